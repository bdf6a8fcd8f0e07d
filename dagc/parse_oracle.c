/* parse_oracle.c - decision graphs; see parse.h.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "parse.h"

static int at_oracle_word(const struct parser *parser)
{
    return dag_at_word(parser, "param") || dag_at_word(parser, "start") ||
           dag_at_word(parser, "node");
}

/* `node NAME`, `param NAME`, `start NAME` or the next oracle: never the inside of a node, where
 * a name is followed by '|', '->', '=' or ';'. */
static int at_item(const struct parser *parser)
{
    return (at_oracle_word(parser) || dag_at_word(parser, "oracle")) &&
           dag_peek(parser).kind == TOKEN_NAME;
}

static int at_oracle(const struct parser *parser)
{
    return dag_at_word(parser, "oracle") && dag_peek(parser).kind == TOKEN_NAME;
}

static int at_end(const struct parser *parser)
{
    return parser->token.kind == TOKEN_END || at_item(parser);
}

/* rule = ( "otherwise" | NAME { "|" NAME } ) "->" NAME ";" */
static int parse_rule(struct parser *parser)
{
    struct dag *dag = parser->dag;
    struct rule rule = {0};
    rule.where = parser->token.where;
    rule.labels.first = dag->label_count;
    rule.target.index = -1;
    if (parser->token.kind != TOKEN_NAME)
        return dag_expected(parser, "an answer, 'otherwise' or '}'");
    if (!dag_take_word(parser, "otherwise")) {
        do {
            struct label label;
            if (!dag_expect_name(parser, "an answer", &label.name, &label.where))
                return 0;
            int at = ADD(dag, labels, label_count);
            dag->labels[at] = label;
            rule.labels.count++;
        } while (dag_take(parser, '|'));
    }
    if (parser->token.kind != TOKEN_ARROW)
        return dag_expected(parser, "'->' and a target after an answer");
    dag_advance(parser);
    if (!dag_expect_name(parser, "the name of a node or of a decision", &rule.target.name,
                         &rule.target.where))
        return 0;
    int index = ADD(dag, rules, rule_count);
    dag->rules[index] = rule;
    /* A missing ';' loses nothing: say so and read on. */
    dag_expect(parser, ';', "after a target");
    return 1;
}

/* value = number | NAME */
static int parse_value(struct parser *parser, int *expression)
{
    struct dag *dag = parser->dag;
    struct expression e = {0};
    e.parameter = e.left = e.right = -1;
    if (dag_at_number(parser)) {
        e.kind = EXPRESSION_NUMBER;
        if (!dag_expect_number(parser, &e.number, &e.where))
            return 0;
    } else {
        e.kind = EXPRESSION_PARAMETER;
        if (!dag_expect_name(parser, "a number or the name of a parameter", &e.name, &e.where))
            return 0;
    }
    *expression = ADD(dag, expressions, expression_count);
    dag->expressions[*expression] = e;
    return 1;
}

/* arguments = "(" [ NAME "=" value { "," NAME "=" value } ] ")" */
static int parse_arguments(struct parser *parser, struct span *span)
{
    struct dag *dag = parser->dag;
    span->first = dag->argument_count;
    if (!dag_expect(parser, '(', "after the tool's name"))
        return 0;
    while (!dag_at_mark(parser, ')')) {
        struct argument argument = {0};
        argument.parameter = -1;
        if (parser->token.kind == TOKEN_NUMBER) {
            dag_expected(parser, "the name of an argument");
            dag_note(dag, dag_nowhere, "arguments are named: write NAME = value");
            return 0;
        }
        if (!dag_expect_name(parser, "the name of an argument", &argument.name, &argument.where) ||
            !dag_expect(parser, '=', "after the argument's name: write NAME = value") ||
            !parse_value(parser, &argument.expression))
            return 0;
        int index = ADD(dag, arguments, argument_count);
        dag->arguments[index] = argument;
        span->count++;
        if (!dag_take(parser, ','))
            break;
    }
    return dag_expect(parser, ')', "or ',' after an argument");
}

/* rules = "{" { rule } "}" ; 0: some rule is lost */
static int parse_rules(struct parser *parser, struct span *span)
{
    int ok = 1;
    span->first = parser->dag->rule_count;
    if (!dag_expect(parser, '{', "and the answers of the node")) {
        struct token next = dag_peek(parser);
        int rule = parser->token.kind == TOKEN_NAME &&
                   (next.kind == TOKEN_ARROW || next.mark == '|');
        if (!rule) /* else only the '{' is missing */
            return 0;
    }
    while (!dag_at_mark(parser, '}') && !at_end(parser)) {
        if (parse_rule(parser))
            continue;
        ok = 0;
        int depth = 0;
        while (!at_end(parser) && !(depth == 0 && dag_at_mark(parser, '}'))) {
            if (dag_at_mark(parser, '{'))
                depth++;
            if (dag_at_mark(parser, '}'))
                depth--;
            int end = depth == 0 && dag_at_mark(parser, ';');
            dag_advance(parser);
            if (end)
                break;
        }
    }
    span->count = parser->dag->rule_count - span->first;
    /* A missing '}' before the next item loses nothing. */
    if (!dag_expect(parser, '}', "after the answers of the node"))
        ok = ok && parser->token.kind != TOKEN_END;
    return ok;
}

/* node = "node" NAME "=" NAME arguments rules */
static int parse_node(struct parser *parser, int oracle)
{
    struct dag *dag = parser->dag;
    struct node node = {0};
    node.tool = node.order = -1;
    node.bad = 1;
    if (!dag_expect_name(parser, "the name of a node", &node.name, &node.where)) {
        dag->oracles[oracle].bad = 1;
        return 0;
    }
    int index = ADD(dag, nodes, node_count);
    struct node *n = &dag->nodes[index];
    *n = node;
    if (!dag_expect(parser, '=', "and a tool after the node's name") ||
        !dag_expect_name(parser, "the name of a tool", &n->tool_name, &n->tool_where))
        return 0;
    int ok = parse_arguments(parser, &n->written);
    if (!ok) {
        while (!at_end(parser) && !dag_at_mark(parser, '{') && !dag_at_mark(parser, '}') &&
               !dag_at_mark(parser, ';'))
            dag_advance(parser);
        if (!dag_at_mark(parser, '{'))
            return 0;
    }
    if (!parse_rules(parser, &n->rules))
        ok = 0;
    n->bad = !ok;
    return 1;
}

/* start = "start" NAME ";" */
static int parse_start(struct parser *parser, int oracle)
{
    struct dag *dag = parser->dag;
    struct target start = {TARGET_NONE, -1, NULL, parser->last};
    if (!dag_expect_name(parser, "the name of a node", &start.name, &start.where)) {
        dag->oracles[oracle].bad = 1;
        return 0;
    }
    struct target *first = &dag->oracles[oracle].start;
    if (first->name != NULL) {
        dag_error(dag, start.where, "a second start");
        dag_note(dag, first->where, "the first is here");
    } else
        *first = start;
    dag_expect(parser, ';', "after the start");
    return 1;
}

/* What may follow a ';' that ends an item: another item, perhaps misspelt, or the '}'. */
static int after_item(const struct parser *parser)
{
    return parser->token.kind == TOKEN_NAME || dag_at_mark(parser, '}');
}

/* To the end of a broken item: past its ';', past the '}' of its body, or before the next item
 * or the oracle's own '}'. */
static void skip_item(struct parser *parser)
{
    int depth = 0;
    while (!at_end(parser) && !(depth == 0 && dag_at_mark(parser, '}'))) {
        if (dag_at_mark(parser, '{'))
            depth++;
        int body = dag_at_mark(parser, '}') && --depth == 0;
        int ends = depth == 0 && dag_at_mark(parser, ';');
        dag_advance(parser);
        if (body || (ends && after_item(parser)))
            return;
    }
}

/* item = "param" parameter ";" | start | node */
static int parse_item(struct parser *parser, int oracle)
{
    struct dag *dag = parser->dag;
    if (dag_take_word(parser, "param")) {
        int ok = dag_parse_parameter(parser);
        struct span *span = &dag->oracles[oracle].parameters;
        int count = dag->parameter_count - span->first;
        if (!ok && count == span->count)
            dag->oracles[oracle].bad = 1;
        span->count = count;
        if (!ok)
            return 0;
        if (dag_expect(parser, ';', "after a parameter"))
            return 1;
        dag->parameters[dag->parameter_count - 1].bad = 1;
        return 0;
    }
    if (dag_take_word(parser, "start"))
        return parse_start(parser, oracle);
    if (dag_take_word(parser, "node")) {
        int ok = parse_node(parser, oracle);
        struct span *span = &dag->oracles[oracle].nodes;
        span->count = dag->node_count - span->first;
        return ok;
    }
    dag_expected(parser, "param, start, node or '}'");
    if (dag_take(parser, ';'))
        return 1;
    if (parser->token.kind == TOKEN_NAME) {
        struct suggestion suggestion = {parser->token.text, NULL, 0};
        dag_suggest(&suggestion, "param");
        dag_suggest(&suggestion, "start");
        dag_suggest(&suggestion, "node");
        dag_note_suggestion(dag, &suggestion);
    }
    dag->oracles[oracle].bad = 1;
    dag_advance(parser);
    return 0;
}

/* oracle = "oracle" NAME [ STRING ] "{" { item } "}" */
int dag_parse_oracle(struct parser *parser)
{
    struct dag *dag = parser->dag;
    struct oracle_graph oracle = {0};
    oracle.doc = "";
    oracle.start.index = -1;
    dag_advance(parser);
    if (!dag_expect_name(parser, "the name of an oracle", &oracle.name, &oracle.where))
        return 0;
    if (parser->token.kind == TOKEN_STRING && !dag_expect_string(parser, "", &oracle.doc))
        return 0;
    oracle.parameters.first = dag->parameter_count;
    oracle.nodes.first = dag->node_count;
    int index = ADD(dag, oracles, oracle_count);
    dag->oracles[index] = oracle;
    if (!dag_expect(parser, '{', "and the oracle's items")) {
        dag->oracles[index].bad = 1;
        return 0;
    }
    for (;;) {
        if (parser->token.kind == TOKEN_END || at_oracle(parser))
            break;
        if (dag_at_mark(parser, '}')) {
            struct where where = parser->token.where;
            dag_advance(parser);
            if (!at_item(parser) || at_oracle(parser))
                return 1;
            dag_error(dag, where, "this '}' would end the oracle, but items follow");
        } else if (!parse_item(parser, index))
            skip_item(parser);
    }
    dag_expect(parser, '}', "at the end of the oracle");
    return 1;
}
