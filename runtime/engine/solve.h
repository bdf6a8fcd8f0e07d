/* solve.h - from a scene to radiosity: refine, solve, refine again with the new radiosities.
 * SPDX-License-Identifier: MIT */
#ifndef SOLVE_H
#define SOLVE_H

#include "engine/bracket.h"
#include "engine/error_control.h"
#include "engine/importance.h"
#include "engine/linear_solution.h"
#include "engine/mended_reach.h"
#include "engine/operator.h"
#include "engine/oracle_inputs.h"
#include "engine/problem.h"
#include "engine/ranking.h"
#include "engine/refine.h"
#include "engine/row_sums.h"
#include "hierarchy/quarters.h"

/* The solution so far, element by element: [element * bands + band]. */
struct state {
    double *radiosity, *irradiance; /* B, H (W/m2) */
};

/* What refinement has come to so far, on all ranks together; of nothing but numbers of 64 bits. */
struct pass_counts {
    uint64_t links, pairs, rays, decided[8], marked[LINK_MARKS];
    /* a sum over the links, each by what it links and what it says of it: equal where all are */
    uint64_t fingerprint;
};

/* What became of it, for people; nothing is computed from it but from its counts. */
struct report {
    int passes, sweeps; /* solves, and sweeps of all of them */
    /* the last solve reached the tolerance, and no link changes any more; with linear elements few
     * do (SETTLED) */
    int converged;
    uint64_t changing; /* links that the last pass changed */
    struct pass_counts counts;
    uint64_t rounds;    /* of the rank that took the most */
    uint64_t held;      /* elements that this process has had, at the most */
    uint64_t particles; /* a sum over what has been counted, as that of the links; 0: nothing */
    /* of the last sweep of radiosity: sum A |dB| / sum A B over leaves */
    double residual;
    /* of the last solve: the bound on what iteration left, relative; the tolerance it was held
     * against; and what constants leave, where the tolerance was made by that (transport.h) */
    double bound, tolerance, variation;
    double emitted, absorbed; /* W, all bands */
    struct row_report rows;
    /* By the clock; in_rays: inside Embree, mean over threads, part of refine; clusters: the tree
     * above the faces, part of build. */
    struct {
        double build, refine, iterate, in_rays, clusters;
    } seconds;
    int cancelled; /* by the progress function */
};

/* How far particles are: rays that they have taken, and the share that is done, about. */
struct counting {
    uint64_t rays;
    double share;
};

/* Who may write what stands in the signatures: functions take the parts they change, and the others
 * const. The parts point at each other, so a solve stays where it was opened. */
struct solve {
    struct problem problem; /* fixed by solve_open */
    /* grows with refinement; what oracles see of elements is set by what computes it */
    struct hierarchy hierarchy;
    struct refinement refinement; /* links and the queue of pairs */
    /* of several ranks, those of which each has its own (own_quarters.h); where faces are dealt
     * out by these, how they are by links: [ranks + 1] */
    struct quarters quarters;
    size_t *stretch;
    struct light_operator operator;
    struct state state;
    struct state mended;       /* of state, by particles (measured_error.h); NULLs: it is not */
    double *mended_gradient;   /* of linear.gradient, to go with it; NULL: none */
    int by_paths;              /* what is mended is so by paths, and is measured by them */
    struct mended_reach reach; /* of what is mended */
    struct oracle_inputs inputs;
    struct importance importance;
    struct error_control error;
    struct bracket bracket;
    struct ranking ranking;
    int bends;                     /* the oracle reads how light bends over receivers (bends.h) */
    struct linear_solution linear; /* with options.linear, once the solve is done */
    struct report report;
    struct trace *trace; /* whoever is told of discussions, borrowed; NULL: nobody */
    /* called by solve_run before each pass but the first refinement; nonzero cancels; NULL: none */
    int (*between)(void *context);
    void *between_context;
    const struct counting *counting; /* NULL: no particles are traced now */
    double told;                     /* the most rays that counting has told of */
    double linked; /* squared error on places of links that these are finer than; 0: not known */
    /* elements that the arrays have place for, and whose radiosity has a value */
    size_t capacity;
    uint32_t started;
    /* what keeps its solver from solving, in a sentence, as of transport.h; "": nothing does */
    char cause[200];
};

/* Build hierarchy and rays over the scene, unless they are handed on; set B = E. Returns 0; on
 * failure -1 with *cause set and nothing to free. */
int solve_open(struct solve *s, const struct scene *scene, const struct solve_options *options,
               const char **cause);
/* Hierarchy and rays to the next solve of options.handed_on. This one may only be closed then. */
void solve_hand_on(struct solve *s);
void handed_on_free(struct handed_on *handed);

/* What comes before the first refinement. Returns 0, or -1 with *cause set. */
int solve_begin(struct solve *s, const struct refiner *refiner, const char **cause);

/* The operator as the links are now: the last pass may have changed them after the last solve, and
 * slopes have rows of their own. *rows is set where it has been made anew. Returns 0 or -1. */
int solve_renew_operator(struct solve *s, struct row_report *rows);

/* What refinement has come to on all ranks, into report.counts and report.rounds. */
void solve_count_links(struct solve *s);

/* What follows from links that are new: counts, and form factors by collocation. Returns 0 or -1.
 */
int solve_recount(struct solve *s);

/* Refine with `refiner` from the root, without solving. Returns 0, or -1 with *cause set. */
int solve_refine(struct solve *s, const struct refiner *refiner, const char **cause);

/* One pass after solve_refine: solve over the links, show the oracles, discuss links again. Returns
 * 1 while there is more to do, 0 when done, -1 with *cause set. */
int solve_step(struct solve *s, const char **cause);

/* Refine, unless that is done, and step until no link changes and iteration error is below
 * tolerance, or passes run out. Returns 0, or -1 with *cause set. */
int solve_run(struct solve *s, const struct refiner *refiner, const char **cause);

/* The solution that is shown: mended, where it is. */
static inline const struct state *solve_shown(const struct solve *s)
{
    return s->mended.radiosity ? &s->mended : &s->state;
}

/* Its slopes, as linear_solution.gradient; NULL: it is constant on leaves. */
static inline const double *solve_gradient(const struct solve *s)
{
    return s->mended_gradient ? s->mended_gradient : s->linear.gradient;
}

/* Show what the links say. */
void solve_forget_mended(struct solve *s);

/* The account of power in the report, of the solution that is shown. */
void solve_sum_power(struct solve *s);

/* Room for all elements, and for elements made since the last call their parent's radiosity.
 * Returns 0, or -1 when out of memory. */
int solve_make_room(struct solve *s);

/* Which share of each leaf from element `first` on no solid stands on; from there up, means. With
 * `known`, leaves of which all is bare by what stands in operator.uncovered are taken to be so. */
void solve_measure_contact(struct solve *s, uint32_t first, int known);
/* The means alone, of the first `count` elements. */
void solve_average_contact(struct solve *s, uint32_t count);

/* Tell the progress function which phase of the work goes on. Returns nonzero when it cancels. */
int solve_tell(struct solve *s, const char *phase);

/* Give the links other form factors, [link_count] in their order, and solve over them as they are
 * then, without discussing any; those of links with a cluster at an end are not looked at. Returns
 * 0, or -1 with *cause set. */
int solve_with_factors(struct solve *s, const float *form_factors, const char **cause);

void solve_close(struct solve *s);

#endif
