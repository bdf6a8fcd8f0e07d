/* sampler.h - evenly spread points of the part of a surface that another surface's plane leaves in
 * front.
 *
 * (s, t) of the unit square is mapped so that area is kept: straight for a parallelogram, else over
 * a fan of triangles from corner 0.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_SAMPLER_H
#define KERNEL_SAMPLER_H

#include "discussion.h"
#include "kernel/constants.h"

/* A polygon ready to be sampled: a parallelogram, or a fan of triangles. (Its inner loops are
 * written out: at -O2 they cost a quarter more otherwise.) */
struct sampler {
    struct polygon p;
    int parallelogram;
    double right[3], up[3]; /* parallelogram: the sides from corner 0 */
    /* twice the areas of the fan's triangles (0, i - 1, i), and their sum */
    double area[POLYGON_MAX], whole;
};

/* The part of e in front of the plane of `other`. */
static inline void sampler_clip(struct sampler *q, const struct element *e,
                                const struct element *other)
{
    const struct polygon *p = &q->p;
    polygon_clip(&q->p, (const double(*)[3])e->vertex, e->vertices, other->centre, other->normal);
    q->whole = 0;
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
        sub3(q->right, p->v[1], p->v[0]);
        sub3(q->up, p->v[3], p->v[0]);
    }
    for (int i = 2; i < p->n && !q->parallelogram; i++) {
        double a[3], b[3], c[3];
        sub3(a, p->v[i - 1], p->v[0]);
        sub3(b, p->v[i], p->v[0]);
        cross3(c, a, b);
        q->area[i] = dot3(c, e->normal);
        q->whole += q->area[i];
    }
}

/* Map (s, t) in the unit square to the polygon so that area is kept. */
static inline void sampler_point(double out[3], const struct sampler *q, double s, double t)
{
    const double *a = q->p.v[0];
    if (q->parallelogram) {
        out[0] = a[0] + s * q->right[0] + t * q->up[0];
        out[1] = a[1] + s * q->right[1] + t * q->up[1];
        out[2] = a[2] + s * q->right[2] + t * q->up[2];
        return;
    }
    s *= q->whole;
    int i;
    for (i = 2; i < q->p.n - 1 && s >= q->area[i]; i++)
        s -= q->area[i];
    s = q->area[i] > 0 && s < q->area[i] ? sqrt(s / q->area[i]) : 1;
    const double *b = q->p.v[i - 1];
    const double *c = q->p.v[i];
    out[0] = a[0] + s * (b[0] - a[0]) + s * t * (c[0] - b[0]);
    out[1] = a[1] + s * (b[1] - a[1]) + s * t * (c[1] - b[1]);
    out[2] = a[2] + s * (b[2] - a[2]) + s * t * (c[2] - b[2]);
}

#endif
