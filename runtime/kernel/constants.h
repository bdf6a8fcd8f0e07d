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

/* ---- visibility */

#define RAY_OFFSET 0x1p-18 /* of the scene's size. Rays start so far off their surface: 32 units in the last place of a
                              float of that size, which Embree's rounding does not cross */
#define RAY_OFFSET_BENT 4  /* times the distance of corners from their face's plane: where coordinates that came as floats
                              bend faces, rays keep off by some times that, and no more: others may be near; chosen */
#define RAY_OFFSET_BENT_MOST 0x1p-21 /* of the largest coordinate: floats are off by up to 2^-25 of it, 16 times that is
                                        the most that rounding can have bent */
#define RAY_FLAT 0.5    /* of the ray offset: a point this near to a plane lies in it, so that no ray that starts off the one
                           surface starts behind the other; chosen */
#define CONTACT_RAYS 8  /* rays per point. chosen: cosine-spread, enough that two may go astray */
#define CONTACT_BACKS 6 /* of CONTACT_RAYS that must meet backs for a point to lie inside a solid. chosen: two may meet
                           fronts of what reaches into the solid; points outside meet backs of closed solids never */

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

#endif
