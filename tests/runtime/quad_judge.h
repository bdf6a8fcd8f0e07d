/* quad_judge.h - view factors of three quads by a way that shares nothing with the library's.
 *
 * From a point x of one quad the third hides of the second what lies behind it: what is within the
 * pyramid of x over the third, and beyond its plane. That is one convex polygon, got by cutting in
 * space; Lambert's sum of the second less that of the hidden part is exact. The outer integral is
 * Gauss points, 2 x 2, in cells of the part in front of the second's plane.
 * SPDX-License-Identifier: MIT */
#ifndef QUAD_JUDGE_H
#define QUAD_JUDGE_H

#include <math.h>
#include <string.h>

enum { JUDGE_CORNERS = 16 };

struct judge_polygon {
    int n;
    double v[JUDGE_CORNERS][3];
};

static inline double judge_dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void judge_cross(const double *o, const double *p, const double *q, double n[3])
{
    for (int k = 0; k < 3; k++) {
        int a = (k + 1) % 3, b = (k + 2) % 3;
        n[k] = (p[a] - o[a]) * (q[b] - o[b]) - (p[b] - o[b]) * (q[a] - o[a]);
    }
}

/* What lies where n . (y - o) >= 0. */
static inline void judge_cut(struct judge_polygon *p, const double *o, const double *n)
{
    struct judge_polygon out = {.n = 0};
    for (int i = 0; i < p->n; i++) {
        const double *a = p->v[i], *b = p->v[(i + 1) % p->n];
        double ha = judge_dot(n, a) - judge_dot(n, o), hb = judge_dot(n, b) - judge_dot(n, o);
        if (ha >= 0)
            memcpy(out.v[out.n++], a, sizeof out.v[0]);
        if ((ha >= 0) != (hb >= 0)) {
            for (int k = 0; k < 3; k++)
                out.v[out.n][k] = a[k] + ha / (ha - hb) * (b[k] - a[k]);
            out.n++;
        }
    }
    *p = out;
}

/* Lambert's sum: angles between the corners' directions about the edges' normals. */
static inline double judge_sum(const struct judge_polygon *p, const double *x, const double *n)
{
    double sum = 0;
    for (int i = 0; i < p->n; i++) {
        const double *a = p->v[i], *b = p->v[(i + 1) % p->n];
        double c[3], u[3], w[3];
        judge_cross(x, a, b, c);
        for (int k = 0; k < 3; k++) {
            u[k] = a[k] - x[k];
            w[k] = b[k] - x[k];
        }
        double size = sqrt(judge_dot(c, c));
        if (size > 0)
            sum += atan2(size, judge_dot(u, w)) * judge_dot(c, n) / size;
    }
    return fabs(sum) / (2 * acos(-1.0));
}

/* From x, normal n, to quad b, past quad c unless that is NULL. */
static inline double judge_point(const double *x, const double *n, const double (*b)[3],
                                 const double (*c)[3])
{
    struct judge_polygon p = {.n = 4}, hidden;
    double normal[3];
    judge_cross(b[0], b[1], b[2], normal);
    memcpy(p.v, b, 4 * sizeof *b);
    if (!(judge_dot(normal, x) > judge_dot(normal, b[0])))
        return 0;
    judge_cut(&p, x, n);
    double all = judge_sum(&p, x, n);
    if (!c || p.n < 3)
        return all;
    judge_cross(c[0], c[1], c[2], normal);
    double side = judge_dot(normal, x) > judge_dot(normal, c[0]) ? -1 : 1;
    hidden = p;
    for (int k = 0; k < 3; k++)
        normal[k] *= side;
    judge_cut(&hidden, c[0], normal);
    for (int e = 0; e < 4; e++) {
        judge_cross(x, c[e], c[(e + 1) % 4], normal);
        for (int k = 0; k < 3; k++)
            normal[k] *= side;
        judge_cut(&hidden, x, normal);
    }
    return all - (hidden.n < 3 ? 0 : judge_sum(&hidden, x, n));
}

/* F_ab of flat convex quads, past c or NULL, by cells x cells per triangle of a's part. */
static inline double judge_factor(const double (*a)[3], const double (*b)[3], const double (*c)[3],
                                  int cells)
{
    struct judge_polygon p = {.n = 4};
    double n[3], nb[3], other[3], area = 0, sum = 0;
    judge_cross(a[0], a[1], a[2], n);
    judge_cross(b[0], b[1], b[2], nb);
    double size = sqrt(judge_dot(n, n));
    for (int k = 0; k < 3; k++)
        n[k] /= size;
    for (int i = 2; i < 4; i++) {
        judge_cross(a[0], a[i - 1], a[i], other);
        area += 0.5 * judge_dot(other, n);
    }
    memcpy(p.v, a, 4 * sizeof *a);
    judge_cut(&p, b[0], nb);
    for (int i = 2; i < p.n; i++) {
        judge_cross(p.v[0], p.v[i - 1], p.v[i], other);
        double twice = judge_dot(other, n) / (cells * cells);
        for (int k = 0; k < 4 * cells * cells; k++) {
            double g = 0.5 / sqrt(3), x[3], s, t;
            s = (k / 4 / cells + 0.5 + (k & 1 ? g : -g)) / cells;
            t = (k / 4 % cells + 0.5 + (k & 2 ? g : -g)) / cells;
            for (int j = 0; j < 3; j++) /* the triangle is a square with one side drawn together */
                x[j] =
                    p.v[0][j] + s * (p.v[i - 1][j] - p.v[0][j] + t * (p.v[i][j] - p.v[i - 1][j]));
            sum += 0.25 * twice * s * judge_point(x, n, b, c);
        }
    }
    return sum / area;
}

#endif
