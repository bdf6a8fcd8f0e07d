/* greedy.h - how few links an open, convex arrangement of rectangles can do with.
 *
 * Each rectangle is a grid of cells, over which its light is known: B = E + rho K B, solved on the
 * cells, K from a cell's centre to a whole cell by Lambert's formula. Links are then taken
 * for pairs of squares of cells, as a hierarchy has them: one for each pair of faces to begin with,
 * and whichever split of a receiver or an emitter lowers the error most for each link that it adds
 * is next. What a link brings is projected on constants or linear functions over the receiver, and
 * so is the radiosity of its emitter, which is the true one. Errors of links add with their signs.
 * Which split is best can be judged by that sum, where what cancels costs nothing, or by each
 * link's error alone, as an oracle does that knows of one pair at a time. The first way finds the
 * one element that an empty white cube needs of each face, but may end where no split by itself is
 * a gain; the second goes on: what is fewer is the greedy optimum. Source: greedy trees of adaptive
 * approximation (Cohen, Dahmen, DeVore 2001), over pairs.
 * SPDX-License-Identifier: MIT */
#ifndef GREEDY_H
#define GREEDY_H

#include <stddef.h>

enum greedy_norm { GREEDY_L1, GREEDY_L2, GREEDY_NORMS };
enum { GREEDY_FACES = 6, GREEDY_CELLS = 512 }; /* at the most; cells along a side, 2^k */

/* The rectangle corner, corner + a, corner + a + b, corner + b; its front is where a x b points. */
struct greedy_face {
    double corner[3], a[3], b[3]; /* m */
    int cells;                    /* along each side */
    double rho, exitance;         /* W/m2 */
};

struct greedy {
    struct greedy_face face[GREEDY_FACES];
    int count;
    double *radiosity[GREEDY_FACES]; /* [cells^2], W/m2 */
    /* from the centre of each cell of i to each cell of j; NULL: no light goes there */
    float *kernel[GREEDY_FACES][GREEDY_FACES];
};

/* Solve the scene. Returns 0, or -1 when out of memory; to be closed in any case. */
int greedy_open(struct greedy *g, const struct greedy_face *faces, int count);
void greedy_close(struct greedy *g);

/* The centre of a cell. */
void greedy_centre(const struct greedy_face *f, int cell, double p[3]);

/* Norm of B - E over all cells: W, W/m. */
double greedy_reflected(const struct greedy *g, enum greedy_norm norm);
/* The same of what is off by `wrong`, per face [cells^2], W/m2. */
double greedy_norm_of(const struct greedy *g, double *const *wrong, enum greedy_norm norm);

struct greedy_step {
    size_t links;
    double error; /* W, W/m */
};
/* Error against links while these rise to `most`: steps[0] is that of whole faces. `alone`: splits
 * are judged by their link alone. At most
 * most / 3 + 1 steps. Returns their number, or -1 when out of memory. */
int greedy_run(const struct greedy *g, enum greedy_norm norm, int linear, int alone, size_t most,
               struct greedy_step *steps);

#endif
