/* leaf_at.h - which leaf below a surface holds a point, and what each of its corners counts for
 * there. A face is cut at exact midpoints, so the way down is taken in the coordinates of its
 * shape.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_LEAF_AT_H
#define KERNEL_LEAF_AT_H

#include <math.h>
#include "discussion.h"

/* The two axes in which a plane of this normal is widest. */
static inline void leaf_axes(const double normal[3], int *x, int *y)
{
    double a = fabs(normal[0]), b = fabs(normal[1]), c = fabs(normal[2]);
    *x = a >= b && a >= c ? 1 : 0;
    *y = c > a && c > b ? 1 : 2;
}

static inline double leaf_clamp(double t)
{
    return t > 0 ? (t < 1 ? t : 1) : 0; /* NaN becomes 0 */
}

/* Distance of t from [0, 1]. */
static inline double leaf_outside(double t)
{
    return t < 0 ? -t : t > 1 ? t - 1 : 0;
}

/* Solve p = v0 + s (v1 - v0) + t (v3 - v0) + s t (v0 - v1 + v2 - v3), a quadratic in t. */
static inline void leaf_quad(const struct element *e, const double p[3], double *s, double *t)
{
    int x, y;
    leaf_axes(e->normal, &x, &y);
    double ex = e->vertex[1][x] - e->vertex[0][x], ey = e->vertex[1][y] - e->vertex[0][y];
    double fx = e->vertex[3][x] - e->vertex[0][x], fy = e->vertex[3][y] - e->vertex[0][y];
    double gx = e->vertex[2][x] - e->vertex[1][x] - fx, gy = e->vertex[2][y] - e->vertex[1][y] - fy;
    double hx = p[x] - e->vertex[0][x], hy = p[y] - e->vertex[0][y];
    double a = gx * fy - gy * fx, b = ex * fy - ey * fx + hx * gy - hy * gx, c = hx * ey - hy * ex;
    double d = sqrt(fmax(b * b - 4 * a * c, 0)), q = -0.5 * (b + copysign(d, b));
    /* q / a overflows when the sides are parallel; then c / q is the root. */
    double root = c / q, other = q / a;
    *t = leaf_outside(root) <= 1e-9 || !(leaf_outside(other) < leaf_outside(root))
             ? leaf_clamp(root)
             : leaf_clamp(other);
    double wx = ex + gx * *t, wy = ey + gy * *t;
    *s = leaf_clamp(fabs(wx) > fabs(wy) ? (hx - fx * *t) / wx : (hy - fy * *t) / wy);
}

static inline void leaf_triangle(const struct element *e, const double p[3], double weight[3])
{
    int x, y;
    leaf_axes(e->normal, &x, &y);
    double ax = e->vertex[1][x] - e->vertex[0][x], ay = e->vertex[1][y] - e->vertex[0][y];
    double bx = e->vertex[2][x] - e->vertex[0][x], by = e->vertex[2][y] - e->vertex[0][y];
    double hx = p[x] - e->vertex[0][x], hy = p[y] - e->vertex[0][y], area = ax * by - ay * bx;
    weight[1] = leaf_clamp((hx * by - hy * bx) / area);
    weight[2] = leaf_clamp((ax * hy - ay * hx) / area);
    if (weight[1] + weight[2] > 1) {
        double sum = weight[1] + weight[2];
        weight[1] /= sum;
        weight[2] /= sum;
    }
    weight[0] = 1 - weight[1] - weight[2];
}

/* A point on its way down from a surface, in the coordinates of where it is by now: s and t of a
 * quad, the weights of a triangle's corners. */
struct leaf_walk {
    uint32_t at; /* an element */
    int quad;
    double x[3];
};

static inline struct leaf_walk leaf_walk_from(const struct element *elements, uint32_t surface,
                                              const double point[3])
{
    struct leaf_walk w = {surface, elements[surface].vertices == 4, {0, 0, 0}};
    if (w.quad)
        leaf_quad(&elements[surface], point, &w.x[0], &w.x[1]);
    else
        leaf_triangle(&elements[surface], point, w.x);
    return w;
}

/* To the child that holds the point, of those from `child` on. Halving a quad halves its bilinear
 * parameters: the cuts are lines of s = 1/2 and t = 1/2, and a child numbers its corners as its
 * parent does. In a triangle child k keeps corner k; child 3 is the middle, its corners those
 * between 0-1, 1-2, 2-0. */
static inline void leaf_walk_down(struct leaf_walk *w, uint32_t child)
{
    double *x = w->x;
    if (w->quad) {
        int right = x[0] > 0.5, top = x[1] > 0.5;
        w->at = child + (uint32_t)(right ^ top) + 2 * (uint32_t)top;
        x[0] = 2 * x[0] - right;
        x[1] = 2 * x[1] - top;
        return;
    }
    uint32_t k = x[0] > 0.5 ? 0 : x[1] > 0.5 ? 1 : x[2] > 0.5 ? 2 : 3;
    w->at = child + k;
    if (k < 3) {
        for (uint32_t j = 0; j < 3; j++)
            x[j] = 2 * x[j] - (j == k);
    } else {
        double w0 = 1 - 2 * x[2], w1 = 1 - 2 * x[0], w2 = 1 - 2 * x[1];
        x[0] = w0;
        x[1] = w1;
        x[2] = w2;
    }
}

/* Weights of the leaf's corners add to 1: bilinear in quads, linear in triangles. A point outside
 * the surface counts as the nearest of its border, nearly. elements: the tree; surface: one of
 * them. Returns the leaf. */
static inline uint32_t leaf_at(const struct element *elements, uint32_t surface,
                               const double point[3], double weight[4])
{
    struct leaf_walk w = leaf_walk_from(elements, surface, point);
    while (elements[w.at].children)
        leaf_walk_down(&w, elements[w.at].child);
    const double s = w.x[0], t = w.x[1];
    weight[0] = w.quad ? (1 - s) * (1 - t) : w.x[0];
    weight[1] = w.quad ? s * (1 - t) : w.x[1];
    weight[2] = w.quad ? s * t : w.x[2];
    if (w.quad)
        weight[3] = (1 - s) * t;
    return w.at;
}

#endif
