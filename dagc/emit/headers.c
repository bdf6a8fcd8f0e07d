/* headers.c - a C header's text: beside who asks for it, from the first folder of -I that has it,
 * or built into the command. It becomes a source: what is made of it depends on it as on the graph
 * (--depfile).
 * SPDX-License-Identifier: MIT */
#include <errno.h>
#include <string.h>

#include "emit/headers.h"
#include "base/internal.h"

/* The text of the file, "" after an error that has been reported; NULL: there is no such file. */
static const char *text_of(struct dag *dag, const char *path)
{
    struct input input;
    const char *text = NULL;
    dag_input_open_named(&input, path);
    for (int i = 0; i < dag->source_count && input.error == 0 && text == NULL; i++)
        if (dag->sources[i].on_disk && dag->sources[i].device == input.device
            && dag->sources[i].inode == input.inode)
            text = dag->sources[i].text;
    if (text == NULL && input.error != ENOENT && input.error != ENOTDIR) {
        dag->reading = input.owned; /* should memory run out, dag_free frees it */
        int source = dag_read(dag, &input);
        dag->reading = NULL;
        text = source < 0 ? "" : dag->sources[source].text;
    }
    dag_input_close(&input);
    return text;
}

const char *dag_folder_of(struct dag *dag, const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash == NULL ? "" : dag_copy(&dag->arena, path, (size_t)(slash + 1 - path));
}

const char *dag_find_header(struct dag *dag, const char *name, const char *beside,
                            enum header_search search, int built_in, const char **path)
{
    int last = dag->folder_count + 1; /* attempts: 0, or the last, is beside */
    for (int i = 0; i <= last; i++) {
        if (i == 0 || i == last) {
            if (beside == NULL || (i == 0) != (search == BESIDE_FIRST))
                continue;
            *path = dag_format(&dag->arena, "%s%s", beside, name);
        } else
            *path = dag_format(&dag->arena, "%s/%s", dag->folders[i - 1], name);
        const char *text = text_of(dag, *path);
        if (text != NULL)
            return text;
    }
    *path = name;
    for (int i = 0; built_in && dagc_headers[i].name != NULL; i++)
        if (strcmp(dagc_headers[i].name, name) == 0)
            return dagc_headers[i].text;
    return NULL;
}

const char *dag_source_folder(struct dag *dag, int source)
{
    return source >= 0 && dag->sources[source].is_file
               ? dag_folder_of(dag, dag->sources[source].name)
               : NULL;
}

int dag_runtime_is_ours(struct dag *dag)
{
    const char *path, *beside = dag_source_folder(dag, dag->runtime_where.source);
    const char *text = dag_find_header(dag, dag->runtime_header, beside, BESIDE_LAST, 1, &path);
    for (int i = 0; dagc_headers[i].name != NULL; i++)
        if (dagc_headers[i].text == text)
            return 1;
    return 0;
}
