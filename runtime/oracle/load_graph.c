/* load_graph.c - see load_graph.h.
 * SPDX-License-Identifier: MIT */
#include "oracle/load_graph.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* POSIX's, of <stdio.h>. A program of another domain has its runtime's header before all else, and
 * with -std=c11 that header has settled that there is nothing of POSIX. */
FILE *open_memstream(char **text, size_t *length);

struct dag *load_graph(const char *path, const struct dag_options *options, const char *name,
                       int *index, struct messages *messages)
{
    char *text = NULL;
    size_t length = 0;
    FILE *errors = open_memstream(&text, &length);
    if (!errors) {
        (void)messages_say(messages, MESSAGE_MEMORY, "out of memory");
        return NULL;
    }
    struct dag *dag = dag_load_with(path, options, errors);
    if (fclose(errors) != 0 || !text)
        (void)messages_say(messages, MESSAGE_MEMORY, "out of memory");
    else if (!dag)
        (void)messages_say(messages, MESSAGE_GRAPH, "%s", text);
    free(text);
    if (!dag)
        return NULL;
    *index = dag_oracle(dag, name);
    if (*index >= 0)
        return dag;
    if (name)
        (void)messages_say(messages, MESSAGE_ARGUMENT, "no oracle '%s' here", name);
    else
        (void)messages_say(messages, MESSAGE_ARGUMENT, "%d oracles here, not one",
                           dag->oracle_count);
    dag_free(dag);
    return NULL;
}

int graph_lacks_extern(const struct dag *dag, int callback, struct messages *messages)
{
    const struct callback *c = &dag->callbacks[callback];
    char what[200], note[400], *text = NULL;
    size_t length = 0;
    FILE *out = open_memstream(&text, &length);
    if (!out)
        return messages_say(messages, MESSAGE_MEMORY, "out of memory");
    snprintf(what, sizeof what, "nothing defines the extern '%s', which the oracle reads", c->name);
    snprintf(note, sizeof note,
             "define in C: double %s(const struct discussion *d); radiosity takes the file by "
             "--plugin, other programs take the function in interpretation.externs",
             c->name);
    dag_print_error(dag, c->where, what, note, out);
    if (fclose(out) != 0 || !text)
        (void)messages_say(messages, MESSAGE_MEMORY, "out of memory");
    else
        (void)messages_say(messages, MESSAGE_GRAPH, "%s", text);
    free(text);
    return -1;
}
