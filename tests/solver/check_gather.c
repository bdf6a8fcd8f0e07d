/* check_gather.c - light gathered at points: furnaces, closed forms of the ground truth in
 * ../shared/failures.md, references by chance; and the pictures made of it.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "folder.h"
#include "kernel/surface_point.h"
#include "load_scene.h"
#include "output/image.h"
#include "suite.h"

enum { POINTS = 256, RAYS = 4096, MANY = 1 << 16 };

struct solved_scene {
    struct loaded loaded; /* of a file; else the next two alone */
    RadDevice device;
    RadScene scene;
    RadOracle oracle;
    RadSolution solution;
};

static void solve(struct solved_scene *s, const char *oracle, const char *parameter, double value,
                  const struct RadSolveOptions *options)
{
    s->oracle = radNewOracle(s->device, oracle, RAD_RELEASE_FLAT);
    ck_assert_ptr_nonnull(s->oracle);
    if (parameter)
        ck_assert_int_eq(radSetOracleParameter(s->oracle, parameter, value), 0);
    s->solution = radNewSolution(s->scene, s->oracle, options);
    ck_assert_int_eq(radSolve(s->solution), 0);
}

static void solve_file(struct solved_scene *s, const char *path, const char *oracle,
                       const struct RadSolveOptions *options)
{
    *s = (struct solved_scene){0};
    load_scene(&s->loaded, path);
    s->device = s->loaded.device;
    s->scene = s->loaded.scene;
    solve(s, oracle, NULL, 0, options);
}

/* Quads, one material each. */
static void make_quads(struct solved_scene *s, const double *corners,
                       const struct RadMaterial *materials, uint32_t count, int threads)
{
    uint32_t indices[32], own[8];
    for (uint32_t i = 0; i < 4 * count; i++)
        indices[i] = i;
    for (uint32_t i = 0; i < count; i++)
        own[i] = i;
    const struct RadPolygons polygons = {.positions = corners,
                                         .position_count = (size_t)4 * count,
                                         .indices = indices,
                                         .size = 4,
                                         .materials = own,
                                         .count = count};
    *s = (struct solved_scene){.device =
                                   radNewDevice(&(struct RadDeviceOptions){.threads = threads})};
    s->scene = radNewScene(s->device);
    ck_assert_int_eq(radSetSceneMaterials(s->scene, materials, count), 0);
    ck_assert_int_eq(radSetSceneSharedPolygons(s->scene, &polygons), 0);
    ck_assert_int_eq(radCommitScene(s->scene), 0);
}

static void close_scene(struct solved_scene *s)
{
    radReleaseSolution(s->solution);
    radReleaseOracle(s->oracle);
    if (s->loaded.scene) {
        unload_scene(&s->loaded);
        return;
    }
    radReleaseScene(s->scene);
    radReleaseDevice(s->device);
}

static struct RadMaterial grey(double rho, double exitance)
{
    return (struct RadMaterial){{rho, rho, rho}, {exitance, exitance, exitance}, 0};
}

/* Grey B at a point of a face. */
static double gather(struct solved_scene *s, uint32_t face, double x, double y, double z,
                     uint32_t rays)
{
    const struct RadGatherPoint point = {face, {x, y, z}, 7, 0, rays};
    double radiosity[3];
    ck_assert_msg(radGather(s->solution, &point, 1, radiosity) == 0, "%s",
                  radGetDeviceErrorMessage(s->device));
    return radiosity[0];
}

/* Where all is equally bright there is no noise: one ray is as good as a thousand. */
START_TEST(furnace_is_exact)
{
    struct solved_scene s;
    struct RadElements e;
    solve_file(&s, "examples/scenes/furnace.obj", "clusters", NULL);
    radGetElements(s.solution, &e);
    double least = INFINITY, most = 0;
    for (uint32_t i = 0; i < e.count; i++) {
        least = fmin(least, e.radiosity[i * e.bands]);
        most = fmax(most, e.radiosity[i * e.bands]);
    }
    ck_assert_double_eq_tol(least, 2, 2e-3);
    ck_assert_double_eq_tol(most, 2, 2e-3);
    for (uint32_t rays = 1; rays < 100; rays = 3 * rays + 1) {
        const struct RadFace *f = &radGetSceneFaces(s.scene)[0];
        double p[3], B;
        for (int k = 0; k < 3; k++)
            p[k] = 0.7 * f->vertex[0][k] + 0.3 * f->vertex[2][k];
        B = gather(&s, 0, p[0], p[1], p[2], rays);
        ck_assert_double_ge(B, 1 + 0.5 * least - 1e-9);
        ck_assert_double_le(B, 1 + 0.5 * most + 1e-9);
    }
    close_scene(&s);
}
END_TEST

/* A lamp of side 1 at z = 2 over a black square of side .75 at z = 1: what the floor receives on
 * the axis of x, whatever the elements are. */
START_TEST(penumbra)
{
    static const double corners[36] = {
        -.5,  -.5,  2, -.5,  .5,    2, .5, .5, 2, .5, -.5, 2, -.375, -.375, 1, -.375, .375, 1,
        .375, .375, 1, .375, -.375, 1, -3, -3, 0, 3,  -3,  0, 3,     3,     0, -3,    3,    0};
    static const double at[5] = {.25, .5, .75, 1, 1.5};
    static const double falls[5] = {0, .0189169153, .0337198400, .0405845563, .0326632655};
    const struct RadMaterial materials[3] = {grey(0, 1), grey(0, 0), grey(.5, 0)};
    struct solved_scene s;
    make_quads(&s, corners, materials, 3, 2);
    solve(&s, "ff", NULL, 0, NULL);
    uint32_t floor = 0;
    while (radGetSceneFaces(s.scene)[floor].input != 2)
        floor++;
    for (int i = 0; i < 5; i++)
        ck_assert_double_eq_tol(gather(&s, floor, at[i], 0, 0, RAYS), .5 * falls[i],
                                .5 * falls[4] * .01);
    close_scene(&s);
}
END_TEST

/* Two unit squares that face each other, E = 1 and rho = 1/2: the continuous solution in the
 * middle, in the middle of an edge and in a corner, from a solution in few elements. */
START_TEST(plates)
{
    static const double corners[24] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0,
                                       0, 0, 1, 0, 1, 1, 1, 1, 1, 1, 0, 1};
    const struct RadMaterial materials[2] = {grey(.5, 1), grey(.5, 1)};
    struct solved_scene s;
    make_quads(&s, corners, materials, 2, 2);
    solve(&s, "clusters", NULL, 0, NULL);
    ck_assert_double_eq_tol(gather(&s, 0, .5, .5, 0, MANY), 1.133303564992, 4e-4);
    ck_assert_double_eq_tol(gather(&s, 0, 0, .5, 0, MANY), 1.100306232464, 4e-4);
    ck_assert_double_eq_tol(gather(&s, 0, 0, 0, 0, MANY), 1.076981393145, 4e-4);
    close_scene(&s);
}
END_TEST

static void spread_points(const struct RadElements *e, uint32_t face, uint32_t rays,
                          struct RadGatherPoint *points)
{
    const struct element *of = &e->elements[e->face_element[face]];
    for (uint32_t i = 0; i < POINTS; i++) {
        points[i] = (struct RadGatherPoint){face, {0, 0, 0}, 0, i * rays, rays};
        surface_even_point(points[i].position, of, (i % 16 + .5) / 16, (i / 16 + .5) / 16);
    }
}

/* Means over faces are those of paths and particles that know of no elements; so are those of a
 * solution whose elements are much too large. */
START_TEST(means_of_faces)
{
    struct solved_scene s;
    struct RadElements e;
    solve_file(&s, "examples/scenes/cornell.obj", "ff", NULL);
    ck_assert_int_eq(radCorrect(s.solution, NULL, NULL), 0);
    radGetElements(s.solution, &e);
    RadReference r = radNewReference(s.scene);
    double truth[32], deviation[32];
    ck_assert_uint_le(s.loaded.report.polygons, 32);
    ck_assert_int_eq(radTraceReference(r, RAD_METHOD_PARTICLES, 1 << 18), 0);
    ck_assert_int_eq(radTraceReference(r, RAD_METHOD_PATHS, 1 << 15), 0);
    ck_assert_int_eq(radGetReferenceValues(r, RAD_METHOD_BOTH, 1, truth, deviation), 0);
    int held = 0;
    for (uint32_t f = 0; f < s.loaded.report.faces; f++) {
        const struct RadFace *face = &s.loaded.surfaces.faces[f];
        struct RadGatherPoint points[POINTS];
        double gathered[POINTS][3], mean = 0;
        if (e.elements[e.face_element[f]].area < .99 * radGetScenePolygonAreas(s.scene)[face->input]
            || e.uncovered[e.face_element[f]] < 1 || !(truth[face->input] > 0))
            continue;
        spread_points(&e, f, 64, points);
        ck_assert_int_eq(radGather(s.solution, points, POINTS, gathered[0]), 0);
        for (int i = 0; i < POINTS; i++)
            mean += gathered[i][1] / POINTS;
        ck_assert_double_eq_tol(mean, truth[face->input],
                                .01 * truth[face->input] + 4 * deviation[face->input]);
        held++;
    }
    ck_assert_int_ge(held, 8);
    radReleaseReference(r);
    close_scene(&s);
}
END_TEST

/* A spot that a lamp throws on the ceiling right above it is found, though elements hold nothing of
 * it: it sends its light down as brightly with few rays as with many. */
START_TEST(bright_spots)
{
    static const double corners[36] = {-2,  -2,  2,   -2, 2,   2,   2,  2,  2,   2,   -2, 2,
                                       -.2, -.2, 1.5, .2, -.2, 1.5, .2, .2, 1.5, -.2, .2, 1.5,
                                       -2,  -2,  0,   2,  -2,  0,   2,  2,  0,   -2,  2,  0};
    const struct RadMaterial materials[3] = {grey(.8, 0), grey(0, 100), grey(.5, 0)};
    struct solved_scene s;
    make_quads(&s, corners, materials, 3, 2);
    solve(&s, "clusters", NULL, 0, NULL);
    uint32_t floor = 0;
    while (radGetSceneFaces(s.scene)[floor].input != 2)
        floor++;
    double many = gather(&s, floor, .9, .4, 0, 1 << 15), spread = 0;
    enum { SETS = 1024 }; /* their spread is known to a fiftieth then */
    struct RadGatherPoint points[SETS];
    double B[SETS], mean = 0;
    for (int i = 0; i < SETS; i++)
        points[i] = (struct RadGatherPoint){floor, {.9, .4, 0}, (uint64_t)i, 0, 64};
    ck_assert_int_eq(radGather(s.solution, points, SETS, B), 0);
    for (int i = 0; i < SETS; i++)
        mean += B[i] / SETS;
    for (int i = 0; i < SETS; i++)
        spread += (B[i] - mean) * (B[i] - mean) / (SETS - 1);
    ck_assert_double_lt(sqrt(spread), .15 * many);
    ck_assert_double_eq_tol(mean, many, 4 * sqrt(spread / SETS) + .005 * many);
    close_scene(&s);
}
END_TEST

/* The same bits on any number of threads, and for points alone or together. */
START_TEST(same_on_all_threads)
{
    static const double corners[24] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0,
                                       0, 0, 1, 0, 1, 1, 1, 1, 1, 1, 0, 1};
    const struct RadMaterial materials[2] = {grey(.5, 0), grey(.5, 1)};
    double first[POINTS], other[POINTS];
    for (int threads = 1; threads < 4; threads++) {
        struct solved_scene s;
        struct RadElements e;
        struct RadGatherPoint points[POINTS];
        make_quads(&s, corners, materials, 2, threads);
        solve(&s, "ff", NULL, 0, NULL);
        radGetElements(s.solution, &e);
        spread_points(&e, 0, 33, points);
        ck_assert_int_eq(radGather(s.solution, points, POINTS, threads > 1 ? other : first), 0);
        ck_assert(threads == 1 || memcmp(first, other, sizeof first) == 0);
        ck_assert_int_eq(radGather(s.solution, &points[100], 1, other), 0);
        ck_assert(memcmp(&first[100], other, sizeof *other) == 0);
        close_scene(&s);
    }
}
END_TEST

static void check_refused(struct solved_scene *s, const struct RadGatherPoint *point,
                          const char *word)
{
    double radiosity[3];
    ck_assert_int_eq(radGather(s->solution, point, 1, radiosity), -1);
    ck_assert_msg(strstr(radGetDeviceErrorMessage(s->device), word), "%s",
                  radGetDeviceErrorMessage(s->device));
    ck_assert_int_ne(radGetDeviceError(s->device), RAD_ERROR_NONE);
}

START_TEST(what_is_refused)
{
    struct solved_scene s;
    solve_file(&s, "examples/scenes/furnace.obj", "ff", NULL);
    check_refused(&s, &(struct RadGatherPoint){6, {0, 0, 0}, 0, 0, 1}, "face 6; there are 6");
    check_refused(&s, &(struct RadGatherPoint){0, {NAN, 0, 0}, 0, 0, 1}, "finite");
    check_refused(&s, &(struct RadGatherPoint){0, {0.5, 0.5, 1e300}, 0, 0, 1}, "finite");
    check_refused(&s, &(struct RadGatherPoint){0, {0.5, 0.5, 1e38}, 0, 0, 1}, "farther");
    check_refused(&s, &(struct RadGatherPoint){0, {0.5, 0.5, -3}, 0, 0, 1}, "farther");
    check_refused(&s, &(struct RadGatherPoint){0, {0, 0, 0}, 0, 0, 0}, "0 rays");
    check_refused(&s, &(struct RadGatherPoint){0, {0, 0, 0}, 0, UINT32_MAX, 2}, "below 2^32");
    check_refused(&s, NULL, "needs points");
    ck_assert_int_eq(radGather(s.solution, NULL, 0, NULL), 0);
    ck_assert_int_eq(radGather(NULL, NULL, 0, NULL), -1);
    radReleaseSolution(s.solution);
    s.solution = radNewSolution(s.scene, s.oracle, NULL);
    check_refused(&s, &(struct RadGatherPoint){0, {0, 0, 0}, 0, 0, 1}, "radSolve");
    close_scene(&s);
}
END_TEST

/* ---- pictures */

static void read_image(const char *path, int width, int height, uint8_t *rgb)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    ck_assert_msg(png_image_begin_read_from_file(&image, path), "%s", image.message);
    image.format = PNG_FORMAT_RGB;
    ck_assert_int_eq((int)image.width, width);
    ck_assert_int_eq((int)image.height, height);
    ck_assert(png_image_finish_read(&image, NULL, rgb, 0, NULL));
}

/* A picture of a lit room, gathered by 128 rays a pixel into a, by others, at corners, into b. */
START_TEST(pixels_and_corners)
{
    enum { W = 40, H = 30 };
    static uint8_t a[H][W][3], b[H][W][3];
    struct solved_scene s;
    struct vertex_values values;
    solve_file(&s, "examples/scenes/cornell.obj", "ff", NULL);
    const struct solution solution = solution_of(&s.loaded.surfaces, s.solution, 2);
    const char *path = in_folder("gather.png");
    for (int corners = 0; corners < 2; corners++) {
        struct gathering g = {path, s.device, s.solution, NULL, corners ? 0 : 128, 0};
        ck_assert_int_eq(vertex_values_build(&values, &solution), 0);
        ck_assert_int_eq(image_write(path, &solution, &values, NULL, W, H, 0, &g), 0);
        vertex_values_free(&values);
        read_image(path, W, H, corners ? b[0][0] : a[0][0]);
    }
    double off = 0;
    for (int i = 0; i < 3 * W * H; i++)
        off += pow((&a[0][0][0])[i] - (&b[0][0][0])[i], 2) / (3 * W * H);
    ck_assert_double_lt(sqrt(off), 6); /* steps of 255; other exposures make 20 and more */
    ck_assert_double_gt(off, 0);
    close_scene(&s);
}
END_TEST

/* The wall of room at x = 4, whose top edge is the ceiling's, and its box (m). */
static uint32_t right_wall(const struct solved_scene *s, const struct solution *solution,
                           double low[3], double high[3])
{
    uint32_t wall = UINT32_MAX;
    double best = 0;
    for (uint32_t f = 0; f < s->loaded.report.faces; f++) {
        const struct element *e = element_of_face(solution, f);
        if (e->centre[0] > 3.99 && e->normal[0] < -.99 && e->area > best) {
            best = e->area;
            wall = f;
        }
    }
    ck_assert_uint_ne(wall, UINT32_MAX);
    const struct RadFace *face = &s->loaded.surfaces.faces[wall];
    for (int k = 0; k < 3; k++) {
        low[k] = INFINITY;
        high[k] = 0;
        for (uint32_t j = 0; j < face->vertices; j++) {
            low[k] = fmin(low[k], face->vertex[j][k]);
            high[k] = fmax(high[k], face->vertex[j][k]);
        }
    }
    return wall;
}

/* Along the edge between wall and ceiling, where leaves of unlike size alternate, the picture goes
 * up and down no more than the light does. */
START_TEST(edges_are_no_saws)
{
    enum { ALONG = 400 };
    struct solved_scene s;
    struct vertex_values values;
    solve_file(&s, "examples/scenes/room.obj", "clusters", NULL);
    const struct solution solution = solution_of(&s.loaded.surfaces, s.solution, 2);
    ck_assert_int_eq(vertex_values_build(&values, &solution), 0);
    uint8_t *seen = malloc(solution.tree.count);
    memset(seen, 1, solution.tree.count);
    double ways[2], range[2];
    for (int gathered = 0; gathered < 2; gathered++) {
        struct gathering g = {"", s.device, s.solution, NULL, 0, 0};
        if (gathered)
            ck_assert_int_eq(gathering_corners(&g, &values, &solution, seen, 1), 0);
        double low[3], high[3], last = 0;
        uint32_t wall = right_wall(&s, &solution, low, high);
        double least = INFINITY, most = 0;
        ways[gathered] = 0;
        for (int i = 0; i < ALONG; i++) {
            double p[3] = {high[0], low[1] + (i + .5) / ALONG * (high[1] - low[1]), high[2] - 1e-3};
            double B[3];
            vertex_values_at(&values, &solution, wall, p, B);
            ways[gathered] += i > 0 ? fabs(B[1] - last) : 0;
            last = B[1];
            least = fmin(least, last);
            most = fmax(most, last);
        }
        range[gathered] = most - least;
    }
    printf("up and down along an edge, in ranges: means %.2f, gathered %.2f\n", ways[0] / range[0],
           ways[1] / range[1]);
    /* the light rises to the middle of the wall and falls: twice the range, and little more */
    ck_assert_double_lt(ways[1], 2.5 * range[1]);
    free(seen);
    vertex_values_free(&values);
    close_scene(&s);
}
END_TEST

/* Particles that mend a wall leave patches on it. Corners are then believed: what is shown is
 * nearer to what each point gathers by many rays than means of leaves are, and near it. */
START_TEST(nothing_blotches)
{
    enum { SIDE = 24, TRUTH = 1024 };
    static struct RadGatherPoint point[SIDE * SIDE];
    static double truth[SIDE * SIDE][3];
    struct solved_scene s;
    struct vertex_values values;
    double low[3], high[3], off[2] = {0, 0}, whole = 0;
    solve_file(&s, "examples/scenes/room.obj", "bf_guarded",
               &(struct RadSolveOptions){.basis = RAD_BASIS_LINEAR});
    ck_assert_int_eq(radCorrect(s.solution, NULL, NULL), 0);
    const struct solution solution = solution_of(&s.loaded.surfaces, s.solution, 2);
    uint32_t wall = right_wall(&s, &solution, low, high);
    for (int i = 0; i < SIDE * SIDE; i++)
        point[i] = (struct RadGatherPoint){
            .face = wall,
            .position = {high[0], low[1] + (i % SIDE + .5) / SIDE * (high[1] - low[1]),
                         low[2] + (i / SIDE + .5) / SIDE * (high[2] - low[2])},
            .set = (uint64_t)(i + 1) << 32,
            .rays = TRUTH};
    ck_assert_int_eq(radGather(s.solution, point, SIDE * SIDE, truth[0]), 0);
    ck_assert_int_eq(vertex_values_build(&values, &solution), 0);
    uint8_t *seen = malloc(solution.tree.count);
    memset(seen, 1, solution.tree.count);
    for (int gathered = 0; gathered < 2; gathered++) {
        struct gathering g = {"", s.device, s.solution, NULL, 0, 0};
        if (gathered)
            ck_assert_int_eq(gathering_corners(&g, &values, &solution, seen, 1024 * 768), 0);
        for (int i = 0; i < SIDE * SIDE; i++) {
            double B[3];
            vertex_values_at(&values, &solution, wall, point[i].position, B);
            off[gathered] += pow(B[1] - truth[i][1], 2);
            whole += gathered ? pow(truth[i][1], 2) : 0;
        }
    }
    printf("a mended wall is off by %.2f %% in the root mean square, gathered %.2f %%\n",
           100 * sqrt(off[0] / whole), 100 * sqrt(off[1] / whole));
    ck_assert_double_lt(off[1], off[0] * 2 / 3);
    free(seen);
    vertex_values_free(&values);
    close_scene(&s);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("gather");
    TCase *points = tcase_create("points");
    tcase_set_timeout(points, 60);
    tcase_add_test(points, furnace_is_exact);
    tcase_add_test(points, penumbra);
    tcase_add_test(points, plates);
    tcase_add_test(points, means_of_faces);
    tcase_add_test(points, bright_spots);
    tcase_add_test(points, same_on_all_threads);
    tcase_add_test(points, what_is_refused);
    suite_add_tcase(suite, points);
    TCase *pictures = tcase_create("pictures");
    tcase_set_timeout(pictures, 60);
    tcase_add_test(pictures, pixels_and_corners);
    tcase_add_test(pictures, edges_are_no_saws);
    tcase_add_test(pictures, nothing_blotches);
    suite_add_tcase(suite, pictures);
    if (folder_make("gather") < 0)
        return EXIT_FAILURE;
    int failed = suite_failures(suite);
    folder_remove();
    return failed != 0;
}
