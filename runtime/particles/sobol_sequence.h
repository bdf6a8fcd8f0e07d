/* sobol_sequence.h - a Sobol' sequence of five dimensions, with a random shift of its digits.
 *
 * Points 2^m k .. 2^m (k + 1) - 1 of it spread evenly over the unit cube for every m; with the
 * shift each point alone is spread evenly by chance, so a mean over them has no bias. Of points in
 * any order and number: kernel/sobol.h goes through the first 4096 of the same points, in four
 * dimensions, one after the other (tests/runtime/check_paths.c). [Sobol' 1967;
 * direction numbers: Joe and Kuo 2008, new-joe-kuo-6.21201; the shift: Matousek 1998]
 * SPDX-License-Identifier: MIT */
#ifndef SOBOL_SEQUENCE_H
#define SOBOL_SEQUENCE_H

#include <stdint.h>

enum { SOBOL_DIMENSIONS = 5 };

/* Direction numbers: what bit b of the index adds to the digits of dimension d. */
struct sobol_sequence {
    uint32_t direction[SOBOL_DIMENSIONS][32];
};

static inline void sobol_sequence_open(struct sobol_sequence *sobol)
{
    /* s: degree of the polynomial, a: its inner coefficients, m: the first direction numbers; of
     * dimensions 2 to 5. The first is the index with its digits turned round. */
    static const struct {
        uint32_t s, a, m[3];
    } rows[] = {{1, 0, {1, 0, 0}}, {2, 1, {1, 3, 0}}, {3, 1, {1, 3, 1}}, {3, 2, {1, 1, 1}}};
    for (uint32_t b = 0; b < 32; b++)
        sobol->direction[0][b] = 1u << (31 - b);
    for (int d = 1; d < SOBOL_DIMENSIONS; d++) {
        uint32_t s = rows[d - 1].s, a = rows[d - 1].a, *v = sobol->direction[d];
        for (uint32_t b = 0; b < 32; b++) {
            v[b] = b < s ? rows[d - 1].m[b] << (31 - b) : v[b - s] ^ v[b - s] >> s;
            for (uint32_t j = 1; b >= s && j < s; j++)
                v[b] ^= a >> (s - 1 - j) & 1 ? v[b - j] : 0;
        }
    }
}

static inline void sobol_sequence_point(const struct sobol_sequence *sobol, uint32_t index,
                                        const uint32_t shift[SOBOL_DIMENSIONS],
                                        double point[SOBOL_DIMENSIONS])
{
    for (int d = 0; d < SOBOL_DIMENSIONS; d++) {
        uint32_t x = shift[d];
        for (uint32_t i = index, b = 0; i; i >>= 1, b++)
            x ^= i & 1 ? sobol->direction[d][b] : 0;
        point[d] = x * 0x1p-32;
    }
}

#endif
