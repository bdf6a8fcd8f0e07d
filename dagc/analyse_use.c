/* analyse_use.c - what nothing leads to and what nothing uses.
 *
 * A parameter that only unreachable nodes use is not reported: mending those may use it.
 * SPDX-License-Identifier: MIT */
#include "analyse.h"

static void unreachable(struct dag *dag, const struct oracle_graph *oracle)
{
    unsigned char *led_to = dag_alloc(&dag->arena, (size_t)dag->node_count);
    int count = oracle->nodes.count;
    for (int i = oracle->nodes.first; i < oracle->nodes.first + count; i++)
        for (int a = 0; a < dag->nodes[i].arcs.count; a++) {
            const struct target *target = &dag->arcs[dag->nodes[i].arcs.first + a].target;
            if (target->kind == TARGET_NODE)
                led_to[target->index] = 1;
        }
    for (int i = oracle->nodes.first; i < oracle->nodes.first + count; i++) {
        const struct node *node = &dag->nodes[i];
        if (node->order >= 0)
            continue;
        if (!dag_warn(dag, WARNING_UNREACHABLE_NODE, node->where,
                      "no path from start leads to the node '%s'", node->name))
            continue;
        if (led_to[i])
            dag_note(dag, dag_nowhere, "only nodes that are unreachable themselves lead to it");
        else
            dag_note(dag, oracle->start.where, "no answer of any node leads to it, and start is '%s'",
                     oracle->start.name);
    }
}

/* Marks the parameters in an expression. */
static void mark(const struct dag *dag, int expression, unsigned char *used)
{
    const struct expression *e = &dag->expressions[expression];
    if (e->kind == EXPRESSION_PARAMETER)
        used[e->parameter] = 1;
}

static void unused_parameters(struct dag *dag, const struct oracle_graph *oracle)
{
    unsigned char *used = dag_alloc(&dag->arena, (size_t)dag->parameter_count);
    for (int i = oracle->nodes.first; i < oracle->nodes.first + oracle->nodes.count; i++) {
        struct span arguments = dag->nodes[i].arguments;
        for (int a = arguments.first; a < arguments.first + arguments.count; a++)
            mark(dag, dag->arguments[a].expression, used);
    }
    for (int i = oracle->parameters.first;
         i < oracle->parameters.first + oracle->parameters.count; i++)
        if (!used[i] && dag_warn(dag, WARNING_UNUSED_PARAMETER, dag->parameters[i].where,
                                 "no node of '%s' uses the parameter '%s'", oracle->name,
                                 dag->parameters[i].name))
            dag_note(dag, dag_nowhere, "who sets it would see nothing change: use it or remove it");
}

void dag_analyse_use(struct dag *dag)
{
    for (int i = 0; i < dag->oracle_count; i++) {
        if (dag_warning_level(dag, WARNING_UNREACHABLE_NODE) != LEVEL_OFF)
            unreachable(dag, &dag->oracles[i]);
        if (dag_warning_level(dag, WARNING_UNUSED_PARAMETER) != LEVEL_OFF)
            unused_parameters(dag, &dag->oracles[i]);
    }
    /* UNUSED_IMPORT and UNUSED_BRANCH go here, once the dag has imports and branches. */
}
