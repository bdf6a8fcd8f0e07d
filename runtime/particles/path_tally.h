/* path_tally.h - what faces receive by paths, told as a tally of particles tells it.
 * SPDX-License-Identifier: MIT */
#ifndef PATH_TALLY_H
#define PATH_TALLY_H

#include "particles/face_paths.h"

/* The tally has replicates of faces, which are those of paths, and counts on no leaves. What chance
 * would make of it is that of as many particles as there are paths, which is no more than a guess:
 * replicates tell its noise. */
struct path_tally {
    struct face_paths paths;
    struct tally tally;
};

/* None yet. Returns 0, or -1 when out of memory; close is fine then too. */
int path_tally_open(struct path_tally *y, const struct tracer *t, uint64_t stream);
void path_tally_close(struct path_tally *y);

/* Trace on until `paths` have been asked for in all (face_paths_trace). Faces that reflect nothing
 * have none, and are said to receive irradiance[element * bands + band] (W/m2). watch: NULL, or
 * asked. Returns 0, or -1 when stopped or out of memory. */
int path_tally_trace(struct path_tally *y, const struct tracer *t, const double *irradiance,
                     uint64_t paths, const struct watch *watch);
/* The same until about so many rays are cast. */
int path_tally_trace_rays(struct path_tally *y, const struct tracer *t, const double *irradiance,
                          uint64_t rays, const struct watch *watch);

#endif
