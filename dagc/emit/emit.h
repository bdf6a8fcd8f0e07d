/* emit.h - what the parts of the C emitter share.
 * SPDX-License-Identifier: MIT */
#ifndef EMIT_H
#define EMIT_H

#include "base/internal.h"

/* What a value of the type is in C. */
static inline const char *dag_c_type(const struct dag *dag, int type)
{
    return dag->types[type].base == BASE_INTEGER ? "int" : "double";
}

/* The functions that one graph can become; their decisions are the same. */
enum flavour {
    FLAVOUR_PLAIN,   /* NAME_refine */
    FLAVOUR_COUNTED, /* NAME_refine_counted: calls, time, answers (--instrument) */
    FLAVOUR_TRACED,  /* NAME_refine_traced: a callback per node (--trace) */
    FLAVOUR_FIRST    /* NAME_refine_first: the plain one, entered with nothing known (--copies) */
};

/* Beyond so many nodes tools are called, not inlined, and the graph becomes functions of so many
 * nodes each: compilers take time that grows faster than a function's size. */
enum { PART_NODES = 100 };

/* Parts of a C file (emit_c.c): the head, the tools that some graph reaches, the macro KNOWN if it
 * is used, and of one oracle all but its `struct oracle`. */
void dag_emit_banner(const struct dag *dag, struct text *out);
unsigned char *dag_emit_reached_tools(struct dag *dag); /* by tool */
void dag_emit_known_macro(struct dag *dag, struct text *out, const struct emit_options *options);
void dag_emit_oracle_h(const struct dag *dag, struct text *out, const struct oracle_graph *oracle,
                       const struct emit_options *options);
void dag_emit_oracle_c(struct dag *dag, struct text *out, const struct oracle_graph *oracle,
                       const struct emit_options *options);

/* One function (emit_flat.c). */
void dag_emit_flat(struct dag *dag, struct text *out, const struct oracle_graph *oracle,
                   enum flavour flavour, const struct emit_options *options);
/* Does the text use the macro KNOWN? */
int dag_emit_states_facts(struct dag *dag, const struct emit_options *options);
/* What functions of many parts call instead of the tools; nothing when no oracle is that large. */
void dag_emit_callers(struct dag *dag, struct text *out, const unsigned char *reached,
                      const struct emit_options *options);

/* Over a block of pairs, all that are at a node at once (emit_wave.c): the function's declaration;
 * what all oracles of the file call, headers included; the function itself. */
void dag_emit_wave_h(const struct dag *dag, struct text *out, const struct oracle_graph *oracle);
void dag_emit_wave_headers(struct dag *dag, struct text *out, const unsigned char *reached);
void dag_emit_wave_calls(struct dag *dag, struct text *out, const unsigned char *reached);
void dag_emit_wave(struct dag *dag, struct text *out, const struct oracle_graph *oracle,
                   const struct emit_options *options);

/* The declarations and tables that counted and traced functions need (emit_counters.c). */
void dag_emit_counters_h(const struct dag *dag, struct text *out, const struct oracle_graph *oracle,
                         const struct emit_options *options);
void dag_emit_counters_c(const struct dag *dag, struct text *out, const struct oracle_graph *oracle,
                         const struct emit_options *options);
/* The head of NAME_refine, NAME_refine_counted or NAME_refine_traced, up to its `)`; the catalog's
 * verb may be another than `refine`. */
void dag_emit_prototype(const struct dag *dag, struct text *out, const struct oracle_graph *oracle,
                        enum flavour flavour);

/* Where an argument is printed. */
struct place {
    const char *at;              /* the discussion's address */
    const char *told;            /* that of the one that is told which argument is no number */
    const struct shared *inside; /* the function for some uses of a graph; NULL: for the whole */
};

/* emit_expression.c: the constants that a node's arguments read or are, then each argument over
 * them, *value counting on from 0, or a shared one as its call gives it; and what the C file must
 * say of all this first. */
int dag_has_reads(const struct dag *dag, const struct node *node,
                  const struct place *place); /* there are such constants */
void dag_emit_reads(struct dag *dag, struct text *out, const struct node *node,
                    const struct place *place);
void dag_emit_expression(struct dag *dag, struct text *out, const struct node *node,
                         const struct argument *argument, const struct place *place, int *value);
void dag_emit_shared_argument(struct dag *dag, struct text *out, const struct argument *argument,
                              const char *at, int doubtful);
/* What the arguments of all reached nodes call, each 1 at its number. */
struct dag_reached {
    unsigned char *facts, *callbacks, *terms;
    int minimum, maximum, arithmetic; /* 1: there is some */
};
struct dag_reached dag_emit_reached(struct dag *dag);
/* May some argument of a reached node be no number? The discussion must be able to say so. */
int dag_emit_has_doubts(const struct dag *dag);
void dag_emit_externs(struct dag *dag, struct text *out); /* prototypes */
/* A C file that defines each of them by a variable `extern_NAME`. Returns how many. */
int dag_emit_extern_calls(struct dag *dag, struct text *out);
void dag_emit_accessors(struct dag *dag, struct text *out); /* headers of terms, small functions */
void dag_emit_fact(const struct dag *dag, struct text *out, int fact);
void dag_emit_fact_name(struct text *out, const struct fact *fact);
void dag_emit_fact_number(const struct dag *dag, struct text *out, int fact); /* FACT_NAME */

#endif
