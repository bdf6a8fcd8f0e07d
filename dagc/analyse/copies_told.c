/* copies_told.c - which knowledge of the terms is worth telling apart.
 *
 * Copies multiply with each level that is told apart. So levels are taken one by one, first that
 * on which most checks hang, each as long as all copies stay within what is allowed: a check of a
 * rare node is left before one of a node that every discussion asks. How often a node is asked is
 * estimated from the graph alone, all answers of a node equally likely.
 * SPDX-License-Identifier: MIT */
#include "analyse/making.h"

/* By place: the share of discussions that come there, were all answers equally likely. */
static double *find_shares(const struct making *m)
{
    double *share = dag_alloc(&m->dag->arena, (size_t)m->oracle->order.count * sizeof *share);
    share[0] = 1;
    for (int place = 0; place < m->oracle->order.count; place++) {
        const struct node *node = dag_node_at(m->dag, m->oracle, place);
        for (int a = 0; a < node->arcs.count; a++) {
            const struct target *target = &m->dag->arcs[node->arcs.first + a].target;
            if (target->kind == TARGET_NODE)
                share[m->dag->nodes[target->index].order] += share[place] / node->arcs.count;
        }
    }
    return share;
}

/* How many checks of the general copies hang on knowledge of that level, per discussion. */
static double count_hanging(const struct making *m, const double *share, int term, int level)
{
    double count = 0;
    for (int place = 0; place < m->oracle->order.count; place++) {
        const struct copy *copy = &m->copies->items[m->copies->first[place]];
        if (dag_making_asked(m->dag, dag_node_at(m->dag, m->oracle, place), term)
                & dag_making_bit(level)
            && copy->known.low[term] < level && copy->known.high[term] >= level)
            count += share[place];
    }
    return count;
}

void dag_making_tell_apart(struct making *m)
{
    const double *share = find_shares(m);
    uint64_t *tried = dag_alloc(&m->dag->arena, (size_t)m->terms * sizeof *tried);
    for (;;) {
        int term = -1, level = 0;
        double most = 0;
        for (int t = 0; t < m->terms; t++)
            for (int l = 1; l <= dag_making_finest(m->dag, t) && l < CUTS; l++) {
                double count = tried[t] & dag_making_bit(l) ? 0 : count_hanging(m, share, t, l);
                if (count > most) {
                    most = count;
                    term = t;
                    level = l;
                }
            }
        if (term < 0)
            break;
        tried[term] |= dag_making_bit(level);
        m->told[term] |= dag_making_bit(level);
        if (dag_making_copies(m) < 0)
            m->told[term] &= ~dag_making_bit(level);
    }
    for (int t = 0; t < m->terms; t++)
        for (int l = 1; l <= dag_making_finest(m->dag, t) && l < CUTS; l++) {
            m->early[t] |= m->told[t] & dag_making_bit(l);
            if (m->told[t] & dag_making_bit(l) && dag_making_copies(m) < 0)
                m->early[t] &= ~dag_making_bit(l);
        }
}
