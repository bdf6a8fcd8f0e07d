/* paths.c - see paths.h.
 *
 * Of the point y of an emitter, c = cos cos / (pi d^2) is how densely directions by the cosine
 * find it, per area, and d = q / A how densely points of emitters do; q the chance of the emitter
 * (light_tree.h), A its area. With n_c and n_l rays of either kind, each counts what it finds as
 * E c / (n_c c + n_l d), by whichever it was found.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "kernel/lambert.h"
#include "particles/paths.h"

/* by_cosine, by_light: c and d, per area (1/m2). */
static void add_exitance(const struct tracer *t, uint32_t emitter, double by_cosine,
                         double by_light, const struct path_rays *rays, double *h)
{
    double share = path_share(rays, by_cosine, by_light);
    for (uint32_t k = 0; k < t->bands; k++)
        h[k] += share * t->exitance[(size_t)emitter * t->bands + k];
}

int path_to_light(const struct tracer *t, uint32_t face, const double p[3], const double u[3],
                  const struct path_rays *rays, double *h)
{
    const double *n = tracer_surface(t, face)->normal;
    double q[3], y[3], way[3];
    uint32_t emitter;
    double chance = light_tree_choose(&t->light_tree, p, n, u[0], &emitter);
    if (!(chance > 0))
        return 0;
    const struct element *e = tracer_surface(t, emitter);
    tracer_point(t, emitter, u[1], u[2], q);
    tracer_on_surface(t, emitter, q, y);
    double by_cosine = tracer_density(t, face, p, y, e->normal);
    if (!(by_cosine > 0))
        return 0;
    sub3(way, q, p);
    if (!rays_blocked(t->rays, p, way))
        add_exitance(t, emitter, by_cosine, chance / e->area, rays, h);
    return 1;
}

int64_t path_onward(const struct tracer *t, uint32_t face, double p[3], double u, double v,
                    const struct path_rays *rays, double *h, double at[3])
{
    const double from[3] = {p[0], p[1], p[2]}, *n = tracer_surface(t, face)->normal;
    int64_t met = tracer_step(t, face, p, u, v, at);
    if (met < 0 || t->light_tree.place[met] == UINT32_MAX)
        return met;
    const struct element *e = tracer_surface(t, (uint32_t)met);
    double by_cosine = tracer_density(t, face, from, at, e->normal);
    if (by_cosine > 0)
        add_exitance(t, (uint32_t)met, by_cosine,
                     light_tree_chance(&t->light_tree, from, n, (uint32_t)met) / e->area, rays, h);
    return met;
}

int path_step(const struct tracer *t, struct path *p, struct dice *dice, double *h, uint64_t *rays)
{
    static const struct path_rays each = {1, 1};
    double found[3] = {0, 0, 0}, u[5];
    for (int i = 0; i < 5; i++)
        u[i] = dice_throw(dice);
    *rays += 1 + (uint64_t)path_to_light(t, p->face, p->x, u, &each, found);
    int64_t met = path_onward(t, p->face, p->x, u[3], u[4], &each, found, p->at);
    for (uint32_t k = 0; k < t->bands; k++)
        h[k] += p->through[k] * found[k];
    if (met < 0)
        return 0;
    p->face = (uint32_t)met;
    return 1;
}

int path_reflect(const struct tracer *t, struct path *p, struct dice *dice)
{
    double strongest = 0, left = 0;
    for (uint32_t k = 0; k < t->bands; k++) {
        strongest = fmax(strongest, p->through[k]);
        p->through[k] *= t->reflectance[(size_t)p->face * t->bands + k];
        left = fmax(left, p->through[k]);
    }
    if (!dice)
        return left > 0;
    if (!(dice_throw(dice) * strongest < left))
        return 0;
    for (uint32_t k = 0; k < t->bands; k++)
        p->through[k] *= strongest / left;
    return 1;
}

void path_irradiance(const struct tracer *t, uint32_t face, const double p[3], struct dice *dice,
                     double *h, uint64_t *rays)
{
    struct path path = path_from(face, p);
    for (uint32_t k = 0; k < t->bands; k++)
        h[k] = 0;
    while (t->light_tree.count > 0 && path_step(t, &path, dice, h, rays)
           && path_reflect(t, &path, dice))
        ;
}
