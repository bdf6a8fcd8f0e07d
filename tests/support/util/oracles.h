/* oracles.h - oracles as the command is asked for them: messages go to stderr, the compiler is the
 * environment's.
 * SPDX-License-Identifier: MIT */
#ifndef SOLVER_ORACLES_H
#define SOLVER_ORACLES_H

#include "oracle/oracles.h"

/* As oracle_open, with the hand-written releases. Returns NULL after a message on stderr. */
struct refiner *oracles_open(const char *oracle, enum release release);

/* Is there a hand-written release of this oracle? */
int oracles_by_hand(const char *oracle);

/* Apply the count texts "NAME=VALUE" to a refiner. Returns 0, or -1 after a message. */
int oracles_set(struct refiner *refiner, char *const *settings, int count);

#endif
