/* problem.h - what is solved, and how: the scene's light and the caller's options.
 *
 * Invariant: nothing in it changes once solve_open has returned.
 * SPDX-License-Identifier: MIT */
#ifndef PROBLEM_H
#define PROBLEM_H

#include <stdint.h>
#include "engine/camera.h"
#include "engine/closure.h"
#include "engine/limits.h"
#include "hierarchy/scene.h"
#include "radiosity.h"
#include "util/ranks.h"
#include "visibility/rays.h"

struct solve;

/* What solves of one scene by the same options, one after the other, need not find anew. */
struct handed_on {
    /* [face_count]: how much of each face nothing stands on, as far as they have found it, else
     * NAN; refinement adds to it. NULL: nobody keeps it */
    double *uncovered;
    /* between solves, rays over this hierarchy, and both as they were built: solve_open takes them,
     * solve_hand_on gives them back. rays NULL: there are none now */
    struct hierarchy hierarchy;
    struct rays *rays;
};

struct solve_options {
    /* relative L1 error of B that iteration may leave; 0: a tenth of what constants on leaves
     * leave (transport.h) */
    double tolerance;
    int iterations; /* sweeps per solve at the most */
    enum RadSolver solver;
    enum RadProjection projection;
    int threads;
    /* none: rows above 1 are capped, each face keeping its power (row_sums.c); or rows */
    enum closure closure;
    int clusters; /* 1 + the strategy that groups faces; 0: the default */
    /* whose picture counts, for oracles that read importance; NULL: all places alike */
    const struct camera *camera;
    int linear;    /* 1: once links are final, solve for functions linear over each element */
    int no_links;  /* 1: particles alone tell how light goes (ambient.h) */
    int unit;      /* ignore the materials: every face has B = 1 and stays so (view factors) */
    int all_sides; /* sides that no light comes to are not told apart (lit_faces.h) */
    struct limits limits;        /* of refinement */
    struct handed_on *handed_on; /* NULL: nobody solves before or after */
    struct ranks *ranks; /* processes that solve it together, all with these options; NULL: one */
    /* NULL: none; nonzero cancels */
    int (*progress)(void *context, const struct solve *solve, const char *phase);
    void *context; /* of progress */
};

struct problem {
    const struct scene *scene; /* borrowed */
    struct solve_options options;
    uint32_t bands;                 /* 1 or 3 */
    double *exitance, *reflectance; /* [face * bands + band]: E (W/m2), rho */
    double *whitest;                /* [face]: rho of the band where it is largest */
    int reflects;                   /* 0: no light is reflected, that is sure (lights_reach.h) */
    struct rays *rays;
    int closed;           /* with closure: 1 when no light leaves the scene (enclosure.c), else 0 */
    uint64_t closed_rays; /* the rays that say so */
};

#endif
