/* sight_rims.c - what a point sees of a convex polygon past convex solids, by the rims of their
 * shadows.
 *
 * The union of the shadows is not cut out: what is seen is all of the polygon less that union, and
 * Lambert's sum goes around it, the other way round: along the rims of shadows as far as they lie
 * outside of the others, and along the polygon's sides as far as these are hidden. How far that is,
 * is an interval of an edge for each shadow; one that no other meets is taken away by itself. Each
 * shadow grows more than the one before, by far less than counts: of two edges in one place one is
 * inside of the other's shadow, or both are. Where a shadow is not told (sight_casting.c), or what
 * was gone around is not closed, the point is not told, and its shadows are to be cut out face by
 * face (sight_pieces.c). Invariant: as sight_pieces.c, but for how far shadows grow. [the rim
 * of a union of convex polygons, edge by edge; derived here]
 * SPDX-License-Identifier: MIT */
#include "engine/sight_rims.h"
#include "engine/sight_casting.h"

/* A rim that does not come back to where it began within so much of the polygon's size has lost an
 * edge, or has one too many. */
static const double OPEN = 1e-9;

/* What is wider apart than so much of the polygon's size is apart, whatever shadows grow by. */
static const double APART = 1e-6;

/* The rim of what is hidden, added edge by edge. */
struct rim {
    struct sight_eye eye;
    struct casting cast;
    double box[SIGHT_BODIES][4]; /* around shadows, APART wider: low and high of each coordinate */
    int beside, other[SIGHT_BODIES]; /* shadows whose box meets that of the one at work */
    int meets[SIGHT_BODIES];         /* 1: there is one */
    double open;                     /* what is counted where edges end, less where they begin */
};

static void find_boxes(struct rim *rim)
{
    const double more = APART * rim->cast.own;
    for (int s = 0; s < rim->cast.count; s++) {
        const struct body_shadow *shadow = &rim->cast.shadow[s];
        sight_box((const double(*)[2])shadow->p, shadow->n, rim->box[s]);
        for (int k = 0; k < 2; k++) {
            rim->box[s][k] -= more;
            rim->box[s][2 + k] += more;
        }
    }
}

/* What of an edge lies outside of shadows: intervals of it that do not, in their order. */
struct hidden_parts {
    int count;
    double low[SIGHT_BODIES], high[SIGHT_BODIES];
};

/* Narrows what of an edge is within a shadow, by how far its ends are outside of a line. */
static void narrow(double g, double h, double *low, double *high)
{
    if (g > 0) {
        const double t = h > 0 ? 1 : g / (g - h);
        *low = t > *low ? t : *low;
    } else if (h > 0) {
        const double t = g / (g - h);
        *high = t < *high ? t : *high;
    }
}

static void add_hidden(struct hidden_parts *parts, double low, double high)
{
    int at = parts->count;
    if (!(low < high))
        return;
    for (; at > 0 && parts->low[at - 1] > low; at--) {
        parts->low[at] = parts->low[at - 1];
        parts->high[at] = parts->high[at - 1];
    }
    parts->low[at] = low;
    parts->high[at] = high;
    parts->count++;
}

/* Counts a corner of the rim. What is counted where edges begin and where they end is the same,
 * when they go around, whatever it is. If it were the place alone, two edges that are wrong could
 * make up for each other, being as long; of this, which is curved and along no axis of theirs, only
 * by chance. */
static inline double count_corner(const struct casting *c, const double p[2])
{
    const double u = (p[0] - c->corner[0][0]) * c->per, v = (p[1] - c->corner[1][0]) * c->per;
    return u * (1 + u * (0.61 + v)) + v * (0.43 + v * (0.74 + u));
}

/* Takes away along a part of the edge from p to q. */
static void take_along(struct rim *rim, const double p[2], const double q[2], double from,
                       double to)
{
    double a[2], b[2];
    for (int k = 0; k < 2; k++) {
        a[k] = from > 0 ? p[k] + from * (q[k] - p[k]) : p[k];
        b[k] = to < 1 ? p[k] + to * (q[k] - p[k]) : q[k];
    }
    sight_eye_edge(&rim->eye, b, a);
    rim->open += count_corner(&rim->cast, a) - count_corner(&rim->cast, b);
}

/* Takes away along what others do not hide of a shadow's edge. */
static void take_outside(struct rim *rim, const double p[2], const double q[2],
                         const struct hidden_parts *parts)
{
    double last = 0;
    for (int i = 0; i <= parts->count; i++) {
        const double end = i < parts->count ? parts->low[i] : 1;
        if (end > last)
            take_along(rim, p, q, last, end);
        if (i < parts->count && parts->high[i] > last)
            last = parts->high[i];
    }
}

/* Takes away along what is hidden of a side of the polygon. */
static void take_hidden(struct rim *rim, const double p[2], const double q[2],
                        const struct hidden_parts *parts)
{
    for (int i = 0, next; i < parts->count; i = next) {
        double high = parts->high[i];
        for (next = i + 1; next < parts->count && parts->low[next] <= high; next++)
            high = parts->high[next] > high ? parts->high[next] : high;
        take_along(rim, p, q, parts->low[i], high);
    }
}

/* Where on the edge from p to q a point of it is. */
static double place_on(const double p[2], const double q[2], const double x[2])
{
    const double u = q[0] - p[0], v = q[1] - p[1];
    return ((x[0] - p[0]) * u + (x[1] - p[1]) * v) / (u * u + v * v);
}

/* What shadows that meet others hide of the polygon's own side i. */
static void add_own(struct rim *rim, const struct outline_cell *cell, int i)
{
    const struct casting *c = &rim->cast;
    struct hidden_parts parts;
    const double *p = cell->p[i], *q = cell->p[i + 1 < cell->n ? i + 1 : 0];
    parts.count = 0;
    for (int s = 0; s < c->count; s++) {
        const struct body_shadow *shadow = &c->shadow[s];
        double low = 1, high = 0;
        if (!rim->meets[s])
            continue;
        for (int k = 0; k < shadow->n; k++)
            if (shadow->by[k] == i) {
                const double t0 = place_on(p, q, shadow->p[k]),
                             t1 = place_on(p, q, shadow->p[k + 1 < shadow->n ? k + 1 : 0]);
                low = t0 < low ? t0 : low;
                high = t1 > high ? t1 : high;
            }
        add_hidden(&parts, low, high);
    }
    take_hidden(rim, p, q, &parts);
}

static int boxes_meet(const double a[4], const double b[4])
{
    return (a[0] <= b[2]) & (b[0] <= a[2]) & (a[1] <= b[3]) & (b[1] <= a[3]);
}

/* Only shadows whose box meets its own hide edges of shadow `own`. */
static void find_others(struct rim *rim, int own)
{
    rim->beside = 0;
    for (int s = 0; s < rim->cast.count; s++) {
        rim->other[rim->beside] = s;
        rim->beside += s != own && boxes_meet(rim->box[s], rim->box[own]);
    }
}

/* What is hidden beside an edge from p to q of the shadow at work. */
static void add_edge(struct rim *rim, const double p[2], const double q[2])
{
    const struct casting *c = &rim->cast;
    struct hidden_parts parts;
    const double edge[4] = {p[0] < q[0] ? p[0] : q[0], p[1] < q[1] ? p[1] : q[1],
                            p[0] < q[0] ? q[0] : p[0], p[1] < q[1] ? q[1] : p[1]};
    parts.count = 0; /* no more of it is read */
    for (int i = 0; i < rim->beside; i++) {
        const int s = rim->other[i];
        double low = 0, high = 1;
        if (!boxes_meet(edge, rim->box[s]))
            continue;
        for (int k = c->first[s]; k < c->first[s + 1] && low < high; k++) {
            const struct body_line *other = &c->cut[k];
            narrow(other->a * p[0] + other->b * p[1] - other->c,
                   other->a * q[0] + other->b * q[1] - other->c, &low, &high);
        }
        add_hidden(&parts, low, high);
    }
    take_outside(rim, p, q, &parts);
}

/* Of a shadow that meets no other one the edges on the polygon's sides do for these. */
static void add_shadow(struct rim *rim, int own)
{
    const struct body_shadow *shadow = &rim->cast.shadow[own];
    find_others(rim, own);
    rim->meets[own] = rim->beside > 0;
    for (int i = 0, j = shadow->n - 1; i < shadow->n; j = i++)
        if (!rim->meets[own])
            sight_eye_edge(&rim->eye, shadow->p[i], shadow->p[j]);
        else if (shadow->by[j] >= POLYGON_MAX)
            add_edge(rim, shadow->p[j], shadow->p[i]);
}

/* How far a point is to be above the plane, in steps off its surface: lower down that step decides
 * what is in the way. Chosen: a needle's shadows differed up to 8. */
static const double LOW = 10;

double sight_rims_past(const struct sight *sight, const double x[3], const double n[3], double up,
                       const struct sight_bodies *bodies, double *whole)
{
    const struct outline_cell *cell = &sight->cell;
    struct rim rim;
    const struct casting *c = &rim.cast;
    double from[3], at[3];
    for (int k = 0; k < 3; k++)
        from[k] = x[k] + up * n[k];
    sight_eye_open(&rim.eye, sight, x, n);
    sight_in_plane(&sight->raised, from, at);
    *whole = rim.open = 0;
    if (!(rim.eye.height > 0) || !(at[2] > 0))
        return 0;
    if (at[2] < LOW * up)
        return -1;
    sight_casting_open(&rim.cast, bodies, cell, at, up);
    for (int i = 0; i < bodies->count; i++) {
        const enum rest rest =
            sight_casting_add(&rim.cast, bodies, &bodies->body[i], cell, c->grow * (i + 1));
        if (rest == REST_UNTOLD)
            return -1;
        if (rest == REST_ALL) {
            (void)sight_eye_left(&rim.eye, whole);
            return 0;
        }
    }
    find_boxes(&rim);
    for (int s = 0; s < c->count; s++)
        add_shadow(&rim, s);
    for (int i = 0; i < cell->n; i++)
        add_own(&rim, cell, i);
    const double seen = sight_eye_left(&rim.eye, whole);
    return fabs(rim.open) <= OPEN ? seen : -1;
}
