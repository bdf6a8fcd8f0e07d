/* resolve_catalog.c - the catalog's names to indices.
 *
 * A name may be used before its declaration. After this pass, unless errors were reported, every
 * index of the catalog is valid and the tables of names are complete.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "check/resolve.h"

void dag_resolve_twice(struct dag *dag, const char *what, const char *name, struct where where,
                       struct where first)
{
    dag_error(dag, where, "a second %s '%s'", what, name);
    dag_note(dag, first, "the first is here");
}

enum { NAMES_LISTED = 12 };

void dag_list_name(struct dag *dag, struct name_list *list, const char *name)
{
    if (list->count < NAMES_LISTED)
        list->text = list->count == 0 ? name : dag_format(&dag->arena, "%s, %s", list->text, name);
    list->count++;
}

void dag_note_names(struct dag *dag, const char *what, const struct name_list *list)
{
    dag_note(dag, dag_nowhere, "%s are: %s%s", what, list->text,
             list->count > NAMES_LISTED ? ", ..." : "");
}

/* Declares the new items of one kind, `name` and `where` being its first two fields. */
#define DECLARE(dag, table, list, count, what) \
    for (int i = (dag)->resolved.list; i < (dag)->count; i++) { \
        int first = dag_put(&(dag)->arena, &(dag)->table, (dag)->list[i].name, i); \
        if (first >= 0) \
            dag_resolve_twice(dag, what, (dag)->list[i].name, (dag)->list[i].where, \
                              (dag)->list[first].where); \
    }

static int resolve_type(struct dag *dag, const char *name, struct where where)
{
    if (name == NULL)
        return -1;
    int type = dag_find(&dag->type_names, name);
    if (type < 0 && !dag->lost) {
        struct suggestion suggestion = {name, NULL, 0};
        struct name_list types = {"", 0};
        dag_error(dag, where, "unknown type '%s'", name);
        for (int i = 0; i < dag->type_count && !dag_errors_full(dag); i++) {
            dag_suggest(&suggestion, dag->types[i].name);
            dag_list_name(dag, &types, dag->types[i].name);
        }
        dag_note_suggestion(dag, &suggestion);
        if (!suggestion.best && types.count > 0)
            dag_note_names(dag, "the types", &types);
    }
    return type;
}

static void resolve_role(struct dag *dag, struct parameter *parameter)
{
    parameter->role = dag_find(&dag->role_names, parameter->role_name);
    if (parameter->role < 0) {
        struct suggestion suggestion = {parameter->role_name, NULL, 0};
        if (dag->lost)
            return;
        dag_error(dag, parameter->role_where, "unknown role '%s'", parameter->role_name);
        for (int i = 0; i < dag->role_count && !dag_errors_full(dag); i++)
            dag_suggest(&suggestion, dag->roles[i].name);
        dag_note_suggestion(dag, &suggestion);
        return;
    }
    const struct role *role = &dag->roles[parameter->role];
    if (parameter->bad || role->type < 0)
        return;
    const struct type *type = &dag->types[parameter->type], *wanted = &dag->types[role->type];
    if (type->base == wanted->base && dag_same_unit(&type->unit, &wanted->unit))
        return;
    dag_error(dag, parameter->role_where, "the role '%s' is for a parameter of type '%s'",
              role->name, role->type_name);
    dag_note(dag, parameter->type_where, "this one is of type '%s'", parameter->type_name);
}

void dag_resolve_parameters(struct dag *dag, struct span span, int roles)
{
    struct table names = {NULL, NULL, 0, 0};
    for (int i = span.first; i < span.first + span.count; i++) {
        struct parameter *parameter = &dag->parameters[i];
        int first = dag_put(&dag->arena, &names, parameter->name, i);
        if (first >= 0)
            dag_resolve_twice(dag, "parameter", parameter->name, parameter->where,
                              dag->parameters[first].where);
        if (strcmp(parameter->name, "inf") == 0)
            dag_error(dag, parameter->where, "'inf' is a number and cannot name a parameter");
        parameter->type = resolve_type(dag, parameter->type_name, parameter->type_where);
        if (parameter->type < 0)
            parameter->bad = 1;
        else if (dag->types[parameter->type].length != 1) {
            dag_error(dag, parameter->type_where, "'%s' is a vector: a parameter is one number",
                      parameter->type_name);
            parameter->bad = 1;
        }
        if (parameter->role_name != NULL && roles)
            resolve_role(dag, parameter);
        else if (parameter->role_name != NULL)
            dag_error(dag, parameter->role_where, "only a parameter of an oracle has a role");
    }
}

void dag_refuse_any_unit(struct dag *dag, int type, struct where where)
{
    if (type >= 0 && dag->types[type].any_unit)
        dag_error(dag, where, "only a tool's parameter may have any unit (\"?\")");
}

static void resolve_term(struct dag *dag, struct term *term)
{
    term->type = resolve_type(dag, term->type_name, term->type_where);
    dag_refuse_any_unit(dag, term->type, term->type_where);
    if (term->levels.count >= ANSWERS_MAX) {
        dag_error(dag, term->where, "a term has at most %d levels", ANSWERS_MAX - 1);
        return;
    }
    for (int i = 0; i < term->levels.count; i++)
        for (int j = 0; j < i; j++) {
            const struct level *levels = &dag->levels[term->levels.first];
            if (strcmp(levels[i].name, levels[j].name) == 0)
                dag_resolve_twice(dag, "level", levels[i].name, levels[i].where, levels[j].where);
        }
}

/* `decision`: it may read a term that is `absent`, which keeps what a path has without asking
 * for it. */
static void resolve_needs(struct dag *dag, struct span span, int decision)
{
    for (int i = span.first; i < span.first + span.count; i++) {
        struct need *need = &dag->needs[i];
        need->term = dag_find(&dag->term_names, need->term_name);
        need->level = 1;
        if (need->term < 0) {
            struct suggestion suggestion = {need->term_name, NULL, 0};
            if (dag->lost)
                continue;
            dag_error(dag, need->where, "unknown term '%s'", need->term_name);
            for (int t = 0; t < dag->term_count && !dag_errors_full(dag); t++)
                dag_suggest(&suggestion, dag->terms[t].name);
            dag_note_suggestion(dag, &suggestion);
            continue;
        }
        if (need->level_name == NULL)
            continue;
        const struct term *term = &dag->terms[need->term];
        struct suggestion suggestion = {need->level_name, NULL, 0};
        need->level = 0;
        if (decision && strcmp(need->level_name, "absent") == 0)
            continue;
        for (int l = 0; l < term->levels.count; l++) {
            const char *name = dag->levels[term->levels.first + l].name;
            dag_suggest(&suggestion, name);
            if (strcmp(name, need->level_name) == 0)
                need->level = l + 1;
        }
        if (need->level == 0) {
            dag_error(dag, need->level_where, "the term '%s' has no level '%s'", term->name,
                      need->level_name);
            dag_note_suggestion(dag, &suggestion);
        }
    }
}

/* The names of a tool's answers or of a graph's exits. */
void dag_resolve_answers(struct dag *dag, struct span span, const char *what)
{
    const struct answer *answers = &dag->answers[span.first];
    for (int i = 0; i < span.count; i++) {
        if (strcmp(answers[i].name, "otherwise") == 0)
            dag_error(dag, answers[i].where, "'otherwise' stands for all other answers");
        for (int j = 0; j < i; j++)
            if (strcmp(answers[i].name, answers[j].name) == 0)
                dag_resolve_twice(dag, what, answers[i].name, answers[i].where, answers[j].where);
    }
}

static int scalar_type(struct dag *dag, const char *name, struct where where)
{
    int type = resolve_type(dag, name, where);
    dag_refuse_any_unit(dag, type, where);
    if (type < 0 || dag->types[type].length == 1)
        return type;
    dag_error(dag, where, "'%s' is a vector: an expression is made of single numbers", name);
    return -1;
}

/* `a.b` would be two things if the term a had a level b. */
static void resolve_fact(struct dag *dag, struct fact *fact)
{
    const char *dot = strchr(fact->name, '.');
    fact->type = scalar_type(dag, fact->type_name, fact->type_where);
    const char *first =
        dot == NULL ? fact->name : dag_copy(&dag->arena, fact->name, (size_t)(dot - fact->name));
    int term = dag_find(&dag->term_names, first);
    if (term >= 0) {
        dag_error(dag, fact->where, "'%s' is a term and cannot %s a fact", first,
                  dot == NULL ? "name" : "begin the name of");
        dag_note(dag, dag->terms[term].where, "declared here");
    }
}

static int is_kept_like(const struct dag *dag, const struct tool *tool, int count, enum base first)
{
    const struct parameter *p = &dag->parameters[tool->parameters.first];
    if (tool->parameters.count != count)
        return 0;
    for (int i = 0; i < count; i++)
        if (p[i].type >= 0 && dag->types[p[i].type].base != (i == 0 ? first : BASE_INTEGER))
            return 0;
    return 1;
}

static void check_kept(struct dag *dag, const struct tool *tool)
{
    if (tool->keeps == KEEPS_COUNT && !is_kept_like(dag, tool, 1, BASE_INTEGER))
        dag_error(dag, tool->keeps_where, "a tool that counts has one parameter, a whole number");
    if (tool->keeps == KEEPS_RECORD && !is_kept_like(dag, tool, 2, BASE_REAL))
        dag_error(dag, tool->keeps_where,
                  "a tool that records has two parameters, a real number and the whole number"
                  " of its histogram");
}

/* Only who is told to do something refuses, and not always. */
static void check_refusals(struct dag *dag, const struct tool *tool)
{
    int refusals = 0;
    for (int i = tool->answers.first; i < tool->answers.first + tool->answers.count; i++) {
        const struct answer *answer = &dag->answers[i];
        refusals += answer->refuses;
        if (answer->refuses && tool->kind != TOOL_COMMAND) {
            dag_error(dag, answer->where, "'%s' cannot refuse: '%s' is a question", answer->name,
                      tool->name);
            dag_note(dag, dag_nowhere,
                     "a command refuses; a question that does not know answers: "
                     "%s other",
                     answer->name);
        }
    }
    if (tool->kind == TOOL_COMMAND && refusals > 0 && refusals == tool->answers.count) {
        dag_error(dag, tool->where, "the command '%s' always refuses", tool->name);
        dag_note(dag, dag_nowhere,
                 "add the answer that says it is done: answers (done, %s refuses)",
                 dag->answers[tool->answers.first].name);
    }
}

static void resolve_tool(struct dag *dag, const struct tool *tool)
{
    dag_resolve_parameters(dag, tool->parameters, 0);
    check_kept(dag, tool);
    check_refusals(dag, tool);
    resolve_needs(dag, tool->reads, 0);
    resolve_needs(dag, tool->writes, 0);
    if (tool->answers.count > ANSWERS_MAX) {
        dag_error(dag, tool->where, "a tool has at most %d answers", ANSWERS_MAX);
        return;
    }
    dag_resolve_answers(dag, tool->answers, "answer");
}

/* ---- units */

static void wrong_unit(struct dag *dag, struct where where, const char *text, int at, int quoted)
{
    where.offset += quoted + at;
    where.length = 1;
    dag_error(dag, where, "\"%s\" is not a unit that can be read from here on", text);
    dag_note(dag, dag_nowhere, "write a product of these, such as \"W/m2\" or \"kg m s-2\": %s",
             dag_known_units(dag));
    dag_note(dag, dag_nowhere, "or declare one: unit ms = 1e-3 s;");
}

static int has_letters_only(const char *name)
{
    for (; *name != '\0'; name++)
        if (!((*name >= 'a' && *name <= 'z') || (*name >= 'A' && *name <= 'Z')))
            return 0;
    return 1;
}

static void resolve_units(struct dag *dag)
{
    int progress = 1, first = dag->resolved.units;
    for (int i = first; i < dag->unit_count; i++) {
        struct own_unit *u = &dag->units[i];
        u->known = 1; /* should it be wrong, that has been said */
        if (!has_letters_only(u->name))
            dag_error(dag, u->where, "a unit's name has letters alone: digits are exponents");
        else if (dag_is_si_unit(u->name))
            dag_error(dag, u->where, "the unit '%s' is known already", u->name);
        else if (!(u->number > 0 && u->number <= 1e300))
            dag_error(dag, u->where, "a unit is a positive multiple of others");
        else
            u->known = 0;
    }
    while (progress) { /* one may be made of others that stand behind it */
        progress = 0;
        for (int i = first; i < dag->unit_count; i++) {
            struct own_unit *u = &dag->units[i];
            if (u->known || dag_parse_unit(dag, u->text, &u->unit) >= 0)
                continue;
            u->unit.size *= u->number;
            u->known = 1;
            progress = 1;
        }
    }
    for (int i = first; i < dag->unit_count; i++) {
        struct own_unit *u = &dag->units[i];
        if (!u->known)
            wrong_unit(dag, u->text_where, u->text, dag_parse_unit(dag, u->text, &u->unit), 0);
        u->known = 1;
    }
    for (int i = dag->resolved.types; i < dag->type_count; i++) {
        struct type *type = &dag->types[i];
        int wrong = type->any_unit ? -1 : dag_parse_unit(dag, type->unit_text, &type->unit);
        if (wrong >= 0)
            wrong_unit(dag, type->unit_where, type->unit_text, wrong, 1);
        if (type->any_unit && (type->base == BASE_INTEGER || type->length > 1))
            dag_error(dag, type->unit_where, "only a single real number may have any unit");
    }
    dag->resolved.units = dag->unit_count;
}

void dag_resolve_catalog(struct dag *dag)
{
    DECLARE(dag, unit_names, units, unit_count, "unit")
    resolve_units(dag);
    DECLARE(dag, type_names, types, type_count, "type")
    DECLARE(dag, term_names, terms, term_count, "term")
    DECLARE(dag, tool_names, tools, tool_count, "tool")
    DECLARE(dag, decision_names, decisions, decision_count, "decision")
    DECLARE(dag, fact_names, facts, fact_count, "fact")
    DECLARE(dag, role_names, roles, role_count, "role")
    DECLARE(dag, callback_names, callbacks, callback_count, "extern")
    for (int i = dag->resolved.terms; i < dag->term_count; i++)
        resolve_term(dag, &dag->terms[i]);
    for (int i = dag->resolved.facts; i < dag->fact_count; i++)
        resolve_fact(dag, &dag->facts[i]);
    for (int i = dag->resolved.roles; i < dag->role_count; i++) {
        struct role *role = &dag->roles[i];
        role->type = scalar_type(dag, role->type_name, role->type_where);
        if (strcmp(role->name, "none") == 0) /* ROLE_NONE in C */
            dag_error(dag, role->where,
                      "'none' is what a parameter without a role has, and names none");
    }
    for (int i = dag->resolved.callbacks; i < dag->callback_count; i++) {
        struct callback *callback = &dag->callbacks[i];
        callback->type = scalar_type(dag, callback->type_name, callback->type_where);
        resolve_needs(dag, callback->reads, 0);
    }
    for (int i = dag->resolved.tools; i < dag->tool_count; i++)
        resolve_tool(dag, &dag->tools[i]);
    for (int i = dag->resolved.decisions; i < dag->decision_count; i++)
        resolve_needs(dag, dag->decisions[i].reads, 1);
    for (int i = dag->resolved.tools; i < dag->tool_count; i++)
        dag_resolve_guards(dag, &dag->tools[i]);
    dag->resolved.types = dag->type_count;
    dag->resolved.terms = dag->term_count;
    dag->resolved.tools = dag->tool_count;
    dag->resolved.decisions = dag->decision_count;
    dag->resolved.facts = dag->fact_count;
    dag->resolved.roles = dag->role_count;
    dag->resolved.callbacks = dag->callback_count;
    if (dag->runtime_header == NULL && dag->error_count == 0) {
        struct where where = {0, 0, 0}; /* the catalog is read first, then what it imports */
        dag_error(dag, where, "the catalog names no runtime");
        dag_note(dag, dag_nowhere,
                 "add: runtime \"HEADER.h\" abi 1;  or, to extend the standard one: "
                 "import standard;");
    }
    if (dag->decision_count == 0 && dag->error_count == 0) {
        struct where where = {0, 0, 0}; /* the catalog is read first, then what it imports */
        dag_error(dag, where, "the catalog declares no decision: no graph could end");
    }
}
