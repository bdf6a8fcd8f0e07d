/* separable_faces.h - faces as arrays of numbers, and the kernel between one of them and a pivot
 * (separable_links.h). Lengths are in units of `unit`, a power of two that is at least the scene's
 * extent, from the corner of its box: so floats do, and no scale of the scene changes a bit.
 * SPDX-License-Identifier: MIT */
#ifndef SEPARABLE_FACES_H
#define SEPARABLE_FACES_H

#include <stddef.h>
#include "discussion.h"

/* What one side of a link is to the other: a point and a normal. Its faces turn to x by the mean of
 * n_i . (x - y_i), which is normal . (x - centre) + shift. */
struct pivot {
    float centre[3], normal[3]; /* unit; unit vector */
    float shift;                /* 0 for one plane (unit) */
};

/* Faces, or one part of a face, as arrays of numbers. */
struct separable_faces {
    float *centre[3], *normal[3]; /* as in pivot */
    /* two vectors p, q in its plane: pp' + qq' is the covariance of its points (unit) */
    float *across[6];
    float *area;    /* unit^2 */
    float *bright;  /* A B as the oracles see it (W/m2 unit^2) */
    float *sent[3]; /* [bands]: A B (W/m2 unit^2) */
};

enum { SEPARABLE_ARRAYS = 14 }; /* of struct separable_faces, besides what the bands have */
#define SEPARABLE_TINY 1e-15f   /* against division by 0; lengths are at most 1 here */

/* The faces of one side of a link. */
struct separable_side {
    struct separable_faces faces;
    size_t from, to;
    float part[SEPARABLE_ARRAYS + 3]; /* room for the only one, when it is a part of a face */
};

/* Let f's arrays be parts of `at`, [SEPARABLE_ARRAYS + bands][count]. */
void separable_faces_arrays(struct separable_faces *f, float *at, size_t count, int bands);

/* Face i is the surface e, of a scene whose box begins at `low` (m); all but `sent`. */
void separable_faces_set(const struct separable_faces *f, size_t i, const struct element *e,
                         const double low[3], double unit);

/* A side that is the faces from .. to - 1, whose arrays it borrows, or one part of a face. */
void separable_side_whole(struct separable_side *side, const struct separable_faces *f, size_t from,
                          size_t to);
void separable_side_part(struct separable_side *side, const struct element *e, const double low[3],
                         double unit);

/* max(0, x), without a branch and inlined always: so loops over faces run several at a time. */
TOOL float positive_part(float x)
{
    return 0.5f * (x + fabsf(x));
}

/* From the centre of a face to a pivot. */
struct separable_way {
    float v[3], near, far, inverse; /* near, far: cosines times |v|; inverse: 1 / |v|^2 */
};

TOOL struct separable_way separable_way(const struct separable_faces *f, size_t i,
                                        const struct pivot *s)
{
    const float *n = s->normal;
    struct separable_way w = {.v = {s->centre[0] - f->centre[0][i], s->centre[1] - f->centre[1][i],
                                    s->centre[2] - f->centre[2][i]}};
    const float *v = w.v;
    w.near =
        positive_part(f->normal[0][i] * v[0] + f->normal[1][i] * v[1] + f->normal[2][i] * v[2]);
    w.far = positive_part(s->shift - (n[0] * v[0] + n[1] * v[1] + n[2] * v[2]));
    w.inverse = 1 / (v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + SEPARABLE_TINY);
    return w;
}

/* k(x, s) pi for face i, times unit^2; the mean over the face to second order in its size. */
TOOL float separable_kernel(const struct separable_faces *f, size_t i, const struct pivot *s)
{
    const struct separable_way w = separable_way(f, i, s);
    const float *n = s->normal, *v = w.v, inverse = w.inverse;
    float p[3] = {f->across[0][i], f->across[1][i], f->across[2][i]},
          q[3] = {f->across[3][i], f->across[4][i], f->across[5][i]};
    float pv = p[0] * v[0] + p[1] * v[1] + p[2] * v[2],
          qv = q[0] * v[0] + q[1] * v[1] + q[2] * v[2];
    float pn = p[0] * n[0] + p[1] * n[1] + p[2] * n[2],
          qn = q[0] * n[0] + q[1] * n[1] + q[2] * n[2];
    float size = p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + q[0] * q[0] + q[1] * q[1] + q[2] * q[2];
    float more = inverse
                 * (12 * inverse * (pv * pv + qv * qv) - 2 * size
                    + 4 * (pn * pv + qn * qv) / (w.far + SEPARABLE_TINY));
    /* 1 + more, but never below 0 */
    return w.near * w.far * inverse * inverse
           * (1 / (1 + positive_part(-more)) + positive_part(more));
}

/* The same at the face's centre. */
TOOL float separable_kernel_at_centre(const struct separable_faces *f, size_t i,
                                      const struct pivot *s)
{
    const struct separable_way w = separable_way(f, i, s);
    return w.near * w.far * w.inverse * w.inverse;
}

#endif
