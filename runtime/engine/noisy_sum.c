/* noisy_sum.c - which sum of errors stands behind a sum of moduli seen through noise.
 *
 * The sum of moduli |e^| is above that of |e|, for noise adds where it should cancel. So the
 * question is turned round: which errors would, with the noise that is known, be expected to show
 * this sum? A normal e^ about m with a deviation of s has E|e^| = m erf(m / (s sqrt 2)) + s sqrt(2
 * / pi) exp(-m^2 / 2 s^2), the folded normal. Let x = |e^| / s. From FACE_ERROR_CERTAIN on, an
 * error is as it is seen. The rest, in classes of polygons with about as many particles, are taken
 * as c s x^a: c is what makes the expected sum of |e^| the observed one, a what does the same for
 * squares. (a = 0: all errors are alike; 1, as good as: they are normal; more: few polygons have
 * them all.)
 *
 * The interval. Among the uncertain: all sums of errors, m^2 raised or lowered alike, that would
 * not make the observed sum a surprise at 95 %, a sum of few being skewed (Cornish and Fisher).
 * With it goes what squares leave open of a, and the noise of certain ones: the surprise is shared
 * between them as is worst. What noises have in common widens or narrows all of it, and the noise
 * of a class may be more or less by what is doubted of it. Where nothing but noise is seen, the
 * upper end is no lower than for a sum one standard deviation below what noise alone makes: a
 * power-constrained limit.
 *
 * [folded normal: Leone, Nelson and Nottingham 1961; interval by inversion of a test: Neyman 1937;
 * skewed sums: Cornish and Fisher 1938; the limit: Cowan et al. 2011; the rest: derived here,
 * coverage: tests/runtime/check_measured_error.c]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "engine/noisy_sum.h"
#include "kernel/constants.h"
#include "kernel/lambert.h"
#include "particles/particles.h"

enum { HALVINGS = 24, TRIES = 10, SPLITS = 4 };

/* of m^2, raised: none that is not certain is left; m is never ten times FACE_ERROR_CERTAIN */
#define LOWEST (-100 * FACE_ERROR_CERTAIN * FACE_ERROR_CERTAIN)

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
struct noisy_expected {
    double sum, variance, skew, errors; /* skew: the third central moment */
};

/* With every m^2 raised by so much, and noise less by so many times its doubt; certain ones are as
 * they are. */
static struct noisy_expected expect_all(const struct noisy_sum *n, double raise, int less)
{
    struct noisy_expected all = {0, 0, 0, 0};
    for (int k = 0; k < NOISY_CLASSES; k++)
        for (int i = 0; i < NOISY_BINS; i++) {
            const struct noisy_bin *b = &n->bin[k][i];
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
static double fit(struct noisy_bin bins[NOISY_BINS], double shape, double *errors)
{
    double low = 0, high = 2 * FACE_ERROR_CERTAIN, seen = 0, base[NOISY_BINS], square = 0;
    for (int i = 0; i < NOISY_BINS; i++) {
        seen += bins[i].x;
        base[i] = bins[i].s > 0 ? pow(bins[i].x / bins[i].s, shape) : 0;
    }
    for (int i = 0; i < HALVINGS; i++) {
        double middle = 0.5 * (low + high), sum = 0;
        for (int j = 0; j < NOISY_BINS; j++)
            sum += bins[j].s > 0 ? bins[j].s * folded(middle * base[j], 1) : 0;
        if (sum > seen)
            high = middle;
        else
            low = middle;
    }
    *errors = 0;
    for (int i = 0; i < NOISY_BINS; i++) {
        bins[i].error = low * base[i];
        *errors += bins[i].s * bins[i].error;
        square += bins[i].square * bins[i].error * bins[i].error;
    }
    return square;
}

/* By the shape that makes the sum of squares what is asked for: the sum of s m. */
static double fit_shape(struct noisy_bin bins[NOISY_BINS], double square)
{
    double low = 0, high = FACE_ERROR_SHAPE, errors;
    for (int i = 0; i < TRIES; i++) {
        double middle = 0.5 * (low + high);
        if (fit(bins, middle, &errors) > square)
            high = middle;
        else
            low = middle;
    }
    fit(bins, low, &errors);
    return errors;
}

void noisy_sum_fit(struct noisy_sum *n, const double squares[NOISY_CLASSES])
{
    for (int k = 0; k < NOISY_CLASSES; k++) {
        int filled = 0;
        double spread = 0, errors;
        for (int i = 0; i < NOISY_BINS; i++) {
            const struct noisy_bin *b = &n->bin[k][i];
            double x = b->s > 0 ? b->x / b->s : 0;
            filled += b->count > 0;
            if (b->count > 0)
                spread += b->square * b->square / b->count
                          * (2 + 1 / exp2(2 * k) + 4 * fmax(0, x * x - 1));
        }
        if (filled == 0)
            continue;
        if (filled == 1) { /* has no shape */
            fit(n->bin[k], 1, &errors);
            continue;
        }
        const double off = NORMAL_T * sqrt(spread), less = fit_shape(n->bin[k], squares[k] + off),
                     more = fit_shape(n->bin[k], squares[k] - off),
                     at = fit_shape(n->bin[k], squares[k]); /* the last: bins keep its errors */
        n->shape_low += (at - less) * (at - less);
        n->shape_high += (more - at) * (more - at);
    }
}

/* How far the expected sum is from the observed one, in standard deviations that the skewness of
 * sums of few has been taken from; `common`: by what the noise that values share multiplies the
 * variance. */
static double surprise(const struct noisy_sum *n, double raise, int less, double observed,
                       double common)
{
    struct noisy_expected e = expect_all(n, raise, less);
    if (!(e.variance > 0))
        return 0;
    double skewed = e.skew / pow(e.variance, 1.5) * (REPLICATES_T * REPLICATES_T - 1) / 6;
    return (e.sum - observed) / sqrt(e.variance * common) + skewed;
}

/* How far all m^2, raised or lowered alike, may take the sum of errors (W) until what is observed
 * would be a surprise of so many standard deviations. */
static double reach(const struct noisy_sum *n, int sign, double surprised, double observed,
                    double common)
{
    double near = 0, far = sign < 0 ? LOWEST : 1;
    struct noisy_expected now = expect_all(n, 0, 0);
    if (!(now.variance > 0))
        return 0;
    while (sign > 0 && far < 1e12 && surprise(n, far, sign, observed, common) < surprised)
        far *= 4;
    for (int i = 0; i < HALVINGS; i++) {
        double middle = 0.5 * (near + far);
        if (sign * surprise(n, middle, sign, observed, common) < surprised)
            near = middle;
        else
            far = middle;
    }
    return sign * (expect_all(n, near, sign).errors - now.errors);
}

/* The most that errors may be above or below what they are thought to be (W): 95 % are shared, as
 * is worst, between what is seen through noise, and the certain ones with the shape of the rest. */
static double farthest(const struct noisy_sum *n, int sign, double observed, double common)
{
    double shape = sign < 0 ? n->shape_low : n->shape_high, most = 0;
    double sure = sqrt(REPLICATES_T * REPLICATES_T * n->sure_square * common + shape);
    for (int i = 0; i <= SPLITS; i++) {
        double angle = LAMBERT_PI / 2 * i / SPLITS;
        double all =
            reach(n, sign, REPLICATES_T * cos(angle), observed, common) + sure * sin(angle);
        most = fmax(most, all);
    }
    return most;
}

struct noisy_errors noisy_sum_errors(const struct noisy_sum *n)
{
    const struct noisy_expected now = expect_all(n, 0, 0);
    return (struct noisy_errors){now.errors + n->sure, now.variance + n->sure_square};
}

void noisy_sum_reach(const struct noisy_sum *n, double common, double *below, double *above)
{
    double observed = 0;
    for (int k = 0; k < NOISY_CLASSES; k++)
        for (int i = 0; i < NOISY_BINS; i++)
            observed += n->bin[k][i].x;
    /* A sum that is small by luck must not make the interval that of a better measurement. */
    const struct noisy_expected none = expect_all(n, LOWEST, 0);
    const double lucky = none.sum - sqrt(none.variance * common);
    *below = farthest(n, -1, observed, common);
    *above = farthest(n, 1, fmax(observed, lucky), common);
}
