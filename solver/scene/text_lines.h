/* text_lines.h - the lines of a text in memory and their words.
 *
 * Lines end in LF, CR LF or CR. Words are parted by blanks; a # ends the line's words (a name that
 * is the rest of a line may hold one: rest_of_line). A backslash at the end of a line joins it with
 * the next, unless it is in a comment: both become blanks in the text. A mark of UTF-8 at the start
 * is no part of the text.
 * SPDX-License-Identifier: MIT */
#ifndef TEXT_LINES_H
#define TEXT_LINES_H

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "util/text_file.h"

struct text_lines {
    char *next, *end;       /* where the next line starts, where the text ends: at a 0 */
    char *line, *line_end;  /* this line without its break */
    char *word, *word_end;  /* the last word taken */
    uint32_t number, after; /* this line's number, from 1, and the next one's */
    int finer;              /* 1: a number so far has said more than a float can */
};

static inline struct text_lines text_lines(char *text, size_t size)
{
    return (struct text_lines){.next = text + text_mark(text), .end = text + size, .after = 1};
}

static inline int is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

/* Where the line that starts here ends; its break is of *size characters, 0 at the text's end. */
static inline char *line_break(char *from, const char *end, size_t *size)
{
    char *lf = memchr(from, '\n', (size_t)(end - from));
    char *cr = memchr(from, '\r', (size_t)((lf ? lf : end) - from));
    *size = cr ? 1 + (size_t)(lf == cr + 1) : lf ? 1 : 0;
    return cr ? cr : lf ? lf : from + (end - from);
}

/* Returns 0 when there is no further line. */
static inline int next_line(struct text_lines *t)
{
    if (t->next >= t->end)
        return 0;
    t->line = t->word_end = t->next;
    t->number = t->after;
    for (;;) {
        const char *part = t->next; /* what was joined before has no comment */
        size_t size;
        char *last = t->line_end = line_break(t->next, t->end, &size);
        t->next = last + size;
        t->after++;
        if (!size || last == part || last[-1] != '\\' || memchr(part, '#', (size_t)(last - part))) {
            if (t->next < t->end)
                *last = '\0'; /* so that no number is looked for beyond it */
            return 1;
        }
        memset(last - 1, ' ', 1 + size);
    }
}

/* Returns 0 when the line has no further word. */
static inline int next_word(struct text_lines *t)
{
    t->word = t->word_end;
    while (t->word < t->line_end && is_blank(*t->word))
        t->word++;
    t->word_end = t->word;
    while (t->word_end < t->line_end && !is_blank(*t->word_end) && *t->word_end != '#')
        t->word_end++;
    return t->word < t->word_end;
}

static inline int word_is(const struct text_lines *t, const char *name)
{
    size_t size = strlen(name);
    return (size_t)(t->word_end - t->word) == size && memcmp(t->word, name, size) == 0;
}

static inline int word_is_any_case(const struct text_lines *t, const char *name)
{
    size_t size = strlen(name);
    return (size_t)(t->word_end - t->word) == size && strncasecmp(t->word, name, size) == 0;
}

/* The rest of the line without the blanks around it, for free(): names may hold blanks. NULL
 * when out of memory. */
static inline char *rest_of_line(const struct text_lines *t)
{
    const char *from = t->word_end, *to = t->line_end;
    while (from < to && is_blank(*from))
        from++;
    while (to > from && is_blank(to[-1]))
        to--;
    return strndup(from, (size_t)(to - from));
}

/* The word as a number; 0 when it is none. */
static inline int word_number(const struct text_lines *t, double *value)
{
    char *stop;
    *value = strtod(t->word, &stop);
    return stop == t->word_end;
}

#endif
