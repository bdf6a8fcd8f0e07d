/* exchange_halves.h - the exchange areas of a block of pairs past many faces.
 * SPDX-License-Identifier: MIT */
#ifndef EXCHANGE_HALVES_H
#define EXCHANGE_HALVES_H

#include "engine/exchange_clear.h"
#include "engine/exchange_horizon.h"
#include "engine/exchange_sight.h"

/* out[rows][columns] (m2). Returns the largest error estimated of any, as a share of
 * the smaller area. */
double halves_block(const struct exchange_faces *faces, const struct exchange_pair *pair,
                    struct horizon *horizon, struct sight_scratch *scratch, double *out);

#endif
