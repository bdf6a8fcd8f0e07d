/* face_error.c - how far from the truth, by what particles say of every polygon.
 *
 * The error of one value is e = R~ - R, reflected power by the solution less the truth; known is
 * e^ = R~ - R^, R^ counted: e with a noise whose deviation is s (polygon_counts.h).
 *
 * Power. The sum of e^ over that of R^, with Student's interval of the replicates.
 *
 * L1. The sum of |e^| is above that of |e|, for noise adds where it should cancel. What it adds is
 * told by the replicates themselves: half of them less the other half, over 2, has the noise of the
 * mean of all and no error in it. By that s of a class of many polygons is scaled, as errors below
 * a third of the noise make that sum but a twentieth larger. Which sum of errors stands behind that
 * of |e^|, and in which interval, noisy_sum.c tells. What replicates show the noises of polygons to
 * have in common widens or narrows it. The moduli of counts of n are not quite those of differences
 * of counts of n / 2: what noise adds is doubted by 1 / 8 n, which no number of polygons mends.
 *
 * [derived here; coverage: tests/runtime/check_measured_error.c]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "engine/face_error.h"
#include "engine/reflected_light.h"
#include "kernel/constants.h"

/* Counts being judged. */
struct judged {
    const struct polygon_counts *c;
    double *weight;              /* [values]: room to work in */
    double scale[NOISY_CLASSES]; /* s of a class by its moduli over that by its squares */
    struct noisy_sum sum;
};

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
static void find_scales(struct judged *j)
{
    const struct polygon_counts *c = j->c;
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
        normal[c->class[i]] += mean_modulus(c->deviation[i]);
        count[c->class[i]]++;
    }
    polygon_rows_sum(&c->rows, apart, NOISY_CLASSES);
    polygon_rows_sum(&c->rows, normal, NOISY_CLASSES);
    polygon_rows_sum(&c->rows, count, NOISY_CLASSES);
    for (int k = 0; k < NOISY_CLASSES; k++)
        j->scale[k] =
            normal[k] > 0
                ? 1 + (apart[k] / normal[k] - 1) * count[k] / (count[k] + FACE_ERROR_ALIKE)
                : 1;
}

/* The deviation of noise whose moduli are as large (W). */
static double noise_by_moduli(const struct judged *j, size_t i)
{
    return j->c->deviation[i] * j->scale[j->c->class[i]];
}

/* The bin of a value; NOISY_BINS: its error is as it is seen. Where next to no particle comes
 * moduli are small because few values have them all, so an error has to stand out of squares as
 * well. */
static int bin_of(const struct judged *j, size_t i)
{
    const struct polygon_counts *c = j->c;
    const double s = noise_by_moduli(j, i), off = fabs(c->solved[i] - c->mean[i]);
    if (off >= FACE_ERROR_CERTAIN * fmax(s, c->deviation[i]))
        return NOISY_BINS;
    return (int)fmin(off / s * (NOISY_BINS / FACE_ERROR_CERTAIN), NOISY_BINS - 1);
}

/* Put values into bins and find their errors. */
static void find_errors(struct judged *j)
{
    const struct polygon_counts *c = j->c;
    double seen[NOISY_CLASSES] = {0};
    for (size_t i = 0; i < c->values; i++) {
        double rms = c->deviation[i], s = noise_by_moduli(j, i),
               off = fabs(c->solved[i] - c->mean[i]);
        if (!(s > 0))
            continue;
        const int at = bin_of(j, i);
        if (at == NOISY_BINS) {
            j->sum.sure += off;
            j->sum.sure_square += s * s;
            continue;
        }
        struct noisy_bin *b = &j->sum.bin[c->class[i]][at];
        b->s += s;
        b->square += s * s;
        b->x += off;
        b->doubt += s * doubt_of(c->class[i]);
        b->count++;
        seen[c->class[i]] += off * off - rms * rms;
    }
    _Static_assert(sizeof(struct noisy_bin) == 6 * sizeof(double), "bins are added as they stand");
    polygon_rows_sum(&c->rows, &j->sum.bin[0][0].s, (size_t)NOISY_CLASSES * NOISY_BINS * 6);
    polygon_rows_sum(&c->rows, seen, NOISY_CLASSES);
    polygon_rows_sum(&c->rows, &j->sum.sure, 1);
    polygon_rows_sum(&c->rows, &j->sum.sure_square, 1);
    noisy_sum_fit(&j->sum, seen);
}

/* The variance of sum g R^ over all values (W2), by the replicates. g: j->weight. */
static double variance_of_sum(const struct judged *j)
{
    const struct polygon_counts *c = j->c;
    double sum[REPLICATES] = {0}, variance;
    for (int r = 0; r < REPLICATES; r++)
        for (size_t i = 0; i < c->values; i++)
            sum[r] += j->weight[i] * c->replicate[(size_t)r * c->values + i];
    polygon_rows_sum(&c->rows, sum, REPLICATES);
    (void)replicates_mean(sum, &variance);
    return variance;
}

static struct RadMeasure measure_l1(struct judged *j)
{
    const struct polygon_counts *c = j->c;
    const struct noisy_errors errors = noisy_sum_errors(&j->sum);
    double value = errors.sum, all = c->reflected, independent = 0, below, above;
    for (size_t i = 0; i < c->values; i++) { /* d |e^| / d R^, and that of the reflected light */
        double off = c->solved[i] - c->mean[i];
        double s = noise_by_moduli(j, i), x = s > 0 ? off / s : 0;
        const int at = s > 0 ? bin_of(j, i) : NOISY_BINS;
        if (at < NOISY_BINS)
            x = copysign(j->sum.bin[c->class[i]][at].error, x);
        double slope = erf(x / sqrt(2));
        j->weight[i] = -slope - value / all;
        independent += slope * slope * s * s;
    }
    polygon_rows_sum(&c->rows, &independent, 1);
    double seen = variance_of_sum(j), chance = errors.variance;
    double common = chance > 0 ? fmax(0.25, 1 + (seen - independent) / chance) : 1;
    noisy_sum_reach(&j->sum, common, &below, &above);
    return (struct RadMeasure){value / all, fmax(0, value - below) / all, (value + above) / all};
}

/* Particles that lose light in one way may all have been spared: one more is allowed for, which is
 * that share of all that is reflected. */
static struct RadMeasure measure_power(struct judged *j, double particles)
{
    const struct polygon_counts *c = j->c;
    double solved = 0;
    for (size_t i = 0; i < c->values; i++) {
        solved += c->solved[i];
        j->weight[i] = 1;
    }
    polygon_rows_sum(&c->rows, &solved, 1);
    double noise = variance_of_sum(j) / (c->reflected * c->reflected),
           deviation = sqrt(noise + 1 / (particles * particles)) * solved / c->reflected;
    double value = solved / c->reflected - 1;
    return (struct RadMeasure){value, value - REPLICATES_T * deviation,
                               value + REPLICATES_T * deviation};
}

/* What is shown of all ranks' polygons. */
static void show_all(struct face_error *f, const struct polygon_counts *c)
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
static void show_polygons(struct face_error *f, const struct polygon_counts *c, const double *areas,
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
        /* where none of a band has come, which the next may bring, replicates agree on nothing */
        double sure = fabs(off) - FACE_ERROR_SURE * fmax(noise, c->most[row]);
        if (!(areas[i] > large) || !(reflected > 0) || !(sure > f->worst_sure * reflected))
            continue;
        f->worst = i;
        f->worst_share = off / reflected;
        f->worst_sure = sure / reflected;
    }
    show_all(f, c);
}

/* Where no particle had any of a band, and the solution has, they know none of it. */
static void find_bands(const struct polygon_counts *c, double light[3], double band_noise[3])
{
    enum { BANDS = 3, SUMS = 3 * BANDS };
    double sum[SUMS] = {0}, *mean = sum, *solved = mean + BANDS, *noise = solved + BANDS;
    for (size_t i = 0; i < c->values; i++) {
        const size_t k = i % c->bands;
        mean[k] += c->mean[i];
        solved[k] += c->solved[i];
        noise[k] += mean_modulus(c->deviation[i]);
    }
    polygon_rows_sum(&c->rows, sum, SUMS);
    const double all = solved[0] + solved[1] + solved[2];
    for (size_t k = 0; k < c->bands && all > 0; k++) {
        light[k] = solved[k] / all;
        band_noise[k] = mean[k] > 0 ? noise[k] / mean[k] : solved[k] > 0;
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

void face_error_agree(struct face_error *f)
{
    const double sure = fmax(f->power.low, -f->power.high);
    if (!(sure > 0) || !isfinite(sure))
        return;
    f->l1.low = fmax(f->l1.low, sure);
    f->l1.value = fmax(f->l1.value, sure);
    f->l1.high = fmax(f->l1.high, sure);
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
    struct polygon_counts *c = polygon_counts_open(p, h, irradiance, tally);
    struct judged j = {.c = c};
    double *areas = polygon_areas(p, h);
    j.weight = c ? malloc((c->values + 1) * sizeof *j.weight) : NULL;
    const int failed = !j.weight || !areas || open_lists(f) < 0;
    if (ranks_any(tally->quarters ? p->options.ranks : NULL, failed)) {
        polygon_counts_close(c);
        free(areas);
        free(j.weight);
        face_error_close(f);
        return -1;
    }
    f->reflected = c->reflected;
    if (!(f->reflected > 0))
        show_nothing(f, unseen_light(p, tally));
    find_scales(&j);
    find_errors(&j);
    if (f->reflected > 0) {
        f->noise = polygon_counts_noise(c);
        f->power = measure_power(&j, (double)tally->particles * REPLICATES);
        f->l1 = measure_l1(&j);
        face_error_agree(f);
    }
    show_polygons(f, c, areas, large_area(p, h));
    find_bands(c, f->band_light, f->band_noise);
    polygon_counts_close(c);
    free(areas);
    free(j.weight);
    return 0;
}

int band_noise_find(const struct problem *p, const struct hierarchy *h, const double *irradiance,
                    const struct tally *tally, double noise[3])
{
    double light[3];
    struct polygon_counts *c = polygon_counts_open(p, h, irradiance, tally);
    if (c)
        find_bands(c, light, noise);
    polygon_counts_close(c);
    return c ? 0 : -1;
}

void face_error_close(struct face_error *f)
{
    free(f->error);
    free(f->deviation);
    *f = (struct face_error){0};
}
