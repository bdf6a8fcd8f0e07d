/* reflected_light.c - see reflected_light.h.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "engine/reflected_light.h"

double reflected_light(const struct problem *p, const struct tally *tally, double *variance)
{
    double power[REPLICATES];
    for (int r = 0; r < REPLICATES; r++) {
        power[r] = 0;
        for (uint32_t f = 0; f < tally->faces; f++)
            for (uint32_t k = 0; k < tally->bands && tally_holds(tally, f); k++)
                power[r] +=
                    p->reflectance[(size_t)f * tally->bands + k] * tally_face(tally, r, f, k);
    }
    if (tally->quarters)
        ranks_add(p->options.ranks, RANKS_PARTICLES, power, REPLICATES);
    const double mean = replicates_mean(power, variance);
    if (tally->faces > 0)
        *variance += tally_unseen(tally) * mean * mean / tally->faces;
    if (!(mean > 0) && !tally->by_paths && p->reflects)
        *variance = tally_power_of_one(tally) * tally_power_of_one(tally);
    return mean;
}

/* Of n particles none is reflected: a share of 3 / n may be, in 95 of 100 cases ("rule of three",
 * Hanley and Lippman-Hand 1983). Paths that found nothing tell nothing of it. What comes first to
 * faces of the reflectance rho they reflect again and again, rho / (1 - rho) of it at the most. */
double unseen_light(const struct problem *p, const struct tally *tally)
{
    double whitest = 0;
    for (uint32_t f = 0; f < tally->faces; f++)
        whitest = fmax(whitest, p->whitest[f]);
    if (!p->reflects)
        return 0;
    const int counted = !tally->by_paths && tally->particles > 0;
    const double comes = counted ? fmin(3 * tally_power_of_one(tally), tally->power) : tally->power;
    return comes * whitest / (1 - whitest);
}
