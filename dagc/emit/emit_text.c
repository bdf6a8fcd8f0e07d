/* emit_text.c - the oracles as a pass left them, for people: --dump=PASS and --emit=text.
 *
 * The listing is in the oracle's own language as far as that goes; what a pass has found out
 * stands beside it in comments.
 * SPDX-License-Identifier: MIT */
#include "analyse/guard.h"

struct listing {
    struct dag *dag;
    struct text *out;
    enum pass pass;
    const struct oracle_graph *oracle;
    unsigned char *sure;    /* by term * nodes + place: the level surely known before the node */
    unsigned char *allowed; /* by decision * nodes + place: every path to the node allows it */
};

/* "x = 1, y = limit" before names are resolved. */
static void print_written(const struct listing *listing, struct span arguments)
{
    struct dag *dag = listing->dag;
    for (int i = 0; i < arguments.count; i++) {
        const struct argument *argument = &dag->arguments[arguments.first + i];
        dag_print(listing->out, "%s%s = %s", i > 0 ? ", " : "", argument->name,
                  dag_value_text(dag, argument->expression));
    }
}

static void print_rules(const struct listing *listing, const struct node *node)
{
    const struct dag *dag = listing->dag;
    for (int i = node->rules.first; i < node->rules.first + node->rules.count; i++) {
        const struct rule *rule = &dag->rules[i];
        dag_print(listing->out, "    %s", rule->labels.count == 0 ? "otherwise" : "");
        for (int l = 0; l < rule->labels.count; l++)
            dag_print(listing->out, "%s%s", l > 0 ? " | " : "",
                      dag->labels[rule->labels.first + l].name);
        dag_print(listing->out, " -> %s;\n", rule->target.name);
    }
}

static void print_arcs(const struct listing *listing, const struct node *node)
{
    const struct dag *dag = listing->dag;
    const struct answer *answers = &dag->answers[dag->tools[node->tool].answers.first];
    for (int i = 0; i < node->arcs.count; i++) {
        const struct target *target = &dag->arcs[node->arcs.first + i].target;
        dag_print(listing->out, "    %s -> %s; # %s%s\n", answers[i].name,
                  dag_target_name(dag, target), dag_kind_name(answers[i].kind),
                  target->kind == TARGET_DECISION ? ", decision" : "");
    }
}

/* What is known before the node is asked. */
static void print_known(const struct listing *listing, const struct node *node)
{
    const struct dag *dag = listing->dag;
    int any = 0;
    dag_print(listing->out, "    # known:");
    for (int t = 0; t < dag->term_count; t++) {
        const struct term *term = &dag->terms[t];
        int level = listing->sure[t * listing->oracle->order.count + node->order];
        if (level == 0)
            continue;
        dag_print(listing->out, "%s %s", any ? "," : "", term->name);
        if (term->levels.count > 0)
            dag_print(listing->out, " >= %s", dag->levels[term->levels.first + level - 1].name);
        any = 1;
    }
    dag_print(listing->out, "%s; allowed:", any ? "" : " nothing");
    any = 0;
    for (int k = 0; k < dag->decision_count; k++)
        if (listing->allowed[k * listing->oracle->order.count + node->order])
            dag_print(listing->out, "%s %s", any++ ? "," : "", dag->decisions[k].name);
    dag_print(listing->out, "%s\n", any ? "" : " no subdivision");
}

static void print_node(const struct listing *listing, const struct node *node)
{
    struct dag *dag = listing->dag;
    dag_print(listing->out, "  node %s = ", node->name);
    if (listing->pass == PASS_PARSE) {
        dag_print(listing->out, "%s(", node->tool_name);
        print_written(listing, node->written);
        dag_print(listing->out, ") {\n");
        print_rules(listing, node);
    } else {
        dag_print(listing->out, "%s {", dag_call_source(dag, node));
        if (listing->pass >= PASS_CHECK)
            dag_print(listing->out, " # %d", node->order);
        dag_print(listing->out, "\n");
        if (listing->pass == PASS_ANALYSE)
            print_known(listing, node);
        print_arcs(listing, node);
    }
    dag_print(listing->out, "  }\n");
}

/* NAME : TYPE = VALUE in [LOW, HIGH] */
static void print_declared(const struct listing *listing, const struct parameter *parameter)
{
    char value[32], low[32], high[32];
    dag_print(listing->out, "%s : %s", parameter->name, parameter->type_name);
    if ((parameter->given & PARAMETER_VALUE) != 0)
        dag_print(listing->out, " = %s", dag_number(parameter->value, value));
    if ((parameter->given & PARAMETER_RANGE) != 0)
        dag_print(listing->out, " in [%s, %s]", dag_number(parameter->low, low),
                  dag_number(parameter->high, high));
    if (parameter->role_name != NULL)
        dag_print(listing->out, " role %s", parameter->role_name);
}

static void print_parameter(const struct listing *listing, const struct parameter *parameter)
{
    dag_print(listing->out, "  %sparam ", parameter->fixed ? "fixed " : "");
    print_declared(listing, parameter);
    dag_print(listing->out, ";");
    if (listing->pass >= PASS_RESOLVE)
        dag_print(listing->out, " # %s", dag_unit_name(&listing->dag->types[parameter->type]));
    dag_print(listing->out, "\n");
}

static void analyse(struct listing *listing)
{
    struct dag *dag = listing->dag;
    int count = listing->oracle->order.count;
    listing->sure = dag_alloc(&dag->arena, (size_t)count * (size_t)dag->term_count);
    listing->allowed = dag_alloc(&dag->arena, (size_t)count * (size_t)dag->decision_count);
    for (int t = 0; t < dag->term_count; t++)
        dag_sure_levels(dag, listing->oracle, t, listing->sure + t * count);
    for (int k = 0; k < dag->decision_count; k++)
        if (dag->decisions[k].subdivides)
            dag_allowed(dag, listing->oracle, k, listing->allowed + k * count);
}

/* A branch as written; the passes after the parser have put it where it is used. */
static void print_branch(const struct listing *listing, const struct oracle_graph *branch)
{
    const struct dag *dag = listing->dag;
    dag_print(listing->out, "graph %s(", branch->name);
    for (int i = 0; i < branch->parameters.count; i++) {
        dag_print(listing->out, "%s", i > 0 ? ", " : "");
        print_declared(listing, &dag->parameters[branch->parameters.first + i]);
    }
    dag_print(listing->out, ") exits (");
    for (int i = 0; i < branch->exits.count; i++) {
        const struct answer *exit = &dag->answers[branch->exits.first + i];
        dag_print(listing->out, "%s%s %s", i > 0 ? ", " : "", exit->name,
                  dag_kind_name(exit->kind));
    }
    dag_print(listing->out, ") {\n  start %s;\n",
              branch->start.name != NULL ? branch->start.name : "?");
    for (int i = 0; i < branch->drafts.count; i++)
        print_node(listing, &dag->drafts[branch->drafts.first + i]);
    dag_print(listing->out, "}\n\n");
}

void dag_emit_text(struct dag *dag, struct text *out, enum pass pass)
{
    struct listing listing = {dag, out, pass, NULL, NULL, NULL};
    if (pass == PASS_AVAILABILITY) {
        dag_emit_availability(dag, out);
        return;
    }
    if (pass == PASS_WAVES) {
        dag_emit_waves(dag, out);
        return;
    }
    for (int i = 0; i < dag->branch_count && pass == PASS_PARSE; i++)
        print_branch(&listing, &dag->branches[i]);
    for (int i = 0; i < dag->oracle_count; i++) {
        const struct oracle_graph *oracle = listing.oracle = &dag->oracles[i];
        dag_print(out, "%soracle %s {\n", i > 0 ? "\n" : "", oracle->name);
        for (int p = oracle->parameters.first;
             p < oracle->parameters.first + oracle->parameters.count; p++)
            print_parameter(&listing, &dag->parameters[p]);
        dag_print(out, "  start %s;\n", oracle->start.name != NULL ? oracle->start.name : "?");
        if (pass == PASS_ANALYSE)
            analyse(&listing);
        int count = pass == PASS_PARSE     ? oracle->drafts.count
                    : pass == PASS_RESOLVE ? oracle->nodes.count
                                           : oracle->order.count;
        for (int k = 0; k < count; k++)
            print_node(&listing, pass == PASS_PARSE     ? &dag->drafts[oracle->drafts.first + k]
                                 : pass == PASS_RESOLVE ? &dag->nodes[oracle->nodes.first + k]
                                                        : dag_node_at(dag, oracle, k));
        dag_print(out, "}\n");
    }
}
