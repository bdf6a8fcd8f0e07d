/* check_runtime.c - the hierarchy, precise answers that must be true, and what a link keeps.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "scene/make_scene.h"
#include "visibility/contact_fraction.h"
#include "visibility/rays.h"
#include "engine/refine.h"
#include "engine/solve.h"
#include "suite.h"
#include "tools/clusters.h"
#include "tools/support_planes.h"
#include "tools/visibility.h"

static double random_unit(unsigned *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0;
}

/* n random small quads in the unit cube, some of them coplanar with others. */
static void clutter(struct scene *s, int n, unsigned seed)
{
    made_open(s);
    made_material(s, 0.5, 1);
    for (int i = 0; i < n; i++) {
        double v[9];
        for (int k = 0; k < 9; k++)
            v[k] = k < 3 ? random_unit(&seed) : 0.2 * (random_unit(&seed) - 0.5);
        if (i % 3 == 0)
            v[2] = 0.25, v[5] = v[8] = 0; /* in the plane z = 1/4 */
        made_quad(s, 0, v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8]);
    }
}

/* Every element lies within its parent, areas add up, identities are unique, every face is there
 * once. */
START_TEST(test_hierarchy)
{
    uint32_t faces = 0;
    struct scene s;
    clutter(&s, 200, 5);
    struct hierarchy h;
    ck_assert_int_eq(hierarchy_build(&h, s.faces, s.face_count), 0);
    for (uint32_t i = 0; i < h.count; i++) {
        const struct element *e = &h.elements[i];
        double area = 0;
        faces += e->vertices > 0;
        if (e->vertices)
            ck_assert_uint_eq(h.face_element[e->face], i);
        for (uint32_t j = 0; j < i; j++)
            ck_assert(h.elements[j].id != e->id);
        for (int c = 0; c < e->children; c++) {
            const struct element *x = &h.elements[e->child + (uint32_t)c];
            ck_assert_uint_eq(x->parent, i);
            area += x->area;
            for (int n = 0; n < (x->vertices ? x->vertices : 2); n++)
                for (int k = 0; k < 3; k++)
                    ck_assert(x->vertex[n][k] >= e->vertex[0][k]
                              && x->vertex[n][k] <= e->vertex[1][k]);
        }
        if (e->children)
            ck_assert_double_eq_tol(area, e->area, 1e-12);
    }
    ck_assert_uint_eq(faces, s.face_count);
    hierarchy_free(&h);
    made_close(&s);
}
END_TEST

/* Splits in another order give the same parts under the same identities. */
START_TEST(test_split_order)
{
    struct hierarchy a, b;
    struct scene s;
    clutter(&s, 2, 9);
    ck_assert_int_eq(hierarchy_build(&a, s.faces, s.face_count), 0);
    ck_assert_int_eq(hierarchy_build(&b, s.faces, s.face_count), 0);
    for (int i = 0; i < 2; i++) {
        ck_assert_int_eq(hierarchy_split(&a, a.face_element[i]), 0);
        ck_assert_int_eq(hierarchy_split(&b, b.face_element[1 - i]), 0);
        ck_assert_int_eq(hierarchy_split(&a, a.face_element[i]), 0); /* again: nothing */
    }
    ck_assert_uint_eq(a.count, b.count);
    for (int i = 0; i < 2; i++) {
        double area = 0;
        for (int k = 0; k < 4; k++) {
            const struct element *x =
                &a.elements[a.elements[a.face_element[i]].child + (uint32_t)k];
            const struct element *y =
                &b.elements[b.elements[b.face_element[i]].child + (uint32_t)k];
            ck_assert(x->id == y->id && x->depth == 1);
            ck_assert(memcmp(x->vertex, y->vertex, sizeof x->vertex) == 0);
            area += x->area;
        }
        ck_assert_double_eq_tol(area, a.elements[a.face_element[i]].area, 1e-14);
    }
    hierarchy_free(&a);
    hierarchy_free(&b);
    made_close(&s);
}
END_TEST

static void random_point(const struct face *f, unsigned *seed, double p[3])
{
    double s = random_unit(seed), t = random_unit(seed);
    for (int k = 0; k < 3; k++)
        p[k] = f->vertex[0][k] + s * (f->vertex[1][k] - f->vertex[0][k])
               + t * (f->vertex[3][k] - f->vertex[0][k]);
}

/* Could light go from a point of a face below `from` to one of a face below `to`? */
static int exchange(const struct hierarchy *h, uint32_t from, uint32_t to, unsigned *seed)
{
    const struct element *a = &h->elements[from], *b = &h->elements[to];
    double p[3], q[3], v[3];
    if (!a->vertices) {
        for (int c = 0; c < a->children; c++)
            if (exchange(h, a->child + (uint32_t)c, to, seed))
                return 1;
        return 0;
    }
    if (!b->vertices) {
        for (int c = 0; c < b->children; c++)
            if (exchange(h, from, b->child + (uint32_t)c, seed))
                return 1;
        return 0;
    }
    random_point(&h->faces[a->face], seed, p);
    random_point(&h->faces[b->face], seed, q);
    sub3(v, q, p);
    return dot3(a->normal, v) > 1e-9 && dot3(b->normal, v) < -1e-9;
}

/* `apart` and `away` are precise answers: no segment may prove them wrong. */
START_TEST(test_precise)
{
    struct host host = {0};
    unsigned seed = 17;
    int apart = 0, away = 0;
    struct scene s;
    clutter(&s, 120, 23);
    struct hierarchy h;
    ck_assert_int_eq(hierarchy_build(&h, s.faces, s.face_count), 0);
    for (uint32_t i = 0; i < h.count; i++)
        for (uint32_t j = 0; j < h.count; j++) {
            struct discussion d = {
                .receiver = &h.elements[i], .emitter = &h.elements[j], .host = &host};
            enum clusters_answer answer = tool_clusters(&d);
            int none = answer == CLUSTERS_APART;
            apart += none;
            if (answer == CLUSTERS_SURFACES && tool_support_planes(&d) == SUPPORT_PLANES_AWAY) {
                away++;
                none = 1;
            }
            for (int n = 0; none && n < 10; n++)
                ck_assert_msg(!exchange(&h, i, j, &seed), "elements %u and %u do exchange light", i,
                              j);
        }
    printf("%d pairs of clusters apart, %d pairs of faces away\n", apart, away);
    ck_assert_int_gt(apart, 100);
    ck_assert_int_gt(away, 100);
    hierarchy_free(&h);
    made_close(&s);
}
END_TEST

/* Two squares, between them half a wall without thickness, its front to either side. */
START_TEST(test_visibility)
{
    const double zero[3] = {0, 0, 0};
    struct scene s;
    made_open(&s);
    made_material(&s, 0.5, 1);
    made_quad(&s, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    made_quad(&s, 0, 0, 0, 1, 0, 1, 0, 1, 0, 0);
    if (_i == 0)
        made_quad(&s, 0, -1, -1, 0.5, 1.5, 0, 0, 0, 3, 0); /* x < 1/2 */
    else
        made_quad(&s, 0, -1, -1, 0.5, 0, 3, 0, 1.5, 0, 0);
    struct hierarchy h;
    ck_assert_int_eq(hierarchy_build(&h, s.faces, s.face_count), 0);
    const char *cause;
    struct rays *rays = rays_open(&h, zero, zero, 1, &cause);
    ck_assert_ptr_nonnull(rays);
    const struct element *a = &h.elements[h.face_element[0]];
    const struct element *b = &h.elements[h.face_element[1]];
    double v = visibility_rays(a, b, rays_host(rays), 64, 0);
    double w = visibility_rays(b, a, rays_host(rays), 64, 0);
    ck_assert(v == w);
    /* by symmetry; sigma sqrt(v (1 - v) / N) = .06 at random, a net does better */
    ck_assert_double_eq_tol(v, 0.5, 0.1);
    ck_assert_uint_eq(rays_count(rays).rays, 128);
    rays_close(rays);
    hierarchy_free(&h);
    made_close(&s);
}
END_TEST

/* The slats of a blind before a window: 4 cm wide, 3.5 cm apart, 8 cm off. What a slat gets comes
 * from the strip of the window that is next to it, and the other slats hide all else. Few rays
 * chosen from 64 segments say in the mean what many do, but for a fifth; spread evenly over both
 * one to four say less than two thirds of it. */
START_TEST(test_near)
{
    enum { SLATS = 40, PAIRS = 2000 };
    static const double zero[1 + SLATS]; /* of each face */
    struct scene s;
    made_open(&s);
    made_material(&s, 0.5, 1);
    made_quad(&s, 0, 0, 0, 0, 0, 3, 0, 0, 0, 1.4);
    for (int i = 0; i < SLATS; i++)
        made_quad(&s, 0, 0.08, 0, 0.0175 + 0.035 * i, 0.04, 0, 0, 0, 3, 0);
    struct hierarchy h;
    ck_assert_int_eq(hierarchy_build(&h, s.faces, s.face_count), 0);
    const char *cause;
    struct rays *rays = rays_open(&h, zero, zero, 1, &cause);
    ck_assert_ptr_nonnull(rays);
    struct element window = h.elements[h.face_element[0]],
                   slat = h.elements[h.face_element[SLATS / 2]];
    double truth = 0;
    for (uint64_t i = 0; i < 40; i++, slat.id++)
        truth += visibility_rays(&window, &slat, rays_host(rays), 1024, 0) / 40;
    for (int few = 1; few <= 16; few *= 4) {
        double sum = 0, squares = 0, even = 0;
        for (int i = 0; i < PAIRS; i++, slat.id++) {
            const double v = visibility_rays(&slat, &window, rays_host(rays), few, 64);
            sum += v / PAIRS;
            squares += v * v / PAIRS;
            even += visibility_rays(&slat, &window, rays_host(rays), few, 0) / PAIRS;
        }
        const double error = sqrt((squares - sum * sum) / PAIRS);
        printf("a slat sees its window: %.3f +- %.3f by %d rays (evenly %.3f), by many %.3f\n", sum,
               error, few, even, truth);
        ck_assert_double_eq_tol(sum, truth, 4 * error + 0.2 * truth);
        ck_assert(few > 4 || even < 0.667 * truth);
    }
    rays_close(rays);
    hierarchy_free(&h);
    made_close(&s);
}
END_TEST

/* A box without a bottom stands on a quarter of the floor: that quarter is in contact. Still so (1)
 * when a shelf reaches into the box, whose underside faces the floor and takes two of the eight
 * rays from each point. */
START_TEST(test_contact)
{
    const double zero[7] = {0};
    struct scene s;
    made_open(&s);
    made_material(&s, 0.5, 1);
    made_quad(&s, 0, 0, 0, 0, 2, 0, 0, 0, 2, 0);
    made_quad(&s, 0, 0.5, 0.5, 1, 1, 0, 0, 0, 1, 0);
    made_quad(&s, 0, 0.5, 0.5, 0, 1, 0, 0, 0, 0, 1);
    made_quad(&s, 0, 0.5, 1.5, 0, 0, 0, 1, 1, 0, 0);
    made_quad(&s, 0, 0.5, 0.5, 0, 0, 0, 1, 0, 1, 0);
    made_quad(&s, 0, 1.5, 0.5, 0, 0, 1, 0, 0, 0, 1);
    if (_i == 1)
        made_quad(&s, 0, 0.5, 0.5, 0.9, 0, 1, 0, 1, 0, 0);
    struct hierarchy h;
    ck_assert_int_eq(hierarchy_build(&h, s.faces, s.face_count), 0);
    const char *cause;
    struct rays *rays = rays_open(&h, zero, zero, 1, &cause);
    ck_assert_ptr_nonnull(rays);
    ck_assert_double_eq_tol(contact_fraction(rays, &h, &h.elements[h.face_element[0]]), 0.25,
                            1e-12);
    ck_assert_double_eq_tol(contact_fraction(rays, &h, &h.elements[h.face_element[1]]), 0, 1e-12);
    rays_close(rays);
    hierarchy_free(&h);
    made_close(&s);
}
END_TEST

/* A link is 16 bytes and gives back what rays found: all stays all, none stays none. */
START_TEST(test_link)
{
    static const double v[] = {0, 1, 0.5, 0.0625, 1e-9, 1 - 1e-9};
    ck_assert_uint_le(sizeof(struct link), 16);
    for (size_t i = 0; i < sizeof v / sizeof *v; i++) {
        struct terms in, out;
        memset(&in, 0, sizeof in);
        struct link link;
        memset(&link, 0, sizeof link);
        in.form_factor = 0.1;
        in.form_factor_level = FORM_FACTOR_POLYGON;
        in.visibility = v[i];
        in.visibility_level = VISIBILITY_RAYS_16;
        link_store(&link, DECISION_LINK, &in);
        link_recall(&link, &out);
        ck_assert((out.visibility <= 0) == (v[i] <= 0) && (out.visibility >= 1) == (v[i] >= 1));
        ck_assert_double_eq_tol(out.visibility, v[i], 1e-4);
        ck_assert_double_eq_tol(out.form_factor, 0.1, 1e-8);
        ck_assert_int_eq(out.form_factor_level, FORM_FACTOR_POLYGON);
        ck_assert_int_eq(out.axis_level, AXIS_ABSENT);
        link_store(&link, DECISION_LINK_CLUSTERS, &in); /* which does not read the form factor */
        link_recall(&link, &out);
        ck_assert(out.form_factor_level == FORM_FACTOR_ABSENT && !(out.form_factor > 0));
        ck_assert_int_eq(out.visibility_level, VISIBILITY_RAYS_16);
    }
}
END_TEST

extern const struct oracle bf_guarded_oracle;

/* A_r F_rs = A_s F_sr, to the rounding of two floats, and V the same, for every two elements
 * linked both ways. */
START_TEST(test_reciprocity)
{
    struct solve_options how = {.tolerance = 1e-4, .iterations = 100, .threads = 2};
    struct refiner *refiner = refiner_compiled(&bf_guarded_oracle, "flat");
    size_t mutual = 0;
    struct scene scene;
    clutter(&scene, 100, 5);
    struct solve s;
    const char *cause;
    ck_assert_int_eq(solve_open(&s, &scene, &how, &cause), 0);
    ck_assert_int_eq(solve_run(&s, refiner, &cause), 0);
    for (size_t i = 0; i < s.refinement.link_count; i++) {
        const struct link *there = &s.refinement.links[i];
        const struct element *elements = s.hierarchy.elements;
        for (size_t j = s.refinement.first_link[there->emitter];
             j < s.refinement.first_link[there->emitter + 1]; j++) {
            const struct link *back = &s.refinement.links[j];
            double a = elements[there->receiver].area * (double)there->form_factor;
            double b = elements[back->receiver].area * (double)back->form_factor;
            if (back->emitter != there->receiver)
                continue;
            mutual++;
            ck_assert_double_le(fabs(a - b), 2e-7 * (a + b));
            if ((there->levels & 0xf0) == (back->levels & 0xf0))
                ck_assert_uint_eq(there->visibility, back->visibility);
        }
    }
    ck_assert_uint_gt(mutual, 1000);
    solve_close(&s);
    refiner_close(refiner);
    made_close(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("runtime");
    TCase *c = tcase_create("runtime");
    tcase_set_timeout(c, 60);
    tcase_add_test(c, test_hierarchy);
    tcase_add_test(c, test_split_order);
    tcase_add_test(c, test_precise);
    tcase_add_loop_test(c, test_visibility, 0, 2);
    tcase_add_test(c, test_near);
    tcase_add_loop_test(c, test_contact, 0, 2);
    tcase_add_test(c, test_link);
    tcase_add_test(c, test_reciprocity);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
