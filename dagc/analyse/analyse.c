/* analyse.c - the analyses in their order, and the search for a path that proves what they say.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "analyse/analyse.h"

void dag_analyse(struct dag *dag)
{
    if (dag->error_count > 0) /* arcs or nodes may be missing */
        return;
    dag_analyse_use(dag);
    dag_analyse_answers(dag);
    dag_analyse_numbers(dag);
    dag_analyse_guards(dag);
    dag_analyse_terms(dag);
    dag_analyse_repeats(dag);
    dag->use = -1;
}

/* ---- the search */

struct search dag_search_new(struct dag *dag)
{
    struct search search = {0};
    size_t states = 2 * (size_t)dag->order_count;
    search.dag = dag;
    search.from = dag_alloc(&dag->arena, states * sizeof(int));
    search.answer = dag_alloc(&dag->arena, states * sizeof(int));
    search.queue = dag_alloc(&dag->arena, states * sizeof(int));
    return search;
}

void dag_search(struct search *search, const struct oracle_graph *oracle, int phases,
                int (*step)(const struct search *, const struct node *, int, int),
                const void *context)
{
    const struct dag *dag = search->dag;
    int head = 0, tail = 0;
    search->oracle = oracle;
    search->phases = phases;
    search->step = step;
    search->context = context;
    for (int i = 0; i < oracle->order.count * phases; i++)
        search->from[i] = -2;
    search->from[0] = -1; /* the start is the first in the order */
    search->queue[tail++] = 0;
    while (head < tail) {
        int state = search->queue[head++], phase = state % phases;
        const struct node *node = dag_node_at(dag, oracle, state / phases);
        for (int a = 0; a < node->arcs.count; a++) {
            const struct target *target = &dag->arcs[node->arcs.first + a].target;
            if (target->kind != TARGET_NODE)
                continue;
            int next = step(search, node, a, phase);
            if (next < 0)
                continue;
            next += dag->nodes[target->index].order * phases;
            if (search->from[next] != -2)
                continue;
            search->from[next] = state;
            search->answer[next] = a;
            search->queue[tail++] = next;
        }
    }
}

int dag_search_reached(const struct search *search, const struct node *node, int phase)
{
    return search->from[node->order * search->phases + phase] != -2;
}

enum { PATH_SHOWN = 12 };

const char *dag_search_path(const struct search *search, const struct node *node, int phase,
                            int answer, const char *end)
{
    struct dag *dag = search->dag;
    const char *path = "start";
    int last = node->order * search->phases + phase, length = 0;
    /* The queue is free once the search is over: it takes the path, backwards. */
    for (int state = last; state >= 0; state = search->from[state])
        search->queue[length++] = state;
    for (int i = length - 1; i >= 0; i--) {
        int state = search->queue[i];
        const struct node *at = dag_node_at(dag, search->oracle, state / search->phases);
        if (length > PATH_SHOWN && i == length - PATH_SHOWN / 2 - 1) {
            int left = length - PATH_SHOWN;
            path = dag_format(&dag->arena, "%s -> ... (%d more) ...", path, left);
            i -= left - 1;
            continue;
        }
        int a = i > 0 ? search->answer[search->queue[i - 1]] : answer;
        path = a >= 0 ? dag_format(&dag->arena, "%s -> %s(%s)", path, at->name,
                                   dag_answer_name(dag, at, a))
                      : dag_format(&dag->arena, "%s -> %s", path, at->name);
    }
    return end == NULL ? path : dag_format(&dag->arena, "%s -> %s", path, end);
}

const struct node *dag_search_turn(const struct search *search, const struct node *node)
{
    int state = node->order * search->phases + 1;
    while (state >= 0 && state % search->phases == 1) {
        int before = search->from[state];
        if (before >= 0 && before % search->phases == 0)
            return dag_node_at(search->dag, search->oracle, before / search->phases);
        state = before;
    }
    return NULL;
}

/* ---- words and small facts */

const struct node *dag_node_at(const struct dag *dag, const struct oracle_graph *oracle, int place)
{
    return &dag->nodes[dag->order[oracle->order.first + place]];
}

void dag_held_uses(const struct dag *dag, const struct oracle_graph *oracle, unsigned char *held)
{
    memset(held, 0, (size_t)dag->use_count);
    for (int i = 0; i < oracle->order.count; i++)
        for (int u = dag_node_at(dag, oracle, i)->use; u >= 0 && !held[u]; u = dag->uses[u].outer)
            held[u] = 1;
}

const char *dag_name_in_use(const struct dag *dag, const char *name, int use)
{
    size_t length = use < 0 ? 0 : strlen(dag->uses[use].node);
    return length > 0 && strncmp(name, dag->uses[use].node, length) == 0
                   && strncmp(name + length, "__", 2) == 0
               ? name + length + 2
               : name;
}

const char *dag_kind_name(enum kind kind)
{
    static const char *const names[] = {"precise", "approximate", "other"};
    return names[kind];
}

const char *dag_answer_name(const struct dag *dag, const struct node *node, int answer)
{
    return dag->answers[dag->tools[node->tool].answers.first + answer].name;
}

const char *dag_target_name(const struct dag *dag, const struct target *target)
{
    return target->kind == TARGET_NODE ? dag->nodes[target->index].name
                                       : dag->decisions[target->index].name;
}

int dag_same_target(const struct target *a, const struct target *b)
{
    return a->kind == b->kind && a->index == b->index;
}

int dag_reads_term(const struct dag *dag, struct span needs, int term)
{
    for (int i = needs.first; i < needs.first + needs.count; i++)
        if (dag->needs[i].term == term)
            return 1;
    return 0;
}

static const char *value_text(struct dag *dag, int expression, const char *before_extern);

/* An operand of + - * / and of the minus sign. */
static const char *operand_text(struct dag *dag, int expression, const char *before_extern)
{
    enum expression_kind kind = dag->expressions[expression].kind;
    const char *text = value_text(dag, expression, before_extern);
    int infix = kind == EXPRESSION_NEGATE || (kind >= EXPRESSION_ADD && kind <= EXPRESSION_DIVIDE);
    return infix ? dag_format(&dag->arena, "(%s)", text) : text;
}

static const char *operation_text(struct dag *dag, const struct expression *e,
                                  const char *before_extern)
{
    static const char *const signs[] = {"+", "-", "*", "/"}; /* from EXPRESSION_ADD on */
    if (e->kind == EXPRESSION_NEGATE)
        return dag_format(&dag->arena, "-%s", operand_text(dag, e->left, before_extern));
    if (e->kind == EXPRESSION_SQRT || e->kind == EXPRESSION_ABS)
        return dag_format(&dag->arena, "%s(%s)", e->kind == EXPRESSION_SQRT ? "sqrt" : "abs",
                          value_text(dag, e->left, before_extern));
    if (e->kind == EXPRESSION_MIN || e->kind == EXPRESSION_MAX)
        return dag_format(&dag->arena, "%s(%s, %s)", e->kind == EXPRESSION_MIN ? "min" : "max",
                          value_text(dag, e->left, before_extern),
                          value_text(dag, e->right, before_extern));
    const char *left = operand_text(dag, e->left, before_extern);
    return dag_format(&dag->arena, "%s %s %s", left, signs[e->kind - EXPRESSION_ADD],
                      operand_text(dag, e->right, before_extern));
}

static const char *value_text(struct dag *dag, int expression, const char *before_extern)
{
    const struct expression *e = &dag->expressions[expression];
    char digits[32];
    switch (e->kind) {
    case EXPRESSION_NUMBER:
        return dag_format(&dag->arena, "%s", dag_number(e->number, digits));
    case EXPRESSION_PARAMETER:
        return dag->parameters[e->parameter].name;
    case EXPRESSION_NAME:
        return e->name;
    case EXPRESSION_FACT:
        return dag->facts[e->index].name;
    case EXPRESSION_TERM: {
        const struct term *term = &dag->terms[e->index];
        return term->levels.count == 0
                   ? term->name
                   : dag_format(&dag->arena, "%s.%s", term->name,
                                dag->levels[term->levels.first + e->level - 1].name);
    }
    case EXPRESSION_EXTERN:
        return dag_format(&dag->arena, "%s%s", before_extern, e->name);
    case EXPRESSION_NEGATE:
    case EXPRESSION_SQRT:
    case EXPRESSION_ABS:
    case EXPRESSION_ADD:
    case EXPRESSION_SUBTRACT:
    case EXPRESSION_MULTIPLY:
    case EXPRESSION_DIVIDE:
    case EXPRESSION_MIN:
    case EXPRESSION_MAX:
        break;
    }
    return operation_text(dag, e, before_extern);
}

const char *dag_value_text(struct dag *dag, int expression)
{
    return value_text(dag, expression, "extern ");
}

static const char *call_text(struct dag *dag, const struct node *node, const char *before_extern)
{
    const char *text = "";
    for (int i = 0; i < node->arguments.count; i++) {
        const struct argument *argument = &dag->arguments[node->arguments.first + i];
        text = dag_format(&dag->arena, "%s%s%s = %s", text, i > 0 ? ", " : "",
                          dag->parameters[argument->parameter].name,
                          value_text(dag, argument->expression, before_extern));
    }
    return dag_format(&dag->arena, "%s(%s)", dag->tools[node->tool].name, text);
}

const char *dag_call_text(struct dag *dag, const struct node *node)
{
    return call_text(dag, node, "extern ");
}

const char *dag_call_source(struct dag *dag, const struct node *node)
{
    return call_text(dag, node, "");
}

const char *dag_need_text(struct dag *dag, const struct need *need)
{
    const char *term = dag->terms[need->term].name;
    return need->level_name == NULL ? term
                                    : dag_format(&dag->arena, "%s >= %s", term, need->level_name);
}

const char *dag_join(struct dag *dag, const char *list, const char *name)
{
    return *list == '\0' ? name : dag_format(&dag->arena, "%s, %s", list, name);
}
