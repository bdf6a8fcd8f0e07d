/* quarter_light.c - see quarter_light.h.
 *
 * Few paths ask, but of any quarter. Whole elements would be 264 bytes each, with values that
 * nobody asks for; what a path wants is 104 of three bands: radiosity and its slope, and what falls
 * there. Where a leaf is and how large it is follows from the quarters on the way down to it.
 *
 * A leaf that all have got its quarters, and their numbers, at one go, leaf by leaf in order. So
 * one rank's are told in the order of its leaves, and of a leaf in the order of numbers.
 * SPDX-License-Identifier: MIT */
#include "engine/quarter_light.h"
#include <stdlib.h>
#include <string.h>
#include "engine/own_quarters.h"
#include "kernel/leaf_at.h"
#include "kernel/surface.h"

double mended_irradiance(const struct solve *s, uint32_t element)
{
    double sum = 0;
    for (uint32_t k = 0; k < s->problem.bands; k++)
        sum += s->mended.irradiance[(size_t)element * s->problem.bands + k];
    return sum;
}

/* What is told of each: its irradiance, radiosity, and the slope of that, if it has one. */
static void put(const struct quarter_light *q, uint32_t element, double *to)
{
    const size_t bands = q->light.bands;
    to[0] = mended_irradiance(q->solve, element);
    memcpy(to + 1, &q->light.mean[element * bands], bands * sizeof *to);
    if (q->light.gradient)
        memcpy(to + 1 + bands, &q->light.gradient[3 * element * bands], 3 * bands * sizeof *to);
}

int quarter_light_open(struct quarter_light *q, const struct solve *s)
{
    *q = (struct quarter_light){.solve = s, .light = element_light_shown(s)};
    if (!own_quarters(s))
        return 0;
    struct ranks *ranks = s->problem.options.ranks;
    const size_t count = (size_t)ranks_count(ranks), me = (size_t)ranks_number(ranks),
                 own = s->hierarchy.count - s->quarters.common;
    q->first = malloc((count + 1) * sizeof *q->first);
    int failed = ranks_any(ranks, !q->first);
    q->width = 1 + q->light.bands * (q->light.gradient ? 4 : 1);
    if (!failed) {
        ranks_starts(ranks, RANKS_VALUES, own, q->first);
        q->told = malloc((q->first[count] + 1) * q->width * sizeof *q->told);
        failed = ranks_any(ranks, !q->told);
    }
    if (!failed) {
        for (size_t i = 0; i < own; i++)
            put(q, s->quarters.common + (uint32_t)i, &q->told[(q->first[me] + i) * q->width]);
        ranks_complete(ranks, RANKS_VALUES, q->told, q->width * sizeof *q->told, q->first);
    }
    return failed ? -1 : 0;
}

void quarter_light_close(struct quarter_light *q)
{
    free(q->told);
    free(q->first);
    *q = (struct quarter_light){0};
}

static struct leaf_light of_element(const struct quarter_light *q, uint32_t leaf,
                                    const double point[3])
{
    struct leaf_light l = {
        q->light.elements[leaf].area, mended_irradiance(q->solve, leaf), {0, 0, 0}};
    for (uint32_t k = 0; k < q->light.bands; k++)
        l.radiosity[k] = element_light_at(&q->light, leaf, k, point);
    return l;
}

/* From a leaf that all have on, down to a quarter of another rank's. */
static struct leaf_light of_told(const struct quarter_light *q, struct leaf_walk walk,
                                 const double point[3])
{
    const uint32_t *child = q->solve->quarters.child, leaf = walk.at;
    struct element e = q->light.elements[leaf], part;
    while (child[walk.at]) {
        const uint32_t first = child[walk.at];
        leaf_walk_down(&walk, first);
        surface_quarter(&e, (int)(walk.at - first), &part);
        e = part;
    }
    const struct solve *s = q->solve;
    const uint32_t at = quarters_at_owner(&s->quarters, leaf, walk.at) - s->quarters.common;
    const double *told =
        &q->told[(q->first[shares_owner(&s->operator.shares, leaf)] + at) * q->width];
    const struct element_light light = {&e, q->light.bands, told + 1,
                                        q->light.gradient ? told + 1 + q->light.bands : NULL};
    struct leaf_light l = {e.area, told[0], {0, 0, 0}};
    for (uint32_t k = 0; k < light.bands; k++)
        l.radiosity[k] = element_light_at(&light, 0, k, point);
    return l;
}

struct leaf_light quarter_light_at(const struct quarter_light *q, uint32_t face,
                                   const double point[3])
{
    const struct hierarchy *h = &q->solve->hierarchy;
    struct leaf_walk walk = leaf_walk_from(h->elements, h->face_element[face], point);
    while (h->elements[walk.at].children)
        leaf_walk_down(&walk, h->elements[walk.at].child);
    return q->told && walk.at < q->solve->quarters.common && q->solve->quarters.child[walk.at]
               ? of_told(q, walk, point)
               : of_element(q, walk.at, point);
}
