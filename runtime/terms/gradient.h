/* gradient.h - term: how F(x), the form factor from a point x of the receiver to the emitter with
 * nothing between, changes with x at the receiver's centre (1/m). A vector in space: its part along
 * the receiver says how F varies over it, its part along the normal what moving the receiver does.
 * Formula and sources: point_gradient.h. 0 where F is 0. Fails: nothing is known of the second
 * derivative, which matters as soon as the two are nearer than a few of the receiver's diameters; F
 * is not differentiable where the centre lies in the emitter's plane.
 * SPDX-License-Identifier: MIT */
#ifndef TERM_GRADIENT_H
#define TERM_GRADIENT_H

#include "discussion.h"
#include "kernel/point_gradient.h"

OUTLINE void gradient_at_centre(const struct element *r, const struct element *s,
                                double gradient[3])
{
    double f = 0;
    struct polygon q;
    point_factor_clip(&q, r, s);
    if (q.n && height3(r->centre, s->centre, s->normal) > 0)
        f = point_factor_gradient(r->centre, r->normal, &q, gradient);
    if (!(f > 0) || polygon_factor_hidden(r, s, f * r->area))
        gradient[0] = gradient[1] = gradient[2] = 0;
}

TOOL const double *term_gradient(struct discussion *d)
{
    if (d->terms.gradient_level < GRADIENT_PRESENT) {
        double gradient[3];
        gradient_at_centre(d->receiver, d->emitter, gradient);
        d->terms.gradient[0] = gradient[0];
        d->terms.gradient[1] = gradient[1];
        d->terms.gradient[2] = gradient[2];
        d->terms.gradient_level = GRADIENT_PRESENT;
    }
    return d->terms.gradient;
}

#endif
