/* operator.h - the linear operator K = rho F V that the links stand for: x = source + K x.
 *
 * Its parts: links between surfaces, separable links where a cluster is at one end, what is done
 * about row sums, and which share of each element a solid does not cover. Transport applies it,
 * row_sums.c sets the row scales.
 * SPDX-License-Identifier: MIT */
#ifndef OPERATOR_H
#define OPERATOR_H

#include "engine/problem.h"
#include "engine/refine.h"
#include "engine/separable_links.h"
#include "engine/shares.h"

struct linear_links;

struct light_operator {
    const struct problem *problem;
    const struct hierarchy *hierarchy;
    const struct refinement *refinement; /* its links, sorted by receiver */
    struct shares shares;                /* which faces sweeps go over here */
    /* [link]: by collocation, F from the receiver's centre (collocation.c); NULL: the links' own,
     * the mean over the receiver */
    float *collocated;
    struct separable_links separable;
    /* while a linear solution is made (linear_solution.h): rows are of its links; else NULL */
    struct linear_links *linear;
    double *uncovered; /* [element]: share of the area that no solid stands on */
    double *row_scale; /* [element]: of leaves only, the factor for what comes over its own links */
    /* [element]: of leaves only, the factor for what comes over those of the elements above it */
    double *row_above;
    double *row_share; /* [element]: of leaves only, per area (1/m2), its share of the power that
                          the cap takes from its face, or, under closure, of its face's irradiance
                          when it has no row of its own */
    double *row; /* [element]: of leaves only, the row once scaled, what it is shared included: the
                    irradiance per uncovered area that a radiosity of 1 everywhere makes */
};

enum { LINKS_WORTH_THREADS = 1 << 16 };

/* Threads that what goes over all links is worth. */
static inline int operator_threads(const struct light_operator *op)
{
    return op->refinement->link_count > LINKS_WORTH_THREADS ? op->problem->options.threads : 1;
}

/* F of link i, by the projection that is asked for. */
static inline double operator_factor(const struct light_operator *op, size_t i)
{
    return (double)(op->collocated ? op->collocated[i] : op->refinement->links[i].form_factor);
}

/* What link i brings of its emitter's radiosity to its receiver: F V. */
static inline double operator_weight(const struct light_operator *op, size_t i)
{
    return operator_factor(op, i) * (op->refinement->links[i].visibility * (1.0 / LINK_VISIBLE));
}

/* The weight of child j in the mean radiosity of e: its share of the uncovered area, or of all
 * where none is. */
static inline double operator_share(const struct light_operator *op, uint32_t j, uint32_t e)
{
    double part = op->hierarchy->elements[j].area / op->hierarchy->elements[e].area;
    return op->uncovered[e] > 0 ? part * op->uncovered[j] / op->uncovered[e] : part;
}

/* Irradiance of e, a mean over all of it, lies on what is bare: so many times as much is the mean
 * over j, which is below e. */
static inline double operator_bare(const struct light_operator *op, uint32_t j, uint32_t e)
{
    return op->uncovered[e] > 0 ? op->uncovered[j] / op->uncovered[e] : 1;
}

/* Is e a leaf of which any part is bare? Others have no light whose error could count. */
static inline int operator_counts(const struct light_operator *op, uint32_t e)
{
    const struct element *x = &op->hierarchy->elements[e];
    return x->vertices && !x->children && op->uncovered[e] > 0;
}

#endif
