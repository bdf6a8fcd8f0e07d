/* parse_catalog.c - the declarations that teach dagc its domain; see parse.h.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "read/parse.h"

/* A catalog where an oracle is expected, with one already: one error, instead of one for each
 * thing it declares again. */
static int refuse_catalog(struct parser *parser, struct where where)
{
    struct dag *dag = parser->dag;
    dag_error(dag, where, "this file is a catalog, not an oracle, and there is one already");
    dag_note(dag, dag->runtime_where, "that one begins here");
    dag_note(dag, dag_nowhere,
             "--catalog=FILE takes it in place of that one; --emit=catalog documents it");
    while (parser->token.kind != TOKEN_END)
        dag_advance(parser);
    return 1;
}

/* runtime = "runtime" STRING "abi" NUMBER ";" */
static int parse_runtime(struct parser *parser)
{
    struct dag *dag = parser->dag;
    struct where where = parser->last;
    if (dag->runtime_header != NULL && parser->content == CONTENT_ORACLES
        && dag->sources[where.source].importer.source < 0
        && dag->runtime_where.source != where.source)
        return refuse_catalog(parser, where);
    const char *header;
    if (!dag_expect_string(parser, "the runtime's header, a string", &header))
        return 0;
    if (!dag_take_word(parser, "abi"))
        return dag_expected(parser, "'abi' and its number");
    double abi;
    struct where abi_where;
    if (!dag_expect_number(parser, &abi, &abi_where))
        return 0;
    if (!(abi >= 0 && abi <= 1e9 && abi == (double)(int)abi))
        dag_error(dag, abi_where, "an abi is a whole number from 0 on");
    else if (dag->runtime_header != NULL) {
        dag_error(dag, where, "a second runtime");
        dag_note(dag, dag->runtime_where, "the first is here");
    } else {
        dag->runtime_header = header;
        dag->runtime_abi = (int)abi;
        dag->runtime_where = where;
    }
    return dag_expect(parser, ';', "after a declaration");
}

/* verb = "verb" NAME ";" */
static int parse_verb(struct parser *parser)
{
    struct dag *dag = parser->dag;
    const char *verb;
    struct where where;
    if (!dag_expect_name(parser, "what the function of an oracle does, a name such as 'decide'",
                         &verb, &where))
        return 0;
    if (dag->verb_where.source >= 0 && strcmp(verb, dag->verb) != 0) {
        dag_error(dag, where, "a second verb");
        dag_note(dag, dag->verb_where, "the first is here");
    } else {
        dag->verb = verb;
        dag->verb_where = where;
    }
    return dag_expect(parser, ';', "after a declaration");
}

/* unit = "unit" NAME "=" [ NUMBER ] UNIT ";" with UNIT as in a type, without its quotes */
static int parse_unit(struct parser *parser)
{
    struct dag *dag = parser->dag;
    struct own_unit unit = {0};
    unit.number = 1;
    if (!dag_expect_name(parser, "the name of a unit", &unit.name, &unit.where)
        || !dag_expect(parser, '=', "after the unit's name"))
        return 0;
    struct where where;
    if (dag_at_number(parser) && !dag_expect_number(parser, &unit.number, &where))
        return 0;
    if (parser->token.kind == TOKEN_STRING) {
        dag_error(dag, parser->token.where, "a unit's size is written without quotes");
        dag_note(dag, dag_nowhere, "write: unit %s = 1e-3 s;", unit.name);
        return 0;
    }
    unit.text_where = parser->token.where;
    while (parser->token.kind != TOKEN_END && !dag_at_mark(parser, ';') && !dag_at_mark(parser, '{')
           && !dag_at_mark(parser, '}'))
        dag_advance(parser);
    int end = parser->last.offset + parser->last.length, from = unit.text_where.offset;
    if (end < from) /* nothing: a multiple of a plain number */
        end = from;
    unit.text_where.length = end - from;
    unit.text = dag_copy(&dag->arena, dag->sources[where.source = unit.where.source].text + from,
                         (size_t)(end - from));
    int index = ADD(dag, units, unit_count);
    dag->units[index] = unit;
    return dag_expect(parser, ';', "after a declaration");
}

/* type = "type" NAME "=" ( "real" [ "[" NUMBER "]" ] | "integer" ) STRING ";" */
static int parse_type(struct parser *parser)
{
    struct dag *dag = parser->dag;
    struct type type = {0};
    type.length = 1;
    type.unit_text = "";
    if (!dag_expect_name(parser, "the name of a type", &type.name, &type.where)) {
        dag->lost = 1;
        return 0;
    }
    int index = ADD(dag, types, type_count);
    struct type *t = &dag->types[index];
    *t = type;
    if (!dag_expect(parser, '=', "after the type's name"))
        return 0;
    if (dag_take_word(parser, "integer"))
        t->base = BASE_INTEGER;
    else if (!dag_take_word(parser, "real"))
        return dag_expected(parser, "'real' or 'integer'");
    struct where where;
    if (t->base == BASE_REAL && dag_take(parser, '[')) {
        double length;
        if (!dag_expect_number(parser, &length, &where))
            return 0;
        if (length >= 2 && length <= VECTOR_MAX_LENGTH && length == (double)(int)length)
            t->length = (int)length;
        else
            dag_error(dag, where, "a vector has 2 to %d components", VECTOR_MAX_LENGTH);
        if (!dag_expect(parser, ']', "after a vector's length"))
            return 0;
    }
    where = parser->token.where;
    if (!dag_expect_string(parser, "a unit, a string such as \"W/m2\" (\"\" for a plain number)",
                           &t->unit_text))
        return 0;
    t->unit_where = where;
    t->any_unit = strcmp(t->unit_text, "?") == 0;
    return dag_expect(parser, ';', "after a declaration");
}

/* range, or nothing; 0 after an error */
static int parse_bounds(struct parser *parser, double *low, double *high)
{
    struct where where;
    int taken = dag_parse_range(parser, low, high, &where);
    if (taken > 0 && !(*low <= *high)) {
        dag_error(parser->dag, where, "this range holds no number");
        *low = -INFINITY;
        *high = INFINITY;
    }
    return taken >= 0;
}

/* Beside NAME.h stands NAME.wave.h. */
static const char *wave_header(struct dag *dag, const char *header)
{
    size_t length = strlen(header);
    if (length > 2 && strcmp(header + length - 2, ".h") == 0)
        length -= 2;
    return dag_format(&dag->arena, "%.*s.wave.h", (int)length, header);
}

/* term = "term" NAME ":" NAME [ range ] [ "levels" "(" NAME { "<" NAME } ")" ]
 *        [ "header" STRING ] [ "wave" ] [ STRING ] ";" */
static int parse_term(struct parser *parser)
{
    struct dag *dag = parser->dag;
    struct term term = {0};
    term.doc = "";
    term.type = -1;
    term.low = -INFINITY;
    term.high = INFINITY;
    if (!dag_expect_name(parser, "the name of a term", &term.name, &term.where)) {
        dag->lost = 1;
        return 0;
    }
    int index = ADD(dag, terms, term_count);
    struct term *t = &dag->terms[index];
    *t = term;
    t->levels.first = dag->level_count;
    if (!dag_expect(parser, ':', "and a type after the term's name")
        || !dag_expect_name(parser, "the name of a type", &t->type_name, &t->type_where)
        || !parse_bounds(parser, &t->low, &t->high))
        return 0;
    if (dag_take_word(parser, "levels")) {
        if (!dag_expect(parser, '(', "after 'levels'"))
            return 0;
        do {
            struct level level;
            if (!dag_expect_name(parser, "the name of a level", &level.name, &level.where))
                return 0;
            int at = ADD(dag, levels, level_count);
            dag->levels[at] = level;
            t->levels.count++;
        } while (dag_take(parser, '<'));
        if (!dag_expect(parser, ')', "or '<' after a level"))
            return 0;
    }
    t->header = dag_format(&dag->arena, "terms/%s.h", t->name);
    if (dag_take_word(parser, "header")
        && !dag_expect_string(parser, "the name of a C header, a string", &t->header))
        return 0;
    if (dag_take_word(parser, "wave"))
        t->wave = wave_header(dag, t->header);
    if (parser->token.kind == TOKEN_STRING && !dag_expect_string(parser, "", &t->doc))
        return 0;
    return dag_expect(parser, ';', "after a declaration");
}

/* fact = "fact" NAME [ "." NAME ] ":" NAME [ range ] [ "fixed" ] "=" STRING [ STRING ] ";" */
static int parse_fact(struct parser *parser)
{
    struct dag *dag = parser->dag;
    struct fact fact = {0};
    fact.doc = fact.c = "";
    fact.type = -1;
    fact.low = -INFINITY;
    fact.high = INFINITY;
    const char *part;
    struct where where;
    if (!dag_expect_name(parser, "the name of a fact", &fact.name, &fact.where)
        || (dag_take(parser, '.')
            && !dag_expect_name(parser, "a name after the '.'", &part, &where))) {
        dag->lost = 1;
        return 0;
    }
    if (parser->last.offset != fact.where.offset) {
        fact.name = dag_format(&dag->arena, "%s.%s", fact.name, part);
        fact.where.length = parser->last.offset + parser->last.length - fact.where.offset;
    }
    int index = ADD(dag, facts, fact_count);
    struct fact *f = &dag->facts[index];
    *f = fact;
    if (!dag_expect(parser, ':', "and a type after the fact's name")
        || !dag_expect_name(parser, "the name of a type", &f->type_name, &f->type_where)
        || !parse_bounds(parser, &f->low, &f->high))
        return 0;
    f->fixed = (unsigned char)dag_take_word(parser, "fixed");
    if (!dag_expect(parser, '=', "and a C expression, a string")
        || !dag_expect_string(parser, "a C expression over d, a string", &f->c))
        return 0;
    if (parser->token.kind == TOKEN_STRING && !dag_expect_string(parser, "", &f->doc))
        return 0;
    return dag_expect(parser, ';', "after a declaration");
}

/* role = "role" NAME ":" NAME [ STRING ] ";" */
static int parse_role(struct parser *parser)
{
    struct dag *dag = parser->dag;
    struct role role = {0};
    role.doc = "";
    role.type = -1;
    if (!dag_expect_name(parser, "the name of a role", &role.name, &role.where)) {
        dag->lost = 1;
        return 0;
    }
    int index = ADD(dag, roles, role_count);
    struct role *r = &dag->roles[index];
    *r = role;
    if (!dag_expect(parser, ':', "and a type after the role's name")
        || !dag_expect_name(parser, "the name of a type", &r->type_name, &r->type_where))
        return 0;
    if (parser->token.kind == TOKEN_STRING && !dag_expect_string(parser, "", &r->doc))
        return 0;
    return dag_expect(parser, ';', "after a declaration");
}

/* needs = "(" NAME [ ">=" NAME ] { "," NAME [ ">=" NAME ] } ")" */
static int parse_needs(struct parser *parser, struct span *span)
{
    struct dag *dag = parser->dag;
    if (span->count != 0) {
        dag_error(dag, parser->last, "a second list of terms: write one");
        span->count = 0;
    }
    span->first = dag->need_count;
    if (!dag_expect(parser, '(', "and terms here"))
        return 0;
    do {
        struct need need = {0};
        need.term = -1;
        if (!dag_expect_name(parser, "the name of a term", &need.term_name, &need.where))
            return 0;
        if (parser->token.kind == TOKEN_AT_LEAST) {
            dag_advance(parser);
            if (!dag_expect_name(parser, "the name of a level", &need.level_name,
                                 &need.level_where))
                return 0;
        }
        int index = ADD(dag, needs, need_count);
        dag->needs[index] = need;
        span->count++;
    } while (dag_take(parser, ','));
    return dag_expect(parser, ')', "or ',' after a term");
}

/* answers = "(" NAME [ kind ] { "," NAME [ kind ] } ")"
 * kind    = "precise" | "approximate" | "other" */
int dag_parse_answers(struct parser *parser, struct span *span)
{
    struct dag *dag = parser->dag;
    span->first = dag->answer_count;
    if (!dag_expect(parser, '(', "and answers here"))
        return 0;
    do {
        struct answer answer = {0};
        if (!dag_expect_name(parser, "the name of an answer", &answer.name, &answer.where))
            return 0;
        if (dag_take_word(parser, "precise"))
            answer.kind = KIND_PRECISE;
        else if (dag_take_word(parser, "approximate"))
            answer.kind = KIND_APPROXIMATE;
        else {
            answer.kind = KIND_OTHER;
            if (!dag_take_word(parser, "other"))
                answer.refuses = (unsigned char)dag_take_word(parser, "refuses");
        }
        int index = ADD(dag, answers, answer_count);
        dag->answers[index] = answer;
        span->count++;
    } while (dag_take(parser, ','));
    return dag_expect(parser, ')', "or ',' after an answer");
}

/* clauses = { "reads" needs | "writes" needs | guards | "counts" | "records" | "header" STRING
 *           | "wave" | "anywhere" }; *wave is raised by that word */
static int parse_clauses(struct parser *parser, struct tool *t, int *wave)
{
    for (;;) {
        if (dag_take_word(parser, "reads")) {
            if (!parse_needs(parser, &t->reads))
                return 0;
        } else if (dag_take_word(parser, "writes")) {
            if (!parse_needs(parser, &t->writes))
                return 0;
        } else if (dag_take_word(parser, "guards")) {
            if (!dag_parse_guards(parser, t))
                return 0;
        } else if (dag_take_word(parser, "counts")) {
            t->keeps = KEEPS_COUNT;
            t->keeps_where = parser->last;
        } else if (dag_take_word(parser, "records")) {
            t->keeps = KEEPS_RECORD;
            t->keeps_where = parser->last;
        } else if (dag_take_word(parser, "header")) {
            if (!dag_expect_string(parser, "the name of a C header, a string", &t->header))
                return 0;
        } else if (dag_take_word(parser, "wave"))
            *wave = 1;
        else if (dag_take_word(parser, "anywhere"))
            t->anywhere = 1;
        else
            return 1;
    }
}

/* tool = "tool" NAME parameters ( "question" | "command" ) "answers" answers
 *        clauses [ STRING ] ";" */
static int parse_tool(struct parser *parser)
{
    struct dag *dag = parser->dag;
    struct tool tool = {0};
    tool.doc = "";
    if (!dag_expect_name(parser, "the name of a tool", &tool.name, &tool.where)) {
        dag->lost = 1;
        return 0;
    }
    int index = ADD(dag, tools, tool_count);
    struct tool *t = &dag->tools[index];
    *t = tool;
    t->header = dag_format(&dag->arena, "tools/%s.h", t->name);
    t->parameters.first = dag->parameter_count;
    int wave = 0;
    if (!dag_parse_parameters(parser, "after the tool's name", &t->parameters))
        return 0;
    if (dag_take_word(parser, "command"))
        t->kind = TOOL_COMMAND;
    else if (!dag_take_word(parser, "question"))
        return dag_expected(parser, "'question' or 'command'");
    if (!dag_take_word(parser, "answers"))
        return dag_expected(parser, "'answers'");
    if (!dag_parse_answers(parser, &t->answers) || !parse_clauses(parser, t, &wave))
        return 0;
    t->wave = wave ? wave_header(dag, t->header) : NULL;
    if (parser->token.kind == TOKEN_STRING && !dag_expect_string(parser, "", &t->doc))
        return 0;
    return dag_expect(parser, ';', "after a declaration");
}

/* decision = "decision" NAME [ "reads" needs ] [ "subdivides" ] [ STRING ] ";" */
static int parse_decision(struct parser *parser)
{
    struct dag *dag = parser->dag;
    struct decision_tool decision = {0};
    decision.doc = "";
    if (!dag_expect_name(parser, "the name of a decision", &decision.name, &decision.where)) {
        dag->lost = 1;
        return 0;
    }
    int index = ADD(dag, decisions, decision_count);
    struct decision_tool *d = &dag->decisions[index];
    *d = decision;
    if (dag_take_word(parser, "reads") && !parse_needs(parser, &d->reads))
        return 0;
    d->subdivides = (unsigned char)dag_take_word(parser, "subdivides");
    if (parser->token.kind == TOKEN_STRING && !dag_expect_string(parser, "", &d->doc))
        return 0;
    return dag_expect(parser, ';', "after a declaration");
}

/* extern = "extern" NAME "(" [ need { "," need } ] ")" ":" NAME [ range ] [ STRING ] ";" */
static int parse_extern(struct parser *parser)
{
    struct dag *dag = parser->dag;
    struct callback callback = {0};
    callback.doc = "";
    callback.type = -1;
    callback.low = -INFINITY;
    callback.high = INFINITY;
    if (!dag_expect_name(parser, "the name of a C function", &callback.name, &callback.where)) {
        dag->lost = 1;
        return 0;
    }
    int index = ADD(dag, callbacks, callback_count);
    struct callback *c = &dag->callbacks[index];
    *c = callback;
    if (dag_at_mark(parser, ':')) {
        dag_error(dag, c->where, "'%s' is a function: expected '(' and what it reads", c->name);
        dag_note(dag, dag_nowhere, "write: extern %s() : TYPE \"doc\";", c->name);
    } else if (dag_at_mark(parser, '(') && dag_peek(parser).mark == ')') {
        dag_advance(parser);
        dag_advance(parser);
    } else if (!parse_needs(parser, &c->reads))
        return 0;
    if (!dag_expect(parser, ':', "and a type after what the function reads")
        || !dag_expect_name(parser, "the name of a type", &c->type_name, &c->type_where)
        || !parse_bounds(parser, &c->low, &c->high))
        return 0;
    if (parser->token.kind == TOKEN_STRING && !dag_expect_string(parser, "", &c->doc))
        return 0;
    return dag_expect(parser, ';', "after a declaration");
}

/* catalog_item = runtime | verb | unit | type | term | fact | role | extern | tool | decision */
int dag_parse_catalog_item(struct parser *parser)
{
    static const struct {
        const char *word;
        int (*parse)(struct parser *parser);
    } items[] = {{"runtime", parse_runtime},  {"verb", parse_verb},     {"unit", parse_unit},
                 {"type", parse_type},        {"term", parse_term},     {"fact", parse_fact},
                 {"role", parse_role},        {"extern", parse_extern}, {"tool", parse_tool},
                 {"decision", parse_decision}};
    for (size_t i = 0; i < sizeof items / sizeof *items; i++)
        if (dag_take_word(parser, items[i].word))
            return items[i].parse(parser);
    return 0;
}
