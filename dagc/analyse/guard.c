/* guard.c - does what a guard answers hold, with the arguments it is given?
 *
 * A guard's measure is how often a pair can still be split before something is below a limit, and
 * the limit is what its `by` parameters say. It is a measure only while the limit stays: a limit
 * that is computed from the pair may fall with every split. And it ends only above 0. So of the
 * parameters one must be above 0 whatever happens, or be made of numbers, parameters and facts that
 * are the same for all pairs, and not be surely 0.
 * SPDX-License-Identifier: MIT */
#include "analyse/guard.h"

#include <string.h>

/* What the value reads that may change from pair to pair; NULL: nothing. */
static const char *varies(const struct dag *dag, int expression)
{
    const struct expression *e = &dag->expressions[expression];
    const char *left;
    if (e->kind == EXPRESSION_FACT)
        return dag->facts[e->index].fixed ? NULL : dag->facts[e->index].name;
    if (e->kind == EXPRESSION_TERM)
        return dag->terms[e->index].name;
    if (e->kind == EXPRESSION_EXTERN)
        return dag->callbacks[e->index].name;
    if (e->left < 0)
        return NULL;
    left = varies(dag, e->left);
    return left != NULL || e->right < 0 ? left : varies(dag, e->right);
}

/* The node's argument for a parameter that the guard goes by. */
static int limit_of(const struct dag *dag, const struct node *node, int by)
{
    const struct tool *tool = &dag->tools[node->tool];
    const char *name = dag->labels[tool->by.first + by].name;
    int i = 0;
    while (strcmp(dag->parameters[tool->parameters.first + i].name, name) != 0)
        i++;
    return dag->arguments[node->arguments.first + i].expression;
}

int dag_guard_holds(const struct dag *dag, const struct node *node)
{
    const struct tool *tool = &dag->tools[node->tool];
    int holds = tool->by.count == 0;
    for (int i = 0; i < tool->by.count && !holds; i++) {
        int limit = limit_of(dag, node, i);
        struct interval value = dag_interval(dag, limit, INTERVAL_FIXED);
        holds = value.low > 0 || (value.high > 0 && varies(dag, limit) == NULL);
    }
    return holds;
}

int dag_guard_idle(const struct dag *dag, const struct node *node)
{
    const struct tool *tool = &dag->tools[node->tool];
    if (tool->guards.count == 0 || tool->by.count == 0)
        return 0;
    for (int i = 0; i < tool->by.count; i++) {
        int limit = limit_of(dag, node, i);
        if (varies(dag, limit) != NULL || dag_interval(dag, limit, INTERVAL_DEFAULTS).high > 0)
            return 0;
    }
    return 1;
}

const char *dag_guard_limits(struct dag *dag, const struct tool *tool, const char *with)
{
    const char *text = "";
    for (int i = 0; i < tool->by.count; i++)
        text = dag_format(&dag->arena, "%s%s%s%s", text, i > 0 ? " and " : "",
                          dag->labels[tool->by.first + i].name, with);
    return text;
}

const char *dag_guard_fault(struct dag *dag, const struct node *node)
{
    const struct tool *tool = &dag->tools[node->tool];
    for (int i = 0; i < tool->by.count; i++) {
        int limit = limit_of(dag, node, i);
        const char *what = varies(dag, limit);
        if (what != NULL)
            return dag_format(&dag->arena,
                              "its limit '%s' is computed from %s, which may fall with every split",
                              dag->labels[tool->by.first + i].name, what);
    }
    return tool->by.count > 1 ? dag_format(&dag->arena, "%s are 0: one of them must be above",
                                           dag_guard_limits(dag, tool, ""))
                              : dag_format(&dag->arena, "%s is 0 and must be above",
                                           dag_guard_limits(dag, tool, ""));
}

const char *dag_guard_allows(struct dag *dag, const struct tool *tool, int answer, int decision)
{
    const char *list = "";
    for (int i = tool->guards.first; i < tool->guards.first + tool->guards.count; i++) {
        const struct guard *guard = &dag->guards[i];
        if (answer >= 0 && guard->answer_index == answer)
            list = dag_join(dag, list, guard->decision.name);
        if (decision >= 0 && guard->decision_index == decision)
            list = *list == '\0' ? guard->answer.name
                                 : dag_format(&dag->arena, "%s | %s", list, guard->answer.name);
    }
    return list;
}

const char *dag_label_list(struct dag *dag, struct span labels)
{
    const char *list = "";
    for (int i = labels.first; i < labels.first + labels.count; i++)
        list = *list == '\0' ? dag->labels[i].name
                             : dag_format(&dag->arena, "%s | %s", list, dag->labels[i].name);
    return list;
}

/* ---- what all paths to a node hold */

/* Is it one of the answers that the guard's tool comes after? */
static int precedes(const struct dag *dag, const struct tool *guard, const struct node *node,
                    int answer)
{
    const char *name = dag_answer_name(dag, node, answer);
    for (int i = 0; guard->after_index == node->tool && i < guard->after_answers.count; i++)
        if (strcmp(dag->labels[guard->after_answers.first + i].name, name) == 0)
            return 1;
    return 0;
}

/* By place: have all paths to the node the answers that the guard's tool comes after? */
static void preceded(const struct dag *dag, const struct oracle_graph *oracle,
                     const struct tool *guard, unsigned char *all)
{
    memset(all, 1, (size_t)oracle->order.count);
    all[0] = guard->after.name == NULL;
    for (int i = 0; i < oracle->order.count; i++) {
        const struct node *node = dag_node_at(dag, oracle, i);
        for (int a = 0; a < node->arcs.count; a++) {
            const struct target *target = &dag->arcs[node->arcs.first + a].target;
            if (target->kind == TARGET_NODE && !precedes(dag, guard, node, a))
                all[dag->nodes[target->index].order] &= all[i];
        }
    }
}

static int allows(const struct dag *dag, const struct node *node, int answer, int decision)
{
    const struct span guards = dag->tools[node->tool].guards;
    for (int i = guards.first; i < guards.first + guards.count; i++)
        if (dag->guards[i].answer_index == answer && dag->guards[i].decision_index == decision)
            return dag_guard_holds(dag, node);
    return 0;
}

void dag_allowed(struct dag *dag, const struct oracle_graph *oracle, int decision,
                 unsigned char *allowed)
{
    size_t count = (size_t)oracle->order.count;
    unsigned char *before = dag_alloc(&dag->arena, count);
    memset(allowed, 1, count);
    allowed[0] = 0;
    for (int i = 0; i < oracle->order.count; i++) {
        const struct node *node = dag_node_at(dag, oracle, i);
        const struct tool *tool = &dag->tools[node->tool];
        if (tool->guards.count > 0)
            preceded(dag, oracle, tool, before);
        for (int a = 0; a < node->arcs.count; a++) {
            const struct target *target = &dag->arcs[node->arcs.first + a].target;
            if (target->kind != TARGET_NODE || (allows(dag, node, a, decision) && before[i]))
                continue;
            allowed[dag->nodes[target->index].order] &= allowed[i];
        }
    }
}
