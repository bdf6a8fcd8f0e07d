/* samples.h - segments between two surfaces and the weight of what each would carry, computed
 * several at a time (lanes.h), each as it would be alone.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_SAMPLES_H
#define KERNEL_SAMPLES_H

#include "discussion.h"
#include "kernel/lambert.h"
#include "kernel/lanes.h"
#include "kernel/sampler.h"
#include "kernel/sobol.h"

/* Up to SEGMENTS_MAX segments, coordinate by coordinate; the digits of a net's points that made
 * them (sobol_points). */
struct samples {
    uint32_t digit[4][SEGMENTS_MAX];
    double from[3][SEGMENTS_MAX], to[3][SEGMENTS_MAX], weight[SEGMENTS_MAX];
};

/* Between what. */
struct samples_ends {
    struct sampler p, q; /* where they start and end; q.p.n = 0: where they end is known */
    const double *n, *m; /* the normals */
    double spread;       /* as lambert_kernel has it (m2) */
    double ray_offset;   /* how far off the surfaces they start and end (m) */
};

TOOL void samples_body(struct samples *x, const struct samples_ends *e, int count)
{
    sampler_points(&e->p, count, x->digit[0], x->digit[1], x->from);
    if (e->q.p.n)
        sampler_points(&e->q, count, x->digit[2], x->digit[3], x->to);
    const double n0 = e->n[0], n1 = e->n[1], n2 = e->n[2], m0 = e->m[0], m1 = e->m[1], m2 = e->m[2],
                 off = e->ray_offset, spread = e->spread;
    for (int i = 0; i < count; i += LANES)
        for (int j = i; j < i + LANES; j++) {
            double a0 = x->from[0][j], a1 = x->from[1][j], a2 = x->from[2][j];
            double b0 = x->to[0][j], b1 = x->to[1][j], b2 = x->to[2][j];
            double w0 = b0 - a0, w1 = b1 - a1, w2 = b2 - a2;
            x->weight[j] =
                lambert_kernel(n0 * w0 + n1 * w1 + n2 * w2, -(m0 * w0 + m1 * w1 + m2 * w2),
                               w0 * w0 + w1 * w1 + w2 * w2, spread);
            x->from[0][j] = a0 + off * n0;
            x->from[1][j] = a1 + off * n1;
            x->from[2][j] = a2 + off * n2;
            x->to[0][j] = b0 + off * m0;
            x->to[1][j] = b1 + off * m1;
            x->to[2][j] = b2 + off * m2;
        }
}

#if LANES_CHOSEN
LANES_AVX512 void samples_8(struct samples *x, const struct samples_ends *e, int count)
{
    samples_body(x, e, count);
}
LANES_AVX2 void samples_4(struct samples *x, const struct samples_ends *e, int count)
{
    samples_body(x, e, count);
}
#endif

/* Make `count` segments of their digits, in vectors of a width, lanes_width() at the most. */
OUTLINE void samples_at(int width, struct samples *x, const struct samples_ends *e, int count)
{
    LANES_RUN(width, samples_8, samples_4, samples_body, (x, e, count));
}

static inline void samples_make(struct samples *x, const struct samples_ends *e, int count)
{
    samples_at(lanes_width(), x, e, count);
}

/* As `occluded` takes them. */
static inline void samples_segments(const struct samples *x, int count, struct segment *segments)
{
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            segments[i].from[k] = x->from[k][i];
            segments[i].to[k] = x->to[k][i];
        }
}

#endif
