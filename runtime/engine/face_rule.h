/* face_rule.h - points of a face, and what each weighs in an integral over it.
 *
 * Inside it, exact to degree 4 (triangles) and 5 (quads); or on its rim, by the corners, the
 * middles of sides and the middle, exact to degree 3. Of a quad they are the products of two
 * sides' points, weighed by how far the quad is spread out there.
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

static inline void face_rule_of_triangle(struct face_rule *rule, const struct element *e, int rim)
{
    /* by the barycentric coordinate that stands alone */
    static const double node[2][3] = {{0.81684757298045851308, 0.10810301816807022736, 1 / 3.0},
                                      {1 - SIGHT_RIM, SIGHT_RIM, 1 / 3.0}};
    static const double weight[2][3] = {{0.10995174365532186764, 0.22338158967801146570, 0},
                                        {3 / 60.0, 8 / 60.0, 27 / 60.0}};
    const double(*v)[3] = (const double(*)[3])e->vertex;
    rule->count = 6 + rim;
    rule->all = 1;
    for (int i = 0; i < rule->count; i++) {
        double w = node[rim][i / 3], u = 0.5 * (1 - w);
        rule->weight[i] = weight[rim][i / 3];
        for (int k = 0; k < 3; k++)
            rule->x[k][i] = w * v[i % 3][k] + u * (v[(i + 1) % 3][k] + v[(i + 2) % 3][k]);
    }
}

static inline void face_rule_of_quad(struct face_rule *rule, const struct element *e, int rim)
{
    static const double node[2][3] = {{0.11270166537925831148, 0.5, 0.88729833462074168852},
                                      {SIGHT_RIM, 0.5, 1 - SIGHT_RIM}};
    static const double weight[2][3] = {{5 / 18.0, 8 / 18.0, 5 / 18.0},
                                        {1 / 6.0, 4 / 6.0, 1 / 6.0}};
    const double(*v)[3] = (const double(*)[3])e->vertex;
    rule->count = 9;
    rule->all = e->area;
    for (int i = 0; i < rule->count; i++) {
        double s = node[rim][i / 3], t = node[rim][i % 3], ds[3], dt[3], jacobian[3];
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

#endif
