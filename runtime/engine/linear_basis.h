/* linear_basis.h - functions linear over a surface, B(x) = b0 + b1 phi_1(x) + b2 phi_2(x).
 *
 * phi_a(x) = g_a . (x - centroid), orthonormal over the element: the mean of phi_a phi_b is 1 for a
 * = b, else 0, and that of phi_a is 0; so b0 is the mean of B whatever the slopes are, and a
 * projection onto the three is three means. With the second moments M = mean of (x - c)(x - c)^T in
 * the plane, M = L L^T, the g_a are the columns of L^-T and d_a = M g_a those of L, for which d_a .
 * g_b is 1 or 0: a linear function of gradient g has b_a = d_a . g. Of a parallelogram that is
 * sqrt(3) times its own coordinates from -1 to 1; of triangles and other quads the same formulas.
 *
 * Two-scale relations, exact: phi_a of an element, on part j of it, is g_a . (c_j - c) + sum_b (d_b
 * of j . g_a) phi_b of j.
 * SPDX-License-Identifier: MIT */
#ifndef LINEAR_BASIS_H
#define LINEAR_BASIS_H

#include "discussion.h"

struct linear_basis {
    double g[2][3]; /* 1/m */
    double d[2][3]; /* m */
};

/* Of a surface. A direction in which it has no extent to speak of has phi = 0. */
void linear_basis_of(struct linear_basis *basis, const struct element *e);

/* phi_1 and phi_2 at x. */
static inline void linear_basis_at(const struct linear_basis *basis, const double centre[3],
                                   const double x[3], double phi[2])
{
    double away[3];
    sub3(away, x, centre);
    phi[0] = dot3(basis->g[0], away);
    phi[1] = dot3(basis->g[1], away);
}

/* The least and the largest value of b1 phi_1 + b2 phi_2, which a convex polygon has at corners. */
void linear_basis_range(const struct linear_basis *basis, const struct element *e,
                        const double b[2], double *least, double *most);

/* How phi_a of `e` is made up on its part `child`: mean[a], and from[a][b] of the child's phi_b. */
struct two_scale {
    double mean[2], from[2][2];
};
void linear_two_scale(struct two_scale *t, const struct linear_basis *basis,
                      const struct element *e, const struct linear_basis *of_child,
                      const struct element *child);

#endif
