/* covered_leaves.c - see covered_leaves.h.
 *
 * A leaf that a solid covers in part has the light of its bare part for its own. Nobody sees it
 * under the solid, but a sum over the mesh counts it there, and along the solid's edge it is the
 * mean over what lies near and far. So such leaves are quartered, along the edge alone: quarters
 * that are bare, or wholly under the solid, stay as they are.
 *
 * A large leaf beside small ones would be bent along its edge by what is dark for a finger's
 * breadth (vertex_values.h). So neighbours on one face differ by one level at the most.
 *
 * [restricted quadtrees: von Herzen and Barr 1987; as meshes of radiosity: Cohen and Wallace 1993,
 * section 8.3]
 * SPDX-License-Identifier: MIT */
#include "engine/covered_leaves.h"
#include "engine/detail.h"
#include "kernel/constants.h"
#include "kernel/leaf_at.h"

/* Split the leaf on the other side of each edge until it is no more than one level coarser. Returns
 * 0, or -1 when out of memory. */
static int split_neighbours(struct hierarchy *h, uint32_t leaf)
{
    const struct element e = h->elements[leaf];
    for (int i = 0; i < e.vertices; i++) {
        const double *a = e.vertex[i], *b = e.vertex[(i + 1) % e.vertices];
        double across[3], weight[4];
        for (int k = 0; k < 3; k++) {
            double middle = 0.5 * (a[k] + b[k]);
            across[k] = middle + 0.25 * (middle - e.centre[k]);
        }
        for (;;) {
            /* beyond the face's border it is a leaf at the border, of about this size */
            uint32_t other = leaf_at(h->elements, h->face_element[e.face], across, weight);
            if (h->elements[other].depth + 1 >= e.depth)
                break;
            if (hierarchy_split(h, other) < 0)
                return -1;
        }
    }
    return 0;
}

/* Of the elements from `from` to `to`: those that are covered in part are split, and, unless they
 * are the ones that links made, from 0 on, their coarser neighbours. Returns 0, or -1 when out of
 * memory. */
static int split_some(struct hierarchy *h, const double *uncovered, uint32_t from, uint32_t to)
{
    const double most = COVERED_SHARE * h->elements[0].area;
    for (uint32_t i = from; i < to; i++) {
        const struct element *e = &h->elements[i];
        const int is_edge = uncovered[i] > 0 && uncovered[i] < 1;
        if (!e->vertices || e->children || e->black)
            continue;
        if (is_edge && e->area > most && hierarchy_split(h, i) < 0)
            return -1;
        if (from > 0 && split_neighbours(h, i) < 0)
            return -1;
    }
    return 0;
}

int covered_leaves(struct solve *s)
{
    struct hierarchy *h = &s->hierarchy;
    uint32_t from = 0, to;
    if (!s->linear.gradient)
        return 0;
    do {
        to = h->count;
        const int failed = split_some(h, s->operator.uncovered, from, to) < 0;
        if (ranks_any(s->problem.options.ranks, failed) || detail_light(s, to) < 0)
            return -1;
        from = to;
    } while (h->count > to);
    return 0;
}
