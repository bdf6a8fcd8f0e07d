/* check_path_mending.c - polygons told by paths: as good as the interval that is told of them, and
 * taken where they are cheap.
 *
 * Under a sky that is the same everywhere a convex body receives what the sky emits, on all of it.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <stdio.h>
#include "engine/mend_solution.h"
#include "engine/mended_error.h"
#include "engine/path_mending.h"
#include "engine/reflected_light.h"
#include "engine/solve_tracer.h"
#include "kernel/constants.h"
#include "runtime/make_known.h"
#include "runtime/make_solve.h"
#include "suite.h"

static char *coarse[] = {"min_share=0.004", NULL};
static const struct mending_goal goal = {
    .noise = 0.0065, .most = 1 << 23, .places = 0.065, .least = 1 << 17};

/* A black sky so large on a side (m), which emits 1 W/m2; in its middle a grey box of 1 m. */
static void box_under_sky(struct scene *s, double side)
{
    uint32_t sky[6] = {0, 0, 0, 0, 0, 0};
    made_open(s);
    made_material(s, 0, 1);
    made_material(s, 0.6, 0);
    made_room(s, sky, side, side, side);
    const double o = side / 2, p = o + 1;
    made_quad(s, 1, o, o, o, 0, 1, 0, 1, 0, 0);
    made_quad(s, 1, o, o, p, 1, 0, 0, 0, 1, 0);
    made_quad(s, 1, o, o, o, 1, 0, 0, 0, 0, 1);
    made_quad(s, 1, o, p, o, 0, 0, 1, 1, 0, 0);
    made_quad(s, 1, o, o, o, 0, 0, 1, 0, 1, 0);
    made_quad(s, 1, p, o, o, 0, 1, 0, 0, 0, 1);
}

/* Of 1e5 particles from a sky of 100 m some meet the box, of one of 10 km none does, which is no
 * proof that there is no light, nor that paths, which see it, are wrong. */
START_TEST(test_sky)
{
    static const double side[] = {100, 10000};
    struct scene scene;
    struct solve s;
    struct measured_error alone, error;
    const char *cause;
    box_under_sky(&scene, side[_i]);
    solve_with(&s, &scene, "power", RELEASE_FLAT, NULL, quick(2));
    /* links of the sky are as right as they are coarse: let them be wrong */
    for (uint32_t f = 6; f < 12; f++)
        s.state.irradiance[s.hierarchy.face_element[f]] *= f % 2 ? 1.3 : 0.8;
    ck_assert_int_eq(measure_and_mend(&s, &goal, &alone, &cause), 0);
    ck_assert_int_eq(s.by_paths, 1);
    ck_assert_int_eq(alone.by_paths, 1);
    ck_assert_double_gt(alone.faces.l1.low, 0.15);
    for (uint32_t f = 6; f < 12; f++)
        ck_assert_double_eq_tol(s.mended.irradiance[s.hierarchy.face_element[f]], 1, 0.03);
    printf("a box under a sky: %.2g rays\n", (double)alone.rays);
    ck_assert_uint_lt(alone.rays, 1000000);
    ck_assert_int_eq(measure_error(&s, 100000, 1, 0, &error, &cause), 0);
    ck_assert_int_eq(error.by_paths, 1);
    ck_assert_double_lt(error.faces.l1.high, 0.05);
    ck_assert_int_eq(measured_elements(&s, &error), 0);
    ck_assert_ptr_nonnull(error.elements.error);
    measured_error_free(&error);
    measured_error_free(&alone);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* The box under a sky of 100 m, each face cut in tiles x tiles. */
static void solve_tiles(struct solve *s, struct scene *scene, int tiles)
{
    const uint32_t sky[6] = {0, 0, 0, 0, 0, 0};
    made_open(scene);
    made_material(scene, 0, 1);
    made_material(scene, 0.6, 0);
    made_room(scene, sky, 100, 100, 100);
    for (int i = 0; i < 6 * tiles * tiles; i++)
        made_tile(scene, 1, 50, i % 6, i / 6, tiles, 0);
    solve_with(s, scene, "power", RELEASE_FLAT, NULL, quick(2));
}

/* The box in tiles; links are off by 2 % at one tile in four. Paths end when
 * mending leaves as little as is asked for, which is long before their own noise is that small. */
START_TEST(test_left)
{
    enum { TILES = 12, FACES = 6 * TILES * TILES };
    double rays[2];
    for (int looked_at = 0; looked_at < 2; looked_at++) {
        struct mending_goal wanted = goal;
        struct scene scene;
        struct solve s;
        struct measured_error alone;
        const char *cause;
        solve_tiles(&s, &scene, TILES);
        for (uint32_t e = 0; e < s.hierarchy.count; e++) {
            const uint32_t f = s.hierarchy.elements[e].face;
            if (s.hierarchy.elements[e].vertices && f >= 6)
                s.state.irradiance[e] = f % 4 ? 1 : 1.02;
        }
        wanted.plain = 1 << 18;
        wanted.left = looked_at ? 0.006 : 0;
        wanted.noise = 0.003;
        ck_assert_int_eq(measure_and_mend(&s, &wanted, &alone, &cause), 0);
        ck_assert_int_eq(s.by_paths, 1);
        double off = 0;
        for (uint32_t f = 6; f < 6 + FACES; f++)
            off += fabs(s.mended.irradiance[s.hierarchy.face_element[f]] - 1) / FACES;
        rays[looked_at] = (double)alone.rays;
        printf("a box of tiles under a sky: %.2g rays, off by %.2g\n", rays[looked_at], off);
        ck_assert_double_le(off, 1.15 * 0.006); /* it is an estimate, of one run */
        measured_error_free(&alone);
        solve_close(&s);
        made_close(&scene);
    }
    ck_assert_double_lt(rays[1], rays[0] / 2);
}
END_TEST

/* Where noise is never as small as is asked for, paths end by the rays that there may be, wherever
 * that lies between blocks of all faces. */
START_TEST(test_most)
{
    enum { TILES = 8 };
    struct mending_goal wanted = goal;
    struct scene scene;
    struct solve s;
    struct measured_error alone;
    const char *cause;
    solve_tiles(&s, &scene, TILES);
    wanted.noise = 1e-5;
    wanted.most = (uint64_t)(900000 * (1 + _i / 8.0));
    ck_assert_int_eq(measure_and_mend(&s, &wanted, &alone, &cause), 0);
    ck_assert_int_eq(s.by_paths, 1);
    ck_assert_uint_gt(alone.rays, wanted.most / 2);
    ck_assert_uint_lt(alone.rays, wanted.most + wanted.most / 4);
    measured_error_free(&alone);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Blocks of 1 m on a ground of 20 m under a sky not much larger: by a block of paths for each face
 * they take .6 of the rays of particles, by four a fifth, and a ninth in the end. */
START_TEST(test_second_look)
{
    enum { BLOCKS = 10 };
    const double side = 32, low = BLOCKS - side / 2;
    struct scene scene;
    struct solve s;
    struct measured_error alone;
    const char *cause;
    made_open(&scene);
    made_material(&scene, 0.5, 0);
    made_material(&scene, 0, 100);
    made_quad(&scene, 0, 0, 0, 0, 2 * BLOCKS, 0, 0, 0, 2 * BLOCKS, 0);
    for (int i = 0; i < BLOCKS * BLOCKS; i++) {
        const double x = i % BLOCKS * 2 + 0.5, y = (double)(i / BLOCKS) * 2 + 0.5;
        made_quad(&scene, 0, x, y, 1, 1, 0, 0, 0, 1, 0);
        made_quad(&scene, 0, x, y, 0, 1, 0, 0, 0, 0, 1);
        made_quad(&scene, 0, x + 1, y, 0, 0, 1, 0, 0, 0, 1);
        made_quad(&scene, 0, x + 1, y + 1, 0, -1, 0, 0, 0, 0, 1);
        made_quad(&scene, 0, x, y + 1, 0, 0, -1, 0, 0, 0, 1);
    }
    made_quad(&scene, 1, low, low, 3 + side / 4, 0, side, 0, side, 0, 0);
    solve_with(&s, &scene, "power", RELEASE_FLAT, coarse, quick(2));
    ck_assert_int_eq(measure_and_mend(&s, &goal, &alone, &cause), 0);
    ck_assert_int_eq(s.by_paths, 1);
    printf("blocks under a sky: %.2g rays\n", (double)alone.rays);
    measured_error_free(&alone);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* A lamp in a room of white walls: light that has been reflected many times. */
START_TEST(test_room)
{
    struct scene scene;
    struct solve s;
    struct measured_error alone;
    const char *cause;
    const uint32_t walls[6] = {0, 0, 0, 0, 0, 0};
    made_open(&scene);
    made_material(&scene, 0.85, 0);
    made_material(&scene, 0, 100);
    made_room(&scene, walls, 4, 5, 2.5);
    made_quad(&scene, 1, 2, 2, 2.45, 0, 0.1, 0, 0.1, 0, 0);
    solve_with(&s, &scene, "power", RELEASE_FLAT, NULL, quick(2));
    ck_assert_int_eq(measure_and_mend(&s, &goal, &alone, &cause), 0);
    ck_assert_int_eq(s.by_paths, 0);
    measured_error_free(&alone);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* A scene, and a look at it by so many particles of each replicate. */
struct looked {
    struct scene scene;
    struct solve solve;
    struct tracer tracer;
    struct tally particles;
};

/* The scene is made. */
static void look(struct looked *l, uint64_t particles)
{
    solve_with(&l->solve, &l->scene, "power", RELEASE_FLAT, NULL, quick(1));
    l->tracer = solve_tracer(&l->solve);
    ck_assert_int_eq(tracer_open(&l->tracer), 0);
    ck_assert_int_eq(tally_open(&l->particles, &l->tracer, 1, 0), 0);
    ck_assert_int_eq(tally_trace(&l->particles, &l->tracer, particles, NULL), 0);
}

static void look_under_sky(struct looked *l, uint64_t particles)
{
    box_under_sky(&l->scene, 100);
    look(l, particles);
}

static void looked_close(struct looked *l)
{
    tally_close(&l->particles);
    tracer_close(&l->tracer);
    solve_close(&l->solve);
    made_close(&l->scene);
}

/* The walls of a room in tiles, whiter: paths take tens of rays each, and a look no more than its
 * share of what particles are to take all the same. */
START_TEST(test_white_room)
{
    enum { TILES = 10 };
    struct mending_goal wanted = goal;
    struct looked l;
    struct path_tally y = {.tally = {0}};
    double times, alone;
    made_open(&l.scene);
    made_material(&l.scene, 0.97, 0);
    made_material(&l.scene, 0.97, 100);
    for (int i = 0; i < 6 * TILES * TILES; i++)
        made_tile(&l.scene, i == 0, 0, i % 6, i / 6, TILES, 1);
    look(&l, 400);
    wanted.most = 1 << 30;
    ck_assert_int_eq(mended_error_times(&l.solve, &l.particles, &wanted, &times, &alone), 0);
    ck_assert_int_eq(path_mending_trace(&y, &l.solve, &l.tracer, &l.particles, &wanted, NULL), 0);
    const double cost = alone * (double)l.particles.rays;
    printf("a white room: a look of %.2g rays, particles take %.2g\n", (double)y.tally.rays, cost);
    ck_assert_double_le((double)y.tally.rays, 1.2 * cost / PATHS_LOOK);
    path_tally_close(&y);
    looked_close(&l);
}
END_TEST

/* Do paths mend, if particles have seen `times` as much light as they have? */
static int paths_mend(struct looked *l, double times)
{
    struct path_tally y;
    const double power = l->particles.power;
    l->particles.power *= times;
    const int mend = path_mending_trace(&y, &l->solve, &l->tracer, &l->particles, &goal, NULL);
    path_tally_close(&y);
    l->particles.power = power;
    return mend;
}

/* Where particles see ten times the light that paths do, paths are not believed, however sure they
 * are. */
START_TEST(test_other_light)
{
    struct looked l;
    look_under_sky(&l, 20000);
    ck_assert_int_eq(paths_mend(&l, 1), 1);
    ck_assert_int_eq(paths_mend(&l, 10), 0);
    looked_close(&l);
}
END_TEST

/* So few particles meet the box that a fifth of what paths see may be chance, though replicates,
 * most of which have none, seem to know better. */
START_TEST(test_few_particles)
{
    struct looked l;
    double variance;
    look_under_sky(&l, 1000);
    const double light = reflected_light(&l.solve.problem, &l.particles, &variance);
    printf("%.2g +- %.2g of 3.6 W by few particles\n", light, sqrt(variance));
    ck_assert_int_eq(paths_mend(&l, 0.2 * 0.6 * 6 / light), 1);
    looked_close(&l);
}
END_TEST

/* Particles would need a thousand times the rays that there may be. These are a fifth of what is
 * worth a look where particles could do; where they cannot a look may be half of them, no more. */
START_TEST(test_few_rays)
{
    static const uint64_t most[] = {4000, 2000};
    struct mending_goal wanted = goal;
    struct looked l;
    struct path_tally y = {.tally = {0}};
    look_under_sky(&l, 20000);
    wanted.most = most[_i];
    ck_assert_int_eq(path_mending_trace(&y, &l.solve, &l.tracer, &l.particles, &wanted, NULL),
                     _i == 0);
    ck_assert_int_eq(y.tally.rays > 0, _i == 0);
    path_tally_close(&y);
    looked_close(&l);
}
END_TEST

/* Is the L1 error of light that is off by `off` of itself within what paths say of it? */
static int covered(const struct solve *s, const double *truth, const struct tally *y, double off,
                   struct chance *c)
{
    const struct problem *p = &s->problem;
    const struct hierarchy *h = &s->hierarchy;
    const uint32_t bands = p->bands;
    double *solved = calloc((size_t)h->count * bands, sizeof *solved), wrong = 0, all = 0;
    double *polygon = calloc((size_t)p->scene->input_count * bands, sizeof *polygon);
    struct face_error m;
    for (uint32_t f = 0; f < h->face_count; f++)
        for (uint32_t k = 0; k < bands; k++) {
            const double H = truth[f * bands + k],
                         changed = H * fmax(0, 1 + off * chance_normal(c));
            const double area = p->reflectance[f * bands + k] * hierarchy_surface(h, f)->area;
            solved[h->face_element[f] * bands + k] = changed;
            polygon[h->faces[f].input * bands + k] += area * (changed - H);
            all += area * H;
        }
    for (uint32_t i = 0; i < p->scene->input_count * bands; i++)
        wrong += fabs(polygon[i]) / all;
    ck_assert_int_eq(face_error_open(&m, p, h, solved, y), 0);
    int in = wrong >= m.l1.low - 1e-9 && wrong <= m.l1.high + 1e-9;
    face_error_close(&m);
    free(polygon);
    free(solved);
    return in;
}

START_TEST(test_coverage)
{
    static const double off[] = {0, 0.01, 0.05, 0.3};
    const int problems = thorough() ? 300 : 60;
    int trials = 0, missed = 0;
    for (int i = 0; i < problems; i++) {
        struct chance chance = {hash64(77 + (uint64_t)i)};
        struct scene scene;
        struct solve s;
        struct path_tally y;
        struct solve_options o = quick(1);
        const char *cause;
        double *truth = known_open(&scene, (enum known)(i % KNOWN_KINDS), &chance);
        ck_assert_int_eq(solve_open(&s, &scene, &o, &cause), 0);
        struct tracer t = solve_tracer(&s);
        t.threads = 1;
        ck_assert_int_eq(tracer_open(&t), 0);
        ck_assert_int_eq(path_tally_open(&y, &t, path_mending_stream((uint64_t)i)), 0);
        double *nothing = calloc((size_t)s.hierarchy.count * scene.bands, sizeof *nothing);
        ck_assert_int_eq(path_tally_trace(&y, &t, nothing,
                                          (uint64_t)(i % 2 ? 1 : 200) * scene.input_count, NULL),
                         0);
        for (int n = 0; n < 4; n++, trials++)
            missed += !covered(&s, truth, &y.tally, off[n], &chance);
        free(nothing);
        free(truth);
        path_tally_close(&y);
        tracer_close(&t);
        solve_close(&s);
        made_close(&scene);
    }
    printf("%d of %d intervals miss the truth\n", missed, trials);
    /* trials of one tally are not independent */
    ck_assert_double_le(missed, trials * (0.08 + 3 * sqrt(0.05 * 0.95 * 4 / trials)));
}
END_TEST

/* A lamp of 1 m2 over its like, so far away that of 64 directions most find it never: what these
 * bring, F of all light, is missing then in every replicate alike. */
START_TEST(test_rarely_met)
{
    static const struct {
        double apart, F; /* by the closed form */
    } cases[] = {{3, 0.032971397219}, {6, 0.008681966049}, {12, 0.002200311594}};
    enum { STREAMS = 100 };
    const double rho = 0.5, F = cases[_i].F, truth[2] = {0, F};
    struct scene scene;
    struct solve s;
    struct chance chance = {1};
    int missed = 0, outside = 0;
    made_open(&scene);
    made_material(&scene, 0, 1);
    made_material(&scene, rho, 0);
    made_quad(&scene, 0, 0, 0, cases[_i].apart, 0, 1, 0, 1, 0, 0);
    made_quad(&scene, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    solve_with(&s, &scene, "power", RELEASE_FLAT, NULL, quick(1));
    struct tracer t = solve_tracer(&s);
    ck_assert_int_eq(tracer_open(&t), 0);
    for (uint64_t i = 0; i < STREAMS; i++) {
        struct path_tally y;
        double variance;
        ck_assert_int_eq(path_tally_open(&y, &t, path_mending_stream(i)), 0);
        ck_assert_int_eq(path_tally_trace(&y, &t, s.state.irradiance, 1, NULL), 0);
        const double off = reflected_light(&s.problem, &y.tally, &variance) - rho * F;
        missed += off * off > PATHS_AGREE * PATHS_AGREE * variance;
        outside += !covered(&s, truth, &y.tally, 0, &chance);
        path_tally_close(&y);
    }
    printf("F %.4f: %d sums and %d intervals of %d miss the truth\n", F, missed, outside, STREAMS);
    ck_assert_int_le(missed, 2);
    ck_assert_int_le(outside, 5 + 3 * 2);
    tracer_close(&t);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* The same counts for any number of threads and of pieces. */
START_TEST(test_same)
{
    struct scene scene;
    struct solve s;
    struct path_tally y[2];
    box_under_sky(&scene, 100);
    solve_with(&s, &scene, "power", RELEASE_FLAT, coarse, quick(1));
    for (int i = 0; i < 2; i++) {
        struct tracer t = solve_tracer(&s);
        t.threads = 1 + 2 * i;
        ck_assert_int_eq(tracer_open(&t), 0);
        ck_assert_int_eq(path_tally_open(&y[i], &t, 1), 0);
        for (uint64_t paths = i ? 100 : 20000; paths <= 20000; paths += 9950)
            ck_assert_int_eq(path_tally_trace(&y[i], &t, s.state.irradiance, paths, NULL), 0);
        tracer_close(&t);
    }
    ck_assert_uint_eq(y[0].tally.rays, y[1].tally.rays);
    for (uint32_t f = 0; f < y[0].tally.faces; f++)
        for (int r = 0; r < REPLICATES; r++)
            ck_assert(tally_face(&y[0].tally, r, f, 0) == tally_face(&y[1].tally, r, f, 0));
    path_tally_close(&y[0]);
    path_tally_close(&y[1]);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("polygons by paths");
    TCase *c = tcase_create("paths");
    tcase_set_timeout(c, thorough() ? 600 : 60);
    tcase_add_loop_test(c, test_sky, 0, 2);
    tcase_add_loop_test(c, test_most, 0, 8);
    tcase_add_test(c, test_left);
    tcase_add_test(c, test_second_look);
    tcase_add_test(c, test_room);
    tcase_add_test(c, test_white_room);
    tcase_add_test(c, test_other_light);
    tcase_add_test(c, test_few_particles);
    tcase_add_loop_test(c, test_few_rays, 0, 2);
    tcase_add_test(c, test_coverage);
    tcase_add_loop_test(c, test_rarely_met, 0, 3);
    tcase_add_test(c, test_same);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
