/* lids.h - what is left of a face where others lie on it in its plane.
 * SPDX-License-Identifier: MIT */
#ifndef LIDS_H
#define LIDS_H

#include "hierarchy/hierarchy.h"
#include "hierarchy/polygon.h"

enum { FRONT = 1, BACK = 2 }; /* sides, in sets */

/* A convex polygon that covers sides of the face, in whose plane it lies. */
struct lid {
    double corner[4][3]; /* counter-clockwise from the face's front (m) */
    double across[4][3]; /* of each edge: the unit vector inwards */
    double touch;        /* what is nearer to an edge is on it (m) */
    uint32_t n;
    unsigned sides;
    uint32_t face; /* the caller's */
};

/* A convex part of the face, and the sides of it that nothing covers. */
struct bare_part {
    double vertex[POLYGON_CORNERS][3];
    uint32_t n;
    unsigned sides;
};

struct bare_parts {
    struct bare_part *parts; /* [count] */
    size_t count, capacity;
};

/* Make a lid of a polygon in a plane with that unit normal. */
void lid_of(struct lid *lid, const double (*vertex)[3], uint32_t n, const double normal[3],
            double touch);

/* How a convex polygon in the plane lies to a lid. */
enum lid_place { BESIDE, UNDER, ACROSS };
enum lid_place lid_place(const struct lid *lid, const double (*vertex)[3], uint32_t n);

/* What of a convex polygon is under the lid; n is 4 at most. Returns its corners, fewer than three
 * where there is none. */
enum { LID_COMMON = 8 };
int lid_common(const struct lid *lid, const double (*vertex)[3], uint32_t n,
               double part[LID_COMMON][3]);

/* Area of that (m2). */
double lid_area(const struct lid *lid, const double (*vertex)[3], uint32_t n,
                const double normal[3]);

/* Add to `bare` what is left of a face with these sides. Returns 0, or -1 when out of memory. */
int lids_take(struct bare_parts *bare, const struct face *face, unsigned sides,
              const struct lid *lids, uint32_t count);

#endif
