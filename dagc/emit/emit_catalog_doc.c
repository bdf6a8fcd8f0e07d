/* emit_catalog_doc.c - a catalog's documentation, in Markdown.
 *
 * A chapter each for decisions, tools, terms and types, in the order of the catalog: from what
 * an oracle is to decide to what things are measured in. What a tool or term computes, its formula,
 * source and failings, is said in one place, the comment that opens its header; it is quoted here.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "analyse/guard.h"
#include "emit/headers.h"

/* Text that Markdown shows as it is, also in a table. */
static void print_escaped(struct text *out, const char *text)
{
    for (; *text != '\0'; text++)
        dag_print(out, strchr("\\`*_[]<>|#&", *text) != NULL ? "\\%c" : "%c", *text);
}

static void print_doc(struct text *out, const char *doc)
{
    if (*doc != '\0') {
        print_escaped(out, doc);
        dag_print(out, "\n\n");
    }
}

/* The comment that opens a header, without its frame and its licence line; nothing when there is
 * none. */
static void print_comment(struct dag *dag, struct text *out, const char *header,
                          struct where declared)
{
    const char *path, *end,
        *text = dag_find_header(dag, header, dag_source_folder(dag, declared.source), BESIDE_LAST,
                                dag_runtime_is_ours(dag), &path);
    if (text == NULL || strncmp(text, "/*", 2) != 0 || (end = strstr(text, "*/")) == NULL)
        return;
    dag_print(out, "```text\n");
    for (text += 2; text < end;) {
        const char *stop = memchr(text, '\n', (size_t)(end - text));
        if (stop == NULL)
            stop = end;
        for (int margin = 0; text < stop && margin < 3 && strchr(" *", *text) != NULL; margin++)
            text++;
        if (strncmp(text, "SPDX-", 5) != 0)
            for (const char *at = text; at <= stop; at++)
                dag_print(out, "%c", at < stop ? *at : '\n');
        text = stop + 1;
    }
    dag_print(out, "```\n\n");
}

static void print_needs(struct dag *dag, struct text *out, const char *what, struct span needs)
{
    const char *gap = " ";
    if (needs.count == 0)
        return;
    dag_print(out, "%s", what);
    for (int i = needs.first; i < needs.first + needs.count; i++) {
        const struct need *need = &dag->needs[i];
        dag_print(out, need->level > 0 ? "%s`%s`" : "%s`%s` where it is known", gap,
                  need->level > 0 ? dag_need_text(dag, need) : dag->terms[need->term].name);
        gap = ", ";
    }
    dag_print(out, ".\n\n");
}

static void print_decisions(struct dag *dag, struct text *out)
{
    dag_print(out, "## Decisions\n\nThe leaves of every graph.\n\n");
    for (int i = 0; i < dag->decision_count; i++) {
        const struct decision_tool *decision = &dag->decisions[i];
        dag_print(out, "### %s\n\n", decision->name);
        print_doc(out, decision->doc);
        print_needs(dag, out, "Every path to it must provide", decision->reads);
        if (decision->subdivides)
            dag_print(out, "Subdivides: every path to it must hold an answer that allows it.\n\n");
    }
}

static void print_parameters(struct dag *dag, struct text *out, struct span parameters)
{
    if (parameters.count == 0)
        return;
    dag_print(out, "| parameter | type | unit | default | range | |\n|---|---|---|---|---|---|\n");
    for (int i = parameters.first; i < parameters.first + parameters.count; i++) {
        const struct parameter *parameter = &dag->parameters[i];
        const struct type *type = &dag->types[parameter->type];
        char value[32], low[32], high[32];
        dag_print(out, "| `%s` | %s | %s | %s | ", parameter->name, type->name, type->unit_text,
                  (parameter->given & PARAMETER_VALUE) != 0 ? dag_number(parameter->value, value)
                                                            : "none");
        if ((parameter->given & PARAMETER_RANGE) != 0)
            dag_print(out, "%s to %s", dag_number(parameter->low, low),
                      dag_number(parameter->high, high));
        dag_print(out, " | ");
        print_escaped(out, parameter->doc);
        dag_print(out, " |\n");
    }
    dag_print(out, "\n");
}

static void print_tools(struct dag *dag, struct text *out)
{
    dag_print(out, "## Tools\n\n");
    for (int i = 0; i < dag->tool_count; i++) {
        const struct tool *tool = &dag->tools[i];
        dag_print(out, "### %s(", tool->name);
        for (int p = 0; p < tool->parameters.count; p++)
            dag_print(out, "%s%s", p > 0 ? ", " : "",
                      dag->parameters[tool->parameters.first + p].name);
        dag_print(out, ")\n\n");
        print_doc(out, tool->doc);
        dag_print(out, "%s%s, in `%s`.\n\n",
                  tool->kind == TOOL_COMMAND ? "A command" : "A question",
                  tool->guards.count > 0 ? " and a guard" : "", tool->header);
        if (tool->keeps != KEEPS_NOTHING)
            dag_print(out, "Statistics keep %s.\n\n",
                      tool->keeps == KEEPS_COUNT
                          ? "how often its argument has each value"
                          : "a histogram of its first argument, by the second");
        print_comment(dag, out, tool->header, tool->where);
        print_parameters(dag, out, tool->parameters);
        int guards = tool->guards.count > 0;
        dag_print(out, "| answer | kind |%s\n|---|---|%s\n", guards ? " allows |" : "",
                  guards ? "---|" : "");
        for (int a = 0; a < tool->answers.count; a++) {
            const struct answer *answer = &dag->answers[tool->answers.first + a];
            dag_print(out, "| `%s` | %s |", answer->name,
                      answer->refuses ? "refuses" : dag_kind_name(answer->kind));
            if (guards)
                dag_print(out, " %s |", dag_guard_allows(dag, tool, a, -1));
            dag_print(out, "\n");
        }
        if (tool->by.count > 0)
            dag_print(out, "\nIt allows that where %s above 0.\n", dag_guard_limits(dag, tool, ""));
        if (tool->after.name != NULL)
            dag_print(out, "\nIt allows that behind `%s` of `%s`.\n",
                      dag_label_list(dag, tool->after_answers), tool->after.name);
        dag_print(out, "\n");
        print_needs(dag, out, "Reads", tool->reads);
        print_needs(dag, out, "Writes", tool->writes);
    }
}

/* "Type `ratio`, in m2. From 0 to 1." */
static void print_value(const struct dag *dag, struct text *out, int type, double low, double high)
{
    const char *unit = dag->types[type].unit_text;
    char from[32], to[32];
    dag_print(out, "Type `%s`%s%s.", dag->types[type].name, *unit != '\0' ? ", in " : "", unit);
    if (!isinf(low) || !isinf(high))
        dag_print(out, " From %s to %s.", dag_number(low, from), dag_number(high, to));
}

static void print_terms(struct dag *dag, struct text *out)
{
    dag_print(out, "## Terms\n\nWhat a discussion may know; levels from the coarsest on.\n\n");
    for (int i = 0; i < dag->term_count; i++) {
        const struct term *term = &dag->terms[i];
        const char *gap = " Levels: ";
        dag_print(out, "### %s\n\n", term->name);
        print_doc(out, term->doc);
        print_value(dag, out, term->type, term->low, term->high);
        for (int l = term->levels.first; l < term->levels.first + term->levels.count; l++) {
            dag_print(out, "%s`%s`", gap, dag->levels[l].name);
            gap = " < ";
        }
        dag_print(out, "%s\n\n", term->levels.count > 0 ? "." : "");
        print_comment(dag, out, term->header, term->where);
    }
}

static void print_facts(const struct dag *dag, struct text *out)
{
    if (dag->fact_count > 0)
        dag_print(out,
                  "## Facts\n\nNumbers that are there for the asking, in computed arguments.\n\n");
    for (int i = 0; i < dag->fact_count; i++) {
        const struct fact *fact = &dag->facts[i];
        dag_print(out, "### %s\n\n", fact->name);
        print_doc(out, fact->doc);
        print_value(dag, out, fact->type, fact->low, fact->high);
        dag_print(out, "\n\n");
    }
}

static void print_roles(const struct dag *dag, struct text *out)
{
    if (dag->role_count > 0)
        dag_print(
            out,
            "## Roles\n\nWhat a parameter of an oracle may be to the program that asks it.\n\n");
    for (int i = 0; i < dag->role_count; i++) {
        const struct role *role = &dag->roles[i];
        dag_print(out, "### %s\n\n", role->name);
        print_doc(out, role->doc);
        print_value(dag, out, role->type, -INFINITY, INFINITY);
        dag_print(out, "\n\n");
    }
}

static void print_callbacks(struct dag *dag, struct text *out)
{
    if (dag->callback_count > 0)
        dag_print(out, "## Externs\n\nC functions of the user's that give a number.\n\n");
    for (int i = 0; i < dag->callback_count; i++) {
        const struct callback *callback = &dag->callbacks[i];
        dag_print(out, "### %s\n\n", callback->name);
        print_doc(out, callback->doc);
        print_value(dag, out, callback->type, callback->low, callback->high);
        dag_print(out, "\n\n");
        print_needs(dag, out, "Reads", callback->reads);
    }
}

static void print_types(const struct dag *dag, struct text *out)
{
    dag_print(out, "## Types\n\n| type | base | unit |\n|---|---|---|\n");
    for (int i = 0; i < dag->type_count; i++) {
        const struct type *type = &dag->types[i];
        dag_print(out, "| `%s` | %s", type->name, type->base == BASE_INTEGER ? "integer" : "real");
        if (type->length > 1)
            dag_print(out, "\\[%d\\]", type->length);
        dag_print(out, " | %s |\n", type->unit_text);
    }
}

void dag_emit_catalog_doc(struct dag *dag, struct text *out)
{
    dag_print(out, "<!-- Generated by dagc %s from %s: do not edit. -->\n\n", DAGC_VERSION,
              dag->sources[dag->runtime_where.source].base);
    dag_print(out, "# The catalog\n\nFor runtimes with `%s`, ABI %d.\n\n", dag->runtime_header,
              dag->runtime_abi);
    print_decisions(dag, out);
    print_tools(dag, out);
    print_terms(dag, out);
    print_facts(dag, out);
    print_roles(dag, out);
    print_callbacks(dag, out);
    print_types(dag, out);
}
