/* check_again.c - tables in rooms: shades of legs that the points of a rule miss.
 *
 * In a closed room every row whose face nothing stands on sums to 1, whatever hides what. Where all
 * points of a wall saw past one leg to another, rows were 1.008; now no more than three tolerances,
 * or they are looked at again. A room without a ceiling has no such sum: there entries are held
 * against quadrature that shares nothing with the library (room_judge.h).
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "runtime/chance.h"
#include "runtime/make_polygons.h"
#include "runtime/room_judge.h"
#include "suite.h"

enum { TABLES = 3, CELLS = 4, FLOOR = CELLS * CELLS, WALLS = 6 * FLOOR };
enum { OFF = 9 };                   /* the room that has a row which does not add up at first */
enum { TABLE = 22, UNDERSIDE = 4 }; /* faces of a table; the board's lower side, where legs stand */
static const double TOLERANCE = 3e-4;

/* A rectangle's cells. */
static void wall(const double at[3], const double u[3], const double v[3])
{
    double cu[3], cv[3];
    for (int k = 0; k < 3; k++) {
        cu[k] = u[k] / CELLS;
        cv[k] = v[k] / CELLS;
    }
    for (int i = 0; i < CELLS * CELLS; i++) {
        double from[3];
        for (int k = 0; k < 3; k++)
            from[k] = at[k] + i % CELLS * cu[k] + i / CELLS * cv[k];
        rectangle(from, cu, cv);
    }
}

static void room(const double size[3], int open)
{
    static const double o[3] = {0, 0, 0};
    const double x[3] = {size[0], 0, 0}, y[3] = {0, size[1], 0}, z[3] = {0, 0, size[2]};
    wall(o, x, y);
    if (!open)
        wall(z, y, x);
    wall(o, z, x);
    wall(y, x, z);
    wall(o, y, z);
    wall(x, z, y);
}

/* A box from `low` to `high` over the floor about (x, y), turned; lids: 1, with top and bottom. */
static void box(const double middle[2], const double half[2], double turn, double low, double high,
                int lids)
{
    const double c = cos(turn), s = sin(turn);
    double p[4][2];
    for (int i = 0; i < 4; i++) {
        const double u = (i == 1 || i == 2 ? 1 : -1) * half[0], v = (i >= 2 ? 1 : -1) * half[1];
        p[i][0] = middle[0] + c * u - s * v;
        p[i][1] = middle[1] + s * u + c * v;
    }
    for (int i = 0; i < 4; i++) {
        const double *a = p[i], *b = p[(i + 1) % 4];
        const double at[3] = {a[0], a[1], low}, u[3] = {b[0] - a[0], b[1] - a[1], 0},
                     v[3] = {0, 0, high - low};
        rectangle(at, u, v);
    }
    for (int top = 0; top < 2 && lids; top++) {
        const double at[3] = {p[0][0], p[0][1], top ? high : low},
                     u[3] = {p[1][0] - p[0][0], p[1][1] - p[0][1], 0},
                     v[3] = {p[3][0] - p[0][0], p[3][1] - p[0][1], 0};
        rectangle(at, top ? u : v, top ? v : u);
    }
}

static void table(const double at[2], const double half[2], double turn, double tall)
{
    const double leg[2] = {0.03, 0.03}, thick = 0.05;
    box(at, half, turn, tall - thick, tall, 1);
    for (int i = 0; i < 4; i++) {
        const double u = (i % 2 ? 1 : -1) * (half[0] - 0.06),
                     v = (i / 2 ? 1 : -1) * (half[1] - 0.06),
                     foot[2] = {at[0] + cos(turn) * u - sin(turn) * v,
                                at[1] + sin(turn) * u + cos(turn) * v};
        box(foot, leg, turn, 0, tall - thick, 0);
    }
}

/* Tables beside each other, each in its own third of the room. */
static void furnish(uint64_t seed, int open)
{
    uint64_t state = seed << 32;
    const double size[3] = {5 + 2 * chance(&state), 3 + 2 * chance(&state), 2.5};
    clear();
    room(size, open);
    for (int i = 0; i < TABLES; i++) {
        const double at[2] = {size[0] * (i + 0.5) / TABLES, size[1] * (0.3 + 0.4 * chance(&state))},
                     half[2] = {0.2 + 0.3 * chance(&state), 0.15 + 0.3 * chance(&state)};
        table(at, half, 3 * chance(&state), 0.4 + 0.5 * chance(&state));
    }
}

/* Those of twelve that were worst. */
static const uint64_t rooms[] = {0, 3, 4, 6, OFF, 11};

START_TEST(test_rows)
{
    static double f[FACES * FACES], areas[FACES];
    furnish(rooms[_i], 0);
    factors(scene.faces, TOLERANCE, f, areas);
    for (uint32_t i = FLOOR; i < scene.faces; i++) {
        double sum = 0;
        for (uint32_t j = 0; j < scene.faces; j++)
            sum += f[i * scene.faces + j];
        if (i < WALLS || (i - WALLS) % TABLE != UNDERSIDE)
            ck_assert_msg(fabs(sum - 1) <= 3 * TOLERANCE, "row %u sums to %.6f", i, sum);
    }
}
END_TEST

/* In the open, from a leg's side to a wall's cell past another leg. */
START_TEST(test_entries)
{
    static const struct {
        uint64_t room;
        uint32_t leg, cell;
    } pairs[] = {{0, 133, 88}, {3, 131, 84}, {3, 124, 92}, {4, 131, 84}, {6, 124, 88}};
    static double f[FACES * FACES], areas[FACES];
    static struct judge_polygon all[FACES];
    for (size_t k = 0; k < sizeof pairs / sizeof *pairs; k++) {
        const uint32_t leg = pairs[k].leg - FLOOR, cell = pairs[k].cell - FLOOR;
        furnish(pairs[k].room, 1);
        factors(leg + 1, TOLERANCE, f, areas);
        for (uint32_t i = 0; i < scene.faces; i++) {
            all[i].n = 4;
            memcpy(all[i].v, &scene.positions[(size_t)12 * i], sizeof(double[4][3]));
        }
        const double right =
            judge_pair(&all[leg], &all[cell], all, (int)scene.faces, 1e-9, 1e-5 * areas[leg])
            / areas[leg];
        ck_assert_double_eq_tol(f[(size_t)leg * scene.faces + cell], right, TOLERANCE);
    }
}
END_TEST

/* A state put down while rows are looked at again: nothing of that is in it, and what goes on from
 * it has the bits of what was never put down. */
struct kept {
    unsigned char bytes[1 << 21];
    size_t size, read;
    int again, stops; /* it is at it; so often it was put down there */
};

static int watch(void *user, const struct RadProgress *at)
{
    struct kept *k = user;
    k->again = strcmp(at->phase, "again") == 0;
    return 0;
}

static enum RadStateWish ask(void *user)
{
    struct kept *k = user;
    k->stops += k->again;
    return k->again ? RAD_STATE_STOP : RAD_STATE_NONE;
}

static int keep(void *user, const void *bytes, size_t size)
{
    struct kept *k = user;
    ck_assert_uint_le(k->size + size, sizeof k->bytes);
    if (size)
        memcpy(k->bytes + k->size, bytes, size);
    k->size += size;
    return 0;
}

static size_t give(void *user, void *bytes, size_t size)
{
    struct kept *k = user;
    const size_t left = k->size - k->read, count = left < size ? left : size;
    memcpy(bytes, k->bytes + k->read, count);
    k->read += count;
    return count;
}

START_TEST(test_put_down)
{
    static struct kept k;
    static double whole[FACES * FACES], areas[FACES], row[FACES];
    const struct RadMaterial grey = {.reflectance = {.5, .5, .5}};
    const struct RadExchangeState down = {.asked = ask, .write = keep, .user = &k},
                                  on = {.read = give, .user = &k};
    struct RadExchangeOptions how = {.tolerance = TOLERANCE, .state = &down};
    furnish(OFF, 0);
    factors(scene.faces, TOLERANCE, whole, areas);
    const struct RadPolygons polygons = {.positions = scene.positions,
                                         .position_count = scene.positions_used,
                                         .indices = scene.indices,
                                         .sizes = scene.sizes,
                                         .materials = scene.materials,
                                         .count = scene.faces};
    RadDevice device = radNewDevice(&(struct RadDeviceOptions){.threads = 2});
    RadScene s = radNewScene(device);
    radSetDeviceProgressFunction(device, watch, &k);
    ck_assert_int_eq(radSetSceneMaterials(s, &grey, 1), 0);
    ck_assert_int_eq(radSetSceneSharedPolygons(s, &polygons), 0);
    ck_assert_int_eq(radCommitScene(s), 0);
    ck_assert_ptr_null(radNewExchange(s, NULL, &how));
    ck_assert_int_eq(radGetDeviceError(device), RAD_ERROR_CANCELLED);
    ck_assert_int_eq(k.stops, 1);
    how.state = &on;
    RadExchange exchange = radNewExchange(s, NULL, &how);
    ck_assert_msg(exchange != NULL, "%s", radGetDeviceErrorMessage(device));
    for (uint32_t i = 0; i < scene.faces; i++) {
        ck_assert_double_ge(radGetExchangeRow(exchange, i, row), 0);
        ck_assert(memcmp(row, &whole[(size_t)i * scene.faces], scene.faces * sizeof *row) == 0);
    }
    radReleaseExchange(exchange);
    radReleaseScene(s);
    radReleaseDevice(device);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("again");
    TCase *tests = tcase_create("rows");
    tcase_set_timeout(tests, 120);
    suite_add_tcase(suite, tests);
    tcase_add_loop_test(tests, test_rows, 0, sizeof rooms / sizeof *rooms);
    tcase_add_test(tests, test_entries);
    tcase_add_test(tests, test_put_down);
    return suite_failures(suite);
}
