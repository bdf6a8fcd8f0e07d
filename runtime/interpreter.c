/* interpreter.c - the DAG release: the graph itself, walked node by node.
 *
 * A node becomes a step: the tool's function, the values of its arguments, and a map from answers to
 * steps or decisions. Steps stand in topological order, so every arc leads forward and the walk ends.
 * [Turbet & Sillion, section 4 and figure 3]
 *
 * Arguments of numbers and parameters are evaluated once, when a parameter is set. A step with others
 * calls `compute` in its tool's place, which runs a program for a stack that ends as the tool's
 * arguments; so the walk itself need not ask which kind a step is. Operations and their order are
 * those of the flat release's C text (dagc/emit_expression.c): the values are the same to the bit.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "dag.h"
#include "refiner.h"
#include "tool_table.h"

/* One operation of a computed step: a number, something read, or an operator on the top of the stack. */
struct instruction {
    enum expression_kind kind;
    int level;
    double number;
    double (*term)(struct discussion *d, int level);
    double (*fact)(const struct discussion *d); /* or an extern */
};

enum { STACK_MAX = EXPRESSION_DEPTH + 100 };

/* What `arguments` of a computed step points to. */
struct computed {
    double unused; /* so that a pointer to double may point here */
    int (*call)(struct discussion *d, const double *arguments);
    struct instruction *code;
    int count;
    int argument, argument_count; /* in program.expressions */
};

struct step {
    int (*call)(struct discussion *d, const double *arguments);
    const double *arguments;
    const int *next; /* [answers]: a step, or ~decision */
};

struct program {
    struct step *steps;
    struct oracle_parameter *parameters;
    double *arguments; /* of all steps */
    int *expressions;  /* of all steps: which expression gives each argument */
    int *next;         /* of all steps */
    struct computed *computed;
    int computed_count;
    struct instruction *code;      /* of all computed steps */
    struct instruction *externs;   /* per callback of the dag: its function, NULL when not given */
    int argument_count;
    struct dag *dag;
    int first_parameter; /* of the oracle, in dag->parameters */
};

static enum decision walk(const void *state, struct discussion *d)
{
    const struct step *steps = state, *step = steps;
    for (;;) {
        int next = step->next[step->call(d, step->arguments)];
        if (next < 0)
            return (enum decision)~next;
        step = &steps[next];
    }
}

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
        return a < b ? a : b;
    case EXPRESSION_MAX:
        return a > b ? a : b;
    default:
        return 0; /* no operator */
    }
}

static int compute(struct discussion *d, const double *arguments)
{
    const struct computed *c = (const struct computed *)(const void *)arguments;
    const struct instruction *i = c->code, *end = i + c->count;
    double stack[STACK_MAX], *top = stack;
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
    return c->call(d, stack);
}

/* The value of a tree of numbers and parameters. */
static double fold(const struct refiner *r, int expression)
{
    const struct program *p = r->own;
    const struct expression *e = &p->dag->expressions[expression];
    double a, b;
    if (e->kind == EXPRESSION_NUMBER)
        return e->number;
    if (e->kind == EXPRESSION_PARAMETER)
        return refiner_get(r, e->parameter - p->first_parameter);
    a = fold(r, e->left);
    b = e->right < 0 ? 0 : fold(r, e->right);
    return operate(e->kind, a, b);
}

static const struct term_entry *find_term(const char *name)
{
    int i;
    for (i = 0; i < term_table_count; i++)
        if (strcmp(term_table[i].name, name) == 0)
            return &term_table[i];
    return NULL;
}

static const struct fact_entry *find_fact(const char *name)
{
    int i;
    for (i = 0; i < fact_table_count; i++)
        if (strcmp(fact_table[i].name, name) == 0)
            return &fact_table[i];
    return NULL;
}

/* Appends the tree's code; what is fixed in it becomes one number. Every name has been looked up by `link_expression`. */
static struct instruction *compile(const struct refiner *r, int expression, struct instruction *at)
{
    const struct program *p = r->own;
    const struct dag *dag = p->dag;
    const struct expression *e = &dag->expressions[expression];
    struct instruction i = { e->kind, e->level, 0, NULL, NULL };
    int k;
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
        for (k = reads.first; k < reads.first + reads.count; k++) {
            struct instruction need = { EXPRESSION_TERM, dag->needs[k].level, 0,
                                        find_term(dag->terms[dag->needs[k].term].name)->read, i.fact };
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

/* Can every name in the tree be evaluated here? 0, or -1 after a message. *size gets the room its code needs. */
static int link_expression(const struct program *p, int expression, const char *oracle, int *size, FILE *errors)
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
        int k;
        *size += reads.count;
        for (k = reads.first; k < reads.first + reads.count && !what; k++)
            if (!find_term(dag->terms[dag->needs[k].term].name)) {
                what = "term";
                name = dag->terms[dag->needs[k].term].name;
            }
        if (!p->externs[e->index].fact) {
            fprintf(errors, "%s: error: the extern '%s' is not registered; give its C function in "
                            "interpretation.externs, or use the flat release\n",
                    oracle, dag->callbacks[e->index].name);
            return -1;
        }
    }
    if (what) {
        fprintf(errors, "%s: error: this program was built without the %s '%s'; use the flat release\n",
                oracle, what, name);
        return -1;
    }
    if (e->left >= 0 && link_expression(p, e->left, oracle, size, errors) < 0)
        return -1;
    return e->right >= 0 ? link_expression(p, e->right, oracle, size, errors) : 0;
}

/* Fixed parameters are evaluated once, here, and not in the walk. */
static void prepare(struct refiner *r)
{
    struct program *p = r->own;
    int i, k;
    for (i = 0; i < p->argument_count; i++)
        p->arguments[i] = dag_is_fixed(p->dag, p->expressions[i]) ? fold(r, p->expressions[i]) : 0;
    for (i = 0; i < p->computed_count; i++) {
        struct computed *c = &p->computed[i];
        struct instruction *end = c->code;
        for (k = 0; k < c->argument_count; k++)
            end = compile(r, p->expressions[c->argument + k], end);
        c->count = (int)(end - c->code);
    }
}

static void release_program(struct refiner *r)
{
    struct program *p = r->own;
    if (!p)
        return;
    dag_free(p->dag);
    free(p->steps);
    free(p->parameters);
    free(p->arguments);
    free(p->expressions);
    free(p->next);
    free(p->computed);
    free(p->code);
    free(p->externs);
    free(p);
}

static const struct tool_entry *find_tool(const char *name)
{
    int i;
    for (i = 0; i < tool_table_count; i++)
        if (strcmp(tool_table[i].name, name) == 0)
            return &tool_table[i];
    return NULL;
}

static int is_computed(const struct dag *dag, const struct node *n)
{
    int k;
    for (k = 0; k < n->arguments.count; k++)
        if (!dag_is_fixed(dag, dag->arguments[n->arguments.first + k].expression))
            return 1;
    return 0;
}

/* Room for the code of the computed steps, each of which gets its part of it. 0, or -1 after a message. */
static int build_computed(struct program *p, const struct oracle_graph *g, FILE *errors)
{
    const struct dag *dag = p->dag;
    int i, k, size = 0, argument = 0, *first = NULL;
    for (i = 0; i < g->order.count; i++)
        p->computed_count += is_computed(dag, &dag->nodes[dag->order[g->order.first + i]]);
    p->computed = calloc((size_t)p->computed_count + 1, sizeof *p->computed);
    first = calloc((size_t)p->computed_count + 1, sizeof *first);
    if (!p->computed || !first)
        goto memory;
    p->computed_count = 0;
    for (i = 0; i < g->order.count; i++) {
        const struct node *n = &dag->nodes[dag->order[g->order.first + i]];
        struct computed *c = &p->computed[p->computed_count];
        if (is_computed(dag, n)) {
            if (n->arguments.count > STACK_MAX - EXPRESSION_DEPTH) {
                fprintf(errors, "%s: error: '%s' has too many arguments to compute\n", g->name, n->tool_name);
                free(first);
                return -1;
            }
            c->call = p->steps[i].call;
            c->argument = argument;
            c->argument_count = n->arguments.count;
            p->steps[i].call = compute;
            p->steps[i].arguments = &c->unused;
            first[p->computed_count++] = size;
            for (k = 0; k < n->arguments.count; k++)
                if (link_expression(p, p->expressions[argument + k], g->name, &size, errors) < 0) {
                    free(first);
                    return -1;
                }
        }
        argument += n->arguments.count;
    }
    p->code = calloc((size_t)size + 1, sizeof *p->code);
    if (!p->code)
        goto memory;
    for (i = 0; i < p->computed_count; i++)
        p->computed[i].code = &p->code[first[i]];
    free(first);
    return 0;
memory:
    free(first);
    fprintf(errors, "%s: error: out of memory\n", g->name);
    return -1;
}

/* Steps in the graph's topological order; every span of the dag has been checked by dagc. */
static int build(struct refiner *r, struct program *p, const struct oracle_graph *g, FILE *errors)
{
    const struct dag *dag = p->dag;
    int i, k, arguments = 0, answers = 0;
    for (i = 0; i < g->order.count; i++) {
        const struct node *n = &dag->nodes[dag->order[g->order.first + i]];
        arguments += n->arguments.count;
        answers += n->arcs.count;
    }
    p->first_parameter = g->parameters.first;
    p->argument_count = arguments;
    p->steps = calloc((size_t)g->order.count, sizeof *p->steps);
    p->arguments = calloc((size_t)arguments + 1, sizeof *p->arguments);
    p->expressions = calloc((size_t)arguments + 1, sizeof *p->expressions);
    p->next = calloc((size_t)answers + 1, sizeof *p->next);
    p->parameters = calloc((size_t)g->parameters.count + 1, sizeof *p->parameters);
    r->block = calloc((size_t)g->parameters.count + 1, sizeof(double));
    if (!p->steps || !p->arguments || !p->expressions || !p->next || !p->parameters || !r->block) {
        fprintf(errors, "%s: error: out of memory\n", g->name);
        return -1;
    }
    for (i = 0; i < g->parameters.count; i++) {
        const struct parameter *q = &dag->parameters[g->parameters.first + i];
        struct oracle_parameter *o = &p->parameters[i];
        o->name = q->name;
        o->unit = dag->types[q->type].unit_text;
        o->doc = q->doc;
        o->value = q->value;
        o->low = q->low;
        o->high = q->high;
        o->integer = dag->types[q->type].base == BASE_INTEGER;
        o->offset = (size_t)i * sizeof(double);
    }
    r->parameters = p->parameters;
    r->parameter_count = g->parameters.count;
    arguments = answers = 0;
    for (i = 0; i < g->order.count; i++) {
        const struct node *n = &dag->nodes[dag->order[g->order.first + i]];
        const struct tool_entry *tool = find_tool(dag->tools[n->tool].name);
        if (!tool || tool->argument_count != n->arguments.count || tool->answer_count != n->arcs.count) {
            fprintf(errors, "%s: error: this program was built without the tool '%s'; "
                            "use the flat release\n", g->name, dag->tools[n->tool].name);
            return -1;
        }
        p->steps[i].call = tool->call;
        p->steps[i].arguments = &p->arguments[arguments];
        p->steps[i].next = &p->next[answers];
        for (k = 0; k < n->arguments.count; k++)
            p->expressions[arguments++] = dag->arguments[n->arguments.first + k].expression;
        for (k = 0; k < n->arcs.count; k++) {
            const struct target *t = &dag->arcs[n->arcs.first + k].target;
            p->next[answers++] = t->kind == TARGET_DECISION ? ~t->index : dag->nodes[t->index].order;
        }
    }
    return build_computed(p, g, errors);
}

static int find_externs(struct program *p, const struct interpretation *how)
{
    int i, k;
    p->externs = calloc((size_t)p->dag->callback_count + 1, sizeof *p->externs);
    if (!p->externs)
        return -1;
    for (i = 0; i < p->dag->callback_count; i++)
        for (k = 0; k < how->extern_count; k++)
            if (strcmp(how->externs[k].name, p->dag->callbacks[i].name) == 0)
                p->externs[i].fact = how->externs[k].call;
    return 0;
}

struct refiner *refiner_interpreted(const char *path, const char *text, const char *name, FILE *errors)
{
    struct interpretation how = {0};
    how.path = path;
    how.text = text;
    how.oracle = name;
    return refiner_interpret(&how, errors);
}

struct refiner *refiner_interpret(const struct interpretation *how, FILE *errors)
{
    const char *path = how->path, *name = how->oracle;
    struct dag_options options = {0};
    struct refiner *r = calloc(1, sizeof *r);
    struct program *p = calloc(1, sizeof *p);
    int index, i;
    if (!r || !p) {
        fprintf(errors, "%s: error: out of memory\n", path);
        free(r);
        free(p);
        return NULL;
    }
    r->own = p;
    r->release_state = release_program;
    options.text = how->text;
    options.length = how->text ? strlen(how->text) : 0;
    options.catalog_path = how->catalog_path;
    options.folders = how->folders;
    options.folder_count = how->folder_count;
    options.switches = how->switches;
    p->dag = dag_load_with(path, &options, errors);
    if (!p->dag)
        goto fail;
    index = dag_oracle(p->dag, name);
    if (index < 0) {
        if (name)
            fprintf(errors, "%s: error: no oracle '%s' here\n", path, name);
        else
            fprintf(errors, "%s: error: %d oracles here, not one\n", path, p->dag->oracle_count);
        goto fail;
    }
    if (find_externs(p, how) < 0) {
        fprintf(errors, "%s: error: out of memory\n", path);
        goto fail;
    }
    if (build(r, p, &p->dag->oracles[index], errors) < 0)
        goto fail;
    r->refine = walk;
    r->state = p->steps;
    r->oracle = p->dag->oracles[index].name;
    r->doc = p->dag->oracles[index].doc;
    r->release = "dag";
    r->prepare = prepare;
    for (i = 0; i < r->parameter_count; i++)
        if (r->parameters[i].integer) {
            int whole = (int)r->parameters[i].value;
            memcpy((char *)r->block + r->parameters[i].offset, &whole, sizeof whole);
        } else {
            memcpy((char *)r->block + r->parameters[i].offset, &r->parameters[i].value, sizeof(double));
        }
    prepare(r);
    return r;
fail:
    refiner_close(r);
    return NULL;
}
