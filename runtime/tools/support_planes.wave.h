/* support_planes.wave.h - the tool of that name over a block, without a branch where pairs lie
 * otherwise: first what spheres prove; then, of the pairs that this leaves open, corners. A
 * triangle's last corner is taken twice, which changes neither the lowest nor the highest.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_SUPPORT_PLANES_WAVE_H
#define TOOL_SUPPORT_PLANES_WAVE_H

#include "wave.h"
#include "tools/support_planes.h"

/* As support_planes_side, of corners. */
static inline int support_planes_wave_side(const struct element *e, const struct element *plane,
                                           double flat)
{
    double h[4];
    for (int i = 0; i < 3; i++)
        h[i] = height3(e->vertex[i], plane->centre, plane->normal);
    h[3] = height3(e->vertex[e->vertices > 3 ? 3 : 2], plane->centre, plane->normal);
    int above = (h[0] > flat) | (h[1] > flat) | (h[2] > flat) | (h[3] > flat);
    int below = (h[0] < -flat) | (h[1] < -flat) | (h[2] < -flat) | (h[3] < -flat);
    return above - 1 + (above & !below);
}

static inline enum support_planes_answer support_planes_wave_answer(const struct element *r,
                                                                    const struct element *s,
                                                                    int side_r, int side_s)
{
    const int larger = (r->area > s->area) | ((r->area == s->area) & (r->id <= s->id));
    const int cuts_r = (side_r == 0) & ((side_s != 0) | larger), cuts_s = side_s == 0;
    const int away = (side_r < 0) | (side_s < 0);
    return away     ? SUPPORT_PLANES_AWAY
           : cuts_r ? SUPPORT_PLANES_RECEIVER_CROSSES
           : cuts_s ? SUPPORT_PLANES_EMITTER_CROSSES
                    : SUPPORT_PLANES_TOWARD;
}

static inline void wave_support_planes(struct discussion *block, const uint16_t *at, int count,
                                       unsigned char *answers)
{
    uint16_t open[WAVE_PAIRS];
    int left = 0;
    for (int k = 0; k < count; k++) {
        const struct discussion *d = &block[at[k]];
        const struct element *r = d->receiver, *s = d->emitter;
        const double flat = plane_side_flat(r, s, d->host);
        const int side_r = plane_side_proved(r, s, flat), side_s = plane_side_proved(s, r, flat);
        const int away = (side_r < 0) | (side_s < 0);
        answers[k] = away ? SUPPORT_PLANES_AWAY : SUPPORT_PLANES_TOWARD;
        open[left] = (uint16_t)k;
        left += (away == 0) & ((side_r == 0) | (side_s == 0));
    }
    for (int i = 0; i < left; i++) {
        const int k = open[i];
        const struct discussion *d = &block[at[k]];
        const struct element *r = d->receiver, *s = d->emitter;
        const double flat = plane_side_flat(r, s, d->host);
        answers[k] = (unsigned char)support_planes_wave_answer(
            r, s, support_planes_wave_side(r, s, flat), support_planes_wave_side(s, r, flat));
    }
}

#endif
