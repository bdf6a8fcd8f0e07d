/* check_waves.c - the release in waves: whatever blocks the pairs stand in and on any number of
 * threads, refinement is the flat release's to the bit.
 *
 * Random rooms, each solved by every built-in oracle: compiled for one pair on one thread, then in
 * waves of 1, 7 and 256 pairs on 1, 2 and 3 threads. Links, their order, elements and radiosities
 * must be the same. (check_widths.sh: whatever the width of vectors, too.)
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <stdatomic.h>
#include <stdio.h>
#include "engine/solve.h"
#include "make_solve.h"
#include "random_room.h"
#include "oracle/builtin.h"
#include "suite.h"
#include "wave.h"

enum { SCENES = 14 };

static const int lengths[] = {1, 7, WAVE_PAIRS};

/* A refiner that gives the real one blocks of `length` at the most. */
struct cut {
    const struct refiner *refiner;
    int length;
    atomic_long pairs, together; /* all; those that were not alone in a block of the engine's */
};

static void cut_wave(const void *state, struct discussion *block, int count,
                     enum decision *decisions)
{
    struct cut *cut = *(struct cut *const *)state;
    atomic_fetch_add(&cut->pairs, count);
    atomic_fetch_add(&cut->together, count > 1 ? count : 0);
    for (int from = 0; from < count; from += cut->length)
        cut->refiner->wave(cut->refiner->state, block + from,
                           count - from < cut->length ? count - from : cut->length,
                           decisions + from);
}

static struct refiner *open_release(const char *oracle, enum release release)
{
    static char *const settings[] = {"min_share=1e-2"};
    struct refiner *r = oracles_open(oracle, release);
    ck_assert_ptr_nonnull(r);
    ck_assert_int_eq(oracles_set(r, settings, 1), 0);
    return r;
}

/* Returns how many discussions were held. */
static uint64_t compare_waves(const char *oracle, const struct scene *scene)
{
    struct refiner *flat = open_release(oracle, RELEASE_FLAT),
                   *wave = open_release(oracle, RELEASE_WAVE);
    struct solve one, other;
    ck_assert(!flat->wave);
    ck_assert(wave->wave);
    solve_by(&one, scene, flat, 1);
    for (int i = 0; i < 3; i++) {
        struct cut cut = {.refiner = wave, .length = lengths[i]}, *at = &cut;
        struct refiner asking = *wave;
        asking.wave = cut_wave;
        asking.state = &at;
        solve_by(&other, scene, &asking, 1 + i);
        same_solves(&one, &other);
        ck_assert_int_eq(cut.pairs, (long)other.refinement.pairs);
        ck_assert_int_gt(cut.together, cut.pairs / 2);
        solve_close(&other);
    }
    const uint64_t pairs = one.refinement.pairs;
    solve_close(&one);
    refiner_close(flat);
    refiner_close(wave);
    return pairs;
}

START_TEST(test_random_rooms)
{
    const char *oracle = builtins[_i].name;
    const int count = thorough() ? SCENES : 1;
    uint64_t pairs = 0;
    for (int i = 0; i < count; i++) {
        struct scene scene;
        random_room(&scene, (unsigned)(1 + _i * SCENES + i));
        pairs += compare_waves(oracle, &scene);
        made_close(&scene);
    }
    printf("%-16s %3d rooms, %8llu discussions, the same in waves of 1, 7 and 256\n", oracle, count,
           (unsigned long long)pairs);
    fflush(stdout);
}
END_TEST

int main(void)
{
    int count = 0;
    while (builtins[count].name)
        count++;
    Suite *suite = suite_create("waves");
    TCase *c = tcase_create("waves");
    tcase_set_timeout(c, 300);
    tcase_add_loop_test(c, test_random_rooms, 0, count);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
