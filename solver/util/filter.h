/* filter.h - conditions over named values, as --where takes them.
 *
 *     condition  = and { "||" and }
 *     and        = not { "&&" not }
 *     not        = "!" not | comparison
 *     comparison = sum [ ( "==" | "!=" | "<" | "<=" | ">" | ">=" ) sum ]
 *     sum        = product { ( "+" | "-" ) product }
 *     product    = sign { ( "*" | "/" ) sign }
 *     sign       = "-" sign | number | "text" | name | "(" condition ")"
 *
 * A name stands for a number, for one of some words, or for a text; words and texts are compared by
 * == and != alone, words with their own bare names, texts with text in quotes. All is checked when
 * it is read, so evaluation cannot fail. NAN is neither equal to anything nor above or below it.
 * SPDX-License-Identifier: MIT */
#ifndef FILTER_H
#define FILTER_H

#include <stddef.h>

enum filter_type { FILTER_NUMBER, FILTER_WORD, FILTER_TEXT };

/* A name, and where its value will be found: values.number, of words their number or -1 for none,
 * or values.text. */
struct filter_name {
    const char *name;
    enum filter_type type;
    const char *const *words; /* of FILTER_WORD; NULL-terminated */
};

struct filter_value {
    double number;
    const char *text;
};

struct filter;

/* `names` [count] are borrowed. Returns NULL, and in `cause` a sentence that begins with the
 * column. */
struct filter *filter_read(const char *text, const struct filter_name *names, size_t count,
                           char *cause, size_t size);

/* values: [count], one for each name. */
int filter_holds(const struct filter *filter, const struct filter_value *values);

void filter_free(struct filter *filter);

#endif
