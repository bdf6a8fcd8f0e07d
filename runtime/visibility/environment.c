/* environment.c - where the rays from a surface go: 64 from each point of a grid.
 *
 * The rays say whether any light leaves the scene and share what a row of view factors lacks
 * among the ways out; how much it lacks the row itself knows better.
 * [derived here]
 * SPDX-License-Identifier: MIT */
#include "visibility/environment.h"
#include "kernel/constants.h"
#include "kernel/hemisphere.h"
#include "kernel/surface_point.h"

enum { DIRECTIONS = 64 };

struct environment environment_of(const struct rays *rays, const struct element *surface, int side)
{
    const struct hemisphere above = hemisphere_over(surface->normal);
    const int points = side * side;
    const double offset = rays_host(rays)->ray_offset;
    struct environment all = {0, 0, 0, 0};
    for (int i = 0; i < points; i++) {
        double p[3], d[3];
        int met[3] = {0, 0, 0};
        surface_point(p, surface, (i % side + 0.5) / side, (i / side + 0.5) / side);
        for (int k = 0; k < 3; k++)
            p[k] += offset * surface->normal[k];
        for (int m = 0; m < DIRECTIONS; m++) {
            hemisphere_direction(d, &above, m, DIRECTIONS, i / (double)points);
            met[rays_first(rays, p, d, NULL, NULL)]++;
        }
        if (met[RAY_MEETS_BACK] >= ENVIRONMENT_BACKS * DIRECTIONS) {
            all.covered += DIRECTIONS;
            continue;
        }
        all.fronts += met[RAY_MEETS_FRONT];
        all.leaves += met[RAY_LEAVES];
        all.backs += met[RAY_MEETS_BACK];
    }
    return all;
}
