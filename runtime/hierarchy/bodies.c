/* bodies.c - convex solids of a few faces.
 *
 * Faces that follow each other across their edges until none is left over close a shell; where no
 * corner of it lies in front of any of its planes, the shell is the surface of a convex solid, its
 * fronts outside. So what it hides from a point is one convex polygon, whatever its faces are.
 * Invariant: a face is of one body at most; a body has no free edge, no bent face and no face whose
 * front looks inside.
 * [a closed surface that each of its planes supports is its hull's; derived here]
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "hierarchy/bodies.h"
#include "util/array.h"

/* The faces that follow each other from one on. Returns how many; 0: some edge is free, or there
 * are more than a body has. */
static int follow(const struct hierarchy *h, const struct mates *mates, uint32_t from,
                  uint32_t faces[BODY_FACES])
{
    int count = 1;
    faces[0] = from;
    for (int at = 0; at < count; at++)
        for (int i = 0; i < h->elements[faces[at]].vertices; i++) {
            const int64_t mate = mates->of[faces[at]][i];
            int k = 0;
            if (mate == NO_MATE || mate % 2)
                return 0;
            while (k < count && faces[k] != (uint32_t)(mate / 2))
                k++;
            if (k == BODY_FACES)
                return 0;
            if (k == count)
                faces[count++] = (uint32_t)(mate / 2);
        }
    return count;
}

/* Does no corner lie in front of a plane, nor of a face off its own, and some behind each by more
 * than rounding? Else points in the plane of a plate were inside. */
static int is_convex(const struct hierarchy *h, const uint32_t *faces, int count)
{
    for (int i = 0; i < count; i++) {
        const struct element *plane = &h->elements[faces[i]];
        double deepest = 0;
        for (int j = 0; j < count; j++) {
            const struct element *e = &h->elements[faces[j]];
            for (int k = 0; k < e->vertices; k++) {
                const double height = height3(e->vertex[k], plane->vertex[0], plane->normal);
                if (height > h->flat || (i == j && height < -h->flat))
                    return 0;
                deepest = height < deepest ? height : deepest;
            }
        }
        if (!(deepest < -8 * h->flat))
            return 0;
    }
    return 1;
}

/* The place of a corner among so many, the next one when it is new. Those that faces round apart
 * are two. */
static int place_of(double (*corners)[3], int count, const double p[3])
{
    int at = 0;
    while (at < count && memcmp(corners[at], p, sizeof corners[at]) != 0)
        at++;
    memcpy(corners[at], p, sizeof corners[at]);
    return at;
}

/* The corners and edges of a body, the last of the lists. */
static void measure(struct body *body, struct bodies *b, const struct hierarchy *h,
                    const struct mates *mates)
{
    const uint32_t *faces = b->faces + body->face;
    double(*corners)[3] = b->corners + body->corner;
    struct body_edge *edges = b->edges + body->edge;
    int count = 0;
    for (int f = 0; f < body->faces; f++) {
        const struct element *e = &h->elements[faces[f]];
        for (int i = 0; i < e->vertices; i++) {
            int at[2], right = 0;
            for (int end = 0; end < 2; end++) {
                at[end] = place_of(corners, count, e->vertex[(i + end) % e->vertices]);
                count += at[end] == count;
            }
            while (faces[right] != (uint32_t)(mates->of[faces[f]][i] / 2))
                right++;
            if (right > f)
                edges[body->edges++] =
                    (struct body_edge){(uint8_t)at[0], (uint8_t)at[1], (uint8_t)f, (uint8_t)right};
        }
    }
    body->corners = (uint8_t)count;
}

int bodies_open(struct bodies *b, const struct hierarchy *h, const struct mates *mates)
{
    uint32_t found[BODY_FACES], count = 0;
    size_t room[4] = {0};
    struct body last = {0};
    memset(b, 0, sizeof *b);
    b->of = calloc((size_t)h->built + 1, sizeof *b->of);
    if (!b->of)
        return -1;
    for (uint32_t i = 0; i < h->built; i++) {
        const int faces = b->of[i] || mates->of[i][0] == NO_MATE ? 0 : follow(h, mates, i, found);
        if (faces == 0 || !is_convex(h, found, faces))
            continue;
        last = (struct body){last.face + last.faces,
                             last.corner + last.corners,
                             last.edge + last.edges,
                             (uint8_t)faces,
                             0,
                             0};
        if (array_reserve(&b->body, count + 1, &room[0], sizeof *b->body) < 0
            || array_reserve(&b->faces, last.face + BODY_FACES, &room[1], sizeof *b->faces) < 0
            || array_reserve(&b->corners, last.corner + BODY_CORNERS, &room[2], sizeof *b->corners)
                   < 0
            || array_reserve(&b->edges, last.edge + BODY_EDGES, &room[3], sizeof *b->edges) < 0)
            return -1;
        memcpy(b->faces + last.face, found, (size_t)faces * sizeof *found);
        measure(&last, b, h, mates);
        b->body[count++] = last;
        for (int k = 0; k < faces; k++)
            b->of[found[k]] = count;
    }
    return 0;
}

void bodies_close(struct bodies *b)
{
    free(b->of);
    free(b->body);
    free(b->faces);
    free(b->corners);
    free(b->edges);
    memset(b, 0, sizeof *b);
}
