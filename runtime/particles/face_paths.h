/* face_paths.h - mean irradiances of faces by paths from points spread over them.
 *
 * How many paths a face gets of so many in all is fixed: by its share, in whole blocks, the first
 * of them by being there. So what has been traced depends on the sum of what was asked for, not on
 * the pieces it was asked in. Even and odd paths are summed up apart: two halves that know nothing
 * of each other. Where sums by replicates are asked for, which tell the noise, those of one go by
 * the points of a sequence, each face's and each replicate's shifted by chance: of a sky that
 * a wall sees a part of, say, that leaves a fraction of the noise. Squares would be blind to it.
 *
 * Invariant: a block is summed up by one thread and blocks in their order, so neither threads nor
 * pieces show.
 * SPDX-License-Identifier: MIT */
#ifndef FACE_PATHS_H
#define FACE_PATHS_H

#include "particles/particles.h"

enum { PATH_BLOCK = 64, PATH_HALVES = 2 };

struct face_paths {
    uint32_t faces, bands;
    uint64_t stream; /* which random numbers */
    uint64_t paths;  /* asked for so far, all faces */
    uint64_t rays;   /* cast for them */
    double *share;   /* [faces]: of all paths; 0: none */
    /* by halves, [faces * bands + band]: of the irradiances h that paths found (W/m2), and of h^2
     */
    double *sum[PATH_HALVES], *square[PATH_HALVES];
    double *replicate[REPLICATES]; /* the same sums of h, by replicates; NULL: not asked for */
};

/* None yet. Faces share paths by (A rho)^(2/3), rho of the strongest band, which gives the sum of
 * A rho times the standard error its least where all are equally noisy; where nothing is reflected
 * none is traced. replicates: 1: sums of these, too. Returns 0, or -1 when out of memory. */
int face_paths_open(struct face_paths *p, const struct tracer *t, uint64_t stream, int replicates);
void face_paths_close(struct face_paths *p);

/* Trace on until `paths` have been asked for in all. watch: NULL, or asked. Returns 0, or -1 when
 * stopped or out of memory: then the sums are of no use. */
int face_paths_trace(struct face_paths *p, const struct tracer *t, uint64_t paths,
                     const struct watch *watch);

/* How many the face has got. */
static inline uint64_t face_paths_count(const struct face_paths *p, uint32_t face, uint64_t paths)
{
    if (!(p->share[face] > 0) || paths == 0)
        return 0;
    uint64_t blocks = (uint64_t)((double)paths * p->share[face] / PATH_BLOCK);
    return PATH_BLOCK * (blocks > 0 ? blocks : 1);
}

/* Mean irradiance of the face in a band (W/m2) by a half, and the variance of that mean. 0 where no
 * path was traced. */
static inline void face_paths_mean(const struct face_paths *p, int half, uint32_t face,
                                   uint32_t band, double *mean, double *variance)
{
    double n = (double)(face_paths_count(p, face, p->paths) / PATH_HALVES);
    size_t at = (size_t)face * p->bands + band;
    *mean = n > 0 ? p->sum[half][at] / n : 0;
    double spread = n > 0 ? p->square[half][at] / n - *mean * *mean : 0;
    *variance = spread > 0 ? spread / (n - 1) : 0;
}

#endif
