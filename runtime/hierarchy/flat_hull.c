/* flat_hull.c - tight outlines of points in a plane.
 *
 * A smallest rectangle around a convex outline has a side that lies on one of its [Freeman &
 * Shapira 1975], so that it is enough to turn a rectangle around it from side to side, and to carry
 * along the corners that it rests on. The hull is made of its lower and its upper chain, from the
 * points sorted along the first axis [Andrew 1979].
 *
 * Invariant: what any function here returns lies around all the points, to rounding.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "hierarchy/flat_hull.h"

/* Of the squares of lengths, and of areas of rectangles: less is rounding. */
#define ROUNDING 1e-12
#define ALIKE 1e-9
/* Sides of an outline that is worth four sides; one rounder is as well off with a rectangle. */
enum { MANY_SIDES = 64 };

static double across(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static double square(const double a[2], const double b[2])
{
    return (b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]);
}

static int by_place(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return x[0] < y[0] ? -1 : x[0] > y[0] ? 1 : x[1] < y[1] ? -1 : x[1] > y[1];
}

/* Does an outline turn left at b by more than rounding? */
static int turns(const double a[2], const double b[2], const double c[2])
{
    return across(a, b, c) > ROUNDING * (square(a, b) + square(b, c));
}

/* Without the corners at which it goes straight on. */
static size_t straighten(double (*hull)[2], size_t n)
{
    for (size_t i = 0, kept = 0; n > 2 && kept < n;) {
        const size_t next = (i + 1) % n;
        if (turns(hull[i], hull[next], hull[(i + 2) % n])) {
            i = next;
            kept++;
            continue;
        }
        memmove(hull[next], hull[next + 1], (n - 1 - next) * sizeof *hull);
        n--;
        i = next ? (i + n - 1) % n : n - 1;
        kept = 0;
    }
    return n;
}

/* Chains turn by however little: of points that share a first coordinate but for rounding, one that
 * lies beyond the next looks as if it lay between. */
size_t flat_hull(double (*points)[2], size_t n, double (*hull)[2])
{
    size_t count = 0, lower = 1;
    if (n == 0)
        return 0;
    qsort(points, n, sizeof *points, by_place);
    for (size_t i = 0; i < 2 * n - 1; i++) {
        const double *p = points[i < n ? i : 2 * n - 2 - i];
        while (count > lower && !(across(hull[count - 2], hull[count - 1], p) > 0))
            count--;
        memcpy(hull[count++], p, sizeof *hull);
        if (i == n - 1)
            lower = count;
    }
    return straighten(hull, count - (count > 1)); /* the last is the first */
}

double flat_area(const double (*corners)[2], size_t n)
{
    double area = 0;
    for (size_t i = 2; i < n; i++)
        area += across(corners[0], corners[i - 1], corners[i]);
    return 0.5 * area;
}

static double dot(const double (*hull)[2], size_t corner, const double way[2])
{
    return hull[corner][0] * way[0] + hull[corner][1] * way[1];
}

void flat_hull_direction(const double (*hull)[2], size_t n, double along[2])
{
    size_t at[3] = {1, 1, 1}; /* corners farthest right, up, left of the side that it rests on */
    double least = INFINITY, round = INFINITY;
    for (size_t i = 0; i < n; i++) {
        const double *a = hull[i], *b = hull[(i + 1) % n];
        double size = sqrt(square(a, b));
        const double u[2] = {(b[0] - a[0]) / size, (b[1] - a[1]) / size};
        const double way[3][2] = {{u[0], u[1]}, {-u[1], u[0]}, {-u[0], -u[1]}};
        double reach[3];
        for (int k = 0; k < 3; k++) {
            size_t step = 0;
            /* each begins where the one before it ends, and never has to turn back */
            if (k > 0 && i == 0)
                at[k] = at[k - 1];
            while (step++ < n && dot(hull, (at[k] + 1) % n, way[k]) > dot(hull, at[k], way[k]))
                at[k] = (at[k] + 1) % n;
            reach[k] = dot(hull, at[k], way[k]);
        }
        double wide = reach[0] + reach[2], high = reach[1] - dot(hull, i, way[1]);
        double area = wide * high;
        if (area < least * (1 - ALIKE)
            || (area < least * (1 + ALIKE) && wide + high < round * (1 - ALIKE))) {
            least = area;
            round = wide + high;
            memcpy(along, u, sizeof u);
        }
    }
}

/* Where the sides before and after side i (from corner i on) meet beyond it, and how much area that
 * adds; infinite when they do not. */
static double beyond(double (*hull)[2], size_t n, size_t i, double meet[2])
{
    const double *a = hull[(i + n - 1) % n], *b = hull[i], *c = hull[(i + 1) % n],
                 *d = hull[(i + 2) % n];
    const double u[2] = {b[0] - a[0], b[1] - a[1]}, v[2] = {c[0] - d[0], c[1] - d[1]};
    double turn = u[1] * v[0] - u[0] * v[1]; /* u x (d - c) */
    if (!(turn > ROUNDING * sqrt(square(a, b) * square(c, d))))
        return INFINITY;
    double t = ((c[0] - b[0]) * -v[1] + (c[1] - b[1]) * v[0]) / turn;
    meet[0] = b[0] + t * u[0];
    meet[1] = b[1] + t * u[1];
    return fabs(across(b, meet, c));
}

size_t flat_hull_quad(double (*hull)[2], size_t n)
{
    if (n > MANY_SIDES)
        return n;
    while (n > 4) {
        double least = INFINITY, corner[2] = {0, 0}, meet[2];
        size_t side = n;
        for (size_t i = 0; i < n; i++) {
            double more = beyond(hull, n, i, meet);
            if (more < least) {
                least = more;
                side = i;
                memcpy(corner, meet, sizeof meet);
            }
        }
        if (side == n)
            break;
        size_t gone = (side + 1) % n;
        memcpy(hull[side], corner, sizeof corner);
        memmove(hull[gone], hull[gone + 1], (n - 1 - gone) * sizeof *hull);
        n--;
    }
    return n;
}
