/* state_identity.h - what a state is of, as numbers: equal where scene and oracle are equal.
 * SPDX-License-Identifier: MIT */
#ifndef STATE_IDENTITY_H
#define STATE_IDENTITY_H

#include "engine/problem.h"
#include "hierarchy/hierarchy.h"
#include "oracle/refiner.h"

/* Of faces, and of how many elements group them. */
uint64_t state_identity_faces(const struct hierarchy *h);
/* Faces with what they emit and reflect. */
uint64_t state_identity_scene(const struct problem *p, const struct hierarchy *h);
/* This library's, which states of others are not for. */
uint64_t state_identity_version(void);

/* Of an oracle and the values of its parameters. */
uint64_t state_identity_oracle(const struct refiner *refiner);

#endif
