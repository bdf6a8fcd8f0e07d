/* row_sums.h - the row of a leaf: the sum of F V over its own links and its ancestors', and what it
 * is scaled to.
 * SPDX-License-Identifier: MIT */
#ifndef ROW_SUMS_H
#define ROW_SUMS_H

#include "engine/operator.h"

/* The rows of all leaves before the cap or closure, per uncovered area; 1 in a closed scene
 * without error. */
struct row_report {
    uint32_t leaves;
    double low, high;                /* smallest and largest row */
    double defect_mean, defect_most; /* |row - 1|, by uncovered area: mean and largest */
    double blind_area;               /* uncovered leaves without any link (m2) */
    /* what the cap or closure took: sum A (row - 1) over rows above 1, over the scene's area */
    double moved;
};

/* After the links have changed: take those that have a cluster at one end anew, which the rows are
 * measured over before they send, measure all rows and set the operator's row scales as
 * options.closure says. Returns 0, or -1 when out of memory. */
int row_sums_renew(struct light_operator *op, struct row_report *report);

#endif
