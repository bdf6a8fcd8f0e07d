/* visibility_table.h - what the visibility study has counted, as tables, a chart, and advice: which
 * tool is good enough for which projected areas.
 *
 * An answer is wrong when it is not the reference's. A row is of all pairs below its threshold, as
 * in the paper's table 5.
 * SPDX-License-Identifier: MIT */
#ifndef VISIBILITY_TABLE_H
#define VISIBILITY_TABLE_H

#include "options/options.h"
#include "study/reliability.h"

struct visibility_table {
    const struct options *options; /* thresholds, rays, wrong, out, chart */
    struct bin bins[STUDY_LIST];   /* by threshold */
    double unit, area;             /* the area unit, the scene's area, m2 */
    const char *partial;           /* why not all pairs have been discussed; NULL: they have */
    double seconds;                /* that it took */
};

/* To standard output: the tables, and which tool is good enough with at most options->wrong wrong
 * answers, as settings of oracle by_reliability. */
void visibility_table_print(const struct visibility_table *t);

/* To options->out, options->chart. Return 0, or -1 after a message. */
int visibility_table_write(const struct visibility_table *t);
int visibility_table_draw(const struct visibility_table *t);

#endif
