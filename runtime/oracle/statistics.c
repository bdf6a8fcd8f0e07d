/* statistics.c - the walk that counts.
 *
 * It takes the place of the walk in interpreter.c only when counts are wanted, so that they cost nothing
 * otherwise. Every thread has counters of its own; sums are made when asked for. What is counted never reaches a tool,
 * so decisions are the same.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#ifdef _OPENMP
#include <omp.h>
#else
#define omp_get_thread_num() 0
#endif
#include <stdlib.h>
#include <string.h>
#include "oracle/program.h"
#include "oracle/statistics.h"

/* One thread's counters. */
struct tally {
    uint64_t counts[STATISTICS_COUNTS];
    struct record_statistics records[STATISTICS_SLOTS];
    uint64_t taken[]; /* [program.answer_count], as program.next */
};

static void keep(struct tally *t, int what, const double *values)
{
    if (what == KEEPS_COUNT) {
        t->counts[values[0] > 0 ? values[0] < STATISTICS_COUNTS ? (int)values[0] : STATISTICS_COUNTS - 1 : 0]++;
    } else {
        struct record_statistics *r = &t->records[values[1] > 0 ? values[1] < STATISTICS_SLOTS ? (int)values[1] : STATISTICS_SLOTS - 1 : 0];
        int e;
        if (!(values[0] > 0)) {
            r->zero++;
            return;
        }
        e = isinf(values[0]) ? STATISTICS_HIGH : (frexp(values[0], &e), e - 1);
        e = e < STATISTICS_LOW ? STATISTICS_LOW : e >= STATISTICS_HIGH ? STATISTICS_HIGH - 1 : e;
        r->bins[e - STATISTICS_LOW]++;
    }
}

enum decision program_walk_counted(const void *state, struct discussion *d)
{
    const struct program *p = state;
    struct tally *t = p->tallies[omp_get_thread_num()];
    const struct step *step = p->steps;
    for (;;) {
        int answer = step->call(d, step->arguments), next = step->next[answer];
        t->taken[&step->next[answer] - p->next]++;
        if (step->keeps != KEEPS_NOTHING) {
            double values[STACK_MAX];
            if (step->call == program_compute) {
                program_evaluate(d, (const struct computed *)(const void *)step->arguments, values);
                keep(t, step->keeps, values);
            } else {
                keep(t, step->keeps, step->arguments);
            }
        }
        if (next < 0)
            return (enum decision)~next;
        step = &p->steps[next];
    }
}

void program_free_tallies(struct program *p)
{
    int i;
    for (i = 0; i < p->tally_count; i++)
        free(p->tallies[i]);
    free(p->tallies);
    p->tallies = NULL;
    p->tally_count = 0;
}

int refiner_count(struct refiner *r, int threads)
{
    struct program *p = r->own;
    int i;
    if (strcmp(r->release, "dag") != 0)
        return -1;
    program_free_tallies(p);
    p->tallies = calloc((size_t)threads, sizeof *p->tallies);
    if (!p->tallies)
        return -1;
    p->tally_count = threads;
    for (i = 0; i < threads; i++) {
        p->tallies[i] = calloc(1, sizeof **p->tallies + (size_t)p->answer_count * sizeof(uint64_t) + 64); /* no line shared */
        if (!p->tallies[i]) {
            program_free_tallies(p);
            return -1;
        }
    }
    r->refine = program_walk_counted;
    r->state = p;
    return 0;
}

static uint64_t sum_taken(const struct program *p, int answer)
{
    uint64_t sum = 0;
    int i;
    for (i = 0; i < p->tally_count; i++)
        sum += p->tallies[i]->taken[answer];
    return sum;
}

static void take_nodes(struct statistics *s, const struct program *p)
{
    static const char *const kinds[] = { "precise", "approximate", "other" };
    const struct dag *dag = p->dag;
    int i, k, at = 0;
    for (i = 0; i < s->node_count; i++) {
        const struct node *n = &dag->nodes[dag->order[p->graph->order.first + i]];
        struct node_statistics *x = &s->nodes[i];
        x->name = n->name;
        x->tool = dag->tools[n->tool].name;
        x->answers = &s->answers[at];
        x->answer_count = n->arcs.count;
        for (k = 0; k < n->arcs.count; k++, at++) {
            const struct answer *a = &dag->answers[dag->tools[n->tool].answers.first + k];
            s->answers[at].name = a->name;
            s->answers[at].kind = dag->tools[n->tool].kind == TOOL_COMMAND ? "command" : kinds[a->kind];
            s->answers[at].target = dag->arcs[n->arcs.first + k].target.name;
            s->answers[at].count = sum_taken(p, at);
            x->calls += s->answers[at].count;
        }
    }
}

int statistics_take(struct statistics *s, const struct refiner *r)
{
    const struct program *p = r->own;
    int i, k, m;
    memset(s, 0, sizeof *s);
    if (strcmp(r->release, "dag") != 0 || !p->tallies)
        return -1;
    s->node_count = p->graph->order.count;
    s->nodes = calloc((size_t)s->node_count, sizeof *s->nodes);
    s->answers = calloc((size_t)p->answer_count + 1, sizeof *s->answers);
    if (!s->nodes || !s->answers) {
        statistics_free(s);
        return -1;
    }
    take_nodes(s, p);
    for (i = 0; i < p->tally_count; i++) {
        const struct tally *t = p->tallies[i];
        for (k = 0; k < STATISTICS_COUNTS; k++)
            s->counts[k] += t->counts[k];
        for (k = 0; k < STATISTICS_SLOTS; k++) {
            s->records[k].zero += t->records[k].zero;
            for (m = 0; m < STATISTICS_HIGH - STATISTICS_LOW; m++)
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
