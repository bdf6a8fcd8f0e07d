/* check_cut.c - faces cut where others stand in them: which are, which are not, and what becomes of
 * the parts.
 *
 * Expected cuts come from the drawing of each scene, done by hand; areas from the faces before.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "geometry.h"
#include "scene/make_scene.h"
#include "scene/read_scene.h"
#include "hierarchy/polygon.h"
#include "hierarchy/cut_faces.h"
#include "suite.h"

static void copy(struct scene *to, const struct scene *from)
{
    *to = *from;
    to->faces = malloc(from->face_count * sizeof *to->faces);
    memcpy(to->faces, from->faces, from->face_count * sizeof *to->faces);
}

/* A floor of x by y at height 0, its front up: always face 0. */
static void open_floor(struct scene *s, double x, double y)
{
    ck_assert_int_eq(made_open(s), 0);
    made_material(s, 0.5, 0);
    made_quad(s, 0, 0, 0, 0, x, 0, 0, 0, y, 0);
}

static void add_back(struct scene *s)
{
    struct face f = s->faces[s->face_count - 1];
    for (uint32_t i = 0; i < f.vertices; i++)
        memcpy(s->faces[s->face_count].vertex[f.vertices - 1 - i], f.vertex[i], sizeof f.vertex[i]);
    s->faces[s->face_count].vertices = f.vertices;
    s->faces[s->face_count].input = f.input;
    s->faces[s->face_count++].back = 1;
    s->input_count = s->face_count; /* made_face counts by faces: an input without a face is none */
}

static int cut(struct scene *s, int threads)
{
    struct bvh tree;
    if (!s->face_count)
        return scene_cut(s, NULL, threads);
    if (bvh_build(&tree, s->faces, s->face_count, CLUSTERING_SAH, threads) < 0)
        return -1;
    int result = scene_cut(s, &tree, threads);
    bvh_free(&tree);
    return result;
}

static uint32_t parts_of(const struct scene *s, uint32_t input)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < s->face_count; i++)
        n += s->faces[i].input == input && !s->faces[i].back;
    return n;
}

/* What must hold of every scene: areas, orientation, convexity; far sides behind their fronts. */
static void check_parts(const struct scene *was, const struct scene *is)
{
    double *signed_area = calloc(was->input_count, 2 * sizeof *signed_area);
    uint32_t parts = 0;
    ck_assert_uint_eq(was->input_count, is->input_count);
    for (uint32_t i = 0; i < was->face_count; i++) {
        struct face f = was->faces[i];
        double n[3];
        signed_area[2 * f.input + f.back] += polygon_normal(f.vertex, f.vertices, n);
    }
    uint32_t j;
    for (uint32_t i = 0; i < is->face_count; i++) {
        struct face f = is->faces[i];
        double n[3], area = polygon_normal(f.vertex, f.vertices, n);
        ck_assert(f.vertices == 3 || f.vertices == 4);
        ck_assert(!polygon_degenerate(f.vertex, f.vertices, is->precision));
        if (f.vertices == 4)
            ck_assert(polygon_convex_quad(f.vertex)
                      && polygon_flat(f.vertex, 4, 1e-4 * polygon_size(f.vertex, 4)));
        signed_area[2 * f.input + f.back] -= area;
        if (f.back) {
            ck_assert(i > 0 && !f.black == !is->faces[i - 1].black
                      && f.input == is->faces[i - 1].input && !is->faces[i - 1].back);
            for (j = 0; j < f.vertices; j++)
                for (int k = 0; k < 3; k++)
                    ck_assert_double_eq(f.vertex[j][k],
                                        is->faces[i - 1].vertex[f.vertices - 1 - j][k]);
        }
        /* Some face of this input and side faces the same way. */
        for (j = 0; j < was->face_count; j++) {
            struct face g = was->faces[j];
            double m[3];
            polygon_normal(g.vertex, g.vertices, m);
            if (g.input == f.input && g.back == f.back && g.material == f.material
                && dot3(m, n) > 1 - 1e-6)
                break;
        }
        ck_assert_uint_lt(j, was->face_count);
        parts += !f.back && parts_of(is, f.input) > parts_of(was, f.input);
    }
    for (uint32_t i = 0; i < 2 * was->input_count; i++)
        ck_assert_double_eq_tol(signed_area[i], 0, 1e-9);
    ck_assert_uint_eq(is->parts, parts);
    free(signed_area);
}

/* Cut, check, and say into how many the floor went. */
static uint32_t cut_floor(struct scene *s)
{
    struct scene was;
    copy(&was, s);
    ck_assert_int_eq(cut(s, 1), 0);
    check_parts(&was, s);
    uint32_t parts = parts_of(s, 0);
    free(was.faces);
    return parts;
}

/* ---- the clipper that all of this and the kernel use */

static double area_2d(const double *p, int n)
{
    double twice = 0;
    for (int i = 0; i < n; i++) {
        const double *a = &p[2 * i], *b = &p[2 * ((i + 1) % n)];
        twice += a[0] * b[1] - a[1] * b[0];
    }
    return twice / 2;
}

/* Both sides of a polygon make it up, whatever line divides it; each side alone is the same;
 * corners on the line are in both, once. */
START_TEST(test_divide)
{
    enum { MOST = 16 };
    unsigned seed = 3;
    for (int round = 0; round < 2000; round++) {
        double v[2 * MOST], h[MOST], above[2 * MOST], below[2 * MOST], alone[2 * MOST], r[3];
        int n = 3 + round % 8, n_alone = -1, over = 0, on = 0;
        for (int k = 0; k < 3; k++) {
            seed = seed * 1664525u + 1013904223u;
            r[k] = (seed >> 8) * (2.0 / (1 << 24)) - 1;
        }
        for (int i = 0; i < n; i++) {
            v[2 * i] = cos(6.283185307179586 * i / n + r[0]);
            v[2 * i + 1] = sin(6.283185307179586 * i / n + r[0]);
        }
        for (int i = 0; i < n; i++) {
            h[i] = round % 3
                       ? r[1] * v[2 * i] + v[2 * i + 1] - r[2]
                       : r[1] * (v[2 * i] - v[0]) + (v[2 * i + 1] - v[1]); /* through a corner */
            over += h[i] > 0;
            on += !(h[i] < 0 || h[i] > 0);
        }
        int n_below;
        int n_above = polygon_divide(v, n, 2, h, MOST, above, below, &n_below);
        double sum = (n_above > 2 ? area_2d(above, n_above) : 0)
                     + (n_below > 2 ? area_2d(below, n_below) : 0);
        ck_assert_double_eq_tol(sum, area_2d(v, n), 1e-12);
        ck_assert_int_eq(on, round % 3 == 0);
        ck_assert_int_eq(n_above + n_below, over == 0 || over + on == n ? n + on : n + 4 - on);
        ck_assert_int_eq(polygon_divide(v, n, 2, h, MOST, alone, NULL, NULL), n_above);
        ck_assert_int_eq(memcmp(alone, above, (size_t)n_above * 2 * sizeof *above), 0);
        ck_assert_int_eq(polygon_divide(v, n, 2, h, MOST, NULL, alone, &n_alone), 0);
        ck_assert_int_eq(n_alone, n_below);
        ck_assert_int_eq(memcmp(alone, below, (size_t)n_below * 2 * sizeof *below), 0);
    }
}
END_TEST

/* ---- what cuts */

static uint32_t with_wall(double x, double y, double length, double z, double height)
{
    struct scene s;
    open_floor(&s, 4, 3);
    made_quad(&s, 0, x, y, z, 0, length, 0, 0, 0, height);
    uint32_t parts = cut_floor(&s);
    made_close(&s);
    return parts;
}

START_TEST(test_wall)
{
    ck_assert_uint_eq(with_wall(1.7, 0, 3, 0, 2), 2);
    ck_assert_uint_eq(with_wall(1.7, 0, 3, -1, 2), 2);    /* through the floor */
    ck_assert_uint_eq(with_wall(1.7, -5, 11, 0, 2), 2);   /* longer than the floor */
    ck_assert_uint_eq(with_wall(1.7, 0.7, 1.6, 0, 2), 2); /* over half of it */
    ck_assert_uint_eq(with_wall(1.7, 0.7, 1.4, 0, 2), 1); /* over less than half */
    /* behind the floor, which has no far side */
    ck_assert_uint_eq(with_wall(1.7, 0, 3, -2, 2), 1);
    ck_assert_uint_eq(with_wall(1.7, 0, 3, 0.01, 2), 1); /* above it */
    ck_assert_uint_eq(with_wall(0, 0, 3, 0, 2), 1);      /* at its border */
    ck_assert_uint_eq(with_wall(4, 0, 3, -1, 2), 1);
    ck_assert_uint_eq(with_wall(1e-4, 0, 3, 0, 2), 1); /* as good as at its border */
    ck_assert_uint_eq(with_wall(1.7, 5, 3, 0, 2), 1);  /* elsewhere */
}
END_TEST

START_TEST(test_where)
{
    uint32_t at = 0;
    struct scene s;
    open_floor(&s, 4, 3);
    made_quad(&s, 0, 0.73, 0, 0, 0, 3, 0, 0, 0, 2);
    ck_assert_uint_eq(cut_floor(&s), 2);
    for (uint32_t i = 0; i < 2; i++)
        for (uint32_t j = 0; j < 4; j++)
            at += fabs(s.faces[i].vertex[j][0] - 0.73) < 1e-15;
    ck_assert_uint_eq(at, 4);
    made_close(&s);
}
END_TEST

/* A table's leg, 5 cm thick, in a floor of 4 x 3 m; a chest that covers over half of its width. */
START_TEST(test_furniture)
{
    for (int leg = 0; leg < 2; leg++) {
        double x = 1, y = leg ? 1 : 0.5, a = leg ? 0.05 : 0.7, b = leg ? 0.05 : 2;
        struct scene s;
        open_floor(&s, 4, 3);
        made_quad(&s, 0, x, y, 0, a, 0, 0, 0, 0, 0.7);
        made_quad(&s, 0, x, y + b, 0, 0, 0, 0.7, a, 0, 0);
        made_quad(&s, 0, x, y, 0, 0, 0, 0.7, 0, b, 0);
        made_quad(&s, 0, x + a, y, 0, 0, b, 0, 0, 0, 0.7);
        /* Its long sides cut; then the short ones do, in the strip below it alone. */
        ck_assert_uint_eq(cut_floor(&s), leg ? 1 : 5);
        made_close(&s);
    }
}
END_TEST

/* A wall with a door is made of two pieces; two walls cross; one ends at another and cuts one
 * side of it. */
START_TEST(test_together)
{
    struct scene s;
    open_floor(&s, 4, 3);
    made_quad(&s, 0, 1.7, 0, 0, 0, 1, 0, 0, 0, 2);
    made_quad(&s, 0, 1.7, 2, 0, 0, 1, 0, 0, 0, 2);
    ck_assert_uint_eq(cut_floor(&s), 2);
    made_close(&s);
    open_floor(&s, 4, 3);
    made_quad(&s, 0, 1.7, 0, 0, 0, 3, 0, 0, 0, 2);
    made_quad(&s, 0, 0, 1.1, 0, 4, 0, 0, 0, 0, 2);
    ck_assert_uint_eq(cut_floor(&s), 4);
    ck_assert_uint_eq(parts_of(&s, 1), 2); /* and each other */
    made_close(&s);
    open_floor(&s, 4, 3);
    made_quad(&s, 0, 1.7, 0, 0, 0, 3, 0, 0, 0, 2);
    made_quad(&s, 0, 0, 1.1, 0, 1.7, 0, 0, 0, 0, 2);
    ck_assert_uint_eq(cut_floor(&s), 3);
    made_close(&s);
}
END_TEST

/* What is as good as half, or as long, is so whatever the coordinates are rounded to: the same
 * drawing at many places. */
START_TEST(test_ties)
{
    unsigned seed = 7;
    for (int round = 0; round < 300; round++) {
        double d[3];
        for (int k = 0; k < 3; k++) {
            seed = seed * 1664525u + 1013904223u;
            d[k] = 10 * ((seed >> 8) * (1.0 / (1 << 24)));
        }
        struct scene s;
        ck_assert_int_eq(made_open(&s), 0);
        made_material(&s, 0.5, 0);
        made_quad(&s, 0, d[0], d[1], d[2], 3.3, 0, 0, 0, 3.3, 0);
        /* Two walls over half of the floor each, both as long, across each other. */
        made_quad(&s, 0, d[0] + 1.1, d[1] + 0.825, d[2], 0, 1.65, 0, 0, 0, 2);
        made_quad(&s, 0, d[0] + 0.825, d[1] + 2.2, d[2], 1.65, 0, 0, 0, 0, 2);
        if (round % 2) /* as a reader of floats has them */
            for (uint32_t i = 0; i < s.face_count; i++)
                for (int j = 0; j < 4; j++)
                    for (int k = 0; k < 3; k++)
                        s.faces[i].vertex[j][k] = (double)(float)s.faces[i].vertex[j][k];
        ck_assert_uint_eq(cut_floor(&s), 3);
        double at = s.faces[0].vertex[0][0];
        for (int j = 0; j < 4; j++)
            at = fmax(at, s.faces[0].vertex[j][0]);
        /* first along the wall whose direction comes first */
        ck_assert_double_eq_tol(at - d[0], 3.3, 1e-5);
        made_close(&s);
    }
}
END_TEST

/* Walls in any direction: parts with more than four corners become quads and triangles. */
START_TEST(test_slanted)
{
    unsigned seed = 1;
    for (int round = 0; round < 200; round++) {
        struct scene s, was;
        open_floor(&s, 4, 3);
        for (int i = 0; i < 6; i++) {
            double p[4];
            for (int k = 0; k < 4; k++) {
                seed = seed * 1664525u + 1013904223u;
                p[k] = (seed >> 8) * (1.0 / (1 << 24));
            }
            made_quad(&s, 0, 4 * p[0], 3 * p[1], -0.5, 6 * (p[2] - 0.5), 6 * (p[3] - 0.5), 0.3, 0.1,
                      0, 1);
            if (round % 2)
                add_back(&s);
        }
        copy(&was, &s);
        ck_assert_int_eq(cut(&s, 1), 0);
        check_parts(&was, &s);
        free(was.faces);
        made_close(&s);
    }
}
END_TEST

START_TEST(test_two_sided)
{
    struct scene s;
    ck_assert_int_eq(made_open(&s), 0);
    made_material(&s, 0.5, 0);
    made_quad(&s, 0, 0, 0, 0, 4, 0, 0, 0, 3, 0);
    add_back(&s);
    made_quad(&s, 0, 1, 0, -2, 0, 3, 0, 0, 0, 2); /* below, where the far side looks */
    add_back(&s);
    ck_assert_uint_eq(cut_floor(&s), 2);
    ck_assert_uint_eq(s.face_count, 6);
    ck_assert_uint_eq(s.cut, 1);
    ck_assert_uint_eq(s.parts, 2);
    made_close(&s);
}
END_TEST

/* ---- limits and sizes */

/* A floor with walls along both sides' steps of 1. */
static uint32_t cut_grid(int side)
{
    struct scene s;
    open_floor(&s, side, side);
    for (int i = 1; i < side; i++) {
        made_quad(&s, 0, i, 0, 0, 0, side, 0, 0, 0, 1);
        made_quad(&s, 0, 0, i, 0, side, 0, 0, 0, 0, 1);
    }
    uint32_t parts = cut_floor(&s);
    made_close(&s);
    return parts;
}

START_TEST(test_limit)
{
    ck_assert_uint_eq(cut_grid(32), 1024);
    ck_assert_uint_eq(cut_grid(65), 4096);
}
END_TEST

START_TEST(test_scale)
{
    static const char *const scenes[] = {"room", "maze_8", "td"};
    static const int powers[] = {-20, -3, 7, 30};
    struct scene_options how = {.quiet = 1};
    char path[64];
    snprintf(path, sizeof path, "examples/scenes/%s.obj", scenes[_i]);
    struct scene s;
    ck_assert_int_eq(scene_read(&s, path, &how), 0);
    for (size_t p = 0; p < 4; p++) {
        struct scene a, b;
        copy(&a, &s);
        copy(&b, &s);
        /* Cut anew what the limit left, and whatever a wall turned by a little meets. */
        for (size_t i = 0; i < s.face_count; i += 3)
            for (uint32_t j = 0; j < s.faces[i].vertices && !s.faces[i].back
                                 && !s.faces[i + 1 < s.face_count ? i + 1 : i].back;
                 j++)
                for (int k = 0; k < 3; k++)
                    a.faces[i].vertex[j][k] = b.faces[i].vertex[j][k] =
                        s.faces[i].vertex[j][k] * 1.25 + 0.01;
        made_scale(&b, ldexp(1, powers[p]));
        ck_assert_int_eq(cut(&a, 1), 0);
        ck_assert_int_eq(cut(&b, 1), 0);
        ck_assert_uint_gt(a.face_count, s.face_count);
        ck_assert_uint_eq(a.face_count, b.face_count);
        made_scale(&a, ldexp(1, powers[p]));
        for (size_t i = 0; i < a.face_count; i++) {
            ck_assert_uint_eq(a.faces[i].vertices, b.faces[i].vertices);
            ck_assert_uint_eq(a.faces[i].input, b.faces[i].input);
            for (uint32_t j = 0; j < a.faces[i].vertices; j++)
                for (int k = 0; k < 3; k++)
                    ck_assert_double_eq(a.faces[i].vertex[j][k], b.faces[i].vertex[j][k]);
        }
        free(a.faces);
        free(b.faces);
    }
    scene_free(&s);
}
END_TEST

/* A longer wall beyond the floor, nearly in line with the one that stands in it, decides nothing:
 * the cut is where the wall stands, whatever else the clusters around it hold. And a scene large
 * enough for many threads is cut as each of its floors is. */
START_TEST(test_far)
{
    struct scene s;
    for (uint32_t n = 1; n <= 900; n += 899) {
        ck_assert_int_eq(made_open(&s), 0);
        made_material(&s, 0.5, 0);
        for (uint32_t copies = 0; copies < n; copies++) {
            double z = 5.0 * copies;
            made_quad(&s, 0, 0, 0, z, 4, 0, 0, 0, 3, 0);
            made_quad(&s, 0, 1.7, 0, z, 0, 3, 0, 0, 0, 2);
            made_quad(&s, 0, 1.7002, 4, z, 0, 30, 0, 0, 0, 2);
        }
        ck_assert_int_eq(cut(&s, 1), 0);
        ck_assert_uint_eq(s.face_count, 4 * n);
        ck_assert_uint_eq(s.cut, n);
        ck_assert_uint_eq(s.parts, 2 * n);
        for (uint32_t i = 0; i < s.face_count; i++) {
            int at_wall = 0;
            ck_assert_uint_eq(s.faces[i].input, 3 * (i / 4) + (i % 4 > 1 ? i % 4 - 1 : 0));
            for (uint32_t j = 0; j < 4; j++)
                at_wall += fabs(s.faces[i].vertex[j][0] - 1.7) < 1e-12;
            ck_assert_int_eq(at_wall, i % 4 < 2 ? 2 : i % 4 == 2 ? 4 : 0);
        }
        made_close(&s);
    }
}
END_TEST

START_TEST(test_unchanged)
{
    const uint32_t grey[6] = {0};
    struct scene s, was;
    ck_assert_int_eq(made_open(&s), 0);
    ck_assert_int_eq(cut(&s, 1), 0); /* no faces at all */
    made_material(&s, 0.5, 0);
    made_room(&s, grey, 4, 5, 3);
    struct face *faces = s.faces;
    copy(&was, &s);
    ck_assert_int_eq(cut(&s, 1), 0);
    ck_assert_ptr_eq(s.faces, faces);
    ck_assert_uint_eq(s.face_count, 6);
    ck_assert_int_eq(memcmp(s.faces, was.faces, 6 * sizeof *faces), 0);
    ck_assert_uint_eq(s.cut, 0);
    free(was.faces);
    made_close(&s);
}
END_TEST

/* No area, no length, the same face twice: nothing to cut and nothing to fall over. */
START_TEST(test_degenerate)
{
    const double line[3][3] = {{0, 1, 0}, {4, 1, 0}, {2, 1, 0}},
                 point[3][3] = {{1, 1, 0}, {1, 1, 0}, {1, 1, 0}};
    struct scene s;
    open_floor(&s, 4, 3);
    made_face(&s, 0, 3, line);
    made_face(&s, 0, 3, point);
    made_quad(&s, 0, 0, 0, 0, 4, 0, 0, 0, 3, 0);
    made_quad(&s, 0, 1, 1, 0, 1, 0, 0, 0, 1, 0);
    ck_assert_int_eq(cut(&s, 1), 0);
    ck_assert_uint_eq(s.cut, 0);
    ck_assert_uint_eq(s.face_count, 5);
    made_close(&s);
}
END_TEST

/* ---- scenes of files */

/* The faces of a file are cut when it is read, their inputs' areas are those of the file, and
 * solvers see all of it. */
START_TEST(test_files)
{
    static const struct {
        const char *name;
        uint32_t cut, parts;
    } known[] = {
        {"furnace", 0, 0}, {"furnace_4", 0, 0}, {"cornell", 0, 0},
        {"room", 9, 44},   {"maze_8", 2, 143},
    };
    struct scene_options how = {.quiet = 1};
    char path[64];
    snprintf(path, sizeof path, "examples/scenes/%s.obj", known[_i].name);
    struct scene s;
    ck_assert_int_eq(scene_read(&s, path, &how), 0);
    ck_assert_uint_eq(s.cut, known[_i].cut);
    ck_assert_uint_eq(s.parts, known[_i].parts);
    double *area;
    area = calloc(s.input_count, sizeof *area);
    for (uint32_t i = 0; i < s.face_count; i++) {
        double n[3];
        if (!s.faces[i].back)
            area[s.faces[i].input] += polygon_normal(s.faces[i].vertex, s.faces[i].vertices, n);
    }
    for (uint32_t i = 0; i < s.input_count; i++)
        ck_assert_double_eq_tol(area[i], s.areas[i], 1e-9 * s.areas[i]);
    free(area);
    scene_free(&s);
}
END_TEST

/* 90,000 faces of a bumpy field, which touch at their borders alone, and a wall through them: were
 * every pair looked at, the suite's time limit would end it. */
START_TEST(test_many)
{
    enum { N = 300 };
    struct scene s = {.bands = 1};
    s.faces = calloc((size_t)N * N + 1, sizeof *s.faces);
    for (uint32_t i = 0; i < N; i++)
        for (uint32_t j = 0; j < N; j++) {
            struct face *f = &s.faces[s.face_count];
            const double p[4][3] = {{i, j, sin(i)},
                                    {i + 1, j, sin(i + 1)},
                                    {i + 1, j + 1, sin(i + 1)},
                                    {i, j + 1, sin(i)}};
            memcpy(f->vertex, p, sizeof p);
            f->vertices = 4;
            f->input = s.face_count++;
        }
    s.faces[s.face_count] =
        (struct face){.vertex = {{0, 10.3, -3}, {N, 10.3, -3}, {N, 10.3, 3}, {0, 10.3, 3}},
                      .vertices = 4,
                      .input = s.face_count};
    s.face_count++;
    clock_t start = clock();
    ck_assert_int_eq(cut(&s, 1), 0);
    double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
    printf("%u faces cut in %.2f s\n", s.face_count, seconds);
    /* each field under the wall; its own contacts are short and on no one line */
    ck_assert_uint_eq(s.cut, N);
    ck_assert_uint_eq(s.parts, 2 * N);
    free(s.faces);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("cut");
    TCase *c = tcase_create("cut");
    tcase_add_test(c, test_divide);
    tcase_add_test(c, test_wall);
    tcase_add_test(c, test_where);
    tcase_add_test(c, test_furniture);
    tcase_add_test(c, test_together);
    tcase_add_test(c, test_ties);
    tcase_add_test(c, test_slanted);
    tcase_add_test(c, test_two_sided);
    tcase_add_test(c, test_limit);
    tcase_add_loop_test(c, test_scale, 0, 3);
    tcase_add_test(c, test_far);
    tcase_add_test(c, test_unchanged);
    tcase_add_test(c, test_degenerate);
    tcase_add_loop_test(c, test_files, 0, 5);
    tcase_add_test(c, test_many);
    tcase_set_timeout(c, 60);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
