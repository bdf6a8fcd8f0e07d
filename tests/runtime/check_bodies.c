/* check_bodies.c - convex solids: which faces make one; what a point sees of a square past those of
 * a few faces, by the rims of their shadows, against what is left when the shadow of each face is
 * cut out; and what pairs of faces exchange past one of many, by its outline, against pair by pair.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "engine/exchange_horizon.h"
#include "kernel/polygon_factor.h"
#include "kernel/shaft.h"
#include "runtime/look_past.h"
#include "suite.h"

/* The corner of a box. */
static void add_tetrahedron(struct scene *s, const double at[3], const double (*along)[3])
{
    static const int corners[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    for (int f = 0; f < 4; f++) {
        double p[3][3];
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                p[i][k] = at[k] + (corners[f][i] ? along[corners[f][i] - 1][k] : 0);
        made_face(s, 0, 3, (const double(*)[3])p);
    }
}

/* Eight triangles, the upper corner at a height over the middle. */
static void add_octahedron(struct scene *s, const double c[3], double size, double height)
{
    for (int f = 0; f < 8; f++) {
        const int x = f & 1 ? 1 : -1, y = f & 2 ? 1 : -1, upper = f & 4;
        const double top = c[2] + (upper ? height : -size),
                     p[3][3] = {{c[0] + x * size, c[1], c[2]},
                                {c[0], c[1] + y * size, c[2]},
                                {c[0], c[1], top}},
                     q[3][3] = {{p[1][0], p[1][1], p[1][2]},
                                {p[0][0], p[0][1], p[0][2]},
                                {p[2][0], p[2][1], p[2][2]}};
        made_face(s, 0, 3, (const double(*)[3])((x * y > 0) == (upper != 0) ? p : q));
    }
}

/* Boxes and tetrahedra anywhere: before each other, through each other, through
 * both squares' planes and around the point. */
START_TEST(test_chance)
{
    uint64_t state = (uint64_t)_i;
    struct seen seen = {0};
    for (int scene = 0; scene < (under_sanitizers() ? 16 : 40); scene++) {
        struct scene s;
        struct exchange_tree t;
        open_squares(&s);
        for (int body = 0; body <= scene % 8; body++) {
            double edges[3][3], at[3];
            chance_edges(&state, body % 2 ? 0.3 : 0.6, edges);
            for (int k = 0; k < 3; k++)
                at[k] = chance(&state) - 0.3 * edges[0][k];
            if (body % 2)
                add_tetrahedron(&s, at, (const double(*)[3])edges);
            else
                made_box(&s, 0, at, (const double(*)[3])edges, 0);
        }
        open_tree(&t, &s);
        look_by_chance(&t, &s, &state, scene % 8 + 1, &seen);
    }
    ck_assert_double_gt(seen.partial, 0.5 * seen.points);
    ck_assert_double_gt(seen.hidden, 0.02 * seen.points);
    ck_assert_double_lt(seen.most, 1e-9);
}
END_TEST

/* Boxes side by side and on each other, along the squares' sides, none as long as another, so that
 * none has an edge of another's, one of them through the upper square's plane; from points under
 * their edges and corners, too. Shadows have edges along each other's there. */
START_TEST(test_in_rows)
{
    struct scene s;
    struct exchange_tree t;
    struct seen seen = {0};
    double x[162][3];
    open_squares(&s);
    for (int i = 0; i < 6; i++) {
        const double along[3][3] = {{0.25, 0, 0}, {0, 0.25 - 0.01 * i, 0}, {0, 0, 0.25 + 0.01 * i}};
        const double at[3] = {0.25 * (i % 3), 0.25 * (i / 3 + i % 2), i == 4 ? 0.8 : 0.25};
        made_box(&s, 0, at, along, 0);
        if (i == 1) {
            const double over[3] = {at[0], at[1], 0.51},
                         on_it[3][3] = {{0.125, 0, 0}, {0, 0.125, 0}, {0, 0, 0.125}};
            made_box(&s, 0, over, on_it, 0);
        }
    }
    open_tree(&t, &s);
    for (int i = 0; i < 162; i++) { /* the second half not in their planes */
        x[i][0] = 0.125 * (i % 9) + (i < 81 ? 0 : 0.03);
        x[i][1] = 0.125 * (i / 9 % 9) + (i < 81 ? 0 : 0.02);
        x[i][2] = 0;
    }
    look(&t, s.face_count, (const double(*)[3])x, 162, 7, &seen);
    ck_assert_double_gt(seen.partial, 0.5 * (seen.points - seen.untold));
    ck_assert_double_lt(seen.untold, 62);
    ck_assert_double_lt(seen.most, 1e-8);
    exchange_tree_close(&t);
    made_close(&s);
}
END_TEST

/* Of boxes that stand on what is looked from, points are in the plane of the lower faces, but for
 * how far they are off it; some are below a box. */
START_TEST(test_on_floor)
{
    struct scene s;
    struct exchange_tree t;
    struct seen seen = {0};
    double x[81][3];
    open_squares(&s);
    for (int i = 0; i < 4; i++) {
        const double at[3] = {0.15 + 0.5 * (i % 2), 0.2 + 0.5 * (i / 2), 0},
                     along[3][3] = {{0.2, 0, 0}, {0, 0.2, 0}, {0, 0, 0.3 + 0.1 * i}};
        made_box(&s, 0, at, along, 0);
    }
    open_tree(&t, &s);
    for (int i = 0; i < 81; i++) {
        x[i][0] = 0.04 + 0.12 * (i % 9);
        x[i][1] = 0.02 + 0.12 * (i / 9);
        x[i][2] = 0;
    }
    look(&t, s.face_count, (const double(*)[3])x, 81, 4, &seen);
    ck_assert_double_gt(seen.partial, 0.5 * seen.points);
    ck_assert_double_gt(seen.hidden, 0.1 * seen.points);
    ck_assert_double_eq(seen.untold, 0);
    ck_assert_double_lt(seen.most, 1e-9);
    exchange_tree_close(&t);
    made_close(&s);
}
END_TEST

/* Two boxes whose long edges are in one plane with the points, so that two edges of their shadows
 * run along each other, on one side of both; and a box one of whose edges points at the point. */
START_TEST(test_in_line)
{
    static const double at[2][3] = {{0.2, 0.3, 0.3}, {0.3, 0.35, 0.5}},
                        along[2][3][3] = {{{0.1, 0, 0}, {0, 0.3, 0}, {0, 0, 0.1}},
                                          {{0.2, 0, 0}, {0, 0.4, 0}, {0, 0, 0.1}}};
    uint64_t state = 1000;
    struct scene s;
    struct exchange_tree t;
    struct seen seen = {0};
    double x[33][3];
    open_squares(&s);
    for (int i = 0; i < 2; i++)
        made_box(&s, 0, at[i], along[i], 0);
    open_tree(&t, &s);
    for (int i = 0; i < 33; i++) { /* raised, in the plane of two edges on the left or the right */
        x[i][0] = t.host.ray_offset / (i % 2 + 1);
        x[i][1] = i / 32.0;
        x[i][2] = 0;
    }
    look(&t, s.face_count, (const double(*)[3])x, 33, 2, &seen);
    exchange_tree_close(&t);
    made_close(&s);
    for (int scene = 0; scene < (under_sanitizers() ? 50 : 200); scene++) {
        double edges[3][3], corner[3], eyes[3][3];
        open_squares(&s);
        chance_edges(&state, 0.15, edges);
        for (int k = 0; k < 3; k++)
            corner[k] = 0.4 + 0.2 * chance(&state);
        made_box(&s, 0, corner, (const double(*)[3])edges, 0);
        open_tree(&t, &s);
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                eyes[i][k] =
                    k < 2 ? corner[k] - (corner[2] - t.host.ray_offset) / edges[i][2] * edges[i][k]
                          : 0;
        look(&t, s.face_count, (const double(*)[3])eyes, 3, 1, &seen);
        exchange_tree_close(&t);
        made_close(&s);
    }
    ck_assert_double_lt(seen.most, 1e-8);
}
END_TEST

/* Boxes with their corners on a lattice: they touch and go through each other, share planes, sides
 * and corners with each other and with the upper square, stand on it and go through its plane; as
 * seen from points of the lattice, too. */
START_TEST(test_lattice)
{
    uint64_t state = (uint64_t)(2000 + 1000 * _i);
    struct seen seen = {0};
    for (int scene = 0; scene < (under_sanitizers() ? 60 : 100); scene++) {
        struct scene s;
        struct exchange_tree t;
        double x[40][3];
        int whole = 1;
        open_squares(&s);
        for (int box = 0; box < 2 + scene % 4; box++) {
            double at[3], along[3][3] = {{0}};
            for (int k = 0; k < 3; k++) {
                const int low = k == 2 ? 1 : -3, from = low + (int)((9 - low) * chance(&state));
                at[k] = from / 9.0;
                along[k][k] = (1 + (int)((10 - from) * chance(&state))) / 9.0;
            }
            made_box(&s, 0, at, (const double(*)[3])along, 0);
        }
        open_tree(&t, &s);
        for (uint32_t f = 2; f < s.face_count; f++) /* not so where two share an edge */
            whole &= t.bodies.of[t.h.face_element[f]] != 0;
        for (int i = 0; i < 40; i++) {
            for (int k = 0; k < 2; k++)
                x[i][k] = i % 2 ? chance(&state) : (1 + 2 * (int)(9 * chance(&state))) / 18.0;
            x[i][2] = 0;
        }
        if (whole)
            look(&t, s.face_count, (const double(*)[3])x, 40, scene % 4 + 2, &seen);
        exchange_tree_close(&t);
        made_close(&s);
    }
    ck_assert_double_gt(seen.points, 2000);
    ck_assert_double_lt(seen.untold, 0.01 * seen.points);
    ck_assert_double_gt(seen.partial, 0.3 * seen.points);
    ck_assert_double_lt(seen.most, 1e-7);
}
END_TEST

/* Two boxes in a row, one of them turned by next to nothing about the middle of both: where their
 * shadows' edges cross is not known, and points say so. */
START_TEST(test_turned)
{
    uint64_t state = 3000;
    struct seen seen = {0};
    for (int scene = 0; scene < 12; scene++) {
        const double turn = 1e-6 * pow(10, -0.5 * scene),
                     at[2][3] = {{0.2, 0.4, 0.4}, {0.35, 0, 0.4}},
                     along[3][3] = {{0.3, 0, 0}, {0, 0.2, 0}, {0, 0, 0.1}},
                     turned[3][3] = {{0.3, 0.3 * turn, 0}, {-0.2 * turn, 0.2, 0}, {0, 0, 0.1}},
                     other[3] = {at[1][0], 0.4 - 0.075 * turn, at[1][2]};
        struct scene s;
        struct exchange_tree t;
        open_squares(&s);
        made_box(&s, 0, at[0], along, 0);
        made_box(&s, 0, other, turned, 0);
        open_tree(&t, &s);
        look_by_chance(&t, &s, &state, 2, &seen);
    }
    ck_assert_double_lt(seen.most, 1e-8);
    ck_assert_double_gt(seen.untold, 0);
}
END_TEST

/* A point within a box that goes through the upper square's plane sees what of the square is in the
 * box, too: no face stands before that. */
START_TEST(test_within)
{
    static const double at[3] = {0.25, 0.25, -0.25},
                        along[3][3] = {{0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 1.5}},
                        x[1][3] = {{0.5, 0.5, 0}};
    struct scene s;
    struct exchange_tree t;
    struct seen seen = {0};
    open_squares(&s);
    made_box(&s, 0, at, along, 0);
    open_tree(&t, &s);
    look(&t, s.face_count, x, 1, 1, &seen);
    ck_assert_double_lt(seen.most, 1e-9);
    exchange_tree_close(&t);
    made_close(&s);
}
END_TEST

/* The two squares, and a small box in the middle between them. */
static void open_box_between(struct scene *s, struct exchange_tree *t)
{
    static const double at[3] = {0.4, 0.4, 0.4},
                        along[3][3] = {{0.2, 0, 0}, {0, 0.2, 0}, {0, 0, 0.2}};
    open_squares(s);
    made_box(s, 0, at, along, 0);
    open_tree(t, s);
}

/* A point that is hardly farther above the plane than it is raised off its own is not told. */
START_TEST(test_low)
{
    struct scene s;
    struct exchange_tree t;
    struct seen low = {0}, high = {0};
    open_box_between(&s, &t);
    const double up = t.lift, x[2][3] = {{0.5, 0.5, 1 - 8 * up}, {0.5, 0.5, 1 - 20 * up}};
    look(&t, s.face_count, &x[0], 1, 1, &low);
    look(&t, s.face_count, &x[1], 1, 1, &high);
    ck_assert_double_eq(low.untold, 1);
    ck_assert_double_eq(high.untold, 0);
    exchange_tree_close(&t);
    made_close(&s);
}
END_TEST

/* Where a corner of what is looked at lies in a plane that it is cut along, it may be there twice,
 * and the side between has any direction: no box is beside that. */
START_TEST(test_short_side)
{
    struct scene s;
    struct exchange_tree t;
    struct seen seen = {0};
    double x[9][3];
    open_box_between(&s, &t);
    for (int i = 0; i < 9; i++) {
        x[i][0] = 0.3 + 0.2 * (i % 3);
        x[i][1] = 0.3 + 0.2 * (i / 3);
        x[i][2] = 0;
    }
    for (int i = 0; i < 8; i++) {
        struct polygon part = {.n = 5};
        memcpy(part.v, face_of(&t, 1)->vertex, 4 * sizeof *part.v);
        memcpy(part.v[4], part.v[3], sizeof part.v[3]);
        part.v[4][0] += 1e-16 * cos(i);
        part.v[4][1] += 1e-16 * sin(i);
        look_at(&t, &part, s.face_count, (const double(*)[3])x, 9, 1, &seen);
    }
    ck_assert_double_gt(seen.partial, 0.5 * seen.points);
    ck_assert_double_lt(seen.most, 1e-9);
    ck_assert_double_eq(seen.untold, 0);
    exchange_tree_close(&t);
    made_close(&s);
}
END_TEST

/* A ball of triangles, each side of an octahedron split so often; `pushed`: one corner of it in. */
static void add_ball(struct scene *s, const double (*v)[3], int depth, int pushed)
{
    double p[3][3], middle[3][3], corner[3][3];
    if (depth == 0) {
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++) {
                const double size = pushed && v[i][2] > 0.999 ? 0.1 : 0.25;
                p[i][k] = 0.5 + size * v[i][k] / length3(v[i]);
            }
        made_face(s, 0, 3, (const double(*)[3])p);
        return;
    }
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            middle[i][k] = 0.5 * (v[i][k] + v[(i + 1) % 3][k]);
    for (int i = 0; i < 3; i++) {
        memcpy(corner[0], v[i], sizeof *corner);
        memcpy(corner[1], middle[i], sizeof *corner);
        memcpy(corner[2], middle[(i + 2) % 3], sizeof *corner);
        add_ball(s, (const double(*)[3])corner, depth - 1, pushed);
    }
    add_ball(s, (const double(*)[3])middle, depth - 1, pushed);
}

/* Four by four faces below, as many above, a ball of 512 triangles between. */
static void open_ball(struct scene *s, int pushed)
{
    made_open(s);
    made_material(s, 0.5, 0);
    for (int i = 0; i < 16; i++)
        made_quad(s, 0, i % 4 * 0.25, i / 4 * 0.25, 0, 0.25, 0, 0, 0, 0.25, 0);
    for (int i = 0; i < 16; i++)
        made_quad(s, 0, i % 4 * 0.25, i / 4 * 0.25, 1, 0, 0.25, 0, 0.25, 0, 0);
    for (int f = 0; f < 8; f++) {
        const double x = f & 1 ? 1 : -1, y = f & 2 ? 1 : -1, z = f & 4 ? 1 : -1;
        const double v[2][3][3] = {{{x, 0, 0}, {0, y, 0}, {0, 0, z}},
                                   {{0, y, 0}, {x, 0, 0}, {0, 0, z}}};
        add_ball(s, v[!(x * y * z > 0)], 3, pushed);
    }
}

/* The group of all faces with this one. */
static const struct element *group_of(const struct exchange_tree *t, uint32_t face)
{
    const struct element *most = NULL;
    uint32_t count = 0;
    for (uint32_t i = 0; i < t->h.built; i++) {
        const struct element *e = &t->h.elements[i];
        const struct face_range range = hierarchy_range(&t->h, i);
        int has = 0;
        for (uint32_t p = range.from; p < range.to; p++)
            has |= t->h.order[p] == face;
        if (has && e->group && range.to - range.from > count) {
            count = range.to - range.from;
            most = e;
        }
    }
    ck_assert_uint_eq(count, 16);
    return most;
}

/* Pairs past a ball, all at once, are what they are one by one; of a ball with a dent they are not
 * asked so. */
START_TEST(test_horizon)
{
    struct scene s;
    struct exchange_tree t;
    struct exchange_faces faces;
    struct sight_scratch scratch;
    struct sight_list list;
    struct shaft shaft;
    double values[16][16], most = 0, part = 0;
    open_ball(&s, _i);
    open_tree(&t, &s);
    const struct sight_limits limits = sight_limits_for(3e-4, s.input_count, s.face_count);
    const struct element *r = group_of(&t, 0), *e = group_of(&t, 16);
    const struct exchange_pair pair = {&t, r, e,
                                       hierarchy_range(&t.h, (uint32_t)(r - t.h.elements)),
                                       hierarchy_range(&t.h, (uint32_t)(e - t.h.elements))};
    struct horizon *horizon = horizon_open();
    ck_assert_ptr_nonnull(horizon);
    ck_assert_int_eq(exchange_faces_open(&faces, &t), 0);
    ck_assert_int_eq(sight_scratch_open(&scratch, &limits), 0);
    ck_assert_int_eq(shaft_open(&shaft, r, e, &t.host), 1);
    sight_list_find(&list, &t, &shaft);
    ck_assert_uint_eq(t.solids.count, _i ? 0 : 1);
    ck_assert_int_eq(
        horizon_block(&faces, &pair, r, e, &shaft, &list, horizon, &scratch, values[0], 16, &most),
        !_i);
    for (uint32_t i = 0; i < 16 && !_i; i++)
        for (uint32_t j = 0; j < 16; j++) {
            const struct element *a = exchange_tree_face(&t, pair.rows.from + i),
                                 *b = exchange_tree_face(&t, pair.columns.from + j);
            double error;
            const double one = sight_pair(a, b, &t, NULL, &scratch, 0, &error);
            ck_assert_double_le(fabs(values[i][j] - one), 2e-4 * fmax(one, limits.floor * a->area));
            part += one < 0.9 * a->area * polygon_factor(a, b, 1) && one > 0;
        }
    ck_assert_double_ge(part, _i ? 0 : 32);
    free(horizon);
    sight_scratch_close(&scratch);
    exchange_faces_close(&faces);
    exchange_tree_close(&t);
    made_close(&s);
}
END_TEST

/* A box is one, and an octahedron, and each of two boxes that share an edge; one without a lid,
 * one inside out, one that is pushed in and a plate of two faces are none. */
START_TEST(test_which)
{
    static const double along[3][3] = {{0.2, 0, 0}, {0, 0.2, 0}, {0, 0, 0.2}},
                        inside_out[3][3] = {{0, 0.2, 0}, {0.2, 0, 0}, {0, 0, 0.2}};
    const double at[5][3] = {
        {0, 0, 0.1}, {0.5, 0, 0.1}, {0, 0.5, 0.1}, {0.5, 0.5, 0.1}, {0.7, 0.7, 0.1}};
    const double middle[2][3] = {{0.8, 0.2, 0.5}, {0.2, 0.8, 0.5}};
    const uint32_t faces[8] = {2, 8, 16, 21, 27, 39, 41, 49};
    struct scene s;
    struct exchange_tree t;
    open_squares(&s);
    made_box(&s, 0, at[0], along, 0);
    add_octahedron(&s, middle[0], 0.1, 0.1);
    made_box(&s, 0, at[1], along, 1);
    made_box(&s, 0, at[2], inside_out, 0);
    made_box(&s, 0, at[3], along, 0);
    made_box(&s, 0, at[4], along, 0);
    made_quad(&s, 0, 0.3, 0.3, 0.9, 0.1, 0, 0, 0, 0.1, 0);
    made_quad(&s, 0, 0.3, 0.3, 0.9, 0, 0.1, 0, 0.1, 0, 0);
    add_octahedron(&s, middle[1], 0.1, -0.05);
    ck_assert_int_eq((int)s.face_count, (int)faces[7]);
    open_tree(&t, &s);
    for (int i = 0; i < 7; i++)
        for (uint32_t f = faces[i]; f < faces[i + 1]; f++)
            ck_assert_int_eq(t.bodies.of[t.h.face_element[f]] != 0, i < 2 || i == 4);
    ck_assert_int_eq(t.bodies.body[0].faces, 6);
    ck_assert_int_eq(t.bodies.body[0].corners, 8);
    ck_assert_int_eq(t.bodies.body[0].edges, 12);
    exchange_tree_close(&t);
    made_close(&s);
}
END_TEST

/* Boxes whose faces are rounded each by itself: corners that should be one are next to each other,
 * some of them on either side of any line there is. */
START_TEST(test_rounded)
{
    enum { BOXES = 125 };
    static const double ROUNDED = 1e-7;
    struct scene s;
    struct exchange_tree t;
    uint64_t state = 1;
    open_squares(&s);
    for (int i = 0; i < BOXES; i++) {
        const double at[3] = {0.1 + 0.2 * (i % 5), 0.1 + 0.2 * (i / 5 % 5), 0.1 + 0.05 * (i / 25)};
        double edges[3][3];
        chance_edges(&state, 0.02, edges);
        made_box(&s, 0, at, (const double(*)[3])edges, 0);
    }
    for (uint32_t f = 0; f < s.face_count; f++)
        for (int i = 0; i < 12; i++)
            s.faces[f].vertex[i / 3][i % 3] += ROUNDED * (chance(&state) - 0.5);
    open_tree(&t, &s);
    for (uint32_t f = 2; f < s.face_count; f++)
        ck_assert_uint_gt(t.bodies.of[t.h.face_element[f]], 0);
    for (int i = 0; i < BOXES; i++)
        ck_assert_int_eq(t.bodies.body[i].corners, 8);
    exchange_tree_close(&t);
    made_close(&s);
}
END_TEST

/* The icosahedron between the squares; the great one joins the same corners the long way, bends out
 * across each edge, and runs through itself: it is no solid. */
START_TEST(test_great)
{
    static const double golden = 1.6180339887498949;
    double corner[12][3];
    for (int i = 0; i < 12; i++) {
        const int axis = i / 4;
        corner[i][axis] = 0.5;
        corner[i][(axis + 1) % 3] = 0.5 + (i & 1 ? 0.1 : -0.1);
        corner[i][(axis + 2) % 3] = 0.5 + (i & 2 ? 0.1 : -0.1) * golden;
    }
    const double side = 0.2 * (_i ? golden : 1);
    struct scene s;
    struct exchange_tree t;
    uint32_t faces = 0;
    open_squares(&s);
    for (int i = 0; i < 12; i++)
        for (int j = i + 1; j < 12; j++)
            for (int k = j + 1; k < 12; k++) {
                double a[3], b[3], c[3], n[3], out[3], p[3][3];
                sub3(a, corner[j], corner[i]);
                sub3(b, corner[k], corner[i]);
                sub3(c, corner[k], corner[j]);
                if (fabs(length3(a) - side) + fabs(length3(b) - side) + fabs(length3(c) - side)
                    > 1e-9)
                    continue;
                cross3(n, a, b);
                for (int x = 0; x < 3; x++)
                    out[x] = corner[i][x] - 0.5;
                const int turned = dot3(n, out) < 0;
                memcpy(p[0], corner[i], sizeof p[0]);
                memcpy(p[1], corner[turned ? k : j], sizeof p[1]);
                memcpy(p[2], corner[turned ? j : k], sizeof p[2]);
                made_face(&s, 0, 3, (const double(*)[3])p);
                faces++;
            }
    ck_assert_uint_eq(faces, 20);
    open_tree(&t, &s);
    ck_assert_uint_eq(t.solids.count, _i ? 0 : 1);
    ck_assert_int_eq(t.bodies.of[t.h.face_element[2]] != 0, !_i);
    exchange_tree_close(&t);
    made_close(&s);
}
END_TEST

/* What a solid is behind does not depend on the sign of a zero in a normal. */
START_TEST(test_zeros)
{
    enum { TILES = 8 };
    struct scene s;
    made_open(&s);
    made_material(&s, 0.5, 0);
    for (int face = 0; face < 6; face++)
        for (int i = 0; i < TILES * TILES; i++)
            made_tile(&s, 0, 0, face, i, TILES, 0);
    struct exchange_tree t;
    const char *cause;
    ck_assert_int_eq(exchange_tree_open(&t, s.faces, s.face_count, 1, &cause), 0);
    ck_assert_uint_eq(t.solids.count, 1);
    for (int face = 0; face < 6; face++)
        for (int signs = 0; signs < 8; signs++) {
            const struct element *e = &t.h.elements[t.h.face_element[face * TILES * TILES]];
            double n[3];
            for (int k = 0; k < 3; k++)
                n[k] = fabs(e->normal[k]) > 0.5 ? e->normal[k] : signs >> k & 1 ? -0.0 : 0.0;
            ck_assert_uint_eq(
                solids_behind(&t.solids, &t.h, n, (const double(*)[3])e->vertex, 4, 1e-6), 1);
        }
    exchange_tree_close(&t);
    made_close(&s);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bodies");
    TCase *tests = tcase_create("bodies");
    tcase_set_timeout(tests, 120);
    suite_add_tcase(suite, tests);
    tcase_add_loop_test(tests, test_chance, 0, 4);
    tcase_add_test(tests, test_in_rows);
    tcase_add_test(tests, test_on_floor);
    tcase_add_test(tests, test_in_line);
    tcase_add_loop_test(tests, test_lattice, 0, 4);
    tcase_add_test(tests, test_turned);
    tcase_add_test(tests, test_within);
    tcase_add_loop_test(tests, test_great, 0, 2);
    tcase_add_test(tests, test_low);
    tcase_add_test(tests, test_short_side);
    tcase_add_test(tests, test_which);
    tcase_add_test(tests, test_rounded);
    tcase_add_loop_test(tests, test_horizon, 0, 2);
    tcase_add_test(tests, test_zeros);
    return suite_failures(suite);
}
