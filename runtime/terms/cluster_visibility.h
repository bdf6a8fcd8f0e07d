/* cluster_visibility.h - V between two elements of which one at least is a cluster: rays between points of their
 * surfaces, not of their boxes. A face is found by going down the tree, each child by the area that it may turn to
 * the other element; segments count by what they would carry over the chance that they were chosen.
 * SPDX-License-Identifier: MIT */
#ifndef TERM_CLUSTER_VISIBILITY_H
#define TERM_CLUSTER_VISIBILITY_H

#include "discussion.h"
#include "terms/visibility.h"

/* The area of e that may face direction v (unit). */
static inline double cluster_faces(const struct element *e, const double v[3])
{
    double c = dot3(e->normal, v), sine;
    if (e->vertices)
        return c > 0 ? e->area * (c + 0.05) : 0.05 * e->area * (c > -0.5);
    if (e->cone > 0) {
        sine = 1 - e->cone * e->cone;
        if (c < 0 && c * c > sine)
            return 0.01 * e->area;
    }
    return e->area;
}

/* A face of e, chosen by *u, which is used up in part; *chance: of its being chosen. */
static inline const struct element *cluster_pick(const struct element *e, const struct element *all, const double v[3], double *u, double *chance)
{
    *chance = 1;
    while (!e->vertices) {
        double w[8] = { 0 }, sum = 0;
        int k, n = e->children;
        for (k = 0; k < n; k++)
            sum += w[k] = cluster_faces(&all[e->child + (uint32_t)k], v);
        *u *= sum;
        for (k = 0; k < n - 1 && *u >= w[k]; k++)
            *u -= w[k];
        if (!(w[k] > 0))
            return NULL;
        *u = *u < w[k] ? *u / w[k] : 0.5;
        *chance *= w[k] / sum;
        e = &all[e->child + (uint32_t)k];
    }
    return e;
}

static inline void cluster_point(double out[3], const struct element *e, double s, double t)
{
    int k;
    if (e->vertices == 3)
        s = sqrt(s);
    for (k = 0; k < 3; k++) {
        const double a = e->vertex[0][k], b = e->vertex[1][k], c = e->vertex[2][k], d = e->vertex[3][k];
        out[k] = e->vertices == 3 ? a + s * (b - a) + s * t * (c - b) : (1 - t) * (a + s * (b - a)) + t * (d + s * (c - d));
    }
}

OUTLINE double cluster_rays(const struct element *receiver, const struct element *emitter, const struct host *host, int count)
{
    const struct element *r = receiver->id < emitter->id ? receiver : emitter, *s = r == receiver ? emitter : receiver;
    const struct element *all = *host->elements;
    struct segment segments[SEGMENTS_MAX];
    double weight[SEGMENTS_MAX], seen = 0, total = 0, v[3], away[3], length;
    uint64_t blocked, hash = visibility_hash(r->id + visibility_hash(s->id));
    int i, k, n = 0;
    sub3(v, s->centre, r->centre);
    length = length3(v);
    for (k = 0; k < 3; k++) {
        v[k] /= length;
        away[k] = -v[k];
    }
    for (i = 0; i < 2 * count && n < count; i++) {
        struct segment *g = &segments[n];
        double u[4], chance_r, chance_s, w[3], cos_r, cos_s, square;
        const struct element *a, *b;
        /* A lattice shifted by the pair's hash. */
        static const double step[4] = { 0.85667488385450287, 0.73389185662630, 0.62870672833307, 0.53859726140 };
        for (k = 0; k < 4; k++) {
            u[k] = (double)((hash >> (16 * k)) & 0xffff) / 65536 + (i + 0.5) * step[k];
            u[k] -= floor(u[k]);
        }
        a = cluster_pick(r, all, v, &u[0], &chance_r);
        b = cluster_pick(s, all, away, &u[2], &chance_s);
        if (!a || !b)
            continue;
        cluster_point(g->from, a, u[0], u[1]);
        cluster_point(g->to, b, u[2], u[3]);
        sub3(w, g->to, g->from);
        cos_r = dot3(a->normal, w);
        cos_s = -dot3(b->normal, w);
        square = dot3(w, w);
        if (!(cos_r > 0) || !(cos_s > 0))
            continue;
        weight[n] = cos_r * cos_s / (square * square) * a->area * b->area / (chance_r * chance_s);
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
        total += weight[i];
        if (!(blocked >> i & 1))
            seen += weight[i];
    }
    return total > 0 ? seen / total : 0;
}

/* The term is `visibility`, at a level of rays up to 64. */
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
