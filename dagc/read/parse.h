/* parse.h - what the two halves of the parser share: the token at hand and how to go on after
 * a mistake.
 *
 * Recursive descent, one function per grammar rule, each with its rule above it. A function
 * that finds a mistake reports it once and returns 0; the nearest list it stands in skips to the
 * next item. Names are resolved later: a lost declaration marks what it stands in as `bad`, and
 * nothing is said about names that it might have declared.
 * SPDX-License-Identifier: MIT */
#ifndef PARSE_H
#define PARSE_H

#include "base/internal.h"

struct parser {
    struct dag *dag;
    struct lexer lexer;
    struct token token; /* the one at hand */
    struct where last;  /* the one before it */
    int ended;          /* it was said that the file ends too early: once is enough */
    int depth;          /* of parentheses in the expression at hand */
    enum content content;
};

/* At the first token of a source. */
struct parser dag_parser(struct dag *dag, int source, enum content content);
void dag_advance(struct parser *parser);
struct token dag_peek(const struct parser *parser); /* the token after the one at hand */
int dag_at_mark(const struct parser *parser, char mark);
int dag_at_word(const struct parser *parser, const char *word);
int dag_take(struct parser *parser, char mark); /* 1 and past it, if it is at hand */
int dag_take_word(struct parser *parser, const char *word);

/* "expected WHAT, found ..." at the token at hand; always 0. */
int dag_expected(struct parser *parser, const char *what);
/* Takes the mark, or says that it is missing after the last token. `after` ends the message. */
int dag_expect(struct parser *parser, char mark, const char *after);
/* Takes a name or a string, or says that `what` was expected. */
int dag_expect_name(struct parser *parser, const char *what, const char **name,
                    struct where *where);
int dag_expect_string(struct parser *parser, const char *what, const char **string);
int dag_expect_number(struct parser *parser, double *number, struct where *where);
/* number or inf, with its sign, is at hand */
int dag_at_number(const struct parser *parser);

/* range = "in" "[" number "," number "]"; 1: taken, 0: none is there, -1: an error */
int dag_parse_range(struct parser *parser, double *low, double *high, struct where *where);
/* parameter = NAME ":" NAME [ "=" number ] [ range ] [ "role" NAME ] [ STRING ] */
int dag_parse_parameter(struct parser *parser);
/* parameters = "(" [ parameter { "," parameter } ] ")"; span->first is given, and the count is also
 * right where an error ends them */
int dag_parse_parameters(struct parser *parser, const char *after, struct span *span);
/* answers = "(" NAME [ kind ] { "," NAME [ kind ] } ")" */
int dag_parse_answers(struct parser *parser, struct span *span);
/* guards = "guards" "(" allowed { "," allowed } ")" [ "by" "(" NAME { "," NAME } ")" ]
 *          [ "after" NAME "(" NAME { "|" NAME } ")" ]; `guards` has been taken (parse_guards.c) */
int dag_parse_guards(struct parser *parser, struct tool *tool);
int dag_parse_expression(struct parser *parser, int *expression); /* parse_expression.c */
int dag_parse_catalog_item(struct parser *parser);                /* parse_catalog.c */
int dag_parse_oracle(struct parser *parser);                      /* parse_oracle.c */
int dag_parse_branch(struct parser *parser);
/* replacement = NAME "=" NAME [ arguments [ rules ] ], all of a source. node->written.first is -1
 * where there are no arguments: the second name is an answer. 0: an error was reported. */
int dag_parse_replacement(struct dag *dag, int source, struct node *node);

#endif
