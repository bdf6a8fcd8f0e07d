/* builtin.h - the oracles that the command carries: every file of examples/oracles, compiled while
 * building.
 * SPDX-License-Identifier: MIT */
#ifndef BUILTIN_H
#define BUILTIN_H

#include "oracle.h"

struct builtin {
    const char *name;
    const char *text;              /* the graph, for the DAG release */
    const struct oracle *compiled; /* the flat release, and that in waves */
};

extern const struct builtin builtins[];   /* ends with a NULL name */
extern const char *const builtin_names[]; /* the same names; ends with NULL */

#endif
