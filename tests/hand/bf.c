/* bf.c - the oracle bf as a good engineer writes it: one function, top to bottom.
 * SPDX-License-Identifier: MIT */
#include "hand.h"

struct parameters {
    double epsilon, relative, min_area, min_share;
    int rays;
};

/* Lowest and highest signed distance of e's corners from the plane of `plane`. */
static void range(const struct element *e, const struct element *plane, double *low, double *high)
{
    const double *n = plane->normal, *c = plane->centre;
    *low = INFINITY;
    *high = -INFINITY;
    for (int i = 0; i < e->vertices; i++) {
        const double *v = e->vertex[i];
        double h = n[0] * (v[0] - c[0]) + n[1] * (v[1] - c[1]) + n[2] * (v[2] - c[2]);
        *low = h < *low ? h : *low;
        *high = h > *high ? h : *high;
    }
}

/* F_rs as good as refinement needs it: the emitter as a disc, seen from the receiver's centre,
 * unless the two are near. */
static double estimate(const struct element *r, const struct element *s, int *polygon)
{
    double reach = r->radius + s->radius;
    double x = s->centre[0] - r->centre[0], y = s->centre[1] - r->centre[1],
           z = s->centre[2] - r->centre[2];
    double q = x * x + y * y + z * z;
    if (q < reach * reach) {
        *polygon = 1;
        return hand_form_factor(r, s);
    }
    double a = r->normal[0] * x + r->normal[1] * y + r->normal[2] * z;
    double b = -(s->normal[0] * x + s->normal[1] * y + s->normal[2] * z);
    return a > 0 && b > 0 ? a * b * s->area / (q * (3.14159265358979323846 * q + s->area)) : 0;
}

static enum decision refine(const void *state, struct discussion *d)
{
    const struct parameters *p = state;
    const struct element *r = d->receiver, *s = d->emitter;
    const struct host *host = d->host;
    double f = d->terms.form_factor;
    int polygon = d->terms.form_factor_level == FORM_FACTOR_POLYGON;

    if (!r->vertices || !s->vertices)
        return hand_open_clusters(r, s, host);

    double flat = host->flat + (1 / 65536.0) * (r->radius + s->radius);
    double low_r, high_r;
    range(r, s, &low_r, &high_r);
    if (high_r <= flat)
        return DECISION_STOP;
    double low_s, high_s;
    range(s, r, &low_s, &high_s);
    if (high_s <= flat)
        return DECISION_STOP;
    int crosses = low_r < -flat || low_s < -flat;
    if (crosses && !polygon) {
        f = hand_form_factor(r, s);
        polygon = 1;
    }

    if (s->black)
        return DECISION_STOP;
    double limit = p->relative * host->irradiance;
    if (p->epsilon > limit)
        limit = p->epsilon;
    double brought = s->radiosity;
    if (brought > limit && !polygon)
        f = estimate(r, s, &polygon);
    if (brought > limit && brought * f > limit) {
        double least = p->min_share * host->area;
        least = 4 * (least > p->min_area ? least : p->min_area);
        int split_r = r->area >= least && r->depth < 24,
            split_s = s->area >= least && s->depth < 24;
        if (split_r && (!split_s || r->area > s->area || (r->area == s->area && r->id <= s->id)))
            return DECISION_SUBDIVIDE_RECEIVER;
        if (split_s)
            return DECISION_SUBDIVIDE_EMITTER;
        d->terms.mark = 1;
        d->terms.mark_level = MARK_PRESENT;
    }

    int level = p->rays <= 4    ? VISIBILITY_RAYS_4
                : p->rays <= 16 ? VISIBILITY_RAYS_16
                                : VISIBILITY_RAYS_64;
    if (d->terms.visibility_level < level) {
        d->terms.visibility = hand_visibility(r, s, host,
                                              level == VISIBILITY_RAYS_4    ? 4
                                              : level == VISIBILITY_RAYS_16 ? 16
                                                                            : 64);
        d->terms.visibility_level = (unsigned char)level;
    }
    if (d->terms.visibility <= 0)
        return DECISION_STOP;
    d->terms.form_factor = polygon ? f : hand_form_factor(r, s);
    d->terms.form_factor_level = FORM_FACTOR_POLYGON;
    return DECISION_LINK;
}

static void defaults(void *at)
{
    *(struct parameters *)at = (struct parameters){.relative = 0.05, .min_share = 2e-5, .rays = 16};
}

static const struct oracle_parameter table[] = {
    {"epsilon", "W/m2", "", 0, 0, INFINITY, 0, offsetof(struct parameters, epsilon), ROLE_NONE, 0},
    {"relative", "", "", 0.05, 0, INFINITY, 0, offsetof(struct parameters, relative), ROLE_NONE, 0},
    {"min_area", "m2", "", 0, 0, INFINITY, 0, offsetof(struct parameters, min_area), ROLE_NONE, 0},
    {"min_share", "", "", 2e-5, 0, 1, 0, offsetof(struct parameters, min_share), ROLE_NONE, 0},
    {"rays", "", "", 16, 4, 64, 1, offsetof(struct parameters, rays), ROLE_NONE, 0},
};

const struct oracle hand_bf = {RUNTIME_ABI,
                               "bf",
                               "written by hand",
                               "",
                               table,
                               5,
                               sizeof(struct parameters),
                               defaults,
                               refine,
                               NULL,
                               0,
                               NULL};
