/* load_graph.h - a graph and one of its oracles, with dagc's messages where the engine keeps its
 * own.
 * SPDX-License-Identifier: MIT */
#ifndef LOAD_GRAPH_H
#define LOAD_GRAPH_H

#include "dag.h"
#include "util/messages.h"

/* As dag_load_with; *index gets the oracle called `name` (NULL: the only one). Returns NULL
 * after a message. */
struct dag *load_graph(const char *path, const struct dag_options *options, const char *name,
                       int *index, struct messages *messages);

/* The message to an extern that nobody defines: where it is declared, what it should be, and who
 * may give it. Returns -1. */
int graph_lacks_extern(const struct dag *dag, int callback, struct messages *messages);

#endif
