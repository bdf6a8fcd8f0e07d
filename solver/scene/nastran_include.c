/* nastran_include.c - see nastran_include.h.
 * SPDX-License-Identifier: MIT */
#include "scene/nastran_include.h"

#include <errno.h>
#include <string.h>
#include <strings.h>

#include "scene/text_lines.h"
#include "util/beside.h"
#include "util/report.h"
#include "util/text_file.h"

enum { NAME = 1024 };

const char *nastran_is_include(const char *line, const char *end)
{
    static const char word[] = "INCLUDE";
    while (line < end && is_blank(*line))
        line++;
    if (end - line < (ptrdiff_t)sizeof word - 1 || strncasecmp(line, word, sizeof word - 1) != 0)
        return NULL;
    line += sizeof word - 1;
    return line < end && (is_blank(*line) || *line == '\'' || *line == '"') ? line : NULL;
}

int nastran_include(const char *path, uint32_t line, const char *name, const char **end,
                    const char *text_end, struct nastran_include *to)
{
    char plain[NAME];
    size_t n = 0;
    while (name < *end && is_blank(*name))
        name++;
    const char quote = name < *end && (*name == '\'' || *name == '"') ? *name : '\0';
    const char *c = name + (quote != 0), *const last = quote ? text_end : *end;
    for (; c < last && n < NAME - 1 && (quote ? *c != quote : !is_blank(*c)); c++) {
        const int breaks = *c == '\n' || *c == '\r';
        if (breaks || (is_blank(*c) && c > name && (c[-1] == '\n' || is_blank(c[-1]))))
            continue; /* blanks before the next part */
        plain[n++] = *c;
        if (plain[n - 1] == '\\')
            plain[n - 1] = '/';
    }
    if (!n || n == NAME - 1 || (quote && c == last))
        return report_error(path, line, "INCLUDE names no file; write its name in quotes");
    *end = c > *end ? c : *end;
    to->path = path_beside(path, plain, n);
    to->text = to->path ? text_file_read_regular(to->path, &to->size) : NULL;
    if (to->text)
        return 0;
    report_error(path, line, "INCLUDE of '%s': %s; put it there or correct the name",
                 to->path ? to->path : "", strerror(to->path ? errno : ENOMEM));
    free(to->path);
    return -1;
}
