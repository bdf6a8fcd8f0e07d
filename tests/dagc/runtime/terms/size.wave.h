/* size.wave.h - a term of dagc's tests, over a block.
 * SPDX-License-Identifier: MIT */
#ifndef TERM_SIZE_WAVE_H
#define TERM_SIZE_WAVE_H

#include "terms/size.h"

static inline void wave_term_size(struct discussion *block, const uint16_t *at, int count,
                                  enum size_level level)
{
    for (int k = 0; k < count; k++)
        (void)term_size(&block[at[k]], level);
}

#endif
