/* faces_reference.h - radiosities per face to measure a solution by.
 * SPDX-License-Identifier: MIT */
#ifndef FACES_REFERENCE_H
#define FACES_REFERENCE_H

#include "output/faces_table.h"
#include "scene/open_scene.h"

/* Read a table of this scene's faces, or of a sample of them. Returns 0, or -1 after a message that
 * names file and line. */
int faces_reference_read(struct faces_table *r, const char *path, const struct open_scene *scene);

/* sum A |B - B_ref| / sum A B_ref over the table's faces and the bands; NAN when out of memory. */
double faces_reference_error(const struct faces_table *r, const struct open_scene *scene,
                             RadSolution solution);

#endif
