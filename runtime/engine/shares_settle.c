/* shares_settle.c - what ranks tell each other after a pass: splits, links, and new stretches.
 *
 * Splits of a face are told as its tree, a bit for each element in preorder, 1 where it is split:
 * all ranks make the union of all trees, and hierarchy_settle gives it the same indices everywhere.
 * Then a link can be told as it is. The next stretches are of the same work as far as links tell
 * it: over them sweeps go, and they are what is discussed again. A link that a cluster receives is
 * one, too, spread over the faces below: it is discussed as one, and in sweeps a face takes little
 * of it. Counted once for each of them it made the fullest of 8 ranks have 1.22 times the mean.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "engine/shares.h"
#include "engine/tree_bits.h"

/* ---- splits */

/* All trees that this pass has changed; a face's number before each, one that is no face's at the
 * end. */
static int put_splits(struct tree_bits *b, const struct hierarchy *h, uint32_t first)
{
    unsigned char *changed = calloc(h->face_count + 1, 1);
    if (!changed)
        return -1;
    for (uint32_t i = first; i < h->count; i++)
        changed[h->elements[i].face] = 1;
    for (uint32_t f = 0; f < h->face_count; f++)
        if (changed[f]) {
            tree_bits_put_number(b, f);
            tree_bits_put(b, h, h->face_element[f]);
        }
    tree_bits_put_number(b, h->face_count);
    free(changed);
    return b->failed ? -1 : 0;
}

/* Splits of all ranks. Returns 0, or -1 on all. */
static int share_splits(const struct shares *s, struct hierarchy *h, uint32_t first)
{
    const size_t ranks = (size_t)ranks_count(s->ranks), me = (size_t)ranks_number(s->ranks);
    struct tree_bits b = {0};
    size_t *place = calloc(ranks + 1, sizeof *place);
    int failed = !place || put_splits(&b, h, first) < 0;
    unsigned char *all = NULL;
    if (!ranks_any(s->ranks, failed)) {
        ranks_starts(s->ranks, RANKS_SPLITS, (b.count + 7) / 8, place);
        all = malloc(place[ranks] + 1);
        failed = ranks_any(s->ranks, !all);
        if (!failed) {
            memcpy(all + place[me], b.byte, (b.count + 7) / 8);
            ranks_complete(s->ranks, RANKS_SPLITS, all, 1, place);
            for (size_t k = 0; k < ranks && !failed; k++) {
                size_t at = 0;
                uint32_t face;
                while (k != me && !failed
                       && (face = tree_bits_take_number(all + place[k], &at)) < h->face_count)
                    failed = tree_bits_take(all + place[k], &at, h, h->face_element[face]) < 0;
            }
        }
    } else {
        failed = 1;
    }
    free(all);
    free(place);
    free(b.byte);
    return ranks_any(s->ranks, failed) ? -1 : 0;
}

/* ---- links */

/* Is this rank the one that tells of the link? Of those that all have, the first. */
static int tells(const struct shares *s, const struct link *l)
{
    return shares_owner(s, l->receiver) != SHARED || ranks_number(s->ranks) == 0;
}

/* What a link costs, and a face besides. All are integers, so that sums have no order, and all
 * ranks have the same stretches. */
enum { OF_A_LINK = 1 << 20, OF_A_FACE = OF_A_LINK / 10 };

/* work[face], of all ranks' links. */
static int measure_work(const struct shares *s, const struct refinement *r, double *work)
{
    const struct hierarchy *h = s->hierarchy;
    double *step = calloc(h->face_count + 1, sizeof *step), all = 0; /* in the tree's order */
    if (ranks_any(s->ranks, !step)) {
        free(step);
        return -1;
    }
    memset(work, 0, h->face_count * sizeof *work);
    for (size_t i = 0; i < r->link_count; i++) {
        const uint32_t to = r->links[i].receiver;
        if (!tells(s, &r->links[i]))
            continue;
        if (h->elements[to].vertices) {
            work[h->elements[to].face] += OF_A_LINK;
            continue;
        }
        const struct face_range below = h->range[to];
        const double each = (double)(OF_A_LINK / (below.to - below.from));
        step[below.from] += each;
        step[below.to] -= each;
    }
    for (uint32_t i = 0; i < h->face_count; i++)
        work[h->order[i]] += all += step[i];
    free(step);
    ranks_add(s->ranks, RANKS_LINKS, work, h->face_count);
    for (uint32_t i = 0; i < h->face_count; i++)
        work[i] += OF_A_FACE;
    return 0;
}

static void count_for(const struct shares *s, uint32_t receiver, size_t *count)
{
    const int owner = shares_owner(s, receiver);
    for (int k = 0; k < ranks_count(s->ranks); k++)
        count[k] += owner == k || owner == SHARED;
}

/* Links to their receivers' owners, by new stretches. Returns 0, or -1 on all ranks. */
static int share_links(struct shares *s, struct refinement *r)
{
    const int ranks = ranks_count(s->ranks);
    double *work = malloc(s->hierarchy->face_count * sizeof *work);
    size_t *count = calloc(3 * (size_t)ranks + 1, sizeof *count),
           *place = count ? count + ranks : 0, *came = count ? place + ranks : NULL, told = 0,
           all = 0;
    int failed = ranks_any(s->ranks, !work || !count) || measure_work(s, r, work) < 0;
    for (size_t i = 0; i < r->link_count && !failed; i++) /* by the old stretches */
        if (tells(s, &r->links[i]))
            r->links[told++] = r->links[i];
    if (!failed) {
        shares_divide(s, work);
        for (size_t i = 0; i < told; i++)
            count_for(s, r->links[i].receiver, count);
        for (int k = 0; k < ranks; k++) {
            place[k] = all;
            all += count[k];
        }
    }
    struct link *out = failed ? NULL : malloc((all + 1) * sizeof *out), *in = NULL;
    if (!failed && !ranks_any(s->ranks, !out)) {
        for (size_t i = 0; i < told; i++) {
            const int owner = shares_owner(s, r->links[i].receiver);
            for (int k = 0; k < ranks; k++)
                if (owner == k || owner == SHARED)
                    out[place[k]++] = r->links[i];
        }
        in = ranks_exchange(s->ranks, RANKS_LINKS, out, sizeof *out, count, came);
    }
    if (in) {
        free(r->links);
        r->links = in;
        r->link_count = 0;
        for (int k = 0; k < ranks; k++)
            r->link_count += came[k];
        r->link_capacity = r->link_count;
    }
    free(out);
    free(work);
    free(count);
    return in ? 0 : -1;
}

int shares_settle(struct shares *s, struct refinement *r, uint32_t first)
{
    const int several = ranks_count(s->ranks) > 1;
    if (several && share_splits(s, r->hierarchy, first) < 0)
        return -1;
    if (ranks_any(s->ranks, refinement_settle(r, first) < 0) || (several && share_links(s, r) < 0))
        return -1;
    return ranks_any(s->ranks, refinement_sort(r) < 0) || shares_find_ghosts(s, r) < 0 ? -1 : 0;
}
