/* run_between.c - see run_between.h.
 * SPDX-License-Identifier: MIT */
#include "util/run_between.h"

#include <errno.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "util/end_with_parent.h"

int run_between(const char *const words[], FILE *from, FILE *to)
{
    if (fflush(from) != 0 || ferror(from) || fseek(from, 0, SEEK_SET) != 0)
        return -1;
    const pid_t parent = getpid(), child = fork();
    if (child == 0) {
        end_with_parent(parent, SIGTERM);
        if (dup2(fileno(from), STDIN_FILENO) >= 0 && dup2(fileno(to), STDOUT_FILENO) >= 0)
            execvp(words[0], (char *const *)(void *)words);
        _exit(RUN_NO_PROGRAM);
    }
    int status;
    while (child > 0 && waitpid(child, &status, 0) < 0)
        if (errno != EINTR)
            return -1;
    return child > 0 && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}
