/* check_losses.c - what rows of view factors lack is told apart: light that leaves the scene, that
 * meets a black back, that comes from where something stands.
 *
 * A unit cube's walls exchange what is known in closed form, and so a wall that is missing, or is
 * turned, takes just that. [Howell, A Catalog of Radiation Heat Transfer Configuration Factors,
 * C-11 and C-14]
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <string.h>
#include "radiosity.h"
#include "kernel/lambert.h"
#include "suite.h"

static const double OPPOSITE = 0.1998248957, BESIDE = 0.2000437761;

/* The cube from (0, 0, 0) to (1, 1, 1), fronts inside: floor, ceiling, and walls round. */
static const double corners[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                     {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
static const uint32_t cube[6][4] = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                                    {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};

enum { MOST = 18 };
struct shape {
    uint32_t corner[MOST][4], count;
    double position[64][3];
    RadDevice device;
    RadScene scene;
    RadExchange exchange;
    enum RadTurned turned; /* what to do of what is */
    struct RadSceneReport seen;
    struct RadExchangeReport report;
    double row[MOST][MOST], sum[MOST];
    struct RadExchangeLoss loss[MOST];
};

static void put_cube(struct shape *s)
{
    memset(s, 0, sizeof *s);
    memcpy(s->position, corners, sizeof corners);
    memcpy(s->corner, cube, sizeof cube);
    s->count = 6;
}

static void turn(struct shape *s, uint32_t i)
{
    uint32_t second = s->corner[i][1];
    s->corner[i][1] = s->corner[i][3];
    s->corner[i][3] = second;
}

static void drop(struct shape *s, uint32_t i)
{
    memmove(s->corner[i], s->corner[i + 1], (--s->count - i) * sizeof s->corner[0]);
}

static void compute(struct shape *s, enum RadClosure closure)
{
    static const struct RadMaterial grey = {{.5, .5, .5}, {0, 0, 0}, 0};
    const struct RadPolygons polygons = {.positions = s->position[0],
                                         .position_count = 64,
                                         .indices = s->corner[0],
                                         .size = 4,
                                         .count = s->count,
                                         .turned = s->turned};
    s->device = radNewDevice(NULL);
    s->scene = radNewScene(s->device);
    ck_assert_int_eq(radSetSceneMaterials(s->scene, &grey, 1), 0);
    ck_assert_int_eq(radSetSceneSharedPolygons(s->scene, &polygons), 0);
    ck_assert_int_eq(radCommitScene(s->scene), 0);
    ck_assert_int_eq(radGetSceneReport(s->scene, &s->seen), 0);
    s->exchange = radNewExchange(s->scene, NULL, &(struct RadExchangeOptions){.closure = closure});
    ck_assert_ptr_nonnull(s->exchange);
    radGetExchangeReport(s->exchange, &s->report);
    for (uint32_t i = 0; i < s->count; i++) {
        s->sum[i] = radGetExchangeRow(s->exchange, i, s->row[i]);
        ck_assert_int_eq(radGetExchangeLoss(s->exchange, i, &s->loss[i]), 0);
    }
}

static void close_shape(struct shape *s)
{
    radReleaseExchange(s->exchange);
    radReleaseScene(s->scene);
    radReleaseDevice(s->device);
}

static void expect_loss(const struct shape *s, uint32_t i, double sky, double backs, double covered)
{
    ck_assert_double_eq_tol(s->loss[i].sky, sky, 1e-6);
    ck_assert_double_eq_tol(s->loss[i].backs, backs, 1e-6);
    ck_assert_double_eq_tol(s->loss[i].covered, covered, 1e-6);
    ck_assert_double_eq_tol(s->sum[i] + sky + backs + covered, 1, 3e-4);
}

/* A closed cube loses nothing. */
START_TEST(test_closed)
{
    struct shape s;
    put_cube(&s);
    compute(&s, RAD_CLOSURE_NONE);
    for (uint32_t i = 0; i < 6; i++)
        expect_loss(&s, i, 0, 0, 0);
    ck_assert_uint_eq(s.report.rows_open + s.report.rows_backs + s.report.rows_covered, 0);
    ck_assert_double_eq_tol(fabs(s.sum[s.report.worst_row] - 1), s.report.worst, 1e-15);
    struct RadExchangeLoss loss;
    ck_assert_int_eq(radGetExchangeLoss(s.exchange, 6, &loss), -1);
    ck_assert_int_eq(radGetDeviceError(s.device), RAD_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(radGetExchangeLoss(s.exchange, 0, NULL), -1);
    ck_assert_int_eq(radGetExchangeLoss(NULL, 0, &loss), -1);
    close_shape(&s);
}
END_TEST

/* Without the ceiling its share leaves. */
START_TEST(test_sky)
{
    struct shape s;
    for (int closure = RAD_CLOSURE_NONE; closure <= RAD_CLOSURE_RECIPROCAL; closure++) {
        put_cube(&s);
        drop(&s, 1);
        compute(&s, (enum RadClosure)closure);
        for (uint32_t i = 0; i < 5; i++)
            expect_loss(&s, i, i ? BESIDE : OPPOSITE, 0, 0);
        ck_assert_uint_eq(s.report.rows_open, 5);
        ck_assert_uint_eq(s.report.rows_backs, 0);
        close_shape(&s);
    }
}
END_TEST

/* A wall that is turned takes its share on its back, and sends all to the sky. */
START_TEST(test_turned)
{
    struct shape s;
    put_cube(&s);
    turn(&s, 3);
    compute(&s, RAD_CLOSURE_NONE);
    for (uint32_t i = 0; i < 6; i++)
        expect_loss(&s, i, i == 3 ? 1 : 0, i == 3 ? 0 : i == 5 ? OPPOSITE : BESIDE, 0);
    ck_assert_uint_eq(s.report.rows_open, 1);
    ck_assert_uint_eq(s.report.rows_backs, 5);
    ck_assert_uint_eq(s.report.rows_closed, 0);
    ck_assert_double_eq_tol(s.report.environment_mean, 1. / 6, 1e-6);
    ck_assert_double_eq_tol(s.report.backs_mean, (4 * BESIDE + OPPOSITE) / 6, 1e-6);
    ck_assert_double_eq_tol(s.report.backs_most, BESIDE, 1e-6);
    close_shape(&s);
}
END_TEST

/* Without the ceiling and with a turned wall a row loses to both, each its own. */
START_TEST(test_both)
{
    struct shape s;
    put_cube(&s);
    turn(&s, 3);
    drop(&s, 1);
    compute(&s, RAD_CLOSURE_NONE);
    for (uint32_t i = 0; i < 5; i++) {
        if (i == 2)
            continue;
        ck_assert_double_eq_tol(s.loss[i].sky, i ? BESIDE : OPPOSITE, .03); /* by 1,024 rays */
        ck_assert_double_eq_tol(s.sum[i] + s.loss[i].sky + s.loss[i].backs, 1, 1e-12);
    }
    ck_assert_uint_eq(s.report.rows_open, 5);
    ck_assert_uint_eq(s.report.rows_backs, 4);
    close_shape(&s);
}
END_TEST

/* A cube more, of this size, at that place, fronts inside. */
static void add_cube(struct shape *s, double size, double x, double y, double z)
{
    uint32_t at = 8 * (s->count / 6);
    for (uint32_t i = 0; i < 8; i++) {
        const double place[3] = {x, y, z};
        for (int k = 0; k < 3; k++)
            s->position[at + i][k] = place[k] + size * corners[i][k];
    }
    for (uint32_t i = 0; i < 6; i++, s->count++)
        for (int j = 0; j < 4; j++)
            s->corner[s->count][j] = at + cube[i][j];
}

static void expect_turned(const struct RadTurnedPolygons *t, uint32_t count, uint32_t first)
{
    ck_assert_uint_eq(t->count, count);
    for (uint32_t i = 0; i < count && i < RAD_TURNED_NAMED; i++)
        ck_assert_uint_eq(t->polygon[i], first + i);
}

/* Whichever wall of the closed cube is turned, it is named, and turned back on demand. A cube seen
 * from outside is no less right. */
START_TEST(test_flip)
{
    struct shape s;
    for (uint32_t wall = 0; wall < 7; wall++)
        for (int outside = 0; outside < 2; outside++)
            for (int flip = RAD_TURNED_IGNORE; flip <= RAD_TURNED_FLIP; flip++) {
                put_cube(&s);
                for (uint32_t i = 0; i < 6; i++)
                    if (outside != (i == wall))
                        turn(&s, i);
                s.turned = (enum RadTurned)flip;
                compute(&s, RAD_CLOSURE_NONE);
                expect_turned(&s.seen.turned_closed, wall < 6 && flip ? 1 : 0, wall);
                expect_turned(&s.seen.turned_open, 0, 0);
                for (uint32_t i = 0; i < 6 && flip == RAD_TURNED_FLIP; i++)
                    expect_loss(&s, i, outside, 0, 0);
                close_shape(&s);
            }
}
END_TEST

/* Of a cube without its ceiling the turned wall is named, and left. */
START_TEST(test_open)
{
    struct shape s;
    put_cube(&s);
    turn(&s, 3);
    drop(&s, 1);
    s.turned = RAD_TURNED_FLIP;
    compute(&s, RAD_CLOSURE_NONE);
    expect_turned(&s.seen.turned_closed, 0, 0);
    expect_turned(&s.seen.turned_open, 1, 2);
    ck_assert_uint_eq(s.report.rows_backs, 4);
    close_shape(&s);
}
END_TEST

/* A cube inside out in a room is turned; not one beside it, nor one in which something stands. */
START_TEST(test_inside_out)
{
    struct shape s;
    for (int place = 0; place < 3; place++) {
        put_cube(&s);
        add_cube(&s, .25, place == 1 ? 2 : .5, .25, .25);
        if (place == 2)
            add_cube(&s, .1, .55, .3, .3);
        s.turned = RAD_TURNED_FLIP;
        compute(&s, RAD_CLOSURE_NONE);
        expect_turned(&s.seen.turned_closed, place == 1 ? 0 : 6, place ? 12 : 6);
        if (place == 2) {
            close_shape(&s);
            continue;
        }
        for (uint32_t i = 0; i < 12; i++)
            expect_loss(&s, i, 0, 0, 0);
        double both = 0; /* what the room gives the box is what the box gives it */
        for (uint32_t i = 6; i < 12; i++)
            for (uint32_t j = 0; j < 6; j++)
                both += s.row[i][j];
        ck_assert_double_eq_tol(both, place ? 0 : 6, 1e-3);
        close_shape(&s);
    }
}
END_TEST

/* A pillar between the points of a coarse grid covers a hundredth of floor and ceiling. */
START_TEST(test_pillar)
{
    struct shape s;
    put_cube(&s);
    for (int k = 0; k < 8; k++) {
        double *p = s.position[8 + k];
        p[0] = k % 4 == 1 || k % 4 == 2 ? 0.3 : 0.2;
        p[1] = k % 4 >= 2 ? 0.3 : 0.2;
        p[2] = k / 4;
    }
    for (uint32_t k = 0; k < 4; k++) {
        const uint32_t side[4] = {8 + k, 8 + (k + 1) % 4, 12 + (k + 1) % 4, 12 + k};
        memcpy(s.corner[s.count++], side, sizeof side);
    }
    compute(&s, RAD_CLOSURE_NONE);
    for (uint32_t i = 0; i < 2; i++) {
        ck_assert_double_eq_tol(s.loss[i].covered, 0.01, 3e-4);
        ck_assert_double_eq_tol(s.sum[i], 0.99, 3e-4);
    }
    for (uint32_t i = 2; i < s.count; i++)
        ck_assert_double_eq(s.loss[i].covered, 0);
    ck_assert_uint_eq(s.report.rows_covered, 2);
    ck_assert_uint_eq(s.report.rows_open + s.report.rows_backs, 0);
    close_shape(&s);
}
END_TEST

/* A patch in the middle of a wide room sees the sky through a chink of one wall, whichever that is,
 * four degrees above its plane at the most: a thousandth of its row is known to go there. */
START_TEST(test_chink)
{
    /* what a point in its middle sees, by Lambert's formula */
    const double away = sqrt(6 * 6 + .4 * .4),
                 chink = (atan(1) - 6 / away * atan(6 / away)) / LAMBERT_PI;
    struct shape s;
    for (uint32_t wall = 2; wall < 6; wall++) {
        put_cube(&s);
        for (int i = 0; i < 8; i++) {
            for (int k = 0; k < 3; k++)
                s.position[i][k] *= k < 2 ? 12 : 4;
            memcpy(s.position[8 + i], s.position[i], sizeof s.position[i]);
            s.position[8 + i][2] = i < 4 ? 1.4 : 1; /* where the wall begins again, and ends */
            s.position[16 + i][0] = i % 4 == 1 || i % 4 == 2 ? 6.05 : 5.95;
            s.position[16 + i][1] = i % 4 >= 2 ? 6.05 : 5.95;
            s.position[16 + i][2] = 1;
        }
        for (int i = 0; i < 4; i++) {
            const uint32_t corner = cube[wall][i];
            s.corner[6][i] = corner < 4 ? corner : 8 + corner;
            s.corner[wall][i] = corner < 4 ? 8 + corner : corner;
            s.corner[7][i] = 16 + (uint32_t)i;
        }
        s.count = 8;
        compute(&s, RAD_CLOSURE_NONE);
        ck_assert_double_eq_tol(s.sum[7], 1 - chink, 3e-4);
        ck_assert_double_eq_tol(s.sum[7] + s.loss[7].sky, 1, 1e-12);
        close_shape(&s);
    }
}
END_TEST

/* A thin bent slab, which is no convex solid, pushed through the floor covers a four hundredth of
 * it, along rows of points that a grid would have. */
START_TEST(test_slab)
{
    static const double plan[6][2] = {{.4, .2},   {.404, .2}, {.424, .5},
                                      {.404, .8}, {.4, .8},   {.42, .5}};
    static const uint32_t top[2][4] = {{0, 1, 2, 5}, {5, 2, 3, 4}};
    struct shape s;
    put_cube(&s);
    for (uint32_t i = 0; i < 12; i++) {
        s.position[8 + i][0] = plan[i % 6][0];
        s.position[8 + i][1] = plan[i % 6][1];
        s.position[8 + i][2] = i < 6 ? -0.1 : 0.3;
    }
    for (uint32_t i = 0; i < 6; i++) {
        const uint32_t next = (i + 1) % 6, side[4] = {8 + i, 8 + next, 14 + next, 14 + i};
        memcpy(s.corner[s.count++], side, sizeof side);
    }
    for (uint32_t i = 0; i < 2; i++)
        for (int k = 0; k < 4; k++)
            s.corner[s.count + i][k] = 14 + top[i][k];
    s.count += 2;
    compute(&s, RAD_CLOSURE_NONE);
    ck_assert_double_eq_tol(s.loss[0].covered, 0.0024, 3e-4);
    ck_assert_double_eq_tol(s.sum[0], 0.9976, 3e-4);
    close_shape(&s);
}
END_TEST

/* A box with its own bottom on the floor of the cube: what it covers is known to the digit, and no
 * light is said to leave from under it. */
START_TEST(test_box)
{
    static struct shape s;
    const double side = 0.3, tall = 0.2, low = 0.33;
    put_cube(&s);
    for (int i = 0; i < 8; i++)
        for (int k = 0; k < 3; k++)
            s.position[8 + i][k] = (k < 2 ? low : 0) + (k < 2 ? side : tall) * corners[i][k];
    for (uint32_t f = 0; f < 6; f++)
        for (int i = 0; i < 4; i++) /* fronts outside */
            s.corner[6 + f][i] = 8 + cube[f][3 - i];
    s.count = 12;
    compute(&s, RAD_CLOSURE_NONE);
    ck_assert_double_eq_tol(s.loss[0].covered, side * side, 3e-4);
    ck_assert_double_eq_tol(s.loss[6].covered, 1, 1e-9);
    for (uint32_t i = 0; i < s.count; i++)
        ck_assert(s.loss[i].sky == 0 && s.loss[i].backs == 0);
    close_shape(&s);
}
END_TEST

/* A block of the plan of an L, without a bottom, on a floor under the sky: the floor sees the sky
 * but for what the block covers and hides. Of so large a one few points would tell what it covers
 * to a sixteenth; so small a one stands between them. */
static const struct {
    double plan[6][2], covered, sky; /* the sky by 4e6 rays */
} block[] = {
    {{{.15, .15}, {.6, .15}, {.6, .35}, {.35, .35}, {.35, .7}, {.15, .7}}, 0.16, 0.7062},
    {{{.14, .14}, {.36, .14}, {.36, .25}, {.25, .25}, {.25, .36}, {.14, .36}}, 0.0363, 0.9052}};

START_TEST(test_block)
{
    static const uint32_t top[2][4] = {{0, 1, 2, 3}, {3, 4, 5, 0}};
    struct shape s;
    put_cube(&s);
    s.count = 1;
    for (uint32_t i = 0; i < 12; i++) {
        s.position[8 + i][0] = block[_i].plan[i % 6][0];
        s.position[8 + i][1] = block[_i].plan[i % 6][1];
        s.position[8 + i][2] = i < 6 ? 0 : 0.25;
    }
    for (uint32_t i = 0; i < 6; i++) {
        const uint32_t next = (i + 1) % 6, side[4] = {8 + i, 8 + next, 14 + next, 14 + i};
        memcpy(s.corner[s.count++], side, sizeof side);
    }
    for (uint32_t i = 0; i < 2; i++, s.count++)
        for (int k = 0; k < 4; k++)
            s.corner[s.count][k] = 14 + top[i][k];
    compute(&s, RAD_CLOSURE_NONE);
    ck_assert_double_eq_tol(s.loss[0].covered, block[_i].covered, 4e-3);
    ck_assert_double_eq_tol(s.loss[0].sky, block[_i].sky, 4e-3);
    ck_assert_double_eq(s.loss[0].backs, 0);
    ck_assert_double_eq_tol(s.sum[0] + s.loss[0].sky + s.loss[0].covered, 1, 1e-12);
    close_shape(&s);
}
END_TEST

/* A box without a bottom at the long side of a floor that is a triangle: what it covers does not
 * depend on the corner that the triangle is told from. Points that crowd at one would say .20. */
START_TEST(test_triangle)
{
    static const double floor[3][2] = {{1, 0}, {1, 0.5}, {0, 0.5}}, low = 0.015, high = 0.345;
    struct shape s;
    for (uint32_t first = 0; first < 3; first++) {
        put_cube(&s);
        for (uint32_t i = 0; i < 8; i++) {
            s.position[8 + i][0] = i % 4 == 1 || i % 4 == 2 ? high : low;
            s.position[8 + i][1] = i % 4 >= 2 ? 0.6785 : 0.4535;
            s.position[8 + i][2] = i < 4 ? 0 : 0.2;
        }
        for (uint32_t f = 1; f < 6; f++)
            for (int i = 0; i < 4; i++) /* fronts outside */
                s.corner[f][i] = 8 + cube[f][3 - i];
        for (uint32_t i = 0; i < 4; i++) {
            const double *at = floor[(i + first) % 3];
            s.position[i][0] = i < 3 ? at[0] : s.position[2][0];
            s.position[i][1] = i < 3 ? at[1] : s.position[2][1];
            s.position[i][2] = 0;
            s.corner[0][i] = i < 3 ? i : 2;
        }
        compute(&s, RAD_CLOSURE_NONE);
        ck_assert_double_eq_tol(s.loss[0].covered, 0.0553, 4e-3); /* 1e6 rays, as the sky */
        ck_assert_double_eq_tol(s.loss[0].sky, 0.8944, 4e-3);
        close_shape(&s);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("losses");
    TCase *rows = tcase_create("rows");
    tcase_add_test(rows, test_closed);
    tcase_add_test(rows, test_pillar);
    tcase_add_test(rows, test_chink);
    tcase_add_test(rows, test_slab);
    tcase_add_test(rows, test_box);
    tcase_add_test(rows, test_triangle);
    tcase_add_loop_test(rows, test_block, 0, sizeof block / sizeof *block);
    tcase_add_test(rows, test_sky);
    tcase_add_test(rows, test_turned);
    tcase_add_test(rows, test_both);
    tcase_add_test(rows, test_flip);
    tcase_add_test(rows, test_open);
    tcase_add_test(rows, test_inside_out);
    suite_add_tcase(suite, rows);
    return suite_failures(suite) > 0;
}
