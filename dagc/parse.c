/* parse.c - the file level of the grammar and the parser's common parts; see parse.h.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "parse.h"

void dag_advance(struct parser *parser)
{
    parser->last = parser->token.where;
    parser->token = dag_lex(&parser->lexer);
}

struct token dag_peek(const struct parser *parser)
{
    struct lexer ahead = parser->lexer;
    ahead.quiet = 1;
    return dag_lex(&ahead);
}

int dag_at_mark(const struct parser *parser, char mark)
{
    return parser->token.kind == TOKEN_PUNCTUATION && parser->token.mark == mark;
}

int dag_at_word(const struct parser *parser, const char *word)
{
    return parser->token.kind == TOKEN_NAME && strcmp(parser->token.text, word) == 0;
}

int dag_take(struct parser *parser, char mark)
{
    int here = dag_at_mark(parser, mark);
    if (here)
        dag_advance(parser);
    return here;
}

int dag_take_word(struct parser *parser, const char *word)
{
    int here = dag_at_word(parser, word);
    if (here)
        dag_advance(parser);
    return here;
}

/* Just behind the last token: where something is missing. */
static struct where behind(const struct parser *parser)
{
    struct where where = parser->last;
    if (where.length == 0)
        return parser->token.where;
    where.offset += where.length;
    where.length = 1;
    return where;
}

/* Is this the first complaint at the file's end, or not at its end? */
static int may_complain(struct parser *parser)
{
    int quiet = parser->ended;
    parser->ended = parser->token.kind == TOKEN_END;
    return !quiet;
}

int dag_expected(struct parser *parser, const char *what)
{
    const struct token *token = &parser->token;
    if (!may_complain(parser))
        return 0;
    if (token->kind == TOKEN_END)
        dag_error(parser->dag, behind(parser), "expected %s, found the end of the file", what);
    else if (token->kind == TOKEN_STRING)
        dag_error(parser->dag, token->where, "expected %s, found a string", what);
    else {
        const char *text = parser->dag->sources[token->where.source].text + token->where.offset;
        int length = token->where.length;
        dag_error(parser->dag, token->where, "expected %s, found '%.*s'%s", what,
                  length > NAME_MAX_LENGTH ? NAME_MAX_LENGTH : length, text,
                  length > NAME_MAX_LENGTH ? "..." : "");
    }
    return 0;
}

int dag_expect(struct parser *parser, char mark, const char *after)
{
    if (dag_take(parser, mark))
        return 1;
    if (may_complain(parser))
        dag_error(parser->dag, behind(parser), "expected '%c' %s", mark, after);
    return 0;
}

int dag_expect_name(struct parser *parser, const char *what, const char **name, struct where *where)
{
    if (parser->token.kind != TOKEN_NAME)
        return dag_expected(parser, what);
    *name = parser->token.text;
    *where = parser->token.where;
    dag_advance(parser);
    return 1;
}

int dag_expect_string(struct parser *parser, const char *what, const char **string)
{
    if (parser->token.kind != TOKEN_STRING)
        return dag_expected(parser, what);
    *string = parser->token.text;
    dag_advance(parser);
    return 1;
}

int dag_at_number(const struct parser *parser)
{
    return parser->token.kind == TOKEN_NUMBER || dag_at_word(parser, "inf") ||
           dag_at_mark(parser, '-');
}

/* number = [ "-" ] ( NUMBER | "inf" ) */
int dag_expect_number(struct parser *parser, double *number, struct where *where)
{
    struct where first = parser->token.where;
    int negative = dag_take(parser, '-');
    if (parser->token.kind == TOKEN_NUMBER)
        *number = parser->token.number;
    else if (dag_at_word(parser, "inf"))
        *number = INFINITY;
    else
        return dag_expected(parser, "a number");
    if (negative)
        *number = -*number;
    dag_advance(parser);
    *where = first;
    where->length = parser->last.offset + parser->last.length - first.offset;
    return 1;
}

int dag_parse_parameter(struct parser *parser)
{
    struct dag *dag = parser->dag;
    struct parameter parameter = {0};
    parameter.type = -1;
    parameter.value = NAN;
    parameter.low = -INFINITY;
    parameter.high = INFINITY;
    parameter.doc = "";
    if (!dag_expect_name(parser, "the name of a parameter", &parameter.name, &parameter.where))
        return 0;
    int index = ADD(dag, parameters, parameter_count);
    struct parameter *p = &dag->parameters[index];
    *p = parameter;
    p->bad = 1; /* until all of it is read */
    if (!dag_expect(parser, ':', "and a type after the parameter's name") ||
        !dag_expect_name(parser, "the name of a type", &p->type_name, &p->type_where))
        return 0;
    if (dag_take(parser, '=')) {
        if (!dag_expect_number(parser, &p->value, &p->value_where))
            return 0;
        p->given |= PARAMETER_VALUE;
    }
    if (dag_at_word(parser, "in")) {
        struct where where = parser->token.where, part;
        dag_advance(parser);
        if (!dag_expect(parser, '[', "after 'in'") || !dag_expect_number(parser, &p->low, &part) ||
            !dag_expect(parser, ',', "between the ends of a range") ||
            !dag_expect_number(parser, &p->high, &part) ||
            !dag_expect(parser, ']', "after a range"))
            return 0;
        where.length = parser->last.offset + parser->last.length - where.offset;
        p->range_where = where;
        p->given |= PARAMETER_RANGE;
    }
    if (parser->token.kind == TOKEN_STRING) {
        p->doc = parser->token.text;
        dag_advance(parser);
    }
    p->bad = 0;
    return 1;
}

static const char *const catalog_words[] = {"runtime", "type", "term", "tool", "decision"};
enum { CATALOG_WORDS = 5 };

static int at_catalog_word(const struct parser *parser)
{
    for (int i = 0; i < CATALOG_WORDS; i++)
        if (dag_at_word(parser, catalog_words[i]))
            return 1;
    return 0;
}

/* The start of a declaration, seen while skipping: its word and what must follow it. */
static int at_item(const struct parser *parser)
{
    if (!dag_at_word(parser, "oracle") && !at_catalog_word(parser))
        return 0;
    enum token_kind next = dag_peek(parser).kind;
    return next == TOKEN_NAME || (next == TOKEN_STRING && dag_at_word(parser, "runtime"));
}

/* To the end of a broken declaration: past its ';', or past the '}' of its body. */
static void skip_item(struct parser *parser)
{
    int depth = 0;
    while (parser->token.kind != TOKEN_END) {
        if (depth == 0 && at_item(parser))
            return;
        if (dag_at_mark(parser, '{'))
            depth++;
        int closes = dag_at_mark(parser, '}') && (depth == 0 || --depth == 0);
        int ends = closes || (depth == 0 && dag_at_mark(parser, ';'));
        dag_advance(parser);
        if (ends)
            return;
    }
}

static void unknown_item(struct parser *parser)
{
    int catalog = parser->content == CONTENT_CATALOG;
    struct suggestion suggestion = {parser->token.text, NULL, 0};
    if (!catalog && at_catalog_word(parser)) {
        dag_error(parser->dag, parser->token.where,
                  "a '%s' is declared in a catalog, not beside oracles", parser->token.text);
        dag_note(parser->dag, dag_nowhere, "put it into a copy of the catalog, given with --catalog");
        return;
    }
    if (catalog && dag_at_word(parser, "oracle")) {
        dag_error(parser->dag, parser->token.where, "a catalog holds no oracles");
        return;
    }
    dag_expected(parser, catalog ? "runtime, type, term, tool or decision" : "'oracle'");
    if (parser->token.kind == TOKEN_NAME) {
        for (int i = 0; catalog && i < CATALOG_WORDS; i++)
            dag_suggest(&suggestion, catalog_words[i]);
        if (!catalog)
            dag_suggest(&suggestion, "oracle");
        dag_note_suggestion(parser->dag, &suggestion);
    }
    parser->dag->lost = 1;
}

/* file = { catalog_item } | oracle { oracle } */
void dag_parse(struct dag *dag, int source, enum content content)
{
    struct parser parser = {0};
    parser.dag = dag;
    parser.lexer = (struct lexer){dag, source, 0, 0};
    parser.last = (struct where){source, 0, 0};
    parser.content = content;
    parser.token = dag_lex(&parser.lexer);
    int oracles = dag->oracle_count, errors = dag->error_count;
    while (parser.token.kind != TOKEN_END) {
        int ok = 0;
        if (content == CONTENT_ORACLES && dag_at_word(&parser, "oracle"))
            ok = dag_parse_oracle(&parser);
        else if (content == CONTENT_CATALOG && at_catalog_word(&parser))
            ok = dag_parse_catalog_item(&parser);
        else {
            unknown_item(&parser);
            dag_advance(&parser);
        }
        if (!ok)
            skip_item(&parser);
    }
    if (content == CONTENT_ORACLES && dag->oracle_count == oracles && dag->error_count == errors) {
        struct where where = {source, 0, 0};
        dag_error(dag, where, "no oracle in this file");
        dag_note(dag, dag_nowhere, "write: oracle NAME \"doc\" "
                                   "{ start NODE; node NODE = TOOL() { ANSWER -> TARGET; } }");
    }
}
