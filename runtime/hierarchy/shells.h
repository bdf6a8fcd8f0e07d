/* shells.h - polygons that look turned: their front is on the other side than that of the polygons
 * which they share edges with.
 * SPDX-License-Identifier: MIT */
#ifndef SHELLS_H
#define SHELLS_H

#include <stdint.h>
#include "radiosity.h"

/* Polygons, by place in the input: */
enum turned { TURNED_NOT, TURNED_CLOSED /* of a closed shell */, TURNED_OPEN };

/* Say of each polygon whether it looks turned: turned[polygons->count], enum turned. The indices
 * are those of positions. Returns 0, or -1 when out of memory. */
int shells_find(const struct RadPolygons *polygons, const struct RadMaterial *materials,
                uint8_t *turned);

#endif
