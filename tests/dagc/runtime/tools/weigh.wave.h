/* weigh.wave.h - a tool of dagc's tests, over a block.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_WEIGH_WAVE_H
#define TOOL_WEIGH_WAVE_H

#include "tools/weigh.h"

static inline void wave_weigh(struct discussion *block, const uint16_t *at, int count,
                              const double *most, const double *share, unsigned char *answers)
{
    for (int k = 0; k < count; k++)
        answers[k] = (unsigned char)tool_weigh(&block[at[k]], most[k], share[k]);
}

#endif
