/* check_overlaps.c - faces that lie on others in a plane: each place keeps one, the right one.
 *
 * What must be there is asked point by point, of the polygons as they were given.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "radiosity.h"
#include "suite.h"

enum { DARK, LAMP, DARK_2S, LAMP_2S, MATERIALS, MOST = 256 };

static const struct RadMaterial materials[MATERIALS] = {
    [DARK] = {{.5, .5, .5}, {0, 0, 0}, 0},
    [LAMP] = {{.5, .5, .5}, {1, 1, 1}, 0},
    [DARK_2S] = {{.5, .5, .5}, {0, 0, 0}, 1},
    [LAMP_2S] = {{.5, .5, .5}, {1, 1, 1}, 1},
};

/* Polygons in a plane, and where that is in space: a place (x, y) is at origin + x u + y v. */
struct plane {
    double origin[3], u[3], v[3];
    double place[4 * MOST][2];
    uint32_t size[MOST], material[MOST], count, corners;
    RadDevice device;
    RadScene scene;
    struct RadSceneReport report;
};

/* Turned about all axes, so many metres to a unit. */
static void open_plane(struct plane *p, double scale, double far)
{
    *p = (struct plane){.origin = {far, -far, far / 3},
                        .u = {.6 * scale, .48 * scale, .64 * scale},
                        .v = {-.8 * scale, .36 * scale, .48 * scale}};
}

static void add_polygon(struct plane *p, uint32_t material, uint32_t n, double (*place)[2])
{
    p->size[p->count] = n;
    p->material[p->count++] = material;
    memcpy(p->place[p->corners], place, n * sizeof *place);
    p->corners += n;
}

static void add_rectangle(struct plane *p, uint32_t material, double x, double y, double w,
                          double h, int turned)
{
    double place[4][2] = {{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}};
    if (turned) {
        place[1][0] = x;
        place[1][1] = y + h;
        place[3][0] = x + w;
        place[3][1] = y;
    }
    add_polygon(p, material, 4, place);
}

static void commit(struct plane *p, int as_given)
{
    static double position[12 * MOST];
    static uint32_t index[4 * MOST];
    for (uint32_t i = 0; i < p->corners; i++) {
        index[i] = i;
        for (int k = 0; k < 3; k++)
            position[3 * i + (uint32_t)k] =
                p->origin[k] + p->place[i][0] * p->u[k] + p->place[i][1] * p->v[k];
    }
    const struct RadPolygons polygons = {.positions = position,
                                         .position_count = p->corners,
                                         .indices = index,
                                         .sizes = p->size,
                                         .materials = p->material,
                                         .count = p->count,
                                         .as_given = as_given};
    p->device = radNewDevice(NULL);
    p->scene = radNewScene(p->device);
    ck_assert_int_eq(radSetSceneMaterials(p->scene, materials, MATERIALS), 0);
    ck_assert_int_eq(radSetSceneSharedPolygons(p->scene, &polygons), 0);
    ck_assert_msg(radCommitScene(p->scene) == 0, "%s", radGetDeviceErrorMessage(p->device));
    ck_assert_int_eq(radGetSceneReport(p->scene, &p->report), 0);
}

static void close_plane(struct plane *p)
{
    radReleaseScene(p->scene);
    radReleaseDevice(p->device);
}

/* Twice the area of a, b, c. */
static double side(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* The side of a convex polygon that looks up where x is inside: 1 its front, -1 its back; 0: x is
 * outside, and *edge 1 when it is so near to an edge that rounding decides. */
static int looks_up(double (*place)[2], uint32_t n, const double x[2], int *edge)
{
    int left = 0, right = 0;
    for (uint32_t i = 0; i < n; i++) {
        const double *a = place[i], *b = place[(i + 1) % n];
        double s = side(a, b, x);
        if (fabs(s) <= 1e-4 * hypot(b[0] - a[0], b[1] - a[1]))
            *edge = 1;
        left += s > 0;
        right += s < 0;
    }
    return right == 0 ? 1 : left == 0 ? -1 : 0;
}

static int emits(uint32_t material)
{
    return material == LAMP || material == LAMP_2S;
}

/* The polygon that has the upper side (up 1) or the lower one (-1) at x; UINT32_MAX: none. */
static uint32_t owner(struct plane *p, const double x[2], int up, int *edge)
{
    uint32_t best = UINT32_MAX, at = 0;
    for (uint32_t i = 0; i < p->count; at += p->size[i++]) {
        int way = looks_up(&p->place[at], p->size[i], x, edge);
        if (way && (way == up || materials[p->material[i]].two_sided)
            && (best == UINT32_MAX || (emits(p->material[i]) && !emits(p->material[best]))))
            best = i;
    }
    return best;
}

/* The same of the faces; it must be one. */
static uint32_t face_at(struct plane *p, const double x[2], int up, double (*faces)[4][2])
{
    const struct RadFace *f = radGetSceneFaces(p->scene);
    uint32_t found = UINT32_MAX;
    int edge = 0;
    for (uint32_t i = 0; i < p->report.faces; i++)
        if (looks_up(faces[i], f[i].vertices, x, &edge) == up && !edge) {
            ck_assert_msg(found == UINT32_MAX, "polygons %u and %u at %g %g", found, f[i].input,
                          x[0], x[1]);
            found = f[i].input;
        } else if (edge) {
            return UINT32_MAX - 1; /* between two parts */
        }
    return found;
}

/* The faces' corners in the plane; areas of polygons must be theirs. */
static double (*faces_in_plane(struct plane *p))[4][2]
{
    const struct RadFace *f = radGetSceneFaces(p->scene);
    const double *areas = radGetScenePolygonAreas(p->scene);
    double(*faces)[4][2] = calloc(p->report.faces + 1, sizeof *faces), *area = calloc(MOST, 8);
    double uu = p->u[0] * p->u[0] + p->u[1] * p->u[1] + p->u[2] * p->u[2];
    for (uint32_t i = 0; i < p->report.faces; i++) {
        double twice = 0;
        for (uint32_t j = 0; j < f[i].vertices; j++)
            for (int k = 0; k < 3; k++) {
                double d = (f[i].vertex[j][k] - p->origin[k]) / uu;
                faces[i][j][0] += d * p->u[k];
                faces[i][j][1] += d * p->v[k];
            }
        for (uint32_t j = 2; j < f[i].vertices; j++)
            twice += side(faces[i][0], faces[i][j - 1], faces[i][j]);
        area[f[i].input] += fabs(twice / 2) * uu / (materials[f[i].material].two_sided ? 2 : 1);
        ck_assert_uint_eq(f[i].material, p->material[f[i].input]);
        ck_assert(!f[i].back || (i && !f[i - 1].back && f[i - 1].input == f[i].input));
        ck_assert(!i || f[i].input >= f[i - 1].input);
    }
    for (uint32_t i = 0; i < p->count; i++)
        ck_assert_double_eq_tol(area[i] / uu, areas[i] / uu, 1e-7);
    free(area);
    return faces;
}

static void check_places(struct plane *p, int points)
{
    double(*faces)[4][2] = faces_in_plane(p);
    int asked = 0;
    for (int i = 0; i < points; i++) {
        double x[2] = {1.2 * rand() / RAND_MAX - .1, 1.2 * rand() / RAND_MAX - .1};
        for (int up = -1; up <= 1; up += 2) {
            int edge = 0;
            uint32_t right = owner(p, x, up, &edge), is = face_at(p, x, up, faces);
            if (edge || is == UINT32_MAX - 1)
                continue;
            asked++;
            ck_assert_msg(is == right, "polygon %d for %d at %g %g, side %d", (int)is, (int)right,
                          x[0], x[1], up);
        }
    }
    ck_assert_int_gt(asked, points / 2);
    free(faces);
}

static void add_at_random(struct plane *p)
{
    uint32_t material = (uint32_t)rand() % MATERIALS;
    double x = 1. * rand() / RAND_MAX, y = 1. * rand() / RAND_MAX, place[3][2];
    if (rand() % 2) {
        add_rectangle(p, material, x * .7, y * .7, .02 + .28 * rand() / RAND_MAX,
                      .02 + .28 * rand() / RAND_MAX, rand() % 2);
        return;
    }
    do
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 2; k++)
                place[i][k] = 1. * rand() / RAND_MAX;
    while (fabs(side(place[0], place[1], place[2])) < .02);
    add_polygon(p, material, 3, place);
}

/* At random: shapes, sides, materials, at several sizes and far away. */
START_TEST(test_random)
{
    static const double scales[] = {1, 1e-6, 1e6, 3, 10}, far[] = {0, 0, 0, 1e5, 1e-3};
    srand(7 + (unsigned)_i);
    for (int turn = 0; turn < 8; turn++) {
        struct plane p;
        open_plane(&p, scales[_i], far[_i]);
        uint32_t n = 2u << turn % 5;
        for (uint32_t i = 0; i < n; i++)
            add_at_random(&p);
        commit(&p, 0);
        check_places(&p, 1500);
        close_plane(&p);
    }
}
END_TEST

/* A lamp on a ceiling keeps its light, wherever it stands in the file; a rug loses its place. */
START_TEST(test_lamp)
{
    for (int first = 0; first < 2; first++) {
        struct plane p;
        open_plane(&p, 4, 0);
        if (first)
            add_rectangle(&p, LAMP, .4, .4, .1, .2, 0);
        add_rectangle(&p, DARK, 0, 0, 1, 1, 0);
        if (!first)
            add_rectangle(&p, LAMP, .4, .4, .1, .2, 0);
        add_rectangle(&p, DARK, .1, .1, .1, .1, 0);
        commit(&p, 0);
        const double *areas = radGetScenePolygonAreas(p.scene);
        ck_assert_double_eq_tol(areas[!first], .02 * 16, 1e-9);
        ck_assert_double_eq_tol(areas[first], .98 * 16, 1e-9);
        ck_assert_double_eq(areas[2], 0);
        ck_assert_uint_eq(p.report.overlaps, 2);
        ck_assert_double_eq_tol(p.report.overlap_area, .03 * 16, 1e-9);
        ck_assert_uint_eq(p.report.overlap[0].polygon, (uint32_t)first);
        ck_assert_uint_eq(p.report.overlap[0].on, (uint32_t)!first);
        ck_assert_uint_eq(p.report.overlap[1].polygon, 2);
        ck_assert_uint_eq(p.report.dropped, 0);
        check_places(&p, 500);
        close_plane(&p);
    }
}
END_TEST

/* What a polygon is said to lie on has stayed there, whichever of those on it were found first. */
START_TEST(test_named)
{
    srand(11);
    for (int turn = 0; turn < 30; turn++) {
        struct plane p;
        open_plane(&p, 4, 0);
        add_rectangle(&p, DARK, .45, .45, .1, .1, 0);
        for (double room = .4; room > .05; room *= .8) {
            double low[2], high[2];
            for (int k = 0; k < 2; k++) {
                low[k] = .45 - room * (.8 + .2 * rand() / RAND_MAX);
                high[k] = .55 + room * (.8 + .2 * rand() / RAND_MAX);
            }
            add_rectangle(&p, LAMP, low[0], low[1], high[0] - low[0], high[1] - low[1], 0);
        }
        commit(&p, 0);
        ck_assert_uint_eq(p.report.overlaps, p.count - 1);
        for (int i = 0; i < RAD_OVERLAPS_NAMED; i++)
            ck_assert_uint_eq(p.report.overlap[i].on, 1);
        close_plane(&p);
    }
}
END_TEST

/* Of a two-sided sheet the side goes that is covered. */
START_TEST(test_two_sided)
{
    struct plane p;
    open_plane(&p, 1, 0);
    add_rectangle(&p, DARK, .5, 0, .5, .5, 0);
    add_rectangle(&p, DARK, .5, .5, .5, .5, 1);
    add_rectangle(&p, DARK_2S, 0, 0, 1, 1, 0);
    commit(&p, 0);
    ck_assert_double_eq_tol(radGetScenePolygonAreas(p.scene)[2], .75, 1e-9);
    ck_assert_double_eq_tol(p.report.area, 2, 1e-9);
    check_places(&p, 500);
    close_plane(&p);
}
END_TEST

static uint32_t overlaps_of(struct plane *p)
{
    commit(p, 0);
    uint32_t n = p->report.overlaps, polygons = p->count, faces = p->report.faces;
    close_plane(p);
    ck_assert(n || faces == polygons);
    return n;
}

/* What is not an overlap: a wall of two faces, neighbours, tiles whose corners were rounded. */
START_TEST(test_neighbours)
{
    struct plane p;
    open_plane(&p, 1, 0);
    add_rectangle(&p, DARK, 0, 0, 1, 1, 0);
    add_rectangle(&p, DARK, 0, 0, 1, 1, 1);
    add_rectangle(&p, DARK, 1, 0, 1, .5, 0);
    add_rectangle(&p, DARK, 1, .5, 1, 1, 1);
    add_rectangle(&p, DARK, 0, 1, .3, 1, 0);
    add_rectangle(&p, DARK, .3, 1, .7, 1, 0);
    ck_assert_uint_eq(overlaps_of(&p), 0);
    for (double far = 0; far < 2e6; far += 1e6) {
        open_plane(&p, 1, far);
        for (int i = 0; i < 100; i++) { /* rows shifted, corners written with six decimals */
            add_rectangle(&p, DARK, .1 * (i % 10) + .037 * (i / 10), .1 * (i / 10), .1, .1, 0);
            for (uint32_t j = p.corners - 4; j < p.corners; j++)
                for (int k = 0; k < 2; k++)
                    p.place[j][k] += 1e-6 * (1. * rand() / RAND_MAX - .5);
        }
        ck_assert_uint_eq(overlaps_of(&p), 0);
    }
}
END_TEST

/* Sheets over one another count from where rays tell them apart, 2^-18 of the scene: below it both
 * would be lit. */
START_TEST(test_near)
{
    for (int apart = 0; apart < 2; apart++) {
        const double z = 4 * 0x1p-18 * (apart ? 1.1 : .9);
        const double position[] = {0, 0, 0, 4, 0, 0, 4, 4, 0, 0, 4, 0,
                                   1, 1, z, 2, 1, z, 2, 2, z, 1, 2, z};
        const uint32_t index[] = {0, 1, 2, 3, 4, 5, 6, 7};
        const struct RadPolygons polygons = {
            .positions = position, .position_count = 8, .indices = index, .size = 4, .count = 2};
        RadDevice device = radNewDevice(NULL);
        RadScene scene = radNewScene(device);
        struct RadSceneReport report;
        radSetSceneMaterials(scene, materials, 1);
        radSetSceneSharedPolygons(scene, &polygons);
        ck_assert_int_eq(radCommitScene(scene), 0);
        ck_assert_int_eq(radGetSceneReport(scene, &report), 0);
        ck_assert_uint_eq(report.overlaps, !apart);
        radReleaseScene(scene);
        radReleaseDevice(device);
    }
}
END_TEST

/* A floor of n x n tiles, and once more as tiles, or as one face that comes last. */
START_TEST(test_many)
{
    const uint32_t n = thorough() ? 316 : 100, tiles = n * n, count = 2 * tiles + 1;
    double *position = malloc((n + 1) * (n + 1) * 3 * sizeof *position);
    uint32_t *index = malloc(4 * count * sizeof *index);
    for (uint32_t i = 0; i <= n; i++)
        for (uint32_t j = 0; j <= n; j++) {
            double *p = &position[3 * (i * (n + 1) + j)];
            p[0] = .1 * j;
            p[1] = .1 * i;
            p[2] = .3;
        }
    for (uint32_t i = 0; i < 2 * tiles; i++) {
        uint32_t at = i % tiles / n * (n + 1) + i % n,
                 corner[4] = {at, at + 1, at + n + 2, at + n + 1};
        for (uint32_t k = 0; k < 4; k++)
            index[4 * i + k] = corner[(k + i / tiles) % 4];
    }
    const uint32_t whole[4] = {0, n, (n + 1) * (n + 1) - 1, n * (n + 1)};
    memcpy(&index[8 * tiles], whole, sizeof whole);
    const struct RadPolygons polygons = {.positions = position,
                                         .position_count = (n + 1) * (n + 1),
                                         .indices = index,
                                         .size = 4,
                                         .count = count};
    RadDevice device = radNewDevice(NULL);
    RadScene scene = radNewScene(device);
    struct RadSceneReport report;
    radSetSceneMaterials(scene, materials, 1);
    radSetSceneSharedPolygons(scene, &polygons);
    clock_t start = clock();
    ck_assert_int_eq(radCommitScene(scene), 0);
    printf("%u tiles twice and a floor: %.2f s\n", tiles,
           (double)(clock() - start) / CLOCKS_PER_SEC);
    ck_assert_int_eq(radGetSceneReport(scene, &report), 0);
    ck_assert_uint_eq(report.overlaps, tiles + 1);
    ck_assert_uint_eq(report.faces, tiles);
    ck_assert_double_eq_tol(report.area, .01 * tiles, 1e-9 * tiles);
    ck_assert_double_eq_tol(report.overlap_area, .02 * tiles, 1e-9 * tiles);
    radReleaseScene(scene);
    radReleaseDevice(device);
    free(position);
    free(index);
}
END_TEST

/* Commit polygons of a device's. Returns the processor's time that it took (s). */
static double commit_timed(RadDevice device, const struct RadPolygons *polygons, RadScene *scene)
{
    *scene = radNewScene(device);
    radSetSceneMaterials(*scene, materials, 1);
    radSetSceneSharedPolygons(*scene, polygons);
    const clock_t start = clock();
    ck_assert_int_eq(radCommitScene(*scene), 0);
    return (double)(clock() - start) / CLOCKS_PER_SEC;
}

/* A disc of one polygon, and as many triangles as are made of it: those of one polygon are not
 * held against each other. */
START_TEST(test_disc)
{
    enum { CORNERS = 3000, TRIANGLES = CORNERS - 2 };
    double *position = calloc(9 * TRIANGLES, sizeof *position), took[2];
    uint32_t *index = malloc(3 * TRIANGLES * sizeof *index);
    RadDevice device = radNewDevice(NULL);
    RadScene scene[2];
    struct RadSceneReport report;
    for (uint32_t i = 0; i < CORNERS; i++) {
        position[3 * i] = cos(2 * M_PI * i / CORNERS);
        position[3 * i + 1] = sin(2 * M_PI * i / CORNERS);
    }
    for (uint32_t i = 0; i < 3 * TRIANGLES; i++)
        index[i] = i;
    struct RadPolygons polygons = {.positions = position,
                                   .position_count = CORNERS,
                                   .indices = index,
                                   .size = CORNERS,
                                   .count = 1};
    took[0] = commit_timed(device, &polygons, &scene[0]);
    const struct RadFace *f = radGetSceneFaces(scene[0]);
    radGetSceneReport(scene[0], &report);
    ck_assert_uint_eq(report.faces, TRIANGLES);
    for (uint32_t i = 0; i < TRIANGLES; i++)
        memcpy(&position[9 * i], f[i].vertex, 9 * sizeof *position);
    polygons.position_count = 3 * TRIANGLES;
    polygons.size = 3;
    polygons.count = TRIANGLES;
    took[1] = commit_timed(device, &polygons, &scene[1]);
    printf("a disc of %d corners: %.2f s; its triangles: %.2f s\n", CORNERS, took[0], took[1]);
    ck_assert_double_lt(took[0], 0.6 * took[1]);
    for (int i = 0; i < 2; i++)
        radReleaseScene(scene[i]);
    radReleaseDevice(device);
    free(position);
    free(index);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("overlaps");
    TCase *c = tcase_create("overlaps");
    tcase_add_loop_test(c, test_random, 0, 5);
    tcase_add_test(c, test_lamp);
    tcase_add_test(c, test_named);
    tcase_add_test(c, test_two_sided);
    tcase_add_test(c, test_neighbours);
    tcase_add_test(c, test_near);
    tcase_add_test(c, test_many);
    tcase_add_test(c, test_disc);
    tcase_set_timeout(c, 60);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
