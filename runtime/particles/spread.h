/* spread.h - a density over the line from 0 to 1, constant between edges: where to look, and how
 * often one looked there.
 *
 * Invariant: edges and running sums rise; the last sum is 1 up to rounding. A spread without edges
 * is even.
 * SPDX-License-Identifier: MIT */
#ifndef SPREAD_H
#define SPREAD_H

#include <stdint.h>

struct spread {
    double *edge; /* [count + 1], from 0 to 1 */
    double *sum;  /* [count + 1]: what lies below the edge, from 0 to 1 */
    uint32_t count;
};

/* Between each two neighbours of the places[count] in [0, 1], which rise, there is an edge, and of
 * `weight` so much around each, or the same around all where NULL. weight: as a density when
 * `per_length`. Where all weigh nothing it is even. Returns 0, or -1 when out of memory. */
int spread_around(struct spread *s, const double *place, const double *weight, uint32_t count,
                  int per_length);
void spread_close(struct spread *s);

/* The place below which there is the share v in [0, 1). */
double spread_place(const struct spread *s, double v);

/* The density at u. */
double spread_density(const struct spread *s, double u);

#endif
