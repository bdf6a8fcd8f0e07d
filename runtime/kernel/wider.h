/* wider.h - which of two elements has the larger bounding sphere? A tie is broken by identity, so
 * that a pair opens the same element both ways round.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_WIDER_H
#define KERNEL_WIDER_H

#include "discussion.h"

static inline int wider(const struct element *a, const struct element *b)
{
    return a->radius > b->radius || (a->radius == b->radius && a->id <= b->id);
}

#endif
