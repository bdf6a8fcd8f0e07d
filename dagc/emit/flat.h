/* flat.h - what the files that print a graph's function share (emit_flat.c, flat_node.c,
 * emit_outline.c).
 * SPDX-License-Identifier: MIT */
#ifndef FLAT_H
#define FLAT_H

#include "analyse/analyse.h"
#include "analyse/copies.h"
#include "analyse/shared.h"
#include "emit/emit.h"

struct flat {
    struct dag *dag;
    struct text *out;
    const struct oracle_graph *oracle;
    enum flavour flavour;
    const unsigned char *terms; /* see emit_options; NULL: all */
    int lines, directives;      /* likewise */
    int watched;                /* calls of outlined functions are marked, for --prove */
    int parts;                  /* how many functions; 1: all is in one */
    const char *at, *of;        /* the discussion: "&d" and "d.", or in a part "d" and "d->" */
    int most;                   /* copies of a node */
    struct copies copies;
    int *first_arc;            /* by order: the number of the node's first arc */
    unsigned char *entry;      /* by order: does an arc from another part lead to it? */
    unsigned char *node_label; /* by copy: is there a goto to it? */
    unsigned char *leaf_label; /* by decision */
    unsigned char *leaf_used;  /* by decision: does an arc lead to its shared leaf? */
    /* --outline: the pieces that are functions, how many, and by order which of them and which use
     * a node is a part of (from 1; 0: of none), and which node of it. */
    struct shared *shared;
    int shared_count;
    int *piece, *use, *member;
    const struct shared *inside; /* the function that is printed; NULL: that of the whole graph */
    unsigned char *handled;      /* by term: does some node of the oracle? */
    int first_leaf;              /* the first decision whose leaf is used; -1: none */
};

static inline const struct node *dag_flat_at(const struct flat *flat, int place)
{
    return dag_node_at(flat->dag, flat->oracle, place);
}

static inline const struct arc *dag_flat_arc(const struct flat *flat, const struct node *node,
                                             int answer)
{
    return &flat->dag->arcs[node->arcs.first + answer];
}

/* Of several functions, the one that a node is in. */
static inline int dag_flat_part(const struct flat *flat, int place)
{
    return flat->parts == 1 ? 0 : place / PART_NODES;
}

/* emit_flat.c */
/* Does an arc to it lead to the shared text that gives back what the decision reads? */
int dag_flat_has_leaf(const struct flat *flat, const struct target *target);

/* flat_node.c */
/* The copy that stands behind this one; -1: it is the last. */
int dag_flat_behind(const struct flat *flat, int copy);
/* The node; its label; where an answer or exit leads, `way` as of a copy, or where a way leads,
 * behind `indent` spaces. */
void dag_flat_node(const struct flat *flat, int at);
void dag_flat_label(const struct flat *flat, int copy);
void dag_flat_jump(const struct flat *flat, int from, const struct target *target, int way,
                   int indent);
void dag_flat_way(const struct flat *flat, int way, int indent);
void dag_flat_directive(const struct flat *flat, struct where where);
/* The name of a term's level, from 1. */
const char *dag_flat_level(const struct dag *dag, const struct term *term, int level);
/* Marks what the copy has gotos to, or what the way leads to. */
void dag_flat_mark_labels(struct flat *flat, int copy);
void dag_flat_label_way(struct flat *flat, int way);
/* The terms that the node handles, one by one: its arguments', then its tool's; -1: no more. */
int dag_flat_term(const struct dag *dag, const struct node *node, int need);
/* Is the compiler told that the copy has the term? */
int dag_flat_is_fact(const struct flat *flat, const struct copy *copy, int term);

/* emit_outline.c */
/* Chooses and prints the pieces that become functions, and does the labels anew. */
void dag_flat_outline(struct flat *flat);
/* The node, or the call in its place, or nothing: the call stands elsewhere. */
void dag_flat_node_or_call(const struct flat *flat, int copy);

#endif
