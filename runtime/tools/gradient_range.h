/* gradient_range.h - question: by how much does what the link brings vary over the receiver, by
 * derivatives? W/m2.
 *
 * rho_r B_s V (|g| D + 2 c) against the larger of `absolute` and `relative` times the scene's mean
 * radiosity. g: the part along the receiver of the gradient of F at its centre (1/m); D: its
 * diameter, twice the bounding radius; c: how far F at the corners is from the plane that g spans,
 * in place of the second derivative, |Hess F| D^2 / 8, which is what it is while F is nearly
 * quadratic; V: the visibility where known, else 1. Where rho_r e_s V F, with e_s the spread of B
 * over the emitter, is above the limit and the larger of the two, the emitter is to be split.
 * [after Gortler et al. 1993 and Holzschuch and Sillion 1998; c derived here]
 * Fails: where elements touch F has no gradient: ask near() first; it takes corners and centre for
 * the whole; no shadow has a gradient in it.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_GRADIENT_RANGE_H
#define TOOL_GRADIENT_RANGE_H

#include "discussion.h"
#include "kernel/constants.h"
#include "kernel/threshold.h"
#include "terms/form_factor.h"
#include "terms/gradient.h"

/* c above, given g. */
OUTLINE double gradient_range_bend(const struct element *r, const struct element *s,
                                   const double g[3])
{
    double most = 0;
    struct polygon q;
    point_factor_clip(&q, r, s);
    double centre = point_factor_at(r->centre, r, s, &q);
    for (int i = 0; i < r->vertices; i++) {
        double x[3], w[3];
        sub3(w, r->vertex[i], r->centre);
        for (int k = 0; k < 3; k++)
            x[k] = r->centre[k] + (1 - CORNER_INSET) * w[k];
        double off = fabs(point_factor_at(x, r, s, &q) - centre - dot3(g, w));
        most = off > most ? off : most;
    }
    return most;
}

TOOL enum gradient_range_answer tool_gradient_range(struct discussion *d, double absolute,
                                                    double relative)
{
    const struct element *r = d->receiver, *s = d->emitter;
    double limit = threshold(absolute, relative, d->host->radiosity), scale = r->reflectance;
    if (d->terms.visibility_level > VISIBILITY_ABSENT)
        scale *= d->terms.visibility;
    if (!(scale * (s->radiosity + s->spread) > limit)) /* no F varies by more than 1 */
        return GRADIENT_RANGE_SMALL;
    const double *g = term_gradient(d);
    double along = dot3(g, r->normal);
    along = dot3(g, g) - along * along;
    double shape = (along > 0 ? 2 * r->radius * sqrt(along) : 0) + 2 * gradient_range_bend(r, s, g);
    shape = scale * s->radiosity * (shape < 1 ? shape : 1);
    double light = scale * s->spread * term_form_factor(d, FORM_FACTOR_POLYGON);
    if (!(shape > limit) && !(light > limit))
        return GRADIENT_RANGE_SMALL;
    return shape >= light ? GRADIENT_RANGE_RECEIVER : GRADIENT_RANGE_EMITTER;
}

#endif
