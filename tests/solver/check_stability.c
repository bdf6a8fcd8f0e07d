/* check_stability.c - the failure table, cell by cell: methods that must pass do, and those that
 * are known to fail fail, by the amount that the table states. One test per case; what a case is,
 * solver/study/stability_cases.c says. Then the closed forms that the cases rest on, against
 * published values, and the command that prints the table.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "suite.h"
#include "study/stability.h"
#include "study/stability_known.h"

static int cases(void)
{
    int n = 0;
    for (int g = 0; g < stability_group_count; g++)
        n += stability_groups[g].count;
    return n;
}

static const struct stability_case *case_at(int index)
{
    int g;
    for (g = 0; index >= stability_groups[g].count; g++)
        index -= stability_groups[g].count;
    return &stability_groups[g].cases[index];
}

/* What takes long and is like a case beside it, or tested by check_scale and check_solve. */
static int kept_for_thorough(const char *name)
{
    static const char *const names[] = {"scale", "brightness", "furnace_99", "furnace_L",
                                        "hollow_sphere"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(name, names[i]) == 0)
            return 1;
    return 0;
}

START_TEST(test_case)
{
    const struct stability_case *c = case_at(_i);
    if (!thorough() && kept_for_thorough(c->name))
        return;
    int wrong = 0;
    for (const struct stability_cell *cell = c->cells; cell->method != NO_METHOD; cell++) {
        struct stability_trial trial;
        const char *name = stability_methods[cell->method].name;
        ck_assert_int_eq(stability_run(c, cell, 2, &trial), 0);
        switch (stability_judge(cell, trial.error)) {
        case VERDICT_PASSES:
        case VERDICT_FAILS_AS_KNOWN:
            break;
        case VERDICT_FAILS:
            printf("%s, %s: error %.3g is above %.1g (%s)\n", c->name, name, trial.error,
                   cell->tolerance, c->measure);
            wrong++;
            break;
        case VERDICT_CHANGED:
            printf("%s, %s: error %.3g, but it is known to fail by %.3g to %.3g (%s)\n", c->name,
                   name, trial.error, cell->low, cell->high, cell->why);
            wrong++;
            break;
        }
    }
    ck_assert_msg(wrong == 0, "%s: %d cells are not as expected", c->name, wrong);
}
END_TEST

/* A cell cannot hold both ways, every case has a name of its own, and the default oracle passes
 * wherever it is asked. */
START_TEST(test_table)
{
    for (int i = 0; i < cases(); i++) {
        const struct stability_case *c = case_at(i);
        ck_assert(c->cells[0].method != NO_METHOD);
        for (int j = 0; j < i; j++)
            ck_assert_str_ne(c->name, case_at(j)->name);
        for (int k = 0; k < STABILITY_CELLS && c->cells[k].method != NO_METHOD; k++) {
            const struct stability_cell *cell = &c->cells[k];
            ck_assert(cell->method > NO_METHOD && cell->method < METHODS);
            ck_assert_ptr_nonnull(stability_methods[cell->method].name);
            ck_assert(cell->tolerance >= 0);
            for (int j = 0; j < k; j++)
                ck_assert_int_ne(c->cells[j].method, cell->method);
            if (cell->method == DEFAULT)
                ck_assert_msg(!cell->why, "%s", c->name);
            if (cell->why) {
                ck_assert_msg(cell->low > cell->tolerance && cell->high >= cell->low, "%s",
                              c->name);
                ck_assert_int_eq(stability_judge(cell, 0), VERDICT_CHANGED);
                ck_assert_int_eq(stability_judge(cell, cell->low), VERDICT_FAILS_AS_KNOWN);
            } else {
                ck_assert_int_eq(stability_judge(cell, cell->tolerance), VERDICT_PASSES);
                ck_assert_int_eq(stability_judge(cell, 2 * cell->tolerance + 1e-300),
                                 VERDICT_FAILS);
                ck_assert_int_eq(stability_judge(cell, NAN), VERDICT_FAILS);
            }
        }
    }
}
END_TEST

/* Published values; the closed forms without shadows have a suite of their own,
 * check_closed_forms.c. */
START_TEST(test_known)
{
    const double source[4] = {-0.5, 0.5, -0.5, 0.5};
    static const double x[] = {0.25, 0.5, 0.75, 1, 1.5},
                        e[] = {0, 0.0189169153, 0.0337198400, 0.0405845563, 0.0326632655};
    ck_assert_double_eq_tol(known_point(0, 1, 0, 1, 1), 0.1385316060, 1e-10);
    ck_assert_double_eq_tol(known_point(-0.5, 0.5, -0.5, 0.5, 1), 0.2394564705, 1e-10);
    ck_assert_double_eq_tol(known_point(0.5, 1.5, -0.5, 0.5, 1),
                            known_point(-1.5, -0.5, -0.5, 0.5, 1), 1e-15);
    for (int i = 0; i < 5; i++) {
        const double s[4] = {source[0] - x[i], source[1] - x[i], source[2], source[3]};
        const double b[4] = {-0.375 - x[i], 0.375 - x[i], -0.375, 0.375};
        ck_assert_double_eq_tol(known_penumbra(s, 2, b, 1), e[i], 1e-10);
    }
}
END_TEST

static int run(const char *arguments)
{
    const char *program = getenv("RADIOSITY");
    char command[512];
    snprintf(command, sizeof command, "%s study %s", program ? program : "build/bin/radiosity",
             arguments);
    return system(command);
}

static int holds(const char *path, const char *text)
{
    FILE *in = fopen(path, "r");
    int found = 0;
    ck_assert_ptr_nonnull(in);
    char line[1024];
    while (!found && fgets(line, sizeof line, in))
        found = strstr(line, text) != NULL;
    fclose(in);
    return found;
}

START_TEST(test_command)
{
    char folder[] = "/tmp/stability-XXXXXX", arguments[256], path[64];
    ck_assert_ptr_nonnull(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/out", folder);
    snprintf(arguments, sizeof arguments, "stability --only shared_edge > %s", path);
    ck_assert_int_eq(run(arguments), 0);
    ck_assert(holds(path, "power") && holds(path, "fails: 1/r2 is unbounded")
              && holds(path, "0 are not as expected"));
    unlink(path);
    snprintf(path, sizeof path, "%s/out.csv", folder);
    snprintf(arguments, sizeof arguments, "stability --only shared_edge -q -o %s", path);
    ck_assert_int_eq(run(arguments), 0);
    ck_assert(holds(path, "form factors,shared_edge,\"disc\",0.02"));
    unlink(path);
    snprintf(path, sizeof path, "%s/out.md", folder);
    snprintf(arguments, sizeof arguments, "stability --only shared_edge -q -o %s", path);
    ck_assert_int_eq(run(arguments), 0);
    ck_assert(holds(path, "| shared_edge | 0.59 fails: 1/r2"));
    unlink(path);
    ck_assert_int_eq(rmdir(folder), 0);
    ck_assert_int_ne(run("stability --only nothing 2> /dev/null"), 0);
    ck_assert_int_ne(run("stability -o table.txt --only shared_edge 2> /dev/null"), 0);
    ck_assert_int_ne(run("2> /dev/null"), 0);
    ck_assert_int_ne(run("stability scene.obj 2> /dev/null"), 0);
    ck_assert_int_ne(run("visibility scene.obj --rays 16,4 2> /dev/null"), 0);
    ck_assert_int_ne(run("visibility scene.obj --thresholds 2,x 2> /dev/null"), 0);
    ck_assert_int_eq(run("--help > /dev/null"), 0);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("stability");
    TCase *c = tcase_create("stability");
    tcase_set_timeout(c, 120);
    tcase_add_test(c, test_table);
    tcase_add_test(c, test_known);
    tcase_add_test(c, test_command);
    tcase_add_loop_test(c, test_case, 0, cases());
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
