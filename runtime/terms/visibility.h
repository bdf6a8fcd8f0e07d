/* visibility.h - term: V, the visible fraction of the light that two surfaces would exchange. In
 * [0, 1].
 *
 * Each segment counts by what it would carry, cos_r cos_s / d^2 (pi d^2 + a): where near parts see
 * each other and far parts do not, as along a corridor, most light passes though most segments are
 * blocked. `a`, the smaller area over the number of segments, bounds the weight of parts that
 * touch.
 *
 * presumed    1, nobody having looked (tools/presume_visible.h); only that command makes it.
 * extinction  as an isotropic medium would let pass (tools/extinction.h); only that command makes
 * it. Who asks
 *             for one of these two here gets four rays.
 * rays_N      N = 4, 16, 64, 256 or 1024 segments between points of the two elements' mutually
 * facing
 *             parts, spread over the four dimensions by a Sobol' net [Joe & Kuo 2008] whose digits
 *             are scrambled by a hash of both path identities: no shared random state, so the
 *             answer depends on the pair alone, and is the same both ways. Fails: a blocker that
 *             shades the fraction p of the segments is missed with probability (1-p)^N.
 * exact       from a shaft (tools/shaft.h) or an integral over the visible part
 * (tools/exact_visibility.h), which alone
 *             make it. Who asks for it here, where it is not known, gets 1024 rays.
 * SPDX-License-Identifier: MIT */
#ifndef TERM_VISIBILITY_H
#define TERM_VISIBILITY_H

#include "discussion.h"
#include "kernel/constants.h"
#include "kernel/hash.h"
#include "kernel/lambert.h"

/* A polygon ready to be sampled: a parallelogram, or a fan of triangles. (Its inner loops are
 * written out: at -O2 they cost a quarter more otherwise.) */
struct sampler {
    struct polygon p;
    int parallelogram;
    double right[3], up[3]; /* parallelogram: the sides from corner 0 */
    /* twice the areas of the fan's triangles (0, i - 1, i), and their sum */
    double area[POLYGON_MAX], whole;
};

/* The part of e in front of the plane of `other`. */
static inline void sampler_clip(struct sampler *q, const struct element *e,
                                const struct element *other)
{
    const struct polygon *p = &q->p;
    polygon_clip(&q->p, (const double(*)[3])e->vertex, e->vertices, other->centre, other->normal);
    q->whole = 0;
    q->parallelogram = 0;
    if (p->n == 4) {
        double gap = 0, size = 0;
        for (int k = 0; k < 3; k++) {
            double x = p->v[0][k] - p->v[1][k] + p->v[2][k] - p->v[3][k],
                   y = p->v[2][k] - p->v[0][k];
            gap += x * x;
            size += y * y;
        }
        q->parallelogram = gap <= SAMPLER_PARALLELOGRAM * size;
        sub3(q->right, p->v[1], p->v[0]);
        sub3(q->up, p->v[3], p->v[0]);
    }
    for (int i = 2; i < p->n && !q->parallelogram; i++) {
        double a[3], b[3], c[3];
        sub3(a, p->v[i - 1], p->v[0]);
        sub3(b, p->v[i], p->v[0]);
        cross3(c, a, b);
        q->area[i] = dot3(c, e->normal);
        q->whole += q->area[i];
    }
}

/* Map (s, t) in the unit square to the polygon so that area is kept. */
static inline void sampler_point(double out[3], const struct sampler *q, double s, double t)
{
    const double *a = q->p.v[0];
    if (q->parallelogram) {
        out[0] = a[0] + s * q->right[0] + t * q->up[0];
        out[1] = a[1] + s * q->right[1] + t * q->up[1];
        out[2] = a[2] + s * q->right[2] + t * q->up[2];
        return;
    }
    s *= q->whole;
    int i;
    for (i = 2; i < q->p.n - 1 && s >= q->area[i]; i++)
        s -= q->area[i];
    s = q->area[i] > 0 && s < q->area[i] ? sqrt(s / q->area[i]) : 1;
    const double *b = q->p.v[i - 1];
    const double *c = q->p.v[i];
    out[0] = a[0] + s * (b[0] - a[0]) + s * t * (c[0] - b[0]);
    out[1] = a[1] + s * (b[1] - a[1]) + s * t * (c[1] - b[1]);
    out[2] = a[2] + s * (b[2] - a[2]) + s * t * (c[2] - b[2]);
}

enum { VISIBILITY_MOST = 4096 }; /* rays that the net has digits for */

/* The visible fraction by `count` segments, a power of two up to VISIBILITY_MOST, cast in
 * batches of SEGMENTS_MAX. */
OUTLINE double visibility_rays(const struct element *receiver, const struct element *emitter,
                               const struct host *host, int count)
{
    /* Sobol' direction numbers, dimensions 1 to 4, the twelve leading bits: one per bit of the
     * index. */
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
    const struct element *r = receiver->id < emitter->id ? receiver : emitter,
                         *s = r == receiver ? emitter : receiver;
    double weight[SEGMENTS_MAX], seen = 0, all = 0,
                                 spread = (r->area < s->area ? r->area : s->area) / count;
    struct sampler p, q;
    uint64_t hash = hash64(r->id + hash64(s->id));
    sampler_clip(&p, r, s);
    sampler_clip(&q, s, r);
    if (p.p.n == 0 || q.p.n == 0)
        return 0;
    uint32_t digit[4];
    for (int k = 0; k < 4; k += 2) {
        digit[k] = (uint32_t)(hash >> 32);
        digit[k + 1] = (uint32_t)hash;
        hash = hash64(hash);
    }
    struct segment segments[SEGMENTS_MAX];
    for (int first = 0; first < count; first += SEGMENTS_MAX) {
        int batch = count - first < SEGMENTS_MAX ? count - first : SEGMENTS_MAX;
        for (int i = 0; i < batch; i++) {
            struct segment *g = &segments[i];
            if (first + i > 0) { /* Gray code order: one digit changes from point to point */
                const uint32_t *toggle = direction[0];
                for (int bits = first + i; !(bits & 1); bits >>= 1)
                    toggle += 4;
                digit[0] ^= toggle[0];
                digit[1] ^= toggle[1];
                digit[2] ^= toggle[2];
                digit[3] ^= toggle[3];
            }
            sampler_point(g->from, &p, digit[0] * (1 / 4294967296.0),
                          digit[1] * (1 / 4294967296.0));
            sampler_point(g->to, &q, digit[2] * (1 / 4294967296.0), digit[3] * (1 / 4294967296.0));
            weight[i] = lambert_points(g->from, r->normal, g->to, s->normal, spread);
            g->from[0] += host->ray_offset * r->normal[0];
            g->from[1] += host->ray_offset * r->normal[1];
            g->from[2] += host->ray_offset * r->normal[2];
            g->to[0] += host->ray_offset * s->normal[0];
            g->to[1] += host->ray_offset * s->normal[1];
            g->to[2] += host->ray_offset * s->normal[2];
        }
        uint64_t blocked = host->occluded(host, batch, segments);
        for (int i = 0; i < batch; i++) {
            all += weight[i];
            if (!(blocked >> i & 1))
                seen += weight[i];
        }
    }
    return all > 0 ? seen / all : 0;
}

/* The level that `rays` rays or more reach, and how many a level casts. */
static inline enum visibility_level visibility_level_of(int rays)
{
    return rays <= 4     ? VISIBILITY_RAYS_4
           : rays <= 16  ? VISIBILITY_RAYS_16
           : rays <= 64  ? VISIBILITY_RAYS_64
           : rays <= 256 ? VISIBILITY_RAYS_256
                         : VISIBILITY_RAYS_1024;
}

static inline int visibility_rays_of(enum visibility_level level)
{
    return level <= VISIBILITY_RAYS_4      ? 4
           : level >= VISIBILITY_RAYS_1024 ? 1024
                                           : 1 << 2 * (level - VISIBILITY_RAYS_4 + 1);
}

TOOL double term_visibility(struct discussion *d, enum visibility_level level)
{
    if (d->terms.visibility_level < level) {
        if (level < VISIBILITY_RAYS_4)
            level = VISIBILITY_RAYS_4;
        if (level > VISIBILITY_RAYS_1024)
            level = VISIBILITY_RAYS_1024;
        if (d->terms.visibility_level < level) {
            d->terms.visibility =
                visibility_rays(d->receiver, d->emitter, d->host, visibility_rays_of(level));
            d->terms.visibility_level = (unsigned char)level;
        }
    }
    return d->terms.visibility;
}

#endif
