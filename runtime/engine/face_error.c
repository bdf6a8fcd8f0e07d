/* face_error.c - how far from the truth, by what particles say of every polygon.
 *
 * The error of one polygon and band is e = R~ - R, reflected power by the solution less the truth;
 * known is e^ = R~ - R^, R^ counted: e with a noise whose deviation is s. Two estimates of s^2 are
 * averaged: how the replicates differ, which sees all but is known to 15 degrees of freedom only
 * and to fewer where few particles land; and chance, by the number of particles, times how the
 * replicates of polygons with as many particles differ from chance in the mean. What noise adds to
 * a sum of moduli is told by the replicates themselves: half of them less the other half, over 2,
 * has the noise of the mean of all and no error in it. By that s of a class of many polygons is
 * scaled, as errors below a third of the noise make that sum but a twentieth larger.
 *
 * Power. The sum of e^ over that of R^, with Student's interval of the replicates.
 *
 * L1. The sum of |e^| is above that of |e|, for noise adds where it should cancel. Which sum of
 * errors stands behind it, and in which interval, noisy_sum.c tells. What replicates show the
 * noises of polygons to have in common widens or narrows it. The moduli of counts of n are not
 * quite those of differences of counts of n / 2: what noise adds is doubted by 1 / 8 n, which no
 * number of polygons mends.
 *
 * [derived here; coverage: tests/runtime/check_measured_error.c]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "engine/face_error.h"
#include "engine/noisy_sum.h"
#include "engine/polygon_rows.h"
#include "engine/reflected_light.h"
#include "kernel/constants.h"
#include "kernel/lambert.h"

struct counted {
    struct polygon_rows rows; /* the polygons whose values are here */
    uint32_t bands;
    size_t values;               /* polygons * bands */
    double *solved;              /* [values]: R~ (W) */
    double *replicate;           /* [REPLICATES][values]: R^ of each (W) */
    double *mean;                /* [values]: R^ */
    double *deviation;           /* [values]: s (W) */
    double scale[NOISY_CLASSES]; /* s of a class by its moduli over that by its squares */
    double *count;        /* [values]: particles by the solution, as far as what came allows that */
    double *weight;       /* [values]: room to work in */
    double reflected;     /* sum of R^ (W) */
    unsigned char *class; /* [values] */
    struct noisy_sum sum;
};

/* Sums over the faces of a polygon: what was solved, and of each replicate. Returns 0, or -1 when
 * out of memory. */
static int sum_polygons(struct counted *c, const struct problem *p, const struct hierarchy *h,
                        const double *irradiance, const struct tally *tally)
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

static void counted_close(struct counted *c)
{
    if (!c)
        return;
    polygon_rows_close(&c->rows);
    free(c->solved);
    free(c->replicate);
    free(c->mean);
    free(c->deviation);
    free(c->count);
    free(c->weight);
    free(c->class);
    free(c);
}

/* The variance of a value's mean, by how replicates differ (W2). */
static double variance_seen(const struct counted *c, size_t i)
{
    double sum = 0;
    for (int r = 0; r < REPLICATES; r++) {
        double off = c->replicate[(size_t)r * c->values + i] - c->mean[i];
        sum += off * off;
    }
    return sum / (REPLICATES * (REPLICATES - 1.0));
}

/* s, the class and the count of every value. */
static void find_deviations(struct counted *c, const struct problem *p, const struct hierarchy *h,
                            const struct tally *tally)
{
    double seen[NOISY_CLASSES] = {0}, chance[NOISY_CLASSES] = {0}, count[NOISY_CLASSES] = {0},
           one = tally_power_of_one(tally);
    double *rho = c->deviation;                    /* until s is known */
    for (uint32_t f = 0; f < h->face_count; f++) { /* sides of one polygon have one rho */
        const uint32_t row = polygon_row(&c->rows, h->faces[f].input);
        for (uint32_t k = 0; k < c->bands && row != NO_ROW; k++)
            rho[(size_t)row * c->bands + k] = p->reflectance[(size_t)f * c->bands + k];
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

/* Of all ways to part x[REPLICATES] in halves that rows of Hadamard's matrix are: one half less the
 * other; the sum of all in x[0]. */
static void all_splits(double x[REPLICATES])
{
    for (int step = 1; step < REPLICATES; step *= 2)
        for (int i = 0; i < REPLICATES; i++)
            if (!(i & step)) {
                double a = x[i], b = x[i + step];
                x[i] = a + b;
                x[i + step] = a - b;
            }
}

/* The mean |n - count| of a Poisson number n of that mean over the mean difference of two numbers
 * of half of it: by that halves of the replicates show too little where few particles come, 2 where
 * next to none do. */
static double few_moduli(double count)
{
    if (!(count > 0) || count >= FACE_ERROR_MANY)
        return 1;
    const double most = floor(count);
    double term = 1, bessel = 0, off = 2 * count;
    for (int i = 0; term > 1e-9 * bessel; i++) { /* I0 + I1 */
        bessel += term * (1 + 0.5 * count / (i + 1));
        term *= 0.25 * count * count / ((i + 1.0) * (i + 1.0));
    }
    for (int i = 1; i <= most; i++)
        off *= count / i;
    return off / (count * bessel);
}

/* How uncertain the moduli of noise are in a class, whose polygons have 4^class particles or more,
 * as a share. */
static double doubt_of(int class)
{
    return class > 0 ? exp2(-2 * class - 3) : FACE_ERROR_FEWEST;
}

/* Of a class, by how far halves of the replicates are apart: what the moduli of noise are over
 * those of a normal one of deviation s. A class of few polygons says little, and where
 * less than four particles come both are something else. */
static void find_scales(struct counted *c)
{
    double apart[NOISY_CLASSES] = {0}, normal[NOISY_CLASSES] = {0}, count[NOISY_CLASSES] = {0};
    for (size_t i = 0; i < c->values; i++) {
        double sum = 0;
        if (!(c->deviation[i] > 0))
            continue;
        double off[REPLICATES];
        for (unsigned r = 0; r < REPLICATES; r++)
            off[r] = c->replicate[(size_t)r * c->values + i] / REPLICATES;
        all_splits(off);
        for (unsigned split = 1; split < REPLICATES; split++)
            sum += fabs(off[split]) / (REPLICATES - 1);
        apart[c->class[i]] += sum * few_moduli(c->count[i]);
        normal[c->class[i]] += sqrt(2 / LAMBERT_PI) * c->deviation[i];
        count[c->class[i]]++;
    }
    polygon_rows_sum(&c->rows, apart, NOISY_CLASSES);
    polygon_rows_sum(&c->rows, normal, NOISY_CLASSES);
    polygon_rows_sum(&c->rows, count, NOISY_CLASSES);
    for (int k = 0; k < NOISY_CLASSES; k++)
        c->scale[k] =
            normal[k] > 0
                ? 1 + (apart[k] / normal[k] - 1) * count[k] / (count[k] + FACE_ERROR_ALIKE)
                : 1;
}

/* The deviation of noise whose moduli are as large (W). */
static double noise_by_moduli(const struct counted *c, size_t i)
{
    return c->deviation[i] * c->scale[c->class[i]];
}

/* The bin of a value; NOISY_BINS: its error is as it is seen. Where next to no particle comes
 * moduli are small because few values have them all, so an error has to stand out of squares as
 * well. */
static int bin_of(const struct counted *c, size_t i)
{
    const double s = noise_by_moduli(c, i), off = fabs(c->solved[i] - c->mean[i]);
    if (off >= FACE_ERROR_CERTAIN * fmax(s, c->deviation[i]))
        return NOISY_BINS;
    return (int)fmin(off / s * (NOISY_BINS / FACE_ERROR_CERTAIN), NOISY_BINS - 1);
}

/* Put values into bins and find their errors. */
static void find_errors(struct counted *c)
{
    double seen[NOISY_CLASSES] = {0};
    for (size_t i = 0; i < c->values; i++) {
        double rms = c->deviation[i], s = noise_by_moduli(c, i),
               off = fabs(c->solved[i] - c->mean[i]);
        if (!(s > 0))
            continue;
        const int at = bin_of(c, i);
        if (at == NOISY_BINS) {
            c->sum.sure += off;
            c->sum.sure_square += s * s;
            continue;
        }
        struct noisy_bin *b = &c->sum.bin[c->class[i]][at];
        b->s += s;
        b->square += s * s;
        b->x += off;
        b->doubt += s * doubt_of(c->class[i]);
        b->count++;
        seen[c->class[i]] += off * off - rms * rms;
    }
    _Static_assert(sizeof(struct noisy_bin) == 6 * sizeof(double), "bins are added as they stand");
    polygon_rows_sum(&c->rows, &c->sum.bin[0][0].s, (size_t)NOISY_CLASSES * NOISY_BINS * 6);
    polygon_rows_sum(&c->rows, seen, NOISY_CLASSES);
    polygon_rows_sum(&c->rows, &c->sum.sure, 1);
    polygon_rows_sum(&c->rows, &c->sum.sure_square, 1);
    noisy_sum_fit(&c->sum, seen);
}

/* The variance of sum g R^ over all values (W2), by the replicates. g: c->weight. */
static double variance_of_sum(const struct counted *c)
{
    double sum[REPLICATES] = {0}, mean = 0, differ = 0;
    for (int r = 0; r < REPLICATES; r++)
        for (size_t i = 0; i < c->values; i++)
            sum[r] += c->weight[i] * c->replicate[(size_t)r * c->values + i];
    polygon_rows_sum(&c->rows, sum, REPLICATES);
    for (int r = 0; r < REPLICATES; r++)
        mean += sum[r] / REPLICATES;
    for (int r = 0; r < REPLICATES; r++)
        differ += (sum[r] - mean) * (sum[r] - mean);
    return differ / (REPLICATES * (REPLICATES - 1.0));
}

static struct RadMeasure measure_l1(struct counted *c)
{
    const struct noisy_errors errors = noisy_sum_errors(&c->sum);
    double value = errors.sum, all = c->reflected, independent = 0, below, above;
    for (size_t i = 0; i < c->values; i++) { /* d |e^| / d R^, and that of the reflected light */
        double off = c->solved[i] - c->mean[i];
        double s = noise_by_moduli(c, i), x = s > 0 ? off / s : 0;
        const int at = s > 0 ? bin_of(c, i) : NOISY_BINS;
        if (at < NOISY_BINS)
            x = copysign(c->sum.bin[c->class[i]][at].error, x);
        double slope = erf(x / sqrt(2));
        c->weight[i] = -slope - value / all;
        independent += slope * slope * s * s;
    }
    polygon_rows_sum(&c->rows, &independent, 1);
    double seen = variance_of_sum(c), chance = errors.variance;
    double common = chance > 0 ? fmax(0.25, 1 + (seen - independent) / chance) : 1;
    noisy_sum_reach(&c->sum, common, &below, &above);
    return (struct RadMeasure){value / all, fmax(0, value - below) / all, (value + above) / all};
}

/* Particles that lose light in one way may all have been spared: one more is allowed for, which is
 * that share of all that is reflected. */
static struct RadMeasure measure_power(struct counted *c, double particles)
{
    double solved = 0;
    for (size_t i = 0; i < c->values; i++) {
        solved += c->solved[i];
        c->weight[i] = 1;
    }
    polygon_rows_sum(&c->rows, &solved, 1);
    double noise = variance_of_sum(c) / (c->reflected * c->reflected),
           deviation = sqrt(noise + 1 / (particles * particles)) * solved / c->reflected;
    double value = solved / c->reflected - 1;
    return (struct RadMeasure){value, value - REPLICATES_T * deviation,
                               value + REPLICATES_T * deviation};
}

/* What is shown of all ranks' polygons. */
static void show_all(struct face_error *f, const struct counted *c)
{
    struct ranks *ranks = c->rows.ranks;
    const size_t values = (size_t)f->polygons * f->bands;
    double most = f->worst_sure, first;
    if (!ranks)
        return;
    ranks_add(ranks, RANKS_PARTICLES, f->error, values); /* to zeros */
    ranks_add(ranks, RANKS_PARTICLES, f->deviation, values);
    ranks_most(ranks, RANKS_PARTICLES, &most, 1);
    first = f->worst_sure < most ? -(double)f->polygons : -(double)f->worst;
    ranks_most(ranks, RANKS_PARTICLES, &first, 1);
    if (f->worst != (uint32_t)-first)
        f->worst_share = 0;
    f->worst = (uint32_t)-first;
    f->worst_sure = most;
    ranks_add(ranks, RANKS_PARTICLES, &f->worst_share, 1);
}

/* Errors per polygon, and the worst. areas: of all sides (m2), [polygons]; large: large_area. */
static void show_polygons(struct face_error *f, const struct counted *c, const double *areas,
                          double large)
{
    for (uint32_t row = 0; row < c->rows.count; row++) {
        const uint32_t i = polygon_of_row(&c->rows, row);
        double off = 0, reflected = 0, noise = 0;
        for (size_t k = 0; k < c->bands; k++) {
            const size_t j = (size_t)row * c->bands + k, to = (size_t)i * c->bands + k;
            f->error[to] = areas[i] > 0 ? (c->solved[j] - c->mean[j]) / areas[i] : 0;
            f->deviation[to] = areas[i] > 0 ? c->deviation[j] / areas[i] : 0;
            off += c->solved[j] - c->mean[j];
            reflected += c->mean[j];
            noise += c->deviation[j]; /* one particle has all bands: their noise is alike */
        }
        double sure = fabs(off) - FACE_ERROR_SURE * noise;
        if (!(areas[i] > large) || !(reflected > 0) || !(sure > f->worst_sure * reflected))
            continue;
        f->worst = i;
        f->worst_share = off / reflected;
        f->worst_sure = sure / reflected;
    }
    show_all(f, c);
}

/* Everything counted, and how noisy it is. Returns NULL when out of memory. */
static struct counted *counted_open(const struct problem *p, const struct hierarchy *h,
                                    const double *irradiance, const struct tally *tally)
{
    struct ranks *ranks = tally->quarters ? p->options.ranks : NULL;
    struct counted *c = calloc(1, sizeof *c);
    int failed = ranks_any(ranks, !c) || polygon_rows_open(&c->rows, p, h, tally) < 0;
    if (failed) {
        counted_close(c);
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
    c->weight = calloc(n, sizeof *c->weight);
    c->class = calloc(n, sizeof *c->class);
    failed = !c->solved || !c->replicate || !c->mean || !c->deviation || !c->count || !c->weight
             || !c->class;
    if (ranks_any(ranks, failed) || sum_polygons(c, p, h, irradiance, tally) < 0) {
        counted_close(c);
        return NULL;
    }
    find_deviations(c, p, h, tally);
    return c;
}

/* The sum of |s z| over all values, z normal and independent. */
static struct RadMeasure expected_noise(const struct counted *c)
{
    double mean = 0, variance = 0;
    for (size_t i = 0; i < c->values; i++) {
        mean += sqrt(2 / LAMBERT_PI) * c->deviation[i];
        variance += (1 - 2 / LAMBERT_PI) * c->deviation[i] * c->deviation[i];
    }
    polygon_rows_sum(&c->rows, &mean, 1);
    polygon_rows_sum(&c->rows, &variance, 1);
    double off = NORMAL_T * sqrt(variance);
    return (struct RadMeasure){mean / c->reflected, fmax(0, mean - off) / c->reflected,
                               (mean + off) / c->reflected};
}

/* What large polygons have of the mean of that. */
static double noise_of_large(const struct counted *c, const double *areas, double large)
{
    double mean = 0;
    for (uint32_t row = 0; row < c->rows.count; row++)
        for (uint32_t k = 0; k < c->bands; k++)
            if (areas[polygon_of_row(&c->rows, row)] > large)
                mean += sqrt(2 / LAMBERT_PI) * c->deviation[(size_t)row * c->bands + k];
    polygon_rows_sum(&c->rows, &mean, 1);
    return mean / c->reflected;
}

int face_noise_find(const struct problem *p, const struct hierarchy *h, const double *irradiance,
                    const struct tally *tally, struct face_noise *noise)
{
    struct counted *c = counted_open(p, h, irradiance, tally);
    double *areas = polygon_areas(p, h);
    const int failed = ranks_any(tally->quarters ? p->options.ranks : NULL, !c || !areas);
    *noise = (struct face_noise){0, 0, 0};
    if (!failed && c->reflected > 0) {
        const struct RadMeasure all = expected_noise(c);
        *noise = (struct face_noise){all.value, noise_of_large(c, areas, large_area(p, h)),
                                     (all.high - all.value) / NORMAL_T};
    }
    counted_close(c);
    free(areas);
    return failed ? -1 : 0;
}

/* Where no particle had any of a band, and the solution has, they know none of it. */
static void show_bands(struct face_error *f, const struct counted *c)
{
    enum { BANDS = 3, SUMS = 3 * BANDS };
    double sum[SUMS] = {0}, *mean = sum, *solved = mean + BANDS, *noise = solved + BANDS;
    for (size_t i = 0; i < c->values; i++) {
        const size_t k = i % c->bands;
        mean[k] += c->mean[i];
        solved[k] += c->solved[i];
        noise[k] += sqrt(2 / LAMBERT_PI) * c->deviation[i];
    }
    polygon_rows_sum(&c->rows, sum, SUMS);
    const double all = solved[0] + solved[1] + solved[2];
    for (size_t k = 0; k < c->bands && all > 0; k++) {
        f->band_light[k] = solved[k] / all;
        f->band_noise[k] = mean[k] > 0 ? noise[k] / mean[k] : solved[k] > 0;
    }
}

/* Where nothing is reflected of what was seen. */
static void show_nothing(struct face_error *f, double unseen)
{
    f->unseen = unseen;
    if (f->unseen > 0) {
        f->l1.high = f->power.high = INFINITY;
        f->power.low = -INFINITY;
    }
}

static int open_lists(struct face_error *f)
{
    size_t n = (size_t)f->polygons * f->bands + 1;
    f->error = calloc(n, sizeof *f->error);
    f->deviation = calloc(n, sizeof *f->deviation);
    return f->error && f->deviation ? 0 : -1;
}

int face_error_open(struct face_error *f, const struct problem *p, const struct hierarchy *h,
                    const double *irradiance, const struct tally *tally)
{
    uint32_t polygons = p->scene->input_count;
    *f = (struct face_error){.polygons = polygons, .bands = p->bands, .worst = polygons};
    struct counted *c = counted_open(p, h, irradiance, tally);
    double *areas = polygon_areas(p, h);
    const int failed = !c || !areas || open_lists(f) < 0;
    if (ranks_any(tally->quarters ? p->options.ranks : NULL, failed)) {
        counted_close(c);
        free(areas);
        face_error_close(f);
        return -1;
    }
    f->reflected = c->reflected;
    if (!(f->reflected > 0))
        show_nothing(f, unseen_light(p, tally));
    find_scales(c);
    find_errors(c);
    if (f->reflected > 0) {
        f->noise = expected_noise(c);
        f->power = measure_power(c, (double)tally->particles * REPLICATES);
        f->l1 = measure_l1(c);
    }
    show_polygons(f, c, areas, large_area(p, h));
    show_bands(f, c);
    counted_close(c);
    free(areas);
    return 0;
}

void face_error_close(struct face_error *f)
{
    free(f->error);
    free(f->deviation);
    *f = (struct face_error){0};
}
