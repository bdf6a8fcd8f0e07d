/* order.c - see order.h.
 *
 * Two questions stand in a row where one leads to the other and both send some answers to the same
 * place: "a passes to b, b passes on; who fails either goes to T". The one that costs less for each
 * pair that it sends to T should come first, if it may: if what a answers depends on nothing that
 * b does, and the other way round; if nothing that is kept depends on which of the two was asked;
 * and if b has an answer where a would have failed, which only the catalog can say (`anywhere`).
 * Then a, asked later of fewer pairs, and b, asked sooner of more, answer as they would have, and
 * each pair goes to T or passes as before.
 *
 * Where T leads to a subdivision, and a's answers may be what allows that, a stays first: no path
 * would hold such an answer else, and the graph, written out, would be refused.
 *
 * A term of several levels speaks against it even if both only read it: whoever reads it may leave
 * it finer than it was, and a reader that takes what it finds sees that.
 *
 * What is measured of b is measured of pairs that a let pass. That the share which b sends to T is
 * the same among all pairs is assumed, and only speed depends on it.
 *
 * Invariant: each exchange lowers a sum over the places of the graph (the sequence is sorted by
 * cost over share), so that it ends. [Hellerstein and Stonebraker 1993, predicates by rank]
 * SPDX-License-Identifier: MIT */
#include "analyse/order.h"

#include <string.h>

#include "analyse/analyse.h"

struct ordering {
    struct dag *dag;
    struct profile *profile;
    struct oracle_graph *oracle; /* the copy */
};

/* The two, and where their answers go. */
struct row {
    int a, b; /* in nodes */
    struct target fail, pass;
};

static int leads_to(const struct target *target, int node)
{
    return target->kind == TARGET_NODE && target->index == node;
}

static struct arc *arc_of(const struct ordering *o, int node, int answer)
{
    return &o->dag->arcs[o->dag->nodes[node].arcs.first + answer];
}

/* ---- the copy */

static struct target copy_target(const struct dag *dag, const struct target *target, const int *to)
{
    struct target copy = *target;
    if (copy.kind == TARGET_NODE) {
        copy.index = to[target->index];
        copy.name = dag->nodes[copy.index].name;
    }
    return copy;
}

/* The oracle's reached nodes and their arcs, anew. */
static void copy_graph(struct dag *dag, const struct oracle_graph *oracle,
                       struct oracle_graph *copy, struct profile *profile)
{
    const int count = oracle->order.count, first = dag->node_count;
    int *to = dag_alloc(&dag->arena, (size_t)(first + count) * sizeof *to);
    struct measured *measured = dag_alloc(&dag->arena, (size_t)(first + count) * sizeof *measured);
    *copy = *oracle;
    copy->order = (struct span){dag->order_count, count};
    copy->nodes = (struct span){first, count};
    memcpy(measured, profile->nodes, (size_t)first * sizeof *measured);
    profile->nodes = measured;
    for (int i = 0; i < count; i++) {
        const int from = dag->order[oracle->order.first + i], node = ADD(dag, nodes, node_count);
        dag->nodes[node] = dag->nodes[from];
        measured[node] = measured[from];
        to[from] = node;
        const int at = ADD(dag, order, order_count);
        dag->order[at] = node;
    }
    for (int i = first; i < first + count; i++) {
        const struct span arcs = dag->nodes[i].arcs;
        dag->nodes[i].arcs.first = dag->arc_count;
        for (int k = 0; k < arcs.count; k++) {
            const int arc = ADD(dag, arcs, arc_count);
            dag->arcs[arc] = dag->arcs[arcs.first + k];
            dag->arcs[arc].target = copy_target(dag, &dag->arcs[arc].target, to);
        }
    }
    copy->start = copy_target(dag, &oracle->start, to);
}

/* ---- rows */

/* Is there no way to the node but from the other? */
static int comes_from(const struct ordering *o, int node, int other)
{
    if (leads_to(&o->oracle->start, node))
        return 0;
    for (int i = 0; i < o->oracle->order.count; i++) {
        const int from = o->dag->order[o->oracle->order.first + i];
        for (int k = 0; from != other && k < o->dag->nodes[from].arcs.count; k++)
            if (leads_to(&arc_of(o, from, k)->target, node))
                return 0;
    }
    return 1;
}

/* Do all answers of the node that do not go to `not` go to one place? Then that, in *sole. */
static int has_one_way(const struct ordering *o, int node, const struct target * not,
                       struct target *sole)
{
    int any = 0, other = 0;
    for (int k = 0; k < o->dag->nodes[node].arcs.count; k++) {
        const struct target *target = &arc_of(o, node, k)->target;
        if (dag_same_target(target, not )) {
            other = 1;
            continue;
        }
        if (any && !dag_same_target(target, sole))
            return 0;
        *sole = *target;
        any = 1;
    }
    return any && other;
}

/* Does b follow a in a row? */
static int make_row(const struct ordering *o, int a, int b, struct row *row)
{
    struct target to_b = {.kind = TARGET_NODE, .index = b};
    row->a = a;
    row->b = b;
    return o->dag->tools[o->dag->nodes[a].tool].kind == TOOL_QUESTION
           && o->dag->tools[o->dag->nodes[b].tool].kind == TOOL_QUESTION
           && has_one_way(o, a, &to_b, &row->fail) && has_one_way(o, b, &row->fail, &row->pass)
           && comes_from(o, b, a);
}

/* ---- may they change places? */

/* Reading these leaves nothing behind that another tool or a decision could tell. */
static const char *leaves_term(struct dag *dag, const char *tool, struct span needs)
{
    for (int i = needs.first; i < needs.first + needs.count; i++) {
        const struct term *term = &dag->terms[dag->needs[i].term];
        if (term->levels.count > 0)
            return dag_format(&dag->arena, "%s may leave %s finer than it was", tool, term->name);
        if (dag_is_kept(dag, dag->needs[i].term))
            return dag_format(&dag->arena, "%s may leave %s known, which a decision keeps", tool,
                              term->name);
    }
    return NULL;
}

static int asks_extern(const struct dag *dag, int expression)
{
    const struct expression *e = &dag->expressions[expression];
    return e->kind == EXPRESSION_EXTERN || (e->left >= 0 && asks_extern(dag, e->left))
           || (e->right >= 0 && asks_extern(dag, e->right));
}

/* Why what the node does may show to others; NULL: it cannot. */
static const char *shows(struct dag *dag, const struct node *node)
{
    const struct tool *tool = &dag->tools[node->tool];
    const char *left = NULL;
    if (tool->writes.count > 0 || tool->keeps != KEEPS_NOTHING)
        return dag_format(&dag->arena, "%s does more than answer", tool->name);
    for (int i = 0; i < node->arguments.count; i++) {
        const struct argument *argument = &dag->arguments[node->arguments.first + i];
        if (asks_extern(dag, argument->expression))
            return dag_format(&dag->arena, "an argument of %s is a function of yours", node->name);
        if (dag_is_doubtful(dag, argument))
            return dag_format(&dag->arena, "an argument of %s may be no number", node->name);
    }
    left = leaves_term(dag, tool->name, tool->reads);
    return left != NULL ? left : leaves_term(dag, node->name, node->reads);
}

/* May what the tool answers be what allows a subdivision? */
static int may_allow(const struct dag *dag, int tool)
{
    for (int i = 0; i < dag->tool_count; i++)
        if (dag->tools[i].after.name != NULL && dag->tools[i].after_index == tool)
            return 1;
    return dag->tools[tool].guards.count > 0;
}

/* Is there a way from the target to a subdivision? */
static int leads_to_split(const struct ordering *o, const struct target *target)
{
    struct dag *dag = o->dag;
    const int count = o->oracle->order.count;
    if (target->kind == TARGET_DECISION)
        return dag->decisions[target->index].subdivides;
    unsigned char *behind = dag_alloc(&dag->arena, (size_t)count + 1);
    behind[dag->nodes[target->index].order] = 1;
    for (int i = 0; i < count; i++) {
        const int node = dag->order[o->oracle->order.first + i];
        for (int k = 0; behind[i] && k < dag->nodes[node].arcs.count; k++) {
            const struct target *to = &arc_of(o, node, k)->target;
            if (to->kind == TARGET_DECISION && dag->decisions[to->index].subdivides)
                return 1;
            if (to->kind == TARGET_NODE)
                behind[dag->nodes[to->index].order] = 1;
        }
    }
    return 0;
}

/* Why not; NULL: it is proved that they may. */
static const char *why_not(const struct ordering *o, const struct row *row)
{
    struct dag *dag = o->dag;
    const struct node *a = &dag->nodes[row->a], *b = &dag->nodes[row->b];
    const struct tool *second = &dag->tools[b->tool];
    const char *why = shows(dag, a);
    if (why == NULL)
        why = shows(dag, b);
    if (why == NULL && (dag_may_change(dag, a, b, 0) || dag_may_change(dag, b, a, 0)))
        why = "one may change what the other answers";
    if (why == NULL && may_allow(dag, a->tool) && leads_to_split(o, &row->fail))
        why = dag_format(&dag->arena, "subdivisions that %s allows would come behind %s alone",
                         dag->tools[a->tool].name, b->name);
    if (why == NULL && !second->anywhere)
        why = dag_format(&dag->arena, "%s may have no answer where %s sends pairs elsewhere",
                         second->name, a->name);
    return why;
}

/* ---- does it pay? */

/* The share of a node's calls that goes to the target. */
static double share_to(const struct ordering *o, int node, const struct target *target)
{
    const struct measured *m = &o->profile->nodes[node];
    double count = 0;
    for (int k = 0; k < o->dag->nodes[node].arcs.count; k++)
        count += dag_same_target(&arc_of(o, node, k)->target, target) ? m->answers[k] : 0;
    return m->calls > 0 ? count / m->calls : 0;
}

/* Is b, which costs less for each pair that it takes out, second? */
static int should_exchange(const struct ordering *o, const struct row *row)
{
    const struct measured *a = &o->profile->nodes[row->a], *b = &o->profile->nodes[row->b];
    return a->seconds > 0 && b->seconds > 0
           && b->seconds * share_to(o, row->a, &row->fail)
                  < a->seconds * share_to(o, row->b, &row->fail);
}

static const char *describe(const struct ordering *o, int node, const struct row *row)
{
    const struct measured *m = &o->profile->nodes[node];
    return dag_format(&o->dag->arena, "%s (%.0f ns, %.1f %% end there)", o->dag->nodes[node].name,
                      1e9 * m->seconds, 100 * share_to(o, node, &row->fail));
}

static void tell(struct ordering *o, const char *sentence)
{
    struct profile *p = o->profile;
    p->told = dag_grow(&o->dag->arena, p->told, p->told_count, sizeof *p->told);
    p->told[p->told_count++] = sentence;
}

/* ---- the exchange */

/* Whoever came to a comes to b; b passes on to a, and a to where b went; in the order they change
 * places, too: all that led to b was a, and all that they lead to stands behind both. */
static void exchange(struct ordering *o, const struct row *row)
{
    struct dag *dag = o->dag;
    struct node *a = &dag->nodes[row->a], *b = &dag->nodes[row->b];
    const struct target to_a = {TARGET_NODE, row->a, a->name, a->where},
                        to_b = {TARGET_NODE, row->b, b->name, b->where};
    for (int i = 0; i < o->oracle->order.count; i++) {
        const int from = dag->order[o->oracle->order.first + i];
        for (int k = 0; k < dag->nodes[from].arcs.count; k++) {
            struct target *target = &arc_of(o, from, k)->target;
            if (from == row->a)
                *target = leads_to(target, row->b) ? row->pass : *target;
            else if (from == row->b)
                *target = dag_same_target(target, &row->pass) ? to_a : *target;
            else if (leads_to(target, row->a))
                *target = to_b;
        }
    }
    if (leads_to(&o->oracle->start, row->a))
        o->oracle->start = to_b;
    const int place = a->order;
    dag->order[o->oracle->order.first + place] = row->b;
    dag->order[o->oracle->order.first + b->order] = row->a;
    a->order = b->order;
    b->order = place;
    o->profile->ordered = 1;
}

/* One sweep over all rows. Returns how many exchanges; the last sweep, which made none, tells of
 * the rows that stay. */
static int sweep(struct ordering *o, int telling)
{
    struct dag *dag = o->dag;
    int count = 0;
    for (int i = 0; i < o->oracle->order.count; i++) {
        const int a = dag->order[o->oracle->order.first + i];
        for (int k = 0; k < dag->nodes[a].arcs.count; k++) {
            const struct target *target = &arc_of(o, a, k)->target;
            struct row row;
            int seen = 0;
            for (int j = 0; j < k; j++)
                seen |= dag_same_target(&arc_of(o, a, j)->target, target);
            if (seen || target->kind != TARGET_NODE || !make_row(o, a, target->index, &row))
                continue;
            const char *why = why_not(o, &row), *first = describe(o, row.a, &row),
                       *second = describe(o, row.b, &row);
            if (telling)
                tell(o,
                     dag_format(&dag->arena, "%s before %s: as it is; %s", first, second,
                                why != NULL ? why : "they commute, and this is the cheaper way"));
            else if (why == NULL && should_exchange(o, &row)) {
                tell(o, dag_format(&dag->arena,
                                   "%s now before %s: they commute, for neither does more than "
                                   "answer, neither leaves a term that is kept or has levels, and "
                                   "%s answers anywhere",
                                   second, first, dag->tools[dag->nodes[row.b].tool].name));
                exchange(o, &row);
                count++;
                break;
            }
        }
    }
    return count;
}

void dag_order_questions(struct dag *dag, struct profile *profile)
{
    struct oracle_graph copy;
    profile->before = dag->oracles[profile->oracle];
    copy_graph(dag, &profile->before, &copy, profile);
    dag->oracles[profile->oracle] = copy;
    struct ordering o = {dag, profile, &dag->oracles[profile->oracle]};
    while (sweep(&o, 0) > 0)
        continue;
    (void)sweep(&o, 1);
}

void dag_keep_order(struct dag *dag, struct profile *profile, const char *why)
{
    struct ordering o = {dag, profile, &dag->oracles[profile->oracle]};
    dag->oracles[profile->oracle] = profile->before;
    profile->ordered = profile->told_count = 0;
    tell(&o, why);
}
