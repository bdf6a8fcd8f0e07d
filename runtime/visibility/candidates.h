/* candidates.h - what stands in a shaft or along a segment, found in the tree of clusters.
 * SPDX-License-Identifier: MIT */
#ifndef CANDIDATES_H
#define CANDIDATES_H

#include "hierarchy/solids.h"

/* `solids`: those of the hierarchy, of which whole ones are left alone; NULL: nobody knows of any.
 * Tells of the faces that meet the shaft, one by one, until it is answered -1. Returns 0, or -1
 * then. What is told of is as in candidates_find. */
int candidates_walk(const struct hierarchy *h, const struct solids *solids,
                    const struct shaft *shaft, double offset,
                    int (*found)(void *context, uint32_t face), void *context);

/* Does an element that is no `back` meet the shaft? `offset`: as below. */
int candidates_meets(const struct hierarchy *h, const struct shaft *shaft, double offset,
                     uint32_t index);

/* The same of its plane: may that part the ends, or an end lie flat on it? Where this is 0 it does
 * not meet the shaft. */
int candidates_parted(const struct hierarchy *h, const struct shaft *shaft, double offset,
                      uint32_t index);

/* The faces that meet the shaft, at most `most` of them. Returns how many there are, or most + 1
 * when there are more. Faces marked `back` are left out: their front stands at the same place. In a
 * hierarchy with groups what is listed are elements: faces, and groups that are as good as one;
 * none that lies behind an end. `offset`: how far the ends are off their surfaces (m). */
int candidates_find(const struct hierarchy *h, const struct shaft *shaft, double offset, int most,
                    uint32_t *faces);

void candidates_corners(const struct hierarchy *h, uint32_t face, struct polygon *polygon);

/* Optical depth along a segment: sum of kappa l over the clusters that hold faces themselves, kappa
 * = sum A / 4 Vol (1/m), l the length inside (m). Clusters that hold `receiver` or `emitter`, two
 * faces, do not count. A box is taken to be `least` thick at least. [Sillion & Drettakis 1995,
 * section 3] */
double candidates_depth(const struct hierarchy *h, const struct segment *segment, uint32_t receiver,
                        uint32_t emitter, double least);

#endif
