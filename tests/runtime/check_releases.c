/* check_releases.c - every oracle of examples/oracles, discussion by discussion: whatever asks it
 * decides alike and links the same, at every one of its nodes.
 *
 * While a scene is solved, each discussion is held by all: compiled, interpreted, interpreted and
 * counted, interpreted and followed, written by hand where there is such a release, in a block
 * behind itself the other way round; and all of them
 * again with parameters that ask otherwise, which leads to nodes that no solve comes by. Pairs are
 * split, so that there are parts and links that are discussed again. A node that was never asked
 * proves nothing: the suite fails, and lists it.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "engine/exchange.h"
#include "kernel/constants.h"
#include "engine/solve.h"
#include "oracle/builtin.h"
#include "oracle/follow.h"
#include "oracle/program.h"
#include "oracle/statistics.h"
#include "scene/read_scene.h"
#include "util/oracles.h"
#include "suite.h"

enum { SETTINGS = 8, WAYS = 9, NODES_MOST = 2000, PATH_MOST = 400 };

/* Who is asked. */
enum { FLAT, DAG, COUNTED, FOLLOWED, HAND, WAVE, ASKED };
static const char *const asked_names[ASKED] = {"flat",     "interpreted", "counted",
                                               "followed", "hand",        "wave"};

/* A scene and the parameters it is solved with; then others to ask with, besides. */
struct run {
    const char *oracle; /* NULL: every one */
    const char *scene;
    const char *settings[SETTINGS], *otherwise[WAYS - 1][SETTINGS];
    int quick;   /* in every run of the suite, not in thorough ones alone */
    int factors; /* view factors are computed, not light */
};

static const struct run runs[] = {
    {NULL, "cornell", {"min_share=1e-2"}, {{"min_share=1"}}, 1, 0},
    {NULL, "cornell", {"min_share=2e-3"}, {{"min_share=1"}}, 0, 0},
    {NULL, "room", {"min_share=1e-2"}, {{"min_share=1"}}, 0, 0},
    {NULL, "maze_8", {"min_share=3e-2"}, {{"min_share=1"}}, 0, 0},
    {"gap", "room", {"min_share=1e-3"}, {{"min_share=1"}}, 0, 0},
    {"error_control", "room", {"min_share=1e-3"}, {{"min_share=1"}}, 0, 0},
    {"importance", "room", {"min_share=1e-3"}, {{"min_share=1"}}, 0, 0},
    {"masking", "maze_8", {"min_share=2e-3", "bright=0.05"}, {{"min_share=1"}}, 0, 0},
    {"tester",
     "room",
     {"min_share=1", "threshold_1=1e9", "reference=64", "from_faces=0"},
     {{"threshold_1=0", "threshold_2=1e9", "tested_2=1"},
      {"threshold_1=0", "threshold_3=1e9", "tested_3=1"},
      {"threshold_1=0", "threshold_4=1e9", "tested_4=1"},
      {"threshold_1=0", "threshold_5=1e9", "tested_5=1"},
      {"threshold_1=0", "threshold_6=1e9", "tested_6=1"},
      {"threshold_1=0", "threshold_7=1e9", "tested_7=1"},
      {"threshold_1=0", "threshold_8=1e9", "tested_8=1"}},
     0,
     0},
    {"viewfactors",
     "maze_8",
     {"from_faces=0", "shadow=1", "group_shadow=0.1"},
     {{"min_share=1", "from_faces=1000000"}, {"group_shadow=0.001"}},
     0,
     1},
};

enum { RUNS = sizeof runs / sizeof *runs };

/* All that ask, with one set of parameters each. */
struct all {
    struct refiner *by[WAYS][ASKED];
    int ways;
    atomic_ullong discussions, different;
    atomic_uchar reached[NODES_MOST];
};

/* What refinement keeps of it: a link, and what receiver and emitter are marked with. */
struct kept {
    struct link link;
    int marks[2];
};

static struct kept keep(enum decision decision, const struct terms *t)
{
    struct kept k;
    memset(&k, 0, sizeof k);
    k.marks[0] = t->receiver_mark_level ? t->receiver_mark : 0;
    k.marks[1] = t->emitter_mark_level ? t->emitter_mark : 0;
    if (decision_links(decision) || decision == DECISION_STOP)
        link_store(&k.link, decision, t);
    return k;
}

static void note_way(struct all *all, const struct refiner *r, uint64_t way)
{
    struct RadAnswer answers[PATH_MOST];
    int count = follow_way(answers, PATH_MOST, r, way);
    ck_assert_int_le(count, PATH_MOST);
    for (int i = 0; i < count; i++)
        atomic_store_explicit(&all->reached[answers[i].node_number], 1, memory_order_relaxed);
}

/* Behind the same pair the other way round. */
static enum decision ask_in_block(const struct refiner *r, struct discussion *copy)
{
    struct discussion block[2] = {*copy, *copy};
    enum decision decisions[2];
    block[0].receiver = copy->emitter;
    block[0].emitter = copy->receiver;
    block[0].blockers = NULL;
    memset(&block[0].terms, 0, sizeof block[0].terms);
    r->wave(r->state, block, 2, decisions);
    *copy = block[1];
    return decisions[1];
}

/* One of them, on a copy that `copy` becomes. */
static enum decision ask(struct all *all, int way, int who, struct discussion *copy)
{
    const struct refiner *r = all->by[way][who];
    if (who == WAVE)
        return ask_in_block(r, copy);
    if (who != FOLLOWED)
        return r->refine(r->state, copy);
    uint64_t went;
    enum decision decision = follow_ask(r, copy, &went);
    note_way(all, r, went);
    return decision;
}

static enum decision ask_all(const void *state, struct discussion *d)
{
    struct all *all = *(struct all *const *)state;
    enum decision decides = DECISION_STOP;
    const struct discussion start = *d;
    struct blockers list = {0};
    if (d->blockers)
        list = *d->blockers;
    for (int way = 0; way < all->ways; way++) {
        enum decision first = DECISION_STOP;
        struct kept first_kept = {0};
        for (int who = 0; who < ASKED; who++) {
            struct blockers blockers = list;
            struct discussion copy = start;
            if (!all->by[way][who])
                continue;
            if (d->blockers)
                copy.blockers = &blockers;
            int real = way == 0 && who == FLAT; /* the one that goes on */
            enum decision decision = ask(all, way, who, real ? d : &copy);
            struct kept kept = keep(decision, real ? &d->terms : &copy.terms);
            if (who == FLAT) {
                first = decision;
                first_kept = kept;
            } else if (decision != first || memcmp(&kept, &first_kept, sizeof kept) != 0) {
                if (atomic_fetch_add(&all->different, 1) == 0)
                    fprintf(stderr, "%s decides %d, %s %d\n", asked_names[FLAT], (int)first,
                            asked_names[who], (int)decision);
            }
            if (real)
                decides = decision;
        }
    }
    atomic_fetch_add(&all->discussions, 1);
    return decides;
}

static struct refiner *open_one(const char *oracle, int who, const struct run *run, int way)
{
    if (who == HAND && !oracles_by_hand(oracle))
        return NULL;
    struct refiner *r = oracles_open(oracle, who == FLAT   ? RELEASE_FLAT
                                             : who == HAND ? RELEASE_HAND
                                             : who == WAVE ? RELEASE_WAVE
                                                           : RELEASE_DAG);
    ck_assert(r != NULL);
    for (int pass = 0; pass <= (way > 0); pass++) {
        const char *const *settings = pass ? run->otherwise[way - 1] : run->settings;
        int count = 0;
        while (count < SETTINGS && settings[count])
            count++;
        ck_assert_int_eq(oracles_set(r, (char *const *)(void *)(uintptr_t)settings, count), 0);
    }
    if (who == COUNTED)
        ck_assert_int_eq(refiner_count(r), 0);
    if (who == FOLLOWED)
        ck_assert_int_eq(follow_open(r, NULL), 0);
    return r;
}

static void solve_asking(const struct run *run, const struct refiner *asking)
{
    char path[128];
    const char *cause = "";
    const struct scene_options as_written = {.quiet = 1};
    struct scene scene;
    snprintf(path, sizeof path, "examples/scenes/%s.obj", run->scene);
    ck_assert_int_eq(scene_read(&scene, path, &as_written), 0);
    if (run->factors) {
        const struct exchange_options options = {.tolerance = EXCHANGE_TOLERANCE, .threads = 2};
        struct exchange x;
        ck_assert_msg(exchange_open(&x, &scene, asking, &options, &cause) == 0, "%s", cause);
        exchange_close(&x);
    } else {
        const struct solve_options options = {.tolerance = 1e-3, .iterations = 1000, .threads = 2};
        struct solve s;
        ck_assert_msg(solve_open(&s, &scene, &options, &cause) == 0, "%s", cause);
        ck_assert_msg(solve_run(&s, asking, &cause) == 0, "%s", cause);
        solve_close(&s);
    }
    scene_free(&scene);
}

/* One run of one oracle; `reached` collects. */
static void ask_run(const char *oracle, const struct run *run, unsigned char *reached)
{
    struct all *all = calloc(1, sizeof *all);
    ck_assert(all != NULL);
    for (all->ways = 1; all->ways < WAYS && run->otherwise[all->ways - 1][0]; all->ways++)
        ;
    for (int way = 0; way < all->ways; way++)
        for (int who = 0; who < ASKED; who++)
            all->by[way][who] = open_one(oracle, who, run, way);
    struct refiner asking = *all->by[0][FLAT]; /* its parameters and what it reads */
    asking.refine = ask_all;
    asking.state = &all;
    solve_asking(run, &asking);
    printf("%-16s %-8s %8llu discussions, %d ways each, %llu different\n", oracle, run->scene,
           (unsigned long long)all->discussions, all->ways, (unsigned long long)all->different);
    fflush(stdout);
    ck_assert_uint_eq(all->different, 0);
    ck_assert_uint_gt(all->discussions, 10);
    for (int i = 0; i < NODES_MOST; i++)
        reached[i] |= all->reached[i];
    for (int way = 0; way < all->ways; way++)
        for (int who = 0; who < ASKED; who++)
            refiner_close(all->by[way][who]);
    free(all);
}

/* Lists the nodes that were never asked. Returns how many. */
static int list_missed(const char *oracle, const unsigned char *reached)
{
    struct refiner *r = oracles_open(oracle, RELEASE_DAG);
    struct RadAnswer node;
    int missed = 0, count = 0;
    ck_assert(r != NULL && follow_open(r, NULL) == 0);
    for (; follow_answer(&node, r, count, 0) == 0; count++)
        if (!reached[count])
            printf("%s%s%s", missed++ ? ", " : "  never asked: ", node.node, "");
    printf("%s", missed ? "\n" : "");
    fflush(stdout);
    ck_assert_int_le(count, NODES_MOST);
    refiner_close(r);
    return missed;
}

/* Asks so much of a pair that its own runs are enough. */
static int heavy(const char *oracle)
{
    return strcmp(oracle, "tester") == 0 || strcmp(oracle, "viewfactors") == 0;
}

START_TEST(test_every_node)
{
    const char *oracle = builtins[_i].name;
    unsigned char reached[NODES_MOST] = {0};
    for (int i = 0; i < RUNS; i++)
        if ((thorough() || runs[i].quick)
            && (runs[i].oracle ? strcmp(runs[i].oracle, oracle) == 0
                               : runs[i].quick || !heavy(oracle)))
            ask_run(oracle, &runs[i], reached);
    if (!thorough())
        return;
    int missed = list_missed(oracle, reached);
    ck_assert_msg(missed == 0, "%s: %d nodes are never asked", oracle, missed);
}
END_TEST

int main(void)
{
    int count = 0;
    while (builtins[count].name)
        count++;
    Suite *suite = suite_create("releases");
    TCase *c = tcase_create("releases");
    tcase_set_timeout(c, 300);
    tcase_add_loop_test(c, test_every_node, 0, count);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
