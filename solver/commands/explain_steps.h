/* explain_steps.h - a discussion gone through by hand: ask node by node, change a parameter or a
 * tool, ask again. [Turbet & Sillion, section 4.3]
 * SPDX-License-Identifier: MIT */
#ifndef EXPLAIN_STEPS_H
#define EXPLAIN_STEPS_H

#include "commands/watch_pair.h"
#include "options/options.h"

/* Obey commands from standard input, one a line, until it ends or says quit. Begins with `first`.
 * Returns the exit status: 1 where a command could not be obeyed. */
int explain_steps(const struct options *o, RadDevice device, RadSolution solution, RadOracle oracle,
                  const struct occasion *first);

#endif
