/* variation.c - what constants on leaves leave of x, by how it steps from leaf to leaf.
 *
 * In a leaf of size h x varies by |g| h / 2 about its mean to either side, g the gradient, along
 * each direction; the four children of an element of size 2h lie as far from the mean of all, at
 * their middles. So the largest |x_child - x_parent| among siblings is, to first order, the largest
 * deviation within each of them, and costs no look at a link. residual.c's d, which evaluates every
 * link at five points of every leaf, costs 140 to 380 sweeps (cornell, room, panels, maze_8), and
 * the few sweeps that are spared are four.
 *
 * Fails to the careful side: a face that is not divided says nothing of itself and counts as 0, so
 * iteration goes on for longer.
 * [derived here; by what it stops iteration: Arvo et al. 1994, section 6.3]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "engine/variation.h"
#include "kernel/constants.h"

double variation_of(const struct light_operator *op, const struct transport *x)
{
    const struct hierarchy *h = op->hierarchy;
    uint32_t b = x->bands;
    double steps = 0, power = 0;
    for (uint32_t i = 0; i < h->count; i++) {
        const struct element *e = &h->elements[i];
        double leaves = 0;
        if (!e->vertices || !shares_mine(&op->shares, i))
            continue;
        if (e->depth == 0)
            for (uint32_t k = 0; k < b; k++)
                power += e->area * op->uncovered[i] * x->value[(size_t)i * b + k];
        for (int c = 0; c < e->children; c++) {
            uint32_t j = e->child + (uint32_t)c;
            leaves += h->elements[j].children ? 0 : h->elements[j].area * op->uncovered[j];
        }
        for (uint32_t k = 0; k < b && leaves > 0; k++) {
            double most = 0;
            for (int c = 0; c < e->children; c++) {
                size_t j = e->child + (uint32_t)c;
                if (op->uncovered[j] > 0)
                    most = fmax(most, fabs(x->value[j * b + k] - x->value[(size_t)i * b + k]));
            }
            steps += leaves * most;
        }
    }
    double sums[] = {steps, power};
    ranks_add(op->shares.ranks, RANKS_SWEEPS, sums, 2);
    return sums[1] > 0 ? sums[0] / sums[1] : 0;
}

double variation_tolerance(double variation)
{
    return fmin(fmax(SOLVE_SHARE * variation, SOLVE_TOLERANCE), SOLVE_TOLERANCE_MOST);
}
