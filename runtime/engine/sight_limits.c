/* sight_limits.c - see sight_limits.h.
 *
 * In a scene of few polygons each entry is looked at for itself, and with care. But an entry is
 * that of two polygons, and a sum over their parts, as a disc's of 200 corners over 99: each part
 * has its share of the pieces, of the error, and of the light below which errors do not count.
 * Errors of parts add up like chance, so that those of k pairs may be root k times as large.
 * Invariant: of polygons that are not cut, and in scenes of many, the limits are the scene's.
 * SPDX-License-Identifier: MIT */
#include "engine/sight_limits.h"

#include "engine/sight_pieces.h"
#include "kernel/constants.h"

struct sight_limits sight_limits_for(double tolerance, uint32_t polygons, uint32_t faces)
{
    int few = polygons <= SIGHT_FEW_POLYGONS;
    return (struct sight_limits){few ? SIGHT_FEW_SURE * tolerance : tolerance,
                                 few ? SIGHT_FLOOR : SIGHT_FLOOR_MANY / sqrt(faces),
                                 few ? SIGHT_PIECES : SIGHT_PIECES_MANY,
                                 faces < SIGHT_LIST ? (int)faces : SIGHT_LIST, !few};
}

/* The polygon that a face is part of: how many parts it has on that side, and their area (m2). */
struct whole {
    double area;
    uint32_t parts;
};

/* Parts of a polygon stand one behind the other, the sides of each beside it. */
static struct whole whole_of(const struct hierarchy *h, uint32_t face)
{
    const struct face *faces = h->faces, *of = &faces[face];
    struct whole whole = {0, 0};
    uint32_t i = face;
    while (i > 0 && faces[i - 1].input == of->input)
        i--;
    for (; i < h->face_count && faces[i].input == of->input; i++)
        if (!faces[i].back == !of->back) {
            whole.area += hierarchy_surface(h, i)->area;
            whole.parts++;
        }
    return whole;
}

struct sight_limits sight_limits_of(const struct sight_limits *limits,
                                    const struct exchange_tree *t, const struct element *r,
                                    const struct element *s)
{
    struct sight_limits own = *limits;
    if (limits->many)
        return own;
    const struct whole a = whole_of(&t->h, r->face), b = whole_of(&t->h, s->face);
    const double pairs = (double)a.parts * b.parts;
    if (a.parts == 1 && b.parts == 1)
        return own;
    own.tolerance *= fmin(sqrt(pairs), 1 / SIGHT_FEW_SURE);
    own.floor *= fmax(fmin(a.area, b.area) / (pairs * fmin(r->area, s->area)), 1);
    own.pieces = (int)fmax(limits->pieces / pairs, SIGHT_PIECES_MANY);
    return own;
}
