/* skeleton.h - the files of a program for a catalog.
 * SPDX-License-Identifier: MIT */
#ifndef SKELETON_H
#define SKELETON_H

#include "base/internal.h"

struct skeleton_file {
    const char *name; /* "tools/look.h" */
    struct text text; /* for dag_text_free */
};

struct skeleton {
    struct dag *dag;
    const char *catalog; /* its path as the folder's makefile needs it */
    int cxx;             /* a program in C++ */
    const char *name;    /* of the graph; set by dag_emit_skeleton */
    struct skeleton_file *files;
    int file_count;
};

void dag_emit_skeleton(struct skeleton *skeleton);

/* emit_first_graph.c. Adds the graph's file; -1 after an error: no graph can be made. */
int dag_skeleton_graph(struct skeleton *skeleton);

/* The text of a new file. */
struct text *dag_skeleton_add(struct skeleton *skeleton, const char *name);

#endif
