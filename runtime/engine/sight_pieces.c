/* sight_pieces.c - what a point sees of a convex polygon past convex faces, exactly.
 *
 * Shadows are cast on the polygon's plane and what they leave of it is cut out (kernel/outline.h),
 * in convex pieces; each has Lambert's sum over its edges. So of a point nothing is approximate
 * but rounding, and an integral over points has no noise of the other side.
 * Invariant: with no blocker it is lambert_sum of the whole polygon.
 * [Lambert 1760; Weiler & Atherton 1977 for convex polygons]
 * SPDX-License-Identifier: MIT */
#include "engine/sight_pieces.h"
#include "kernel/lambert.h"

/* A point over the plane, in the plane's coordinates. */
struct eye {
    double at[2], height, normal[3];
};

void sight_open(struct sight *sight, const struct element *e, const struct polygon *part, double up)
{
    outline_frame_of(&sight->frame, e, 0);
    outline_frame_of(&sight->raised, e, up);
    sight->cell.n = part->n;
    for (int i = 0; i < part->n; i++)
        outline_in(&sight->frame, part->v[i], sight->cell.p[i]);
}

static double cell_factor(const struct eye *eye, const struct outline_cell *cell)
{
    double v[OUTLINE_CELL][3];
    static const double origin[3] = {0, 0, 0};
    for (int i = 0; i < cell->n; i++) {
        v[i][0] = cell->p[i][0] - eye->at[0];
        v[i][1] = cell->p[i][1] - eye->at[1];
        v[i][2] = -eye->height;
    }
    return lambert_sum(origin, eye->normal, (const double(*)[3])v, cell->n);
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

/* The factor of what is left of the cell when the shadows from k on are taken away. */
static double left_factor(const struct eye *eye, const struct outline *shadows, int count, int k,
                          const struct outline_cell *cell)
{
    struct outline_cell inside[2], outside;
    const struct outline_cell *now = cell;
    double sum = 0;
    int flip = 0;
    if (cell->n < 3)
        return 0;
    while (k < count && beside(&shadows[k], cell))
        k++;
    if (k == count)
        return cell_factor(eye, cell);
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
        if (above == now->n)
            return sum + left_factor(eye, shadows, count, k + 1, now);
        outside.n = polygon_divide(&now->p[0][0], now->n, 2, h, OUTLINE_CELL, &outside.p[0][0],
                                   &inside[flip].p[0][0], &inside[flip].n);
        sum += left_factor(eye, shadows, count, k + 1, &outside);
        now = &inside[flip];
        flip = 1 - flip;
    }
    return sum;
}

double sight_factor(const struct sight *sight, const double x[3], const double n[3], double up,
                    const struct polygon *blockers, int count)
{
    struct outline shadows[SIGHT_LIST];
    const struct outline_frame *f = &sight->frame;
    struct eye eye = {.height = height3(x, f->origin, f->n),
                      .normal = {dot3(n, f->u), dot3(n, f->v), dot3(n, f->n)}};
    double from[3];
    int cast = 0;
    outline_in(f, x, eye.at);
    for (int k = 0; k < 3; k++)
        from[k] = x[k] + up * n[k];
    double height = height3(from, sight->raised.origin, f->n);
    if (!(eye.height > 0) || !(height > 0))
        return 0;
    for (int b = 0; b < count; b++)
        cast += outline_cast(&shadows[cast], &sight->raised, from, height,
                             (const double(*)[3])blockers[b].v, blockers[b].n);
    double seen = left_factor(&eye, shadows, cast, 0, &sight->cell);
    return seen > 0 ? seen < 1 ? seen : 1 : 0;
}
