/* graph_expression.c - see graph_expression.h. Parentheses stand where an operator inside binds
 * less than the one around it.
 * SPDX-License-Identifier: MIT */
#include "output/graph_expression.h"

#include <stdio.h>
#include <string.h>

struct writer {
    char *text;
    size_t size, length;
};

static void put(struct writer *w, const char *word)
{
    size_t length = strlen(word), room = w->size - w->length - 1;
    length = length < room ? length : room;
    memcpy(w->text + w->length, word, length);
    w->length += length;
    w->text[w->length] = 0;
}

static const char *word_of(const json_t *e, const char *key)
{
    return json_string_value(json_object_get(e, key));
}

static const struct operator_row {
    const char *name, *sign;
    int binds;
} infix[] = {
    {"add", " + ", 1}, {"subtract", " - ", 1}, {"multiply", " * ", 2}, {"divide", " / ", 2}};

static void write_expression(struct writer *w, const json_t *e, int around);

/* min, max, sqrt, abs: NAME(A, B); a negated one has its sign. */
static void write_call(struct writer *w, const char *name, const json_t *operands)
{
    int negated = strcmp(name, "negate") == 0;
    put(w, negated ? "-" : name);
    put(w, negated ? "" : "(");
    for (size_t i = 0; i < json_array_size(operands); i++) {
        put(w, i ? ", " : "");
        write_expression(w, json_array_get(operands, i), negated ? 3 : 0);
    }
    put(w, negated ? "" : ")");
}

static void write_operator(struct writer *w, const json_t *e, int around)
{
    const char *name = word_of(e, "operator");
    const json_t *operands = json_object_get(e, "operands");
    for (size_t i = 0; i < sizeof infix / sizeof *infix; i++)
        if (strcmp(infix[i].name, name) == 0) {
            put(w, infix[i].binds < around ? "(" : "");
            write_expression(w, json_array_get(operands, 0), infix[i].binds);
            put(w, infix[i].sign);
            write_expression(w, json_array_get(operands, 1), infix[i].binds + 1);
            put(w, infix[i].binds < around ? ")" : "");
            return;
        }
    write_call(w, name, operands);
}

/* around: how strongly what it stands in binds. */
static void write_expression(struct writer *w, const json_t *e, int around)
{
    static const char *const names[] = {"parameter", "fact", "extern", "term"};
    const json_t *number = json_object_get(e, "number");
    if (word_of(e, "operator")) {
        write_operator(w, e, around);
        return;
    }
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (word_of(e, names[i]))
            put(w, word_of(e, names[i]));
    if (word_of(e, "level")) {
        put(w, ".");
        put(w, word_of(e, "level"));
    }
    if (json_is_string(number))
        put(w, json_string_value(number));
    else if (number) {
        char digits[32];
        snprintf(digits, sizeof digits, "%.6g", json_number_value(number));
        put(w, digits);
    }
}

void graph_expression_text(const json_t *expression, char *text, size_t size)
{
    struct writer w = {text, size, 0};
    *text = 0;
    write_expression(&w, expression, 0);
}
