/* analyse_guards.c - does every path to a subdivision pass a guard?
 *
 * A decision that `subdivides` asks the oracle again, one step deeper. Only a tool declared
 * `guards` knows when that must end (clusters become surfaces, surfaces become small), so a path
 * without one, whatever that guard answers, may go on for ever. The paths without a guard are
 * those of the graph without its guards: one search finds them all.
 * SPDX-License-Identifier: MIT */
#include "analyse/analyse.h"

static int unguarded(const struct search *search, const struct node *node, int answer, int phase)
{
    (void)answer, (void)phase;
    return search->dag->tools[node->tool].guards ? -1 : 0;
}

static const char *guards(struct dag *dag)
{
    const char *list = "";
    for (int i = 0; i < dag->tool_count; i++)
        if (dag->tools[i].guards)
            list = dag_join(dag, list, dag->tools[i].name);
    return list;
}

static void report(struct search *search, const struct node *node, int answer, int others)
{
    struct dag *dag = search->dag;
    const struct arc *arc = &dag->arcs[node->arcs.first + answer];
    const char *decision = dag->decisions[arc->target.index].name, *list = guards(dag);
    dag->use = node->use;
    if (!dag_warn(dag, WARNING_UNGUARDED_SPLIT, arc->target.where,
                  "a path to '%s' passes no guard: '%s' need not end", decision,
                  search->oracle->name))
        return;
    dag_note(dag, node->where, "%s", dag_search_path(search, node, 0, answer, decision));
    if (others > 0)
        dag_note(dag, dag_nowhere, "%d more arc%s to '%s' lack%s one as well", others,
                 others > 1 ? "s" : "", decision, others > 1 ? "" : "s");
    if (*list == '\0')
        dag_note(dag, dag_nowhere, "no tool of the catalog is declared 'guards'");
    else
        dag_note(dag, dag_nowhere, "ask a guard on the way, whatever it answers: %s", list);
}

/* Every arc of an unguarded path that leads to the decision: the first is reported. */
static void check_decision(struct search *search, int decision)
{
    const struct dag *dag = search->dag;
    const struct node *first = NULL;
    int first_answer = 0, count = 0;
    for (int i = 0; i < search->oracle->order.count; i++) {
        const struct node *node = dag_node_at(dag, search->oracle, i);
        if (!dag_search_reached(search, node, 0) || dag->tools[node->tool].guards)
            continue;
        for (int a = 0; a < node->arcs.count; a++) {
            const struct target *target = &dag->arcs[node->arcs.first + a].target;
            if (target->kind != TARGET_DECISION || target->index != decision)
                continue;
            if (count++ == 0) {
                first = node;
                first_answer = a;
            }
        }
    }
    if (count > 0)
        report(search, first, first_answer, count - 1);
}

void dag_analyse_guards(struct dag *dag)
{
    if (dag_warning_level(dag, WARNING_UNGUARDED_SPLIT) == LEVEL_OFF)
        return;
    struct search search = dag_search_new(dag);
    for (int i = 0; i < dag->oracle_count; i++) {
        dag_search(&search, &dag->oracles[i], 1, unguarded, NULL);
        for (int k = 0; k < dag->decision_count; k++)
            if (dag->decisions[k].subdivides)
                check_decision(&search, k);
    }
}
