/* oracles.c - the releases of an oracle, by name or from a file.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "oracle/builtin.h"
#include "oracle/compile_oracle.h"
#include "oracle/oracles.h"
#include "util/array.h"

static const char *const release_names[RELEASES] = {"flat", "dag", "hand", "wave"};

static const struct oracle_sources nothing;

int oracle_register(struct oracle_sources *sources, const struct oracle *oracle)
{
    if (oracle->abi != RUNTIME_ABI)
        return -1;
    if (array_reserve(&sources->hand, (size_t)sources->hand_count + 1, &sources->hand_capacity,
                      sizeof *sources->hand)
        < 0)
        return -1;
    sources->hand[sources->hand_count++] = oracle;
    return 0;
}

void oracle_sources_free(struct oracle_sources *sources)
{
    free(sources->hand);
    sources->hand = NULL;
    sources->hand_count = 0;
    sources->hand_capacity = 0;
    plugins_free(sources->plugins);
    sources->plugins = NULL;
}

static int is_file(const char *oracle)
{
    size_t n = strlen(oracle);
    return strchr(oracle, '/') || (n > 4 && strcmp(oracle + n - 4, ".dag") == 0)
           || strcmp(oracle, "-") == 0;
}

static const struct builtin *find_builtin(const char *name)
{
    for (const struct builtin *b = builtins; b->name; b++)
        if (strcmp(b->name, name) == 0)
            return b;
    return NULL;
}

static const struct oracle *find_hand(const struct oracle_sources *sources, const char *oracle)
{
    for (int i = 0; i < sources->hand_count; i++)
        if (strcmp(sources->hand[i]->name, oracle) == 0)
            return sources->hand[i];
    return NULL;
}

static struct refiner *open_compiled(const struct oracle *oracle, enum release release,
                                     struct messages *messages)
{
    struct refiner *r = refiner_compiled(oracle, release_names[release]);
    if (!r)
        (void)messages_say(messages, MESSAGE_MEMORY, "out of memory");
    else if (release == RELEASE_FLAT) /* pair by pair, as its name says */
        r->wave = NULL;
    return r;
}

static struct refiner *open_hand(const struct oracle_sources *sources, const char *oracle,
                                 struct messages *messages)
{
    const struct oracle *hand = find_hand(sources, oracle);
    char names[500] = "";
    size_t used = 0;
    if (hand)
        return open_compiled(hand, RELEASE_HAND, messages);
    for (int i = 0; i < sources->hand_count && used < sizeof names; i++)
        used += (size_t)snprintf(names + used, sizeof names - used, "%s--oracle %s",
                                 i ? " or " : ", or ", sources->hand[i]->name);
    (void)messages_say(messages, MESSAGE_ARGUMENT,
                       "no hand-written release of this oracle; use --release flat, wave or dag%s",
                       names);
    return NULL;
}

struct refiner *oracle_open(const struct oracle_sources *sources, const char *oracle,
                            enum release release, struct messages *messages)
{
    const struct builtin *b = find_builtin(oracle);
    if (!sources)
        sources = &nothing;
    if (!b && !is_file(oracle) && (release != RELEASE_HAND || !find_hand(sources, oracle))) {
        (void)messages_say(messages, MESSAGE_ARGUMENT,
                           "no such oracle; `radiosity oracles` lists the built-in ones, a file's "
                           "name ends in .dag");
        return NULL;
    }
    if (release == RELEASE_HAND)
        return open_hand(sources, oracle, messages);
    if (!b)
        return oracle_load(sources, oracle, NULL, NULL, release, messages);
    if (release == RELEASE_DAG)
        return refiner_interpreted(oracle, b->text, b->name, messages);
    return open_compiled(b->compiled, release, messages);
}

struct refiner *oracle_load(const struct oracle_sources *sources, const char *path,
                            const char *text, const char *name, enum release release,
                            struct messages *messages)
{
    if (!sources)
        sources = &nothing;
    if (release == RELEASE_DAG)
        return refiner_interpret(
            &(struct interpretation){.path = path,
                                     .text = text,
                                     .oracle = name,
                                     .find_extern = plugin_find,
                                     .find_where = sources->plugins,
                                     .replacements = sources->replacements,
                                     .replacement_count = sources->replacement_count},
            messages);
    if (release != RELEASE_HAND)
        return compile_oracle(path, text, name, release == RELEASE_WAVE, sources, messages);
    (void)messages_say(messages, MESSAGE_ARGUMENT,
                       "a file has no hand-written release; use --release flat, wave or dag");
    return NULL;
}
