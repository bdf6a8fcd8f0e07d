/* parameter_file.h - values of an oracle's parameters in a text file: what a panel gives back.
 *
 *     oracle power            # the first line names the oracle
 *     noise = 2e-5            # then one NAME = VALUE per line
 *
 * Blank lines and what follows a # do not count. What is not named keeps its value.
 * SPDX-License-Identifier: MIT */
#ifndef PARAMETER_FILE_H
#define PARAMETER_FILE_H

#include "radiosity.h"

/* Set what `path` says; `named`: the oracle as the command line names it, for messages. Returns 0,
 * or -1 after a message with file, line and cause. */
int parameter_file_apply(const char *path, RadDevice device, RadOracle oracle, const char *named);

#endif
