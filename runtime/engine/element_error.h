/* element_error.h - where a solution is off: what counted particles surely say of parts of faces.
 * SPDX-License-Identifier: MIT */
#ifndef ELEMENT_ERROR_H
#define ELEMENT_ERROR_H

#include "engine/face_error.h"
#include "engine/operator.h"

/* Of leaves on surfaces, [element * bands + band], W/m2; 0 of all other elements. */
struct element_error {
    double *error; /* mean B less the truth where that stands clear of noise, 0 elsewhere */
    double *limit; /* the modulus of B less the truth is below this, in 95 of 100 */
};

/* Hold irradiance[element * bands + band] (W/m2) against a tally that nothing in it comes from, and
 * that `faces` was made of. Where it has no counts of leaves, faces are told of as a whole. Returns
 * 0, or -1 when out of memory. */
int element_error_open(struct element_error *x, const struct light_operator *op,
                       const struct face_error *faces, const struct tally *tally,
                       const double *irradiance);
void element_error_close(struct element_error *x);

#endif
