/* oracles.h - find an oracle by name or file, in the release that is asked for.
 * SPDX-License-Identifier: MIT */
#ifndef ORACLES_H
#define ORACLES_H

#include "oracle/refiner.h"

#define DEFAULT_ORACLE "clusters"
#define DEFAULT_BY_HAND "bf_guarded" /* of `compare`: the one nearest to it that has a hand-written release */

enum release { RELEASE_FLAT, RELEASE_DAG, RELEASE_HAND, RELEASES };

extern const char *const release_names[RELEASES]; /* "flat", "dag", "hand" */

/* `oracle`: the name of a built-in oracle, or a .dag file. A file's flat release is compiled with the
 * system's `cc` and loaded. Returns NULL after a message on stderr. */
struct refiner *oracles_open(const char *oracle, enum release release);

/* The hand-written releases that there are: a table that ends with NULL and is borrowed. */
void oracles_register_hand(const struct oracle *const *table);

/* Is there a hand-written release of this oracle? */
int oracles_by_hand(const char *oracle);

/* Apply the count texts "NAME=VALUE" to a refiner. Returns 0, or -1 after a message. */
int oracles_set(struct refiner *refiner, char *const *settings, int count);

/* The built-in oracles and their parameters, for --help and `radiosity oracles`. */
void oracles_print(FILE *out);

#endif
