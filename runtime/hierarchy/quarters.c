/* quarters.c - see quarters.h.
 *
 * What becomes of a leaf of another rank is worked out by the same splits in the same order, and
 * forgotten but for the numbers.
 * SPDX-License-Identifier: MIT */
#include "hierarchy/quarters.h"
#include <stdlib.h>
#include "kernel/surface.h"
#include "util/array.h"

int quarters_open(struct quarters *q, const struct hierarchy *h)
{
    *q = (struct quarters){.common = h->count, .count = h->count};
    if (array_reserve(&q->child, h->count, &q->child_capacity, sizeof *q->child) < 0)
        return -1;
    for (uint32_t i = 0; i < h->count; i++)
        q->child[i] = h->elements[i].children ? h->elements[i].child : 0;
    return 0;
}

void quarters_close(struct quarters *q)
{
    free(q->child);
    free(q->number);
    free(q->place);
    *q = (struct quarters){0};
}

/* Numbers for the four parts of `number`. Returns 0, or -1 when out of memory. */
static int number_parts(struct quarters *q, uint32_t number)
{
    if (q->count > UINT32_MAX - 4
        || array_reserve(&q->child, (size_t)q->count + 4, &q->child_capacity, sizeof *q->child) < 0)
        return -1;
    q->child[number] = q->count;
    for (int c = 0; c < 4; c++)
        q->child[q->count++] = 0;
    return 0;
}

/* e: what is split, a copy; here: its index where it is this rank's, or 0. */
static int split(struct quarters *q, struct hierarchy *h, const struct element *e, uint32_t number,
                 uint32_t here, double parts)
{
    if (parts <= 1 || e->depth == UINT8_MAX)
        return 0;
    if (number_parts(q, number) < 0)
        return -1;
    const uint32_t child = q->child[number];
    uint32_t first = 0;
    if (here) {
        const size_t own = h->count - q->common;
        if (array_reserve(&q->number, own + 4, &q->number_capacity, sizeof *q->number) < 0
            || hierarchy_split(h, here) < 0)
            return -1;
        first = h->elements[here].child;
        for (uint32_t c = 0; c < 4; c++)
            q->number[own + c] = child + c;
    }
    for (uint32_t c = 0; c < 4; c++) {
        struct element part;
        if (here) {
            part = h->elements[first + c];
        } else {
            surface_quarter(e, (int)c, &part);
            part.depth = (uint8_t)(e->depth + 1);
        }
        if (split(q, h, &part, child + c, here ? first + c : 0, parts * part.area / e->area) < 0)
            return -1;
    }
    return 0;
}

int quarters_split(struct quarters *q, struct hierarchy *h, uint32_t leaf, double parts, int mine)
{
    const struct element e = h->elements[leaf];
    return split(q, h, &e, leaf, mine ? leaf : 0, parts);
}

int quarters_place(struct quarters *q, const struct hierarchy *h, const uint16_t *owner,
                   size_t ranks)
{
    uint32_t *made = calloc(ranks, sizeof *made), last = q->common;
    q->place = malloc(q->common * sizeof *q->place);
    for (uint32_t i = 0; i < q->common && made && q->place; i++) {
        if (q->child[i] < q->common)
            continue;
        if (last < q->common) /* its numbers end where the next leaf's begin */
            made[owner[h->elements[last].face]] += q->child[i] - q->child[last];
        q->place[i] = made[owner[h->elements[i].face]];
        last = i;
    }
    const int failed = !made || !q->place;
    free(made);
    return failed ? -1 : 0;
}
