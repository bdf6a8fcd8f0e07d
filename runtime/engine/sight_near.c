/* sight_near.c - see sight_near.h.
 *
 * Where a leg stands on a floor, or light passes under a sheet's edge, most of what a piece loses
 * is lost in a narrow part of it, and points may all stand beside that, of its quarters, too: then
 * all agree, and all are off the same way. But what the piece exchanges with such a face is known
 * exactly, and so is what its points make of it. [derived here]
 * SPDX-License-Identifier: MIT */
#include "engine/sight_near.h"
#include "engine/face_rule.h"
#include "kernel/constants.h"
#include "kernel/lambert.h"
#include "kernel/polygon_factor.h"

/* Is any of it so near that the factor to it is not smooth along the piece? */
static int is_near(const struct element *piece, const struct element *face)
{
    const double reach = CLEAR_POINTS_NEAR * piece->radius, all = reach + face->radius;
    double apart[3];
    sub3(apart, face->centre, piece->centre);
    return dot3(apart, apart) < all * all
           && polygon_distance(piece->centre, (const double(*)[3])face->vertex, face->vertices,
                               face->normal)
                  < reach;
}

double sight_exchange_through(const struct element *face, const struct element *e)
{
    struct element back = *face;
    for (int i = 0; i < face->vertices; i++)
        for (int k = 0; k < 3; k++)
            back.vertex[i][k] = face->vertex[face->vertices - 1 - i][k];
    for (int k = 0; k < 3; k++)
        back.normal[k] = -face->normal[k];
    return face->area * (polygon_factor(face, e, 0) + polygon_factor(&back, e, 0));
}

double sight_near(const struct element *piece, const struct exchange_tree *tree,
                  const uint32_t *faces, int count, double *sum)
{
    struct face_rule rule;
    double off = 0, at[FACE_RULE][3], f[FACE_RULE];
    face_rule_of(&rule, piece, 0);
    *sum = 0;
    for (int i = 0; i < rule.count; i++)
        for (int k = 0; k < 3; k++)
            at[i][k] = rule.x[k][i];
    for (int b = 0; b < count; b++) {
        const struct element *face = &tree->h.elements[faces[b]];
        struct polygon front;
        double mean = 0;
        if (!is_near(piece, face))
            continue;
        polygon_clip(&front, (const double(*)[3])face->vertex, face->vertices, piece->centre,
                     piece->normal);
        if (front.n < 3)
            continue;
        lambert_sums(rule.count, (const double(*)[3])at, piece->normal, (const double(*)[3])front.v,
                     front.n, f);
        for (int i = 0; i < rule.count; i++)
            mean += rule.weight[i] / rule.all * fabs(f[i]);
        off += fabs(sight_exchange_through(face, piece) - piece->area * mean);
        *sum += piece->area * mean;
    }
    return off;
}
