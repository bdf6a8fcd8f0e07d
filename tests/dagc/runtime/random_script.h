/* random_script.h - discussions whose tools answer by chance, the same ones in every run, and what
 * tools were asked in them.
 * SPDX-License-Identifier: MIT */
#ifndef RANDOM_SCRIPT_H
#define RANDOM_SCRIPT_H

#include <stdio.h>
#include "discussion.h"

/* One in which nothing is known yet. */
static inline void random_script(struct discussion *d, struct record *record,
                                 unsigned char script[64], unsigned *random)
{
    for (int i = 0; i < 64; i++) {
        *random = *random * 1664525u + 1013904223u;
        script[i] = (unsigned char)(*random >> 24);
    }
    memset(d, 0, sizeof *d);
    memset(record, 0, sizeof *record);
    d->record = record;
    record->script = script;
}

static inline void print_calls(int run, int decision, const struct record *record)
{
    printf("%d %d %d", run, decision, record->calls);
    for (int i = 0; i < record->calls; i++)
        printf(" %d:%g:%g", record->tools[i], record->arguments[i][0], record->arguments[i][1]);
}

#endif
