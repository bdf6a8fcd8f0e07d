/* statistics.c - the walk that counts.
 *
 * It takes the place of the walk in interpreter.c only when counts are wanted, so that they cost
 * nothing otherwise. Every thread that asks has counters of its own, whoever made the thread; sums
 * are made when asked for. What is counted never reaches a tool, so decisions are the same.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include "oracle/program.h"
#include "oracle/statistics.h"

/* One thread's counters of one program. */
struct tally {
    const void *owner;  /* address of the thread's `mine`: no two living threads have the same */
    struct tally *next; /* of the program */
    uint64_t counts[STATISTICS_COUNTS];
    struct record_statistics records[STATISTICS_SLOTS];
    uint64_t taken[]; /* [program.answer_count], as program.next */
};

/* The tally that the thread used last, and of which counting: a number that is never given
 * twice. */
static _Thread_local struct {
    uint64_t counting;
    struct tally *tally;
} mine;

static atomic_uint_fast64_t countings;

/* The thread's tally of the program, made when it asks for the first time. NULL: out of memory,
 * which statistics_take tells. */
static struct tally *find_tally(struct program *p)
{
    struct tally *first = atomic_load(&p->tallies), *t = first;
    while (t && t->owner != &mine)
        t = t->next;
    if (!t) {
        /* no line shared */
        t = calloc(1, sizeof *t + (size_t)p->answer_count * sizeof(uint64_t) + 64);
        if (!t) {
            atomic_store(&p->lost, 1);
            return NULL;
        }
        t->owner = &mine;
        do
            t->next = first;
        while (!atomic_compare_exchange_weak(&p->tallies, &first, t));
    }
    mine.counting = p->counting;
    mine.tally = t;
    return t;
}

static void keep(struct tally *t, enum keeps what, const double *values)
{
    if (what == KEEPS_COUNT) {
        t->counts[values[0] > 0
                      ? values[0] < STATISTICS_COUNTS ? (int)values[0] : STATISTICS_COUNTS - 1
                      : 0]++;
    } else {
        struct record_statistics *r =
            &t->records[values[1] > 0
                            ? values[1] < STATISTICS_SLOTS ? (int)values[1] : STATISTICS_SLOTS - 1
                            : 0];
        if (!(values[0] > 0)) {
            r->zero++;
            return;
        }
        int e;
        e = isinf(values[0]) ? STATISTICS_HIGH : (frexp(values[0], &e), e - 1);
        e = e < STATISTICS_LOW ? STATISTICS_LOW : e >= STATISTICS_HIGH ? STATISTICS_HIGH - 1 : e;
        r->bins[e - STATISTICS_LOW]++;
    }
}

enum decision program_walk_counted(const void *state, struct discussion *d)
{
    const struct program *p = state;
    struct tally *t = mine.counting == p->counting ? mine.tally : find_tally(p->self);
    const struct step *step = p->steps;
    if (!t)
        return program_walk(p->steps, d);
    for (;;) {
        int answer = step->call(d, step->arguments), next = step->next[answer];
        t->taken[&step->next[answer] - p->next]++;
        if (step->keeps != KEEPS_NOTHING) {
            if (step->call == program_compute) {
                double values[STACK_MAX];
                program_evaluate(d, (const struct computed *)(const void *)step->arguments, values);
                keep(t, step->keeps, values);
            } else {
                keep(t, step->keeps, step->arguments);
            }
        }
        if (next < 0)
            return (enum decision) ~next;
        step = &p->steps[next];
    }
}

void program_free_tallies(struct program *p)
{
    struct tally *t = atomic_exchange(&p->tallies, NULL), *next;
    for (; t; t = next) {
        next = t->next;
        free(t);
    }
}

int refiner_count(struct refiner *r)
{
    struct program *p = r->own;
    if (strcmp(r->release, "dag") != 0)
        return -1;
    program_free_tallies(p);
    p->self = p;
    p->counting = atomic_fetch_add(&countings, 1) + 1;
    atomic_store(&p->lost, 0);
    r->refine = program_walk_counted;
    r->state = p;
    return 0;
}

static uint64_t sum_taken(const struct program *p, int answer)
{
    uint64_t sum = 0;
    for (const struct tally *t = p->tallies; t; t = t->next)
        sum += t->taken[answer];
    return sum;
}

static void sum_nodes(struct statistics *s, const struct program *p)
{
    static const char *const kinds[] = {"precise", "approximate", "other"};
    const struct dag *dag = p->dag;
    int at = 0;
    for (int i = 0; i < s->node_count; i++) {
        const struct node *n = &dag->nodes[dag->order[p->graph->order.first + i]];
        struct node_statistics *x = &s->nodes[i];
        x->name = n->name;
        x->tool = dag->tools[n->tool].name;
        x->answers = &s->answers[at];
        x->answer_count = n->arcs.count;
        for (int k = 0; k < n->arcs.count; k++, at++) {
            const struct answer *a = &dag->answers[dag->tools[n->tool].answers.first + k];
            s->answers[at].name = a->name;
            s->answers[at].kind =
                dag->tools[n->tool].kind == TOOL_COMMAND ? "command" : kinds[a->kind];
            s->answers[at].target = dag->arcs[n->arcs.first + k].target.name;
            s->answers[at].count = sum_taken(p, at);
            x->calls += s->answers[at].count;
        }
    }
}

int statistics_take(struct statistics *s, const struct refiner *r)
{
    const struct program *p = r->own;
    memset(s, 0, sizeof *s);
    if (strcmp(r->release, "dag") != 0 || !p->counting || p->lost)
        return -1;
    s->node_count = p->graph->order.count;
    s->nodes = calloc((size_t)s->node_count, sizeof *s->nodes);
    s->answers = calloc((size_t)p->answer_count + 1, sizeof *s->answers);
    if (!s->nodes || !s->answers) {
        statistics_free(s);
        return -1;
    }
    sum_nodes(s, p);
    for (const struct tally *t = p->tallies; t; t = t->next) {
        for (int k = 0; k < STATISTICS_COUNTS; k++)
            s->counts[k] += t->counts[k];
        for (int k = 0; k < STATISTICS_SLOTS; k++) {
            s->records[k].zero += t->records[k].zero;
            for (int m = 0; m < STATISTICS_HIGH - STATISTICS_LOW; m++)
                s->records[k].bins[m] += t->records[k].bins[m];
        }
    }
    return 0;
}

void statistics_free(struct statistics *s)
{
    free(s->nodes);
    free(s->answers);
    memset(s, 0, sizeof *s);
}
