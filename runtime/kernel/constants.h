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

/* Coordinates are off by their relative rounding, SCENE_SINGLE or SCENE_DOUBLE, times the largest of them. */
#define SCENE_SINGLE 0x1p-24      /* relative rounding of a float [IEEE 754] */
#define SCENE_DOUBLE 0x1p-53      /* of a double */
#define SCENE_FLAT_QUAD 1e-4      /* of a quad's size: corners no farther from its mean plane make it flat, else it is two triangles. Chosen */
#define SCENE_FLAT_ROUNDED 0x1p-20 /* of the scene's extent: the same for a quad whose corners have been floats. A quarter of what rays keep
                                   * off surfaces (VISIBILITY ray_offset), so that no ray from a quad meets it */
#define SCENE_THIN 1e-7           /* of its longest diagonal: a polygon no wider than that has no area. Chosen: well above the rounding of its area */
#define SCENE_THIN_ROUNDINGS 2    /* roundings of its largest coordinate: the same. Two corners may both be off, to either side */

/* ---- visibility */

#define RAY_OFFSET 0x1p-18 /* of the scene's size. Rays start so far off their surface: 32 units in the last place of a
                              float of that size, which Embree's rounding does not cross */
#define RAY_FLAT 0.5    /* of the ray offset: a point this near to a plane lies in it, so that no ray that starts off the one
                           surface starts behind the other; chosen */
#define CONTACT_RAYS 8  /* rays per point. chosen: cosine-spread, enough that two may go astray */
#define CONTACT_BACKS 6 /* of CONTACT_RAYS that must meet backs for a point to lie inside a solid. chosen: two may meet
                           fronts of what reaches into the solid; points outside meet backs of closed solids never */
#define ENVIRONMENT_BACKS 0.75 /* of the rays from a point: when so many meet backs, it lies inside a solid. As CONTACT_BACKS of
                                  CONTACT_RAYS */
#define ENCLOSURE_CRACKS 2e-5 /* of the steps of all walks: so many may end and the scene still counts as closed, for rounding lets a
                                 ray through a crack between faces now and then. What can be missed is an opening of that share of
                                 all area; one of 1e-4 is found with a probability of 99.99 % (visibility/enclosure.c) */

/* ---- links and transport (engine) */

#define HYSTERESIS 0.02 /* relative. What an oracle sees of radiosity, spread and importance lags this far behind the
                           truth, so that passes end; chosen, below the 5 % that the oracles' own thresholds decide by */
#define ROUGH_TOLERANCE 0.005 /* relative L1 error of B. Where groups are linked, passes before the last ones solve to
                                 this: a quarter of HYSTERESIS, so that oracles do not notice; must stay below it */
#define SETTLED 1000    /* links per changed link. Passes solve to the tolerance once no more links change than one in
                           this many; chosen: so few cannot bring many others to change */
#define ROW_EXCESS 0.5  /* of 1 - rho: how far the cap may exceed 1 where a face's mean row does. Below 1 the iteration
                           converges, rho (1 + (1 - rho)) < 1; half of it leaves it a rate. derived in row_sums.c */
#define ROW_SHADOW 0.5  /* of the cap. Leaves whose row is below this take nothing of what is capped off others: their
                           row is small because something stands before them, not by error; chosen */
#define IMPORTANCE_LEAST 1e-4 /* of the largest importance. What oracles see is no less, so that nothing divides by 0;
                                 chosen, far below what a picture of 8 bits shows */
#define ERROR_STEP 1.4  /* factor by which an error tolerance falls per pass; Bekaert and Willems 1996 */
#define ERROR_ENOUGH 0.25 /* of the error to be held: the most that all links of a leaf may bring together by the
                             oracle's own measure before the leaf is given up; chosen */
#define PIVOT_RELIABLE 0.3 /* cosine. A side whose mean normal is turned less than this to the other side is seen on
                              edge: that normal says nothing of what passes, only the place does; chosen */

/* ---- exchange areas (engine) */

#define EXCHANGE_TOLERANCE 3e-4 /* of a row's sum. The default, and the tolerance that the limits of examples/oracles/viewfactors.dag
                                   are made for: chosen */
#define EXCHANGE_NEAR 2.5 /* sums of two faces' radii. Pairs nearer than that have the contour integral at EXCHANGE_TOLERANCE; the
                             error of the others falls with the fourth power of distance */
#define EXCHANGE_NEAR_LEAST 1.5 /* the same at any tolerance. chosen: nearer, the series in size over distance need not converge */
#define EXCHANGE_NEAR_FALL 0.25 /* power of the tolerance by which EXCHANGE_NEAR changes: one over that of the error's fall */
#define CLOSURE_ENOUGH 1e-12 /* of a row's sum: what reciprocal closure may leave. chosen: all twelve digits that are written */

/* ---- pictures and meshes (solver/output) */

#define OUTPUT_TOUCH 1e-4 /* of a face's size: what is nearer stands on it, as faces are cut where others are that near */
#define OUTPUT_SAME_PLANE 0.99985 /* cosine of one degree: faces turned less are one surface. chosen: flat when shaded */
#define OUTPUT_NO_LINE 0.01 /* sine between two planes below which they have no line to speak of, as where faces are cut */
#define OUTPUT_SAME_LINE 0.999998 /* cosine of a tenth of a degree: one direction. chosen */
#define OUTPUT_REACH 4 /* OUTPUT_TOUCHes along a wall and ... */
#define OUTPUT_RISE 3  /* ... up it, where it must be to stand here. chosen: clear of what touches, near enough to be local */
#define EXPOSURE_MIDDLE 0.34 /* where the log-mean of a picture goes. chosen: 0.18 is a film's middle grey, rooms with
                                bright walls want more */
#define EXPOSURE_BRIGHT 0.98 /* share of a picture that is darker than what the shoulder is measured by. chosen: lamps
                                and highlights are less */

#endif
