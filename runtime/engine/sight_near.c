/* sight_near.c - see sight_near.h.
 *
 * Where a leg stands on a floor, or light passes under a sheet's edge, most of what a piece loses
 * is lost in a narrow part of it, and points may all stand beside that, of its quarters, too: then
 * all agree, and all are off the same way. But what the piece exchanges with such a face is known
 * exactly, and so is what its points make of it.
 * Invariant: what was known before is what would be computed now: corners are equal to the last
 * bit, but for one chance of 2^64 that others have their hash. [derived here]
 * SPDX-License-Identifier: MIT */
#include <string.h>
#include "engine/sight_near.h"
#include "engine/face_rule.h"
#include "kernel/constants.h"
#include "kernel/hash.h"
#include "kernel/lambert.h"
#include "kernel/polygon_factor.h"

/* How near any of a face has to be, so that the factor to it is not smooth along the piece. */
static double reach_of(const struct element *piece)
{
    return CLEAR_POINTS_NEAR * piece->radius;
}

/* Is all of a face, by its centre or by its plane, so far off that what a piece exchanges with it
 * is smooth? */
static int is_far(const struct element *piece, const struct element *face)
{
    const double reach = reach_of(piece), all = reach + face->radius;
    double apart[3];
    sub3(apart, face->centre, piece->centre);
    return !(dot3(apart, apart) < all * all) || fabs(dot3(apart, face->normal)) >= reach;
}

/* What is asked, of a piece and a face. */
enum asked { THROUGH, NEAR };

static uint64_t key_of(const struct element *piece, enum asked asked)
{
    uint64_t key = hash64(piece->id + asked);
    for (int i = 0; i < piece->vertices; i++)
        for (int k = 0; k < 3; k++) {
            uint64_t bits;
            memcpy(&bits, &piece->vertex[i][k], sizeof bits);
            key = hash64(key ^ bits);
        }
    return key;
}

/* The place of what is asked of a face. Returns whether its value is known; else it is to be set.
 */
static int find(struct sight_known *known, uint64_t piece, uint32_t face, double **value)
{
    const uint64_t key = hash64(piece + face) | 1;
    struct sight_known_place *place = &known->place[(piece + face) % SIGHT_KNOWN];
    const int is = place->key == key;
    place->key = key;
    *value = place->value;
    return is;
}

static double exchange_through(const struct element *face, const struct element *e)
{
    struct element back = *face;
    for (int i = 0; i < face->vertices; i++)
        for (int k = 0; k < 3; k++)
            back.vertex[i][k] = face->vertex[face->vertices - 1 - i][k];
    for (int k = 0; k < 3; k++)
        back.normal[k] = -face->normal[k];
    return face->area * (polygon_factor(face, e, 0) + polygon_factor(&back, e, 0));
}

double sight_exchange_through(const struct exchange_tree *tree, uint32_t face,
                              const struct element *e, struct sight_known *known)
{
    double *value;
    if (!find(known, key_of(e, THROUGH), face, &value))
        value[0] = exchange_through(&tree->h.elements[face], e);
    return value[0];
}

/* How far a piece's points are off of what it exchanges with a face, and what they say (m2); both 0
 * when it is not near, or not in front. */
static void look_at(const struct element *piece, const struct element *face, double value[2])
{
    struct face_rule rule;
    struct polygon front;
    double mean = 0, at[FACE_RULE][3], f[FACE_RULE];
    value[0] = value[1] = 0;
    if (!(polygon_distance(piece->centre, (const double(*)[3])face->vertex, face->vertices,
                           face->normal)
          < reach_of(piece)))
        return;
    polygon_clip(&front, (const double(*)[3])face->vertex, face->vertices, piece->centre,
                 piece->normal);
    if (front.n < 3)
        return;
    face_rule_of(&rule, piece, 0);
    for (int i = 0; i < rule.count; i++)
        for (int k = 0; k < 3; k++)
            at[i][k] = rule.x[k][i];
    lambert_sums(rule.count, (const double(*)[3])at, piece->normal, (const double(*)[3])front.v,
                 front.n, f);
    for (int i = 0; i < rule.count; i++)
        mean += rule.weight[i] / rule.all * fabs(f[i]);
    value[0] = fabs(exchange_through(face, piece) - piece->area * mean);
    value[1] = piece->area * mean;
}

double sight_near(const struct element *piece, const struct exchange_tree *tree,
                  const uint32_t *faces, int count, struct sight_known *known, double *sum)
{
    const uint64_t key = key_of(piece, NEAR);
    double off = 0, *value;
    *sum = 0;
    for (int b = 0; b < count; b++) {
        const struct element *face = &tree->h.elements[faces[b]];
        if (is_far(piece, face)) /* most are, and that is told sooner than they are looked up */
            continue;
        if (!find(known, key, faces[b], &value))
            look_at(piece, face, value);
        off += value[0];
        *sum += value[1];
    }
    return off;
}
