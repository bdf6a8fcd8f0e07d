/* stability_factors.c - cases about form factors: near, touching, crossing, thin, far.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "scene/make_scene.h"
#include "study/stability.h"
#include "study/stability_known.h"

/* Two elements, one each of the first two faces of a scene. */
struct two {
    struct scene scene;
    struct hierarchy h;
};

static const struct element *element(const struct two *t, int i)
{
    return &t->h.elements[t->h.face_element[i]];
}

static int two_begin(struct two *t)
{
    if (made_open(&t->scene) < 0) {
        made_close(&t->scene);
        return -1;
    }
    made_material(&t->scene, 0.5, 0);
    return 0;
}

static int two_end(struct two *t)
{
    if (hierarchy_build(&t->h, t->scene.faces, t->scene.face_count) == 0)
        return 0;
    made_close(&t->scene);
    return -1;
}

static void two_close(struct two *t)
{
    hierarchy_free(&t->h);
    made_close(&t->scene);
}

/* a x b at distance c. */
static int two_parallel(struct two *t, double a, double b, double c)
{
    if (two_begin(t) < 0)
        return -1;
    made_quad(&t->scene, 0, 0, 0, 0, a, 0, 0, 0, b, 0);
    made_quad(&t->scene, 0, 0, 0, c, 0, b, 0, a, 0, 0);
    return two_end(t);
}

/* A floor w x l and a wall h x l on its edge. */
static int two_perpendicular(struct two *t, double w, double h, double l)
{
    if (two_begin(t) < 0)
        return -1;
    made_quad(&t->scene, 0, 0, 0, 0, l, 0, 0, 0, w, 0);
    made_quad(&t->scene, 0, 0, 0, 0, 0, 0, h, l, 0, 0);
    return two_end(t);
}

/* F from face 0 to face 1 by the trial's method. Returns 0 or -1. */
static int factor(struct stability_trial *trial, struct two *t, double *f)
{
    struct solve s;
    if (trial->method->kind == BY_FACTOR) {
        *f = stability_factor(trial->method, element(t, 0), element(t, 1));
        return 0;
    }
    if (stability_solve(&s, &t->scene, trial, 1) < 0)
        return -1;
    *f = stability_exchange(&s, 0, 1);
    trial->count = (double)s.refinement.link_count;
    solve_close(&s);
    return 0;
}

/* Set the error of F from face 0 to face 1, relative to `known`, and close. */
static int against(struct stability_trial *trial, struct two *t, double known)
{
    double f;
    int status = factor(trial, t, &f);
    two_close(t);
    trial->error = status < 0 ? NAN : fabs(f / known - 1);
    return status;
}

int stability_shared_edge(struct stability_trial *trial)
{
    struct two t;
    return two_perpendicular(&t, 1, 1, 1) < 0 ? -1 : against(trial, &t, closed_perpendicular(1, 1, 1));
}

/* The error of F from n x n parts of the one square to n x n parts of the other. */
static int parts_error(const struct stability_trial *trial, int n, double *error)
{
    double h = 1.0 / n, sum = 0;
    struct two t;
    uint32_t i, j, cells = (uint32_t)(n * n);
    int k;
    if (two_begin(&t) < 0)
        return -1;
    for (k = 0; k < 2; k++)
        for (i = 0; i < cells; i++) {
            double x = h * (i % (uint32_t)n), y = h * (i / (uint32_t)n);
            if (k == 0)
                made_quad(&t.scene, 0, x, y, 0, h, 0, 0, 0, h, 0);
            else
                made_quad(&t.scene, 0, x, 0, y, 0, 0, h, h, 0, 0);
        }
    if (two_end(&t) < 0)
        return -1;
    for (i = 0; i < cells; i++)
        for (j = 0; j < cells; j++)
            sum += h * h * stability_factor(trial->method, element(&t, (int)i), element(&t, (int)(cells + j)));
    two_close(&t);
    *error = fabs(sum / closed_perpendicular(1, 1, 1) - 1);
    return 0;
}

int stability_shared_edge_halved(struct stability_trial *trial)
{
    double before, after;
    int n;
    trial->error = 0;
    for (n = 1; n < 16; n *= 2) {
        if (parts_error(trial, n, &before) < 0 || parts_error(trial, 2 * n, &after) < 0)
            return -1;
        trial->error = fmax(trial->error, before > 1e-9 ? after / before : 0);
    }
    return 0;
}

int stability_close_parallel(struct stability_trial *trial)
{
    struct two t;
    return two_parallel(&t, 1, 1, 0.1) < 0 ? -1 : against(trial, &t, closed_parallel(1, 1, 0.1));
}

int stability_half_apart(struct stability_trial *trial)
{
    struct two t;
    return two_parallel(&t, 1, 1, 0.5) < 0 ? -1 : against(trial, &t, closed_parallel(1, 1, 0.5));
}

int stability_row_sum(struct stability_trial *trial)
{
    const uint32_t grey[6] = { 0, 0, 0, 0, 0, 0 };
    struct two t;
    struct solve s;
    double sum = 0;
    int j;
    if (two_begin(&t) < 0)
        return -1;
    made_room(&t.scene, grey, 1, 1, 1);
    if (two_end(&t) < 0)
        return -1;
    if (trial->method->kind == BY_FACTOR) {
        for (j = 1; j < 6; j++)
            sum += stability_factor(trial->method, element(&t, 0), element(&t, j));
    } else {
        if (stability_solve(&s, &t.scene, trial, 1) < 0) {
            two_close(&t);
            return -1;
        }
        sum = stability_row(&s, 0);
        trial->count = (double)s.refinement.link_count;
        solve_close(&s);
    }
    two_close(&t);
    trial->error = fabs(sum - 1);
    return 0;
}

/* A wall through the floor's edge, its lower half below the floor's plane. */
static int two_straddling(struct two *t)
{
    if (two_begin(t) < 0)
        return -1;
    made_quad(&t->scene, 0, 0, 0, -0.5, 0, 1, 0, 0, 0, 1);
    made_quad(&t->scene, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    return two_end(t);
}

int stability_straddle(struct stability_trial *trial)
{
    struct two t;
    return two_straddling(&t) < 0 ? -1 : against(trial, &t, 0.5 * closed_perpendicular(0.5, 1, 1));
}

int stability_straddle_children(struct stability_trial *trial)
{
    struct two t;
    double whole, parts = 0;
    uint32_t c, wall;
    if (two_straddling(&t) < 0)
        return -1;
    wall = t.h.face_element[0];
    whole = element(&t, 0)->area * stability_factor(trial->method, element(&t, 0), element(&t, 1));
    if (hierarchy_split(&t.h, wall) < 0) {
        two_close(&t);
        return -1;
    }
    for (c = 0; c < 4; c++) {
        const struct element *e = &t.h.elements[t.h.elements[wall].child + c];
        parts += e->area * stability_factor(trial->method, e, element(&t, 1));
    }
    two_close(&t);
    trial->error = fabs(parts - whole) / (0.5 * closed_perpendicular(0.5, 1, 1));
    return 0;
}

/* Two axes across each other, any way round. */
static void random_frame(unsigned *seed, double u[3], double v[3])
{
    double w[3];
    int k;
    for (k = 0; k < 3; k++) {
        u[k] = stability_random(seed) - 0.5;
        w[k] = stability_random(seed) - 0.5;
    }
    cross3(v, u, w);
}

int stability_coplanar(struct stability_trial *trial)
{
    enum { PAIRS = 400, SOLVED = 8 };
    unsigned seed = 5;
    int i, wrong = 0, n = trial->method->kind == BY_FACTOR ? PAIRS : SOLVED;
    for (i = 0; i < n; i++) {
        struct two t;
        struct solve s;
        double u[3], v[3], side = 1 + (i & 1); /* touching, or one apart */
        random_frame(&seed, u, v);
        if (two_begin(&t) < 0)
            return -1;
        made_quad(&t.scene, 0, 0.1, 0.2, 0.3, u[0], u[1], u[2], v[0], v[1], v[2]);
        made_quad(&t.scene, 0, 0.1 + side * u[0], 0.2 + side * u[1], 0.3 + side * u[2], u[0], u[1], u[2], v[0], v[1], v[2]);
        if (two_end(&t) < 0)
            return -1;
        if (trial->method->kind == BY_FACTOR) {
            wrong += stability_factor(trial->method, element(&t, 0), element(&t, 1)) > 0;
        } else {
            if (stability_solve(&s, &t.scene, trial, 1) < 0) {
                two_close(&t);
                return -1;
            }
            wrong += s.refinement.link_count > 0 || rays_count(s.problem.rays).rays > 0;
            solve_close(&s);
        }
        two_close(&t);
    }
    trial->error = (double)wrong / n;
    return 0;
}

/* 1 : 1e4, over a strip of the same shape at a distance between its two sides. */
int stability_sliver(struct stability_trial *trial)
{
    struct two t;
    return two_parallel(&t, 1e-4, 1, 1e-2) < 0 ? -1 : against(trial, &t, closed_parallel(1e-4, 1, 1e-2));
}

/* A skirting 1e-4 high along a floor. */
int stability_sliver_standing(struct stability_trial *trial)
{
    struct two t;
    if (two_begin(&t) < 0)
        return -1;
    made_quad(&t.scene, 0, 0, 0, 0, 0, 0, 1e-4, 1, 0, 0);
    made_quad(&t.scene, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    return two_end(&t) < 0 ? -1 : against(trial, &t, closed_perpendicular(1e-4, 1, 1));
}

int stability_scale_far(struct stability_trial *trial)
{
    struct two t;
    double near = INFINITY, far;
    if (two_parallel(&t, 1, 1, 2) < 0)
        return -1;
    if (factor(trial, &t, &near) < 0) {
        two_close(&t);
        return -1;
    }
    two_close(&t);
    if (two_parallel(&t, 1024, 1024, 2048) < 0)
        return -1;
    if (factor(trial, &t, &far) < 0) {
        two_close(&t);
        return -1;
    }
    two_close(&t);
    trial->error = fabs(far / near - 1);
    return 0;
}

/* The worst of many rectangles, aligned and at right angles, thin and wide, near and far. */
int stability_closed_forms(struct stability_trial *trial)
{
    static const double parallel[][3] = { { 1, 1, 0.01 }, { 1, 1, 0.1 }, { 1, 1, 1 }, { 1, 1, 2 }, { 2, 0.5, 0.3 },
                                          { 1, 3, 5 }, { 1, 1, 20 }, { 0.03, 4, 0.7 }, { 1, 100, 1 }, { 1, 1000, 1 } };
    static const double standing[][3] = { { 1, 1, 1 }, { 1, 0.1, 1 }, { 0.1, 1, 1 }, { 3, 0.5, 2 }, { 1, 1, 10 }, { 5, 5, 0.1 } };
    double worst = 0;
    size_t i;
    for (i = 0; i < sizeof parallel / sizeof *parallel; i++) {
        const double *p = parallel[i];
        struct two t;
        if (two_parallel(&t, p[0], p[1], p[2]) < 0 || against(trial, &t, closed_parallel(p[0], p[1], p[2])) < 0)
            return -1;
        worst = fmax(worst, trial->error);
    }
    for (i = 0; i < sizeof standing / sizeof *standing; i++) {
        const double *p = standing[i];
        struct two t;
        if (two_perpendicular(&t, p[0], p[1], p[2]) < 0 || against(trial, &t, closed_perpendicular(p[0], p[1], p[2])) < 0)
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
    static const double flat[3][3] = { { 0.2, 0.2, 1 }, { 0.5, 0.5, 1 }, { 0.8, 0.8, 1 } };
    struct two t;
    double f, g;
    if (two_begin(&t) < 0)
        return -1;
    made_quad(&t.scene, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    made_face(&t.scene, 0, 3, flat);
    if (two_end(&t) < 0)
        return -1;
    f = stability_factor(trial->method, element(&t, 0), element(&t, 1));
    g = stability_factor(trial->method, element(&t, 1), element(&t, 0));
    two_close(&t);
    trial->error = isnan(f) || isnan(g) ? NAN : fmax(fabs(f), fabs(g));
    return 0;
}
