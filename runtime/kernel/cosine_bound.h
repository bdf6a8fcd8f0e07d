/* cosine_bound.h - between which cosines do all directions from one element's points to another's
 * meet its normal?
 *
 * With v = y - x from any point x of the one to any y of the other, the v are a convex polytope
 * whose corners are the differences of corners. c(v) = n.v / |v| is quasi-concave where n.v >= 0:
 * its level sets are cones. So there the least c is at a corner, exactly. The largest is that of
 * the least angle between n and the polytope: project the corners on the plane n.v = 1, then
 * 1/sqrt(1 + m^2) where no point of their hull is nearer to n's foot than m. m is found by
 * Gilbert's algorithm, whose every step proves a lower bound: for any w, the hull is not nearer
 * than min w.u / |w|. Where n.v has both signs the corners are projected along n instead, and m is
 * that over the largest n.v; the other end is the same problem with -n. Clusters: interval
 * arithmetic over boxes and spheres, then the cone of normals. A corner nearer to the plane than
 * 2^-40 of the pair's size lies in it, and corners so near are one. [Gilbert 1966; D: the rest
 * derived here]
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_COSINE_BOUND_H
#define KERNEL_COSINE_BOUND_H

#include "discussion.h"
#include "kernel/constants.h"
#include "kernel/element_distance.h"
#include "kernel/lambert.h"

enum { COSINE_BOUND_STEPS = 12 };

/* A number that the distance of the points' hull from the origin is not below. */
static inline double cosine_bound_hull(const double (*u)[3], int n)
{
    double w[3] = {0, 0, 0}, square = INFINITY, best = 0;
    for (int i = 0; i < n; i++)
        if (dot3(u[i], u[i]) < square) {
            square = dot3(u[i], u[i]);
            for (int k = 0; k < 3; k++)
                w[k] = u[i][k];
        }
    for (int step = 0; step < COSINE_BOUND_STEPS && square > 0; step++) {
        double least = INFINITY, toward[3];
        int at = 0;
        for (int i = 0; i < n; i++)
            if (dot3(u[i], w) < least) {
                least = dot3(u[i], w);
                at = i;
            }
        if (least > best * sqrt(square))
            best = least / sqrt(square);
        if (!(least < square * (1 - COSINE_BOUND_ENOUGH)))
            break;
        sub3(toward, u[at], w);
        double t = (square - least) / dot3(toward, toward);
        for (int k = 0; k < 3; k++)
            w[k] += (t < 1 ? t : 1) * toward[k];
        square = dot3(w, w);
    }
    return best;
}

/* A number that no cosine of v[n] with sign * normal exceeds; h: normal.v, some of the right
 * sign. */
static inline double cosine_bound_peak(const double (*v)[3], const double *h, int n,
                                       const double normal[3], double sign)
{
    double u[16][3], least = INFINITY, most = 0;
    for (int i = 0; i < n; i++) {
        least = sign * h[i] < least ? sign * h[i] : least;
        most = sign * h[i] > most ? sign * h[i] : most;
    }
    for (int i = 0; i < n; i++)
        for (int k = 0; k < 3; k++)
            u[i][k] = (v[i][k] - h[i] * normal[k]) / (least > 0 ? sign * h[i] : most);
    double m = cosine_bound_hull((const double(*)[3])u, n);
    return 1 / sqrt(1 + m * m);
}

static inline void cosine_bound_surfaces(const struct element *e, const struct element *other,
                                         double range[2])
{
    double v[16][3], h[16], axis[3], low = INFINITY, high = -INFINITY, least = 1, most = -1;
    int n = 0;
    sub3(axis, other->centre, e->centre);
    double flat = COSINE_BOUND_FLAT * (length3(axis) + e->radius + other->radius);
    for (int i = 0; i < e->vertices; i++)
        for (int j = 0; j < other->vertices; j++) {
            sub3(v[n], other->vertex[j], e->vertex[i]);
            double size = length3(v[n]);
            if (!(size > flat))
                continue;
            h[n] = height3(other->vertex[j], e->centre, e->normal);
            h[n] = fabs(h[n]) > flat ? h[n] : 0;
            low = h[n] < low ? h[n] : low;
            high = h[n] > high ? h[n] : high;
            double c = h[n] / size;
            least = c < least ? c : least;
            most = c > most ? c : most;
            n++;
        }
    range[0] = low >= 0 ? least : -cosine_bound_peak((const double(*)[3])v, h, n, e->normal, -1);
    range[1] = high <= 0 ? most : cosine_bound_peak((const double(*)[3])v, h, n, e->normal, 1);
}

/* n.v over all v between the boxes, over the distance of the boxes; then the normals around n. */
static inline void cosine_bound_boxes(const struct element *e, const struct element *other,
                                      double range[2])
{
    double box[4][3], v[3], half = 0, distance[2];
    range[0] = -1;
    range[1] = 1;
    distance_bound(e, other, distance);
    if (!(distance[0] > 0) || !(e->cone > -1))
        return;
    distance_box(e, box[0], box[1]);
    distance_box(other, box[2], box[3]);
    for (int k = 0; k < 3; k++) {
        v[k] = 0.5 * (box[2][k] + box[3][k] - box[0][k] - box[1][k]);
        half += 0.5 * fabs(e->normal[k]) * (box[3][k] - box[2][k] + box[1][k] - box[0][k]);
    }
    double middle = dot3(e->normal, v);
    range[0] = (middle - half) / distance[middle > half];
    range[1] = (middle + half) / distance[middle + half < 0];
    double open = e->vertices ? 0 : acos(e->cone < 1 ? e->cone : 1) + COSINE_BOUND_CONE;
    range[0] = range[0] > -1 ? range[0] : -1;
    range[1] = range[1] < 1 ? range[1] : 1;
    range[0] = acos(range[0]) + open < LAMBERT_PI ? cos(acos(range[0]) + open) : -1;
    range[1] = acos(range[1]) - open > 0 ? cos(acos(range[1]) - open) : 1;
}

OUTLINE void cosine_bound(const struct element *e, const struct element *other, double range[2])
{
    if (e->vertices && other->vertices)
        cosine_bound_surfaces(e, other, range);
    else
        cosine_bound_boxes(e, other, range);
    range[0] = range[0] - COSINE_BOUND_ROUNDING > -1 ? range[0] - COSINE_BOUND_ROUNDING : -1;
    range[1] = range[1] + COSINE_BOUND_ROUNDING < 1 ? range[1] + COSINE_BOUND_ROUNDING : 1;
}

/* The cosine at the centre. */
static inline double cosine_centre(const double normal[3], const double axis[3])
{
    double size = length3(axis);
    return size > 0 ? dot3(normal, axis) / size : 0;
}

#endif
