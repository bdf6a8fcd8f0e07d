/* command.h - the command, as a user calls it.
 * SPDX-License-Identifier: MIT */
#ifndef COMMAND_H
#define COMMAND_H

#include <check.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>

/* Run a line of the shell, in which $RADIOSITY is the command, by its whole path: that of the
 * environment, or the one that is built here. Returns the exit status; -1 when a signal ended it.
 */
__attribute__((__format__(__printf__, 1, 2))) static inline int shell(const char *format, ...)
{
    char line[4096];
    const char *program = getenv("RADIOSITY");
    char *path = realpath(program ? program : "build/bin/radiosity", NULL);
    va_list list;
    ck_assert_msg(path && setenv("RADIOSITY", path, 1) == 0, "no command to test");
    free(path);
    va_start(list, format);
    const int length = vsnprintf(line, sizeof line, format, list);
    va_end(list);
    ck_assert_int_lt(length, (int)sizeof line);
    const int status = system(line);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

#endif
