/* copies.c - what paths know of the terms, with a node copied where they disagree.
 *
 * Knowledge of a term is an interval of levels. Each node exists once for all that may be known
 * anywhere: the general copy, which looks at whatever is open. Beside it, forward from what
 * discussions begin with, in topological order, it exists once for each knowledge that a path
 * brings to it, so that a check whose outcome hangs on the path is none: a path that knows and one
 * that does not run through different copies. Discussions begin with nothing, or with what some
 * decision leaves on every path to it, since what it left is handed back when the pair is discussed
 * again: one look at all of that at once, and nothing of it is looked at below. Whoever comes with
 * something else runs through the general copies (copies_starts.c).
 *
 * Where a tool leaves open what it computed, one look at the level, just behind the call, says
 * which copy is next (a compiler that has inlined the tool knows, and takes the look out); where
 * the host left it open, the look is taken when somebody first asks. Levels that nobody below asks
 * for are not told apart, nor are those for which there would be too many copies (copies_told.c).
 *
 * `low` is what writes declare, and may be stated as a fact. `high` is a guess, since a tool may
 * compute terms on its way that it does not name: it decides where copies are made, never what
 * they do.
 * [specialisation of a program to what is known of its input: Jones, Gomard and Sestoft 1993;
 * splitting paths at merges: Mueller and Whalley, Avoiding conditional branches by code
 * replication, PLDI 1995]
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "analyse/making.h"

int dag_making_finest(const struct dag *dag, int term)
{
    int levels = dag->terms[term].levels.count;
    return levels > 0 ? levels : 1;
}

uint64_t dag_making_bit(int level)
{
    return level > 0 && level < CUTS ? UINT64_C(1) << level : 0;
}

static uint64_t *cuts_at(const struct making *m, int place)
{
    return m->cuts + (size_t)place * (size_t)m->terms;
}

/* ---- what is asked for */

/* Without a level any may be asked for: whether there is one at all is what matters. */
uint64_t dag_making_asked(const struct dag *dag, const struct node *node, int term)
{
    const struct tool *tool = &dag->tools[node->tool];
    const struct span *const spans[] = {&node->reads, &tool->reads, &tool->writes};
    uint64_t cuts = 0;
    for (int s = 0; s < 3; s++)
        for (int i = spans[s]->first; i < spans[s]->first + spans[s]->count; i++)
            if (dag->needs[i].term == term)
                cuts |= dag_making_bit(dag->needs[i].level > 0 ? dag->needs[i].level : 1);
    return cuts;
}

/* Those asked for below it. */
static uint64_t cuts_below(const struct making *m, const struct node *node, int term)
{
    uint64_t cuts = 0;
    for (int a = 0; a < node->arcs.count; a++) {
        const struct target *target = &m->dag->arcs[node->arcs.first + a].target;
        /* what the node leaves there needs no asking */
        int left = dag_left_level(m->dag, node, a, term);
        if (target->kind == TARGET_NODE && left < CUTS - 1)
            cuts |=
                cuts_at(m, m->dag->nodes[target->index].order)[term] & ~((UINT64_C(2) << left) - 1);
    }
    return cuts;
}

static void find_cuts(struct making *m)
{
    for (int place = m->oracle->order.count - 1; place >= 0; place--) {
        const struct node *node = dag_node_at(m->dag, m->oracle, place);
        for (int t = 0; t < m->terms; t++)
            cuts_at(m, place)[t] =
                (dag_making_asked(m->dag, node, t) & m->told[t]) | cuts_below(m, node, t);
    }
}

/* ---- what is known */

struct knowledge dag_making_knowledge(const struct making *m)
{
    struct knowledge known = {dag_alloc(&m->dag->arena, (size_t)m->terms),
                              dag_alloc(&m->dag->arena, (size_t)m->terms)};
    return known;
}

void dag_making_copy(const struct making *m, struct knowledge to, struct knowledge from)
{
    memcpy(to.low, from.low, (size_t)m->terms);
    memcpy(to.high, from.high, (size_t)m->terms);
}

/* After the node has answered. A tool that writes a term may also make it coarser. */
static void pass_node(const struct making *m, const struct node *node, int answer,
                      struct knowledge known)
{
    for (int t = 0; t < m->terms; t++) {
        int written = dag_written_level(m->dag, &m->dag->tools[node->tool], answer, t);
        int left = dag_left_level(m->dag, node, answer, t);
        if (dag_making_asked(m->dag, node, t) == 0)
            continue;
        known.high[t] = (unsigned char)dag_making_finest(m->dag, t);
        if (written > 0)
            known.low[t] = (unsigned char)written;
        else if (left > known.low[t])
            known.low[t] = (unsigned char)left;
    }
}

/* ---- copies */

/* Do two knowledges of the terms say the same of all that is asked for from this place on? */
static int agree(const struct making *m, int place, struct knowledge a, struct knowledge b)
{
    for (int t = 0; t < m->terms; t++)
        for (int level = 1; level <= dag_making_finest(m->dag, t) && level < CUTS; level++)
            if (cuts_at(m, place)[t] & dag_making_bit(level)
                && ((a.low[t] >= level) != (b.low[t] >= level)
                    || (a.high[t] >= level) != (b.high[t] >= level)))
                return 0;
    return 1;
}

static void widen(const struct making *m, struct knowledge known, struct knowledge by)
{
    for (int t = 0; t < m->terms; t++) {
        if (by.low[t] < known.low[t])
            known.low[t] = by.low[t];
        if (by.high[t] > known.high[t])
            known.high[t] = by.high[t];
    }
}

/* The copy of the node at this place for what is known, one that is there or a new one. */
static int copy_for(struct making *m, int place, struct knowledge known)
{
    struct copies *copies = m->copies;
    int last = -1, count = 0;
    for (int i = copies->first[place]; i >= 0; i = copies->items[i].next, count++) {
        last = i;
        if (m->general
            || ((count > 0 || !m->kept) && agree(m, place, copies->items[i].known, known))) {
            widen(m, copies->items[i].known, known);
            return i;
        }
    }
    copies->items = dag_grow(&m->dag->arena, copies->items, copies->count, sizeof *copies->items);
    struct copy *copy = &copies->items[copies->count];
    *copy = (struct copy){place, count, -1, 0, 0, NULL, dag_making_knowledge(m)};
    dag_making_copy(m, copy->known, known);
    if (last >= 0)
        copies->items[last].next = copies->count;
    else
        copies->first[place] = copies->count;
    return copies->count++;
}

/* Where the arc from `from` (NULL: an entry) to `to` looks at a level: 0 nowhere, else the cut. */
static int look_at(const struct making *m, const struct node *from, const struct node *to, int term,
                   struct knowledge known)
{
    uint64_t cuts = cuts_at(m, to->order)[term];
    uint64_t here = dag_making_asked(m->dag, to, term) ? cuts_below(m, to, term) : 0;
    if (from != NULL && dag_making_asked(m->dag, from, term))
        here |= cuts;
    for (int level = known.low[term] + 1; level <= known.high[term] && level < CUTS; level++)
        if (here & dag_making_bit(level))
            return level;
    return 0;
}

/* Does a path leave open whether the need is met? */
static int is_left_open(const struct dag *dag, const struct need *need, int any,
                        struct knowledge known)
{
    int low = known.low[need->term], high = known.high[need->term];
    if (any && need->level_name == NULL && dag_making_finest(dag, need->term) > 1)
        return high > 0 && low == 0;
    return low < need->level && high >= need->level;
}

static int count_checks(const struct dag *dag, const struct node *node, struct knowledge known)
{
    const struct tool *tool = &dag->tools[node->tool];
    const struct span *const spans[] = {&node->reads, &tool->reads, &tool->writes};
    int checks = 0;
    for (int s = 0; s < 3; s++)
        for (int i = spans[s]->first; i < spans[s]->first + spans[s]->count; i++)
            checks += is_left_open(dag, &dag->needs[i], s > 0, known);
    return checks;
}

static int new_way(struct making *m, struct way way)
{
    struct copies *copies = m->copies;
    copies->ways = dag_grow(&m->dag->arena, copies->ways, copies->way_count, sizeof *copies->ways);
    copies->ways[copies->way_count] = way;
    return copies->way_count++;
}

/* The way from `from` to `to` with this knowledge, which is changed on the way and put back. */
static int make_way(struct making *m, const struct node *from, const struct node *to, int term,
                    struct knowledge known)
{
    for (; term < m->terms && !m->general; term++) {
        int cut = look_at(m, from, to, term, known);
        if (cut == 0)
            continue;
        unsigned char low = known.low[term], high = known.high[term];
        known.high[term] = (unsigned char)(cut - 1);
        int below = make_way(m, from, to, term, known);
        known.high[term] = high;
        known.low[term] = (unsigned char)cut;
        int above = make_way(m, from, to, term, known);
        known.low[term] = low;
        const struct way *a = &m->copies->ways[below], *b = &m->copies->ways[above];
        if (a->cut == 0 && b->cut == 0 && a->below == b->below)
            return below;
        return new_way(m, (struct way){term, cut, below, above, 0});
    }
    return new_way(m, (struct way){-1, 0, copy_for(m, to->order, known), -1, 0});
}

/* A look behind a tool that was asked with the level known is none: the tool has settled it. */
static void note_looks(struct making *m, const struct node *from, int way, struct knowledge known)
{
    struct way *w = &m->copies->ways[way];
    if (w->cut == 0)
        return;
    w->checked = !dag_making_asked(m->dag, from, w->term)
                 || (known.low[w->term] == 0 && known.high[w->term] > 0);
    note_looks(m, from, w->below, known);
    note_looks(m, from, w->above, known);
}

static void note_entries(struct copies *copies, int way)
{
    const struct way *w = &copies->ways[way];
    if (w->cut == 0)
        copies->items[w->below].arcs_in++;
    else {
        note_entries(copies, w->below);
        note_entries(copies, w->above);
    }
}

int dag_making_entry(struct making *m, struct knowledge known)
{
    int way = make_way(m, NULL, dag_node_at(m->dag, m->oracle, 0), 0, known);
    note_entries(m->copies, way);
    return way;
}

/* The ways out of a copy; all that lead to it have been made. */
static void make_ways(struct making *m, int at)
{
    const struct node *node = dag_node_at(m->dag, m->oracle, m->copies->items[at].place);
    struct knowledge known = dag_making_knowledge(m), other_known = dag_making_knowledge(m);
    int *ways = dag_alloc(&m->dag->arena, (size_t)node->arcs.count * sizeof *ways);
    m->copies->items[at].ways = ways;
    m->copies->items[at].checks = count_checks(m->dag, node, m->copies->items[at].known);
    for (int a = 0; a < node->arcs.count; a++) {
        const struct target *target = &m->dag->arcs[node->arcs.first + a].target;
        dag_making_copy(m, known, m->copies->items[at].known);
        pass_node(m, node, a, known);
        ways[a] = -1;
        for (int b = 0; b < node->arcs.count; b++) { /* answers with one target have one way */
            const struct target *other = &m->dag->arcs[node->arcs.first + b].target;
            if (b == a || other->kind != TARGET_NODE || target->kind != TARGET_NODE
                || other->index != target->index)
                continue;
            if (b < a)
                ways[a] = ways[b];
            dag_making_copy(m, other_known, m->copies->items[at].known);
            pass_node(m, node, b, other_known);
            widen(m, known, other_known);
        }
        if (target->kind == TARGET_NODE && ways[a] < 0)
            ways[a] = make_way(m, node, &m->dag->nodes[target->index], 0, known);
        if (target->kind == TARGET_NODE) {
            note_entries(m->copies, ways[a]);
            note_looks(m, node, ways[a], m->copies->items[at].known);
        }
    }
}

static void make_all(struct making *m)
{
    for (int place = 0; place < m->oracle->order.count; place++)
        for (int i = m->copies->first[place]; i >= 0 && (size_t)m->copies->count <= m->most;
             i = m->copies->items[i].next)
            if (m->copies->items[i].ways == NULL)
                make_ways(m, i);
}

int dag_making_copies(struct making *m)
{
    struct copies *copies = m->copies;
    size_t nodes = (size_t)m->oracle->order.count;
    struct knowledge known = dag_making_knowledge(m);
    copies->first = dag_alloc(&m->dag->arena, nodes * sizeof *copies->first);
    for (size_t i = 0; i < nodes; i++)
        copies->first[i] = -1;
    copies->count = copies->way_count = 0;
    find_cuts(m);
    for (int t = 0; t < m->terms; t++)
        known.high[t] = (unsigned char)(dag_is_kept(m->dag, t) ? dag_making_finest(m->dag, t) : 0);
    m->general = m->kept || m->most == nodes;
    copies->general = dag_making_entry(m, known);
    make_all(m);
    m->general = 0;
    if (m->most == nodes)
        return 0;
    dag_making_starts(m, known);
    copies->nothing = dag_making_entry(m, dag_making_knowledge(m));
    make_all(m);
    return (size_t)copies->count <= m->most ? 0 : -1;
}

struct copies dag_copies(struct dag *dag, const struct oracle_graph *oracle, int most)
{
    struct copies copies = {0};
    size_t nodes = (size_t)oracle->order.count, terms = (size_t)dag->term_count;
    struct making m = {.dag = dag, .oracle = oracle, .copies = &copies, .terms = dag->term_count};
    m.told = dag_alloc(&dag->arena, terms * sizeof *m.told);
    m.early = dag_alloc(&dag->arena, terms * sizeof *m.early);
    m.cuts = dag_alloc(&dag->arena, nodes * terms * sizeof *m.cuts);
    m.most = nodes * (size_t)most;
    for (int t = 0; t < m.terms; t++)
        m.kept |= dag_is_kept(dag, t);
    if (most > 1)
        dag_making_find_left(&m);
    (void)dag_making_copies(&m);
    if (most > 1) {
        dag_making_tell_apart(&m);
        (void)dag_making_copies(&m);
    }
    return copies;
}
