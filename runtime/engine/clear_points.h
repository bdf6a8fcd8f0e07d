/* clear_points.h - what two faces that see all of each other exchange, by points of the one, each
 * of which sees the other exactly.
 *
 * What a point sees is smooth along a face as far as the other face is away, so that its parts by
 * degree fall like powers: a rule that is exact to degree 2 m or 2 m - 1 resolves the parts up to
 * m - 1 or m, and what it leaves out is less than the square of the last of them, as a share of
 * the whole. [Davis & Rabinowitz 1984, section 4.6, on analytic integrands]
 * Of 40,000 random pairs of triangles and as many of parallelograms, .1 to 10 times as large as
 * each other, where CLEAR_POINTS_NEAR lies between and the estimate is 1e-6 to 1e-3, 28 are off by
 * more than it says, none by more than CLEAR_POINTS_REST times as much.
 * SPDX-License-Identifier: MIT */
#ifndef CLEAR_POINTS_H
#define CLEAR_POINTS_H

#include "discussion.h"

enum { CLEAR_POINTS = 16, CLEAR_PARTS = 16 };

/* Points of a face, by barycentric coordinates of its second and third corner, or along the sides
 * of a quad, and polynomials at them. */
struct clear_rule {
    int before, last; /* how many there are of the two highest degrees that are resolved */
    double at[2][CLEAR_POINTS], weight[CLEAR_POINTS];
    /* [point][part], weights included: the mean, then orthonormal ones of either degree */
    double part[CLEAR_POINTS][CLEAR_PARTS];
};

/* rules[0]: of triangles, [1]: of quads. */
void clear_rules_open(struct clear_rule rules[2]);

/* A_a F_ab (m2), and an estimate of how far it is off (m2): INFINITY where the faces are too near
 * each other for that. Each lies in front of the other. */
double clear_points(const struct clear_rule rules[2], const struct element *a,
                    const struct element *b, double *error);

#endif
