/* factor_state.h - `radiosity viewfactors --resume FILE`: where the work stands, in a file from
 * which the same command goes on.
 *
 * The file is written now and then, and when SIGINT or SIGTERM stops the run; it is gone when the
 * run has written its outputs. Without one the two signals end the run as any other.
 * SPDX-License-Identifier: MIT */
#ifndef FACTOR_STATE_H
#define FACTOR_STATE_H

#include <stdio.h>

#include "options/options.h"
#include "util/atomic_file.h"
#include "util/progress.h"

struct factor_state {
    const char *path; /* NULL: there is none */
    int quiet;
    struct progress progress;
    struct RadExchangeState host;
    FILE *in;                        /* the state to go on from; NULL: there is none */
    int unread;                      /* it could not be read to its end */
    struct atomic_file out;          /* while it is written */
    double start, saved, save_began; /* s, of the clock */
    double save_for;                 /* s, that the last one took */
    int failed;                      /* the last one could not be written */
    int told;                        /* since one could not; the next may be */
    int whole;                       /* this run has written one */
};

/* Looks whether there is one, and begins to watch for signals. Returns 0, or -1 after a message. */
int factor_state_open(struct factor_state *s, const struct options *o);

/* What radNewExchange is given; NULL without a file. */
const struct RadExchangeState *factor_state_host(const struct factor_state *s);

/* A RadProgressFunction; the user is a struct factor_state. */
int factor_state_show(void *user, const struct RadProgress *at);

/* After a radNewExchange that gave nothing: say why. Returns the exit status. */
int factor_state_report(struct factor_state *s, RadDevice device, const char *scene);

/* Signals end the run again. */
void factor_state_close(struct factor_state *s);

/* The outputs are written: forget it. */
void factor_state_remove(const struct factor_state *s);

#endif
