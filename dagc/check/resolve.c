/* resolve.c - the names in oracles and branches to indices, their rules to arcs.
 *
 * After this pass every draft with a known tool or branch has one argument per parameter of it and
 * one arc per answer or exit, in its order; nodes are named by their drafts. What could not be
 * resolved has been reported and is left at -1 or TARGET_NONE. A branch is resolved once, however
 * many nodes use it.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "check/resolve.h"

static void declare_nodes(struct dag *dag, struct scope *scope)
{
    struct span span = scope->graph->drafts;
    for (int i = span.first; i < span.first + span.count; i++) {
        const struct node *node = &dag->drafts[i];
        int exit = dag_find(&scope->exits, node->name);
        if (exit >= 0) {
            dag_error(dag, node->where, "'%s' is an exit of this graph and cannot name a node",
                      node->name);
            dag_note(dag, dag->answers[scope->graph->exits.first + exit].where, "declared here");
        }
        int decision = dag_find(&dag->decision_names, node->name);
        if (decision >= 0) {
            dag_error(dag, node->where, "'%s' is a decision and cannot name a node", node->name);
            dag_note(dag, dag->decisions[decision].where, "declared here");
        }
        int first = dag_put(&dag->arena, &scope->nodes, node->name, i);
        if (first >= 0)
            dag_resolve_twice(dag, "node", node->name, node->where, dag->drafts[first].where);
    }
}

static void declare_exits(struct dag *dag, struct scope *scope)
{
    struct span span = scope->graph->exits;
    if (span.count > ANSWERS_MAX) {
        dag_error(dag, scope->graph->where, "a graph has at most %d exits", ANSWERS_MAX);
        scope->graph->exits.count = ANSWERS_MAX;
        return;
    }
    dag_resolve_answers(dag, span, "exit");
    for (int i = 0; i < span.count; i++) {
        const struct answer *exit = &dag->answers[span.first + i];
        if (exit->refuses)
            dag_error(dag, exit->where, "the exit '%s' cannot refuse: a command's answer does",
                      exit->name);
        int decision = dag_find(&dag->decision_names, exit->name);
        dag_put(&dag->arena, &scope->exits, exit->name, i);
        if (decision >= 0) {
            dag_error(dag, exit->where, "'%s' is a decision and cannot name an exit", exit->name);
            dag_note(dag, dag->decisions[decision].where, "declared here");
        }
    }
}

static void declare_parameters(struct dag *dag, struct scope *scope)
{
    struct span span = scope->graph->parameters;
    dag_resolve_parameters(dag, span, !scope->graph->branch);
    for (int i = span.first; i < span.first + span.count; i++)
        dag_refuse_any_unit(dag, dag->parameters[i].type, dag->parameters[i].type_where);
    for (int i = span.first; i < span.first + span.count; i++) {
        struct parameter *parameter = &dag->parameters[i];
        dag_put(&dag->arena, &scope->parameters, parameter->name, i);
        if (scope->graph->branch)
            continue;
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
    int exit = dag_find(&scope->exits, target->name);
    int decision = dag_find(&dag->decision_names, target->name);
    if (node >= 0) {
        target->kind = TARGET_NODE;
        target->index = node;
    } else if (exit >= 0) {
        target->kind = TARGET_EXIT;
        target->index = exit;
    } else if (decision >= 0) {
        target->kind = TARGET_DECISION;
        target->index = decision;
    } else if (!scope->graph->bad) {
        struct suggestion suggestion = {target->name, NULL, 0};
        struct span span = scope->graph->drafts, exits = scope->graph->exits;
        dag_error(dag, target->where, "no node%s and no decision is called '%s'",
                  scope->graph->branch ? ", no exit" : "", target->name);
        if (dag_errors_full(dag))
            return;
        for (int i = 0; i < dag->decision_count; i++)
            dag_suggest(&suggestion, dag->decisions[i].name);
        for (int i = exits.first; i < exits.first + exits.count; i++)
            dag_suggest(&suggestion, dag->answers[i].name);
        for (int i = span.first; i < span.first + span.count; i++)
            dag_suggest(&suggestion, dag->drafts[i].name);
        dag_note_suggestion(dag, &suggestion);
    }
}

static void unknown_tool(struct dag *dag, struct node *node)
{
    struct suggestion suggestion = {node->tool_name, NULL, 0};
    node->bad = 1;
    if (dag->lost)
        return;
    dag_error(dag, node->tool_where, "unknown tool '%s'", node->tool_name);
    for (int i = 0; i < dag->tool_count && !dag_errors_full(dag); i++)
        dag_suggest(&suggestion, dag->tools[i].name);
    for (int i = 0; i < dag->branch_count && !dag_errors_full(dag); i++)
        dag_suggest(&suggestion, dag->branches[i].name);
    dag_note_suggestion(dag, &suggestion);
}

/* What a node uses: a tool or a branch. */
struct callee {
    const char *name;
    struct span parameters, answers;
};

static struct callee callee_of(const struct dag *dag, const struct node *node)
{
    if (node->branch >= 0) {
        const struct oracle_graph *branch = &dag->branches[node->branch];
        return (struct callee){branch->name, branch->parameters, branch->exits};
    }
    const struct tool *tool = &dag->tools[node->tool];
    return (struct callee){tool->name, tool->parameters, tool->answers};
}

/* ---- arguments */

static void unknown_argument(struct dag *dag, const struct callee *tool,
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

/* The parameter of a tool by its name, -1: none. */
static int parameter_of(const struct dag *dag, const struct callee *tool, const char *name)
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
    const struct callee callee = callee_of(dag, node), *tool = &callee;
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
        dag_resolve_expression(dag, scope, argument->expression);
    }
    return ok;
}

static int default_value(struct dag *dag, int parameter)
{
    struct expression e = {0};
    e.kind = EXPRESSION_NUMBER;
    e.number = dag->parameters[parameter].value;
    e.where = dag->parameters[parameter].value_where;
    e.parameter = e.index = e.left = e.right = -1;
    return dag_add_expression(dag, &e);
}

static void resolve_arguments(struct dag *dag, const struct scope *scope, struct node *node)
{
    const struct callee callee = callee_of(dag, node), *tool = &callee;
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

static int answer_of(const struct dag *dag, const struct callee *tool, const char *name)
{
    for (int i = 0; i < tool->answers.count; i++)
        if (strcmp(dag->answers[tool->answers.first + i].name, name) == 0)
            return i;
    return -1;
}

/* Says so; the answer that was probably meant, -1: none comes near. */
static int unknown_answer(struct dag *dag, const struct callee *tool, const struct label *label)
{
    struct suggestion suggestion = {label->name, NULL, 0};
    struct name_list answers = {"", 0};
    dag_error(dag, label->where, "%s never answers '%s'", tool->name, label->name);
    if (dag_errors_full(dag))
        return -1;
    for (int i = 0; i < tool->answers.count; i++) {
        const char *name = dag->answers[tool->answers.first + i].name;
        dag_suggest(&suggestion, name);
        dag_list_name(dag, &answers, name);
    }
    dag_note_suggestion(dag, &suggestion);
    dag_note_names(dag, "its answers", &answers);
    return suggestion.best == NULL ? -1 : answer_of(dag, tool, suggestion.best);
}

/* Enters one rule into the arcs of its answers. */
static void resolve_rule(struct dag *dag, const struct node *node, const struct rule *rule)
{
    const struct callee callee = callee_of(dag, node), *tool = &callee;
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
    const struct callee callee = callee_of(dag, node), *tool = &callee;
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
    if (node->tool < 0 && node->branch < 0 && node->tool_name != NULL)
        unknown_tool(dag, node);
    /* A branch without exits lost them to a syntax error. */
    int known =
        node->tool >= 0 || (node->branch >= 0 && dag->branches[node->branch].exits.count > 0);
    if (known) {
        int answers = callee_of(dag, node).answers.count;
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
            if (known)
                resolve_rule(dag, node, rule);
        } else if (otherwise == NULL)
            otherwise = rule;
        else {
            dag_error(dag, rule->where, "a second 'otherwise'");
            dag_note(dag, otherwise->where, "the first is here");
        }
    }
    if (known)
        resolve_rest(dag, node, otherwise);
}

static void resolve_start(struct dag *dag, const struct scope *scope)
{
    struct oracle_graph *graph = scope->graph;
    const char *what = graph->branch ? "graph" : "oracle";
    if (graph->start.name == NULL) {
        if (graph->bad)
            return;
        dag_error(dag, graph->where, "the %s '%s' has no start", what, graph->name);
        dag_note(dag, dag_nowhere, "add: start %s;",
                 graph->drafts.count > 0 ? dag->drafts[graph->drafts.first].name : "NODE");
        return;
    }
    resolve_target(dag, scope, &graph->start);
    if (graph->start.kind == TARGET_DECISION || graph->start.kind == TARGET_EXIT) {
        dag_error(dag, graph->start.where, "%s %s starts with a node, '%s' is %s",
                  graph->branch ? "a" : "an", what, graph->start.name,
                  graph->start.kind == TARGET_EXIT ? "an exit" : "a decision");
        graph->start.kind = TARGET_NONE;
    }
}

static void resolve_graph(struct dag *dag, struct oracle_graph *graph)
{
    struct scope scope = {graph, {NULL, NULL, 0, 0}, {NULL, NULL, 0, 0}, {NULL, NULL, 0, 0}};
    dag->use = graph->use;
    declare_parameters(dag, &scope);
    declare_exits(dag, &scope);
    declare_nodes(dag, &scope);
    resolve_start(dag, &scope);
    for (int n = graph->drafts.first; n < graph->drafts.first + graph->drafts.count; n++)
        resolve_node(dag, &scope, &dag->drafts[n]);
    dag->use = -1;
}

static void declare_branches(struct dag *dag)
{
    for (int i = 0; i < dag->branch_count; i++) {
        const struct oracle_graph *branch = &dag->branches[i];
        int tool = dag_find(&dag->tool_names, branch->name);
        int first = dag_put(&dag->arena, &dag->branch_names, branch->name, i);
        if (tool >= 0) {
            dag_error(dag, branch->where, "'%s' is a tool and cannot name a graph", branch->name);
            dag_note(dag, dag->tools[tool].where, "declared here");
        }
        if (first >= 0)
            dag_resolve_twice(dag, "graph", branch->name, branch->where,
                              dag->branches[first].where);
    }
}

/* What each node of a graph uses; branches not seen before get their first use and a place in the
 * queue. */
static void resolve_uses(struct dag *dag, const struct oracle_graph *graph, int *queue, int *queued)
{
    for (int i = graph->drafts.first; i < graph->drafts.first + graph->drafts.count; i++) {
        struct node *node = &dag->drafts[i];
        if (node->tool_name == NULL)
            continue;
        node->tool = dag_find(&dag->tool_names, node->tool_name);
        node->branch = node->tool >= 0 ? -1 : dag_find(&dag->branch_names, node->tool_name);
        if (node->branch < 0 || queue == NULL || dag->branches[node->branch].use >= 0)
            continue;
        int use = ADD(dag, uses, use_count);
        dag->uses[use] = (struct use){node->branch, node->name, node->tool_where, graph->use};
        dag->branches[node->branch].use = use;
        queue[(*queued)++] = node->branch;
    }
}

/* Two names of tools or more, none of them known or like one that is: the file is for another
 * catalog, and that is all to be said. */
static int is_for_another(struct dag *dag)
{
    const struct node *first = NULL;
    int unknown = 0;
    for (int i = 0; i < dag->draft_count; i++) {
        const struct node *node = &dag->drafts[i];
        if (node->tool_name == NULL || node->branch >= 0)
            continue;
        struct suggestion suggestion = {node->tool_name, NULL, 0};
        for (int t = 0; t < dag->tool_count; t++)
            dag_suggest(&suggestion, dag->tools[t].name);
        if (node->tool >= 0 || suggestion.best != NULL)
            return 0;
        first = first == NULL ? node : first;
        unknown |= strcmp(node->tool_name, first->tool_name) != 0;
    }
    if (!unknown || dag->lost || dag->error_count > 0)
        return 0;
    dag_error(dag, first->tool_where, "%s has none of the tools that this file asks",
              dag->sources[0].name);
    dag_note(dag, dag_nowhere,
             "if the file is for another catalog, let it say so: catalog "
             "\"FILE\";  or give --catalog FILE");
    dag->oracle_count = dag->branch_count = 0;
    return 1;
}

void dag_resolve(struct dag *dag)
{
    int *queue = dag_alloc(&dag->arena, ((size_t)dag->branch_count + 1) * sizeof *queue),
        queued = 0;
    declare_branches(dag);
    for (int i = 0; i < dag->oracle_count; i++)
        resolve_uses(dag, &dag->oracles[i], queue, &queued);
    for (int i = 0; i < queued; i++)
        resolve_uses(dag, &dag->branches[queue[i]], queue, &queued);
    for (int i = 0; i < dag->branch_count; i++)
        if (dag->branches[i].use < 0)
            resolve_uses(dag, &dag->branches[i], NULL, NULL);
    if (is_for_another(dag))
        return;
    for (int i = 0; i < dag->oracle_count; i++) {
        struct oracle_graph *oracle = &dag->oracles[i];
        int first = dag_put(&dag->arena, &dag->oracle_names, oracle->name, i);
        if (first >= 0)
            dag_resolve_twice(dag, "oracle", oracle->name, oracle->where,
                              dag->oracles[first].where);
        resolve_graph(dag, oracle);
    }
    for (int i = 0; i < dag->branch_count; i++)
        resolve_graph(dag, &dag->branches[i]);
}
