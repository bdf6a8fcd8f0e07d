/* check_profiles.c - View2D's examples, scenes in the plane, as strips: a face a hundredth long
 * amid others 20 long sees of each what its profile says, but for what leaves past their ends.
 *
 * Of the light of a point that goes one way in the plane and so meets a strip at the distance r,
 * (2 / pi) (atan q + q / (1 + q^2)) with q = 10 / r does so before the strip ends. So what is right
 * is told by a sweep over all ways in the plane from many points of a segment; and that sweep is
 * held against the numbers that are printed with two of the examples, of strips without an end.
 * [Walton, View3D user manual 3.5, and the examples of View2D beside it; FACET, UCID-19887]
 * Once is enough: it is about numbers; that memory is used well, shorter suites tell.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>

#include "runtime/make_polygons.h"
#include "suite.h"
#include "util/array.h"

enum { LINES = 100, CORNERS = 2 * LINES + 8, POINTS_OF_LINE = 300, LONG = 20 };

/* Its front is to the left of the way from a to b. */
struct line {
    double a[2], b[2];
};

static const double TURN = 2 * 3.14159265358979323846;
static struct line lines[LINES];
static int used;

static void add(double x0, double y0, double x1, double y1)
{
    ck_assert_int_lt(used, LINES);
    lines[used++] = (struct line){{x0, y0}, {x1, y1}};
}

/* Each side of a polygon in equal parts. */
static void outline(const double (*at)[2], int corners, int parts)
{
    for (int i = 0; i < corners; i++) {
        const double *p = at[i], *q = at[(i + 1) % corners];
        const double x = (q[0] - p[0]) / parts, y = (q[1] - p[1]) / parts;
        for (int k = 0; k < parts; k++)
            add(p[0] + k * x, p[1] + k * y, p[0] + (k + 1) * x, p[1] + (k + 1) * y);
    }
}

/* ---- in the plane */

/* Where a way from a point meets a line, in parts of both; 0 when they are parallel. Above 0: the
 * line's front. */
static double meet(const double from[2], const double way[2], const struct line *s, double part[2])
{
    const double u[2] = {s->b[0] - s->a[0], s->b[1] - s->a[1]},
                 v[2] = {s->a[0] - from[0], s->a[1] - from[1]},
                 cross = way[0] * u[1] - way[1] * u[0];
    part[0] = (v[0] * u[1] - v[1] * u[0]) / cross;
    part[1] = (v[0] * way[1] - v[1] * way[0]) / cross;
    return cross;
}

/* The line whose front a way meets first, and how far off; -1: none. Two sheets may be at one
 * place. */
static int first_met(const double from[2], const double way[2], int own, double *distance)
{
    int met = -1;
    *distance = INFINITY;
    for (int k = 0; k < used; k++) {
        double part[2], cross;
        if (k == own || !(fabs(cross = meet(from, way, &lines[k], part)) > 0) || part[1] < 0
            || part[1] > 1 || part[0] < 1e-9)
            continue;
        if (part[0] < *distance - 1e-9 || (part[0] < *distance + 1e-9 && cross > 0)) {
            *distance = part[0];
            met = cross > 0 ? k : -1;
        }
    }
    return met;
}

/* All ends of lines, and where lines cross. */
static int find_corners(double (*at)[2])
{
    int n = 0;
    for (int i = 0; i < used; i++) {
        const struct line *s = &lines[i];
        const double way[2] = {s->b[0] - s->a[0], s->b[1] - s->a[1]};
        memcpy(at[n++], s->a, sizeof s->a);
        memcpy(at[n++], s->b, sizeof s->b);
        for (int k = 0; k < i; k++) {
            double part[2];
            if (fabs(meet(s->a, way, &lines[k], part)) > 1e-12 && part[0] > 1e-9
                && part[0] < 1 - 1e-9 && part[1] > 1e-9 && part[1] < 1 - 1e-9) {
                ck_assert_int_lt(n, CORNERS);
                at[n][0] = s->a[0] + part[0] * way[0];
                at[n++][1] = s->a[1] + part[0] * way[1];
            }
        }
    }
    return n;
}

/* Row i of the profile, of strips this far to either side. */
static void sweep(int i, double half, double *row)
{
    static double at[CORNERS][2], edge[CORNERS + 2];
    const struct line *s = &lines[i];
    const double length = hypot(s->b[0] - s->a[0], s->b[1] - s->a[1]),
                 d[2] = {(s->b[0] - s->a[0]) / length, (s->b[1] - s->a[1]) / length};
    const int corners = find_corners(at);
    memset(row, 0, (size_t)used * sizeof *row);
    for (int p = 0; p < POINTS_OF_LINE; p++) {
        const double part = length * (p + .5) / POINTS_OF_LINE,
                     from[2] = {s->a[0] + part * d[0], s->a[1] + part * d[1]};
        int edges = 0;
        edge[edges++] = -1;
        edge[edges++] = 1;
        for (int k = 0; k < corners; k++) {
            const double x = at[k][0] - from[0], y = at[k][1] - from[1];
            if (y * d[0] - x * d[1] > 1e-12)
                edge[edges++] = (x * d[0] + y * d[1]) / hypot(x, y);
        }
        qsort(edge, (size_t)edges, sizeof *edge, compare_numbers);
        for (int k = 0; k + 1 < edges; k++) {
            if (!(edge[k + 1] > edge[k]))
                continue;
            const double t = (edge[k] + edge[k + 1]) / 2, n = sqrt(1 - t * t),
                         way[2] = {t * d[0] - n * d[1], t * d[1] + n * d[0]};
            double r;
            const int met = first_met(from, way, i, &r);
            const double q = half / r,
                         before_end = isinf(half) ? 1 : 4 / TURN * (atan(q) + q / (1 + q * q));
            if (met >= 0)
                row[met] += (edge[k + 1] - edge[k]) / 2 / POINTS_OF_LINE * before_end;
        }
    }
}

/* ---- as strips */

static void strip(const struct line *s, double length)
{
    rectangle((const double[3]){s->a[0], s->a[1], -length / 2}, (const double[3]){0, 0, length},
              (const double[3]){s->b[0] - s->a[0], s->b[1] - s->a[1], 0});
}

/* Rows from, from + step ... of strips, against the sweep. */
static void check_rows(const char *what, int from, int step, double scale, double off)
{
    static double f[FACES], areas[FACES], row[LINES];
    for (int i = from; i < used; i += step) {
        clear();
        strip(&lines[i], .01 * scale);
        for (int k = 0; k < used; k++)
            if (k != i)
                strip(&lines[k], LONG * scale);
        factors(1, 1e-6, f, areas);
        sweep(i, LONG / 2. * scale, row);
        for (int k = 0, face = 1; k < used; k++) {
            const double got = k == i ? 0 : f[face++];
            ck_assert_msg(fabs(got - row[k]) <= off, "%s, %d to %d: %.8f, not %.8f", what, i, k,
                          got, row[k]);
        }
    }
}

/* Of strips without an end, some of what is printed of row i; what is not printed is nothing. */
struct printed {
    int line;
    double factor;
};
static void check_printed(const char *what, int i, const struct printed *printed)
{
    double row[LINES];
    sweep(i, INFINITY, row);
    for (int k = 0; k < used; k++) {
        const double wanted = printed->line == k ? printed++->factor : 0;
        ck_assert_msg(fabs(row[k] - wanted) <= 1e-5, "%s, %d to %d: %.8f, not %.7f", what, i, k,
                      row[k], wanted);
    }
}

static void begin(void)
{
    used = 0;
}

/* test1: a room of 2 x 1. test8 and test10, and 9 and 11, which say the same otherwise: 5 x 3 and 8
 * x 5 in units. */
START_TEST(test_rooms)
{
    begin();
    outline((const double[4][2]){{0, 0}, {2, 0}, {2, 1}, {0, 1}}, 4, 1);
    check_rows("test1", 0, 1, 2, 3e-5);
    static const int sides[2][2] = {{5, 3}, {8, 5}};
    for (int room = 0; room < 2; room++) {
        const int w = sides[room][0], h = sides[room][1];
        begin();
        for (int i = 0; i < w; i++)
            add(i, 0, i + 1, 0);
        for (int i = 0; i < h; i++)
            add(w, i, w, i + 1);
        for (int i = w; i-- > 0;)
            add(i + 1, h, i, h);
        for (int i = h; i-- > 0;)
            add(0, i + 1, 0, i);
        check_rows(room ? "test10" : "test8", 0, 5, w, 3e-5);
    }
}
END_TEST

START_TEST(test_blockers)
{
    begin();
    add(4, 0, 4, 4);
    add(0, 4, 0, 0);
    add(1, 3, 1, 1);
    add(1, 1, 1, 3);
    check_rows("test2", 0, 1, 4, 3e-5);
    begin();
    outline((const double[4][2]){{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 4, 1);
    outline((const double[4][2]){{.25, .25}, {.25, .75}, {.75, .75}, {.75, .25}}, 4, 1);
    check_rows("test3", 0, 1, 1, 3e-5);
    begin();
    outline((const double[4][2]){{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 4, 1);
    add(.25, .75, .25, .25);
    add(.25, .25, .25, .75);
    add(.5, .5, 0, .5);
    add(0, .5, .5, .5);
    check_rows("test4", 0, 1, 1, 3e-5);
}
END_TEST

START_TEST(test_facet)
{
    static const double p[10][2] = {{0, 0},  {0, .5},  {.4, .5}, {0, 1},   {1, 1},
                                    {1, .5}, {.6, .5}, {1, 0},   {.65, 0}, {.35, 0}};
    static const int ends[12][2] = {{2, 1}, {3, 2}, {2, 3}, {4, 2}, {5, 4},  {6, 5},
                                    {7, 6}, {6, 7}, {8, 6}, {9, 8}, {10, 9}, {1, 10}};
    begin();
    for (int i = 0; i < 12; i++) {
        const double *a = p[ends[i][0] - 1], *b = p[ends[i][1] - 1];
        add(a[0], a[1], b[0], b[1]);
    }
    check_rows("facet", 0, 1, 1, 3e-5);
    check_printed("facet", 0,
                  (const struct printed[]){{1, .2596876},
                                           {4, .0071238},
                                           {5, .0521637},
                                           {7, .0629910},
                                           {8, .2360680},
                                           {9, .0520270},
                                           {10, .0902668},
                                           {11, .2396722},
                                           {-1, 0}});
    check_printed("facet", 9,
                  (const struct printed[]){{0, .0743243},
                                           {1, .1085215},
                                           {3, .0101769},
                                           {4, .1100936},
                                           {7, .3544949},
                                           {8, .3423889},
                                           {-1, 0}});
}
END_TEST

/* What stands in the square of test5, whose walls are in ten parts, and of test6. test7 is test5,
 * combined to test6. */
static void obstacles(void)
{
    static const double squares[8][2] = {{3, 1}, {6, 1}, {8, 3}, {8, 6},
                                         {6, 8}, {3, 8}, {1, 6}, {1, 3}},
                        diamonds[4][2] = {{2, 2}, {8, 2}, {8, 8}, {2, 8}},
                        triangles[4][3][2] = {{{5, 3}, {4.5, 4}, {5.5, 4}},
                                              {{6, 4.5}, {6, 5.5}, {7, 5}},
                                              {{4.5, 6}, {5, 7}, {5.5, 6}},
                                              {{4, 4.5}, {3, 5}, {4, 5.5}}};
    for (int i = 0; i < 8; i++) {
        const double x = squares[i][0], y = squares[i][1];
        outline((const double[4][2]){{x, y}, {x, y + 1}, {x + 1, y + 1}, {x + 1, y}}, 4, 1);
    }
    for (int i = 0; i < 4; i++) {
        const double x = diamonds[i][0], y = diamonds[i][1];
        outline((const double[4][2]){{x, y - .5}, {x - .5, y}, {x, y + .5}, {x + .5, y}}, 4, 1);
    }
    for (int i = 0; i < 4; i++)
        outline(triangles[i], 3, 1);
}

START_TEST(test_obstacles)
{
    for (int parts = 1; parts <= 10; parts += 9) {
        begin();
        outline((const double[4][2]){{0, 0}, {10, 0}, {10, 10}, {0, 10}}, 4, parts);
        obstacles();
        if (parts == 1) {
            check_rows("test6", 9, 45, 10, 1e-4);
            continue;
        }
        check_rows("test5", 0, 90, 10, 1e-4);
        check_printed(
            "test5", 0,
            (const struct printed[]){
                {10, .0027548}, {11, .0030926}, {20, .0004848}, {21, .0007578}, {28, .0105961},
                {29, .0498756}, {30, .0027548}, {31, .0034363}, {32, .0044050}, {33, .0058474},
                {34, .0081285}, {35, .0120430}, {36, .0195860}, {37, .0368951}, {38, .0890729},
                {39, .2928932}, {40, .0745428}, {43, .0173092}, {44, .0114575}, {47, .0022811},
                {64, .0058474}, {67, .0201716}, {68, .0195860}, {71, .1318435}, {72, .1293886},
                {75, .0049412}, {80, .0054344}, {88, .0283316}, {97, .0062414}, {-1, 0}});
        check_printed(
            "test5", 44,
            (const struct printed[]){{0, .0114575},  {1, .0248521},  {2, .0471216},  {3, .0745427},
                                     {4, .1147476},  {5, .0890728},  {24, .0030955}, {33, .0343982},
                                     {34, .0356415}, {36, .0114573}, {37, .0049596}, {39, .0201716},
                                     {42, .2360682}, {66, .0055447}, {67, .0391632}, {70, .0894169},
                                     {71, .0248521}, {74, .0152120}, {90, .0789871}, {96, .0069902},
                                     {97, .0283902}, {99, .0038574}, {-1, 0}});
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("profiles");
    TCase *t = tcase_create("profiles");
    tcase_set_timeout(t, 120);
    tcase_add_test(t, test_rooms);
    tcase_add_test(t, test_blockers);
    tcase_add_test(t, test_facet);
    tcase_add_test(t, test_obstacles);
    suite_add_tcase(suite, t);
    return suite_failures(suite) ? EXIT_FAILURE : EXIT_SUCCESS;
}
