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
#include <math.h>
#include "enclosure.h"

enum { SIDE = 4, POINTS = SIDE * SIDE, DIRECTIONS = 64, BURIED = DIRECTIONS / 4 * 3 };

/* Two unit vectors across the unit vector n, the first square to the axis that is most across it. */
static void frame(const double n[3], double u[3], double v[3])
{
    int axis = fabs(n[0]) <= fabs(n[1]) ? fabs(n[0]) <= fabs(n[2]) ? 0 : 2 : fabs(n[1]) <= fabs(n[2]) ? 1 : 2, k;
    double size;
    u[0] = u[1] = u[2] = 0;
    u[axis] = 1;
    cross3(v, n, u);
    size = length3(v);
    for (k = 0; k < 3; k++)
        v[k] /= size;
    cross3(u, v, n);
}

/* Point (s, t) of the unit square mapped to the face so that area is kept, a ray's offset in front of it. */
static void face_point(const struct element *e, double s, double t, double offset, double p[3])
{
    int k;
    if (e->vertices == 3)
        s = sqrt(s);
    for (k = 0; k < 3; k++) {
        const double a = e->vertex[0][k], b = e->vertex[1][k], c = e->vertex[2][k], d = e->vertex[3][k];
        p[k] = e->vertices == 3 ? a + s * (b - a) + s * t * (c - b)
                                : (1 - t) * (a + s * (b - a)) + t * (d + s * (c - d));
        p[k] += offset * e->normal[k];
    }
}

struct fates enclosure_look(const struct rays *rays, const struct element *e)
{
    struct fates all = { 0, 0, 0, 0 };
    double u[3], v[3], offset = rays_host(rays)->ray_offset;
    int i, m, k;
    frame(e->normal, u, v);
    for (i = 0; i < POINTS; i++) {
        double p[3];
        int met[3] = { 0, 0, 0 };
        face_point(e, (i % SIDE + 0.5) / SIDE, (i / SIDE + 0.5) / SIDE, offset, p);
        for (m = 0; m < DIRECTIONS; m++) { /* a spiral of golden angles, turned a little from point to point */
            double angle = 2.39996322972865332 * (m + i / (double)POINTS), r = sqrt((m + 0.5) / DIRECTIONS), z = sqrt(1 - r * r);
            double d[3];
            for (k = 0; k < 3; k++)
                d[k] = z * e->normal[k] + r * (cos(angle) * u[k] + sin(angle) * v[k]);
            met[rays_first(rays, p, d)]++;
        }
        if (met[RAY_MEETS_BACK] >= BURIED) {
            all.buried += DIRECTIONS;
            continue;
        }
        all.fronts += met[RAY_MEETS_FRONT];
        all.leaves += met[RAY_LEAVES];
        all.backs += met[RAY_MEETS_BACK];
    }
    return all;
}

int enclosure_decide(struct solve *s)
{
    uint32_t i;
    int open = 0, lit = 0;
#pragma omp parallel for schedule(dynamic, 16) num_threads(s->options.threads) reduction(| : open, lit)
    for (i = 0; i < s->scene->face_count; i++) {
        struct fates f = enclosure_look(s->rays, &s->hierarchy.elements[s->hierarchy.face_element[i]]);
        open |= f.leaves + f.backs > 0 && f.fronts > 0;
        lit |= f.fronts > 0;
    }
    s->closed_rays = (uint64_t)s->scene->face_count * POINTS * DIRECTIONS;
    return lit && !open;
}
