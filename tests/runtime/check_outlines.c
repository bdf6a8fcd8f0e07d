/* check_outlines.c - surfaces made of many faces stand between as their outlines say.
 * What a point sees of a square past meshes by their outlines is what it sees when each face is cut
 * out by itself. A mesh hides all of a shaft when rays say so, and a hole in it is found; scenes of
 * curved meshes are closed.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include "engine/exchange.h"
#include "engine/sight_outlines.h"
#include "kernel/lambert.h"
#include "kernel/shaft.h"
#include "runtime/chance.h"
#include "runtime/two_squares.h"
#include "suite.h"
#include "terms/visibility.h"
#include "util/array.h"
#include "util/oracles.h"
#include "visibility/candidates.h"
#include "visibility/hidden.h"

/* A corner of an octahedron's face cut into m x m, on the sphere around c, bent by `dent`. */
static void on_sphere(double p[3], const double c[3], double radius, double dent, const int at[3],
                      const int sign[3])
{
    double v[3], size = 0;
    for (int k = 0; k < 3; k++) {
        v[k] = sign[k] * at[k];
        size += v[k] * v[k];
    }
    size = sqrt(size);
    double r = radius * (1 + dent * sin(5 * v[0] / size) * cos(4 * v[2] / size));
    for (int k = 0; k < 3; k++)
        p[k] = c[k] + r * v[k] / size;
}

/* A triangulated ball of 8 m m faces, front outside; those numbered gap[] are left out. */
static void add_ball(struct scene *s, const double c[3], double radius, double dent, int m,
                     const int gap[2])
{
    int number = 0;
    for (int octant = 0; octant < 8; octant++) {
        const int sign[3] = {octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1};
        for (int i = 0; i < m; i++)
            for (int j = 0; j < m - i; j++)
                for (int upper = 0; upper < 1 + (i + j < m - 1); upper++, number++) {
                    const int at[2][3][3] = {
                        {{i, j, m - i - j}, {i + 1, j, m - i - j - 1}, {i, j + 1, m - i - j - 1}},
                        {{i + 1, j, m - i - j - 1},
                         {i + 1, j + 1, m - i - j - 2},
                         {i, j + 1, m - i - j - 1}}};
                    double p[3][3];
                    int flip = sign[0] * sign[1] * sign[2] < 0;
                    for (int k = 0; k < 3; k++)
                        on_sphere(p[flip ? 2 - k : k], c, radius, dent, at[upper][k], sign);
                    if (number != gap[0] && number != gap[1])
                        made_face(s, 0, 3, (const double(*)[3])p);
                }
    }
}

static const int no_gap[2] = {-1, -1};

/* The lower square looking at the upper one past what stands between, both ways. */
struct look {
    struct exchange_tree t;
    const struct element *low;
    uint32_t list[SIGHT_LIST];
    int count;
    struct sight sight;
    struct sight_between between;
};

static void look_open(struct look *l, const struct scene *s)
{
    struct shaft shaft;
    struct polygon whole = {.n = 4};
    open_tree(&l->t, s);
    l->low = face_of(&l->t, 0);
    const struct element *high = face_of(&l->t, 1);
    memcpy(whole.v, high->vertex, 4 * sizeof *whole.v);
    ck_assert(shaft_open(&shaft, l->low, high, &l->t.host));
    l->count = candidates_find(&l->t.h, &shaft, l->t.host.ray_offset, SIGHT_LIST, l->list);
    ck_assert_int_le(l->count, SIGHT_CUT);
    qsort(l->list, (size_t)l->count, sizeof *l->list, compare_words);
    sight_open(&l->sight, high, &whole, l->t.host.ray_offset);
    ck_assert_int_eq(sight_between_find(&l->between, &l->t, &shaft, l->list, l->count, 0),
                     BETWEEN_SOME);
    ck_assert_int_eq(sight_between_place(&l->between, &l->t, &l->sight), 0);
}

static double look_by_outlines(struct look *l, const double x[3], double *clear)
{
    return sight_past(&l->sight, x, l->low->normal, l->t.host.ray_offset, &l->between, clear);
}

/* Past the first `count` of them. */
static double look_by_faces(const struct look *l, const double x[3], int count, double *clear)
{
    return sight_factor(&l->sight, x, l->low->normal, l->t.host.ray_offset, &l->t, l->list, count,
                        clear);
}

/* Two squares above each other and what chance puts between: one smooth ball, dented ones, a box
 * and loose triangles, which may cross; both ways to see the upper one from points of the lower
 * one. */
START_TEST(test_both_ways)
{
    static struct look l;
    uint64_t state = (uint64_t)_i;
    double most = 0, partial = 0, points = 0;
    for (int scene = 0; scene < 12; scene++) {
        struct scene s;
        open_squares(&s);
        for (int ball = 0; ball <= scene % 3; ball++) {
            const double c[3] = {chance(&state), chance(&state), 0.3 + 0.4 * chance(&state)};
            add_ball(&s, c, 0.1 + 0.15 * chance(&state), ball ? 0.3 : 0, scene % 3 ? 2 : 4, no_gap);
        }
        for (int loose = 0; loose < scene; loose++) {
            double p[3][3];
            for (int i = 0; i < 9; i++)
                p[i / 3][i % 3] = i % 3 == 2 ? 0.1 + chance(&state) : chance(&state);
            made_face(&s, 0, 3, (const double(*)[3])p);
        }
        look_open(&l, &s);
        for (int i = 0; i < 40; i++) {
            const double x[3] = {chance(&state), chance(&state), 0};
            double clear[2], by_outlines = look_by_outlines(&l, x, &clear[0]),
                             by_faces = look_by_faces(&l, x, l.count, &clear[1]),
                             past_none = look_by_faces(&l, x, 0, &clear[1]);
            ck_assert_double_eq(clear[0], past_none);
            ck_assert_double_eq(clear[1], past_none);
            most = fmax(most, fabs(by_outlines - by_faces));
            partial += by_faces < 0.999 * past_none;
            points++;
        }
        exchange_tree_close(&l.t);
        made_close(&s);
    }
    ck_assert_double_gt(partial, 0.5 * points);
    ck_assert_double_lt(most, 1e-9);
}
END_TEST

/* Does the way from a to b run through a triangle? By the volumes that it spans with its sides. */
static int runs_through(const double a[3], const double b[3], const double (*v)[3])
{
    double along[3], to[3][3], n[3], e[3], f[3], over[2];
    sub3(along, b, a);
    sub3(e, v[1], v[0]);
    sub3(f, v[2], v[0]);
    cross3(n, e, f);
    for (int i = 0; i < 3; i++)
        sub3(to[i], v[i], a);
    sub3(e, b, v[0]);
    over[0] = -dot3(n, to[0]);
    over[1] = dot3(n, e);
    int sides = 0;
    for (int i = 0; i < 3; i++) {
        cross3(e, to[i], to[(i + 1) % 3]);
        sides += dot3(e, along) > 0;
    }
    return (over[0] > 0) != (over[1] > 0) && (sides == 0 || sides == 3);
}

/* What a point sees of a square past up to 30 loose triangles, which are small and large, cross,
 * hide each other, stand beside the square or reach under it: in whatever order they are listed,
 * and as ways to a grid of points of the square say one by one. */
START_TEST(test_loose)
{
    enum { GRID = 120 };
    uint64_t state = 1000 + (uint64_t)_i;
    double whole, most_order = 0, most_ways = 0, sum_ways = 0, partial = 0, points = 0;
    for (int scene = 0; scene < 10; scene++) {
        struct scene s;
        struct exchange_tree t;
        open_squares(&s);
        const int loose = 3 * (scene + 1);
        for (int i = 0; i < loose; i++) {
            const double size = 0.1 + 0.5 * chance(&state) * chance(&state);
            double p[3][3], c[3];
            for (int k = 0; k < 3; k++)
                c[k] = k < 2 ? 1.6 * chance(&state) - 0.3 : 0.2 + 0.8 * chance(&state);
            for (int k = 0; k < 9; k++)
                p[k / 3][k % 3] = c[k % 3] + size * (chance(&state) - 0.5);
            made_face(&s, 0, 3, (const double(*)[3])p);
        }
        open_tree(&t, &s);
        const struct element *low = face_of(&t, 0), *high = face_of(&t, 1);
        uint32_t list[30], mixed[30];
        struct sight sight;
        struct polygon part = {.n = 4};
        memcpy(part.v, high->vertex, 4 * sizeof *part.v);
        sight_open(&sight, high, &part, t.host.ray_offset);
        for (int i = 0; i < loose; i++)
            mixed[i] = list[i] = t.h.face_element[i + 2];
        for (int i = loose - 1; i > 0; i--) {
            const int j = (int)((i + 1) * chance(&state));
            const uint32_t swap = mixed[i];
            mixed[i] = mixed[j];
            mixed[j] = swap;
        }
        for (int i = 0; i < 12; i++) {
            const double x[3] = {chance(&state), chance(&state), 0};
            double ways = 0;
            const double seen = sight_factor(&sight, x, low->normal, t.host.ray_offset, &t, list,
                                             loose, &whole),
                         again = sight_factor(&sight, x, low->normal, t.host.ray_offset, &t, mixed,
                                              loose, &whole);
            for (int k = 0; k < GRID * GRID; k++) {
                const double to[3] = {(k / GRID + 0.5) / GRID, (k % GRID + 0.5) / GRID, 1};
                double r[3];
                int stopped = 0;
                for (int f = 0; f < loose && !stopped; f++)
                    stopped = runs_through(x, to, (const double(*)[3])t.h.elements[list[f]].vertex);
                sub3(r, to, x);
                const double square = dot3(r, r);
                ways += stopped ? 0 : 1 / (square * square * LAMBERT_PI * GRID * GRID);
            }
            most_order = fmax(most_order, fabs(seen - again));
            most_ways = fmax(most_ways, fabs(seen - ways));
            sum_ways += fabs(seen - ways);
            partial += seen > 0 && seen < 0.999 * whole;
            points++;
        }
        exchange_tree_close(&t);
        made_close(&s);
    }
    ck_assert_double_gt(partial, 0.6 * points);
    ck_assert_double_lt(most_order, 1e-12);
    ck_assert_double_lt(most_ways, 1.5e-3);
    ck_assert_double_lt(sum_ways, 2.5e-4 * points);
}
END_TEST

/* Small squares on both sides of a ball: hidden behind its middle, not at its rim, nor through a
 * hole, with which the far side alone would hide. */
START_TEST(test_hidden)
{
    static const struct {
        double aside;
        int gap[2], hidden;
    } cases[] = {{0, {-1, -1}, 1},   {0.1, {-1, -1}, 1}, {0.3, {-1, -1}, 0},
                 {0.5, {-1, -1}, 0}, {0, {1, -1}, 0},    {0, {1, 257}, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct scene s;
        struct exchange_tree t;
        struct shaft shaft;
        uint32_t list[16];
        const double c[3] = {0, 0, 1}, d = cases[i].aside;
        made_open(&s);
        made_material(&s, 0.5, 0);
        made_quad(&s, 0, d, d, 0, .05, 0, 0, 0, .05, 0);
        made_quad(&s, 0, d, d, 2, 0, .05, 0, .05, 0, 0);
        add_ball(&s, c, 0.4, 0.05, 8, cases[i].gap);
        open_tree(&t, &s);
        ck_assert(shaft_open(&shaft, face_of(&t, 0), face_of(&t, 1), &t.host));
        int found = t.host.candidates(&t.host, &shaft, 16, list);
        ck_assert_int_eq(found == HOST_HIDDEN, cases[i].hidden);
        /* no ray gets through, whatever side says so */
        if (found == HOST_HIDDEN)
            ck_assert(visibility_rays(face_of(&t, 0), face_of(&t, 1), &t.host, 1024, 0) <= 0);
        exchange_tree_close(&t);
        made_close(&s);
    }
}
END_TEST

/* The unit cube from inside, each wall cut into 2 n n triangles. */
static void add_box(struct scene *s, int n)
{
    for (int wall = 0; wall < 6; wall++)
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n; j++) {
                double p[4][3], q[3][3];
                int axis = wall / 2;
                for (int k = 0; k < 4; k++) {
                    p[k][axis] = wall % 2;
                    p[k][(axis + 1) % 3] = (i + (k == 1 || k == 2)) / (double)n;
                    p[k][(axis + 2) % 3] = (j + (k >= 2)) / (double)n;
                }
                for (int half = 0; half < 2; half++) {
                    for (int k = 0; k < 3; k++)
                        memcpy(q[wall % 2 ? 2 - k : k], p[k ? k + half : 0], sizeof *q);
                    made_face(s, 0, 3, (const double(*)[3])q);
                }
            }
}

/* Opens the exchange of a scene, which is closed, to a tolerance of 3e-4: the first so many rows,
 * or all. */
static void open_exchange(struct exchange *x, const struct scene *s, uint32_t rows)
{
    const char *cause;
    struct refiner *refiner = oracles_open("viewfactors", RELEASE_FLAT);
    exchange_set_tolerance(refiner, 3e-4);
    const struct exchange_options options = {.tolerance = 3e-4, .threads = 1, .rows = rows};
    ck_assert_int_eq(exchange_open(x, s, refiner, &options, &cause), 0);
    ck_assert_uint_eq(x->report.rows_closed, rows ? rows : s->input_count);
    refiner_close(refiner);
}

/* Two balls, one dented, in a box of triangles: every row is 1. An entry may be off by the
 * tolerance times 4 over the root of 308 faces, 7e-5; about a hundred of a row are in half shadow,
 * which by chance makes ten times that, and three times so much is met once in 300 rows. */
START_TEST(test_closed)
{
    struct scene s;
    struct exchange x;
    const double c[2][3] = {{0.35, 0.4, 0.4}, {0.7, 0.65, 0.6}};
    made_open(&s);
    made_material(&s, 0.5, 0);
    add_box(&s, 3);
    add_ball(&s, c[0], 0.25, 0, 4, no_gap);
    add_ball(&s, c[1], 0.15, 0.3, 3, no_gap);
    open_exchange(&x, &s, 0);
    printf("two balls in a box: rows off by %.1e at the most\n", x.report.defect_most);
    ck_assert_double_lt(x.report.defect_most, 2e-3);
    exchange_close(&x);
    made_close(&s);
}
END_TEST

/* A ball of faces much smaller than the walls': hundreds stand between two of these, and yet its
 * outline is exact, so that no ray is cast and rows are 1 to the tolerance. */
START_TEST(test_many_between)
{
    struct scene s;
    struct exchange x;
    const double c[3] = {0.5, 0.45, 0.55};
    made_open(&s);
    made_material(&s, 0.5, 0);
    add_box(&s, 2);
    add_ball(&s, c, 0.25, 0, 12, no_gap);
    open_exchange(&x, &s, 0);
    printf("a fine ball in a box: rows off by %.1e at the most\n", x.report.defect_most);
    ck_assert_double_lt(x.report.defect_most, 3e-4);
    ck_assert_int_eq((int)x.report.rays, 0);
    exchange_close(&x);
    made_close(&s);
}
END_TEST

/* Four hundred slips between walls, with two sides, are more than points can look past; rays do, as
 * far as there are so many. Of a wall's row half is such, and 1,024 rays of a piece are off by less
 * than those of chance, .5 / 32 of it. */
START_TEST(test_crowd)
{
    enum { SLIPS = 400, WALLS = 12 };
    struct scene s;
    struct exchange x;
    uint64_t state = 7;
    made_open(&s);
    made_material(&s, 0.5, 0);
    add_box(&s, 1);
    for (int i = 0; i < SLIPS; i++) {
        double p[2][3][3];
        for (int k = 0; k < 3; k++) {
            const double at = 0.05 + 0.9 * chance(&state);
            for (int v = 0; v < 3; v++)
                p[0][v][k] = p[1][2 - v][k] = at + 0.05 * (chance(&state) - 0.5);
        }
        made_face(&s, 0, 3, (const double(*)[3])p[0]);
        made_face(&s, 0, 3, (const double(*)[3])p[1]);
        struct face *front = &s.faces[s.face_count - 2];
        front[0].input = front[1].input = WALLS + (uint32_t)i;
        front[1].back = 1;
    }
    s.input_count = WALLS + SLIPS;
    open_exchange(&x, &s, WALLS);
    printf("slips in a box: rows off by %.1e at the most, %llu rays\n", x.report.defect_most,
           (unsigned long long)x.report.rays);
    ck_assert_double_lt(x.report.defect_most, 1.5e-3);
    ck_assert_int_gt((int)x.report.rays, 0);
    exchange_close(&x);
    made_close(&s);
}
END_TEST

/* A disc of triangles with many corners, and a wall of triangles with a hole as round: what points
 * see past it, or through it, is what is left of the square without the disc, or what the disc
 * alone would be. Both ways hold a part with as many corners. */
START_TEST(test_round)
{
    static struct look l;
    const int corners[] = {40, 70, 100, 160}, n = corners[_i / 2], hole = _i % 2;
    const double size = 0.1, pi = acos(-1), at = 0.4;
    struct scene s;
    open_squares(&s);
    for (int i = 0; i < n; i++) {
        const double a[2] = {2 * pi * i / n, 2 * pi * (i + 1) / n}, far = 20 * size,
                     p[2][3] = {{0.5 + size * cos(a[0]), 0.5 + size * sin(a[0]), at},
                                {0.5 + size * cos(a[1]), 0.5 + size * sin(a[1]), at}},
                     disc[3][3] = {{0.5, 0.5, at}, {p[0][0], p[0][1], at}, {p[1][0], p[1][1], at}},
                     wall[4][3] = {{p[0][0], p[0][1], at},
                                   {0.5 + far * cos(a[0]), 0.5 + far * sin(a[0]), at},
                                   {0.5 + far * cos(a[1]), 0.5 + far * sin(a[1]), at},
                                   {p[1][0], p[1][1], at}};
        made_face(&s, 0, hole ? 4 : 3, hole ? wall : disc);
    }
    look_open(&l, &s);
    for (int k = 0; k < 9; k++) {
        const double x[3] = {0.45 + 0.05 * (k % 3), 0.45 + 0.05 * (k / 3), 0};
        double clear, disc = 0;
        for (int i = 0; i < n; i++) { /* which the square reaches beyond, from here */
            const double a[2] = {2 * pi * i / n, 2 * pi * (i + 1) / n},
                         g[2] = {0.5 + size * cos(a[0]) - x[0], 0.5 + size * sin(a[0]) - x[1]},
                         h[2] = {0.5 + size * cos(a[1]) - x[0], 0.5 + size * sin(a[1]) - x[1]};
            disc += lambert_edge(g[0], g[1], at, h[0], h[1], at, 0, 0, 1) / (2 * pi);
        }
        const double by_outlines = look_by_outlines(&l, x, &clear),
                     by_faces = look_by_faces(&l, x, l.count, &clear),
                     right = hole ? disc : clear - disc;
        ck_assert_double_eq_tol(by_outlines, right, 2e-6); /* points start off their surface */
        ck_assert_double_eq_tol(by_faces, right, 2e-6);
    }
    exchange_tree_close(&l.t);
    made_close(&s);
}
END_TEST

/* A sheet between: two eighths of a ring, of two triangles each, or a disc of `sectors`. */
static void add_sheet(struct scene *s, int sectors, double misfit, uint64_t *state)
{
    const double step = sectors ? 2 * acos(-1) / sectors : acos(-1) / 4;
    for (int i = 0; i < (sectors ? sectors : 4); i++) {
        const int half = sectors ? 0 : i % 2; /* of an eighth */
        const double from = step * (sectors ? i : i / 2), to = from + step,
                     inner = sectors ? 0 : 0.15, outer = sectors ? 0.15 : 0.3;
        const double angle[3] = {half ? to : from, from, to},
                     radius[3] = {inner, half ? inner : outer, outer};
        double p[3][3];
        for (int c = 0; c < 3; c++) {
            p[c][0] = 0.5 + radius[c] * cos(angle[c]) + misfit * (2 * chance(state) - 1);
            p[c][1] = 0.5 + radius[c] * sin(angle[c]) + misfit * (2 * chance(state) - 1);
            p[c][2] = 0.5;
        }
        made_face(s, 0, 3, (const double(*)[3])p);
    }
}

/* Its faces do not fit to the last digits where they meet: the middle of a part, which is on an
 * edge that two have, tells nothing. */
START_TEST(test_misfit)
{
    static struct look l;
    static const double misfit[] = {0, 1e-16, 1e-15, 1e-14, 1e-13, 1e-11, 1e-9, 1e-8};
    enum { MISFITS = sizeof misfit / sizeof *misfit };
    uint64_t state = 1;
    for (int i = 0; i < (under_sanitizers() ? 1 : 20) * MISFITS; i++) {
        struct scene s;
        open_squares(&s);
        add_sheet(&s, _i ? _i + 2 : 0, misfit[i % MISFITS], &state);
        look_open(&l, &s);
        for (int at = 0; at < 40; at++) {
            const double x[3] = {chance(&state), chance(&state), 0};
            double clear;
            const double by_outlines = look_by_outlines(&l, x, &clear),
                         by_faces = look_by_faces(&l, x, l.count, &clear);
            ck_assert_msg(fabs(by_outlines - by_faces) < 1e-6, "misfit %g: %g, %g",
                          misfit[i % MISFITS], by_outlines, by_faces);
        }
        exchange_tree_close(&l.t);
        made_close(&s);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("outlines");
    TCase *tests = tcase_create("outlines");
    tcase_set_timeout(tests, 120);
    suite_add_tcase(suite, tests);
    tcase_add_loop_test(tests, test_both_ways, 0, under_sanitizers() ? 1 : 3);
    tcase_add_loop_test(tests, test_loose, 0, under_sanitizers() ? 1 : 3);
    tcase_add_loop_test(tests, test_round, 0, under_sanitizers() ? 2 : 8);
    tcase_add_test(tests, test_hidden);
    tcase_add_loop_test(tests, test_misfit, 0, 7);
    tcase_add_test(tests, test_closed);
    if (!under_sanitizers()) { /* half a minute, of what the others do */
        tcase_add_test(tests, test_many_between);
        tcase_add_test(tests, test_crowd);
    }
    return suite_failures(suite);
}
