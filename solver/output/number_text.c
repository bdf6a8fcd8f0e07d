/* number_text.c - "%.12g" in some tens of nanoseconds, to the byte.
 *
 * x = m 2^e with m of 53 bits. Twelve digits are the integer nearest to x 10^p, of which p is the
 * only one that makes it have twelve. For 1e-15 <= x < 1e12, p, even if guessed one too large, is 0
 * to 27, 5^p has 63 bits and m 5^p 116: so m 5^p 2^(e + p) is an exact 128-bit number shifted, and
 * rounding it, halves to even as printf does, needs no second look. The rest is left to printf.
 * [Steele & White 1990 for the problem; exact for so few digits without their care]
 * SPDX-License-Identifier: MIT */
#include "output/number_text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { DIGITS = 12, FIVES = 28 };

__extension__ typedef unsigned __int128 wide;

/* Eight digits, all of them at once: halves, pairs, then digits, each in its own lane. */
static void eight(char *out, uint32_t n)
{
    uint64_t high = n / 10000, v = high | (uint64_t)(n - 10000 * (uint32_t)high) << 32;
    uint64_t q = (v * 10486 >> 20) & 0x0000007f0000007fu;
    v = q | (v - q * 100) << 16;
    q = (v * 103 >> 10) & 0x000f000f000f000fu;
    v = (q | (v - q * 10) << 8) | 0x3030303030303030u;
    out[0] = (char)v;
    out[1] = (char)(v >> 8);
    out[2] = (char)(v >> 16);
    out[3] = (char)(v >> 24);
    out[4] = (char)(v >> 32);
    out[5] = (char)(v >> 40);
    out[6] = (char)(v >> 48);
    out[7] = (char)(v >> 56);
}

static void four(char *out, uint32_t n)
{
    uint32_t v = n / 100;
    v |= (n - 100 * v) << 16;
    uint32_t q = (v * 103 >> 10) & 0x000f000fu;
    v = (q | (v - q * 10) << 8) | 0x30303030u;
    out[0] = (char)v;
    out[1] = (char)(v >> 8);
    out[2] = (char)(v >> 16);
    out[3] = (char)(v >> 24);
}

/* 5^p, moved left until the highest bit is set, and by how many bits. */
static const struct five {
    uint64_t power;
    int moved;
} fives[FIVES] = {
    {9223372036854775808u, 63},  {11529215046068469760u, 61}, {14411518807585587200u, 59},
    {18014398509481984000u, 57}, {11258999068426240000u, 54}, {14073748835532800000u, 52},
    {17592186044416000000u, 50}, {10995116277760000000u, 47}, {13743895347200000000u, 45},
    {17179869184000000000u, 43}, {10737418240000000000u, 40}, {13421772800000000000u, 38},
    {16777216000000000000u, 36}, {10485760000000000000u, 33}, {13107200000000000000u, 31},
    {16384000000000000000u, 29}, {10240000000000000000u, 26}, {12800000000000000000u, 24},
    {16000000000000000000u, 22}, {10000000000000000000u, 19}, {12500000000000000000u, 17},
    {15625000000000000000u, 15}, {9765625000000000000u, 12},  {12207031250000000000u, 10},
    {15258789062500000000u, 8},  {9536743164062500000u, 5},   {11920928955078125000u, 3},
    {14901161193847656250u, 1},
};

/* 10^k, or the nearest there is to it; for a guess. */
static const double tens[] = {1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6,
                              1e-5,  1e-4,  1e-3,  1e-2,  1e-1,  1,     10,   1e2,  1e3,  1e4,
                              1e5,   1e6,   1e7,   1e8,   1e9,   1e10,  1e11, 1e12};

/* The integer nearest to m 2^e 10^p, m below 2^53, when it has 37 to 63 bits. */
static uint64_t scaled(uint64_t m, int e, int p)
{
    const struct five *five = &fives[p];
    wide product = (wide)(m << 11) * five->power;
    uint64_t high = (uint64_t)(product >> 64), low = (uint64_t)product;
    int shift = five->moved + 11 - 64 - e - p;
    uint64_t n = high >> shift;
    uint64_t half = (uint64_t)1 << (shift - 1);
    uint64_t rest = high & (2 * half - 1);
    return n + (rest > half || (rest == half && (low || (n & 1))));
}

static const char powers[] = "e-05e-06e-07e-08e-09e-10e-11e-12e-13e-14e-15";

/* Digits d, the first worth 10^exponent, as %g lays them out. */
static int lay_out(char *out, const char *d, int exponent)
{
    int n = DIGITS, length = 0;
    while (n > 1 && d[n - 1] == '0')
        n--;
    if (exponent < -4) {
        out[length++] = d[0];
        if (n > 1) {
            out[length++] = '.';
            memcpy(out + length, d + 1, DIGITS - 1);
            length += n - 1;
        }
        memcpy(out + length, powers + 4 * (-exponent - 5), 4);
        return length + 4;
    }
    if (exponent < 0) {
        memcpy(out, "0.000", 5);
        memcpy(out + 1 - exponent, d, DIGITS);
        return 1 - exponent + n;
    }
    memcpy(out, d, (size_t)exponent + 1);
    if (n <= exponent + 1)
        return exponent + 1;
    out[exponent + 1] = '.';
    memcpy(out + exponent + 2, d + exponent + 1, (size_t)(n - exponent - 1));
    return n + 1;
}

int number_text(char out[NUMBER_TEXT], double x)
{
    char d[DIGITS];
    if (x == 0 && !signbit(x)) {
        *out = '0';
        return 1;
    }
    if (!(x >= 1e-15 && x < 999999999999.0)) {
        char text[32];
        int length = snprintf(text, sizeof text, "%.12g", x);
        memcpy(out, text, (size_t)length);
        return length;
    }
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    int e = (int)(bits >> 52) - 1075;
    uint64_t m = (bits & 0xfffffffffffffu) | 0x10000000000000u;
    int exponent = (e + 52) * 1233 >> 12; /* of 2^(e + 52), rounded down: that of x, or one less */
    exponent += x >= tens[exponent + 16];
    uint64_t n = scaled(m, e, DIGITS - 1 - exponent);
    if (n >= 1000000000000u) { /* rounded up to the next power */
        exponent++;
        n = scaled(m, e, DIGITS - 1 - exponent);
    }
    eight(d, (uint32_t)(n / 10000));
    four(d + 8, (uint32_t)(n % 10000));
    return lay_out(out, d, exponent);
}

int number_text_whole(char out[NUMBER_TEXT], uint32_t n)
{
    char d[10];
    int i = 10;
    do {
        d[--i] = (char)('0' + n % 10);
        n /= 10;
    } while (n);
    memcpy(out, d + i, (size_t)(10 - i));
    return 10 - i;
}
