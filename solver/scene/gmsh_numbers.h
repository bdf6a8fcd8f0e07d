/* gmsh_numbers.h - the numbers of a section of a Gmsh mesh, which is text or binary.
 *
 * What is a line and what a word in a text is nothing and a number of known size in a binary
 * section. There lines only count up to the section, which messages name. Each of these returns 0,
 * or -1 after a message, which says `what` was to come.
 * SPDX-License-Identifier: MIT */
#ifndef GMSH_NUMBERS_H
#define GMSH_NUMBERS_H

#include "scene/mesh_parts.h"
#include "scene/text_lines.h"

struct gmsh_numbers {
    const struct mesh *mesh; /* whose file messages name */
    struct text_lines lines;
    int version; /* 2 or 4; 0: not known yet */
    int binary, big_endian;
    int bytes; /* 1: what comes now is no text */
};

/* The next line with words. */
int gmsh_need_line(struct gmsh_numbers *g, const char *what);
/* The next number of a binary section, of 4 or 8 bytes. */
int gmsh_bits(struct gmsh_numbers *g, const char *what, unsigned size, uint64_t *bits);
int gmsh_number(struct gmsh_numbers *g, const char *what, double *x);
/* Of entities, types and groups, which take 4 bytes; in 4.1 counts and numbers of nodes and
 * elements take 8. */
int gmsh_whole(struct gmsh_numbers *g, const char *what, int64_t *i);
int gmsh_long(struct gmsh_numbers *g, const char *what, int64_t *i);
int gmsh_count(struct gmsh_numbers *g, const char *what, int64_t *i);
/* The line must be $End and the section's name. */
int gmsh_need_end(struct gmsh_numbers *g, const char *end);

#endif
