/* api.h - what stands behind the handles of radiosity.h.
 *
 * Every handle counts its holders and holds what it was made from: solution and exchange hold scene
 * and oracle, those hold the device. Only a device is shared by threads that call at the same time,
 * so only it has a lock.
 * SPDX-License-Identifier: MIT */
#ifndef API_H
#define API_H

#include <pthread.h>
#include <stdatomic.h>
#include "engine/exchange.h"
#include "engine/measured_error.h"
#include "engine/point_view.h"
#include "engine/solve_state.h"
#include "engine/trace.h"
#include "hierarchy/scene.h"
#include "oracle/explain.h"
#include "oracle/oracles.h"
#include "oracle/refiner.h"
#include "oracle/statistics.h"
#include "radiosity.h"
#include "util/messages.h"

enum { MESSAGE_SIZE = 8192 };

struct RadDeviceObject {
    atomic_int holders;
    int threads;
    struct ranks *ranks;        /* owned; NULL: this process alone */
    char *compiler, *temporary; /* of the options; NULL: none given */
    pthread_mutex_t lock;       /* of all that follows */
    enum RadError error;        /* the first since it was asked for */
    char message[MESSAGE_SIZE];
    RadMessageFunction tell;
    void *tell_user;
    RadProgressFunction progress;
    void *progress_user;
    struct oracle_sources sources; /* of radRegisterOracle */
};

struct RadSceneObject {
    atomic_int holders;
    RadDevice device;
    struct RadMaterial *materials; /* [material_count]; NULL after the commit */
    uint32_t material_count;
    /* borrowed until the commit; zero before they are set and after it */
    struct RadPolygons polygons;
    int polygons_set, committed;
    int lit_asked;      /* for what is dark: a solution has been made, not of view factors alone */
    struct scene scene; /* empty before the commit */
    struct RadSceneReport report;
    struct point_view points; /* of radGetPointFactors; .scene NULL: not yet asked */
};

struct RadExchangeObject {
    atomic_int holders;
    RadScene scene;
    struct exchange exchange;
};

/* What an oracle was loaded from; path NULL: nobody knows, or it is somebody's C. */
struct oracle_source {
    char *path, *text, *name;
    char **replacements;
    int replacement_count;
};

struct RadOracleObject {
    atomic_int holders;
    RadDevice device;
    struct refiner *refiner;
    double *set; /* [parameter_count]: parameters before they are scaled; NULL: none is */
    int counting;
    struct statistics counted;    /* what radGetOracleStatistics shows */
    struct explanation explained; /* what radExplain shows */
    struct oracle_source source;
};

struct RadSolutionObject {
    atomic_int holders;
    RadScene scene;
    RadOracle oracle;
    struct camera camera;
    struct solve solve;
    struct ray_split places;        /* of the links as they are; rays 0: not measured */
    uint64_t mending_rays;          /* of the last radCorrect */
    struct measured_error measured; /* .elements NULLs: nothing has been, or not what is shown */
    struct trace trace;             /* of radTraceSolution */
    uint32_t *part;                 /* per face: see engine/element_names.h; NULL: not yet asked */
    struct solve_state state;       /* of radGetSolutionState */
    RadPassFunction between;        /* of radSetSolutionPassFunction; NULL: none */
    void *between_user;
    int between_stopped;
    int done; /* the last step said so */
    int dead; /* a call has failed: what there is is incomplete, and may only be released */
};

/* The device's first error becomes this one, unless there is one; its message function is told.
 * Returns -1. */
int api_fail(RadDevice device, enum RadError code, const char *format, ...) MESSAGE_LIKE(3, 4);

/* Is there what `what` says a call needs from its caller, a place for its result, say? Returns 0,
 * or -1 with the device told. */
int api_needs(RadDevice device, const void *given, const char *what);

/* Calls the progress function, if there is one. Returns what it says. */
int api_progress(RadDevice device, const struct RadProgress *progress);

/* A handle that takes the refiner over; NULL for a refiner is out of memory. Returns NULL after
 * an error. */
RadOracle api_oracle(RadDevice device, struct refiner *refiner);

/* api_oracle.c. Those that radLoadPlugin has loaded so far. */
const struct plugin *api_plugins(RadDevice device);

/* api_graph.c. Keeps what the oracle was loaded from; where there is no memory for it, nothing. */
void api_keep_source(RadOracle oracle, const char *path, const char *text, const char *name,
                     const char *const *replacements, int count);
void api_forget_source(struct oracle_source *source);
/* The oracle's graph, interpreted, with the parameters that the oracle has now; the caller's.
 * NULL: nobody knows it. */
struct refiner *api_interpret(RadOracle oracle);

/* As radNewSolution, from what others of the scene by the same options hand on; NULL: none do. */
RadSolution api_new_solution(RadScene scene, RadOracle oracle,
                             const struct RadSolveOptions *options, struct handed_on *handed);

/* After a call that could not do its work: the solution is dead. Returns -1. */
int api_give_up(RadSolution solution, const char *cause);
/* Returns 0, or -1 with the device told that the solution can do no more. */
int api_not_dead(RadSolution solution);

/* Are there links? */
static inline int api_refined(RadSolution solution)
{
    return solution->solve.refinement.hierarchy != NULL;
}

/* Is this process alone? Returns 0, or -1 with the device told that `what` needs all links. */
int api_alone(RadDevice device, const char *what);

/* radSolve. may_end: where refinement meets a limit that nobody has given, or that on pairs, nobody
 * is told. Returns 0, -1, or 1: it has. */
int api_solve(RadSolution solution, int may_end);

/* Is there light to be looked at? Returns 0, or -1 with the device told that `what` needs it. */
int api_solved(RadSolution solution, const char *what);

/* What of a report is about faces, the rest 0. */
struct RadErrorReport api_face_report(const struct face_error *f);

/* The code of a cause that the engine gives as a constant string. */
enum RadError api_cause(const char *cause);

/* Is it a place, no farther out than corners may be (3.4e38 m)? */
int api_place(const double place[3]);

#endif
