/* separable_faces.c - see separable_faces.h.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "engine/separable_faces.h"

void separable_faces_arrays(struct separable_faces *f, float *at, size_t count, int bands)
{
    for (int k = 0; k < 3; k++) {
        f->centre[k] = at + (size_t)k * count;
        f->normal[k] = at + (size_t)(3 + k) * count;
        f->sent[k] = at + (size_t)(SEPARABLE_ARRAYS + (k < bands ? k : 0)) * count;
    }
    for (int k = 0; k < 6; k++)
        f->across[k] = at + (size_t)(6 + k) * count;
    f->area = at + 12 * count;
    f->bright = at + 13 * count;
}

void separable_faces_set(const struct separable_faces *f, size_t i, const struct element *e,
                         const double low[3], double unit)
{
    double along[3], other[3], square[3] = {0, 0, 0}, inverse = 1 / unit;
    sub3(along, e->vertex[1], e->vertex[0]);
    double p = length3(along);
    for (int k = 0; k < 3; k++)
        along[k] *= p > 0 ? 1 / p : 0;
    cross3(other, e->normal, along);
    /* a twelfth of the corners' sum is exact for triangles and parallelograms */
    for (int v = 0; v < e->vertices; v++) {
        double w[3];
        sub3(w, e->vertex[v], e->centre);
        double x = dot3(w, along) * inverse;
        double y = dot3(w, other) * inverse;
        square[0] += x * x / 12;
        square[1] += x * y / 12;
        square[2] += y * y / 12;
    }
    p = sqrt(square[0]);
    double q = p > 0 ? square[1] / p : 0;
    double r = square[2] - q * q;
    r = r > 0 ? sqrt(r) : 0;
    for (int k = 0; k < 3; k++) {
        f->centre[k][i] = (float)((e->centre[k] - low[k]) * inverse);
        f->normal[k][i] = (float)e->normal[k];
        f->across[k][i] = (float)(p * along[k] + q * other[k]);
        f->across[3 + k][i] = (float)(r * other[k]);
    }
    f->area[i] = (float)(e->area * inverse * inverse);
    f->bright[i] = f->area[i] * (float)e->radiosity;
}

void separable_side_whole(struct separable_side *side, const struct separable_faces *f, size_t from,
                          size_t to)
{
    side->faces = *f;
    side->from = from;
    side->to = to;
}

void separable_side_part(struct separable_side *side, const struct element *e, const double low[3],
                         double unit)
{
    separable_faces_arrays(&side->faces, side->part, 1, 3);
    separable_faces_set(&side->faces, 0, e, low, unit);
    side->from = 0;
    side->to = 1;
}
