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

/* The first child of i, 0 when it is a leaf; from `first`, which is that of all elements, when it
 * is given: many points in no order find it in the cache, where they would wait for the elements.
 */
static inline uint32_t leaf_child(const struct element *elements, const uint32_t *first, uint32_t i)
{
    return first ? first[i] : elements[i].children ? elements[i].child : 0;
}

/* Halving a quad halves its bilinear parameters: the cuts are lines of s = 1/2 and t = 1/2, and a
 * child numbers its corners as its parent does. */
static inline uint32_t leaf_descend_quad(const struct element *elements, const uint32_t *first,
                                         uint32_t i, const double p[3], double weight[4])
{
    double s, t;
    leaf_quad(&elements[i], p, &s, &t);
    for (uint32_t child; (child = leaf_child(elements, first, i)) != 0;) {
        int right = s > 0.5, top = t > 0.5;
        i = child + (uint32_t)(top ? (right ? 2 : 3) : (right ? 1 : 0));
        s = 2 * s - right;
        t = 2 * t - top;
    }
    weight[0] = (1 - s) * (1 - t);
    weight[1] = s * (1 - t);
    weight[2] = s * t;
    weight[3] = (1 - s) * t;
    return i;
}

/* Child k keeps corner k; child 3 is the middle, its corners those between 0-1, 1-2, 2-0. */
static inline uint32_t leaf_descend_triangle(const struct element *elements, const uint32_t *first,
                                             uint32_t i, const double p[3], double weight[4])
{
    leaf_triangle(&elements[i], p, weight);
    for (uint32_t child; (child = leaf_child(elements, first, i)) != 0;) {
        uint32_t k = weight[0] > 0.5 ? 0 : weight[1] > 0.5 ? 1 : weight[2] > 0.5 ? 2 : 3;
        i = child + k;
        if (k < 3) {
            for (uint32_t j = 0; j < 3; j++)
                weight[j] = 2 * weight[j] - (j == k);
        } else {
            double w0 = 1 - 2 * weight[2], w1 = 1 - 2 * weight[0], w2 = 1 - 2 * weight[1];
            weight[0] = w0;
            weight[1] = w1;
            weight[2] = w2;
        }
    }
    return i;
}

/* Weights of the leaf's corners add to 1: bilinear in quads, linear in triangles. A point outside
 * the surface counts as the nearest of its border, nearly. elements: the tree; surface: one of
 * them. Returns the leaf. */
static inline uint32_t leaf_at(const struct element *elements, uint32_t surface,
                               const double point[3], double weight[4])
{
    return elements[surface].vertices == 4
               ? leaf_descend_quad(elements, NULL, surface, point, weight)
               : leaf_descend_triangle(elements, NULL, surface, point, weight);
}

/* The same by all elements' first children. */
static inline uint32_t leaf_at_by(const struct element *elements, const uint32_t *first,
                                  uint32_t surface, const double point[3], double weight[4])
{
    return elements[surface].vertices == 4
               ? leaf_descend_quad(elements, first, surface, point, weight)
               : leaf_descend_triangle(elements, first, surface, point, weight);
}

#endif
