/* check_graph.c - no cycles, and the nodes in topological order.
 *
 * One depth-first search per oracle, without recursion, so that a chain of any length is fine.
 * An arc to a node that is still open closes a cycle. The order is the reverse of leaving the
 * nodes that the start reaches; answers are searched last to first, so that a node is followed
 * by where its first answer leads, when nothing forbids it. It depends on the graph alone, not
 * on where in the source a node stands.
 * SPDX-License-Identifier: MIT */
#include "internal.h"

enum state { UNSEEN, OPEN, CLOSED };

struct search {
    unsigned char *state; /* of every node of the dag */
    int *stack;           /* the open nodes, from the root */
    int *next;            /* per open node: answers not yet followed */
    int *closed;          /* nodes in the order of closing */
    int depth, closed_count;
};

enum { PATH_SHOWN = 12 };

/* Was the cycle found before, in another copy of the same branch? */
static int is_known(const struct dag *dag, const struct arc *closing)
{
    const struct where *where = &closing->target.where;
    for (int i = 0; i < dag->diagnostic_count; i++) {
        const struct diagnostic *other = &dag->diagnostics[i];
        if (other->use >= 0 && other->severity == SEVERITY_ERROR &&
            other->where.source == where->source && other->where.offset == where->offset)
            return 1;
    }
    return 0;
}

/* "a -> b -> a", its middle left out when it is long. */
static void report_cycle(struct dag *dag, const struct search *search, const struct arc *closing)
{
    int first = search->depth - 1;
    if (is_known(dag, closing))
        return;
    dag->use = dag->nodes[search->stack[search->depth - 1]].use;
    if (dag_errors_full(dag)) {
        dag_error(dag, closing->target.where, "a cycle");
        dag->use = -1;
        return;
    }
    while (search->stack[first] != closing->target.index)
        first--;
    int length = search->depth - first;
    const char *path = "";
    for (int i = 0; i < length; i++) {
        if (length > PATH_SHOWN && i == PATH_SHOWN / 2) {
            int left = length - PATH_SHOWN;
            path = dag_format(&dag->arena, "%s... (%d more) ... -> ", path, left);
            i += left;
        }
        path = dag_format(&dag->arena, "%s%s -> ", path, dag->nodes[search->stack[first + i]].name);
    }
    dag_error(dag, closing->target.where, "a cycle: %s%s", path, closing->target.name);
    dag_note(dag, dag_nowhere, "a discussion would never end: every arc must lead nearer to a decision");
    dag->use = -1;
}

/* Has an answer of the node that was followed before `arc` led to the same place? Answers are
 * followed from the last to the first. */
static int led_there(const struct dag *dag, const struct node *node, const struct arc *arc)
{
    const struct arc *end = &dag->arcs[node->arcs.first] + node->arcs.count;
    for (const struct arc *other = arc + 1; other < end; other++)
        if (other->target.kind == TARGET_NODE && other->target.index == arc->target.index)
            return 1;
    return 0;
}

static void open_node(const struct dag *dag, struct search *search, int node)
{
    search->state[node] = OPEN;
    search->next[search->depth] = dag->nodes[node].arcs.count;
    search->stack[search->depth++] = node;
}

static void search_from(struct dag *dag, struct search *search, int root)
{
    if (search->state[root] != UNSEEN)
        return;
    open_node(dag, search, root);
    while (search->depth > 0) {
        int node = search->stack[search->depth - 1];
        int *next = &search->next[search->depth - 1];
        if (*next == 0) {
            search->state[node] = CLOSED;
            search->closed[search->closed_count++] = node;
            search->depth--;
            continue;
        }
        const struct arc *arc = &dag->arcs[dag->nodes[node].arcs.first + --*next];
        if (arc->target.kind != TARGET_NODE)
            continue;
        if (search->state[arc->target.index] == UNSEEN)
            open_node(dag, search, arc->target.index);
        else if (search->state[arc->target.index] == OPEN &&
                 !led_there(dag, &dag->nodes[node], arc))
            report_cycle(dag, search, arc);
    }
}

static void check_oracle(struct dag *dag, struct search *search, struct oracle_graph *oracle)
{
    search->closed_count = 0;
    oracle->order.first = dag->order_count;
    if (oracle->start.kind == TARGET_NODE)
        search_from(dag, search, oracle->start.index);
    for (int i = search->closed_count - 1; i >= 0; i--) {
        int place = ADD(dag, order, order_count);
        dag->order[place] = search->closed[i];
        dag->nodes[search->closed[i]].order = oracle->order.count++;
    }
    /* A cycle is a mistake even where nothing leads to it. */
    for (int i = oracle->nodes.first; i < oracle->nodes.first + oracle->nodes.count; i++)
        search_from(dag, search, i);
}

void dag_check_graph(struct dag *dag)
{
    size_t count = (size_t)dag->node_count;
    struct search search = {0};
    search.state = dag_alloc(&dag->arena, count);
    search.stack = dag_alloc(&dag->arena, count * sizeof(int));
    search.next = dag_alloc(&dag->arena, count * sizeof(int));
    search.closed = dag_alloc(&dag->arena, count * sizeof(int));
    for (int i = 0; i < dag->oracle_count; i++)
        check_oracle(dag, &search, &dag->oracles[i]);
}
