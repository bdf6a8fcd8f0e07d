/* room_judge.h - view factors past any number of convex blockers by a way that shares nothing with
 * the library's.
 *
 * From a point x each blocker hides of the other polygon what lies within the pyramid of x over the
 * blocker, and beyond its plane; what is left is cut, in space, into convex pieces that the next
 * blocker is held against, and Lambert's sum of each is exact. The outer integral is Gauss points,
 * three for a triangle, each triangle against its four quarters until they agree, are no larger
 * than the smallest blocker, and have no corner in a shade that ends before their points: where all
 * points of a large one see past a small box, they agree, too.
 * SPDX-License-Identifier: MIT */
#ifndef ROOM_JUDGE_H
#define ROOM_JUDGE_H

#include "runtime/quad_judge.h"

enum { JUDGE_BLOCKERS = 64, JUDGE_LEAST_DEPTH = 2, JUDGE_SHADE_DEPTH = 6, JUDGE_MOST_DEPTH = 10 };

/* A pair at work: what is looked at, past what. */
struct judge_view {
    const struct judge_polygon *to;
    double normal[3];   /* of the face that looks, a unit vector */
    double enough;      /* the error to leave (m2), of area */
    double area, least; /* least: the smallest blocker's (m2) */
    int count;
    const struct judge_polygon *blockers[JUDGE_BLOCKERS];
    double plane[JUDGE_BLOCKERS][3]; /* their normals */
};

static inline void judge_normal(const struct judge_polygon *p, double n[3])
{
    judge_cross(p->v[0], p->v[1], p->v[2], n);
    double size = sqrt(judge_dot(n, n));
    for (int k = 0; k < 3; k++)
        n[k] /= size;
}

static inline double judge_area(const struct judge_polygon *p)
{
    double n[3], area = 0;
    for (int i = 2; i < p->n; i++) {
        judge_cross(p->v[0], p->v[i - 1], p->v[i], n);
        area += 0.5 * sqrt(judge_dot(n, n));
    }
    return area;
}

/* How far p reaches over the plane through o with normal n, and under it: out[0], out[1] (m). */
static inline void judge_reach(const struct judge_polygon *p, const double *o, const double *n,
                               double out[2])
{
    out[0] = out[1] = 0;
    for (int i = 0; i < p->n; i++) {
        double h = 0;
        for (int k = 0; k < 3; k++)
            h += n[k] * (p->v[i][k] - o[k]);
        out[0] = fmax(out[0], h);
        out[1] = fmax(out[1], -h);
    }
}

/* Does a blocker have a part between the two planes, and points of the two on both its sides, by
 * more than `flat`? */
static inline int judge_between(const struct judge_polygon *blocker, const struct judge_polygon *a,
                                const struct judge_polygon *b, double flat)
{
    double n[3], m[3], c[3], over[2], other[2];
    judge_normal(blocker, c);
    judge_reach(a, blocker->v[0], c, over);
    judge_reach(b, blocker->v[0], c, other);
    if (!((over[0] > flat && other[1] > flat) || (over[1] > flat && other[0] > flat)))
        return 0;
    judge_normal(a, n);
    judge_normal(b, m);
    judge_reach(blocker, a->v[0], n, over);
    judge_reach(blocker, b->v[0], m, other);
    return over[0] > flat && other[0] > flat;
}

/* The sum of what is left of p past blockers from k on. */
static inline double judge_left(const struct judge_view *view, const double *x, int k,
                                const struct judge_polygon *p)
{
    double cut[JUDGE_CORNERS + 1][3], sum = 0;
    for (; k < view->count; k++) {
        const struct judge_polygon *c = view->blockers[k];
        double h = 0;
        for (int i = 0; i < 3; i++)
            h += view->plane[k][i] * (x[i] - c->v[0][i]);
        double side = h > 0 ? -1 : 1;
        for (int e = 0; e < c->n; e++) {
            judge_cross(x, c->v[e], c->v[(e + 1) % c->n], cut[e + 1]);
            for (int i = 0; i < 3; i++)
                cut[e + 1][i] *= side;
        }
        for (int i = 0; i < 3; i++)
            cut[0][i] = side * view->plane[k][i];
        struct judge_polygon hidden = *p;
        for (int e = 0; e <= c->n && hidden.n >= 3; e++)
            judge_cut(&hidden, e ? x : c->v[0], cut[e]);
        if (hidden.n < 3)
            continue;
        hidden = *p;
        for (int e = 0; e <= c->n && hidden.n >= 3; e++) {
            struct judge_polygon outside = hidden;
            double back[3] = {-cut[e][0], -cut[e][1], -cut[e][2]};
            judge_cut(&outside, e ? x : c->v[0], back);
            judge_cut(&hidden, e ? x : c->v[0], cut[e]);
            if (outside.n >= 3)
                sum += judge_left(view, x, k + 1, &outside);
        }
        return sum;
    }
    return judge_sum(p, x, view->normal);
}

static inline double judge_at(const struct judge_view *view, const double *x)
{
    struct judge_polygon p = *view->to;
    judge_cut(&p, x, view->normal);
    return p.n < 3 ? 0 : judge_left(view, x, 0, &p);
}

/* By three points of a triangle. */
static inline double judge_rule(const struct judge_view *view, const double t[3][3], double area)
{
    double sum = 0, x[3];
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            x[k] = (4 * t[i][k] + t[(i + 1) % 3][k] + t[(i + 2) % 3][k]) / 6;
        sum += judge_at(view, x) / 3;
    }
    return sum * area;
}

/* Is something of what x would see hidden? */
static inline int judge_dim(const struct judge_view *view, const double *x)
{
    struct judge_polygon p = *view->to;
    judge_cut(&p, x, view->normal);
    return p.n >= 3 && judge_left(view, x, 0, &p) < judge_sum(&p, x, view->normal) * (1 - 1e-9);
}

/* Does a shade that a corner is in end before the rule's points? */
static inline int judge_missed(const struct judge_view *view, const double t[3][3])
{
    int dim[2] = {0, 0};
    for (int i = 0; i < 3; i++)
        for (int corner = 0; corner < 2 && view->count; corner++) {
            const double w = corner ? 1 - 2e-6 : 4 / 6.0, u = 0.5 * (1 - w);
            double x[3];
            for (int k = 0; k < 3; k++)
                x[k] = w * t[i][k] + u * (t[(i + 1) % 3][k] + t[(i + 2) % 3][k]);
            dim[corner] |= judge_dim(view, x);
        }
    return dim[1] && !dim[0];
}

static inline double judge_triangle(const struct judge_view *view, const double t[3][3],
                                    double area, double value, int depth)
{
    double middle[3][3], quarter[4][3][3], values[4], sum = 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            middle[i][k] = 0.5 * (t[i][k] + t[(i + 1) % 3][k]);
    for (int q = 0; q < 4; q++) {
        memcpy(quarter[q][0], q < 3 ? t[q] : middle[0], sizeof middle[0]);
        memcpy(quarter[q][1], middle[q < 3 ? q : 1], sizeof middle[0]);
        memcpy(quarter[q][2], middle[(q + 2) % 3], sizeof middle[0]);
        if (q == 3)
            memcpy(quarter[q][2], middle[2], sizeof middle[0]);
        sum += values[q] = judge_rule(view, (const double(*)[3])quarter[q], 0.25 * area);
    }
    if (depth == JUDGE_MOST_DEPTH
        || (!(depth < JUDGE_SHADE_DEPTH && judge_missed(view, t)) && depth >= JUDGE_LEAST_DEPTH
            && area <= view->least && fabs(sum - value) <= view->enough * sqrt(area / view->area)))
        return sum;
    sum = 0;
    for (int q = 0; q < 4; q++)
        sum +=
            judge_triangle(view, (const double(*)[3])quarter[q], 0.25 * area, values[q], depth + 1);
    return sum;
}

/* A_a F_ab, right to about `enough` (m2), past blockers. */
static inline double judge_pair(const struct judge_polygon *a, const struct judge_polygon *b,
                                const struct judge_polygon *blockers, int count, double flat,
                                double enough)
{
    struct judge_view view = {.to = b, .enough = enough, .least = INFINITY};
    struct judge_polygon p = *a;
    double n[3], other[3], sum = 0;
    judge_normal(a, view.normal);
    judge_normal(b, n);
    judge_cut(&p, b->v[0], n);
    for (int i = 0; i < count && view.count < JUDGE_BLOCKERS; i++)
        if (judge_between(&blockers[i], a, b, flat)) {
            judge_normal(&blockers[i], view.plane[view.count]);
            view.least = fmin(view.least, judge_area(&blockers[i]));
            view.blockers[view.count++] = &blockers[i];
        }
    for (int i = 2; i < p.n; i++) {
        judge_cross(p.v[0], p.v[i - 1], p.v[i], other);
        view.area += 0.5 * judge_dot(other, view.normal);
    }
    for (int i = 2; i < p.n; i++) {
        const double t[3][3] = {{p.v[0][0], p.v[0][1], p.v[0][2]},
                                {p.v[i - 1][0], p.v[i - 1][1], p.v[i - 1][2]},
                                {p.v[i][0], p.v[i][1], p.v[i][2]}};
        judge_cross(p.v[0], p.v[i - 1], p.v[i], other);
        double area = 0.5 * judge_dot(other, view.normal);
        if (area > 0)
            sum += judge_triangle(&view, t, area, judge_rule(&view, t, area), 0);
    }
    return sum;
}

#endif
