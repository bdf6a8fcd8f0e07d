/* mend_sums.h - of every element that is mended here: its light by links, and what particles
 * counted there.
 * SPDX-License-Identifier: MIT */
#ifndef MEND_SUMS_H
#define MEND_SUMS_H

#include <math.h>
#include "engine/mend_places.h"
#include "particles/particles.h"

/* From leaves up, or from faces, whose parts are then left alone. */
enum mend_depth { MEND_LEAVES, MEND_FACES };

struct mend_sums {
    const struct light_operator *op;
    const struct tally *tally;
    uint32_t bands;
    struct mend_places places;
    double *linked;    /* [place * bands + band]: power by links (W) */
    double *received;  /* the same, counted, mean of all replicates */
    double *replicate; /* [REPLICATES][places.built * bands]: by each (W) */
};

/* Light by links: of leaves, irradiance[element * bands + band] (W/m2). Returns 0, or -1 on all
 * ranks when any is out of memory; either way mend_sums_close. */
int mend_sums_open(struct mend_sums *m, const struct light_operator *op, const struct tally *tally,
                   enum mend_depth depth, const double *irradiance);
void mend_sums_close(struct mend_sums *m);

/* Where the values of an element are. */
static inline size_t mend_at(const struct mend_sums *m, uint32_t element, uint32_t band)
{
    return (size_t)mend_place(&m->places, element) * m->bands + band;
}

enum { MEND_CHILDREN = 255 }; /* that an element may have */

/* The share of its parent's light that each child of e has by links. */
void mend_shares(const struct mend_sums *m, uint32_t e, uint32_t band, double given[MEND_CHILDREN]);

/* s^2 of a child that has the share `given` of `whole`, of which `here` were counted there (W), if
 * chance alone spread particles (W2). */
static inline double mend_chance(const struct mend_sums *m, uint32_t band, double given,
                                 double here, double whole)
{
    return (1 - given) * (1 - given) * tally_chance(m->tally, here, band)
           + given * given * tally_chance(m->tally, fmax(whole - here, 0), band);
}

/* A class of elements: those that about as many particles met, by powers of 2. */
enum { MEND_CLASSES = 48 };
static inline int mend_class(const struct mend_sums *m, uint32_t e, uint32_t band)
{
    const double particles = m->received[mend_at(m, e, band)] / tally_power_of_one(m->tally);
    const int class = particles > 1 ? (int)log2(particles) : 0;
    return class < MEND_CLASSES ? class : MEND_CLASSES - 1;
}

/* Is what an element adds to its class this rank's to add? */
static inline int mend_is_noted(const struct mend_sums *m, uint32_t e)
{
    return !m->op->shares.common || shares_counts(&m->op->shares, e);
}

/* Sums of classes, of all ranks where each has elements of its own. */
static inline void mend_add_up(const struct mend_sums *m, void *sums, size_t values)
{
    if (m->op->shares.common)
        ranks_add(m->op->shares.ranks, RANKS_PARTICLES, sums, values);
}

#endif
