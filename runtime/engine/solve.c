/* solve.c - Hanrahan's multigridding around the radiosity iteration: refine, solve, let the oracle
 * see the new radiosities, refine again, until no link changes.
 *
 * Where groups are linked there are many links, and most passes change many of them. Those solve to
 * ROUGH_TOLERANCE only, less than what oracles notice (HYSTERESIS). Once so few links change, one
 * in SETTLED, passes solve to the tolerance. The solve has converged when such a pass changes no
 * link: what the last links gave is then known to the tolerance, and the oracle would leave them as
 * they are.
 *
 * The equation is solved in transport.c; what is done about rows that sum to more or less than 1
 * stands in row_sums.c; what the oracles see of a solution in oracle_inputs.c.
 * [Hanrahan et al. 1991, sections 4 and 5]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>
#include "engine/ambient.h"
#include "engine/bends.h"
#include "engine/collocation.h"
#include "engine/dense.h"
#include "engine/solve.h"
#include "engine/state_identity.h"
#include "engine/trace.h"
#include "engine/transport.h"
#include "engine/variation.h"
#include "kernel/constants.h"
#include "util/clock.h"

/* Where the solver lowers error tolerances or ranks links, a pass may be one step of many. */
enum { PASSES = 32, PASSES_IN_STEPS = 200 };

/* Radiosity, as an equation over the links. */
static struct transport light(struct solve *s, double tolerance)
{
    return (struct transport){.bands = s->problem.bands,
                              .value = s->state.radiosity,
                              .irradiance = s->state.irradiance,
                              .source = s->problem.exitance,
                              .reflectance = s->problem.reflectance,
                              .tolerance = tolerance};
}

/* ---- progress, which may cancel */

int solve_tell(struct solve *s, const char *phase)
{
    const struct solve_options *o = &s->problem.options;
    s->report.cancelled |= o->progress && o->progress(o->context, s, phase);
    return s->report.cancelled;
}

static int watch_refinement(void *context, const struct refinement *r)
{
    struct solve *s = context;
    if (s->problem.options.solver == RAD_SOLVER_LU
        && dense_too_many(dense_leaves(r->hierarchy), s->cause, sizeof s->cause))
        return -1;
    return solve_tell(context, "refine");
}

static int watch_light(void *context, const struct transport *x)
{
    struct solve *s = context;
    s->report.sweeps++;
    s->report.residual = x->residual;
    return solve_tell(s, "solve");
}

static int watch_importance(void *context, const struct transport *x)
{
    struct solve *s = context;
    (void)x;
    s->report.sweeps++;
    return solve_tell(s, "solve");
}

/* Solve; then all ranks have what surfaces have. A cause of failure is the solve's. Returns 0 or
 * -1. */
static int solve_transport(struct solve *s, struct transport *x)
{
    struct shares *shares = &s->operator.shares;
    if (transport_solve(&s->operator, x) < 0) {
        if (x->cause[0])
            memcpy(s->cause, x->cause, sizeof s->cause);
        return -1;
    }
    return shares_complete(shares, x->value, x->bands) < 0
                   || shares_complete(shares, x->irradiance, x->bands) < 0
               ? -1
               : 0;
}

/* What keeps a step from going on. Returns -1. */
static int fail(const struct solve *s, const char *memory, const char **cause)
{
    *cause = s->report.cancelled ? "cancelled" : s->cause[0] ? s->cause : memory;
    return -1;
}

/* ---- passes */

/* One packet of many is timed, and counts for all of them: where a thread was put aside in one,
 * that would be more than the whole. */
static void note_ray_seconds(struct solve *s)
{
    s->report.seconds.in_rays = fmin(
        rays_count(s->problem.rays).seconds / s->problem.options.threads, s->report.seconds.refine);
}

static const char refining[] =
    "out of memory while refining; a coarser oracle parameter needs less";

int solve_begin(struct solve *s, const struct refiner *refiner, const char **cause)
{
    const struct problem *p = &s->problem;
    if (!ranks_alike(p->options.ranks, RANKS_VALUES, state_identity_oracle(refiner)))
        return fail(s, "the processes have different oracles; give all of them the same files",
                    cause);
    double error = error_control_target(refiner, rays_host(p->rays));
    int impact = refiner_reads(refiner, FACT_RECEIVER_IMPACT),
        bracket =
            refiner_reads(refiner, FACT_EMITTER_LOWER) || refiner_reads(refiner, FACT_EMITTER_GAP);
    ranking_start(&s->ranking, refiner, p->rays);
    s->bends = refiner_reads(refiner, FACT_RECEIVER_BEND) && !rays_in_the_way(p->rays);
    for (uint32_t i = 0; i < s->hierarchy.count && s->bends; i++)
        s->hierarchy.elements[i].bend = 0;
    impact = impact || s->ranking.asked
             || (p->options.camera && refiner_reads(refiner, FACT_RECEIVER_IMPORTANCE));
    const int failed =
        (impact && importance_start(&s->importance, &s->operator, & s->hierarchy, &s->inputs) < 0)
        || (bracket && bracket_start(&s->bracket, &s->operator, & s->hierarchy) < 0);
    if (ranks_any(p->options.ranks, failed))
        return fail(s, "out of memory", cause);
    if (error > 0)
        error_control_start(&s->error, error, &s->hierarchy, &s->inputs);
    const struct limits limits = limits_complete(p->options.limits, p->options.ranks);
    if (ranks_any(p->options.ranks,
                  refinement_open(&s->refinement, &s->hierarchy, rays_host(p->rays), refiner,
                                  limits, p->options.threads)
                      < 0))
        return fail(s, refining, cause);
    s->refinement.watch = watch_refinement;
    s->refinement.watch_context = s;
    s->refinement.trace = s->trace;
    s->refinement.shares = ranks_count(p->options.ranks) > 1 ? &s->operator.shares : NULL;
    s->refinement.rays = p->rays;
    return 0;
}

int solve_renew_operator(struct solve *s, struct row_report *rows)
{
    if (s->report.changing == 0 && !s->linear.gradient)
        return 0;
    return row_sums_renew(&s->operator, rows);
}

int solve_recount(struct solve *s)
{
    solve_count_links(s);
    return ranks_any(s->problem.options.ranks, collocation_update(&s->operator) < 0) ? -1 : 0;
}

int solve_refine(struct solve *s, const struct refiner *refiner, const char **cause)
{
    const struct problem *p = &s->problem;
    const double start = seconds();
    if (solve_begin(s, refiner, cause) < 0)
        return -1;
    if (s->trace)
        s->trace->pass = 1;
    const int failed =
        (p->options.no_links ? refinement_resume(&s->refinement) : refinement_start(&s->refinement))
        < 0;
    if (limits_share(&s->refinement, p->options.ranks, failed)
        || shares_settle(&s->operator.shares, &s->refinement, s->hierarchy.built) < 0
        || ranks_any(p->options.ranks, solve_make_room(s) < 0))
        return fail(s, refining, cause);
    if (solve_recount(s) < 0)
        return fail(s, "out of memory", cause);
    if (!p->options.unit)
        solve_measure_contact(s, 0, 0);
    s->report.seconds.refine += seconds() - start;
    note_ray_seconds(s);
    return 0;
}

/* Solve for the radiosities over the links as they are, to `tolerance`, and for importance where it
 * is asked for; let the oracles see both. Returns 0 or -1. */
static int iterate(struct solve *s, double tolerance, int rough)
{
    struct light_operator *op = &s->operator;
    struct transport x = light(s, tolerance), carried;
    x.rough = rough;
    if (row_sums_renew(op, &s->report.rows) < 0)
        return -1;
    if (s->problem.options.solver == RAD_SOLVER_LU && !rough && solve_tell(s, "matrix"))
        return -1;
    x.watch = watch_light;
    x.watch_context = s;
    if (solve_transport(s, &x) < 0)
        return -1;
    s->report.converged = x.converged;
    s->report.tolerance = x.held;
    s->report.bound = x.bound;
    s->report.variation = x.variation;
    s->inputs.known = s->problem.options.tolerance > 0 ? s->problem.options.tolerance
                      : rough                          ? SOLVE_TOLERANCE
                                                       : x.held;
    transport_average(op, &x);
    if (oracle_inputs_update(&s->inputs, op, s->state.radiosity, &s->hierarchy) < 0)
        return -1;
    if (s->bends && bends_update(&s->inputs, op, s->state.radiosity, &s->hierarchy) < 0)
        return -1;
    if (s->bracket.capacity > 0 && bracket_update(&s->bracket, op, &s->hierarchy, &s->inputs) < 0)
        return -1;
    if (s->importance.capacity == 0)
        return 0;
    if (importance_open(&s->importance, op, &carried) < 0)
        return -1;
    carried.watch = watch_importance;
    carried.watch_context = s;
    if (solve_transport(s, &carried) < 0)
        return -1;
    s->importance.sweeps += carried.sweeps;
    s->report.converged &= carried.converged;
    importance_update(&s->importance, op, &s->hierarchy, &s->inputs);
    rays_tell_impact(s->problem.rays, s->importance.largest);
    return 0;
}

void solve_sum_power(struct solve *s)
{
    const struct problem *p = &s->problem;
    const double *irradiance = solve_shown(s)->irradiance;
    s->report.emitted = s->report.absorbed = 0;
    for (uint32_t i = 0; i < s->hierarchy.face_count; i++) {
        uint32_t e = s->hierarchy.face_element[i];
        double area = s->hierarchy.elements[e].area;
        for (uint32_t k = 0; k < p->bands; k++) {
            size_t at = (size_t)i * p->bands + k;
            s->report.emitted += area * s->operator.uncovered[e] * p->exitance[at];
            s->report.absorbed +=
                area * (1 - p->reflectance[at]) * irradiance[(size_t)e * p->bands + k];
        }
    }
}

/* Discuss the links of changed elements again and make room for what comes of it. Returns how
 * many changed, or -1. */
static int64_t refine_again(struct solve *s)
{
    uint32_t first = s->hierarchy.count;
    struct ranks *ranks = s->problem.options.ranks;
    int64_t changed = refinement_again(&s->refinement, s->inputs.changed);
    uint64_t all = changed > 0 ? (uint64_t)changed : 0;
    if (limits_share(&s->refinement, ranks, changed < 0))
        return -1;
    ranks_add_counts(ranks, RANKS_VALUES, &all, 1);
    if (all > 0
        && (shares_settle(&s->operator.shares, &s->refinement, first) < 0
            || ranks_any(ranks, collocation_update(&s->operator) < 0)))
        return -1;
    if (ranks_any(ranks, solve_make_room(s) < 0))
        return -1;
    solve_count_links(s);
    solve_measure_contact(s, first, 0);
    return (int64_t)all;
}

/* Under error control: lower error tolerances until some link changes for it, or nothing is left to
 * be gained. Returns how many links changed, or -1. */
static int64_t refine_for_error(struct solve *s)
{
    if (error_control_estimate(&s->error, &s->operator, s->state.radiosity) < 0)
        return -1;
    for (;;) {
        uint32_t lowered =
            error_control_tighten(&s->error, &s->operator, & s->hierarchy, &s->inputs);
        int64_t changed = refine_again(s);
        if (changed != 0 || lowered == 0)
            return changed;
        memset(s->inputs.changed, 0, s->hierarchy.count);
    }
}

/* Where links are ranked: those that are the worst now, and nothing else. Returns how many links
 * changed, or -1. */
static int64_t refine_worst(struct solve *s)
{
    if (ranking_update(&s->ranking, &s->operator, s->problem.rays, &s->inputs) < 0)
        return -1;
    return refine_again(s);
}

/* Solve once more over the final links for functions linear over the elements. Returns 0 or -1. */
static int solve_linear(struct solve *s, const char **cause)
{
    double tolerance = s->problem.options.tolerance;
    struct transport x = light(s, tolerance);
    if (!(tolerance > 0)) {
        s->report.variation = variation_of(&s->operator, & x);
        x.tolerance = variation_tolerance(s->report.variation);
    }
    x.watch = watch_light;
    x.watch_context = s;
    if (linear_solution_solve(&s->linear, &s->operator, & x, &s->report.rows) < 0)
        return fail(s, "out of memory for linear elements; a coarser oracle parameter needs less",
                    cause);
    s->report.converged &= x.converged;
    s->report.tolerance = x.tolerance;
    s->report.bound = x.bound;
    s->report.seconds.iterate += s->linear.seconds;
    solve_sum_power(s);
    return 0;
}

int solve_step(struct solve *s, const char **cause)
{
    const struct problem *p = &s->problem;
    /* error control holds an error anywhere, which what constants leave in the mean says nothing of
     */
    int fixed = s->error.target > 0 && !(p->options.tolerance > 0);
    double start = seconds(), tolerance = fixed ? SOLVE_TOLERANCE : p->options.tolerance;
    solve_forget_mended(s);
    int rough = !(s->error.target > 0) && s->report.counts.decided[DECISION_LINK_CLUSTERS] > 0;
    int settled = s->report.passes > 0 && s->report.changing * SETTLED <= s->report.counts.links;
    rough = rough && !settled && tolerance < ROUGH_TOLERANCE;
    if (iterate(s, rough ? ROUGH_TOLERANCE : tolerance, rough) < 0)
        return fail(s, "out of memory", cause);
    double middle = seconds();
    s->refinement.trace = s->trace;
    if (s->trace)
        s->trace->pass = s->report.passes + 2;
    int64_t changed = s->error.target > 0 ? refine_for_error(s)
                      : s->ranking.asked  ? refine_worst(s)
                                          : refine_again(s);
    if (changed < 0)
        return fail(s, refining, cause);
    s->report.passes++;
    s->report.changing = (uint64_t)changed;
    int few = (uint64_t)changed * SETTLED <= s->report.counts.links,
        linear = p->options.linear && !(s->error.target > 0) && !s->ranking.asked,
        done = linear ? few : changed == 0 && !rough;
    const int most = s->error.target > 0 || s->ranking.asked ? PASSES_IN_STEPS : PASSES,
              last = done || s->report.passes >= most;
    s->report.converged = (s->report.converged || rough) && done;
    s->report.seconds.iterate += middle - start;
    s->report.seconds.refine += seconds() - middle;
    note_ray_seconds(s);
    if (last && p->options.linear && solve_linear(s, cause) < 0)
        return -1;
    if (p->options.no_links && !p->options.unit)
        ambient_light(s);
    solve_sum_power(s);
    return !last;
}

int solve_with_factors(struct solve *s, const float *form_factors, const char **cause)
{
    struct refinement *r = &s->refinement;
    const double start = seconds();
    solve_forget_mended(s);
    for (size_t i = 0; i < r->link_count; i++) {
        struct link *l = &r->links[i];
        if (s->hierarchy.elements[l->receiver].vertices
            && s->hierarchy.elements[l->emitter].vertices)
            l->form_factor = form_factors[i];
    }
    if (iterate(s, s->problem.options.tolerance, 0) < 0)
        return fail(s, "out of memory", cause);
    s->report.passes++;
    s->report.changing = 0;
    s->report.seconds.iterate += seconds() - start;
    solve_sum_power(s);
    return 0;
}

int solve_run(struct solve *s, const struct refiner *refiner, const char **cause)
{
    int more = 1;
    if (!s->refinement.hierarchy && solve_refine(s, refiner, cause) < 0)
        return -1;
    while (more > 0) {
        if (s->between && s->between(s->between_context)) {
            s->report.cancelled = 1;
            return fail(s, "", cause);
        }
        more = solve_step(s, cause);
    }
    return more;
}
