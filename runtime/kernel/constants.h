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

/* Coordinates are off by at most their relative rounding times the largest of them. */
#define SCENE_SINGLE 0x1p-24 /* relative. Rounding of a float: half a unit in its last place [IEEE 754] */
#define SCENE_DOUBLE 0x1p-53 /* relative. The same of a double */
#define SCENE_FLAT_QUAD 1e-4 /* of a quad's size. Corners no farther from its mean plane make it flat, else it is two triangles. Chosen */
#define SCENE_FLAT_ROUNDED 0x1p-20 /* of the scene's extent. Where corners have been floats, they must be no farther either: rays keep
                                    * 2^-18 of the extent off surfaces, four times that, so that none meets the quad it leaves */
#define SCENE_THIN 1e-7 /* of its longest diagonal. A polygon no wider than that has no area. Chosen: far above the rounding of its area */
#define SCENE_THIN_ROUNDINGS 2 /* roundings of its largest coordinate. The same: of two corners, each may be off by one */

/* Faces cut where others stand (hierarchy/cut_faces.c); `size` is the longest diagonal of the face that is cut. */
#define CUT_TOUCH 1e-4 /* of the size. Nearer than that to a plane is in it, and lengths that differ by less are equal. Chosen: modellers
                        * leave gaps of a tenth of a millimetre in rooms of metres */
#define CUT_TOUCH_ROUNDINGS 4 /* roundings of the largest coordinate. The same: both faces may be off, each by two corners */
#define CUT_SAME_LINE 1e-4 /* radians, and of the size. Lines that near to each other are one. As CUT_TOUCH */
#define CUT_SLIVER 1e-4 /* of the size. No cut leaves less than that on a side. As CUT_TOUCH */
#define CUT_CORNER 1e-5 /* of the size. A cut that near to a corner goes through it, so that no edge is shorter. Chosen, below CUT_SLIVER */
#define CUT_PARALLEL 0.01 /* sine. Planes at a smaller angle have no line of contact to speak of. Chosen */
#define CUT_COVER 0.5 /* of a chord. Contacts that cover less of it do not cut: a wall with a door does, the leg of a table does not. Chosen */

/* ---- visibility */

/* ---- links and transport (engine) */

/* ---- exchange areas (engine) */

#endif
