/* element_light.h - the radiosity that a solution has at a point of a surface: constant on each
 * leaf, or linear (linear_solution.h).
 * SPDX-License-Identifier: MIT */
#ifndef ELEMENT_LIGHT_H
#define ELEMENT_LIGHT_H

#include "engine/solve.h"

/* B(x) = mean + gradient . (x - centroid) on a leaf. */
struct element_light {
    const struct element *elements;
    uint32_t bands;
    const double *mean;     /* [element * bands + band] (W/m2) */
    const double *gradient; /* [(element * bands + band) * 3] (W/m2 per m); NULL: 0 */
};

/* Of the solution that is shown. */
static inline struct element_light element_light_shown(const struct solve *s)
{
    return (struct element_light){s->hierarchy.elements, s->problem.bands,
                                  solve_shown(s)->radiosity, solve_gradient(s)};
}

/* What B at p is above the mean of the leaf; p may be off the leaf's plane, for gradients lie in
 * it. */
static inline double element_light_slope(const struct element_light *l, uint32_t leaf,
                                         uint32_t band, const double p[3])
{
    double away[3];
    if (!l->gradient)
        return 0;
    sub3(away, p, l->elements[leaf].centre);
    return dot3(&l->gradient[3 * ((size_t)leaf * l->bands + band)], away);
}

static inline double element_light_at(const struct element_light *l, uint32_t leaf, uint32_t band,
                                      const double p[3])
{
    return l->mean[(size_t)leaf * l->bands + band] + element_light_slope(l, leaf, band, p);
}

#endif
