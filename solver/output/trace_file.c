/* trace_file.c - see trace_file.h.
 *
 * What a condition may ask stands in the list of `numbers` below; besides, `decision` and every
 * node of the graph by its name, or node.NAME where a value is called so: the answer that it gave,
 * none where it was not asked.
 * SPDX-License-Identifier: MIT */
#include "output/trace_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "geometry.h"
#include "util/array.h"
#include "util/atomic_file.h"
#include "util/beside.h"
#include "util/decisions.h"
#include "util/ends_with.h"
#include "util/filter.h"
#include "util/report.h"

/* The most that a file takes: with it a disk is not filled by a slip, and 1e7 lines fit. */
#define TRACE_BYTES 2000000000u

struct trace_file {
    struct atomic_file file;
    FILE *out;
    int json;
    RadSolution solution;
    RadOracle oracle;
    const struct RadFace *faces;
    struct filter *filter; /* NULL: all */
    struct filter_name *names;
    struct filter_value *values;
    size_t name_count, name_capacity;
    char **texts; /* owned: "node.NAME" */
    size_t text_count, text_capacity;
    const char **words; /* of all nodes: their answers, each list ended by NULL */
    struct RadAnswer *way;
    int nodes;
    int first_node; /* in names: the nodes, each by name and as node.NAME */
    struct trace_count count;
    int failed; /* a write, or the library */
    char receiver[RAD_NAME], emitter[RAD_NAME];
};

/* Values that are numbers, in this order; then texts; then `decision`; then nodes. */
enum {
    PASS,
    ROUND,
    RAYS,
    NODES,
    DEPTH,
    DISTANCE,
    FORM_FACTOR,
    VISIBILITY,
    OF_RECEIVER, /* so many of each of the two */
    FACE = 0,
    SPLITS,
    CLUSTER,
    AREA,
    RADIOSITY,
    PER_ELEMENT,
    OF_EMITTER = OF_RECEIVER + PER_ELEMENT,
    NUMBERS = OF_EMITTER + PER_ELEMENT,
    RECEIVER = NUMBERS,
    EMITTER,
    DECISION,
    FIXED_NAMES
};
static const char *const numbers[NUMBERS] = {"pass",
                                             "round",
                                             "rays",
                                             "nodes",
                                             "depth",
                                             "distance",
                                             "form_factor",
                                             "visibility",
                                             "receiver.face",
                                             "receiver.depth",
                                             "receiver.cluster",
                                             "receiver.area",
                                             "receiver.radiosity",
                                             "emitter.face",
                                             "emitter.depth",
                                             "emitter.cluster",
                                             "emitter.area",
                                             "emitter.radiosity"};

/* ---- names */

static int add_name(struct trace_file *t, const char *name, enum filter_type type,
                    const char *const *words)
{
    if (array_reserve(&t->names, t->name_count + 1, &t->name_capacity, sizeof *t->names) < 0)
        return -1;
    t->names[t->name_count++] = (struct filter_name){name, type, words};
    return 0;
}

static int add_node(struct trace_file *t, const char *name, const char *const *words)
{
    size_t size = strlen(name) + sizeof "node.";
    if (array_reserve(&t->texts, t->text_count + 1, &t->text_capacity, sizeof *t->texts) < 0
        || !(t->texts[t->text_count] = malloc(size)))
        return -1;
    snprintf(t->texts[t->text_count], size, "node.%s", name);
    return add_name(t, name, FILTER_WORD, words) < 0
                   || add_name(t, t->texts[t->text_count++], FILTER_WORD, words) < 0
               ? -1
               : 0;
}

/* Returns 0, or -1 when out of memory. */
static int list_names(struct trace_file *t)
{
    struct RadAnswer a;
    size_t words = 0, at = 0;
    for (int i = 0; i < NUMBERS; i++)
        if (add_name(t, numbers[i], FILTER_NUMBER, NULL) < 0)
            return -1;
    if (add_name(t, "receiver", FILTER_TEXT, NULL) < 0
        || add_name(t, "emitter", FILTER_TEXT, NULL) < 0
        || add_name(t, "decision", FILTER_WORD, decision_names) < 0)
        return -1;
    t->first_node = (int)t->name_count;
    for (; radGetOracleAnswer(t->oracle, t->nodes, 0, &a) == 0; t->nodes++)
        for (int k = 0; radGetOracleAnswer(t->oracle, t->nodes, k, &a) == 0; k++)
            words++;
    t->words = malloc((words + (size_t)t->nodes + 1) * sizeof *t->words);
    t->way = malloc(((size_t)t->nodes + 1) * sizeof *t->way);
    if (!t->words || !t->way)
        return -1;
    for (int i = 0; i < t->nodes; i++) {
        const char **first = &t->words[at];
        for (int k = 0; radGetOracleAnswer(t->oracle, i, k, &a) == 0; k++)
            t->words[at++] = a.answer;
        t->words[at++] = NULL;
        (void)radGetOracleAnswer(t->oracle, i, 0, &a);
        if (add_node(t, a.node, first) < 0)
            return -1;
    }
    t->values = calloc(t->name_count, sizeof *t->values);
    return t->values ? 0 : -1;
}

/* ---- one discussion */

static void set_element(const struct trace_file *t, int at, const struct element *e)
{
    struct filter_value *v = &t->values[at];
    v[FACE].number = e->vertices && !e->group ? (double)t->faces[e->face].input : -1;
    v[SPLITS].number = e->depth;
    v[CLUSTER].number = e->vertices == 0;
    v[AREA].number = e->area;
    v[RADIOSITY].number = e->radiosity;
}

static void set_values(struct trace_file *t, const struct RadTraced *d, int steps)
{
    const struct element *r = d->before->receiver, *s = d->before->emitter;
    struct filter_value *v = t->values;
    double between[3];
    sub3(between, s->centre, r->centre);
    v[PASS].number = d->pass;
    v[ROUND].number = (double)d->round;
    v[RAYS].number = d->rays;
    v[NODES].number = steps;
    v[DEPTH].number = r->depth > s->depth ? r->depth : s->depth;
    v[DISTANCE].number = length3(between);
    v[FORM_FACTOR].number = d->form_factor_level ? d->form_factor : (double)NAN;
    v[VISIBILITY].number = d->visibility_level ? d->visibility : (double)NAN;
    set_element(t, OF_RECEIVER, r);
    set_element(t, OF_EMITTER, s);
    v[RECEIVER].text = t->receiver;
    v[EMITTER].text = t->emitter;
    v[DECISION].number = d->decision;
    for (int i = 0; i < 2 * t->nodes; i++)
        v[t->first_node + i].number = -1;
    for (int i = 0; i < steps; i++)
        for (int k = 0; k < 2; k++)
            v[t->first_node + 2 * t->way[i].node_number + k].number = t->way[i].answer_number;
}

static int print_number(FILE *out, int json, int known, double value)
{
    return known ? fprintf(out, "%.9g", value) : json ? fprintf(out, "null") : 0;
}

/* Names are of letters, digits and ./_, so that nothing need be quoted. Returns its length. */
static int print_line(const struct trace_file *t, const struct RadTraced *d, int steps)
{
    FILE *out = t->out;
    int length = fprintf(out,
                         t->json ? "{\"pass\": %d, \"round\": %llu, \"receiver\": \"%s\", "
                                   "\"emitter\": \"%s\", \"decision\": \"%s\", \"rays\": %u, "
                                   "\"form_factor\": "
                                 : "%d,%llu,%s,%s,%s,%u,",
                         d->pass, (unsigned long long)d->round, t->receiver, t->emitter,
                         decision_names[d->decision], (unsigned)d->rays);
    length += print_number(out, t->json, d->form_factor_level, d->form_factor);
    length += fprintf(out, t->json ? ", \"visibility\": " : ",");
    length += print_number(out, t->json, d->visibility_level, d->visibility);
    length += fprintf(out, t->json ? ", \"way\": [" : ",");
    for (int i = 0; i < steps; i++)
        length += fprintf(out, t->json ? "%s[\"%s\", \"%s\"]" : "%s%s:%s",
                          i == 0    ? ""
                          : t->json ? ", "
                                    : " ",
                          t->way[i].node, t->way[i].answer);
    return length + fprintf(out, t->json ? "]}\n" : "\n");
}

static int note(void *user, const struct RadTraced *d)
{
    struct trace_file *t = user;
    const int steps = radGetOracleWay(t->oracle, d->way, t->way, t->nodes);
    t->count.held++;
    if (steps < 0 || radGetElementName(t->solution, d->receiver, t->receiver) < 0
        || radGetElementName(t->solution, d->emitter, t->emitter) < 0)
        return t->failed = 1;
    if (t->filter) {
        set_values(t, d, steps);
        if (!filter_holds(t->filter, t->values))
            return 0;
    }
    t->count.matched++;
    if (t->count.bytes > TRACE_BYTES)
        return 0;
    const int length = print_line(t, d, steps);
    t->count.bytes += length > 0 ? (uint64_t)length : 0;
    t->count.written++;
    return t->failed = ferror(t->out) != 0;
}

/* ---- the file */

static void release(struct trace_file *t)
{
    filter_free(t->filter);
    for (size_t i = 0; i < t->text_count; i++)
        free(t->texts[i]);
    free(t->texts);
    free(t->names);
    free(t->values);
    free(t->words);
    free(t->way);
    free(t);
}

int trace_file_open(struct trace_file **trace, const char *path, const char *where, RadScene scene,
                    RadSolution solution, RadOracle oracle)
{
    struct trace_file *t = calloc(1, sizeof *t);
    *trace = NULL;
    if (!t) {
        report_error(path, 0, "out of memory for a trace");
        return 1;
    }
    *t = (struct trace_file){.json = ends_with(path, ".jsonl"),
                             .faces = radGetSceneFaces(scene),
                             .solution = solution,
                             .oracle = oracle};
    if (list_names(t) < 0) {
        report_error(path, 0, "out of memory for a trace");
        release(t);
        return 1;
    }
    char cause[1024];
    if (where && !(t->filter = filter_read(where, t->names, t->name_count, cause, sizeof cause))) {
        report_error("--where", 0, "%s", cause);
        release(t);
        return 2;
    }
    if (path_is_stdout(path)) {
        t->out = stdout;
    } else if (atomic_open(&t->file, path) < 0) {
        release(t);
        return 1;
    } else {
        t->out = t->file.stream;
    }
    if (!t->json)
        t->count.bytes += (uint64_t)fprintf(
            t->out, "pass,round,receiver,emitter,decision,rays,form_factor,visibility,way\n");
    if (radTraceSolution(solution, note, t) < 0) {
        trace_file_discard(t);
        return -1;
    }
    *trace = t;
    return 0;
}

int trace_file_close(struct trace_file *t, struct trace_count *count)
{
    int status = 0;
    *count = t->count;
    if (t->out != stdout)
        status = atomic_commit(&t->file);
    release(t);
    return status;
}

void trace_file_discard(struct trace_file *t)
{
    if (!t)
        return;
    atomic_discard(&t->file);
    release(t);
}
