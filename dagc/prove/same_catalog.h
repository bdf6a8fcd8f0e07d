/* same_catalog.h - do two files know the same tools, terms and decisions?
 * SPDX-License-Identifier: MIT */
#ifndef SAME_CATALOG_H
#define SAME_CATALOG_H

#include "dag.h"

/* 0, and it is said on standard error: they know others, or what both call by one name is not the
 * same. Files may declare some themselves. */
int dag_same_catalog(const struct dag *a, const struct dag *b);

#endif
