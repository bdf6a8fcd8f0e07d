/* sight_outlines.c - what a point sees of a convex polygon past surfaces made of many faces, by
 * their outlines.
 *
 * How many faces a ray meets is the same on both sides of an edge where two faces go on into each
 * other, both turned to the eye or both away: their shadows lie side by side. So of a mesh the
 * shadow changes at its outline alone. The polygon is cut along the outline's edges that cross it,
 * as far as they do; what is then left uncut is seen or hidden as one, and one ray at each part's
 * middle says which, past the faces themselves. An edge too many costs time and changes nothing.
 * Faces must be flat. Nothing else is asked of surfaces: they may be open, of any shape, and cross.
 * Invariant: as sight_pieces.c, but for rounding; where no edge is an outline from anywhere, the
 * piece is clear or hidden, proved (visibility/hidden.c).
 * [Appel 1967, outlines and how many surfaces hide; binary space partition, Fuchs, Kedem & Naylor
 * 1980; put together here]
 * SPDX-License-Identifier: MIT */
#include "engine/sight_outlines.h"

/* An edge of the outline as its shadow in the plane, and the line it is part of: on it a u + b v =
 * c. */
struct cut_line {
    double end[2][2], a, b, c;
};

/* A point at work. */
struct cutting {
    struct sight_eye *eye;
    const struct sight_between *between;
    double from[3]; /* where rays start, in the plane's coordinates */
    int lines;
    struct cut_line line[SIGHT_EDGES];
};

/* The shadows that cross the polygon, of edges that are outlines from the eye. */
static void cast_edges(struct cutting *c, const struct outline_cell *cell)
{
    const struct sight_between *b = c->between;
    struct sight_shadows shadows;
    c->lines = 0;
    for (int at = 0; at < b->edges; at += SIGHT_LINES) {
        sight_shadows_cast(&b->edge[at / SIGHT_LINES], c->from, cell, &shadows);
        for (int k = 0; k < SIGHT_LINES; k++)
            if (shadows.crosses[k])
                c->line[c->lines++] =
                    (struct cut_line){{{shadows.end[0][0][k], shadows.end[0][1][k]},
                                       {shadows.end[1][0][k], shadows.end[1][1][k]}},
                                      shadows.a[k],
                                      shadows.b[k],
                                      shadows.c[k]};
    }
}

/* Does the ray to the middle of a part meet a face? */
static int is_hidden(const struct cutting *c, const struct outline_cell *cell)
{
    struct sight_ray ray = {.from = {c->from[0], c->from[1], c->from[2]}};
    const double each = 1.0 / cell->n;
    for (int i = 0; i < cell->n; i++)
        for (int k = 0; k < 2; k++)
            ray.to[k] += cell->p[i][k] * each;
    sight_ray_aim(&ray);
    return sight_faces_stop(c->between->block, sight_between_blocks(c->between), &ray);
}

/* Adds what is seen of the cell, cut along the edges from k on. */
static void add_seen(const struct cutting *c, int k, const struct outline_cell *cell)
{
    struct outline_cell above, below;
    double h[OUTLINE_CELL];
    if (cell->n < 3)
        return;
    for (; k < c->lines; k++) {
        const struct cut_line *line = &c->line[k];
        int over_it = 0, under_it = 0;
        for (int i = 0; i < cell->n; i++) {
            h[i] = line->a * cell->p[i][0] + line->b * cell->p[i][1] - line->c;
            over_it |= h[i] > 0;
            under_it |= h[i] < 0;
        }
        if (over_it && under_it && sight_runs_through(line->end[0], line->a, line->b, cell, h)) {
            above.n = polygon_divide(&cell->p[0][0], cell->n, 2, h, OUTLINE_CELL, &above.p[0][0],
                                     &below.p[0][0], &below.n);
            add_seen(c, k + 1, &above);
            add_seen(c, k + 1, &below);
            return;
        }
    }
    if (!is_hidden(c, cell))
        sight_eye_add(c->eye, cell);
}

double sight_past(const struct sight *sight, const double x[3], const double n[3], double up,
                  const struct sight_between *between, double *whole)
{
    struct cutting c;
    struct sight_eye eye;
    double from[3];
    for (int k = 0; k < 3; k++)
        from[k] = x[k] + up * n[k];
    sight_eye_open(&eye, sight, x, n);
    sight_in_plane(&sight->raised, from, c.from);
    *whole = 0;
    if (!(eye.height > 0) || !(c.from[2] > 0))
        return 0;
    c.eye = &eye;
    c.between = between;
    cast_edges(&c, &sight->cell);
    add_seen(&c, 0, &sight->cell);
    return sight_eye_factor(&eye, whole);
}
