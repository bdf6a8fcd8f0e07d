/* walk.c - one path: the graph itself, as dag.h has it, and a release beside it.
 *
 * Both note the same events: each call of a tool with its arguments, each term or extern that the
 * arguments read, in order, and what is known of every term then. All of it must agree, and the
 * decision, and at the end the terms that this decision reads.
 *
 * Parameters, facts, externs and terms have values of their own, so that none can stand for
 * another; and others, since large values may hide behind a minimum or a maximum, and an argument
 * is no number, as 0 / 0, at the ends of ranges.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "prove/proving.h"

const struct node *prove_node_at(const struct proof *proof, int place)
{
    return dag_node_at(proof->dag, proof->oracle, place);
}

/* By a fixed seed: 0 .. count - 1. */
static int pick(struct proof *proof, int count)
{
    proof->random = proof->random * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (int)((proof->random >> 33) % (uint64_t)count);
}

/* ---- values */

/* Somewhere in a range, `share` of the way up: of an endless one, at any order of magnitude, so
 * that each of several numbers is the largest now and then. */
static double within(double low, double high, double share, int whole)
{
    double far = pow(10, 6 * share - 3);
    double value = isinf(low) && isinf(high) ? far - 1
                   : isinf(high)             ? low + far
                   : isinf(low)              ? high - far
                                             : low + (high - low) * share;
    if (!whole)
        return value;
    value = floor(value);
    return value < low ? ceil(low) : value;
}

static double choose(struct proof *proof, int way, double low, double high, int whole, double apart)
{
    double share = way == 1 ? 0.5 : (1 + pick(proof, 1000)) / 1001.0;
    double end = way == PROVE_LOW || (way == PROVE_ENDS && share < 0.5) ? low : high;
    if (way == 0)
        return apart;
    return way >= PROVE_LOW && way <= PROVE_ENDS && (!whole || isfinite(end))
               ? end
               : within(low, high, share, whole);
}

void prove_choose_values(struct proof *proof, int way)
{
    enum { LEVEL_UNIT = 100000, TERM_UNIT = 100 }; /* above all else, and far apart */
    struct dag *dag = proof->dag;
    for (int i = 0; i < proof->oracle->parameters.count; i++) {
        const struct parameter *p = &dag->parameters[proof->oracle->parameters.first + i];
        int whole = dag->types[p->type].base == BASE_INTEGER;
        proof->values[i] =
            way == 1 ? p->value
                     : choose(proof, way, p->low, p->high, whole, whole ? 1000 + i : 0.3 + 1.7 * i);
        proof->library->write(i, proof->values[i]);
    }
    proof->library->written();
    for (int i = 0; i < dag->fact_count; i++) {
        const struct fact *fact = &dag->facts[i];
        int whole = dag->types[fact->type].base == BASE_INTEGER;
        proof->facts[i] =
            choose(proof, way, fact->low, fact->high, whole, whole ? 3 + i : 0.7 + 1.3 * i);
    }
    for (int i = 0; i < dag->callback_count; i++) {
        const struct callback *c = &dag->callbacks[i];
        int whole = dag->types[c->type].base == BASE_INTEGER;
        proof->facts[dag->fact_count + i] =
            choose(proof, way, c->low, c->high, whole, whole ? 50 + i : 0.2 + 1.1 * i);
    }
    for (int i = 0; i < dag->term_count; i++) {
        const struct term *term = &dag->terms[i];
        int whole = dag->types[term->type].base == BASE_INTEGER;
        int levels = term->levels.count > 0 ? term->levels.count : 1;
        for (int level = 1; level <= levels; level++)
            proof->known[i * PROVE_LEVELS + level] = choose(
                proof, way, term->low, term->high, whole, LEVEL_UNIT * level + TERM_UNIT * (i + 1));
    }
}

/* ---- the graph itself */

/* Notes an event; its arguments, all zero. */
static double *note(const struct proof *proof, struct prove_record *r, int what)
{
    size_t at = (size_t)r->events++, terms = (size_t)proof->dag->term_count;
    double *arguments = r->arguments + at * (size_t)proof->width;
    r->what[at] = what;
    memset(arguments, 0, (size_t)proof->width * sizeof *arguments);
    memcpy(r->levels + at * terms, r->end, terms);
    return arguments;
}

static double read_term(const struct proof *proof, struct prove_record *r, int term, int level)
{
    *note(proof, r, ~term) = level;
    if (r->end[term] < level)
        r->end[term] = (unsigned char)level;
    return proof->known[term * PROVE_LEVELS + r->end[term]];
}

static double call_extern(const struct proof *proof, struct prove_record *r, int number)
{
    const struct dag *dag = proof->dag;
    struct span reads = dag->callbacks[number].reads;
    double result = proof->facts[dag->fact_count + number];
    for (int i = reads.first; i < reads.first + reads.count; i++)
        (void)read_term(proof, r, dag->needs[i].term, dag->needs[i].level);
    (void)note(proof, r, ~(dag->term_count + number));
    for (int i = reads.first; i < reads.first + reads.count; i++) {
        int term = dag->needs[i].term;
        result += proof->known[term * PROVE_LEVELS + r->end[term]];
    }
    return result;
}

/* The value of an expression. Kinds that are added to the language come in here. */
static double value_of(const struct proof *proof, struct prove_record *r, int expression)
{
    const struct expression *e = &proof->dag->expressions[expression];
    double a = e->left >= 0 ? value_of(proof, r, e->left) : 0;
    double b = e->right >= 0 ? value_of(proof, r, e->right) : 0;
    switch (e->kind) {
    case EXPRESSION_NUMBER:
        return e->number;
    case EXPRESSION_PARAMETER:
        return proof->values[e->parameter - proof->oracle->parameters.first];
    case EXPRESSION_FACT:
        return proof->facts[e->index];
    case EXPRESSION_TERM:
        return read_term(proof, r, e->index, e->level);
    case EXPRESSION_EXTERN:
        return call_extern(proof, r, e->index);
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
    case EXPRESSION_NAME:
        break;
    }
    return NAN;
}

/* What the tool is given in place of an argument that is no number of its range. */
static double looked_at(const struct proof *proof, struct prove_record *r, const struct node *node,
                        const struct argument *argument, double value)
{
    if (!dag_is_doubtful(proof->dag, argument))
        return value;
    const struct dag_doubt doubt = dag_doubt(proof->dag, node, argument);
    if (value >= doubt.low && value <= doubt.high)
        return value;
    if (r->no_number == NULL)
        r->no_number = doubt.what;
    return doubt.instead;
}

static void call_tool(const struct proof *proof, const struct node *node, int answer,
                      struct prove_record *r)
{
    const struct dag *dag = proof->dag;
    const struct tool *tool = &dag->tools[node->tool];
    const struct argument *arguments = &dag->arguments[node->arguments.first];
    for (int i = 0; i < node->arguments.count; i++)
        proof->asked[i] = value_of(proof, r, arguments[i].expression);
    for (int i = 0; i < node->arguments.count; i++)
        proof->asked[i] = looked_at(proof, r, node, &arguments[i], proof->asked[i]);
    memcpy(note(proof, r, node->tool), proof->asked,
           (size_t)node->arguments.count * sizeof *proof->asked);
    int refuses = dag->answers[tool->answers.first + answer].refuses;
    for (int i = 0; i < tool->writes.count && !refuses; i++) {
        const struct need *need = &dag->needs[tool->writes.first + i];
        if (r->end[need->term] < need->level)
            r->end[need->term] = (unsigned char)need->level;
    }
    proof->told[r->calls] = r->no_number != NULL;
    proof->nodes[r->calls++] = node->order;
}

/* Along the script: the decision. */
static int walk(const struct proof *proof, struct prove_record *r)
{
    const struct node *node = prove_node_at(proof, 0);
    for (;;) {
        int answer = r->script[r->calls];
        call_tool(proof, node, answer, r);
        const struct target *target = &proof->dag->arcs[node->arcs.first + answer].target;
        if (target->kind == TARGET_DECISION)
            return target->index;
        node = &proof->dag->nodes[target->index];
    }
}

/* ---- what they differ in */

static const char *level_name(const struct dag *dag, int term, int level)
{
    struct span levels = dag->terms[term].levels;
    return level == 0 || level > levels.count ? level == 0 ? "absent" : "present"
                                              : dag->levels[levels.first + level - 1].name;
}

const char *prove_flavour_name(struct dag *dag, enum prove_flavour flavour)
{
    static const char *const suffixes[PROVE_FLAVOURS] = {"",        "_first", "_counted",
                                                         "_traced", "_wave",  ""};
    return flavour == PROVE_INTERPRETED
               ? "the interpreter"
               : dag_format(&dag->arena, "%s%s", dag->verb, suffixes[flavour]);
}

static void print_path(const struct proof *proof, enum prove_flavour flavour, int wanted, int got,
                       const char *what)
{
    struct dag *dag = proof->dag;
    const struct node *node = prove_node_at(proof, 0);
    const char *name = proof->oracle->name;
    if (flavour == PROVE_INTERPRETED)
        fprintf(proof->report, "%s: %s differs in %s on the path\n", name,
                prove_flavour_name(dag, flavour), what);
    else
        fprintf(proof->report, "%s: %s_%s differs in %s on the path\n", name, name,
                prove_flavour_name(dag, flavour), what);
    for (int i = 0; i < dag->term_count; i++)
        if (proof->start[i] > 0)
            fprintf(proof->report, "  (the discussion comes with %s: %s)\n", dag->terms[i].name,
                    level_name(dag, i, proof->start[i]));
    for (int i = 0; i < proof->wanted.calls; i++) {
        const struct arc *arc = &dag->arcs[node->arcs.first + proof->script[i]];
        const struct tool *tool = &dag->tools[node->tool];
        fprintf(proof->report, "  %s = %s: %s\n", node->name, tool->name,
                dag->answers[tool->answers.first + proof->script[i]].name);
        if (arc->target.kind == TARGET_NODE)
            node = &dag->nodes[arc->target.index];
    }
    fprintf(proof->report, "  the graph decides %s after %d calls, %s %s after %d\n",
            dag->decisions[wanted].name, proof->wanted.calls,
            flavour == PROVE_INTERPRETED ? "the interpreter" : "the function",
            got >= 0 && got < dag->decision_count ? dag->decisions[got].name : "nothing",
            proof->got.calls);
}

/* Is what the decision reads there at the end as the graph has it? */
static int same_terms(const struct proof *proof, const struct span *reads)
{
    const struct dag *dag = proof->dag;
    int first = 0; /* of the term's numbers */
    for (int term = 0; term < dag->term_count; term++) {
        int length = dag->types[dag->terms[term].type].length, level = proof->wanted.end[term];
        for (int i = reads->first; i < reads->first + reads->count; i++) {
            if (dag->needs[i].term != term)
                continue;
            if (proof->got.end[term] != level)
                return 0;
            for (int k = 0; k < length; k++)
                if (proof->got.terms[first + k] != proof->known[term * PROVE_LEVELS + level] + k)
                    return 0;
        }
        first += length;
    }
    return 1;
}

/* NULL: both agree; else what they differ in. */
static const char *difference(const struct proof *proof, enum prove_flavour flavour, int wanted,
                              int got)
{
    const struct prove_record *a = &proof->wanted, *b = &proof->got;
    size_t events = (size_t)a->events, width = (size_t)proof->width;
    if (a->events != b->events || a->calls != b->calls
        || memcmp(a->what, b->what, events * sizeof *a->what) != 0)
        return "the calls";
    for (size_t i = 0; i < events * width; i++) /* one kind of not-a-number is as good as another */
        if (memcmp(&a->arguments[i], &b->arguments[i], sizeof *a->arguments) != 0
            && !(isnan(a->arguments[i]) && isnan(b->arguments[i])))
            return "an argument";
    if (memcmp(a->levels, b->levels, events * (size_t)proof->dag->term_count) != 0)
        return "what is known when a tool is asked";
    if (wanted != got)
        return "the decision";
    if (!same_terms(proof, &proof->dag->decisions[wanted].reads))
        return "a term that the decision reads";
    if (a->no_number == NULL ? b->no_number != NULL
                             : b->no_number == NULL || strcmp(a->no_number, b->no_number) != 0)
        return "which argument is no number";
    if (b->untrue)
        return "what it takes for known";
    return (flavour == PROVE_COUNTED || flavour == PROVE_TRACED) && b->watched != b->calls
               ? "what was counted"
               : NULL;
}

int prove_try(struct proof *proof, enum prove_flavour flavour)
{
    struct prove_record *wanted = &proof->wanted, *got = &proof->got;
    wanted->calls = wanted->events = 0;
    wanted->no_number = NULL;
    got->calls = got->events = got->watched = 0;
    memcpy(wanted->end, proof->start, (size_t)proof->dag->term_count);
    int decision = walk(proof, wanted), found = proof->library->run(flavour, got);
    const char *what = difference(proof, flavour, decision, found);
    if (what == NULL)
        return 0;
    proof->different = 1;
    print_path(proof, flavour, decision, found, what);
    return 1;
}

/* ---- room */

static void open_record(struct proof *proof, struct prove_record *r, int room)
{
    struct arena *arena = &proof->dag->arena;
    size_t events = (size_t)room, terms = (size_t)proof->dag->term_count;
    *r = (struct prove_record){.script = proof->script,
                               .start = proof->start,
                               .known = proof->known,
                               .facts = proof->facts,
                               .room = room};
    r->what = dag_alloc(arena, events * sizeof *r->what);
    r->site = dag_alloc(arena, events * sizeof *r->site);
    r->arguments = dag_alloc(arena, events * (size_t)proof->width * sizeof *r->arguments);
    r->levels = dag_alloc(arena, events * terms + 1);
    r->terms = dag_alloc(arena, ((size_t)proof->term_values + 1) * sizeof *r->terms);
    r->end = dag_alloc(arena, terms + 1);
}

static int count_reads(const struct dag *dag, int expression)
{
    const struct expression *e = &dag->expressions[expression];
    int count = e->kind == EXPRESSION_TERM     ? 1
                : e->kind == EXPRESSION_EXTERN ? 1 + dag->callbacks[e->index].reads.count
                                               : 0;
    if (e->left >= 0)
        count += count_reads(dag, e->left);
    return e->right >= 0 ? count + count_reads(dag, e->right) : count;
}

void prove_prepare(struct proof *proof)
{
    struct dag *dag = proof->dag;
    struct arena *arena = &dag->arena;
    int room = 2;
    for (int i = 0; i < proof->oracle->order.count; i++) {
        struct span arguments = prove_node_at(proof, i)->arguments;
        room++;
        for (int k = arguments.first; k < arguments.first + arguments.count; k++)
            room += count_reads(dag, dag->arguments[k].expression);
    }
    proof->script = dag_alloc(arena, (size_t)room);
    proof->start = dag_alloc(arena, (size_t)dag->term_count + 1);
    proof->nodes = dag_alloc(arena, (size_t)room * sizeof *proof->nodes);
    proof->told = dag_alloc(arena, (size_t)room);
    proof->asked = dag_alloc(arena, (size_t)proof->width * sizeof(double));
    proof->values = dag_alloc(arena, (size_t)proof->oracle->parameters.count * sizeof(double) + 1);
    proof->facts =
        dag_alloc(arena, (size_t)(dag->fact_count + dag->callback_count) * sizeof(double) + 1);
    proof->known = dag_alloc(arena, ((size_t)dag->term_count + 1) * PROVE_LEVELS * sizeof(double));
    open_record(proof, &proof->wanted, room);
    open_record(proof, &proof->got, room);
}
