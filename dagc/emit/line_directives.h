/* line_directives.h - #line in the C text.
 * SPDX-License-Identifier: MIT */
#ifndef LINE_DIRECTIVES_H
#define LINE_DIRECTIVES_H

#include "base/internal.h"

/* What follows is line `line` of that file; is where a source says; is the generated text's own.
 * Each is a line of its own. */
void dag_line_in(struct text *out, const char *path, int line);
void dag_line_at(const struct dag *dag, struct text *out, struct where where);
void dag_line_here(struct text *out);

/* When the text is whole: the places of dag_line_here get the name of its file and their line. */
void dag_number_lines(struct text *text, const char *path);

#endif
