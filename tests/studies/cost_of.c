/* cost_of.c - what another program takes of the processor and of memory:
 *
 *     cost_of FILE LIMIT COMMAND...
 *
 * runs COMMAND and writes to FILE, line by line, names and values: seconds (of the processor, user
 * and system, children that it waited for included), elapsed (s from start to end), memory_mb (the
 * peak of the largest process).
 * The LIMIT is of the processor, too, so that it means the same on a busy machine; a command that
 * reaches it is ended, with exit status 124. Else the exit status is the command's, 125 when it
 * was ended by a signal, 127 when there is none.
 * SPDX-License-Identifier: MIT */
#define _DEFAULT_SOURCE /* wait4 */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static double seconds(const struct timeval *t)
{
    return (double)t->tv_sec + 1e-6 * (double)t->tv_usec;
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int main(int count, char **argument)
{
    char *end = NULL;
    const long limit = count > 3 ? strtol(argument[2], &end, 10) : 0;
    if (limit < 1 || *end) {
        fputs("usage: cost_of FILE LIMIT COMMAND...\n", stderr);
        return 2;
    }
    const double start = now();
    const pid_t child = fork();
    if (child < 0)
        return perror("cost_of"), 1;
    if (child == 0) {
        const struct rlimit cpu = {.rlim_cur = (rlim_t)limit, .rlim_max = (rlim_t)limit + 1};
        if (setrlimit(RLIMIT_CPU, &cpu) == 0)
            execvp(argument[3], argument + 3);
        perror(argument[3]);
        _exit(127);
    }
    int status;
    struct rusage use;
    if (wait4(child, &status, 0, &use) != child)
        return perror("cost_of"), 1;
    const double elapsed = now() - start;
    const double took = seconds(&use.ru_utime) + seconds(&use.ru_stime);
    FILE *out = fopen(argument[1], "w");
    if (!out)
        return perror(argument[1]), 1;
    fprintf(out, "seconds %.3f\nelapsed %.3f\nmemory_mb %.1f\n", took, elapsed,
            (double)use.ru_maxrss / 1024);
    if (fclose(out) != 0)
        return perror(argument[1]), 1;
    if (WIFSIGNALED(status))
        return WTERMSIG(status) == SIGXCPU || took >= (double)limit ? 124 : 125;
    return WEXITSTATUS(status);
}
