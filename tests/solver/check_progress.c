/* check_progress.c - progress in a file: whole lines, one a minute, with what is left.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include "captured.h"
#include "suite.h"
#include "util/progress.h"

/* What is written to standard error when the times of these shares are told, each as if it were
 * `apart` seconds after the one before. */
static const char *told(int quiet, double apart, const double *shares, int count)
{
    static char text[1000];
    struct captured err = capture_start(STDERR_FILENO);
    struct progress p;
    progress_start(&p, quiet);
    for (int i = 0; i < count; i++) {
        const struct RadProgress at = {.phase = "factors", .rays = 7, .share = shares[i]};
        p.next -= apart;
        p.since -= apart;
        ck_assert_int_eq(progress_show(&p, &at), 0);
    }
    progress_end(&p);
    capture_end(&err, text, sizeof text);
    return text;
}

/* Lines with these shares (%) and times left (s); -1: without. */
static void expect(const char *text, int count, const int *share, const double *left)
{
    for (int i = 0; i < count; i++) {
        int done = 0, n = 0;
        double s = -1;
        ck_assert_int_ge(
            sscanf(text, "factors %d %% done%n, about %lf s left%n", &done, &n, &s, &n), 1);
        ck_assert_int_eq(done, share[i]);
        ck_assert_double_eq_tol(s, left[i], left[i] > 0 ? .05 * left[i] : 1e-9);
        ck_assert_int_eq(strncmp(text + n, ", 7 rays\n", 9), 0);
        text += n + 9;
    }
    ck_assert_str_eq(text, "");
}

START_TEST(test_file)
{
    static const double shares[] = {.1, .2, .3, .6};
    ck_assert_str_eq(told(1, 61, shares, 4), "");
    ck_assert_str_eq(told(0, 1, shares, 4), ""); /* all within a minute */
    expect(told(0, 100, shares, 4), 4, (const int[]){10, 20, 30, 60},
           (const double[]){-1, 800, 700, 240});
    expect(told(0, 35, shares, 4), 2, (const int[]){20, 60}, (const double[]){280, 84});
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("progress");
    TCase *lines = tcase_create("lines");
    tcase_add_test(lines, test_file);
    suite_add_tcase(suite, lines);
    return suite_failures(suite) > 0;
}
