/* parse_oracle.c - decision graphs, oracles and branches; see parse.h.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "read/parse.h"

static int at_oracle_word(const struct parser *parser)
{
    return dag_at_word(parser, "fixed") || dag_at_word(parser, "param")
           || dag_at_word(parser, "start") || dag_at_word(parser, "node");
}

/* `node NAME`, `param NAME`, `fixed param`, `start NAME` or the next graph: never the inside of a
 * node, where a name is followed by '|', '->', '=' or ';'. */
static int at_item(const struct parser *parser)
{
    return (at_oracle_word(parser) || dag_at_word(parser, "oracle") || dag_at_word(parser, "graph"))
           && dag_peek(parser).kind == TOKEN_NAME;
}

static int at_graph(const struct parser *parser)
{
    return (dag_at_word(parser, "oracle") || dag_at_word(parser, "graph"))
           && dag_peek(parser).kind == TOKEN_NAME;
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

/* arguments = "(" [ NAME "=" expression { "," NAME "=" expression } ] ")" */
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
        if (!dag_expect_name(parser, "the name of an argument", &argument.name, &argument.where)
            || !dag_expect(parser, '=', "after the argument's name: write NAME = value")
            || !dag_parse_expression(parser, &argument.expression))
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
        int rule =
            parser->token.kind == TOKEN_NAME && (next.kind == TOKEN_ARROW || next.mark == '|');
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
static int parse_node(struct parser *parser, struct oracle_graph *graph)
{
    struct dag *dag = parser->dag;
    struct node node = {0};
    node.tool = node.branch = node.use = node.order = -1;
    node.bad = 1;
    if (!dag_expect_name(parser, "the name of a node", &node.name, &node.where)) {
        graph->bad = 1;
        return 0;
    }
    int index = ADD(dag, drafts, draft_count);
    struct node *n = &dag->drafts[index];
    *n = node;
    if (!dag_expect(parser, '=', "and a tool after the node's name")
        || !dag_expect_name(parser, "the name of a tool", &n->tool_name, &n->tool_where))
        return 0;
    int ok = parse_arguments(parser, &n->written);
    if (!ok) {
        while (!at_end(parser) && !dag_at_mark(parser, '{') && !dag_at_mark(parser, '}')
               && !dag_at_mark(parser, ';'))
            dag_advance(parser);
        if (!dag_at_mark(parser, '{'))
            return 0;
    }
    if (!parse_rules(parser, &n->rules))
        ok = 0;
    n->bad = !ok;
    return 1;
}

int dag_parse_replacement(struct dag *dag, int source, struct node *node)
{
    struct parser parser = dag_parser(dag, source, CONTENT_ORACLES);
    *node = (struct node){0};
    node->written.first = -1;
    if (!dag_expect_name(&parser, "the name of a node", &node->name, &node->where)
        || !dag_expect(&parser, '=', "and a tool or an answer after the node's name")
        || !dag_expect_name(&parser, "the name of a tool or of an answer", &node->tool_name,
                            &node->tool_where))
        return 0;
    if (dag_at_mark(&parser, '(')
        && (!parse_arguments(&parser, &node->written)
            || (dag_at_mark(&parser, '{') && !parse_rules(&parser, &node->rules))))
        return 0;
    return parser.token.kind == TOKEN_END
           || dag_expected(&parser, node->written.first < 0
                                        ? "'(' and a tool's arguments, or no more"
                                        : "'{' and rules, or no more");
}

/* start = "start" NAME ";" */
static int parse_start(struct parser *parser, struct oracle_graph *graph)
{
    struct dag *dag = parser->dag;
    struct target start = {TARGET_NONE, -1, NULL, parser->last};
    if (!dag_expect_name(parser, "the name of a node", &start.name, &start.where)) {
        graph->bad = 1;
        return 0;
    }
    struct target *first = &graph->start;
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

/* item = [ "fixed" ] "param" parameter ";" | start | node */
static int parse_item(struct parser *parser, struct oracle_graph *graph)
{
    struct dag *dag = parser->dag;
    int fixed = dag_take_word(parser, "fixed");
    if (fixed && !dag_at_word(parser, "param")) {
        graph->bad = 1;
        return dag_expected(parser, "'param' after 'fixed'");
    }
    if (graph->branch && dag_at_word(parser, "param")) {
        dag_error(dag, parser->token.where, "the parameters of a graph stand in parentheses");
        dag_note(dag, dag_nowhere, "write: graph %s(NAME : TYPE) exits (...)", graph->name);
        graph->bad = 1;
        dag_advance(parser);
        return 0;
    }
    if (dag_take_word(parser, "param")) {
        int ok = dag_parse_parameter(parser);
        struct span *span = &graph->parameters;
        int count = dag->parameter_count - span->first;
        if (!ok && count == span->count)
            graph->bad = 1;
        else
            dag->parameters[dag->parameter_count - 1].fixed = fixed != 0;
        span->count = count;
        if (!ok)
            return 0;
        if (dag_expect(parser, ';', "after a parameter"))
            return 1;
        dag->parameters[dag->parameter_count - 1].bad = 1;
        return 0;
    }
    if (dag_take_word(parser, "start"))
        return parse_start(parser, graph);
    if (dag_take_word(parser, "node")) {
        int ok = parse_node(parser, graph);
        graph->drafts.count = dag->draft_count - graph->drafts.first;
        return ok;
    }
    dag_expected(parser, "fixed, param, start, node or '}'");
    if (dag_take(parser, ';'))
        return 1;
    if (parser->token.kind == TOKEN_NAME) {
        struct suggestion suggestion = {parser->token.text, NULL, 0};
        dag_suggest(&suggestion, "fixed");
        dag_suggest(&suggestion, "param");
        dag_suggest(&suggestion, "start");
        dag_suggest(&suggestion, "node");
        dag_note_suggestion(dag, &suggestion);
    }
    graph->bad = 1;
    dag_advance(parser);
    return 0;
}

/* body = "{" { item } "}"; `what` is the graph's kind */
static int parse_body(struct parser *parser, struct oracle_graph *graph, const char *what)
{
    if (!dag_expect(parser, '{', dag_format(&parser->dag->arena, "and the %s's items", what))) {
        graph->bad = 1;
        return 0;
    }
    for (;;) {
        if (parser->token.kind == TOKEN_END || at_graph(parser))
            break;
        if (dag_at_mark(parser, '}')) {
            struct where where = parser->token.where;
            dag_advance(parser);
            if (!at_item(parser) || at_graph(parser))
                return 1;
            dag_error(parser->dag, where, "this '}' would end the %s, but items follow", what);
        } else if (!parse_item(parser, graph))
            skip_item(parser);
    }
    dag_expect(parser, '}', dag_format(&parser->dag->arena, "at the end of the %s", what));
    return 1;
}

static struct oracle_graph new_graph(const struct dag *dag)
{
    struct oracle_graph graph = {0};
    graph.doc = "";
    graph.start.index = graph.use = -1;
    graph.parameters.first = dag->parameter_count;
    graph.drafts.first = dag->draft_count;
    return graph;
}

/* oracle = "oracle" NAME [ STRING ] body */
int dag_parse_oracle(struct parser *parser)
{
    struct dag *dag = parser->dag;
    struct oracle_graph oracle = new_graph(dag);
    dag_advance(parser);
    if (!dag_expect_name(parser, "the name of an oracle", &oracle.name, &oracle.where))
        return 0;
    if (parser->token.kind == TOKEN_STRING && !dag_expect_string(parser, "", &oracle.doc))
        return 0;
    int index = ADD(dag, oracles, oracle_count);
    dag->oracles[index] = oracle;
    return parse_body(parser, &dag->oracles[index], "oracle");
}

/* graph = "graph" NAME parameters "exits" answers [ STRING ] body */
int dag_parse_branch(struct parser *parser)
{
    struct dag *dag = parser->dag;
    struct oracle_graph branch = new_graph(dag);
    branch.branch = 1;
    dag_advance(parser);
    if (!dag_expect_name(parser, "the name of a graph", &branch.name, &branch.where)) {
        dag->lost = 1;
        return 0;
    }
    int index = ADD(dag, branches, branch_count);
    struct oracle_graph *b = &dag->branches[index];
    *b = branch;
    b->bad = 1;
    if (!dag_parse_parameters(parser, "after the graph's name", &b->parameters))
        return 0;
    if (!dag_take_word(parser, "exits"))
        return dag_expected(parser, "'exits'");
    if (!dag_parse_answers(parser, &b->exits))
        return 0;
    if (parser->token.kind == TOKEN_STRING && !dag_expect_string(parser, "", &b->doc))
        return 0;
    b->bad = 0;
    return parse_body(parser, b, "graph");
}
