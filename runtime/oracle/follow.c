/* follow.c - see follow.h.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "oracle/follow.h"
#include "oracle/program.h"

static const struct node *node_at(const struct program *p, int step)
{
    return &p->dag->nodes[p->dag->order[p->graph->order.first + step]];
}

/* Ways from each step: of the last step first, since arcs lead forward. Returns 0, or -1: they are
 * too many. */
static int number_ways(const struct program *p, uint64_t *from)
{
    for (int i = p->graph->order.count; i-- > 0;) {
        const int *next = p->steps[i].next;
        uint64_t *ways = &p->ways[next - p->next];
        from[i] = 0;
        for (int k = 0; k < node_at(p, i)->arcs.count; k++) {
            const uint64_t below = next[k] < 0 ? 1 : from[next[k]];
            ways[k] = from[i];
            if (from[i] > UINT64_MAX - below)
                return -1;
            from[i] += below;
        }
    }
    return 0;
}

int follow_open(struct refiner *r, struct messages *messages)
{
    if (strcmp(r->release, "dag") != 0)
        return messages_say(messages, MESSAGE_ARGUMENT,
                            "only interpreted graphs can be watched; make oracle %s with "
                            "RAD_RELEASE_DAG",
                            r->oracle);
    struct program *p = r->own;
    if (p->ways)
        return 0;
    uint64_t *from = malloc((size_t)p->graph->order.count * sizeof *from);
    p->ways = malloc(((size_t)p->answer_count + 1) * sizeof *p->ways);
    int status = from && p->ways ? number_ways(p, from) : -1;
    if (!from || !p->ways)
        (void)messages_say(messages, MESSAGE_MEMORY, "out of memory");
    else if (status < 0)
        (void)messages_say(messages, MESSAGE_ARGUMENT,
                           "oracle %s has more than 2^64 ways from its start to a decision: too "
                           "many to be told apart",
                           r->oracle);
    free(from);
    if (status < 0) {
        free(p->ways);
        p->ways = NULL;
    }
    return status;
}

enum decision follow_ask(const struct refiner *r, struct discussion *d, uint64_t *way)
{
    const struct program *p = r->own;
    const struct step *step = p->steps;
    uint64_t sum = 0;
    for (;;) {
        const int *arc = &step->next[step->call(d, step->arguments)], next = *arc;
        sum += p->ways[arc - p->next];
        if (next < 0) {
            *way = sum;
            return (enum decision) ~next;
        }
        step = &p->steps[next];
    }
}

int follow_answer(struct RadAnswer *out, const struct refiner *r, int node, int answer)
{
    static const char *const kinds[] = {"precise", "approximate", "other"};
    const struct program *p = r->own;
    const struct dag *dag = p->dag;
    if (node < 0 || node >= p->graph->order.count || answer < 0
        || answer >= node_at(p, node)->arcs.count)
        return -1;
    const struct node *n = node_at(p, node);
    const struct tool *tool = &dag->tools[n->tool];
    const struct answer *a = &dag->answers[tool->answers.first + answer];
    *out = (struct RadAnswer){.node_number = node,
                              .answer_number = answer,
                              .node = n->name,
                              .tool = tool->name,
                              .doc = tool->doc,
                              .answer = a->name,
                              .kind = tool->kind == TOOL_COMMAND ? "command" : kinds[a->kind],
                              .target = dag->arcs[n->arcs.first + answer].target.name};
    return 0;
}

int follow_way(struct RadAnswer *out, int most, const struct refiner *r, uint64_t way)
{
    const struct program *p = r->own;
    for (int step = 0, count = 0;;) {
        const int *next = p->steps[step].next;
        const uint64_t *ways = &p->ways[next - p->next];
        int answer = node_at(p, step)->arcs.count - 1;
        while (answer > 0 && ways[answer] > way)
            answer--;
        if (count < most)
            (void)follow_answer(&out[count], r, step, answer);
        count++;
        way -= ways[answer];
        if (next[answer] < 0)
            return way == 0 ? count : -1;
        step = next[answer];
    }
}
