/* dim_list.c - see dim_list.h.
 * SPDX-License-Identifier: MIT */
#include "engine/dim_list.h"

#include <stdlib.h>

#include "engine/dim_parts.h"
#include "engine/polygon_rows.h"

/* A polygon or a part, and what of it reflects and is not covered by what stands on it (m2), a dark
 * side with a lit one: a face is as large as both its sides, wherever that is asked. */
struct candidate {
    uint32_t part;
    double area;
};

static int by_area(const void *a, const void *b)
{
    const struct candidate *x = a, *y = b;
    return x->area != y->area ? (x->area < y->area ? 1 : -1)
                              : (x->part > y->part) - (x->part < y->part);
}

/* In which bands there is light at all. */
static void find_lit(struct dim_faces *d)
{
    const struct tracer *t = d->tracer;
    for (uint32_t i = 0; i < t->hierarchy->face_count; i++)
        for (uint32_t k = 0; k < t->bands; k++)
            d->lit[k] |= t->exitance[(size_t)i * t->bands + k] > 0;
}

int dim_list_reflects(const struct dim_faces *d, uint32_t face)
{
    const struct tracer *t = d->tracer;
    int any = 0;
    for (uint32_t k = 0; k < t->bands; k++)
        any |= d->lit[k] && t->reflectance[(size_t)face * t->bands + k] > 0;
    return any && tracer_reflectance(t, face) > 0;
}

static double open_area(const struct dim_faces *d, uint32_t face)
{
    const struct tracer *t = d->tracer;
    const double uncovered = d->solve->operator.uncovered[t->hierarchy->face_element[face]];
    return dim_list_reflects(d, face) ? uncovered * tracer_surface(t, face)->area : 0;
}

/* [parts]: the area of each candidate (m2), 0 where nothing is lit; the caller's. NULL when out of
 * memory. */
static double *part_areas(const struct dim_faces *d)
{
    const struct hierarchy *h = d->tracer->hierarchy;
    double *area = calloc((size_t)d->parts + 1, sizeof *area);
    for (uint32_t i = 0; i < h->face_count && area; i++)
        area[d->part[i]] += open_area(d, i);
    for (uint32_t i = 0; i < h->face_count && area; i++)
        if (h->faces[i].light == FACE_DARK && d->solve->problem.whitest[i] > 0
            && area[d->part[i]] > 0)
            area[d->part[i]] += tracer_surface(d->tracer, i)->area;
    return area;
}

/* What is looked at together: polygons; or, where groups are asked, what small ones are gathered
 * in. Returns 0, or -1 when out of memory. */
static int find_parts(struct dim_faces *d)
{
    const struct hierarchy *h = d->tracer->hierarchy;
    d->parts = d->solve->problem.scene->input_count;
    d->large = large_area(&d->solve->problem, h);
    d->part = malloc(((size_t)h->face_count + 1) * sizeof *d->part);
    for (uint32_t i = 0; i < h->face_count && d->part; i++)
        d->part[i] = h->faces[i].input;
    if (!d->part || d->size != DIM_GROUPS)
        return d->part ? 0 : -1;
    double *area = part_areas(d);
    const int status = area ? dim_parts_find(d->tracer, area, d->large, d->part, &d->parts) : -1;
    free(area);
    return status;
}

/* Is it one to look at? */
static int is_asked(const struct dim_faces *d, const struct candidate *c)
{
    const enum dim_size size = !(c->area > d->large)                            ? DIM_SMALL_ONES
                               : c->part < d->solve->problem.scene->input_count ? DIM_LARGE_ONES
                                                                                : DIM_GROUPS;
    return c->area > 0 && size == d->size;
}

/* Those to look at; no more than `most` of them, the largest ones, may be asked. Returns 0, or -1
 * when out of memory. */
static int list_polygons(struct dim_faces *d, uint32_t most)
{
    const struct hierarchy *h = d->tracer->hierarchy;
    uint32_t asked = 0;
    double *area = part_areas(d);
    struct candidate *all = malloc(((size_t)d->parts + 1) * sizeof *all);
    d->of = malloc(((size_t)d->parts + 1) * sizeof *d->of);
    d->face = malloc(((size_t)h->face_count + 1) * sizeof *d->face);
    d->until = malloc(((size_t)h->face_count + 1) * sizeof *d->until);
    int failed = !area || !all || !d->of || !d->face || !d->until;
    for (uint32_t p = 0; p < d->parts && !failed; p++) {
        const struct candidate c = {p, area[p]};
        if (is_asked(d, &c))
            all[asked++] = c;
        d->of[p] = NOT_DIM;
    }
    if (!failed && asked > most)
        qsort(all, asked, sizeof *all, by_area);
    for (uint32_t i = 0; i < asked; i++)
        d->of[all[i].part] = 0;
    for (uint32_t p = 0; p < d->parts && !failed; p++)
        if (d->of[p] != NOT_DIM)
            d->of[p] = d->count++;
    d->polygon = failed ? NULL : calloc((size_t)d->count + 1, sizeof *d->polygon);
    for (uint32_t i = 0; i < asked && i < most && d->polygon; i++)
        d->polygon[d->of[all[i].part]].asked = 1;
    free(all);
    free(area);
    return d->polygon ? 0 : -1;
}

/* The faces of each, beside each other. */
static void list_faces(struct dim_faces *d)
{
    const struct tracer *t = d->tracer;
    const struct hierarchy *h = t->hierarchy;
    uint32_t next = 0;
    for (uint32_t i = 0; i < h->face_count; i++)
        if (dim_list_reflects(d, i) && d->of[d->part[i]] != NOT_DIM)
            d->polygon[d->of[d->part[i]]].to++;
    for (uint32_t j = 0; j < d->count; j++) {
        struct dim_polygon *p = &d->polygon[j];
        p->from = next;
        next += p->to;
        p->to = p->from;
    }
    for (uint32_t i = 0; i < h->face_count; i++)
        if (dim_list_reflects(d, i) && d->of[d->part[i]] != NOT_DIM) {
            struct dim_polygon *p = &d->polygon[d->of[d->part[i]]];
            p->area += tracer_surface(t, i)->area;
            d->until[p->to] = p->area;
            d->face[p->to++] = i;
        }
}

int dim_list_open(struct dim_faces *d, uint32_t most)
{
    find_lit(d);
    if (ranks_any(d->tracer->ranks, find_parts(d) < 0 || list_polygons(d, most) < 0))
        return -1;
    list_faces(d);
    return 0;
}

void dim_list_close(struct dim_faces *d)
{
    free(d->part);
    free(d->of);
    free(d->polygon);
    free(d->face);
    free(d->until);
}
