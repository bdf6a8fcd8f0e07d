/* analyse_use.c - what nothing leads to and what nothing uses.
 *
 * All of this is asked of the graphs as written, before branches are put in place: a node of a
 * branch is one node, however often the branch is used. A parameter that only unreachable nodes
 * use is not reported: mending those may use it.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "analyse/analyse.h"

/* ---- nodes */

/* The draft that the graph starts with; -1: none is called so. */
static int start_of(const struct dag *dag, const struct oracle_graph *graph)
{
    for (int i = graph->drafts.first; i < graph->drafts.first + graph->drafts.count; i++)
        if (strcmp(dag->drafts[i].name, graph->start.name) == 0)
            return i;
    return -1;
}

enum { LED_TO = 1, REACHED = 2 };

/* Marks what the draft's arcs lead to; those seen for the first time go on the stack. */
static void follow(const struct dag *dag, const struct node *draft, unsigned char *marks,
                   unsigned char mark, int *stack, int *depth)
{
    for (int a = draft->arcs.first; a < draft->arcs.first + draft->arcs.count; a++) {
        const struct target *target = &dag->arcs[a].target;
        if (target->kind != TARGET_NODE || (marks[target->index] & mark) != 0)
            continue;
        marks[target->index] |= mark;
        if (stack != NULL)
            stack[(*depth)++] = target->index;
    }
}

static void unreachable(struct dag *dag, const struct oracle_graph *graph, unsigned char *marks,
                        int *stack)
{
    int start = start_of(dag, graph), depth = 0, end = graph->drafts.first + graph->drafts.count;
    if (start < 0)
        return;
    marks[start] |= REACHED;
    stack[depth++] = start;
    while (depth > 0) {
        const struct node *draft = &dag->drafts[stack[--depth]];
        follow(dag, draft, marks, REACHED, stack, &depth);
    }
    for (int i = graph->drafts.first; i < end; i++)
        follow(dag, &dag->drafts[i], marks, LED_TO, NULL, NULL);
    for (int i = graph->drafts.first; i < end; i++) {
        const struct node *draft = &dag->drafts[i];
        if ((marks[i] & REACHED) != 0
            || !dag_warn(dag, WARNING_UNREACHABLE_NODE, draft->where,
                         "no path from start leads to the node '%s'", draft->name))
            continue;
        if ((marks[i] & LED_TO) != 0)
            dag_note(dag, dag_nowhere, "only nodes that are unreachable themselves lead to it");
        else
            dag_note(dag, graph->start.where,
                     "no answer of any node leads to it, and start is '%s'", graph->start.name);
    }
}

/* ---- parameters */

static void mark(const struct dag *dag, int expression, unsigned char *used)
{
    const struct expression *e = &dag->expressions[expression];
    if (e->kind == EXPRESSION_PARAMETER)
        used[e->parameter] = 1;
    if (e->left >= 0)
        mark(dag, e->left, used);
    if (e->right >= 0)
        mark(dag, e->right, used);
}

static void unused_parameters(struct dag *dag, const struct oracle_graph *graph,
                              unsigned char *used)
{
    struct span drafts = graph->drafts, parameters = graph->parameters;
    for (int i = drafts.first; i < drafts.first + drafts.count; i++) {
        struct span arguments = dag->drafts[i].arguments;
        for (int a = arguments.first; a < arguments.first + arguments.count; a++)
            if (dag->arguments[a].expression >= 0)
                mark(dag, dag->arguments[a].expression, used);
    }
    for (int i = parameters.first; i < parameters.first + parameters.count; i++)
        if (!used[i] && dag->parameters[i].role < 0 /* a program reads it */
            && dag_warn(dag, WARNING_UNUSED_PARAMETER, dag->parameters[i].where,
                        "no node of '%s' uses the parameter '%s'", graph->name,
                        dag->parameters[i].name))
            dag_note(dag, dag_nowhere, "who sets it would see nothing change: use it or remove it");
}

/* ---- branches and imports */

/* A file that others import may hold branches for them. */
static void unused_branches(struct dag *dag)
{
    for (int i = 0; i < dag->branch_count; i++) {
        const struct oracle_graph *branch = &dag->branches[i];
        if (branch->use < 0 && dag->oracle_count > 0
            && branch->where.source == dag->oracles[0].where.source)
            dag_warn(dag, WARNING_UNUSED_BRANCH, branch->where, "no node uses the graph '%s'",
                     branch->name);
    }
}

static void use_needs(const struct dag *dag, struct span needs, unsigned char *sources)
{
    for (int i = needs.first; i < needs.first + needs.count; i++)
        sources[dag->terms[dag->needs[i].term].where.source] = 1;
}

static void use_expression(const struct dag *dag, int expression, unsigned char *sources)
{
    const struct expression *e = &dag->expressions[expression];
    if (e->kind == EXPRESSION_FACT)
        sources[dag->facts[e->index].where.source] = 1;
    else if (e->kind == EXPRESSION_TERM)
        sources[dag->terms[e->index].where.source] = 1;
    else if (e->kind == EXPRESSION_EXTERN)
        sources[dag->callbacks[e->index].where.source] = 1;
    if (e->left >= 0)
        use_expression(dag, e->left, sources);
    if (e->right >= 0)
        use_expression(dag, e->right, sources);
}

/* Marks the sources of all that the node's tool, arguments and leaves name. */
static void use_node(const struct dag *dag, const struct node *node, unsigned char *sources)
{
    if (node->tool >= 0) {
        const struct tool *tool = &dag->tools[node->tool];
        sources[tool->where.source] = 1;
        use_needs(dag, tool->reads, sources);
        use_needs(dag, tool->writes, sources);
    }
    for (int a = node->arguments.first; a < node->arguments.first + node->arguments.count; a++)
        if (dag->arguments[a].expression >= 0)
            use_expression(dag, dag->arguments[a].expression, sources);
    for (int a = node->arcs.first; a < node->arcs.first + node->arcs.count; a++)
        if (dag->arcs[a].target.kind == TARGET_DECISION) {
            const struct decision_tool *decision = &dag->decisions[dag->arcs[a].target.index];
            sources[decision->where.source] = 1;
            use_needs(dag, decision->reads, sources);
        }
}

static void use_parameters(const struct dag *dag, struct span parameters, unsigned char *sources)
{
    for (int i = parameters.first; i < parameters.first + parameters.count; i++)
        sources[dag->types[dag->parameters[i].type].where.source] = 1;
}

static void unused_imports(struct dag *dag)
{
    unsigned char *sources = dag_alloc(&dag->arena, (size_t)dag->source_count);
    for (int i = 0; i < dag->draft_count; i++)
        use_node(dag, &dag->drafts[i], sources);
    for (int i = 0; i < dag->branch_count; i++) {
        use_parameters(dag, dag->branches[i].parameters, sources);
        if (dag->branches[i].use >= 0)
            sources[dag->branches[i].where.source] = 1;
    }
    for (int i = 0; i < dag->oracle_count; i++)
        use_parameters(dag, dag->oracles[i].parameters, sources);
    /* What imports a used file is used; an import stands before those of the file it reads. */
    for (int i = dag->import_count - 1; i >= 0; i--)
        if (dag->imports[i].source >= 0 && sources[dag->imports[i].source])
            sources[dag->imports[i].where.source] = 1;
    for (int i = 0; i < dag->import_count; i++) {
        const struct import *import = &dag->imports[i];
        if (import->source < 0 || sources[import->source] || dag->oracle_count == 0
            || import->where.source != dag->oracles[0].where.source)
            continue;
        dag_warn(dag, WARNING_UNUSED_IMPORT, import->where, "nothing of %s is used",
                 dag->sources[import->source].name);
    }
}

void dag_analyse_use(struct dag *dag)
{
    unsigned char *marks = dag_alloc(&dag->arena, (size_t)dag->draft_count);
    int *stack = dag_alloc(&dag->arena, (size_t)dag->draft_count * sizeof(int));
    unsigned char *used = dag_alloc(&dag->arena, (size_t)dag->parameter_count);
    for (int i = 0; i < dag->oracle_count + dag->branch_count; i++) {
        const struct oracle_graph *graph =
            i < dag->oracle_count ? &dag->oracles[i] : &dag->branches[i - dag->oracle_count];
        unreachable(dag, graph, marks, stack);
        unused_parameters(dag, graph, used);
    }
    unused_branches(dag);
    unused_imports(dag);
}
