/* decisions.h - what decisions are called: as graphs write them.
 * SPDX-License-Identifier: MIT */
#ifndef DECISIONS_H
#define DECISIONS_H

#include "radiosity.h"

/* By enum decision; NULL behind the last. */
extern const char *const decision_names[DECISIONS + 1];

#endif
