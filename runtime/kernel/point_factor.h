/* point_factor.h - the form factor from a point of the receiver to a flat convex polygon.
 *
 * F(x) = -(1/2pi) sum theta_i Gamma_i.n over the polygon's edges: theta_i is the angle that edge i
 * subtends at x, Gamma_i the unit normal of the plane through x and the edge [Lambert 1760; Baum et
 * al. 1989]. The polygon is clipped at the receiver's plane; a point behind the emitter's plane
 * sees nothing of it: F = 0. Dimensionless.
 * Fails: at the polygon's own edges F jumps; there the edge is left out.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_POINT_FACTOR_H
#define KERNEL_POINT_FACTOR_H

#include "discussion.h"
#include "kernel/polygon_factor.h"

/* The part of s that the receiver's plane leaves in view; no corners: nothing. */
static inline void point_factor_clip(struct polygon *q, const struct element *r,
                                     const struct element *s)
{
    q->n = 0;
    if (r->vertices && s->vertices)
        polygon_clip(q, (const double(*)[3])s->vertex, s->vertices, r->centre, r->normal);
}

/* F from the point x of r to q, the clipped s. */
static inline double point_factor_at(const double x[3], const struct element *r,
                                     const struct element *s, const struct polygon *q)
{
    if (q->n == 0 || !(height3(x, s->centre, s->normal) > 0))
        return 0;
    double f = lambert_sum(x, r->normal, (const double(*)[3])q->v, q->n);
    return f > 0 ? f < 1 ? f : 1 : 0;
}

/* The same from many points at once, LAMBERT_POINTS at the most. */
static inline void point_factors_at(int points, const double (*x)[3], const struct element *r,
                                    const struct element *s, const struct polygon *q, double *out)
{
    if (q->n > 0)
        lambert_sums(points, x, r->normal, (const double(*)[3])q->v, q->n, out);
    for (int i = 0; i < points; i++) {
        if (q->n == 0 || !(height3(x[i], s->centre, s->normal) > 0))
            out[i] = 0;
        out[i] = out[i] > 0 ? out[i] < 1 ? out[i] : 1 : 0;
    }
}

/* F from the receiver's centre. */
OUTLINE double point_factor(const struct element *r, const struct element *s)
{
    struct polygon q;
    point_factor_clip(&q, r, s);
    double f = point_factor_at(r->centre, r, s, &q);
    return q.n == 0 || polygon_factor_hidden(r, s, f * r->area) ? 0 : f;
}

#endif
