/* cluster_visibility.h - V between two elements of which one at least is a cluster, kept as the term `visibility`.
 *
 * Rays go between points of the clusters' faces, not of their boxes: so a cluster shadows itself where its faces do, and
 * what stands within its box does not. A face is found by going down the tree, each child with a
 * chance in proportion to the area that it may turn to the other element; a segment counts by what it would carry
 * over the chance that it was chosen, cos_r cos_s / (d^4 p). Points are the lattice of the generalised golden
 * ratio in four dimensions, shifted by a hash of both identities; the same both ways. Up to 64 rays; segments between faces
 * that turn out to face away carry nothing and are not cast. Fails: as all sampling; where few of a cluster's faces
 * face the other, few of its points count.
 * [Smits, Arvo, Greenberg 1994, section 5, for visibility by segments; the choice of points: derived here]
 * SPDX-License-Identifier: MIT */
#ifndef TERM_CLUSTER_VISIBILITY_H
#define TERM_CLUSTER_VISIBILITY_H

#include "discussion.h"
#include "terms/surface_point.h"
#include "terms/visibility.h"

enum { CLUSTER_CHILDREN = 8 }; /* the most that a cluster has */

/* The area of e that may face direction v (unit), or one that differs from it by an angle whose sine is at most `slope`. */
static inline double cluster_facing(const struct element *e, const double v[3], double slope)
{
    double c = dot3(e->normal, v), across = 1 - c * c, sine = 1 - e->cone * e->cone;
    if (c < e->cone) /* the normal of the cone that turns to v most */
        c = c * e->cone + (across > 0 && sine > 0 ? sqrt(across * sine) : 0);
    else
        c = 1;
    if (e->vertices)
        c = dot3(e->normal, v);
    c += slope;
    return e->area * (c < 0 ? 0 : c < 1 ? c : 1);
}

/* A face of e, chosen by *u in [0, 1), of which what is left comes back; NULL: none faces v. *chance: of the choice. */
static inline const struct element *cluster_face(const struct element *e, const struct element *all, const double v[3],
                                                 double slope, double *u, double *chance)
{
    *chance = 1;
    while (!e->vertices) {
        double part[CLUSTER_CHILDREN], sum = 0;
        int k = 0, i;
        for (i = 0; i < e->children; i++) {
            part[i] = cluster_facing(&all[e->child + (uint32_t)i], v, slope);
            sum += part[i];
        }
        if (!(sum > 0))
            return NULL;
        *u *= sum;
        while (k < e->children - 1 && *u >= part[k])
            *u -= part[k++];
        if (!(part[k] > 0)) /* rounding led past the last */
            return NULL;
        *u = *u < part[k] ? *u / part[k] : 0.5;
        *chance *= part[k] / sum;
        e = &all[e->child + (uint32_t)k];
    }
    return e;
}

/* The visible fraction by at most `count` segments, up to SEGMENTS_MAX. */
OUTLINE double cluster_rays(const struct element *receiver, const struct element *emitter, const struct host *host, int count)
{
    static const double step[4] = { 0.8566748838545029, 0.733891856627126, 0.6287067210378087, 0.5385972572236101 };
    const struct element *r = receiver->id < emitter->id ? receiver : emitter, *s = r == receiver ? emitter : receiver;
    const struct element *all = *host->elements;
    struct segment segments[SEGMENTS_MAX];
    double weight[SEGMENTS_MAX], seen = 0, whole = 0, v[3], back[3], distance, slope;
    uint64_t blocked, hash = visibility_hash(r->id + visibility_hash(s->id));
    int i, k, n = 0;
    sub3(v, s->centre, r->centre);
    distance = length3(v);
    if (!(distance > 0))
        return 0;
    slope = (r->radius + s->radius) / distance;
    for (k = 0; k < 3; k++) {
        v[k] /= distance;
        back[k] = -v[k];
    }
    for (i = 0; i < count; i++) {
        struct segment *g = &segments[n];
        const struct element *a, *b;
        double u[4], chance_a, chance_b, w[3], cos_a, cos_b, square;
        for (k = 0; k < 4; k++) {
            u[k] = (double)(hash >> 16 * k & 0xffff) * (1 / 65536.0) + (i + 0.5) * step[k];
            u[k] -= floor(u[k]);
        }
        a = cluster_face(r, all, v, slope, &u[0], &chance_a);
        b = cluster_face(s, all, back, slope, &u[2], &chance_b);
        if (!a || !b)
            continue;
        surface_point(g->from, a, u[0], u[1]);
        surface_point(g->to, b, u[2], u[3]);
        sub3(w, g->to, g->from);
        cos_a = dot3(a->normal, w);
        cos_b = -dot3(b->normal, w);
        square = dot3(w, w) / (distance * distance);
        if (!(cos_a > 0) || !(cos_b > 0))
            continue;
        weight[n] = cos_a * cos_b * (a->area / r->area) * (b->area / s->area) / (square * square * chance_a * chance_b);
        for (k = 0; k < 3; k++) {
            g->from[k] += host->ray_offset * a->normal[k];
            g->to[k] += host->ray_offset * b->normal[k];
        }
        n++;
    }
    if (n == 0)
        return 0;
    blocked = host->occluded(host, n, segments);
    for (i = 0; i < n; i++) {
        whole += weight[i];
        if (!(blocked >> i & 1))
            seen += weight[i];
    }
    return whole > 0 ? seen / whole : 0;
}

TOOL double term_cluster_visibility(struct discussion *d, enum visibility_level level)
{
    if (level > VISIBILITY_RAYS_64)
        level = VISIBILITY_RAYS_64;
    if (d->terms.visibility_level < level) {
        d->terms.visibility = cluster_rays(d->receiver, d->emitter, d->host, visibility_rays_of(level));
        d->terms.visibility_level = (unsigned char)level;
    }
    return d->terms.visibility;
}

#endif
