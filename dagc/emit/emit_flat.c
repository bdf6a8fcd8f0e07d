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
#include "emit/flat.h"

/* Is it to be given back? What a decision merely keeps, and no node handles, is as it came. */
static int gives_back(const struct flat *flat, const struct need *need)
{
    return need->level > 0 || flat->handled[need->term];
}

int dag_flat_has_leaf(const struct flat *flat, const struct target *target)
{
    if (target->kind != TARGET_DECISION)
        return 0;
    const struct span reads = flat->dag->decisions[target->index].reads;
    for (int i = reads.first; i < reads.first + reads.count; i++)
        if (gives_back(flat, &flat->dag->needs[i]))
            return 1;
    return 0;
}

static void find_labels(struct flat *flat)
{
    int arcs = 0;
    flat->entry[0] = 1;
    for (int i = 0; i < flat->oracle->order.count; i++) {
        const struct node *node = dag_flat_at(flat, i);
        flat->first_arc[i] = arcs;
        arcs += node->arcs.count;
        for (int a = 0; a < node->arcs.count; a++) {
            const struct target *target = &dag_flat_arc(flat, node, a)->target;
            if (dag_flat_has_leaf(flat, target)) {
                flat->leaf_used[target->index] = 1;
                if (flat->first_leaf < 0 || target->index < flat->first_leaf)
                    flat->first_leaf = target->index;
            }
            if (target->kind == TARGET_NODE) {
                int to = flat->dag->nodes[target->index].order;
                flat->entry[to] |= dag_flat_part(flat, i) != dag_flat_part(flat, to);
            }
        }
    }
    for (int i = 0; i < flat->copies.count; i++)
        dag_flat_mark_labels(flat, i);
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
        if (!gives_back(flat, &needs[i]))
            continue;
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
    dag_print_constant(flat->out, "decision", decision->name);
    dag_print(flat->out, ";\n");
}

static int uses_parameters(const struct flat *flat)
{
    for (int i = 0; i < flat->oracle->order.count; i++) {
        const struct node *node = dag_flat_at(flat, i);
        for (int a = 0; a < node->arguments.count; a++) {
            int value = flat->dag->arguments[node->arguments.first + a].expression;
            if (dag_reads_parameters(flat->dag, value))
                return 1;
        }
    }
    return 0;
}

/* The term is unknown. The value is cleared, too: a register is then never filled from the caller's
 * memory only because the compiler cannot see that the value is not used. */
static void print_unknown(const struct flat *flat, int number, const char *indent)
{
    const struct term *term = &flat->dag->terms[number];
    int length = flat->dag->types[term->type].length;
    dag_print(flat->out, "%s", indent);
    for (int k = 0; length > 1 && k < length; k++)
        dag_print(flat->out, "d.terms.%s[%d] = ", term->name, k);
    if (length == 1)
        dag_print(flat->out, "d.terms.%s = ", term->name);
    dag_print(flat->out, "0;\n%sd.terms.%s_level = ", indent, term->name);
    dag_print_constant(flat->out, term->name, "absent");
    dag_print(flat->out, ";\n");
}

/* Who counts has one entry: the discussion itself says whether it is the first. */
static void print_is_first(const struct flat *flat)
{
    dag_print(flat->out, "    int first = 1;\n");
    for (int i = 0; i < flat->dag->term_count; i++)
        if (dag_is_kept(flat->dag, i))
            dag_print(flat->out, "    first &= d.terms.%s_level == 0;\n", flat->dag->terms[i].name);
}

static int same_way(const struct copies *copies, int a, int b)
{
    return copies->ways[a].cut == 0 && copies->ways[b].cut == 0
           && copies->ways[a].below == copies->ways[b].below;
}

/* All that a discussion may begin with, by one look: the levels as the digits of a number. */
static void print_starts(const struct flat *flat)
{
    const struct copies *copies = &flat->copies;
    struct text *out = flat->out;
    if (copies->look_count == 0) {
        dag_print(out, "    ");
        dag_flat_way(flat, copies->general, 4);
        return;
    }
    if (flat->flavour == FLAVOUR_COUNTED)
        dag_print(out, "    counters->checks++;\n");
    dag_print(out, "    switch (");
    for (int i = 0; i < copies->look_count; i++) {
        const struct look *look = &copies->looks[i];
        const struct term *term = &flat->dag->terms[look->term];
        dag_print(out, "%s(d.terms.%s_level >= ", i > 0 ? "\n            + " : "", term->name);
        dag_print_constant(out, term->name, dag_flat_level(flat->dag, term, look->level));
        dag_print(out, ") * %d", look->weight);
    }
    dag_print(out, ") {\n");
    for (int i = 0; i < copies->start_count; i++)
        if (copies->starts[i] != copies->general) {
            int next = i + 1 < copies->start_count ? copies->starts[i + 1] : copies->general;
            dag_print(out, "    case %d:\n", i);
            if (same_way(copies, copies->starts[i], next))
                continue;
            dag_print(out, "        ");
            dag_flat_way(flat, copies->starts[i], 8);
        }
    dag_print(out, "    default:\n        ");
    dag_flat_way(flat, copies->general, 8);
    dag_print(out, "    }\n");
}

/* Terms that no decision reads are unknown at first; with copies, so are the others in a first
 * discussion, which enters where they are. Whoever begins with more enters where that is known. */
static void print_absent(const struct flat *flat)
{
    for (int i = 0; i < flat->dag->term_count; i++)
        if (!dag_is_kept(flat->dag, i) && (flat->terms == NULL || flat->terms[i]))
            print_unknown(flat, i, "    ");
    if (flat->most == 1)
        return;
    if (flat->flavour == FLAVOUR_COUNTED)
        print_is_first(flat);
    dag_print(flat->out, "    if (first) {\n");
    for (int i = 0; i < flat->dag->term_count; i++)
        if (dag_is_kept(flat->dag, i))
            print_unknown(flat, i, "        ");
    dag_print(flat->out, "        ");
    dag_flat_way(flat, flat->copies.nothing, 8);
    dag_print(flat->out, "    }\n");
    print_starts(flat);
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
                      --left == 0 ? "    default:\n" : "", dag_flat_at(flat, i)->name);
    dag_print(out, "    }\n");
    for (int i = first; i < end; i++)
        dag_flat_node(flat, flat->copies.first[i]);
    dag_flat_directive(flat, dag_nowhere);
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
            dag_print_constant(out, "decision", flat->dag->decisions[i].name);
            dag_print(out, ")\n        goto leaf_%s;\n", flat->dag->decisions[i].name);
        }
    dag_print(out, "    return (enum decision)~at;\n");
}

/* How many functions the graph becomes, not counting those of --outline: one, if with these none is
 * too large. */
static int count_parts(struct dag *dag, const struct oracle_graph *oracle, enum flavour flavour,
                       const struct emit_options *options)
{
    struct shared *shared;
    int nodes = oracle->order.count, left = nodes, most = 0;
    if (nodes > PART_NODES && options->outline && flavour == FLAVOUR_PLAIN)
        for (int i = dag_find_shared(dag, oracle, &shared) - 1; i >= 0; i--) {
            left -= shared[i].uses * (shared[i].nodes - 1);
            most = shared[i].nodes > most ? shared[i].nodes : most;
        }
    return left <= PART_NODES && most <= PART_NODES ? 1 : (nodes + PART_NODES - 1) / PART_NODES;
}

static struct flat open_flat(struct dag *dag, struct text *out, const struct oracle_graph *oracle,
                             enum flavour flavour, const struct emit_options *options)
{
    size_t nodes = (size_t)oracle->order.count;
    struct flat flat = {0};
    flat.dag = dag;
    flat.out = out;
    flat.oracle = oracle;
    flat.flavour = flavour;
    flat.first_leaf = -1;
    flat.parts = count_parts(dag, oracle, flavour, options);
    flat.at = flat.parts > 1 ? "d" : "&d";
    flat.of = flat.parts > 1 ? "d->" : "d.";
    flat.most =
        flat.parts > 1 || flavour == FLAVOUR_TRACED || options->copies < 1 ? 1 : options->copies;
    flat.copies = dag_copies(dag, oracle, flat.most);
    flat.first_arc = dag_alloc(&dag->arena, nodes * sizeof(int));
    flat.entry = dag_alloc(&dag->arena, nodes);
    flat.node_label = dag_alloc(&dag->arena, (size_t)flat.copies.count);
    flat.leaf_label = dag_alloc(&dag->arena, (size_t)dag->decision_count);
    flat.leaf_used = dag_alloc(&dag->arena, (size_t)dag->decision_count);
    flat.handled = dag_alloc(&dag->arena, (size_t)dag->term_count);
    for (int i = 0, term; i < oracle->order.count; i++)
        for (int k = 0; (term = dag_flat_term(dag, dag_flat_at(&flat, i), k)) >= 0; k++)
            flat.handled[term] = 1;
    find_labels(&flat);
    if (flat.most > 1) {
        dag_flat_label_way(&flat, flat.copies.general);
        dag_flat_label_way(&flat, flat.copies.nothing);
        for (int i = 0; i < flat.copies.start_count; i++)
            dag_flat_label_way(&flat, flat.copies.starts[i]);
    }
    return flat;
}

int dag_emit_states_facts(struct dag *dag, const struct emit_options *options)
{
    for (int i = 0; i < dag->oracle_count; i++) {
        struct flat flat = open_flat(dag, NULL, &dag->oracles[i], FLAVOUR_PLAIN, options);
        for (int n = 0; n < flat.copies.count; n++) {
            const struct copy *copy = &flat.copies.items[n];
            const struct node *node = dag_flat_at(&flat, copy->place);
            for (int k = 0, term; (term = dag_flat_term(dag, node, k)) >= 0; k++)
                if (dag_flat_is_fact(&flat, copy, term))
                    return 1;
        }
    }
    return 0;
}

void dag_emit_flat(struct dag *dag, struct text *out, const struct oracle_graph *oracle,
                   enum flavour flavour, const struct emit_options *options)
{
    struct flat flat = open_flat(dag, out, oracle, flavour, options);
    flat.terms = options->terms;
    flat.lines = options->lines;
    flat.watched = options->before != NULL;
    flat.directives = options->directives;
    for (int i = 0; flat.parts > 1 && i < flat.parts; i++)
        print_part(&flat, i);
    if (options->outline && flavour == FLAVOUR_PLAIN && flat.parts == 1)
        dag_flat_outline(&flat);
    dag_print(out, "\n");
    /* two entries to one body */
    int entries = flavour == FLAVOUR_PLAIN && options->copies > 1;
    if (entries)
        dag_print(out,
                  "static enum decision %s_discuss(const struct %s_parameters *parameters,\n"
                  "    struct discussion *discussion%s)",
                  oracle->name, oracle->name, flat.most > 1 ? ", int first" : "");
    else
        dag_emit_prototype(dag, out, oracle, flavour);
    dag_print(out, "\n{\n    struct discussion d = *discussion;\n");
    if (flat.parts > 1)
        print_parts_loop(&flat);
    else {
        print_watch_variables(&flat);
        if (!uses_parameters(&flat))
            dag_print(out, "    (void)parameters;\n");
        print_absent(&flat);
        for (int i = flat.copies.first[0]; i >= 0; i = dag_flat_behind(&flat, i))
            dag_flat_node_or_call(&flat, i);
        dag_flat_directive(&flat, dag_nowhere);
    }
    for (int i = 0; i < dag->decision_count; i++)
        if (flat.leaf_used[i]) {
            flat.leaf_label[i] |= flat.parts > 1;
            print_leaf(&flat, &dag->decisions[i]);
        }
    dag_print(out, "}\n");
    for (int first = 0; entries && first < 2; first++) {
        dag_print(out, "\n");
        dag_emit_prototype(dag, out, oracle, first ? FLAVOUR_FIRST : FLAVOUR_PLAIN);
        dag_print(out, "\n{\n    return %s_discuss(parameters, discussion%s);\n}\n", oracle->name,
                  flat.most == 1 ? ""
                  : first        ? ", 1"
                                 : ", 0");
    }
}

void dag_emit_callers(struct dag *dag, struct text *out, const unsigned char *reached,
                      const struct emit_options *options)
{
    int any = 0;
    for (int i = 0; i < dag->oracle_count; i++)
        any |= count_parts(dag, &dag->oracles[i],
                           options->counted || options->traced ? FLAVOUR_COUNTED : FLAVOUR_PLAIN,
                           options)
               > 1;
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
            dag_print(out, ", %s %s_", dag_c_type(dag, parameters[k].type), parameters[k].name);
        dag_print(out, ")\n{\n    return tool_%s(d", tool->name);
        for (int k = 0; k < tool->parameters.count; k++)
            dag_print(out, ", %s_", parameters[k].name);
        dag_print(out, ");\n}\n");
    }
}
