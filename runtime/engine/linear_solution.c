/* linear_solution.c - see linear_solution.h.
 * SPDX-License-Identifier: MIT */
#include "engine/linear_solution.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/linear_transport.h"
#include "util/clock.h"

/* Gradients of all surfaces from the slopes in their bases. */
static int make_gradients(struct linear_solution *s, const struct light_operator *op,
                          const struct linear_links *l, const struct linear_transport *x)
{
    const struct hierarchy *h = op->hierarchy;
    uint32_t bands = x->means->bands;
    double leaves = 0;
    s->gradient = calloc((size_t)h->count * bands * 3, sizeof *s->gradient);
    if (!s->gradient)
        return -1;
    s->lowered = s->weakened = 0;
    for (uint32_t i = 0; i < h->count; i++) {
        const struct element *e = &h->elements[i];
        int is_leaf = e->vertices && !e->children, lowered = 0;
        for (uint32_t k = 0; e->vertices && k < bands; k++) {
            size_t at = (size_t)i * bands + k;
            const double *slope = &x->value[2 * at];
            double mean = x->means->value[at], least, most;
            linear_basis_range(&l->basis[i], e, slope, &least, &most);
            double keep = !(mean > 0) ? 0 : mean + least < 0 ? mean / -least : 1;
            for (int c = 0; c < 3; c++)
                s->gradient[3 * at + (size_t)c] =
                    keep * (slope[0] * l->basis[i].g[0][c] + slope[1] * l->basis[i].g[1][c]);
            lowered |= keep < 1 && least < 0;
        }
        leaves += is_leaf ? e->area : 0;
        s->lowered += is_leaf && lowered ? e->area : 0;
        s->weakened += is_leaf && l->row[i].scale < 1 ? e->area : 0;
    }
    s->lowered /= leaves;
    s->weakened /= leaves;
    return 0;
}

/* Rows and sweeps, from constants. Returns 0, -1, or 1 when changes grow. */
static int solve_once(struct light_operator *op, struct linear_links *l, struct linear_transport *x,
                      struct row_report *rows)
{
    const struct problem *p = op->problem;
    size_t slopes = (size_t)op->hierarchy->count * x->means->bands * 2;
    memset(x->value, 0, slopes * sizeof *x->value);
    memset(x->irradiance, 0, slopes * sizeof *x->irradiance);
    separable_links_close(&op->separable);
    if (separable_links_open(&op->separable, op->hierarchy, op->refinement, (int)p->bands,
                             p->options.threads)
        < 0)
        return -1;
    row_sums_scale(op, rows);
    linear_links_scale(l, op);
    return linear_transport_solve(op, l, x);
}

int linear_solution_solve(struct linear_solution *s, struct light_operator *op, struct transport *x,
                          struct row_report *rows)
{
    double start = seconds();
    size_t slopes = (size_t)op->hierarchy->count * x->bands * 2;
    struct linear_links links;
    struct linear_transport linear = {.means = x,
                                      .value = malloc(slopes * sizeof *linear.value),
                                      .irradiance = malloc(slopes * sizeof *linear.irradiance)};
    int result = linear.value && linear.irradiance ? linear_links_open(&links, op) : -1;
    linear_solution_free(s);
    if (result == 0) {
        op->linear = &links;
        result = solve_once(op, &links, &linear, rows);
        s->sweeps = x->sweeps;
        if (result > 0) {
            linear_links_limit(&links);
            result = solve_once(op, &links, &linear, rows);
            s->sweeps += x->sweeps;
        }
        s->limited = links.limited;
        if (result == 0) {
            transport_average(op, x);
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
