/* exchange_halves.c - the exchange areas of a block of pairs past many faces.
 *
 * What stands between the two groups is found once; then the block is halved, the side of more
 * faces first. What may stand between two halves is of the whole's list, since shafts nest. Where
 * nothing does, or all is hidden, which the shaft tells as it does of two faces
 * (visibility/hidden.h), all pairs of the halves are known at once; a pair that is left is
 * integrated (exchange_sight.h). Half a group is the rectangle around its faces, along the group's
 * first side, and need not lie in the group's own outline: so the ray that speaks for all is one
 * between two of the faces, which lies in every shaft.
 * Invariant: as pair by pair, within the tolerance; hidden pairs exchange nothing.
 * SPDX-License-Identifier: MIT */
#include <string.h>
#include "engine/exchange_halves.h"
#include "engine/sight_between.h"
#include "engine/sight_lists.h"
#include "kernel/outline.h"
#include "kernel/shaft.h"
#include "visibility/candidates.h"
#include "visibility/hidden.h"

/* A block at work. */
struct halving {
    const struct exchange_faces *faces;
    const struct exchange_pair *whole;
    struct horizon *horizon;
    struct sight_scratch *scratch;
    double *out;
    double most; /* error, of the smaller area */
};

/* Some faces of an element, which is given when it is no group. */
struct half {
    const struct element *of;
    struct face_range range;
};

static uint32_t count_of(const struct half *h)
{
    return h->range.to - h->range.from;
}

/* The face, or the rectangle around the faces. */
static void make_element(struct element *out, const struct exchange_tree *t, const struct half *h)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY}, half[2];
    struct outline_frame frame;
    *out = h->of->group && count_of(h) == 1 ? *exchange_tree_face(t, h->range.from) : *h->of;
    if (!out->group)
        return;
    outline_frame_of(&frame, h->of, 0);
    for (uint32_t i = h->range.from; i < h->range.to; i++) {
        const struct element *e = exchange_tree_face(t, i);
        for (int v = 0; v < e->vertices; v++) {
            double at[2];
            outline_in(&frame, e->vertex[v], at);
            for (int k = 0; k < 2; k++) {
                low[k] = fmin(low[k], at[k]);
                high[k] = fmax(high[k], at[k]);
            }
        }
    }
    out->vertices = 4;
    for (int v = 0; v < 4; v++) {
        const double at[2] = {v == 1 || v == 2 ? high[0] : low[0], v >= 2 ? high[1] : low[1]};
        outline_out(&frame, at, out->vertex[v]);
    }
    for (int k = 0; k < 2; k++)
        half[k] = 0.5 * (high[k] - low[k]);
    const double middle[2] = {low[0] + half[0], low[1] + half[1]};
    outline_out(&frame, middle, out->centre);
    out->area = 4 * half[0] * half[1];
    out->radius = sqrt(half[0] * half[0] + half[1] * half[1]);
}

/* Where a ray between two of the faces ends on one of them. Returns 0 when that is not in front of
 * the other side's plane. */
static int ray_end(const struct exchange_tree *t, const struct half *h, const struct element *other,
                   double end[3])
{
    const struct element *e = h->of->group ? exchange_tree_face(t, h->range.from) : h->of;
    for (int k = 0; k < 3; k++)
        end[k] = e->centre[k] + t->host.ray_offset * e->normal[k];
    return height3(e->centre, other->centre, other->normal) > t->host.ray_offset;
}

static void add_face(struct hidden *hidden, const struct exchange_tree *t, uint32_t face)
{
    if (hidden_front(hidden->shaft, &t->h.elements[face])
        || candidates_meets(&t->h, hidden->shaft, t->host.ray_offset, face))
        hidden_add(hidden, face);
}

/* What stands between the faces of two halves, if one answer is proved for all of them. *opens: a
 * face that is asked first, since it has an outline in the whole's shaft; else, what does in this
 * one. */
static enum between prove(const struct exchange_tree *t, const struct shaft *shaft,
                          const struct half *r, const struct half *s, const struct sight_list *list,
                          uint32_t *opens)
{
    struct hidden hidden;
    if (list->count == 0)
        return BETWEEN_NOTHING;
    hidden_start(&hidden, &t->h, &t->mates, shaft);
    if (!ray_end(t, r, s->of, hidden.ray[0]) || !ray_end(t, s, r->of, hidden.ray[1]))
        return BETWEEN_SOME;
    if (*opens != UINT32_MAX)
        add_face(&hidden, t, *opens);
    for (int i = 0; i < list->count && !hidden.open; i++)
        if (list->face[i] != *opens) {
            add_face(&hidden, t, list->face[i]);
            if (hidden.open)
                *opens = list->face[i];
        }
    return hidden.open ? BETWEEN_SOME : hidden.met ? BETWEEN_ALL : BETWEEN_NOTHING;
}

static double *place_of(const struct halving *h, uint32_t row, uint32_t column)
{
    const struct face_range *rows = &h->whole->rows, *columns = &h->whole->columns;
    return h->out + (size_t)(row - rows->from) * (columns->to - columns->from)
           + (column - columns->from);
}

/* All pairs of two halves between which nothing, or all, is hidden. */
static void put_known(const struct halving *h, const struct half *r, const struct half *s,
                      enum between stands)
{
    const struct exchange_pair pair = {h->whole->tree, h->whole->receiver, h->whole->emitter,
                                       r->range, s->range};
    const double tolerance = h->scratch->limits.tolerance;
    for (uint32_t i = r->range.from; i < r->range.to; i++) {
        double *line = place_of(h, i, s->range.from);
        if (stands == BETWEEN_NOTHING)
            clear_line(h->faces, &pair, tolerance, i, 0, line);
        else
            memset(line, 0, count_of(s) * sizeof *line);
    }
}

/* All pairs of two halves, if they are few, and one convex solid stands between. */
static int is_past_solid(struct halving *h, const struct half *r, const struct half *s,
                         const struct element *from, const struct element *to,
                         const struct shaft *shaft, const struct sight_list *list)
{
    const struct exchange_pair pair = {h->whole->tree, h->whole->receiver, h->whole->emitter,
                                       r->range, s->range};
    const struct face_range *columns = &h->whole->columns;
    return horizon_block(h->faces, &pair, from, to, shaft, list, h->horizon, h->scratch,
                         place_of(h, r->range.from, s->range.from), columns->to - columns->from,
                         &h->most);
}

/* The halves' pairs; what may stand between is of `among`, or, where this is NULL, anything. */
static void fill_halves(struct halving *h, const struct half *r, const struct half *s,
                        const struct sight_list *among, uint32_t opens)
{
    const struct exchange_tree *t = h->whole->tree;
    const int parts = h->whole->receiver->depth || h->whole->emitter->depth;
    struct element from, to;
    struct sight_list own;
    struct shaft shaft;
    make_element(&from, t, r);
    make_element(&to, t, s);
    if (count_of(r) == 1 && count_of(s) == 1) {
        double error;
        *place_of(h, r->range.from, s->range.from) =
            sight_pair(&from, &to, t, among, h->scratch, 0, &error);
        h->most = fmax(h->most, error / fmin(from.area, to.area));
        return;
    }
    if (shaft_open(&shaft, &from, &to, &t->host)) { /* else faces that lie a little off may */
        if (among)
            own.count = sight_list_near(among, t, &shaft, own.face);
        else
            sight_list_find(&own, t, &shaft);
        if (own.count <= SIGHT_LIST) {
            const enum between stands = parts ? BETWEEN_SOME : prove(t, &shaft, r, s, &own, &opens);
            if (stands != BETWEEN_SOME) {
                put_known(h, r, s, stands);
                return;
            }
            if (!parts && is_past_solid(h, r, s, &from, &to, &shaft, &own))
                return;
            among = &own;
        }
    }
    const int rows = count_of(r) >= count_of(s);
    struct half first = rows ? *r : *s, second = first;
    first.range.to = second.range.from = first.range.from + count_of(&first) / 2;
    fill_halves(h, rows ? &first : r, rows ? s : &first, among, opens);
    fill_halves(h, rows ? &second : r, rows ? s : &second, among, opens);
}

double halves_block(const struct exchange_faces *faces, const struct exchange_pair *pair,
                    struct horizon *horizon, struct sight_scratch *scratch, double *out)
{
    struct halving h = {faces, pair, horizon, scratch, out, 0};
    const struct half r = {pair->receiver, pair->rows}, s = {pair->emitter, pair->columns};
    fill_halves(&h, &r, &s, NULL, UINT32_MAX);
    return h.most;
}
