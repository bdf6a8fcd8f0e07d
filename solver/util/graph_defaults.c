/* graph_defaults.c - see graph_defaults.h.
 *
 * The text is read by its words alone, as dagc/read/lex.c does: comments and strings are passed
 * over, line ends and blanks may stand between any two words. `param` begins parameters of oracles
 * only; those of branches stand in parentheses. The text has been compiled before, so what it means
 * is not checked again.
 * SPDX-License-Identifier: MIT */
#include "util/graph_defaults.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct word {
    const char *text;
    size_t length; /* 0: the end */
};

static int in_name(char c)
{
    return isalnum((unsigned char)c) || c == '_';
}

/* Digits, '.', and an exponent with its sign; a name; a string; or one character. */
static size_t word_length(const char *at)
{
    size_t n = 1;
    if (*at == '"') {
        while (at[n] && at[n] != '"' && at[n] != '\n')
            n += at[n] == '\\' && at[n + 1] && at[n + 1] != '\n' ? 2 : 1;
        return n + (at[n] == '"');
    }
    if (isdigit((unsigned char)*at)) {
        while (in_name(at[n]) || at[n] == '.'
               || ((at[n] == '-' || at[n] == '+') && tolower((unsigned char)at[n - 1]) == 'e'))
            n++;
        return n;
    }
    while (in_name(*at) && in_name(at[n]))
        n++;
    return n;
}

/* The first word at or behind `at`. */
static struct word word_at(const char *at)
{
    for (;;) {
        at += strspn(at, " \t\n\r\f\v");
        if (*at != '#')
            break;
        at += strcspn(at, "\n");
    }
    return (struct word){at, *at ? word_length(at) : 0};
}

static struct word next(struct word w)
{
    return word_at(w.text + w.length);
}

static int is(struct word w, const char *text)
{
    return w.length == strlen(text) && memcmp(w.text, text, w.length) == 0;
}

/* The number behind `param NAME : TYPE =`, length 0 where there is none. */
static struct word default_of(const char *text, const char *name)
{
    for (struct word w = word_at(text); w.length; w = next(w)) {
        if (!is(w, "param") || !is(next(w), name))
            continue;
        struct word colon = next(next(w)), type = next(colon), equals = next(type);
        if (is(colon, ":") && is(equals, "="))
            return next(equals);
    }
    return (struct word){text, 0};
}

void graph_number(double value, char text[GRAPH_NUMBER])
{
    snprintf(text, GRAPH_NUMBER, "%g", value);
}

char *graph_with_defaults(const char *text, const struct graph_default *defaults, int count,
                          const char **missing)
{
    char *now = malloc(strlen(text) + 1);
    *missing = NULL;
    if (now)
        strcpy(now, text);
    for (int i = 0; now && i < count; i++) {
        char number[GRAPH_NUMBER];
        graph_number(defaults[i].value, number);
        struct word old = default_of(now, defaults[i].name);
        char *changed = old.length ? malloc(strlen(now) + GRAPH_NUMBER) : NULL;
        if (changed)
            sprintf(changed, "%.*s%s%s", (int)(old.text - now), now, number, old.text + old.length);
        else if (!old.length)
            *missing = defaults[i].name;
        free(now);
        now = changed;
    }
    return now;
}
