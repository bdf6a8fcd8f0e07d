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

static double over(const double plane[4], const double p[3])
{
    return dot3(plane, p) - plane[3];
}

static void in_plane(const struct outline_frame *f, const double p[3], double out[3])
{
    outline_in(f, p, out);
    out[2] = height3(p, f->origin, f->n);
}

static void make_face(struct sight_face *face, const struct element *e,
                      const struct outline_frame *f)
{
    face->n = e->vertices;
    for (int i = 0; i < face->n; i++)
        in_plane(f, e->vertex[i], face->v[i]);
    face->plane[0] = dot3(e->normal, f->u);
    face->plane[1] = dot3(e->normal, f->v);
    face->plane[2] = dot3(e->normal, f->n);
    face->plane[3] = dot3(face->plane, face->v[0]);
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

/* The line along which a face meets the plane, if it crosses it: its shadow ends there. */
static int add_foot(struct sight_between *b, const struct sight_face *face)
{
    double end[2][3] = {{0}};
    int found = 0;
    for (int i = 0, j = face->n - 1; i < face->n; j = i++) {
        double g = face->v[j][2], h = face->v[i][2];
        if ((g > 0) == (h > 0) || found == 2)
            continue;
        for (int k = 0; k < 2; k++)
            end[found][k] = face->v[j][k] + g / (g - h) * (face->v[i][k] - face->v[j][k]);
        found++;
    }
    if (found < 2)
        return 0;
    if (b->edges == SIGHT_EDGES)
        return -1;
    struct sight_edge *edge = &b->edge[b->edges++];
    edge->mates = 0;
    for (int k = 0; k < 2; k++) {
        edge->end[k][0] = end[k][0];
        edge->end[k][1] = end[k][1];
        edge->end[k][2] = 0;
    }
    return 0;
}

/* front[]: which end is in front of each face, 0 where its plane does not part them. Returns -1
 * when there are too many. */
static int add_edges(struct sight_between *b, const struct exchange_tree *t,
                     const struct shaft *shaft, const signed char *front, int at)
{
    uint32_t index = b->list[at];
    const struct element *e = &t->h.elements[index];
    const struct sight_face *face = &b->face[at];
    for (int i = 0; i < e->vertices; i++) {
        int next = i + 1 < e->vertices ? i + 1 : 0, mate = -1, turned = 0;
        int64_t across = t->mates.of[index][i];
        if (across != NO_MATE) {
            turned = (int)(across % 2);
            mate = place_of(b, (uint32_t)(across / 2));
        }
        if (mate >= 0
            && (mate < at || (front[at] && front[mate] == (turned ? -front[at] : front[at]))))
            continue;
        if (!hidden_edge(shaft, e->vertex[i], e->vertex[next]))
            continue;
        if (b->edges == SIGHT_EDGES)
            return -1;
        struct sight_edge *edge = &b->edge[b->edges++];
        edge->mates = mate >= 0;
        for (int k = 0; k < 3; k++) {
            edge->end[0][k] = face->v[i][k];
            edge->end[1][k] = face->v[next][k];
        }
        for (int k = 0; k < 4 && mate >= 0; k++) {
            edge->plane[0][k] = face->plane[k];
            edge->plane[1][k] = turned ? -b->face[mate].plane[k] : b->face[mate].plane[k];
        }
    }
    return 0;
}

/* Boxes around so many faces each, which stand in the list as in the tree: neighbours are near each
 * other. Larger by more than rounding. */
static void make_boxes(struct sight_between *b, double more)
{
    for (int i = 0; i < b->faces; i++) {
        struct sight_box *box = &b->box[i / SIGHT_BOXED];
        const struct sight_face *face = &b->face[i];
        for (int k = 0; k < 3; k++) {
            double low = face->v[0][k], high = low;
            for (int c = 1; c < face->n; c++) {
                low = face->v[c][k] < low ? face->v[c][k] : low;
                high = face->v[c][k] > high ? face->v[c][k] : high;
            }
            low -= more;
            high += more;
            box->low[k] = i % SIGHT_BOXED && box->low[k] < low ? box->low[k] : low;
            box->high[k] = i % SIGHT_BOXED && box->high[k] > high ? box->high[k] : high;
        }
    }
}

enum between sight_between_open(struct sight_between *b, const struct exchange_tree *t,
                                const struct shaft *shaft, const struct sight *sight,
                                const uint32_t *list, int count)
{
    signed char front[SIGHT_LIST];
    int parted = 1;
    b->faces = b->edges = b->bent = 0;
    for (int i = 0; i < count; i++) {
        const struct element *e = &t->h.elements[list[i]];
        if (shaft_far(shaft, (const double(*)[3])e->vertex, e->vertices))
            continue;
        front[b->faces] = (signed char)hidden_front(shaft, e);
        if (!front[b->faces] && !candidates_meets(&t->h, shaft, t->host.ray_offset, list[i]))
            continue;
        parted &= front[b->faces] != 0;
        b->bent |= hidden_bent(e, shaft->flat); /* edges and planes tell two outlines */
        make_face(&b->face[b->faces], e, &sight->raised);
        b->list[b->faces++] = list[i];
    }
    make_places(b);
    for (int i = 0; i < b->faces; i++)
        if (add_edges(b, t, shaft, front, i) < 0 || add_foot(b, &b->face[i]) < 0)
            return BETWEEN_MANY;
    if (b->faces > SIGHT_CUT && (b->bent || b->edges > 2 * b->faces))
        return BETWEEN_MANY;
    make_boxes(b, shaft->flat);
    if (!parted || b->edges > 0)
        return BETWEEN_SOME;
    struct hidden hidden;
    hidden_start(&hidden, &t->h, &t->mates, shaft);
    for (int i = 0; i < b->faces && !hidden.met; i++)
        hidden_add(&hidden, b->list[i]);
    return hidden.met ? BETWEEN_ALL : hidden.open ? BETWEEN_SOME : BETWEEN_NOTHING;
}

/* The edge as seen from the eye, as far as it is between the plane and the eye. Returns 0 when it
 * is no outline, or no shadow of it meets the polygon. */
static int cast_edge(const struct cutting *c, const struct sight_edge *edge,
                     const struct outline_cell *cell, struct cut_line *out)
{
    if (edge->mates && (over(edge->plane[0], c->from) > 0) == (over(edge->plane[1], c->from) > 0))
        return 0;
    double height = c->from[2], most = height * (1 - OUTLINE_BELOW_EYE), at[2] = {0, 1};
    const double *p = edge->end[0], *q = edge->end[1];
    if ((p[2] < 0 && q[2] < 0) || (p[2] > most && q[2] > most))
        return 0;
    for (int end = 0; end < 2; end++) {
        double h = end ? q[2] : p[2], limit = h < 0 ? 0 : most;
        if (h < 0 || h > most)
            at[end] = (limit - p[2]) / (q[2] - p[2]);
    }
    for (int end = 0; end < 2; end++) {
        double h = p[2] + at[end] * (q[2] - p[2]), t = height / (height - h);
        for (int k = 0; k < 2; k++)
            out->end[end][k] = c->from[k] + t * (p[k] + at[end] * (q[k] - p[k]) - c->from[k]);
    }
    out->a = out->end[1][1] - out->end[0][1];
    out->b = out->end[0][0] - out->end[1][0];
    out->c = out->a * out->end[0][0] + out->b * out->end[0][1];
    int below = 0, above = 0;
    for (int i = 0; i < cell->n; i++) {
        double h = out->a * cell->p[i][0] + out->b * cell->p[i][1] - out->c;
        above |= h > 0;
        below |= h < 0;
    }
    return above && below;
}

/* A ray to the middle of a part, in the plane's coordinates. */
struct sight_ray {
    const double *from;
    double to[3], along[3], per[3]; /* per: 1 / along */
};

/* Does a ray pass a box by? Where it runs along a side, that side does not tell. */
static int passes_by(const struct sight_ray *ray, const struct sight_box *box)
{
    double enter = 0, leave = 1;
    for (int k = 0; k < 3; k++) {
        double a = (box->low[k] - ray->from[k]) * ray->per[k],
               b = (box->high[k] - ray->from[k]) * ray->per[k];
        double first = a < b ? a : b, last = a < b ? b : a;
        enter = first > enter ? first : enter;
        leave = last < leave ? last : leave;
    }
    return enter > leave;
}

static int stops(const struct sight_ray *ray, const struct sight_face *f)
{
    return (over(f->plane, ray->from) > 0) != (over(f->plane, ray->to) > 0)
           && hidden_through(ray->from, ray->along, (const double(*)[3])f->v, f->n);
}

/* Does the ray to the middle of a part meet a face? */
static int is_hidden(const struct cutting *c, const struct outline_cell *cell)
{
    const struct sight_between *b = c->between;
    struct sight_ray ray = {.from = c->from};
    for (int i = 0; i < cell->n; i++)
        for (int k = 0; k < 2; k++)
            ray.to[k] += cell->p[i][k] / cell->n;
    sub3(ray.along, ray.to, c->from);
    for (int k = 0; k < 3; k++)
        ray.per[k] = 1 / ray.along[k];
    for (int box = 0; box * SIGHT_BOXED < b->faces; box++) {
        int from = box * SIGHT_BOXED,
            to = from + SIGHT_BOXED < b->faces ? from + SIGHT_BOXED : b->faces;
        if (passes_by(&ray, &b->box[box]))
            continue;
        for (int i = from; i < to; i++)
            if (stops(&ray, &b->face[i]))
                return 1;
    }
    return 0;
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
        first = fmin(first, along);
        last = fmax(last, along);
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
    *whole = sight_eye_whole(&eye, sight);
    c.eye = &eye;
    c.between = between;
    c.lines = 0;
    for (int i = 0; i < between->edges; i++)
        c.lines += cast_edge(&c, &between->edge[i], &sight->cell, &c.line[c.lines]);
    add_seen(&c, 0, &sight->cell);
    return sight_eye_factor(&eye);
}
