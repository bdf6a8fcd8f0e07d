/* emit.h - what the parts of the C emitter share.
 * SPDX-License-Identifier: MIT */
#ifndef EMIT_H
#define EMIT_H

#include "internal.h"

/* The function NAME_refine (emit_flat.c). */
void dag_emit_flat(struct dag *dag, struct text *out, const struct oracle_graph *oracle);

/* emit_expression.c: the constants that a node's arguments read (how many), then each argument
 * over them, *value counting on from 0; and what the C file must say of all this first. */
int dag_has_reads(const struct dag *dag, const struct node *node); /* there are such constants */
int dag_emit_reads(const struct dag *dag, struct text *out, const struct node *node);
void dag_emit_expression(const struct dag *dag, struct text *out, const struct argument *argument,
                         int *value);
void dag_emit_externs(struct dag *dag, struct text *out);   /* prototypes */
void dag_emit_accessors(struct dag *dag, struct text *out); /* headers of terms, small functions */
void dag_emit_fact(const struct dag *dag, struct text *out, int fact);
void dag_emit_fact_name(struct text *out, const struct fact *fact);

#endif
