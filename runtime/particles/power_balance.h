/* power_balance.h - what is emitted is absorbed or lost: counts that know it.
 * SPDX-License-Identifier: MIT */
#ifndef POWER_BALANCE_H
#define POWER_BALANCE_H

#include "particles/particles.h"

/* Set tally->correction by all that has been counted so far: tally_face and tally_leaf tell of it
 * from here on, until more is traced. Without emitters nothing is done. */
void power_balance(struct tally *tally, const struct tracer *t);

#endif
