/* sobol_sequence.h - a Sobol' sequence of up to twenty dimensions, its digits shifted by chance.
 *
 * Points 2^m k .. 2^m (k + 1) - 1 of it spread evenly over the unit cube for every m; with the
 * shift each point alone is spread evenly by chance, so a mean over them has no bias. Of points in
 * any order and number: kernel/sobol.h goes through the first 4096 of the same points, in four
 * dimensions, one after the other (tests/runtime/check_paths.c). Coordinates can be had one by one:
 * a path takes three more with each reflection, and most have few. [Sobol' 1967; direction numbers:
 * Joe and Kuo 2008, new-joe-kuo-6.21201; the shift: Matousek 1998]
 * SPDX-License-Identifier: MIT */
#ifndef SOBOL_SEQUENCE_H
#define SOBOL_SEQUENCE_H

#include <stdint.h>
#include "kernel/hash.h"

/* Those that a point has, and those that can be had. */
enum { SOBOL_DIMENSIONS = 5, SOBOL_COORDINATES = 20 };

/* Bits of an index that are looked up at once, and how many such runs it has. */
enum { SOBOL_RUN = 5, SOBOL_RUNS = 7 };

/* What the bits of a run of the index add to the digits of dimension d. Those of one bit b are its
 * direction numbers, digits[d][b / SOBOL_RUN][1 << b % SOBOL_RUN]. */
struct sobol_sequence {
    uint32_t digits[SOBOL_COORDINATES][SOBOL_RUNS][1 << SOBOL_RUN];
};

static inline void sobol_sequence_open(struct sobol_sequence *sobol)
{
    /* s: degree of the polynomial, a: its inner coefficients, m: the first direction numbers; of
     * dimensions 2 to 20. The first is the index with its digits turned round. */
    static const struct {
        uint32_t s, a, m[7];
    } rows[] = {{1, 0, {1}},
                {2, 1, {1, 3}},
                {3, 1, {1, 3, 1}},
                {3, 2, {1, 1, 1}},
                {4, 1, {1, 1, 3, 3}},
                {4, 4, {1, 3, 5, 13}},
                {5, 2, {1, 1, 5, 5, 17}},
                {5, 4, {1, 1, 5, 5, 5}},
                {5, 7, {1, 1, 7, 11, 19}},
                {5, 11, {1, 1, 5, 1, 1}},
                {5, 13, {1, 1, 1, 3, 11}},
                {5, 14, {1, 3, 5, 5, 31}},
                {6, 1, {1, 3, 3, 9, 7, 49}},
                {6, 13, {1, 1, 1, 15, 21, 21}},
                {6, 16, {1, 3, 1, 13, 27, 49}},
                {6, 19, {1, 1, 1, 15, 7, 5}},
                {6, 22, {1, 3, 1, 15, 13, 25}},
                {6, 25, {1, 1, 5, 5, 19, 61}},
                {7, 1, {1, 3, 7, 11, 23, 15, 103}}};
    for (int d = 0; d < SOBOL_COORDINATES; d++) {
        uint32_t v[SOBOL_RUN * SOBOL_RUNS] = {0};
        for (uint32_t b = 0; b < 32; b++) {
            if (d == 0) {
                v[b] = 1u << (31 - b);
                continue;
            }
            const uint32_t s = rows[d - 1].s, a = rows[d - 1].a;
            v[b] = b < s ? rows[d - 1].m[b] << (31 - b) : v[b - s] ^ v[b - s] >> s;
            for (uint32_t j = 1; b >= s && j < s; j++)
                v[b] ^= a >> (s - 1 - j) & 1 ? v[b - j] : 0;
        }
        for (uint32_t run = 0; run < SOBOL_RUNS; run++) {
            uint32_t *digits = sobol->digits[d][run];
            digits[0] = 0;
            for (uint32_t b = 0; b < SOBOL_RUN; b++)
                for (uint32_t i = 0; i < 1u << b; i++)
                    digits[(1u << b) + i] = digits[i] ^ v[run * SOBOL_RUN + b];
        }
    }
}

/* Shifts of a set of points, which no other set has. */
static inline void sobol_sequence_shifts(uint64_t set, uint32_t shift[SOBOL_COORDINATES])
{
    for (int d = 0; d < SOBOL_COORDINATES; d++)
        shift[d] = (uint32_t)(hash64(set * SOBOL_COORDINATES + (uint64_t)d + 1) >> 32);
}

/* Coordinate d of a point, by the shift of its digits. */
static inline double sobol_sequence_at(const struct sobol_sequence *sobol, uint32_t index, int d,
                                       uint32_t shift)
{
    const uint32_t last = (1u << SOBOL_RUN) - 1;
    uint32_t x = shift;
    for (uint32_t i = index, run = 0; i; i >>= SOBOL_RUN, run++)
        x ^= sobol->digits[d][run][i & last];
    return x * 0x1p-32;
}

static inline void sobol_sequence_point(const struct sobol_sequence *sobol, uint32_t index,
                                        const uint32_t shift[SOBOL_DIMENSIONS],
                                        double point[SOBOL_DIMENSIONS])
{
    for (int d = 0; d < SOBOL_DIMENSIONS; d++)
        point[d] = sobol_sequence_at(sobol, index, d, shift[d]);
}

#endif
