/* report.c - messages on stderr in the form that editors and compilers share.
 * SPDX-License-Identifier: MIT */
#include "util/report.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "util/machines.h"
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
    char all[2048], at[16] = "";
    if (line)
        snprintf(at, sizeof at, ":%u", (unsigned)line);
    snprintf(all, sizeof all, "%s%s: %s: %s\n", path, at, kind, text);
    if (!machines_keep(all, strcmp(kind, "error") == 0))
        fputs(all, stderr);
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
