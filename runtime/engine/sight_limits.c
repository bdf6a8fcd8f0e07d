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

struct sight_limits sight_limits_of(const struct sight_limits *limits,
                                    const struct exchange_tree *t, const struct element *r,
                                    const struct element *s)
{
    const struct exchange_whole *a = &t->wholes[r->face], *b = &t->wholes[s->face];
    const double pairs = (double)a->parts * b->parts;
    struct sight_limits own = *limits;
    if (limits->many || (a->parts == 1 && b->parts == 1))
        return own;
    own.tolerance *= fmin(sqrt(pairs), 1 / SIGHT_FEW_SURE);
    own.floor *= fmax(fmin(a->area, b->area) / (pairs * fmin(r->area, s->area)), 1);
    own.pieces = (int)fmax(limits->pieces / pairs, SIGHT_PIECES_MANY);
    return own;
}
