/* face_rule.h - points of a face, and what each weighs in an integral over it.
 *
 * Inside it, exact to degree 4 (triangles) and 5 (quads); or on its rim, by the corners, the
 * middles of sides and the middle, exact to degree 3. Of a quad they are weighed by how far it is
 * spread out there; those on its rim are the products of two sides' points. Those inside are the
 * middle and two squares about it, turned, of the same degree and as many as products of Gauss
 * points: no two are as far along a side, so that shades that repeat along one, as those of fins
 * do, meet nine places of it, not three, which a quarter's three agreed with by chance.
 * Together they tell what neither tells alone: two rules may agree by chance, but what the best
 * quadratic leaves of the values at the points of both is small only where they lie on one. With
 * those on the rim go some that weigh nothing, at places along the sides where the others leave
 * wide gaps: a strip across a face, as is lit along a sheet's edge, is missed by products alike.
 * [triangles: Dunavant 1985; rims: Simpson; inside quads: derived here, see face_rule_place]
 * SPDX-License-Identifier: MIT */
#ifndef FACE_RULE_H
#define FACE_RULE_H

#include "discussion.h"
#include "kernel/constants.h"

/* the most points of a rule; those inside a quad, turned; those of products; which of either is a
 * quad's middle; and those that weigh nothing */
enum { FACE_RULE = 13, FACE_TURNED = 9, FACE_PRODUCTS = 9, FACE_MIDDLE = 4, FACE_MORE = 4 };

struct face_rule {
    int count;
    double x[3][FACE_RULE], weight[FACE_RULE];
    double all; /* what the weights add up to: 1 of a triangle, of a quad its area (m2) */
};

/* How many points a rule has, those that weigh nothing among them. */
static inline int face_rule_count(int vertices, int rim)
{
    return vertices == 3 ? 6 + 4 * rim : rim ? FACE_PRODUCTS + FACE_MORE : FACE_TURNED;
}

/* Where a point stands: of a triangle its first two barycentric coordinates, of a quad how far
 * along two sides. Of the middle and two squares about it, each turned by some angle, two numbers
 * stay free at degree 5, by symmetry; these make small how far the shares of the points' weights
 * on one side of a line are from those of the area. Root mean squares, of lines along sides .039
 * (products of Gauss points: .088), of lines in all directions .054 (.050); of the latter the least
 * is .050, and .069 along sides then. */
static inline void face_rule_place(int vertices, int rim, int i, double place[2])
{
    static const double of_triangle[3] = {0.66, 0.22, 0.12};
    static const double node[2][3] = {{0.81684757298045851308, 0.10810301816807022736, 1 / 3.0},
                                      {1 - SIGHT_RIM, SIGHT_RIM, 1 / 3.0}};
    static const double of_side[3] = {SIGHT_RIM, 0.5, 1 - SIGHT_RIM};
    static const double of_quad[FACE_MORE][2] = {
        {0.242, 0.629}, {0.371, 0.242}, {0.629, 0.758}, {0.758, 0.371}};
    static const double turned[FACE_TURNED][2] = {{0.64852586539627644, 0.88300139335032091},
                                                  {0.11699860664967915, 0.64852586539627644},
                                                  {0.35147413460372368, 0.11699860664967909},
                                                  {0.88300139335032091, 0.35147413460372368},
                                                  {0.5, 0.5},
                                                  {0.95634998021937512, 0.81918620065552816},
                                                  {0.18081379934447195, 0.95634998021937512},
                                                  {0.043650019780624827, 0.18081379934447195},
                                                  {0.81918620065552794, 0.043650019780624771}};
    if (vertices == 3) {
        const double w = node[rim][i < 7 ? i / 3 : 0], u = 0.5 * (1 - w);
        for (int k = 0; k < 2; k++)
            place[k] = i < 7 ? (i % 3 == k ? w : u) : of_triangle[(i - 7 + 3 - k) % 3];
    } else {
        for (int k = 0; k < 2; k++)
            place[k] = !rim                ? turned[i][k]
                       : i < FACE_PRODUCTS ? of_side[k ? i % 3 : i / 3]
                                           : of_quad[i - FACE_PRODUCTS][k];
    }
}

static inline void face_rule_of_triangle(struct face_rule *rule, const struct element *e, int rim)
{
    static const double weight[2][4] = {{0.10995174365532186764, 0.22338158967801146570, 0, 0},
                                        {3 / 60.0, 8 / 60.0, 27 / 60.0, 0}};
    const double(*v)[3] = (const double(*)[3])e->vertex;
    rule->count = face_rule_count(3, rim);
    rule->all = 1;
    for (int i = 0; i < rule->count; i++) {
        double at[2];
        face_rule_place(3, rim, i, at);
        rule->weight[i] = weight[rim][i < 7 ? i / 3 : 3];
        for (int k = 0; k < 3; k++)
            rule->x[k][i] = at[0] * v[0][k] + at[1] * v[1][k] + (1 - at[0] - at[1]) * v[2][k];
    }
}

static inline void face_rule_of_quad(struct face_rule *rule, const struct element *e, int rim)
{
    static const double turned[FACE_TURNED] = {0.13412589544276785,  0.13412589544276785,
                                               0.13412589544276785,  0.13412589544276785,
                                               0.21801733953755267,  0.061369769672843986,
                                               0.061369769672843986, 0.061369769672843986,
                                               0.061369769672843986},
                        side[3] = {1 / 6.0, 4 / 6.0, 1 / 6.0};
    const double(*v)[3] = (const double(*)[3])e->vertex;
    rule->count = face_rule_count(4, rim);
    rule->all = e->area;
    for (int i = 0; i < rule->count; i++) {
        double at[2], ds[3], dt[3], jacobian[3];
        face_rule_place(4, rim, i, at);
        const double s = at[0], t = at[1];
        for (int k = 0; k < 3; k++) {
            double low = v[0][k] + s * (v[1][k] - v[0][k]),
                   high = v[3][k] + s * (v[2][k] - v[3][k]);
            dt[k] = high - low;
            ds[k] = (1 - t) * (v[1][k] - v[0][k]) + t * (v[2][k] - v[3][k]);
            rule->x[k][i] = low + t * dt[k];
        }
        cross3(jacobian, ds, dt);
        const double share = !rim ? turned[i] : i < FACE_PRODUCTS ? side[i / 3] * side[i % 3] : 0;
        rule->weight[i] = share * dot3(jacobian, e->normal);
    }
}

static inline void face_rule_of(struct face_rule *rule, const struct element *e, int rim)
{
    if (e->vertices == 3)
        face_rule_of_triangle(rule, e, rim);
    else
        face_rule_of_quad(rule, e, rim);
}

/* Polynomials of degree 2 at the points of both rules, orthonormal. */
enum { FACE_FIT = 6 };
struct face_fit {
    int count; /* of points: those inside, then those on the rim */
    double basis[FACE_FIT][2 * FACE_RULE];
};

static inline void face_fit_open(struct face_fit *fit, int vertices)
{
    fit->count = 0;
    for (int rim = 0; rim < 2; rim++) {
        for (int i = 0; i < face_rule_count(vertices, rim); i++) {
            double at[2];
            face_rule_place(vertices, rim, i, at);
            const double x = at[0], y = at[1], power[FACE_FIT] = {1, x, y, x * x, x * y, y * y};
            for (int b = 0; b < FACE_FIT; b++)
                fit->basis[b][fit->count] = power[b];
            fit->count++;
        }
    }
    for (int b = 0; b < FACE_FIT; b++)
        for (int c = 0; c <= b; c++) { /* the last takes its length away */
            double product = 0;
            for (int i = 0; i < fit->count; i++)
                product += fit->basis[b][i] * fit->basis[c][i];
            for (int i = 0; i < fit->count; i++)
                fit->basis[b][i] = c < b ? fit->basis[b][i] - product * fit->basis[c][i]
                                         : fit->basis[b][i] / sqrt(product);
        }
}

/* What the best of these polynomials leaves of the values, by degree of freedom. */
static inline double face_fit_rest(const struct face_fit *fit, const double *value)
{
    double rest[2 * FACE_RULE], square = 0;
    for (int i = 0; i < fit->count; i++)
        rest[i] = value[i];
    for (int b = 0; b < FACE_FIT; b++) {
        double product = 0;
        for (int i = 0; i < fit->count; i++)
            product += rest[i] * fit->basis[b][i];
        for (int i = 0; i < fit->count; i++)
            rest[i] -= product * fit->basis[b][i];
    }
    for (int i = 0; i < fit->count; i++)
        square += rest[i] * rest[i];
    return sqrt(square / (fit->count - FACE_FIT));
}

#endif
