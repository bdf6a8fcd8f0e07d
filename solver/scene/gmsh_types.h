/* gmsh_types.h - how many nodes Gmsh's elements have.
 * [Gmsh reference manual, node ordering; GmshDefines.h names the types by number]
 * SPDX-License-Identifier: MIT */
#ifndef GMSH_TYPES_H
#define GMSH_TYPES_H

#include <stdint.h>

enum { GMSH_TYPES = 140 }; /* the last one */

/* Corners of a face; 0: a point or a line; -1: something else. */
static inline int corners_of(int64_t type)
{
    switch (type) {
    case 2:
    case 9:
    case 20:
    case 21:
    case 22:
    case 23:
    case 24:
    case 25:
        return 3;
    case 3:
    case 10:
    case 16:
    case 36:
    case 37:
    case 38:
    case 39:
    case 40:
    case 41:
        return 4;
    case 1:
    case 8:
    case 15:
    case 26:
    case 27:
    case 28:
        return 0;
    default:
        return -1;
    }
}

/* All nodes of an element; 0: a type that is not known. */
static inline int nodes_of(int64_t type)
{
    static const unsigned char nodes[] = {0,  2,  3,  4,  4,  8,  6, 5,  3,  6,  9,  10, 27, 18,
                                          14, 1,  8,  20, 15, 13, 9, 10, 12, 15, 15, 21, 4,  5,
                                          6,  20, 35, 56, 22, 28, 0, 0,  16, 25, 36, 12, 16, 20};
    switch (type) {
    case 90:
        return 40;
    case 91:
        return 75;
    case 92:
        return 64;
    case 93:
        return 125;
    default:
        return type > 0 && type < (int64_t)sizeof nodes ? nodes[type] : 0;
    }
}

#endif
