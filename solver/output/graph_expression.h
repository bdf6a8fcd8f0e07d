/* graph_expression.h - an argument's value as the graph's author would write it.
 * SPDX-License-Identifier: MIT */
#ifndef GRAPH_EXPRESSION_H
#define GRAPH_EXPRESSION_H

#include <jansson.h>
#include <stddef.h>

/* Of an expression as dagc/1 has it, into text[size]; what is too long is cut. */
void graph_expression_text(const json_t *expression, char *text, size_t size);

#endif
