/* check_shells.c - boxes in boxes: rooms that stand empty in other rooms look turned, and to find
 * them takes no longer where there are many.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include "radiosity.h"
#include "runtime/chance.h"
#include "suite.h"

struct box {
    double low[3], high[3];
    int inwards;
};

static const uint32_t sides[6][4] = {{4, 5, 7, 6}, {0, 2, 3, 1}, {0, 1, 5, 4},
                                     {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}};

/* Commit the boxes, as they are. Returns the processor's time that it took (s). */
static double commit(const struct box *boxes, uint32_t count, struct RadSceneReport *report)
{
    double *position = malloc(24 * (size_t)count * sizeof *position);
    uint32_t *index = malloc(24 * (size_t)count * sizeof *index);
    for (uint32_t b = 0; b < count; b++) {
        for (uint32_t i = 0; i < 8; i++)
            for (uint32_t k = 0; k < 3; k++)
                position[24 * b + 3 * i + k] = i >> k & 1 ? boxes[b].high[k] : boxes[b].low[k];
        for (uint32_t i = 0; i < 24; i++)
            index[24 * b + i] = 8 * b + sides[i / 4][boxes[b].inwards ? 3 - i % 4 : i % 4];
    }
    const struct RadMaterial grey = {{.5, .5, .5}, {0, 0, 0}, 0};
    const struct RadPolygons polygons = {.positions = position,
                                         .position_count = 8 * (size_t)count,
                                         .indices = index,
                                         .size = 4,
                                         .count = 6 * count,
                                         .as_given = 1,
                                         .turned = RAD_TURNED_FIND};
    RadDevice device = radNewDevice(NULL);
    RadScene scene = radNewScene(device);
    ck_assert_int_eq(radSetSceneMaterials(scene, &grey, 1), 0);
    ck_assert_int_eq(radSetSceneSharedPolygons(scene, &polygons), 0);
    const clock_t start = clock();
    ck_assert_msg(radCommitScene(scene) == 0, "%s", radGetDeviceErrorMessage(device));
    const double took = (double)(clock() - start) / CLOCKS_PER_SEC;
    ck_assert_int_eq(radGetSceneReport(scene, report), 0);
    radReleaseScene(scene);
    radReleaseDevice(device);
    free(position);
    free(index);
    return took;
}

static int is_within(const struct box *in, const struct box *out)
{
    for (int k = 0; k < 3; k++)
        if (in->low[k] < out->low[k] || in->high[k] > out->high[k])
            return 0;
    return in != out;
}

START_TEST(test_nested)
{
    enum { BOXES = 60 };
    struct box boxes[BOXES];
    struct RadSceneReport report;
    uint64_t state = (uint64_t)_i + 1;
    uint32_t turned = 0;
    for (int b = 0; b < BOXES; b++) {
        const double size = 0.02 + chance(&state) * chance(&state) * chance(&state);
        boxes[b].inwards = chance(&state) < 0.7;
        for (int k = 0; k < 3; k++) {
            boxes[b].low[k] = chance(&state);
            boxes[b].high[k] = boxes[b].low[k] + size * (0.5 + chance(&state));
        }
    }
    commit(boxes, BOXES, &report);
    for (int b = 0; b < BOXES; b++) {
        int holds = 0, held = 0;
        for (int i = 0; i < BOXES; i++) {
            holds |= is_within(&boxes[i], &boxes[b]);
            held |= boxes[i].inwards && is_within(&boxes[b], &boxes[i]);
        }
        if (!boxes[b].inwards || holds || !held)
            continue;
        for (uint32_t i = 0; i < 6; i++, turned++)
            if (turned < RAD_TURNED_NAMED)
                ck_assert_uint_eq(report.turned_closed.polygon[turned], 6 * (uint32_t)b + i);
    }
    ck_assert_uint_eq(report.turned_closed.count, turned);
    ck_assert_uint_eq(report.turned_open.count, 0);
    ck_assert_uint_gt(turned, 0);
}
END_TEST

/* A grid of boxes in a room, all outwards and then all inwards. */
START_TEST(test_many)
{
    enum { SIDE = 28, BOXES = SIDE * SIDE * SIDE };
    struct box *boxes = malloc((BOXES + 1) * sizeof *boxes);
    double took[2];
    for (int inwards = 0; inwards < 2; inwards++) {
        struct RadSceneReport report;
        boxes[0] = (struct box){{-1, -1, -1}, {SIDE, SIDE, SIDE}, 1};
        for (int b = 0; b < BOXES; b++) {
            const int at[3] = {b % SIDE, b / SIDE % SIDE, b / SIDE / SIDE};
            for (int k = 0; k < 3; k++) {
                boxes[b + 1].low[k] = at[k];
                boxes[b + 1].high[k] = at[k] + 0.5;
            }
            boxes[b + 1].inwards = inwards;
        }
        took[inwards] = commit(boxes, BOXES + 1, &report);
        ck_assert_uint_eq(report.turned_closed.count, inwards ? 6 * BOXES : 0);
    }
    printf("%d boxes, %.2f s; inwards, %.2f s\n", BOXES, took[0], took[1]);
    ck_assert_double_le(took[1], 4 * took[0]);
    free(boxes);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("shells");
    TCase *c = tcase_create("shells");
    tcase_add_loop_test(c, test_nested, 0, 40);
    tcase_add_test(c, test_many);
    tcase_set_timeout(c, 60);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
