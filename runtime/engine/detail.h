/* detail.h - leaves made finer where particles can tell how light is spread over them.
 * SPDX-License-Identifier: MIT */
#ifndef DETAIL_H
#define DETAIL_H

#include "engine/solve.h"

/* Split the leaves of a linear solution, until about so many particles land (of all that do,
 * `landings`) on each no more than MEND_DETAIL, or there are about MEND_LEAVES. What links say is
 * the same function as before, and no link is added. A solution of constants stays as it is.
 * Returns 0, or -1 when out of memory. */
int detail_leaves(struct solve *s, double landings);

/* Once the solution is mended: of the elements made since there were `first`, drop those whose
 * light is their parent's linear function, so that only such quarters stay as particles had
 * something to say of. Returns 0, or -1 when out of memory. */
int detail_merge(struct solve *s, uint32_t first);

/* Split them until none is larger than PLACE_SHARE of the scene's area; the same holds. */
int detail_places(struct solve *s);

/* Undo that: back to the first `count` elements. Returns 0, or -1 when out of memory. */
int detail_drop(struct solve *s, uint32_t count);

/* Room for the elements that others have made since there were `first`, and their light: what links
 * say is the same function as before. Returns 0, or -1 when out of memory. */
int detail_light(struct solve *s, uint32_t first);

#endif
