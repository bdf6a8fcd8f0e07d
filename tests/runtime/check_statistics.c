/* check_statistics.c - counts of an interpreted graph against those of the refinement.
 * SPDX-License-Identifier: MIT */
#include <pthread.h>
#include <stdio.h>
#include <time.h>
#include "runtime/make_solve.h"
#include "oracle/statistics.h"
#include "oracles.h"
#include "suite.h"
#include "wave.h"

/* An oracle that counts depths and records what links bring. */
static const char counting[] =
    "oracle counting \"bf, counted\" { start level;\n"
    "  node level = clusters() { surfaces -> planes;  apart -> stop;  receiver -> "
    "subdivide_receiver;  emitter -> subdivide_emitter; }\n"
    "  node planes = support_planes() { away -> stop;  otherwise -> deep; }\n"
    "  node deep = count(as = receiver.depth) { done -> energy; }\n"
    "  node energy = transfer(relative = 0.2) { dark -> stop;  below -> few;  above -> guard; }\n"
    "  node guard = can_split(min_share = 1e-3) { both -> side;  neither -> few;\n"
    "                         receiver -> subdivide_receiver;  emitter -> subdivide_emitter; }\n"
    "  node side = larger() { receiver -> subdivide_receiver;  emitter -> subdivide_emitter; }\n"
    "  node few = visibility(rays = 16) { none -> stop;  partial | all -> form; }\n"
    "  node form = form_factor() { done -> note; }\n"
    "  node note = record(value = emitter.radiosity * form_factor / scene.irradiance, slot = 3) { "
    "done -> known; }\n"
    "  node known = record(value = 0.75) { done -> link; }\n"
    "}\n";

/* Counting changes nothing, and the counts are those of the refinement: every pair came in at the
 * start, every node was asked as often as arcs led to it, every decision taken as often as it was
 * carried out. */
START_TEST(test_statistics)
{
    static const char *const decisions[] = {"link", "stop", "subdivide_receiver",
                                            "subdivide_emitter", "subdivide_both"};
    struct solve s, plain;
    struct solve_options options = quick(2);
    uint64_t deep = 0, noted = 0, sum[5] = {0};
    struct scene scene;
    furnished(&scene, 1);
    struct refiner *r = interpreted("counting.dag", counting, NULL);
    struct refiner *other = interpreted("counting.dag", counting, NULL);
    ck_assert_ptr_nonnull(r);
    struct statistics counted;
    ck_assert_int_eq(statistics_take(&counted, r), -1); /* not asked for */
    ck_assert_int_eq(refiner_count(r), 0);
    const char *cause;
    ck_assert_int_eq(solve_open(&s, &scene, &options, &cause), 0);
    ck_assert_int_eq(solve_run(&s, r, &cause), 0);
    ck_assert_int_eq(solve_open(&plain, &scene, &options, &cause), 0);
    ck_assert_int_eq(solve_run(&plain, other, &cause), 0);
    same_links(&s, &plain);
    ck_assert_int_eq(statistics_take(&counted, r), 0);
    ck_assert_str_eq(counted.shown.nodes[0].name, "level");
    ck_assert_uint_eq(counted.shown.nodes[0].calls, s.refinement.pairs);
    for (int i = 0; i < counted.shown.node_count; i++) {
        const struct RadNodeCount *n = &counted.shown.nodes[i];
        uint64_t in = i == 0 ? s.refinement.pairs : 0, out = 0;
        for (int j = 0; j < counted.shown.node_count; j++)
            for (int k = 0; k < counted.shown.nodes[j].answer_count; k++)
                in += strcmp(counted.shown.nodes[j].answers[k].target, n->name) == 0
                          ? counted.shown.nodes[j].answers[k].count
                          : 0;
        for (int k = 0; k < n->answer_count; k++) {
            out += n->answers[k].count;
            for (int j = 0; j < 5; j++)
                sum[j] += strcmp(n->answers[k].target, decisions[j]) == 0 ? n->answers[k].count : 0;
        }
        ck_assert_uint_eq(in, n->calls);
        ck_assert_uint_eq(out, n->calls);
        if (strcmp(n->name, "deep") == 0)
            deep = n->calls;
        if (strcmp(n->name, "note") == 0)
            noted = n->calls;
    }
    for (int j = 0; j < 5; j++)
        ck_assert_uint_eq(sum[j], s.refinement.decided[j]);
    for (int i = 0; i < RAD_COUNTS; i++)
        deep -= counted.counts[i];
    ck_assert_uint_eq(deep, 0);
    ck_assert_uint_gt(counted.counts[0], 0);
    ck_assert_uint_gt(counted.counts[1], 0);
    ck_assert_uint_eq(counted.counts[25], 0); /* can_split ends at 24 */
    ck_assert_uint_gt(noted, 100);
    /* 0.75 lies in [1/2, 1) */
    ck_assert_uint_eq(counted.bins[0][-1 - STATISTICS_LOW], noted);
    noted -= counted.zero[3];
    for (int i = 0; i < STATISTICS_HIGH - STATISTICS_LOW; i++) {
        noted -= counted.bins[3][i];
        /* no B is above 20 W/m2, and F <= 1 */
        if (ldexp(1, STATISTICS_LOW + i) > 20 / rays_host(s.problem.rays)->irradiance)
            ck_assert_uint_eq(counted.bins[3][i], 0);
    }
    ck_assert_uint_eq(noted, 0);
    statistics_free(&counted);
    solve_close(&s);
    solve_close(&plain);
    refiner_close(r);
    refiner_close(other);
    made_close(&scene);
}
END_TEST

/* What a spy sees of the blocks that the engine hands to a counted graph: after each, what every
 * node was called more, of which a list is made. */
enum { NODES = 32 };

struct spy {
    const struct refiner *refiner;
    uint64_t called[NODES], lists[NODES], vectors[NODES][RAD_WIDTHS], blocks;
};

static void spy_wave(const void *state, struct discussion *block, int count,
                     enum decision *decisions)
{
    struct spy *spy = *(struct spy *const *)state;
    struct statistics s;
    spy->refiner->wave(spy->refiner->state, block, count, decisions);
    ck_assert_int_le(count, WAVE_PAIRS);
    ck_assert_int_eq(statistics_take(&s, spy->refiner), 0);
    ck_assert_int_le(s.shown.node_count, NODES);
    spy->blocks++;
    for (int i = 0; i < s.shown.node_count; i++) {
        const uint64_t pairs = s.shown.nodes[i].calls - spy->called[i];
        spy->called[i] += pairs;
        spy->lists[i] += pairs > 0;
        for (int k = 0; k < RAD_WIDTHS; k++)
            for (uint64_t left = pairs, width = 4u << k; left; left -= left < width ? left : width)
                spy->vectors[i][k]++;
    }
    statistics_free(&s);
}

/* The lists that a release in waves would ask are those of the blocks, on any number of threads. */
START_TEST(test_lists)
{
    struct scene scene;
    struct solve s;
    struct statistics one, other;
    const char *cause;
    furnished(&scene, 1);
    struct refiner *r = interpreted("counting.dag", counting, NULL);
    ck_assert_ptr_nonnull(r);
    ck_assert_int_eq(refiner_count(r), 0);
    struct spy spy = {.refiner = r}, *at = &spy;
    struct refiner asking = *r;
    struct solve_options options = quick(1);
    asking.wave = spy_wave;
    asking.state = &at;
    ck_assert_int_eq(solve_open(&s, &scene, &options, &cause), 0);
    ck_assert_int_eq(solve_run(&s, &asking, &cause), 0);
    solve_close(&s);
    ck_assert_int_eq(statistics_take(&one, r), 0);
    ck_assert_uint_eq(one.shown.nodes[0].lists, spy.blocks);
    ck_assert_uint_gt(one.shown.nodes[0].calls, 20 * spy.blocks);
    ck_assert_int_eq(refiner_count(r), 0);
    options = quick(3);
    ck_assert_int_eq(solve_open(&s, &scene, &options, &cause), 0);
    ck_assert_int_eq(solve_run(&s, r, &cause), 0);
    solve_close(&s);
    ck_assert_int_eq(statistics_take(&other, r), 0);
    for (int i = 0; i < one.shown.node_count; i++) {
        const struct RadNodeCount *a = &one.shown.nodes[i], *b = &other.shown.nodes[i];
        ck_assert_uint_eq(a->lists, spy.lists[i]);
        ck_assert_uint_eq(b->lists, spy.lists[i]);
        for (int k = 0; k < RAD_WIDTHS; k++) {
            ck_assert_uint_eq(a->vectors[k], spy.vectors[i][k]);
            ck_assert_uint_eq(b->vectors[k], spy.vectors[i][k]);
        }
    }
    statistics_free(&one);
    statistics_free(&other);
    refiner_close(r);
    made_close(&scene);
}
END_TEST

/* Threads of a program's own, not OpenMP's, and two graphs that the same threads ask in turns. */
enum { THREADS = 4, ASKED = 20000 };

struct asked {
    struct refiner *refiners[2];
};

static void *ask_in_turns(void *at)
{
    const struct asked *asked = at;
    const struct host host = {.occluded = NULL,
                              .area = 1,
                              .extent = 1,
                              .exitance = 1,
                              .irradiance = 1,
                              .radiosity = 1,
                              .importance = 1};
    for (int i = 0; i < ASKED; i++) {
        const struct refiner *r = asked->refiners[i % 3 == 0];
        struct element element = {.area = 1, .radius = 1, .depth = (uint8_t)(i & 3)};
        struct discussion d = {.receiver = &element, .emitter = &element, .host = &host};
        (void)r->refine(r->state, &d);
    }
    return NULL;
}

START_TEST(test_threads)
{
    static const char text[] = "oracle turns { start deep;\n"
                               "  node deep = count(as = receiver.depth) { done -> kind; }\n"
                               "  node kind = larger() { receiver | emitter -> stop; } }\n";
    const uint64_t wanted[2] = {THREADS * (ASKED - (ASKED + 2) / 3), THREADS * ((ASKED + 2) / 3)};
    struct asked asked;
    for (int k = 0; k < 2; k++) {
        asked.refiners[k] = interpreted("turns.dag", text, NULL);
        ck_assert_ptr_nonnull(asked.refiners[k]);
    }
    pthread_t threads[THREADS];
    struct statistics counted;
    /* the second time from 0, by threads that know the first */
    for (int again = 0; again < 2; again++) {
        for (int k = 0; k < 2; k++)
            ck_assert_int_eq(refiner_count(asked.refiners[k]), 0);
        for (int t = 1; t < THREADS; t++)
            ck_assert_int_eq(pthread_create(&threads[t], NULL, ask_in_turns, &asked), 0);
        (void)ask_in_turns(&asked);
        for (int t = 1; t < THREADS; t++)
            ck_assert_int_eq(pthread_join(threads[t], NULL), 0);
        for (int k = 0; k < 2; k++) {
            uint64_t sum = 0;
            ck_assert_int_eq(statistics_take(&counted, asked.refiners[k]), 0);
            ck_assert_uint_eq(counted.shown.nodes[0].calls, wanted[k]);
            ck_assert_uint_eq(counted.shown.nodes[1].calls, wanted[k]);
            for (int i = 0; i < 4; i++)
                sum += counted.counts[i];
            ck_assert_uint_eq(sum, wanted[k]);
            ck_assert_uint_gt(counted.counts[3], 0);
            statistics_free(&counted);
        }
    }
    for (int k = 0; k < 2; k++)
        refiner_close(asked.refiners[k]);
}
END_TEST

/* Ways through a graph of few, each by what it must be; and the arcs between, by their sums. */
START_TEST(test_paths)
{
    static const char text[] = "oracle ways { start which;\n"
                               "  node which = larger() { receiver | emitter -> deep; }\n"
                               "  node deep = can_split(min_area = 2) { both -> stop;\n"
                               "    receiver | emitter -> form;  neither -> note; }\n"
                               "  node note = mark(as = 1) { done -> form; }\n"
                               "  node form = mark(as = 2) { done -> stop; } }\n";
    static const struct {
        double receiver, emitter; /* areas: which is larger, who may be split */
        int count, length;
        const char *way[4];
    } cases[] = {{9, 9, 7, 2, {"receiver", "both"}},
                 {1, 9, 5, 3, {"emitter", "emitter", "done"}},
                 {9, 1, 3, 3, {"receiver", "receiver", "done"}},
                 {1, 2, 2, 4, {"emitter", "neither", "done", "done"}}};
    enum { CASES = sizeof cases / sizeof *cases };
    struct refiner *r = interpreted("ways.dag", text, NULL);
    ck_assert_int_eq(refiner_count(r), 0);
    const struct host host = {.area = 1};
    for (int c = 0; c < CASES; c++)
        for (int i = 0; i < cases[c].count; i++) {
            struct element receiver = {.area = cases[c].receiver, .vertices = 4},
                           emitter = {.area = cases[c].emitter, .vertices = 4};
            struct discussion d = {.receiver = &receiver, .emitter = &emitter, .host = &host};
            (void)r->refine(r->state, &d);
            ck_assert_ptr_eq(d.host, &host);
            if (c == 1 && i == 0) /* the first seven and one are the first pass */
                ck_assert_int_eq(statistics_end_pass(r), 0);
        }
    ck_assert_int_eq(statistics_end_pass(r), 0);
    struct statistics counted;
    ck_assert_int_eq(statistics_take(&counted, r), 0);
    const struct RadStatistics *s = &counted.shown;
    ck_assert_uint_eq(s->distinct_paths, CASES);
    ck_assert_int_eq(s->path_count, CASES);
    int found = 0;
    for (int p = 0; p < s->path_count; p++)
        for (int c = 0; c < CASES; c++) {
            int same = s->paths[p].length == cases[c].length;
            for (int k = 0; same && k < cases[c].length; k++) {
                const struct RadNodeCount *n = &s->nodes[s->paths[p].nodes[k]];
                same = strcmp(n->answers[s->paths[p].answers[k]].name, cases[c].way[k]) == 0;
            }
            if (same)
                ck_assert_uint_eq(s->paths[p].count, (uint64_t)cases[c].count);
            found += same;
        }
    ck_assert_int_eq(found, CASES);
    ck_assert_int_eq(s->pass_count, 2);
    ck_assert_uint_eq(s->passes[0].discussions, 8);
    ck_assert_uint_eq(s->passes[1].discussions, 9);
    /* mark is a term: note makes it, form finds it as good as it will be */
    for (int i = 0; i < s->node_count; i++) {
        const struct RadNodeCount *n = &s->nodes[i];
        uint64_t made = strcmp(n->name, "note") == 0 ? 2 : strcmp(n->name, "form") == 0 ? 8 : 0;
        ck_assert_uint_eq(n->term_count ? n->terms[0].count : 0, made);
        if (made)
            ck_assert_str_eq(n->terms[0].name, "mark");
    }
    statistics_free(&counted);
    refiner_close(r);
}
END_TEST

/* Seconds of the nodes `form` and `side` of an oracle that is asked ASKS times, and of the thread.
 */
enum { ASKS = 20000 };
struct times {
    double form, side, own;
    unsigned long long timed;
};

static struct times ask_slowly(struct refiner *r)
{
    struct element low = {.area = 1,
                          .vertices = 4,
                          .normal = {0, 0, 1},
                          .radius = 0.71,
                          .centre = {.5, .5, 0},
                          .vertex = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}},
                   high = {.area = 1,
                           .vertices = 4,
                           .normal = {0, 0, -1},
                           .radius = 0.71,
                           .centre = {.5, .5, 1},
                           .vertex = {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}};
    const struct host host = {.area = 6, .extent = 1};
    struct timespec from, to;
    ck_assert_int_eq(refiner_count(r), 0);
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &from);
    for (int i = 0; i < ASKS; i++) {
        struct discussion d = {.receiver = &low, .emitter = &high, .host = &host};
        (void)r->refine(r->state, &d);
    }
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &to);
    struct statistics counted;
    ck_assert_int_eq(statistics_take(&counted, r), 0);
    const struct RadNodeCount *form = &counted.nodes[0], *side = &counted.nodes[1];
    ck_assert_uint_eq(form->timed, side->timed);
    struct times t = {form->seconds, side->seconds,
                      difftime(to.tv_sec, from.tv_sec) + 1e-9 * (double)(to.tv_nsec - from.tv_nsec),
                      form->timed};
    statistics_free(&counted);
    return t;
}

/* A node that takes a hundred times as long as another has a hundred times its time, about; all
 * nodes together take most of the thread's own time. A busy machine may spoil a try, not twenty. */
START_TEST(test_times)
{
    static const char text[] = "oracle slow { start form;\n"
                               "  node form = exact_form_factor() { done -> side; }\n"
                               "  node side = larger() { receiver | emitter -> stop; } }\n";
    struct refiner *r = interpreted("slow.dag", text, NULL);
    ck_assert_ptr_nonnull(r);
    int right = 0;
    for (int tries = 0; tries < 20 && !right; tries++) {
        struct times t = ask_slowly(r);
        printf("%.3g s, of them %.3g and %.3g in the nodes; %llu of %d timed\n", t.own, t.form,
               t.side, t.timed, ASKS);
        /* 156 expected; by chance, or because the machine is busy, fewer */
        right = t.timed > ASKS / RAD_TIMED_EVERY / 8 && t.timed < ASKS / RAD_TIMED_EVERY * 3 / 2
                && t.form > 5 * t.side && t.form + t.side < 3 * t.own
                && t.form + t.side > t.own / 3;
    }
    ck_assert(right);
    refiner_close(r);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("statistics");
    TCase *c = tcase_create("statistics");
    tcase_set_timeout(c, 300);
    tcase_add_test(c, test_statistics);
    tcase_add_test(c, test_lists);
    tcase_add_test(c, test_paths);
    tcase_add_test(c, test_times);
    tcase_add_test(c, test_threads);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
