/* body_parts.c - see body_parts.h.
 *
 * Solids that stand flush on each other have sides in one plane, and what is one side is in groups
 * with others', where triangles, or the parts that contacts cut them into, do not end with it. Then
 * groups do not make the solid. But its faces, all of them, still close a shell, part
 * by part, though edges that meet are not equal (across.h). That takes longer, so only shells are
 * looked for of which some face lies on one that looks the other way, where it matters whether
 * there is a solid. A shell that bends in somewhere is left as soon as that is known: of a floor
 * that things stand on, at its first wall.
 * [derived here]
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "hierarchy/across.h"
#include "hierarchy/body_parts.h"
#include "hierarchy/body_rest.h"
#include "hierarchy/reach.h"
#include "util/array.h"

enum { MET = 1, AT_HAND };

static int append(uint32_t **list, uint32_t count, size_t *room, uint32_t value)
{
    if (array_reserve(list, (size_t)count + 1, room, sizeof **list) < 0)
        return -1;
    (*list)[count] = value;
    return 0;
}

/* Faces below an element, in a plane, that others lie on. */
static int find_starts_in(struct body_parts *p, uint32_t index)
{
    const struct hierarchy *h = p->h;
    const struct element *e = &h->elements[index];
    if (p->whose[index] || !body_rest_is_on(h, e))
        return 0;
    if (!e->children)
        return h->faces[h->order[h->range[index].from]].back
                       || append(&p->start, p->starts++, &p->room[0], index) == 0
                   ? 0
                   : -1;
    for (uint32_t c = 0; c < e->children; c++)
        if (find_starts_in(p, e->child + c) < 0)
            return -1;
    return 0;
}

static int find_starts(struct body_parts *p, uint32_t index)
{
    const struct element *e = &p->h->elements[index];
    if (e->vertices)
        return find_starts_in(p, index);
    for (uint32_t c = 0; c < e->children; c++)
        if (find_starts(p, e->child + c) < 0)
            return -1;
    return 0;
}

int body_parts_open(struct body_parts *p, const struct hierarchy *h, const uint32_t *whose)
{
    memset(p, 0, sizeof *p);
    p->h = h;
    p->whose = whose;
    if (find_starts(p, 0) < 0)
        return -1;
    if (p->starts == 0)
        return 0;
    p->met = calloc((size_t)h->built + 1, sizeof *p->met);
    return p->met ? 0 : -1;
}

/* Is the face not behind the plane of the one before? That one's shell bends in there, or ends. */
static int bends_in(const struct hierarchy *h, const struct element *e, uint32_t face)
{
    double high = 0, low = 0;
    element_reach(e, &h->elements[face], &high, &low);
    return high > h->flat;
}

/* A face of the shell is looked at: who is across its edges is of the shell, too. Returns 1; 0 when
 * that makes none; -1 when out of memory. */
static int look_around(struct body_parts *p, struct shell *s, int at)
{
    const struct element *e = &p->h->elements[p->face[at]];
    struct across list[ACROSS_STRETCHES];
    for (int side = 0; side < e->vertices; side++) {
        const int count = across_edge(p->h, p->face[at], side, list);
        if (count == 0)
            return 0;
        for (int i = 0; i < count; i++) {
            const uint32_t face = list[i].face;
            if (face == ACROSS_NOBODY || bends_in(p->h, e, face)) {
                if (s->edges == BODY_CORNERS)
                    return 0;
                s->edge[s->edges++] = (struct free_edge){at, -1, list[i].from, list[i].to};
                continue;
            }
            if (p->met[face] == AT_HAND)
                continue;
            if (p->met[face])
                return 0;
            p->met[face] = AT_HAND;
            if (append(&p->face, (uint32_t)s->faces++, &p->room[1], face) < 0)
                return -1;
        }
    }
    return 1;
}

/* The face's plane is one of those of the shell's sides, or one more. Returns 0 when these are more
 * than a body has. */
static int add_side(struct body_parts *p, struct shell *s, uint32_t face)
{
    const struct element *e = &p->h->elements[face];
    for (int k = 0; k < s->sides; k++) {
        const struct element *plane = &p->h->elements[p->side[k]];
        double high = 0, low = 0;
        element_reach(plane, e, &high, &low);
        if (high > p->h->flat)
            return 0;
        if (low >= -p->h->flat && dot3(e->normal, plane->normal) > 0)
            return 1;
    }
    if (s->sides == BODY_FACES)
        return 0;
    p->side[s->sides++] = face;
    return 1;
}

/* The shell of a face. Returns 1, 0 when it is none, or -1 when out of memory. */
static int follow(struct body_parts *p, struct shell *s, uint32_t from)
{
    int status = append(&p->face, 0, &p->room[1], from) < 0 ? -1 : 1;
    s->faces = 1;
    s->sides = s->edges = 0;
    p->met[from] = AT_HAND;
    for (int at = 0; at < s->faces && status == 1; at++)
        status = add_side(p, s, p->face[at]) ? look_around(p, s, at) : 0;
    for (int i = 0; i < s->faces && status >= 0; i++)
        p->met[p->face[i]] = MET;
    s->face = p->face;
    s->side = p->side;
    return status;
}

int body_parts_next(struct body_parts *p, struct shell *s)
{
    int status = 0;
    while (status == 0 && p->next < p->starts) {
        const uint32_t from = p->start[p->next++];
        if (!p->met[from])
            status = follow(p, s, from);
    }
    return status;
}

void body_parts_close(struct body_parts *p)
{
    free(p->met);
    free(p->start);
    free(p->face);
    memset(p, 0, sizeof *p);
}
