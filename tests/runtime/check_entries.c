/* check_entries.c - entries of view factors in half shadow against quadrature that shares nothing
 * with the library (quad_judge.h): three quads, each in the others' half shadow, many of which
 * cross each other's plane. Every entry is within the tolerance asked for, of itself or of 1e-4,
 * and none is above what it is where nothing stands between.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "engine/exchange.h"
#include "engine/exchange_tree.h"
#include "kernel/constants.h"
#include "util/oracles.h"
#include "scene/make_scene.h"
#include "runtime/make_polygons.h"
#include "runtime/quad_judge.h"
#include "suite.h"

enum { QUADS = 3, SCENES = 45 };

/* All rows of a scene, f[count * count], by the library. Returns the error it estimates. */
static double rows_of(const struct scene *made, double tolerance, double *f)
{
    struct exchange x;
    const char *cause;
    struct refiner *refiner = oracles_open("viewfactors", RELEASE_FLAT);
    exchange_set_tolerance(refiner, tolerance);
    const struct exchange_options options = {.tolerance = tolerance, .threads = 1};
    ck_assert_int_eq(exchange_open(&x, made, refiner, &options, &cause), 0);
    for (uint32_t i = 0; i < made->input_count; i++)
        (void)exchange_row(&x, i, f + made->input_count * i);
    double error = x.report.entry_error;
    exchange_close(&x);
    refiner_close(refiner);
    return error;
}

/* The same of so many quads. */
static double factors_of(int count, const double (*quad)[4][3], double tolerance, double *f)
{
    struct scene made;
    made_open(&made);
    made_material(&made, 0.5, 0);
    for (int i = 0; i < count; i++)
        made_face(&made, 0, 4, quad[i]);
    const double error = rows_of(&made, tolerance, f);
    made_close(&made);
    return error;
}

static double three_factors(const double (*quad)[4][3], double tolerance, double f[QUADS][QUADS])
{
    return factors_of(QUADS, quad, tolerance, &f[0][0]);
}

/* Returns the largest error, as a share of what is allowed. */
static double judge(const double (*quad)[4][3], double tolerance, int cells)
{
    double f[QUADS][QUADS], worst = 0;
    double estimate = three_factors(quad, tolerance, f);
    ck_assert(estimate >= 0 && estimate < 1);
    for (int i = 0; i < QUADS; i++)
        for (int j = 0; j < QUADS; j++) {
            if (i == j) {
                ck_assert(f[i][j] == 0);
                continue;
            }
            double right = judge_factor(quad[i], quad[j], quad[QUADS - i - j], cells),
                   clear = judge_factor(quad[i], quad[j], NULL, cells / 4);
            if (f[i][j] > 0.99 * clear)
                clear = judge_factor(quad[i], quad[j], NULL, 2 * cells);
            double share = fabs(f[i][j] - right) / (tolerance * fmax(right, 1e-4));
            if (share > 1)
                printf("F_%d%d is %.9g, not %.9g: %.2f of the tolerance %g\n", i, j, f[i][j], right,
                       share, tolerance);
            worst = fmax(worst, share);
            ck_assert_double_le(f[i][j], clear * (1 + 1e-5));
        }
    return worst;
}

/* A plate 5 cm over a face hides nearly all of a lamp from it, the more so in its middle. How large
 * the scene is besides does not matter: another face stands by, 10 or 100 m away. */
START_TEST(test_far_face)
{
    static const double far[] = {10, 100};
    double quad[4][4][3] =
        {{{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 0}},
         {{-2, 2, 0.5}, {2, 2, 0.5}, {2, -2, 0.5}, {-2, -2, 0.5}},
         {{-0.2, 0.2, 0.05}, {0.2, 0.2, 0.05}, {0.2, -0.2, 0.05}, {-0.2, -0.2, 0.05}}},
           f[16];
    const double(*all)[4][3] = (const double(*)[4][3])quad,
          right = judge_factor(all[0], all[1], all[2], 48);
    for (int i = 0; i < 2; i++) {
        const double x = far[i];
        const double away[4][3] = {{x, 0, -1}, {x + 1, 0, -1}, {x + 1, 1, -1}, {x, 1, -1}};
        memcpy(quad[3], away, sizeof away);
        (void)factors_of(4, all, 1e-4, f);
        printf("beside a face %g m away %.7f, right: %.7f\n", x, f[1], right);
        ck_assert_double_eq_tol(f[1], right, 1e-4 * right);
    }
}
END_TEST

/* How far off their faces points look from, of a floor of 2 x 2 m and a box on it that is so much
 * too high (m). */
static double lift_of(double high, double *rays)
{
    const double o = 0.5, p = 1.25, z[2] = {high, high + 0.5};
    const double quad[6][4][3] = {{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}},
                                  {{o, o, z[1]}, {p, o, z[1]}, {p, p, z[1]}, {o, p, z[1]}},
                                  {{o, o, z[0]}, {p, o, z[0]}, {p, o, z[1]}, {o, o, z[1]}},
                                  {{p, o, z[0]}, {p, p, z[0]}, {p, p, z[1]}, {p, o, z[1]}},
                                  {{p, p, z[0]}, {o, p, z[0]}, {o, p, z[1]}, {p, p, z[1]}},
                                  {{o, p, z[0]}, {o, o, z[0]}, {o, o, z[1]}, {o, p, z[1]}}};
    struct scene made;
    struct exchange_tree tree;
    const char *cause;
    made_open(&made);
    made_material(&made, 0.5, 0);
    for (int i = 0; i < 6; i++)
        made_face(&made, 0, 4, quad[i]);
    ck_assert_int_eq(exchange_tree_open(&tree, made.faces, made.face_count, 1, &cause), 0);
    const double lift = tree.lift;
    *rays = tree.host.ray_offset;
    exchange_tree_close(&tree);
    made_close(&made);
    return lift;
}

/* A box that stands as exactly as doubles say, one off by the last of seven digits, and one that
 * hovers. */
START_TEST(test_misfit)
{
    double rays;
    ck_assert_double_eq_tol(lift_of(0, &rays) / rays, SIGHT_LIFT, 1e-12);
    ck_assert_double_eq_tol(lift_of(1e-7, &rays), SIGHT_MISFITS * 1e-7, 1e-12);
    ck_assert_double_eq_tol(lift_of(-1e-7, &rays), SIGHT_MISFITS * 1e-7, 1e-12);
    ck_assert_double_eq_tol(lift_of(1e-2, &rays) / rays, SIGHT_LIFT, 1e-12);
}
END_TEST

START_TEST(test_crossing_planes)
{
    static const double quad[QUADS][4][3] = {
        {{22, 0, 0}, {22, 0, 22}, {15, 45, 22}, {15, 45, 0}},
        {{33, 67, 5}, {33, 153, 5}, {-22, 153, 5}, {-22, 67, 5}},
        {{0, 0, 0}, {0, 67, 0}, {0, 67, 22}, {0, 0, 22}}};
    double f[QUADS][QUADS];
    (void)three_factors(quad, 3e-4, f);
    ck_assert_double_eq_tol(f[0][1] / 0.00122079, 1, 3e-4);
    ck_assert_double_lt(judge(quad, 3e-4, 96), 1);
    ck_assert_double_lt(judge(quad, 3e-3, 24), 1);
}
END_TEST

/* Two plates between squares, each near one of them: wherever points stand, on either square, one
 * of the shades lies between them. The plates hide nothing of each other to speak of, so what they
 * hide together is the sum of what each does, told from the square that is far from it. */
START_TEST(test_small_shades)
{
    static const double quad[4][4][3] = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                                         {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}},
                                         {{.2887, .3459, .1867},
                                          {.2752, .3488, .1879},
                                          {.2740, .3393, .1980},
                                          {.2875, .3364, .1968}},
                                         {{.0811, .8312, .9231},
                                          {.0698, .8216, .9434},
                                          {.0922, .8188, .9545},
                                          {.1035, .8284, .9342}}};
    static const double tolerance[] = {3e-4, 1e-4, 1e-5};
    double f[16];
    const double clear = judge_factor(quad[0], quad[1], NULL, 96),
                 first = judge_factor(quad[1], quad[0], quad[2], 96),
                 second = judge_factor(quad[0], quad[1], quad[3], 96),
                 right = first + second - clear;
    ck_assert_double_gt(clear - first, 1e-5);
    ck_assert_double_gt(clear - second, 5e-5);
    for (int i = 0; i < 3; i++) {
        const double said = factors_of(4, quad, tolerance[i], f);
        ck_assert_double_eq_tol(f[1], right, tolerance[i] * right);
        ck_assert_double_le(fabs(f[1] - right), said);
    }
}
END_TEST

/* The soffit of a doorway as a cupboard sees it. The walls beside and above touch its sides; one of
 * them hides some of it, the others hide nothing from anywhere, and are no reason for doubt. */
START_TEST(test_touching)
{
    static const double quad[5][4][3] = {
        {{.5, 3, 0}, {.5, 4.4, 0}, {.5, 4.4, 1.9}, {.5, 3, 1.9}},
        {{3.1, 3, 2.1}, {3, 3, 2.1}, {3, 3.9, 2.1}, {3.1, 3.9, 2.1}},
        {{3, 8, 0}, {3, 3.9, 0}, {3, 3.9, 2.5}, {3, 8, 2.5}},
        {{3, 3, 0}, {3, 0, 0}, {3, 0, 2.5}, {3, 3, 2.5}},
        {{3, 3.9, 2.1}, {3, 3, 2.1}, {3, 3, 2.5}, {3, 3.9, 2.5}}};
    static const double tolerance[] = {3e-4, 1e-4};
    double f[25];
    const double right = judge_factor(quad[1], quad[0], quad[2], 256);
    ck_assert_double_lt(right, judge_factor(quad[1], quad[0], NULL, 256) * (1 - 1e-3));
    for (int i = 0; i < 2; i++) {
        const double said = factors_of(5, quad, tolerance[i], f);
        ck_assert_double_eq_tol(f[5], right, tolerance[i] * right);
        ck_assert_double_le(fabs(f[5] - right), said);
        ck_assert_double_le(said, tolerance[i]);
    }
}
END_TEST

/* Five triangles of which two go through others are many faces by then, but each entry is looked at
 * as in other small scenes. Right is an adaptive rule over the first, with all that hides of the
 * second cut out in space. */
START_TEST(test_crossing_faces)
{
    static const double v[15][3] = {
        {0.63696168732145431, 0.26978671376387031, 0.040973523936194689},
        {0.016527635528529094, 0.81327023920027242, 0.91275557727772172},
        {0.60663577576717986, 0.7294965609839984, 0.54362499146542287},
        {0.58033238598685066, 0.2986961328189226, 0.67199487795635937},
        {0.1995154439682133, 0.94211311050649782, 0.36511016824482856},
        {0.10549527957022953, 0.62910815153970923, 0.92715455306786743},
        {0.93507242378776823, 0.81585355412153215, 0.0027385001701480949},
        {0.85740427658756935, 0.033585575305464355, 0.72965544642994407},
        {0.17565562060255901, 0.86317892234988658, 0.54146122024909171},
        {0.48583535883178908, 0.88948783434900025, 0.93404351595624968},
        {0.35779519670907023, 0.57152983072976093, 0.32186939107594215},
        {0.59430003019969679, 0.33791122550713326, 0.39161900052816123},
        {0.89027435200479232, 0.22715759353337972, 0.62318714468604242},
        {0.084015343582384827, 0.83264414765339778, 0.78709830748868337},
        {0.23936944299295215, 0.87648423081070381, 0.058568034805194347}};
    double row[5], areas[5];
    clear();
    for (int i = 0; i < 15; i += 3)
        polygon(&v[i], 3);
    factors(1, 1e-4, row, areas);
    ck_assert_double_eq_tol(row[1] / 0.03469358, 1, 1e-4);
}
END_TEST

/* A floor and a round lamp over it, with a plate between. The lamp's entry is one, in many parts,
 * and those of its rim are next to nothing; right is the sum over its quads. Lost: what a part has
 * too much error, or too few pieces, for the whole. */
START_TEST(test_many_corners)
{
    enum { CORNERS = 42, FOUR = (CORNERS - 2) / 2 };
    static const double tolerance[] = {1e-4, 1e-5};
    static const double floor[4][3] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
    double plate[4][3] = {{.7, .6, .5}, {1.2, .7, .55}, {1.1, 1.3, .6}, {.6, 1.2, .55}};
    double v[CORNERS][3], row[3], areas[3], right = 0;
    for (int i = 0; i < CORNERS; i++) {
        v[i][0] = 1 + .4 * cos(-2 * M_PI * i / CORNERS);
        v[i][1] = .9 + .35 * sin(-2 * M_PI * i / CORNERS);
        v[i][2] = 1;
    }
    for (int i = 0; i < FOUR; i++) {
        double part[4][3];
        for (int k = 0; k < 4; k++)
            memcpy(part[k], v[k ? 2 * i + k : 0], sizeof part[k]);
        right += judge_factor(floor, (const double(*)[3])part, (const double(*)[3])plate, 64);
    }
    for (int i = 0; i < 2; i++) {
        clear();
        polygon((const double(*)[3])floor, 4);
        polygon((const double(*)[3])v, CORNERS);
        polygon((const double(*)[3])plate, 4);
        factors(1, tolerance[i], row, areas);
        printf("a lamp of %d corners %.8f, right: %.8f\n", CORNERS, row[1], right);
        ck_assert_double_eq_tol(row[1], right, tolerance[i] * right);
    }
}
END_TEST

/* Boxes in a row, each turned on its feet: what is far apart sees little of each other, with all
 * the others between. */
enum { BOXES = 24, BOX_FACES = 5 * BOXES };
static void open_row_of_boxes(void)
{
    clear();
    for (int b = 0; b < BOXES; b++) {
        const double turn = 0.7 * b, u[3] = {cos(turn), sin(turn), 0}, v[3] = {-u[1], u[0], 0},
                     up[3] = {0, 0, 1}, minus_u[3] = {-u[0], -u[1], 0},
                     minus_v[3] = {u[1], -u[0], 0};
        double at[5][3];
        for (int k = 0; k < 3; k++) {
            const double corner = (k == 0   ? 2.0 * b
                                   : k == 1 ? 3 * sin(b)
                                            : 0)
                                  - 0.5 * u[k] - 0.5 * v[k];
            at[0][k] = corner;
            at[1][k] = corner + u[k];
            at[2][k] = corner + u[k] + v[k];
            at[3][k] = corner + v[k];
            at[4][k] = corner + up[k];
        }
        rectangle(at[0], u, up);
        rectangle(at[1], v, up);
        rectangle(at[2], minus_u, up);
        rectangle(at[3], minus_v, up);
        rectangle(at[4], u, v);
    }
}

/* Pairs that exchange far less than the error that is allowed are asked by few rays. With an
 * allowance of a thousandth none is: by that entries are right to an eighth of what is allowed, and
 * their sum is right, as rays err to either side. */
START_TEST(test_faint)
{
    static double coarse[BOX_FACES * BOX_FACES], fine[BOX_FACES * BOX_FACES], areas[BOX_FACES];
    const double tolerance = 1e-2;
    double off = 0, faint = 0, doubt = 0;
    int pairs = 0;
    open_row_of_boxes();
    factors(BOX_FACES, tolerance, coarse, areas);
    factors(BOX_FACES, 1e-3 * tolerance, fine, areas);
    const double allowed = tolerance * 4 / sqrt(BOX_FACES);
    for (int i = 0; i < BOX_FACES * BOX_FACES; i++) {
        const double error = coarse[i] - fine[i];
        ck_assert_double_le(fabs(error), fmax(tolerance * fine[i], allowed));
        if (!(fine[i] > 0) || fine[i] > allowed / 8)
            continue;
        ck_assert_double_le(fabs(error), allowed / 8);
        pairs++;
        faint += fine[i];
        off += error;
        doubt += error * error;
    }
    ck_assert_int_gt(pairs, 300);
    /* both entries of a pair have one error */
    ck_assert_double_le(fabs(off), 2 * sqrt(2 * doubt) + 0.01 * faint);
}
END_TEST

/* A room of so many tiles a side with plates in a row in it, seen past by its walls: shades that
 * repeat along them. */
enum { FIN_FACES = 6 * 9 + 6 * 8 };
static int fins_of(int tiles, int plates, double thick, double tolerance, double *f,
                   double *estimate)
{
    const double along[3][3] = {{thick, 0, 0}, {0, 0.6, 0}, {0, 0, 0.5}};
    const int of_room = 6 * tiles * tiles;
    struct scene made;
    made_open(&made);
    made_material(&made, 0.5, 0);
    for (int i = 0; i < of_room; i++)
        made_tile(&made, 0, 0, i / (tiles * tiles), i % (tiles * tiles), tiles, 1);
    for (int i = 0; i < plates; i++) {
        const double at[3] = {0.2 + 0.6 * i / plates, 0.2, 0.2};
        made_box(&made, 0, at, along, 0);
    }
    *estimate = rows_of(&made, tolerance, f);
    const int faces = (int)made.input_count;
    made_close(&made);
    return faces;
}

/* One entry of each by quadrature that shares nothing with the library: 7 points in each of 2,048
 * triangles, of either face; the two differ by less than 3e-5 of an entry. All others by a
 * tolerance of a 30th. */
START_TEST(test_fins)
{
    static const struct {
        int tiles, plates;
        double thick;
        int from, onto;
        double right;
    } of[3] = {{1, 5, 0.02, 5, 4, 0.084749},
               {2, 6, 0.001, 16, 13, 0.0164825},
               {3, 8, 0.001, 21, 32, 0.0061032}};
    static const double tolerance = 3e-4;
    static double f[FIN_FACES * FIN_FACES], fine[FIN_FACES * FIN_FACES];
    for (int t = 0; t < 3; t++) {
        double estimate, least;
        const int faces = fins_of(of[t].tiles, of[t].plates, of[t].thick, tolerance, f, &estimate);
        (void)fins_of(of[t].tiles, of[t].plates, of[t].thick, tolerance / 30, fine, &least);
        const int at = of[t].from * faces + of[t].onto;
        const double allowed = tolerance * SIGHT_FLOOR_MANY / sqrt(faces);
        double worst = 0;
        for (int i = 0; i < faces * faces; i++)
            worst = fmax(worst, fabs(f[i] - fine[i]));
        printf("past %d fins %.7f and %.7f, right: %.7f; off by %.2f of what is allowed\n",
               of[t].plates, f[at], fine[at], of[t].right, worst / allowed);
        ck_assert_double_le(fabs(f[at] - of[t].right), allowed);
        ck_assert_double_le(fabs(fine[at] - of[t].right), 0.1 * allowed);
        ck_assert_double_le(worst, allowed);
        ck_assert_double_le(worst, estimate + 0.1 * allowed);
    }
}
END_TEST

/* A desk of that side on four legs, which have neither tops nor bottoms. */
struct desk {
    double at[2], side, thick;
};
static void add_desk(struct scene *made, const struct desk *desk)
{
    const double tall = 0.7, leg = 0.05, s = desk->side, at[3] = {desk->at[0], desk->at[1], tall},
                 seat[3][3] = {{s, 0, 0}, {0, s, 0}, {0, 0, desk->thick}},
                 along[3][3] = {{leg, 0, 0}, {0, leg, 0}, {0, 0, tall}};
    made_box(made, 0, at, seat, 0);
    for (int i = 0; i < 4; i++) {
        const double foot[3] = {at[0] + (i / 2 ? s - 0.08 : 0.02),
                                at[1] + (i % 2 ? s - 0.09 : 0.03), 0};
        made_box(made, 0, foot, along, 2);
    }
}

/* So many tiles a side of the rectangle from u to v. */
static void add_wall(struct scene *made, int tiles, const double at[3], const double u[3],
                     const double v[3])
{
    const double part = 1. / tiles;
    for (int i = 0; i < tiles * tiles; i++) {
        double o[3];
        for (int k = 0; k < 3; k++)
            o[k] = at[k] + part * (i / tiles * u[k] + i % tiles * v[k]);
        made_quad(made, 0, o[0], o[1], o[2], part * u[0], part * u[1], part * u[2], part * v[0],
                  part * v[1], part * v[2]);
    }
}

/* Two desks in a room. One leg is seen by the other desk's edge past a seat, and past a leg that
 * no point of a group's rule looks past; another by the wall beside the edge of a seat, where
 * points of a piece and of its quarters agree and those along its rim do not. One entry of each by
 * midpoint sums of 3,600 by 3,600 points, which differ by less than 2e-5 from those of 1,600, all
 * others by a tolerance of a 30th. */
START_TEST(test_desks)
{
    enum { TILES = 3, WALLS = 6 * TILES * TILES, DESK = 22, DESK_SCENE = WALLS + 2 * DESK };
    static const struct {
        struct desk desk[2];
        int from, onto;
        double right;
    } of[2] = {{{{{0.43, 1.025}, 0.96, 0.045}, {{2.35, 0.525}, 1.09, 0.0455}},
                WALLS + 7,
                WALLS + DESK + 2,
                0.003452},
               {{{{0.6, 0.75}, 1, 0.05}, {{2.15, 0.38}, 1, 0.035}}, WALLS + 15, 34, 0.016660}};
    static const double tolerance = 3e-4, o[3] = {0, 0, 0}, x[3] = {4, 0, 0}, y[3] = {0, 3, 0},
                        z[3] = {0, 0, 2.5};
    static double f[DESK_SCENE * DESK_SCENE], fine[DESK_SCENE * DESK_SCENE];
    const double allowed = tolerance * SIGHT_FLOOR_MANY / sqrt(DESK_SCENE);
    struct scene made;
    made_open(&made);
    made_material(&made, 0.5, 0);
    add_wall(&made, TILES, o, x, y);
    add_wall(&made, TILES, z, y, x);
    add_wall(&made, TILES, o, z, x);
    add_wall(&made, TILES, y, x, z);
    add_wall(&made, TILES, o, y, z);
    add_wall(&made, TILES, x, z, y);
    for (int i = 0; i < 2; i++)
        add_desk(&made, &of[_i].desk[i]);
    ck_assert_uint_eq(made.face_count, DESK_SCENE);
    (void)rows_of(&made, tolerance, f);
    (void)rows_of(&made, tolerance / 30, fine);
    made_close(&made);
    const int at = of[_i].from * DESK_SCENE + of[_i].onto;
    double worst = 0, row = 0;
    for (int i = 0; i < DESK_SCENE; i++) {
        double sum = 0;
        for (int j = 0; j < DESK_SCENE; j++) {
            worst = fmax(worst, fabs(f[i * DESK_SCENE + j] - fine[i * DESK_SCENE + j]));
            sum += f[i * DESK_SCENE + j] - fine[i * DESK_SCENE + j];
        }
        row = fmax(row, fabs(sum));
    }
    printf("past desks %.6f and %.6f, right: %.6f; off by %.2f of what is allowed, a row by "
           "%.2f\n",
           f[at], fine[at], of[_i].right, worst / allowed, row / tolerance);
    ck_assert_double_le(fabs(f[at] - of[_i].right), allowed);
    ck_assert_double_le(fabs(fine[at] - of[_i].right), 0.15 * allowed);
    ck_assert_double_le(worst, allowed);
    ck_assert_double_le(row, tolerance);
}
END_TEST

static double chance(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * (1 / 9007199254740992.0);
}

/* A trapezoid anywhere in a cube, any way up. */
static void random_quad(double v[4][3], uint64_t *state)
{
    double u[3], w[3], n[3], o[3] = {0, 0, 0}, uu, uw, ww;
    do {
        for (int k = 0; k < 3; k++) {
            u[k] = 2 * chance(state) - 1;
            w[k] = 2 * chance(state) - 1;
        }
        judge_cross(o, u, w, n);
        uu = judge_dot(u, u);
        uw = judge_dot(u, w);
        ww = judge_dot(w, w);
    } while (!(uu > 0.1 && ww > 0.1 && fabs(uw) < 0.5 * sqrt(uu * ww)));
    double narrow = 0.4 + 0.6 * chance(state);
    for (int k = 0; k < 3; k++) {
        double c = 2 * chance(state) - 1;
        v[0][k] = c - 0.5 * u[k] - 0.5 * w[k];
        v[1][k] = c + 0.5 * u[k] - 0.5 * w[k];
        v[2][k] = c + 0.5 * narrow * u[k] + 0.5 * w[k];
        v[3][k] = c - 0.5 * narrow * u[k] + 0.5 * w[k];
    }
}

/* Does an edge of a meet b, made larger by a tenth? */
static int meets(const double (*a)[3], const double (*b)[3])
{
    double large[4][3], n[3], m[3], p[3];
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 3; k++)
            large[i][k] = 1.1 * b[i][k] - 0.1 * 0.25 * (b[0][k] + b[1][k] + b[2][k] + b[3][k]);
    judge_cross(b[0], b[1], b[2], n);
    for (int i = 0; i < 4; i++) {
        const double *from = a[i], *to = a[(i + 1) % 4];
        double h = judge_dot(n, from) - judge_dot(n, b[0]),
               g = judge_dot(n, to) - judge_dot(n, b[0]);
        int inside = (h > 0) != (g > 0);
        for (int k = 0; k < 3 && inside; k++)
            p[k] = from[k] + h / (h - g) * (to[k] - from[k]);
        for (int e = 0; e < 4 && inside; e++) {
            judge_cross(large[e], large[(e + 1) % 4], p, m);
            inside = judge_dot(m, n) > 0;
        }
        if (inside)
            return 1;
    }
    return 0;
}

/* The two without the third, and with it, by few points: does it shade, and cross a plane? */
static int of_interest(const double (*quad)[4][3])
{
    int shaded = 0;
    for (int i = 0; i < QUADS; i++)
        for (int j = 0; j < QUADS; j++)
            if (i != j && meets(quad[i], quad[j]))
                return 0;
    for (int i = 0; i < QUADS; i++) {
        int j = (i + 1) % QUADS;
        double clear = judge_factor(quad[i], quad[j], NULL, 4),
               seen = judge_factor(quad[i], quad[j], quad[QUADS - i - j], 4);
        shaded += seen > 1e-4 && seen < 0.98 * clear;
    }
    return shaded > 0;
}

START_TEST(test_random_scenes)
{
    uint64_t state = 17;
    double worst = 0, quad[QUADS][4][3];
    for (int at = 0; at < SCENES;) {
        for (int i = 0; i < QUADS; i++)
            random_quad(quad[i], &state);
        if (!of_interest((const double(*)[4][3])quad))
            continue;
        worst = fmax(worst, judge((const double(*)[4][3])quad, 1e-3, 24));
        at++;
    }
    ck_assert_double_lt(worst, 1);
}
END_TEST

/* Light that passes between two crossing shades, to a thirtieth of the face that no point of the
 * first rules sees lit: with it F is .02996996, by triangles of points each of which sees the
 * other face exactly; without it .02994306. */
START_TEST(test_gap)
{
    static const double at[6][3][3] = {
        {{0.27, 0.47, 0.49}, {-0.1, -0.04, 0.21}, {0.12, -0.39, -0.01}},
        {{0.83, 0.45, 0.34}, {-0.1, -0.09, -0.12}, {0.36, -0.82, 0.31}},
        {{0.29, 0.32, 0.05}, {-0.34, -0.84, -0.36}, {0.89, -0.32, -0.09}},
        {{0.93, 0.79, 0.55}, {-0.86, -0.07, -0.22}, {0.02, -0.74, 0.15}},
        {{0.66, 0.95, 0.73}, {-0.41, 0.42, -0.77}, {0.12, -0.4, -0.28}},
        {{0.84, 0.78, 0.19}, {-0.07, 0.13, 0.11}, {-0.14, -0.63, 0.69}}};
    static const double tolerance[3] = {1e-3, 3e-4, 1e-4}, right = 0.02996996;
    double row[6], areas[6];
    clear();
    for (int i = 0; i < 6; i++)
        rectangle(at[i][0], at[i][1], at[i][2]);
    for (int i = 0; i < 3; i++) {
        factors(1, tolerance[i], row, areas);
        ck_assert_double_eq_tol(row[4] / right, 1, 0.25 * tolerance[i]);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("entries");
    TCase *tests = tcase_create("entries");
    tcase_set_timeout(tests, 60);
    suite_add_tcase(suite, tests);
    tcase_add_test(tests, test_far_face);
    tcase_add_test(tests, test_misfit);
    tcase_add_test(tests, test_crossing_planes);
    tcase_add_test(tests, test_small_shades);
    tcase_add_test(tests, test_gap);
    tcase_add_test(tests, test_touching);
    tcase_add_test(tests, test_crossing_faces);
    tcase_add_test(tests, test_many_corners);
    tcase_add_test(tests, test_faint);
    tcase_add_test(tests, test_fins);
    tcase_add_loop_test(tests, test_desks, 0, 2);
    tcase_add_test(tests, test_random_scenes);
    return suite_failures(suite);
}
