/* linear_solution.h - radiosity linear over each element, solved once over the final links.
 *
 * While links are refined the solution is constant: oracles judge by means. The last links are
 * solved over again with slopes, from there on; the means move, too, for what an element sends is
 * no longer the same all over it.
 * SPDX-License-Identifier: MIT */
#ifndef LINEAR_SOLUTION_H
#define LINEAR_SOLUTION_H

#include "engine/linear_links.h"
#include "engine/row_sums.h"
#include "engine/transport.h"

struct linear_solution {
    /* [(element * bands + band) * 3]: B(x) = mean + gradient . (x - centroid) on a surface
     * (W/m2 per m); NULL: there is none. Made less where B would be below 0 at a corner, so that
     * the mean stays */
    double *gradient;
    int sweeps;
    /* links whose kernels were made nonnegative, for they brought negative light or sweeps did not
     * converge */
    uint64_t limited;
    /* shares of the leaves' area: constant, for a solid covers a part; gradients made less, for B
     * would be below 0 */
    double flat, lowered;
    double seconds;
};

/* Solve over the operator's links, from the means that x begins with; value and irradiance of x
 * are means of surfaces and clusters then, the operator's separable links and row scales those of
 * this solve. Returns 0, or -1 when out of memory or stopped by x->watch. */
int linear_solution_solve(struct linear_solution *s, struct light_operator *op, struct transport *x,
                          struct row_report *rows);
void linear_solution_free(struct linear_solution *s);

#endif
