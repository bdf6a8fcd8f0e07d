/* sight_look.c - what points of one face see of another past what stands between.
 *
 * Solids, if nothing else stands between, are looked past by the rims of their shadows, unless
 * rounding leaves open where these run (sight_rims.h). Else outlines save most where faces go on
 * into each other (sight_outlines.h); faces by themselves, and bent ones, are cut out one by one
 * (sight_pieces.h). Many faces leave parts that each meet few of them, and many edges part what is
 * hidden, too. Invariant: which way is taken changes what is told by rounding alone.
 * SPDX-License-Identifier: MIT */
#include "engine/sight_look.h"
#include "engine/sight_outlines.h"
#include "engine/sight_rims.h"

/* By solids no more than can be cut out, which a point does that these do not tell. */
int sight_look_place(struct sight_look *l)
{
    struct sight_between *b = l->between;
    l->by_bodies = !b->bent && b->faces <= SIGHT_CUT
                   && sight_bodies_place(l->bodies, l->tree, b->list, b->faces, &l->sight.raised);
    return l->by_bodies ? 0 : sight_between_place(b, l->tree, &l->sight);
}

/* Are outlines sooner cut by than faces, one by one? Edges of two faces; those that are outlines
 * from anywhere count twice, as half of the others are, about. Measured: triangles that cross each
 * other take three quarters of the time. Of bodies no edges are placed. */
static int is_by_outlines(const struct sight_between *b)
{
    const int most = b->faces > SIGHT_SHORT && b->faces <= SIGHT_CUT ? 3 : 4,
              edges = b->faces <= SIGHT_CUT ? b->edges + b->loose : b->edges;
    return !b->bent && 2 * edges <= most * b->faces;
}

static double past_faces(const struct sight_look *l, const double x[3], const double n[3],
                         double *whole)
{
    struct sight_between *b = l->between;
    const double up = l->tree->lift;
    if (l->by_bodies) {
        const double seen = sight_rims_past(&l->sight, x, n, up, l->bodies, whole);
        if (seen >= 0)
            return seen;
    } else if (is_by_outlines(b))
        return sight_past(&l->sight, x, n, up, b, whole);
    return sight_factor(&l->sight, x, n, up, l->tree, b->list, b->faces, whole);
}

/* Faces in the plane of an end stand before nothing there, as rays start beyond them. A solid that
 * joins both ends has one in the plane of each, and from where it stands only its sides would stop
 * what goes through it; so points in it see nothing. */
double sight_look_from(const struct sight_look *l, const double x[3], const double n[3],
                       double *whole)
{
    const double seen = past_faces(l, x, n, whole), up = l->tree->host.ray_offset;
    const double over[3] = {x[0] + up * n[0], x[1] + up * n[1], x[2] + up * n[2]};
    return l->joined && bodies_hold(&l->tree->bodies, &l->tree->h, l->on, over) ? 0 : seen;
}
