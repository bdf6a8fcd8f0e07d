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

static const struct stability_case refine_cases[] = {
    { "brightness", "a furnished room, E times 1024", "the same links, B times 1024 exactly", "change of the number of links", "links", stability_brightness,
      { FAIL(BF_1991, 0, 1, 1000, "absolute threshold"), PASS(BF, 0), PASS(BF_GUARDED, 0) } },
    { "scale", "a furnished room of 4 mm, 4 m, 4,000 km", "the same links and B", "change of the number of links", "links", stability_scale,
      { FAIL(BF_NODES, 0, 0.5, 1, "absolute smallest area"), PASS(BF, 0), PASS(BF_GUARDED, 0) } },
    { "large_source", "a unit square under a square of 10, 1 above", "H = mean of F(x) (closed form)", "relative error of H", "links", stability_large_source,
      { PASS(BF, 1e-3), PASS(BF_GUARDED, 1e-3) } },
    { "touching_cells", "cells that touch at an edge, halved four times; two plates", "the measure falls; what a guard keeps whole is marked",
      "share of the measure that is left; of heavy links without a mark", "heavy links", stability_touching_cells,
      { FAIL(LINF_GAP, 0.1, 0.99, 1.01, "F spans .07 to .5 always"), PASS(AREA_GAP, 0.1), PASS(BF, 0), PASS(BF_GUARDED, 0) } },
    { "range_centre", "a small source close over the middle of a receiver", "the largest F(x) is found", "share of the largest F(x) missed", NULL, stability_range_centre,
      { FAIL(CORNERS, 0, 0.9, 1, "maximum inside"), PASS(SAMPLED, 1e-12), PASS(BOUNDED, 0) } },
    { "range_quarter", "the same over no special point", "the largest F(x) is found", "share of the largest F(x) missed", NULL, stability_range_quarter,
      { FAIL(CORNERS, 0, 0.9, 1, "maximum inside"), FAIL(SAMPLED, 1e-12, 0.5, 1, "maximum off the centre"), PASS(BOUNDED, 0) } },
    { "four_shadows", "four squares that shade a floor, on a mesh too coarse for two of them", "a lost shadow is told from a kept one",
      "smallest error over largest; of oracles, error in a shadow's middle", "links", stability_four_shadows,
      { FAIL(L2_NORM, 0.5, 0.5, 1, "all shadows alike"), FAIL(LINF_NORM, 0.5, 0.5, 1, "all shadows alike"), PASS(UMBRA, 0.5), PASS(BF, 0.1), PASS(BF_GUARDED, 0.1) } },
};

static const struct stability_case mesh_cases[] = {
    { "bent_quad", "a quad with its corners far out of plane", "as its two triangles, to the bit", "relative difference of B", "links", stability_bent_quad,
      { FAIL(ONE_PLANE, 0, 1e-3, 1, "it has no plane"), PASS(BF, 0), PASS(BF_GUARDED, 0) } },
    { "no_area", "triangles without area in a scene file", "dropped and counted, the rest as without them", "relative difference of B", "links", stability_no_area,
      { PASS(BF, 0), PASS(BF_GUARDED, 0) } },
};

static const struct stability_case balance_cases[] = {
    { "furnace_95", "a cube, E = 1 and rho = .95 everywhere", "B = 20", "largest relative error of B", "links", stability_furnace_95,
      { FAIL(DISC, 1e-3, 0.58, 0.6, "B = 31.7"), PASS(POLYGON, 1e-3), PASS(CONTOUR, 1e-6), PASS(BF, 1e-3), PASS(BF_GUARDED, 1e-3), PASS(CLOSED, 1e-4) } },
    { "furnace_98", "the same, rho = .98", "B = 50", "largest relative error of B", "links", stability_furnace_98,
      { FAIL(DISC, 1e-3, 18, 21, "B = 1035"), PASS(POLYGON, 1e-3), PASS(CONTOUR, 1e-6), PASS(BF, 1e-3), PASS(BF_GUARDED, 1e-3), PASS(CLOSED, 1e-4) } },
    { "furnace_99", "the same, rho = .99", "B = 100", "largest relative error of B", "links", stability_furnace_99,
      { FAIL(DISC, 1e-3, INFINITY, INFINITY, "diverges"), PASS(POLYGON, 1e-3), PASS(CONTOUR, 1e-6), PASS(BF, 1e-3), PASS(BF_GUARDED, 1e-3), PASS(CLOSED, 1e-4) } },
    { "furnace_box", "a box 2 x 1 x 1, rho = .99", "B = 100", "largest relative error of B", "links", stability_furnace_box,
      { PASS(BF, 1e-3), PASS(BF_GUARDED, 1e-3), PASS(CLOSED, 1e-4) } },
    { "furnace_L", "an L-shaped room, rho = .99", "B = 100", "largest relative error of B", "links", stability_furnace_L,
      { PASS(BF, 1e-3), PASS(BF_GUARDED, 1e-3), PASS(CLOSED, 1e-4) } },
    { "near_white", "a cube, E = 1 and rho = .999, to 1e-3", "B = 1000", "largest relative error of B", "sweeps", stability_near_white,
      { FAIL(JACOBI, 2e-3, 0.85, 0.95, "rho^100 = .9"), FAIL(NAIVE_STOP, 2e-3, 0.4, 0.6, "bound is dB/(1-rho)"), PASS(BF_GUARDED, 2e-3) } },
    { "sweeps", "a cube, rho = .5, .9, .99 and .999, to 1e-3", "Jacobi takes 10, 66, 687, 6904", "sweeps over Jacobi's ln 1e-3 / ln rho", "sweeps", stability_sweeps,
      { PASS(SWEEPS_JACOBI, 1.05), PASS(BF_GUARDED, 1) } },
    { "open_plates", "two parallel unit squares 1 apart, E = 1, rho = .5", "mean B = 1.111165, no power gained", "relative error of B", "links", stability_open_plates,
      { FAIL(NORMALISED, 1e-3, 0.79, 0.81, "B = 2"), PASS(BF, 1e-3), PASS(BF_GUARDED, 1e-3), PASS(FINE, 1e-3), PASS(CLOSED, 1e-3) } },
    { "plates_profile", "the same", "B = 1.1333, 1.1003, 1.0770 at centre, edge and corner", "largest relative error", "links", stability_plates_profile,
      { PASS(BF, 5e-2), PASS(BF_GUARDED, 5e-2), PASS(FINE, 2e-2), PASS(CLOSED, 5e-2) } },
    { "plates_edge", "two unit squares at right angles, E = 1, rho = .5", "mean B = 1.1159537, 4/3 at the edge", "largest relative error", "links", stability_plates_edge,
      { PASS(BF, 2e-1), PASS(BF_GUARDED, 2e-1), PASS(FINE, 2e-1), PASS(CLOSED, 2e-1) } },
    { "cube", "a cube, rho = .5, its ceiling E = 1", "mean B = 1.1043616, .1712161, .1811056", "largest relative error", "links", stability_cube,
      { FAIL(POLYGON, 1e-2, 0.06, 0.07, "one element a face"), FAIL(CONTOUR, 1e-2, 0.06, 0.07, "one element a face"), PASS(BF, 5e-2), PASS(BF_GUARDED, 5e-2), PASS(FINE, 5e-3), PASS(CLOSED, 5e-2) } },
    { "cavity", "a cube open at one face, walls of emissivity .1 and .5", "the opening seems .3483681 and .8111445", "largest relative error", "links", stability_cavity,
      { FAIL(POLYGON, 1e-2, 0.02, 0.03, "one element a face"), FAIL(CONTOUR, 1e-2, 0.02, 0.03, "one element a face"), PASS(BF, 1e-1), PASS(BF_GUARDED, 1e-1), PASS(FINE, 1e-2), PASS(CLOSED, 5e-2) } },
    { "sphere", "a sphere of uneven E and rho", "H = <E> / (1 - <rho>) everywhere", "relative error of H in the dark half", "links", stability_sphere,
      { PASS(BF, 1e-2), PASS(BF_GUARDED, 1e-2), PASS(CLOSED, 1e-2) } },
    { "hollow_sphere", "half of a sphere open, emissivity .1", "B = .1818", "relative error of B", "links", stability_hollow_sphere,
      { PASS(BF, 1e-2), PASS(BF_GUARDED, 1e-2), PASS(CLOSED, 1e-2) } },
    { "concentric", "spheres of radius 1/2 and 1, E = 1 within, rho = .5", "B = 10/9 and 2/9", "relative error of B without", "links", stability_concentric,
      { PASS(BF, 1e-2), PASS(BF_GUARDED, 1e-2), PASS(CLOSED, 1e-2) } },
    { "wide_plates", "plates of 8 x 8 and 16 x 16 unit squares 1 apart, E = 1 and 0, rho = .5 and .8", "infinite: B = (E1 + rho1 E2) / (1 - rho1 rho2)", "relative error of B in the middle", "links", stability_wide_plates,
      { PASS(BF, 1e-2), PASS(BF_GUARDED, 1e-2), PASS(CLOSED, 2e-2) } },
};

#define GROUP(title, cases) { title, cases, sizeof cases / sizeof *cases }

const struct stability_group stability_groups[] = {
    GROUP("form factors", factor_cases),
    GROUP("visibility", sight_cases),
    GROUP("refinement", refine_cases),
    GROUP("meshes", mesh_cases),
    GROUP("balance", balance_cases),
};
const int stability_group_count = sizeof stability_groups / sizeof *stability_groups;
