/* stability_known.c - see stability_known.h.
 * SPDX-License-Identifier: MIT */
#include "study/stability_known.h"

#include <math.h>

/* A rectangle with a corner above the point is odd in both sides, so corners add with their
 * signs. */
double known_point(double x0, double x1, double y0, double y1, double h)
{
    return closed_corner(x1, y1, h) - closed_corner(x0, y1, h) - closed_corner(x1, y0, h)
           + closed_corner(x0, y0, h);
}

double known_penumbra(const double source[4], double h, const double blocker[4], double z)
{
    double hidden[4], f = known_point(source[0], source[1], source[2], source[3], h);
    for (int k = 0; k < 4; k += 2) {
        hidden[k] = fmax(source[k], blocker[k] * h / z);
        hidden[k + 1] = fmin(source[k + 1], blocker[k + 1] * h / z);
        if (hidden[k] >= hidden[k + 1])
            return f;
    }
    return f - known_point(hidden[0], hidden[1], hidden[2], hidden[3], h);
}
