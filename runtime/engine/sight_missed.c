/* sight_missed.c - see sight_missed.h.
 *
 * A small face near a piece shades it in one place. Where no point of the rule stands there, all
 * points agree, and so do those of the quarters, by chance: nothing tells that a shade was missed.
 * But what passes through a face is no more than what the piece and the face exchange with nothing
 * between, nor than what the face and the polygon do; and both are known exactly. A face that
 * throws a shade on some point is not asked: the rule's own error speaks of that. What passes
 * through a solid passes through two of its faces, and is counted at the one by which it comes in.
 * [derived here]
 * SPDX-License-Identifier: MIT */
#include "engine/sight_missed.h"
#include "kernel/element_distance.h"
#include "kernel/lambert.h"
#include "kernel/shaft.h"
#include "visibility/candidates.h"

/* Of a piece: where a convex face's shade meets a convex polygon is convex on the piece, and of all
 * that is convex and holds none of its and its quarters' points none is larger, about: a strip
 * between two rows of a quad's has .19 */
static const double GAP = 0.25;

/* The most that a part of the piece in which no point stands exchanges with the face (m2). */
static double exchange_in_gap(const struct element *face, const struct element *piece)
{
    double range[2];
    distance_bound(face, piece, range);
    return GAP * piece->area * face->area / (LAMBERT_PI * range[0] * range[0]);
}

void sight_eyes_open(struct sight_eyes *eyes, const struct sight *sight, double up, int enough)
{
    eyes->sight = sight;
    eyes->up = up;
    eyes->enough = enough;
    eyes->count = 0;
}

void sight_eyes_add(struct sight_eyes *eyes, const struct element *piece)
{
    const struct outline_frame *plane = &eyes->sight->raised;
    struct face_rule rule;
    face_rule_of(&rule, piece, 0);
    for (int i = 0; i < rule.count; i++) {
        double *from = eyes->from[eyes->count];
        for (int k = 0; k < 3; k++)
            from[k] = rule.x[k][i] + eyes->up * piece->normal[k];
        eyes->height[eyes->count++] = height3(from, plane->origin, plane->n);
    }
}

/* A point so near to a face's plane, of the piece's radius, sees it from the edge: its shade is as
 * narrow, wherever it falls, and tells nothing. Chosen. */
static const double EDGE_ON = 0.01;

/* Does the face throw a shade on enough of the points? */
static int is_seen(const struct sight_eyes *eyes, const struct element *face, double radius)
{
    const struct sight *sight = eyes->sight;
    struct outline shade;
    int shaded = 0;
    for (int i = 0; i < eyes->count; i++)
        if (eyes->height[i] > 0
            && fabs(height3(eyes->from[i], face->vertex[0], face->normal)) > EDGE_ON * radius
            && outline_cast(&shade, &sight->raised, eyes->from[i], eyes->height[i],
                            (const double(*)[3])face->vertex, face->vertices)
            && sight_shade_meets(&shade, &sight->cell) && ++shaded == eyes->enough)
            return 1;
    return 0;
}

/* The planes through the sides of a polygon and the corners of a piece in front of it. */
struct side_planes {
    int sides, corners; /* sides: 0 when the piece is not in front of all of it */
    const double *at[4];
    double normal[4][4][3], least[4][4];
};

/* near: how far to the inner side of a plane is beside it still (m). */
static void planes_between(struct side_planes *planes, const struct element *piece,
                           const struct element *to, double near)
{
    planes->sides = 0;
    planes->corners = piece->vertices;
    for (int c = 0; c < piece->vertices; c++)
        if (height3(piece->vertex[c], to->vertex[0], to->normal) < -near)
            return;
    for (int i = 0; i < to->vertices; i++) {
        const double *a = to->vertex[i], *b = to->vertex[i + 1 < to->vertices ? i + 1 : 0];
        planes->at[i] = a;
        for (int c = 0; c < piece->vertices; c++) {
            double side[3], sight[3];
            sub3(side, b, a);
            sub3(sight, piece->vertex[c], a);
            cross3(planes->normal[i][c], side, sight);
            planes->least[i][c] = -near * length3(planes->normal[i][c]);
        }
    }
    planes->sides = to->vertices;
}

/* Does all of a face lie beyond one side, as seen from anywhere on the piece? */
static int is_beyond(const struct element *face, const struct side_planes *planes)
{
    for (int i = 0; i < planes->sides; i++) {
        int beyond = 1;
        for (int c = 0; c < planes->corners && beyond; c++)
            for (int k = 0; k < face->vertices && beyond; k++)
                beyond = height3(face->vertex[k], planes->at[i], planes->normal[i][c])
                         >= planes->least[i][c];
        if (beyond)
            return 1;
    }
    return 0;
}

/* Do rays from the piece leave a solid by the face? They have met one by which they come in. */
static int is_way_out(const struct exchange_tree *t, uint32_t face, const struct element *piece)
{
    const struct element *e = &t->h.elements[face];
    int behind = t->bodies.of[face] != 0;
    for (int c = 0; c < piece->vertices && behind; c++)
        behind = height3(piece->vertex[c], e->vertex[0], e->normal) < 0;
    return behind;
}

double sight_missed(const struct sight_eyes *eyes, const struct element *piece,
                    const struct element *to, const struct exchange_tree *tree,
                    const uint32_t *faces, int count, struct sight_known *known, double most)
{
    struct side_planes of_to, of_piece;
    struct shaft shaft;
    double sum = 0;
    if (!(most > 0) || !shaft_open(&shaft, piece, to, &tree->host))
        return 0;
    planes_between(&of_to, piece, to, tree->h.flat);
    planes_between(&of_piece, to, piece, tree->h.flat);
    for (int i = 0; i < count && sum < most; i++) {
        const struct element *face = &tree->h.elements[faces[i]];
        if (is_way_out(tree, faces[i], piece) || is_beyond(face, &of_to)
            || is_beyond(face, &of_piece) || is_seen(eyes, face, piece->radius)
            || !candidates_meets(&tree->h, &shaft, tree->host.ray_offset, faces[i]))
            continue;
        sum += fmin(fmin(sight_exchange_through(tree, faces[i], piece, known),
                         sight_exchange_through(tree, faces[i], to, known)),
                    exchange_in_gap(face, piece));
    }
    return fmin(sum, most);
}
