/* polygon_rows.c - see polygon_rows.h.
 * SPDX-License-Identifier: MIT */
#include "engine/polygon_rows.h"
#include <stdlib.h>
#include "kernel/constants.h"
#include "util/thread_pool.h"

/* Who has the polygons' first faces, and which have others of other ranks: first[polygon], the rank
 * + 1; parted[polygon]. */
static void find_owners(const struct hierarchy *h, const uint16_t *owner, uint32_t *first,
                        unsigned char *parted)
{
    for (uint32_t f = 0; f < h->face_count; f++) {
        const uint32_t p = h->faces[f].input;
        if (!first[p])
            first[p] = owner[f] + 1u;
        parted[p] |= first[p] != owner[f] + 1u;
    }
}

int polygon_rows_open(struct polygon_rows *rows, const struct problem *p, const struct hierarchy *h,
                      const struct tally *tally)
{
    const uint32_t polygons = p->scene->input_count;
    *rows = (struct polygon_rows){.count = polygons};
    if (!tally->quarters)
        return 0;
    rows->ranks = p->options.ranks;
    rows->row = calloc((size_t)polygons + 1, sizeof *rows->row);
    rows->polygon = malloc(((size_t)polygons + 1) * sizeof *rows->polygon);
    rows->several = malloc(((size_t)polygons + 1) * sizeof *rows->several);
    unsigned char *parted = calloc((size_t)polygons + 1, 1);
    const int failed =
        ranks_any(rows->ranks, !rows->row || !rows->polygon || !rows->several || !parted);
    if (!failed) {
        const uint32_t me = (uint32_t)ranks_number(rows->ranks) + 1;
        find_owners(h, tally->owner, rows->row, parted);
        rows->count = 0;
        for (uint32_t i = 0; i < polygons; i++) {
            const int mine = rows->row[i] == me;
            rows->row[i] = mine ? rows->count : NO_ROW;
            if (mine)
                rows->polygon[rows->count++] = i;
            if (parted[i])
                rows->several[rows->several_count++] = i;
        }
    }
    free(parted);
    return failed ? -1 : 0;
}

void polygon_rows_close(struct polygon_rows *rows)
{
    free(rows->row);
    free(rows->polygon);
    free(rows->several);
    *rows = (struct polygon_rows){0};
}

struct adding {
    const struct polygon_rows *rows;
    const struct problem *p;
    const struct hierarchy *h;
    const struct tally *tally;
    const uint32_t *place; /* [polygon]: of those of several ranks, + 1; NULL: there are none */
    double *value, *several;
};

/* Where a face adds to of a replicate: its polygon's row, or its place among those of several. */
static double *sums_of(const struct adding *x, size_t replicate, uint32_t face)
{
    const uint32_t polygon = x->h->faces[face].input, place = x->place ? x->place[polygon] : 0,
                   bands = x->tally->bands;
    if (place)
        return &x->several[(replicate * x->rows->several_count + place - 1) * bands];
    return &x->value[(replicate * x->rows->count + polygon_row(x->rows, polygon)) * bands];
}

static void add_replicates(const void *adding, size_t from, size_t to)
{
    const struct adding *x = adding;
    const uint32_t bands = x->tally->bands;
    for (size_t r = from; r < to; r++)
        for (uint32_t f = 0; f < x->h->face_count; f++) {
            if (!tally_holds(x->tally, f))
                continue;
            double *sum = sums_of(x, r, f);
            for (uint32_t k = 0; k < bands; k++)
                sum[k] +=
                    x->p->reflectance[(size_t)f * bands + k] * tally_face(x->tally, (int)r, f, k);
        }
}

/* What all ranks have of those of several, to the row of each that is here. */
static void take_several(const struct adding *x)
{
    const struct polygon_rows *rows = x->rows;
    const size_t bands = x->tally->bands;
    ranks_add(rows->ranks, RANKS_PARTICLES, x->several, REPLICATES * rows->several_count * bands);
    for (size_t r = 0; r < REPLICATES; r++)
        for (size_t i = 0; i < rows->several_count; i++) {
            const uint32_t row = rows->row[rows->several[i]];
            for (size_t k = 0; k < bands && row != NO_ROW; k++)
                x->value[(r * rows->count + row) * bands + k] =
                    x->several[(r * rows->several_count + i) * bands + k];
        }
}

int polygon_rows_add(const struct polygon_rows *rows, const struct problem *p,
                     const struct hierarchy *h, const struct tally *tally, double *value)
{
    const size_t bands = tally->bands;
    uint32_t *place = NULL;
    double *several = NULL;
    if (rows->several_count) {
        place = calloc((size_t)p->scene->input_count + 1, sizeof *place);
        several = calloc(REPLICATES * rows->several_count * bands, sizeof *several);
        if (ranks_any(rows->ranks, !place || !several)) {
            free(place);
            free(several);
            return -1;
        }
        for (uint32_t i = 0; i < rows->several_count; i++)
            place[rows->several[i]] = i + 1;
    }
    const struct adding x = {rows, p, h, tally, place, value, several};
    thread_pool_run(p->options.threads, REPLICATES, 1, add_replicates, &x);
    if (several)
        take_several(&x);
    free(place);
    free(several);
    return 0;
}

double *polygon_areas(const struct problem *p, const struct hierarchy *h)
{
    double *areas = calloc((size_t)p->scene->input_count + 1, sizeof *areas);
    for (uint32_t i = 0; i < h->face_count && areas; i++)
        areas[h->faces[i].input] += hierarchy_surface(h, i)->area;
    return areas;
}

double large_area(const struct problem *p, const struct hierarchy *h)
{
    double area = 0;
    for (uint32_t i = 0; i < h->face_count; i++)
        area += p->whitest[i] > 0 ? hierarchy_surface(h, i)->area : 0;
    return FACE_ERROR_LARGE * area;
}
