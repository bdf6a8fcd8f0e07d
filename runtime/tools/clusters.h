/* clusters.h - question: are both elements surfaces, and if not, which cluster is to be opened?
 *
 * apart is true only when no normal of the one, taken anywhere in its normal cone, makes an acute
 * angle with any direction from its box to the other's. For a normal at angle theta from the cone's
 * axis a, and v from one box to the other with a.v <= m, |v| <= l:  n.v <= m cos(theta) + sqrt(l^2
 * - m^2) sin(theta). A surface is a cone of angle 0 and a box of its own. [D: derived here]
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_CLUSTERS_H
#define TOOL_CLUSTERS_H

#include "discussion.h"
#include "kernel/wider.h"

/* Does all of `e` face away from all of `other`? `v` leads from e's centre to the other's. */
static inline int clusters_turned(const struct element *e, const struct element *other,
                                  const double v[3], double longest, double flat)
{
    const double *a = e->normal;
    if (e->cone <= 0)
        return 0;
    double m = dot3(a, v);
    for (int i = 0; i < 2; i++) {
        const struct element *b = i ? other : e;
        if (b->vertices) {
            if (b == other)
                m += b->radius;
        } else {
            for (int k = 0; k < 3; k++)
                m += 0.5 * fabs(a[k]) * (b->vertex[1][k] - b->vertex[0][k]);
        }
    }
    if (m > flat)
        return 0;
    double across = longest * longest - m * m;
    double sine = 1 - e->cone * e->cone;
    return m * e->cone + (across > 0 && sine > 0 ? sqrt(across * sine) : 0) <= flat;
}

TOOL enum clusters_answer tool_clusters(struct discussion *d)
{
    const struct element *r = d->receiver, *s = d->emitter;
    double v[3];
    if (r->vertices && s->vertices)
        return CLUSTERS_SURFACES;
    sub3(v, s->centre, r->centre);
    double longest = length3(v) + r->radius + s->radius;
    const double flat = d->host->flat; /* no more: plates with a narrow gap exchange light */
    if (clusters_turned(r, s, v, longest, flat))
        return CLUSTERS_APART;
    v[0] = -v[0];
    v[1] = -v[1];
    v[2] = -v[2];
    if (clusters_turned(s, r, v, longest, flat))
        return CLUSTERS_APART;
    if (r->vertices || s->vertices)
        return s->vertices ? CLUSTERS_RECEIVER : CLUSTERS_EMITTER;
    return wider(r, s) ? CLUSTERS_RECEIVER : CLUSTERS_EMITTER;
}

#endif
