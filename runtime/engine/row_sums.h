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

/* Take the links that have a cluster at one end anew, each of several ranks those of its faces.
 * Returns 0, or -1 on all ranks when any is out of memory. */
int row_sums_separate(struct light_operator *op);

/* After the links have changed: that, for the rows are measured over these before they send;
 * measure all rows and set the operator's row scales as options.closure says. Returns 0 or -1,
 * alike. */
int row_sums_renew(struct light_operator *op, struct row_report *report);

#endif
