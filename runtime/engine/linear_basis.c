/* linear_basis.c - see linear_basis.h.
 * SPDX-License-Identifier: MIT */
#include "engine/linear_basis.h"

#include <math.h>
#include <string.h>
#include "kernel/constants.h"

/* Second moments about the centroid in plane coordinates, the x axis along the first edge (m2). */
struct moments {
    double x[3], y[3], xx, xy, yy;
};

static void measure(struct moments *m, const struct element *e)
{
    double p[4][2], along[3];
    memset(m, 0, sizeof *m);
    sub3(along, e->vertex[1], e->vertex[0]);
    double size = length3(along);
    if (!(size > 0 && e->area > 0))
        return;
    for (int k = 0; k < 3; k++)
        m->x[k] = along[k] / size;
    cross3(m->y, e->normal, m->x);
    for (int i = 0; i < e->vertices; i++) {
        double from[3];
        sub3(from, e->vertex[i], e->centre);
        p[i][0] = dot3(from, m->x);
        p[i][1] = dot3(from, m->y);
    }
    /* of a triangle: area / 12 times the sum over its corners and over their sum */
    for (int i = 2; i < e->vertices; i++) {
        const double *a = p[0], *b = p[i - 1], *c = p[i];
        double area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])),
               x = a[0] + b[0] + c[0], y = a[1] + b[1] + c[1], share = area / (12 * e->area);
        m->xx += share * (a[0] * a[0] + b[0] * b[0] + c[0] * c[0] + x * x);
        m->xy += share * (a[0] * a[1] + b[0] * b[1] + c[0] * c[1] + x * y);
        m->yy += share * (a[1] * a[1] + b[1] * b[1] + c[1] * c[1] + y * y);
    }
}

void linear_basis_of(struct linear_basis *basis, const struct element *e)
{
    struct moments m;
    memset(basis, 0, sizeof *basis);
    measure(&m, e);
    double least = LINEAR_THIN * LINEAR_THIN * e->radius * e->radius;
    if (!(m.xx > least))
        return;
    double across = m.yy - m.xy * m.xy / m.xx;
    double a = sqrt(m.xx), b = across > least ? sqrt(across) : 0;
    for (int k = 0; k < 3; k++) {
        basis->g[0][k] = m.x[k] / a;
        basis->d[0][k] = a * m.x[k] + m.xy / a * m.y[k];
        if (b > 0) {
            basis->g[1][k] = (m.y[k] - m.xy / m.xx * m.x[k]) / b;
            basis->d[1][k] = b * m.y[k];
        }
    }
}

void linear_basis_range(const struct linear_basis *basis, const struct element *e,
                        const double b[2], double *least, double *most)
{
    *least = INFINITY;
    *most = -INFINITY;
    for (int i = 0; i < e->vertices; i++) {
        double phi[2];
        linear_basis_at(basis, e->centre, e->vertex[i], phi);
        double value = b[0] * phi[0] + b[1] * phi[1];
        *least = fmin(*least, value);
        *most = fmax(*most, value);
    }
}

void linear_two_scale(struct two_scale *t, const struct linear_basis *basis,
                      const struct element *e, const struct linear_basis *of_child,
                      const struct element *child)
{
    linear_basis_at(basis, e->centre, child->centre, t->mean);
    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++)
            t->from[a][b] = dot3(of_child->d[b], basis->g[a]);
}
