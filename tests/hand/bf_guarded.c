/* bf_guarded.c - the oracle bf_guarded as a good engineer writes it.
 * SPDX-License-Identifier: MIT */
#include "hand.h"

struct parameters {
    double epsilon, relative, shadow, faint, min_area, min_share;
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
static double estimate(const struct element *r, const struct element *s, int *known)
{
    double reach = r->radius + s->radius;
    double x = s->centre[0] - r->centre[0], y = s->centre[1] - r->centre[1],
           z = s->centre[2] - r->centre[2];
    double q = x * x + y * y + z * z;
    if (q < reach * reach) {
        *known = FORM_FACTOR_POLYGON;
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
    int known = d->terms.form_factor_level;

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
    int r_crosses = low_r < -flat;
    int s_crosses = low_s < -flat;
    int r_first = r->area > s->area || (r->area == s->area && r->id <= s->id);
    if (r_crosses && s_crosses)
        *(r_first ? &s_crosses : &r_crosses) = 0;
    if ((r_crosses || s_crosses) && known < FORM_FACTOR_POLYGON) {
        f = hand_form_factor(r, s);
        known = FORM_FACTOR_POLYGON;
    }

    if (s->black)
        return DECISION_STOP;
    double least = p->min_share * host->area;
    least = 4 * (least > p->min_area ? least : p->min_area);
    int split_r = r->area >= least && r->depth < 24, split_s = s->area >= least && s->depth < 24;

    double limit = p->relative * host->irradiance, half = p->shadow * host->irradiance;
    double faint = p->faint * host->irradiance, brought = s->radiosity;
    limit = p->epsilon > limit ? p->epsilon : limit;
    half = p->epsilon > half ? p->epsilon : half;
    if (brought > limit || brought > half || brought > faint) {
        if (known == FORM_FACTOR_ABSENT)
            f = estimate(r, s, &known);
        brought *= f;
    }
    if (brought > limit && (split_r || split_s)) {
        if (r_crosses || s_crosses)
            return (r_crosses ? split_r : !split_s) ? DECISION_SUBDIVIDE_RECEIVER
                                                    : DECISION_SUBDIVIDE_EMITTER;
        return split_r && (!split_s || r_first) ? DECISION_SUBDIVIDE_RECEIVER
                                                : DECISION_SUBDIVIDE_EMITTER;
    }
    int stuck = brought > limit;

    int bright = brought > faint;
    int level = !bright || p->rays <= 4 ? VISIBILITY_RAYS_4
                : p->rays <= 16         ? VISIBILITY_RAYS_16
                                        : VISIBILITY_RAYS_64;
    double v = d->terms.visibility;
    if (d->terms.visibility_level < level)
        v = hand_visibility(r, s, host,
                            level == VISIBILITY_RAYS_4    ? 4
                            : level == VISIBILITY_RAYS_16 ? 16
                                                          : 64);
    else
        level = d->terms.visibility_level;
    int doubtful = v <= 0;
    if (doubtful && bright && brought > half && level < VISIBILITY_RAYS_64) {
        v = hand_visibility(r, s, host, 64);
        level = VISIBILITY_RAYS_64;
    }
    d->terms.visibility = v;
    d->terms.visibility_level = (unsigned char)level;
    if (doubtful) {
        if (!bright || brought <= half || v <= 0)
            return DECISION_STOP;
    }
    if (bright && (doubtful || v < 1) && brought > half) {
        if (split_r || split_s)
            return split_r && (!split_s || r_first) ? DECISION_SUBDIVIDE_RECEIVER
                                                    : DECISION_SUBDIVIDE_EMITTER;
        stuck = 1;
    }

    if (stuck) {
        d->terms.mark = 1;
        d->terms.mark_level = MARK_PRESENT;
    }
    d->terms.form_factor = known == FORM_FACTOR_POLYGON ? f : hand_form_factor(r, s);
    d->terms.form_factor_level = FORM_FACTOR_POLYGON;
    return DECISION_LINK;
}

static void defaults(void *at)
{
    *(struct parameters *)at = (struct parameters){
        .relative = 0.05, .shadow = 0.005, .faint = 2e-4, .min_share = 2e-5, .rays = 16};
}

static const struct oracle_parameter table[] = {
    {"epsilon", "W/m2", "", 0, 0, INFINITY, 0, offsetof(struct parameters, epsilon), ROLE_NONE, 0},
    {"relative", "", "", 0.05, 0, INFINITY, 0, offsetof(struct parameters, relative), ROLE_NONE, 0},
    {"shadow", "", "", 0.005, 0, INFINITY, 0, offsetof(struct parameters, shadow), ROLE_NONE, 0},
    {"faint", "", "", 2e-4, 0, INFINITY, 0, offsetof(struct parameters, faint), ROLE_NONE, 0},
    {"min_area", "m2", "", 0, 0, INFINITY, 0, offsetof(struct parameters, min_area), ROLE_NONE, 0},
    {"min_share", "", "", 2e-5, 0, 1, 0, offsetof(struct parameters, min_share), ROLE_NONE, 0},
    {"rays", "", "", 16, 4, 64, 1, offsetof(struct parameters, rays), ROLE_NONE, 0},
};

const struct oracle hand_bf_guarded = {RUNTIME_ABI,
                                       "bf_guarded",
                                       "written by hand",
                                       "",
                                       table,
                                       7,
                                       sizeof(struct parameters),
                                       defaults,
                                       refine,
                                       NULL,
                                       0,
                                       NULL};
