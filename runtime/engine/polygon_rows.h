/* polygon_rows.h - of which polygons a rank adds up what is counted on their faces.
 *
 * Where each rank has the counts of its own faces, a polygon is its first face's owner's. Polygons
 * that have faces of several ranks, such as a floor that others stand on, are added up by all.
 * Else, and in a run of one process, all polygons are here.
 * SPDX-License-Identifier: MIT */
#ifndef POLYGON_ROWS_H
#define POLYGON_ROWS_H

#include "engine/problem.h"
#include "particles/particles.h"

#define NO_ROW UINT32_MAX

struct polygon_rows {
    struct ranks *ranks; /* that have parts; NULL: all polygons are here */
    uint32_t count;      /* here */
    uint32_t *row;       /* [polygon]; NO_ROW: another rank's. NULL: each at its index */
    uint32_t *polygon;   /* [count]; NULL likewise */
    uint32_t *several;   /* [several_count]: polygons with faces of several ranks, rising */
    uint32_t several_count;
};

/* As the tally has its counts. Returns 0, or -1 on all ranks that have parts when any is out of
 * memory; either way polygon_rows_close. */
int polygon_rows_open(struct polygon_rows *rows, const struct problem *p, const struct hierarchy *h,
                      const struct tally *tally);
void polygon_rows_close(struct polygon_rows *rows);

static inline uint32_t polygon_row(const struct polygon_rows *rows, uint32_t polygon)
{
    return rows->row ? rows->row[polygon] : polygon;
}

static inline uint32_t polygon_of_row(const struct polygon_rows *rows, uint32_t row)
{
    return rows->polygon ? rows->polygon[row] : row;
}

/* value[REPLICATES][rows->count * bands]: what the tally counted on all faces of each polygon,
 * times the reflectance (W); zero before. Returns as above. */
int polygon_rows_add(const struct polygon_rows *rows, const struct problem *p,
                     const struct hierarchy *h, const struct tally *tally, double *value);

/* [polygon]: the area of all its sides (m2), the caller's. NULL when out of memory. */
double *polygon_areas(const struct problem *p, const struct hierarchy *h);

/* What is larger is a large face (m2): FACE_ERROR_LARGE of the area of all faces that reflect. */
double large_area(const struct problem *p, const struct hierarchy *h);

/* Sums over the rows of all ranks. */
static inline void polygon_rows_sum(const struct polygon_rows *rows, double *sum, size_t count)
{
    if (rows->ranks)
        ranks_add(rows->ranks, RANKS_PARTICLES, sum, count);
}

#endif
