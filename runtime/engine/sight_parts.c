/* sight_parts.c - see sight_parts.h.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stddef.h>
#include "engine/sight_parts.h"
#include "kernel/hash.h"

int sight_part_in_front(struct polygon *out, const struct element *e, const struct element *plane,
                        double flat)
{
    double h[4];
    int front = 0, behind = 0;
    for (int i = 0; i < e->vertices; i++) {
        h[i] = height3(e->vertex[i], plane->centre, plane->normal);
        if (fabs(h[i]) <= flat)
            h[i] = 0;
        front += h[i] > 0;
        behind += h[i] < 0;
    }
    out->n = front ? polygon_divide(&e->vertex[0][0], e->vertices, 3, h, POLYGON_MAX, &out->v[0][0],
                                    NULL, NULL)
                   : 0;
    if (out->n < 3)
        out->n = 0;
    return !behind;
}

void sight_piece_make(struct element *piece, const struct element *e, const double (*v)[3], int n)
{
    double sum[3] = {0, 0, 0}, square = 0;
    *piece = *e;
    piece->vertices = (uint8_t)n;
    piece->area = 0;
    for (int i = 0; i < n; i++)
        for (int k = 0; k < 3; k++)
            piece->vertex[i][k] = v[i][k];
    for (int i = 2; i < n; i++) {
        double a[3], b[3], c[3];
        sub3(a, v[i - 1], v[0]);
        sub3(b, v[i], v[0]);
        cross3(c, a, b);
        double area = 0.5 * dot3(c, e->normal);
        piece->area += area;
        for (int k = 0; k < 3; k++)
            sum[k] += area * (v[0][k] + v[i - 1][k] + v[i][k]) * (1 / 3.0);
    }
    for (int k = 0; k < 3; k++)
        piece->centre[k] = piece->area > 0 ? sum[k] / piece->area : v[0][k];
    for (int i = 0; i < n; i++) {
        double d[3];
        sub3(d, v[i], piece->centre);
        square = fmax(square, dot3(d, d));
    }
    piece->radius = sqrt(square);
}

/* How far from the middle of its sides a piece is cut, at the most, as a share of them; measured.
 */
static const double OFF_MIDDLE = 0.125;

static void between_at(double out[3], const double a[3], const double b[3], double t)
{
    for (int k = 0; k < 3; k++)
        out[k] = a[k] + t * (b[k] - a[k]);
}

void sight_quarter_make(struct element *out, const struct element *e, int q)
{
    int n = e->vertices;
    const double(*v)[3] = (const double(*)[3])e->vertex;
    double t[4] = {0}, m[4][3], p[4][3], centre[3];
    for (int i = 0; i < n; i++) {
        t[i] = n == 4 && i >= 2
                   ? 1 - t[i - 2]
                   : 0.5
                         + OFF_MIDDLE
                               * (2 * hash_unit(e->id + (uint64_t)(SIGHT_QUARTERS + i + 1)) - 1);
        between_at(m[i], v[i], v[i + 1 < n ? i + 1 : 0], t[i]);
    }
    between_at(centre, m[0], m[n == 4 ? 2 : 1], t[1]); /* of a quad */
    for (int k = 0; k < 3; k++) {
        if (n == 3) { /* the last one is the middle */
            p[0][k] = q < 3 ? v[q][k] : m[0][k];
            p[1][k] = q < 3 ? m[q][k] : m[1][k];
            p[2][k] = q < 3 ? m[(q + 2) % 3][k] : m[2][k];
        } else {
            p[0][k] = v[q][k];
            p[1][k] = m[q][k];
            p[2][k] = centre[k];
            p[3][k] = m[(q + 3) % 4][k];
        }
    }
    sight_piece_make(out, e, (const double(*)[3])p, n);
    out->id = hash64(e->id + (uint64_t)q + 1);
}
