/* parameter_file.c - see parameter_file.h.
 * SPDX-License-Identifier: MIT */
#include "util/parameter_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "util/near_name.h"
#include "util/open_oracle.h"
#include "util/report.h"
#include "util/text_file.h"

#define BLANKS " \t\r\f\v"
enum { NAME_SIZE = 64 }; /* a name in a graph has at most 63 characters */

struct parameter_file {
    const char *path, *named;
    RadDevice device;
    RadOracle oracle;
    struct RadOracleReport report;
    uint32_t line, *lines; /* [report.parameter_count]: which line set it; 0: none */
    int named_oracle;      /* a line has said which oracle it is about */
};

static int unknown(const struct parameter_file *f, const char *name)
{
    struct near_name near = near_name(name, strlen(name));
    char names[1000] = "none";
    int length = 0;
    for (int i = 0; i < f->report.parameter_count; i++)
        near_name_offer(&near, f->report.parameters[i].name);
    for (int i = 0; i < f->report.parameter_count && length < (int)sizeof names; i++)
        length += snprintf(names + length, sizeof names - (size_t)length, "%s%s", i ? ", " : "",
                           f->report.parameters[i].name);
    return report_error(f->path, f->line, "oracle %s has no parameter %s; %s%s%s", f->report.name,
                        name, near.best ? "did you mean " : "it has ",
                        near.best ? near.best : names, near.best ? "?" : "");
}

static int set(struct parameter_file *f, const char *name, const char *text)
{
    int i = 0;
    while (i < f->report.parameter_count && strcmp(f->report.parameters[i].name, name) != 0)
        i++;
    if (i == f->report.parameter_count)
        return unknown(f, name);
    if (f->lines[i])
        return report_error(f->path, f->line, "%s is set twice, first in line %u; keep one of them",
                            name, (unsigned)f->lines[i]);
    f->lines[i] = f->line;
    return set_oracle_parameter(f->device, f->oracle, name, text, f->path, f->line);
}

/* "oracle NAME" */
static int name_oracle(struct parameter_file *f, char *text)
{
    size_t word = strcspn(text, BLANKS);
    char *name = text + word + strspn(text + word, BLANKS);
    if (strncmp(text, "oracle", word) != 0 || word != 6 || !*name || strpbrk(name, BLANKS "="))
        return report_error(f->path, f->line,
                            "the first line says whose parameters these are; write oracle %s",
                            f->report.name);
    if (strcmp(name, f->report.name) != 0)
        return report_error(f->path, f->line,
                            "these are parameters of oracle %s, but --oracle is %s; give %s, or "
                            "its file, by --oracle",
                            name, f->named, name);
    f->named_oracle = 1;
    return 0;
}

/* One line, its end a 0, which it may change. */
static int read_line(struct parameter_file *f, char *text)
{
    text[strcspn(text, "#")] = 0;
    text += strspn(text, BLANKS);
    size_t length = strlen(text);
    while (length && strchr(BLANKS, text[length - 1]))
        text[--length] = 0;
    if (!*text)
        return 0;
    if (!f->named_oracle)
        return name_oracle(f, text);
    char *equals = strchr(text, '='), name[NAME_SIZE];
    size_t end = equals ? (size_t)(equals - text) : 0;
    while (end && strchr(BLANKS, text[end - 1]))
        end--;
    if (!end)
        return report_error(f->path, f->line, "'%s' sets nothing; write NAME = VALUE", text);
    if (end >= sizeof name)
        return report_error(f->path, f->line,
                            "'%.*s' is too long for a name; it has %d letters at the most",
                            (int)end, text, NAME_SIZE - 1);
    memcpy(name, text, end);
    name[end] = 0;
    return set(f, name, equals + 1 + strspn(equals + 1, BLANKS));
}

int parameter_file_apply(const char *path, RadDevice device, RadOracle oracle, const char *named)
{
    struct parameter_file f = {.path = path, .named = named, .device = device, .oracle = oracle};
    radGetOracleReport(oracle, &f.report);
    size_t size;
    char *text = text_file_need(path, &size);
    if (!text)
        return -1;
    f.lines = calloc((size_t)f.report.parameter_count + 1, sizeof *f.lines);
    int status = f.lines ? 0 : report_error(path, 0, "out of memory");
    if (status == 0 && strlen(text) != size)
        status =
            report_error(path, 0, "not a text: it has a byte 0; give a file as a panel saves it");
    for (char *at = text + text_mark(text), *end = text + size; status == 0 && at < end;) {
        char *next = at + strcspn(at, "\n");
        *next = 0;
        f.line++;
        status = read_line(&f, at);
        at = next + 1;
    }
    if (status == 0 && !f.named_oracle)
        status = report_error(path, 0, "no line says whose parameters these are; write oracle %s",
                              f.report.name);
    free(f.lines);
    free(text);
    return status;
}
