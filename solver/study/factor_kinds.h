/* factor_kinds.h - the form factors of a solution's links by every level of the term: how wrong,
 * at what cost.
 * SPDX-License-Identifier: MIT */
#ifndef FACTOR_KINDS_H
#define FACTOR_KINDS_H

#include "util/progress.h"
#include "util/solved.h"

/* Kind k is level k + 1 of term form_factor. Bins are of the distance of the centres over the sum
 * of the radii: bin b ends at 2^b, the last nowhere. */
enum { KINDS = FORM_FACTOR_CONTOUR, KIND_CONTOUR = KINDS - 1, BINS = 6 };

/* Sums over the links of a bin. */
struct factor_tally {
    size_t links;       /* that were evaluated and compared */
    double exchange;    /* sum of A_r F, by the yardstick (m2) */
    double off, excess; /* sums of A_r |F - F*| and A_r (F - F*) (m2) */
    double worst;       /* largest |F - F*| */
    double evaluations, seconds;
};

struct factor_kind {
    const char *name, *looks_at; /* what one evaluation looks at */
    /* the last: all bins. The yardstick F* is the contour integral; of that itself fine_factor.h,
     * over some links of each bin */
    struct factor_tally tally[BINS + 1];
    double reflected; /* L1 of reflected light per face, over the reflected light; of contour 0 */
    /* what a solve caps off the rows: sum A (row - 1) over rows above 1, over the scene's area */
    double capped;
};

struct factor_kinds {
    struct factor_kind kind[KINDS];
    size_t links, left_out; /* left_out: with a cluster at an end */
    double doubt;           /* of fine_factor.h: sum over its links, over their exchange */
};

/* Evaluate, time on this thread, and solve once per kind over the same links, which have the last
 * one's form factors then. Returns 0, or -1 after a message. */
int factor_kinds_measure(struct factor_kinds *kinds, const struct solved *solved, RadDevice device,
                         const char *where, struct progress *progress);

#endif
