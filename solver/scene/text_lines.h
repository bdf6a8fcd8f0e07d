/* text_lines.h - the lines of a text in memory and their words.
 *
 * Words are parted by blanks; a word that starts with # ends the line. A backslash at the end of a
 * line joins it with the next, unless it is in such a comment: both become blanks in the text.
 * SPDX-License-Identifier: MIT */
#ifndef TEXT_LINES_H
#define TEXT_LINES_H

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

struct text_lines {
    char *next, *end;       /* where the next line starts, where the text ends: at a 0 */
    char *line, *line_end;  /* this line without its break */
    char *word, *word_end;  /* the last word taken */
    uint32_t number, after; /* this line's number, from 1, and the next one's */
};

static inline struct text_lines text_lines(char *text, size_t size)
{
    return (struct text_lines){.next = text, .end = text + size, .after = 1};
}

static inline int is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

/* Does a word from here on start with #? */
static inline int has_comment(const char *from, const char *end)
{
    for (const char *p = from; (p = memchr(p, '#', (size_t)(end - p))) != NULL; p++)
        if (p == from || is_blank(p[-1]))
            return 1;
    return 0;
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
        char *stop = memchr(t->next, '\n', (size_t)(t->end - t->next));
        t->line_end = stop ? stop : t->end;
        t->next = stop ? stop + 1 : t->end;
        t->after++;
        char *last = t->line_end;
        while (last > part && last[-1] == '\r')
            last--;
        if (!stop || last == part || last[-1] != '\\' || has_comment(part, last))
            return 1;
        for (char *p = last - 1; p <= stop; p++)
            *p = ' ';
    }
}

/* Returns 0 when the line has no further word. */
static inline int next_word(struct text_lines *t)
{
    t->word = t->word_end;
    while (t->word < t->line_end && is_blank(*t->word))
        t->word++;
    t->word_end = t->word;
    while (t->word_end < t->line_end && !is_blank(*t->word_end))
        t->word_end++;
    return t->word < t->word_end && *t->word != '#';
}

static inline int word_is(const struct text_lines *t, const char *name)
{
    size_t size = strlen(name);
    return (size_t)(t->word_end - t->word) == size && memcmp(t->word, name, size) == 0;
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
