/* expand.c - branches to plain nodes.
 *
 * Every node that uses a branch gives way to a copy of the branch's nodes: parameters become the
 * expressions of the arguments, exits become the targets of the node's arcs, and whatever led to
 * the node leads to the copy's start. First all copies are made, then all arcs, since an arc may
 * lead on. Copies of copies recurse, at most BRANCH_DEPTH deep.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "base/internal.h"

/* One graph in place: an oracle, or one use of a branch. */
struct instance {
    const struct oracle_graph *graph;
    int parent, draft; /* the instance and the draft in it that use this one; -1 */
    int use;           /* in uses; -1: an oracle */
    int *node;         /* per draft of the graph: in nodes; -1 */
    int *child;        /* per draft of the graph: in instances; -1 */
    int *values;       /* per parameter of the branch: in expressions */
};

struct expansion {
    struct dag *dag;
    struct instance *instances;
    int instance_count;
    struct table names; /* of the oracle's nodes */
    int number;         /* makes names different */
};

/* ---- branches that use themselves, or each other too deep, or too often */

enum state { UNSEEN, OPEN, CLOSED };

struct search {
    unsigned char *state; /* of each branch */
    int *depth, *size;    /* of each closed branch: levels of branches in it, nodes in a copy */
    int *stack, *next;    /* the open branches, and the draft where each goes on */
    int count;
};

static void report_recursion(struct dag *dag, const struct search *search, const struct node *draft)
{
    int first = search->count - 1;
    const char *path = "";
    while (search->stack[first] != draft->branch)
        first--;
    for (int i = first; i < search->count; i++) {
        if (i - first == 6 && search->count - i > 6) {
            path = dag_format(&dag->arena, "%s... (%d more) ... -> ", path, search->count - i - 6);
            i = search->count - 6;
        }
        path = dag_format(&dag->arena, "%s%s -> ", path, dag->branches[search->stack[i]].name);
    }
    dag_error(dag, draft->tool_where, "a graph that uses itself: %s%s", path, draft->tool_name);
    dag_note(dag, dag_nowhere,
             "a graph is put in place of each node that uses it: this would never end");
    dag->recursive = 1;
}

/* What a use of `inner` adds to the graph that is measured in *depth and *size. */
static void measure(const struct search *search, const struct node *draft, int *depth, int *size)
{
    int more = 1;
    if (draft->branch >= 0 && search->state[draft->branch] == CLOSED) {
        int below = search->depth[draft->branch] + 1;
        *depth = below > *depth ? below : *depth;
        more = search->size[draft->branch];
    }
    *size = more >= NODES_MAX - *size ? NODES_MAX : *size + more; /* NODES_MAX: or more */
}

static void close_branch(struct dag *dag, struct search *search)
{
    int branch = search->stack[--search->count];
    struct span drafts = dag->branches[branch].drafts;
    for (int i = drafts.first; i < drafts.first + drafts.count; i++)
        measure(search, &dag->drafts[i], &search->depth[branch], &search->size[branch]);
    search->state[branch] = CLOSED;
    if (search->depth[branch] == BRANCH_DEPTH) {
        dag_error(dag, dag->branches[branch].where, "graphs are nested more than %d deep here",
                  BRANCH_DEPTH);
        dag->recursive = 1;
    }
}

static void search_branches(struct dag *dag, struct search *search, int root)
{
    if (search->state[root] != UNSEEN)
        return;
    search->state[root] = OPEN;
    search->next[search->count] = 0;
    search->stack[search->count++] = root;
    while (search->count > 0) {
        const struct oracle_graph *branch = &dag->branches[search->stack[search->count - 1]];
        int *next = &search->next[search->count - 1];
        if (*next == branch->drafts.count) {
            close_branch(dag, search);
            continue;
        }
        const struct node *draft = &dag->drafts[branch->drafts.first + (*next)++];
        if (draft->branch < 0)
            continue;
        if (search->state[draft->branch] == OPEN) {
            dag->use = branch->use;
            report_recursion(dag, search, draft);
            dag->use = -1;
        } else if (search->state[draft->branch] == UNSEEN) {
            search->state[draft->branch] = OPEN;
            search->next[search->count] = 0;
            search->stack[search->count++] = draft->branch;
        }
    }
}

static void check_branches(struct dag *dag)
{
    size_t count = (size_t)dag->branch_count;
    struct search search = {0};
    search.state = dag_alloc(&dag->arena, count);
    search.depth = dag_alloc(&dag->arena, count * sizeof(int));
    search.size = dag_alloc(&dag->arena, count * sizeof(int));
    search.stack = dag_alloc(&dag->arena, count * sizeof(int));
    search.next = dag_alloc(&dag->arena, count * sizeof(int));
    for (int i = 0; i < dag->branch_count; i++)
        search_branches(dag, &search, i);
    for (int i = 0, size = 0; i < dag->oracle_count && !dag->recursive; i++) {
        const struct oracle_graph *oracle = &dag->oracles[i];
        int depth = 0, before = size, uses = 0;
        for (int n = 0; n < oracle->drafts.count; n++) {
            const struct node *draft = &dag->drafts[oracle->drafts.first + n];
            measure(&search, draft, &depth, &size);
            uses |= draft->branch >= 0;
        }
        if (uses && size == NODES_MAX) {
            dag_error(dag, oracle->where,
                      "with its graphs in place, the oracle '%s' would have %d "
                      "nodes or more",
                      oracle->name, NODES_MAX - before);
            if (before > 0)
                dag_note(dag, dag_nowhere, "those before it have %d, and %d are the most", before,
                         NODES_MAX);
            dag->recursive = 1;
        } else if (!uses)
            size = before;
    }
}

/* ---- values */

/* The expression with the parameters of the instance's branch replaced. */
static int substitute(struct expansion *x, const struct instance *instance, int expression)
{
    struct dag *dag = x->dag;
    struct expression e = dag->expressions[expression];
    if (instance->use < 0)
        return expression;
    if (e.kind == EXPRESSION_PARAMETER)
        return instance->values[e.parameter - instance->graph->parameters.first];
    int left = e.left < 0 ? -1 : substitute(x, instance, e.left);
    int right = e.right < 0 ? -1 : substitute(x, instance, e.right);
    if (left == e.left && right == e.right)
        return expression;
    e.left = left;
    e.right = right;
    int index = dag_add_expression(dag, &e);
    if (dag->expressions[index].size <= EXPRESSION_SIZE
        && dag->expressions[index].depth <= EXPRESSION_DEPTH)
        return index;
    dag->use = instance->use;
    dag_error(dag, e.where,
              "with the arguments of this use in place, the expression has more than "
              "%d parts, or more than %d in each other",
              EXPRESSION_SIZE, EXPRESSION_DEPTH);
    dag->use = -1;
    return expression;
}

static struct span substitute_arguments(struct expansion *x, const struct instance *instance,
                                        struct span written)
{
    struct dag *dag = x->dag;
    if (instance->use < 0)
        return written;
    struct span span = {dag->argument_count, 0};
    for (int i = 0; i < written.count; i++) {
        struct argument argument = dag->arguments[written.first + i];
        if (argument.expression >= 0)
            argument.expression = substitute(x, instance, argument.expression);
        int index = ADD(dag, arguments, argument_count);
        dag->arguments[index] = argument;
        span.count++;
    }
    return span;
}

/* ---- copies */

static int is_free(const struct expansion *x, const char *name)
{
    return dag_find(&x->names, name) < 0 && dag_find(&x->dag->decision_names, name) < 0;
}

/* USE__NAME, shortened or numbered where that is too long or taken. */
static const char *copy_name(struct expansion *x, const char *use, const char *name)
{
    struct arena *arena = &x->dag->arena;
    const char *full = dag_format(arena, "%s__%s", use, name);
    while (strlen(full) > NAME_MAX_LENGTH || !is_free(x, full))
        full = dag_format(arena, "%.40s__%.10s_%d", use, name, ++x->number);
    return full;
}

static int new_instance(struct expansion *x, const struct oracle_graph *graph)
{
    struct arena *arena = &x->dag->arena;
    x->instances = dag_grow(arena, x->instances, x->instance_count, sizeof *x->instances);
    struct instance *instance = &x->instances[x->instance_count];
    size_t drafts = (size_t)graph->drafts.count;
    instance->graph = graph;
    instance->parent = instance->draft = instance->use = -1;
    instance->node = dag_alloc(arena, drafts * sizeof(int));
    instance->child = dag_alloc(arena, drafts * sizeof(int));
    instance->values = dag_alloc(arena, (size_t)graph->parameters.count * sizeof(int));
    return x->instance_count++;
}

static void copy_drafts(struct expansion *x, int instance, const char *prefix);

static int copy_branch(struct expansion *x, int parent, int draft, const char *name)
{
    struct dag *dag = x->dag;
    const struct node *node = &dag->drafts[draft];
    struct use use = {node->branch, name, node->tool_where, x->instances[parent].use};
    int index = new_instance(x, &dag->branches[node->branch]);
    dag->branches[node->branch].placed = 1;
    struct instance *instance = &x->instances[index];
    instance->parent = parent;
    instance->draft = draft;
    instance->use = ADD(dag, uses, use_count);
    dag->uses[instance->use] = use;
    for (int i = 0; i < node->arguments.count; i++) {
        int value = dag->arguments[node->arguments.first + i].expression;
        instance->values[i] = value < 0 ? -1 : substitute(x, &x->instances[parent], value);
    }
    copy_drafts(x, index, name);
    return index;
}

/* The nodes of one instance and of those inside it; prefix NULL: of the oracle itself. */
static void copy_drafts(struct expansion *x, int instance, const char *prefix)
{
    struct dag *dag = x->dag;
    struct span drafts = x->instances[instance].graph->drafts;
    for (int i = 0; i < drafts.count; i++) {
        const struct node *draft = &dag->drafts[drafts.first + i];
        const char *name = prefix == NULL ? draft->name : copy_name(x, prefix, draft->name);
        if (prefix != NULL)
            dag_put(&dag->arena, &x->names, name, drafts.first + i);
        x->instances[instance].node[i] = x->instances[instance].child[i] = -1;
        if (draft->branch >= 0 && !dag->recursive) {
            int child = copy_branch(x, instance, drafts.first + i, name);
            x->instances[instance].child[i] = child;
            continue;
        }
        int index = ADD(dag, nodes, node_count);
        struct node *node = &dag->nodes[index];
        *node = *draft;
        node->name = name;
        node->use = x->instances[instance].use;
        node->arguments = substitute_arguments(x, &x->instances[instance], draft->arguments);
        node->reads.first = dag->need_count;
        for (int a = node->arguments.first; a < node->arguments.first + node->arguments.count; a++)
            if (dag->arguments[a].expression >= 0)
                dag_add_reads(dag, dag->arguments[a].expression);
        node->reads.count = dag->need_count - node->reads.first;
        x->instances[instance].node[i] = index;
    }
}

/* ---- arcs */

/* Where a target of a draft in this instance leads: out of branches by their exits, into others
 * by their starts, until it is a node or a decision. */
static struct target follow(const struct expansion *x, const struct instance *instance,
                            struct target target)
{
    const struct dag *dag = x->dag;
    struct where where = target.where;
    for (;;) {
        if (target.kind == TARGET_EXIT) {
            const struct node *user = &dag->drafts[instance->draft];
            if (target.index >= user->arcs.count)
                return (struct target){TARGET_NONE, -1, target.name, where};
            target = dag->arcs[user->arcs.first + target.index].target;
            instance = &x->instances[instance->parent];
        } else if (target.kind == TARGET_NODE) {
            int place = target.index - instance->graph->drafts.first;
            if (instance->child[place] < 0) {
                target.index = instance->node[place];
                target.name = dag->nodes[target.index].name;
                break;
            }
            instance = &x->instances[instance->child[place]];
            target = instance->graph->start;
        } else
            break;
    }
    target.where = where;
    return target;
}

static void make_arcs(struct expansion *x)
{
    struct dag *dag = x->dag;
    for (int i = 0; i < x->instance_count; i++) {
        const struct instance *instance = &x->instances[i];
        for (int d = 0; d < instance->graph->drafts.count; d++) {
            if (instance->node[d] < 0)
                continue;
            struct node *node = &dag->nodes[instance->node[d]];
            struct span arcs = node->arcs;
            node->arcs.first = dag->arc_count;
            for (int a = 0; a < arcs.count; a++) {
                struct arc arc = dag->arcs[arcs.first + a];
                arc.target = follow(x, instance, arc.target);
                int index = ADD(dag, arcs, arc_count);
                dag->arcs[index] = arc;
            }
        }
    }
}

void dag_expand(struct dag *dag)
{
    check_branches(dag);
    for (int i = 0; i < dag->oracle_count; i++) {
        struct oracle_graph *oracle = &dag->oracles[i];
        struct expansion x = {dag, NULL, 0, {NULL, NULL, 0, 0}, 0};
        for (int n = oracle->drafts.first; n < oracle->drafts.first + oracle->drafts.count; n++)
            dag_put(&dag->arena, &x.names, dag->drafts[n].name, n);
        int root = new_instance(&x, oracle);
        oracle->nodes.first = dag->node_count;
        copy_drafts(&x, root, NULL);
        oracle->nodes.count = dag->node_count - oracle->nodes.first;
        make_arcs(&x);
        oracle->start = follow(&x, &x.instances[root], oracle->start);
    }
}
