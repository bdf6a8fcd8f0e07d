/* resolve_guards.c - the names in a tool's `guards` to indices.
 *
 * The tool that a guard comes after may be declared later, so all tools' names and answers are
 * known before.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "check/resolve.h"

/* Which of the tool's answers has the name? -1, after an error. */
static int find_answer(struct dag *dag, const struct tool *tool, const struct label *label)
{
    struct suggestion suggestion = {label->name, NULL, 0};
    for (int i = 0; i < tool->answers.count; i++) {
        const char *name = dag->answers[tool->answers.first + i].name;
        if (strcmp(name, label->name) == 0)
            return i;
        dag_suggest(&suggestion, name);
    }
    dag_error(dag, label->where, "the tool '%s' has no answer '%s'", tool->name, label->name);
    dag_note_suggestion(dag, &suggestion);
    return -1;
}

static int find_decision(struct dag *dag, const struct label *label)
{
    int index = dag_find(&dag->decision_names, label->name);
    if (index < 0) {
        struct suggestion suggestion = {label->name, NULL, 0};
        if (dag->lost)
            return -1;
        dag_error(dag, label->where, "unknown decision '%s'", label->name);
        for (int i = 0; i < dag->decision_count && !dag_errors_full(dag); i++)
            dag_suggest(&suggestion, dag->decisions[i].name);
        dag_note_suggestion(dag, &suggestion);
    } else if (!dag->decisions[index].subdivides) {
        dag_error(dag, label->where, "'%s' does not subdivide: it needs no guard", label->name);
        dag_note(dag, dag->decisions[index].where, "declared here");
    }
    return index;
}

static void resolve_by(struct dag *dag, const struct tool *tool)
{
    for (int i = tool->by.first; i < tool->by.first + tool->by.count; i++) {
        const struct label *label = &dag->labels[i];
        struct suggestion suggestion = {label->name, NULL, 0};
        int found = 0;
        for (int p = 0; p < tool->parameters.count && !found; p++) {
            const char *name = dag->parameters[tool->parameters.first + p].name;
            found = strcmp(name, label->name) == 0;
            dag_suggest(&suggestion, name);
        }
        if (found)
            continue;
        dag_error(dag, label->where, "the tool '%s' has no parameter '%s'", tool->name,
                  label->name);
        dag_note_suggestion(dag, &suggestion);
    }
}

static void resolve_after(struct dag *dag, struct tool *tool)
{
    tool->after_index = dag_find(&dag->tool_names, tool->after.name);
    if (tool->after_index < 0) {
        struct suggestion suggestion = {tool->after.name, NULL, 0};
        if (dag->lost)
            return;
        dag_error(dag, tool->after.where, "unknown tool '%s'", tool->after.name);
        for (int i = 0; i < dag->tool_count && !dag_errors_full(dag); i++)
            dag_suggest(&suggestion, dag->tools[i].name);
        dag_note_suggestion(dag, &suggestion);
        return;
    }
    for (int i = 0; i < tool->after_answers.count; i++)
        find_answer(dag, &dag->tools[tool->after_index],
                    &dag->labels[tool->after_answers.first + i]);
}

void dag_resolve_guards(struct dag *dag, struct tool *tool)
{
    for (int i = tool->guards.first; i < tool->guards.first + tool->guards.count; i++) {
        struct guard *guard = &dag->guards[i];
        guard->answer_index = find_answer(dag, tool, &guard->answer);
        guard->decision_index = find_decision(dag, &guard->decision);
    }
    resolve_by(dag, tool);
    if (tool->after.name != NULL)
        resolve_after(dag, tool);
}
