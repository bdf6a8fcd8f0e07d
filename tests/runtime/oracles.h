/* oracles.h - oracles for tests: what they complain about goes to stderr.
 * SPDX-License-Identifier: MIT */
#ifndef TESTS_ORACLES_H
#define TESTS_ORACLES_H

#include <stdio.h>
#include "oracle/oracles.h"
#include "util/oracles.h"

static inline struct refiner *interpreted(const char *path, const char *text, const char *name)
{
    struct messages messages = {0};
    struct refiner *r = refiner_interpreted(path, text, name, &messages);
    fputs(messages_text(&messages), stderr);
    messages_free(&messages);
    return r;
}

#endif
