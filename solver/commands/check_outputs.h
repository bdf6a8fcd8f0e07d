/* check_outputs.h - before the work: can everything that shall be written be written, and would
 * nothing be lost by it that is read, or written as well?
 * SPDX-License-Identifier: MIT */
#ifndef CHECK_OUTPUTS_H
#define CHECK_OUTPUTS_H

#include "options/options.h"

/* Leaves no trace. Returns 0, or the exit status after one line on stderr. */
int check_outputs(const struct options *options);

#endif
