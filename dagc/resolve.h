/* resolve.h - what the two resolvers share.
 * SPDX-License-Identifier: MIT */
#ifndef RESOLVE_H
#define RESOLVE_H

#include "internal.h"

void dag_resolve_twice(struct dag *dag, const char *what, const char *name, struct where where,
                       struct where first);
int dag_resolve_type(struct dag *dag, const char *name, struct where where);
void dag_resolve_parameters(struct dag *dag, struct span span);

#endif
