/* face_error.c - how far from the truth, by what particles say of every polygon.
 *
 * The error of one polygon and band is e = R~ - R, reflected power by the solution less the truth;
 * known is e^ = R~ - R^, R^ counted: e with a noise whose deviation is s. Two estimates of s^2 are
 * averaged: how the replicates differ, which sees all but is known to 15 degrees of freedom only,
 * and chance, by the number of particles, times how the replicates of polygons with as many
 * particles differ from chance in the mean.
 *
 * Power. The sum of e^ over that of R^, with Student's interval of the replicates.
 *
 * L1. The sum of |e^| is above that of |e|, for noise adds where it should cancel. So the question
 * is turned round: which errors would, with the noise that is known, be expected to show this sum?
 * A normal e with a deviation of s has E|e| = m erf(m / (s sqrt 2)) + s sqrt(2 / pi) exp(-m^2 / 2
 * s^2), the folded normal. In each class of polygons with about as many particles the true errors
 * are taken as c |e^|, 0 <= c <= 1, and c is what makes the expected sum the observed one. (Where
 * errors are normal in a class that is exact: c^2 is the share of the true variance.) The interval
 * is that of a test: all sums of errors, c^2 raised or lowered alike, that would not make the
 * observed sum a surprise at 95 %. Where nothing but noise is seen, the upper end is no lower than
 * for a sum one standard deviation below what noise alone makes: a power-constrained limit. [folded
 * normal: Leone, Nelson and Nottingham 1961; interval by inversion of a test: Neyman 1937; its
 * limit: Cowan et al. 2011; the rest: derived here, coverage: tests/runtime/check_measured_error.c]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "engine/face_error.h"
#include "kernel/constants.h"
#include "kernel/lambert.h"

enum { CLASSES = 24, BINS = 160, HALVINGS = 50 };

/* 97.5 % of Student's t with REPLICATES - 1 degrees of freedom, and of the normal. */
#define T_QUANTILE 2.131449545559323
#define NORMAL_QUANTILE 1.959963984540054
_Static_assert(REPLICATES == 16, "T_QUANTILE is that of 15 degrees of freedom");

/* Polygons and bands alike in number of particles and in x = |e^| / s: sums of s, s^2 and s x. */
struct bin {
    double s, square, x;
};

struct counted {
    uint32_t bands;
    size_t values;        /* polygons * bands */
    double *solved;       /* [values]: R~ (W) */
    double *replicate;    /* [REPLICATES][values]: R^ of each (W) */
    double *mean;         /* [values]: R^ */
    double *deviation;    /* [values]: s (W) */
    double *weight;       /* [values]: room to work in */
    double reflected;     /* sum of R^ (W) */
    unsigned char *class; /* [values] */
    struct bin bin[CLASSES][BINS];
    double share[CLASSES]; /* c */
};

static double folded(double m, double s)
{
    double x = m / (s * sqrt(2));
    return m * erf(x) + s * sqrt(2 / LAMBERT_PI) * exp(-x * x);
}

/* If errors in a class were c |e^|: the expected sum of |e^|, its variance, and their sum. */
struct expected {
    double sum, variance, errors;
};

static struct expected expect(const struct bin bins[BINS], double c)
{
    struct expected all = {0, 0, 0};
    for (int i = 0; i < BINS; i++) {
        const struct bin *b = &bins[i];
        if (!(b->s > 0))
            continue;
        double x = c * b->x / b->s, e = folded(x, 1);
        all.sum += b->s * e;
        all.variance += b->square * fmax(0, 1 + x * x - e * e);
        all.errors += b->s * x;
    }
    return all;
}

/* The same of all classes, with every c^2 raised by so much. */
static struct expected expect_all(const struct counted *c, double raise)
{
    struct expected all = {0, 0, 0};
    for (int i = 0; i < CLASSES; i++) {
        struct expected one = expect(c->bin[i], sqrt(fmax(0, c->share[i] * c->share[i] + raise)));
        all.sum += one.sum;
        all.variance += one.variance;
        all.errors += one.errors;
    }
    return all;
}

static void sum_polygons(struct counted *c, const struct problem *p, const struct hierarchy *h,
                         const double *irradiance, const struct tally *tally)
{
    for (uint32_t f = 0; f < h->face_count; f++) {
        uint32_t e = h->face_element[f];
        for (uint32_t k = 0; k < c->bands; k++) {
            size_t at = (size_t)h->faces[f].input * c->bands + k;
            double rho = p->reflectance[(size_t)f * c->bands + k];
            c->solved[at] += rho * h->elements[e].area * irradiance[(size_t)e * c->bands + k];
            for (int r = 0; r < REPLICATES; r++)
                c->replicate[(size_t)r * c->values + at] += rho * tally_face(tally, r, f, k);
        }
    }
    for (size_t i = 0; i < c->values; i++) {
        for (int r = 0; r < REPLICATES; r++)
            c->mean[i] += c->replicate[(size_t)r * c->values + i] / REPLICATES;
        c->reflected += c->mean[i];
    }
}

static void counted_close(struct counted *c)
{
    if (!c)
        return;
    free(c->solved);
    free(c->replicate);
    free(c->mean);
    free(c->deviation);
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

/* s and the class of every value. */
static void find_deviations(struct counted *c, const struct problem *p, const struct hierarchy *h,
                            const struct tally *tally)
{
    double seen[CLASSES] = {0}, chance[CLASSES] = {0}, one = tally_power_of_one(tally);
    double *rho = c->deviation;                  /* until s is known */
    for (uint32_t f = 0; f < h->face_count; f++) /* sides of one polygon have one rho */
        for (uint32_t k = 0; k < c->bands; k++)
            rho[(size_t)h->faces[f].input * c->bands + k] =
                p->reflectance[(size_t)f * c->bands + k];
    for (size_t i = 0; i < c->values; i++) {
        double by_chance = 0, particles = 0;
        if (rho[i] > 0) {
            particles = fmax(c->mean[i], c->solved[i]) / (rho[i] * one);
            by_chance = rho[i] * rho[i]
                        * tally_chance(tally, c->mean[i] / rho[i], (uint32_t)(i % c->bands));
        }
        int class = particles > 1 ? (int)(0.5 * log2(particles)) : 0;
        c->class[i] = (unsigned char)(class < CLASSES ? class : CLASSES - 1);
        seen[c->class[i]] += variance_seen(c, i);
        chance[c->class[i]] += by_chance;
        c->deviation[i] = by_chance;
    }
    for (size_t i = 0; i < c->values; i++) {
        int class = c->class[i];
        double scaled = chance[class] > 0 ? c->deviation[i] * seen[class] / chance[class] : 0;
        c->deviation[i] = sqrt(0.5 * (variance_seen(c, i) + scaled));
    }
}

/* Put values into bins and find c of each class. */
static void find_shares(struct counted *c)
{
    for (size_t i = 0; i < c->values; i++) {
        double s = c->deviation[i], off = fabs(c->solved[i] - c->mean[i]);
        if (!(s > 0))
            continue;
        double place = 16 * log2(1 + off / s); /* from 16 on, x = 2^10 and more, all are certain */
        struct bin *b = &c->bin[c->class[i]][place < BINS ? (int)place : BINS - 1];
        b->s += s;
        b->square += s * s;
        b->x += off;
    }
    for (int k = 0; k < CLASSES; k++) {
        double low = 0, high = 1, sum = 0;
        for (int i = 0; i < BINS; i++)
            sum += c->bin[k][i].x;
        for (int i = 0; i < HALVINGS; i++) {
            double middle = 0.5 * (low + high);
            if (expect(c->bin[k], middle).sum > sum)
                high = middle;
            else
                low = middle;
        }
        c->share[k] = low;
    }
}

/* The variance of sum g R^ over all values (W2), by the replicates, and what it would be if values
 * were independent. g: c->weight. */
static double variance_of_sum(const struct counted *c, double *independent)
{
    double sum[REPLICATES] = {0}, mean = 0, differ = 0;
    for (int r = 0; r < REPLICATES; r++) {
        for (size_t i = 0; i < c->values; i++)
            sum[r] += c->weight[i] * c->replicate[(size_t)r * c->values + i];
        mean += sum[r] / REPLICATES;
    }
    for (int r = 0; r < REPLICATES; r++)
        differ += (sum[r] - mean) * (sum[r] - mean);
    *independent = 0;
    for (size_t i = 0; i < c->values; i++)
        *independent += c->weight[i] * c->weight[i] * c->deviation[i] * c->deviation[i];
    return differ / (REPLICATES * (REPLICATES - 1.0));
}

/* How far the expected sum is from the observed one, in standard deviations; `common`: what noise
 * that values share adds to the variance. */
static double surprise(const struct counted *c, double raise, double observed, double common)
{
    struct expected e = expect_all(c, raise);
    double least = 0.25 * e.variance; /* the replicates know `common` roughly */
    return (e.sum - observed) / sqrt(fmax(e.variance + common, least));
}

static struct RadMeasure measure_l1(struct counted *c)
{
    double observed = 0, value = expect_all(c, 0).errors / c->reflected, independent;
    for (int k = 0; k < CLASSES; k++)
        for (int i = 0; i < BINS; i++)
            observed += c->bin[k][i].x;
    if (!(observed > 0))
        return (struct RadMeasure){0, 0, 0};
    for (size_t i = 0; i < c->values; i++) { /* d |e^| / d R^, and that of the reflected light */
        double off = c->solved[i] - c->mean[i];
        double x =
            c->deviation[i] > 0 ? c->share[c->class[i]] * off / (c->deviation[i] * sqrt(2)) : 0;
        c->weight[i] = -erf(x) - value;
    }
    double common = variance_of_sum(c, &independent) - independent;
    /* A sum that is small by luck must not make the interval that of a better measurement. */
    struct expected none = expect_all(c, -1);
    double lucky = none.sum - sqrt(fmax(none.variance + common, 0.25 * none.variance));
    double low = -1, high = 1, raise[2], judged[2] = {observed, fmax(observed, lucky)};
    while (surprise(c, high, judged[1], common) < T_QUANTILE && high < 1e12)
        high *= 4;
    for (int side = 0; side < 2; side++) {
        double from = side == 0 ? low : 0, to = side == 0 ? 0 : high;
        for (int i = 0; i < HALVINGS; i++) {
            double middle = 0.5 * (from + to);
            if (surprise(c, middle, judged[side], common) < (side == 0 ? -T_QUANTILE : T_QUANTILE))
                from = middle;
            else
                to = middle;
        }
        raise[side] = side == 0 ? from : to;
    }
    return (struct RadMeasure){value, expect_all(c, raise[0]).errors / c->reflected,
                               expect_all(c, raise[1]).errors / c->reflected};
}

static struct RadMeasure measure_power(struct counted *c)
{
    double solved = 0, independent;
    for (size_t i = 0; i < c->values; i++) {
        solved += c->solved[i];
        c->weight[i] = 1;
    }
    double deviation =
        sqrt(variance_of_sum(c, &independent)) * solved / (c->reflected * c->reflected);
    double value = solved / c->reflected - 1;
    return (struct RadMeasure){value, value - T_QUANTILE * deviation,
                               value + T_QUANTILE * deviation};
}

/* Errors per polygon, and the worst. areas: of all sides (m2), [polygons]. */
static void show_polygons(struct face_error *f, const struct counted *c, const double *areas)
{
    double surest = 0;
    for (uint32_t i = 0; i < f->polygons; i++) {
        double off = 0, reflected = 0, variance = 0;
        for (size_t j = (size_t)i * c->bands; j < ((size_t)i + 1) * c->bands; j++) {
            f->error[j] = areas[i] > 0 ? (c->solved[j] - c->mean[j]) / areas[i] : 0;
            f->deviation[j] = areas[i] > 0 ? c->deviation[j] / areas[i] : 0;
            off += c->solved[j] - c->mean[j];
            reflected += c->mean[j];
            variance += c->deviation[j] * c->deviation[j];
        }
        double sure = fabs(off) - FACE_ERROR_SURE * sqrt(variance);
        if (reflected < FACE_ERROR_LARGE * f->reflected || !(sure > surest * reflected))
            continue;
        surest = sure / reflected;
        f->worst = i;
        f->worst_share = off / reflected;
    }
}

/* Everything counted, and how noisy it is. Returns NULL when out of memory. */
static struct counted *counted_open(const struct problem *p, const struct hierarchy *h,
                                    const double *irradiance, const struct tally *tally)
{
    struct counted *c = calloc(1, sizeof *c);
    if (!c)
        return NULL;
    c->bands = p->bands;
    c->values = (size_t)p->scene->input_count * p->bands;
    size_t n = c->values + 1;
    c->solved = calloc(n, sizeof *c->solved);
    c->replicate = calloc(n * REPLICATES, sizeof *c->replicate);
    c->mean = calloc(n, sizeof *c->mean);
    c->deviation = calloc(n, sizeof *c->deviation);
    c->weight = calloc(n, sizeof *c->weight);
    c->class = calloc(n, sizeof *c->class);
    if (!c->solved || !c->replicate || !c->mean || !c->deviation || !c->weight || !c->class) {
        counted_close(c);
        return NULL;
    }
    sum_polygons(c, p, h, irradiance, tally);
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
    double off = NORMAL_QUANTILE * sqrt(variance);
    return (struct RadMeasure){mean / c->reflected, fmax(0, mean - off) / c->reflected,
                               (mean + off) / c->reflected};
}

int face_noise(const struct problem *p, const struct hierarchy *h, const double *irradiance,
               const struct tally *tally, double *noise)
{
    struct counted *c = counted_open(p, h, irradiance, tally);
    if (!c)
        return -1;
    *noise = c->reflected > 0 ? expected_noise(c).value : 0;
    counted_close(c);
    return 0;
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
    double *areas = calloc((size_t)polygons + 1, sizeof *areas);
    if (!c || !areas || open_lists(f) < 0) {
        counted_close(c);
        free(areas);
        face_error_close(f);
        return -1;
    }
    for (uint32_t i = 0; i < h->face_count; i++)
        areas[h->faces[i].input] += h->elements[h->face_element[i]].area;
    f->reflected = c->reflected;
    find_shares(c);
    if (f->reflected > 0) {
        f->noise = expected_noise(c);
        f->power = measure_power(c);
        f->l1 = measure_l1(c);
    }
    show_polygons(f, c, areas);
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
