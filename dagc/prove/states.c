/* states.c - all paths by the states that they go through.
 *
 * A release that calls a tool is in a state: the place in its text, or step, that calls, what is
 * known of each term, and whether some argument was no number, of which only the first is told. It
 * keeps nothing else, so from a state on it does the same whatever way led there, and so does the
 * graph from a node with the same terms known. Two ways that meet in such a pair of states need be
 * followed only once from there: if both have done the same in every step from each pair to the
 * next, they do the same on every path. So each pair that can be reached is entered once, and left
 * once by each answer; paths are exponentially many, states are not. [dynamic programming;
 * bisimulation of two deterministic automata, Hopcroft and Karp 1971]
 *
 * A state is left by running its release anew along the path that first found it; the script's end
 * answers 0 to everything, and what comes along there is found, too.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "analyse/analyse.h"
#include "prove/proving.h"

enum { STATES_MAX = 500000 };

struct state {
    int from, node, depth; /* from: in states; -1: it is where a discussion begins */
    long long site;
    unsigned char answer;        /* that led here from there */
    unsigned char told;          /* some argument was no number */
    const unsigned char *levels; /* by term */
    const unsigned char *start;  /* what the discussion came with */
};

struct exploring {
    struct proof *proof;
    struct state *states;
    int count;
    int *table; /* by hash: a state, from 1; 0: free */
    size_t size;
    struct prove_extent *extent;
};

static uint64_t hash_of(const struct exploring *s, const struct state *state)
{
    uint64_t hash = UINT64_C(14695981039346656037);
    hash = (hash ^ (uint64_t)(2 * state->node + state->told)) * UINT64_C(1099511628211);
    hash = (hash ^ (uint64_t)state->site) * UINT64_C(1099511628211);
    for (int i = 0; i < s->proof->dag->term_count; i++)
        hash = (hash ^ state->levels[i]) * UINT64_C(1099511628211);
    return hash ^ hash >> 29;
}

static size_t slot_of(const struct exploring *s, const struct state *state)
{
    size_t slot = (size_t)hash_of(s, state) & (s->size - 1);
    for (; s->table[slot] != 0; slot = (slot + 1) & (s->size - 1)) {
        const struct state *other = &s->states[s->table[slot] - 1];
        if (other->node == state->node && other->site == state->site && other->told == state->told
            && memcmp(other->levels, state->levels, (size_t)s->proof->dag->term_count) == 0)
            break;
    }
    return slot;
}

static void grow(struct exploring *s)
{
    s->size *= 2;
    s->table = dag_alloc(&s->proof->dag->arena, s->size * sizeof *s->table);
    for (int i = 0; i < s->count; i++)
        s->table[slot_of(s, &s->states[i])] = i + 1;
}

/* Runs the script; states that it goes through behind `from` are entered. */
static void run(struct exploring *s, enum prove_flavour flavour, int from,
                const unsigned char *start)
{
    struct proof *proof = s->proof;
    struct dag *dag = proof->dag;
    const struct prove_record *got = &proof->got;
    size_t terms = (size_t)dag->term_count;
    int call = 0, behind = from < 0 ? 0 : s->states[from].depth + 1;
    s->extent->walks++;
    if (prove_try(proof, flavour))
        return;
    for (int event = 0; event < got->events; event++) {
        if (got->what[event] < 0)
            continue;
        if (call < behind) {
            call++;
            continue;
        }
        struct state state = {.from = from,
                              .node = proof->nodes[call],
                              .site = got->site[event],
                              .depth = call,
                              .answer = call > 0 ? proof->script[call - 1] : 0,
                              .told = proof->told[call],
                              .levels = got->levels + (size_t)event * terms,
                              .start = start};
        size_t slot = slot_of(s, &state);
        if (s->table[slot] != 0)
            return;
        if (s->count == STATES_MAX) {
            s->extent->cut = 1;
            return;
        }
        s->states = dag_grow(&dag->arena, s->states, s->count, sizeof *s->states);
        unsigned char *levels = dag_alloc(&dag->arena, terms + 1);
        memcpy(levels, state.levels, terms);
        state.levels = levels;
        s->states[s->count] = state;
        s->table[slot] = ++s->count;
        if ((size_t)s->count * 2 > s->size)
            grow(s);
        from = s->count - 1;
        call++;
    }
}

/* The answers that lead to a state, and then one more; the rest of the script is 0. */
static void write_script(const struct exploring *s, int state, int answer)
{
    struct proof *proof = s->proof;
    const struct state *at = &s->states[state];
    memset(proof->script, 0, (size_t)proof->got.room);
    proof->script[at->depth] = (unsigned char)answer;
    for (; at->from >= 0; at = &s->states[at->from])
        proof->script[at->depth - 1] = at->answer;
}

/* The next of all that may be known at first, as an odometer counts; 0: there is none. */
static int next_start(const struct dag *dag, unsigned char *start)
{
    for (int i = 0; i < dag->term_count; i++) {
        int levels = dag->terms[i].levels.count > 0 ? dag->terms[i].levels.count : 1;
        if (!dag_is_kept(dag, i))
            continue;
        if (start[i] < levels) {
            start[i]++;
            return 1;
        }
        start[i] = 0;
    }
    return 0;
}

void prove_states(struct proof *proof, enum prove_flavour flavour, int all_starts,
                  struct prove_extent *extent)
{
    struct dag *dag = proof->dag;
    size_t terms = (size_t)dag->term_count;
    struct exploring s = {.proof = proof, .size = 1024, .extent = extent};
    s.table = dag_alloc(&dag->arena, s.size * sizeof *s.table);
    unsigned char *start = dag_alloc(&dag->arena, terms + 1);
    *extent = (struct prove_extent){0};
    do {
        unsigned char *kept = dag_alloc(&dag->arena, terms + 1);
        memcpy(kept, start, terms);
        memcpy(proof->start, start, terms);
        memset(proof->script, 0, (size_t)proof->got.room);
        run(&s, flavour, -1, kept);
        extent->starts++;
    } while (all_starts && !proof->different && !extent->cut && next_start(dag, start));
    for (int i = 0; i < s.count && !proof->different; i++)
        for (int a = 1; a < prove_node_at(proof, s.states[i].node)->arcs.count && !proof->different;
             a++) {
            write_script(&s, i, a);
            memcpy(proof->start, s.states[i].start, terms);
            run(&s, flavour, i, s.states[i].start);
        }
    extent->states = s.count;
}
