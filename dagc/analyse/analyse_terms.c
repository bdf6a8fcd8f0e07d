/* analyse_terms.c - is every term that a path needs known there, at the level that is needed?
 *
 * A forward must-analysis: the fact about a term is the level at which it is surely known, where
 * paths meet the least of theirs holds, and a tool that writes the term raises it, but where it
 * answers that it refuses. A tool's
 * `reads` without a level asks for nothing: such a tool computes what it lacks, and may also
 * do without (so it raises nothing either); what a node's arguments read is computed before the
 * tool is asked, and is known from there on. A level in `reads`, and whatever a decision reads,
 * must be there. Terms are absent at the start: what an earlier discussion left may be gone.
 * [the forward analysis of Kildall 1973, on a graph without cycles: one sweep]
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "analyse/analyse.h"

int dag_written_level(const struct dag *dag, const struct tool *tool, int answer, int term)
{
    int level = 0;
    if (answer >= 0 && dag->answers[tool->answers.first + answer].refuses)
        return 0;
    for (int i = tool->writes.first; i < tool->writes.first + tool->writes.count; i++)
        if (dag->needs[i].term == term && dag->needs[i].level > level)
            level = dag->needs[i].level;
    return level;
}

int dag_left_level(const struct dag *dag, const struct node *node, int answer, int term)
{
    int level = dag_written_level(dag, &dag->tools[node->tool], answer, term);
    for (int i = node->reads.first; i < node->reads.first + node->reads.count; i++)
        if (dag->needs[i].term == term && dag->needs[i].level > level)
            level = dag->needs[i].level;
    return level;
}

void dag_sure_levels(const struct dag *dag, const struct oracle_graph *oracle, int term,
                     unsigned char *sure)
{
    enum { UNREACHED = 255 }; /* above every level: a term has fewer than that */
    for (int i = 0; i < oracle->order.count; i++)
        sure[i] = UNREACHED;
    sure[0] = 0;
    for (int i = 0; i < oracle->order.count; i++) {
        const struct node *node = dag_node_at(dag, oracle, i);
        for (int a = 0; a < node->arcs.count; a++) {
            int written = dag_left_level(dag, node, a, term);
            unsigned char after = written > sure[i] ? (unsigned char)written : sure[i];
            const struct target *target = &dag->arcs[node->arcs.first + a].target;
            if (target->kind == TARGET_NODE && after < sure[dag->nodes[target->index].order])
                sure[dag->nodes[target->index].order] = after;
        }
    }
}

int dag_is_kept(const struct dag *dag, int term)
{
    for (int i = 0; i < dag->decision_count; i++)
        for (int k = 0; k < dag->decisions[i].reads.count; k++)
            if (dag->needs[dag->decisions[i].reads.first + k].term == term)
                return 1;
    return 0;
}

/* The may-analysis beside it. A node may fill whatever it declares to read or write; a term that
 * decisions read may have come with the discussion. */
void dag_possible_terms(const struct dag *dag, const struct oracle_graph *oracle, int term,
                        unsigned char *possible)
{
    memset(possible, 0, (size_t)oracle->order.count);
    possible[0] = (unsigned char)dag_is_kept(dag, term);
    for (int i = 0; i < oracle->order.count; i++) {
        const struct node *node = dag_node_at(dag, oracle, i);
        const struct tool *tool = &dag->tools[node->tool];
        int after = possible[i] || dag_reads_term(dag, node->reads, term)
                    || dag_reads_term(dag, tool->reads, term)
                    || dag_reads_term(dag, tool->writes, term);
        for (int a = 0; a < node->arcs.count; a++) {
            const struct target *target = &dag->arcs[node->arcs.first + a].target;
            if (target->kind == TARGET_NODE)
                possible[dag->nodes[target->index].order] |= (unsigned char)after;
        }
    }
}

/* ---- witnesses */

struct wanted {
    int term, level;
};

/* Paths on which the term does not reach the level. */
static int lacks(const struct search *search, const struct node *node, int answer, int phase)
{
    const struct wanted *wanted = search->context;
    (void)phase;
    int level = dag_left_level(search->dag, node, answer, wanted->term);
    return level >= wanted->level ? -1 : 0;
}

/* Phase 1: the term has reached the level. */
static int reaches(const struct search *search, const struct node *node, int answer, int phase)
{
    const struct wanted *wanted = search->context;
    return phase || dag_left_level(search->dag, node, answer, wanted->term) >= wanted->level;
}

static const char *level_name(const struct dag *dag, int term, int level)
{
    struct span levels = dag->terms[term].levels;
    return levels.count == 0 ? "present" : dag->levels[levels.first + level - 1].name;
}

static void note_writers(struct dag *dag, const struct need *need)
{
    const char *list = "";
    for (int i = 0; i < dag->tool_count; i++)
        if (dag_written_level(dag, &dag->tools[i], -1, need->term) >= need->level)
            list = dag_join(dag, list, dag->tools[i].name);
    if (*list == '\0')
        dag_note(dag, dag_nowhere, "no tool of the catalog writes it so");
    else
        dag_note(dag, dag_nowhere, "ask one of these on the way: %s", list);
}

/* ---- what is missing */

/* Where a need is not met: the first place, and how many more. */
struct lack {
    const struct node *node;
    int answer; /* -1: the node's own tool has the need */
    int count;
};

static void report_lack(struct search *search, const struct need *need, const char *who,
                        const struct lack *lack)
{
    struct dag *dag = search->dag;
    const struct node *node = lack->node;
    struct wanted wanted = {need->term, need->level};
    dag->use = node->use;
    struct where where = lack->answer < 0 ? node->tool_where
                                          : dag->arcs[node->arcs.first + lack->answer].target.where;
    if (!dag_warn(dag, WARNING_MISSING_TERM, where,
                  "'%s' needs %s, and a path to it does not compute that", who,
                  dag_need_text(dag, need)))
        return;
    dag_search(search, search->oracle, 1, lacks, &wanted);
    dag_note(dag, node->where, "%s",
             dag_search_path(search, node, 0, lack->answer, lack->answer < 0 ? NULL : who));
    if (lack->count > 1)
        dag_note(dag, dag_nowhere, "at %d more place%s it is missing as well", lack->count - 1,
                 lack->count > 2 ? "s" : "");
    note_writers(dag, need);
}

static void check_decision(struct search *search, int decision, const struct need *need,
                           const unsigned char *sure)
{
    struct dag *dag = search->dag;
    struct lack lack = {NULL, 0, 0};
    for (int i = 0; i < search->oracle->order.count; i++) {
        const struct node *node = dag_node_at(dag, search->oracle, i);
        for (int a = 0; a < node->arcs.count; a++) {
            const struct target *target = &dag->arcs[node->arcs.first + a].target;
            if (sure[i] >= need->level || dag_left_level(dag, node, a, need->term) >= need->level)
                continue;
            if (target->kind != TARGET_DECISION || target->index != decision)
                continue;
            if (lack.count++ == 0) {
                lack.node = node;
                lack.answer = a;
            }
        }
    }
    if (lack.count > 0)
        report_lack(search, need, dag->decisions[decision].name, &lack);
}

/* Do the node's arguments read the term so well? They are evaluated before the tool. */
static int reads_it(const struct dag *dag, const struct node *node, const struct need *need)
{
    for (int i = node->reads.first; i < node->reads.first + node->reads.count; i++)
        if (dag->needs[i].term == need->term && dag->needs[i].level >= need->level)
            return 1;
    return 0;
}

static void check_tool(struct search *search, int tool, const struct need *need,
                       const unsigned char *sure)
{
    struct dag *dag = search->dag;
    struct lack lack = {NULL, -1, 0};
    for (int i = 0; i < search->oracle->order.count; i++) {
        const struct node *node = dag_node_at(dag, search->oracle, i);
        if (node->tool == tool && sure[i] < need->level && !reads_it(dag, node, need)
            && lack.count++ == 0)
            lack.node = node;
    }
    if (lack.count > 0)
        report_lack(search, need, dag->tools[tool].name, &lack);
}

/* ---- what is computed again, and worse */

/* A tool writes at its level or better: how much better its arguments may say, as the number of
 * rays does, so only of a tool without any it is known. */
static void check_falling(struct search *search, int term, const unsigned char *sure)
{
    struct dag *dag = search->dag;
    for (int i = 0; i < search->oracle->order.count; i++) {
        const struct node *node = dag_node_at(dag, search->oracle, i);
        const struct tool *tool = &dag->tools[node->tool];
        struct wanted wanted = {term, sure[i]};
        int explicit = 0;
        for (int k = tool->writes.first; k < tool->writes.first + tool->writes.count; k++)
            explicit |= dag->needs[k].term == term && dag->needs[k].level_name != NULL;
        int level = dag_written_level(dag, tool, -1, term);
        if (!explicit || tool->parameters.count > 0 || level >= sure[i])
            continue;
        dag->use = node->use;
        if (!dag_warn(dag, WARNING_FALLING_PRECISION, node->tool_where,
                      "'%s' computes %s at %s, where every path knows it at %s", tool->name,
                      dag->terms[term].name, level_name(dag, term, level),
                      level_name(dag, term, sure[i])))
            continue;
        dag_search(search, search->oracle, 2, reaches, &wanted);
        const struct node *better = dag_search_turn(search, node);
        dag_note(dag, better->where, "%s", dag_search_path(search, node, 1, -1, NULL));
        dag_note(dag, dag_nowhere, "the better value stays: leave '%s' out", node->name);
    }
}

/* ---- */

static void check_term(struct search *search, int term, unsigned char *sure)
{
    struct dag *dag = search->dag;
    dag_sure_levels(dag, search->oracle, term, sure);
    for (int i = 0; i < dag->decision_count; i++) {
        struct span reads = dag->decisions[i].reads;
        for (int k = reads.first; k < reads.first + reads.count; k++)
            if (dag->needs[k].term == term)
                check_decision(search, i, &dag->needs[k], sure);
    }
    for (int i = 0; i < dag->tool_count; i++) {
        struct span reads = dag->tools[i].reads;
        for (int k = reads.first; k < reads.first + reads.count; k++)
            if (dag->needs[k].term == term && dag->needs[k].level_name != NULL)
                check_tool(search, i, &dag->needs[k], sure);
    }
    check_falling(search, term, sure);
}

void dag_analyse_terms(struct dag *dag)
{
    struct search search = dag_search_new(dag);
    unsigned char *sure = dag_alloc(&dag->arena, (size_t)dag->order_count);
    for (int i = 0; i < dag->oracle_count; i++) {
        search.oracle = &dag->oracles[i];
        for (int t = 0; t < dag->term_count; t++)
            check_term(&search, t, sure);
    }
}
