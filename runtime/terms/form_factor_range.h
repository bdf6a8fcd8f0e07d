/* form_factor_range.h - term: the least and the largest F(x) over the points x of the receiver,
 * nothing between: the point-to-polygon factor of point_factor.h. Dimensionless, [0] <= [1], both
 * in [0, 1].
 *
 * sampled  over the receiver's corners and centre. The corners are taken CORNER_INSET of the way to
 *          the centre: where the elements touch, F has no value at the corner itself. Fails: an
 *          extremum between them is not seen.
 * bounded  no F(x) lies outside. With k(x) the height of x over the emitter's plane, h(y) that of y
 *          over the receiver's, F(x) = k(x)/pi int h(y) / |x-y|^4 dy: only k and the distance
 *          depend on x. So, for distances in [d, D], k_min Q/D^4 <= F <= k_max Q/d^4 with
 *          Q = int h / pi; F is at most what the emitter's whole half plane would give,
 *          (1 - n_r.n_s)/2; and with the gradient g at a centre c, R the radius around it,
 *          |F(x) - F(c) - g.(x-c)|
 *              <= 1/2 R^2 (20 F_max/d^2 + 8 kappa min(F_max/(k_min d), Q/d^5)),
 *          kappa = |grad k| along the receiver. Quarters of the receiver, and theirs, are bounded
 *          by themselves where that could matter. Fails: not tight where the two are nearer than an
 *          eighth of the receiver (the upper end is then the half plane's, which is right where
 *          they touch). [D: derived here]
 * SPDX-License-Identifier: MIT */
#ifndef TERM_FORM_FACTOR_RANGE_H
#define TERM_FORM_FACTOR_RANGE_H

#include "discussion.h"
#include "kernel/constants.h"
#include "kernel/corner_factors.h"
#include "kernel/point_factor.h"
#include "kernel/point_gradient.h"

enum { FORM_FACTOR_RANGE_DEPTH = 3 };

struct form_factor_range {
    const struct element *r, *s;
    struct polygon q;  /* the emitter, clipped */
    double share;      /* Q (m3) */
    double lowest;     /* the least h(y) (m) */
    double cap, slope; /* (1 - n_r.n_s)/2; kappa */
    double seen[2];    /* the range of the values found */
    double bound[2];   /* what encloses all pieces so far */
};

OUTLINE void form_factor_range_sample(const struct element *r, const struct element *s,
                                      double range[2])
{
    double f[5];
    int open = corner_factors(r, s, f);
    range[0] = range[1] = f[0];
    if (!open || polygon_factor_hidden(r, s, range[1] * r->area)) {
        range[0] = range[1] = 0;
        return;
    }
    for (int i = 1; i <= r->vertices; i++) {
        range[0] = f[i] < range[0] ? f[i] : range[0];
        range[1] = f[i] > range[1] ? f[i] : range[1];
    }
}

/* A part of the receiver. */
struct form_factor_piece {
    const double (*v)[3];
    int n;
    double c[3], radius; /* its middle, and how far corners are from it (m) */
    double k_min, k_max; /* heights of its corners over the emitter (m) */
};

static inline struct form_factor_piece form_factor_piece_of(const struct form_factor_range *b,
                                                            const double (*v)[3], int n)
{
    struct form_factor_piece p = {.v = v, .n = n, .k_min = INFINITY, .k_max = -INFINITY};
    for (int i = 0; i < n; i++)
        for (int k = 0; k < 3; k++)
            p.c[k] += v[i][k] / n;
    for (int i = 0; i < n; i++) {
        double h = height3(v[i], b->s->centre, b->s->normal), w[3];
        sub3(w, v[i], p.c);
        double d = length3(w);
        p.radius = d > p.radius ? d : p.radius;
        p.k_min = h < p.k_min ? h : p.k_min;
        p.k_max = h > p.k_max ? h : p.k_max;
    }
    return p;
}

/* What encloses F over a piece, where it is f in the middle: range[2]. Is it so wide that quarters
 * may tell more? */
static inline int form_factor_range_enclose(const struct form_factor_range *b,
                                            const struct form_factor_piece *p, double f,
                                            const double gradient[3], double range[2])
{
    double far = 0, rise[2] = {0, 0};
    for (int i = 0; i < b->q.n; i++) {
        double w[3];
        sub3(w, b->q.v[i], p->c);
        double d = length3(w) + p->radius;
        far = d > far ? d : far;
    }
    double near =
        polygon_distance(p->c, (const double(*)[3])b->q.v, b->q.n, b->s->normal) - p->radius;
    near = p->k_min > near ? p->k_min : near;
    near = b->lowest > near ? b->lowest : near;
    double k_most = p->k_max > -p->k_min ? p->k_max : -p->k_min;
    range[0] = p->k_min > 0 ? p->k_min * b->share / far / far / far / far : 0;
    range[1] = b->cap;
    if (!(near > 0))
        return 1;
    double most = b->share / near / near / near / near,
           f_most = k_most * most < 1 ? k_most * most : 1;
    if (p->k_max * most < range[1])
        range[1] = p->k_max * most;
    double steep = most / near;
    if (p->k_min > 0 && f_most / p->k_min / near < steep)
        steep = f_most / p->k_min / near;
    double bend = 0.5 * p->radius * p->radius * (20 * f_most / near / near + 8 * b->slope * steep);
    for (int i = 0; i < p->n; i++) {
        double w[3];
        sub3(w, p->v[i], p->c);
        double step = dot3(w, gradient);
        rise[0] = step < rise[0] ? step : rise[0];
        rise[1] = step > rise[1] ? step : rise[1];
    }
    if (f + rise[0] - bend > range[0])
        range[0] = f + rise[0] - bend;
    if (f + rise[1] + bend < range[1])
        range[1] = f + rise[1] + bend > 0 ? f + rise[1] + bend : 0;
    return bend > 0.125 * (rise[1] - rise[0]);
}

/* Quarter i of a piece: corner i and the middles beside it; of a triangle the fourth is between the
 * middles. */
static inline void form_factor_piece_quarter(const struct form_factor_piece *p, int i,
                                             double part[4][3])
{
    const int n = p->n;
    for (int j = 0; j < n; j++) {
        int from = n == 3 && i == 3 ? j : i, to = n == 3 && i == 3 ? (j + 1) % 3 : j;
        int across = n == 4 && (i + 2) % 4 == j;
        for (int k = 0; k < 3; k++)
            part[j][k] = across ? p->c[k] : 0.5 * (p->v[from][k] + p->v[to][k]);
    }
}

/* Widen b->bound by what encloses F over the part v[n] of the receiver. */
static inline void form_factor_range_piece(struct form_factor_range *b, const double (*v)[3], int n,
                                           int depth)
{
    const struct form_factor_piece p = form_factor_piece_of(b, v, n);
    if (!(p.k_max > 0)) {
        b->bound[0] = b->seen[0] = 0;
        return;
    }
    double gradient[3], range[2], f = point_factor_gradient(p.c, b->r->normal, &b->q, gradient);
    int open = form_factor_range_enclose(b, &p, f, gradient, range);
    f = f > 0 && height3(p.c, b->s->centre, b->s->normal) > 0 ? f : 0;
    b->seen[0] = f < b->seen[0] ? f : b->seen[0];
    b->seen[1] = f > b->seen[1] ? f : b->seen[1];
    if (open && depth > 0) {
        double slack = 0.0625 * (b->seen[1] - b->seen[0]) + (1 / 1024.0) * b->seen[1];
        open = range[0] < b->seen[0] - slack || range[1] > b->seen[1] + slack;
        open = open && (range[0] < b->bound[0] || range[1] > b->bound[1]);
    }
    if (!open || depth == 0) {
        b->bound[0] = range[0] < b->bound[0] ? range[0] : b->bound[0];
        b->bound[1] = range[1] > b->bound[1] ? range[1] : b->bound[1];
        return;
    }
    for (int i = 0; i < 4; i++) {
        double part[4][3];
        form_factor_piece_quarter(&p, i, part);
        form_factor_range_piece(b, (const double(*)[3])part, n, depth - 1);
    }
}

/* The same by pieces halved so many times at the most; 0: the receiver as a whole, which is sooner
 * done and wider. */
OUTLINE void form_factor_range_bound_to(const struct element *r, const struct element *s, int depth,
                                        double range[2])
{
    double turn = dot3(r->normal, s->normal), level = 0;
    range[0] = range[1] = 0;
    if (!r->vertices || !s->vertices) {
        range[1] = 1;
        return;
    }
    struct form_factor_range b;
    b.r = r;
    b.s = s;
    point_factor_clip(&b.q, r, s);
    if (b.q.n == 0 || polygon_factor_hidden(r, s, point_factor_at(r->centre, r, s, &b.q) * r->area))
        return;
    b.lowest = INFINITY;
    for (int i = 0; i < b.q.n; i++) {
        double h = height3(b.q.v[i], r->centre, r->normal);
        b.lowest = h < b.lowest ? h : b.lowest;
    }
    for (int i = 2; i < b.q.n; i++) {
        struct polygon t;
        t.n = 3;
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                t.v[j][k] = b.q.v[j ? i - 2 + j : 0][k];
        for (int j = 0; j < 3; j++)
            level +=
                height3(t.v[j], r->centre, r->normal) * polygon_area(&t, s->normal) * (1 / 3.0);
    }
    b.share = level > 0 ? level / LAMBERT_PI : 0;
    b.cap = 0.5 - 0.5 * turn < 1 ? 0.5 - 0.5 * turn : 1;
    b.slope = turn * turn < 1 ? sqrt(1 - turn * turn) : 0;
    b.seen[0] = b.bound[0] = INFINITY;
    b.seen[1] = b.bound[1] = 0;
    form_factor_range_piece(&b, (const double(*)[3])r->vertex, r->vertices, depth);
    /* What rounding may have done to the sums over edges. */
    range[0] = b.bound[0] * (1 - FORM_FACTOR_RANGE_ROUNDING) - FORM_FACTOR_RANGE_LEAST;
    range[0] = range[0] > 0 ? range[0] : 0;
    range[1] = b.bound[1] * (1 + FORM_FACTOR_RANGE_ROUNDING) + FORM_FACTOR_RANGE_LEAST;
    range[1] = range[1] < 1 ? range[1] : 1;
}

OUTLINE void form_factor_range_bound(const struct element *r, const struct element *s,
                                     double range[2])
{
    form_factor_range_bound_to(r, s, FORM_FACTOR_RANGE_DEPTH, range);
}

TOOL const double *term_form_factor_range(struct discussion *d, enum form_factor_range_level level)
{
    if (d->terms.form_factor_range_level < level) {
        double range[2];
        if (level == FORM_FACTOR_RANGE_SAMPLED)
            form_factor_range_sample(d->receiver, d->emitter, range);
        else
            form_factor_range_bound(d->receiver, d->emitter, range);
        d->terms.form_factor_range[0] = range[0];
        d->terms.form_factor_range[1] = range[1];
        d->terms.form_factor_range_level = (unsigned char)level;
    }
    return d->terms.form_factor_range;
}

#endif
