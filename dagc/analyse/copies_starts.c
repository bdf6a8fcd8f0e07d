/* copies_starts.c - what a discussion may begin with.
 *
 * What a decision gives back is handed in when the pair is discussed again. On every path to the
 * decision some terms have reached some levels: that much such a discussion surely begins with, and
 * one look tells it from others. Nothing here is trusted: who begins with something else, as with
 * what another oracle left, is sent to the general copies.
 * SPDX-License-Identifier: MIT */
#include "analyse/making.h"

enum { STARTS = 64 }; /* so many knowledges that discussions begin with */

static unsigned char *left_by(const struct making *m, int decision)
{
    return m->left + (size_t)decision * (size_t)m->terms;
}

/* What every path to the decision leaves of the terms that it gives back. */
static void find_left(const struct making *m, int decision)
{
    const struct dag *dag = m->dag;
    const struct span reads = dag->decisions[decision].reads;
    unsigned char *sure = dag_alloc(&m->dag->arena, (size_t)m->oracle->order.count);
    for (int k = reads.first; k < reads.first + reads.count; k++) {
        int term = dag->needs[k].term, least = -1;
        dag_sure_levels(dag, m->oracle, term, sure);
        for (int i = 0; i < m->oracle->order.count; i++) {
            const struct node *node = dag_node_at(dag, m->oracle, i);
            for (int a = 0; a < node->arcs.count; a++) {
                const struct target *target = &dag->arcs[node->arcs.first + a].target;
                int level = dag_left_level(dag, node, a, term);
                level = level > sure[i] ? level : sure[i];
                if (target->kind == TARGET_DECISION && target->index == decision
                    && (least < 0 || level < least))
                    least = level;
            }
        }
        left_by(m, decision)[term] = least > 0 ? (unsigned char)least : 0;
    }
}

void dag_making_find_left(struct making *m)
{
    m->left = dag_alloc(&m->dag->arena, (size_t)m->dag->decision_count * (size_t)m->terms);
    for (int d = 0; d < m->dag->decision_count; d++)
        find_left(m, d);
}

/* Are these levels what some decision leaves, or better? */
static int is_start(const struct making *m, const unsigned char *low)
{
    int is = 0;
    for (int d = 0; d < m->dag->decision_count; d++) {
        const unsigned char *left = left_by(m, d);
        int some = 0, all = 1;
        for (int t = 0; t < m->terms; t++) {
            some |= left[t] > 0;
            all &= low[t] >= left[t] && (left[t] > 0 || low[t] == 0);
        }
        is |= some && all;
    }
    return is;
}

/* Those levels that decisions leave, and those of the same terms that are told apart early, are
 * the digits of a number: whatever a discussion begins with is found by one look. */
static void find_looks(struct making *m)
{
    struct copies *copies = m->copies;
    uint64_t any = 0;
    int weight = 1;
    copies->look_count = 0;
    for (int t = 0; t < m->terms; t++)
        any |= m->told[t];
    for (int t = 0; t < m->terms; t++) {
        uint64_t levels = 0;
        int digits = 1;
        for (int d = 0; d < m->dag->decision_count && any; d++)
            levels |= dag_making_bit(left_by(m, d)[t]);
        levels |= levels ? m->early[t] : 0;
        for (int level = 1; level <= dag_making_finest(m->dag, t) && level < CUTS; level++)
            if (levels & dag_making_bit(level) && (digits + 1) * weight <= STARTS) {
                copies->looks = dag_grow(&m->dag->arena, copies->looks, copies->look_count,
                                         sizeof *copies->looks);
                copies->looks[copies->look_count++] = (struct look){t, level, weight};
                digits++;
            }
        weight *= digits;
    }
    copies->start_count = weight;
}

/* What is known where the looks make that number, in place of what may be. */
static void know(const struct copies *copies, int number, struct knowledge known)
{
    for (int i = 0; i < copies->look_count; i++) {
        const struct look *look = &copies->looks[i];
        int digits = 1, at = 0; /* of its term; which of them is the look's */
        for (int k = 0; k < copies->look_count; k++)
            if (copies->looks[k].term == look->term) {
                digits++;
                at += k <= i;
            }
        if (number / look->weight % digits >= at)
            known.low[look->term] = (unsigned char)look->level;
        else if (known.high[look->term] >= look->level)
            known.high[look->term] = (unsigned char)(look->level - 1);
    }
}

void dag_making_starts(struct making *m, struct knowledge any)
{
    struct copies *copies = m->copies;
    struct knowledge known = dag_making_knowledge(m);
    find_looks(m);
    copies->starts = dag_alloc(&m->dag->arena, (size_t)copies->start_count * sizeof(int));
    for (int number = 0; number < copies->start_count; number++) {
        dag_making_copy(m, known, any);
        know(copies, number, known);
        copies->starts[number] =
            is_start(m, known.low) ? dag_making_entry(m, known) : copies->general;
    }
}
