/* Are clusters mended where links are off, and left alone where they are not; and is what is left
 * of their error what mending says? Truths are closed forms, links are the truth spoilt by chance
 * (spoilt.h).
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "runtime/spoilt.h"
#include "engine/mend.h"
#include "engine/mend_solution.h"
#include "engine/mended_error.h"
#include "engine/mended_reach.h"
#include "engine/reflected_light.h"
#include "kernel/constants.h"

/* Means over some runs, as shares of the reflected light: of L1 errors of polygons before and after
 * mending, of what is said of the last, and of the noise of particles alone. */
/* Walls of n x n tiles whose light is known, and what particles count there. */
struct trial {
    struct scene scene;
    struct solve s;
    struct tracer t;
    struct tally y;
    double *truth;
};

static void trial_open(struct trial *w, int n, int particles, uint64_t stream,
                       struct chance *chance)
{
    w->truth = tiled_open(&w->scene, &w->s, n, chance);
    w->t = tracer_over(&w->s, 1);
    traced(&w->y, &w->t, stream, particles * (int)w->scene.input_count);
}

/* links: to be freed; or NULL. */
static void trial_close(struct trial *w, double *links)
{
    tally_close(&w->y);
    close_known(&w->s, &w->scene, &w->t, w->truth, links);
}

struct means {
    double before, after, said, noise;
};

/* Walls of n x n tiles, links off by `target` times the noise, particles as many as of a tile. */
static struct means mended(int n, int particles, double target, uint64_t seed)
{
    enum { RUNS = 8 };
    struct means m = {0, 0, 0, 0};
    struct chance chance = {hash64(seed)};
    for (uint64_t i = 0; i < RUNS; i++) {
        struct trial w;
        struct face_noise noise;
        struct mended_faces after;
        struct mended_error left;
        trial_open(&w, n, particles, i + 1, &chance);
        struct solve *s = &w.s;
        const size_t values = (size_t)s->hierarchy.count * w.scene.bands;
        double *links = calloc(values, sizeof *links);
        spoil(s, w.truth, links, 0, &chance);
        ck_assert_int_eq(face_noise_find(&s->problem, &s->hierarchy, links, &w.y, &noise), 0);
        spoil(s, w.truth, links, target * noise.all, &chance);
        memcpy(s->state.irradiance, links, values * sizeof *links);
        ck_assert_int_eq(mended_error_find(s, &w.y, &noise, &left), 0);
        ck_assert_mem_eq(s->state.irradiance, links, values * sizeof *links);
        ck_assert_int_eq(mend_faces(&s->operator, & w.y, links, &after, NULL), 0);
        m.before += true_errors(s, w.truth, links).l1 / RUNS;
        m.after += true_errors(s, w.truth, after.irradiance).l1 / RUNS;
        m.said += left.value / RUNS;
        m.noise += noise.all / RUNS;
        mended_faces_close(&after);
        trial_close(&w, links);
    }
    if (thorough())
        printf("%d tiles, %d particles each, links off by %4.2f noises: %.4f -> %.4f, said %.4f, "
               "noise %.4f\n",
               6 * n * n, particles, target, m.before, m.after, m.said, m.noise);
    return m;
}

/* Links that are right stay so, but for a tenth of the noise; what is far off is as good as what
 * particles say; and in between mending is never much worse than the better of both. */
START_TEST(test_mends)
{
    static const int particles[] = {4, 16, 64};
    for (int i = 0; i < 3; i++) {
        const struct means right = mended(12, particles[i], 0, 11),
                           near = mended(12, particles[i], 0.5, 12),
                           far = mended(12, particles[i], 6, 13);
        ck_assert_double_lt(right.after, 0.12 * right.noise);
        ck_assert_double_lt(near.after, near.before + 0.15 * near.noise);
        ck_assert_double_lt(far.after, 1.1 * far.noise);
    }
}
END_TEST

/* What is said of the rest is not below it, but for what eight runs leave open, and not far above:
 * by half where a third of the faces have all of it, and by what cannot be told from nothing, the
 * less the more faces there are. */
START_TEST(test_says)
{
    static const int particles[] = {4, 16, 64}, tiles[] = {14, 40};
    static const double targets[] = {0, 0.25, 0.5, 1, 2, 6}, unseen[] = {0.4, 0.25};
    for (int n = 0; n < 2; n++)
        for (int i = 0; i < (n ? 1 : 3); i++)
            for (int j = 0; j < 6; j += under_sanitizers() ? 5 : 1 + n) {
                const struct means m =
                    mended(tiles[n], particles[i], targets[j], 21 + (uint64_t)(8 * i + j));
                ck_assert_double_ge(m.said, 0.9 * m.after);
                ck_assert_double_le(m.said, 1.5 * m.after + unseen[n] * m.noise);
                ck_assert_double_le(m.said, 1.0001 * m.noise);
            }
}
END_TEST

/* Means over some runs of what is left and of its upper end, and how often it is above that. */
struct ends {
    double after, most;
    int beyond;
};

enum { ENDS = 40 };

/* Walls of 14 x 14 tiles, each with links off by a share by chance, and 64 particles a tile. */
static struct ends ends_of(double share, uint64_t seed)
{
    struct ends ends = {0, 0, 0};
    struct chance chance = {hash64(seed)};
    for (uint64_t i = 0; i < ENDS; i++) {
        struct trial w;
        struct mended_reach reach;
        struct mended_faces after;
        trial_open(&w, 14, 64, i + 1, &chance);
        const uint32_t bands = w.scene.bands;
        double *links = w.s.state.irradiance;
        for (uint32_t f = 0; f < w.scene.face_count; f++) {
            const double off = share * chance_normal(&chance);
            for (uint32_t k = 0; k < bands; k++)
                links[w.s.hierarchy.face_element[f] * bands + k] =
                    w.truth[f * bands + k] * fmax(0.1, 1 + off);
        }
        ck_assert_int_eq(mended_reach_find(&w.s, &w.y, &reach), 0);
        ck_assert_int_eq(mend_faces(&w.s.operator, & w.y, links, &after, NULL), 0);
        const double left = true_errors(&w.s, w.truth, after.irradiance).l1;
        ends.after += left / ENDS;
        ends.most += reach.l1 / ENDS;
        ends.beyond += left > reach.l1;
        mended_faces_close(&after);
        trial_close(&w, NULL);
    }
    if (thorough())
        printf("links off by %.2f: %.4f are left, at most %.4f, %d of %d beyond\n", share,
               ends.after, ends.most, ends.beyond, ENDS);
    return ends;
}

/* What is left at the most holds the truth in 97 of 100 cases, but for three standard deviations
 * of 40; where links say nothing it is as sure as the noise of many tiles is, not as that of
 * one. */
START_TEST(test_ends)
{
    const struct ends far = ends_of(0.5, 51), near = ends_of(0.04, 52), right = ends_of(0, 53);
    ck_assert_int_le(far.beyond, 4);
    ck_assert_int_le(near.beyond, 4);
    ck_assert_int_le(right.beyond, 4);
    ck_assert_double_lt(far.most, 1.15 * far.after);
}
END_TEST

/* Of large polygons it is the noise of particles, however good links are. */
START_TEST(test_large)
{
    const struct means m = mended(1, 10000, 0, 5);
    ck_assert_double_eq_tol(m.said, m.noise, 1e-12);
}
END_TEST

/* How many particles more: with none of the error from links as many as noise tells, with nothing
 * but that no number is enough, and in between they are what is missing. */
START_TEST(test_wanted)
{
    ck_assert_double_eq_tol(mended_error_wanted(0.02, 0.02, 0.01), 4, 1e-12);
    ck_assert_double_eq(mended_error_wanted(0.01, 0.04, 0.01), 0);
    for (double error = 0.011; error < 0.04; error += 0.001) {
        const double links = 1 / (error * error) - 1 / (0.04 * 0.04),
                     times = mended_error_wanted(error, 0.04, 0.01);
        ck_assert_double_gt(times, 1);
        ck_assert_double_eq_tol(1 / sqrt(links + times / (0.04 * 0.04)), 0.01, 1e-9);
    }
}
END_TEST

/* So many rays does mending cast, and so far off is what is shown. */
static uint64_t rays_of(double left, double *error)
{
    struct chance chance = {hash64(31)};
    struct scene scene;
    struct solve s;
    struct measured_error alone;
    const char *cause;
    double *truth = tiled_open(&scene, &s, 14, &chance);
    struct tracer t = tracer_over(&s, 1);
    for (uint32_t f = 0; f < scene.face_count; f++)
        for (uint32_t k = 0; k < scene.bands; k++)
            s.state.irradiance[s.hierarchy.face_element[f] * scene.bands + k] =
                truth[f * scene.bands + k];
    const struct mending_goal goal = {.noise = 0.05, .left = left, .most = 1 << 24};
    ck_assert_int_eq(measure_and_mend(&s, &goal, &alone, &cause), 0);
    *error = true_errors(&s, truth, s.mended.irradiance).l1;
    const uint64_t rays = alone.rays;
    measured_error_free(&alone);
    close_known(&s, &scene, &t, truth, NULL);
    return rays;
}

/* Where links are right half of the particles is enough, and all is as near as was wanted. */
START_TEST(test_spares)
{
    double error, alone;
    const uint64_t unaided = rays_of(0, &alone), rays = rays_of(0.05, &error);
    ck_assert_uint_lt(2 * rays, unaided);
    ck_assert_double_lt(error, 0.05);
    ck_assert_double_lt(alone, 0.05);
}
END_TEST

/* As many as all reflected light wants, where each face would do with fewer. */
START_TEST(test_power)
{
    struct chance chance = {hash64(41)};
    struct scene scene;
    struct solve s;
    struct tally y;
    double *truth = tiled_open(&scene, &s, 4, &chance), variance, times, alone;
    struct tracer t = tracer_over(&s, 1);
    traced(&y, &t, 1, 4096);
    const double light = reflected_light(&s.problem, &y, &variance);
    struct mending_goal goal = {.noise = 0.9, .power = 0.5 * sqrt(variance) / light};
    ck_assert_int_eq(mended_error_times(&s, &y, &goal, &times, &alone), 0);
    ck_assert_double_eq_tol(times, 4, 1e-9);
    ck_assert_double_eq_tol(alone, 4, 1e-9);
    goal.power = 0;
    ck_assert_int_eq(mended_error_times(&s, &y, &goal, &times, &alone), 0);
    ck_assert_double_lt(times, 1);
    tally_close(&y);
    close_known(&s, &scene, &t, truth, NULL);
}
END_TEST

/* What all faces reflect (W). */
static double sum_of(const struct solve *s, const double *irradiance)
{
    const uint32_t bands = s->problem.bands;
    double sum = 0;
    for (uint32_t f = 0; f < s->hierarchy.face_count; f++)
        for (uint32_t k = 0; k < bands; k++) {
            const uint32_t at = s->hierarchy.face_element[f];
            sum += s->problem.reflectance[f * bands + k] * s->hierarchy.elements[at].area
                   * irradiance[at * bands + k];
        }
    return sum;
}

/* Links that have a share too much on faces that reflect more than others, and as much less on
 * those: all that falls on faces is right. */
static void tilt(const struct solve *s, const double *truth, double share, double *links)
{
    const uint32_t bands = s->problem.bands, faces = s->hierarchy.face_count;
    const double *rho = s->problem.reflectance;
    double mean = 0;
    for (uint32_t f = 0; f < faces; f++)
        mean += rho[f * bands] / faces;
    for (uint32_t f = 0; f < faces; f++)
        for (uint32_t k = 0; k < bands; k++)
            links[s->hierarchy.face_element[f] * bands + k] =
                truth[f * bands + k] * (1 + share * (rho[f * bands] - mean));
}

/* Of links that are tilted until their sum is so many standard errors of what is counted too much:
 * by how much of what links are off from what was counted may their mended sum be? */
static void check_sum(double many, uint64_t seed)
{
    struct chance chance = {hash64(seed)};
    struct scene scene;
    struct solve s;
    struct tally y;
    struct mended_faces after;
    double *truth = tiled_open(&scene, &s, 8, &chance), variance;
    const size_t values = (size_t)s.hierarchy.count * scene.bands;
    double *links = calloc(values, sizeof *links);
    struct tracer t = tracer_over(&s, 1);
    traced(&y, &t, seed, 16 * (int)scene.face_count);
    const double counted = reflected_light(&s.problem, &y, &variance), noise = sqrt(variance);
    tilt(&s, truth, 0, links);
    const double right = sum_of(&s, links);
    tilt(&s, truth, 1, links);
    const double whole = sum_of(&s, links) - right;
    tilt(&s, truth, whole > 1e-9 * right ? many * noise / whole : 0, links);
    ck_assert_int_eq(mend_faces(&s.operator, & y, links, &after, NULL), 0);
    const double off = fabs(sum_of(&s, after.irradiance) - counted),
                 linked = fabs(sum_of(&s, links) - counted),
                 evidence = sqrt(1 + MEND_EVIDENCE * sqrt(2)) * noise;
    ck_assert_double_le(off, (linked > evidence ? noise * noise / linked : evidence) * (1 + 1e-9)
                                 + 1e-9 * counted);
    tally_close(&y);
    mended_faces_close(&after);
    close_known(&s, &scene, &t, truth, links);
}

/* Where each cluster's error is below what is believed of it, the sum of all is not. */
START_TEST(test_sums)
{
    for (uint64_t seed = 1; seed <= 24; seed++)
        for (double many = 0; many < 5; many += 2)
            check_sum(many, seed);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("mended error");
    TCase *tests = tcase_create("");
    tcase_set_timeout(tests, 120);
    tcase_add_test(tests, test_mends);
    tcase_add_test(tests, test_says);
    tcase_add_test(tests, test_ends);
    tcase_add_test(tests, test_large);
    tcase_add_test(tests, test_wanted);
    tcase_add_test(tests, test_spares);
    tcase_add_test(tests, test_power);
    tcase_add_test(tests, test_sums);
    suite_add_tcase(suite, tests);
    return suite_failures(suite) > 0;
}
