/* petsc_solution.c - see petsc_solution.h.
 *
 * The unknowns are the radiosities of the leaves that a rank has, all bands of them; the equation
 * is (1 - K) x = source, K as transport.c has it. PETSc knows K by what it makes of a vector: area
 * means of the leaves go up to the elements; a VecScatter brings those that other ranks' links take
 * light from; links between surfaces are a matrix, AIJ, a column for every element that there is,
 * used for all bands (MAIJ); links of groups are added by separable_links.h; what comes of it is
 * pushed down to the leaves, which reflect it (push_pull.h).
 *
 * When to stop. A sweep after this one changes leaf i by r_i, the residual of the equation, and the
 * bound that it is held against (transport.c) is that of max r_i / (1 - k_i). The method knows the
 * root of the sum of squares, no more: where that is what the tolerance leaves for the largest it
 * is enough, and where it is as much as if all r_i were alike the residual is made and held to the
 * bound, which costs a sweep; and again when it has got less by as much as the bound was above the
 * tolerance. Sweeps then say whether the bound holds, and do what is left: also of a method that
 * has taken twice as many steps as they would at the most, or has only made it worse.
 *
 * Invariant: rows are summed over links in the order that refinement_sort gives, and products of
 * vectors exactly (petsc_sums.h), so that how many ranks there are does not show.
 * [Saad and Schultz 1986 for GMRES, which is taken unless PETSc's options name another; Baranoski,
 * Bramley and Shirley 1995 for Krylov methods on radiosity]
 * SPDX-License-Identifier: MIT */
#include "engine/petsc_solution.h"

#ifdef RADIOSITY_PETSC
#include <limits.h>
#include <math.h>
#include <petscksp.h>
#include <stdlib.h>
#include <string.h>
#include "engine/petsc_start.h"
#include "engine/petsc_sums.h"
#include "engine/push_pull.h"
#include "kernel/constants.h"
#include "util/thread_pool.h"

/* By how much a norm gets less, at the least and at the most, before the residual is made again:
 * one or more steps of a method that does well, and no more than that it never comes. Chosen */
#define MOST_STEP 0.7
#define LEAST_STEP 0.01

int petsc_solution_built(void)
{
    return 1;
}

struct equation {
    const struct light_operator *op;
    struct transport *x;
    struct transport step;    /* without a source, on arrays of its own: what K makes of a vector */
    uint32_t *own, own_count; /* surfaces of this rank */
    uint32_t *leaf, leaves;   /* those of them that are not divided */
    int most;                 /* sweeps that it may take */
    double tolerance;
    /* means of all elements, and what they gather, as step's arrays */
    Vec everywhere, gathered;
    Vec sent;          /* of the own ones, for others: they alone; NULL: there is one rank */
    VecScatter ghosts; /* from there to everywhere */
    PetscInt *row, *column;
    double *weight; /* of the links between surfaces */
    Mat one, links; /* of one band; of all */
    Mat system;
    KSP method;
    void *by_norm; /* its own test */
    Vec found, source, product;
    double sum[3], until; /* sum A k; below this norm the residual is made */
    double begun;         /* norm before the first step; INFINITY: not asked */
    double rate;          /* what a sweep leaves of the largest residual at the most */
};

/* ---- 1 - K */

static void gather_faces(const void *equation, size_t from, size_t to)
{
    const struct equation *q = equation;
    const struct transport *x = &q->step;
    for (size_t i = from; i < to; i++)
        separable_links_gather(&q->op->separable, (int)x->bands, q->own[i],
                               &x->irradiance[(size_t)q->own[i] * x->bands]);
}

static void update_faces(const void *equation, size_t from, size_t to)
{
    const struct equation *q = equation;
    for (size_t i = from; i < to; i++) {
        struct change unread;
        face_update(q->op, &q->step, q->op->hierarchy->face_element[q->op->shares.own[i]], &unread);
    }
}

/* Into step.value, of the own elements what x[leaf] makes of them, and of others' what links take
 * light from. */
static PetscErrorCode spread(struct equation *q, const double *x)
{
    const struct transport *t = &q->step;
    const size_t size = t->bands * sizeof *x;
    for (size_t i = 0; i < q->leaves; i++)
        memcpy(&t->value[(size_t)q->leaf[i] * t->bands], &x[i * t->bands], size);
    for (size_t i = q->own_count; i-- > 0;) /* children follow their parents */
        if (q->op->hierarchy->elements[q->own[i]].children)
            element_average(q->op, t, q->own[i]);
    if (!q->sent)
        return 0;
    double *sent;
    PetscCall(VecGetArrayWrite(q->sent, &sent));
    for (size_t i = 0; i < q->own_count; i++)
        memcpy(&sent[i * t->bands], &t->value[(size_t)q->own[i] * t->bands], size);
    PetscCall(VecRestoreArrayWrite(q->sent, &sent));
    PetscCall(VecScatterBegin(q->ghosts, q->sent, q->everywhere, INSERT_VALUES, SCATTER_FORWARD));
    PetscCall(VecScatterEnd(q->ghosts, q->sent, q->everywhere, INSERT_VALUES, SCATTER_FORWARD));
    const struct shares *s = &q->op->shares;
    ranks_sends(s->ranks, RANKS_SWEEPS,
                (s->there.first[SWEEP_BLOCKS] + s->to_groups.first[1]) * size);
    return 0;
}

static PetscErrorCode multiply(Mat system, Vec x, Vec y)
{
    struct equation *q;
    const double *from;
    double *to;
    PetscCall(MatShellGetContext(system, &q));
    const struct light_operator *op = q->op;
    const struct transport *t = &q->step;
    const int threads = operator_threads(op);
    PetscCall(VecGetArrayRead(x, &from));
    PetscCall(spread(q, from));
    PetscCall(MatMult(q->links, q->everywhere, q->gathered));
    separable_links_send(&op->separable, (int)t->bands, t->value);
    if (op->separable.count > 0)
        thread_pool_run(threads, q->own_count, 256, gather_faces, q);
    thread_pool_run(threads, op->shares.own_first[SWEEP_BLOCKS], 64, update_faces, q);
    PetscCall(VecGetArrayWrite(y, &to));
    for (size_t i = 0; i < q->leaves; i++)
        for (uint32_t k = 0; k < t->bands; k++)
            to[i * t->bands + k] =
                from[i * t->bands + k] - t->value[(size_t)q->leaf[i] * t->bands + k];
    PetscCall(VecRestoreArrayWrite(y, &to));
    return VecRestoreArrayRead(x, &from);
}

/* ---- what it is made of */

/* Surfaces of this rank, and its leaves. */
static PetscErrorCode list_own(struct equation *q)
{
    const struct hierarchy *h = q->op->hierarchy;
    q->own = malloc((h->count + 1) * sizeof *q->own);
    q->leaf = malloc((h->count + 1) * sizeof *q->leaf);
    if (!q->own || !q->leaf)
        return PETSC_ERR_MEM;
    for (uint32_t e = 0; e < h->count; e++)
        if (h->elements[e].vertices && shares_mine(&q->op->shares, e)) {
            q->own[q->own_count++] = e;
            if (!h->elements[e].children)
                q->leaf[q->leaves++] = e;
        }
    return 0;
}

/* Arrays for what K makes of a vector. */
static PetscErrorCode make_room(struct equation *q)
{
    const struct transport *x = q->x;
    const size_t values = (size_t)q->op->hierarchy->count * x->bands;
    double *room = values <= INT_MAX ? calloc(2 * values, sizeof *room) : NULL;
    if (!room)
        return PETSC_ERR_MEM;
    q->step = (struct transport){.bands = x->bands,
                                 .value = room,
                                 .irradiance = room + values,
                                 .reflectance = x->reflectance};
    PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, (PetscInt)x->bands, (PetscInt)values,
                                    q->step.value, &q->everywhere));
    return VecCreateSeqWithArray(PETSC_COMM_SELF, (PetscInt)x->bands, (PetscInt)values,
                                 q->step.irradiance, &q->gathered);
}

/* Links between surfaces, a row for each element: others' have none here. */
static PetscErrorCode make_links(struct equation *q)
{
    const struct refinement *r = q->op->refinement;
    const struct hierarchy *h = q->op->hierarchy;
    const PetscInt count = (PetscInt)h->count, bands = (PetscInt)q->step.bands;
    q->row = malloc(((size_t)h->count + 1) * sizeof *q->row);
    q->column = malloc((r->link_count + 1) * sizeof *q->column);
    q->weight = malloc((r->link_count + 1) * sizeof *q->weight);
    if (!q->row || !q->column || !q->weight || r->link_count > INT_MAX)
        return PETSC_ERR_MEM;
    PetscInt n = 0;
    for (uint32_t e = 0; e < h->count; e++) {
        q->row[e] = n;
        for (size_t i = r->first_link[e]; h->elements[e].vertices && i < r->first_link[e + 1]; i++)
            if (h->elements[r->links[i].emitter].vertices) {
                q->column[n] = (PetscInt)r->links[i].emitter;
                q->weight[n++] = operator_weight(q->op, i);
            }
    }
    q->row[h->count] = n;
    PetscCall(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, count, count, q->row, q->column, q->weight,
                                        &q->one));
    /* Rows that are alike would be summed together, in pairs: which are depends on the rank. */
    PetscCall(MatSetOption(q->one, MAT_USE_INODES, PETSC_FALSE));
    return MatCreateMAIJ(q->one, bands, &q->links);
}

/* Where others' elements stand in `sent`: each rank's own ones one after the other. */
static PetscErrorCode make_scatter(struct equation *q, MPI_Comm comm, const PetscInt *first,
                                   PetscInt *place)
{
    const struct shares *s = &q->op->shares;
    const struct hierarchy *h = q->op->hierarchy;
    const PetscInt bands = (PetscInt)q->step.bands, ghosts = (PetscInt)shares_ghosts(s);
    IS from, to;
    PetscInt *next = malloc((size_t)ranks_count(s->ranks) * sizeof *next);
    if (!next)
        return PETSC_ERR_MEM;
    for (int k = 0; k < ranks_count(s->ranks); k++)
        next[k] = first[k];
    for (uint32_t e = 0; e < h->count; e++)
        if (h->elements[e].vertices)
            place[e] = next[shares_owner(s, e)]++;
    free(next);
    PetscInt *of = place + h->count, *at = of + ghosts;
    for (PetscInt i = 0; i < ghosts; i++) {
        at[i] = (PetscInt)shares_ghost(s, (size_t)i);
        of[i] = place[shares_ghost(s, (size_t)i)];
    }
    PetscCall(VecCreateMPI(comm, bands * (PetscInt)q->own_count, PETSC_DECIDE, &q->sent));
    PetscCall(ISCreateBlock(comm, bands, ghosts, of, PETSC_USE_POINTER, &from));
    PetscCall(ISCreateBlock(comm, bands, ghosts, at, PETSC_USE_POINTER, &to));
    PetscCall(VecScatterCreate(q->sent, from, q->everywhere, to, &q->ghosts));
    PetscCall(ISDestroy(&from));
    return ISDestroy(&to);
}

static PetscErrorCode make_ghosts(struct equation *q, MPI_Comm comm)
{
    const struct shares *s = &q->op->shares;
    const size_t ranks = (size_t)ranks_count(s->ranks);
    if (ranks == 1)
        return 0;
    PetscInt *first = calloc(ranks + 1, sizeof *first),
             *place = malloc((q->op->hierarchy->count + 2 * shares_ghosts(s) + 1) * sizeof *place);
    PetscErrorCode error = ranks_any(s->ranks, !first || !place) ? PETSC_ERR_MEM : 0;
    if (!error) {
        for (uint32_t e = 0; e < q->op->hierarchy->count; e++)
            if (q->op->hierarchy->elements[e].vertices)
                first[shares_owner(s, e) + 1]++;
        for (size_t k = 0; k < ranks; k++)
            first[k + 1] += first[k];
        error = make_scatter(q, comm, first, place);
    }
    free(first);
    free(place);
    return error;
}

/* ---- the solution */

/* What light the leaf i of this rank sends for a radiosity of 1 everywhere, in band k. */
static double grown(const struct equation *q, size_t i, uint32_t k)
{
    const uint32_t e = q->leaf[i];
    return q->x->reflectance[(size_t)q->op->hierarchy->elements[e].face * q->x->bands + k]
           * q->op->row[e];
}

/* What |r| may be for the bound to hold whatever r is; 0: there is no light, none is reflected, or
 * rows are too large for a bound. */
static double allowed(struct equation *q)
{
    const struct light_operator *op = q->op;
    const struct transport *x = q->x;
    enum { POWER, LEAVES, SUM, SUMS = SUM + 3 };
    double sums[SUMS] = {0}, most = 0, all = 0;
    sums[LEAVES] = q->leaves;
    for (size_t i = 0; i < q->leaves; i++) {
        const double area = op->hierarchy->elements[q->leaf[i]].area * op->uncovered[q->leaf[i]];
        for (uint32_t k = 0; k < x->bands; k++) {
            sums[POWER] += area * x->value[(size_t)q->leaf[i] * x->bands + k];
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
static PetscErrorCode count(struct equation *q)
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
static PetscErrorCode measure(struct equation *q, double *left)
{
    const struct transport *x = q->x;
    struct ranks *ranks = q->op->shares.ranks;
    Vec found;
    const double *value, *product, *source;
    double most[3] = {0, 0, 0}, power = 0;
    PetscCall(KSPBuildSolution(q->method, NULL, &found));
    PetscCall(MatMult(q->system, found, q->product));
    PetscCall(VecGetArrayRead(found, &value));
    PetscCall(VecGetArrayRead(q->product, &product));
    PetscCall(VecGetArrayRead(q->source, &source));
    for (size_t i = 0; i < q->leaves; i++)
        for (uint32_t k = 0; k < x->bands; k++) {
            const size_t at = i * x->bands + k;
            const uint32_t e = q->leaf[i];
            most[k] = fmax(most[k], fabs(source[at] - product[at]) / (1 - grown(q, i, k)));
            power += q->op->hierarchy->elements[e].area * q->op->uncovered[e] * value[at];
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
    struct equation *q = equation;
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

static PetscErrorCode make_method(struct equation *q, MPI_Comm comm, double left)
{
    const PetscInt n = (PetscInt)(q->leaves * q->step.bands);
    PetscCall(VecCreate(comm, &q->found));
    PetscCall(VecSetSizes(q->found, n, PETSC_DECIDE));
    PetscCall(VecSetType(q->found, VECMPI));
    petsc_sums_exactly(q->found);
    PetscCall(VecDuplicate(q->found, &q->source));
    PetscCall(VecDuplicate(q->found, &q->product));
    PetscCall(MatCreateShell(comm, n, n, PETSC_DETERMINE, PETSC_DETERMINE, q, &q->system));
    PetscCall(MatShellSetOperation(q->system, MATOP_MULT, (void (*)(void))multiply));
    PetscCall(KSPCreate(comm, &q->method));
    PetscCall(KSPSetOperators(q->method, q->system, q->system));
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

static PetscErrorCode solve(struct equation *q)
{
    const struct transport *x = q->x;
    const uint32_t bands = x->bands;
    double *found, *source;
    PetscCall(VecGetArrayWrite(q->found, &found));
    PetscCall(VecGetArrayWrite(q->source, &source));
    for (size_t i = 0; i < q->leaves; i++) {
        const size_t e = q->leaf[i],
                     of = (x->by_element ? e : q->op->hierarchy->elements[e].face) * bands;
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
static PetscErrorCode keep(struct equation *q)
{
    const struct shares *s = &q->op->shares;
    struct transport *x = q->x;
    const size_t size = x->bands * sizeof *x->value, ghosts = q->sent ? shares_ghosts(s) : 0;
    const double *found;
    KSPConvergedReason reason;
    PetscCall(KSPGetConvergedReason(q->method, &reason));
    PetscReal norm;
    PetscCall(KSPGetResidualNorm(q->method, &norm));
    if ((reason < 0 && reason != KSP_DIVERGED_ITS) || !(norm <= q->begun))
        return 0; /* it has gone astray: sweeps go on from where it began */
    PetscCall(VecGetArrayRead(q->found, &found));
    PetscCall(spread(q, found));
    PetscCall(VecRestoreArrayRead(q->found, &found));
    for (size_t i = 0; i < q->own_count + ghosts; i++) {
        const size_t e = i < q->own_count ? q->own[i] : shares_ghost(s, i - q->own_count);
        memcpy(&x->value[e * x->bands], &q->step.value[e * x->bands], size);
    }
    return 0;
}

static PetscErrorCode make_and_solve(struct equation *q, MPI_Comm comm)
{
    struct ranks *ranks = q->op->shares.ranks;
    PetscErrorCode error = list_own(q);
    if (!error)
        error = make_room(q);
    if (!error)
        error = make_links(q);
    if (ranks_any(ranks, error != 0)) /* what follows waits for all */
        return error ? error : PETSC_ERR_MEM;
    const double left = allowed(q);
    if (!(left > 0)) /* nothing to be solved, or rows too large for a bound: sweeps do it */
        return 0;
    PetscCall(make_ghosts(q, comm));
    PetscCall(make_method(q, comm, left));
    PetscCall(solve(q));
    return keep(q);
}

int petsc_solution_make(const struct light_operator *op, struct transport *x)
{
    struct equation q = {.op = op,
                         .x = x,
                         .begun = INFINITY,
                         .most = op->problem->options.iterations - 1,
                         .tolerance = x->tolerance > 0 ? x->tolerance : SOLVE_TOLERANCE};
    struct ranks *ranks = op->shares.ranks;
    MPI_Comm comm;
    int error = petsc_begin(ranks, &comm);
    if (!ranks_any(ranks, error) && q.most > 0)
        error = (int)make_and_solve(&q, comm);
    KSPDestroy(&q.method);
    if (q.by_norm)
        KSPConvergedDefaultDestroy(q.by_norm);
    MatDestroy(&q.system);
    VecDestroy(&q.product);
    VecDestroy(&q.source);
    VecDestroy(&q.found);
    VecScatterDestroy(&q.ghosts);
    VecDestroy(&q.sent);
    MatDestroy(&q.links);
    MatDestroy(&q.one);
    VecDestroy(&q.gathered);
    VecDestroy(&q.everywhere);
    free(q.step.value);
    free(q.row);
    free(q.column);
    free(q.weight);
    free(q.own);
    free(q.leaf);
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
