/* outline_visibility.h - V of two surfaces past a list of faces: seen exactly from four points of the smaller one, three
 * of a triangle, by terms/outline.h; points behind the larger one's plane see nothing. In [0, 1].
 *
 * A point counts by what it would exchange with the larger one, taken at the centroid: cos cos / (pi d^2 + a / n), a the
 * smaller area over the points, which bounds the weight of parts that touch. So V = sum seen / sum all, the same both ways.
 * As good as 64 rays at the price of 16, and far better where the shadow's edge crosses only the larger surface.
 * Fails: shadows whose edges are finer than a quarter of the smaller surface.
 * [derived here]
 * SPDX-License-Identifier: MIT */
#ifndef TERM_OUTLINE_VISIBILITY_H
#define TERM_OUTLINE_VISIBILITY_H

#include "discussion.h"
#include "terms/blockers.h"
#include "terms/outline.h"

/* What a piece of the plane, its centroid at y, exchanges with a point per area. `spread`: m2 */
static inline double outline_kernel(const double x[3], const double n[3], const double y[3], const double m[3], double spread)
{
    double w[3], cos_x, cos_y, square;
    sub3(w, y, x);
    cos_x = dot3(n, w);
    cos_y = -dot3(m, w);
    square = dot3(w, w);
    return cos_x > 0 && cos_y > 0 ? cos_x * cos_y / (square * (3.14159265358979323846 * square + spread)) : 0;
}

OUTLINE double outline_visibility(const struct element *r, const struct element *s, const struct host *host, const struct blockers *list)
{
    int r_is_small = r->radius < s->radius || (r->radius == s->radius && r->id < s->id);
    const struct element *small = r_is_small ? r : s, *large = r_is_small ? s : r;
    struct polygon clipped, blocker;
    struct outline_frame frame;
    struct outline_cell cell;
    struct outline_sum whole = { 0, { 0, 0 } }, seen;
    struct outline shadows[BLOCKERS_MAX];
    double x[OUTLINE_POINTS][3], weight[OUTLINE_POINTS], y[3], uv[2], part = 0, all = 0, spread;
    int points, i, k;
    polygon_clip(&clipped, (const double (*)[3])large->vertex, large->vertices, small->centre, small->normal);
    if (clipped.n == 0)
        return 0;
    outline_frame_of(&frame, large, host->ray_offset);
    cell.n = clipped.n;
    for (i = 0; i < clipped.n; i++)
        outline_in(&frame, clipped.v[i], cell.p[i]);
    outline_add(&whole, &cell);
    if (!(whole.area > 0))
        return 0;
    points = outline_points(small, host->ray_offset, x, weight);
    spread = small->area / points;
    for (i = 0; i < points; i++) {
        double height = height3(x[i], frame.origin, frame.n), q;
        int count = 0;
        if (!(height > 0))
            continue;
        for (k = 0; k < 2; k++)
            uv[k] = whole.at[k] / whole.area;
        outline_out(&frame, uv, y);
        q = weight[i] * outline_kernel(x[i], small->normal, y, frame.n, spread);
        all += q * whole.area;
        for (k = 0; k < list->count; k++) {
            host->corners(host, list->face[k], &blocker);
            count += outline_cast(&shadows[count], &frame, x[i], height, (const double (*)[3])blocker.v, blocker.n);
        }
        switch (outline_seen(shadows, count, &cell, &whole, &seen)) {
        case 2:
            part += q * whole.area;
            break;
        case 1:
            for (k = 0; k < 2; k++)
                uv[k] = seen.at[k] / seen.area;
            outline_out(&frame, uv, y);
            part += weight[i] * outline_kernel(x[i], small->normal, y, frame.n, spread) * seen.area;
            break;
        default:
            break;
        }
    }
    return !(part > 0) ? 0 : part < all ? part / all : 1;
}

#endif
