/* contact_fraction.c - which part of a surface lies inside a solid that stands on it, by rays.
 *
 * A point is covered when most rays from it, cosine-spread over its side, meet first the back of a
 * one-sided face: it is inside something. The share is that of a 4 x 4 grid of points, so it is off
 * by up to about half a cell along the edge of what stands there. Where nothing stands on a part
 * (standing.h) the middle is asked, and says it for all when it is outside. Not all rays need meet
 * backs: solids may reach into each other, and a ray along an edge may slip past. Solids of
 * two-sided faces have backs where their insides are known to be dark (dark_sides.h). [derived
 * here]
 * SPDX-License-Identifier: MIT */
#include "kernel/constants.h"
#include "kernel/hemisphere.h"
#include "kernel/surface_point.h"
#include "visibility/contact_fraction.h"
#include "visibility/standing.h"

enum { SIDE = 4 };

/* The rays from any point of e. */
static void look_around(const struct element *e, double direction[CONTACT_RAYS][3])
{
    const struct hemisphere above = hemisphere_over(e->normal);
    for (int m = 0; m < CONTACT_RAYS; m++)
        hemisphere_direction(direction[m], &above, m, CONTACT_RAYS, 0);
}

int contact_covers(const struct rays *rays, const struct element *e, const double p[3])
{
    double direction[CONTACT_RAYS][3];
    int inside = 0;
    look_around(e, direction);
    for (int m = 0; m < CONTACT_RAYS && inside + CONTACT_RAYS - m >= CONTACT_BACKS; m++)
        inside += rays_first(rays, p, direction[m], NULL, NULL) == RAY_MEETS_BACK;
    return inside >= CONTACT_BACKS;
}

/* As contact_covers for all points at once, direction by direction: rays side by side cost half. */
static double share_inside(const struct rays *rays, const struct element *e)
{
    double direction[CONTACT_RAYS][3], p[SIDE * SIDE][3];
    int inside[SIDE * SIDE] = {0}, covered = 0;
    unsigned open = (1u << SIDE * SIDE) - 1; /* points that are inside or not by rays to come */
    look_around(e, direction);
    for (int i = 0; i < SIDE * SIDE; i++) {
        surface_point(p[i], e, (i / SIDE + 0.5) / SIDE, (i % SIDE + 0.5) / SIDE);
        for (int k = 0; k < 3; k++)
            p[i][k] += rays_host(rays)->ray_offset * e->normal[k];
    }
    for (int m = 0; m < CONTACT_RAYS && open; m++) {
        unsigned backs = rays_meet_backs(rays, (const double(*)[3])p, open, direction[m]);
        for (int i = 0; i < SIDE * SIDE; i++) {
            inside[i] += (int)(backs >> i & 1);
            if (inside[i] >= CONTACT_BACKS || inside[i] + CONTACT_RAYS - 1 - m < CONTACT_BACKS)
                open &= ~(1u << i);
        }
    }
    for (int i = 0; i < SIDE * SIDE; i++)
        covered += inside[i] >= CONTACT_BACKS;
    return covered / (double)(SIDE * SIDE);
}

double contact_fraction(const struct rays *rays, const struct hierarchy *h, const struct element *e)
{
    const double off = rays_host(rays)->ray_offset;
    double middle[3];
    for (int k = 0; k < 3; k++)
        middle[k] = e->centre[k] + off * e->normal[k];
    return standing_may(h, e, off) || contact_covers(rays, e, middle) ? share_inside(rays, e) : 0;
}
