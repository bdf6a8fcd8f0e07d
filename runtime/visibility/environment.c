/* environment.c - where the rays from a surface go: some from each of its points.
 *
 * The rays say whether any light leaves the scene and share what a row of view factors lacks
 * among the ways out; how much it lacks the row itself knows better.
 * [points anywhere in their cells: R2, M. Roberts 2018, The unreasonable effectiveness of
 * quasirandom sequences; the rest derived here]
 * SPDX-License-Identifier: MIT */
#include "visibility/environment.h"
#include "kernel/constants.h"
#include "kernel/hemisphere.h"
#include "kernel/surface_point.h"

/* 1 / g and 1 / g^2, g^3 = g + 1; and the golden ratio's */
static const double STEP[3] = {0.75487766624669276, 0.56984029099805327, 0.61803398874989485};

/* The square root of 2, which no sum of those makes; golden angles in a turn. */
static const double STEP_AROUND = 1.41421356237309505, TURN = 2.61803398874989485;

/* Where in its cell point i stands, and where in their rings its rays go: in the middle of the
 * outermost of 16 none is nearer to the surface than 10 degrees. */
static double within(const struct environment_grid *grid, int i, int k)
{
    const double x = 0.5 + i * STEP[k];
    return grid->anywhere ? x - floor(x) : 0.5;
}

/* By how many golden angles the rays of point i are turned. By one at the most, 62 % of each ring
 * are asked from nowhere: rays of many rings fill these in, and few leave out whole ways. */
static double turn_of(const struct environment_grid *grid, int i)
{
    const double x = i * STEP_AROUND;
    return grid->anywhere ? TURN * (x - floor(x)) : i / (double)(grid->side * grid->side);
}

/* Is it a quad that narrows, as what a triangle is cut into? Points of a grid would crowd at its
 * narrow side; on triangles and parallelograms they are even. */
static int narrows(const struct element *e)
{
    double off = 0;
    for (int k = 0; k < 3 && e->vertices == 4; k++)
        off =
            fmax(off, fabs(e->vertex[0][k] - e->vertex[1][k] + e->vertex[2][k] - e->vertex[3][k]));
    return off > 1e-3 * e->radius;
}

struct environment environment_of(const struct rays *rays, const struct element *surface,
                                  struct environment_grid grid)
{
    const struct hemisphere above = hemisphere_over(surface->normal);
    const int points = grid.side * grid.side;
    const double offset = rays_host(rays)->ray_offset;
    const int is_uneven = narrows(surface);
    struct environment all = {0, 0, 0, 0};
    for (int i = 0; i < points; i++) {
        double p[3], d[3];
        int met[3] = {0, 0, 0};
        const double s = (i % grid.side + within(&grid, i, 0)) / grid.side,
                     t = (i / grid.side + within(&grid, i, 1)) / grid.side;
        if (is_uneven)
            surface_even_point(p, surface, s, t);
        else
            surface_point(p, surface, s, t);
        for (int k = 0; k < 3; k++)
            p[k] += offset * surface->normal[k];
        for (int m = 0; m < grid.directions; m++) {
            hemisphere_direction_in(d, &above, m, grid.directions, turn_of(&grid, i),
                                    within(&grid, i, 2));
            met[rays_first(rays, p, d, NULL, NULL)]++;
        }
        if (met[RAY_MEETS_BACK] >= ENVIRONMENT_BACKS * grid.directions) {
            all.covered += grid.directions;
            continue;
        }
        all.fronts += met[RAY_MEETS_FRONT];
        all.leaves += met[RAY_LEAVES];
        all.backs += met[RAY_MEETS_BACK];
    }
    return all;
}
