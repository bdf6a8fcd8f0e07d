/* check_contact.c - the share of a surface that a solid stands on, against the part of its outline,
 * that no part which one covers is taken for free of any, and that rays side by side meet the backs
 * that each meets alone.
 * Once is enough: it is about numbers; that memory is used well, shorter suites tell.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include "kernel/hash.h"
#include "scene/make_scene.h"
#include "suite.h"
#include "visibility/contact_fraction.h"
#include "visibility/standing.h"

enum { SCENES = 40, DEPTH = 4, POINTS = 64 };

/* A turn in space, a length and a place. */
struct frame {
    double axis[3][3], unit, origin[3];
};

static double chance(uint64_t *seed)
{
    return hash_unit(++*seed * HASH_STEP);
}

static struct frame any_frame(uint64_t *seed)
{
    struct frame f;
    double z = 2 * chance(seed) - 1, a = 6.28 * chance(seed), side[3] = {0.3, -0.8, 0.52}, length;
    f.axis[2][0] = sqrt(1 - z * z) * cos(a);
    f.axis[2][1] = sqrt(1 - z * z) * sin(a);
    f.axis[2][2] = z;
    cross3(f.axis[0], f.axis[2], side);
    length = length3(f.axis[0]);
    for (int k = 0; k < 3; k++)
        f.axis[0][k] /= length;
    cross3(f.axis[1], f.axis[2], f.axis[0]);
    f.unit = pow(10, 4 * chance(seed) - 2);
    for (int k = 0; k < 3; k++)
        f.origin[k] = f.unit * 5 * chance(seed);
    return f;
}

/* The parallelogram from (x, y, z) of the frame along a and b. */
static void add(struct scene *s, const struct frame *f, const double at[3], const double a[3],
                const double b[3])
{
    double p[4][3];
    for (int v = 0; v < 4; v++)
        for (int k = 0; k < 3; k++) {
            p[v][k] = f->origin[k];
            for (int c = 0; c < 3; c++)
                p[v][k] += f->unit * f->axis[c][k]
                           * (at[c] + (v == 1 || v == 2 ? a[c] : 0) + (v >= 2 ? b[c] : 0));
        }
    made_face(s, 0, 4, (const double(*)[3])p);
}

/* A solid's outline on the floor, in the frame: a parallelogram. */
struct outline {
    double at[3], a[3], b[3];
};

/* A floor of 1 x 1, wall behind it, and a solid on it, which leans, without a bottom, `gap` above.
 */
static struct outline furnish(struct scene *s, const struct frame *f, double gap, uint64_t *seed)
{
    const double zero[3] = {0, 0, 0}, x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, z[3] = {0, 0, 1};
    struct outline o;
    double turn = 6.28 * chance(seed), wide = 0.2 + 0.4 * chance(seed),
           deep = 0.2 + 0.4 * chance(seed);
    const double up[3] = {0.2 * chance(seed), 0.2 * chance(seed), 0.8};
    for (int k = 0; k < 2; k++)
        o.at[k] = 0.1 + 0.6 * chance(seed);
    o.at[2] = gap;
    o.a[0] = wide * cos(turn), o.a[1] = wide * sin(turn), o.a[2] = 0;
    o.b[0] = -deep * sin(turn), o.b[1] = deep * cos(turn), o.b[2] = 0;
    made_open(s);
    made_material(s, 0.5, 1);
    add(s, f, zero, x, y);
    add(s, f, zero, z, x); /* y = 0, looks towards y */
    double top[3], right[3], back[3];
    for (int k = 0; k < 3; k++) {
        top[k] = o.at[k] + up[k];
        right[k] = o.at[k] + o.a[k];
        back[k] = o.at[k] + o.b[k];
    }
    add(s, f, top, o.a, o.b);
    add(s, f, o.at, o.a, up);
    add(s, f, back, up, o.a);
    add(s, f, o.at, up, o.b);
    add(s, f, right, o.b, up);
    return o;
}

/* The share of POINTS^2 even points of the element that lie under the outline. */
static double under(const struct outline *o, const struct frame *f, const struct element *e)
{
    double in = 0;
    const double aa = dot3(o->a, o->a), bb = dot3(o->b, o->b);
    for (int i = 0; i < POINTS; i++)
        for (int j = 0; j < POINTS; j++) {
            double q[3], d[3];
            for (int k = 0; k < 3; k++)
                q[k] = (e->vertex[0][k] + (e->vertex[1][k] - e->vertex[0][k]) * (i + 0.5) / POINTS
                        + (e->vertex[3][k] - e->vertex[0][k]) * (j + 0.5) / POINTS - f->origin[k])
                       / f->unit;
            for (int c = 0; c < 3; c++)
                d[c] = dot3(q, f->axis[c]) - (c < 2 ? o->at[c] : 0);
            double u = (d[0] * o->a[0] + d[1] * o->a[1]) / aa,
                   v = (d[0] * o->b[0] + d[1] * o->b[1]) / bb;
            in += u > 0 && u < 1 && v > 0 && v < 1;
        }
    return in / POINTS / POINTS;
}

static void split_all(struct hierarchy *h)
{
    for (uint32_t i = 0; i < h->count; i++) /* parts follow, and are split in their turn */
        if (h->elements[i].vertices && h->elements[i].face == 0 && h->elements[i].depth < DEPTH)
            ck_assert_int_eq(hierarchy_split(h, i), 0);
}

START_TEST(stands)
{
    uint64_t seed = 1;
    double all = 0, wrong = 0, open = 0, asked = 0, partly = 0;
    for (int n = 0; n < SCENES; n++) {
        struct frame f = any_frame(&seed);
        struct scene scene;
        struct hierarchy h;
        const char *cause;
        const double ones[8] = {1, 1, 1, 1, 1, 1, 1, 1};
        struct outline o = furnish(&scene, &f, n % 2 ? 0.002 : 0, &seed);
        ck_assert_int_eq(hierarchy_build(&h, scene.faces, scene.face_count), 0);
        struct rays *rays = rays_open(&h, ones, ones, 1, &cause);
        ck_assert(rays);
        split_all(&h);
        for (uint32_t i = 0; i < h.count; i++) {
            const struct element *e = &h.elements[i];
            if (!e->vertices || e->face != 0)
                continue;
            const double share = under(&o, &f, e), found = contact_fraction(rays, &h, e);
            const int may = standing_may(&h, e, rays_host(rays)->ray_offset);
            /* what an outline's border crosses is asked point by point */
            ck_assert(may || share == 0 || share == 1);
            asked++;
            open += !may;
            partly += share > 0 && share < 1;
            if (e->depth < DEPTH)
                continue;
            /* cells of 1/64: at a border those of one row may be told otherwise */
            all += share;
            wrong += fabs(found - share);
        }
        rays_close(rays);
        hierarchy_free(&h);
        made_close(&scene);
    }
    printf("%.0f parts: %.0f are partly covered, %.0f are proved not to be; area off by %.1f %%\n",
           asked, partly, open, 100 * wrong / all);
    ck_assert_double_lt(wrong, 0.1 * all);
    /* the solids lean, and so are over some that they do not stand on */
    ck_assert_double_gt(open, 0.8 * (asked - partly));
}
END_TEST

/* Over the floor hang two faces that show their backs to it: one alone, one with a front in the
 * same place, of other corners. Rays that go the same way from sixteen points of the floor. */
START_TEST(side_by_side)
{
    const double zero[3] = {0, 0, 0}, x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, half[3] = {0.5, 0, 0};
    uint64_t seed = 7;
    int fronts = 0, backs = 0;
    for (int n = 0; n < SCENES; n++) {
        const struct frame f = any_frame(&seed);
        const double low[3] = {0, 0, 0.3}, right[3] = {0.5, 0, 0.3}, behind[3] = {-0.1, -0.1, 0.3},
                     wide[3] = {0.8, 0, 0}, deep[3] = {0, 1.3, 0}, ones[4] = {1, 1, 1, 1};
        struct scene scene;
        struct hierarchy h;
        const char *cause;
        made_open(&scene);
        made_material(&scene, 0.5, 1);
        add(&scene, &f, zero, x, y);
        add(&scene, &f, low, half, y);
        add(&scene, &f, right, half, y);
        add(&scene, &f, behind, deep, wide); /* looks down */
        ck_assert_int_eq(hierarchy_build(&h, scene.faces, scene.face_count), 0);
        struct rays *rays = rays_open(&h, ones, ones, 1, &cause);
        ck_assert(rays);
        double from[16][3], way[3];
        for (int k = 0; k < 3; k++)
            way[k] = f.axis[2][k] + (chance(&seed) - 0.5) * f.axis[0][k];
        for (int i = 0; i < 16; i++) {
            const double u = chance(&seed), v = chance(&seed);
            for (int k = 0; k < 3; k++)
                from[i][k] = f.origin[k] + f.unit * (u * f.axis[0][k] + v * f.axis[1][k])
                             + rays_host(rays)->ray_offset * f.axis[2][k];
        }
        const unsigned which = (unsigned)(0xffff * chance(&seed)),
                       met = rays_meet_backs(rays, (const double(*)[3])from, which, way);
        for (int i = 0; i < 16; i++) {
            const enum ray_fate alone = rays_first(rays, from[i], way, NULL, NULL);
            ck_assert_int_eq(met >> i & 1, (which >> i & 1) && alone == RAY_MEETS_BACK);
            fronts += alone == RAY_MEETS_FRONT;
            backs += alone == RAY_MEETS_BACK;
        }
        rays_close(rays);
        hierarchy_free(&h);
        made_close(&scene);
    }
    ck_assert_int_gt(fronts, 100);
    ck_assert_int_gt(backs, 40);
}
END_TEST

int main(void)
{
    Suite *s = suite_create("contact");
    TCase *c = tcase_create("contact");
    tcase_add_test(c, stands);
    tcase_add_test(c, side_by_side);
    suite_add_tcase(s, c);
    return suite_failures(s) != 0;
}
