/* cluster_batch.h - samples of clusters (cluster_samples.h) for several pairs at once: a batch of
 * them goes through all steps together, several at a time (lanes.h).
 *
 * A few pairs are in hand. Each gives as many samples as it may still need to a batch, which takes
 * all through the same steps: the lattice's points, down the one tree, where segments begin, down
 * the other, where they end, what they carry. Down a tree they go a level at a time; those that
 * have come to a face leave the list. A sample that is lost is carried along and left out at the
 * end.
 *
 * Invariant: every number of a sample comes by the operations of cluster_segments in their order,
 * and those that count are taken in the lattice's order, so a pair's segments are the same to the
 * bit whatever else is in the batch. What a last batch has too much is computed in vain.
 * A cluster with more than four children (an octree's), or one that finds no spot, is walked by
 * cluster_face, sample by sample.
 * [D: derived here]
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_CLUSTER_BATCH_H
#define KERNEL_CLUSTER_BATCH_H

#include "discussion.h"
#include "kernel/cluster_samples.h"
#include "kernel/cluster_spots.h"
#include "kernel/lanes.h"
#include "kernel/rows.h"

enum {
    CLUSTER_HAND = 8,   /* pairs in hand */
    CLUSTER_SPARE = 384 /* fewer spots left: all are forgotten before the next batch */
};

/* A pair in hand: its samples are from .. from + tries - 1 of the batch. */
struct cluster_pair {
    struct cluster_ends ends;
    int at;          /* in the list */
    int count, cast; /* segments to make and to cast */
    int made, tried, from, tries;
    struct cluster_spot *root[2]; /* NULL: none yet */
    struct segment segments[SEGMENTS_MAX];
    double weight[SEGMENTS_MAX];
};

/* Samples on their way down one tree, and the points on the faces that they come to. */
struct cluster_side {
    double left[CLUSTER_ROOM], chance[CLUSTER_ROOM], last[CLUSTER_ROOM]; /* as cluster_face's */
    const struct element *face[CLUSTER_ROOM];                            /* the root: lost */
    double at[3][CLUSTER_ROOM], normal[3][CLUSTER_ROOM], area[CLUSTER_ROOM];
};

struct cluster_wave {
    const struct element *all; /* the hierarchy, its root first */
    double off;                /* as far as segments are moved off */
    int hand, samples;
    struct cluster_pair places[CLUSTER_HAND], *pair[CLUSTER_HAND]; /* those in hand come first */
    unsigned char of[CLUSTER_ROOM];                                /* which pair's a sample is */
    struct cluster_side side[2];
    double weight[CLUSTER_ROOM]; /* below 0: carries nothing */
    struct cluster_choice choice;
    struct cluster_spots spots;
    struct cluster_walk plain;
};

/* How the other element lies, seen from a pair's side. */
static inline const double *cluster_along(const struct cluster_ends *ends, int side)
{
    return side ? ends->back : ends->v;
}

/* The face below e that one sample comes to, by itself. */
OUTLINE void cluster_descend_plainly(struct cluster_wave *w, int side, const struct element *e,
                                     int sample)
{
    const struct cluster_ends *ends = &w->pair[w->of[sample]]->ends;
    struct cluster_side *x = &w->side[side];
    cluster_walk_open(&w->plain, w->all, cluster_along(ends, side), ends->slope);
    const struct element *face = cluster_face(&w->plain, e, &x->left[sample], &x->chance[sample]);
    x->face[sample] = face ? face : w->all;
}

/* Samples of the batch that are not lost set out from their pairs' elements.
 * Returns how many stand at spots; the others are there. */
TOOL int cluster_set_out(struct cluster_wave *w, int side)
{
    struct cluster_side *x = &w->side[side];
    struct cluster_choice *now = &w->choice;
    int on = 0;
    for (int j = 0; j < w->hand; j++) {
        struct cluster_pair *p = w->pair[j];
        const struct element *e = side ? p->ends.s : p->ends.r;
        const int end = p->from + p->tries;
        if (e->vertices) {
            for (int i = p->from; i < end; i++) {
                x->chance[i] = 1;
                x->face[i] = x->face[i] ? w->all : e;
            }
            continue;
        }
        if (!p->root[side] && p->tries > 0)
            p->root[side] = cluster_spot_new(&w->spots, w->all, e, cluster_along(&p->ends, side),
                                             p->ends.slope);
        struct cluster_spot *const root = p->root[side];
        for (int i = p->from; i < end && !root; i++)
            if (!x->face[i]) {
                x->chance[i] = 1;
                cluster_descend_plainly(w, side, e, i);
            }
        for (int i = p->from; i < end; i++) {
            now->left[on] = x->left[i];
            now->chance[on] = 1;
            now->at[on] = root;
            now->sample[on] = (uint16_t)i;
            on += !x->face[i];
        }
    }
    return on;
}

/* All samples that have not been lost (their `face` is NULL then), down to a face. */
TOOL void cluster_descend(struct cluster_wave *w, int side)
{
    struct cluster_side *x = &w->side[side];
    struct cluster_choice *now = &w->choice;
    int on = cluster_set_out(w, side);
    while (on > 0) {
        int still = 0;
        for (int i = on; i % CLUSTER_FEW; i++)
            now->at[i] = now->at[0];
        cluster_choose(now, on);
        for (int i = 0; i < on; i++) {
            struct cluster_spot *spot = now->at[i];
            const int64_t k = now->child[i];
            const int sample = now->sample[i];
            const double left = now->left[i], chance = now->chance[i];
            const struct element *to = spot->to[k];
            struct cluster_spot *next = spot->next[k];
            x->left[sample] = left;
            x->chance[sample] = chance;
            x->face[sample] = to;
            if (!next) {
                const struct cluster_ends *ends = &w->pair[w->of[sample]]->ends;
                next =
                    cluster_spot_new(&w->spots, w->all, to, cluster_along(ends, side), ends->slope);
                spot->next[k] = next;
                if (!next) {
                    cluster_descend_plainly(w, side, to, sample);
                    next = &w->spots.ends;
                }
            }
            now->left[still] = left;
            now->chance[still] = chance;
            now->at[still] = next;
            now->sample[still] = (uint16_t)sample;
            still += next != &w->spots.ends;
        }
        on = still;
    }
}

/* As surface_point, on the samples' faces; of a lost one, anywhere. */
TOOL void cluster_points(struct cluster_side *x, int count, const struct element *none)
{
    /* Three rows of four: an assertion as in cluster_parts_body. */
    (void)sizeof(char[sizeof none->vertex == 12 * sizeof(double) ? 1 : -1]);
    for (int i = count; i % CLUSTER_FEW; i++)
        x->face[i] = none;
    for (int i = 0; i < count; i += CLUSTER_FEW) {
        double own[4][CLUSTER_FEW], one[4][CLUSTER_FEW], two[4][CLUSTER_FEW], three[4][CLUSTER_FEW],
            corners[CLUSTER_FEW];
        const struct element *e = x->face[i], *f = x->face[i + 1], *g = x->face[i + 2],
                             *h = x->face[i + 3];
        rows_turn(e, f, g, h, offsetof(struct element, normal), own);
        rows_turn(e, f, g, h, offsetof(struct element, vertex), one);
        rows_turn(e, f, g, h, offsetof(struct element, vertex) + sizeof one[0], two);
        rows_turn(e, f, g, h, offsetof(struct element, vertex) + 2 * sizeof one[0], three);
        rows_four(corners, e->vertices, f->vertices, g->vertices, h->vertices);
        const double *left = &x->left[i], *last = &x->last[i];
        double *to = &x->at[0][i], *n = &x->normal[0][i], *area = &x->area[i];
        for (int k = 0; k < CLUSTER_FEW; k++) {
            const double a0 = one[0][k], a1 = one[1][k], a2 = one[2][k], b0 = one[3][k],
                         b1 = two[0][k], b2 = two[1][k], c0 = two[2][k], c1 = two[3][k],
                         c2 = three[0][k], d0 = three[1][k], d1 = three[2][k], d2 = three[3][k];
            const double s = left[k], t = last[k], root = sqrt(s), both = root * t, rest = 1 - t;
            const double x0 = a0 + root * (b0 - a0) + both * (c0 - b0),
                         x1 = a1 + root * (b1 - a1) + both * (c1 - b1),
                         x2 = a2 + root * (b2 - a2) + both * (c2 - b2);
            const double y0 = rest * (a0 + s * (b0 - a0)) + t * (d0 + s * (c0 - d0)),
                         y1 = rest * (a1 + s * (b1 - a1)) + t * (d1 + s * (c1 - d1)),
                         y2 = rest * (a2 + s * (b2 - a2)) + t * (d2 + s * (c2 - d2));
            to[k] = corners[k] < 4 ? x0 : y0;
            to[k + CLUSTER_ROOM] = corners[k] < 4 ? x1 : y1;
            to[k + 2 * CLUSTER_ROOM] = corners[k] < 4 ? x2 : y2;
            n[k] = own[0][k];
            n[k + CLUSTER_ROOM] = own[1][k];
            n[k + 2 * CLUSTER_ROOM] = own[2][k];
            area[k] = own[3][k];
        }
    }
}

/* The lattice's points, pair by pair; what is written behind a pair's is the next one's. */
TOOL void cluster_lattice(struct cluster_wave *w)
{
    for (int j = 0; j < w->hand; j++) {
        const struct cluster_pair *p = w->pair[j];
        for (int k = 0; k < 4; k++) {
            const double first = p->ends.first[k], step = cluster_step[k];
            const int tried = p->tried;
            struct cluster_side *x = &w->side[k / 2];
            double *u = (k % 2 ? x->last : x->left) + p->from;
            for (int i = 0; i < p->tries; i += LANES)
                for (int c = 0; c < LANES; c++) {
                    const double at = first + (tried + i + c + 0.5) * step;
                    u[i + c] = at - (int)at;
                }
        }
        for (int i = p->from; i < p->from + p->tries; i++) {
            w->of[i] = (unsigned char)j;
            w->side[0].face[i] = NULL;
        }
    }
}

/* Samples from whose points nothing of s is in front, nor is what rounding could make of it, are
 * lost. */
TOOL void cluster_cull(struct cluster_wave *w)
{
    const struct cluster_side *x = &w->side[0];
    for (int j = 0; j < w->hand; j++) {
        const struct cluster_pair *p = w->pair[j];
        const double c0 = p->ends.s->centre[0], c1 = p->ends.s->centre[1],
                     c2 = p->ends.s->centre[2], reach = 1.001 * p->ends.s->radius,
                     least = -1e-9 * p->ends.distance;
        for (int i = p->from; i < p->from + p->tries; i += LANES)
            for (int k = i; k < i + LANES; k++) {
                const double height = x->normal[0][k] * (c0 - x->at[0][k])
                                      + x->normal[1][k] * (c1 - x->at[1][k])
                                      + x->normal[2][k] * (c2 - x->at[2][k]);
                w->weight[k] = height + reach < least ? -1 : 1;
            }
    }
    for (int i = 0; i < w->samples; i++)
        w->side[1].face[i] = w->weight[i] < 0 || x->face[i] == w->all ? w->all : NULL;
}

/* What each segment would carry. */
TOOL void cluster_weigh(struct cluster_wave *w)
{
    const struct cluster_side *x = &w->side[0], *y = &w->side[1];
    for (int j = 0; j < w->hand; j++) {
        const struct cluster_pair *p = w->pair[j];
        const double area_r = p->ends.r->area, area_s = p->ends.s->area,
                     whole = p->ends.distance * p->ends.distance;
        for (int i = p->from; i < p->from + p->tries; i += LANES)
            for (int k = i; k < i + LANES; k++) {
                const double w0 = y->at[0][k] - x->at[0][k], w1 = y->at[1][k] - x->at[1][k],
                             w2 = y->at[2][k] - x->at[2][k];
                const double cos_a =
                    x->normal[0][k] * w0 + x->normal[1][k] * w1 + x->normal[2][k] * w2;
                const double cos_b =
                    -(y->normal[0][k] * w0 + y->normal[1][k] * w1 + y->normal[2][k] * w2);
                const double square = (w0 * w0 + w1 * w1 + w2 * w2) / whole;
                const double weight = cos_a * cos_b * (x->area[k] / area_r) * (y->area[k] / area_s)
                                      / (square * square * x->chance[k] * y->chance[k]);
                w->weight[k] = ((cos_a > 0) & (cos_b > 0)) ? weight : -1;
            }
    }
}

/* What a batch has made goes to its pairs, as many as each still needs, moved off the faces. */
TOOL void cluster_gather(struct cluster_wave *w)
{
    const struct cluster_side *x = &w->side[0], *y = &w->side[1];
    const double off = w->off;
    for (int j = 0; j < w->hand; j++) {
        struct cluster_pair *p = w->pair[j];
        uint16_t good[CLUSTER_BATCH];
        int found = 0;
        for (int i = p->from; i < p->from + p->tries; i++) {
            good[found] = (uint16_t)i;
            found += (y->face[i] != w->all) & (w->weight[i] >= 0);
        }
        for (int i = 0; i < found && p->made < p->count; i++, p->made++) {
            const int at = good[i];
            struct segment *g = &p->segments[p->made];
            for (int k = 0; k < 3; k++) {
                g->from[k] = x->at[k][at] + off * x->normal[k][at];
                g->to[k] = y->at[k][at] + off * y->normal[k][at];
            }
            p->weight[p->made] = w->weight[at];
        }
        p->tried += p->tries;
    }
}

TOOL void cluster_batch_body(struct cluster_wave *w)
{
    cluster_lattice(w);
    cluster_descend(w, 0);
    cluster_points(&w->side[0], w->samples, w->all);
    cluster_cull(w);
    cluster_descend(w, 1);
    cluster_points(&w->side[1], w->samples, w->all);
    cluster_weigh(w);
    cluster_gather(w);
}

#if LANES_CHOSEN
LANES_AVX512 void cluster_batch_8(struct cluster_wave *w)
{
    cluster_batch_body(w);
}
LANES_AVX2 void cluster_batch_4(struct cluster_wave *w)
{
    cluster_batch_body(w);
}
#endif

/* One batch of the pairs in hand, in vectors of a width, lanes_width() at the most. */
OUTLINE void cluster_batch(int width, struct cluster_wave *w)
{
    LANES_RUN(width, cluster_batch_8, cluster_batch_4, cluster_batch_body, (w));
}

static inline void cluster_wave_open(struct cluster_wave *w, const struct host *host)
{
    w->all = *host->elements;
    w->off = host->ray_offset;
    w->spots.used = w->hand = 0;
    for (int j = 0; j < CLUSTER_HAND; j++)
        w->pair[j] = &w->places[j];
}

/* How many samples more a pair is likely to need. */
static inline int cluster_wanted(const struct cluster_pair *p)
{
    const int need = p->count - p->made, rest = CLUSTER_TRIES * p->count - p->tried,
              likely = p->tried ? need * p->tried / (p->made ? p->made : 1) : need;
    return need == 0 ? 0 : likely < rest ? likely : rest;
}

/* Each pair in hand gets its samples of the next batch, as far as there is room. */
static inline void cluster_share_out(struct cluster_wave *w)
{
    w->samples = 0;
    if (CLUSTER_SPOTS - w->spots.used < CLUSTER_SPARE) {
        w->spots.used = 0;
        for (int j = 0; j < w->hand; j++)
            w->pair[j]->root[0] = w->pair[j]->root[1] = NULL;
    }
    for (int j = 0; j < w->hand; j++) {
        struct cluster_pair *p = w->pair[j];
        const int room = CLUSTER_BATCH - w->samples, wanted = cluster_wanted(p);
        p->from = w->samples;
        p->tries = wanted < room ? wanted : room;
        w->samples += p->tries;
    }
}

#endif
