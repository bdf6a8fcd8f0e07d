/* check_linear.c - functions linear over elements: bases, couplings and solutions against closed
 * forms, published values and sums over many points.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "engine/linear_coupling.h"
#include "engine/linear_solution.h"
#include "engine/linear_transport.h"
#include "kernel/polygon_factor.h"
#include "kernel/surface.h"
#include "runtime/make_solve.h"
#include "suite.h"

static void make(struct element *e, int corners, const double (*v)[3])
{
    memset(e, 0, sizeof *e);
    e->vertices = (uint8_t)corners;
    memcpy(e->vertex, v, (size_t)corners * sizeof *v);
    surface_measure(e);
}

/* ---- bases */

enum { SHAPES = 4 };

/* In a plane that is turned, far from the origin. */
static void make_shape(struct element *e, int shape)
{
    static const double flat[SHAPES][4][2] = {{{0, 0}, {2, 0}, {2, 2}, {0, 2}},
                                              {{0, 0}, {3, 1}, {3.5, 2}, {0.5, 1}},
                                              {{0, 0}, {1, 0}, {0.7, 0.8}, {0.1, 1}},
                                              {{0, 0}, {2, 0.3}, {0.4, 1.5}, {0, 0}}};
    static const double x[3] = {2 / 3.0, 1 / 3.0, 2 / 3.0}, y[3] = {-2 / 3.0, 2 / 3.0, 1 / 3.0};
    double v[4][3];
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 3; k++)
            v[i][k] = 5 + k + flat[shape][i][0] * x[k] + flat[shape][i][1] * y[k];
    make(e, shape == 3 ? 3 : 4, (const double(*)[3])v);
}

/* The parts of e after so many quarterings, one after the other. */
static void quarter(const struct element *e, int depth, struct element **to)
{
    if (depth == 0) {
        *(*to)++ = *e;
        return;
    }
    for (int i = 0; i < 4; i++) {
        struct element part;
        surface_quarter(e, i, &part);
        quarter(&part, depth - 1, to);
    }
}

/* Means over 4^6 parts: of phi_a 0, of phi_a phi_b 1 or 0. */
START_TEST(test_basis)
{
    enum { DEPTH = 6 };
    struct element e, *parts = malloc(sizeof *parts << (2 * DEPTH)), *end = parts;
    struct linear_basis basis;
    double mean[5] = {0};
    make_shape(&e, _i);
    linear_basis_of(&basis, &e);
    quarter(&e, DEPTH, &end);
    for (const struct element *p = parts; p < end; p++) {
        double phi[2], share = p->area / e.area;
        linear_basis_at(&basis, e.centre, p->centre, phi);
        const double product[5] = {phi[0], phi[1], phi[0] * phi[0], phi[0] * phi[1],
                                   phi[1] * phi[1]};
        for (int k = 0; k < 5; k++)
            mean[k] += share * product[k];
    }
    static const double known[5] = {0, 0, 1, 0, 1};
    for (int k = 0; k < 5; k++)
        ck_assert_double_eq_tol(mean[k], known[k], k < 2 ? 1e-12 : 5e-4);
    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++)
            ck_assert_double_eq_tol(dot3(basis.g[a], basis.d[b]), a == b, 1e-12);
    free(parts);
}
END_TEST

/* A linear function is the same on the parts, and projected from them it is itself. */
START_TEST(test_two_scale)
{
    static const double b[3] = {0.25, 1, -0.75};
    struct element e[5];
    struct linear_basis basis[5];
    struct hierarchy h = {.elements = e};
    struct linear_links links = {.basis = basis};
    double back[3] = {0, 0, 0};
    make_shape(&e[0], _i);
    linear_basis_of(&basis[0], &e[0]);
    for (uint32_t i = 1; i < 5; i++) {
        struct two_scale t;
        double on_part[3], share;
        surface_quarter(&e[0], (int)i - 1, &e[i]);
        linear_basis_of(&basis[i], &e[i]);
        linear_links_restrict(&links, &h, 0, i, b, on_part);
        for (int j = 0; j < e[i].vertices; j++) {
            double phi[2], small[2];
            linear_basis_at(&basis[0], e[0].centre, e[i].vertex[j], phi);
            linear_basis_at(&basis[i], e[i].centre, e[i].vertex[j], small);
            ck_assert_double_eq_tol(on_part[0] + on_part[1] * small[0] + on_part[2] * small[1],
                                    b[0] + b[1] * phi[0] + b[2] * phi[1], 1e-12);
        }
        linear_two_scale(&t, &basis[0], &e[0], &basis[i], &e[i]);
        share = e[i].area / e[0].area;
        back[0] += share * on_part[0];
        for (int a = 0; a < 2; a++)
            back[a + 1] +=
                share
                * (on_part[0] * t.mean[a] + on_part[1] * t.from[a][0] + on_part[2] * t.from[a][1]);
    }
    for (int a = 0; a < 3; a++)
        ck_assert_double_eq_tol(back[a], b[a], 1e-12);
}
END_TEST

/* ---- couplings */

struct pair_case {
    const char *name;
    int touching; /* sums over points converge with the first power of their distance, else second
                   */
    int corners[2];
    double v[2][4][3];
};

#define SQUARE \
    { \
        {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, \
        { \
            0, 1, 0 \
        } \
    }
static const struct pair_case cases[] = {
    {"perpendicular, one edge", 1, {4, 4}, {SQUARE, {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}}},
    {"straddling", 1, {4, 4}, {SQUARE, {{0, 0, -1}, {0, 1, -1}, {0, 1, 1}, {0, 0, 1}}}},
    {"one corner", 1, {4, 4}, {SQUARE, {{0, 1, 0}, {0, 2, 0}, {0, 2, 1}, {0, 1, 1}}}},
    {"five corners in front",
     1,
     {4, 4},
     {SQUARE, {{0, 0.2, -0.3}, {0, 1, 0.2}, {0, 0.8, 0.9}, {0, -0.4, 0.6}}}},
    {"triangles, one edge",
     1,
     {3, 3},
     {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}}}},
    {"parallel", 0, {4, 4}, {SQUARE, {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}}},
    {"far", 0, {4, 4}, {SQUARE, {{2, 0, 5}, {2, 1, 5}, {3, 1, 5}, {3, 0, 5}}}},
    {"unequal", 0, {4, 4}, {SQUARE, {{-2, -2, 1}, {-2, 3, 1}, {3, 3, 1}, {3, -2, 1}}}},
    {"triangles",
     0,
     {3, 3},
     {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0.2, 0, 1}, {0, 1, 1.2}, {1, 0.5, 1.1}}}},
    {"quads",
     0,
     {4, 4},
     {{{0, 0, 0}, {1, 0, 0}, {0.7, 0.8, 0}, {0.1, 1, 0}},
      {{0, 0, 0.7}, {0.1, 1.3, 0.7}, {0.9, 0.8, 0.7}, {1, 0, 0.7}}}},
    {"a strip, one edge", 1, {4, 4}, {SQUARE, {{0, -1, 0}, {0, 7, 0}, {0, 7, 0.5}, {0, -1, 0.5}}}},
    {"a strip", 0, {4, 4}, {SQUARE, {{0, -1, 1}, {0, 7, 1}, {0.5, 7, 1}, {0.5, -1, 1}}}},
    {"a needle", 0, {4, 3}, {SQUARE, {{0.2, -1, 1}, {0.5, 4, 1}, {0.8, -1, 1}}}},
    {"a needle, its base behind", 0, {4, 3}, {SQUARE, {{0.5, 4, 1}, {0.8, -1, 1}, {0.2, -1, 1}}}},
};
enum { CASES = sizeof cases / sizeof *cases };

struct pair_of {
    struct element e[2];
    struct linear_basis basis[2];
    struct linear_side r, s;
};

static void make_pair(struct pair_of *p, const struct pair_case *c)
{
    for (int i = 0; i < 2; i++) {
        make(&p->e[i], c->corners[i], c->v[i]);
        linear_basis_of(&p->basis[i], &p->e[i]);
    }
    p->r = (struct linear_side){&p->e[0], &p->basis[0]};
    p->s = (struct linear_side){&p->e[1], &p->basis[1]};
}

/* All points with all points: the middles of 4^depth parts each, the kernel written out. */
static void sum_points(double c[3][3], const struct pair_of *p, int depth)
{
    struct element *parts[2], *end[2];
    memset(c, 0, 9 * sizeof(double));
    for (int i = 0; i < 2; i++) {
        end[i] = parts[i] = malloc(sizeof **parts << (2 * depth));
        quarter(&p->e[i], depth, &end[i]);
    }
    for (const struct element *x = parts[0]; x < end[0]; x++) {
        double phi[3] = {1, 0, 0}, sum[3] = {0, 0, 0};
        linear_basis_at(&p->basis[0], p->e[0].centre, x->centre, phi + 1);
        for (const struct element *y = parts[1]; y < end[1]; y++) {
            double w[3], psi[3] = {1, 0, 0};
            sub3(w, y->centre, x->centre);
            double in = dot3(w, p->e[0].normal), out = -dot3(w, p->e[1].normal),
                   square = dot3(w, w);
            if (!(in > 0 && out > 0))
                continue;
            linear_basis_at(&p->basis[1], p->e[1].centre, y->centre, psi + 1);
            for (int b = 0; b < 3; b++)
                sum[b] += y->area * in * out / (M_PI * square * square) * psi[b];
        }
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                c[a][b] += x->area / p->e[0].area * phi[a] * sum[b];
    }
    free(parts[0]);
    free(parts[1]);
}

/* Couplings against sums over 1,024 points and over a quarter as many on each side, extrapolated.
 * Shares of F: what linear_coupling.h promises. */
START_TEST(test_coupling)
{
    const struct pair_case *pair = &cases[_i];
    struct pair_of p;
    double c[3][3], fine[3][3], coarse[3][3], off[3] = {0, 0, 0};
    int depth = pair->touching ? 5 : 4;
    make_pair(&p, pair);
    linear_coupling_integrate(c, p.r, p.s);
    (void)linear_coupling_at(1, fine, p.r, p.s); /* the same bits in vectors of any width */
    ck_assert_mem_eq(fine, c, sizeof c);
    sum_points(fine, &p, depth);
    sum_points(coarse, &p, depth - 1);
    double factor = polygon_factor(&p.e[0], &p.e[1], 1), more = pair->touching ? 1 : 1 / 3.0;
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            double known = fine[a][b] + more * (fine[a][b] - coarse[a][b]);
            double *worst = &off[(a > 0) + (b > 0)];
            *worst = fmax(*worst, fabs(c[a][b] - (a + b > 0 ? known : factor)) / factor);
        }
    printf("%s: of F, mean off by %.1e, slopes %.1e, slope to slope %.1e\n", pair->name, off[0],
           off[1], off[2]);
    ck_assert_double_le(off[0], pair->touching ? 7e-3 : 2e-3);
    ck_assert_double_le(off[1], pair->touching ? 3e-2 : 2e-3);
    ck_assert_double_le(off[2], pair->touching ? 1.5e-1 : 4e-3);
}
END_TEST

/* How many pairs of cells a coupling takes. */
static long cells_of(const struct pair_case *pair)
{
    struct pair_of p;
    double c[3][3];
    make_pair(&p, pair);
    return linear_coupling_at(1, c, p.r, p.s);
}

/* A square of 2 mm beside a strip of 1 m by 1 mm has a few times as many pairs of cells as beside
 * another square, and had hundreds of times as many by quarters of the strip. */
START_TEST(test_strip)
{
    static const struct pair_case pair[2] = {
        {"squares", 1, {4, 4}, {SQUARE, {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}}},
        {"a strip",
         1,
         {4, 4},
         {SQUARE, {{0, -250, 0}, {0, 250, 0}, {0, 250, 0.5}, {0, -250, 0.5}}}}};
    const long square = cells_of(&pair[0]), strip = cells_of(&pair[1]);
    printf("cells of %s: %ld, of %s: %ld\n", pair[1].name, strip, pair[0].name, square);
    ck_assert_int_lt(strip, 10 * square);
}
END_TEST

/* Limited couplings: the kernel between any corners is not negative, where it was before; F is the
 * link's; and A_r C_ab (r, s) = A_s C_ba (s, r). */
START_TEST(test_limit)
{
    struct pair_of p;
    double there[3][3], back[3][3], before = 0, least = 0;
    make_pair(&p, &cases[_i]);
    double factor = 0.9 * polygon_factor(&p.e[0], &p.e[1], 1), areas = p.e[0].area / p.e[1].area;
    linear_coupling_integrate(there, p.r, p.s);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            back[b][a] = there[a][b] * areas;
    linear_coupling_scale(there, factor);
    linear_coupling_scale(back, factor * areas);
    for (int limited = 0; limited < 2; limited++) {
        for (int i = 0; i < p.e[0].vertices; i++)
            for (int j = 0; j < p.e[1].vertices; j++) {
                double x[3] = {1, 0, 0}, y[3] = {1, 0, 0}, kernel = 0;
                linear_basis_at(&p.basis[0], p.e[0].centre, p.e[0].vertex[i], x + 1);
                linear_basis_at(&p.basis[1], p.e[1].centre, p.e[1].vertex[j], y + 1);
                for (int a = 0; a < 3; a++)
                    for (int b = 0; b < 3; b++)
                        kernel += x[a] * there[a][b] * y[b];
                if (limited)
                    least = fmin(least, kernel);
                else
                    before = fmin(before, kernel);
            }
        linear_coupling_limit(there, p.r, p.s);
        linear_coupling_limit(back, p.s, p.r);
    }
    ck_assert_double_ge(least, -1e-12 * factor);
    if (cases[_i].touching)
        ck_assert_double_lt(before, -0.1 * factor);
    ck_assert_double_eq(there[0][0], factor);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            ck_assert_double_eq_tol(back[b][a], there[a][b] * areas, 1e-9 * factor * areas);
}
END_TEST

/* ---- solutions over links that a test has set */

/* Leaves of one depth for each face, all linked. */
struct script {
    int depth[2]; /* of face 0, of the others */
    int above;    /* emitters are linked so many levels above their leaves */
    int twice;    /* links claim twice their F */
};

static enum decision follow(const void *state, struct discussion *d)
{
    const struct script *script = state;
    const struct element *r = d->receiver, *e = d->emitter;
    if (!r->vertices || !e->vertices)
        return r->vertices   ? DECISION_SUBDIVIDE_EMITTER
               : e->vertices ? DECISION_SUBDIVIDE_RECEIVER
                             : DECISION_SUBDIVIDE_BOTH;
    if (r->face == e->face)
        return DECISION_STOP;
    int split_r = r->depth < script->depth[r->face > 0],
        split_e = e->depth < script->depth[e->face > 0] - script->above;
    if (split_r || split_e)
        return split_r && split_e ? DECISION_SUBDIVIDE_BOTH
               : split_r          ? DECISION_SUBDIVIDE_RECEIVER
                                  : DECISION_SUBDIVIDE_EMITTER;
    memset(&d->terms, 0, sizeof d->terms);
    d->terms.form_factor = (1 + script->twice) * polygon_factor(r, e, 0);
    d->terms.visibility = 1;
    return d->terms.form_factor > 0 ? DECISION_LINK : DECISION_STOP;
}

static struct solve_options with_basis(int linear, int threads)
{
    struct solve_options o = quick(threads);
    o.linear = linear;
    return o;
}

static void run_script(struct solve *s, const struct scene *scene, const struct script *script,
                       struct solve_options how)
{
    const struct refiner refiner = {
        .refine = follow, .state = script, .oracle = "scripted", .release = "hand"};
    const char *cause;
    ck_assert_int_eq(solve_open(s, scene, &how, &cause), 0);
    ck_assert_int_eq(solve_run(s, &refiner, &cause), 0);
    ck_assert_int_eq(s->report.converged, 1);
}

/* B at x of element e. */
static double value_in(const struct solve *s, uint32_t e, const double x[3])
{
    double away[3];
    sub3(away, x, s->hierarchy.elements[e].centre);
    return s->state.radiosity[e]
           + (s->linear.gradient ? dot3(&s->linear.gradient[3 * (size_t)e], away) : 0);
}

/* The mean of B over the leaves that x is on. */
static double value_at(const struct solve *s, const double x[3])
{
    double sum = 0;
    int count = 0;
    for (uint32_t i = 0; i < s->hierarchy.count; i++) {
        const struct element *e = &s->hierarchy.elements[i];
        if (!e->vertices || e->children
            || polygon_distance(x, (const double(*)[3])e->vertex, e->vertices, e->normal) > 1e-9)
            continue;
        sum += value_in(s, i, x);
        count++;
    }
    ck_assert_int_gt(count, 0);
    return sum / count;
}

/* Under a unit square at height 1 above the origin: four corners' rectangles. */
static double under_square(double x, double y)
{
    double sum = 0;
    for (int i = 0; i < 4; i++) {
        double a = (i & 1 ? 0.5 : -0.5) - x, b = (i & 2 ? 0.5 : -0.5) - y, p = sqrt(1 + a * a),
               q = sqrt(1 + b * b), part = (a / p * atan(b / p) + b / q * atan(a / q)) / (2 * M_PI);
        sum += (i == 0 || i == 3 ? 1 : -1) * part;
    }
    return sum;
}

/* The L2 distance from the closed form, by 4 x 4 Gauss rules of 3 x 3 points per leaf. */
static double arvo_error(int depth, int linear)
{
    static const double node[3] = {0.11270166537925831148, 0.5, 0.88729833462074168852};
    static const double weight[3] = {5 / 18.0, 8 / 18.0, 5 / 18.0};
    enum { RULES = 4, POINTS = 3 * RULES };
    const struct script script = {{depth, 0}, 0, 0};
    struct scene scene;
    struct solve s;
    double sum = 0;
    made_open(&scene);
    uint32_t white = made_material(&scene, 0.999, 0), lamp = made_material(&scene, 0, 1);
    made_quad(&scene, white, -5, -5, 0, 10, 0, 0, 0, 10, 0);
    made_quad(&scene, lamp, -0.5, -0.5, 1, 0, 1, 0, 1, 0, 0);
    run_script(&s, &scene, &script, with_basis(linear, 1));
    for (uint32_t i = 0; i < s.hierarchy.count; i++) {
        const struct element *e = &s.hierarchy.elements[i];
        for (int j = 0; e->vertices && !e->children && e->face == 0 && j < POINTS * POINTS; j++) {
            double x[3] = {0, 0, 0}, share = 1.0 / (RULES * RULES);
            for (int k = 0; k < 2; k++) {
                int at = k ? j / POINTS : j % POINTS;
                x[k] = e->vertex[0][k]
                       + (at / 3 + node[at % 3]) / RULES * (e->vertex[2][k] - e->vertex[0][k]);
                share *= weight[at % 3];
            }
            double off = value_in(&s, i, x) / 0.999 - under_square(x[0], x[1]);
            sum += e->area * share * off * off;
        }
    }
    ck_assert((s.linear.gradient != NULL) == linear);
    solve_close(&s);
    made_close(&scene);
    return sqrt(sum);
}

/* Arvo's scene (oracles.md, figure 4): constants as published, which fall with h; linear functions
 * with h^2. */
START_TEST(test_order)
{
    static const double known[3] = {0.14462, NAN, 0.03543};
    double error[2][3];
    for (int linear = 0; linear < 2; linear++)
        for (int i = 0; i < 3; i++)
            error[linear][i] = arvo_error(3 + i, linear);
    printf(
        "unit source over 10 x 10, n 8, 16, 32: constant %.5f %.5f %.5f, linear %.5f %.5f %.5f\n",
        error[0][0], error[0][1], error[0][2], error[1][0], error[1][1], error[1][2]);
    for (int i = 0; i < 3; i += 2)
        ck_assert_double_eq_tol(error[0][i], known[i], 0.002 * known[i]);
    ck_assert_double_lt(error[0][1] / error[0][2], 2.1);
    ck_assert_double_gt(error[1][1] / error[1][2], 3.6);
    ck_assert_double_lt(error[1][2], 0.1 * error[0][2]);
}
END_TEST

/* Two parallel unit squares, or four triangles: the continuous solution at the centre, the middle
 * of an edge and a corner, and its mean. */
START_TEST(test_plates)
{
    static const double at[3][3] = {{0.5, 0.5, 0}, {0.5, 0, 0}, {0, 0, 0}};
    static const double known[4] = {1.133303564992, 1.100306232464, 1.076981393145, 1.111165244298};
    static const double square[2][4][3] = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                                           {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}};
    static const struct script script = {{2, 2}, 0, 0};
    double off[2] = {0, 0}, mean[2];
    for (int linear = 0; linear < 2; linear++) {
        struct scene scene;
        struct solve s;
        made_open(&scene);
        made_material(&scene, 0.5, 1);
        for (int i = 0; i < 2 && _i == 0; i++)
            made_face(&scene, 0, 4, square[i]);
        for (int i = 0; i < 4 && _i == 1; i++) {
            const double(*v)[3] = square[i / 2];
            const double half[3][3] = {{v[0][0], v[0][1], v[0][2]},
                                       {v[1 + i % 2][0], v[1 + i % 2][1], v[1 + i % 2][2]},
                                       {v[2 + i % 2][0], v[2 + i % 2][1], v[2 + i % 2][2]}};
            made_face(&scene, 0, 3, half);
        }
        run_script(&s, &scene, &script, with_basis(linear, 1));
        for (int i = 0; i < 3; i++)
            off[linear] = fmax(off[linear], fabs(value_at(&s, at[i]) - known[i]));
        mean[linear] = fabs(face_radiosity(&s, 0) - known[3]);
        solve_close(&s);
        made_close(&scene);
    }
    printf("plates, %s: points off by %.5f constant, %.5f linear; mean by %.6f, %.6f\n",
           _i ? "32 triangles" : "16 squares", off[0], off[1], mean[0], mean[1]);
    ck_assert_double_lt(off[1], 0.2 * off[0]);
    ck_assert_double_lt(mean[1], 0.2 * mean[0]);
    ck_assert_double_lt(mean[1], 2e-5);
}
END_TEST

/* The mean over e of value times phi_a of element `in`, value linear over the triangles of e: their
 * edges' middles are a rule exact to degree 2. */
static double mean_with(const struct solve *s, uint32_t e, uint32_t in, int a)
{
    const struct element *at = &s->hierarchy.elements[e], *whole = &s->hierarchy.elements[in];
    struct linear_basis basis;
    double sum = 0;
    linear_basis_of(&basis, whole);
    for (int t = 2; t < at->vertices; t++) {
        const double *v[3] = {at->vertex[0], at->vertex[t - 1], at->vertex[t]};
        double x[3], u[3], w[3], c[3], phi[2];
        sub3(u, v[1], v[0]);
        sub3(w, v[2], v[0]);
        cross3(c, u, w);
        for (int i = 0; i < 3; i++) {
            for (int k = 0; k < 3; k++)
                x[k] = 0.5 * (v[i][k] + v[(i + 1) % 3][k]);
            linear_basis_at(&basis, whole->centre, x, phi);
            sum += 0.5 * length3(c) / 3 * value_in(s, e, x) * phi[a];
        }
    }
    return sum / at->area;
}

/* Two plates of leaves two deep, quads and triangles, linked from emitters two levels above: what
 * an element sends is the projection of its leaves' light. */
START_TEST(test_projection)
{
    static const struct script script = {{2, 2}, 2, 0};
    struct scene scene;
    struct solve s;
    int checked = 0;
    made_open(&scene);
    made_material(&scene, 0.5, 1);
    const double low[4][3] = {{0, 0, 0}, {1, 0, 0}, {0.7, 0.8, 0}, {0.1, 1, 0}},
                 high[3][3] = {{0, 0, 0.4}, {0, 1, 0.4}, {1, 0, 0.4}};
    made_face(&scene, 0, 4, low);
    made_face(&scene, 0, 3, high);
    run_script(&s, &scene, &script, with_basis(1, 1));
    for (uint32_t i = 0; i < s.hierarchy.count; i++) {
        const struct element *e = &s.hierarchy.elements[i];
        for (int a = 0; e->vertices && e->children && a < 2; a++) {
            double parts = 0;
            for (uint32_t c = e->child; c < e->child + e->children; c++)
                parts += s.hierarchy.elements[c].area / e->area * mean_with(&s, c, i, a);
            ck_assert_double_eq_tol(mean_with(&s, i, i, a), parts, 1e-9);
            checked += fabs(parts) > 1e-4;
        }
    }
    ck_assert_int_gt(checked, 10);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Three walls of a corner, one element each, whose links claim twice what they bring: rows are
 * below 1, but above it along the edges. What is taken off there is taken off both ways round: the
 * light that the second wall has from the first, times area, is what the first has from the second.
 */
START_TEST(test_reciprocal)
{
    static const struct script script = {{0, 0}, 0, 1};
    double sent[2];
    for (int lamp = 0; lamp < 2; lamp++) {
        struct scene scene;
        struct solve s;
        made_open(&scene);
        for (int i = 0; i < 3; i++)
            made_material(&scene, 0.5, i == lamp);
        made_quad(&scene, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0);
        made_quad(&scene, 1, 0, 0, 0, 0, 2, 0, 0, 0, 1.5);
        made_quad(&scene, 2, 0, 0, 0, 0, 0, 1.5, 1, 0, 0);
        run_script(&s, &scene, &script, with_basis(1, 1));
        ck_assert_double_lt(s.report.rows.high, 1);
        sent[lamp] = (lamp ? 2 : 3) * face_radiosity(&s, !lamp);
        solve_close(&s);
        made_close(&scene);
    }
    printf("three walls: %.9f W and %.9f W\n", sent[0], sent[1]);
    ck_assert_double_eq_tol(sent[0], sent[1], 1e-5 * sent[0]);
}
END_TEST

/* A cube with one emitting face, rho .5: the continuous solution's means, from 4 and 16 elements
 * a face; constants come nearer to the same. */
START_TEST(test_cube)
{
    static const double known[6] = {0.1712161, 1.1043616, 0.1811056,
                                    0.1811056, 0.1811056, 0.1811056};
    double error[2][2] = {{0, 0}, {0, 0}};
    for (int linear = 0; linear < 2; linear++)
        for (int depth = 1; depth < 3; depth++) {
            const struct script script = {{depth, depth}, 0, 0};
            struct scene scene;
            struct solve s;
            made_open(&scene);
            uint32_t wall = made_material(&scene, 0.5, 0), lamp = made_material(&scene, 0.5, 1);
            made_room(&scene, (const uint32_t[6]){wall, lamp, wall, wall, wall, wall}, 1, 1, 1);
            run_script(&s, &scene, &script, with_basis(linear, 1));
            for (uint32_t f = 0; f < 6; f++)
                error[linear][depth - 1] =
                    fmax(error[linear][depth - 1], fabs(face_radiosity(&s, f) - known[f]));
            solve_close(&s);
            made_close(&scene);
        }
    printf("cube, 4 and 16 elements a face: means off by %.5f, %.5f constant, %.5f, %.5f linear\n",
           error[0][0], error[0][1], error[1][0], error[1][1]);
    ck_assert_double_lt(error[0][1], error[0][0]);
    for (int i = 0; i < 2; i++)
        ck_assert_double_lt(error[1][i], 0.2 * error[0][i]);
    ck_assert_double_lt(error[1][1], 2e-4);
}
END_TEST

/* B = E / (1 - rho) at every corner of every leaf: to the tolerance under closure; else as well as
 * the rows are 1. */
START_TEST(test_furnace)
{
    static void (*const shape[3])(struct scene *, double) = {furnace_cube, furnace_prism,
                                                             furnace_octahedron};
    static const char *const name[3] = {"cube", "prism", "octahedron"};
    static const double rho[2] = {0.9, 0.5};
    struct scene scene;
    struct solve s;
    int closed = _i % 2;
    double worst = 0, r = rho[_i / 6];
    struct solve_options how = with_basis(1, 1);
    how.closure = closed ? CLOSURE_ROWS : CLOSURE_NONE;
    shape[_i / 2 % 3](&scene, r);
    solve_with(&s, &scene, "bf_guarded", RELEASE_FLAT, NULL, how);
    ck_assert_uint_eq(s.linear.limited, 0);
    for (uint32_t i = 0; i < s.hierarchy.count; i++) {
        const struct element *e = &s.hierarchy.elements[i];
        for (int j = 0; j < e->vertices; j++)
            worst = fmax(worst, fabs(value_in(&s, i, e->vertex[j]) * (1 - r) - 1));
    }
    printf("furnace %s rho %.2f, %s: worst corner off by %.1e\n", name[_i / 2 % 3], r,
           closed ? "closed rows" : "capped rows", worst);
    ck_assert_double_le(worst, closed ? 1e-5 : 2e-3);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* ---- what must not change it, what it must not do */

/* Couplings five times what they are: changes grow, which is told; nonnegative kernels of the same
 * links converge, and no light is negative. */
START_TEST(test_limited)
{
    static const struct script script = {{1, 1}, 0, 0};
    struct scene scene;
    struct solve s;
    struct linear_links links;
    made_open(&scene);
    uint32_t grey = made_material(&scene, 0.9, 0), lamp = made_material(&scene, 0.9, 1);
    made_room(&scene, (const uint32_t[6]){grey, lamp, grey, grey, grey, grey}, 1, 1, 1);
    run_script(&s, &scene, &script, with_basis(0, 1));
    size_t count = s.hierarchy.count;
    double *value = calloc(5 * count, sizeof *value);
    struct transport means = {.bands = 1,
                              .value = s.state.radiosity,
                              .irradiance = s.state.irradiance,
                              .source = s.problem.exitance,
                              .reflectance = s.problem.reflectance,
                              .tolerance = 1e-6};
    struct linear_transport x = {&means, value, value + 3 * count};
    ck_assert_int_eq(linear_links_open(&links, &s.operator), 0);
    for (size_t i = 0; i < s.refinement.link_count; i++)
        for (int k = 0; k < LINEAR_MOMENTS; k++)
            links.moment[i][k] *= 5;
    s.operator.linear = & links;
    for (int limited = 0; limited < 2; limited++) {
        if (limited)
            linear_links_limit(&links, NULL);
        memset(value, 0, 5 * count * sizeof *value);
        linear_transport_start(&s.operator, & links, &x);
        ck_assert_int_eq(row_sums_renew(&s.operator, & s.report.rows), 0);
        linear_links_scale(&links, &s.operator);
        ck_assert_int_eq(linear_transport_solve(&s.operator, & links, &x), !limited);
        ck_assert_int_eq(means.converged, limited);
    }
    printf("couplings times 5, made nonnegative: %d sweeps\n", means.sweeps);
    for (uint32_t i = 0; i < count; i++) {
        double least, most;
        if (!s.hierarchy.elements[i].vertices)
            continue;
        linear_basis_range(&links.basis[i], &s.hierarchy.elements[i], &value[3 * (size_t)i + 1],
                           &least, &most);
        ck_assert_double_ge(means.value[i] + least, -1e-6);
    }
    s.operator.linear = NULL;
    linear_links_close(&links);
    free(value);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* A white cube, from the light that there is and from a hundred times as much: that shrinks about
 * as fast as what sweeps change. Both end at the same light. */
START_TEST(test_too_bright)
{
    static const struct script script = {{1, 1}, 0, 0};
    struct scene scene;
    struct solve s;
    double light[2] = {0, 0};
    furnace_cube(&scene, 0.999);
    scene.faces[0].material = made_material(&scene, 0.999, 40);
    run_script(&s, &scene, &script, with_basis(0, 1));
    for (int bright = 0; bright < 2; bright++) {
        struct transport means = {.bands = 1,
                                  .value = s.state.radiosity,
                                  .irradiance = s.state.irradiance,
                                  .source = s.problem.exitance,
                                  .reflectance = s.problem.reflectance,
                                  .tolerance = 1e-6};
        for (uint32_t i = 0; i < s.hierarchy.count; i++)
            means.value[i] *= bright ? 100 : 1;
        ck_assert_int_eq(linear_solution_solve(&s.linear, &s.operator, & means, &s.report.rows), 0);
        ck_assert_int_eq(means.converged, 1);
        for (uint32_t f = 0; f < 6; f++)
            light[bright] += face_radiosity(&s, f);
        printf("%d sweeps, %g W/m2\n", s.linear.sweeps, light[bright] / 6);
        ck_assert_int_lt(s.linear.sweeps, 60);
    }
    ck_assert_double_eq_tol(light[1] / light[0], 1, 1e-5);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* A furnished room, linked so coarsely that some links bring negative light and are limited: the
 * same bits for any number of threads; no corner below 0; a leaf that is
 * covered in part, below the box, is constant; the links are those of constants, and without the
 * option nothing is made. */
START_TEST(test_room)
{
    static char *settings[] = {"relative=0.5", NULL};
    struct scene scene;
    struct solve s[3];
    furnished(&scene, 1);
    for (int i = 0; i < 3; i++)
        solve_with(&s[i], &scene, "bf_guarded", RELEASE_FLAT, settings,
                   with_basis(i > 0, 1 + i % 2));
    same_links(&s[0], &s[1]);
    ck_assert_ptr_null(s[0].linear.gradient);
    size_t count = s[1].hierarchy.count;
    ck_assert_int_eq(memcmp(s[1].linear.gradient, s[2].linear.gradient,
                            3 * count * sizeof *s[1].linear.gradient),
                     0);
    ck_assert_int_eq(
        memcmp(s[1].state.radiosity, s[2].state.radiosity, count * sizeof *s[1].state.radiosity),
        0);
    double low = INFINITY, sloped = 0;
    for (uint32_t i = 0; i < count; i++) {
        const struct element *e = &s[1].hierarchy.elements[i];
        const double *g = &s[1].linear.gradient[3 * (size_t)i];
        for (int j = 0; j < e->vertices; j++)
            low = fmin(low, value_in(&s[1], i, e->vertex[j]));
        if (e->vertices && !e->children && s[1].operator.uncovered[i]<1)
            ck_assert_double_eq(dot3(g, g), 0);
        sloped += dot3(g, g) > 0;
    }
    double lost_by_constants =
        fabs(s[0].report.emitted - s[0].report.absorbed) / s[0].report.emitted;
    double lost = fabs(s[1].report.emitted - s[1].report.absorbed) / s[1].report.emitted;
    printf(
        "furnished: least corner %.2e, %.0f of %zu elements sloped, power off by %.1e, constants "
        "by %.1e\n",
        low, sloped, count, lost,
        fabs(s[0].report.emitted - s[0].report.absorbed) / s[0].report.emitted);
    ck_assert_double_ge(low, -1e-12);
    ck_assert_double_gt(sloped, 0.5 * (double)count);
    ck_assert_double_lt(lost, lost_by_constants);
    ck_assert_uint_gt(s[1].linear.limited, 0);
    for (int i = 0; i < 3; i++)
        solve_close(&s[i]);
    made_close(&scene);
}
END_TEST

/* A tolerance below what doubles resolve ends where they do, and for that no link is limited. */
START_TEST(test_last_digits)
{
    struct scene scene;
    struct solve s, rough;
    struct solve_options how = with_basis(1, 1);
    furnished(&scene, 1);
    solve_with(&rough, &scene, "bf_guarded", RELEASE_FLAT, NULL, how);
    how.tolerance = 1e-19;
    solve_with(&s, &scene, "bf_guarded", RELEASE_FLAT, NULL, how);
    printf("%d sweeps to 1e-19, %llu links limited, %llu before\n", s.linear.sweeps,
           (unsigned long long)s.linear.limited, (unsigned long long)rough.linear.limited);
    ck_assert_int_eq(s.report.converged, 1);
    ck_assert_int_lt(s.linear.sweeps, 1000);
    ck_assert_uint_eq(s.linear.limited, rough.linear.limited);
    solve_close(&s);
    solve_close(&rough);
    made_close(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("linear");
    TCase *bases = tcase_create("bases"), *couplings = tcase_create("couplings"),
          *solutions = tcase_create("solutions");
    tcase_add_loop_test(bases, test_basis, 0, SHAPES);
    tcase_add_loop_test(bases, test_two_scale, 0, SHAPES);
    tcase_add_test(couplings, test_strip);
    tcase_add_loop_test(couplings, test_coupling, 0, CASES);
    tcase_add_loop_test(couplings, test_limit, 0, CASES);
    tcase_add_test(solutions, test_order);
    tcase_add_loop_test(solutions, test_plates, 0, 2);
    tcase_add_test(solutions, test_cube);
    tcase_add_test(solutions, test_projection);
    tcase_add_test(solutions, test_reciprocal);
    tcase_add_loop_test(solutions, test_furnace, 0, thorough() ? 12 : 6);
    tcase_add_test(solutions, test_limited);
    tcase_add_test(solutions, test_too_bright);
    tcase_add_test(solutions, test_room);
    tcase_add_test(solutions, test_last_digits);
    tcase_set_timeout(solutions, 120);
    suite_add_tcase(suite, bases);
    suite_add_tcase(suite, couplings);
    suite_add_tcase(suite, solutions);
    return suite_failures(suite) != 0;
}
