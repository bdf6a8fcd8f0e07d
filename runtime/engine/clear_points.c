/* clear_points.c - see clear_points.h.
 *
 * The rules are exact to degree 8 on triangles and 7 along the sides of quads.
 * [triangles: Dunavant 1985, to more digits; quads: Gauss]
 * SPDX-License-Identifier: MIT */
#include <string.h>
#include "engine/clear_points.h"
#include "kernel/constants.h"
#include "kernel/lambert.h"

static void open_triangle(struct clear_rule *rule)
{
    /* a point, three times three, and six, that lie alike to the corners: one or two coordinates */
    static const double node[5][2] = {{1 / 3.0, 1 / 3.0},
                                      {0.17056930775176020662, 0.17056930775176020662},
                                      {0.05054722831703097545, 0.05054722831703097545},
                                      {0.45929258829272315603, 0.45929258829272315603},
                                      {0.26311282963463811342, 0.00839477740995760534}};
    static const double weight[5] = {0.14431560767778716825, 0.10321737053471825028,
                                     0.03245849762319808031, 0.09509163426728462479,
                                     0.02723031417443499426};
    int n = 0;
    for (int k = 0; k < 5; k++) {
        const double u = node[k][0], v = node[k][1], w = 1 - u - v;
        const double turn[6][2] = {{u, v}, {v, w}, {w, u}, {v, u}, {w, v}, {u, w}};
        for (int i = 0; i < (k == 0 ? 1 : k < 4 ? 3 : 6); i++) {
            rule->at[0][n] = turn[i][0];
            rule->at[1][n] = turn[i][1];
            rule->weight[n++] = weight[k];
        }
    }
}

static void open_quad(struct clear_rule *rule)
{
    static const double node[4] = {0.06943184420297371239, 0.33000947820757186760,
                                   0.66999052179242813240, 0.93056815579702628761};
    static const double weight[4] = {0.17392742256872692869, 0.32607257743127307131,
                                     0.32607257743127307131, 0.17392742256872692869};
    for (int i = 0; i < CLEAR_POINTS; i++) {
        rule->at[0][i] = node[i / 4];
        rule->at[1][i] = node[i % 4];
        rule->weight[i] = weight[i / 4] * weight[i % 4];
    }
}

/* The polynomials of all degrees up to the highest, made orthonormal in their order; those of the
 * two highest are kept. */
static void open_parts(struct clear_rule *rule, int degree)
{
    double basis[(4 + 1) * (4 + 2) / 2][CLEAR_POINTS];
    int count = 0, first = degree * (degree - 1) / 2;
    for (int d = 0; d <= degree; d++)
        for (int k = 0; k <= d; k++, count++) {
            double *own = basis[count], square = 0;
            for (int i = 0; i < CLEAR_POINTS; i++) {
                own[i] = 1;
                for (int j = 0; j < d; j++)
                    own[i] *= rule->at[j < k][i] - 0.4;
            }
            for (int twice = 0; twice < 2; twice++)
                for (int c = 0; c < count; c++) {
                    double product = 0;
                    for (int i = 0; i < CLEAR_POINTS; i++)
                        product += rule->weight[i] * own[i] * basis[c][i];
                    for (int i = 0; i < CLEAR_POINTS; i++)
                        own[i] -= product * basis[c][i];
                }
            for (int i = 0; i < CLEAR_POINTS; i++)
                square += rule->weight[i] * own[i] * own[i];
            for (int i = 0; i < CLEAR_POINTS; i++)
                own[i] /= sqrt(square);
        }
    rule->before = degree;
    rule->last = degree + 1;
    for (int i = 0; i < CLEAR_POINTS; i++) {
        rule->part[i][0] = rule->weight[i];
        for (int c = first; c < count; c++)
            rule->part[i][1 + c - first] = rule->weight[i] * basis[c][i];
    }
}

void clear_rules_open(struct clear_rule rules[2])
{
    memset(rules, 0, 2 * sizeof *rules);
    open_triangle(&rules[0]);
    open_parts(&rules[0], 4);
    open_quad(&rules[1]);
    open_parts(&rules[1], 3);
}

/* Of the points of a face, what each sees of another, v[count]: the mean and the parts. A quad is
 * spread out by more or less than in the mean from place to place. */
TOOL void see_body(const struct clear_rule *rule, const struct element *e,
                   const struct element *other, double *restrict part)
{
    const double(*v)[3] = (const double(*)[3])e->vertex;
    const int quad = e->vertices == 4;
    const double n0 = e->normal[0], n1 = e->normal[1], n2 = e->normal[2], area = e->area;
    double s[3], t[3], turn[3], x[3][CLEAR_POINTS], f[CLEAR_POINTS] = {0};
    for (int k = 0; k < 3; k++) {
        s[k] = v[1][k] - v[0][k];
        t[k] = v[e->vertices - 1][k] - v[0][k];
        turn[k] = quad ? v[2][k] - v[1][k] - t[k] : 0;
    }
    for (int i = 0; i < CLEAR_POINTS; i++)
        for (int k = 0; k < 3; k++)
            x[k][i] = v[0][k] + rule->at[0][i] * s[k]
                      + rule->at[1][i] * (t[k] + rule->at[0][i] * turn[k]);
    for (int i = 0, j = other->vertices - 1; i < other->vertices; j = i++) {
        const double *a = other->vertex[j], *b = other->vertex[i];
        const double a0 = a[0], a1 = a[1], a2 = a[2], b0 = b[0], b1 = b[1], b2 = b[2];
        for (int k = 0; k < CLEAR_POINTS; k++)
            f[k] += lambert_edge(a0 - x[0][k], a1 - x[1][k], a2 - x[2][k], b0 - x[0][k],
                                 b1 - x[1][k], b2 - x[2][k], n0, n1, n2);
    }
    for (int i = 0; i < CLEAR_POINTS && quad; i++) {
        double along[3], across[3], jacobian[3];
        for (int k = 0; k < 3; k++) {
            along[k] = s[k] + rule->at[1][i] * turn[k];
            across[k] = t[k] + rule->at[0][i] * turn[k];
        }
        cross3(jacobian, along, across);
        f[i] *= (jacobian[0] * n0 + jacobian[1] * n1 + jacobian[2] * n2) / area;
    }
    for (int c = 0; c < CLEAR_PARTS; c++)
        part[c] = 0;
    for (int i = 0; i < CLEAR_POINTS; i++)
        for (int c = 0; c < CLEAR_PARTS; c++)
            part[c] += f[i] * rule->part[i][c];
}

#if LANES_CHOSEN
LANES_AVX512 void see_8(const struct clear_rule *rule, const struct element *e,
                        const struct element *other, double *part)
{
    see_body(rule, e, other, part);
}
LANES_AVX2 void see_4(const struct clear_rule *rule, const struct element *e,
                      const struct element *other, double *part)
{
    see_body(rule, e, other, part);
}
#endif

/* Is the other face farther from the middle than CLEAR_POINTS_NEAR radii? */
static int is_apart(const struct element *e, const struct element *other)
{
    double away[3], least = CLEAR_POINTS_NEAR * e->radius;
    sub3(away, other->centre, e->centre);
    return dot3(away, away) > (least + other->radius) * (least + other->radius)
           || polygon_distance(e->centre, (const double(*)[3])other->vertex, other->vertices,
                               other->normal)
                  > least;
}

double clear_points(const struct clear_rule rules[2], const struct element *a,
                    const struct element *b, double *error)
{
    const struct element *e = a->radius <= b->radius ? a : b, *other = e == a ? b : a;
    const struct clear_rule *rule = &rules[e->vertices == 4];
    double part[CLEAR_PARTS], before = 0, last = 0;
    *error = INFINITY;
    if (!is_apart(e, other))
        return 0;
    LANES_RUN(lanes_width(), see_8, see_4, see_body, (rule, e, other, part));
    for (int c = 1; c <= rule->before; c++)
        before += part[c] * part[c];
    for (int c = 1 + rule->before; c <= rule->before + rule->last; c++)
        last += part[c] * part[c];
    /* where the highest degree is missing by chance, or by symmetry, the one before it is not */
    const double mean = fabs(part[0]), scale = e->area * (0.5 / LAMBERT_PI);
    *error = scale * fmax(last / mean, before * sqrt(before) / (mean * mean));
    return -scale * part[0];
}
