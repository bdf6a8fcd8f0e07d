/* resolve_expression.c - the names in the arguments of a node.
 *
 * A plain name is the graph's parameter, else an extern, a fact, or a term at its coarsest level;
 * a name with a dot is a fact, else a term at a level. So a parameter hides a term of its name.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "check/resolve.h"

static void unknown(struct dag *dag, const struct scope *scope, const struct expression *e)
{
    struct suggestion suggestion = {e->name, NULL, 0};
    struct span span = scope->graph->parameters;
    if (e->dot > 0)
        dag_error(dag, e->where, "no fact and no level of a term is called '%s'", e->name);
    else
        dag_error(dag, e->where, "the %s '%s' has no parameter '%s'",
                  scope->graph->branch ? "graph" : "oracle", scope->graph->name, e->name);
    if (dag_errors_full(dag))
        return;
    if (e->dot == 0)
        for (int i = span.first; i < span.first + span.count; i++)
            dag_suggest(&suggestion, dag->parameters[i].name);
    for (int i = 0; i < dag->fact_count; i++)
        dag_suggest(&suggestion, dag->facts[i].name);
    for (int i = 0; i < dag->callback_count; i++)
        dag_suggest(&suggestion, dag->callbacks[i].name);
    for (int i = 0; i < dag->term_count; i++)
        dag_suggest(&suggestion, dag->terms[i].name);
    dag_note_suggestion(dag, &suggestion);
}

/* `term` or `term.level`; 0: the name is no term's. */
static int resolve_term(struct dag *dag, struct expression *e)
{
    const char *name = e->dot == 0 ? e->name : dag_copy(&dag->arena, e->name, (size_t)e->dot);
    int index = dag_find(&dag->term_names, name);
    if (index < 0)
        return 0;
    const struct term *term = &dag->terms[index];
    int level = 1;
    e->bad = 1;
    if (e->dot > 0) {
        struct suggestion suggestion = {e->name + e->dot + 1, NULL, 0};
        for (level = 1; level <= term->levels.count; level++) {
            const char *candidate = dag->levels[term->levels.first + level - 1].name;
            if (strcmp(candidate, suggestion.wanted) == 0)
                break;
            dag_suggest(&suggestion, candidate);
        }
        if (level > term->levels.count) {
            dag_error(dag, e->where, "the term '%s' has no level '%s'", term->name,
                      suggestion.wanted);
            dag_note_suggestion(dag, &suggestion);
            dag_note(dag, term->where, "declared here");
            return 1;
        }
    }
    if (term->type >= 0 && dag->types[term->type].length > 1) {
        dag_error(dag, e->where, "'%s' is a vector: an expression is made of single numbers",
                  term->name);
        dag_note(dag, term->where, "declared here");
        return 1;
    }
    e->bad = 0;
    e->kind = EXPRESSION_TERM;
    e->index = index;
    e->level = level;
    return 1;
}

void dag_resolve_expression(struct dag *dag, const struct scope *scope, int expression)
{
    struct expression *e = &dag->expressions[expression];
    if (e->left >= 0)
        dag_resolve_expression(dag, scope, e->left);
    if (e->right >= 0)
        dag_resolve_expression(dag, scope, e->right);
    dag_fold(dag, e);
    if (e->kind != EXPRESSION_NAME)
        return;
    if (e->dot == 0 && (e->parameter = dag_find(&scope->parameters, e->name)) >= 0)
        e->kind = EXPRESSION_PARAMETER;
    else if ((e->index = dag_find(&dag->callback_names, e->name)) >= 0)
        e->kind = EXPRESSION_EXTERN;
    else if ((e->index = dag_find(&dag->fact_names, e->name)) >= 0)
        e->kind = EXPRESSION_FACT;
    else if (strcmp(e->name, "pi") == 0 && dag_find(&dag->term_names, e->name) < 0) {
        e->kind = EXPRESSION_NUMBER;
        e->number = PI;
    } else if (!resolve_term(dag, e)) {
        e->bad = 1;
        if (!scope->graph->bad && !dag->lost)
            unknown(dag, scope, e);
    }
}
