/* measured_error.h - how far a solution is from the truth, measured by light that is counted; and
 * what it measured used to mend the solution.
 * SPDX-License-Identifier: MIT */
#ifndef MEASURED_ERROR_H
#define MEASURED_ERROR_H

#include "engine/black_backs.h"
#include "engine/dim_faces.h"
#include "engine/element_error.h"
#include "engine/ray_split.h"
#include "engine/face_error.h"
#include "engine/solve.h"

/* What a measurement found of the solution that is shown. */
struct measured_error {
    struct face_error faces;
    struct RadMeasure l2, p999;    /* of surfaces, where they were asked for; else all zero */
    struct element_error elements; /* NULLs until measured_elements makes it of what is counted; and
                                    * for good where leaves were not counted on */
    struct tally tally;
    struct black_backs backs;
    struct dim_count dim;     /* once mended, by measure_and_mend alone: large ones and groups */
    struct dim_count small;   /* likewise: of smaller ones how many are not known, and their area */
    uint32_t gathered;        /* of these groups */
    uint64_t rays, particles; /* particles: paths, where by_paths */
    int by_paths;
    double seconds;
};

/* Measure what solve_shown says by about so many rays, with random numbers of a stream that the
 * solution has not been mended with (any but MEND_STREAM); `what` adds over the surfaces, too, by
 * three fifths of the rays, or leaves out leaves. Returns 0, or -1 with *cause set. */
enum { MEND_STREAM = 0 };
enum { MEASURE_SURFACES = 1, MEASURE_NO_LEAVES = 2 };
int measure_error(struct solve *s, uint64_t rays, uint64_t stream, int what,
                  struct measured_error *m, const char **cause);
/* m->elements, of a solution that has not changed since it was measured. Few ask for it. Returns 0,
 * or -1 when out of memory. */
int measured_elements(const struct solve *s, struct measured_error *m);
void measured_error_free(struct measured_error *m);

/* How far links are off on places of PLACE_SHARE of the area, and particles would be, by about so
 * many rays (ray_split.h). The solution stays as it was. Returns 0, or -1 with *cause set. */
int measure_places(struct solve *s, uint64_t rays, struct ray_split *split, const char **cause);

/* When particles are enough. */
struct mending_goal {
    double noise;    /* theirs in the L1 error of polygons, a share of the reflected light */
    double left;     /* or what mending leaves of that error, the same; 0: not looked at */
    double power;    /* and the standard error of all reflected light, the same; 0: any */
    uint64_t plain;  /* rays, about, before that is looked at */
    uint64_t most;   /* rays, about: no more, whatever they have reached */
    double places;   /* error on places, root mean square as ray_split.h; 0: not looked at */
    uint64_t least;  /* rays, about, before that is looked at */
    double expected; /* rays that may be needed for it; 0: nothing is known */
    double linked;   /* squared error on places of links that these are finer than; 0: not known */
    int own;         /* 1: quarters may stay with the ranks that own their faces (own_quarters.h) */
    int look;        /* 1: polygons that are too dim for particles stay as they are */
};

/* Mend the radiosities of the links, which a mended solution then shows. *alone: the links' error
 * as the same particles measure it. Returns 0, or -1 with *cause set. */
int measure_and_mend(struct solve *s, const struct mending_goal *goal, struct measured_error *alone,
                     const char **cause);

#endif
