/* polygon_counts.c - see polygon_counts.h.
 *
 * Two estimates of s^2 are averaged: how the replicates differ, which sees all but is known to 15
 * degrees of freedom only and to fewer where few particles land; and chance, by the number of
 * particles, times how the replicates of polygons with as many particles differ from chance in the
 * mean. [derived here; coverage: tests/runtime/check_measured_error.c]
 * SPDX-License-Identifier: MIT */
#include "engine/polygon_counts.h"

#include <math.h>
#include <stdlib.h>

#include "kernel/constants.h"

/* Sums over the faces of a polygon: what was solved, and of each replicate. Returns 0, or -1 when
 * out of memory. */
static int sum_polygons(struct polygon_counts *c, const struct problem *p,
                        const struct hierarchy *h, const double *irradiance,
                        const struct tally *tally)
{
    for (uint32_t f = 0; f < h->face_count; f++) {
        const uint32_t row = polygon_row(&c->rows, h->faces[f].input);
        const size_t e = h->face_element[f];
        for (uint32_t k = 0; k < c->bands && row != NO_ROW; k++)
            c->solved[(size_t)row * c->bands + k] += p->reflectance[(size_t)f * c->bands + k]
                                                     * h->elements[e].area
                                                     * irradiance[e * c->bands + k];
    }
    if (polygon_rows_add(&c->rows, p, h, tally, c->replicate) < 0)
        return -1;
    for (int r = 0; r < REPLICATES; r++)
        for (size_t i = 0; i < c->values; i++)
            c->mean[i] += c->replicate[(size_t)r * c->values + i] / REPLICATES;
    for (size_t i = 0; i < c->values; i++)
        c->reflected += c->mean[i];
    polygon_rows_sum(&c->rows, &c->reflected, 1);
    return 0;
}

void polygon_counts_close(struct polygon_counts *c)
{
    if (!c)
        return;
    polygon_rows_close(&c->rows);
    free(c->solved);
    free(c->replicate);
    free(c->mean);
    free(c->deviation);
    free(c->count);
    free(c->class);
    free(c->most);
    free(c);
}

/* The variance of a value's mean, by how replicates differ (W2). */
static double variance_seen(const struct polygon_counts *c, size_t i)
{
    double sum = 0;
    for (int r = 0; r < REPLICATES; r++) {
        double off = c->replicate[(size_t)r * c->values + i] - c->mean[i];
        sum += off * off;
    }
    return sum / (REPLICATES * (REPLICATES - 1.0));
}

/* s, the class and the count of every value. */
static void find_deviations(struct polygon_counts *c, const struct problem *p,
                            const struct hierarchy *h, const struct tally *tally)
{
    double seen[NOISY_CLASSES] = {0}, chance[NOISY_CLASSES] = {0}, count[NOISY_CLASSES] = {0},
           one = tally_power_of_one(tally);
    double *rho = c->deviation;                    /* until s is known */
    for (uint32_t f = 0; f < h->face_count; f++) { /* sides of one polygon have one rho */
        const uint32_t row = polygon_row(&c->rows, h->faces[f].input);
        for (uint32_t k = 0; k < c->bands && row != NO_ROW; k++) {
            const double r = p->reflectance[(size_t)f * c->bands + k];
            rho[(size_t)row * c->bands + k] = r;
            c->most[row] = fmax(c->most[row], tally->by_paths ? 0 : r * one);
        }
    }
    for (size_t i = 0; i < c->values; i++) {
        double by_chance = 0, particles = 0;
        if (rho[i] > 0) {
            particles = fmax(c->mean[i], c->solved[i]) / (rho[i] * one);
            uint32_t band = (uint32_t)(i % c->bands);
            double reach =
                FACE_ERROR_DRAWN * rho[i] * sqrt(tally_chance(tally, c->mean[i] / rho[i], band));
            /* the count alone would call low counts sure: the truth is between, so far */
            double drawn = fmin(c->mean[i] + reach, fmax(c->mean[i] - reach, c->solved[i]));
            by_chance =
                rho[i] * rho[i] * tally_chance(tally, 0.5 * (c->mean[i] + drawn) / rho[i], band);
            c->count[i] = drawn / (rho[i] * one);
        }
        int class = particles > 1 ? (int)(0.5 * log2(particles)) : 0;
        c->class[i] = (unsigned char)(class < NOISY_CLASSES ? class : NOISY_CLASSES - 1);
        seen[c->class[i]] += variance_seen(c, i);
        chance[c->class[i]] += by_chance;
        count[c->class[i]] += by_chance > 0;
        c->deviation[i] = by_chance;
    }
    polygon_rows_sum(&c->rows, seen, NOISY_CLASSES);
    polygon_rows_sum(&c->rows, chance, NOISY_CLASSES);
    polygon_rows_sum(&c->rows, count, NOISY_CLASSES);
    /* of few particles replicates may have met none of a class: as if one polygon more were by
     * chance */
    for (int k = 0; k < NOISY_CLASSES && !tally->by_paths; k++) {
        double few = FACE_ERROR_FEW / (FACE_ERROR_FEW + ldexp(1, 2 * k)),
               more = count[k] > 0 ? few * chance[k] / count[k] : 0;
        seen[k] += more;
        chance[k] += more;
    }
    for (size_t i = 0; i < c->values; i++) {
        int class = c->class[i];
        double scaled = chance[class] > 0 ? c->deviation[i] * seen[class] / chance[class] : 0;
        double square = c->mean[i] * c->mean[i]; /* over the number of particles: variance */
        double own = square > 0 ? 0.5 / (1 + FACE_ERROR_FEW * scaled / square) : 0;
        c->deviation[i] =
            sqrt(own * variance_seen(c, i) + (1 - own) * scaled + tally_unseen(tally) * square);
    }
}

struct polygon_counts *polygon_counts_open(const struct problem *p, const struct hierarchy *h,
                                           const double *irradiance, const struct tally *tally)
{
    struct ranks *ranks = tally->quarters ? p->options.ranks : NULL;
    struct polygon_counts *c = calloc(1, sizeof *c);
    int failed = ranks_any(ranks, !c) || polygon_rows_open(&c->rows, p, h, tally) < 0;
    if (failed) {
        polygon_counts_close(c);
        return NULL;
    }
    c->bands = p->bands;
    c->values = (size_t)c->rows.count * p->bands;
    size_t n = c->values + 1;
    c->solved = calloc(n, sizeof *c->solved);
    c->replicate = calloc(n * REPLICATES, sizeof *c->replicate);
    c->mean = calloc(n, sizeof *c->mean);
    c->deviation = calloc(n, sizeof *c->deviation);
    c->count = calloc(n, sizeof *c->count);
    c->class = calloc(n, sizeof *c->class);
    c->most = calloc((size_t)c->rows.count + 1, sizeof *c->most);
    failed = !c->most || !c->solved || !c->replicate || !c->mean || !c->deviation || !c->count
             || !c->class;
    if (ranks_any(ranks, failed) || sum_polygons(c, p, h, irradiance, tally) < 0) {
        polygon_counts_close(c);
        return NULL;
    }
    find_deviations(c, p, h, tally);
    return c;
}

struct RadMeasure polygon_counts_noise(const struct polygon_counts *c)
{
    double mean = 0, variance = 0;
    for (size_t i = 0; i < c->values; i++) {
        mean += mean_modulus(c->deviation[i]);
        variance += (1 - 2 / LAMBERT_PI) * c->deviation[i] * c->deviation[i];
    }
    polygon_rows_sum(&c->rows, &mean, 1);
    polygon_rows_sum(&c->rows, &variance, 1);
    double off = NORMAL_T * sqrt(variance);
    return (struct RadMeasure){mean / c->reflected, fmax(0, mean - off) / c->reflected,
                               (mean + off) / c->reflected};
}

/* What large polygons have of the mean of that. */
static double noise_of_large(const struct polygon_counts *c, const double *areas, double large)
{
    double mean = 0;
    for (uint32_t row = 0; row < c->rows.count; row++)
        for (uint32_t k = 0; k < c->bands; k++)
            if (areas[polygon_of_row(&c->rows, row)] > large)
                mean += mean_modulus(c->deviation[(size_t)row * c->bands + k]);
    polygon_rows_sum(&c->rows, &mean, 1);
    return mean / c->reflected;
}

int face_noise_find(const struct problem *p, const struct hierarchy *h, const double *irradiance,
                    const struct tally *tally, struct face_noise *noise)
{
    struct polygon_counts *c = polygon_counts_open(p, h, irradiance, tally);
    double *areas = polygon_areas(p, h);
    const int failed = ranks_any(tally->quarters ? p->options.ranks : NULL, !c || !areas);
    *noise = (struct face_noise){0, 0, 0};
    if (!failed && c->reflected > 0) {
        const struct RadMeasure all = polygon_counts_noise(c);
        *noise = (struct face_noise){all.value, noise_of_large(c, areas, large_area(p, h)),
                                     (all.high - all.value) / NORMAL_T};
    }
    polygon_counts_close(c);
    free(areas);
    return failed ? -1 : 0;
}
