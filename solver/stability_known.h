/* stability_known.h - closed forms: what the cases of stability.h are held against.
 * Sources: Howell, A Catalog of Radiation Heat Transfer Configuration Factors, C-11, C-14, B-4; Hottel's crossed
 * strings; penumbra derived from B-4.
 * SPDX-License-Identifier: MIT */
#ifndef STABILITY_KNOWN_H
#define STABILITY_KNOWN_H

/* Aligned parallel rectangles a x b at distance c. */
double known_parallel(double a, double b, double c);

/* Perpendicular rectangles with a common edge l: from the one of width w to the one of height h. */
double known_perpendicular(double w, double h, double l);

/* Infinitely long parallel strips of width w at distance h. */
double known_strips(double w, double h);

/* From a point with a horizontal surface to the rectangle [x0, x1] x [y0, y1] parallel to it at height h
 * over it; coordinates from the point. */
double known_point(double x0, double x1, double y0, double y1, double h);

/* The same with a blocking rectangle of corners `blocker` (as x0, x1, y0, y1) at height z < h. */
double known_penumbra(const double source[4], double h, const double blocker[4], double z);

#endif
