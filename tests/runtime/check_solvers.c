/* check_solvers.c - Jacobi, Gauss-Seidel, Southwell and LU give one answer over the same links.
 *
 * Each scene is refined and solved once; then every solver starts anew over those links. LU, which
 * does not iterate, is what the others are held against, and a direct sum over the links of the
 * leaves says that it is right itself.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include "engine/dense.h"
#include "engine/southwell.h"
#include "engine/transport.h"
#include "runtime/make_solve.h"
#include "suite.h"

enum { SOLVERS = 5 };
static const char *const solver_names[SOLVERS] = {"Gauss-Seidel", "Jacobi", "Southwell", "LU",
                                                  "PETSc"};

/* ---- scenes: what each must hold is asserted where it is used */

static void tinted(struct scene *s, uint32_t material, double red, double green, double blue)
{
    struct RadMaterial *m = &s->materials[material];
    m->reflectance[0] *= red;
    m->reflectance[1] *= green;
    m->reflectance[2] *= blue;
    m->exitance[0] *= blue;
    m->exitance[2] *= red;
    s->bands = 3;
}

static void furnished_grey(struct scene *s)
{
    furnished(s, 1);
}

static void furnished_tinted(struct scene *s)
{
    furnished(s, 1);
    tinted(s, 0, 1.5, 1, 0.2);
    tinted(s, 1, 0.5, 1, 2);
    tinted(s, 2, 0, 1, 3);
}

/* The same with two crowds of little boxes on the floor, grids of faces. */
static void crowded(struct scene *s)
{
    furnished_tinted(s);
    for (int i = 0; i < 18; i++) {
        double x = i % 2 ? 0.3 : 3.2, y = 0.5 + 0.25 * (i / 6), z = 0.2 + 0.3 * (i / 2 % 3);
        made_quad(s, 0, x, y, z, 0, 0.1, 0, 0.1, 0, 0);
        made_quad(s, 2, x, y, z + 0.1, 0.1, 0, 0, 0, 0.1, 0);
        made_quad(s, 0, x, y, z, 0.1, 0, 0, 0, 0, 0.1);
        made_quad(s, 2, x, y, z, 0, 0, 0.1, 0, 0.1, 0);
    }
}

/* A bright cube: rows above 1 near its edges. */
static void bright_cube(struct scene *s)
{
    furnace_cube(s, 0.97);
    s->faces[0].material = made_material(s, 0.9, 40);
}

static const struct test_case {
    const char *name;
    void (*make)(struct scene *s);
    const char *oracle;
    char *settings[4];
    enum RadClosure closure;
    enum RadProjection projection;
    /* what the links must hold for the case to say anything: rows that the cap cuts, leaves that
     * are covered, links of clusters, parts of faces among their ends */
    int capped, covered, clusters, parts;
    double tolerance; /* relative; links of clusters are of floats */
    double agree;     /* the same, of any leaf */
} cases[] = {
    {"grey",
     furnished_grey,
     "bf_guarded",
     {"min_share=2e-3"},
     RAD_CLOSURE_NONE,
     RAD_PROJECTION_GALERKIN,
     1,
     1,
     0,
     0,
     1e-13,
     1e-12},
    {"bright",
     bright_cube,
     "bf_guarded",
     {"relative=0.1", "min_share=5e-3"},
     RAD_CLOSURE_NONE,
     RAD_PROJECTION_GALERKIN,
     1,
     0,
     0,
     0,
     1e-13,
     1e-12},
    {"three bands",
     furnished_tinted,
     "bf_guarded",
     {"min_share=2e-3"},
     RAD_CLOSURE_NONE,
     RAD_PROJECTION_GALERKIN,
     1,
     1,
     0,
     0,
     1e-13,
     1e-12},
    {"closed rows",
     furnished_tinted,
     "bf_guarded",
     {"min_share=2e-3"},
     RAD_CLOSURE_ROWS,
     RAD_PROJECTION_GALERKIN,
     0,
     1,
     0,
     0,
     1e-13,
     1e-12},
    {"collocation",
     furnished_tinted,
     "bf_guarded",
     {"min_share=2e-3"},
     RAD_CLOSURE_NONE,
     RAD_PROJECTION_COLLOCATION,
     1,
     1,
     0,
     0,
     1e-13,
     1e-12},
    {"clusters",
     crowded,
     "clusters",
     {"min_share=8e-4"},
     RAD_CLOSURE_NONE,
     RAD_PROJECTION_GALERKIN,
     1,
     1,
     1,
     1,
     1e-6,
     1e-6},
    {"clusters, closed rows, collocation",
     crowded,
     "clusters",
     {"min_share=8e-4"},
     RAD_CLOSURE_ROWS,
     RAD_PROJECTION_COLLOCATION,
     0,
     1,
     1,
     1,
     1e-6,
     1e-6},
};
enum { CASES = sizeof cases / sizeof *cases };

static int is_leaf(const struct solve *s, uint32_t e)
{
    return s->hierarchy.elements[e].vertices && !s->hierarchy.elements[e].children;
}

static void assert_holds(const struct test_case *t, const struct solve *s)
{
    const struct element *elements = s->hierarchy.elements;
    int capped = 0, covered = 0, parts = 0;
    for (uint32_t i = 0; i < s->hierarchy.count; i++) {
        capped += is_leaf(s, i) && (s->operator.row_scale[i]<1 || s->operator.row_above[i]<1);
        covered += is_leaf(s, i) && s->operator.uncovered[i]<1;
    }
    for (size_t i = 0; i < s->refinement.link_count; i++) {
        const struct element *r = &elements[s->refinement.links[i].receiver],
                             *e = &elements[s->refinement.links[i].emitter];
        parts += (!r->vertices && e->depth > 0) || (!e->vertices && r->depth > 0);
    }
    printf("%s: %u leaves, %d rows cut, %d leaves covered, %zu links of clusters, %d to parts\n",
           t->name, (unsigned)dense_leaves(&s->hierarchy), capped, covered,
           s->operator.separable.count, parts);
    ck_assert(!t->capped || capped > 0);
    ck_assert(!t->covered || covered > 0);
    ck_assert(!t->clusters || s->operator.separable.count> 0);
    ck_assert(!t->parts || parts > 0);
}

static void open_case(const struct test_case *t, struct scene *scene, struct solve *s)
{
    struct solve_options how = quick(1);
    how.closure = t->closure == RAD_CLOSURE_ROWS ? CLOSURE_ROWS : CLOSURE_NONE;
    how.projection = t->projection;
    t->make(scene);
    solve_with(s, scene, t->oracle, RELEASE_FLAT, t->settings, how);
    assert_holds(t, s);
}

/* ---- equations over the links of a solve */

/* From B = E, to that tolerance. */
static struct transport fresh(const struct solve *s, double tolerance)
{
    uint32_t b = s->problem.bands, count = s->hierarchy.count;
    struct transport x = {.bands = b,
                          .value = calloc((size_t)count * b, sizeof(double)),
                          .irradiance = calloc((size_t)count * b, sizeof(double)),
                          .source = s->problem.exitance,
                          .reflectance = s->problem.reflectance,
                          .tolerance = tolerance};
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < b && s->hierarchy.elements[i].vertices; k++)
            x.value[(size_t)i * b + k] =
                s->problem.exitance[(size_t)s->hierarchy.elements[i].face * b + k];
    return x;
}

static void discard(struct transport *x)
{
    free(x->value);
    free(x->irradiance);
}

static double largest_value(const struct solve *s, const struct transport *x)
{
    double most = 0;
    for (size_t i = 0; i < (size_t)s->hierarchy.count * x->bands; i++)
        most = fmax(most, x->value[i]);
    return most;
}

/* The largest difference of two solutions on surfaces, over the largest value. */
static double apart(const struct solve *s, const struct transport *x, const struct transport *y)
{
    double most = 0;
    for (uint32_t i = 0; i < s->hierarchy.count; i++)
        for (uint32_t k = 0; k < x->bands && s->hierarchy.elements[i].vertices; k++)
            most = fmax(most, fabs(x->value[(size_t)i * x->bands + k]
                                   - y->value[(size_t)i * x->bands + k]));
    return most / largest_value(s, x);
}

/* All that there are, from B = E. */
static void compare_solvers(const struct test_case *t, struct solve *s,
                            const struct transport *known)
{
    for (int i = 0; i < SOLVERS && radHasSolver((enum RadSolver)i); i++) {
        struct transport x = fresh(s, t->tolerance);
        s->problem.options.solver = (enum RadSolver)i;
        ck_assert_int_eq(transport_solve(&s->operator, & x), 0);
        double off = apart(s, &x, known);
        printf("    %-12s %3d sweeps, off by %.1e, bound %.1e\n", solver_names[i], x.sweeps, off,
               x.bound);
        ck_assert_double_le(off, t->agree);
        ck_assert_int_eq(x.converged, 1);
        if (i == RAD_SOLVER_LU) /* nothing is left to iterate */
            ck_assert_int_le(x.sweeps, 2);
        discard(&x);
    }
}

/* A tolerance below what doubles resolve ends where they do, not after all sweeps that are allowed.
 */
static void below_rounding(const struct test_case *t, struct solve *s,
                           const struct transport *known)
{
    for (int i = 0; i < SOLVERS && radHasSolver((enum RadSolver)i); i++) {
        struct transport x = fresh(s, 1e-19);
        s->problem.options.solver = (enum RadSolver)i;
        ck_assert_int_eq(transport_solve(&s->operator, & x), 0);
        printf("    %-12s %3d sweeps to 1e-19, bound %.1e\n", solver_names[i], x.sweeps, x.bound);
        ck_assert_int_eq(x.converged, 1);
        ck_assert_int_lt(x.sweeps, 20000);
        ck_assert_double_le(apart(s, &x, known), t->agree);
        discard(&x);
    }
}

/* Shots alone, from B = E with all of it unshot, and no sweep, come as near as they are asked to;
 * and with sweeps so does Southwell's method from another light, where shots take away as well. */
static void try_shots(const struct test_case *t, struct solve *s, const struct transport *known)
{
    struct transport x = fresh(s, t->tolerance), nothing = x;
    struct southwell *shooter = southwell_new(&s->operator, & x);
    double *before = calloc((size_t)s->hierarchy.count * x.bands, sizeof *before);
    ck_assert_ptr_nonnull(shooter);
    nothing.value = before;
    southwell_keep(shooter, &s->operator, & nothing);
    ck_assert_int_eq(southwell_shoot(shooter, &s->operator, & x, 10 / t->tolerance, 100000), 0);
    printf("    %d sweeps of shots, off by %.1e\n", x.sweeps, apart(s, &x, known));
    ck_assert_double_le(apart(s, &x, known), t->agree);
    ck_assert_int_ge(x.sweeps, 3);
    southwell_free(shooter);
    free(before);

    s->problem.options.solver = RAD_SOLVER_SOUTHWELL;
    for (uint32_t i = 0; i < s->hierarchy.count * x.bands; i++)
        x.value[i] *= 1 + 0.5 * ((i / 7) % 3);
    ck_assert_int_eq(transport_solve(&s->operator, & x), 0);
    ck_assert_double_le(apart(s, &x, known), t->agree);
    discard(&x);
}

/* sum A |B - known| over leaves (W); B = E + rho H must hold of it. */
static double power_off(const struct solve *s, const struct transport *x,
                        const struct transport *known)
{
    double off = 0;
    for (uint32_t e = 0; e < s->hierarchy.count; e++)
        for (uint32_t k = 0; k < x->bands && is_leaf(s, e); k++) {
            size_t at = (size_t)e * x->bands + k,
                   of = (size_t)s->hierarchy.elements[e].face * x->bands + k;
            double uncovered = s->operator.uncovered[e], b = x->value[at];
            off += s->hierarchy.elements[e].area * uncovered * fabs(b - known->value[at]);
            if (uncovered > 0)
                ck_assert_double_le(
                    fabs(x->source[of] + x->reflectance[of] * x->irradiance[at] / uncovered - b),
                    1e-12 * b);
        }
    return off;
}

/* A solve that is cut short is nearer to the answer with the ambient estimate than a sweep is; and
 * the estimate is gone once the solve goes on. */
static void cut_short(const struct test_case *t, struct solve *s, const struct transport *known)
{
    int most = s->problem.options.iterations;
    double off[2];
    for (int i = 0; i < 2; i++) {
        struct transport x = fresh(s, t->tolerance);
        s->problem.options.solver = i ? RAD_SOLVER_SOUTHWELL : RAD_SOLVER_JACOBI;
        s->problem.options.iterations = 1;
        ck_assert_int_eq(transport_solve(&s->operator, & x), 0);
        ck_assert_int_eq(x.converged, 0);
        off[i] = power_off(s, &x, known);
        s->problem.options.iterations = most;
        ck_assert_int_eq(transport_solve(&s->operator, & x), 0);
        ck_assert_double_le(apart(s, &x, known), t->agree);
        discard(&x);
    }
    printf("    after one sweep off by %.3g W, with the ambient estimate by %.3g W\n", off[0],
           off[1]);
    ck_assert_double_le(off[1], 0.5 * off[0]);
}

START_TEST(test_solvers)
{
    const struct test_case *t = &cases[_i];
    struct scene scene;
    struct solve s;
    open_case(t, &scene, &s);
    struct transport known = fresh(&s, 0);
    ck_assert_int_eq(dense_solve(&s.operator, & known), 0);
    compare_solvers(t, &s, &known);
    below_rounding(t, &s, &known);
    try_shots(t, &s, &known);
    cut_short(t, &s, &known);
    discard(&known);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* A cube that reflects .999, one wall of it brighter: sweeps alone take thousands, each a
 * thousandth of what is left; guesses of what they come to spare nearly all. Also from so much
 * light that it shrinks about as fast as changes do: the two over each other hardly shrink. */
START_TEST(test_slow)
{
    struct scene scene;
    struct solve s;
    char *settings[] = {"min_share=5e-3", NULL};
    furnace_cube(&scene, 0.999);
    scene.faces[0].material = made_material(&scene, 0.999, 40);
    solve_with(&s, &scene, "bf_guarded", RELEASE_FLAT, settings, quick(1));
    struct transport known = fresh(&s, 0), x = fresh(&s, 1e-6);
    double off = 0, all = 0;
    ck_assert_int_eq(dense_solve(&s.operator, & known), 0);
    for (uint32_t i = 0; _i > 0 && i < s.hierarchy.count; i++)
        x.value[i] = _i * 100 * known.value[i];
    ck_assert_int_eq(transport_solve(&s.operator, & x), 0);
    for (uint32_t i = 0; i < s.hierarchy.count; i++)
        if (s.hierarchy.elements[i].vertices && !s.hierarchy.elements[i].children) {
            off += s.hierarchy.elements[i].area * fabs(x.value[i] - known.value[i]);
            all += s.hierarchy.elements[i].area * known.value[i];
        }
    printf("from %d times the light %d sweeps, bound %.1e, off by %.1e\n", _i * 100, x.sweeps,
           x.bound, off / all);
    ck_assert_int_eq(x.converged, 1);
    ck_assert_double_le(off, x.bound * all);
    ck_assert_int_lt(x.sweeps, 60);
    discard(&known);
    discard(&x);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* The same bits by any number of threads, Southwell's and LU's whole solves. */
START_TEST(test_threads)
{
    struct scene scene;
    struct solve one, other;
    struct solve_options how = quick(1), more = quick(3);
    how.solver = more.solver = _i % 2 ? RAD_SOLVER_LU : RAD_SOLVER_SOUTHWELL;
    how.projection = more.projection = (enum RadProjection)(_i / 2);
    char *settings[] = {"min_share=8e-4", NULL};
    crowded(&scene);
    solve_with(&one, &scene, "clusters", RELEASE_FLAT, settings, how);
    solve_with(&other, &scene, "clusters", RELEASE_FLAT, settings, more);
    same_links(&one, &other);
    ck_assert(
        memcmp(one.state.radiosity, other.state.radiosity, one.hierarchy.count * 3 * sizeof(double))
        == 0);
    solve_close(&one);
    solve_close(&other);
    made_close(&scene);
}
END_TEST

/* More leaves than a matrix is made for: said at once of faces, and as soon as refinement comes to
 * it of parts. */
START_TEST(test_too_many)
{
    struct scene scene;
    struct solve s;
    struct solve_options how = quick(2);
    const char *cause = "";
    how.solver = RAD_SOLVER_LU;
    furnished(&scene, 1);
    struct refiner *r = oracles_open("bf_guarded", RELEASE_FLAT);
    char *fine[] = {"relative=0.01"};
    ck_assert_int_eq(oracles_set(r, fine, 1), 0);
    ck_assert_int_eq(solve_open(&s, &scene, &how, &cause), 0);
    ck_assert_int_eq(solve_refine(&s, r, &cause), -1);
    printf("%s\n", cause);
    ck_assert_ptr_nonnull(strstr(cause, "LU solves for at most 5000 leaves"));
    ck_assert_ptr_nonnull(strstr(cause, "coarser oracle parameters"));
    solve_close(&s);
    refiner_close(r);
    made_close(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("solvers");
    TCase *c = tcase_create("solvers");
    tcase_set_timeout(c, 60);
    tcase_add_loop_test(c, test_solvers, 0, CASES);
    tcase_add_loop_test(c, test_slow, 0, 2);
    tcase_add_loop_test(c, test_threads, 0, 4);
    tcase_add_test(c, test_too_many);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
