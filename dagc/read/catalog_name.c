/* catalog_name.c - the catalog that a graph's file names.
 *
 * The catalog is read before the graph, which cannot be parsed without it, so that its name is
 * looked for in the bare text: the word `catalog` and a string, outside of braces, strings and
 * comments. It is taken where nothing else was said; where something was, the parser compares.
 * SPDX-License-Identifier: MIT */
#include <ctype.h>
#include <errno.h>
#include <string.h>

#include "base/internal.h"

static const char *past_blanks(const char *at, const char *end)
{
    while (at < end && (isspace((unsigned char)*at) || *at == '#'))
        if (*at == '#')
            while (at < end && *at != '\n')
                at++;
        else
            at++;
    return at;
}

const char *dag_named_catalog(struct dag *dag, const struct input *file)
{
    static const char word[] = "catalog";
    if (file->bytes == NULL) /* it cannot be read, which is told later */
        return NULL;
    const char *end = file->bytes + file->length, *at = past_blanks(file->bytes, end);
    for (int depth = 0; at < end; at = past_blanks(at, end)) {
        if (*at == '"') {
            for (at++; at < end && *at != '"' && *at != '\n'; at++)
                at += *at == '\\' && at + 1 < end;
            at += at < end;
        } else if (isalpha((unsigned char)*at)) {
            const char *begin = at;
            while (at < end && (isalnum((unsigned char)*at) || *at == '_'))
                at++;
            if (depth > 0 || (size_t)(at - begin) != strlen(word)
                || memcmp(begin, word, strlen(word)) != 0)
                continue;
            begin = past_blanks(at, end);
            const char *close = begin < end && *begin == '"'
                                    ? memchr(begin + 1, '"', (size_t)(end - begin - 1))
                                    : NULL;
            if (close != NULL)
                return dag_copy(&dag->arena, begin + 1, (size_t)(close - begin - 1));
        } else {
            depth += *at == '{';
            depth -= *at == '}';
            at++;
        }
    }
    return NULL;
}

int dag_open_catalog(struct dag *dag, const char *path, const char *beside, struct input *input)
{
    const char *slash = strrchr(beside, '/');
    int length = slash != NULL ? (int)(slash + 1 - beside) : 0;
    const char *at =
        path[0] == '/' ? path : dag_format(&dag->arena, "%.*s%s", length, beside, path);
    dag_input_open_named(input, at);
    for (int i = 0; i < dag->folder_count && input->error == ENOENT && path[0] != '/'; i++) {
        dag_input_close(input);
        dag_input_open_named(input, dag_format(&dag->arena, "%s/%s", dag->folders[i], path));
    }
    return input->error == 0;
}

const char *dag_other_catalog(struct dag *dag, const char *path, int source)
{
    const struct source *taken = &dag->sources[0];
    struct input input;
    if (path == NULL)
        return taken->standard
                   ? NULL
                   : dag_format(&dag->arena, "not for %s: leave --catalog away", taken->name);
    int there = dag_open_catalog(dag, path, dag->sources[source].name, &input);
    dag->opened = input.owned; /* should memory run out, dag_free frees it */
    int same =
        there && taken->on_disk && taken->device == input.device && taken->inode == input.inode;
    /* a copy of it, or a text in memory, is as good */
    same |= there && (size_t)taken->length == input.length
            && memcmp(taken->text, input.bytes, input.length) == 0;
    const char *wrong =
        there ? dag_format(&dag->arena, "not for %s: leave --catalog away", taken->name)
              : dag_format(&dag->arena, "which cannot be read: %s", strerror(input.error));
    dag->opened = NULL;
    dag_input_close(&input);
    return same ? NULL : wrong;
}
