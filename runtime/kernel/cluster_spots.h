/* cluster_spots.h - clusters that samples have come to on their way down (cluster_batch.h), and
 * which child each sample chooses there, several at a time (lanes.h).
 *
 * A cluster stands at a spot, which knows the spots of its children: what a cluster turns to the
 * other element is computed once, and found again without a search. Numbers are those of
 * cluster_parts_body and of cluster_face, by the same operations.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_CLUSTER_SPOTS_H
#define KERNEL_CLUSTER_SPOTS_H

#include "discussion.h"
#include "kernel/cluster_samples.h"
#include "kernel/lanes.h"
#include "kernel/rows.h"

enum {
    CLUSTER_BATCH = 64, /* samples that go together at the most */
    CLUSTER_ROOM = CLUSTER_BATCH + LANES_MOST,
    CLUSTER_SPOTS = 768, /* clusters that are remembered */
    CLUSTER_FEW = 4      /* children of a spot; samples that rows of four numbers become lanes of */
};

/* A cluster's children as cluster_parts has them, those that lack with no part: rows of four. What
 * a choice leads to: each child, and nothing, where none of them is turned to the other. */
struct cluster_spot {
    double part[CLUSTER_FEW];
    double pass[CLUSTER_FEW - 1], sum;
    const struct element *to[CLUSTER_FEW + 1];
    struct cluster_spot *next[CLUSTER_FEW + 1]; /* NULL: not known yet; `ends`: no cluster */
};

struct cluster_spots {
    int used;
    struct cluster_spot spot[CLUSTER_SPOTS], ends;
};

/* Samples that stand at spots: which child each chooses, what is left. */
struct cluster_choice {
    double left[CLUSTER_ROOM], chance[CLUSTER_ROOM];
    int64_t child[CLUSTER_ROOM];
    struct cluster_spot *at[CLUSTER_ROOM];
    uint16_t sample[CLUSTER_ROOM];
};

/* A spot for cluster e, as seen along v. NULL: there is none. */
TOOL struct cluster_spot *cluster_spot_new(struct cluster_spots *spots, const struct element *all,
                                           const struct element *e, const double *v, double slope)
{
    static const double place[CLUSTER_FEW] = {0, 1, 2, 3};
    const double v0 = v[0], v1 = v[1], v2 = v[2], children = e->children;
    double row[4][CLUSTER_FEW], cone[CLUSTER_FEW], flat[CLUSTER_FEW], sum = 0;
    const int last = e->children - 1;
    if (last >= CLUSTER_FEW || spots->used == CLUSTER_SPOTS)
        return NULL;
    struct cluster_spot *p = &spots->spot[spots->used++];
    const struct element *c = &all[e->child];
    for (int k = 0; k < CLUSTER_FEW; k++) {
        p->to[k] = c;
        p->next[k] = c->vertices ? &spots->ends : NULL;
        c += k < last;
    }
    const struct element *const *to = p->to;
    /* normal and area, see cluster_parts_body */
    rows_turn(to[0], to[1], to[2], to[3], offsetof(struct element, normal), row);
    rows_four(cone, to[0]->cone, to[1]->cone, to[2]->cone, to[3]->cone);
    rows_four(flat, to[0]->vertices, to[1]->vertices, to[2]->vertices, to[3]->vertices);
    p->to[CLUSTER_FEW] = all;
    p->next[CLUSTER_FEW] = &spots->ends;
    for (int k = 0; k < CLUSTER_FEW; k++) {
        const double d = row[0][k] * v0 + row[1][k] * v1 + row[2][k] * v2,
                     part = row[3][k] * cluster_cosine(d, cone[k], flat[k], slope);
        p->part[k] = place[k] < children ? part : 0;
    }
    for (int k = 0; k < CLUSTER_FEW; k++)
        sum += p->part[k];
    for (int k = 0; k < CLUSTER_FEW - 1; k++)
        p->pass[k] = k < last ? p->part[k] : INFINITY;
    p->sum = sum;
    return p;
}

/* Of each the child; CLUSTER_FEW: none. */
TOOL void cluster_choose(struct cluster_choice *x, int count)
{
    for (int i = 0; i < count; i += CLUSTER_FEW) {
        double part[4][CLUSTER_FEW], pass[4][CLUSTER_FEW];
        const struct cluster_spot *p = x->at[i], *q = x->at[i + 1], *r = x->at[i + 2],
                                  *s = x->at[i + 3];
        rows_turn(p, q, r, s, offsetof(struct cluster_spot, part), part);
        rows_turn(p, q, r, s, offsetof(struct cluster_spot, pass), pass);
        double *left = &x->left[i], *chance = &x->chance[i];
        int64_t *child = &x->child[i];
        for (int k = 0; k < CLUSTER_FEW; k++) {
            const double sum = pass[3][k], a = left[k] * sum, b = a - part[0][k],
                         c = b - part[1][k], d = c - part[2][k];
            const int64_t on_1 = a >= pass[0][k], on_2 = on_1 & (b >= pass[1][k]),
                          on_3 = on_2 & (c >= pass[2][k]);
            double rest = on_1 ? b : a, chosen = on_1 ? part[1][k] : part[0][k];
            rest = on_2 ? c : rest;
            chosen = on_2 ? part[2][k] : chosen;
            rest = on_3 ? d : rest;
            chosen = on_3 ? part[3][k] : chosen;
            const double share = rest / chosen;
            left[k] = rest < chosen ? share : 0.5;
            chance[k] *= chosen / sum;
            child[k] = chosen > 0 ? on_1 + on_2 + on_3 : (int64_t)CLUSTER_FEW;
        }
    }
}

#endif
