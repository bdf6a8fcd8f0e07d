/* graph_svg.h - a decision graph as a drawing, with what a solve has counted in it.
 * SPDX-License-Identifier: MIT */
#ifndef GRAPH_SVG_H
#define GRAPH_SVG_H

#include <jansson.h>
#include <stdio.h>

#include "radiosity.h"

/* Writes one <svg> element, without an XML head, so that a page may hold it. The oracle is of
 * RAD_RELEASE_DAG; `statistics`: what statistics_read returned for this oracle; NULL: none, all
 * nodes have one colour. Needs Graphviz's `dot`, which places things. The same input gives the
 * same bytes.
 *
 * A node is <g class="node CLASS" id="node-NAME" data-node="NAME">, CLASS one of question, term (a
 * question that may compute terms), command; with statistics also `heat0` to `heat6` (share of the
 * time) or `unused`. An arc is <g class="arc KIND" id="arc-NAME-ANSWER">, KIND precise,
 * approximate, other or command; a leaf <g class="leaf DECISION">; a branch <g class="branch"
 * id="branch-NAME">. Each has a <title>. Returns 0, or -1 after a message. */
int graph_svg_write(FILE *out, RadOracle oracle, const json_t *statistics);

#endif
