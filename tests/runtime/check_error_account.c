/* check_error_account.c - problems with known answers: the bound is never below the true error, in
 * any of three norms, and the estimates are near it.
 *
 * Three kinds of problem.
 * Furnaces: closed scenes where each face has E = (1 - rho) b, rho its own: B = b everywhere,
 * whatever stands in the way.
 * Direct light: one flat face reflects and all others are black: B = E + rho sum E_j F_j(x), at
 * each point by Lambert's formula for polygons, and past an occluder less what of the lamps its
 * projection from x covers.
 * Boxes where all faces reflect: a dense collocation of our own, whose error is told by the same on
 * half as many patches a side.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "engine/error_account.h"
#include "engine/winding.h"
#include "kernel/hash.h"
#include "kernel/point_factor.h"
#include "runtime/make_solve.h"
#include "suite.h"
#include "util/array.h"

/* ---- chance */

static uint64_t state;

static double chance(double low, double high)
{
    state = hash64(state + HASH_STEP);
    return low + (high - low) * (double)(state >> 11) * 0x1p-53;
}

/* rho from 0 to .95, large ones as likely as small ones. */
static double chance_rho(void)
{
    return 0.95 * (1 - pow(chance(0, 1), 2));
}

/* ---- the true radiosity of a problem */

enum { SCENE_FACES = 64, GRID = 20 };

struct truth {
    const struct scene *scene;
    double constant;     /* furnace: b; else 0 */
    const double *patch; /* [face][n * n] of a box; NULL: direct light */
    int n;
    uint32_t occluder; /* a face that hides; UINT32_MAX: none */
};

/* Lambert's formula, written down anew: F from x, normal n, to the polygon v before its plane. */
static double lambert(const double x[3], const double n[3], const double (*v)[3], int count)
{
    double sum = 0;
    for (int i = 0; i < count; i++) {
        double a[3], b[3], c[3], at[3];
        for (int k = 0; k < 3; k++) {
            a[k] = v[i][k] - x[k];
            b[k] = v[(i + 1) % count][k] - x[k];
        }
        for (int k = 0; k < 3; k++)
            c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
        double size = sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
        double turn = atan2(size, a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
        for (int k = 0; k < 3; k++)
            at[k] = size > 0 ? c[k] / size : 0;
        sum += turn * (at[0] * n[0] + at[1] * n[1] + at[2] * n[2]);
    }
    return -sum / (2 * M_PI);
}

static double factor_to(const struct truth *t, uint32_t j, const double x[3], const double n[3])
{
    const struct face *f = &t->scene->faces[j];
    double u[3], v[3], m[3], w[3];
    sub3(u, f->vertex[1], f->vertex[0]);
    sub3(v, f->vertex[2], f->vertex[0]);
    cross3(m, u, v);
    sub3(w, x, f->vertex[0]);
    if (!(dot3(w, m) > 0))
        return 0;
    /* in these scenes no face crosses the plane of the face that reflects */
    return lambert(x, n, (const double(*)[3])f->vertex, (int)f->vertices);
}

/* What the occluder takes of it: the part of face j within its shadow from x, cut edge by edge. */
static double hidden_of(const struct truth *t, uint32_t j, const double x[3], const double n[3])
{
    const struct face *f = &t->scene->faces[j], *o = &t->scene->faces[t->occluder];
    double part[2][16][3];
    int count = (int)f->vertices, now = 0;
    memcpy(part[0], f->vertex, (size_t)count * sizeof part[0][0]);
    double centre[3] = {0, 0, 0};
    for (uint32_t i = 0; i < o->vertices; i++)
        for (int k = 0; k < 3; k++)
            centre[k] += o->vertex[i][k] / o->vertices;
    for (uint32_t i = 0; i < o->vertices && count >= 3; i++) {
        double a[3], b[3], m[3], w[3], h[16];
        sub3(a, o->vertex[i], x);
        sub3(b, o->vertex[(i + 1) % o->vertices], x);
        cross3(m, a, b);
        sub3(w, centre, x);
        double side = dot3(m, w) > 0 ? 1 : -1;
        for (int k = 0; k < count; k++) {
            sub3(w, part[now][k], x);
            h[k] = side * dot3(m, w);
        }
        count = polygon_divide(&part[now][0][0], count, 3, h, 16, &part[1 - now][0][0], NULL, NULL);
        now = 1 - now;
    }
    return count < 3 ? 0 : lambert(x, n, (const double(*)[3])part[now], count);
}

/* B at x on face i. */
static double true_radiosity(const struct truth *t, uint32_t i, const double x[3],
                             const double n[3])
{
    const struct scene *s = t->scene;
    const struct RadMaterial *m = &s->materials[s->faces[i].material];
    double light = 0;
    if (t->constant > 0)
        return t->constant;
    if (!(m->reflectance[0] > 0))
        return m->exitance[0];
    for (uint32_t j = 0; j < s->face_count; j++) {
        double e = s->materials[s->faces[j].material].exitance[0];
        if (j == i)
            continue;
        if (!t->patch) {
            if (e > 0)
                light += e
                         * (factor_to(t, j, x, n)
                            - (t->occluder < s->face_count ? hidden_of(t, j, x, n) : 0));
            continue;
        }
        const struct face *f = &s->faces[j];
        for (int a = 0; a < t->n * t->n; a++) {
            double v[4][3];
            for (int c = 0; c < 4; c++)
                for (int k = 0; k < 3; k++)
                    v[c][k] = f->vertex[0][k]
                              + (f->vertex[1][k] - f->vertex[0][k])
                                    * (a % t->n + (c == 1 || c == 2)) / t->n
                              + (f->vertex[3][k] - f->vertex[0][k]) * (a / t->n + (c >= 2)) / t->n;
            light += t->patch[(size_t)j * (size_t)(t->n * t->n) + (size_t)a]
                     * lambert(x, n, (const double(*)[3])v, 4);
        }
    }
    return m->exitance[0] + m->reflectance[0] * light;
}

/* ---- norms of the error, by points of each leaf */

static struct RadErrorNorms true_error(const struct solve *s, const struct truth *t, int side)
{
    struct norm_sums n = {0, 0, 0};
    for (uint32_t i = 0; i < s->hierarchy.count; i++) {
        const struct element *e = &s->hierarchy.elements[i];
        if (!e->vertices || e->children || !(s->operator.uncovered[i]> 0))
            continue;
        for (int a = 0; a < side; a++)
            for (int b = 0; b < side; b++) {
                double p = (a + 0.5) / side, q = (b + 0.5) / side, x[3];
                if (e->vertices == 3 && p + q > 1) {
                    p = 1 - p;
                    q = 1 - q;
                }
                for (int k = 0; k < 3; k++)
                    x[k] = e->vertices == 3
                               ? (1 - p - q) * e->vertex[0][k] + p * e->vertex[1][k]
                                     + q * e->vertex[2][k]
                               : (1 - p) * (1 - q) * e->vertex[0][k] + p * (1 - q) * e->vertex[1][k]
                                     + p * q * e->vertex[2][k] + (1 - p) * q * e->vertex[3][k];
                norm_add(&n, e->area * s->operator.uncovered[i] /(side * side),
                         s->state.radiosity[i] - true_radiosity(t, e->face, x, e->normal));
            }
    }
    return norms_of(&n);
}

/* ---- what all problems came to */

enum { PROBLEMS = 1024, NORMS = 3 };
static const char *const norm_names[NORMS] = {"L1", "L2", "Linf"};

struct results {
    double over[NORMS][PROBLEMS], near[NORMS][PROBLEMS]; /* bound, estimate over true error */
    int count, below;
};

static void tell(const char *kind, struct results *r)
{
    printf("%s: %d problems, %d bounds below the error;", kind, r->count, r->below);
    for (int k = 0; k < NORMS && r->count; k++) {
        qsort(r->over[k], (size_t)r->count, sizeof(double), compare_numbers);
        qsort(r->near[k], (size_t)r->count, sizeof(double), compare_numbers);
        printf(" %s bound/error median %.3g, worst %.3g, estimate/error %.2g to %.2g, median %.2g;",
               norm_names[k], r->over[k][r->count / 2], r->over[k][r->count - 1], r->near[k][0],
               r->near[k][r->count - 1], r->near[k][r->count / 2]);
    }
    printf("\n");
    ck_assert_int_eq(r->below, 0);
    /* an estimate is good to a factor of three, in the median: of one or two there is none */
    for (int k = 0; k < NORMS && r->count >= 5; k++) {
        ck_assert_double_gt(r->near[k][r->count / 2], 1 / 3.0);
        ck_assert_double_lt(r->near[k][r->count / 2], 3);
    }
}

static void make_account(struct solve *s, const struct RadAccountOptions *o,
                         struct RadAccountReport *report)
{
    static const struct RadAccountOptions defaults;
    struct error_account a = {.solve = s, .options = o ? o : &defaults, .report = report};
    ck_assert_int_eq(error_account_make(&a), 0);
    ck_assert_int_eq(report->bounded, 1);
}

static const struct {
    const char *oracle, *settings[3];
} oracles[] = {{"ff", {"limit=0.1", "min_share=1e-3"}},
               {"gap", {"relative=0.1", "min_share=1e-3"}},
               {"bf_guarded", {"relative=0.1", "min_share=1e-3"}},
               {"relative", {"exitance=0.01", "min_share=1e-3"}},
               {"bf_guarded", {"shadow=0.02", "min_share=1e-3"}},
               {"bf", {"relative=0.2"}},
               {"clusters", {"min_share=4e-4"}},
               {"feature", {"min_share=2e-3"}},
               {"gibson_hubbold", {"relative=0.3", "min_share=1e-3"}}};
enum { ORACLES = sizeof oracles / sizeof *oracles };

/* Solve, account, compare; `doubt`: what the truth may be off by itself, in the largest modulus. */
static void judge(struct results *r, const struct scene *scene, const struct truth *truth, int with,
                  double tolerance, double doubt)
{
    struct solve s;
    struct solve_options options = {.tolerance = tolerance, .iterations = 100000, .threads = 1};
    struct RadAccountReport report;
    solve_with(&s, scene, oracles[with].oracle, RELEASE_FLAT,
               (char *const *)(uintptr_t)oracles[with].settings, options);
    make_account(&s, NULL, &report);
    double area = 0;
    for (uint32_t i = 0; i < s.hierarchy.face_count; i++)
        area += hierarchy_surface(&s.hierarchy, i)->area;
    struct RadErrorNorms e = true_error(&s, truth, s.hierarchy.count < 2000 ? 6 : 3),
                         b = report.bound[RAD_CATEGORY_TOGETHER],
                         about = report.estimate[RAD_CATEGORY_TOGETHER];
    const double error[NORMS] = {e.l1 - doubt * area, e.l2 - doubt * sqrt(area), e.linf - doubt},
                 bound[NORMS] = {b.l1, b.l2, b.linf},
                 near[NORMS] = {about.l1, about.l2, about.linf};
    for (int k = 0; k < NORMS; k++) {
        ck_assert_double_le(near[k], bound[k]); /* what cannot be is not likely */
        if (!(bound[k] >= error[k])) {
            printf("%s %s: %u faces, %u elements: true %.17g, bound %.17g\n", oracles[with].oracle,
                   norm_names[k], scene->face_count, s.hierarchy.count, error[k], bound[k]);
            r->below++;
        }
        r->over[k][r->count] = error[k] > 0 ? bound[k] / error[k] : 1;
        r->near[k][r->count] = error[k] > 0 ? near[k] / error[k] : 1;
    }
    if (getenv("VERBOSE"))
        printf(
            "  %-14s %4u faces %5u elements %7llu ranges, visible %.2f closed %.2f: true %.3g %.3g "
            "%.3g bound %.3g %.3g %.3g estimate %.3g %.3g %.3g\n",
            oracles[with].oracle, scene->face_count, s.hierarchy.count,
            (unsigned long long)report.ranges, report.visible, report.closed, e.l1, e.l2, e.linf,
            b.l1, b.l2, b.linf, about.l1, about.l2, about.linf);
    r->count++;
    solve_close(&s);
}

/* ---- furnaces */

/* rho by chance and E to it, for all faces anew. */
static void heat(struct scene *s, double b)
{
    uint32_t kinds = s->material_count = 0;
    for (; kinds < 6; kinds++) {
        double rho = chance_rho();
        made_material(s, rho, (1 - rho) * b);
    }
    for (uint32_t i = 0; i < s->face_count; i++) {
        s->faces[i].material = (uint32_t)chance(0, 6) % kinds;
        s->faces[i].black = 0;
    }
}

static void make_furnace(struct scene *s, int kind)
{
    switch (kind % 4) {
    case 0:
        furnace_cube(s, 0.5);
        break;
    case 1:
        furnace_prism(s, 0.5);
        break;
    case 2:
        furnace_octahedron(s, 0.5);
        break;
    default:
        furnished(s, 1);
        break;
    }
    for (uint32_t i = 0; i < s->face_count; i++) /* stretched */
        for (uint32_t j = 0; j < s->faces[i].vertices; j++)
            s->faces[i].vertex[j][kind % 3] *= 1 + kind % 5;
    heat(s, 3);
}

START_TEST(test_furnaces)
{
    struct results r = {.count = 0};
    state = 1;
    for (int i = 0; i < (thorough() ? 72 : 2); i++) {
        struct scene scene;
        make_furnace(&scene, i);
        const struct truth truth = {.scene = &scene, .constant = 3};
        judge(&r, &scene, &truth, i % ORACLES, pow(10, -2 - i % 4), 0);
        made_close(&scene);
    }
    tell("furnaces", &r);
}
END_TEST

/* ---- direct light */

/* A box whose floor alone reflects, the others lamps of their own. */
static void make_lit_floor(struct scene *s)
{
    uint32_t m[6];
    made_open(s);
    m[0] = made_material(s, chance(0.1, 0.95), chance(0, 1) < 0.3 ? 0.2 : 0);
    for (int i = 1; i < 6; i++)
        m[i] = made_material(s, 0, chance(0, 1) < 0.4 ? 0 : chance(0, 2));
    m[1] = made_material(s, 0, 1);
    made_room(s, m, chance(0.5, 3), chance(0.5, 3), chance(0.3, 2));
}

/* A lamp above a floor, and an opaque plate between when asked for. Returns the plate's number. */
static uint32_t make_plates(struct scene *s, int plate)
{
    double side = chance(0.3, 1.5), height = chance(0.3, 2), x = chance(0, 1), y = chance(0, 1);
    made_open(s);
    uint32_t floor = made_material(s, chance(0.1, 0.95), 0), lamp = made_material(s, 0, 1),
             black = made_material(s, 0, 0);
    made_quad(s, floor, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    made_quad(s, lamp, x, y, height, 0, side, 0, side, 0, 0);
    if (plate) {
        double at = height * chance(0.2, 0.8), size = chance(0.1, 0.6);
        made_quad(s, black, chance(0, 1), chance(0, 1), at, 0, size, 0, size, 0, 0);
    }
    return plate ? 2 : UINT32_MAX;
}

START_TEST(test_direct_light)
{
    struct results r = {.count = 0};
    state = 2;
    for (int i = 0; i < (thorough() ? 90 : 6); i++) {
        struct scene scene;
        uint32_t plate = UINT32_MAX;
        if (i % 3 == 0)
            make_lit_floor(&scene);
        else
            plate = make_plates(&scene, i % 3 == 1);
        const struct truth truth = {.scene = &scene, .occluder = plate};
        judge(&r, &scene, &truth, i % ORACLES, 1e-4, 0);
        made_close(&scene);
    }
    tell("direct light", &r);
}
END_TEST

/* ---- boxes */

/* Collocation at the centres of n x n patches a face; B into patch[6][n * n]. */
static void collocate(const struct scene *s, int n, double *patch)
{
    int count = 6 * n * n;
    float *f = malloc((size_t)count * (size_t)count * sizeof *f);
    ck_assert_ptr_nonnull(f);
    for (int i = 0; i < count; i++) {
        const struct face *r = &s->faces[i / (n * n)];
        int at = i % (n * n);
        double x[3], u[3], v[3], m[3];
        sub3(u, r->vertex[1], r->vertex[0]);
        sub3(v, r->vertex[3], r->vertex[0]);
        cross3(m, u, v);
        double size = length3(m);
        for (int k = 0; k < 3; k++) {
            x[k] = r->vertex[0][k] + u[k] * (at % n + 0.5) / n + v[k] * (at / n + 0.5) / n;
            m[k] /= size;
        }
        for (int j = 0; j < count; j++) {
            const struct face *e = &s->faces[j / (n * n)];
            int to = j % (n * n);
            double q[4][3];
            for (int c = 0; c < 4; c++)
                for (int k = 0; k < 3; k++)
                    q[c][k] =
                        e->vertex[0][k]
                        + (e->vertex[1][k] - e->vertex[0][k]) * (to % n + (c == 1 || c == 2)) / n
                        + (e->vertex[3][k] - e->vertex[0][k]) * (to / n + (c >= 2)) / n;
            f[(size_t)i * (size_t)count + (size_t)j] =
                e == r ? 0 : (float)lambert(x, m, (const double(*)[3])q, 4);
        }
        patch[i] = s->materials[r->material].exitance[0];
    }
    for (double most = 1; most > 1e-7;) {
        most = 0;
        for (int i = 0; i < count; i++) {
            const struct RadMaterial *m = &s->materials[s->faces[i / (n * n)].material];
            double light = 0;
            for (int j = 0; j < count; j++)
                light += (double)f[(size_t)i * (size_t)count + (size_t)j] * patch[j];
            double next = m->exitance[0] + m->reflectance[0] * light;
            most = fmax(most, fabs(next - patch[i]));
            patch[i] = next;
        }
    }
    free(f);
}

START_TEST(test_boxes)
{
    struct results r = {.count = 0};
    enum { FINE = 12 };
    static double fine[6 * FINE * FINE], half[6 * FINE * FINE / 4];
    int n = thorough() ? FINE : FINE / 2;
    double worst = 0;
    state = 3;
    for (int i = 0; i < (thorough() ? 45 : 1); i++) {
        struct scene scene;
        uint32_t m[6];
        made_open(&scene);
        for (int k = 0; k < 6; k++)
            m[k] = made_material(&scene, chance_rho(), chance(0, 1) < 0.6 ? 0 : chance(0, 2));
        scene.materials[m[1]].exitance[0] = 1;
        made_room(&scene, m, chance(0.5, 2), chance(0.5, 2), chance(0.5, 2));
        collocate(&scene, n, fine);
        collocate(&scene, n / 2, half);
        const struct truth truth = {.scene = &scene, .patch = fine, .n = n},
                           rough = {.scene = &scene, .patch = half, .n = n / 2};
        double doubt = 0; /* second order: a third of the difference is left */
        for (uint32_t k = 0; k < 6; k++)
            for (int at = 0; at < 49; at++) {
                const struct face *f = &scene.faces[k];
                double x[3], u[3], v[3], normal[3];
                sub3(u, f->vertex[1], f->vertex[0]);
                sub3(v, f->vertex[3], f->vertex[0]);
                cross3(normal, u, v);
                double size = length3(normal);
                for (int c = 0; c < 3; c++) {
                    x[c] = f->vertex[0][c] + u[c] * (at % 7 + 0.5) / 7 + v[c] * (at / 7 + 0.5) / 7;
                    normal[c] /= size;
                }
                doubt = fmax(doubt, fabs(true_radiosity(&truth, k, x, normal)
                                         - true_radiosity(&rough, k, x, normal)));
            }
        worst = fmax(worst, doubt / 3);
        judge(&r, &scene, &truth, i % ORACLES, 1e-4, doubt / 3);
        made_close(&scene);
    }
    printf("the boxes' truth is good to %.1e W/m2\n", worst);
    tell("boxes", &r);
}
END_TEST

/* ---- boundary data */

/* Means of B over faces. */
static void face_means(const struct scene *scene, double *b)
{
    static const char *const settings[] = {"relative=0.2", "min_share=2e-3", NULL};
    struct solve s;
    solve_with(&s, scene, "bf_guarded", RELEASE_FLAT, (char *const *)(uintptr_t)settings, quick(1));
    for (uint32_t i = 0; i < scene->face_count; i++)
        b[i] = face_radiosity(&s, i);
    solve_close(&s);
}

START_TEST(test_perturbed)
{
    double worst = 0;
    state = 4;
    for (int i = 0; i < (thorough() ? 20 : 1); i++) {
        struct scene scene;
        struct solve s;
        struct RadAccountReport report;
        uint32_t m[6];
        double before[6], after[6];
        const struct RadAccountOptions o = {chance(0, 0.04), chance(0, 0.2), 0};
        made_open(&scene);
        for (int k = 0; k < 6; k++)
            m[k] = made_material(&scene, fmin(chance_rho(), 0.9), chance(0, 1));
        made_room(&scene, m, 1, chance(0.5, 2), chance(0.5, 2));
        face_means(&scene, before);
        static const char *const settings[] = {"relative=0.2", "min_share=2e-3", NULL};
        solve_with(&s, &scene, "bf_guarded", RELEASE_FLAT, (char *const *)(uintptr_t)settings,
                   quick(1));
        make_account(&s, &o, &report);
        const struct RadErrorNorms bound = report.bound[RAD_CATEGORY_BOUNDARY],
                                   about = report.estimate[RAD_CATEGORY_BOUNDARY];
        ck_assert(bound.l1 >= about.l1 && bound.linf >= about.linf);
        struct RadMaterial given[6];
        memcpy(given, scene.materials, sizeof given);
        for (int n = 0; n < 6; n++) {
            double moved = 0, most = 0;
            for (int k = 0; k < 6; k++) {
                double up = n == 0   ? 1
                            : n == 1 ? -1
                                     : chance(-1, 1),
                       on = n < 2 ? up : chance(-1, 1);
                scene.materials[k].reflectance[0] =
                    fmax(given[k].reflectance[0] + up * o.reflectance_error, 0);
                scene.materials[k].exitance[0] = given[k].exitance[0] * (1 + on * o.exitance_error);
            }
            face_means(&scene, after);
            for (uint32_t k = 0; k < 6; k++) {
                double area = hierarchy_surface(&s.hierarchy, k)->area;
                moved += area * fabs(after[k] - before[k]);
                most = fmax(most, fabs(after[k] - before[k]));
            }
            ck_assert_double_le(moved, bound.l1);
            ck_assert_double_le(most, bound.linf);
            worst = fmax(worst, moved / bound.l1);
            if (n == 0) /* the estimate is of first order */
                ck_assert_double_le(fabs(moved / about.l1 - 1), 0.5);
        }
        solve_close(&s);
        made_close(&scene);
    }
    printf("perturbed: the solution moved by up to %.2g of the bound\n", worst);
    ck_assert_double_gt(worst, 0.3);
}
END_TEST

/* What each link of a furnace is off by the others make good, and that is proved: no more than what
 * is proved is told as likely. */
START_TEST(test_likely_is_possible)
{
    struct scene scene;
    struct solve s;
    struct RadAccountReport report;
    furnace_cube(&scene, 0.5);
    solve_with(&s, &scene, "power", RELEASE_FLAT, NULL, quick(1));
    make_account(&s, NULL, &report);
    const struct RadErrorNorms *most = &report.bound[RAD_CATEGORY_TOGETHER],
                               *likely = &report.estimate[RAD_CATEGORY_TOGETHER];
    ck_assert_double_le(likely->l1, most->l1);
    ck_assert_double_le(likely->l2, most->l2);
    ck_assert_double_le(likely->linf, most->linf);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* rho that may reach 1 has no bound, and is told to have none. */
START_TEST(test_no_bound)
{
    struct scene scene;
    struct solve s;
    struct RadAccountReport report;
    const struct RadAccountOptions o = {0.1, 0, 0};
    static const char *const settings[] = {"relative=1", "min_share=2e-3", NULL};
    furnace_cube(&scene, 0.95);
    solve_with(&s, &scene, "bf", RELEASE_FLAT, (char *const *)(uintptr_t)settings, quick(1));
    make_account(&s, &o, &report);
    ck_assert(isinf(report.bound[RAD_CATEGORY_BOUNDARY].l1));
    ck_assert(isinf(report.bound[RAD_CATEGORY_TOGETHER].linf));
    ck_assert(isfinite(report.bound[RAD_CATEGORY_DISCRETIZATION].l1));
    ck_assert_double_eq_tol(report.kappa_inf, 0.95, 0.01);
    ck_assert_double_eq_tol(report.inverse_found, 20, 1);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* ---- ranges */

/* Shares cover what is before a leaf once, and F at any point of it is within them. */
START_TEST(test_ranges)
{
    state = 5;
    for (int kind = 0; kind < (thorough() ? 3 : 1); kind++)
        for (int with = 0; with < ORACLES; with += thorough() ? 3 : 6) {
            struct scene scene;
            struct solve s;
            struct light_ranges r;
            make_furnace(&scene, kind);
            solve_with(&s, &scene, oracles[with].oracle, RELEASE_FLAT,
                       (char *const *)(uintptr_t)oracles[with].settings, quick(1));
            double *most = calloc(2 * (size_t)s.hierarchy.count, sizeof *most);
            ck_assert_ptr_nonnull(most);
            for (uint32_t i = 0; i < 2 * s.hierarchy.count; i++)
                most[i] = 0.5;
            ck_assert_int_eq(
                light_ranges_open(&r, &s.operator, most, most + s.hierarchy.count, NULL, NULL), 0);
            for (uint32_t i = 0; i < s.hierarchy.count; i += 7) {
                const struct element *e = &s.hierarchy.elements[i];
                const struct share_row *row = &r.rows[i];
                double x[3] = {0, 0, 0}, all = 0, sum = 0, weight[4];
                if (!e->vertices || e->children)
                    continue;
                for (int k = 0; k < e->vertices; k++)
                    all += weight[k] = chance(0.001, 1);
                for (int k = 0; k < e->vertices; k++)
                    for (int c = 0; c < 3; c++)
                        x[c] += weight[k] / all * e->vertex[k][c];
                for (uint32_t k = 0; k < row->share_count; k++) {
                    const struct element *from = &s.hierarchy.elements[row->shares[k].emitter];
                    struct polygon q;
                    if (!from->vertices)
                        continue;
                    point_factor_clip(&q, e, from);
                    double f = point_factor_at(x, e, from, &q);
                    ck_assert_double_ge(f, (double)row->shares[k].low);
                    ck_assert_double_le(f, (double)row->shares[k].high);
                    sum += f;
                }
                ck_assert_double_eq_tol(sum, 1, 1e-9);
                ck_assert_int_eq(r.closed[i], 1);
            }
            light_ranges_close(&r);
            free(most);
            solve_close(&s);
            made_close(&scene);
        }
}
END_TEST

/* A cube without a wall is open, and one within which another lies inside out has backs. */
START_TEST(test_open)
{
    for (int kind = 0; kind < 2; kind++) {
        struct scene scene;
        struct solve s;
        unsigned char closed[64];
        furnace_cube(&scene, 0.5);
        if (kind == 0)
            scene.face_count--;
        else
            for (uint32_t i = 0; i < 6; i++) { /* its walls look in, not out */
                double v[4][3];
                memcpy(v, scene.faces[i].vertex, sizeof v);
                for (int j = 0; j < 4; j++)
                    for (int k = 0; k < 3; k++)
                        v[j][k] = 0.4 + 0.2 * v[j][k];
                made_face(&scene, scene.faces[i].material, 4, (const double(*)[3])v);
            }
        static const char *const whole[] = {"relative=100", NULL};
        solve_with(&s, &scene, "bf", RELEASE_FLAT, (char *const *)(uintptr_t)whole, quick(1));
        ck_assert_uint_le(s.hierarchy.count, sizeof closed);
        memset(closed, 1, sizeof closed);
        winding_closed(&s.hierarchy, s.operator.uncovered, 1, closed);
        for (uint32_t i = 0; i < s.hierarchy.count; i++)
            ck_assert_int_eq(closed[i], 0);
        solve_close(&s);
        made_close(&scene);
    }
}
END_TEST

/* ---- by the library */

/* A room in three bands. */
static RadScene api_room(RadDevice device)
{
    static const double positions[24] = {0, 0, 0, 4, 0, 0, 4, 5, 0, 0, 5, 0,
                                         0, 0, 3, 4, 0, 3, 4, 5, 3, 0, 5, 3};
    static const uint32_t indices[24] = {0, 1, 2, 3, 4, 7, 6, 5, 0, 4, 5, 1,
                                         1, 5, 6, 2, 2, 6, 7, 3, 3, 7, 4, 0},
                          kinds[6] = {0, 1, 2, 2, 2, 2};
    static const struct RadMaterial materials[3] = {{{0.3, 0.2, 0.1}, {0, 0, 0}, 0},
                                                    {{0.8, 0.8, 0.8}, {10, 9, 5}, 0},
                                                    {{0.6, 0.5, 0.7}, {0, 0, 0}, 0}};
    static const struct RadPolygons polygons = {.positions = positions,
                                                .position_count = 8,
                                                .indices = indices,
                                                .size = 4,
                                                .materials = kinds,
                                                .count = 6};
    RadScene scene = radNewScene(device);
    ck_assert_int_eq(radSetSceneMaterials(scene, materials, 3), 0);
    ck_assert_int_eq(radSetSceneSharedPolygons(scene, &polygons), 0);
    ck_assert_int_eq(radCommitScene(scene), 0);
    return scene;
}

/* What it costs to ask too early or wrongly; and the same bits for any number of threads, asked
 * once or twice. */
START_TEST(test_library)
{
    struct RadAccountReport report[2];
    for (int threads = 1; threads <= 3; threads += 2) {
        const struct RadDeviceOptions options = {.threads = threads};
        RadDevice device = radNewDevice(&options);
        RadScene scene = api_room(device);
        RadOracle oracle = radNewOracle(device, "bf_guarded", RAD_RELEASE_FLAT);
        ck_assert_int_eq(radSetOracleParameter(oracle, "relative", 0.3), 0);
        ck_assert_int_eq(radSetOracleParameter(oracle, "min_share", 2e-3), 0);
        RadSolution solution = radNewSolution(scene, oracle, NULL);
        const struct RadAccountOptions wrong[] = {{-0.1, 0, 0}, {1, 0, 0}, {NAN, 0, 0}, {0, -1, 0}},
                                       right = {0.01, 0.02, 0};
        ck_assert_int_eq(radAccountErrors(solution, NULL, &report[0]), -1);
        ck_assert_int_eq(radGetDeviceError(device), RAD_ERROR_INVALID_OPERATION);
        ck_assert_int_eq(radSolve(solution), 0);
        for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
            ck_assert_int_eq(radAccountErrors(solution, &wrong[i], &report[0]), -1);
            ck_assert_int_eq(radGetDeviceError(device), RAD_ERROR_INVALID_ARGUMENT);
        }
        ck_assert_int_eq(radAccountErrors(solution, &right, &report[threads > 1]), 0);
        struct RadAccountReport again;
        ck_assert_int_eq(radAccountErrors(solution, &right, &again), 0);
        again.seconds = report[threads > 1].seconds;
        ck_assert_mem_eq(&again, &report[threads > 1], sizeof again);
        radReleaseSolution(solution);
        radReleaseOracle(oracle);
        radReleaseScene(scene);
        radReleaseDevice(device);
    }
    report[0].seconds = report[1].seconds;
    ck_assert_mem_eq(&report[0], &report[1], sizeof *report);
    ck_assert_int_eq(report[0].bounded, 1);
    for (int c = 0; c < RAD_CATEGORIES; c++) {
        ck_assert_double_ge(report[0].bound[c].l1, report[0].estimate[c].l1 * (c != 1 && c != 3));
        ck_assert_double_le(report[0].bound[c].l2, 10 * report[0].bound[c].l1);
    }
    ck_assert_double_le(report[0].kappa_inf, 0.81);
    ck_assert_double_le(report[0].inverse_found, report[0].inverse_bound);
}
END_TEST

/* With slopes the account is that of the same links without, and the solution stays what it was. */
START_TEST(test_slopes)
{
    static const struct RadAccountOptions estimates = {0.01, 0.02, 1};
    char *settings[] = {"relative=0.3", "min_share=2e-3", NULL};
    struct RadAccountReport report[2];
    for (int linear = 0; linear < 2; linear++) {
        struct scene scene;
        struct solve s;
        struct solve_options how = quick(1);
        how.linear = linear;
        furnished(&scene, 1);
        solve_with(&s, &scene, "bf", RELEASE_FLAT, settings, how);
        size_t count = s.hierarchy.count, size = count * sizeof(double);
        double *before[3] = {malloc(size), malloc(size), malloc(size)};
        const double *after[3] = {s.state.radiosity, s.state.irradiance, s.operator.row_scale };
        for (int i = 0; i < 3; i++)
            memcpy(before[i], after[i], size);
        struct error_account a = {.solve = &s, .options = &estimates, .report = &report[linear]};
        ck_assert_int_eq(error_account_make(&a), 0);
        ck_assert_int_eq(report[linear].without_slopes, linear);
        ck_assert_ptr_eq(s.state.radiosity, after[0]);
        for (int i = 0; i < 3; i++) {
            ck_assert_mem_eq(before[i], after[i], size);
            free(before[i]);
        }
        solve_close(&s);
        made_close(&scene);
    }
    for (int c = 0; c < RAD_CATEGORIES; c++) {
        const struct RadErrorNorms *x = &report[0].estimate[c], *y = &report[1].estimate[c];
        double all = report[0].estimate[RAD_CATEGORY_TOGETHER].l1;
        ck_assert_double_eq_tol(x->l1, y->l1, 1e-3 * all);
        ck_assert_double_eq_tol(x->l2, y->l2, 1e-3 * all);
    }
    ck_assert_double_eq_tol(report[0].kappa_inf, report[1].kappa_inf, 1e-12);
}
END_TEST

/* What iteration leaves is told by the links as they are solved over, by either projection: of an
 * error e in the solution (1 - K) e, at most twice that, as K takes no more than it is given. */
START_TEST(test_solver_share)
{
    char *settings[] = {"relative=0.3", "min_share=2e-3", NULL};
    struct scene scene;
    struct solve s;
    struct RadAccountReport report;
    struct solve_options how = quick(1);
    how.projection = (enum RadProjection)_i;
    furnished(&scene, 1);
    solve_with(&s, &scene, "bf", RELEASE_FLAT, settings, how);
    make_account(&s, NULL, &report);
    double power = 0;
    for (uint32_t i = 0; i < s.hierarchy.face_count; i++) {
        uint32_t e = s.hierarchy.face_element[i];
        power += s.hierarchy.elements[e].area * s.state.radiosity[e];
    }
    ck_assert_double_le(report.estimate[RAD_CATEGORY_SOLVER].l1, 2 * how.tolerance * power);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("error_account");
    TCase *answers = tcase_create("known answers");
    tcase_set_timeout(answers, 1800);
    tcase_add_test(answers, test_furnaces);
    tcase_add_test(answers, test_direct_light);
    tcase_add_test(answers, test_boxes);
    tcase_add_test(answers, test_perturbed);
    tcase_add_test(answers, test_no_bound);
    tcase_add_test(answers, test_likely_is_possible);
    suite_add_tcase(suite, answers);
    TCase *parts = tcase_create("parts");
    tcase_set_timeout(parts, 300);
    tcase_add_test(parts, test_ranges);
    tcase_add_test(parts, test_open);
    tcase_add_test(parts, test_library);
    tcase_add_test(parts, test_slopes);
    tcase_add_loop_test(parts, test_solver_share, 0, 2);
    suite_add_tcase(suite, parts);
    return suite_failures(suite) != 0;
}
