/* exchange_contacts.c - see exchange_contacts.h.
 *
 * Two faces that lie on each other, the one's front on the other's, see nothing there; those that
 * lie back to back, as walls drawn from both sides, see all. Which it is their planes do not tell:
 * it is the one if over one of them is something solid, whose backs rays from there meet. A ray
 * that ends where two faces lie on each other tells nothing, for it may be told either of the two.
 * Rays are as many low as steep, for under a plate only low ones meet its rim. Close behind a lamp
 * all meet its back, too, though nothing is solid there; so what is said to end there, a face of no
 * convex solid, is also asked whether anything goes on behind it (body_rim.h). [derived here]
 * SPDX-License-Identifier: MIT */
#include "engine/exchange_contacts.h"
#include <math.h>
#include <stdlib.h>
#include "hierarchy/body_contacts.h"
#include "hierarchy/body_feet.h"
#include "hierarchy/body_rest.h"
#include "hierarchy/body_rim.h"
#include "kernel/hemisphere.h"
#include "kernel/lambert.h"

/* Of rays around a point. Chosen: from the middle of a disc the lowest meet its rim where it is 64
 * times as wide as thick. */
enum { AROUND = 8, RISES = 3 };
static const double RISE[RISES] = {1, 1.0 / 8, 1.0 / 32};

/* How wide a place is around where a ray ends, by how near faces are to lie on each other, so that
 * what lies there has something of it. Chosen. */
static const double PLACE = 8;

/* Of the rays, so many meet backs within something solid: all do, but for those to the fronts of
 * what reaches into it, as a box by a micrometre into its neighbour; and outside of what is closed
 * none does. Midway; chosen. */
static const double MOST_BACKS = 0.5;

/* Does a face that looks against n lie where a ray met one that looks along it? */
static int is_double(const struct hierarchy *h, const double at[3], const double n[3])
{
    const struct hemisphere over = hemisphere_over(n);
    struct shell_lid place;
    place.n = 3;
    for (int k = 0; k < 3; k++) {
        place.corner[0][k] = at[k] + PLACE * h->flat * over.u[k];
        place.corner[1][k] = at[k] + PLACE * h->flat * over.v[k];
        place.corner[2][k] = at[k] - PLACE * h->flat * over.u[k];
        place.normal[k] = n[k];
    }
    return body_rest_on_lid(h, &place);
}

/* Is what lies over that point of a face solid? */
static int is_solid_over(const struct exchange_tree *t, const struct element *e, const double p[3])
{
    const double up = rays_host(t->rays)->ray_offset;
    double from[3], u[3], v[3];
    int told = 0, backs = 0;
    sub3(u, e->vertex[1], e->vertex[0]);
    const double length = length3(u);
    for (int k = 0; k < 3; k++) {
        from[k] = p[k] + up * e->normal[k];
        u[k] /= length;
    }
    cross3(v, e->normal, u);
    for (int i = 0; i < AROUND * RISES; i++) {
        const double turn = 2 * LAMBERT_PI * (i % AROUND + 0.5) / AROUND, rise = RISE[i / AROUND];
        double direction[3], at[3], normal[3] = {0, 0, 0};
        for (int k = 0; k < 3; k++)
            direction[k] = cos(turn) * u[k] + sin(turn) * v[k] + rise * e->normal[k];
        const enum ray_fate fate = rays_first(t->rays, from, direction, at, normal);
        const int turned = (dot3(normal, direction) > 0) != (fate == RAY_MEETS_BACK);
        for (int k = 0; k < 3; k++)
            normal[k] *= turned ? -1 : 1; /* its front's */
        if (fate != RAY_LEAVES && is_double(&t->h, at, normal))
            continue;
        told++;
        backs += fate == RAY_MEETS_BACK;
    }
    return told > 0 && backs >= MOST_BACKS * told;
}

/* Is a face a side of something solid? Of back sides nothing is known. Returns 1 or 0, or -1 when
 * out of memory. */
static int ends_solid(const struct exchange_tree *t, struct body_rim *rim, uint32_t face)
{
    return t->bodies.whose[face] || t->h.faces[t->h.elements[face].face].back
               ? 1
               : body_rim_goes_back(rim, &t->h, face);
}

/* Is there something solid between two faces, on one of them? Returns 0, or -1 when out of memory.
 */
static int judge(const struct exchange_tree *t, struct body_rim *rim, struct body_contact *c)
{
    for (int k = 0; k < 2 && !c->solid; k++) {
        const int solid = is_solid_over(t, &t->h.elements[c->face[k]], c->middle)
                              ? ends_solid(t, rim, c->face[1 - k])
                              : 0;
        if (solid < 0)
            return -1;
        c->solid = solid;
    }
    return 0;
}

int exchange_contacts_find(struct exchange_tree *t)
{
    struct body_contacts all = {NULL, 0, 0};
    struct body_rim rim;
    int status = body_rim_open(&rim, &t->h);
    status = status == 0 ? body_contacts_find(&all, &t->bodies, &t->h) : status;
    for (size_t i = 0; i < all.count && status == 0; i++)
        status = judge(t, &rim, &all.list[i]);
    if (status == 0 && all.count > 0)
        status = body_feet_contacts(&t->bodies, all.list, all.count);
    free(all.list);
    body_rim_close(&rim);
    return status;
}
