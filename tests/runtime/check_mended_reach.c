/* Does what mending's own particles say of the error hold, and does it narrow what others measure?
 * Truths are closed forms, links are the truth spoilt by chance (spoilt.h).
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "runtime/spoilt.h"
#include "engine/mend.h"
#include "engine/mended_reach.h"
#include "suite.h"

struct cover {
    int trials, above, below, power, beyond;
    double wide, narrow, power_wide, power_narrow, left; /* sums: upper ends, widths, true errors */
};

/* Links off by `target`, mended by `of` and measured by `against`. */
static void judge(struct solve *s, const double *truth, double target, const struct tally *of,
                  const struct tally *against, struct chance *chance, struct cover *c)
{
    const size_t size = (size_t)s->hierarchy.count * s->problem.bands * sizeof(double);
    double *links = s->state.irradiance, *mended = malloc(size);
    struct mended_reach reach;
    struct face_error m;
    memset(links, 0, size);
    spoil(s, truth, links, target, chance);
    ck_assert_int_eq(mended_reach_find(s, of, &reach), 0);
    memcpy(mended, links, size);
    ck_assert_int_eq(mend_irradiance(&s->operator, of, mended), 0);
    const struct errors e = true_errors(s, truth, mended);
    ck_assert_int_eq(face_error_open(&m, &s->problem, &s->hierarchy, mended, against), 0);
    c->wide += m.l1.high;
    c->power_wide += m.power.high - m.power.low;
    mended_reach_narrow(&reach, &m);
    ck_assert(m.l1.low >= 0 && m.l1.low <= m.l1.value && m.l1.value <= m.l1.high);
    c->narrow += m.l1.high;
    c->power_narrow += m.power.high - m.power.low;
    c->left += e.l1;
    c->trials++;
    c->beyond += e.l1 > reach.l1 + 1e-9;
    c->above += e.l1 > m.l1.high + 1e-9;
    c->below += e.l1 < m.l1.low - 1e-9;
    c->power += e.power < m.power.low - 1e-9 || e.power > m.power.high + 1e-9;
    face_error_close(&m);
    free(mended);
}

static void say(const char *name, const struct cover *c)
{
    const double n = c->trials;
    if (thorough() && c->trials)
        printf("%-26s %5d: above %4.1f %%, below %4.1f %%, power missed %4.1f %%; high %.4f -> "
               "%.4f, true %.4f; power's width %.4f -> %.4f\n",
               name, c->trials, 100 * c->above / n, 100 * c->below / n, 100 * c->power / n,
               c->wide / n, c->narrow / n, c->left / n, c->power_wide / n, c->power_narrow / n);
}

static void add(struct cover *sum, const struct cover *c)
{
    sum->trials += c->trials;
    sum->above += c->above;
    sum->below += c->below;
    sum->power += c->power;
    sum->beyond += c->beyond;
    sum->wide += c->wide;
    sum->narrow += c->narrow;
    sum->power_wide += c->power_wide;
    sum->power_narrow += c->power_narrow;
    sum->left += c->left;
}

/* Of ranges that are to hold the truth in 95 of 100 cases, 8 miss it at the most, but for three
 * standard deviations of so many trials. Measured by a twentieth of what mends. */
START_TEST(test_coverage)
{
    static const double beside[] = {0, 0.2, 1, 4, 20}; /* error of links over noise of mending */
    static const int particles[] = {20000, 300000};
    enum { MEASURED = 20, MANY_PARTICLES = 8 };
    static struct cover cover[2][2][5];
    const int problems = thorough() ? 216 : 36, streams = thorough() ? 4 : 1;
    for (int i = 0; i < problems; i++) {
        const enum known kind = (enum known)(i % KNOWN_KINDS);
        const int many = kind == KNOWN_TILED || kind == KNOWN_SPHERE;
        struct chance chance = {hash64(2000003 + (uint64_t)i)};
        struct scene scene;
        struct solve s;
        double *truth = known_open(&scene, kind, &chance);
        open_known(&s, &scene);
        struct tracer t = tracer_over(&s, 1);
        for (int n = many; n < (thorough() || i % MANY_PARTICLES == 0 ? 2 : 1 + many); n++)
            for (int r = 0; r < streams; r++) {
                struct tally of, against;
                struct face_noise noise;
                traced(&of, &t, (uint64_t)(2 * streams * i + 2 * r + 1), particles[n]);
                traced(&against, &t, (uint64_t)(2 * streams * i + 2 * r + 2),
                       particles[n] / MEASURED);
                spoil(&s, truth, s.state.irradiance, 0, &chance);
                ck_assert_int_eq(
                    face_noise_find(&s.problem, &s.hierarchy, s.state.irradiance, &of, &noise), 0);
                for (int q = 0; q < 5; q++)
                    judge(&s, truth,
                          fmin(1, noise.all * beside[q] * exp(chance_between(&chance, -0.5, 0.5))),
                          &of, &against, &chance, &cover[many][n][q]);
                tally_close(&of);
                tally_close(&against);
            }
        close_known(&s, &scene, &t, truth, NULL);
    }
    struct cover all = {0};
    for (int many = 0; many < 2; many++)
        for (int n = 0; n < 2; n++)
            for (int q = 0; q < 5; q++) {
                const struct cover *c = &cover[many][n][q];
                char name[64];
                snprintf(name, sizeof name, "%s faces, %d, links %g", many ? "many" : "few",
                         particles[n], beside[q]);
                say(name, c);
                add(&all, c);
                const double most = 0.08 + 3 * sqrt(0.05 * 0.95 / fmax(c->trials, 1));
                ck_assert_msg(c->above + c->below <= most * c->trials, "%s: l1 missed", name);
            }
    say("all", &all);
    /* trials of one tally are not independent: as few as there are tallies */
    const double most = 0.08 + 3 * sqrt(0.05 * 0.95 * 5 / all.trials);
    ck_assert_double_le(all.above + all.below, most * all.trials);
    ck_assert_double_le(all.power, most * all.trials);
    ck_assert_double_le(all.beyond, 0.025 * all.trials);
    ck_assert_double_lt(all.narrow, 0.7 * all.wide);
    ck_assert_double_lt(all.power_narrow, 0.4 * all.power_wide);
}
END_TEST

/* Measured: all light W, its error and interval, and those of faces. */
static struct face_error measured(double light, double deviation, double low, double high)
{
    const double half = REPLICATES_T * deviation / light;
    return (struct face_error){
        .reflected = light, .power = {0, -half, half}, .l1 = {(low + high) / 2, low, high}};
}

/* Of faces the upper end comes down to what mending may leave, and what is above that becomes what
 * mending leaves; but not where it is surely above; */
START_TEST(test_faces)
{
    const struct mended_reach reach = {.left = 0.006, .l1 = 0.01}, nothing = {0, 0, 0, 0};
    struct face_error m = measured(1, 0.1, 0.004, 0.03);
    mended_reach_narrow(&nothing, &m);
    ck_assert_double_eq(m.l1.high, 0.03);
    mended_reach_narrow(&reach, &m);
    ck_assert_double_eq(m.l1.low, 0.004);
    ck_assert_double_eq(m.l1.value, 0.006);
    ck_assert_double_eq(m.l1.high, 0.01);
    m = measured(1, 0.1, 0.001, 0.009);
    mended_reach_narrow(&reach, &m);
    ck_assert_double_eq(m.l1.high, 0.009);
    m = measured(1, 0.1, 0.011, 0.03);
    mended_reach_narrow(&reach, &m);
    ck_assert_double_eq(m.l1.value, (0.011 + 0.03) / 2);
    ck_assert_double_eq(m.l1.high, 0.03);
}
END_TEST

/* and all light is the mean of both counts by their variances, as wide as that of one and a third
 * as many where the one has three times the particles of the other; where they are four times
 * farther apart than both allow, four times as wide. */
START_TEST(test_power)
{
    const double small = 1e-3; /* of all light: widths are linear in it */
    for (double apart = 0; apart < 5; apart += 4) {
        const struct mended_reach reach = {0.006, 0.01, 1 + apart * 2 * small, small * small};
        struct face_error m = measured(1, sqrt(3) * small, 0, 0.03);
        mended_reach_narrow(&reach, &m);
        const double light = (1 + 3 * reach.light) / 4,
                     half = REPLICATES_T * sqrt(0.75) * small * fmax(apart, 1);
        ck_assert_double_eq_tol(m.power.value, 1 / light - 1, 1e-12);
        ck_assert_double_eq_tol(m.power.high - m.power.value, half / (light * light), 1e-12);
        ck_assert_double_eq_tol(m.power.value - m.power.low, half / (light * light), 1e-12);
    }
}
END_TEST

/* What is surely missing of all light is missing of faces, whatever is told of these. */
START_TEST(test_agree)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        struct face_error m = measured(1, 0, 0.0008, 0.0034);
        m.power = (struct RadMeasure){sign * 0.0049, sign * 0.0049 - 0.001, sign * 0.0049 + 0.001};
        face_error_agree(&m);
        ck_assert_double_eq_tol(m.l1.low, 0.0039, 1e-12);
        ck_assert_double_eq(m.l1.value, m.l1.low);
        ck_assert_double_eq(m.l1.high, m.l1.low);
        m = measured(1, 0, 0.0008, 0.0054);
        m.power = (struct RadMeasure){sign * 0.0029, sign * 0.0029 - 0.001, sign * 0.0029 + 0.001};
        face_error_agree(&m);
        ck_assert_double_eq_tol(m.l1.low, 0.0019, 1e-12);
        ck_assert_double_eq(m.l1.value, (0.0008 + 0.0054) / 2);
        ck_assert_double_eq(m.l1.high, 0.0054);
    }
    struct face_error m = measured(1, 0.001, 0.0008, 0.0034);
    face_error_agree(&m);
    ck_assert_double_eq(m.l1.low, 0.0008);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("mended reach");
    TCase *tests = tcase_create("");
    tcase_set_timeout(tests, 300);
    tcase_add_test(tests, test_coverage);
    tcase_add_test(tests, test_faces);
    tcase_add_test(tests, test_power);
    tcase_add_test(tests, test_agree);
    suite_add_tcase(suite, tests);
    return suite_failures(suite) > 0;
}
