/* look_past.h - what points see of a square past solids, by the rims of their shadows, against what
 * is left when the shadow of each face is cut out.
 * SPDX-License-Identifier: MIT */
#ifndef LOOK_PAST_H
#define LOOK_PAST_H

#include <math.h>
#include "engine/sight_rims.h"
#include "runtime/chance.h"
#include "runtime/two_squares.h"

/* Three edges of a box of any size, turned by chance; right-handed. */
static inline void chance_edges(uint64_t *state, double size, double edges[3][3])
{
    double n[3], u[3], v[3];
    for (int k = 0; k < 3; k++) {
        n[k] = chance(state) - 0.5;
        u[k] = chance(state) - 0.5;
    }
    cross3(v, n, u);
    cross3(u, v, n);
    const double *axes[3] = {u, v, n};
    for (int i = 0; i < 3; i++) {
        const double scale = size * (0.2 + chance(state)) / length3(axes[i]);
        for (int k = 0; k < 3; k++)
            edges[i][k] = scale * axes[i][k];
    }
}

/* What points of the lower square see of the upper one past all other faces. */
struct seen {
    double most, partial, hidden, points, untold;
};

static inline void look_at(const struct exchange_tree *t, const struct polygon *part,
                           uint32_t faces, const double (*x)[3], int points, int count,
                           struct seen *seen)
{
    static struct sight_bodies bodies;
    const struct element *low = face_of(t, 0), *high = face_of(t, 1);
    uint32_t list[SIGHT_CUT];
    struct sight sight;
    sight_open(&sight, high, part, t->lift);
    for (uint32_t i = 2; i < faces; i++)
        list[i - 2] = t->h.face_element[i];
    ck_assert(sight_bodies_place(&bodies, t, list, (int)faces - 2, &sight.raised));
    ck_assert_int_le(bodies.count, count);
    for (int i = 0; i < points; i++) {
        double whole[2];
        const double up = t->lift,
                     by_rims = sight_rims_past(&sight, x[i], low->normal, up, &bodies, &whole[0]),
                     by_faces = sight_factor(&sight, x[i], low->normal, up, t, list, (int)faces - 2,
                                             &whole[1]);
        seen->points++;
        if (by_rims < 0) {
            seen->untold++;
            continue;
        }
        ck_assert_double_eq(whole[0], whole[1]);
        ck_assert_double_le(by_rims, whole[0]);
        seen->most = fmax(seen->most, fabs(by_rims - by_faces));
        seen->partial += by_faces > 1e-6 && by_faces < 0.999 * whole[1];
        seen->hidden += !(by_faces > 1e-9);
    }
}

static inline void look(const struct exchange_tree *t, uint32_t faces, const double (*x)[3],
                        int points, int count, struct seen *seen)
{
    struct polygon part = {.n = 4};
    memcpy(part.v, face_of(t, 1)->vertex, 4 * sizeof *part.v);
    look_at(t, &part, faces, x, points, count, seen);
}

/* The same from points anywhere on the lower square, then the scene and its tree are closed. */
enum { LOOK_POINTS = 40 };
static inline void look_by_chance(struct exchange_tree *t, struct scene *s, uint64_t *state,
                                  int count, struct seen *seen)
{
    double x[LOOK_POINTS][3];
    for (int i = 0; i < LOOK_POINTS; i++) {
        x[i][0] = chance(state);
        x[i][1] = chance(state);
        x[i][2] = 0;
    }
    look(t, s->face_count, (const double(*)[3])x, LOOK_POINTS, count, seen);
    exchange_tree_close(t);
    made_close(s);
}

#endif
