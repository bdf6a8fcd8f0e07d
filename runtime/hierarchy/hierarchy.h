/* hierarchy.h - the one tree of elements: clusters above the faces, parts of faces below.
 * SPDX-License-Identifier: MIT */
#ifndef HIERARCHY_H
#define HIERARCHY_H

#include <stddef.h>
#include <stdint.h>
#include "hierarchy/bvh.h"
#include "discussion.h"

/* A flat, convex face with 3 or 4 corners, counter-clockwise from its front. */
struct face {
    double vertex[4][3]; /* m */
    uint32_t vertices;   /* 3 or 4 */
    uint32_t material;   /* the caller's */
    uint32_t input;      /* index of the face in the scene file it came from */
    uint8_t back;        /* 1: the far side of a two-sided face that is also listed */
    uint8_t black;       /* 1: neither emits nor reflects in any band */
    uint8_t light;       /* enum face_light */
    uint8_t apart;       /* 1: it lies on no other part of its input */
};

/* What is known of the light on the sides of a two-sided face. No light comes to a dark one, and no
 * tree holds it: of a two-sided face the other side is left, with a black back. */
enum face_light { FACE_LIT, FACE_DARK, FACE_ALONE /* the other side is dark */ };

/* Does it cast a shadow? Of two sides one does, and so a front where both are lit. */
static inline int face_shades(const struct face *f)
{
    return f->light == FACE_LIT ? !f->back : f->light == FACE_ALONE;
}

/* Is it the front of a face with two sides, whose far side is the next face? */
static inline int face_is_pair(const struct face *faces, uint32_t count, uint32_t front)
{
    const struct face *f = &faces[front];
    return !f->back && front + 1 < count && f[1].back && f[1].input == f->input;
}

/* The other side of a face with two; UINT32_MAX: it has one. */
static inline uint32_t face_other_side(const struct face *faces, uint32_t count, uint32_t face)
{
    return faces[face].back ? face - 1 : face_is_pair(faces, count, face) ? face + 1 : UINT32_MAX;
}

struct hierarchy {
    /* [count]; element 0 is the root; children of one element are neighbours */
    struct element *elements;
    uint32_t count;
    size_t capacity;
    const struct face *faces; /* [face_count], borrowed */
    uint32_t face_count;
    uint32_t *face_element; /* [face_count]: the element that is the whole face */
    /* [face_count]: the faces in the tree's order, so that each cluster's are neighbours; dark
     * ones, which the tree does not hold, are the last */
    uint32_t *order;
    struct face_range {
        uint32_t from, to;
        /* [built]: the part of `order` below each element made by hierarchy_build */
    } * range;
    enum clustering strategy; /* that has built the tree */
    uint32_t built; /* elements made by hierarchy_build: clusters and faces, then dark faces */
    double low[3], high[3]; /* bounding box of the faces (m) */
    /* [built]: 1: what stands in shafts: faces, and groups that are as good as one. NULL: faces
     * alone */
    unsigned char *solid;
    /* [built]: 1: all that an element holds has the whole scene in front of it, and so stands in no
     * shaft (visibility/outer_walls.h). NULL: nobody knows */
    unsigned char *outer;
    /* [built]: the element whose plane all faces of this one lie in; 0: there is none
     * (flat_clusters.h). NULL: nobody knows, as with groups */
    uint32_t *plane;
    double flat; /* with groups: how far from their planes their faces may reach (m) */
};

/* Build the clusters and one element per face (deterministic, independent of threads), by the
 * default strategy and one thread. The faces are borrowed and must outlive the hierarchy. Returns
 * 0, or -1 when out of memory. */
int hierarchy_build(struct hierarchy *h, const struct face *faces, uint32_t face_count);

/* The same by a strategy and a number of threads. The elements of faces, but for their places,
 * do not depend on the strategy. */
int hierarchy_build_by(struct hierarchy *h, const struct face *faces, uint32_t face_count,
                       enum clustering strategy, int threads);

/* Room for so many elements more, lest a stretch of splits move all elements again and again.
 * Pointers into `elements` may move. Returns 0, or -1 when out of memory; then nothing has changed.
 */
int hierarchy_reserve(struct hierarchy *h, uint32_t more);

/* Split a surface in four, unless it is split. Pointers into `elements` may move.
 * Returns 0, or -1 when out of memory or out of indices; then nothing has changed. */
int hierarchy_split(struct hierarchy *h, uint32_t element);

/* Undo all splits since there were `count` elements. */
void hierarchy_drop(struct hierarchy *h, uint32_t count);

/* As hierarchy_build left it: without splits, and with nothing said of elements by a solver. */
void hierarchy_renew(struct hierarchy *h);

/* Take out of the elements from `first` on those whose parent has no children any more, or is taken
 * out. place[]: [count]: the index each has from now on, 0 for those that are gone. */
void hierarchy_close_up(struct hierarchy *h, uint32_t first, uint32_t *place);

/* Give the elements from `first` on, which splits have made in any order, the places that what is
 * split alone decides: level by level, in the order of their parents. place[]: [count]: the index
 * each has from now on. Returns 0, or -1 when out of memory; then nothing has changed. */
int hierarchy_settle(struct hierarchy *h, uint32_t first, uint32_t *place);

void hierarchy_free(struct hierarchy *h);

/* The element that is the whole face. */
static inline const struct element *hierarchy_surface(const struct hierarchy *h, uint32_t face)
{
    return &h->elements[h->face_element[face]];
}

/* The part of `order` below an element; of a part of a face the face's. */
static inline struct face_range hierarchy_range(const struct hierarchy *h, uint32_t element)
{
    return h->range[element < h->built ? element : h->face_element[h->elements[element].face]];
}

/* For builders of hierarchies: what a solver may say of an element later, unsaid; */
void element_reset(struct element *e);

/* what a face adds to its clusters; */
struct face_share {
    double normal[3], area;
    int black;
};

/* and a cluster's area, box and cone of normals, from shares in the tree's order. Exactly equal
 * normals give a cone of angle 0. */
void element_measure_cluster(struct element *e, const struct face_share *share,
                             const struct bounds *box, struct face_range range);

#endif
