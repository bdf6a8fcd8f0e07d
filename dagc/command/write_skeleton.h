/* write_skeleton.h - a skeleton's files in a folder.
 * SPDX-License-Identifier: MIT */
#ifndef WRITE_SKELETON_H
#define WRITE_SKELETON_H

#include "emit/skeleton.h"

/* Where the catalog lies, seen from the folder; in the arena. */
const char *dag_seen_from(struct dag *dag, const char *folder, const char *path);

/* Makes the folders and writes what is not there yet; says both on standard output. 0 or -1 after a
 * message. */
int dag_write_skeleton(struct skeleton *skeleton, const char *folder);

#endif
