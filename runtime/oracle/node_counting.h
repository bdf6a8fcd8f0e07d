/* node_counting.h - an interpreted graph asked so that calls, time and answers of each node are
 * counted. Of no domain: terms and rays are counting.h's, radiosity's own.
 * SPDX-License-Identifier: MIT */
#ifndef NODE_COUNTING_H
#define NODE_COUNTING_H

#include "oracle/node_counts.h"
#include "oracle/refiner.h"

/* One for each thread: nothing is locked. */
struct node_counting;

/* Of an interpreted refiner, which must outlive it. `clock` may be NULL: no time is taken. NULL
 * after a message: out of memory, or the refiner is a compiled one. */
struct node_counting *node_counting_open(const struct refiner *refiner,
                                         double (*clock)(void *context), void *context,
                                         struct messages *messages);

/* Decides as the refiner does, and counts. */
enum decision node_counting_ask(struct node_counting *counting, struct discussion *d);

/* Good until the next call; the arrays are the counting's. */
struct node_counts node_counting_counts(const struct node_counting *counting);

void node_counting_close(struct node_counting *counting); /* NULL is fine */

#endif
