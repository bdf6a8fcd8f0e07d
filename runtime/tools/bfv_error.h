/* bfv_error.h - question: may the irradiance of this link, F V B_s, be wrong by more than the
 * limit? W/m2.
 *
 * err = (V dF + dV (F + dF)) B_s. F is the mean and dF the largest deviation of F(x_k) over the
 * receiver's centre and corners, each the sum over the emitter's four quarters as discs, A_q cos
 * cos / (pi d^2 + A_q); dV = 1 where some rays arrive and others do not, else 1/10, also where none
 * arrives: a few rays are not believed. The limit is the larger of `absolute` and `relative` times
 * the scene's mean irradiance. [bf_error_analysis of the Stanford radiosity program in SPLASH-3,
 * which halves the limit for a receiver with more than ten links: a tool cannot count them, so the
 * limit stays]
 * Fails: no reflectance in it, so black receivers are refined like white ones; half shadow costs
 * the full error however little of the light passes; where the elements touch dF does not shrink.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_BFV_ERROR_H
#define TOOL_BFV_ERROR_H

#include "discussion.h"
#include "kernel/constants.h"
#include "kernel/lambert.h"
#include "kernel/threshold.h"
#include "terms/visibility.h"

/* F from x, with normal n, to the four quarters of s. A corner's quarter has its centre half way
 * to the corner. */
static inline double bfv_error_at(const double x[3], const double n[3], const struct element *s)
{
    double sum = 0, area = 0.25 * s->area;
    for (int i = 0; i < 4; i++) {
        double v[3];
        for (int k = 0; k < 3; k++)
            v[k] = s->centre[k] + (i < s->vertices ? 0.5 * (s->vertex[i][k] - s->centre[k]) : 0)
                   - x[k];
        double cos_r = dot3(n, v); /* both times the distance */
        double cos_s = -dot3(s->normal, v);
        double square = dot3(v, v);
        if (cos_r > 0 && cos_s > 0)
            sum += cos_r * cos_s * area / (square * (LAMBERT_PI * square + area));
    }
    return sum < 1 ? sum : 1;
}

OUTLINE void bfv_error_factors(const struct element *r, const struct element *s, double *mean,
                               double *spread)
{
    double f[5];
    *mean = f[4] = bfv_error_at(r->centre, r->normal, s);
    for (int i = 0; i < r->vertices; i++)
        *mean += f[i] = bfv_error_at(r->vertex[i], r->normal, s);
    *mean /= r->vertices + 1;
    *spread = fabs(f[4] - *mean);
    for (int i = 0; i < r->vertices; i++)
        *spread = fabs(f[i] - *mean) > *spread ? fabs(f[i] - *mean) : *spread;
}

TOOL enum bfv_error_answer tool_bfv_error(struct discussion *d, double absolute, double relative)
{
    double limit = threshold(absolute, relative, d->host->irradiance),
           v = term_visibility(d, VISIBILITY_RAYS_16);
    double f, df;
    bfv_error_factors(d->receiver, d->emitter, &f, &df);
    return (v * df + (v > 0 && v < 1 ? 1 : BFV_ERROR_DOUBT) * (f + df)) * d->emitter->radiosity
                   > limit
               ? BFV_ERROR_ABOVE
               : BFV_ERROR_BELOW;
}

#endif
