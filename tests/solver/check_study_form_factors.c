/* check_study_form_factors.c - `radiosity study form-factors`, run as the user would: its table
 * against itself, the order of its kinds, and an oracle that asks for them.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "discussion.h"
#include "command.h"
#include "folder.h"
#include "suite.h"

#define CORNELL "examples/scenes/cornell.obj"

/* The exit status; what went to standard output is in folder/out, to standard error in folder/log.
 */
static int run(const char *format, const char *a, const char *b)
{
    char rest[512];
    snprintf(rest, sizeof rest, format, a, b);
    return shell("$RADIOSITY %s > %s/out 2> %s/log", rest, folder, folder);
}

enum { KINDS = FORM_FACTOR_CONTOUR, BINS = 6 };
static const char *const kinds[KINDS] = {"inverse_square", "disc",    "hemicube", "point",
                                         "rays",           "polygon", "contour"};

struct row {
    unsigned long long links, compared;
    double exchange, error, excess, worst, ns, reflected;
};

/* Field `number` of a line of a table. */
static const char *field(const char *line, int number)
{
    while (number-- > 0)
        line = strchr(line, ',') + 1;
    return line;
}

static void read_table(const char *name, struct row rows[KINDS][BINS + 1])
{
    char line[512];
    FILE *f = fopen(in_folder(name), "r");
    ck_assert_ptr_nonnull(f);
    ck_assert_ptr_nonnull(fgets(line, sizeof line, f));
    ck_assert_str_eq(line, "kind,distance_from,distance_to,links,compared,exchange_m2,error,signed,"
                           "worst,ns,reflected,capped,looks_at\n");
    for (int k = 0; k < KINDS; k++)
        for (int b = 0; b <= BINS; b++) {
            struct row *r = &rows[k][b];
            ck_assert_ptr_nonnull(fgets(line, sizeof line, f));
            ck_assert_int_eq(strncmp(line, kinds[k], strlen(kinds[k])), 0);
            ck_assert_int_eq(sscanf(field(line, 3), "%llu,%llu,%lf,%lf,%lf,%lf,%lf", &r->links,
                                    &r->compared, &r->exchange, &r->error, &r->excess, &r->worst,
                                    &r->ns),
                             7);
            const char *reflected = field(line, 10);
            r->reflected = *reflected == ',' ? -1 : strtod(reflected, NULL);
            ck_assert((r->reflected >= 0) == (b == BINS && k < KINDS - 1));
        }
    ck_assert_ptr_null(fgets(line, sizeof line, f));
    (void)fclose(f);
}

/* Bins add up to the whole; kinds are in the order of their error, which is near what the term's
 * header says; polygon and contour keep what they promise; the light errs as F does. */
START_TEST(test_table)
{
    struct row rows[KINDS][BINS + 1];
    ck_assert_int_eq(run("study form-factors " CORNELL " -q -o %s --chart %s",
                         in_folder("table.csv"), in_folder("chart.svg")),
                     0);
    read_table("table.csv", rows);
    for (int k = 0; k < KINDS; k++) {
        const struct row *all = &rows[k][BINS];
        double off = 0, exchange = 0, worst = 0;
        unsigned long long links = 0;
        for (int b = 0; b < BINS; b++) {
            const struct row *r = &rows[k][b];
            off += r->error * r->exchange;
            exchange += r->exchange;
            worst = fmax(worst, r->worst);
            links += r->links;
            ck_assert(fabs(r->excess) <= r->error * (1 + 1e-5));
            ck_assert((r->ns > 0) == (r->links > 0));
        }
        ck_assert_uint_eq(links, all->links);
        ck_assert_double_eq_tol(exchange, all->exchange, 1e-7 * exchange);
        ck_assert(worst == all->worst);
        if (k < KINDS - 1) { /* contour is compared for some */
            ck_assert_double_eq_tol(off / exchange, all->error, 1e-5 * all->error);
            ck_assert_uint_eq(all->compared, all->links);
            ck_assert(all->error > rows[k + 1][BINS].error);
            ck_assert(all->reflected > all->error / 20 && all->reflected < all->error);
        }
    }
    ck_assert_double_eq_tol(rows[0][BINS].error, 0.13, 0.005);
    ck_assert_double_eq_tol(rows[4][BINS].error, 0.012, 0.002);
    ck_assert_double_lt(rows[5][BINS].error, 1e-5);
    ck_assert_double_lt(rows[6][BINS].error, 1e-9);
    ck_assert(rows[6][BINS].compared >= 90 && rows[6][BINS].worst < 1e-9);
    ck_assert(folder_holds("chart.svg", "hemicube") && folder_holds("chart.svg", "</svg>"));
}
END_TEST

/* The same numbers from any number of threads, but for the time; a table to read, and one for
 * people; links of clusters are counted. */
START_TEST(test_outputs)
{
    struct row one[KINDS][BINS + 1], two[KINDS][BINS + 1];
    ck_assert_int_eq(run("study form-factors examples/scenes/furnace_4.obj --oracle clusters "
                         "--set relative=4 --tolerance 1e-2 --threads 1 -o %s%s",
                         in_folder("one.csv"), ""),
                     0);
    ck_assert(folder_holds("out", "of clusters, left out")
              && folder_holds("out", "inverse_square"));
    ck_assert_int_eq(run("study form-factors examples/scenes/furnace_4.obj --oracle clusters "
                         "--set relative=4 --tolerance 1e-2 --threads 2 -q -o %s%s",
                         in_folder("two.csv"), ""),
                     0);
    read_table("one.csv", one);
    read_table("two.csv", two);
    for (int k = 0; k < KINDS; k++)
        for (int b = 0; b <= BINS; b++) {
            one[k][b].ns = two[k][b].ns = 0;
            ck_assert(memcmp(&one[k][b], &two[k][b], sizeof one[k][b]) == 0);
        }
    ck_assert_int_eq(
        run("study form-factors " CORNELL " --set limit=0.4 -q -o %s%s", in_folder("table.md"), ""),
        0);
    ck_assert(folder_holds("table.md", "| inverse_square |")
              && folder_holds("table.md", "`radiosity study"));
}
END_TEST

/* Errors: nothing to measure, no such oracle. */
START_TEST(test_errors)
{
    FILE *f = fopen(in_folder("alone.obj"), "w");
    ck_assert_ptr_nonnull(f);
    fputs("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", f);
    ck_assert_int_eq(fclose(f), 0);
    ck_assert_int_eq(
        run("study form-factors %s -q -o %s", in_folder("alone.obj"), in_folder("none.csv")), 1);
    ck_assert(folder_holds("log", "no link between two surfaces"));
    ck_assert_int_ne(access(in_folder("none.csv"), F_OK), 0);
    ck_assert_int_eq(run("study form-factors " CORNELL " --oracle %s%s", "none", ""), 1);
    ck_assert_int_eq(run("study form-factors " CORNELL " -o %s%s", "table.txt", ""), 2);
    ck_assert_int_eq(run("study form-factors%s%s", "", ""), 2);
}
END_TEST

/* An oracle may ask for every level: what the interpreter does is what the compiled graph does, bit
 * by bit. Draws by the value make decisions differ where its last bits do. */
START_TEST(test_oracle)
{
    FILE *f = fopen(in_folder("kinds.dag"), "w");
    ck_assert_ptr_nonnull(f);
    fputs(
        "oracle kinds \"asks for every kind of form factor\" {\n"
        "  start level;\n"
        "  node level  = clusters()       { surfaces -> planes;  apart -> stop;\n"
        "      receiver -> subdivide_receiver;  emitter -> subdivide_emitter; }\n"
        "  node planes = support_planes() { away -> stop;\n"
        "      toward | receiver_crosses | emitter_crosses -> square; }\n"
        "  node square = inverse_square_form_factor() { done -> one; }\n"
        "  node one    = lot(share = min(1, 4 * form_factor)) { drawn -> cube;  blank -> seen; }\n"
        "  node cube   = hemicube_form_factor() { done -> two; }\n"
        "  node two    = lot(share = min(1, 5 * form_factor)) { drawn -> cast;  blank -> seen; }\n"
        "  node cast   = ray_form_factor() { done -> three; }\n"
        "  node three  = coupling(limit = 0.03) { dark -> stop;  below -> seen;  above -> guard; "
        "}\n"
        "  node guard  = can_split(min_share = 1e-2) { both -> side;  neither -> seen;\n"
        "      receiver -> subdivide_receiver;  emitter -> subdivide_emitter; }\n"
        "  node side   = larger() { receiver -> subdivide_receiver;  emitter -> subdivide_emitter; "
        "}\n"
        "  node seen   = visibility(rays = 4) { none -> stop;  partial | all -> form; }\n"
        "  node form   = form_factor() { done -> link; }\n"
        "}\n",
        f);
    ck_assert_int_eq(fclose(f), 0);
    ck_assert_int_eq(run("compare examples/scenes/furnace.obj --oracle %s --repeats 1%s",
                         in_folder("kinds.dag"), ""),
                     0);
    ck_assert_int_eq(
        run("solve examples/scenes/furnace.obj --oracle %s --release dag --statistics - -q%s",
            in_folder("kinds.dag"), ""),
        0);
    ck_assert(folder_holds("out", "ray_form_factor")
              && folder_holds("out", "hemicube_form_factor"));
}
END_TEST

int main(void)
{
    if (folder_make("factors") < 0)
        return 1;
    Suite *suite = suite_create("study form-factors");
    TCase *c = tcase_create("study form-factors");
    tcase_set_timeout(c, 120);
    tcase_add_test(c, test_table);
    tcase_add_test(c, test_outputs);
    tcase_add_test(c, test_errors);
    tcase_add_test(c, test_oracle);
    suite_add_tcase(suite, c);
    int failed = suite_failures(suite);
    folder_remove();
    return failed != 0;
}
