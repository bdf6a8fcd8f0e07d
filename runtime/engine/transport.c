/* transport.c - iteration over the links, and when it stops.
 *
 * A sweep gathers H_r += F V x_s over the links of every element, pushes it down to the leaves,
 * where x = source + rho H, and pulls area means up (push_pull.c). A sweep goes through the faces
 * in blocks, every sixteenth face in one; within a block all gather first and are updated then, so
 * the result is the same for any number of threads, and of ranks, each of which has its own faces
 * of every block and tells the others of them then (shares.h). One block is Jacobi's method, many
 * are Gauss-Seidel's. Southwell's shoots
 * between Jacobi's sweeps (southwell.c); LU solves a dense matrix before the first (dense.c), and
 * PETSc by a Krylov method (petsc_solution.c): whichever it is, a sweep says what is left, and all
 * stop by the same bound.
 *
 * When to stop. A sweep is x_n = s + L x_n + U x_(n-1) with L + U = K >= 0, the operator (L = 0 is
 * Jacobi's); so errors and changes go as e_n = T e_(n-1), d_n = x_n - x_(n-1) = (T - 1) e_(n-1), T
 * = (1 - L)^-1 U. A value of 1 everywhere makes k_i = rho_i row_i at leaf i by K, the rows as
 * row_sums.c leaves them, and no more by T. So with a = max |d_n| / (1 - k),
 *     |e_(n-1)| <= a everywhere,  |e_n| <= a k_i at leaf i,  sum A |e_n| <= a sum A k,
 * and that, over sum A x and summed over bands, is the bound that the tolerance is held against.
 * The largest k may be above rho, for the cap allows rows up to 1 + (1 - rho) / 2; it is below 1
 * all the same. The change is taken in the norm in which K is known to contract, largest modulus;
 * sum A |d| would not do: there its factor is the largest column, and since caps and closure scale
 * rows alone, A_i F_ij = A_j F_ji does not hold and columns may exceed 1.
 * [Arvo et al. 1994, sections 5.3 and 6.3, for the norms; derived here]
 * Where one place is far brighter than the mean the bound is hundreds of times what is left. A
 * rough solve, which another one follows, stops by an estimate: as if every sweep left rho, the
 * largest reflectance, of the change before; Southwell's by its ambient estimate, in which what is
 * unshot goes on among all surfaces and rho is their mean.
 *
 * Where Gauss-Seidel's sweeps are slow the limit is guessed from time to time (extrapolation.h).
 *
 * How far down. A change too small to see may turn a last digit, and that change turn it back a
 * sweep later: for ever, at a bound that falls no more. Sweeps end then, if that change, the
 * residual, is no more than double precision is worth; or the bound no more than single precision,
 * in which what groups send is summed.
 *
 * To which tolerance. Constants on leaves have an error that no sweep takes away; a tenth of it is
 * little beside it (variation.c), and where nobody asks for another tolerance that is the one.
 * [Arvo et al. 1994, section 6.3, for the balance]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "engine/dense.h"
#include "engine/extrapolation.h"
#include "engine/petsc_solution.h"
#include "engine/push_pull.h"
#include "engine/southwell.h"
#include "engine/transport.h"
#include "engine/variation.h"
#include "kernel/constants.h"
#include "util/thread_pool.h"

void transport_average(const struct light_operator *op, struct transport *x)
{
    for (uint32_t e = op->hierarchy->count; e-- > 0;) /* children follow their parents */
        if (!op->hierarchy->elements[e].vertices)
            element_average(op, x, e);
}

/* Of one block. */
struct block {
    const struct light_operator *op;
    const struct transport *x;
    struct change *change; /* [face] */
    const uint32_t *face;  /* [of the block] */
};

static void gather_faces(const void *block, size_t from, size_t to)
{
    const struct block *b = block;
    for (size_t i = from; i < to; i++)
        face_gather(b->op, b->x, b->op->hierarchy->face_element[b->face[i]]);
}

static void update_faces(const void *block, size_t from, size_t to)
{
    const struct block *b = block;
    for (size_t i = from; i < to; i++)
        face_update(b->op, b->x, b->op->hierarchy->face_element[b->face[i]],
                    &b->change[b->face[i]]);
}

void transport_sweep(const struct light_operator *op, const struct transport *x, int jacobi,
                     struct change *change, double *room)
{
    const struct shares *s = &op->shares;
    const int threads = operator_threads(op);
    separable_links_send(&op->separable, (int)x->bands, x->value);
    for (uint32_t i = 0; i < SWEEP_BLOCKS; i++) {
        const uint32_t from = s->own_first[i], to = s->own_first[jacobi ? SWEEP_BLOCKS : i + 1];
        const struct block b = {op, x, change, s->own + from};
        thread_pool_run(threads, to - from, 8, gather_faces, &b);
        thread_pool_run(threads, to - from, 64, update_faces, &b);
        if (jacobi)
            break;
        shares_tell_block(s, i, x->value, x->bands, room);
    }
    for (uint32_t i = 0; jacobi && i < SWEEP_BLOCKS; i++)
        shares_tell_block(s, i, x->value, x->bands, room);
    shares_tell_groups(s, x->value, x->bands, room);
}

/* Residual and bound after a sweep. */
static void measure(const struct light_operator *op, struct transport *x,
                    const struct change *change)
{
    const struct shares *s = &op->shares;
    enum { MOVED, POWER, SUM, SUMS = SUM + 3 };
    double sums[SUMS] = {0}, most[3] = {0, 0, 0}, left = 0;
    for (uint32_t f = 0; f < op->hierarchy->face_count; f++) {
        if (s->owner && s->owner[f] != ranks_number(s->ranks))
            continue;
        sums[MOVED] += change[f].moved;
        for (uint32_t k = 0; k < x->bands; k++) {
            sums[POWER] += change[f].power[k];
            sums[SUM + k] += change[f].sum[k];
            most[k] = fmax(most[k], change[f].most[k]);
        }
    }
    ranks_add(s->ranks, RANKS_SWEEPS, sums, SUMS);
    ranks_most(s->ranks, RANKS_SWEEPS, most, 3);
    for (uint32_t k = 0; k < x->bands; k++)
        left += most[k] > 0 && sums[SUM + k] > 0 ? most[k] * sums[SUM + k] : 0;
    x->moved = sums[MOVED];
    x->residual = sums[POWER] > 0 ? sums[MOVED] / sums[POWER] : 0;
    x->bound = !(left > 0) ? 0 : sums[POWER] > 0 ? left / sums[POWER] : INFINITY;
}

/* By how much the estimate of a rough solve takes each reflection to weaken light. */
static double reflects(const struct light_operator *op, const struct transport *x)
{
    double most = 0;
    if (op->problem->options.solver == RAD_SOLVER_SOUTHWELL)
        return southwell_reflects(op, x);
    for (size_t i = 0; i < (size_t)op->hierarchy->face_count * x->bands; i++)
        most = fmax(most, x->reflectance[i]);
    return most;
}

/* What is left after a sweep, as far as it is to be within the tolerance, over that: at most 1 when
 * the solve may stop. */
static double left_of(const struct light_operator *op, struct transport *x, double rho)
{
    x->held = x->tolerance;
    if (x->rough)
        return x->residual * rho / ((1 - rho) * x->tolerance);
    if (!(x->tolerance > 0)) {
        x->held = SOLVE_TOLERANCE_MOST;
        if (x->bound <= x->held) {
            x->variation = variation_of(op, x);
            x->held = variation_tolerance(x->variation);
        }
    }
    return x->bound / x->held;
}

int transport_stalled(const struct light_operator *op, const struct transport *x,
                      struct stall *stall)
{
    stall->sweeps = stall->sweeps && x->bound >= stall->least ? stall->sweeps + 1 : 1;
    if (stall->sweeps == 1)
        stall->least = x->bound;
    return stall->sweeps > SOLVE_STALLED
           && (x->residual <= SOLVE_DOUBLE
               || (x->bound <= SOLVE_SINGLE && op->separable.count > 0));
}

/* Sweeps, between which Southwell's method shoots. */
static int iterate(const struct light_operator *op, struct transport *x, struct change *change,
                   double *room, struct southwell *shooter)
{
    const int jacobi = op->problem->options.solver == RAD_SOLVER_JACOBI || shooter;
    const int most = op->problem->options.iterations;
    const double rho = reflects(op, x);
    const size_t values = (size_t)op->hierarchy->count * x->bands;
    struct extrapolation guess = {.steady = 0};
    struct stall stall = {.sweeps = 0};
    int stopped = 0;
    while (x->sweeps < most && !x->converged && !stopped) {
        if (shooter)
            southwell_keep(shooter, op, x);
        if (!jacobi)
            extrapolation_keep(&guess, GUESS_MEANS, x->value, values);
        transport_sweep(op, x, jacobi, change, room);
        measure(op, x, change);
        x->sweeps++;
        double left = left_of(op, x, rho);
        x->converged = left <= 1 || (!x->rough && transport_stalled(op, x, &stall));
        stopped = x->watch && x->watch(x->watch_context, x);
        const double factor = jacobi ? 0 : extrapolation_factor(&guess, x->moved);
        if (factor > 0 && !x->converged) {
            extrapolation_add(&guess, GUESS_MEANS, factor, x->value, values);
            shares_tell_groups(&op->shares, x->value, x->bands, room);
        }
        if (shooter && !x->converged && !stopped)
            stopped = southwell_shoot(shooter, op, x, left, most) < 0;
    }
    extrapolation_close(&guess);
    if (shooter && !x->converged && !stopped)
        southwell_ambient(shooter, op, x);
    return stopped ? -1 : 0;
}

/* What comes before the first sweep. A rough solve takes so few that nothing has to. Returns 0 or
 * -1. */
static int prepare(const struct light_operator *op, struct transport *x)
{
    const enum RadSolver solver = op->problem->options.solver;
    return x->rough                     ? 0
           : solver == RAD_SOLVER_LU    ? dense_solve(op, x)
           : solver == RAD_SOLVER_PETSC ? petsc_solution_make(op, x)
                                        : 0;
}

int transport_solve(const struct light_operator *op, struct transport *x)
{
    const enum RadSolver solver = op->problem->options.solver;
    struct change *change = malloc(op->hierarchy->face_count * sizeof *change);
    double *room = malloc((shares_room(&op->shares) * x->bands + 1) * sizeof *room);
    struct southwell *shooter = solver == RAD_SOLVER_SOUTHWELL ? southwell_new(op, x) : NULL;
    int status = -1;
    x->sweeps = x->converged = 0;
    x->variation = 0;
    x->cause[0] = 0;
    if (!ranks_any(op->shares.ranks,
                   !change || !room || (!shooter && solver == RAD_SOLVER_SOUTHWELL))
        && prepare(op, x) == 0)
        status = iterate(op, x, change, room, shooter);
    southwell_free(shooter);
    free(room);
    free(change);
    return status;
}
