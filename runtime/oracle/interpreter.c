/* interpreter.c - the DAG release: the graph itself, walked node by node.
 *
 * A node becomes a step: the tool's function, the values of its arguments, and a map from answers
 * to steps or decisions. Steps stand in topological order, so every arc leads forward and the walk
 * ends.
 * [Turbet & Sillion, section 4 and figure 3]
 *
 * What the tools are given is worked out in arguments.c, what a counting walk counts in
 * counting.c.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "oracle/load_graph.h"
#include "oracle/program.h"
#include "oracle/tool_table.h"

enum decision program_walk(const void *state, struct discussion *d)
{
    const struct step *steps = state, *step = steps;
    for (;;) {
        int next = step->next[step->call(d, step->arguments)];
        if (next < 0)
            return (enum decision) ~next;
        step = &steps[next];
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
    free(p->doubts);
    free(p->externs);
    free(p->reads);
    free(p->ways);
    if (p->forget)
        p->forget(p);
    free(p->graph_json);
    free(p);
}

static const struct tool_entry *find_tool(const char *name)
{
    for (int i = 0; i < tool_table_count; i++)
        if (strcmp(tool_table[i].name, name) == 0)
            return &tool_table[i];
    return NULL;
}

/* Room for all that build() fills in. Returns 0 or -1. */
static int reserve(struct refiner *r, struct program *p, const struct oracle_graph *g)
{
    for (int i = 0; i < g->order.count; i++) {
        const struct node *n = dag_node_at(p->dag, g, i);
        p->argument_count += n->arguments.count;
        p->answer_count += n->arcs.count;
    }
    p->steps = calloc((size_t)g->order.count, sizeof *p->steps);
    p->arguments = calloc((size_t)p->argument_count + 1, sizeof *p->arguments);
    p->expressions = calloc((size_t)p->argument_count + 1, sizeof *p->expressions);
    p->next = calloc((size_t)p->answer_count + 1, sizeof *p->next);
    p->parameters = calloc((size_t)g->parameters.count + 1, sizeof *p->parameters);
    p->reads = calloc((size_t)p->dag->fact_count + 1, sizeof *p->reads);
    r->block = calloc((size_t)g->parameters.count + 1, sizeof(double));
    return !p->steps || !p->arguments || !p->expressions || !p->next || !p->parameters || !p->reads
                   || !r->block
               ? -1
               : 0;
}

static void build_parameters(struct program *p, const struct oracle_graph *g)
{
    for (int i = 0; i < g->parameters.count; i++) {
        const struct parameter *q = &p->dag->parameters[g->parameters.first + i];
        p->parameters[i] = (struct oracle_parameter){
            .name = q->name,
            .unit = p->dag->types[q->type].unit_text,
            .doc = q->doc,
            .value = q->value,
            .low = q->low,
            .high = q->high,
            .integer = p->dag->types[q->type].base == BASE_INTEGER,
            .offset = (size_t)i * sizeof(double),
            .role = q->role + 1, /* none: 0 */
            .fixed = q->fixed,
        };
    }
}

/* Steps in the graph's topological order; every span of the dag has been checked by dagc. */
static int build(struct refiner *r, struct program *p, const struct oracle_graph *g,
                 struct messages *messages)
{
    const struct dag *dag = p->dag;
    int arguments = 0, answers = 0;
    p->first_parameter = g->parameters.first;
    p->graph = g;
    if (reserve(r, p, g) < 0)
        return messages_say(messages, MESSAGE_MEMORY, "out of memory");
    build_parameters(p, g);
    r->parameters = p->parameters;
    r->parameter_count = g->parameters.count;
    for (int i = 0; i < dag->fact_count; i++)
        if (dag_reads_fact(dag, g, i))
            p->reads[p->read_count++] = i;
    for (int i = 0; i < g->order.count; i++) {
        const struct node *n = dag_node_at(dag, g, i);
        const struct tool_entry *tool = find_tool(dag->tools[n->tool].name);
        if (!tool || tool->argument_count != n->arguments.count
            || tool->answer_count != n->arcs.count) {
            return messages_say(messages, MESSAGE_ARGUMENT,
                                "oracle %s: this program was built without the tool '%s'; "
                                "use the flat release",
                                g->name, dag->tools[n->tool].name);
        }
        p->steps[i].call = tool->call;
        p->steps[i].keeps = dag->tools[n->tool].keeps;
        p->steps[i].arguments = &p->arguments[arguments];
        p->steps[i].next = &p->next[answers];
        for (int k = 0; k < n->arguments.count; k++)
            p->expressions[arguments++] = dag->arguments[n->arguments.first + k].expression;
        for (int k = 0; k < n->arcs.count; k++) {
            const struct target *t = &dag->arcs[n->arcs.first + k].target;
            p->next[answers++] =
                t->kind == TARGET_DECISION ? ~t->index : dag->nodes[t->index].order;
        }
    }
    return program_link(p, g, messages);
}

static int find_externs(struct program *p, const struct interpretation *how)
{
    p->externs = calloc((size_t)p->dag->callback_count + 1, sizeof *p->externs);
    if (!p->externs)
        return -1;
    for (int i = 0; i < p->dag->callback_count; i++) {
        const char *name = p->dag->callbacks[i].name;
        for (int k = 0; k < how->extern_count; k++)
            if (strcmp(how->externs[k].name, name) == 0)
                p->externs[i].fact = how->externs[k].call;
        if (!p->externs[i].fact && how->find_extern)
            p->externs[i].fact = how->find_extern(how->find_where, name);
    }
    return 0;
}

struct refiner *refiner_interpreted(const char *path, const char *text, const char *name,
                                    struct messages *messages)
{
    struct interpretation how = {0};
    how.path = path;
    how.text = text;
    how.oracle = name;
    return refiner_interpret(&how, messages);
}

struct refiner *refiner_interpret(const struct interpretation *how, struct messages *messages)
{
    struct dag_options options = {0};
    struct refiner *r = calloc(1, sizeof *r);
    struct program *p = calloc(1, sizeof *p);
    if (!r || !p) {
        (void)messages_say(messages, MESSAGE_MEMORY, "out of memory");
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
    options.replacements = how->replacements;
    options.replacement_count = how->replacement_count;
    int index;
    p->dag = load_graph(how->path, &options, how->oracle, &index, messages);
    if (!p->dag)
        goto fail;
    if (find_externs(p, how) < 0) {
        (void)messages_say(messages, MESSAGE_MEMORY, "out of memory");
        goto fail;
    }
    if (build(r, p, &p->dag->oracles[index], messages) < 0)
        goto fail;
    r->refine = program_walk;
    r->state = p->steps;
    r->oracle = p->dag->oracles[index].name;
    r->doc = p->dag->oracles[index].doc;
    dag_fingerprint_text(&p->dag->oracles[index], p->fingerprint);
    r->fingerprint = p->fingerprint;
    r->release = "dag";
    r->reads = p->reads;
    r->read_count = p->read_count;
    r->prepare = program_prepare;
    for (int i = 0; i < r->parameter_count; i++)
        if (r->parameters[i].integer) {
            int whole = (int)r->parameters[i].value;
            memcpy((char *)r->block + r->parameters[i].offset, &whole, sizeof whole);
        } else {
            memcpy((char *)r->block + r->parameters[i].offset, &r->parameters[i].value,
                   sizeof(double));
        }
    program_prepare(r);
    return r;
fail:
    refiner_close(r);
    return NULL;
}

const char *refiner_graph(const struct refiner *r, struct messages *messages)
{
    struct program *p = r->own;
    if (strcmp(r->release, "dag") != 0) {
        (void)messages_say(messages, MESSAGE_ARGUMENT,
                           "only interpreted oracles keep their graph; make oracle %s with "
                           "RAD_RELEASE_DAG",
                           r->oracle);
        return NULL;
    }
    if (!p->graph_json && !(p->graph_json = dag_json(p->dag)))
        (void)messages_say(messages, MESSAGE_MEMORY, "out of memory");
    return p->graph_json;
}
