/* headers.h - C headers: where dagc finds those that a catalog names, and what they include.
 * SPDX-License-Identifier: MIT */
#ifndef HEADERS_H
#define HEADERS_H

struct dag_header {
    const char *name; /* as in an #include: "tools/larger.h" */
    const char *text;
};

struct dag;

/* The header `name`: of the two, `beside` is the folder of who asks for it (NULL: none), built-in
 * ones are there if `built_in`. Its text in the arena, the same for the same file, and its path;
 * NULL: there is none. */
enum header_search { BESIDE_FIRST /* then -I, as C does */, BESIDE_LAST };
const char *dag_find_header(struct dag *dag, const char *name, const char *beside,
                            enum header_search search, int built_in, const char **path);

/* The folder of a path, its last '/' included; "" when it has none. */
const char *dag_folder_of(struct dag *dag, const char *path);

/* The folder of a source; NULL: it is no file. */
const char *dag_source_folder(struct dag *dag, int source);

/* Is the catalog's runtime dagc's own? Only then are headers that are built in meant. */
int dag_runtime_is_ours(struct dag *dag);

/* ends with a NULL name (dagc/emit/embed_headers.sh makes it) */
extern const struct dag_header dagc_headers[];

/* Likewise, for --prove: the runtime's interpreter and what it includes. */
extern const struct dag_header dagc_interpreter[];

#endif
