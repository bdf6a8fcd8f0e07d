/* emit_outline.c - graphs that are used more than once, as functions (--outline).
 *
 * Expanding branches makes the text of a graph as long as its paths need it; where copies are alike
 * (shared.c) one function can stand for all of them. It is called in the place of each, is given
 * the arguments that differ and returns the number of the exit that it was left by. Whether the
 * text gets shorter that way is found by printing it both ways. The price is time: the discussion
 * then lives in memory, where registers held it.
 * [outlining, or procedural abstraction: Fraser, Myers and Wendt, Analyzing and compressing
 * assembly code, 1984]
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "emit/flat.h"

/* Is the node in a function of its own, and not in this one? */
static int is_elsewhere(const struct flat *flat, int place)
{
    return flat->shared_count > 0 && flat->piece[place] > 0
           && flat->inside != &flat->shared[flat->piece[place] - 1];
}

static void print_shared_name(const struct flat *flat, const struct shared *s)
{
    dag_print(flat->out, "%s_branch_%s", flat->oracle->name, flat->dag->branches[s->branch].name);
}

/* Is the argument that uses differ in looked at in the function? */
static int is_doubtful(const struct shared *s, int different)
{
    return dag_shared_doubt(s, s->argument[different * s->uses]) >= 0;
}

static void print_function(struct flat *flat, const struct shared *s)
{
    const struct dag *dag = flat->dag;
    const char *at = flat->at, *of = flat->of;
    unsigned char *labels = flat->node_label;
    flat->inside = s;
    flat->at = "d";
    flat->of = "d->";
    flat->node_label = dag_alloc(&flat->dag->arena, (size_t)flat->copies.count);
    for (int i = 0; i < s->nodes; i++)
        for (int a = 0; a < dag->nodes[s->node[i]].arcs.count; a++)
            if (s->exit_of[s->first_answer[i] + a] < 0) {
                const struct target *to = &dag->arcs[dag->nodes[s->node[i]].arcs.first + a].target;
                flat->node_label[flat->copies.first[dag->nodes[to->index].order]] = 1;
            }
    dag_print(flat->out, "\n/* The graph %s, used %d times. Returns by which exit it is left. */\n",
              dag->branches[s->branch].name, s->uses);
    dag_print(flat->out, "static int ");
    print_shared_name(flat, s);
    dag_print(flat->out, "(const struct %s_parameters *parameters,\n    struct discussion *d",
              flat->oracle->name);
    for (int i = 0; i < s->different; i++) {
        const struct argument *argument = &dag->arguments[s->argument[i * s->uses]];
        int type = dag->parameters[argument->parameter].type, whole = !is_doubtful(s, i);
        dag_print(flat->out, ", %s argument_%d", whole ? dag_c_type(dag, type) : "double", i + 1);
    }
    if (s->doubts > 0)
        dag_print(flat->out, ",\n    struct discussion *discussion");
    for (int i = 0; i < s->doubts; i++)
        dag_print(flat->out, ", const char *what_%d", i + 1);
    dag_print(flat->out, ")\n{\n    (void)parameters;\n");
    for (int i = 0; i < s->nodes; i++)
        dag_flat_node(flat, flat->copies.first[dag->nodes[s->node[i]].order]);
    dag_flat_directive(flat, dag_nowhere);
    dag_print(flat->out, "}\n");
    flat->inside = NULL;
    flat->at = at;
    flat->of = of;
    flat->node_label = labels;
}

static int way_of(const struct flat *flat, const struct shared *s, int use, int exit)
{
    int arc = s->exit[use * s->exits + exit];
    for (int i = 0; i < s->nodes; i++) {
        const struct node *node = &flat->dag->nodes[s->node[use * s->nodes + i]];
        if (arc >= node->arcs.first && arc < node->arcs.first + node->arcs.count)
            return flat->copies.items[flat->copies.first[node->order]].ways[arc - node->arcs.first];
    }
    return -1;
}

/* In place of a use's first node. */
static void print_use(const struct flat *flat, int copy)
{
    int place = flat->copies.items[copy].place, use = flat->use[place] - 1;
    struct dag *dag = flat->dag;
    const struct shared *s = &flat->shared[flat->piece[place] - 1];
    dag_print(flat->out, "\n");
    if (flat->node_label[copy]) {
        dag_flat_label(flat, copy);
        dag_print(flat->out, ":\n");
    }
    dag_flat_directive(flat, dag->uses[dag_node_at(flat->dag, flat->oracle, place)->use].where);
    dag_print(flat->out, s->exits > 1 ? "    switch (" : "    (void)");
    print_shared_name(flat, s);
    dag_print(flat->out, "(parameters, %s", flat->at);
    for (int i = 0; i < s->different; i++) {
        dag_print(flat->out, ", ");
        dag_emit_shared_argument(dag, flat->out, &dag->arguments[s->argument[i * s->uses + use]],
                                 flat->at, is_doubtful(s, i));
    }
    dag_print(flat->out, s->doubts > 0 ? ", discussion" : "");
    for (int i = 0; i < s->doubts; i++) {
        const struct node *node = &dag->nodes[s->doubt_node[i * s->uses + use]];
        dag_print(flat->out, ",\n        ");
        dag_print_string(flat->out,
                         dag_doubt(dag, node, &dag->arguments[s->doubt[i * s->uses + use]]).what);
    }
    dag_print(flat->out, s->exits > 1 ? ")) {\n" : ");\n    ");
    for (int e = 0; e < s->exits; e++) {
        const struct arc *arc = &dag->arcs[s->exit[use * s->exits + e]];
        if (s->exits > 1) {
            dag_print(flat->out, "    case %d:\n%s", e, e == s->exits - 1 ? "    default:\n" : "");
            dag_print(flat->out, "        ");
        }
        dag_flat_jump(flat, place, &arc->target,
                      arc->target.kind == TARGET_NODE ? way_of(flat, s, use, e) : -1, 8);
    }
    dag_print(flat->out, s->exits > 1 ? "    }\n" : "");
}

void dag_flat_node_or_call(const struct flat *flat, int copy)
{
    int place = flat->copies.items[copy].place;
    if (!is_elsewhere(flat, place))
        dag_flat_node(flat, copy);
    else if (flat->member[place] == 0)
        print_use(flat, copy);
}

/* The labels anew: of what is in this function, and of what leaves the others. */
static void label_again(struct flat *flat)
{
    memset(flat->node_label, 0, (size_t)flat->copies.count);
    memset(flat->leaf_label, 0, (size_t)flat->dag->decision_count);
    for (int i = 0; i < flat->copies.count; i++)
        if (!is_elsewhere(flat, flat->copies.items[i].place))
            dag_flat_mark_labels(flat, i);
    for (int p = 0; p < flat->shared_count; p++) {
        const struct shared *s = &flat->shared[p];
        for (int i = 0; i < s->uses * s->exits; i++) {
            const struct target *target = &flat->dag->arcs[s->exit[i]].target;
            if (target->kind == TARGET_NODE)
                flat->node_label[flat->copies.first[flat->dag->nodes[target->index].order]] = 1;
            else if (dag_flat_has_leaf(flat, target))
                flat->leaf_label[target->index] = 1;
        }
    }
}

/* By order, what is in the piece; `number` 0: in none. */
static void mark_piece(struct flat *flat, const struct shared *s, int number)
{
    for (int i = 0; i < s->uses * s->nodes; i++) {
        int place = flat->dag->nodes[s->node[i]].order;
        flat->piece[place] = number;
        flat->use[place] = i / s->nodes + 1;
        flat->member[place] = i % s->nodes;
    }
}

/* How long the text of the whole is, as the pieces are now. */
static size_t text_length(struct flat *flat)
{
    struct text *out = flat->out, measured = {0};
    flat->out = &measured;
    for (int p = 0; p < flat->shared_count; p++)
        print_function(flat, &flat->shared[p]);
    label_again(flat);
    for (int i = flat->copies.first[0]; i >= 0; i = dag_flat_behind(flat, i))
        dag_flat_node_or_call(flat, i);
    flat->out = out;
    size_t length = measured.length;
    dag_text_free(&measured);
    return length;
}

/* A proof must know from where a function was called. */
static void print_watched_name(const struct flat *flat, const struct shared *s)
{
    dag_print(flat->out, "\n#define ");
    print_shared_name(flat, s);
    dag_print(flat->out, "(...) WATCHED(");
    print_shared_name(flat, s);
    dag_print(flat->out, "(__VA_ARGS__))\n");
}

/* Those pieces become functions with which the text is shorter. */
void dag_flat_outline(struct flat *flat)
{
    size_t places = (size_t)flat->oracle->order.count;
    struct shared *all;
    int count = dag_find_shared(flat->dag, flat->oracle, &all);
    flat->shared = dag_alloc(&flat->dag->arena, (size_t)(count + 1) * sizeof *all);
    flat->piece = dag_alloc(&flat->dag->arena, places * sizeof(int));
    flat->use = dag_alloc(&flat->dag->arena, places * sizeof(int));
    flat->member = dag_alloc(&flat->dag->arena, places * sizeof(int));
    size_t shortest = text_length(flat);
    for (int i = 0; i < count; i++) {
        flat->shared[flat->shared_count++] = all[i];
        mark_piece(flat, &all[i], flat->shared_count);
        size_t length = text_length(flat);
        if (length < shortest)
            shortest = length;
        else {
            flat->shared_count--;
            mark_piece(flat, &all[i], 0);
        }
    }
    for (int p = 0; p < flat->shared_count; p++)
        print_function(flat, &flat->shared[p]);
    for (int p = 0; p < flat->shared_count && flat->watched; p++)
        print_watched_name(flat, &flat->shared[p]);
    label_again(flat);
}
