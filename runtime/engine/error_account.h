/* error_account.h - how wrong a solution may be, and why.
 * SPDX-License-Identifier: MIT */
#ifndef ERROR_ACCOUNT_H
#define ERROR_ACCOUNT_H

#include "engine/light_ranges.h"
#include "engine/solve.h"

/* Norms in the making: integrals of the modulus and of the square, largest modulus. */
struct norm_sums {
    double first, second, most;
};

/* One solution's account. */
struct error_account {
    struct solve *solve; /* borrowed; what its operator has sent last is written anew */
    const struct RadAccountOptions *options;
    struct RadAccountReport *report; /* the result */
    ranges_watch *watch;             /* NULL: none */
    void *context;

    /* [element * bands + band], of leaves: what the cap and the solver left there, signed, and
     * what form factors may have, at the most (W/m2) */
    double *cap, *left, *factor;
    /* [element]: the largest B below it, and the largest difference of two, in whatever band */
    double *most, *spread;
};

/* Fill a->report. Returns 0; -1 when out of memory or stopped by the watch. */
int error_account_make(struct error_account *a);

/* Set cap and left. */
void error_local_signed(const struct error_account *a);
/* Set factor, and the estimates of discretization, form factors and visibility, and of what is left
 * together with cap and left. Returns 0, or -1 when out of memory. */
int error_local_make(const struct error_account *a);

/* The bounds alone; the arrays and the report's estimates are there. Returns 0 or -1. */
int error_bounds_make(struct error_account *a);

/* Is it a leaf that light can reach? */
static inline int account_counts(const struct error_account *a, uint32_t e)
{
    return operator_counts(&a->solve->operator, e);
}

static inline void norm_add(struct norm_sums *n, double area, double error)
{
    n->first += area * fabs(error);
    n->second += area * error * error;
    n->most = fmax(n->most, fabs(error));
}

static inline struct RadErrorNorms norms_of(const struct norm_sums *n)
{
    return (struct RadErrorNorms){n->first, sqrt(n->second), n->most};
}

/* Norms of the function that is x[leaf * bands + band] on each leaf; `whole`: over whole leaves,
 * else over what no solid covers. */
struct RadErrorNorms account_norms(const struct error_account *a, const double *x, int whole);

/* The error of E and of rho at face i in a band, as the options say. */
static inline double account_exitance_error(const struct error_account *a, uint32_t i, uint32_t k)
{
    const struct problem *p = &a->solve->problem;
    return a->options->exitance_error * p->exitance[(size_t)i * p->bands + k];
}

#endif
