/* reflected_light.h - what all faces reflect by a tally, and what may be where none was seen.
 * SPDX-License-Identifier: MIT */
#ifndef REFLECTED_LIGHT_H
#define REFLECTED_LIGHT_H

#include "engine/problem.h"
#include "particles/particles.h"

/* W, all bands, on all ranks; *variance: of that, by how replicates differ, and of paths by what
 * none may have found (tally_unseen); where none of the particles was reflected, though some may
 * be, as if one more were. */
double reflected_light(const struct problem *p, const struct tally *tally, double *variance);

/* Where the tally has seen nothing reflected: no more than that is (W, all bands; by particles in
 * 95 of 100 cases), 0: nothing is, that is sure. */
double unseen_light(const struct problem *p, const struct tally *tally);

#endif
