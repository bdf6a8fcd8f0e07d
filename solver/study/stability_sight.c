/* stability_sight.c - cases about visibility: small blockers, walls without thickness, walls that
 * stand in an element, coordinates far from zero.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>
#include "study/stability.h"
#include "study/stability_known.h"
#include "terms/visibility.h"
#include "tools/exact_visibility.h"

/* Occlusion one face after the other: by fronts alone, or from coordinates rounded to single
 * precision and a fixed distance kept, as programs do that fail. */
struct simple_host {
    struct host host; /* first */
    const struct made_scene *scene;
    int single;
};

/* Where a fixed distance that suits a scene of a few metres is kept whatever the coordinates
 * (m). */
#define FIXED_OFFSET 1e-4

static int meets_triangle(const double from[3], const double along[3], const double *a,
                          const double *b, const double *c, double least, int fronts)
{
    double u[3], v[3], w[3], p[3], q[3], n[3];
    sub3(u, b, a);
    sub3(v, c, a);
    sub3(w, from, a);
    cross3(n, u, v);
    if (fronts && dot3(n, along) >= 0)
        return 0;
    cross3(p, along, v);
    double det = dot3(u, p);
    if (det == 0)
        return 0;
    double x = dot3(w, p) / det;
    cross3(q, w, u);
    double y = dot3(along, q) / det;
    double t = dot3(v, q) / det;
    return x >= 0 && y >= 0 && x + y <= 1 && t > least && t < 1 - least;
}

static void round_to_single(double out[3], const double v[3], int single)
{
    for (int k = 0; k < 3; k++)
        out[k] = single ? (double)(float)v[k] : v[k];
}

static uint64_t simple_occluded(const struct host *host, int count, const struct segment *segments)
{
    const struct simple_host *h = (const struct simple_host *)(const void *)host;
    const struct made_scene *scene = h->scene;
    uint64_t hits = 0;
    for (int i = 0; i < count; i++) {
        double from[3], to[3], along[3];
        round_to_single(from, segments[i].from, h->single);
        round_to_single(to, segments[i].to, h->single);
        sub3(along, to, from);
        double least = h->single ? FIXED_OFFSET / length3(along) : 0;
        for (uint32_t f = 0, first = 0; f < scene->count; first += scene->size[f++]) {
            double v[4][3];
            for (uint32_t j = 0; j < scene->size[f]; j++)
                round_to_single(v[j], scene->position[first + j], h->single);
            for (uint32_t j = 2; j < scene->size[f]; j++)
                if (meets_triangle(from, along, v[0], v[j - 1], v[j], least, !h->single))
                    hits |= (uint64_t)1 << i;
        }
    }
    return hits;
}

/* Visible fraction between two elements by the trial's BY_RAYS method. */
static double visible(const struct made_scene *scene, const struct host *host,
                      struct stability_trial *trial, const struct element *receiver,
                      const struct element *emitter)
{
    int rays = trial->method->number;
    struct simple_host simple = {*host, scene, rays == BY_FLOAT};
    struct discussion d = {.receiver = receiver, .emitter = emitter};
    d.host = rays == BY_FRONTS || rays == BY_FLOAT ? &simple.host : host;
    if (rays == BY_INTEGRAL) {
        (void)tool_exact_visibility(&d);
        return d.terms.visibility;
    }
    simple.host.occluded = simple_occluded;
    if (simple.single)
        simple.host.ray_offset = FIXED_OFFSET;
    if (rays <= 0)
        return term_visibility(&d, VISIBILITY_RAYS_64);
    trial->work = rays << 2 * trial->level;
    return term_visibility(&d, visibility_level_of(rays << 2 * trial->level));
}

/* F V from face i to face j by the trial's method, any kind. Returns 0 or -1. */
static int exchange(struct stability_trial *trial, const struct made_scene *scene, uint32_t i,
                    uint32_t j, double *f)
{
    struct solved s;
    if (trial->method->kind == BY_ORACLE) {
        if (stability_solve(&s, scene, trial, 1) < 0)
            return -1;
        *f = stability_exchange(&s, i, j);
        trial->count = (trial->count > 0 ? trial->count : 0) + (double)s.report.rays;
    } else {
        if (stability_unsolved(&s, scene) < 0)
            return -1;
        *f = visible(scene, radGetHost(s.solution), trial, stability_face(&s, i),
                     stability_face(&s, j))
             * polygon_factor(stability_face(&s, i), stability_face(&s, j), 1);
    }
    solved_close(&s);
    return 0;
}

enum { RECEIVER, SOURCE, BLOCKER };

/* A receiver of side `size` in z = 0 around (x, 0), a unit source around (0, 0) in z = 2 and a
 * square blocker around (bx, by) in z = 1. */
static struct made_scene sheltered(double size, double x, double side, double bx, double by)
{
    struct made_scene s = {.count = 0};
    uint32_t grey = made_material(&s, 0.5, 0), black = made_material(&s, 0, 0);
    made_quad(&s, grey, x - 0.5 * size, -0.5 * size, 0, size, 0, 0, 0, size, 0);
    made_quad(&s, grey, -0.5, -0.5, 2, 0, 1, 0, 1, 0, 0);
    made_quad(&s, black, bx - 0.5 * side, by - 0.5 * side, 1, side, 0, 0, 0, side, 0);
    return s;
}

/* How often a blocker that hides a tenth of the source is missed, wherever it stands. */
int stability_tiny_blocker(struct stability_trial *trial)
{
    const double side = 0.5 * sqrt(0.1), clear = known_point(-0.5, 0.5, -0.5, 0.5, 2);
    int n = trial->method->kind == BY_ORACLE ? 4 : 12, missed = 0;
    for (int i = 0; i < n * n; i++) {
        double bx = 0.17 * (2 * (i % n + 0.5) / n - 1), by = 0.17 * (2 * (i / n + 0.5) / n - 1), f;
        const struct made_scene scene = sheltered(1e-3, 0, side, bx, by);
        if (exchange(trial, &scene, RECEIVER, SOURCE, &f) < 0)
            return -1;
        missed += f > 0.99 * clear;
    }
    trial->error = (double)missed / (n * n);
    return 0;
}

int stability_penumbra(struct stability_trial *trial)
{
    static const double at[] = {0.25, 0.5, 0.6, 0.75, 0.9, 1, 1.25, 1.5};
    trial->error = 0;
    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
        const double source[4] = {-0.5 - at[i], 0.5 - at[i], -0.5, 0.5},
                     blocker[4] = {-0.375 - at[i], 0.375 - at[i], -0.375, 0.375};
        const struct made_scene scene = sheltered(1e-4, at[i], 0.75, 0, 0);
        double f;
        if (exchange(trial, &scene, RECEIVER, SOURCE, &f) < 0)
            return -1;
        trial->error = fmax(trial->error, fabs(f - known_penumbra(source, 2, blocker, 1)));
    }
    return 0;
}

/* Two unit squares, a quarter of the middle plane blocked at a corner. */
int stability_obstructed(struct stability_trial *trial)
{
    struct made_scene scene = {.count = 0};
    made_material(&scene, 0.5, 0);
    made_quad(&scene, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    made_quad(&scene, 0, 0, 0, 1, 0, 1, 0, 1, 0, 0);
    made_quad(&scene, 0, 0, 0, 0.5, 0.5, 0, 0, 0, 0.5, 0);
    double f;
    if (exchange(trial, &scene, 0, 1, &f) < 0)
        return -1;
    trial->error = fabs(f - 0.75 * closed_parallel(1, 1, 1));
    return 0;
}

/* A dark room from x = 0 to `wall`, a lit one to 2, of walls that end at the dividing wall or go on
 * behind it. The dividing wall has no thickness; `turned`: its front is to the dark side. Faces: 0
 * dark end, 1 lit end, 2 the dividing wall, then floor, ceiling and sides. */
static struct made_scene two_rooms(double wall, int turned, int whole)
{
    struct made_scene s = {.count = 0};
    uint32_t grey = made_material(&s, 0.7, 0), lamp = made_material(&s, 0.5, 10);
    made_quad(&s, grey, 0, 0, 0, 0, 1, 0, 0, 0, 1);
    made_quad(&s, lamp, 2, 0, 0, 0, 0, 1, 0, 1, 0);
    if (turned)
        made_quad(&s, grey, wall, 0, 0, 0, 0, 1, 0, 1, 0);
    else
        made_quad(&s, grey, wall, 0, 0, 0, 1, 0, 0, 0, 1);
    for (int part = 0; part < 2 - whole; part++) {
        double x = part ? wall : 0, length = whole ? 2 : part ? 2 - wall : wall;
        made_quad(&s, grey, x, 0, 0, length, 0, 0, 0, 1, 0);
        made_quad(&s, grey, x, 0, 1, 0, 1, 0, length, 0, 0);
        made_quad(&s, grey, x, 0, 0, 0, 0, 1, length, 0, 0);
        made_quad(&s, grey, x, 1, 0, length, 0, 0, 0, 0, 1);
    }
    return s;
}

/* The largest B of leaves that lie wholly beyond x, over the mean of all faces' B. */
static double leak(const struct solved *s, double x)
{
    double most = 0, power = 0, area = 0;
    for (uint32_t i = 0; i < s->elements.count; i++) {
        const struct element *e = &s->elements.elements[i];
        int beyond = e->centre[0] < x - 1e-9;
        if (!e->vertices || e->children)
            continue;
        for (uint32_t j = 0; j < e->vertices; j++)
            beyond &= e->vertex[j][0] <= x + 1e-9;
        power += e->area * s->elements.radiosity[i];
        area += e->area;
        if (beyond)
            most = fmax(most, s->elements.radiosity[i]);
    }
    return most / (power / area);
}

/* Solve two rooms and find the light that came through. */
static int leaked(struct stability_trial *trial, double wall, int turned, int whole, double *error)
{
    struct made_scene scene = two_rooms(wall, turned, whole);
    if (trial->method->kind == BY_RAYS)
        return exchange(trial, &scene, 0, 1, error);
    scene.as_given = trial->method == &stability_methods[UNCUT];
    struct solved s;
    if (stability_solve(&s, &scene, trial, 0) < 0)
        return -1;
    *error = leak(&s, wall);
    trial->count = (double)s.links.count;
    solved_close(&s);
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

/* A lit box with a shelf in it, and a square that looks at it from outside; all moved by (away,
 * away, away). */
static struct made_scene box_far_off(double away)
{
    static const uint32_t material[6] = {0, 1, 0, 0, 0, 0};
    struct made_scene s = {.count = 0};
    made_material(&s, 0.6, 0);
    made_material(&s, 0.2, 10);
    made_room(&s, material, 4, 5, 3);
    made_quad(&s, 0, -1, 1, 1, 0, 2, 0, 0, 0, 1); /* outside, front to the box */
    /* the shelf, not quite level: top and underside */
    made_quad(&s, 0, 1, 1, 1.03, 2, 0, 0.2, 0, 2, 0);
    made_quad(&s, 0, 1, 1, 1, 0, 2, 0, 2, 0, 0.2);
    made_move(&s, away);
    return s;
}

/* The irradiance that reaches outside, or the change of any face's that the move makes,
 * whichever is worse. */
static int moved_by(struct stability_trial *trial, double away)
{
    enum { OUTSIDE = 6, SHELF = 7, FLOOR = 0, CEILING = 1 };
    const struct made_scene here = box_far_off(0), there = box_far_off(away);
    struct solved a, b;
    if (trial->method->kind == BY_RAYS) {
        double f[3];
        if (exchange(trial, &here, SHELF, CEILING, &f[0]) < 0
            || exchange(trial, &there, SHELF, CEILING, &f[1]) < 0
            || exchange(trial, &there, OUTSIDE, 5, &f[2]) < 0)
            return -1;
        trial->error = fmax(fabs(f[1] / f[0] - 1), f[2] / f[0]);
        return 0;
    }
    if (stability_solve(&a, &here, trial, 0) < 0)
        return -1;
    if (stability_solve(&b, &there, trial, 0) < 0) {
        solved_close(&a);
        return -1;
    }
    trial->error = stability_radiosity(&b, OUTSIDE) / stability_radiosity(&b, FLOOR);
    for (uint32_t i = 0; i < here.count; i++)
        if (i != OUTSIDE)
            trial->error = fmax(trial->error,
                                fabs(stability_radiosity(&b, i) / stability_radiosity(&a, i) - 1));
    solved_close(&a);
    solved_close(&b);
    return 0;
}

int stability_far_from_zero(struct stability_trial *trial)
{
    return moved_by(trial, 1048576);
}
