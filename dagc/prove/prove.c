/* prove.c - interpreter against flat release, path by path.
 *
 * The oracles are emitted and compiled with tools that answer from a script and note how they
 * were asked. Each script is one path through the graph: a walk over the graph says which calls
 * with which arguments it must bring and which leaf it ends at; the compiled function must agree.
 * A graph of at most PATHS_MAX paths is walked on all of them; a larger one on paths that cover
 * every pair of an arc into a node and an arc out of it, and on random ones from a fixed seed.
 * Every parameter gets a value of its own, so that none can stand for another; so does every fact
 * and extern. A term that is read has a value that tells when and how well it was computed.
 * SPDX-License-Identifier: MIT */
#define _XOPEN_SOURCE 700

#include <dlfcn.h>
#include <math.h>
#include <string.h>

#include "prove/compile.h"
#include "emit/headers.h"
#include "prove/prove.h"

enum { PATHS_MAX = 100000, RANDOM_PATHS = 2000, SEED = 1, OPTIMISED_NODES = 1000 };

/* What a run of one path was asked. The same text stands in the scripted discussion.h. */
struct prove_record {
    const unsigned char *script; /* the answers to give */
    int room;                    /* of the lists: no path is longer */
    int calls;
    int *tools;
    double *arguments; /* [room * proof.width] */
    double *terms;     /* the terms at the end */
    unsigned char *levels;
    const double *facts; /* by fact, then by extern: its value */
    int watched;         /* calls that the counters or the trace have seen */
};
static const char record_text[] = "struct prove_record {\n    const unsigned char *script;\n    "
                                  "int room, calls;\n    int *tools;\n"
                                  "    double *arguments, *terms;\n    unsigned char *levels;\n    "
                                  "const double *facts;\n    int watched;\n};\n";

struct proof {
    struct dag *dag;
    const struct emit_options *options;
    const struct dag_compiler *compiler;
    FILE *report;
    void *library;
    const struct oracle_graph *oracle;
    int number;     /* of the oracle */
    int width;      /* arguments of the tool that has most */
    int room;       /* nodes of the oracle, plus some */
    double *values; /* of the oracle's parameters */
    double *facts;  /* see prove_record */
    unsigned char *script;
    struct prove_record wanted, got;
    int (*run)(int oracle, int flavour, const double *values, struct prove_record *record);
    long walked;
    int different;
    uint64_t random;
};

/* ---- the scripted runtime */

static void print_tool(const struct dag *dag, struct text *out, int number, int width)
{
    const struct tool *tool = &dag->tools[number];
    const struct parameter *parameters = &dag->parameters[tool->parameters.first];
    dag_print(out, "TOOL enum %s_answer tool_%s(struct discussion *d", tool->name, tool->name);
    for (int i = 0; i < tool->parameters.count; i++)
        dag_print(out, ", %s p%d",
                  dag->types[parameters[i].type].base == BASE_INTEGER ? "int" : "double", i);
    dag_print(out, ")\n{\n    double given[%d] = {0};\n", width);
    for (int i = 0; i < tool->parameters.count; i++)
        dag_print(out, "    given[%d] = p%d;\n", i, i);
    for (int i = 0; i < tool->writes.count; i++) {
        const struct need *need = &dag->needs[tool->writes.first + i];
        const struct term *term = &dag->terms[need->term];
        int length = dag->types[term->type].length;
        for (int k = 0; k < length; k++) {
            dag_print(out, "    d->terms.%s", term->name);
            if (length > 1)
                dag_print(out, "[%d]", k);
            dag_print(out, " = d->record->calls + 1;\n");
        }
        dag_print(out, "    d->terms.%s_level = %d;\n", term->name, need->level);
    }
    dag_print(out, "    return (enum %s_answer)prove_ask(d, %d, given, %d);\n}\n", tool->name,
              number, tool->answers.count);
}

/* The value of a term that an argument makes compute: READ_UNIT * level + the calls so far + 1. */
enum { READ_UNIT = 100000 };

static void print_term(const struct dag *dag, struct text *out, const struct term *term)
{
    const struct type *type = &dag->types[term->type];
    const char *base = type->base == BASE_INTEGER ? "int" : "double",
               *value = type->length > 1 ? "[0]" : "";
    int levels = term->levels.count;
    dag_print(out, "TOOL %s%s%s term_%s(struct discussion *d", type->length > 1 ? "const " : "",
              base, type->length > 1 ? " *" : "", term->name);
    if (levels > 0)
        dag_print(out, ", enum %s_level level", term->name);
    dag_print(out,
              ")\n{\n    if ((int)d->terms.%s_level < %s) {\n        d->terms.%s%s = %d * %s + "
              "d->record->calls + 1;\n"
              "        d->terms.%s_level = %s%s;\n    }\n    return d->terms.%s;\n}\n",
              term->name, levels > 0 ? "(int)level" : "1", term->name, value, READ_UNIT,
              levels > 0 ? "(int)level" : "1", term->name, levels > 0 ? "(unsigned char)" : "",
              levels > 0 ? "level" : "1", term->name);
}

/* An extern gives its value and those of the terms that it reads. */
static void print_callback(const struct dag *dag, struct text *out, int number)
{
    const struct callback *callback = &dag->callbacks[number];
    dag_print(
        out,
        "double %s(const struct discussion *d)\n{\n    double result = d->record->facts[%d];\n",
        callback->name, dag->fact_count + number);
    for (int i = callback->reads.first; i < callback->reads.first + callback->reads.count; i++)
        dag_print(out, "    result += d->terms.%s%s;\n", dag->terms[dag->needs[i].term].name,
                  dag->types[dag->terms[dag->needs[i].term].type].length > 1 ? "[0]" : "");
    dag_print(out, "    return result;\n}\n");
}

static void print_discussion(const struct dag *dag, struct text *out, int width)
{
    dag_print(
        out,
        "#ifndef DISCUSSION_H\n#define DISCUSSION_H\n#include <math.h>\n#include <stddef.h>\n"
        "#include <string.h>\n#define RUNTIME_ABI %d\n#include \"catalog.h\"\n%s"
        "#define TOOL static inline\n"
        "struct discussion {\n    struct terms terms;\n    struct prove_record *record;\n};\n",
        dag->runtime_abi, record_text);
    dag_print(out,
              "static inline int prove_ask(struct discussion *d, int tool, const double *given, "
              "int answers)\n{\n"
              "    struct prove_record *r = d->record;\n    int call = r->calls, answer = 0;\n"
              "    if (call < r->room) {\n        r->calls++;\n        r->tools[call] = tool;\n"
              "        memcpy(r->arguments + call * %d, given, %d * sizeof *given);\n"
              "        answer = r->script[call];\n    }\n"
              "    return answer < answers ? answer : 0;\n}\n",
              width, width);
    for (int i = 0; i < dag->tool_count; i++)
        print_tool(dag, out, i, width);
    for (int i = 0; i < dag->term_count; i++)
        print_term(dag, out, &dag->terms[i]);
    dag_print(out, "#endif\n");
}

/* One call of a compiled function; fills in the terms it gives back. */
static void print_run(const struct dag *dag, struct text *out, const struct emit_options *options)
{
    dag_print(out, "\nint prove_run(int oracle, int flavour, const double *values,"
                   " struct prove_record *record);\n");
    for (int i = 0; i < dag->callback_count; i++)
        print_callback(dag, out, i);
    if (options->traced)
        dag_print(out, "static void prove_trace(void *context, const struct discussion *d, int "
                       "node, int arc)\n{\n"
                       "    (void)d;\n    (void)node;\n    (void)arc;\n"
                       "    ((struct prove_record *)context)->watched++;\n}\n");
    for (int i = 0; i < dag->oracle_count; i++) {
        const struct oracle_graph *oracle = &dag->oracles[i];
        const char *name = oracle->name;
        dag_print(
            out,
            "static int prove_%d(int flavour, const double *values, struct discussion *d)\n{\n"
            "    struct %s_parameters p;\n    int result = -1;\n    %s_defaults(&p);\n"
            "    (void)values;\n",
            i, name, name);
        for (int k = 0; k < oracle->parameters.count; k++) {
            const struct parameter *parameter = &dag->parameters[oracle->parameters.first + k];
            dag_print(out, "    p.%s = %svalues[%d];\n", parameter->name,
                      dag->types[parameter->type].base == BASE_INTEGER ? "(int)" : "", k);
        }
        dag_print(out, "    if (flavour == 0)\n        result = (int)%s_refine(&p, d);\n", name);
        if (options->counted)
            dag_print(
                out,
                "    if (flavour == 1) {\n"
                "        static struct %s_counters c;\n"
                "        int calls = 0, arcs = 0, i;\n        memset(&c, 0, sizeof c);\n"
                "        result = (int)%s_refine_counted(&p, d, &c);\n"
                "        for (i = 0; i < %s_nodes; i++)\n            calls += (int)c.calls[i];\n"
                "        for (i = 0; i < %s_arcs; i++)\n"
                "            if (c.arcs[i] > 0 && c.calls[%s_arc_nodes[i]] > 0)\n                "
                "arcs += (int)c.arcs[i];\n"
                "        d->record->watched = calls == arcs ? calls : -1;\n    }\n",
                name, name, name, name, name);
        if (options->traced)
            dag_print(out,
                      "    if (flavour == 2)\n        result = (int)%s_refine_traced(&p, d, "
                      "prove_trace, d->record);\n",
                      name);
        dag_print(out, "    return result;\n}\n");
    }
    dag_print(out,
              "\nint prove_run(int oracle, int flavour, const double *values, struct prove_record "
              "*record)\n{\n"
              "    static int (*const oracles[])(int, const double *, struct discussion *) = {\n");
    for (int i = 0; i < dag->oracle_count; i++)
        dag_print(out, "        prove_%d,\n", i);
    dag_print(out,
              "    };\n    struct discussion d;\n    int result;\n    memset(&d, 0, sizeof d);\n"
              "    d.record = record;\n    result = oracles[oracle](flavour, values, &d);\n");
    for (int i = 0; i < dag->term_count; i++) {
        const char *name = dag->terms[i].name;
        dag_print(
            out,
            "    record->terms[%d] = d.terms.%s%s;\n    record->levels[%d] = d.terms.%s_level;\n",
            i, name, dag->types[dag->terms[i].type].length > 1 ? "[0]" : "", i, name);
    }
    dag_print(out, "    return result;\n}\n");
}

/* ---- the library */

static const char *embedded(const char *name)
{
    for (int i = 0; dagc_headers[i].name != NULL; i++)
        if (strcmp(dagc_headers[i].name, name) == 0)
            return dagc_headers[i].text;
    return "";
}

static int build(struct proof *proof)
{
    enum { C, CATALOG, DISCUSSION, ORACLE, TOOLS, FILES };
    static const char *const names[FILES] = {"oracles.c", "catalog.h", "discussion.h", "oracle.h",
                                             "tools.h"};
    struct dag *dag = proof->dag;
    struct text texts[FILES] = {{0}};
    char message[4096] = "out of memory";
    /* Much text is compiled without optimising, which would take minutes. */
    const char *const flags[] = {dag->order_count > OPTIMISED_NODES ? "-O0" : "-O1", NULL};
    int failed = 0;
    dag->runtime_header = "discussion.h";
    for (int i = 0; i < dag->tool_count; i++)
        dag->tools[i].header = "tools.h";
    for (int i = 0; i < dag->term_count; i++)
        dag->terms[i].header = "tools.h";
    for (int i = 0; i < dag->fact_count; i++)
        dag->facts[i].c = dag_format(&dag->arena, "d->record->facts[%d]", i);
    dag_emit_catalog_h(dag, &texts[CATALOG], NULL);
    print_discussion(dag, &texts[DISCUSSION], proof->width);
    dag_print(&texts[ORACLE], "%s", embedded("oracle.h"));
    dag_print(&texts[TOOLS], "/* all are in discussion.h */\n");
    dag_emit_c(dag, &texts[C], NULL, NULL, proof->options);
    print_run(dag, &texts[C], proof->options);
    struct c_file files[FILES];
    for (int i = 0; i < FILES; i++) {
        files[i] = (struct c_file){names[i], texts[i].bytes, texts[i].length};
        failed |= texts[i].failed;
    }
    if (!failed)
        proof->library = dag_compile(files, FILES, flags, proof->compiler, message, sizeof message);
    for (int i = 0; i < FILES; i++)
        dag_text_free(&texts[i]);
    if (proof->library == NULL) {
        fprintf(stderr, "dagc: error: %s\n", message);
        return -1;
    }
    *(void **)&proof->run = dlsym(proof->library, "prove_run");
    return proof->run != NULL ? 0 : -1;
}

/* ---- walking */

static const struct node *node_at(const struct proof *proof, int place)
{
    return &proof->dag->nodes[proof->dag->order[proof->oracle->order.first + place]];
}

static double read_term(struct prove_record *r, int term, int level)
{
    if (r->levels[term] < level) {
        r->terms[term] = (double)READ_UNIT * level + r->calls + 1;
        r->levels[term] = (unsigned char)level;
    }
    return r->terms[term];
}

static double call_extern(const struct proof *proof, struct prove_record *r, int number)
{
    const struct dag *dag = proof->dag;
    struct span reads = dag->callbacks[number].reads;
    double result = proof->facts[dag->fact_count + number];
    for (int i = reads.first; i < reads.first + reads.count; i++)
        read_term(r, dag->needs[i].term, dag->needs[i].level);
    for (int i = reads.first; i < reads.first + reads.count; i++)
        result += r->terms[dag->needs[i].term];
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
        return read_term(r, e->index, e->level);
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

static void note_call(const struct proof *proof, const struct node *node, struct prove_record *r)
{
    const struct tool *tool = &proof->dag->tools[node->tool];
    double *arguments = r->arguments + r->calls * proof->width;
    memset(arguments, 0, (size_t)proof->width * sizeof *arguments);
    for (int i = 0; i < node->arguments.count; i++) {
        const struct argument *argument = &proof->dag->arguments[node->arguments.first + i];
        arguments[i] = value_of(proof, r, argument->expression);
        if (!dag_is_doubtful(proof->dag, argument))
            continue;
        const struct dag_doubt doubt = dag_doubt(proof->dag, node, argument);
        if (!(arguments[i] >= doubt.low && arguments[i] <= doubt.high))
            arguments[i] = doubt.instead;
    }
    for (int i = 0; i < tool->writes.count; i++) {
        const struct need *need = &proof->dag->needs[tool->writes.first + i];
        r->terms[need->term] = r->calls + 1;
        r->levels[need->term] = (unsigned char)need->level;
    }
    r->tools[r->calls++] = node->tool;
}

/* The graph itself, along the script: the decision. */
static int walk(const struct proof *proof, struct prove_record *r)
{
    const struct node *node = node_at(proof, 0);
    for (;;) {
        int answer = r->script[r->calls];
        note_call(proof, node, r);
        const struct target *target = &proof->dag->arcs[node->arcs.first + answer].target;
        if (target->kind == TARGET_DECISION)
            return target->index;
        node = &proof->dag->nodes[target->index];
    }
}

static void print_path(const struct proof *proof, int wanted, int got, const char *what)
{
    static const char *const flavours[] = {"refine", "refine_counted", "refine_traced"};
    const struct node *node = node_at(proof, 0);
    fprintf(proof->report, "%s: %s_%s differs in %s on the path\n", proof->oracle->name,
            proof->oracle->name, flavours[proof->different - 1], what);
    for (int i = 0; i < proof->wanted.calls; i++) {
        const struct arc *arc = &proof->dag->arcs[node->arcs.first + proof->script[i]];
        const struct tool *tool = &proof->dag->tools[node->tool];
        fprintf(proof->report, "  %s = %s: %s\n", node->name, tool->name,
                proof->dag->answers[tool->answers.first + proof->script[i]].name);
        if (arc->target.kind == TARGET_NODE)
            node = &proof->dag->nodes[arc->target.index];
    }
    fprintf(proof->report, "  the graph decides %s after %d calls, the function %s after %d\n",
            proof->dag->decisions[wanted].name, proof->wanted.calls,
            got >= 0 && got < proof->dag->decision_count ? proof->dag->decisions[got].name
                                                         : "nothing",
            proof->got.calls);
}

/* NULL: both agree; else what they differ in. */
static const char *difference(const struct proof *proof, int flavour, int wanted, int got)
{
    const struct prove_record *a = &proof->wanted, *b = &proof->got;
    size_t calls = (size_t)a->calls, width = (size_t)proof->width;
    const struct span *reads = &proof->dag->decisions[wanted].reads;
    if (a->calls != b->calls || memcmp(a->tools, b->tools, calls * sizeof *a->tools) != 0)
        return "the calls";
    for (size_t i = 0; i < calls * width; i++) /* one kind of not-a-number is as good as another */
        if (memcmp(&a->arguments[i], &b->arguments[i], sizeof *a->arguments) != 0
            && !(isnan(a->arguments[i]) && isnan(b->arguments[i])))
            return "an argument";
    if (wanted != got)
        return "the decision";
    for (int i = 0; i < reads->count; i++) {
        int term = proof->dag->needs[reads->first + i].term;
        if (a->levels[term] != b->levels[term] || a->terms[term] != b->terms[term])
            return "a term that the decision reads";
    }
    return flavour != 0 && b->watched != b->calls ? "what was counted" : NULL;
}

static void empty(const struct proof *proof, struct prove_record *r)
{
    r->calls = r->watched = 0;
    memset(r->terms, 0, (size_t)proof->dag->term_count * sizeof *r->terms);
    memset(r->levels, 0, (size_t)proof->dag->term_count);
}

static void try_script(struct proof *proof)
{
    empty(proof, &proof->wanted);
    int wanted = walk(proof, &proof->wanted);
    for (int flavour = 0; flavour < 3 && proof->different == 0; flavour++) {
        if ((flavour == 1 && !proof->options->counted) || (flavour == 2 && !proof->options->traced))
            continue;
        empty(proof, &proof->got);
        int got = proof->run(proof->number, flavour, proof->values, &proof->got);
        const char *what = difference(proof, flavour, wanted, got);
        if (what != NULL) {
            proof->different = flavour + 1;
            print_path(proof, wanted, got, what);
        }
    }
    proof->walked++;
}

/* ---- choosing paths */

static int pick(struct proof *proof, int count)
{
    proof->random = proof->random * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (int)((proof->random >> 33) % (uint64_t)count);
}

/* Random answers from the call `at` on, which asks `node`. */
static void finish_at_random(struct proof *proof, const struct node *node, int at)
{
    for (;;) {
        int answer = pick(proof, node->arcs.count);
        const struct target *target = &proof->dag->arcs[node->arcs.first + answer].target;
        proof->script[at++] = (unsigned char)answer;
        if (target->kind != TARGET_NODE)
            return;
        node = &proof->dag->nodes[target->index];
    }
}

/* All paths, as an odometer counts: the last answer that has a next one goes on. */
static void walk_all(struct proof *proof)
{
    memset(proof->script, 0, (size_t)proof->room);
    while (proof->different == 0) {
        const struct node *node = node_at(proof, 0);
        int last = -1, length = 0;
        try_script(proof);
        for (; length < proof->wanted.calls; length++) {
            const struct arc *arc = &proof->dag->arcs[node->arcs.first + proof->script[length]];
            if (proof->script[length] + 1 < node->arcs.count)
                last = length;
            if (arc->target.kind == TARGET_NODE)
                node = &proof->dag->nodes[arc->target.index];
        }
        if (last < 0)
            return;
        proof->script[last]++;
        memset(proof->script + last + 1, 0, (size_t)(proof->room - last - 1));
    }
}

/* For every arc, one path to it and over it to each of the arcs that may follow. */
static int walk_pairs(struct proof *proof, int *way_node, unsigned char *way_answer)
{
    int count = proof->oracle->order.count, pairs = 0;
    way_node[0] = -1;
    for (int i = 0; i < count; i++) {
        const struct node *node = node_at(proof, i);
        for (int a = 0; a < node->arcs.count; a++) {
            const struct target *target = &proof->dag->arcs[node->arcs.first + a].target;
            if (target->kind == TARGET_NODE) {
                way_node[proof->dag->nodes[target->index].order] = i;
                way_answer[proof->dag->nodes[target->index].order] = (unsigned char)a;
            }
        }
    }
    for (int i = 0; i < count; i++) {
        const struct node *node = node_at(proof, i);
        int depth = 0;
        for (int at = i; way_node[at] >= 0; at = way_node[at])
            depth++;
        for (int a = 0; a < node->arcs.count; a++) {
            const struct target *target = &proof->dag->arcs[node->arcs.first + a].target;
            const struct node *next =
                target->kind == TARGET_NODE ? &proof->dag->nodes[target->index] : NULL;
            int follow = next != NULL ? next->arcs.count : 1;
            for (int b = 0; b < follow && proof->different == 0; b++, pairs++) {
                int k = depth;
                for (int at = i; way_node[at] >= 0; at = way_node[at])
                    proof->script[--k] = way_answer[at];
                proof->script[depth] = (unsigned char)a;
                if (next != NULL) {
                    const struct target *then = &proof->dag->arcs[next->arcs.first + b].target;
                    proof->script[depth + 1] = (unsigned char)b;
                    if (then->kind == TARGET_NODE)
                        finish_at_random(proof, &proof->dag->nodes[then->index], depth + 2);
                }
                try_script(proof);
            }
        }
    }
    return pairs;
}

static double count_paths(const struct proof *proof, double *paths)
{
    for (int i = proof->oracle->order.count - 1; i >= 0; i--) {
        const struct node *node = node_at(proof, i);
        paths[i] = 0;
        for (int a = 0; a < node->arcs.count; a++) {
            const struct target *target = &proof->dag->arcs[node->arcs.first + a].target;
            paths[i] +=
                target->kind == TARGET_NODE ? paths[proof->dag->nodes[target->index].order] : 1;
        }
    }
    return paths[0];
}

static void open_record(struct proof *proof, struct prove_record *r)
{
    struct arena *arena = &proof->dag->arena;
    size_t room = (size_t)proof->room;
    r->script = proof->script;
    r->facts = proof->facts;
    r->room = proof->room;
    r->tools = dag_alloc(arena, room * sizeof *r->tools);
    r->arguments = dag_alloc(arena, room * (size_t)proof->width * sizeof *r->arguments);
    r->terms = dag_alloc(arena, (size_t)proof->dag->term_count * sizeof *r->terms + 1);
    r->levels = dag_alloc(arena, (size_t)proof->dag->term_count + 1);
}

static int prove_oracle(struct proof *proof)
{
    struct dag *dag = proof->dag;
    const struct oracle_graph *oracle = proof->oracle;
    size_t nodes = (size_t)oracle->order.count;
    double *paths = dag_alloc(&dag->arena, nodes * sizeof *paths);
    proof->room = oracle->order.count + 2;
    proof->script = dag_alloc(&dag->arena, (size_t)proof->room);
    proof->values = dag_alloc(&dag->arena, (size_t)oracle->parameters.count * sizeof(double) + 1);
    proof->facts = dag_alloc(&dag->arena,
                             (size_t)(dag->fact_count + dag->callback_count) * sizeof(double) + 1);
    for (int i = 0; i < dag->fact_count; i++)
        proof->facts[i] =
            dag->types[dag->facts[i].type].base == BASE_INTEGER ? 3 + i : 0.7 + 1.3 * i;
    for (int i = 0; i < dag->callback_count; i++)
        proof->facts[dag->fact_count + i] =
            dag->types[dag->callbacks[i].type].base == BASE_INTEGER ? 50 + i : 0.2 + 1.1 * i;
    open_record(proof, &proof->wanted);
    open_record(proof, &proof->got);
    for (int i = 0; i < oracle->parameters.count; i++) {
        const struct parameter *p = &dag->parameters[oracle->parameters.first + i];
        proof->values[i] = dag->types[p->type].base == BASE_INTEGER ? 1000 + i : 0.3 + 1.7 * i;
    }
    proof->walked = 0;
    proof->different = 0;
    proof->random = SEED;
    double count = count_paths(proof, paths);
    if (count <= PATHS_MAX)
        walk_all(proof);
    else {
        int *way = dag_alloc(&dag->arena, nodes * sizeof *way);
        int pairs = walk_pairs(proof, way, dag_alloc(&dag->arena, nodes));
        for (int i = 0; i < RANDOM_PATHS && proof->different == 0; i++) {
            finish_at_random(proof, node_at(proof, 0), 0);
            try_script(proof);
        }
        if (proof->different == 0)
            fprintf(proof->report,
                    "%s: proved on %d pairs of arcs and %d random paths (seed %d) of %.3g paths\n",
                    oracle->name, pairs, RANDOM_PATHS, SEED, count);
    }
    if (count <= PATHS_MAX && proof->different == 0)
        fprintf(proof->report, "%s: proved on all %ld paths\n", oracle->name, proof->walked);
    return proof->different != 0;
}

struct request {
    struct proof proof;
    int result;
};

static void prove_all(struct dag *dag, void *context)
{
    struct request *request = context;
    struct proof *proof = &request->proof;
    request->result = build(proof);
    for (int i = 0; i < dag->oracle_count && request->result >= 0; i++) {
        proof->oracle = &dag->oracles[i];
        proof->number = i;
        request->result |= prove_oracle(proof);
    }
}

int dag_prove(struct dag *dag, const struct emit_options *options,
              const struct dag_compiler *compiler, FILE *report)
{
    struct request request = {0};
    struct protector *outer = dag->arena.protector;
    request.proof.dag = dag;
    request.proof.options = options;
    request.proof.compiler = compiler;
    request.proof.report = report;
    request.proof.width = 1;
    for (int i = 0; i < dag->tool_count; i++)
        if (dag->tools[i].parameters.count > request.proof.width)
            request.proof.width = dag->tools[i].parameters.count;
    /* Of its own, so that the library goes even when memory runs out. */
    if (dag_protect(dag, prove_all, &request) != 0) {
        fprintf(stderr, "dagc: error: out of memory\n");
        request.result = -1;
    }
    dag->arena.protector = outer;
    if (request.proof.library != NULL)
        dlclose(request.proof.library);
    return request.result;
}
