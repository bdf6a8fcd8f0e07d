/* Does mending find the light of a large face that few particles meet? The truth is a closed form:
 * two closed boxes, apart, each a furnace: walls that emit E and reflect rho have H = E / (1 - rho)
 * everywhere. One is a thousand times as bright as the other and gets all but a thousandth of the
 * particles. What links say of one wall of the dark one is spoilt.
 * SPDX-License-Identifier: MIT */
#include "runtime/make_solve.h"
#include "scene/read_scene.h"
#include "engine/dim_belief.h"
#include "engine/dim_faces.h"
#include "engine/dim_list.h"
#include "engine/dim_parts.h"
#include "engine/dim_plan.h"
#include "engine/lit_faces.h"
#include "engine/mend_solution.h"
#include "engine/mend.h"
#include "engine/solve_tracer.h"
#include "kernel/constants.h"
#include "suite.h"

#define DARK 1e-3  /* W/m2: H in the dark box; in the bright one it is 1 */
#define RHO 0.3    /* of both */
#define SPOILT 1.3 /* by what the wall's light is multiplied */

/* The face that is spoilt, the first of the dark box; the other five are cut in CUTS x CUTS parts
 * of 1/192 of the area each, two of which are large together, and four too large. */
enum { WALL = 6, CUTS = 4, GROUPS = 5 * CUTS * CUTS / 2 };

/* Of a box's walls: one part of n by n. */
static void add_part(struct scene *s, uint32_t material, const struct face *wall, int n, int part)
{
    const double(*v)[3] = wall->vertex;
    double o[3], a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = (v[1][k] - v[0][k]) / n;
        b[k] = (v[3][k] - v[0][k]) / n;
        o[k] = v[0][k] + part % n * a[k] + part / n * b[k];
    }
    made_quad(s, material, o[0] + 5, o[1], o[2], a[0], a[1], a[2], b[0], b[1], b[2]);
}

/* Two boxes whose links are right. light: H in the second, of whose walls all but the first are cut
 * in cuts^2 parts; CUTS: each of less than a hundredth of the area. */
static void furnaces_cut(struct solve *s, struct scene *scene, double light, int cuts, int threads)
{
    static char *settings[] = {"min_share=0.02", NULL};
    ck_assert_int_eq(made_open(scene), 0);
    uint32_t bright = made_material(scene, RHO, 1 - RHO),
             dark = made_material(scene, RHO, light * (1 - RHO));
    const uint32_t walls[6] = {bright, bright, bright, bright, bright, bright};
    made_room(scene, walls, 1, 1, 1);
    for (int i = 0; i < 6; i++)
        for (int n = i == 0 ? 1 : cuts, part = 0; part < n * n; part++)
            add_part(scene, dark, &scene->faces[i], n, part);
    solve_with(s, scene, "bf", RELEASE_FLAT, settings, quick(threads));
}

static void two_furnaces(struct solve *s, struct scene *scene, double light, int threads)
{
    furnaces_cut(s, scene, light, CUTS, threads);
}

static void spoil(struct solve *s, uint32_t from, uint32_t to, double factor)
{
    for (uint32_t e = 0; e < s->hierarchy.count; e++) {
        const struct element *at = &s->hierarchy.elements[e];
        if (at->vertices && at->face >= from && at->face < to) {
            s->state.irradiance[e] *= factor;
            s->state.radiosity[e] = DARK * (1 - RHO) + RHO * s->state.irradiance[e];
        }
    }
}

static void spoil_wall(struct solve *s)
{
    spoil(s, WALL, WALL + 1, SPOILT);
}

static double of_face(const struct solve *s, uint32_t face)
{
    return s->mended.irradiance[s->hierarchy.face_element[face]];
}

static void mend_all(struct solve *s, double noise, uint64_t most, struct measured_error *alone)
{
    const struct mending_goal goal = {.noise = noise, .most = most};
    const char *cause;
    ck_assert_int_eq(measure_and_mend(s, &goal, alone, &cause), 0);
}

/* The wall is right to 5 %, two standard errors, where links are off by 30 % and some 50 particles
 * by 14 %; bright walls stay; each element has what its children have. */
START_TEST(test_found)
{
    struct scene scene;
    struct solve s;
    struct measured_error alone;
    two_furnaces(&s, &scene, DARK, 2);
    spoil_wall(&s);
    mend_all(&s, 1e-4, 450000, &alone);
    ck_assert_uint_eq(alone.gathered, GROUPS); /* parts of the other dark walls are small */
    ck_assert_uint_eq(alone.dim.large, WALL + 1 + GROUPS);
    for (uint32_t i = 0; i < alone.dim.unsure; i++)
        ck_assert_uint_gt(alone.dim.named[i], WALL);
    const struct hierarchy *h = &s.hierarchy;
    for (uint32_t f = 0; f < WALL; f++)
        ck_assert_double_eq_tol(of_face(&s, f), 1, 0.01);
    ck_assert_double_eq_tol(of_face(&s, WALL) / DARK, 1, 0.05);
    for (uint32_t e = 0; e < h->count; e++) {
        double sum = 0, own = s.mended.irradiance[e] * h->elements[e].area;
        for (uint32_t c = 0; c < h->elements[e].children; c++)
            sum += s.mended.irradiance[h->elements[e].child + c]
                   * h->elements[h->elements[e].child + c].area;
        if (h->elements[e].children)
            ck_assert_double_eq_tol(sum, own, 1e-12 * own);
    }
    measured_error_free(&alone);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* A box against a wall, another one and a third on that: what touches floor or wall sees nothing,
 * and that is known; the two faces where boxes meet are not asked. */
START_TEST(test_stood_on)
{
    static const double at[3][3] = {{0, 0.5, 0}, {0.5, 0.5, 0}, {0.5, 0.5, 0.3}},
                        along[3][3] = {{0.3, 0, 0}, {0, 0.3, 0}, {0, 0, 0.3}};
    struct scene scene;
    struct solve s;
    struct measured_error alone;
    made_open(&scene);
    const uint32_t wall = made_material(&scene, RHO, 0), lamp = made_material(&scene, RHO, 1);
    const uint32_t walls[6] = {wall, wall, wall, wall, wall, lamp};
    made_room(&scene, walls, 1, 1, 1);
    for (int i = 0; i < 3; i++)
        made_box(&scene, wall, at[i], along, 0);
    solve_with(&s, &scene, "bf", RELEASE_FLAT, NULL, quick(2));
    mend_all(&s, 1e-4, 450000, &alone);
    ck_assert_uint_eq(alone.dim.large, 6 + 6 + 5 + 5);
    ck_assert_uint_eq(alone.dim.unsure, 0);
    measured_error_free(&alone);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

static uint32_t unsure; /* as the last of mend_apart said */

/* Mend by `particles`, then dim polygons within the budget. Returns what the latter returned;
 * *root: by what factor the whole scene's light has changed. */
static int mend_within(struct solve *s, uint64_t particles, const struct dim_budget *budget,
                       uint64_t *rays, double *root)
{
    struct dim_count dim;
    size_t size = s->hierarchy.count * sizeof(double);
    struct tracer t = solve_tracer(s);
    struct tally tally;
    ck_assert_int_eq(tracer_open(&t), 0);
    ck_assert_int_eq(tally_open(&tally, &t, MEND_STREAM, 1), 0);
    ck_assert_int_eq(tally_trace(&tally, &t, particles / REPLICATES, NULL), 0);
    s->mended.radiosity = malloc(size);
    s->mended.irradiance = malloc(size);
    memcpy(s->mended.radiosity, s->state.radiosity, size);
    memcpy(s->mended.irradiance, s->state.irradiance, size);
    ck_assert_int_eq(mend_irradiance(&s->operator, & tally, s->mended.irradiance), 0);
    double before = s->mended.irradiance[0];
    *rays = 0;
    double band_noise[3] = {1, 1, 1};
    int changed =
        dim_faces_mend(s, &t, &tally, DIM_LARGE_ONES, budget, NULL, rays, &dim, band_noise);
    ck_assert_uint_ge(dim.large, dim.unsure);
    unsure = dim.unsure;
    *root = s->mended.irradiance[0] / before;
    tally_close(&tally);
    tracer_close(&t);
    return changed;
}

static int mend_apart(struct solve *s, uint64_t particles, uint64_t budget, uint64_t *rays,
                      double *root)
{
    const struct dim_budget all = {(double)budget, 2 * (double)budget, (double)budget};
    return mend_within(s, particles, &all, rays, root);
}

/* Same bits by any number of threads; no power is made or lost; the budget is kept, but for whole
 * blocks of paths. */
START_TEST(test_same_bits)
{
    enum { BUDGET = 20000 };
    static const int threads[] = {1, 2, 5};
    double *first = NULL;
    for (int i = 0; i < 3; i++) {
        struct scene scene;
        struct solve s;
        uint64_t rays;
        double root;
        two_furnaces(&s, &scene, DARK, threads[i]);
        spoil_wall(&s);
        ck_assert_int_eq(mend_apart(&s, 200000, BUDGET, &rays, &root), 1);
        ck_assert_uint_gt(rays, 0);
        ck_assert_uint_le(rays, BUDGET + 64 * 4);
        ck_assert_double_eq_tol(root, 1, 1e-12);
        size_t size = s.hierarchy.count * sizeof *first;
        if (i == 0)
            memcpy(first = malloc(size), s.mended.irradiance, size);
        else
            ck_assert_int_eq(memcmp(first, s.mended.irradiance, size), 0);
        solve_close(&s);
        made_close(&scene);
    }
    free(first);
}
END_TEST

/* Too few rays to know the wall: so it is said. */
START_TEST(test_unsure)
{
    struct scene scene;
    struct solve s;
    uint64_t rays;
    double root;
    two_furnaces(&s, &scene, DARK, 2);
    spoil_wall(&s);
    ck_assert_int_ge(mend_apart(&s, 2000, 2000, &rays, &root), 1);
    ck_assert_uint_ge(unsure, 1);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Split particles: the dark box is met by as many as the bright one, each wall by the light that it
 * has, and how replicates differ is how far they are off. The windows are wrong by half an order of
 * magnitude, here and there. */
static void split_boxes(double dark)
{
    struct scene scene;
    struct solve s;
    struct tally tally;
    two_furnaces(&s, &scene, dark, 2);
    const struct hierarchy *h = &s.hierarchy;
    struct tracer t = solve_tracer(&s);
    float *window = malloc(h->count * sizeof *window);
    for (uint32_t e = 0; e < h->count; e++) {
        uint32_t face = h->elements[e].vertices ? h->elements[e].face : 0;
        window[e] = (float)((face < WALL ? 1 : dark) * (e % 3 == 0 ? 0.3 : 1));
    }
    ck_assert_int_eq(tracer_open(&t), 0);
    ck_assert_int_eq(tally_open(&tally, &t, MEND_STREAM, 1), 0);
    ck_assert_int_eq(tally_split(&tally, &t, window, DIM_LEAST, 1e6), 0);
    ck_assert_int_eq(tally_trace(&tally, &t, 20000, NULL), 0);
    double chi = 0, walls[2] = {0, 0};
    for (uint32_t f = 0; f < h->face_count; f++) {
        double true_light = f < WALL ? 1 : dark, mean = 0, square = 0;
        double area = hierarchy_surface(h, f)->area;
        for (int r = 0; r < REPLICATES; r++) {
            double H = tally_face(&tally, r, f, 0) / area / true_light;
            mean += H / REPLICATES;
            square += H * H / REPLICATES;
        }
        double variance = (square - mean * mean) / (REPLICATES - 1);
        ck_assert_double_lt(sqrt(variance), 0.05);
        chi += (mean - 1) * (mean - 1) / variance;
        walls[f >= WALL] += mean * area / 6;
    }
    ck_assert_double_eq_tol(walls[0], 1, 0.005);
    ck_assert_double_eq_tol(walls[1], 1, 0.005);
    /* of one of h->face_count values Student's t^2, 15 / 13 in the mean, 3.2 its variance */
    double n = h->face_count;
    ck_assert_double_eq_tol(chi, n * 15 / 13, 4 * sqrt(3.2 * n));
    tally_close(&tally);
    tracer_close(&t);
    free(window);
    solve_close(&s);
    made_close(&scene);
}

/* In three bands: a closed room in which light is 1, .05 and .002 W/m2, and each wall reflects what
 * it does of each. Windows are wrong here and there, and differ by band. What lands in each band is
 * right in the mean, and as noisy as replicates say, however few of another band turn into it. */
START_TEST(test_split_bands)
{
    static const double light[3] = {1, 0.05, 0.002};
    static const double rho[6][3] = {{0.9, 0, 0.5},   {0, 0.8, 0.9}, {0, 0, 0.9},
                                     {0.5, 0.5, 0.5}, {0.9, 0.9, 0}, {0, 0.9, 0.3}};
    struct scene scene;
    struct solve s;
    struct tally tally;
    made_open(&scene);
    scene.bands = 3;
    uint32_t walls[6];
    for (int i = 0; i < 6; i++) {
        walls[i] = made_material(&scene, 0, 0);
        for (int k = 0; k < 3; k++) {
            scene.materials[walls[i]].reflectance[k] = rho[i][k];
            scene.materials[walls[i]].exitance[k] = (1 - rho[i][k]) * light[k];
        }
    }
    made_room(&scene, walls, 1, 1, 1);
    solve_with(&s, &scene, "power", RELEASE_FLAT, NULL, quick(2));
    struct tracer t = solve_tracer(&s);
    float *window = malloc(3 * s.hierarchy.count * sizeof *window);
    for (uint32_t i = 0; i < 3 * s.hierarchy.count; i++)
        window[i] = (float)(light[i % 3] * (i % 7 == 0 ? 0.3 : i % 5 == 0 ? 2 : 1));
    ck_assert_int_eq(tracer_open(&t), 0);
    ck_assert_int_eq(tally_open(&tally, &t, MEND_STREAM, 1), 0);
    ck_assert_int_eq(tally_split(&tally, &t, window, DIM_LEAST, 1e6), 0);
    ck_assert_int_eq(tally_trace(&tally, &t, 20000, NULL), 0);
    double chi = 0;
    for (uint32_t f = 0; f < 6; f++)
        for (uint32_t k = 0; k < 3; k++) {
            double h[REPLICATES], mean, variance;
            for (int r = 0; r < REPLICATES; r++)
                h[r] = tally_face(&tally, r, f, k) / light[k];
            mean = replicates_mean(h, &variance);
            ck_assert_double_lt(sqrt(variance), 0.03);
            chi += (mean - 1) * (mean - 1) / variance;
        }
    printf("18 lights of faces are off by %.2f of their noise\n", sqrt(chi / 18));
    ck_assert_double_lt(chi, 18 * 15 / 13.0 + 4 * sqrt(3.2 * 18));
    for (int k = 0; k < 3; k++) /* what others leave behind is not gathered in a few */
        ck_assert_double_lt(tally.square[k], 4 * light[k] * tally.until[t.lights.count - 1]);
    tally_close(&tally);
    tracer_close(&t);
    free(window);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

START_TEST(test_split)
{
    split_boxes(DARK);
}
END_TEST

/* The dark box has a lamp of its own that nobody would miss: as many start there as elsewhere, and
 * what they carry is not gathered in a few. */
START_TEST(test_split_weak_lamp)
{
    split_boxes(1e-10);
}
END_TEST

/* As a whole: the walls of that box are known, and right where links were. */
START_TEST(test_weak_lamp)
{
    struct scene scene;
    struct solve s;
    struct measured_error alone;
    two_furnaces(&s, &scene, 1e-10, 2);
    mend_all(&s, 1e-2, 200000, &alone);
    ck_assert_double_eq_tol(of_face(&s, WALL) / 1e-10, 1, 0.05);
    for (uint32_t i = 0; i < alone.dim.unsure; i++)
        ck_assert_uint_gt(alone.dim.named[i], WALL);
    measured_error_free(&alone);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* However much a first look might have taken: what is paid for is believed. */
START_TEST(test_large_budget)
{
    struct scene scene;
    struct solve s;
    uint64_t rays;
    double root;
    two_furnaces(&s, &scene, DARK, 2);
    spoil_wall(&s);
    ck_assert_int_eq(mend_apart(&s, 200000, 2000000, &rays, &root), 1);
    ck_assert_double_eq_tol(of_face(&s, WALL) / DARK, 1, 0.05);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Where mending has taken all that it may, paths take no more than that again; also where that much
 * more would make surer what is known. */
START_TEST(test_budget)
{
    const double most = 1.6e6; /* what is left of DIM_FEW may be taken in any case */
    struct scene scene;
    struct solve s;
    struct measured_error alone;
    furnaces_cut(&s, &scene, DARK, 1, 2); /* six dark walls */
    mend_all(&s, 1e-5, (uint64_t)most, &alone);
    printf("at most %.0f rays: %.0f in all\n", most, (double)alone.rays);
    ck_assert_double_gt((double)alone.rays, 1.2 * most);
    ck_assert_double_lt((double)alone.rays, 2.1 * most);
    measured_error_free(&alone);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* A box of faces with two sides, whose insides are dark, in a room: each is as large as both. */
START_TEST(test_dark_side)
{
    struct scene scene;
    struct solve s;
    ck_assert_int_eq(scene_read(&scene, "tests/runtime/dark_box.obj", &(struct scene_options){0}),
                     0);
    const char *cause;
    ck_assert_int_eq(lit_faces_find(&scene, NULL, 1, &cause), 0);
    solve_with(&s, &scene, "power", RELEASE_FLAT, NULL, quick(1));
    uint32_t dark = 0;
    for (uint32_t i = 0; i < s.hierarchy.face_count; i++)
        dark += s.hierarchy.faces[i].light == FACE_DARK;
    ck_assert_uint_eq(dark, 6);
    struct tracer t = solve_tracer(&s);
    ck_assert_int_eq(tracer_open(&t), 0);
    struct dim_faces d = {.size = DIM_LARGE_ONES, .solve = &s, .tracer = &t};
    ck_assert_int_eq(dim_list_open(&d, 100), 0);
    ck_assert_uint_eq(d.count, 12);
    dim_list_close(&d);
    tracer_close(&t);
    solve_close(&s);
    scene_free(&scene);
}
END_TEST

/* Groups are of one wall each, and no face that is small is left out. */
START_TEST(test_groups)
{
    struct scene scene;
    struct solve s;
    struct tracer tracer;
    double area[WALL + 1 + 5 * CUTS * CUTS] = {0};
    uint32_t part[WALL + 1 + 5 * CUTS * CUTS], count = WALL + 1 + 5 * CUTS * CUTS,
                                               members[GROUPS] = {0};
    two_furnaces(&s, &scene, DARK, 1);
    ck_assert_uint_eq(scene.face_count, count);
    tracer = solve_tracer(&s);
    ck_assert_int_eq(tracer_open(&tracer), 0);
    const struct hierarchy *h = &s.hierarchy;
    for (uint32_t i = 0; i < h->face_count; i++) {
        part[i] = h->faces[i].input;
        area[part[i]] += tracer_surface(&tracer, i)->area;
    }
    ck_assert_int_eq(dim_parts_find(&tracer, area, 0.01 * 12, part, &count), 0);
    ck_assert_uint_eq(count, h->face_count + GROUPS);
    const double *normal[GROUPS];
    for (uint32_t i = 0; i < h->face_count; i++) {
        const uint32_t of = part[i] - h->face_count;
        if (h->faces[i].input <= WALL) {
            ck_assert_uint_eq(part[i], h->faces[i].input);
            continue;
        }
        ck_assert_uint_lt(of, GROUPS);
        if (members[of]++ == 0)
            normal[of] = tracer_surface(&tracer, i)->normal;
        ck_assert_double_gt(dot3(normal[of], tracer_surface(&tracer, i)->normal), 0.999);
    }
    for (int i = 0; i < GROUPS; i++)
        ck_assert_uint_eq(members[i], 2);
    tracer_close(&tracer);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Few rays: of the dark box nothing is known, and so it is said, by wall and by group. */
START_TEST(test_groups_told)
{
    struct scene scene;
    struct solve s;
    struct measured_error alone;
    two_furnaces(&s, &scene, DARK, 2);
    s.report.counts.rays = 1000000000; /* so that none is left for what is small */
    mend_all(&s, 1e-2, 20000, &alone);
    ck_assert_uint_eq(alone.gathered, GROUPS);
    ck_assert_uint_ge(alone.dim.unsure, GROUPS / 2);
    for (uint32_t i = 0; i < alone.dim.unsure; i++) {
        ck_assert_uint_ge(alone.dim.named[i], WALL);
        ck_assert(i == 0 || alone.dim.named[i] > alone.dim.named[i - 1]);
    }
    measured_error_free(&alone);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* What is small and not known is counted, though no ray is left to ask it: all parts of the dark
 * box. Parts of a bright one that few particles met links and particles together know, but for one
 * in twenty. */
START_TEST(test_small_told)
{
    static const double light[] = {DARK, 1};
    for (int i = 0; i < 2; i++) {
        struct scene scene;
        struct solve s;
        struct measured_error alone;
        two_furnaces(&s, &scene, light[i], 2);
        s.report.counts.rays = 1000000000;
        mend_all(&s, 1e-2, 200000, &alone);
        if (i == 0)
            ck_assert_uint_eq(alone.small.unsure, 5 * CUTS * CUTS);
        else
            ck_assert_uint_le(alone.small.unsure, 5 * CUTS * CUTS / 20);
        ck_assert_double_eq_tol(alone.small.area, alone.small.unsure * (1.0 / (CUTS * CUTS)), 1e-9);
        measured_error_free(&alone);
        solve_close(&s);
        made_close(&scene);
    }
}
END_TEST

/* Small faces where little light is: all of them are three times too bright, and none stays so. */
START_TEST(test_small)
{
    struct scene scene;
    struct solve s;
    struct measured_error alone;
    two_furnaces(&s, &scene, DARK, 2);
    spoil(&s, WALL + 1, scene.face_count, 3);
    mend_all(&s, 1e-2, 200000, &alone);
    for (uint32_t f = WALL + 1; f < scene.face_count; f++)
        ck_assert_double_eq_tol(of_face(&s, f) / DARK, 1, 0.15);
    measured_error_free(&alone);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* What surrounds the wall is ten times too bright, and too dim for particles to tell: paths go on
 * from there and end in nothing that nobody knows. */
START_TEST(test_dim_places)
{
    struct scene scene;
    struct solve s;
    uint64_t rays;
    double root;
    two_furnaces(&s, &scene, DARK, 2);
    spoil(&s, WALL + 1, scene.face_count, 10);
    ck_assert_int_eq(mend_apart(&s, 20000, 400000, &rays, &root), 1);
    ck_assert_double_eq_tol(of_face(&s, WALL) / DARK, 1, 0.05);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* L1 error of the bright walls, leaf by leaf, a share of their light; *leaves: how many. */
static double bright_error(const struct solve *s, uint32_t *leaves)
{
    const struct hierarchy *h = &s->hierarchy;
    double off = 0, area = 0;
    *leaves = 0;
    for (uint32_t e = 0; e < h->count; e++) {
        const struct element *at = &h->elements[e];
        if (!at->vertices || at->children || at->face >= WALL)
            continue;
        off += fabs(s->mended.irradiance[e] - 1) * at->area;
        area += at->area;
        ++*leaves;
    }
    return off / area;
}

/* Split particles come through what is bright, and tell of it, too: what a few have left there,
 * where links know nothing of how light is shared, is less than half as much then. The lamp of
 * the dark box hangs low over its floor, where paths from other walls seldom find it. */
START_TEST(test_split_tells_of_bright)
{
    enum { FEW = 8000, MANY = 200000 };
    static char *settings[] = {"min_share=0.005", NULL};
    static const struct dim_budget none = {0, 0, 0}, split = {1000, 1000, MANY};
    double off[2], root;
    for (int i = 0; i < 2; i++) {
        struct scene scene;
        struct solve s;
        uint64_t rays;
        uint32_t leaves;
        made_open(&scene);
        const uint32_t bright = made_material(&scene, RHO, 1 - RHO),
                       dark = made_material(&scene, RHO, 0), lamp = made_material(&scene, 0, 0.1);
        const uint32_t walls[6] = {bright, bright, bright, bright, bright, bright};
        made_room(&scene, walls, 1, 1, 1);
        for (int wall = 0; wall < 6; wall++)
            add_part(&scene, dark, &scene.faces[wall], 1, 0);
        made_quad(&scene, lamp, 5.4, 0.4, 0.01, 0, 0.2, 0, 0.2, 0, 0); /* turned down */
        solve_with(&s, &scene, "bf", RELEASE_FLAT, settings, quick(2));
        for (uint32_t e = 0; e < s.hierarchy.count; e++)
            if (s.hierarchy.elements[e].vertices && s.hierarchy.elements[e].face < WALL) {
                s.state.irradiance[e] *= e % 2 ? 1.3 : 0.7;
                s.state.radiosity[e] = 1 - RHO + RHO * s.state.irradiance[e];
            }
        ck_assert_int_ge(mend_within(&s, FEW, i ? &split : &none, &rays, &root), 0);
        off[i] = bright_error(&s, &leaves);
        printf("%u leaves off by %.4f: %u rays for dim walls\n", (unsigned)leaves, off[i],
               (unsigned)rays);
        ck_assert_uint_ge(leaves, 24);
        ck_assert(i == 0 || rays > MANY / 2);
        solve_close(&s);
        made_close(&scene);
    }
    ck_assert_double_lt(off[1], 0.5 * off[0]);
}
END_TEST

/* Sum of moduli of what the bright walls lack of their light, over that. */
static double walls_off(const struct solve *s, const double *irradiance)
{
    double off = 0;
    for (uint32_t f = 0; f < WALL; f++)
        off += fabs(irradiance[s->hierarchy.face_element[f]] - 1) / WALL;
    return off;
}

static void count_some(struct tally *tally, const struct tracer *t, uint64_t stream,
                       uint64_t particles)
{
    ck_assert_int_eq(tally_open(tally, t, stream, 1), 0);
    ck_assert_int_eq(tally_trace(tally, t, particles / REPLICATES, NULL), 0);
}

/* What all faces of a room receive, and reflect (W). */
static void sum_faces(const struct solve *s, const double *irradiance, double sum[2])
{
    sum[0] = sum[1] = 0;
    for (uint32_t f = 0; f < s->hierarchy.face_count; f++) {
        const uint32_t e = s->hierarchy.face_element[f];
        const double light = s->hierarchy.elements[e].area * irradiance[e];
        sum[0] += light;
        sum[1] += s->problem.reflectance[f] * light;
    }
}

/* A room of white and dark tiles, of which links have the white ones too bright and the others too
 * dark. No count of a tile is believed, but that of what all reflect is, and tiles are settled for
 * it: then they receive less than 6 W, which the scene does. Few that count anew leave both. */
START_TEST(test_again_in_all)
{
    enum { TILES = 8 };
    struct scene scene;
    struct solve s;
    struct tally many, few;
    made_open(&scene);
    const uint32_t white = made_material(&scene, 0.9, 0.1), dark = made_material(&scene, 0.1, 0.9);
    const uint32_t walls[6] = {white, dark, white, dark, white, dark};
    made_room(&scene, walls, 1, 1, 1);
    static struct face wall[6];
    memcpy(wall, scene.faces, sizeof wall);
    scene.face_count = scene.input_count = 0;
    for (int i = 0; i < 6; i++)
        for (int part = 0; part < TILES * TILES; part++)
            add_part(&scene, part % 2 ? white : dark, &wall[i], TILES, part);
    static char *settings[] = {"min_share=0.02", NULL};
    solve_with(&s, &scene, "bf", RELEASE_FLAT, settings, quick(2));
    for (uint32_t e = 0; e < s.hierarchy.count; e++)
        if (s.hierarchy.elements[e].vertices)
            s.state.irradiance[e] *=
                scene.faces[s.hierarchy.elements[e].face].material == white ? 1.1 : 0.9;
    const size_t size = s.hierarchy.count * sizeof(double);
    double *mended = malloc(size), *again = malloc(size), before[2], after[2];
    struct tracer t = solve_tracer(&s);
    ck_assert_int_eq(tracer_open(&t), 0);
    count_some(&many, &t, 0, 10000);
    count_some(&few, &t, 1, 2000);
    memcpy(mended, s.state.irradiance, size);
    ck_assert_int_eq(mend_irradiance(&s.operator, & many, mended), 0);
    memcpy(again, mended, size);
    ck_assert_int_eq(mend_again(&s.operator, & few, &many, s.state.irradiance, again), 0);
    sum_faces(&s, mended, before);
    sum_faces(&s, again, after);
    printf("received %.6f, then %.6f; reflected %.6f, then %.6f W; 6 and 3\n", before[0], after[0],
           before[1], after[1]);
    ck_assert_double_lt(before[0], 5.95);
    for (int i = 0; i < 2; i++)
        ck_assert_double_eq_tol(after[i] / before[i], 1, 0.005);
    tally_close(&many);
    tally_close(&few);
    free(mended);
    free(again);
    tracer_close(&t);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Few that count anew leave what many have mended as it is: of twenty draws in the mean. Without
 * knowing of the many, a cluster alone in its class would often be believed what it got by chance.
 */
START_TEST(test_again)
{
    enum { FEW = 4000, MANY = 400000, DRAWS = 20 };
    struct scene scene;
    struct solve s;
    struct tally many, few;
    two_furnaces(&s, &scene, DARK, 2);
    for (uint32_t e = 0; e < s.hierarchy.count; e++) /* links are off from wall to wall */
        if (s.hierarchy.elements[e].vertices && s.hierarchy.elements[e].face < WALL)
            s.state.irradiance[e] *= s.hierarchy.elements[e].face % 2 ? 1.2 : 0.8;
    const size_t size = s.hierarchy.count * sizeof(double);
    double *mended = malloc(size), *again = malloc(size), off[3] = {0, 0, 0};
    struct tracer t = solve_tracer(&s);
    ck_assert_int_eq(tracer_open(&t), 0);
    for (uint64_t i = 0; i < DRAWS; i++) {
        count_some(&many, &t, 2 * i, MANY);
        count_some(&few, &t, 2 * i + 1, FEW);
        memcpy(mended, s.state.irradiance, size);
        ck_assert_int_eq(mend_irradiance(&s.operator, & many, mended), 0);
        off[0] += walls_off(&s, mended) / DRAWS;
        memcpy(again, mended, size);
        ck_assert_int_eq(mend_irradiance(&s.operator, & few, again), 0);
        off[1] += walls_off(&s, again) / DRAWS;
        memcpy(again, mended, size);
        ck_assert_int_eq(mend_again(&s.operator, & few, &many, s.state.irradiance, again), 0);
        off[2] += walls_off(&s, again) / DRAWS;
        ck_assert_double_eq_tol(again[0], mended[0], 1e-12);
        tally_close(&many);
        tally_close(&few);
    }
    printf("many leave %.5f; few, again, %.5f, knowing of the many %.5f\n", off[0], off[1], off[2]);
    ck_assert_double_gt(off[1], 1.5 * off[0]);
    ck_assert_double_lt(off[2], 1.1 * off[0]);
    free(mended);
    free(again);
    tracer_close(&t);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* A closed room in which H is 1 W/m2 of red light and DARK of blue, everywhere: walls emit 1 - rho
 * of either. All but the first reflect blue alone, and are known by what few particles are left
 * with of it, unless these are split by bands: by all light walls are as bright as any. */
START_TEST(test_dim_band)
{
    struct scene scene;
    struct solve s;
    struct measured_error alone;
    made_open(&scene);
    scene.bands = 3;
    const uint32_t red = made_material(&scene, 0, 0), blue = made_material(&scene, 0, 0);
    scene.materials[red].reflectance[0] = 0.9;
    scene.materials[red].exitance[0] = 0.1;
    scene.materials[red].exitance[2] = DARK;
    scene.materials[blue].reflectance[2] = 0.9;
    scene.materials[blue].exitance[0] = 1;
    scene.materials[blue].exitance[2] = DARK / 10;
    const uint32_t walls[6] = {red, blue, blue, blue, blue, blue};
    made_room(&scene, walls, 1, 1, 1);
    solve_with(&s, &scene, "power", RELEASE_FLAT, NULL, quick(2));
    mend_all(&s, 1e-2, 200000, &alone);
    printf("of blue light particles know walls to %.2g\n", alone.faces.band_noise[2]);
    ck_assert_uint_eq(alone.dim.unsure, 0);
    for (uint32_t f = 1; f < 6; f++)
        ck_assert_double_eq_tol(s.mended.irradiance[3 * s.hierarchy.face_element[f] + 2] / DARK, 1,
                                0.05);
    ck_assert_double_lt(alone.faces.band_noise[2], 0.2); /* .28 by those that are not split */
    measured_error_free(&alone);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Where every large face is met by particles enough, nothing is asked and nothing paid. */
START_TEST(test_bright)
{
    struct scene scene;
    struct solve s;
    uint64_t rays;
    double root;
    two_furnaces(&s, &scene, 1, 2);
    ck_assert_int_eq(mend_apart(&s, 200000, 20000, &rays, &root), 0);
    ck_assert_uint_eq(rays, 0);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* A red lamp for a ceiling, and one wall that reflects red; what the others reflect no lamp emits,
 * so that they are dark for sure and nobody asks for their light; or only one outside of
 * the room does, which paths cannot know. What they receive of the red lamp's light is none of
 * their light, and not for paths to change: the red wall keeps what it has, F. */
static void other_colours(int green_lamp)
{
    const double F = 0.2000437760754032;
    static const double at[3] = {5, 0, 0}, along[3][3] = {{0, 0.1, 0}, {0.1, 0, 0}, {0, 0, 0.1}};
    struct scene scene;
    struct solve s;
    struct measured_error alone;
    made_open(&scene);
    scene.bands = 3;
    const uint32_t cyan = made_material(&scene, 0, 0), red = made_material(&scene, 0, 0),
                   lamp = made_material(&scene, 0, 0), green = made_material(&scene, 0, 0);
    scene.materials[cyan].reflectance[1] = scene.materials[cyan].reflectance[2] = 0.5;
    scene.materials[red].reflectance[0] = 0.3;
    scene.materials[lamp].exitance[0] = 1;
    scene.materials[green].exitance[1] = 1;
    const uint32_t walls[6] = {red, cyan, cyan, cyan, cyan, lamp};
    made_room(&scene, walls, 1, 1, 1);
    if (green_lamp)
        made_box(&scene, green, at, along, 0);
    solve_with(&s, &scene, "power", RELEASE_FLAT, NULL, quick(2));
    mend_all(&s, 1e-2, 200000, &alone);
    ck_assert_uint_eq(alone.dim.large, green_lamp ? 5 : 1);
    ck_assert_uint_eq(alone.dim.unsure, green_lamp ? 4 : 0);
    ck_assert_double_eq_tol(s.mended.irradiance[3 * s.hierarchy.face_element[0]] / F, 1, 0.003);
    measured_error_free(&alone);
    solve_close(&s);
    made_close(&scene);
}

START_TEST(test_other_colours)
{
    other_colours(0);
}
END_TEST

START_TEST(test_lamp_outside)
{
    other_colours(1);
}
END_TEST

/* A thousand paths that agree about a tenth of what particles count, to a tenth of that, have
 * missed what the rest comes from; those that say nearly the same know it best. */
START_TEST(test_missed)
{
    const struct dim_faces d = {.unseen = 0};
    struct dim_polygon p = {.light = 1, .variance = 0.01, .paths = 1000, .all = 100, .square = 11};
    ck_assert_double_lt(dim_path_weight(&d, &p), 0.06);
    p.all = 950;
    p.square = 903.5;
    ck_assert_double_gt(dim_path_weight(&d, &p), 0.99);
}
END_TEST

/* Paths that find 1 or 3 W/m2, one as often as the other, on polygons of 2 W/m2 of which nothing
 * else is known. */
static void open_plan(struct dim_faces *d, struct dim_polygon *polygon, uint32_t count)
{
    const uint64_t looked = 100;
    *d = (struct dim_faces){
        .size = DIM_LARGE_ONES, .polygon = polygon, .count = count, .sure = DIM_GOAL / 2};
    for (uint32_t i = 0; i < count; i++)
        polygon[i] = (struct dim_polygon){.light = 2,
                                          .variance = 1e6,
                                          .looked = looked,
                                          .paths = looked,
                                          .sighted = looked,
                                          .rays = 4 * looked,
                                          .all = 2 * (double)looked,
                                          .square = 5 * (double)looked};
}

/* The standard error that is planned, of the light. */
static double planned(const struct dim_polygon *p)
{
    return 1 / sqrt((double)p->wanted) / 2;
}

/* All reach DIM_GOAL by the rays that there are, and where there may be more go on to what many are
 * to have; one that is too noisy gets what is left, and the others still go on. */
START_TEST(test_plan)
{
    enum { COUNT = 5 };
    const double goal = 4 / (4 * DIM_GOAL * DIM_GOAL), all = COUNT * goal;
    struct dim_polygon polygon[COUNT];
    struct dim_faces d;
    open_plan(&d, polygon, COUNT);
    dim_plan(&d, 1.1 * all, 1.1 * all);
    for (int i = 0; i < COUNT; i++)
        ck_assert(polygon[i].planned && planned(&polygon[i]) < 1.03 * DIM_GOAL);
    ck_assert_double_gt(planned(&polygon[0]), 0.9 * DIM_GOAL);
    dim_plan(&d, 1.1 * all, 5 * all);
    for (int i = 0; i < COUNT; i++)
        ck_assert_double_eq_tol(planned(&polygon[i]), d.sure, 0.03 * d.sure);
    polygon[2].square *= 1000;
    dim_plan(&d, 1.1 * all, 5 * all);
    for (int i = 0; i < COUNT; i++)
        if (i != 2)
            ck_assert_double_eq_tol(planned(&polygon[i]), d.sure, 0.03 * d.sure);
    ck_assert(!polygon[2].planned && polygon[2].wanted > polygon[2].paths);
    ck_assert_double_le(4 * (double)polygon[2].wanted,
                        1.1 * all - (COUNT - 1) * goal + COUNT * 400);
}
END_TEST

/* What is sure gets nothing more, the others what makes them sure; where paths miss something, or
 * all light is not known so well, none do. */
START_TEST(test_plan_rest)
{
    enum { COUNT = 3 };
    struct dim_polygon polygon[COUNT];
    struct dim_faces d;
    open_plan(&d, polygon, COUNT);
    polygon[1].variance = 1e-6;
    const double rays = dim_plan_rest(&d);
    ck_assert_uint_eq(polygon[1].wanted, polygon[1].paths);
    ck_assert_double_eq_tol(planned(&polygon[0]), DIM_GOAL / DIM_MARGIN, 1e-2 * DIM_GOAL);
    ck_assert_double_eq_tol(rays, 8 * (double)(polygon[0].wanted - polygon[0].paths), 1e-9 * rays);
    polygon[2].light = 20;
    polygon[2].variance = 1;
    ck_assert(isinf(dim_plan_rest(&d)));
    open_plan(&d, polygon, COUNT);
    d.shared = DIM_GOAL * DIM_GOAL;
    ck_assert(isinf(dim_plan_rest(&d)));
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("dim faces");
    TCase *tests = tcase_create("");
    tcase_set_timeout(tests, 60);
    tcase_add_test(tests, test_missed);
    tcase_add_test(tests, test_found);
    tcase_add_test(tests, test_stood_on);
    tcase_add_test(tests, test_unsure);
    tcase_add_test(tests, test_dark_side);
    tcase_add_test(tests, test_groups);
    tcase_add_test(tests, test_groups_told);
    tcase_add_test(tests, test_plan);
    tcase_add_test(tests, test_plan_rest);
    tcase_add_test(tests, test_split);
    tcase_add_test(tests, test_split_bands);
    tcase_add_test(tests, test_split_weak_lamp);
    tcase_add_test(tests, test_weak_lamp);
    tcase_add_test(tests, test_split_tells_of_bright);
    tcase_add_test(tests, test_again);
    tcase_add_test(tests, test_again_in_all);
    tcase_add_test(tests, test_same_bits);
    tcase_add_test(tests, test_large_budget);
    tcase_add_test(tests, test_budget);
    tcase_add_test(tests, test_small);
    tcase_add_test(tests, test_small_told);
    tcase_add_test(tests, test_dim_places);
    tcase_add_test(tests, test_bright);
    tcase_add_test(tests, test_dim_band);
    tcase_add_test(tests, test_other_colours);
    tcase_add_test(tests, test_lamp_outside);
    suite_add_tcase(suite, tests);
    return suite_failures(suite) > 0;
}
