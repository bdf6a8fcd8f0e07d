/* expression.c - what the passes ask of an expression.
 *
 * Walks recurse: a tree is never deeper than EXPRESSION_DEPTH. Operands are visited from left to
 * right, the order in which both releases evaluate them.
 * SPDX-License-Identifier: MIT */
#include "base/internal.h"

int dag_is_fixed(const struct dag *dag, int expression)
{
    const struct expression *e = &dag->expressions[expression];
    if (e->kind == EXPRESSION_FACT || e->kind == EXPRESSION_TERM || e->kind == EXPRESSION_EXTERN)
        return 0;
    return (e->left < 0 || dag_is_fixed(dag, e->left))
           && (e->right < 0 || dag_is_fixed(dag, e->right));
}

int dag_reads_parameters(const struct dag *dag, int expression)
{
    const struct expression *e = &dag->expressions[expression];
    return e->kind == EXPRESSION_PARAMETER || (e->left >= 0 && dag_reads_parameters(dag, e->left))
           || (e->right >= 0 && dag_reads_parameters(dag, e->right));
}

static int reads(const struct dag *dag, int expression, enum expression_kind kind, int index)
{
    const struct expression *e = &dag->expressions[expression];
    return (e->kind == kind && e->index == index)
           || (e->left >= 0 && reads(dag, e->left, kind, index))
           || (e->right >= 0 && reads(dag, e->right, kind, index));
}

static int oracle_reads(const struct dag *dag, const struct oracle_graph *oracle,
                        enum expression_kind kind, int index)
{
    for (int i = oracle->order.first; i < oracle->order.first + oracle->order.count; i++) {
        const struct span arguments = dag->nodes[dag->order[i]].arguments;
        for (int k = arguments.first; k < arguments.first + arguments.count; k++)
            if (reads(dag, dag->arguments[k].expression, kind, index))
                return 1;
    }
    return 0;
}

int dag_reads_fact(const struct dag *dag, const struct oracle_graph *oracle, int fact)
{
    return oracle_reads(dag, oracle, EXPRESSION_FACT, fact);
}

int dag_reads_extern(const struct dag *dag, const struct oracle_graph *oracle, int callback)
{
    return oracle_reads(dag, oracle, EXPRESSION_EXTERN, callback);
}

void dag_fold(const struct dag *dag, struct expression *e)
{
    if (e->kind != EXPRESSION_NEGATE || dag->expressions[e->left].kind != EXPRESSION_NUMBER)
        return;
    const struct expression operand = dag->expressions[e->left];
    const struct where where = e->where;
    *e = operand;
    e->where = where;
    e->number = -operand.number;
    e->low = -operand.high;
    e->high = -operand.low;
}

int dag_add_expression(struct dag *dag, const struct expression *expression)
{
    int index = ADD(dag, expressions, expression_count);
    struct expression *e = &dag->expressions[index];
    *e = *expression;
    dag_fold(dag, e);
    e->size = e->depth = 1;
    const int operands[] = {e->left, e->right};
    for (int i = 0; i < 2; i++)
        if (operands[i] >= 0) { /* both are at most 1000 or so: the sums do not overflow */
            const struct expression *operand = &dag->expressions[operands[i]];
            e->size += operand->size;
            e->depth = operand->depth >= e->depth ? operand->depth + 1 : e->depth;
        }
    return index;
}

static void add_need(struct dag *dag, int term, int level, struct where where)
{
    if (term < 0)
        return; /* an extern's, and its declaration was told to be wrong */
    int index = ADD(dag, needs, need_count);
    struct need *need = &dag->needs[index];
    const struct term *t = &dag->terms[term];
    need->term = term;
    need->level = level;
    need->term_name = t->name;
    need->level_name =
        t->levels.count > 0 && level > 0 ? dag->levels[t->levels.first + level - 1].name : NULL;
    need->where = need->level_where = where;
}

void dag_add_reads(struct dag *dag, int expression)
{
    const struct expression *e = &dag->expressions[expression];
    if (e->kind == EXPRESSION_TERM)
        add_need(dag, e->index, e->level, e->where);
    else if (e->kind == EXPRESSION_EXTERN) {
        struct span reads = dag->callbacks[e->index].reads;
        for (int i = reads.first; i < reads.first + reads.count; i++)
            add_need(dag, dag->needs[i].term, dag->needs[i].level, e->where);
    }
    if (e->left >= 0)
        dag_add_reads(dag, e->left);
    if (e->right >= 0)
        dag_add_reads(dag, e->right);
}

const char *dag_expression_text(struct dag *dag, int expression)
{
    const struct expression *e = &dag->expressions[expression];
    enum { SHOWN = 40 };
    if (e->where.source < 0)
        return "";
    const char *text = dag->sources[e->where.source].text + e->where.offset;
    int length = e->where.length, end = 0;
    while (end < length && end < SHOWN && text[end] != '\n' && text[end] != '\r'
           && text[end] != '#')
        end++;
    while (end > 0 && end < length && ((unsigned char)text[end] & 0xc0) == 0x80)
        end--;
    return dag_format(&dag->arena, "%.*s%s", end, text, end < length ? "..." : "");
}
