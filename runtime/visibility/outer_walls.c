/* outer_walls.c - see outer_walls.h.
 *
 * What stops light has some of the scene behind it: a plane with all faces in front of it is
 * crossed by no segment between two of them. Such a wall needs no look at shafts, nor does an
 * element that holds such walls alone; in the inside of a ball that is all of it, though each of
 * its faces reaches into the boxes around many shafts. Faces that lie flat on the wall and look at
 * it are under it for shafts (shaft.h), which hides them: then it stays one that is asked.
 *
 * As in free_space.c a walk looks at boxes that reach behind the plane, and few do. Most planes are
 * known by the first corner that is asked, the one that was behind the last plane: so what takes
 * steps is what is a wall, or nearly. What is not known after STEPS for each face is no wall.
 * Invariant: `outer` depends on the faces and the tree alone. [derived here]
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include "hierarchy/reach.h"
#include "kernel/constants.h"
#include "visibility/outer_walls.h"

/* Steps for each face, all together. Four times those of free_space.c, as here each pair of faces
 * is asked what stands between: balls of 100,000 faces are known, and a million take seconds.
 * Chosen */
enum { STEPS = 1024 };

struct walk {
    struct hierarchy *h;
    const struct element *wall;
    double behind, near; /* heights (m): farther behind, what is cut off; of what may lie on it */
    uint32_t witness;    /* an element that was behind the last plane */
    uint64_t steps;      /* that are left for all walks together */
};

/* Is some of a face behind the wall, or does it lie flat on it, looking at it? */
static int is_against(const struct walk *w, const struct element *e)
{
    const double *n = w->wall->normal;
    double high = -INFINITY, low = INFINITY, across[3];
    element_reach(w->wall, e, &high, &low);
    if (low < w->behind)
        return 1;
    cross3(across, n, e->normal);
    return low < w->near && dot3(n, e->normal) < 0 && dot3(across, across) < 2 * SHAFT_PARALLEL;
}

/* Is any face below an element, or is that not known? */
static int any_against(struct walk *w, uint32_t index)
{
    const struct element *e = &w->h->elements[index];
    if (w->steps == 0)
        return 1;
    w->steps--;
    if (e->vertices && !e->group) {
        const int against = is_against(w, e);
        w->witness = against ? index : w->witness;
        return against;
    }
    if (!e->vertices) {
        double high, low;
        box_reach((const double(*)[3])e->vertex, w->wall->vertex[0], w->wall->normal, &high, &low);
        if (low > w->near)
            return 0;
    }
    for (uint32_t c = 0; c < e->children; c++)
        if (any_against(w, e->child + c))
            return 1;
    return 0;
}

/* Is what stands in shafts as this one face flat, and all faces before it? */
static int is_outer(struct walk *w, uint32_t index)
{
    double high = 0, low = 0;
    w->wall = &w->h->elements[index];
    element_reach(w->wall, w->wall, &high, &low);
    return high <= -w->behind && low >= w->behind && !is_against(w, &w->h->elements[w->witness])
           && !any_against(w, 0);
}

/* Returns whether all that an element holds is. */
static int find(struct walk *w, uint32_t index)
{
    struct hierarchy *h = w->h;
    const uint32_t child = h->elements[index].child, children = h->elements[index].children;
    int all = h->solid[index] ? is_outer(w, index) : children > 0;
    for (uint32_t c = 0; c < children && !h->solid[index]; c++)
        all &= find(w, child + c);
    h->outer[index] = (unsigned char)all;
    return all;
}

int outer_walls_find(struct hierarchy *h, double offset)
{
    struct walk w = {.h = h,
                     .behind = -SHAFT_STRIP * offset,
                     .near = 2 * offset, /* more than an end's offset and SHAFT_MARGIN */
                     .witness = h->face_element[0],
                     .steps = STEPS * (uint64_t)h->face_count};
    h->outer = calloc(h->built, 1);
    if (!h->outer)
        return -1;
    (void)find(&w, 0);
    return 0;
}
