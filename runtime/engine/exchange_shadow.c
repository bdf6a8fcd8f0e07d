/* exchange_shadow.c - what pairs of faces of two flat groups see of each other past some blockers.
 *
 * Each pair is seen from four points of its one face: from there the blockers cast shadows on the
 * plane of the other group, once for all its faces, and what is left of each face is cut out
 * exactly (kernel/outline.h). The points are on the side where a face's size matters less. The
 * face's corners look, too, and do not count: how far the points may be off is estimated by how far
 * all of them differ; a pair that this is too much for is integrated by itself (exchange_sight.h).
 * Invariant: what lies outside the box around a blocker's shadows from the corners is in none of
 * its shadows from the face, since casting takes what is convex to what is convex; so a face of the
 * group that lies outside of all boxes is clear, and one that one blocker hides from all corners is
 * hidden.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "engine/exchange_shadow.h"
#include "kernel/lambert.h"

/* A face of the group that shadows fall on, in its plane's coordinates. */
struct shadow_cell {
    struct outline_sum whole;
    double middle[2], half[2]; /* its box */
    double p[4][2];
    int n;
};

/* From how many of the points a face was wholly hidden and wholly seen, and what each point sees
 * of it; the least and the most that they or the corners see. */
struct shadow_sight {
    int hidden, clear, proved;                    /* proved: that all of the face sees the same */
    double part[OUTLINE_FEW], at[OUTLINE_FEW][2]; /* of its area (m2); the centroid */
    double low, high;                             /* of its area (m2) */
};

/* The group that shadows fall on. */
struct screen {
    struct outline_frame frame;
    struct shadow_cell *cells; /* [count] */
    uint32_t count;
    double middle[2], half[2]; /* the box of them all */
};

/* The points of a face, and its corners. */
struct points {
    double x[OUTLINE_FEW][3], weight[OUTLINE_FEW];
    double corner[4][3];
    int corners;
};

/* What one blocker hides from the corners. */
struct cast {
    int shadows, boundless;    /* from how many there is one; 1: not all of it is below them */
    double middle[2], half[2]; /* the box around all */
    struct outline shadow[4];
};

int shadow_scratch_open(struct shadow_scratch *scratch)
{
    scratch->cells = malloc(TILE * sizeof *scratch->cells);
    scratch->sights = malloc(TILE * sizeof *scratch->sights);
    return scratch->cells && scratch->sights ? 0 : -1;
}

void shadow_scratch_close(struct shadow_scratch *scratch)
{
    free(scratch->cells);
    free(scratch->sights);
}

static void make_cell(struct shadow_cell *c, const struct element *e,
                      const struct outline_frame *frame)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    struct outline_cell cell;
    cell.n = c->n = e->vertices;
    for (int v = 0; v < c->n; v++) {
        outline_in(frame, e->vertex[v], c->p[v]);
        for (int k = 0; k < 2; k++) {
            cell.p[v][k] = c->p[v][k];
            low[k] = c->p[v][k] < low[k] ? c->p[v][k] : low[k];
            high[k] = c->p[v][k] > high[k] ? c->p[v][k] : high[k];
        }
    }
    memset(&c->whole, 0, sizeof c->whole);
    outline_add(&c->whole, &cell);
    for (int k = 0; k < 2; k++) {
        c->middle[k] = 0.5 * (low[k] + high[k]);
        c->half[k] = 0.5 * (high[k] - low[k]);
    }
}

static void make_screen(struct screen *screen, const struct exchange_tree *t,
                        const struct element *group, struct face_range faces)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    outline_frame_of(&screen->frame, group, t->lift);
    screen->count = faces.to - faces.from;
    for (uint32_t j = 0; j < screen->count; j++) {
        struct shadow_cell *c = &screen->cells[j];
        make_cell(c, exchange_tree_face(t, faces.from + j), &screen->frame);
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], c->middle[k] - c->half[k]);
            high[k] = fmax(high[k], c->middle[k] + c->half[k]);
        }
    }
    for (int k = 0; k < 2; k++) {
        screen->middle[k] = 0.5 * (low[k] + high[k]);
        screen->half[k] = 0.5 * (high[k] - low[k]);
    }
}

/* What is seen of a cell past the shadows, none of which covers all of the screen: area (m2) and
 * centroid. Returns 0: nothing, 1: a part, 2: all of it. */
static int see_cell(const struct outline *shadows, int count, const struct shadow_cell *c,
                    double *part, double at[2])
{
    int touched = 0, side = -1;
    for (int s = 0; s < count && side < 1; s++) {
        side = outline_box(&shadows[s], c->middle, c->half);
        touched |= side == 0;
    }
    *part = side == 1 ? 0 : c->whole.area;
    side = side == 1 ? 0 : touched ? 1 : 2;
    if (side == 1) {
        struct outline_cell cell;
        cell.n = c->n;
        for (int v = 0; v < c->n; v++) {
            cell.p[v][0] = c->p[v][0];
            cell.p[v][1] = c->p[v][1];
        }
        struct outline_sum seen;
        side = outline_seen(shadows, count, &cell, &c->whole, &seen);
        *part = seen.area;
        if (side == 1) {
            at[0] = seen.at[0] / seen.area;
            at[1] = seen.at[1] / seen.area;
            return side;
        }
    }
    at[0] = c->whole.at[0] / c->whole.area;
    at[1] = c->whole.at[1] / c->whole.area;
    return side;
}

/* What one point sees of the screen's cells; k: which of the points that count, or -1. */
static void see_cells(const struct screen *screen, const double x[3], int k,
                      const struct polygon *blockers, int blocker_count,
                      struct shadow_sight *sights)
{
    struct outline shadows[BLOCKERS_MAX];
    double height = height3(x, screen->frame.origin, screen->frame.n);
    int count = 0, covered = 0;
    for (int b = 0; b < blocker_count && !covered; b++)
        if (outline_cast(&shadows[count], &screen->frame, x, height,
                         (const double(*)[3])blockers[b].v, blockers[b].n)) {
            int side = outline_box(&shadows[count], screen->middle, screen->half);
            covered = side == 1;
            count += side == 0;
        }
    for (uint32_t j = 0; j < screen->count; j++) {
        struct shadow_sight *sight = &sights[j];
        double part = 0, at[2] = {0, 0};
        int side = covered ? 0 : see_cell(shadows, count, &screen->cells[j], &part, at);
        sight->low = fmin(sight->low, part);
        sight->high = fmax(sight->high, part);
        if (k < 0)
            continue;
        sight->hidden += side == 0;
        sight->clear += side == 2;
        sight->part[k] = part;
        sight->at[k][0] = at[0];
        sight->at[k][1] = at[1];
    }
}

/* The shadows of a blocker from all corners. A corner below some of it casts that nowhere. */
static void cast_corners(const struct screen *screen, const struct points *points,
                         const struct polygon *blocker, struct cast *cast)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY}, top = -INFINITY;
    cast->shadows = cast->boundless = 0;
    for (int v = 0; v < blocker->n; v++)
        top = fmax(top, height3(blocker->v[v], screen->frame.origin, screen->frame.n));
    for (int c = 0; c < points->corners && top > 0; c++) {
        const double *x = points->corner[c];
        double height = height3(x, screen->frame.origin, screen->frame.n);
        struct outline *shadow = &cast->shadow[cast->shadows];
        cast->boundless |= !(top < height * (1 - OUTLINE_BELOW_EYE));
        if (!outline_cast(shadow, &screen->frame, x, height, (const double(*)[3])blocker->v,
                          blocker->n))
            continue;
        cast->shadows++;
        for (int v = 0; v < shadow->n; v++)
            for (int k = 0; k < 2; k++) {
                low[k] = fmin(low[k], shadow->p[v][k]);
                high[k] = fmax(high[k], shadow->p[v][k]);
            }
    }
    for (int k = 0; k < 2; k++) {
        cast->middle[k] = 0.5 * (low[k] + high[k]);
        cast->half[k] = 0.5 * (high[k] - low[k]);
    }
}

/* Does all of the face see all of each cell, or nothing? */
static void prove(const struct screen *screen, const struct points *points,
                  const struct polygon *blockers, int blocker_count, struct shadow_sight *sights)
{
    for (uint32_t j = 0; j < screen->count; j++)
        sights[j].proved = 1;
    for (int b = 0; b < blocker_count; b++) {
        struct cast cast;
        cast_corners(screen, points, &blockers[b], &cast);
        if (!cast.boundless && cast.shadows == 0)
            continue;
        for (uint32_t j = 0; j < screen->count; j++) {
            const struct shadow_cell *c = &screen->cells[j];
            int apart = !cast.boundless, hidden = cast.shadows == points->corners;
            if (apart)
                apart = fabs(c->middle[0] - cast.middle[0]) > c->half[0] + cast.half[0]
                        || fabs(c->middle[1] - cast.middle[1]) > c->half[1] + cast.half[1];
            for (int s = 0; s < cast.shadows && hidden; s++)
                hidden = outline_box(&cast.shadow[s], c->middle, c->half) == 1;
            if (hidden)
                sights[j].proved = 2;
            else if (!apart && sights[j].proved == 1)
                sights[j].proved = 0;
        }
    }
}

/* What the points see of the screen's cells. */
static void see_screen(const struct screen *screen, const struct points *points,
                       const struct polygon *blockers, int blocker_count,
                       struct shadow_sight *sights)
{
    for (uint32_t j = 0; j < screen->count; j++)
        sights[j] = (struct shadow_sight){.low = INFINITY};
    prove(screen, points, blockers, blocker_count, sights);
    for (int k = 0; k < OUTLINE_FEW; k++)
        see_cells(screen, points->x[k], k, blockers, blocker_count, sights);
    for (int c = 0; c < points->corners; c++)
        see_cells(screen, points->corner[c], -1, blockers, blocker_count, sights);
}

/* The seen share of what the points, normal n, exchange with a cell. */
static double seen_share(const struct shadow_sight *sight, const struct shadow_cell *c,
                         const struct points *points, const double n[3],
                         const struct outline_frame *frame)
{
    double seen = 0, all = 0;
    if (sight->hidden == OUTLINE_FEW)
        return 0;
    if (sight->clear == OUTLINE_FEW)
        return 1;
    for (int k = 0; k < OUTLINE_FEW; k++) {
        const double uv[2] = {c->whole.at[0] / c->whole.area, c->whole.at[1] / c->whole.area};
        double y[3];
        outline_out(frame, uv, y);
        all += points->weight[k] * c->whole.area * lambert_points(points->x[k], n, y, frame->n, 0);
        outline_out(frame, sight->at[k], y);
        seen +=
            points->weight[k] * sight->part[k] * lambert_points(points->x[k], n, y, frame->n, 0);
    }
    return !(seen > 0) ? 0 : seen < all ? seen / all : 1;
}

/* How large a face of the group looks from the nearest blocker: seen from another point of it,
 * shadows move by so much. */
static double seen_from(const struct element *e, struct face_range range,
                        const struct exchange_tree *t, const struct blockers *list)
{
    double least = INFINITY;
    for (int b = 0; b < list->count; b++) {
        const struct element *blocker = &t->h.elements[list->face[b]];
        least = fmin(least, polygon_distance(e->centre, (const double(*)[3])blocker->vertex,
                                             blocker->vertices, blocker->normal));
    }
    return sqrt(e->area / (range.to - range.from)) / (least + e->radius);
}

/* Which share of a pair the points may be wrong by: of how far they and the corners differ, what a
 * line that parts the face may be misjudged by; and a strip as wide as a quarter of the face, which
 * none of them sees, whether they agree of what they do see or not. */
static double doubt_of(const struct shadow_sight *sight, double area)
{
    if (sight->proved)
        return 0;
    return fmax(SHADOW_BETWEEN * (sight->high - sight->low) / area, SHADOW_UNSEEN);
}

double shadow_block(const struct exchange_pair *pair, const struct blockers *list,
                    struct shadow_scratch *scratch, struct sight_scratch *looking, double *values)
{
    const struct exchange_tree *t = pair->tree;
    const struct element *r = pair->receiver, *s = pair->emitter;
    const struct sight_limits *limits = &looking->limits;
    uint32_t across = pair->columns.to - pair->columns.from;
    int swap = seen_from(s, pair->columns, t, list) < seen_from(r, pair->rows, t, list);
    struct face_range from = swap ? pair->columns : pair->rows,
                      onto = swap ? pair->rows : pair->columns;
    size_t step_i = swap ? 1 : across, step_j = swap ? across : 1;
    double most = 0;
    struct screen screen = {.cells = scratch->cells};
    make_screen(&screen, t, swap ? r : s, onto);
    struct polygon blockers[BLOCKERS_MAX];
    struct sight_list among = {.count = list->count};
    for (int b = 0; b < list->count; b++) {
        among.face[b] = list->face[b];
        t->host.corners(&t->host, list->face[b], &blockers[b]);
    }
    for (uint32_t i = from.from; i < from.to; i++) {
        struct points points;
        const struct element *e = exchange_tree_face(t, i);
        outline_points(e, t->lift, OUTLINE_FEW, points.x, points.weight);
        points.corners = e->vertices;
        for (int v = 0; v < e->vertices; v++)
            for (int k = 0; k < 3; k++)
                points.corner[v][k] = e->vertex[v][k] + t->lift * e->normal[k];
        see_screen(&screen, &points, blockers, list->count, scratch->sights);
        for (uint32_t j = 0; j < screen.count; j++) {
            double *value = &values[(i - from.from) * step_i + j * step_j], all = *value,
                   least = fmin(e->area, screen.cells[j].whole.area), error;
            const struct shadow_sight *sight = &scratch->sights[j];
            *value *=
                seen_share(sight, &screen.cells[j], &points, (swap ? s : r)->normal, &screen.frame);
            error = all * doubt_of(sight, screen.cells[j].whole.area);
            if (!sight_enough(limits, error, *value, least))
                *value = fmin(sight_pair(e, exchange_tree_face(t, onto.from + j), t, &among,
                                         looking, 0, &error),
                              all);
            most = fmax(most, error / least);
        }
    }
    return most;
}
