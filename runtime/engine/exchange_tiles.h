/* exchange_tiles.h - the tiles that a refinement's links are cut into, one after the other.
 *
 * Of the two links between the same two elements one counts: that whose receiver stands later in
 * the tree's order. Tiles without any of the rows that are asked for are left out.
 * SPDX-License-Identifier: MIT */
#ifndef EXCHANGE_TILES_H
#define EXCHANGE_TILES_H

#include "engine/exchange_areas.h"

struct exchange_tiles {
    const struct exchange_areas *areas;
    const struct refinement *refinement;
    size_t next, links;       /* the next link; those that count, so far */
    const struct link *link;  /* of the tile; NULL: before the first */
    struct face_range r, s;   /* its rows and columns, */
    uint32_t i, j;            /* and where the next tile of it begins */
    struct exchange_block is; /* the tile; `at` counts values */
    size_t values;
};

static inline struct exchange_tiles exchange_tiles(const struct exchange_areas *m,
                                                   const struct refinement *r)
{
    return (struct exchange_tiles){.areas = m, .refinement = r};
}

/* Is any of the places a row that is asked for? */
static inline int exchange_tile_asked(const struct exchange_areas *m, uint32_t from, uint32_t count)
{
    if (m->rows == m->inputs)
        return 1;
    for (uint32_t p = from; p < from + count; p++)
        if (m->input[p] < m->rows)
            return 1;
    return 0;
}

/* Returns 0 when there is no further tile. */
static inline int exchange_tiles_next(struct exchange_tiles *t)
{
    const struct hierarchy *h = &t->areas->tree->h;
    for (;;) {
        while (!t->link || t->i >= t->r.to) {
            if (t->next == t->refinement->link_count)
                return 0;
            t->link = &t->refinement->links[t->next++];
            t->r = hierarchy_range(h, t->link->receiver);
            t->s = hierarchy_range(h, t->link->emitter);
            int counts = t->r.from > t->s.from;
            t->i = counts ? t->r.from : t->r.to;
            t->j = t->s.from;
            t->links += (size_t)counts;
        }
        struct exchange_block *b = &t->is;
        uint32_t rows = t->r.to - t->i < TILE ? t->r.to - t->i : TILE,
                 columns = t->s.to - t->j < TILE ? t->s.to - t->j : TILE;
        *b =
            (struct exchange_block){t->i, t->j, (uint16_t)rows, (uint16_t)columns, 0, t->values, 0};
        t->j += TILE;
        if (t->j >= t->s.to) {
            t->j = t->s.from;
            t->i += TILE;
        }
        if (exchange_tile_asked(t->areas, b->row, b->rows)
            || exchange_tile_asked(t->areas, b->column, b->columns)) {
            t->values += (size_t)b->rows * b->columns;
            return 1;
        }
    }
}

#endif
