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

/* ---- links and transport (engine) */

/* ---- exchange areas (engine) */

#endif
