/* paths.c - see paths.h.
 *
 * Of the point y of an emitter, c = cos cos / (pi d^2) is how densely directions by the cosine
 * find it, per area, and d = E / P how densely points by power do; E its exitance, P the power of
 * all, summed over bands. With n_c and n_l rays of either kind, each counts what it finds as
 * E c / (n_c c + n_l d), by whichever it was found.
 * SPDX-License-Identifier: MIT */
#include "kernel/lambert.h"
#include "particles/paths.h"

static void add_exitance(const struct tracer *t, uint32_t emitter, double by_cosine,
                         const struct path_rays *rays, double *h)
{
    const double *exitance = &t->exitance[(size_t)emitter * t->bands];
    double whole = 0;
    for (uint32_t k = 0; k < t->bands; k++)
        whole += exitance[k];
    if (!(whole > 0 && by_cosine > 0))
        return;
    double by_light = rays->light > 0 ? rays->light * whole / t->lights.power : 0,
           share = by_cosine / (rays->cosine * by_cosine + by_light);
    for (uint32_t k = 0; k < t->bands; k++)
        h[k] += share * exitance[k];
}

int path_to_light(const struct tracer *t, uint32_t face, const double p[3], const double u[3],
                  const struct path_rays *rays, double *h)
{
    uint32_t emitter = lights_choose(&t->lights, u[0]);
    const double *n = tracer_surface(t, face)->normal, *m = tracer_surface(t, emitter)->normal,
                 offset = rays_host(t->rays)->ray_offset;
    double q[3], y[3], way[3];
    tracer_point(t, emitter, u[1], u[2], q);
    for (int k = 0; k < 3; k++)
        y[k] = q[k] - offset * m[k]; /* where directions meet it */
    double by_cosine = lambert_points(p, n, y, m, 0);
    if (!(by_cosine > 0))
        return 0;
    sub3(way, q, p);
    if (!rays_blocked(t->rays, p, way))
        add_exitance(t, emitter, by_cosine, rays, h);
    return 1;
}

int64_t path_onward(const struct tracer *t, uint32_t face, double p[3], double u, double v,
                    const struct path_rays *rays, double *h, double at[3])
{
    const double from[3] = {p[0], p[1], p[2]};
    int64_t met = tracer_step(t, face, p, u, v, at);
    if (met >= 0)
        add_exitance(t, (uint32_t)met,
                     lambert_points(from, tracer_surface(t, face)->normal, at,
                                    tracer_surface(t, (uint32_t)met)->normal, 0),
                     rays, h);
    return met;
}

void path_irradiance(const struct tracer *t, uint32_t face, const double p[3], struct dice *dice,
                     double *h, uint64_t *rays)
{
    const struct path_rays each = {1, 1};
    double through[3] = {1, 1, 1}, x[3] = {p[0], p[1], p[2]}, at[3];
    for (uint32_t k = 0; k < t->bands; k++)
        h[k] = 0;
    while (t->lights.count > 0) {
        double found[3] = {0, 0, 0}, u[5], strongest = 0, left = 0;
        for (int d = 0; d < 5; d++)
            u[d] = dice_throw(dice);
        *rays += 1 + (uint64_t)path_to_light(t, face, x, u, &each, found);
        int64_t met = path_onward(t, face, x, u[3], u[4], &each, found, at);
        for (uint32_t k = 0; k < t->bands; k++)
            h[k] += through[k] * found[k];
        if (met < 0)
            return;
        face = (uint32_t)met;
        for (uint32_t k = 0; k < t->bands; k++) {
            strongest = through[k] > strongest ? through[k] : strongest;
            through[k] *= t->reflectance[(size_t)face * t->bands + k];
            left = through[k] > left ? through[k] : left;
        }
        if (!(dice_throw(dice) * strongest < left))
            return;
        for (uint32_t k = 0; k < t->bands; k++)
            through[k] *= strongest / left;
    }
}
