/* petsc_sums.c - see petsc_sums.h.
 *
 * Krylov methods take each step by dot products, and a sum of doubles depends on where it is cut:
 * with other ranks, other last bits, and in the end another link. So products are cut into two
 * integers each, relative to the largest of all, and integers are added, in any order. What is cut
 * off is below the largest times 2^-62; with 2^31 values, below that times 2^-31 in all.
 *
 * Two messages for one. The methods that ask for products in other ways, by halves that they add
 * themselves (pipelined ones), get PETSc's own.
 *
 * Of PETSc's insides this file alone knows: there is no other way to a vector's own sums.
 * [Demmel and Nguyen 2015, reproducible sums by bins, of which this is the plainest]
 * SPDX-License-Identifier: MIT */
#ifdef RADIOSITY_PETSC
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <petsc/private/vecimpl.h>
#include "engine/petsc_sums.h"

enum { TOGETHER = 32, BITS = 62 }; /* products of one message; of an integer, before its sign */

/* Below this nothing is left, and above its inverse nothing finite: no power of two runs over. */
static const double LEAST = 1e-250;

struct halves {
    uint64_t high, low; /* of signed integers: sums wrap around and come back */
};

static double largest(const double *x, const double *y, PetscInt n)
{
    double most = 0;
    for (PetscInt i = 0; i < n; i++) {
        const double t = fabs(x[i] * y[i]);
        most = t <= most ? most : t <= DBL_MAX ? t : INFINITY;
    }
    return most;
}

/* scale: the largest product takes `bits` bits. */
static struct halves cut(const double *x, const double *y, PetscInt n, double scale, int bits)
{
    struct halves all = {0, 0};
    const double fine = ldexp(1, bits);
    for (PetscInt i = 0; i < n; i++) {
        const double t = x[i] * y[i] * scale;
        const int64_t high = (int64_t)t;
        all.high += (uint64_t)high;
        all.low += (uint64_t)(int64_t)((t - (double)high) * fine);
    }
    return all;
}

/* x . y[j], of at most TOGETHER. */
static PetscErrorCode multiply(Vec x, PetscInt count, const Vec y[], double *value)
{
    const MPI_Comm all = PetscObjectComm((PetscObject)x);
    const double *own, *other;
    double most[TOGETHER];
    int exponent[TOGETHER], bits = BITS;
    struct halves sum[TOGETHER];
    PetscInt n, whole;
    PetscCall(VecGetLocalSize(x, &n));
    PetscCall(VecGetSize(x, &whole));
    for (PetscInt k = 1; k < whole && bits > BITS / 2; k *= 2)
        bits--;
    PetscCall(VecGetArrayRead(x, &own));
    for (PetscInt j = 0; j < count; j++) {
        PetscCall(VecGetArrayRead(y[j], &other));
        most[j] = largest(own, other, n);
        PetscCall(VecRestoreArrayRead(y[j], &other));
    }
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, (int)count, MPI_DOUBLE, MPI_MAX, all));
    for (PetscInt j = 0; j < count; j++) {
        sum[j] = (struct halves){0, 0};
        if (!(most[j] > LEAST && most[j] < 1 / LEAST))
            continue;
        frexp(most[j], &exponent[j]);
        PetscCall(VecGetArrayRead(y[j], &other));
        sum[j] = cut(own, other, n, ldexp(1, bits - exponent[j]), bits);
        PetscCall(VecRestoreArrayRead(y[j], &other));
    }
    PetscCall(VecRestoreArrayRead(x, &own));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2 * (int)count, MPI_UINT64_T, MPI_SUM, all));
    for (PetscInt j = 0; j < count; j++)
        value[j] =
            !(most[j] > LEAST) ? 0
            : !(most[j] < 1 / LEAST)
                ? NAN
                : ldexp((double)(int64_t)sum[j].high + ldexp((double)(int64_t)sum[j].low, -bits),
                        exponent[j] - bits);
    return 0;
}

static PetscErrorCode many(Vec x, PetscInt count, const Vec y[], PetscScalar *value)
{
    for (PetscInt from = 0; from < count; from += TOGETHER)
        PetscCall(multiply(x, PetscMin(TOGETHER, count - from), y + from, value + from));
    return 0;
}

static PetscErrorCode one(Vec x, Vec y, PetscScalar *value)
{
    return multiply(x, 1, &y, value);
}

/* x . y and y . y */
static PetscErrorCode two(Vec x, Vec y, PetscScalar *value, PetscScalar *square)
{
    PetscCall(multiply(x, 1, &y, value));
    return multiply(y, 1, &y, square);
}

static PetscErrorCode (*norm_of_petsc)(Vec, NormType, PetscReal *);

static PetscErrorCode norm(Vec x, NormType type, PetscReal *value)
{
    if (type != NORM_2 && type != NORM_FROBENIUS)
        return norm_of_petsc(x, type, value);
    PetscCall(multiply(x, 1, &x, value));
    *value = sqrt(*value);
    return 0;
}

void petsc_sums_exactly(Vec v)
{
    norm_of_petsc = v->ops->norm;
    v->ops->dot = v->ops->tdot = one;
    v->ops->mdot = v->ops->mtdot = many;
    v->ops->dotnorm2 = two;
    v->ops->norm = norm;
}
#else
typedef int petsc_sums_nothing; /* a file has something in it */
#endif
