/* sight_pieces.h - what a point sees of a convex polygon past convex faces, exactly.
 * SPDX-License-Identifier: MIT */
#ifndef SIGHT_PIECES_H
#define SIGHT_PIECES_H

#include "engine/exchange_tree.h"
#include "kernel/outline.h"

/* the most faces that may stand between, of a mesh; so many where each is cut out by itself; the
 * most edges and feet, which as many have */
enum { SIGHT_LIST = 2048, SIGHT_CUT = 256, SIGHT_EDGES = 5 * SIGHT_CUT };
/* faces of a list that is not worth an index; by how many an index tells places apart, twice the
 * longest list's */
enum { SIGHT_SHORT = 16, SIGHT_PLACES = 2 * SIGHT_LIST };
/* and of one that does for all pieces of a pair; measured: in rooms of boxes, 16 are worse, 256 no
 * better */
enum { SIGHT_SHARED = 64 };

/* The polygon that is looked at, in its plane; the plane that shadows are cast on is raised a
 * little, as rays' ends are. */
struct sight {
    struct outline_frame frame, raised;
    struct outline_cell cell;
};

/* Edges of pieces, from a to b as the eye sees them: summed as many at a time as there is room. The
 * first are those of all of the polygon, if there are so many still. */
enum { SIGHT_EYE_EDGES = 96 };
struct sight_edges {
    int count, of_whole;
    double a[2][SIGHT_EYE_EDGES], b[2][SIGHT_EYE_EDGES], value[SIGHT_EYE_EDGES], sum, whole;
};

/* A point over the plane, in the plane's coordinates, and what it has found. */
struct sight_eye {
    double at[2], height, normal[3];
    struct sight_edges edges;
};

/* `part`: what of the element is to be seen. */
void sight_open(struct sight *sight, const struct element *e, const struct polygon *part,
                double up);

void sight_eye_open(struct sight_eye *eye, const struct sight *sight, const double x[3],
                    const double n[3]);
void sight_eye_add(struct sight_eye *eye, const struct outline_cell *cell);

/* Sum up the edges that have been added since. */
void sight_eye_sum(struct sight_eye *eye);

/* Add an edge of what is hidden, or, the other way round, of what is seen. */
static inline void sight_eye_edge(struct sight_eye *eye, const double from[2], const double to[2])
{
    struct sight_edges *g = &eye->edges;
    if (g->count == SIGHT_EYE_EDGES)
        sight_eye_sum(eye);
    for (int k = 0; k < 2; k++) {
        g->a[k][g->count] = from[k] - eye->at[k];
        g->b[k][g->count] = to[k] - eye->at[k];
    }
    g->count++;
}

/* Of all cells and edges of the plane that were added, Lambert's sum, and of all of the polygon; in
 * [0, 1].
 */
double sight_eye_factor(struct sight_eye *eye, double *whole);
/* The same when only what is taken away of the polygon was added, turned; 0 of what rounding may
 * leave of all. */
double sight_eye_left(struct sight_eye *eye, double *whole);

static inline void sight_in_plane(const struct outline_frame *f, const double p[3], double out[3])
{
    outline_in(f, p, out);
    out[2] = height3(p, f->origin, f->n);
}

/* Does an edge run through a convex cell, whose corners have the heights h over its line a u + b v
 * = c? By where the line enters and leaves: cells may have sides without a direction. The edge
 * starts at `from` and is (-b, a) long. */
int sight_runs_through(const double from[2], double a, double b, const struct outline_cell *cell,
                       const double *h);

/* The form factor from a point x with normal n, in front of whose plane all of the polygon lies, to
 * what it sees of the polygon past the faces, from `up` over x. In [0, 1]; *whole: to all of it. */
double sight_factor(const struct sight *sight, const double x[3], const double n[3], double up,
                    const struct exchange_tree *tree, const uint32_t *faces, int count,
                    double *whole);

/* Of cells with more corners than this halves are cut, which has room for all that a shadow adds.
 */
enum { SIGHT_CELL_MOST = OUTLINE_CELL - 2 * OUTLINE_CORNERS };

/* The halves of a convex cell, along the line between two of its corners. */
void sight_halve(const struct outline_cell *cell, struct outline_cell half[2]);

/* The box around points of the plane: low and high of either coordinate. */
void sight_box(const double (*p)[2], int n, double box[4]);

/* Does a shadow fall on the polygon? What only touches does not. */
int sight_shade_meets(const struct outline *shade, const struct outline_cell *cell);

#endif
