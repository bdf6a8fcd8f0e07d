/* shaft_planes.h - a shaft's planes, several asked at a time (lanes.h), each as it would be alone.
 *
 * Behind the last plane stand LANES_MOST that hold everything, of which a vector may ask too.
 * Whether a face or a box is outside is asked of whole vectors of planes, one after the other,
 * until one of them says so: which it is makes no difference.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_SHAFT_PLANES_H
#define KERNEL_SHAFT_PLANES_H

#include "discussion.h"
#include "kernel/lanes.h"

enum { SHAFT_AXES = 6 }; /* the first planes, the sides of the box around the ends */

/* Adds a plane with normal n, of any length; where it stands is found for all at the end. */
static inline void shaft_planes_add(struct shaft *shaft, const double n[3])
{
    if (!(dot3(n, n) > 0) || shaft->planes == SHAFT_PLANES)
        return;
    for (int k = 0; k < 3; k++)
        shaft->normal[k][shaft->planes] = n[k];
    shaft->planes++;
}

/* Normals become of length 1, and each plane stands at the farthest corner of both ends. */
TOOL void shaft_planes_place_body(struct shaft *shaft)
{
    for (int i = 0; i < shaft->planes; i += LANES) {
        double *x = shaft->normal[0] + i, *y = shaft->normal[1] + i, *z = shaft->normal[2] + i,
               *offset = shaft->offset + i;
        double most[LANES], u[LANES], v[LANES], w[LANES];
        for (int k = 0; k < LANES; k++) {
            const double size = sqrt(x[k] * x[k] + y[k] * y[k] + z[k] * z[k]);
            const double some = size > 0 ? size : 1;
            u[k] = x[k] / some;
            v[k] = y[k] / some;
            w[k] = z[k] / some;
            most[k] = size > 0 ? -INFINITY : INFINITY;
        }
        for (int end = 0; end < 2; end++)
            for (int c = 0; c < shaft->points[end]; c++) {
                const double a = shaft->end[end][c][0], b = shaft->end[end][c][1],
                             d = shaft->end[end][c][2];
                for (int k = 0; k < LANES; k++) {
                    const double height = u[k] * a + v[k] * b + w[k] * d;
                    most[k] = height > most[k] ? height : most[k];
                }
            }
        for (int k = 0; k < LANES; k++) {
            x[k] = u[k];
            y[k] = v[k];
            z[k] = w[k];
            offset[k] = most[k];
        }
    }
}

/* Does one plane have all of a box outside? The axes' planes are not asked: the shaft's own box is
 * the same. */
TOOL int shaft_planes_miss_body(const struct shaft *shaft, const double low[3],
                                const double high[3])
{
    const double low_x = low[0], low_y = low[1], low_z = low[2], high_x = high[0], high_y = high[1],
                 high_z = high[2], reach = shaft->reach;
    for (int i = SHAFT_AXES; i < shaft->planes; i += LANES) {
        const double *x = shaft->normal[0] + i, *y = shaft->normal[1] + i,
                     *z = shaft->normal[2] + i, *offset = shaft->offset + i;
        int64_t any = 0, outside[LANES];
        for (int k = 0; k < LANES; k++) {
            const double a = x[k] > 0 ? low_x : high_x, b = y[k] > 0 ? low_y : high_y,
                         c = z[k] > 0 ? low_z : high_z;
            outside[k] = x[k] * a + y[k] * b + z[k] * c > offset[k] + reach;
        }
        for (int k = 0; k < LANES; k++)
            any |= outside[k];
        if (any)
            return 1;
    }
    return 0;
}

/* Does one plane have all corners farther outside than `out`? The axes' planes are not asked: that
 * takes comparisons alone. */
TOOL int shaft_planes_far_body(const struct shaft *shaft, double out, const double (*v)[3], int n)
{
    for (int i = SHAFT_AXES; i < shaft->planes; i += LANES) {
        const double *x = shaft->normal[0] + i, *y = shaft->normal[1] + i,
                     *z = shaft->normal[2] + i, *offset = shaft->offset + i;
        int64_t all = 1, inside[LANES] = {0};
        for (int c = 0; c < n; c++) {
            const double a = v[c][0], b = v[c][1], d = v[c][2];
            for (int k = 0; k < LANES; k++)
                inside[k] |= !(a * x[k] + b * y[k] + d * z[k] > offset[k] + out);
        }
        for (int k = 0; k < LANES; k++)
            all &= inside[k];
        if (!all)
            return 1;
    }
    return 0;
}

/* Is a part of the segment from a to b no farther outside than `out`, for all planes at once? */
TOOL int shaft_planes_reach_body(const struct shaft *shaft, double out, const double a[3],
                                 const double b[3])
{
    const double a0 = a[0], a1 = a[1], a2 = a[2], b0 = b[0], b1 = b[1], b2 = b[2];
    double from[LANES] = {0}, to[LANES], first = 0, last = 1;
    for (int k = 0; k < LANES; k++)
        to[k] = 1;
    for (int i = 0; i < shaft->planes; i += LANES) {
        const double *x = shaft->normal[0] + i, *y = shaft->normal[1] + i,
                     *z = shaft->normal[2] + i, *offset = shaft->offset + i;
        int64_t any = 0, outside[LANES];
        for (int k = 0; k < LANES; k++) {
            const double g = a0 * x[k] + a1 * y[k] + a2 * z[k] - offset[k] - out,
                         h = b0 * x[k] + b1 * y[k] + b2 * z[k] - offset[k] - out, t = g / (g - h),
                         enters = g > 0 ? t : 0, leaves = h > 0 ? t : 1;
            outside[k] = (g > 0) & (h > 0);
            from[k] = enters > from[k] ? enters : from[k];
            to[k] = leaves < to[k] ? leaves : to[k];
        }
        for (int k = 0; k < LANES; k++)
            any |= outside[k];
        if (any)
            return 0;
    }
    for (int k = 0; k < LANES; k++) {
        first = from[k] > first ? from[k] : first;
        last = to[k] < last ? to[k] : last;
    }
    return first <= last;
}

/* Which planes, a bit for each, have a corner higher than `slack` less `reach`? Returns 0 when one
 * has all of them higher than `slack` and `reach`. */
TOOL int shaft_planes_cut_body(const struct shaft *shaft, double slack, double reach,
                               const double (*v)[3], int n, uint64_t *planes)
{
    uint64_t cut = 0;
    for (int i = 0; i < shaft->planes; i += LANES) {
        const double *x = shaft->normal[0] + i, *y = shaft->normal[1] + i,
                     *z = shaft->normal[2] + i, *offset = shaft->offset + i;
        int64_t all = 1, some = 0, inside[LANES] = {0}, crosses[LANES] = {0};
        for (int c = 0; c < n; c++) {
            const double a = v[c][0], b = v[c][1], d = v[c][2];
            for (int k = 0; k < LANES; k++) {
                const double h = a * x[k] + b * y[k] + d * z[k], limit = offset[k] + slack;
                inside[k] |= !(h > limit + reach);
                crosses[k] |= h > limit - reach;
            }
        }
        for (int k = 0; k < LANES; k++)
            crosses[k] <<= k;
        for (int k = 0; k < LANES; k++)
            all &= inside[k];
        if (!all)
            return 0;
        for (int k = 0; k < LANES; k++)
            some |= crosses[k];
        cut |= (uint64_t)some << i;
    }
    *planes = cut;
    return 1;
}

#if LANES_CHOSEN
LANES_AVX512 void shaft_planes_place_8(struct shaft *shaft)
{
    shaft_planes_place_body(shaft);
}
LANES_AVX2 void shaft_planes_place_4(struct shaft *shaft)
{
    shaft_planes_place_body(shaft);
}
LANES_AVX512 int shaft_planes_miss_8(const struct shaft *shaft, const double low[3],
                                     const double high[3])
{
    return shaft_planes_miss_body(shaft, low, high);
}
LANES_AVX2 int shaft_planes_miss_4(const struct shaft *shaft, const double low[3],
                                   const double high[3])
{
    return shaft_planes_miss_body(shaft, low, high);
}
LANES_AVX512 int shaft_planes_far_8(const struct shaft *shaft, double out, const double (*v)[3],
                                    int n)
{
    return shaft_planes_far_body(shaft, out, v, n);
}
LANES_AVX2 int shaft_planes_far_4(const struct shaft *shaft, double out, const double (*v)[3],
                                  int n)
{
    return shaft_planes_far_body(shaft, out, v, n);
}
LANES_AVX512 int shaft_planes_reach_8(const struct shaft *shaft, double out, const double a[3],
                                      const double b[3])
{
    return shaft_planes_reach_body(shaft, out, a, b);
}
LANES_AVX2 int shaft_planes_reach_4(const struct shaft *shaft, double out, const double a[3],
                                    const double b[3])
{
    return shaft_planes_reach_body(shaft, out, a, b);
}
LANES_AVX512 int shaft_planes_cut_8(const struct shaft *shaft, double slack, double reach,
                                    const double (*v)[3], int n, uint64_t *planes)
{
    return shaft_planes_cut_body(shaft, slack, reach, v, n, planes);
}
LANES_AVX2 int shaft_planes_cut_4(const struct shaft *shaft, double slack, double reach,
                                  const double (*v)[3], int n, uint64_t *planes)
{
    return shaft_planes_cut_body(shaft, slack, reach, v, n, planes);
}
#endif

/* All planes are added: they are placed, and what stands behind them holds everything. */
OUTLINE void shaft_planes_place(int width, struct shaft *shaft)
{
    for (int i = shaft->planes; i < shaft->planes + LANES_MOST; i++) {
        for (int k = 0; k < 3; k++)
            shaft->normal[k][i] = 0;
        shaft->offset[i] = INFINITY;
    }
    LANES_RUN(width, shaft_planes_place_8, shaft_planes_place_4, shaft_planes_place_body, (shaft));
}

OUTLINE int shaft_planes_miss(int width, const struct shaft *shaft, const double low[3],
                              const double high[3])
{
    return LANES_RUN(width, shaft_planes_miss_8, shaft_planes_miss_4, shaft_planes_miss_body,
                     (shaft, low, high));
}

OUTLINE int shaft_planes_far(int width, const struct shaft *shaft, double out, const double (*v)[3],
                             int n)
{
    return LANES_RUN(width, shaft_planes_far_8, shaft_planes_far_4, shaft_planes_far_body,
                     (shaft, out, v, n));
}

OUTLINE int shaft_planes_reach(int width, const struct shaft *shaft, double out, const double a[3],
                               const double b[3])
{
    return LANES_RUN(width, shaft_planes_reach_8, shaft_planes_reach_4, shaft_planes_reach_body,
                     (shaft, out, a, b));
}

OUTLINE int shaft_planes_cut(int width, const struct shaft *shaft, double slack, double reach,
                             const double (*v)[3], int n, uint64_t *planes)
{
    return LANES_RUN(width, shaft_planes_cut_8, shaft_planes_cut_4, shaft_planes_cut_body,
                     (shaft, slack, reach, v, n, planes));
}

#endif
