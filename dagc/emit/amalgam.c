/* amalgam.c - C files put one into the other, as their #include lines say.
 *
 * A file goes in whole and as it is, at the place of its first #include; the lines it has for
 * itself (#undef, conditions, pragmas) mean there what they meant. What is not found stays an
 * #include: it is the program's, or the system's.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "emit/amalgam.h"
#include "emit/headers.h"
#include "emit/line_directives.h"

enum { FILES_DEEP = 200 };

static int has_word(const struct c_token *token, const char *directive, const char *word)
{
    const char *what = dag_c_directive(token, directive);
    return what != NULL && strncmp(what, word, strlen(word)) == 0;
}

/* Does #ifndef NAME, #define NAME ... #endif hold all of it? Or is there a #pragma once? */
static void find_guard(struct dag *dag, struct amalgam_file *file)
{
    const struct c_token *first = NULL, *second = NULL, *last = NULL;
    int depth = 0, closed = 0;
    for (int i = 0; i < file->tokens.count; i++) {
        const struct c_token *token = &file->tokens.items[i];
        if (token->kind == C_SPACE || token->kind == C_COMMENT)
            continue;
        if (has_word(token, "pragma", "once"))
            file->once = 1;
        depth += dag_c_directive(token, "if") != NULL || dag_c_directive(token, "ifdef") != NULL
                 || dag_c_directive(token, "ifndef") != NULL;
        depth -= dag_c_directive(token, "endif") != NULL;
        closed += depth == 0;
        second = first != NULL && second == NULL ? token : second;
        first = first == NULL ? token : first;
        last = token;
    }
    if (second != NULL && closed == 1 && dag_c_directive(last, "endif") != NULL) {
        const char *guard = dag_c_directive(first, "ifndef");
        const char *defined = dag_c_directive(second, "define");
        file->guarded = guard != NULL && defined != NULL
                        && strcmp(dag_c_copy_name(dag, guard), dag_c_copy_name(dag, defined)) == 0;
    }
    file->guarded |= file->once;
}

/* Two names joined to one cannot be seen, and so be given no prefix. */
static void refuse_joined(struct amalgam *amalgam, const struct amalgam_file *file)
{
    int line = 1;
    for (int i = 0; i < file->tokens.count; i++) {
        const struct c_token *token = &file->tokens.items[i];
        for (size_t k = 0; k < token->length; k++) {
            if (token->kind == C_DIRECTIVE && dag_c_directive(token, "define") != NULL
                && k + 1 < token->length && memcmp(token->text + k, "##", 2) == 0) {
                dag_error(amalgam->dag, dag_nowhere,
                          "%s:%d: '##' makes names here that --standalone cannot give its prefix",
                          file->path, line);
                dag_note(amalgam->dag, dag_nowhere,
                         "write the names out, or leave the file where it is: --host %s",
                         file->name);
                return;
            }
            line += token->text[k] == '\n';
        }
    }
}

static int add_file(struct amalgam *amalgam, const char *name, const char *path, const char *text,
                    const char *beside)
{
    struct dag *dag = amalgam->dag;
    for (int i = 0; i < amalgam->file_count; i++)
        if (amalgam->files[i].text == text)
            return i;
    amalgam->files =
        dag_grow(&dag->arena, amalgam->files, amalgam->file_count, sizeof *amalgam->files);
    struct amalgam_file *file = &amalgam->files[amalgam->file_count];
    *file = (struct amalgam_file){.name = name, .path = path, .text = text, .beside = beside};
    file->tokens = dag_c_tokens(dag, text, strlen(text));
    file->built_in = strcmp(path, name) == 0 && beside == NULL;
    find_guard(dag, file);
    refuse_joined(amalgam, file);
    dag_c_collect(dag, &amalgam->names, &file->tokens);
    for (int i = 0; i < file->tokens.count; i++)
        if (file->tokens.items[i].kind == C_NAME && file->tokens.items[i].member)
            dag_put(&dag->arena, &amalgam->members,
                    dag_c_copy_name(dag, file->tokens.items[i].text), 1);
    return amalgam->file_count++;
}

void dag_amalgam_text(struct amalgam *amalgam, const char *name, const char *text)
{
    int file = add_file(amalgam, name, name, text, NULL); /* the array may grow */
    amalgam->files[file].made = 1;
}

/* Index of the file; -1: there is none, or it is the program's. */
static int find_file(struct amalgam *amalgam, const char *name, const char *beside,
                     enum header_search search)
{
    const char *path, *text;
    for (int i = 0; search == BESIDE_FIRST && i < amalgam->host_count; i++)
        if (strcmp(amalgam->host[i], name) == 0)
            return -1;
    for (int i = 0; i < amalgam->file_count; i++) /* the catalog.h that is made here is meant */
        if ((amalgam->files[i].beside == NULL || beside == NULL)
            && strcmp(amalgam->files[i].name, name) == 0)
            return i;
    text = dag_find_header(amalgam->dag, name, beside, search, amalgam->built_in, &path);
    if (text == NULL && search == BESIDE_FIRST && amalgam->catalog != NULL)
        text = dag_find_header(amalgam->dag, name, amalgam->catalog, BESIDE_LAST, 0, &path);
    if (text == NULL)
        return -1;
    int is_file = 1;
    for (int i = 0; dagc_headers[i].name != NULL; i++)
        is_file &= dagc_headers[i].text != text;
    return add_file(amalgam, name, path, text, is_file ? dag_folder_of(amalgam->dag, path) : NULL);
}

static void put_file(struct amalgam *amalgam, struct text *out, int index, int conditional);

/* The first comment of a file of dagc's own, without the line that names its licence: what is
 * generated is its user's. */
static void print_comment(struct text *out, const struct c_token *comment)
{
    size_t length = comment->length;
    for (size_t i = 0; i + 4 < length; i++)
        if (memcmp(comment->text + i, "SPDX", 4) == 0) {
            while (i > 0 && strchr(" *\n", comment->text[i - 1]) != NULL)
                i--;
            dag_print(out, "%.*s */", (int)i, comment->text);
            return;
        }
    dag_print(out, "%.*s", (int)length, comment->text);
}

/* #include "NAME": the file in its place, if it is found. */
static int put_included(struct amalgam *amalgam, struct text *out, const struct amalgam_file *from,
                        const struct c_token *token, int conditional)
{
    const char *what = dag_c_directive(token, "include");
    const char *end = what == NULL || *what != '"' ? NULL : strchr(what + 1, '"');
    if (end == NULL)
        return 0;
    const char *name = dag_copy(&amalgam->dag->arena, what + 1, (size_t)(end - what - 1));
    int index = find_file(amalgam, name, from->beside, BESIDE_FIRST);
    if (index < 0)
        return 0;
    put_file(amalgam, out, index, conditional);
    return 1;
}

/* What follows is line `line` of the file; texts that were made here have no file. */
static void print_directive(const struct amalgam *amalgam, struct text *out,
                            const struct amalgam_file *file, int line)
{
    if (!amalgam->directives || out == NULL)
        return;
    if (file->made)
        dag_line_here(out);
    else
        dag_line_in(out, file->path, line);
}

static int lines_in(const struct c_token *token)
{
    int lines = 0;
    for (size_t i = 0; i < token->length; i++)
        lines += token->text[i] == '\n';
    return lines;
}

static void put_file(struct amalgam *amalgam, struct text *out, int index, int conditional)
{
    struct dag *dag = amalgam->dag;
    const struct amalgam_file file = amalgam->files[index]; /* the array may grow */
    const struct c_token *before = NULL;
    int depth = conditional, first = 1, skip = 0, wrap = file.once && conditional;
    if (file.guarded && file.in)
        return;
    if (++amalgam->depth > FILES_DEEP) {
        if (amalgam->depth == FILES_DEEP + 1)
            dag_error(dag, dag_nowhere, "%s includes itself without end", file.path);
        return;
    }
    amalgam->files[index].in |= (unsigned char)!conditional;
    if (wrap && out != NULL)
        dag_print(out, "#ifndef %s_ONCE_%d\n#define %s_ONCE_%d\n", amalgam->prefix, index,
                  amalgam->prefix, index);
    int own = file.guarded && !file.once, line = 1; /* its guard is no condition */
    print_directive(amalgam, out, &file, line);
    for (int i = 0; i < file.tokens.count; i++) {
        const struct c_token *token = &file.tokens.items[i];
        int opens = dag_c_directive(token, "if") != NULL || dag_c_directive(token, "ifdef") != NULL
                    || dag_c_directive(token, "ifndef") != NULL;
        depth += opens && !own;
        own &= !opens;
        depth -= dag_c_directive(token, "endif") != NULL && depth > conditional;
        line += lines_in(token);
        if (put_included(amalgam, out, &file, token, depth) || has_word(token, "pragma", "once")) {
            skip = 1; /* the end of its line */
            print_directive(amalgam, out, &file, line + 1);
            continue;
        }
        if (out == NULL)
            continue;
        if (token->kind == C_COMMENT && first && file.built_in) {
            print_comment(out, token);
            print_directive(amalgam, out, &file, line);
        } else if (skip && token->kind == C_SPACE && *token->text == '\n')
            dag_print(out, "%.*s", (int)token->length - 1, token->text + 1);
        else
            dag_c_print(dag, out, token, before, &amalgam->names, amalgam->prefix);
        skip = 0;
        first &= token->kind == C_SPACE;
        if (token->kind != C_SPACE && token->kind != C_COMMENT)
            before = token;
    }
    if (wrap && out != NULL)
        dag_print(out, "#endif\n");
    amalgam->depth--;
}

int dag_amalgam_put(struct amalgam *amalgam, struct text *out, const char *name, const char *beside)
{
    int index = find_file(amalgam, name, beside, BESIDE_LAST);
    amalgam->catalog = beside;
    if (index < 0)
        return 0;
    amalgam->depth = 0;
    if (out != NULL && !(amalgam->files[index].guarded && amalgam->files[index].in))
        dag_print(out, "\n");
    put_file(amalgam, out, index, 0);
    if (amalgam->directives && out != NULL)
        dag_line_here(out);
    return 1;
}

void dag_amalgam_again(struct amalgam *amalgam)
{
    for (int i = 0; i < amalgam->file_count; i++)
        amalgam->files[i].in = 0;
}
