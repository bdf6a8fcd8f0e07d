/* body_contacts.c - see body_contacts.h.
 *
 * A face of a gear, a washer or a bracket covers what it lies on as that of a box does, but planes
 * do not tell what is in such a solid. That two faces are one on the other is found pair by pair,
 * from those of no convex solid. Invariant: a pair is listed once.
 * [derived here]
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include "hierarchy/body_contacts.h"
#include "hierarchy/body_rest.h"
#include "hierarchy/lids.h"
#include "util/array.h"

/* What an element has in common with a lid: its area, and the middle of its corners. */
static double common(const struct lid *lid, const struct element *e, double middle[3])
{
    double part[LID_COMMON][3], normal[3];
    const int count = lid_common(lid, (const double(*)[3])e->vertex, e->vertices, part);
    if (count < 3)
        return 0;
    for (int k = 0; k < 3; k++) {
        middle[k] = 0;
        for (int i = 0; i < count; i++)
            middle[k] += part[i][k] / count;
    }
    return polygon_normal(part, (uint32_t)count, normal);
}

/* Of a face with what is below an element. */
static int find_on(struct body_contacts *all, const struct bodies *b, const struct hierarchy *h,
                   uint32_t index, uint32_t face, const struct shell_lid *own)
{
    const struct element *e = &h->elements[index];
    struct body_contact next = {.face = {face, index}};
    struct lid under;
    if (!body_rest_near(h, e, own) || (e->vertices && !(dot3(e->normal, own->normal) < 0)))
        return 0;
    for (uint32_t c = 0; c < e->children; c++)
        if (find_on(all, b, h, e->child + c, face, own) < 0)
            return -1;
    if (e->children || (!b->whose[index] && !h->faces[e->face].back && index < face)
        || face_other_side(h->faces, h->face_count, e->face) == h->elements[face].face)
        return 0;
    lid_of(&under, (const double(*)[3])own->corner, (uint32_t)own->n, own->normal, h->flat);
    if (lid_place(&under, (const double(*)[3])e->vertex, e->vertices) == BESIDE)
        return 0;
    next.area = common(&under, e, next.middle);
    if (!(next.area > 0))
        return 0;
    if (array_reserve(&all->list, all->count + 1, &all->room, sizeof *all->list) < 0)
        return -1;
    all->list[all->count++] = next;
    return 0;
}

int body_contacts_find(struct body_contacts *all, const struct bodies *b, const struct hierarchy *h)
{
    for (size_t i = 0; i < b->loose_count; i++) {
        const struct element *e = &h->elements[b->loose[i]];
        struct shell_lid own;
        if (b->whose[b->loose[i]])
            continue;
        shell_lid_of(&own, e);
        if (find_on(all, b, h, 0, b->loose[i], &own) < 0)
            return -1;
    }
    return 0;
}
