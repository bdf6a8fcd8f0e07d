/* emit_waves.c - what --dump=waves lists: of each node of a graph that runs in waves, whether its
 * tool has a form over a list of pairs, and how many pairs of a full block to expect there.
 *
 * Expected means: if of each node all answers were equally likely. What they are in truth a profile
 * tells (--profile): how many of 256 came by, how long the lists were where any did, which share of
 * the lanes of a vector they fill, and what a call took. Then which questions may change places
 * (order.c) is told, of the graph that was measured.
 * SPDX-License-Identifier: MIT */
#include "analyse/profile.h"
#include "emit/emit.h"

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

/* "61.4 %": of the vectors that the lists fill, the lanes that hold a pair. */
static void print_filled(struct text *out, const struct measured *m)
{
    for (int k = 0; k < PROFILE_WIDTHS; k++)
        dag_print(out, " %5.1f %%",
                  100 * m->calls / (m->vectors[k] > 0 ? dag_profile_widths[k] * m->vectors[k] : 1));
}

static void print_measured(struct text *out, const struct measured *m, double discussions)
{
    dag_print(out, " %8.1f", discussions > 0 ? DAG_WAVE_PAIRS * m->calls / discussions : 0);
    if (m->lists > 0) {
        dag_print(out, " %8.1f", m->calls / m->lists);
        print_filled(out, m);
    } else
        dag_print(out, " %8s %7s %7s %7s", "-", "-", "-", "-");
    if (m->seconds > 0)
        dag_print(out, " %8.0f", 1e9 * m->seconds);
    else
        dag_print(out, " %8s", "-");
}

static void print_head(struct text *out, const struct oracle_graph *oracle,
                       const struct profile *profile)
{
    dag_print(out, "oracle %s\n  %-32s %-22s %-12s %s", oracle->name, "node", "tool", "asked",
              "pairs of 256");
    if (profile != NULL)
        dag_print(out, " %8s %8s %7s %7s %7s %8s", "measured", "per list", "of 4", "of 8", "of 16",
                  "ns each");
    dag_print(out, "\n");
}

static void print_oracle(struct dag *dag, struct text *out, const struct oracle_graph *oracle,
                         const struct profile *profile)
{
    const double *shares = find_shares(dag, oracle);
    int own = 0;
    double asked = 0, in_lists = 0;
    print_head(out, oracle, profile);
    for (int i = 0; i < oracle->order.count; i++) {
        const int index = dag->order[oracle->order.first + i];
        const struct node *node = &dag->nodes[index];
        const struct tool *tool = &dag->tools[node->tool];
        const int together = tool->wave != NULL;
        double share = shares[i];
        dag_print(out, "  %-32s %-22s %-12s %.*f", node->name, tool->name,
                  together ? "as a list" : "one by one", 1, DAG_WAVE_PAIRS * share);
        if (profile != NULL) {
            const double all = profile->nodes[dag->order[oracle->order.first]].calls;
            print_measured(out, &profile->nodes[index], all);
            share = all > 0 ? profile->nodes[index].calls / all : 0;
        }
        dag_print(out, "\n");
        own += together;
        asked += share;
        in_lists += together ? share : 0;
    }
    dag_print(out, "  %d of %d nodes are asked as a list: %.2f of %.2f questions a pair\n", own,
              oracle->order.count, in_lists, asked);
    for (int i = 0; profile != NULL && i < profile->told_count; i++)
        dag_print(out, "  %s\n", profile->told[i]);
}

void dag_emit_waves(struct dag *dag, struct text *out)
{
    for (int k = 0; k < dag->oracle_count; k++) {
        const struct profile *profile =
            dag->profile != NULL && dag->profile->oracle == k ? dag->profile : NULL;
        dag_print(out, "%s", k > 0 ? "\n" : "");
        print_oracle(dag, out, profile != NULL ? &profile->before : &dag->oracles[k], profile);
    }
}
