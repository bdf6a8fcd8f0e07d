/* check_assemblies.c - rooms full of boxes that touch: on top of each other, side by side, in
 * corners, against walls of tiles, and along edges.
 *
 * Boxes and tiles end at the lines of a grid, so what is bare of each face is counted by its cells,
 * and that is what its row sums to; of a side that is meshed, what its rows sum to in the mean.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>
#include "radiosity.h"
#include "runtime/chance.h"
#include "runtime/make_polygons.h"
#include "suite.h"

enum { SIDE = 6, ROOMS = 16, NOBODY = 0 };
static const double TOLERANCE = 3e-4, TURN = 0.7, ROUNDED = 1e-6;

static int cells[SIDE][SIDE][SIDE]; /* whose each is: of a box, from 1 on */
static double bare[FACES];          /* of each face, a share */

struct block {
    int low[3], high[3];
};

static int is_free(int x, int y, int z)
{
    return x >= 0 && x < SIDE && y >= 0 && y < SIDE && z >= 0 && z < SIDE
           && cells[x][y][z] == NOBODY;
}

/* Sides that are meshed, each in its own way: where their faces end, and what is bare of each. */
static struct {
    uint64_t chance; /* 0: none is meshed */
    uint32_t count, end[FACES];
    double bare[FACES];
} meshed;

/* A rectangle in one or two halves, each of them two triangles along either diagonal. */
static void triangles(const double at[3], const double u[3], const double v[3])
{
    static const int corners[2][6] = {{0, 1, 2, 0, 2, 3}, {0, 1, 3, 1, 2, 3}};
    const int halves = chance(&meshed.chance) < 0.5, along_u = chance(&meshed.chance) < 0.5;
    const double middle = 0.3 + 0.4 * chance(&meshed.chance);
    for (int half = 0; half <= halves; half++) {
        const double from = half ? middle : 0, to = halves && !half ? middle : 1,
                     x[2] = {along_u ? from : 0, along_u ? to : 1},
                     y[2] = {along_u ? 0 : from, along_u ? 1 : to};
        const int *corner_of = corners[chance(&meshed.chance) < 0.5];
        for (int i = 0; i < 6; i++) {
            const double a = x[corner_of[i] == 1 || corner_of[i] == 2], b = y[corner_of[i] / 2];
            corner(at[0] + a * u[0] + b * v[0], at[1] + a * u[1] + b * v[1],
                   at[2] + a * u[2] + b * v[2]);
            if (i % 3 == 2)
                end_face(3);
        }
    }
}

/* A side of a block across an axis, with its front outside, or inside of a room. */
static void side_of(const struct block *b, int axis, int up, int inside, int turned)
{
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    const int in_front = up ? (inside ? b->high[axis] - 1 : b->high[axis])
                            : (inside ? b->low[axis] : b->low[axis] - 1);
    double p[3][3] = {{b->low[0], b->low[1], b->low[2]}, {0}, {0}}, all = 0, free_ = 0;
    p[0][axis] = up ? b->high[axis] : b->low[axis];
    p[up != inside ? 1 : 2][i] = b->high[i] - b->low[i];
    p[up != inside ? 2 : 1][j] = b->high[j] - b->low[j];
    for (int a = b->low[i]; a < b->high[i]; a++)
        for (int c = b->low[j]; c < b->high[j]; c++) {
            int at[3];
            at[axis] = in_front;
            at[i] = a;
            at[j] = c;
            all++;
            free_ += is_free(at[0], at[1], at[2]);
        }
    bare[scene.faces] = free_ / all;
    for (int k = 0; k < 3 && turned; k++) {
        const double x = p[k][0], y = p[k][1];
        p[k][0] = cos(TURN) * x - sin(TURN) * y;
        p[k][1] = sin(TURN) * x + cos(TURN) * y;
    }
    if (!meshed.chance) {
        rectangle(p[0], p[1], p[2]);
        return;
    }
    meshed.bare[meshed.count] = free_ / all;
    triangles(p[0], p[1], p[2]);
    meshed.end[meshed.count++] = scene.faces;
}

/* Blocks of up to so many cells a side, where there is room; walls of tiles x tiles each. */
static void furnish(uint64_t seed, int most, int tiles, int turned)
{
    struct block blocks[12];
    uint64_t state = (seed + 1) << 32;
    int count = 0, wanted = 4 + (int)(seed % 8);
    clear();
    memset(cells, 0, sizeof cells);
    for (int tried = 0; tried < 200 && count < wanted; tried++) {
        struct block b;
        int taken = 0;
        for (int k = 0; k < 3; k++) {
            b.low[k] = (int)(SIDE * chance(&state));
            b.high[k] = b.low[k] + 1 + (int)(most * chance(&state));
            taken |= b.high[k] > SIDE;
        }
        for (int round = 0; round < 2 && !taken; round++)
            for (int x = b.low[0]; x < b.high[0]; x++)
                for (int y = b.low[1]; y < b.high[1]; y++)
                    for (int z = b.low[2]; z < b.high[2]; z++) {
                        taken |= round == 0 && !is_free(x, y, z);
                        cells[x][y][z] = round ? count + 1 : cells[x][y][z];
                    }
        if (!taken)
            blocks[count++] = b;
    }
    for (int wall = 0; wall < 6; wall++)
        for (int tile = 0; tile < tiles * tiles; tile++) {
            struct block b = {{0, 0, 0}, {SIDE, SIDE, SIDE}};
            const int axis = wall / 2, at[2] = {tile % tiles, tile / tiles}, wide = SIDE / tiles;
            for (int k = 0; k < 2; k++) {
                b.low[(axis + 1 + k) % 3] = wide * at[k];
                b.high[(axis + 1 + k) % 3] = wide * (at[k] + 1);
            }
            side_of(&b, axis, wall % 2, 1, turned);
        }
    for (int i = 0; i < count; i++)
        for (int side = 0; side < 6; side++)
            side_of(&blocks[i], side / 2, side % 2, 0, turned);
}

static void check_rows(uint32_t rows)
{
    static double f[FACES * FACES], area[FACES];
    factors(rows, TOLERANCE, f, area);
    for (uint32_t i = 0; i < rows; i++) {
        const double sum = row_sum(f, i);
        ck_assert_msg(fabs(sum - bare[i]) <= 3 * TOLERANCE, "row %u sums to %.5f, not %.5f", i, sum,
                      bare[i]);
    }
}

/* Rooms of some metres whose objects were moved into their places and rounded each by itself, to
 * seven digits: corners of neighbours are next to each other. */
static void round_corners(double size, uint64_t seed)
{
    uint64_t state = (seed + 1) << 32;
    for (uint32_t i = 0; i < 3 * scene.positions_used; i++)
        scene.positions[i] = size * scene.positions[i] + ROUNDED * (chance(&state) - 0.5);
}

START_TEST(test_blocks)
{
    furnish((uint64_t)_i / 2, 3, _i % 2 ? 3 : 1, _i % 4 / 2);
    check_rows(scene.faces);
}
END_TEST

START_TEST(test_cubes)
{
    furnish((uint64_t)_i, 1, _i % 2 ? 6 : 1, _i % 4 / 2);
    check_rows(scene.faces);
}
END_TEST

START_TEST(test_rounded)
{
    furnish((uint64_t)_i, 1 + _i % 3, 1 + _i % 2 * 2, 1);
    round_corners(0.4 + 0.02 * _i, (uint64_t)_i);
    check_rows(scene.faces);
}
END_TEST

/* Blocks whose sides are triangles that no neighbour has: what is bare of a side is what its rows
 * come to, and none comes to more than 1. */
START_TEST(test_meshed)
{
    static double f[FACES * FACES], area[FACES];
    uint32_t face = 0;
    meshed.chance = (uint64_t)_i + 1;
    meshed.count = 0;
    furnish((uint64_t)_i, 2 + _i % 2, 1, _i % 4 / 2);
    meshed.chance = 0;
    if (_i % 3 == 2)
        round_corners(0.4 + 0.02 * _i, (uint64_t)_i);
    factors(scene.faces, TOLERANCE, f, area);
    for (uint32_t side = 0; side < meshed.count; side++) {
        double all = 0, sums = 0;
        for (; face < meshed.end[side]; face++) {
            const double sum = row_sum(f, face);
            ck_assert_msg(sum <= 1 + 3 * TOLERANCE, "row %u sums to %.5f", face, sum);
            all += area[face];
            sums += area[face] * sum;
        }
        ck_assert_msg(fabs(sums / all - meshed.bare[side]) <= 3 * TOLERANCE,
                      "side %u sums to %.5f, not %.5f", side, sums / all, meshed.bare[side]);
    }
}
END_TEST

/* What stands far outside makes nothing touch that does not. */
START_TEST(test_far)
{
    static const double AT[3] = {2000, 1500, 1000}, U[3] = {0, 1, 0}, V[3] = {0, 0, 1};
    furnish((uint64_t)_i, 1 + _i % 3, 1 + _i % 2 * 2, 1);
    const uint32_t rows = scene.faces;
    rectangle(AT, U, V);
    check_rows(rows);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("assemblies");
    TCase *t = tcase_create("assemblies");
    tcase_set_timeout(t, 60);
    tcase_add_loop_test(t, test_blocks, 0, under_sanitizers() ? 6 : 2 * ROOMS);
    tcase_add_loop_test(t, test_cubes, 0, under_sanitizers() ? 4 : ROOMS);
    tcase_add_loop_test(t, test_rounded, 0, under_sanitizers() ? 4 : ROOMS);
    tcase_add_loop_test(t, test_meshed, ROOMS / 2, under_sanitizers() ? ROOMS / 2 + 1 : ROOMS);
    tcase_add_loop_test(t, test_far, 0, under_sanitizers() ? 2 : ROOMS);
    suite_add_tcase(suite, t);
    return suite_failures(suite) != 0;
}
