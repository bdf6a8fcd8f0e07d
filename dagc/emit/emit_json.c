/* emit_json.c - the whole resolved graph as JSON, for other programs.
 *
 * {"schema": "dagc/1", ...}: the number grows when a field goes or changes its meaning; new fields
 * alone leave it. Order is that of the sources, nodes are in topological order, and things name
 * each other by name, so the text is the same wherever it is made. Of the catalog only what the
 * oracles use is there; an answer may allow a decision that they do not make. JSON has no infinity:
 * such an end of a range is null.
 * SPDX-License-Identifier: MIT */
#include <math.h>

#include "analyse/analyse.h"
#include "emit/emit.h"

static void print_text(struct text *out, const char *value)
{
    dag_print(out, "\"");
    for (; *value != '\0'; value++) {
        unsigned char byte = (unsigned char)*value;
        if (byte == '"' || byte == '\\')
            dag_print(out, "\\%c", byte);
        else if (byte < ' ' || byte == 0x7f)
            dag_print(out, "\\u%04x", byte);
        else
            dag_print(out, "%c", byte);
    }
    dag_print(out, "\"");
}

/* "name": "value", behind what has been printed; a name of NULL: "value" alone. */
static void print_field(struct text *out, const char *before, const char *name, const char *value)
{
    dag_print(out, "%s", before);
    if (name != NULL)
        dag_print(out, "\"%s\": ", name);
    print_text(out, value);
}

static void print_number_field(struct text *out, const char *name, double value)
{
    char digits[32];
    dag_print(out, ", \"%s\": %s", name, isfinite(value) ? dag_number(value, digits) : "null");
}

static void print_flag(struct text *out, const char *name, int value)
{
    dag_print(out, ", \"%s\": %s", name, value ? "true" : "false");
}

/* Between the items of a list, each on its line. */
static const char *comma(int *count)
{
    return (*count)++ == 0 ? "\n" : ",\n";
}

/* ---- the catalog */

/* What the nodes and leaves that are reached use. */
struct used {
    unsigned char *tools, *decisions, *terms, *types, *facts, *callbacks;
};

static void use_needs(const struct dag *dag, struct used *used, struct span needs)
{
    for (int i = needs.first; i < needs.first + needs.count; i++) {
        used->terms[dag->needs[i].term] = 1;
        used->types[dag->terms[dag->needs[i].term].type] = 1;
    }
}

static void use_parameters(const struct dag *dag, struct used *used, struct span parameters)
{
    for (int i = parameters.first; i < parameters.first + parameters.count; i++)
        used->types[dag->parameters[i].type] = 1;
}

static struct used find_used(struct dag *dag)
{
    struct used used;
    used.tools = dag_alloc(&dag->arena, (size_t)dag->tool_count);
    used.decisions = dag_alloc(&dag->arena, (size_t)dag->decision_count);
    used.terms = dag_alloc(&dag->arena, (size_t)dag->term_count);
    used.types = dag_alloc(&dag->arena, (size_t)dag->type_count);
    const struct dag_reached reached = dag_emit_reached(dag);
    used.facts = reached.facts;
    used.callbacks = reached.callbacks;
    for (int i = 0; i < dag->order_count; i++) {
        const struct node *node = &dag->nodes[dag->order[i]];
        used.tools[node->tool] = 1;
        use_needs(dag, &used, node->reads);
        for (int a = node->arcs.first; a < node->arcs.first + node->arcs.count; a++)
            if (dag->arcs[a].target.kind == TARGET_DECISION)
                used.decisions[dag->arcs[a].target.index] = 1;
    }
    for (int i = 0; i < dag->fact_count; i++)
        if (used.facts[i])
            used.types[dag->facts[i].type] = 1;
    for (int i = 0; i < dag->callback_count; i++)
        if (used.callbacks[i]) {
            used.types[dag->callbacks[i].type] = 1;
            use_needs(dag, &used, dag->callbacks[i].reads);
        }
    for (int i = 0; i < dag->tool_count; i++)
        if (used.tools[i]) {
            use_needs(dag, &used, dag->tools[i].reads);
            use_needs(dag, &used, dag->tools[i].writes);
            use_parameters(dag, &used, dag->tools[i].parameters);
        }
    for (int i = 0; i < dag->decision_count; i++)
        if (used.decisions[i])
            use_needs(dag, &used, dag->decisions[i].reads);
    for (int i = 0; i < dag->oracle_count; i++)
        use_parameters(dag, &used, dag->oracles[i].parameters);
    return used;
}

static void print_needs(const struct dag *dag, struct text *out, const char *name,
                        struct span needs)
{
    dag_print(out, ", \"%s\": [", name);
    for (int i = 0; i < needs.count; i++) {
        const struct need *need = &dag->needs[needs.first + i];
        print_field(out, i > 0 ? ", {" : "{", "term", need->term_name);
        if (need->level_name != NULL)
            print_field(out, ", ", "level", need->level_name);
        dag_print(out, "}");
    }
    dag_print(out, "]");
}

static void print_parameter(const struct dag *dag, struct text *out,
                            const struct parameter *parameter)
{
    print_field(out, "{", "name", parameter->name);
    print_field(out, ", ", "type", dag->types[parameter->type].name);
    if ((parameter->given & PARAMETER_VALUE) != 0)
        print_number_field(out, "default", parameter->value);
    print_number_field(out, "low", parameter->low);
    print_number_field(out, "high", parameter->high);
    if (parameter->role >= 0)
        print_field(out, ", ", "role", dag->roles[parameter->role].name);
    if (parameter->fixed)
        dag_print(out, ", \"fixed\": true");
    print_field(out, ", ", "doc", parameter->doc);
    dag_print(out, "}");
}

static void print_type(struct text *out, const struct type *type)
{
    print_field(out, "      {", "name", type->name);
    print_field(out, ", ", "base", type->base == BASE_INTEGER ? "integer" : "real");
    dag_print(out, ", \"length\": %d", type->length);
    print_field(out, ", ", "unit", type->unit_text);
    dag_print(out, "}");
}

static void print_term(const struct dag *dag, struct text *out, const struct term *term)
{
    print_field(out, "      {", "name", term->name);
    print_field(out, ", ", "type", dag->types[term->type].name);
    dag_print(out, ", \"levels\": [");
    for (int i = 0; i < term->levels.count; i++) {
        dag_print(out, "%s", i > 0 ? ", " : "");
        print_text(out, dag->levels[term->levels.first + i].name);
    }
    dag_print(out, "]");
    print_number_field(out, "low", term->low);
    print_number_field(out, "high", term->high);
    print_field(out, ", ", "header", term->header);
    if (term->wave != NULL)
        print_field(out, ", ", "wave", term->wave);
    print_field(out, ", ", "doc", term->doc);
    dag_print(out, "}");
}

/* The decisions that an answer allows; nothing when it allows none. */
static void print_allows(const struct dag *dag, struct text *out, const struct tool *tool,
                         int answer)
{
    int count = 0;
    for (int i = tool->guards.first; i < tool->guards.first + tool->guards.count; i++)
        if (dag->guards[i].answer_index == answer)
            print_field(out, count++ == 0 ? ", \"allows\": [" : ", ", NULL,
                        dag->guards[i].decision.name);
    dag_print(out, "%s", count > 0 ? "]" : "");
}

/* Under which conditions a guard's answers allow what they do: a parameter above 0 (one of them),
 * answers of another tool before. */
static void print_conditions(const struct dag *dag, struct text *out, const struct tool *tool)
{
    for (int i = 0; i < tool->by.count; i++)
        print_field(out, i == 0 ? ", \"by\": [" : ", ", NULL, dag->labels[tool->by.first + i].name);
    dag_print(out, "%s", tool->by.count > 0 ? "]" : "");
    if (tool->after.name == NULL)
        return;
    print_field(out, ", \"after\": {", "tool", tool->after.name);
    for (int i = 0; i < tool->after_answers.count; i++)
        print_field(out, i == 0 ? ", \"answers\": [" : ", ", NULL,
                    dag->labels[tool->after_answers.first + i].name);
    dag_print(out, "]}");
}

static void print_tool(const struct dag *dag, struct text *out, const struct tool *tool)
{
    print_field(out, "      {", "name", tool->name);
    print_field(out, ", ", "kind", tool->kind == TOOL_COMMAND ? "command" : "question");
    dag_print(out, ",\n       \"parameters\": [");
    for (int i = 0; i < tool->parameters.count; i++) {
        dag_print(out, "%s", i > 0 ? ", " : "");
        print_parameter(dag, out, &dag->parameters[tool->parameters.first + i]);
    }
    dag_print(out, "],\n       \"answers\": [");
    for (int i = 0; i < tool->answers.count; i++) {
        const struct answer *answer = &dag->answers[tool->answers.first + i];
        print_field(out, i > 0 ? ", {" : "{", "name", answer->name);
        print_field(out, ", ", "kind", dag_kind_name(answer->kind));
        if (answer->refuses)
            print_flag(out, "refuses", 1);
        print_allows(dag, out, tool, i);
        dag_print(out, "}");
    }
    dag_print(out, "]");
    print_needs(dag, out, "reads", tool->reads);
    print_needs(dag, out, "writes", tool->writes);
    print_flag(out, "guards", tool->guards.count > 0);
    print_conditions(dag, out, tool);
    if (tool->keeps != KEEPS_NOTHING)
        print_field(out, ", ", "keeps", tool->keeps == KEEPS_COUNT ? "count" : "record");
    print_field(out, ",\n       ", "header", tool->header);
    if (tool->wave != NULL)
        print_field(out, ", ", "wave", tool->wave);
    if (tool->anywhere)
        print_flag(out, "anywhere", 1);
    print_field(out, ", ", "doc", tool->doc);
    dag_print(out, "}");
}

static void print_decision(const struct dag *dag, struct text *out,
                           const struct decision_tool *decision)
{
    print_field(out, "      {", "name", decision->name);
    print_needs(dag, out, "reads", decision->reads);
    print_flag(out, "subdivides", decision->subdivides);
    print_field(out, ", ", "doc", decision->doc);
    dag_print(out, "}");
}

/* What a fact and an extern have alike. */
static void print_value(const struct dag *dag, struct text *out, const char *name, int type,
                        double low, double high)
{
    print_field(out, "      {", "name", name);
    print_field(out, ", ", "type", dag->types[type].name);
    print_number_field(out, "low", low);
    print_number_field(out, "high", high);
}

static void print_fact(const struct dag *dag, struct text *out, const struct fact *fact)
{
    print_value(dag, out, fact->name, fact->type, fact->low, fact->high);
    print_field(out, ", ", "c", fact->c);
    print_field(out, ", ", "doc", fact->doc);
    dag_print(out, "}");
}

static void print_callback(const struct dag *dag, struct text *out, const struct callback *callback)
{
    print_value(dag, out, callback->name, callback->type, callback->low, callback->high);
    print_needs(dag, out, "reads", callback->reads);
    print_field(out, ", ", "doc", callback->doc);
    dag_print(out, "}");
}

static void print_values(struct dag *dag, struct text *out, const struct used *used)
{
    int count = 0;
    dag_print(out, "\n    ],\n    \"facts\": [");
    for (int i = 0; i < dag->fact_count; i++)
        if (used->facts[i]) {
            dag_print(out, "%s", comma(&count));
            print_fact(dag, out, &dag->facts[i]);
        }
    dag_print(out, "\n    ],\n    \"externs\": [");
    count = 0;
    for (int i = 0; i < dag->callback_count; i++)
        if (used->callbacks[i]) {
            dag_print(out, "%s", comma(&count));
            print_callback(dag, out, &dag->callbacks[i]);
        }
}

static void print_catalog(struct dag *dag, struct text *out)
{
    struct used used = find_used(dag);
    int count = 0;
    dag_print(out, "  \"catalog\": {\n    \"abi\": %d,\n    \"types\": [", dag->runtime_abi);
    for (int i = 0; i < dag->type_count; i++)
        if (used.types[i]) {
            dag_print(out, "%s", comma(&count));
            print_type(out, &dag->types[i]);
        }
    dag_print(out, "\n    ],\n    \"terms\": [");
    count = 0;
    for (int i = 0; i < dag->term_count; i++)
        if (used.terms[i]) {
            dag_print(out, "%s", comma(&count));
            print_term(dag, out, &dag->terms[i]);
        }
    print_values(dag, out, &used);
    dag_print(out, "\n    ],\n    \"tools\": [");
    count = 0;
    for (int i = 0; i < dag->tool_count; i++)
        if (used.tools[i]) {
            dag_print(out, "%s", comma(&count));
            print_tool(dag, out, &dag->tools[i]);
        }
    dag_print(out, "\n    ],\n    \"decisions\": [");
    count = 0;
    for (int i = 0; i < dag->decision_count; i++)
        if (used.decisions[i]) {
            dag_print(out, "%s", comma(&count));
            print_decision(dag, out, &dag->decisions[i]);
        }
    dag_print(out, "\n    ]\n  }");
}

/* ---- the oracles */

/* {"number": 16}, {"parameter": "rays"}, {"operator": "add", "operands": [..., ...]} and so on; an
 * infinite number is a string. */
static void print_expression(struct dag *dag, struct text *out, int expression)
{
    static const char *const operators[] = {
        "negate",   "sqrt",   "abs", "add", "subtract",
        "multiply", "divide", "min", "max"}; /* from EXPRESSION_NEGATE on */
    const struct expression *e = &dag->expressions[expression];
    if (e->kind == EXPRESSION_PARAMETER)
        print_field(out, "{", "parameter", dag->parameters[e->parameter].name);
    else if (e->kind == EXPRESSION_NUMBER) {
        const char *quote = isfinite(e->number) ? "" : "\"";
        char digits[32];
        dag_print(out, "{\"number\": %s%s%s", quote, dag_number(e->number, digits), quote);
    } else if (e->kind == EXPRESSION_FACT)
        print_field(out, "{", "fact", dag->facts[e->index].name);
    else if (e->kind == EXPRESSION_EXTERN)
        print_field(out, "{", "extern", dag->callbacks[e->index].name);
    else if (e->kind == EXPRESSION_TERM) {
        const struct term *term = &dag->terms[e->index];
        print_field(out, "{", "term", term->name);
        if (term->levels.count > 0)
            print_field(out, ", ", "level", dag->levels[term->levels.first + e->level - 1].name);
    } else if (e->kind >= EXPRESSION_NEGATE) {
        print_field(out, "{", "operator", operators[e->kind - EXPRESSION_NEGATE]);
        dag_print(out, ", \"operands\": [");
        print_expression(dag, out, e->left);
        if (e->right >= 0) {
            dag_print(out, ", ");
            print_expression(dag, out, e->right);
        }
        dag_print(out, "]");
    }
    dag_print(out, "}");
}

/* The places where branches are used, as far as their nodes are reached; outer ones first. */
static void print_branches(struct dag *dag, struct text *out, const struct oracle_graph *oracle)
{
    int count = 0;
    unsigned char *held = dag_alloc(&dag->arena, (size_t)dag->use_count);
    dag_held_uses(dag, oracle, held);
    for (int u = 0; u < dag->use_count; u++) {
        if (!held[u])
            continue;
        const struct oracle_graph *branch = &dag->branches[dag->uses[u].branch];
        dag_print(out, "%s", count == 0 ? ",\n     \"branches\": [" : "");
        dag_print(out, "%s      {", comma(&count));
        print_field(out, "", "name", dag->uses[u].node);
        print_field(out, ", ", "graph", branch->name);
        if (dag->uses[u].outer >= 0)
            print_field(out, ", ", "outer", dag->uses[dag->uses[u].outer].node);
        print_field(out, ", ", "doc", branch->doc);
        dag_print(out, "}");
    }
    dag_print(out, "%s", count == 0 ? "" : "\n     ]");
}

static void print_node(struct dag *dag, struct text *out, const struct node *node)
{
    const struct source *source = &dag->sources[node->where.source];
    print_field(out, "      {", "name", node->name);
    print_field(out, ", ", "tool", dag->tools[node->tool].name);
    if (node->use >= 0)
        print_field(out, ", ", "branch", dag->uses[node->use].node);
    dag_print(out, ", \"line\": %d,\n       \"arguments\": [",
              dag_line(source, node->where.offset));
    for (int i = 0; i < node->arguments.count; i++) {
        const struct argument *argument = &dag->arguments[node->arguments.first + i];
        print_field(out, i > 0 ? ", {" : "{", "name", dag->parameters[argument->parameter].name);
        dag_print(out, ", \"value\": ");
        print_expression(dag, out, argument->expression);
        dag_print(out, "}");
    }
    dag_print(out, "],\n       \"arcs\": [");
    for (int i = 0; i < node->arcs.count; i++) {
        const struct answer *answer = &dag->answers[dag->tools[node->tool].answers.first + i];
        const struct target *target = &dag->arcs[node->arcs.first + i].target;
        print_field(out, i > 0 ? ",\n                {" : "{", "answer", answer->name);
        print_field(out, ", ", "kind", dag_kind_name(answer->kind));
        print_field(out, ", ", target->kind == TARGET_NODE ? "node" : "decision",
                    dag_target_name(dag, target));
        dag_print(out, "}");
    }
    dag_print(out, "]}");
}

static void print_oracle(struct dag *dag, struct text *out, const struct oracle_graph *oracle)
{
    char fingerprint[17];
    dag_fingerprint_text(oracle, fingerprint);
    print_field(out, "    {", "name", oracle->name);
    print_field(out, ", ", "fingerprint", fingerprint);
    print_field(out, ",\n     ", "doc", oracle->doc);
    dag_print(out, ",\n     \"parameters\": [");
    for (int i = 0; i < oracle->parameters.count; i++) {
        dag_print(out, "%s\n      ", i > 0 ? "," : "");
        print_parameter(dag, out, &dag->parameters[oracle->parameters.first + i]);
    }
    dag_print(out, "]");
    print_branches(dag, out, oracle);
    print_field(out, ",\n     ", "start", oracle->start.name);
    dag_print(out, ",\n     \"nodes\": [");
    for (int i = 0; i < oracle->order.count; i++) {
        dag_print(out, "%s", i > 0 ? ",\n" : "\n");
        print_node(dag, out, dag_node_at(dag, oracle, i));
    }
    dag_print(out, "\n     ]}");
}

void dag_emit_json(struct dag *dag, struct text *out)
{
    dag_print(out, "{\n");
    print_field(out, "  ", "schema", "dagc/1");
    print_field(out, ",\n  ", "dagc", DAGC_VERSION);
    print_field(out, ",\n  ", "source", dag->sources[dag->oracles[0].where.source].base);
    dag_print(out, ",\n");
    print_catalog(dag, out);
    dag_print(out, ",\n  \"oracles\": [");
    for (int i = 0; i < dag->oracle_count; i++) {
        dag_print(out, "%s", i > 0 ? ",\n" : "\n");
        print_oracle(dag, out, &dag->oracles[i]);
    }
    dag_print(out, "\n  ]\n}\n");
}

static void emit_json(struct dag *dag, void *text)
{
    dag_emit_json(dag, text);
}

char *dag_json(struct dag *dag)
{
    struct text text = {0};
    int status = dag_protect(dag, emit_json, &text);
    if (status == 0 && !text.failed)
        return text.bytes;
    dag_text_free(&text);
    return NULL;
}
