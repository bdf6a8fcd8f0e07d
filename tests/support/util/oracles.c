/* oracles.c - see oracles.h.
 * SPDX-License-Identifier: MIT */
#include "util/oracles.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hand.h"
#include "oracle/builtin.h"
#include "util/report.h"

static const char *from_environment(const char *name)
{
    const char *value = getenv(name);
    return value && *value ? value : NULL;
}

static int add_hand(struct oracle_sources *sources)
{
    for (int i = 0; hand_releases[i]; i++)
        if (oracle_register(sources, hand_releases[i]) < 0)
            return -1;
    return 0;
}

struct refiner *oracles_open(const char *oracle, enum release release)
{
    struct oracle_sources sources = {.compiler = from_environment("CC"),
                                     .temporary = from_environment("TMPDIR")};
    struct messages messages = {0};
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

int oracles_by_hand(const char *oracle)
{
    int i;
    for (i = 0; hand_releases[i] && strcmp(hand_releases[i]->name, oracle) != 0; i++)
        ;
    return hand_releases[i] != NULL;
}

/* Settings are the tests' own: what is said of a user's stands in solver/util/open_oracle.c. */
static int set(struct refiner *r, const char *setting)
{
    char name[64];
    double value;
    int used = 0;
    struct messages messages = {0};
    if (sscanf(setting, "%63[^=]=%lf%n", name, &value, &used) != 2 || setting[used])
        return report_error("--set", 0, "'%s' is not PARAM=NUMBER", setting);
    if (refiner_set(r, name, value, &messages) < 0)
        report_error("--set", 0, "%s", messages_text(&messages));
    int status = messages.cause ? -1 : 0;
    messages_free(&messages);
    return status;
}

int oracles_set(struct refiner *r, char *const *settings, int count)
{
    for (int i = 0; i < count; i++)
        if (set(r, settings[i]) < 0)
            return -1;
    return 0;
}
