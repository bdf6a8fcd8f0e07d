/* same_catalog.c - see same_catalog.h.
 * SPDX-License-Identifier: MIT */
#include "prove/same_catalog.h"

#include <stdio.h>
#include <string.h>

#include "base/internal.h"

static int same_needs(const struct dag *a, struct span x, const struct dag *b, struct span y)
{
    int same = x.count == y.count;
    for (int i = 0; same && i < x.count; i++) {
        const struct need *p = &a->needs[x.first + i], *q = &b->needs[y.first + i];
        same = p->term == q->term && p->level == q->level;
    }
    return same;
}

static int same_type(const struct type *x, const struct type *y)
{
    return x->base == y->base && x->length == y->length && x->any_unit == y->any_unit
           && dag_same_unit(&x->unit, &y->unit);
}

/* (Of documentation, ranges and defaults nothing depends on which question is asked.) */
static int same_tool(const struct dag *a, const struct tool *x, const struct dag *b,
                     const struct tool *y)
{
    int same = x->kind == y->kind && x->answers.count == y->answers.count
               && x->parameters.count == y->parameters.count && strcmp(x->header, y->header) == 0
               && same_needs(a, x->reads, b, y->reads) && same_needs(a, x->writes, b, y->writes);
    for (int i = 0; same && i < x->answers.count; i++) {
        const struct answer *p = &a->answers[x->answers.first + i],
                            *q = &b->answers[y->answers.first + i];
        same = strcmp(p->name, q->name) == 0 && p->refuses == q->refuses;
    }
    for (int i = 0; same && i < x->parameters.count; i++) {
        const struct parameter *p = &a->parameters[x->parameters.first + i],
                               *q = &b->parameters[y->parameters.first + i];
        same = strcmp(p->name, q->name) == 0 && same_type(&a->types[p->type], &b->types[q->type]);
    }
    return same;
}

static int same_term(const struct dag *a, const struct term *x, const struct dag *b,
                     const struct term *y)
{
    int same = x->levels.count == y->levels.count && strcmp(x->header, y->header) == 0
               && same_type(&a->types[x->type], &b->types[y->type]);
    for (int i = 0; same && i < x->levels.count; i++)
        same =
            strcmp(a->levels[x->levels.first + i].name, b->levels[y->levels.first + i].name) == 0;
    return same;
}

/* 0, and it is said: they know tools, terms or decisions of other names. */
static int same_names(const struct dag *a, const struct dag *b)
{
    int same = a->tool_count == b->tool_count && a->term_count == b->term_count
               && a->decision_count == b->decision_count;
    for (int i = 0; same && i < a->tool_count; i++)
        same = strcmp(a->tools[i].name, b->tools[i].name) == 0;
    for (int i = 0; same && i < a->term_count; i++)
        same = strcmp(a->terms[i].name, b->terms[i].name) == 0;
    for (int i = 0; same && i < a->decision_count; i++)
        same = strcmp(a->decisions[i].name, b->decisions[i].name) == 0;
    if (!same)
        fprintf(stderr, "dagc: error: the two files declare different tools, terms or decisions\n");
    return same;
}

int dag_same_catalog(const struct dag *a, const struct dag *b)
{
    const char *what = NULL, *name = "";
    if (!same_names(a, b))
        return 0;
    if (a->runtime_abi != b->runtime_abi || strcmp(a->runtime_header, b->runtime_header) != 0)
        what = "runtime";
    for (int i = 0; what == NULL && i < a->term_count; i++)
        if (!same_term(a, &a->terms[i], b, &b->terms[i])) {
            what = "term ";
            name = a->terms[i].name;
        }
    for (int i = 0; what == NULL && i < a->tool_count; i++)
        if (!same_tool(a, &a->tools[i], b, &b->tools[i])) {
            what = "tool ";
            name = a->tools[i].name;
        }
    if (what != NULL)
        fprintf(stderr, "dagc: error: the two files declare the %s%s differently\n", what, name);
    return what == NULL;
}
