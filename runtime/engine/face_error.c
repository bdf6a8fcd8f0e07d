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
 * L1. The sum of |e^| is above that of |e|, for noise adds where it should cancel. So the question
 * is turned round: which errors would, with the noise that is known, be expected to show this sum?
 * A normal e with a deviation of s has E|e| = m erf(m / (s sqrt 2)) + s sqrt(2 / pi) exp(-m^2 / 2
 * s^2), the folded normal. Let x = |e^| / s. From FACE_ERROR_CERTAIN on, an error is as it is seen.
 * The rest, in classes of polygons with about as many particles, are taken as c s x^a: c is what
 * makes the expected sum of |e^| the observed one, a what does the same for squares. (a = 0: all
 * errors are alike; 1, as good as: they are normal; more: few polygons have them all.)
 *
 * The interval. Among the uncertain: all sums of errors, m^2 raised or lowered alike, that would
 * not make the observed sum a surprise at 95 %, a sum of few being skewed (Cornish and Fisher).
 * With it goes what squares leave open of a, and the noise of certain ones: the surprise is shared
 * between them as is worst. What replicates show the noises of polygons to have in common widens
 * or narrows all of it. The moduli of counts of n are not quite those of differences of counts of
 * n / 2: what noise adds is doubted by 1 / 8 n, which no number of polygons mends. Where nothing
 * but noise is seen, the upper end is no lower than for a sum one standard deviation below what
 * noise alone makes: a power-constrained limit.
 *
 * [folded normal: Leone, Nelson and Nottingham 1961; interval by inversion of a test: Neyman 1937;
 * skewed sums: Cornish and Fisher 1938; the limit: Cowan et al. 2011; the rest: derived here,
 * coverage: tests/runtime/check_measured_error.c]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "engine/face_error.h"
#include "engine/polygon_rows.h"
#include "engine/reflected_light.h"
#include "kernel/constants.h"
#include "kernel/lambert.h"
#include "util/thread_pool.h"

enum { CLASSES = 24, BINS = 24, HALVINGS = 24, TRIES = 10, SPLITS = 4 };

/* of m^2, raised: none that is not certain is left; m is never ten times FACE_ERROR_CERTAIN */
#define LOWEST (-100 * FACE_ERROR_CERTAIN * FACE_ERROR_CERTAIN)
#define NORMAL_QUANTILE 1.959963984540054 /* 97.5 % */
/* 97.5 % of Student's t with REPLICATES - 1 degrees of freedom. */
#define T_QUANTILE 2.131449545559323
_Static_assert(REPLICATES == 16, "T_QUANTILE is that of 15 degrees of freedom");

/* Polygons and bands alike in number of particles and in x = |e^| / s: sums of s, s^2 and s x. */
struct bin {
    double s, square, x;
    double doubt;        /* sum of s times how uncertain it is, as a share */
    double count, error; /* error: m of each, true errors over s, as far as can be told */
};

struct counted {
    struct polygon_rows rows; /* the polygons whose values are here */
    uint32_t bands;
    size_t values;         /* polygons * bands */
    double *solved;        /* [values]: R~ (W) */
    double *replicate;     /* [REPLICATES][values]: R^ of each (W) */
    double *mean;          /* [values]: R^ */
    double *deviation;     /* [values]: s (W) */
    double scale[CLASSES]; /* s of a class by its moduli over that by its squares */
    double *count;        /* [values]: particles by the solution, as far as what came allows that */
    double *weight;       /* [values]: room to work in */
    double reflected;     /* sum of R^ (W) */
    unsigned char *class; /* [values] */
    struct bin bin[CLASSES][BINS];
    double sure, sure_square;     /* of those whose x is beyond all bins: sums of |e^| and s^2 */
    double shape_low, shape_high; /* what shapes may take off and add (W) */
};

static double folded(double m, double s)
{
    double x = m / (s * sqrt(2));
    return m * erf(x) + s * sqrt(2 / LAMBERT_PI) * exp(-x * x);
}

/* The third central moment of |e|, e normal about x with a deviation of 1. */
static double skew(double x)
{
    double first = folded(x, 1), third = (x * x * x + 3 * x) * erf(x / sqrt(2))
                                         + (x * x + 2) * sqrt(2 / LAMBERT_PI) * exp(-x * x / 2);
    return fmax(0, third - 3 * first * (1 + x * x) + 2 * first * first * first);
}

/* The expected sum of |e^|, its moments, and the sum of errors. */
struct expected {
    double sum, variance, skew, errors; /* skew: the third central moment */
};

/* With every m^2 raised by so much, and noise less by so many times its doubt; certain ones are as
 * they are. */
static struct expected expect_all(const struct counted *c, double raise, int less)
{
    struct expected all = {0, 0, 0, 0};
    for (int k = 0; k < CLASSES; k++)
        for (int i = 0; i < BINS; i++) {
            const struct bin *b = &c->bin[k][i];
            if (!(b->s > 0))
                continue;
            double x = sqrt(fmax(0, b->error * b->error + raise)), noise = b->s - less * b->doubt,
                   e = folded(x, noise / b->s);
            all.sum += b->s * e;
            all.variance += b->square * fmax(0, 1 + x * x - e * e);
            all.skew += b->square * (b->square / b->s) * skew(x);
            all.errors += b->s * x;
        }
    return all;
}

/* Errors m = c x^shape in a class, c such that the expected sum is what is seen. Returns the sum of
 * s^2 m^2; *errors: that of s m. */
static double fit(struct bin bins[BINS], double shape, double *errors)
{
    double low = 0, high = 2 * FACE_ERROR_CERTAIN, seen = 0, base[BINS], square = 0;
    for (int i = 0; i < BINS; i++) {
        seen += bins[i].x;
        base[i] = bins[i].s > 0 ? pow(bins[i].x / bins[i].s, shape) : 0;
    }
    for (int i = 0; i < HALVINGS; i++) {
        double middle = 0.5 * (low + high), sum = 0;
        for (int j = 0; j < BINS; j++)
            sum += bins[j].s > 0 ? bins[j].s * folded(middle * base[j], 1) : 0;
        if (sum > seen)
            high = middle;
        else
            low = middle;
    }
    *errors = 0;
    for (int i = 0; i < BINS; i++) {
        bins[i].error = low * base[i];
        *errors += bins[i].s * bins[i].error;
        square += bins[i].square * bins[i].error * bins[i].error;
    }
    return square;
}

/* The shape that makes the sum of squares what is asked for. */
static double shape_of(struct bin bins[BINS], double square, double *errors)
{
    double low = 0, high = FACE_ERROR_SHAPE;
    for (int i = 0; i < TRIES; i++) {
        double middle = 0.5 * (low + high);
        if (fit(bins, middle, errors) > square)
            high = middle;
        else
            low = middle;
    }
    fit(bins, low, errors);
    return low;
}

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
    double seen[CLASSES] = {0}, chance[CLASSES] = {0}, count[CLASSES] = {0},
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
        c->class[i] = (unsigned char)(class < CLASSES ? class : CLASSES - 1);
        seen[c->class[i]] += variance_seen(c, i);
        chance[c->class[i]] += by_chance;
        count[c->class[i]] += by_chance > 0;
        c->deviation[i] = by_chance;
    }
    polygon_rows_sum(&c->rows, seen, CLASSES);
    polygon_rows_sum(&c->rows, chance, CLASSES);
    polygon_rows_sum(&c->rows, count, CLASSES);
    /* of few particles replicates may have met none of a class: as if one polygon more were by
     * chance */
    for (int k = 0; k < CLASSES && !tally->by_paths; k++) {
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
    double apart[CLASSES] = {0}, normal[CLASSES] = {0}, count[CLASSES] = {0};
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
    polygon_rows_sum(&c->rows, apart, CLASSES);
    polygon_rows_sum(&c->rows, normal, CLASSES);
    polygon_rows_sum(&c->rows, count, CLASSES);
    for (int k = 0; k < CLASSES; k++)
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

/* The bin of a value; BINS: its error is as it is seen. Where next to no particle comes moduli are
 * small because few values have them all, so an error has to stand out of squares as well. */
static int bin_of(const struct counted *c, size_t i)
{
    const double s = noise_by_moduli(c, i), off = fabs(c->solved[i] - c->mean[i]);
    if (off >= FACE_ERROR_CERTAIN * fmax(s, c->deviation[i]))
        return BINS;
    return (int)fmin(off / s * (BINS / FACE_ERROR_CERTAIN), BINS - 1);
}

/* Put values into bins and find their errors. */
static void find_errors(struct counted *c)
{
    double seen[CLASSES] = {0};
    for (size_t i = 0; i < c->values; i++) {
        double rms = c->deviation[i], s = noise_by_moduli(c, i),
               off = fabs(c->solved[i] - c->mean[i]);
        if (!(s > 0))
            continue;
        const int at = bin_of(c, i);
        if (at == BINS) {
            c->sure += off;
            c->sure_square += s * s;
            continue;
        }
        struct bin *b = &c->bin[c->class[i]][at];
        b->s += s;
        b->square += s * s;
        b->x += off;
        b->doubt += s * doubt_of(c->class[i]);
        b->count++;
        seen[c->class[i]] += off * off - rms * rms;
    }
    _Static_assert(sizeof(struct bin) == 6 * sizeof(double), "bins are added as they stand");
    polygon_rows_sum(&c->rows, &c->bin[0][0].s, (size_t)CLASSES * BINS * 6);
    polygon_rows_sum(&c->rows, seen, CLASSES);
    polygon_rows_sum(&c->rows, &c->sure, 1);
    polygon_rows_sum(&c->rows, &c->sure_square, 1);
    for (int k = 0; k < CLASSES; k++) {
        int filled = 0;
        double spread = 0, at = 0, less = 0, more = 0;
        for (int i = 0; i < BINS; i++) {
            const struct bin *b = &c->bin[k][i];
            double x = b->s > 0 ? b->x / b->s : 0;
            filled += b->count > 0;
            if (b->count > 0)
                spread += b->square * b->square / b->count
                          * (2 + 1 / exp2(2 * k) + 4 * fmax(0, x * x - 1));
        }
        if (filled == 0)
            continue;
        if (filled == 1) { /* has no shape */
            fit(c->bin[k], 1, &at);
            continue;
        }
        shape_of(c->bin[k], seen[k] + NORMAL_QUANTILE * sqrt(spread), &less);
        shape_of(c->bin[k], seen[k] - NORMAL_QUANTILE * sqrt(spread), &more);
        shape_of(c->bin[k], seen[k], &at);
        c->shape_low += (at - less) * (at - less);
        c->shape_high += (more - at) * (more - at);
    }
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

/* How far the expected sum is from the observed one, in standard deviations that the skewness of
 * sums of few has been taken from; `common`: by what the noise that values share multiplies the
 * variance. */
static double surprise(const struct counted *c, double raise, int less, double observed,
                       double common)
{
    struct expected e = expect_all(c, raise, less);
    if (!(e.variance > 0))
        return 0;
    double skewed = e.skew / pow(e.variance, 1.5) * (T_QUANTILE * T_QUANTILE - 1) / 6;
    return (e.sum - observed) / sqrt(e.variance * common) + skewed;
}

/* How far all m^2, raised or lowered alike, may take the sum of errors (W) until what is observed
 * would be a surprise of so many standard deviations. */
static double reach(const struct counted *c, int sign, double surprised, double observed,
                    double common)
{
    double near = 0, far = sign < 0 ? LOWEST : 1;
    struct expected now = expect_all(c, 0, 0);
    if (!(now.variance > 0))
        return 0;
    while (sign > 0 && far < 1e12 && surprise(c, far, sign, observed, common) < surprised)
        far *= 4;
    for (int i = 0; i < HALVINGS; i++) {
        double middle = 0.5 * (near + far);
        if (sign * surprise(c, middle, sign, observed, common) < surprised)
            near = middle;
        else
            far = middle;
    }
    return sign * (expect_all(c, near, sign).errors - now.errors);
}

/* The most that errors may be above or below what they are thought to be (W): 95 % are shared, as
 * is worst, between what is seen through noise, and the certain ones with the shape of the rest. */
static double farthest(const struct counted *c, int sign, double observed, double common)
{
    double shape = sign < 0 ? c->shape_low : c->shape_high, most = 0;
    double sure = sqrt(T_QUANTILE * T_QUANTILE * c->sure_square * common + shape);
    for (int i = 0; i <= SPLITS; i++) {
        double angle = LAMBERT_PI / 2 * i / SPLITS;
        double all = reach(c, sign, T_QUANTILE * cos(angle), observed, common) + sure * sin(angle);
        most = fmax(most, all);
    }
    return most;
}

static struct RadMeasure measure_l1(struct counted *c)
{
    struct expected now = expect_all(c, 0, 0);
    double observed = 0, value = now.errors + c->sure, all = c->reflected, independent = 0;
    for (int k = 0; k < CLASSES; k++)
        for (int i = 0; i < BINS; i++)
            observed += c->bin[k][i].x;
    for (size_t i = 0; i < c->values; i++) { /* d |e^| / d R^, and that of the reflected light */
        double off = c->solved[i] - c->mean[i];
        double s = noise_by_moduli(c, i), x = s > 0 ? off / s : 0;
        const int at = s > 0 ? bin_of(c, i) : BINS;
        if (at < BINS)
            x = copysign(c->bin[c->class[i]][at].error, x);
        double slope = erf(x / sqrt(2));
        c->weight[i] = -slope - value / all;
        independent += slope * slope * s * s;
    }
    polygon_rows_sum(&c->rows, &independent, 1);
    double seen = variance_of_sum(c), chance = now.variance + c->sure_square;
    double common = chance > 0 ? fmax(0.25, 1 + (seen - independent) / chance) : 1;
    /* A sum that is small by luck must not make the interval that of a better measurement. */
    struct expected none = expect_all(c, LOWEST, 0);
    double lucky = none.sum - sqrt(none.variance * common);
    double low = farthest(c, -1, observed, common),
           high = farthest(c, 1, fmax(observed, lucky), common);
    return (struct RadMeasure){value / all, fmax(0, value - low) / all, (value + high) / all};
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
    return (struct RadMeasure){value, value - T_QUANTILE * deviation,
                               value + T_QUANTILE * deviation};
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
    double off = NORMAL_QUANTILE * sqrt(variance);
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
    *noise = (struct face_noise){0, 0};
    if (!failed && c->reflected > 0)
        *noise = (struct face_noise){expected_noise(c).value,
                                     noise_of_large(c, areas, large_area(p, h))};
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
