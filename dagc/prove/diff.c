/* diff.c - the oracles of two files, pair by pair: their parameters, their facts, and what they
 * decide (side_by_side.c).
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "prove/diff.h"
#include "prove/same_catalog.h"
#include "prove/side_by_side.h"

struct request {
    struct compared side[SIDES];
    struct arena arena; /* of one walk */
    FILE *out;
    int result;
};

/* Parameters that one of them lacks, or whose defaults differ. */
static int compare_parameters(const struct request *request)
{
    int different = 0;
    for (int s = 0; s < SIDES; s++) {
        const struct compared *side = &request->side[s], *other = &request->side[1 - s];
        for (int i = 0; i < side->oracle->parameters.count; i++) {
            const struct parameter *a = &side->dag->parameters[side->oracle->parameters.first + i],
                                   *b = NULL;
            for (int k = 0; k < other->oracle->parameters.count && b == NULL; k++) {
                const struct parameter *q =
                    &other->dag->parameters[other->oracle->parameters.first + k];
                b = strcmp(a->name, q->name) == 0 ? q : NULL;
            }
            if (b == NULL)
                fprintf(request->out, "%c parameter %s\n", s == 0 ? '-' : '+', a->name);
            else if (s == 0 && !dag_same_number(a->value, b->value)) {
                char x[32];
                fprintf(request->out, "- parameter %s = %s\n", a->name, dag_number(a->value, x));
                char y[32];
                fprintf(request->out, "+ parameter %s = %s\n", a->name, dag_number(b->value, y));
                different = 1;
            }
        }
    }
    return different;
}

/* Facts that both call by one name but that are not the same; the questions look alike. */
static void compare_facts(const struct request *request)
{
    const struct compared *a = &request->side[0], *b = &request->side[1];
    for (int i = 0; i < a->dag->fact_count; i++) {
        const struct fact *fact = &a->dag->facts[i];
        int other = dag_find(&b->dag->fact_names, fact->name);
        if (other < 0 || strcmp(fact->c, b->dag->facts[other].c) == 0
            || !dag_reads_fact(a->dag, a->oracle, i) || !dag_reads_fact(b->dag, b->oracle, other))
            continue;
        fprintf(request->out, "- fact %s = \"%s\"\n", fact->name, fact->c);
        fprintf(request->out, "+ fact %s = \"%s\"\n", fact->name, b->dag->facts[other].c);
    }
}

int dag_diff_graphs(struct dag *dag, const struct oracle_graph *a, const struct oracle_graph *b)
{
    const struct compared side[SIDES] = {{dag, a, NULL}, {dag, b, NULL}};
    const struct differences found = dag_walk_both(side, &dag->arena, NULL);
    return found.ways > 0 ? 1 : found.cut ? 2 : 0;
}

/* (Protected twice: the arenas of both dags grow.) */
static void compare(struct dag *other, void *context)
{
    struct request *request = context;
    struct dag *dag = request->side[0].dag;
    (void)other;
    request->arena.protector = dag->arena.protector;
    fprintf(request->out, "oracle %s\n", request->side[0].oracle->name);
    request->result |= compare_parameters(request);
    compare_facts(request);
    const struct differences found = dag_walk_both(request->side, &request->arena, request->out);
    if (found.ways > WAYS_SHOWN)
        fprintf(request->out, "\n%d ways to decide differ%s; the first %d are shown\n", found.ways,
                found.ways == WAYS_MAX ? " at least" : "", WAYS_SHOWN);
    else
        fprintf(request->out, "%s%d ways to decide differ\n", found.ways > 0 ? "\n" : "",
                found.ways);
    if (found.cut)
        fprintf(request->out, "stopped after %d states: there may be more\n", found.states);
    request->result |= (found.ways > 0 ? 1 : 0) | (found.cut ? 2 : 0);
}

static void compare_protected(struct dag *dag, void *context)
{
    struct request *request = context;
    (void)dag;
    if (dag_protect(request->side[1].dag, compare, request) != 0) {
        fprintf(stderr, "dagc: error: out of memory\n");
        request->result = 2;
    }
}

/* ---- the files */

/* Oracles of one name are compared; two files of one oracle each whatever the names. */
static int pair_up(struct request *request, int index)
{
    struct dag *a = request->side[0].dag, *b = request->side[1].dag;
    int other =
        a->oracle_count == 1 && b->oracle_count == 1 ? 0 : dag_oracle(b, a->oracles[index].name);
    if (other < 0) {
        fprintf(request->out, "- oracle %s\n", a->oracles[index].name);
        request->result |= 1;
        return 0;
    }
    request->side[0].oracle = &a->oracles[index];
    request->side[1].oracle = &b->oracles[other];
    return 1;
}

int dag_diff(const char *a, const char *b, const struct dag_options *options, FILE *out)
{
    struct request request = {0};
    request.out = out;
    request.side[0].path = a;
    request.side[1].path = b;
    struct dag_options loaded = *options;
    loaded.switches = "no-all"; /* a graph with weaknesses can be compared, too */
    request.side[0].dag = dag_load_with(a, &loaded, stderr);
    request.side[1].dag = dag_load_with(b, &loaded, stderr);
    if (request.side[0].dag == NULL || request.side[1].dag == NULL)
        request.result = 2;
    else if (!dag_same_catalog(request.side[0].dag, request.side[1].dag))
        request.result = 2;
    for (int i = 0; request.result < 2 && i < request.side[0].dag->oracle_count; i++) {
        if (pair_up(&request, i)
            && dag_protect(request.side[0].dag, compare_protected, &request) != 0) {
            fprintf(stderr, "dagc: error: out of memory\n");
            request.result = 2;
        }
        dag_arena_free(&request.arena);
    }
    for (int i = 0; request.result < 2 && i < request.side[1].dag->oracle_count; i++)
        if (!(request.side[0].dag->oracle_count == 1 && request.side[1].dag->oracle_count == 1)
            && dag_oracle(request.side[0].dag, request.side[1].dag->oracles[i].name) < 0) {
            fprintf(out, "+ oracle %s\n", request.side[1].dag->oracles[i].name);
            request.result |= 1;
        }
    dag_free(request.side[0].dag);
    dag_free(request.side[1].dag);
    return request.result >= 2 ? 2 : request.result;
}
