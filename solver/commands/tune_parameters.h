/* tune_parameters.h - which parameters of an oracle are fitted, and between which ends.
 * SPDX-License-Identifier: MIT */
#ifndef TUNE_PARAMETERS_H
#define TUNE_PARAMETERS_H

#include "commands/tune_fit.h"

/* Those that `wanted` names: [count] texts "NAME" or "NAME=LOW:HIGH"; count 0: all of the role
 * link_threshold. `name` is the oracle, for messages. Returns 0, or -1 after a message. */
int tune_parameters(struct tuner *t, const char *name, char *const *wanted, int count);

#endif
