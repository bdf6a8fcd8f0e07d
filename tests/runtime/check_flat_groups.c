/* check_flat_groups.c - groups of coplanar triangles are as good as those of quads.
 * Outlines against all directions tried in turn; links of a cube of triangles against those of the
 * same cube of quads; view factors of convex rooms, where nothing is hidden, against closed forms
 * and, pair by pair, against the contour integral. Rooms are turned in space: no axis is special.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <string.h>
#include "engine/exchange.h"
#include "hierarchy/flat_hull.h"
#include "hierarchy/group_hierarchy.h"
#include "kernel/polygon_factor.h"
#include "runtime/chance.h"
#include "scene/make_scene.h"
#include "study/closed_forms.h"
#include "suite.h"
#include "util/oracles.h"

/* ---- outlines */

/* The area of the rectangle around the points that lies along (x, y). */
static double around(const double (*p)[2], size_t n, double x, double y)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (size_t i = 0; i < n; i++) {
        const double at[2] = {p[i][0] * x + p[i][1] * y, p[i][1] * x - p[i][0] * y};
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], at[k]);
            high[k] = fmax(high[k], at[k]);
        }
    }
    return (high[0] - low[0]) * (high[1] - low[1]);
}

/* Is the outline convex, and do all points lie in it? */
static void check_around(const double (*outline)[2], size_t sides, const double (*p)[2], size_t n)
{
    for (size_t i = 0; i < sides; i++) {
        const double *a = outline[i], *b = outline[(i + 1) % sides], *c = outline[(i + 2) % sides];
        ck_assert_double_gt((b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]), 0);
        for (size_t j = 0; j < n; j++)
            ck_assert_double_gt((b[0] - a[0]) * (p[j][1] - a[1]) - (b[1] - a[1]) * (p[j][0] - a[0]),
                                -1e-12);
    }
}

/* Clouds of points: no direction has a rectangle smaller than the one found, by more than what lies
 * between two tried; the outline of four sides holds them all and is not far from the hull. */
START_TEST(test_clouds)
{
    enum { MOST = 40, TRIED = 20000 };
    uint64_t state = (uint64_t)_i << 32;
    double p[MOST][2], hull[MOST + 1][2], along[2], best = INFINITY;
    size_t n = 3 + (size_t)(chance(&state) * (MOST - 3));
    for (size_t i = 0; i < n; i++) {
        p[i][0] = chance(&state) * 3;
        p[i][1] = chance(&state) + 0.7 * p[i][0];
    }
    size_t corners = flat_hull(p, n, hull);
    check_around((const double(*)[2])hull, corners, (const double(*)[2])p, n);
    flat_hull_direction((const double(*)[2])hull, corners, along);
    ck_assert_double_eq_tol(hypot(along[0], along[1]), 1, 1e-12);
    double found = around((const double(*)[2])p, n, along[0], along[1]);
    for (int i = 0; i < TRIED; i++)
        best = fmin(best, around((const double(*)[2])p, n, cos(i * M_PI_2 / TRIED),
                                 sin(i * M_PI_2 / TRIED)));
    ck_assert_double_le(found, best * (1 + 1e-12));
    ck_assert_double_ge(found, best * (1 - 1e-3));
    double area = flat_area((const double(*)[2])hull, corners);
    size_t sides = flat_hull_quad(hull, corners);
    ck_assert_uint_le(sides, 4);
    check_around((const double(*)[2])hull, sides, (const double(*)[2])p, n);
    ck_assert_double_le(flat_area((const double(*)[2])hull, sides), 2 * area);
}
END_TEST

/* Faces in a row, along an axis but for rounding: which of them comes first is chance. */
START_TEST(test_in_a_row)
{
    enum { ROW = 12 };
    uint64_t state = 77 + (uint64_t)_i;
    double p[2 * ROW][2], hull[2 * ROW + 1][2];
    for (int i = 0; i < ROW; i++)
        for (int side = 0; side < 2; side++) {
            p[2 * i + side][0] = side - 0.5 + 1e-12 * (chance(&state) - 0.5);
            p[2 * i + side][1] = (i == 0 ? 0 : i == 1 ? 10 : 10 * chance(&state));
        }
    const size_t corners = flat_hull(p, 2 * ROW, hull);
    ck_assert_double_eq_tol(flat_area((const double(*)[2])hull, corners), 10, 1e-9);
    ck_assert_uint_eq(corners, 4);
}
END_TEST

/* A right triangle has two smallest rectangles; the one along its legs is taken. A gable loses a
 * side; what is left is known. Points on a line have no hull. */
START_TEST(test_shapes)
{
    double legs[3][2] = {{0, 0}, {2, 1}, {-2, 4}}, line[3][2] = {{0, 0}, {1, 1}, {3, 3}};
    double gable[6][2] = {{0, 0}, {1, 0}, {1, 1}, {0.5, 1.25}, {0, 1}, {0.5, 0}};
    double hull[7][2], along[2];
    ck_assert_uint_lt(flat_hull(line, 3, hull), 3);
    ck_assert_uint_eq(flat_hull(legs, 3, hull), 3);
    flat_hull_direction((const double(*)[2])hull, 3, along);
    double cosine = fabs(along[0] * 2 + along[1]) / sqrt(5);
    ck_assert(cosine < 1e-9 || cosine > 1 - 1e-9);
    ck_assert_uint_eq(flat_hull(gable, 6, hull), 5);
    ck_assert_double_eq_tol(flat_area((const double(*)[2])hull, 5), 1.125, 1e-12);
    ck_assert_uint_eq(flat_hull_quad(hull, 5), 4);
    /* a roof's side goes, and the other's reaches to the wall: 1/2 x 1/2 x 1/2 more */
    ck_assert_double_eq_tol(flat_area((const double(*)[2])hull, 4), 1.25, 1e-12);
}
END_TEST

/* ---- rooms */

/* Turned about two axes, and moved. */
static void turn(double p[3])
{
    double x = p[0] * cos(0.7) - p[1] * sin(0.7), y = p[0] * sin(0.7) + p[1] * cos(0.7);
    p[0] = x + 3;
    p[1] = y * cos(0.4) - p[2] * sin(0.4) - 2;
    p[2] = y * sin(0.4) + p[2] * cos(0.4) + 5;
}

/* turned: 2: and its corners rounded as a file of floats has them. */
static void add_face(struct scene *s, int turned, int n, const double *const corner[4])
{
    double p[4][3];
    for (int c = 0; c < n; c++) {
        memcpy(p[c], corner[c], sizeof p[c]);
        if (turned)
            turn(p[c]);
        for (int k = 0; k < 3 && turned == 2; k++)
            p[c][k] = (double)(float)p[c][k];
    }
    made_face(s, 0, n, (const double(*)[3])p);
}

enum mesh { QUADS, SAME_WAY, CROSSWISE };

/* The unit cube from inside, cells x cells on each wall: wall 2k, 2k + 1 across axis k. */
static void cube(struct scene *s, int cells, enum mesh mesh, int turned)
{
    made_open(s);
    made_material(s, 0.5, 0);
    for (int wall = 0; wall < 6; wall++)
        for (int cell = 0; cell < cells * cells; cell++) {
            double p[4][3];
            for (int c = 0; c < 4; c++) {
                int i = cell % cells + (c == 1 || c == 2), j = cell / cells + (c >= 2);
                p[c][wall / 2] = wall % 2;
                p[c][(wall / 2 + 1) % 3] = (wall % 2 ? j : i) / (double)cells;
                p[c][(wall / 2 + 2) % 3] = (wall % 2 ? i : j) / (double)cells;
            }
            int at = mesh == CROSSWISE && (cell % cells + cell / cells) % 2;
            if (mesh == QUADS) {
                add_face(s, turned, 4, (const double *const[]){p[0], p[1], p[2], p[3]});
                continue;
            }
            add_face(s, turned, 3, (const double *const[4]){p[at], p[at + 1], p[at + 2], NULL});
            add_face(s, turned, 3,
                     (const double *const[4]){p[at], p[at + 2], p[(at + 3) % 4], NULL});
        }
}

/* A triangle in four, so many times over. */
static void add_triangles(struct scene *s, const double p[3][3], int levels)
{
    if (levels == 0) {
        add_face(s, 1, 3, (const double *const[4]){p[0], p[1], p[2], NULL});
        return;
    }
    double m[3][3];
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++)
            m[c][k] = 0.5 * (p[c][k] + p[(c + 1) % 3][k]);
    for (int c = 0; c < 3; c++) {
        double q[3][3];
        memcpy(q[0], p[c], sizeof q[0]);
        memcpy(q[1], m[c], sizeof q[1]);
        memcpy(q[2], m[(c + 2) % 3], sizeof q[2]);
        add_triangles(s, (const double(*)[3])q, levels - 1);
    }
    add_triangles(s, (const double(*)[3])m, levels - 1);
}

/* A room from inside whose walls are a floor plan's sides, `corners` of them, each a quad; floor
 * and ceiling are fans of triangles. */
static void prism(struct scene *s, const double (*plan)[2], int corners, double height, int levels)
{
    made_open(s);
    made_material(s, 0.5, 0);
    for (int i = 0; i < corners; i++) {
        const double *a = plan[i], *b = plan[(i + 1) % corners];
        const double low[2][3] = {{a[0], a[1], 0}, {b[0], b[1], 0}},
                     high[2][3] = {{a[0], a[1], height}, {b[0], b[1], height}};
        double t[3][3];
        for (int half = 0; half < 2; half++) {
            memcpy(t[0], low[1], sizeof t[0]);
            memcpy(t[1], half ? high[0] : low[0], sizeof t[1]);
            memcpy(t[2], half ? high[1] : high[0], sizeof t[2]);
            add_triangles(s, (const double(*)[3])t, levels);
        }
        if (i == 0 || i == corners - 1)
            continue;
        for (int up = 0; up < 2; up++) {
            const double *q[3] = {plan[0], up ? b : a, up ? a : b};
            for (int c = 0; c < 3; c++) {
                t[c][0] = q[c][0];
                t[c][1] = q[c][1];
                t[c][2] = up ? height : 0;
            }
            add_triangles(s, (const double(*)[3])t, levels);
        }
    }
}

static void open_exchange(struct exchange *x, const struct scene *s)
{
    struct refiner *refiner = oracles_open("viewfactors", RELEASE_FLAT);
    const struct exchange_options options = {.tolerance = 3e-4, .threads = 2};
    const char *cause;
    ck_assert_int_eq(exchange_open(x, s, refiner, &options, &cause), 0);
    refiner_close(refiner);
}

/* Triangles, cut either way, have the links of quads, one per pair of walls; walls exchange what
 * squares do. */
START_TEST(test_cube)
{
    enum { CELLS = 8 };
    for (enum mesh mesh = QUADS; mesh <= CROSSWISE; mesh++) {
        struct scene s;
        struct exchange x;
        cube(&s, CELLS, mesh, _i);
        open_exchange(&x, &s);
        ck_assert_uint_eq(x.report.links, 15);
        uint32_t per_wall = s.face_count / 6;
        double *row = malloc(s.input_count * sizeof *row), walls[36] = {0};
        for (uint32_t i = 0; i < s.face_count; i++) {
            ck_assert_double_eq_tol(exchange_row(&x, i, row), 1, 1e-4);
            for (uint32_t j = 0; j < s.face_count; j++)
                walls[i / per_wall * 6 + j / per_wall] += row[j] / per_wall;
        }
        for (uint32_t i = 0; i < 36; i++)
            ck_assert_double_eq_tol(walls[i],
                                    i / 6 == i % 6        ? 0
                                    : i / 12 == i % 6 / 2 ? closed_parallel(1, 1, 1)
                                                          : closed_perpendicular(1, 1, 1),
                                    2e-5);
        free(row);
        exchange_close(&x);
        made_close(&s);
    }
}
END_TEST

/* Every pair of a convex room against the contour integral, within the tolerance; and how many
 * links it takes. */
static void check_prism(const double (*plan)[2], int corners, int levels, uint64_t most)
{
    struct scene s;
    struct exchange x;
    prism(&s, plan, corners, 0.8, levels);
    open_exchange(&x, &s);
    ck_assert_uint_le(x.report.links, most);
    double *row = malloc(s.input_count * sizeof *row);
    for (uint32_t p = 0; p<s.face_count; p += levels> 0 ? 17 : 1) {
        const struct element *e = exchange_tree_face(&x.tree, p);
        ck_assert_double_eq_tol(exchange_row(&x, s.faces[e->face].input, row), 1, 3e-4);
        for (uint32_t q = 0; q < s.face_count; q++) {
            const struct element *f = exchange_tree_face(&x.tree, q);
            double f_ij = dot3(e->normal, f->normal) > 1 - 1e-9 ? 0 : polygon_factor(e, f, 1);
            ck_assert_double_eq_tol(row[s.faces[f->face].input], f_ij, 3e-4 * fmax(f_ij, 1e-4));
        }
    }
    free(row);
    exchange_close(&x);
    made_close(&s);
}

START_TEST(test_prisms)
{
    const double wedge[3][2] = {{0, 0}, {2, 0}, {0.3, 1.1}};
    const double trapezoid[4][2] = {{0, 0}, {2, 0}, {1.4, 1}, {0.2, 1}};
    const double house[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0.5, 1.4}, {0, 1}};
    check_prism(wedge, 3, 3, 10);
    check_prism(trapezoid, 4, 3, 15);
    check_prism(house, 5, 3, 5000);
    /* face by face: each pair of faces that see each other is one link, at acute edges too */
    check_prism(wedge, 3, 0, 25);
    check_prism(trapezoid, 4, 0, 60);
}
END_TEST

/* How many groups of a wall of tiles around a window are as good as one face. `rounded`: the most
 * that each corner of each tile is off by, by itself. */
static int solid_groups(double size, double rounded)
{
    enum { CELLS = 12, LOW = 4, HIGH = 7 };
    struct scene s;
    struct hierarchy plain, h;
    uint64_t state = 3;
    int solid = 0;
    made_open(&s);
    made_material(&s, 0.5, 0);
    for (int i = 0; i < CELLS; i++)
        for (int j = 0; j < CELLS; j++) {
            double p[4][3];
            if (i >= LOW && i < HIGH && j >= LOW && j < HIGH)
                continue;
            for (int c = 0; c < 4; c++) {
                p[c][0] = size * (i + (c == 1 || c == 2)) / CELLS;
                p[c][1] = size * (j + (c >= 2)) / CELLS;
                p[c][2] = 0;
                turn(p[c]);
                for (int k = 0; k < 3; k++)
                    p[c][k] += rounded * (2 * chance(&state) - 1);
            }
            made_face(&s, 0, 4, (const double(*)[3])p);
        }
    ck_assert_int_eq(hierarchy_build(&plain, s.faces, s.face_count), 0);
    ck_assert_int_eq(hierarchy_build_groups(&h, &plain, 1e-6), 0);
    for (uint32_t e = 0; e < h.built; e++)
        solid += h.solid[e] && h.elements[e].children;
    hierarchy_free(&h);
    hierarchy_free(&plain);
    made_close(&s);
    return solid;
}

START_TEST(test_rounded)
{
    const double size = 1 + 0.01 * _i;
    ck_assert_int_gt(solid_groups(size, 0), 1);
    ck_assert_int_eq(solid_groups(size, 2e-7), solid_groups(size, 0));
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("flat groups");
    TCase *c = tcase_create("flat groups");
    tcase_set_timeout(c, 60);
    tcase_add_loop_test(c, test_clouds, 0, under_sanitizers() ? 5 : 20);
    tcase_add_loop_test(c, test_in_a_row, 0, under_sanitizers() ? 12 : 50);
    tcase_add_test(c, test_shapes);
    tcase_add_loop_test(c, test_cube, 0, 3);
    tcase_add_test(c, test_prisms);
    tcase_add_loop_test(c, test_rounded, 0, under_sanitizers() ? 5 : 20);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
