/* petsc_equation.c - see petsc_equation.h.
 *
 * PETSc knows K by what it makes of a vector: area means of the leaves go up to the elements; a
 * VecScatter brings those that other ranks' links take light from; links between surfaces are a
 * matrix, AIJ, a column for every element that there is, used for all bands (MAIJ); links of groups
 * are added by separable_links.h; what comes of it is pushed down to the leaves, which reflect it
 * (push_pull.h).
 *
 * Invariant: rows are summed over links in the order that refinement_sort gives, so that how many
 * ranks there are does not show.
 * SPDX-License-Identifier: MIT */
#ifdef RADIOSITY_PETSC
#include "engine/petsc_equation.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "engine/push_pull.h"
#include "util/thread_pool.h"

/* ---- 1 - K */

static void gather_faces(const void *equation, size_t from, size_t to)
{
    const struct petsc_equation *q = equation;
    const struct transport *x = &q->step;
    for (size_t i = from; i < to; i++)
        separable_links_gather(&q->op->separable, (int)x->bands, q->own[i],
                               &x->irradiance[(size_t)q->own[i] * x->bands]);
}

static void update_faces(const void *equation, size_t from, size_t to)
{
    const struct petsc_equation *q = equation;
    for (size_t i = from; i < to; i++) {
        struct change unread;
        face_update(q->op, &q->step, q->op->hierarchy->face_element[q->op->shares.own[i]], &unread);
    }
}

PetscErrorCode petsc_equation_spread(struct petsc_equation *q, const double *x)
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
    struct petsc_equation *q;
    const double *from;
    double *to;
    PetscCall(MatShellGetContext(system, &q));
    const struct light_operator *op = q->op;
    const struct transport *t = &q->step;
    const int threads = operator_threads(op);
    PetscCall(VecGetArrayRead(x, &from));
    PetscCall(petsc_equation_spread(q, from));
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
static PetscErrorCode list_own(struct petsc_equation *q)
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
static PetscErrorCode make_room(struct petsc_equation *q, const struct transport *x)
{
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
static PetscErrorCode make_links(struct petsc_equation *q)
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
static PetscErrorCode make_scatter(struct petsc_equation *q, MPI_Comm comm, const PetscInt *first,
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

static PetscErrorCode make_ghosts(struct petsc_equation *q, MPI_Comm comm)
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

PetscErrorCode petsc_equation_open(struct petsc_equation *q, const struct light_operator *op,
                                   const struct transport *x)
{
    *q = (struct petsc_equation){.op = op};
    PetscErrorCode error = list_own(q);
    if (!error)
        error = make_room(q, x);
    return error ? error : make_links(q);
}

PetscErrorCode petsc_equation_join(struct petsc_equation *q, MPI_Comm comm)
{
    const PetscInt n = (PetscInt)(q->leaves * q->step.bands);
    PetscCall(make_ghosts(q, comm));
    PetscCall(MatCreateShell(comm, n, n, PETSC_DETERMINE, PETSC_DETERMINE, q, &q->system));
    return MatShellSetOperation(q->system, MATOP_MULT, (void (*)(void))multiply);
}

void petsc_equation_close(struct petsc_equation *q)
{
    MatDestroy(&q->system);
    VecScatterDestroy(&q->ghosts);
    VecDestroy(&q->sent);
    MatDestroy(&q->links);
    MatDestroy(&q->one);
    VecDestroy(&q->gathered);
    VecDestroy(&q->everywhere);
    free(q->step.value);
    free(q->row);
    free(q->column);
    free(q->weight);
    free(q->own);
    free(q->leaf);
}

#else
typedef int petsc_equation_nothing; /* a file has something in it */
#endif
