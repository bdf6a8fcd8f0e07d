/* sobol.h - points spread evenly over four dimensions: Sobol's net, its digits shifted.
 *
 * The first 2^m points stand one each in the boxes of many subdivisions, so that means over them
 * are off by less than those of chance. A hash shifts the digits (exclusive or), which keeps that,
 * and nets of different hashes have nothing to do with each other. [direction numbers: Joe & Kuo
 * 2008; the order of Gray codes: Antonov and Saleev 1979; the shift: L'Ecuyer and Lemieux 2002]
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_SOBOL_H
#define KERNEL_SOBOL_H

#include "discussion.h"
#include "kernel/hash.h"

enum { SOBOL_MOST = 4096 }; /* points that there are digits for */

struct sobol {
    uint32_t digit[4];
};

/* The net that the hash shifts. */
static inline void sobol_start(struct sobol *net, uint64_t hash)
{
    for (int k = 0; k < 4; k += 2) {
        net->digit[k] = (uint32_t)(hash >> 32);
        net->digit[k + 1] = (uint32_t)hash;
        hash = hash64(hash);
    }
}

/* The digits of points first to first + count - 1, first a multiple of SEGMENTS_MAX, in the order
 * of Gray codes; up to 15 more are written. The four low bits of an index have a table; what each
 * of the others toggles is the sum of its direction number and the one before. */
static inline void sobol_points(const struct sobol *net, int first, int count,
                                uint32_t digit[4][SEGMENTS_MAX])
{
    /* The leading four digits of the first 16 points; they have no others. */
    static const uint32_t low[4][16] = {
        {0x0, 0x8, 0xc, 0x4, 0x6, 0xe, 0xa, 0x2, 0x3, 0xb, 0xf, 0x7, 0x5, 0xd, 0x9, 0x1},
        {0x0, 0x8, 0x4, 0xc, 0x6, 0xe, 0x2, 0xa, 0x5, 0xd, 0x1, 0x9, 0x3, 0xb, 0x7, 0xf},
        {0x0, 0x8, 0x4, 0xc, 0xa, 0x2, 0xe, 0x6, 0xf, 0x7, 0xb, 0x3, 0x5, 0xd, 0x1, 0x9},
        {0x0, 0x8, 0x4, 0xc, 0xe, 0x6, 0xa, 0x2, 0x7, 0xf, 0x3, 0xb, 0x9, 0x1, 0xd, 0x5},
    };
    static const uint32_t toggle[8][4] = {
        {0x18000000u, 0x78000000u, 0x78000000u, 0xa8000000u},
        {0x0c000000u, 0x44000000u, 0xb4000000u, 0x8c000000u},
        {0x06000000u, 0x66000000u, 0xd2000000u, 0xd6000000u},
        {0x03000000u, 0x55000000u, 0x4b000000u, 0x31000000u},
        {0x01800000u, 0x7f800000u, 0xad800000u, 0x4b800000u},
        {0x00c00000u, 0x40400000u, 0xf4400000u, 0xfdc00000u},
        {0x00600000u, 0x60600000u, 0x72a00000u, 0x7ca00000u},
        {0x00300000u, 0x50500000u, 0xbbf00000u, 0xbf300000u},
    };
    for (int at = 0; at < count; at += 16) {
        uint32_t shift[4];
        for (int k = 0; k < 4; k++)
            shift[k] = net->digit[k];
        const uint32_t(*of)[4] = toggle;
        for (int bits = (first + at) >> 4; bits; bits >>= 1, of++)
            for (int k = 0; bits & 1 && k < 4; k++)
                shift[k] ^= (*of)[k];
        for (int k = 0; k < 4; k++)
            for (int i = 0; i < 16; i++)
                digit[k][at + i] = low[k][i] << 28 ^ shift[k];
    }
}

/* The coordinate that digits stand for, digits / 2^32, in [0, 1): by a number with a sign, as
 * processors convert those several at a time. */
TOOL double sobol_unit(uint32_t digits)
{
    return (double)(int32_t)(digits ^ 0x80000000u) * (1 / 4294967296.0) + 0.5;
}

#endif
