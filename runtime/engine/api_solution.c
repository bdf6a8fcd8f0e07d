/* api_solution.c - solutions: options checked, and passes.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/api.h"
#include "engine/dense.h"
#include "engine/lit_faces.h"
#include "engine/own_quarters.h"
#include "engine/petsc_solution.h"
#include "kernel/constants.h"
#include "util/lapack_library.h"

_Static_assert((int)RAD_LU_LEAVES == (int)DENSE_LEAVES, "one number");

enum { ITERATIONS = 100000 };

const char *const *radGetClusteringNames(void)
{
    static const char *const names[] = {
#define X(constant, name, help) #name,
        CLUSTERINGS(X)
#undef X
            NULL};
    return names;
}

const char *radGetClusteringDoc(const char *name)
{
    int i = name ? clustering_of(name) : -1;
    return i < 0 ? NULL : clustering_helps[i];
}

/* Is a . b what it should be, to the rounding of what a program computes or reads from a file? */
static int near(double value, double wanted)
{
    return fabs(value - wanted) <= 1e-6;
}

static int check_camera(RadDevice device, const struct RadCamera *c)
{
    if (!api_place(c->eye))
        return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                        "the camera's eye is not finite, or beyond 3.4e38");
    if (!near(dot3(c->right, c->right), 1) || !near(dot3(c->up, c->up), 1)
        || !near(dot3(c->ahead, c->ahead), 1) || !near(dot3(c->right, c->up), 0)
        || !near(dot3(c->up, c->ahead), 0) || !near(dot3(c->ahead, c->right), 0))
        return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                        "the camera's right, up and ahead must have length 1 and be at right "
                        "angles to each other");
    if (!(c->wide > 0 && isfinite(c->wide) && c->high > 0 && isfinite(c->high)))
        return api_fail(
            device, RAD_ERROR_INVALID_ARGUMENT,
            "the camera's angles of view are tangents %g and %g; both must be above 0 and finite",
            c->wide, c->high);
    return 0;
}

int radHasSolver(enum RadSolver solver)
{
    return (unsigned)solver < RAD_SOLVER_PETSC
           || (solver == RAD_SOLVER_PETSC && petsc_solution_built());
}

static int check_options(RadDevice device, const struct RadSolveOptions *o)
{
    if (!(o->tolerance >= 0 && o->tolerance < 1))
        return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                        "RadSolveOptions.tolerance is %g; it takes a number above 0 and below 1, "
                        "or 0 for the default",
                        o->tolerance);
    if (o->iterations < 0)
        return api_fail(
            device, RAD_ERROR_INVALID_ARGUMENT,
            "RadSolveOptions.iterations is %d; it takes 1 or more, or 0 for the default",
            o->iterations);
    if ((unsigned)o->solver > RAD_SOLVER_PETSC)
        return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                        "RadSolveOptions.solver is %d; it takes one of enum RadSolver",
                        (int)o->solver);
    if (!radHasSolver(o->solver))
        return api_fail(device, RAD_ERROR_UNSUPPORTED,
                        "this library was built without PETSc: make PETSC=1");
    if (o->basis == RAD_BASIS_LINEAR
        && (o->projection != RAD_PROJECTION_GALERKIN
            || (o->solver != RAD_SOLVER_GAUSS_SEIDEL && o->solver != RAD_SOLVER_JACOBI)))
        return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                        "RAD_BASIS_LINEAR goes with RAD_PROJECTION_GALERKIN and with Gauss-Seidel "
                        "or Jacobi sweeps");
    if (o->projection != RAD_PROJECTION_GALERKIN && o->projection != RAD_PROJECTION_COLLOCATION)
        return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                        "RadSolveOptions.projection takes RAD_PROJECTION_GALERKIN or "
                        "RAD_PROJECTION_COLLOCATION");
    if (o->closure != RAD_CLOSURE_NONE && o->closure != RAD_CLOSURE_ROWS)
        return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                        "RadSolveOptions.closure takes RAD_CLOSURE_NONE or RAD_CLOSURE_ROWS");
    if (o->basis != RAD_BASIS_CONSTANT && o->basis != RAD_BASIS_LINEAR)
        return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                        "RadSolveOptions.basis takes RAD_BASIS_CONSTANT or RAD_BASIS_LINEAR");
    if (o->clustering && clustering_of(o->clustering) < 0)
        return api_fail(
            device, RAD_ERROR_INVALID_ARGUMENT,
            "there is no clustering '%s'; radGetClusteringNames tells those that there are",
            o->clustering);
    if (o->limits.depth < 0 || o->limits.depth > LIMIT_DEPTH_MOST)
        return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                        "RadSolveOptions.limits.depth is %d; it takes 1 to %d, or 0 for the "
                        "default",
                        o->limits.depth, LIMIT_DEPTH_MOST);
    struct lapack lapack;
    const char *cause = o->solver == RAD_SOLVER_LU ? lapack_load(&lapack) : NULL;
    if (cause)
        return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                        "RAD_SOLVER_LU needs LAPACKE, which does not load: %s", cause);
    return o->camera ? check_camera(device, o->camera) : 0;
}

/* What goes over the links of all, several ranks cannot do. */
static int check_ranks(RadDevice device, RadOracle oracle, const struct RadSolveOptions *o)
{
    static const struct {
        int fact;
        const char *what;
    } all[] = {{FACT_RECEIVER_TOLERANCE, "error control, which this oracle asks for,"},
               {FACT_SCENE_RANK, "ranking links, which this oracle asks for,"},
               {FACT_EMITTER_LOWER, "an enclosing solution, which this oracle asks for,"},
               {FACT_EMITTER_GAP, "an enclosing solution, which this oracle asks for,"}};
    if (o->solver == RAD_SOLVER_SOUTHWELL && api_alone(device, "Southwell's method") < 0)
        return -1;
    if (o->solver == RAD_SOLVER_LU && api_alone(device, "LU") < 0)
        return -1;
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (refiner_reads(oracle->refiner, all[i].fact) && api_alone(device, all[i].what) < 0)
            return -1;
    return 0;
}

static int watch(void *context, const struct solve *s, const char *phase)
{
    const struct RadSolutionObject *solution = context;
    const struct counting *counting = s->counting;
    const struct RadProgress progress = {phase,
                                         s->report.passes + 1,
                                         s->refinement.rounds,
                                         s->refinement.pairs,
                                         s->refinement.queue_count,
                                         s->refinement.link_count,
                                         counting ? counting->rays
                                                  : rays_count(s->problem.rays).rays,
                                         s->report.residual,
                                         counting ? counting->share : 0};
    return api_progress(solution->scene->device, &progress);
}

static struct solve_options engine_options(RadSolution solution, const struct RadSolveOptions *o)
{
    struct solve_options options = {
        .tolerance = o->tolerance,
        .iterations = o->iterations ? o->iterations : ITERATIONS,
        .solver = o->solver,
        .projection = o->projection,
        .threads = solution->scene->device->threads,
        .closure = o->closure == RAD_CLOSURE_ROWS ? CLOSURE_ROWS : CLOSURE_NONE,
        .clusters = o->clustering ? 1 + clustering_of(o->clustering) : 0,
        .linear = o->basis == RAD_BASIS_LINEAR,
        .unit = o->unit != 0,
        .no_links = o->no_links != 0,
        .limits = {o->limits.depth, o->limits.elements, o->limits.links, o->limits.pairs,
                   o->limits.rounds, 0},
        .ranks = solution->scene->device->ranks,
        .progress = watch,
        .context = solution};
    if (o->camera) {
        const struct RadCamera *c = o->camera;
        struct camera *to = &solution->camera;
        memcpy(to->eye, c->eye, sizeof to->eye);
        memcpy(to->right, c->right, sizeof to->right);
        memcpy(to->up, c->up, sizeof to->up);
        memcpy(to->ahead, c->ahead, sizeof to->ahead);
        to->wide = c->wide;
        to->high = c->high;
        options.camera = to;
    }
    return options;
}

/* Which sides are dark, once for all solutions; view factors are of all sides. Returns 0, or -1
 * with *cause set. */
static int ask_lit(RadScene scene, const struct RadSolveOptions *o, const char **cause)
{
    if (o->unit || scene->lit_asked)
        return 0;
    if (lit_faces_find(&scene->scene, scene->device->ranks, scene->device->threads, cause) < 0)
        return -1;
    scene->lit_asked = 1;
    return 0;
}

RadSolution api_new_solution(RadScene scene, RadOracle oracle, const struct RadSolveOptions *given,
                             struct handed_on *handed)
{
    static const struct RadSolveOptions defaults;
    const struct RadSolveOptions *o = given ? given : &defaults;
    if (!scene)
        return NULL;
    if (!scene->committed) {
        api_fail(scene->device, RAD_ERROR_INVALID_OPERATION,
                 "radCommitScene comes before radNewSolution");
        return NULL;
    }
    if (!oracle) {
        api_fail(scene->device, RAD_ERROR_INVALID_ARGUMENT,
                 "a solution needs an oracle; radNewOracle(device, radGetDefaultOracle(), "
                 "RAD_RELEASE_FLAT) makes one");
        return NULL;
    }
    if (check_options(scene->device, o) < 0 || check_ranks(scene->device, oracle, o) < 0)
        return NULL;
    RadSolution solution = calloc(1, sizeof *solution);
    if (!solution) {
        api_fail(scene->device, RAD_ERROR_OUT_OF_MEMORY, "out of memory for a solution");
        return NULL;
    }
    atomic_init(&solution->holders, 1);
    solution->scene = scene;
    solution->oracle = oracle;
    struct solve_options options = engine_options(solution, o);
    options.handed_on = handed;
    const char *cause;
    if (ask_lit(scene, o, &cause) < 0
        || solve_open(&solution->solve, &scene->scene, &options, &cause) < 0) {
        api_fail(scene->device, api_cause(cause), "%s", cause);
        free(solution);
        return NULL;
    }
    radRetainScene(scene);
    radRetainOracle(oracle);
    return solution;
}

RadSolution radNewSolution(RadScene scene, RadOracle oracle, const struct RadSolveOptions *options)
{
    return api_new_solution(scene, oracle, options, NULL);
}

void radRetainSolution(RadSolution solution)
{
    if (solution)
        atomic_fetch_add(&solution->holders, 1);
}

void radReleaseSolution(RadSolution solution)
{
    if (!solution || atomic_fetch_sub(&solution->holders, 1) != 1)
        return;
    measured_error_free(&solution->measured);
    solve_state_free(&solution->state);
    free(solution->trace.pairs);
    free(solution->part);
    solve_close(&solution->solve);
    radReleaseOracle(solution->oracle);
    radReleaseScene(solution->scene);
    free(solution);
}

int api_give_up(RadSolution solution, const char *cause)
{
    RadDevice device = solution->scene->device;
    solution->dead = 1;
    if (solution->trace.stopped)
        return api_fail(device, RAD_ERROR_CANCELLED, "cancelled by the trace function");
    if (solution->between_stopped)
        return api_fail(device, RAD_ERROR_CANCELLED, "cancelled by the pass function");
    if (solution->solve.report.cancelled)
        return api_fail(device, RAD_ERROR_CANCELLED, "cancelled by the progress function");
    if (solution->solve.refinement.none)
        return api_fail(device, RAD_ERROR_INVALID_ORACLE, "oracle %s: %s",
                        solution->oracle->refiner->oracle, solution->solve.refinement.none);
    if (solution->solve.refinement.met) {
        char text[1024];
        struct refiner *graph = api_interpret(solution->oracle);
        limits_tell(&solution->solve.refinement, graph, text, sizeof text);
        refiner_close(graph);
        return api_fail(device, RAD_ERROR_LIMIT, "%s", text);
    }
    return api_fail(device, api_cause(cause), "%s", cause);
}

int api_not_dead(RadSolution solution)
{
    if (!solution)
        return -1;
    if (solution->dead)
        return api_fail(solution->scene->device, RAD_ERROR_INVALID_OPERATION,
                        "the solution was cancelled or has failed; release it and make another");
    return 0;
}

int api_solved(RadSolution solution, const char *what)
{
    if (api_not_dead(solution) < 0)
        return -1;
    RadDevice device = solution->scene->device;
    if (solution->solve.report.passes == 0)
        return api_fail(device, RAD_ERROR_INVALID_OPERATION,
                        "%s needs a solution: radSolve or radStep comes first", what);
    if (solution->solve.problem.options.unit)
        return api_fail(device, RAD_ERROR_INVALID_OPERATION,
                        "%s needs the scene's own light; RadSolveOptions.unit has none", what);
    return 0;
}

int radRefine(RadSolution solution)
{
    if (api_not_dead(solution) < 0)
        return -1;
    if (api_refined(solution))
        return api_fail(solution->scene->device, RAD_ERROR_INVALID_OPERATION,
                        "radRefine comes first and once; radStep refines further");
    const char *cause;
    if (solve_refine(&solution->solve, solution->oracle->refiner, &cause) < 0)
        return api_give_up(solution, cause);
    return 0;
}

/* What was measured is of light that is about to change. */
static void forget_measured(RadSolution solution)
{
    measured_error_free(&solution->measured);
    solution->places.rays = 0;
}

int radStep(RadSolution solution)
{
    if (api_not_dead(solution) < 0)
        return -1;
    if (solution->done)
        return 0;
    const char *cause;
    if (!api_refined(solution)
        && solve_refine(&solution->solve, solution->oracle->refiner, &cause) < 0)
        return api_give_up(solution, cause);
    forget_measured(solution);
    if (own_quarters_share(&solution->solve) < 0)
        return api_give_up(solution, "out of memory");
    int more = solve_step(&solution->solve, &cause);
    solution->done = more == 0;
    return more < 0 ? api_give_up(solution, cause) : more;
}

/* Has the caller given the limit that is met? Pairs are not asked for. */
static int is_given(const struct limits *given, const char *met)
{
    return (!strcmp(met, "depth") && given->depth) || (!strcmp(met, "elements") && given->elements)
           || (!strcmp(met, "links") && given->links) || (!strcmp(met, "rounds") && given->rounds);
}

int api_solve(RadSolution solution, int may_end)
{
    if (api_not_dead(solution) < 0)
        return -1;
    if (solution->done)
        return 0;
    const char *cause;
    forget_measured(solution);
    if (own_quarters_share(&solution->solve) < 0)
        return api_give_up(solution, "out of memory");
    if (solve_run(&solution->solve, solution->oracle->refiner, &cause) < 0) {
        const struct refinement *r = &solution->solve.refinement;
        if (!may_end || !r->met || is_given(&solution->solve.problem.options.limits, r->met)
            || r->none || solution->solve.report.cancelled)
            return api_give_up(solution, cause);
        solution->dead = 1;
        return 1;
    }
    solution->done = 1;
    return 0;
}

int radSolve(RadSolution solution)
{
    return api_solve(solution, 0);
}

int radSolveWithFactors(RadSolution solution, const float *form_factors)
{
    if (api_not_dead(solution) < 0)
        return -1;
    RadDevice device = solution->scene->device;
    if (api_alone(device, "radSolveWithFactors") < 0)
        return -1;
    if (!api_refined(solution))
        return api_fail(device, RAD_ERROR_INVALID_OPERATION,
                        "radRefine or radSolve comes before radSolveWithFactors: there are no "
                        "links yet");
    if (!form_factors)
        return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                        "radSolveWithFactors needs a form factor for each link");
    const size_t count = solution->solve.refinement.link_count;
    for (size_t i = 0; i < count; i++)
        if (!(form_factors[i] >= 0 && isfinite(form_factors[i])))
            return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                            "form factor %zu of %zu is %g; it takes a finite number from 0", i,
                            count, (double)form_factors[i]);
    const char *cause;
    forget_measured(solution);
    if (solve_with_factors(&solution->solve, form_factors, &cause) < 0)
        return api_give_up(solution, cause);
    solution->done = 1;
    return 0;
}
