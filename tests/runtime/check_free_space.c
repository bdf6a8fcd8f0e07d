/* check_free_space.c - what passes without a ray is passed by no face, and in an empty convex room
 * that is all; and walls that have all before them are known.
 * Once is enough: it is about numbers; that memory is used well, shorter suites tell.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include "engine/exchange_tree.h"
#include "kernel/hash.h"
#include "scene/make_scene.h"
#include "suite.h"
#include "visibility/rays.h"

enum { SCENES = 12, SEGMENTS = 20000, BOXES = 3 };

static double chance(uint64_t *seed)
{
    return hash_unit(++*seed * HASH_STEP);
}

/* A box at `low`, seen from outside. */
static void add_box(struct scene *s, const double low[3], const double size[3])
{
    const double x = low[0], y = low[1], z = low[2], a = size[0], b = size[1], c = size[2];
    made_quad(s, 0, x, y, z, 0, b, 0, a, 0, 0);
    made_quad(s, 0, x, y, z + c, a, 0, 0, 0, b, 0);
    made_quad(s, 0, x, y, z, a, 0, 0, 0, 0, c);
    made_quad(s, 0, x, y + b, z, 0, 0, c, a, 0, 0);
    made_quad(s, 0, x, y, z, 0, 0, c, 0, b, 0);
    made_quad(s, 0, x + a, y, z, 0, b, 0, 0, 0, c);
}

/* A room of n x n quads a wall, turned in space. */
static void make_room(struct scene *s, int n, int boxes, uint64_t *seed)
{
    const uint32_t material[6] = {0};
    const double side[3] = {4, 5, 3};
    made_open(s);
    made_material(s, 0.5, 1);
    made_room(s, material, side[0] / n, side[1] / n, side[2] / n);
    for (int f = 0; f < 6; f++) { /* the corner's quads, again and again along their walls */
        const struct face first = s->faces[f];
        for (int i = 0; i < n * n; i++) {
            struct face *to = i == 0 ? &s->faces[f] : &s->faces[s->face_count];
            double p[4][3];
            for (int v = 0; v < 4; v++)
                for (int k = 0; k < 3; k++) {
                    double u = first.vertex[1][k] - first.vertex[0][k],
                           w = first.vertex[3][k] - first.vertex[0][k];
                    p[v][k] = first.vertex[v][k] + i % n * u + i / n * w;
                    int far = f == 1 ? k == 2 : f == 3 ? k == 1 : f == 5 ? k == 0 : 0;
                    p[v][k] = far ? side[k] : p[v][k];
                }
            if (i == 0)
                memcpy(to->vertex, p, sizeof p);
            else
                made_face(s, 0, 4, (const double(*)[3])p);
        }
    }
    for (int i = 0; i < boxes; i++) {
        double low[3], size[3];
        for (int k = 0; k < 3; k++) {
            size[k] = side[k] * (0.05 + 0.2 * chance(seed));
            low[k] =
                k == 2 && i == 0 ? 0 : 0.3 * side[k] + 0.4 * (side[k] - size[k]) * chance(seed);
        }
        add_box(s, low, size);
    }
    double turn[3][2];
    for (int a = 0; a < 3; a++) {
        double angle = 6.28 * chance(seed);
        turn[a][0] = cos(angle);
        turn[a][1] = sin(angle);
    }
    for (uint32_t i = 0; i < s->face_count; i++)
        for (int v = 0; v < 4; v++)
            for (int a = 0; a < 3; a++) {
                double *x = &s->faces[i].vertex[v][a], *y = &s->faces[i].vertex[v][(a + 1) % 3];
                double moved = turn[a][0] * *x - turn[a][1] * *y;
                *y = turn[a][1] * *x + turn[a][0] * *y;
                *x = moved;
            }
}

/* Does the segment cross a face away from its rim? In double precision; faces are parallelograms.
 */
static int crosses(const struct face *f, const struct segment *g)
{
    double a[3], b[3], n[3], d[3], o[3], p[3], c[3];
    sub3(a, f->vertex[1], f->vertex[0]);
    sub3(b, f->vertex[3], f->vertex[0]);
    cross3(n, a, b);
    sub3(d, g->to, g->from);
    sub3(o, f->vertex[0], g->from);
    double t = dot3(o, n) / dot3(d, n);
    if (!(t > 0 && t < 1))
        return 0;
    for (int k = 0; k < 3; k++)
        p[k] = t * d[k] - o[k];
    cross3(c, p, b);
    double u = dot3(c, n) / dot3(n, n);
    cross3(c, a, p);
    double v = dot3(c, n) / dot3(n, n);
    return u > 1e-6 && u < 1 - 1e-6 && v > 1e-6 && v < 1 - 1e-6;
}

static void random_end(const struct scene *s, double off, uint64_t *seed, double p[3])
{
    const struct face *f = &s->faces[(uint32_t)(chance(seed) * s->face_count)];
    double a[3], b[3], n[3], u = chance(seed), v = chance(seed);
    sub3(a, f->vertex[1], f->vertex[0]);
    sub3(b, f->vertex[3], f->vertex[0]);
    cross3(n, a, b);
    for (int k = 0; k < 3; k++)
        p[k] = f->vertex[0][k] + u * a[k] + v * b[k] + off * n[k] / length3(n);
}

START_TEST(test_passes)
{
    static const double zero[1024];
    const int boxes = _i % 3 ? 1 + _i % BOXES : 0;
    uint64_t seed = 1 + 1000003 * (uint64_t)_i, spared = 0;
    struct scene s;
    struct hierarchy h;
    const char *cause;
    make_room(&s, 1 + _i % 4, boxes, &seed);
    ck_assert_int_eq(hierarchy_build(&h, s.faces, s.face_count), 0);
    struct rays *rays = rays_open(&h, zero, zero, 1, &cause);
    ck_assert_ptr_nonnull(rays);
    const struct host *host = rays_host(rays);
    for (int i = 0; i < SEGMENTS; i++) {
        struct segment g;
        uint64_t before = rays_count(rays).rays;
        random_end(&s, host->ray_offset, &seed, g.from);
        random_end(&s, host->ray_offset, &seed, g.to);
        uint64_t hit = host->occluded(host, 1, &g);
        if (rays_count(rays).rays != before)
            continue;
        spared++;
        ck_assert_uint_eq(hit, 0);
        for (uint32_t f = 0; f < s.face_count; f++)
            ck_assert_msg(!crosses(&s.faces[f], &g), "room %d: face %u is in the way", _i, f);
    }
    if (boxes == 0)
        ck_assert_uint_eq(rays_count(rays).rays, 0);
    else
        ck_assert_msg(spared > SEGMENTS / 50 && spared < SEGMENTS, "room %d: %d spared", _i,
                      (int)spared);
    rays_close(rays);
    hierarchy_free(&h);
    made_close(&s);
}
END_TEST

/* Two fences that cross: each has a part of the other on either side. */
START_TEST(test_corner)
{
    static const double zero[64];
    struct scene s;
    struct hierarchy h;
    const char *cause;
    made_open(&s);
    made_material(&s, 0.5, 1);
    made_quad(&s, 0, 0, 0, 0, 4, 0, 0, 0, 0, 1);  /* a fence along x = 0 .. 4 */
    made_quad(&s, 0, 2, -2, 0, 0, 4, 0, 0, 0, 1); /* and one across */
    ck_assert_int_eq(hierarchy_build(&h, s.faces, s.face_count), 0);
    struct rays *rays = rays_open(&h, zero, zero, 1, &cause);
    ck_assert_ptr_nonnull(rays);
    const struct host *host = rays_host(rays);
    const struct segment blocked = {{1, 1, 0.5}, {1, -1, 0.5}}, above = {{1, 1, 2}, {3, -1, 2}};
    ck_assert_uint_eq(host->occluded(host, 1, &blocked), 1);
    ck_assert_uint_eq(rays_count(rays).rays, 1);
    ck_assert_uint_eq(host->occluded(host, 1, &above), 0);
    ck_assert_uint_eq(rays_count(rays).rays, 1);
    /* one in the way, and all of its call are cast */
    const struct segment both[2] = {above, blocked};
    ck_assert_uint_eq(host->occluded(host, 2, both), 2);
    ck_assert_uint_eq(rays_count(rays).rays, 3);
    rays_close(rays);
    hierarchy_free(&h);
    made_close(&s);
}
END_TEST

/* How far all corners of a scene are in front of an element's plane, at the least (m). */
static double least_before(const struct scene *s, const struct element *e)
{
    double least = INFINITY;
    for (uint32_t i = 0; i < s->face_count; i++)
        for (uint32_t v = 0; v < s->faces[i].vertices; v++)
            least = fmin(least, height3(s->faces[i].vertex[v], e->vertex[0], e->normal));
    return least;
}

/* The walls of a room have all before them, and nothing else does; the floor has, too, but that a
 * box lies flat on it. In an empty room that is all of the tree. */
START_TEST(test_outer_walls)
{
    const int boxes = _i % 3 ? 1 + _i % BOXES : 0;
    uint64_t seed = 1 + 1000003 * (uint64_t)_i;
    struct scene s;
    struct exchange_tree t;
    const char *cause;
    uint32_t outer = 0, walls = 0;
    make_room(&s, 1 + _i % 4, boxes, &seed);
    ck_assert_int_eq(exchange_tree_open(&t, s.faces, s.face_count, 1, &cause), 0);
    for (uint32_t i = 0; i < t.h.built; i++) {
        const struct element *e = &t.h.elements[i];
        uint32_t above = i;
        while (above && !t.h.solid[above = t.h.elements[above].parent])
            ;
        if (!t.h.solid[i] || above) /* part of one */
            continue;
        const int before = least_before(&s, e) > -t.host.ray_offset / 4;
        ck_assert_msg(before || !t.h.outer[i], "room %d: element %u", _i, i);
        walls += (uint32_t)before;
        outer += t.h.outer[i];
    }
    ck_assert_uint_gt(walls, 0);
    ck_assert_int_eq(t.h.outer[0], boxes == 0);
    ck_assert_msg(boxes ? outer < walls && outer >= walls / 6 * 5 : outer == walls,
                  "room %d: %u of %u", _i, outer, walls);
    exchange_tree_close(&t);
    made_close(&s);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("free space");
    TCase *cases = tcase_create("free space");
    tcase_set_timeout(cases, 120);
    tcase_add_loop_test(cases, test_passes, 0, SCENES);
    tcase_add_test(cases, test_corner);
    tcase_add_loop_test(cases, test_outer_walls, 0, SCENES);
    suite_add_tcase(suite, cases);
    return suite_failures(suite) != 0;
}
