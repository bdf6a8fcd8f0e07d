/* explanation.h - a discussion, node by node, for people and for programs.
 * SPDX-License-Identifier: MIT */
#ifndef EXPLANATION_H
#define EXPLANATION_H

#include <jansson.h>
#include <stdio.h>
#include "radiosity.h"

/* Node i of it, counted from 0; the decision; all known terms; all nodes and the decision. */
void explanation_print_node(FILE *out, const struct RadExplanation *x, int i);
void explanation_print_decision(FILE *out, const struct RadExplanation *x);
void explanation_print_terms(FILE *out, const struct RadTerm *terms, int count);
void explanation_print(FILE *out, const struct RadExplanation *x);

/* NULL: out of memory. */
json_t *explanation_json(const struct RadExplanation *x);

#endif
