/* surface.h - a surface from its corners: area, centroid, normal, radius; and its quarters.
 *
 * Halving at midpoints (a + b) / 2 is exact to the last bit in both directions of an edge, so that
 * parts of neighbours meet.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_SURFACE_H
#define KERNEL_SURFACE_H

#include <string.h>
#include "discussion.h"

/* Area, centroid, unit normal and radius from the corners. */
static inline void surface_measure(struct element *e)
{
    double normal[3] = {0, 0, 0}, sum[3] = {0, 0, 0}, area = 0, farthest = 0;
    for (int i = 2; i < e->vertices; i++) {
        double a[3], b[3], c[3];
        sub3(a, e->vertex[i - 1], e->vertex[0]);
        sub3(b, e->vertex[i], e->vertex[0]);
        cross3(c, a, b);
        for (int k = 0; k < 3; k++)
            normal[k] += c[k];
    }
    double size = length3(normal);
    for (int k = 0; k < 3; k++)
        e->normal[k] = size > 0 ? normal[k] / size : 0;
    for (int i = 2; i < e->vertices; i++) {
        double a[3], b[3], c[3];
        sub3(a, e->vertex[i - 1], e->vertex[0]);
        sub3(b, e->vertex[i], e->vertex[0]);
        cross3(c, a, b);
        double part = 0.5 * dot3(c, e->normal);
        area += part;
        for (int k = 0; k < 3; k++)
            sum[k] += part * (a[k] + b[k]) * (1 / 3.0);
    }
    e->area = area;
    for (int k = 0; k < 3; k++)
        e->centre[k] = e->vertex[0][k] + (area > 0 ? sum[k] / area : 0);
    for (int i = 0; i < e->vertices; i++) {
        double a[3];
        sub3(a, e->vertex[i], e->centre);
        double square = dot3(a, a);
        farthest = square > farthest ? square : farthest;
    }
    e->radius = sqrt(farthest);
    e->cone = 1;
}

/* The place of quarter i: the one that keeps corner i, or of a triangle, with i = 3, the one
 * between the midpoints. What is not place (identity, radiosity, ...) is zero. */
static inline void surface_quarter(const struct element *e, int i, struct element *quarter)
{
    int n = e->vertices;
    memset(quarter, 0, sizeof *quarter);
    double middle[4][3];
    for (int j = 0; j < n; j++)
        for (int k = 0; k < 3; k++)
            middle[j][k] = 0.5 * (e->vertex[j][k] + e->vertex[j + 1 < n ? j + 1 : 0][k]);
    for (int k = 0; k < 3; k++) {
        if (n == 3 && i == 3) {
            for (int j = 0; j < 3; j++)
                quarter->vertex[j][k] = middle[j][k];
        } else {
            int before = i > 0 ? i - 1 : n - 1;
            quarter->vertex[i][k] = e->vertex[i][k];
            quarter->vertex[i + 1 < n ? i + 1 : 0][k] = middle[i][k];
            quarter->vertex[before][k] = middle[before][k];
            if (n == 4)
                quarter->vertex[(i + 2) % 4][k] = 0.5 * (middle[0][k] + middle[2][k]);
        }
    }
    quarter->vertices = e->vertices;
    surface_measure(quarter);
    memcpy(quarter->normal, e->normal, sizeof quarter->normal);
}

#endif
