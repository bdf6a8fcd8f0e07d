/* mend_places.h - of which elements a rank mends what they receive, and where it keeps what it
 * knows of them meanwhile.
 *
 * Where each rank has quarters of its own, it knows of what its own faces receive, and of clusters
 * of these; not of others'. Clusters of several ranks, up to the root, all ranks mend alike: of
 * these and of their children, a few hundred, all are told what each rank has.
 *
 * Invariant: who mends an element knows of all its children.
 * SPDX-License-Identifier: MIT */
#ifndef MEND_PLACES_H
#define MEND_PLACES_H

#include "engine/operator.h"
#include "hierarchy/levels.h"

#define MENDED_ELSEWHERE UINT32_MAX

struct mend_places {
    uint32_t *at;    /* [common]: the place of each element; NULL: all are here, at their index */
    uint32_t common; /* elements that all ranks have; those behind them are this rank's own */
    uint32_t held;   /* places of common ones */
    uint32_t told;   /* the first so many: clusters of several ranks, and children of such */
    uint32_t built;  /* the first so many: of clusters and faces */
    uint32_t count;  /* of all */
};

/* Of the operator's hierarchy as it is now. Returns 0, or -1 when out of memory; either way
 * mend_places_close. */
int mend_places_open(struct mend_places *p, const struct light_operator *op);
void mend_places_close(struct mend_places *p);

static inline uint32_t mend_place(const struct mend_places *p, uint32_t element)
{
    if (!p->at)
        return element;
    return element < p->common ? p->at[element] : p->held + (element - p->common);
}

/* Does this rank know of the element? */
static inline int mend_is_here(const struct mend_places *p, uint32_t element)
{
    return mend_place(p, element) != MENDED_ELSEWHERE;
}

/* Does this rank mend what is below the element? */
static inline int mend_is_added(const struct light_operator *op, uint32_t element)
{
    return !op->shares.common || shares_keeps(&op->shares, element);
}

/* Is it a cluster of several ranks, which all mend? */
static inline int mend_is_shared(const struct light_operator *op, uint32_t element)
{
    return op->shares.common && shares_owner(&op->shares, element) == SHARED;
}

/* Leave out of the levels what others mend. */
void mend_places_levels(const struct light_operator *op, struct levels *levels);

#endif
