/* ray_split.c - see ray_split.h.
 *
 * Of errors e of links and s / sqrt(r) of r rays of particles the best mixture has
 * 1 / (1 / e^2 + r / s^2). So an error of t takes s^2 (1 / t^2 - 1 / e^2) rays of particles, and
 * finer links, of L rays and an error f, are worth them if and only if s^2 (1 / f^2 - 1 / e^2) > L,
 * whatever t is: solver/commands/coarse_first.c.
 *
 * Both are measured on places: the largest elements of no more than PLACE_SHARE of the area, and
 * leaves that are larger. What particles differ from links by is e^2 + s^2 / r, of which chance
 * tells the last. Particles of a Sobol' sequence are less noisy than chance: links are then thought
 * better than they are, and no ray is cast for it. [Derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "engine/ray_split.h"
#include "kernel/constants.h"

/* Power counted on all elements, from leaves up: [element * bands + band] (W). */
static double *count_power(const struct hierarchy *h, const struct tally *tally)
{
    uint32_t bands = tally->bands;
    double *power = malloc((size_t)h->count * bands * sizeof *power);
    for (uint32_t e = 0; power && e < h->count; e++)
        for (uint32_t k = 0; k < bands; k++)
            power[(size_t)e * bands + k] = h->elements[e].children ? 0 : tally_leaf(tally, e, k);
    for (uint32_t e = h->count; power && e-- > 1;) /* children follow their parents */
        for (uint32_t k = 0; k < bands; k++)
            power[(size_t)h->elements[e].parent * bands + k] += power[(size_t)e * bands + k];
    return power;
}

static int is_place(const struct hierarchy *h, uint32_t e)
{
    double most = PLACE_SHARE * h->elements[0].area;
    const struct element *at = &h->elements[e];
    if (!at->vertices || (at->area > most && at->children))
        return 0;
    const struct element *parent = &h->elements[at->parent];
    return !parent->vertices || parent->area > most;
}

int ray_split_measure(const struct light_operator *op, const struct tally *tally,
                      const double *irradiance, struct ray_split *split)
{
    const struct hierarchy *h = op->hierarchy;
    double *power = count_power(h, tally), seen = 0, noise = 0, square = 0, light = 0; /* W */
    double one = tally_power_of_one(tally);
    *split = (struct ray_split){.rays = tally->rays};
    if (!power)
        return -1;
    for (uint32_t e = 0; e < h->count; e++)
        for (uint32_t k = 0; k < tally->bands && is_place(h, e); k++) {
            size_t at = (size_t)e * tally->bands + k;
            double area = h->elements[e].area, linked = irradiance[at] * area,
                   off = power[at] - linked, weight = 1 / (linked + irradiance[k] * area + one);
            /* chance is that of the light that links expect: of what landed it would be small
             * wherever little happened to */
            double chance = one * tally->square[k] * linked * weight;
            seen += off * off * weight;
            noise += chance;
            square += chance * chance;
            light += linked * linked * weight;
        }
    free(power);
    if (light > 0 && tally->rays > 0) {
        split->links = (seen - noise) / light;
        split->deviation = sqrt(2 * square) / light; /* of squares of normal variables */
        split->ray = noise / light * (double)tally->rays;
    }
    return 0;
}

double ray_split_wanted(const struct ray_split *split, double wanted)
{
    return split->links > 0 ? split->ray * fmax(0, 1 / (wanted * wanted) - 1 / split->links) : 0;
}
