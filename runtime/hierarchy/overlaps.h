/* overlaps.h - faces that lie on others in one plane, with the same side in front.
 *
 * Both would take the light that falls there, and power would be made. So each side of each place
 * in a plane belongs to one polygon: of those that emit, if any does, the first, else the first.
 * The others lose what is covered, and become what is left of them, in parts; one that is covered
 * wholly becomes none. All keep their numbers. Fronts that look opposite ways are a thin wall with
 * two sides, and stay; of a two-sided face only the covered side goes.
 * SPDX-License-Identifier: MIT */
#ifndef OVERLAPS_H
#define OVERLAPS_H

#include "hierarchy/scene.h"

/* Take off the scene's faces what is covered, on so many threads. `tree` is over the faces. Sets
 * scene->overlaps, what belongs to it, and areas of the polygons. Returns how many faces have
 * changed, or -1 when out of memory; then nothing has. */
long overlaps_take(struct scene *scene, const struct bvh *tree, int threads);

#endif
