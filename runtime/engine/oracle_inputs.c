/* publish.c - what the oracles see of a solution.
 *
 * They see a value that is within STALE of the true one, so that passes end; changed[] marks the
 * elements that they see grow. The spread of an element is the largest less the smallest radiosity of the leaves below it,
 * in the band where that is most: for an emitter, how wrong it is to send the mean [Lischinski et al. 1994]. Two
 * radiosities that differ by less than iteration leaves are not known to differ, so a spread has to grow by the
 * tolerance too. What is buried in a solid has no light of its own and does not count.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "engine/transport.h"
#include "engine/oracle_inputs.h"

void publish_guess(struct solve *s)
{
    uint32_t i, k;
    int c;
    for (i = s->hierarchy.count; i-- > 0;) {
        struct element *e = &s->hierarchy.elements[i];
        double sum = 0;
        for (k = 0; k < s->bands && e->vertices; k++) {
            size_t at = (size_t)e->face * s->bands + k;
            double b = s->exitance[at] + s->reflectance[at] * rays_host(s->rays)->irradiance;
            e->radiosity = b > e->radiosity ? b : e->radiosity;
        }
        for (c = 0; c < e->children && !e->vertices; c++)
            sum += s->hierarchy.elements[e->child + (uint32_t)c].radiosity * s->hierarchy.elements[e->child + (uint32_t)c].area;
        if (!e->vertices)
            e->radiosity = sum / e->area;
    }
}

/* Means of a cluster. Its children have theirs. */
static void average(struct solve *s, uint32_t i)
{
    const struct element *e = &s->hierarchy.elements[i];
    uint32_t b = s->bands, k;
    int c;
    for (k = 0; k < b; k++)
        s->radiosity[(size_t)i * b + k] = s->irradiance[(size_t)i * b + k] = 0;
    for (c = 0; c < e->children; c++) {
        uint32_t j = e->child + (uint32_t)c;
        double sent = balance_share(s, j, i), received = s->hierarchy.elements[j].area / e->area;
        for (k = 0; k < b; k++) {
            s->radiosity[(size_t)i * b + k] += sent * s->radiosity[(size_t)j * b + k];
            s->irradiance[(size_t)i * b + k] += received * s->irradiance[(size_t)j * b + k];
        }
    }
}

/* Largest less smallest B below element i, largest band. Fills its part of least[] and most[], which its
 * children's hold already. */
static double measure_spread(struct solve *s, uint32_t i)
{
    const struct element *e = &s->hierarchy.elements[i];
    uint32_t b = s->bands, k;
    double widest = 0;
    int c;
    for (k = 0; k < b; k++) {
        size_t at = (size_t)i * b + k;
        double low = INFINITY, high = -INFINITY;
        if (!e->children && s->exposed[i] > 0)
            low = high = s->radiosity[at];
        for (c = 0; c < e->children; c++) {
            size_t below = (size_t)(e->child + (uint32_t)c) * b + k;
            low = s->least[below] < low ? s->least[below] : low;
            high = s->most[below] > high ? s->most[below] : high;
        }
        s->least[at] = low;
        s->most[at] = high;
        widest = high - low > widest ? high - low : widest;
    }
    return widest;
}

void publish(struct solve *s)
{
    uint32_t i, k;
    for (i = s->hierarchy.count; i-- > 0;) { /* children follow their parents */
        struct element *e = &s->hierarchy.elements[i];
        double seen = 0, spread;
        int spread_grew;
        if (!e->vertices)
            average(s, i);
        for (k = 0; k < s->bands; k++)
            seen = s->radiosity[(size_t)i * s->bands + k] > seen ? s->radiosity[(size_t)i * s->bands + k] : seen;
        s->changed[i] = seen > (1 + STALE) * e->radiosity;
        if (s->changed[i] || seen < (1 - STALE) * e->radiosity)
            e->radiosity = seen;
        spread = measure_spread(s, i);
        spread_grew = spread > (1 + STALE) * e->spread + s->options.tolerance * seen;
        s->changed[i] |= (unsigned char)spread_grew;
        if (spread_grew || spread < (1 - STALE) * e->spread)
            e->spread = spread;
    }
}
