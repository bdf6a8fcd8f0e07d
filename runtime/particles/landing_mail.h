/* landing_mail.h - what particles leave on faces of other ranks is told to the ranks that count
 * there.
 *
 * A particle goes through all faces, and lands on those of all ranks. Counts of all faces on every
 * rank, and their sums, would be more than what lands as soon as there are many faces. So what
 * lands on others' faces waits, a few batches of particles at a time, and then goes to the owners.
 *
 * Invariant: owners add integers, so the order of letters does not show.
 * SPDX-License-Identifier: MIT */
#ifndef LANDING_MAIL_H
#define LANDING_MAIL_H

#include <stdatomic.h>
#include "particles/particles.h"

/* Batches that a rank traces before it tells what has landed. */
enum { MAIL_BATCHES = 32 };

/* To the owner of a face: what has landed there. */
struct letter {
    uint32_t at; /* the leaf, as the owner has it; where leaves are not counted on, the face */
    uint16_t replicate, owner;
    uint32_t count[3]; /* by band: of a particle that is not split, at the most ONE_WHOLE */
};

/* Of one batch. */
struct mail {
    struct letter *letter;
    size_t count, capacity;
    int failed; /* out of memory: some are lost */
};

/* Count so much. A thread that counts alone need not lock what it counts on. */
static inline void tally_raise(const struct tally *tally, _Atomic int64_t *count, int64_t w)
{
    if (tally->alone)
        atomic_store_explicit(count, atomic_load_explicit(count, memory_order_relaxed) + w,
                              memory_order_relaxed);
    else
        atomic_fetch_add_explicit(count, w, memory_order_relaxed);
}

/* Count w on a face of this rank's, by its place, and on a leaf of it by its index here. */
static inline void tally_count(struct tally *tally, int replicate, size_t place, uint32_t leaf,
                               const int64_t w[3])
{
    const size_t at = (size_t)replicate * tally->held + place;
    for (uint32_t k = 0; k < tally->bands; k++) {
        tally_raise(tally, &tally->face[at * tally->bands + k], w[k]);
        if (tally->element)
            tally_raise(tally, &tally->element[(size_t)leaf * tally->bands + k], w[k]);
    }
}

/* Additions would wait for memory one after the other. The counts of three bands may lie in two
 * cache lines. To gcc 12 a call of what only prefetches does nothing, and is left out, unless it is
 * part of the caller from the start. */
static inline __attribute__((always_inline)) void tally_prefetch(const struct tally *tally,
                                                                 int replicate, size_t place,
                                                                 uint32_t leaf)
{
    const size_t at = ((size_t)replicate * tally->held + place) * tally->bands,
                 of_leaf = (size_t)leaf * tally->bands, last = tally->bands - 1;
    __builtin_prefetch((const void *)&tally->face[at], 1);
    __builtin_prefetch((const void *)&tally->face[at + last], 1);
    if (tally->element) {
        __builtin_prefetch((const void *)&tally->element[of_leaf], 1);
        __builtin_prefetch((const void *)&tally->element[of_leaf + last], 1);
    }
}

/* Write to the owner of the face; leaf: as the owner has it. */
void mail_landing(struct mail *mail, const struct tally *tally, int replicate, uint32_t face,
                  uint32_t leaf, const int64_t w[3]);

/* Send what has been written in so many batches, and count what comes. Returns 0, or -1 on all
 * ranks when any is out of memory: then the tally is of no use. */
int mail_send(struct mail *mail, int batches, struct tally *tally, struct ranks *ranks);

void mail_close(struct mail *mail, int batches);

#endif
