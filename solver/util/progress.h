/* progress.h - a line on the terminal that says how far the work is; in a file a line a minute.
 * SPDX-License-Identifier: MIT */
#ifndef PROGRESS_H
#define PROGRESS_H

#include "radiosity.h"
#include "util/report.h"

struct progress {
    int wanted;          /* nobody asked for quiet */
    int file;            /* standard error is no terminal */
    int shown;           /* a line that stands there */
    double next;         /* when to write again, s */
    double share, since; /* of the phase at hand, when it was first heard of; and when, s */
};

void progress_start(struct progress *p, int quiet);
/* A RadProgressFunction; the user is a struct progress. Never cancels. */
int progress_show(void *user, const struct RadProgress *at);
/* The same line with another text. */
void progress_say(struct progress *p, const char *format, ...) PRINTF_LIKE(2, 3);
void progress_end(struct progress *p);

#endif
