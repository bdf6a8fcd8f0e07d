/* releases.c - the hand-written releases, for whoever wants to compare them.
 * SPDX-License-Identifier: MIT */
#include "hand.h"

const struct oracle *const hand_releases[] = {&hand_bf, &hand_bf_guarded, &hand_power, 0};
