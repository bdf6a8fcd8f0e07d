/* tracer.c - see tracer.h.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "kernel/constants.h"
#include "kernel/hemisphere.h"
#include "kernel/lambert.h"
#include "kernel/surface_point.h"
#include "particles/running_sums.h"
#include "particles/tracer.h"

int tracer_open(struct tracer *t)
{
    struct lights *l = &t->lights;
    uint32_t count = 0, faces = t->hierarchy->face_count;
    *l = (struct lights){0};
    t->light_tree = (struct light_tree){0};
    sobol_sequence_open(&t->sobol);
    for (uint32_t pass = 0; pass < 2; pass++) {
        for (uint32_t i = 0; i < faces; i++) {
            double power = 0;
            for (uint32_t k = 0; k < t->bands; k++)
                power += tracer_surface(t, i)->area * t->exitance[(size_t)i * t->bands + k];
            if (!(power > 0))
                continue;
            if (pass == 0) {
                count++;
                continue;
            }
            l->face[l->count] = i;
            l->until[l->count++] = l->power += power;
        }
        if (pass == 0) {
            l->face = malloc((count + 1) * sizeof *l->face);
            l->until = malloc((count + 1) * sizeof *l->until);
            if (!l->face || !l->until) {
                tracer_close(t);
                return -1;
            }
        }
    }
    if (light_tree_open(&t->light_tree, t->hierarchy, t->exitance, t->bands) == 0)
        return 0;
    tracer_close(t);
    return -1;
}

void tracer_close(struct tracer *t)
{
    light_tree_close(&t->light_tree);
    free(t->lights.face);
    free(t->lights.until);
    t->lights = (struct lights){0};
}

double tracer_reflectance(const struct tracer *t, uint32_t face)
{
    double most = 0;
    const int dark = t->hierarchy->faces[face].light == FACE_DARK;
    for (uint32_t k = 0; k < t->bands && !dark; k++)
        most = fmax(most, t->reflectance[(size_t)face * t->bands + k]);
    return most;
}

uint32_t lights_choose(const struct lights *l, double u)
{
    return l->face[running_sums_find(l->until, l->count, u * l->power)];
}

static void move_off(const struct tracer *t, const struct element *e, double p[3])
{
    double offset = rays_host(t->rays)->ray_offset;
    for (int k = 0; k < 3; k++)
        p[k] += offset * e->normal[k];
}

void tracer_point(const struct tracer *t, uint32_t face, double u, double v, double p[3])
{
    const struct element *e = tracer_surface(t, face);
    surface_even_point(p, e, u, v);
    move_off(t, e, p);
}

/* Are two points near its plane within the surface, farther than that from its border? */
static int lie_within(const struct element *e, const double p[3], const double q[3], double border)
{
    for (uint32_t i = 0; i < e->vertices; i++) {
        const double *from = e->vertex[i], *to = e->vertex[(i + 1) % e->vertices];
        double side[3], to_p[3], to_q[3], inward[3];
        sub3(side, to, from);
        sub3(to_p, p, from);
        sub3(to_q, q, from);
        cross3(inward, e->normal, side);
        const double least = border * length3(inward);
        if (!(dot3(inward, to_p) > least && dot3(inward, to_q) > least))
            return 0;
    }
    return 1;
}

/* A ray that leaves straight above its point meets what is near as if it were nearer still, by the
 * offset: between a strip of lamps and a wall a millimetre away, in a hall of twenty metres, a
 * thirteenth of the gap is missing. So it starts farther on, where the ray from the surface itself
 * is off by as much; but not beyond the surface's border, nor where something stands on it that the
 * ray might start behind. */
static void slide_along(const struct tracer *t, uint32_t face, double p[3],
                        const double direction[3], double cosine)
{
    const struct element *e = tracer_surface(t, face);
    const double offset = rays_host(t->rays)->ray_offset, reach = offset / cosine;
    double q[3];
    if (!(cosine > SLIDE_LEAST) || rays_stood_on(t->rays, face))
        return;
    for (int k = 0; k < 3; k++)
        q[k] = p[k] + reach * (direction[k] - cosine * e->normal[k]);
    if (lie_within(e, p, q, offset))
        memcpy(p, q, sizeof q);
}

void tracer_on_surface(const struct tracer *t, uint32_t face, const double p[3], double on[3])
{
    const struct element *e = tracer_surface(t, face);
    for (int k = 0; k < 3; k++)
        on[k] = p[k] - rays_host(t->rays)->ray_offset * e->normal[k];
}

double tracer_density(const struct tracer *t, uint32_t face, const double p[3], const double y[3],
                      const double normal[3])
{
    double on[3];
    tracer_on_surface(t, face, p, on);
    return lambert_points(on, tracer_surface(t, face)->normal, y, normal, 0);
}

int64_t tracer_step(const struct tracer *t, uint32_t face, double p[3], double u, double v,
                    double at[3])
{
    const struct hemisphere above = hemisphere_over(tracer_surface(t, face)->normal);
    double angle = 2 * LAMBERT_PI * u, r = sqrt(v), z = sqrt(1 - v), direction[3], distance;
    for (int k = 0; k < 3; k++)
        direction[k] = z * above.n[k] + r * (cos(angle) * above.u[k] + sin(angle) * above.v[k]);
    slide_along(t, face, p, direction, z);
    int64_t met = rays_meet(t->rays, p, direction, &distance);
    if (met < 0)
        return met;
    const struct element *e = tracer_surface(t, (uint32_t)met);
    ray_land(p, direction, distance, e);
    if (at)
        memcpy(at, p, 3 * sizeof *at);
    move_off(t, e, p);
    return met;
}
