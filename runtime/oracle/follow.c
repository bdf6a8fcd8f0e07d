/* follow.c - see follow.h.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "oracle/follow.h"
#include "oracle/program.h"

/* Ways from each step, of the last step first, since arcs lead forward; and what each arc is worth.
 * Returns 0, or 1: they are too many. */
static int number_ways(const struct program *p, uint64_t *from, uint64_t *worth)
{
    for (int i = p->graph->order.count; i-- > 0;) {
        const int *next = p->steps[i].next;
        uint64_t *ways = &worth[next - p->next];
        from[i] = 0;
        for (int k = 0; k < dag_node_at(p->dag, p->graph, i)->arcs.count; k++) {
            const uint64_t below = next[k] < 0 ? 1 : from[next[k]];
            ways[k] = from[i];
            if (from[i] > UINT64_MAX - below)
                return 1;
            from[i] += below;
        }
    }
    return 0;
}

int follow_number(struct program *p)
{
    if (p->ways)
        return 0;
    uint64_t *from = malloc((size_t)p->graph->order.count * sizeof *from);
    uint64_t *worth = malloc(((size_t)p->answer_count + 1) * sizeof *worth);
    const int status = from && worth ? number_ways(p, from, worth) : -1;
    free(from);
    if (status == 0)
        p->ways = worth;
    else
        free(worth);
    return status;
}

int follow_open(struct refiner *r, struct messages *messages)
{
    if (strcmp(r->release, "dag") != 0)
        return messages_say(messages, MESSAGE_ARGUMENT,
                            "only interpreted graphs can be watched; make oracle %s with "
                            "RAD_RELEASE_DAG",
                            r->oracle);
    const int status = follow_number(r->own);
    if (status < 0)
        return messages_say(messages, MESSAGE_MEMORY, "out of memory");
    if (status > 0)
        return messages_say(messages, MESSAGE_ARGUMENT,
                            "oracle %s has more than 2^64 ways from its start to a decision: too "
                            "many to be told apart",
                            r->oracle);
    return 0;
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

struct RadAnswer follow_said(const struct program *p, int step, int answer)
{
    const struct dag *dag = p->dag;
    const struct node *n = dag_node_at(dag, p->graph, step);
    const struct tool *tool = &dag->tools[n->tool];
    const struct answer *a = &dag->answers[tool->answers.first + answer];
    return (struct RadAnswer){.node_number = step,
                              .answer_number = answer,
                              .node = n->name,
                              .tool = tool->name,
                              .doc = tool->doc,
                              .answer = a->name,
                              .kind =
                                  tool->kind == TOOL_COMMAND ? "command" : dag_kind_name(a->kind),
                              .target = dag->arcs[n->arcs.first + answer].target.name};
}

int follow_answer(struct RadAnswer *out, const struct refiner *r, int node, int answer)
{
    const struct program *p = r->own;
    if (node < 0 || node >= p->graph->order.count || answer < 0
        || answer >= dag_node_at(p->dag, p->graph, node)->arcs.count)
        return -1;
    *out = follow_said(p, node, answer);
    return 0;
}

int follow_step(const struct program *p, int step, uint64_t *way)
{
    const uint64_t *ways = &p->ways[p->steps[step].next - p->next];
    int answer = dag_node_at(p->dag, p->graph, step)->arcs.count - 1;
    while (ways[answer] > *way) /* the first is worth 0 */
        answer--;
    *way -= ways[answer];
    return answer;
}

int follow_way(struct RadAnswer *out, int most, const struct refiner *r, uint64_t way)
{
    const struct program *p = r->own;
    int count = 0;
    for (int step = 0; step >= 0; count++) {
        const int answer = follow_step(p, step, &way);
        if (count < most)
            out[count] = follow_said(p, step, answer);
        step = p->steps[step].next[answer];
    }
    return way == 0 ? count : -1;
}
