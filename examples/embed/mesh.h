/* mesh.h - this program's own scene: a room of rectangles, and a ray test that asks every one of
 * them.
 * SPDX-License-Identifier: MIT */
#ifndef MESH_H
#define MESH_H

/* A rectangle: one corner and its two sides; it faces the way of side[0] x side[1]. */
struct patch {
    double corner[3], side[2][3];
    double light;    /* what it sends, W/m2 */
    int depth;       /* how often it was split */
    unsigned number; /* the room's are 1 to 9, quarter q of n is 16 n + q, without what is beyond 32
                        bits */
};

enum { ROOM_PATCHES = 9 };
extern const struct patch room[ROOM_PATCHES];

double patch_area(const struct patch *p);
void patch_normal(const struct patch *p, double normal[3]);
void patch_corner(const struct patch *p, int corner, double at[3]); /* 0 to 3, counter-clockwise */
struct patch patch_quarter(const struct patch *p, int quarter);     /* 0 to 3 */

/* Does a rectangle of the room stand between the two points? */
int room_blocks(const double from[3], const double to[3]);

#endif
