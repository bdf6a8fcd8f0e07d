/* geometry.h - vectors, planes and clipped convex polygons, for tools and terms.
 *
 * Every expression here scales exactly: multiplying all coordinates by a power of two changes
 * no comparison and no dimensionless result by a single bit.
 * SPDX-License-Identifier: MIT */
#ifndef GEOMETRY_H
#define GEOMETRY_H

#include <math.h>

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

/* A quad cut by one plane has at most 5 corners. */
enum { POLYGON_MAX = 5 };

struct polygon {
    int n; /* 0, or 3 to POLYGON_MAX */
    double v[POLYGON_MAX][3];
};

/* The part of the convex polygon v[n], n <= 4, in front of the plane (Sutherland-Hodgman). A quad that lies in the plane
 * may cross it four times by rounding: then corners are left out. */
static inline void polygon_clip(struct polygon *out, const double (*v)[3], int n,
                                const double on[3], const double normal[3])
{
    int i, count = 0;
    double h = height3(v[n - 1], on, normal);
    const double *a = v[n - 1];
    for (i = 0; i < n; i++) {
        const double *b = v[i];
        double g = height3(b, on, normal);
        if (((h > 0 && g < 0) || (h < 0 && g > 0)) && count < POLYGON_MAX) {
            double t = h / (h - g);
            out->v[count][0] = a[0] + t * (b[0] - a[0]);
            out->v[count][1] = a[1] + t * (b[1] - a[1]);
            out->v[count][2] = a[2] + t * (b[2] - a[2]);
            count++;
        }
        if (g >= 0 && count < POLYGON_MAX) {
            out->v[count][0] = b[0];
            out->v[count][1] = b[1];
            out->v[count][2] = b[2];
            count++;
        }
        a = b;
        h = g;
    }
    out->n = count < 3 ? 0 : count;
}

/* Area of a convex flat polygon with unit normal n (m2). */
static inline double polygon_area(const struct polygon *p, const double n[3])
{
    double twice = 0;
    int i;
    for (i = 2; i < p->n; i++) {
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
    int i, inside = 1;
    for (i = 0; i < n; i++) {
        const double *a = v[i], *b = v[i + 1 < n ? i + 1 : 0];
        double e[3], w[3], side[3], t, q, ee;
        sub3(e, b, a);
        sub3(w, p, a);
        cross3(side, e, w);
        if (dot3(side, normal) >= 0)
            continue;
        inside = 0;
        ee = dot3(e, e);
        t = ee > 0 ? dot3(w, e) / ee : 0;
        t = t < 0 ? 0 : t > 1 ? 1 : t;
        w[0] -= t * e[0];
        w[1] -= t * e[1];
        w[2] -= t * e[2];
        q = dot3(w, w);
        if (q < best)
            best = q;
    }
    return inside ? fabs(height3(p, v[0], normal)) : sqrt(best);
}

#endif
