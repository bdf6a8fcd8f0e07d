/* unit.c - units of measurement as exponents of the SI base units, and a size.
 *
 * Those known from the start are coherent, of size 1. A catalog may declare others (ms, of size
 * 0.001): then units are the same when their sizes are, too, to rounding. Nothing is converted, so
 * no factor is lost where nobody sees it.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "base/internal.h"

static const struct {
    const char *symbol;
    struct unit unit; /* m kg s A K mol cd */
} symbols[] = {
    {"m", {{1, 0, 0, 0, 0, 0, 0}, 1}},     {"kg", {{0, 1, 0, 0, 0, 0, 0}, 1}},
    {"s", {{0, 0, 1, 0, 0, 0, 0}, 1}},     {"A", {{0, 0, 0, 1, 0, 0, 0}, 1}},
    {"K", {{0, 0, 0, 0, 1, 0, 0}, 1}},     {"mol", {{0, 0, 0, 0, 0, 1, 0}, 1}},
    {"cd", {{0, 0, 0, 0, 0, 0, 1}, 1}},    {"Hz", {{0, 0, -1, 0, 0, 0, 0}, 1}},
    {"N", {{1, 1, -2, 0, 0, 0, 0}, 1}},    {"Pa", {{-1, 1, -2, 0, 0, 0, 0}, 1}},
    {"J", {{2, 1, -2, 0, 0, 0, 0}, 1}},    {"W", {{2, 1, -3, 0, 0, 0, 0}, 1}},
    {"C", {{0, 0, 1, 1, 0, 0, 0}, 1}},     {"V", {{2, 1, -3, -1, 0, 0, 0}, 1}},
    {"ohm", {{2, 1, -3, -2, 0, 0, 0}, 1}}, {"lm", {{0, 0, 0, 0, 0, 0, 1}, 1}},
    {"lx", {{-2, 0, 0, 0, 0, 0, 1}, 1}},   {"rad", {{0, 0, 0, 0, 0, 0, 0}, 1}},
    {"sr", {{0, 0, 0, 0, 0, 0, 0}, 1}},    {"1", {{0, 0, 0, 0, 0, 0, 0}, 1}},
};

enum { EXPONENT_MAX = 99, SYMBOLS = (int)(sizeof symbols / sizeof *symbols) };

/* The symbol at the start of text: its unit and length; NULL: there is none, or it is not known
 * yet. */
static const struct unit *symbol_at(const struct dag *dag, const char *text, int *length)
{
    int letters = 0;
    while ((text[letters] >= 'a' && text[letters] <= 'z')
           || (text[letters] >= 'A' && text[letters] <= 'Z'))
        letters++;
    *length = letters == 0 && *text == '1' ? 1 : letters;
    for (int i = 0; i < dag->unit_count; i++)
        if ((int)strlen(dag->units[i].name) == letters && letters > 0
            && memcmp(dag->units[i].name, text, (size_t)letters) == 0)
            return dag->units[i].known ? &dag->units[i].unit : NULL;
    for (int i = 0; i < SYMBOLS; i++)
        if ((int)strlen(symbols[i].symbol) == *length
            && memcmp(symbols[i].symbol, text, (size_t)*length) == 0)
            return &symbols[i].unit;
    return NULL;
}

const char *dag_known_units(struct dag *dag)
{
    const char *text = "";
    for (int i = 0; i < SYMBOLS; i++)
        text = dag_format(&dag->arena, "%s%s%s", text, i > 0 ? " " : "", symbols[i].symbol);
    for (int i = 0; i < dag->unit_count; i++)
        text = dag_format(&dag->arena, "%s %s", text, dag->units[i].name);
    return text;
}

int dag_is_si_unit(const char *name)
{
    for (int i = 0; i < SYMBOLS; i++)
        if (strcmp(symbols[i].symbol, name) == 0)
            return 1;
    return 0;
}

static double size_of(const struct unit *unit)
{
    return unit->size != 0 ? unit->size : 1;
}

/* unit = [ [ "/" ] factor { ( " " | "." | "*" | "/" ) factor } ]; "/" divides by one factor only
 * factor = SYMBOL [ [ "^" ] [ "-" ] DIGITS ] */
int dag_parse_unit(const struct dag *dag, const char *text, struct unit *unit)
{
    const char *at = text;
    *unit = (struct unit){{0}, 1};
    while (*at != '\0') {
        int sign = 1, power = 1;
        while (*at == ' ' || (at != text && (*at == '.' || *at == '*')))
            at++;
        if (*at == '/') {
            sign = -1;
            at++;
        }
        if (*at == '\0')
            return sign < 0 ? (int)(at - text) : -1;
        int length;
        const struct unit *symbol = symbol_at(dag, at, &length);
        if (symbol == NULL)
            return (int)(at - text);
        at += length;
        if (*at == '^')
            at++;
        if (*at == '-') {
            sign = -sign;
            at++;
            if (*at < '0' || *at > '9')
                return (int)(at - text);
        }
        if (*at >= '0' && *at <= '9')
            power = *at++ - '0';
        for (int i = 0; i < UNIT_BASES; i++) {
            int sum = unit->exponent[i] + sign * power * symbol->exponent[i];
            if (sum < -EXPONENT_MAX || sum > EXPONENT_MAX)
                return (int)(at - text) - 1;
            unit->exponent[i] = (signed char)sum;
        }
        for (int i = 0; i < power; i++)
            unit->size = sign > 0 ? unit->size * size_of(symbol) : unit->size / size_of(symbol);
        if (*at != '\0' && strchr(" .*/", *at) == NULL)
            return (int)(at - text);
    }
    return -1;
}

const char *dag_unit_name(const struct type *type)
{
    return type->unit_text[0] == '\0' ? "a plain number" : type->unit_text;
}

/* Sizes are products and quotients of a few numbers as written. */
#define UNIT_ROUNDING 1e-12

int dag_same_unit(const struct unit *a, const struct unit *b)
{
    return memcmp(a->exponent, b->exponent, sizeof a->exponent) == 0
           && fabs(size_of(a) / size_of(b) - 1) <= UNIT_ROUNDING;
}

int dag_unit_product(struct unit *result, const struct unit *a, const struct unit *b, int sign)
{
    struct unit product = {{0}, sign > 0 ? size_of(a) * size_of(b) : size_of(a) / size_of(b)};
    for (int i = 0; i < UNIT_BASES; i++) {
        int sum = a->exponent[i] + sign * b->exponent[i];
        if (sum < -EXPONENT_MAX || sum > EXPONENT_MAX)
            return 0;
        product.exponent[i] = (signed char)sum;
    }
    *result = product;
    return 1;
}

int dag_unit_root(struct unit *unit)
{
    for (int i = 0; i < UNIT_BASES; i++)
        if (unit->exponent[i] % 2 != 0)
            return 0;
    for (int i = 0; i < UNIT_BASES; i++)
        unit->exponent[i] = (signed char)(unit->exponent[i] / 2);
    unit->size = sqrt(size_of(unit));
    return 1;
}

const char *dag_unit_text(struct dag *dag, const struct unit *unit)
{
    static const char *const bases[] = {"m", "kg", "s", "A", "K", "mol", "cd"};
    const char *text = "";
    for (int i = 0; i < dag->type_count; i++)
        if (!dag->types[i].any_unit && dag_same_unit(&dag->types[i].unit, unit))
            return dag_unit_name(&dag->types[i]);
    for (int i = 0; i < UNIT_BASES; i++)
        if (unit->exponent[i] == 1)
            text = dag_format(&dag->arena, "%s%s%s", text, *text != '\0' ? " " : "", bases[i]);
        else if (unit->exponent[i] != 0)
            text = dag_format(&dag->arena, "%s%s%s%d", text, *text != '\0' ? " " : "", bases[i],
                              unit->exponent[i]);
    if (fabs(size_of(unit) - 1) > UNIT_ROUNDING) {
        char number[32];
        return dag_format(&dag->arena, "%s %s", dag_number(size_of(unit), number),
                          *text != '\0' ? text : "as a plain number");
    }
    return *text != '\0' ? text : "a plain number";
}
