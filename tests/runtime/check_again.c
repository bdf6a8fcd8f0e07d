/* check_again.c - tables in rooms: shades of legs that the points of a rule miss.
 *
 * In a closed room every row whose face nothing stands on sums to 1, whatever hides what. Where all
 * points of a wall saw past one leg to another, rows were 1.008; now no more than three tolerances,
 * or they are looked at again. A room without a ceiling has no such sum: there entries are held
 * against quadrature that shares nothing with the library (room_judge.h).
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "runtime/make_tables.h"
#include "runtime/room_judge.h"
#include "suite.h"

static const double TOLERANCE = 3e-4;

/* Those of the first twelve that were worst, and one that is looked at again. */
static const uint64_t rooms[] = {0, 3, 4, 6, 9, 11, OFF};

START_TEST(test_rows)
{
    static double f[FACES * FACES], areas[FACES];
    furnish(rooms[_i], 0);
    factors(scene.faces, TOLERANCE, f, areas);
    for (uint32_t i = FLOOR; i < scene.faces; i++) {
        const double sum = row_sum(f, i);
        if (i < WALLS || (i - WALLS) % TABLE != UNDERSIDE)
            ck_assert_msg(fabs(sum - 1) <= 3 * TOLERANCE, "row %u sums to %.6f", i, sum);
    }
}
END_TEST

/* In the open, from a leg's side to a wall's cell past another leg. */
START_TEST(test_entries)
{
    static const struct {
        uint64_t room;
        uint32_t leg, cell;
    } pairs[] = {{0, 133, 88}, {3, 131, 84}, {3, 124, 92},  {4, 131, 84},  {6, 124, 88},
                 {0, 157, 64}, {2, 110, 92}, {12, 138, 65}, {12, 130, 65}, {12, 124, 88}};
    static double f[FACES * FACES], areas[FACES];
    static struct judge_polygon all[FACES];
    for (size_t k = 0; k < sizeof pairs / sizeof *pairs; k += under_sanitizers() ? 8 : 1) {
        const uint32_t leg = pairs[k].leg - FLOOR, cell = pairs[k].cell - FLOOR;
        furnish(pairs[k].room, 1);
        factors(leg + 1, TOLERANCE, f, areas);
        for (uint32_t i = 0; i < scene.faces; i++) {
            all[i].n = 4;
            memcpy(all[i].v, &scene.positions[(size_t)12 * i], sizeof(double[4][3]));
        }
        const double right =
            judge_pair(&all[leg], &all[cell], all, (int)scene.faces, 1e-9, 1e-5 * areas[leg])
            / areas[leg];
        ck_assert_double_eq_tol(f[(size_t)leg * scene.faces + cell], right, TOLERANCE);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("again");
    TCase *tests = tcase_create("rows");
    tcase_set_timeout(tests, 120);
    suite_add_tcase(suite, tests);
    tcase_add_loop_test(tests, test_rows, 0,
                        under_sanitizers() ? 1 : (int)(sizeof rooms / sizeof *rooms));
    tcase_add_test(tests, test_entries);
    return suite_failures(suite);
}
