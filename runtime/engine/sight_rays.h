/* sight_rays.h - which share of what two faces would exchange arrives, by rays.
 * SPDX-License-Identifier: MIT */
#ifndef SIGHT_RAYS_H
#define SIGHT_RAYS_H

#include "discussion.h"

/* In [0, 1], by so many rays, SOBOL_MOST at the most; *error: the standard error of that. The same
 * for both orders of the faces. */
double sight_rays(const struct element *r, const struct element *s, const struct host *host,
                  int rays, double *error);

/* What so many rays leave of a clear view (m2); *error: the standard error of that (m2). */
double sight_rays_leave(const struct element *r, const struct element *s, const struct host *host,
                        int rays, double clear, double *error);

#endif
