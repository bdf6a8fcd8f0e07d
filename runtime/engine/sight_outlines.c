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
#include <string.h>
#include "engine/sight_outlines.h"
#include "kernel/shaft.h"
#include "visibility/candidates.h"
#include "visibility/hidden.h"

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

static void in_plane(const struct outline_frame *f, const double p[3], double out[3])
{
    outline_in(f, p, out);
    out[2] = height3(p, f->origin, f->n);
}

static void make_face(struct sight_between *b, int at, const struct element *e,
                      const struct outline_frame *f)
{
    struct sight_faces *block = &b->block[at / SIGHT_BOXED];
    const int lane = at % SIGHT_BOXED;
    double p[3], n[3] = {dot3(e->normal, f->u), dot3(e->normal, f->v), dot3(e->normal, f->n)};
    if (lane == 0)
        memset(block, 0, sizeof *block);
    for (int i = 0; i < SIGHT_CORNERS; i++) {
        if (i < e->vertices)
            in_plane(f, e->vertex[i], p);
        for (int k = 0; k < 3; k++)
            block->v[i][k][lane] = p[k];
        if (i == 0)
            block->plane[3][lane] = dot3(n, p);
    }
    for (int k = 0; k < 3; k++)
        block->plane[k][lane] = n[k];
}

static void corner_of(const struct sight_between *b, int at, int corner, double p[3])
{
    for (int k = 0; k < 3; k++)
        p[k] = b->block[at / SIGHT_BOXED].v[corner][k][at % SIGHT_BOXED];
}

static void plane_of(const struct sight_between *b, int at, double plane[4])
{
    for (int k = 0; k < 4; k++)
        plane[k] = b->block[at / SIGHT_BOXED].plane[k][at % SIGHT_BOXED];
}

/* Faces of a short list are looked for in it; of others, their places are kept by the last digits
 * of their indices. */
static void make_places(struct sight_between *b)
{
    if (b->faces <= SIGHT_SHORT)
        return;
    memset(b->place, 0, sizeof b->place);
    for (int i = 0; i < b->faces; i++)
        b->place[b->list[i] % SIGHT_PLACES] = (uint16_t)(i + 1);
}

/* Where in the list a face is; -1: it is not in it. */
static int place_of(const struct sight_between *b, uint32_t face)
{
    int low = 0, high = b->faces;
    if (b->faces > SIGHT_SHORT) {
        int at = b->place[face % SIGHT_PLACES] - 1;
        if (at < 0 || b->list[at] == face)
            return at;
        high = at; /* the place is the last one's with these digits */
    }
    while (low < high) {
        int middle = (low + high) / 2;
        if (b->list[middle] < face)
            low = middle + 1;
        else
            high = middle;
    }
    return low < b->faces && b->list[low] == face ? low : -1;
}

/* The next edge, from p to q, between two planes. Returns -1 when there are too many. */
static int add_edge(struct sight_between *b, const double p[3], const double q[3],
                    const double planes[2][4])
{
    struct sight_edge_block *block = &b->edge[b->edges / SIGHT_LINES];
    const int lane = b->edges % SIGHT_LINES;
    if (b->edges == SIGHT_EDGES)
        return -1;
    if (lane == 0)
        memset(block, 0, sizeof *block);
    for (int k = 0; k < 3; k++) {
        block->end[0][k][lane] = p[k];
        block->end[1][k][lane] = q[k];
    }
    for (int k = 0; k < 4; k++) {
        block->plane[0][k][lane] = planes[0][k];
        block->plane[1][k][lane] = planes[1][k];
    }
    b->edges++;
    return 0;
}

/* Of an edge that is an outline from anywhere: all is over the one plane and under the other. */
static const double ANYWHERE[2][4] = {{0, 0, 0, -1}, {0, 0, 0, 1}};

/* The line along which a face of n corners meets the plane, if it crosses it: its shadow ends
 * there.
 */
static int add_foot(struct sight_between *b, int at, int n)
{
    double end[2][3] = {{0}}, last[3], next[3];
    int found = 0;
    corner_of(b, at, n - 1, last);
    for (int i = 0; i < n; i++) {
        corner_of(b, at, i, next);
        double g = last[2], h = next[2];
        if ((g > 0) != (h > 0) && found < 2) {
            for (int k = 0; k < 2; k++)
                end[found][k] = last[k] + g / (g - h) * (next[k] - last[k]);
            found++;
        }
        memcpy(last, next, sizeof last);
    }
    return found < 2 ? 0 : add_edge(b, end[0], end[1], ANYWHERE);
}

/* front[]: which end is in front of each face, 0 where its plane does not part them. Returns -1
 * when there are too many. */
static int add_edges(struct sight_between *b, const struct exchange_tree *t,
                     const struct shaft *shaft, const signed char *front, int at)
{
    uint32_t index = b->list[at];
    const struct element *e = &t->h.elements[index];
    for (int i = 0; i < e->vertices; i++) {
        int next = i + 1 < e->vertices ? i + 1 : 0, mate = -1, turned = 0;
        int64_t across = t->mates.of[index][i];
        double p[3], q[3], planes[2][4];
        if (across != NO_MATE) {
            turned = (int)(across % 2);
            mate = place_of(b, (uint32_t)(across / 2));
        }
        if (mate >= 0
            && (mate < at || (front[at] && front[mate] == (turned ? -front[at] : front[at]))))
            continue;
        if (!hidden_edge(shaft, e->vertex[i], e->vertex[next]))
            continue;
        corner_of(b, at, i, p);
        corner_of(b, at, next, q);
        if (mate >= 0) {
            plane_of(b, at, planes[0]);
            plane_of(b, mate, planes[1]);
            for (int k = 0; k < 4 && turned; k++)
                planes[1][k] = -planes[1][k];
        }
        if (add_edge(b, p, q, mate >= 0 ? (const double(*)[4])planes : ANYWHERE) < 0)
            return -1;
    }
    return 0;
}

/* Boxes around the faces of a block, which stand in the list as in the tree: neighbours are near
 * each other. Larger by more than rounding. */
static void make_boxes(struct sight_between *b, double more)
{
    for (int at = 0; at < b->faces; at += SIGHT_BOXED) {
        struct sight_faces *block = &b->block[at / SIGHT_BOXED];
        const int count = b->faces - at < SIGHT_BOXED ? b->faces - at : SIGHT_BOXED;
        for (int k = 0; k < 3; k++) {
            double low = block->v[0][k][0], high = low;
            for (int c = 0; c < SIGHT_CORNERS; c++)
                for (int i = 0; i < count; i++) {
                    const double x = block->v[c][k][i];
                    low = x < low ? x : low;
                    high = x > high ? x : high;
                }
            block->low[k] = low - more;
            block->high[k] = high + more;
        }
    }
}

static int blocks_of(const struct sight_between *b)
{
    return (b->faces + SIGHT_BOXED - 1) / SIGHT_BOXED;
}

/* One ray between the ends, which speaks for all where no edge is an outline. */
static int stops_middle(const struct sight_between *b, const struct shaft *shaft,
                        const struct outline_frame *f)
{
    struct sight_ray ray;
    double middle[2][3] = {{0}};
    for (int end = 0; end < 2; end++)
        for (int i = 0; i < shaft->points[end]; i++)
            for (int k = 0; k < 3; k++)
                middle[end][k] += shaft->end[end][i][k] / shaft->points[end];
    in_plane(f, middle[0], ray.from);
    in_plane(f, middle[1], ray.to);
    sight_ray_aim(&ray);
    return sight_faces_stop(b->block, blocks_of(b), &ray);
}

enum between sight_between_open(struct sight_between *b, const struct exchange_tree *t,
                                const struct shaft *shaft, const struct sight *sight,
                                const uint32_t *list, int count, int near)
{
    signed char front[SIGHT_LIST];
    int parted = 1;
    b->faces = b->edges = b->bent = 0;
    for (int i = 0; i < count; i++) {
        const struct element *e = &t->h.elements[list[i]];
        if (!near && shaft_far(shaft, (const double(*)[3])e->vertex, e->vertices))
            continue;
        front[b->faces] = (signed char)hidden_front(shaft, e);
        if (!front[b->faces] && !candidates_meets(&t->h, shaft, t->host.ray_offset, list[i]))
            continue;
        parted &= front[b->faces] != 0;
        b->bent |= hidden_bent(e, shaft->flat); /* edges and planes tell two outlines */
        make_face(b, b->faces, e, &sight->raised);
        b->list[b->faces++] = list[i];
    }
    make_places(b);
    for (int i = 0; i < b->faces; i++)
        if (add_edges(b, t, shaft, front, i) < 0
            || add_foot(b, i, t->h.elements[b->list[i]].vertices) < 0)
            return BETWEEN_MANY;
    if (b->faces > SIGHT_CUT && (b->bent || b->edges > 2 * b->faces))
        return BETWEEN_MANY;
    make_boxes(b, shaft->flat);
    if (!parted || b->edges > 0)
        return BETWEEN_SOME;
    return b->faces && stops_middle(b, shaft, &sight->raised) ? BETWEEN_ALL : BETWEEN_NOTHING;
}

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
    for (int i = 0; i < cell->n; i++)
        for (int k = 0; k < 2; k++)
            ray.to[k] += cell->p[i][k] / cell->n;
    sight_ray_aim(&ray);
    return sight_faces_stop(c->between->block, blocks_of(c->between), &ray);
}

/* Does the edge run through a convex cell, whose corners have the heights h over its line? By where
 * the line enters and leaves: cells may have sides without a direction. */
static int runs_through(const struct cut_line *line, const struct outline_cell *cell,
                        const double *h)
{
    double first = INFINITY, last = -INFINITY, square = line->a * line->a + line->b * line->b;
    for (int i = 0, j = cell->n - 1; i < cell->n; j = i++) {
        if ((h[i] > 0) == (h[j] > 0))
            continue;
        double t = h[j] / (h[j] - h[i]), along = 0;
        for (int k = 0; k < 2; k++) {
            double p = cell->p[j][k] + t * (cell->p[i][k] - cell->p[j][k]);
            along += (p - line->end[0][k]) * (k ? line->a : -line->b);
        }
        first = along < first ? along : first;
        last = along > last ? along : last;
    }
    return first < square && last > 0;
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
        if (over_it && under_it && runs_through(line, cell, h))
            break;
    }
    if (k == c->lines) {
        if (!is_hidden(c, cell))
            sight_eye_add(c->eye, cell);
        return;
    }
    above.n = polygon_divide(&cell->p[0][0], cell->n, 2, h, OUTLINE_CELL, &above.p[0][0],
                             &below.p[0][0], &below.n);
    add_seen(c, k + 1, &above);
    add_seen(c, k + 1, &below);
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
    in_plane(&sight->raised, from, c.from);
    *whole = 0;
    if (!(eye.height > 0) || !(c.from[2] > 0))
        return 0;
    c.eye = &eye;
    c.between = between;
    cast_edges(&c, &sight->cell);
    add_seen(&c, 0, &sight->cell);
    return sight_eye_factor(&eye, whole);
}
