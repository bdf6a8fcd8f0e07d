/* stability_sight.c - cases about visibility: small blockers, walls without thickness, walls that stand in an
 * element, coordinates far from zero.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>
#include "scene/make_scene.h"
#include "hierarchy/cut_faces.h"
#include "study/stability.h"
#include "study/stability_known.h"
#include "terms/form_factor.h"
#include "terms/visibility.h"
#include "tools/exact_visibility.h"

/* Occlusion one face after the other: by fronts alone, or from coordinates rounded to single precision and a
 * fixed distance kept, as programs do that fail. */
struct simple_host {
    struct host host; /* first */
    const struct scene *scene;
    int single;
};

/* Where a fixed distance that suits a scene of a few metres is kept whatever the coordinates (m). */
#define FIXED_OFFSET 1e-4

static int meets_triangle(const double from[3], const double along[3], const double *a, const double *b, const double *c,
                          double least, int fronts)
{
    double u[3], v[3], w[3], p[3], q[3], n[3], det, x, y, t;
    sub3(u, b, a);
    sub3(v, c, a);
    sub3(w, from, a);
    cross3(n, u, v);
    if (fronts && dot3(n, along) >= 0)
        return 0;
    cross3(p, along, v);
    det = dot3(u, p);
    if (det == 0)
        return 0;
    x = dot3(w, p) / det;
    cross3(q, w, u);
    y = dot3(along, q) / det;
    t = dot3(v, q) / det;
    return x >= 0 && y >= 0 && x + y <= 1 && t > least && t < 1 - least;
}

static void round_to_single(double out[3], const double v[3], int single)
{
    int k;
    for (k = 0; k < 3; k++)
        out[k] = single ? (double)(float)v[k] : v[k];
}

static uint64_t simple_occluded(const struct host *host, int count, const struct segment *segments)
{
    const struct simple_host *h = (const struct simple_host *)(const void *)host;
    uint64_t hits = 0;
    int i;
    for (i = 0; i < count; i++) {
        double from[3], to[3], along[3], least;
        uint32_t f, j;
        round_to_single(from, segments[i].from, h->single);
        round_to_single(to, segments[i].to, h->single);
        sub3(along, to, from);
        least = h->single ? FIXED_OFFSET / length3(along) : 0;
        for (f = 0; f < h->scene->face_count; f++) {
            const struct face *face = &h->scene->faces[f];
            double v[4][3];
            for (j = 0; j < face->vertices; j++)
                round_to_single(v[j], face->vertex[j], h->single);
            for (j = 2; j < face->vertices; j++)
                if (meets_triangle(from, along, v[0], v[j - 1], v[j], least, !h->single))
                    hits |= (uint64_t)1 << i;
        }
    }
    return hits;
}

/* Visible fraction from face i to face j by the trial's BY_RAYS method. */
static double visible(const struct solve *s, const struct stability_trial *trial, uint32_t i, uint32_t j)
{
    int rays = trial->method->number;
    struct simple_host simple = { *rays_host(s->problem.rays), s->problem.scene, rays == BY_FLOAT };
    struct discussion d;
    memset(&d, 0, sizeof d);
    d.receiver = &s->hierarchy.elements[s->hierarchy.face_element[i]];
    d.emitter = &s->hierarchy.elements[s->hierarchy.face_element[j]];
    d.host = rays == BY_FRONTS || rays == BY_FLOAT ? &simple.host : rays_host(s->problem.rays);
    if (rays == BY_INTEGRAL) {
        (void)tool_exact_visibility(&d);
        return d.terms.visibility;
    }
    simple.host.occluded = simple_occluded;
    if (simple.single)
        simple.host.ray_offset = FIXED_OFFSET;
    return term_visibility(&d, rays == 4 ? VISIBILITY_RAYS_4 : rays == 16 ? VISIBILITY_RAYS_16 : VISIBILITY_RAYS_64);
}

/* F V from face i to face j by the trial's method, any kind. Returns 0 or -1. */
static int exchange(struct stability_trial *trial, const struct scene *scene, uint32_t i, uint32_t j, double *f)
{
    struct solve_options how = { .tolerance = 1e-6, .iterations = 1, .threads = 1, .unit = 1 };
    struct solve s;
    const char *cause;
    if (trial->method->kind == BY_ORACLE) {
        if (stability_solve(&s, scene, trial, 1) < 0)
            return -1;
        *f = stability_exchange(&s, i, j);
        trial->count = (trial->count > 0 ? trial->count : 0) + (double)rays_count(s.problem.rays).rays;
    } else {
        if (solve_open(&s, scene, &how, &cause) < 0)
            return -1;
        *f = visible(&s, trial, i, j)
           * polygon_factor(&s.hierarchy.elements[s.hierarchy.face_element[i]], &s.hierarchy.elements[s.hierarchy.face_element[j]], 1);
    }
    solve_close(&s);
    return 0;
}

enum { RECEIVER, SOURCE, BLOCKER };

/* A receiver of side `size` in z = 0 around (x, 0), a unit source around (0, 0) in z = 2 and a square
 * blocker around (bx, by) in z = 1. */
static int sheltered(struct scene *s, double size, double x, double side, double bx, double by)
{
    uint32_t grey, black;
    if (made_open(s) < 0) {
        made_close(s);
        return -1;
    }
    grey = made_material(s, 0.5, 0);
    black = made_material(s, 0, 0);
    made_quad(s, grey, x - 0.5 * size, -0.5 * size, 0, size, 0, 0, 0, size, 0);
    made_quad(s, grey, -0.5, -0.5, 2, 0, 1, 0, 1, 0, 0);
    made_quad(s, black, bx - 0.5 * side, by - 0.5 * side, 1, side, 0, 0, 0, side, 0);
    return 0;
}

/* How often a blocker that hides a tenth of the source is missed, wherever it stands. */
int stability_tiny_blocker(struct stability_trial *trial)
{
    const double side = 0.5 * sqrt(0.1), clear = known_point(-0.5, 0.5, -0.5, 0.5, 2);
    int n = trial->method->kind == BY_ORACLE ? 4 : 12, i, missed = 0;
    for (i = 0; i < n * n; i++) {
        double bx = 0.17 * (2 * (i % n + 0.5) / n - 1), by = 0.17 * (2 * (i / n + 0.5) / n - 1), f;
        struct scene scene;
        int status;
        if (sheltered(&scene, 1e-3, 0, side, bx, by) < 0)
            return -1;
        status = exchange(trial, &scene, RECEIVER, SOURCE, &f);
        made_close(&scene);
        if (status < 0)
            return -1;
        missed += f > 0.99 * clear;
    }
    trial->error = (double)missed / (n * n);
    return 0;
}

int stability_penumbra(struct stability_trial *trial)
{
    static const double at[] = { 0.25, 0.5, 0.6, 0.75, 0.9, 1, 1.25, 1.5 };
    size_t i;
    trial->error = 0;
    for (i = 0; i < sizeof at / sizeof *at; i++) {
        const double source[4] = { -0.5 - at[i], 0.5 - at[i], -0.5, 0.5 }, blocker[4] = { -0.375 - at[i], 0.375 - at[i], -0.375, 0.375 };
        struct scene scene;
        double f;
        int status;
        if (sheltered(&scene, 1e-4, at[i], 0.75, 0, 0) < 0)
            return -1;
        status = exchange(trial, &scene, RECEIVER, SOURCE, &f);
        made_close(&scene);
        if (status < 0)
            return -1;
        trial->error = fmax(trial->error, fabs(f - known_penumbra(source, 2, blocker, 1)));
    }
    return 0;
}

/* Two unit squares, a quarter of the middle plane blocked at a corner. */
int stability_obstructed(struct stability_trial *trial)
{
    struct scene scene;
    double f;
    int status;
    if (made_open(&scene) < 0) {
        made_close(&scene);
        return -1;
    }
    made_material(&scene, 0.5, 0);
    made_quad(&scene, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    made_quad(&scene, 0, 0, 0, 1, 0, 1, 0, 1, 0, 0);
    made_quad(&scene, 0, 0, 0, 0.5, 0.5, 0, 0, 0, 0.5, 0);
    status = exchange(trial, &scene, 0, 1, &f);
    made_close(&scene);
    trial->error = fabs(f - 0.75 * closed_parallel(1, 1, 1));
    return status;
}

/* A dark room from x = 0 to `wall`, a lit one to 2, of walls that end at the dividing wall or go on behind it. The
 * dividing wall has no thickness; `turned`: its front is to the dark side. Faces: 0 dark end, 1 lit end,
 * 2 the dividing wall, then floor, ceiling and sides. */
static int two_rooms(struct scene *s, double wall, int turned, int whole)
{
    uint32_t grey, lamp;
    int part;
    if (made_open(s) < 0) {
        made_close(s);
        return -1;
    }
    grey = made_material(s, 0.7, 0);
    lamp = made_material(s, 0.5, 10);
    made_quad(s, grey, 0, 0, 0, 0, 1, 0, 0, 0, 1);
    made_quad(s, lamp, 2, 0, 0, 0, 0, 1, 0, 1, 0);
    if (turned)
        made_quad(s, grey, wall, 0, 0, 0, 0, 1, 0, 1, 0);
    else
        made_quad(s, grey, wall, 0, 0, 0, 1, 0, 0, 0, 1);
    for (part = 0; part < 2 - whole; part++) {
        double x = part ? wall : 0, length = whole ? 2 : part ? 2 - wall : wall;
        made_quad(s, grey, x, 0, 0, length, 0, 0, 0, 1, 0);
        made_quad(s, grey, x, 0, 1, 0, 1, 0, length, 0, 0);
        made_quad(s, grey, x, 0, 0, 0, 0, 1, length, 0, 0);
        made_quad(s, grey, x, 1, 0, length, 0, 0, 0, 0, 1);
    }
    return 0;
}

/* The largest B of leaves that lie wholly beyond x, over the mean of all faces' B. */
static double leak(const struct solve *s, double x)
{
    double most = 0, power = 0, area = 0;
    uint32_t i, j;
    for (i = 0; i < s->hierarchy.count; i++) {
        const struct element *e = &s->hierarchy.elements[i];
        int beyond = e->centre[0] < x - 1e-9;
        if (!e->vertices || e->children)
            continue;
        for (j = 0; j < e->vertices; j++)
            beyond &= e->vertex[j][0] <= x + 1e-9;
        power += e->area * s->state.radiosity[i];
        area += e->area;
        if (beyond)
            most = fmax(most, s->state.radiosity[i]);
    }
    return most / (power / area);
}

/* Solve two rooms and find the light that came through. */
static int leaked(struct stability_trial *trial, double wall, int turned, int whole, double *error)
{
    struct scene scene;
    struct solve s;
    if (two_rooms(&scene, wall, turned, whole) < 0)
        return -1;
    if (trial->method->kind == BY_RAYS) {
        int status = exchange(trial, &scene, 0, 1, error);
        made_close(&scene);
        return status;
    }
    if ((trial->method != &stability_methods[UNCUT] && scene_cut(&scene, 0) < 0) || stability_solve(&s, &scene, trial, 0) < 0) {
        made_close(&scene);
        return -1;
    }
    *error = leak(&s, wall);
    trial->count = (double)s.refinement.link_count;
    solve_close(&s);
    made_close(&scene);
    return 0;
}

int stability_thin_wall(struct stability_trial *trial)
{
    double front, back;
    if (leaked(trial, 1, 0, 0, &front) < 0 || leaked(trial, 1, 1, 0, &back) < 0)
        return -1;
    trial->error = fmax(front, back);
    return 0;
}

int stability_wall_in_floor(struct stability_trial *trial)
{
    return leaked(trial, 0.73, 0, 1, &trial->error);
}

/* A lit box with a shelf in it, and a square that looks at it from outside; all moved by (away, away, away). */
static int box_far_off(struct scene *s, double away)
{
    uint32_t m[6], i, j;
    int k;
    if (made_open(s) < 0) {
        made_close(s);
        return -1;
    }
    made_material(s, 0.6, 0);
    made_material(s, 0.2, 10);
    for (i = 0; i < 6; i++)
        m[i] = i == 1;
    made_room(s, m, 4, 5, 3);
    made_quad(s, 0, -1, 1, 1, 0, 2, 0, 0, 0, 1); /* outside, front to the box */
    made_quad(s, 0, 1, 1, 1.03, 2, 0, 0.2, 0, 2, 0); /* the shelf, not quite level: top and underside */
    made_quad(s, 0, 1, 1, 1, 0, 2, 0, 2, 0, 0.2);
    for (i = 0; i < s->face_count; i++)
        for (j = 0; j < s->faces[i].vertices; j++)
            for (k = 0; k < 3; k++)
                s->faces[i].vertex[j][k] += away;
    return 0;
}

/* The irradiance that reaches outside, or the change of any face's that the move makes, whichever is worse. */
static int moved_by(struct stability_trial *trial, double away)
{
    enum { OUTSIDE = 6, SHELF = 7, FLOOR = 0, CEILING = 1 };
    struct scene here, there;
    struct solve a, b;
    double f[4];
    uint32_t i;
    int status = -1;
    if (box_far_off(&here, 0) < 0)
        return -1;
    if (box_far_off(&there, away) < 0) {
        made_close(&here);
        return -1;
    }
    if (trial->method->kind == BY_RAYS) {
        status = exchange(trial, &here, SHELF, CEILING, &f[0]) < 0 || exchange(trial, &there, SHELF, CEILING, &f[1]) < 0
              || exchange(trial, &there, OUTSIDE, 5, &f[2]) < 0 ? -1 : 0;
        trial->error = fmax(fabs(f[1] / f[0] - 1), f[2] / f[0]);
    } else if (stability_solve(&a, &here, trial, 0) == 0) {
        if (stability_solve(&b, &there, trial, 0) == 0) {
            trial->error = stability_radiosity(&b, OUTSIDE) / stability_radiosity(&b, FLOOR);
            for (i = 0; i < here.face_count; i++)
                if (i != OUTSIDE)
                    trial->error = fmax(trial->error, fabs(stability_radiosity(&b, i) / stability_radiosity(&a, i) - 1));
            status = 0;
            solve_close(&b);
        }
        solve_close(&a);
    }
    made_close(&here);
    made_close(&there);
    return status;
}

int stability_far_from_zero(struct stability_trial *trial)
{
    return moved_by(trial, 1048576);
}
