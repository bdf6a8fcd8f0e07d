/* sight_faces.h - does a ray meet one of the faces that stand between? Eight are asked at a time
 * (kernel/lanes.h), each as it would be alone, where the ray meets the box around them.
 * Invariant: what is asked of an edge is exactly what is asked of it as its neighbour's, but for
 * the sign (visibility/hidden.h): no ray passes between neighbours.
 * SPDX-License-Identifier: MIT */
#ifndef SIGHT_FACES_H
#define SIGHT_FACES_H

#include "kernel/lanes.h"

enum { SIGHT_BOXED = 8, SIGHT_CORNERS = 4 };

/* A triangle's last corner stands twice: from it to itself there is no edge. Where there is no face
 * all is 0, and no ray meets it. */
struct sight_faces {
    double v[SIGHT_CORNERS][3][SIGHT_BOXED];
    double plane[4][SIGHT_BOXED]; /* n . p - c */
    double low[3], high[3];       /* the box around them, larger than they are */
};

/* per: 1 / along, for boxes */
struct sight_ray {
    double from[3], to[3], along[3], per[3];
};

static inline void sight_ray_aim(struct sight_ray *ray)
{
    for (int k = 0; k < 3; k++)
        ray->along[k] = ray->to[k] - ray->from[k];
}

/* Where the ray runs along a side, that side does not tell. */
static inline int sight_ray_passes(const struct sight_ray *ray, const struct sight_faces *f)
{
    double enter = 0, leave = 1;
    for (int k = 0; k < 3; k++) {
        double a = (f->low[k] - ray->from[k]) * ray->per[k],
               b = (f->high[k] - ray->from[k]) * ray->per[k];
        double first = a < b ? a : b, last = a < b ? b : a;
        enter = first > enter ? first : enter;
        leave = last < leave ? last : leave;
    }
    return enter > leave;
}

/* Which faces it meets, a bit of each: its ends are on either side of the plane, and it runs by all
 * edges on one side, or on them. */
TOOL int sight_faces_stop_body(const struct sight_faces *f, const struct sight_ray *ray)
{
    const double x = ray->from[0], y = ray->from[1], z = ray->from[2], to_x = ray->to[0],
                 to_y = ray->to[1], to_z = ray->to[2], along_x = ray->along[0],
                 along_y = ray->along[1], along_z = ray->along[2];
    int64_t any = 0, stops[SIGHT_BOXED], left[SIGHT_BOXED] = {0}, right[SIGHT_BOXED] = {0};
    for (int k = 0; k < SIGHT_BOXED; k++) {
        const double a = f->plane[0][k], b = f->plane[1][k], c = f->plane[2][k], d = f->plane[3][k];
        stops[k] = (a * x + b * y + c * z - d > 0) != (a * to_x + b * to_y + c * to_z - d > 0);
    }
    for (int k = 0; k < SIGHT_BOXED; k++)
        any |= stops[k];
    if (!any)
        return 0;
    for (int i = 0, j = SIGHT_CORNERS - 1; i < SIGHT_CORNERS; j = i++)
        for (int k = 0; k < SIGHT_BOXED; k++) {
            const double p0 = f->v[j][0][k] - x, p1 = f->v[j][1][k] - y, p2 = f->v[j][2][k] - z,
                         q0 = f->v[i][0][k] - x, q1 = f->v[i][1][k] - y, q2 = f->v[i][2][k] - z;
            const double side = (p1 * q2 - p2 * q1) * along_x + (p2 * q0 - p0 * q2) * along_y
                                + (p0 * q1 - p1 * q0) * along_z;
            left[k] |= side > 0;
            right[k] |= side < 0;
        }
    any = 0;
    for (int k = 0; k < SIGHT_BOXED; k++)
        any |= (stops[k] & ~(left[k] & right[k])) << k;
    return (int)any;
}

#if LANES_CHOSEN
LANES_AVX512 int sight_faces_stop_8(const struct sight_faces *f, const struct sight_ray *ray)
{
    return sight_faces_stop_body(f, ray);
}
LANES_AVX2 int sight_faces_stop_4(const struct sight_faces *f, const struct sight_ray *ray)
{
    return sight_faces_stop_body(f, ray);
}
#endif

static inline int sight_faces_met(const struct sight_faces *f, const struct sight_ray *ray)
{
    return LANES_RUN(lanes_width(), sight_faces_stop_8, sight_faces_stop_4, sight_faces_stop_body,
                     (f, ray));
}

/* The first of so many blocks with a face that a ray meets; -1: it meets none. */
static inline int sight_faces_stop(const struct sight_faces *f, int blocks, struct sight_ray *ray)
{
    for (int k = 0; k < 3 && blocks > 1; k++)
        ray->per[k] = 1 / ray->along[k];
    for (int i = 0; i < blocks; i++)
        if (!(blocks > 1 && sight_ray_passes(ray, &f[i])) && sight_faces_met(&f[i], ray))
            return i;
    return -1;
}

#endif
