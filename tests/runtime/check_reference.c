/* check_reference.c - references: right where the answer is known, as sure as they say, and the
 * same bits however they were come by.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "engine/reference.h"
#include "runtime/path_reference.h"
#include "scene/make_scene.h"
#include "scene/read_scene.h"
#include "suite.h"

enum { RUNS = 40 };

static void read_file(struct scene *scene, const char *path)
{
    const struct scene_options how = {.quiet = 1};
    ck_assert_int_eq(scene_read(scene, path, &how), 0);
}

static void open_reference(struct reference *r, const struct scene *scene, int threads)
{
    const char *cause;
    ck_assert_int_eq(reference_open(r, scene, threads, NULL, &cause), 0);
}

static void trace(struct reference *r, uint64_t particles, uint64_t paths)
{
    ck_assert_int_eq(tally_trace(&r->tally, &r->tracer, particles / REPLICATES, NULL), 0);
    ck_assert_int_eq(face_paths_trace(&r->paths, &r->tracer, paths, NULL), 0);
}

/* Closed, all of E = 1 and rho = 1/2: H = E / (1 - rho) = 2 everywhere, by any method. */
START_TEST(furnace)
{
    struct scene scene;
    struct reference r;
    read_file(&scene, "examples/scenes/furnace.obj");
    open_reference(&r, &scene, 2);
    trace(&r, 1 << 18, 1 << 17);
    double mean[16], variance[16];
    ck_assert_uint_le(scene.input_count, 16);
    const struct RadMaterial *m = &scene.materials[scene.faces[0].material];
    double h = m->exitance[0] / (1 - m->reflectance[0]);
    for (enum reference_method way = 0; way < REFERENCE_METHODS;
         way = (enum reference_method)(way + 1)) {
        ck_assert_int_eq(reference_irradiance(&r, way, 0, mean, variance), 0);
        for (uint32_t i = 0; i < scene.input_count; i++) {
            /* of sixteen replicates once in 6,000 */
            ck_assert_double_eq_tol(mean[i], h, 5 * sqrt(variance[i]));
            ck_assert_double_lt(sqrt(variance[i]), 0.01 * h);
        }
    }
    struct reference_summary s;
    ck_assert_int_eq(reference_summary(&r, &s), 0);
    ck_assert_double_eq_tol(s.reflected, s.emitted / (1 / m->reflectance[0] - 1),
                            5e-3 * s.reflected);
    ck_assert_double_le(fabs(s.difference), 4 * s.deviation);
    reference_close(&r);
    scene_free(&scene);
}
END_TEST

/* Scatter of RUNS values over the variance told of them; 0 where they are all 0. */
static double scatter(const double *value, size_t stride, double told)
{
    double middle = 0, spread = 0;
    for (int run = 0; run < RUNS; run++)
        middle += value[(size_t)run * stride] / RUNS;
    for (int run = 0; run < RUNS; run++)
        spread += pow(value[(size_t)run * stride] - middle, 2) / (RUNS - 1);
    return middle > 0 ? spread / told : 0;
}

/* Runs that share no random number scatter about their mean as each says of itself. */
START_TEST(as_sure_as_it_says)
{
    struct scene scene;
    read_file(&scene, "examples/scenes/cornell.obj");
    size_t n = scene.input_count;
    double *mean[REFERENCE_METHODS], *told[REFERENCE_METHODS],
        *variance = calloc(n, sizeof(double));
    for (int way = 0; way < REFERENCE_METHODS; way++) {
        mean[way] = calloc(RUNS * n, sizeof(double));
        told[way] = calloc(n, sizeof(double));
    }
    double chi = 0, off = 0, outside = 0, bias = 0;
    for (size_t run = 0; run < RUNS; run++) {
        struct reference r;
        struct reference_summary s;
        open_reference(&r, &scene, 2);
        r.tally.stream += 1000 + run;
        r.paths.stream += (1 + run) << 33;
        trace(&r, 1 << 15, 1 << 13);
        for (int way = 0; way < REFERENCE_METHODS; way++) {
            ck_assert_int_eq(reference_irradiance(&r, (enum reference_method)way, 1,
                                                  mean[way] + run * n, variance),
                             0);
            for (size_t i = 0; i < n; i++)
                told[way][i] += variance[i] / RUNS;
        }
        ck_assert_int_eq(reference_summary(&r, &s), 0);
        chi += s.chi_square / RUNS;
        bias += s.difference / s.deviation / RUNS;
        off += pow(s.difference / s.deviation, 2) / RUNS;
        outside += fabs(s.difference) > 1.96 * s.deviation;
        reference_close(&r);
    }
    for (int way = 0; way < REFERENCE_METHODS; way++) {
        double sum = 0;
        int known = 0;
        for (size_t i = 0; i < n; i++) {
            double each = scatter(mean[way] + i, n, told[way][i]);
            sum += each;
            known += each > 0;
        }
        printf("method %d: scatter over what is told %.3f, %d faces\n", way, sum / known, known);
        ck_assert_int_ge(known, 20);
        /* a variance from RUNS values is known to root (2 / RUNS); of 20 faces, some go together */
        ck_assert_double_eq_tol(sum / known, 1, 0.15);
        free(mean[way]);
        free(told[way]);
    }
    printf("difference: mean %.2f, mean square %.2f, outside 95 %%: %g of %d; chi-square %.3f\n",
           bias, off, outside, RUNS, chi);
    ck_assert_double_lt(fabs(bias), 3 / sqrt(RUNS));
    ck_assert_double_eq_tol(off, 1, 3 * sqrt(2. / RUNS));
    ck_assert_double_le(outside, 0.05 * RUNS + 3 * sqrt(0.05 * RUNS));
    ck_assert_double_eq_tol(chi, 1, 0.2);
    free(variance);
    scene_free(&scene);
}
END_TEST

/* A unit room of tiles x tiles tiles a wall, the first of the ceiling a lamp. */
static void tiled_room(struct scene *scene, int tiles, double rho)
{
    const uint32_t wall = made_material(scene, rho, 0), lamp = made_material(scene, rho, 1);
    for (int face = 0; face < 6; face++)
        for (int i = 0; i < tiles * tiles; i++)
            made_tile(scene, face == 5 && i == 0 ? lamp : wall, 0, face, i, tiles, 1);
}

/* A room of TILES x TILES tiles a wall, one of them a lamp, of which few particles and few paths
 * know little each. A closed room absorbs what is emitted: whatever the noise of its faces, their
 * sum is right within what is told of it. */
START_TEST(no_bias)
{
    enum { TILES = 16 };
    struct scene scene;
    struct reference r;
    const double rho = 0.6, side = 1. / TILES;
    made_open(&scene);
    tiled_room(&scene, TILES, rho);
    double *mean = calloc(scene.input_count, sizeof *mean),
           *variance = calloc(scene.input_count, sizeof *variance);
    ck_assert(mean && variance);
    for (int many = 1; many <= 4; many *= 4) {
        open_reference(&r, &scene, 2);
        trace(&r, (uint64_t)(1 << 14) * (unsigned)many, (uint64_t)(1 << 16) * (unsigned)many);
        struct reference_summary s;
        ck_assert_int_eq(reference_summary(&r, &s), 0);
        for (enum reference_method way = 0; way < REFERENCE_METHODS;
             way = (enum reference_method)(way + 1)) {
            double absorbed = 0, chance = 0;
            ck_assert_int_eq(reference_irradiance(&r, way, 0, mean, variance), 0);
            for (uint32_t i = 0; i < scene.input_count; i++) {
                const double share = (1 - rho) * side * side;
                absorbed += share * mean[i];
                chance += share * share * variance[i];
            }
            printf("method %d, noise %.3f: %.4f of what is emitted is absorbed, deviation %.4f\n",
                   way, s.noise[way], absorbed / s.emitted, sqrt(chance) / s.emitted);
            ck_assert_double_eq_tol(absorbed, s.emitted, 4 * sqrt(chance));
            ck_assert_double_lt(sqrt(chance), 0.04 * s.emitted); /* or it says nothing */
        }
        reference_close(&r);
    }
    free(mean);
    free(variance);
    made_close(&scene);
}
END_TEST

/* A sheet of 2 m under a black lamp, bent by .1 mm one way or the other, is as bright as a flat
 * one: what it reflects leaves. As one quad its ridge was farther up than rays start, and half of
 * them met it from below. */
START_TEST(bent_sheet)
{
    enum { WAYS = 3 };
    static const uint32_t around[8] = {0, 1, 2, 3, 4, 5, 6, 7}, of[2] = {0, 1};
    static const struct RadMaterial material[2] = {{{0.8, 0.8, 0.8}, {0, 0, 0}, 1},
                                                   {{0, 0, 0}, {1, 1, 1}, 0}};
    double mean[WAYS][2], variance[WAYS][2];
    for (int way = 0; way < WAYS; way++) {
        const double bend = 1e-4 * (way - 1),
                     at[24] = {0, 0, bend, 2, 0, -bend, 2, 2, bend, 0, 2, -bend,
                               0, 0, 1,    0, 2, 1,     2, 2, 1,    2, 0, 1};
        const struct RadPolygons sheet = {.positions = at,
                                          .position_count = 8,
                                          .indices = around,
                                          .materials = of,
                                          .size = 4,
                                          .count = 2};
        struct scene scene;
        struct scene_error error;
        struct reference r;
        ck_assert_int_eq(scene_build(&scene, &sheet, material, 2, 1, &error), 0);
        open_reference(&r, &scene, 1);
        trace(&r, 1 << 18, 1 << 14);
        ck_assert_int_eq(reference_irradiance(&r, REFERENCE_PARTICLES, 0, mean[way], variance[way]),
                         0);
        reference_close(&r);
        scene_free(&scene);
    }
    for (int way = 0; way < WAYS; way += 2)
        ck_assert_double_eq_tol(mean[way][0], mean[1][0],
                                5 * sqrt(variance[way][0] + variance[1][0]));
}
END_TEST

/* A strip of lamps, w wide, before a wall at the distance g. Of what it sends rho K comes back to
 * it, K the integral of F^2 over w, F how much of the wall's hemisphere it fills: per length, as
 * both are long. Where rays start off their surfaces by 2^-18 of the scene's size, which is a
 * thirteenth of the gap, they are not to see a gap that is narrower by it: 5 % more would come
 * back. */
START_TEST(near_a_wall)
{
    const double length = 20, w = 2e-3, g = 1e-3, rho = 0.5, step = 1e-6;
    double fills = 0;
    for (double x = step / 2; x < 0.5; x += step) {
        const double F =
            ((x + w / 2) / hypot(x + w / 2, g) - (x - w / 2) / hypot(x - w / 2, g)) / 2;
        fills += 2 * F * F * step / w;
    }
    struct scene scene;
    struct reference r;
    double mean[2], variance[2];
    made_open(&scene);
    made_quad(&scene, made_material(&scene, rho, 0), 0, -1, 0, length, 0, 0, 0, 2, 0);
    made_quad(&scene, made_material(&scene, 1e-6, 1), 0, -w / 2, g, 0, w, 0, length, 0, 0);
    open_reference(&r, &scene, 2);
    trace(&r, 1 << 21, 1 << 18);
    for (enum reference_method way = 0; way < REFERENCE_METHODS;
         way = (enum reference_method)(way + 1)) {
        ck_assert_int_eq(reference_irradiance(&r, way, 0, mean, variance), 0);
        printf("on a strip near a wall, by method %d: %.5f (%.5f), %.5f\n", way, mean[1],
               sqrt(variance[1]), rho * fills);
        ck_assert_double_eq_tol(mean[1], rho * fills, 5 * sqrt(variance[1]) + 3e-3 * rho * fills);
        if (way != REFERENCE_PATHS) /* few of these start on the strip */
            ck_assert_double_lt(sqrt(variance[1]), 5e-3 * rho * fills);
    }
    reference_close(&r);
    made_close(&scene);
}
END_TEST

/* The tiled room with a wall through its middle that has a hole of one tile. Few paths from behind
 * the wall find it, and what these know of their noise is next to nothing. Tiles there are as far
 * from what many more particles say as they say themselves, and no farther than by particles
 * alone. */
START_TEST(through_a_hole)
{
    enum { TILES = 8, FEW = 16 };
    const double hole[2] = {3. / TILES, 4. / TILES}, middle = 0.5;
    struct scene scene;
    struct reference r;
    made_open(&scene);
    tiled_room(&scene, TILES, 0.6);
    const double strips[4][4] = {/* y and z: below and above the hole, and beside it */
                                 {0, 1, 0, hole[0]},
                                 {0, 1, hole[1], 1},
                                 {0, hole[0], hole[0], hole[1]},
                                 {hole[1], 1, hole[0], hole[1]}};
    for (int back = 0; back < 2; back++)
        for (int i = 0; i < 4; i++) {
            const double *at = strips[i], wide = at[1] - at[0], high = at[3] - at[2];
            made_quad(&scene, 0, middle, at[0], at[2], 0, back ? 0 : wide, back ? high : 0, 0,
                      back ? wide : 0, back ? 0 : high);
        }
    double *mean = calloc(scene.input_count, sizeof *mean),
           *variance = calloc(scene.input_count, sizeof *variance),
           *truth = calloc(scene.input_count, sizeof *truth),
           *doubt = calloc(scene.input_count, sizeof *doubt);
    ck_assert(mean && variance && truth && doubt);
    open_reference(&r, &scene, 2);
    trace(&r, 1 << 22, 0);
    ck_assert_int_eq(reference_irradiance(&r, REFERENCE_PARTICLES, 0, truth, doubt), 0);
    reference_close(&r);
    double chi[REFERENCE_METHODS] = {0}, off[REFERENCE_METHODS] = {0}, sum[REFERENCE_METHODS] = {0},
           told[REFERENCE_METHODS] = {0}, compared = 0;
    int dark = 0;
    for (unsigned run = 1; run <= FEW; run++) {
        open_reference(&r, &scene, 2);
        r.tally.stream += run;
        r.paths.stream += (uint64_t)run << 33;
        trace(&r, 1 << 18, 1 << 14);
        for (enum reference_method way = 0; way < REFERENCE_METHODS;
             way = (enum reference_method)(way + 1)) {
            ck_assert_int_eq(reference_irradiance(&r, way, 0, mean, variance), 0);
            for (uint32_t i = 0; i < 6 * TILES * TILES; i++) {
                const double d = mean[i] - truth[i];
                if (!(tracer_surface(&r.tracer, i)->centre[0] > middle))
                    continue;
                dark += way == REFERENCE_BOTH;
                chi[way] += d * d / (variance[i] + doubt[i]);
                off[way] += d * d;
                sum[way] += fabs(d);
                told[way] += variance[i] + doubt[i];
            }
        }
        struct reference_summary summary;
        ck_assert_int_eq(reference_summary(&r, &summary), 0);
        compared += (double)summary.compared;
        reference_close(&r);
    }
    printf("behind a hole %g tiles that both are said to know well\n", compared / FEW);
    ck_assert_double_lt(compared / FEW, 1);
    for (int way = 0; way < REFERENCE_METHODS; way++)
        printf("behind a hole by method %d, %d tiles: squares over what is told %.2f, in all %.2f; "
               "over those by particles %.2f, moduli %.3f\n",
               way, dark, chi[way] / dark, off[way] / told[way], off[way] / off[0],
               sum[way] / sum[0]);
    ck_assert_double_eq_tol(chi[REFERENCE_BOTH] / dark, 1, 0.2);
    ck_assert_double_lt(sum[REFERENCE_BOTH], 1.05 * sum[REFERENCE_PARTICLES]);
    free(mean);
    free(variance);
    free(truth);
    free(doubt);
    made_close(&scene);
}
END_TEST

/* Another program's particles, of which nothing is shared but Embree. */
START_TEST(as_others_find)
{
    struct scene scene;
    struct reference r;
    read_file(&scene, "examples/scenes/room.obj");
    open_reference(&r, &scene, 2);
    trace(&r, 1 << 18, 1 << 16);
    uint32_t bands = scene.bands;
    double *other = calloc((size_t)scene.face_count * bands, sizeof *other),
           *noise = calloc((size_t)scene.face_count * bands, sizeof *noise),
           *mean = calloc(scene.input_count, sizeof *mean),
           *variance = calloc(scene.input_count, sizeof *variance),
           *sum = calloc(scene.input_count, sizeof *sum),
           *area = calloc(scene.input_count, sizeof *area);
    path_reference(&scene, 1 << 18, other, noise);
    double mine = 0, theirs = 0, worst = 0;
    for (uint32_t b = 0; b < bands; b++) {
        ck_assert_int_eq(reference_irradiance(&r, REFERENCE_BOTH, b, mean, variance), 0);
        memset(sum, 0, scene.input_count * sizeof *sum);
        memset(area, 0, scene.input_count * sizeof *area);
        for (uint32_t i = 0; i < scene.face_count; i++) {
            double a = tracer_surface(&r.tracer, i)->area;
            sum[scene.faces[i].input] += a * other[(size_t)i * bands + b];
            area[scene.faces[i].input] += a;
        }
        for (uint32_t i = 0; i < scene.input_count; i++) {
            mine += area[i] * mean[i];
            theirs += sum[i];
            if (area[i] > 5) /* m2; both know them to a percent or so */
                worst = fmax(worst, fabs(area[i] * mean[i] / sum[i] - 1));
        }
    }
    printf("room: %.4f W received, by others %.4f; walls differ by %.2f %% at the most\n", mine,
           theirs, 100 * worst);
    ck_assert_double_eq_tol(mine, theirs, 5e-3 * mine);
    ck_assert_double_lt(worst, 0.02);
    free(other);
    free(noise);
    free(mean);
    free(variance);
    free(sum);
    free(area);
    reference_close(&r);
    scene_free(&scene);
}
END_TEST

static unsigned char *state_of(const struct reference *r)
{
    unsigned char *bytes = malloc(reference_state_size(r));
    ck_assert_ptr_nonnull(bytes);
    reference_state(r, bytes);
    return bytes;
}

static void same_state(const struct reference *a, const struct reference *b)
{
    unsigned char *x = state_of(a), *y = state_of(b);
    ck_assert_uint_eq(reference_state_size(a), reference_state_size(b));
    ck_assert(memcmp(x, y, reference_state_size(a)) == 0);
    free(x);
    free(y);
}

START_TEST(same_bits)
{
    struct scene scene;
    struct reference whole, other;
    const char *cause;
    read_file(&scene, "examples/scenes/room.obj");
    open_reference(&whole, &scene, 1);
    trace(&whole, 1 << 14, 20000);
    trace(&whole, 3 << 14, 50000);
    open_reference(&other, &scene, 3); /* threads; paths in other pieces */
    ck_assert_int_eq(face_paths_trace(&other.paths, &other.tracer, 33333, NULL), 0);
    trace(&other, 1 << 14, 20000);
    trace(&other, 3 << 14, 50000);
    same_state(&whole, &other);
    reference_close(&other);
    open_reference(&other, &scene, 2); /* saved between */
    trace(&other, 1 << 14, 20000);
    unsigned char *bytes = state_of(&other);
    size_t size = reference_state_size(&other);
    reference_close(&other);
    open_reference(&other, &scene, 2);
    ck_assert_int_eq(reference_restore(&other, bytes, size, &cause), 0);
    trace(&other, 3 << 14, 50000);
    same_state(&whole, &other);
    double *mean = malloc(4 * scene.input_count * sizeof *mean);
    for (size_t i = 0; i < 2; i++)
        ck_assert_int_eq(reference_irradiance(i ? &whole : &other, REFERENCE_BOTH, 2,
                                              mean + 2 * i * scene.input_count,
                                              mean + (2 * i + 1) * scene.input_count),
                         0);
    ck_assert(memcmp(mean, mean + 2 * scene.input_count, 2 * scene.input_count * sizeof *mean)
              == 0);
    free(mean);
    /* what is damaged, short, or of another scene changes nothing */
    static const size_t places[] = {0, 3, 9, 40, 200, 4000};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        bytes[places[i]] ^= 4;
        ck_assert_int_eq(reference_restore(&other, bytes, size, &cause), -1);
        bytes[places[i]] ^= 4;
    }
    for (size_t cut = 0; cut < size; cut += 1 + size / 50)
        ck_assert_int_eq(reference_restore(&other, bytes, cut, &cause), -1);
    same_state(&whole, &other);
    reference_close(&other);
    struct scene cornell;
    read_file(&cornell, "examples/scenes/cornell.obj");
    open_reference(&other, &cornell, 2);
    ck_assert_int_eq(reference_restore(&other, bytes, size, &cause), -1);
    ck_assert_ptr_nonnull(strstr(cause, "another scene"));
    ck_assert_uint_eq(other.tally.particles, 0);
    reference_close(&other);
    scene.materials[scene.faces[0].material].reflectance[0] *= 0.5; /* another light */
    open_reference(&other, &scene, 2);
    ck_assert_int_eq(reference_restore(&other, bytes, size, &cause), -1);
    reference_close(&other);
    reference_close(&whole);
    free(bytes);
    scene_free(&cornell);
    scene_free(&scene);
}
END_TEST

/* Without light, without reflection, of a polygon without area: exact, and no nan. */
START_TEST(nothing_to_find)
{
    for (int lamp = 0; lamp < 2; lamp++) {
        struct scene scene;
        struct reference r;
        struct reference_summary s;
        double mean[4], variance[4];
        made_open(&scene);
        made_material(&scene, 0, lamp);
        made_material(&scene, lamp ? 0 : 0.5, 0);
        made_quad(&scene, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0);
        made_quad(&scene, 0, 0, 0, 1, 0, 1, 0, 1, 0, 0);
        open_reference(&r, &scene, 1);
        trace(&r, 1 << 12, 1 << 12);
        for (enum reference_method way = 0; way < REFERENCE_METHODS;
             way = (enum reference_method)(way + 1)) {
            ck_assert_int_eq(reference_irradiance(&r, way, 0, mean, variance), 0);
            for (int i = 0; i < 2; i++)
                ck_assert(isfinite(mean[i]) && isfinite(variance[i]) && (lamp || mean[i] == 0));
        }
        ck_assert_int_eq(reference_summary(&r, &s), 0);
        ck_assert_double_eq(s.reflected, 0);
        for (int way = 0; way < REFERENCE_METHODS; way++)
            ck_assert_double_eq(s.noise[way], 0);
        ck_assert(isfinite(s.chi_square) && isfinite(s.deviation));
        reference_close(&r);
        scene_free(&scene);
    }
}
END_TEST

/* What was not traced is not known, nor is the difference of one method from nothing. */
START_TEST(not_traced)
{
    struct scene scene;
    struct reference r;
    struct reference_summary s;
    double mean[16], variance[16];
    const int particles = _i & 1, paths = _i >> 1;
    const int known[REFERENCE_METHODS] = {particles, paths, particles || paths};
    read_file(&scene, "examples/scenes/furnace.obj");
    open_reference(&r, &scene, 2);
    trace(&r, particles ? 1 << 14 : 0, paths ? 1 << 12 : 0);
    ck_assert_int_eq(reference_summary(&r, &s), 0);
    for (int way = 0; way < REFERENCE_METHODS; way++) {
        ck_assert_int_eq(isfinite(s.noise[way]), known[way]);
        ck_assert_int_eq(reference_irradiance(&r, (enum reference_method)way, 0, mean, variance),
                         0);
        ck_assert_int_eq(isfinite(variance[0]), known[way]);
    }
    ck_assert_int_eq(isfinite(s.deviation), particles && paths);
    ck_assert(s.compared == 0 || (particles && paths));
    ck_assert_int_eq(s.unseen > 0, !particles && !paths);
    ck_assert_double_le(s.unseen, s.emitted);
    reference_close(&r);
    scene_free(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("reference");
    TCase *c = tcase_create("reference");
    tcase_set_timeout(c, 300);
    tcase_add_test(c, furnace);
    tcase_add_test(c, as_sure_as_it_says);
    tcase_add_test(c, no_bias);
    tcase_add_test(c, bent_sheet);
    tcase_add_test(c, near_a_wall);
    tcase_add_test(c, through_a_hole);
    tcase_add_test(c, as_others_find);
    tcase_add_test(c, same_bits);
    tcase_add_test(c, nothing_to_find);
    tcase_add_loop_test(c, not_traced, 0, 4);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
