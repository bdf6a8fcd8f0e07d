/* analyse_guards.c - does every path to a subdivision hold an answer that allows it?
 *
 * A decision that `subdivides` asks the oracle again, one step deeper. An answer that allows it
 * says that it lowers the guard's measure, and no subdivision raises the measure of any guard; so
 * where every path to a subdivision holds an answer that allows just this one, the sum of the
 * measures of all guards falls with every step, and refinement ends. [D: derived here]
 *
 * For each such decision a breadth-first search looks for a path to it on which no answer allows
 * it: a path ends where one does. Beside the node, a state knows what else the proof needs: which
 * tools with an `after` have been preceded by what they come after. A question asked twice with the
 * same arguments answers the same, unless a tool between has changed what it reads; so when the
 * path that was found contradicts itself, the search is repeated with that question's answer in the
 * state, too. What it then finds is feasible, or there is nothing to find. States are bounded: past
 * MOST_STATES, or without bits for another question, the path found is reported as it is.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "analyse/guard.h"

enum { TRACKED_MAX = 8, KNOWN_BITS = 56, MOST_STATES = 1 << 18, AFTER_MAX = 8 };

/* A node, and what the path to it has left: bit i of `known` is "preceded" of the i-th guard that
 * comes after something; above AFTER_MAX, for each tracked question, its answer + 1; 0: not known.
 */
struct state {
    int place, from, answer; /* from: the state before, and its answer that leads here; -1 */
    uint64_t known;
};

struct question {
    int node; /* in nodes: one that asks it */
    int shift, bits;
};

struct proof {
    struct dag *dag;
    const struct oracle_graph *oracle;
    int decision;
    unsigned char *holds;                 /* by place: does the node's guard hold? */
    int *question;                        /* by place: equal numbers, equal questions */
    int after[AFTER_MAX], after_count;    /* in tools: guards that come after something */
    unsigned char (*allows)[ANSWERS_MAX]; /* by tool of the catalog: the decision */
    struct question tracked[TRACKED_MAX]; /* answers that states know */
    int tracked_count, bits;
    unsigned char *told; /* by arc: it has been reported */
    struct state *states;
    int count, capacity;
    int *table; /* states by hash; -1: empty */
    int table_size;
    int *path; /* states, from the start */
    int length;
};

static const struct node *node_of(const struct proof *p, int state)
{
    return dag_node_at(p->dag, p->oracle, p->states[state].place);
}

/* ---- what a path knows */

/* *known behind the answer of the node; 0: the answer contradicts what the path knows. */
static int learn(const struct proof *p, int place, int answer, uint64_t *known)
{
    const struct dag *dag = p->dag;
    const struct node *node = dag_node_at(dag, p->oracle, place);
    for (int i = 0; i < p->after_count; i++) {
        const struct tool *guard = &dag->tools[p->after[i]];
        const char *name = dag_answer_name(dag, node, answer);
        for (int k = 0; guard->after_index == node->tool && k < guard->after_answers.count; k++)
            if (strcmp(dag->labels[guard->after_answers.first + k].name, name) == 0)
                *known |= UINT64_C(1) << i;
    }
    for (int i = 0; i < p->tracked_count; i++) {
        const struct question *q = &p->tracked[i];
        const struct node *asked = &dag->nodes[q->node];
        uint64_t mask = ((UINT64_C(1) << q->bits) - 1) << q->shift;
        uint64_t is = (uint64_t)(answer + 1) << q->shift;
        int same = p->question[place] == p->question[asked->order];
        if (same && (*known & mask) != 0 && (*known & mask) != is)
            return 0;
        if (same)
            *known = (*known & ~mask) | is;
        if (dag_may_change(dag, node, asked, same))
            *known &= ~mask;
    }
    return 1;
}

/* Does this answer allow the decision, on a path that knows this? */
static int allowed(const struct proof *p, int place, int answer, uint64_t known)
{
    const struct node *node = dag_node_at(p->dag, p->oracle, place);
    if (!p->allows[node->tool][answer] || !p->holds[place])
        return 0;
    for (int i = 0; i < p->after_count; i++)
        if (p->after[i] == node->tool)
            return (int)(known >> i & 1);
    return p->dag->tools[node->tool].after.name == NULL;
}

/* ---- the search */

static int slot_of(const struct proof *p, int place, uint64_t known)
{
    uint64_t hash =
        (known + (uint64_t)place * UINT64_C(0x9e3779b97f4a7c15)) * UINT64_C(0xbf58476d1ce4e5b9);
    int slot = (int)((hash >> 33) % (uint64_t)p->table_size);
    while (
        p->table[slot] >= 0
        && (p->states[p->table[slot]].place != place || p->states[p->table[slot]].known != known))
        slot = slot + 1 == p->table_size ? 0 : slot + 1;
    return slot;
}

static void rehash(struct proof *p)
{
    if (p->table_size != 4 * p->capacity + 1) {
        p->table_size = 4 * p->capacity + 1;
        p->table = dag_alloc(&p->dag->arena, (size_t)p->table_size * sizeof *p->table);
    }
    for (int i = 0; i < p->table_size; i++)
        p->table[i] = -1;
    for (int i = 0; i < p->count; i++)
        p->table[slot_of(p, p->states[i].place, p->states[i].known)] = i;
}

static void reach(struct proof *p, int place, uint64_t known, int from, int answer)
{
    if (p->count == p->capacity) {
        struct state *old = p->states;
        p->capacity *= 2;
        p->states = dag_alloc(&p->dag->arena, (size_t)p->capacity * sizeof *old);
        memcpy(p->states, old, (size_t)p->count * sizeof *old);
        rehash(p);
    }
    int slot = slot_of(p, place, known);
    if (p->table[slot] >= 0)
        return;
    p->table[slot] = p->count;
    p->states[p->count++] = (struct state){place, from, answer, known};
}

/* A shortest path to the decision that nothing allows: its last state, and *answer of it; -1: there
 * is none, -2: there are too many states to know. */
static int search(struct proof *p, int *answer)
{
    const struct dag *dag = p->dag;
    p->count = 0;
    rehash(p);
    reach(p, 0, 0, -1, -1);
    for (int s = 0; s < p->count; s++) {
        int place = p->states[s].place;
        const struct node *node = dag_node_at(dag, p->oracle, place);
        for (int a = 0; a < node->arcs.count; a++) {
            const struct target *target = &dag->arcs[node->arcs.first + a].target;
            uint64_t known = p->states[s].known;
            if (allowed(p, place, a, known) || !learn(p, place, a, &known))
                continue;
            if (target->kind == TARGET_DECISION && target->index == p->decision
                && !p->told[node->arcs.first + a]) {
                *answer = a;
                return s;
            }
            if (target->kind == TARGET_NODE)
                reach(p, dag->nodes[target->index].order, known, s, a);
        }
        if (p->count > MOST_STATES && p->tracked_count > 0)
            return -2;
    }
    return -1;
}

static void trace_path(struct proof *p, int last)
{
    p->length = 0;
    for (int s = last; s >= 0; s = p->states[s].from)
        p->length++;
    p->path = dag_alloc(&p->dag->arena, (size_t)p->length * sizeof *p->path);
    for (int s = last, i = p->length - 1; s >= 0; s = p->states[s].from)
        p->path[i--] = s;
}

/* The answer that the path takes at its i-th node; `last` at the end of it. */
static int answer_at(const struct proof *p, int i, int last)
{
    return i + 1 < p->length ? p->states[p->path[i + 1]].answer : last;
}

/* ---- contradictions */

static int is_tracked(const struct proof *p, int question)
{
    for (int i = 0; i < p->tracked_count; i++)
        if (p->question[p->dag->nodes[p->tracked[i].node].order] == question)
            return 1;
    return 0;
}

/* A question that the path has answered otherwise before, nothing between having changed it: its
 * place on the path; -1: the path agrees with itself. */
static int contradiction(const struct proof *p, int last)
{
    for (int i = 0; i < p->length; i++) {
        const struct node *node = node_of(p, p->path[i]);
        int question = p->question[node->order];
        for (int k = i - 1; k >= 0 && !is_tracked(p, question); k--) {
            const struct node *before = node_of(p, p->path[k]);
            int same = p->question[before->order] == question;
            if (dag_may_change(p->dag, before, node, same))
                break;
            if (same && answer_at(p, k, last) != answer_at(p, i, last))
                return i;
        }
    }
    return -1;
}

/* The question's answer becomes a part of states; 0: there is no room. */
static int track(struct proof *p, const struct node *node)
{
    int bits = 1;
    while (node->arcs.count >> bits != 0)
        bits++;
    if (p->tracked_count == TRACKED_MAX || p->bits + bits > KNOWN_BITS)
        return 0;
    p->tracked[p->tracked_count++] =
        (struct question){(int)(node - p->dag->nodes), AFTER_MAX + p->bits, bits};
    p->bits += bits;
    return 1;
}

/* ---- what is said */

enum { PATH_SHOWN = 12, NOTES_SHOWN = 3, OTHERS_SHOWN = 4 };

static const char *path_text(const struct proof *p, int last)
{
    struct dag *dag = p->dag;
    const char *path = "start";
    for (int i = 0; i < p->length; i++) {
        if (p->length > PATH_SHOWN && i == PATH_SHOWN / 2) {
            path = dag_format(&dag->arena, "%s -> ... (%d more) ...", path, p->length - PATH_SHOWN);
            i += p->length - PATH_SHOWN - 1;
            continue;
        }
        const struct node *node = node_of(p, p->path[i]);
        path = dag_format(&dag->arena, "%s -> %s(%s)", path, node->name,
                          dag_answer_name(dag, node, answer_at(p, i, last)));
    }
    return dag_format(&dag->arena, "%s -> %s", path, dag->decisions[p->decision].name);
}

/* Of a guard on the path: why its answer does not do. */
static void note_guard(const struct proof *p, int at, int answer)
{
    struct dag *dag = p->dag;
    const struct node *node = node_of(p, p->path[at]);
    const struct tool *tool = &dag->tools[node->tool];
    const char *name = dag_answer_name(dag, node, answer);
    const char *other = dag_guard_allows(dag, tool, answer, -1);
    if (!p->holds[node->order])
        dag_note(dag, node->where, "'%s' guards nothing: %s", node->name,
                 dag_guard_fault(dag, node));
    else if (p->allows[node->tool][answer])
        dag_note(dag, node->where, "%s guards only behind %s of %s", tool->name,
                 dag_label_list(dag, tool->after_answers), tool->after.name);
    else if (*other != '\0')
        dag_note(dag, node->where, "the answer '%s' of %s allows %s alone", name, tool->name,
                 other);
    else
        dag_note(dag, node->where, "the answer '%s' of %s allows no subdivision", name, tool->name);
}

/* "can_split(both | receiver), clusters(receiver)" */
static const char *remedies(const struct proof *p)
{
    struct dag *dag = p->dag;
    const char *list = "";
    for (int i = 0; i < dag->tool_count; i++) {
        const char *answers = dag_guard_allows(dag, &dag->tools[i], -1, p->decision);
        if (*answers != '\0')
            list =
                dag_join(dag, list, dag_format(&dag->arena, "%s(%s)", dag->tools[i].name, answers));
    }
    return list;
}

/* 1 when it is shown. The first path found; then the other arcs to the decision that such paths end
 * with, by name. */
static int report(const struct proof *p, int last)
{
    struct dag *dag = p->dag;
    const struct node *node = node_of(p, p->path[p->length - 1]);
    const struct arc *arc = &dag->arcs[node->arcs.first + last];
    dag->use = node->use;
    if (!dag_warn(dag, WARNING_UNGUARDED_SPLIT, arc->target.where,
                  "a path to '%s' holds no answer that allows it: '%s' need not end",
                  dag->decisions[p->decision].name, p->oracle->name))
        return 0;
    dag_note(dag, node->where, "%s", path_text(p, last));
    for (int i = p->length - 1, notes = 0; i >= 0 && notes < NOTES_SHOWN; i--)
        if (dag->tools[node_of(p, p->path[i])->tool].guards.count > 0) {
            note_guard(p, i, answer_at(p, i, last));
            notes++;
        }
    return 1;
}

static void report_end(const struct proof *p, const char *others, int count)
{
    struct dag *dag = p->dag;
    const char *list = remedies(p);
    if (count > OTHERS_SHOWN)
        others = dag_format(&dag->arena, "%s ...", others);
    if (count > 0)
        dag_note(dag, dag_nowhere, "so do paths to it by %s", others);
    if (*list == '\0')
        dag_note(dag, dag_nowhere, "no tool of the catalog 'guards' it");
    else
        dag_note(dag, dag_nowhere, "what allows it: %s", list);
}

/* ---- the decisions of one oracle */

static void find_allows(struct proof *p)
{
    const struct dag *dag = p->dag;
    for (int i = 0; i < dag->tool_count; i++) {
        const struct span guards = dag->tools[i].guards;
        memset(p->allows[i], 0, ANSWERS_MAX);
        for (int g = guards.first; g < guards.first + guards.count; g++)
            if (dag->guards[g].decision_index == p->decision)
                p->allows[i][dag->guards[g].answer_index] = 1;
    }
}

/* The next path, feasible as far as that is known: 1 and *answer at its end, or 0. */
static int next_path(struct proof *p, int *answer)
{
    int last;
    while ((last = search(p, answer)) != -1) {
        if (last == -2) { /* with one question less there are fewer states, and a path */
            p->bits = KNOWN_BITS;
            p->tracked_count--;
            continue;
        }
        trace_path(p, last);
        int at = contradiction(p, *answer);
        if (at < 0 || !track(p, node_of(p, p->path[at])))
            return 1;
    }
    return 0;
}

static void check_decision(struct proof *p)
{
    struct dag *dag = p->dag;
    const char *others = "";
    int answer = 0, count = -1; /* of the others */
    find_allows(p);
    p->tracked_count = p->bits = 0;
    for (; count <= OTHERS_SHOWN && next_path(p, &answer); count++) {
        const struct node *node = node_of(p, p->path[p->length - 1]);
        p->told[node->arcs.first + answer] = 1;
        if (count < 0 && !report(p, answer))
            return;
        if (count >= 0 && count < OTHERS_SHOWN)
            others = dag_join(
                dag, others,
                dag_format(&dag->arena, "%s(%s)", node->name, dag_answer_name(dag, node, answer)));
    }
    if (count >= 0)
        report_end(p, others, count);
}

static void check_idle(struct dag *dag, const struct oracle_graph *oracle)
{
    for (int i = 0; i < oracle->order.count; i++) {
        const struct node *node = dag_node_at(dag, oracle, i);
        const struct tool *tool = &dag->tools[node->tool];
        dag->use = node->use;
        if (!dag_guard_idle(dag, node) || !dag_guard_holds(dag, node)
            || !dag_warn(dag, WARNING_IDLE_GUARD, node->where,
                         "unless its parameters are set, '%s' guards nothing: %s", node->name,
                         dag_guard_limits(dag, tool, " = 0")))
            continue;
        dag_note(dag, dag_nowhere,
                 "give one a default above 0, or refinement ends only where a program's limits "
                 "stop it");
    }
}

/* What is the same for all decisions of the oracle. */
static void look_at_nodes(struct proof *p)
{
    struct table table = {NULL, NULL, 0, 0};
    int questions = 0;
    for (int i = 0; i < p->oracle->order.count; i++) {
        const struct node *node = dag_node_at(p->dag, p->oracle, i);
        int old = dag_put(&p->dag->arena, &table, dag_call_text(p->dag, node), questions);
        p->question[i] = old >= 0 ? old : questions++;
        p->holds[i] = (unsigned char)dag_guard_holds(p->dag, node);
        int known = p->dag->tools[node->tool].after.name == NULL || p->after_count == AFTER_MAX;
        for (int k = 0; k < p->after_count; k++)
            known |= p->after[k] == node->tool;
        if (!known)
            p->after[p->after_count++] = node->tool;
    }
}

void dag_analyse_guards(struct dag *dag)
{
    struct proof p = {0};
    size_t nodes = (size_t)dag->order_count;
    if (dag_warning_level(dag, WARNING_UNGUARDED_SPLIT) == LEVEL_OFF
        && dag_warning_level(dag, WARNING_IDLE_GUARD) == LEVEL_OFF)
        return;
    p.dag = dag;
    p.holds = dag_alloc(&dag->arena, nodes);
    p.told = dag_alloc(&dag->arena, (size_t)dag->arc_count);
    p.question = dag_alloc(&dag->arena, nodes * sizeof *p.question);
    p.allows = dag_alloc(&dag->arena, (size_t)dag->tool_count * sizeof *p.allows);
    p.capacity = 1024;
    p.states = dag_alloc(&dag->arena, (size_t)p.capacity * sizeof *p.states);
    for (int i = 0; i < dag->oracle_count; i++) {
        p.oracle = &dag->oracles[i];
        p.after_count = 0;
        look_at_nodes(&p);
        check_idle(dag, p.oracle);
        for (p.decision = 0; p.decision < dag->decision_count; p.decision++)
            if (dag->decisions[p.decision].subdivides)
                check_decision(&p);
    }
}
