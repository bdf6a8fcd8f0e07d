/* body_rim.c - see body_rim.h.
 *
 * Edges need not be equal (across.h). Who is across an edge in front of the face is a wall that
 * stands on it; who is in its plane and looks the other way is its own other side. Half of the rim
 * is asked for, as solids may lack a side, or have one that is not known. [derived here]
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "hierarchy/across.h"
#include "hierarchy/body_rim.h"
#include "hierarchy/reach.h"
#include "util/array.h"

enum { AT_HAND = 1, GOES_BACK_NOT, GOES_BACK };

static const double MOST = 0.5; /* of the rim; chosen */

/* While faces of one plane follow each other. */
struct plane {
    struct body_rim *rim;
    const struct hierarchy *h;
    uint32_t count;
    double length, back; /* of the rim, and where something goes back (m) */
};

static int add(struct plane *p, uint32_t face)
{
    struct body_rim *rim = p->rim;
    if (array_reserve(&rim->list, (size_t)p->count + 1, &rim->room, sizeof *rim->list) < 0)
        return -1;
    rim->list[p->count++] = face;
    rim->known[face] = AT_HAND;
    return 0;
}

/* A stretch of a face's edge: there it goes on in its plane, or ends. Returns 0, or -1 when out of
 * memory. */
static int look_across(struct plane *p, const struct element *e, const struct across *stretch)
{
    double high = 0, low = 0, along[3];
    if (stretch->face != ACROSS_NOBODY) {
        const struct element *next = &p->h->elements[stretch->face];
        element_reach(e, next, &high, &low);
        if (high <= p->h->flat && low >= -p->h->flat && dot3(e->normal, next->normal) > 0)
            return p->rim->known[stretch->face] ? 0 : add(p, stretch->face);
    }
    sub3(along, stretch->to, stretch->from);
    p->length += length3(along);
    p->back += high <= p->h->flat && low < -p->h->flat ? length3(along) : 0;
    return 0;
}

int body_rim_goes_back(struct body_rim *rim, const struct hierarchy *h, uint32_t face)
{
    struct plane p = {rim, h, 0, 0, 0};
    struct across list[ACROSS_STRETCHES];
    if (rim->known[face])
        return rim->known[face] == GOES_BACK;
    if (add(&p, face) < 0)
        return -1;
    for (uint32_t at = 0; at < p.count; at++) {
        const struct element *e = &h->elements[rim->list[at]];
        for (int side = 0; side < e->vertices; side++) {
            const int count = across_edge(h, rim->list[at], side, list);
            for (int i = 0; i < count; i++)
                if (look_across(&p, e, &list[i]) < 0)
                    return -1;
        }
    }
    const int back = p.back >= MOST * p.length;
    for (uint32_t i = 0; i < p.count; i++)
        rim->known[rim->list[i]] = back ? GOES_BACK : GOES_BACK_NOT;
    return back;
}

int body_rim_open(struct body_rim *rim, const struct hierarchy *h)
{
    memset(rim, 0, sizeof *rim);
    rim->known = calloc((size_t)h->built + 1, sizeof *rim->known);
    return rim->known ? 0 : -1;
}

void body_rim_close(struct body_rim *rim)
{
    free(rim->known);
    free(rim->list);
    memset(rim, 0, sizeof *rim);
}
