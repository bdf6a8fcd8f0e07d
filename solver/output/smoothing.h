/* smoothing.h - values at vertices, without what in them is as good as noise.
 *
 * What is gathered at corners is noisy, and an eye sees in a wall that should be even what no
 * table shows: one percent that goes up and down over a few elements. So values are averaged over
 * wider and wider neighbourhoods, and of what each step takes off that is given back which stands
 * out of what it takes off a field of mere noise, in squares and in the mean round about: all of a
 * shadow's edge, next to nothing of an even wall. [undecimated wavelets: Starck and Murtagh 1994;
 * by blocks: Cai 1999; this share, the garrote: Gao 1998]
 *
 * A vertex is averaged with what lies on a line through it alone, a neighbour on either side, each
 * by its distance: so what is linear stays as it is, also on the border of a face.
 *
 * Fails: detail as faint as the noise is lost with it. A corner of a face has no line, and stays.
 * SPDX-License-Identifier: MIT */
#ifndef SMOOTHING_H
#define SMOOTHING_H

#include "output/solution.h"
#include "output/vertex_values.h"

/* noise[vertex]: what the value, all bands together, would be by chance if it were 0, with whatever
 * neighbours have in common; NAN: not known, the vertex stays and nothing is averaged with it.
 * Returns 0, or -1 when out of memory: then the values are of no use. */
int smoothing_apply(struct vertex_values *v, const struct solution *solution, const double *noise);

#endif
