/* compile_oracle.h - the flat release of a user's .dag file, made while the program runs.
 * SPDX-License-Identifier: MIT */
#ifndef COMPILE_ORACLE_H
#define COMPILE_ORACLE_H

#include "oracle/refiner.h"

/* Compile with dagc and the system's `cc` (or $CC), load, and look up the only oracle of the file.
 * Returns NULL after a message on stderr. */
struct refiner *compile_oracle(const char *path);

#endif
