/* body_lining.h - which faces line a hollow solid.
 * SPDX-License-Identifier: MIT */
#ifndef BODY_LINING_H
#define BODY_LINING_H

#include "hierarchy/body_lids.h"

/* Is the solid hollow there, as a house of outer and inner walls in the same planes? Then those
 * that the face goes on to across edges, from one to the next, are all in the solid, or on its
 * sides, and not on one alone. Walls of a room in whose corner it stands go on outside of it. Edges
 * need not be equal (across.h). What is known of faces that have been asked for: */
struct body_lining {
    uint32_t *known; /* [built]: of faces, by the number of the body */
    uint32_t *list;
    size_t room;
};

/* Returns 1 or 0, or -1 when out of memory. The faces of the body, with that number, are marked in
 * whose, as struct bodies has it. */
int body_lining_is(struct body_lining *lining, const struct shell *s, const uint32_t *whose,
                   uint32_t body, uint32_t face);

/* Returns 0, or -1 when out of memory; close is fine then too. */
int body_lining_open(struct body_lining *lining, const struct hierarchy *h);
void body_lining_close(struct body_lining *lining);

#endif
