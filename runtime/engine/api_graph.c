/* api_graph.c - the graph that a compiled oracle was made of, for what only a graph can tell.
 *
 * A solution asks the flat release, which knows no nodes. Who wants to know which node it was makes
 * the DAG release of the same source, with the same parameters: it decides the same.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "engine/api.h"

static char *copy(const char *text)
{
    return text ? strdup(text) : NULL;
}

void api_keep_source(RadOracle oracle, const char *path, const char *text, const char *name,
                     const char *const *replacements, int count)
{
    struct oracle_source *s = &oracle->source;
    s->path = copy(path);
    s->text = copy(text);
    s->name = copy(name);
    s->replacements = calloc((size_t)count + 1, sizeof *s->replacements);
    for (int i = 0; s->replacements && i < count; i++)
        if ((s->replacements[i] = copy(replacements[i])) != NULL)
            s->replacement_count++;
}

void api_forget_source(struct oracle_source *s)
{
    for (int i = 0; i < s->replacement_count; i++)
        free(s->replacements[i]);
    free(s->replacements);
    free(s->path);
    free(s->text);
    free(s->name);
}

struct refiner *api_interpret(RadOracle oracle)
{
    const struct oracle_source *s = &oracle->source;
    const struct refiner *r = oracle->refiner;
    struct messages messages = {0};
    if (!s->path || (strcmp(s->path, "-") == 0 && !s->text))
        return NULL;
    struct refiner *graph = refiner_interpret(
        &(struct interpretation){.path = s->path,
                                 .text = s->text,
                                 .oracle = s->name,
                                 .find_extern = plugin_find,
                                 .find_where = api_plugins(oracle->device),
                                 .replacements = (const char *const *)s->replacements,
                                 .replacement_count = s->replacement_count},
        &messages);
    for (int i = 0; graph && i < r->parameter_count; i++)
        (void)refiner_set(graph, r->parameters[i].name, refiner_get(r, i), &messages);
    messages_free(&messages);
    return graph;
}
