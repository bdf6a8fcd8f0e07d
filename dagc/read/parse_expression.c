/* parse_expression.c - the values of arguments; see parse.h.
 *
 * Recursion is bounded: by EXPRESSION_DEPTH in parentheses and signs, while a chain of operators
 * is a loop; and a tree has at most EXPRESSION_SIZE parts, so that whoever walks it may recurse.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "read/parse.h"

static int too_deep(struct parser *parser)
{
    if (parser->depth < EXPRESSION_DEPTH)
        return 0;
    dag_error(parser->dag, parser->token.where, "this expression is nested more than %d deep",
              EXPRESSION_DEPTH);
    return 1;
}

/* A new part from `first` to the last token. */
static int add(struct parser *parser, struct expression *e, struct where first, int *expression)
{
    struct dag *dag = parser->dag;
    e->where = first;
    e->where.length = parser->last.offset + parser->last.length - first.offset;
    *expression = dag_add_expression(dag, e);
    const struct expression *added = &dag->expressions[*expression];
    if (added->size <= EXPRESSION_SIZE && added->depth <= EXPRESSION_DEPTH)
        return 1;
    dag_error(dag, parser->last,
              "this expression is too long: more than %d parts, or more than %d "
              "in each other",
              EXPRESSION_SIZE, EXPRESSION_DEPTH);
    return 0;
}

static struct expression new_expression(enum expression_kind kind)
{
    struct expression e = {0};
    e.kind = kind;
    e.parameter = e.index = e.left = e.right = -1;
    return e;
}

static const struct {
    const char *name;
    enum expression_kind kind;
    int operands;
} functions[] = {
    {"min", EXPRESSION_MIN, 2},
    {"max", EXPRESSION_MAX, 2},
    {"sqrt", EXPRESSION_SQRT, 1},
    {"abs", EXPRESSION_ABS, 1},
};
enum { FUNCTIONS = 4 };

/* call = ( "min" | "max" ) "(" expression "," expression ")"
 *      | ( "sqrt" | "abs" ) "(" expression ")" */
static int parse_call(struct parser *parser, int *expression)
{
    struct where first = parser->token.where;
    struct suggestion suggestion = {parser->token.text, NULL, 0};
    int f = 0;
    while (f < FUNCTIONS && !dag_at_word(parser, functions[f].name))
        dag_suggest(&suggestion, functions[f++].name);
    if (f == FUNCTIONS) {
        dag_error(parser->dag, first, "unknown function '%s'", parser->token.text);
        dag_note_suggestion(parser->dag, &suggestion);
        for (int i = 0; i < parser->dag->callback_count; i++)
            if (strcmp(parser->dag->callbacks[i].name, parser->token.text) == 0)
                dag_note(parser->dag, dag_nowhere, "an extern is read without parentheses: %s",
                         parser->token.text);
        if (suggestion.best == NULL)
            dag_note(parser->dag, dag_nowhere,
                     "the functions are min(a, b), max(a, b), sqrt(x) and abs(x)");
        return 0;
    }
    struct expression e = new_expression(functions[f].kind);
    dag_advance(parser);
    dag_advance(parser);
    if (!dag_parse_expression(parser, &e.left))
        return 0;
    if (functions[f].operands == 2
        && (!dag_expect(parser, ',', "and a second operand here")
            || !dag_parse_expression(parser, &e.right)))
        return 0;
    return dag_expect(parser, ')', "after the operands of a function")
           && add(parser, &e, first, expression);
}

/* name = NAME [ "." NAME ] */
static int parse_name(struct parser *parser, int *expression)
{
    struct expression e = new_expression(EXPRESSION_NAME);
    struct where first;
    if (!dag_expect_name(parser, "a number or the name of a parameter", &e.name, &first))
        return 0;
    if (dag_take(parser, '.')) {
        e.dot = (int)strlen(e.name);
        const char *part;
        struct where where;
        if (!dag_expect_name(parser, "a name after the '.'", &part, &where))
            return 0;
        e.name = dag_format(&parser->dag->arena, "%s.%s", e.name, part);
    }
    return add(parser, &e, first, expression);
}

/* primary = NUMBER | "inf" | call | name | "(" expression ")" */
static int parse_primary(struct parser *parser, int *expression)
{
    struct where first = parser->token.where;
    if (parser->token.kind == TOKEN_NUMBER || dag_at_word(parser, "inf")) {
        struct expression e = new_expression(EXPRESSION_NUMBER);
        e.number = parser->token.kind == TOKEN_NUMBER ? parser->token.number : INFINITY;
        dag_advance(parser);
        return add(parser, &e, first, expression);
    }
    if (dag_take(parser, '('))
        return dag_parse_expression(parser, expression)
               && dag_expect(parser, ')', "to close this part of the expression");
    if (parser->token.kind == TOKEN_NAME && dag_peek(parser).mark == '(')
        return parse_call(parser, expression);
    return parse_name(parser, expression);
}

/* unary = "-" unary | primary */
static int parse_unary(struct parser *parser, int *expression)
{
    struct where first = parser->token.where;
    if (!dag_take(parser, '-'))
        return parse_primary(parser, expression);
    if (too_deep(parser))
        return 0;
    parser->depth++;
    struct expression e = new_expression(EXPRESSION_NEGATE);
    int ok = parse_unary(parser, &e.left);
    parser->depth--;
    return ok && add(parser, &e, first, expression);
}

/* product = unary { ( "*" | "/" ) unary } */
static int parse_product(struct parser *parser, int *expression)
{
    struct where first = parser->token.where;
    if (!parse_unary(parser, expression))
        return 0;
    while (dag_at_mark(parser, '*') || dag_at_mark(parser, '/')) {
        struct expression e =
            new_expression(dag_at_mark(parser, '*') ? EXPRESSION_MULTIPLY : EXPRESSION_DIVIDE);
        dag_advance(parser);
        e.left = *expression;
        if (!parse_unary(parser, &e.right) || !add(parser, &e, first, expression))
            return 0;
    }
    return 1;
}

/* expression = product { ( "+" | "-" ) product } */
int dag_parse_expression(struct parser *parser, int *expression)
{
    struct where first = parser->token.where;
    if (too_deep(parser))
        return 0;
    parser->depth++;
    int ok = parse_product(parser, expression);
    while (ok && (dag_at_mark(parser, '+') || dag_at_mark(parser, '-'))) {
        struct expression e =
            new_expression(dag_at_mark(parser, '+') ? EXPRESSION_ADD : EXPRESSION_SUBTRACT);
        dag_advance(parser);
        e.left = *expression;
        ok = parse_product(parser, &e.right) && add(parser, &e, first, expression);
    }
    parser->depth--;
    return ok;
}
