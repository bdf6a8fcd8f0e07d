/* exchange_blocks.c - the exchange areas of a block of pairs.
 *
 * In a clear view each pair has its own (exchange_clear.h). In half shadow of groups each value is
 * looked into from a few points, or pair by pair (exchange_shadow.h). Single faces that are not
 * proved to see each other, groups with more between than a list holds, and parts of faces linked
 * to groups are halved down to the pairs that are in half shadow (exchange_halves.h).
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "engine/exchange_blocks.h"
#include "engine/exchange_halves.h"
#include "kernel/polygon_factor.h"
#include "terms/blockers.h"

int exchange_scratch_open(struct exchange_scratch *s, const struct sight_limits *limits)
{
    s->horizon = horizon_open();
    return !s->horizon || sight_scratch_open(&s->sight, limits) < 0
               ? -1
               : shadow_scratch_open(&s->shadow);
}

void exchange_scratch_close(struct exchange_scratch *s)
{
    sight_scratch_close(&s->sight);
    shadow_scratch_close(&s->shadow);
    free(s->horizon);
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

int exchange_link_proved(const struct link *link)
{
    return link->levels >> 4 == VISIBILITY_EXACT && link->visibility == LINK_VISIBLE;
}

int exchange_link_clear(const struct exchange_tree *tree, const struct link *link)
{
    const struct element *r = &tree->h.elements[link->receiver],
                         *s = &tree->h.elements[link->emitter];
    return exchange_link_proved(link) && (r->group || s->group) && !r->depth && !s->depth;
}

double exchange_block_fill(const struct exchange_faces *p, const struct exchange_pair *pair,
                           const struct link *link, struct exchange_scratch *scratch, double *out)
{
    const struct element *r = pair->receiver, *s = pair->emitter;
    struct blockers list = {.known = BLOCKERS_UNKNOWN};
    if (exchange_link_proved(link) && !r->group && !s->group) {
        const double e = r->area * link_factor(pair, link), least = fmin(r->area, s->area);
        const int dark = p->covered[pair->rows.from] || p->covered[pair->columns.from]
                         || clear_meet(pair->tree, r, s);
        *out = dark ? 0 : fmin(e, least);
        return 0;
    }
    if (r->depth || s->depth || (!r->group && !s->group)) /* or a part of a face against a group */
        return halves_block(p, pair, scratch->horizon, &scratch->sight, out);
    if (exchange_link_proved(link)) {
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
        return halves_block(p, pair, scratch->horizon, &scratch->sight, out);
    clear_block(p, pair, scratch->sight.limits.tolerance, out);
    return shadow_block(pair, &list, &scratch->shadow, &scratch->sight, out);
}
