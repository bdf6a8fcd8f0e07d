/* depfile.c - which files the outputs depend on, in the syntax of make.
 *
 * As of gcc -MD -MP: one rule, outputs: inputs, then an empty rule for every input but the first,
 * so that make goes on when an imported file is gone. The catalog inside dagc is no file.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "command/depfile.h"
#include "command/options.h"

/* A name that make reads as one word and as written. */
static void print_name(struct text *out, const char *name)
{
    for (; *name != '\0'; name++) {
        if (strchr(" \t#%:", *name) != NULL)
            dag_print(out, "\\");
        else if (*name == '$')
            dag_print(out, "$");
        dag_print(out, "%c", *name);
    }
}

/* A file read twice is named once. */
static int is_first(const struct dag *dag, int source)
{
    for (int i = 0; i < source; i++)
        if (dag->sources[i].is_file && strcmp(dag->sources[i].name, dag->sources[source].name) == 0)
            return 0;
    return dag->sources[source].is_file;
}

void dag_emit_depfile(const struct dag *dag, struct output *outputs)
{
    struct text *out = &outputs[OUTPUT_DEPFILE].text;
    const char *gap = "";
    int source = -1;
    if (outputs[OUTPUT_DEPFILE].path == NULL)
        return;
    for (int i = 0; i < OUTPUT_DEPFILE; i++)
        if (outputs[i].path != NULL && strcmp(outputs[i].path, "-") != 0) {
            dag_print(out, "%s", gap);
            print_name(out, outputs[i].path);
            gap = " ";
        }
    dag_print(out, ":");
    for (int i = 0; i < dag->source_count; i++)
        if (is_first(dag, i)) {
            dag_print(out, " ");
            print_name(out, dag->sources[i].name);
        }
    dag_print(out, "\n");
    for (int i = 0; i < dag->oracle_count; i++)
        source = dag->oracles[i].where.source;
    for (int i = 0; i < dag->source_count; i++)
        if (is_first(dag, i) && i != source) {
            print_name(out, dag->sources[i].name);
            dag_print(out, ":\n");
        }
}
