/* order.h - questions that may be asked in either order: --profile.
 * SPDX-License-Identifier: MIT */
#ifndef ORDER_H
#define ORDER_H

#include "analyse/profile.h"

/* Makes of the profile's oracle a graph in which independent questions come the cheapest and most
 * decisive first, and puts it into the oracle's place; profile->before keeps the one that was
 * measured, profile->told says of each two questions what was proved and what was done. Decisions,
 * and terms that decisions keep, are the same: whoever calls has that proved once more, by
 * dag_diff_graphs. */
void dag_order_questions(struct dag *dag, struct profile *profile);

/* Puts back the graph that was measured; profile->told says why, and no more. */
void dag_keep_order(struct dag *dag, struct profile *profile, const char *why);

#endif
