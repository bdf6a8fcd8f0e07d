/* node_counting.c - see node_counting.h: the interpreter's walk with three sums to each node.
 *
 * Arcs are numbered as program.next has them, node by node in topological order: so does text that
 * dagc --instrument makes of the same graph.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "oracle/node_counting.h"
#include "oracle/program.h"

struct node_counting {
    const struct program *program;
    double (*clock)(void *context);
    void *context;
    const char **node_names, **arc_names;
    int *arc_nodes;
    unsigned long long *calls, *answers;
    double *time;
};

void node_counting_close(struct node_counting *c)
{
    if (!c)
        return;
    free(c->node_names);
    free(c->arc_names);
    free(c->arc_nodes);
    free(c->calls);
    free(c->answers);
    free(c->time);
    free(c);
}

static void name_nodes(struct node_counting *c)
{
    const struct program *p = c->program;
    for (int i = 0, arc = 0; i < p->graph->order.count; i++) {
        const struct node *n = dag_node_at(p->dag, p->graph, i);
        const struct tool *tool = &p->dag->tools[n->tool];
        c->node_names[i] = n->name;
        for (int k = 0; k < n->arcs.count; k++, arc++) {
            c->arc_names[arc] = p->dag->answers[tool->answers.first + k].name;
            c->arc_nodes[arc] = i;
        }
    }
}

struct node_counting *node_counting_open(const struct refiner *r, double (*clock)(void *context),
                                         void *context, struct messages *messages)
{
    if (strcmp(r->release, "dag") != 0) {
        (void)messages_say(messages, MESSAGE_ARGUMENT,
                           "oracle %s is not interpreted: dagc --instrument makes text that counts",
                           r->oracle);
        return NULL;
    }
    const struct program *p = r->own;
    const size_t nodes = (size_t)p->graph->order.count, arcs = (size_t)p->answer_count;
    struct node_counting *c = calloc(1, sizeof *c);
    if (c) {
        c->program = p;
        c->clock = clock;
        c->context = context;
        c->node_names = calloc(nodes, sizeof *c->node_names);
        c->arc_names = calloc(arcs + 1, sizeof *c->arc_names);
        c->arc_nodes = calloc(arcs + 1, sizeof *c->arc_nodes);
        c->calls = calloc(nodes, sizeof *c->calls);
        c->answers = calloc(arcs + 1, sizeof *c->answers);
        c->time = calloc(nodes, sizeof *c->time);
    }
    if (!c || !c->node_names || !c->arc_names || !c->arc_nodes || !c->calls || !c->answers
        || !c->time) {
        (void)messages_say(messages, MESSAGE_MEMORY, "out of memory");
        node_counting_close(c);
        return NULL;
    }
    name_nodes(c);
    return c;
}

enum decision node_counting_ask(struct node_counting *c, struct discussion *d)
{
    const struct program *p = c->program;
    for (int at = 0;;) {
        const struct step *step = &p->steps[at];
        const double began = c->clock ? c->clock(c->context) : 0;
        const int arc = (int)(step->next - p->next) + step->call(d, step->arguments);
        c->time[at] += c->clock ? c->clock(c->context) - began : 0;
        c->calls[at]++;
        c->answers[arc]++;
        if (p->next[arc] < 0)
            return (enum decision) ~p->next[arc];
        at = p->next[arc];
    }
}

struct node_counts node_counting_counts(const struct node_counting *c)
{
    return node_counts_of(c->program->graph->order.count, c->node_names, c->program->answer_count,
                          c->arc_names, c->arc_nodes, c->calls, c->answers, c->time);
}
