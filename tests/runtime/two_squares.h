/* two_squares.h - two squares that see each other, and trees of exchange over them and what stands
 * between.
 * SPDX-License-Identifier: MIT */
#ifndef TWO_SQUARES_H
#define TWO_SQUARES_H

#include <check.h>
#include "engine/exchange_tree.h"
#include "scene/make_scene.h"

/* They face each other at a distance of their side: faces 0 and 1. */
static inline void open_squares(struct scene *s)
{
    made_open(s);
    made_material(s, 0.5, 0);
    made_quad(s, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    made_quad(s, 0, 0, 0, 1, 0, 1, 0, 1, 0, 0);
}

static inline void open_tree(struct exchange_tree *t, const struct scene *s)
{
    const char *cause;
    ck_assert_int_eq(exchange_tree_open(t, s->faces, s->face_count, 1, &cause), 0);
}

/* The face that was made at a place. */
static inline const struct element *face_of(const struct exchange_tree *t, uint32_t face)
{
    return hierarchy_surface(&t->h, face);
}

#endif
