/* resolve.c - an oracle's names to indices, its rules to arcs.
 *
 * After this pass every node with a known tool has one argument per parameter of the tool and
 * one arc per answer, in the tool's order. What could not be resolved has been reported and is
 * left at -1 or TARGET_NONE.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "resolve.h"

/* The names that one oracle declares. */
struct scope {
    struct oracle_graph *oracle;
    struct table nodes, parameters;
};

static void declare_nodes(struct dag *dag, struct scope *scope)
{
    struct span span = scope->oracle->nodes;
    for (int i = span.first; i < span.first + span.count; i++) {
        const struct node *node = &dag->nodes[i];
        int decision = dag_find(&dag->decision_names, node->name);
        if (decision >= 0) {
            dag_error(dag, node->where, "'%s' is a decision and cannot name a node", node->name);
            dag_note(dag, dag->decisions[decision].where, "declared here");
        }
        int first = dag_put(&dag->arena, &scope->nodes, node->name, i);
        if (first >= 0)
            dag_resolve_twice(dag, "node", node->name, node->where, dag->nodes[first].where);
    }
}

static void declare_parameters(struct dag *dag, struct scope *scope)
{
    struct span span = scope->oracle->parameters;
    dag_resolve_parameters(dag, span);
    for (int i = span.first; i < span.first + span.count; i++) {
        struct parameter *parameter = &dag->parameters[i];
        dag_put(&dag->arena, &scope->parameters, parameter->name, i);
        if (dag_is_c_word(parameter->name)) {
            dag_error(dag, parameter->where,
                      "'%s' is a word of C or C++ and cannot name a parameter", parameter->name);
            dag_note(dag, dag_nowhere, "choose another name, such as '%s_'", parameter->name);
        }
        if (!parameter->bad && (parameter->given & PARAMETER_VALUE) == 0) {
            dag_error(dag, parameter->where, "the parameter '%s' has no default", parameter->name);
            dag_note(dag, dag_nowhere, "write: param %s : %s = VALUE;", parameter->name,
                     parameter->type_name);
            parameter->bad = 1;
        }
    }
}

static void resolve_target(struct dag *dag, const struct scope *scope, struct target *target)
{
    int node = dag_find(&scope->nodes, target->name);
    int decision = dag_find(&dag->decision_names, target->name);
    if (node >= 0) {
        target->kind = TARGET_NODE;
        target->index = node;
    } else if (decision >= 0) {
        target->kind = TARGET_DECISION;
        target->index = decision;
    } else if (!scope->oracle->bad) {
        struct suggestion suggestion = {target->name, NULL, 0};
        struct span span = scope->oracle->nodes;
        dag_error(dag, target->where, "no node and no decision is called '%s'", target->name);
        if (dag_errors_full(dag))
            return;
        for (int i = 0; i < dag->decision_count; i++)
            dag_suggest(&suggestion, dag->decisions[i].name);
        for (int i = span.first; i < span.first + span.count; i++)
            dag_suggest(&suggestion, dag->nodes[i].name);
        dag_note_suggestion(dag, &suggestion);
    }
}

static void unknown_tool(struct dag *dag, struct node *node)
{
    struct suggestion suggestion = {node->tool_name, NULL, 0};
    node->bad = 1;
    dag_error(dag, node->tool_where, "unknown tool '%s'", node->tool_name);
    for (int i = 0; i < dag->tool_count && !dag_errors_full(dag); i++)
        dag_suggest(&suggestion, dag->tools[i].name);
    dag_note_suggestion(dag, &suggestion);
}

/* ---- arguments */

static void unknown_argument(struct dag *dag, const struct tool *tool,
                             const struct argument *argument)
{
    struct suggestion suggestion = {argument->name, NULL, 0};
    if (tool->parameters.count == 0) {
        dag_error(dag, argument->where, "%s takes no arguments", tool->name);
        return;
    }
    dag_error(dag, argument->where, "%s has no parameter '%s'", tool->name, argument->name);
    for (int i = 0; i < tool->parameters.count; i++)
        dag_suggest(&suggestion, dag->parameters[tool->parameters.first + i].name);
    dag_note_suggestion(dag, &suggestion);
}

static void resolve_value(struct dag *dag, const struct scope *scope, int index)
{
    struct expression *expression = &dag->expressions[index];
    if (expression->kind != EXPRESSION_PARAMETER)
        return;
    expression->parameter = dag_find(&scope->parameters, expression->name);
    if (expression->parameter >= 0 || scope->oracle->bad)
        return;
    struct suggestion suggestion = {expression->name, NULL, 0};
    struct span span = scope->oracle->parameters;
    dag_error(dag, expression->where, "the oracle '%s' has no parameter '%s'", scope->oracle->name,
              expression->name);
    if (dag_errors_full(dag))
        return;
    for (int i = span.first; i < span.first + span.count; i++)
        dag_suggest(&suggestion, dag->parameters[i].name);
    dag_note_suggestion(dag, &suggestion);
}

/* The parameter of a tool by its name, -1: none. */
static int parameter_of(const struct dag *dag, const struct tool *tool, const char *name)
{
    for (int i = tool->parameters.first; i < tool->parameters.first + tool->parameters.count; i++)
        if (strcmp(dag->parameters[i].name, name) == 0)
            return i;
    return -1;
}

/* The argument written for a parameter, -1: none. */
static int written_for(const struct dag *dag, const struct node *node, int parameter)
{
    for (int i = node->written.first; i < node->written.first + node->written.count; i++)
        if (dag->arguments[i].parameter == parameter)
            return i;
    return -1;
}

/* Finds the parameter of each written argument; 0: some have none. */
static int resolve_written(struct dag *dag, const struct scope *scope, const struct node *node)
{
    const struct tool *tool = &dag->tools[node->tool];
    int ok = 1;
    for (int i = node->written.first; i < node->written.first + node->written.count; i++) {
        struct argument *argument = &dag->arguments[i];
        int parameter = parameter_of(dag, tool, argument->name);
        int first = parameter < 0 ? -1 : written_for(dag, node, parameter);
        if (parameter < 0) {
            unknown_argument(dag, tool, argument);
            ok = 0;
        } else if (first >= 0)
            dag_resolve_twice(dag, "argument", argument->name, argument->where,
                              dag->arguments[first].where);
        else
            argument->parameter = parameter;
        resolve_value(dag, scope, argument->expression);
    }
    return ok;
}

static int default_value(struct dag *dag, int parameter)
{
    int index = ADD(dag, expressions, expression_count);
    struct expression *expression = &dag->expressions[index];
    expression->kind = EXPRESSION_NUMBER;
    expression->number = dag->parameters[parameter].value;
    expression->where = dag->parameters[parameter].value_where;
    expression->parameter = expression->left = expression->right = -1;
    return index;
}

static void resolve_arguments(struct dag *dag, const struct scope *scope, struct node *node)
{
    const struct tool *tool = &dag->tools[node->tool];
    int ok = resolve_written(dag, scope, node);
    node->arguments.first = dag->argument_count;
    for (int p = tool->parameters.first; p < tool->parameters.first + tool->parameters.count; p++) {
        const struct parameter *parameter = &dag->parameters[p];
        int found = written_for(dag, node, p);
        struct argument argument = {parameter->name, node->where, p, -1};
        if (found >= 0)
            argument = dag->arguments[found];
        else if ((parameter->given & PARAMETER_VALUE) != 0)
            argument.expression = default_value(dag, p);
        else if (ok && !node->bad) {
            dag_error(dag, node->tool_where, "%s needs the argument '%s', it has no default",
                      tool->name, parameter->name);
            dag_note(dag, parameter->where, "declared here");
        }
        int index = ADD(dag, arguments, argument_count);
        dag->arguments[index] = argument;
        node->arguments.count++;
    }
}

/* ---- arcs */

static int answer_of(const struct dag *dag, const struct tool *tool, const char *name)
{
    for (int i = 0; i < tool->answers.count; i++)
        if (strcmp(dag->answers[tool->answers.first + i].name, name) == 0)
            return i;
    return -1;
}

/* Says so; the answer that was probably meant, -1: none comes near. */
static int unknown_answer(struct dag *dag, const struct tool *tool, const struct label *label)
{
    struct suggestion suggestion = {label->name, NULL, 0};
    const char *list = "";
    dag_error(dag, label->where, "%s never answers '%s'", tool->name, label->name);
    if (dag_errors_full(dag))
        return -1;
    for (int i = 0; i < tool->answers.count; i++) {
        const char *name = dag->answers[tool->answers.first + i].name;
        dag_suggest(&suggestion, name);
        list = i == 0 ? name : i < 12 ? dag_format(&dag->arena, "%s, %s", list, name) : list;
    }
    dag_note_suggestion(dag, &suggestion);
    dag_note(dag, dag_nowhere, "its answers are: %s%s", list, tool->answers.count > 12 ? ", ..." : "");
    return suggestion.best == NULL ? -1 : answer_of(dag, tool, suggestion.best);
}

/* Enters one rule into the arcs of its answers. */
static void resolve_rule(struct dag *dag, const struct node *node, const struct rule *rule)
{
    const struct tool *tool = &dag->tools[node->tool];
    for (int i = rule->labels.first; i < rule->labels.first + rule->labels.count; i++) {
        const struct label *label = &dag->labels[i];
        int answer = answer_of(dag, tool, label->name), known = answer >= 0;
        if (!known)
            answer = unknown_answer(dag, tool, label);
        if (answer < 0)
            continue;
        struct arc *arc = &dag->arcs[node->arcs.first + answer];
        if (arc->where.source >= 0 && !known)
            continue;
        if (arc->where.source >= 0) {
            dag_error(dag, label->where, "the answer '%s' is mapped twice", label->name);
            dag_note(dag, arc->where, "first here, to '%s'", arc->target.name);
        } else {
            arc->target = rule->target;
            arc->where = label->where;
        }
    }
}

/* `otherwise` takes the answers that no rule names; without it none may be left. */
static void resolve_rest(struct dag *dag, const struct node *node, const struct rule *otherwise)
{
    const struct tool *tool = &dag->tools[node->tool];
    const char *missing = NULL;
    int count = 0;
    for (int i = 0; i < node->arcs.count; i++) {
        struct arc *arc = &dag->arcs[node->arcs.first + i];
        const char *name = dag->answers[tool->answers.first + i].name;
        if (arc->where.source >= 0)
            continue;
        if (otherwise != NULL) {
            arc->target = otherwise->target;
            arc->where = otherwise->where;
        } else if (!dag_errors_full(dag)) {
            missing = count == 0 ? name : dag_format(&dag->arena, "%s | %s", missing, name);
            count++;
        }
    }
    if (count > 0 && !node->bad) {
        dag_error(dag, node->where, "the node '%s' says nothing about the answer%s %s", node->name,
                  count > 1 ? "s" : "", missing);
        dag_note(dag, dag_nowhere, "add: %s -> TARGET;  or: otherwise -> TARGET;", missing);
    }
}

static void resolve_node(struct dag *dag, const struct scope *scope, struct node *node)
{
    const struct rule *otherwise = NULL;
    node->tool = node->tool_name == NULL ? -1 : dag_find(&dag->tool_names, node->tool_name);
    if (node->tool < 0 && node->tool_name != NULL)
        unknown_tool(dag, node);
    if (node->tool >= 0) {
        int answers = dag->tools[node->tool].answers.count;
        resolve_arguments(dag, scope, node);
        node->arcs.first = dag->arc_count;
        node->arcs.count = answers;
        for (int i = 0; i < answers; i++) {
            int arc = ADD(dag, arcs, arc_count);
            dag->arcs[arc].target.index = -1;
            dag->arcs[arc].where = dag_nowhere;
        }
    }
    for (int i = node->rules.first; i < node->rules.first + node->rules.count; i++) {
        struct rule *rule = &dag->rules[i];
        resolve_target(dag, scope, &rule->target);
        if (rule->labels.count > 0) {
            if (node->tool >= 0)
                resolve_rule(dag, node, rule);
        } else if (otherwise == NULL)
            otherwise = rule;
        else {
            dag_error(dag, rule->where, "a second 'otherwise'");
            dag_note(dag, otherwise->where, "the first is here");
        }
    }
    if (node->tool >= 0)
        resolve_rest(dag, node, otherwise);
}

static void resolve_start(struct dag *dag, const struct scope *scope)
{
    struct oracle_graph *oracle = scope->oracle;
    if (oracle->start.name == NULL) {
        if (oracle->bad)
            return;
        dag_error(dag, oracle->where, "the oracle '%s' has no start", oracle->name);
        dag_note(dag, dag_nowhere, "add: start %s;", oracle->nodes.count > 0
                     ? dag->nodes[oracle->nodes.first].name : "NODE");
        return;
    }
    resolve_target(dag, scope, &oracle->start);
    if (oracle->start.kind == TARGET_DECISION)
        dag_error(dag, oracle->start.where, "an oracle starts with a node, '%s' is a decision",
                  oracle->start.name);
}

void dag_resolve(struct dag *dag)
{
    for (int i = 0; i < dag->oracle_count; i++) {
        struct oracle_graph *oracle = &dag->oracles[i];
        struct scope scope = {oracle, {NULL, NULL, 0, 0}, {NULL, NULL, 0, 0}};
        int first = dag_put(&dag->arena, &dag->oracle_names, oracle->name, i);
        if (first >= 0)
            dag_resolve_twice(dag, "oracle", oracle->name, oracle->where, dag->oracles[first].where);
        declare_parameters(dag, &scope);
        declare_nodes(dag, &scope);
        resolve_start(dag, &scope);
        for (int n = oracle->nodes.first; n < oracle->nodes.first + oracle->nodes.count; n++)
            resolve_node(dag, &scope, &dag->nodes[n]);
    }
}
