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

/* ---- links and transport (engine) */

/* ---- exchange areas (engine) */

#endif
