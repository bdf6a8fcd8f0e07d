/* sight_pieces.c - what a point sees of a convex polygon past convex faces, exactly.
 *
 * Shadows are cast on the polygon's plane and what they leave of it is cut out (kernel/outline.h),
 * in convex pieces; Lambert's sum goes over their edges. So of a point nothing is approximate
 * but rounding, and an integral over points has no noise of the other side. A piece takes along the
 * shadows that its box meets: most of what is cut out of it meets few of them. Large shadows come
 * first: what they hide is cut no more.
 * Invariant: with no blocker it is lambert_sum of the whole polygon.
 * [Lambert 1760; Weiler & Atherton 1977 for convex polygons]
 * SPDX-License-Identifier: MIT */
#include <string.h>
#include "engine/sight_pieces.h"
#include "kernel/lambert.h"
#include "kernel/lanes.h"

_Static_assert((int)SIGHT_EYE_EDGES >= (int)OUTLINE_CELL && SIGHT_EYE_EDGES % LANES_MOST == 0,
               "room for any piece");

TOOL void edges_body(struct sight_eye *eye)
{
    struct sight_edges *g = &eye->edges;
    const double z = -eye->height, n0 = eye->normal[0], n1 = eye->normal[1], n2 = eye->normal[2];
    const int count = g->count;
    for (int i = 0; i < count; i += LANES)
        for (int k = i; k < i + LANES; k++)
            g->value[k] =
                lambert_edge(g->a[0][k], g->a[1][k], z, g->b[0][k], g->b[1][k], z, n0, n1, n2);
}

#if LANES_CHOSEN
LANES_AVX512 void edges_8(struct sight_eye *eye)
{
    edges_body(eye);
}
LANES_AVX2 void edges_4(struct sight_eye *eye)
{
    edges_body(eye);
}
#endif

void sight_eye_sum(struct sight_eye *eye)
{
    struct sight_edges *g = &eye->edges;
    for (int k = g->count; k % LANES; k++)
        g->a[0][k] = g->a[1][k] = g->b[0][k] = g->b[1][k] = 0;
    LANES_RUN(lanes_width(), edges_8, edges_4, edges_body, (eye));
    for (int k = 0; k < g->of_whole; k++)
        g->whole += g->value[k];
    for (int k = g->of_whole; k < g->count; k++)
        g->sum += g->value[k];
    g->count = g->of_whole = 0;
}

void sight_open(struct sight *sight, const struct element *e, const struct polygon *part, double up)
{
    outline_frame_of(&sight->frame, e, 0);
    outline_frame_of(&sight->raised, e, up);
    sight->cell.n = part->n;
    for (int i = 0; i < part->n; i++)
        outline_in(&sight->frame, part->v[i], sight->cell.p[i]);
}

void sight_eye_open(struct sight_eye *eye, const struct sight *sight, const double x[3],
                    const double n[3])
{
    const struct outline_frame *f = &sight->frame;
    eye->height = height3(x, f->origin, f->n);
    eye->normal[0] = dot3(n, f->u);
    eye->normal[1] = dot3(n, f->v);
    eye->normal[2] = dot3(n, f->n);
    eye->edges.count = eye->edges.of_whole = 0;
    eye->edges.sum = eye->edges.whole = 0;
    outline_in(f, x, eye->at);
    sight_eye_add(eye, &sight->cell);
    eye->edges.of_whole = eye->edges.count;
}

/* Of Lambert's sum over edges. */
static double factor_of(double sum)
{
    double f = sum * (-0.5 / LAMBERT_PI);
    return f > 0 ? f < 1 ? f : 1 : 0;
}

double sight_eye_factor(struct sight_eye *eye, double *whole)
{
    sight_eye_sum(eye);
    *whole = factor_of(eye->edges.whole);
    return factor_of(eye->edges.sum);
}

/* What is left of all by rounding, as a share: less than shadows grow by, and chosen. */
static const double LEFT = 1e-12;

double sight_eye_left(struct sight_eye *eye, double *whole)
{
    sight_eye_sum(eye);
    *whole = factor_of(eye->edges.whole);
    const double seen = factor_of(eye->edges.whole + eye->edges.sum);
    return seen > LEFT * *whole ? fmin(seen, *whole) : 0;
}

void sight_eye_add(struct sight_eye *eye, const struct outline_cell *cell)
{
    struct sight_edges *g = &eye->edges;
    if (g->count + cell->n > SIGHT_EYE_EDGES)
        sight_eye_sum(eye);
    for (int i = 0, j = cell->n - 1; i < cell->n; j = i++)
        sight_eye_edge(eye, cell->p[j], cell->p[i]);
}

int sight_runs_through(const double from[2], double a, double b, const struct outline_cell *cell,
                       const double *h)
{
    double first = INFINITY, last = -INFINITY, square = a * a + b * b;
    for (int i = 0, j = cell->n - 1; i < cell->n; j = i++) {
        if ((h[i] > 0) == (h[j] > 0))
            continue;
        double t = h[j] / (h[j] - h[i]), along = 0;
        for (int k = 0; k < 2; k++) {
            double p = cell->p[j][k] + t * (cell->p[i][k] - cell->p[j][k]);
            along += (p - from[k]) * (k ? a : -b);
        }
        first = along < first ? along : first;
        last = along > last ? along : last;
    }
    return first < square && last > 0;
}

void sight_halve(const struct outline_cell *cell, struct outline_cell half[2])
{
    const int middle = cell->n / 2;
    half[0].n = half[1].n = 0;
    for (int i = 0; i < cell->n; i++) {
        if (i <= middle)
            memcpy(half[0].p[half[0].n++], cell->p[i], sizeof *cell->p);
        if (i == 0 || i >= middle)
            memcpy(half[1].p[half[1].n++], cell->p[i], sizeof *cell->p);
    }
}

/* Is the middle of a cell outside of a shadow? */
static int is_outside(const struct outline *s, const struct outline_cell *cell)
{
    double at[2] = {0, 0};
    for (int i = 0; i < cell->n; i++)
        for (int k = 0; k < 2; k++)
            at[k] += cell->p[i][k] / cell->n;
    for (int e = 0; e < s->n; e++)
        if (s->a[e] * at[0] + s->b[e] * at[1] > s->c[e])
            return 1;
    return 0;
}

/* Sides of cells may be as short as rounding, in any direction: nothing is for sure beside one. As
 * a sine, and a share of how far the side is; chosen. */
static const double SIDE_SURE = 1e-10;

/* Is all of the shadow for sure beside a side of the cell? What only touches is not. */
static int beside_cell(const struct outline *s, const struct outline_cell *cell)
{
    for (int i = 0, j = cell->n - 1, e; i < cell->n; j = i++) {
        const double u = cell->p[i][0] - cell->p[j][0], v = cell->p[i][1] - cell->p[j][1];
        for (e = 0; e < s->n; e++) {
            const double x = s->p[e][0] - cell->p[j][0], y = s->p[e][1] - cell->p[j][1];
            if (!(u * y - v * x < -SIDE_SURE * (x * x + y * y)))
                break;
        }
        if (e == s->n)
            return 1;
    }
    return 0;
}

int sight_shade_meets(const struct outline *shade, const struct outline_cell *cell)
{
    return !outline_beside(shade, cell) && !beside_cell(shade, cell);
}

/* Does the shadow hide all of the cell? */
static int covers(const struct outline *s, const struct outline_cell *cell)
{
    for (int e = 0; e < s->n; e++)
        for (int i = 0; i < cell->n; i++)
            if (s->a[e] * cell->p[i][0] + s->b[e] * cell->p[i][1] > s->c[e])
                return 0;
    return 1;
}

void sight_box(const double (*p)[2], int n, double box[4])
{
    for (int k = 0; k < 2; k++)
        box[k] = box[2 + k] = p[0][k];
    for (int i = 1; i < n; i++)
        for (int k = 0; k < 2; k++) {
            box[k] = p[i][k] < box[k] ? p[i][k] : box[k];
            box[2 + k] = p[i][k] > box[2 + k] ? p[i][k] : box[2 + k];
        }
}

/* The area (m2) that two boxes share. */
static double overlap(const double a[4], const double b[4])
{
    double area = 1;
    for (int k = 0; k < 2; k++) {
        const double low = a[k] > b[k] ? a[k] : b[k],
                     high = a[2 + k] < b[2 + k] ? a[2 + k] : b[2 + k];
        area *= high > low ? high - low : 0;
    }
    return area;
}

/* A point's shadows, and boxes around them. */
struct shadows {
    struct sight_eye *eye;
    struct outline cast[SIGHT_CUT];
    double box[SIGHT_CUT][4];
};

/* Adds what is left of the cell when the shadows of a list are taken away; behind it is room for
 * shorter ones. It is cut along those edges of a shadow that run through it: then all of it lies
 * within or outside. */
static void add_left(const struct shadows *all, const uint16_t *among, int count, uint16_t *list,
                     const struct outline_cell *cell)
{
    struct outline_cell inside[2], outside;
    const struct outline_cell *now = cell;
    double box[4];
    int flip = 0, n = 0, first = 0;
    if (cell->n < 3)
        return;
    if (cell->n > SIGHT_CELL_MOST) {
        struct outline_cell half[2];
        sight_halve(cell, half);
        for (int k = 0; k < 2; k++)
            add_left(all, among, count, list, &half[k]);
        return;
    }
    sight_box((const double(*)[2])cell->p, cell->n, box);
    for (int i = 0; i < count; i++) {
        const double *b = all->box[among[i]];
        if ((b[0] <= box[0]) & (b[2] >= box[2]) & (b[1] <= box[1]) & (b[3] >= box[3])
            && covers(&all->cast[among[i]], cell))
            return;
        list[n] = among[i];
        n += (b[0] < box[2]) & (b[2] > box[0]) & (b[1] < box[3]) & (b[3] > box[1]);
    }
    while (first < n && !sight_shade_meets(&all->cast[list[first]], cell))
        first++;
    if (first == n) {
        sight_eye_add(all->eye, cell);
        return;
    }
    const struct outline *s = &all->cast[list[first++]];
    list += first;
    n -= first;
    for (int e = 0, from = s->n - 1; e < s->n && now->n >= 3; from = e++) {
        double h[OUTLINE_CELL];
        int above = 0;
        for (int i = 0; i < now->n; i++) {
            h[i] = s->a[e] * now->p[i][0] + s->b[e] * now->p[i][1] - s->c[e];
            above += h[i] > 0;
        }
        if (above == 0 || above == now->n
            || !sight_runs_through(s->p[from], s->a[e], s->b[e], now, h))
            continue;
        outside.n = polygon_divide(&now->p[0][0], now->n, 2, h, OUTLINE_CELL, &outside.p[0][0],
                                   &inside[flip].p[0][0], &inside[flip].n);
        add_left(all, list, n, list + n, &outside);
        now = &inside[flip];
        flip = 1 - flip;
    }
    if (now->n >= 3 && is_outside(s, now))
        add_left(all, list, n, list + n, now);
}

double sight_factor(const struct sight *sight, const double x[3], const double n[3], double up,
                    const struct exchange_tree *tree, const uint32_t *faces, int count,
                    double *whole)
{
    struct sight_eye eye;
    struct shadows shadows;
    uint16_t lists[SIGHT_CUT * (SIGHT_CUT + 3) / 2];
    double from[3], box[4], sizes[SIGHT_CUT];
    int cast = 0;
    sight_eye_open(&eye, sight, x, n);
    for (int k = 0; k < 3; k++)
        from[k] = x[k] + up * n[k];
    double height = height3(from, sight->raised.origin, sight->raised.n);
    *whole = 0;
    if (!(eye.height > 0) || !(height > 0))
        return 0;
    sight_box((const double(*)[2])sight->cell.p, sight->cell.n, box);
    for (int b = 0; b < count; b++) {
        const struct element *e = &tree->h.elements[faces[b]];
        if (!outline_cast(&shadows.cast[cast], &sight->raised, from, height,
                          (const double(*)[3])e->vertex, e->vertices))
            continue;
        sight_box((const double(*)[2])shadows.cast[cast].p, shadows.cast[cast].n,
                  shadows.box[cast]);
        const double size = overlap(shadows.box[cast], box);
        int at = cast;
        if (!(size > 0))
            continue;
        for (; at > 0 && sizes[at - 1] < size; at--) {
            sizes[at] = sizes[at - 1];
            lists[at] = lists[at - 1];
        }
        sizes[at] = size;
        lists[at] = (uint16_t)cast++;
    }
    shadows.eye = &eye;
    add_left(&shadows, lists, cast, lists + cast, &sight->cell);
    return sight_eye_factor(&eye, whole);
}
