/* check_graph.c - no cycles, and the nodes in topological order.
 *
 * One depth-first search per oracle, without recursion, so that a chain of any length is fine.
 * An arc to a node that is still open closes a cycle. The order is the reverse of leaving the
 * nodes that the start reaches; answers are searched last to first, so that a node is followed
 * by where its first answer leads, when nothing forbids it. It depends on the graph alone, not
 * on where in the source a node stands.
 *
 * A branch is searched where it is used, in each copy. One that no oracle holds is searched as it
 * is written; a node in it that uses another branch has then an arc for each exit which that one
 * can come to.
 * SPDX-License-Identifier: MIT */
#include "base/internal.h"

enum state { UNSEEN, OPEN, CLOSED };

struct search {
    const struct node *nodes; /* the dag's nodes, or its drafts */
    /* by answer: is it an exit that its branch comes to? NULL: no branches */
    const unsigned char *exits;
    unsigned char *state; /* of every one of the nodes */
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
        if (other->use >= 0 && other->severity == SEVERITY_ERROR
            && other->where.source == where->source && other->where.offset == where->offset)
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
    dag->use = search->exits == NULL ? search->nodes[search->stack[search->depth - 1]].use : -1;
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
        path =
            dag_format(&dag->arena, "%s%s -> ", path, search->nodes[search->stack[first + i]].name);
    }
    dag_error(dag, closing->target.where, "a cycle: %s%s", path, closing->target.name);
    dag_note(dag, dag_nowhere,
             "a discussion would never end: every arc must lead nearer to a decision");
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

/* Does the arc lead anywhere? Not from an exit that is never come to. */
static int leads_on(const struct dag *dag, const struct search *search, const struct node *node,
                    const struct arc *arc)
{
    if (arc->target.kind != TARGET_NODE)
        return 0;
    return search->exits == NULL || node->branch < 0
           || search->exits[dag->branches[node->branch].exits.first
                            + (int)(arc - &dag->arcs[node->arcs.first])];
}

static void open_node(struct search *search, int node)
{
    search->state[node] = OPEN;
    search->next[search->depth] = search->nodes[node].arcs.count;
    search->stack[search->depth++] = node;
}

static void search_from(struct dag *dag, struct search *search, int root)
{
    if (search->state[root] != UNSEEN)
        return;
    open_node(search, root);
    while (search->depth > 0) {
        int node = search->stack[search->depth - 1];
        int *next = &search->next[search->depth - 1];
        if (*next == 0) {
            search->state[node] = CLOSED;
            search->closed[search->closed_count++] = node;
            search->depth--;
            continue;
        }
        const struct arc *arc = &dag->arcs[search->nodes[node].arcs.first + --*next];
        if (!leads_on(dag, search, &search->nodes[node], arc))
            continue;
        if (search->state[arc->target.index] == UNSEEN)
            open_node(search, arc->target.index);
        else if (search->state[arc->target.index] == OPEN
                 && !led_there(dag, &search->nodes[node], arc))
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

static struct search new_search(struct dag *dag, const struct node *nodes, int count)
{
    struct search search = {0};
    search.nodes = nodes;
    search.state = dag_alloc(&dag->arena, (size_t)count);
    search.stack = dag_alloc(&dag->arena, (size_t)count * sizeof(int));
    search.next = dag_alloc(&dag->arena, (size_t)count * sizeof(int));
    search.closed = dag_alloc(&dag->arena, (size_t)count * sizeof(int));
    return search;
}

/* ---- branches that no oracle holds */

/* Marks the exits that a path from the branch's start comes to; those within it first. (Recursion:
 * branches are nested at most BRANCH_DEPTH deep, and none uses itself.) */
static void find_exits(struct dag *dag, int index, unsigned char *done, unsigned char *exits,
                       unsigned char *seen, int *stack)
{
    const struct oracle_graph *branch = &dag->branches[index];
    struct span drafts = branch->drafts;
    int depth = 0;
    if (done[index])
        return;
    done[index] = 1;
    for (int i = drafts.first; i < drafts.first + drafts.count; i++)
        if (dag->drafts[i].branch >= 0)
            find_exits(dag, dag->drafts[i].branch, done, exits, seen, stack);
    if (branch->start.kind == TARGET_NODE) {
        seen[branch->start.index] = 1;
        stack[depth++] = branch->start.index;
    }
    while (depth > 0) {
        const struct node *draft = &dag->drafts[stack[--depth]];
        for (int a = 0; a < draft->arcs.count; a++) {
            const struct target *target = &dag->arcs[draft->arcs.first + a].target;
            if (draft->branch >= 0 && !exits[dag->branches[draft->branch].exits.first + a])
                continue;
            if (target->kind == TARGET_EXIT)
                exits[branch->exits.first + target->index] = 1;
            else if (target->kind == TARGET_NODE && !seen[target->index]) {
                seen[target->index] = 1;
                stack[depth++] = target->index;
            }
        }
    }
}

static void check_branches(struct dag *dag)
{
    struct search search = new_search(dag, dag->drafts, dag->draft_count);
    unsigned char *exits = dag_alloc(&dag->arena, (size_t)dag->answer_count);
    unsigned char *done = dag_alloc(&dag->arena, (size_t)dag->branch_count);
    unsigned char *seen = dag_alloc(&dag->arena, (size_t)dag->draft_count);
    for (int i = 0; i < dag->branch_count; i++)
        find_exits(dag, i, done, exits, seen, search.stack);
    search.exits = exits;
    for (int i = 0; i < dag->branch_count; i++) {
        struct span drafts = dag->branches[i].drafts;
        search.closed_count = 0;
        for (int n = drafts.first; n < drafts.first + drafts.count && !dag->branches[i].placed; n++)
            search_from(dag, &search, n);
    }
}

/* ---- */

void dag_check_graph(struct dag *dag)
{
    struct search search = new_search(dag, dag->nodes, dag->node_count);
    for (int i = 0; i < dag->oracle_count; i++)
        check_oracle(dag, &search, &dag->oracles[i]);
    if (!dag->recursive)
        check_branches(dag);
}
