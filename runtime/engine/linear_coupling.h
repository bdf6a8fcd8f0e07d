/* linear_coupling.h - what linear functions on two surfaces exchange:
 *     C_ab = 1/A_r  int over r  int over s  phi_a(x) k(x, y) phi_b(y)   (a, b = 0, 1, 2; phi_0 =
 *     1),
 * k Lambert's kernel, nothing in between. Then H_a += V sum_b C_ab B_b.
 *
 * Quadrature that fits the distance. Of cells apart, the farther the fewer points each (2 x 2 or 3
 * x 3 in quads, 3 or 6 in triangles); of cells near each other the larger is quartered, or halved
 * across where it is long, and so on down to LINEAR_CELL of the smaller element. Cells that still
 * touch take the exact factor from points to polygons, both ways round, and as the kernel between
 * them what these two say as a product. C_00 is not computed but the link's own F, to which the
 * others are scaled, so that constants are what they are without slopes.
 *
 * k >= 0, so light is never negative; its projection K(x, y) = sum C_ab phi_a(x) phi_b(y) may be,
 * where elements touch or differ much in size. To limit a coupling is to make K >= 0 with the same
 * F: first the two marginals, F + sum C_a0 phi_a(x) and F + sum C_0b phi_b(y), by a factor each
 * where they need it; then what K has beside the marginals' product by the largest factor that will
 * do. What a nonnegative function sends is nonnegative then. It costs accuracy (all links limited:
 * a tenth more error in coarse solutions of rooms), so links in half shadow are limited, whose
 * couplings are guesses anyway, and those that have brought negative light (linear_solution.c).
 * The limits treat both sides alike: A_r C_ab(r, s) = A_s C_ba(s, r) stays.
 * [Zatz 1993 for higher orders; Gortler et al. 1993 for hierarchies of them; the limits: derived
 * here]
 * SPDX-License-Identifier: MIT */
#ifndef LINEAR_COUPLING_H
#define LINEAR_COUPLING_H

#include "engine/linear_basis.h"

/* C[a][b] without C_00, which is F: in this order. */
enum { LINEAR_01, LINEAR_02, LINEAR_10, LINEAR_11, LINEAR_12, LINEAR_20, LINEAR_21, LINEAR_22 };
enum { LINEAR_MOMENTS = 8 };

/* A side: a surface and its basis. */
struct linear_side {
    const struct element *element;
    const struct linear_basis *basis;
};

/* All nine by quadrature, C_00 too, without limits. */
void linear_coupling_integrate(double c[3][3], struct linear_side r, struct linear_side s);

/* The same in vectors of a width, lanes_width() at the most. Returns how many pairs of cells it
 * took. */
long linear_coupling_at(int width, double c[3][3], struct linear_side r, struct linear_side s);

/* Scale to the form factor F of the link. */
void linear_coupling_scale(double c[3][3], double form_factor);

/* Make K nonnegative. */
void linear_coupling_limit(double c[3][3], struct linear_side r, struct linear_side s);

#endif
