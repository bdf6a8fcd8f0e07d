/* hemicube.h - the form factor from the receiver's centre to a flat convex polygon, projected on a
 * hemicube.
 *
 * Half a cube of side 2 stands over the centre, its five faces divided into pixels: n x n on top, n
 * x n/2 on each side. A pixel of area a that a ray from the centre meets at (x, y, 1), seen from
 * its face, has the delta form factor a / (pi (1 + x^2 + y^2)^2) on top, and that times its height
 * on a side; F is the sum over the pixels whose middle the polygon covers. Polygons that share an
 * edge share no pixel, so rows of a closed scene sum to what all pixels do, 1 to 1 / n^2.
 * [Cohen and Greenberg 1985]
 * What made the method is missing here: one projection for all emitters, the nearest hiding the
 * others. A row's pixels that a polygon covers are found by its edges, since these are planes
 * through the centre: one interval per row.
 * Fails: as all one-point rules do where F varies over the receiver; and by pixels, which small or
 * far polygons slip between (F below 1 / n^2 is noise) and whose steps show at every edge.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_HEMICUBE_H
#define KERNEL_HEMICUBE_H

#include "discussion.h"
#include "kernel/hemisphere.h"
#include "kernel/lambert.h"
#include "kernel/point_factor.h"

/* A face of the hemicube: its pixels' middles lie at out + a along + b up, -1 < a < 1, and b the
 * same on top, 0 < b < 1 on the sides. */
struct hemicube_face {
    double out[3], along[3], up[3];
    int side;
};

/* The interval of a for which out + a along + b up is within all planes; 0: it is empty. */
static inline int hemicube_interval(const struct hemicube_face *f, double b,
                                    const double (*plane)[3], int n, double *low, double *high)
{
    *low = -1;
    *high = 1;
    for (int i = 0; i < n; i++) {
        const double rise = dot3(plane[i], f->along),
                     at = dot3(plane[i], f->out) + b * dot3(plane[i], f->up);
        if (rise > 0)
            *low = fmax(*low, -at / rise);
        else if (rise < 0)
            *high = fmin(*high, -at / rise);
        else if (at < 0)
            return 0;
    }
    return *low < *high;
}

/* The sum of delta form factors over the pixels of one face that are within all planes. */
static inline double hemicube_sum(const struct hemicube_face *f, const double (*plane)[3], int n,
                                  int pixels)
{
    const double step = 2.0 / pixels;
    double low, high, sum = 0;
    for (int row = 0; row < (f->side ? pixels / 2 : pixels); row++) {
        const double b = (row + 0.5) * step - (f->side ? 0 : 1);
        if (!hemicube_interval(f, b, plane, n, &low, &high))
            continue;
        const int first = (int)ceil((low + 1) / step - 0.5),
                  end = (int)ceil((high + 1) / step - 0.5);
        double part = 0;
        for (int i = first; i < end; i++) {
            const double a = (i + 0.5) * step - 1, square = 1 + a * a + b * b;
            part += 1 / (square * square);
        }
        sum += (f->side ? b : 1) * part;
    }
    return sum * step * step / LAMBERT_PI;
}

/* F_rs by a hemicube of `pixels` x `pixels`, an even number. */
OUTLINE double hemicube_factor(const struct element *r, const struct element *s, int pixels)
{
    struct polygon q;
    double plane[POLYGON_MAX][3], a[3], b[3], sum = 0;
    point_factor_clip(&q, r, s);
    if (q.n == 0 || !(height3(r->centre, s->centre, s->normal) > 0))
        return 0;
    sub3(a, q.v[q.n - 1], r->centre);
    for (int i = 0; i < q.n; i++) {
        sub3(b, q.v[i], r->centre);
        cross3(plane[i], b, a); /* inwards: s is counter-clockwise from here */
        for (int k = 0; k < 3; k++)
            a[k] = b[k];
    }
    const struct hemisphere h = hemisphere_over(r->normal);
    for (int side = 0; side < 5; side++) {
        struct hemicube_face f;
        const double *const out = side == 0  ? h.n
                                  : side < 3 ? h.u
                                             : h.v,
                            *const along = side == 0 || side > 2 ? h.u : h.v,
                            *const up = side == 0 ? h.v : h.n;
        double nearest = 0;
        f.side = side > 0;
        for (int k = 0; k < 3; k++) {
            f.out[k] = side == 2 || side == 4 ? -out[k] : out[k];
            f.along[k] = along[k];
            f.up[k] = up[k];
        }
        for (int i = 0; i < q.n; i++) {
            sub3(a, q.v[i], r->centre);
            nearest = fmax(nearest, dot3(a, f.out));
        }
        if (nearest > 0) /* else all of s is behind this face */
            sum += hemicube_sum(&f, (const double(*)[3])plane, q.n, pixels);
    }
    /* pixels are taken at their middles: all of them together make 1.00003 */
    return polygon_factor_hidden(r, s, sum * r->area) ? 0 : fmin(sum, 1);
}

#endif
