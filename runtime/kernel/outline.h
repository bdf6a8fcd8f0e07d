/* outline.h - what is seen of a convex cell in a plane past convex faces, from a point: cut out
 * exactly.
 *
 * Seen from x, a face hides of the plane a convex polygon, the projection of what of the face lies
 * between x and the plane. What is left of a cell when all such shadows are taken away is found by
 * cutting: each edge of a shadow parts the cell in what lies outside, which goes on to the next
 * shadow, and what does not. So faces may be many and their shadows may overlap. The plane has
 * coordinates of its own, (u, v); heights over it are along n, where x is. In m, m2.
 * Fails: nothing, but for rounding; cells left smaller than OUTLINE_LEAST of themselves are nothing
 * (outline_seen).
 * [projection: Crow 1977; the parts left by cutting: Weiler & Atherton 1977 for convex polygons]
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_OUTLINE_H
#define KERNEL_OUTLINE_H

#include "discussion.h"
#include "kernel/constants.h"

enum { OUTLINE_CORNERS = 8, OUTLINE_CELL = 72 };

struct outline_frame {
    double origin[3], u[3], v[3], n[3];
};

/* A shadow: counter-clockwise; a point is inside where a u + b v <= c for every edge. */
struct outline {
    int n;
    double p[OUTLINE_CORNERS][2], a[OUTLINE_CORNERS], b[OUTLINE_CORNERS], c[OUTLINE_CORNERS];
};

struct outline_cell {
    int n;
    double p[OUTLINE_CELL][2];
};

/* Area, and area times centroid. */
struct outline_sum {
    double area, at[2];
};

/* The plane of a surface, raised by `up`. */
static inline void outline_frame_of(struct outline_frame *f, const struct element *e, double up)
{
    for (int k = 0; k < 3; k++) {
        f->origin[k] = e->centre[k] + up * e->normal[k];
        f->n[k] = e->normal[k];
        f->u[k] = e->vertex[1][k] - e->vertex[0][k];
    }
    cross3(f->v, f->n, f->u);
    double size = length3(f->v);
    for (int k = 0; k < 3; k++)
        f->v[k] = size > 0 ? f->v[k] / size : 0;
    cross3(f->u, f->v, f->n);
}

static inline void outline_in(const struct outline_frame *f, const double p[3], double uv[2])
{
    double w[3];
    sub3(w, p, f->origin);
    uv[0] = dot3(w, f->u);
    uv[1] = dot3(w, f->v);
}

static inline void outline_out(const struct outline_frame *f, const double uv[2], double p[3])
{
    for (int k = 0; k < 3; k++)
        p[k] = f->origin[k] + uv[0] * f->u[k] + uv[1] * f->v[k];
}

/* Twice the area of a polygon. */
static inline double outline_twice(const double (*p)[2], int n)
{
    double sum = 0;
    for (int i = 2; i < n; i++)
        sum += (p[i - 1][0] - p[0][0]) * (p[i][1] - p[0][1])
               - (p[i - 1][1] - p[0][1]) * (p[i][0] - p[0][0]);
    return sum;
}

/* The shadow of the polygon v[n] from x, `height` over the plane. Returns 0 when there is none. */
static inline int outline_cast(struct outline *out, const struct outline_frame *f,
                               const double x[3], double height, const double (*v)[3], int n)
{
    double q[2][OUTLINE_CORNERS][3], h[OUTLINE_CORNERS], most = height * (1 - OUTLINE_BELOW_EYE),
                                                         at[2], w[3];
    int count = n, now = 0;
    sub3(w, x, f->origin);
    at[0] = dot3(w, f->u);
    at[1] = dot3(w, f->v);
    int i;
    for (i = 0; i < n; i++) { /* (u, v, height) */
        sub3(w, v[i], f->origin);
        q[0][i][0] = dot3(w, f->u);
        q[0][i][1] = dot3(w, f->v);
        q[0][i][2] = dot3(w, f->n);
    }
    for (int side = 0; side < 2; side++) { /* over the plane; below x */
        int within = 0;
        for (i = 0; i < count; i++) {
            h[i] = side ? most - q[now][i][2] : q[now][i][2];
            within += h[i] > 0;
        }
        if (within == 0) /* also what lies in the plane: it hides nothing of it */
            return 0;
        if (within == count) /* most are cut by neither */
            continue;
        count = polygon_divide(&q[now][0][0], count, 3, h, OUTLINE_CORNERS, &q[1 - now][0][0], NULL,
                               NULL);
        now = 1 - now;
        if (count < 3)
            return 0;
    }
    for (i = 0; i < count; i++) {
        double t = height / (height - q[now][i][2]);
        for (int k = 0; k < 2; k++)
            out->p[i][k] = at[k] + t * (q[now][i][k] - at[k]);
    }
    int j;
    if (outline_twice((const double(*)[2])out->p, count) < 0)
        for (i = 0, j = count - 1; i < j; i++, j--)
            for (int k = 0; k < 2; k++) {
                double swap = out->p[i][k];
                out->p[i][k] = out->p[j][k];
                out->p[j][k] = swap;
            }
    out->n = count;
    for (i = 0, j = count - 1; i < count; j = i++) { /* edge from j to i */
        out->a[i] = out->p[i][1] - out->p[j][1];
        out->b[i] = out->p[j][0] - out->p[i][0];
        out->c[i] = out->a[i] * out->p[j][0] + out->b[i] * out->p[j][1];
    }
    return 1;
}

/* A box in the plane against a shadow: -1 outside, 1 inside, 0 neither for sure. Given by middle
 * and half sides. */
static inline int outline_box(const struct outline *s, const double middle[2], const double half[2])
{
    int inside = 1;
    for (int i = 0; i < s->n; i++) {
        double m = s->a[i] * middle[0] + s->b[i] * middle[1] - s->c[i];
        double reach = fabs(s->a[i]) * half[0] + fabs(s->b[i]) * half[1];
        if (m >= reach)
            return -1;
        inside &= m <= -reach;
    }
    return inside;
}

static inline void outline_add(struct outline_sum *sum, const struct outline_cell *c)
{
    for (int i = 2; i < c->n; i++) {
        const double *o = c->p[0], *p = c->p[i - 1], *q = c->p[i];
        double area = 0.5 * ((p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]));
        sum->area += area;
        for (int k = 0; k < 2; k++)
            sum->at[k] += area * (o[k] + p[k] + q[k]) * (1 / 3.0);
    }
}

/* 1: the cell is wholly beside one of the shadow's edges. */
static inline int outline_beside(const struct outline *s, const struct outline_cell *cell)
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

/* Add what is left of the cell when the shadows from k on are taken away. */
static inline void outline_left(const struct outline *shadows, int count, int k,
                                const struct outline_cell *cell, struct outline_sum *sum)
{
    struct outline_cell inside[2], outside;
    const struct outline_cell *now = cell;
    int flip = 0;
    if (cell->n < 3)
        return;
    while (k < count && outline_beside(&shadows[k], cell))
        k++;
    if (k == count) {
        outline_add(sum, cell);
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
            outline_left(shadows, count, k + 1, now, sum);
            return;
        }
        outside.n = polygon_divide(&now->p[0][0], now->n, 2, h, OUTLINE_CELL, &outside.p[0][0],
                                   &inside[flip].p[0][0], &inside[flip].n);
        outline_left(shadows, count, k + 1, &outside, sum);
        now = &inside[flip];
        flip = 1 - flip;
    }
}

/* What is seen of a cell of this size (`whole`: area and area times centroid). Returns 0: nothing,
 * 1: a part, 2: all of it; *seen is set. */
static inline int outline_seen(const struct outline *shadows, int count,
                               const struct outline_cell *cell, const struct outline_sum *whole,
                               struct outline_sum *seen)
{
    seen->area = seen->at[0] = seen->at[1] = 0;
    outline_left(shadows, count, 0, cell, seen);
    if (!(seen->area > OUTLINE_LEAST * whole->area))
        return 0;
    if (seen->area < (1 - OUTLINE_LEAST) * whole->area)
        return 1;
    *seen = *whole;
    return 2;
}

/* Points to integrate a surface by, raised by `up`: 4 or 16 on a turned lattice, so that along
 * either side they stand at as many places: the edges of shadows often run along them. A triangle
 * is a square folded, area kept. */
enum { OUTLINE_FEW = 4, OUTLINE_MANY = 16 };
static inline void outline_points(const struct element *e, double up, int count, double (*x)[3],
                                  double *weight)
{
    static const int turned[OUTLINE_FEW] = {2, 0, 3, 1};
    double sum = 0;
    for (int i = 0; i < count; i++) {
        int j = count == OUTLINE_FEW ? turned[i] : 5 * i % OUTLINE_MANY;
        double s = (i + 0.5) / count, t = (j + 0.5) / count, ds[3], dt[3], jacobian[3];
        if (e->vertices == 3)
            s = sqrt(s);
        for (int k = 0; k < 3; k++) {
            double a = e->vertex[0][k], b = e->vertex[1][k], c = e->vertex[2][k];
            double low = a + s * (b - a), high = e->vertices == 3
                                                     ? a + s * (c - a)
                                                     : e->vertex[3][k] + s * (c - e->vertex[3][k]);
            dt[k] = high - low;
            ds[k] = e->vertices == 3 ? 0 : (1 - t) * (b - a) + t * (c - e->vertex[3][k]);
            x[i][k] = low + t * dt[k] + up * e->normal[k];
        }
        cross3(jacobian, ds, dt);
        weight[i] = e->vertices == 3 ? 1 : dot3(jacobian, e->normal);
        sum += weight[i];
    }
    for (int i = 0; i < count; i++)
        weight[i] = sum > 0 ? weight[i] / sum : 1.0 / count;
}

#endif
