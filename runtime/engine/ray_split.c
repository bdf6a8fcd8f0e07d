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
#include "engine/place_counts.h"
#include "engine/ray_split.h"
#include "kernel/constants.h"
#include "util/thread_pool.h"

static int is_place(const struct hierarchy *h, uint32_t e)
{
    double most = PLACE_SHARE * h->elements[0].area;
    const struct element *at = &h->elements[e];
    if (!at->vertices || (at->area > most && at->children))
        return 0;
    const struct element *parent = &h->elements[at->parent];
    return !parent->vertices || parent->area > most;
}

/* Places, and the power counted on them: [place * bands + band] (W). */
struct places {
    const struct hierarchy *h;
    const struct tally *tally;
    uint32_t *element, count;
    double *power;
    const struct shares *shares; /* who looks at which; NULL: all at all */
};

/* Is it this rank's to look at? */
static int is_counted(const struct places *p, uint32_t e)
{
    return !p->shares || shares_mine(p->shares, e);
}

/* Add what has been counted below an element: children last to first, each once it is whole. */
static void add_power(const struct places *p, uint32_t e, double power[3])
{
    const struct element *at = &p->h->elements[e];
    for (uint32_t k = 0; k < p->tally->bands && !at->children; k++)
        power[k] += tally_leaf(p->tally, e, k);
    for (uint32_t j = at->child + at->children; at->children && j-- > at->child;) {
        double part[3] = {0, 0, 0};
        add_power(p, j, part);
        for (uint32_t k = 0; k < p->tally->bands; k++)
            power[k] += part[k];
    }
}

static void add_powers(const void *places, size_t from, size_t to)
{
    const struct places *p = places;
    for (size_t i = from; i < to; i++) {
        double power[3] = {0, 0, 0};
        add_power(p, p->element[i], power);
        for (uint32_t k = 0; k < p->tally->bands; k++)
            p->power[i * p->tally->bands + k] = power[k];
    }
}

/* The same where ranks have counted apart. */
static int add_counts(const struct places *p, struct ranks *ranks)
{
    const uint32_t bands = p->tally->bands;
    int64_t *count = place_counts(ranks, p->tally, p->element, p->count, p->shares != NULL);
    if (!count)
        return -1;
    for (size_t i = 0; i < (size_t)p->count * bands; i++)
        p->power[i] = tally_leaf_unit(p->tally, (uint32_t)(i % bands)) * (double)count[i];
    free(count);
    return 0;
}

/* Returns 0, or -1 when out of memory; either way places_close. */
static int places_open(struct places *p, const struct light_operator *op, const struct tally *tally)
{
    const struct hierarchy *h = op->hierarchy;
    const int threads = op->problem->options.threads;
    *p = (struct places){.h = h, .tally = tally, .shares = op->shares.common ? &op->shares : NULL};
    p->element = malloc((size_t)h->count * sizeof *p->element);
    for (uint32_t e = 0; p->element && e < h->count; e++)
        if (is_place(h, e) && is_counted(p, e))
            p->element[p->count++] = e;
    p->power = malloc(((size_t)p->count * tally->bands + 1) * sizeof *p->power);
    if (ranks_any(op->shares.ranks, !p->element || !p->power))
        return -1;
    if (tally->parted_leaves)
        return add_counts(p, op->shares.ranks);
    thread_pool_run(threads, p->count, 64, add_powers, p);
    return 0;
}

static void places_close(struct places *p)
{
    free(p->element);
    free(p->power);
}

int ray_split_measure(const struct light_operator *op, const struct tally *tally,
                      const double *irradiance, struct ray_split *split)
{
    const struct hierarchy *h = op->hierarchy;
    double seen = 0, noise = 0, square = 0, light = 0; /* W */
    double one = tally_power_of_one(tally);
    struct places places;
    int result = places_open(&places, op, tally);
    *split = (struct ray_split){.rays = tally->rays};
    for (uint32_t i = 0; result == 0 && i < places.count; i++)
        for (uint32_t k = 0; k < tally->bands; k++) {
            const uint32_t e = places.element[i];
            double area = h->elements[e].area,
                   linked = irradiance[(size_t)e * tally->bands + k] * area,
                   off = places.power[(size_t)i * tally->bands + k] - linked,
                   weight = 1 / (linked + irradiance[k] * area + one);
            /* chance is that of the light that links expect: of what landed it would be small
             * wherever little happened to */
            double chance = one * tally->square[k] * linked * weight;
            seen += off * off * weight;
            noise += chance;
            square += chance * chance;
            light += linked * linked * weight;
        }
    if (result == 0 && places.shares) {
        double sums[] = {seen, noise, square, light};
        ranks_add(op->shares.ranks, RANKS_PARTICLES, sums, 4);
        seen = sums[0];
        noise = sums[1];
        square = sums[2];
        light = sums[3];
    }
    places_close(&places);
    if (light > 0 && tally->rays > 0) {
        split->links = (seen - noise) / light;
        split->deviation = sqrt(2 * square) / light; /* of squares of normal variables */
        split->ray = noise / light * (double)tally->rays;
    }
    return result;
}

double ray_split_wanted(const struct ray_split *split, double wanted)
{
    return split->links > 0 ? split->ray * fmax(0, 1 / (wanted * wanted) - 1 / split->links) : 0;
}
