/* check_crossing.c - polygons whose outline crosses itself are all that it goes round.
 *
 * What it goes round is asked by the sum of angles under which a point sees the edges, and areas by
 * lengths along many lines; the code that is tested has neither.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "radiosity.h"
#include "suite.h"

enum { MOST = 24, LINES = 4000 };

static const double PI = 3.14159265358979323846;

struct outline {
    double place[MOST][2];
    uint32_t n;
};

/* How often the outline goes round a place, to the left; *edge 1 when it is too near to an edge. */
static int times_round(const struct outline *o, const double x[2], int *edge)
{
    double sum = 0;
    for (uint32_t i = 0; i < o->n; i++) {
        const double *p = o->place[i], *q = o->place[(i + 1) % o->n];
        double a[2] = {p[0] - x[0], p[1] - x[1]}, b[2] = {q[0] - x[0], q[1] - x[1]};
        double sine = a[0] * b[1] - a[1] * b[0], cosine = a[0] * b[0] + a[1] * b[1];
        if (fabs(sine) < 1e-3 * hypot(q[0] - p[0], q[1] - p[1]))
            *edge = 1;
        sum += atan2(sine, cosine);
    }
    return (int)lround(sum / (2 * PI));
}

static double shoelace(const struct outline *o)
{
    double twice = 0;
    for (uint32_t i = 0; i < o->n; i++) {
        const double *p = o->place[i], *q = o->place[(i + 1) % o->n];
        twice += p[0] * q[1] - p[1] * q[0];
    }
    return twice / 2;
}

/* The length of what the outline goes round on x = const, by the crossings in order. */
static double length_along(const struct outline *o, double x)
{
    double at[MOST], length = 0;
    int way[MOST], count = 0, round = 0;
    for (uint32_t i = 0; i < o->n; i++) {
        const double *p = o->place[i], *q = o->place[(i + 1) % o->n];
        if ((p[0] < x) == (q[0] < x))
            continue;
        double y = p[1] + (x - p[0]) / (q[0] - p[0]) * (q[1] - p[1]);
        int k = count++;
        for (; k && at[k - 1] > y; k--) {
            at[k] = at[k - 1];
            way[k] = way[k - 1];
        }
        at[k] = y;
        way[k] = p[0] < x ? 1 : -1;
    }
    for (int i = 0; i + 1 < count; i++) {
        round += way[i];
        length += round ? at[i + 1] - at[i] : 0;
    }
    return length;
}

static double area_by_lines(const struct outline *o)
{
    double sum = 0;
    for (int i = 0; i < LINES; i++)
        sum += length_along(o, 2 * (i + .5) / LINES - .5) * 2 / LINES;
    return sum;
}

static struct RadSceneReport commit(const struct outline *o, double scale, int turned,
                                    RadScene *scene, RadDevice *device)
{
    double position[MOST][3] = {{0}};
    uint32_t index[MOST], size = o->n;
    struct RadSceneReport report;
    for (uint32_t i = 0; i < o->n; i++) {
        index[i] = i;
        position[i][0] = scale * o->place[i][0];
        position[i][1] = scale * (turned ? .8 : 1) * o->place[i][1];
        position[i][2] = scale * (turned ? .6 : 0) * o->place[i][1];
    }
    const struct RadMaterial grey = {.reflectance = {.5, .5, .5}};
    const struct RadPolygons polygons = {.positions = &position[0][0],
                                         .position_count = o->n,
                                         .indices = index,
                                         .sizes = &size,
                                         .count = 1};
    *device = radNewDevice(NULL);
    *scene = radNewScene(*device);
    ck_assert_int_eq(radSetSceneMaterials(*scene, &grey, 1), 0);
    ck_assert_int_eq(radSetSceneSharedPolygons(*scene, &polygons), 0);
    ck_assert_msg(radCommitScene(*scene) == 0, "%s", radGetDeviceErrorMessage(*device));
    ck_assert_int_eq(radGetSceneReport(*scene, &report), 0);
    return report;
}

/* Is a place in the face, with its front up? */
static int is_in(const struct RadFace *f, double scale, int turned, const double x[2])
{
    for (uint32_t i = 0; i < f->vertices; i++) {
        const double *p = f->vertex[i], *q = f->vertex[(i + 1) % f->vertices];
        double y = turned ? .8 : 1;
        if ((q[0] - p[0]) * (x[1] * scale - p[1] / y) - (q[1] - p[1]) / y * (x[0] * scale - p[0])
            < 0)
            return 0;
    }
    return 1;
}

static void check_outline(const struct outline *o, double scale, int turned)
{
    RadScene scene;
    RadDevice device;
    double net = shoelace(o), right = area_by_lines(o);
    struct RadSceneReport r = commit(o, scale, turned, &scene, &device);
    const struct RadFace *faces = radGetSceneFaces(scene);
    ck_assert_msg(fabs(r.area / (scale * scale) - right) < 2e-3, "area %g, not %g",
                  r.area / (scale * scale), right);
    ck_assert_double_eq_tol(radGetScenePolygonAreas(scene)[0], r.area, 1e-9 * r.area);
    for (int i = 0; i < 400; i++) {
        double x[2] = {1. * rand() / RAND_MAX, 1. * rand() / RAND_MAX};
        int edge = 0, round = times_round(o, x, &edge);
        uint32_t up = 0;
        for (uint32_t k = 0; k < r.faces; k++) {
            struct RadFace f = faces[k];
            for (uint32_t j = 0; j < f.vertices && net < 0; j++) /* its front is below */
                memcpy(f.vertex[j], faces[k].vertex[f.vertices - 1 - j], sizeof f.vertex[j]);
            up += (uint32_t)is_in(&f, scale, turned, x);
        }
        if (!edge && fabs(net) > 1e-3)
            ck_assert_msg(up == (round != 0), "%u faces where it goes round %d times", up, round);
    }
    radReleaseScene(scene);
    radReleaseDevice(device);
}

START_TEST(test_random)
{
    static const double scales[] = {1, 1e-5, 1e5};
    srand(3 + (unsigned)_i);
    for (int turn = 0; turn < 60; turn++) {
        struct outline o = {.n = 4 + (uint32_t)(turn % 9)};
        for (uint32_t i = 0; i < o.n; i++)
            for (int k = 0; k < 2; k++)
                o.place[i][k] = turn % 2 ? 1. * rand() / RAND_MAX : rand() % 6 / 5.;
        if (fabs(shoelace(&o)) > 1e-3)
            check_outline(&o, scales[_i], turn / 2 % 2);
    }
}
END_TEST

static double area_of(const struct outline *o, uint32_t *crossing)
{
    RadScene scene;
    RadDevice device;
    struct RadSceneReport r = commit(o, 3, 1, &scene, &device);
    *crossing = r.crossing;
    radReleaseScene(scene);
    radReleaseDevice(device);
    return r.area / 9;
}

/* By hand: a bow tie, also with unequal loops and with its knot a corner; a five-pointed star drawn
 * in one line; a square gone round twice; what only touches itself does not cross. */
START_TEST(test_known)
{
    struct outline star = {.n = 5};
    for (int i = 0; i < 5; i++) {
        star.place[i][0] = cos(4 * PI * i / 5);
        star.place[i][1] = sin(4 * PI * i / 5);
    }
    const double inner = (3 - sqrt(5)) / 2, step = PI / 5; /* of the star's inner corners */
    const struct {
        struct outline o;
        double area;
        uint32_t crossing;
    } cases[] = {
        {{{{0, 0}, {1, 0}, {0, 1}, {1, 1}}, 4}, .5, 1},
        {{{{0, 0}, {3, 0}, {0, 1}, {1, 1}}, 4}, .125 + 9. / 8, 1},
        {{{{0, 0}, {1, 0}, {.5, .5}, {0, 1}, {1, 1}, {.5, .5}}, 6}, .5, 1},
        {{{{0, 0}, {1, 0}, {.5, .5}, {-.5, 1.5}, {1.5, 1.5}, {.5, .5}}, 6}, 1.25, 1},
        {star, 5 * inner * sin(step), 1},
        {{{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}, {1, 0}, {1, 1}, {0, 1}}, 8}, 1, 1},
        {{{{0, 0}, {1, 0}, {.5, .5}, {1, 1}, {0, 1}, {.5, .5}}, 6}, .5, 0},
        {{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 4}, 1, 0},
        {{{{0, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 0}, {.5, .5}, {.5, 1}, {1, 1}, {1, .5}, {.5, .5}},
          10},
         3.75,
         0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        uint32_t crossing;
        double area = area_of(&cases[i].o, &crossing);
        ck_assert_msg(fabs(area - cases[i].area) < 1e-12, "case %zu: %.15g, not %.15g", i, area,
                      cases[i].area);
        ck_assert_msg(crossing == cases[i].crossing, "case %zu", i);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("crossing");
    TCase *c = tcase_create("crossing");
    tcase_add_loop_test(c, test_random, 0, 3);
    tcase_add_test(c, test_known);
    tcase_set_timeout(c, 60);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
