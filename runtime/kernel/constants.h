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
