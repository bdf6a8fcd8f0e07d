/* body_feet.h - what convex solids stand on: of a body in the making, and of all of them.
 * SPDX-License-Identifier: MIT */
#ifndef BODY_FEET_H
#define BODY_FEET_H

#include "hierarchy/body_contacts.h"
#include "hierarchy/body_lids.h"
#include "hierarchy/body_lining.h"

/* Are all lids covered, but for what is narrower than faces may reach off their planes? */
int body_feet_shut(const struct shell *shell);

/* Add what the next body stands on, with its lids and with those faces of its own that are
 * marked as its. Returns 0, or -1 when out of memory. */
int body_feet_add(struct bodies *bodies, const struct shell *shell, struct body_lining *lining,
                  uint32_t body);

/* Once all are there: how much of each face is covered; the list is put in order. */
void body_feet_sum(struct bodies *bodies, const struct hierarchy *h);

/* Add those of faces of something solid, after that. Returns 0, or -1 when out of memory. */
int body_feet_contacts(struct bodies *bodies, const struct body_contact *list, size_t count);

#endif
