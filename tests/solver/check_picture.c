/* check_picture.c - from a solution to pixels and meshes: interpolation, camera, exposure, exports.
 *
 * Solutions are made up, so that the right answer is known: constants, bilinear functions, colours
 * that say where a face stands. Files are written to a folder of their own, removed at the end.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <assimp/cimport.h>
#include <assimp/scene.h>

#include "geometry.h"
#include "hierarchy/hierarchy.h"
#include "load_scene.h"
#include "output/export.h"
#include "output/exposure.h"
#include "output/far_away.h"
#include "output/image.h"
#include "output/leaf_mesh.h"
#include "output/picture.h"
#include "output/raster.h"
#include "folder.h"
#include "read_png.h"
#include "suite.h"

/* ---- a solution made by hand ---- */

enum { FACES_MAX = 8, ELEMENTS_MAX = 60000 };

struct stage {
    struct RadFace faces[FACES_MAX];
    struct RadMaterial materials[FACES_MAX];
    uint32_t bands;
    struct hierarchy h; /* of the engine, for quadtrees as uneven as they come */
    struct solution solution;
    struct vertex_values values;
    double *b, *gradient; /* gradient: NULL or 3 per element */
};

static struct stage *stage_new(uint32_t bands)
{
    struct stage *s = calloc(1, sizeof *s);
    s->solution.surfaces.faces = s->faces;
    s->solution.surfaces.materials = s->materials;
    s->bands = bands;
    s->b = calloc(3 * ELEMENTS_MAX, sizeof *s->b);
    return s;
}

static void stage_face(struct stage *s, uint32_t material, uint32_t vertices, const double v[4][3])
{
    uint32_t i = s->solution.surfaces.face_count++;
    memcpy(s->faces[i].vertex, v, vertices * sizeof v[0]);
    s->faces[i].vertices = vertices;
    s->faces[i].material = material;
    s->faces[i].input = i;
}

static void stage_build(struct stage *s)
{
    /* A RadFace is a struct face. */
    ck_assert_int_eq(hierarchy_build(&s->h, (const struct face *)(const void *)s->faces,
                                     s->solution.surfaces.face_count),
                     0);
}

static int leaf(const struct stage *s, uint32_t i)
{
    return is_leaf(&s->h.elements[i]);
}

/* Split some leaves, others not, `rounds` times: a quadtree as uneven as they come. */
static void stage_split(struct stage *s, int rounds)
{
    for (int r = 0; r < rounds; r++) {
        uint32_t count = s->h.count;
        for (uint32_t i = 0; i < count; i++)
            if (leaf(s, i) && (s->h.elements[i].depth == 0 || (s->h.elements[i].id >> 20) % 3 == 0))
                ck_assert_int_eq(hierarchy_split(&s->h, i), 0);
    }
    ck_assert_uint_lt(s->h.count, ELEMENTS_MAX);
}

static void stage_solve(struct stage *s)
{
    s->solution.tree =
        (struct RadElements){s->h.elements, s->h.count, s->h.built, s->h.face_element, s->bands,
                             s->b,          s->b,       NULL,       s->gradient};
    ck_assert_int_eq(vertex_values_build(&s->values, &s->solution), 0);
}

static void stage_free(struct stage *s)
{
    vertex_values_free(&s->values);
    hierarchy_free(&s->h);
    free(s->b);
    free(s->gradient);
    free(s);
}

/* ---- interpolation ---- */

static const double SQUARE[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
static const double SKEW[4][3] = {{0, 0, 1}, {3, 0.5, 1}, {2, 2, 1}, {0.25, 1, 1}};
static const double BELOW[4][3] = {{0, -1, 0}, {1, -1, 0}, {1, 0, 0}, {0, 0, 0}};
static const double TRIANGLE[4][3] = {{0, 0, 2}, {2, 0, 2}, {0, 1, 3}};

/* From both sides of every leaf's every edge, at points a hair apart, the same value. */
static void check_seams(const struct stage *s)
{
    int seams = 0;
    for (uint32_t i = 0; i < s->h.count; i++) {
        const struct element *e = &s->h.elements[i];
        for (int j = 0; leaf(s, i) && j < e->vertices; j++)
            for (double t = 0.03; t < 1; t += 0.11) {
                double in[3], out[3], value[2][3];
                const double *a = e->vertex[j], *b = e->vertex[(j + 1) % e->vertices];
                for (int k = 0; k < 3; k++) {
                    double on = a[k] + t * (b[k] - a[k]);
                    in[k] = on + 1e-9 * (e->centre[k] - on);
                    out[k] = on - 1e-9 * (e->centre[k] - on);
                }
                uint32_t p = vertex_values_at(&s->values, &s->solution, e->face, in, value[0]);
                uint32_t q = vertex_values_at(&s->values, &s->solution, e->face, out, value[1]);
                ck_assert_uint_eq(p, i);
                seams += p != q;
                ck_assert_double_eq_tol(value[0][0], value[1][0], 1e-6);
            }
    }
    ck_assert_int_gt(seams, 1000);
}

/* Faces of all shapes, not solved yet. */
static struct stage *stage_of_three(int rounds)
{
    struct stage *s = stage_new(1);
    stage_face(s, 0, 4, SQUARE);
    stage_face(s, 0, 4, SKEW);
    stage_face(s, 0, 3, TRIANGLE);
    stage_build(s);
    stage_split(s, rounds);
    return s;
}

START_TEST(test_no_seams)
{
    struct stage *s = stage_of_three(6);
    for (uint32_t i = 0; i < s->h.count; i++)
        s->b[i] = (double)(s->h.elements[i].id % 1000) / 100; /* as rough as can be */
    stage_solve(s);
    check_seams(s);
    stage_free(s);
}
END_TEST

/* Vertices with values of their own, hanging ones too: a linear function is shown exactly in every
 * leaf, and any others without a jump. */
START_TEST(test_own_values)
{
    const double g[3] = {3, -2, 0.5};
    struct stage *s = stage_of_three(6);
    stage_solve(s);
    int hanging = 0;
    for (uint32_t i = 0; i < s->values.count; i++)
        s->values.value[i] = 100 + dot3(g, s->values.vertices[i].position);
    for (uint32_t i = 0; i < s->h.count; i++) {
        const struct element *e = &s->h.elements[i];
        for (int j = 0; leaf(s, i) && j < e->vertices; j++)
            for (double t = 0.05; t < 1; t += 0.1) {
                double p[3], value;
                for (int k = 0; k < 3; k++)
                    p[k] = e->vertex[j][k] + t * (e->centre[k] - e->vertex[j][k]);
                vertex_values_at(&s->values, &s->solution, e->face, p, &value);
                ck_assert_double_eq_tol(value, 100 + dot3(g, p), 1e-9);
                hanging += s->values.middle[4 * (size_t)i + (size_t)j] != NO_VERTEX;
            }
    }
    ck_assert_int_gt(hanging, 1000);
    for (uint32_t i = 0; i < s->values.count; i++)
        s->values.value[i] = i * 7919 % 1000 / 100.0;
    check_seams(s);
    stage_free(s);
}
END_TEST

/* Two faces side by side are one surface when they share plane and material, else not. */
START_TEST(test_across_faces)
{
    for (uint32_t material = 0; material < 2; material++) {
        struct stage *s = stage_new(1);
        stage_face(s, 0, 4, SQUARE);
        stage_face(s, material, 4, BELOW);
        s->materials[1].exitance[0] = 7;
        stage_build(s);
        hierarchy_split(&s->h, s->h.face_element[0]);
        for (uint32_t i = 0; i < s->h.count; i++)
            s->b[i] = s->h.elements[i].face == 0 ? 1 : 9;
        stage_solve(s);
        double above[3] = {0.3, 1e-9, 0}, below[3] = {0.3, -1e-9, 0}, corner[3] = {0, 0, 0}, value;
        vertex_values_at(&s->values, &s->solution, 0, above, &value);
        /* Shared: at (0, 0) leaves of 1/4 m2 with 1 and of 1 m2 with 9 meet; (1/4 + 9) / (5/4). */
        ck_assert_double_eq_tol(value, material ? 1 : 7.4, 1e-6);
        vertex_values_at(&s->values, &s->solution, 1, below, &value);
        ck_assert_double_eq_tol(value, material ? 9 : 7.4, 1e-6);
        vertex_values_at(&s->values, &s->solution, 1, corner, &value);
        ck_assert_double_eq_tol(value, material ? 9 : 7.4, 1e-12);
        stage_free(s);
    }
}
END_TEST

/* Faces that meet at an angle share no value, though their material is one. */
START_TEST(test_across_an_edge)
{
    const double upright[4][3] = {{0, 0, 1}, {1, 0, 1}, {1, 0, 0}, {0, 0, 0}};
    const double floor[3] = {0.3, 1e-9, 0}, wall[3] = {0.3, 0, 1e-9};
    struct stage *s = stage_new(1);
    stage_face(s, 0, 4, SQUARE);
    stage_face(s, 0, 4, upright);
    stage_build(s);
    for (uint32_t i = 0; i < s->h.count; i++)
        s->b[i] = s->h.elements[i].face == 0 ? 1 : 9;
    stage_solve(s);
    double value;
    vertex_values_at(&s->values, &s->solution, 0, floor, &value);
    ck_assert_double_eq_tol(value, 1, 1e-6);
    vertex_values_at(&s->values, &s->solution, 1, wall, &value);
    ck_assert_double_eq_tol(value, 9, 1e-6);
    stage_free(s);
}
END_TEST

/* Leaves of one linear function show it exactly, hanging vertices, triangles and all; with
 * gradients of their own, vertices take the mean of what the leaves have there, and nothing is
 * below 0. */
START_TEST(test_linear_leaves)
{
    const double g[3] = {3, -2, 0.5}, square[3] = {0.5, 0.5, 0};
    struct stage *s = stage_of_three(4);
    s->gradient = calloc(3 * ELEMENTS_MAX, sizeof *s->gradient);
    for (uint32_t i = 0; i < s->h.count; i++) {
        s->b[i] = 100 + dot3(g, s->h.elements[i].centre);
        memcpy(&s->gradient[3 * (size_t)i], g, sizeof g);
    }
    stage_solve(s);
    for (uint32_t i = 0; i < s->values.count; i++)
        ck_assert_double_eq_tol(s->values.value[i], 100 + dot3(g, s->values.vertices[i].position),
                                1e-9);
    vertex_values_free(&s->values);
    for (uint32_t i = 0; i < s->h.count; i++)
        s->b[i] -= 1000;
    stage_solve(s);
    double value;
    vertex_values_at(&s->values, &s->solution, 0, square, &value);
    ck_assert_double_eq(value, 0);
    stage_free(s);
}
END_TEST

/* In one leaf: bilinear in a quad, linear in a triangle, whatever its shape. */
START_TEST(test_shape_functions)
{
    const double trapezium[4][3] = {{0, 0, 0}, {4, 0, 0}, {3, 0, 1}, {1, 0, 1}};
    struct stage *s = stage_new(1);
    stage_face(s, 0, 4, SKEW);
    stage_face(s, 1, 4, trapezium);
    stage_face(s, 2, 4, SQUARE);
    stage_face(s, 3, 3, TRIANGLE);
    stage_build(s);
    stage_solve(s);
    for (uint32_t f = 0; f < 4; f++) {
        const uint32_t *c = &s->values.corner[4 * (size_t)s->h.face_element[f]];
        uint32_t n = s->faces[f].vertices;
        for (uint32_t j = 0; j < n; j++)
            s->values.value[c[j]] = 1 + j * j;
        for (double u = 0; u <= 1; u += 0.0625)
            for (double v = 0; v <= (n == 4 ? 1 : 1 - u); v += 0.0625) {
                double w[4] = {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v}, p[3],
                       wanted = 0;
                if (n == 3)
                    w[0] = 1 - u - v, w[1] = u, w[2] = v;
                for (int k = 0; k < 3; k++) {
                    p[k] = 0;
                    for (uint32_t j = 0; j < n; j++)
                        p[k] += w[j] * s->faces[f].vertex[j][k];
                }
                for (uint32_t j = 0; j < n; j++)
                    wanted += w[j] * (1 + j * j);
                double value;
                vertex_values_at(&s->values, &s->solution, f, p, &value);
                ck_assert_double_eq_tol(value, wanted, 1e-9);
            }
    }
    stage_free(s);
}
END_TEST

/* ---- the camera ---- */

START_TEST(test_view_parse)
{
    static const char *const bad[] = {"",
                                      "1,2,3",
                                      "1,2,3:",
                                      "1,2,3:4,5",
                                      "1,2,3:1,2,3",
                                      "1,2,3:4,5,6:",
                                      "1,2,3:4,5,6:0.5",
                                      "1,2,3:4,5,6:171",
                                      "1,2,3:4,5,6:x",
                                      "1,2,3:4,5,6:60x",
                                      "nan,2,3:4,5,6",
                                      "1,2,3:inf,5,6",
                                      "1, 2,3:4,5,6",
                                      "1,2,3:4,5,6:nan",
                                      "1;2;3:4;5;6",
                                      "1e200,0,0:-1e200,0,0"};
    struct view v;
    ck_assert_int_eq(view_parse("1,-2,3.5:4,5e-1,6", &v), 0);
    ck_assert(v.eye[0] == 1 && v.eye[1] == -2 && v.eye[2] == 3.5 && v.at[0] == 4 && v.at[1] == 0.5
              && v.at[2] == 6);
    ck_assert(v.fov == 70 && v.up[0] == 0 && v.up[1] == 0 && v.up[2] == 0);
    ck_assert_int_eq(view_parse("0,0,0:0,0,1:39.5", &v), 0);
    ck_assert(v.fov == 39.5);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        ck_assert_msg(view_parse(bad[i], &v) == -1, "'%s' was taken", bad[i]);
}
END_TEST

START_TEST(test_frame_straight_down)
{
    struct stage *s = stage_new(1);
    double right[3], up[3], ahead[3];
    stage_face(s, 0, 4, SQUARE); /* z is up */
    struct view v;
    for (int i = 0; i < 2; i++) {
        view_parse(i ? "0,0,5:0,0,0" : "0,0,0:1,1,9", &v);
        view_frame(&v, &s->solution.surfaces, right, up, ahead);
        ck_assert_double_eq_tol(length3(right), 1, 1e-12);
        ck_assert_double_eq_tol(length3(up), 1, 1e-12);
        ck_assert_double_eq_tol(
            fabs(dot3(up, ahead)) + fabs(dot3(up, right)) + fabs(dot3(right, ahead)), 0, 1e-12);
    }
    ck_assert_double_eq_tol(up[1], 1, 1e-12);
    ck_assert_double_eq_tol(right[0], 1, 1e-12);
    stage_free(s);
}
END_TEST

/* Which channel leads clearly, 0 to 2, or -1. */
static int hue(const unsigned char *c)
{
    for (int k = 0; k < 3; k++)
        if (c[k] > 40 + c[(k + 1) % 3] && c[k] > 40 + c[(k + 2) % 3])
            return k;
    return -1;
}

/* Squares 1 m wide at distance 4, before the eye at the origin that looks along +y, z up. */
static void wall(struct stage *s, uint32_t material, double x, double y, double z, int back)
{
    double v[4][3] = {{x, y, z}, {x + 1, y, z}, {x + 1, y, z + 1}, {x, y, z + 1}};
    if (back) {
        double t[3];
        memcpy(t, v[1], sizeof t);
        memcpy(v[1], v[3], sizeof t);
        memcpy(v[3], t, sizeof t);
    }
    stage_face(s, material, 4, (const double(*)[3])v);
}

static void colours(struct stage *s)
{
    for (uint32_t i = 0; i < s->h.count; i++)
        for (uint32_t k = 0; k < 3; k++)
            s->b[3 * i + k] = s->faces[s->h.elements[i].face].material == k ? 2 : 0.02;
}

START_TEST(test_not_mirrored)
{
    struct stage *s = stage_new(3);
    wall(s, 0, 1, 4, 0, 0);   /* red: right, just above the middle */
    wall(s, 1, -2, 4, 1, 0);  /* green: left, higher */
    wall(s, 2, 0, 4, -2, 0);  /* blue: low, right of the middle */
    wall(s, 2, 0.5, 2, 0, 1); /* a back before the red one: cut away */
    wall(s, 1, -1, 8, -4, 0); /* green behind the blue one: hidden there */
    stage_build(s);
    stage_split(s, 3);
    colours(s);
    stage_solve(s);
    /* tan(fov / 2) = 0.5: at distance 4 the picture is 4 m high, hence 50 pixels to the metre. */
    char text[64];
    snprintf(text, sizeof text, "0,0,0:0,1,0:%.12f", 2 * atan(0.5) * 180 / 3.14159265358979323846);
    struct view v;
    ck_assert_int_eq(view_parse(text, &v), 0);
    v.up[2] = 1;
    ck_assert_int_eq(
        image_write(in_folder("a.png"), &s->solution, &s->values, &v, 240, 200, 0, NULL), 0);
    struct pixels p = load(in_folder("a.png"));
    ck_assert_int_eq(p.width, 240);
    ck_assert_int_eq(p.height, 200);
    /* x in pixels: 120 + 50 x, y: 100 - 50 z */
    static const struct {
        int x, y, hue;
    } expected[] = {
        {172, 98, 0},  {218, 98, 0},  {172, 52, 0},   {168, 75, -1},  {222, 75, -1}, {195, 102, -1},
        {195, 47, -1}, {22, 48, 1},   {68, 2, 1},     {72, 25, -1},   {45, 52, -1},  {122, 152, 2},
        {168, 198, 2}, {122, 198, 2}, {172, 175, -1}, {130, 148, -1}, {100, 190, 1}, {100, 80, -1},
    };
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++)
        ck_assert_msg(hue(at(&p, expected[i].x, expected[i].y)) == expected[i].hue, "pixel %d %d",
                      expected[i].x, expected[i].y);
    /* Away from the edges a surface of one radiosity is one colour. */
    ck_assert_mem_eq(at(&p, 180, 90), at(&p, 210, 60), 3);
    free(p.rgb);
    stage_free(s);
}
END_TEST

/* Counts threads that ask it for colours; it takes its time, so that others come. */
struct asking {
    atomic_int threads;
    unsigned call;
};

static void ask_colour(const void *context, const struct picture_sample *sample, double colour[3])
{
    static _Thread_local unsigned met;
    struct asking *asking;
    memcpy(&asking, context, sizeof asking);
    (void)sample;
    if (met != asking->call) {
        met = asking->call;
        atomic_fetch_add(&asking->threads, 1);
        nanosleep(&(struct timespec){.tv_nsec = 50000000}, NULL);
    }
    colour[0] = colour[1] = colour[2] = .5;
}

/* As many threads draw as are wanted, and no more. */
START_TEST(test_picture_threads)
{
    static unsigned calls;
    struct stage *s = stage_new(1);
    struct picture p;
    struct view v;
    ck_assert_int_eq(view_parse("0.5,0,0.5:0.5,1,0.5:14", &v), 0);
    v.up[2] = 1;
    wall(s, 0, 0, 4, 0, 0);
    stage_build(s);
    for (uint32_t i = 0; i < s->h.count; i++)
        s->b[i] = 1;
    stage_solve(s);
    for (int threads = 1; threads <= 5; threads += 2) {
        struct asking asking = {.call = ++calls}, *at = &asking;
        s->solution.threads = threads;
        ck_assert_int_eq(picture_open(&p, "p.png", &s->solution, &s->values, &v, 90, 90, 0), 0);
        uint8_t *rgb = picture_draw(&p, ask_colour, &at);
        ck_assert_ptr_nonnull(rgb);
        free(rgb);
        ck_assert_int_le(asking.threads, threads);
        ck_assert_int_ge(asking.threads, threads > 1 ? 2 : 1);
    }
    stage_free(s);
}
END_TEST

START_TEST(test_mesh_lines)
{
    struct stage *s = stage_new(1);
    wall(s, 0, 0, 4, 0, 0);
    stage_build(s);
    hierarchy_split(&s->h, s->h.face_element[0]);
    for (uint32_t i = 0; i < s->h.count; i++)
        s->b[i] = 1;
    stage_solve(s);
    char text[64];
    snprintf(text, sizeof text, "0.5,0,0.5:0.5,1,0.5:%.12f",
             2 * atan(0.125) * 180 / 3.14159265358979323846); /* it fills the picture */
    struct view v;
    view_parse(text, &v);
    v.up[2] = 1;
    struct pixels p[2];
    for (int mesh = 0; mesh < 2; mesh++) {
        ck_assert_int_eq(
            image_write(in_folder("m.png"), &s->solution, &s->values, &v, 101, 101, mesh, NULL), 0);
        p[mesh] = load(in_folder("m.png"));
    }
    for (int y = 0; y < 101; y++)
        for (int x = 0; x < 101; x++) {
            int plain = at(&p[0], x, y)[0], lined = at(&p[1], x, y)[0];
            int line =
                abs(x - 50) == 0 || abs(y - 50) == 0 || x == 0 || y == 0 || x == 100 || y == 100;
            int beside =
                abs(x - 50) == 1 || abs(y - 50) == 1 || x == 1 || y == 1 || x == 99 || y == 99;
            if (line)
                ck_assert_msg(lined < plain - 20, "no line at %d %d", x, y);
            else if (!beside)
                ck_assert_msg(lined == plain, "a line at %d %d", x, y);
        }
    free(p[0].rgb);
    free(p[1].rgb);
    stage_free(s);
}
END_TEST

/* ---- shipped scenes: closed, so every sample meets a front ---- */

static const struct {
    const char *name, *view;
} shipped[] = {
    {"room", "0.4,0.3,1.9:2.4,3.4,0.7"},
    {"td", "2.55,3.75,1.35:2.5,4.6,0.76"},
    {"td", "1.2,1.6,1.8:2.7,4.6,0.7"},
    {"sejour", "5.5,0.25,1.9:2.4,3.2,0.6"},
    {"sejour", "0.7,3.0,1.8:4.5,1.2,0.7"},
    {"cornell", "0.278,0.273,0.05:0.278,0.273,1"},
    {"furnace", "0.5,0.5,0.5:1,1,1"},
    {"furnace_4", "0.1,0.2,0.3:1,0.5,0.5:120"},
    {"maze_8", "0.6,0.6,1.5:3,0.65,1.2"},
    {"room", NULL},
    {"cornell", NULL},
    {"td", NULL},
    {"sejour", NULL},
};

START_TEST(test_watertight)
{
    struct loaded l = {0};
    char path[128];
    snprintf(path, sizeof path, "examples/scenes/%s.obj", shipped[_i].name);
    load_scene(&l, path);
    struct view v;
    if (shipped[_i].view)
        ck_assert_int_eq(view_parse(shipped[_i].view, &v), 0);
    else
        ck_assert_int_eq(view_guess(&l.surfaces, &v), 0);
    enum { W = 320, H = 240 };
    uint32_t *face = malloc(W * H * sizeof *face), misses = 0, backs = 0;
    double *nearness = malloc(W * H * sizeof *nearness);
    struct raster r;
    ck_assert_int_eq(raster_begin(&r, &l.surfaces, &v, W, H, 1), 0);
    raster_rows(&r, 0, H, face, nearness);
    for (int i = 0; i < W * H; i++) {
        misses += face[i] == NO_FACE;
        for (uint32_t j = 0; j < r.count && face[i] != NO_FACE; j++)
            if (r.faces[j].face == face[i]) {
                backs += !r.faces[j].front;
                break;
            }
    }
    ck_assert_uint_eq(misses, 0);
    ck_assert_uint_eq(backs, 0);
    ck_assert_int_eq(view_up_axis(&l.surfaces), strcmp(shipped[_i].name, "cornell") == 0 ? 1 : 2);
    raster_end(&r);
    free(face);
    free(nearness);
    unload_scene(&l);
}
END_TEST

/* Depth against the plane's equation: what the raster says is where the ray meets the face. */
START_TEST(test_raster_depth)
{
    struct stage *s = stage_new(1);
    /* reaches behind the eye */
    const double floor[4][3] = {{-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}};
    stage_face(s, 0, 4, floor);
    struct view v;
    ck_assert_int_eq(view_parse("0,0,2:1,0,1:90", &v), 0);
    struct raster r;
    ck_assert_int_eq(raster_begin(&r, &s->solution.surfaces, &v, 64, 48, 0), 0);
    uint32_t face[64 * 48];
    double nearness[64 * 48];
    raster_rows(&r, 0, 48, face, nearness);
    for (int y = 0; y < 48; y++)
        for (int x = 0; x < 64; x++) {
            double d[3];
            raster_direction(&r, x, y, d);
            double t = -2 / d[2], px = t * d[0], py = t * d[1];
            int hit = d[2] < 0 && fabs(px) < 50 && fabs(py) < 50;
            ck_assert_int_eq(face[64 * y + x] == 0, hit);
            if (hit)
                ck_assert_double_eq_tol(nearness[64 * y + x], 1 / t, 1e-12);
        }
    raster_end(&r);
    stage_free(s);
}
END_TEST

/* ---- exposure ---- */

START_TEST(test_exposure)
{
    /* The same whatever the unit; a lamp in sight changes nothing (it is not metered). */
    double b[3] = {3, 2, 1}, dim[3], bright[3], zero[1] = {0};
    struct meter_sample samples[3] = {{1, 1}, {2, 1}, {5, 2}},
                        scaled[3] = {{1000, 1}, {5000, 2}, {2000, 1}};
    struct exposure e = exposure_measure(samples, 3), f = exposure_measure(scaled, 3);
    exposure_apply(&e, b, 3, dim);
    for (int k = 0; k < 3; k++)
        b[k] *= 1000;
    exposure_apply(&f, b, 3, bright);
    for (int k = 0; k < 3; k++)
        ck_assert_double_eq_tol(dim[k], bright[k], 1e-12);
    ck_assert_double_eq_tol(dim[0] / dim[1], 1.5, 1e-12); /* the hue is kept */
    ck_assert(dim[0] > 0.05 && dim[0] < 0.95);
    /* The log-mean goes to 0.34, and the shoulder ends 1.2 times above what 98 % of the picture
     * do not exceed. */
    struct meter_sample bright_spot[3] = {{1, 60}, {1000, 1}, {30, 39}};
    f = exposure_measure(bright_spot, 3);
    ck_assert_double_eq_tol(f.scale * exp(0.39 * log(30) + 0.01 * log(1000)), 0.34, 1e-12);
    ck_assert_double_eq_tol(f.white, 1.2 * 30 * f.scale, 1e-12);
    f = exposure_measure(samples, 0);
    exposure_apply(&f, zero, 1, dim);
    ck_assert(dim[0] == 0 && dim[1] == 0 && dim[2] == 0);
    /* sRGB: fixed points of the standard, 18 % grey is 118 (IEC 61966-2-1). */
    ck_assert_int_eq(srgb_byte(0), 0);
    ck_assert_int_eq(srgb_byte(1), 255);
    ck_assert_int_eq(srgb_byte(0.18), 118);
    ck_assert_int_eq(srgb_byte(-1), 0);
    ck_assert_int_eq(srgb_byte(7), 255);
}
END_TEST

START_TEST(test_bad_sizes)
{
    struct stage *s = stage_new(1);
    stage_face(s, 0, 4, SQUARE);
    stage_build(s);
    stage_solve(s);
    ck_assert_int_eq(
        image_write(in_folder("n.png"), &s->solution, &s->values, NULL, 0, 10, 0, NULL), -1);
    ck_assert_int_eq(
        image_write(in_folder("n.png"), &s->solution, &s->values, NULL, 10, 20000, 0, NULL), -1);
    ck_assert_int_eq(
        image_write(in_folder("no/n.png"), &s->solution, &s->values, NULL, 10, 10, 0, NULL), -1);
    ck_assert_int_ne(access(in_folder("n.png"), F_OK), 0);
    /* All black, and seen from outside: still a picture. */
    ck_assert_int_eq(image_write(in_folder("n.png"), &s->solution, &s->values, NULL, 1, 1, 1, NULL),
                     0);
    stage_free(s);
}
END_TEST

/* ---- exports ---- */

static struct stage *coloured_stage(void)
{
    struct stage *s = stage_new(3);
    stage_face(s, 0, 4, SQUARE);
    stage_face(s, 1, 4, BELOW);
    stage_face(s, 2, 3, TRIANGLE);
    stage_build(s);
    stage_split(s, 5);
    colours(s);
    stage_solve(s);
    return s;
}

START_TEST(test_export_format)
{
    ck_assert_int_eq(export_format("a.ply"), EXPORT_PLY);
    ck_assert_int_eq(export_format("d.x/a.GLTF"), EXPORT_GLTF);
    ck_assert_int_eq(export_format("a.b.glb"), EXPORT_GLB);
    ck_assert_int_eq(export_format("a.Obj"), EXPORT_OBJ);
    ck_assert_int_eq(export_format("a.stl"), EXPORT_UNKNOWN);
    ck_assert_int_eq(export_format("dir.ply/a"), EXPORT_UNKNOWN);
    ck_assert_int_eq(export_format("ply"), EXPORT_UNKNOWN);
    ck_assert_int_eq(export_format(""), EXPORT_UNKNOWN);
}
END_TEST

/* Every edge inside a face is shared by two polygons, point for point: no T-junction. */
START_TEST(test_leaf_mesh)
{
    struct stage *s = coloured_stage();
    struct leaf_mesh m;
    ck_assert_int_eq(leaf_mesh_build(&m, &s->solution, &s->values), 0);
    for (int triangles = 0; triangles < 2; triangles++) {
        uint32_t border = 0, pairs = 0;
        for (uint32_t i = 0; i < m.polygons; i++)
            for (uint32_t j = m.start[i]; j < m.start[i + 1]; j++) {
                uint32_t a = m.corner[j], b = m.corner[j + 1 < m.start[i + 1] ? j + 1 : m.start[i]],
                         found = 0;
                for (uint32_t p = 0; p < m.polygons; p++)
                    for (uint32_t q = m.start[p]; q < m.start[p + 1]; q++)
                        found += m.corner[q] == b
                                 && m.corner[q + 1 < m.start[p + 1] ? q + 1 : m.start[p]] == a;
                ck_assert_uint_le(found, 1);
                pairs += found;
                /* Alone: then it lies on the border of its face. */
                const double *u = s->values.vertices[a].position,
                             *v = s->values.vertices[b].position;
                if (!found) {
                    int on_border = 0;
                    for (uint32_t f = 0; f < 3; f++)
                        for (uint32_t k = 0; k < s->faces[f].vertices; k++) {
                            double e[3], x[3], y[3], cx[3], cy[3];
                            sub3(e, s->faces[f].vertex[(k + 1) % s->faces[f].vertices],
                                 s->faces[f].vertex[k]);
                            sub3(x, u, s->faces[f].vertex[k]);
                            sub3(y, v, s->faces[f].vertex[k]);
                            cross3(cx, e, x);
                            cross3(cy, e, y);
                            on_border |= length3(cx) < 1e-12 && length3(cy) < 1e-12;
                        }
                    ck_assert(on_border);
                    border++;
                }
            }
        ck_assert_uint_gt(pairs, 100);
        ck_assert_uint_gt(border, 10);
        if (!triangles)
            ck_assert_int_eq(leaf_mesh_triangulate(&m, &s->values), 0);
    }
    leaf_mesh_free(&m);
    stage_free(s);
}
END_TEST

/* A square beside a strip of many quads, which hang on most of its edge and share no corner
 * with it: all are in its polygon, in order, at no more cost than finding them. */
START_TEST(test_many_passing)
{
    enum { STRIP = 16000 };
    struct stage *s = stage_new(1);
    struct RadFace *faces = calloc(STRIP + 1, sizeof *faces);
    memcpy(faces[0].vertex, SQUARE, sizeof SQUARE);
    for (uint32_t i = 0; i < STRIP; i++) {
        const double x[2] = {.1 + .7 * i / STRIP, .1 + .7 * (i + 1) / STRIP};
        const double v[4][3] = {{x[0], -.01, 0}, {x[1], -.01, 0}, {x[1], 0, 0}, {x[0], 0, 0}};
        memcpy(faces[i + 1].vertex, v, sizeof v);
    }
    for (uint32_t i = 0; i <= STRIP; i++) {
        faces[i].vertices = 4;
        faces[i].input = i;
    }
    s->solution.surfaces.faces = faces;
    s->solution.surfaces.face_count = STRIP + 1;
    ck_assert_int_eq(hierarchy_build(&s->h, (const struct face *)(const void *)faces, STRIP + 1),
                     0);
    ck_assert_uint_lt(s->h.count, ELEMENTS_MAX);
    const clock_t began = clock();
    stage_solve(s);
    const clock_t found = clock();
    struct leaf_mesh m;
    ck_assert_int_eq(leaf_mesh_build(&m, &s->solution, &s->values), 0);
    ck_assert_double_le((double)(clock() - found), 3 * (double)(found - began));
    uint32_t large = 0;
    while (large < m.polygons && m.start[large + 1] - m.start[large] == 4)
        large++;
    ck_assert_uint_lt(large, m.polygons);
    ck_assert_uint_eq(m.start[large + 1] - m.start[large], STRIP + 5);
    for (uint32_t i = m.start[large] + 1; i < m.start[large] + STRIP + 3; i++) {
        const double *a = s->values.vertices[m.corner[i - 1]].position,
                     *b = s->values.vertices[m.corner[i]].position;
        ck_assert(a[1] == 0 && b[1] == 0 && a[0] < b[0]);
    }
    leaf_mesh_free(&m);
    stage_free(s);
    free(faces);
}
END_TEST

/* A written file through Assimp, with the area of all; place: of its node. */
static const struct aiScene *read_back(const char *path, struct aiMatrix4x4 *place)
{
    const struct aiScene *scene = aiImportFile(path, 0);
    ck_assert_msg(scene != NULL, "%s: %s", path, aiGetErrorString());
    double area = 0;
    ck_assert_uint_ge(scene->mNumMeshes, 1);
    *place = scene->mRootNode->mTransformation;
    if (!scene->mRootNode->mNumMeshes)
        aiMultiplyMatrix4(place, &scene->mRootNode->mChildren[0]->mTransformation);
    for (uint32_t n = 0; n < scene->mNumMeshes; n++) { /* one per material */
        const struct aiMesh *m = scene->mMeshes[n];
        for (uint32_t i = 0; i < m->mNumFaces; i++) {
            double v[64][3], a[3], b[3], c[3], sum[3] = {0, 0, 0};
            ck_assert_uint_le(m->mFaces[i].mNumIndices, 64);
            for (uint32_t j = 0; j < m->mFaces[i].mNumIndices; j++) {
                const struct aiVector3D *p = &m->mVertices[m->mFaces[i].mIndices[j]];
                v[j][0] = (double)p->x;
                v[j][1] = (double)p->y;
                v[j][2] = (double)p->z;
            }
            for (uint32_t j = 2; j < m->mFaces[i].mNumIndices; j++) {
                sub3(a, v[j - 1], v[0]);
                sub3(b, v[j], v[0]);
                cross3(c, a, b);
                for (int k = 0; k < 3; k++)
                    sum[k] += 0.5 * c[k];
            }
            area += length3(sum);
        }
    }
    /* two unit squares, half of |(2 0 0) x (0 1 1)| */
    ck_assert_double_eq_tol(area, 2 + sqrt(2), 1e-5);
    return scene;
}

/* Each vertex's colour says its face's. */
static void check_read_back(const char *path, int y_up)
{
    struct aiMatrix4x4 t;
    const struct aiScene *scene = read_back(path, &t);
    double highest = -INFINITY;
    uint32_t coloured = 0;
    for (uint32_t n = 0; n < scene->mNumMeshes; n++) {
        const struct aiMesh *m = scene->mMeshes[n];
        ck_assert_ptr_nonnull(m->mColors[0]);
        for (uint32_t i = 0; i < m->mNumVertices; i++) {
            const struct aiColor4D *c = &m->mColors[0][i];
            struct aiVector3D p = m->mVertices[i];
            double x = (double)p.x, y = (double)p.y, z = (double)p.z;
            int k = z > 1.5 ? 2 : y > 1e-6 ? 0 : y < -1e-6 ? 1 : -1;
            double channel[3] = {(double)c->r, (double)c->g, (double)c->b};
            for (int o = 0; o < 3 && k >= 0; o++)
                ck_assert_msg(o == k || channel[k] > channel[o] + 0.2,
                              "%s: vertex %g %g %g is %g %g %g", path, x, y, z, channel[0],
                              channel[1], channel[2]);
            coloured += k >= 0;
            aiTransformVecByMatrix4(&p, &t);
            highest = fmax(highest, (double)(y_up ? p.y : p.z));
        }
    }
    ck_assert_uint_gt(coloured, 50);
    ck_assert_double_eq_tol(highest, 3, 1e-6);
    aiReleaseImport(scene);
}

START_TEST(test_exports)
{
    static const char *const names[] = {"o.ply", "o.gltf", "o.glb", "o.obj"};
    struct stage *s = coloured_stage();
    for (int i = 0; i < 4; i++) {
        ck_assert_int_eq(export_write(in_folder(names[i]), &s->solution, &s->values, NULL), 0);
        check_read_back(in_folder(names[i]), i == 1 || i == 2);
    }
    ck_assert_int_eq(export_write(in_folder("o.stl"), &s->solution, &s->values, NULL), -1);
    ck_assert_int_eq(export_write(in_folder("no/o.gltf"), &s->solution, &s->values, NULL), -1);
    ck_assert_int_eq(export_write(in_folder("no/o.ply"), &s->solution, &s->values, NULL), -1);
    stage_free(s);
}
END_TEST

/* In coordinates of a map a float is off by a quarter of a metre: PLY takes doubles, glTF moves the
 * mesh as a whole. */
START_TEST(test_exports_far_away)
{
    static const double moved[3] = {500000, 5400000, 12};
    double middle[3];
    struct stage *s = coloured_stage();
    ck_assert_double_eq(far_away(&s->values, middle), 0);
    for (uint32_t i = 0; i < s->values.count; i++)
        for (int k = 0; k < 3; k++)
            s->values.vertices[i].position[k] += moved[k];
    ck_assert_double_eq(far_away(&s->values, middle), 0.25);

    const double *p = s->values.vertices[0].position;
    ck_assert_int_eq(export_write(in_folder("far.ply"), &s->solution, &s->values, NULL), 0);
    FILE *f = fopen(in_folder("far.ply"), "rb");
    char line[256];
    int doubles = 0;
    while (fgets(line, sizeof line, f) && strcmp(line, "end_header\n") != 0)
        doubles += strstr(line, "property double ") == line;
    ck_assert_int_eq(doubles, 3);
    double read[3];
    ck_assert_uint_eq(fread(read, sizeof *read, 3, f), 3);
    fclose(f);
    ck_assert_mem_eq(read, p, sizeof read);

    ck_assert_int_eq(export_write(in_folder("far.glb"), &s->solution, &s->values, NULL), 0);
    struct aiMatrix4x4 t;
    const struct aiScene *scene = read_back(in_folder("far.glb"), &t);
    ck_assert_double_eq_tol((double)t.a4, middle[0], 0.25);
    ck_assert_double_eq_tol(fmax(fabs((double)t.b4), fabs((double)t.c4)), middle[1], 0.25);
    aiReleaseImport(scene);
    stage_free(s);
}
END_TEST

/* The bytes of a PLY: header as documented, then radiosity in W/m2 behind each vertex. */
START_TEST(test_ply_bytes)
{
    struct stage *s = stage_new(1);
    stage_face(s, 0, 4, SQUARE);
    stage_build(s);
    s->b[s->h.face_element[0]] = 12.5;
    stage_solve(s);
    ck_assert_int_eq(export_write(in_folder("b.ply"), &s->solution, &s->values, NULL), 0);
    FILE *f = fopen(in_folder("b.ply"), "rb");
    unsigned char bytes[2048];
    size_t size = fread(bytes, 1, sizeof bytes - 1, f);
    fclose(f);
    bytes[size] = 0;
    const char *end = strstr((const char *)bytes, "end_header\n");
    ck_assert_ptr_nonnull(end);
    ck_assert_ptr_nonnull(strstr((const char *)bytes, "element vertex 4\n"));
    ck_assert_ptr_nonnull(
        strstr((const char *)bytes, "property float radiosity_0\nelement face 1\n"));
    const unsigned char *body = (const unsigned char *)end + strlen("end_header\n");
    ck_assert_uint_eq((size_t)(bytes + size - body), 4 * 19 + 5 * 4);
    static const unsigned char twelve_and_a_half[4] = {0, 0, 0x48, 0x41};
    for (int i = 0; i < 4; i++)
        ck_assert_mem_eq(body + 19 * i + 15, twelve_and_a_half, 4);
    static const unsigned char four[4] = {4, 0, 0, 0};
    ck_assert_mem_eq(body + 4 * 19, four, 4);
    stage_free(s);
}
END_TEST

int main(void)
{
    if (folder_make("picture") < 0)
        return EXIT_FAILURE;
    Suite *suite = suite_create("picture");
    TCase *t = tcase_create("picture");
    tcase_set_timeout(t, 60);
    tcase_add_test(t, test_no_seams);
    tcase_add_test(t, test_own_values);
    tcase_add_test(t, test_across_faces);
    tcase_add_test(t, test_across_an_edge);
    tcase_add_test(t, test_shape_functions);
    tcase_add_test(t, test_linear_leaves);
    tcase_add_test(t, test_view_parse);
    tcase_add_test(t, test_frame_straight_down);
    tcase_add_test(t, test_not_mirrored);
    tcase_add_test(t, test_picture_threads);
    tcase_add_test(t, test_mesh_lines);
    tcase_add_loop_test(t, test_watertight, 0, sizeof shipped / sizeof *shipped);
    tcase_add_test(t, test_raster_depth);
    tcase_add_test(t, test_exposure);
    tcase_add_test(t, test_bad_sizes);
    tcase_add_test(t, test_export_format);
    tcase_add_test(t, test_leaf_mesh);
    tcase_add_test(t, test_many_passing);
    tcase_add_test(t, test_exports);
    tcase_add_test(t, test_exports_far_away);
    tcase_add_test(t, test_ply_bytes);
    suite_add_tcase(suite, t);
    int failed = suite_failures(suite);
    folder_remove();
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
