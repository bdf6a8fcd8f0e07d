/* import.c - the files that files ask for.
 *
 * Parsing only notes an import; the files are read one after the other when the one at hand is
 * parsed, so that neither a long chain nor a cycle of imports costs a stack. A file is read once,
 * however many paths lead to it. It is looked for beside the importing file, then in each of
 * dag->folders.
 * SPDX-License-Identifier: MIT */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "base/internal.h"

static int known(const struct dag *dag, const struct input *input)
{
    for (int i = 0; i < dag->source_count; i++)
        if (dag->sources[i].on_disk && dag->sources[i].device == input->device
            && dag->sources[i].inode == input->inode)
            return i;
    return -1;
}

static int known_standard(const struct dag *dag)
{
    for (int i = 0; i < dag->source_count; i++)
        if (dag->sources[i].standard)
            return i;
    return -1;
}

/* The path of attempt `at`: 0 beside the importing file, then the folders; NULL: no more. */
static const char *candidate(struct dag *dag, const struct import *import, int at)
{
    const struct source *from = &dag->sources[import->where.source];
    if (import->path[0] == '/')
        return at == 0 ? import->path : NULL;
    if (at == 0)
        return dag_format(&dag->arena, "%.*s%s", (int)(from->base - from->name), from->name,
                          import->path);
    if (at > dag->folder_count)
        return NULL;
    const char *folder = dag->folders[at - 1];
    size_t length = strlen(folder);
    return dag_format(&dag->arena, "%s%s%s", folder,
                      length > 0 && folder[length - 1] != '/' ? "/" : "", import->path);
}

static void cannot(struct dag *dag, const struct import *import, int error)
{
    dag_error(dag, import->where, "cannot import \"%s\": %s", import->path,
              error == ENOTSUP ? "it is a pipe or a device; give a file" : strerror(error));
    if (error != ENOENT)
        return;
    if (import->path[0] != '/')
        dag_note(dag, dag_nowhere, "looked for beside this file%s",
                 dag->folder_count > 0 ? " and in the folders given with -I"
                                       : "; give other folders with -I");
}

/* Index of the source, which `fresh` says is to be parsed; -1 after an error. */
static int read_import(struct dag *dag, const struct import *import, int *fresh)
{
    int failure = ENOENT;
    const char *path;
    *fresh = 0;
    for (int at = 0; (path = candidate(dag, import, at)) != NULL; at++) {
        struct input input;
        dag_input_open_named(&input, path);
        dag->reading = input.owned; /* should memory run out, dag_free frees it */
        int source = -1;
        if (input.error == 0) {
            source = known(dag, &input);
            if (source < 0) {
                source = dag_read(dag, &input);
                *fresh = source >= 0;
            }
        } else if (failure == ENOENT)
            failure = input.error;
        dag->reading = NULL;
        dag_input_close(&input);
        if (input.error == 0)
            return source;
        if (input.error == ENOMEM) /* it may well be there: no other of this name is meant */
            dag_out_of_memory(&dag->arena);
    }
    cannot(dag, import, failure);
    return -1;
}

int dag_next_import(struct dag *dag)
{
    while (dag->imports_read < dag->import_count) {
        struct import *import = &dag->imports[dag->imports_read++];
        int fresh = 0;
        if (import->path != NULL)
            import->source = read_import(dag, import, &fresh);
        else {
            import->source = known_standard(dag);
            fresh = import->source < 0;
            if (fresh)
                import->source = dag_read_text(dag, "the standard catalog", dagc_standard_catalog,
                                               strlen(dagc_standard_catalog));
        }
        if (fresh && import->source >= 0) {
            dag->sources[import->source].importer = import->where;
            return import->source;
        }
    }
    return -1;
}
