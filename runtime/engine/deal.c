/* deal.c - see deal.h.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include "engine/deal.h"
#include "engine/discuss.h"
#include "util/ranks.h"

/* The lists of candidates that pairs have found, of those that have one. */
static int tell_lists(const struct refinement *r, size_t count)
{
    const int ranks = ranks_count(r->deal);
    size_t *at = malloc(((size_t)ranks + 1) * sizeof *at), n = 0;
    struct blockers *told = NULL;
    for (size_t i = 0; i < count; i++)
        n += r->outcomes[i].listed;
    if (n)
        told = malloc(n * sizeof *told);
    const int failed = ranks_any(r->deal, !at || (n && !told));
    n = 0;
    for (int k = 0; k < ranks && !failed; k++) {
        at[k] = n;
        for (size_t i = ranks_part(r->deal, count, k); i < ranks_part(r->deal, count, k + 1); i++)
            if (r->outcomes[i].listed)
                told[n++] = r->found[i]; /* of this rank's pairs; others' come in their places */
    }
    if (!failed) {
        at[ranks] = n;
        ranks_complete(r->deal, RANKS_PAIRS, told, sizeof *told, at);
    }
    n = 0;
    for (size_t i = 0; i < count && !failed; i++)
        if (r->outcomes[i].listed)
            r->found[i] = told[n++];
    free(told);
    free(at);
    return failed ? -1 : 0;
}

int deal_round(const struct refinement *r, size_t count)
{
    const int me = ranks_number(r->deal);
    const size_t from = ranks_part(r->deal, count, me), to = ranks_part(r->deal, count, me + 1);
    discuss_round(r, from, to);
    ranks_complete_parts(r->deal, RANKS_PAIRS, r->outcomes, sizeof *r->outcomes, count);
    for (size_t i = 0; i < count; i++) /* a name is where this process has it */
        if (r->outcomes[i].none && (i < from || i >= to))
            discuss_round(r, i, i + 1);
    return tell_lists(r, count);
}
