/* factor_closure.c - make rows of view factors sum to what they should.
 *
 * rows: each row by its own factor; A_i F_ij = A_j F_ji is lost.
 * reciprocal: the symmetric matrix nearest to the exchange areas E = A_i F_ij, in relative entropy, whose rows sum to A_i: it is
 *     E'_ij = d_i d_j E_ij,   d_i sum_j E_ij d_j = A_i,
 * found by d_i <- sqrt(d_i A_i / sum_j E_ij d_j). Zeros stay zeros, nothing gets negative, the two ways round stay one number, and
 * to first order it is the least-squares correction with weights E_ij of Larsen & Howell 1986 and Lawson 1995.
 * [van Leersum 1989 for view factors; scaling: Sinkhorn 1964, symmetric and by square roots Knight, Ruiz & Ucar 2014]
 * A row that may sum to less has d_i <= 1, and less only where its sum would be above its area.
 * Fails where no such matrix exists, as for two faces of different size that see only each other: `left` then says what is missing.
 * SPDX-License-Identifier: MIT */
#include "engine/exchange_closure.h"

#include <math.h>
#include <stdlib.h>

const char *const factor_closure_names[FACTOR_CLOSURES] = { "none", "rows", "reciprocal" };

enum { ITERATIONS = 500 };
#define ENOUGH 1e-12

static void by_rows(struct factor_closure *c, const struct factor_matrix *m, const double *sums, const struct factor_sky *sky)
{
    uint32_t i;
    for (i = 0; i < m->inputs; i++)
        if (sums[i] > 0 && (factor_sky_closed(&sky[i]) || sums[i] > m->area[i])) {
            c->scale[i] = m->area[i] / sums[i];
            c->most = fmax(c->most, fabs(c->scale[i] - 1));
        }
}

static int reciprocal(struct factor_closure *c, const struct factor_matrix *m, const struct factor_sky *sky)
{
    double *sums = malloc((m->inputs + 1) * sizeof *sums), low = 1, high = 1;
    uint32_t i;
    if (!sums)
        return -1;
    for (;; c->iterations++) {
        c->left = 0;
        factor_matrix_sums(m, c->scale, sums);
        for (i = 0; i < m->inputs; i++)
            if (sums[i] > 0) {
                double sum = c->scale[i] * sums[i] / m->area[i];
                int closed = factor_sky_closed(&sky[i]);
                if (closed || sum > 1)
                    c->left = fmax(c->left, fabs(1 - sum));
            }
        if (c->left <= ENOUGH || c->iterations == ITERATIONS)
            break;
        for (i = 0; i < m->inputs; i++)
            if (sums[i] > 0) {
                double d = sqrt(c->scale[i] * m->area[i] / sums[i]);
                c->scale[i] = factor_sky_closed(&sky[i]) || d < 1 ? d : 1;
            }
    }
    for (i = 0; i < m->inputs; i++) {
        low = fmin(low, c->scale[i]);
        high = fmax(high, c->scale[i]);
    }
    c->most = fmax(high * high - 1, 1 - low * low);
    free(sums);
    return 0;
}

int factor_closure_make(struct factor_closure *c, enum factor_closure_kind kind, const struct factor_matrix *m, const double *sums,
                        const struct factor_sky *sky)
{
    uint32_t i;
    *c = (struct factor_closure){ 0 };
    if (kind == FACTOR_CLOSURE_NONE)
        return 0;
    c->scale = malloc((m->inputs + 1) * sizeof *c->scale);
    if (!c->scale)
        return -1;
    for (i = 0; i < m->inputs; i++)
        c->scale[i] = 1;
    c->both = kind == FACTOR_CLOSURE_RECIPROCAL;
    if (!c->both)
        by_rows(c, m, sums, sky);
    else if (reciprocal(c, m, sky) < 0) {
        factor_closure_free(c);
        return -1;
    }
    return 0;
}

void factor_closure_free(struct factor_closure *c)
{
    free(c->scale);
    *c = (struct factor_closure){ 0 };
}
