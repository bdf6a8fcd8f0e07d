/* factor_table.h - the matrix of view factors as rows with names and areas: of faces, or of parts,
 * which are sums over their faces.
 *
 * F_GH = sum of A_i F_ij over i in G and j in H, divided by A_G: the share of what leaves G evenly
 * that meets H, G itself included. So A_G F_GH = A_H F_HG as far as that holds for faces. A face's
 * area is that of all its sides. Two columns may follow, the shares that go to the sky and to black
 * backs. What writes files knows of nothing but this.
 * SPDX-License-Identifier: MIT */
#ifndef FACTOR_TABLE_H
#define FACTOR_TABLE_H

#include <stddef.h>
#include "output/solution.h"

/* Which face is of which part; those without a face are left out. */
struct factor_parts {
    const uint32_t *of; /* [polygon] */
    char *const *names; /* [count] */
    uint32_t count;
};

struct factor_table {
    RadExchange exchange;
    uint32_t all, polygons; /* columns of the exchange; those that are no copies (util/fold.h) */
    uint32_t count;         /* rows of this */
    uint32_t columns;       /* count, or with sky and backs 2 more */
    char *title;            /* the scene's name, without folder and ending */
    char **names;           /* [count], without control characters */
    double *areas;          /* [count], m2, of all sides that emit */
    double *emissivities;   /* [count]: 1 - reflectance, mean over bands and area */
    /* Of parts; `of` NULL: rows are faces. */
    uint32_t *of;              /* [polygons] */
    uint32_t *first, *members; /* faces of row r: members[first[r]] to before first[r + 1] */
    double *weights;           /* [polygons]: areas of faces */
};

/* `all`: columns of the exchange, copies of the surfaces and all. `losses`: with these two columns.
 * `path`: of the scene's file. `parts` NULL: a row per face, called MATERIAL.NUMBER. Returns 0, or
 * -1 when out of memory; to be closed in either case. */
int factor_table_open(struct factor_table *table, RadExchange exchange, uint32_t all,
                      const char *path, const struct surfaces *surfaces,
                      const struct factor_parts *parts, int losses);
void factor_table_close(struct factor_table *table);

/* Rows as many threads ask for them, each of which has a room of its own. */
struct factor_reading {
    const struct factor_table *table;
    size_t size;   /* of a room, numbers */
    double *rooms; /* [threads][size] */
};

/* Returns 0, or -1 when out of memory; to be closed in either case. */
int factor_reading_open(struct factor_reading *rows, const struct factor_table *table, int threads);
void factor_reading_close(struct factor_reading *rows);

/* Row r, [columns], until the same thread of the pool asks for another. */
const double *factor_reading_row(const struct factor_reading *rows, uint32_t r);

/* How many entries of a row are not 0. */
uint32_t factor_row_entries(const struct factor_table *table, const double *row);

#endif
