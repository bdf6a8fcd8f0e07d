/* far_away.c - see far_away.h.
 * SPDX-License-Identifier: MIT */
#include "output/far_away.h"

#include <math.h>

static const double HALF_UNIT = 0x1p-25; /* of a float, as a share of the next power of two */
static const double BENT = 1e-6;

double far_away(const struct vertex_values *values, double middle[3])
{
    double extent = 0, most = 0;
    for (int k = 0; k < 3; k++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t i = 0; i < values->count; i++) {
            low = fmin(low, values->vertices[i].position[k]);
            high = fmax(high, values->vertices[i].position[k]);
        }
        extent = fmax(extent, high - low);
        most = fmax(most, fmax(-low, high));
        middle[k] = values->count ? low + (high - low) / 2 : 0;
    }
    int exponent;
    (void)frexp(most, &exponent);
    const double moved = ldexp(HALF_UNIT, exponent);
    if (moved > BENT * extent)
        return moved;
    middle[0] = middle[1] = middle[2] = 0;
    return 0;
}
