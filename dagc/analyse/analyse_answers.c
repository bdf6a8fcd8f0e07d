/* analyse_answers.c - answers that a wildcard hides, and answers that make no difference.
 *
 * Two nodes decide alike when they ask the same question with the same arguments and each answer
 * leads to the same decision or to nodes that decide alike. From the leaves upwards every node
 * gets the number of its class, so equal numbers are equal subgraphs, in linear time.
 * [value numbering; hash-consing of decision diagrams, Bryant 1986]
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "analyse/analyse.h"

/* ---- otherwise */

static const struct rule *otherwise_of(const struct dag *dag, const struct node *node)
{
    for (int i = node->rules.first; i < node->rules.first + node->rules.count; i++)
        if (dag->rules[i].labels.count == 0)
            return &dag->rules[i];
    return NULL;
}

static int is_by(const struct arc *arc, const struct rule *rule)
{
    return arc->where.source == rule->where.source && arc->where.offset == rule->where.offset;
}

/* A node whose only rule is `otherwise` asks without wanting to know: see idle-question. */
static void check_wildcard(struct dag *dag, struct search *search, const struct node *node)
{
    const struct rule *otherwise = otherwise_of(dag, node);
    const char *precise = "", *all = "";
    int count = 0, shown = -1;
    if (otherwise == NULL || node->rules.count == 1)
        return;
    dag->use = node->use;
    for (int a = 0; a < node->arcs.count; a++) {
        if (!is_by(&dag->arcs[node->arcs.first + a], otherwise))
            continue;
        const struct answer *answer = &dag->answers[dag->tools[node->tool].answers.first + a];
        all = *all == '\0' ? answer->name : dag_format(&dag->arena, "%s | %s", all, answer->name);
        if (answer->kind != KIND_PRECISE)
            continue;
        precise = dag_join(dag, precise, answer->name);
        shown = shown < 0 ? a : shown;
        count++;
    }
    if (count == 0
        || !dag_warn(dag, WARNING_SWALLOWED_ANSWER, otherwise->where,
                     "'otherwise' swallows the precise answer%s %s of '%s'", count > 1 ? "s" : "",
                     precise, node->name))
        return;
    const char *end = dag_target_name(dag, &dag->arcs[node->arcs.first + shown].target);
    dag_note(dag, node->where, "%s", dag_search_path(search, node, 0, shown, end));
    dag_note(dag, dag_nowhere, "say which answers are meant: %s -> %s;", all,
             otherwise->target.name);
}

/* ---- classes of nodes that decide alike */

struct classes {
    struct dag *dag;
    const struct oracle_graph *oracle;
    int *class; /* by place in the order */
};

/* The class of a target; decisions are the negative numbers. */
static int class_of(const struct classes *classes, const struct target *target)
{
    return target->kind == TARGET_DECISION
               ? -1 - target->index
               : classes->class[classes->dag->nodes[target->index].order];
}

static void find_classes(struct classes *classes)
{
    struct dag *dag = classes->dag;
    struct table table = {NULL, NULL, 0, 0};
    for (int i = classes->oracle->order.count - 1; i >= 0; i--) {
        const struct node *node = dag_node_at(dag, classes->oracle, i);
        const char *call = dag_call_text(dag, node);
        size_t at = strlen(call), room = at + 13 * (size_t)node->arcs.count + 1;
        char *key = dag_alloc(&dag->arena, room);
        memcpy(key, call, at);
        for (int a = 0; a < node->arcs.count; a++) {
            int class = class_of(classes, &dag->arcs[node->arcs.first + a].target);
            at += (size_t)snprintf(key + at, room - at, " %d", class);
        }
        int old = dag_put(&dag->arena, &table, key, i);
        classes->class[i] = old >= 0 ? old : i;
    }
}

static int is_idle(const struct classes *classes, const struct node *node)
{
    const struct arc *arcs = &classes->dag->arcs[node->arcs.first];
    const struct tool *tool = &classes->dag->tools[node->tool];
    if (node->arcs.count < 2 || tool->writes.count > 0 || tool->kind == TOOL_COMMAND)
        return 0;
    for (int a = 1; a < node->arcs.count; a++)
        if (class_of(classes, &arcs[a].target) != class_of(classes, &arcs[0].target))
            return 0;
    return 1;
}

/* The first answer whose arc leads elsewhere in the text, but decides alike; -1: none. */
static int twin_of(const struct classes *classes, const struct node *node, int answer)
{
    const struct arc *arcs = &classes->dag->arcs[node->arcs.first];
    for (int a = 0; a < answer; a++)
        if (!dag_same_target(&arcs[a].target, &arcs[answer].target)
            && class_of(classes, &arcs[a].target) == class_of(classes, &arcs[answer].target))
            return a;
    return -1;
}

static void check_alike(struct classes *classes, struct search *search, const struct node *node)
{
    struct dag *dag = classes->dag;
    const struct arc *arcs = &dag->arcs[node->arcs.first];
    dag->use = node->use;
    if (is_idle(classes, node)) {
        if (dag_warn(dag, WARNING_IDLE_QUESTION, node->where,
                     "'%s' decides nothing: all its answers lead to the same decisions",
                     node->name)) {
            dag_note(dag, arcs[0].target.where, "%s",
                     dag_search_path(search, node, 0, 0, dag_target_name(dag, &arcs[0].target)));
            dag_note(dag, dag_nowhere, "lead to '%s' at once", arcs[0].target.name);
        }
        return;
    }
    for (int a = 1; a < node->arcs.count; a++) {
        int twin = twin_of(classes, node, a);
        if (twin < 0)
            continue;
        if (dag_warn(dag, WARNING_TWIN_ANSWERS, arcs[a].target.where,
                     "'%s' and '%s' of '%s' lead to '%s' and '%s', which decide alike",
                     dag_answer_name(dag, node, twin), dag_answer_name(dag, node, a), node->name,
                     arcs[twin].target.name, arcs[a].target.name)) {
            dag_note(
                dag, arcs[twin].target.where, "%s",
                dag_search_path(search, node, 0, twin, dag_target_name(dag, &arcs[twin].target)));
            dag_note(dag, dag_nowhere, "lead both to '%s'", arcs[twin].target.name);
        }
        break;
    }
}

static int any(const struct search *search, const struct node *node, int answer, int phase)
{
    (void)search, (void)node, (void)answer, (void)phase;
    return 0;
}

void dag_analyse_answers(struct dag *dag)
{
    struct search search = dag_search_new(dag);
    struct classes classes = {dag, NULL, NULL};
    if (dag_warning_level(dag, WARNING_SWALLOWED_ANSWER) == LEVEL_OFF
        && dag_warning_level(dag, WARNING_IDLE_QUESTION) == LEVEL_OFF
        && dag_warning_level(dag, WARNING_TWIN_ANSWERS) == LEVEL_OFF)
        return;
    classes.class = dag_alloc(&dag->arena, (size_t)dag->order_count * sizeof(int));
    for (int i = 0; i < dag->oracle_count; i++) {
        classes.oracle = &dag->oracles[i];
        find_classes(&classes);
        dag_search(&search, classes.oracle, 1, any, NULL);
        for (int k = 0; k < classes.oracle->order.count; k++) {
            const struct node *node = dag_node_at(dag, classes.oracle, k);
            check_wildcard(dag, &search, node);
            check_alike(&classes, &search, node);
        }
    }
}
