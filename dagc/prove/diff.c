/* diff.c - two oracles walked side by side.
 *
 * A state is a node (or leaf) of each graph, what has been written to the data manager on either
 * side, and the answers given so far that one of the two may still come to ask about. A question is
 * a tool, its arguments (parameters by name, numbers by value) and what its side has done to the
 * terms that it and its arguments read; whoever asks it again gets the answer it had. What is done
 * to a term is known by levels where arguments read it: they say at which. A tool says less: what
 * it writes is its own, and what it reads it may leave finer than it was, unless the term has no
 * levels or is at its last. So these count by who they were, in which order; the same question
 * finds what it left. A state that was seen is not walked again, and where both sides stand before
 * the same subgraph with the same terms nothing can differ, so the work is polynomial in all but
 * the answers that stay relevant; it is capped, and a walk that was cut short says so.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "analyse/analyse.h"
#include "prove/diff.h"
#include "prove/same_catalog.h"

enum { STATES_MAX = 1000000, TABLE_SIZE = 1 << 10, SHOWN = 20, GROUPS_MAX = 1000, SIDES = 2 };

/* A tool with its arguments: equal numbers, equal questions but for the terms. */
struct question {
    int side, node; /* where it was first seen */
};

/* What a side has done to a term. */
struct known {
    uint64_t history; /* a hash of the tools that may have changed it, in their order */
    uint64_t last;    /* the last of them, if nothing came after it */
    uint64_t level;   /* at least */
};

/* One that has been asked: a hash of what it reads as it found that, and as reading left it; and
 * where that was, to try its next answer from. */
struct asked {
    int base, answer, answers;
    uint64_t found, left;
    int before; /* in the trail: the last of the same base; -1 */
    struct target at[SIDES];
    int last[SIDES], change_count, idle_count;
    int next, previous; /* in the trail: of those that may be asked again; -1 */
};

/* What a side knew of a term. */
struct change {
    int side, term;
    struct known known;
};

struct group { /* ways to decide that differ, by what was asked last on either side */
    int node[SIDES], decision[SIDES];
};

struct side {
    struct dag *dag;
    const struct oracle_graph *oracle;
    const char *path;
    int *base;            /* by order: in bases */
    unsigned char *reach; /* [order][bases, then terms, in bits]: is it asked or read from here? */
    uint64_t *subgraph;   /* by order: a hash of all that follows */
    struct known *known;  /* by term */
    struct target at;
    int last; /* the node that led to `at`; its order */
};

struct walk {
    struct arena *arena;
    struct side side[SIDES];
    struct question *bases;
    int base_count, bytes;
    struct asked *trail; /* a way may be as long as the graphs: nothing recurses on it */
    int trail_count;
    int *newest;            /* by base: in the trail, from 1; 0: it has not been asked */
    struct change *changes; /* of this way, to be undone */
    int change_count;
    int first, final; /* of the trail, those that may be asked again */
    int *idle;        /* and those that were found not to: neither are they further on */
    int idle_count;
    uint64_t *seen;
    size_t seen_size; /* a power of two */
    int states, cut;
    struct group groups[GROUPS_MAX];
    int group_count;
    FILE *out; /* NULL: nothing is told */
};

static const struct node *node_at(const struct side *side, int place)
{
    return &side->dag->nodes[side->dag->order[side->oracle->order.first + place]];
}

/* ---- questions */

/* -0 is less than 0. */
static int same_number(double x, double y)
{
    return x == y && !signbit(x) == !signbit(y);
}

static int same_value(const struct dag *a, int i, const struct dag *b, int j)
{
    const struct expression *x = &a->expressions[i], *y = &b->expressions[j];
    if (x->kind != y->kind)
        return 0;
    switch (x->kind) {
    case EXPRESSION_NUMBER:
        return same_number(x->number, y->number);
    case EXPRESSION_PARAMETER:
        return strcmp(a->parameters[x->parameter].name, b->parameters[y->parameter].name) == 0;
    case EXPRESSION_FACT:
        return strcmp(a->facts[x->index].name, b->facts[y->index].name) == 0
               && strcmp(a->facts[x->index].c, b->facts[y->index].c) == 0;
    case EXPRESSION_TERM:
        return x->index == y->index && x->level == y->level;
    case EXPRESSION_EXTERN:
        return strcmp(a->callbacks[x->index].name, b->callbacks[y->index].name) == 0;
    default:
        return same_value(a, x->left, b, y->left)
               && (x->right < 0 || same_value(a, x->right, b, y->right));
    }
}

static int same_base(const struct side *a, const struct node *x, const struct side *b,
                     const struct node *y)
{
    if (x->tool != y->tool || x->reads.count != y->reads.count)
        return 0;
    for (int i = 0; i < x->reads.count; i++) { /* an extern may be declared otherwise */
        const struct need *p = &a->dag->needs[x->reads.first + i],
                          *q = &b->dag->needs[y->reads.first + i];
        if (p->term != q->term || p->level != q->level)
            return 0;
    }
    for (int i = 0; i < x->arguments.count; i++)
        if (!same_value(a->dag, a->dag->arguments[x->arguments.first + i].expression, b->dag,
                        b->dag->arguments[y->arguments.first + i].expression))
            return 0;
    return 1;
}

static uint64_t mix(uint64_t x, uint64_t y)
{
    x = (x ^ y) * UINT64_C(0x9e3779b97f4a7c15);
    return x ^ x >> 29;
}

static void change(struct known *known, uint64_t tool)
{
    if (known->last == tool) /* it finds what it left */
        return;
    known->history = mix(mix(known->history, known->level), tool);
    known->last = tool;
}

static int reads(const struct dag *dag, struct span needs, int term)
{
    for (int i = needs.first; i < needs.first + needs.count; i++)
        if (dag->needs[i].term == term)
            return 1;
    return 0;
}

/* The term when the tool is asked: its arguments have been evaluated by then. With a reader, who
 * stands for the tool: once it has read its terms, too. */
static struct known known_at(const struct side *side, const struct node *node, int term,
                             uint64_t reader)
{
    const struct dag *dag = side->dag;
    const uint64_t levels = (uint64_t)dag->terms[term].levels.count;
    struct known known = side->known[term];
    for (int i = node->reads.first; i < node->reads.first + node->reads.count; i++)
        if (dag->needs[i].term == term && (uint64_t)dag->needs[i].level > known.level) {
            known.level = (uint64_t)dag->needs[i].level;
            known.last = 0;
        }
    if (reader != 0 && known.level < levels && reads(dag, dag->tools[node->tool].reads, term))
        change(&known, reader);
    return known;
}

/* What an answer depends on: the terms that the arguments read, then those of the tool. */
static uint64_t hash_reads(const struct side *side, const struct node *node, uint64_t reader)
{
    const struct span *const needs[] = {&node->reads, &side->dag->tools[node->tool].reads};
    uint64_t hash = 5;
    for (int k = 0; k < 2; k++)
        for (int i = needs[k]->first; i < needs[k]->first + needs[k]->count; i++) {
            struct known known = known_at(side, node, side->dag->needs[i].term, reader);
            hash = mix(mix(hash, known.history), known.level);
        }
    return hash;
}

/* A tool as one who changes terms, by reading or by writing them. */
enum { READS = 6, WRITES };
static uint64_t changer(const struct asked *asked, int how)
{
    uint64_t hash = mix(mix((uint64_t)how, (uint64_t)asked->base), asked->found);
    return hash == 0 ? 1 : hash;
}

/* Bases are looked for among those of the same text: chains, newest first. */
static void find_bases(struct walk *walk)
{
    int most = walk->side[0].oracle->order.count + walk->side[1].oracle->order.count;
    struct table texts = {NULL, NULL, 0, 0};
    int *last = dag_alloc(walk->arena, (size_t)most * sizeof(int));
    int *before = dag_alloc(walk->arena, (size_t)most * sizeof(int));
    walk->bases = dag_alloc(walk->arena, (size_t)most * sizeof *walk->bases);
    for (int s = 0; s < SIDES; s++) {
        struct side *side = &walk->side[s];
        side->base = dag_alloc(walk->arena, (size_t)side->oracle->order.count * sizeof(int));
        for (int i = 0; i < side->oracle->order.count; i++) {
            const struct node *node = node_at(side, i);
            int text = texts.count;
            int known = dag_put(walk->arena, &texts, dag_call_text(side->dag, node), text);
            text = known < 0 ? text : known;
            int found = last[text] - 1;
            for (; found >= 0; found = before[found] - 1) {
                const struct side *other = &walk->side[walk->bases[found].side];
                if (same_base(side, node, other, node_at(other, walk->bases[found].node)))
                    break;
            }
            if (found < 0) {
                found = walk->base_count++;
                walk->bases[found].side = s;
                walk->bases[found].node = i;
                before[found] = last[text];
                last[text] = found + 1;
            }
            side->base[i] = found;
        }
    }
}

static void set_bit(unsigned char *bits, int i)
{
    bits[i / 8] |= (unsigned char)(1 << i % 8);
}

static void find_reach(struct walk *walk)
{
    walk->bytes = (walk->base_count + walk->side[0].dag->term_count + 7) / 8;
    for (int s = 0; s < SIDES; s++) {
        struct side *side = &walk->side[s];
        int count = side->oracle->order.count;
        side->reach = dag_alloc(walk->arena, (size_t)count * (size_t)walk->bytes);
        for (int i = count - 1; i >= 0; i--) {
            const struct node *node = node_at(side, i);
            unsigned char *row = side->reach + (size_t)i * (size_t)walk->bytes;
            set_bit(row, side->base[i]);
            for (int t = 0; t < side->dag->term_count; t++)
                if (reads(side->dag, node->reads, t)
                    || reads(side->dag, side->dag->tools[node->tool].reads, t))
                    set_bit(row, walk->base_count + t);
            for (int a = 0; a < node->arcs.count; a++) {
                const struct target *target = &side->dag->arcs[node->arcs.first + a].target;
                if (target->kind != TARGET_NODE)
                    continue;
                const unsigned char *from =
                    side->reach
                    + (size_t)side->dag->nodes[target->index].order * (size_t)walk->bytes;
                for (int k = 0; k < walk->bytes; k++)
                    row[k] |= from[k];
            }
        }
    }
}

static uint64_t subgraph_of(const struct side *side, const struct target *target)
{
    return target->kind == TARGET_NODE ? side->subgraph[side->dag->nodes[target->index].order]
                                       : mix(3, (uint64_t)target->index);
}

static void find_subgraphs(struct walk *walk)
{
    for (int s = 0; s < SIDES; s++) {
        struct side *side = &walk->side[s];
        int count = side->oracle->order.count;
        side->subgraph = dag_alloc(walk->arena, (size_t)count * sizeof *side->subgraph);
        for (int i = count - 1; i >= 0; i--) {
            const struct node *node = node_at(side, i);
            uint64_t hash = mix(4, (uint64_t)side->base[i]);
            for (int a = 0; a < node->arcs.count; a++)
                hash = mix(hash, subgraph_of(side, &side->dag->arcs[node->arcs.first + a].target));
            side->subgraph[i] = hash;
        }
    }
}

static int place_of(const struct side *side)
{
    return side->at.kind == TARGET_NODE ? side->dag->nodes[side->at.index].order : -1;
}

/* May the side still ask a question with this base, or read the term behind all bases? */
static int may_ask(const struct walk *walk, const struct side *side, int base)
{
    int place = place_of(side);
    return place >= 0
           && (side->reach[(size_t)place * (size_t)walk->bytes + (size_t)(base / 8)] >> base % 8
               & 1);
}

/* Nothing that follows can differ: the same graph lies before both, with the same terms. */
static int must_agree(const struct walk *walk)
{
    const struct side *a = &walk->side[0], *b = &walk->side[1];
    if (subgraph_of(a, &a->at) != subgraph_of(b, &b->at))
        return 0;
    for (int t = 0; t < a->dag->term_count; t++)
        if (may_ask(walk, a, walk->base_count + t)
            && (a->known[t].history != b->known[t].history
                || a->known[t].level != b->known[t].level))
            return 0;
    return 1;
}

/* When the question of this side's node has been asked; NULL: not yet. */
static const struct asked *find_asked(const struct walk *walk, const struct side *side)
{
    int place = place_of(side);
    uint64_t reads = hash_reads(side, node_at(side, place), 0);
    for (int i = walk->newest[side->base[place]] - 1; i >= 0; i = walk->trail[i].before)
        if (walk->trail[i].found == reads || walk->trail[i].left == reads)
            return &walk->trail[i];
    return NULL;
}

/* ---- the trail
 *
 * Items are put at its end and taken from there. Those that neither side may come to ask again
 * leave the list of the others on the way, and come back on the way back, the last one first. */

static void link_asked(struct walk *walk, int item)
{
    const struct asked *asked = &walk->trail[item];
    *(asked->previous < 0 ? &walk->first : &walk->trail[asked->previous].next) = item;
    *(asked->next < 0 ? &walk->final : &walk->trail[asked->next].previous) = item;
}

static void unlink_asked(struct walk *walk, int item)
{
    const struct asked *asked = &walk->trail[item];
    *(asked->previous < 0 ? &walk->first : &walk->trail[asked->previous].next) = asked->next;
    *(asked->next < 0 ? &walk->final : &walk->trail[asked->next].previous) = asked->previous;
}

static void unlink_idle(struct walk *walk)
{
    for (int i = walk->first; i >= 0; i = walk->trail[i].next)
        if (!may_ask(walk, &walk->side[0], walk->trail[i].base)
            && !may_ask(walk, &walk->side[1], walk->trail[i].base)) {
            unlink_asked(walk, i);
            walk->idle[walk->idle_count++] = i;
        }
}

/* As it was when the item was asked. */
static void put_back(struct walk *walk, const struct asked *asked)
{
    while (walk->change_count > asked->change_count) {
        const struct change *change = &walk->changes[--walk->change_count];
        walk->side[change->side].known[change->term] = change->known;
    }
    while (walk->idle_count > asked->idle_count)
        link_asked(walk, walk->idle[--walk->idle_count]);
    for (int s = 0; s < SIDES; s++) {
        walk->side[s].at = asked->at[s];
        walk->side[s].last = asked->last[s];
    }
}

/* The question that the side is at, without an answer yet. */
static void put_asked(struct walk *walk, const struct side *side)
{
    const int place = place_of(side), item = walk->trail_count++;
    const struct node *node = node_at(side, place);
    struct asked *asked = &walk->trail[item];
    asked->base = side->base[place];
    asked->answer = -1;
    asked->answers = node->arcs.count;
    asked->found = hash_reads(side, node, 0);
    asked->left = hash_reads(side, node, changer(asked, READS));
    asked->before = walk->newest[asked->base] - 1;
    asked->change_count = walk->change_count;
    asked->idle_count = walk->idle_count;
    asked->next = -1;
    asked->previous = walk->final;
    for (int s = 0; s < SIDES; s++) {
        asked->at[s] = walk->side[s].at;
        asked->last[s] = walk->side[s].last;
    }
    walk->newest[asked->base] = item + 1;
    link_asked(walk, item);
}

static void take_asked(struct walk *walk)
{
    const struct asked *asked = &walk->trail[--walk->trail_count];
    walk->newest[asked->base] = asked->before + 1;
    unlink_asked(walk, walk->trail_count);
}

/* ---- states */

static uint64_t hash_state(const struct walk *walk)
{
    uint64_t hash = 1, answers = 0;
    for (int s = 0; s < SIDES; s++) {
        const struct side *side = &walk->side[s];
        hash = mix(mix(hash, (uint64_t)side->at.kind), (uint64_t)side->at.index);
        if (side->at.kind != TARGET_NODE) /* ways that differ are told apart by it */
            hash = mix(hash, (uint64_t)side->last);
        for (int t = 0; t < side->dag->term_count; t++)
            if (may_ask(walk, side, walk->base_count + t))
                hash = mix(mix(hash, side->known[t].history), side->known[t].level);
    }
    for (int i = walk->first; i >= 0; i = walk->trail[i].next) {
        const struct asked *asked = &walk->trail[i];
        uint64_t one = mix(mix(2, (uint64_t)asked->base), (uint64_t)asked->answer);
        answers += mix(one, asked->found); /* in whatever order they came */
    }
    hash = mix(hash, answers);
    return hash == 0 ? 1 : hash;
}

static size_t slot_of(const uint64_t *seen, size_t size, uint64_t hash)
{
    size_t slot = hash & (size - 1);
    while (seen[slot] != 0 && seen[slot] != hash)
        slot = (slot + 1) & (size - 1);
    return slot;
}

static void enlarge_seen(struct walk *walk)
{
    const size_t size = walk->seen_size == 0 ? TABLE_SIZE : 2 * walk->seen_size;
    uint64_t *seen = dag_alloc(walk->arena, size * sizeof *seen);
    for (size_t i = 0; i < walk->seen_size; i++)
        if (walk->seen[i] != 0)
            seen[slot_of(seen, size, walk->seen[i])] = walk->seen[i];
    walk->seen = seen;
    walk->seen_size = size;
}

/* Has the state been walked? Else it has now. */
static int seen_before(struct walk *walk)
{
    if (2 * (size_t)walk->states >= walk->seen_size)
        enlarge_seen(walk);
    uint64_t hash = hash_state(walk);
    size_t slot = slot_of(walk->seen, walk->seen_size, hash);
    if (walk->seen[slot] == hash)
        return 1;
    if (walk->states >= STATES_MAX) {
        walk->cut = 1;
        return 1;
    }
    walk->seen[slot] = hash;
    walk->states++;
    return 0;
}

/* ---- the report */

static void print_question(FILE *out, const struct side *side, const struct node *node)
{
    fprintf(out, "  %s(", side->dag->tools[node->tool].name);
    for (int i = 0; i < node->arguments.count; i++) {
        const struct argument *argument = &side->dag->arguments[node->arguments.first + i];
        fprintf(out, "%s%s = %s", i > 0 ? ", " : "", argument->name,
                dag_value_text(side->dag, argument->expression));
    }
    fprintf(out, ")");
}

static void report(struct walk *walk)
{
    struct group new_group = {{0}, {0}};
    for (int s = 0; s < SIDES; s++) {
        new_group.node[s] = walk->side[s].last;
        new_group.decision[s] = walk->side[s].at.index;
    }
    for (int i = 0; i < walk->group_count; i++)
        if (memcmp(&walk->groups[i], &new_group, sizeof new_group) == 0)
            return;
    if (walk->group_count >= GROUPS_MAX)
        return;
    walk->groups[walk->group_count++] = new_group;
    if (walk->out == NULL || walk->group_count > SHOWN)
        return;
    fprintf(walk->out, "\n");
    for (int i = 0; i < walk->trail_count; i++) {
        const struct asked *asked = &walk->trail[i];
        const struct side *side = &walk->side[walk->bases[asked->base].side];
        const struct node *node = node_at(side, walk->bases[asked->base].node);
        const struct tool *tool = &side->dag->tools[node->tool];
        print_question(walk->out, side, node);
        fprintf(walk->out, ": %s\n", side->dag->answers[tool->answers.first + asked->answer].name);
    }
    for (int s = 0; s < SIDES; s++)
        fprintf(walk->out, "%c %s decides %s after %s\n", s == 0 ? '-' : '+', walk->side[s].path,
                walk->side[s].dag->decisions[walk->side[s].at.index].name,
                node_at(&walk->side[s], walk->side[s].last)->name);
}

/* ---- the walk */

static void set_known(struct walk *walk, int s, int term, struct known known)
{
    struct known *at = &walk->side[s].known[term];
    if (at->history == known.history && at->last == known.last && at->level == known.level)
        return;
    walk->changes[walk->change_count++] = (struct change){s, term, *at};
    *at = known;
}

/* One side takes the answer's arc; its arguments and its tool have then read their terms, and the
 * tool has written what it declares. */
static void follow_arc(struct walk *walk, int s, const struct asked *asked)
{
    struct side *side = &walk->side[s];
    const struct dag *dag = side->dag;
    const struct node *node = &dag->nodes[side->at.index];
    const struct tool *tool = &dag->tools[node->tool];
    const struct span *const needs[] = {&node->reads, &tool->reads};
    for (int k = 0; k < 2; k++)
        for (int i = needs[k]->first; i < needs[k]->first + needs[k]->count; i++) {
            int term = dag->needs[i].term;
            set_known(walk, s, term, known_at(side, node, term, changer(asked, READS)));
        }
    int refuses = dag->answers[tool->answers.first + asked->answer].refuses;
    for (int i = 0; i < tool->writes.count && !refuses; i++) {
        const struct need *need = &dag->needs[tool->writes.first + i];
        struct known known = side->known[need->term];
        change(&known, changer(asked, WRITES));
        if (known.level < (uint64_t)need->level)
            known.level = (uint64_t)need->level;
        set_known(walk, s, need->term, known);
    }
    side->last = node->order;
    side->at = dag->arcs[node->arcs.first + asked->answer].target;
}

/* Follows what is known on both sides, then asks the first thing that is not, if there is one. */
static void go_on(struct walk *walk)
{
    int next = -1;
    for (int s = 0; s < SIDES; s++) {
        struct side *side = &walk->side[s];
        const struct asked *asked;
        while (side->at.kind == TARGET_NODE && (asked = find_asked(walk, side)) != NULL)
            follow_arc(walk, s, asked);
        if (side->at.kind == TARGET_NODE && next < 0)
            next = s;
    }
    unlink_idle(walk);
    if (must_agree(walk) || seen_before(walk))
        return;
    if (next >= 0)
        put_asked(walk, &walk->side[next]);
    else if (walk->side[0].at.index != walk->side[1].at.index)
        report(walk);
}

/* Tries every answer of every question. */
static void walk_all(struct walk *walk)
{
    go_on(walk);
    while (walk->trail_count > 0) {
        struct asked *asked = &walk->trail[walk->trail_count - 1];
        put_back(walk, asked);
        if (walk->cut || ++asked->answer == asked->answers)
            take_asked(walk);
        else
            go_on(walk);
    }
}

/* Parameters that one of them lacks, or whose defaults differ. */
static int compare_parameters(const struct walk *walk)
{
    int different = 0;
    for (int s = 0; s < SIDES; s++) {
        const struct side *side = &walk->side[s], *other = &walk->side[1 - s];
        for (int i = 0; i < side->oracle->parameters.count; i++) {
            const struct parameter *a = &side->dag->parameters[side->oracle->parameters.first + i],
                                   *b = NULL;
            for (int k = 0; k < other->oracle->parameters.count && b == NULL; k++) {
                const struct parameter *q =
                    &other->dag->parameters[other->oracle->parameters.first + k];
                b = strcmp(a->name, q->name) == 0 ? q : NULL;
            }
            if (b == NULL)
                fprintf(walk->out, "%c parameter %s\n", s == 0 ? '-' : '+', a->name);
            else if (s == 0 && !same_number(a->value, b->value)) {
                char x[32];
                fprintf(walk->out, "- parameter %s = %s\n", a->name, dag_number(a->value, x));
                char y[32];
                fprintf(walk->out, "+ parameter %s = %s\n", a->name, dag_number(b->value, y));
                different = 1;
            }
        }
    }
    return different;
}

/* Facts that both call by one name but that are not the same; the questions look alike. */
static void compare_facts(const struct walk *walk)
{
    const struct side *a = &walk->side[0], *b = &walk->side[1];
    for (int i = 0; i < a->dag->fact_count; i++) {
        const struct fact *fact = &a->dag->facts[i];
        int other = dag_find(&b->dag->fact_names, fact->name);
        if (other < 0 || strcmp(fact->c, b->dag->facts[other].c) == 0
            || !dag_reads_fact(a->dag, a->oracle, i) || !dag_reads_fact(b->dag, b->oracle, other))
            continue;
        fprintf(walk->out, "- fact %s = \"%s\"\n", fact->name, fact->c);
        fprintf(walk->out, "+ fact %s = \"%s\"\n", fact->name, b->dag->facts[other].c);
    }
}

struct request {
    struct side side[SIDES];
    struct arena arena; /* of one walk */
    FILE *out;
    int result;
};

/* Makes room for a walk, and walks. */
static void begin(struct walk *walk)
{
    struct arena *arena = walk->arena;
    const size_t terms = (size_t)walk->side[0].dag->term_count;
    find_bases(walk);
    find_reach(walk);
    find_subgraphs(walk);
    size_t most = 1, changes = 1; /* a way comes to each node once */
    for (int s = 0; s < SIDES; s++) {
        struct side *side = &walk->side[s];
        side->known = dag_alloc(arena, terms * sizeof *side->known + 1);
        side->at = side->oracle->start;
        most += (size_t)side->oracle->order.count;
        for (int i = 0; i < side->oracle->order.count; i++) {
            const struct node *node = node_at(side, i);
            const struct tool *tool = &side->dag->tools[node->tool];
            changes += (size_t)(node->reads.count + tool->reads.count + tool->writes.count);
        }
    }
    walk->trail = dag_alloc(arena, most * sizeof *walk->trail);
    walk->newest = dag_alloc(arena, most * sizeof *walk->newest);
    walk->changes = dag_alloc(arena, changes * sizeof *walk->changes);
    walk->idle = dag_alloc(arena, most * sizeof *walk->idle);
    walk->first = walk->final = -1;
    walk_all(walk);
}

int dag_diff_graphs(struct dag *dag, const struct oracle_graph *a, const struct oracle_graph *b)
{
    struct walk *walk = dag_alloc(&dag->arena, sizeof *walk);
    walk->arena = &dag->arena;
    for (int s = 0; s < SIDES; s++) {
        walk->side[s].dag = dag;
        walk->side[s].oracle = s == 0 ? a : b;
    }
    begin(walk);
    return walk->group_count > 0 || walk->cut;
}

/* (Protected twice: the arenas of both dags grow.) */
static void compare(struct dag *other, void *context)
{
    struct request *request = context;
    struct dag *dag = request->side[0].dag;
    (void)other;
    request->arena.protector = dag->arena.protector;
    struct walk *walk = dag_alloc(&request->arena, sizeof *walk);
    walk->arena = &request->arena;
    walk->out = request->out;
    memcpy(walk->side, request->side, sizeof walk->side);
    fprintf(walk->out, "oracle %s\n", walk->side[0].oracle->name);
    request->result |= compare_parameters(walk);
    compare_facts(walk);
    begin(walk);
    if (walk->group_count > SHOWN)
        fprintf(walk->out, "\n%d ways to decide differ%s; the first %d are shown\n",
                walk->group_count, walk->group_count == GROUPS_MAX ? " at least" : "", SHOWN);
    else
        fprintf(walk->out, "%s%d ways to decide differ\n", walk->group_count > 0 ? "\n" : "",
                walk->group_count);
    if (walk->cut)
        fprintf(walk->out, "stopped after %d states: there may be more\n", walk->states);
    request->result |= (walk->group_count > 0 ? 1 : 0) | (walk->cut ? 2 : 0);
}

static void compare_protected(struct dag *dag, void *context)
{
    struct request *request = context;
    (void)dag;
    if (dag_protect(request->side[1].dag, compare, request) != 0) {
        fprintf(stderr, "dagc: error: out of memory\n");
        request->result = 2;
    }
}

/* ---- the files */

/* Oracles of one name are compared; two files of one oracle each whatever the names. */
static int pair_up(struct request *request, int index)
{
    struct dag *a = request->side[0].dag, *b = request->side[1].dag;
    int other =
        a->oracle_count == 1 && b->oracle_count == 1 ? 0 : dag_oracle(b, a->oracles[index].name);
    if (other < 0) {
        fprintf(request->out, "- oracle %s\n", a->oracles[index].name);
        request->result |= 1;
        return 0;
    }
    request->side[0].oracle = &a->oracles[index];
    request->side[1].oracle = &b->oracles[other];
    return 1;
}

int dag_diff(const char *a, const char *b, const struct dag_options *options, FILE *out)
{
    struct request request = {0};
    request.out = out;
    request.side[0].path = a;
    request.side[1].path = b;
    struct dag_options loaded = *options;
    loaded.switches = "no-all"; /* a graph with weaknesses can be compared, too */
    request.side[0].dag = dag_load_with(a, &loaded, stderr);
    request.side[1].dag = dag_load_with(b, &loaded, stderr);
    if (request.side[0].dag == NULL || request.side[1].dag == NULL)
        request.result = 2;
    else if (!dag_same_catalog(request.side[0].dag, request.side[1].dag))
        request.result = 2;
    for (int i = 0; request.result < 2 && i < request.side[0].dag->oracle_count; i++) {
        if (pair_up(&request, i)
            && dag_protect(request.side[0].dag, compare_protected, &request) != 0) {
            fprintf(stderr, "dagc: error: out of memory\n");
            request.result = 2;
        }
        dag_arena_free(&request.arena);
    }
    for (int i = 0; request.result < 2 && i < request.side[1].dag->oracle_count; i++)
        if (!(request.side[0].dag->oracle_count == 1 && request.side[1].dag->oracle_count == 1)
            && dag_oracle(request.side[0].dag, request.side[1].dag->oracles[i].name) < 0) {
            fprintf(out, "+ oracle %s\n", request.side[1].dag->oracles[i].name);
            request.result |= 1;
        }
    dag_free(request.side[0].dag);
    dag_free(request.side[1].dag);
    return request.result >= 2 ? 2 : request.result;
}
