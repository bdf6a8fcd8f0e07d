/* polygon.c - see polygon.h.
 *
 * Ear clipping [Meisters 1975]: a polygon always has a corner whose triangle holds no other
 * corner; cut it off and go on. Among the ears we take the one with the shortest cut, which
 * keeps the triangles of convex polygons from degenerating into slivers.
 * SPDX-License-Identifier: MIT */
#include "hierarchy/polygon.h"

#include <math.h>

#include "geometry.h"
#include "kernel/constants.h"

double polygon_normal(double (*vertex)[3], uint32_t count, double normal[3])
{
    double sum[3] = {0, 0, 0};
    for (uint32_t i = 1; i + 1 < count; i++) {
        /* Relative to the first corner, so that a far origin costs no digits. */
        double a[3], b[3], c[3];
        sub3(a, vertex[i], vertex[0]);
        sub3(b, vertex[i + 1], vertex[0]);
        cross3(c, a, b);
        for (int k = 0; k < 3; k++)
            sum[k] += c[k];
    }
    double twice = length3(sum);
    for (int k = 0; k < 3; k++)
        normal[k] = twice > 0 ? sum[k] / twice : 0;
    return twice / 2;
}

double polygon_size(double (*vertex)[3], uint32_t count)
{
    /* Beyond 64 corners the box's diagonal is near enough, and n is not squared. */
    double size = 0, low[3], high[3], diagonal[3];
    if (count <= 64) {
        for (uint32_t i = 0; i < count; i++)
            for (uint32_t j = 0; j < i; j++) {
                double d[3];
                sub3(d, vertex[i], vertex[j]);
                size = fmax(size, length3(d));
            }
        return size;
    }
    for (int k = 0; k < 3; k++) {
        low[k] = high[k] = vertex[0][k];
        for (uint32_t i = 1; i < count; i++) {
            low[k] = fmin(low[k], vertex[i][k]);
            high[k] = fmax(high[k], vertex[i][k]);
        }
    }
    sub3(diagonal, high, low);
    return length3(diagonal);
}

int polygon_degenerate(double (*vertex)[3], uint32_t count, double precision)
{
    if (count < 3)
        return 1;
    double normal[3], largest = 0, size = polygon_size(vertex, count);
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            largest = fmax(largest, fabs(vertex[i][k]));
    double area = polygon_normal(vertex, count, normal);
    return !(area > SCENE_THIN * size * size
             && area > SCENE_THIN_ROUNDINGS * precision * largest * size);
}

int polygon_flat(double (*vertex)[3], uint32_t count, double tolerance)
{
    double normal[3], centre[3] = {0, 0, 0};
    polygon_normal(vertex, count, normal);
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            centre[k] += vertex[i][k] / count;
    for (uint32_t i = 0; i < count; i++) {
        double d[3];
        sub3(d, vertex[i], centre);
        if (fabs(dot3(d, normal)) > tolerance)
            return 0;
    }
    return 1;
}

int polygon_convex_quad(double (*vertex)[3])
{
    double normal[3];
    polygon_normal(vertex, 4, normal);
    for (int i = 0; i < 4; i++) {
        double a[3], b[3], c[3];
        sub3(a, vertex[(i + 1) % 4], vertex[i]);
        sub3(b, vertex[(i + 2) % 4], vertex[(i + 1) % 4]);
        cross3(c, a, b);
        if (dot3(c, normal) < -1e-6 * length3(a) * length3(b))
            return 0;
    }
    return 1;
}

static double side(const double a[3], const double b[3], const double c[3], const double normal[3])
{
    double u[3], v[3], w[3];
    sub3(u, b, a);
    sub3(v, c, a);
    cross3(w, u, v);
    return dot3(w, normal);
}

/* Is the triangle at place i of the remaining ring an ear? */
static int ear(double (*vertex)[3], const uint32_t *ring, uint32_t count, uint32_t i,
               const double normal[3])
{
    const double *a = vertex[ring[(i + count - 1) % count]], *b = vertex[ring[i]],
                 *c = vertex[ring[(i + 1) % count]];
    if (side(a, b, c, normal) <= 0)
        return 0;
    for (uint32_t step = 2; step < count - 1; step++) {
        const double *p = vertex[ring[(i + step) % count]];
        /* A ring joined to a hole visits a point twice: that is no obstacle. */
        if ((p[0] == a[0] && p[1] == a[1] && p[2] == a[2])
            || (p[0] == c[0] && p[1] == c[1] && p[2] == c[2]))
            continue;
        if (side(a, b, p, normal) >= 0 && side(b, c, p, normal) >= 0 && side(c, a, p, normal) >= 0)
            return 0;
    }
    return 1;
}

uint32_t polygon_triangulate(double (*vertex)[3], uint32_t count, uint32_t (*triangle)[3],
                             uint32_t *scratch)
{
    double normal[3];
    uint32_t *ring = scratch, triangles = 0, start = 0;
    polygon_normal(vertex, count, normal);
    for (uint32_t i = 0; i < count; i++)
        ring[i] = i;
    while (count > 3) {
        uint32_t best = count;
        double shortest = INFINITY;
        for (uint32_t step = 0; step < count; step++) {
            uint32_t i = (start + step) % count;
            if (!ear(vertex, ring, count, i, normal))
                continue;
            double d[3];
            sub3(d, vertex[ring[(i + count - 1) % count]], vertex[ring[(i + 1) % count]]);
            if (length3(d) < shortest) {
                shortest = length3(d);
                best = i;
            }
            if (count > 64)
                break; /* the best ear is a luxury that costs n^3 */
        }
        if (best < count) {
            triangle[triangles][0] = ring[(best + count - 1) % count];
            triangle[triangles][1] = ring[best];
            triangle[triangles++][2] = ring[(best + 1) % count];
        } else {
            /* Only straight or crossing corners are left: let go of the flattest. */
            double least = INFINITY;
            best = 0;
            for (uint32_t i = 0; i < count; i++) {
                double s = fabs(side(vertex[ring[(i + count - 1) % count]], vertex[ring[i]],
                                     vertex[ring[(i + 1) % count]], normal));
                if (s < least) {
                    least = s;
                    best = i;
                }
            }
        }
        for (uint32_t i = best; i + 1 < count; i++)
            ring[i] = ring[i + 1];
        count--;
        start = best % count;
    }
    for (int k = 0; k < 3; k++)
        triangle[triangles][k] = ring[k];
    return triangles + 1;
}
