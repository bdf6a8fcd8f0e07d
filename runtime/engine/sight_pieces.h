/* sight_pieces.h - what a point sees of a convex polygon past convex faces, exactly.
 * SPDX-License-Identifier: MIT */
#ifndef SIGHT_PIECES_H
#define SIGHT_PIECES_H

#include "kernel/outline.h"

enum { SIGHT_LIST = 64 }; /* the most faces that may stand between */

/* The polygon that is looked at, in its plane; the plane that shadows are cast on is raised a
 * little, as rays' ends are. */
struct sight {
    struct outline_frame frame, raised;
    struct outline_cell cell;
};

/* `part`: what of the element is to be seen. */
void sight_open(struct sight *sight, const struct element *e, const struct polygon *part,
                double up);

/* The form factor from a point x with normal n, in front of whose plane all of the polygon lies, to
 * what it sees of the polygon past the blockers, from `up` over x. In [0, 1]. */
double sight_factor(const struct sight *sight, const double x[3], const double n[3], double up,
                    const struct polygon *blockers, int count);

#endif
