/* factor_table.c - see factor_table.h.
 *
 * A part's row is summed by one thread, over its faces in the file's order, so that sums do not
 * depend on how many threads there are.
 * SPDX-License-Identifier: MIT */
#include "output/factor_table.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "util/beside.h"
#include "util/fold.h"
#include "util/thread_pool.h"

#define NONE UINT32_MAX /* a part without a face */

static void to_one_line(char *name)
{
    for (; *name; name++)
        if ((unsigned char)*name < ' ')
            *name = ' ';
}

/* For free(); `number` UINT32_MAX: none. NULL when out of memory. */
static char *name_of(const char *name, uint32_t number)
{
    const size_t size = strlen(name) + 12;
    char *text = malloc(size);
    if (!text)
        return NULL;
    snprintf(text, size, number < UINT32_MAX ? "%s.%lu" : "%s", name, (unsigned long)number);
    to_one_line(text);
    return text;
}

/* What emits: both sides of a face that has two. */
static double weight_of(const struct surfaces *s, uint32_t polygon)
{
    const struct RadMaterial *m = &s->materials[s->polygon_materials[polygon]];
    return s->polygon_areas[polygon] * (m->two_sided ? 2 : 1);
}

static double emissivity_of(const struct surfaces *s, uint32_t polygon)
{
    const double *rho = s->materials[s->polygon_materials[polygon]].reflectance;
    return 1 - (rho[0] + rho[1] + rho[2]) / 3;
}

static int open_faces(struct factor_table *t, const struct surfaces *s)
{
    for (uint32_t i = 0; i < t->count; i++) {
        t->names[i] = name_of(s->material_names[s->polygon_materials[i]], i);
        if (!t->names[i])
            return -1;
        t->areas[i] = weight_of(s, i);
        t->emissivities[i] = emissivity_of(s, i);
    }
    return 0;
}

/* Rows of parts that have faces, in the order of parts: row[part], or NONE. Returns how many. */
static uint32_t number_parts(const struct factor_parts *parts, uint32_t polygons, uint32_t *row)
{
    uint32_t count = 0;
    memset(row, 0xff, parts->count * sizeof *row); /* NONE */
    for (uint32_t i = 0; i < polygons; i++)
        row[parts->of[i]] = 0;
    for (uint32_t p = 0; p < parts->count; p++)
        if (row[p] != NONE)
            row[p] = count++;
    return count;
}

static int open_parts(struct factor_table *t, const struct surfaces *s,
                      const struct factor_parts *parts, const uint32_t *row)
{
    t->of = malloc(((size_t)t->polygons + 1) * sizeof *t->of);
    t->members = malloc(((size_t)t->polygons + 1) * sizeof *t->members);
    t->weights = malloc(((size_t)t->polygons + 1) * sizeof *t->weights);
    t->first = calloc((size_t)t->count + 2, sizeof *t->first);
    if (!t->of || !t->members || !t->weights || !t->first)
        return -1;
    for (uint32_t p = 0; p < parts->count; p++)
        if (row[p] != NONE && !(t->names[row[p]] = name_of(parts->names[p], UINT32_MAX)))
            return -1;
    for (uint32_t i = 0; i < t->polygons; i++) {
        const uint32_t r = t->of[i] = row[parts->of[i]];
        t->weights[i] = weight_of(s, i);
        t->areas[r] += t->weights[i];
        t->emissivities[r] += t->weights[i] * emissivity_of(s, i);
        t->first[r + 2]++;
    }
    for (uint32_t r = 0; r < t->count; r++) {
        t->emissivities[r] = t->areas[r] > 0 ? t->emissivities[r] / t->areas[r] : 1;
        t->first[r + 2] += t->first[r + 1];
    }
    for (uint32_t i = 0; i < t->polygons; i++) /* first[r + 1] runs from first to last of r */
        t->members[t->first[t->of[i] + 1]++] = i;
    return 0;
}

/* NULL when out of memory. */
static char *title_of(const char *path)
{
    const char *name = path_name(path);
    char *title = strndup(name, path_stem(name));
    if (title)
        to_one_line(title);
    return title;
}

int factor_table_open(struct factor_table *t, RadExchange exchange, uint32_t all, const char *path,
                      const struct surfaces *s, const struct factor_parts *parts, int losses)
{
    uint32_t *row = parts ? malloc(((size_t)parts->count + 1) * sizeof *row) : NULL;
    *t = (struct factor_table){.exchange = exchange, .all = all, .polygons = s->polygon_count};
    if (parts && !row)
        return -1;
    t->count = parts ? number_parts(parts, t->polygons, row) : t->polygons;
    t->columns = t->count + (losses ? 2 : 0);
    t->title = title_of(path);
    t->names = calloc((size_t)t->count + 1, sizeof *t->names);
    t->areas = calloc((size_t)t->count + 1, sizeof *t->areas);
    t->emissivities = calloc((size_t)t->count + 1, sizeof *t->emissivities);
    int status = !t->title || !t->names || !t->areas || !t->emissivities ? -1
                 : parts ? open_parts(t, s, parts, row)
                         : open_faces(t, s);
    free(row);
    return status;
}

void factor_table_close(struct factor_table *t)
{
    for (uint32_t r = 0; t->names && r < t->count; r++)
        free(t->names[r]);
    free(t->title);
    free(t->names);
    free(t->areas);
    free(t->emissivities);
    free(t->of);
    free(t->first);
    free(t->members);
    free(t->weights);
    *t = (struct factor_table){0};
}

int factor_reading_open(struct factor_reading *rows, const struct factor_table *t, int threads)
{
    *rows =
        (struct factor_reading){.table = t, .size = (size_t)t->all + 2 + (t->of ? t->columns : 0)};
    rows->rooms = malloc((size_t)threads * rows->size * sizeof *rows->rooms);
    return rows->rooms ? 0 : -1;
}

void factor_reading_close(struct factor_reading *rows)
{
    free(rows->rooms);
}

/* Row i of the exchange, and what it loses behind it. */
static void face_row(const struct factor_table *t, uint32_t i, double *row)
{
    struct RadExchangeLoss loss = {0};
    (void)radGetExchangeRow(t->exchange, i, row);
    fold_row(row, t->all, t->polygons);
    if (t->columns > t->count)
        (void)radGetExchangeLoss(t->exchange, i, &loss);
    row[t->polygons] = loss.sky;
    row[t->polygons + 1] = loss.backs;
}

const double *factor_reading_row(const struct factor_reading *rows, uint32_t r)
{
    const struct factor_table *t = rows->table;
    double *room = &rows->rooms[(size_t)thread_pool_number() * rows->size];
    if (!t->of) {
        face_row(t, r, room);
        return room;
    }
    double *sums = room + t->all + 2;
    memset(sums, 0, t->columns * sizeof *sums);
    for (uint32_t k = t->first[r]; k < t->first[r + 1]; k++) {
        const uint32_t i = t->members[k];
        if (!(t->weights[i] > 0))
            continue;
        face_row(t, i, room);
        for (uint32_t j = 0; j < t->polygons; j++)
            sums[t->of[j]] += t->weights[i] * room[j];
        for (uint32_t e = t->count; e < t->columns; e++)
            sums[e] += t->weights[i] * room[t->polygons + e - t->count];
    }
    for (uint32_t h = 0; h < t->columns; h++)
        sums[h] = t->areas[r] > 0 ? sums[h] / t->areas[r] : 0;
    return sums;
}

uint32_t factor_row_entries(const struct factor_table *t, const double *row)
{
    uint32_t count = 0;
    for (uint32_t j = 0; j < t->columns; j++)
        count += row[j] > 0;
    return count;
}
