/* dark_sides.c - see dark_sides.h.
 *
 * A solid whose faces have two sides is a dark chamber: nothing inside emits, and nothing comes in.
 * So no light is anywhere inside, and nothing of it need be solved for. What is one space tell the
 * edges (sides.h), and rays: where one gets from a side to another, both bound the same space. A
 * space in which nothing emits is dark.
 *
 * A side that something stands on bounds several spaces: a ray that meets it goes on from there, in
 * any direction, until it meets a side of one space or has lost its way. No ray starts on such a
 * side; where a space has no other it is not asked, and counts as lit. A ray that slips through a
 * crack joins two spaces that are apart: then one is not known to be dark, which is what was
 * before. What can be missed is an opening along which no face goes on from one space into the
 * other, and through which none of the RAYS of a space happens to pass. [derived here]
 * SPDX-License-Identifier: MIT */
#include "visibility/dark_sides.h"
#include <stdlib.h>
#include <string.h>
#include "hierarchy/sides.h"
#include "kernel/hash.h"
#include "kernel/hemisphere.h"
#include "kernel/surface_point.h"

/* Walks of a space, and from each of its sides, at the least, and steps of one at the most. Chosen:
 * of 10,585 dark sides of six furnished scenes particles then meet three, through slits, with a
 * millionth of a scene's light at the most. */
enum { RAYS = 64, STARTS = 2, STEPS = 16 };

struct search {
    const struct rays *rays;
    const struct hierarchy *h;
    const double *exitance; /* [face] */
    struct sides sides;
    uint32_t lit;   /* a side that emits */
    uint64_t dice;  /* the number of the last random number */
    uint32_t *next; /* [far]: the next side that its edges join to it; itself: the last */
};

/* The listed face that is a side; UINT32_MAX: the black back of a one-sided face. */
static uint32_t face_of(const struct hierarchy *h, uint32_t side)
{
    return side % 2 ? face_other_side(h->faces, h->face_count, side / 2) : side / 2;
}

static int emits(const struct search *s, uint32_t side)
{
    uint32_t face = face_of(s->h, side);
    return face != UINT32_MAX && s->exitance[face] > 0;
}

static double chance(struct search *s)
{
    return hash_unit(++s->dice * HASH_STEP);
}

static void move_off(const struct search *s, const struct element *e, double p[3])
{
    for (int k = 0; k < 3; k++)
        p[k] += rays_host(s->rays)->ray_offset * e->normal[k];
}

/* May walks begin on the side? */
static int begins(const struct search *s, uint32_t side)
{
    return !s->sides.touched[side] && face_of(s->h, side) != UINT32_MAX;
}

/* Walk from a side to another of its space, and join them. */
static void walk(struct search *s, uint32_t from)
{
    const struct element *e = hierarchy_surface(s->h, face_of(s->h, from));
    double p[3], u = chance(s), v = chance(s);
    surface_even_point(p, e, u, v);
    move_off(s, e, p);
    for (int i = 0; i < STEPS; i++) {
        const struct hemisphere above = hemisphere_over(e->normal);
        const int turn = (int)(chance(s) * RAYS);
        double d[3], distance;
        hemisphere_direction(d, &above, turn, RAYS, chance(s));
        const int64_t met = rays_meet(s->rays, p, d, &distance);
        uint32_t side = met == RAY_MEETS_NO_FRONT ? s->sides.far
                        : met < 0                 ? 2 * (uint32_t)ray_meets_back(met) + 1
                                                  : sides_of(s->h, (uint32_t)met);
        if (met < 0 || !s->sides.touched[side] || emits(s, side)) {
            sides_join(&s->sides, from, side);
            return;
        }
        e = hierarchy_surface(s->h, (uint32_t)met);
        ray_land(p, d, distance, e);
        move_off(s, e, p);
    }
}

static int is_lit(struct search *s, uint32_t side)
{
    return sides_space(&s->sides, side) == sides_space(&s->sides, s->lit);
}

/* Walk from the sides that edges join to a first one, each STARTS times at the least, until they
 * are known to be lit. Of those that are from the beginning, what they see is not yet. */
static void search_space(struct search *s, uint32_t first)
{
    const int lit = is_lit(s, first);
    uint32_t starts = 0, faces = 0, side = first;
    do {
        faces += face_of(s->h, side) != UINT32_MAX ? 1 : 0;
        starts += begins(s, side) ? 1 : 0;
        side = s->next[side];
    } while (side != first);
    if (starts == 0 && faces > 0)
        sides_join(&s->sides, first, s->lit);
    for (uint32_t i = starts > 0 ? RAYS / starts + STARTS : 0; i > 0; i--)
        do {
            if (!lit && is_lit(s, first))
                return;
            if (begins(s, side))
                walk(s, side);
            side = s->next[side];
        } while (side != first);
}

/* Lists of the sides that edges have joined. last: [far]. */
static void list_spaces(struct search *s, uint32_t *last)
{
    for (uint32_t i = 0; i < s->sides.far; i++) {
        const uint32_t root = sides_space(&s->sides, i); /* the smallest of its space */
        if (root != i)
            s->next[last[root]] = i;
        s->next[i] = root;
        last[root] = i;
    }
}

/* Far sides stand in two places: as sides 2 f + 1 of their fronts, and as faces of their own, which
 * have no sides. */
static int is_side(const struct search *s, uint32_t side)
{
    return !s->h->faces[side / 2].back;
}

static void mark_dark(struct search *s, uint8_t *dark)
{
    for (uint32_t i = 0; i < s->sides.far; i++) {
        const uint32_t face = face_of(s->h, i);
        if (is_side(s, i) && face_of(s->h, i | 1) != UINT32_MAX)
            dark[face] = !s->sides.touched[i] && !is_lit(s, i);
    }
}

int dark_sides_find(const struct rays *rays, const struct hierarchy *h, const double *exitance,
                    double precision, struct ranks *ranks, int threads, uint8_t *dark)
{
    struct search s = {.rays = rays, .h = h, .exitance = exitance, .lit = UINT32_MAX};
    memset(dark, 0, h->face_count);
    if (sides_open(&s.sides, h, precision, ranks, threads) < 0) {
        sides_close(&s.sides);
        return -1;
    }
    for (uint32_t i = 0; i < s.sides.far; i++)
        if (is_side(&s, i) && emits(&s, i)) {
            s.lit = s.lit == UINT32_MAX ? i : s.lit;
            sides_join(&s.sides, i, s.lit);
        }
    uint32_t *last = malloc(((size_t)s.sides.far + 1) * sizeof *last);
    s.next = malloc(((size_t)s.sides.far + 1) * sizeof *s.next);
    const int failed = ranks_any(ranks, !last || !s.next);
    if (!failed && s.lit != UINT32_MAX) {
        list_spaces(&s, last);
        for (uint32_t i = 0; i < s.sides.far; i++)
            last[i] = sides_space(&s.sides, i) == i;
        for (uint32_t i = 0; i < s.sides.far; i++)
            if (last[i] && is_side(&s, i))
                search_space(&s, i);
        mark_dark(&s, dark);
    }
    free(last);
    free(s.next);
    sides_close(&s.sides);
    return failed ? -1 : 0;
}
