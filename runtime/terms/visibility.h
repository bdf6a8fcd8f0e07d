/* visibility.h - term: V, the visible fraction of the light that two surfaces would exchange. In
 * [0, 1].
 *
 * Each segment counts by what it would carry, cos_r cos_s / d^2 (pi d^2 + a): where near parts see
 * each other and far parts do not, as along a corridor, most light passes though most segments are
 * blocked. `a`, the smaller area over the number of segments, bounds the weight of parts that
 * touch.
 *
 * Few segments of equal chance mislead where elements are nearer to each other than the larger
 * one's radius: most that is exchanged passes between parts that few of them join. An oracle may
 * ask there for rays chosen from `near` segments, up to SEGMENTS_MAX, in proportion to what each
 * would carry.
 *
 * presumed    1, nobody having looked (tools/presume_visible.h); only that command makes it.
 * extinction  as an isotropic medium would let pass (tools/extinction.h); only that command makes
 *             it. Who asks for one of these two here gets four rays.
 * rays_N      N = 1, 4, 16, 64, 256 or 1024 segments between points of the two elements' mutually
 *             facing parts, spread over the four dimensions by a Sobol' net [Joe & Kuo 2008] whose
 *             digits are shifted by a hash of both path identities: no shared random state, so the
 *             answer depends on the pair alone, and is the same both ways. Where N is 1 it is
 *             chosen from VISIBILITY_CHOICE, in proportion to what each would carry. Fails: a
 *             blocker that shades the fraction p of the segments is missed with probability
 *             (1-p)^N.
 * exact       from a shaft (tools/shaft.h) or an integral over the visible part
 *             (tools/exact_visibility.h), which alone make it. Who asks for it here, where it is
 *             not known, gets 1024 rays.
 * SPDX-License-Identifier: MIT */
#ifndef TERM_VISIBILITY_H
#define TERM_VISIBILITY_H

#include "discussion.h"
#include "kernel/constants.h"
#include "kernel/hash.h"
#include "kernel/samples.h"
#include "kernel/segments.h"
#include "kernel/sobol.h"

/* How many segments `count` of them are chosen from. */
static inline int visibility_choice(const struct element *r, const struct element *s, int count,
                                    int near)
{
    const double wide = r->radius > s->radius ? r->radius : s->radius;
    double apart[3];
    sub3(apart, r->centre, s->centre);
    const int choice = near > 0 && dot3(apart, apart) < wide * wide ? near
                       : count > 1                                  ? 1
                                                                    : VISIBILITY_CHOICE;
    return count > choice ? count : choice;
}

/* Where ends on an element s are, of so many drawn. */
typedef void visibility_ends(struct samples *samples, int batch, const struct element *s,
                             const struct host *host);

/* The share that arrives of what `points` segments would carry, a power of two up to SOBOL_MOST,
 * cast in batches of SEGMENTS_MAX, `count` of them by chance where that is less. Both ends lie by
 * area, unless `place` tells where those on s do. */
TOOL double visibility_among(const struct element *r, const struct element *s,
                             const struct host *host, int points, int count, uint64_t hash,
                             visibility_ends *place)
{
    struct samples_ends ends;
    sampler_clip(&ends.p, r, s);
    ends.q.p.n = 0;
    if (!place)
        sampler_clip(&ends.q, s, r);
    if (ends.p.p.n == 0 || (!place && ends.q.p.n == 0))
        return 0;
    ends.n = r->normal;
    ends.m = s->normal;
    ends.spread = (r->area < s->area ? r->area : s->area) / points;
    ends.ray_offset = host->ray_offset;
    struct sobol net;
    sobol_start(&net, hash);
    struct samples samples;
    struct segment segments[SEGMENTS_MAX];
    double seen = 0, all = 0;
    for (int first = 0; first < points; first += SEGMENTS_MAX) {
        int batch = points - first < SEGMENTS_MAX ? points - first : SEGMENTS_MAX;
        sobol_points(&net, first, batch, samples.digit);
        if (place)
            place(&samples, batch, s, host);
        samples_make(&samples, &ends, batch);
        samples_segments(&samples, batch, segments);
        segments_cast_few(host, batch, count, hash, segments, samples.weight, &seen, &all);
    }
    return all > 0 ? seen / all : 0;
}

/* The visible fraction by `count` segments; of elements near each other chosen from `near`. */
OUTLINE double visibility_rays(const struct element *receiver, const struct element *emitter,
                               const struct host *host, int count, int near)
{
    const struct element *r = receiver->id < emitter->id ? receiver : emitter,
                         *s = r == receiver ? emitter : receiver;
    return visibility_among(r, s, host, visibility_choice(r, s, count, near), count,
                            hash64(r->id + hash64(s->id)), NULL);
}

/* The level that `rays` rays or more reach, and how many a level casts. */
static inline enum visibility_level visibility_level_of(int rays)
{
    return rays <= 1     ? VISIBILITY_RAYS_1
           : rays <= 4   ? VISIBILITY_RAYS_4
           : rays <= 16  ? VISIBILITY_RAYS_16
           : rays <= 64  ? VISIBILITY_RAYS_64
           : rays <= 256 ? VISIBILITY_RAYS_256
                         : VISIBILITY_RAYS_1024;
}

static inline int visibility_rays_of(enum visibility_level level)
{
    return level <= VISIBILITY_RAYS_1      ? 1
           : level >= VISIBILITY_RAYS_1024 ? 1024
                                           : 1 << 2 * (level - VISIBILITY_RAYS_1);
}

TOOL double visibility_known(struct discussion *d, enum visibility_level level, int near)
{
    if (d->terms.visibility_level < level) {
        if (level < VISIBILITY_RAYS_1)
            level = VISIBILITY_RAYS_4;
        if (level > VISIBILITY_RAYS_1024)
            level = VISIBILITY_RAYS_1024;
        if (d->terms.visibility_level < level) {
            d->terms.visibility =
                visibility_rays(d->receiver, d->emitter, d->host, visibility_rays_of(level), near);
            d->terms.visibility_level = (unsigned char)level;
        }
    }
    return d->terms.visibility;
}

TOOL double term_visibility(struct discussion *d, enum visibility_level level)
{
    return visibility_known(d, level, 0);
}

#endif
