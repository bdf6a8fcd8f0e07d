/* cluster_visibility.h - question: how many of N rays between the faces of two elements, one of
 * them a cluster at least, arrive? N = 1, 4, 16 or 64, the next above `rays`. Answers as
 * visibility.h gives them; kept as the term `visibility`.
 *
 * Rays go between points of the clusters' faces, not of their boxes: so a cluster shadows itself
 * where its faces do, and what stands within its box does not. A face is found by going down the
 * tree, each child with a chance in proportion to the area that it may turn to the other element; a
 * segment counts by what it would carry over the chance that it was chosen, cos_r cos_s / (d^4 p).
 * Points are the lattice of the generalised golden ratio in four dimensions, shifted by a hash of
 * both identities; the same both ways. Up to 64 rays; segments between faces that turn out to face
 * away carry nothing and are not cast. Fails: as all sampling; where few of a cluster's faces face
 * the other, few of its points count.
 * [Smits, Arvo, Greenberg 1994, section 5, for visibility by segments; the choice of points:
 * derived here]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_CLUSTER_VISIBILITY_H
#define TOOL_CLUSTER_VISIBILITY_H

#include "discussion.h"
#include "kernel/cluster_facing.h"
#include "kernel/constants.h"
#include "kernel/hash.h"
#include "kernel/segments.h"
#include "kernel/surface_point.h"
#include "terms/visibility.h"

/* The most children that a cluster has. */
enum { CLUSTER_CHILDREN = 8 };

/* Faces chosen from one element: of each, what is left of its u in [0, 1) once the choice has used
 * it up, and the chance that it was chosen. */
struct cluster_choice {
    const struct element *face[SEGMENTS_MAX]; /* NULL: none faces v */
    double u[SEGMENTS_MAX], chance[SEGMENTS_MAX];
};

/* Choose `count` faces of e by c->u. All go down the tree together, so that what a cluster's
 * children may turn to v is computed once for all that pass it. */
static inline void cluster_choose(struct cluster_choice *c, int count, const struct element *e,
                                  const struct element *all, const double v[3], double slope)
{
    /* those at one element stand together in `order` */
    unsigned char order[SEGMENTS_MAX], moved[SEGMENTS_MAX], went[SEGMENTS_MAX];
    int open = !e->vertices;
    for (int i = 0; i < count; i++) {
        c->face[i] = e;
        c->chance[i] = 1;
        order[i] = (unsigned char)i;
    }
    int k;
    while (open) {
        open = 0;
        int to;
        for (int from = 0; from < count; from = to) {
            const struct element *at = c->face[order[from]];
            double part[CLUSTER_CHILDREN], sum = 0;
            int n[CLUSTER_CHILDREN + 1] = {0};
            for (to = from + 1; to < count && c->face[order[to]] == at; to++)
                ;
            if (!at || at->vertices)
                continue;
            const struct element *child = &all[at->child];
            for (k = 0; k < at->children; k++) {
                part[k] = cluster_facing(&child[k], v, slope);
                sum += part[k];
            }
            for (int i = from; i < to; i++) {
                int j = order[i];
                double u = c->u[j] * sum;
                for (k = 0; k < at->children - 1 && u >= part[k]; k++)
                    u -= part[k];
                /* else nothing faces v, or rounding led past the last that does */
                if (part[k] > 0) {
                    c->u[j] = u < part[k] ? u / part[k] : 0.5;
                    c->chance[j] *= part[k] / sum;
                    c->face[j] = &child[k];
                    open |= !child[k].vertices;
                } else {
                    c->face[j] = NULL;
                }
                went[i] = (unsigned char)k;
                n[k + 1]++;
            }
            for (k = 0; k < at->children; k++)
                n[k + 1] += n[k];
            for (int i = from; i < to; i++)
                moved[from + n[went[i]]++] = order[i];
            for (int i = from; i < to; i++)
                order[i] = moved[i];
        }
    }
}

/* The visible fraction by at most `count` segments, up to SEGMENTS_MAX. */
OUTLINE double cluster_rays(const struct element *receiver, const struct element *emitter,
                            const struct host *host, int count)
{
    static const double step[4] = {0.8566748838545029, 0.733891856627126, 0.6287067210378087,
                                   0.5385972572236101};
    const struct element *r = receiver->id < emitter->id ? receiver : emitter,
                         *s = r == receiver ? emitter : receiver;
    const struct element *all = *host->elements;
    struct cluster_choice of_r, of_s;
    double weight[SEGMENTS_MAX], across[2][SEGMENTS_MAX], seen = 0, whole = 0, v[3], back[3];
    uint64_t hash = hash64(r->id + hash64(s->id));
    int n = 0;
    sub3(v, s->centre, r->centre);
    double distance = length3(v);
    if (!(distance > 0))
        return 0;
    double slope = (r->radius + s->radius) / distance;
    for (int k = 0; k < 3; k++) {
        v[k] /= distance;
        back[k] = -v[k];
    }
    struct segment segments[SEGMENTS_MAX];
    int one = count == 1;
    if (one)
        count = VISIBILITY_CHOICE;
    for (int tried = 0; n < count && tried < CLUSTER_TRIES * count; tried += count) {
        for (int i = 0; i < count; i++) {
            double u[4];
            for (int k = 0; k < 4; k++) {
                u[k] =
                    (double)(hash >> 16 * k & 0xffff) * (1 / 65536.0) + (tried + i + 0.5) * step[k];
                u[k] -= floor(u[k]);
            }
            of_r.u[i] = u[0];
            across[0][i] = u[1];
            of_s.u[i] = u[2];
            across[1][i] = u[3];
        }
        cluster_choose(&of_r, count, r, all, v, slope);
        cluster_choose(&of_s, count, s, all, back, slope);
        for (int i = 0; i < count && n < count; i++) {
            struct segment *g = &segments[n];
            const struct element *a = of_r.face[i], *b = of_s.face[i];
            double w[3];
            if (!a || !b)
                continue;
            surface_point(g->from, a, of_r.u[i], across[0][i]);
            surface_point(g->to, b, of_s.u[i], across[1][i]);
            sub3(w, g->to, g->from);
            double cos_a = dot3(a->normal, w);
            double cos_b = -dot3(b->normal, w);
            double square = dot3(w, w) / (distance * distance);
            if (!(cos_a > 0) || !(cos_b > 0))
                continue;
            weight[n] = cos_a * cos_b * (a->area / r->area) * (b->area / s->area)
                        / (square * square * of_r.chance[i] * of_s.chance[i]);
            segment_clear(g, a->normal, b->normal, host);
            n++;
        }
    }
    if (n == 0)
        return 0;
    if (one) {
        segments_choose(n, segments, weight, hash_unit(hash + HASH_STEP));
        n = 1;
    }
    segments_cast(host, n, segments, weight, &seen, &whole);
    return whole > 0 ? seen / whole : 0;
}

TOOL double term_cluster_visibility(struct discussion *d, enum visibility_level level)
{
    if (level > VISIBILITY_RAYS_64)
        level = VISIBILITY_RAYS_64;
    if (d->terms.visibility_level < level) {
        d->terms.visibility =
            cluster_rays(d->receiver, d->emitter, d->host, visibility_rays_of(level));
        d->terms.visibility_level = (unsigned char)level;
    }
    return d->terms.visibility;
}

TOOL enum cluster_visibility_answer tool_cluster_visibility(struct discussion *d, int rays)
{
    double v = term_cluster_visibility(d, visibility_level_of(rays));
    return v <= 0  ? CLUSTER_VISIBILITY_NONE
           : v < 1 ? CLUSTER_VISIBILITY_PARTIAL
                   : CLUSTER_VISIBILITY_ALL;
}

#endif
