/* progress.c - see progress.h. Ten lines a second at the most, one a minute in a file.
 * SPDX-License-Identifier: MIT */
#include "util/progress.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "util/clock.h"

static const double MINUTE = 60;

void progress_start(struct progress *p, int quiet)
{
    int file = !isatty(STDERR_FILENO);
    *p = (struct progress){
        .wanted = !quiet, .file = file, .next = seconds() + (file ? MINUTE : 0.3)};
}

void progress_say(struct progress *p, const char *format, ...)
{
    double now;
    if (!p->wanted || (now = seconds()) < p->next)
        return;
    va_list list;
    va_start(list, format);
    if (!p->file)
        fputc('\r', stderr);
    vfprintf(stderr, format, list);
    fputs(p->file ? "\n" : " \033[K", stderr);
    va_end(list);
    p->shown = !p->file;
    p->next = now + (p->file ? MINUTE : 0.1);
}

/* Seconds that are left if the rest goes as what is done; -1 when too little is. */
static double seconds_left(struct progress *p, double share)
{
    double now = seconds();
    if (!(p->share > 0) || share < p->share) {
        p->share = share;
        p->since = now;
    }
    return share - p->share < 0.01 ? -1 : (now - p->since) * (1 - share) / (share - p->share);
}

int progress_show(void *user, const struct RadProgress *at)
{
    double left = at->share > 0 ? seconds_left(user, at->share) : -1;
    if (left >= 0)
        progress_say(user, "%-7s %.0f %% done, about %.3g s left, %.3g rays", at->phase,
                     100 * at->share, left, (double)at->rays);
    else if (strcmp(at->phase, "particles") == 0 || at->share > 0)
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
