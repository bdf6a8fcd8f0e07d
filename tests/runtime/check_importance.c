/* check_importance.c - what the solver tells oracles of a view and of errors: importance against a
 * direct solution and by duality, the residual of a leaf against its definition, error control
 * against a known solution.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include "engine/residual.h"
#include "runtime/make_solve.h"
#include "make_camera.h"
#include "oracles.h"
#include "suite.h"

/* BF with a threshold by importance; `%s`: that threshold. */
static const char weighted[] =
    "oracle weighted \"bf for a view\" { start level;\n"
    "  node level = clusters() { surfaces -> planes;  apart -> stop;  receiver -> "
    "subdivide_receiver;  emitter -> subdivide_emitter; }\n"
    "  node planes = support_planes() { away -> stop;  otherwise -> energy; }\n"
    "  node energy = transfer(relative = %s) { dark -> stop;  below -> few;  above -> guard; }\n"
    "  node guard = can_split(min_share = 2e-4) { both -> side;  neither -> few;\n"
    "                         receiver -> subdivide_receiver;  emitter -> subdivide_emitter; }\n"
    "  node side = larger() { receiver -> subdivide_receiver;  emitter -> subdivide_emitter; }\n"
    "  node few = visibility(rays = 16) { none -> stop;  partial | all -> form; }\n"
    "  node form = form_factor() { done -> link; }\n"
    "}\n";

static void solve_view(struct solve *s, const struct scene *scene, const char *threshold,
                       struct solve_options options)
{
    char text[2048];
    snprintf(text, sizeof text, weighted, threshold);
    struct refiner *r = interpreted("weighted.dag", text, NULL);
    ck_assert_ptr_nonnull(r);
    ck_assert(refiner_reads(r, FACT_RECEIVER_IMPORTANCE)
              && !refiner_reads(r, FACT_RECEIVER_TOLERANCE));
    const char *cause;
    ck_assert_int_eq(solve_open(s, scene, &options, &cause), 0);
    ck_assert_int_eq(solve_run(s, r, &cause), 0);
    ck_assert_int_eq(s->report.converged, 1);
    refiner_close(r);
}

/* x := A^-1 x, by elimination with pivots; A [n * n] is lost. */
static void eliminate(double *a, double *x, size_t n)
{
    for (size_t k = 0; k < n; k++) {
        size_t p = k;
        for (size_t i = k + 1; i < n; i++)
            p = fabs(a[i * n + k]) > fabs(a[p * n + k]) ? i : p;
        for (size_t j = k; p != k && j < n; j++) {
            double keep = a[k * n + j];
            a[k * n + j] = a[p * n + j];
            a[p * n + j] = keep;
        }
        if (p != k) {
            double keep = x[k];
            x[k] = x[p];
            x[p] = keep;
        }
        for (size_t i = k + 1; i < n; i++) {
            double f = a[i * n + k] / a[k * n + k];
            for (size_t j = k; j < n && f != 0; j++)
                a[i * n + j] -= f * a[k * n + j];
            x[i] -= f * x[k];
        }
    }
    for (size_t k = n; k-- > 0;) {
        for (size_t j = k + 1; j < n; j++)
            x[k] -= a[k * n + j] * x[j];
        x[k] /= a[k * n + k];
    }
}

/* The share of leaf j in what element e sends, 0 when it is not below e. */
static double part_of(const struct solve *s, uint32_t j, uint32_t e)
{
    uint32_t up = j;
    while (up > e)
        up = s->hierarchy.elements[up].parent;
    return up == e ? s->hierarchy.elements[j].area
                         * s->operator.uncovered[j] /(s->hierarchy.elements[e].area
                                                      * s->operator.uncovered[e])
                   : 0;
}

struct view {
    double eye[3], at[3], fov; /* m, degrees */
};
static const struct view into_the_corner = {{3.9, 4.9, 2.9}, {0, 0, 0}, 25};

static struct camera camera_of(const struct view *view, double aspect)
{
    return made_camera(view->eye, view->at, view->fov, aspect);
}

/* Importance by sweeps over the links is that of the same links written out as one matrix and
 * solved at once. */
START_TEST(test_importance_dense)
{
    struct solve_options options = quick(1);
    uint32_t n = 0;
    double worst = 0;
    options.tolerance = 1e-9;
    options.closure = CLOSURE_ROWS; /* no gifts among leaves, which a matrix row does not show */
    struct scene scene;
    furnished(&scene, 1);
    const struct camera camera = camera_of(&into_the_corner, 1.5);
    options.camera = &camera;
    struct solve s;
    solve_view(&s, &scene, "0.1 / max(receiver.importance, 0.01)", options);
    uint32_t *leaf;
    leaf = malloc(s.hierarchy.count * sizeof *leaf);
    for (uint32_t i = 0; i < s.hierarchy.count; i++)
        if (s.hierarchy.elements[i].vertices && !s.hierarchy.elements[i].children)
            leaf[n++] = i;
    double *a;
    a = calloc((size_t)n * n, sizeof *a);
    double *y;
    y = calloc(n, sizeof *y);
    ck_assert_uint_gt(n, 100);
    for (uint32_t i = 0; i < n; i++) {
        a[(size_t)i * n + i] = 1;
        y[i] = s.importance.response[leaf[i]];
        ck_assert(s.operator.row_share[leaf[i]] == 0 || !(s.operator.uncovered[leaf[i]]> 0));
        for (uint32_t up = leaf[i];
             s.operator.uncovered[leaf[i]]> 0 && s.hierarchy.elements[up].vertices;
             up = s.hierarchy.elements[up].parent)
            for (size_t l = s.refinement.first_link[up]; l < s.refinement.first_link[up + 1]; l++) {
                const struct link *link = &s.refinement.links[l];
                double f = (double)link->form_factor * link->visibility / LINK_VISIBLE
                           * s.operator.row_scale[leaf[i]] / s.operator.uncovered[up];
                for (uint32_t j = 0; j < n; j++)
                    a[(size_t)i * n + j] -= f * part_of(&s, leaf[j], link->emitter)
                                            * s.hierarchy.elements[leaf[j]].reflectance;
            }
    }
    eliminate(a, y, n);
    for (uint32_t i = 0; i < n; i++)
        worst = s.operator.uncovered[leaf[i]]> 0
                    ? fmax(worst, fabs(s.importance.value[leaf[i]] - y[i]))
                    : worst;
    printf("importance of %u leaves: at most %.1e from the direct solution; from %.3g in the mean "
           "to %.3g\n",
           n, worst, s.importance.mean, s.importance.largest);
    ck_assert_double_le(worst, 1e-6 * s.importance.largest);
    ck_assert_double_gt(s.importance.seen, 0.5);
    ck_assert_double_lt(s.importance.seen, 0.5 * rays_host(s.problem.rays)->area);
    for (uint32_t i = 0; i < s.hierarchy.count; i++) {
        double share = fmax(s.importance.value[i] / s.importance.largest, 1e-4);
        ck_assert_double_le(fabs(s.hierarchy.elements[i].importance - share), 0.0201 * share);
    }
    free(a);
    free(y);
    free(leaf);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* <r, B> = <Y, E>: what the picture holds is what the light that is emitted means to it. Exact to
 * rounding where links are reciprocal: two plates, linked alike both ways. In a room as good as its
 * links. */
START_TEST(test_importance_dual)
{
    static const struct view down = {{0.5, 0.5, 0.9}, {0.4, 0.5, 0}, 40};
    struct solve_options options = quick(1);
    double left = 0, right = 0;
    options.tolerance = 1e-9;
    struct scene scene;
    if (_i) {
        furnished(&scene, 1);
    } else {
        made_open(&scene);
        made_material(&scene, 0.5, 1);
        made_quad(&scene, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
        made_quad(&scene, 0, 0, 0, 1, 0, 1, 0, 1, 0, 0);
    }
    const struct camera camera = camera_of(_i ? &into_the_corner : &down, 1);
    options.camera = &camera;
    struct solve s;
    solve_view(&s, &scene, "0.05 + 0 * receiver.importance", options);
    for (uint32_t i = 0; i < s.hierarchy.count; i++) {
        const struct element *e = &s.hierarchy.elements[i];
        if (e->children || !e->vertices)
            continue;
        left += e->area * s.operator.uncovered[i] * s.importance.response[i] * s.state.radiosity[i];
        right +=
            e->area * s.operator.uncovered[i] * s.importance.value[i] * s.problem.exitance[e->face];
    }
    printf("what the picture holds: %.9g W by light, %.9g W by importance\n", left, right);
    ck_assert_double_gt(left, 0.1);
    ck_assert_double_le(fabs(left / right - 1), _i ? 0.05 : 1e-6);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* An oracle that weighs by importance spends less on what the picture does not hold, and gets the
 * picture's light as well as the oracle that refines everywhere. */
START_TEST(test_importance_pays)
{
    struct solve_options options = quick(1);
    double sum[2] = {0, 0};
    struct scene scene;
    furnished(&scene, 1);
    const struct camera camera = camera_of(&into_the_corner, 1);
    options.camera = &camera;
    struct solve s[2];
    for (int k = 0; k < 2; k++) {
        solve_view(&s[k], &scene,
                   k ? "0.02 / max(receiver.importance, 0.01)" : "0.02 + 0 * receiver.importance",
                   options);
        for (uint32_t i = 0; i < s[k].hierarchy.count; i++)
            if (s[k].hierarchy.elements[i].vertices && !s[k].hierarchy.elements[i].children)
                sum[k] += s[k].hierarchy.elements[i].area * s[k].importance.response[i]
                          * s[k].state.radiosity[i];
    }
    printf("in the picture %.5g W by %zu links, %.5g W by %zu links of importance\n", sum[0],
           s[0].refinement.link_count, sum[1], s[1].refinement.link_count);
    ck_assert_double_le(fabs(sum[1] / sum[0] - 1), 0.03);
    ck_assert_double_le((double)s[1].refinement.link_count,
                        0.75 * (double)s[0].refinement.link_count);
    for (int k = 0; k < 2; k++)
        solve_close(&s[k]);
    made_close(&scene);
}
END_TEST

/* F at the point x of a leaf with normal n, by the midpoint rule of N x N points over the
 * emitter's quad. */
static double factor_at(const double x[3], const double n[3], const struct element *s, int N)
{
    double sum = 0;
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) {
            double u = (i + 0.5) / N, v = (j + 0.5) / N, w[3];
            for (int k = 0; k < 3; k++)
                w[k] = s->vertex[0][k] + u * (s->vertex[1][k] - s->vertex[0][k])
                       + v * (s->vertex[3][k] - s->vertex[0][k]) - x[k];
            double q = dot3(w, w);
            double a = dot3(w, n);
            double b = -dot3(w, s->normal);
            sum += a > 0 && b > 0 ? a * b / (M_PI * q * q) : 0;
        }
    return sum * s->area / ((double)N * N);
}

/* A leaf's residual against its definition, links and integrals written out. */
START_TEST(test_residual)
{
    static char *settings[] = {"relative=0.05", "min_share=1e-3", NULL};
    uint32_t found = 0;
    struct scene scene;
    made_open(&scene);
    made_material(&scene, 0.5, 1);
    made_material(&scene, 0.7, 0);
    made_quad(&scene, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    made_quad(&scene, 1, 0.3, 0, 1, 0, 1, 0, 1, 0, 0);
    struct solve s;
    solve_with(&s, &scene, "bf", RELEASE_FLAT, settings, quick(1));
    for (uint32_t i = 0; i < s.hierarchy.count && found < 3; i++) {
        const struct element *e = &s.hierarchy.elements[i];
        double worst = 0;
        uint32_t links = 0;
        if (!e->vertices || e->children || e->face != 1)
            continue;
        for (int k = 0; k < 5; k++) {
            const double *x = k < 4 ? e->vertex[k] : e->centre;
            double sum = 0;
            links = 0;
            for (uint32_t up = i; s.hierarchy.elements[up].vertices;
                 up = s.hierarchy.elements[up].parent)
                for (size_t l = s.refinement.first_link[up]; l < s.refinement.first_link[up + 1];
                     l++, links++) {
                    const struct link *link = &s.refinement.links[l];
                    sum += s.state.radiosity[link->emitter] * link->visibility / LINK_VISIBLE
                           * (factor_at(x, e->normal, &s.hierarchy.elements[link->emitter], 300)
                              - (double)link->form_factor);
                }
            worst = fmax(worst, 0.7 * fabs(sum));
        }
        struct leaf_residual d;
        d = residual_of_leaf(&s.operator, s.state.radiosity, i);
        ck_assert_uint_eq(d.links, links);
        ck_assert_double_eq_tol(d.all, worst, 2e-5);
        ck_assert_double_gt(d.all, 1e-3);
        ck_assert(d.guarded <= d.all + 1e-12);
        found++;
    }
    ck_assert_uint_eq(found, 3);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Error control: what was asked for is held by every leaf that is not given up, and by the face
 * means of a cube whose solution is known; tolerances start where they should, only fall, and a
 * parent's is the least of its children's. */
START_TEST(test_error_control)
{
    static char *wanted[3][4] = {{"relative=0", "epsilon=0.1", "min_share=1e-4", NULL},
                                 {"relative=0", "epsilon=0.05", "min_share=1e-4", NULL},
                                 {"relative=0", "epsilon=0.025", "min_share=1e-4", NULL}};
    static const double eps[3] = {0.1, 0.05, 0.025};
    size_t links[3];
    for (int k = 0; k < 3; k++) {
        uint32_t m[6], given_up = 0, fallen = 0;
        struct scene scene;
        made_open(&scene);
        made_material(&scene, 0.5, 0);
        made_material(&scene, 0.5, 1);
        for (uint32_t f = 0; f < 6; f++)
            m[f] = f == 1;
        made_room(&scene, m, 1, 1, 1);
        struct solve s;
        solve_with(&s, &scene, "error_control", RELEASE_FLAT, wanted[k], quick(1));
        links[k] = s.refinement.link_count;
        ck_assert_double_eq_tol(s.error.target, eps[k], 1e-15);
        for (uint32_t i = 0; i < s.hierarchy.count; i++) {
            const struct element *e = &s.hierarchy.elements[i];
            double least = INFINITY;
            ck_assert_double_le(e->tolerance, 0.5 * eps[k]);
            fallen += e->vertices && e->tolerance < 0.49 * eps[k];
            for (int c = 0; c < e->children; c++)
                least = fmin(least, s.hierarchy.elements[e->child + (uint32_t)c].tolerance);
            if (e->children)
                ck_assert(least >= e->tolerance
                          && (e->depth > 0 || !e->vertices || least <= 0.5 * eps[k]));
            if (!e->vertices || e->children)
                continue;
            struct leaf_residual left = residual_of_leaf(&s.operator, s.state.radiosity, i);
            if (left.all > eps[k]) {
                given_up++;
                ck_assert(left.guarded > eps[k] || e->tolerance * left.links < 0.25 * eps[k]);
            }
        }
        double off =
            fmax(fabs(face_radiosity(&s, 1) - 1.1043616), fabs(face_radiosity(&s, 0) - 0.1712161));
        for (uint32_t f = 2; f < 6; f++)
            off = fmax(off, fabs(face_radiosity(&s, f) - 0.1811056));
        printf("error asked %.3f: %zu links, %d passes, estimate %.3f, %u of %u leaves given up, "
               "%u elements lowered, face means off by %.1e\n",
               eps[k], links[k], s.report.passes, s.error.largest, given_up, s.report.rows.leaves,
               fallen, off);
        ck_assert((s.error.area > 0) == (given_up > 0));
        ck_assert(k < 2 || fallen > 0);
        ck_assert_double_le(off, eps[k]);
        solve_close(&s);
        made_close(&scene);
    }
    ck_assert_uint_lt(links[0], links[1]);
    ck_assert_uint_lt(links[1], links[2]);
}
END_TEST

/* Groups of faces count, too: a lamp of 16 faces over a floor, linked as a group while the floor's
 * tolerance bears it. Every leaf is then within eps at its corners by the faces themselves, but for
 * what taking the group for a point leaves out. */
static const char grouped[] =
    "oracle grouped \"links of groups by tolerance\" { param epsilon : flux = 0 in [0, inf] role "
    "error_tolerance;\n"
    "  start level;\n"
    "  node level = clusters() { surfaces -> form;  apart -> stop;  receiver | emitter -> far; }\n"
    "  node far   = cluster_gap(absolute = 32 * min(receiver.tolerance, epsilon)) { dark -> stop;  "
    "near | above -> open;  below -> sight; }\n"
    "  node sight = cluster_visibility() { none -> stop;  partial | all -> link_clusters; }\n"
    "  node open  = opens(ratio = 1, min_share = 1e-4) { receiver -> subdivide_receiver;  emitter "
    "-> subdivide_emitter; }\n"
    "  node form  = form_factor() { done -> see; }\n"
    "  node see   = visibility(rays = 4) { none | partial | all -> link; }\n"
    "}\n";

START_TEST(test_residual_groups)
{
    static const double eps = 0.002;
    struct solve_options options = quick(1);
    uint32_t leaves = 0, groups = 0;
    double worst = 0;
    struct scene scene;
    made_open(&scene);
    made_material(&scene, 0, 20);
    made_material(&scene, 0.5, 0);
    made_quad(&scene, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    for (uint32_t i = 0; i < 16; i++)
        made_quad(&scene, 0, 0.5 + 0.025 * (i % 4), 0.4 + 0.025 * (i / 4), 1, 0, 0.02, 0, 0.02, 0,
                  0);
    struct refiner *r = interpreted("grouped.dag", grouped, NULL);
    ck_assert_ptr_nonnull(r);
    ck_assert_int_eq(refiner_set(r, "epsilon", eps, NULL), 0);
    struct solve s;
    const char *cause;
    ck_assert_int_eq(solve_open(&s, &scene, &options, &cause), 0);
    ck_assert_int_eq(solve_run(&s, r, &cause), 0);
    for (uint32_t i = 0; i < s.refinement.link_count; i++)
        groups += !s.hierarchy.elements[s.refinement.links[i].emitter].vertices;
    for (uint32_t i = 0; i < s.hierarchy.count; i++) {
        const struct element *e = &s.hierarchy.elements[i];
        if (!e->vertices || e->children || e->face != 0)
            continue;
        leaves++;
        for (int k = 0; k < 4; k++) {
            double sum = 0;
            for (uint32_t f = 1; f <= 16; f++)
                sum +=
                    20 * factor_at(e->vertex[k], e->normal, hierarchy_surface(&s.hierarchy, f), 2);
            worst = fmax(worst, 0.5 * fabs(sum - s.state.irradiance[i]));
        }
    }
    printf("groups: %u leaves, %u links of groups, off by %.2g of %.2g at the corners\n", leaves,
           groups, worst, eps);
    ck_assert_uint_gt(leaves, 4);
    ck_assert_uint_gt(groups, 0);
    ck_assert_double_le(worst, 1.25 * eps);
    solve_close(&s);
    refiner_close(r);
    made_close(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("importance and error control");
    TCase *c = tcase_create("importance and error control");
    tcase_set_timeout(c, 300);
    tcase_add_test(c, test_importance_dense);
    tcase_add_loop_test(c, test_importance_dual, 0, 2);
    tcase_add_test(c, test_importance_pays);
    tcase_add_test(c, test_residual);
    tcase_add_test(c, test_residual_groups);
    tcase_add_test(c, test_error_control);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
