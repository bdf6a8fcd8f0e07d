/* stability_balance.c - cases whose solution is known: open scenes, a cube and a cavity.
 *
 * Plates, cube and cube cavity from converged solutions of the integral equation, cross-checked by
 * a second method.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "study/stability.h"

/* Two unit squares, E = 1, rho = .5: parallel at distance 1, or at right angles with an edge in
 * common. */
static void make_parallel(struct made_scene *s, double unused)
{
    (void)unused;
    made_material(s, 0.5, 1);
    made_quad(s, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    made_quad(s, 0, 0, 0, 1, 0, 1, 0, 1, 0, 0);
}

static void make_corner(struct made_scene *s, double unused)
{
    (void)unused;
    made_material(s, 0.5, 1);
    made_quad(s, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    made_quad(s, 0, 0, 0, 0, 0, 0, 1, 1, 0, 0);
}

enum { LEAF = 255 };

/* B of the part of a face that is nearest to p (by its centre): of a leaf, or of what `depth`
 * splits make. */
static double radiosity_at(const struct solved *s, uint32_t face, int depth, double x, double y,
                           double z)
{
    const struct element *all = s->elements.elements;
    uint32_t e = s->elements.face_element[face];
    const double p[3] = {x, y, z};
    while (all[e].children && all[e].depth < depth) {
        double best = INFINITY;
        uint32_t next = e;
        for (uint32_t c = all[e].child; c < all[e].child + all[e].children; c++) {
            double v[3];
            sub3(v, all[c].centre, p);
            if (dot3(v, v) < best) {
                best = dot3(v, v);
                next = c;
            }
        }
        e = next;
    }
    return s->elements.radiosity[(size_t)e * s->elements.bands];
}

/* The larger of |value / known - 1| and `error`. */
static double off(double error, double value, double known)
{
    return fmax(error, fabs(value / known - 1));
}

static double plates_error(const struct solved *s, double known)
{
    double error = off(off(0, stability_radiosity(s, 0), known), stability_radiosity(s, 1), known);
    return fmax(error, s->report.absorbed / s->report.emitted - 1);
}

int stability_open_plates(struct stability_trial *trial)
{
    static const struct stability_scene plates = {make_parallel, plates_error};
    const double known = 1.111165244298;
    if (trial->method != &stability_methods[NORMALISED])
        return stability_measured(trial, &plates, known, &trial->error);
    /* with its row made 1 a plate sees nothing but plate */
    trial->error = 1 / (1 - 0.5) / known - 1;
    return 0;
}

static double profile_error(const struct solved *s, double unused)
{
    double error = off(0, radiosity_at(s, 0, LEAF, 0.5, 0.5, 0), 1.133303564992);
    (void)unused;
    error = off(error, radiosity_at(s, 0, LEAF, 0.5, 0, 0), 1.100306232464);
    return off(error, radiosity_at(s, 0, LEAF, 0, 0, 0), 1.076981393145);
}

int stability_plates_profile(struct stability_trial *trial)
{
    static const struct stability_scene plates = {make_parallel, profile_error};
    return stability_measured(trial, &plates, 0, &trial->error);
}

static double edge_error(const struct solved *s, double unused)
{
    (void)unused;
    return off(off(0, stability_radiosity(s, 0), 1.1159537), radiosity_at(s, 0, LEAF, 0.5, 0, 0),
               1 / (1 - 0.5 * 0.5));
}

int stability_plates_edge(struct stability_trial *trial)
{
    static const struct stability_scene plates = {make_corner, edge_error};
    return stability_measured(trial, &plates, 0, &trial->error);
}

/* A unit cube, rho = .5, its ceiling E = 1. */
static void make_lit_cube(struct made_scene *s, double unused)
{
    const uint32_t m[6] = {0, 1, 0, 0, 0, 0};
    (void)unused;
    made_material(s, 0.5, 0);
    made_material(s, 0.5, 1);
    made_room(s, m, 1, 1, 1);
}

static double cube_off(double ceiling, double floor, double wall)
{
    return off(off(off(0, ceiling, 1.1043616), floor, 0.1712161), wall, 0.1811056);
}

static double cube_error(const struct solved *s, double unused)
{
    (void)unused;
    return cube_off(stability_radiosity(s, 1), stability_radiosity(s, 0),
                    stability_radiosity(s, 2));
}

int stability_cube(struct stability_trial *trial)
{
    static const struct stability_scene cube = {make_lit_cube, cube_error};
    double b[3] = {1, 0, 0}, f[2];
    if (trial->method->kind == BY_ORACLE)
        return stability_measured(trial, &cube, 0, &trial->error);
    stability_cube_factors(trial, f);
    trial->work = 0;                /* its faces stay one element each, however well F is known */
    for (int i = 0; i < 200; i++) { /* one element per face: ceiling, floor, walls */
        double c = 1 + 0.5 * (f[0] * b[1] + 4 * f[1] * b[2]),
               g = 0.5 * (f[0] * b[0] + 4 * f[1] * b[2]);
        b[2] = 0.5 * (f[1] * (b[0] + b[1] + 2 * b[2]) + f[0] * b[2]);
        b[0] = c;
        b[1] = g;
    }
    trial->error = cube_off(b[0], b[1], b[2]);
    return 0;
}

/* A cube with one face open: a black face in the opening, whose irradiance is the emissivity
 * that the opening seems to have. */
static void make_cavity(struct made_scene *s, double emissivity)
{
    const uint32_t m[6] = {0, 1, 0, 0, 0, 0};
    made_material(s, 1 - emissivity, emissivity);
    made_material(s, 0, 0);
    made_room(s, m, 1, 1, 1);
}

static double opening(const struct solved *s, double unused)
{
    (void)unused;
    return stability_irradiance(s, 1);
}

int stability_cavity(struct stability_trial *trial)
{
    static const struct stability_scene cavity = {make_cavity, opening};
    static const double wall[2] = {0.1, 0.5}, known[2] = {0.3483681, 0.8111445};
    trial->error = 0;
    for (int i = 0; i < 2; i++) {
        double seen = NAN;
        /* floor and walls alike see the opening by f[0], f[1]; E = e, two unknowns */
        if (trial->method->kind == BY_FACTOR) {
            double b = wall[i], w = wall[i], rho = 1 - wall[i];
            double f[2];
            stability_cube_factors(trial, f);
            trial->work = 0;
            for (int k = 0; k < 2000; k++) {
                double next = wall[i] + rho * 4 * f[1] * w;
                w = wall[i] + rho * (f[1] * b + (f[0] + 2 * f[1]) * w);
                b = next;
            }
            seen = f[0] * b + 4 * f[1] * w;
        } else if (stability_measured(trial, &cavity, wall[i], &seen) < 0) {
            return -1;
        }
        trial->error = off(trial->error, seen, known[i]);
    }
    return 0;
}
