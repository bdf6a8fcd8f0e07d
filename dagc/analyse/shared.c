/* shared.c - which graphs an oracle uses more than once in one and the same way.
 *
 * Expanding has made a copy of a branch's nodes for each use. They can go back into one function if
 * the copies agree node by node: the same tools, arcs inside that lead to the same place, one way
 * in. Arguments may differ if it is all the same when they are computed: numbers, parameters,
 * facts, but no terms. Targets outside may differ: arcs that lead to the same place in every use
 * are one exit. A branch whose nodes are a part of a larger piece already is left alone.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "analyse/shared.h"

/* Is the node a part of this use, or of one inside it? */
static int is_in(const struct dag *dag, const struct node *node, int use)
{
    for (int u = node->use; u >= 0; u = dag->uses[u].outer)
        if (u == use)
            return 1;
    return 0;
}

/* The nodes of a use, in the oracle's order; NULL to count them. */
static int collect(const struct dag *dag, const struct oracle_graph *oracle, int use, int *nodes)
{
    int count = 0;
    for (int i = 0; i < oracle->order.count; i++)
        if (is_in(dag, dag_node_at(dag, oracle, i), use)) {
            if (nodes != NULL)
                nodes[count] = dag->order[oracle->order.first + i];
            count++;
        }
    return count;
}

static int same_place(struct where a, struct where b)
{
    return a.source == b.source && a.offset == b.offset;
}

/* Are they copies of one node, used in the same places inside of their uses a and b? */
static int same_origin(const struct dag *dag, const struct node *x, int a, const struct node *y,
                       int b)
{
    int u = x->use, v = y->use;
    if (!same_place(x->where, y->where))
        return 0;
    for (; u != a && v != b; u = dag->uses[u].outer, v = dag->uses[v].outer)
        if (!same_place(dag->uses[u].where, dag->uses[v].where))
            return 0;
    return u == a && v == b;
}

/* The other uses' nodes in the first one's order. 0: they are not the same. */
static int align(const struct dag *dag, struct shared *s, const int *uses)
{
    for (int u = 1; u < s->uses; u++) {
        int *nodes = s->node + u * s->nodes;
        for (int i = 0; i < s->nodes; i++) {
            int k = i;
            while (k < s->nodes
                   && !same_origin(dag, &dag->nodes[s->node[i]], uses[0], &dag->nodes[nodes[k]],
                                   uses[u]))
                k++;
            if (k == s->nodes)
                return 0;
            int found = nodes[k];
            nodes[k] = nodes[i];
            nodes[i] = found;
        }
    }
    return 1;
}

/* Which node of the use the arc leads to; -1: it leaves. */
static int place_in(const struct shared *s, int use, const struct target *target)
{
    for (int i = 0; target->kind == TARGET_NODE && i < s->nodes; i++)
        if (s->node[use * s->nodes + i] == target->index)
            return i;
    return -1;
}

/* Does anybody outside lead to a node but the first? */
static int has_side_entry(const struct dag *dag, const struct oracle_graph *oracle,
                          const struct shared *s, int use, int which)
{
    for (int i = 0; i < oracle->order.count; i++) {
        const struct node *node = dag_node_at(dag, oracle, i);
        for (int a = 0; !is_in(dag, node, use) && a < node->arcs.count; a++)
            if (place_in(s, which, &dag->arcs[node->arcs.first + a].target) > 0)
                return 1;
    }
    return 0;
}

static int number_exits(struct dag *dag, struct shared *s)
{
    int answers = 0;
    s->first_answer = dag_alloc(&dag->arena, (size_t)s->nodes * sizeof(int));
    for (int i = 0; i < s->nodes; i++) {
        s->first_answer[i] = answers;
        answers += dag->nodes[s->node[i]].arcs.count;
    }
    s->exit_of = dag_alloc(&dag->arena, (size_t)answers * sizeof(int));
    s->exit = dag_alloc(&dag->arena, (size_t)answers * (size_t)s->uses * sizeof(int));
    int *exits = dag_alloc(&dag->arena, (size_t)answers * (size_t)s->uses * sizeof(int));
    for (int i = 0; i < s->nodes; i++)
        for (int a = 0; a < dag->nodes[s->node[i]].arcs.count; a++) {
            int inside = -1, exit = 0;
            for (int u = 0; u < s->uses; u++) {
                int arc = dag->nodes[s->node[u * s->nodes + i]].arcs.first + a;
                int to = place_in(s, u, &dag->arcs[arc].target);
                if (u > 0 && to != inside)
                    return 0;
                inside = to;
                exits[s->exits * s->uses + u] = arc;
            }
            s->exit_of[s->first_answer[i] + a] = -1;
            if (inside >= 0)
                continue;
            for (int same = 0; exit < s->exits; exit++) {
                same = 1;
                for (int u = 0; u < s->uses; u++)
                    same &= dag_same_target(&dag->arcs[exits[exit * s->uses + u]].target,
                                            &dag->arcs[exits[s->exits * s->uses + u]].target);
                if (same)
                    break;
            }
            s->exit_of[s->first_answer[i] + a] = exit;
            s->exits += exit == s->exits;
        }
    for (int e = 0; e < s->exits; e++)
        for (int u = 0; u < s->uses; u++)
            s->exit[u * s->exits + e] = exits[e * s->uses + u];
    return 1;
}

/* Is it the same whenever it is computed in one discussion? */
static int is_steady(const struct dag *dag, int expression)
{
    const struct expression *e = &dag->expressions[expression];
    return e->kind != EXPRESSION_TERM && e->kind != EXPRESSION_EXTERN
           && (e->left < 0 || is_steady(dag, e->left))
           && (e->right < 0 || is_steady(dag, e->right));
}

static void add_doubt(struct dag *dag, struct shared *s, int node, int argument)
{
    for (int u = 0; u < s->uses; u++) {
        int at = s->doubts * s->uses + u, of = s->node[u * s->nodes + node];
        s->doubt = dag_grow(&dag->arena, s->doubt, at, sizeof *s->doubt);
        s->doubt_node = dag_grow(&dag->arena, s->doubt_node, at, sizeof *s->doubt_node);
        s->doubt[at] = dag->nodes[of].arguments.first + argument;
        s->doubt_node[at] = of;
    }
    s->doubts++;
}

static int find_arguments(struct dag *dag, struct shared *s)
{
    for (int i = 0; i < s->nodes; i++) {
        const struct node *first = &dag->nodes[s->node[i]];
        for (int k = 0; k < first->arguments.count; k++) {
            int value = dag->arguments[first->arguments.first + k].expression, differs = 0;
            const char *text = dag_value_text(dag, value);
            int steady = is_steady(dag, value);
            int doubtful = dag_is_doubtful(dag, &dag->arguments[first->arguments.first + k]);
            for (int u = 1; u < s->uses; u++) {
                const struct node *node = &dag->nodes[s->node[u * s->nodes + i]];
                int other = dag->arguments[node->arguments.first + k].expression;
                differs |= strcmp(text, dag_value_text(dag, other)) != 0;
                steady &= is_steady(dag, other);
                doubtful |= dag_is_doubtful(dag, &dag->arguments[node->arguments.first + k]);
            }
            if (doubtful)
                add_doubt(dag, s, i, k);
            if (!differs)
                continue;
            if (!steady)
                return 0;
            for (int u = 0; u < s->uses; u++) {
                s->argument = dag_grow(&dag->arena, s->argument, s->different * s->uses + u,
                                       sizeof *s->argument);
                s->argument[s->different * s->uses + u] =
                    dag->nodes[s->node[u * s->nodes + i]].arguments.first + k;
            }
            s->different++;
        }
    }
    return 1;
}

/* 0: the uses of the branch are not alike. */
static int make_shared(struct dag *dag, const struct oracle_graph *oracle, int branch,
                       const unsigned char *taken, struct shared *s)
{
    int *uses = dag_alloc(&dag->arena, (size_t)dag->use_count * sizeof *uses);
    *s = (struct shared){.branch = branch};
    for (int u = 0; u < dag->use_count; u++) {
        int count = dag->uses[u].branch == branch ? collect(dag, oracle, u, NULL) : 0;
        if (count == 0)
            continue;
        if (s->uses > 0 && count != s->nodes)
            return 0;
        s->nodes = count;
        uses[s->uses++] = u;
    }
    if (s->uses < 2)
        return 0;
    s->node = dag_alloc(&dag->arena, (size_t)s->uses * (size_t)s->nodes * sizeof *s->node);
    for (int u = 0; u < s->uses; u++)
        (void)collect(dag, oracle, uses[u], s->node + u * s->nodes);
    if (!align(dag, s, uses))
        return 0;
    for (int u = 0; u < s->uses; u++)
        for (int i = 0; i < s->nodes; i++) {
            const struct node *node = &dag->nodes[s->node[u * s->nodes + i]];
            const struct node *first = &dag->nodes[s->node[i]];
            if (taken[node->order] || node->tool != first->tool
                || node->arcs.count != first->arcs.count)
                return 0;
        }
    for (int u = 0; u < s->uses; u++)
        if (has_side_entry(dag, oracle, s, uses[u], u))
            return 0;
    return number_exits(dag, s) && find_arguments(dag, s);
}

int dag_find_shared(struct dag *dag, const struct oracle_graph *oracle, struct shared **shared)
{
    int count = 0;
    unsigned char *taken = dag_alloc(&dag->arena, (size_t)oracle->order.count);
    *shared = dag_alloc(&dag->arena, (size_t)dag->branch_count * sizeof **shared);
    /* As a rule a branch stands behind those that it uses: the larger pieces come first. */
    for (int b = dag->branch_count - 1; b >= 0; b--) {
        struct shared *s = &(*shared)[count];
        if (!make_shared(dag, oracle, b, taken, s))
            continue;
        for (int i = 0; i < s->uses * s->nodes; i++)
            taken[dag->nodes[s->node[i]].order] = 1;
        count++;
    }
    return count;
}

int dag_shared_argument(const struct shared *shared, int argument)
{
    for (int i = 0; i < shared->different; i++)
        if (shared->argument[i * shared->uses] == argument)
            return i;
    return -1;
}

int dag_shared_doubt(const struct shared *shared, int argument)
{
    for (int i = 0; i < shared->doubts; i++)
        if (shared->doubt[i * shared->uses] == argument)
            return i;
    return -1;
}
