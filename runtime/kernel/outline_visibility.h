/* outline_visibility.h - V of two surfaces past a list of faces: seen exactly from sixteen points
 * of one of them, by kernel/outline.h; points behind the other one's plane see nothing. In [0, 1].
 * The points are on the surface that looks smaller from the faces: from point to point of it
 * shadows move less.
 *
 * A point counts by what it would exchange with the other one, taken at the centroid: cos cos / (pi
 * d^2 + a / n), a the smaller area over the points, which bounds the weight of parts that touch. So
 * V = sum seen / sum all, the same both ways. Far better than 64 rays, since on the other surface
 * it is exact.
 * Fails: gaps between faces that are seen from less than a sixteenth of the surface with the
 * points.
 * [derived here]
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_OUTLINE_VISIBILITY_H
#define KERNEL_OUTLINE_VISIBILITY_H

#include "discussion.h"
#include "kernel/lambert.h"
#include "kernel/outline.h"
#include "kernel/shaft.h"

/* How large e looks from the nearest of the faces: seen from another point of e, their shadows
 * move by so much. */
static inline double outline_sway(const struct element *e, const struct host *host,
                                  const struct blockers *list)
{
    double least = INFINITY;
    for (int i = 0; i < list->count; i++) {
        struct polygon face;
        double normal[3];
        host->corners(host, list->face[i], &face);
        if (!shaft_normal((const double(*)[3])face.v, face.n, normal))
            continue;
        double d = polygon_distance(e->centre, (const double(*)[3])face.v, face.n, normal);
        least = d < least ? d : least;
    }
    return e->radius / (least + e->radius);
}

OUTLINE double outline_visibility(const struct element *r, const struct element *s,
                                  const struct host *host, const struct blockers *list)
{
    double sway_r = outline_sway(r, host, list), sway_s = outline_sway(s, host, list);
    int from_r = sway_r < sway_s || (sway_r == sway_s && r->id < s->id);
    const struct element *from = from_r ? r : s, *to = from_r ? s : r;
    struct polygon clipped, blocker;
    struct outline_sum whole = {0, {0, 0}}, seen;
    double x[OUTLINE_MANY][3], weight[OUTLINE_MANY], y[3], uv[2], part = 0, all = 0;
    polygon_clip(&clipped, (const double(*)[3])to->vertex, to->vertices, from->centre,
                 from->normal);
    if (clipped.n == 0)
        return 0;
    struct outline_frame frame;
    outline_frame_of(&frame, to, host->ray_offset);
    struct outline_cell cell;
    cell.n = clipped.n;
    for (int i = 0; i < clipped.n; i++)
        outline_in(&frame, clipped.v[i], cell.p[i]);
    outline_add(&whole, &cell);
    if (!(whole.area > 0))
        return 0;
    outline_points(from, host->ray_offset, OUTLINE_MANY, x, weight);
    double spread = (r->area < s->area ? r->area : s->area) / (double)OUTLINE_MANY;
    struct outline shadows[BLOCKERS_MAX];
    int k;
    for (int i = 0; i < OUTLINE_MANY; i++) {
        double height = height3(x[i], frame.origin, frame.n);
        int count = 0;
        if (!(height > 0))
            continue;
        for (k = 0; k < 2; k++)
            uv[k] = whole.at[k] / whole.area;
        outline_out(&frame, uv, y);
        double q = weight[i] * lambert_points(x[i], from->normal, y, frame.n, spread);
        all += q * whole.area;
        for (k = 0; k < list->count; k++) {
            host->corners(host, list->face[k], &blocker);
            count += outline_cast(&shadows[count], &frame, x[i], height,
                                  (const double(*)[3])blocker.v, blocker.n);
        }
        switch (outline_seen(shadows, count, &cell, &whole, &seen)) {
        case 2:
            part += q * whole.area;
            break;
        case 1:
            for (k = 0; k < 2; k++)
                uv[k] = seen.at[k] / seen.area;
            outline_out(&frame, uv, y);
            part += weight[i] * lambert_points(x[i], from->normal, y, frame.n, spread) * seen.area;
            break;
        default:
            break;
        }
    }
    return !(part > 0) ? 0 : part < all ? part / all : 1;
}

#endif
