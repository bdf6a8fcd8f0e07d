/* error_control.c - the solver tells the oracle how large the error of one link may be at each
 * receiver.
 *
 * A link's share in the error of a radiosity depends on how many others there are and on their
 * signs, so no threshold per link holds an error eps. So the error tolerance of every face starts
 * at (1 - rho) eps, for what reflection makes of a local error is at most 1 / (1 - rho) of it;
 * after each solve the error of each leaf is estimated (residual.c); where it is above eps the
 * leaf's tolerance is divided by ERROR_STEP, an element's is the least of its children's, and the
 * links are discussed again: until no estimate is above eps, or nothing can be split.
 *
 * A leaf is given up, and reported, when the links that a guard kept whole are above eps by
 * themselves, as beside an edge that elements share, where F has all values from 0 to 1/2 at every
 * size: lowering its tolerance, and with it its ancestors', would split everything else without
 * end. Or when tolerance times links is far below eps (ERROR_ENOUGH): then all links together are
 * within eps by the oracle's own measure, and what is left is none that it knows. Unreliable in
 * half shadow, as its estimate is. [Bekaert and Willems 1996; the end: derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/error_control.h"
#include "kernel/constants.h"
#include "util/array.h"
#include "util/thread_pool.h"

static double parameter(const struct refiner *r, int role)
{
    int i = refiner_find_role(r, role, -1);
    return i < 0 ? 0 : refiner_get(r, i);
}

double error_control_target(const struct refiner *r, const struct host *host)
{
    double absolute = parameter(r, ROLE_ERROR_TOLERANCE);
    double relative = parameter(r, ROLE_RELATIVE_ERROR_TOLERANCE) * host->radiosity;
    return refiner_reads(r, FACT_RECEIVER_TOLERANCE) ? fmax(absolute, relative) : 0;
}

double power_tolerance(const struct refiner *r, const struct host *host)
{
    return fmax(parameter(r, ROLE_POWER_TOLERANCE),
                parameter(r, ROLE_RELATIVE_POWER_TOLERANCE) * host->irradiance * host->area);
}

/* The least of the children's, bottom up, where that is less than what is there. */
static void lower_ancestors(struct hierarchy *h, struct oracle_inputs *in)
{
    for (uint32_t i = h->count; i-- > 0;) { /* children follow their parents */
        struct element *e = &h->elements[i];
        for (int c = 0; c < e->children; c++) {
            double tolerance = h->elements[e->child + (uint32_t)c].tolerance;
            if (!(tolerance < e->tolerance))
                continue;
            e->tolerance = tolerance;
            in->changed[i] = 1;
        }
    }
}

void error_control_start(struct error_control *c, double target, struct hierarchy *h,
                         struct oracle_inputs *in)
{
    c->target = target;
    for (uint32_t i = 0; i < h->face_count; i++) {
        struct element *e = &h->elements[h->face_element[i]];
        e->tolerance = (1 - e->reflectance) * target;
    }
    lower_ancestors(h, in);
}

struct estimating {
    const struct error_control *control;
    const struct light_operator *op;
    const double *radiosity; /* [element * bands + band] */
};

static void estimate_leaves(const void *estimating, size_t from, size_t to)
{
    const struct estimating *x = estimating;
    for (uint32_t i = (uint32_t)from; i < to; i++)
        if (operator_counts(x->op, i))
            x->control->residual[i] = residual_of_leaf(x->op, x->radiosity, i);
}

int error_control_estimate(struct error_control *c, const struct light_operator *op,
                           const double *radiosity)
{
    const struct hierarchy *h = op->hierarchy;
    if (array_reserve(&c->residual, h->count, &c->capacity, sizeof *c->residual) < 0)
        return -1;
    const struct estimating x = {c, op, radiosity};
    thread_pool_run(op->problem->options.threads, h->count, 16, estimate_leaves, &x);
    c->largest = c->area = 0;
    for (uint32_t i = 0; i < h->count; i++) {
        if (!operator_counts(op, i))
            continue;
        c->largest = fmax(c->largest, c->residual[i].all);
        c->area += c->residual[i].all > c->target ? h->elements[i].area : 0;
    }
    return 0;
}

uint32_t error_control_tighten(const struct error_control *c, const struct light_operator *op,
                               struct hierarchy *h, struct oracle_inputs *in)
{
    uint32_t lowered = 0;
    for (uint32_t i = 0; i < h->count; i++) {
        const struct leaf_residual *r = &c->residual[i];
        if (!operator_counts(op, i) || !(r->all > c->target) || r->guarded > c->target
            || h->elements[i].tolerance * r->links < ERROR_ENOUGH * c->target)
            continue;
        h->elements[i].tolerance *= 1 / ERROR_STEP;
        in->changed[i] = 1;
        lowered++;
    }
    if (lowered)
        lower_ancestors(h, in);
    return lowered;
}

void error_control_free(struct error_control *c)
{
    free(c->residual);
}
