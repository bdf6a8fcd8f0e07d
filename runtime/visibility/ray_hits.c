/* ray_hits.c - what a ray meets first, and from which side.
 *
 * A face of one side is black from behind; where a front lies in the place of a back that is met,
 * the front is. Rays are cast each alone, but for those that only ask for backs.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>
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

/* Where two one-sided faces lie back to back in one plane, a ray meets either of them first, by
 * rounding. So of a black back that is met it is asked whether a front lies in the same place, as
 * near as rays can tell; then that is met. Returns 1 when it is. */
static int front_there(const struct rays *rays, struct RTCRayHit *query)
{
    struct RTCRayHit again = {.ray = query->ray};
    const float near =
        (float)(rays->host.ray_offset * rays->scale)
        / sqrtf(query->ray.dir_x * query->ray.dir_x + query->ray.dir_y * query->ray.dir_y
                + query->ray.dir_z * query->ray.dir_z);
    again.ray.tnear = fmaxf(0, query->ray.tfar - near);
    again.ray.tfar = query->ray.tfar + near;
    intersect(rays, &again, 1);
    if (again.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return 0;
    const struct RTCHit *a = &again.hit, *b = &query->hit;
    float cosine = -(a->Ng_x * b->Ng_x + a->Ng_y * b->Ng_y + a->Ng_z * b->Ng_z),
          sizes = sqrtf((a->Ng_x * a->Ng_x + a->Ng_y * a->Ng_y + a->Ng_z * a->Ng_z)
                        * (b->Ng_x * b->Ng_x + b->Ng_y * b->Ng_y + b->Ng_z * b->Ng_z));
    if (!(cosine > (float)GROUP_COSINE * sizes))
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

/* A ray of a packet, and what it met. */
static struct RTCRayHit one_of(const struct RTCRayHit16 *packet, int i)
{
    const struct RTCRay16 *ray = &packet->ray;
    const struct RTCHit16 *hit = &packet->hit;
    struct RTCRayHit one;
    memset(&one, 0, sizeof one);
    one.ray.org_x = ray->org_x[i];
    one.ray.org_y = ray->org_y[i];
    one.ray.org_z = ray->org_z[i];
    one.ray.dir_x = ray->dir_x[i];
    one.ray.dir_y = ray->dir_y[i];
    one.ray.dir_z = ray->dir_z[i];
    one.ray.tfar = ray->tfar[i];
    one.ray.mask = ray->mask[i];
    one.hit.Ng_x = hit->Ng_x[i];
    one.hit.Ng_y = hit->Ng_y[i];
    one.hit.Ng_z = hit->Ng_z[i];
    one.hit.primID = hit->primID[i];
    one.hit.geomID = hit->geomID[i];
    return one;
}

unsigned rays_meet_backs(const struct rays *rays, const double from[16][3], unsigned which,
                         const double direction[3])
{
    struct RTCRayHit16 query;
    _Alignas(64) int valid[16];
    unsigned backs = 0;
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
    embree_intersect_16(rays->scene, valid, &query);
    for (int i = 0; i < 16; i++) {
        if (!valid[i] || query.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID
            || rays->behind[rays->face[query.hit.primID[i]]] != BLACK_BACK)
            continue;
        _Alignas(16) struct RTCRayHit one = one_of(&query, i);
        backs |= (unsigned)meets_behind(rays, &one) << i;
    }
    return backs;
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
