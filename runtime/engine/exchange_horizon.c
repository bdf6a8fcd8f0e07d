/* exchange_horizon.c - the exchange areas of a block of pairs past one convex solid.
 *
 * What a convex solid hides of a plane from a point is convex, however many faces it has: it lies
 * on one side of the line of each edge of its outline, its horizon. So edges are looked for once
 * for the block, and once for each point those that are outlines from there and run through the
 * rectangle around all faces looked at; of each of these the sides of these lines leave what is
 * hidden. No other edge matters: from a point of the rectangle that is hidden to one that is not,
 * the way leads across the outline within the rectangle, out of the half plane of the edge there.
 * Where none runs through it, all of it is seen or hidden as one, and a ray says which. A pair is
 * believed where its face's points tell enough, as a piece is (sight_cubature.c); it is integrated
 * by itself where they do not, and where rounding decides: of points nearly in the plane of a face
 * at the outline, or in line with an edge of it.
 * Invariant: as pair by pair, within the tolerance.
 * [half planes of a convex set; the rest derived here]
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "engine/exchange_horizon.h"
#include "engine/sight_shadows.h"
#include "kernel/plane_side.h"
#include "util/array.h"
#include "visibility/hidden.h"

/* The most lines through a rectangle, and corners of what they leave of a face. */
enum { HORIZON_LINES = 64, POINTS = 2 * FACE_RULE };
_Static_assert(HORIZON_LINES + 4 <= OUTLINE_CELL, "each line adds one corner at most");

/* Points so near to a plane, of how far what they see is, may be on either side of it; edges that
 * look so short, of that, have no direction. Chosen: rounding is a thousandth of it. */
static const double NEARLY = 1e-9, SHORT = 1e-8;

/* a u + b v <= c on the solid's side. */
struct horizon_line {
    double a, b, c;
};

/* What a point sees of the rectangle: past lines; when there is none, all of it or nothing. */
struct horizon_view {
    double x[3];
    int lines, hidden;
    struct horizon_line line[HORIZON_LINES];
};

struct horizon_cell {
    const struct element *face;
    int n;
    double p[4][2];
};

struct horizon {
    int edges, own, cells;
    struct sight_edge_block edge[SIGHT_EDGES / SIGHT_LINES];
    struct sight_edge_block of_face[SIGHT_EDGES / SIGHT_LINES]; /* own: from the face at hand */
    struct horizon_cell cell[HORIZON_SIDE];
    struct horizon_view view[POINTS];
};

/* A block at work. */
struct looking_past {
    struct horizon *horizon;
    const struct exchange_tree *tree;
    const struct sight_list *list;
    const struct element *to;
    struct sight sight; /* of all of `to` */
};

/* ---- edges, once for all points */

/* Are all faces of the list of one convex solid? */
static int is_one(const struct exchange_tree *t, const struct sight_list *list)
{
    for (int i = 1; i < list->count; i++)
        if (t->solids.of[list->face[i]] != t->solids.of[list->face[0]])
            return 0;
    return list->count > 0 && t->solids.of[list->face[0]] != 0;
}

static void plane_of(const struct element *e, const struct outline_frame *f, double plane[4])
{
    double p[3];
    sight_in_plane(f, e->vertex[0], p);
    plane[0] = dot3(e->normal, f->u);
    plane[1] = dot3(e->normal, f->v);
    plane[2] = dot3(e->normal, f->n);
    plane[3] = dot3(plane, p);
}

/* An edge from p to q, the face of the first plane on its left. Returns -1 when there are too many.
 */
static int add_edge(struct horizon *z, const double p[3], const double q[3], const double left[4],
                    const double right[4])
{
    if (z->edges == SIGHT_EDGES)
        return -1;
    sight_edge_put(z->edge, z->edges++, p, q, left, right);
    return 0;
}

/* Where a face crosses the plane the solid ends for the point, as if it had a face there that looks
 * down. */
static int add_foot(struct horizon *z, const double (*corner)[3], int n, const double plane[4])
{
    static const double down[4] = {0, 0, 0, INFINITY};
    double foot[2][3] = {{0}};
    int ends = 0;
    for (int i = 0; i < n; i++) {
        const double *p = corner[i], *q = corner[i + 1 < n ? i + 1 : 0];
        if ((p[2] > 0) == (q[2] > 0))
            continue;
        for (int k = 0; k < 2; k++)
            foot[q[2] > 0][k] = p[k] + p[2] / (p[2] - q[2]) * (q[k] - p[k]);
        ends |= q[2] > 0 ? 2 : 1;
    }
    return ends == 3 ? add_edge(z, foot[0], foot[1], plane, down) : 0;
}

/* The edges of a face that may be outlines in the shaft. One that a face of the list has on either
 * side is the first's. */
static int add_face(struct looking_past *l, const struct shaft *shaft, uint32_t index)
{
    const struct exchange_tree *t = l->tree;
    const struct element *e = &t->h.elements[index];
    const struct outline_frame *f = &l->sight.raised;
    const int front = hidden_front(shaft, e);
    double corner[4][3], plane[4], across[4];
    plane_of(e, f, plane);
    for (int i = 0; i < e->vertices; i++)
        sight_in_plane(f, e->vertex[i], corner[i]);
    for (int i = 0; i < e->vertices; i++) {
        const int next = i + 1 < e->vertices ? i + 1 : 0;
        const uint32_t mate = (uint32_t)(t->mates.of[index][i] / 2);
        if (mate < index
            && bsearch(&mate, l->list->face, (size_t)l->list->count, sizeof mate, compare_words))
            continue;
        if ((front && hidden_front(shaft, &t->h.elements[mate]) == front)
            || !hidden_edge(shaft, e->vertex[i], e->vertex[next]))
            continue;
        plane_of(&t->h.elements[mate], f, across);
        if (add_edge(l->horizon, corner[i], corner[next], plane, across) < 0)
            return -1;
    }
    return add_foot(l->horizon, (const double(*)[3])corner, e->vertices, plane);
}

/* ---- those that a face may see as outlines */

/* A lane of a block goes to the end of the face's own. */
static void keep_edge(struct horizon *z, const struct sight_edge_block *from, int k)
{
    double end[2][3], plane[2][4];
    for (int side = 0; side < 2; side++) {
        for (int i = 0; i < 3; i++)
            end[side][i] = from->end[side][i][k];
        for (int i = 0; i < 4; i++)
            plane[side][i] = from->plane[side][i][k];
    }
    sight_edge_put(z->of_face, z->own++, end[0], end[1], plane[0], plane[1]);
}

/* The edges that are outlines from some point of a face: its points are seen from the same side as
 * its corners, where these agree. */
static void keep_edges(const struct looking_past *l, const struct element *e)
{
    struct horizon *z = l->horizon;
    double corner[4][3];
    for (int i = 0; i < e->vertices; i++) {
        double x[3];
        for (int k = 0; k < 3; k++)
            x[k] = e->vertex[i][k] + l->tree->lift * e->normal[k];
        sight_in_plane(&l->sight.raised, x, corner[i]);
    }
    z->own = 0;
    for (int at = 0; at < z->edges; at += SIGHT_LINES) {
        const struct sight_edge_block *block = &z->edge[at / SIGHT_LINES];
        int64_t turns[SIGHT_LINES];
        sight_edges_turn(block, (const double(*)[3])corner, e->vertices, turns);
        for (int k = 0; k < SIGHT_LINES; k++)
            if (turns[k])
                keep_edge(z, block, k);
    }
}

/* ---- what a point sees of the rectangle */

/* Does the ray from a point to the rectangle's middle meet the solid? */
static int is_hidden(const struct looking_past *l, const double x[3])
{
    double to[3], along[3];
    for (int k = 0; k < 3; k++)
        to[k] = l->to->centre[k] + l->tree->lift * l->to->normal[k];
    sub3(along, to, x);
    for (int i = 0; i < l->list->count; i++) {
        const struct element *e = &l->tree->h.elements[l->list->face[i]];
        if ((height3(x, e->vertex[0], e->normal) > 0) != (height3(to, e->vertex[0], e->normal) > 0)
            && hidden_through(x, along, (const double(*)[3])e->vertex, e->vertices))
            return 1;
    }
    return 0;
}

/* One edge of the outline as its shadow. Returns 0 when rounding may turn it. */
static int add_line(struct horizon_view *view, const struct sight_edge_block *e, int k,
                    const double from[3], const struct sight_shadows *s)
{
    const double over[2] = {sight_over(e->plane[0], k, from[0], from[1], from[2]),
                            sight_over(e->plane[1], k, from[0], from[1], from[2])},
                 sign = over[0] > 0 ? 1 : -1, a = s->a[k], b = s->b[k];
    double far = from[2] * from[2];
    for (int end = 0; end < 2; end++)
        for (int i = 0; i < 2; i++) {
            const double along = s->end[end][i][k] - from[i];
            far += along * along;
        }
    if (view->lines == HORIZON_LINES || !(a * a + b * b > SHORT * SHORT * far)
        || !(fmin(fabs(over[0]), fabs(over[1])) > NEARLY * sqrt(far)))
        return 0;
    view->line[view->lines++] = (struct horizon_line){sign * a, sign * b, sign * s->c[k]};
    return 1;
}

/* Returns 0 when the point is not told. */
static int view_from(const struct looking_past *l, const double n[3], struct horizon_view *view)
{
    const struct outline_cell *cell = &l->sight.cell;
    const struct horizon *z = l->horizon;
    double x[3], from[3], h[POLYGON_MAX];
    for (int k = 0; k < 3; k++)
        x[k] = view->x[k] + l->tree->lift * n[k];
    sight_in_plane(&l->sight.raised, x, from);
    view->lines = view->hidden = 0;
    if (!(from[2] > 0))
        return 0;
    for (int at = 0; at < z->own; at += SIGHT_LINES) {
        const struct sight_edge_block *e = &z->of_face[at / SIGHT_LINES];
        struct sight_shadows s;
        sight_shadows_cast(e, from, cell, &s);
        for (int k = 0; k < SIGHT_LINES; k++) {
            const double end[2] = {s.end[0][0][k], s.end[0][1][k]};
            if (!s.crosses[k])
                continue;
            for (int i = 0; i < cell->n; i++)
                h[i] = s.a[k] * cell->p[i][0] + s.b[k] * cell->p[i][1] - s.c[k];
            if (sight_runs_through(end, s.a[k], s.b[k], cell, h) && !add_line(view, e, k, from, &s))
                return 0;
        }
    }
    view->hidden = view->lines == 0 && is_hidden(l, x);
    return 1;
}

/* ---- what it sees of a face */

enum seen { SEEN_NOTHING, SEEN_PART, SEEN_ALL };

/* What the lines leave of a cell is hidden. */
static enum seen see(const struct horizon_view *view, const struct horizon_cell *c,
                     struct outline_cell *hidden)
{
    uint8_t crossing[HORIZON_LINES];
    struct outline_cell other, *now = hidden, *next = &other;
    double h[OUTLINE_CELL];
    int count = 0;
    if (view->lines == 0)
        return view->hidden ? SEEN_NOTHING : SEEN_ALL;
    for (int i = 0; i < view->lines; i++) {
        const struct horizon_line *line = &view->line[i];
        int over = 0;
        for (int v = 0; v < c->n; v++)
            over += line->a * c->p[v][0] + line->b * c->p[v][1] > line->c;
        if (over == c->n)
            return SEEN_ALL;
        crossing[count] = (uint8_t)i;
        count += over > 0;
    }
    if (count == 0)
        return SEEN_NOTHING;
    now->n = c->n;
    memcpy(now->p, c->p, sizeof c->p);
    for (int i = 0; i < count; i++) {
        const struct horizon_line *line = &view->line[crossing[i]];
        int over = 0;
        for (int v = 0; v < now->n; v++) {
            h[v] = line->a * now->p[v][0] + line->b * now->p[v][1] - line->c;
            over += h[v] > 0;
        }
        if (over == 0)
            continue;
        if (over == now->n)
            return SEEN_ALL;
        (void)polygon_divide(&now->p[0][0], now->n, 2, h, OUTLINE_CELL, NULL, &next->p[0][0],
                             &next->n);
        struct outline_cell *swap = now;
        now = next;
        next = swap;
        if (now->n < 3)
            return SEEN_ALL;
    }
    if (now != hidden) {
        hidden->n = now->n;
        memcpy(hidden->p, now->p, (size_t)now->n * sizeof *now->p);
    }
    return SEEN_PART;
}

/* The form factors from a point to what it sees of a cell, and to all of it. */
static double factors(const struct looking_past *l, const struct horizon_view *view,
                      const double n[3], const struct horizon_cell *c, double *whole)
{
    struct outline_cell hidden;
    struct sight_eye eye;
    struct sight sight;
    const enum seen seen = see(view, c, &hidden);
    sight.frame = l->sight.frame;
    sight.cell.n = c->n;
    memcpy(sight.cell.p, c->p, sizeof c->p);
    sight_eye_open(&eye, &sight, view->x, n);
    if (seen == SEEN_PART)
        sight_eye_add(&eye, &hidden);
    const double less = sight_eye_factor(&eye, whole);
    return seen == SEEN_NOTHING ? 0 : seen == SEEN_ALL ? *whole : fmax(*whole - less, 0);
}

/* Do all points see all of a cell, or nothing? Else SEEN_PART. */
static enum seen see_alike(const struct horizon *z, int points, const struct horizon_cell *c)
{
    struct outline_cell hidden;
    const enum seen first = see(&z->view[0], c, &hidden);
    for (int i = 1; i < points && first != SEEN_PART; i++)
        if (see(&z->view[i], c, &hidden) != first)
            return SEEN_PART;
    return first;
}

/* The points of a face, normal n: those inside, then those on its rim. */
struct two_rules {
    const struct element *face;
    struct face_rule inside, rim;
};

/* What a face, by its points, exchanges with a cell, of *value with nothing between (m2). Returns
 * the error estimated, as of a piece (sight_cubature.c). */
static double measure(const struct looking_past *l, const struct two_rules *rules,
                      const struct face_fit *fit, const struct horizon_cell *c, double *value)
{
    const int inside = rules->inside.count, points = inside + rules->rim.count;
    const double clear = *value;
    double seen[POINTS], whole[POINTS], sum[2][2] = {{0}};
    const enum seen alike = see_alike(l->horizon, points, c);
    if (alike != SEEN_PART) {
        *value = alike == SEEN_ALL ? clear : 0;
        return 0;
    }
    for (int i = 0; i < points; i++) {
        const struct face_rule *rule = i < inside ? &rules->inside : &rules->rim;
        const double weight = rule->weight[i < inside ? i : i - inside];
        seen[i] = factors(l, &l->horizon->view[i], rules->face->normal, c, &whole[i]);
        sum[i >= inside][0] += weight * seen[i];
        sum[i >= inside][1] += weight * whole[i];
    }
    const double share = sum[0][0] > 0 ? fmin(sum[0][0] / sum[0][1], 1) : 0,
                 of_rim = sum[1][0] > 0 ? fmin(sum[1][0] / sum[1][1], 1) : 0;
    *value = clear * share;
    return SIGHT_REST
           * fmax(sight_rest(fit, seen, whole, share, clear), clear * fabs(share - of_rim));
}

/* The row of a face: values[column * step]. */
static void fill_row(struct looking_past *l, const struct element *e, struct sight_scratch *scratch,
                     double *values, size_t step, double *most)
{
    struct horizon *z = l->horizon;
    const struct sight_limits *limits = &scratch->limits;
    struct two_rules rules = {.face = e};
    int told = 1;
    face_rule_of(&rules.inside, e, 0);
    face_rule_of(&rules.rim, e, 1);
    keep_edges(l, e);
    const int inside = rules.inside.count, points = inside + rules.rim.count;
    for (int i = 0; i < points && told; i++) {
        const struct face_rule *rule = i < inside ? &rules.inside : &rules.rim;
        for (int k = 0; k < 3; k++)
            z->view[i].x[k] = rule->x[k][i < inside ? i : i - inside];
        told = view_from(l, e->normal, &z->view[i]);
    }
    for (int c = 0; c < z->cells; c++) {
        const struct element *face = z->cell[c].face;
        const double least = fmin(e->area, face->area);
        double *value = &values[(size_t)c * step], all = *value, error = INFINITY;
        if (told)
            error = measure(l, &rules, &scratch->fit[e->vertices - 3], &z->cell[c], value);
        if (!(error <= SIGHT_BELIEVED * limits->tolerance * fmax(*value, limits->floor * least)))
            *value = fmin(sight_pair(e, face, l->tree, l->list, scratch, 0, &error), all);
        *most = fmax(*most, error / least);
    }
}

/* ---- blocks */

/* How large a face of so many looks from the nearest of the list: seen from another point of it,
 * shadows move by so much. */
static double sway(const struct element *e, uint32_t count, const struct exchange_tree *t,
                   const struct sight_list *list)
{
    const double size = sqrt(e->area / count);
    double least = INFINITY;
    for (int i = 0; i < list->count; i++) {
        const struct element *face = &t->h.elements[list->face[i]];
        least = fmin(least, polygon_distance(e->centre, (const double(*)[3])face->vertex,
                                             face->vertices, face->normal));
    }
    return size / (least + size);
}

/* The edges, and the faces looked at. Returns 0 when there are too many. */
static int place(struct looking_past *l, const struct shaft *shaft, struct face_range onto)
{
    struct horizon *z = l->horizon;
    struct polygon all = {.n = l->to->vertices};
    memcpy(all.v, l->to->vertex, sizeof l->to->vertex);
    sight_open(&l->sight, l->to, &all, l->tree->lift);
    z->edges = z->cells = 0;
    for (int i = 0; i < l->list->count; i++)
        if (add_face(l, shaft, l->list->face[i]) < 0)
            return 0;
    for (uint32_t j = onto.from; j < onto.to; j++) {
        struct horizon_cell *c = &z->cell[z->cells++];
        c->face = exchange_tree_face(l->tree, j);
        c->n = c->face->vertices;
        for (int v = 0; v < c->n; v++)
            outline_in(&l->sight.frame, c->face->vertex[v], c->p[v]);
    }
    return 1;
}

int horizon_block(const struct exchange_faces *faces, const struct exchange_pair *pair,
                  const struct element *r, const struct element *s, const struct shaft *shaft,
                  const struct sight_list *list, struct horizon *horizon,
                  struct sight_scratch *scratch, double *values, size_t across, double *most)
{
    const struct exchange_tree *t = pair->tree;
    const uint32_t rows = pair->rows.to - pair->rows.from,
                   columns = pair->columns.to - pair->columns.from;
    if (!scratch->limits.many || rows > HORIZON_SIDE || columns > HORIZON_SIDE || !is_one(t, list)
        || plane_side_behind(r, s, t->host.flat) || plane_side_behind(s, r, t->host.flat))
        return 0;
    const int swap = sway(s, columns, t, list) < sway(r, rows, t, list);
    const struct face_range from = swap ? pair->columns : pair->rows,
                            onto = swap ? pair->rows : pair->columns;
    struct looking_past l = {.horizon = horizon, .tree = t, .list = list, .to = swap ? r : s};
    if (!place(&l, shaft, onto))
        return 0;
    for (uint32_t i = 0; i < rows; i++)
        clear_line(faces, pair, scratch->limits.tolerance, pair->rows.from + i, 0,
                   values + i * across);
    for (uint32_t i = from.from; i < from.to; i++)
        fill_row(&l, exchange_tree_face(t, i), scratch,
                 values + (i - from.from) * (swap ? 1 : across), swap ? across : 1, most);
    return 1;
}

struct horizon *horizon_open(void)
{
    return malloc(sizeof(struct horizon));
}
