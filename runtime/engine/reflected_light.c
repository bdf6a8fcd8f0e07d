/* reflected_light.c - see reflected_light.h.
 *
 * Where no particle was reflected, that is chance or it is so: a lamp may shine through a pinhole,
 * and a hot body alone in space shines on nothing. Planes tell the second: light goes from a face
 * to another only if each has a corner in front of the other's plane. Where much faces each other
 * the first pairs say so; of others no more than PAIRS are looked at.
 * SPDX-License-Identifier: MIT */
#include "engine/reflected_light.h"
#include "kernel/plane_side.h"

enum { PAIRS = 10000000 }; /* chosen, a tenth of a second */

/* of the radii: less is rounding, as where faces adjoin */
static const double ROUNDING = 1e-9;

static int is_in_front(const struct element *e, const struct element *plane)
{
    double low, high;
    plane_side_heights(e, plane, &low, &high);
    return high > ROUNDING * (e->radius + plane->radius);
}

static double all_bands(const struct problem *p, const double *of_faces, uint32_t face)
{
    double sum = 0;
    for (uint32_t k = 0; k < p->bands; k++)
        sum += of_faces[(size_t)face * p->bands + k];
    return sum;
}

static const struct element *surface(const struct hierarchy *h, uint32_t face)
{
    return &h->elements[h->face_element[face]];
}

/* 0: no face that reflects is in front of one that emits, and that one in front of it; so nothing
 * is reflected once, nor ever. 1: it may be. */
static int lights_reach(const struct problem *p, const struct hierarchy *h)
{
    uint32_t pairs = 0;
    for (uint32_t s = 0; s < h->face_count; s++) {
        if (!(all_bands(p, p->exitance, s) > 0))
            continue;
        for (uint32_t r = 0; r < h->face_count; r++) {
            if (h->faces[r].light == FACE_DARK || !(all_bands(p, p->reflectance, r) > 0))
                continue;
            if (++pairs > PAIRS
                || (is_in_front(surface(h, r), surface(h, s))
                    && is_in_front(surface(h, s), surface(h, r))))
                return 1;
        }
    }
    return 0;
}

double reflected_light(const struct problem *p, const struct hierarchy *h,
                       const struct tally *tally, double *variance)
{
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
    *variance = square / (REPLICATES * (REPLICATES - 1));
    if (!(mean > 0) && !tally->by_paths && lights_reach(p, h))
        *variance = tally_power_of_one(tally) * tally_power_of_one(tally);
    return mean;
}

/* Of n particles none is reflected: a share of 3 / n may be, in 95 of 100 cases ("rule of three",
 * Hanley and Lippman-Hand 1983). Paths that found nothing tell nothing of it. What comes first to
 * faces of the reflectance rho they reflect again and again, rho / (1 - rho) of it at the most. */
double unseen_light(const struct problem *p, const struct hierarchy *h, const struct tally *tally)
{
    double whitest = 0;
    for (uint32_t f = 0; f < h->face_count; f++)
        whitest = fmax(whitest, p->whitest[f]);
    if (!(tally->power > 0) || !lights_reach(p, h))
        return 0;
    const int counted = !tally->by_paths && tally->particles > 0;
    const double comes = counted ? fmin(3 * tally_power_of_one(tally), tally->power) : tally->power;
    return comes * whitest / (1 - whitest);
}
