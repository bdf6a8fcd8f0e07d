/* emit.h - what the parts of the C emitter share.
 * SPDX-License-Identifier: MIT */
#ifndef EMIT_H
#define EMIT_H

#include "base/internal.h"

/* The three functions that one graph can become; their decisions are the same. */
enum flavour {
    FLAVOUR_PLAIN,   /* NAME_refine */
    FLAVOUR_COUNTED, /* NAME_refine_counted: calls, time, answers (--instrument) */
    FLAVOUR_TRACED   /* NAME_refine_traced: a callback per node (--trace) */
};

/* Beyond so many nodes tools are called, not inlined, and the graph becomes functions of so many
 * nodes each: compilers take time that grows faster than a function's size. */
enum { PART_NODES = 100 };

/* Parts of a C file (emit_c.c): the head, the tools that some graph reaches, the macro KNOWN if it
 * is used, and of one oracle all but its `struct oracle`. */
void dag_emit_banner(const struct dag *dag, struct text *out);
unsigned char *dag_emit_reached_tools(struct dag *dag); /* by tool */
void dag_emit_known_macro(struct dag *dag, struct text *out);
void dag_emit_oracle_h(const struct dag *dag, struct text *out, const struct oracle_graph *oracle,
                       const struct emit_options *options);
void dag_emit_oracle_c(struct dag *dag, struct text *out, const struct oracle_graph *oracle,
                       const struct emit_options *options);

/* One function (emit_flat.c). */
void dag_emit_flat(struct dag *dag, struct text *out, const struct oracle_graph *oracle,
                   enum flavour flavour, const struct emit_options *options);
int dag_emit_states_facts(struct dag *dag); /* does the text use the macro KNOWN? */
/* What functions of many parts call instead of the tools; nothing when no oracle is that large. */
void dag_emit_callers(const struct dag *dag, struct text *out, const unsigned char *reached);

/* The declarations and tables that counted and traced functions need (emit_counters.c). */
void dag_emit_counters_h(const struct dag *dag, struct text *out, const struct oracle_graph *oracle,
                         const struct emit_options *options);
void dag_emit_counters_c(const struct dag *dag, struct text *out, const struct oracle_graph *oracle,
                         const struct emit_options *options);
/* The head of NAME_refine, NAME_refine_counted or NAME_refine_traced, up to its `)`. */
void dag_emit_prototype(struct text *out, const struct oracle_graph *oracle, enum flavour flavour);

/* emit_expression.c: the constants that a node's arguments read (how many), then each argument
 * over them, *value counting on from 0; `at` is the discussion's address there; and what the C file
 * must say of all this first. */
int dag_has_reads(const struct dag *dag, const struct node *node); /* there are such constants */
int dag_emit_reads(const struct dag *dag, struct text *out, const struct node *node,
                   const char *at);
void dag_emit_expression(struct dag *dag, struct text *out, const struct node *node,
                         const struct argument *argument, const char *at, int *value);
/* May some argument of a reached node be no number? The discussion must be able to say so. */
int dag_emit_has_doubts(const struct dag *dag);
void dag_emit_externs(struct dag *dag, struct text *out);   /* prototypes */
void dag_emit_accessors(struct dag *dag, struct text *out); /* headers of terms, small functions */
void dag_emit_fact(const struct dag *dag, struct text *out, int fact);
void dag_emit_fact_name(struct text *out, const struct fact *fact);
void dag_emit_fact_number(const struct dag *dag, struct text *out, int fact); /* FACT_NAME */

#endif
