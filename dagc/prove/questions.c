/* questions.c - see questions.h.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "analyse/analyse.h"
#include "prove/questions.h"

static const struct node *asked_at(const struct asking *side, int place)
{
    return dag_node_at(side->dag, side->oracle, place);
}

/* -0 is less than 0. */
int dag_same_number(double x, double y)
{
    return x == y && !signbit(x) == !signbit(y);
}

static int same_value(const struct dag *a, int i, const struct dag *b, int j)
{
    const struct expression *x = &a->expressions[i], *y = &b->expressions[j];
    if (x->kind != y->kind)
        return 0;
    switch (x->kind) {
    case EXPRESSION_NUMBER:
        return dag_same_number(x->number, y->number);
    case EXPRESSION_PARAMETER:
        return strcmp(a->parameters[x->parameter].name, b->parameters[y->parameter].name) == 0;
    case EXPRESSION_FACT:
        return strcmp(a->facts[x->index].name, b->facts[y->index].name) == 0
               && strcmp(a->facts[x->index].c, b->facts[y->index].c) == 0;
    case EXPRESSION_TERM:
        return x->index == y->index && x->level == y->level;
    case EXPRESSION_EXTERN:
        return strcmp(a->callbacks[x->index].name, b->callbacks[y->index].name) == 0;
    default:
        return same_value(a, x->left, b, y->left)
               && (x->right < 0 || same_value(a, x->right, b, y->right));
    }
}

static int same_base(const struct asking *a, const struct node *x, const struct asking *b,
                     const struct node *y)
{
    if (x->tool != y->tool || x->reads.count != y->reads.count)
        return 0;
    for (int i = 0; i < x->reads.count; i++) { /* an extern may be declared otherwise */
        const struct need *p = &a->dag->needs[x->reads.first + i],
                          *q = &b->dag->needs[y->reads.first + i];
        if (p->term != q->term || p->level != q->level)
            return 0;
    }
    for (int i = 0; i < x->arguments.count; i++)
        if (!same_value(a->dag, a->dag->arguments[x->arguments.first + i].expression, b->dag,
                        b->dag->arguments[y->arguments.first + i].expression))
            return 0;
    return 1;
}

/* Bases are looked for among those of the same text: chains, newest first. */
static void find_bases(struct questions *all, struct arena *arena)
{
    int most = all->side[0].oracle->order.count + all->side[1].oracle->order.count;
    struct table texts = {NULL, NULL, 0, 0};
    int *last = dag_alloc(arena, (size_t)most * sizeof(int));
    int *before = dag_alloc(arena, (size_t)most * sizeof(int));
    all->bases = dag_alloc(arena, (size_t)most * sizeof *all->bases);
    for (int s = 0; s < SIDES; s++) {
        struct asking *side = &all->side[s];
        side->base = dag_alloc(arena, (size_t)side->oracle->order.count * sizeof(int));
        for (int i = 0; i < side->oracle->order.count; i++) {
            const struct node *node = asked_at(side, i);
            int text = texts.count;
            int known = dag_put(arena, &texts, dag_call_text(side->dag, node), text);
            text = known < 0 ? text : known;
            int found = last[text] - 1;
            for (; found >= 0; found = before[found] - 1) {
                const struct asking *other = &all->side[all->bases[found].side];
                if (same_base(side, node, other, asked_at(other, all->bases[found].node)))
                    break;
            }
            if (found < 0) {
                found = all->base_count++;
                all->bases[found].side = s;
                all->bases[found].node = i;
                before[found] = last[text];
                last[text] = found + 1;
            }
            side->base[i] = found;
        }
    }
}

static void set_bit(unsigned char *bits, int i)
{
    bits[i / 8] |= (unsigned char)(1 << i % 8);
}

static void find_reach(struct questions *all, struct arena *arena)
{
    all->bytes = (all->base_count + all->side[0].dag->term_count + 7) / 8;
    for (int s = 0; s < SIDES; s++) {
        struct asking *side = &all->side[s];
        int count = side->oracle->order.count;
        side->reach = dag_alloc(arena, (size_t)count * (size_t)all->bytes);
        for (int i = count - 1; i >= 0; i--) {
            const struct node *node = asked_at(side, i);
            unsigned char *row = side->reach + (size_t)i * (size_t)all->bytes;
            set_bit(row, side->base[i]);
            for (int t = 0; t < side->dag->term_count; t++)
                if (dag_reads_term(side->dag, node->reads, t)
                    || dag_reads_term(side->dag, side->dag->tools[node->tool].reads, t))
                    set_bit(row, all->base_count + t);
            for (int a = 0; a < node->arcs.count; a++) {
                const struct target *target = &side->dag->arcs[node->arcs.first + a].target;
                if (target->kind != TARGET_NODE)
                    continue;
                const unsigned char *from =
                    side->reach
                    + (size_t)side->dag->nodes[target->index].order * (size_t)all->bytes;
                for (int k = 0; k < all->bytes; k++)
                    row[k] |= from[k];
            }
        }
    }
}

static void find_subgraphs(struct questions *all, struct arena *arena)
{
    for (int s = 0; s < SIDES; s++) {
        struct asking *side = &all->side[s];
        int count = side->oracle->order.count;
        side->subgraph = dag_alloc(arena, (size_t)count * sizeof *side->subgraph);
        for (int i = count - 1; i >= 0; i--) {
            const struct node *node = asked_at(side, i);
            uint64_t hash = dag_mix(4, (uint64_t)side->base[i]);
            for (int a = 0; a < node->arcs.count; a++)
                hash = dag_mix(
                    hash, dag_subgraph_of(side, &side->dag->arcs[node->arcs.first + a].target));
            side->subgraph[i] = hash;
        }
    }
}

void dag_questions_find(struct questions *all, struct arena *arena)
{
    find_bases(all, arena);
    find_reach(all, arena);
    find_subgraphs(all, arena);
}
