/* mended_reach.h - how far off a mended solution is, by the particles that mended it.
 * SPDX-License-Identifier: MIT */
#ifndef MENDED_REACH_H
#define MENDED_REACH_H

#include "engine/face_error.h"

struct solve;

struct mended_reach {
    /* L1 error of polygons, shares of the reflected light: what mending leaves by its own estimate,
     * and what is above the truth in 97 of 100 cases; 0: nothing is known */
    double left, l1;
    double light, variance; /* all reflected light (W) and the variance of that (W2) */
};

/* Before they mend, of what the links say. Returns 0, or -1 on all ranks when any is out of
 * memory. */
int mended_reach_find(const struct solve *s, const struct tally *tally, struct mended_reach *reach);

/* Narrow what other particles have measured of the mended solution: f->l1 and f->power. */
void mended_reach_narrow(const struct mended_reach *reach, struct face_error *f);

#endif
