/* enclosure.h - is the scene closed?
 * SPDX-License-Identifier: MIT */
#ifndef ENCLOSURE_H
#define ENCLOSURE_H

#include "engine/problem.h"

/* 1 when light that walks through the scene never leaves it nor meets the black back of a one-sided face, else 0; 0 without
 * light. *rays: the steps that say so. */
int enclosure_decide(const struct problem *p, const struct hierarchy *h, uint64_t *rays);

#endif
