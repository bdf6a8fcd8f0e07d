/* asked_oracle.h - the oracle that the command line asks for, with all that it says of it.
 * SPDX-License-Identifier: MIT */
#ifndef ASKED_ORACLE_H
#define ASKED_ORACLE_H

#include "options/options.h"
#include "radiosity.h"

/* This release of it, with the nodes that --replace names, the values of --params, and those of
 * --set, which win over them. Returns NULL after a message. */
RadOracle open_asked_oracle(const struct options *o, RadDevice device, enum RadRelease release);

#endif
