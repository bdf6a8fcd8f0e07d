/* statistics.c - see statistics.h: from the numbers that threads counted to what a program is
 * shown.
 *
 * All numbers are whole, so their sums are the same for any number of threads; only times differ.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "oracle/counting.h"
#include "oracle/follow.h"
#include "oracle/statistics.h"
#include "util/array.h"

static void sum_numbers(const struct program *p, uint64_t *sum)
{
    memset(sum, 0, p->number_count * sizeof *sum);
    for (const struct tally *t = p->tallies; t; t = t->next)
        for (size_t i = 0; i < p->number_count; i++)
            sum[i] += t->numbers[i];
}

int statistics_end_pass(const struct refiner *r)
{
    if (r->refine != program_walk_counted)
        return 0;
    struct program *p = ((const struct program *)r->own)->self;
    if (array_reserve(&p->passes, (p->pass_count + 1) * p->number_count, &p->pass_capacity,
                      sizeof *p->passes)
        < 0)
        return -1;
    sum_numbers(p, p->passes + p->pass_count++ * p->number_count);
    return 0;
}

static double scaled_seconds(uint64_t nanoseconds, uint64_t timed, uint64_t calls)
{
    return timed ? 1e-9 * (double)nanoseconds * (double)calls / (double)timed : 0;
}

/* ---- nodes */

/* The nodes from `numbers`, counted since `since` (NULL: since the beginning), as the view `view`:
 * 0, or one more than the pass. */
static void show_nodes(struct statistics *s, const struct program *p, size_t view,
                       const uint64_t *numbers, const uint64_t *since)
{
    const size_t steps = (size_t)p->graph->order.count, stride = (size_t)program_stride();
    struct RadAnswerCount *answer = s->answers + view * (size_t)p->answer_count;
    struct RadTermCount *term = s->terms + view * steps * (size_t)term_table_count;
    size_t arc = 0;
    for (size_t i = 0; i < steps; i++) {
        const struct node *n = dag_node_at(p->dag, p->graph, (int)i);
        struct RadNodeCount *x = &s->nodes[view * steps + i];
        const size_t own = (size_t)p->answer_count + i * stride;
        *x = (struct RadNodeCount){.name = n->name,
                                   .tool = p->dag->tools[n->tool].name,
                                   .answers = answer,
                                   .answer_count = n->arcs.count,
                                   .terms = term};
        for (int k = 0; k < n->arcs.count; k++, arc++, answer++) {
            const struct RadAnswer said = follow_said(p, (int)i, k);
            *answer = (struct RadAnswerCount){said.answer, said.kind, said.target,
                                              numbers[arc] - (since ? since[arc] : 0)};
            x->calls += answer->count;
        }
        uint64_t at[NUMBER_TERMS];
        for (size_t k = 0; k < NUMBER_TERMS; k++)
            at[k] = numbers[own + k] - (since ? since[own + k] : 0);
        x->timed = at[NUMBER_TIMED];
        x->seconds = scaled_seconds(at[NUMBER_NANOSECONDS], x->timed, x->calls);
        x->rays = at[NUMBER_RAYS];
        x->lists = at[NUMBER_LISTS];
        memcpy(x->vectors, at + NUMBER_VECTORS, sizeof x->vectors);
        for (size_t k = 0; k < (size_t)term_table_count; k++) {
            size_t of = own + NUMBER_TERMS + k;
            uint64_t count = numbers[of] - (since ? since[of] : 0);
            if (count)
                *term++ = (struct RadTermCount){term_table[k].name, count};
        }
        x->term_count = (int)(term - x->terms);
    }
}

static void show_passes(struct statistics *s, const struct program *p)
{
    const size_t steps = (size_t)p->graph->order.count;
    for (size_t i = 0; i < p->pass_count; i++) {
        struct RadPass *pass = &s->passes[i];
        const uint64_t *numbers = p->passes + i * p->number_count;
        show_nodes(s, p, i + 1, numbers, i > 0 ? numbers - p->number_count : NULL);
        *pass = (struct RadPass){.nodes = s->nodes + (i + 1) * steps};
        pass->discussions = pass->nodes[0].calls;
        for (size_t k = 0; k < steps; k++) {
            pass->rays += pass->nodes[k].rays;
            pass->seconds += pass->nodes[k].seconds;
        }
    }
}

/* ---- paths */

static double path_seconds(const struct path_count *path)
{
    return scaled_seconds(path->nanoseconds, path->timed, path->count);
}

static int by_number(const void *a, const void *b)
{
    const struct path_count *x = a, *y = b;
    return (x->number > y->number) - (x->number < y->number);
}

static int by_cost(const void *a, const void *b)
{
    const struct path_count *x = a, *y = b;
    double left = path_seconds(x), right = path_seconds(y);
    if (left != right)
        return left < right ? 1 : -1;
    return x->count != y->count ? (x->count < y->count ? 1 : -1) : by_number(a, b);
}

/* The paths of all tallies, each once, in *paths. Returns how many, or -1 when out of memory. */
static long gather_paths(const struct program *p, struct path_count **paths)
{
    size_t all = 0, distinct = 0;
    for (const struct tally *t = p->tallies; t; t = t->next)
        all += t->path_count;
    struct path_count *to = malloc((all + 1) * sizeof *to);
    if (!to)
        return -1;
    all = 0;
    for (const struct tally *t = p->tallies; t; t = t->next)
        for (size_t i = 0; i < t->path_capacity; i++)
            if (t->paths[i].count)
                to[all++] = t->paths[i];
    qsort(to, all, sizeof *to, by_number);
    for (size_t i = 0; i < all; i++)
        if (distinct > 0 && to[distinct - 1].number == to[i].number) {
            to[distinct - 1].count += to[i].count;
            to[distinct - 1].timed += to[i].timed;
            to[distinct - 1].nanoseconds += to[i].nanoseconds;
        } else
            to[distinct++] = to[i];
    qsort(to, distinct, sizeof *to, by_cost);
    *paths = to;
    return (long)distinct;
}

/* The way that a number stands for: nodes in steps[0..], answers in answers[0..]. Returns how many
 * of each. */
static int follow(const struct program *p, uint64_t number, int *steps, int *answers)
{
    int length = 0;
    for (int at = 0; at >= 0; length++) {
        steps[length] = at;
        answers[length] = follow_step(p, at, &number);
        at = p->steps[at].next[answers[length]];
    }
    return length;
}

/* Returns 0, or -1 when out of memory. */
static int show_paths(struct statistics *s, const struct program *p)
{
    const size_t steps = (size_t)p->graph->order.count;
    struct path_count *paths;
    long distinct = gather_paths(p, &paths);
    if (distinct < 0)
        return -1;
    int count = distinct < RAD_PATHS ? (int)distinct : RAD_PATHS;
    for (int i = 0; i < count; i++) {
        int *at = s->steps + (size_t)i * 2 * steps;
        s->paths[i] = (struct RadPath){.nodes = at,
                                       .answers = at + steps,
                                       .length = follow(p, paths[i].number, at, at + steps),
                                       .count = paths[i].count,
                                       .timed = paths[i].timed,
                                       .seconds = path_seconds(&paths[i])};
    }
    free(paths);
    s->shown.paths = s->paths;
    s->shown.path_count = count;
    s->shown.distinct_paths = (uint64_t)distinct;
    return 0;
}

/* ---- all together */

/* Room for it all. Returns 0, or -1. */
static int make_room(struct statistics *s, const struct program *p)
{
    const size_t views = p->pass_count + 1, steps = (size_t)p->graph->order.count;
    s->nodes = calloc(views * steps, sizeof *s->nodes);
    s->answers = calloc(views * (size_t)p->answer_count + 1, sizeof *s->answers);
    s->terms = calloc(views * steps * (size_t)term_table_count + 1, sizeof *s->terms);
    s->passes = calloc(views, sizeof *s->passes);
    s->paths = calloc(RAD_PATHS, sizeof *s->paths);
    s->steps = calloc(RAD_PATHS * 2 * steps, sizeof *s->steps);
    return s->nodes && s->answers && s->terms && s->passes && s->paths && s->steps ? 0 : -1;
}

static void sum_kept(struct statistics *s, const struct program *p)
{
    for (const struct tally *t = p->tallies; t; t = t->next) {
        for (int k = 0; k < RAD_COUNTS; k++)
            s->counts[k] += t->counts[k];
        for (int k = 0; k < RAD_RECORDS; k++) {
            s->zero[k] += t->zero[k];
            for (int m = 0; m < RAD_BINS; m++)
                s->bins[k][m] += t->bins[k][m];
        }
    }
}

int statistics_take(struct statistics *s, const struct refiner *r)
{
    const struct program *p = r->own;
    memset(s, 0, sizeof *s);
    if (r->refine != program_walk_counted || p->lost)
        return -1;
    uint64_t *numbers = calloc(p->number_count + 1, sizeof *numbers);
    if (!numbers || make_room(s, p) < 0 || show_paths(s, p) < 0) {
        free(numbers);
        statistics_free(s);
        return -1;
    }
    sum_numbers(p, numbers);
    show_nodes(s, p, 0, numbers, NULL);
    free(numbers);
    show_passes(s, p);
    sum_kept(s, p);
    s->shown.nodes = s->nodes;
    s->shown.node_count = p->graph->order.count;
    s->shown.counts = s->counts;
    s->shown.bins = (const uint64_t(*)[RAD_BINS])s->bins;
    s->shown.zero = s->zero;
    s->shown.passes = s->passes;
    s->shown.pass_count = (int)p->pass_count;
    return 0;
}

void statistics_free(struct statistics *s)
{
    free(s->nodes);
    free(s->answers);
    free(s->terms);
    free(s->passes);
    free(s->paths);
    free(s->steps);
    memset(s, 0, sizeof *s);
}
