/* polygon.c - see polygon.h.
 *
 * Ear clipping [Meisters 1975]: a polygon always has a corner whose triangle no edge enters; cut
 * it off and go on. Among the ears we take the one with the shortest cut, which keeps the
 * triangles of convex polygons from degenerating into slivers. Rings that a bridge joins to a hole
 * pass some corners and edges twice: so it is edges that are tested, against the open triangle.
 * Invariant: the ring and the triangles cut off make up the polygon's area.
 * SPDX-License-Identifier: MIT */
#include "hierarchy/polygon.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry.h"
#include "kernel/constants.h"

double polygon_normal(double (*vertex)[3], uint32_t count, double normal[3])
{
    double sum[3] = {0, 0, 0};
    for (uint32_t i = 1; i + 1 < count; i++) {
        /* Relative to the first corner, so that a far origin costs no digits. */
        double a[3], b[3], c[3];
        sub3(a, vertex[i], vertex[0]);
        sub3(b, vertex[i + 1], vertex[0]);
        cross3(c, a, b);
        for (int k = 0; k < 3; k++)
            sum[k] += c[k];
    }
    double twice = length3(sum);
    for (int k = 0; k < 3; k++)
        normal[k] = twice > 0 ? sum[k] / twice : 0;
    return twice / 2;
}

double polygon_size(double (*vertex)[3], uint32_t count)
{
    /* Beyond 64 corners the box's diagonal is near enough, and n is not squared. */
    double size = 0, low[3], high[3], diagonal[3];
    if (count <= 64) {
        for (uint32_t i = 0; i < count; i++)
            for (uint32_t j = 0; j < i; j++) {
                double d[3];
                sub3(d, vertex[i], vertex[j]);
                size = fmax(size, length3(d));
            }
        return size;
    }
    for (int k = 0; k < 3; k++) {
        low[k] = high[k] = vertex[0][k];
        for (uint32_t i = 1; i < count; i++) {
            low[k] = fmin(low[k], vertex[i][k]);
            high[k] = fmax(high[k], vertex[i][k]);
        }
    }
    sub3(diagonal, high, low);
    return length3(diagonal);
}

int polygon_degenerate(double (*vertex)[3], uint32_t count, double precision)
{
    if (count < 3)
        return 1;
    double normal[3], largest = 0, size = polygon_size(vertex, count);
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            largest = fmax(largest, fabs(vertex[i][k]));
    double area = polygon_normal(vertex, count, normal);
    return !(area > SCENE_THIN * size * size
             && area > SCENE_THIN_ROUNDINGS * precision * largest * size);
}

int polygon_flat(double (*vertex)[3], uint32_t count, double tolerance)
{
    double normal[3], centre[3] = {0, 0, 0};
    polygon_normal(vertex, count, normal);
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            centre[k] += vertex[i][k] / count;
    for (uint32_t i = 0; i < count; i++) {
        double d[3];
        sub3(d, vertex[i], centre);
        if (fabs(dot3(d, normal)) > tolerance)
            return 0;
    }
    return 1;
}

int polygon_convex_quad(double (*vertex)[3])
{
    double normal[3];
    polygon_normal(vertex, 4, normal);
    for (int i = 0; i < 4; i++) {
        double a[3], b[3], c[3];
        sub3(a, vertex[(i + 1) % 4], vertex[i]);
        sub3(b, vertex[(i + 2) % 4], vertex[(i + 1) % 4]);
        cross3(c, a, b);
        if (dot3(c, normal) < -1e-6 * length3(a) * length3(b))
            return 0;
    }
    return 1;
}

/* An edge in the plane of two axes. */
struct flat_edge {
    double from[2], to[2], low, high; /* low, high: along the first axis */
    uint32_t at;
};

static int by_low(const void *a, const void *b)
{
    const struct flat_edge *x = a, *y = b;
    return (x->low > y->low) - (x->low < y->low);
}

/* Are both ends of an edge to one side of another? */
static int is_beside(const struct flat_edge *e, const struct flat_edge *line)
{
    double x = line->to[0] - line->from[0], y = line->to[1] - line->from[1],
           from = x * (e->from[1] - line->from[1]) - y * (e->from[0] - line->from[0]),
           to = x * (e->to[1] - line->from[1]) - y * (e->to[0] - line->from[0]);
    return (from > 0 && to > 0) || (from < 0 && to < 0);
}

static int is_apart(const struct flat_edge *a, const struct flat_edge *b, uint32_t count)
{
    uint32_t gap = a->at > b->at ? a->at - b->at : b->at - a->at;
    return gap == 1 || gap == count - 1 || fmin(a->from[1], a->to[1]) > fmax(b->from[1], b->to[1])
           || fmax(a->from[1], a->to[1]) < fmin(b->from[1], b->to[1]) || is_beside(a, b)
           || is_beside(b, a);
}

int polygon_simple(double (*vertex)[3], uint32_t count)
{
    double normal[3];
    polygon_normal(vertex, count, normal);
    int axis = 0, simple = 1;
    for (int k = 1; k < 3; k++)
        axis = fabs(normal[k]) > fabs(normal[axis]) ? k : axis;
    struct flat_edge *edges = malloc(count * sizeof *edges);
    if (!edges)
        return 0;
    for (uint32_t i = 0; i < count; i++) {
        struct flat_edge *e = &edges[i];
        for (int k = 0; k < 2; k++) {
            e->from[k] = vertex[i][(axis + 1 + k) % 3];
            e->to[k] = vertex[i + 1 < count ? i + 1 : 0][(axis + 1 + k) % 3];
        }
        e->low = fmin(e->from[0], e->to[0]);
        e->high = fmax(e->from[0], e->to[0]);
        e->at = i;
    }
    qsort(edges, count, sizeof *edges, by_low);
    for (uint32_t i = 0; i < count && simple; i++)
        for (uint32_t j = i + 1; j < count && edges[j].low <= edges[i].high && simple; j++)
            simple = is_apart(&edges[i], &edges[j], count);
    free(edges);
    return simple;
}

/* A ring of corners that triangles are cut off. */
struct ring {
    double (*vertex)[3];
    uint32_t *corner, count;
    double normal[3];
    double rounding; /* no farther than that from a line is on it (m) */
};

static const double *at(const struct ring *r, uint32_t i)
{
    return r->vertex[r->corner[i % r->count]];
}

/* Twice the area of a, b, c: positive in the ring's sense of rotation, 0 when c is on the line. */
static double side(const struct ring *r, const double a[3], const double b[3], const double c[3])
{
    double u[3], v[3], w[3];
    sub3(u, b, a);
    sub3(v, c, a);
    cross3(w, u, v);
    double twice = dot3(w, r->normal);
    return fabs(twice) <= r->rounding * length3(u) ? 0 : twice;
}

/* Does the edge from p to q enter what is on the positive side of all three lines? Given are the
 * sides of both. */
static int enters(const double p[3], const double q[3])
{
    double from = 0, to = 1;
    for (int k = 0; k < 3; k++) {
        if (p[k] <= 0 && q[k] <= 0)
            return 0;
        if (p[k] < 0)
            from = fmax(from, p[k] / (p[k] - q[k]));
        else if (q[k] < 0)
            to = fmin(to, p[k] / (p[k] - q[k]));
    }
    return to - from > DBL_EPSILON;
}

/* A triangle at the ring's border, and its box, wider by what rounding may do. */
struct tip {
    const double *corner[3];
    double low[3], high[3];
};

static struct tip tip_at(const struct ring *r, uint32_t i)
{
    struct tip t = {.corner = {at(r, i + r->count - 1), at(r, i), at(r, i + 1)}};
    for (int k = 0; k < 3; k++) {
        const double a = t.corner[0][k], b = t.corner[1][k], c = t.corner[2][k];
        t.low[k] = fmin(a, fmin(b, c)) - r->rounding;
        t.high[k] = fmax(a, fmax(b, c)) + r->rounding;
    }
    return t;
}

/* The sides of the box that a point lies beyond, a bit each. */
static unsigned beyond(const struct tip *t, const double p[3])
{
    unsigned sides = 0;
    for (int k = 0; k < 3; k++)
        sides |=
            (unsigned)(p[k] < t->low[k]) << 2 * k | (unsigned)(p[k] > t->high[k]) << (2 * k + 1);
    return sides;
}

/* On which sides of the triangle's lines a point lies. */
static void sides_of(const struct ring *r, const struct tip *t, const double p[3], double sides[3])
{
    for (int k = 0; k < 3; k++)
        sides[k] = side(r, t->corner[k], t->corner[(k + 1) % 3], p);
}

/* Is the triangle at place i an ear? From its end on to its begin no edge may enter, and no corner
 * stand on the cut. Nearly all edges are beyond one side of its box: no more is asked of them. */
static int ear(const struct ring *r, uint32_t i)
{
    const struct tip t = tip_at(r, i);
    const double *last = t.corner[2];
    double from[3] = {0, 0, 0}; /* of `last`, where known */
    unsigned last_beyond = 0;
    int known = 1;
    if (side(r, t.corner[0], t.corner[1], t.corner[2]) <= 0)
        return 0;
    for (uint32_t step = 2, place = (i + 2) % r->count; step < r->count; step++) {
        const double *p = r->vertex[r->corner[place]];
        const unsigned p_beyond = beyond(&t, p);
        if (p_beyond & last_beyond)
            known = 0;
        else {
            double to[3];
            sides_of(r, &t, p, to);
            if (!known)
                sides_of(r, &t, last, from);
            if ((to[0] > 0 && to[1] > 0 && to[2] >= 0) || enters(from, to))
                return 0;
            memcpy(from, to, sizeof from);
            known = 1;
        }
        last = p;
        last_beyond = p_beyond;
        place = place + 1 < r->count ? place + 1 : 0;
    }
    return 1;
}

static void drop(struct ring *r, uint32_t i)
{
    r->count--;
    for (; i < r->count; i++)
        r->corner[i] = r->corner[i + 1];
}

/* Where cutting has left a spike without area, its tip goes; 1: there was one. */
static int drop_spike(struct ring *r, uint32_t i)
{
    const double *a = at(r, i + r->count - 1), *b = at(r, i), *c = at(r, i + 1);
    double u[3], v[3];
    sub3(u, a, b);
    sub3(v, c, b);
    int none = length3(u) <= r->rounding || length3(v) <= r->rounding;
    if (r->count <= 3 || (!none && (dot3(u, v) <= 0 || side(r, a, b, c) != 0)))
        return 0;
    drop(r, i);
    return 1;
}

/* The place to cut: of a few ears the one with the shortest cut. count: there is none. */
static uint32_t find_ear(const struct ring *r, uint32_t start)
{
    uint32_t best = r->count;
    double shortest = INFINITY;
    for (uint32_t step = 0; step < r->count; step++) {
        uint32_t i = (start + step) % r->count;
        double d[3];
        sub3(d, at(r, i + r->count - 1), at(r, i + 1));
        if (!(length3(d) < shortest) || !ear(r, i))
            continue;
        shortest = length3(d);
        best = i;
        if (r->count > 64)
            break; /* the best ear is a luxury that costs n^3 */
    }
    return best;
}

static double corner_side(const struct ring *r, uint32_t i)
{
    return side(r, at(r, i + r->count - 1), at(r, i), at(r, i + 1));
}

/* When only straight or crossing corners are left: the flattest. */
static uint32_t find_flattest(const struct ring *r)
{
    double least = INFINITY;
    uint32_t best = 0;
    for (uint32_t i = 0; i < r->count; i++) {
        double s = fabs(corner_side(r, i));
        if (s < least) {
            least = s;
            best = i;
        }
    }
    return best;
}

uint32_t polygon_triangulate(double (*vertex)[3], uint32_t count, uint32_t (*triangle)[3],
                             uint32_t *scratch)
{
    struct ring r = {.vertex = vertex, .corner = scratch, .count = count};
    uint32_t triangles = 0, start = 0;
    double lost = 0, most = POLYGON_LOST * polygon_normal(vertex, count, r.normal);
    for (uint32_t i = 0; i < count; i++) {
        r.corner[i] = i;
        for (int k = 0; k < 3; k++)
            r.rounding = fmax(r.rounding, POLYGON_ON_LINE * DBL_EPSILON * fabs(vertex[i][k]));
    }
    while (r.count > 3) {
        uint32_t best = find_ear(&r, start);
        int found = best < r.count;
        if (found) {
            triangle[triangles][0] = r.corner[(best + r.count - 1) % r.count];
            triangle[triangles][1] = r.corner[best];
            triangle[triangles++][2] = r.corner[(best + 1) % r.count];
        } else {
            best = find_flattest(&r);
            lost += fabs(corner_side(&r, best)) / 2;
            if (lost > most)
                return 0;
        }
        drop(&r, best);
        start = best % r.count;
        while (
            found
            && (drop_spike(&r, start % r.count) || drop_spike(&r, (start + r.count - 1) % r.count)))
            start = (start + r.count - 1) % r.count;
    }
    for (int k = 0; k < 3; k++)
        triangle[triangles][k] = r.corner[k];
    lost += fmax(0, -corner_side(&r, 1)) / 2;
    return lost > most ? 0 : triangles + 1;
}

uint32_t polygon_pieces(double (*vertex)[3], uint32_t n, double touch, struct piece *piece)
{
    uint32_t ring[POLYGON_CORNERS], rest[POLYGON_CORNERS], count = 0;
    for (uint32_t i = 0; i < n; i++)
        ring[i] = i;
    for (; n > 4; n -= 2) {
        uint32_t best = 0;
        double shortest = INFINITY;
        for (uint32_t i = 0; i < n; i++) {
            double d[3];
            sub3(d, vertex[ring[i]], vertex[ring[(i + 3) % n]]);
            if (length3(d) < shortest - touch) {
                shortest = length3(d);
                best = i;
            }
        }
        for (uint32_t j = 0; j < 4; j++)
            piece[count].corner[j] = ring[(best + j) % n];
        piece[count++].n = 4;
        for (uint32_t j = 3; j <= n; j++)
            rest[j - 3] = ring[(best + j) % n];
        memcpy(ring, rest, sizeof ring);
    }
    memcpy(piece[count].corner, ring, sizeof piece->corner);
    piece[count].n = n;
    return count + 1;
}
