/* exchange_again.h - entries of rows that do not add up, looked at again.
 * SPDX-License-Identifier: MIT */
#ifndef EXCHANGE_AGAIN_H
#define EXCHANGE_AGAIN_H

#include "engine/exchange_areas.h"

/* Of polygons whose row is off, off[inputs], all entries that are not proved to be clear are
 * computed anew, as those of scenes of few polygons are: rules of points that tell enough are not
 * believed. `refinement`: what the areas were made of; no stream. States that are asked for
 * meanwhile hold what was there before. Returns 0, or -1 on all ranks when out of memory, or not
 * wanted any more. */
int exchange_again(struct exchange_areas *m, const struct refinement *refinement,
                   const unsigned char *off, const struct exchange_aim *how);

#endif
