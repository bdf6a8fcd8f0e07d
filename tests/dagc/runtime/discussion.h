/* discussion.h - a runtime for dagc's tests: tools answer from a script and note how they were called.
 * SPDX-License-Identifier: MIT */
#ifndef DISCUSSION_H
#define DISCUSSION_H

#include <math.h>
#include <string.h>

#ifndef RUNTIME_ABI
#define RUNTIME_ABI 7
#endif

#include "catalog.h"

#define TOOL static inline

/* What was asked, and what is to be answered. */
struct record {
    const unsigned char *script; /* one random byte per call */
    int calls;
    int tools[4096];
    double arguments[4096][2];
    double facts[4]; /* what the catalog's facts read */
};

struct discussion {
    struct terms terms;
    struct record *record;
};

static inline int answer(struct discussion *d, int tool, double first, double second, int answers)
{
    struct record *r = d->record;
    int call = r->calls++;
    r->tools[call] = tool;
    r->arguments[call][0] = first;
    r->arguments[call][1] = second;
    return r->script[call] % answers;
}

#endif
