/* ray_split.c - see ray_split.h.
 *
 * Of errors e of links and s / sqrt(r) of r rays of particles the best mixture has
 * 1 / (1 / e^2 + r / s^2). So an error of t takes s^2 (1 / t^2 - 1 / e^2) rays of particles, and
 * finer links, of L rays and an error f, are worth them if and only if s^2 (1 / f^2 - 1 / e^2) > L,
 * whatever t is: api_choice.c.
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
#include "kernel/lambert.h"
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
};

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
    int64_t *count = place_counts(ranks, p->tally, p->element, p->count);
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
    *p = (struct places){.h = h, .tally = tally};
    p->element = malloc((size_t)h->count * sizeof *p->element);
    for (uint32_t e = 0; p->element && e < h->count; e++)
        if (is_place(h, e) && shares_looks_at(&op->shares, e))
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

/* Of a run of places: squares of what particles differ by, what of that chance tells, squares of
 * that, and of light; each over the light there (W). */
struct split_sums {
    double seen, noise, square, light;
};

enum { RUN = 256 };

struct summing {
    const struct places *places;
    const double *irradiance;
    struct split_sums *sums; /* [run] */
};

static void add_places(const void *summing, size_t from, size_t to)
{
    const struct summing *x = summing;
    const struct tally *tally = x->places->tally;
    const double one = tally_power_of_one(tally);
    struct split_sums *sums = &x->sums[from / RUN];
    for (size_t i = from; i < to; i++)
        for (uint32_t k = 0; k < tally->bands; k++) {
            const uint32_t e = x->places->element[i];
            double area = x->places->h->elements[e].area,
                   linked = x->irradiance[(size_t)e * tally->bands + k] * area,
                   off = x->places->power[i * tally->bands + k] - linked,
                   weight = 1 / (linked + x->irradiance[k] * area + one);
            /* chance is that of the light that links expect: of what landed it would be small
             * wherever little happened to */
            double chance = one * tally->square[k] * linked * weight;
            sums->seen += off * off * weight;
            sums->noise += chance;
            sums->square += chance * chance;
            sums->light += linked * linked * weight;
        }
}

int ray_split_measure(const struct light_operator *op, const struct tally *tally,
                      const double *irradiance, struct ray_split *split)
{
    double all[] = {0, 0, 0, 0};
    struct places places;
    int failed = places_open(&places, op, tally) < 0;
    struct split_sums *sums = failed ? NULL : calloc(places.count / RUN + 1, sizeof *sums);
    *split = (struct ray_split){.rays = tally->rays};
    failed = failed || ranks_any(op->shares.ranks, !sums);
    if (!failed) {
        const struct summing x = {&places, irradiance, sums};
        thread_pool_run(op->problem->options.threads, places.count, RUN, add_places, &x);
        for (uint32_t i = 0; i < places.count; i += RUN) {
            const struct split_sums *of = &sums[i / RUN];
            all[0] += of->seen;
            all[1] += of->noise;
            all[2] += of->square;
            all[3] += of->light;
        }
        if (op->shares.common)
            ranks_add(op->shares.ranks, RANKS_PARTICLES, all, 4);
    }
    free(sums);
    places_close(&places);
    if (failed)
        return -1;
    if (all[3] > 0 && tally->rays > 0) {
        split->links = (all[0] - all[1]) / all[3];
        split->deviation = sqrt(2 * all[2]) / all[3]; /* of squares of normal variables */
        split->ray = all[1] / all[3] * (double)tally->rays;
    }
    return 0;
}

int ray_split_faces(const struct light_operator *op, const struct tally *tally,
                    const double *irradiance, struct ray_split *split)
{
    const struct problem *p = op->problem;
    const struct hierarchy *h = op->hierarchy;
    const uint32_t bands = tally->bands, polygons = p->scene->input_count;
    const double one = tally_power_of_one(tally);
    double *reflected = calloc((size_t)polygons * bands + 1, sizeof *reflected), noise = 0, all = 0;
    double *rho = calloc((size_t)polygons * bands + 1, sizeof *rho);
    for (uint32_t i = 0; reflected && rho && i < h->face_count; i++)
        for (uint32_t k = 0; k < bands; k++) {
            const uint32_t e = h->face_element[i];
            const size_t at = (size_t)h->faces[i].input * bands + k;
            rho[at] = p->reflectance[(size_t)i * bands + k];
            reflected[at] += rho[at] * irradiance[(size_t)e * bands + k] * h->elements[e].area;
        }
    for (size_t i = 0; reflected && rho && i < (size_t)polygons * bands; i++) {
        noise += sqrt(2 / LAMBERT_PI * rho[i] * one * tally->square[i % bands] * reflected[i]);
        all += reflected[i];
    }
    split->face = all > 0 ? noise / all * (noise / all) * (double)tally->rays : 0;
    int failed = ranks_any(op->shares.ranks, !reflected || !rho);
    free(reflected);
    free(rho);
    return failed ? -1 : 0;
}

double ray_split_wanted(const struct ray_split *split, double wanted)
{
    return split->links > 0 ? split->ray * fmax(0, 1 / (wanted * wanted) - 1 / split->links) : 0;
}
