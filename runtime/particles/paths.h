/* paths.h - the irradiance at a point, by paths from it.
 *
 * Light straight from emitters is looked for in two ways, by points on them and by directions
 * spread by the cosine: the former finds small lamps far off, the latter large ones at hand.
 * What either finds counts by the balance heuristic, so that no lamp, however small or near, gives
 * a spike. [Veach and Guibas 1995, section 3] A path goes on with the probability of the
 * reflectance of its strongest band, as a particle does, and is as free of bias.
 *
 * Invariant: nothing is computed from but the tracer and the dice, so the same dice give the same
 * bits on any thread.
 * SPDX-License-Identifier: MIT */
#ifndef PATHS_H
#define PATHS_H

#include "particles/tracer.h"

/* How many rays of each kind look for emitters from one point; some by the cosine. */
struct path_rays {
    double cosine, light;
};

/* The share of what leaves a point that one of `rays`, of either kind, counts as irradiance when it
 * finds that point (the balance heuristic): c / (n_c c + n_l d), where by_cosine is how densely
 * directions by the cosine find it, c, and by_light how densely points on emitters do, d (1/m2). */
static inline double path_share(const struct path_rays *rays, double by_cosine, double by_light)
{
    return by_cosine / (rays->cosine * by_cosine + rays->light * by_light);
}

/* From p, just in front of the face, towards the point of the emitters that u in [0, 1)^3 stands
 * for: adds to h[bands] what this ray of `rays` finds (W/m2). One ray, or none where the emitter
 * faces away. The scene has emitters. Returns how many rays were cast. */
int path_to_light(const struct tracer *t, uint32_t face, const double p[3], const double u[3],
                  const struct path_rays *rays, double *h);

/* From p, just in front of the face, in the direction by the cosine that (u, v) stand for: adds to
 * h[bands] the exitance that this ray of `rays` finds (W/m2). One ray. Returns the face that it
 * meets, with p moved in front of it and `at` in its plane, or what is below 0. */
int64_t path_onward(const struct tracer *t, uint32_t face, double p[3], double u, double v,
                    const struct path_rays *rays, double *h, double at[3]);

/* A path on its way. */
struct path {
    uint32_t face;
    double x[3];       /* where it goes on from, just in front of the face (m) */
    double at[3];      /* the same point in the face's plane, once it has met one */
    double through[3]; /* [band]: how much of what arrives here arrives where it began */
};

static inline struct path path_from(uint32_t face, const double x[3])
{
    return (struct path){.face = face, .x = {x[0], x[1], x[2]}, .through = {1, 1, 1}};
}

/* Looks for emitters from where the path is, by one ray of each kind, and adds what they bring to
 * where it began to h[bands] (W/m2). Then it is at the face that the ray by the cosine meets; 0:
 * there is none. The scene has emitters. How many rays that took is added to *rays. */
int path_step(const struct tracer *t, struct path *p, struct dice *dice, double *h, uint64_t *rays);

/* The face that the path has met reflects. 0: it ends there, by chance as said above; with no dice
 * where no band is left. */
int path_reflect(const struct tracer *t, struct path *p, struct dice *dice);

/* The irradiance at p (m), just in front of the face (tracer_point): h[bands] (W/m2) by one path,
 * right in the mean, and how many rays that took is added to *rays: at each of its points one by
 * the cosine and, towards emitters that face it, another one; so no more than 2 / (1 - rho) in the
 * mean, rho the brightest reflectance. Without emitters none. */
void path_irradiance(const struct tracer *t, uint32_t face, const double p[3], struct dice *dice,
                     double *h, uint64_t *rays);

#endif
