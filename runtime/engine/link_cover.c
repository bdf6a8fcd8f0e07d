/* link_cover.c - see link_cover.h.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include "engine/link_cover.h"

int link_cover_open(struct link_cover *c, const struct light_operator *op)
{
    *c = (struct link_cover){.op = op,
                             .mark = calloc((size_t)op->hierarchy->count + 1, sizeof *c->mark)};
    if (!c->mark)
        return -1;
    link_cover_mark(c, 0, 1);
    return 0;
}

void link_cover_close(struct link_cover *c)
{
    free(c->mark);
    *c = (struct link_cover){0};
}

void link_cover_mark(struct link_cover *c, uint32_t e, int marked)
{
    const struct refinement *r = c->op->refinement;
    size_t group = c->op->separable.count ? c->op->separable.first[e] : 0;
    for (size_t i = r->first_link[e]; i < r->first_link[e + 1]; i++) {
        const struct link *l = &r->links[i];
        size_t mark = 2 * (i + 1);
        if (link_is_separable(c->op->hierarchy, l))
            mark = 2 * ++group + 1;
        if (l->visibility > 0)
            c->mark[l->emitter] = marked ? mark : 0;
    }
}

static int holds(const struct element *elements, uint32_t cluster, uint32_t e)
{
    while (e != cluster && e != 0)
        e = elements[e].parent;
    return e == cluster;
}

void link_cover_move(struct link_cover *c, uint32_t cluster)
{
    const struct element *elements = c->op->hierarchy->elements;
    for (; !holds(elements, c->top, cluster); c->top = elements[c->top].parent)
        link_cover_mark(c, c->top, 0);
    for (uint32_t e = cluster; e != c->top; e = elements[e].parent)
        link_cover_mark(c, e, 1);
    c->top = cluster;
}

struct covering link_cover_find(const struct link_cover *c, uint32_t emitter)
{
    const struct element *elements = c->op->hierarchy->elements;
    while (!c->mark[emitter] && emitter != 0)
        emitter = elements[emitter].parent;
    size_t mark = c->mark[emitter], i = mark / 2 - 1;
    if (mark == 0)
        return (struct covering){.way = RAD_WAY_NONE};
    if (mark & 1)
        return (struct covering){.way = RAD_WAY_GROUPS, .group = i};
    const struct link *l = &c->op->refinement->links[i];
    return (struct covering){.way = link_way(l), .link = l};
}
