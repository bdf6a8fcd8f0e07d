/* closed_forms.h - view factors that are known: what form factors are measured against.
 * In long double, since the forms subtract what is nearly equal. Numbers C-xx: Howell, A Catalog of
 * Radiation Heat Transfer Configuration Factors.
 * SPDX-License-Identifier: MIT */
#ifndef CLOSED_FORMS_H
#define CLOSED_FORMS_H

#include <math.h>

#define CLOSED_PI 3.141592653589793238462643383279502884L

/* C-11: aligned parallel rectangles a x b at distance c. */
static inline double closed_parallel(double a, double b, double c)
{
    long double x = (long double)a / c, y = (long double)b / c, p = sqrtl(1 + x * x),
                q = sqrtl(1 + y * y);
    return (double)(2 / (CLOSED_PI * x * y)
                    * (logl(p * q / sqrtl(1 + x * x + y * y)) + x * q * atanl(x / q)
                       + y * p * atanl(y / p) - x * atanl(x) - y * atanl(y)));
}

/* C-13: parallel rectangles at distance h, sides along two axes: the area of either times its
 * factor to the other (m2). */
static inline double closed_offset(const double low[2][2], const double high[2][2], double h)
{
    double sum = 0;
    for (int ends = 0; ends < 16; ends++) {
        double apart[2], sign = 1;
        for (int k = 0; k < 2; k++) {
            const int mine = ends >> k & 1, its = ends >> (k + 2) & 1;
            apart[k] = (mine ? high : low)[0][k] - (its ? high : low)[1][k];
            sign = mine == its ? sign : -sign;
        }
        const double u = apart[0], v = apart[1], p = sqrt(u * u + h * h), q = sqrt(v * v + h * h);
        sum +=
            sign
            * (v * p * atan(v / p) + u * q * atan(u / q) - h * h / 2 * log(u * u + v * v + h * h));
    }
    return sum / (double)(2 * CLOSED_PI);
}

/* C-14: perpendicular rectangles with a common edge l, from width w to height h. */
static inline double closed_perpendicular(double w, double h, double l)
{
    long double W = (long double)w / l, H = (long double)h / l, s2 = W * W + H * H, s = sqrtl(s2);
    long double t = (1 + W * W) * (1 + H * H) / (1 + s2);
    long double u = powl(W * W * (1 + s2) / ((1 + W * W) * s2), W * W);
    long double v = powl(H * H * (1 + s2) / ((1 + H * H) * s2), H * H);
    return (
        double)((W * atanl(1 / W) + H * atanl(1 / H) - s * atanl(1 / s) + 0.25L * logl(t * u * v))
                / (CLOSED_PI * W));
}

/* C-41: coaxial parallel discs, from radius r to radius s at distance h. */
static inline double closed_discs(double r, double s, double h)
{
    double x = 1 + (h * h + s * s) / (r * r);
    return 0.5 * (x - sqrt(x * x - 4 * (s / r) * (s / r)));
}

/* B-4: from a point to a parallel rectangle a x b at height d, one corner above the point. */
static inline double closed_corner(double a, double b, double d)
{
    double x = a / d, y = b / d, p = sqrt(1 + x * x), q = sqrt(1 + y * y);
    return (x / p * atan(y / p) + y / q * atan(x / q)) / (2 * M_PI);
}

/* Crossed strings, strips without end: from the segment a-b to the segment c-d of the plane, which
 * see each other whole; a-d and b-c are the uncrossed strings. [Hottel 1954] */
static inline double closed_strips(const double a[2], const double b[2], const double c[2],
                                   const double d[2])
{
    double crossed = hypot(c[0] - a[0], c[1] - a[1]) + hypot(d[0] - b[0], d[1] - b[1]);
    double uncrossed = hypot(d[0] - a[0], d[1] - a[1]) + hypot(c[0] - b[0], c[1] - b[1]);
    return (crossed - uncrossed) / (2 * hypot(b[0] - a[0], b[1] - a[1]));
}

#endif
