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
#include "kernel/lambert.h"
#include "util/thread_pool.h"

/* Of some places: squares of what particles differ by, what of that chance tells, squares of that,
 * and of light; each over the light there (W). */
struct split_sums {
    double seen, noise, square, light;
};

enum { RUN = 16 }; /* faces that are added up as one, by whichever thread */

struct places {
    const struct hierarchy *h;
    const struct tally *tally;
    const double *irradiance;
    struct split_sums *sums; /* [run] */
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

static void add_place(const struct places *p, uint32_t e, struct split_sums *sums)
{
    const struct tally *tally = p->tally;
    const double area = p->h->elements[e].area, one = tally_power_of_one(tally);
    double power[3] = {0, 0, 0};
    add_power(p, e, power);
    for (uint32_t k = 0; k < tally->bands; k++) {
        double linked = p->irradiance[(size_t)e * tally->bands + k] * area, off = power[k] - linked,
               weight = 1 / (linked + p->irradiance[k] * area + one);
        /* chance is that of the light that links expect: of what landed it would be small wherever
         * little happened to */
        double chance = one * tally->square[k] * linked * weight;
        sums->seen += off * off * weight;
        sums->noise += chance;
        sums->square += chance * chance;
        sums->light += linked * linked * weight;
    }
}

/* The places of an element. */
static void add_places(const struct places *p, uint32_t e, struct split_sums *sums)
{
    const struct element *at = &p->h->elements[e];
    if (!at->children || at->area <= PLACE_SHARE * p->h->elements[0].area)
        add_place(p, e, sums);
    else
        for (uint32_t j = at->child; j < at->child + at->children; j++)
            add_places(p, j, sums);
}

static void add_faces(const void *places, size_t from, size_t to)
{
    const struct places *p = places;
    for (size_t i = from; i < to; i++)
        add_places(p, p->h->face_element[i], &p->sums[from / RUN]);
}

/* The squared noise in the L1 error of polygons, as a share of the reflected light, if chance alone
 * spread particles over them by what links say. Returns 0, or -1 when out of memory. */
static int measure_faces(const struct light_operator *op, const struct tally *tally,
                         const double *irradiance, double *square)
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
    *square = all > 0 ? noise / all * (noise / all) : 0;
    int failed = !reflected || !rho;
    free(reflected);
    free(rho);
    return failed ? -1 : 0;
}

int ray_split_measure(const struct light_operator *op, const struct tally *tally,
                      const double *irradiance, struct ray_split *split)
{
    const uint32_t faces = op->hierarchy->face_count;
    struct split_sums all = {0, 0, 0, 0}, *sums = calloc(faces / RUN + 1, sizeof *sums);
    const struct places places = {op->hierarchy, tally, irradiance, sums};
    *split = (struct ray_split){.rays = tally->rays};
    if (!sums)
        return -1;
    thread_pool_run(op->problem->options.threads, faces, RUN, add_faces, &places);
    for (uint32_t i = 0; i < faces; i += RUN) {
        const struct split_sums *of = &sums[i / RUN];
        all.seen += of->seen;
        all.noise += of->noise;
        all.square += of->square;
        all.light += of->light;
    }
    free(sums);
    if (all.light > 0 && tally->rays > 0) {
        split->links = (all.seen - all.noise) / all.light;
        split->deviation = sqrt(2 * all.square) / all.light; /* of squares of normal variables */
        split->ray = all.noise / all.light * (double)tally->rays;
    }
    if (measure_faces(op, tally, irradiance, &split->face) < 0)
        return -1;
    split->face *= (double)tally->rays;
    return 0;
}

double ray_split_wanted(const struct ray_split *split, double wanted)
{
    return split->links > 0 ? split->ray * fmax(0, 1 / (wanted * wanted) - 1 / split->links) : 0;
}
