/* lambert.h - Lambert's kernel: what two pieces of surface exchange.
 *
 * Of points x, y with unit normals n, m, r = y - x, s = r.r, the kernel is (n.r)(-m.r) / (pi s^2),
 * in 1/m2. Of faces, to second order in their size over their distance, it is taken at the
 * centroids and weighted with both faces' second moments M (m2):
 *     pi k = a b / s^2 + a b (12 r.Qr / s^4 - 2 tr Q / s^3) - 4 (a m.M_i r + b n.M_j r) / s^3,   Q
 *     = M_i + M_j,
 * a = n.r, b = m.r, m here the normal of j turned round; n M_i = 0 and m M_j = 0 because faces are
 * flat. What that leaves out is of fourth order.
 * [Taylor's formula for Lambert's kernel, derived here]
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_LAMBERT_H
#define KERNEL_LAMBERT_H

#include "discussion.h"

#define LAMBERT_PI 3.14159265358979323846

/* The kernel of points on front sides, else 0 (1/m2). `spread` (m2), a piece's area, bounds it
 * where pieces touch: no more than about 1 / spread is exchanged. */
static inline double lambert_points(const double x[3], const double n[3], const double y[3],
                                    const double m[3], double spread)
{
    double w[3];
    sub3(w, y, x);
    double cos_x = dot3(n, w);
    double cos_y = -dot3(m, w);
    double square = dot3(w, w);
    return cos_x > 0 && cos_y > 0 ? cos_x * cos_y / (square * (LAMBERT_PI * square + spread)) : 0;
}

/* The form factor from the point x with normal n to a flat convex polygon v[count] in front of it,
 * in (0, 1]; negative seen from its back: -(1/2pi) sum theta_i Gamma_i.n over its edges, theta_i
 * the angle that edge i subtends at x, Gamma_i the unit normal of the plane through x and the edge.
 * [Lambert 1760] */
static inline double lambert_sum(const double x[3], const double n[3], const double (*v)[3],
                                 int count)
{
    double sum = 0, a[3], b[3], c[3];
    if (count < 3)
        return 0;
    sub3(a, v[count - 1], x);
    for (int i = 0; i < count; i++) {
        sub3(b, v[i], x);
        cross3(c, a, b);
        double size = length3(c);
        if (size > 0)
            sum += atan2(size, dot3(a, b)) / size * dot3(c, n);
        for (int k = 0; k < 3; k++)
            a[k] = b[k];
    }
    return sum * (-0.5 / LAMBERT_PI);
}

/* pi k of two faces: a = n.r, b = m.r, t = 1 / s, quad = r.Qr, trace = tr Q, skew = a m.M_i r + b
 * n.M_j r. Inlined always, so that loops over faces run several at a time. */
TOOL double lambert_second_order(double a, double b, double t, double quad, double trace,
                                 double skew)
{
    return t * t * (a * b * (1 + t * (12 * t * quad - 2 * trace)) - 4 * t * skew);
}

#endif
