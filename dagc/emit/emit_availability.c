/* emit_availability.c - which checks of the data manager the flat release keeps:
 * --dump=availability.
 *
 * A tool that asks for a term finds it, or computes it: which of the two is a check at run time
 * only where paths disagree. For each node and each term that its arguments and its tool are
 * declared to read or write, a line says which paths have computed it (analyse_terms.c) and what
 * becomes of the check: left out where every path has the term at the wanted level, or none has it
 * at all; else it stays. A tool that declares no level may ask for any: then the check is left out
 * for levels up to the known one.
 * SPDX-License-Identifier: MIT */
#include "analyse/analyse.h"

struct table_of {
    struct dag *dag;
    struct text *out;
    const struct oracle_graph *oracle;
    unsigned char *sure, *possible; /* by term * nodes + place */
    int left_out, partly, stay;
};

enum wish { WISH_ARGUMENT, WISH_READ, WISH_WRITE };
static const char *const wishes[] = {"in an argument", "reads", "writes"};

static const char *level_name(const struct dag *dag, const struct term *term, int level)
{
    return dag->levels[term->levels.first + level - 1].name;
}

static void print_line(struct table_of *table, const struct node *node, const struct need *need,
                       enum wish wish, int first)
{
    struct dag *dag = table->dag;
    const struct term *term = &dag->terms[need->term];
    int finest = term->levels.count > 0 ? term->levels.count : 1;
    int any = wish != WISH_ARGUMENT && need->level_name == NULL && finest > 1;
    size_t at = (size_t)need->term * (size_t)table->oracle->order.count + (size_t)node->order;
    int sure = table->sure[at], wanted = any ? finest : need->level;
    const char *there = !table->possible[at] ? "no path" : sure == 0 ? "some paths" : "every path";
    if (sure > 0 && term->levels.count > 0)
        there = dag_format(&dag->arena, "every path, >= %s", level_name(dag, term, sure));
    const char *level = finest == 1 ? ""
                        : any
                            ? " at any level"
                            : dag_format(&dag->arena, " >= %s", level_name(dag, term, need->level));
    const char *check;
    if (!table->possible[at] || sure >= wanted) {
        check = table->possible[at] ? "left out: it is there" : "left out: it is not there";
        table->left_out++;
    } else if (any && sure > 0) {
        check = dag_format(&dag->arena, "left out up to %s", level_name(dag, term, sure));
        table->partly++;
    } else {
        check = "stays";
        table->stay++;
    }
    dag_print(table->out, "  %-24s %-14s %-24s %-24s %s\n", first ? node->name : "", term->name,
              dag_format(&dag->arena, "%s%s", wishes[wish], level), there, check);
}

static void print_node(struct table_of *table, const struct node *node)
{
    const struct tool *tool = &table->dag->tools[node->tool];
    const struct span spans[3] = {node->reads, tool->reads, tool->writes};
    int lines = 0;
    for (int s = WISH_ARGUMENT; s <= WISH_WRITE; s++)
        for (int i = spans[s].first; i < spans[s].first + spans[s].count; i++)
            print_line(table, node, &table->dag->needs[i], (enum wish)s, lines++ == 0);
}

static void print_oracle(struct table_of *table)
{
    struct dag *dag = table->dag;
    int count = table->oracle->order.count;
    const char *kept = "";
    table->sure = dag_alloc(&dag->arena, (size_t)count * (size_t)dag->term_count);
    table->possible = dag_alloc(&dag->arena, (size_t)count * (size_t)dag->term_count);
    for (int t = 0; t < dag->term_count; t++) {
        dag_sure_levels(dag, table->oracle, t, table->sure + (size_t)t * (size_t)count);
        dag_possible_terms(dag, table->oracle, t, table->possible + (size_t)t * (size_t)count);
        if (dag_is_kept(dag, t))
            kept = dag_join(dag, kept, dag->terms[t].name);
    }
    dag_print(table->out, "oracle %s\n  %-24s %-14s %-24s %-24s %s\n", table->oracle->name, "node",
              "term", "which it", "has been computed on", "check");
    for (int i = 0; i < count; i++)
        print_node(table, dag_node_at(dag, table->oracle, i));
    dag_print(table->out, "  %d checks: %d left out, %d left out up to a level, %d stay\n",
              table->left_out + table->partly + table->stay, table->left_out, table->partly,
              table->stay);
    if (*kept != '\0')
        dag_print(table->out,
                  "  Some paths begin with these, from an earlier discussion of the pair: %s\n",
                  kept);
}

void dag_emit_availability(struct dag *dag, struct text *out)
{
    for (int i = 0; i < dag->oracle_count; i++) {
        struct table_of table = {dag, out, &dag->oracles[i], NULL, NULL, 0, 0, 0};
        dag_print(out, "%s", i > 0 ? "\n" : "");
        print_oracle(&table);
    }
}
