/* two_furnaces.h - two closed boxes, apart, each a furnace: walls that emit E and reflect rho have
 * H = E / (1 - rho) everywhere. One is as bright as is asked, the other at 1 W/m2, and gets nearly
 * all particles.
 * SPDX-License-Identifier: MIT */
#ifndef TWO_FURNACES_H
#define TWO_FURNACES_H

#include "runtime/make_solve.h"
#include "engine/dim_faces.h"
#include "engine/measured_error.h"
#include "engine/mend.h"
#include "engine/solve_tracer.h"

#define DARK 1e-3 /* W/m2: H in the dark box; in the bright one it is 1 */
#define RHO 0.3   /* of both */

/* The face that is spoilt, the first of the dark box; the other five are cut in CUTS x CUTS parts
 * of 1/192 of the area each, two of which are large together, and four too large. */
enum { WALL = 6, CUTS = 4, GROUPS = 5 * CUTS * CUTS / 2 };

/* Of a box's walls: one part of n by n. */
static inline void add_part(struct scene *s, uint32_t material, const struct face *wall, int n,
                            int part)
{
    const double(*v)[3] = wall->vertex;
    double o[3], a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = (v[1][k] - v[0][k]) / n;
        b[k] = (v[3][k] - v[0][k]) / n;
        o[k] = v[0][k] + part % n * a[k] + part / n * b[k];
    }
    made_quad(s, material, o[0] + 5, o[1], o[2], a[0], a[1], a[2], b[0], b[1], b[2]);
}

/* Two boxes whose links are right. light: H in the second, of whose walls all but the first are cut
 * in cuts^2 parts; CUTS: each of less than a hundredth of the area. */
static inline void furnaces_cut(struct solve *s, struct scene *scene, double light, int cuts,
                                int threads)
{
    static char *settings[] = {"min_share=0.02", NULL};
    ck_assert_int_eq(made_open(scene), 0);
    uint32_t bright = made_material(scene, RHO, 1 - RHO),
             dark = made_material(scene, RHO, light * (1 - RHO));
    const uint32_t walls[6] = {bright, bright, bright, bright, bright, bright};
    made_room(scene, walls, 1, 1, 1);
    for (int i = 0; i < 6; i++)
        for (int n = i == 0 ? 1 : cuts, part = 0; part < n * n; part++)
            add_part(scene, dark, &scene->faces[i], n, part);
    solve_with(s, scene, "bf", RELEASE_FLAT, settings, quick(threads));
}

static inline void two_furnaces(struct solve *s, struct scene *scene, double light, int threads)
{
    furnaces_cut(s, scene, light, CUTS, threads);
}

/* Mend by `particles`, then dim polygons within the budget. Returns what the latter returned;
 * *root: by what factor the whole scene's light has changed. */
static inline int mend_within(struct solve *s, uint64_t particles, const struct dim_budget *budget,
                              uint64_t *rays, double *root, struct dim_count *dim)
{
    size_t size = s->hierarchy.count * sizeof(double);
    struct tracer t = solve_tracer(s);
    struct tally tally;
    ck_assert_int_eq(tracer_open(&t), 0);
    ck_assert_int_eq(tally_open(&tally, &t, MEND_STREAM, 1), 0);
    ck_assert_int_eq(tally_trace(&tally, &t, particles / REPLICATES, NULL), 0);
    s->mended.radiosity = malloc(size);
    s->mended.irradiance = malloc(size);
    memcpy(s->mended.radiosity, s->state.radiosity, size);
    memcpy(s->mended.irradiance, s->state.irradiance, size);
    ck_assert_int_eq(mend_irradiance(&s->operator, & tally, s->mended.irradiance), 0);
    double before = s->mended.irradiance[0];
    *rays = 0;
    double band_noise[3] = {1, 1, 1};
    int changed =
        dim_faces_mend(s, &t, &tally, DIM_LARGE_ONES, budget, NULL, rays, dim, band_noise);
    ck_assert_uint_ge(dim->large, dim->unsure);
    *root = s->mended.irradiance[0] / before;
    tally_close(&tally);
    tracer_close(&t);
    return changed;
}

#endif
