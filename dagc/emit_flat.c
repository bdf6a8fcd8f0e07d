/* emit_flat.c - a decision graph as one C function.
 *
 * Each reachable node stands once, under a label, in topological order, and every arc is one
 * goto: the text is linear in the graph however its nodes are shared (nested ifs double a shared
 * node at each sharing). The discussion is a local copy; once the tools are inlined the compiler
 * keeps its terms in registers and sees, along each path, which of them are known. Terms that some
 * decision reads come with the discussion, as an earlier one about the same pair may have left them, and
 * go back with such a decision; all others start absent.
 * SPDX-License-Identifier: MIT */
#include "emit.h"

struct flat {
    struct dag *dag;
    struct text *out;
    const struct oracle_graph *oracle;
    unsigned char *node_label; /* by order: is there a goto to it? */
    unsigned char *leaf_label; /* by decision */
    unsigned char *leaf_used;  /* by decision: does an arc lead to its shared leaf? */
    int first_leaf;            /* the first decision whose leaf is used; -1: none */
};

static int same_target(const struct target *a, const struct target *b)
{
    return a->kind == b->kind && a->index == b->index;
}

static const struct arc *arc_of(const struct flat *flat, const struct node *node, int answer)
{
    return &flat->dag->arcs[node->arcs.first + answer];
}

/* Do all answers lead to one target? Then there is nothing to ask. */
static int decides_nothing(const struct flat *flat, const struct node *node)
{
    for (int i = 1; i < node->arcs.count; i++)
        if (!same_target(&arc_of(flat, node, 0)->target, &arc_of(flat, node, i)->target))
            return 0;
    return 1;
}

static int has_shared_leaf(const struct flat *flat, const struct target *target)
{
    return target->kind == TARGET_DECISION &&
           flat->dag->decisions[target->index].reads.count > 0;
}

/* What stands next needs no goto when nothing is asked before it: the node at the next place, or,
 * after the last one, the first of the shared leaves. */
static int falls_through(const struct flat *flat, const struct node *node)
{
    const struct target *target = &arc_of(flat, node, 0)->target;
    if (!decides_nothing(flat, node))
        return 0;
    if (target->kind == TARGET_NODE)
        return flat->dag->nodes[target->index].order == node->order + 1;
    return node->order == flat->oracle->order.count - 1 && target->index == flat->first_leaf;
}

static const struct node *node_at(const struct flat *flat, int place)
{
    return &flat->dag->nodes[flat->dag->order[flat->oracle->order.first + place]];
}

static void find_labels(struct flat *flat)
{
    for (int i = 0; i < flat->oracle->order.count; i++) {
        const struct node *node = node_at(flat, i);
        for (int a = 0; a < node->arcs.count; a++) {
            const struct target *target = &arc_of(flat, node, a)->target;
            if (has_shared_leaf(flat, target)) {
                flat->leaf_used[target->index] = 1;
                if (flat->first_leaf < 0 || target->index < flat->first_leaf)
                    flat->first_leaf = target->index;
            }
        }
    }
    for (int i = 0; i < flat->oracle->order.count; i++) {
        const struct node *node = node_at(flat, i);
        int through = falls_through(flat, node);
        for (int a = 0; a < node->arcs.count; a++) {
            const struct target *target = &arc_of(flat, node, a)->target;
            if (target->kind == TARGET_NODE && !through)
                flat->node_label[flat->dag->nodes[target->index].order] = 1;
            else if (has_shared_leaf(flat, target) && !through)
                flat->leaf_label[target->index] = 1;
        }
    }
}

static void print_constant(struct text *out, const char *prefix, const char *name)
{
    dag_print_upper(out, prefix);
    dag_print(out, "_");
    dag_print_upper(out, name);
}

static void print_jump(const struct flat *flat, const struct target *target)
{
    if (target->kind == TARGET_NODE)
        dag_print(flat->out, "goto node_%s;\n", flat->dag->nodes[target->index].name);
    else if (has_shared_leaf(flat, target))
        dag_print(flat->out, "goto leaf_%s;\n", flat->dag->decisions[target->index].name);
    else {
        dag_print(flat->out, "return ");
        print_constant(flat->out, "decision", flat->dag->decisions[target->index].name);
        dag_print(flat->out, ";\n");
    }
}

static void print_call(const struct flat *flat, const struct node *node)
{
    int value = 0;
    dag_print(flat->out, "tool_%s(&d", flat->dag->tools[node->tool].name);
    for (int i = 0; i < node->arguments.count; i++) {
        dag_print(flat->out, ", ");
        dag_emit_expression(flat->dag, flat->out, &flat->dag->arguments[node->arguments.first + i],
                            &value);
    }
    dag_print(flat->out, ")");
}

/* The answers that share a target share a jump; the last ones are the default, so that the
 * compiler need not think of an answer that does not exist. */
static void print_switch(const struct flat *flat, const struct node *node)
{
    const struct tool *tool = &flat->dag->tools[node->tool];
    const struct answer *answers = &flat->dag->answers[tool->answers.first];
    unsigned char done[ANSWERS_MAX] = {0};
    int left = node->arcs.count;
    dag_print(flat->out, "    switch (");
    print_call(flat, node);
    dag_print(flat->out, ") {\n");
    for (int i = 0; i < node->arcs.count; i++) {
        const struct target *target = &arc_of(flat, node, i)->target;
        for (int j = i; j < node->arcs.count; j++)
            if (!done[j] && same_target(target, &arc_of(flat, node, j)->target)) {
                dag_print(flat->out, "    case ");
                print_constant(flat->out, tool->name, answers[j].name);
                dag_print(flat->out, ":\n");
                done[j] = 2;
                left--;
            }
        if (done[i] == 2) {
            dag_print(flat->out, "%s        ", left == 0 ? "    default:\n" : "");
            print_jump(flat, target);
        }
        for (int j = i; j < node->arcs.count; j++)
            done[j] = done[j] != 0;
    }
    dag_print(flat->out, "    }\n");
}

static void print_node(const struct flat *flat, const struct node *node)
{
    int block = dag_has_reads(flat->dag, node);
    dag_print(flat->out, "\n");
    if (flat->node_label[node->order])
        dag_print(flat->out, "node_%s:\n", node->name);
    if (block) { /* C++ may not jump past a constant: it gets a block */
        dag_print(flat->out, "    {\n");
        dag_emit_reads(flat->dag, flat->out, node);
    }
    if (!decides_nothing(flat, node)) {
        print_switch(flat, node);
        dag_print(flat->out, "%s", block ? "    }\n" : "");
        return;
    }
    dag_print(flat->out, "    (void)");
    print_call(flat, node);
    dag_print(flat->out, ";\n%s", block ? "    }\n" : "");
    if (!falls_through(flat, node)) {
        dag_print(flat->out, "    ");
        print_jump(flat, &arc_of(flat, node, 0)->target);
    }
}

static void print_leaf(const struct flat *flat, const struct decision_tool *decision)
{
    const struct dag *dag = flat->dag;
    const struct need *needs = &dag->needs[decision->reads.first];
    dag_print(flat->out, "\n");
    if (flat->leaf_label[decision - dag->decisions])
        dag_print(flat->out, "leaf_%s:\n", decision->name);
    for (int i = 0; i < decision->reads.count; i++) {
        const struct term *term = &dag->terms[needs[i].term];
        int length = dag->types[term->type].length;
        for (int k = 0; length > 1 && k < length; k++)
            dag_print(flat->out, "    discussion->terms.%s[%d] = d.terms.%s[%d];\n", term->name, k,
                      term->name, k);
        if (length == 1)
            dag_print(flat->out, "    discussion->terms.%s = d.terms.%s;\n", term->name, term->name);
        dag_print(flat->out, "    discussion->terms.%s_level = d.terms.%s_level;\n", term->name,
                  term->name);
    }
    dag_print(flat->out, "    return ");
    print_constant(flat->out, "decision", decision->name);
    dag_print(flat->out, ";\n");
}

static int uses_parameters(const struct flat *flat)
{
    for (int i = 0; i < flat->oracle->order.count; i++) {
        const struct node *node = node_at(flat, i);
        for (int a = 0; a < node->arguments.count; a++) {
            int value = flat->dag->arguments[node->arguments.first + a].expression;
            if (dag_reads_parameters(flat->dag, value))
                return 1;
        }
    }
    return 0;
}

/* Does a decision read the term? Then a discussion gives it back, and may be handed it again. */
static int is_kept(const struct dag *dag, int term)
{
    for (int i = 0; i < dag->decision_count; i++)
        for (int k = 0; k < dag->decisions[i].reads.count; k++)
            if (dag->needs[dag->decisions[i].reads.first + k].term == term)
                return 1;
    return 0;
}

/* Terms that no decision reads are unknown at first. The values are cleared, too: a register is
 * then never filled from the caller's memory only because the compiler cannot see that the value
 * is not used. */
static void print_absent(const struct flat *flat)
{
    const struct dag *dag = flat->dag;
    for (int i = 0; i < dag->term_count; i++) {
        const struct term *term = &dag->terms[i];
        int length = dag->types[term->type].length;
        if (is_kept(dag, i))
            continue;
        dag_print(flat->out, "    ");
        for (int k = 0; length > 1 && k < length; k++)
            dag_print(flat->out, "d.terms.%s[%d] = ", term->name, k);
        if (length == 1)
            dag_print(flat->out, "d.terms.%s = ", term->name);
        dag_print(flat->out, "0;\n    d.terms.%s_level = ", term->name);
        print_constant(flat->out, term->name, "absent");
        dag_print(flat->out, ";\n");
    }
}

void dag_emit_flat(struct dag *dag, struct text *out, const struct oracle_graph *oracle)
{
    struct flat flat = {dag, out, oracle, NULL, NULL, NULL, -1};
    flat.node_label = dag_alloc(&dag->arena, (size_t)oracle->order.count);
    flat.leaf_label = dag_alloc(&dag->arena, (size_t)dag->decision_count);
    flat.leaf_used = dag_alloc(&dag->arena, (size_t)dag->decision_count);
    find_labels(&flat);

    dag_print(out, "\nenum decision %s_refine(const struct %s_parameters *parameters,\n"
                   "    struct discussion *discussion)\n{\n"
                   "    struct discussion d = *discussion;\n", oracle->name, oracle->name);
    print_absent(&flat);
    if (!uses_parameters(&flat))
        dag_print(out, "    (void)parameters;\n");
    for (int i = 0; i < oracle->order.count; i++)
        print_node(&flat, node_at(&flat, i));
    for (int i = 0; i < dag->decision_count; i++)
        if (flat.leaf_used[i])
            print_leaf(&flat, &dag->decisions[i]);
    dag_print(out, "}\n");
}
