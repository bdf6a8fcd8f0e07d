/* emit_stub.c - the header of a tool or of a term, ready to be filled in.
 *
 * The signature is the one that flat code and the interpreter's table call, so that a stub
 * compiles at once; until it is written it gives the first answer, or 0.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "emit/emit.h"

static void print_guard(struct text *out, const char *kind, const char *name)
{
    dag_print(out, "%s_", kind);
    dag_print_upper(out, name);
    dag_print(out, "_H");
}

static void print_frame(struct text *out, const char *kind, const char *name)
{
    dag_print(out, "#ifndef ");
    print_guard(out, kind, name);
    dag_print(out, "\n#define ");
    print_guard(out, kind, name);
    dag_print(out, "\n\n");
}

static void print_needs(const struct dag *dag, struct text *out, struct span needs, const char *how)
{
    for (int i = needs.first; i < needs.first + needs.count; i++) {
        const struct term *term = &dag->terms[dag->needs[i].term];
        dag_print(out, " * It %s the term %s", how, term->name);
        if (term->levels.count > 0) {
            dag_print(out, ": term_%s(d, ", term->name);
            dag_print_constant(out, term->name,
                               dag->levels[term->levels.first + dag->needs[i].level - 1].name);
            dag_print(out, ")");
        } else
            dag_print(out, ": term_%s(d)", term->name);
        dag_print(out, "; its unit: %s.\n", dag_unit_name(&dag->types[term->type]));
    }
}

/* The header of need i of those that the tool reads, then of those that it writes. */
static const char *need_header(const struct dag *dag, const struct tool *tool, int i)
{
    const int at =
        i < tool->reads.count ? tool->reads.first + i : tool->writes.first + i - tool->reads.count;
    return dag->terms[dag->needs[at].term].header;
}

/* Each once: a term may be read and written, and terms may share a header. */
static void print_includes(const struct dag *dag, struct text *out, const struct tool *tool)
{
    dag_print(out, "#include \"%s\"\n", dag->runtime_header);
    for (int i = 0; i < tool->reads.count + tool->writes.count; i++) {
        const char *header = need_header(dag, tool, i);
        int before = 0;
        while (before < i && strcmp(need_header(dag, tool, before), header) != 0)
            before++;
        if (before == i)
            dag_print(out, "#include \"%s\"\n", header);
    }
}

/* What C calls a parameter: a catalog may call it what is a word of C, or a name of the function's
 * own. */
static void print_parameter(struct text *out, const struct parameter *parameter)
{
    static const char *const own[] = {"d", "block", "at", "count", "answers"};
    dag_print(out, "%s%s", parameter->name,
              dag_is_c_taken(parameter->name, own, sizeof own / sizeof *own) ? "_" : "");
}

static void print_tool(const struct dag *dag, struct text *out, const struct tool *tool)
{
    dag_print(out, "/* %s - %s: ", tool->header,
              tool->kind == TOOL_QUESTION ? "question" : "command");
    dag_print_comment(out, *tool->doc != '\0' ? tool->doc
                                              : "what does it ask, and how far can it be trusted?");
    dag_print(out, "\n *\n");
    for (int i = 0; i < tool->parameters.count; i++) {
        const struct parameter *p = &dag->parameters[tool->parameters.first + i];
        char low[32], high[32];
        dag_print(out, " * %s: %s, in [%s, %s]", p->name, dag_unit_name(&dag->types[p->type]),
                  dag_number(p->low, low), dag_number(p->high, high));
        dag_print(out, "%s", *p->doc != '\0' ? "; " : "");
        dag_print_comment(out, p->doc);
        dag_print(out, "\n");
    }
    print_needs(dag, out, tool->reads, "may read");
    print_needs(dag, out, tool->writes, "leaves behind");
    dag_print(out, " * It reads the discussion and writes nothing but terms. */\n");
    print_frame(out, "TOOL", tool->name);
    print_includes(dag, out, tool);
    dag_print(out, "\nTOOL enum %s_answer tool_%s(struct discussion *d", tool->name, tool->name);
    for (int i = 0; i < tool->parameters.count; i++) {
        const struct parameter *p = &dag->parameters[tool->parameters.first + i];
        dag_print(out, ", %s ", dag_c_type(dag, p->type));
        print_parameter(out, p);
    }
    dag_print(out, ")\n{\n    (void)d;\n");
    for (int i = 0; i < tool->parameters.count; i++) {
        dag_print(out, "    (void)");
        print_parameter(out, &dag->parameters[tool->parameters.first + i]);
        dag_print(out, ";\n");
    }
    dag_print(out, "    /* The answers:\n");
    for (int i = 0; i < tool->answers.count; i++) {
        const struct answer *answer = &dag->answers[tool->answers.first + i];
        dag_print(out, "     *   ");
        dag_print_constant(out, tool->name, answer->name);
        dag_print(out, ", %s\n",
                  answer->refuses ? "refuses: writes nothing" : dag_kind_name(answer->kind));
    }
    dag_print(out, "     */\n    return ");
    dag_print_constant(out, tool->name, dag->answers[tool->answers.first].name);
    dag_print(out, ";\n}\n\n#endif\n");
}

static void print_term(const struct dag *dag, struct text *out, const struct term *term)
{
    const struct type *type = &dag->types[term->type];
    const char *c = dag_c_type(dag, term->type);
    dag_print(out, "/* %s - term: ", term->header);
    dag_print_comment(
        out, *term->doc != '\0' ? term->doc : "what is it, and how far can each level be trusted?");
    dag_print(out,
              "\n * Its unit: %s. Computed when it is asked for and absent%s, else found. */\n",
              dag_unit_name(type), term->levels.count > 0 ? " or coarser" : "");
    print_frame(out, "TERM", term->name);
    dag_print(out, "#include \"%s\"\n\nTOOL %s%s%sterm_%s(struct discussion *d",
              dag->runtime_header, type->length > 1 ? "const " : "", c,
              type->length > 1 ? " *" : " ", term->name);
    if (term->levels.count > 0)
        dag_print(out, ", enum %s_level level", term->name);
    dag_print(out, ")\n{\n    if (d->terms.%s_level < ", term->name);
    if (term->levels.count > 0)
        dag_print(out, "level");
    else {
        dag_print_upper(out, term->name);
        dag_print(out, "_PRESENT");
    }
    dag_print(out, ") {\n        d->terms.%s%s = 0; /* compute it here", term->name,
              type->length > 1 ? "[0]" : "");
    for (int i = 0; i < term->levels.count; i++) {
        dag_print(out, "%s", i == 0 ? ": " : ", ");
        dag_print_constant(out, term->name, dag->levels[term->levels.first + i].name);
    }
    dag_print(out, " */\n        d->terms.%s_level = ", term->name);
    if (term->levels.count > 0)
        dag_print(out, "(unsigned char)level");
    else {
        dag_print_upper(out, term->name);
        dag_print(out, "_PRESENT");
    }
    dag_print(out, ";\n    }\n    return d->terms.%s;\n}\n\n#endif\n", term->name);
}

/* The file of a wave form of a tool or term, up to the arguments that all have. */
static void print_wave_head(struct text *out, const char *kind, const char *wave,
                            const char *header, const char *function, const char *name)
{
    dag_print(out,
              "/* %s - the same as %s of many pairs at once: block[at[k]], k below count. */\n",
              wave, header);
    print_frame(out, kind, name);
    dag_print(out,
              "#include <stdint.h>\n#include \"%s\"\n\nstatic inline void %s%s(struct "
              "discussion *block, const uint16_t *at, int count",
              header, function, name);
}

/* By the tool itself, pair by pair: what --release=wave calls until somebody writes a faster one.
 */
static void print_tool_wave(const struct dag *dag, struct text *out, const struct tool *tool)
{
    print_wave_head(out, "TOOL_WAVE", tool->wave, tool->header, "wave_", tool->name);
    for (int i = 0; i < tool->parameters.count; i++) {
        const struct parameter *p = &dag->parameters[tool->parameters.first + i];
        dag_print(out, ", const %s *", dag_c_type(dag, p->type));
        print_parameter(out, p);
    }
    dag_print(out,
              ", unsigned char *answers)\n{\n    int k_;\n    for (k_ = 0; k_ < count; k_++)\n"
              "        answers[k_] = (unsigned char)tool_%s(&block[at[k_]]",
              tool->name);
    for (int i = 0; i < tool->parameters.count; i++) {
        dag_print(out, ", ");
        print_parameter(out, &dag->parameters[tool->parameters.first + i]);
        dag_print(out, "[k_]");
    }
    dag_print(out, ");\n}\n\n#endif\n");
}

static void print_term_wave(struct text *out, const struct term *term)
{
    const int levels = term->levels.count > 0;
    print_wave_head(out, "TERM_WAVE", term->wave, term->header, "wave_term_", term->name);
    if (levels)
        dag_print(out, ", enum %s_level level", term->name);
    dag_print(
        out,
        ")\n{\n    int k;\n    for (k = 0; k < count; k++)\n        (void)term_%s(&block[at[k]]"
        "%s);\n}\n\n#endif\n",
        term->name, levels ? ", level" : "");
}

void dag_emit_stub_wave(struct dag *dag, struct text *out, const char *name)
{
    int tool = dag_find(&dag->tool_names, name);
    if (tool >= 0)
        print_tool_wave(dag, out, &dag->tools[tool]);
    else
        print_term_wave(out, &dag->terms[dag_find(&dag->term_names, name)]);
}

void dag_emit_stub(struct dag *dag, struct text *out, const char *name)
{
    int tool = dag_find(&dag->tool_names, name), term = dag_find(&dag->term_names, name);
    if (tool >= 0)
        print_tool(dag, out, &dag->tools[tool]);
    else if (term >= 0)
        print_term(dag, out, &dag->terms[term]);
    else {
        struct suggestion suggestion = {name, NULL, 0};
        dag_error(dag, dag_nowhere, "the catalog declares no tool and no term '%s'", name);
        for (int i = 0; i < dag->tool_count; i++)
            dag_suggest(&suggestion, dag->tools[i].name);
        for (int i = 0; i < dag->term_count; i++)
            dag_suggest(&suggestion, dag->terms[i].name);
        dag_note_suggestion(dag, &suggestion);
    }
}
