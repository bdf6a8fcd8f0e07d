/* sampler.h - evenly spread points of the part of a surface that another surface's plane leaves in
 * front.
 *
 * (s, t) of the unit square is mapped so that area is kept: straight for a parallelogram, else over
 * a fan of triangles from corner 0. s chooses the triangle; a triangle is the square pulled
 * together to a point at one side, s drawn to its root so that area is kept. Points are computed
 * several at a time (lanes.h), each as it would be alone.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_SAMPLER_H
#define KERNEL_SAMPLER_H

#include "discussion.h"
#include "kernel/constants.h"
#include "kernel/lanes.h"
#include "kernel/sobol.h"

enum { SAMPLER_PARTS = POLYGON_MAX - 2 };

/* A polygon ready to be sampled: a parallelogram, or a fan of triangles (0, i + 1, i + 2). */
struct sampler {
    struct polygon p;
    int parallelogram;
    /* the sides from corner 0; of triangle i, its side from corner 0 and the one across */
    double right[SAMPLER_PARTS][3], up[SAMPLER_PARTS][3];
    /* twice the triangles' areas, and their sum; what s must reach for the next one */
    double area[SAMPLER_PARTS], whole, limit[SAMPLER_PARTS];
};

/* The part of e in front of the plane of `other`. */
static inline void sampler_clip(struct sampler *q, const struct element *e,
                                const struct element *other)
{
    const struct polygon *p = &q->p;
    polygon_clip(&q->p, (const double(*)[3])e->vertex, e->vertices, other->centre, other->normal);
    q->parallelogram = 0;
    if (p->n == 4) {
        double gap = 0, size = 0;
        for (int k = 0; k < 3; k++) {
            double x = p->v[0][k] - p->v[1][k] + p->v[2][k] - p->v[3][k],
                   y = p->v[2][k] - p->v[0][k];
            gap += x * x;
            size += y * y;
        }
        q->parallelogram = gap <= SAMPLER_PARALLELOGRAM * size;
    }
    if (q->parallelogram) {
        sub3(q->right[0], p->v[1], p->v[0]);
        sub3(q->up[0], p->v[3], p->v[0]);
        return;
    }
    q->whole = 0;
    for (int i = 0; i < SAMPLER_PARTS; i++) {
        q->limit[i] = INFINITY;
        q->area[i] = 0;
        if (i + 2 < p->n) {
            double c[3], d[3];
            sub3(q->right[i], p->v[i + 1], p->v[0]);
            sub3(q->up[i], p->v[i + 2], p->v[i + 1]);
            sub3(d, p->v[i + 2], p->v[0]);
            cross3(c, q->right[i], d);
            q->area[i] = dot3(c, e->normal);
            q->whole += q->area[i];
            if (i + 3 < p->n)
                q->limit[i] = q->area[i];
        } else {
            for (int k = 0; k < 3; k++)
                q->right[i][k] = q->up[i][k] = 0;
        }
    }
}

TOOL void sampler_parallelogram(const struct sampler *q, int count, const uint32_t *s,
                                const uint32_t *t, double (*out)[SEGMENTS_MAX])
{
    const double *a = q->p.v[0], *r = q->right[0], *u = q->up[0];
    const double a0 = a[0], a1 = a[1], a2 = a[2], r0 = r[0], r1 = r[1], r2 = r[2], u0 = u[0],
                 u1 = u[1], u2 = u[2];
    for (int i = 0; i < count; i += LANES)
        for (int j = i; j < i + LANES; j++) {
            const double x = sobol_unit(s[j]), y = sobol_unit(t[j]);
            out[0][j] = a0 + x * r0 + y * u0;
            out[1][j] = a1 + x * r1 + y * u1;
            out[2][j] = a2 + x * r2 + y * u2;
        }
}

TOOL void sampler_fan(const struct sampler *q, int count, const uint32_t *s, const uint32_t *t,
                      double (*out)[SEGMENTS_MAX])
{
    /* how far along the triangle's side and how far across, and which it is: 0, 1, 2 */
    double along[SEGMENTS_MAX], across[SEGMENTS_MAX], part[SEGMENTS_MAX];
    const double whole = q->whole, limit_0 = q->limit[0], limit_1 = q->limit[1],
                 area_0 = q->area[0], area_1 = q->area[1], area_2 = q->area[2];
    for (int i = 0; i < count; i += LANES)
        for (int j = i; j < i + LANES; j++) {
            double x = sobol_unit(s[j]) * whole, rest = x - area_0, last = rest - area_1;
            double area = x >= limit_0 ? area_1 : area_0;
            double at = x >= limit_0 ? 1 : 0;
            double y = x >= limit_0 ? rest : x;
            double other = x >= limit_0 ? limit_1 : INFINITY;
            area = y >= other ? area_2 : area;
            part[j] = y >= other ? 2 : at;
            y = y >= other ? last : y;
            double root = sqrt(y / area);
            root = area > 0 ? root : 1;
            root = y < area ? root : 1;
            along[j] = root;
            across[j] = root * sobol_unit(t[j]);
        }
    for (int k = 0; k < 3; k++) {
        const double from = q->p.v[0][k], r0 = q->right[0][k], r1 = q->right[1][k],
                     r2 = q->right[2][k], u0 = q->up[0][k], u1 = q->up[1][k], u2 = q->up[2][k];
        for (int i = 0; i < count; i += LANES)
            for (int j = i; j < i + LANES; j++) {
                double right = part[j] > 0 ? r1 : r0, up = part[j] > 0 ? u1 : u0;
                right = part[j] > 1 ? r2 : right;
                up = part[j] > 1 ? u2 : up;
                out[k][j] = from + along[j] * right + across[j] * up;
            }
    }
}

/* `count` points, rounded up to whole lanes; from the digits of both coordinates. */
TOOL void sampler_points(const struct sampler *q, int count, const uint32_t *s, const uint32_t *t,
                         double (*out)[SEGMENTS_MAX])
{
    if (q->parallelogram)
        sampler_parallelogram(q, count, s, t, out);
    else
        sampler_fan(q, count, s, t, out);
}

#endif
