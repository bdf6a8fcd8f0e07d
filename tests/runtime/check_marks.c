/* check_marks.c - marks that discussions give elements: the rounds to come see them, an element
 * keeps the first that it is given, of those given in one round the least; parts begin with the
 * mark of what they are parts of; on any number of threads.
 *
 * A refiner of our own gives marks by a hash and notes each under a lock; after every round the
 * elements are held against these notes.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <pthread.h>
#include <string.h>
#include "discussion.h"
#include "engine/exchange_tree.h"
#include "engine/refine.h"
#include "make_solve.h"
#include "suite.h"
#include "tools/clusters.h"
#include "tools/mark_emitter.h"
#include "tools/mark_receiver.h"
#include "tools/marked.h"

enum { ELEMENTS = 4096, NONE = 8 };

struct notes {
    pthread_mutex_t lock;
    const struct hierarchy *h;
    unsigned char least[ELEMENTS], before[ELEMENTS]; /* of this round; the marks at its begin */
    uint32_t count;                                  /* elements then */
    int given, conflicts, refused, inherited;
};

static void note(struct notes *n, const struct element *e, int mark, int done)
{
    uint32_t i = (uint32_t)(e - n->h->elements);
    ck_assert_uint_lt(i, ELEMENTS);
    pthread_mutex_lock(&n->lock);
    ck_assert_uint_eq(e->mark, n->before[i]); /* nothing changes during a round */
    ck_assert_int_eq(done, !e->mark || (int)e->mark == mark);
    n->refused += !done;
    n->given += done;
    n->conflicts += done && n->least[i] != NONE && n->least[i] != mark;
    if (done && mark < n->least[i])
        n->least[i] = (unsigned char)mark;
    pthread_mutex_unlock(&n->lock);
}

/* The number of (pair, salt), below n. */
static int pick(const struct discussion *d, uint64_t salt, uint64_t n)
{
    return (int)((d->receiver->id * 3 + d->emitter->id * 7 + salt) * 0x9E3779B97F4A7C15u >> 40)
           % (int)n;
}

static enum decision give_marks(const void *state, struct discussion *d)
{
    struct notes *n = *(struct notes *const *)state;
    switch (tool_clusters(d)) {
    case CLUSTERS_SURFACES:
        break;
    case CLUSTERS_APART:
        return DECISION_STOP;
    case CLUSTERS_RECEIVER:
        return DECISION_SUBDIVIDE_RECEIVER;
    case CLUSTERS_EMITTER:
        return DECISION_SUBDIVIDE_EMITTER;
    }
    if (pick(d, 1, 2) == 0) {
        int mark = 1 + pick(d, 2, 7);
        note(n, d->receiver, mark, tool_mark_receiver(d, mark) == MARK_RECEIVER_DONE);
        ck_assert(tool_marked(d, term_receiver_mark(d)) != MARKED_NONE); /* at once, here */
    }
    if (pick(d, 3, 2) == 0) {
        int mark = 1 + pick(d, 4, 7);
        note(n, d->emitter, mark, tool_mark_emitter(d, mark) == MARK_EMITTER_DONE);
    }
    return d->receiver->depth < 3 && pick(d, 5, 2) ? DECISION_SUBDIVIDE_RECEIVER : DECISION_STOP;
}

static int look(void *context, const struct refinement *r)
{
    struct notes *n = context;
    const struct hierarchy *h = r->hierarchy;
    ck_assert_uint_le(h->count, ELEMENTS);
    for (uint32_t i = 0; i < n->count; i++)
        ck_assert_uint_eq(h->elements[i].mark, n->before[i]         ? n->before[i]
                                               : n->least[i] < NONE ? n->least[i]
                                                                    : 0);
    for (uint32_t i = n->count; i < h->count; i++) {
        ck_assert_uint_eq(h->elements[i].mark, h->elements[h->elements[i].parent].mark);
        n->inherited += h->elements[i].mark > 0;
    }
    n->count = h->count;
    for (uint32_t i = 0; i < h->count; i++)
        n->before[i] = (unsigned char)h->elements[i].mark;
    memset(n->least, NONE, sizeof n->least);
    return 0;
}

START_TEST(test_marks)
{
    static unsigned char first[ELEMENTS];
    for (int threads = 1; threads <= 2; threads++) {
        static struct notes notes;
        struct notes *n = &notes;
        struct scene scene;
        furnace_cube(&scene, 0.5);
        struct exchange_tree tree;
        const char *cause;
        ck_assert_int_eq(exchange_tree_open(&tree, scene.faces, scene.face_count, threads, &cause),
                         0);
        notes = (struct notes){.h = &tree.h, .count = tree.h.count};
        memset(notes.least, NONE, sizeof notes.least);
        ck_assert_int_eq(pthread_mutex_init(&notes.lock, NULL), 0);
        const struct refiner refiner = {.refine = give_marks, .state = &n};
        struct refinement r;
        ck_assert_int_eq(refinement_open(&r, &tree.h, &tree.host, &refiner,
                                         limits_complete((struct limits){0}, NULL), threads),
                         0);
        r.watch = look;
        r.watch_context = n;
        ck_assert_int_eq(refinement_start(&r), 0);
        printf("marks: %d given, %d against another of the round, %d refused, %d parts marked, %u "
               "elements\n",
               notes.given, notes.conflicts, notes.refused, notes.inherited, tree.h.count);
        ck_assert_int_gt(notes.conflicts, 10);
        ck_assert_int_gt(notes.refused, 10);
        ck_assert_int_gt(notes.inherited, 10);
        if (threads == 1)
            memcpy(first, notes.before, sizeof first);
        else
            ck_assert_mem_eq(first, notes.before, sizeof first);
        refinement_close(&r);
        exchange_tree_close(&tree);
        made_close(&scene);
        pthread_mutex_destroy(&notes.lock);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("marks");
    TCase *c = tcase_create("marks");
    tcase_add_test(c, test_marks);
    suite_add_tcase(suite, c);
    return suite_failures(suite) ? 1 : 0;
}
