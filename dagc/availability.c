/* availability.c - which terms the data manager surely holds, or surely lacks, at each node.
 *
 * A forward analysis over the topological order; where paths meet, `low` is the lesser of what
 * they bring (must) and `high` the greater (may). A tool raises low to the level it declares to
 * write. It may fill any term that it declares to read or write, at any level, so high becomes
 * the best level there. Terms that a decision reads may come with the discussion at any level;
 * all others start absent.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "emit.h"

int dag_is_kept(const struct dag *dag, int term)
{
    for (int i = 0; i < dag->decision_count; i++)
        for (int k = 0; k < dag->decisions[i].reads.count; k++)
            if (dag->needs[dag->decisions[i].reads.first + k].term == term)
                return 1;
    return 0;
}

static unsigned char best_level(const struct dag *dag, int term)
{
    int levels = dag->terms[term].levels.count;
    return (unsigned char)(levels == 0 ? 1 : levels > 255 ? 255 : levels);
}

static void after_tool(const struct dag *dag, const struct tool *tool, unsigned char *low,
                       unsigned char *high)
{
    for (int i = 0; i < tool->reads.count; i++) {
        int term = dag->needs[tool->reads.first + i].term;
        high[term] = best_level(dag, term);
    }
    for (int i = 0; i < tool->writes.count; i++) {
        const struct need *need = &dag->needs[tool->writes.first + i];
        high[need->term] = best_level(dag, need->term);
        if (need->level <= 255 && low[need->term] < need->level)
            low[need->term] = (unsigned char)need->level;
    }
}

struct available dag_availability(struct dag *dag, const struct oracle_graph *oracle)
{
    size_t terms = (size_t)dag->term_count, nodes = (size_t)oracle->order.count;
    struct available known = {dag_alloc(&dag->arena, nodes * terms + 1),
                              dag_alloc(&dag->arena, nodes * terms + 1)};
    unsigned char *low = dag_alloc(&dag->arena, terms + 1), *high = dag_alloc(&dag->arena, terms + 1);
    memset(known.low + terms, 255, (nodes - 1) * terms); /* no path has come yet */
    for (int t = 0; t < dag->term_count; t++)
        known.high[t] = dag_is_kept(dag, t) ? best_level(dag, t) : 0;
    for (size_t n = 0; n < nodes; n++) {
        const struct node *node = &dag->nodes[dag->order[oracle->order.first + (int)n]];
        if (terms > 0) {
            memcpy(low, known.low + n * terms, terms);
            memcpy(high, known.high + n * terms, terms);
        }
        after_tool(dag, &dag->tools[node->tool], low, high);
        for (int a = 0; a < node->arcs.count; a++) {
            const struct target *target = &dag->arcs[node->arcs.first + a].target;
            if (target->kind != TARGET_NODE)
                continue;
            size_t to = (size_t)dag->nodes[target->index].order * terms;
            for (size_t t = 0; t < terms; t++) {
                known.low[to + t] = known.low[to + t] < low[t] ? known.low[to + t] : low[t];
                known.high[to + t] = known.high[to + t] > high[t] ? known.high[to + t] : high[t];
            }
        }
    }
    return known;
}
