/* reflected_light.h - what all faces reflect by a tally.
 * SPDX-License-Identifier: MIT */
#ifndef REFLECTED_LIGHT_H
#define REFLECTED_LIGHT_H

#include "engine/problem.h"
#include "particles/particles.h"

/* W, all bands, on all ranks; *variance: of that, by how replicates differ; where none of the
 * particles was reflected, though some may be, as if one more were. */
static inline double reflected_light(const struct problem *p, const struct tally *tally,
                                     double *variance)
{
    const double one = tally->by_paths || !tally->reach ? 0 : tally_power_of_one(tally);
    double power[REPLICATES], mean = 0, square = 0;
    for (int r = 0; r < REPLICATES; r++) {
        power[r] = 0;
        for (uint32_t f = 0; f < tally->faces; f++)
            for (uint32_t k = 0; k < tally->bands && tally_holds(tally, f); k++)
                power[r] +=
                    p->reflectance[(size_t)f * tally->bands + k] * tally_face(tally, r, f, k);
    }
    if (tally->quarters)
        ranks_add(p->options.ranks, RANKS_PARTICLES, power, REPLICATES);
    for (int r = 0; r < REPLICATES; r++)
        mean += power[r] / REPLICATES;
    for (int r = 0; r < REPLICATES; r++)
        square += (power[r] - mean) * (power[r] - mean);
    *variance = mean > 0 ? square / (REPLICATES * (REPLICATES - 1)) : one * one;
    return mean;
}

#endif
