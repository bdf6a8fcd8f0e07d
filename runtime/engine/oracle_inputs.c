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
#include "engine/oracle_inputs.h"
#include "kernel/constants.h"

void oracle_inputs_guess(const struct problem *p, struct hierarchy *h)
{
    for (uint32_t i = h->count; i-- > 0;) { /* children follow their parents */
        struct element *e = &h->elements[i];
        double sum = 0;
        for (uint32_t k = 0; k < p->bands && e->vertices; k++) {
            size_t at = (size_t)e->face * p->bands + k;
            e->radiosity =
                fmax(e->radiosity,
                     p->exitance[at] + p->reflectance[at] * rays_host(p->rays)->irradiance);
        }
        if (e->vertices)
            continue;
        for (int c = 0; c < e->children; c++) {
            const struct element *child = &h->elements[e->child + (uint32_t)c];
            sum += child->radiosity * child->area;
        }
        e->radiosity = sum / e->area;
    }
}

/* Largest less smallest B below element i, largest band. Fills its part of least[] and most[],
 * which its children's hold already. */
static double measure_spread(struct oracle_inputs *in, const struct light_operator *op,
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

void oracle_inputs_update(struct oracle_inputs *in, const struct light_operator *op,
                          const double *radiosity, struct hierarchy *h)
{
    uint32_t b = op->problem->bands;
    for (uint32_t i = h->count; i-- > 0;) {
        struct element *e = &h->elements[i];
        double brightest = 0;
        for (uint32_t k = 0; k < b; k++)
            brightest = fmax(brightest, radiosity[(size_t)i * b + k]);
        in->changed[i] = brightest > (1 + HYSTERESIS) * e->radiosity;
        if (in->changed[i] || brightest < (1 - HYSTERESIS) * e->radiosity)
            e->radiosity = brightest;
        double spread = measure_spread(in, op, radiosity, i);
        int spread_grew =
            spread > (1 + HYSTERESIS) * e->spread + in->known * brightest;
        in->changed[i] |= (unsigned char)spread_grew;
        if (spread_grew || spread < (1 - HYSTERESIS) * e->spread)
            e->spread = spread;
    }
}
