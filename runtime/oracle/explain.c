/* explain.c - see explain.h.
 *
 * The walk of interpreter.c, with a look at the data manager before and behind each node: what the
 * catalog says that the node reads and writes, and whatever else has changed. A discussion ends the
 * same each time, so it is held REPEATS times and the shortest time of each node is told: what it
 * costs once its code and data are at hand.
 * [Turbet & Sillion, section 4.3: execution track, debugging]
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "oracle/counted_host.h"
#include "oracle/explain.h"
#include "oracle/follow.h"
#include "oracle/program.h"
#include "oracle/tool_table.h"
#include "util/clock.h"

enum { REPEATS = 5 };

void explain_free(struct explanation *x)
{
    free(x->asked);
    free(x->arguments);
    free(x->terms);
    memset(x, 0, sizeof *x);
}

/* Term i of the catalog, as the data manager has it. */
static struct RadTerm read_term(const struct dag *dag, int i, const struct terms *terms)
{
    const struct term *t = &dag->terms[i];
    const struct type *type = &dag->types[t->type];
    const char *at = (const char *)terms;
    struct RadTerm out = {.name = t->name,
                          .doc = t->doc,
                          .unit = type->unit_text,
                          .level_number = *(const unsigned char *)(at + term_table[i].level),
                          .level_count = t->levels.count,
                          .size = type->length};
    if (out.level_number)
        out.level = t->levels.count ? dag->levels[t->levels.first + out.level_number - 1].name : "";
    for (int k = 0; k < type->length && k < 3; k++)
        if (type->base == BASE_INTEGER) {
            int whole;
            memcpy(&whole, at + term_table[i].value, sizeof whole);
            out.value[k] = whole;
        } else {
            memcpy(&out.value[k], at + term_table[i].value + (size_t)k * sizeof(double),
                   sizeof(double));
        }
    return out;
}

static int needs(const struct dag *dag, struct span span, int term)
{
    for (int i = span.first; i < span.first + span.count; i++)
        if (dag->needs[i].term == term)
            return 1;
    return 0;
}

static int same(const struct RadTerm *a, const struct RadTerm *b)
{
    return a->level_number == b->level_number && memcmp(a->value, b->value, sizeof a->value) == 0;
}

/* The terms that node n has to do with. Returns how many. */
static int note_terms(struct RadTerm *out, const struct dag *dag, const struct node *n,
                      const struct terms *before, const struct terms *after)
{
    const struct tool *tool = &dag->tools[n->tool];
    int count = 0;
    for (int i = 0; i < dag->term_count; i++) {
        const struct RadTerm old = read_term(dag, i, before);
        struct RadTerm now = read_term(dag, i, after);
        now.reads = needs(dag, tool->reads, i) || needs(dag, n->reads, i);
        now.writes = needs(dag, tool->writes, i);
        now.changed = !same(&old, &now);
        now.level_before = old.level_number;
        if (now.reads || now.writes || now.changed)
            out[count++] = now;
    }
    return count;
}

/* The values that the step's tool is given. Returns its own call. */
static int (*evaluate(const struct step *step, struct discussion *d, double *values,
                      int count))(struct discussion *, const double *)
{
    if (step->call == program_compute) {
        const struct computed *c = (const struct computed *)(const void *)step->arguments;
        program_evaluate(d, c, values);
        return c->call;
    }
    if (count > 0)
        memcpy(values, step->arguments, (size_t)count * sizeof *values);
    return step->call;
}

/* Of an argument that may have any: what the catalog calls the unit that it has here. */
static const char *unit_of(const struct dag *dag, const struct argument *a, const struct type *type)
{
    if (!type->any_unit)
        return type->unit_text;
    for (int i = 0; i < dag->type_count; i++)
        if (!dag->types[i].any_unit
            && dag_same_unit(&dag->types[i].unit, &dag->expressions[a->expression].unit))
            return dag->types[i].unit_text;
    return "";
}

static void note_arguments(struct RadArgument *out, const struct dag *dag, const struct node *n,
                           const double *values)
{
    for (int k = 0; k < n->arguments.count; k++) {
        const struct argument *a = &dag->arguments[n->arguments.first + k];
        const struct parameter *q = &dag->parameters[a->parameter];
        out[k] = (struct RadArgument){.name = q->name,
                                      .unit = unit_of(dag, a, &dag->types[q->type]),
                                      .doc = q->doc,
                                      .value = values[k],
                                      .computed = !dag_is_fixed(dag, a->expression)};
    }
}

/* What it came to, with its terms from `term` on. */
static void note_end(struct explanation *x, const struct dag *dag, int term,
                     const struct terms *terms)
{
    x->shown.decision_name = dag->decisions[x->shown.decision].name;
    x->shown.decision_doc = dag->decisions[x->shown.decision].doc;
    x->shown.terms = &x->terms[term];
    for (int i = 0; i < dag->term_count; i++) {
        const struct RadTerm t = read_term(dag, i, terms);
        if (t.level_number)
            x->terms[term + x->shown.term_count++] = t;
    }
}

/* Hold it once more. `first`: everything is noted, later only shorter times are. */
static void repeat(struct explanation *x, const struct program *p, const struct discussion *before,
                   const struct host *real, int first)
{
    const struct dag *dag = p->dag;
    struct discussion d = *before;
    struct blockers list;
    struct counted_host host;
    int argument = 0, term = 0, count = 0;
    counted_host_make(&host, before->host, real);
    d.host = &host.host;
    if (before->blockers) {
        list = *before->blockers;
        d.blockers = &list;
    }
    for (int step = 0; step >= 0; count++) {
        const struct node *n = dag_node_at(dag, p->graph, step);
        const struct terms old = d.terms;
        const uint64_t rays = host.rays;
        double values[STACK_MAX];
        const double start = seconds();
        int (*call)(struct discussion *, const double *) =
            evaluate(&p->steps[step], &d, values, n->arguments.count);
        const int answer = call(&d, values), next = p->steps[step].next[answer];
        const double taken = seconds() - start;
        struct RadAsked *a = &x->asked[count];
        if (first) {
            const struct RadAnswer said = follow_said(p, step, answer);
            *a = (struct RadAsked){.node = said.node,
                                   .tool = said.tool,
                                   .doc = said.doc,
                                   .answer = said.answer,
                                   .kind = said.kind,
                                   .target = said.target,
                                   .arguments = &x->arguments[argument],
                                   .argument_count = n->arguments.count,
                                   .terms = &x->terms[term],
                                   .rays = host.rays - rays,
                                   .seconds = taken};
            note_arguments(&x->arguments[argument], dag, n, values);
            a->term_count = note_terms(&x->terms[term], dag, n, &old, &d.terms);
            argument += n->arguments.count;
            term += a->term_count;
            x->shown.way += p->ways[&p->steps[step].next[answer] - p->next];
        } else if (taken < a->seconds) {
            a->seconds = taken;
        }
        step = next;
        x->shown.decision = (enum decision) ~next;
    }
    x->shown.asked_count = count;
    x->shown.rays = host.rays;
    if (first)
        note_end(x, dag, term, &d.terms);
}

int explain(struct explanation *x, const struct refiner *r, const struct discussion *before,
            const struct host *real)
{
    const struct program *p = r->own;
    const size_t steps = (size_t)p->graph->order.count, terms = (size_t)p->dag->term_count;
    explain_free(x);
    x->asked = malloc(steps * sizeof *x->asked);
    x->arguments = malloc(((size_t)p->argument_count + 1) * sizeof *x->arguments);
    x->terms = malloc((steps + 1) * (terms + 1) * sizeof *x->terms);
    if (!x->asked || !x->arguments || !x->terms) {
        explain_free(x);
        return -1;
    }
    x->shown.asked = x->asked;
    for (int i = 0; i < REPEATS; i++)
        repeat(x, p, before, real, i == 0);
    for (int i = 0; i < x->shown.asked_count; i++)
        x->shown.seconds += x->asked[i].seconds;
    return 0;
}
