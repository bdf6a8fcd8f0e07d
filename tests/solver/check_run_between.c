/* check_run_between.c - another program is given all that was written for it, or nothing, and how
 * it ends is known.
 * SPDX-License-Identifier: MIT */
#include "util/run_between.h"
#include <check.h>
#include <string.h>
#include "suite.h"

static FILE *written(const char *text)
{
    FILE *file = tmpfile();
    ck_assert_ptr_nonnull(file);
    ck_assert_int_ge(fputs(text, file), 0);
    return file;
}

START_TEST(test_ends)
{
    static const char *const command[3][4] = {
        {"sh", NULL}, {"sh", "-c", "exit 3", NULL}, {"no-such-program", NULL}};
    static const int status[3] = {0, 3, RUN_NO_PROGRAM};
    char line[16] = "";
    FILE *from = written("echo said\n"), *to = tmpfile();
    ck_assert_int_eq(run_between(command[_i], from, to), status[_i]);
    rewind(to);
    ck_assert(fgets(line, sizeof line, to) == (_i == 0 ? line : NULL));
    ck_assert_str_eq(line, _i == 0 ? "said\n" : "");
    fclose(from);
    fclose(to);
}
END_TEST

/* Of a disk that was full for a while the end of a file may be whole, and its beginning missing. */
START_TEST(test_lost)
{
    static const char *const command[] = {"true", NULL};
    FILE *from = fopen("/dev/full", "w"), *to = tmpfile();
    ck_assert_ptr_nonnull(from);
    setvbuf(from, NULL, _IONBF, 0);
    ck_assert_int_eq(fputs("lost", from), EOF);
    ck_assert_int_eq(run_between(command, from, to), -1);
    fclose(from);
    fclose(to);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("run between");
    TCase *c = tcase_create("run between");
    tcase_add_loop_test(c, test_ends, 0, 3);
    tcase_add_test(c, test_lost);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
