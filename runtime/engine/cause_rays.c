/* cause_rays.c - see cause_rays.h.
 *
 * Bright spots, wherever they are, are looked for by points on them, too: a face is chosen by its
 * power and place (light_tree.h), as if it emitted what it radiates. What either ray finds counts
 * by the balance heuristic (paths.h).
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>
#include "engine/cause_rays.h"
#include "kernel/lambert.h"
#include "kernel/leaf_at.h"
#include "kernel/surface_point.h"
#include "particles/paths.h"
#include "visibility/contact_fraction.h"

static void add(const struct cause_receiver *at, int cause, uint32_t band, double difference)
{
    *at->to[cause][band] += at->weight * difference;
    *at->after[cause] += at->weight * at->growth[band] * difference;
}

/* What a link sends, mean over its emitter as it sees it. */
static double mean_sent(const struct cause_rays *c, const struct covering *by, uint32_t band)
{
    const struct separable_links *groups = &c->solve->operator.separable;
    uint32_t bands = c->tracer.bands;
    if (by->link)
        return c->solve->state.radiosity[(size_t)by->link->emitter * bands + band];
    double one = (double)c->of_one[by->group];
    return one > 0 ? (double)groups->arrives[by->group * bands + band] / one : 0;
}

/* A ray finds light at point y of a face, and counts as `share` of one. */
static void add_arrival(const struct cause_rays *c, const struct link_cover *cover,
                        const struct cause_receiver *at, uint32_t face, const double y[3],
                        double share)
{
    static const struct {
        int bright, visibility;
    } causes[RAD_WAYS] = {[RAD_WAY_OPEN] = {RAD_CAUSE_OPEN_BRIGHT, RAD_CAUSE_OPEN_VISIBILITY},
                          [RAD_WAY_HALF] = {RAD_CAUSE_HALF_BRIGHT, RAD_CAUSE_HALF_VISIBILITY},
                          [RAD_WAY_GROUPS] = {RAD_CAUSE_GROUPS_BRIGHT, RAD_CAUSE_GROUPS_REST}};
    const struct hierarchy *h = &c->solve->hierarchy;
    double unused[4];
    uint32_t emitter = leaf_at(h->elements, h->face_element[face], y, unused);
    const double *B = &c->solve->state.radiosity[(size_t)emitter * c->tracer.bands];
    struct covering by = link_cover_find(cover, emitter);
    for (uint32_t k = 0; k < c->tracer.bands; k++) {
        double rho = share * at->reflectance[k];
        add(at, CAUSE_ALL, k, -rho * B[k]);
        if (!(at->uncovered > 0)) {
            add(at, RAD_CAUSE_CONTACT, k, -rho * B[k]);
            continue;
        }
        at->found[by.way] += at->weight * rho * B[k];
        if (by.way == RAD_WAY_NONE) {
            add(at, RAD_CAUSE_LOST, k, -rho * B[k]);
            continue;
        }
        double mean = mean_sent(c, &by, k);
        add(at, causes[by.way].bright, k, rho * (mean - B[k]));
        add(at, causes[by.way].visibility, k, -rho * mean);
    }
}

/* The share of light from y of an emitter, found from p, by a ray of either kind; chance: that the
 * emitter is chosen (paths.c). */
static double share_of(const struct tracer *t, uint32_t face, const double p[3],
                       const struct element *emitter, const double y[3], double chance)
{
    static const struct path_rays each = {1, 1};
    double by_cosine = tracer_density(t, face, p, y, emitter->normal);
    return by_cosine > 0 ? path_share(&each, by_cosine, chance / emitter->area) : 0;
}

/* A ray from p to what shines. */
static void look_for_light(const struct cause_rays *c, const struct link_cover *cover,
                           const struct cause_receiver *at, const double p[3], const double u[3])
{
    const struct tracer *t = &c->tracer;
    const struct element *from = tracer_surface(t, at->face);
    uint32_t face;
    double chance = light_tree_choose(&t->light_tree, p, from->normal, u[0], &face);
    if (!(chance > 0))
        return;
    const struct element *emitter = tracer_surface(t, face);
    double above[3], y[3], way[3], distance;
    tracer_point(t, face, u[1], u[2], above);
    tracer_on_surface(t, face, above, y);
    double share = share_of(t, at->face, p, emitter, y, chance);
    sub3(way, y, p);
    /* not whether something is between: of two faces in one place the other kind of ray meets one
     */
    if (share > 0 && rays_meet(t->rays, p, way, &distance) == (int64_t)face)
        add_arrival(c, cover, at, face, y, share);
}

/* Set at->growth by a path from p, whose chance to go on is the strongest band's reflectance.
 * Returns its rays. */
static uint64_t follow_light(const struct tracer *t, struct cause_receiver *at, const double p[3],
                             struct dice *dice)
{
    double through[3] = {1, 1, 1}, x[3] = {p[0], p[1], p[2]};
    uint32_t face = at->face;
    memcpy(at->growth, through, sizeof through);
    for (uint64_t rays = 1;; rays++) {
        double u = dice_throw(dice), v = dice_throw(dice), strongest = 0, left = 0;
        int64_t met = tracer_step(t, face, x, u, v, NULL);
        if (met < 0)
            return rays;
        face = (uint32_t)met;
        for (uint32_t k = 0; k < t->bands; k++) {
            strongest = fmax(strongest, through[k]);
            through[k] *= t->reflectance[(size_t)face * t->bands + k];
            left = fmax(left, through[k]);
            at->growth[k] += through[k];
        }
        if (!(dice_throw(dice) * strongest < left))
            return rays;
        for (uint32_t k = 0; k < t->bands; k++)
            through[k] *= strongest / left;
    }
}

static double turn(double u)
{
    return u < 0.5 ? u + 0.5 : u - 0.5;
}

uint64_t cause_rays_cast(const struct cause_rays *c, const struct link_cover *cover,
                         struct cause_receiver *at, const double u[SOBOL_DIMENSIONS],
                         struct dice *dice)
{
    const struct tracer *t = &c->tracer;
    const struct element *leaf = &c->solve->hierarchy.elements[at->leaf];
    uint64_t rays = CAUSE_RAYS;
    double from[3], p[3], y[3];
    surface_even_point(from, leaf, u[0], u[1]);
    for (int d = 0; d < 3; d++)
        p[d] = from[d] += rays_host(t->rays)->ray_offset * leaf->normal[d];
    int64_t met = tracer_step(t, at->face, p, u[2], u[3], y);
    int covered = met < 0 && contact_covers(t->rays, leaf, from);
    double bare = covered ? 0 : 1;
    rays += covered ? 0 : follow_light(t, at, from, dice);
    for (uint32_t k = 0; k < t->bands; k++) {
        double known = at->uncovered > 0 ? at->uncovered : 0;
        add(at, CAUSE_ALL, k, bare * at->shown[k]);
        add(at, RAD_CAUSE_CONTACT, k, (bare - known) * at->shown[k]);
    }
    if (covered)
        return rays;
    if (met >= 0) {
        uint32_t face = (uint32_t)met;
        double chance = light_tree_chance(&t->light_tree, from, leaf->normal, face);
        double share =
            chance > 0 ? share_of(t, at->face, from, tracer_surface(t, face), y, chance) : 1;
        add_arrival(c, cover, at, face, y, share);
    }
    /* Of a Sobol' sequence with the place, too; that it goes with the direction does no harm: each
     * of the two rays is spread evenly by itself. */
    const double v[3] = {u[4], turn(u[2]), turn(u[3])};
    look_for_light(c, cover, at, from, v);
    return rays;
}
