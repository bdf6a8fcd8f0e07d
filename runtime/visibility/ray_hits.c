/* ray_hits.c - what a ray meets first, and from which side.
 *
 * A face of one side is black from behind; where a front lies in the place of a back that is met,
 * the front is. Rays are cast each alone, but for those that only ask for backs: sixteen at a time.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "kernel/constants.h"
#include "visibility/back_faces.h"
#include "visibility/rays_within.h"

/* A coordinate of a point (m), and of a direction, in Embree's coordinates. */
static float embree_place(const struct rays *rays, const double p[3], int k)
{
    return (float)((p[k] - rays->origin[k]) * rays->scale);
}
static float embree_way(const struct rays *rays, const double direction[3], int k)
{
    return (float)(direction[k] * rays->scale);
}

/* The ray from p (m) into a direction, of length `far` directions. Written where it is wanted: a
 * copy would load at once as wholes what has just been stored in parts, and wait for that. */
static void ray_from(struct RTCRay *ray, const struct rays *rays, const double p[3],
                     const double direction[3], float far)
{
    ray->org_x = embree_place(rays, p, 0);
    ray->org_y = embree_place(rays, p, 1);
    ray->org_z = embree_place(rays, p, 2);
    ray->tnear = 0;
    ray->dir_x = embree_way(rays, direction, 0);
    ray->dir_y = embree_way(rays, direction, 1);
    ray->dir_z = embree_way(rays, direction, 2);
    ray->time = 0;
    ray->tfar = far;
    ray->mask = ~0u;
    ray->id = ray->flags = 0;
}

/* Is it hit from behind? */
static int from_behind(const struct RTCRayHit *query)
{
    return query->hit.Ng_x * query->ray.dir_x + query->hit.Ng_y * query->ray.dir_y
               + query->hit.Ng_z * query->ray.dir_z
           > 0;
}

/* A filter of Embree's: passes over what is met from behind. A ray's direction begins at its fifth
 * number, a hit's normal at its first (rtcore_ray.h). */
static void fronts_alone(const struct RTCFilterFunctionNArguments *a)
{
    const float *ray = (const void *)a->ray, *hit = (const void *)a->hit;
    for (unsigned i = 0; i < a->N; i++) {
        float cosine = 0;
        for (unsigned k = 0; k < 3; k++)
            cosine += hit[k * a->N + i] * ray[(4 + k) * a->N + i];
        if (cosine > 0)
            a->valid[i] = 0;
    }
}

static void intersect(const struct rays *rays, struct RTCRayHit *query, int fronts)
{
    query->hit.geomID = RTC_INVALID_GEOMETRY_ID;
    embree_intersect(rays->scene, query, fronts ? fronts_alone : NULL);
}

/* From where to where (in directions) a ray that is `far` long is near its end, as near as rays can
 * tell. */
static void look_near(const struct rays *rays, const float way[3], float *from, float *far)
{
    const float near = (float)(rays->host.ray_offset * rays->scale)
                       / sqrtf(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
    *from = fmaxf(0, *far - near);
    *far += near;
}

/* Normals of any length. */
static int are_back_to_back(const float a[3], const float b[3])
{
    const float cosine = -(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]),
                sizes = sqrtf((a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
                              * (b[0] * b[0] + b[1] * b[1] + b[2] * b[2]));
    return cosine > (float)GROUP_COSINE * sizes;
}

/* Where two one-sided faces lie back to back in one plane, a ray meets either of them first, by
 * rounding. So of a black back that is met it is asked whether a front lies in the same place; then
 * that is met. Returns 1 when it is. */
static int front_there(const struct rays *rays, struct RTCRayHit *query)
{
    struct RTCRayHit again = {.ray = query->ray};
    const float way[3] = {again.ray.dir_x, again.ray.dir_y, again.ray.dir_z},
                back[3] = {query->hit.Ng_x, query->hit.Ng_y, query->hit.Ng_z};
    look_near(rays, way, &again.ray.tnear, &again.ray.tfar);
    intersect(rays, &again, 1);
    const float front[3] = {again.hit.Ng_x, again.hit.Ng_y, again.hit.Ng_z};
    if (again.hit.geomID == RTC_INVALID_GEOMETRY_ID || !are_back_to_back(front, back))
        return 0;
    *query = again;
    return 1;
}

/* Does the ray come from behind what it meets, with no front in the same place? */
static int meets_behind(const struct rays *rays, struct RTCRayHit *query)
{
    return from_behind(query)
           && !(rays->behind[rays->face[query->hit.primID]] == BLACK_BACK
                && front_there(rays, query));
}

/* What the ray meets first: 0 when nothing; *behind: it comes from behind. */
static int first_hit(const struct rays *rays, const double from[3], const double direction[3],
                     struct RTCRayHit *query, int *behind)
{
    ray_from(&query->ray, rays, from, direction, INFINITY);
    intersect(rays, query, 0);
    if (query->hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return 0;
    *behind = meets_behind(rays, query);
    return 1;
}

enum ray_fate rays_first(const struct rays *rays, const double from[3], const double direction[3],
                         double at[3], double normal[3])
{
    _Alignas(16) struct RTCRayHit query;
    int behind;
    if (!first_hit(rays, from, direction, &query, &behind))
        return RAY_LEAVES;
    double side[3] = {query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z}, size = length3(side);
    for (int k = 0; k < 3; k++) {
        if (at)
            at[k] = from[k] + (double)query.ray.tfar * direction[k];
        if (normal)
            normal[k] = (behind ? -side[k] : side[k]) / size;
    }
    return behind && rays->behind[rays->face[query.hit.primID]] == BLACK_BACK ? RAY_MEETS_BACK
                                                                              : RAY_MEETS_FRONT;
}

/* Rays of a packet that come from behind what they meet, which is black there. */
static unsigned black_backs(const struct rays *rays, const struct RTCRayHit16 *query,
                            const int valid[16])
{
    const struct RTCRay16 *ray = &query->ray;
    const struct RTCHit16 *hit = &query->hit;
    unsigned backs = 0;
    for (int i = 0; i < 16; i++)
        if (valid[i] && hit->geomID[i] != RTC_INVALID_GEOMETRY_ID
            && rays->behind[rays->face[hit->primID[i]]] == BLACK_BACK)
            backs |= (unsigned)(hit->Ng_x[i] * ray->dir_x[i] + hit->Ng_y[i] * ray->dir_y[i]
                                    + hit->Ng_z[i] * ray->dir_z[i]
                                > 0)
                     << i;
    return backs;
}

/* As front_there, of those rays of a packet: of which is there one? */
static unsigned fronts_there(const struct rays *rays, const struct RTCRayHit16 *query,
                             unsigned which)
{
    struct RTCRayHit16 again = *query;
    _Alignas(64) int valid[16];
    unsigned fronts = 0;
    for (int i = 0; i < 16; i++) {
        const float way[3] = {again.ray.dir_x[i], again.ray.dir_y[i], again.ray.dir_z[i]};
        valid[i] = which >> i & 1 ? -1 : 0;
        look_near(rays, way, &again.ray.tnear[i], &again.ray.tfar[i]);
        again.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
    embree_intersect_16(rays->scene, valid, &again, fronts_alone);
    for (int i = 0; i < 16; i++) {
        const float a[3] = {again.hit.Ng_x[i], again.hit.Ng_y[i], again.hit.Ng_z[i]},
                    b[3] = {query->hit.Ng_x[i], query->hit.Ng_y[i], query->hit.Ng_z[i]};
        if (valid[i] && again.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID)
            fronts |= (unsigned)are_back_to_back(a, b) << i;
    }
    return fronts;
}

unsigned rays_meet_backs(const struct rays *rays, const double from[16][3], unsigned which,
                         const double direction[3])
{
    struct RTCRayHit16 query;
    _Alignas(64) int valid[16];
    const float way[3] = {embree_way(rays, direction, 0), embree_way(rays, direction, 1),
                          embree_way(rays, direction, 2)};
    for (int i = 0; i < 16; i++) {
        valid[i] = which >> i & 1 ? -1 : 0;
        query.ray.org_x[i] = embree_place(rays, from[i], 0);
        query.ray.org_y[i] = embree_place(rays, from[i], 1);
        query.ray.org_z[i] = embree_place(rays, from[i], 2);
        query.ray.dir_x[i] = way[0];
        query.ray.dir_y[i] = way[1];
        query.ray.dir_z[i] = way[2];
        query.ray.tnear[i] = 0;
        query.ray.tfar[i] = INFINITY;
        query.ray.time[i] = 0;
        query.ray.mask[i] = ~0u;
        query.ray.id[i] = query.ray.flags[i] = 0;
        query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
    embree_intersect_16(rays->scene, valid, &query, NULL);
    const unsigned backs = black_backs(rays, &query, valid);
    return backs ? backs & ~fronts_there(rays, &query, backs) : 0;
}

int64_t rays_meet(const struct rays *rays, const double from[3], const double direction[3],
                  double *distance)
{
    _Alignas(16) struct RTCRayHit query;
    int behind;
    if (!first_hit(rays, from, direction, &query, &behind))
        return RAY_MEETS_NO_FRONT;
    const uint32_t face = rays->face[query.hit.primID];
    *distance = (double)query.ray.tfar;
    if (!behind)
        return face;
    return rays->behind[face] == BLACK_BACK ? ray_meets_back(face) : (int64_t)rays->behind[face];
}

int rays_blocked(const struct rays *rays, const double from[3], const double direction[3])
{
    _Alignas(16) struct RTCRay ray;
    ray_from(&ray, rays, from, direction, 1);
    embree_occluded(rays->scene, &ray);
    return ray.tfar < 0;
}
