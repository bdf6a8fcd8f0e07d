/* emit_wave.c - a decision graph as a C function over a block of pairs.
 *
 * A graph has no circle, so one sweep over its nodes in topological order treats a block: all pairs
 * that have reached a node stand in its list, the tool answers for the whole list, and the answers
 * part the list among the nodes that follow. So a tool sees many pairs at once, and may compute
 * them in vectors, or send their rays together; and a processor sees one loop after the other in
 * place of branches that no two pairs take alike.
 *
 * A tool's own wave form (tools/NAME.wave.h, `wave` in the catalog) is given the list, and loops
 * behind it part what it answers. Of any other tool the scalar form stands in a loop that parts
 * the pairs as they are answered: no answer is stored, and each pair is looked up once. Terms stay
 * in each pair's discussion, so the forms of tools depend on no graph. A list is used again when
 * its node is done: there are as many as nodes wait at a time.
 *
 * Invariant: what is done to a pair depends on no other pair; calls of one pair come in the order
 * of the flat release. So decisions and terms are those of NAME_refine, to the bit.
 * SPDX-License-Identifier: MIT */
#include "analyse/analyse.h"
#include "analyse/profile.h"
#include "emit/emit.h"
#include "emit/line_directives.h"

/* A graph in which more nodes wait than LISTS_MOST would need too much of a stack and goes pair by
 * pair. */
enum { LISTS_MOST = 1000, NO_LIST = 0 };

struct wave {
    struct dag *dag;
    struct text *out;
    const struct oracle_graph *oracle;
    const struct emit_options *options;
    int *list; /* by place in the order; those that are decided stand in none, NO_LIST */
    int lists;
};

static const struct node *node_at(const struct wave *wave, int place)
{
    return dag_node_at(wave->dag, wave->oracle, place);
}

static const struct arc *arc_of(const struct wave *wave, const struct node *node, int answer)
{
    return &wave->dag->arcs[node->arcs.first + answer];
}

/* A node's list is used from the first node that leads to it until its own end. */
static void assign_lists(struct wave *wave)
{
    const int nodes = wave->oracle->order.count;
    int *unused = dag_alloc(&wave->dag->arena, (size_t)nodes * sizeof *unused), count = 0;
    wave->list = dag_alloc(&wave->dag->arena, (size_t)nodes * sizeof *wave->list);
    wave->list[0] = 1;
    wave->lists = 2;
    for (int i = 0; i < nodes; i++) {
        const struct node *node = node_at(wave, i);
        for (int a = 0; a < node->arcs.count; a++) {
            const struct target *target = &arc_of(wave, node, a)->target;
            if (target->kind != TARGET_NODE)
                continue;
            int *list = &wave->list[wave->dag->nodes[target->index].order];
            if (*list == NO_LIST)
                *list = count > 0 ? unused[--count] : wave->lists++;
        }
        unused[count++] = wave->list[i];
    }
}

static void print_prototype(const struct dag *dag, struct text *out,
                            const struct oracle_graph *oracle)
{
    dag_print(out,
              "void %s_%s_wave(const struct %s_parameters *parameters,\n"
              "    struct discussion *block, int count, enum decision *decisions)",
              oracle->name, dag->verb, oracle->name);
}

void dag_emit_wave_h(const struct dag *dag, struct text *out, const struct oracle_graph *oracle)
{
    dag_print(out,
              "\n/* The same of `count` discussions, which have one host: decisions[i] is that of"
              " block[i].\n * Which of them stand together makes no difference. */\n");
    print_prototype(dag, out, oracle);
    dag_print(out, ";\n");
}

void dag_emit_wave_headers(struct dag *dag, struct text *out, const unsigned char *reached)
{
    const unsigned char *terms = dag_emit_reached(dag).terms;
    for (int i = 0; i < dag->tool_count; i++)
        if (reached[i] && dag->tools[i].wave != NULL)
            dag_print(out, "#include \"%s\"\n", dag->tools[i].wave);
    for (int i = 0; i < dag->term_count; i++)
        if (terms[i] && dag->terms[i].wave != NULL)
            dag_print(out, "#include \"%s\"\n", dag->terms[i].wave);
}

static int reaches_wave_form(const struct dag *dag, const unsigned char *reached)
{
    for (int i = 0; i < dag->tool_count; i++)
        if (reached[i] && dag->tools[i].wave != NULL)
            return 1;
    return 0;
}

/* Does some answer of a tool that answers for a list lead to what is of that kind? */
static int leads_to(const struct dag *dag, enum target_kind kind)
{
    for (int k = 0; k < dag->oracle_count; k++)
        for (int i = 0; i < dag->oracles[k].order.count; i++) {
            const struct node *node = dag_node_at(dag, &dag->oracles[k], i);
            for (int a = 0; dag->tools[node->tool].wave != NULL && a < node->arcs.count; a++)
                if (dag->arcs[node->arcs.first + a].target.kind == kind)
                    return 1;
        }
    return 0;
}

void dag_emit_wave_calls(struct dag *dag, struct text *out, const unsigned char *reached)
{
    if (!reaches_wave_form(dag, reached))
        return;
    if (leads_to(dag, TARGET_NODE))
        dag_print(
            out,
            "\n/* Of the pairs of a list those whose answer leads on to another, behind the "
            "`waiting` "
            "that\n * are there. Every pair is written, and the next in its place unless it is "
            "counted: no branch,\n * so that answers in any order cost the same. Returns how many "
            "are there. */\n"
            "static int lists_part(const unsigned char *leads, const unsigned char *answers,\n"
            "    const uint16_t *from, int count, uint16_t *to, int waiting)\n{\n"
            "    for (int k = 0; k < count; k++) {\n"
            "        to[waiting] = from[k];\n"
            "        waiting += leads[answers[k]];\n    }\n"
            "    return waiting;\n}\n");
    if (leads_to(dag, TARGET_DECISION))
        dag_print(
            out,
            "\n/* What answers decide; where one leads on it is told later, and until then "
            "anything. */\n"
            "static void lists_decide(const enum decision *decides, const unsigned char *answers,\n"
            "    const uint16_t *from, int count, enum decision *decisions)\n{\n"
            "    for (int k = 0; k < count; k++)\n"
            "        decisions[from[k]] = decides[answers[k]];\n}\n");
}

/* The list that an answer leads to. */
static int list_behind(const struct wave *wave, const struct node *node, int answer)
{
    const struct target *target = &arc_of(wave, node, answer)->target;
    return target->kind == TARGET_DECISION ? NO_LIST
                                           : wave->list[wave->dag->nodes[target->index].order];
}

/* static const enum decision decides[] = {DECISION_...}. Returns 0, and prints none, where no
 * answer decides. */
static int print_decides(const struct wave *wave, const struct node *node)
{
    const struct dag *dag = wave->dag;
    int any = 0;
    for (int a = 0; a < node->arcs.count; a++)
        any |= list_behind(wave, node, a) == NO_LIST;
    if (!any)
        return 0;
    dag_print(wave->out, "        static const enum decision decides[] = {");
    for (int a = 0; a < node->arcs.count; a++) {
        const struct target *target = &arc_of(wave, node, a)->target;
        dag_print(wave->out, "%sDECISION_", a > 0 ? ", " : "");
        dag_print_upper(wave->out,
                        dag->decisions[target->kind == TARGET_DECISION ? target->index : 0].name);
    }
    dag_print(wave->out, "};\n");
    return 1;
}

/* The list that answer `a` leads to, unless one before it did; else NO_LIST. */
static int new_list(const struct wave *wave, const struct node *node, int a)
{
    const int to = list_behind(wave, node, a);
    for (int k = 0; k < a; k++)
        if (list_behind(wave, node, k) == to)
            return NO_LIST;
    return to;
}

/* static const unsigned char leads_2[] = {...}: 1 for each answer that leads to the list. */
static void print_leads(const struct wave *wave, const struct node *node, int to)
{
    dag_print(wave->out, "        static const unsigned char leads_%d[] = {", to);
    for (int k = 0; k < node->arcs.count; k++)
        dag_print(wave->out, "%s%d", k > 0 ? ", " : "", list_behind(wave, node, k) == to);
    dag_print(wave->out, "};\n");
}

/* What answers[] say of a list: decisions, and one sweep for each list that answers lead to. */
static void print_ways(const struct wave *wave, const struct node *node, int list)
{
    if (print_decides(wave, node))
        dag_print(wave->out,
                  "        lists_decide(decides, answers, at[%d], waiting[%d], decisions);\n", list,
                  list);
    for (int a = 0; a < node->arcs.count; a++) {
        const int to = new_list(wave, node, a);
        if (to == NO_LIST)
            continue;
        print_leads(wave, node, to);
        dag_print(wave->out,
                  "        waiting[%d] = lists_part(leads_%d, answers, at[%d], waiting[%d], "
                  "at[%d], waiting[%d]);\n",
                  to, to, list, list, to, to);
    }
}

/* Does an argument look at the discussion? */
static int looks_at_pair(const struct dag *dag, const struct node *node)
{
    for (int i = 0; i < node->arguments.count; i++) {
        const struct argument *argument = &dag->arguments[node->arguments.first + i];
        if (!dag_is_fixed(dag, argument->expression) || dag_is_doubtful(dag, argument))
            return 1;
    }
    return 0;
}

/* The term that is read first, by its form over a list, if it has one. No other: a later one may
 * depend on what is known when the pair comes to it. */
static void print_first_read(const struct wave *wave, const struct node *node, int list)
{
    const struct dag *dag = wave->dag;
    const struct need *need = &dag->needs[node->reads.first];
    if (node->reads.count == 0 || dag->terms[need->term].wave == NULL)
        return;
    const struct term *term = &dag->terms[need->term];
    dag_print(wave->out, "        wave_term_%s(block, at[%d], waiting[%d]", term->name, list, list);
    if (term->levels.count > 0) {
        dag_print(wave->out, ", ");
        dag_print_constant(wave->out, term->name,
                           dag->levels[term->levels.first + need->level - 1].name);
    }
    dag_print(wave->out, ");\n");
}

/* An argument's C type and name, `given_1`. */
static void print_given(const struct wave *wave, const struct node *node, int i)
{
    const struct dag *dag = wave->dag;
    dag_print(
        wave->out, "%s given_%d",
        dag_c_type(dag, dag->parameters[dag->arguments[node->arguments.first + i].parameter].type),
        i + 1);
}

/* The arguments of all pairs of the list, given_1[k] and so on. */
static void print_arguments(const struct wave *wave, const struct node *node, int list)
{
    const struct place place = {"d", "d", NULL};
    struct text *out = wave->out;
    int value = 0;
    for (int i = 0; i < node->arguments.count; i++) {
        dag_print(out, "        ");
        print_given(wave, node, i);
        dag_print(out, "[%d];\n", DAG_WAVE_PAIRS);
    }
    if (node->arguments.count == 0)
        return;
    print_first_read(wave, node, list);
    dag_print(out, "        for (int k = 0; k < waiting[%d]; k++) {\n", list);
    if (looks_at_pair(wave->dag, node))
        dag_print(out, "            struct discussion *d = &block[at[%d][k]];\n", list);
    dag_emit_reads(wave->dag, out, node, &place);
    for (int i = 0; i < node->arguments.count; i++) {
        dag_print(out, "            given_%d[k] = ", i + 1);
        dag_emit_expression(wave->dag, out, node, &wave->dag->arguments[node->arguments.first + i],
                            &place, &value);
        dag_print(out, ";\n");
    }
    dag_print(out, "        }\n");
}

/* A tool that answers for the whole list. */
static void print_together(const struct wave *wave, const struct node *node, int list)
{
    struct text *out = wave->out;
    print_arguments(wave, node, list);
    dag_print(out, "        wave_%s(block, at[%d], waiting[%d]", wave->dag->tools[node->tool].name,
              list, list);
    for (int i = 0; i < node->arguments.count; i++)
        dag_print(out, ", given_%d", i + 1);
    dag_print(out, ", answers);\n");
    print_ways(wave, node, list);
}

/* const int answer = (int)tool_NAME(d, ...); of one pair. */
static void print_question(const struct wave *wave, const struct node *node)
{
    const struct place place = {"d", "d", NULL};
    struct text *out = wave->out;
    int value = 0;
    dag_emit_reads(wave->dag, out, node, &place);
    for (int i = 0; i < node->arguments.count; i++) {
        dag_print(out, "            const ");
        print_given(wave, node, i);
        dag_print(out, " = ");
        dag_emit_expression(wave->dag, out, node, &wave->dag->arguments[node->arguments.first + i],
                            &place, &value);
        dag_print(out, ";\n");
    }
    dag_print(out, "            const int answer = (int)tool_%s(d",
              wave->dag->tools[node->tool].name);
    for (int i = 0; i < node->arguments.count; i++)
        dag_print(out, ", given_%d", i + 1);
    dag_print(out, ");\n");
}

/* A tool that is asked pair by pair: each pair goes on to the end of its list. It is written to
 * all that there are, and counted in its own: no branch, as in lists_part. */
static void print_one_by_one(const struct wave *wave, const struct node *node, int list)
{
    struct text *out = wave->out;
    const int decides = print_decides(wave, node);
    for (int a = 0; a < node->arcs.count; a++) {
        const int to = new_list(wave, node, a);
        if (to == NO_LIST)
            continue;
        print_leads(wave, node, to);
        dag_print(out, "        int to_%d = waiting[%d];\n", to, to);
    }
    print_first_read(wave, node, list);
    dag_print(out,
              "        for (int k = 0; k < waiting[%d]; k++) {\n"
              "            const uint16_t pair = at[%d][k];\n"
              "            struct discussion *d = &block[pair];\n",
              list, list);
    print_question(wave, node);
    if (decides)
        dag_print(out, "            decisions[pair] = decides[answer];\n");
    for (int a = 0; a < node->arcs.count; a++) {
        const int to = new_list(wave, node, a);
        if (to != NO_LIST)
            dag_print(out,
                      "            at[%d][to_%d] = pair;\n"
                      "            to_%d += leads_%d[answer];\n",
                      to, to, to, to);
    }
    dag_print(out, "        }\n");
    for (int a = 0; a < node->arcs.count; a++) {
        const int to = new_list(wave, node, a);
        if (to != NO_LIST)
            dag_print(out, "        waiting[%d] = to_%d;\n", to, to);
    }
}

static void print_node(const struct wave *wave, int place)
{
    const struct node *node = node_at(wave, place);
    const int list = wave->list[place];
    struct text *out = wave->out;
    dag_print(out, "\n        /* %s */\n", node->name);
    if (wave->options->directives)
        dag_line_at(wave->dag, out, node->where);
    dag_print(out, "        if (waiting[%d] > 0) {\n", list);
    if (wave->dag->tools[node->tool].wave != NULL)
        print_together(wave, node, list);
    else
        print_one_by_one(wave, node, list);
    dag_print(out, "        waiting[%d] = 0;\n        }\n", list);
}

/* What no decision reads is unknown at first. */
static void print_begin(const struct wave *wave)
{
    dag_print(wave->out,
              "        const int pairs = count < %d ? count : %d;\n"
              "        for (int k = 0; k < pairs; k++) {\n"
              "            at[1][k] = (uint16_t)k;\n",
              DAG_WAVE_PAIRS, DAG_WAVE_PAIRS);
    for (int i = 0; i < wave->dag->term_count; i++) {
        const char *name = wave->dag->terms[i].name;
        if (dag_is_kept(wave->dag, i) || (wave->options->terms != NULL && !wave->options->terms[i]))
            continue;
        dag_print(wave->out, "            block[k].terms.%s_level = ", name);
        dag_print_upper(wave->out, name);
        dag_print(wave->out, "_ABSENT;\n");
    }
    dag_print(wave->out, "        }\n        waiting[1] = pairs;\n");
}

static int asks_together(const struct wave *wave)
{
    for (int i = 0; i < wave->oracle->order.count; i++)
        if (wave->dag->tools[node_at(wave, i)->tool].wave != NULL)
            return 1;
    return 0;
}

void dag_emit_wave(struct dag *dag, struct text *out, const struct oracle_graph *oracle,
                   const struct emit_options *options)
{
    struct wave wave = {.dag = dag, .out = out, .oracle = oracle, .options = options};
    assign_lists(&wave);
    dag_print(out, "\n");
    print_prototype(dag, out, oracle);
    dag_print(out, "\n{\n");
    if (wave.lists > LISTS_MOST) {
        dag_print(out,
                  "    for (int i = 0; i < count; i++)\n"
                  "        decisions[i] = %s_%s(parameters, &block[i]);\n}\n",
                  oracle->name, dag->verb);
        return;
    }
    dag_print(out, "    uint16_t at[%d][%d];\n    int waiting[%d] = {0};\n", wave.lists,
              DAG_WAVE_PAIRS, wave.lists);
    if (asks_together(&wave))
        dag_print(out, "    unsigned char answers[%d];\n", DAG_WAVE_PAIRS);
    dag_print(out,
              "    (void)parameters;\n"
              "    for (; count > 0; count -= %d, block += %d, decisions += %d) {\n",
              DAG_WAVE_PAIRS, DAG_WAVE_PAIRS, DAG_WAVE_PAIRS);
    print_begin(&wave);
    for (int i = 0; i < oracle->order.count; i++)
        print_node(&wave, i);
    if (options->directives)
        dag_line_here(out);
    dag_print(out, "    }\n}\n");
}
