/* check_scene.c - the scene reader, the helpers below it, and the writers of tables and files.
 *
 * Facts come from outside: the scenes' README, geometry done by hand, a second and dumb parse of
 * the OBJ text. Files are written to a folder of their own, which is removed at the end.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "captured.h"
#include "util/atomic_file.h"
#include "output/faces_csv.h"
#include "hierarchy/polygon.h"
#include "load_scene.h"
#include "scene/read_obj.h"
#include "scene/read_scene.h"
#include "folder.h"
#include "suite.h"

static const char SCENES[] = "examples/scenes/";
static const char MTL[] =
    "newmtl a\nKd 0.5 0.5 0.5\nnewmtl b_2s\nKd 0.25 0.5 0.75\nKe 3 2 1\nnewmtl black\nKd 0 0 0\n";
static const char SQUARE[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

static char last_error[2048];

static const char *write_text(const char *name, const char *text)
{
    folder_write(name, text);
    return in_folder(name);
}

static char *read_text(const char *path)
{
    FILE *f = fopen(path, "r");
    ck_assert_ptr_nonnull(f);
    char *text = calloc(1, 1 << 20);
    ck_assert_uint_gt(fread(text, 1, (1 << 20) - 1, f), 0);
    fclose(f);
    return text;
}

/* Read a scene with stderr kept in last_error. */
static int read_scene(struct scene *s, const char *path, const struct scene_options *options)
{
    struct captured err = capture_start(STDERR_FILENO);
    int result = scene_read(s, path, options);
    capture_end(&err, last_error, sizeof last_error);
    return result;
}

static int read_body(struct scene *s, const char *body)
{
    write_text("m.mtl", MTL);
    char text[8192];
    snprintf(text, sizeof text, "mtllib m.mtl\n%s", body);
    return read_scene(s, write_text("s.obj", text), NULL);
}

static void expect_error(const char *body, const char *what)
{
    struct scene s;
    ck_assert_int_eq(read_body(&s, body), -1);
    ck_assert_msg(strstr(last_error, what) != NULL, "'%s' is not in '%s'", what, last_error);
    ck_assert_msg(strstr(last_error, ": error: ") != NULL, "%s", last_error);
    ck_assert_msg(strchr(last_error, '\n') == last_error + strlen(last_error) - 1, "one line: %s",
                  last_error);
    ck_assert_uint_eq(s.face_count, 0);
    ck_assert_ptr_null(s.faces);
}

static double total_area(const struct scene *s)
{
    double area = 0;
    for (uint32_t i = 0; i < s->input_count; i++)
        area += s->areas[i];
    return area;
}

static double face_area(const struct face *f)
{
    double v[4][3], normal[3];
    memcpy(v, f->vertex, sizeof v);
    return polygon_normal(v, f->vertices, normal);
}

/* ---- scenes that ship, against their README ---- */

static const struct fact {
    const char *name;
    unsigned polygons, triangles, bands;
    double area, watts[3];
    unsigned overlaps; /* the feet of td's chair cross */
} facts[] = {
    {"cornell", 21, 2, 3, 2.225, {0.732, 0.4905, 0.1261}, 0},
    {"room", 185, 0, 3, 99.12, {93.6, 98.8, 109.2}, 0},
    {"td", 1640, 100, 3, 123.8, {60.01, 56.58, 48.7}, 8},
    {"maze_8", 146, 0, 3, 603.9, {180, 174, 156}, 0},
    {"maze_16", 519, 0, 3, 2457, {750, 725, 650}, 0},
    {"sejour", 10421, 1144, 3, 241.1, {130.1, 136.8, 147.3}, 0},
    {"furnace", 6, 0, 1, 6, {6, 6, 6}, 0},
    {"furnace_4", 96, 0, 1, 6, {6, 6, 6}, 0},
};

START_TEST(test_shipped)
{
    const struct fact *f = &facts[_i];
    char path[128];
    snprintf(path, sizeof path, "%s%s.obj", SCENES, f->name);
    struct scene s;
    ck_assert_int_eq(read_scene(&s, path, NULL), 0);
    ck_assert(!f->overlaps == !*last_error);
    ck_assert_uint_eq(s.overlaps, f->overlaps);
    ck_assert_uint_eq(s.input_count, f->polygons);
    if (!f->overlaps)
        ck_assert_uint_eq(s.face_count, f->polygons + s.parts - s.cut);
    ck_assert_uint_eq(s.dropped, 0);
    ck_assert_uint_eq(s.bands, f->bands);
    unsigned triangles = 0;
    double area = 0, parts = 0;
    double watts[3] = {0, 0, 0};
    for (uint32_t i = 0; i < s.face_count; i++) {
        const struct RadMaterial *m = &s.materials[s.faces[i].material];
        int first = i == 0 || s.faces[i].input != s.faces[i - 1].input;
        int last = i + 1 == s.face_count || s.faces[i].input != s.faces[i + 1].input;
        triangles += first && last && s.faces[i].vertices == 3;
        for (int k = 0; k < 3; k++)
            watts[k] += face_area(&s.faces[i]) * m->exitance[k];
        /* Parts of one polygon are neighbours, and make it up. */
        ck_assert_uint_eq(s.faces[i].input, i == 0 ? 0 : s.faces[i - 1].input + (uint32_t)first);
        ck_assert_uint_eq(s.faces[i].back, 0);
        area = face_area(&s.faces[i]) + (first ? 0 : area);
        parts = first ? 1 : parts + 1; /* each rounds its area, and the sum, by a last bit or two */
        if (last)
            ck_assert_double_eq_tol(area, s.areas[s.faces[i].input], 1e-12 + 4e-16 * parts * area);
    }
    ck_assert_uint_le(triangles, f->triangles);
    ck_assert_uint_ge(triangles + s.cut, f->triangles);
    ck_assert_double_eq_tol(total_area(&s), f->area, 6e-4 * f->area);
    for (int k = 0; k < 3; k++)
        ck_assert_double_eq_tol(watts[k], f->watts[k], 6e-4 * f->watts[k]);
    scene_free(&s);
}
END_TEST

/* Faces in the order of the file's f lines, by a parse that knows nothing but v and f. */
static void compare_order(const char *path)
{
    static double v[40000][3];
    struct scene s;
    unsigned vertices = 0, faces = 0;
    uint32_t next = 0;
    ck_assert_int_eq(read_scene(&s, path, NULL), 0);
    FILE *f = fopen(path, "r");
    char line[512];
    while (fgets(line, sizeof line, f)) {
        if (line[0] == 'v' && line[1] == ' ') {
            ck_assert_int_eq(
                sscanf(line + 2, "%lf %lf %lf", &v[vertices][0], &v[vertices][1], &v[vertices][2]),
                3);
            vertices++;
        } else if (line[0] == 'f') {
            /* Every corner of the file's polygon is one of its face's, or of its parts' when it
             * was cut. */
            uint32_t first = next;
            int corners = 0;
            char *rest = NULL;
            ck_assert_uint_lt(next, s.face_count);
            while (next < s.face_count && s.faces[next].input == faces)
                next++;
            ck_assert_uint_gt(next, first);
            for (char *word = strtok_r(line + 2, " \n", &rest); word;
                 word = strtok_r(NULL, " \n", &rest), corners++) {
                const double *p = v[atoi(word) - 1];
                int found = 0;
                for (uint32_t i = first; i < next; i++)
                    for (uint32_t j = 0; j < s.faces[i].vertices; j++) {
                        const double *q = s.faces[i].vertex[j];
                        found |= fabs(p[0] - q[0]) < 2e-6 && fabs(p[1] - q[1]) < 2e-6
                                 && fabs(p[2] - q[2]) < 2e-6;
                    }
                ck_assert(found);
            }
            if (next == first + 1)
                ck_assert_int_eq((int)s.faces[first].vertices, corners);
            faces++;
        }
    }
    fclose(f);
    ck_assert_uint_eq(faces, s.input_count);
    scene_free(&s);
}

START_TEST(test_order)
{
    compare_order("examples/scenes/room.obj");
    compare_order("examples/scenes/sejour.obj");
    /* Groups and objects that come back, and runs of one material: Assimp would gather them. */
    write_text("m.mtl", MTL);
    char text[1024];
    snprintf(
        text, sizeof text,
        "mtllib m.mtl\no one\n%sv 0 0 1\nv 0 0 2\ng x\nusemtl a\nf 1 2 3\nusemtl black\nf 1 3 4\n"
        "o two\nusemtl a\nf 1 2 5\ng y\nf 2 1 6\no one\nusemtl black\nf 2 3 5\ng x\nusemtl a\nf 3 "
        "4 5\no two\nusemtl black\nf 3 4 6\n",
        SQUARE);
    compare_order(write_text("order.obj", text));
}
END_TEST

/* ---- shapes ---- */

START_TEST(test_two_sided)
{
    char body[512];
    snprintf(body, sizeof body, "%susemtl b_2s\nf 1 2 3 4\nv 0 1 1\nusemtl a\nf 1 2 5\n", SQUARE);
    struct scene s;
    ck_assert_int_eq(read_body(&s, body), 0);
    ck_assert_uint_eq(s.face_count, 3);
    ck_assert_uint_eq(s.input_count, 2);
    ck_assert_uint_eq(s.faces[0].back, 0);
    ck_assert_uint_eq(s.faces[1].back, 1);
    ck_assert_uint_eq(s.faces[1].input, 0);
    ck_assert_uint_eq(s.faces[2].input, 1);
    for (int i = 0; i < 4; i++)
        ck_assert_mem_eq(s.faces[0].vertex[i], s.faces[1].vertex[3 - i],
                         sizeof s.faces[0].vertex[0]);
    ck_assert_double_eq_tol(s.areas[0], 1, 1e-12); /* one side */
    const struct RadMaterial *m = &s.materials[s.faces[0].material];
    struct scene_file file;
    ck_assert_int_eq(scene_file_read(&file, in_folder("s.obj"), NULL), 0);
    ck_assert_str_eq(file.names[s.faces[0].material], "b_2s");
    scene_file_free(&file);
    ck_assert_int_eq(m->two_sided, 1);
    for (int k = 0; k < 3; k++) {
        ck_assert_double_eq(m->reflectance[k], 0.25 * (k + 1));
        ck_assert_double_eq(m->exitance[k], 3 - k);
    }
    ck_assert_uint_eq(s.bands, 3);
    scene_free(&s);
    const struct scene_options all = {.two_sided = 1};
    ck_assert_int_eq(read_scene(&s, in_folder("s.obj"), &all), 0);
    ck_assert_uint_eq(s.face_count, 4);
    scene_free(&s);
}
END_TEST

START_TEST(test_polygons)
{
    static const struct {
        const char *body;
        unsigned faces;
        double area;
    } cases[] = {
        {"v 0 0 0\nv 1 0 0\nv 1 1 0.001\nv 0 1 0\nf 1 2 3 4\n", 2, 1},  /* not flat */
        {"v 0 0 0\nv 1 0 0\nv 1 1 0.0001\nv 0 1 0\nf 1 2 3 4\n", 2, 1}, /* not so for rays */
        {"v 0 0 0\nv 1 0 0\nv 1 1 1e-6\nv 0 1 0\nf 1 2 3 4\n", 1, 1},   /* flat enough */
        {"v 0 0 0\nv 2 0 0\nv 0.5 0.5 0\nv 0 2 0\nf 1 2 3 4\n", 2,
         1}, /* an arrow head, notch at (.5, .5) */
        {"v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5 6\n", 4, 3}, /* an L */
        {"v 0 0 0\nv 3 0 0\nv 3 3 0\nv 2 3 0\nv 2 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\nf 1 2 3 4 5 6 7 "
         "8\n",
         6, 7}, /* a U */
        {"v 1 0 0\nv 0.5 0.8660254 0\nv -0.5 0.8660254 0\nv -1 0 0\nv -0.5 -0.8660254 0\nv 0.5 "
         "-0.8660254 0\nf 1 2 3 4 5 6\n",
         /* a hexagon: 3 sqrt(3) / 2 */
         4, 2.598076},
        {"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 3\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nf -4 "
         "-3/1/1 -2//7 -1\n",
         2, 1.5}, /* repeated; relative; odd parts */
        {"v 0 0 0\nv 1 0 0\\\n\nv 1 1 0\r\nv 0 1 0\nf 1 2 \\\n 3 4\r\n", 1,
         1},                                                        /* continued lines, CR */
        {"v 0 0 0\n v .5 0 0\n\tv .5 +.5 0\n f 1 2 3\n", 1, 0.125}, /* bare points, indents */
    };
    struct scene s;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        ck_assert_int_eq(read_body(&s, cases[i].body), 0);
        ck_assert_msg(s.face_count == cases[i].faces, "case %zu: %u faces", i,
                      (unsigned)s.face_count);
        double area = 0;
        for (uint32_t j = 0; j < s.face_count; j++) {
            double v[4][3], normal[3];
            memcpy(v, s.faces[j].vertex, sizeof v);
            area += polygon_normal(v, s.faces[j].vertices, normal);
            ck_assert_msg(normal[2] > 0.99, "case %zu: face %u turned over", i, (unsigned)j);
        }
        ck_assert_double_eq_tol(area, cases[i].area, 2e-6);
        ck_assert_double_eq_tol(total_area(&s), cases[i].area, 2e-6);
        scene_free(&s);
    }
    /* Both halves of a quad that is not flat are one face of the file. */
    ck_assert_int_eq(read_body(&s, cases[0].body), 0);
    ck_assert_uint_eq(s.input_count, 1);
    ck_assert_uint_eq(s.faces[0].input + s.faces[1].input, 0);
    scene_free(&s);
}
END_TEST

/* A star with many points: ear clipping against the area by the shoelace formula. */
START_TEST(test_star)
{
    enum { N = 400 };
    static double v[N][3];
    static uint32_t triangle[N][3], scratch[N];
    double shoelace = 0, sum = 0;
    for (int i = 0; i < N; i++) {
        double angle = 2 * 3.14159265358979323846 * i / N, radius = i % 2 ? 0.3 : 1.0;
        v[i][0] = radius * cos(angle);
        v[i][1] = radius * sin(angle);
        v[i][2] = 5 + 0.5 * v[i][0]; /* in a tilted plane */
    }
    for (int i = 0; i < N; i++)
        shoelace += 0.5 * (v[i][0] * v[(i + 1) % N][1] - v[(i + 1) % N][0] * v[i][1]);
    uint32_t count = polygon_triangulate(v, N, triangle, scratch);
    ck_assert_uint_eq(count, N - 2);
    for (uint32_t i = 0; i < count; i++) {
        double t[3][3], normal[3];
        for (int k = 0; k < 3; k++)
            memcpy(t[k], v[triangle[i][k]], sizeof t[k]);
        sum += polygon_normal(t, 3, normal);
        ck_assert(normal[2] > 0);
    }
    ck_assert_double_eq_tol(sum, shoelace * sqrt(1.25), 1e-12);
}
END_TEST

/* The triangles of a polygon in the plane z = 0, turned into another: their sum against the
 * shoelace formula; none turned over. */
static void expect_triangles(double (*flat)[2], uint32_t n, double area, const char *what)
{
    static double v[400][3];
    static uint32_t triangle[400][3], scratch[400];
    for (int turned = 0; turned < 2; turned++) {
        for (uint32_t i = 0; i < n; i++) {
            v[i][0] = flat[i][0];
            v[i][1] = turned ? 0.8 * flat[i][1] : flat[i][1];
            v[i][2] = turned ? 0.6 * flat[i][1] : 0;
        }
        uint32_t count = polygon_triangulate(v, n, triangle, scratch);
        double sum = 0;
        for (uint32_t i = 0; i < count; i++) {
            double t[3][3], normal[3];
            for (int k = 0; k < 3; k++)
                memcpy(t[k], v[triangle[i][k]], sizeof t[k]);
            double part = polygon_normal(t, 3, normal);
            ck_assert_msg(normal[2] > 0 || part <= 1e-13 * area, "%s: triangle %u turned over",
                          what, (unsigned)i);
            sum += polygon_degenerate(t, 3, 0x1p-53) ? 0 : part;
        }
        ck_assert_uint_gt(count, 0);
        ck_assert_msg(fabs(sum - area) <= 1e-12 * area, "%s: %.15g, not %.15g", what, sum, area);
    }
}

START_TEST(test_concave)
{
    double hole[][2] = {{0, 0}, {4, 0},   {4, 2},  {2, 2}, {2, 4},  {0, 4},
                        {0, 0}, {.5, .5}, {.5, 1}, {1, 1}, {1, .5}, {.5, .5}};
    expect_triangles(hole, 12, 11.75, "an L with a hole");
    double two[][2] = {{0, 0}, {9, 0}, {9, 3}, {0, 3}, {0, 1}, {1, 1}, {1, 2}, {2, 2}, {2, 1},
                       {6, 1}, {6, 2}, {8, 2}, {8, 1}, {6, 1}, {2, 1}, {1, 1}, {0, 1}};
    expect_triangles(two, 17, 24, "two holes on one bridge");
    double straight[][2] = {{0, 0}, {1, 0}, {2, 0},   {3, 0}, {3, .1}, {3, .2},
                            {3, 3}, {2, 3}, {1.5, 3}, {0, 3}, {0, 2},  {0, .7}};
    expect_triangles(straight, 12, 9, "straight corners");
    double thirds[][2] = {{0, 0}, {.1, .1 / 3}, {.2, .2 / 3}, {.7, .7 / 3}, {1, 1. / 3}, {0, 1}};
    expect_triangles(thirds, 6, .5, "straight corners that are rounded");
    enum { TEETH = 40 };
    double comb[4 * TEETH + 2][2];
    uint32_t n = 0;
    for (int i = 0; i < TEETH; i++) {
        const double at[4][2] = {{2. * i, 0}, {2. * i + 1, 0}, {2. * i + 1, 5}, {2. * i + 2, 5}};
        memcpy(comb[n], at, sizeof at);
        n += 4;
    }
    const double back[2][2] = {{2. * TEETH, 6}, {0, 6}};
    memcpy(comb[n], back, sizeof back);
    expect_triangles(comb, n + 2, TEETH * 7, "a comb");
}
END_TEST

static double shoelace(double (*v)[2], uint32_t n)
{
    double sum = 0;
    for (uint32_t i = 0; i < n; i++)
        sum += 0.5 * (v[i][0] * v[(i + 1) % n][1] - v[(i + 1) % n][0] * v[i][1]);
    return sum;
}

/* Stars with a star cut out of them, joined by a bridge from corner to corner of the same angle. */
START_TEST(test_bridged)
{
    const double pi = 3.14159265358979323846;
    srand(16);
    for (int round = 0; round < 2000; round++) {
        double ring[130][2];
        uint32_t outer = 3 + (uint32_t)rand() % 40, inner = 3 + (uint32_t)rand() % 20, n = 0;
        double turn = rand() / (double)RAND_MAX, x = rand() % 100, y = rand() % 100;
        for (uint32_t i = 0; i <= outer; i++, n++) {
            double a = turn + 2 * pi * (i % outer) / outer;
            double radius = i == outer ? 0 : 2 + (rand() % 4) * (rand() / (double)RAND_MAX);
            ring[n][0] = x + radius * cos(a);
            ring[n][1] = y + radius * sin(a);
        }
        memcpy(ring[outer], ring[0], sizeof ring[0]);
        double area = shoelace(ring, outer);
        /* within the circle that the outer star's edges leave free: 2 cos(pi / 3) */
        for (uint32_t i = 0; i <= inner; i++, n++) {
            double a = turn - 2 * pi * (i % inner) / inner;
            double radius = i == inner ? 0 : .1 + .85 * (rand() / (double)RAND_MAX);
            ring[n][0] = x + radius * cos(a);
            ring[n][1] = y + radius * sin(a);
        }
        memcpy(ring[n - 1], ring[outer + 1], sizeof ring[0]);
        area += shoelace(&ring[outer + 1], inner);
        char what[80];
        snprintf(what, sizeof what, "round %d, %u and %u corners", round, (unsigned)outer,
                 (unsigned)inner);
        /* from any corner on */
        uint32_t from = (uint32_t)rand() % n;
        double turned[130][2];
        for (uint32_t i = 0; i < n; i++)
            memcpy(turned[i], ring[(from + i) % n], sizeof turned[i]);
        expect_triangles(turned, n, area, what);
    }
}
END_TEST

START_TEST(test_dropped)
{
    char body[512];
    snprintf(body, sizeof body,
             "%sv 0.5 0 0\nusemtl a\nf 1 2 5\nf 1 1 2\nf 1 2\nf 1\nf 1 2 3 4\nl 1 2\np 3\n",
             SQUARE);
    struct scene s;
    ck_assert_int_eq(read_body(&s, body), 0);
    ck_assert_uint_eq(s.dropped, 4);
    ck_assert_uint_eq(s.input_count, 5);
    ck_assert_uint_eq(s.face_count, 1);
    ck_assert_uint_eq(s.faces[0].input, 4);
    ck_assert_double_eq(s.areas[0], 0);
    ck_assert_double_eq_tol(s.areas[4], 1, 1e-12);
    ck_assert_ptr_nonnull(strstr(last_error, "warning: 4 degenerate faces"));
    ck_assert_ptr_nonnull(strstr(last_error, "2 points and lines"));
    ck_assert_ptr_eq(strchr(last_error, '\n'), last_error + strlen(last_error) - 1);
    scene_free(&s);
    const struct scene_options quiet = {.quiet = 1};
    ck_assert_int_eq(read_scene(&s, in_folder("s.obj"), &quiet), 0);
    ck_assert_str_eq(last_error, "");
    scene_free(&s);
}
END_TEST

/* A floor twice is one floor, the first; a wall with a face to either side is two. Here the
 * two-sided one emits, so it is what stays. */
START_TEST(test_same_faces)
{
    char body[512];
    snprintf(body, sizeof body,
             "%sv 0 1 0\nusemtl a\nf 1 2 3 4\nusemtl b_2s\nf 3 5 1 2\nusemtl black\nf 1 2 3 4\n"
             "usemtl a\nf 1 2 3\nf 3 2 1\nf 2 3 1\n",
             SQUARE);
    struct scene s;
    ck_assert_int_eq(read_body(&s, body), 0);
    ck_assert_uint_eq(s.input_count, 6);
    static const double area[] = {0, 1, 0, 0, 0, 0};
    for (int i = 0; i < 6; i++)
        ck_assert_double_eq_tol(s.areas[i], area[i], 1e-12);
    ck_assert_ptr_nonnull(strstr(last_error, "s.obj:8: warning: face 0 (line 8) lies on face 1 "
                                             "(line 10) in one plane"));
    ck_assert_ptr_nonnull(strstr(last_error, "face 2 (line 12), face 3 (line 14) and 2 more; 3.5 "
                                             "m2 in all"));
    scene_free(&s);
    snprintf(body, sizeof body, "%susemtl b_2s\nf 1 2 3 4\nusemtl a\nf 4 3 2 1\n", SQUARE);
    ck_assert_int_eq(read_body(&s, body), 0);
    ck_assert_double_eq(s.areas[1], 0);
    scene_free(&s);
}
END_TEST

START_TEST(test_crossing)
{
    char body[512];
    snprintf(body, sizeof body, "%sv 0 0 1\nusemtl a\nf 1 2 3 4\nf 1 2 5\nf 1 5 4 3\nf 5 2 1 4\n",
             SQUARE);
    struct scene s;
    ck_assert_int_eq(read_body(&s, body), 0);
    ck_assert_str_eq(last_error, "");
    scene_free(&s);
    snprintf(body, sizeof body, "%susemtl a\nf 1 2 4 3\nusemtl b_2s\nf 1 3 2 4\n", SQUARE);
    ck_assert_int_eq(read_body(&s, body), 0);
    ck_assert_ptr_nonnull(strstr(last_error, "s.obj:7: warning: the outline of face 0 (line 7) "
                                             "crosses itself (and 1 more): "));
    ck_assert_uint_eq(s.dropped, 0);
    scene_free(&s);
}
END_TEST

START_TEST(test_black_and_grey)
{
    char body[512];
    snprintf(body, sizeof body, "%susemtl black\nf 1 2 3 4\nusemtl a\nf 4 3 2 1\n", SQUARE);
    struct scene s;
    ck_assert_int_eq(read_body(&s, body), 0);
    ck_assert_uint_eq(s.faces[0].black, 1);
    ck_assert_uint_eq(s.faces[1].black, 0);
    ck_assert_uint_eq(s.bands, 1); /* the coloured material is not used */
    scene_free(&s);
}
END_TEST

/* ---- OBJ in full ---- */

/* Coordinates 1e-4 apart at 1e6, where floats are 1/16 apart: no digit is lost. */
START_TEST(test_double)
{
    const double at[4][2] = {{1000000.0001, -2000000.0001},
                             {1000000.0003, -2000000.0001},
                             {1000000.0003, -1999999.9997},
                             {1000000.0001, -1999999.9997}};
    char body[512];
    int size = 0;
    for (int i = 0; i < 4; i++)
        size += snprintf(body + size, sizeof body - (size_t)size,
                         "v %.4f %.4f 0.1234567890123456\n", at[i][0], at[i][1]);
    snprintf(body + size, sizeof body - (size_t)size, "usemtl a\nf 1 2 3 4\n");
    struct scene s;
    ck_assert_int_eq(read_body(&s, body), 0);
    ck_assert_uint_eq(s.face_count, 1);
    ck_assert_uint_eq(s.faces[0].vertices, 4);
    for (int i = 0; i < 4; i++) {
        ck_assert_double_eq(s.faces[0].vertex[i][0], at[i][0]);
        ck_assert_double_eq(s.faces[0].vertex[i][1], at[i][1]);
        ck_assert_double_eq(s.faces[0].vertex[i][2], 0.1234567890123456);
    }
    ck_assert_double_eq_tol(s.areas[0], 8e-8, 1e-12);
    scene_free(&s);
}
END_TEST

/* What may stand in a file, and what is passed over. */
START_TEST(test_obj)
{
    static const double corner[4][3] = {{0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}};
    static const struct {
        const char *name, *material;
        double rho, exitance;
    } expected[] = {
        {"before usemtl", "DefaultMaterial", 0.6, 0},
        {"defined later too", "late", 0.75, 0}, /* what usemtl meant stays */
        {"blanks", "two words", 0.125, 1e6},
        {"no Kd", "plain", 0.6, 3},
    };
    write_text("one.mtl", "# Kd 9 9 9\nnewmtl  two words\t\nKd 0.125\nd 0.5\nTr 0.5\nKe 1e6 "
                          "1000000 1.0e+06\nillum 2\nmap_Kd a.png\nNs x\n"
                          "newmtl late\nKd 0.75 0.75 0.75\nnewmtl plain\n\tKe 3 3 3 # W/m2\n");
    write_text("an other.mtl", "newmtl late\r\nKd .25 .25 .25\r\n");
    const char *obj = write_text(
        "full.obj", "\xEF\xBB\xBF# a comment \\\no thing\nvt 0 0\nvn 0 0 1\nvp 1\n"
                    "f -1 -2 -3\n" /* three vertices before this line are none: replaced below */);
    struct scene s;
    ck_assert_int_eq(read_scene(&s, obj, NULL), -1);
    ck_assert_msg(
        strstr(
            last_error,
            "full.obj:6: error: vertex index -1 is out of range: 0 vertices come before this line"),
        "%s", last_error);
    obj = write_text(
        "full.obj",
        "\xEF\xBB\xBF# a comment \\\no thing\nvt 0 0\nvn 0 0 1\n"
        "v 9 9 9 # never used\nv 0 0 1\nv 4 0 2 2\nv\t2\t2\t1\t0.5\t0.5\t0.5\r\nv 0 2 \\\n1\n"
        "f 2/1/1 3//1 4/1 5\n" /* faces before any material */
        "mtllib one.mtl\ng a b c\ns off\nusemtl late\n"
        "f -4/9/9 7 -2 -1 # vertex 7 comes later\n"
        "v 2 0 1\nv 2 0 1\n" /* 7 is 3 once more */
        "usemtl two words \n\tf 2 3 \\\r\n 4 5\ng d\nl 1 2\np 1\ncall x\n"
        "usemtl plain\nf +2 3 4 5\nmtllib an other.mtl");
    ck_assert_int_eq(read_scene(&s, obj, NULL), 0);
    ck_assert_uint_eq(s.face_count, 1); /* all four are in one place */
    ck_assert_ptr_nonnull(strstr(last_error, "2 points and lines"));
    scene_free(&s);
    struct scene_file file = {0};
    ck_assert_int_eq(read_obj(&file, obj, 1), 0);
    ck_assert_uint_eq(file.polygon_count, 4);
    for (size_t i = 0; i < 4; i++) {
        ck_assert_uint_eq(file.sizes[i], 4);
        for (size_t j = 0; j < 4; j++)
            for (size_t k = 0; k < 3; k++) {
                double x = file.positions[3 * (size_t)file.indices[4 * i + j] + k];
                ck_assert_msg(fabs(x - corner[j][k]) <= 0, "%s: %g at %zu", expected[i].name, x, j);
            }
        const struct RadMaterial *m = &file.materials[file.polygon_materials[i]];
        ck_assert_str_eq(file.names[file.polygon_materials[i]], expected[i].material);
        for (int k = 0; k < 3; k++) {
            ck_assert_double_eq(m->reflectance[k], expected[i].rho);
            ck_assert_double_eq(m->exitance[k], expected[i].exitance);
        }
    }
    scene_file_free(&file);
}
END_TEST

/* One triangle each, whose material the file says in some way that is not the plainest. */
START_TEST(test_materials_said_oddly)
{
    static char name[3000], mtl[8000], use[8000];
    memset(name, 'n', sizeof name - 1);
    snprintf(mtl, sizeof mtl, "newmtl %s\nKd .25\n", name);
    snprintf(use, sizeof use, "usemtl %s\n", name);
    static const char *const plain = "newmtl x\nKd .75\nnewmtl y\nKd .875\n";
    const struct {
        const char *mtl, *body;
        double rho, exitance;
        const char *told; /* NULL: nothing */
    } rows[] = {
        {mtl, use, .25, 0, NULL},
        {"newmtl x\nKd .25", "usemtl x\nmtllib y.mtl\n", .25, 0, NULL},
        {"newmtl x\nKd .25", "usemtl x\nmtllib x.mtl\n", .25, 0, "material 'x' is defined again"},
        {"newmtl x\nKd .25", "mtllib x.mtl\nusemtl x\n", .75, 0, "x.mtl:1: warning: material 'x'"},
        {"newmtl x\nKd .25", "usemtl x\nmtllib x.mtl\nmtllib m.mtl\n", .25, 0, "again"},
        {"newmtl x\nKd .25", "mtllib x.mtl\nmtllib m.mtl\nusemtl x\n", .25, 0, "again"},
        {"newmtl z", "mtllib m.mtl x.mtl y.mtl # all\nusemtl x\n", .75, 0, "no Kd"},
        {"newmtl x\nKd .25\nnewmtl x\nKd .5", "usemtl x\n", .5, 0, "m.mtl:3: warning"},
        {" \tnewmtl x\n\tKd .25 .25 .25\n", "usemtl x\n", .25, 0, NULL},
        {"newmtl x\nKd .5\nKe 5\n", "usemtl x\n", .5, 5, NULL},
        {"newmtl x\nKd 0x1p-1\n", "usemtl x\n", .5, 0, NULL},
        {"newmtl x\nKe 1 1 1\n", "usemtl x\n", .6, 1, "m.mtl:1: warning: material 'x' has no Kd"},
        {"newmtl\nKd .25\n", "usemtl\n", .25, 0, NULL},
        {"newmtl x\naniso 1\nNs abc\nd -halo 0.5\nKa spectral a.rfl\nKd .25\n", "usemtl x\n", .25,
         0, NULL},
        {"newmtl x\nKd .25 \\\n.25 \\\r\n.25\n", "usemtl x\n", .25, 0, NULL},
        {"\xEF\xBB\xBFnewmtl x\nKd .25\n", "usemtl x\n", .25, 0, NULL},
        {"newmtl x\rKd .25\rKe 1\r", "usemtl x\r", .25, 1, NULL},
        {"", "", .6, 0, "a face before any usemtl"},
        {"# nothing\n", "usemtl x\n", .6, 0, "its libraries are empty"},
        {"Kd .25\nnewmtl x\nKd .5\n", "usemtl x\n", .5, 0, "Kd before any newmtl"},
        {"newmtl x\nKd .25\nmap_Kd a.png\n", "usemtl x\n", .25, 0, "texture of material 'x'"},
        {"newmtl x\nKd .25\nd 0.5\n", "usemtl x\n", .25, 0, "'x' is transparent"},
        {"newmtl M #1\nKd .25\nnewmtl M #2\nKd .5\n", "usemtl M #1\n", .25, 0, NULL},
        {"newmtl x # red\nKd .25 # dark\nnewmtl y#\nKd .5# light", "usemtl x\t# it\n", .25, 0,
         NULL},
        {"newmtl x\nKd .25\nke 5\n", "usemtl x\n", .25, 0,
         "m.mtl:3: warning: a line that starts "
         "with 'ke'"},
        {"newmtl x\nKd .25\n", "usemtl x\nsurf 0 1 0 1 1\n", .25, 0, "starts with 'surf'"},
    };
    write_text("x.mtl", plain);
    write_text("y.mtl", "newmtl y\nKd .5\n");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        static char text[10000];
        write_text("m.mtl", rows[i].mtl);
        snprintf(text, sizeof text,
                 "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0#\n%sf 1 2 3 # a face\nf 1 3 2#too\n",
                 rows[i].body);
        struct scene_file file;
        const char *obj = write_text("odd.obj", text);
        struct scene s;
        ck_assert_msg(read_scene(&s, obj, NULL) == 0, "row %zu: %s", i, last_error);
        scene_free(&s);
        ck_assert_msg(rows[i].told ? strstr(last_error, rows[i].told) != NULL : !*last_error,
                      "row %zu: '%s'", i, last_error);
        ck_assert_int_eq(scene_file_read(&file, obj, &(struct scene_options){.quiet = 1}), 0);
        ck_assert_uint_eq(file.polygon_count, 2);
        for (int j = 0; j < 2; j++)
            for (int k = 0; k < 3; k++) {
                const struct RadMaterial *m = &file.materials[file.polygon_materials[j]];
                ck_assert_msg(m->reflectance[k] == rows[i].rho
                                  && m->exitance[k] == rows[i].exitance,
                              "row %zu: rho %g, E %g", i, m->reflectance[k], m->exitance[k]);
            }
        scene_file_free(&file);
    }
}
END_TEST

/* Every polygon knows its line, also behind lines that are continued. */
START_TEST(test_lines)
{
    write_text("m.mtl", MTL);
    const char *obj = write_text(
        "l.obj",
        "mtllib m.mtl\nv 0 0 0\nv 1 \\\n 0 0\nv 1 1 0\nf 1 2 \\\n3\n\nusemtl a\nf 1 2\n#\nf 3 2 1");
    struct scene_file file;
    ck_assert_int_eq(scene_file_read(&file, obj, NULL), 0);
    ck_assert_uint_eq(file.polygon_count, 3);
    ck_assert_uint_eq(file.position_count, 3);
    ck_assert_int_eq(file.single_precision, 0);
    static const uint32_t lines[] = {6, 10, 12}, sizes[] = {3, 2, 3};
    for (int i = 0; i < 3; i++) {
        ck_assert_uint_eq(file.lines[i], lines[i]);
        ck_assert_uint_eq(file.sizes[i], sizes[i]);
    }
    ck_assert_str_eq(file.names[file.polygon_materials[0]], "DefaultMaterial");
    ck_assert_str_eq(file.names[file.polygon_materials[1]], "a");
    scene_file_free(&file);
}
END_TEST

/* A backslash at the end of a comment joins nothing: what follows is not lost. */
START_TEST(test_comment_ends)
{
    write_text("m.mtl", MTL);
    const char *obj =
        write_text("c.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0 # C:\\\n  # D:\\\r\n"
                            "usemtl a\nf 1 \\\n2 3 # \\\n#\\\nf 1 2 3\n");
    struct scene_file file;
    ck_assert_int_eq(scene_file_read(&file, obj, NULL), 0);
    ck_assert_uint_eq(file.polygon_count, 2);
    ck_assert_str_eq(file.names[file.polygon_materials[0]], "a");
    ck_assert_uint_eq(file.lines[1], 10);
    scene_file_free(&file);
}
END_TEST

/* Materials are found by a hash of their names: a search through all would take a minute. */
START_TEST(test_many_materials)
{
    enum { MANY = 100000 };
    FILE *mtl = fopen(in_folder("many.mtl"), "w"), *obj = fopen(in_folder("many.obj"), "w");
    ck_assert(mtl && obj);
    fputs("mtllib many.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\n", obj);
    for (int i = 0; i < MANY; i++) {
        fprintf(mtl, "newmtl the material with the number %d\nKd %g\n", i, i / (double)MANY);
        fprintf(obj, "usemtl the material with the number %d\nf 1 2 3\n", MANY - 1 - i);
    }
    ck_assert(fclose(mtl) == 0 && fclose(obj) == 0);
    struct scene_file file;
    ck_assert_int_eq(scene_file_read(&file, in_folder("many.obj"), NULL), 0);
    ck_assert_uint_eq(file.material_count, MANY);
    for (uint32_t i = 0; i < MANY; i++)
        ck_assert_uint_eq(file.polygon_materials[i], MANY - 1 - i);
    scene_file_free(&file);
}
END_TEST

/* ---- errors: file, line, cause ---- */

/* Messages end as they should whatever a word holds, and nothing without an end is read. */
START_TEST(test_hostile_words)
{
    static char body[20000];
    char word[5000];
    struct scene s;
    memset(word, 'y', sizeof word - 1);
    word[sizeof word - 1] = 0;
    static const struct {
        const char *format, *what;
    } rows[] = {
        {"v 0 0 %s\n", "is not a number in a vertex; write a decimal number\n"},
        {"f %s\n", "is not a corner of a face; write the number of a vertex\n"},
        {"usemtl %s\n", "define it there or correct the name\n"},
        {"mtllib %s\n", "File name too long; put it there or correct the name\n"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        snprintf(body, sizeof body, rows[i].format, word);
        expect_error(body, rows[i].what);
    }
    expect_error("usemtl \033[31m%s%n\n", "s.obj:2: error: material '?[31m%s%n' is in no");
    expect_error("mtllib /dev/zero\n",
                 "s.obj:2: error: cannot read the material library '/dev/zero'");
    const char *endless = in_folder("endless.obj");
    ck_assert_int_eq(symlink("/dev/zero", endless), 0);
    ck_assert_int_eq(read_scene(&s, endless, NULL), -1);
    ck_assert_ptr_nonnull(strstr(last_error, "endless.obj: error: cannot read"));
}
END_TEST

START_TEST(test_errors)
{
    expect_error("v 0 0 0\nv nan 0 0\nv 1 1 0\nf 1 2 3\n",
                 "s.obj:3: error: a vertex is not finite");
    expect_error("v 0 0 0\nv inf 0 0\nv 1 1 0\nf 1 2 3\n",
                 "s.obj:3: error: a vertex is not finite");
    expect_error("v 0 0 0\nv 1e39 0 0\nv 1 1 0\nf 1 2 3\n",
                 "s.obj:3: error: a vertex is not finite");
    expect_error("v 0 0 0\nv 1 0\nf 1 2 1\n", "s.obj:3: error: a vertex with 2 numbers");
    expect_error("v 0 0 x\n", "s.obj:2: error: 'x' is not a number");
    expect_error("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 4\n",
                 "s.obj:5: error: vertex index 4 is out of range: 3 vertices");
    expect_error("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 -4\n",
                 "s.obj:5: error: vertex index -4 is out of range");
    expect_error("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 0 1 2\n",
                 "s.obj:5: error: vertex index 0 is out of range");
    expect_error("f 1 2 \\\n3 4\nv 0 0 0\nv 1 0 0\nv 1 1 0\n",
                 "s.obj:2: error: vertex index 4 is out of range: 3 vertices are in the file");
    expect_error("v 0 0 0\nv 1 \\\n0 0\nv 1 1 0\nf 1 2 x\n", "s.obj:6: error: 'x' is not a corner");
    expect_error("v 0 0 0\nv 1 0 0 0\nv 1 1 0\nf 1 2 3\n",
                 "s.obj:3: error: a vertex is not finite when divided by its w, 0");
    expect_error("usemtl b\nusemtl aa\nusemtl aa\n",
                 "s.obj:2: error: material 'b' is in no material library");
    expect_error("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 99999999999999999999\n", "out of range");
    expect_error("v 0 0 0\nv 1 0 0\nv 1 1 0\nf a b c\n", "s.obj:5: error: 'a' is not a corner");
    expect_error("v 0 0 0\nv 1 0 0\nv 1 1 0\nf\n", "s.obj:5: error: a face without corners");
    expect_error("v 0 0 0\nv 1 0 0\nv 1 1 0\n", "there is no face");
    expect_error("usemtl a\nv 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n",
                 "all of its 1 faces are degenerate");
    expect_error("v 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl aa\nf 1 2 3\n",
                 "s.obj:5: error: material 'aa' is in no material library");
    expect_error("mtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n",
                 "s.obj:2: error: cannot read the material library");
    struct scene s;
    ck_assert_int_eq(read_scene(&s, in_folder("missing.obj"), NULL), -1);
    ck_assert_ptr_nonnull(strstr(last_error, "No such file"));
    ck_assert_int_eq(read_scene(&s, folder, NULL), -1);
    ck_assert_ptr_nonnull(strstr(last_error, "this is a folder"));
    ck_assert_int_eq(read_scene(&s, write_text("g.xyz", "garbage"), NULL), -1);
    ck_assert_ptr_nonnull(strstr(last_error, "cannot be read as a scene"));
    ck_assert_int_eq(read_scene(&s, write_text("g.x", "xof 0302a\nb\n0032\n"), NULL), -1);
    ck_assert_msg(strchr(last_error, '\n')[1] == 0, "one line: %s", last_error);
    ck_assert_int_eq(read_scene(&s, write_text("g.gltf", "{\"garbage\": ["), NULL), -1);
    ck_assert_ptr_nonnull(strstr(last_error, "g.gltf: error: "));
    ck_assert_int_eq(read_scene(&s, write_text("empty.obj", ""), NULL), -1);
    ck_assert_ptr_nonnull(strstr(last_error, "there is no face"));
}
END_TEST

START_TEST(test_bad_materials)
{
    static const struct {
        const char *mtl, *error;
    } cases[] = {
        {"newmtl x\n\nKd 0.5 1 0.5\n", "x.mtl:3: error: material 'x' has reflectance 1;"},
        {"newmtl x\nKd 0.5 -0.1 0.5\n", "x.mtl:2: error: material 'x' has reflectance -0.1;"},
        {"newmtl x\nKd 0.5 0.5 0.5\nKe 0 0 -2\n",
         "x.mtl:3: error: material 'x' has exitance -2 W/m2;"},
        {"newmtl x\nKd 0.5 nan 0.5\n", "x.mtl:2: error: a diffuse colour (Kd) is not finite"},
        {"newmtl x\nKe 0 nan 0\n", "x.mtl:2: error: an exitance (Ke) is not finite"},
        {"newmtl x\nKd a b c\n", "x.mtl:2: error: 'a' is not a number"},
    };
    struct scene s;
    const char *obj =
        write_text("x.obj", "mtllib x.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl x\nf 1 2 3\n");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        write_text("x.mtl", cases[i].mtl);
        ck_assert_int_eq(read_scene(&s, obj, NULL), -1);
        ck_assert_msg(strstr(last_error, cases[i].error) != NULL, "'%s' is not in '%s'",
                      cases[i].error, last_error);
    }
    write_text("x.mtl", "newmtl unused\nKd 2 2 2\nnewmtl x\nKd 0.1 0.9 0.99\nKe 12345.5 0 1e-9\n");
    ck_assert_int_eq(read_scene(&s, obj, NULL), 0);
    const struct RadMaterial *m = &s.materials[s.faces[0].material];
    ck_assert_double_eq(m->reflectance[0], 0.1);
    ck_assert_double_eq(m->reflectance[2], 0.99);
    ck_assert_double_eq(m->exitance[0], 12345.5);
    ck_assert_double_eq(m->exitance[2], 1e-9);
    scene_free(&s);
}
END_TEST

/* ---- other formats ---- */

/* One triangle, (0 0 0) (1 0 0) (0 1 0), as 36 bytes of little-endian floats in base 64. */
static const char GLTF[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],"
    "\"nodes\":[{\"mesh\":0,\"scale\":[2,2,2],\"translation\":[0,0,5]},{\"mesh\":0,\"scale\":[-1,1,"
    "1]}],"
    "\"materials\":[{\"name\":\"m\",\"doubleSided\":%s,\"pbrMetallicRoughness\":{"
    "\"baseColorFactor\":[0.25,0.5,0.75,1]},"
    "\"emissiveFactor\":[1,0.5,0.25]}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0}]}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":"
    "[0,0,0],\"max\":[1,1,0]}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,\"uri\":"
    "\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}";

START_TEST(test_gltf)
{
    char text[2048];
    snprintf(text, sizeof text, GLTF, "false");
    struct scene s;
    ck_assert_int_eq(read_scene(&s, write_text("t.gltf", text), NULL), 0);
    ck_assert_uint_eq(s.face_count, 2);
    const struct RadMaterial *m = &s.materials[s.faces[0].material];
    ck_assert_double_eq(m->reflectance[0], 0.25);
    ck_assert_double_eq(m->reflectance[2], 0.75);
    ck_assert_double_eq(m->exitance[1], 0.5);
    ck_assert_int_eq(m->two_sided, 0);
    ck_assert_double_eq_tol(s.areas[0], 2, 1e-6); /* twice as large */
    ck_assert_double_eq_tol(s.faces[0].vertex[0][2], 5, 1e-6);
    /* The mirrored copy keeps its front. */
    double v[4][3], normal[3];
    memcpy(v, s.faces[1].vertex, sizeof v);
    polygon_normal(v, 3, normal);
    ck_assert_double_eq_tol(normal[2], 1, 1e-6);
    scene_free(&s);
    snprintf(text, sizeof text, GLTF, "true");
    ck_assert_int_eq(read_scene(&s, write_text("t.gltf", text), NULL), 0);
    ck_assert_uint_eq(s.face_count, 4);
    scene_free(&s);
}
END_TEST

/* Whose path is of another machine is beside the scene. */
START_TEST(test_libraries_of_windows)
{
    static const char *const names[] = {".\\w.mtl", "C:\\Program Files\\w.mtl", "a\\b\\w.mtl"};
    write_text("w.mtl", "newmtl x\nKd .25 .25 .25\n");
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char text[200];
        struct scene_file f;
        snprintf(text, sizeof text, "mtllib %s\nusemtl x\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n",
                 names[i]);
        ck_assert_int_eq(scene_file_read(&f, write_text("w.obj", text), NULL), 0);
        ck_assert_double_eq(f.materials[f.polygon_materials[0]].reflectance[0], .25);
        scene_file_free(&f);
    }
}
END_TEST

/* Numbers of 16 bits would be read as floats, many copies as one; a colour's index of refraction
 * is nobody's need. */
START_TEST(test_gltf_extensions)
{
    static const struct {
        const char *list, *name;
        int result;
    } cases[] = {{"Required", "KHR_mesh_quantization", -1},
                 {"Required", "EXT_meshopt_compression", -1},
                 {"Used", "EXT_mesh_gpu_instancing", -1},
                 {"Required", "KHR_materials_ior", 0},
                 {"Used", "KHR_mesh_quantization", 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[2048], more[2300];
        struct scene_file f;
        snprintf(text, sizeof text, GLTF, "false");
        snprintf(more, sizeof more, "{\"extensions%s\":[\"%s\"],%s", cases[i].list, cases[i].name,
                 text + 1);
        ck_assert_int_eq(scene_file_read(&f, write_text("x.gltf", more), NULL), cases[i].result);
        scene_file_free(&f);
    }
}
END_TEST

/* What a file has and a scene has not is told, and nothing of one that has none of it. */
START_TEST(test_gltf_told)
{
    static const char lights[] =
        "{\"extensionsUsed\":[\"KHR_lights_punctual\"],\"extensions\":{\"KHR_lights_punctual\":{"
        "\"lights\":[{\"type\":\"point\",\"name\":\"p\"}]}},";
    static const struct {
        const char *from, *to, *told;
    } cases[] = {
        {"{", "{", NULL},
        {"0.75,1]", "0.75,0.5]", NULL}, /* alpha says nothing without its mode */
        {"0.75,1]},", "0.75,0.5]},\"alphaMode\":\"BLEND\",", "opaque (1 materials)"},
        {"\"doubleSided\"",
         "\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":0.9}},"
         "\"doubleSided\"",
         "opaque (1 materials)"},
        {"\"mesh\":0,", "\"mesh\":0,\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}},",
         "material (1 lights)"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[2048], more[2600];
        struct scene s;
        snprintf(text, sizeof text, GLTF, "false");
        const char *at = strstr(text, cases[i].from);
        const int has_light = strstr(cases[i].to, "punctual") != NULL;
        snprintf(more, sizeof more, "%s%.*s%s%s", has_light ? lights : "",
                 (int)(at - text) - has_light, text + has_light, cases[i].to,
                 at + strlen(cases[i].from));
        ck_assert_msg(read_scene(&s, write_text("w.gltf", more), NULL) == 0, "%s", last_error);
        ck_assert_uint_eq(s.face_count, 2);
        scene_free(&s);
        ck_assert_msg(cases[i].told ? strstr(last_error, cases[i].told) != NULL : !*last_error,
                      "case %zu: '%s'", i, last_error);
    }
}
END_TEST

/* What the lamp emits, and what faces without a material reflect. */
START_TEST(test_gltf_materials)
{
    static const char form[] =
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
        "\"nodes\":[{\"mesh\":0}],\"materials\":[{\"name\":\"a\",\"pbrMetallicRoughness\":{"
        "\"baseColorFactor\":[0.3,0.3,0.3,1]},\"emissiveFactor\":[0,0,0]},"
        "{\"name\":\"%s\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.3,0.3,0.3,1]},"
        "\"emissiveFactor\":[1,1,1]},"
        "{\"name\":\"lamp\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.3,0.3,0.3,1]},"
        "\"emissiveFactor\":[1,1,1],\"extensions\":{\"KHR_materials_emissive_strength\":{"
        "\"emissiveStrength\":40}}}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":2},"
        "{\"attributes\":{\"POSITION\":0}},{\"attributes\":{\"POSITION\":0},\"material\":1}]}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
        "\"min\":[0,0,0],\"max\":[1,1,0]}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
        "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,"
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}";
    char text[2048];
    struct scene_file f;
    snprintf(text, sizeof text, form, "glow");
    ck_assert_int_eq(scene_file_read(&f, write_text("e.gltf", text), NULL), 0);
    ck_assert_uint_eq(f.polygon_count, 3);
    static const double rho[] = {0.3, 0.5, 0.3}, exitance[] = {40, 0, 1};
    for (int i = 0; i < 3; i++) {
        const struct RadMaterial *m = &f.materials[f.polygon_materials[i]];
        ck_assert_double_eq_tol(m->reflectance[1], rho[i], 1e-7);
        ck_assert_double_eq_tol(m->exitance[1], exitance[i], 1e-5);
    }
    scene_file_free(&f);
    snprintf(text, sizeof text, form, "lamp");
    struct scene s;
    ck_assert_int_eq(read_scene(&s, write_text("e.gltf", text), NULL), -1);
    ck_assert_ptr_nonnull(strstr(last_error, "two materials 'lamp' of one colour emit"));
}
END_TEST

START_TEST(test_ply)
{
    struct scene s;
    const char *ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float "
                      "y\nproperty float z\n"
                      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                      "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
    ck_assert_int_eq(read_scene(&s, write_text("q.ply", ply), NULL), 0);
    ck_assert_uint_eq(s.face_count, 1);
    ck_assert_uint_eq(s.faces[0].vertices, 4);
    ck_assert_double_eq(s.materials[s.faces[0].material].reflectance[0], 0.5);
    ck_assert_ptr_nonnull(strstr(last_error, "holds no materials"));
    scene_free(&s);
}
END_TEST

/* Two rows of four triangles in strips, all upwards: with -1 between, turned by corners that are
 * there twice, and as two lists. */
START_TEST(test_ply_strips)
{
    static const char head[] =
        "ply\nformat ascii 1.0\nelement vertex 9\nproperty float x\nproperty "
        "float y\nproperty float z\n0 0 0\n1 0 0\n2 0 0\n0 1 0\n1 1 0\n2 1 "
        "0\n0 2 0\n1 2 0\n2 2 0\n",
                      *const strips[] = {"1", "13 3 0 4 1 5 2 -1 6 3 7 4 8 5\n",
                                         "1", "14 3 0 4 1 5 2 2 6 6 3 7 4 8 5\n",
                                         "2", "6 3 0 4 1 5 2\n8 -1 6 3 7 4 8 5 -1\n"};
    const char *values = strstr(head, "0 0 0");
    for (int i = 0; i < 6; i += 2) {
        char text[512];
        snprintf(text, sizeof text,
                 "%.*selement tristrips %s\nproperty list int int vertex_indices\nend_header\n%s%s",
                 (int)(values - head), head, strips[i], values, strips[i + 1]);
        struct scene s;
        ck_assert_int_eq(read_scene(&s, write_text("strips.ply", text), NULL), 0);
        ck_assert_uint_eq(s.face_count, 8);
        ck_assert_uint_eq(s.overlaps, 0);
        ck_assert_double_eq_tol(total_area(&s), 4, 1e-12);
        for (uint32_t j = 0; j < s.face_count; j++) {
            double v[4][3], normal[3];
            memcpy(v, s.faces[j].vertex, sizeof v);
            polygon_normal(v, 3, normal);
            ck_assert_double_eq(normal[2], 1);
        }
        scene_free(&s);
    }
    char text[512];
    snprintf(
        text, sizeof text,
        "%.*selement tristrips 1\nproperty list int int vertex_indices\nend_header\n%s3 0 1 -2\n",
        (int)(values - head), head, values);
    struct scene s;
    ck_assert_int_eq(read_scene(&s, write_text("strips.ply", text), NULL), -1);
    ck_assert_ptr_nonnull(strstr(last_error, "strips.ply:19: error: tristrips 0 names vertex -2"));
}
END_TEST

static const char *write_bytes(const char *name, const char *bytes, size_t size)
{
    const char *path = in_folder(name);
    FILE *f = fopen(path, "wb");
    ck_assert_ptr_nonnull(f);
    ck_assert_uint_eq(fwrite(bytes, 1, size, f), size);
    ck_assert_int_eq(fclose(f), 0);
    return path;
}

/* Every beginning of a file that misses more than blanks is refused, unless what is missing are
 * digits of its last number: then it is told that the last line has no end. */
static void expect_whole(const char *name, const char *bytes, size_t size, double area)
{
    struct scene s;
    for (size_t cut = 0; cut < size; cut++) {
        if (read_scene(&s, write_bytes(name, bytes, cut), NULL) == 0) {
            ck_assert_msg(strstr(last_error, "the last line has no end") != NULL
                              || bytes[cut - 1] == '\r',
                          "%s of %zu bytes: %s", name, cut, last_error);
            ck_assert_uint_ge(cut + 10, size);
            scene_free(&s);
        }
        ck_assert_ptr_nonnull(strstr(last_error, name));
    }
    ck_assert_msg(read_scene(&s, write_bytes(name, bytes, size), NULL) == 0, "%s", last_error);
    ck_assert_ptr_null(strstr(last_error, "passed over"));
    ck_assert_double_eq_tol(total_area(&s), area, 1e-12);
    ck_assert_double_eq(s.materials[s.faces[0].material].reflectance[0], 0.5);
    scene_free(&s);
    char more[2000];
    memcpy(more, bytes, size);
    memcpy(more + size, "1 2 3\n", 6);
    if (read_scene(&s, write_bytes(name, more, size + 6), NULL) == 0) {
        ck_assert_msg(strstr(last_error, "passed over") != NULL, "%s: %s", name, last_error);
        scene_free(&s);
    }
}

/* Bytes of a number in either order. */
static size_t put_bytes(char *to, const void *value, size_t size, int big_endian)
{
    const uint16_t one = 1;
    int little = *(const char *)&one;
    for (size_t i = 0; i < size; i++)
        to[i] = ((const char *)value)[little == !big_endian ? i : size - 1 - i];
    return size;
}

/* A metre a thousand kilometres away: floats know it to 6 cm, doubles to the last digit. */
START_TEST(test_far_floats)
{
    static const char form[] = "ply\nformat ascii 1.0\nelement vertex 3\nproperty %s x\n"
                               "property %s y\nproperty %s z\nelement face 1\n"
                               "property list uchar int vertex_indices\nend_header\n"
                               "%s000000 0 0\n%s000001 0 0\n%s000000 1 0\n3 0 1 2\n";
    static const struct {
        const char *type, *millions;
        int told;
    } rows[] = {{"float", "1", 1}, {"double", "1", 0}, {"float", "0", 0}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const char *type = rows[i].type, *millions = rows[i].millions;
        char text[1024];
        struct scene s;
        snprintf(text, sizeof text, form, type, type, type, millions, millions, millions);
        ck_assert_int_eq(read_scene(&s, write_text("far.ply", text), NULL), 0);
        ck_assert_int_eq(strstr(last_error, "move it to the origin") != NULL, rows[i].told);
        ck_assert_double_eq_tol(s.areas[0], 0.5, 1e-12);
        scene_free(&s);
    }
}
END_TEST

START_TEST(test_cut_shapes)
{
    static const char
        off[] = "OFF # a square\n4 1 4\n0 0 0\n2 0 0 255 0 0\n2 2 0\n0 2 0\n\n"
                "4 0 1 2 3 0.5 0.5\n",
        plain_off[] = "3 1\r0 0 0\r2 0 0\r2 2 0\r3 0 1 2\r",
        ply[] = "ply\r\nformat ascii 1.0\r\ncomment x\r\nelement vertex 3\r\n"
                "property double x\r\nproperty double y\r\nproperty double z\r\n"
                "property uchar red\r\nelement face 1\r\n"
                "property list uchar int vertex_indices\r\nend_header\r\n"
                "1000000 0 0 1\r\n1000000.5 0 0 1\r\n1000000.5 1 0 1\r\n3 0 1 2\r\n",
        stl[] = "\xEF\xBB\xBFsolid of a kind\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n"
                "vertex 1 0 0\nvertex 1 1 0\nendloop\nendfacet\nendsolid\n";
    expect_whole("cut.off", off, sizeof off - 1, 4);
    expect_whole("plain.off", plain_off, sizeof plain_off - 1, 2);
    expect_whole("cut.ply", ply, sizeof ply - 1, .25);
    expect_whole("cut.stl", stl, sizeof stl - 1, .5);
    const float corner[3][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
    const int32_t index[3] = {0, 1, 2};
    char bytes[1000];
    for (int big = 0; big < 2; big++) {
        size_t size = (size_t)snprintf(
            bytes, sizeof bytes,
            "ply\nformat binary_%s_endian 1.0\nelement vertex 3\nproperty float x\n"
            "property float y\nproperty float z\nelement face 1\nproperty list uchar int "
            "vertex_index\nproperty short flag\nend_header\n",
            big ? "big" : "little");
        for (int i = 0; i < 9; i++)
            size += put_bytes(bytes + size, &corner[i / 3][i % 3], 4, big);
        bytes[size++] = 3;
        for (int i = 0; i < 3; i++)
            size += put_bytes(bytes + size, &index[i], 4, big);
        bytes[size++] = 0;
        bytes[size++] = 0;
        expect_whole(big ? "big.ply" : "little.ply", bytes, size, .5);
    }
    memset(bytes, 0, sizeof bytes);
    strcpy(bytes, "solid though of bytes");
    const uint32_t two = 2;
    size_t size = 80 + put_bytes(bytes + 80, &two, 4, 0);
    for (int i = 0; i < 2; i++, size += 2) {
        size += 12;
        for (int j = 0; j < 9; j++) {
            const float x = corner[j / 3][j % 3] + (float)i;
            size += put_bytes(bytes + size, &x, 4, 0);
        }
    }
    expect_whole("bytes.stl", bytes, size, 1);
}
END_TEST

START_TEST(test_damaged_shapes)
{
    static const struct {
        const char *name, *text, *error;
    } rows[] = {
        {"d.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n3 0 1 3\n",
         "d.off:6: error: face 0 names vertex 3, but there are 3"},
        {"d.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n3 0 1 -1\n", "d.off:6: error: face 0 names"},
        {"d.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n1 nan 0\n3 0 1 2\n", "d.off:5: error: vertex 2"},
        {"d.off", "OFF\n4000000000 4000000000 0\n0 0 0\n", "ends before vertex 1 of the 40000"},
        {"d.off", "OFF\n2 1 0\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n", "d.off:6: error: more lines"},
        {"d.off", "4OFF\n1 1 1\n", "no numbers of vertices"},
        {"d.ply",
         "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty "
         "float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n3 0 "
         "0 1\n",
         "d.ply:11: error: face 0 names vertex 1"},
        {"d.ply",
         "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty "
         "float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 1\n",
         "d.ply:10: error: more numbers for vertex 0"},
        {"d.ply", "ply\nformat ascii 1.0\nelement vertex 9999999999999\nend_header\n",
         "no vertices with x, y and z"},
        {"d.ply", "ply\nelement vertex -1\nend_header\n", "d.ply:2: error: an element without"},
        {"d.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n",
         "d.stl:4: error: a vertex with 2 numbers"},
        {"d.stl", "solid x\nendsolid x\n", "no triangle"},
        {"d.stl",
         "solid a much longer name than eighty bytes so that there is room for a title and a "
         "count\nendsolid\n",
         "no triangle"},
    };
    struct scene s;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        ck_assert_int_eq(read_scene(&s, write_text(rows[i].name, rows[i].text), NULL), -1);
        ck_assert_msg(strstr(last_error, rows[i].error) != NULL, "row %zu: '%s' is not in '%s'", i,
                      rows[i].error, last_error);
        ck_assert_ptr_eq(strchr(last_error, '\n'), last_error + strlen(last_error) - 1);
    }
}
END_TEST

/* ---- files written ---- */

static int files_in_folder(void)
{
    DIR *d = opendir(folder);
    int count = 0;
    while (readdir(d))
        count++;
    closedir(d);
    return count;
}

START_TEST(test_atomic)
{
    struct atomic_file f;
    mode_t old = umask(027);
    const char *path = write_text("out.txt", "before");
    int files = files_in_folder();
    ck_assert_int_eq(atomic_open(&f, path), 0);
    fputs("after", f.stream);
    atomic_discard(&f);
    char *text = read_text(path);
    ck_assert_str_eq(text, "before");
    free(text);
    ck_assert_int_eq(atomic_open(&f, path), 0);
    fputs("after", f.stream);
    ck_assert_int_eq(atomic_commit(&f), 0);
    text = read_text(path);
    ck_assert_str_eq(text, "after");
    free(text);
    ck_assert_int_eq(files_in_folder(), files);
    struct stat status;
    ck_assert_int_eq(stat(path, &status), 0);
    ck_assert_int_eq((int)(status.st_mode & 0777), 0640);
    umask(old);
    /* A link stays a link, and its file changes. */
    const char *link = in_folder("link");
    ck_assert_int_eq(symlink("out.txt", link), 0);
    ck_assert_int_eq(atomic_open(&f, link), 0);
    fputs("linked", f.stream);
    ck_assert_int_eq(atomic_commit(&f), 0);
    ck_assert(lstat(link, &status) == 0 && S_ISLNK(status.st_mode));
    text = read_text(path);
    ck_assert_str_eq(text, "linked");
    free(text);
    if (stat("/dev/full", &status) == 0) {
        ck_assert_int_eq(atomic_open(&f, "/dev/full"), 0);
        fputs("x", f.stream);
        ck_assert_int_eq(atomic_commit(&f), -1);
    }
    ck_assert_int_eq(atomic_open(&f, in_folder("no/such/file")), -1);
    ck_assert_int_eq(atomic_open(&f, folder), -1);
    atomic_discard(&f);
}
END_TEST

START_TEST(test_faces_csv)
{
    enum { FRONT = 1, BACK };
    const uint32_t face_element[2] = {FRONT, BACK};
    const struct element elements[3] = {
        [FRONT] = {.area = 1, .vertices = 4}, [BACK] = {.area = 1, .vertices = 4}};
    const double b[3] = {[FRONT] = 3, [BACK] = 1}, irradiance[3] = {[FRONT] = 4};
    write_text("n.mtl", "newmtl a, \"b\"_2s\nKd 0.5 0.5 0.5\nKe 1 1 1\n");
    struct loaded l;
    load_scene(&l, write_text("n.obj", "mtllib n.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl "
                                       "a, \"b\"_2s\nf 1 2 2\nf 1 2 3 4\n"));
    ck_assert_uint_eq(l.report.faces, 2);
    const struct solution solution = {
        l.surfaces,
        {elements, 3, 3, face_element, l.report.bands, b, irradiance, NULL, NULL},
        0,
        0};
    ck_assert_int_eq(faces_csv_write(in_folder("f.csv"), &solution, NULL), 0);
    char *text = read_text(in_folder("f.csv"));
    ck_assert_str_eq(text, "face,material,area,E_0,rho_0,H_0,B_0,sides\n"
                           "0,\"a, \"\"b\"\"_2s\",0,0,0,0,0,2\n"
                           "1,\"a, \"\"b\"\"_2s\",1,1,0.5,2,2,2\n");
    free(text);
    /* as names of rows are written: blanks at the ends are kept by quotes */
    static char in_front[] = " a", behind[] = "a ", within[] = "a b", empty[] = "";
    static const struct {
        char *name;
        const char *wanted;
    } names[] = {{in_front, "\" a\""}, {behind, "\"a \""}, {within, "a b"}, {empty, ""}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char wanted[80], *const all[] = {names[i].name};
        struct solution other = solution;
        other.surfaces.material_names = all;
        ck_assert_int_eq(faces_csv_write(in_folder("f.csv"), &other, NULL), 0);
        snprintf(wanted, sizeof wanted, "\n1,%s,1,1,", names[i].wanted);
        text = read_text(in_folder("f.csv"));
        ck_assert_msg(strstr(text, wanted), "%s", text);
        free(text);
    }
    unload_scene(&l);
}
END_TEST

int main(void)
{
    if (folder_make("scene") < 0)
        return EXIT_FAILURE;
    Suite *suite = suite_create("scene");
    TCase *t = tcase_create("scene");
    tcase_set_timeout(t, 60);
    tcase_add_loop_test(t, test_shipped, 0, sizeof facts / sizeof *facts);
    tcase_add_test(t, test_order);
    tcase_add_test(t, test_two_sided);
    tcase_add_test(t, test_polygons);
    tcase_add_test(t, test_star);
    tcase_add_test(t, test_concave);
    tcase_add_test(t, test_bridged);
    tcase_add_test(t, test_dropped);
    tcase_add_test(t, test_same_faces);
    tcase_add_test(t, test_crossing);
    tcase_add_test(t, test_black_and_grey);
    tcase_add_test(t, test_double);
    tcase_add_test(t, test_obj);
    tcase_add_test(t, test_materials_said_oddly);
    tcase_add_test(t, test_lines);
    tcase_add_test(t, test_comment_ends);
    tcase_add_test(t, test_many_materials);
    tcase_add_test(t, test_hostile_words);
    tcase_add_test(t, test_errors);
    tcase_add_test(t, test_bad_materials);
    tcase_add_test(t, test_gltf);
    tcase_add_test(t, test_libraries_of_windows);
    tcase_add_test(t, test_gltf_extensions);
    tcase_add_test(t, test_gltf_told);
    tcase_add_test(t, test_gltf_materials);
    tcase_add_test(t, test_ply);
    tcase_add_test(t, test_ply_strips);
    tcase_add_test(t, test_far_floats);
    tcase_add_test(t, test_cut_shapes);
    tcase_add_test(t, test_damaged_shapes);
    tcase_add_test(t, test_atomic);
    tcase_add_test(t, test_faces_csv);
    suite_add_tcase(suite, t);
    int failed = suite_failures(suite);
    folder_remove();
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
