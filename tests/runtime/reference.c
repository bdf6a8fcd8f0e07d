/* reference.c - path-traced radiosities to measure solutions by: reference SCENE PATHS [FACES] >
 * ref.csv
 *
 * For every face, paths from points spread evenly over it estimate its mean irradiance H; B = E +
 * rho H. At each bounce the light that emitters send straight there is sampled both by points on
 * emitters and by the next cosine-spread direction, weighted by the balance heuristic [Veach and
 * Guibas 1995]; so lamps small and near give no spikes. A path goes on with probability rho of its
 * brightest band. Independent of hierarchy, links, oracles and visibility term; it shares the scene
 * reader. Faces get paths by (area)^(2/3), which is best for errors weighted by area when all are
 * equally noisy, at least 64. Seeded by the face: the same numbers every time. With FACES about so
 * many faces of the file are traced, chosen evenly by a hash, and the others have no row: enough to
 * know the mean error of a scene with a million.
 *
 * Columns: face, area, B_k, se_k (one standard error of B_k), for each band k, as `radiosity solve
 * --faces` counts faces.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <omp.h>
#include "util/embree.h"
#include "geometry.h"
#include "scene/read_scene.h"
#include "kernel/hash.h"

#define INVERSE_PI 0.31830988618379067154

static struct scene scene;
static double (*normal)[3], *area;
static RTCScene world;
static uint32_t *face_of; /* by Embree's primitive */
static double offset;

static struct lights {
    uint32_t *face;
    double *upto, whole; /* running sums of A max E */
    uint32_t count;
} lights;

static double uniform(uint64_t *state)
{
    return (double)(hash64(*state += HASH_STEP) >> 11) * 0x1p-53;
}

static double largest(const double v[3])
{
    double m = v[0] > v[1] ? v[0] : v[1];
    return m > v[2] ? m : v[2];
}

static const struct RadMaterial *material(uint32_t face)
{
    return &scene.materials[scene.faces[face].material];
}

static void measure(uint32_t i)
{
    const struct face *f = &scene.faces[i];
    double sum[3] = {0, 0, 0}, a[3], b[3], c[3];
    for (uint32_t j = 2; j < f->vertices; j++) {
        sub3(a, f->vertex[j - 1], f->vertex[0]);
        sub3(b, f->vertex[j], f->vertex[0]);
        cross3(c, a, b);
        for (uint32_t k = 0; k < 3; k++)
            sum[k] += c[k];
    }
    area[i] = 0.5 * length3(sum);
    for (uint32_t k = 0; k < 3; k++)
        normal[i][k] = 0.5 * sum[k] / area[i];
}

/* A point of the face, spread evenly, just in front of it. */
static void point(double p[3], uint32_t i, uint64_t *state)
{
    const struct face *f = &scene.faces[i];
    const double *a = f->vertex[0], *b = f->vertex[1], *c = f->vertex[2];
    if (f->vertices == 4) {
        double u[3];
        sub3(u, b, a);
        double v[3];
        sub3(v, c, a);
        double w[3];
        cross3(w, u, v);
        if (uniform(state) * area[i] > 0.5 * length3(w)) {
            b = c;
            c = f->vertex[3];
        }
    }
    double s = sqrt(uniform(state));
    double t = uniform(state);
    for (int k = 0; k < 3; k++)
        p[k] = a[k] + s * (b[k] - a[k]) + s * t * (c[k] - b[k]) + offset * normal[i][k];
}

static int blocked(const double p[3], const double v[3])
{
    struct RTCRay ray;
    memset(&ray, 0, sizeof ray);
    ray.org_x = (float)p[0];
    ray.org_y = (float)p[1];
    ray.org_z = (float)p[2];
    ray.dir_x = (float)v[0];
    ray.dir_y = (float)v[1];
    ray.dir_z = (float)v[2];
    ray.tfar = 1;
    ray.mask = ~0u;
#if EMBREE == 4
    struct RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    rtcOccluded1(world, &ray, &arguments);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(world, &context, &ray);
#endif
    return ray.tfar < 0;
}

/* The face whose front the ray meets, or -1: nothing, or a black back. *square: squared
 * distance, *cosine: at the face. */
static int64_t meets(double p[3], const double v[3], double *square, double *cosine)
{
    struct RTCRayHit q;
    memset(&q, 0, sizeof q);
    q.ray.org_x = (float)p[0];
    q.ray.org_y = (float)p[1];
    q.ray.org_z = (float)p[2];
    q.ray.dir_x = (float)v[0];
    q.ray.dir_y = (float)v[1];
    q.ray.dir_z = (float)v[2];
    q.ray.tfar = INFINITY;
    q.ray.mask = ~0u;
    q.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if EMBREE == 4
    struct RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    rtcIntersect1(world, &q, &arguments);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(world, &context, &q);
#endif
    if (q.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return -1;
    int64_t face = face_of[q.hit.primID];
    double c = -dot3(normal[face], v);
    if (c <= 0) { /* the back: the face that follows, when there is one */
        uint32_t twin = (uint32_t)face + 1;
        if (twin >= scene.face_count || !scene.faces[twin].back
            || scene.faces[twin].input != scene.faces[face].input)
            return -1;
        face = twin;
        c = -c;
    }
    *square = (double)q.ray.tfar * (double)q.ray.tfar;
    *cosine = c;
    for (int k = 0; k < 3; k++)
        p[k] += (double)q.ray.tfar * v[k] + offset * normal[face][k];
    return face;
}

/* Per area, how likely the light sampler chooses a point of this face. */
static double light_density(uint32_t face)
{
    return lights.whole > 0 ? largest(material(face)->exitance) / lights.whole : 0;
}

/* Light straight from an emitter at p, chosen by the light sampler. */
static void sample_light(const double p[3], const double n[3], const double through[3], double h[3],
                         uint64_t *state)
{
    double u = uniform(state) * lights.whole, q[3], v[3];
    uint32_t low = 0, high = lights.count - 1;
    if (lights.count == 0)
        return;
    while (low < high) {
        uint32_t middle = (low + high) / 2;
        if (lights.upto[middle] > u)
            high = middle;
        else
            low = middle + 1;
    }
    uint32_t f = lights.face[low];
    point(q, f, state);
    sub3(v, q, p);
    double square = dot3(v, v);
    double cos_p = dot3(n, v);
    double cos_q = -dot3(normal[f], v);
    if (!(cos_p > 0) || !(cos_q > 0) || blocked(p, v))
        return;
    /* of the cosine-spread direction to find q */
    double chance = cos_p * cos_q * INVERSE_PI / (square * square);
    for (int k = 0; k < 3; k++)
        h[k] += through[k] * material(f)->exitance[k] * chance / (chance + light_density(f));
}

/* One path's estimate of the irradiance at p. */
static void trace(double p[3], const double at[3], double h[3], uint64_t *state)
{
    double n[3] = {at[0], at[1], at[2]}, through[3] = {1, 1, 1};
    for (;;) {
        double u = uniform(state), angle = 6.28318530717958647693 * uniform(state), r = sqrt(u),
               z = sqrt(1 - u);
        double x[3] = {fabs(n[0]) < 0.5, fabs(n[0]) >= 0.5, 0}, y[3], v[3];
        sample_light(p, n, through, h, state);
        cross3(y, n, x);
        double size = length3(y);
        for (int k = 0; k < 3; k++)
            y[k] /= size;
        cross3(x, y, n);
        for (int k = 0; k < 3; k++)
            v[k] = r * cos(angle) * x[k] + r * sin(angle) * y[k] + z * n[k];
        double square, cosine;
        int64_t face = meets(p, v, &square, &cosine);
        if (face < 0)
            return;
        const struct RadMaterial *m = material((uint32_t)face);
        /* the direction's density per area, times the squared distance */
        double share = z * cosine * INVERSE_PI;
        share = share > 0 ? share / (share + light_density((uint32_t)face) * square) : 0;
        double goes_on = largest(m->reflectance);
        for (int k = 0; k < 3; k++)
            h[k] += through[k] * m->exitance[k] * share;
        if (uniform(state) >= goes_on)
            return;
        for (int k = 0; k < 3; k++) {
            through[k] *= m->reflectance[k] / goes_on;
            n[k] = normal[face][k];
        }
    }
}

static void build_world(RTCDevice device)
{
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_QUAD);
    uint32_t solid = 0, n = 0;
    double size = 0;
    for (uint32_t i = 0; i < scene.face_count; i++)
        solid += !scene.faces[i].back;
    float *v;
    v = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof *v,
                                (size_t)solid * 4);
    unsigned *index;
    index = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4,
                                    4 * sizeof *index, solid);
    for (uint32_t i = 0; i < scene.face_count; i++) {
        const struct face *f = &scene.faces[i];
        for (uint32_t j = 0; j < 4; j++)
            for (uint32_t k = 0; k < 3; k++) {
                double x = f->vertex[j < f->vertices ? j : f->vertices - 1][k];
                size = fabs(x) > size ? fabs(x) : size;
                if (!f->back)
                    v[12 * (size_t)n + 3 * j + k] = (float)x;
            }
        if (f->back)
            continue;
        for (uint32_t j = 0; j < 4; j++)
            index[4 * (size_t)n + j] = 4 * n + j;
        face_of[n++] = i;
    }
    offset = 4e-6 * size;
    rtcCommitGeometry(g);
    world = rtcNewScene(device);
    rtcSetSceneFlags(world, RTC_SCENE_FLAG_ROBUST);
    rtcAttachGeometry(world, g);
    rtcReleaseGeometry(g);
    rtcCommitScene(world);
}

/* Is this face of the file among the share that is traced? */
static int chosen(uint32_t input, double share)
{
    uint64_t state = input;
    return uniform(&state) < share;
}

struct estimate {
    double area, sum[3], variance[3]; /* of A H over the faces that one input became */
};

int main(int count, char **arguments)
{
    const struct scene_options how = {0, 0};
    double paths, share = 1, whole = 0;
    if (count < 3 || count > 4 || !(paths = atof(arguments[2]), paths >= 1)
        || (count == 4 && !(atof(arguments[3]) >= 1))) {
        fprintf(
            stderr,
            "usage: reference SCENE PATHS [FACES] > ref.csv\n"
            "PATHS: mean number per face; face,area,B_k,se_k per input face and band go to "
            "standard output\n"
            "FACES: trace about so many faces of the file, spread evenly over it; all without\n");
        return 2;
    }
    if (scene_read(&scene, arguments[1], &how) < 0)
        return 1;
    if (count == 4)
        share = atof(arguments[3]) / scene.input_count;
    normal = malloc(scene.face_count * sizeof *normal);
    area = malloc(scene.face_count * sizeof *area);
    face_of = malloc(scene.face_count * sizeof *face_of);
    lights.face = malloc(scene.face_count * sizeof *lights.face);
    lights.upto = malloc(scene.face_count * sizeof *lights.upto);
    struct estimate *estimates;
    estimates = calloc(scene.input_count + 1, sizeof *estimates);
    if (!normal || !area || !face_of || !lights.face || !lights.upto || !estimates) {
        fprintf(stderr, "reference: out of memory\n");
        return 1;
    }
    for (uint32_t i = 0; i < scene.face_count; i++) {
        measure(i);
        whole += cbrt(area[i] * area[i]);
        double power = area[i] * largest(material(i)->exitance);
        if (power > 0) {
            lights.face[lights.count] = i;
            lights.upto[lights.count++] = lights.whole += power;
        }
    }
    build_world(rtcNewDevice(NULL));
#pragma omp parallel for schedule(dynamic, 4)
    for (uint32_t i = 0; i < scene.face_count; i++) {
        double wanted = paths * scene.face_count * cbrt(area[i] * area[i]) / whole, sum[3] = {0},
               squares[3] = {0};
        uint64_t n = wanted > 64 ? (uint64_t)wanted : 64, state = 7919 * (uint64_t)i + 13;
        struct estimate *e = &estimates[scene.faces[i].input];
        if (!chosen(scene.faces[i].input, share))
            continue;
        for (uint64_t j = 0; j < n; j++) {
            double p[3], h[3] = {0, 0, 0};
            point(p, i, &state);
            trace(p, normal[i], h, &state);
            for (uint32_t b = 0; b < 3; b++) {
                sum[b] += h[b];
                squares[b] += h[b] * h[b];
            }
        }
#pragma omp critical
        {
            e->area += area[i];
            for (uint32_t b = 0; b < 3; b++) {
                double mean = sum[b] / (double)n, variance = squares[b] / (double)n - mean * mean;
                e->sum[b] += area[i] * mean;
                e->variance[b] += area[i] * area[i] * (variance > 0 ? variance : 0) / (double)n;
            }
        }
    }
    printf("face,area");
    for (uint32_t k = 0; k < scene.bands; k++)
        printf(",B_%u", k);
    for (uint32_t k = 0; k < scene.bands; k++)
        printf(",se_%u", k);
    for (uint32_t i = 0; i < scene.input_count; i++) {
        const struct estimate *e = &estimates[i];
        const struct RadMaterial *m = &scene.materials[scene.input_materials[i]];
        if (!chosen(i, share))
            continue;
        printf("\n%u,%.9g", i, e->area);
        for (uint32_t k = 0; k < scene.bands; k++)
            printf(",%.9g",
                   e->area > 0 ? m->exitance[k] + m->reflectance[k] * e->sum[k] / e->area : 0);
        for (uint32_t k = 0; k < scene.bands; k++)
            printf(",%.3g", e->area > 0 ? m->reflectance[k] * sqrt(e->variance[k]) / e->area : 0);
    }
    putchar('\n');
    scene_free(&scene);
    return 0;
}
