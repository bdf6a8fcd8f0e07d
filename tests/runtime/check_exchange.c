/* check_exchange.c - exchange areas where the graphs shipped do not lead: whatever an oracle links,
 * the matrix holds what the pairs of its faces exchange.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>
#include "engine/exchange.h"
#include "kernel/constants.h"
#include "util/oracles.h"
#include "scene/make_scene.h"
#include "suite.h"

/* Two unit squares at distance 1, cells x cells faces each, and 12 plates that hide a quarter of
 * the plane between them, each a little above the one before: no two are in one plane. Seen from
 * one point, no more than a hundredth of them overlaps or parts. */
static void plates(struct scene *s, int cells)
{
    made_open(s);
    made_material(s, 0.5, 0);
    double side = 1.0 / cells;
    for (int i = 0; i < cells * cells; i++)
        made_quad(s, 0, i % cells * side, i / cells * side, 0, side, 0, 0, 0, side, 0);
    for (int i = 0; i < cells * cells; i++)
        made_quad(s, 0, i % cells * side, i / cells * side, 1, 0, side, 0, side, 0, 0);
    for (int i = 0; i < 12; i++)
        made_quad(s, 0, i % 3 / 6.0, i / 3 / 8.0, 0.5 + (i - 6) * 2e-4, 1 / 6.0, 0, 0, 0, 1 / 8.0,
                  0);
}

/* Links groups as soon as they turn to each other. `deep`: cuts one face of such a pair in four
 * first. */
static enum decision link_groups(const void *state, struct discussion *d)
{
    const int *deep = state;
    const struct element *r = d->receiver, *s = d->emitter;
    if (r == s)
        return r->children ? DECISION_SUBDIVIDE_BOTH : DECISION_STOP;
    if (!r->vertices)
        return DECISION_SUBDIVIDE_RECEIVER;
    if (!s->vertices)
        return DECISION_SUBDIVIDE_EMITTER;
    if (!(height3(s->centre, r->centre, r->normal) > 0)
        || !(height3(r->centre, s->centre, s->normal) > 0))
        return DECISION_STOP;
    if (*deep && r->group && (s->depth || s->group))
        return s->depth ? DECISION_LINK : DECISION_SUBDIVIDE_EMITTER;
    if (*deep && s->group && r->depth)
        return DECISION_LINK;
    if (*deep && (r->group || s->group))
        return r->group ? DECISION_SUBDIVIDE_EMITTER : DECISION_SUBDIVIDE_RECEIVER;
    return DECISION_LINK;
}

/* What the one wall exchanges with the other (m2). */
static double wall_to_wall(int cells, int deep)
{
    struct scene scene;
    plates(&scene, cells);
    struct exchange_tree tree;
    const char *cause;
    ck_assert_int_eq(exchange_tree_open(&tree, scene.faces, scene.face_count, 2, &cause), 0);
    const struct refiner refiner = {.refine = link_groups, .state = &deep};
    struct refinement refinement;
    ck_assert_int_eq(refinement_open(&refinement, &tree.h, &tree.host, &refiner,
                                     limits_complete((struct limits){0}, NULL), 2),
                     0);
    ck_assert_int_eq(refinement_start(&refinement), 0);
    struct exchange_areas matrix;
    const struct exchange_aim how = {.tolerance = 3e-4, .keep = SIZE_MAX, .threads = 2};
    ck_assert_int_eq(exchange_areas_open(&matrix, &tree, &scene, &refinement, &how), 0);
    uint32_t wall = (uint32_t)(cells * cells);
    double *row = calloc(scene.input_count, sizeof *row), sum = 0;
    for (uint32_t i = 0; i < wall; i++) {
        memset(row, 0, scene.input_count * sizeof *row);
        (void)exchange_areas_row(&matrix, i, NULL, row);
        for (uint32_t j = wall; j < 2 * wall; j++)
            sum += row[j];
    }
    free(row);
    exchange_areas_close(&matrix);
    refinement_close(&refinement);
    exchange_tree_close(&tree);
    made_close(&scene);
    return sum;
}

/* F = 3/4 of the clear value, as in check_viewfactors.c, though twelve blockers stand in the shaft
 * of the two groups and a list holds eight. */
START_TEST(test_many_blockers)
{
    ck_assert_double_eq_tol(wall_to_wall(4, 0) / 0.1498686718, 1, 5e-3);
    ck_assert_double_eq_tol(wall_to_wall(8, 0) / 0.1498686718, 1, 5e-3);
}
END_TEST

/* The same when parts of faces are linked to groups. */
START_TEST(test_parts_and_groups)
{
    ck_assert_double_eq_tol(wall_to_wall(4, 1) / 0.1498686718, 1, 5e-3);
}
END_TEST

static int stop_at(void *context, const struct exchange *x, const char *phase)
{
    (void)x;
    return phase[0] == *(const char *)context;
}

/* The progress function ends it in either phase; then there is nothing, and no cause but that.
 * Else rows of a cube are 1. */
START_TEST(test_cancel)
{
    static const char *const phases[] = {"refine", "factors", "none"};
    static const uint32_t m[6] = {0};
    struct scene scene;
    made_open(&scene);
    made_material(&scene, 0.5, 0);
    made_room(&scene, m, 1, 1, 1);
    struct refiner *refiner = oracles_open("viewfactors", RELEASE_FLAT);
    for (int i = 0; i < 3; i++) {
        const struct exchange_options options = {.tolerance = 3e-4,
                                                 .closure = CLOSURE_RECIPROCAL,
                                                 .threads = 2,
                                                 .progress = stop_at,
                                                 .context = (void *)(uintptr_t)phases[i]};
        struct exchange x;
        const char *cause = "not set";
        ck_assert_int_eq(exchange_open(&x, &scene, refiner, &options, &cause), i < 2 ? -1 : 0);
        if (i < 2) {
            ck_assert_ptr_null(cause);
            ck_assert_ptr_null(x.tree.rays);
            continue;
        }
        double row[6];
        ck_assert_double_eq_tol(exchange_row(&x, 3, row), 1, 1e-11);
        ck_assert_double_eq_tol(row[0], 0.2000437760754032, 1e-5);
        ck_assert_uint_eq(x.report.rows_closed, 6);
        exchange_close(&x);
    }
    refiner_close(refiner);
    made_close(&scene);
}
END_TEST

/* A product is the matrix times its columns, whether values are kept or computed anew, to the bit
 * for any number of threads; of fewer rows, those rows. Walls of 256 faces are tiles of groups, in
 * each other's half shadow. */
START_TEST(test_product)
{
    enum { CELLS = 16, N = 2 * CELLS * CELLS + 12, COLUMNS = 11 };
    static double in[N * COLUMNS], out[4][N * COLUMNS], row[N];
    const int cells = under_sanitizers() ? CELLS / 2 : CELLS, n = 2 * cells * cells + 12;
    struct scene scene;
    plates(&scene, cells);
    struct refiner *refiner = oracles_open("viewfactors", RELEASE_FLAT);
    const struct exchange_options options[4] = {
        {.tolerance = 3e-4, .closure = CLOSURE_ROWS, .threads = 2},
        {.tolerance = 3e-4, .closure = CLOSURE_ROWS, .threads = 2, .stream = 1},
        {.tolerance = 3e-4, .closure = CLOSURE_ROWS, .threads = 1, .stream = 1},
        {.tolerance = 3e-4, .closure = CLOSURE_ROWS, .threads = 2, .stream = 1, .rows = 40}};
    for (int k = 0; k < n * COLUMNS; k++)
        in[k] = sin(k);
    for (int i = 0; i < 4; i++) {
        struct exchange x;
        const char *cause = "not set";
        ck_assert_int_eq(exchange_open(&x, &scene, refiner, &options[i], &cause), 0);
        ck_assert_int_eq(exchange_multiply(&x, COLUMNS, in, out[i]), 0);
        for (uint32_t r = 0; r < (uint32_t)n && i == 0; r++) {
            (void)exchange_row(&x, r, row);
            for (int c = 0; c < COLUMNS; c++) {
                double sum = 0;
                for (int j = 0; j < n; j++)
                    sum += row[j] * in[j * COLUMNS + c];
                ck_assert_double_eq_tol(out[0][r * COLUMNS + (uint32_t)c], sum, 1e-12);
            }
        }
        exchange_close(&x);
    }
    for (int k = 0; k < n * COLUMNS; k++)
        ck_assert_double_eq_tol(out[1][k], out[0][k], 1e-13);
    ck_assert_int_eq(memcmp(out[1], out[2], sizeof out[1]), 0);
    for (int k = 0; k < 40 * COLUMNS; k++)
        ck_assert_double_eq_tol(out[3][k], out[0][k], 1e-13);
    ck_assert(fabs(out[0][0]) > 1e-6);
    refiner_close(refiner);
    made_close(&scene);
}
END_TEST

/* It is so, too, where a closure makes entries larger than 1. */
START_TEST(test_product_above)
{
    struct scene scene;
    made_open(&scene);
    made_material(&scene, 0.5, 0);
    made_quad(&scene, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    made_quad(&scene, 0, 0, 0, 0.01, 0, 1, 0, 1, 0, 0);
    struct refiner *refiner = oracles_open("viewfactors", RELEASE_FLAT);
    for (int closure = CLOSURE_ROWS; closure <= CLOSURE_RECIPROCAL; closure++) {
        const struct exchange_options options = {
            .tolerance = 3e-4, .closure = (enum closure)closure, .threads = 1};
        const double in[2] = {0.3, 0.7};
        double out[2], row[2];
        struct exchange x;
        const char *cause;
        ck_assert_int_eq(exchange_open(&x, &scene, refiner, &options, &cause), 0);
        for (int i = 0; i < 2; i++)
            x.closure.scale[i] *= 1.1;
        ck_assert_int_eq(exchange_multiply(&x, 1, in, out), 0);
        for (uint32_t i = 0; i < 2; i++) {
            ck_assert_double_gt(exchange_row(&x, i, row), 1.05);
            ck_assert_double_eq_tol(out[i], row[0] * in[0] + row[1] * in[1], 1e-14);
        }
        exchange_close(&x);
    }
    refiner_close(refiner);
    made_close(&scene);
}
END_TEST

/* Rows, products, losses and closures are the same to the bit whether all values are kept, some of
 * those in clear view, or none; and A_i F_ij is A_j F_ji in all of them. Faces with a back are two
 * in one row. Faces far and near, in clear view and in half shadow. */
START_TEST(test_made_anew)
{
    enum { CELLS = 12, N = 2 * CELLS * CELLS + 12, FINS = 3 };
    static const enum closure closures[] = {CLOSURE_NONE, CLOSURE_RECIPROCAL};
    static double rows[2][N + FINS][N + FINS], out[2][N + FINS], in[N + FINS];
    size_t keep[] = {SIZE_MAX, 1, 0}, anew;
    struct scene scene;
    plates(&scene, CELLS);
    for (int i = 0; i < FINS; i++) { /* with a back each */
        made_quad(&scene, 0, 0.2, i * 0.3, 0.2, 0, 0.25, 0, 0, 0, 0.4 + i * 0.1);
        made_quad(&scene, 0, 0.2, i * 0.3, 0.2, 0, 0, 0.4 + i * 0.1, 0, 0.25, 0);
        scene.faces[scene.face_count - 2].input = scene.faces[scene.face_count - 1].input =
            --scene.input_count - 1;
    }
    struct refiner *refiner = oracles_open("viewfactors", RELEASE_FLAT);
    for (int k = 0; k < N + FINS; k++)
        in[k] = cos(k);
    for (int i = 0; i < (under_sanitizers() ? 3 : 6); i++) {
        const struct exchange_options options = {.tolerance = 3e-4,
                                                 .closure = closures[i / 3],
                                                 .threads = 1 + i % 3,
                                                 .keep = keep[i % 3]};
        struct exchange x;
        const char *cause = "not set";
        ck_assert_int_eq(exchange_open(&x, &scene, refiner, &options, &cause), 0);
        ck_assert_uint_eq(x.areas.inputs, N + FINS);
        anew = x.areas.value_count - x.areas.kept;
        ck_assert(i % 3 == 0 ? anew == 0 : anew > 1000);
        keep[2] = anew / 2 * sizeof(double);
        for (uint32_t r = 0; r < N + FINS; r++)
            (void)exchange_row(&x, r, rows[i % 3 > 0][r]);
        ck_assert_int_eq(exchange_multiply(&x, 1, in, out[i % 3 > 0]), 0);
        for (uint32_t r = 0; r < N + FINS && i < 3; r++)
            for (uint32_t c = 0; c < r; c++) {
                double there = x.areas.area[r] * rows[i > 0][r][c];
                ck_assert_double_le(fabs(x.areas.area[c] * rows[i > 0][c][r] - there),
                                    1e-12 * there);
            }
        if (i % 3) {
            ck_assert_int_eq(memcmp(rows[1], rows[0], sizeof rows[0]), 0);
            ck_assert_int_eq(memcmp(out[1], out[0], sizeof out[0]), 0);
        }
        exchange_close(&x);
    }
    refiner_close(refiner);
    made_close(&scene);
}
END_TEST

/* Limits follow the tolerance, and only they do. */
START_TEST(test_tolerance)
{
    struct refiner *refiner = oracles_open("viewfactors", RELEASE_FLAT);
    exchange_set_tolerance(refiner, 0.1 * EXCHANGE_TOLERANCE);
    for (int i = 0; i < refiner->parameter_count; i++) {
        const struct oracle_parameter *p = &refiner->parameters[i];
        int limit = strcmp(p->name, "group_shadow") == 0;
        /* integrated, not split; integrated for the entry, not for the link */
        if (strcmp(p->name, "shadow") == 0 || strcmp(p->name, "cut_out") == 0
            || strcmp(p->name, "exact") == 0)
            ck_assert_double_infinite(refiner_get(refiner, i));
        else
            ck_assert_double_eq_tol(refiner_get(refiner, i), p->value * (limit ? 0.1 : 1),
                                    1e-12 * p->value);
    }
    refiner_close(refiner);
}
END_TEST

/* Half shadow that is integrated has no sample besides, though the oracle takes some by default;
 * the entries are the same. */
START_TEST(test_looks_once)
{
    enum { CELLS = 3, N = 2 * CELLS * CELLS + 12 };
    static double row[2][N][N];
    struct scene scene;
    plates(&scene, CELLS);
    for (int k = 0; k < 2; k++) {
        struct refiner *refiner = oracles_open("viewfactors", RELEASE_FLAT);
        const struct exchange_options options = {.tolerance = EXCHANGE_TOLERANCE, .threads = 1};
        struct exchange x;
        const char *cause;
        exchange_set_tolerance(refiner, EXCHANGE_TOLERANCE);
        if (k == 1)
            ck_assert_int_eq(refiner_set(refiner, "cut_out", 0, NULL), 0);
        ck_assert_int_eq(exchange_open(&x, &scene, refiner, &options, &cause), 0);
        ck_assert(k == 0 ? x.report.rays == 0 : x.report.rays > 0);
        for (uint32_t r = 0; r < N; r++)
            (void)exchange_row(&x, r, row[k][r]);
        exchange_close(&x);
        refiner_close(refiner);
    }
    ck_assert_int_eq(memcmp(row[0], row[1], sizeof row[0]), 0);
    made_close(&scene);
}
END_TEST

/* The rule of one row. */
START_TEST(test_row_scale)
{
    ck_assert_double_eq(closure_row_scale(0.5, 2, 1), 4);
    ck_assert_double_eq(closure_row_scale(0.5, 2, 0), 1);
    ck_assert_double_eq(closure_row_scale(4, 2, 0), 0.5);
    ck_assert_double_eq(closure_row_scale(0, 2, 1), 1);
}
END_TEST

/* Oracles' rays between two slanting faces across from each other, beside what is far off: they
 * start and end nearer to these than Embree's numbers tell, and meet neither. With a plate between
 * all meet it. */
START_TEST(test_rays_beside_far)
{
    enum { SIDE = 40, PARTS = 30 };
    static const double UP[2] = {0.31, 0.17}, FAR_AWAY = 20000; /* a slope along x and y */
    const double steep = sqrt(1 + UP[0] * UP[0] + UP[1] * UP[1]);
    struct scene s;
    struct exchange_tree t;
    const char *cause;
    uint64_t met = 0;
    made_open(&s);
    made_material(&s, 0.5, 0);
    for (int i = 0; i < PARTS; i++)
        made_quad(&s, 0, 0, (double)i / PARTS, UP[1] * i / PARTS, 1, 0, UP[0], 0, 1.0 / PARTS,
                  UP[1] / PARTS);
    made_quad(&s, 0, 0, 0, 1, 0, 1, UP[1], 1, 0, UP[0]);
    if (_i)
        made_quad(&s, 0, -1, -1, 0.5 - UP[0] - UP[1], 3, 0, 3 * UP[0], 0, 3, 3 * UP[1]);
    made_quad(&s, 0, FAR_AWAY, FAR_AWAY, FAR_AWAY, 0, 1, 0, 0, 0, 1);
    ck_assert_int_eq(exchange_tree_open(&t, s.faces, s.face_count, 1, &cause), 0);
    ck_assert_double_lt(t.host.ray_offset, 0.01 * rays_host(t.rays)->ray_offset);
    ck_assert(rays_in_the_way(t.rays) || rays_build(t.rays, &cause) == 0);
    const double off = t.host.ray_offset / steep,
                 n[3] = {-UP[0] * off, -UP[1] * off, off}; /* from the lower face up */
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double x = (i % SIDE + 0.37) / SIDE, y = (i / SIDE + 0.61) / SIDE,
                     low = UP[0] * x + UP[1] * y, high = 1 + UP[0] * y + UP[1] * (1 - x);
        const struct segment ray = {{x + n[0], y + n[1], low + n[2]},
                                    {y - n[0], 1 - x - n[1], high - n[2]}};
        met += t.host.occluded(&t.host, 1, &ray) & 1;
    }
    ck_assert_uint_eq(met, _i ? SIDE * SIDE : 0);
    exchange_tree_close(&t);
    made_close(&s);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("exchange areas");
    TCase *c = tcase_create("exchange areas");
    tcase_set_timeout(c, 60);
    tcase_add_test(c, test_many_blockers);
    tcase_add_test(c, test_parts_and_groups);
    tcase_add_test(c, test_cancel);
    tcase_add_test(c, test_product);
    tcase_add_test(c, test_product_above);
    tcase_add_test(c, test_made_anew);
    tcase_add_test(c, test_tolerance);
    tcase_add_test(c, test_looks_once);
    tcase_add_test(c, test_row_scale);
    tcase_add_loop_test(c, test_rays_beside_far, 0, 2);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
