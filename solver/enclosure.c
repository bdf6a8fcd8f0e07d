/* enclosure.c - is the scene closed? Decided by rays, cosine-spread, 1,024 from every face: 64 directions from
 * each of 16 points.
 *
 * Closed means that what leaves a front always meets a front, so that the rows of every point sum to 1. Not
 * counted are points inside a solid, as on the floor under a table leg (three quarters of their rays meet backs),
 * and faces that turn outward, none of whose rays meets a front, as the underside of a box that stands on the floor.
 *
 * What it can miss: an opening that takes the share p of a face's light is overlooked by all of that face's rays with a
 * probability near (1 - p)^1024, so 1/150 of the light is found with 99.9 %, and a hole which every face sees
 * under less than about 1/10000 may pass. The error is then no larger than that share.
 * [derived here]
 * SPDX-License-Identifier: MIT */
#include "enclosure.h"
#include "hemisphere.h"
#include "terms/surface_point.h"

enum { SIDE = 4, POINTS = SIDE * SIDE, DIRECTIONS = 64, BURIED = DIRECTIONS / 4 * 3 };

/* Where the rays from one face went. */
struct fates {
    int fronts, lost; /* of rays from points that are not buried; lost: left the scene or met a back */
};

static struct fates look_around(const struct rays *rays, const struct element *e)
{
    struct fates all = { 0, 0 };
    const struct hemisphere above = hemisphere_over(e->normal);
    int i, m, k;
    for (i = 0; i < POINTS; i++) {
        double p[3], d[3];
        int met[3] = { 0, 0, 0 };
        surface_point(p, e, (i % SIDE + 0.5) / SIDE, (i / SIDE + 0.5) / SIDE);
        for (k = 0; k < 3; k++)
            p[k] += rays_host(rays)->ray_offset * e->normal[k];
        for (m = 0; m < DIRECTIONS; m++) {
            hemisphere_direction(d, &above, m, DIRECTIONS, i / (double)POINTS);
            met[rays_first(rays, p, d)]++;
        }
        if (met[RAY_MEETS_BACK] >= BURIED)
            continue;
        all.fronts += met[RAY_MEETS_FRONT];
        all.lost += met[RAY_MEETS_BACK] + met[RAY_LEAVES];
    }
    return all;
}

int enclosure_decide(struct solve *s)
{
    uint32_t i;
    int open = 0, lit = 0;
#pragma omp parallel for schedule(dynamic, 16) num_threads(s->options.threads) reduction(| : open, lit)
    for (i = 0; i < s->scene->face_count; i++) {
        struct fates f = look_around(s->rays, &s->hierarchy.elements[s->hierarchy.face_element[i]]);
        open |= f.lost > 0 && f.fronts > 0;
        lit |= f.fronts > 0;
    }
    s->closed_rays = (uint64_t)s->scene->face_count * POINTS * DIRECTIONS;
    return lit && !open;
}
