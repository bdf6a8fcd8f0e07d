/* compile_oracle.c - from a graph to a loaded library and the oracle in it.
 *
 * dagc's library carries the headers that the C text includes, so this works wherever a program
 * stands; what it needs is a C compiler.
 * SPDX-License-Identifier: MIT */
#include "oracle/compile_oracle.h"

#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

#include "oracle/load_graph.h"
#include "oracle/tool_table.h"

static void close_library(struct refiner *r)
{
    dlclose(r->own);
}

/* A discussion holds the terms of this program's catalog, in their order: a graph that declares
 * more of them was compiled for another structure. */
static int same_terms(const struct dag *dag)
{
    for (int i = 0; i < dag->term_count && i < term_table_count; i++)
        if (strcmp(dag->terms[i].name, term_table[i].name) != 0)
            return 0;
    return dag->term_count == term_table_count;
}

static struct refiner *open_library(void *library, const char *name, int wave,
                                    struct messages *messages)
{
    char symbol[128];
    snprintf(symbol, sizeof symbol, "%s_oracle", name);
    const struct oracle *oracle = dlsym(library, symbol);
    struct refiner *r = oracle ? refiner_compiled(oracle, wave ? "wave" : "flat") : NULL;
    if (r) {
        r->own = library;
        r->release_state = close_library;
        return r;
    }
    dlclose(library);
    (void)messages_say(messages, MESSAGE_COMPILER,
                       "the compiled oracle '%s' does not fit this program", name);
    return NULL;
}

/* Externs of other oracles in the file stay NULL: nobody asks those. Returns 0, or -1 after a
 * message. */
static int find_externs(const struct dag *dag, int oracle, const struct plugin *plugins,
                        struct messages *messages)
{
    for (int i = 0; i < dag->callback_count; i++)
        if (dag_reads_extern(dag, &dag->oracles[oracle], i)
            && !plugin_find(plugins, dag->callbacks[i].name))
            return graph_lacks_extern(dag, i, messages);
    return 0;
}

static void set_externs(void *library, const struct dag *dag, const struct plugin *plugins)
{
    char symbol[128];
    for (int i = 0; i < dag->callback_count; i++) {
        snprintf(symbol, sizeof symbol, "extern_%s", dag->callbacks[i].name);
        extern_function **variable = dlsym(library, symbol);
        if (variable)
            *variable = plugin_find(plugins, dag->callbacks[i].name);
    }
}

struct refiner *compile_oracle(const char *path, const char *text, const char *name, int wave,
                               const struct oracle_sources *how, struct messages *messages)
{
    struct dag_options options = {.text = text,
                                  .length = text ? strlen(text) : 0,
                                  .replacements = how->replacements,
                                  .replacement_count = how->replacement_count};
    struct refiner *r = NULL;
    int index;
    struct dag *dag = load_graph(path, &options, name, &index, messages);
    if (!dag)
        return NULL;
    if (!same_terms(dag)) {
        (void)messages_say(messages, MESSAGE_ARGUMENT,
                           "the graph's catalog declares terms that this program was built "
                           "without; leave them out, or build a program with that catalog");
    } else if (find_externs(dag, index, how->plugins, messages) == 0) {
        const struct dag_compiler compiler = {how->compiler, how->temporary, wave};
        char message[4096];
        void *library = dag_compile_oracles(dag, &compiler, message, sizeof message);
        if (!library)
            (void)messages_say(messages, MESSAGE_COMPILER, "%s", message);
        else {
            set_externs(library, dag, how->plugins);
            r = open_library(library, dag->oracles[index].name, wave, messages);
        }
    }
    dag_free(dag);
    return r;
}
