/* open_oracle.h - oracles as the command line names them.
 * SPDX-License-Identifier: MIT */
#ifndef OPEN_ORACLE_H
#define OPEN_ORACLE_H

#include "radiosity.h"

/* `oracle`: the name of a built-in oracle, or a .dag file; settings: [count] texts "NAME=VALUE" for
 * its parameters. Returns NULL after a message. */
RadOracle open_oracle(RadDevice device, const char *oracle, enum RadRelease release,
                      char *const *settings, int count);

/* The same at its defaults, with nodes that are otherwise than written: [count] replacements, as
 * radLoadOracleReplaced takes them. */
RadOracle open_oracle_replaced(RadDevice device, const char *oracle, enum RadRelease release,
                               char *const *replacements, int count);

/* Set a parameter to the number that a text says. `where`, `line`: what says so, for messages; line
 * 0: an option. Returns 0, or -1 after a message. */
int set_oracle_parameter(RadDevice device, RadOracle oracle, const char *name, const char *text,
                         const char *where, uint32_t line);

/* Apply texts "NAME=VALUE" to an oracle. Returns 0, or -1 after a message. */
int set_oracle(RadDevice device, RadOracle oracle, char *const *settings, int count);

#endif
