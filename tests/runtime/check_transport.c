/* check_transport.c - links that a test has set by hand, solved: against closed forms and against a
 * dense matrix.
 *
 * The oracle is a C function here, which gives every link the form factor that the test wants;
 * faces lie side by side in one plane, so that nothing else is between them.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "engine/solve.h"
#include "engine/transport.h"
#include "kernel/constants.h"
#include "kernel/hash.h"
#include "scene/make_scene.h"
#include "suite.h"

/* Which links there are: `splits` asks for a finer receiver, else the pair is linked with
 * `factor`; not at all for 0. */
struct script {
    int (*splits)(const struct element *receiver, const struct element *emitter);
    double (*factor)(const struct element *receiver, const struct element *emitter);
    int groups; /* some links are of groups: passes may be rough */
};

static enum decision follow(const void *state, struct discussion *d)
{
    const struct script *script = state;
    const struct element *r = d->receiver, *e = d->emitter;
    if (!r->vertices || !e->vertices)
        return r->vertices   ? DECISION_SUBDIVIDE_EMITTER
               : e->vertices ? DECISION_SUBDIVIDE_RECEIVER
                             : DECISION_SUBDIVIDE_BOTH;
    if (r->face == e->face) { /* dark, as its form factor is not kept */
        memset(&d->terms, 0, sizeof d->terms);
        return script->groups ? DECISION_LINK_CLUSTERS : DECISION_STOP;
    }
    if (script->splits && script->splits(r, e))
        return DECISION_SUBDIVIDE_RECEIVER;
    memset(&d->terms, 0, sizeof d->terms);
    d->terms.form_factor = script->factor(r, e);
    d->terms.visibility = 1;
    if (!(d->terms.form_factor > 0))
        return DECISION_STOP;
    return DECISION_LINK;
}

static struct refiner scripted(const struct script *script)
{
    return (struct refiner){
        .refine = follow, .state = script, .oracle = "scripted", .release = "hand"};
}

/* A square of that side beside the ones before; it has a material of its own. */
static void add_square(struct scene *scene, double side, double rho, double exitance)
{
    made_quad(scene, made_material(scene, rho, exitance), 4.0 * scene->face_count, 0, 0, side, 0, 0,
              0, side, 0);
}

static struct solve_options options(double tolerance, enum RadSolver solver)
{
    return (struct solve_options){
        .tolerance = tolerance, .iterations = 100000, .threads = 1, .solver = solver};
}

static void open_solve(struct solve *s, const struct scene *scene, const struct script *script,
                       struct refiner *refiner, struct solve_options how)
{
    const char *cause;
    *refiner = scripted(script);
    ck_assert_int_eq(solve_open(s, scene, &how, &cause), 0);
    ck_assert_int_eq(solve_refine(s, refiner, &cause), 0);
}

static void run_refiner(struct solve *s, const struct scene *scene, const struct refiner *refiner,
                        struct solve_options how)
{
    const char *cause;
    ck_assert_int_eq(solve_open(s, scene, &how, &cause), 0);
    ck_assert_int_eq(solve_run(s, refiner, &cause), 0);
    ck_assert_int_eq(s->report.converged, 1);
    ck_assert_uint_eq(s->report.changing, 0);
}

static void run_solve(struct solve *s, const struct scene *scene, const struct script *script,
                      struct solve_options how)
{
    const struct refiner refiner = scripted(script);
    run_refiner(s, scene, &refiner, how);
}

static double face_value(const struct solve *s, uint32_t face)
{
    return s->state.radiosity[s->hierarchy.face_element[face]];
}

/* ---- the cap */

/* Which quarter of its face a part is: 0 to 3, by its place. */
static int quarter(const struct element *e)
{
    double x = e->centre[0] - 4.0 * e->face;
    return (x > 1) + 2 * (e->centre[1] > 1);
}

static int split_for_lamp(const struct element *r, const struct element *e)
{
    return r->face == 0 && e->face == 1 && r->depth == 0;
}

static double above_one(const struct element *r, const struct element *e)
{
    static const double own[4] = {0.875, 0, 0.5, 0.5};
    return r->face != 0 ? 0 : e->face == 2 ? 0.25 : own[quarter(r)];
}

/* A face in four: all have 1/4 of a dim face over the whole one's link, and 7/8, 0, 1/2 and 1/2 of
 * a bright lamp over their own. The first row, 9/8, is cut to 1 at the cost of the dim light alone;
 * what is cut, 1/8, goes to the two rows of 3/4, none to that of 1/4, which is shadow. The face as
 * a whole keeps its power. */
START_TEST(test_cap)
{
    static const struct script script = {split_for_lamp, above_one, 0};
    static const double lamp[4] = {0.875, 0, 0.5, 0.5}, dim[4] = {0.125, 0.25, 0.3125, 0.3125};
    double power = 0;
    int found = 0;
    struct scene scene;
    made_open(&scene);
    add_square(&scene, 2, 0.5, 0);
    add_square(&scene, 2, 0, 1024);
    add_square(&scene, 2, 0, 1);
    struct solve s;
    run_solve(&s, &scene, &script, options(1e-9, RAD_SOLVER_GAUSS_SEIDEL));
    for (uint32_t i = 0; i < s.hierarchy.count; i++) {
        const struct element *e = &s.hierarchy.elements[i];
        if (!e->vertices || e->children || e->face != 0)
            continue;
        double expected = 1024 * lamp[quarter(e)] + dim[quarter(e)];
        ck_assert_double_eq_tol(s.state.irradiance[i], expected, 1e-12 * expected);
        ck_assert_double_eq_tol(s.state.radiosity[i], 0.5 * expected, 1e-12 * expected);
        power += e->area * s.state.irradiance[i];
        found++;
    }
    ck_assert_int_eq(found, 4);
    ck_assert_double_eq_tol(power, 1024 * (0.875 + 0.5 + 0.5) + 4 * 0.25, 1e-9);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Under a ceiling of four squares that shine, which is one group, and beside a lamp: all that face
 * 0 gets, of the lamp *state times its radiosity. */
static enum decision under_group(const void *state, struct discussion *d)
{
    const struct element *r = d->receiver, *e = d->emitter;
    if (!r->vertices)
        return r->children && e->vertices ? DECISION_SUBDIVIDE_RECEIVER : DECISION_SUBDIVIDE_BOTH;
    memset(&d->terms, 0, sizeof d->terms);
    d->terms.visibility = 1;
    if (!e->vertices) /* of ceiling alone, in whose plane the centre is then */
        return r->face == 0 && e->centre[2] > 1.999 ? DECISION_LINK_CLUSTERS
                                                    : DECISION_SUBDIVIDE_EMITTER;
    d->terms.form_factor = *(const double *)state;
    return r->face == 0 && e->face == 1 ? DECISION_LINK : DECISION_STOP;
}

static double light_from_group(enum RadSolver solver, double lamp)
{
    const struct refiner refiner = {
        .refine = under_group, .state = &lamp, .oracle = "scripted", .release = "hand"};
    struct scene scene;
    made_open(&scene);
    add_square(&scene, 2, 0.5, 0);
    add_square(&scene, 2, 0, 1024);
    const uint32_t shines = made_material(&scene, 0, 1);
    for (int i = 0; i < 4; i++)
        made_quad(&scene, shines, 1 - 4.0 * (i / 2), 1 - 4.0 * (i % 2), 2, 0, 4, 0, 4, 0, 0);
    struct solve s;
    run_refiner(&s, &scene, &refiner, options(1e-9, solver));
    const double light = 2 * face_value(&s, 0);
    solve_close(&s);
    made_close(&scene);
    return light;
}

/* A face that reflects half may see 5/4 of everything. Of what a link of groups brings, whose
 * radiosity is 1, it takes all beside 1/4 and 1/2 of a lamp, so much as is left beside 1.1 of it,
 * and nothing beside 3/2, which are cut to 5/4. */
START_TEST(test_group_cap)
{
    static const enum RadSolver solvers[] = {RAD_SOLVER_GAUSS_SEIDEL, RAD_SOLVER_SOUTHWELL,
                                             RAD_SOLVER_LU};
    const double all = light_from_group(solvers[_i], 0.25) - 256;
    ck_assert_double_gt(all, 0.4);
    ck_assert_double_eq_tol(light_from_group(solvers[_i], 0.5), 512 + all, 1e-4);
    ck_assert_double_eq_tol(light_from_group(solvers[_i], 1.1), 1024 * 1.1 + 0.15, 1e-4);
    ck_assert_double_eq_tol(light_from_group(solvers[_i], 1.5), 1024 * 1.25, 1e-4);
}
END_TEST

/* ---- what stands on a face */

static double above_and_split(const struct element *r, const struct element *e)
{
    return r->face + e->face == 2 && r->face != 1 ? 0.25 : r->face + e->face == 1 ? 1e-9 : 0;
}

/* A box stands on half of a quarter of a face. What a lamp brings over the whole face's link lies
 * on what is bare, everywhere alike: 7/8 of the face have all of its light, by sweeps, by shots, by
 * elimination and with slopes. The lamp reflects what comes back. */
static void stand_box(enum RadSolver solver, int linear)
{
    static const struct script script = {split_for_lamp, above_and_split, 0};
    static const double along[3][3] = {{1, 0, 0}, {0, 0.5, 0}, {0, 0, 1}};
    struct solve_options how = options(1e-9, solver);
    const double row = 0.25 / 0.875, expected = 0.5 * row * 1024 / (1 - 0.5 * row * 0.5 * 0.25);
    double power = 0;
    int covered = 0, found = 0;
    struct scene scene;
    how.linear = linear;
    made_open(&scene);
    add_square(&scene, 2, 0.5, 0);
    add_square(&scene, 2, 0, 0);
    add_square(&scene, 2, 0.5, 1024);
    uint32_t black = made_material(&scene, 0, 0);
    made_box(&scene, black, (const double[3]){0, 0, 0}, along, 0);
    struct solve s;
    run_solve(&s, &scene, &script, how);
    if (solver == RAD_SOLVER_LU) /* one to see that nothing changes */
        ck_assert_int_eq(s.report.sweeps, s.report.passes);
    for (uint32_t i = 0; i < s.hierarchy.count; i++) {
        const struct element *e = &s.hierarchy.elements[i];
        if (!e->vertices || e->children || e->face != 0)
            continue;
        covered += s.operator.uncovered[i]<1;
        ck_assert_double_eq_tol(s.operator.uncovered[i], quarter(e) == 0 ? 0.5 : 1, 1e-12);
        ck_assert_double_eq_tol(s.state.radiosity[i], expected, 1e-6);
        ck_assert_double_eq_tol(s.operator.row[i], row, 1e-8);
        power += e->area * s.state.irradiance[i];
        found++;
    }
    ck_assert_int_eq(found, 4);
    ck_assert_int_eq(covered, 1);
    ck_assert_double_eq_tol(power, 4 * 0.875 * expected / 0.5, 1e-5);
    solve_close(&s);
    made_close(&scene);
}

START_TEST(test_stands)
{
    stand_box(RAD_SOLVER_GAUSS_SEIDEL, 0);
    stand_box(RAD_SOLVER_SOUTHWELL, 0);
    stand_box(RAD_SOLVER_LU, 0);
    stand_box(RAD_SOLVER_GAUSS_SEIDEL, 1);
}
END_TEST

/* ---- when iteration stops */

static double mutual;

static double each_other(const struct element *r, const struct element *e)
{
    return (r->face ^ 1) == e->face ? mutual : 0;
}

/* Two faces that see each other alone, F = 1, or 3/2, which the cap makes 1 + (1 - rho) / 2: B = E
 * / (1 - q), and Jacobi's sweeps come nearer by exactly q. What is left is at most the tolerance,
 * and not much less: a bound that is any looser, or takes rho for q, leaves more. */
START_TEST(test_stop)
{
    static const struct script script = {NULL, each_other, 0};
    const double rho = 0.9375, tolerance = 1e-2;
    const double q = _i == 0 ? rho : rho * (1 + 0.5 * (1 - rho)), known = 1 / (1 - q);
    mutual = _i == 0 ? 1 : 1.5;
    struct scene scene;
    made_open(&scene);
    add_square(&scene, 1, rho, 1);
    add_square(&scene, 1, rho, 1);
    struct solve s;
    run_solve(&s, &scene, &script, options(tolerance, RAD_SOLVER_JACOBI));
    double error = fabs(face_value(&s, 0) - known) / face_value(&s, 0);
    printf("two faces, q %.4f: error %.5f of %.5f after %d sweeps\n", q, error, tolerance,
           s.report.sweeps);
    ck_assert_double_le(error, tolerance * (1 + 1e-9));
    ck_assert_double_ge(error, 0.9 * tolerance);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

static int split_first(const struct element *r, const struct element *e)
{
    (void)e;
    return r->face == 0 && r->depth == 0;
}

static double step; /* relative, of one quarter of face 0 up and of one down */

static double each_other_unevenly(const struct element *r, const struct element *e)
{
    static const double steps[4] = {0, 0, -1, 1};
    return (r->face == 0 ? 1 + step * steps[quarter(r)] : 1) * each_other(r, e);
}

/* Nobody asks for a tolerance: iteration stops at a tenth of what constants leave, here rho F step
 * on one of two faces alike, but within SOLVE_TOLERANCE and SOLVE_TOLERANCE_MOST. */
START_TEST(test_tenth)
{
    static const struct script script = {split_first, each_other_unevenly, 0};
    static const double steps[] = {0, 1e-3, 1e-2, 0.05}, rho = 0.9375;
    mutual = 0.875;
    step = steps[_i];
    const double left = 0.5 * rho * mutual * step,
                 held = fmin(fmax(0.1 * left, SOLVE_TOLERANCE), SOLVE_TOLERANCE_MOST);
    struct scene scene;
    made_open(&scene);
    add_square(&scene, 2, rho, 1);
    add_square(&scene, 2, rho, 1);
    struct solve s;
    run_solve(&s, &scene, &script, options(0, RAD_SOLVER_JACOBI));
    double known = 1 / (1 - rho * mutual), error = fabs(face_value(&s, 1) / known - 1);
    printf("constants leave %.5f: held to %.6f, off by %.6f after %d sweeps\n", s.report.variation,
           s.report.tolerance, error, s.report.sweeps);
    ck_assert_double_eq_tol(s.report.variation, left, 1e-3 * left + 1e-15);
    ck_assert_double_eq_tol(s.report.tolerance, held, 1e-3 * held);
    ck_assert_double_le(s.report.bound, s.report.tolerance);
    ck_assert_double_le(error, held * (1 + 1e-2));
    ck_assert_double_ge(error, 0.6 * held);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

static double chain(const struct element *r, const struct element *e)
{
    return r->face == e->face + 1;
}

/* Light comes to a large face over one of a millionth of its area: the sweep in which that small
 * face changes moves next to no power, and the next a fifth of all. */
START_TEST(test_stop_small)
{
    static const struct script script = {NULL, chain, 0};
    struct scene scene;
    made_open(&scene);
    add_square(&scene, 1, 0.5, 1);
    add_square(&scene, 1e-3, 0.5, 0);
    add_square(&scene, 1, 0.5, 0);
    struct solve s;
    run_solve(&s, &scene, &script, options(1e-4, RAD_SOLVER_JACOBI));
    ck_assert_double_eq_tol(face_value(&s, 1), 0.5, 1e-4);
    ck_assert_double_eq_tol(face_value(&s, 2), 0.25, 1e-4);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

enum { FACES = 8, LEAVES = 4 * FACES };

static double draw(uint64_t a, uint64_t b)
{
    return (double)(hash64((a * 64 + b + 1) * HASH_STEP) >> 11) * 0x1p-53;
}

static int split_odd(const struct element *r, const struct element *e)
{
    return (e->face & 1) && r->depth == 0;
}

static double drawn(const struct element *r, const struct element *e)
{
    return 0.4 * draw(r->face * 4u + (r->depth ? (uint64_t)quarter(r) : 0), e->face);
}

/* K over the leaves, from the links and row_sums.h's words: a[i * n + j]. */
static void dense_operator(const struct solve *s, const uint32_t *leaf, int n, double *a)
{
    const struct light_operator *op = &s->operator;
    const struct element *elements = s->hierarchy.elements;
    double *raw = calloc((size_t)(n * n), sizeof *raw),
           *kept = calloc((size_t)(n * n), sizeof *kept);
    for (int i = 0; i < n; i++) {
        for (uint32_t up = leaf[i]; elements[up].vertices; up = elements[up].parent)
            for (size_t l = s->refinement.first_link[up]; l < s->refinement.first_link[up + 1];
                 l++) {
                const struct link *link = &s->refinement.links[l];
                const struct element *from = &elements[link->emitter];
                double f = (double)link->form_factor;
                for (int j = 0; j < n; j++)
                    if (elements[leaf[j]].face == from->face) {
                        double part = elements[leaf[j]].area / from->area;
                        raw[i * n + j] += f * part;
                        kept[i * n + j] +=
                            f * part * (up == leaf[i] ? op->row_scale[up] : op->row_above[leaf[i]]);
                    }
            }
    }
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            double shared = 0;
            for (int m = 0; m < n; m++)
                if (elements[leaf[m]].face == elements[leaf[i]].face)
                    shared += elements[leaf[m]].area * (raw[m * n + j] - kept[m * n + j]);
            a[i * n + j] =
                elements[leaf[i]].reflectance * (kept[i * n + j] + op->row_share[leaf[i]] * shared);
        }
    free(raw);
    free(kept);
}

/* x of (1 - K) x = b, by elimination; both are overwritten, x stands in b. */
static void solve_dense(double *k, double *b, int n)
{
    for (int i = 0; i < n * n; i++)
        k[i] = (i % (n + 1) == 0) - k[i];
    for (int p = 0; p < n; p++)
        for (int i = 0; i < n; i++) {
            double factor = k[i * n + p] / k[p * n + p];
            if (i == p)
                continue;
            for (int j = p; j < n; j++)
                k[i * n + j] -= factor * k[p * n + j];
            b[i] -= factor * b[p];
        }
    for (int i = 0; i < n; i++)
        b[i] /= k[i * n + i];
}

/* Eight faces, each linked to all others by numbers that were drawn: rows far above 1, so that the
 * cap is at work in every face, rho 0.97. What iteration leaves is within the tolerance of a dense
 * matrix's solution, by all methods. */
START_TEST(test_dense)
{
    static const struct script script = {split_odd, drawn, 0};
    const double tolerance = 1e-2;
    double known[LEAVES], k[LEAVES * LEAVES], off = 0, all = 0, capped = 0;
    int n = 0;
    struct scene scene;
    made_open(&scene);
    for (int i = 0; i < FACES; i++)
        add_square(&scene, 2, 0.97, draw(1000, (uint64_t)i));
    struct solve s;
    run_solve(&s, &scene, &script, options(tolerance, (enum RadSolver)_i));
    uint32_t leaf[LEAVES];
    for (uint32_t i = 0; i < s.hierarchy.count; i++)
        if (s.hierarchy.elements[i].vertices && !s.hierarchy.elements[i].children) {
            capped = fmax(capped, s.operator.row[i]);
            known[n] = s.problem.exitance[s.hierarchy.elements[i].face];
            leaf[n++] = i;
        }
    ck_assert_int_eq(n, LEAVES);
    ck_assert_double_eq_tol(capped, 1.015, 1e-12);
    dense_operator(&s, leaf, n, k);
    for (int i = 0; i < n; i++) { /* the rows that the bound goes by */
        double row = 0;
        for (int j = 0; j < n; j++)
            row += k[i * n + j] / 0.97;
        ck_assert_double_eq_tol(row, s.operator.row[leaf[i]], 1e-12);
    }
    solve_dense(k, known, n);
    for (int i = 0; i < n; i++) {
        off += s.hierarchy.elements[leaf[i]].area * fabs(s.state.radiosity[leaf[i]] - known[i]);
        all += s.hierarchy.elements[leaf[i]].area * s.state.radiosity[leaf[i]];
    }
    static const char *const solver[] = {"Gauss-Seidel", "Jacobi", "Southwell", "LU"};
    printf("dense, %s: error %.5f of %.5f after %d sweeps\n", solver[_i], off / all, tolerance,
           s.report.sweeps);
    ck_assert_double_le(off / all, tolerance);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* ---- passes */

/* What a rough pass leaves is less than what oracles notice; then the solve goes on to the
 * tolerance. */
START_TEST(test_rough)
{
    static const struct script script = {NULL, each_other, 1};
    const double rho = 0.9375, known = 1 / (1 - rho);
    mutual = 1;
    struct scene scene;
    made_open(&scene);
    add_square(&scene, 1, rho, 1);
    add_square(&scene, 1, rho, 1);
    struct solve s;
    struct refiner refiner;
    open_solve(&s, &scene, &script, &refiner, options(1e-7, RAD_SOLVER_GAUSS_SEIDEL));
    const char *cause;
    ck_assert_int_eq(solve_step(&s, &cause), 1);
    ck_assert_int_eq(s.report.converged, 0);
    printf("rough pass: %.4f off\n", fabs(face_value(&s, 0) / known - 1));
    ck_assert_double_le(fabs(face_value(&s, 0) / known - 1), 0.5 * HYSTERESIS);
    int more;
    while ((more = solve_step(&s, &cause)) > 0)
        ;
    ck_assert_int_eq(more, 0);
    ck_assert_int_eq(s.report.converged, 1);
    ck_assert_double_eq_tol(face_value(&s, 0), known, 1e-7 * known);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

enum { LAMP = 1, SLOW = 2, PASSERS_BY = 4 };

/* Face 0 wants finer links from the lamp as soon as the light over the ones it has is seen, down
 * to depth 3. */
static int split_when_lit(const struct element *r, const struct element *e)
{
    return r->face == 0 && e->face == LAMP && r->depth < 3 && r->radiosity > 0.9 * (1 << r->depth);
}

static double doubling(const struct element *r, const struct element *e)
{
    if (r->face == 0)
        return e->face == LAMP ? 0.125 * (1 << r->depth) : 0;
    if (r->face >= PASSERS_BY && e->face >= PASSERS_BY)
        return 0x1p-20;
    return (r->face == SLOW && e->face == SLOW + 1) || (r->face == SLOW + 1 && e->face == SLOW) ? 1
                                                                                                : 0;
}

/* Every pass changes a link, until the lamp's face is in 64 parts, among many links that do not
 * change (0) or few (1). While any changes the answer is not called converged, however few; and
 * while more than one in SETTLED do, passes are rough. */
START_TEST(test_converged)
{
    static const struct script script = {split_when_lit, doubling, 1};
    int sweeps[2], leaves = 0;
    struct scene scene;
    made_open(&scene);
    add_square(&scene, 1, 0.5, 0);
    add_square(&scene, 1, 0, 16);
    add_square(&scene, 1, 0.9375, 0.01);
    add_square(&scene, 1, 0.9375, 0.01);
    uint32_t grey = made_material(&scene, 0.5, 0);
    for (int i = 0; i < 40; i++)
        made_quad(&scene, grey, 4.0 * scene.face_count, 0, 0, 3, 0, 0, 0, 3, 0);
    if (_i == 1)
        scene.face_count = PASSERS_BY + 2;
    struct solve s;
    struct refiner refiner;
    open_solve(&s, &scene, &script, &refiner, options(1e-9, RAD_SOLVER_GAUSS_SEIDEL));
    ck_assert((s.refinement.link_count > SETTLED) == (_i == 0));
    const char *cause;
    ck_assert_int_eq(solve_step(&s, &cause), 1);
    ck_assert_uint_eq(s.report.changing, 1);
    ck_assert_int_eq(s.report.converged, 0);
    sweeps[0] = s.report.sweeps;
    int more = solve_step(&s, &cause);
    sweeps[1] = s.report.sweeps - sweeps[0];
    ck_assert_int_eq(more, 1);
    ck_assert_uint_eq(s.report.changing, 4);
    ck_assert_int_eq(s.report.converged, 0);
    printf("%zu links: %d sweeps, then %d\n", s.refinement.link_count, sweeps[0], sweeps[1]);
    ck_assert((sweeps[1] > sweeps[0]) == (_i == 0));
    while ((more = solve_step(&s, &cause)) > 0)
        ck_assert_int_eq(s.report.converged, 0);
    ck_assert_int_eq(more, 0);
    ck_assert_int_eq(s.report.converged, 1);
    ck_assert_uint_eq(s.report.changing, 0);
    for (uint32_t i = 0; i < s.hierarchy.count; i++) {
        const struct element *e = &s.hierarchy.elements[i];
        if (!e->vertices || e->children || e->face != 0)
            continue;
        ck_assert_int_eq(e->depth, 3);
        ck_assert_double_eq_tol(s.state.radiosity[i], 8, 1e-8);
        leaves++;
    }
    ck_assert_int_eq(leaves, 64);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

static int cancel(void *context, const struct solve *s, const char *phase)
{
    (void)s;
    return strcmp(phase, context) == 0;
}

/* A progress function that says so ends the solve in any phase. */
START_TEST(test_cancel)
{
    static const struct script script = {NULL, each_other, 0};
    static char phase[3][8] = {"refine", "solve", "matrix"};
    struct solve_options how = options(1e-6, _i == 2 ? RAD_SOLVER_LU : RAD_SOLVER_GAUSS_SEIDEL);
    struct refiner refiner = scripted(&script);
    const char *cause = NULL;
    mutual = 1;
    how.progress = cancel;
    how.context = phase[_i];
    struct scene scene;
    made_open(&scene);
    add_square(&scene, 1, 0.5, 1);
    add_square(&scene, 1, 0.5, 1);
    struct solve s;
    ck_assert_int_eq(solve_open(&s, &scene, &how, &cause), 0);
    ck_assert_int_eq(solve_run(&s, &refiner, &cause), -1);
    ck_assert_str_eq(cause, "cancelled");
    ck_assert_int_eq(s.report.cancelled, 1);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("transport");
    TCase *c = tcase_create("transport");
    tcase_add_test(c, test_cap);
    tcase_add_loop_test(c, test_group_cap, 0, 3);
    tcase_add_test(c, test_stands);
    tcase_add_loop_test(c, test_stop, 0, 2);
    tcase_add_loop_test(c, test_tenth, 0, 4);
    tcase_add_test(c, test_stop_small);
    tcase_add_loop_test(c, test_dense, 0, 4);
    tcase_add_test(c, test_rough);
    tcase_add_loop_test(c, test_converged, 0, 2);
    tcase_add_loop_test(c, test_cancel, 0, 3);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
