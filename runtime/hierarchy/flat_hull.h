/* flat_hull.h - tight outlines of points in a plane.
 * SPDX-License-Identifier: MIT */
#ifndef FLAT_HULL_H
#define FLAT_HULL_H

#include <stddef.h>

/* The convex hull of n points, counter-clockwise, without corners on its sides. Sorts the points;
 * hull: [n + 1]. Returns how many corners, fewer than 3 when the points lie on a line. */
size_t flat_hull(double (*points)[2], size_t n, double (*hull)[2]);

/* Which way the smallest rectangle around a hull of 3 corners or more lies: a unit vector along one
 * of its sides. Of rectangles equally large the one with the smallest perimeter, then the first. */
void flat_hull_direction(const double (*hull)[2], size_t n, double along[2]);

/* Take sides off a hull, each that whose neighbours meet nearest beyond it, until there are no more
 * than 4. What is left lies around the hull. Returns how many, more than 4 when there is no such
 * side, or when there were too many. */
size_t flat_hull_quad(double (*hull)[2], size_t n);

double flat_area(const double (*corners)[2], size_t n);

#endif
