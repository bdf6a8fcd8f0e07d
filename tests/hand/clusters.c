/* clusters.c - opening clusters, by hand.
 * SPDX-License-Identifier: MIT */
#include "hand.h"

/* Half the width of e's box along a: a surface has none along its own normal, and at most its
 * radius along another. */
static double half_width(const struct element *e, const double a[3], int own, double m)
{
    if (e->vertices)
        return own ? m : m + e->radius;
    m += 0.5 * fabs(a[0]) * (e->vertex[1][0] - e->vertex[0][0]);
    m += 0.5 * fabs(a[1]) * (e->vertex[1][1] - e->vertex[0][1]);
    m += 0.5 * fabs(a[2]) * (e->vertex[1][2] - e->vertex[0][2]);
    return m;
}

static int turned_away(const struct element *e, const struct element *other, double x, double y,
                       double z, double longest, double flat)
{
    const double *a = e->normal;
    if (e->cone <= 0)
        return 0;
    double m = a[0] * x + a[1] * y + a[2] * z;
    m = half_width(e, a, 1, m);
    m = half_width(other, a, 0, m);
    if (m > flat)
        return 0;
    double across = longest * longest - m * m, sine = 1 - e->cone * e->cone;
    return m * e->cone + (across > 0 && sine > 0 ? sqrt(across * sine) : 0) <= flat;
}

int hand_apart(const struct element *r, const struct element *s, const struct host *host)
{
    double x = s->centre[0] - r->centre[0], y = s->centre[1] - r->centre[1],
           z = s->centre[2] - r->centre[2];
    double reach = sqrt(x * x + y * y + z * z) + r->radius + s->radius;
    const double flat = host->flat;
    return turned_away(r, s, x, y, z, reach, flat) || turned_away(s, r, -x, -y, -z, reach, flat);
}

enum decision hand_open_clusters(const struct element *r, const struct element *s,
                                 const struct host *host)
{
    if (hand_apart(r, s, host))
        return DECISION_STOP;
    if (s->vertices)
        return DECISION_SUBDIVIDE_RECEIVER;
    if (r->vertices)
        return DECISION_SUBDIVIDE_EMITTER;
    if (r->radius != s->radius)
        return r->radius > s->radius ? DECISION_SUBDIVIDE_RECEIVER : DECISION_SUBDIVIDE_EMITTER;
    return r->id <= s->id ? DECISION_SUBDIVIDE_RECEIVER : DECISION_SUBDIVIDE_EMITTER;
}
