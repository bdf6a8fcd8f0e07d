/* random_room.h - rooms with lamps and boards that stand askew, some black, some through each
 * other, so that pairs of one block go different ways; and solves of them by a refiner at hand.
 * SPDX-License-Identifier: MIT */
#ifndef RANDOM_ROOM_H
#define RANDOM_ROOM_H

#include "make_pair.h"
#include "make_solve.h"

enum { BOARDS = 7 };

static inline void random_board(struct scene *s, uint32_t material, unsigned *state)
{
    double o[3], a[3], b[3];
    for (int k = 0; k < 3; k++) {
        o[k] = 0.8 + (k == 2 ? 1.2 : 2.2) * random_unit(state);
        a[k] = 1.4 * (random_unit(state) - 0.5);
        b[k] = 1.4 * (random_unit(state) - 0.5);
    }
    made_quad(s, material, o[0], o[1], o[2], a[0], a[1], a[2], b[0], b[1], b[2]);
    made_quad(s, material, o[0], o[1], o[2], b[0], b[1], b[2], a[0], a[1], a[2]);
}

static inline void random_room(struct scene *s, unsigned seed)
{
    unsigned state = seed;
    uint32_t m[6];
    ck_assert_int_eq(made_open(s), 0);
    const uint32_t grey = made_material(s, 0.3 + 0.5 * random_unit(&state), 0),
                   lamp = made_material(s, 0.2, 10), black = made_material(s, 0, 0),
                   dim = made_material(s, 0.5, 0.3 * random_unit(&state));
    for (int i = 0; i < 6; i++)
        m[i] = i == 5 ? dim : grey;
    made_room(s, m, 4, 5, 3);
    for (int i = 0; i < BOARDS; i++)
        random_board(s, i == 0 ? lamp : i == 1 ? black : i == 2 ? dim : grey, &state);
}

static inline void solve_by(struct solve *s, const struct scene *scene, const struct refiner *r,
                            int threads)
{
    const struct solve_options options = {
        .tolerance = 1e-3, .iterations = 1000, .threads = threads};
    const char *cause = "";
    ck_assert_msg(solve_open(s, scene, &options, &cause) == 0, "%s", cause);
    ck_assert_msg(solve_run(s, r, &cause) == 0, "%s", cause);
}

/* The same elements, links in the same order and radiosities, after as many discussions that
 * decided the same. */
static inline void same_solves(const struct solve *a, const struct solve *b)
{
    same_links(a, b);
    ck_assert_uint_eq(a->refinement.pairs, b->refinement.pairs);
    ck_assert(memcmp(a->refinement.decided, b->refinement.decided, sizeof a->refinement.decided)
              == 0);
    ck_assert(memcmp(a->state.radiosity, b->state.radiosity, a->hierarchy.count * sizeof(double))
              == 0);
}

#endif
