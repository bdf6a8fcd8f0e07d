/* oracles.h - oracles for tests: what they complain about goes to stderr.
 * SPDX-License-Identifier: MIT */
#ifndef TESTS_ORACLES_H
#define TESTS_ORACLES_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "hand.h"
#include "oracle/oracles.h"
#include "util/report.h"

static inline struct refiner *interpreted(const char *path, const char *text, const char *name)
{
    struct messages messages = { 0 };
    struct refiner *r = refiner_interpreted(path, text, name, &messages);
    fputs(messages_text(&messages), stderr);
    messages_free(&messages);
    return r;
}

static inline const char *from_environment(const char *name)
{
    const char *value = getenv(name);
    return value && *value ? value : NULL;
}

static inline int add_hand(struct oracle_sources *sources)
{
    for (int i = 0; hand_releases[i]; i++)
        if (oracle_register(sources, hand_releases[i]) < 0)
            return -1;
    return 0;
}

/* As oracle_open, with the hand-written releases. */
static inline struct refiner *oracles_open(const char *oracle, enum release release)
{
    struct oracle_sources sources = { .compiler = from_environment("CC"), .temporary = from_environment("TMPDIR") };
    struct messages messages = { 0 };
    struct refiner *r = NULL;
    if (add_hand(&sources) == 0)
        r = oracle_open(&sources, oracle, release, &messages);
    if (!r && messages.cause == MESSAGE_GRAPH)
        fputs(messages_text(&messages), stderr);
    else if (!r)
        report_error(oracle, 0, "%s", messages.cause ? messages_text(&messages) : "out of memory");
    messages_free(&messages);
    oracle_sources_free(&sources);
    return r;
}

/* Apply texts "NAME=VALUE". */
static inline int oracles_set(struct refiner *r, char *const *settings, int count)
{
    struct messages messages = { 0 };
    int status = 0;
    for (int i = 0; i < count && status == 0; i++) {
        const char *equals = strchr(settings[i], '=');
        char name[64];
        snprintf(name, sizeof name, "%.*s", (int)(equals - settings[i]), settings[i]);
        status = refiner_set(r, name, strtod(equals + 1, NULL), &messages);
    }
    fputs(messages_text(&messages), stderr);
    messages_free(&messages);
    return status;
}

#endif
