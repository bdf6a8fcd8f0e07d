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

struct program;

/* Number the ways, in program.ways, unless that is done. Returns 0; 1: there are 2^64 or more; -1:
 * out of memory. */
int follow_number(struct program *p);

/* The answer that the way, of which *way is left, takes at the step; *way becomes what is left
 * behind it. After follow_number. */
int follow_step(const struct program *p, int step, uint64_t *way);

/* Answer `answer` of step `step`, which there are. */
struct RadAnswer follow_said(const struct program *p, int step, int answer);

/* Number a refiner's ways. Returns 0, or -1 after a message: it is no interpreted graph, it has
 * more ways than a number tells, or memory is out. */
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
