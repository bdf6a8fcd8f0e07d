/* face_rule.h - points of a face, and what each weighs in an integral over it.
 *
 * Inside it, exact to degree 4 (triangles) and 5 (quads); or on its rim, by the corners, the
 * middles of sides and the middle, exact to degree 3. Of a quad they are the products of two
 * sides' points, weighed by how far the quad is spread out there.
 * Together they tell what neither tells alone: two rules may agree by chance, but what the best
 * quadratic leaves of the values at the points of both is small only where they lie on one.
 * [triangles: Dunavant 1985; quads: Gauss, Simpson]
 * SPDX-License-Identifier: MIT */
#ifndef FACE_RULE_H
#define FACE_RULE_H

#include "discussion.h"
#include "kernel/constants.h"

enum { FACE_RULE = 9 }; /* the most points of a rule */

struct face_rule {
    int count;
    double x[3][FACE_RULE], weight[FACE_RULE];
    double all; /* what the weights add up to: 1 of a triangle, of a quad its area (m2) */
};

/* Where a rule's points stand, by the barycentric coordinate that stands alone or along a side. */
static inline const double *face_rule_nodes(int vertices, int rim)
{
    static const double of_triangle[2][3] = {
        {0.81684757298045851308, 0.10810301816807022736, 1 / 3.0},
        {1 - SIGHT_RIM, SIGHT_RIM, 1 / 3.0}};
    static const double of_quad[2][3] = {{0.11270166537925831148, 0.5, 0.88729833462074168852},
                                         {SIGHT_RIM, 0.5, 1 - SIGHT_RIM}};
    return vertices == 3 ? of_triangle[rim] : of_quad[rim];
}

static inline void face_rule_of_triangle(struct face_rule *rule, const struct element *e, int rim)
{
    static const double weight[2][3] = {{0.10995174365532186764, 0.22338158967801146570, 0},
                                        {3 / 60.0, 8 / 60.0, 27 / 60.0}};
    const double *node = face_rule_nodes(3, rim);
    const double(*v)[3] = (const double(*)[3])e->vertex;
    rule->count = 6 + rim;
    rule->all = 1;
    for (int i = 0; i < rule->count; i++) {
        double w = node[i / 3], u = 0.5 * (1 - w);
        rule->weight[i] = weight[rim][i / 3];
        for (int k = 0; k < 3; k++)
            rule->x[k][i] = w * v[i % 3][k] + u * (v[(i + 1) % 3][k] + v[(i + 2) % 3][k]);
    }
}

static inline void face_rule_of_quad(struct face_rule *rule, const struct element *e, int rim)
{
    static const double weight[2][3] = {{5 / 18.0, 8 / 18.0, 5 / 18.0},
                                        {1 / 6.0, 4 / 6.0, 1 / 6.0}};
    const double *node = face_rule_nodes(4, rim);
    const double(*v)[3] = (const double(*)[3])e->vertex;
    rule->count = 9;
    rule->all = e->area;
    for (int i = 0; i < rule->count; i++) {
        double s = node[i / 3], t = node[i % 3], ds[3], dt[3], jacobian[3];
        for (int k = 0; k < 3; k++) {
            double low = v[0][k] + s * (v[1][k] - v[0][k]),
                   high = v[3][k] + s * (v[2][k] - v[3][k]);
            dt[k] = high - low;
            ds[k] = (1 - t) * (v[1][k] - v[0][k]) + t * (v[2][k] - v[3][k]);
            rule->x[k][i] = low + t * dt[k];
        }
        cross3(jacobian, ds, dt);
        rule->weight[i] = weight[rim][i / 3] * weight[rim][i % 3] * dot3(jacobian, e->normal);
    }
}

static inline void face_rule_of(struct face_rule *rule, const struct element *e, int rim)
{
    if (e->vertices == 3)
        face_rule_of_triangle(rule, e, rim);
    else
        face_rule_of_quad(rule, e, rim);
}

/* Polynomials of degree 2 at the points of both rules, or of the first alone, orthonormal. */
enum { FACE_FIT = 6 };
struct face_fit {
    int count; /* of points: those inside, then those on the rim */
    double basis[FACE_FIT][2 * FACE_RULE];
};

static inline void face_fit_open(struct face_fit *fit, int vertices, int rules)
{
    fit->count = 0;
    for (int rim = 0; rim < rules; rim++) {
        const double *node = face_rule_nodes(vertices, rim);
        for (int i = 0; i < (vertices == 3 ? 6 + rim : 9); i++) {
            double w = node[i / 3], u = 0.5 * (1 - w), x = w, y = node[i % 3];
            if (vertices == 3) {
                x = i % 3 == 0 ? w : u;
                y = i % 3 == 1 ? w : u;
            }
            const double power[FACE_FIT] = {1, x, y, x * x, x * y, y * y};
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
