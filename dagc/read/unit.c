/* unit.c - units of measurement as exponents of the SI base units.
 *
 * Only coherent units are known, so that equal exponents mean equal numbers: no factor is ever
 * lost in a conversion that nobody sees.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "base/internal.h"

static const struct {
    const char *symbol;
    struct unit unit; /* m kg s A K mol cd */
} symbols[] = {
    {"m", {{1, 0, 0, 0, 0, 0, 0}}},     {"kg", {{0, 1, 0, 0, 0, 0, 0}}},
    {"s", {{0, 0, 1, 0, 0, 0, 0}}},     {"A", {{0, 0, 0, 1, 0, 0, 0}}},
    {"K", {{0, 0, 0, 0, 1, 0, 0}}},     {"mol", {{0, 0, 0, 0, 0, 1, 0}}},
    {"cd", {{0, 0, 0, 0, 0, 0, 1}}},    {"Hz", {{0, 0, -1, 0, 0, 0, 0}}},
    {"N", {{1, 1, -2, 0, 0, 0, 0}}},    {"Pa", {{-1, 1, -2, 0, 0, 0, 0}}},
    {"J", {{2, 1, -2, 0, 0, 0, 0}}},    {"W", {{2, 1, -3, 0, 0, 0, 0}}},
    {"C", {{0, 0, 1, 1, 0, 0, 0}}},     {"V", {{2, 1, -3, -1, 0, 0, 0}}},
    {"ohm", {{2, 1, -3, -2, 0, 0, 0}}}, {"lm", {{0, 0, 0, 0, 0, 0, 1}}},
    {"lx", {{-2, 0, 0, 0, 0, 0, 1}}},   {"rad", {{0, 0, 0, 0, 0, 0, 0}}},
    {"sr", {{0, 0, 0, 0, 0, 0, 0}}},    {"1", {{0, 0, 0, 0, 0, 0, 0}}},
};

enum { EXPONENT_MAX = 99 };

/* The symbol at the start of text: its index and length, or -1. */
static int symbol_at(const char *text, int *length)
{
    int letters = 0;
    while ((text[letters] >= 'a' && text[letters] <= 'z')
           || (text[letters] >= 'A' && text[letters] <= 'Z'))
        letters++;
    *length = letters == 0 && *text == '1' ? 1 : letters;
    for (int i = 0; i < (int)(sizeof symbols / sizeof *symbols); i++)
        if ((int)strlen(symbols[i].symbol) == *length
            && memcmp(symbols[i].symbol, text, (size_t)*length) == 0)
            return i;
    return -1;
}

/* unit = [ [ "/" ] factor { ( " " | "." | "*" | "/" ) factor } ]; "/" divides by one factor only
 * factor = SYMBOL [ [ "^" ] [ "-" ] DIGITS ] */
int dag_parse_unit(const char *text, struct unit *unit)
{
    const char *at = text;
    *unit = (struct unit){{0}};
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
        int symbol = symbol_at(at, &length);
        if (symbol < 0)
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
            int sum = unit->exponent[i] + sign * power * symbols[symbol].unit.exponent[i];
            if (sum < -EXPONENT_MAX || sum > EXPONENT_MAX)
                return (int)(at - text) - 1;
            unit->exponent[i] = (signed char)sum;
        }
        if (*at != '\0' && strchr(" .*/", *at) == NULL)
            return (int)(at - text);
    }
    return -1;
}

const char *dag_unit_name(const struct type *type)
{
    return type->unit_text[0] == '\0' ? "a plain number" : type->unit_text;
}

int dag_same_unit(const struct unit *a, const struct unit *b)
{
    return memcmp(a->exponent, b->exponent, sizeof a->exponent) == 0;
}

int dag_unit_product(struct unit *result, const struct unit *a, const struct unit *b, int sign)
{
    struct unit product = {{0}};
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
    return 1;
}

const char *dag_unit_text(struct dag *dag, const struct unit *unit)
{
    static const char *const bases[] = {"m", "kg", "s", "A", "K", "mol", "cd"};
    const char *text = "";
    for (int i = 0; i < dag->type_count; i++)
        if (dag_same_unit(&dag->types[i].unit, unit))
            return dag_unit_name(&dag->types[i]);
    for (int i = 0; i < UNIT_BASES; i++)
        if (unit->exponent[i] == 1)
            text = dag_format(&dag->arena, "%s%s%s", text, *text != '\0' ? " " : "", bases[i]);
        else if (unit->exponent[i] != 0)
            text = dag_format(&dag->arena, "%s%s%s%d", text, *text != '\0' ? " " : "", bases[i],
                              unit->exponent[i]);
    return *text != '\0' ? text : "a plain number";
}
