/* body_lining.c - see body_lining.h.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "hierarchy/across.h"
#include "hierarchy/body_lining.h"
#include "hierarchy/reach.h"
#include "util/array.h"

/* Is all of an element in the solid, or on its surface? */
static int is_within(const struct shell *s, const struct element *e)
{
    for (int side = 0; side < s->sides + s->lids; side++) {
        const struct element *f = side < s->sides ? &s->h->elements[s->side[side]] : NULL;
        const struct shell_lid *lid = f ? NULL : &s->lid[side - s->sides];
        double high = 0, low = 0;
        polygon_reach((const double(*)[3])e->vertex, e->vertices, f ? f->vertex[0] : lid->corner[0],
                      f ? f->normal : lid->normal, &high, &low);
        if (high > s->h->flat)
            return 0;
    }
    return 1;
}

/* Are two faces that follow each other not in one plane? */
static int bends(const struct hierarchy *h, const struct element *e, const struct element *next)
{
    double high = 0, low = 0;
    element_reach(e, next, &high, &low);
    return high > h->flat || low < -h->flat;
}

/* What is known of a face: nothing, or these, from 3 times the body's number on. */
enum { AT_HAND = 1, LINES_NOT, LINES, STATES = LINES };

/* While faces follow each other. */
struct lines {
    struct body_lining *lining;
    const struct shell *s;
    const uint32_t *whose;
    uint32_t body, count;
    int within, bent;
};

static int add(struct lines *l, uint32_t face)
{
    struct body_lining *lining = l->lining;
    if (array_reserve(&lining->list, (size_t)l->count + 1, &lining->room, sizeof *lining->list) < 0)
        return -1;
    lining->list[l->count++] = face;
    lining->known[face] = STATES * l->body + AT_HAND;
    return 0;
}

/* A face goes on to those across one of its edges. Returns 0, or -1 when out of memory. */
static int go_on(struct lines *l, uint32_t face, int side)
{
    const struct hierarchy *h = l->s->h;
    struct across list[ACROSS_STRETCHES];
    const int count = across_edge(h, face, side, list);
    for (int k = 0; k < count && l->within; k++) {
        const uint32_t mate = list[k].face;
        if (mate == ACROSS_NOBODY || l->whose[mate] == l->body + 1)
            continue;
        const uint32_t known = l->lining->known[mate];
        l->within = is_within(l->s, &h->elements[mate]) && known != STATES * l->body + LINES_NOT;
        l->bent |= bends(h, &h->elements[face], &h->elements[mate]);
        if (l->within && known <= STATES * l->body && add(l, mate) < 0)
            return -1;
    }
    return 0;
}

int body_lining_is(struct body_lining *lining, const struct shell *s, const uint32_t *whose,
                   uint32_t body, uint32_t face)
{
    struct lines l = {lining, s, whose, body, 0, 1, 0};
    if (lining->known[face] > STATES * body)
        return lining->known[face] == STATES * body + LINES;
    if (add(&l, face) < 0)
        return -1;
    for (uint32_t at = 0; at < l.count && l.within; at++)
        for (int side = 0; side < s->h->elements[lining->list[at]].vertices && l.within; side++)
            if (go_on(&l, lining->list[at], side) < 0)
                return -1;
    for (uint32_t i = 0; i < l.count; i++)
        lining->known[lining->list[i]] = STATES * body + (l.within && l.bent ? LINES : LINES_NOT);
    return l.within && l.bent;
}

int body_lining_open(struct body_lining *lining, const struct hierarchy *h)
{
    memset(lining, 0, sizeof *lining);
    lining->known = calloc((size_t)h->built + 1, sizeof *lining->known);
    return lining->known ? 0 : -1;
}

void body_lining_close(struct body_lining *lining)
{
    free(lining->known);
    free(lining->list);
    memset(lining, 0, sizeof *lining);
}
