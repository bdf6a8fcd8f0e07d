/* bends.h - how far from linear over a receiver is what all its links bring it together.
 * SPDX-License-Identifier: MIT */
#ifndef BENDS_H
#define BENDS_H

#include "engine/oracle_inputs.h"

/* element.bend of every surface that has links, by B [element * bands + band]. Sets changed[e]
 * where it grew by more than its hysteresis and what iteration may have left. Returns 0, or -1 on
 * all ranks when any is out of memory. */
int bends_update(struct oracle_inputs *in, struct light_operator *op, const double *radiosity,
                 struct hierarchy *h);

#endif
