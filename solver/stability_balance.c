/* stability_balance.c - cases about the whole: rows, bright scenes, open scenes, and solutions that are known.
 *
 * Sources: white furnace and sphere from their closed forms; plates, cube and cube cavity from converged solutions
 * of the integral equation, cross-checked by a second method.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>
#include "make_scene.h"
#include "oracles.h"
#include "stability.h"
#include "stability_known.h"

static int begin(struct scene *s)
{
    if (made_open(s) == 0)
        return 0;
    made_close(s);
    return -1;
}

/* Solve and close the scene; the solution keeps pointing at it for its faces' inputs alone, which nobody here reads. */
static int solved(struct stability_trial *trial, struct scene *scene, struct solve *s)
{
    int status = stability_solve(s, scene, trial, 0);
    if (status == 0)
        trial->count = (double)s->refinement.link_count;
    return status;
}

/* The sum of F over a cube's face by a BY_FACTOR method, from one element per face: to the opposite face in [0], to
 * one of the four beside it in [1]. */
static int cube_factors(const struct stability_method *method, double f[2])
{
    const uint32_t grey[6] = { 0, 0, 0, 0, 0, 0 };
    struct scene scene;
    struct hierarchy h;
    if (begin(&scene) < 0)
        return -1;
    made_material(&scene, 0.5, 0);
    made_room(&scene, grey, 1, 1, 1);
    if (hierarchy_build(&h, scene.faces, scene.face_count) < 0) {
        made_close(&scene);
        return -1;
    }
    f[0] = stability_factor(method, &h.elements[h.face_element[0]], &h.elements[h.face_element[1]]);
    f[1] = stability_factor(method, &h.elements[h.face_element[0]], &h.elements[h.face_element[2]]);
    hierarchy_free(&h);
    made_close(&scene);
    return 0;
}

/* The largest |B (1 - rho) / E - 1| over the leaves of a furnace with E = 1. */
static double furnace_error(const struct solve *s, double rho)
{
    double worst = 0;
    uint32_t i;
    for (i = 0; i < s->hierarchy.count; i++)
        if (s->hierarchy.elements[i].vertices)
            worst = fmax(worst, fabs(s->radiosity[i] * (1 - rho) - 1));
    return worst;
}

/* By symmetry all six B of the cube are equal, B = 1 + rho sum B. */
static int furnace(struct stability_trial *trial, double rho)
{
    const uint32_t white[6] = { 0, 0, 0, 0, 0, 0 };
    struct scene scene;
    struct solve s;
    double f[2];
    int status;
    if (trial->method->kind == BY_FACTOR) {
        if (cube_factors(trial->method, f) < 0)
            return -1;
        trial->error = fabs((1 - rho) / (1 - rho * (f[0] + 4 * f[1])) - 1);
        if (rho * (f[0] + 4 * f[1]) >= 1)
            trial->error = INFINITY; /* every reflection adds power: no iteration ends */
        return 0;
    }
    if (begin(&scene) < 0)
        return -1;
    made_material(&scene, rho, 1);
    made_room(&scene, white, 1, 1, 1);
    status = solved(trial, &scene, &s);
    if (status == 0) {
        trial->error = furnace_error(&s, rho);
        solve_close(&s);
    }
    made_close(&scene);
    return status;
}

int stability_furnace_95(struct stability_trial *trial)
{
    return furnace(trial, 0.95);
}

int stability_furnace_98(struct stability_trial *trial)
{
    return furnace(trial, 0.98);
}

int stability_furnace_99(struct stability_trial *trial)
{
    return furnace(trial, 0.99);
}

/* An L of unit width with legs of 2, height 1: its floor and ceiling are three squares each. */
static int furnace_room(struct stability_trial *trial, int bent, double rho)
{
    static const double at[3][2] = { { 0, 0 }, { 1, 0 }, { 0, 1 } };
    static const double wall[8][4] = { { 0, 0, 1, 0 }, { 1, 0, 1, 0 }, { 2, 0, 0, 1 }, { 2, 1, -1, 0 },
                                       { 1, 1, 0, 1 }, { 1, 2, -1, 0 }, { 0, 2, 0, -1 }, { 0, 1, 0, -1 } };
    struct scene scene;
    struct solve s;
    int i, status;
    if (begin(&scene) < 0)
        return -1;
    made_material(&scene, rho, 1);
    if (bent) {
        for (i = 0; i < 3; i++) {
            made_quad(&scene, 0, at[i][0], at[i][1], 0, 1, 0, 0, 0, 1, 0);
            made_quad(&scene, 0, at[i][0], at[i][1], 1, 0, 1, 0, 1, 0, 0);
        }
        for (i = 0; i < 8; i++) /* counter-clockwise round the room, fronts inward */
            made_quad(&scene, 0, wall[i][0], wall[i][1], 0, 0, 0, 1, wall[i][2], wall[i][3], 0);
    } else {
        const uint32_t white[6] = { 0, 0, 0, 0, 0, 0 };
        made_room(&scene, white, 2, 1, 1);
    }
    status = solved(trial, &scene, &s);
    if (status == 0) {
        trial->error = furnace_error(&s, rho);
        solve_close(&s);
    }
    made_close(&scene);
    return status;
}

int stability_furnace_box(struct stability_trial *trial)
{
    return furnace_room(trial, 0, 0.99);
}

int stability_furnace_L(struct stability_trial *trial)
{
    return furnace_room(trial, 1, 0.99);
}

/* A furnace cube solved with other sweeps than the default. Returns 0 or -1. */
static int sweep_furnace(struct stability_trial *trial, double rho, struct solve_options how, double *error, int *sweeps)
{
    const uint32_t white[6] = { 0, 0, 0, 0, 0, 0 };
    struct refiner *refiner = oracles_open("bf_guarded", RELEASE_FLAT);
    struct scene scene;
    struct solve s;
    const char *cause;
    int status = -1;
    if (!refiner || begin(&scene) < 0) {
        refiner_close(refiner);
        return -1;
    }
    (void)refiner_set(refiner, "relative", 1); /* six elements are as good as many here */
    how.threads = trial->threads;
    made_material(&scene, rho, 1);
    made_room(&scene, white, 1, 1, 1);
    if (solve_open(&s, &scene, &how, &cause) == 0) {
        status = solve_run(&s, refiner, &cause);
        *error = furnace_error(&s, rho);
        *sweeps = s.sweeps;
        solve_close(&s);
    }
    refiner_close(refiner);
    made_close(&scene);
    return status;
}

/* What a rule about sweeps makes of rho = .999. */
int stability_near_white(struct stability_trial *trial)
{
    const double rho = 0.999, tolerance = 1e-3;
    struct solve_options how = { .tolerance = tolerance, .iterations = 100000 };
    int sweeps;
    if (trial->method == &stability_methods[JACOBI]) {
        how.jacobi = 1;
        how.iterations = 100;
    } else if (trial->method == &stability_methods[NAIVE_STOP]) {
        how.jacobi = 1;
        how.tolerance = tolerance * rho / (1 - rho); /* takes back what the solver allows for: stop where dB / B is 1e-3 */
    }
    if (sweep_furnace(trial, rho, how, &trial->error, &sweeps) < 0)
        return -1;
    trial->count = sweeps;
    return 0;
}

/* Sweeps to 1e-3 for rho from .5 to .999, as a share of Jacobi's ln 1e-3 / ln rho. */
int stability_sweeps(struct stability_trial *trial)
{
    static const double rho[] = { 0.5, 0.9, 0.99, 0.999 };
    struct solve_options how = { .tolerance = 1e-3, .iterations = 100000, .jacobi = trial->method == &stability_methods[SWEEPS_JACOBI] };
    size_t i;
    trial->error = 0;
    for (i = 0; i < sizeof rho / sizeof *rho; i++) {
        double error;
        int sweeps;
        if (sweep_furnace(trial, rho[i], how, &error, &sweeps) < 0)
            return -1;
        trial->error = fmax(trial->error, sweeps / ceil(log(1e-3) / log(rho[i])));
        trial->count = sweeps;
    }
    return 0;
}

/* Two unit squares, E = 1, rho = .5: parallel at distance 1, or at right angles with an edge in common. */
static int plates(struct scene *s, int parallel)
{
    if (begin(s) < 0)
        return -1;
    made_material(s, 0.5, 1);
    made_quad(s, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    if (parallel)
        made_quad(s, 0, 0, 0, 1, 0, 1, 0, 1, 0, 0);
    else
        made_quad(s, 0, 0, 0, 0, 0, 0, 1, 1, 0, 0);
    return 0;
}

enum { LEAF = 255 };

/* B of the part of a face that is nearest to p (by its centre): of a leaf, or of what `depth` splits make. */
static double radiosity_at(const struct solve *s, uint32_t face, int depth, double x, double y, double z)
{
    uint32_t e = s->hierarchy.face_element[face];
    const double p[3] = { x, y, z };
    while (s->hierarchy.elements[e].children && s->hierarchy.elements[e].depth < depth) {
        const struct element *x0 = &s->hierarchy.elements[e];
        double best = INFINITY;
        uint32_t c, next = e;
        for (c = 0; c < x0->children; c++) {
            double v[3], square;
            sub3(v, s->hierarchy.elements[x0->child + c].centre, p);
            square = dot3(v, v);
            if (square < best) {
                best = square;
                next = x0->child + c;
            }
        }
        e = next;
    }
    return s->radiosity[(size_t)e * s->bands];
}

int stability_open_plates(struct stability_trial *trial)
{
    const double known = 1.111165244298;
    struct scene scene;
    struct solve s;
    int status;
    if (trial->method == &stability_methods[NORMALISED]) {
        trial->error = 1 / (1 - 0.5) / known - 1; /* with its row made 1 a plate sees nothing but plate */
        return 0;
    }
    if (plates(&scene, 1) < 0)
        return -1;
    status = solved(trial, &scene, &s);
    if (status == 0) {
        trial->error = fmax(fabs(stability_radiosity(&s, 0) / known - 1), fabs(stability_radiosity(&s, 1) / known - 1));
        trial->error = fmax(trial->error, s.absorbed / s.emitted - 1);
        solve_close(&s);
    }
    made_close(&scene);
    return status;
}

int stability_plates_profile(struct stability_trial *trial)
{
    struct scene scene;
    struct solve s;
    int status;
    if (plates(&scene, 1) < 0)
        return -1;
    status = solved(trial, &scene, &s);
    if (status == 0) {
        trial->error = fmax(fabs(radiosity_at(&s, 0, LEAF, 0.5, 0.5, 0) / 1.133303564992 - 1),
                            fmax(fabs(radiosity_at(&s, 0, LEAF, 0.5, 0, 0) / 1.100306232464 - 1), fabs(radiosity_at(&s, 0, LEAF, 0, 0, 0) / 1.076981393145 - 1)));
        solve_close(&s);
    }
    made_close(&scene);
    return status;
}

int stability_plates_edge(struct stability_trial *trial)
{
    struct scene scene;
    struct solve s;
    int status;
    if (plates(&scene, 0) < 0)
        return -1;
    status = solved(trial, &scene, &s);
    if (status == 0) {
        trial->error = fmax(fabs(stability_radiosity(&s, 0) / 1.1159537 - 1), fabs(radiosity_at(&s, 0, LEAF, 0.5, 0, 0) / (1 / (1 - 0.5 * 0.5)) - 1));
        solve_close(&s);
    }
    made_close(&scene);
    return status;
}

/* A unit cube, rho = .5, its ceiling E = 1. With one element per face three unknowns: ceiling, floor, walls. */
int stability_cube(struct stability_trial *trial)
{
    static const double known[3] = { 1.1043616, 0.1712161, 0.1811056 };
    uint32_t m[6] = { 0, 1, 0, 0, 0, 0 };
    struct scene scene;
    struct solve s;
    double b[3] = { 1, 0, 0 }, f[2];
    int i, k, status;
    if (trial->method->kind == BY_FACTOR) {
        if (cube_factors(trial->method, f) < 0)
            return -1;
        for (i = 0; i < 200; i++) {
            double c = 1 + 0.5 * (f[0] * b[1] + 4 * f[1] * b[2]), g = 0.5 * (f[0] * b[0] + 4 * f[1] * b[2]);
            b[2] = 0.5 * (f[1] * (b[0] + b[1] + 2 * b[2]) + f[0] * b[2]);
            b[0] = c;
            b[1] = g;
        }
    } else {
        if (begin(&scene) < 0)
            return -1;
        made_material(&scene, 0.5, 0);
        made_material(&scene, 0.5, 1);
        made_room(&scene, m, 1, 1, 1);
        status = solved(trial, &scene, &s);
        if (status == 0) {
            b[0] = stability_radiosity(&s, 1);
            b[1] = stability_radiosity(&s, 0);
            b[2] = stability_radiosity(&s, 2);
            solve_close(&s);
        }
        made_close(&scene);
        if (status < 0)
            return -1;
    }
    trial->error = 0;
    for (k = 0; k < 3; k++)
        trial->error = fmax(trial->error, fabs(b[k] / known[k] - 1));
    return 0;
}

/* A cube with one face open: the emissivity that the opening seems to have, for walls of .1 and .5. The opening is a
 * black face, and its irradiance the answer. */
int stability_cavity(struct stability_trial *trial)
{
    static const double wall[2] = { 0.1, 0.5 }, known[2] = { 0.3483681, 0.8111445 };
    uint32_t m[6] = { 0, 1, 0, 0, 0, 0 };
    int i;
    trial->error = 0;
    for (i = 0; i < 2; i++) {
        struct scene scene;
        struct solve s;
        double f[2], seen = NAN;
        int status;
        if (trial->method->kind == BY_FACTOR) { /* floor and walls alike see the opening by f[0], f[1]; E = e, two unknowns */
            double b = wall[i], w = wall[i], rho = 1 - wall[i];
            int k;
            if (cube_factors(trial->method, f) < 0)
                return -1;
            for (k = 0; k < 2000; k++) {
                double next = wall[i] + rho * 4 * f[1] * w;
                w = wall[i] + rho * (f[1] * b + (f[0] + 2 * f[1]) * w);
                b = next;
            }
            seen = f[0] * b + 4 * f[1] * w;
        } else {
            if (begin(&scene) < 0)
                return -1;
            made_material(&scene, 1 - wall[i], wall[i]);
            made_material(&scene, 0, 0);
            made_room(&scene, m, 1, 1, 1);
            status = solved(trial, &scene, &s);
            if (status == 0) {
                seen = stability_irradiance(&s, 1);
                solve_close(&s);
            }
            made_close(&scene);
            if (status < 0)
                return -1;
        }
        trial->error = fmax(trial->error, fabs(seen / known[i] - 1));
    }
    return 0;
}

/* Triangles of a sphere seen from inside, or from outside: an octahedron's faces in quarters `level` times.
 * material(context, centre) names each. */
struct sphere {
    double radius;
    int outward;
    uint32_t (*material)(const double centre[3]);
};

static void add_sphere(struct scene *s, const struct sphere *sphere, const double a[3], const double b[3], const double c[3], int level)
{
    double p[3][3], middle[3][3], centre[3];
    int i, k;
    if (level > 0) {
        for (i = 0; i < 3; i++) {
            const double *u = i == 0 ? a : i == 1 ? b : c, *v = i == 0 ? b : i == 1 ? c : a;
            double size;
            for (k = 0; k < 3; k++)
                middle[i][k] = u[k] + v[k];
            size = length3(middle[i]);
            for (k = 0; k < 3; k++)
                middle[i][k] /= size;
        }
        add_sphere(s, sphere, a, middle[0], middle[2], level - 1);
        add_sphere(s, sphere, b, middle[1], middle[0], level - 1);
        add_sphere(s, sphere, c, middle[2], middle[1], level - 1);
        add_sphere(s, sphere, middle[0], middle[1], middle[2], level - 1);
        return;
    }
    for (k = 0; k < 3; k++) {
        p[0][k] = sphere->radius * a[k];
        p[1][k] = sphere->radius * (sphere->outward ? b : c)[k];
        p[2][k] = sphere->radius * (sphere->outward ? c : b)[k];
        centre[k] = a[k] + b[k] + c[k];
    }
    made_face(s, sphere->material(centre), 3, (const double (*)[3])p);
}

static void made_sphere(struct scene *s, const struct sphere *sphere, int level)
{
    int i;
    for (i = 0; i < 8; i++) {
        const double x[3] = { i & 1 ? -1 : 1, 0, 0 }, y[3] = { 0, i & 2 ? -1 : 1, 0 }, z[3] = { 0, 0, i & 4 ? -1 : 1 };
        int even = !(((i & 1) + (i >> 1 & 1) + (i >> 2 & 1)) & 1);
        add_sphere(s, sphere, x, even ? y : z, even ? z : y, level);
    }
}

/* Area mean of B (or of H) over faces from..to of a solution. */
static double mean(const struct solve *s, uint32_t from, uint32_t to, uint32_t material, int irradiance)
{
    double sum = 0, area = 0;
    uint32_t f;
    for (f = from; f < to; f++) {
        uint32_t e = s->hierarchy.face_element[f];
        if (material != UINT32_MAX && s->scene->faces[f].material != material)
            continue;
        sum += s->hierarchy.elements[e].area * (irradiance ? s->irradiance : s->radiosity)[(size_t)e * s->bands];
        area += s->hierarchy.elements[e].area;
    }
    return sum / area;
}

static uint32_t by_octant(const double centre[3])
{
    return (centre[2] > 0) + (centre[0] > 0 ? 2u : 0);
}

static uint32_t first_material(const double centre[3])
{
    (void)centre;
    return 0;
}

static uint32_t second_material(const double centre[3])
{
    (void)centre;
    return 1;
}

/* One number from a sphere of faces; as faces get half as wide its error falls to a quarter, so two levels give
 * what many would tend to. */
static int extrapolated(struct stability_trial *trial, int coarse, int (*at)(struct stability_trial *trial, int level, double *value), double *value)
{
    double low, high;
    if (at(trial, coarse, &low) < 0 || at(trial, coarse + 1, &high) < 0)
        return -1;
    *value = high + (high - low) / 3;
    return 0;
}

/* E = 1 above, rho = .8 on one side and .2 on the other: H = <E> / (1 - <rho>) = 1 in the dark half. */
static int sphere_at(struct stability_trial *trial, int level, double *value)
{
    const struct sphere sphere = { 1, 0, by_octant };
    struct scene scene;
    struct solve s;
    int status;
    if (begin(&scene) < 0)
        return -1;
    made_material(&scene, 0.2, 0);
    made_material(&scene, 0.2, 1);
    made_material(&scene, 0.8, 0);
    made_material(&scene, 0.8, 1);
    made_sphere(&scene, &sphere, level);
    status = solved(trial, &scene, &s);
    if (status == 0) {
        *value = 0.5 * (mean(&s, 0, scene.face_count, 0, 1) + mean(&s, 0, scene.face_count, 2, 1));
        solve_close(&s);
    }
    made_close(&scene);
    return status;
}

int stability_sphere(struct stability_trial *trial)
{
    double h = NAN;
    if (extrapolated(trial, 1, sphere_at, &h) < 0)
        return -1;
    trial->error = fabs(h - 1);
    return 0;
}

/* Half of a sphere open: walls of emissivity .1 seem to have .1 / (.1 + .5 * .9). */
static int hollow_at(struct stability_trial *trial, int level, double *value)
{
    const struct sphere sphere = { 1, 0, by_octant };
    struct scene scene;
    struct solve s;
    int status;
    if (begin(&scene) < 0)
        return -1;
    made_material(&scene, 0, 0);
    made_material(&scene, 0.9, 0.1);
    made_material(&scene, 0, 0);
    made_material(&scene, 0.9, 0.1);
    made_sphere(&scene, &sphere, level);
    status = solved(trial, &scene, &s);
    if (status == 0) {
        *value = 0.5 * (mean(&s, 0, scene.face_count, 1, 0) + mean(&s, 0, scene.face_count, 3, 0));
        solve_close(&s);
    }
    made_close(&scene);
    return status;
}

int stability_hollow_sphere(struct stability_trial *trial)
{
    const double known = 0.1 / (0.1 + 0.5 * 0.9);
    double b = NAN;
    if (extrapolated(trial, 1, hollow_at, &b) < 0)
        return -1;
    trial->error = fabs(b / known - 1);
    return 0;
}

/* Radii 1/2 and 1, E = 1 within, rho = .5: B = 10/9 and 2/9. */
static int inner_at(struct stability_trial *trial, int level, double *value)
{
    const struct sphere inner = { 0.5, 1, first_material }, outer = { 1, 0, second_material };
    struct scene scene;
    struct solve s;
    uint32_t half;
    int status;
    if (begin(&scene) < 0)
        return -1;
    made_material(&scene, 0.5, 1);
    made_material(&scene, 0.5, 0);
    made_sphere(&scene, &inner, level);
    half = scene.face_count;
    made_sphere(&scene, &outer, level);
    status = solved(trial, &scene, &s);
    if (status == 0) {
        *value = mean(&s, half, scene.face_count, UINT32_MAX, 0);
        solve_close(&s);
    }
    made_close(&scene);
    return status;
}

int stability_concentric(struct stability_trial *trial)
{
    double b = NAN;
    if (extrapolated(trial, 1, inner_at, &b) < 0)
        return -1;
    trial->error = fabs(b / (2 / 9.0) - 1);
    return 0;
}

/* Plates of `wide` x `wide` unit squares, so wide that the middle ones see little else, E = 1 and 0, rho = .5 and .8;
 * what those lack of infinite ones falls as 1/wide2. */
static int middle_at(struct stability_trial *trial, int level, double *value)
{
    int wide = 3 << level, i;
    uint32_t middle = (uint32_t)(wide / 2 * wide + wide / 2) * 2;
    struct scene scene;
    struct solve s;
    int status;
    if (begin(&scene) < 0)
        return -1;
    made_material(&scene, 0.5, 1);
    made_material(&scene, 0.8, 0);
    for (i = 0; i < wide * wide; i++) {
        made_quad(&scene, 0, i % wide, i / wide, 0, 1, 0, 0, 0, 1, 0);
        made_quad(&scene, 1, i % wide, i / wide, 1, 0, 1, 0, 1, 0, 0);
    }
    status = solved(trial, &scene, &s);
    if (status == 0) {
        *value = stability_radiosity(&s, middle);
        solve_close(&s);
    }
    made_close(&scene);
    return status;
}

int stability_wide_plates(struct stability_trial *trial)
{
    const double known = (1 + 0.5 * 0) / (1 - 0.5 * 0.8);
    double b = NAN;
    if (extrapolated(trial, 1, middle_at, &b) < 0)
        return -1;
    trial->error = fabs(b / known - 1);
    return 0;
}
