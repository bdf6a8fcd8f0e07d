/* visibility.h - term: V, the visible fraction of the segments between two surfaces. In [0, 1].
 *
 * rays_4, rays_16, rays_64: so many segments between points of the two elements' mutually facing
 * parts, spread over the four dimensions by a Sobol' net [Joe & Kuo 2008] whose digits are
 * scrambled by a hash of both path identities: no shared random state, so the answer depends on
 * the pair alone, and is the same both ways. Fails: a blocker that shades the fraction p of the segments is missed with
 * probability (1-p)^N.
 * SPDX-License-Identifier: MIT */
#ifndef TERM_VISIBILITY_H
#define TERM_VISIBILITY_H

#include "discussion.h"

static inline uint64_t visibility_hash(uint64_t x)
{
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

/* A polygon ready to be sampled: a parallelogram, or a fan of triangles. */
struct sampler {
    struct polygon p;
    int parallelogram;
    double area[POLYGON_MAX], whole; /* twice the areas of the fan's triangles (0, i - 1, i), and their sum */
};

/* The part of e in front of the plane of `other`. */
static inline void sampler_clip(struct sampler *q, const struct element *e, const struct element *other)
{
    const struct polygon *p = &q->p;
    int i, k;
    polygon_clip(&q->p, (const double (*)[3])e->vertex, e->vertices, other->centre, other->normal);
    q->whole = 0;
    q->parallelogram = 0;
    if (p->n == 4) {
        double gap = 0, size = 0;
        for (k = 0; k < 3; k++) {
            double x = p->v[0][k] - p->v[1][k] + p->v[2][k] - p->v[3][k], y = p->v[2][k] - p->v[0][k];
            gap += x * x;
            size += y * y;
        }
        q->parallelogram = gap <= 1e-6 * size;
    }
    for (i = 2; i < p->n && !q->parallelogram; i++) {
        double a[3], b[3], c[3];
        sub3(a, p->v[i - 1], p->v[0]);
        sub3(b, p->v[i], p->v[0]);
        cross3(c, a, b);
        q->area[i] = dot3(c, e->normal);
        q->whole += q->area[i];
    }
}

/* a + s u + t v. */
static inline void sampler_sum(double out[3], const double a[3], double s, const double u[3], double t, const double v[3])
{
    out[0] = a[0] + s * u[0] + t * v[0];
    out[1] = a[1] + s * u[1] + t * v[1];
    out[2] = a[2] + s * u[2] + t * v[2];
}

static inline void sampler_lift(double out[3], double offset, const double normal[3])
{
    out[0] += offset * normal[0];
    out[1] += offset * normal[1];
    out[2] += offset * normal[2];
}

/* Map (s, t) in the unit square to the polygon so that area is kept. */
static inline void sampler_point(double out[3], const struct sampler *q, double s, double t)
{
    const double *a = q->p.v[0];
    double u[3], v[3];
    int i;
    if (q->parallelogram) {
        sub3(u, q->p.v[1], a);
        sub3(v, q->p.v[3], a);
        sampler_sum(out, a, s, u, t, v);
        return;
    }
    s *= q->whole;
    for (i = 2; i < q->p.n - 1 && s >= q->area[i]; i++)
        s -= q->area[i];
    s = q->area[i] > 0 && s < q->area[i] ? sqrt(s / q->area[i]) : 1;
    sub3(u, q->p.v[i - 1], a);
    sub3(v, q->p.v[i], q->p.v[i - 1]);
    sampler_sum(out, a, s, u, s * t, v);
}

/* The visible fraction by `count` segments, a power of two up to SEGMENTS_MAX. */
OUTLINE double visibility_rays(const struct element *receiver, const struct element *emitter,
                               const struct host *host, int count)
{
    /* Sobol' direction numbers, dimensions 1 to 4, the six leading bits: one per bit of the index. */
    static const uint32_t direction[4][6] = {
        { 0x80000000u, 0x40000000u, 0x20000000u, 0x10000000u, 0x08000000u, 0x04000000u },
        { 0x80000000u, 0xc0000000u, 0xa0000000u, 0xf0000000u, 0x88000000u, 0xcc000000u },
        { 0x80000000u, 0xc0000000u, 0x60000000u, 0x90000000u, 0xe8000000u, 0x5c000000u },
        { 0x80000000u, 0xc0000000u, 0x20000000u, 0x50000000u, 0xf8000000u, 0x74000000u },
    };
    const struct element *r = receiver->id < emitter->id ? receiver : emitter, *s = r == receiver ? emitter : receiver;
    struct segment segments[SEGMENTS_MAX];
    struct sampler p, q;
    uint64_t hash = visibility_hash(r->id + visibility_hash(s->id));
    uint32_t digit[4];
    int i, k;
    sampler_clip(&p, r, s);
    sampler_clip(&q, s, r);
    if (p.p.n == 0 || q.p.n == 0)
        return 0;
    for (k = 0; k < 4; k += 2) {
        digit[k] = (uint32_t)(hash >> 32);
        digit[k + 1] = (uint32_t)hash;
        hash = visibility_hash(hash);
    }
    for (i = 0; i < count; i++) {
        struct segment *g = &segments[i];
        double x[4];
        if (i > 0) { /* Gray code order: one digit changes from point to point */
            int bit = 0;
            while (!(i >> bit & 1))
                bit++;
            for (k = 0; k < 4; k++)
                digit[k] ^= direction[k][bit];
        }
        for (k = 0; k < 4; k++)
            x[k] = digit[k] * (1 / 4294967296.0);
        sampler_point(g->from, &p, x[0], x[1]);
        sampler_point(g->to, &q, x[2], x[3]);
        sampler_lift(g->from, host->ray_offset, r->normal);
        sampler_lift(g->to, host->ray_offset, s->normal);
    }
    return 1 - (double)host->occluded(host, count, segments) / count;
}

TOOL double term_visibility(struct discussion *d, enum visibility_level level)
{
    if (d->terms.visibility_level < level) {
        d->terms.visibility = visibility_rays(d->receiver, d->emitter, d->host,
                                              level == VISIBILITY_RAYS_4 ? 4 : level == VISIBILITY_RAYS_16 ? 16 : 64);
        d->terms.visibility_level = (unsigned char)level;
    }
    return d->terms.visibility;
}

#endif
