/* Does mending find the light of a large face that few particles meet? Of two furnaces one is a
 * thousand times as bright as the other and gets all but a thousandth of the particles. What links
 * say of one wall of the dark one is spoilt.
 * SPDX-License-Identifier: MIT */
#include "runtime/two_furnaces.h"
#include "scene/read_scene.h"
#include "engine/dim_list.h"
#include "engine/dim_parts.h"
#include "engine/lit_faces.h"
#include "engine/mend_solution.h"
#include "kernel/constants.h"
#include "suite.h"

#define SPOILT 1.3 /* by what the wall's light is multiplied */

static void spoil(struct solve *s, uint32_t from, uint32_t to, double factor)
{
    for (uint32_t e = 0; e < s->hierarchy.count; e++) {
        const struct element *at = &s->hierarchy.elements[e];
        if (at->vertices && at->face >= from && at->face < to) {
            s->state.irradiance[e] *= factor;
            s->state.radiosity[e] = DARK * (1 - RHO) + RHO * s->state.irradiance[e];
        }
    }
}

static void spoil_wall(struct solve *s)
{
    spoil(s, WALL, WALL + 1, SPOILT);
}

static double of_face(const struct solve *s, uint32_t face)
{
    return s->mended.irradiance[s->hierarchy.face_element[face]];
}

static void mend_all(struct solve *s, double noise, uint64_t most, struct measured_error *alone)
{
    const struct mending_goal goal = {.noise = noise, .most = most};
    const char *cause;
    ck_assert_int_eq(measure_and_mend(s, &goal, alone, &cause), 0);
}

/* The wall is right to 5 %, two standard errors, where links are off by 30 % and some 50 particles
 * by 14 %; bright walls stay; each element has what its children have. */
START_TEST(test_found)
{
    struct scene scene;
    struct solve s;
    struct measured_error alone;
    two_furnaces(&s, &scene, DARK, 2);
    spoil_wall(&s);
    mend_all(&s, 1e-4, 450000, &alone);
    ck_assert_uint_eq(alone.gathered, GROUPS); /* parts of the other dark walls are small */
    ck_assert_uint_eq(alone.dim.large, WALL + 1 + GROUPS);
    for (uint32_t i = 0; i < alone.dim.unsure; i++)
        ck_assert_uint_gt(alone.dim.named[i], WALL);
    const struct hierarchy *h = &s.hierarchy;
    for (uint32_t f = 0; f < WALL; f++)
        ck_assert_double_eq_tol(of_face(&s, f), 1, 0.01);
    ck_assert_double_eq_tol(of_face(&s, WALL) / DARK, 1, 0.05);
    for (uint32_t e = 0; e < h->count; e++) {
        double sum = 0, own = s.mended.irradiance[e] * h->elements[e].area;
        for (uint32_t c = 0; c < h->elements[e].children; c++)
            sum += s.mended.irradiance[h->elements[e].child + c]
                   * h->elements[h->elements[e].child + c].area;
        if (h->elements[e].children)
            ck_assert_double_eq_tol(sum, own, 1e-12 * own);
    }
    measured_error_free(&alone);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* A box against a wall, another one and a third on that: what touches floor or wall sees nothing,
 * and that is known; the two faces where boxes meet are not asked. */
START_TEST(test_stood_on)
{
    static const double at[3][3] = {{0, 0.5, 0}, {0.5, 0.5, 0}, {0.5, 0.5, 0.3}},
                        along[3][3] = {{0.3, 0, 0}, {0, 0.3, 0}, {0, 0, 0.3}};
    struct scene scene;
    struct solve s;
    struct measured_error alone;
    made_open(&scene);
    const uint32_t wall = made_material(&scene, RHO, 0), lamp = made_material(&scene, RHO, 1);
    const uint32_t walls[6] = {wall, wall, wall, wall, wall, lamp};
    made_room(&scene, walls, 1, 1, 1);
    for (int i = 0; i < 3; i++)
        made_box(&scene, wall, at[i], along, 0);
    solve_with(&s, &scene, "bf", RELEASE_FLAT, NULL, quick(2));
    mend_all(&s, 1e-4, 450000, &alone);
    ck_assert_uint_eq(alone.dim.large, 6 + 6 + 5 + 5);
    ck_assert_uint_eq(alone.dim.unsure, 0);
    measured_error_free(&alone);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

static uint32_t unsure; /* as the last of mend_apart said */

static int mend_apart(struct solve *s, uint64_t particles, uint64_t budget, uint64_t *rays,
                      double *root)
{
    const struct dim_budget all = {(double)budget, 2 * (double)budget, (double)budget};
    struct dim_count dim;
    const int changed = mend_within(s, particles, &all, rays, root, &dim);
    unsure = dim.unsure;
    return changed;
}

/* Same bits by any number of threads; no power is made or lost; the budget is kept, but for whole
 * blocks of paths. */
START_TEST(test_same_bits)
{
    enum { BUDGET = 20000 };
    static const int threads[] = {1, 2, 5};
    double *first = NULL;
    for (int i = 0; i < 3; i++) {
        struct scene scene;
        struct solve s;
        uint64_t rays;
        double root;
        two_furnaces(&s, &scene, DARK, threads[i]);
        spoil_wall(&s);
        ck_assert_int_eq(mend_apart(&s, 200000, BUDGET, &rays, &root), 1);
        ck_assert_uint_gt(rays, 0);
        ck_assert_uint_le(rays, BUDGET + 64 * 4);
        ck_assert_double_eq_tol(root, 1, 1e-12);
        size_t size = s.hierarchy.count * sizeof *first;
        if (i == 0)
            memcpy(first = malloc(size), s.mended.irradiance, size);
        else
            ck_assert_int_eq(memcmp(first, s.mended.irradiance, size), 0);
        solve_close(&s);
        made_close(&scene);
    }
    free(first);
}
END_TEST

/* Too few rays to know the wall: so it is said. */
START_TEST(test_unsure)
{
    struct scene scene;
    struct solve s;
    uint64_t rays;
    double root;
    two_furnaces(&s, &scene, DARK, 2);
    spoil_wall(&s);
    ck_assert_int_ge(mend_apart(&s, 2000, 2000, &rays, &root), 1);
    ck_assert_uint_ge(unsure, 1);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* As a whole: the walls of that box are known, and right where links were. */
START_TEST(test_weak_lamp)
{
    struct scene scene;
    struct solve s;
    struct measured_error alone;
    two_furnaces(&s, &scene, 1e-10, 2);
    mend_all(&s, 1e-2, 200000, &alone);
    ck_assert_double_eq_tol(of_face(&s, WALL) / 1e-10, 1, 0.05);
    for (uint32_t i = 0; i < alone.dim.unsure; i++)
        ck_assert_uint_gt(alone.dim.named[i], WALL);
    measured_error_free(&alone);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* However much a first look might have taken: what is paid for is believed. */
START_TEST(test_large_budget)
{
    struct scene scene;
    struct solve s;
    uint64_t rays;
    double root;
    two_furnaces(&s, &scene, DARK, 2);
    spoil_wall(&s);
    ck_assert_int_eq(mend_apart(&s, 200000, 2000000, &rays, &root), 1);
    ck_assert_double_eq_tol(of_face(&s, WALL) / DARK, 1, 0.05);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Where mending has taken all that it may, paths take no more than that again; also where that much
 * more would make surer what is known. */
START_TEST(test_budget)
{
    const double most = 1.6e6; /* what is left of DIM_FEW may be taken in any case */
    struct scene scene;
    struct solve s;
    struct measured_error alone;
    furnaces_cut(&s, &scene, DARK, 1, 2); /* six dark walls */
    mend_all(&s, 1e-5, (uint64_t)most, &alone);
    printf("at most %.0f rays: %.0f in all\n", most, (double)alone.rays);
    ck_assert_double_gt((double)alone.rays, 1.2 * most);
    ck_assert_double_lt((double)alone.rays, 2.1 * most);
    measured_error_free(&alone);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* A box of faces with two sides, whose insides are dark, in a room: each is as large as both. */
START_TEST(test_dark_side)
{
    struct scene scene;
    struct solve s;
    ck_assert_int_eq(scene_read(&scene, "tests/runtime/dark_box.obj", &(struct scene_options){0}),
                     0);
    const char *cause;
    ck_assert_int_eq(lit_faces_find(&scene, NULL, 1, &cause), 0);
    solve_with(&s, &scene, "power", RELEASE_FLAT, NULL, quick(1));
    uint32_t dark = 0;
    for (uint32_t i = 0; i < s.hierarchy.face_count; i++)
        dark += s.hierarchy.faces[i].light == FACE_DARK;
    ck_assert_uint_eq(dark, 6);
    struct tracer t = solve_tracer(&s);
    ck_assert_int_eq(tracer_open(&t), 0);
    struct dim_faces d = {.size = DIM_LARGE_ONES, .solve = &s, .tracer = &t};
    ck_assert_int_eq(dim_list_open(&d, 100), 0);
    ck_assert_uint_eq(d.count, 12);
    dim_list_close(&d);
    tracer_close(&t);
    solve_close(&s);
    scene_free(&scene);
}
END_TEST

/* Groups are of one wall each, and no face that is small is left out. */
START_TEST(test_groups)
{
    struct scene scene;
    struct solve s;
    struct tracer tracer;
    double area[WALL + 1 + 5 * CUTS * CUTS] = {0};
    uint32_t part[WALL + 1 + 5 * CUTS * CUTS], count = WALL + 1 + 5 * CUTS * CUTS,
                                               members[GROUPS] = {0};
    two_furnaces(&s, &scene, DARK, 1);
    ck_assert_uint_eq(scene.face_count, count);
    tracer = solve_tracer(&s);
    ck_assert_int_eq(tracer_open(&tracer), 0);
    const struct hierarchy *h = &s.hierarchy;
    for (uint32_t i = 0; i < h->face_count; i++) {
        part[i] = h->faces[i].input;
        area[part[i]] += tracer_surface(&tracer, i)->area;
    }
    ck_assert_int_eq(dim_parts_find(&tracer, area, 0.01 * 12, part, &count), 0);
    ck_assert_uint_eq(count, h->face_count + GROUPS);
    const double *normal[GROUPS];
    for (uint32_t i = 0; i < h->face_count; i++) {
        const uint32_t of = part[i] - h->face_count;
        if (h->faces[i].input <= WALL) {
            ck_assert_uint_eq(part[i], h->faces[i].input);
            continue;
        }
        ck_assert_uint_lt(of, GROUPS);
        if (members[of]++ == 0)
            normal[of] = tracer_surface(&tracer, i)->normal;
        ck_assert_double_gt(dot3(normal[of], tracer_surface(&tracer, i)->normal), 0.999);
    }
    for (int i = 0; i < GROUPS; i++)
        ck_assert_uint_eq(members[i], 2);
    tracer_close(&tracer);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Few rays: of the dark box nothing is known, and so it is said, by wall and by group. */
START_TEST(test_groups_told)
{
    struct scene scene;
    struct solve s;
    struct measured_error alone;
    two_furnaces(&s, &scene, DARK, 2);
    s.report.counts.rays = 1000000000; /* so that none is left for what is small */
    mend_all(&s, 1e-2, 20000, &alone);
    ck_assert_uint_eq(alone.gathered, GROUPS);
    ck_assert_uint_ge(alone.dim.unsure, GROUPS / 2);
    for (uint32_t i = 0; i < alone.dim.unsure; i++) {
        ck_assert_uint_ge(alone.dim.named[i], WALL);
        ck_assert(i == 0 || alone.dim.named[i] > alone.dim.named[i - 1]);
    }
    measured_error_free(&alone);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* What is small and not known is counted, though no ray is left to ask it: all parts of the dark
 * box. Parts of a bright one that few particles met links and particles together know, but for one
 * in twenty. */
START_TEST(test_small_told)
{
    static const double light[] = {DARK, 1};
    for (int i = 0; i < 2; i++) {
        struct scene scene;
        struct solve s;
        struct measured_error alone;
        two_furnaces(&s, &scene, light[i], 2);
        s.report.counts.rays = 1000000000;
        mend_all(&s, 1e-2, 200000, &alone);
        if (i == 0)
            ck_assert_uint_eq(alone.small.unsure, 5 * CUTS * CUTS);
        else
            ck_assert_uint_le(alone.small.unsure, 5 * CUTS * CUTS / 20);
        ck_assert_double_eq_tol(alone.small.area, alone.small.unsure * (1.0 / (CUTS * CUTS)), 1e-9);
        measured_error_free(&alone);
        solve_close(&s);
        made_close(&scene);
    }
}
END_TEST

/* Small faces where little light is: all of them are three times too bright, and none stays so. */
START_TEST(test_small)
{
    struct scene scene;
    struct solve s;
    struct measured_error alone;
    two_furnaces(&s, &scene, DARK, 2);
    spoil(&s, WALL + 1, scene.face_count, 3);
    mend_all(&s, 1e-2, 200000, &alone);
    for (uint32_t f = WALL + 1; f < scene.face_count; f++)
        ck_assert_double_eq_tol(of_face(&s, f) / DARK, 1, 0.15);
    measured_error_free(&alone);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* What surrounds the wall is ten times too bright, and too dim for particles to tell: paths go on
 * from there and end in nothing that nobody knows. */
START_TEST(test_dim_places)
{
    struct scene scene;
    struct solve s;
    uint64_t rays;
    double root;
    two_furnaces(&s, &scene, DARK, 2);
    spoil(&s, WALL + 1, scene.face_count, 10);
    ck_assert_int_eq(mend_apart(&s, 20000, 400000, &rays, &root), 1);
    ck_assert_double_eq_tol(of_face(&s, WALL) / DARK, 1, 0.05);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* A closed room in which H is 1 W/m2 of red light and DARK of blue, everywhere: walls emit 1 - rho
 * of either. All but the first reflect blue alone, and are known by what few particles are left
 * with of it, unless these are split by bands: by all light walls are as bright as any. */
START_TEST(test_dim_band)
{
    struct scene scene;
    struct solve s;
    struct measured_error alone;
    made_open(&scene);
    scene.bands = 3;
    const uint32_t red = made_material(&scene, 0, 0), blue = made_material(&scene, 0, 0);
    scene.materials[red].reflectance[0] = 0.9;
    scene.materials[red].exitance[0] = 0.1;
    scene.materials[red].exitance[2] = DARK;
    scene.materials[blue].reflectance[2] = 0.9;
    scene.materials[blue].exitance[0] = 1;
    scene.materials[blue].exitance[2] = DARK / 10;
    const uint32_t walls[6] = {red, blue, blue, blue, blue, blue};
    made_room(&scene, walls, 1, 1, 1);
    solve_with(&s, &scene, "power", RELEASE_FLAT, NULL, quick(2));
    mend_all(&s, 1e-2, 200000, &alone);
    printf("of blue light particles know walls to %.2g\n", alone.faces.band_noise[2]);
    ck_assert_uint_eq(alone.dim.unsure, 0);
    for (uint32_t f = 1; f < 6; f++)
        ck_assert_double_eq_tol(s.mended.irradiance[3 * s.hierarchy.face_element[f] + 2] / DARK, 1,
                                0.05);
    ck_assert_double_lt(alone.faces.band_noise[2], 0.2); /* .28 by those that are not split */
    measured_error_free(&alone);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Where every large face is met by particles enough, nothing is asked and nothing paid. */
START_TEST(test_bright)
{
    struct scene scene;
    struct solve s;
    uint64_t rays;
    double root;
    two_furnaces(&s, &scene, 1, 2);
    ck_assert_int_eq(mend_apart(&s, 200000, 20000, &rays, &root), 0);
    ck_assert_uint_eq(rays, 0);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* A red lamp for a ceiling, and one wall that reflects red; what the others reflect no lamp emits,
 * so that they are dark for sure and nobody asks for their light; or only one outside of
 * the room does, which paths cannot know. What they receive of the red lamp's light is none of
 * their light, and not for paths to change: the red wall keeps what it has, F. */
static void other_colours(int green_lamp)
{
    const double F = 0.2000437760754032;
    static const double at[3] = {5, 0, 0}, along[3][3] = {{0, 0.1, 0}, {0.1, 0, 0}, {0, 0, 0.1}};
    struct scene scene;
    struct solve s;
    struct measured_error alone;
    made_open(&scene);
    scene.bands = 3;
    const uint32_t cyan = made_material(&scene, 0, 0), red = made_material(&scene, 0, 0),
                   lamp = made_material(&scene, 0, 0), green = made_material(&scene, 0, 0);
    scene.materials[cyan].reflectance[1] = scene.materials[cyan].reflectance[2] = 0.5;
    scene.materials[red].reflectance[0] = 0.3;
    scene.materials[lamp].exitance[0] = 1;
    scene.materials[green].exitance[1] = 1;
    const uint32_t walls[6] = {red, cyan, cyan, cyan, cyan, lamp};
    made_room(&scene, walls, 1, 1, 1);
    if (green_lamp)
        made_box(&scene, green, at, along, 0);
    solve_with(&s, &scene, "power", RELEASE_FLAT, NULL, quick(2));
    mend_all(&s, 1e-2, 200000, &alone);
    ck_assert_uint_eq(alone.dim.large, green_lamp ? 5 : 1);
    ck_assert_uint_eq(alone.dim.unsure, green_lamp ? 4 : 0);
    ck_assert_double_eq_tol(s.mended.irradiance[3 * s.hierarchy.face_element[0]] / F, 1, 0.003);
    measured_error_free(&alone);
    solve_close(&s);
    made_close(&scene);
}

START_TEST(test_other_colours)
{
    other_colours(0);
}
END_TEST

START_TEST(test_lamp_outside)
{
    other_colours(1);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("dim faces");
    TCase *tests = tcase_create("");
    tcase_set_timeout(tests, 60);
    tcase_add_test(tests, test_found);
    tcase_add_test(tests, test_stood_on);
    tcase_add_test(tests, test_unsure);
    tcase_add_test(tests, test_dark_side);
    tcase_add_test(tests, test_groups);
    tcase_add_test(tests, test_groups_told);
    tcase_add_test(tests, test_weak_lamp);
    tcase_add_test(tests, test_same_bits);
    tcase_add_test(tests, test_large_budget);
    tcase_add_test(tests, test_budget);
    tcase_add_test(tests, test_small);
    tcase_add_test(tests, test_small_told);
    tcase_add_test(tests, test_dim_places);
    tcase_add_test(tests, test_bright);
    tcase_add_test(tests, test_dim_band);
    tcase_add_test(tests, test_other_colours);
    tcase_add_test(tests, test_lamp_outside);
    suite_add_tcase(suite, tests);
    return suite_failures(suite) > 0;
}
