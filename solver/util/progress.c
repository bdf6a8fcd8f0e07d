/* progress.c - see progress.h. Ten lines a second at the most, and none in a log file.
 * SPDX-License-Identifier: MIT */
#include "util/progress.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "util/clock.h"

void progress_start(struct progress *p, int quiet)
{
    *p = (struct progress){.wanted = !quiet && isatty(STDERR_FILENO), .next = seconds() + 0.3};
}

void progress_say(struct progress *p, const char *format, ...)
{
    double now;
    if (!p->wanted || (now = seconds()) < p->next)
        return;
    va_list list;
    va_start(list, format);
    fputc('\r', stderr);
    vfprintf(stderr, format, list);
    fputs(" \033[K", stderr);
    va_end(list);
    p->shown = 1;
    p->next = now + 0.1;
}

int progress_show(void *user, const struct RadProgress *at)
{
    if (strcmp(at->phase, "particles") == 0 || at->share > 0)
        progress_say(user, "%-7s %.0f %% done, %.3g rays", at->phase, 100 * at->share,
                     (double)at->rays);
    else
        progress_say(user,
                     "%-7s pass %d, round %llu: %.3g pairs (%.3g waiting), %.3g links, %.3g rays, "
                     "residual %.1e",
                     at->phase, at->pass, (unsigned long long)at->rounds, (double)at->pairs,
                     (double)at->waiting, (double)at->links, (double)at->rays, at->residual);
    return 0;
}

void progress_end(struct progress *p)
{
    if (p->shown)
        fprintf(stderr, "\r\033[K");
    p->shown = 0;
}
