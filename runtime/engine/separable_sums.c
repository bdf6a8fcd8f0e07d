/* separable_sums.c - see separable_sums.h. Both loops are most of what sweeps cost where groups are
 * linked, so they are compiled for wide vectors, too (kernel/lanes.h).
 * SPDX-License-Identifier: MIT */
#include <string.h>
#include "engine/separable_sums.h"
#include "kernel/lanes.h"

TOOL void kernels(const struct separable_sum *s, size_t i, float value[SEPARABLE_BLOCK])
{
    const struct separable_faces *f = s->faces;
    if (s->centres) {
#pragma omp simd
        for (int j = 0; j < SEPARABLE_BLOCK; j++)
            value[j] = separable_kernel_at_centre(f, i + (size_t)j, s->pivot);
    } else {
#pragma omp simd
        for (int j = 0; j < SEPARABLE_BLOCK; j++)
            value[j] = separable_kernel(f, i + (size_t)j, s->pivot);
    }
}

TOOL void sent_body(const struct separable_sum *s, const float *const sent[3], float sum[3])
{
    float part[3][SEPARABLE_BLOCK] = {{0}};
    for (size_t i = s->from; i < s->to; i += SEPARABLE_BLOCK) {
        float value[SEPARABLE_BLOCK];
        kernels(s, i, value);
        for (size_t j = s->to - i; j < SEPARABLE_BLOCK; j++)
            value[j] = 0;
        for (int k = 0; k < s->bands; k++)
#pragma omp simd
            for (int j = 0; j < SEPARABLE_BLOCK; j++)
                part[k][j] += sent[k][i + (size_t)j] * value[j];
    }
    for (int k = 0; k < s->bands; k++) {
        sum[k] = 0;
        for (int j = 0; j < SEPARABLE_BLOCK; j++)
            sum[k] += part[k][j];
    }
}

TOOL void received_body(const struct separable_sum *s, const float *arrives, float *received,
                        size_t stride)
{
    for (size_t i = s->from; i < s->to; i += SEPARABLE_BLOCK) {
        float value[SEPARABLE_BLOCK];
        const size_t left = s->to - i < SEPARABLE_BLOCK ? s->to - i : SEPARABLE_BLOCK;
        kernels(s, i, value);
        for (int k = 0; k < s->bands; k++) {
            float *at = &received[(size_t)k * stride + i];
            if (left == SEPARABLE_BLOCK)
#pragma omp simd
                for (int j = 0; j < SEPARABLE_BLOCK; j++)
                    at[j] += arrives[k] * value[j];
            else
                for (size_t j = 0; j < left; j++)
                    at[j] += arrives[k] * value[j];
        }
    }
}

#if LANES_CHOSEN
LANES_AVX512 void sent_8(const struct separable_sum *s, const float *const sent[3], float sum[3])
{
    sent_body(s, sent, sum);
}
LANES_AVX2 void sent_4(const struct separable_sum *s, const float *const sent[3], float sum[3])
{
    sent_body(s, sent, sum);
}
LANES_AVX512 void received_8(const struct separable_sum *s, const float *arrives, float *received,
                             size_t stride)
{
    received_body(s, arrives, received, stride);
}
LANES_AVX2 void received_4(const struct separable_sum *s, const float *arrives, float *received,
                           size_t stride)
{
    received_body(s, arrives, received, stride);
}
#endif

void separable_sum_sent(const struct separable_sum *s, const float *const sent[3], float sum[3])
{
    LANES_RUN(s->width, sent_8, sent_4, sent_body, (s, sent, sum));
}

void separable_sum_received(const struct separable_sum *s, const float *arrives, float *received,
                            size_t stride)
{
    LANES_RUN(s->width, received_8, received_4, received_body, (s, arrives, received, stride));
}
