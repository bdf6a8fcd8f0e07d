/* tools.h - what mesh.dag declares: three questions and a term.
 * SPDX-License-Identifier: MIT */
#ifndef TOOLS_H
#define TOOLS_H

#include "mesh.h"

static inline enum coarse_answer tool_coarse(struct discussion *d, int depth)
{
    return d->mesh->cells[d->cell].size > ldexp(1, -depth) ? COARSE_YES : COARSE_NO;
}

static inline enum graded_answer tool_graded(struct discussion *d)
{
    for (int side = 0; side < 4; side++)
        for (int half = 0; half < 2; half++) {
            int n = mesh_neighbour(d->mesh, d->cell, side, half);
            if (n >= 0 && d->mesh->cells[n].size < d->mesh->cells[d->cell].size / 2)
                return GRADED_NO;
        }
    return GRADED_YES;
}

/* How far u is from the straight line between the values across opposite sides, both ways. */
static inline double term_bend(struct discussion *d)
{
    if (d->terms.bend_level < BEND_PRESENT) {
        d->terms.bend = 0;
        for (int side = 0; side < 4; side += 2) {
            double a, b, before = mesh_across(d->mesh, d->cell, side, &a);
            double behind = mesh_across(d->mesh, d->cell, side + 1, &b);
            d->terms.bend += fabs(d->mesh->cells[d->cell].u - (before * b + behind * a) / (a + b));
        }
        d->terms.bend_level = BEND_PRESENT;
    }
    return d->terms.bend;
}

static inline enum bends_answer tool_bends(struct discussion *d, double most)
{
    return term_bend(d) > most ? BENDS_YES : BENDS_NO;
}

#endif
