/* exchange_contacts.h - where faces of solids that are not convex lie on others.
 * SPDX-License-Identifier: MIT */
#ifndef EXCHANGE_CONTACTS_H
#define EXCHANGE_CONTACTS_H

#include "engine/exchange_tree.h"

/* Tell the tree's bodies, once its rays are built. Returns 0, or -1 when out of memory. */
int exchange_contacts_find(struct exchange_tree *tree);

#endif
