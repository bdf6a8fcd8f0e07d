/* point_gradient.h - how the form factor from a point x to a polygon changes with x (1/m).
 *
 * Lambert's sum (point_factor.h), derived edge by edge: with a, b from x to the edge's ends, c = a
 * x b, s = |c|, t = a.b and D = c.n,
 *     d(theta D / s) = theta/s dD + (t/(s^2+t^2) - theta/s) D/s ds - D/(s^2+t^2) dt,
 *     dD = dx.((a-b) x n),    ds = dx.((a-b) x c)/s,    dt = -dx.(a+b).
 * The clip at the horizon moves with x, but what it adds or takes lies on the horizon, where the
 * integrand is zero: to first order it does nothing. [Arvo 1994, "The irradiance Jacobian";
 * Holzschuch and Sillion 1998]
 * Fails: at the polygon's own edges the gradient has no bound; there the edge is left out.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_POINT_GRADIENT_H
#define KERNEL_POINT_GRADIENT_H

#include "discussion.h"
#include "kernel/point_factor.h"

/* sin t cos t - t, without the loss of digits for small t. */
static inline double point_factor_lag(double t)
{
    double u = t * t;
    if (t < 0.1)
        return t * u * (-2 / 3.0 + u * (2 / 15.0 + u * (-4 / 315.0 + u * (2 / 2835.0))));
    return sin(t) * cos(t) - t;
}

/* F from the point x with normal n to q, negative behind its plane, and its gradient (1/m). */
static inline double point_factor_gradient(const double x[3], const double n[3],
                                           const struct polygon *q, double gradient[3])
{
    double sum = 0, a[3], b[3];
    gradient[0] = gradient[1] = gradient[2] = 0;
    sub3(a, q->v[q->n - 1], x);
    for (int i = 0; i < q->n; i++) {
        double c[3];
        sub3(b, q->v[i], x);
        cross3(c, a, b);
        double s = length3(c);
        double t = dot3(a, b);
        if (s > 0) {
            double angle = plain_angle(s, t);
            double height = dot3(c, n) / s;
            sum += angle * height;
            double e[3];
            sub3(e, a, b);
            double along[3];
            cross3(along, e, n);
            double across[3];
            cross3(across, e, c);
            double whole = dot3(a, a) * dot3(b, b);
            double lag = point_factor_lag(angle) * height / s / s;
            for (int k = 0; k < 3; k++)
                gradient[k] +=
                    angle / s * along[k] + lag * across[k] + height * s / whole * (a[k] + b[k]);
        }
        for (int k = 0; k < 3; k++)
            a[k] = b[k];
    }
    for (int k = 0; k < 3; k++)
        gradient[k] *= -0.5 / LAMBERT_PI;
    return sum * (-0.5 / LAMBERT_PI);
}

#endif
