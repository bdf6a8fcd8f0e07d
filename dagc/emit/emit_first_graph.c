/* emit_first_graph.c - a skeleton's graph: it must compile without a warning whatever the catalog.
 *
 * A question, then the way to one decision behind its first answer and to another behind the
 * others; on each way the tools that write what is read further on. What subdivides is left to
 * those who know what guards it.
 * SPDX-License-Identifier: MIT */
#include <math.h>

#include "emit/skeleton.h"

/* Tools in an order in which each finds what it reads; those that never do are left out. */
struct order {
    int *tools, count;
};

/* A tool that reads a term at no level computes it, or does without. */
static int must_be_there(const struct need *need, int of_tool)
{
    return need->level > 0 && (!of_tool || need->level_name != NULL);
}

static int are_known(const struct dag *dag, const struct tool *tool, const int *known)
{
    for (int i = tool->reads.first; i < tool->reads.first + tool->reads.count; i++)
        if (must_be_there(&dag->needs[i], 1) && known[dag->needs[i].term] < dag->needs[i].level)
            return 0;
    return 1;
}

static struct order find_order(struct dag *dag)
{
    struct order order = {dag_alloc(&dag->arena, ((size_t)dag->tool_count + 1) * sizeof(int)), 0};
    int *known = dag_alloc(&dag->arena, ((size_t)dag->term_count + 1) * sizeof *known);
    unsigned char *in = dag_alloc(&dag->arena, (size_t)dag->tool_count + 1);
    for (int before = -1; before < order.count;) {
        before = order.count;
        for (int i = 0; i < dag->tool_count; i++) {
            struct span writes = dag->tools[i].writes;
            if (in[i] || !are_known(dag, &dag->tools[i], known))
                continue;
            in[i] = 1;
            order.tools[order.count++] = i;
            for (int k = writes.first; k < writes.first + writes.count; k++)
                if (known[dag->needs[k].term] < dag->needs[k].level)
                    known[dag->needs[k].term] = dag->needs[k].level;
        }
    }
    return order;
}

/* The place in the order of the first tool that leaves the term behind at that level or better;
 * -1: none. */
static int writer_of(const struct dag *dag, const struct order *order, const struct need *need)
{
    for (int i = 0; i < order->count; i++) {
        struct span writes = dag->tools[order->tools[i]].writes;
        for (int k = writes.first; k < writes.first + writes.count; k++)
            if (dag->needs[k].term == need->term && dag->needs[k].level >= need->level)
                return i;
    }
    return -1;
}

/* Marks the writers of all that is needed; 0: some has none. */
static int mark(const struct dag *dag, const struct order *order, struct span needs, int of_tool,
                unsigned char *wanted)
{
    for (int i = needs.first; i < needs.first + needs.count; i++) {
        if (!must_be_there(&dag->needs[i], of_tool))
            continue;
        int writer = writer_of(dag, order, &dag->needs[i]);
        if (writer < 0)
            return 0;
        wanted[writer] = 1;
    }
    return 1;
}

/* Tools to ask one after the other, and the decision behind them. */
struct way {
    int *tools, count, decision;
};

/* The tools that must be asked, but for those asked already, before something that has these needs;
 * count -1: they cannot be met. */
static struct way find_way(struct dag *dag, const struct order *order, struct span needs,
                           int of_tool, const unsigned char *asked)
{
    struct way way = {dag_alloc(&dag->arena, ((size_t)order->count + 1) * sizeof(int)), -1, -1};
    unsigned char *wanted = dag_alloc(&dag->arena, (size_t)order->count + 1);
    if (!mark(dag, order, needs, of_tool, wanted))
        return way;
    for (int i = order->count; i-- > 0;)
        if (wanted[i]) /* what it reads comes before it in the order */
            (void)mark(dag, order, dag->tools[order->tools[i]].reads, 1, wanted);
    way.count = 0;
    for (int i = 0; i < order->count; i++)
        if (wanted[i] && !asked[order->tools[i]])
            way.tools[way.count++] = order->tools[i];
    return way;
}

static void print_node(const struct dag *dag, struct text *out, int tool, int at)
{
    const struct tool *t = &dag->tools[tool];
    const char *gap = "";
    dag_print(out, "  node n%d = %s(", at, t->name);
    for (int i = t->parameters.first; i < t->parameters.first + t->parameters.count; i++) {
        const struct parameter *p = &dag->parameters[i];
        char number[32];
        if (!isnan(p->value))
            continue;
        double value = isfinite(p->low) ? p->low : isfinite(p->high) ? p->high : 0;
        dag_print(out, "%s%s = %s", gap, p->name, dag_number(value, number));
        gap = ", ";
    }
    dag_print(out, ") { ");
}

/* Where the way leads from its tool `at`, which is node `node`; behind the last, the decision. */
static void print_target(const struct dag *dag, struct text *out, const struct way *way, int at,
                         int node)
{
    if (at < way->count || way->decision < 0)
        dag_print(out, "n%d; ", node);
    else
        dag_print(out, "%s; ", dag->decisions[way->decision].name);
}

/* Its tools as nodes from `node` on; the number of the next. */
static int print_way(const struct dag *dag, struct text *out, const struct way *way, int node)
{
    for (int i = 0; i < way->count; i++) {
        print_node(dag, out, way->tools[i], node + i);
        dag_print(out, "otherwise -> ");
        print_target(dag, out, way, i + 1, node + i + 1);
        dag_print(out, "}\n");
    }
    return node + way->count;
}

/* The first tool of the order that can say more than one thing, or the first of all. */
static int find_question(const struct dag *dag, const struct order *order)
{
    for (int i = 0; i < order->count; i++)
        if (dag->tools[order->tools[i]].answers.count > 1)
            return order->tools[i];
    return order->tools[0];
}

int dag_skeleton_graph(struct skeleton *s)
{
    struct dag *dag = s->dag;
    struct order order = find_order(dag);
    unsigned char *asked = dag_alloc(&dag->arena, (size_t)dag->tool_count + 1);
    struct way ways[2] = {{NULL, 0, -1}, {NULL, 0, -1}};
    int count = 0;
    if (order.count == 0) {
        dag_error(dag, dag->tool_count == 0 ? dag->runtime_where : dag->tools[0].where,
                  dag->tool_count == 0
                      ? "this catalog declares no tool"
                      : "every tool of this catalog reads what another must write");
        return -1;
    }
    const int question = find_question(dag, &order);
    const struct tool *tool = &dag->tools[question];
    struct way before = find_way(dag, &order, tool->reads, 1, asked);
    asked[question] = 1;
    for (int i = 0; i < before.count; i++)
        asked[before.tools[i]] = 1;
    for (int i = 0; i < dag->decision_count && count < (tool->answers.count > 1 ? 2 : 1); i++) {
        ways[count] = find_way(dag, &order, dag->decisions[i].reads, 0, asked);
        ways[count].decision = i;
        count += ways[count].count >= 0 && !dag->decisions[i].subdivides;
    }
    if (count == 0) {
        dag_error(dag, dag->decision_count == 0 ? dag->runtime_where : dag->decisions[0].where,
                  "no tools of this catalog lead to a decision that does not subdivide");
        return -1;
    }
    struct text *out = dag_skeleton_add(s, dag_format(&dag->arena, "%s.dag", s->name));
    dag_print(out,
              "# One way through the catalog, to begin with.\ncatalog \"%s\";\n\noracle %s {\n"
              "  start n1;\n",
              s->catalog, s->name);
    int node = print_way(dag, out, &before, 1) + 1;
    print_node(dag, out, question, node - 1);
    if (count == 2) { /* by name: `otherwise` would swallow precise answers */
        dag_print(out, "%s -> ", dag->answers[tool->answers.first].name);
        print_target(dag, out, &ways[0], 0, node);
        for (int i = 1; i < tool->answers.count; i++)
            dag_print(out, "%s%s", i > 1 ? " | " : "", dag->answers[tool->answers.first + i].name);
    } else
        dag_print(out, "otherwise");
    dag_print(out, " -> ");
    print_target(dag, out, &ways[count - 1], 0, node + (count == 2 ? ways[0].count : 0));
    dag_print(out, "}\n");
    for (int i = 0; i < count; i++)
        node = print_way(dag, out, &ways[i], node);
    dag_print(out, "}\n");
    return 0;
}
