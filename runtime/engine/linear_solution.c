/* linear_solution.c - see linear_solution.h.
 *
 * Light below 0. The couplings of a mean over a large emitter may be negative in a corner of it,
 * and bring less than nothing to a small receiver where all light of the emitter is in that corner.
 * Then the links of that leaf and of what it is part of are limited, and the solve goes on from
 * where it is, until no irradiance of a leaf is negative. What is left may be so at corners: there
 * the gradient is made less, and the mean stays.
 * SPDX-License-Identifier: MIT */
#include "engine/linear_solution.h"

#include <stdlib.h>
#include <string.h>
#include "engine/linear_transport.h"
#include "kernel/constants.h"
#include "util/clock.h"

/* Gradients of all surfaces from the slopes in their bases. */
static int make_gradients(struct linear_solution *s, const struct light_operator *op,
                          const struct linear_links *l, const struct linear_transport *x)
{
    const struct hierarchy *h = op->hierarchy;
    uint32_t bands = x->means->bands;
    double leaves = 0;
    s->gradient = calloc((size_t)h->count * bands * 3, sizeof *s->gradient);
    if (ranks_any(op->shares.ranks, !s->gradient))
        return -1;
    s->lowered = s->flat = 0;
    for (uint32_t i = 0; i < h->count; i++) {
        const struct element *e = &h->elements[i];
        int is_leaf = e->vertices && !e->children, lowered = 0;
        for (uint32_t k = 0; e->vertices && k < bands; k++) {
            size_t at = (size_t)i * bands + k;
            const double *slope = &x->value[3 * at + 1];
            double emitted = op->problem->exitance[(size_t)e->face * bands + k],
                   reflected = x->means->value[at] - emitted, least, most;
            linear_basis_range(&l->basis[i], e, slope, &least, &most);
            double keep = !(reflected > 0) ? 0 : reflected + least < 0 ? reflected / -least : 1;
            for (int c = 0; c < 3; c++)
                s->gradient[3 * at + (size_t)c] =
                    keep * (slope[0] * l->basis[i].g[0][c] + slope[1] * l->basis[i].g[1][c]);
            lowered |= keep < 1 && least < 0;
        }
        leaves += is_leaf ? e->area : 0;
        s->lowered += is_leaf && lowered ? e->area : 0;
        s->flat += is_leaf && op->uncovered[i] < 1 ? e->area : 0;
    }
    s->lowered /= leaves;
    s->flat /= leaves;
    return 0;
}

/* Sweeps from what there is. Returns 0, -1, or 1 when changes grow. */
static int sweep_more(struct linear_solution *s, const struct light_operator *op,
                      const struct linear_links *l, struct linear_transport *x)
{
    int result = linear_transport_solve(op, l, x);
    s->sweeps += x->means->sweeps;
    return result;
}

/* Rows and sweeps from what there is. Returns 0, -1, or 1 when changes grow. */
static int solve_once(struct linear_solution *s, struct light_operator *op, struct linear_links *l,
                      struct linear_transport *x, struct row_report *rows)
{
    if (row_sums_renew(op, rows) < 0)
        return -1;
    linear_links_scale(l, op);
    return sweep_more(s, op, l, x);
}

/* Limit the links that bring light to leaves whose irradiance is below 0. Returns how many were
 * not limited yet, or -1 when out of memory. */
static int64_t limit_negative(struct linear_links *l, const struct light_operator *op,
                              const struct transport *x)
{
    const struct element *elements = op->hierarchy->elements;
    unsigned char *marked = calloc(op->hierarchy->count, sizeof *marked);
    int any = 0;
    if (ranks_any(op->shares.ranks, !marked)) {
        free(marked);
        return -1;
    }
    for (uint32_t i = 0; i < op->hierarchy->count; i++)
        for (uint32_t k = 0; elements[i].vertices && !elements[i].children && k < x->bands
                             && shares_mine(&op->shares, i);
             k++)
            if (x->irradiance[(size_t)i * x->bands + k] < 0) {
                any = 1;
                marked[i] = 1;
                for (uint32_t up = i; elements[up].depth > 0; up = elements[up].parent)
                    marked[elements[up].parent] = 1;
            }
    size_t made = ranks_any(op->shares.ranks, any) ? linear_links_limit(l, marked) : 0;
    free(marked);
    return (int64_t)made;
}

/* Solve, and again while light is negative or sweeps do not converge, with links limited where
 * they must be: roughly as long as some must, then to the tolerance. Returns 0 or -1. */
static int solve_links(struct linear_solution *s, struct light_operator *op, struct linear_links *l,
                       struct linear_transport *x, struct row_report *rows)
{
    size_t values = (size_t)op->hierarchy->count * x->means->bands * 3;
    double tolerance = x->means->tolerance;
    int limited = 1; /* links since the rows were summed; the first time all are new */
    linear_transport_start(op, l, x);
    for (int rough = tolerance < ROUGH_TOLERANCE;;) {
        x->means->tolerance = rough ? ROUGH_TOLERANCE : tolerance;
        int result = limited ? solve_once(s, op, l, x, rows) : sweep_more(s, op, l, x);
        if (result < 0)
            return -1;
        limited = 1;
        if (result > 0) {
            memset(x->value, 0, values * sizeof *x->value);
            linear_transport_start(op, l, x);
            s->limited += linear_links_limit(l, NULL);
            continue;
        }
        int64_t made = limit_negative(l, op, x->means);
        if (made < 0)
            return -1;
        s->limited += (uint64_t)made;
        limited = made > 0;
        if (!limited && !rough)
            return 0;
        rough = rough && limited;
    }
}

int linear_solution_solve(struct linear_solution *s, struct light_operator *op, struct transport *x,
                          struct row_report *rows)
{
    double start = seconds();
    size_t values = (size_t)op->hierarchy->count * x->bands;
    struct linear_links links;
    struct linear_transport linear = {.means = x,
                                      .value = calloc(3 * values, sizeof *linear.value),
                                      .irradiance = calloc(2 * values, sizeof *linear.irradiance)};
    int result = ranks_any(op->shares.ranks, !linear.value || !linear.irradiance)
                     ? -1
                     : linear_links_open(&links, op);
    linear_solution_free(s);
    if (result == 0) {
        op->linear = &links;
        result = solve_links(s, op, &links, &linear, rows);
        if (result == 0)
            result = shares_complete(&op->shares, linear.value, 3 * (size_t)x->bands);
        if (result == 0)
            result = shares_complete(&op->shares, x->value, x->bands);
        if (result == 0)
            result = shares_complete(&op->shares, x->irradiance, x->bands);
        if (result == 0) {
            transport_average(op, x);
            linear_transport_start(op, &links, &linear);
            result = make_gradients(s, op, &links, &linear);
        }
        op->linear = NULL;
        linear_links_close(&links);
    }
    free(linear.value);
    free(linear.irradiance);
    s->seconds = seconds() - start;
    return result;
}

void linear_solution_free(struct linear_solution *s)
{
    free(s->gradient);
    memset(s, 0, sizeof *s);
}
