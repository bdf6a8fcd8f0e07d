/* progress.c - see progress.h. Ten lines a second at the most, and none in a log file.
 * SPDX-License-Identifier: MIT */
#include <stdarg.h>
#include <stdio.h>
#include <unistd.h>
#include "util/clock.h"
#include "progress.h"

void progress_start(struct progress *p, int quiet)
{
    p->wanted = !quiet && isatty(STDERR_FILENO);
    p->shown = 0;
    p->next = seconds() + 0.3;
}

int progress_show(void *context, const struct solve *s, const char *phase)
{
    struct progress *p = context;
    double now;
    if (!p->wanted || (now = seconds()) < p->next)
        return 0;
    fprintf(stderr, "\r%-6s pass %d, round %llu: %.3g pairs (%zu waiting), %.3g links, %.3g rays, residual %.1e \033[K",
            phase, s->report.passes + 1, (unsigned long long)s->refinement.rounds, (double)s->refinement.pairs,
            s->refinement.queue_count, (double)s->refinement.link_count, (double)rays_count(s->problem.rays).rays, s->report.residual);
    p->shown = 1;
    p->next = now + 0.1;
    return 0;
}

void progress_say(struct progress *p, const char *format, ...)
{
    va_list list;
    double now;
    if (!p->wanted || (now = seconds()) < p->next)
        return;
    va_start(list, format);
    fputc('\r', stderr);
    vfprintf(stderr, format, list);
    fputs(" \033[K", stderr);
    va_end(list);
    p->shown = 1;
    p->next = now + 0.1;
}

void progress_end(struct progress *p)
{
    if (p->shown)
        fprintf(stderr, "\r\033[K");
    p->shown = 0;
}
