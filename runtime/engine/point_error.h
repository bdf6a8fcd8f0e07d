/* point_error.h - how far a radiosity is from the truth at a point, without bias, in two
 * independent halves: the product of both is the square of the error in the mean, however noisy
 * they are.
 *
 * e = B~ - E - rho (D + R), D the irradiance straight from emitters (paths.h), R that of light
 * reflected before. For R directions by the cosine ask the solution itself what comes from where
 * they end, mended by the error that particles have measured there, each half by particles of its
 * own. Paths that go on until they die would be free of any bias, but one of them is as noisy as H
 * itself, ten times the error that is looked for; mended radiosities are smooth.
 *
 * They are mended over the smallest part of the tree, a cluster or a part of a face, that enough
 * particles should have met. What its errors have of structure within that part is left in R; the
 * directions average it, and it falls with the number of particles.
 *
 * Directions and points of emitters are spread evenly by a lattice of generalized golden ratios
 * [Roberts 2018], shifted at random [Cranley and Patterson 1976].
 * SPDX-License-Identifier: MIT */
#ifndef POINT_ERROR_H
#define POINT_ERROR_H

#include "engine/error_places.h"
#include "engine/solve.h"
#include "particles/particles.h"
#include "particles/paths.h"

enum { HALVES = 2 };

struct point_sample {
    double solved[3];        /* B~ - E (W/m2) */
    double error[HALVES][3]; /* e, by each half */
};

struct point_error {
    const struct solve *solve;
    const struct tracer *tracer;
    const struct element_light *light; /* B~ */
    /* [element * bands + band]: what leaves reflect once mended, the mean of B - E, by each half's
     * particles; slopes are those of B~ */
    double *reflected[HALVES];
    /* of a half's particles: square of the relative standard error of the light they have reflected
     * in all, mean of both */
    double variance;
};

/* Trace particles of two streams by about so many rays; *rays: added to. Returns 0, or -1 when out
 * of memory or stopped by `watch` (may be NULL). */
int point_error_open(struct point_error *x, const struct solve *s, const struct tracer *t,
                     const struct element_light *light, uint64_t budget, uint64_t stream,
                     const struct watch *watch, uint64_t *rays);
void point_error_close(struct point_error *x);

/* The error at a place by so many directions and points of emitters in each half; adds to *rays.
 * Thread-safe. Returns 0, or 1 when a solid covers it: nothing is measured there. */
int point_error_measure(const struct point_error *x, const struct place *at,
                        const struct path_rays *count, struct dice *dice, struct point_sample *out,
                        uint64_t *rays);

#endif
