/* element_distance.h - between which distances do the points of two elements lie (m)?
 *
 * Surfaces: exact to rounding, 0 where they meet: the least distance of convex polygons is between
 * a corner and a polygon or between two edges, or an edge meets a polygon; the largest is between
 * corners [Ericson 2005, section 5.1]. Clusters, and what stands beside one: of their boxes and
 * spheres.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_ELEMENT_DISTANCE_H
#define KERNEL_ELEMENT_DISTANCE_H

#include "discussion.h"
#include "kernel/constants.h"

/* The element's box along the axes. */
static inline void distance_box(const struct element *e, double low[3], double high[3])
{
    int n = e->vertices ? e->vertices : 2;
    for (int k = 0; k < 3; k++) {
        low[k] = high[k] = e->vertex[0][k];
        for (int i = 1; i < n; i++) {
            low[k] = e->vertex[i][k] < low[k] ? e->vertex[i][k] : low[k];
            high[k] = e->vertex[i][k] > high[k] ? e->vertex[i][k] : high[k];
        }
    }
}

/* Square of the distance between the segments a, a + u and b, b + v (m2). */
static inline double distance_edges(const double a[3], const double u[3], const double b[3],
                                    const double v[3])
{
    double w[3], uu = dot3(u, u), vv = dot3(v, v), uv = dot3(u, v);
    sub3(w, a, b);
    double uw = dot3(u, w);
    double vw = dot3(v, w);
    double whole = uu * vv - uv * uv;
    double s = whole > 0 ? (uv * vw - vv * uw) / whole : 0;
    s = s > 0 ? s < 1 ? s : 1 : 0;
    double t = vv > 0 ? (uv * s + vw) / vv : 0;
    if (!(t > 0 && t < 1)) {
        t = t > 0 ? 1 : 0;
        s = uu > 0 ? (uv * t - uw) / uu : 0;
        s = s > 0 ? s < 1 ? s : 1 : 0;
    }
    w[0] += s * u[0] - t * v[0];
    w[1] += s * u[1] - t * v[1];
    w[2] += s * u[2] - t * v[2];
    return dot3(w, w);
}

/* The least distance of a's corners, and of the points where its edges meet b's plane, from the
 * polygon b. */
static inline double distance_corners(const struct element *a, const struct element *b)
{
    const double(*v)[3] = (const double(*)[3])b->vertex;
    double least = INFINITY;
    for (int i = 0; i < a->vertices; i++) {
        const double *p = a->vertex[i], *q = a->vertex[i + 1 < a->vertices ? i + 1 : 0];
        double d = polygon_distance(p, v, b->vertices, b->normal);
        double g = height3(p, b->centre, b->normal), h = height3(q, b->centre, b->normal);
        least = d < least ? d : least;
        if ((g > 0 && h < 0) || (g < 0 && h > 0)) {
            double x[3];
            for (int k = 0; k < 3; k++)
                x[k] = p[k] + g / (g - h) * (q[k] - p[k]);
            d = polygon_distance(x, v, b->vertices, b->normal);
            least = d < least ? d : least;
        }
    }
    return least;
}

static inline void distance_surfaces(const struct element *r, const struct element *s,
                                     double range[2])
{
    double least = INFINITY, most = 0, d;
    for (int i = 0; i < r->vertices; i++)
        for (int j = 0; j < s->vertices; j++) {
            double u[3], v[3], w[3];
            sub3(u, r->vertex[i + 1 < r->vertices ? i + 1 : 0], r->vertex[i]);
            sub3(v, s->vertex[j + 1 < s->vertices ? j + 1 : 0], s->vertex[j]);
            sub3(w, s->vertex[j], r->vertex[i]);
            d = distance_edges(r->vertex[i], u, s->vertex[j], v);
            least = d < least ? d : least;
            d = dot3(w, w);
            most = d > most ? d : most;
        }
    range[0] = sqrt(least);
    range[1] = sqrt(most);
    d = distance_corners(r, s);
    range[0] = d < range[0] ? d : range[0];
    d = distance_corners(s, r);
    range[0] = d < range[0] ? d : range[0];
}

OUTLINE void distance_bound(const struct element *r, const struct element *s, double range[2])
{
    if (r->vertices && s->vertices) {
        distance_surfaces(r, s, range);
    } else {
        double low_r[3], high_r[3], low_s[3], high_s[3], v[3], least = 0, most = 0,
                                                               reach = r->radius + s->radius;
        distance_box(r, low_r, high_r);
        distance_box(s, low_s, high_s);
        for (int k = 0; k < 3; k++) {
            double below = low_r[k] - high_s[k], above = low_s[k] - high_r[k];
            double gap = below > above ? below : above, span = below < above ? -below : -above;
            least += gap > 0 ? gap * gap : 0;
            most += span * span;
        }
        sub3(v, s->centre, r->centre);
        double d = length3(v);
        range[0] = sqrt(least) > d - reach ? sqrt(least) : d - reach;
        range[1] = sqrt(most) < d + reach ? sqrt(most) : d + reach;
    }
    range[0] -= DISTANCE_ROUNDING * range[1];
    range[0] = range[0] > 0 ? range[0] : 0;
    range[1] += DISTANCE_ROUNDING * range[1];
}

#endif
