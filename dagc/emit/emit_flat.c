/* emit_flat.c - a decision graph as one C function.
 *
 * Each reachable node stands once, under a label, in topological order, and every arc is one
 * goto: the text is linear in the graph however its nodes are shared (nested ifs double a shared
 * node at each sharing). The discussion is a local copy; once the tools are inlined the compiler
 * keeps its terms in registers and sees, along each path, which of them are known. Terms that some
 * decision reads come with the discussion, as an earlier one about the same pair may have left
 * them, and go back with such a decision; all others start absent.
 *
 * Where paths meet, a compiler that has lost sight of a term is told what analyse_terms.c found;
 * what it cannot know is checked at run time, and a comment at the node says so. A graph of more
 * than PART_NODES nodes becomes several functions over one discussion, as compilers need more
 * than linear time for a function.
 * SPDX-License-Identifier: MIT */
#include "analyse/analyse.h"
#include "emit/emit.h"

struct flat {
    struct dag *dag;
    struct text *out;
    const struct oracle_graph *oracle;
    enum flavour flavour;
    const unsigned char *terms; /* see emit_options; NULL: all */
    int lines;                  /* likewise */
    int parts;                  /* how many functions; 1: all is in one */
    const char *at, *of;        /* the discussion: "&d" and "d.", or in a part "d" and "d->" */
    /* by term and order (place_of): its level on every path to the node */
    unsigned char *sure;
    unsigned char *possible;   /* likewise: may it be there at all? */
    int *arcs_in;              /* by order: how many arcs lead to the node */
    int *first_arc;            /* by order: the number of the node's first arc */
    unsigned char *entry;      /* by order: does an arc from another part lead to it? */
    unsigned char *node_label; /* by order: is there a goto to it? */
    unsigned char *leaf_label; /* by decision */
    unsigned char *leaf_used;  /* by decision: does an arc lead to its shared leaf? */
    int first_leaf;            /* the first decision whose leaf is used; -1: none */
};

static int same_target(const struct target *a, const struct target *b)
{
    return a->kind == b->kind && a->index == b->index;
}

static const struct arc *arc_of(const struct flat *flat, const struct node *node, int answer)
{
    return &flat->dag->arcs[node->arcs.first + answer];
}

/* Do all answers lead to one target? Then there is nothing to ask. */
static int decides_nothing(const struct flat *flat, const struct node *node)
{
    for (int i = 1; i < node->arcs.count; i++)
        if (!same_target(&arc_of(flat, node, 0)->target, &arc_of(flat, node, i)->target))
            return 0;
    return 1;
}

static int has_shared_leaf(const struct flat *flat, const struct target *target)
{
    return target->kind == TARGET_DECISION && flat->dag->decisions[target->index].reads.count > 0;
}

static int part_of(const struct flat *flat, int place)
{
    return flat->parts == 1 ? 0 : place / PART_NODES;
}

/* What stands next needs no goto when nothing is asked before it: the node at the next place, or,
 * after the last one, the first of the shared leaves. */
static int falls_through(const struct flat *flat, const struct node *node)
{
    const struct target *target = &arc_of(flat, node, 0)->target;
    if (!decides_nothing(flat, node))
        return 0;
    if (target->kind == TARGET_NODE)
        return flat->dag->nodes[target->index].order == node->order + 1
               && part_of(flat, node->order) == part_of(flat, node->order + 1);
    return flat->parts == 1 && node->order == flat->oracle->order.count - 1
           && target->index == flat->first_leaf;
}

static const struct node *node_at(const struct flat *flat, int place)
{
    return &flat->dag->nodes[flat->dag->order[flat->oracle->order.first + place]];
}

static void find_labels(struct flat *flat)
{
    for (int i = 0; i < flat->oracle->order.count; i++) {
        const struct node *node = node_at(flat, i);
        for (int a = 0; a < node->arcs.count; a++) {
            const struct target *target = &arc_of(flat, node, a)->target;
            if (has_shared_leaf(flat, target)) {
                flat->leaf_used[target->index] = 1;
                if (flat->first_leaf < 0 || target->index < flat->first_leaf)
                    flat->first_leaf = target->index;
            }
        }
    }
    int arcs = 0;
    flat->entry[0] = 1;
    for (int i = 0; i < flat->oracle->order.count; i++) {
        const struct node *node = node_at(flat, i);
        int through = falls_through(flat, node);
        flat->first_arc[i] = arcs;
        arcs += node->arcs.count;
        for (int a = 0; a < node->arcs.count; a++) {
            const struct target *target = &arc_of(flat, node, a)->target;
            if (target->kind == TARGET_NODE) {
                int to = flat->dag->nodes[target->index].order;
                flat->arcs_in[to]++;
                flat->entry[to] |= part_of(flat, i) != part_of(flat, to);
            }
            if (target->kind == TARGET_NODE && !through)
                flat->node_label[flat->dag->nodes[target->index].order] = 1;
            else if (has_shared_leaf(flat, target) && !through)
                flat->leaf_label[target->index] = 1;
        }
    }
}

static void print_constant(struct text *out, const char *prefix, const char *name)
{
    dag_print_upper(out, prefix);
    dag_print(out, "_");
    dag_print_upper(out, name);
}

/* In a part: the number of the node to go on with elsewhere, or ~decision. */
static void print_jump_in_part(const struct flat *flat, int from, const struct target *target)
{
    if (target->kind != TARGET_NODE) {
        dag_print(flat->out, "return ~(int)");
        print_constant(flat->out, "decision", flat->dag->decisions[target->index].name);
        dag_print(flat->out, ";\n");
    } else if (part_of(flat, from) == part_of(flat, flat->dag->nodes[target->index].order))
        dag_print(flat->out, "goto node_%s;\n", flat->dag->nodes[target->index].name);
    else
        dag_print(flat->out, "return %d;\n", flat->dag->nodes[target->index].order);
}

static void print_jump(const struct flat *flat, int from, const struct target *target)
{
    if (flat->parts > 1)
        print_jump_in_part(flat, from, target);
    else if (target->kind == TARGET_NODE)
        dag_print(flat->out, "goto node_%s;\n", flat->dag->nodes[target->index].name);
    else if (has_shared_leaf(flat, target))
        dag_print(flat->out, "goto leaf_%s;\n", flat->dag->decisions[target->index].name);
    else {
        dag_print(flat->out, "return ");
        print_constant(flat->out, "decision", flat->dag->decisions[target->index].name);
        dag_print(flat->out, ";\n");
    }
}

static void print_call(const struct flat *flat, const struct node *node)
{
    int value = 0;
    dag_print(flat->out, "%s_%s(%s", flat->parts > 1 ? "ask" : "tool",
              flat->dag->tools[node->tool].name, flat->at);
    for (int i = 0; i < node->arguments.count; i++) {
        dag_print(flat->out, ", ");
        dag_emit_expression(flat->dag, flat->out, node,
                            &flat->dag->arguments[node->arguments.first + i], flat->at, &value);
    }
    dag_print(flat->out, ")");
}

/* The answers that share a target share a jump; the last ones are the default, so that the
 * compiler need not think of an answer that does not exist. */
static void print_switch(const struct flat *flat, const struct node *node)
{
    const struct tool *tool = &flat->dag->tools[node->tool];
    const struct answer *answers = &flat->dag->answers[tool->answers.first];
    unsigned char done[ANSWERS_MAX] = {0};
    int left = node->arcs.count;
    if (flat->flavour == FLAVOUR_PLAIN) {
        dag_print(flat->out, "    switch (");
        print_call(flat, node);
        dag_print(flat->out, ") {\n");
    } else
        dag_print(flat->out, "    switch (answer) {\n");
    for (int i = 0; i < node->arcs.count; i++) {
        const struct target *target = &arc_of(flat, node, i)->target;
        for (int j = i; j < node->arcs.count; j++)
            if (!done[j] && same_target(target, &arc_of(flat, node, j)->target)) {
                dag_print(flat->out, "    case ");
                print_constant(flat->out, tool->name, answers[j].name);
                dag_print(flat->out, ":\n");
                done[j] = 2;
                left--;
            }
        if (done[i] == 2) {
            dag_print(flat->out, "%s        ", left == 0 ? "    default:\n" : "");
            print_jump(flat, node->order, target);
        }
        for (int j = i; j < node->arcs.count; j++)
            done[j] = done[j] != 0;
    }
    dag_print(flat->out, "    }\n");
}

/* The terms that the node handles, one by one: its arguments', then its tool's; -1: no more. */
static int term_of(const struct dag *dag, const struct node *node, int need)
{
    const struct tool *tool = &dag->tools[node->tool];
    if (need < node->reads.count)
        return dag->needs[node->reads.first + need].term;
    need -= node->reads.count;
    if (need < tool->reads.count)
        return dag->needs[tool->reads.first + need].term;
    need -= tool->reads.count;
    return need < tool->writes.count ? dag->needs[tool->writes.first + need].term : -1;
}

static const char *level_name(const struct dag *dag, const struct term *term, int level)
{
    return term->levels.count == 0 ? "present" : dag->levels[term->levels.first + level - 1].name;
}

static size_t place_of(const struct flat *flat, int term, int order)
{
    return (size_t)term * (size_t)flat->oracle->order.count + (size_t)order;
}

/* Is it worth telling the compiler that a term is known? With one arc it has seen why. */
static int is_fact(const struct flat *flat, const struct node *node, int low)
{
    return low > 0 && flat->arcs_in[node->order] > 1 && flat->parts == 1;
}

/* What the analysis knows of the terms that the node handles, for the reader as a comment
 * and, where several arcs meet, for the compiler as a fact. */
static void print_known(const struct flat *flat, const struct node *node)
{
    const struct dag *dag = flat->dag;
    for (int i = 0, term; (term = term_of(dag, node, i)) >= 0; i++) {
        const struct term *t = &dag->terms[term];
        size_t at = place_of(flat, term, node->order);
        int low = flat->sure[at];
        int seen = 0;
        for (int j = 0; j < i; j++)
            seen |= term_of(dag, node, j) == term;
        if (seen)
            continue;
        if (low > 0)
            dag_print(flat->out, "    /* %s: %s%s on every path */\n", t->name,
                      level_name(dag, t, low), low < t->levels.count ? " or better" : "");
        else
            dag_print(flat->out, "    /* %s: %s */\n", t->name,
                      !flat->possible[at] ? "absent on every path"
                                          : "checked: not every path has it");
        if (is_fact(flat, node, low)) {
            dag_print(flat->out, "    KNOWN(%sterms.%s_level >= ", flat->of, t->name);
            print_constant(flat->out, t->name, level_name(dag, t, low));
            dag_print(flat->out, ");\n");
        }
    }
}

/* The call, counted or traced; `answer` holds what it said. */
static void print_watched(const struct flat *flat, const struct node *node)
{
    dag_print(flat->out, "    answer = (int)");
    print_call(flat, node);
    dag_print(flat->out, ";\n");
    if (flat->flavour == FLAVOUR_COUNTED)
        dag_print(flat->out, "    %s_count(counters, %d, %d + answer, began);\n",
                  flat->oracle->name, node->order, flat->first_arc[node->order]);
    else
        dag_print(flat->out, "    trace(context, %s, %d, %d + answer);\n", flat->at, node->order,
                  flat->first_arc[node->order]);
}

/* "FILE:LINE", and for a copy out of a branch the places that use it, from the inside out. */
static void print_place(const struct flat *flat, const struct node *node)
{
    const struct dag *dag = flat->dag;
    struct where where = node->where;
    const char *before = "    /* ";
    for (int use = node->use;; use = dag->uses[use].outer) {
        const struct source *source = &dag->sources[where.source];
        dag_print(flat->out, "%s", before);
        dag_print_comment(flat->out, source->base);
        dag_print(flat->out, ":%d", dag_line(source, where.offset));
        before = ", used at ";
        if (use < 0)
            break;
        where = dag->uses[use].where;
    }
    dag_print(flat->out, " */\n");
}

static void print_node(const struct flat *flat, const struct node *node)
{
    int block = dag_has_reads(flat->dag, node);
    dag_print(flat->out, "\n");
    if (flat->node_label[node->order] || (flat->parts > 1 && flat->entry[node->order]))
        dag_print(flat->out, "node_%s:\n", node->name);
    if (flat->lines)
        print_place(flat, node);
    print_known(flat, node);
    if (block) /* C++ may not jump past a constant: it gets a block */
        dag_print(flat->out, "    {\n");
    if (flat->flavour == FLAVOUR_COUNTED) /* what the arguments compute is the node's time, too */
        dag_print(flat->out, "    began = %s_clock(counters);\n", flat->oracle->name);
    if (block)
        dag_emit_reads(flat->dag, flat->out, node, flat->at);
    if (flat->flavour != FLAVOUR_PLAIN)
        print_watched(flat, node);
    if (!decides_nothing(flat, node)) {
        print_switch(flat, node);
        dag_print(flat->out, "%s", block ? "    }\n" : "");
        return;
    }
    if (flat->flavour == FLAVOUR_PLAIN) {
        dag_print(flat->out, "    (void)");
        print_call(flat, node);
        dag_print(flat->out, ";\n");
    }
    dag_print(flat->out, "%s", block ? "    }\n" : "");
    if (!falls_through(flat, node)) {
        dag_print(flat->out, "    ");
        print_jump(flat, node->order, &arc_of(flat, node, 0)->target);
    }
}

static void print_leaf(const struct flat *flat, const struct decision_tool *decision)
{
    const struct dag *dag = flat->dag;
    const struct need *needs = &dag->needs[decision->reads.first];
    dag_print(flat->out, "\n");
    if (flat->leaf_label[decision - dag->decisions])
        dag_print(flat->out, "leaf_%s:\n", decision->name);
    for (int i = 0; i < decision->reads.count; i++) {
        const struct term *term = &dag->terms[needs[i].term];
        int length = dag->types[term->type].length;
        for (int k = 0; length > 1 && k < length; k++)
            dag_print(flat->out, "    discussion->terms.%s[%d] = d.terms.%s[%d];\n", term->name, k,
                      term->name, k);
        if (length == 1)
            dag_print(flat->out, "    discussion->terms.%s = d.terms.%s;\n", term->name,
                      term->name);
        dag_print(flat->out, "    discussion->terms.%s_level = d.terms.%s_level;\n", term->name,
                  term->name);
    }
    dag_print(flat->out, "    return ");
    print_constant(flat->out, "decision", decision->name);
    dag_print(flat->out, ";\n");
}

static int uses_parameters(const struct flat *flat)
{
    for (int i = 0; i < flat->oracle->order.count; i++) {
        const struct node *node = node_at(flat, i);
        for (int a = 0; a < node->arguments.count; a++) {
            int value = flat->dag->arguments[node->arguments.first + a].expression;
            if (dag_reads_parameters(flat->dag, value))
                return 1;
        }
    }
    return 0;
}

/* Terms that no decision reads are unknown at first. The values are cleared, too: a register is
 * then never filled from the caller's memory only because the compiler cannot see that the value
 * is not used. */
static void print_absent(const struct flat *flat)
{
    const struct dag *dag = flat->dag;
    for (int i = 0; i < dag->term_count; i++) {
        const struct term *term = &dag->terms[i];
        int length = dag->types[term->type].length;
        if (dag_is_kept(dag, i) || (flat->terms != NULL && !flat->terms[i]))
            continue;
        dag_print(flat->out, "    ");
        for (int k = 0; length > 1 && k < length; k++)
            dag_print(flat->out, "d.terms.%s[%d] = ", term->name, k);
        if (length == 1)
            dag_print(flat->out, "d.terms.%s = ", term->name);
        dag_print(flat->out, "0;\n    d.terms.%s_level = ", term->name);
        print_constant(flat->out, term->name, "absent");
        dag_print(flat->out, ";\n");
    }
}

static void print_watch_variables(const struct flat *flat)
{
    if (flat->flavour == FLAVOUR_COUNTED)
        dag_print(flat->out, "    double began;\n");
    if (flat->flavour != FLAVOUR_PLAIN)
        dag_print(flat->out, "    int answer;\n");
}

static const char *part_suffix(const struct flat *flat)
{
    static const char *const suffixes[] = {"part", "counted_part", "traced_part"};
    return suffixes[flat->flavour];
}

/* Whatever follows the discussion in the argument list of a counted or traced function. */
static void print_watch_parameters(const struct flat *flat)
{
    if (flat->flavour == FLAVOUR_COUNTED)
        dag_print(flat->out, ",\n    struct %s_counters *counters", flat->oracle->name);
    else if (flat->flavour == FLAVOUR_TRACED)
        dag_print(flat->out,
                  ",\n    void (*trace)(void *context, const struct discussion *discussion,"
                  " int node, int arc),\n    void *context");
}

/* static int NAME_part_N(...): the nodes PART_NODES * N and on, from node `at`. */
static void print_part(const struct flat *flat, int part)
{
    struct text *out = flat->out;
    int first = part * PART_NODES, end = first + PART_NODES, entries = 0;
    if (end > flat->oracle->order.count)
        end = flat->oracle->order.count;
    dag_print(out,
              "\nstatic int %s_%s_%d(const struct %s_parameters *parameters,\n"
              "    struct discussion *d, int at",
              flat->oracle->name, part_suffix(flat), part, flat->oracle->name);
    print_watch_parameters(flat);
    dag_print(out, ")\n{\n");
    print_watch_variables(flat);
    dag_print(out, "    (void)parameters;\n");
    for (int i = first; i < end; i++)
        entries += flat->entry[i];
    int left = entries;
    dag_print(out, "    switch (at) {\n");
    for (int i = first; i < end; i++)
        if (flat->entry[i])
            dag_print(out, "    case %d:\n%s        goto node_%s;\n", i,
                      --left == 0 ? "    default:\n" : "", node_at(flat, i)->name);
    dag_print(out, "    }\n");
    for (int i = first; i < end; i++)
        print_node(flat, node_at(flat, i));
    dag_print(out, "}\n");
}

/* The function that hands one discussion from part to part. */
static void print_parts_loop(const struct flat *flat)
{
    struct text *out = flat->out;
    dag_print(out, "    int at = 0;\n");
    print_absent(flat);
    dag_print(out, "    while (at >= 0) {\n        switch (at / %d) {\n", PART_NODES);
    for (int i = 0; i < flat->parts; i++) {
        dag_print(out,
                  "        case %d:\n%s            at = %s_%s_%d(parameters, &d, at%s);\n"
                  "            break;\n",
                  i, i == flat->parts - 1 ? "        default:\n" : "", flat->oracle->name,
                  part_suffix(flat), i,
                  flat->flavour == FLAVOUR_COUNTED  ? ", counters"
                  : flat->flavour == FLAVOUR_TRACED ? ", trace, context"
                                                    : "");
    }
    dag_print(out, "        }\n    }\n");
    if (dag_emit_has_doubts(flat->dag))
        dag_print(out, "    discussion->terms.no_number = d.terms.no_number;\n");
    for (int i = 0; i < flat->dag->decision_count; i++)
        if (flat->leaf_used[i]) {
            dag_print(out, "    if (~at == (int)");
            print_constant(out, "decision", flat->dag->decisions[i].name);
            dag_print(out, ")\n        goto leaf_%s;\n", flat->dag->decisions[i].name);
        }
    dag_print(out, "    return (enum decision)~at;\n");
}

static struct flat open_flat(struct dag *dag, struct text *out, const struct oracle_graph *oracle,
                             enum flavour flavour)
{
    size_t nodes = (size_t)oracle->order.count;
    struct flat flat = {0};
    flat.dag = dag;
    flat.out = out;
    flat.oracle = oracle;
    flat.flavour = flavour;
    flat.first_leaf = -1;
    flat.parts = nodes > PART_NODES ? (int)((nodes + PART_NODES - 1) / PART_NODES) : 1;
    flat.at = flat.parts > 1 ? "d" : "&d";
    flat.of = flat.parts > 1 ? "d->" : "d.";
    flat.sure = dag_alloc(&dag->arena, nodes * (size_t)dag->term_count);
    flat.possible = dag_alloc(&dag->arena, nodes * (size_t)dag->term_count);
    for (int t = 0; t < dag->term_count; t++) {
        dag_sure_levels(dag, oracle, t, flat.sure + place_of(&flat, t, 0));
        dag_possible_terms(dag, oracle, t, flat.possible + place_of(&flat, t, 0));
    }
    flat.arcs_in = dag_alloc(&dag->arena, nodes * sizeof(int));
    flat.first_arc = dag_alloc(&dag->arena, nodes * sizeof(int));
    flat.entry = dag_alloc(&dag->arena, nodes);
    flat.node_label = dag_alloc(&dag->arena, nodes);
    flat.leaf_label = dag_alloc(&dag->arena, (size_t)dag->decision_count);
    flat.leaf_used = dag_alloc(&dag->arena, (size_t)dag->decision_count);
    find_labels(&flat);
    return flat;
}

int dag_emit_states_facts(struct dag *dag)
{
    for (int i = 0; i < dag->oracle_count; i++) {
        struct flat flat = open_flat(dag, NULL, &dag->oracles[i], FLAVOUR_PLAIN);
        for (int n = 0; n < flat.oracle->order.count; n++) {
            const struct node *node = node_at(&flat, n);
            for (int k = 0, term; (term = term_of(dag, node, k)) >= 0; k++)
                if (is_fact(&flat, node, flat.sure[place_of(&flat, term, n)]))
                    return 1;
        }
    }
    return 0;
}

void dag_emit_flat(struct dag *dag, struct text *out, const struct oracle_graph *oracle,
                   enum flavour flavour, const struct emit_options *options)
{
    struct flat flat = open_flat(dag, out, oracle, flavour);
    flat.terms = options->terms;
    flat.lines = options->lines;
    for (int i = 0; flat.parts > 1 && i < flat.parts; i++)
        print_part(&flat, i);
    dag_print(out, "\n");
    dag_emit_prototype(out, oracle, flavour);
    dag_print(out, "\n{\n    struct discussion d = *discussion;\n");
    if (flat.parts > 1)
        print_parts_loop(&flat);
    else {
        print_watch_variables(&flat);
        print_absent(&flat);
        if (!uses_parameters(&flat))
            dag_print(out, "    (void)parameters;\n");
        for (int i = 0; i < oracle->order.count; i++)
            print_node(&flat, node_at(&flat, i));
    }
    for (int i = 0; i < dag->decision_count; i++)
        if (flat.leaf_used[i]) {
            flat.leaf_label[i] |= flat.parts > 1;
            print_leaf(&flat, &dag->decisions[i]);
        }
    dag_print(out, "}\n");
}

void dag_emit_callers(const struct dag *dag, struct text *out, const unsigned char *reached)
{
    int any = 0;
    for (int i = 0; i < dag->oracle_count; i++)
        any |= dag->oracles[i].order.count > PART_NODES;
    if (!any)
        return;
    dag_print(out,
              "\n#if defined __GNUC__\n#define CALLED static __attribute__((noinline, unused))\n"
              "#else\n#define CALLED static\n#endif\n");
    for (int i = 0; i < dag->tool_count; i++) {
        const struct tool *tool = &dag->tools[i];
        const struct parameter *parameters = &dag->parameters[tool->parameters.first];
        if (!reached[i])
            continue;
        dag_print(out, "\nCALLED enum %s_answer ask_%s(struct discussion *d", tool->name,
                  tool->name);
        for (int k = 0; k < tool->parameters.count; k++)
            dag_print(out, ", %s %s_",
                      dag->types[parameters[k].type].base == BASE_INTEGER ? "int" : "double",
                      parameters[k].name);
        dag_print(out, ")\n{\n    return tool_%s(d", tool->name);
        for (int k = 0; k < tool->parameters.count; k++)
            dag_print(out, ", %s_", parameters[k].name);
        dag_print(out, ");\n}\n");
    }
}
