/* polygon_factor.h - the form factor of two flat convex polygons, nothing between them.
 *
 * The method is chosen by how far the smaller polygon (by bounding radius) is from the larger,
 * in its own radii; each limit keeps the relative error near 1e-5
 * (tests/runtime/check_form_factor.c). Source of the formulas: form_factor.h.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_POLYGON_FACTOR_H
#define KERNEL_POLYGON_FACTOR_H

#include "discussion.h"
#include "kernel/constants.h"
#include "kernel/contour_factor.h"
#include "kernel/lambert.h"
#include "kernel/plane_side.h"

/* Multiply a polygon's corners by a power of two. */
static inline void polygon_factor_scale(struct polygon *p, double factor)
{
    for (int i = 0; i < p->n; i++) {
        p->v[i][0] *= factor;
        p->v[i][1] *= factor;
        p->v[i][2] *= factor;
    }
}

/* Integral over triangle abc with normal n of the factor to q (m2): 1, 3 or 6 points, exact to
 * degree 1, 2, 4 [Strang and Fix 1973; Dunavant 1985]. */
static inline double polygon_factor_triangle(const double *a, const double *b, const double *c,
                                             const double n[3], const struct polygon *q, int order)
{
    static const double corner[3][2] = {
        {1 / 3.0, 0}, {2 / 3.0, 0}, {0.81684757298045851308, 0.10810301816807022736}};
    static const double weight[3][2] = {
        {1, 0}, {1 / 3.0, 0}, {0.10995174365532186764, 0.22338158967801146570}};
    double x[3], y[3], z[3], at[6][3], f[6], sum = 0;
    const int groups = order == 2 ? 2 : 1, each = order == 0 ? 1 : 3;
    sub3(x, b, a);
    sub3(y, c, a);
    cross3(z, x, y);
    for (int group = 0; group < groups; group++) {
        double w = corner[order][group], v = 0.5 * (1 - w);
        for (int i = 0; i < each; i++) {
            const double *p0 = i == 0   ? a
                               : i == 1 ? b
                                        : c,
                         *p1 = i == 0   ? b
                               : i == 1 ? c
                                        : a,
                         *p2 = i == 0   ? c
                               : i == 1 ? a
                                        : b;
            for (int k = 0; k < 3; k++)
                at[group * each + i][k] = w * p0[k] + v * p1[k] + v * p2[k];
        }
    }
    lambert_sums(groups * each, (const double(*)[3])at, n, (const double(*)[3])q->v, q->n, f);
    for (int group = 0; group < groups; group++) {
        double part = 0;
        for (int i = 0; i < each; i++)
            part += f[group * each + i];
        sum += weight[order][group] * part;
    }
    return sum * 0.5 * dot3(z, n);
}

/* The same over a quad: the bilinear map of a Gauss rule of 1, 2 x 2 or 3 x 3 points. */
static inline double polygon_factor_quad(const double (*v)[3], const double n[3],
                                         const struct polygon *q, int order)
{
    static const double node[3][3] = {{0.5, 0, 0},
                                      {0.21132486540518711775, 0.78867513459481288225, 0},
                                      {0.11270166537925831148, 0.5, 0.88729833462074168852}};
    static const double weight[3][3] = {{1, 0, 0}, {0.5, 0.5, 0}, {5 / 18.0, 8 / 18.0, 5 / 18.0}};
    double sum = 0, at[9][3], share[9], f[9];
    double near[3], far[3]; /* the sides along which s runs, at t = 0 and 1 */
    sub3(near, v[1], v[0]);
    sub3(far, v[2], v[3]);
    int points = 0;
    for (int i = 0; i <= order; i++) {
        double s = node[order][i], low[3], dt[3];
        for (int k = 0; k < 3; k++) {
            low[k] = v[0][k] + s * near[k];
            dt[k] = v[3][k] + s * far[k] - low[k];
        }
        for (int j = 0; j <= order; j++, points++) {
            double t = node[order][j], ds[3], jacobian[3];
            for (int k = 0; k < 3; k++) {
                at[points][k] = low[k] + t * dt[k];
                ds[k] = (1 - t) * near[k] + t * far[k];
            }
            cross3(jacobian, ds, dt);
            share[points] = weight[order][i] * weight[order][j] * dot3(jacobian, n);
        }
    }
    lambert_sums(points, (const double(*)[3])at, n, (const double(*)[3])q->v, q->n, f);
    for (int i = 0; i < points; i++)
        sum += share[i] * f[i];
    return sum;
}

/* The integral over a whole polygon, cut into quads and triangles (m2). */
static inline double polygon_factor_rule(const struct polygon *p, const double n[3],
                                         const struct polygon *q, int order)
{
    const double(*v)[3] = (const double(*)[3])p->v;
    double sum = 0;
    if (p->n != 3)
        sum = polygon_factor_quad(v, n, q, order);
    if (p->n == 3)
        sum = polygon_factor_triangle(v[0], v[1], v[2], n, q, order);
    else if (p->n == 5)
        sum += polygon_factor_triangle(v[0], v[3], v[4], n, q, order);
    return sum;
}

/* The contour integral at a size of about one, so that logarithms round alike at every scale. */
static inline double polygon_factor_contour_at(struct polygon *p, struct polygon *q, double radius,
                                               double area, double error)
{
    int e;
    (void)frexp(radius, &e);
    double up = ldexp(1, e);
    double down = 1 / up;
    polygon_factor_scale(p, down);
    polygon_factor_scale(q, down);
    return contour_factor(p, q, area * down * down, error) * up * up;
}

/* 1: what they exchange is so little, and one has so nearly no part in front of the other's plane,
 * that F is 0, as for coplanar elements, not what sums of nothing leave. A plane is known the worse
 * the narrower its element and the farther off the corner. */
static inline int polygon_factor_hidden(const struct element *r, const struct element *s,
                                        double exchange)
{
    double away[3], width = r->area / r->radius, low, high;
    if (!(exchange < POLYGON_FACTOR_FAINT * (r->area < s->area ? r->area : s->area)))
        return 0;
    sub3(away, s->centre, r->centre);
    double size;
    double reach = size = length3(away) + r->radius + s->radius;
    for (int k = 0; k < 3; k++)
        size += fabs(r->centre[k]) + fabs(s->centre[k]);
    if (s->area / s->radius < width)
        width = s->area / s->radius;
    double flat = POLYGON_FACTOR_FLAT * size * (1 + reach / width);
    plane_side_heights(r, s, &low, &high);
    if (high <= flat)
        return 1;
    plane_side_heights(s, r, &low, &high);
    return high <= flat;
}

/* The normal of an element to clip at. Of a narrow one it is known to few digits across the longest
 * edge and along it, though the edge itself is known to all: it is put at a right angle to the
 * edge, so that a neighbour is not cut at what they share. Not that of a bent element, whose edges
 * are not in its plane. */
static inline void polygon_factor_normal(double n[3], const struct element *e)
{
    double longest[3], square = 0;
    for (int i = 0; i < e->vertices; i++) {
        double side[3];
        sub3(side, e->vertex[i + 1 < e->vertices ? i + 1 : 0], e->vertex[i]);
        double length = dot3(side, side);
        if (length > square) {
            square = length;
            for (int k = 0; k < 3; k++)
                longest[k] = side[k];
        }
    }
    double off = square > 0 ? dot3(e->normal, longest) : 0;
    int bent = off * off > POLYGON_FACTOR_TILT * square;
    for (int k = 0; k < 3; k++)
        n[k] = e->normal[k] - (off != 0 && !bent ? off / square * longest[k] : 0);
}

/* F_rs of two surfaces. `exact`: as many points as give about 1e-9, not 1e-5; where contours are
 * integrated, to `error` of F, by one pair of edges. */
OUTLINE double polygon_factor_within(const struct element *r, const struct element *s, int exact,
                                     double error)
{
    int r_is_small = r->radius < s->radius || (r->radius == s->radius && r->id < s->id);
    const struct element *small = r_is_small ? r : s, *large = r_is_small ? s : r;
    struct polygon p, q;
    double away[3];
    sub3(away, small->centre, large->centre);
    double distance = length3(away) - large->radius;
    if (!exact && distance > POLYGON_FACTOR_FAR * large->radius) {
        double cos_r = -dot3(small->normal, away), cos_s = dot3(large->normal, away),
               square = dot3(away, away);
        if (cos_r >= large->radius && cos_s >= small->radius) /* no part behind the other's plane */
            return cos_r * cos_s * s->area / (LAMBERT_PI * square * square);
    }
    const double *n = small->normal, *m = large->normal;
    double upright[2][3];
    if (exact) {
        polygon_factor_normal(upright[0], small);
        polygon_factor_normal(upright[1], large);
        n = upright[0];
        m = upright[1];
    }
    polygon_clip(&p, (const double(*)[3])small->vertex, small->vertices, large->centre, m);
    polygon_clip(&q, (const double(*)[3])large->vertex, large->vertices, small->centre, n);
    if (p.n == 0 || q.n == 0)
        return 0;
    if (distance < POLYGON_FACTOR_FAR * small->radius)
        distance = polygon_distance(small->centre, (const double(*)[3])q.v, q.n, large->normal);
    double least = r->area < s->area ? r->area : s->area;
    double exchange;
    if (distance <= (exact ? POLYGON_FACTOR_EXACT : POLYGON_FACTOR_NEAR) * small->radius)
        exchange = polygon_factor_contour_at(&p, &q, large->radius, least, error);
    else
        exchange =
            polygon_factor_rule(&p, small->normal, &q,
                                exact || distance <= POLYGON_FACTOR_MIDDLE * small->radius ? 2
                                : distance <= POLYGON_FACTOR_FAR * small->radius           ? 1
                                                                                           : 0);
    if (!(exchange > 0 && least > 0) || polygon_factor_hidden(r, s, exchange))
        return 0;
    return (exchange < least ? exchange : least) / r->area;
}

static inline double polygon_factor(const struct element *r, const struct element *s, int exact)
{
    return polygon_factor_within(r, s, exact, exact ? CONTOUR_FACTOR_EXACT : CONTOUR_FACTOR_FAIR);
}

#endif
