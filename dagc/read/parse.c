/* parse.c - the file level of the grammar and the parser's common parts; see parse.h.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "read/parse.h"

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
    return parser->token.kind == TOKEN_NUMBER || dag_at_word(parser, "inf")
           || dag_at_word(parser, "pi") || dag_at_mark(parser, '-');
}

/* number = [ "-" ] ( NUMBER | "inf" | "pi" ) */
int dag_expect_number(struct parser *parser, double *number, struct where *where)
{
    struct where first = parser->token.where;
    int negative = dag_take(parser, '-');
    if (parser->token.kind == TOKEN_NUMBER)
        *number = parser->token.number;
    else if (dag_at_word(parser, "inf"))
        *number = INFINITY;
    else if (dag_at_word(parser, "pi"))
        *number = PI;
    else
        return dag_expected(parser, "a number");
    if (negative)
        *number = -*number;
    dag_advance(parser);
    *where = first;
    where->length = parser->last.offset + parser->last.length - first.offset;
    return 1;
}

int dag_parse_range(struct parser *parser, double *low, double *high, struct where *where)
{
    *where = parser->token.where;
    if (!dag_take_word(parser, "in"))
        return 0;
    struct where part;
    if (!dag_expect(parser, '[', "after 'in'") || !dag_expect_number(parser, low, &part)
        || !dag_expect(parser, ',', "between the ends of a range")
        || !dag_expect_number(parser, high, &part) || !dag_expect(parser, ']', "after a range"))
        return -1;
    where->length = parser->last.offset + parser->last.length - where->offset;
    return 1;
}

int dag_parse_parameter(struct parser *parser)
{
    struct dag *dag = parser->dag;
    struct parameter parameter = {0};
    parameter.type = parameter.role = -1;
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
    if (!dag_expect(parser, ':', "and a type after the parameter's name")
        || !dag_expect_name(parser, "the name of a type", &p->type_name, &p->type_where))
        return 0;
    if (dag_take(parser, '=')) {
        if (!dag_expect_number(parser, &p->value, &p->value_where))
            return 0;
        p->given |= PARAMETER_VALUE;
    }
    struct where range;
    int ranged = dag_parse_range(parser, &p->low, &p->high, &range);
    if (ranged < 0)
        return 0;
    if (ranged) {
        p->range_where = range;
        p->given |= PARAMETER_RANGE;
    }
    if (dag_take_word(parser, "role")
        && !dag_expect_name(parser, "the name of a role", &p->role_name, &p->role_where))
        return 0;
    if (parser->token.kind == TOKEN_STRING) {
        p->doc = parser->token.text;
        dag_advance(parser);
    }
    p->bad = 0;
    return 1;
}

int dag_parse_parameters(struct parser *parser, const char *after, struct span *span)
{
    if (!dag_expect(parser, '(', after))
        return 0;
    while (!dag_at_mark(parser, ')')) {
        int ok = dag_parse_parameter(parser);
        span->count = parser->dag->parameter_count - span->first;
        if (!ok)
            return 0;
        if (!dag_take(parser, ','))
            break;
    }
    return dag_expect(parser, ')', "or ',' after a parameter");
}

static const char *const item_words[] = {"import", "graph",  "oracle", "catalog", "runtime",
                                         "verb",   "unit",   "type",   "term",    "fact",
                                         "role",   "extern", "tool",   "decision"};
enum { ITEM_WORDS = 14, CATALOG_WORD = 4 /* the first of the catalog's */ };

static int at_catalog_word(const struct parser *parser)
{
    for (int i = CATALOG_WORD; i < ITEM_WORDS; i++)
        if (dag_at_word(parser, item_words[i]))
            return 1;
    return 0;
}

/* The start of a declaration, seen while skipping: its word and what must follow it. */
static int at_item(const struct parser *parser)
{
    int string = dag_at_word(parser, "runtime") || dag_at_word(parser, "import")
                 || dag_at_word(parser, "catalog");
    if (!dag_at_word(parser, "oracle") && !dag_at_word(parser, "graph") && !string
        && !at_catalog_word(parser))
        return 0;
    enum token_kind next = dag_peek(parser).kind;
    return next == TOKEN_NAME || (next == TOKEN_STRING && string);
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
    dag_expected(
        parser,
        catalog
            ? "import, runtime, verb, unit, type, term, fact, role, extern, tool, decision or graph"
            : "'oracle', 'graph', 'import', 'catalog' or a declaration");
    if (parser->token.kind == TOKEN_NAME) {
        for (int i = 0; i < ITEM_WORDS; i++)
            dag_suggest(&suggestion, item_words[i]);
        dag_note_suggestion(parser->dag, &suggestion);
    }
    parser->dag->lost = 1;
}

/* import = "import" ( STRING | "standard" ) ";" */
static int parse_import(struct parser *parser)
{
    struct dag *dag = parser->dag;
    struct import import = {NULL, parser->token.where, -1};
    if (!dag_take_word(parser, "standard")
        && !dag_expect_string(parser, "a file's name, a string, or 'standard'", &import.path))
        return 0;
    if (import.path != NULL && import.path[0] == '\0') {
        dag_error(dag, import.where, "an import names a file");
        return 0;
    }
    int index = ADD(dag, imports, import_count);
    dag->imports[index] = import;
    return dag_expect(parser, ';', "after an import");
}

/* catalog = "catalog" ( STRING | "standard" ) ";": what the file is for. Which one was taken is
 * settled; with another, nothing else that the file says could be understood. */
static int parse_catalog_name(struct parser *parser)
{
    struct dag *dag = parser->dag;
    struct where where = parser->token.where;
    const char *path = NULL;
    if (!dag_take_word(parser, "standard")
        && !dag_expect_string(parser, "a catalog's file, a string, or 'standard'", &path))
        return 0;
    const char *wrong = dag_other_catalog(dag, path, where.source);
    if (wrong == NULL)
        return dag_expect(parser, ';', "after a catalog's name");
    if (parser->content == CONTENT_CATALOG)
        dag_error(dag, where, "a catalog is for no other: write import to extend one");
    else
        dag_error(dag, where, "this file is for the catalog %s%s%s, %s", path == NULL ? "" : "\"",
                  path == NULL ? "standard" : path, path == NULL ? "" : "\"", wrong);
    while (parser->token.kind != TOKEN_END)
        dag_advance(parser);
    dag->oracle_count = dag->branch_count = 0; /* nor what it said before */
    return 1;
}

/* An imported file, or a catalog, lends its graphs and declarations; an oracle in it is checked
 * for its syntax and left out. */
static int parse_oracle(struct parser *parser, int wanted)
{
    int count = parser->dag->oracle_count, ok = dag_parse_oracle(parser);
    if (!wanted)
        parser->dag->oracle_count = count;
    return ok;
}

struct parser dag_parser(struct dag *dag, int source, enum content content)
{
    struct parser parser = {0};
    parser.dag = dag;
    parser.lexer = (struct lexer){dag, source, 0, 0};
    parser.last = (struct where){source, 0, 0};
    parser.content = content;
    parser.token = dag_lex(&parser.lexer);
    return parser;
}

/* file = { catalog | import | graph | oracle | catalog_item } */
static void parse_file(struct dag *dag, int source, enum content content)
{
    struct parser parser = dag_parser(dag, source, content);
    int main = content == CONTENT_ORACLES && dag->sources[source].importer.source < 0;
    int oracles = dag->oracle_count, errors = dag->error_count;
    while (parser.token.kind != TOKEN_END) {
        int ok = 0;
        if (dag_at_word(&parser, "oracle"))
            ok = parse_oracle(&parser, main);
        else if (dag_at_word(&parser, "graph"))
            ok = dag_parse_branch(&parser);
        else if (dag_take_word(&parser, "import"))
            ok = parse_import(&parser);
        else if (dag_take_word(&parser, "catalog"))
            ok = parse_catalog_name(&parser);
        else if (at_catalog_word(&parser))
            ok = dag_parse_catalog_item(&parser);
        else {
            unknown_item(&parser);
            dag_advance(&parser);
        }
        if (!ok)
            skip_item(&parser);
    }
    if (main && dag->oracle_count == oracles && dag->error_count == errors) {
        struct where where = {source, 0, 0};
        dag_error(dag, where, "no oracle in this file");
        dag_note(dag, dag_nowhere,
                 "write: oracle NAME \"doc\" "
                 "{ start NODE; node NODE = TOOL() { ANSWER -> TARGET; } }");
    }
}

void dag_parse(struct dag *dag, int source, enum content content)
{
    for (; source >= 0; source = dag_next_import(dag))
        parse_file(dag, source, content);
}
