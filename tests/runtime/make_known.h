/* make_known.h - scenes with a known answer, of any shape.
 *
 * Closed: E = b (1 - rho) at every place makes B = b and H = b everywhere, whatever the shape, what
 * stands in it and how rho varies: the white furnace, turned round. Here rho and b are chosen by
 * chance, per material and per band. Spheres: H = <E> / (1 - <rho>) for any E and rho, off by what
 * facets see of each other. Plates: F in closed form; the plate that is lit alone reflects, so
 * H = F E.
 * SPDX-License-Identifier: MIT */
#ifndef MAKE_KNOWN_H
#define MAKE_KNOWN_H

#include <math.h>
#include "kernel/hash.h"
#include "scene/make_scene.h"

/* Chosen by chance from a seed. */
struct chance {
    uint64_t state;
};
static inline double chance_even(struct chance *c)
{
    return (double)(hash64(c->state += HASH_STEP) >> 11) * 0x1p-53;
}
static inline double chance_between(struct chance *c, double low, double high)
{
    return low + (high - low) * chance_even(c);
}
static inline double chance_normal(struct chance *c)
{
    double r = sqrt(-2 * log(1 - chance_even(c)));
    return r * cos(2 * M_PI * chance_even(c));
}

enum known {
    KNOWN_BOX,
    KNOWN_PRISM,
    KNOWN_OCTAHEDRON,
    KNOWN_FURNISHED, /* a box in a box */
    KNOWN_SCREEN,    /* a two-sided screen in a box */
    KNOWN_TILED,     /* a box of up to 1,014 faces */
    KNOWN_SPHERE,    /* 320 facets */
    KNOWN_PARALLEL,
    KNOWN_PERPENDICULAR,
    KNOWN_KINDS
};

enum { KNOWN_MATERIALS = 12 };

static inline int known_is_plates(enum known kind)
{
    return kind == KNOWN_PARALLEL || kind == KNOWN_PERPENDICULAR;
}

/* Materials by chance, rho up to .95; `white`: all with the same. Returns the radiosity b of each
 * band in b[3]. */
static inline void known_materials(struct scene *s, struct chance *c, double b[3])
{
    int white = chance_even(c) < 0.25;
    double high = chance_between(c, 0.3, 0.95), first = chance_between(c, 0.05, high);
    s->bands = chance_even(c) < 0.3 ? 3 : 1;
    for (uint32_t k = 0; k < 3; k++)
        b[k] = s->bands == 3 ? chance_between(c, 0.3, 3) : 1;
    for (int i = 0; i < KNOWN_MATERIALS; i++) {
        made_material(s, 0, 0);
        double grey = white ? first : chance_between(c, 0.02, high);
        for (uint32_t k = 0; k < 3; k++) {
            struct RadMaterial *m = &s->materials[i];
            m->reflectance[k] =
                s->bands == 3 && !white ? fmin(0.95, grey * chance_between(c, 0.5, 1.5)) : grey;
            m->exitance[k] = b[k] * (1 - m->reflectance[k]);
        }
    }
}

static inline uint32_t known_pick(struct chance *c)
{
    return (uint32_t)(KNOWN_MATERIALS * chance_even(c));
}

/* The quad o, o + a, o + a + b, o + b as n x n. */
static inline void known_tiles(struct scene *s, struct chance *c, int n, double ox, double oy,
                               double oz, double ax, double ay, double az, double bx, double by,
                               double bz)
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            double u = (double)i / n, v = (double)j / n;
            made_quad(s, known_pick(c), ox + u * ax + v * bx, oy + u * ay + v * by,
                      oz + u * az + v * bz, ax / n, ay / n, az / n, bx / n, by / n, bz / n);
        }
}

static inline void known_room(struct scene *s, struct chance *c, int n, double x, double y,
                              double z)
{
    known_tiles(s, c, n, 0, 0, 0, x, 0, 0, 0, y, 0);
    known_tiles(s, c, n, 0, 0, z, 0, y, 0, x, 0, 0);
    known_tiles(s, c, n, 0, 0, 0, 0, 0, z, x, 0, 0);
    known_tiles(s, c, n, 0, y, 0, x, 0, 0, 0, 0, z);
    known_tiles(s, c, n, 0, 0, 0, 0, y, 0, 0, 0, z);
    known_tiles(s, c, n, x, 0, 0, 0, 0, z, 0, y, 0);
}

static inline void known_prism(struct scene *s, struct chance *c)
{
    int n = 3 + (int)(7 * chance_even(c));
    double h = chance_between(c, 0.2, 3);
    for (int i = 0; i < n; i++) {
        double p = 2 * M_PI / n * i, q = 2 * M_PI / n * (i + 1);
        const double low[3][3] = {{0, 0, 0}, {cos(p), sin(p), 0}, {cos(q), sin(q), 0}};
        const double high[3][3] = {{0, 0, h}, {cos(q), sin(q), h}, {cos(p), sin(p), h}};
        const double wall[4][3] = {
            {cos(q), sin(q), 0}, {cos(p), sin(p), 0}, {cos(p), sin(p), h}, {cos(q), sin(q), h}};
        made_face(s, known_pick(c), 3, low);
        made_face(s, known_pick(c), 3, high);
        made_face(s, known_pick(c), 4, wall);
    }
}

/* From inside: eight triangles, each split in four so often; `round`: corners on the sphere. */
static inline void known_ball(struct scene *s, struct chance *c, double p[3][3], int depth,
                              int round)
{
    if (depth == 0) {
        made_face(s, known_pick(c), 3, (const double(*)[3])p);
        return;
    }
    double m[3][3];
    for (int i = 0; i < 3; i++) {
        double length = 0;
        for (int k = 0; k < 3; k++) {
            m[i][k] = 0.5 * (p[i][k] + p[(i + 1) % 3][k]);
            length += m[i][k] * m[i][k];
        }
        for (int k = 0; k < 3 && round; k++)
            m[i][k] /= sqrt(length);
    }
    for (int i = 0; i < 3; i++) {
        double q[3][3];
        memcpy(q[0], p[i], sizeof q[0]);
        memcpy(q[1], m[i], sizeof q[1]);
        memcpy(q[2], m[(i + 2) % 3], sizeof q[2]);
        known_ball(s, c, q, depth - 1, round);
    }
    known_ball(s, c, m, depth - 1, round);
}

static inline void known_octahedron(struct scene *s, struct chance *c, int depth, int round)
{
    for (int i = 0; i < 8; i++) {
        double x = i & 1 ? 1 : -1, y = i & 2 ? 1 : -1, z = i & 4 ? 1 : -1;
        double out[3][3] = {{x, 0, 0}, {0, y, 0}, {0, 0, z}};
        double in[3][3] = {{0, y, 0}, {x, 0, 0}, {0, 0, z}};
        known_ball(s, c, x * y * z > 0 ? in : out, depth, round);
    }
}

/* Unit squares one over the other at a distance d. [Hottel 1931] */
static inline double known_parallel_factor(double d)
{
    double X = 1 / d, u = sqrt(1 + X * X);
    return 2 / (M_PI * X * X)
           * (log(u * u / sqrt(1 + 2 * X * X)) + 2 * X * u * atan(X / u) - 2 * X * atan(X));
}

/* From a floor of 1 x 1 to a wall of height h on its edge. [Hottel 1931] */
static inline double known_perpendicular_factor(double h)
{
    double W = 1, H = h, s2 = H * H + W * W, s = sqrt(s2);
    double t = (1 + W * W) * (1 + H * H) / (1 + s2);
    double u = pow(W * W * (1 + s2) / ((1 + W * W) * s2), W * W);
    double v = pow(H * H * (1 + s2) / ((1 + H * H) * s2), H * H);
    return (W * atan(1 / W) + H * atan(1 / H) - s * atan(1 / s) + log(t * u * v) / 4) / (M_PI * W);
}

/* Make a scene; its mean irradiances are truth[face * bands + band] (W/m2), the caller's to free.
 */
static inline double *known_open(struct scene *s, enum known kind, struct chance *c)
{
    double b[3], x = chance_between(c, 0.5, 4), y = chance_between(c, 0.5, 4),
                 z = chance_between(c, 0.5, 4);
    made_open(s);
    known_materials(s, c, b);
    switch (kind) {
    case KNOWN_BOX:
        known_room(s, c, 1, x, y, z);
        break;
    case KNOWN_PRISM:
        known_prism(s, c);
        break;
    case KNOWN_OCTAHEDRON:
        known_octahedron(s, c, 0, 0);
        break;
    case KNOWN_FURNISHED:
        known_room(s, c, 2, x, y, z);
        made_quad(s, 0, x / 3, y / 3, 3 * z / 4, x / 3, 0, 0, 0, y / 3, 0);
        made_quad(s, 5, x / 3, y / 3, z / 4, 0, y / 3, 0, x / 3, 0, 0);
        made_quad(s, 1, x / 3, y / 3, z / 4, x / 3, 0, 0, 0, 0, z / 2);
        made_quad(s, 2, x / 3, 2 * y / 3, z / 4, 0, 0, z / 2, x / 3, 0, 0);
        made_quad(s, 3, x / 3, y / 3, z / 4, 0, 0, z / 2, 0, y / 3, 0);
        made_quad(s, 4, 2 * x / 3, y / 3, z / 4, 0, y / 3, 0, 0, 0, z / 2);
        break;
    case KNOWN_SCREEN:
        known_room(s, c, 1, x, y, z);
        made_quad(s, 0, x / 2, y / 4, z / 4, 0, y / 2, 0, 0, 0, z / 2);
        made_quad(s, 0, x / 2, y / 4, z / 4, 0, 0, z / 2, 0, y / 2, 0);
        s->faces[s->face_count - 1].input = --s->input_count - 1;
        s->faces[s->face_count - 1].back = 1;
        break;
    case KNOWN_TILED:
        known_room(s, c, 13, x, y, z);
        break;
    case KNOWN_SPHERE:
        for (int i = 0; i < KNOWN_MATERIALS; i++)
            for (int k = 0; k < 3; k++)
                s->materials[i].exitance[k] *= s->bands == 3 ? 1 : 0.2 * (i % 5);
        known_octahedron(s, c, 3, 1);
        break;
    default: /* a black lamp and what it shines on */
        for (uint32_t k = 0; k < 3; k++) {
            s->materials[0].reflectance[k] = 0;
            s->materials[1].exitance[k] = 0;
        }
        if (kind == KNOWN_PARALLEL) {
            z = chance_between(c, 0.1, 2);
            made_quad(s, 0, 0, 0, z, 0, 1, 0, 1, 0, 0);
            x = known_parallel_factor(z);
        } else {
            z = chance_between(c, 0.1, 2);
            made_quad(s, 0, 0, 0, 0, 0, z, 0, 0, 0,
                      1); /* the lamp stands on an edge of the floor */
            s->faces[0].vertex[0][0] = 0;
            const double wall[4][3] = {{0, 0, 0}, {0, 1, 0}, {0, 1, z}, {0, 0, z}};
            memcpy(s->faces[0].vertex, wall, sizeof wall);
            x = known_perpendicular_factor(z);
        }
        made_quad(s, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    }
    double *truth = calloc((size_t)s->face_count * s->bands, sizeof *truth);
    double emitted[3] = {0}, reflects[3] = {0}, area = 0;
    for (uint32_t f = 0; f < s->face_count && kind == KNOWN_SPHERE; f++) {
        const struct RadMaterial *m = &s->materials[s->faces[f].material];
        double(*v)[3] = s->faces[f].vertex;
        double a[3], d[3], n = 0;
        for (int k = 0; k < 3; k++) {
            a[k] = v[1][k] - v[0][k];
            d[k] = v[2][k] - v[0][k];
        }
        for (int k = 0; k < 3; k++) {
            double of = a[k] * d[(k + 1) % 3] - a[(k + 1) % 3] * d[k];
            n += of * of;
        }
        area += sqrt(n) / 2;
        for (int k = 0; k < 3; k++) {
            emitted[k] += sqrt(n) / 2 * m->exitance[k];
            reflects[k] += sqrt(n) / 2 * m->reflectance[k];
        }
    }
    for (uint32_t f = 0; f < s->face_count; f++)
        for (uint32_t k = 0; k < s->bands; k++) {
            double *H = &truth[f * s->bands + k];
            *H = b[k];
            if (kind == KNOWN_SPHERE)
                *H = emitted[k] / (area - reflects[k]);
            if (known_is_plates(kind))
                *H = f == 1 ? x * s->materials[0].exitance[k] : 0;
        }
    return truth;
}

#endif
