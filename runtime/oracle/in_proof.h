/* in_proof.h - the half of a proof that is compiled along with the oracles: their releases as a
 * program has them, by the runtime's own refiner.c and interpreter.c.
 *
 * dagc carries this text and never compiles it itself. In place of loading, the interpreter gets
 * the graph that dagc has; its steps are wrapped, so that a tool knows which of them asks.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>

#include "oracle/load_graph.h"
#include "oracle/program.h"
#include "prove/proof.h"

extern const struct prove_compiled prove_compiled[];
extern const struct extern_entry prove_externs[]; /* [prove_extern_count] */
extern const int prove_extern_count;

int prove_site, prove_outer, prove_untrue;

static struct prove_host host;
static int opened;
static struct refiner *releases[PROVE_RELEASES];

/* ---- what the interpreter finds in place of dagc's library */

struct dag *load_graph(const char *path, const struct dag_options *options, const char *name,
                       int *index, struct messages *messages)
{
    (void)path, (void)options, (void)name, (void)messages;
    *index = opened;
    return host.dag;
}

void dag_free(struct dag *dag)
{
    (void)dag; /* it is dagc's */
}

int dag_is_fixed(const struct dag *dag, int expression)
{
    return host.is_fixed(dag, expression);
}

int dag_reads_fact(const struct dag *dag, const struct oracle_graph *oracle, int fact)
{
    return host.reads_fact(dag, oracle, fact);
}

const struct node *dag_node_at(const struct dag *dag, const struct oracle_graph *oracle, int place)
{
    return host.node_at(dag, oracle, place);
}

int dag_is_doubtful(const struct dag *dag, const struct argument *argument)
{
    return host.is_doubtful(dag, argument);
}

struct dag_doubt dag_doubt(struct dag *dag, const struct node *node,
                           const struct argument *argument)
{
    return host.doubt(dag, node, argument);
}

char *dag_json(struct dag *dag)
{
    (void)dag;
    return NULL;
}

/* ---- steps that say where they are */

struct prove_step {
    double unused; /* so that a pointer to double may point here */
    int (*call)(struct discussion *d, const double *arguments);
    const double *arguments;
    int site;
};
static struct prove_step *steps;

static int call_step(struct discussion *d, const double *arguments)
{
    const struct prove_step *step = (const struct prove_step *)(const void *)arguments;
    prove_site = step->site;
    return step->call(d, step->arguments);
}

static int wrap_steps(struct program *p)
{
    steps = calloc((size_t)p->graph->order.count, sizeof *steps);
    if (!steps)
        return -1;
    for (int i = 0; i < p->graph->order.count; i++) {
        steps[i] = (struct prove_step){0, p->steps[i].call, p->steps[i].arguments, i};
        p->steps[i].call = call_step;
        p->steps[i].arguments = &steps[i].unused;
    }
    return 0;
}

/* ---- the library's functions */

static void prove_close(void)
{
    for (int i = 0; i < PROVE_RELEASES; i++) {
        refiner_close(releases[i]);
        releases[i] = NULL;
    }
    free(steps);
    steps = NULL;
}

static const char *prove_open(const struct prove_host *h, int oracle)
{
    static char said[500];
    struct messages messages = {0};
    host = *h;
    opened = oracle;
    if (prove_compiled[oracle].oracle->abi != RUNTIME_ABI)
        return "the compiled oracle says another RUNTIME_ABI than the catalog";
    releases[PROVE_FLAT] = refiner_compiled(prove_compiled[oracle].oracle, "flat");
    if (!releases[PROVE_FLAT])
        return "out of memory";
    releases[PROVE_DAG] = refiner_interpret(
        &(struct interpretation){
            .path = "-", .externs = prove_externs, .extern_count = prove_extern_count},
        &messages);
    said[0] = '\0';
    if (!releases[PROVE_DAG])
        strncat(said, messages_text(&messages), sizeof said - 1);
    else if (wrap_steps(releases[PROVE_DAG]->own) < 0)
        strcat(said, "out of memory");
    messages_free(&messages);
    if (!*said)
        return NULL;
    prove_close();
    return said;
}

static void prove_describe(enum prove_release release, struct prove_description *out)
{
    const struct refiner *r = releases[release];
    const struct prove_compiled *c = &prove_compiled[opened];
    *out = (struct prove_description){.name = r->oracle,
                                      .doc = r->doc,
                                      .fingerprint = r->fingerprint,
                                      .parameters = r->parameter_count,
                                      .reads = r->read_count,
                                      .read = r->reads,
                                      .size = c->oracle->parameters_size,
                                      .block = c->size};
}

static void prove_parameter(enum prove_release release, int number, struct prove_parameter *out)
{
    const struct oracle_parameter *p = &releases[release]->parameters[number];
    int flat = release == PROVE_FLAT;
    *out = (struct prove_parameter){.name = p->name,
                                    .unit = p->unit,
                                    .doc = p->doc,
                                    .value = p->value,
                                    .low = p->low,
                                    .high = p->high,
                                    .given = refiner_get(releases[release], number),
                                    .offset = p->offset,
                                    .field = flat ? prove_compiled[opened].fields[number] : 0,
                                    .end = flat ? prove_compiled[opened].ends[number] : 0,
                                    .integer = p->integer,
                                    .role = p->role,
                                    .fixed = p->fixed};
}

static int prove_set(enum prove_release release, int number, double value, double *then)
{
    struct refiner *r = releases[release];
    int status = refiner_set(r, r->parameters[number].name, value, NULL);
    *then = refiner_get(r, number);
    return status;
}

static void prove_write(int number, double value)
{
    for (int i = 0; i < PROVE_RELEASES; i++) {
        const struct oracle_parameter *p = &releases[i]->parameters[number];
        int whole = (int)value;
        if (p->integer)
            memcpy((char *)releases[i]->block + p->offset, &whole, sizeof whole);
        else
            memcpy((char *)releases[i]->block + p->offset, &value, sizeof value);
    }
}

static void prove_written(void)
{
    for (int i = 0; i < PROVE_RELEASES; i++)
        if (releases[i]->prepare)
            releases[i]->prepare(releases[i]);
}

static int prove_run(enum prove_flavour flavour, struct prove_record *record)
{
    struct discussion d;
    struct refiner *r = releases[flavour == PROVE_INTERPRETED ? PROVE_DAG : PROVE_FLAT];
    memset(&d, 0, sizeof d);
    d.record = record;
    prove_site = prove_outer = prove_untrue = 0;
    prove_begin(&d, flavour != PROVE_INTERPRETED);
    int decision = flavour == PROVE_PLAIN || flavour == PROVE_INTERPRETED
                       ? (int)r->refine(r->state, &d)
                       : prove_compiled[opened].watched((int)flavour, r->block, &d);
    prove_end(&d);
    record->no_number = d.terms.no_number;
    record->untrue = prove_untrue;
    return decision;
}

const struct prove_library prove_library = {prove_open,      prove_close, prove_describe,
                                            prove_parameter, prove_set,   prove_write,
                                            prove_written,   prove_run};
