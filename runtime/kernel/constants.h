/* constants.h - every threshold that decides an answer: its value, unit, and reason.
 *
 * One home for each, and this is the page that lists them. The reason is a source, a derivation, or the command that
 * measured it; "chosen" says that there is none yet. What merely bounds work (buffers, chunks of a loop) stays where it is used.
 * Headers of tools and terms may use these: dagc --standalone copies the ones that a graph reaches.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_CONSTANTS_H
#define KERNEL_CONSTANTS_H

/* ---- geometry of a pair (kernel, terms, tools) */

/* ---- scenes (hierarchy) */

#define CLUSTERS_FACES 1000 /* faces. The default tree of fewer is of halves, of more by the surface-area heuristic: below this no
                               shipped graph links clusters, and the tree decides only in which order pairs are found; chosen */
#define CONE_LEAST 1e-9 /* of a cluster's area: a mean normal no longer than that, times area, points nowhere; rounding of a sum */
#define CONE_EQUAL 1e-14 /* of a cosine: normals no farther apart count as equal, so that flat clusters have a cone of angle 0;
                            what rounding leaves of two unit vectors' product */
#define GROUP_COSINE 0.99999 /* between the normals of a coplanar group's faces, least: 0.26 degrees. chosen; heights decide before it */
#define GROUP_NORMAL_GAP 1e-5 /* of a unit normal: neighbours in the order of one coordinate that are farther apart are not in one
                                 plane; chosen, above the rounding of corners given as floats */
#define GROUP_HEIGHT_GAP 0.5 /* of host.flat: the same of heights; half, since a corner may be off either way */
#define GROUP_GAPS 1e-5 /* of a group's rectangle: so much may its faces' areas be off and still tile it; chosen, above what
                           GROUP_COSINE and rounding of corners make of areas */
#define GROUP_SAME_PLACE 1e-6 /* of the scene's size: middles of faces no farther apart are in one row, which is not cut; chosen */
#define LOWEST_GROUP 16 /* faces of a lowest group. Shadows are found group by group: 16 are as good as 8 or 32, by the seconds of
                          `radiosity viewfactors` on rooms of make_room.h */

#define SCENE_FLAT_QUAD 1e-4 /* of a quad's size: corners no farther from its mean plane make it flat, else it is two triangles. Chosen */

/* ---- visibility */

#define ENVIRONMENT_BACKS 0.75 /* of the rays from a point: when so many meet backs, it lies inside a solid. As CONTACT_BACKS of
                                  CONTACT_RAYS */
#define ENCLOSURE_CRACKS 2e-5 /* of the steps of all walks: so many may end and the scene still counts as closed, for rounding lets a
                                 ray through a crack between faces now and then. What can be missed is an opening of that share of
                                 all area; one of 1e-4 is found with a probability of 99.99 % (visibility/enclosure.c) */

/* ---- links and transport (engine) */

/* ---- exchange areas (engine) */

#define EXCHANGE_TOLERANCE 3e-4 /* of a row's sum. The default, and the tolerance that the limits of examples/oracles/viewfactors.dag
                                   are made for: chosen */
#define EXCHANGE_NEAR 2.5 /* sums of two faces' radii. Pairs nearer than that have the contour integral at EXCHANGE_TOLERANCE; the
                             error of the others falls with the fourth power of distance */
#define EXCHANGE_NEAR_LEAST 1.5 /* the same at any tolerance. chosen: nearer, the series in size over distance need not converge */
#define EXCHANGE_NEAR_FALL 0.25 /* power of the tolerance by which EXCHANGE_NEAR changes: one over that of the error's fall */
#define CLOSURE_ENOUGH 1e-12 /* of a row's sum: what reciprocal closure may leave. chosen: all twelve digits that are written */

#endif
