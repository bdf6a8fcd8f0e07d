/* cut.h - convex polygons of many corners, cut by planes.
 *
 * struct polygon (geometry.h) has room for one cut of a quad; these have room for many. A cut adds
 * at most one corner; where there is no room left, the result is too large by a corner, never too
 * small.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_CUT_H
#define KERNEL_CUT_H

#include "discussion.h"

enum { CUT_MAX = 40 };

struct cut {
    int n; /* 0: nothing is left */
    double v[CUT_MAX][3];
};

static inline void cut_from(struct cut *out, const double (*v)[3], int n)
{
    out->n = n;
    for (int i = 0; i < n; i++)
        for (int k = 0; k < 3; k++)
            out->v[i][k] = v[i][k];
}

/* The part of a polygon where normal . (p - on) <= limit. Returns 1 when that is all of it;
 * `out` is then not written. */
static inline int cut_below(struct cut *out, const struct cut *in, const double on[3],
                            const double normal[3], double limit)
{
    double height[CUT_MAX];
    int above = 0;
    for (int i = 0; i < in->n; i++) {
        height[i] = height3(in->v[i], on, normal) - limit;
        above += height[i] > 0;
    }
    if (above == 0)
        return 1;
    out->n = 0;
    if (above < in->n)
        (void)polygon_divide(&in->v[0][0], in->n, 3, height, CUT_MAX, NULL, &out->v[0][0], &out->n);
    return 0;
}

#endif
