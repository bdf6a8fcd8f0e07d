/* progress.h - a line on the terminal that says how far the work is.
 * SPDX-License-Identifier: MIT */
#ifndef PROGRESS_H
#define PROGRESS_H

#include "radiosity.h"
#include "util/report.h"

struct progress {
    int wanted; /* standard error is a terminal and nobody asked for quiet */
    int shown;
    double next; /* when to write again, s */
};

void progress_start(struct progress *p, int quiet);
/* A RadProgressFunction; the user is a struct progress. Never cancels. */
int progress_show(void *user, const struct RadProgress *at);
/* The same line with another text. */
void progress_say(struct progress *p, const char *format, ...) PRINTF_LIKE(2, 3);
void progress_end(struct progress *p);

#endif
