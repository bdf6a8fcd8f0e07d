/* best_squares.h - the least error that constants over many squares can have, by formula.
 *
 * Where B has the gradient (p, q) along the sides of a square of side h, its mean is off by
 *     L1: h e, e = a / 4 + b^2 / (12 a), a >= b the larger and the smaller of |p| and |q|,
 *     L2: h e, e^2 = (p^2 + q^2) / 12,
 * in the mean over the square. With N squares in all, N = int h^-2 dA, the sum of that is least for
 * h ~ e^(-1/3) (L1) and h ~ e^(-1/2) (L2):
 *     L1: (int e^(2/3) dA)^(3/2) / sqrt N,    L2: int e dA / sqrt N.
 * True of many squares of any size at any place, so that no quadtree is better; of few it may be,
 * as light bends, and of squares near a cell's size, over which greedy.h knows one value. A link
 * serves one receiver, so there are no more parts than links: the same with links for N holds of
 * links. [Lagrange; D: derived here]
 * SPDX-License-Identifier: MIT */
#ifndef BEST_SQUARES_H
#define BEST_SQUARES_H

#include "study/greedy.h"

/* The numerator above, of the light of all cells: W, W/m. Divided by the root of how many squares
 * or links there are it is their least error. */
double best_squares(const struct greedy *g, enum greedy_norm norm);

#endif
