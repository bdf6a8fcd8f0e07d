/* winding.h - does every ray that leaves the front of a surface end on the front of another?
 * SPDX-License-Identifier: MIT */
#ifndef WINDING_H
#define WINDING_H

#include "hierarchy/hierarchy.h"

/* closed[element] becomes 1 for the leaves from which no light leaves the scene, nor meets a black
 * back; 0 for all others, and where that would cost too much to find out. */
void winding_closed(const struct hierarchy *h, const double *uncovered, int threads,
                    unsigned char *closed);

#endif
