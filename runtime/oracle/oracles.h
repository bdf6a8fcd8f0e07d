/* oracles.h - find an oracle by name or file, in the release that is asked for.
 * SPDX-License-Identifier: MIT */
#ifndef ORACLES_H
#define ORACLES_H

#include "oracle/plugin.h"
#include "oracle/refiner.h"
#include "util/messages.h"

#define DEFAULT_ORACLE "power"

enum release { RELEASE_FLAT, RELEASE_DAG, RELEASE_HAND, RELEASE_WAVE, RELEASES };

/* What a program adds to the built-in oracles; all zero: nothing. */
struct oracle_sources {
    /* [hand_count]: releases written by hand, or generated and linked with */
    const struct oracle **hand;
    int hand_count;
    size_t hand_capacity;
    const char *compiler, *temporary; /* for the flat release of files; NULL: "cc", "/tmp" */
    /* [replacement_count] of nodes of what oracle_load loads, as in struct dag_options */
    const char *const *replacements;
    int replacement_count;
    const struct plugin *plugins; /* owned: where externs are */
};

/* Registers a release under its own name; it is borrowed. Returns 0, or -1: out of memory, or of
 * another RUNTIME_ABI. */
int oracle_register(struct oracle_sources *sources, const struct oracle *oracle);
void oracle_sources_free(struct oracle_sources *sources);

/* A built-in or registered oracle by its name, or, when `oracle` looks like a file's name (ends in
 * .dag, has a '/', is "-"), the only one of that file. `sources` NULL: none. Returns NULL after a
 * message. */
struct refiner *oracle_open(const struct oracle_sources *sources, const char *oracle,
                            enum release release, struct messages *messages);

/* An oracle of a file, or of a text under the name `path`; `name` NULL: the only one. FLAT,
 * DAG or WAVE. */
struct refiner *oracle_load(const struct oracle_sources *sources, const char *path,
                            const char *text, const char *name, enum release release,
                            struct messages *messages);

#endif
