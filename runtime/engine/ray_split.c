/* ray_split.c - see ray_split.h.
 *
 * Of errors e of links and s / sqrt(r) of r rays of particles the best mixture has
 * 1 / (1 / e^2 + r / s^2). Particles alone from all rays, L of links and r, have s^2 / (L + r). So
 * the mixture is better if and only if e^2 < s^2 / L, whatever r is: links are worth their rays
 * where particles from as many would be worse. Where they are not, what is spent besides is better
 * spent on particles.
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
                      const double *irradiance, uint64_t link_rays, struct ray_split *split)
{
    const struct hierarchy *h = op->hierarchy;
    double *power = count_power(h, tally), seen = 0, noise = 0, light = 0;
    double one = tally_power_of_one(tally);
    *split = (struct ray_split){0, 0};
    if (!power)
        return -1;
    for (uint32_t e = 0; e < h->count; e++)
        for (uint32_t k = 0; k < tally->bands && is_place(h, e); k++) {
            size_t at = (size_t)e * tally->bands + k;
            double linked = irradiance[at] * h->elements[e].area, off = power[at] - linked;
            /* chance is that of the light that links expect: of what landed it would be small
             * wherever little happened to */
            double chance = one * tally->square[k] * linked;
            seen += off * off / (linked + one);
            noise += chance / (linked + one);
            light += linked;
        }
    free(power);
    if (light > 0 && tally->rays > 0) {
        split->links = (seen - noise) / light;
        split->particles = noise / light * (double)tally->rays / (double)link_rays;
    }
    return 0;
}
