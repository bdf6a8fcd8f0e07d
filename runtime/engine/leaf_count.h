/* leaf_count.h - what a leaf receives by a tally, with counts on leaves or without.
 * SPDX-License-Identifier: MIT */
#ifndef LEAF_COUNT_H
#define LEAF_COUNT_H

#include "hierarchy/hierarchy.h"
#include "particles/particles.h"

/* W. Where nothing was counted on leaves, as by paths (path_tally.h), a leaf has that share of what
 * was counted on its face which it has of irradiance[element * bands + band] (W/m2). */
static inline double leaf_count(const struct tally *tally, const struct hierarchy *h,
                                const double *irradiance, uint32_t leaf, uint32_t band)
{
    if (tally->element)
        return tally_leaf(tally, leaf, band);
    const struct element *at = &h->elements[leaf];
    const uint32_t whole = h->face_element[at->face];
    const double all = irradiance[(size_t)whole * tally->bands + band];
    return tally_face_mean(tally, at->face, band) * (at->area / h->elements[whole].area)
           * (all > 0 ? irradiance[(size_t)leaf * tally->bands + band] / all : 1);
}

#endif
