/* diag.c - the sink of all messages.
 *
 * Passes report in the order they find things; the reader wants the order of the file. So
 * messages are kept and printed at the end, sorted by place, each with its notes, the line and a
 * caret. The first ERRORS_SHOWN errors and as many warnings are kept, the others counted.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>

#include "base/internal.h"

const struct where dag_nowhere = {-1, 0, 0};

int dag_errors_full(const struct dag *dag)
{
    return dag->error_count >= ERRORS_SHOWN;
}

int dag_is_full(const struct dag *dag, enum severity severity)
{
    return (severity == SEVERITY_ERROR ? dag->error_count : dag->warning_count) >= ERRORS_SHOWN;
}

int dag_report(struct dag *dag, enum severity severity, struct where where, const char *message)
{
    int kept = severity == SEVERITY_NOTE ? !dag->muted : !dag_is_full(dag, severity);
    if (kept) {
        int index = ADD(dag, diagnostics, diagnostic_count);
        dag->diagnostics[index] = (struct diagnostic){severity, where, message, dag->use};
    }
    if (severity != SEVERITY_NOTE)
        dag->muted = (unsigned char)!kept;
    dag->error_count += severity == SEVERITY_ERROR;
    dag->warning_count += severity == SEVERITY_WARNING;
    return kept;
}

void dag_error(struct dag *dag, struct where where, const char *format, ...)
{
    const char *message = "";
    if (!dag_errors_full(dag)) {
        va_list arguments;
        va_start(arguments, format);
        message = dag_vformat(&dag->arena, format, arguments);
        va_end(arguments);
    }
    dag_report(dag, SEVERITY_ERROR, where, message);
}

void dag_note(struct dag *dag, struct where where, const char *format, ...)
{
    if (dag->muted)
        return;
    va_list arguments;
    va_start(arguments, format);
    dag_report(dag, SEVERITY_NOTE, where, dag_vformat(&dag->arena, format, arguments));
    va_end(arguments);
}

int dag_line(const struct source *source, int offset)
{
    int line = 1 + source->lines[offset / LINES_STEP];
    for (int i = offset / LINES_STEP * LINES_STEP; i < offset; i++)
        line += source->text[i] == '\n';
    return line;
}

/* ---- suggestions */

static int least(int a, int b)
{
    return a < b ? a : b;
}

/* Edit distance where swapping neighbours is one step (optimal string alignment). */
static int distance(const char *a, const char *b)
{
    int la = (int)strlen(a), lb = (int)strlen(b);
    if (la > NAME_MAX_LENGTH || lb > NAME_MAX_LENGTH)
        return NAME_MAX_LENGTH;
    int rows[3][NAME_MAX_LENGTH + 1];
    for (int j = 0; j <= lb; j++)
        rows[0][j] = j;
    for (int i = 1; i <= la; i++) {
        int *row = rows[i % 3], *above = rows[(i + 2) % 3], *two = rows[(i + 1) % 3];
        row[0] = i;
        for (int j = 1; j <= lb; j++) {
            row[j] = least(least(row[j - 1], above[j]) + 1, above[j - 1] + (a[i - 1] != b[j - 1]));
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = least(row[j], two[j - 2] + 1);
        }
    }
    return rows[la % 3][lb];
}

void dag_suggest(struct suggestion *suggestion, const char *candidate)
{
    int length = (int)strlen(suggestion->wanted);
    int limit = length <= 2 ? 1 : length <= 5 ? 2 : length / 3 + 1;
    int steps = distance(suggestion->wanted, candidate);
    if (steps <= limit && steps < length
        && (suggestion->best == NULL || steps < suggestion->distance)) {
        suggestion->best = candidate;
        suggestion->distance = steps;
    }
}

void dag_note_suggestion(struct dag *dag, const struct suggestion *suggestion)
{
    if (suggestion->best != NULL)
        dag_note(dag, dag_nowhere, "did you mean '%s'?", suggestion->best);
}

/* ---- printing */

static int starts_character(char byte)
{
    return ((unsigned char)byte & 0xc0) != 0x80;
}

/* At most this many bytes of a line are shown, around the caret. */
enum { LINE_SHOWN = 120 };

static void print_line(const struct source *source, const struct where *where, int start, FILE *out)
{
    int end = start, from = start;
    while (end < source->length && source->text[end] != '\n')
        end++;
    if (where->offset - start > LINE_SHOWN * 2 / 3)
        from = where->offset - LINE_SHOWN / 3;
    int to = end - from > LINE_SHOWN ? from + LINE_SHOWN : end;
    while (from > start && !starts_character(source->text[from]))
        from--;
    while (to < end && to > from && !starts_character(source->text[to]))
        to--;
    const char *left = from > start ? "..." : "", *right = to < end ? "..." : "";

    fprintf(out, "    %s", left);
    for (int i = from; i < to; i++) {
        unsigned char byte = (unsigned char)source->text[i];
        fputc(byte == '\t'                 ? '\t'
              : byte == '\r'               ? ' '
              : byte < ' ' || byte == 0x7f ? '?'
                                           : byte,
              out);
    }
    fprintf(out, "%s\n    %*s", right, (int)strlen(left), "");
    for (int i = from; i < where->offset; i++) {
        if (source->text[i] == '\t')
            fputc('\t', out);
        else if (starts_character(source->text[i]))
            fputc(' ', out);
    }
    fputc('^', out);
    int stop = least(where->offset + where->length, to);
    for (int i = where->offset + 1; i < stop; i++)
        if (starts_character(source->text[i]))
            fputc('~', out);
    fputc('\n', out);
}

/* file:line:col: severity: message, the line, the caret. Columns count characters, from 1. */
static void print_one(const struct dag *dag, const struct diagnostic *diagnostic, FILE *out)
{
    static const char *const words[] = {"error", "warning", "note"};
    const struct where *where = &diagnostic->where;
    const char *word = words[diagnostic->severity];
    if (where->source < 0) {
        const char *indent = diagnostic->severity == SEVERITY_NOTE ? "    " : "dagc: ";
        fprintf(out, "%s%s: %s\n", indent, word, diagnostic->message);
        return;
    }
    const struct source *source = &dag->sources[where->source];
    int start = where->offset, column = 1;
    while (start > 0 && source->text[start - 1] != '\n')
        start--;
    for (int i = start; i < where->offset; i++)
        column += starts_character(source->text[i]);
    fprintf(out, "%s:%d:%d: %s: %s\n", source->name, dag_line(source, where->offset), column, word,
            diagnostic->message);
    print_line(source, where, start, out);
}

enum { CHAIN_SHOWN = 10 };

static void print_note(const struct dag *dag, struct where where, const char *message, FILE *out)
{
    const struct diagnostic note = {SEVERITY_NOTE, where, message, -1};
    print_one(dag, &note, out);
}

void dag_print_error(const struct dag *dag, struct where where, const char *message,
                     const char *note, FILE *out)
{
    const struct diagnostic error = {SEVERITY_ERROR, where, message, -1};
    print_one(dag, &error, out);
    print_note(dag, dag_nowhere, note, out);
}

/* How one comes to the branch that a message is about. */
static void print_uses(const struct dag *dag, int use, FILE *out)
{
    for (int shown = 0; use >= 0; use = dag->uses[use].outer)
        if (shown++ < CHAIN_SHOWN)
            print_note(dag, dag->uses[use].where, "in the graph that is used here", out);
}

/* How one comes to the file that a message is about. */
static void print_importers(const struct dag *dag, int source, FILE *out)
{
    for (int shown = 0; source >= 0 && dag->sources[source].importer.source >= 0; shown++) {
        struct where importer = dag->sources[source].importer;
        if (shown < CHAIN_SHOWN)
            print_note(dag, importer, "imported here", out);
        source = importer.source;
    }
}

/* An error and where its notes are; sorted by place, then by the order of reporting. */
struct group {
    struct where where;
    int first;
};

static int by_place(const void *a, const void *b)
{
    const struct group *x = a, *y = b;
    int order = (x->where.source > y->where.source) - (x->where.source < y->where.source);
    if (order == 0)
        order = (x->where.offset > y->where.offset) - (x->where.offset < y->where.offset);
    return order != 0 ? order : (x->first > y->first) - (x->first < y->first);
}

/* One message speaks for itself, but an error among warnings would be looked for in vain. */
static void print_count(int count, const char *what, int others, FILE *out)
{
    if (count > ERRORS_SHOWN)
        fprintf(out, "dagc: %d %ss, the first %d found are shown\n", count, what, ERRORS_SHOWN);
    else if (count > 1 || (count == 1 && others > 1))
        fprintf(out, "dagc: %d %s%s\n", count, what, count > 1 ? "s" : "");
}

void dag_print_diagnostics(const struct dag *dag, FILE *out)
{
    struct group groups[ERRORS_SHOWN * 2];
    int count = 0;
    for (int i = 0; i < dag->diagnostic_count && count < ERRORS_SHOWN * 2; i++)
        if (dag->diagnostics[i].severity != SEVERITY_NOTE)
            groups[count++] = (struct group){dag->diagnostics[i].where, i};
    qsort(groups, (size_t)count, sizeof *groups, by_place);
    for (int g = 0; g < count; g++) {
        int i = groups[g].first, use = dag->diagnostics[i].use;
        do
            print_one(dag, &dag->diagnostics[i++], out);
        while (i < dag->diagnostic_count && dag->diagnostics[i].severity == SEVERITY_NOTE);
        print_uses(dag, use, out);
        if (g == 0 || groups[g - 1].where.source != groups[g].where.source)
            print_importers(dag, groups[g].where.source, out);
    }
    print_count(dag->error_count, "error", dag->warning_count, out);
    print_count(dag->warning_count, "warning", 0, out);
}
