/* check_paths.c - irradiance by paths, against closed forms and against particles.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdlib.h>
#include "make_solve.h"
#include "particles/face_paths.h"
#include "particles/particles.h"
#include "particles/paths.h"
#include "scene/read_scene.h"
#include "kernel/sobol.h"
#include "particles/sobol_sequence.h"
#include "engine/solve_tracer.h"
#include "study/closed_forms.h"
#include "suite.h"

/* A solve that has only been opened, and a tracer through its scene. */
struct traced {
    struct scene scene;
    struct solve solve;
    struct tracer tracer;
};

static void traced_open(struct traced *x, int threads)
{
    const char *cause;
    struct solve_options options = quick(threads);
    ck_assert_int_eq(solve_open(&x->solve, &x->scene, &options, &cause), 0);
    x->tracer = solve_tracer(&x->solve);
    ck_assert_int_eq(tracer_open(&x->tracer), 0);
}

static void traced_close(struct traced *x)
{
    tracer_close(&x->tracer);
    solve_close(&x->solve);
    scene_free(&x->scene);
}

struct estimate {
    double mean[3], se[3];
    uint64_t rays;
};

/* Paths from a point, or with p NULL from points all over the face. */
static struct estimate estimate(const struct traced *x, uint32_t face, const double *p, int paths)
{
    struct estimate e = {{0, 0, 0}, {0, 0, 0}, 0};
    const double offset = rays_host(x->tracer.rays)->ray_offset,
                 *n = tracer_surface(&x->tracer, face)->normal;
    for (int i = 0; i < paths; i++) {
        struct dice dice = dice_of(face, (uint64_t)i);
        double from[3], h[3];
        if (p) {
            for (int k = 0; k < 3; k++)
                from[k] = p[k] + offset * n[k];
        } else {
            double u = dice_throw(&dice), v = dice_throw(&dice);
            tracer_point(&x->tracer, face, u, v, from);
        }
        path_irradiance(&x->tracer, face, from, &dice, h, &e.rays);
        for (uint32_t k = 0; k < x->tracer.bands; k++) {
            e.mean[k] += h[k] / paths;
            e.se[k] += h[k] * h[k] / paths;
        }
    }
    for (uint32_t k = 0; k < x->tracer.bands; k++)
        e.se[k] = sqrt(fmax(e.se[k] - e.mean[k] * e.mean[k], 0) / paths);
    return e;
}

/* Lamps small and large, near and far: down to a millimetre above the point. No path brings more
 * than both its rays may, E each, which bounds the noise of any lamp. */
START_TEST(test_corner)
{
    static const struct {
        double a, b, c, noise; /* of H, by one path */
    } lamps[] = {{1, 1, 1, 2},        {3, 2, 0.1, 2},        {0.01, 0.02, 1, 0.5}, {1, 1, 0.001, 2},
                 {0.001, 4, 0.01, 6}, {1e-3, 1e-3, 1e-3, 2}, {0.3, 0.4, 0.05, 2}};
    for (size_t i = 0; i < sizeof lamps / sizeof *lamps; i++) {
        const double a = lamps[i].a, b = lamps[i].b, c = lamps[i].c, at[3] = {0, 0, 0};
        struct traced x;
        made_open(&x.scene);
        made_material(&x.scene, 0.5, 0);
        made_material(&x.scene, 0, 7);
        made_quad(&x.scene, 0, -1, -1, 0, 2, 0, 0, 0, 2, 0);
        made_quad(&x.scene, 1, 0, 0, c, 0, b, 0, a, 0, 0);
        traced_open(&x, 1);
        struct estimate e = estimate(&x, 0, at, 40000);
        double h = 7 * closed_corner(a, b, c);
        /* the point is taken 2^-18 of the extent in front of the floor */
        ck_assert_double_eq_tol(e.mean[0], h, 4 * e.se[0] + 2e-5 / c * h);
        ck_assert_double_lt(e.se[0], lamps[i].noise * h / sqrt(40000));
        ck_assert_double_lt(e.se[0], sqrt(2 * 7 * h / 40000));
        ck_assert_uint_le(e.rays, 2 * 40000);
        traced_close(&x);
    }
}
END_TEST

/* A unit square that sees another one emit, both black. [Howell, C-11] */
START_TEST(test_squares)
{
    for (double c = 0.03; c < 4; c *= 3) {
        const double f = closed_parallel(1, 1, c);
        struct traced x;
        made_open(&x.scene);
        made_material(&x.scene, 0, 0);
        made_material(&x.scene, 0, 3);
        made_quad(&x.scene, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
        made_quad(&x.scene, 1, 0, 0, c, 0, 1, 0, 1, 0, 0);
        traced_open(&x, 1);
        struct estimate e = estimate(&x, 0, NULL, 40000);
        ck_assert_double_eq_tol(e.mean[0], 3 * f, 4 * e.se[0] + 2e-5 / c * f);
        ck_assert_double_lt(e.se[0], 0.01 * f * 3);
        traced_close(&x);
    }
}
END_TEST

/* Plates so large that the border counts little: light goes to and fro, E / (1 - rho^2) of the
 * dark one's H and rho times that of the other's. */
START_TEST(test_plates)
{
    struct traced x;
    const double at[3] = {0, 0, 0}, over[3] = {0, 0, 1};
    made_open(&x.scene);
    made_material(&x.scene, 0.8, 0);
    made_material(&x.scene, 0.5, 2);
    made_quad(&x.scene, 0, -500, -500, 0, 1000, 0, 0, 0, 1000, 0);
    made_quad(&x.scene, 1, -500, -500, 1, 0, 1000, 0, 1000, 0, 0);
    traced_open(&x, 1);
    struct estimate e = estimate(&x, 0, at, 40000);
    ck_assert_double_eq_tol(e.mean[0], 2 / (1 - 0.4), 4 * e.se[0] + 1e-4);
    e = estimate(&x, 1, over, 40000);
    ck_assert_double_eq_tol(e.mean[0], 1.6 / (1 - 0.4), 4 * e.se[0] + 1e-4);
    traced_close(&x);
}
END_TEST

/* In any closed shape that emits and reflects alike everywhere, H = E / (1 - rho), in each band;
 * no ray misses, and the count is what the header says. */
START_TEST(test_furnace)
{
    static void (*const shapes[])(struct scene *, double) = {furnace_cube, furnace_prism,
                                                             furnace_octahedron};
    for (int i = 0; i < 3; i++) {
        struct traced x;
        shapes[i](&x.scene, 0.7);
        x.scene.bands = 3;
        x.scene.materials[0].reflectance[1] = 0.2;
        x.scene.materials[0].reflectance[2] = 0;
        x.scene.materials[0].exitance[2] = 5;
        traced_open(&x, 1);
        struct estimate e = estimate(&x, 1, NULL, 20000);
        ck_assert_double_eq_tol(e.mean[0], 1 / 0.3, 4 * e.se[0]);
        ck_assert_double_eq_tol(e.mean[1], 1 / 0.8, 4 * e.se[1]);
        ck_assert_double_eq_tol(e.mean[2], 5, 4 * e.se[2] + 1e-9);
        ck_assert_double_lt(e.se[0], 0.03);
        ck_assert_double_le((double)e.rays, 1.05 * 20000 * 2 / 0.3);
        traced_close(&x);
    }
}
END_TEST

/* 2,000 lamps of many sizes, directions and powers, in a hall of 40 x 40 m. */
static void many_lamps(struct scene *s)
{
    uint64_t state = 5;
    made_open(s);
    made_material(s, 0.3, 0);
    for (int m = 0; m < 4; m++)
        made_material(s, 0, pow(5, m));
    made_quad(s, 0, 0, 0, 0, 40, 0, 0, 0, 40, 0);
    for (int i = 0; i < 2000; i++) {
        double r[8];
        for (int k = 0; k < 8; k++)
            r[k] = (double)(hash64(state += HASH_STEP) >> 11) * 0x1p-53;
        double a = 0.002 + 0.02 * r[3], turn = 7 * r[4], x = a * cos(turn), y = a * sin(turn);
        made_quad(s, 1 + (uint32_t)i % 4, 40 * r[0], 40 * r[1], 1 + 4 * r[2], x, y, a * r[5], y, -x,
                  a * r[6]);
    }
}

/* The chance of an emitter is the share of u that chooses it, all chances add to 1, and with it
 * noise is 1.7 of H by one path; by power alone, 3.8. */
START_TEST(test_light_tree)
{
    struct traced x;
    many_lamps(&x.scene);
    traced_open(&x, 1);
    const struct light_tree *tree = &x.tracer.light_tree;
    const double up[3] = {0, 0, 1}, from[3][3] = {{20, 20, 0}, {1, 39, 0}, {7, 9, 3}};
    enum { SHARES = 200000 };
    for (int i = 0; i < 3; i++) {
        double sum = 0;
        int *got = calloc(x.scene.face_count, sizeof *got);
        for (int j = 0; j < SHARES; j++) {
            uint32_t face;
            double chance = light_tree_choose(tree, from[i], up, (j + 0.5) / SHARES, &face);
            if (!(chance > 0)) /* below a node that is in sight no lamp may be */
                continue;
            ck_assert_double_eq_tol(chance, light_tree_chance(tree, from[i], up, face), 1e-12);
            got[face]++;
        }
        for (uint32_t f = 0; f < x.scene.face_count; f++) {
            double chance = light_tree_chance(tree, from[i], up, f);
            ck_assert_double_eq_tol(got[f], chance * SHARES, 2);
            sum += chance;
        }
        ck_assert_double_le(sum, 1 + 1e-9);
        free(got);
    }
    struct estimate e = estimate(&x, 0, from[0], 20000);
    ck_assert_double_lt(e.se[0] / e.mean[0] * sqrt(20000), 2);
    traced_close(&x);
}
END_TEST

/* Nothing emits: 0, and no ray. */
START_TEST(test_dark)
{
    struct traced x;
    furnace_cube(&x.scene, 0.9);
    x.scene.materials[0].exitance[0] = 0;
    traced_open(&x, 1);
    struct estimate e = estimate(&x, 0, NULL, 10);
    ck_assert(e.mean[0] == 0 && e.rays == 0);
    traced_close(&x);
}
END_TEST

/* Chi of paths against particles, face by face and band, by both standard errors: of mean 1 when
 * they agree. */
static double disagreement(struct traced *x, uint64_t particles, int paths)
{
    struct tally tally;
    double sum = 0, worst = 0;
    int count = 0;
    ck_assert_int_eq(tally_open(&tally, &x->tracer, 1, 0), 0);
    ck_assert_int_eq(tally_trace(&tally, &x->tracer, particles, NULL), 0);
    for (uint32_t i = 0; i < x->tracer.hierarchy->face_count; i++) {
        struct estimate e = estimate(x, i, NULL, paths);
        double area = tracer_surface(&x->tracer, i)->area;
        for (uint32_t k = 0; k < x->tracer.bands; k++) {
            double mean = 0, square = 0;
            for (int r = 0; r < REPLICATES; r++) {
                double h = tally_face(&tally, r, i, k) / area;
                mean += h / REPLICATES;
                square += h * h / REPLICATES;
            }
            double variance = (square - mean * mean) / (REPLICATES - 1) + e.se[k] * e.se[k];
            if (!(variance > 0) || mean < 1e-3) /* what is under a box has no light */
                continue;
            double z = (e.mean[k] - mean) / sqrt(variance);
            sum += z * z;
            worst = fmax(worst, fabs(z));
            count++;
        }
    }
    tally_close(&tally);
    ck_assert_int_ge(count, 12);
    ck_assert_double_lt(worst, 5.5);
    return sum / count;
}

/* Shadows, two-sided lamps, colour: as particles find, which know nothing of light sampling. */
START_TEST(test_particles)
{
    struct traced x;
    furnished(&x.scene, 1); /* its lamp: two one-sided faces back to back at one place */
    traced_open(&x, 1);
    double chi = disagreement(&x, 4000, 4000);
    ck_assert_double_lt(chi, 1.7);
    traced_close(&x);
    ck_assert_int_eq(
        scene_read(&x.scene, "examples/scenes/cornell.obj", &(struct scene_options){0}), 0);
    traced_open(&x, 1);
    chi = disagreement(&x, 8000, 4000);
    ck_assert_double_lt(chi, 1.7);
    traced_close(&x);
    for (int i = 0; i < 2 && thorough(); i++) {
        static const char *const paths[] = {"examples/scenes/room.obj", "tests/runtime/panels.obj"};
        ck_assert_int_eq(scene_read(&x.scene, paths[i], &(struct scene_options){0}), 0);
        traced_open(&x, 1);
        chi = disagreement(&x, 100000, 40000);
        ck_assert_double_lt(chi, 1.3);
        traced_close(&x);
    }
}
END_TEST

/* Paths of a face that sees a lamp, in the second case each half of it half the lamp, as a wall
 * stands between, by points of a sequence: replicates tell how far their mean is off, and it is
 * nearer than that of as many by chance. */
START_TEST(test_sequence)
{
    enum { STREAMS = 64, PATHS = 2048 };
    for (int screen = 0; screen < 2; screen++) {
        struct traced x;
        made_open(&x.scene);
        made_material(&x.scene, 0.5, 0);
        made_material(&x.scene, 0, 3);
        made_material(&x.scene, 0, 0);
        made_quad(&x.scene, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
        made_quad(&x.scene, 1, 0, 0, 1, 0, 1, 0, 1, 0, 0);
        if (screen)
            made_quad(&x.scene, 2, 0.5, 0, 1e-4, 0, 1, 0, 0, 0, 0.9999);
        traced_open(&x, 1);
        const double exact = 3 * closed_parallel(screen ? 0.5 : 1, 1, 1);
        double off = 0, told = 0, by_chance = 0;
        for (uint64_t stream = 0; stream < STREAMS; stream++) {
            struct face_paths p;
            double variance = 0, mean = 0, square = 0;
            ck_assert_int_eq(face_paths_open(&p, &x.tracer, stream << 40, 1), 0);
            ck_assert_int_eq(face_paths_trace(&p, &x.tracer, PATHS, NULL), 0);
            const double n = (double)face_paths_count(&p, 0, PATHS) / REPLICATES;
            for (int r = 0; r < REPLICATES; r++) {
                const double h = p.replicate[r][0] / n;
                mean += h / REPLICATES;
                square += h * h;
            }
            variance = (square - REPLICATES * mean * mean) / (REPLICATES * (REPLICATES - 1));
            for (int half = 0; half < PATH_HALVES; half++) {
                double of_half, spread;
                face_paths_mean(&p, half, 0, 0, &of_half, &spread);
                by_chance += spread / (PATH_HALVES * PATH_HALVES);
            }
            off += (mean - exact) * (mean - exact) / STREAMS;
            told += variance / STREAMS;
            face_paths_close(&p);
        }
        by_chance /= STREAMS;
        /* a sum of STREAMS squares: 1.5 times the mean is 2.8 standard deviations */
        ck_assert_double_lt(off, 1.5 * told);
        ck_assert_double_lt(told, 1.5 * off);
        ck_assert_double_lt(told, by_chance / 2);
        traced_close(&x);
    }
}
END_TEST

/* Two ways to the same points: one by one, and many at once in the order of Gray codes. */
START_TEST(test_sobol)
{
    struct sobol_sequence sequence;
    struct sobol net;
    uint32_t shift[SOBOL_DIMENSIONS] = {0};
    sobol_sequence_open(&sequence);
    sobol_start(&net, 0x1234567890abcdef);
    for (int k = 0; k < 4; k++)
        shift[k] = net.digit[k];
    for (int i = 0; i < SOBOL_MOST; i++) {
        double point[SOBOL_DIMENSIONS];
        uint32_t digit[4][SEGMENTS_MAX];
        const int at = i % SEGMENTS_MAX;
        sobol_points(&net, i - at, at + 1, digit);
        sobol_sequence_point(&sequence, (uint32_t)(i ^ i >> 1), shift, point);
        for (int k = 0; k < 4; k++)
            ck_assert(point[k] == sobol_unit(digit[k][at]));
    }
}
END_TEST

/* Of 2^n points in n dimensions each of the 2^n halves of halves has one [property A, Sobol' 1976],
 * which Joe and Kuo's numbers have for every n: the first digits of the first n directions are
 * independent. A wrong one among them most likely breaks that. */
START_TEST(test_directions)
{
    struct sobol_sequence sequence;
    sobol_sequence_open(&sequence);
    for (int n = 1; n <= SOBOL_COORDINATES; n++) {
        uint32_t row[SOBOL_COORDINATES] = {0};
        for (int d = 0; d < n; d++)
            for (int b = 0; b < n; b++)
                row[d] |= (sequence.digits[d][b / SOBOL_RUN][1 << b % SOBOL_RUN] >> 31) << b;
        for (int b = 0; b < n; b++) { /* to triangular form */
            int pivot = b;
            while (pivot < n && !(row[pivot] >> b & 1))
                pivot++;
            ck_assert_int_lt(pivot, n);
            const uint32_t of_pivot = row[pivot];
            row[pivot] = row[b];
            row[b] = of_pivot;
            for (int d = b + 1; d < n; d++)
                row[d] ^= row[d] >> b & 1 ? of_pivot : 0;
        }
    }
}
END_TEST

/* In a furnace a particle lands 1 / (1 - rho) times; by chance the number has a variance of rho /
 * (1 - rho)^2. Where the sequence decides about reflections replicates differ by less. */
START_TEST(test_reflections)
{
    enum { PARTICLES = 4096 };
    struct traced x;
    struct tally tally;
    furnace_cube(&x.scene, 0.5);
    traced_open(&x, 1);
    ck_assert_int_eq(tally_open(&tally, &x.tracer, 1, 0), 0);
    ck_assert_int_eq(tally_trace(&tally, &x.tracer, PARTICLES, NULL), 0);
    double mean = 0, square = 0;
    for (int r = 0; r < REPLICATES; r++) {
        double landed = 0;
        for (uint32_t i = 0; i < x.tracer.hierarchy->face_count; i++)
            landed += tally_face(&tally, r, i, 0) / tally.power;
        mean += landed / REPLICATES;
        square += landed * landed / REPLICATES;
    }
    const double variance = (square - mean * mean) * REPLICATES / (REPLICATES - 1),
                 chance = 2.0 / PARTICLES;
    ck_assert_double_eq_tol(mean, 2, 4 * sqrt(chance / REPLICATES));
    ck_assert_double_lt(variance, chance / 8);
    tally_close(&tally);
    traced_close(&x);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("paths");
    TCase *paths = tcase_create("paths");
    tcase_add_test(paths, test_sobol);
    tcase_add_test(paths, test_directions);
    tcase_add_test(paths, test_reflections);
    tcase_add_test(paths, test_corner);
    tcase_add_test(paths, test_squares);
    tcase_add_test(paths, test_sequence);
    tcase_add_test(paths, test_plates);
    tcase_add_test(paths, test_furnace);
    tcase_add_test(paths, test_light_tree);
    tcase_add_test(paths, test_dark);
    tcase_add_test(paths, test_particles);
    tcase_set_timeout(paths, 60);
    suite_add_tcase(suite, paths);
    return suite_failures(suite) ? 1 : 0;
}
