/* separable_sums.h - what separable links send and bring, summed over many faces at a time.
 *
 * Faces are taken in blocks of SEPARABLE_BLOCK from the first on, and each place of a block has a
 * sum of its own: so no vector is so wide that it would change the last bit of a sum. Arrays may be
 * read for a block beyond their faces (SEPARABLE_SPARE); what is read there counts for nothing.
 * SPDX-License-Identifier: MIT */
#ifndef SEPARABLE_SUMS_H
#define SEPARABLE_SUMS_H

#include "engine/separable_faces.h"

enum { SEPARABLE_BLOCK = 8, SEPARABLE_SPARE = SEPARABLE_BLOCK - 1 };

/* Of the faces from .. to - 1, seen by a pivot; `width`: of vectors, lanes_width() at the most. */
struct separable_sum {
    const struct separable_faces *faces;
    const struct pivot *pivot;
    size_t from, to;
    int bands, width;
    int centres; /* 1: the kernel at the centres of faces */
};

/* sum[band] becomes that of sent[band][i] times the kernel of face i. */
void separable_sum_sent(const struct separable_sum *s, const float *const sent[3], float sum[3]);

/* Add arrives[band] times the kernel of face i to received[band * stride + i]. */
void separable_sum_received(const struct separable_sum *s, const float *arrives, float *received,
                            size_t stride);

#endif
