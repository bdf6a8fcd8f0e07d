/* sight_between.c - what stands between a piece and the polygon that it looks at: faces, and those
 * of their edges that may be an outline from a point of the piece.
 *
 * First by the shaft alone, where most pairs end: let every face part the two ends, and no edge be
 * an outline from anywhere; then how many faces a ray meets is the same for all (hidden.c), and a
 * ray tells whether all is seen or nothing. Else the faces and edges that were found are put down
 * in the coordinates of the plane that shadows are cast on, for the points to look past them.
 * Whether a face that does not part the ends lies in the shaft at all is asked only where the
 * answer hangs on it: one too many costs time and changes nothing, unless it is bent. Invariant:
 * every face that meets the shaft is in the list; an edge that is not is no outline within the
 * shaft, or the other face at it has brought it.
 * SPDX-License-Identifier: MIT */
#include <string.h>
#include "engine/sight_between.h"
#include "kernel/shaft.h"
#include "visibility/candidates.h"
#include "visibility/hidden.h"

/* Faces of a short list are looked for in it; of others, their places are kept by the last digits
 * of their indices. */
static void make_places(struct sight_between *b)
{
    if (b->faces <= SIGHT_SHORT)
        return;
    memset(b->place, 0, sizeof b->place);
    for (int i = 0; i < b->faces; i++)
        b->place[b->list[i] % SIGHT_PLACES] = (uint16_t)(i + 1);
}

/* Where in the list a face is; -1: it is not in it. */
static int place_of(const struct sight_between *b, uint32_t face)
{
    int low = 0, high = b->faces;
    if (b->faces > SIGHT_SHORT) {
        int at = b->place[face % SIGHT_PLACES] - 1;
        if (at < 0 || b->list[at] == face)
            return at;
        high = at; /* the place is the last one's with these digits */
    }
    while (low < high) {
        int middle = (low + high) / 2;
        if (b->list[middle] < face)
            low = middle + 1;
        else
            high = middle;
    }
    return low < b->faces && b->list[low] == face ? low : -1;
}

/* front[]: which end is in front of each face, 0 where its plane does not part them. Returns -1
 * when there are too many. */
static int add_rims(struct sight_between *b, const struct exchange_tree *t,
                    const struct shaft *shaft, const signed char *front, int at)
{
    uint32_t index = b->list[at];
    const struct element *e = &t->h.elements[index];
    for (int i = 0; i < e->vertices; i++) {
        int mate = -1, turned = 0;
        int64_t across = t->mates.of[index][i];
        if (across != NO_MATE) {
            turned = (int)(across % 2);
            mate = place_of(b, (uint32_t)(across / 2));
        }
        if (mate >= 0
            && (mate < at || (front[at] && front[mate] == (turned ? -front[at] : front[at]))))
            continue;
        if (!hidden_edge(shaft, e->vertex[i], e->vertex[i + 1 < e->vertices ? i + 1 : 0]))
            continue;
        if (b->rims == SIGHT_EDGES)
            return -1;
        b->rim[b->rims++] =
            (struct sight_rim){(int16_t)at, (int16_t)mate, (int8_t)i, (int8_t)turned};
    }
    return 0;
}

/* Does any of the faces that part the ends stop it? It meets none of the others, for they do not
 * meet the shaft. */
static int stops(const struct sight_between *b, const struct exchange_tree *t,
                 const signed char *front, double ray[2][3])
{
    double along[3];
    sub3(along, ray[1], ray[0]);
    for (int i = 0; i < b->faces; i++) {
        const struct element *e = &t->h.elements[b->list[i]];
        if (front[i] && hidden_through(ray[0], along, (const double(*)[3])e->vertex, e->vertices))
            return 1;
    }
    return 0;
}

/* Where no edge is an outline one ray between the ends speaks for all; but edges that count as one
 * may leave a joint between them, and the first ray, between two middles, lie in it. So it is asked
 * of two more, which have nothing in common with the scene's symmetries. */
static int stops_all(const struct sight_between *b, const struct exchange_tree *t,
                     const struct shaft *shaft, const signed char *front)
{
    static const double off[3][2] = {{0, 0}, {0.37, 0.29}, {0.61, 0.53}};
    double middle[2][3], ray[2][3];
    hidden_middle(shaft, middle);
    for (int line = 0; line < 3; line++) {
        for (int end = 0; end < 2; end++) {
            const double *corner = shaft->end[end][(line + end) % shaft->points[end]];
            for (int k = 0; k < 3; k++)
                ray[end][k] = middle[end][k] + off[line][end] * (corner[k] - middle[end][k]);
        }
        if (stops(b, t, front, ray))
            return 1;
    }
    return 0;
}

enum between sight_between_find(struct sight_between *b, const struct exchange_tree *t,
                                const struct shaft *shaft, const uint32_t *list, int count,
                                int near)
{
    signed char front[SIGHT_LIST];
    b->faces = b->rims = b->bent = 0;
    b->flat = shaft->flat;
    for (int i = 0; i < count; i++) {
        const struct element *e = &t->h.elements[list[i]];
        if (!near && shaft_far(shaft, (const double(*)[3])e->vertex, e->vertices))
            continue;
        front[b->faces] = (signed char)hidden_front(shaft, e);
        if (!front[b->faces] && !candidates_parted(&t->h, shaft, t->host.ray_offset, list[i]))
            continue;
        if (hidden_bent(e, t->host.flat)) { /* edges and planes tell two outlines */
            if (!front[b->faces] && !candidates_meets(&t->h, shaft, t->host.ray_offset, list[i]))
                continue;
            b->bent = 1;
        }
        b->list[b->faces++] = list[i];
    }
    make_places(b);
    for (int i = 0; i < b->faces; i++)
        if (add_rims(b, t, shaft, front, i) < 0)
            return BETWEEN_MANY;
    if (b->rims > 0)
        return BETWEEN_SOME;
    for (int i = 0; i < b->faces; i++)
        if (!front[i] && candidates_meets(&t->h, shaft, t->host.ray_offset, b->list[i]))
            return BETWEEN_SOME;
    return stops_all(b, t, shaft, front) ? BETWEEN_ALL : BETWEEN_NOTHING;
}

/* ---- in the plane's coordinates */

static void make_face(struct sight_between *b, int at, const struct element *e,
                      const struct outline_frame *f)
{
    struct sight_faces *block = &b->block[at / SIGHT_BOXED];
    const int lane = at % SIGHT_BOXED;
    double p[3], n[3] = {dot3(e->normal, f->u), dot3(e->normal, f->v), dot3(e->normal, f->n)};
    if (lane == 0)
        memset(block, 0, sizeof *block);
    for (int i = 0; i < SIGHT_CORNERS; i++) {
        if (i < e->vertices)
            sight_in_plane(f, e->vertex[i], p);
        for (int k = 0; k < 3; k++)
            block->v[i][k][lane] = p[k];
        if (i == 0)
            block->plane[3][lane] = dot3(n, p);
    }
    for (int k = 0; k < 3; k++)
        block->plane[k][lane] = n[k];
}

static void corner_of(const struct sight_between *b, int at, int corner, double p[3])
{
    for (int k = 0; k < 3; k++)
        p[k] = b->block[at / SIGHT_BOXED].v[corner][k][at % SIGHT_BOXED];
}

static void plane_of(const struct sight_between *b, int at, double plane[4])
{
    for (int k = 0; k < 4; k++)
        plane[k] = b->block[at / SIGHT_BOXED].plane[k][at % SIGHT_BOXED];
}

/* The next edge, from p to q, between two planes. Returns -1 when there are too many. */
static int add_edge(struct sight_between *b, const double p[3], const double q[3],
                    const double planes[2][4])
{
    if (b->edges == SIGHT_EDGES)
        return -1;
    sight_edge_put(b->edge, b->edges++, p, q, planes[0], planes[1]);
    return 0;
}

/* Of an edge that is an outline from anywhere: all is over the one plane and under the other. */
static const double ANYWHERE[2][4] = {{0, 0, 0, -1}, {0, 0, 0, 1}};

/* The line along which a face of n corners meets the plane, if it crosses it: its shadow ends
 * there.
 */
static int add_foot(struct sight_between *b, int at, int n)
{
    double end[2][3] = {{0}}, last[3], next[3];
    int found = 0;
    corner_of(b, at, n - 1, last);
    for (int i = 0; i < n; i++) {
        corner_of(b, at, i, next);
        double g = last[2], h = next[2];
        if ((g > 0) != (h > 0) && found < 2) {
            for (int k = 0; k < 2; k++)
                end[found][k] = last[k] + g / (g - h) * (next[k] - last[k]);
            found++;
        }
        memcpy(last, next, sizeof last);
    }
    if (found < 2)
        return 0;
    b->loose++;
    return add_edge(b, end[0], end[1], ANYWHERE);
}

static int put_rim(struct sight_between *b, const struct sight_rim *rim, int n)
{
    double p[3], q[3], planes[2][4];
    corner_of(b, rim->at, rim->corner, p);
    corner_of(b, rim->at, rim->corner + 1 < n ? rim->corner + 1 : 0, q);
    if (rim->mate < 0) {
        b->loose++;
        return add_edge(b, p, q, ANYWHERE);
    }
    plane_of(b, rim->at, planes[0]);
    plane_of(b, rim->mate, planes[1]);
    for (int k = 0; k < 4 && rim->turned; k++)
        planes[1][k] = -planes[1][k];
    return add_edge(b, p, q, (const double(*)[4])planes);
}

/* Boxes around the faces of a block, which stand in the list as in the tree: neighbours are near
 * each other. Larger by more than rounding. */
static void make_boxes(struct sight_between *b, double more)
{
    for (int at = 0; at < b->faces; at += SIGHT_BOXED) {
        struct sight_faces *block = &b->block[at / SIGHT_BOXED];
        const int count = b->faces - at < SIGHT_BOXED ? b->faces - at : SIGHT_BOXED;
        for (int k = 0; k < 3; k++) {
            double low = block->v[0][k][0], high = low;
            for (int c = 0; c < SIGHT_CORNERS; c++)
                for (int i = 0; i < count; i++) {
                    const double x = block->v[c][k][i];
                    low = x < low ? x : low;
                    high = x > high ? x : high;
                }
            block->low[k] = low - more;
            block->high[k] = high + more;
        }
    }
}

int sight_between_place(struct sight_between *b, const struct exchange_tree *t,
                        const struct sight *sight)
{
    b->edges = b->loose = 0;
    for (int i = 0; i < b->faces; i++)
        make_face(b, i, &t->h.elements[b->list[i]], &sight->raised);
    for (int i = 0, rim = 0; i < b->faces; i++) {
        const int n = t->h.elements[b->list[i]].vertices;
        for (; rim < b->rims && b->rim[rim].at == i; rim++)
            if (put_rim(b, &b->rim[rim], n) < 0)
                return -1;
        if (add_foot(b, i, n) < 0)
            return -1;
    }
    make_boxes(b, b->flat);
    /* measured: with three edges for two faces a point takes as long as 100 rays, with four 10,000
     */
    return b->faces > SIGHT_CUT && (b->bent || 2 * b->edges > 3 * b->faces) ? -1 : 0;
}
