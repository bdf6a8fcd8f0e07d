/* headers.c - the text of a runtime's header: from the first folder of -I that has it, else the one
 * built into the command. It becomes a source: what is made of it depends on it as on the graph
 * (--depfile).
 * SPDX-License-Identifier: MIT */
#include <errno.h>
#include <string.h>

#include "emit/headers.h"
#include "base/internal.h"

const char *dag_header_text(struct dag *dag, const char *name)
{
    for (int i = 0; i < dag->folder_count; i++) {
        struct input input;
        dag_input_open(&input, dag_format(&dag->arena, "%s/%s", dag->folders[i], name));
        if (input.error != ENOENT && input.error != ENOTDIR) {
            dag->reading = input.owned; /* should memory run out, dag_free frees it */
            int source = dag_read(dag, &input);
            dag->reading = NULL;
            dag_input_close(&input);
            return source < 0 ? "" : dag->sources[source].text;
        }
        dag_input_close(&input);
    }
    for (int i = 0; dagc_headers[i].name != NULL; i++)
        if (strcmp(dagc_headers[i].name, name) == 0)
            return dagc_headers[i].text;
    return NULL;
}
