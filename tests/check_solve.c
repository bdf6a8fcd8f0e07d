/* check_solve.c - solutions against exact ones, and what must not change them: threads, releases, units.
 * Sources: furnace, plates and cube from closed forms and converged integral-equation solutions
 * (two parallel unit squares, two perpendicular unit squares, a cube with one emitting face).
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "defect.h"
#include "make_scene.h"
#include "oracles.h"
#include "solve.h"
#include "statistics.h"

static struct solve_options quick(int threads)
{
    struct solve_options o = { .tolerance = 1e-6, .iterations = 100000, .threads = threads };
    return o;
}

/* Solve with an oracle; settings end with NULL. */
static void solve_with(struct solve *s, const struct scene *scene, const char *oracle, enum release release,
                       char *const *settings, struct solve_options options)
{
    const char *cause;
    struct refiner *r = oracles_open(oracle, release);
    int n = 0;
    ck_assert_ptr_nonnull(r);
    while (settings && settings[n])
        n++;
    ck_assert_int_eq(oracles_set(r, settings, n), 0);
    ck_assert_int_eq(solve_open(s, scene, &options, &cause), 0);
    ck_assert_int_eq(solve_run(s, r, &cause), 0);
    ck_assert_int_eq(s->converged, 1);
    refiner_close(r);
}

static double face_radiosity(const struct solve *s, uint32_t face)
{
    return s->radiosity[(size_t)s->hierarchy.face_element[face] * s->bands];
}

static void same_links(const struct solve *a, const struct solve *b)
{
    ck_assert_uint_eq(a->refinement.link_count, b->refinement.link_count);
    ck_assert_uint_eq(a->hierarchy.count, b->hierarchy.count);
    ck_assert(memcmp(a->refinement.links, b->refinement.links, a->refinement.link_count * sizeof(struct link)) == 0);
}

/* Six faces, rho and E the same everywhere. */
static void furnace_cube(struct scene *s, double rho)
{
    uint32_t m[6];
    int i;
    made_open(s);
    m[0] = made_material(s, rho, 1);
    for (i = 1; i < 6; i++)
        m[i] = m[0];
    made_room(s, m, 1, 1, 1);
}

/* A hexagonal prism: two fans of triangles and six quads. */
static void furnace_prism(struct scene *s, double rho)
{
    int i;
    made_open(s);
    made_material(s, rho, 1);
    for (i = 0; i < 6; i++) {
        double a = M_PI / 3 * i, b = M_PI / 3 * (i + 1), h = 0.8;
        const double low[3][3] = { { 0, 0, 0 }, { cos(a), sin(a), 0 }, { cos(b), sin(b), 0 } };
        const double high[3][3] = { { 0, 0, h }, { cos(b), sin(b), h }, { cos(a), sin(a), h } };
        const double wall[4][3] = { { cos(b), sin(b), 0 }, { cos(a), sin(a), 0 }, { cos(a), sin(a), h }, { cos(b), sin(b), h } };
        made_face(s, 0, 3, low);
        made_face(s, 0, 3, high);
        made_face(s, 0, 4, wall);
    }
}

/* A regular octahedron from inside. */
static void furnace_octahedron(struct scene *s, double rho)
{
    int i;
    made_open(s);
    made_material(s, rho, 1);
    for (i = 0; i < 8; i++) {
        double x = i & 1 ? 1 : -1, y = i & 2 ? 1 : -1, z = i & 4 ? 1 : -1;
        const double out[3][3] = { { x, 0, 0 }, { 0, y, 0 }, { 0, 0, z } };
        const double in[3][3] = { { 0, y, 0 }, { x, 0, 0 }, { 0, 0, z } };
        made_face(s, 0, 3, x * y * z > 0 ? in : out);
    }
}

/* B = E / (1 - rho) in any closed shape, at the default parameters. */
START_TEST(test_furnace)
{
    static void (*const shape[3])(struct scene *, double) = { furnace_cube, furnace_prism, furnace_octahedron };
    static const char *const name[3] = { "cube", "prism", "octahedron" };
    static const double rho[3] = { 0.5, 0.9, 0.99 };
    static const char *const oracle[2] = { "bf_guarded", "bf" };
    struct scene scene;
    struct solve s;
    double worst = 0;
    uint32_t i;
    shape[_i % 3](&scene, rho[_i / 3 % 3]);
    solve_with(&s, &scene, oracle[_i / 9], RELEASE_FLAT, NULL, quick(2));
    for (i = 0; i < s.hierarchy.count; i++)
        if (s.hierarchy.elements[i].vertices)
            worst = fmax(worst, fabs(s.radiosity[i] * (1 - rho[_i / 3 % 3]) - 1));
    printf("furnace %s rho %.2f %s: worst element off by %.1e; rows %.4f to %.4f before the cap\n", name[_i % 3],
           rho[_i / 3 % 3], oracle[_i / 9], worst, s.row_low, s.row_high);
    ck_assert_double_le(worst, 1e-3);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* An L of two rooms, 2 x 1 and 1 x 1, that open into each other: walls hide parts of it from others. */
static void furnace_l(struct scene *s, double rho)
{
    uint32_t i;
    made_open(s);
    made_material(s, rho, 1);
    for (i = 0; i < 2; i++) {
        double y = i, x = i ? 1 : 2;
        made_quad(s, 0, 0, y, 0, x, 0, 0, 0, 1, 0);
        made_quad(s, 0, 0, y, 1, 0, 1, 0, x, 0, 0);
    }
    made_quad(s, 0, 0, 0, 0, 0, 0, 1, 2, 0, 0);
    made_quad(s, 0, 2, 0, 0, 0, 0, 1, 0, 1, 0);
    made_quad(s, 0, 2, 1, 0, 0, 0, 1, -1, 0, 0);
    made_quad(s, 0, 1, 1, 0, 0, 0, 1, 0, 1, 0);
    made_quad(s, 0, 1, 2, 0, 0, 0, 1, -1, 0, 0);
    made_quad(s, 0, 0, 2, 0, 0, 0, 1, 0, -2, 0);
}

/* A room with a box on its floor, which buries a part of it; the box has no bottom. */
static void furnace_box(struct scene *s, double rho)
{
    static const uint32_t m[6] = { 0 };
    made_open(s);
    made_material(s, rho, 1);
    made_room(s, m, 2, 1.5, 1);
    made_quad(s, 0, 0.7, 0.3, 0.6, 0.5, 0.1, 0, -0.1, 0.5, 0); /* turned against the walls, so that quarters do not fit it */
    made_quad(s, 0, 0.7, 0.3, 0, 0.5, 0.1, 0, 0, 0, 0.6);
    made_quad(s, 0, 1.2, 0.4, 0, -0.1, 0.5, 0, 0, 0, 0.6);
    made_quad(s, 0, 1.1, 0.9, 0, -0.5, -0.1, 0, 0, 0, 0.6);
    made_quad(s, 0, 0.6, 0.8, 0, 0.1, -0.5, 0, 0, 0, 0.6);
}

/* With its rows closed a furnace is right in every element that is not buried, and loses no power; without, the defect
 * that closure removes is there. */
START_TEST(test_closed_furnace)
{
    static void (*const shape[5])(struct scene *, double) = { furnace_cube, furnace_prism, furnace_octahedron, furnace_l, furnace_box };
    static const char *const name[5] = { "cube", "prism", "octahedron", "L", "box in a room" };
    struct scene scene;
    double worst[2] = { 0, 0 }, balance[2];
    uint32_t i;
    int closed;
    shape[_i](&scene, 0.99);
    for (closed = 0; closed < 2; closed++) {
        struct solve s;
        struct solve_options options = quick(1);
        options.tolerance = 1e-5;
        options.closure = closed ? CLOSURE_ROWS : CLOSURE_NONE;
        solve_with(&s, &scene, "bf_guarded", RELEASE_FLAT, NULL, options);
        for (i = 0; i < s.hierarchy.count; i++)
            if (s.hierarchy.elements[i].vertices && s.exposed[i] > 0)
                worst[closed] = fmax(worst[closed], fabs(s.radiosity[i] * 0.01 - 1));
        balance[closed] = s.absorbed / s.emitted - 1;
        if (closed) {
            printf("furnace %s rho 0.99: worst element off by %.1e closed, %.1e without; power by %.1e, %.1e; |row - 1| %.4f "
                   "in the mean, %.4f at the most; blind %.1e m2\n", name[_i], worst[1], worst[0], balance[1],
                   balance[0], s.row_defect, s.row_defect_most, s.row_blind);
            ck_assert_int_eq(s.closed, 1);
            ck_assert_double_gt(s.row_defect, 1e-3);
        }
        solve_close(&s);
    }
    ck_assert_double_le(worst[1], 1e-4);
    ck_assert_double_le(fabs(balance[1]), 1e-4);
    if (_i >= 3)
        ck_assert_double_gt(worst[0], 1e-3);
    made_close(&scene);
}
END_TEST

/* In an open scene closure only takes: no row is scaled up, and B is nowhere above what it is without. A hole in
 * the roof, and a roof whose black back is seen, are both openings. */
START_TEST(test_open_closure)
{
    static char *settings[] = { "relative=0.2", NULL };
    struct scene scene;
    struct solve s;
    struct solve_options options = quick(2);
    uint32_t i;
    options.closure = CLOSURE_ROWS;
    furnace_cube(&scene, 0.9);
    if (_i == 0) /* the roof leaves a slit of 2 % */
        scene.faces[1].vertex[2][0] = scene.faces[1].vertex[3][0] = 0.98;
    else if (_i == 1) { /* a partition that turns its back on half of the room */
        made_quad(&scene, 0, 0.5, 0.2, 0.2, 0, 0.5, 0, 0, 0, 0.5);
    } else /* nothing but a plate and another */
        scene.face_count = scene.input_count = 2;
    solve_with(&s, &scene, "bf_guarded", RELEASE_FLAT, settings, options);
    ck_assert_int_eq(s.closed, 0);
    for (i = 0; i < s.hierarchy.count; i++) {
        if (!s.hierarchy.elements[i].vertices || s.hierarchy.elements[i].children)
            continue;
        ck_assert_double_le(s.row_scale[i], 1);
        ck_assert(s.row_gift[i] == 0);
    }
    ck_assert_double_le(s.absorbed, s.emitted);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Half of a wall is lit: its spread and that of all above it are the difference, the spread of leaves is nothing. */
START_TEST(test_spread)
{
    static char *settings[] = { "relative=0.1", NULL };
    struct scene scene;
    struct solve s;
    uint32_t i;
    furnace_l(&scene, 0.5);
    scene.faces[2].material = scene.faces[3].material = made_material(&scene, 0.7, 0);
    solve_with(&s, &scene, "bf_guarded", RELEASE_FLAT, settings, quick(2));
    for (i = 0; i < s.hierarchy.count; i++) {
        const struct element *e = &s.hierarchy.elements[i];
        double low = INFINITY, high = -INFINITY;
        uint32_t j;
        for (j = i; j < s.hierarchy.count; j++) { /* leaves below i, by their ancestors */
            uint32_t up = j;
            if (s.hierarchy.elements[j].children)
                continue;
            while (up > i)
                up = s.hierarchy.elements[up].parent;
            if (up != i)
                continue;
            low = fmin(low, s.radiosity[j]);
            high = fmax(high, s.radiosity[j]);
        }
        ck_assert_double_le(fabs(e->spread - (high - low)), 0.0201 * (high - low) + 1e-6 * high);
    }
    ck_assert_double_gt(s.hierarchy.elements[0].spread, 0.5);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* A cube, ceiling E = 1, rho = .5: the continuous solution's means. The error falls with epsilon. */
START_TEST(test_cube)
{
    static char *settings[3][5] = { { "relative=0", "epsilon=0.1", "min_share=1e-6", NULL },
                                    { "relative=0", "epsilon=0.01", "min_share=1e-6", NULL },
                                    { "relative=0", "epsilon=0.002", "min_share=1e-6", NULL } };
    double error[3];
    int i;
    for (i = 0; i < 3; i++) {
        struct scene scene;
        struct solve s;
        uint32_t wall, lamp, m[6], f;
        made_open(&scene);
        wall = made_material(&scene, 0.5, 0);
        lamp = made_material(&scene, 0.5, 1);
        for (f = 0; f < 6; f++)
            m[f] = f == 1 ? lamp : wall;
        made_room(&scene, m, 1, 1, 1);
        solve_with(&s, &scene, "bf", RELEASE_FLAT, settings[i], quick(2));
        error[i] = fmax(fabs(face_radiosity(&s, 1) - 1.1043616), fabs(face_radiosity(&s, 0) - 0.1712161));
        for (f = 2; f < 6; f++)
            error[i] = fmax(error[i], fabs(face_radiosity(&s, f) - 0.1811056));
        printf("cube epsilon %s: worst face mean off by %.1e\n", settings[i][1], error[i]);
        solve_close(&s);
        made_close(&scene);
    }
    ck_assert_double_lt(error[1], error[0]);
    ck_assert_double_lt(error[2], error[1]);
    ck_assert_double_lt(error[2], 1e-3);
}
END_TEST

/* Open scenes: two parallel, then two perpendicular unit squares, E = 1, rho = .5. */
START_TEST(test_plates)
{
    static char *settings[] = { "relative=0.003", "min_share=1e-6", NULL };
    struct scene scene;
    struct solve s;
    made_open(&scene);
    made_material(&scene, 0.5, 1);
    made_quad(&scene, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    if (_i == 0)
        made_quad(&scene, 0, 0, 0, 1, 0, 1, 0, 1, 0, 0);
    else
        made_quad(&scene, 0, 0, 0, 0, 0, 0, 1, 1, 0, 0);
    solve_with(&s, &scene, "bf_guarded", RELEASE_FLAT, settings, quick(2));
    ck_assert_double_eq_tol(face_radiosity(&s, 0), _i == 0 ? 1.111165244298 : 1.1159537, 5e-4);
    ck_assert_double_eq_tol(face_radiosity(&s, 1), face_radiosity(&s, 0), 2e-4);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* A room with a box on the floor and a lamp: something to compare with itself. `bright` scales E. */
static void furnished(struct scene *s, double bright)
{
    uint32_t m[6], grey, i;
    made_open(s);
    grey = made_material(s, 0.6, 0);
    for (i = 0; i < 6; i++)
        m[i] = grey;
    made_room(s, m, 4, 5, 3);
    made_material(s, 0.2, 10 * bright);
    made_material(s, 0.3, 0);
    made_quad(s, 1, 1, 2, 2.5, 0, 1, 0, 1, 0, 0);           /* a lamp that shines down */
    made_quad(s, 1, 1, 2, 2.5, 1, 0, 0, 0, 1, 0);           /* and up */
    made_quad(s, 2, 1.3, 1, 1, 1, 0, 0, 0, 1.5, 0);         /* a box: top and sides */
    made_quad(s, 2, 1.3, 1, 0, 1, 0, 0, 0, 0, 1);
    made_quad(s, 2, 1.3, 2.5, 0, 0, 0, 1, 1, 0, 0);
    made_quad(s, 2, 1.3, 1, 0, 0, 0, 1, 0, 1.5, 0);
    made_quad(s, 2, 2.3, 1, 0, 0, 1.5, 0, 0, 0, 1);
}

/* Threads, releases and methods give the same links to the bit. */
START_TEST(test_same_links)
{
    static const char *const oracle[2] = { "bf", "bf_guarded" };
    struct scene scene;
    struct solve one, other;
    int k;
    furnished(&scene, 1);
    solve_with(&one, &scene, oracle[_i], RELEASE_FLAT, NULL, quick(1));
    for (k = 0; k < 4; k++) {
        solve_with(&other, &scene, oracle[_i], k == 1 ? RELEASE_DAG : k == 2 ? RELEASE_HAND : RELEASE_FLAT, NULL, quick(k == 3 ? 5 : 2));
        same_links(&one, &other);
        ck_assert(memcmp(one.radiosity, other.radiosity, one.hierarchy.count * sizeof(double)) == 0);
        solve_close(&other);
    }
    solve_close(&one);
    made_close(&scene);
}
END_TEST

/* An oracle that counts depths and records what links bring. */
static const char counting[] =
    "oracle counting \"bf, counted\" { start level;\n"
    "  node level = clusters() { surfaces -> planes;  apart -> stop;  receiver -> subdivide_receiver;  emitter -> subdivide_emitter; }\n"
    "  node planes = support_planes() { away -> stop;  otherwise -> deep; }\n"
    "  node deep = count(as = receiver.depth) { done -> energy; }\n"
    "  node energy = transfer(relative = 0.2) { dark -> stop;  below -> few;  above -> guard; }\n"
    "  node guard = can_split(min_share = 1e-3) { both -> side;  neither -> few;\n"
    "                         receiver -> subdivide_receiver;  emitter -> subdivide_emitter; }\n"
    "  node side = larger() { receiver -> subdivide_receiver;  emitter -> subdivide_emitter; }\n"
    "  node few = visibility(rays = 16) { none -> stop;  partial | all -> form; }\n"
    "  node form = form_factor() { done -> note; }\n"
    "  node note = record(value = emitter.radiosity * form_factor / scene.irradiance, slot = 3) { done -> known; }\n"
    "  node known = record(value = 0.75) { done -> link; }\n"
    "}\n";

/* Counting changes nothing, and the counts are those of the refinement: every pair came in at the start, every node was
 * asked as often as arcs led to it, every decision taken as often as it was carried out. */
START_TEST(test_statistics)
{
    static const char *const decisions[] = { "link", "stop", "subdivide_receiver", "subdivide_emitter", "subdivide_both" };
    struct scene scene;
    struct solve s, plain;
    struct solve_options options = quick(2);
    struct statistics counted;
    struct refiner *r, *other;
    const char *cause;
    uint64_t deep = 0, noted = 0, sum[5] = { 0 };
    int i, k, j;
    furnished(&scene, 1);
    r = refiner_interpreted("counting.dag", counting, NULL, stderr);
    other = refiner_interpreted("counting.dag", counting, NULL, stderr);
    ck_assert_ptr_nonnull(r);
    ck_assert_int_eq(statistics_take(&counted, r), -1); /* not asked for */
    ck_assert_int_eq(refiner_count(r, 2), 0);
    ck_assert_int_eq(solve_open(&s, &scene, &options, &cause), 0);
    ck_assert_int_eq(solve_run(&s, r, &cause), 0);
    ck_assert_int_eq(solve_open(&plain, &scene, &options, &cause), 0);
    ck_assert_int_eq(solve_run(&plain, other, &cause), 0);
    same_links(&s, &plain);
    ck_assert_int_eq(statistics_take(&counted, r), 0);
    ck_assert_str_eq(counted.nodes[0].name, "level");
    ck_assert_uint_eq(counted.nodes[0].calls, s.refinement.pairs);
    for (i = 0; i < counted.node_count; i++) {
        const struct node_statistics *n = &counted.nodes[i];
        uint64_t in = i == 0 ? s.refinement.pairs : 0, out = 0;
        for (j = 0; j < counted.node_count; j++)
            for (k = 0; k < counted.nodes[j].answer_count; k++)
                in += strcmp(counted.nodes[j].answers[k].target, n->name) == 0 ? counted.nodes[j].answers[k].count : 0;
        for (k = 0; k < n->answer_count; k++) {
            out += n->answers[k].count;
            for (j = 0; j < 5; j++)
                sum[j] += strcmp(n->answers[k].target, decisions[j]) == 0 ? n->answers[k].count : 0;
        }
        ck_assert_uint_eq(in, n->calls);
        ck_assert_uint_eq(out, n->calls);
        if (strcmp(n->name, "deep") == 0)
            deep = n->calls;
        if (strcmp(n->name, "note") == 0)
            noted = n->calls;
    }
    for (j = 0; j < 5; j++)
        ck_assert_uint_eq(sum[j], s.refinement.decided[j]);
    for (i = 0; i < STATISTICS_COUNTS; i++)
        deep -= counted.counts[i];
    ck_assert_uint_eq(deep, 0);
    ck_assert_uint_gt(counted.counts[0], 0);
    ck_assert_uint_gt(counted.counts[1], 0);
    ck_assert_uint_eq(counted.counts[25], 0); /* can_split ends at 24 */
    ck_assert_uint_gt(noted, 100);
    ck_assert_uint_eq(counted.records[0].bins[-1 - STATISTICS_LOW], noted); /* 0.75 lies in [1/2, 1) */
    noted -= counted.records[3].zero;
    for (i = 0; i < STATISTICS_HIGH - STATISTICS_LOW; i++) {
        noted -= counted.records[3].bins[i];
        if (ldexp(1, STATISTICS_LOW + i) > 20 / rays_host(s.rays)->irradiance) /* no B is above 20 W/m2, and F <= 1 */
            ck_assert_uint_eq(counted.records[3].bins[i], 0);
    }
    ck_assert_uint_eq(noted, 0);
    statistics_free(&counted);
    solve_close(&s);
    solve_close(&plain);
    refiner_close(r);
    refiner_close(other);
    made_close(&scene);
}
END_TEST

/* BF with a threshold by importance; `%s`: that threshold. */
static const char weighted[] =
    "oracle weighted \"bf for a view\" { start level;\n"
    "  node level = clusters() { surfaces -> planes;  apart -> stop;  receiver -> subdivide_receiver;  emitter -> subdivide_emitter; }\n"
    "  node planes = support_planes() { away -> stop;  otherwise -> energy; }\n"
    "  node energy = transfer(relative = %s) { dark -> stop;  below -> few;  above -> guard; }\n"
    "  node guard = can_split(min_share = 2e-4) { both -> side;  neither -> few;\n"
    "                         receiver -> subdivide_receiver;  emitter -> subdivide_emitter; }\n"
    "  node side = larger() { receiver -> subdivide_receiver;  emitter -> subdivide_emitter; }\n"
    "  node few = visibility(rays = 16) { none -> stop;  partial | all -> form; }\n"
    "  node form = form_factor() { done -> link; }\n"
    "}\n";

static void solve_view(struct solve *s, const struct scene *scene, const char *threshold, struct solve_options options)
{
    char text[2048];
    const char *cause;
    struct refiner *r;
    snprintf(text, sizeof text, weighted, threshold);
    r = refiner_interpreted("weighted.dag", text, NULL, stderr);
    ck_assert_ptr_nonnull(r);
    ck_assert_uint_eq(r->reads, REFINER_READS_IMPORTANCE);
    ck_assert_int_eq(solve_open(s, scene, &options, &cause), 0);
    ck_assert_int_eq(solve_run(s, r, &cause), 0);
    ck_assert_int_eq(s->converged, 1);
    refiner_close(r);
}

/* x := A^-1 x, by elimination with pivots; A [n * n] is lost. */
static void eliminate(double *a, double *x, size_t n)
{
    size_t i, j, k;
    for (k = 0; k < n; k++) {
        size_t p = k;
        for (i = k + 1; i < n; i++)
            p = fabs(a[i * n + k]) > fabs(a[p * n + k]) ? i : p;
        for (j = k; p != k && j < n; j++) {
            double keep = a[k * n + j];
            a[k * n + j] = a[p * n + j];
            a[p * n + j] = keep;
        }
        if (p != k) {
            double keep = x[k];
            x[k] = x[p];
            x[p] = keep;
        }
        for (i = k + 1; i < n; i++) {
            double f = a[i * n + k] / a[k * n + k];
            for (j = k; j < n && f != 0; j++)
                a[i * n + j] -= f * a[k * n + j];
            x[i] -= f * x[k];
        }
    }
    for (k = n; k-- > 0;) {
        for (j = k + 1; j < n; j++)
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
    return up == e ? s->hierarchy.elements[j].area * s->exposed[j] / (s->hierarchy.elements[e].area * s->exposed[e]) : 0;
}

static const struct view into_the_corner = { .eye = { 3.9, 4.9, 2.9 }, .at = { 0, 0, 0 }, .fov = 25 };

/* Importance by sweeps over the links is that of the same links written out as one matrix and solved at once. */
START_TEST(test_importance_dense)
{
    struct scene scene;
    struct solve s;
    struct solve_options options = quick(1);
    uint32_t *leaf, n = 0, i, j, up;
    double *a, *y, worst = 0;
    size_t l;
    options.tolerance = 1e-9;
    options.closure = CLOSURE_ROWS; /* no gifts among leaves, which a matrix row does not show */
    options.view = &into_the_corner;
    options.aspect = 1.5;
    furnished(&scene, 1);
    solve_view(&s, &scene, "0.1 / max(receiver.importance, 0.01)", options);
    leaf = malloc(s.hierarchy.count * sizeof *leaf);
    for (i = 0; i < s.hierarchy.count; i++)
        if (s.hierarchy.elements[i].vertices && !s.hierarchy.elements[i].children)
            leaf[n++] = i;
    a = calloc((size_t)n * n, sizeof *a);
    y = calloc(n, sizeof *y);
    ck_assert_uint_gt(n, 100);
    for (i = 0; i < n; i++) {
        a[(size_t)i * n + i] = 1;
        y[i] = s.importance.response[leaf[i]];
        ck_assert(s.row_gift[leaf[i]] == 0 || !(s.exposed[leaf[i]] > 0));
        for (up = leaf[i]; s.exposed[leaf[i]] > 0 && s.hierarchy.elements[up].vertices; up = s.hierarchy.elements[up].parent)
            for (l = s.refinement.first_link[up]; l < s.refinement.first_link[up + 1]; l++) {
                const struct link *link = &s.refinement.links[l];
                double f = (double)link->form_factor * link->visibility / LINK_VISIBLE * s.row_scale[leaf[i]] / s.exposed[leaf[i]];
                for (j = 0; j < n; j++)
                    a[(size_t)i * n + j] -= f * part_of(&s, leaf[j], link->emitter) * s.hierarchy.elements[leaf[j]].reflectance;
            }
    }
    eliminate(a, y, n);
    for (i = 0; i < n; i++)
        worst = s.exposed[leaf[i]] > 0 ? fmax(worst, fabs(s.importance.value[leaf[i]] - y[i])) : worst;
    printf("importance of %u leaves: at most %.1e from the direct solution; from %.3g in the mean to %.3g\n", n, worst,
           s.importance.mean, s.importance.largest);
    ck_assert_double_le(worst, 1e-6 * s.importance.largest);
    ck_assert_double_gt(s.importance.seen, 0.5);
    ck_assert_double_lt(s.importance.seen, 0.5 * rays_host(s.rays)->area);
    for (i = 0; i < s.hierarchy.count; i++) {
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

/* <r, B> = <Y, E>: what the picture holds is what the light that is emitted means to it. Exact to rounding where links
 * are reciprocal: two plates, linked alike both ways. In a room as good as its links. */
START_TEST(test_importance_dual)
{
    static const struct view down = { .eye = { 0.5, 0.5, 0.9 }, .at = { 0.4, 0.5, 0 }, .fov = 40 };
    struct scene scene;
    struct solve s;
    struct solve_options options = quick(1);
    double left = 0, right = 0;
    uint32_t i;
    options.tolerance = 1e-9;
    options.view = _i ? &into_the_corner : &down;
    options.aspect = 1;
    if (_i) {
        furnished(&scene, 1);
    } else {
        made_open(&scene);
        made_material(&scene, 0.5, 1);
        made_quad(&scene, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
        made_quad(&scene, 0, 0, 0, 1, 0, 1, 0, 1, 0, 0);
    }
    solve_view(&s, &scene, "0.05 + 0 * receiver.importance", options);
    for (i = 0; i < s.hierarchy.count; i++) {
        const struct element *e = &s.hierarchy.elements[i];
        if (e->children || !e->vertices)
            continue;
        left += e->area * s.exposed[i] * s.importance.response[i] * s.radiosity[i];
        right += e->area * s.exposed[i] * s.importance.value[i] * s.exitance[e->face];
    }
    printf("what the picture holds: %.9g W by light, %.9g W by importance\n", left, right);
    ck_assert_double_gt(left, 0.1);
    ck_assert_double_le(fabs(left / right - 1), _i ? 0.05 : 1e-6);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* An oracle that weighs by importance spends less on what the picture does not hold, and gets the picture's light as
 * well as the oracle that refines everywhere. */
START_TEST(test_importance_pays)
{
    struct scene scene;
    struct solve s[2];
    struct solve_options options = quick(1);
    double sum[2] = { 0, 0 };
    uint32_t i;
    int k;
    options.view = &into_the_corner;
    options.aspect = 1;
    furnished(&scene, 1);
    for (k = 0; k < 2; k++) {
        solve_view(&s[k], &scene, k ? "0.02 / max(receiver.importance, 0.01)" : "0.02 + 0 * receiver.importance", options);
        for (i = 0; i < s[k].hierarchy.count; i++)
            if (s[k].hierarchy.elements[i].vertices && !s[k].hierarchy.elements[i].children)
                sum[k] += s[k].hierarchy.elements[i].area * s[k].importance.response[i] * s[k].radiosity[i];
    }
    printf("in the picture %.5g W by %zu links, %.5g W by %zu links of importance\n", sum[0], s[0].refinement.link_count,
           sum[1], s[1].refinement.link_count);
    ck_assert_double_le(fabs(sum[1] / sum[0] - 1), 0.03);
    ck_assert_double_le((double)s[1].refinement.link_count, 0.75 * (double)s[0].refinement.link_count);
    for (k = 0; k < 2; k++)
        solve_close(&s[k]);
    made_close(&scene);
}
END_TEST

/* F at the point x of a leaf with normal n, by the midpoint rule over the emitter's quad. */
static double factor_at(const double x[3], const double n[3], const struct element *s)
{
    enum { N = 300 };
    double sum = 0;
    int i, j, k;
    for (i = 0; i < N; i++)
        for (j = 0; j < N; j++) {
            double u = (i + 0.5) / N, v = (j + 0.5) / N, w[3], q, a, b;
            for (k = 0; k < 3; k++)
                w[k] = s->vertex[0][k] + u * (s->vertex[1][k] - s->vertex[0][k]) + v * (s->vertex[3][k] - s->vertex[0][k]) - x[k];
            q = dot3(w, w);
            a = dot3(w, n);
            b = -dot3(w, s->normal);
            sum += a > 0 && b > 0 ? a * b / (M_PI * q * q) : 0;
        }
    return sum * s->area / ((double)N * N);
}

/* A leaf's defect against its definition, links and integrals written out. */
START_TEST(test_defect)
{
    static char *settings[] = { "relative=0.05", "min_share=1e-3", NULL };
    struct scene scene;
    struct solve s;
    uint32_t i, found = 0;
    made_open(&scene);
    made_material(&scene, 0.5, 1);
    made_material(&scene, 0.7, 0);
    made_quad(&scene, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    made_quad(&scene, 1, 0.3, 0, 1, 0, 1, 0, 1, 0, 0);
    solve_with(&s, &scene, "bf", RELEASE_FLAT, settings, quick(1));
    for (i = 0; i < s.hierarchy.count && found < 3; i++) {
        const struct element *e = &s.hierarchy.elements[i];
        double worst = 0;
        uint32_t up, links = 0;
        struct defect d;
        size_t l;
        int k;
        if (!e->vertices || e->children || e->face != 1)
            continue;
        for (k = 0; k < 5; k++) {
            const double *x = k < 4 ? e->vertex[k] : e->centre;
            double sum = 0;
            links = 0;
            for (up = i; s.hierarchy.elements[up].vertices; up = s.hierarchy.elements[up].parent)
                for (l = s.refinement.first_link[up]; l < s.refinement.first_link[up + 1]; l++, links++) {
                    const struct link *link = &s.refinement.links[l];
                    sum += s.radiosity[link->emitter] * link->visibility / LINK_VISIBLE
                         * (factor_at(x, e->normal, &s.hierarchy.elements[link->emitter]) - (double)link->form_factor);
                }
            worst = fmax(worst, 0.7 * fabs(sum));
        }
        d = defect_leaf(&s, i);
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

/* Error control: what was asked for is held by every leaf that is not given up, and by the face means of a cube whose
 * solution is known; allowances start where they should, only fall, and a parent's is the least of its children's. */
START_TEST(test_allowance)
{
    static char *wanted[3][4] = { { "relative=0", "epsilon=0.1", "min_share=1e-4", NULL }, { "relative=0", "epsilon=0.05", "min_share=1e-4", NULL },
                                  { "relative=0", "epsilon=0.025", "min_share=1e-4", NULL } };
    static const double eps[3] = { 0.1, 0.05, 0.025 };
    size_t links[3];
    int k, c;
    for (k = 0; k < 3; k++) {
        struct scene scene;
        struct solve s;
        uint32_t m[6], f, i, given_up = 0, fallen = 0;
        double off;
        made_open(&scene);
        made_material(&scene, 0.5, 0);
        made_material(&scene, 0.5, 1);
        for (f = 0; f < 6; f++)
            m[f] = f == 1;
        made_room(&scene, m, 1, 1, 1);
        solve_with(&s, &scene, "error_control", RELEASE_FLAT, wanted[k], quick(1));
        links[k] = s.refinement.link_count;
        ck_assert_double_eq_tol(s.allowance.target, eps[k], 1e-15);
        for (i = 0; i < s.hierarchy.count; i++) {
            const struct element *e = &s.hierarchy.elements[i];
            double least = INFINITY;
            ck_assert_double_le(e->allowance, 0.5 * eps[k]);
            fallen += e->vertices && e->allowance < 0.49 * eps[k];
            for (c = 0; c < e->children; c++)
                least = fmin(least, s.hierarchy.elements[e->child + (uint32_t)c].allowance);
            if (e->children)
                ck_assert(least >= e->allowance && (e->depth > 0 || !e->vertices || least <= 0.5 * eps[k]));
            if (!e->vertices || e->children)
                continue;
            if (defect_leaf(&s, i).all > eps[k]) {
                given_up++;
                ck_assert(defect_leaf(&s, i).guarded > eps[k] || e->allowance * defect_leaf(&s, i).links < 0.25 * eps[k]);
            }
        }
        off = fmax(fabs(face_radiosity(&s, 1) - 1.1043616), fabs(face_radiosity(&s, 0) - 0.1712161));
        for (f = 2; f < 6; f++)
            off = fmax(off, fabs(face_radiosity(&s, f) - 0.1811056));
        printf("error asked %.3f: %zu links, %d passes, estimate %.3f, %u of %u leaves given up, %u elements lowered, face means off by %.1e\n",
               eps[k], links[k], s.passes, s.allowance.largest, given_up, s.leaves, fallen, off);
        ck_assert((s.allowance.area > 0) == (given_up > 0));
        ck_assert(k < 2 || fallen > 0);
        ck_assert_double_le(off, eps[k]);
        solve_close(&s);
        made_close(&scene);
    }
    ck_assert_uint_lt(links[0], links[1]);
    ck_assert_uint_lt(links[1], links[2]);
}
END_TEST

/* Brightness and epsilon times 1000: the same links. */
START_TEST(test_brightness)
{
    static char *dim[] = { "relative=0", "epsilon=0.05", NULL }, *bright[] = { "relative=0", "epsilon=50", NULL };
    struct scene scene;
    struct solve one, other;
    furnished(&scene, 1);
    solve_with(&one, &scene, "bf", RELEASE_FLAT, dim, quick(2));
    made_close(&scene);
    furnished(&scene, 1000);
    solve_with(&other, &scene, "bf", RELEASE_FLAT, bright, quick(2));
    same_links(&one, &other);
    ck_assert_double_eq_tol(face_radiosity(&other, 0) / face_radiosity(&one, 0), 1000, 1e-6);
    solve_close(&one);
    solve_close(&other);
    made_close(&scene);
}
END_TEST

/* All lengths times 2^10 and 2^-10: the same links and radiosities, to the bit, without touching a parameter. */
START_TEST(test_scale)
{
    struct scene scene, scaled;
    struct solve one, other;
    furnished(&scene, 1);
    furnished(&scaled, 1);
    made_scale(&scaled, _i ? 1024 : 1 / 1024.0);
    solve_with(&one, &scene, "bf_guarded", RELEASE_FLAT, NULL, quick(2));
    solve_with(&other, &scaled, "bf_guarded", RELEASE_FLAT, NULL, quick(2));
    same_links(&one, &other);
    ck_assert(memcmp(one.radiosity, other.radiosity, one.hierarchy.count * sizeof(double)) == 0);
    solve_close(&one);
    solve_close(&other);
    made_close(&scene);
    made_close(&scaled);
}
END_TEST

/* Jacobi and Gauss-Seidel agree, and power is conserved to a few percent. */
START_TEST(test_methods)
{
    struct scene scene;
    struct solve one, other;
    struct solve_options jacobi = quick(2);
    uint32_t i;
    jacobi.jacobi = 1;
    furnished(&scene, 1);
    solve_with(&one, &scene, "bf_guarded", RELEASE_FLAT, NULL, quick(2));
    solve_with(&other, &scene, "bf_guarded", RELEASE_FLAT, NULL, jacobi);
    for (i = 0; i < scene.face_count; i++)
        ck_assert_double_eq_tol(face_radiosity(&one, i) / face_radiosity(&other, i), 1, 1e-3);
    ck_assert_int_lt(one.sweeps, other.sweeps);
    ck_assert_double_eq_tol(one.absorbed / one.emitted, 1, 0.03);
    solve_close(&one);
    solve_close(&other);
    made_close(&scene);
}
END_TEST

/* A wall without thickness between a lit and a dark room, its front to either side: nothing passes. */
START_TEST(test_wall)
{
    struct scene scene;
    struct solve s;
    uint32_t grey, lamp, side, i;
    made_open(&scene);
    grey = made_material(&scene, 0.7, 0);
    lamp = made_material(&scene, 0.5, 10);
    for (side = 0; side < 2; side++) { /* the dark room from x = 0 to 1, the lit one to 2 */
        double x = side;
        made_quad(&scene, grey, x, 0, 0, 1, 0, 0, 0, 1, 0);
        made_quad(&scene, grey, x, 0, 1, 0, 1, 0, 1, 0, 0);
        made_quad(&scene, grey, x, 0, 0, 0, 0, 1, 1, 0, 0);
        made_quad(&scene, grey, x, 1, 0, 1, 0, 0, 0, 0, 1);
    }
    made_quad(&scene, grey, 0, 0, 0, 0, 1, 0, 0, 0, 1);
    made_quad(&scene, lamp, 2, 0, 0, 0, 0, 1, 0, 1, 0);
    if (_i == 0)
        made_quad(&scene, grey, 1, 0, 0, 0, 1, 0, 0, 0, 1); /* faces the lamp */
    else
        made_quad(&scene, grey, 1, 0, 0, 0, 0, 1, 0, 1, 0); /* turns its black back on it */
    solve_with(&s, &scene, "bf_guarded", RELEASE_FLAT, NULL, quick(2));
    for (i = 0; i < 4; i++) {
        ck_assert(face_radiosity(&s, i) == 0);
        ck_assert_double_gt(face_radiosity(&s, i + 4), 0.5);
    }
    ck_assert(face_radiosity(&s, 8) == 0);
    ck_assert(_i == 0 ? face_radiosity(&s, 10) > 0.5 : face_radiosity(&s, 10) == 0);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* The paper's scenes: every release of both oracles decides alike (run as the user would). */
START_TEST(test_compare)
{
    static const char *const scene[] = { "cornell", "room", "td", "maze_8", "furnace" };
    static const char *const oracle[] = { "bf", "bf_guarded" };
    const char *program = getenv("RADIOSITY");
    char command[512];
    snprintf(command, sizeof command, "%s compare examples/scenes/%s.obj --oracle %s --repeats 1 --set relative=0.5 --set min_share=1e-3%s > /dev/null",
             program ? program : "build/bin/radiosity", scene[_i / 2], oracle[_i % 2], _i % 2 ? " --set shadow=0.1 --set faint=1e-3" : "");
    ck_assert_int_eq(system(command), 0);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("solve");
    TCase *c = tcase_create("solve");
    SRunner *runner;
    int failed;
    tcase_set_timeout(c, 600);
    tcase_add_loop_test(c, test_furnace, 0, 18);
    tcase_add_loop_test(c, test_closed_furnace, 0, 5);
    tcase_add_loop_test(c, test_open_closure, 0, 3);
    tcase_add_test(c, test_spread);
    tcase_add_test(c, test_cube);
    tcase_add_loop_test(c, test_plates, 0, 2);
    tcase_add_loop_test(c, test_same_links, 0, 2);
    tcase_add_test(c, test_statistics);
    tcase_add_test(c, test_importance_dense);
    tcase_add_loop_test(c, test_importance_dual, 0, 2);
    tcase_add_test(c, test_importance_pays);
    tcase_add_test(c, test_defect);
    tcase_add_test(c, test_allowance);
    tcase_add_test(c, test_brightness);
    tcase_add_loop_test(c, test_scale, 0, 2);
    tcase_add_test(c, test_methods);
    tcase_add_loop_test(c, test_wall, 0, 2);
    tcase_add_loop_test(c, test_compare, 0, 10);
    suite_add_tcase(suite, c);
    runner = srunner_create(suite);
    srunner_run_all(runner, CK_NORMAL);
    failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed != 0;
}
