/* sight_pieces.c - what a point sees of a convex polygon past convex faces, exactly.
 *
 * Shadows are cast on the polygon's plane and what they leave of it is cut out (kernel/outline.h),
 * in convex pieces; Lambert's sum goes over their edges. So of a point nothing is approximate
 * but rounding, and an integral over points has no noise of the other side.
 * Invariant: with no blocker it is lambert_sum of the whole polygon.
 * [Lambert 1760; Weiler & Atherton 1977 for convex polygons]
 * SPDX-License-Identifier: MIT */
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

static void edges_sum(struct sight_eye *eye)
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
    edges_sum(eye);
    *whole = factor_of(eye->edges.whole);
    return factor_of(eye->edges.sum);
}

void sight_eye_add(struct sight_eye *eye, const struct outline_cell *cell)
{
    struct sight_edges *g = &eye->edges;
    if (g->count + cell->n > SIGHT_EYE_EDGES)
        edges_sum(eye);
    for (int i = 0, j = cell->n - 1; i < cell->n; j = i++) {
        for (int k = 0; k < 2; k++) {
            g->a[k][g->count] = cell->p[j][k] - eye->at[k];
            g->b[k][g->count] = cell->p[i][k] - eye->at[k];
        }
        g->count++;
    }
}

/* How a cell lies to a shadow: 1: wholly beside one of its edges. */
static int beside(const struct outline *s, const struct outline_cell *cell)
{
    int i;
    for (int e = 0; e < s->n; e++) {
        for (i = 0; i < cell->n; i++)
            if (s->a[e] * cell->p[i][0] + s->b[e] * cell->p[i][1] < s->c[e])
                break;
        if (i == cell->n)
            return 1;
    }
    return 0;
}

/* Adds what is left of the cell when the shadows from k on are taken away. */
static void add_left(struct sight_eye *eye, const struct outline *shadows, int count, int k,
                     const struct outline_cell *cell)
{
    struct outline_cell inside[2], outside;
    const struct outline_cell *now = cell;
    int flip = 0;
    if (cell->n < 3)
        return;
    while (k < count && beside(&shadows[k], cell))
        k++;
    if (k == count) {
        sight_eye_add(eye, cell);
        return;
    }
    const struct outline *s = &shadows[k];
    for (int e = 0; e < s->n && now->n >= 3; e++) {
        double h[OUTLINE_CELL];
        int above = 0;
        for (int i = 0; i < now->n; i++) {
            h[i] = s->a[e] * now->p[i][0] + s->b[e] * now->p[i][1] - s->c[e];
            above += h[i] > 0;
        }
        if (above == 0)
            continue;
        if (above == now->n) {
            add_left(eye, shadows, count, k + 1, now);
            return;
        }
        outside.n = polygon_divide(&now->p[0][0], now->n, 2, h, OUTLINE_CELL, &outside.p[0][0],
                                   &inside[flip].p[0][0], &inside[flip].n);
        add_left(eye, shadows, count, k + 1, &outside);
        now = &inside[flip];
        flip = 1 - flip;
    }
}

double sight_factor(const struct sight *sight, const double x[3], const double n[3], double up,
                    const struct exchange_tree *tree, const uint32_t *faces, int count,
                    double *whole)
{
    struct outline shadows[SIGHT_CUT];
    struct sight_eye eye;
    double from[3];
    int cast = 0;
    sight_eye_open(&eye, sight, x, n);
    for (int k = 0; k < 3; k++)
        from[k] = x[k] + up * n[k];
    double height = height3(from, sight->raised.origin, sight->raised.n);
    *whole = 0;
    if (!(eye.height > 0) || !(height > 0))
        return 0;
    for (int b = 0; b < count; b++) {
        const struct element *e = &tree->h.elements[faces[b]];
        cast += outline_cast(&shadows[cast], &sight->raised, from, height,
                             (const double(*)[3])e->vertex, e->vertices);
    }
    add_left(&eye, shadows, cast, 0, &sight->cell);
    return sight_eye_factor(&eye, whole);
}
