/* prove.h - do the releases of an oracle make the same calls and decisions as the graph?
 * SPDX-License-Identifier: MIT */
#ifndef PROVE_H
#define PROVE_H

#include "base/internal.h"

/* Compiles the dag's oracles and the runtime's interpreter over scripted tools and follows their
 * paths; what it did goes to `report`, one line per oracle, and the first difference of each. Also
 * proves the counted and traced functions that the options ask for. 0: no difference; 1: a
 * difference; -1: it could not be done, and standard error says why. Changes the headers named in
 * the dag. */
int dag_prove(struct dag *dag, const struct emit_options *options,
              const struct dag_compiler *compiler, FILE *report);

#endif
