/* check_study.c - `radiosity study visibility`, run as the user would, its table held against what
 * must be so.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "command.h"
#include "discussion.h"
#include "folder.h"
#include "suite.h"
#include "tools/lot.h"

#define STUDY "$RADIOSITY study visibility examples/scenes/cornell.obj "

static int run(const char *more)
{
    return shell(STUDY "-q %s", more);
}

enum { TOOLS = 7, ROWS = 16 };

struct row {
    double threshold, area, known, percent, low, high;
    char tool[16];
    long pairs, tested, wrong, matrix[3][4], complete;
};

static int read_row(FILE *in, struct row *r)
{
    int n =
        fscanf(in, "%lf,%lf,%15[^,],%ld,%ld,%lf,%ld,%lf,%lf,%lf", &r->threshold, &r->area, r->tool,
               &r->pairs, &r->tested, &r->known, &r->wrong, &r->percent, &r->low, &r->high);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 4; b++)
            n += fscanf(in, ",%ld", &r->matrix[a][b]);
    return n + fscanf(in, ",%ld\n", &r->complete);
}

/* The table that `more` makes: rows[threshold][tool], so many of both. */
static void read_table(const char *more, int status, int thresholds, int tools,
                       struct row rows[ROWS][TOOLS])
{
    char head[512];
    ck_assert_int_eq(shell(STUDY "-q %s -o %s", more, in_folder("table.csv")), status);
    FILE *in = fopen(in_folder("table.csv"), "r");
    ck_assert_ptr_nonnull(in);
    ck_assert_ptr_nonnull(fgets(head, sizeof head, in));
    ck_assert(strncmp(head, "threshold,area_m2,tool,pairs,tested,known_percent,wrong,", 56) == 0);
    for (int i = 0; i < thresholds; i++)
        for (int k = 0; k < tools; k++)
            ck_assert_int_eq(read_row(in, &rows[i][k]), 23);
    ck_assert_int_eq(fgetc(in), EOF);
    fclose(in);
}

/* Far fewer pairs than by default, so that all of them are drawn. */
#define COARSE "--set relative=0.1 --set min_share=2e-3 "

static void check_row(const struct row *r, const char *tool, double threshold)
{
    long sum = 0, right = 0, none = 0;
    double z = 1.96;
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 4; b++) {
            sum += r->matrix[a][b];
            right += a == b ? r->matrix[a][b] : 0;
            none += b == 3 ? r->matrix[a][b] : 0;
        }
    double n = (double)(sum - none), p = (double)r->wrong / n;
    ck_assert_str_eq(r->tool, tool);
    ck_assert_double_eq_tol(r->threshold, threshold, 1e-12);
    /* the scene has 2.225 m2 */
    ck_assert_double_eq_tol(r->area, threshold * 4e-5 * 2.225, 1e-3 * r->area);
    ck_assert_int_eq(sum, r->tested);
    ck_assert_int_eq(sum - none - right, r->wrong);
    ck_assert_double_eq_tol(r->known, 100 * n / (double)sum, 1e-6);
    ck_assert_double_eq_tol(r->percent, 100 * p, 1e-6);
    if (r->wrong > 0) { /* the interval's ends are where |p - q| = z sqrt(q (1 - q) / n) */
        double low = 0.01 * r->low, high = 0.01 * r->high;
        ck_assert_double_eq_tol(p - low, z * sqrt(low * (1 - low) / n), 1e-5);
        ck_assert_double_eq_tol(high - p, z * sqrt(high * (1 - high) / n), 1e-5);
    }
    ck_assert_int_eq(r->complete, 1);
}

/* The rays of few are among those of many, so a part that few see is one that many see; 1024 rays
 * are the reference itself; more rays are less often wrong; the shaft never is; and each half of
 * the pairs is asked by its own tools. One threshold, so that there is one stratum. */
START_TEST(test_visibility)
{
    static const char *const tools[] = {"4 rays",    "16 rays", "64 rays", "256 rays",
                                        "1024 rays", "shaft",   "outline"};
    static struct row rows[ROWS][TOOLS];
    char path[256];
    snprintf(path, sizeof path,
             "--thresholds 500 --rays 4,16,64,256,1024 --within 0.001 " COARSE
             "--chart %s/chart.svg",
             folder);
    read_table(path, 0, 1, TOOLS, rows);
    const struct row *r = rows[0];
    for (int k = 0; k < TOOLS; k++) {
        check_row(&r[k], tools[k], 500);
        ck_assert_int_eq(r[k].pairs, r[0].pairs);
    }
    ck_assert_int_gt(r[0].pairs, 500);
    ck_assert_int_eq(r[0].tested + r[5].tested, r[0].pairs);
    ck_assert_int_eq(r[6].tested, r[5].tested);
    ck_assert_int_gt(r[0].wrong, 10);
    for (int k = 0; k < 5; k++) {
        ck_assert_int_eq(r[k].tested, r[0].tested);
        ck_assert(k == 0 || r[k].wrong <= r[k - 1].wrong);
        ck_assert_int_eq(r[k].matrix[0][1] + r[k].matrix[0][2] + r[k].matrix[2][0], 0);
        /* A ray that starts within its rounding of an adjoining face's plane may hit that: once in
         * 250,000 rays. */
        ck_assert_int_le(r[k].matrix[2][1], 1 + r[k].pairs / 1000);
    }
    ck_assert_int_eq(r[4].wrong, r[4].matrix[2][1]);
    ck_assert_int_eq(r[5].wrong, 0);
    ck_assert_double_gt(r[5].known, 50);
    ck_assert_double_lt(r[5].known, 100);
    ck_assert_double_le(r[6].percent, r[0].percent);
    ck_assert_msg(folder_holds("chart.svg", "16 rays"),
                  "no chart; it is drawn by gnuplot (gnuplot-nox)");
}
END_TEST

/* A sample stands for all pairs: there are as many, fewer of them are tested, and the share of
 * wrong answers is that of all within twice the interval, which is of the width that was asked for.
 * With shares that are halved as counts rise, a sum without weights would be that of the first
 * pairs. */
START_TEST(test_sample)
{
    static struct row all[ROWS][TOOLS], few[ROWS][TOOLS];
    const char *const scene = "--thresholds 30,1000 --set relative=0.03 --set min_share=1e-4 "
                              "--set reference=64 --within ";
    char more[256];
    snprintf(more, sizeof more, "%s 0.2%%", scene);
    read_table(more, 0, 2, 5, all);
    snprintf(more, sizeof more, "%s 2%%", scene);
    read_table(more, 0, 2, 5, few);
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 5; k++) {
            const struct row *a = &all[i][k], *f = &few[i][k];
            /* a link keeps what tools have found of it, and so light knows of the test */
            ck_assert_double_eq_tol((double)f->pairs, (double)a->pairs, 2e-3 * (double)a->pairs);
            ck_assert_int_lt(2 * f->tested, a->tested);
            ck_assert_double_le(a->percent, f->percent + 2 * (f->high - f->percent));
            ck_assert_double_ge(a->percent, f->percent - 2 * (f->percent - f->low) - 1e-9);
            ck_assert(k > 2 || f->high - f->low < 4);
        }
}
END_TEST

/* Thresholds beyond the eighth take a solve of their own, and count the same pairs. Results do not
 * depend on threads; a pass more finds more pairs. */
START_TEST(test_thresholds)
{
    static struct row one[ROWS][TOOLS], many[ROWS][TOOLS], again[ROWS][TOOLS], first[ROWS][TOOLS];
    read_table("--thresholds 100,1000 --rays 4 --threads 1 " COARSE, 0, 2, 3, one);
    read_table("--thresholds 100,1000 --rays 4 --threads 2 " COARSE, 0, 2, 3, again);
    read_table("--thresholds 60,65,70,75,80,85,90,95,100,1000 --rays 4 " COARSE, 0, 10, 3, many);
    read_table("--thresholds 100,1000 --rays 4 --iterations 1 " COARSE, 0, 2, 3, first);
    ck_assert_mem_eq(one, again, sizeof one);
    for (int k = 0; k < 3; k++) {
        ck_assert_int_eq(many[8][k].pairs, one[0][k].pairs);
        ck_assert_int_eq(many[9][k].pairs, one[1][k].pairs);
        ck_assert_int_eq(many[9][k].tested, one[1][k].tested);
        ck_assert_int_eq(many[9][k].wrong, one[1][k].wrong);
    }
    ck_assert_int_lt(many[0][0].pairs, many[8][0].pairs);
    ck_assert_int_lt(first[1][0].pairs, one[1][0].pairs);
}
END_TEST

/* What was counted when the time ends, or a signal comes, is a table that says so. */
START_TEST(test_partial)
{
    static struct row rows[ROWS][TOOLS];
    const char *const slow = "--thresholds 100 --within 0.0001 --set relative=0.003 --threads 1";
    char more[512];
    snprintf(more, sizeof more, "%s --limit-seconds 1", slow);
    read_table(more, 3, 1, 5, rows);
    ck_assert_int_gt(rows[0][0].tested, 0);
    ck_assert_int_eq(rows[0][0].complete, 0);
    ck_assert_int_eq(shell("timeout --foreground --preserve-status -s INT 1 " STUDY
                           "%s -o %s/stopped.csv > %s/stopped.txt",
                           slow, folder, folder),
                     130);
    ck_assert_int_eq(shell("grep -q '^partial: stopped' %s/stopped.txt && "
                           "grep -q ',0$' %s/stopped.csv",
                           folder, folder),
                     0);
}
END_TEST

/* The settings that the study prints: a share of the scene's area for each number of rays. If all
 * answers may be wrong, 4 rays are good enough everywhere, if none may be, nothing is; in between
 * the thresholds do not fall. */
START_TEST(test_choice)
{
    static const char *const wrong[] = {"99%", "4%", "0.0001%"};
    double below[3][3];
    for (int i = 0; i < 3; i++) {
        ck_assert_int_eq(shell(STUDY "--thresholds 20,100,1000 " COARSE "--wrong %s | sed -n "
                                     "'s/.*--oracle by_reliability/by_reliability/p' > %s",
                               wrong[i], in_folder("choice.txt")),
                         0);
        FILE *out = fopen(in_folder("choice.txt"), "r");
        ck_assert_ptr_nonnull(out);
        ck_assert_int_eq(fscanf(out,
                                "by_reliability --set below_4=%lf --set below_16=%lf --set "
                                "below_64=%lf",
                                &below[i][0], &below[i][1], &below[i][2]),
                         3);
        fclose(out);
    }
    for (int k = 0; k < 3; k++) {
        ck_assert_double_eq_tol(below[0][k], 1000 * 4e-5, 1e-6);
        ck_assert_double_eq(below[2][k], 0);
    }
    ck_assert(below[1][0] <= below[1][1] && below[1][1] <= below[1][2]);
    ck_assert_double_gt(below[1][2], 0);
    ck_assert_double_lt(below[1][0], 1000 * 4e-5);
}
END_TEST

/* Links with a mark, by oracle by_reliability. */
static long marked(const char *more, int mark)
{
    long marks[8] = {0};
    ck_assert_int_eq(shell("$RADIOSITY solve examples/scenes/cornell.obj --oracle by_reliability "
                           "--no-correct --no-errors -q --set min_share=1e-3 %s --json - | "
                           "tr -d ' \n' | sed 's/.*\"marks\":\\[//' > %s",
                           more, in_folder("marks.txt")),
                     0);
    FILE *out = fopen(in_folder("marks.txt"), "r");
    ck_assert_ptr_nonnull(out);
    ck_assert_int_eq(fscanf(out, "%ld,%ld,%ld,%ld", &marks[0], &marks[1], &marks[2], &marks[3]), 4);
    fclose(out);
    return marks[mark];
}

/* Links that few rays have told of are marked: none where no area is small enough, none that
 * matter, and when light has been found to be more than was guessed the marks go. */
START_TEST(test_marks)
{
    const char *const all = "--set doubt=inf --set below_4=0.5 --set below_16=1 --set below_64=1";
    ck_assert_int_gt(marked(all, 2), 100);
    ck_assert_int_gt(marked("--set doubt=inf --set below_4=0 --set below_16=1", 3), 100);
    ck_assert_int_eq(marked("--set doubt=inf --set below_4=0 --set below_16=1", 2), 0);
    ck_assert_int_eq(marked("--set doubt=inf --set below_4=0 --set below_16=0", 3), 0);
    long few = marked("--set doubt=1e-3 --set below_4=1", 2);
    ck_assert_int_lt(few, marked("--set doubt=inf --set below_4=1", 2));
    ck_assert_int_lt(marked("--set doubt=0 --set below_4=1", 2), few); /* they bring no light */
}
END_TEST

/* What the graph cannot do is refused. */
START_TEST(test_wrong)
{
    ck_assert_int_eq(run("--rays 5 2> /dev/null"), 2);
    ck_assert_int_eq(run("--rays 16,4 2> /dev/null"), 2);
    ck_assert_int_eq(run("--chart no.txt 2> /dev/null"), 2);
    ck_assert_int_eq(run("-o no.txt 2> /dev/null"), 2);
    ck_assert_int_eq(run("--only shared_edge 2> /dev/null"), 2);
    ck_assert_int_ne(run("--set nothing=1 2> /dev/null"), 0);
}
END_TEST

/* Lots: the share that was asked for, the same both ways round. 100,000 pairs; 5 standard
 * deviations, wrong once in 1.7 million. */
START_TEST(test_lot)
{
    enum { PAIRS = 100000 };
    static const double share[] = {0, 0.01, 0.5, 1};
    struct element a, b;
    struct discussion there, back;
    memset(&a, 0, sizeof a);
    memset(&b, 0, sizeof b);
    memset(&there, 0, sizeof there);
    there.receiver = &a;
    there.emitter = &b;
    back = there;
    back.receiver = &b;
    back.emitter = &a;
    for (size_t k = 0; k < sizeof share / sizeof *share; k++) {
        double drawn = 0;
        for (int i = 0; i < PAIRS; i++) {
            a.id = (uint64_t)i / 300;
            b.id = (uint64_t)(i % 300) * 0x100000001u;
            ck_assert_int_eq(tool_lot(&there, share[k]), tool_lot(&back, share[k]));
            drawn += tool_lot(&there, share[k]) == LOT_DRAWN;
        }
        ck_assert_double_le(fabs(drawn - PAIRS * share[k]),
                            5 * sqrt(PAIRS * share[k] * (1 - share[k])));
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("study");
    TCase *c = tcase_create("study");
    if (folder_make("study") < 0)
        return 1;
    tcase_set_timeout(c, 300);
    tcase_add_test(c, test_visibility);
    tcase_add_test(c, test_sample);
    tcase_add_test(c, test_thresholds);
    tcase_add_test(c, test_partial);
    tcase_add_test(c, test_choice);
    tcase_add_test(c, test_marks);
    tcase_add_test(c, test_wrong);
    tcase_add_test(c, test_lot);
    suite_add_tcase(suite, c);
    int failed = suite_failures(suite);
    folder_remove();
    return failed != 0;
}
