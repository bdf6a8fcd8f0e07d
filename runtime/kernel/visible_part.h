/* visible_part.h - the visible fraction of the light between two surfaces when at most two convex
 * faces stand between them.
 *
 * From a point x of r, what a face Q hides of s is the part of s within the pyramid of x over Q and
 * beyond Q's plane: a convex polygon, whose form factor from x Lambert's formula gives. So with two
 * faces
 *   V = 1 - (1 / A_r F_rs) int over r of [F(s_1) + F(s_2) - F(s_12)] dA,
 * s_i hidden by face i, s_12 by both. Dimensionless, in [0, 1].
 *
 * The integrand has kinks where the shadow of an edge or corner passes a corner or edge of s: on
 * the planes through an edge of the one and a corner of the other. r is cut along all of them;
 * within a cell the shadow of one face has the same corners everywhere, so that a shadow which is
 * empty at the cell's centre is empty in the cell, and a seven-point rule [Radon 1948] on
 * triangles, halved until they agree, converges fast. Error below 1e-6 of A_r F_rs, but for depth:
 * a triangle is quartered ten times at most. With two faces kinks remain where their shadows' edges
 * cross; they are found by the halving. Integrates over the smaller surface, so the result is the
 * same both ways, to the bit.
 * [Lambert 1760; Heckbert 1992 and Drettakis & Fiume 1994 for the critical lines; integral: derived
 * here]
 * Fails: more than two faces, bent quads (returns -1); faces that touch r, where the integrand has
 * no bounded derivative: the error may then be 1e-5.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_VISIBLE_PART_H
#define KERNEL_VISIBLE_PART_H

#include "discussion.h"
#include "kernel/constants.h"
#include "kernel/cut.h"
#include "kernel/polygon_factor.h"
#include "kernel/shaft.h"

enum {
    VISIBLE_PART_FACES = 2,
    VISIBLE_PART_DEPTH = 10,
    VISIBLE_PART_PLANES = VISIBLE_PART_FACES * (2 * 4 * POLYGON_MAX + 1)
};

struct visible_part {
    struct cut source;
    double normal[3]; /* of the surface integrated over */
    int faces, planes;
    struct {
        int n;
        double v[4][3], normal[3];
    } face[VISIBLE_PART_FACES];
    double on[VISIBLE_PART_PLANES][3], across[VISIBLE_PART_PLANES][3]; /* the planes of the kinks */
    double tolerance;                                                  /* per area */
    double near; /* cells are not cut off thinner than this (m) */
};

/* What face f hides of *from, seen from x. */
static inline void visible_part_hidden(const struct visible_part *p, int f, const double x[3],
                                       const struct cut *from, struct cut *out)
{
    const double(*v)[3] = (const double(*)[3])p->face[f].v, *normal = p->face[f].normal;
    double a[3], b[3], c[3], h = height3(x, v[0], normal), turn = h > 0 ? 1 : -1;
    int n = p->face[f].n, now = 0;
    out->n = 0;
    if (!(fabs(h) > 0))
        return;
    struct cut part[2];
    part[0] = *from;
    for (int i = 0; i < n && part[now].n > 0; i++) {
        sub3(a, v[i], x);
        sub3(b, v[i + 1 < n ? i + 1 : 0], x);
        cross3(c, a, b);
        for (int k = 0; k < 3; k++)
            c[k] *= turn;
        now ^= !cut_below(&part[now ^ 1], &part[now], x, c, 0);
    }
    for (int k = 0; k < 3; k++)
        c[k] = turn * normal[k];
    if (part[now].n > 0)
        now ^= !cut_below(&part[now ^ 1], &part[now], v[0], c, 0);
    *out = part[now];
}

/* The form factor from x to all that is hidden. */
static inline double visible_part_shadow(const struct visible_part *p, const double x[3])
{
    struct cut hidden;
    visible_part_hidden(p, 0, x, &p->source, &hidden);
    double sum = lambert_sum(x, p->normal, (const double(*)[3])hidden.v, hidden.n);
    if (p->faces > 1) {
        struct cut both;
        if (hidden.n > 2) {
            visible_part_hidden(p, 1, x, &hidden, &both);
            sum -= lambert_sum(x, p->normal, (const double(*)[3])both.v, both.n);
        }
        visible_part_hidden(p, 1, x, &p->source, &both);
        sum += lambert_sum(x, p->normal, (const double(*)[3])both.v, both.n);
    }
    return sum;
}

/* The mean over a triangle. */
static inline double visible_part_rule(const struct visible_part *p, const double *a,
                                       const double *b, const double *c)
{
    static const double corner[2] = {0.059715871789769820, 0.79742698535308732};
    static const double weight[2] = {0.13239415278850618, 0.12593918054482715};
    double x[3];
    for (int k = 0; k < 3; k++)
        x[k] = (a[k] + b[k] + c[k]) * (1 / 3.0);
    double sum = 0.225 * visible_part_shadow(p, x);
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 3; j++) {
            const double *u = j == 0   ? a
                              : j == 1 ? b
                                       : c,
                         *v = j == 0   ? b
                              : j == 1 ? c
                                       : a,
                         *w = j == 0   ? c
                              : j == 1 ? a
                                       : b;
            double other = 0.5 * (1 - corner[i]);
            for (int k = 0; k < 3; k++)
                x[k] = corner[i] * u[k] + other * (v[k] + w[k]);
            sum += weight[i] * visible_part_shadow(p, x);
        }
    return sum;
}

static inline double visible_part_adapt(const struct visible_part *p, const double *a,
                                        const double *b, const double *c, double mean, int depth)
{
    double m[3][3], quarter[4], sum = 0;
    for (int k = 0; k < 3; k++) {
        m[0][k] = 0.5 * (b[k] + c[k]);
        m[1][k] = 0.5 * (c[k] + a[k]);
        m[2][k] = 0.5 * (a[k] + b[k]);
    }
    quarter[0] = visible_part_rule(p, a, m[2], m[1]);
    quarter[1] = visible_part_rule(p, m[2], b, m[0]);
    quarter[2] = visible_part_rule(p, m[1], m[0], c);
    quarter[3] = visible_part_rule(p, m[0], m[1], m[2]);
    for (int i = 0; i < 4; i++)
        sum += 0.25 * quarter[i];
    if (depth == 0 || fabs(sum - mean) <= p->tolerance)
        return sum;
    return 0.25
           * (visible_part_adapt(p, a, m[2], m[1], quarter[0], depth - 1)
              + visible_part_adapt(p, m[2], b, m[0], quarter[1], depth - 1)
              + visible_part_adapt(p, m[1], m[0], c, quarter[2], depth - 1)
              + visible_part_adapt(p, m[0], m[1], m[2], quarter[3], depth - 1));
}

/* The integral over one cell. */
static inline double visible_part_cell(const struct visible_part *p, const struct cut *cell)
{
    double centre[3] = {0, 0, 0}, sum = 0;
    int dark = 0;
    for (int i = 0; i < cell->n; i++)
        for (int k = 0; k < 3; k++)
            centre[k] += cell->v[i][k] / cell->n;
    struct cut hidden;
    for (int f = 0; f < p->faces; f++) {
        visible_part_hidden(p, f, centre, &p->source, &hidden);
        dark |= hidden.n > 2;
    }
    for (int i = 2; i < cell->n && dark; i++) {
        const double *a = cell->v[0], *b = cell->v[i - 1], *c = cell->v[i];
        double u[3], v[3], w[3];
        sub3(u, b, a);
        sub3(v, c, a);
        cross3(w, u, v);
        sum += 0.5 * length3(w)
               * visible_part_adapt(p, a, b, c, visible_part_rule(p, a, b, c), VISIBLE_PART_DEPTH);
    }
    return sum;
}

/* The same over a polygon cut by the planes from k on. */
static inline double visible_part_cells(const struct visible_part *p, const struct cut *cell,
                                        int plane)
{
    for (; plane < p->planes && cell->n < CUT_MAX; plane++) {
        const double *on = p->on[plane], *n = p->across[plane];
        double low = INFINITY, high = -INFINITY, back[3];
        for (int i = 0; i < cell->n; i++) {
            double h = height3(cell->v[i], on, n);
            low = h < low ? h : low;
            high = h > high ? h : high;
        }
        if (!(low < -p->near && high > p->near))
            continue;
        for (int i = 0; i < 3; i++)
            back[i] = -n[i];
        struct cut part[2];
        (void)cut_below(&part[0], cell, on, n, 0);
        (void)cut_below(&part[1], cell, on, back, 0);
        return visible_part_cells(p, &part[0], plane + 1)
               + visible_part_cells(p, &part[1], plane + 1);
    }
    return visible_part_cell(p, cell);
}

static inline void visible_part_plane(struct visible_part *p, const double on[3],
                                      const double normal[3])
{
    double size = length3(normal);
    if (!(size > 0))
        return;
    for (int k = 0; k < 3; k++) {
        p->on[p->planes][k] = on[k];
        p->across[p->planes][k] = normal[k] / size;
    }
    p->planes++;
}

/* The planes through an edge of v and a corner of w. */
static inline void visible_part_kinks(struct visible_part *p, const double (*v)[3], int n,
                                      const double (*w)[3], int m)
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j < m; j++) {
            double e[3], g[3], normal[3];
            sub3(e, v[i + 1 < n ? i + 1 : 0], v[i]);
            sub3(g, w[j], v[i]);
            cross3(normal, e, g);
            if (dot3(normal, normal) > VISIBLE_PART_LINE * dot3(e, e) * dot3(g, g))
                visible_part_plane(p, v[i], normal);
        }
}

/* Can a face that lies in the plane of e stop light to or from e? No. */
static inline int visible_part_lies_in(const struct element *e, const double on[3],
                                       const double normal[3], double flat)
{
    int lies = 1;
    for (int i = 0; i < e->vertices; i++)
        lies &= fabs(height3(e->vertex[i], on, normal)) <= flat;
    return lies;
}

/* The visible fraction, or -1 when the faces are too many or bent. */
OUTLINE double visible_part_fraction(const struct element *r, const struct element *s,
                                     const struct host *host, const struct blockers *list)
{
    int r_is_small = r->radius < s->radius || (r->radius == s->radius && r->id < s->id);
    const struct element *small = r_is_small ? r : s, *large = r_is_small ? s : r;
    struct visible_part part;
    struct polygon p, q;
    part.faces = part.planes = 0;
    for (int i = 0; i < list->count; i++) {
        struct polygon face;
        host->corners(host, list->face[i], &face);
        double normal[3];
        if (!shaft_normal((const double(*)[3])face.v, face.n, normal)
            || visible_part_lies_in(r, face.v[0], normal, host->flat)
            || visible_part_lies_in(s, face.v[0], normal, host->flat))
            continue;
        if (part.faces == VISIBLE_PART_FACES
            || (face.n == 4
                && fabs(height3(face.v[1], face.v[0], normal)) > host->ray_offset * SHAFT_BENT))
            return -1;
        for (int k = 0; k < 3; k++) {
            part.face[part.faces].normal[k] = normal[k];
            for (int j = 0; j < face.n; j++)
                part.face[part.faces].v[j][k] = face.v[j][k];
        }
        part.face[part.faces++].n = face.n;
    }
    if (part.faces == 0)
        return 1;
    double exchange = small->area * polygon_factor(small, large, 1);
    polygon_clip(&p, (const double(*)[3])small->vertex, small->vertices, large->centre,
                 large->normal);
    polygon_clip(&q, (const double(*)[3])large->vertex, large->vertices, small->centre,
                 small->normal);
    if (p.n == 0 || q.n == 0 || !(exchange > 0))
        return -1;
    struct cut cell;
    cut_from(&cell, (const double(*)[3])p.v, p.n);
    cut_from(&part.source, (const double(*)[3])q.v, q.n);
    for (int k = 0; k < 3; k++)
        part.normal[k] = small->normal[k];
    part.tolerance = VISIBLE_PART_ERROR * exchange / small->area;
    part.near = VISIBLE_PART_NEAR * small->radius;
    for (int i = 0; i < part.faces; i++) {
        const double(*v)[3] = (const double(*)[3])part.face[i].v;
        visible_part_plane(&part, v[0], part.face[i].normal);
        visible_part_kinks(&part, v, part.face[i].n, (const double(*)[3])q.v, q.n);
        visible_part_kinks(&part, (const double(*)[3])q.v, q.n, v, part.face[i].n);
    }
    double hidden = visible_part_cells(&part, &cell, 0) / exchange;
    return hidden < VISIBLE_PART_NONE ? 1 : hidden > 1 - VISIBLE_PART_NONE ? 0 : 1 - hidden;
}

#endif
