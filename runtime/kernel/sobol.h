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

/* Before the first point of the net that the hash shifts. */
static inline void sobol_start(struct sobol *net, uint64_t hash)
{
    for (int k = 0; k < 4; k += 2) {
        net->digit[k] = (uint32_t)(hash >> 32);
        net->digit[k + 1] = (uint32_t)hash;
        hash = hash64(hash);
    }
}

/* Go to point i; to be called with 0, 1, 2 and so on. */
static inline void sobol_go(struct sobol *net, int i)
{
    /* Direction numbers, dimensions 1 to 4, the twelve leading bits: one per bit of the index. */
    static const uint32_t direction[12][4] = {
        {0x80000000u, 0x80000000u, 0x80000000u, 0x80000000u},
        {0x40000000u, 0xc0000000u, 0xc0000000u, 0xc0000000u},
        {0x20000000u, 0xa0000000u, 0x60000000u, 0x20000000u},
        {0x10000000u, 0xf0000000u, 0x90000000u, 0x50000000u},
        {0x08000000u, 0x88000000u, 0xe8000000u, 0xf8000000u},
        {0x04000000u, 0xcc000000u, 0x5c000000u, 0x74000000u},
        {0x02000000u, 0xaa000000u, 0x8e000000u, 0xa2000000u},
        {0x01000000u, 0xff000000u, 0xc5000000u, 0x93000000u},
        {0x00800000u, 0x80800000u, 0x68800000u, 0xd8800000u},
        {0x00400000u, 0xc0c00000u, 0x9cc00000u, 0x25400000u},
        {0x00200000u, 0xa0a00000u, 0xee600000u, 0x59e00000u},
        {0x00100000u, 0xf0f00000u, 0x55900000u, 0xe6d00000u},
    };
    if (i > 0) { /* one digit changes from point to point */
        const uint32_t *toggle = direction[0];
        for (int bits = i; !(bits & 1); bits >>= 1)
            toggle += 4;
        net->digit[0] ^= toggle[0];
        net->digit[1] ^= toggle[1];
        net->digit[2] ^= toggle[2];
        net->digit[3] ^= toggle[3];
    }
}

/* Coordinate k of the point, in [0, 1). */
static inline double sobol_at(const struct sobol *net, int k)
{
    return net->digit[k] * (1 / 4294967296.0);
}

#endif
