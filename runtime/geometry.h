/* geometry.h - vectors, planes and clipped convex polygons, for tools and terms.
 *
 * Every expression here scales exactly: multiplying all coordinates by a power of two changes
 * no comparison and no dimensionless result by a single bit.
 * SPDX-License-Identifier: MIT */
#ifndef GEOMETRY_H
#define GEOMETRY_H

#include <math.h>
#include <stddef.h>

/* Products are rounded before they are added, whatever the processor could do at once: clang asks
 * this here of all that follows, gcc is asked by -std=c11 or -ffp-contract=off. */
#ifdef __clang__
#pragma STDC FP_CONTRACT OFF
#endif

static inline double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void sub3(double out[3], const double a[3], const double b[3])
{
    out[0] = a[0] - b[0];
    out[1] = a[1] - b[1];
    out[2] = a[2] - b[2];
}

static inline void cross3(double out[3], const double a[3], const double b[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static inline double length3(const double a[3])
{
    return sqrt(dot3(a, a));
}

/* Signed distance of p from the plane through `on` with unit normal n, positive in front (m). */
static inline double height3(const double p[3], const double on[3], const double n[3])
{
    return n[0] * (p[0] - on[0]) + n[1] * (p[1] - on[1]) + n[2] * (p[2] - on[2]);
}

/* Divide a convex polygon of n corners, `size` coordinates each, by a line or plane over which they
 * have heights h: what lies above goes to `above`, what lies below to `below`, corners at height 0
 * to both; either may be NULL. Returns how many corners are above, and below in *n_below. Each has
 * room for `most`; rounding may make a bent polygon cross more than twice, then corners are left
 * out. [Sutherland and Hodgman 1974] */
static inline int polygon_divide(const double *v, int n, int size, const double *h, int most,
                                 double *above, double *below, int *n_below)
{
    int i, j, up = 0, down = 0;
    for (i = 0, j = n - 1; i < n; j = i++) {
        if ((h[j] > 0 && h[i] < 0) || (h[j] < 0 && h[i] > 0)) {
            const double t = h[j] / (h[j] - h[i]);
            for (int k = 0; k < size; k++) {
                const double x = v[j * size + k] + t * (v[i * size + k] - v[j * size + k]);
                if (above && up < most)
                    above[up * size + k] = x;
                if (below && down < most)
                    below[down * size + k] = x;
            }
            up += up < most;
            down += down < most;
        }
        if (above && h[i] >= 0 && up < most) {
            for (int k = 0; k < size; k++)
                above[up * size + k] = v[i * size + k];
            up++;
        }
        if (below && h[i] <= 0 && down < most) {
            for (int k = 0; k < size; k++)
                below[down * size + k] = v[i * size + k];
            down++;
        }
    }
    if (below)
        *n_below = down;
    return above ? up : 0;
}

/* A quad cut by one plane has at most 5 corners. */
enum { POLYGON_MAX = 5 };

struct polygon {
    int n; /* 0, or 3 to POLYGON_MAX */
    double v[POLYGON_MAX][3];
};

/* The part of the convex polygon v[n], n <= 4, in front of the plane. */
static inline void polygon_clip(struct polygon *out, const double (*v)[3], int n,
                                const double on[3], const double normal[3])
{
    double h[POLYGON_MAX];
    int front = 0;
    for (int i = 0; i < n; i++) {
        h[i] = height3(v[i], on, normal);
        front += h[i] >= 0;
    }
    out->n = n;
    if (front < n)
        out->n = polygon_divide(&v[0][0], n, 3, h, POLYGON_MAX, &out->v[0][0], NULL, NULL);
    else /* most planes cut nothing */
        for (int i = 0; i < n; i++)
            for (int k = 0; k < 3; k++)
                out->v[i][k] = v[i][k];
    if (out->n < 3)
        out->n = 0;
}

/* Area of a convex flat polygon with unit normal n (m2). */
static inline double polygon_area(const struct polygon *p, const double n[3])
{
    double twice = 0;
    for (int i = 2; i < p->n; i++) {
        double a[3], b[3], c[3];
        sub3(a, p->v[i - 1], p->v[0]);
        sub3(b, p->v[i], p->v[0]);
        cross3(c, a, b);
        twice += dot3(c, n);
    }
    return 0.5 * twice;
}

/* Distance from p to the convex polygon v[n] with unit normal `normal` (m). */
static inline double polygon_distance(const double p[3], const double (*v)[3], int n,
                                      const double normal[3])
{
    double best = INFINITY;
    int inside = 1;
    for (int i = 0; i < n; i++) {
        const double *a = v[i], *b = v[i + 1 < n ? i + 1 : 0];
        double e[3], w[3], side[3];
        sub3(e, b, a);
        sub3(w, p, a);
        cross3(side, e, w);
        if (dot3(side, normal) >= 0)
            continue;
        inside = 0;
        double ee = dot3(e, e);
        double t = ee > 0 ? dot3(w, e) / ee : 0;
        t = t < 0 ? 0 : t > 1 ? 1 : t;
        w[0] -= t * e[0];
        w[1] -= t * e[1];
        w[2] -= t * e[2];
        double q = dot3(w, w);
        if (q < best)
            best = q;
    }
    return inside ? fabs(height3(p, v[0], normal)) : sqrt(best);
}

#endif
