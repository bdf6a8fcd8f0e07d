/* cause_rays.h - the rays of one point that links are held against.
 * SPDX-License-Identifier: MIT */
#ifndef CAUSE_RAYS_H
#define CAUSE_RAYS_H

#include "engine/cause_sums.h"
#include "engine/link_cover.h"
#include "engine/solve.h"
#include "particles/sobol_sequence.h"
#include "particles/tracer.h"

/* What all rays are cast in. */
struct cause_rays {
    const struct solve *solve; /* borrowed; the separable links have sent its radiosities */
    struct tracer tracer;      /* its exitance: mean radiosities of faces */
    const float *of_one;       /* [separable link]: J of a radiosity of 1 */
};

/* What all rays of a leaf have in common, and where what they find goes. */
struct cause_receiver {
    uint32_t leaf, face;
    double weight;                                 /* of one point */
    double uncovered;                              /* share of the leaf */
    double shown[3], reflectance[3];               /* B - E (W/m2), rho */
    double *to[CAUSE_SUMS][3], *after[CAUSE_SUMS]; /* sums of this replicate */
    double *found;                                 /* [RAD_WAYS]: light, as found by rays */
    /* of the last point that no solid covers, if any: what light reflected there comes to after all
     * reflections, over itself */
    double growth[3];
};

/* Cast the rays of a point, u in [0, 1)^5. Returns how many. */
uint64_t cause_rays_cast(const struct cause_rays *c, const struct link_cover *cover,
                         struct cause_receiver *at, const double u[SOBOL_DIMENSIONS],
                         struct dice *dice);
enum { CAUSE_RAYS = 2 }; /* besides the path that tells the growth */

#endif
