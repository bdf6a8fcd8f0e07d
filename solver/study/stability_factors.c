/* stability_factors.c - cases about form factors: near, touching, crossing, thin, far.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "study/closed_forms.h"
#include "study/stability.h"

static struct made_scene one_grey(void)
{
    struct made_scene scene = {.count = 0};
    made_material(&scene, 0.5, 0);
    return scene;
}

/* a x b at distance c. */
static struct made_scene two_parallel(double a, double b, double c)
{
    struct made_scene scene = one_grey();
    made_quad(&scene, 0, 0, 0, 0, a, 0, 0, 0, b, 0);
    made_quad(&scene, 0, 0, 0, c, 0, b, 0, a, 0, 0);
    return scene;
}

/* A floor w x l and a wall h x l on its edge. */
static struct made_scene two_perpendicular(double w, double h, double l)
{
    struct made_scene scene = one_grey();
    made_quad(&scene, 0, 0, 0, 0, l, 0, 0, 0, w, 0);
    made_quad(&scene, 0, 0, 0, 0, 0, 0, h, l, 0, 0);
    return scene;
}

/* F from polygon i to polygon j by a BY_FACTOR method. */
static double pair_factor(const struct stability_trial *trial, const struct made_scene *scene,
                          uint32_t i, uint32_t j)
{
    const struct element r = made_element(scene, i), s = made_element(scene, j);
    return stability_factor(trial, &r, &s);
}

/* F from face 0 to face 1 by the trial's method. Returns 0 or -1. */
static int factor(struct stability_trial *trial, const struct made_scene *scene, double *f)
{
    if (trial->method->kind == BY_FACTOR) {
        *f = pair_factor(trial, scene, 0, 1);
        return 0;
    }
    struct solved s;
    if (stability_solve(&s, scene, trial, 1) < 0)
        return -1;
    *f = stability_exchange(&s, 0, 1);
    trial->count = (double)s.links.count;
    solved_close(&s);
    return 0;
}

/* Set the error of F from face 0 to face 1, relative to `known`. Returns 0 or -1. */
static int against(struct stability_trial *trial, struct made_scene scene, double known)
{
    double f;
    if (factor(trial, &scene, &f) < 0)
        return -1;
    trial->error = fabs(f / known - 1);
    return 0;
}

int stability_shared_edge(struct stability_trial *trial)
{
    return against(trial, two_perpendicular(1, 1, 1), closed_perpendicular(1, 1, 1));
}

/* The error of F from n x n parts of the one square to n x n parts of the other. */
static double parts_error(const struct stability_trial *trial, uint32_t n)
{
    double h = 1.0 / n, sum = 0;
    struct made_scene scene = one_grey();
    uint32_t cells = n * n;
    for (int k = 0; k < 2; k++)
        for (uint32_t i = 0; i < cells; i++) {
            double x = h * (i % n), y = h * (i / n);
            if (k == 0)
                made_quad(&scene, 0, x, y, 0, h, 0, 0, 0, h, 0);
            else
                made_quad(&scene, 0, x, 0, y, 0, 0, h, h, 0, 0);
        }
    struct element element[MADE_POLYGONS];
    for (uint32_t i = 0; i < scene.count; i++)
        element[i] = made_element(&scene, i);
    for (uint32_t i = 0; i < cells; i++)
        for (uint32_t j = 0; j < cells; j++)
            sum += h * h * stability_factor(trial, &element[i], &element[cells + j]);
    return fabs(sum / closed_perpendicular(1, 1, 1) - 1);
}

int stability_shared_edge_halved(struct stability_trial *trial)
{
    trial->error = 0;
    for (uint32_t n = 1; n < 16; n *= 2) {
        double before = parts_error(trial, n), after = parts_error(trial, 2 * n);
        trial->error = fmax(trial->error, before > 1e-9 ? after / before : 0);
    }
    return 0;
}

int stability_close_parallel(struct stability_trial *trial)
{
    return against(trial, two_parallel(1, 1, 0.1), closed_parallel(1, 1, 0.1));
}

int stability_half_apart(struct stability_trial *trial)
{
    return against(trial, two_parallel(1, 1, 0.5), closed_parallel(1, 1, 0.5));
}

int stability_row_sum(struct stability_trial *trial)
{
    const uint32_t grey[6] = {0, 0, 0, 0, 0, 0};
    struct made_scene cube = one_grey();
    double sum = 0;
    made_room(&cube, grey, 1, 1, 1);
    if (trial->method->kind == BY_FACTOR) {
        for (uint32_t j = 1; j < 6; j++)
            sum += pair_factor(trial, &cube, 0, j);
    } else {
        struct solved s;
        if (stability_solve(&s, &cube, trial, 1) < 0)
            return -1;
        sum = stability_row(&s, 0);
        trial->count = (double)s.links.count;
        solved_close(&s);
    }
    trial->error = fabs(sum - 1);
    return 0;
}

/* A wall through the floor's edge, its lower half below the floor's plane; it stays whole. */
static struct made_scene two_straddling(void)
{
    struct made_scene scene = one_grey();
    scene.as_given = 1;
    made_quad(&scene, 0, 0, 0, -0.5, 0, 1, 0, 0, 0, 1);
    made_quad(&scene, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    return scene;
}

int stability_straddle(struct stability_trial *trial)
{
    return against(trial, two_straddling(), 0.5 * closed_perpendicular(0.5, 1, 1));
}

int stability_straddle_children(struct stability_trial *trial)
{
    const struct made_scene scene = two_straddling();
    const struct element wall = made_element(&scene, 0), floor = made_element(&scene, 1);
    double whole = wall.area * stability_factor(trial, &wall, &floor), parts = 0;
    for (int i = 0; i < 4; i++) {
        struct element quarter;
        surface_quarter(&wall, i, &quarter);
        parts += quarter.area * stability_factor(trial, &quarter, &floor);
    }
    trial->error = fabs(parts - whole) / (0.5 * closed_perpendicular(0.5, 1, 1));
    return 0;
}

/* Two axes across each other, any way round. */
static void random_frame(unsigned *seed, double u[3], double v[3])
{
    double w[3];
    for (int k = 0; k < 3; k++) {
        u[k] = stability_random(seed) - 0.5;
        w[k] = stability_random(seed) - 0.5;
    }
    cross3(v, u, w);
}

int stability_coplanar(struct stability_trial *trial)
{
    enum { PAIRS = 400, SOLVED = 8 };
    unsigned seed = 5;
    int wrong = 0, n = trial->method->kind == BY_FACTOR ? PAIRS : SOLVED;
    for (int i = 0; i < n; i++) {
        struct made_scene scene = one_grey();
        double u[3], v[3], side = 1 + (i & 1); /* touching, or one apart */
        random_frame(&seed, u, v);
        made_quad(&scene, 0, 0.1, 0.2, 0.3, u[0], u[1], u[2], v[0], v[1], v[2]);
        made_quad(&scene, 0, 0.1 + side * u[0], 0.2 + side * u[1], 0.3 + side * u[2], u[0], u[1],
                  u[2], v[0], v[1], v[2]);
        if (trial->method->kind == BY_FACTOR) {
            wrong += pair_factor(trial, &scene, 0, 1) > 0;
        } else {
            struct solved s;
            if (stability_solve(&s, &scene, trial, 1) < 0)
                return -1;
            wrong += s.links.count > 0 || s.report.rays > 0;
            solved_close(&s);
        }
    }
    trial->error = (double)wrong / n;
    return 0;
}

/* 1 : 1e4, over a strip of the same shape at a distance between its two sides. */
int stability_sliver(struct stability_trial *trial)
{
    return against(trial, two_parallel(1e-4, 1, 1e-2), closed_parallel(1e-4, 1, 1e-2));
}

/* A skirting 1e-4 high along a floor. */
int stability_sliver_standing(struct stability_trial *trial)
{
    struct made_scene scene = one_grey();
    made_quad(&scene, 0, 0, 0, 0, 0, 0, 1e-4, 1, 0, 0);
    made_quad(&scene, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    return against(trial, scene, closed_perpendicular(1e-4, 1, 1));
}

int stability_scale_far(struct stability_trial *trial)
{
    const struct made_scene near = two_parallel(1, 1, 2), far = two_parallel(1024, 1024, 2048);
    double f[2];
    if (factor(trial, &near, &f[0]) < 0 || factor(trial, &far, &f[1]) < 0)
        return -1;
    trial->error = fabs(f[1] / f[0] - 1);
    return 0;
}

/* The worst of many rectangles, aligned and at right angles, thin and wide, near and far. */
int stability_closed_forms(struct stability_trial *trial)
{
    static const double parallel[][3] = {{1, 1, 0.01},  {1, 1, 0.1}, {1, 1, 1},  {1, 1, 2},
                                         {2, 0.5, 0.3}, {1, 3, 5},   {1, 1, 20}, {0.03, 4, 0.7},
                                         {1, 100, 1},   {1, 1000, 1}};
    static const double standing[][3] = {{1, 1, 1},   {1, 0.1, 1}, {0.1, 1, 1},
                                         {3, 0.5, 2}, {1, 1, 10},  {5, 5, 0.1}};
    double worst = 0;
    for (size_t i = 0; i < sizeof parallel / sizeof *parallel; i++) {
        const double *p = parallel[i];
        if (against(trial, two_parallel(p[0], p[1], p[2]), closed_parallel(p[0], p[1], p[2])) < 0)
            return -1;
        worst = fmax(worst, trial->error);
    }
    for (size_t i = 0; i < sizeof standing / sizeof *standing; i++) {
        const double *p = standing[i];
        if (against(trial, two_perpendicular(p[0], p[1], p[2]),
                    closed_perpendicular(p[0], p[1], p[2]))
            < 0)
            return -1;
        worst = fmax(worst, trial->error);
    }
    trial->error = worst;
    trial->count = -1;
    return 0;
}

/* A triangle whose corners lie on a line, among formulas that divide by its area. */
int stability_degenerate_factor(struct stability_trial *trial)
{
    static const double flat[3][3] = {{0.2, 0.2, 1}, {0.5, 0.5, 1}, {0.8, 0.8, 1}};
    struct made_scene scene = one_grey();
    made_quad(&scene, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    made_face(&scene, 0, 3, flat);
    double f = pair_factor(trial, &scene, 0, 1), g = pair_factor(trial, &scene, 1, 0);
    trial->error = isnan(f) || isnan(g) ? NAN : fmax(fabs(f), fabs(g));
    return 0;
}
