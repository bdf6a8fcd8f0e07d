/* check_bends.c - a receiver is split for light that bends over it, not for links whose bends make
 * up for each other: furnaces, where one element a face is exact, and rooms where it is not.
 * SPDX-License-Identifier: MIT */
#include "engine/bends.h"
#include "kernel/corner_factors.h"
#include "kernel/polygon_factor.h"
#include "make_solve.h"
#include "suite.h"

/* Pairs of faces that see each other; of convex scenes, those that do not lie in one plane. */
static size_t pairs_of(const struct hierarchy *h)
{
    size_t pairs = 0;
    for (uint32_t i = 0; i < h->face_count; i++)
        for (uint32_t j = 0; j < h->face_count; j++) {
            const struct element *r = hierarchy_surface(h, i), *s = hierarchy_surface(h, j);
            double high = 0;
            for (int k = 0; k < s->vertices; k++)
                high = fmax(high, height3(s->vertex[k], r->centre, r->normal));
            pairs += high > 1e-6;
        }
    return pairs;
}

/* E and rho are the same everywhere, and so is B = E / (1 - rho): one element a face is exact. */
START_TEST(test_furnace)
{
    static void (*const shapes[3])(struct scene *, double) = {furnace_cube, furnace_prism,
                                                              furnace_octahedron};
    const double rho = _i % 2 ? 0.9 : 0.5;
    struct scene scene;
    struct solve s;
    shapes[_i / 2](&scene, rho);
    solve_with(&s, &scene, "power", RELEASE_FLAT, NULL, quick_linear(1));
    printf("furnace %d, rho %.1f: %zu links of %zu pairs\n", _i / 2, rho, s.refinement.link_count,
           pairs_of(&s.hierarchy));
    ck_assert_uint_eq(s.hierarchy.count, s.hierarchy.built);
    ck_assert_uint_eq(s.refinement.link_count, pairs_of(&s.hierarchy));
    ck_assert_uint_eq(rays_count(s.problem.rays).rays, 0);
    for (uint32_t i = 0; i < s.hierarchy.face_count; i++)
        ck_assert_double_eq_tol(face_radiosity(&s, i) * (1 - rho), 1, 1e-4);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* The cube with one wall that is darker: what makes up for each other is no longer there. */
START_TEST(test_uneven)
{
    struct scene scene;
    struct solve s;
    made_open(&scene);
    uint32_t bright = made_material(&scene, 0.5, 1), dark = made_material(&scene, 0.5, 0);
    made_room(&scene, (const uint32_t[6]){bright, dark, bright, bright, bright, bright}, 1, 1, 1);
    solve_with(&s, &scene, "power", RELEASE_FLAT, NULL, quick_linear(1));
    ck_assert_uint_gt(s.hierarchy.count, s.hierarchy.built);
    uint32_t still = 0;
    for (uint32_t i = 0; i < s.hierarchy.face_count; i++)
        still += hierarchy_surface(&s.hierarchy, i)->children == 0;
    printf("cube with one dark wall: %zu links, %u faces whole\n", s.refinement.link_count, still);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* A lamp over a floor: less light comes than was guessed, so that nothing grows but the bend. */
START_TEST(test_found)
{
    struct scene scene;
    struct solve s;
    made_open(&scene);
    uint32_t lamp = made_material(&scene, 0, 1), grey = made_material(&scene, 0.5, 0);
    made_quad(&scene, grey, 0, 0, 0, 4, 0, 0, 0, 4, 0);
    made_quad(&scene, lamp, 0, 0, 1, 0, 1, 0, 1, 0, 0);
    solve_with(&s, &scene, "power", RELEASE_FLAT, NULL, quick_linear(1));
    printf("lamp over a floor: %zu links\n", s.refinement.link_count);
    ck_assert_int_eq(hierarchy_surface(&s.hierarchy, 0)->children, 4);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* A square under a lamp in two halves: what both bring together, against the sum of what each does
 * at the square's centre and corners. */
START_TEST(test_sum)
{
    struct scene scene;
    struct solve s;
    made_open(&scene);
    uint32_t lamp = made_material(&scene, 0, 1), grey = made_material(&scene, 0.5, 0);
    made_quad(&scene, grey, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    made_quad(&scene, lamp, 0, 0, 1, 0, 1, 0, 0.5, 0, 0);
    made_quad(&scene, lamp, 0.5, 0, 1, 0, 1, 0, 0.5, 0, 0);
    char *const coarse[] = {"bend=1", "shadow=1", NULL};
    solve_with(&s, &scene, "power", RELEASE_FLAT, coarse, quick_linear(1));
    const struct element *floor = hierarchy_surface(&s.hierarchy, 0);
    ck_assert_uint_eq(s.hierarchy.count, s.hierarchy.built);
    const struct element *above[2] = {hierarchy_surface(&s.hierarchy, 1),
                                      hierarchy_surface(&s.hierarchy, 2)};
    double whole[5] = {0}, mean = 0;
    for (int i = 0; i < 2; i++) {
        double f[5];
        (void)corner_factors(floor, above[i], f);
        for (int k = 0; k < 5; k++)
            whole[k] += f[k];
        mean += polygon_factor(floor, above[i], 0);
    }
    ck_assert_double_eq_tol(whole[1], whole[3], 1e-9); /* symmetric: no twist */
    ck_assert_double_eq_tol((double)floor->bend,
                            fmax(2 / 3.0 * fabs(whole[0] - whole[1]),
                                 fabs(mean - 2 / 3.0 * whole[0] - 1 / 3.0 * whole[1])),
                            1e-6);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Under a low ceiling of strips, bright and dark in turn, what all bring together is the same at
 * the floor's centre and corners, and is not even. Held against an oracle that splits for every
 * link. */
START_TEST(test_strips)
{
    enum { STRIPS = 8 };
    struct scene scene;
    struct solve s, other;
    struct solve_options options = quick_linear(1);
    options.tolerance = 0; /* by what the elements leave; last digits of sums are not even */
    made_open(&scene);
    uint32_t even = made_material(&scene, 0.5, 0.5), bright = made_material(&scene, 0.5, 1),
             dark = made_material(&scene, 0.5, 0);
    made_quad(&scene, even, 0, 0, 0, 10, 0, 0, 0, 10, 0);
    made_quad(&scene, even, 0, 0, 0, 0, 0, 0.1, 10, 0, 0);
    made_quad(&scene, even, 0, 10, 0, 10, 0, 0, 0, 0, 0.1);
    made_quad(&scene, even, 0, 0, 0, 0, 10, 0, 0, 0, 0.1);
    made_quad(&scene, even, 10, 0, 0, 0, 0, 0.1, 0, 10, 0);
    for (int i = 0; i < STRIPS; i++) {
        const double from = 10.0 * i / STRIPS, to = 10.0 * (i + 1) / STRIPS;
        made_quad(&scene, i % 2 ? bright : dark, from, 0, 0.1, 0, 10, 0, to - from, 0, 0);
    }
    solve_with(&s, &scene, "power", RELEASE_FLAT, NULL, options);
    solve_with(&other, &scene, "bf_guarded", RELEASE_FLAT, NULL, options);
    double off = 0, all = 0;
    for (uint32_t i = 0; i < s.hierarchy.face_count; i++) {
        const double area = hierarchy_surface(&s.hierarchy, i)->area;
        off += area * fabs(face_radiosity(&s, i) - face_radiosity(&other, i));
        all += area * face_radiosity(&other, i);
    }
    printf("%d strips: %zu links, %.2f %% from %zu links of bf_guarded\n", STRIPS,
           s.refinement.link_count, 100 * off / all, other.refinement.link_count);
    ck_assert_double_lt(off, 0.02 * all);
    solve_close(&s);
    solve_close(&other);
    made_close(&scene);
}
END_TEST

/* What is written by hand asks for the same. */
START_TEST(test_hand)
{
    struct scene scene;
    struct solve s, hand;
    made_open(&scene);
    uint32_t bright = made_material(&scene, 0.5, 1), dark = made_material(&scene, 0.5, 0);
    made_room(&scene, (const uint32_t[6]){bright, dark, bright, bright, bright, bright}, 1, 1, 1);
    solve_with(&s, &scene, "power", RELEASE_FLAT, NULL, quick_linear(1));
    solve_with(&hand, &scene, "power", RELEASE_HAND, NULL, quick_linear(1));
    same_links(&s, &hand);
    solve_close(&s);
    solve_close(&hand);
    made_close(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bends");
    TCase *c = tcase_create("bends");
    tcase_add_loop_test(c, test_furnace, 0, 6);
    tcase_add_test(c, test_uneven);
    tcase_add_test(c, test_found);
    tcase_add_test(c, test_sum);
    tcase_add_test(c, test_strips);
    tcase_add_test(c, test_hand);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
