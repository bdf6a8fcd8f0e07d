/* emit_dot.c - a decision graph as a drawing, in the language of Graphviz.
 *
 * Made to be read from the top: nodes are boxes with the question under the name, arcs are
 * labelled by the answer, their line says how far the answer can be trusted (solid: precise,
 * dashed: approximate, dotted: other). Answers of one kind with one target share an arc. Leaves
 * are drawn small, once below each node that decides, because arcs from everywhere to one
 * `stop` would hide the graph; their colour tells a decision that subdivides (orange) and one that
 * uses terms (green) from one that does neither (grey). A branch is a frame around the nodes that
 * stand in its place, with its own name for them.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "analyse/analyse.h"

struct drawing {
    struct dag *dag;
    struct text *out;
    const struct oracle_graph *graph;
    const unsigned char *held; /* by use of a branch: is it one of this oracle's? */
    int oracle; /* its number stands before every name, so that several can share a drawing */
};

static const char *const line_styles[] = {"solid", "dashed", "dotted"}; /* by enum kind */

static void print_character(struct text *out, char c)
{
    switch (c) {
    case '&':
        dag_print(out, "&amp;");
        break;
    case '<':
        dag_print(out, "&lt;");
        break;
    case '>':
        dag_print(out, "&gt;");
        break;
    case '"':
        dag_print(out, "&quot;");
        break;
    default:
        dag_print(out, "%c", c);
    }
}

/* Text inside a label of the kind <...>. */
static void print_escaped(struct text *out, const char *text)
{
    for (; *text != '\0'; text++)
        print_character(out, *text);
}

/* The same in lines of about so many bytes, left-aligned. */
static void print_wrapped(struct text *out, const char *text, int width)
{
    for (int column = 0; *text != '\0'; text++, column++)
        if (*text == ' ' && column >= width) {
            dag_print(out, "<br align=\"left\"/>");
            column = -1;
        } else
            print_character(out, *text);
    dag_print(out, "<br align=\"left\"/>");
}

static const char *leaf_colour(const struct decision_tool *decision)
{
    return decision->subdivides ? "#f6d9b0" : decision->reads.count > 0 ? "#cfe8cf" : "#e4e4e4";
}

/* The question: tool, and one line per argument that has something to say. */
static void print_node(const struct drawing *drawing, const struct node *node)
{
    struct dag *dag = drawing->dag;
    struct text *out = drawing->out;
    const struct tool *tool = &dag->tools[node->tool];
    dag_print(out, "  \"%d.%s\" [label=<<b>%s</b><br/><font point-size=\"10\">", drawing->oracle,
              node->name, dag_name_in_use(dag, node->name, node->use));
    print_escaped(out, tool->name);
    dag_print(out, "</font>");
    for (int i = 0; i < node->arguments.count; i++) {
        const struct argument *argument = &dag->arguments[node->arguments.first + i];
        const char *name = dag->parameters[argument->parameter].name;
        const char *value = dag_value_text(dag, argument->expression);
        dag_print(out, "<br/><font point-size=\"9\" color=\"#555555\">%s", name);
        if (strcmp(name, value) != 0) { /* `rays = rays` says no more than `rays` */
            dag_print(out, " = ");
            print_escaped(out, value);
        }
        dag_print(out, "</font>");
    }
    dag_print(out, ">%s%s];\n", tool->guards.count > 0 ? ", penwidth=2" : "",
              tool->kind == TOOL_COMMAND ? ", style=\"filled\", fillcolor=\"#eef0f6\"" : "");
}

/* The arcs of one kind to one target, from `answer` on, as one; leaves are made on the way. */
static void print_arc(const struct drawing *drawing, const struct node *node, int answer,
                      unsigned char *done)
{
    const struct dag *dag = drawing->dag;
    struct text *out = drawing->out;
    const struct answer *answers = &dag->answers[dag->tools[node->tool].answers.first];
    const struct target *target = &dag->arcs[node->arcs.first + answer].target;
    dag_print(out, "  \"%d.%s\" -> \"%d.%s%s%s\" [style=%s, label=<", drawing->oracle, node->name,
              drawing->oracle, target->kind == TARGET_DECISION ? node->name : "",
              target->kind == TARGET_DECISION ? "." : "", dag_target_name(dag, target),
              line_styles[answers[answer].kind]);
    for (int a = answer; a < node->arcs.count; a++)
        if (answers[a].kind == answers[answer].kind
            && dag_same_target(&dag->arcs[node->arcs.first + a].target, target)) {
            dag_print(out, "%s&#160;%s&#160;", a > answer ? "<br/>" : "", answers[a].name);
            done[a] = 1;
        }
    dag_print(out, ">];\n");
}

static void print_leaf(const struct drawing *drawing, const struct node *node, int decision)
{
    const struct decision_tool *leaf = &drawing->dag->decisions[decision];
    dag_print(
        drawing->out,
        "  \"%d.%s.%s\" [label=\"%s\", shape=box, style=\"filled,rounded\", "
        "fillcolor=\"%s\", color=\"#999999\", fontsize=10, height=0.25, margin=\"0.1,0.03\"];\n",
        drawing->oracle, node->name, leaf->name, leaf->name, leaf_colour(leaf));
}

/* Does an answer before this one lead to the same place? */
static int is_repeated(const struct drawing *drawing, const struct node *node, int answer)
{
    const struct arc *arcs = &drawing->dag->arcs[node->arcs.first];
    for (int a = 0; a < answer; a++)
        if (dag_same_target(&arcs[a].target, &arcs[answer].target))
            return 1;
    return 0;
}

static void print_node_and_leaves(const struct drawing *drawing, const struct node *node)
{
    print_node(drawing, node);
    for (int a = 0; a < node->arcs.count; a++) {
        const struct target *target = &drawing->dag->arcs[node->arcs.first + a].target;
        if (target->kind == TARGET_DECISION && !is_repeated(drawing, node, a))
            print_leaf(drawing, node, target->index);
    }
}

/* The nodes that stand in this use of a branch (-1: in none), then the uses in it, each in its
 * frame. Arcs come after all of them: Graphviz puts what an arc names where it stands. */
static void print_shapes(const struct drawing *drawing, int use)
{
    struct dag *dag = drawing->dag;
    for (int i = 0; i < drawing->graph->order.count; i++)
        if (dag_node_at(dag, drawing->graph, i)->use == use)
            print_node_and_leaves(drawing, dag_node_at(dag, drawing->graph, i));
    for (int u = 0; u < dag->use_count; u++) {
        const struct use *inner = &dag->uses[u];
        if (!drawing->held[u] || inner->outer != use)
            continue;
        dag_print(drawing->out,
                  "  subgraph \"cluster%d.%s\" {\n  label=\"%s = %s\"; labelloc=t; fontsize=10; "
                  "fontcolor=\"#555555\"; style=\"rounded,filled\"; fillcolor=\"#f7f8fb\"; "
                  "color=\"#b5bccb\"; margin=10;\n",
                  drawing->oracle, inner->node, dag_name_in_use(dag, inner->node, use),
                  dag->branches[inner->branch].name);
        print_shapes(drawing, u);
        dag_print(drawing->out, "  }\n");
    }
}

static void print_arcs(const struct drawing *drawing, const struct node *node)
{
    unsigned char done[ANSWERS_MAX] = {0};
    for (int a = 0; a < node->arcs.count; a++)
        if (!done[a])
            print_arc(drawing, node, a, done);
}

/* ---- the caption: what the oracle is, and a row per parameter */

static void print_cell(struct text *out, const char *text)
{
    dag_print(out, "<td align=\"left\">");
    print_escaped(out, text);
    dag_print(out, "</td>");
}

static void print_parameter(const struct drawing *drawing, const struct parameter *parameter)
{
    struct text *out = drawing->out;
    char value[32], low[32], high[32];
    dag_print(out, "<tr><td align=\"left\" valign=\"top\"><b>%s</b></td>", parameter->name);
    dag_print(out, "<td align=\"left\" valign=\"top\">%s %s</td>",
              dag_number(parameter->value, value), drawing->dag->types[parameter->type].unit_text);
    dag_print(out, "<td align=\"left\" valign=\"top\">");
    if ((parameter->given & PARAMETER_RANGE) != 0)
        dag_print(out, "%s ... %s", dag_number(parameter->low, low),
                  dag_number(parameter->high, high));
    dag_print(out, "</td><td align=\"left\" valign=\"top\" balign=\"left\">");
    print_wrapped(out, parameter->doc, 60);
    dag_print(out, "</td></tr>");
}

static void print_caption(const struct drawing *drawing, const struct oracle_graph *oracle)
{
    struct text *out = drawing->out;
    dag_print(out,
              "  label=<<table border=\"0\" cellborder=\"0\" cellspacing=\"2\" cellpadding=\"1\">"
              "<tr><td height=\"16\"></td></tr><tr><td colspan=\"4\" align=\"left\"><font "
              "point-size=\"16\"><b>%s</b></font>",
              oracle->name);
    dag_print(out, "</td></tr><tr><td colspan=\"4\" align=\"left\">");
    print_escaped(out, *oracle->doc != '\0' ? oracle->doc : " ");
    dag_print(out, "</td></tr>");
    for (int i = 0; i < oracle->parameters.count; i++)
        print_parameter(drawing, &drawing->dag->parameters[oracle->parameters.first + i]);
    dag_print(out, "<tr>");
    print_cell(out, " ");
    dag_print(out, "</tr><tr><td colspan=\"4\" align=\"left\"><font color=\"#555555\">solid: "
                   "precise answer; dashed: "
                   "approximate; dotted: other; heavy frame: guard; tinted box: "
                   "command; frame around nodes: a branch</font></td></tr></table>>;\n");
}

/* Several oracles stand side by side, each in its own frame. */
static void print_oracle(struct dag *dag, struct text *out, int index)
{
    const struct oracle_graph *oracle = &dag->oracles[index];
    unsigned char *held = dag_alloc(&dag->arena, (size_t)dag->use_count);
    struct drawing drawing = {dag, out, oracle, held, index};
    dag_held_uses(dag, oracle, held);
    if (dag->oracle_count > 1)
        dag_print(out, "  subgraph \"cluster%d\" {\n  color=\"#cccccc\";\n", index);
    print_caption(&drawing, oracle);
    dag_print(out,
              "  \"%d start\" [label=\"start\", shape=plain, fontcolor=\"#555555\"];\n"
              "  \"%d start\" -> \"%d.%s\";\n",
              index, index, index, oracle->start.name);
    print_shapes(&drawing, -1);
    for (int i = 0; i < oracle->order.count; i++)
        print_arcs(&drawing, dag_node_at(dag, oracle, i));
    if (dag->oracle_count > 1)
        dag_print(out, "  }\n");
}

/* nodes: of more, dot spends minutes on curves */
enum { CURVED = 100 };

void dag_emit_dot(struct dag *dag, struct text *out)
{
    const struct source *source = &dag->sources[dag->oracles[0].where.source];
    dag_print(out, "/* Generated by dagc %s from ", DAGC_VERSION);
    dag_print_comment(out, source->base);
    dag_print(
        out,
        " */\ndigraph dagc {\n"
        "  rankdir=TB; nodesep=0.2; ranksep=0.35; labelloc=b; labeljust=l; fontsize=11;\n"
        "  fontname=\"Helvetica,Arial,sans-serif\"; bgcolor=white; pad=0.3;\n"
        "  node [shape=box, style=\"filled\", fillcolor=white, color=\"#334466\", fontsize=12,\n"
        "        margin=\"0.14,0.06\", height=0.3, fontname=\"Helvetica,Arial,sans-serif\"];\n"
        "  edge [color=\"#334466\", fontsize=9, fontcolor=\"#334466\", arrowsize=0.6,\n"
        "        fontname=\"Helvetica,Arial,sans-serif\"];\n");
    int nodes = 0;
    for (int i = 0; i < dag->oracle_count; i++)
        nodes += dag->oracles[i].order.count;
    if (nodes > CURVED)
        dag_print(out, "  splines=line; nslimit=1; nslimit1=1; mclimit=0.1;\n");
    for (int i = 0; i < dag->oracle_count; i++)
        print_oracle(dag, out, i);
    dag_print(out, "}\n");
}
