/* arguments.c - the values of a step's arguments.
 *
 * Arguments of numbers and parameters are evaluated once, when a parameter is set. A step with
 * others calls `program_compute` in its tool's place, which runs a program for a stack that ends as
 * the tool's arguments; so the walk itself need not ask which kind a step is. Operations and their
 * order are those of the flat release's C text (dagc/emit/emit_expression.c): the values are the
 * same to the bit.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "oracle/load_graph.h"
#include "oracle/program.h"
#include "oracle/tool_table.h"

static double operate(enum expression_kind kind, double a, double b)
{
    switch (kind) {
    case EXPRESSION_NEGATE:
        return -a;
    case EXPRESSION_SQRT:
        return sqrt(a);
    case EXPRESSION_ABS:
        return fabs(a);
    case EXPRESSION_ADD:
        return a + b;
    case EXPRESSION_SUBTRACT:
        return a - b;
    case EXPRESSION_MULTIPLY:
        return a * b;
    case EXPRESSION_DIVIDE:
        return a / b;
    case EXPRESSION_MIN:
        return a < b || isnan(a) || (a == b && signbit(a)) ? a : b;
    case EXPRESSION_MAX:
        return a > b || isnan(a) || (a == b && !signbit(a)) ? a : b;
    default:
        return 0; /* no operator */
    }
}

void program_evaluate(struct discussion *d, const struct computed *c, double *stack)
{
    const struct instruction *i = c->code, *end = i + c->count;
    double *top = stack;
    for (; i < end; i++)
        switch (i->kind) {
        case EXPRESSION_NUMBER:
            *top++ = i->number;
            break;
        case EXPRESSION_TERM:
            *top = i->term(d, i->level);
            if (i->fact) /* read for the extern that follows, the value is not wanted */
                break;
            top++;
            break;
        case EXPRESSION_FACT:
        case EXPRESSION_EXTERN:
            *top++ = i->fact(d);
            break;
        case EXPRESSION_NEGATE:
        case EXPRESSION_SQRT:
        case EXPRESSION_ABS:
            top[-1] = operate(i->kind, top[-1], 0);
            break;
        default:
            top--;
            top[-1] = operate(i->kind, top[-1], top[0]);
            break;
        }
    for (int k = 0; k < c->doubt_count; k++) {
        const struct doubtful *doubt = &c->doubts[k];
        double *value = &stack[doubt->argument];
        if (*value >= doubt->low && *value <= doubt->high)
            continue;
        if (!d->terms.no_number)
            d->terms.no_number = doubt->what;
        *value = doubt->instead;
    }
}

int program_compute(struct discussion *d, const double *arguments)
{
    const struct computed *c = (const struct computed *)(const void *)arguments;
    double stack[STACK_MAX];
    program_evaluate(d, c, stack);
    return c->call(d, stack);
}

/* The value of a tree of numbers and parameters. */
static double fold(const struct refiner *r, int expression)
{
    const struct program *p = r->own;
    const struct expression *e = &p->dag->expressions[expression];
    if (e->kind == EXPRESSION_NUMBER)
        return e->number;
    if (e->kind == EXPRESSION_PARAMETER)
        return refiner_get(r, e->parameter - p->first_parameter);
    double a = fold(r, e->left);
    double b = e->right < 0 ? 0 : fold(r, e->right);
    return operate(e->kind, a, b);
}

static const struct term_entry *find_term(const char *name)
{
    for (int i = 0; i < term_table_count; i++)
        if (strcmp(term_table[i].name, name) == 0)
            return &term_table[i];
    return NULL;
}

static const struct fact_entry *find_fact(const char *name)
{
    for (int i = 0; i < fact_table_count; i++)
        if (strcmp(fact_table[i].name, name) == 0)
            return &fact_table[i];
    return NULL;
}

/* Appends the tree's code; what is fixed in it becomes one number. Every name has been looked up
 * by `link_expression`. */
static struct instruction *compile(const struct refiner *r, int expression, struct instruction *at)
{
    const struct program *p = r->own;
    const struct dag *dag = p->dag;
    const struct expression *e = &dag->expressions[expression];
    struct instruction i = {e->kind, e->level, 0, NULL, NULL};
    if (dag_is_fixed(dag, expression)) {
        i.kind = EXPRESSION_NUMBER;
        i.number = fold(r, expression);
    } else if (e->kind == EXPRESSION_FACT) {
        i.fact = find_fact(dag->facts[e->index].name)->read;
    } else if (e->kind == EXPRESSION_TERM) {
        i.term = find_term(dag->terms[e->index].name)->read;
    } else if (e->kind == EXPRESSION_EXTERN) {
        const struct span reads = dag->callbacks[e->index].reads;
        i.fact = p->externs[e->index].fact;
        for (int k = reads.first; k < reads.first + reads.count; k++) {
            struct instruction need = {EXPRESSION_TERM, dag->needs[k].level, 0,
                                       find_term(dag->terms[dag->needs[k].term].name)->read,
                                       i.fact};
            *at++ = need;
        }
    } else {
        at = compile(r, e->left, at);
        if (e->right >= 0)
            at = compile(r, e->right, at);
    }
    *at++ = i;
    return at;
}

/* Can every name in the tree be evaluated here? 0, or -1 after a message. *size gets the room
 * its code needs. */
static int link_expression(const struct program *p, int expression, const char *oracle, int *size,
                           struct messages *messages)
{
    const struct dag *dag = p->dag;
    const struct expression *e = &dag->expressions[expression];
    const char *what = NULL, *name = NULL;
    ++*size;
    if (e->kind == EXPRESSION_FACT && !find_fact(dag->facts[e->index].name)) {
        what = "fact";
        name = dag->facts[e->index].name;
    } else if (e->kind == EXPRESSION_TERM && !find_term(dag->terms[e->index].name)) {
        what = "term";
        name = dag->terms[e->index].name;
    } else if (e->kind == EXPRESSION_EXTERN) {
        const struct span reads = dag->callbacks[e->index].reads;
        *size += reads.count;
        for (int k = reads.first; k < reads.first + reads.count && !what; k++)
            if (!find_term(dag->terms[dag->needs[k].term].name)) {
                what = "term";
                name = dag->terms[dag->needs[k].term].name;
            }
        if (!p->externs[e->index].fact)
            return graph_lacks_extern(dag, e->index, messages);
    }
    if (what)
        return messages_say(messages, MESSAGE_ARGUMENT,
                            "oracle %s: this program was built without the %s '%s'; use the "
                            "flat release",
                            oracle, what, name);
    if (e->left >= 0 && link_expression(p, e->left, oracle, size, messages) < 0)
        return -1;
    return e->right >= 0 ? link_expression(p, e->right, oracle, size, messages) : 0;
}

void program_prepare(struct refiner *r)
{
    struct program *p = r->own;
    for (int i = 0; i < p->argument_count; i++)
        p->arguments[i] = dag_is_fixed(p->dag, p->expressions[i]) ? fold(r, p->expressions[i]) : 0;
    for (int i = 0; i < p->computed_count; i++) {
        struct computed *c = &p->computed[i];
        struct instruction *end = c->code;
        for (int k = 0; k < c->argument_count; k++)
            end = compile(r, p->expressions[c->argument + k], end);
        c->count = (int)(end - c->code);
    }
}

static int is_computed(const struct dag *dag, const struct node *n)
{
    for (int k = 0; k < n->arguments.count; k++) {
        const struct argument *a = &dag->arguments[n->arguments.first + k];
        if (!dag_is_fixed(dag, a->expression) || dag_is_doubtful(dag, a))
            return 1;
    }
    return 0;
}

/* The arguments of a step that may be no number, to `to`. Returns how many. */
static int find_doubts(struct dag *dag, const struct node *n, struct doubtful *to)
{
    int count = 0;
    for (int k = 0; k < n->arguments.count; k++) {
        const struct argument *a = &dag->arguments[n->arguments.first + k];
        if (!dag_is_doubtful(dag, a))
            continue;
        const struct dag_doubt doubt = dag_doubt(dag, n, a);
        to[count++] = (struct doubtful){k, doubt.low, doubt.high, doubt.instead, doubt.what};
    }
    return count;
}

/* Each computed step gets its part of the room for all code. */
int program_link(struct program *p, const struct oracle_graph *g, struct messages *messages)
{
    struct dag *dag = p->dag;
    int size = 0, argument = 0, doubts = 0, *first = NULL;
    for (int i = 0; i < g->order.count; i++)
        p->computed_count += is_computed(dag, dag_node_at(dag, g, i));
    p->computed = calloc((size_t)p->computed_count + 1, sizeof *p->computed);
    first = calloc((size_t)p->computed_count + 1, sizeof *first);
    p->doubts = calloc((size_t)p->argument_count + 1, sizeof *p->doubts);
    if (!p->computed || !first || !p->doubts)
        goto memory;
    p->computed_count = 0;
    for (int i = 0; i < g->order.count; i++) {
        const struct node *n = dag_node_at(dag, g, i);
        struct computed *c = &p->computed[p->computed_count];
        if (is_computed(dag, n)) {
            if (n->arguments.count > STACK_MAX - EXPRESSION_DEPTH) {
                free(first);
                return messages_say(messages, MESSAGE_ARGUMENT,
                                    "oracle %s: '%s' has too many arguments to compute", g->name,
                                    n->tool_name);
            }
            c->call = p->steps[i].call;
            c->argument = argument;
            c->argument_count = n->arguments.count;
            c->doubts = &p->doubts[doubts];
            c->doubt_count = find_doubts(dag, n, &p->doubts[doubts]);
            doubts += c->doubt_count;
            p->steps[i].call = program_compute;
            p->steps[i].arguments = &c->unused;
            first[p->computed_count++] = size;
            for (int k = 0; k < n->arguments.count; k++)
                if (link_expression(p, p->expressions[argument + k], g->name, &size, messages)
                    < 0) {
                    free(first);
                    return -1;
                }
        }
        argument += n->arguments.count;
    }
    p->code = calloc((size_t)size + 1, sizeof *p->code);
    if (!p->code)
        goto memory;
    for (int i = 0; i < p->computed_count; i++)
        p->computed[i].code = &p->code[first[i]];
    free(first);
    return 0;
memory:
    free(first);
    return messages_say(messages, MESSAGE_MEMORY, "out of memory");
}
