/* check_power_balance.c - counts that know that what is emitted is absorbed or lost: exact where
 * all reflect alike, right in the mean and less noisy elsewhere.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include "engine/reflected_light.h"
#include "engine/solve_tracer.h"
#include "particles/power_balance.h"
#include "runtime/make_solve.h"
#include "suite.h"

enum { FEW = 64, SETS = 200 }; /* particles of each replicate; tallies of them */

/* A room whose ceiling shines; `open`: without the last wall. */
static void lit_room(struct scene *scene, double walls, double floor, int open)
{
    const uint32_t m[6] = {1, 2, 0, 0, 0, 0};
    made_open(scene);
    made_material(scene, walls, 0);
    made_material(scene, floor, 0);
    made_material(scene, walls, 2);
    made_room(scene, m, 4, 5, 3);
    scene->face_count -= (uint32_t)open;
    scene->input_count -= (uint32_t)open;
}

static void open_tracer(struct solve *s, struct tracer *t, const struct scene *scene)
{
    const struct solve_options how = quick(1);
    const char *cause;
    ck_assert_int_eq(solve_open(s, scene, &how, &cause), 0);
    *t = solve_tracer(s);
    ck_assert_int_eq(tracer_open(t), 0);
}

static void count(struct tally *y, const struct tracer *t, uint64_t stream, uint64_t particles)
{
    ck_assert_int_eq(tally_open(y, t, stream, 1), 0);
    ck_assert_int_eq(tally_trace(y, t, particles, NULL), 0);
}

/* Walls of one kind: rho / (1 - rho) of what is emitted is reflected, however few particles there
 * are; and each replicate knows it. */
START_TEST(test_white)
{
    struct scene scene;
    struct solve s;
    struct tracer t;
    struct tally y;
    double before, after, noise[2];
    lit_room(&scene, 0.9, 0.9, 0);
    open_tracer(&s, &t, &scene);
    count(&y, &t, 1, FEW);
    before = reflected_light(&s.problem, &y, &noise[0]);
    power_balance(&y, &t);
    after = reflected_light(&s.problem, &y, &noise[1]);
    printf("white: %.4g W, balanced %.6g, of %.6g\n", before, after, 9 * t.lights.power);
    ck_assert_double_gt(fabs(before / (9 * t.lights.power) - 1), 1e-4);
    ck_assert_double_gt(sqrt(noise[0]), 1e-3 * after);
    ck_assert_double_eq_tol(after / (9 * t.lights.power), 1, 1e-6);
    ck_assert_double_lt(sqrt(noise[1]), 1e-6 * after);
    double leaves = 0;
    for (uint32_t e = 0; e < y.elements; e++)
        if (s.hierarchy.elements[e].vertices && !s.hierarchy.elements[e].children)
            leaves += 0.9 * tally_leaf(&y, e, 0);
    ck_assert_double_eq_tol(leaves, after, 1e-6 * after);
    tally_close(&y);
    tracer_close(&t);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Of many tallies: the mean of what each says is reflected (W), how far these differ, and what
 * their replicates say of that (W2). */
struct spread {
    double mean, square, told;
};

static void add_tally(struct spread *x, const struct problem *p, const struct tally *y, int of)
{
    double noise, found = reflected_light(p, y, &noise);
    x->mean += found / of;
    x->square += found * found / of;
    x->told += noise / of;
}

static double variance_of(const struct spread *x)
{
    return x->square - x->mean * x->mean;
}

/* A dark floor, then without one wall, too: the mean of many balanced tallies is that of as many
 * others, they differ less from each other, and by as much as replicates say. */
START_TEST(test_mean)
{
    struct scene scene;
    struct solve s;
    struct tracer t;
    struct spread before = {0, 0, 0}, after = {0, 0, 0};
    lit_room(&scene, 0.95, 0.3, _i);
    open_tracer(&s, &t, &scene);
    for (uint64_t i = 0; i < SETS; i++) {
        struct tally y;
        count(&y, &t, i + 1, FEW);
        add_tally(&before, &s.problem, &y, SETS);
        power_balance(&y, &t);
        add_tally(&after, &s.problem, &y, SETS);
        tally_close(&y);
    }
    const double plain = variance_of(&before), less = variance_of(&after);
    printf("%s: %.5g +- %.2g W, balanced %.5g +- %.2g, replicates say %.2g\n",
           _i ? "open" : "dark floor", before.mean, sqrt(plain), after.mean, sqrt(less),
           sqrt(after.told));
    ck_assert_double_lt(fabs(after.mean - before.mean), 4 * sqrt((plain + less) / SETS));
    ck_assert_double_lt(less, (_i ? 1 : 0.8) * plain);
    ck_assert_double_gt(after.told, 0.7 * less);
    ck_assert_double_lt(after.told, 1.4 * less);
    tracer_close(&t);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* A dark room with a lamp and a slot in a wall, beyond which all is bright: the few particles that
 * get there are reflected twenty times, and both the slope and what it corrects hang on them. */
static void slotted_rooms(struct scene *scene)
{
    enum { DARK, BRIGHT, LAMP };
    const double wall = 4.75;
    made_open(scene);
    made_material(scene, 0.02, 0);
    made_material(scene, 0.95, 0);
    made_material(scene, 0.02, 2);
    for (int room = 0; room < 2; room++) {
        const uint32_t m = room ? BRIGHT : DARK;
        const double x = 4 * room;
        made_quad(scene, m, x, 0, 0, 4, 0, 0, 0, 5, 0);
        made_quad(scene, room ? m : LAMP, x, 0, 3, 0, 5, 0, 4, 0, 0);
        made_quad(scene, m, x, 0, 0, 0, 0, 3, 4, 0, 0);
        made_quad(scene, m, x, 5, 0, 4, 0, 0, 0, 0, 3);
        made_quad(scene, m, x, 0, 0, 0, room ? wall : 5, 0, 0, 0, 3);
        made_quad(scene, m, x + 4, 0, 0, 0, 0, 3, 0, room ? 5 : wall, 0);
    }
}

/* What replicates say of the noise holds the slope's, too. By slopes of the others alone they said
 * 8 % less than there was (W2). */
START_TEST(test_told)
{
    enum { MANY = 3000 };
    struct scene scene;
    struct solve s;
    struct tracer t;
    struct spread x = {0, 0, 0};
    slotted_rooms(&scene);
    open_tracer(&s, &t, &scene);
    for (uint64_t i = 0; i < MANY; i++) {
        struct tally y;
        count(&y, &t, i + 1, 4 * FEW);
        power_balance(&y, &t);
        add_tally(&x, &s.problem, &y, MANY);
        tally_close(&y);
    }
    printf("slot: %.5g +- %.2g W, replicates say %.3f of that\n", x.mean, sqrt(variance_of(&x)),
           sqrt(x.told / variance_of(&x)));
    ck_assert_double_gt(x.told, 0.95 * variance_of(&x));
    tracer_close(&t);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("power balance");
    TCase *c = tcase_create("power balance");
    tcase_set_timeout(c, 120);
    tcase_add_test(c, test_white);
    tcase_add_test(c, test_told);
    tcase_add_loop_test(c, test_mean, 0, 2);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
