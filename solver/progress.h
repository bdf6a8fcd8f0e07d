/* progress.h - a line on the terminal that says how far the work is.
 * SPDX-License-Identifier: MIT */
#ifndef PROGRESS_H
#define PROGRESS_H

#include "util/report.h"
#include "engine/solve.h"

struct progress {
    int wanted; /* standard error is a terminal and nobody asked for quiet */
    int shown;
    double next; /* when to write again, s */
};

void progress_start(struct progress *p, int quiet);
/* For solve_options.progress; the context is a struct progress. Returns 0: never cancels. */
int progress_show(void *context, const struct solve *solve, const char *phase);
/* The same line with another text. */
void progress_say(struct progress *p, const char *format, ...) PRINTF_LIKE(2, 3);
void progress_end(struct progress *p);

#endif
