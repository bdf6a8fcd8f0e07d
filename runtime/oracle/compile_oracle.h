/* compile_oracle.h - the flat release of a graph, made while the program runs.
 * SPDX-License-Identifier: MIT */
#ifndef COMPILE_ORACLE_H
#define COMPILE_ORACLE_H

#include "oracle/refiner.h"
#include "util/messages.h"

/* Load `path` ("-": standard input) or, when `text` is not NULL, that text under the name `path`,
 * have the C compiler make machine code of it (NULL: cc, in /tmp) and look up the oracle called
 * `name` (NULL: the only one). Returns NULL after a message. */
struct refiner *compile_oracle(const char *path, const char *text, const char *name,
                               const char *compiler, const char *temporary,
                               struct messages *messages);

#endif
