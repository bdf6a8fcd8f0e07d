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
 * question that may compute terms), command; where it guards subdivision also `guards`, with
 * statistics also `heat0` to `heat6` (share of the time) or `unused`. A leaf is <g class="leaf
 * LINKS DECISION" id="leaf-NODE-DECISION">, LINKS one of links, subdivides, stops. An arc, which
 * stands for all answers of one kind to one place, is <g class="arc KIND" id="arc-NODE-ANSWER"
 * data-from="ID" data-to="ID">, KIND one of precise, approximate, other, command, with `dead`
 * where statistics know that it was never taken. A branch is <g class="branch" id="branch-NAME">.
 * Each has a <title>. Returns 0, or -1 after a message. */
int graph_svg_write(FILE *out, RadOracle oracle, const json_t *statistics);

#endif
