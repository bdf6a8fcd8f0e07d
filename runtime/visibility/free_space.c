/* free_space.c - see free_space.h.
 *
 * A wall whose plane has the whole scene on one side stops no segment between two surfaces: both
 * ends are on that side, and so is all between. So only the other faces stand in the way: those of
 * a table, not those of the room; in an empty convex room none. What runs past the box of them
 * needs no ray.
 *
 * What lies behind a plane by no more than `flat` lies in it, as for all rays. Whether anything is
 * behind is asked of the clusters: a box that is not is left alone with all it holds, so that a
 * walk takes few steps; it ends at the first face behind. A face in the plane of a wall found
 * before needs none. Where walls are curved and fine many boxes reach behind a little: what is not
 * known after FREE_SPACE_STEPS for each face may stand in the way.
 * [derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "hierarchy/reach.h"
#include "kernel/constants.h"
#include "visibility/free_space.h"

enum { WALLS = 16 };

/* The plane of a face, from one of its sides, and how many steps all walks together have left. */
struct walk {
    const struct hierarchy *h;
    const double *at;
    double normal[3], flat;
    uint64_t steps;
};

/* Is a part of element i or of what it holds more than `flat` behind the plane? 1 where it is not
 * known, too. */
static int reaches_behind(struct walk *w, uint32_t i)
{
    const struct hierarchy *h = w->h;
    const struct element *e = &h->elements[i];
    const double(*v)[3] = (const double(*)[3])e->vertex;
    int face = e->vertices && h->face_element[e->face] == i;
    double high = 0, low = 0;
    if (w->steps == 0)
        return 1;
    w->steps--;
    if (face) {
        polygon_reach(v, e->vertices, w->at, w->normal, &high, &low);
        return low < -w->flat;
    }
    if (!e->vertices) {
        box_reach(v, w->at, w->normal, &high, &low);
        if (low >= -w->flat)
            return 0;
    }
    for (uint32_t c = 0; c < e->children; c++)
        if (reaches_behind(w, e->child + c))
            return 1;
    return 0;
}

/* The walls found last: most faces lie in the plane of a neighbour. */
struct walls {
    const struct element *last[WALLS];
    uint32_t found;
};

static int lies_in(const struct element *e, const struct element *wall, double flat)
{
    double high = 0, low = 0;
    element_reach(wall, e, &high, &low);
    return high <= flat && low >= -flat;
}

/* Is all of the scene on one side of the face? */
static int is_wall(struct walk *w, struct walls *walls, uint32_t face)
{
    const struct element *e = hierarchy_surface(w->h, face);
    for (uint32_t i = 0; i < walls->found && i < WALLS; i++)
        if (lies_in(e, walls->last[i], w->flat))
            return 1;
    w->at = e->vertex[0];
    for (int side = 0; side < 2; side++) {
        for (int k = 0; k < 3; k++)
            w->normal[k] = side ? -e->normal[k] : e->normal[k];
        if (!reaches_behind(w, 0)) {
            walls->last[walls->found++ % WALLS] = e;
            return 1;
        }
    }
    return 0;
}

void free_space_find(struct free_space *space, const struct hierarchy *h, double flat, double off)
{
    struct walls walls = {.found = 0};
    struct walk walk = {.h = h, .flat = flat, .steps = FREE_SPACE_STEPS * (uint64_t)h->face_count};
    for (int k = 0; k < 3; k++) {
        space->low[k] = INFINITY;
        space->high[k] = -INFINITY;
    }
    for (uint32_t i = 0; i < h->face_count; i++) {
        const struct face *f = &h->faces[i];
        if (!face_shades(f) || is_wall(&walk, &walls, i))
            continue;
        for (uint32_t v = 0; v < f->vertices; v++)
            for (int k = 0; k < 3; k++) {
                space->low[k] = fmin(space->low[k], f->vertex[v][k] - off);
                space->high[k] = fmax(space->high[k], f->vertex[v][k] + off);
            }
    }
}
