/* ray_factor.h - the form factor of two flat convex polygons by rays, nothing between them.
 *
 * F_pq = (1 / A_p) int_p int_q k dy dx, k Lambert's kernel, is a mean over points x of p, of what
 * meets q; it can be had by rays to points y of q, evenly spread (F = mean of A_q k: good far off,
 * without bound where the two touch), or by rays in directions spread by the cosine (F = the share
 * that meets q: good near by, blind far off). Here each point x of the smaller casts one ray of
 * either kind, and both count by the balance heuristic, A_q k / (1 + A_q k), which is what a disc
 * of q's area would show: no ray counts more than 1, and their sum has no bias. What noise takes
 * above F = 1 or A_q / A_p is cut off. [Malley's method for the second kind; Veach and Guibas 1995,
 * for how the two are joined]
 *
 * The points are a net shifted by a hash of both identities: the same in every run, and A_p F_pq =
 * A_q F_qp to rounding.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_RAY_FACTOR_H
#define KERNEL_RAY_FACTOR_H

#include "discussion.h"
#include "kernel/hemisphere.h"
#include "kernel/lambert.h"
#include "kernel/polygon_factor.h"
#include "kernel/sampler.h"
#include "kernel/sobol.h"

/* What a ray counts whose ends have cosines of this product, at this square of a distance. */
static inline double ray_factor_weight(double area, double cosines, double square)
{
    double k = area * cosines;
    return k / (LAMBERT_PI * square + k);
}

/* What the ray from x, with frame h, to y on q counts. */
static inline double ray_factor_to(const double x[3], const struct hemisphere *h, const double y[3],
                                   const double normal[3], double area)
{
    double w[3];
    sub3(w, y, x);
    double square = dot3(w, w), cos_x = dot3(h->n, w), cos_y = -dot3(normal, w);
    return cos_x > 0 && cos_y > 0 ? ray_factor_weight(area, cos_x * cos_y / square, square) : 0;
}

/* What the ray from x in the direction of the disc's point (s, t) counts: 0 if it misses q. */
static inline double ray_factor_along(const double x[3], const struct hemisphere *h, double s,
                                      double t, const struct polygon *q, const double normal[3],
                                      double area)
{
    double way[3], y[3], edge[3], to[3], side[3];
    const double out = sqrt(s), cos_x = sqrt(1 - s), angle = 2 * LAMBERT_PI * t;
    const double a = out * cos(angle), b = out * sin(angle);
    for (int k = 0; k < 3; k++)
        way[k] = cos_x * h->n[k] + a * h->u[k] + b * h->v[k];
    const double height = height3(x, q->v[0], normal), cos_y = -dot3(normal, way);
    if (!(height > 0 && cos_y > 0))
        return 0;
    const double length = height / cos_y;
    for (int k = 0; k < 3; k++)
        y[k] = x[k] + length * way[k];
    for (int i = 0; i < q->n; i++) {
        sub3(edge, q->v[i + 1 < q->n ? i + 1 : 0], q->v[i]);
        sub3(to, y, q->v[i]);
        cross3(side, edge, to);
        if (dot3(side, normal) < 0)
            return 0;
    }
    return ray_factor_weight(area, cos_x * cos_y, length * length);
}

/* F_rs by `count` rays of either kind, a power of two up to SOBOL_MOST. */
OUTLINE double ray_factor(const struct element *r, const struct element *s, int count)
{
    const int r_is_small = r->radius < s->radius || (r->radius == s->radius && r->id < s->id);
    const struct element *small = r_is_small ? r : s, *large = r_is_small ? s : r;
    struct sampler p, q;
    struct sobol net;
    uint32_t digit[4][SEGMENTS_MAX];
    double from[3][SEGMENTS_MAX], to[3][SEGMENTS_MAX], sum = 0;
    sampler_clip(&p, small, large);
    sampler_clip(&q, large, small);
    if (p.p.n == 0 || q.p.n == 0)
        return 0;
    const double area = polygon_area(&q.p, large->normal);
    const struct hemisphere h = hemisphere_over(small->normal);
    sobol_start(&net, hash64(small->id + hash64(large->id)));
    for (int first = 0; first < count; first += SEGMENTS_MAX) {
        const int batch = count - first < SEGMENTS_MAX ? count - first : SEGMENTS_MAX;
        sobol_points(&net, first, batch, digit);
        sampler_points(&p, batch, digit[0], digit[1], from);
        sampler_points(&q, batch, digit[2], digit[3], to);
        for (int i = 0; i < batch; i++) {
            const double x[3] = {from[0][i], from[1][i], from[2][i]},
                         y[3] = {to[0][i], to[1][i], to[2][i]};
            sum += ray_factor_to(x, &h, y, large->normal, area);
            sum += ray_factor_along(x, &h, sobol_unit(digit[2][i]), sobol_unit(digit[3][i]), &q.p,
                                    large->normal, area);
        }
    }
    const double exchange = polygon_area(&p.p, small->normal) * sum / count;
    const double least = r->area < s->area ? r->area : s->area;
    if (!(exchange > 0) || polygon_factor_hidden(r, s, exchange))
        return 0;
    return (exchange < least ? exchange : least) / r->area;
}

#endif
