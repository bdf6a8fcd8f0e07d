/* fold.h - rows over a scene and its copies, as rows over the scene: polygon i of the k-th copy is
 * number k * originals + i (scene/copies.h), and what is seen of it counts as seen of polygon i.
 * SPDX-License-Identifier: MIT */
#ifndef FOLD_H
#define FOLD_H

#include <stdint.h>

static inline void fold_row(double *row, uint32_t count, uint32_t originals)
{
    for (uint32_t from = originals; from < count; from += originals)
        for (uint32_t j = 0; j < originals; j++)
            row[j] += row[from + j];
}

#endif
