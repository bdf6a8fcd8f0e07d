/* flat_node.c - the text of one node of a graph's function: its label, what is known there, the
 * question, and where each answer leads.
 * SPDX-License-Identifier: MIT */
#include "emit/flat.h"
#include "emit/line_directives.h"

/* For compilers and debuggers: what follows stands there in the source. */
void dag_flat_directive(const struct flat *flat, struct where where)
{
    if (flat->directives)
        dag_line_at(flat->dag, flat->out, where);
}

/* Out of a function for a piece of the graph: by which exit; -1: the answer stays in it. */
static int exit_of(const struct flat *flat, const struct node *node, int answer)
{
    const struct shared *s = flat->inside;
    return s == NULL ? -1 : s->exit_of[s->first_answer[flat->member[node->order]] + answer];
}

/* Two exits are two ways, also where the use that the nodes are of sends both to one place. */
static int same_way_on(const struct flat *flat, const struct node *node, int a, int b)
{
    return exit_of(flat, node, a) == exit_of(flat, node, b)
           && dag_same_target(&dag_flat_arc(flat, node, a)->target,
                              &dag_flat_arc(flat, node, b)->target);
}

/* Do all answers lead to one target? Then there is nothing to ask. */
static int decides_nothing(const struct flat *flat, const struct node *node)
{
    for (int i = 1; i < node->arcs.count; i++)
        if (!same_way_on(flat, node, 0, i))
            return 0;
    return 1;
}

int dag_flat_behind(const struct flat *flat, int copy)
{
    const struct copy *c = &flat->copies.items[copy];
    if (c->next >= 0)
        return c->next;
    return c->place + 1 < flat->oracle->order.count ? flat->copies.first[c->place + 1] : -1;
}

/* What stands next needs no goto when nothing is asked before it: the copy behind, or, after the
 * last one, the first of the shared leaves. */
static int falls_through(const struct flat *flat, int copy)
{
    const struct copy *c = &flat->copies.items[copy];
    const struct node *node = dag_flat_at(flat, c->place);
    const struct target *target = &dag_flat_arc(flat, node, 0)->target;
    int behind = dag_flat_behind(flat, copy);
    if (!decides_nothing(flat, node) || flat->shared_count > 0)
        return 0;
    if (target->kind == TARGET_NODE) {
        const struct way *way = &flat->copies.ways[c->ways[0]];
        return way->cut == 0 && way->below == behind
               && dag_flat_part(flat, c->place)
                      == dag_flat_part(flat, flat->copies.items[behind].place);
    }
    return flat->parts == 1 && behind < 0 && target->index == flat->first_leaf;
}

void dag_flat_label_way(struct flat *flat, int number)
{
    const struct way *way = &flat->copies.ways[number];
    if (way->cut == 0)
        flat->node_label[way->below] = 1;
    else {
        dag_flat_label_way(flat, way->below);
        dag_flat_label_way(flat, way->above);
    }
}

void dag_flat_mark_labels(struct flat *flat, int copy)
{
    const struct copy *c = &flat->copies.items[copy];
    const struct node *node = dag_flat_at(flat, c->place);
    int through = falls_through(flat, copy);
    for (int a = 0; a < node->arcs.count && !through; a++) {
        const struct target *target = &dag_flat_arc(flat, node, a)->target;
        if (target->kind == TARGET_NODE)
            dag_flat_label_way(flat, c->ways[a]);
        else if (dag_flat_has_leaf(flat, target))
            flat->leaf_label[target->index] = 1;
    }
}

/* In a part: the number of the node to go on with elsewhere, or ~decision. */
static void print_jump_in_part(const struct flat *flat, int from, const struct target *target)
{
    if (target->kind != TARGET_NODE) {
        dag_print(flat->out, "return ~(int)");
        dag_print_constant(flat->out, "decision", flat->dag->decisions[target->index].name);
        dag_print(flat->out, ";\n");
    } else if (dag_flat_part(flat, from)
               == dag_flat_part(flat, flat->dag->nodes[target->index].order))
        dag_print(flat->out, "goto node_%s;\n", flat->dag->nodes[target->index].name);
    else
        dag_print(flat->out, "return %d;\n", flat->dag->nodes[target->index].order);
}

/* "node_NAME", or of its copies but the first "copyN_NAME". */
void dag_flat_label(const struct flat *flat, int copy)
{
    const struct copy *c = &flat->copies.items[copy];
    if (c->number == 0)
        dag_print(flat->out, "node_%s", dag_flat_at(flat, c->place)->name);
    else
        dag_print(flat->out, "copy%d_%s", c->number + 1, dag_flat_at(flat, c->place)->name);
}

const char *dag_flat_level(const struct dag *dag, const struct term *term, int level)
{
    return term->levels.count == 0 ? "present" : dag->levels[term->levels.first + level - 1].name;
}

/* goto the copy, or by a look to one of more; behind `indent` spaces, which stand already. */
void dag_flat_way(const struct flat *flat, int number, int indent)
{
    const struct way *way = &flat->copies.ways[number];
    if (way->cut == 0) {
        dag_print(flat->out, "goto ");
        dag_flat_label(flat, way->below);
        dag_print(flat->out, ";\n");
        return;
    }
    const struct term *term = &flat->dag->terms[way->term];
    const struct way *above = &flat->copies.ways[way->above];
    if (flat->flavour == FLAVOUR_COUNTED && way->checked)
        dag_print(flat->out, "counters->checks++;\n%*s", indent, "");
    dag_print(flat->out, "if (%sterms.%s_level >= ", flat->of, term->name);
    dag_print_constant(flat->out, term->name, dag_flat_level(flat->dag, term, way->cut));
    dag_print(flat->out, ")%s\n%*s", above->cut > 0 ? " {" : "", indent + 4, "");
    dag_flat_way(flat, way->above, indent + 4);
    if (above->cut > 0)
        dag_print(flat->out, "%*s}\n", indent, "");
    dag_print(flat->out, "%*s", indent, "");
    dag_flat_way(flat, way->below, indent);
}

/* 0: the answer does not leave the function. */
static int print_exit(const struct flat *flat, const struct node *node, int answer)
{
    int exit = exit_of(flat, node, answer);
    if (exit >= 0)
        dag_print(flat->out, "return %d;\n", exit);
    return exit >= 0;
}

void dag_flat_jump(const struct flat *flat, int from, const struct target *target, int way,
                   int indent)
{
    if (flat->parts > 1)
        print_jump_in_part(flat, from, target);
    else if (target->kind == TARGET_NODE)
        dag_flat_way(flat, way, indent);
    else if (dag_flat_has_leaf(flat, target))
        dag_print(flat->out, "goto leaf_%s;\n", flat->dag->decisions[target->index].name);
    else {
        dag_print(flat->out, "return ");
        dag_print_constant(flat->out, "decision", flat->dag->decisions[target->index].name);
        dag_print(flat->out, ";\n");
    }
}

/* A local copy of the discussion does not come back: its owner's is told what is no number. */
static struct place place_of(const struct flat *flat)
{
    return (struct place){flat->at, flat->parts > 1 ? flat->at : "discussion", flat->inside};
}

static void print_call(const struct flat *flat, const struct node *node)
{
    const struct place place = place_of(flat);
    int value = 0;
    dag_print(flat->out, "%s_%s(%s", flat->parts > 1 ? "ask" : "tool",
              flat->dag->tools[node->tool].name, flat->at);
    for (int i = 0; i < node->arguments.count; i++) {
        dag_print(flat->out, ", ");
        dag_emit_expression(flat->dag, flat->out, node,
                            &flat->dag->arguments[node->arguments.first + i], &place, &value);
    }
    dag_print(flat->out, ")");
}

/* The answers that share a target share a jump; the last ones are the default, so that the
 * compiler need not think of an answer that does not exist. */
static void print_switch(const struct flat *flat, const struct node *node, const struct copy *copy)
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
        const struct target *target = &dag_flat_arc(flat, node, i)->target;
        for (int j = i; j < node->arcs.count; j++)
            if (!done[j] && same_way_on(flat, node, i, j)) {
                dag_print(flat->out, "    case ");
                dag_print_constant(flat->out, tool->name, answers[j].name);
                dag_print(flat->out, ":\n");
                done[j] = 2;
                left--;
            }
        if (done[i] == 2) {
            dag_print(flat->out, "%s", left == 0 ? "    default:\n" : "");
            dag_flat_directive(flat, dag_flat_arc(flat, node, i)->where);
            dag_print(flat->out, "        ");
            if (!print_exit(flat, node, i))
                dag_flat_jump(flat, node->order, target, copy->ways[i], 8);
        }
        for (int j = i; j < node->arcs.count; j++)
            done[j] = done[j] != 0;
    }
    dag_print(flat->out, "    }\n");
}

int dag_flat_term(const struct dag *dag, const struct node *node, int need)
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

/* Is it worth telling the compiler that a term is known? With one arc it has seen why. */
int dag_flat_is_fact(const struct flat *flat, const struct copy *copy, int term)
{
    return copy->known.low[term] > 0 && copy->arcs_in > 1 && flat->parts == 1
           && flat->inside == NULL;
}

/* What the analysis knows of the terms that the node handles, for the reader as a comment
 * and, where several arcs meet, for the compiler as a fact. */
static void print_known(const struct flat *flat, const struct copy *copy)
{
    const struct dag *dag = flat->dag;
    const struct node *node = dag_flat_at(flat, copy->place);
    for (int i = 0, term; (term = dag_flat_term(dag, node, i)) >= 0; i++) {
        const struct term *t = &dag->terms[term];
        int low = copy->known.low[term], high = copy->known.high[term];
        int seen = 0;
        for (int j = 0; j < i; j++)
            seen |= dag_flat_term(dag, node, j) == term;
        if (seen)
            continue;
        if (low > 0)
            dag_print(flat->out, "    /* %s: %s%s on every path */\n", t->name,
                      dag_flat_level(dag, t, low), low < t->levels.count ? " or better" : "");
        else
            dag_print(flat->out, "    /* %s: %s */\n", t->name,
                      high == 0 ? "absent on every path" : "checked: not every path has it");
        if (dag_flat_is_fact(flat, copy, term)) {
            dag_print(flat->out, "    KNOWN(%sterms.%s_level >= ", flat->of, t->name);
            dag_print_constant(flat->out, t->name, dag_flat_level(dag, t, low));
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

void dag_flat_node(const struct flat *flat, int at)
{
    const struct copy *copy = &flat->copies.items[at];
    const struct node *node = dag_flat_at(flat, copy->place);
    const struct place place = place_of(flat);
    int block = dag_has_reads(flat->dag, node, &place);
    dag_print(flat->out, "\n");
    dag_flat_directive(flat, node->where);
    if (flat->node_label[at] || (flat->parts > 1 && flat->entry[node->order])) {
        dag_flat_label(flat, at);
        dag_print(flat->out, ":\n");
    }
    if (flat->lines)
        print_place(flat, node);
    print_known(flat, copy);
    if (block) /* C++ may not jump past a constant: it gets a block */
        dag_print(flat->out, "    {\n");
    if (flat->flavour == FLAVOUR_COUNTED) /* what the arguments compute is the node's time, too */
        dag_print(flat->out, "    began = %s_clock(counters);\n", flat->oracle->name);
    if (block) {
        dag_flat_directive(flat, node->tool_where);
        dag_emit_reads(flat->dag, flat->out, node, &place);
    }
    if (flat->flavour == FLAVOUR_COUNTED && copy->checks > 0)
        dag_print(flat->out, "    counters->checks += %d;\n", copy->checks);
    dag_flat_directive(flat, node->tool_where);
    if (flat->flavour != FLAVOUR_PLAIN)
        print_watched(flat, node);
    if (!decides_nothing(flat, node)) {
        print_switch(flat, node, copy);
        dag_print(flat->out, "%s", block ? "    }\n" : "");
        return;
    }
    if (flat->flavour == FLAVOUR_PLAIN) {
        dag_print(flat->out, "    (void)");
        print_call(flat, node);
        dag_print(flat->out, ";\n");
    }
    dag_print(flat->out, "%s", block ? "    }\n" : "");
    if (!falls_through(flat, at)) {
        dag_flat_directive(flat, dag_flat_arc(flat, node, 0)->where);
        dag_print(flat->out, "    ");
        if (!print_exit(flat, node, 0))
            dag_flat_jump(flat, node->order, &dag_flat_arc(flat, node, 0)->target, copy->ways[0],
                          4);
    }
}
