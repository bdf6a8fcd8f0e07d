/* defect.h - how far the radiosity of a leaf is from what its links would give at single points of it.
 * SPDX-License-Identifier: MIT */
#ifndef DEFECT_H
#define DEFECT_H

#include "engine/solve.h"

/* The discretization defect of a leaf (W/m2), the band where it is largest. */
struct defect {
    double all;     /* of all its links, its ancestors' among them */
    double guarded; /* of those alone that a guard kept from being split (LINK_GUARDED) */
    uint32_t links; /* how many it has */
};

/* Thread-safe. */
struct defect defect_leaf(const struct solve *s, uint32_t leaf);

#endif
