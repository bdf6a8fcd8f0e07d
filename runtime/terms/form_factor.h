/* form_factor.h - term: F_rs, the fraction of the light leaving r that would meet s if nothing
 * stood between, mean over r. Dimensionless, in [0, 1] but for level inverse_square.
 *
 * inverse_square  Lambert's kernel at both centres, cos_r cos_s A_s / (pi d^2), cosines cut off at
 *          0. Fails: near pairs, without bound (unit squares .1 apart: 31.8); elements that cross
 *          each other's planes. [Lambert 1760]
 * disc     the emitter as a disc of its area seen from the receiver's centre,
 *          A_s cos_r cos_s / (pi d^2 + A_s), cosines cut off at 0. Fails: near pairs (+17 % and
 *          more; a wall's strip beside a wide ceiling loses most), so where the bounding spheres
 *          meet the polygon is computed instead; elements that cross each other's planes.
 *          [Hanrahan et al. 1991, section 4; Wallace et al. 1989]
 * hemicube the emitter projected on a hemicube of FORM_FACTOR_PIXELS^2 at the receiver's centre
 *          (hemicube.h). Fails: as one point does; and by its pixels, the more the farther: +-14 %
 *          of F at 11 times the size. [Cohen and Greenberg 1985]
 * point    the point-to-polygon factor at the receiver's centre, the polygon clipped at the
 *          receiver's plane (point_factor.h). Fails: where F varies over the receiver, as all
 *          one-point rules do: -5 % for unit squares at right angles with a common edge, +33 % for
 *          parallel ones at half their side (tests/runtime/check_terms.c).
 *          [Baum et al. 1989]
 * rays     FORM_FACTOR_RAYS_EACH rays from points of the smaller to points of the other, and as
 *          many in directions spread by the cosine (ray_factor.h). No bias but what F <= 1 cuts
 *          off. Fails: by noise, 2 to 3 % near by, 1e-3 far off; beyond 15 sizes point is better.
 *          A_r F_rs = A_s F_sr to rounding. [Veach and Guibas 1995]
 * polygon  both elements clipped at each other's plane, then the mean over the smaller of the
 *          point-to-polygon factor (1/2pi) sum theta_i Gamma_i.n [Lambert 1760; Baum et al. 1989]
 *          by a rule of as many points as the distance asks for; where they are nearer than their
 *          size, the contour integral (1 / 2 pi A_r) oint oint ln r dx_r.dx_s [Sparrow 1963],
 *          closed for parallel edges, else its inner integral closed and the outer one adaptive
 *          (contour_factor.h). Relative error about 1e-5, 4e-4 at the most (far pairs); 1e-6 by
 *          contour. A_r F_rs = A_s F_sr to rounding, since both come from the smaller.
 * contour  the same with the contour integral up to 60 radii away, and nine or more points beyond:
 *          F to 1e-9.
 *
 * The order is that of the error summed over the links of a scene, A_r |F - F*|: of the exchange
 * in the room of examples/scenes 13, 12, 9.9, 9.0, 1.2, .00014 and 3e-10 %, in the same order in
 * cornell and maze_8 (`radiosity study form-factors`). Pair by pair no order holds: far off a
 * hemicube is worse than 1 / d^2, and a disc near by is no better than one point. Nor is it that of
 * cost: rays cost more than the polygon.
 * SPDX-License-Identifier: MIT */
#ifndef TERM_FORM_FACTOR_H
#define TERM_FORM_FACTOR_H

#include "discussion.h"
#include "terms/axis.h"
#include "kernel/constants.h"
#include "kernel/hemicube.h"
#include "kernel/lambert.h"
#include "kernel/point_factor.h"
#include "kernel/polygon_factor.h"
#include "kernel/ray_factor.h"

TOOL double form_factor_inverse_square(struct discussion *d)
{
    const struct element *r = d->receiver, *s = d->emitter;
    return s->area * lambert_points(r->centre, r->normal, s->centre, s->normal, 0);
}

TOOL double form_factor_disc(struct discussion *d)
{
    const struct element *r = d->receiver, *s = d->emitter;
    const double *axis = term_axis(d);
    double square = dot3(axis, axis);
    double cos_r = dot3(r->normal, axis); /* both times the distance */
    double cos_s = -dot3(s->normal, axis);
    if (!(cos_r > 0) || !(cos_s > 0))
        return 0;
    return cos_r * cos_s * s->area / (square * (LAMBERT_PI * square + s->area));
}

TOOL double form_factor_of(struct discussion *d, enum form_factor_level level)
{
    switch (level) {
    case FORM_FACTOR_INVERSE_SQUARE:
        return form_factor_inverse_square(d);
    case FORM_FACTOR_DISC:
        return form_factor_disc(d);
    case FORM_FACTOR_HEMICUBE:
        return hemicube_factor(d->receiver, d->emitter, FORM_FACTOR_PIXELS);
    case FORM_FACTOR_POINT:
        return point_factor(d->receiver, d->emitter);
    case FORM_FACTOR_RAYS:
        return ray_factor(d->receiver, d->emitter, FORM_FACTOR_RAYS_EACH);
    default:
        return polygon_factor(d->receiver, d->emitter, level == FORM_FACTOR_CONTOUR);
    }
}

TOOL double term_form_factor(struct discussion *d, enum form_factor_level level)
{
    if (d->terms.form_factor_level < level) {
        if (level == FORM_FACTOR_DISC) {
            double reach = d->receiver->radius + d->emitter->radius;
            const double *axis = term_axis(d);
            if (dot3(axis, axis) < reach * reach)
                level = FORM_FACTOR_POLYGON;
        }
        d->terms.form_factor = form_factor_of(d, level);
        d->terms.form_factor_level = (unsigned char)level;
    }
    return d->terms.form_factor;
}

#endif
