/* support_planes.wave.h - the tool of that name over a block: where the receivers lie, then, of
 * those pairs that this leaves open, where the emitters lie; corners without a branch, so that
 * pairs which lie otherwise cost no more. A triangle's last corner is taken twice, which changes
 * neither the lowest nor the highest.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_SUPPORT_PLANES_WAVE_H
#define TOOL_SUPPORT_PLANES_WAVE_H

#include "wave.h"
#include "tools/support_planes.h"

/* As support_planes_side. */
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

/* Where both have a side. */
static inline enum support_planes_answer support_planes_wave_answer(const struct element *r,
                                                                    const struct element *s,
                                                                    int side_r, int side_s)
{
    const int larger = (r->area > s->area) | ((r->area == s->area) & (r->id <= s->id));
    const int cuts_r = (side_r == 0) & ((side_s != 0) | larger), cuts_s = side_s == 0;
    return side_s < 0 ? SUPPORT_PLANES_AWAY
           : cuts_r   ? SUPPORT_PLANES_RECEIVER_CROSSES
           : cuts_s   ? SUPPORT_PLANES_EMITTER_CROSSES
                      : SUPPORT_PLANES_TOWARD;
}

static inline void wave_support_planes(struct discussion *block, const uint16_t *at, int count,
                                       unsigned char *answers)
{
    uint16_t open[WAVE_PAIRS];
    signed char sides[WAVE_PAIRS];
    int left = 0;
    for (int k = 0; k < count; k++) {
        const struct discussion *d = &block[at[k]];
        const struct element *r = d->receiver, *s = d->emitter;
        const int side = support_planes_wave_side(r, s, plane_side_flat(r, s, d->host));
        answers[k] = SUPPORT_PLANES_AWAY;
        sides[k] = (signed char)side;
        open[left] = (uint16_t)k;
        left += side >= 0;
    }
    for (int i = 0; i < left; i++) {
        const int k = open[i];
        const struct discussion *d = &block[at[k]];
        const struct element *r = d->receiver, *s = d->emitter;
        const int side = support_planes_wave_side(s, r, plane_side_flat(r, s, d->host));
        answers[k] = (unsigned char)support_planes_wave_answer(r, s, sides[k], side);
    }
}

#endif
