/* import_child.h - a scene file read in a process of its own, by code that may crash, hang or take
 * all memory when the file is damaged.
 *
 * The child has limits on processor time and memory, which grow with the size of the file, and
 * hands what it has read back through a pipe, as the arrays of a scene_file. What comes is
 * checked here: a child whose memory is spoiled may send anything.
 * SPDX-License-Identifier: MIT */
#ifndef IMPORT_CHILD_H
#define IMPORT_CHILD_H

#include "scene/scene_file.h"

/* What the child runs: fill an empty file. Returns 0; -1 after one line on stderr; IMPORT_MEMORY
 * after none, when memory did not suffice. It may do to its process what it likes. */
typedef int import_reader(struct scene_file *file, const char *path);
enum { IMPORT_MEMORY = 1 };

/* Fill an empty file. Returns 0, or -1 after one line on stderr. */
int import_in_child(struct scene_file *file, const char *path, import_reader *read);

#endif
