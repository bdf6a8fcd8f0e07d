/* suite.h - run a suite of tests as every program here does.
 * SPDX-License-Identifier: MIT */
#ifndef SUITE_H
#define SUITE_H

#include <check.h>
#include <stdlib.h>

/* Is everything asked for, as by make check-accuracy? make check leaves out what takes long and
 * is like what is left. */
static inline int thorough(void)
{
    return getenv("THOROUGH") != NULL;
}

/* Do sanitizers look on? All takes several times as long then, and what takes long does less. */
static inline int under_sanitizers(void)
{
#ifdef __SANITIZE_ADDRESS__
    return 1;
#else
    return 0;
#endif
}

/* Run the suite, print what failed and the count, and free it. Returns how many tests failed. */
static inline int suite_failures(Suite *suite)
{
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_NORMAL);
    int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed;
}

#endif
