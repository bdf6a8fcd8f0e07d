/* enclosure.h - is the scene closed?
 * SPDX-License-Identifier: MIT */
#ifndef ENCLOSURE_H
#define ENCLOSURE_H

#include "engine/solve.h"

/* 1 when light that walks through the scene never leaves it nor meets the black back of a one-sided face, else 0; 0 without
 * light. Counts the steps in closed_rays. */
int enclosure_decide(struct solve *s);

#endif
