/* collocation.h - form factors of links from the receiver's centre.
 * SPDX-License-Identifier: MIT */
#ifndef COLLOCATION_H
#define COLLOCATION_H

#include "engine/operator.h"

/* Where the problem asks for collocation, set op->collocated, of the links as they are sorted.
 * Returns 0, or -1 when out of memory. */
int collocation_update(struct light_operator *op);

#endif
