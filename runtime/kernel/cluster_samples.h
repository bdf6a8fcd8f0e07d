/* cluster_samples.h - segments between points on the faces of two elements, one of them a cluster
 * at least, each with the weight of what it would carry.
 *
 * A face is found by going down the tree, each child with a chance in proportion to the area that
 * it may turn to the other element; a segment counts by what it would carry over the chance that it
 * was chosen, cos_r cos_s / (d^4 p). Points are the lattice of the generalised golden ratio in four
 * dimensions, shifted by a hash of both identities; the same both ways. Segments between faces that
 * turn out to face away carry nothing and are left out.
 * [Smits, Arvo, Greenberg 1994, section 5, for visibility by segments; the choice of points:
 * derived here]
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_CLUSTER_SAMPLES_H
#define KERNEL_CLUSTER_SAMPLES_H

#include <string.h>
#include "discussion.h"
#include "kernel/cluster_facing.h"
#include "kernel/constants.h"
#include "kernel/hash.h"
#include "kernel/lanes.h"
#include "kernel/segments.h"
#include "kernel/surface_point.h"

/* The most children that a cluster has; of how many clusters a walk remembers what it computed. */
enum { CLUSTER_CHILDREN = 8, CLUSTER_KEPT = 128, CLUSTER_KEPT_BITS = 7 };

/* Of a cluster's children: what each may turn to v (cluster_facing), its share of the sum, and what
 * u must reach to pass it by: its part, but of the last child and behind it nothing does. */
struct cluster_parts {
    double part[CLUSTER_CHILDREN], share[CLUSTER_CHILDREN], pass[CLUSTER_CHILDREN], sum;
};

/* One element of the pair as seen from the other, for all walks down from it. */
struct cluster_walk {
    const struct element *all;
    double v[3], slope;
    int width;                    /* of vectors */
    uint32_t child[CLUSTER_KEPT]; /* whose parts these are, by the first child; 0: nobody's */
    struct cluster_parts parts[CLUSTER_KEPT];
};

static inline void cluster_walk_open(struct cluster_walk *w, const struct element *all,
                                     const double v[3], double slope)
{
    w->all = all;
    w->width = lanes_width();
    w->slope = slope;
    for (int k = 0; k < 3; k++)
        w->v[k] = v[k];
    for (int i = 0; i < CLUSTER_KEPT; i++)
        w->child[i] = 0;
}

/* What cluster_facing has of an area, to the bit, without branches, so that several go together: d
 * is the cosine of v with the axis; flat > 0: of a surface. */
TOOL double cluster_cosine(double d, double cone, double flat, double slope)
{
    const double across = 1 - d * d, sine = 1 - cone * cone, turned = across * sine,
                 root = sqrt(turned > 0 ? turned : 0), some = across > 0 ? root : 0;
    double c = d * cone + (sine > 0 ? some : 0);
    c = d < cone ? c : 1;
    c = (flat > 0 ? d : c) + slope;
    c = c < 1 ? c : 1;
    return c < 0 ? 0 : c;
}

/* By fours: few clusters have more children. */
TOOL void cluster_parts_body(const struct element *child, int children, const double v[3],
                             double slope, struct cluster_parts *p)
{
    static const double place[CLUSTER_CHILDREN] = {0, 1, 2, 3, 4, 5, 6, 7};
    /* A row is the normal and the area: an assertion that C99, C11 and C++11 know alike. */
    (void)sizeof(char[offsetof(struct element, normal) == 0
                              && offsetof(struct element, area) == 3 * sizeof(double)
                          ? 1
                          : -1]);
    const double v0 = v[0], v1 = v[1], v2 = v[2], last = children - 1;
    double sum = 0;
    for (int i = 0; i < children; i += 4) {
        double row[4][4], cone[4], flat[4]; /* the normal and the area, which lie side by side */
        const struct element *e = &child[i];
        for (int k = 0; k < 4; k++) {
            memcpy(row[k], e, sizeof row[k]);
            cone[k] = e->cone;
            flat[k] = e->vertices;
            e += i + k + 1 < children;
        }
        for (int k = 0; k < 4; k++) {
            const double d = row[k][0] * v0 + row[k][1] * v1 + row[k][2] * v2;
            p->part[i + k] = row[k][3] * cluster_cosine(d, cone[k], flat[k], slope);
        }
    }
    for (int k = 0; k < children; k++)
        sum += p->part[k];
    for (int i = 0; i < children; i += 4)
        for (int k = i; k < i + 4; k++) {
            p->share[k] = p->part[k] / sum;
            p->pass[k] = place[k] < last ? p->part[k] : INFINITY;
        }
    p->sum = sum;
}

#if LANES_CHOSEN
LANES_AVX2 void cluster_parts_4(const struct element *child, int children, const double v[3],
                                double slope, struct cluster_parts *p)
{
    cluster_parts_body(child, children, v, slope, p);
}
#endif

/* Keep the parts of cluster e at its place, where another's may be. */
OUTLINE void cluster_keep(struct cluster_walk *w, const struct element *e, uint32_t at)
{
    w->child[at] = e->child;
    LANES_RUN(w->width, cluster_parts_4, cluster_parts_4, cluster_parts_body,
              (&w->all[e->child], e->children, w->v, w->slope, &w->parts[at]));
}

/* The face that *left in [0, 1) chooses below e; what remains of it once the choice has used it up;
 * *chance, that e was chosen, becomes that the face was. NULL: none faces v. */
static inline const struct element *cluster_face(struct cluster_walk *w, const struct element *e,
                                                 double *left, double *chance)
{
    double u = *left, all = *chance;
    while (!e->vertices) {
        const uint32_t at = e->child * 2654435769u >> (32 - CLUSTER_KEPT_BITS);
        const struct cluster_parts *p = &w->parts[at];
        if (w->child[at] != e->child)
            cluster_keep(w, e, at);
        double rest[4];
        rest[0] = u * p->sum;
        int k = rest[0] >= p->pass[0], on = k;
        rest[1] = rest[0] - p->part[0];
        on &= rest[1] >= p->pass[1];
        k += on;
        rest[2] = rest[1] - p->part[1];
        on &= rest[2] >= p->pass[2];
        k += on;
        rest[3] = rest[2] - p->part[2];
        u = rest[k];
        if (k == 3) /* eight children, of an octree */
            for (; u >= p->pass[k]; k++)
                u -= p->part[k];
        const double part = p->part[k];
        if (!(part > 0)) /* nothing faces v, or rounding led past the last that does */
            return NULL;
        u = u < part ? u / part : 0.5;
        all *= p->share[k];
        e = &w->all[e->child + (uint32_t)k];
    }
    *left = u;
    *chance = all;
    return e;
}

/* A pair of elements, the same both ways round: what all its samples have in common. */
struct cluster_ends {
    const struct element *r, *s, *all;
    uint64_t hash;
    double v[3], back[3], distance, slope; /* from r to s, of length 1; and the other way */
    double first[4];                       /* where the lattice begins */
};

/* How far the lattice goes with each sample. */
static const double cluster_step[4] = {0.8566748838545029, 0.733891856627126, 0.6287067210378087,
                                       0.5385972572236101};

/* Returns 0 where the two have one centre. */
static inline int cluster_ends_open(struct cluster_ends *p, const struct element *receiver,
                                    const struct element *emitter, const struct host *host)
{
    p->r = receiver->id < emitter->id ? receiver : emitter;
    p->s = p->r == receiver ? emitter : receiver;
    p->all = *host->elements;
    p->hash = hash64(p->r->id + hash64(p->s->id));
    sub3(p->v, p->s->centre, p->r->centre);
    p->distance = length3(p->v);
    if (!(p->distance > 0))
        return 0;
    p->slope = (p->r->radius + p->s->radius) / p->distance;
    for (int k = 0; k < 3; k++) {
        p->v[k] /= p->distance;
        p->back[k] = -p->v[k];
    }
    for (int k = 0; k < 4; k++)
        p->first[k] = (double)(p->hash >> 16 * k & 0xffff) * (1 / 65536.0);
    return 1;
}

/* Makes at most `count` segments. Returns how many. */
static inline int cluster_segments(const struct cluster_ends *p, const struct host *host, int count,
                                   struct segment *segments, double *weight)
{
    const struct element *r = p->r, *s = p->s;
    struct cluster_walk from_r, from_s;
    int n = 0;
    cluster_walk_open(&from_r, p->all, p->v, p->slope);
    cluster_walk_open(&from_s, p->all, p->back, p->slope);
    for (int tried = 0; n < count && tried < CLUSTER_TRIES * count; tried++) {
        struct segment *g = &segments[n];
        double u[4], w[3], chance[2] = {1, 1};
        for (int k = 0; k < 4; k++) {
            u[k] = p->first[k] + (tried + 0.5) * cluster_step[k];
            u[k] -= (int)u[k];
        }
        const struct element *a = cluster_face(&from_r, r, &u[0], &chance[0]);
        if (!a)
            continue;
        surface_point(g->from, a, u[0], u[1]);
        /* nothing of s is in front, nor is what rounding could make of it */
        if (height3(s->centre, g->from, a->normal) + 1.001 * s->radius < -1e-9 * p->distance)
            continue;
        const struct element *b = cluster_face(&from_s, s, &u[2], &chance[1]);
        if (!b)
            continue;
        surface_point(g->to, b, u[2], u[3]);
        sub3(w, g->to, g->from);
        double cos_a = dot3(a->normal, w);
        double cos_b = -dot3(b->normal, w);
        double square = dot3(w, w) / (p->distance * p->distance);
        if (!(cos_a > 0) || !(cos_b > 0))
            continue;
        weight[n] = cos_a * cos_b * (a->area / r->area) * (b->area / s->area)
                    / (square * square * chance[0] * chance[1]);
        segment_clear(g, a->normal, b->normal, host);
        n++;
    }
    return n;
}

#endif
