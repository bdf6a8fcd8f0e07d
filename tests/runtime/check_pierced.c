/* check_pierced.c - what a segment between a shaft's corners pierces is also met by cutting, at
 * every width of vectors, and most of what is met is pierced.
 *
 * Faces stand anywhere between two elements, or with a corner or an edge on a segment between
 * corners of both, so that rounding decides whether it passes inside; some quads are bent by a
 * little, which only cutting may judge.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <stdio.h>
#include <string.h>
#include "kernel/shaft.h"
#include "runtime/even_numbers.h"
#include "suite.h"

/* A parallelogram or half of one, with a corner there. */
static void make(struct element *e, const double corner[3], int vertices)
{
    double side[2][3], n[3], size;
    memset(e, 0, sizeof *e);
    do {
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < 2; i++)
                side[i][k] = 2 * even() - 1;
        cross3(n, side[0], side[1]);
        size = length3(n);
    } while (!(size > 0.01));
    e->vertices = (uint8_t)vertices;
    for (int k = 0; k < 3; k++) {
        e->normal[k] = n[k] / size;
        e->vertex[0][k] = corner[k];
        e->vertex[1][k] = corner[k] + side[0][k];
        e->vertex[2][k] = corner[k] + side[1][k] + (vertices == 4 ? side[0][k] : 0);
        e->vertex[3][k] = corner[k] + side[1][k];
        for (int i = 0; i < vertices; i++)
            e->centre[k] += e->vertex[i][k] / vertices;
    }
    e->area = vertices == 4 ? size : size / 2;
}

static void move(struct element *e, const double by[3], double times)
{
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 3; k++)
            e->vertex[i][k] += times * by[k];
}

/* A face for the shaft: kind 0: anywhere; 1: a corner on a segment between corners; 2: an edge. */
static void place(struct element *face, const struct shaft *shaft, int kind, int vertices)
{
    double at[3], side[3];
    const int i = (int)(even() * shaft->points[0]), j = (int)(even() * shaft->points[1]);
    const double t = 0.1 + 0.8 * even();
    for (int k = 0; k < 3; k++) {
        const double a = shaft->end[0][i][k], b = shaft->end[1][j][k];
        at[k] = kind ? a + t * (b - a) : shaft->low[k] + even() * (shaft->high[k] - shaft->low[k]);
    }
    make(face, at, vertices);
    sub3(side, face->vertex[1], face->vertex[0]);
    if (kind == 2)
        move(face, side, -even());
}

/* Does one plane have all of a face outside, all planes asked one by one? */
static int plainly_far(const struct shaft *shaft, const double (*v)[3], int n)
{
    int far = 0;
    for (int p = 0; p < shaft->planes; p++) {
        int all = 1;
        for (int i = 0; i < n; i++)
            all &= v[i][0] * shaft->normal[0][p] + v[i][1] * shaft->normal[1][p]
                       + v[i][2] * shaft->normal[2][p]
                   > shaft->offset[p] + 4 * shaft->reach;
        far |= all;
    }
    return far;
}

START_TEST(test_pierced)
{
    int shafts = 0, met = 0, pierced = 0, touching = 0, bent = 0, far = 0, early[3] = {0, 0, 0};
    struct host host;
    memset(&host, 0, sizeof host);
    host.ray_offset = 1e-5;
    for (int i = 0; i < 20000; i++) {
        struct element a, b, face;
        struct shaft shaft;
        double at[2][3], normal[3];
        for (int k = 0; k < 3; k++) {
            at[0][k] = even();
            at[1][k] = even() + (k == 0 ? 2 * even() : 0);
        }
        make(&a, at[0], 3 + i % 2);
        make(&b, at[1], 3 + i / 2 % 2);
        b.id = 1;
        if (!shaft_open(&shaft, &a, &b, &host))
            continue;
        shafts++;
        const int kind = i % 3, n = 3 + i / 4 % 2;
        place(&face, &shaft, kind, n);
        const int bend = n == 4 && i % 7 == 0;
        if (bend) /* less than is taken for two triangles */
            for (int k = 0; k < 3; k++)
                face.vertex[1][k] += 0.5 * shaft.flat * face.normal[k];
        const double(*v)[3] = (const double(*)[3])face.vertex;
        ck_assert(shaft_normal(v, n, normal));
        const int said = shaft_pierced(&shaft, v, n, normal);
        for (int width = 1; width <= lanes_width(); width *= width == 1 ? 4 : 2)
            ck_assert_int_eq(shaft_pierced_at(width, &shaft, v, n, normal),
                             shaft_pierced_at(1, &shaft, v, n, normal));
        ck_assert(!(bend && said));
        bent += bend;
        struct cut large, inside;
        uint64_t planes;
        shaft_enlarge(&large, v, n, normal, shaft.grow);
        const int cut = shaft_cutting(&shaft, &large, &planes)
                        && shaft_inside(&shaft, planes, &large, normal, 0, &inside);
        ck_assert_msg(cut || !said, "face %d is pierced and yet cut away", i);
        /* what is said without planes is what they say; `inside`: nobody asks what is pierced */
        const int soon = shaft_meets_early(&shaft, v, n);
        ck_assert(soon < 0 || soon == shaft_meets(&shaft, v, n, &inside));
        early[soon + 1]++;
        for (int k = 0; k < 3; k++) {
            const double away = even();
            for (int c = 0; c < n; c++)
                face.vertex[c][k] += away;
        }
        ck_assert_int_eq(shaft_far(&shaft, v, n), plainly_far(&shaft, v, n));
        far += shaft_far(&shaft, v, n);
        met += cut && kind == 0;
        pierced += said && kind == 0;
        touching += said && kind > 0;
    }
    printf("%d shafts: of %d faces met %d are pierced, %d touching ones, none of %d bent ones\n",
           shafts, met, pierced, touching, bent);
    printf("%d far ones; without planes %d not known, %d not met, %d met\n", far, early[0],
           early[1], early[2]);
    ck_assert_int_gt(shafts, 5000);
    ck_assert_int_gt(far, shafts / 20);
    ck_assert_int_lt(far, shafts);
    for (int k = 0; k < 3; k++)
        ck_assert_int_gt(early[k], 100);
    ck_assert_int_gt(pierced, met / 2);
    ck_assert_int_gt(touching, 1000);
    ck_assert_int_gt(bent, 500);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("pierced");
    TCase *c = tcase_create("pierced");
    tcase_set_timeout(c, 120);
    tcase_add_test(c, test_pierced);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
