/* crossing.c - see crossing.h.
 *
 * The plane is divided into bands at the heights of all corners and crossings; within a band edges
 * neither end nor cross, so from left to right they say where the outline is gone round. What is
 * between two edges, over all the bands in which it is the same two, is one part. [Lorenz; as
 * scan conversion of polygons, Foley et al. 1990, 3.6]
 *
 * Invariant: parts are disjoint, and their corners lie on edges of the outline, so that what was
 * bent stays on it.
 * SPDX-License-Identifier: MIT */
#include "hierarchy/crossing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry.h"
#include "kernel/constants.h"
#include "util/array.h"

/* An edge from its lower end to its upper one, in the plane (m). */
struct edge {
    double x[2], y[2];
    const double *end[2];
    int up; /* 1: so the outline runs; -1: the other way */
};

struct scan {
    struct edge *edges; /* [edge_count]: those that are not level, by their lower ends */
    uint32_t edge_count, next;
    double *heights; /* [height_count] */
    size_t height_count, height_capacity;
    uint32_t *across; /* [across_count]: edges that cross the band, from left to right */
    uint32_t across_count;
    /* between which edges parts are open, and from which height on; of this band and the last */
    struct open_part {
        uint32_t left, right;
        double from;
    } * open[2];
    uint32_t open_count[2];
};

double crossing_normal(double (*vertex)[3], uint32_t count, double normal[3])
{
    double most = 0;
    memset(normal, 0, 3 * sizeof *normal);
    for (uint32_t i = 1; i + 1 < count; i++) {
        double a[3], b[3], c[3];
        sub3(a, vertex[i], vertex[0]);
        sub3(b, vertex[i + 1], vertex[0]);
        cross3(c, a, b);
        double twice = length3(c);
        if (twice > most) {
            most = twice;
            for (int k = 0; k < 3; k++)
                normal[k] = c[k] / twice;
        }
    }
    return most / 2;
}

static int add_height(struct scan *s, double y)
{
    if (array_reserve(&s->heights, s->height_count + 1, &s->height_capacity, sizeof *s->heights)
        < 0)
        return -1;
    s->heights[s->height_count++] = y;
    return 0;
}

static double x_at(const struct edge *e, double y)
{
    return e->x[0] + (y - e->y[0]) / (e->y[1] - e->y[0]) * (e->x[1] - e->x[0]);
}

/* Heights of corners and of crossings, in order. Returns 0 or -1. */
static int find_heights(struct scan *s)
{
    for (uint32_t i = 0; i < s->edge_count; i++) {
        const struct edge *a = &s->edges[i];
        if (add_height(s, a->y[0]) || add_height(s, a->y[1]))
            return -1;
        for (uint32_t j = i + 1; j < s->edge_count && s->edges[j].y[0] < a->y[1]; j++) {
            const struct edge *b = &s->edges[j];
            double low = fmax(a->y[0], b->y[0]), high = fmin(a->y[1], b->y[1]);
            if (!(low < high))
                continue;
            double below = x_at(a, low) - x_at(b, low), above = x_at(a, high) - x_at(b, high);
            if (((below < 0 && above > 0) || (below > 0 && above < 0))
                && add_height(s, low + below / (below - above) * (high - low)))
                return -1;
        }
    }
    return 0;
}

static int by_lower_end(const void *a, const void *b)
{
    const struct edge *x = a, *y = b;
    if (x->y[0] < y->y[0] || x->y[0] > y->y[0])
        return x->y[0] < y->y[0] ? -1 : 1;
    int k = x->end[0] == y->end[0];
    return (x->end[k] > y->end[k]) - (x->end[k] < y->end[k]);
}

static void point_at(const struct edge *e, double y, double point[3])
{
    double t = (y - e->y[0]) / (e->y[1] - e->y[0]);
    for (int k = 0; k < 3; k++)
        point[k] = t <= 0   ? e->end[0][k]
                   : t >= 1 ? e->end[1][k]
                            : e->end[0][k] + t * (e->end[1][k] - e->end[0][k]);
}

/* An open part ends at y. Returns 0 or -1. */
static int end_part(const struct scan *s, const struct open_part *o, double y,
                    struct round_parts *parts, double touch)
{
    const struct edge *left = &s->edges[o->left], *right = &s->edges[o->right];
    if (array_reserve(&parts->parts, parts->count + 1, &parts->capacity, sizeof *parts->parts) < 0)
        return -1;
    struct round_part *p = &parts->parts[parts->count++];
    p->n = 0;
    point_at(left, o->from, p->vertex[p->n++]);
    if (x_at(right, o->from) - x_at(left, o->from) > touch)
        point_at(right, o->from, p->vertex[p->n++]);
    point_at(right, y, p->vertex[p->n++]);
    if (x_at(right, y) - x_at(left, y) > touch)
        point_at(left, y, p->vertex[p->n++]);
    parts->count -= p->n < 3;
    return 0;
}

/* The edges across a band, by their places in its middle: those of the last band that go on, which
 * are nearly in order, and those that begin. */
static void edges_across(struct scan *s, double middle)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < s->across_count; i++)
        if (s->edges[s->across[i]].y[1] > middle)
            s->across[n++] = s->across[i];
    for (; s->next < s->edge_count && s->edges[s->next].y[0] < middle; s->next++)
        if (s->edges[s->next].y[1] > middle)
            s->across[n++] = s->next;
    for (uint32_t i = 1; i < n; i++) {
        uint32_t edge = s->across[i], at = i;
        double x = x_at(&s->edges[edge], middle);
        for (; at && x_at(&s->edges[s->across[at - 1]], middle) > x; at--)
            s->across[at] = s->across[at - 1];
        s->across[at] = edge;
    }
    s->across_count = n;
}

/* The parts of the band from `from` to `to`: those that go on stay open. Returns 0 or -1. */
static int scan_band(struct scan *s, double from, double to, struct round_parts *parts,
                     double touch)
{
    uint32_t left = 0, count = 0;
    struct open_part *now = s->open[1];
    int round = 0;
    edges_across(s, from + (to - from) / 2);
    for (uint32_t i = 0; i < s->across_count; i++) {
        int before = round;
        round += s->edges[s->across[i]].up;
        if (!before)
            left = s->across[i];
        else if (!round)
            now[count++] = (struct open_part){left, s->across[i], from};
    }
    /* Both lists run from left to right: what goes on stands behind what was found last. */
    for (uint32_t i = 0, at = 0; i < s->open_count[0]; i++) {
        struct open_part *o = &s->open[0][i];
        uint32_t tried = 0;
        for (; tried < count && (now[at].left != o->left || now[at].right != o->right); tried++)
            at = at + 1 < count ? at + 1 : 0;
        if (tried < count)
            now[at].from = o->from;
        else if (end_part(s, o, from, parts, touch))
            return -1;
    }
    s->open[1] = s->open[0];
    s->open[0] = now;
    s->open_count[0] = count;
    return 0;
}

static int scan_bands(struct scan *s, struct round_parts *parts, double touch)
{
    qsort(s->edges, s->edge_count, sizeof *s->edges, by_lower_end);
    if (find_heights(s))
        return -1;
    qsort(s->heights, s->height_count, sizeof *s->heights, compare_numbers);
    double from = s->height_count ? s->heights[0] : 0;
    for (size_t i = 1; i < s->height_count; i++)
        if (s->heights[i] > from + touch) {
            if (scan_band(s, from, s->heights[i], parts, touch))
                return -1;
            from = s->heights[i];
        }
    for (uint32_t i = 0; i < s->open_count[0]; i++)
        if (end_part(s, &s->open[0][i], from, parts, touch))
            return -1;
    return 0;
}

int crossing_parts(struct round_parts *parts, double (*vertex)[3], uint32_t count,
                   const double normal[3])
{
    struct scan s = {
        .edges = malloc(count * sizeof *s.edges),
        .across = malloc(count * sizeof *s.across),
        .open = {malloc(count * sizeof *s.open[0]), malloc(count * sizeof *s.open[0])}};
    double x[3], y[3], size = 0;
    int axis = fabs(normal[0]) < fabs(normal[1]) ? 0 : 1, result = -1;
    axis = fabs(normal[2]) < fabs(normal[axis]) ? 2 : axis;
    const double away[3] = {axis == 0, axis == 1, axis == 2};
    cross3(x, away, normal);
    double length = length3(x);
    for (int k = 0; k < 3; k++)
        x[k] /= length;
    cross3(y, normal, x);
    parts->count = 0;
    if (s.edges && s.across && s.open[0] && s.open[1]) {
        for (uint32_t i = 0; i < count; i++) {
            const double *end[2] = {vertex[i], vertex[(i + 1) % count]};
            double px[2], py[2];
            for (int k = 0; k < 2; k++) {
                px[k] = height3(end[k], vertex[0], x);
                py[k] = height3(end[k], vertex[0], y);
            }
            int low = py[0] > py[1];
            size = fmax(size, fmax(fabs(px[0]), fabs(py[0])));
            if (py[0] < py[1] || py[0] > py[1])
                s.edges[s.edge_count++] = (struct edge){.x = {px[low], px[!low]},
                                                        .y = {py[low], py[!low]},
                                                        .end = {end[low], end[!low]},
                                                        .up = low ? 1 : -1};
        }
        result = scan_bands(&s, parts, CROSSING_TOUCH * size);
    }
    free(s.edges);
    free(s.heights);
    free(s.across);
    free(s.open[0]);
    free(s.open[1]);
    return result;
}
