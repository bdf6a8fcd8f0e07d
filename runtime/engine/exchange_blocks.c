/* exchange_blocks.c - the exchange areas of a block of pairs.
 *
 * In a clear view each pair has its own (exchange_clear.h). In half shadow of groups each value is
 * looked into from a few points, or pair by pair (exchange_shadow.h). Single faces that are not
 * proved to see each other, groups with more between than a list holds, and parts of faces linked
 * to groups are looked into pair by pair (exchange_sight.h).
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "engine/exchange_blocks.h"
#include "kernel/constants.h"
#include "kernel/polygon_factor.h"
#include "terms/blockers.h"

int exchange_scratch_open(struct exchange_scratch *s, const struct sight_limits *limits)
{
    return sight_scratch_open(&s->sight, limits) < 0 ? -1 : shadow_scratch_open(&s->shadow, TILE);
}

void exchange_scratch_close(struct exchange_scratch *s)
{
    sight_scratch_close(&s->sight);
    shadow_scratch_close(&s->shadow);
}

/* What may stand between one face of the receiver and all of the emitter: of those of a list, or,
 * when this is NULL, of all there are. Returns `own`, or the list when that is good enough. */
static const struct sight_list *list_row(const struct exchange_pair *pair, uint32_t row,
                                         const struct sight_list *list, struct sight_list *own)
{
    const struct element *s = pair->emitter;
    if (!s->group || (list && list->count <= SIGHT_SHORT))
        return list;
    const struct element *r =
        pair->receiver->group ? exchange_tree_face(pair->tree, row) : pair->receiver;
    sight_list_find(own, r, s, pair->tree, list);
    return own->count <= SIGHT_LIST ? own : list;
}

/* A block of which no more is known than what it links. Lists are handed down: a row's shaft lies
 * in the block's, a pair's in the row's. */
static double block_by_pairs(const struct exchange_pair *pair, struct exchange_scratch *scratch,
                             double *out)
{
    const struct element *r = pair->receiver, *s = pair->emitter;
    double error, most = 0;
    struct sight_list list, own, *among = NULL;
    if (r->group || s->group) {
        sight_list_find(&list, r, s, pair->tree, NULL);
        among = list.count <= SIGHT_LIST ? &list : NULL;
    }
    for (uint32_t i = pair->rows.from; i < pair->rows.to; i++) {
        const struct sight_list *row = list_row(pair, i, among, &own);
        for (uint32_t j = pair->columns.from; j < pair->columns.to; j++) {
            *out++ = sight_pair(r->group ? exchange_tree_face(pair->tree, i) : r,
                                s->group ? exchange_tree_face(pair->tree, j) : s, pair->tree, row,
                                &scratch->sight, &error);
            most = fmax(most, error);
        }
    }
    return most;
}

/* The form factor of a link in clear view. Of whole faces in all its digits: the link keeps those
 * of a float, and what is right to 1e-5 where faces look at each other is right to 1e-3 where they
 * graze. None is made anew that the oracle had by other means. */
static double link_factor(const struct exchange_pair *pair, const struct link *link)
{
    const struct element *r = pair->receiver, *s = pair->emitter;
    int level = link->levels & 15;
    if (r->depth || s->depth || (level != FORM_FACTOR_POLYGON && level != FORM_FACTOR_CONTOUR))
        return (double)link->form_factor;
    return polygon_factor(r, s, 1);
}

static int is_proved(const struct link *link)
{
    return link->levels >> 4 == VISIBILITY_EXACT && link->visibility == LINK_VISIBLE;
}

int exchange_link_clear(const struct exchange_tree *tree, const struct link *link)
{
    const struct element *r = &tree->h.elements[link->receiver],
                         *s = &tree->h.elements[link->emitter];
    return is_proved(link) && (r->group || s->group) && !r->depth && !s->depth;
}

double exchange_block_fill(const struct exchange_faces *p, const struct exchange_pair *pair,
                           const struct link *link, struct exchange_scratch *scratch, double *out)
{
    const struct element *r = pair->receiver, *s = pair->emitter;
    struct blockers list = {.known = BLOCKERS_UNKNOWN};
    if (is_proved(link) && !r->group && !s->group) {
        double e = r->area * link_factor(pair, link), least = fmin(r->area, s->area);
        *out = e < least ? e : least;
        return 0;
    }
    if (r->depth || s->depth || (!r->group && !s->group)) /* or a part of a face against a group */
        return block_by_pairs(pair, scratch, out);
    if (is_proved(link)) {
        clear_block(p, pair, scratch->sight.limits.tolerance, out);
        return 0;
    }
    blockers_find(r, s, &pair->tree->host, &list);
    if (list.covered) { /* which a list handed down to the oracle does not tell */
        memset(out, 0,
               (size_t)(pair->rows.to - pair->rows.from) * (pair->columns.to - pair->columns.from)
                   * sizeof *out);
        return 0;
    }
    if (list.count > BLOCKERS_MAX)
        return block_by_pairs(pair, scratch, out);
    clear_block(p, pair, scratch->sight.limits.tolerance, out);
    return shadow_block(pair, &list, &scratch->shadow, &scratch->sight, out);
}
