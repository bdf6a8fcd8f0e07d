/* path_reference.h - what every face receives, by tracing light: an answer to compare solutions
 * with that knows nothing of form factors, links and elements.
 *
 * Particles leave the emitters by their power, from random points in directions by the cosine. Each
 * front that one meets is given its power; then it goes on, dimmed by the reflectance, until
 * roulette ends it, a back or the open. What a face was given over its area is H, exact but for the
 * noise, whose standard error is taken from BATCHES independent parts; each part's random numbers
 * start from its index alone, so the result does not depend on threads.
 * [Pattanaik and Mudur 1992]
 * SPDX-License-Identifier: MIT */
#ifndef PATH_REFERENCE_H
#define PATH_REFERENCE_H

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "util/embree.h"
#include "geometry.h"
#include "hierarchy/scene.h"
#include "kernel/hash.h"

struct path_scene {
    const struct scene *scene;
    RTCDevice device;
    RTCScene rays;
    uint32_t *face;      /* by Embree's primitive */
    double (*normal)[3]; /* by face */
    double centre[3], size;
};

static inline double path_random(uint64_t *state)
{
    return (double)(hash64(*state += HASH_STEP) >> 11) * (1 / 9007199254740992.0);
}

static inline void path_open(struct path_scene *p, const struct scene *scene)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    uint32_t n = 0;
    p->scene = scene;
    p->device = rtcNewDevice(NULL);
    p->rays = rtcNewScene(p->device);
    p->face = malloc(scene->face_count * sizeof *p->face);
    p->normal = malloc(scene->face_count * sizeof *p->normal);
    for (uint32_t i = 0; i < scene->face_count; i++) {
        const struct face *f = &scene->faces[i];
        double a[3], b[3];
        sub3(a, f->vertex[1], f->vertex[0]);
        sub3(b, f->vertex[2], f->vertex[0]);
        cross3(p->normal[i], a, b);
        double size = length3(p->normal[i]);
        for (int k = 0; k < 3; k++)
            p->normal[i][k] /= size;
        if (!f->back)
            p->face[n++] = i;
        for (uint32_t j = 0; j < f->vertices; j++)
            for (int k = 0; k < 3; k++) {
                low[k] = fmin(low[k], f->vertex[j][k]);
                high[k] = fmax(high[k], f->vertex[j][k]);
            }
    }
    for (int k = 0; k < 3; k++)
        p->centre[k] = 0.5 * (low[k] + high[k]);
    p->size = fmax(high[0] - low[0], fmax(high[1] - low[1], high[2] - low[2]));
    RTCGeometry geometry = rtcNewGeometry(p->device, RTC_GEOMETRY_TYPE_QUAD);
    float *vertex;
    vertex = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                     3 * sizeof *vertex, (size_t)n * 4);
    unsigned *index;
    index = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4,
                                    4 * sizeof *index, n);
    for (uint32_t i = 0; i < n; i++) {
        const struct face *f = &scene->faces[p->face[i]];
        for (uint32_t j = 0; j < 4; j++) {
            for (int k = 0; k < 3; k++)
                vertex[12 * i + 3 * j + (uint32_t)k] =
                    (float)((f->vertex[j < f->vertices ? j : f->vertices - 1][k] - p->centre[k])
                            / p->size);
            index[4 * i + j] = 4 * i + j;
        }
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(p->rays, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(p->rays, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(p->rays);
}

static inline void path_close(struct path_scene *p)
{
    rtcReleaseScene(p->rays);
    rtcReleaseDevice(p->device);
    free(p->face);
    free(p->normal);
}

/* From x on `face`, in a direction by the cosine: the face whose front is met, x moved to it; or
 * -1. */
static inline int64_t path_step(const struct path_scene *p, uint32_t face, double x[3],
                                uint64_t *state)
{
    const double *n = p->normal[face];
    double angle = 6.28318530717958647693 * path_random(state), square = path_random(state),
           r = sqrt(square), z = sqrt(1 - square);
    double u[3] = {0, 0, 0}, v[3], d[3];
    int axis = fabs(n[0]) <= fabs(n[1])   ? fabs(n[0]) <= fabs(n[2]) ? 0 : 2
               : fabs(n[1]) <= fabs(n[2]) ? 1
                                          : 2;
    u[axis] = 1;
    cross3(v, n, u);
    double size = length3(v);
    for (int k = 0; k < 3; k++)
        v[k] /= size;
    cross3(u, v, n);
    for (int k = 0; k < 3; k++)
        d[k] = z * n[k] + r * (cos(angle) * u[k] + sin(angle) * v[k]);
    struct RTCRayHit hit;
    memset(&hit, 0, sizeof hit);
    hit.ray.org_x = (float)((x[0] - p->centre[0]) / p->size + 4e-6 * n[0]);
    hit.ray.org_y = (float)((x[1] - p->centre[1]) / p->size + 4e-6 * n[1]);
    hit.ray.org_z = (float)((x[2] - p->centre[2]) / p->size + 4e-6 * n[2]);
    hit.ray.dir_x = (float)d[0];
    hit.ray.dir_y = (float)d[1];
    hit.ray.dir_z = (float)d[2];
    hit.ray.tfar = INFINITY;
    hit.ray.mask = ~0u;
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    embree_intersect(p->rays, &hit, NULL);
    if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return -1;
    uint32_t met = p->face[hit.hit.primID];
    if (dot3(d, p->normal[met]) >= 0) { /* its back: black, unless the face after it is that side */
        met++;
        if (met == p->scene->face_count || !p->scene->faces[met].back)
            return -1;
    }
    for (int k = 0; k < 3; k++)
        x[k] += p->size * (double)hit.ray.tfar * d[k];
    return met;
}

enum { BATCHES = 64 };

/* Add the power that `count` particles bring, per face and band (W), for emitters of `total` W
 * in all bands. */
static inline void path_batch(const struct path_scene *p, const double *until, int batch, int count,
                              double *power)
{
    const struct scene *scene = p->scene;
    uint64_t state = ((uint64_t)batch + 1) * 0xd1342543de82ef95u;
    uint32_t bands = scene->bands;
    double total = until[scene->face_count - 1];
    for (int i = 0; i < count; i++) {
        double pick = path_random(&state) * total, weight[3] = {0, 0, 0}, sum = 0, a[3], b[3], c[3],
               x[3];
        uint32_t low = 0, high = scene->face_count - 1;
        while (low < high) { /* the first face whose sum is above `pick` */
            uint32_t middle = (low + high) / 2;
            if (until[middle] > pick)
                high = middle;
            else
                low = middle + 1;
        }
        const struct face *f = &scene->faces[low];
        const double *e = scene->materials[f->material].exitance;
        for (uint32_t k = 0; k < bands; k++)
            sum += e[k];
        for (uint32_t k = 0; k < bands; k++)
            weight[k] = total / count * e[k] / sum;
        sub3(a, f->vertex[1], f->vertex[0]);
        sub3(b, f->vertex[2], f->vertex[0]);
        cross3(c, a, b);
        double first = length3(c);
        sub3(a, f->vertex[f->vertices - 1], f->vertex[0]);
        cross3(c, b, a);
        double second = f->vertices == 4 ? length3(c) : 0;
        int m = path_random(&state) * (first + second) >= first;
        const double *q = f->vertex[m ? 2 : 1];
        const double *r = f->vertex[m ? 3 : 2];
        double s = sqrt(path_random(&state));
        double t = path_random(&state);
        for (m = 0; m < 3; m++)
            x[m] = f->vertex[0][m] + s * (q[m] - f->vertex[0][m]) + s * t * (r[m] - q[m]);
        int64_t at = low;
        while ((at = path_step(p, (uint32_t)at, x, &state)) >= 0) {
            const double *rho = scene->materials[scene->faces[at].material].reflectance;
            double live = 0;
            for (uint32_t k = 0; k < bands; k++) {
                power[(size_t)at * bands + k] += weight[k];
                live = rho[k] > live ? rho[k] : live;
            }
            if (path_random(&state) >= live)
                break;
            for (uint32_t k = 0; k < bands; k++)
                weight[k] *= rho[k] / live;
        }
    }
}

/* The power that faces receive (W), [BATCHES][face_count * bands]: BATCHES independent estimates,
 * each by its part of so many particles. `area` (m2), [face_count], is filled, too. */
static inline double *path_powers(const struct scene *scene, int particles, double *area)
{
    size_t values = (size_t)scene->face_count * scene->bands;
    double *power = calloc(BATCHES * values, sizeof *power),
           *until = calloc(scene->face_count, sizeof *until);
    struct path_scene p;
    path_open(&p, scene);
    for (uint32_t f = 0; f < scene->face_count; f++) {
        const struct face *face = &scene->faces[f];
        const double *e = scene->materials[face->material].exitance;
        area[f] = 0;
        for (uint32_t j = 2; j < face->vertices; j++) {
            double a[3], b[3], c[3];
            sub3(a, face->vertex[j - 1], face->vertex[0]);
            sub3(b, face->vertex[j], face->vertex[0]);
            cross3(c, a, b);
            area[f] += 0.5 * length3(c);
        }
        until[f] = f > 0 ? until[f - 1] : 0;
        for (uint32_t k = 0; k < scene->bands; k++)
            until[f] += area[f] * e[k];
    }
#pragma omp parallel for schedule(dynamic, 1)
    for (int batch = 0; batch < BATCHES; batch++)
        path_batch(&p, until, batch, particles / BATCHES, power + (size_t)batch * values);
    path_close(&p);
    free(until);
    return power;
}

/* H of all faces (W/m2) and its standard error, [face_count * bands] each, by so many particles. */
static inline void path_reference(const struct scene *scene, int particles, double *irradiance,
                                  double *error)
{
    size_t values = (size_t)scene->face_count * scene->bands;
    double *area = malloc(scene->face_count * sizeof *area),
           *power = path_powers(scene, particles, area);
    for (size_t i = 0; i < values; i++) {
        double sum = 0, squares = 0, here = area[i / scene->bands];
        for (int batch = 0; batch < BATCHES; batch++) {
            double h = power[(size_t)batch * values + i] / here;
            sum += h;
            squares += h * h;
        }
        irradiance[i] = sum / BATCHES;
        error[i] = sqrt(fmax(0, squares / BATCHES - irradiance[i] * irradiance[i]) / (BATCHES - 1));
    }
    free(power);
    free(area);
}

#endif
