/* power.c - the oracle power as a good engineer writes it: what is known of a pair stands in
 * locals, and rays come in a loop, 1, 4, 16, 64, until more would change nothing that matters.
 *
 * It casts the rays, cuts the polygons and looks into the shafts that all releases do, by the
 * functions of kernel/, terms/ and tools/ that take elements and know of no discussion: so what it
 * differs by is the graph alone. Questions, thresholds and what is kept are its own.
 * SPDX-License-Identifier: MIT */
#include "hand.h"
#include "kernel/constants.h"
#include "kernel/outline_visibility.h"
#include "kernel/plane_side.h"
#include "kernel/point_factor.h"
#include "kernel/point_intensity.h"
#include "kernel/polygon_factor.h"
#include "kernel/surface_point.h"
#include "kernel/wider.h"
#include "terms/blockers.h"
#include "terms/visibility.h"
#include "tools/cluster_visibility.h"
#include "tools/light_visibility.h"

struct parameters {
    double energy, bend, balance, shadow, noise, hidden, spot, uneven, product, larger, min_share;
    int near;
};

enum { RECEIVER, EMITTER, NEITHER, BALANCED };
enum sight { CLEAR, BLOCKED, LISTED, CROWDED };
enum { GO_ON = -1 }; /* no decision yet */

/* A pair, and what is known of it so far. */
struct pair {
    const struct element *r, *s;
    const struct host *host;
    double axis[3], square; /* between the centres (m), and its length's square */
    double factor, seen;    /* F and V */
    enum visibility_level seen_level;
    int factor_level, mark;
    struct blockers *list, own;
};

static void start(struct pair *p, const struct discussion *d)
{
    p->r = d->receiver;
    p->s = d->emitter;
    p->host = d->host;
    sub3(p->axis, p->s->centre, p->r->centre);
    p->square = dot3(p->axis, p->axis);
    p->factor = d->terms.form_factor;
    p->factor_level = d->terms.form_factor_level;
    p->seen = d->terms.visibility;
    p->seen_level = (enum visibility_level)d->terms.visibility_level;
    p->mark = 0;
    p->own.known = BLOCKERS_UNKNOWN;
    p->list = d->blockers ? d->blockers : &p->own;
}

/* What the other way round of a pair that is linked, or given up, starts from. */
static enum decision hand_over(const struct pair *p, struct discussion *d, int decision)
{
    d->terms.visibility = p->seen;
    d->terms.visibility_level = (unsigned char)p->seen_level;
    return (enum decision)decision;
}

/* A share of all light, half of it counted as it falls and half as it is reflected, as irradiance
 * on this receiver over the mean. */
static double here(const struct pair *p, double share)
{
    return share
           / (0.5 * p->r->area * (1 + p->r->reflectance / p->host->mean_reflectance)
              / p->host->area);
}

/* The standard deviation of V. */
static double noise(const struct pair *p)
{
    if (p->seen_level == VISIBILITY_EXACT)
        return 0;
    double rays = visibility_rays_of(p->seen_level);
    return p->seen <= 0 || p->seen >= 1 ? 1 / rays : sqrt(p->seen * (1 - p->seen) / rays);
}

/* How far the mean of V B may be from V times the mean of B (W/m2). */
static double uneven(const struct pair *p)
{
    const struct element *s = p->s;
    double share = p->seen < 0.5 ? p->seen : 1 - p->seen;
    if (p->seen_level != VISIBILITY_EXACT)
        share += 1.0 / visibility_rays_of(p->seen_level);
    else if (share <= 0)
        return 0;
    return share * s->spread < s->deviation ? share * s->spread : s->deviation;
}

/* ---- surfaces */

static double exact_factor(struct pair *p)
{
    if (p->factor_level < FORM_FACTOR_POLYGON) {
        p->factor = polygon_factor(p->r, p->s, 0);
        p->factor_level = FORM_FACTOR_POLYGON;
    }
    return p->factor;
}

/* F as good as refinement needs it: the emitter as a disc, unless the two are near. */
static double factor(struct pair *p)
{
    const struct element *r = p->r, *s = p->s;
    if (p->factor_level >= FORM_FACTOR_DISC)
        return p->factor;
    double reach = r->radius + s->radius;
    if (p->square < reach * reach)
        return exact_factor(p);
    double a = dot3(r->normal, p->axis), b = -dot3(s->normal, p->axis);
    p->factor_level = FORM_FACTOR_DISC;
    p->factor = a > 0 && b > 0
                    ? a * b * s->area / (p->square * (3.14159265358979323846 * p->square + s->area))
                    : 0;
    return p->factor;
}

static void cast(struct pair *p, int rays, int near)
{
    enum visibility_level level = visibility_level_of(rays);
    if (p->seen_level < level) {
        p->seen = visibility_rays(p->r, p->s, p->host, rays, near);
        p->seen_level = level;
    }
}

/* Rays that end where the emitter's light comes from. */
static void cast_at_light(struct pair *p, int rays, int near)
{
    p->seen = light_visibility_rays(p->r, p->s, p->host, rays, near);
    p->seen_level = visibility_level_of(rays);
}

/* What the faces that may stand between leave of the light. */
static enum sight look_between(struct pair *p)
{
    int sure = p->seen_level == VISIBILITY_EXACT && (p->seen <= 0 || p->seen >= 1);
    if (sure) {
        p->list->wanted = 1; /* by pairs below */
    } else {
        blockers_find(p->r, p->s, p->host, p->list);
        if (p->list->count > BLOCKERS_MAX)
            return CROWDED;
        if (p->list->count > 0 && !p->list->covered)
            return LISTED;
        p->seen = p->list->covered ? 0 : 1;
        p->seen_level = VISIBILITY_EXACT;
    }
    return p->seen > 0 ? CLEAR : BLOCKED;
}

/* As good as 64 rays: outlines, where there is a list of what is in the way. */
static void look_closely(struct pair *p, enum sight between)
{
    if (between == LISTED && p->seen_level < VISIBILITY_RAYS_64) {
        p->seen = outline_visibility(p->r, p->s, p->host, p->list);
        p->seen_level = VISIBILITY_RAYS_64;
    } else {
        cast(p, 64, 0);
    }
}

/* What F over the receiver has beside its best linear function: twist and bulge of its corners and
 * centre, and what these miss of its mean. */
static double bend(const struct pair *p)
{
    const struct element *r = p->r, *s = p->s;
    struct polygon q;
    point_factor_clip(&q, r, s);
    double middle = point_factor_at(r->centre, r, s, &q), corner[4], mean = 0;
    for (int i = 0; i < r->vertices; i++) {
        double x[3];
        surface_corner(x, r, i);
        corner[i] = point_factor_at(x, r, s, &q);
        mean += corner[i] / r->vertices;
    }
    double most = (2 / 3.0) * fabs(middle - mean);
    double missed = fabs(p->factor - (2 / 3.0) * middle - (1 / 3.0) * mean);
    most = missed > most ? missed : most;
    if (r->vertices < 4)
        return most;
    double twist = 0.25 * fabs(corner[0] - corner[1] + corner[2] - corner[3]);
    return twist > most ? twist : most;
}

/* Over which of the two is the light not linear, by more than `limit` (W/m2)? */
static int curved(struct pair *p, double limit, double balance)
{
    const struct element *s = p->s;
    double v = p->seen_level > VISIBILITY_ABSENT ? p->seen : 1, size = s->radius * s->radius;
    double by_s = v * exact_factor(p) * s->deviation * (size < p->square ? size / p->square : 1);
    double by_r = s->radiosity > limit ? v * s->radiosity * bend(p) : 0;
    if (!(by_r > limit) && !(by_s > limit))
        return NEITHER;
    if (by_r > limit && by_r >= by_s && balance * (double)p->r->bend > limit)
        return RECEIVER;
    return by_s > limit ? EMITTER : BALANCED;
}

/* Split the one of the two, or the other where that may not be; or mark the pair. */
static int split(struct pair *p, double min_share, int first)
{
    double least = 4 * (min_share * p->host->area);
    int r = p->r->area >= least && p->r->depth < 24, s = p->s->area >= least && p->s->depth < 24;
    if (r && (!s || first == RECEIVER))
        return DECISION_SUBDIVIDE_RECEIVER;
    if (s)
        return DECISION_SUBDIVIDE_EMITTER;
    p->mark = 1;
    return GO_ON;
}

static int larger(const struct pair *p)
{
    const struct element *r = p->r, *s = p->s;
    return r->area > s->area || (r->area == s->area && r->id <= s->id) ? RECEIVER : EMITTER;
}

/* Where light may be hidden with the emitter's bright part: `limit` in W/m2. */
static int spotted(struct pair *p, const struct parameters *by, double spot, double limit)
{
    double mean = p->host->irradiance, most = uneven(p), f = p->factor;
    if (!(most * f > spot * mean))
        return DECISION_LINK;
    if (most * f > by->uneven * spot * mean) {
        int decision = split(p, by->min_share, EMITTER);
        if (decision != GO_ON)
            return decision;
    }
    cast_at_light(p, 4, by->near);
    if (p->s->radiosity * f * noise(p) > limit)
        cast_at_light(p, 16, by->near);
    return p->seen <= 0 ? DECISION_STOP : DECISION_LINK;
}

/* Is the pair seen well enough? `brought` (W/m2): B F. */
static int seen(struct pair *p, const struct parameters *by, double brought)
{
    double mean = p->host->irradiance, noise_here = here(p, by->noise);
    double limit = noise_here * mean, lost = by->hidden * noise_here * mean;
    double half = here(p, by->shadow) * mean;
    enum sight between = CROWDED;
    for (int rays = 4;; rays *= 4) {
        int last = rays == 64;
        if (last)
            look_closely(p, between);
        else
            cast(p, rays, by->near);
        int partial = p->seen > 0 && p->seen < 1;
        if (p->seen <= 0) {
            if (last || !(brought * noise(p) > lost))
                return DECISION_STOP;
        } else if (partial && brought > half) {
            int decision = split(p, by->min_share, larger(p));
            if (decision != GO_ON)
                return decision;
            break;
        } else if (last || !(brought * noise(p) > limit)) {
            break;
        }
        if (!partial || rays == 16) {
            between = look_between(p);
            if (between == CLEAR)
                return DECISION_LINK;
            if (between == BLOCKED)
                return DECISION_STOP;
        }
    }
    return spotted(p, by, here(p, by->spot), limit);
}

static enum decision link_surfaces(struct pair *p, struct discussion *d)
{
    d->terms.form_factor = exact_factor(p);
    d->terms.form_factor_level = (unsigned char)p->factor_level;
    if (p->mark) {
        d->terms.mark = 1;
        d->terms.mark_level = MARK_PRESENT;
    }
    return hand_over(p, d, DECISION_LINK);
}

/* Where nothing that is wrong would matter. */
static enum decision looked_at_once(struct pair *p, const struct parameters *by,
                                    struct discussion *d, int listed)
{
    if (listed)
        (void)look_between(p);
    cast(p, 1, by->near);
    return p->seen > 0 ? link_surfaces(p, d) : hand_over(p, d, DECISION_STOP);
}

static enum decision surfaces(const struct parameters *by, struct discussion *d)
{
    const struct element *r = d->receiver, *s = d->emitter;
    double flat = plane_side_flat(r, s, d->host), low_r, high_r;
    plane_side_heights(r, s, &low_r, &high_r);
    if (high_r <= flat)
        return DECISION_STOP;
    double low_s, high_s;
    plane_side_heights(s, r, &low_s, &high_s);
    if (high_s <= flat)
        return DECISION_STOP;

    struct pair p;
    start(&p, d);
    int listed = p.list->known != BLOCKERS_UNKNOWN || p.seen_level == VISIBILITY_EXACT;
    double mean = d->host->irradiance, dim = here(&p, by->spot) * mean;
    int cut = low_r < -flat || low_s < -flat;
    if (cut
        && (point_intensity(s, s->radiosity) > dim * p.square || s->radiosity * factor(&p) > dim))
        (void)exact_factor(&p);
    if (!(s->radiosity * factor(&p) > dim))
        return looked_at_once(&p, by, d, listed && !cut && r->depth + s->depth > 0);
    if (!cut && (listed || (r->depth == 0 && s->depth == 0)) && look_between(&p) == BLOCKED)
        return hand_over(&p, d, DECISION_STOP);

    double brought = s->radiosity * factor(&p);
    int decision;
    if (brought > here(&p, by->energy) * mean) {
        int worse = curved(&p, here(&p, by->bend) * mean, by->balance);
        if (worse == BALANCED) {
            enum sight between = look_between(&p);
            if (between == CLEAR)
                return link_surfaces(&p, d);
            if (between == BLOCKED)
                return hand_over(&p, d, DECISION_STOP);
            worse = RECEIVER;
        }
        if (worse != NEITHER) {
            decision = split(&p, by->min_share, worse);
            if (decision != GO_ON)
                return (enum decision)decision;
        }
        brought = s->radiosity * p.factor;
    }
    decision = seen(&p, by, brought);
    return decision == DECISION_LINK ? link_surfaces(&p, d) : hand_over(&p, d, decision);
}

/* ---- groups */

/* Open the one with the larger sphere; a surface only where it is much the larger. */
static enum decision opened(const struct pair *p, const struct parameters *by)
{
    const struct element *r = p->r, *s = p->s, *surface = s->vertices ? s : r;
    int whole = wider(r, s);
    if (surface->vertices) {
        const struct element *group = surface == s ? r : s;
        int cut = surface->radius > by->larger * group->radius
                  && surface->area >= 4 * by->min_share * p->host->area && surface->depth < 24;
        whole = cut == (surface == r);
    }
    return whole ? DECISION_SUBDIVIDE_RECEIVER : DECISION_SUBDIVIDE_EMITTER;
}

static void cast_at_group(struct pair *p, int rays)
{
    enum visibility_level level = visibility_level_of(rays);
    if (p->seen_level < level) {
        p->seen = cluster_rays(p->r, p->s, p->host, rays);
        p->seen_level = level;
    }
}

static enum decision groups(const struct parameters *by, struct discussion *d)
{
    struct pair p;
    start(&p, d);
    const struct element *r = p.r, *s = p.s;
    double mean = d->host->irradiance, reach = r->radius + s->radius;
    double sent = point_intensity(s, s->radiosity); /* W/sr */
    if (!(p.square > reach * reach)
        || sent * SEPARABLE_ERROR * r->radius * s->radius
               > here(&p, by->product) * mean * p.square * p.square)
        return opened(&p, by);

    if (!(sent > here(&p, by->spot) * mean * p.square)) {
        cast_at_group(&p, 1);
        return hand_over(&p, d, p.seen > 0 ? DECISION_LINK_CLUSTERS : DECISION_STOP);
    }
    double noise_here = here(&p, by->noise);
    double limit = noise_here * mean * p.square, lost = by->hidden * noise_here * mean * p.square;
    double half = here(&p, by->shadow) * mean * p.square;
    for (int rays = 4;; rays *= 4) {
        cast_at_group(&p, rays);
        if (p.seen <= 0) {
            if (rays == 64 || !(sent * noise(&p) > lost))
                return hand_over(&p, d, DECISION_STOP);
        } else if (p.seen < 1 && sent > half) {
            return opened(&p, by);
        } else if (rays == 64 || !(sent * noise(&p) > limit)) {
            break;
        }
    }
    if (point_intensity(s, uneven(&p)) > here(&p, 0.5 * by->uneven * by->spot) * mean * p.square)
        return opened(&p, by);
    return hand_over(&p, d, DECISION_LINK_CLUSTERS);
}

static enum decision refine(const void *state, struct discussion *d)
{
    const struct parameters *by = state;
    if (d->emitter->black)
        return DECISION_STOP;
    if (d->receiver->vertices && d->emitter->vertices)
        return surfaces(by, d);
    return hand_apart(d->receiver, d->emitter, d->host) ? DECISION_STOP : groups(by, d);
}

static void defaults(void *at)
{
    *(struct parameters *)at = (struct parameters){.energy = 2e-5,
                                                   .bend = 5e-6,
                                                   .balance = 16,
                                                   .shadow = 3e-5,
                                                   .noise = 8e-6,
                                                   .hidden = 0.3,
                                                   .spot = 3e-7,
                                                   .uneven = 8,
                                                   .product = 5e-8,
                                                   .larger = 3,
                                                   .near = 64,
                                                   .min_share = 1e-7};
}

#define AT(name) 0, offsetof(struct parameters, name)
static const struct oracle_parameter table[] = {
    {"energy", "", "", 2e-5, 0, INFINITY, AT(energy), ROLE_LINK_THRESHOLD, 0},
    {"bend", "", "", 5e-6, 0, INFINITY, AT(bend), ROLE_LINK_THRESHOLD, 0},
    {"balance", "", "", 16, 1, 1e6, AT(balance), ROLE_NONE, 0},
    {"shadow", "", "", 3e-5, 0, INFINITY, AT(shadow), ROLE_LINK_THRESHOLD, 0},
    {"noise", "", "", 8e-6, 0, INFINITY, AT(noise), ROLE_LINK_THRESHOLD, 0},
    {"hidden", "", "", 0.3, 0, 1, AT(hidden), ROLE_NONE, 0},
    {"spot", "", "", 3e-7, 0, INFINITY, AT(spot), ROLE_LINK_THRESHOLD, 0},
    {"uneven", "", "", 8, 1, INFINITY, AT(uneven), ROLE_NONE, 0},
    {"product", "", "", 5e-8, 0, INFINITY, AT(product), ROLE_LINK_THRESHOLD, 0},
    {"larger", "", "", 3, 0, INFINITY, AT(larger), ROLE_NONE, 0},
    {"near", "", "", 64, 0, 64, 1, offsetof(struct parameters, near), ROLE_NONE, 0},
    {"min_share", "", "", 1e-7, 0, 1, AT(min_share), ROLE_SMALLEST_PART, 0},
};

static const int reads[] = {FACT_RECEIVER_BEND};

const struct oracle hand_power = {RUNTIME_ABI,
                                  "power",
                                  "written by hand",
                                  "",
                                  table,
                                  sizeof table / sizeof *table,
                                  sizeof(struct parameters),
                                  defaults,
                                  refine,
                                  reads,
                                  sizeof reads / sizeof *reads,
                                  NULL};
