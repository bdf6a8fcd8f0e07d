/* scripted.c - the C text of a proof: the catalog with tools that answer from a script and note how
 * they were asked, the oracles as they are emitted, and the runtime's interpreter.
 *
 * Each tool notes from where in the text it was called (its line, and that of the call of an
 * outlined function around it; a step of the interpreter), and
 * what is known of all terms then. Emitted text keeps nothing else from one call to the next, so
 * these two are its state (states.c). Terms have values by level alone; a tool that declares to
 * write one writes it, and one that arguments read is noted as it is read. What the text tells the
 * compiler to be known (KNOWN) is looked at, in place of being believed.
 * SPDX-License-Identifier: MIT */
#define _XOPEN_SOURCE 700

#include <dlfcn.h>
#include <string.h>

#include "prove/compile.h"
#include "analyse/analyse.h"
#include "emit/emit.h"
#include "emit/headers.h"
#include "prove/proving.h"

enum { OPTIMISED_NODES = 1000 };

/* d->terms.NAME = what it is at `level`, a C expression. */
static void print_value(const struct dag *dag, struct text *out, int number, const char *level)
{
    const struct term *term = &dag->terms[number];
    int length = dag->types[term->type].length;
    for (int k = 0; k < length; k++) {
        dag_print(out, "        d->terms.%s", term->name);
        if (length > 1)
            dag_print(out, "[%d]", k);
        dag_print(out, " = (%s)(d->record->known[%d * %d + (%s)] + %d);\n",
                  dag_c_type(dag, term->type), number, PROVE_LEVELS, level, k);
    }
    dag_print(out, "        d->terms.%s_level = (unsigned char)(%s);\n", term->name, level);
}

static void print_tool(struct dag *dag, struct text *out, int number, int width)
{
    const struct tool *tool = &dag->tools[number];
    const struct parameter *parameters = &dag->parameters[tool->parameters.first];
    dag_print(out, "TOOL enum %s_answer tool_%s(struct discussion *d", tool->name, tool->name);
    for (int i = 0; i < tool->parameters.count; i++)
        dag_print(out, ", %s p%d", dag_c_type(dag, parameters[i].type), i);
    dag_print(out, ")\n{\n    double given[%d] = {0};\n    int answer;\n", width);
    for (int i = 0; i < tool->parameters.count; i++)
        dag_print(out, "    given[%d] = p%d;\n", i, i);
    dag_print(out, "    answer = prove_ask(d, %d, given, %d);\n", number, tool->answers.count);
    for (int i = 0; i < tool->answers.count && tool->writes.count > 0; i++)
        if (dag->answers[tool->answers.first + i].refuses)
            dag_print(out, "    if (answer == %d)\n        return (enum %s_answer)answer;\n", i,
                      tool->name);
    for (int i = 0; i < tool->writes.count; i++) {
        const struct need *need = &dag->needs[tool->writes.first + i];
        dag_print(out, "    if (d->terms.%s_level < %d) {\n", dag->terms[need->term].name,
                  need->level);
        print_value(dag, out, need->term, dag_format(&dag->arena, "%d", need->level));
        dag_print(out, "    }\n");
    }
    dag_print(out, "    return (enum %s_answer)answer;\n}\n", tool->name);
}

static void print_term(const struct dag *dag, struct text *out, int number, int width)
{
    const struct term *term = &dag->terms[number];
    const struct type *type = &dag->types[term->type];
    int levels = term->levels.count;
    dag_print(out, "TOOL %s%s%sterm_%s(struct discussion *d", type->length > 1 ? "const " : "",
              dag_c_type(dag, term->type), type->length > 1 ? " *" : " ", term->name);
    if (levels > 0)
        dag_print(out, ", enum %s_level wanted", term->name);
    dag_print(out, ")\n{\n    double given[%d] = {0};\n    int level = %s;\n", width,
              levels > 0 ? "(int)wanted" : "1");
    dag_print(out,
              "    given[0] = level;\n    prove_note(d, ~%d, given);\n"
              "    if ((int)d->terms.%s_level < level) {\n",
              number, term->name);
    print_value(dag, out, number, "level");
    dag_print(out, "    }\n    return d->terms.%s;\n}\n", term->name);
}

/* An extern gives its value and those of the terms that it reads. */
static void print_callback(const struct dag *dag, struct text *out, int number, int width)
{
    const struct callback *callback = &dag->callbacks[number];
    dag_print(out,
              "double %s(const struct discussion *d)\n{\n"
              "    static const double none[%d];\n    double result = d->record->facts[%d];\n"
              "    prove_note(d, ~%d, none);\n",
              callback->name, width, dag->fact_count + number, dag->term_count + number);
    for (int i = callback->reads.first; i < callback->reads.first + callback->reads.count; i++)
        dag_print(out, "    result += d->terms.%s%s;\n", dag->terms[dag->needs[i].term].name,
                  dag->types[dag->terms[dag->needs[i].term].type].length > 1 ? "[0]" : "");
    dag_print(out, "    return result;\n}\n");
}

/* The record and how events get into it. */
static void print_notes(const struct dag *dag, struct text *out, int width)
{
    dag_print(out, "extern int prove_site, prove_outer, prove_untrue;\n"
                   "static inline void prove_note(const struct discussion *d, int what, const "
                   "double *given)\n{\n"
                   "    struct prove_record *r = d->record;\n    int at = r->events;\n"
                   "    if (at >= r->room)\n        return;\n    r->events++;\n"
                   "    r->what[at] = what;\n    r->site[at] = ((long long)prove_outer << 32) + "
                   "prove_site;\n");
    dag_print(out, "    memcpy(r->arguments + at * %d, given, %d * sizeof *given);\n", width,
              width);
    for (int i = 0; i < dag->term_count; i++)
        dag_print(out, "    r->levels[at * %d + %d] = d->terms.%s_level;\n", dag->term_count, i,
                  dag->terms[i].name);
    dag_print(out, "}\n"
                   "static inline int prove_ask(struct discussion *d, int tool, const double "
                   "*given, int answers)\n{\n"
                   "    struct prove_record *r = d->record;\n    int answer = 0;\n"
                   "    prove_note(d, tool, given);\n"
                   "    if (r->calls < r->room)\n        answer = r->script[r->calls++];\n"
                   "    return answer < answers ? answer : 0;\n}\n");
}

static void print_discussion(struct dag *dag, struct text *out, int width)
{
    dag_print(
        out,
        "#ifndef DISCUSSION_H\n#define DISCUSSION_H\n#include <math.h>\n#include <stddef.h>\n"
        "#include <stdint.h>\n#include <string.h>\n#define RUNTIME_ABI %d\n"
        "#include \"catalog.h\"\n#include \"prove/proof.h\"\n#define TOOL static inline\n"
        "struct discussion {\n    struct terms terms;\n    struct prove_record *record;\n};\n",
        dag->runtime_abi);
    print_notes(dag, out, width);
    for (int i = 0; i < dag->tool_count; i++)
        print_tool(dag, out, i, width);
    for (int i = 0; i < dag->term_count; i++)
        print_term(dag, out, i, width);
    dag_print(out, "#endif\n");
}

/* What a discussion begins with and ends with. A term that no decision reads is for the compiled
 * function to clear: it finds one there. */
static void print_ends(struct dag *dag, struct text *out)
{
    int at = 0;
    dag_print(out, "static void prove_begin(struct discussion *d, int left)\n{\n    (void)left;\n");
    for (int i = 0; i < dag->term_count; i++) {
        dag_print(out, "    {\n");
        print_value(dag, out, i,
                    dag_is_kept(dag, i) ? dag_format(&dag->arena, "d->record->start[%d]", i)
                                        : "left ? 1 : 0");
        dag_print(out, "    }\n");
    }
    dag_print(out, "}\nstatic void prove_end(struct discussion *d)\n{\n    (void)d;\n");
    for (int i = 0; i < dag->term_count; i++) {
        const char *name = dag->terms[i].name;
        int length = dag->types[dag->terms[i].type].length;
        for (int k = 0; k < length; k++, at++) {
            dag_print(out, "    d->record->terms[%d] = d->terms.%s", at, name);
            if (length > 1)
                dag_print(out, "[%d]", k);
            dag_print(out, ";\n");
        }
        dag_print(out, "    d->record->end[%d] = d->terms.%s_level;\n", i, name);
    }
    dag_print(out, "}\n");
}

/* The other file: the runtime's interpreter and what opens both releases. */
static void print_releases(struct dag *dag, struct text *out, int width)
{
    dag_print(out, "#include \"discussion.h\"\n#include \"oracle/refiner.h\"\n");
    for (int i = 0; i < dag->callback_count; i++)
        print_callback(dag, out, i, width);
    print_ends(dag, out);
    dag_print(out,
              "#include \"oracle/in_proof.inc\"\nconst struct extern_entry prove_externs[] = {\n");
    for (int i = 0; i < dag->callback_count; i++)
        dag_print(out, "    {\"%s\", %s},\n", dag->callbacks[i].name, dag->callbacks[i].name);
    dag_print(out, "    {0, 0}};\nconst int prove_extern_count = %d;\n", dag->callback_count);
}

/* Before the oracles: each call of a tool says its line first, each fact is looked at. */
static const char *watch_text(struct dag *dag)
{
    const char *text =
        "\n#undef KNOWN\n#define KNOWN(fact) ((void)(prove_untrue |= !(fact)))\n"
        "static inline int prove_left(int exit)\n{\n    prove_outer = 0;\n    return exit;\n}\n"
        "#define WATCHED(call) (prove_outer = __LINE__, prove_left(call))\n";
    for (int i = 0; i < dag->tool_count; i++) {
        const char *name = dag->tools[i].name;
        text = dag_format(&dag->arena,
                          "%s#define tool_%s (prove_site = __LINE__, tool_%s)\n"
                          "#define ask_%s (prove_site = __LINE__, ask_%s)\n"
                          "#define wave_%s (prove_site = __LINE__, wave_%s)\n",
                          text, name, name, name, name, name, name);
    }
    return text;
}

static void print_counted(struct text *out, const char *name, const char *verb)
{
    dag_print(out,
              "    if (flavour == %d) {\n"
              "        static struct %s_counters c;\n"
              "        int calls = 0, arcs = 0, i;\n        memset(&c, 0, sizeof c);\n"
              "        result = (int)%s_%s_counted(p, d, &c);\n"
              "        for (i = 0; i < %s_nodes; i++)\n            calls += (int)c.calls[i];\n"
              "        for (i = 0; i < %s_arcs; i++)\n"
              "            if (c.arcs[i] > 0 && c.calls[%s_arc_nodes[i]] > 0)\n                "
              "arcs += (int)c.arcs[i];\n"
              "        d->record->watched = calls == arcs ? calls : -1;\n    }\n",
              PROVE_COUNTED, name, name, verb, name, name, name);
}

/* Where each parameter of each oracle is in truth, and the functions that count and trace. */
static void print_compiled(const struct dag *dag, struct text *out,
                           const struct emit_options *options)
{
    if (options->traced)
        dag_print(out, "static void prove_trace(void *context, const struct discussion *d, int "
                       "node, int arc)\n{\n"
                       "    (void)d;\n    (void)node;\n    (void)arc;\n"
                       "    ((struct prove_record *)context)->watched++;\n}\n");
    for (int i = 0; i < dag->oracle_count; i++) {
        const struct oracle_graph *oracle = &dag->oracles[i];
        const struct parameter *parameters = &dag->parameters[oracle->parameters.first];
        const char *name = oracle->name;
        dag_print(out,
                  "static int prove_watched_%d(int flavour, const void *parameters,\n"
                  "    struct discussion *d)\n{\n    int result = -1;\n"
                  "    const struct %s_parameters *p = (const struct %s_parameters *)parameters;\n"
                  "    (void)p;\n    (void)d;\n    (void)flavour;\n",
                  i, name, name);
        if (options->counted)
            print_counted(out, name, dag->verb);
        if (options->traced)
            dag_print(out,
                      "    if (flavour == %d)\n        result = (int)%s_%s_traced(p, d, "
                      "prove_trace, d->record);\n",
                      PROVE_TRACED, name, dag->verb);
        if (options->copies > 1)
            dag_print(out, "    if (flavour == %d)\n        result = (int)%s_%s_first(p, d);\n",
                      PROVE_FIRST, name, dag->verb);
        dag_print(out, "    return result;\n}\nstatic const size_t prove_fields_%d[] = {", i);
        for (int k = 0; k < oracle->parameters.count; k++)
            dag_print(out, "offsetof(struct %s_parameters, %s), ", name, parameters[k].name);
        dag_print(out, "0}, prove_ends_%d[] = {", i);
        for (int k = 0; k < oracle->parameters.count; k++)
            dag_print(out, "offsetof(struct %s_parameters, %s) + sizeof(%s), ", name,
                      parameters[k].name, dag_c_type(dag, parameters[k].type));
        dag_print(out, "0};\n");
    }
    dag_print(out, "extern const struct prove_compiled prove_compiled[];\n"
                   "const struct prove_compiled prove_compiled[] = {\n");
    for (int i = 0; i < dag->oracle_count; i++)
        dag_print(out,
                  "    {&%s_oracle, prove_watched_%d, prove_fields_%d, prove_ends_%d,\n"
                  "     sizeof(struct %s_parameters)},\n",
                  dag->oracles[i].name, i, i, i, dag->oracles[i].name);
    dag_print(out, "};\n");
}

static const char *embedded(const char *name)
{
    for (int i = 0; dagc_headers[i].name != NULL; i++)
        if (strcmp(dagc_headers[i].name, name) == 0)
            return dagc_headers[i].text;
    return "";
}

/* Nothing here is the catalog's own: every header that it names is the scripted one. */
static void redirect(struct dag *dag)
{
    dag->runtime_header = "discussion.h";
    for (int i = 0; i < dag->tool_count; i++) {
        dag->tools[i].header = "tools.h";
        dag->tools[i].wave = NULL;
    }
    for (int i = 0; i < dag->term_count; i++) {
        dag->terms[i].header = "tools.h";
        dag->terms[i].wave = NULL;
    }
    for (int i = 0; i < dag->fact_count; i++)
        dag->facts[i].c = dag_format(&dag->arena, "d->record->facts[%d]", i);
}

int prove_build(struct proof *proof)
{
    enum {
        ORACLES,
        RELEASES,
        TABLE,
        CATALOG,
        DISCUSSION,
        ORACLE,
        TOOLS,
        TOOL_TABLE,
        ATOMIC,
        FILES
    };
    static const char *const names[FILES] = {"oracles.c", "releases.c",   "catalog.c",
                                             "catalog.h", "discussion.h", "oracle.h",
                                             "tools.h",   "tool_table.h", "stdatomic.h"};
    struct dag *dag = proof->dag;
    struct text texts[FILES] = {{0}};
    struct emit_options options = *proof->options;
    char message[4096] = "out of memory";
    /* Much text is compiled without optimising, which would take minutes. */
    const char *const flags[] = {dag->order_count > OPTIMISED_NODES ? "-O0" : "-O1", NULL};
    int failed = 0, count = FILES;
    while (dagc_interpreter[count - FILES].name != NULL)
        count++;
    struct c_file *files = dag_alloc(&dag->arena, (size_t)count * sizeof *files);
    redirect(dag);
    options.before = watch_text(dag);
    dag_emit_c(dag, &texts[ORACLES], NULL, NULL, &options);
    print_compiled(dag, &texts[ORACLES], &options);
    print_releases(dag, &texts[RELEASES], proof->width);
    dag_emit_catalog_c(dag, &texts[TABLE]);
    dag_emit_catalog_h(dag, &texts[CATALOG]);
    print_discussion(dag, &texts[DISCUSSION], proof->width);
    dag_print(&texts[ORACLE], "%s", embedded("oracle.h"));
    dag_print(&texts[TOOLS], "/* all are in discussion.h */\n");
    /* One thread asks; and not every compiler has it. */
    dag_print(&texts[ATOMIC], "#define _Atomic(type) type\ntypedef int atomic_int;\n");
    dag_print(&texts[TOOL_TABLE], "#include \"oracle/tool_table.h\"\n");
    for (int i = 0; i < FILES; i++) {
        files[i] = (struct c_file){names[i], texts[i].bytes, texts[i].length};
        failed |= texts[i].failed;
    }
    for (int i = FILES; i < count; i++)
        files[i] =
            (struct c_file){dagc_interpreter[i - FILES].name, dagc_interpreter[i - FILES].text,
                            strlen(dagc_interpreter[i - FILES].text)};
    if (!failed)
        proof->handle = dag_compile(files, count, flags, proof->compiler, message, sizeof message);
    for (int i = 0; i < FILES; i++)
        dag_text_free(&texts[i]);
    if (proof->handle == NULL) {
        fprintf(stderr, "dagc: error: %s\n", message);
        return -1;
    }
    proof->library = dlsym(proof->handle, "prove_library");
    return proof->library != NULL ? 0 : -1;
}
