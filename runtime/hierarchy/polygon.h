/* polygon.h - plane polygons in space: area, flatness, convexity, triangles.
 * SPDX-License-Identifier: MIT */
#ifndef POLYGON_H
#define POLYGON_H

#include <stdint.h>

/* Unit normal by Newell's sum, counter-clockwise seen from its tip; returns the area (of the
 * projection along that normal when the polygon is not flat). Area 0: the normal is 0. */
double polygon_normal(double (*vertex)[3], uint32_t count, double normal[3]);

/* The longest distance between two corners. */
double polygon_size(double (*vertex)[3], uint32_t count);

/* 1 when there is no area to speak of: thinner than SCENE_THIN, or than the rounding of its
 * coordinates, which is `precision` times the largest of them. */
int polygon_degenerate(double (*vertex)[3], uint32_t count, double precision);

/* 1 when every corner lies within `tolerance` (m) of the mean plane. */
int polygon_flat(double (*vertex)[3], uint32_t count, double tolerance);

/* 1 when a flat quad has no inward corner and does not cross itself. */
int polygon_convex_quad(double (*vertex)[3]);

/* 1 when no edges meet but neighbours, seen along the mean normal; 0 also when out of memory. */
int polygon_simple(double (*vertex)[3], uint32_t count);

/* Cut into count - 2 triangles or fewer by ear clipping, in the plane of the mean normal; concave
 * polygons are cut right. Triangles are corner indices in the polygon's own sense of rotation,
 * `scratch` holds `count` numbers. Returns the number of triangles, 0 when the outline crosses
 * itself: then corners are left that are no ears, with more than POLYGON_LOST of the area. */
uint32_t polygon_triangulate(double (*vertex)[3], uint32_t count, uint32_t (*triangle)[3],
                             uint32_t *scratch);

enum { POLYGON_CORNERS = 12 }; /* of a convex polygon that becomes pieces */

/* Of a convex polygon: what becomes a face. */
struct piece {
    uint32_t corner[4], n;
};

/* Cut a convex polygon of up to POLYGON_CORNERS corners into quads and at most one triangle, each
 * cut off where the cut is shortest; lengths that differ by less than `touch` (m) are equal.
 * Returns how many; there is room for half as many as corners. */
uint32_t polygon_pieces(double (*vertex)[3], uint32_t count, double touch, struct piece *piece);

#endif
