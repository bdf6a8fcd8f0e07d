/* places.c - which corners are one place, though rounding sets them apart.
 *
 * On a grid two corners that all but coincide fall in two cells where a line of the grid happens to
 * pass between them, however coarse it is. So corners are parted where there is room: sorted along
 * an axis and cut at its gaps, each part along the next axis, until none of three axes parts it.
 *
 * Invariant: corners of one place lie together in the list, and places are numbered in its order,
 * which does not depend on the order of corners before.
 * SPDX-License-Identifier: MIT */
#include "hierarchy/places.h"

#include <stdlib.h>

struct parting {
    struct corner *corners;
    uint32_t *place, count;
    double apart;
};

static int compare_along(const struct corner *a, const struct corner *b, int axis)
{
    return (a->at[axis] > b->at[axis]) - (a->at[axis] < b->at[axis]);
}

static int compare_x(const void *a, const void *b)
{
    return compare_along(a, b, 0);
}

static int compare_y(const void *a, const void *b)
{
    return compare_along(a, b, 1);
}

static int compare_z(const void *a, const void *b)
{
    return compare_along(a, b, 2);
}

/* Corners from..to, which as many axes before this one did not part. */
static void part(struct parting *p, size_t from, size_t to, int axis, int whole)
{
    static int (*const compare[3])(const void *, const void *) = {compare_x, compare_y, compare_z};
    struct corner *c = p->corners;
    if (whole == 3 || to - from == 1) {
        for (size_t i = from; i < to; i++)
            p->place[c[i].index] = p->count;
        p->count++;
        return;
    }
    qsort(&c[from], to - from, sizeof *c, compare[axis]);
    for (size_t first = from, i = from + 1; i <= to; i++)
        if (i == to || c[i].at[axis] - c[i - 1].at[axis] > p->apart) {
            const int all = first == from && i == to;
            part(p, first, i, (axis + 1) % 3, all ? whole + 1 : 1);
            first = i;
        }
}

void places_find(struct corner *corners, size_t count, double apart, uint32_t *place)
{
    struct parting p = {corners, place, 0, apart};
    if (count)
        part(&p, 0, count, 0, 0);
}
