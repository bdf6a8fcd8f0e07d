/* make_room.h - a closed room of 4 x 5 x 3 m with a box floating in it, cut into quads, and what a
 * ray from it meets.
 *
 * Each wall is n x n quads, each side of the box m x m: 6 (n^2 + m^2) faces, 6,528 for n = 32 and m
 * = 8. Faces count wall by wall, row by row. Rays are cut with the twelve rectangles themselves: no
 * code of the project's is in it.
 * SPDX-License-Identifier: MIT */
#ifndef MAKE_ROOM_H
#define MAKE_ROOM_H

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include "kernel/hash.h"

enum { ROOM_SIDES = 12 };

struct room_side {
    double o[3], u[3], v[3], n[3], square[2], height; /* corner, edges; normal, |u|^2, |v|^2, n.o */
    int cuts, first;                                  /* quads each way; number of the first */
};

struct room {
    struct room_side side[ROOM_SIDES];
    int sides, faces; /* sides 6: no box */
};

static inline void room_side(struct room *r, const double o[3], const double u[3],
                             const double v[3], int cuts)
{
    struct room_side *s = &r->side[r->sides++];
    for (int k = 0; k < 3; k++) {
        s->o[k] = o[k];
        s->u[k] = u[k];
        s->v[k] = v[k];
        s->n[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    }
    double size = sqrt(s->n[0] * s->n[0] + s->n[1] * s->n[1] + s->n[2] * s->n[2]);
    s->square[0] = s->square[1] = s->height = 0;
    for (int k = 0; k < 3; k++) {
        s->n[k] /= size;
        s->square[0] += u[k] * u[k];
        s->square[1] += v[k] * v[k];
        s->height += s->n[k] * o[k];
    }
    s->cuts = cuts;
    s->first = r->faces;
    r->faces += cuts * cuts;
}

/* m = 0: no box. It is turned by `degrees` about the vertical. */
static inline void room_make(struct room *r, int n, int m, double degrees)
{
    const double x[3] = {4, 0, 0}, y[3] = {0, 5, 0}, z[3] = {0, 0, 3}, zero[3] = {0, 0, 0};
    double turn = degrees * 0.017453292519943295, c = cos(turn), s = sin(turn);
    double a[3] = {1.2 * c, 1.2 * s, 0}, b[3] = {-0.9 * s, 0.9 * c, 0}, h[3] = {0, 0, 0.8}, low[3],
           p[3];
    r->sides = r->faces = 0;
    room_side(r, zero, x, y, n);
    room_side(r, z, y, x, n);
    room_side(r, zero, y, z, n);
    room_side(r, x, z, y, n);
    room_side(r, zero, z, x, n);
    room_side(r, y, x, z, n);
    if (m == 0)
        return;
    for (int k = 0; k < 3; k++)
        low[k] = (k == 0 ? 1.8 : k == 1 ? 2.3 : 0.6) - 0.5 * (a[k] + b[k]);
    room_side(r, low, b, a, m);
    room_side(r, low, h, b, m);
    room_side(r, low, a, h, m);
    for (int k = 0; k < 3; k++)
        p[k] = low[k] + h[k];
    room_side(r, p, a, b, m);
    for (int k = 0; k < 3; k++)
        p[k] = low[k] + a[k];
    room_side(r, p, b, h, m);
    for (int k = 0; k < 3; k++)
        p[k] = low[k] + b[k];
    room_side(r, p, h, a, m);
}

/* Corner (i, j) of a side's grid. */
static inline void room_corner(const struct room_side *s, int i, int j, double p[3])
{
    for (int k = 0; k < 3; k++)
        p[k] = s->o[k] + s->u[k] * i / s->cuts + s->v[k] * j / s->cuts;
}

/* As OBJ with the library room.mtl; `without`: a side that is left out, -1 for none. */
static inline void room_write(const struct room *r, int without, FILE *out)
{
    int base = 1;
    fputs("mtllib room.mtl\nusemtl wall\n", out);
    for (int k = 0; k < r->sides; k++) {
        const struct room_side *s = &r->side[k];
        int row = s->cuts + 1;
        if (k == without)
            continue;
        if (k == 6)
            fputs("usemtl box\n", out);
        for (int j = 0; j <= s->cuts; j++)
            for (int i = 0; i <= s->cuts; i++) {
                double p[3];
                room_corner(s, i, j, p);
                fprintf(out, "v %.17g %.17g %.17g\n", p[0], p[1], p[2]);
            }
        for (int j = 0; j < s->cuts; j++)
            for (int i = 0; i < s->cuts; i++) {
                int a = base + j * row + i;
                fprintf(out, "f %d %d %d %d\n", a, a + 1, a + row + 1, a + row);
            }
        base += row * row;
    }
}

static inline const struct room_side *room_side_of(const struct room *r, int face)
{
    int k = r->sides - 1;
    while (r->side[k].first > face)
        k--;
    return &r->side[k];
}

/* Area of a face. */
static inline double room_area(const struct room *r, int face)
{
    const struct room_side *s = room_side_of(r, face);
    int i = (face - s->first) % s->cuts, j = (face - s->first) / s->cuts;
    double corner[4][3], a[3], b[3], n[3];
    for (int c = 0; c < 4; c++)
        room_corner(s, i + (c == 1 || c == 2), j + (c >= 2), corner[c]);
    for (int k = 0; k < 3; k++) {
        a[k] = corner[2][k] - corner[0][k];
        b[k] = corner[3][k] - corner[1][k];
    }
    for (int k = 0; k < 3; k++)
        n[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    return 0.5 * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
}

/* The face whose front the ray from p in direction d meets first, or -1. */
static inline int room_hit(const struct room *r, const double p[3], const double d[3])
{
    double best = INFINITY;
    int hit = -1;
    for (int k = 0; k < r->sides; k++) {
        const struct room_side *s = &r->side[k];
        double down = s->n[0] * d[0] + s->n[1] * d[1] + s->n[2] * d[2], a = 0, b = 0;
        if (!(down < 0))
            continue;
        double t = (s->height - (s->n[0] * p[0] + s->n[1] * p[1] + s->n[2] * p[2])) / down;
        if (!(t > 1e-12 && t < best))
            continue;
        for (int c = 0; c < 3; c++) {
            double w = p[c] + t * d[c] - s->o[c];
            a += w * s->u[c];
            b += w * s->v[c];
        }
        a *= s->cuts / s->square[0];
        b *= s->cuts / s->square[1];
        if (!(a >= 0 && b >= 0 && a < s->cuts && b < s->cuts))
            continue;
        best = t;
        hit = s->first + (int)b * s->cuts + (int)a;
    }
    return hit;
}

static inline double room_random(uint64_t *state)
{
    return (double)(hash64(*state += HASH_STEP) >> 11) * (1 / 9007199254740992.0);
}

/* Where `count` rays from a face, cosine-spread, end: hits[faces]. Returns how many met nothing. */
static inline long room_rays(const struct room *r, int face, long count, uint64_t seed, long *hits)
{
    const struct room_side *s = room_side_of(r, face);
    int cell = face - s->first;
    long lost = 0;
    for (long i = 0; i < count; i++) {
        double a = (cell % s->cuts + room_random(&seed)) / s->cuts,
               b = (cell / s->cuts + room_random(&seed)) / s->cuts;
        double turn = 6.283185307179586 * room_random(&seed), q = room_random(&seed),
               flat = sqrt(q), up = sqrt(1 - q), p[3], d[3];
        double u = flat * cos(turn) / sqrt(s->square[0]), v = flat * sin(turn) / sqrt(s->square[1]);
        for (int c = 0; c < 3; c++) {
            p[c] = s->o[c] + a * s->u[c] + b * s->v[c];
            d[c] = u * s->u[c] + v * s->v[c] + up * s->n[c];
        }
        int hit = room_hit(r, p, d);
        if (hit < 0)
            lost++;
        else
            hits[hit]++;
    }
    return lost;
}

/* The error that a view factor may have beside chance: a hundredth, and what is seen by so thin
 * a strip that it is missed. */
#define ROOM_RELATIVE 0.01
#define ROOM_ABSOLUTE 3e-6

/* Are the counts those of the shares f[faces]? Chi-square over faces that expect 25 hits or more,
 * and one class for the rest. Returns how many of its standard deviations the statistic, made
 * normal by Wilson & Hilferty's cube root, is too large. */
static inline double room_chi(const struct room *r, const double *f, const long *hits, long count,
                              double *worst)
{
    double sum = 0, few = 0, got = 0;
    int classes = 0;
    *worst = 0;
    for (int j = 0; j < r->faces; j++) {
        double e = f[j] * (double)count, off = ROOM_RELATIVE * e + ROOM_ABSOLUTE * (double)count;
        if (e < 25) {
            few += e;
            got += (double)hits[j];
            continue;
        }
        double z = ((double)hits[j] - e) / sqrt(e + off * off);
        sum += z * z;
        classes++;
        *worst = fabs(z) > *worst ? fabs(z) : *worst;
    }
    if (few > 0) {
        double off = ROOM_ABSOLUTE * (double)count;
        sum += (got - few) * (got - few) / (few + off * off);
        classes++;
    }
    double k = classes - 1;
    return (cbrt(sum / k) - (1 - 2 / (9 * k))) / sqrt(2 / (9 * k));
}

#endif
