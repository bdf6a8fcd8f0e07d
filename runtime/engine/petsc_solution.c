/* petsc_solution.c - see petsc_solution.h.
 *
 * What is solved is petsc_equation.h's.
 *
 * When to stop. A sweep after this one changes leaf i by r_i, the residual of the equation, and the
 * bound that it is held against (transport.c) is that of max r_i / (1 - k_i). The method knows the
 * root of the sum of squares, no more: where that is what the tolerance leaves for the largest it
 * is enough, and where it is as much as if all r_i were alike the residual is made and held to the
 * bound, which costs a sweep; and again when it has got less by as much as the bound was above the
 * tolerance. Sweeps then say whether the bound holds, and do what is left: also of a method that
 * has taken twice as many steps as they would at the most, or has only made it worse.
 *
 * Invariant: products of vectors are summed exactly (petsc_sums.h), so that how many ranks there
 * are does not show. [Saad and Schultz 1986 for GMRES, which is taken unless PETSc's options name
 * another; Baranoski, Bramley and Shirley 1995 for Krylov methods on radiosity]
 * SPDX-License-Identifier: MIT */
#include "engine/petsc_solution.h"

#ifdef RADIOSITY_PETSC
#include <math.h>
#include <string.h>
#include "engine/petsc_equation.h"
#include "engine/petsc_start.h"
#include "engine/petsc_sums.h"
#include "kernel/constants.h"

/* By how much a norm gets less, at the least and at the most, before the residual is made again:
 * one or more steps of a method that does well, and no more than that it never comes. Chosen */
#define MOST_STEP 0.7
#define LEAST_STEP 0.01

int petsc_solution_built(void)
{
    return 1;
}

struct solving {
    struct petsc_equation of;
    struct transport *x;
    int most; /* sweeps that it may take */
    double tolerance;
    KSP method;
    void *by_norm; /* its own test */
    Vec found, source, product;
    double sum[3], until; /* sum A k; below this norm the residual is made */
    double begun;         /* norm before the first step; INFINITY: not asked */
    double rate;          /* what a sweep leaves of the largest residual at the most */
};

/* What light the leaf i of this rank sends for a radiosity of 1 everywhere, in band k. */
static double grown(const struct solving *q, size_t i, uint32_t k)
{
    const uint32_t e = q->of.leaf[i];
    return q->x->reflectance[(size_t)q->of.op->hierarchy->elements[e].face * q->x->bands + k]
           * q->of.op->row[e];
}

/* What |r| may be for the bound to hold whatever r is; 0: there is no light, none is reflected, or
 * rows are too large for a bound. */
static double allowed(struct solving *q)
{
    const struct light_operator *op = q->of.op;
    const struct transport *x = q->x;
    enum { POWER, LEAVES, SUM, SUMS = SUM + 3 };
    double sums[SUMS] = {0}, most = 0, all = 0;
    sums[LEAVES] = q->of.leaves;
    for (size_t i = 0; i < q->of.leaves; i++) {
        const double area =
            op->hierarchy->elements[q->of.leaf[i]].area * op->uncovered[q->of.leaf[i]];
        for (uint32_t k = 0; k < x->bands; k++) {
            sums[POWER] += area * x->value[(size_t)q->of.leaf[i] * x->bands + k];
            sums[SUM + k] += area * grown(q, i, k);
            most = fmax(most, grown(q, i, k));
        }
    }
    ranks_add(op->shares.ranks, RANKS_SWEEPS, sums, SUMS);
    ranks_most(op->shares.ranks, RANKS_SWEEPS, &most, 1);
    for (int k = 0; k < 3; k++)
        all += q->sum[k] = sums[SUM + k];
    const double left = all > 0 ? q->tolerance * sums[POWER] / all * (1 - most) : 0;
    q->until = left * sqrt(sums[LEAVES] * x->bands);
    q->rate = most;
    return left > 0 ? left : 0;
}

/* A step of the method is a sweep, as messages and work go. Returns nonzero when it is to stop. */
static PetscErrorCode count(struct solving *q)
{
    struct transport *x = q->x;
    x->sweeps++;
    return x->watch && x->watch(x->watch_context, x) ? PETSC_ERR_USER : 0;
}

static PetscErrorCode watch(KSP method, PetscInt step, PetscReal norm, void *equation)
{
    (void)method, (void)norm;
    return step > 0 ? count(equation) : 0;
}

/* The bound of what is found so far, over the tolerance. */
static PetscErrorCode measure(struct solving *q, double *left)
{
    const struct transport *x = q->x;
    struct ranks *ranks = q->of.op->shares.ranks;
    Vec found;
    const double *value, *product, *source;
    double most[3] = {0, 0, 0}, power = 0;
    PetscCall(KSPBuildSolution(q->method, NULL, &found));
    PetscCall(MatMult(q->of.system, found, q->product));
    PetscCall(VecGetArrayRead(found, &value));
    PetscCall(VecGetArrayRead(q->product, &product));
    PetscCall(VecGetArrayRead(q->source, &source));
    for (size_t i = 0; i < q->of.leaves; i++)
        for (uint32_t k = 0; k < x->bands; k++) {
            const size_t at = i * x->bands + k;
            const uint32_t e = q->of.leaf[i];
            most[k] = fmax(most[k], fabs(source[at] - product[at]) / (1 - grown(q, i, k)));
            power += q->of.op->hierarchy->elements[e].area * q->of.op->uncovered[e] * value[at];
        }
    PetscCall(VecRestoreArrayRead(q->source, &source));
    PetscCall(VecRestoreArrayRead(q->product, &product));
    PetscCall(VecRestoreArrayRead(found, &value));
    ranks_add(ranks, RANKS_SWEEPS, &power, 1);
    ranks_most(ranks, RANKS_SWEEPS, most, 3);
    *left = 0;
    for (int k = 0; k < 3; k++)
        *left += most[k] * q->sum[k] / (power * q->tolerance);
    return count(q);
}

/* Whether the method may stop. */
static PetscErrorCode test(KSP method, PetscInt step, PetscReal norm, KSPConvergedReason *reason,
                           void *equation)
{
    struct solving *q = equation;
    double left = 0;
    PetscReal least;
    PetscCall(KSPGetTolerances(method, NULL, &least, NULL, NULL));
    if (step == 0)
        q->begun = norm;
    PetscCall(KSPConvergedDefault(method, step, norm, reason, q->by_norm));
    /* after so many sweeps the largest residual is below `least`: each leaves `rate` of it */
    if (!*reason && step > 2 * log(least / q->begun) / log(q->rate))
        *reason = KSP_DIVERGED_ITS;
    if (*reason || step == 0 || norm > q->until)
        return 0;
    PetscCall(measure(q, &left));
    if (left <= 1)
        *reason = KSP_CONVERGED_ATOL;
    else
        q->until = norm * fmax(LEAST_STEP, fmin(MOST_STEP, 1 / left));
    return 0;
}

static PetscErrorCode make_method(struct solving *q, MPI_Comm comm, double left)
{
    const PetscInt n = (PetscInt)(q->of.leaves * q->of.step.bands);
    PetscCall(VecCreate(comm, &q->found));
    PetscCall(VecSetSizes(q->found, n, PETSC_DECIDE));
    PetscCall(VecSetType(q->found, VECMPI));
    petsc_sums_exactly(q->found);
    PetscCall(VecDuplicate(q->found, &q->source));
    PetscCall(VecDuplicate(q->found, &q->product));
    PetscCall(KSPCreate(comm, &q->method));
    PetscCall(KSPSetOperators(q->method, q->of.system, q->of.system));
    PetscCall(KSPSetType(q->method, KSPGMRES));
    PC none;
    PetscCall(KSPGetPC(q->method, &none));
    PetscCall(PCSetType(none, PCNONE));
    PetscCall(KSPSetInitialGuessNonzero(q->method, PETSC_TRUE));
    PetscCall(KSPSetTolerances(q->method, 1e-15, left, PETSC_DEFAULT, q->most));
    PetscCall(KSPConvergedDefaultCreate(&q->by_norm));
    PetscCall(KSPSetConvergenceTest(q->method, test, q, NULL));
    PetscCall(KSPMonitorSet(q->method, watch, q, NULL));
    return KSPSetFromOptions(q->method);
}

static PetscErrorCode solve(struct solving *q)
{
    const struct transport *x = q->x;
    const uint32_t bands = x->bands;
    double *found, *source;
    PetscCall(VecGetArrayWrite(q->found, &found));
    PetscCall(VecGetArrayWrite(q->source, &source));
    for (size_t i = 0; i < q->of.leaves; i++) {
        const size_t e = q->of.leaf[i],
                     of = (x->by_element ? e : q->of.op->hierarchy->elements[e].face) * bands;
        for (size_t k = 0; k < bands; k++) {
            found[i * bands + k] = x->value[e * bands + k];
            source[i * bands + k] = x->source ? x->source[of + k] : 0;
        }
    }
    PetscCall(VecRestoreArrayWrite(q->source, &source));
    PetscCall(VecRestoreArrayWrite(q->found, &found));
    return KSPSolve(q->method, q->source, q->found);
}

/* Let x have it: this rank's elements, and others' that links take light from. */
static PetscErrorCode keep(struct solving *q)
{
    const struct shares *s = &q->of.op->shares;
    struct transport *x = q->x;
    const size_t size = x->bands * sizeof *x->value, ghosts = q->of.sent ? shares_ghosts(s) : 0;
    const double *found;
    KSPConvergedReason reason;
    PetscCall(KSPGetConvergedReason(q->method, &reason));
    PetscReal norm;
    PetscCall(KSPGetResidualNorm(q->method, &norm));
    if ((reason < 0 && reason != KSP_DIVERGED_ITS) || !(norm <= q->begun))
        return 0; /* it has gone astray: sweeps go on from where it began */
    PetscCall(VecGetArrayRead(q->found, &found));
    PetscCall(petsc_equation_spread(&q->of, found));
    PetscCall(VecRestoreArrayRead(q->found, &found));
    for (size_t i = 0; i < q->of.own_count + ghosts; i++) {
        const size_t e = i < q->of.own_count ? q->of.own[i] : shares_ghost(s, i - q->of.own_count);
        memcpy(&x->value[e * x->bands], &q->of.step.value[e * x->bands], size);
    }
    return 0;
}

static PetscErrorCode make_and_solve(struct solving *q, const struct light_operator *op,
                                     MPI_Comm comm)
{
    const PetscErrorCode error = petsc_equation_open(&q->of, op, q->x);
    if (ranks_any(op->shares.ranks, error != 0)) /* what follows waits for all */
        return error ? error : PETSC_ERR_MEM;
    const double left = allowed(q);
    if (!(left > 0)) /* nothing to be solved, or rows too large for a bound: sweeps do it */
        return 0;
    PetscCall(petsc_equation_join(&q->of, comm));
    PetscCall(make_method(q, comm, left));
    PetscCall(solve(q));
    return keep(q);
}

int petsc_solution_make(const struct light_operator *op, struct transport *x)
{
    struct solving q = {.x = x,
                        .begun = INFINITY,
                        .most = op->problem->options.iterations - 1,
                        .tolerance = x->tolerance > 0 ? x->tolerance : SOLVE_TOLERANCE};
    struct ranks *ranks = op->shares.ranks;
    MPI_Comm comm;
    int error = petsc_begin(ranks, &comm);
    if (!ranks_any(ranks, error) && q.most > 0)
        error = (int)make_and_solve(&q, op, comm);
    KSPDestroy(&q.method);
    if (q.by_norm)
        KSPConvergedDefaultDestroy(q.by_norm);
    VecDestroy(&q.product);
    VecDestroy(&q.source);
    VecDestroy(&q.found);
    petsc_equation_close(&q.of);
    return petsc_end(ranks, error, x->cause, sizeof x->cause);
}

#else

int petsc_solution_built(void)
{
    return 0;
}

int petsc_solution_make(const struct light_operator *op, struct transport *x)
{
    (void)op, (void)x;
    return -1;
}

#endif
