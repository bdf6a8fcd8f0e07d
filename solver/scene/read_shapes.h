/* read_shapes.h - the formats of shape alone: PLY, STL and OFF.
 *
 * One polygon per face, in the file's order, all of one material, which the caller sets. What a
 * file counts is held against what it has: a file that was cut or damaged is refused, with the line
 * where it is a text.
 * [Turk 1994, The PLY Polygon File Format; 3D Systems 1989, StereoLithography Interface
 * Specification; Geomview manual, OFF]
 * SPDX-License-Identifier: MIT */
#ifndef READ_SHAPES_H
#define READ_SHAPES_H

#include "scene/scene_file.h"

/* Fill an empty file, whose size and text the caller has read; the text is changed. Warn unless
 * `quiet`. Each returns 0, or -1 after one line on stderr. */
int read_ply(struct scene_file *file, const char *path, char *text, size_t size, int quiet);
int read_stl(struct scene_file *file, const char *path, char *text, size_t size, int quiet);
int read_off(struct scene_file *file, const char *path, char *text, size_t size, int quiet);

#endif
