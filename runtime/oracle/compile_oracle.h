/* compile_oracle.h - the flat release of a graph, or that in waves, made while the program
 * runs.
 * SPDX-License-Identifier: MIT */
#ifndef COMPILE_ORACLE_H
#define COMPILE_ORACLE_H

#include "oracle/oracles.h"
#include "util/messages.h"

/* Load `path` ("-": standard input) or, when `text` is not NULL, that text under the name `path`,
 * have the C compiler make machine code of it and look up the oracle called `name` (NULL: the only
 * one); `wave`: over blocks of pairs, too. Of `how`, the compiler, its folder and the replacements
 * matter. Returns NULL after a message. */
struct refiner *compile_oracle(const char *path, const char *text, const char *name, int wave,
                               const struct oracle_sources *how, struct messages *messages);

#endif
