/* own_quarters.h - a solve whose quarters each of several ranks has of its own faces alone
 * (hierarchy/quarters.h), while particles mend it and as long as nobody asks for more.
 *
 * Invariant: of the elements that all have, `solve.quarters.common` of them, all ranks have the
 * same values; behind them each has its own, in the order that one process would have them in.
 * SPDX-License-Identifier: MIT */
#ifndef OWN_QUARTERS_H
#define OWN_QUARTERS_H

#include "engine/solve.h"

/* From here on each rank makes quarters of its own faces alone: by quarters_split, which all call
 * for all leaves. Faces are dealt out anew, into stretches of about the same work[face]; links stay
 * where they are, and those of groups are put away. Where there is one rank nothing changes.
 * Returns 0, or -1 on all ranks when any is out of memory. */
int own_quarters_begin(struct solve *s, const double *work);

/* Are there such? */
static inline int own_quarters(const struct solve *s)
{
    return s->quarters.common > 0;
}

/* Is the element here this rank's to work on? */
static inline int own_quarters_mine(const struct solve *s, uint32_t element)
{
    return shares_looks_at(&s->operator.shares, element);
}

/* Of values[element * width], which owners have set: then all have those of the common surfaces.
 * Where there are no such quarters all have them already. Returns 0 or -1, alike. */
int own_quarters_tell(struct solve *s, double *values, size_t width);

/* No more will be made, and some have gone: numbers are forgotten, all count what is left. */
void own_quarters_settle(struct solve *s);

/* All ranks get the quarters of all, with the places and values that one process has, and faces are
 * dealt out by links again. Nothing to do where there are none. Returns 0 or -1, alike. */
int own_quarters_share(struct solve *s);

#endif
