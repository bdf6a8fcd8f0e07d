/* solve.h - from a scene to radiosity: refine, solve, refine again with the new radiosities.
 * SPDX-License-Identifier: MIT */
#ifndef SOLVE_H
#define SOLVE_H

#include <stdio.h>
#include "engine/separable_links.h"
#include "hierarchy/hierarchy.h"
#include "visibility/rays.h"
#include "engine/refine.h"
#include "hierarchy/scene.h"
#include "engine/solution.h"
#include "engine/camera.h"

struct solve;

/* What is done about rows, the sums of F V over what a leaf sees (rows.c). */
enum closure {
    CLOSURE_NONE, /* rows above 1 are capped, each face keeping its power */
    CLOSURE_ROWS  /* every row is 1 in a closed scene, at most 1 in an open one */
};

struct solve_options {
    double tolerance; /* relative L1 error of B that iteration may leave, > 0 */
    int iterations;   /* sweeps per solve at the most */
    int jacobi;       /* Jacobi sweeps instead of block Gauss-Seidel */
    int threads;
    enum closure closure;
    int clusters; /* 1 + the strategy that groups faces; 0: the default */
    const struct camera *camera; /* whose picture counts, for oracles that read importance; NULL: every place counts alike */
    int unit;         /* ignore the materials: every face has B = 1 and stays so (view factors) */
    int (*progress)(void *context, const struct solve *solve, const char *phase); /* anything but 0 cancels */
    void *context; /* of progress, which may be NULL */
};

/* Seconds by the clock in each phase. */
struct solve_seconds {
    double build, refine, iterate, in_rays; /* in_rays: inside Embree, mean over threads, part of refine */
};

/* What the view makes of light (importance.c): [room], element by element. */
struct importance {
    double *response;   /* r, the share that is in the picture */
    double *source, *carried, *irradiance; /* rho r, Z = rho Y, and what Z irradiates */
    double *value;      /* Y */
    uint32_t room, started;
    int sweeps;         /* 0: no importance was asked for */
    double largest, mean; /* of Y over the leaves, the mean by area */
    double seen;        /* area in the picture (m2) */
};

/* The mark by which graphs say that a link was too large and could not be split (runtime/tools/mark.h). */
enum { LINK_GUARDED = 1 };

/* Error control (allowance.c). */
struct defect;
struct allowance {
    double target;     /* the error of radiosity to be held (W/m2); 0: nobody asked */
    struct defect *defect; /* [room]: of the leaves */
    uint32_t room;
    double largest;    /* of the estimates (W/m2) */
    double area;       /* of the leaves whose estimate is above the target (m2) */
};

struct solve {
    struct scene const *scene; /* borrowed */
    struct solve_options options;
    struct hierarchy hierarchy;
    struct rays *rays;
    struct refinement refinement;
    struct cluster_light cluster_light;
    uint32_t bands;
    double *radiosity, *irradiance; /* [room * bands], element by element */
    double *exitance, *reflectance; /* [face_count * bands] */
    double *whitest;                /* [face_count]: reflectance of the largest band */
    struct importance importance;
    struct allowance allowance;
    double *least, *most;           /* [room * bands]: smallest and largest radiosity of the exposed leaves below */
    unsigned char *changed;         /* [room]: the oracles see a radiosity or spread that has grown since the links were discussed */
    uint32_t room;                  /* elements that the arrays above have place for */
    uint32_t started;               /* elements whose radiosity has a value */

    uint32_t leaves;
    int passes, sweeps;      /* solves, and sweeps of all of them */
    int refined, settled;    /* the links are there; so few changed that the next solve may be the last */
    int cancelled;           /* by options.progress: everything is as far as it came, and no further */
    uint64_t changing;       /* links that the last pass changed */
    int converged;           /* the last solve reached the tolerance and changed no link */
    double residual;         /* of the last sweep: sum A |dB| / sum A B over leaves */
    double emitted, absorbed; /* W, all bands */
    double *exposed;          /* [room]: the share of the element that is not buried in a solid */
    double *row_scale;        /* [room]: leaves only, the factor for what comes over its own links */
    double *row_above;        /* [room]: leaves only, the factor for what comes over those of the elements above it */
    double *row_gift;         /* [room]: leaves only, its share of the power capped off its face, or under closure of the
                                 irradiance of its face when it has no row of its own, per area (1/m2) */
    double row_low, row_high; /* smallest and largest sum of F V over a leaf's links, before the cap; 1 in a closed scene */
    double row_defect, row_defect_most; /* |row - 1| before the cap or closure, per exposed area: mean and largest */
    double row_blind;         /* exposed leaves without any link (m2) */
    int closed;               /* with closure: 1 when no ray leaves the scene (enclosure.c), else 0 */
    uint64_t closed_rays;     /* the rays that say so */
    double row_excess;        /* what the cap moved: sum A (row - 1) over rows above 1, as a share of the scene's area */
    struct solve_seconds seconds;
};

/* Build hierarchy and rays over the scene, set B = E. Returns 0; on failure -1 with *cause set and nothing to free. */
int solve_open(struct solve *s, const struct scene *scene, const struct solve_options *options, const char **cause);

/* Refine with `refiner` and solve until no link changes and iteration error is below tolerance.
 * Returns 0, or -1 with *cause set. */
int solve_run(struct solve *s, const struct refiner *refiner, const char **cause);

/* One pass: refine from the root when there are no links yet, solve over them, discuss them again. Returns 1 while links
 * changed and passes are left, 0 when it was the last, -1 with *cause set. */
int solve_step(struct solve *s, const struct refiner *refiner, const char **cause);

/* Refine once from the root, without solving. */
int solve_refine(struct solve *s, const struct refiner *refiner, const char **cause);

struct solution solve_solution(const struct solve *s);
void solve_close(struct solve *s);

#endif
