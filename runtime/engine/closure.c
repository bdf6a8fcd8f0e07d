/* closure.c - rows that sum to what they should.
 *
 * rows: each row by its own factor; A_i F_ij = A_j F_ji is lost.
 * reciprocal: the symmetric matrix nearest to the exchange areas E = A_i F_ij, in relative entropy,
 * whose rows sum to A_i: it is
 *     E'_ij = d_i d_j E_ij,   d_i sum_j E_ij d_j = A_i,
 * found by d_i <- sqrt(d_i A_i / sum_j E_ij d_j). Zeros stay zeros, nothing gets negative, the two
 * ways round stay one number, and to first order it is the least-squares correction with weights
 * E_ij of Larsen & Howell 1986 and Lawson 1995.
 * [van Leersum 1989 for view factors; scaling: Sinkhorn 1964, symmetric and by square roots Knight,
 * Ruiz & Ucar 2014] A row that may sum to less has d_i <= 1, and less only where its sum would be
 * above its area.
 * Fails where no such matrix exists, as for two faces of different size that see only each other:
 * `left` then says what is missing.
 * SPDX-License-Identifier: MIT */
#include "engine/closure.h"

#include <math.h>
#include <stdlib.h>
#include "engine/exchange_product.h"
#include "kernel/constants.h"

enum { ITERATIONS = 500 };

double closure_row_scale(double sum, double whole, int closed)
{
    return sum > 0 && (closed || sum > whole) ? whole / sum : 1;
}

static void close_rows(struct exchange_closure *c, const struct exchange_areas *m,
                       const double *sums, const unsigned char *closed)
{
    for (uint32_t i = 0; i < m->inputs; i++) {
        c->scale[i] = closure_row_scale(sums[i], m->area[i], closed[i]);
        c->change = fmax(c->change, fabs(c->scale[i] - 1));
    }
}

static int close_both_ways(struct exchange_closure *c, const struct exchange_areas *m, int threads,
                           const unsigned char *closed)
{
    double *sums = malloc((m->inputs + 1) * sizeof *sums), low = 1, high = 1;
    if (ranks_any(m->ranks, !sums)) {
        free(sums);
        return -1;
    }
    for (;; c->iterations++) {
        c->left = 0;
        if (exchange_sums(m, threads, c->scale, sums) < 0) {
            free(sums);
            return -1;
        }
        for (uint32_t i = 0; i < m->inputs; i++)
            if (sums[i] > 0) {
                double sum = c->scale[i] * sums[i] / m->area[i];
                if (closed[i] || sum > 1)
                    c->left = fmax(c->left, fabs(1 - sum));
            }
        if (c->left <= CLOSURE_ENOUGH || c->iterations == ITERATIONS)
            break;
        for (uint32_t i = 0; i < m->inputs; i++)
            if (sums[i] > 0) {
                double d = sqrt(c->scale[i] * m->area[i] / sums[i]);
                c->scale[i] = closed[i] || d < 1 ? d : 1;
            }
    }
    for (uint32_t i = 0; i < m->inputs; i++) {
        low = fmin(low, c->scale[i]);
        high = fmax(high, c->scale[i]);
    }
    c->change = fmax(high * high - 1, 1 - low * low);
    free(sums);
    return 0;
}

int exchange_closure_make(struct exchange_closure *c, enum closure kind,
                          const struct exchange_areas *m, int threads, const double *sums,
                          const unsigned char *closed)
{
    *c = (struct exchange_closure){0};
    if (kind == CLOSURE_NONE)
        return 0;
    c->scale = malloc((m->inputs + 1) * sizeof *c->scale);
    if (ranks_any(m->ranks, !c->scale)) {
        exchange_closure_free(c);
        return -1;
    }
    for (uint32_t i = 0; i < m->inputs; i++)
        c->scale[i] = 1;
    c->both = kind == CLOSURE_RECIPROCAL;
    if (!c->both)
        close_rows(c, m, sums, closed);
    else if (close_both_ways(c, m, threads, closed) < 0) {
        exchange_closure_free(c);
        return -1;
    }
    return 0;
}

void exchange_closure_free(struct exchange_closure *c)
{
    free(c->scale);
    *c = (struct exchange_closure){0};
}
