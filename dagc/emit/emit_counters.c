/* emit_counters.c - what a watched oracle shows: counters and names, and the ways to ask it.
 *
 * The counters are the caller's, so threads can count apart and add up; so is the clock. A node's
 * number is its place in the topological order, an arc's number its place when the nodes are
 * listed in that order and each node's answers in the order of its tool's declaration. Both are
 * the same for every release, and as stable as the graph.
 * SPDX-License-Identifier: MIT */
#include "emit/emit.h"

void dag_emit_prototype(const struct dag *dag, struct text *out, const struct oracle_graph *oracle,
                        enum flavour flavour)
{
    const char *name = oracle->name;
    static const char *const suffixes[] = {"", "_counted", "_traced", "_first"};
    dag_print(out,
              "enum decision %s_%s%s(const struct %s_parameters *parameters,\n"
              "    struct discussion *discussion",
              name, dag->verb, suffixes[flavour], name);
    if (flavour == FLAVOUR_COUNTED)
        dag_print(out, ", struct %s_counters *counters", name);
    else if (flavour == FLAVOUR_TRACED)
        dag_print(out, ",\n    void (*trace)(void *context, const struct discussion *discussion,"
                       " int node, int arc),\n    void *context");
    dag_print(out, ")");
}

void dag_emit_counters_h(const struct dag *dag, struct text *out, const struct oracle_graph *oracle,
                         const struct emit_options *options)
{
    const char *name = oracle->name;
    int arcs = 0;
    if (!options->counted && !options->traced)
        return;
    for (int i = 0; i < oracle->order.count; i++)
        arcs += dag_node_at(dag, oracle, i)->arcs.count;
    dag_print(
        out,
        "\n/* Nodes and arcs by number: their names, how far an arc's answer can be trusted, and "
        "the node that it\n"
        " * leaves. */\n"
        "enum { %s_nodes = %d, %s_arcs = %d };\n"
        "extern const char *const %s_node_names[%d];\n"
        "extern const char *const %s_arc_names[%d];\n"
        "extern const char *const %s_arc_kinds[%d]; /* \"precise\", \"approximate\", \"other\" */\n"
        "extern const int %s_arc_nodes[%d];\n",
        name, oracle->order.count, name, arcs, name, oracle->order.count, name, arcs, name, arcs,
        name, arcs);
    if (options->counted) {
        dag_print(
            out,
            "\n/* All zero before the first use. One structure per thread: nothing is locked. */\n"
            "struct %s_counters {\n"
            "    double (*clock)(void *context); /* in seconds or whatever; NULL: no time is taken "
            "*/\n"
            "    void *context;\n"
            "    double time[%d];              /* by node, in the unit of clock */\n"
            "    unsigned long long calls[%d]; /* by node */\n"
            "    unsigned long long arcs[%d];  /* by arc: how often the answer was given */\n"
            "    unsigned long long checks;    /* looks at a term that may be known or not */\n"
            "};\n",
            name, oracle->order.count, oracle->order.count, arcs);
        dag_print(out, "\n/* Decides as %s_%s does, and counts. */\n", name, dag->verb);
        dag_emit_prototype(dag, out, oracle, FLAVOUR_COUNTED);
        dag_print(out, ";\n");
    }
    if (options->traced) {
        dag_print(out,
                  "\n/* Decides as %s_%s does, and calls trace after every node with its "
                  "number and the\n"
                  " * arc that its answer takes; the discussion is then as the node left it. */\n",
                  name, dag->verb);
        dag_emit_prototype(dag, out, oracle, FLAVOUR_TRACED);
        dag_print(out, ";\n");
    }
}

/* One line per arc: its answer's name or kind. */
static void print_answers(const struct dag *dag, struct text *out,
                          const struct oracle_graph *oracle, int kinds)
{
    for (int i = 0; i < oracle->order.count; i++) {
        const struct node *node = dag_node_at(dag, oracle, i);
        const struct answer *answers = &dag->answers[dag->tools[node->tool].answers.first];
        for (int a = 0; a < node->arcs.count; a++)
            dag_print(out, "    \"%s\",\n",
                      kinds ? dag_kind_name(answers[a].kind) : answers[a].name);
    }
}

static void print_names(const struct dag *dag, struct text *out, const struct oracle_graph *oracle)
{
    dag_print(out, "\nconst char *const %s_node_names[] = {\n", oracle->name);
    for (int i = 0; i < oracle->order.count; i++)
        dag_print(out, "    \"%s\",\n", dag_node_at(dag, oracle, i)->name);
    dag_print(out, "};\nconst char *const %s_arc_names[] = {\n", oracle->name);
    print_answers(dag, out, oracle, 0);
    dag_print(out, "};\nconst char *const %s_arc_kinds[] = {\n", oracle->name);
    print_answers(dag, out, oracle, 1);
    dag_print(out, "};\nconst int %s_arc_nodes[] = {\n", oracle->name);
    for (int i = 0; i < oracle->order.count; i++) {
        dag_print(out, "   ");
        for (int a = 0; a < dag_node_at(dag, oracle, i)->arcs.count; a++)
            dag_print(out, " %d,", i);
        dag_print(out, "\n");
    }
    dag_print(out, "};\n");
}

void dag_emit_counters_c(const struct dag *dag, struct text *out, const struct oracle_graph *oracle,
                         const struct emit_options *options)
{
    const char *name = oracle->name;
    if (options->counted || options->traced)
        print_names(dag, out, oracle);
    if (options->counted)
        dag_print(
            out,
            "\nstatic double %s_clock(const struct %s_counters *counters)\n{\n"
            "    return counters->clock != NULL ? counters->clock(counters->context) : 0.0;\n}\n"
            "\nstatic void %s_count(struct %s_counters *counters, int node, int arc, double "
            "began)\n{\n"
            "    counters->time[node] += %s_clock(counters) - began;\n"
            "    counters->calls[node]++;\n    counters->arcs[arc]++;\n}\n",
            name, name, name, name, name);
}
