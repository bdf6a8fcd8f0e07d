/* plain_math.h - the logarithm and the angle that form factors are made of, the same bits on every
 * machine: additions, multiplications and divisions of doubles alone, no branch, so that a loop
 * over them runs several at a time, and none of them differs from one alone.
 *
 * Both are cut down to a short interval by steps without rounding, or nearly, and a polynomial does
 * the rest: of least largest error (Remez's exchange, made for this file with 60 digits), of a
 * degree that leaves less than a rounding. Measured against mpfr's results and long doubles
 * (tests/runtime/check_plain_math.c): at most 1 unit in the last place, the angle 1.5.
 *
 * Needs multiplications and additions that are not fused: -ffp-contract=off.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_PLAIN_MATH_H
#define KERNEL_PLAIN_MATH_H

#include "discussion.h"

#include <string.h>

/* ln 2, the first part so short that it times any exponent is exact. */
#define PLAIN_MATH_LN2 0.69314718036912382
#define PLAIN_MATH_LN2_REST 1.9082149292705877e-10
#define PLAIN_MATH_HALF 0.46364760900080609 /* atan(1/2); what it and pi/4 leave out */
#define PLAIN_MATH_HALF_REST 2.2698777452961687e-17
#define PLAIN_MATH_QUARTER_PI 0.78539816339744828
#define PLAIN_MATH_QUARTER_PI_REST 3.061616997868383e-17

/* ln x of a finite x > 0 that has all its digits, x >= 2.3e-308; of less, 0 included, about -709:
 * enough for a product that is 0 there, such as 0 ln 0. x = 2^k m, m in [sqrt 1/2, sqrt 2),
 * f = m - 1, s = f / (2 + f):
 *     ln m = 2 atanh s = f - s (f - R(s^2)),  R(z) = z (2/3 + 2/5 z + ...). */
TOOL double plain_log(double x)
{
    const uint64_t root = 0x3fe6a09e667f3bcd; /* sqrt 1/2 */
    uint64_t bits, power;
    double m, k;
    memcpy(&bits, &x, sizeof bits);
    bits += 0x3ff0000000000000 - root;
    power = bits >> 52 | 0x4330000000000000; /* of a number in [2^52, 2^53): 2^52 + 1023 + k */
    bits = (bits & 0xfffffffffffff) + root;
    memcpy(&m, &bits, sizeof m);
    memcpy(&k, &power, sizeof k);
    k -= 4503599627370496.0 + 1023;
    double f = m - 1, s = f / (2 + f), z = s * s;
    double r = 0.146178813838630361511;
    r = r * z + 0.153315962345972473467;
    r = r * z + 0.181828932404853293441;
    r = r * z + 0.222222110725671872163;
    r = r * z + 0.285714286264003954123;
    r = r * z + 0.399999999998984455821;
    r = r * z + 0.666666666666666972881;
    return k * PLAIN_MATH_LN2 - ((s * (f - z * r) - k * PLAIN_MATH_LN2_REST) - f);
}

/* The angle in [0, pi] between the axis and (c, s), s >= 0: atan2(s, c); 0 of (0, 0). The slope t
 * in [0, 1] of the nearer axis is turned back by the nearest of 0, atan(1/2), pi/4: (t - tan a) /
 * (1 + t tan a), at most sqrt 5 - 2 = .236. */
TOOL double plain_angle(double s, double c)
{
    double wide = c < 0 ? -c : c;
    double least = s < wide ? s : wide, most = s < wide ? wide : s;
    /* the tangents of the middles between the three */
    int some = least > 0.26 * most, much = least > 0.72 * most;
    double turn = much ? 1 : some ? 0.5 : 0;
    double by = much ? PLAIN_MATH_QUARTER_PI : some ? PLAIN_MATH_HALF : 0;
    double rest = much ? PLAIN_MATH_QUARTER_PI_REST : some ? PLAIN_MATH_HALF_REST : 0;
    double under = most + turn * least;
    double x = (least - turn * most) / (under > 0 ? under : 1), z = x * x;
    double r = -0.0402450039166724400881;
    r = r * z + 0.0573377175763519464422;
    r = r * z - 0.0665679337740348540357;
    r = r * z + 0.0769192117894681616573;
    r = r * z - 0.0909090015583377919048;
    r = r * z + 0.11111110994752937852;
    r = r * z - 0.14285714284954026921;
    r = r * z + 0.199999999999980860314;
    r = r * z - 0.333333333333333325401;
    double angle = by + (x + (x * (z * r) + rest));
    /* from the axis that c lies along, and from its positive end */
    double steep = 2 * PLAIN_MATH_QUARTER_PI - (angle - 2 * PLAIN_MATH_QUARTER_PI_REST);
    angle = s > wide ? steep : angle;
    double back = 4 * PLAIN_MATH_QUARTER_PI - (angle - 4 * PLAIN_MATH_QUARTER_PI_REST);
    return c < 0 ? back : angle;
}

#endif
