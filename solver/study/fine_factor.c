/* fine_factor.c - see fine_factor.h: adaptive integration of the point-to-polygon factor.
 *
 * A_p F_pq is the integral over p, the smaller of the two, of the factor from its points to q, both
 * clipped at the other's plane. It shares with the contour integral Lambert's sum for a point, and
 * neither edges nor logarithms. p is a fan of triangles, each the image of the unit square with one
 * side drawn together to a point. A box of the square is integrated by 4 x 4 Gauss points, and by
 * the same on its halves, across and along; while the better halves change the sum by more than
 * FINE of the whole, the box is halved the way that changes more. Where p and q touch, F(x) jumps
 * or bends at the edge alone, and boxes grow thin towards it.
 * SPDX-License-Identifier: MIT */
#include "study/fine_factor.h"
#include "kernel/lambert.h"

#include <math.h>

/* of the exchange: what halving one box may change. Boxes are some hundreds */
#define FINE 1e-11
enum { DEEPEST = 48, POINTS = 4 };

struct fine {
    const double *a, *b, *c; /* of the triangle */
    double area;             /* twice it, m2 */
    const double *normal;    /* of p */
    const struct polygon *q;
    double enough; /* m2 */
    double doubt;  /* m2 */
};

/* A box of the unit square. */
struct box {
    double s, t, wide, high;
};

/* The integral over the box. */
static double gauss(const struct fine *f, struct box box)
{
    static const double node[POINTS] = {0.069431844202973712, 0.33000947820757187,
                                        0.66999052179242813, 0.93056815579702629},
                        weight[POINTS] = {0.17392742256872693, 0.32607257743127307,
                                          0.32607257743127307, 0.17392742256872693};
    double sum = 0;
    for (int i = 0; i < POINTS; i++) {
        const double s = box.s + box.wide * node[i];
        for (int j = 0; j < POINTS; j++) {
            const double t = box.t + box.high * node[j];
            double x[3];
            for (int k = 0; k < 3; k++)
                x[k] = f->a[k] + s * (f->b[k] - f->a[k]) + s * t * (f->c[k] - f->b[k]);
            const double one = lambert_sum(x, f->normal, (const double(*)[3])f->q->v, f->q->n);
            sum += weight[i] * weight[j] * s * (one > 0 ? one : 0);
        }
    }
    return f->area * box.wide * box.high * sum;
}

static double integrate(struct fine *f, struct box box, double whole, int depth)
{
    struct box half[2][2] = {{box, box}, {box, box}};
    double part[2][2], change[2];
    for (int way = 0; way < 2; way++) {
        struct box *low = &half[way][0], *high = &half[way][1];
        if (way == 0) {
            low->wide = high->wide = 0.5 * box.wide;
            high->s += low->wide;
        } else {
            low->high = high->high = 0.5 * box.high;
            high->t += low->high;
        }
        part[way][0] = gauss(f, *low);
        part[way][1] = gauss(f, *high);
        change[way] = fabs(part[way][0] + part[way][1] - whole);
    }
    const int way = change[0] < change[1];
    if (!(change[way] > f->enough) || depth == DEEPEST) {
        f->doubt += change[way];
        return part[way][0] + part[way][1];
    }
    return integrate(f, half[way][0], part[way][0], depth + 1)
           + integrate(f, half[way][1], part[way][1], depth + 1);
}

double fine_factor(const struct element *r, const struct element *s, double *doubt)
{
    const int r_is_small = r->radius < s->radius || (r->radius == s->radius && r->id < s->id);
    const struct element *small = r_is_small ? r : s, *large = r_is_small ? s : r;
    const struct box all = {0, 0, 1, 1};
    struct polygon p, q;
    double first[POLYGON_MAX], rough = 0, sum = 0;
    *doubt = 0;
    polygon_clip(&p, (const double(*)[3])small->vertex, small->vertices, large->centre,
                 large->normal);
    polygon_clip(&q, (const double(*)[3])large->vertex, large->vertices, small->centre,
                 small->normal);
    if (p.n == 0 || q.n == 0)
        return 0;
    struct fine f = {.normal = small->normal, .q = &q};
    for (int turn = 0; turn < 2; turn++)
        for (int i = 2; i < p.n; i++) {
            double x[3], y[3], z[3];
            f.a = p.v[0];
            f.b = p.v[i - 1];
            f.c = p.v[i];
            sub3(x, f.b, f.a);
            sub3(y, f.c, f.a);
            cross3(z, x, y);
            f.area = length3(z);
            if (turn == 0)
                rough += first[i] = gauss(&f, all);
            else {
                f.enough = FINE * rough;
                sum += integrate(&f, all, first[i], 0);
            }
        }
    *doubt = f.doubt / r->area;
    return sum / r->area;
}
