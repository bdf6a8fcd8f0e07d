/* best_squares.c - see best_squares.h. Gradients are differences of neighbouring cells, over two
 * cells but at a face's rim.
 * SPDX-License-Identifier: MIT */
#include "study/best_squares.h"

#include <math.h>

#include "geometry.h"

/* The change of B from cell to cell along one side (W/m2), at place i of `cells` that stand
 * `stride` apart. */
static double slope(const double *b, int i, int cells, int stride)
{
    int before = i > 0, after = i < cells - 1;
    return before + after == 0 ? 0 : (b[after * stride] - b[-(before * stride)]) / (before + after);
}

/* What a square of side 1 is off by in the mean, W/m2 for each m. */
static double error_of(enum greedy_norm norm, double p, double q)
{
    double a = fmax(fabs(p), fabs(q)), b = fmin(fabs(p), fabs(q));
    if (norm == GREEDY_L2)
        return sqrt((a * a + b * b) / 12);
    return a > 0 ? a / 4 + b * b / (12 * a) : 0;
}

double best_squares(const struct greedy *g, enum greedy_norm norm)
{
    double sum = 0;
    for (int i = 0; i < g->count; i++) {
        const struct greedy_face *f = &g->face[i];
        const int n = f->cells;
        const double along = length3(f->a) / n, across = length3(f->b) / n;
        for (int k = 0; k < n * n; k++) {
            const double *b = g->radiosity[i] + k;
            double e =
                error_of(norm, slope(b, k % n, n, 1) / along, slope(b, k / n, n, n) / across);
            sum += (norm == GREEDY_L1 ? cbrt(e * e) : e) * along * across;
        }
    }
    return norm == GREEDY_L1 ? sum * sqrt(sum) : sum;
}
