/* far_away.h - meshes so far from the origin that single precision bends them.
 *
 * A float has 24 bits: in coordinates of a map, 5,400,000 m from the origin, it moves points by up
 * to .25 m. What knows only floats is then written about the mesh's middle, or says so.
 * SPDX-License-Identifier: MIT */
#ifndef FAR_AWAY_H
#define FAR_AWAY_H

#include "output/vertex_values.h"

/* By how much single precision moves a coordinate at most (m), where that is more than a millionth
 * of the mesh's extent; then `middle` is that of the mesh. Else 0, and `middle` the origin. */
double far_away(const struct vertex_values *values, double middle[3]);

#endif
