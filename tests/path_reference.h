/* path_reference.h - what every face receives, by path tracing: an answer to compare solutions with that knows nothing
 * of form factors, links and elements.
 *
 * A path starts at a random point of the face, in a direction by the cosine, and gathers the exitance of each front it
 * meets, dimmed by the reflectances on the way; it ends at a back, in the open, or by roulette. The mean over `paths` of
 * them is H, exact but for the noise, whose standard error comes with it. A face's random numbers start from its index
 * alone, so the result does not depend on threads. [Kajiya 1986]
 * SPDX-License-Identifier: MIT */
#ifndef PATH_REFERENCE_H
#define PATH_REFERENCE_H

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#if defined __has_include
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#define PATH_EMBREE 4
#endif
#endif
#ifndef PATH_EMBREE
#include <embree3/rtcore.h>
#define PATH_EMBREE 3
#endif
#include "geometry.h"
#include "scene.h"

struct path_scene {
    const struct scene *scene;
    RTCDevice device;
    RTCScene rays;
    uint32_t *face;                /* by Embree's primitive */
    double (*normal)[3];           /* by face */
    double centre[3], size;
};

static inline double path_random(uint64_t *state)
{
    uint64_t x = *state += 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return (double)((x ^ x >> 31) >> 11) * (1 / 9007199254740992.0);
}

static inline void path_open(struct path_scene *p, const struct scene *scene)
{
    RTCGeometry geometry;
    float *vertex;
    unsigned *index;
    double low[3] = { INFINITY, INFINITY, INFINITY }, high[3] = { -INFINITY, -INFINITY, -INFINITY };
    uint32_t i, j, n = 0;
    int k;
    p->scene = scene;
    p->device = rtcNewDevice(NULL);
    p->rays = rtcNewScene(p->device);
    p->face = malloc(scene->face_count * sizeof *p->face);
    p->normal = malloc(scene->face_count * sizeof *p->normal);
    for (i = 0; i < scene->face_count; i++) {
        const struct face *f = &scene->faces[i];
        double a[3], b[3], size;
        sub3(a, f->vertex[1], f->vertex[0]);
        sub3(b, f->vertex[2], f->vertex[0]);
        cross3(p->normal[i], a, b);
        size = length3(p->normal[i]);
        for (k = 0; k < 3; k++)
            p->normal[i][k] /= size;
        if (!f->back)
            p->face[n++] = i;
        for (j = 0; j < f->vertices; j++)
            for (k = 0; k < 3; k++) {
                low[k] = fmin(low[k], f->vertex[j][k]);
                high[k] = fmax(high[k], f->vertex[j][k]);
            }
    }
    for (k = 0; k < 3; k++)
        p->centre[k] = 0.5 * (low[k] + high[k]);
    p->size = fmax(high[0] - low[0], fmax(high[1] - low[1], high[2] - low[2]));
    geometry = rtcNewGeometry(p->device, RTC_GEOMETRY_TYPE_QUAD);
    vertex = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof *vertex, (size_t)n * 4);
    index = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 4 * sizeof *index, n);
    for (i = 0; i < n; i++) {
        const struct face *f = &scene->faces[p->face[i]];
        for (j = 0; j < 4; j++) {
            for (k = 0; k < 3; k++)
                vertex[12 * i + 3 * j + (uint32_t)k] = (float)((f->vertex[j < f->vertices ? j : f->vertices - 1][k] - p->centre[k]) / p->size);
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

/* From x on `face`, in a direction by the cosine: the face whose front is met there, x moved to it; or -1. */
static inline int64_t path_step(const struct path_scene *p, uint32_t face, double x[3], uint64_t *state)
{
    const double *n = p->normal[face];
    double angle = 6.28318530717958647693 * path_random(state), square = path_random(state), r = sqrt(square), z = sqrt(1 - square);
    double u[3] = { 0, 0, 0 }, v[3], d[3], size;
    struct RTCRayHit hit;
    int k, axis = fabs(n[0]) <= fabs(n[1]) ? fabs(n[0]) <= fabs(n[2]) ? 0 : 2 : fabs(n[1]) <= fabs(n[2]) ? 1 : 2;
    uint32_t met;
    u[axis] = 1;
    cross3(v, n, u);
    size = length3(v);
    for (k = 0; k < 3; k++)
        v[k] /= size;
    cross3(u, v, n);
    for (k = 0; k < 3; k++)
        d[k] = z * n[k] + r * (cos(angle) * u[k] + sin(angle) * v[k]);
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
#if PATH_EMBREE == 4
    rtcIntersect1(p->rays, &hit, NULL);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(p->rays, &context, &hit);
#endif
    if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return -1;
    met = p->face[hit.hit.primID];
    if (dot3(d, p->normal[met]) >= 0) { /* its back: black, unless the face after it is that side */
        met++;
        if (met == p->scene->face_count || !p->scene->faces[met].back)
            return -1;
    }
    for (k = 0; k < 3; k++)
        x[k] += p->size * (double)hit.ray.tfar * d[k];
    return met;
}

/* H of one face, per band (W/m2), and its standard error. */
static inline void path_face(const struct path_scene *p, uint32_t face, int paths, double *irradiance, double *error)
{
    const struct face *f = &p->scene->faces[face];
    double sum[3] = { 0, 0, 0 }, squares[3] = { 0, 0, 0 }, a[3], b[3], c[3], first, second;
    uint64_t state = ((uint64_t)face + 1) * 0xd1342543de82ef95u;
    uint32_t bands = p->scene->bands, k;
    int i, m;
    sub3(a, f->vertex[1], f->vertex[0]);
    sub3(b, f->vertex[2], f->vertex[0]);
    cross3(c, a, b);
    first = length3(c);
    sub3(a, f->vertex[f->vertices - 1], f->vertex[0]);
    cross3(c, b, a);
    second = f->vertices == 4 ? length3(c) : 0;
    for (i = 0; i < paths; i++) {
        int far = path_random(&state) * (first + second) >= first;
        double s = sqrt(path_random(&state)), t = path_random(&state), x[3], weight[3] = { 1, 1, 1 }, got[3] = { 0, 0, 0 };
        const double *q = f->vertex[far ? 2 : 1], *r = f->vertex[far ? 3 : 2];
        int64_t at = face;
        for (m = 0; m < 3; m++)
            x[m] = f->vertex[0][m] + s * (q[m] - f->vertex[0][m]) + s * t * (r[m] - q[m]);
        while ((at = path_step(p, (uint32_t)at, x, &state)) >= 0) {
            const struct material *met = &p->scene->materials[p->scene->faces[at].material];
            double live = 0;
            for (k = 0; k < bands; k++) {
                got[k] += weight[k] * met->exitance[k];
                weight[k] *= met->reflectance[k];
                live = weight[k] > live ? weight[k] : live;
            }
            live = live < 1 ? live : 1;
            if (path_random(&state) >= live)
                break;
            for (k = 0; k < bands; k++)
                weight[k] /= live;
        }
        for (k = 0; k < bands; k++) {
            sum[k] += got[k];
            squares[k] += got[k] * got[k];
        }
    }
    for (k = 0; k < bands; k++) {
        irradiance[k] = sum[k] / paths;
        error[k] = sqrt((squares[k] / paths - irradiance[k] * irradiance[k]) / paths);
    }
}

/* H of all faces and its standard error: [face_count * bands] each. */
static inline void path_reference(const struct scene *scene, int paths, double *irradiance, double *error)
{
    struct path_scene p;
    uint32_t i;
    path_open(&p, scene);
#pragma omp parallel for schedule(dynamic, 1)
    for (i = 0; i < scene->face_count; i++)
        path_face(&p, i, paths, irradiance + (size_t)i * scene->bands, error + (size_t)i * scene->bands);
    path_close(&p);
}

#endif
