/* follow.h - which way a discussion took through an interpreted graph.
 *
 * All ways from the start to a decision are numbered, so that a discussion's is one number: each
 * arc is worth the number of ways that the answers before it have, and the way is the sum
 * [Ball and Larus 1996, "Efficient path profiling"]. The walk adds once per node and stores
 * nothing.
 * SPDX-License-Identifier: MIT */
#ifndef FOLLOW_H
#define FOLLOW_H

#include "oracle/refiner.h"
#include "radiosity.h"

/* Number the ways. Returns 0, or -1 after a message: it is no interpreted graph, it has more ways
 * than a number tells, or memory is out. */
int follow_open(struct refiner *refiner, struct messages *messages);

/* Ask it, as refiner->refine does; *way gets the number. After follow_open; safe from many threads.
 */
enum decision follow_ask(const struct refiner *refiner, struct discussion *d, uint64_t *way);

/* Answer `answer` of node `node`, in topological order, both from 0. Returns 0; -1: there is none.
 */
int follow_answer(struct RadAnswer *out, const struct refiner *refiner, int node, int answer);

/* The answers on a way, `most` at the most. Returns how many there are; -1: there is no such way.
 */
int follow_way(struct RadAnswer *out, int most, const struct refiner *refiner, uint64_t way);

#endif
