/* headers.h - the runtime's headers built into the command, as the standard catalog is.
 * SPDX-License-Identifier: MIT */
#ifndef HEADERS_H
#define HEADERS_H

struct dag_header {
    const char *name; /* as in an #include: "tools/larger.h" */
    const char *text;
};

struct dag;

/* A header's text, in the arena; NULL: there is none of this name. */
const char *dag_header_text(struct dag *dag, const char *name);

/* ends with a NULL name (dagc/emit/embed_headers.sh makes it) */
extern const struct dag_header dagc_headers[];

/* Likewise, for --prove: the runtime's interpreter and what it includes. */
extern const struct dag_header dagc_interpreter[];

#endif
