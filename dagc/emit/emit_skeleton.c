/* emit_skeleton.c - all that a catalog asks of a program, ready to be filled in: the runtime's
 * header, a header for every tool and term, a graph, a program that asks it once, and a makefile.
 *
 * It compiles and runs as it is made: tools give their first answers, terms are 0. What a fact
 * reads of the discussion (d->packet->size) becomes a field. dagc-runtime(5) tells of each part.
 * SPDX-License-Identifier: MIT */
#include <ctype.h>
#include <string.h>

#include "emit/emit.h"
#include "emit/skeleton.h"

struct text *dag_skeleton_add(struct skeleton *s, const char *name)
{
    s->files = dag_grow(&s->dag->arena, s->files, s->file_count, sizeof *s->files);
    s->files[s->file_count].name = name;
    return &s->files[s->file_count++].text;
}

/* The text of a file that is there, or of a new one. */
static struct text *file_of(struct skeleton *s, const char *name)
{
    for (int i = 0; i < s->file_count; i++)
        if (strcmp(s->files[i].name, name) == 0) {
            dag_print(&s->files[i].text, "\n");
            return &s->files[i].text;
        }
    return dag_skeleton_add(s, name);
}

/* ---- what facts read: fields of the discussion */

/* d->NAME, or d->NAME->PART and d->NAME.PART; either may be indexed. */
struct field {
    const char *name, *part; /* part NULL: a number */
    unsigned char pointer, array;
};
enum { FIELDS_MAX = 200, FIELD_LENGTH = 16 };

static int name_length(const char *text)
{
    int length = 0;
    while (isalnum((unsigned char)text[length]) || text[length] == '_')
        length++;
    return length;
}

static int add_field(struct dag *dag, struct field *fields, int count, const char *at)
{
    struct field f = {NULL, NULL, 0, 0};
    int length = name_length(at);
    if (length == 0 || count == FIELDS_MAX)
        return count;
    f.name = dag_copy(&dag->arena, at, (size_t)length);
    at += length;
    if (strncmp(at, "->", 2) == 0 || *at == '.') {
        f.pointer = *at == '-';
        at += f.pointer ? 2 : 1;
        f.part = dag_copy(&dag->arena, at, (size_t)name_length(at));
        at += strlen(f.part);
    }
    f.array = *at == '[';
    for (int i = 0; i < count; i++)
        if (strcmp(fields[i].name, f.name) == 0
            && (f.part == NULL || fields[i].part == NULL || strcmp(fields[i].part, f.part) == 0))
            return count;
    if (strcmp(f.name, "terms") != 0)
        fields[count++] = f;
    return count;
}

static int find_fields(struct dag *dag, struct field *fields)
{
    int count = 0;
    for (int i = 0; i < dag->fact_count; i++)
        for (const char *at = dag->facts[i].c; (at = strstr(at, "d->")) != NULL; at += 3)
            if (at == dag->facts[i].c || name_length(at - 1) == 0
                || !(isalnum((unsigned char)at[-1]) || at[-1] == '_'))
                count = add_field(dag, fields, count, at + 3);
    return count;
}

static int first_of(const struct field *fields, int at)
{
    for (int i = 0; i < at; i++)
        if (strcmp(fields[i].name, fields[at].name) == 0)
            return 0;
    return 1;
}

static void print_number_field(struct text *out, const char *name, int array)
{
    dag_print(out, "    double %s", name);
    if (array)
        dag_print(out, "[%d]", FIELD_LENGTH);
    dag_print(out, ";\n");
}

static void print_fields(struct text *out, const struct field *fields, int count)
{
    for (int i = 0; i < count; i++) {
        if (fields[i].part == NULL || !first_of(fields, i))
            continue;
        dag_print(out, "\nstruct %s {\n", fields[i].name);
        for (int k = i; k < count; k++)
            if (strcmp(fields[k].name, fields[i].name) == 0)
                print_number_field(out, fields[k].part, fields[k].array);
        dag_print(out, "};\n");
    }
    dag_print(out,
              "\n/* What is asked about. The field `terms` is dagc's, the others are yours. */\n"
              "struct discussion {\n    struct terms terms; /* all zero: nothing is known */\n");
    for (int i = 0; i < count; i++)
        if (first_of(fields, i) && fields[i].part != NULL)
            dag_print(out, "    %sstruct %s %s%s;\n", fields[i].pointer ? "const " : "",
                      fields[i].name, fields[i].pointer ? "*" : "", fields[i].name);
        else if (first_of(fields, i))
            print_number_field(out, fields[i].name, fields[i].array);
    dag_print(out, "};\n");
}

static void print_runtime(struct skeleton *s)
{
    struct dag *dag = s->dag;
    struct field *fields = dag_alloc(&dag->arena, FIELDS_MAX * sizeof *fields);
    const char *name = dag->runtime_header, *slash = strrchr(name, '/');
    struct text *out = dag_skeleton_add(s, name);
    const char *guard = dag_c_name(dag, slash != NULL ? slash + 1 : name);
    dag_print(out,
              "/* %s - what a tool sees of the world. dagc-runtime(5) says what it must define. "
              "*/\n#ifndef ",
              name);
    dag_print_upper(out, guard);
    dag_print(out, "\n#define ");
    dag_print_upper(out, guard);
    dag_print(out,
              "\n\n#define RUNTIME_ABI %d /* as the catalog says; raised when something below "
              "changes */\n\n#include \"catalog.h\"\n\n#define TOOL static inline\n",
              dag->runtime_abi);
    print_fields(out, fields, find_fields(dag, fields));
    dag_print(out, "\n#endif\n");
}

/* ---- the program */

/* What the program calls its variable for a field: it has some of its own. */
static const char *variable_of(struct dag *dag, const char *field)
{
    static const char *const own[] = {"d", "parameters", "decisions"};
    return dag_is_c_taken(field, own, sizeof own / sizeof *own)
               ? dag_format(&dag->arena, "%s_", field)
               : field;
}

static void print_program(struct skeleton *s)
{
    struct dag *dag = s->dag;
    struct field *fields = dag_alloc(&dag->arena, FIELDS_MAX * sizeof *fields);
    int count = find_fields(dag, fields);
    const char *n = s->name, *file = s->cxx ? "main.cpp" : "main.c";
    struct text *out = dag_skeleton_add(s, file);
    dag_print(out,
              "/* %s - fills in one discussion, asks the graph and prints what it decides. */\n"
              "#include <stdio.h>\n#include <string.h>\n#include \"%s.h\"\n\n"
              "int main(%s)\n{\n    static const char *const decisions[] = {",
              file, n, s->cxx ? "" : "void");
    for (int i = 0; i < dag->decision_count; i++)
        dag_print(out, "%s\"%s\"", i > 0 ? ", " : "", dag->decisions[i].name);
    dag_print(out, "};\n    struct %s_parameters parameters;\n    struct %s_discussion d;\n", n, n);
    for (int i = 0; i < count; i++)
        if (first_of(fields, i) && fields[i].pointer)
            dag_print(out, "    struct %s_%s %s;\n", n, fields[i].name,
                      variable_of(dag, fields[i].name));
    dag_print(out, "    memset(&d, 0, sizeof d);\n");
    for (int i = 0; i < count; i++) {
        if (!first_of(fields, i) || !fields[i].pointer)
            continue;
        const char *variable = variable_of(dag, fields[i].name);
        dag_print(out, "    memset(&%s, 0, sizeof %s);\n    d.%s = &%s;\n", variable, variable,
                  fields[i].name, variable);
    }
    dag_print(out,
              "    %s_defaults(&parameters);\n"
              "    printf(\"%%s\\n\", decisions[%s_%s(&parameters, &d)]);\n    return 0;\n}\n",
              n, n, dag->verb);
}

static void print_makefile(struct skeleton *s)
{
    struct text *out = dag_skeleton_add(s, "Makefile");
    const char *n = s->name, *c = s->cxx ? "cpp" : "c", *compiler = s->cxx ? "CXX" : "CC";
    dag_print(out,
              "# make, then ./%s\nDAGC   = dagc\n"
              "%sFLAGS = -O2 -Wall -Wextra -ffp-contract=off -fno-math-errno -fno-trapping-math\n\n"
              "%s: main.%s %s.%s %s.h\n"
              "\t$(%s) $(%sFLAGS) -o $@ main.%s %s.%s -lm\n\n"
              "%s.%s %s.h: %s.dag\n"
              "\t$(DAGC) -I . --standalone --depfile %s.d -o %s.%s --header "
              "%s.h %s.dag\n\n-include %s.d\n",
              n, s->cxx ? "CXX" : "C", n, c, n, c, n, compiler, s->cxx ? "CXX" : "C", c, n, c, n, c,
              n, n, n, n, c, n, n, n);
}

void dag_emit_skeleton(struct skeleton *s)
{
    struct dag *dag = s->dag;
    if (dag->runtime_header == NULL) {
        dag_error(dag, dag_nowhere, "the catalog declares no runtime: write runtime \"%s\" abi 1;",
                  "my_runtime.h");
        return;
    }
    s->name = "first";
    print_runtime(s);
    for (int i = 0; i < dag->tool_count; i++)
        dag_emit_stub(dag, file_of(s, dag->tools[i].header), dag->tools[i].name);
    for (int i = 0; i < dag->term_count; i++)
        dag_emit_stub(dag, file_of(s, dag->terms[i].header), dag->terms[i].name);
    for (int i = 0; i < dag->tool_count; i++)
        if (dag->tools[i].wave != NULL)
            dag_emit_stub_wave(dag, file_of(s, dag->tools[i].wave), dag->tools[i].name);
    for (int i = 0; i < dag->term_count; i++)
        if (dag->terms[i].wave != NULL)
            dag_emit_stub_wave(dag, file_of(s, dag->terms[i].wave), dag->terms[i].name);
    if (dag_skeleton_graph(s) < 0)
        return;
    print_program(s);
    print_makefile(s);
}
