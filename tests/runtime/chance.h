/* chance.h - numbers by chance, the same in every run.
 * SPDX-License-Identifier: MIT */
#ifndef CHANCE_H
#define CHANCE_H

#include "kernel/hash.h"

/* The next one, in [0, 1). */
static inline double chance(uint64_t *state)
{
    return hash_unit(++*state);
}

#endif
