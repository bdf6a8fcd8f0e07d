/* check_long_faces.c - large long faces are cut across, others stay.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "geometry.h"
#include "hierarchy/long_faces.h"
#include "hierarchy/polygon.h"
#include "scene/make_scene.h"
#include "suite.h"

static const uint32_t walls[6] = {0, 0, 0, 0, 0, 0};

static void sides_of(const struct face *f, double length[2])
{
    double d[3];
    for (int s = 0; s < 2; s++) {
        sub3(d, f->vertex[s + 1], f->vertex[s]);
        length[s] = length3(d);
    }
}

/* Parts of a tunnel: none is long, and together they are the face. */
START_TEST(test_tunnel)
{
    struct scene s, twice;
    made_open(&s);
    made_material(&s, 0.5, 0);
    made_room(&s, walls, 300, 8, 5);
    made_quad(&s, 0, 10, 4, 4.9, 0, 1, 0, 60, 0, 0); /* long, and small */
    made_open(&twice);
    made_material(&twice, 0.5, 0);
    made_room(&twice, walls, 300, 8, 5);
    made_quad(&twice, 0, 10, 4, 4.9, 0, 1, 0, 60, 0, 0);
    made_scale(&twice, 1024);
    struct face given[7];
    memcpy(given, s.faces, sizeof given);
    ck_assert_int_eq(scene_shorten(&s), 0);
    ck_assert_int_eq(scene_shorten(&twice), 0);
    ck_assert_uint_eq(s.face_count, twice.face_count);
    ck_assert_uint_gt(s.face_count, 4 * 15);
    ck_assert_uint_lt(s.face_count, 4 * 35);
    double area[7] = {0}, normal[3], before[3];
    int parts[7] = {0};
    for (uint32_t i = 0; i < s.face_count; i++) {
        struct face *f = &s.faces[i];
        const uint32_t input = f->input;
        area[input] += polygon_normal(f->vertex, f->vertices, normal);
        (void)polygon_normal(given[input].vertex, 4, before);
        ck_assert_double_gt(dot3(normal, before), 1 - 1e-12);
        double length[2];
        sides_of(f, length);
        if (input < 6)
            ck_assert_double_le(fmax(length[0], length[1]), 2.4 * fmin(length[0], length[1]));
        if (parts[input]++ > 0) { /* begins where the one before ends, to the bit */
            ck_assert_mem_eq(f->vertex[0], f[-1].vertex[1], sizeof f->vertex[0]);
            ck_assert_mem_eq(f->vertex[3], f[-1].vertex[2], sizeof f->vertex[0]);
        }
        for (int c = 0; c < 4; c++)
            for (int k = 0; k < 3; k++)
                ck_assert(1024 * f->vertex[c][k] == twice.faces[i].vertex[c][k]);
    }
    for (int i = 0; i < 7; i++) {
        ck_assert_double_eq_tol(area[i], polygon_normal(given[i].vertex, 4, normal),
                                1e-12 * area[i]);
        ck_assert_int_eq(parts[i] > 1, i != 4 && i != 5 && i != 6); /* ends and the strip stay */
    }
    ck_assert_uint_eq(s.cut, 4);
    ck_assert_uint_eq(s.parts, s.face_count - 3);
    printf("a tunnel of 300 m by 8 and 5: %u faces\n", s.face_count);
    made_close(&s);
    made_close(&twice);
}
END_TEST

/* Far sides are cut like their fronts, and stay behind them. */
START_TEST(test_pairs)
{
    struct scene s;
    made_open(&s);
    made_material(&s, 0.5, 0);
    made_quad(&s, 0, 0, 0, 0, 1, 0, 0, 0, 20, 0);
    made_quad(&s, 0, 0, 0, 0, 0, 20, 0, 1, 0, 0);
    s.faces[1].input = 0;
    s.faces[1].back = 1;
    ck_assert_int_eq(scene_shorten(&s), 0);
    ck_assert_uint_eq(s.face_count, 20);
    for (uint32_t i = 0; i < s.face_count; i += 2) {
        ck_assert(scene_is_pair(&s, i));
        for (int c = 0; c < 4; c++)
            ck_assert_mem_eq(s.faces[i].vertex[c], s.faces[i + 1].vertex[3 - c],
                             sizeof s.faces[i].vertex[c]);
    }
    made_close(&s);
}
END_TEST

/* Rooms, cubes and triangles stay as they are. */
START_TEST(test_short)
{
    struct scene s;
    const double sliver[3][3] = {{0, 0, 0}, {100, 0, 0}, {100, 1, 0}};
    made_open(&s);
    made_material(&s, 0.5, 0);
    made_room(&s, walls, 10, 5, 2.5);
    made_face(&s, 0, 3, sliver);
    const struct face *same = s.faces;
    ck_assert_int_eq(scene_shorten(&s), 0);
    ck_assert_uint_eq(s.face_count, 7);
    ck_assert_ptr_eq(s.faces, same);
    made_close(&s);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("long faces");
    TCase *c = tcase_create("long faces");
    tcase_set_timeout(c, 60);
    tcase_add_test(c, test_tunnel);
    tcase_add_test(c, test_pairs);
    tcase_add_test(c, test_short);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
