/* constants.h - every threshold that decides an answer: its value, unit, and reason.
 *
 * One home for each, and this is the page that lists them. The reason is a source, a derivation, or
 * the command that measured it; "chosen" says that there is none yet. What merely bounds work
 * (buffers, chunks of a loop) stays where it is used. Headers of tools and terms may use these:
 * dagc --standalone copies the ones that a graph reaches.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_CONSTANTS_H
#define KERNEL_CONSTANTS_H

/* ---- geometry of a pair (kernel, terms, tools) */

/* ---- scenes (hierarchy) */

/* Coordinates are off by at most their relative rounding times the largest of them. */
/* relative. Rounding of a float: half a unit in its last place [IEEE 754] */
#define SCENE_SINGLE 0x1p-24
#define SCENE_DOUBLE 0x1p-53 /* relative. The same of a double */
/* of a quad's size. Corners no farther from its mean plane make it flat, else it is two
 * triangles. Chosen */
#define SCENE_FLAT_QUAD 1e-4
/* of the scene's extent. Where corners have been floats, they must be no farther either: rays
 * keep 2^-18 of the extent off surfaces, four times that, so that none meets the quad it leaves */
#define SCENE_FLAT_ROUNDED 0x1p-20
/* of its longest diagonal. A polygon no wider than that has no area. Chosen: far above the
 * rounding of its area */
#define SCENE_THIN 1e-7
/* roundings of its largest coordinate. The same: of two corners, each may be off by one */
#define SCENE_THIN_ROUNDINGS 2

/* Faces cut where others stand (hierarchy/cut_faces.c); `size` is the longest diagonal of the
 * face that is cut. */
/* of the size. Nearer than that to a plane is in it, and lengths that differ by less are equal.
 * Chosen: modellers leave gaps of a tenth of a millimetre in rooms of metres */
#define CUT_TOUCH 1e-4
/* roundings of the largest coordinate. The same: both faces may be off, each by two corners */
#define CUT_TOUCH_ROUNDINGS 4
/* radians, and of the size. Lines that near to each other are one. As CUT_TOUCH */
#define CUT_SAME_LINE 1e-4
#define CUT_SLIVER 1e-4 /* of the size. No cut leaves less than that on a side. As CUT_TOUCH */
/* of the size. A cut that near to a corner goes through it, so that no edge is shorter. Chosen,
 * below CUT_SLIVER */
#define CUT_CORNER 1e-5
/* sine. Planes at a smaller angle have no line of contact to speak of. Chosen */
#define CUT_PARALLEL 0.01
/* of a chord. Contacts that cover less of it do not cut: a wall with a door does, the leg of a
 * table does not. Chosen */
#define CUT_COVER 0.5

/* faces. The default tree of fewer is of halves, of more by the surface-area heuristic: below
 * this no shipped graph links clusters, and the tree decides only in which order pairs are
 * found; chosen */
#define CLUSTERS_FACES 1000
/* of a cluster's area: a mean normal no longer than that, times area, points nowhere; rounding
 * of a sum */
#define CONE_LEAST 1e-9
/* of a cosine: normals no farther apart count as equal, so that flat clusters have a cone of
 * angle 0; what rounding leaves of two unit vectors' product */
#define CONE_EQUAL 1e-14
/* between the normals of a coplanar group's faces, least: 0.26 degrees. chosen; heights decide
 * before it */
#define GROUP_COSINE 0.99999
/* of a unit normal: neighbours in the order of one coordinate that are farther apart are not in
 * one plane; chosen, above the rounding of corners given as floats */
#define GROUP_NORMAL_GAP 1e-5
/* of host.flat: the same of heights; half, since a corner may be off either way */
#define GROUP_HEIGHT_GAP 0.5
/* of a group's rectangle: so much may its faces' areas be off and still tile it; chosen, above
 * what GROUP_COSINE and rounding of corners make of areas */
#define GROUP_GAPS 1e-5
/* of the scene's size: middles of faces no farther apart are in one row, which is not cut;
 * chosen */
#define GROUP_SAME_PLACE 1e-6
/* faces of a lowest group. Shadows are found group by group: 16 are as good as 8 or 32, by the
 * seconds of `radiosity viewfactors` on rooms of make_room.h */
#define LOWEST_GROUP 16

/* ---- visibility */

/* of the scene's size. Rays start so far off their surface: 32 units in the last place of a
 * float of that size, which Embree's rounding does not cross */
#define RAY_OFFSET 0x1p-18
/* of the ray offset: a point this near to a plane lies in it, so that no ray that starts off the
 * one surface starts behind the other; chosen */
#define RAY_FLAT 0.5
#define CONTACT_RAYS 8 /* rays per point. chosen: cosine-spread, enough that two may go astray */
/* of CONTACT_RAYS that must meet backs for a point to lie inside a solid. chosen: two may meet
 * fronts of what reaches into the solid; points outside meet backs of closed solids never */
#define CONTACT_BACKS 6
/* of the rays from a point: when so many meet backs, it lies inside a solid. As CONTACT_BACKS of
 * CONTACT_RAYS */
#define ENVIRONMENT_BACKS 0.75
/* of the steps of all walks: so many may end and the scene still counts as closed, for rounding
 * lets a ray through a crack between faces now and then. What can be missed is an opening of
 * that share of all area; one of 1e-4 is found with a probability of 99.99 %
 * (visibility/enclosure.c) */
#define ENCLOSURE_CRACKS 2e-5

/* ---- links and transport (engine) */

/* relative. What an oracle sees of radiosity, spread and importance lags this far behind the
 * truth, so that passes end; chosen, below the 5 % that the oracles' own thresholds decide by */
#define HYSTERESIS 0.02
/* relative L1 error of B. Where groups are linked, passes before the last ones solve to this: a
 * quarter of HYSTERESIS, so that oracles do not notice; must stay below it */
#define ROUGH_TOLERANCE 0.005
/* links per changed link. Passes solve to the tolerance once no more links change than one in
 * this many; chosen: so few cannot bring many others to change */
#define SETTLED 1000
/* of 1 - rho: how far the cap may exceed 1 where a face's mean row does. Below 1 the iteration
 * converges, rho (1 + (1 - rho)) < 1; half of it leaves it a rate. derived in row_sums.c */
#define ROW_EXCESS 0.5
/* of the cap. Leaves whose row is below this take nothing of what is capped off others: their
 * row is small because something stands before them, not by error; chosen */
#define ROW_SHADOW 0.5
/* of the largest importance. What oracles see is no less, so that nothing divides by 0; chosen,
 * far below what a picture of 8 bits shows */
#define IMPORTANCE_LEAST 1e-4
/* factor by which an error tolerance falls per pass; Bekaert and Willems 1996 */
#define ERROR_STEP 1.4
/* of the error to be held: the most that all links of a leaf may bring together by the oracle's
 * own measure before the leaf is given up; chosen */
#define ERROR_ENOUGH 0.25
/* cosine. A side whose mean normal is turned less than this to the other side is seen on edge:
 * that normal says nothing of what passes, only the place does; chosen */
#define PIVOT_RELIABLE 0.3

/* ---- exchange areas (engine) */

/* of a row's sum. The default, and the tolerance that the limits of
 * examples/oracles/viewfactors.dag are made for: chosen */
#define EXCHANGE_TOLERANCE 3e-4
/* sums of two faces' radii. Pairs nearer than that have the contour integral at
 * EXCHANGE_TOLERANCE; the error of the others falls with the fourth power of distance */
#define EXCHANGE_NEAR 2.5
/* the same at any tolerance. chosen: nearer, the series in size over distance need not converge */
#define EXCHANGE_NEAR_LEAST 1.5
/* power of the tolerance by which EXCHANGE_NEAR changes: one over that of the error's fall */
#define EXCHANGE_NEAR_FALL 0.25
/* of a row's sum: what reciprocal closure may leave. chosen: all twelve digits that are written */
#define CLOSURE_ENOUGH 1e-12

/* ---- pictures and meshes (solver/output) */

/* of a face's size: what is nearer stands on it, as faces are cut where others are that near */
#define OUTPUT_TOUCH 1e-4
/* cosine of one degree: faces turned less are one surface. chosen: flat when shaded */
#define OUTPUT_SAME_PLANE 0.99985
/* sine between two planes below which they have no line to speak of, as where faces are cut */
#define OUTPUT_NO_LINE 0.01
#define OUTPUT_SAME_LINE 0.999998 /* cosine of a tenth of a degree: one direction. chosen */
#define OUTPUT_REACH 4            /* OUTPUT_TOUCHes along a wall and ... */
/* ... up it, where it must be to stand here. chosen: clear of what touches, near enough to be
 * local */
#define OUTPUT_RISE 3
/* where the log-mean of a picture goes. chosen: 0.18 is a film's middle grey, rooms with bright
 * walls want more */
#define EXPOSURE_MIDDLE 0.34
/* share of a picture that is darker than what the shoulder is measured by. chosen: lamps and
 * highlights are less */
#define EXPOSURE_BRIGHT 0.98

#endif
