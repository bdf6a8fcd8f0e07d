/* api_choice.c - as many links as pay: radSolveScene.
 *
 * Particles know all light without a link: places to an error t by s^2 / t^2 rays, s^2 that of one
 * ray (engine/ray_split.c), and the means of polygons by some number that coarse links lower little
 * (engine/mended_error.c). What lies between the two is what links can surely spare. They cost
 * rays, and discussions and sweeps, which take as long as PAIR rays for each pair discussed. So
 * where that comes to more than a QUARTER of what can be spared before the coarsest links are done,
 * there are none; but for a LITTLE of what polygons take anyway there may be. Scenes whose coarse
 * links are done within FEW pairs are not asked, nor whoever says how to solve for links or wants
 * to keep them.
 *
 * Links of error e, point by point, and L rays are worth these only where particles from as many
 * would be farther off: e^2 < s^2 / L. Sweeps are a part of L: an empty white sphere takes no rays,
 * but 50 sweeps. So links come coarse first, with thresholds times COARSE, and few particles
 * measure e and s; of e^2 the most counts that they do not speak against, for by chance it may come
 * out below 0, which no L would be too much for. Finer links, of L' rays and error e', spare s^2 (1
 * / e'^2 - 1 / e^2) rays. Were it rays that make the error, e^2 would fall with 1 / L; where
 * elements make it, it falls more slowly: with L^-.4 on maze_8, office3 and td, whose e^2 halves as
 * L grows six times. Then s^2 ((L' / L)^.4 - 1) / e^2 rays are spared, fewer than L' for every L'
 * where e^2 is above s^2 / (FINER L): particles are the cheaper way, and the coarse links stay.
 * Unless particles would have to do all: where coarse links know next to nothing of places, as of a
 * gap between a cupboard and its wall, finer ones may know nearly all of it. If what they could
 * spare at the most takes longer than they do, which is TRIED times what the coarse ones did, they
 * are made. So nobody waits more than about twice as long as for the better way, whatever e falls
 * with. Finer links are solved for anew: what was given up coarsely is not missed then. All follows
 * from counts, so the choice is the same on any machine, and on any number of them. [Derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "engine/api.h"
#include "util/clock.h"

static const double COARSE = 16;
static const double FINER = 5.4; /* the least of x / (x^.4 - 1), at x = 3.6 */
/* rays of particles that take as long as discussing a pair and sweeping over what comes of it:
 * between 2.4 and 5 in scenes of 500 to 15,000 faces that reflect a half; where sweeps are known,
 * the same without them, and each of them over a link: 55 to 130 ns, beside .3 us of a ray */
static const double PAIR = 4;
static const double DISCUSSED = 3;
static const double SWEPT = 0.2;
/* of what could be spared: on td and office3 coarse links spare .4 of it, and leaves that the first
 * particles tell spare some of it, too */
static const double QUARTER = 0.25;
static const double LITTLE = 0.125;
/* thresholds of a sixteenth: rays and discussions of finer links over those of coarse ones. 2.3 to
 * 9.2 in ten rooms of 24 to 434 faces */
static const double TRIED = 8;
/* rays of links that take as long as one of a particle that is counted on quarters of leaves: .3
 * and .6 us */
static const double PARTICLE = 2;
static const double FEW = 1e5; /* pairs: .2 seconds of one processor */

/* What a choice is made for, and where it stands. */
struct choosing {
    RadScene scene;
    RadOracle oracle;
    struct RadSolveOptions options;
    struct RadChoiceOptions wishes;
    struct RadChoice so_far;
    struct handed_on handed; /* from solution to solution */
    double linked;           /* squared error of coarser links on places; 0: none are known */
};

/* Another one is solved instead, if any is. */
static void hand_on(RadSolution s)
{
    s->dead = 1;
    solve_hand_on(&s->solve);
    radReleaseSolution(s);
}

/* Solve with links, or without any: *solution. A limit on pairs above 0 may be met. Returns 0, 1
 * where it was, or -1, both with *solution NULL. */
static int solve(struct choosing *x, double scale, double pairs, RadSolution *solution)
{
    struct RadSolveOptions options = x->options;
    /* a limit of the caller's own that comes sooner is met as ever */
    const int limited =
        pairs > 0 && !(options.limits.pairs > 0 && (double)options.limits.pairs <= pairs);
    const double start = seconds();
    options.no_links = x->so_far.no_links;
    if (limited)
        options.limits.pairs = (uint64_t)pairs;
    x->so_far.scale = scale;
    *solution = NULL;
    if (radScaleOracle(x->oracle, scale) < 0)
        return -1;
    RadSolution s = api_new_solution(x->scene, x->oracle, &options, &x->handed);
    if (!s)
        return -1;
    s->solve.linked = x->linked;
    int status = 0;
    if (x->wishes.begin && x->wishes.begin(x->wishes.user, s, &x->so_far) != 0)
        status = api_fail(x->scene->device, RAD_ERROR_CANCELLED,
                          "given up by whoever wanted to begin it");
    if (status == 0)
        status = api_solve(s, limited);
    if (status == 0)
        *solution = s;
    else
        hand_on(s);
    x->so_far.seconds += status > 0 ? seconds() - start : 0;
    return status;
}

/* Returns 0, or -1 with the solution released. */
static int measure(struct choosing *x, RadSolution solution, struct RadPlaces *places)
{
    const double start = seconds();
    if (radMeasurePlaces(solution, 0, places) < 0) {
        hand_on(solution);
        return -1;
    }
    x->so_far.rays += places->rays;
    x->so_far.seconds += seconds() - start;
    return 0;
}

/* Rays that particles alone need for places, and for polygons. */
static double rays_for_places(const struct RadPlaces *p)
{
    return p->ray / (RAD_CORRECT_PLACES * RAD_CORRECT_PLACES);
}

static double rays_for_faces(const struct RadPlaces *p)
{
    return p->face / (RAD_CORRECT_NOISE * RAD_CORRECT_NOISE);
}

/* Solve without links, and find how many pairs links may cost to be tried: *pairs. Returns 0, or
 * -1. */
static int solve_without(struct choosing *x, double *pairs, RadSolution *solution)
{
    struct RadPlaces p;
    x->so_far.no_links = 1;
    const int status = solve(x, 1, 0, solution);
    x->so_far.no_links = 0;
    if (status < 0 || measure(x, *solution, &p) < 0)
        return -1;
    const double faces = rays_for_faces(&p);
    *pairs = fmax(QUARTER * (rays_for_places(&p) - faces), LITTLE * faces) / PAIR;
    return 0;
}

/* With coarse links, or with none where these cost too much. One solution is held at a time, as of
 * large scenes each takes much memory: the one without links goes before links are tried, and is
 * made again where these cost too much. Returns 0, or -1. */
static int solve_coarse(struct choosing *x, RadSolution *solution)
{
    const struct RadSolveOptions *o = &x->options;
    const int may_be_none = !x->wishes.keep_links && o->closure == RAD_CLOSURE_NONE
                            && o->solver == RAD_SOLVER_GAUSS_SEIDEL && !(o->tolerance > 0)
                            && o->basis == RAD_BASIS_LINEAR;
    struct RadReport r;
    double pairs;
    int status = solve(x, COARSE, may_be_none ? FEW : 0, solution);
    if (status <= 0)
        return status;
    if (solve_without(x, &pairs, solution) < 0)
        return -1;
    if (!(pairs > FEW)) {
        x->so_far.no_links = 1;
        return 0;
    }
    const struct ray_split places = (*solution)->places;
    radGetReport(*solution, &r);
    x->so_far.seconds += r.seconds.build + r.seconds.refine + r.seconds.iterate;
    hand_on(*solution);
    status = solve(x, COARSE, pairs, solution);
    if (status <= 0)
        return status;
    x->so_far.no_links = 1;
    status = solve(x, 1, 0, solution);
    if (status == 0)
        (*solution)->places = places;
    return status;
}

/* Squared error of links on places, as much as it may be by what was measured. */
static double most_off(const struct RadPlaces *p)
{
    return fmax(p->links, 0) + p->deviation;
}

/* Rays that take as long as the sweeps of all passes. */
static double sweeping(const struct RadReport *r)
{
    return SWEPT * (double)r->links * (r->iterations + r->linear.sweeps);
}

/* Are finer links worth their price, as coarse ones are measured? */
static int is_finer_better(const struct RadPlaces *p, const struct RadReport *coarse)
{
    const double rays = (double)coarse->rays + sweeping(coarse),
                 cost = TRIED * (rays + DISCUSSED * (double)coarse->pairs), links = most_off(p),
                 spared = rays_for_places(p) - p->ray / links - rays_for_faces(p);
    return links * FINER * rays < p->ray || PARTICLE * spared > cost;
}

/* Returns 0, or -1. */
static int choose(struct choosing *x, RadSolution *solution)
{
    const double start = seconds();
    struct RadPlaces p;
    struct RadReport r;
    if (solve_coarse(x, solution) < 0)
        return -1;
    if (x->so_far.no_links)
        return 0;
    if (measure(x, *solution, &p) < 0)
        return -1;
    radGetReport(*solution, &r);
    if (!is_finer_better(&p, &r))
        return 0;
    x->so_far.rays += r.rays;
    x->so_far.seconds = seconds() - start;
    hand_on(*solution);
    x->linked = most_off(&p);
    return solve(x, 1, 0, solution);
}

RadSolution radSolveScene(RadScene scene, RadOracle oracle, const struct RadSolveOptions *options,
                          const struct RadChoiceOptions *wishes, struct RadChoice *choice)
{
    struct choosing x = {.scene = scene, .oracle = oracle};
    RadSolution solution;
    if (options)
        x.options = *options;
    if (wishes)
        x.wishes = *wishes;
    if (!scene || !oracle)
        return radNewSolution(scene, oracle, NULL); /* which says what is missing */
    if (x.options.unit || x.options.no_links) {
        api_fail(scene->device, RAD_ERROR_INVALID_ARGUMENT,
                 "radSolveScene chooses how many links there are: RadSolveOptions.%s must be 0",
                 x.options.unit ? "unit" : "no_links");
        return NULL;
    }
    const uint32_t faces = scene->scene.face_count;
    double *uncovered = malloc(faces * sizeof *uncovered); /* NULL: found anew each time */
    for (uint32_t i = 0; uncovered && i < faces; i++)
        uncovered[i] = NAN;
    x.handed.uncovered = uncovered;
    /* nothing can be coarser or finer of an oracle without thresholds */
    const int count = radScaleOracle(oracle, 1);
    const int status = count < 0   ? -1
                       : count > 0 ? choose(&x, &solution)
                                   : solve(&x, 1, 0, &solution);
    handed_on_free(&x.handed);
    if (status < 0)
        return NULL;
    solution->solve.problem.options.handed_on = NULL;
    if (choice)
        *choice = x.so_far;
    return solution;
}
