/* sight_outlines.c - what a point sees of a convex polygon past surfaces made of many faces, by
 * their outlines.
 *
 * How many faces a ray meets is the same on both sides of an edge where two faces go on into each
 * other, both turned to the eye or both away: their shadows lie side by side. So of a mesh the
 * shadow changes at its outline alone. The polygon is cut along the outline's edges that cross it,
 * as far as they do; what is then left uncut is seen or hidden as one, and one ray into each part
 * says which, past the faces themselves. An edge too many costs time and changes nothing.
 * Faces must be flat. Nothing else is asked of surfaces: they may be open, of any shape, and cross.
 * Invariant: as sight_pieces.c, but for rounding; where no edge is an outline from anywhere, the
 * piece is clear or hidden, proved (visibility/hidden.c).
 * [Appel 1967, outlines and how many surfaces hide; binary space partition, Fuchs, Kedem & Naylor
 * 1980; put together here]
 * SPDX-License-Identifier: MIT */
#include "engine/sight_outlines.h"
#include "kernel/hash.h"

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

/* A part that so many edges still run through is worth a look at what hides all of it: a ray more
 * to one that is cut into more than as many. Chosen. */
enum { WORTH_A_LOOK = 8 };

/* A block with a face that the ray to somewhere within a part meets; -1: there is none. Corners
 * count by chance: midway between them, and on the axes of what is regular, run edges where two
 * faces go on into each other, as the diagonals of squares and the spokes of hexagons, and where
 * these do not fit to the last digit a ray slips through. */
static int hides_inside(const struct cutting *c, const struct outline_cell *cell)
{
    struct sight_ray ray = {.from = {c->from[0], c->from[1], c->from[2]}};
    double all = 0;
    for (int i = 0; i < cell->n; i++) {
        const double counts = 1 + hash_unit((uint64_t)i);
        for (int k = 0; k < 2; k++)
            ray.to[k] += cell->p[i][k] * counts;
        all += counts;
    }
    for (int k = 0; k < 2; k++)
        ray.to[k] /= all;
    sight_ray_aim(&ray);
    return sight_faces_stop(c->between->block, sight_between_blocks(c->between), &ray);
}

/* Does one face that hides a place within a part hide all of it? Where the rays to its corners meet
 * what is convex, so do all others. */
static int is_covered(const struct cutting *c, const struct outline_cell *cell)
{
    struct sight_ray ray = {.from = {c->from[0], c->from[1], c->from[2]}};
    const int at = hides_inside(c, cell);
    int met = at < 0 ? 0 : ~0;
    for (int i = 0; i < cell->n && met; i++) {
        ray.to[0] = cell->p[i][0];
        ray.to[1] = cell->p[i][1];
        sight_ray_aim(&ray);
        met &= sight_faces_met(&c->between->block[at], &ray);
    }
    return met != 0;
}

/* Does a line run through the cell, which lies in a box? h[]: how far the cell's corners are over
 * it. */
static int crosses(const struct cut_line *line, const struct outline_cell *cell,
                   const double box[4], double *h)
{
    const double *p = line->end[0], *q = line->end[1];
    int over_it = 0, under_it = 0;
    for (int k = 0; k < 2; k++)
        if ((p[k] < box[k] && q[k] < box[k]) || (p[k] > box[2 + k] && q[k] > box[2 + k]))
            return 0;
    for (int i = 0; i < cell->n; i++) {
        h[i] = line->a * cell->p[i][0] + line->b * cell->p[i][1] - line->c;
        over_it |= h[i] > 0;
        under_it |= h[i] < 0;
    }
    return over_it && under_it && sight_runs_through(line->end[0], line->a, line->b, cell, h);
}

/* Of more lines than that, a part is halved between them first: a line of a rounded outline has
 * all others on one side, so that cuts along one after the other look at each of them as often as
 * there are. Measured: 200 corners take a quarter of the time, 16 as long as before. */
enum { WORTH_HALVING = 16 };

/* How far the cell's corners are past the middle of so many lines, across the way along which these
 * are spread. Returns 0 when most would run through both halves. */
static int halve_between(const struct cutting *c, const uint16_t *list, int n,
                         const struct outline_cell *cell, double *h)
{
    double sum[2] = {0, 0}, low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    int side[2] = {0, 0};
    for (int i = 0; i < n; i++)
        for (int k = 0; k < 2; k++) {
            const struct cut_line *line = &c->line[list[i]];
            const double middle = 0.5 * (line->end[0][k] + line->end[1][k]);
            sum[k] += middle;
            low[k] = middle < low[k] ? middle : low[k];
            high[k] = middle > high[k] ? middle : high[k];
        }
    const int axis = high[1] - low[1] > high[0] - low[0];
    const double at = sum[axis] / n;
    for (int i = 0; i < n; i++) {
        const struct cut_line *line = &c->line[list[i]];
        side[0] += line->end[0][axis] < at || line->end[1][axis] < at;
        side[1] += line->end[0][axis] > at || line->end[1][axis] > at;
    }
    for (int i = 0; i < cell->n; i++)
        h[i] = cell->p[i][axis] - at;
    return 4 * side[0] <= 3 * n && 4 * side[1] <= 3 * n;
}

/* Adds what is seen of the cell, cut along the lines of a list that run through it; behind the list
 * is room for shorter ones. A part is cut by those alone that run through the whole. */
static void add_seen(const struct cutting *c, const uint16_t *among, int count, uint16_t *list,
                     const struct outline_cell *cell)
{
    struct outline_cell above, below;
    double first[OUTLINE_CELL], h[OUTLINE_CELL], box[4];
    int n = 0;
    if (cell->n < 3)
        return;
    if (cell->n > SIGHT_CELL_MOST) {
        struct outline_cell half[2];
        sight_halve(cell, half);
        for (int k = 0; k < 2; k++)
            add_seen(c, among, count, list, &half[k]);
        return;
    }
    sight_box((const double(*)[2])cell->p, cell->n, box);
    for (int k = 0; k < count; k++)
        if (crosses(&c->line[among[k]], cell, box, n ? h : first))
            list[n++] = among[k];
    if (n == 0) {
        if (hides_inside(c, cell) < 0)
            sight_eye_add(c->eye, cell);
        return;
    }
    if (n > WORTH_A_LOOK && is_covered(c, cell))
        return;
    const int halved = n > WORTH_HALVING && halve_between(c, list, n, cell, h);
    above.n = polygon_divide(&cell->p[0][0], cell->n, 2, halved ? h : first, OUTLINE_CELL,
                             &above.p[0][0], &below.p[0][0], &below.n);
    list += !halved; /* nothing runs along its own line */
    n -= !halved;
    add_seen(c, list, n, list + n, &above);
    add_seen(c, list, n, list + n, &below);
}

double sight_past(const struct sight *sight, const double x[3], const double n[3], double up,
                  struct sight_between *between, double *whole)
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
    for (int k = 0; k < c.lines; k++)
        between->cuts[k] = (uint16_t)k;
    add_seen(&c, between->cuts, c.lines, between->cuts + c.lines, &sight->cell);
    return sight_eye_factor(&eye, whole);
}
