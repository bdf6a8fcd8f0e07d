/* bvh.h - the tree of clusters over the faces, and the strategies that can build it.
 *
 * What a strategy is asked to do stands in bvh_strategy.h; whatever it answers, the tree is sound:
 * each face is in it once, a node has 2 to PARTS_MAX children, and no path is longer than DEPTH_MAX
 * and what halving needs below that.
 * SPDX-License-Identifier: MIT */
#ifndef CLUSTER_TREE_H
#define CLUSTER_TREE_H

#include <stdint.h>

struct face;

/* Constant, name, what it is. `radiosity study clustering` compares them. */
#define CLUSTERINGS(X) \
    X(SAH, sah, "boxes cut where the surface-area heuristic says [Wald 2007]") \
    X(EMBREE, embree, "Embree's high-quality builder, spatial splits [Stich et al. 2009]") \
    X(OCTREE, octree, "uniform octree, faces by middle and size [Ulrich 2000]") \
    X(KD, kd, "overlapping k-d tree, planes by surface area [MacDonald and Booth 1990]") \
    X(HALVES, halves, "as sah where every slice holds a face, else halves of the file's order")
enum clustering {
#define X(constant, name, help) CLUSTERING_##constant,
    CLUSTERINGS(X)
#undef X
        CLUSTERING_COUNT,
    CLUSTERING_DEFAULT = CLUSTERING_COUNT /* sah from CLUSTERS_FACES on, below halves */
};
extern const char *const clustering_names[CLUSTERING_COUNT],
    *const clustering_helps[CLUSTERING_COUNT];

/* Returns the strategy's number, or -1. */
int clustering_of(const char *name);

/* What builds the tree over so many faces: the strategy, or what the default chooses. */
enum clustering clustering_chosen(enum clustering strategy, uint32_t count);

enum { PARTS_MAX = 8, DEPTH_MAX = 64 };

struct bounds {
    double low[3], high[3];
};

struct bvh_node {
    uint32_t from, to; /* its faces in `order` */
    uint32_t child;    /* the first; the others follow */
    uint32_t children; /* 0: it is one face */
};

struct bvh {
    uint32_t *order; /* [face_count]: faces */
    /* [count], breadth first; [0] is the root, the only one that may have a single child */
    struct bvh_node *nodes;
    struct bounds *boxes; /* [count] */
    uint32_t count;
    uint32_t depth; /* nodes from the root to the farthest face, both ends included */
};

/* Returns 0, or -1 when out of memory; then the tree is empty. The tree depends on faces and
 * strategy alone. */
int bvh_build(struct bvh *t, const struct face *faces, uint32_t count, enum clustering strategy,
              int threads);
void bvh_free(struct bvh *t);

void bounds_empty(struct bounds *b);
void bounds_add(struct bounds *b, const struct bounds *other);
double bounds_area(const struct bounds *b); /* half of its surface; 0 when empty */

#endif
