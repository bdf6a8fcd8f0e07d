/* free_space.h - where in a scene nothing can stand in the way: outside the box of what is no wall.
 * SPDX-License-Identifier: MIT */
#ifndef FREE_SPACE_H
#define FREE_SPACE_H

#include "hierarchy/hierarchy.h"

/* The box of all faces that may stop a segment between two surfaces, as far as Embree's rounding
 * and `off`, how far the segments' ends are off their surfaces (m), may reach. Empty, low above
 * high, in a convex scene. */
struct free_space {
    double low[3], high[3];
};

void free_space_find(struct free_space *space, const struct hierarchy *h, double flat, double off);

/* Can nothing stand in the way anywhere? */
static inline int free_space_is_all(const struct free_space *space)
{
    return space->low[0] > space->high[0];
}

/* Does the segment stay out of the box, for sure? */
static inline int free_space_passes(const struct free_space *space, const double from[3],
                                    const double to[3])
{
    double enter = 0, leave = 1;
    for (int k = 0; k < 3; k++) {
        double d = to[k] - from[k], low = space->low[k] - from[k], high = space->high[k] - from[k];
        if (d == 0 && (low > 0 || high < 0))
            return 1;
        if (d == 0)
            continue;
        double in = (d > 0 ? low : high) / d, out = (d > 0 ? high : low) / d;
        enter = in > enter ? in : enter;
        leave = out < leave ? out : leave;
    }
    return enter > leave;
}

#endif
