/* stability_cases.c - the failure table: every case, and what is expected of every method on it.
 *
 * Rows follow the order in which the failures are met on the way to a solution: form factors, visibility,
 * refinement, the balance. Errors of known failures are stated as ranges about what was measured, and
 * published where a source says so. "Z" Zatz 1993; "L" Lightscape's manual; other figures are our own.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "stability.h"

#define PASS(method, tolerance) { method, tolerance, NULL, 0, 0 }
#define FAIL(method, tolerance, low, high, why) { method, tolerance, why, low, high }

static const struct stability_case factor_cases[] = {
    { "shared_edge", "two unit squares at a right angle, with an edge in common", "F = .2000437761 (closed form)",
      "relative error of F", "links", stability_shared_edge,
      { FAIL(KERNEL, 1e-2, 0.58, 0.60, "1/r2 is unbounded"), FAIL(DISC, 1e-2, 0.027, 0.029, "edge, not disc"),
        FAIL(POINT, 1e-2, 0.1, 0.5, "F varies over r"), PASS(POLYGON, 1e-5), PASS(CONTOUR, 1e-8),
        PASS(BF, 1e-2), PASS(VIEWFACTORS, 1e-6), PASS(BF_GUARDED, 1e-3) } },
    { "shared_edge_halved", "the same cut in n x n, n = 1, 2, 4, 8, 16", "every halving lessens the error",
      "largest ratio of the error to the one before", NULL, stability_shared_edge_halved,
      { PASS(KERNEL, 1), FAIL(DISC, 1, 1.5, 1.65, "grows from n = 1 to 2"), PASS(POINT, 1), PASS(POLYGON, 1), PASS(CONTOUR, 1) } },
    { "close_parallel", "two unit squares .1 apart", "F = .8269945224 (closed form), at most 1",
      "relative error of F", "links", stability_close_parallel,
      { FAIL(KERNEL, 1e-2, 37, 38, "F = 31.8"), FAIL(DISC, 1e-2, 0.165, 0.175, "not a disc so near"),
        FAIL(POINT, 1e-2, 0.1, 0.3, "F varies over r"), PASS(POLYGON, 1e-5), PASS(CONTOUR, 1e-8),
        PASS(BF, 1e-2), PASS(VIEWFACTORS, 1e-6), PASS(BF_GUARDED, 1e-3) } },
    { "half_apart", "two unit squares .5 apart, where the disc is worst", "F = .4152 (closed form)",
      "relative error of F", "links", stability_half_apart,
      { FAIL(KERNEL, 1e-2, 2, 2.2, "F = 1.27"), FAIL(DISC, 1e-2, 0.34, 0.36, "not a disc so near"),
        FAIL(POINT, 1e-2, 0.1, 0.4, "F varies over r"), PASS(POLYGON, 1e-5), PASS(CONTOUR, 1e-8),
        PASS(BF, 1e-2), PASS(VIEWFACTORS, 1e-6), PASS(BF_GUARDED, 1e-3) } },
    { "row_sum", "the six faces of a cube", "the sum of F is 1", "|sum - 1|", "links", stability_row_sum,
      { FAIL(KERNEL, 1e-3, 0.2, 2, "1/r2 is unbounded"), FAIL(DISC, 1e-3, 0.0194, 0.0195, "sum 1.0194"),
        FAIL(POINT, 1e-3, 0, 1, "?"), PASS(POLYGON, 1e-5), PASS(CONTOUR, 1e-8), PASS(BF, 1e-2), PASS(VIEWFACTORS, 1e-6), PASS(BF_GUARDED, 1e-3) } },
    { "straddle", "a wall that crosses the floor's plane: half of it sees the floor", "half of F for the upper half (closed form)",
      "relative error of F", "links", stability_straddle,
      { FAIL(KERNEL, 1e-2, 1, 1, "F = 0, cosine of centre"), FAIL(DISC, 1e-2, 1, 1, "F = 0, cosine of centre"),
        FAIL(POINT, 1e-2, 0, 1, "F = 0, centre in plane"), PASS(POLYGON, 1e-5), PASS(CONTOUR, 1e-8),
        PASS(BF, 1e-2), PASS(VIEWFACTORS, 1e-6), PASS(BF_GUARDED, 1e-3) } },
    { "straddle_children", "the same, the wall in quarters", "A F of the quarters sums to A F of the whole",
      "difference as a share of A F", NULL, stability_straddle_children,
      { FAIL(KERNEL, 1e-2, 0.1, 2, "cosines cut off at 0"), FAIL(DISC, 1e-2, 0.1, 2, "cosines cut off at 0"),
        FAIL(POINT, 1e-2, 0.1, 2, "centre in plane"), PASS(POLYGON, 1e-5), PASS(CONTOUR, 1e-8) } },
    { "coplanar", "pairs in one plane that lies anyhow in space", "F = 0 exactly; no link, no ray",
      "share of pairs with F > 0 (links or rays)", NULL, stability_coplanar,
      { FAIL(KERNEL, 0, 0.05, 0.5, "sign of rounding"), FAIL(DISC, 0, 0.05, 0.5, "sign of rounding"),
        FAIL(POINT, 0, 0.05, 0.5, "sign of rounding"), FAIL(POLYGON, 0, 0.0, 0.5, "sign of rounding"), FAIL(CONTOUR, 0, 0.0, 0.5, "sign of rounding"),
        PASS(BF, 0), PASS(VIEWFACTORS, 0), PASS(BF_GUARDED, 0) } },
    { "sliver", "a strip 1e-4 x 1 over its like, .01 apart", "F by the closed form", "relative error of F", "links", stability_sliver,
      { FAIL(KERNEL, 1e-2, 0, 100, "length ignored"), FAIL(DISC, 1e-2, 0, 100, "length ignored"),
        FAIL(POINT, 1e-2, 0, 1, "?"), PASS(POLYGON, 1e-5), PASS(CONTOUR, 1e-6), PASS(BF, 1e-2), PASS(VIEWFACTORS, 1e-6), PASS(BF_GUARDED, 1e-3) } },
    { "sliver_standing", "a skirting 1e-4 x 1 on a unit floor's edge", "F by the closed form", "relative error of F", "links", stability_sliver_standing,
      { FAIL(KERNEL, 1e-2, 0, 100, "length ignored"), FAIL(DISC, 1e-2, 0, 100, "length ignored"),
        FAIL(POINT, 1e-2, 0, 1, "?"), PASS(POLYGON, 1e-5), PASS(CONTOUR, 1e-6), PASS(BF, 1e-2), PASS(VIEWFACTORS, 1e-6), PASS(BF_GUARDED, 1e-3) } },
    { "scale_far", "two squares, all lengths times 1024", "F stays, to the bit", "relative change of F", NULL, stability_scale_far,
      { PASS(KERNEL, 0), FAIL(CULLED, 0, 1, 1, "every pair beyond 564"), PASS(DISC, 0), PASS(POINT, 0), PASS(POLYGON, 0), PASS(CONTOUR, 0),
        PASS(BF, 0), PASS(VIEWFACTORS, 0), PASS(BF_GUARDED, 0) } },
    { "degenerate_factor", "a triangle with its corners on a line, and a square", "F = 0 both ways, never NaN", "largest |F|", NULL, stability_degenerate_factor,
      { PASS(KERNEL, 0), PASS(DISC, 0), PASS(POINT, 0), PASS(POLYGON, 0), PASS(CONTOUR, 0) } },
    { "closed_forms", "sixteen pairs of rectangles, aligned or at right angles", "the closed forms", "largest relative error of F", NULL, stability_closed_forms,
      { FAIL(KERNEL, 1e-2, 1, INFINITY, "near"), FAIL(DISC, 1e-2, 0.2, 10, "near"), FAIL(POINT, 1e-2, 0, 10, "near"),
        PASS(POLYGON, 1e-4), PASS(CONTOUR, 1e-6), PASS(BF, 1e-2), PASS(VIEWFACTORS, 1e-6), PASS(BF_GUARDED, 1e-3) } },
};

static const struct stability_case sight_cases[] = {
    { "tiny_blocker", "a square that hides a tenth of a source, in many places", "it is never missed",
      "share of the places where F V is within 1 % of the clear value", "rays", stability_tiny_blocker,
      { FAIL(RAYS_4, 0.01, 0.4, 0.8, "missed by (1-p)^4"), FAIL(RAYS_16, 0.01, 0.02, 0.3, "missed by (1-p)^16"),
        PASS(RAYS_64, 0.01), PASS(BF, 0), PASS(VIEWFACTORS, 0), PASS(BF_GUARDED, 0) } },
    { "penumbra", "points under a unit source and a square of .75 in the middle: umbra, half shadow, clear", "F V by the closed form",
      "largest error of F V", "rays", stability_penumbra,
      { FAIL(RAYS_4, 1e-3, 3e-3, 3e-2, "V in quarters"), FAIL(RAYS_16, 1e-3, 1e-3, 1e-2, "V in sixteenths"),
        PASS(RAYS_64, 1e-3), PASS(BF, 1e-2), PASS(VIEWFACTORS, 1e-3), PASS(BF_GUARDED, 1e-3) } },
    { "obstructed", "two unit squares, a quarter of the plane between them blocked", "3/4 of the clear F", "error of F V", "rays", stability_obstructed,
      { FAIL(RAYS_4, 1e-3, 1e-3, 1e-1, "V in quarters"), FAIL(RAYS_16, 1e-3, 1e-3, 1e-1, "V in sixteenths"),
        PASS(RAYS_64, 1e-3), PASS(BF, 1e-2), PASS(VIEWFACTORS, 1e-3), PASS(BF_GUARDED, 1e-3) } },
    { "thin_wall", "a wall without thickness between a lit and a dark room, its front to either side", "no light in the dark room",
      "largest B there over the mean of all", "links", stability_thin_wall,
      { FAIL(FRONTS, 0, 0.01, 1, "a back stops no ray"), PASS(RAYS_4, 0), PASS(RAYS_16, 0), PASS(RAYS_64, 0), PASS(BF, 0), PASS(BF_GUARDED, 0) } },
    { "wall_in_floor", "the same, floor, ceiling and sides each one face through both rooms", "no light on leaves beyond the wall",
      "largest B there over the mean of all", "links", stability_wall_in_floor,
      { PASS(BF, 0.01), PASS(BF_GUARDED, 0.01) } },
    { "far_from_zero", "a lit box with a shelf, 2^20 m from the origin, and a square outside it", "as at the origin; no light outside",
      "largest relative change, or share of light outside", "rays", stability_far_from_zero,
      { FAIL(FIXED_EPSILON, 1e-2, 0.01, 100, "float steps of .06 m"), PASS(RAYS_4, 1e-2), PASS(RAYS_64, 1e-2), PASS(BF, 1e-2), PASS(BF_GUARDED, 1e-2) } },
};

#define GROUP(title, cases) { title, cases, sizeof cases / sizeof *cases }

const struct stability_group stability_groups[] = {
    GROUP("form factors", factor_cases),
    GROUP("visibility", sight_cases),
};
const int stability_group_count = sizeof stability_groups / sizeof *stability_groups;
