/* measured_error.h - how far a solution is from the truth, measured by light that is counted.
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
/* What the tally, which nothing of the shown solution comes from, says of its polygons. Returns 0,
 * or -1 when out of memory. */
int measured_faces(struct solve *s, struct tally *tally, struct measured_error *m);
/* m->elements, of a solution that has not changed since it was measured. Few ask for it. Returns 0,
 * or -1 when out of memory. */
int measured_elements(const struct solve *s, struct measured_error *m);
void measured_error_free(struct measured_error *m);

/* How far links are off on places of PLACE_SHARE of the area, and particles would be, by about so
 * many rays (ray_split.h). The solution stays as it was. Returns 0, or -1 with *cause set. */
int measure_places(struct solve *s, uint64_t rays, struct ray_split *split, const char **cause);

#endif
