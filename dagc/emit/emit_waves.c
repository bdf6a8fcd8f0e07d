/* emit_waves.c - what --dump=waves lists: of each node of a graph that runs in waves, whether its
 * tool has a form over a list of pairs, and how many pairs of a full block to expect there.
 *
 * Expected means: if of each node all answers were equally likely. What they are in truth, counts
 * tell: --instrument, or a program's own statistics, give a node's calls per discussion, and 256
 * times that is its share of a block.
 * SPDX-License-Identifier: MIT */
#include "emit/emit.h"

enum { PAIRS = 256 }; /* as in emit_wave.c */

/* By place in the order: the share of all discussions that comes by. */
static double *find_shares(struct dag *dag, const struct oracle_graph *oracle)
{
    double *shares = dag_alloc(&dag->arena, (size_t)oracle->order.count * sizeof *shares);
    shares[0] = 1;
    for (int i = 0; i < oracle->order.count; i++) {
        const struct node *node = dag_node_at(dag, oracle, i);
        for (int a = node->arcs.first; a < node->arcs.first + node->arcs.count; a++) {
            const struct target *target = &dag->arcs[a].target;
            if (target->kind == TARGET_NODE)
                shares[dag->nodes[target->index].order] += shares[i] / node->arcs.count;
        }
    }
    return shares;
}

void dag_emit_waves(struct dag *dag, struct text *out)
{
    for (int k = 0; k < dag->oracle_count; k++) {
        const struct oracle_graph *oracle = &dag->oracles[k];
        const double *shares = find_shares(dag, oracle);
        int own = 0;
        double asked = 0, in_lists = 0;
        dag_print(out, "%soracle %s\n  %-32s %-22s %-12s %s\n", k > 0 ? "\n" : "", oracle->name,
                  "node", "tool", "asked", "pairs of 256");
        for (int i = 0; i < oracle->order.count; i++) {
            const struct node *node = dag_node_at(dag, oracle, i);
            const struct tool *tool = &dag->tools[node->tool];
            const int together = tool->wave != NULL;
            dag_print(out, "  %-32s %-22s %-12s %.1f\n", node->name, tool->name,
                      together ? "as a list" : "one by one", PAIRS * shares[i]);
            own += together;
            asked += shares[i];
            in_lists += together ? shares[i] : 0;
        }
        dag_print(out, "  %d of %d nodes are asked as a list: %.2f of %.2f questions a pair\n", own,
                  oracle->order.count, in_lists, asked);
    }
}
