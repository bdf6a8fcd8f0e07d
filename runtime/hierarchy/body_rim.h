/* body_rim.h - does a face end something that goes on behind it, or is it a sheet's side?
 * SPDX-License-Identifier: MIT */
#ifndef BODY_RIM_H
#define BODY_RIM_H

#include "hierarchy/hierarchy.h"

/* Of a face and those that go on from it in its plane the rim is looked at: a side of a solid has
 * others across its edges that go back behind it; a sheet, drawn from both sides, has but its own
 * other side there, and a floor the walls that stand on it. What is known of faces that have been
 * asked for: */
struct body_rim {
    unsigned char *known; /* [built] */
    uint32_t *list;
    size_t room;
};

/* Does something go back behind a face along half of its rim, or is that not known? Returns 1 or 0,
 * or -1 when out of memory. */
int body_rim_goes_back(struct body_rim *rim, const struct hierarchy *h, uint32_t face);

/* Returns 0, or -1 when out of memory; close is fine then too. */
int body_rim_open(struct body_rim *rim, const struct hierarchy *h);
void body_rim_close(struct body_rim *rim);

#endif
