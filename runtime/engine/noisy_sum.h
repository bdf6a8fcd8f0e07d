/* noisy_sum.h - sums of the moduli of many values, each known with noise: which sum of true errors
 * stands behind them, and in which interval.
 * SPDX-License-Identifier: MIT */
#ifndef NOISY_SUM_H
#define NOISY_SUM_H

enum { NOISY_CLASSES = 24, NOISY_BINS = 24 };

/* Polygons and bands alike in number of particles and in x = |e^| / s: sums of s, s^2 and s x. */
struct noisy_bin {
    double s, square, x;
    double doubt;        /* sum of s times how uncertain it is, as a share */
    double count, error; /* error: m of each, true errors over s, as far as can be told */
};

/* Of all values: those seen through noise in bins, and the rest, which are as they are seen.
 * Whoever counts fills s to count of the bins, and both sums; zeros before. */
struct noisy_sum {
    struct noisy_bin bin[NOISY_CLASSES][NOISY_BINS];
    double sure, sure_square;     /* of those whose x is beyond all bins: sums of |e^| and s^2 */
    double shape_low, shape_high; /* what shapes may take off and add (W), by noisy_sum_fit */
};

/* Find the errors of bins. squares: of each class the sum of the squares of its true errors, as far
 * as it can be told (W2). */
void noisy_sum_fit(struct noisy_sum *sum, const double squares[NOISY_CLASSES]);

/* The sum of |e| (W), and the variance of that of |e^| where values are independent (W2). */
struct noisy_errors {
    double sum, variance;
};
struct noisy_errors noisy_sum_errors(const struct noisy_sum *sum);

/* How far the sum of |e| may be below and above that (W, 95 %); `common`: by what the noise that
 * values share multiplies its variance. */
void noisy_sum_reach(const struct noisy_sum *sum, double common, double *below, double *above);

#endif
