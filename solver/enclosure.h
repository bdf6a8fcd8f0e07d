/* enclosure.h - is the scene closed?
 * SPDX-License-Identifier: MIT */
#ifndef ENCLOSURE_H
#define ENCLOSURE_H

#include "solve.h"

/* Where 1,024 rays from one face went. Those from points inside a solid count as buried, whatever they met. */
struct fates {
    int fronts, leaves, backs, buried;
};
struct fates enclosure_look(const struct rays *rays, const struct element *e);

/* 1 when no ray from any face's front leaves the scene or meets the black back of a one-sided face, else 0. Counts the
 * rays in closed_rays. */
int enclosure_decide(struct solve *s);

#endif
