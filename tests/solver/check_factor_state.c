/* check_factor_state.c - saves of `viewfactors --resume` that fail: told once, tried again later.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "captured.h"
#include "commands/factor_state.h"
#include "folder.h"
#include "suite.h"

/* A state of one byte, as the library puts it. Returns how many lines are said meanwhile; -1 when
 * it is written, and nothing is said. */
static int save(const struct RadExchangeState *host)
{
    char said[1000];
    struct captured err = capture_start(STDERR_FILENO);
    const int failed = host->write(host->user, "x", 1) || host->write(host->user, NULL, 0);
    capture_end(&err, said, sizeof said);
    int lines = 0;
    for (const char *c = said; *c; c++)
        lines += *c == '\n';
    ck_assert(failed || lines == 0);
    return failed ? lines : -1;
}

START_TEST(test_saves)
{
    char later[500], path[600];
    snprintf(later, sizeof later, "%s", in_folder("later"));
    snprintf(path, sizeof path, "%s/state", later);
    const struct options o = {.resume = path, .quiet = 1};
    struct factor_state s;
    ck_assert_int_eq(factor_state_open(&s, &o), 0);
    const struct RadExchangeState *host = factor_state_host(&s);
    /* no folder; the same; there is one; none again, after which it is stopped */
    static const int wanted[] = {1, 0, -1, 1, 0};
    for (int i = 0; i < 5; i++) {
        if (i == 2)
            ck_assert_int_eq(mkdir(later, 0700), 0);
        if (i == 3) {
            ck_assert_int_eq(unlink(path), 0);
            ck_assert_int_eq(rmdir(later), 0);
        }
        ck_assert_int_eq(host->asked(host->user), RAD_STATE_NONE);
        s.saved -= 100;
        ck_assert_int_eq(host->asked(host->user), RAD_STATE_SAVE);
        ck_assert_int_eq(save(host), wanted[i]);
        ck_assert_int_eq(s.failed, wanted[i] >= 0);
    }
    raise(SIGTERM);
    ck_assert_int_eq(host->asked(host->user), RAD_STATE_STOP);
    ck_assert_int_eq(save(host), 1);
    factor_state_close(&s);
}
END_TEST

int main(void)
{
    if (folder_make("factor_state") < 0)
        return EXIT_FAILURE;
    Suite *suite = suite_create("factor state");
    TCase *t = tcase_create("factor state");
    tcase_add_test(t, test_saves);
    suite_add_tcase(suite, t);
    int failed = suite_failures(suite);
    folder_remove();
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
