/* dim_faces.h - polygons that are too dim or too small for particles to know, looked at from
 * themselves.
 * SPDX-License-Identifier: MIT */
#ifndef DIM_FACES_H
#define DIM_FACES_H

#include "engine/dim_paths.h"
#include "engine/solve.h"
#include "particles/particles.h"
#include "particles/watch.h"
#include "radiosity.h"

/* Polygons or groups of the size that was asked for, which reflect; and how many of them have a
 * standard error above DIM_GOAL of their light, after all: these, by number, groups by their first
 * face's polygon. */
struct dim_count {
    uint32_t large, unsure, named[RAD_UNSURE_NAMED];
    double area; /* of those (m2) */
};

/* Rays, about, that may be cast at the most. */
struct dim_budget {
    double paths; /* for paths; */
    double surer; /* for these, where more of them make those surer that are known; no fewer */
    double both;  /* for paths and particles that are split; no fewer than mending took, or none */
};

/* Irradiances of the mended solution s->mended, which `tally` has mended, are set anew: those of
 * polygons of that size whose reflected light the tally knows to no better than DIM_GOAL, where
 * these are many than one in which none is off by much, by paths from their points, and where these
 * do not know it either by particles that are split; all others by what these say of them, if there
 * are any, and by one factor per band, so that the scene receives what it did. Of small ones no
 * more are asked, the largest, than so many rays can tell; but all are counted that are not known,
 * neither by the tally, nor by what mending leaves of their error, nor by paths. Radiosities are
 * the caller's to set. *rays is raised by what is cast; without such polygons nothing is. watch:
 * NULL, or asked. *count: what is known then. band_noise (face_error.h): of what has mended, and
 * then of what was split as well. Returns how many polygons were changed, or -1 when out of memory
 * or stopped. */
int dim_faces_mend(struct solve *s, const struct tracer *t, const struct tally *tally,
                   enum dim_size size, const struct dim_budget *budget, const struct watch *watch,
                   uint64_t *rays, struct dim_count *count, double band_noise[3]);

/* Take those of c, other polygons than *to has, into *to. */
void dim_count_add(struct dim_count *to, const struct dim_count *c);

#endif
