/* dense.h - the equation as a matrix over the leaves, solved by LU.
 * SPDX-License-Identifier: MIT */
#ifndef DENSE_H
#define DENSE_H

#include "engine/transport.h"

/* leaves: the most that a matrix is made for, 200 MB and 10^11 operations. Chosen */
enum { DENSE_LEAVES = 5000 };

/* The surfaces that are not divided. */
uint32_t dense_leaves(const struct hierarchy *h);

/* Are there more leaves than a matrix is made for? Then `cause` says so. */
int dense_too_many(uint32_t leaves, char *cause, size_t size);

/* Set x->value to the solution, of at most DENSE_LEAVES leaves. Its irradiance is left to the sweep
 * that follows. Returns 0, or -1 when out of memory. Loads LAPACK, which whoever asks for LU has
 * tried. */
int dense_solve(const struct light_operator *op, struct transport *x);

#endif
