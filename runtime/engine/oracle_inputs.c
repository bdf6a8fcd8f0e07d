/* oracle_inputs.c - what the oracles see of a solution.
 *
 * They see a value that is within HYSTERESIS of the true one, so that passes end; changed[] marks
 * the elements that they see grow. The spread of an element is the largest less the smallest
 * radiosity of the leaves below it, in the band where that is most: for an emitter, how wrong it is
 * to send the mean [Lischinski et al. 1994]. Two radiosities that differ by less than iteration
 * leaves (known) are not known to differ, so a spread has to grow by the tolerance too. What a
 * solid covers has no light of its own and does not count.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "engine/oracle_inputs.h"
#include "hierarchy/children_first.h"
#include "kernel/constants.h"

/* What the oracles see of the radiosity of an element at the least. Where rows are closed they are
 * scaled by what is missing, so an error in a link from a dark element moves light of the mean
 * radiosity. */
static double least_radiosity(const struct problem *p)
{
    int told = p->rays && p->options.closure != CLOSURE_NONE; /* no rays yet: no mean */
    return told ? rays_host(p->rays)->radiosity : 0;
}

void oracle_inputs_guess(const struct problem *p, struct hierarchy *h)
{
    for (uint32_t i = h->count; i-- > 0;) { /* children follow their parents */
        struct element *e = &h->elements[i];
        double sum = 0;
        if (i > 0 && e->reflectance > h->elements[e->parent].reflectance)
            h->elements[e->parent].reflectance = e->reflectance;
        for (uint32_t k = 0; k < p->bands && e->vertices; k++) {
            size_t at = (size_t)e->face * p->bands + k;
            e->radiosity =
                fmax(e->radiosity,
                     p->exitance[at] + p->reflectance[at] * rays_host(p->rays)->irradiance);
        }
        if (e->vertices) {
            e->radiosity = fmax(e->radiosity, least_radiosity(p));
            continue;
        }
        for (int c = 0; c < e->children; c++) {
            const struct element *child = &h->elements[e->child + (uint32_t)c];
            sum += child->radiosity * child->area;
        }
        e->radiosity = sum / e->area;
    }
}

/* What is worked with, as long as nothing but this asks for it. */
struct spreads {
    /* [element * bands + band]: smallest and largest radiosity of the uncovered leaves below */
    double *least, *most;
    double *deviation; /* the same: half the mean of |B - its mean| below */
};

/* Largest less smallest B below element i, largest band. Fills its part of least[] and most[],
 * which its children's hold already. */
static double measure_spread(const struct spreads *in, const struct light_operator *op,
                             const double *radiosity, uint32_t i)
{
    const struct element *e = &op->hierarchy->elements[i];
    uint32_t b = op->problem->bands;
    double widest = 0;
    for (uint32_t k = 0; k < b; k++) {
        size_t at = (size_t)i * b + k;
        double low = INFINITY, high = -INFINITY;
        if (!e->children && op->uncovered[i] > 0)
            low = high = radiosity[at];
        for (int c = 0; c < e->children; c++) {
            size_t below = (size_t)(e->child + (uint32_t)c) * b + k;
            low = fmin(low, in->least[below]);
            high = fmax(high, in->most[below]);
        }
        in->least[at] = low;
        in->most[at] = high;
        widest = fmax(widest, high - low);
    }
    return widest;
}

/* Half the area mean of |B - its mean| below element i, largest band, from above: of a part it is
 * at most the part's own and what the part's mean is off. Fills its part of deviation[]. */
static double measure_deviation(const struct spreads *in, const struct light_operator *op,
                                const double *radiosity, uint32_t i)
{
    const struct element *e = &op->hierarchy->elements[i];
    uint32_t b = op->problem->bands;
    double widest = 0;
    for (uint32_t k = 0; k < b; k++) {
        size_t at = (size_t)i * b + k;
        double sum = 0;
        for (uint32_t c = e->child; c < e->child + e->children; c++) {
            size_t below = (size_t)c * b + k;
            sum += op->uncovered[c] * op->hierarchy->elements[c].area
                   * (in->deviation[below] + 0.5 * fabs(radiosity[below] - radiosity[at]));
        }
        in->deviation[at] = sum / e->area;
        widest = fmax(widest, in->deviation[at]);
    }
    return widest;
}

struct showing {
    struct oracle_inputs *in;
    struct spreads below;
    const struct light_operator *op;
    const double *radiosity;
    struct element *elements;
};

static void show_element(const void *showing, uint32_t i)
{
    const struct showing *s = showing;
    struct element *e = &s->elements[i];
    uint32_t b = s->op->problem->bands;
    double brightest = least_radiosity(s->op->problem);
    for (uint32_t k = 0; k < b; k++)
        brightest = fmax(brightest, s->radiosity[(size_t)i * b + k]);
    double unknown = s->in->known * brightest,
           spread = measure_spread(&s->below, s->op, s->radiosity, i),
           deviation = measure_deviation(&s->below, s->op, s->radiosity, i);
    int grew = oracle_inputs_follow(&e->radiosity, brightest, HYSTERESIS, 0);
    grew |= oracle_inputs_follow(&e->spread, spread, HYSTERESIS, unknown);
    grew |= oracle_inputs_follow(&e->deviation, deviation, DEVIATION_HYSTERESIS, unknown);
    s->in->changed[i] = (unsigned char)grew;
}

int oracle_inputs_update(struct oracle_inputs *in, const struct light_operator *op,
                         const double *radiosity, struct hierarchy *h)
{
    const size_t values = (size_t)h->count * op->problem->bands;
    double *room = malloc(3 * values * sizeof *room);
    if (ranks_any(op->problem->options.ranks, !room)) {
        free(room);
        return -1;
    }
    const struct showing s = {
        in, {room, room + values, room + 2 * values}, op, radiosity, h->elements};
    children_first(h, op->problem->options.threads, show_element, &s);
    free(room);
    return 0;
}
