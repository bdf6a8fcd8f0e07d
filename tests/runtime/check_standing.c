/* check_standing.c - solids that stand on something, with no face there, and plates beside solids:
 * which faces make one, and what points see past them, against what is left when the shadow of each
 * face is cut out.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include "engine/exchange.h"
#include "engine/exchange_sight.h"
#include "kernel/polygon_factor.h"
#include "runtime/look_past.h"
#include "suite.h"
#include "terms/visibility.h"
#include "util/oracles.h"

/* A corner by its share of the three edges. */
static void corner_of(double out[3], const double at[3], const double (*along)[3], double u,
                      double v, double w)
{
    for (int k = 0; k < 3; k++)
        out[k] = at[k] + u * along[0][k] + v * along[1][k] + w * along[2][k];
}

/* A box within those edges, without its first faces: the upper, the lower, a side. */
static void add_part(struct scene *s, const double at[3], const double (*along)[3],
                     const double low[3], const double high[3], int missing)
{
    double from[3], part[3][3];
    corner_of(from, at, along, low[0], low[1], low[2]);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            part[i][k] = (high[i] - low[i]) * along[i][k];
    made_box(s, 0, from, (const double(*)[3])part, missing);
}

/* A quad, or its two halves. */
static void add_patch(struct scene *s, const double (*p)[3], int halves)
{
    const double half[3][3] = {
        {p[0][0], p[0][1], p[0][2]}, {p[2][0], p[2][1], p[2][2]}, {p[3][0], p[3][1], p[3][2]}};
    made_face(s, 0, halves ? 3 : 4, p);
    if (halves)
        made_face(s, 0, 3, half);
}

/* A seat on four legs, which have neither tops nor bottoms; a ground for these, of one box or of
 * two triangles. */
static void add_table(struct scene *s, const double at[3], const double (*along)[3], int plate)
{
    const double seat[2][3] = {{0, 0, 0.8}, {1, 1, 1}},
                 ground[2][3] = {{-0.1, -0.1, -0.1}, {1.1, 1.1, 0}};
    add_part(s, at, along, seat[0], seat[1], 0);
    for (int leg = 0; leg < 4; leg++) {
        const double x = leg % 2 ? 0.85 : 0.05, y = leg / 2 ? 0.7 : 0.1,
                     part[2][3] = {{x, y, 0}, {x + 0.1, y + 0.2, 0.8}};
        add_part(s, at, along, part[0], part[1], 2);
    }
    if (!plate) {
        add_part(s, at, along, ground[0], ground[1], 0);
        return;
    }
    double p[4][3];
    for (int i = 0; i < 4; i++)
        corner_of(p[i], at, along, i == 1 || i == 2 ? 1.1 : -0.1, i / 2 ? 1.1 : -0.1, 0);
    add_patch(s, (const double(*)[3])p, 1);
}

/* Three edges at right angles, turned by chance, one of them not. */
static void upright(uint64_t *state, double size, double edges[3][3])
{
    const double turn = 6.3 * chance(state);
    const double turned[3][3] = {{size * cos(turn), size * sin(turn), 0},
                                 {-0.8 * size * sin(turn), 0.8 * size * cos(turn), 0},
                                 {0, 0, 0.7 * size}};
    memcpy(edges, turned, sizeof turned);
}

/* Tables anywhere, also through the upper square's plane; one point in eight is within a leg. */
START_TEST(test_tables)
{
    uint64_t state = (uint64_t)(100 * _i);
    struct seen seen = {0};
    for (int scene = 0; scene < 40; scene++) {
        struct scene s;
        struct exchange_tree t;
        double edges[3][3], at[3], x[40][3];
        open_squares(&s);
        if (scene % 2)
            chance_edges(&state, 0.5, edges);
        else
            upright(&state, 0.5, edges);
        for (int k = 0; k < 3; k++)
            at[k] = (k < 2 ? 0.1 : 0.3) + 0.4 * chance(&state);
        add_table(&s, at, (const double(*)[3])edges, scene % 4 > 1);
        open_tree(&t, &s);
        for (uint32_t f = 2; f < s.face_count; f++)
            ck_assert_int_eq(t.bodies.of[t.h.face_element[f]] != 0
                                 || t.bodies.of[hierarchy_surface(&t.h, f)->parent] != 0,
                             scene % 4 < 2 || f < 2 + 6 + 16);
        for (int i = 0; i < 40; i++) {
            x[i][0] = chance(&state);
            x[i][1] = chance(&state);
            x[i][2] = 0;
            if (i % 8 == 0)
                corner_of(x[i], at, (const double(*)[3])edges, 0.1, 0.2, 0.8 * chance(&state));
        }
        look(&t, s.face_count, (const double(*)[3])x, 40, scene % 4 < 2 ? 6 : 7, &seen);
        exchange_tree_close(&t);
        made_close(&s);
    }
    ck_assert_double_gt(seen.partial, 0.4 * seen.points);
    ck_assert_double_lt(seen.untold, 0.2 * seen.points);
    ck_assert_double_lt(seen.most, 1e-8);
}
END_TEST

/* Boxes, and plates before them, through them and through the square's plane. */
START_TEST(test_plates)
{
    uint64_t state = (uint64_t)(5000 + 100 * _i);
    struct seen seen = {0};
    for (int scene = 0; scene < 40; scene++) {
        struct scene s;
        struct exchange_tree t;
        open_squares(&s);
        for (int i = 0; i < 4; i++) {
            double edges[3][3], at[3];
            chance_edges(&state, 0.4, edges);
            for (int k = 0; k < 3; k++)
                at[k] = chance(&state) - 0.3 * edges[0][k];
            if (i < 2)
                made_box(&s, 0, at, (const double(*)[3])edges, 0);
            else
                made_quad(&s, 0, at[0], at[1], at[2], edges[0][0], edges[0][1], edges[0][2],
                          edges[1][0], edges[1][1], edges[1][2]);
        }
        open_tree(&t, &s);
        look_by_chance(&t, &s, &state, 4, &seen);
    }
    ck_assert_double_gt(seen.partial, 0.4 * seen.points);
    ck_assert_double_lt(seen.untold, 0.01 * seen.points);
    ck_assert_double_lt(seen.most, 1e-9);
}
END_TEST

/* A quad or its two halves at a height, from x = 0.2 as far as 0.2 + wide; turned: it looks down.
 */
static void add_cover(struct scene *s, double from, double wide, double z, int turned)
{
    if (turned)
        made_quad(s, 0, from, 0.2, z, 0, 0.4, 0, wide, 0, 0);
    else
        made_quad(s, 0, from, 0.2, z, wide, 0, 0, 0, 0.4, 0);
}

/* A tube between two covers is one; not where one is missing, does not cover all, is too far away,
 * or covers half from either side; nor where two neighbouring sides are missing. */
START_TEST(test_which)
{
    static const double at[3] = {0.3, 0.3, 0.3},
                        along[3][3] = {{0.2, 0, 0}, {0, 0.2, 0}, {0, 0, 0.2}};
    static const struct {
        int is, missing, covers;
        struct {
            double from, wide, z;
            int turned;
        } cover[3];
    } cases[] = {
        {1, 2, 2, {{0.2, 0.4, 0.3, 0}, {0.2, 0.4, 0.5, 1}}},
        {1, 2, 2, {{0.3, 0.2, 0.3, 1}, {0.3, 0.2, 0.5, 1}}},
        {1, 2, 3, {{0.2, 0.4, 0.3, 0}, {0.2, 0.15, 0.5, 1}, {0.35, 0.2, 0.5, 1}}},
        {1, 1, 1, {{0.2, 0.4, 0.5, 1}}},
        {0, 2, 1, {{0.2, 0.4, 0.3, 0}}},
        {0, 2, 1, {{0.2, 0.4, 0.5, 0}}},
        {0, 2, 2, {{0.2, 0.4, 0.3, 0}, {0.2, 0.29, 0.5, 1}}},
        {0, 2, 2, {{0.2, 0.4, 0.3, 0}, {0.2, 0.4, 0.501, 1}}},
        {0, 2, 3, {{0.2, 0.4, 0.3, 0}, {0.2, 0.15, 0.5, 1}, {0.36, 0.2, 0.5, 1}}},
        {0, 2, 3, {{0.2, 0.4, 0.3, 0}, {0.2, 0.2, 0.5, 1}, {0.4, 0.2, 0.5, 0}}},
        {0, 3, 2, {{0.2, 0.4, 0.3, 0}, {0.2, 0.4, 0.5, 1}}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct scene s;
        struct exchange_tree t;
        open_squares(&s);
        made_box(&s, 0, at, along, cases[i].missing);
        for (int k = 0; k < cases[i].covers; k++)
            add_cover(&s, cases[i].cover[k].from, cases[i].cover[k].wide, cases[i].cover[k].z,
                      cases[i].cover[k].turned);
        open_tree(&t, &s);
        for (uint32_t f = 2; f < 8 - (uint32_t)cases[i].missing; f++)
            ck_assert_msg((t.bodies.of[t.h.face_element[f]] != 0) == cases[i].is,
                          "case %zu, face %u", i, f);
        if (cases[i].is)
            ck_assert_int_eq(t.bodies.body[0].lids, cases[i].missing);
        exchange_tree_close(&t);
        made_close(&s);
    }
}
END_TEST

/* A box whose upper face is in five parts, as where something narrow stands on it, with corners in
 * the middle of edges: they stand in shafts as one face when they are of one polygon, which has no
 * holes; else they are a lid. */
START_TEST(test_parts)
{
    static const double at[3] = {0.3, 0.3, 0.3},
                        along[3][3] = {{0.2, 0, 0}, {0, 0.2, 0}, {0, 0, 0.2}},
                        part[5][4] = {{0, 0, 0.2, 0.05},
                                      {0, 0.05, 0.07, 0.1},
                                      {0.07, 0.05, 0.06, 0.1},
                                      {0.13, 0.05, 0.07, 0.1},
                                      {0, 0.15, 0.2, 0.05}};
    for (int polygons = 1; polygons <= 5; polygons += 4) {
        struct scene s;
        struct exchange_tree t;
        open_squares(&s);
        made_box(&s, 0, at, along, 1);
        for (int i = 0; i < 5; i++) {
            made_quad(&s, 0, 0.3 + part[i][0], 0.3 + part[i][1], 0.5, part[i][2], 0, 0, 0,
                      part[i][3], 0);
            s.faces[s.face_count - 1].input = (uint32_t)(polygons == 1 ? 7 : 7 + i);
        }
        open_tree(&t, &s);
        ck_assert_int_eq(t.bodies.body[0].lids, polygons != 1);
        if (polygons == 1)
            ck_assert_int_eq(t.bodies.body[0].faces, 6);
        exchange_tree_close(&t);
        made_close(&s);
    }
}
END_TEST

/* A column on a floor whose cells end at its foot, in quads or in triangles: its sides are four,
 * and neither the floor around it nor what it stands on is of it, though they share its edges. The
 * cell under it is in two strips. */
START_TEST(test_foot)
{
    struct scene s;
    struct exchange_tree t;
    open_squares(&s);
    for (int i = 0; i < 10; i++) {
        const int at = i < 9 ? i : 4;
        const double low = 0.2 + 0.2 * (at % 3) + (i == 9 ? 0.1 : 0), wide = at == 4 ? 0.1 : 0.2,
                     y = 0.2 + 0.2 * (at / 3),
                     cell[4][3] = {{low, y, 0.2},
                                   {low + wide, y, 0.2},
                                   {low + wide, y + 0.2, 0.2},
                                   {low, y + 0.2, 0.2}};
        add_patch(&s, cell, _i);
    }
    const uint32_t first = s.face_count;
    for (int i = 0; i < 4; i++) {
        static const double around[5][2] = {
            {0.4, 0.4}, {0.6, 0.4}, {0.6, 0.6}, {0.4, 0.6}, {0.4, 0.4}};
        const double *a = around[i], *b = around[i + 1],
                     side[4][3] = {{a[0], a[1], 0.2},
                                   {b[0], b[1], 0.2},
                                   {b[0], b[1], 0.6},
                                   {a[0], a[1], 0.6}};
        add_patch(&s, side, _i);
    }
    const double top[4][3] = {{0.4, 0.4, 0.6}, {0.6, 0.4, 0.6}, {0.6, 0.6, 0.6}, {0.4, 0.6, 0.6}};
    add_patch(&s, top, _i);
    /* in one plane with a side, whose halves are not tiles of one outline then */
    made_quad(&s, 0, 0.05, 0.4, 0.3, 0.1, 0, 0, 0, 0, 0.1);
    open_tree(&t, &s);
    const uint32_t of = t.bodies.of[t.h.face_element[first]]
                            ? t.bodies.of[t.h.face_element[first]]
                            : t.bodies.of[hierarchy_surface(&t.h, first)->parent];
    ck_assert_uint_ne(of, 0);
    ck_assert_int_eq(t.bodies.body[of - 1].faces, 5);
    ck_assert_int_eq(t.bodies.body[of - 1].lids, 1);
    ck_assert_int_eq(t.bodies.body[of - 1].edges, 12);
    ck_assert_int_eq(t.bodies.body[of - 1].corners, 8);
    exchange_tree_close(&t);
    made_close(&s);
}
END_TEST

/* A seat on four legs in a closed room, thin and between the points where rays ask what a row
 * lacks: what stands there is known, and is no error of the row. */
START_TEST(test_covered)
{
    static const double at[2] = {0.2, 0.5}, along[3][3] = {{0.6, 0, 0}, {0, 0.6, 0}, {0, 0, 0.05}},
                        leg[3][3] = {{0.012, 0, 0}, {0, 0.012, 0}, {0, 0, 0.5}},
                        foot[2] = {0.2 + 0.6 * 0.0525, 0.2 + 0.6 * 0.9275};
    static const uint32_t material[6] = {0};
    const double seat[3] = {at[0], at[0], at[1]};
    struct scene s;
    struct exchange x;
    const char *cause;
    made_open(&s);
    made_material(&s, 0.5, 0);
    made_room(&s, material, 1, 1, 1);
    made_box(&s, 0, seat, along, 0);
    for (int i = 0; i < 4; i++) {
        const double from[3] = {foot[i % 2], foot[i / 2], 0};
        made_box(&s, 0, from, leg, 2);
    }
    struct refiner *refiner = oracles_open("viewfactors", RELEASE_FLAT);
    exchange_set_tolerance(refiner, 2e-5);
    const struct exchange_options options = {.tolerance = 2e-5, .threads = 1};
    ck_assert_int_eq(exchange_open(&x, &s, refiner, &options, &cause), 0);
    const double share = 4 * 0.012 * 0.012 / (0.6 * 0.6);
    ck_assert_double_eq_tol(x.losses[7].covered, share, 0.02 * share); /* the seat's lower side */
    ck_assert_double_eq(x.losses[6].covered, 0);
    ck_assert_double_le(x.report.defect_most, 6e-5);
    exchange_close(&x);
    refiner_close(refiner);
    made_close(&s);
}
END_TEST

/* A prism of six sides, upright, two of them across x. */
static void add_prism(struct scene *s, double x, double y, double z)
{
    static const double size = 0.04, tall = 0.1, around[6][2] = {{1, -0.6}, {1, 0.6},   {0, 1},
                                                                 {-1, 0.6}, {-1, -0.6}, {0, -1}};
    double p[2][6][3];
    for (int i = 0; i < 12; i++) {
        p[i / 6][i % 6][0] = x + size * around[i % 6][0];
        p[i / 6][i % 6][1] = y + size * around[i % 6][1];
        p[i / 6][i % 6][2] = z + (i < 6 ? 0 : tall);
    }
    for (int i = 0; i < 6; i++) {
        double side[4][3];
        const int next = (i + 1) % 6;
        memcpy(side[0], p[0][i], sizeof *side);
        memcpy(side[1], p[0][next], sizeof *side);
        memcpy(side[2], p[1][next], sizeof *side);
        memcpy(side[3], p[1][i], sizeof *side);
        made_face(s, 0, 4, (const double(*)[3])side);
    }
    for (int half = 0; half < 2; half++)
        for (int upper = 0; upper < 2; upper++) {
            double part[4][3];
            for (int k = 0; k < 4; k++)
                memcpy(part[k], p[upper][(3 * half + (upper ? k : 3 - k)) % 6], sizeof *part);
            made_face(s, 0, 4, (const double(*)[3])part);
        }
}

/* Forty-two prisms between the squares, with more faces than are cut out of a polygon; points of
 * the lower square are in planes of some. What both exchange, against rays. */
START_TEST(test_many)
{
    struct scene s;
    struct exchange_tree t;
    struct sight_scratch scratch;
    double error;
    open_squares(&s);
    for (int i = 0; i < 42; i++)
        add_prism(&s, 0.54 + 0.14 * (i % 7 - 3), (i / 7 + 0.5) / 6, 0.3 + 0.01 * i);
    open_tree(&t, &s);
    const struct sight_limits limits = sight_limits_for(3e-4, s.input_count, s.face_count);
    const struct element *low = face_of(&t, 0), *high = face_of(&t, 1);
    ck_assert_int_eq(sight_scratch_open(&scratch, &limits), 0);
    const double value = sight_pair(low, high, &t, NULL, &scratch, 0, &error),
                 clear = polygon_factor(low, high, 1),
                 rays = visibility_rays(low, high, &t.host, SOBOL_MOST, 0);
    ck_assert_double_eq_tol(value, clear * rays, 4 * clear * sqrt(rays * (1 - rays) / SOBOL_MOST));
    sight_scratch_close(&scratch);
    exchange_tree_close(&t);
    made_close(&s);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("standing");
    TCase *tests = tcase_create("standing");
    tcase_set_timeout(tests, 120);
    suite_add_tcase(suite, tests);
    tcase_add_loop_test(tests, test_tables, 0, 4);
    tcase_add_loop_test(tests, test_plates, 0, 4);
    tcase_add_test(tests, test_which);
    tcase_add_test(tests, test_parts);
    tcase_add_loop_test(tests, test_foot, 0, 2);
    tcase_add_test(tests, test_covered);
    tcase_add_test(tests, test_many);
    return suite_failures(suite);
}
