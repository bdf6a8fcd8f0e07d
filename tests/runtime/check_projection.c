/* check_projection.c - radiosity held by constants, over meshes that an oracle divides evenly:
 * collocation beside Galerkin in the published experiment's table, in the rows of a cube and in the
 * limit; and what constants leave.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include "engine/residual.h"
#include "engine/solve.h"
#include "engine/variation.h"
#include "kernel/polygon_factor.h"
#include "runtime/make_solve.h"
#include "suite.h"

/* Every element of a face is split to that depth, but a lamp's; all see each other. */
struct even {
    int depth;
    uint32_t lamp; /* a face; NO_LAMP: there is none */
};
enum { NO_LAMP = 1000 };

static enum decision divide(const void *state, struct discussion *d)
{
    const struct even *even = state;
    const struct element *r = d->receiver, *e = d->emitter;
    if (!r->vertices || !e->vertices)
        return r->vertices   ? DECISION_SUBDIVIDE_EMITTER
               : e->vertices ? DECISION_SUBDIVIDE_RECEIVER
                             : DECISION_SUBDIVIDE_BOTH;
    if (r->face == e->face || r->face == even->lamp)
        return DECISION_STOP;
    if (r->depth < even->depth)
        return DECISION_SUBDIVIDE_RECEIVER;
    if (e->depth < even->depth && e->face != even->lamp)
        return DECISION_SUBDIVIDE_EMITTER;
    memset(&d->terms, 0, sizeof d->terms);
    d->terms.form_factor = polygon_factor(r, e, 1);
    d->terms.visibility = 1;
    return DECISION_LINK;
}

static void solve_evenly(struct solve *s, const struct scene *scene, int depth, uint32_t lamp,
                         enum RadProjection projection)
{
    const struct even even = {depth, lamp};
    const struct refiner refiner = {
        .refine = divide, .state = &even, .oracle = "even", .release = "hand"};
    struct solve_options how = quick(2);
    const char *cause;
    how.tolerance = 1e-9;
    how.projection = projection;
    ck_assert_int_eq(solve_open(s, scene, &how, &cause), 0);
    ck_assert_int_eq(solve_run(s, &refiner, &cause), 0);
    ck_assert_int_eq(s->report.converged, 1);
}

static int is_leaf(const struct solve *s, uint32_t e)
{
    return s->hierarchy.elements[e].vertices && !s->hierarchy.elements[e].children;
}

/* ---- Arvo, Torrance and Smits, figure 4: a unit square 1 above the middle of a 10 x 10 one */

/* F from a point to a rectangle a x b, 1 above it, with a corner straight above the point. */
static double under_corner(double a, double b)
{
    double p = sqrt(1 + a * a), q = sqrt(1 + b * b);
    return (a / p * atan(b / p) + b / q * atan(a / q)) / (2 * M_PI);
}

static double from_point(double x, double y)
{
    double sum = 0;
    for (int i = 0; i < 4; i++)
        sum += (i & 1 ? 1 : -1) * (i & 2 ? 1 : -1)
               * under_corner((i & 1 ? 0.5 : -0.5) - x, (i & 2 ? 0.5 : -0.5) - y);
    return sum;
}

enum { SAMPLES = 1024 }; /* along the side of a quarter, half of which is enough */

/* L1 and L2 distance of the constants from F, over the whole receiver. */
static void distances(const struct solve *s, int n, double *l1, double *l2)
{
    double *constant = calloc((size_t)(n * n), sizeof *constant), step = 5.0 / SAMPLES;
    int leaves = 0;
    for (uint32_t e = 0; e < s->hierarchy.count; e++) {
        const struct element *x = &s->hierarchy.elements[e];
        if (!is_leaf(s, e) || x->face != 0)
            continue;
        int i = (int)((x->centre[0] + 5) / 10 * n), j = (int)((x->centre[1] + 5) / 10 * n);
        constant[i * n + j] = s->state.irradiance[e];
        leaves++;
    }
    ck_assert_int_eq(leaves, n * n);
    *l1 = *l2 = 0;
    for (int i = 0; i < SAMPLES; i++)
        for (int j = 0; j <= i; j++) {
            double area = (i == j ? 4 : 8) * step * step;
            double x = (i + 0.5) * step, y = (j + 0.5) * step;
            double off =
                from_point(x, y) - constant[(int)((x + 5) / 10 * n) * n + (int)((y + 5) / 10 * n)];
            *l1 += area * fabs(off);
            *l2 += area * off * off;
        }
    *l2 = sqrt(*l2);
    free(constant);
}

static const struct {
    int depth;
    double l1[2], l2[2]; /* Galerkin, collocation */
} published[] = {
    {2, {0.89163, 0.76210}, {0.24045, 0.25100}},
    {3, {0.43702, 0.43598}, {0.14462, 0.14512}},
    {5, {0.10591, 0.10598}, {0.03543, 0.03558}},
};

/* All printed digits, but for what the sum over SAMPLES leaves: half a unit in the last place more.
 */
START_TEST(test_table)
{
    for (int p = 0; p < 2; p++) {
        double l1, l2;
        struct scene scene;
        made_open(&scene);
        made_quad(&scene, made_material(&scene, 0.5, 0), -5, -5, 0, 10, 0, 0, 0, 10, 0);
        made_quad(&scene, made_material(&scene, 0, 1), -0.5, -0.5, 1, 0, 1, 0, 1, 0, 0);
        struct solve s;
        solve_evenly(&s, &scene, published[_i].depth, 1, (enum RadProjection)p);
        distances(&s, 1 << published[_i].depth, &l1, &l2);
        printf("n = %2d, %-11s L1 %.6f (%.5f), L2 %.6f (%.5f)\n", 1 << published[_i].depth,
               p ? "collocation" : "Galerkin", l1, published[_i].l1[p], l2, published[_i].l2[p]);
        ck_assert_double_eq_tol(l1, published[_i].l1[p], 1e-5);
        ck_assert_double_eq_tol(l2, published[_i].l2[p], 1e-5);
        solve_close(&s);
        made_close(&scene);
    }
}
END_TEST

/* What constants leave, by steps from leaf to leaf and by evaluating each link at five points of
 * each leaf: alike, and halved with the leaves' size. */
START_TEST(test_variation)
{
    double last = INFINITY;
    for (int depth = 3; depth < 6; depth++) {
        struct scene scene;
        made_open(&scene);
        made_quad(&scene, made_material(&scene, 0.5, 0), -2, -2, 0, 4, 0, 0, 0, 4, 0);
        made_quad(&scene, made_material(&scene, 0, 1), -0.5, -0.5, 1, 0, 1, 0, 1, 0, 0);
        struct solve s;
        solve_evenly(&s, &scene, depth, 1, RAD_PROJECTION_GALERKIN);
        double points = 0, power = 0;
        for (uint32_t e = 0; e < s.hierarchy.count; e++) {
            double area = s.hierarchy.elements[e].area;
            if (!is_leaf(&s, e))
                continue;
            points += area * residual_of_leaf(&s.operator, s.state.radiosity, e).all;
            power += area * s.state.radiosity[e];
        }
        const struct transport x = {.bands = 1, .value = s.state.radiosity};
        double steps = variation_of(&s.operator, & x);
        printf("%4d leaves: constants leave %.5f by steps, %.5f by points\n", 1 << (2 * depth),
               steps, points / power);
        ck_assert_double_le(fabs(log(steps * power / points)), log(1.25));
        ck_assert_double_le(steps, 0.6 * last);
        last = steps;
        solve_close(&s);
        made_close(&scene);
    }
}
END_TEST

/* ---- a cube */

/* What a point of a closed scene sees is all there is: without closure and without a cap every row
 * of a centre sums to 1, and a furnace is right, however coarse its mesh. */
START_TEST(test_rows)
{
    struct scene scene;
    furnace_cube(&scene, 0.95);
    struct solve s;
    solve_evenly(&s, &scene, _i, NO_LAMP, RAD_PROJECTION_COLLOCATION);
    ck_assert_double_eq_tol(s.report.rows.low, 1, 1e-6);
    ck_assert_double_eq_tol(s.report.rows.high, 1, 1e-6);
    for (uint32_t e = 0; e < s.hierarchy.count; e++)
        if (is_leaf(&s, e))
            ck_assert_double_eq_tol(s.state.radiosity[e] * (1 - 0.95), 1, 2e-5);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* The ceiling of a cube emits 1, rho = 1/2: its mean, the floor's and a wall's, of the continuous
 * solution (energy sums to E / (1 - rho)). */
static const double continuous[3] = {1.1043616, 0.1712161, 0.1811056};

/* Both projections come to it as the square of the elements' size, or nearly, the one from means,
 * the other from centres; links hold means for both. */
START_TEST(test_limit)
{
    double off[2][4];
    const int depths = thorough() ? 4 : 3;
    for (int depth = 0; depth < depths; depth++) {
        struct solve s[2];
        struct scene scene;
        furnace_cube(&scene, 0.5);
        uint32_t dark = made_material(&scene, 0.5, 0);
        for (int i = 0; i < 6; i++)
            scene.faces[i].material = i == 1 ? 0 : dark;
        for (int p = 0; p < 2; p++) {
            solve_evenly(&s[p], &scene, depth, NO_LAMP, (enum RadProjection)p);
            double wall = 0, b[3];
            for (uint32_t i = 2; i < 6; i++)
                wall += face_radiosity(&s[p], i) / 4;
            b[0] = face_radiosity(&s[p], 1);
            b[1] = face_radiosity(&s[p], 0);
            b[2] = wall;
            off[p][depth] = 0;
            for (int i = 0; i < 3; i++)
                off[p][depth] = fmax(off[p][depth], fabs(b[i] / continuous[i] - 1));
        }
        same_links(&s[0], &s[1]);
        printf("%3d elements per face: off by %.2e, %.2e\n", 1 << (2 * depth), off[0][depth],
               off[1][depth]);
        solve_close(&s[0]);
        solve_close(&s[1]);
        made_close(&scene);
    }
    for (int p = 0; p < 2; p++)
        for (int depth = 1; depth < depths; depth++)
            ck_assert_double_le(off[p][depth], 0.3 * off[p][depth - 1]);
    ck_assert_double_ge(off[1][0], 2 * off[0][0]); /* they are not the same thing */
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("projection");
    TCase *c = tcase_create("projection");
    tcase_set_timeout(c, 30);
    tcase_add_loop_test(c, test_table, 0, sizeof published / sizeof *published);
    tcase_add_test(c, test_variation);
    tcase_add_loop_test(c, test_rows, 0, 3);
    tcase_add_test(c, test_limit);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
