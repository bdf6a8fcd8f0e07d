/* reference.h - what a scene's faces radiate, by chance alone: by particles from the emitters
 * (particles/particles.h) and by paths from the faces (particles/face_paths.h).
 *
 * Neither knows of links, form factors or elements. The two share faces, rays and random numbers,
 * of which they use other ones; what one counts as arriving the other looks for from where it
 * arrives, so that an error in either shows in their difference.
 *
 * Invariant: what has been traced, and its bits, depend on how much was asked for of each in all,
 * where its pieces ended, and on nothing else: a reference that was saved and loaded goes on as if
 * it had not been.
 * SPDX-License-Identifier: MIT */
#ifndef REFERENCE_H
#define REFERENCE_H

#include "engine/solve.h"
#include "particles/face_paths.h"

enum reference_method { REFERENCE_PARTICLES, REFERENCE_PATHS, REFERENCE_BOTH, REFERENCE_METHODS };

struct reference {
    struct solve solve; /* opened, and nothing more: hierarchy, rays, light */
    struct tracer tracer;
    struct tally tally;
    struct face_paths paths;
};

int reference_open(struct reference *r, const struct scene *scene, int threads, struct ranks *ranks,
                   const char **cause);
void reference_close(struct reference *r);

/* Area means of irradiance over polygons, both sides of two-sided ones, in one band, and the
 * variances of these means; [input_count] each (W/m2, squared). By both methods: weighted by
 * what is known of either's noise. INFINITY: the method has traced nothing. Returns 0, or -1 when
 * out of memory. */
int reference_irradiance(const struct reference *r, enum reference_method method, uint32_t band,
                         double *mean, double *variance);

/* The whole, all bands. */
struct reference_summary {
    double emitted;   /* W */
    double reflected; /* W, by both */
    double unseen;    /* W, where that is 0: no more than so much is, 95 % */
    /* sum of A rho times standard error of H (W); INFINITY where nothing is known */
    double noise[REFERENCE_METHODS];
    /* reflected by particles less by paths, and one standard error of that (W); likewise */
    double difference, deviation;
    /* (h - h')^2 over its variance, mean over polygons and bands that both know well: 1, but for
     * chance, and a little more where replicates are few */
    double chi_square;
    uint64_t compared; /* in so many places */
};
int reference_summary(const struct reference *r, struct reference_summary *summary);

/* All that has been traced as bytes, which fit the scene alone. reference_restore returns 0, or -1
 * with the reason, and then nothing has changed. */
size_t reference_state_size(const struct reference *r);
void reference_state(const struct reference *r, unsigned char *bytes);
int reference_restore(struct reference *r, const unsigned char *bytes, size_t size,
                      const char **cause);

#endif
