/* check_stacked.c - solids between faces: a box on another box on a floor, a post with or without
 * ends between two boards, a house of outer and inner walls in the same planes, two rooms with a
 * lamp below the ceiling of the one.
 *
 * All values are known: what lies under a solid with a face there sees nothing, what is joined by a
 * tube without ends sees through it, and closed rooms sum to what is not covered of them.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "radiosity.h"
#include "runtime/make_polygons.h"
#include "study/closed_forms.h"
#include "suite.h"

/* The six sides of a box, seen from outside or, with inside, from there: bottom, top, x, y. Sides
 * left out are set in `without`. */
static void box(const double low[3], const double high[3], int inside, unsigned without)
{
    static const int axis[6] = {2, 2, 0, 0, 1, 1};
    for (int side = 0; side < 6; side++) {
        const int k = axis[side], up = side % 2, i = (k + 1) % 3, j = (k + 2) % 3;
        double at[3] = {low[0], low[1], low[2]}, u[3] = {0, 0, 0}, v[3] = {0, 0, 0};
        if (without >> side & 1)
            continue;
        at[k] = up ? high[k] : low[k];
        u[i] = high[i] - low[i];
        v[j] = high[j] - low[j];
        rectangle(at, up != inside ? u : v, up != inside ? v : u);
    }
}

/* A floor of n x n tiles, and the walls and the ceiling of a room. */
static void room(double wide, double tall, int n)
{
    const double low[3] = {0, 0, 0}, high[3] = {wide, wide, tall}, u[3] = {wide / n, 0, 0},
                 v[3] = {0, wide / n, 0};
    for (int i = 0; i < n * n; i++) {
        const double at[3] = {i % n * u[0], i / n * v[1], 0};
        rectangle(at, u, v);
    }
    box(low, high, 1, 1);
}

/* Two boxes on a floor of n x n tiles, the upper one smaller, or so much above the lower one. */
static const struct {
    int tiles;
    double less, gap;
} stack[] = {{1, 0, 0},    {1, 0.1, 0},  {3, 0, 0},      {3, 0.1, 0},   {1, 0.1, 1e-8},
             {3, 0, 1e-8}, {1, 0, 1e-6}, {1, 0.1, 1e-5}, {3, 0.1, 1e-6}};

START_TEST(test_boxes)
{
    static double f[FACES * FACES], area[FACES];
    const int n = stack[_i].tiles, lower = n * n + 5, upper = lower + 6;
    const double less = stack[_i].less, from = 0.3 + stack[_i].gap,
                 low[2][3] = {{1, 1, 0}, {1 + less, 1 + less, from}},
                 high[2][3] = {{2, 2, 0.3}, {2 - less, 2 - less, from + 0.3}};
    double floor = 0;
    clear();
    room(3, 2, n);
    for (int i = 0; i < 2; i++)
        box(low[i], high[i], 0, 0);
    factors(scene.faces, 0, f, area);
    for (int i = 0; i < n * n; i++) {
        floor += area[i] / 9 * row_sum(f, (uint32_t)i);
        ck_assert_double_le(f[(size_t)i * scene.faces + (size_t)upper], 3e-4);
    }
    ck_assert_double_eq_tol(floor, 8.0 / 9, 3e-4);
    /* a gap is a contact, or all that is seen across it is what is below */
    const double below = f[(size_t)upper * scene.faces + (size_t)lower + 1];
    ck_assert_double_eq_tol(row_sum(f, (uint32_t)upper), below, 3e-4);
    ck_assert_double_eq_tol(below, below > 0.5 && stack[_i].gap > 0, 3e-4);
    ck_assert_double_eq_tol(row_sum(f, (uint32_t)lower), 0, 3e-4);
    for (int i = lower + 2; i < upper; i++)
        ck_assert_double_eq_tol(row_sum(f, (uint32_t)i), 1, 3e-4);
}
END_TEST

/* What two boards exchange past a post of .2 x .2 between them, .5 apart. */
static double past_post(int ends)
{
    static double f[FACES], area[FACES];
    const double low[3] = {1.4, 1.4, 0}, high[3] = {1.6, 1.6, 0.5}, o[3] = {0, 0, 0},
                 top[3] = {1, 1, 0.5}, x[3] = {3, 0, 0}, y[3] = {0, 3, 0}, u[3] = {1, 0, 0},
                 v[3] = {0, 1, 0};
    clear();
    rectangle(o, x, y);
    rectangle(top, v, u);
    box(low, high, 0, ends ? 0 : 3);
    factors(1, 1e-5, f, area);
    return f[1];
}

/* Without ends it is a tube, through which the squares at its ends see each other: Howell's
 * catalog, C-11. */
START_TEST(test_post)
{
    const double square = closed_parallel(0.2, 0.2, 0.5);
    ck_assert_double_eq_tol(past_post(0) - past_post(1), 0.04 / 9 * square, 2e-6);
}
END_TEST

/* Is anything looked at again? */
static int is_again(void *again, const struct RadProgress *progress)
{
    *(int *)again |= strcmp(progress->phase, "again") == 0;
    return 0;
}

/* A post without ends from floor to ceiling: what it stands on sees the other end through it, which
 * is what rows have more than what is not covered of them, and no reason to doubt their entries. */
START_TEST(test_pipe)
{
    static const double low[3] = {0.2, 0.2, 0}, high[3] = {0.6, 0.6, 1};
    const double sum = 1 - 0.16 * (1 - closed_parallel(0.4, 0.4, 1));
    const struct RadExchangeOptions how = {.tolerance = 1e-3};
    double f[16];
    int again = 0;
    clear();
    room(1, 1, 1);
    box(low, high, 0, 3);
    RadDevice device = radNewDevice(&(struct RadDeviceOptions){.threads = 1});
    radSetDeviceProgressFunction(device, is_again, &again);
    RadScene s = scene_on(device);
    RadExchange exchange = radNewExchange(s, NULL, &how);
    ck_assert_ptr_nonnull(exchange);
    ck_assert_double_eq_tol(radGetExchangeRow(exchange, 0, f), sum, 1e-3);
    ck_assert_int_eq(again, 0);
    radReleaseExchange(exchange);
    radReleaseScene(s);
    radReleaseDevice(device);
}
END_TEST

/* An angle piece on the floor, which is no convex solid: from (1, 1), two long, with arms half as
 * wide. A box on it reaches over its inner edge, or another such piece lies on all of it. */
static void angle(double low, double high)
{
    static const double corner[6][2] = {{1, 1}, {3, 1}, {3, 1.5}, {1.5, 1.5}, {1.5, 3}, {1, 3}};
    const double o[2][3] = {{1, 1, 0}, {1, 1.5, 0}}, long_x[3] = {2, 0, 0}, short_x[3] = {.5, 0, 0},
                 short_y[3] = {0, .5, 0}, long_y[3] = {0, 1.5, 0}, tall[3] = {0, 0, high - low};
    for (int i = 0; i < 6; i++) {
        const double *from = corner[i], *to = corner[(i + 1) % 6], at[3] = {from[0], from[1], low},
                     along[3] = {to[0] - from[0], to[1] - from[1], 0};
        rectangle(at, along, tall);
    }
    for (int top = 0; top < 2; top++) {
        const double arm[2][3] = {{o[0][0], o[0][1], top ? high : low},
                                  {o[1][0], o[1][1], top ? high : low}};
        rectangle(arm[0], top ? long_x : short_y, top ? short_y : long_x);
        rectangle(arm[1], top ? short_x : long_y, top ? long_y : short_x);
    }
}

START_TEST(test_angle)
{
    static double f[FACES * FACES], area[FACES];
    static const double low[3] = {1.2, 1.2, 0.3}, high[3] = {2.2, 2.2, 0.6};
    enum { TILES = 9, LOWER = TILES + 5, UPPER = LOWER + 10 };
    double floor = 0;
    clear();
    room(4, 2, 3);
    angle(0, 0.3);
    if (_i)
        angle(0.3, 0.32);
    else
        box(low, high, 0, 0);
    factors(scene.faces, 0, f, area);
    for (int i = 0; i < TILES; i++)
        floor += area[i] / 16 * row_sum(f, (uint32_t)i);
    ck_assert_double_eq_tol(floor, 1 - 1.75 / 16, 3e-4);
    for (int i = LOWER + 6; i < LOWER + 8; i++) /* what is on the floor */
        ck_assert_double_eq_tol(row_sum(f, (uint32_t)i), 0, 3e-4);
    if (_i) {
        for (int i = LOWER + 8; i < UPPER; i++) /* what the upper one lies on */
            ck_assert_double_eq_tol(row_sum(f, (uint32_t)i), 0, 3e-4);
        for (int i = UPPER + 6; i < UPPER + 8; i++)
            ck_assert_double_eq_tol(row_sum(f, (uint32_t)i), 0, 3e-4);
    } else { /* the box's bottom is bare but for what lies on the arms */
        ck_assert_double_eq_tol(row_sum(f, UPPER), 0.49, 3e-4);
    }
}
END_TEST

/* What a solid covers is told as that, also where another lies on that solid: rays from within end
 * between the two, and know nothing. The room is closed, so none of its light goes to backs. */
START_TEST(test_what_is_covered)
{
    static const double low[3] = {0.9, 0.9, 0.3}, high[3] = {2.2, 2.2, 0.6};
    const struct RadExchangeOptions how = {.tolerance = 3e-4};
    double f[FACES];
    clear();
    room(4, 2, _i ? 4 : 3);
    angle(0, 0.3);
    box(low, high, 0, 0);
    RadDevice device = radNewDevice(&(struct RadDeviceOptions){.threads = 1});
    RadScene s = scene_on(device);
    RadExchange exchange = radNewExchange(s, NULL, &how);
    ck_assert_ptr_nonnull(exchange);
    for (uint32_t i = 0; i < scene.faces; i++) {
        struct RadExchangeLoss loss;
        const double sum = radGetExchangeRow(exchange, i, f);
        ck_assert_int_eq(radGetExchangeLoss(exchange, i, &loss), 0);
        ck_assert_double_eq_tol(loss.backs, 0, 1e-3);
        ck_assert_double_eq_tol(loss.covered, 1 - sum, 1e-3);
    }
    radReleaseExchange(exchange);
    radReleaseScene(s);
    radReleaseDevice(device);
}
END_TEST

/* An inner room whose walls lie in an outer box's planes, all of them or four or two. */
START_TEST(test_house)
{
    static const double inner[3][2][3] = {
        {{1, 1, 1}, {2, 2, 2.2}}, {{1, 1, 1.1}, {2, 2, 2}}, {{1, 1.2, 1.1}, {2, 1.8, 2.2}}};
    static double f[FACES * FACES], area[FACES];
    const double o[3] = {0, 0, 0}, far[3] = {4, 4, 4}, low[3] = {1, 1, 1}, high[3] = {2, 2, 2.2};
    clear();
    box(o, far, 1, 0);
    box(low, high, 0, 0);
    box(inner[_i][0], inner[_i][1], 1, 0);
    factors(scene.faces, 0, f, area);
    for (uint32_t i = 0; i < scene.faces; i++)
        ck_assert_double_eq_tol(row_sum(f, i), 1, 3e-4);
}
END_TEST

/* What is a rectangle from there on, as four triangles in two halves, whose edges end in the middle
 * of neighbours'; turned, and rounded as files of nine digits are. */
static void mesh_from(uint32_t first)
{
    const uint32_t last = scene.faces;
    uint32_t from = 0;
    for (uint32_t i = 0; i < first; i++)
        from += scene.sizes[i];
    scene.faces = first;
    scene.indices_used = from;
    static double kept[3 * POSITIONS];
    memcpy(kept, scene.positions, sizeof kept);
    scene.positions_used = from;
    for (uint32_t i = first; i < last; i++) {
        const double *v = &kept[(size_t)3 * (from + 4 * (i - first))];
        static const int corners[4][3] = {{0, 4, 5}, {0, 5, 3}, {4, 1, 2}, {4, 2, 5}};
        double p[6][3];
        memcpy(p, v, 4 * sizeof *p);
        for (int k = 0; k < 3; k++) {
            p[4][k] = 0.6 * p[0][k] + 0.4 * p[1][k];
            p[5][k] = 0.6 * p[3][k] + 0.4 * p[2][k];
        }
        for (int t = 0; t < 4; t++) {
            for (int c = 0; c < 3; c++)
                corner(p[corners[t][c]][0], p[corners[t][c]][1], p[corners[t][c]][2]);
            end_face(3);
        }
    }
}

static void turn_and_round(double by)
{
    static const double digits = 1e8;
    const double c = cos(by), s = sin(by);
    for (uint32_t i = 0; i < scene.positions_used; i++) {
        double *p = &scene.positions[(size_t)3 * i];
        const double x = c * p[0] - s * p[1], y = s * p[0] + c * p[1],
                     turned[3] = {x, c * y - s * p[2], s * y + c * p[2]};
        for (int k = 0; k < 3; k++)
            p[k] = round(turned[k] * digits) / digits;
    }
}

/* The same house, whose inner walls are triangles and its outer ones are not, or both are: what
 * rounding puts between them is no gap. */
START_TEST(test_meshed_house)
{
    static double f[FACES * FACES], area[FACES];
    const double o[3] = {0, 0, 0}, far[3] = {4, 4, 4}, low[3] = {1, 1, 1}, high[3] = {2, 2, 2.2};
    clear();
    box(o, far, 1, 0);
    if (_i % 2)
        box(low, high, 0, 0);
    box(low, high, 1, 0);
    mesh_from(_i % 2 ? 12 : 6);
    if (_i % 2 == 0)
        box(low, high, 0, 0);
    if (_i / 2)
        turn_and_round(0.7 * (_i / 2));
    factors(scene.faces, 0, f, area);
    for (uint32_t i = 0; i < scene.faces; i++)
        ck_assert_double_eq_tol(row_sum(f, i), 1, 3e-4);
}
END_TEST

/* A shelf whose end lies on a post, but for four ninths of it: a post on a tile's edge, against a
 * wall, in a corner of the room, without the sides that it stands on or with them. */
static const struct {
    int tiles;
    double at[2];
    unsigned without;
} post[] = {{1, {1, 1}, 0},
            {1, {1, 1}, 1},
            {3, {1, 1}, 0},
            {3, {1, 1}, 1},
            {1, {1, 0}, 1 | 1 << 4},
            {3, {1, 0}, 1 | 1 << 4},
            {3, {1, 0}, 0},
            {1, {0, 0}, 1 | 1 << 2 | 1 << 4},
            {3, {0, 0}, 1 | 1 << 2 | 1 << 4},
            {3, {0, 0}, 0}};

START_TEST(test_shelf)
{
    static double f[FACES * FACES], area[FACES];
    const double x = post[_i].at[0], y = post[_i].at[1], low[3] = {x, y, 0},
                 high[3] = {x + 0.1, y + 1, 1}, from[3] = {x + 0.1, y + 0.5, 0.5},
                 to[3] = {x + 1, y + 1.4, 0.55};
    clear();
    room(3, 2, post[_i].tiles);
    box(low, high, 0, post[_i].without);
    const uint32_t shelf = scene.faces, end = shelf + 2;
    box(from, to, 0, 0);
    factors(scene.faces, 0, f, area);
    ck_assert_double_eq_tol(row_sum(f, end), 4.0 / 9, 3e-4);
    for (uint32_t i = shelf; i < scene.faces; i++)
        if (i != end)
            ck_assert_double_eq_tol(row_sum(f, i), 1, 3e-4);
}
END_TEST

/* Two boxes on a floor, of triangles, that reach into each other by so much: where they do, nothing
 * is seen, though what stands in a solid shows its front there. */
static const double reach[] = {1e-6, 4e-5, 1e-3};

START_TEST(test_reach)
{
    static double f[FACES * FACES], area[FACES];
    const int smaller = _i % 2; /* the second box, whose side is hidden then, and the first's not */
    const double low[2][3] = {{0.5, 0.5, 0}, {1 - reach[_i / 2], 0.5, 0}},
                 high[2][3] = {{1, 1.1, 0.5}, {1.5, smaller ? 0.95 : 1.1, smaller ? 0.35 : 0.5}};
    enum { ROOM = 6, OF_SIDE = 4, OF_BOX = 6 * OF_SIDE };
    const double inside = smaller ? 2 * reach[_i / 2] / 0.175 : 0; /* of a triangle so high */
    clear();
    room(2, 2, 1);
    for (int i = 0; i < 2; i++)
        box(low[i], high[i], 0, 0);
    mesh_from(ROOM);
    turn_and_round(0.3);
    factors(scene.faces, 0, f, area);
    for (uint32_t i = ROOM; i < scene.faces; i++) {
        const uint32_t box = (i - ROOM) / OF_BOX, side = (i - ROOM) % OF_BOX / OF_SIDE;
        const int is_hidden = side == 0 || side == 3 - box;
        if (!smaller || box || side != 3)
            ck_assert_double_eq_tol(row_sum(f, i), !is_hidden, 2e-3 + inside);
    }
}
END_TEST

/* A room of 3 x 3 on another, with n x n tiles of what is the one's floor and the other's ceiling.
 * A lamp with one side, or a lid over it, hangs so close below the middle that next to nothing
 * comes between: what is over it is dark, but no solid, and covers nothing of the floor above. */
static const struct {
    int tiles;
    double gap;
} lamp[] = {{1, 1e-3}, {1, 1e-2}, {3, 1e-3}, {9, 1e-3}};

START_TEST(test_lamp)
{
    static double f[FACES * FACES], area[FACES];
    const int n = lamp[_i].tiles, tiles = n * n;
    const double low[2][3] = {{0, 0, 0}, {0, 0, 2}}, high[2][3] = {{3, 3, 2}, {3, 3, 4}},
                 u[3] = {3.0 / n, 0, 0}, v[3] = {0, 3.0 / n, 0}, at[3] = {1, 1, 2 - lamp[_i].gap},
                 along[3] = {1, 0, 0}, across[3] = {0, 1, 0};
    double ceiling = 0;
    clear();
    for (int i = 0; i < 2 * tiles; i++) {
        const double corner[3] = {i % n * u[0], i % tiles / n * v[1], 2};
        rectangle(corner, i < tiles ? v : u, i < tiles ? u : v);
    }
    box(low[0], high[0], 1, 1 << 1);
    box(low[1], high[1], 1, 1);
    rectangle(at, across, along);
    factors(scene.faces, 0, f, area);
    for (int i = 0; i < tiles; i++) {
        ceiling += row_sum(f, (uint32_t)i) / tiles;
        ck_assert_double_eq_tol(row_sum(f, (uint32_t)(tiles + i)), 1, 3e-4);
    }
    ck_assert_double_eq_tol(ceiling, 8.0 / 9, 2e-3);
}
END_TEST

/* A plate drawn from both sides, in a room, and the back of another close over all of it. */
START_TEST(test_plate)
{
    static double f[FACES * FACES], area[FACES];
    const double at[2][3] = {{1, 1, 1}, {1, 1, 1.01}}, u[3] = {1, 0, 0}, v[3] = {0, 1, 0};
    clear();
    room(3, 2, 1);
    const uint32_t plate = scene.faces;
    rectangle(at[0], u, v);
    rectangle(at[0], v, u);
    rectangle(at[1], u, v);
    factors(scene.faces, 0, f, area);
    ck_assert_double_eq_tol(row_sum(f, plate), 0.0195, 1e-3); /* past the edges of the gap */
    ck_assert_double_eq_tol(row_sum(f, plate + 1), 1, 3e-4);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("stacked");
    TCase *t = tcase_create("stacked");
    tcase_set_timeout(t, 60);
    tcase_add_loop_test(t, test_boxes, 0, sizeof stack / sizeof *stack);
    tcase_add_loop_test(t, test_shelf, 0, sizeof post / sizeof *post);
    tcase_add_test(t, test_post);
    tcase_add_test(t, test_pipe);
    tcase_add_loop_test(t, test_angle, 0, 2);
    tcase_add_loop_test(t, test_what_is_covered, 0, 2);
    tcase_add_loop_test(t, test_reach, 0, 2 * sizeof reach / sizeof *reach);
    tcase_add_loop_test(t, test_lamp, 0, sizeof lamp / sizeof *lamp);
    tcase_add_test(t, test_plate);
    tcase_add_loop_test(t, test_house, 0, under_sanitizers() ? 1 : 3);
    tcase_add_loop_test(t, test_meshed_house, 0, under_sanitizers() ? 4 : 14);
    suite_add_tcase(suite, t);
    return suite_failures(suite) != 0;
}
