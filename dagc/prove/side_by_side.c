/* side_by_side.c - see side_by_side.h.
 *
 * A state is a node (or leaf) of each graph, what has been written to the data manager on either
 * side, and the answers given so far that one of the two may still come to ask about. A question is
 * a tool, its arguments (parameters by name, numbers by value) and what its side has done to the
 * terms that it and its arguments read; whoever asks it again gets the answer it had. What is done
 * to a term is known by levels where arguments read it: they say at which. A tool says less: what
 * it writes is its own, and what it reads it may leave finer than it was, unless it is at its last
 * level. So these count by who they were, in which order; the same question finds what it left. A
 * term without levels is the same whoever reads it first, an argument or a tool. A state that was
 * seen is not walked again, and where both sides stand before the same subgraph with the same terms
 * nothing can differ, so the work is polynomial in all but the answers that stay relevant; it is
 * capped, and a walk that was cut short says so.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "analyse/analyse.h"
#include "prove/questions.h"
#include "prove/side_by_side.h"

enum { STATES_MAX = 1000000, TABLE_SIZE = 1 << 10 };

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
    const struct asking *graph;
    const char *path;
    struct known *known; /* by term */
    struct target at;
    int last; /* the node that led to `at`; its order */
};

struct walk {
    struct arena *arena;
    struct questions questions;
    struct side side[SIDES];
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
    struct group groups[WAYS_MAX];
    int group_count;
    FILE *out; /* NULL: nothing is told */
};

static const struct node *node_at(const struct side *side, int place)
{
    return dag_node_at(side->graph->dag, side->graph->oracle, place);
}

/* ---- what a question finds */

static void change(struct known *known, uint64_t tool)
{
    if (known->last == tool) /* it finds what it left */
        return;
    known->history = dag_mix(dag_mix(known->history, known->level), tool);
    known->last = tool;
}

/* The term when the tool is asked: its arguments have been evaluated by then. With a reader, who
 * stands for the tool: once it has read its terms, too. */
static struct known known_at(const struct side *side, const struct node *node, int term,
                             uint64_t reader)
{
    const struct dag *dag = side->graph->dag;
    const uint64_t levels = (uint64_t)dag->terms[term].levels.count;
    struct known known = side->known[term];
    for (int i = node->reads.first; i < node->reads.first + node->reads.count; i++)
        if (dag->needs[i].term == term && levels > 0
            && (uint64_t)dag->needs[i].level > known.level) {
            known.level = (uint64_t)dag->needs[i].level;
            known.last = 0;
        }
    if (reader != 0 && known.level < levels
        && dag_reads_term(dag, dag->tools[node->tool].reads, term))
        change(&known, reader);
    return known;
}

/* What an answer depends on: the terms that the arguments read, then those of the tool. */
static uint64_t hash_reads(const struct side *side, const struct node *node, uint64_t reader)
{
    const struct span *const needs[] = {&node->reads, &side->graph->dag->tools[node->tool].reads};
    uint64_t hash = 5;
    for (int k = 0; k < 2; k++)
        for (int i = needs[k]->first; i < needs[k]->first + needs[k]->count; i++) {
            struct known known = known_at(side, node, side->graph->dag->needs[i].term, reader);
            hash = dag_mix(dag_mix(hash, known.history), known.level);
        }
    return hash;
}

/* A tool as one who changes terms, by reading or by writing them. */
enum { READS = 6, WRITES };
static uint64_t changer(const struct asked *asked, int how)
{
    uint64_t hash = dag_mix(dag_mix((uint64_t)how, (uint64_t)asked->base), asked->found);
    return hash == 0 ? 1 : hash;
}

static int place_of(const struct side *side)
{
    return side->at.kind == TARGET_NODE ? side->graph->dag->nodes[side->at.index].order : -1;
}

/* May the side still ask a question with this base, or read the term behind all bases? */
static int may_ask(const struct walk *walk, const struct side *side, int base)
{
    int place = place_of(side);
    return place >= 0
           && (side->graph
                       ->reach[(size_t)place * (size_t)walk->questions.bytes + (size_t)(base / 8)]
                   >> base % 8
               & 1);
}

/* Nothing that follows can differ: the same graph lies before both, with the same terms. */
static int must_agree(const struct walk *walk)
{
    const struct side *a = &walk->side[0], *b = &walk->side[1];
    if (dag_subgraph_of(a->graph, &a->at) != dag_subgraph_of(b->graph, &b->at))
        return 0;
    for (int t = 0; t < a->graph->dag->term_count; t++)
        if (may_ask(walk, a, walk->questions.base_count + t)
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
    for (int i = walk->newest[side->graph->base[place]] - 1; i >= 0; i = walk->trail[i].before)
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
    asked->base = side->graph->base[place];
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
        hash = dag_mix(dag_mix(hash, (uint64_t)side->at.kind), (uint64_t)side->at.index);
        if (side->at.kind != TARGET_NODE) /* ways that differ are told apart by it */
            hash = dag_mix(hash, (uint64_t)side->last);
        for (int t = 0; t < side->graph->dag->term_count; t++)
            if (may_ask(walk, side, walk->questions.base_count + t))
                hash = dag_mix(dag_mix(hash, side->known[t].history), side->known[t].level);
    }
    for (int i = walk->first; i >= 0; i = walk->trail[i].next) {
        const struct asked *asked = &walk->trail[i];
        uint64_t one = dag_mix(dag_mix(2, (uint64_t)asked->base), (uint64_t)asked->answer);
        answers += dag_mix(one, asked->found); /* in whatever order they came */
    }
    hash = dag_mix(hash, answers);
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
    fprintf(out, "  %s(", side->graph->dag->tools[node->tool].name);
    for (int i = 0; i < node->arguments.count; i++) {
        const struct argument *argument = &side->graph->dag->arguments[node->arguments.first + i];
        fprintf(out, "%s%s = %s", i > 0 ? ", " : "", argument->name,
                dag_value_text(side->graph->dag, argument->expression));
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
    if (walk->group_count >= WAYS_MAX)
        return;
    walk->groups[walk->group_count++] = new_group;
    if (walk->out == NULL || walk->group_count > WAYS_SHOWN)
        return;
    fprintf(walk->out, "\n");
    for (int i = 0; i < walk->trail_count; i++) {
        const struct asked *asked = &walk->trail[i];
        const struct side *side = &walk->side[walk->questions.bases[asked->base].side];
        const struct node *node = node_at(side, walk->questions.bases[asked->base].node);
        const struct tool *tool = &side->graph->dag->tools[node->tool];
        print_question(walk->out, side, node);
        fprintf(walk->out, ": %s\n",
                side->graph->dag->answers[tool->answers.first + asked->answer].name);
    }
    for (int s = 0; s < SIDES; s++)
        fprintf(walk->out, "%c %s decides %s after %s\n", s == 0 ? '-' : '+', walk->side[s].path,
                walk->side[s].graph->dag->decisions[walk->side[s].at.index].name,
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
    const struct dag *dag = side->graph->dag;
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

struct differences dag_walk_both(const struct compared *side, struct arena *arena, FILE *out)
{
    struct walk *walk = dag_alloc(arena, sizeof *walk);
    const size_t terms = (size_t)side[0].dag->term_count;
    walk->arena = arena;
    walk->out = out;
    for (int s = 0; s < SIDES; s++) {
        walk->questions.side[s].dag = side[s].dag;
        walk->questions.side[s].oracle = side[s].oracle;
    }
    dag_questions_find(&walk->questions, arena);
    size_t most = 1, changes = 1; /* a way comes to each node once */
    for (int s = 0; s < SIDES; s++) {
        const struct oracle_graph *oracle = side[s].oracle;
        walk->side[s] = (struct side){.graph = &walk->questions.side[s],
                                      .path = side[s].path,
                                      .known = dag_alloc(arena, terms * sizeof(struct known) + 1),
                                      .at = oracle->start};
        most += (size_t)oracle->order.count;
        for (int i = 0; i < oracle->order.count; i++) {
            const struct node *node = dag_node_at(side[s].dag, oracle, i);
            const struct tool *tool = &side[s].dag->tools[node->tool];
            changes += (size_t)(node->reads.count + tool->reads.count + tool->writes.count);
        }
    }
    walk->trail = dag_alloc(arena, most * sizeof *walk->trail);
    walk->newest = dag_alloc(arena, most * sizeof *walk->newest);
    walk->changes = dag_alloc(arena, changes * sizeof *walk->changes);
    walk->idle = dag_alloc(arena, most * sizeof *walk->idle);
    walk->first = walk->final = -1;
    walk_all(walk);
    return (struct differences){walk->group_count, walk->states, walk->cut};
}
