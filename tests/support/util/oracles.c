/* open_oracle.c - see open_oracle.h.
 * SPDX-License-Identifier: MIT */
#include "util/oracles.h"

#include <math.h>
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

static int set(struct refiner *r, const char *setting)
{
    const char *equals = strchr(setting, '=');
    char name[64];
    size_t length = equals ? (size_t)(equals - setting) : 0;
    struct messages messages = {0};
    if (!equals || length == 0 || length >= sizeof name)
        return report_error("--set", 0, "'%s' names no parameter; write PARAM=VALUE", setting);
    memcpy(name, setting, length);
    name[length] = 0;
    char *end;
    double value = strtod(equals + 1, &end);
    if (!equals[1])
        return report_error("--set", 0, "%s has no value; write %s=NUMBER", name, name);
    if (end == equals + 1 || *end || isnan(value))
        return report_error("--set", 0, "'%s' is not a number (in %s)", equals + 1, setting);
    if (isinf(value) && strpbrk(equals + 1, "0123456789"))
        return report_error("--set", 0, "%s: too large to be a number here; inf is one", setting);
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

void oracles_print(FILE *out)
{
    for (const struct builtin *b = builtins; b->name; b++) {
        fprintf(out, "%s%s: %s\n", b->name,
                strcmp(b->name, DEFAULT_ORACLE) == 0 ? " (default)" : "", b->compiled->doc);
        for (int i = 0; i < b->compiled->parameter_count; i++) {
            const struct oracle_parameter *p = &b->compiled->parameters[i];
            fprintf(out, "  %-10s %8g %-5s %s\n", p->name, p->value, p->unit, p->doc);
        }
    }
}
