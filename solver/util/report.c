/* report.c - messages on stderr in the form that editors and compilers share.
 * SPDX-License-Identifier: MIT */
#include "util/report.h"

#include <stdarg.h>
#include <stdio.h>

#include "util/temporary.h"

static void report(const char *path, uint32_t line, const char *kind, const char *format,
                   va_list arguments)
{
    char text[1024];
    if (temporary_stopping())
        return;
    vsnprintf(text, sizeof text, format, arguments);
    /* Words of a damaged file must not steer the terminal. */
    for (char *c = text; *c; c++)
        if (((unsigned char)*c < ' ' && *c != '\n' && *c != '\t') || *c == 127)
            *c = '?';
    if (line)
        fprintf(stderr, "%s:%u: %s: %s\n", path, (unsigned)line, kind, text);
    else
        fprintf(stderr, "%s: %s: %s\n", path, kind, text);
}

int report_error(const char *path, uint32_t line, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    report(path, line, "error", format, arguments);
    va_end(arguments);
    return -1;
}

void report_warning(const char *path, uint32_t line, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    report(path, line, "warning", format, arguments);
    va_end(arguments);
}
