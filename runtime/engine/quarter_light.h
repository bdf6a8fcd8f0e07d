/* quarter_light.h - the mended light at any point of the scene, where each of several ranks has the
 * quarters of its own faces alone (own_quarters.h): what is asked of others' quarters they have
 * told.
 * SPDX-License-Identifier: MIT */
#ifndef QUARTER_LIGHT_H
#define QUARTER_LIGHT_H

#include "engine/element_light.h"

/* Of an element here, all bands (W/m2). */
double mended_irradiance(const struct solve *solve, uint32_t element);

struct quarter_light {
    const struct solve *solve;
    struct element_light light; /* of elements here */
    size_t width;               /* numbers that are told of a quarter */
    double *told;               /* [all quarters, rank by rank][width]; NULL: all are here */
    size_t *first;              /* [ranks + 1]: where each rank's begin there */
};

/* At a point of a face: of the leaf there. */
struct leaf_light {
    double area, irradiance; /* m2; all bands (W/m2) */
    double radiosity[3];     /* at the point (W/m2) */
};

/* All ranks call it; told is what the mended solution is now. Nothing is where there are no such
 * quarters. Returns 0 or -1, alike; quarter_light_close is fine then too. */
int quarter_light_open(struct quarter_light *q, const struct solve *s);
void quarter_light_close(struct quarter_light *q);

struct leaf_light quarter_light_at(const struct quarter_light *q, uint32_t face,
                                   const double point[3]);

#endif
