/* line_directives.c - #line, so that compilers and debuggers point into the files that text was
 * made of (--line-directives).
 *
 * A directive holds until the next one, so what is not out of a file must say so, too: it is on a
 * line of the generated file, which is known only when all of the text is there. Until then such
 * places hold a directive that no compiler would take; dag_number_lines fills them in.
 * [ISO C11, 6.10.4; as yacc and lex do]
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "emit/line_directives.h"

static const char unknown[] = "#line 0 \"\"\n";

static void begin_line(struct text *out)
{
    if (out->length > 0 && out->bytes[out->length - 1] != '\n')
        dag_print(out, "\n");
}

void dag_line_in(struct text *out, const char *path, int line)
{
    begin_line(out);
    dag_print(out, "#line %d ", line);
    dag_print_string(out, path);
    dag_print(out, "\n");
}

void dag_line_at(const struct dag *dag, struct text *out, struct where where)
{
    if (where.source < 0)
        dag_line_here(out);
    else
        dag_line_in(out, dag->sources[where.source].name,
                    dag_line(&dag->sources[where.source], where.offset));
}

void dag_line_here(struct text *out)
{
    begin_line(out);
    dag_print(out, "%s", unknown);
}

void dag_number_lines(struct text *text, const char *path)
{
    struct text out = {0};
    const char *from = text->bytes, *end = from == NULL ? NULL : from + text->length;
    for (int line = 1; from < end; line++) {
        const char *next = memchr(from, '\n', (size_t)(end - from));
        next = next == NULL ? end : next + 1;
        if ((size_t)(next - from) == sizeof unknown - 1
            && memcmp(from, unknown, sizeof unknown - 1) == 0)
            dag_line_in(&out, path, line + 1);
        else
            dag_print(&out, "%.*s", (int)(next - from), from);
        from = next;
    }
    out.failed |= text->failed;
    dag_text_free(text);
    *text = out;
}
