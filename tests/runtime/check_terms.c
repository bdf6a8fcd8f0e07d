/* check_terms.c - what tools say of a pair's geometry is true: no point of either element may prove
 * an enclosure or a precise answer wrong; derivatives agree with differences; and no value depends
 * on the unit of length.
 * Once is enough: it is about numbers; that memory is used well, shorter suites tell.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include "study/closed_forms.h"
#include "hand.h"
#include "runtime/make_pair.h"
#include "util/oracles.h"
#include "engine/solve.h"
#include "suite.h"
#include "kernel/samples.h"
#include "terms/form_factor.h"
#include "terms/form_factor_range.h"
#include "terms/gradient.h"
#include "tools/clusters.h"
#include "tools/coplanar.h"
#include "tools/longer.h"
#include "tools/near.h"
#include "tools/overlap.h"
#include "tools/projected_area.h"
#include "tools/straddle.h"
#include "tools/support_planes.h"

/* low <= F(x) <= high for every x, tight where the two are far from each other; the sampled
 * range is inside. */
START_TEST(test_range)
{
    unsigned state = 5;
    double width[2] = {0, 0};
    for (int i = 0; i < 1500; i++) {
        double sampled[2], bound[2], low = INFINITY, high = 0;
        int apart = i % 6;
        struct two t;
        two_random(&t, i % 5 == 4, apart, 1, &state);
        struct discussion d;
        d = two_discussion(&t);
        memcpy(sampled, term_form_factor_range(&d, FORM_FACTOR_RANGE_SAMPLED), sizeof sampled);
        memcpy(bound, term_form_factor_range(&d, FORM_FACTOR_RANGE_BOUNDED), sizeof bound);
        ck_assert_int_eq(d.terms.form_factor_range_level, FORM_FACTOR_RANGE_BOUNDED);
        ck_assert(0 <= bound[0] && bound[0] <= sampled[0] && sampled[0] <= sampled[1]
                  && sampled[1] <= bound[1] && bound[1] <= 1);
        struct polygon q;
        point_factor_clip(&q, t.a, t.b);
        for (int n = 0; n < 100; n++) {
            double x[3];
            random_point(t.a, &state, x);
            double f = point_factor_at(x, t.a, t.b, &q);
            ck_assert_msg(f >= bound[0] && f <= bound[1],
                          "pair %d: F = %.17g outside [%.17g, %.17g]", i, f, bound[0], bound[1]);
            low = f < low ? f : low;
            high = f > high ? f : high;
        }
        if (apart >= 2) {
            width[0] += high - low;
            width[1] += bound[1] - bound[0];
        }
        d = two_discussion(&t);
        /* the mean is no larger than the largest */
        ck_assert(term_form_factor(&d, FORM_FACTOR_CONTOUR) <= bound[1] + 1e-9);
        ck_assert(term_form_factor(&d, FORM_FACTOR_CONTOUR) >= bound[0] - 1e-9);
        two_close(&t);
    }
    printf("150,000 points in their range; two sizes apart and more it is %.2f times as wide as "
           "needed\n",
           width[1] / width[0]);
    ck_assert_double_lt(width[1], 1.5 * width[0]);
}
END_TEST

/* Where squares touch, the largest F is that of the whole half plane. Where they are close, the
 * corners see a quarter of what the middle would see of squares twice as long. */
START_TEST(test_range_near)
{
    struct two t;
    two_perpendicular(&t, 1, 1, 1);
    struct discussion d;
    d = two_discussion(&t);
    const double *range = term_form_factor_range(&d, FORM_FACTOR_RANGE_SAMPLED);
    /* at the ends of the edge, from the middle: three quarters of 1/2 */
    ck_assert_double_eq_tol(range[1], 0.375, 1e-5);
    range = term_form_factor_range(&d, FORM_FACTOR_RANGE_BOUNDED);
    ck_assert_double_eq_tol(range[1], 0.5, 1e-12);
    two_close(&t);
    two_parallel(&t, 1, 1, 0.1);
    d = two_discussion(&t);
    range = term_form_factor_range(&d, FORM_FACTOR_RANGE_SAMPLED);
    ck_assert_double_eq_tol(range[0], closed_corner(1, 1, 0.1), 1e-5);
    ck_assert_double_eq_tol(range[1], 4 * closed_corner(0.5, 0.5, 0.1), 1e-12);
    two_close(&t);
}
END_TEST

/* A lamp over the middle of a large floor: the largest F is inside. Corners and centre see it
 * here; moved by a quarter, only the bound does. */
START_TEST(test_interior)
{
    const double under[3] = {2.5, 2.5, 0};
    struct two t;
    two_start(&t);
    made_quad(&t.scene, 0, 0, 0, 0, 10, 0, 0, 0, 10, 0);
    made_quad(&t.scene, 0, 2, 2, 2, 0, 1, 0, 1, 0, 0);
    two_open(&t);
    struct discussion d;
    d = two_discussion(&t);
    struct polygon q;
    point_factor_clip(&q, t.a, t.b);
    double most = point_factor_at(under, t.a, t.b, &q);
    double sampled = term_form_factor_range(&d, FORM_FACTOR_RANGE_SAMPLED)[1];
    ck_assert_double_lt(sampled, 0.3 * most);
    ck_assert(term_form_factor_range(&d, FORM_FACTOR_RANGE_BOUNDED)[1] >= most);
    ck_assert_double_lt(term_form_factor_range(&d, FORM_FACTOR_RANGE_BOUNDED)[1], 2 * most);
    two_close(&t);
}
END_TEST

/* Against central differences, the horizon's clip included. */
START_TEST(test_gradient)
{
    unsigned state = 19;
    int clipped = 0, n = 0;
    for (int i = 0; i < 2000; i++) {
        double difference[3], error = 0, heights[2];
        struct two t;
        two_random(&t, i % 4 == 3, i % 4, 1, &state);
        struct discussion d;
        d = two_discussion(&t);
        if (!(term_form_factor(&d, FORM_FACTOR_POINT) > 0) || distance_corners(t.a, t.b) < 0.05
            || distance_corners(t.b, t.a) < 0.05
            || height3(t.a->centre, t.b->centre, t.b->normal) < 0.01) {
            two_close(&t);
            continue;
        }
        for (int k = 0; k < 3; k++) {
            struct element left = *t.a, right = *t.a;
            double step = 1e-4;
            left.centre[k] -= step;
            right.centre[k] += step;
            difference[k] = (point_factor(&right, t.b) - point_factor(&left, t.b)) / (2 * step);
        }
        double size = length3(term_gradient(&d));
        for (int k = 0; k < 3; k++)
            error += pow(d.terms.gradient[k] - difference[k], 2);
        ck_assert_msg(sqrt(error) < 1e-4 * size + 1e-6,
                      "pair %d: gradient of length %g is wrong by %g", i, size, sqrt(error));
        plane_side_heights(t.b, t.a, &heights[0], &heights[1]);
        clipped += heights[0] < 0;
        n++;
        two_close(&t);
    }
    ck_assert_int_gt(n, 500);
    ck_assert_int_gt(clipped, 100);
}
END_TEST

/* A plane on whose normal the element's centre and its farthest corner lie, this one lower (way 1)
 * or higher (-1), and the centre at the height `to`. */
static struct element plane_below(const struct element *e, int way, double to)
{
    struct element plane = *e;
    double most = -1;
    for (int j = 0; j < e->vertices; j++) {
        double v[3];
        sub3(v, e->centre, e->vertex[j]);
        if (length3(v) > most) {
            most = length3(v);
            for (int k = 0; k < 3; k++)
                plane.normal[k] = way * v[k] / most;
        }
    }
    for (int k = 0; k < 3; k++)
        plane.centre[k] = e->centre[k] - to * plane.normal[k];
    return plane;
}

/* What spheres prove of sides is what corners say, where the sphere touches the plane with a
 * corner, as near as `flat` and rounding are. */
START_TEST(test_sides)
{
    unsigned state = 5;
    int proved[3] = {0};
    for (int i = 0; i < 20000; i++) {
        struct two t;
        two_random(&t, i % 4 == 3, i % 4, random_size(&state, 1e3), &state);
        struct discussion d = two_discussion(&t);
        const struct element *e = t.b;
        const double flat = plane_side_flat(t.a, e, d.host),
                     off = flat * ((i % 7 - 3) * pow(2, -(i % 40)) + i % 5 - 2);
        double low, high;
        const struct element plane =
            i % 2 ? plane_below(e, 1, e->radius + off) : plane_below(e, -1, off - e->radius);
        plane_side_heights(e, &plane, &low, &high);
        const int side = high <= flat  ? -1
                         : low < -flat ? 0
                                       : 1,
                  sphere = plane_side_proved(e, &plane, flat);
        ck_assert_msg(sphere == 0 || sphere == side, "pair %d: %d by its sphere, %d by corners", i,
                      sphere, side);
        ck_assert_int_eq(support_planes_side(e, &plane, flat), side);
        proved[sphere + 1]++;
        two_close(&t);
    }
    for (int k = 0; k < 3; k++)
        ck_assert_int_gt(proved[k], 500);
}
END_TEST

/* Random points of two elements, faces or clusters of faces. */
static void any_point(const struct hierarchy *h, const struct element *e, unsigned *state,
                      double p[3], double n[3])
{
    while (e->children)
        e = &h->elements[e->child + (uint32_t)(random_unit(state) * e->children)];
    random_point(e, state, p);
    memcpy(n, e->normal, 3 * sizeof *n);
}

static void prove(const struct hierarchy *h, struct discussion *d, unsigned *state, int points,
                  double seen[6])
{
    const double *distance = term_distance(d, DISTANCE_BOUND),
                 *at_r = term_receiver_cosine(d, RECEIVER_COSINE_BOUND);
    const double *at_s = term_emitter_cosine(d, EMITTER_COSINE_BOUND);
    for (int i = 0; i < points; i++) {
        double x[3], y[3], n_r[3], n_s[3], v[3];
        any_point(h, d->receiver, state, x, n_r);
        any_point(h, d->emitter, state, y, n_s);
        sub3(v, y, x);
        double size = length3(v);
        double c = dot3(n_r, v) / size;
        double s = -dot3(n_s, v) / size;
        ck_assert_msg(size >= distance[0] && size <= distance[1], "%g not in [%g, %g]", size,
                      distance[0], distance[1]);
        ck_assert_msg(c >= at_r[0] && c <= at_r[1], "receiver: %.17g not in [%.17g, %.17g]", c,
                      at_r[0], at_r[1]);
        ck_assert_msg(s >= at_s[0] && s <= at_s[1], "emitter: %.17g not in [%.17g, %.17g]", s,
                      at_s[0], at_s[1]);
        seen[0] = fmin(seen[0], size);
        seen[1] = fmax(seen[1], size);
        seen[2] = fmin(seen[2], c);
        seen[3] = fmax(seen[3], c);
    }
}

/* No two points of two surfaces are nearer, farther, or at other cosines than the bounds say,
 * and random points come near to these. */
START_TEST(test_bounds)
{
    unsigned state = 23;
    double slack[4] = {0, 0, 0, 0};
    int n = 0;
    for (int i = 0; i < (thorough() ? 1000 : 200); i++) {
        double seen[6] = {INFINITY, 0, 1, -1}, bound[4];
        struct two t;
        two_random(&t, i % 5 == 4, i % 3, 1, &state);
        struct discussion d;
        d = two_discussion(&t);
        ck_assert(term_distance(&d, DISTANCE_CENTRE)[0] == length3(term_axis(&d)));
        ck_assert(term_receiver_cosine(&d, RECEIVER_COSINE_CENTRE)[0]
                  == dot3(t.a->normal, d.terms.axis) / length3(d.terms.axis));
        ck_assert(term_emitter_cosine(&d, EMITTER_COSINE_CENTRE)[1]
                  == -dot3(t.b->normal, d.terms.axis) / length3(d.terms.axis));
        prove(&t.h, &d, &state, 1000, seen);
        memcpy(bound, d.terms.distance, sizeof d.terms.distance);
        memcpy(bound + 2, d.terms.receiver_cosine, sizeof d.terms.receiver_cosine);
        for (int k = 0; k < 4; k++)
            slack[k] += fabs(seen[k] - bound[k]);
        n++;
        two_close(&t);
    }
    printf("mean distance of the bounds from what 1,000 random segments show: %.2f %.2f m, cosine "
           "%.2f %.2f\n",
           slack[0] / n, slack[1] / n, slack[2] / n, slack[3] / n);
    ck_assert(slack[0] < 0.15 * n && slack[1] < 0.15 * n && slack[2] < 0.2 * n
              && slack[3] < 0.2 * n);
}
END_TEST

/* The least distance of parallelograms is exact: against coordinate descent over both's two
 * parameters each. */
START_TEST(test_distance)
{
    unsigned state = 29;
    for (int i = 0; i < 500; i++) {
        double way[4][3], at[4] = {0.5, 0.5, 0.5, 0.5}, v[3], least = INFINITY;
        struct two t;
        two_random(&t, 0, (i % 4) * 0.4, 1, &state);
        struct discussion d;
        d = two_discussion(&t);
        for (int k = 0; k < 3; k++) {
            way[0][k] = t.a->vertex[1][k] - t.a->vertex[0][k];
            way[1][k] = t.a->vertex[3][k] - t.a->vertex[0][k];
            way[2][k] = t.b->vertex[0][k] - t.b->vertex[1][k];
            way[3][k] = t.b->vertex[0][k] - t.b->vertex[3][k];
            v[k] = t.a->vertex[0][k] - t.b->vertex[0][k]
                   + 0.5 * (way[0][k] + way[1][k] + way[2][k] + way[3][k]);
        }
        for (int n = 0; n < 100000; n++) {
            double last = least;
            for (int j = 0; j < 4; j++) {
                double to = at[j] - dot3(v, way[j]) / dot3(way[j], way[j]);
                to = to < 0 ? 0 : to > 1 ? 1 : to;
                for (int k = 0; k < 3; k++)
                    v[k] += (to - at[j]) * way[j][k];
                at[j] = to;
            }
            least = length3(v);
            if (n > 100 && last - least < 1e-13)
                break;
        }
        ck_assert_double_le(term_distance(&d, DISTANCE_BOUND)[0], least);
        ck_assert_double_eq_tol(d.terms.distance[0], least, 1e-6);
        two_close(&t);
    }
}
END_TEST

/* Clusters: boxes bound what they hold. Precise answers on them too. */
START_TEST(test_clusters)
{
    unsigned state = 31;
    int apart = 0, far = 0, certain = 0;
    struct host host;
    memset(&host, 0, sizeof host);
    struct scene s;
    made_open(&s);
    made_material(&s, 0.5, 1);
    for (uint32_t i = 0; i < 60; i++) {
        double v[9];
        for (int k = 0; k < 9; k++)
            v[k] = random_unit(&state) - (k < 3 ? 0 : 0.5);
        if (i < 20) /* some clusters get narrow cones */
            v[5] = v[8] = 0.01 * v[5];
        made_quad(&s, 0, 6 * v[0], 6 * v[1], 6 * v[2], v[3], v[4], v[5], v[6], v[7], v[8]);
    }
    struct hierarchy h;
    ck_assert_int_eq(hierarchy_build(&h, s.faces, s.face_count), 0);
    for (uint32_t i = 0; i < h.count; i++)
        for (uint32_t j = 0; j < h.count; j++) {
            struct discussion d = {
                .receiver = &h.elements[i], .emitter = &h.elements[j], .host = &host};
            double seen[6] = {INFINITY, 0, 1, -1};
            if (d.receiver->vertices && d.emitter->vertices)
                continue;
            prove(&h, &d, &state, 40, seen);
            apart += tool_overlap(&d) == OVERLAP_APART;
            if (tool_near(&d, 1) == NEAR_FAR) {
                far++;
                ck_assert_double_ge(seen[0], 2 * fmax(d.receiver->radius, d.emitter->radius));
            }
            if (tool_overlap(&d) == OVERLAP_APART)
                ck_assert_double_gt(seen[0], 0);
            certain += d.terms.receiver_cosine[0] > -0.99 || d.terms.receiver_cosine[1] < 0.99;
            ck_assert_int_eq(tool_coplanar(&d), COPLANAR_NO);
        }
    printf("clusters: %d pairs apart, %d far, cosine bounded for %d\n", apart, far, certain);
    ck_assert(apart > 100 && far > 50 && certain > 100);
    hierarchy_free(&h);
    made_close(&s);
}
END_TEST

/* kinds of form factor from the disc on: 1 / d^2 has no bound */
enum { LEVELS = FORM_FACTOR_CONTOUR - FORM_FACTOR_DISC + 1 };

/* Everything the tools of a pair can say, as bits. */
struct said {
    double f[LEVELS], sampled[2], bounded[2], at_r[2], at_s[2], distance[2], gradient[3];
    int answer[8];
};

static void say(const struct two *t, double flat, double unit, struct said *said)
{
    struct host host = t->host;
    memset(said, 0, sizeof *said);
    host.flat = flat * unit;
    struct discussion d;
    for (int level = FORM_FACTOR_DISC; level <= FORM_FACTOR_CONTOUR; level++) {
        d = two_discussion(t);
        said->f[level - FORM_FACTOR_DISC] = term_form_factor(&d, (enum form_factor_level)level);
    }
    d.host = &host;
    memcpy(said->sampled, term_form_factor_range(&d, FORM_FACTOR_RANGE_SAMPLED),
           sizeof said->sampled);
    memcpy(said->bounded, term_form_factor_range(&d, FORM_FACTOR_RANGE_BOUNDED),
           sizeof said->bounded);
    memcpy(said->at_r, term_receiver_cosine(&d, RECEIVER_COSINE_BOUND), sizeof said->at_r);
    memcpy(said->at_s, term_emitter_cosine(&d, EMITTER_COSINE_BOUND), sizeof said->at_s);
    term_distance(&d, DISTANCE_BOUND);
    term_gradient(&d);
    for (int k = 0; k < 2; k++)
        said->distance[k] = d.terms.distance[k] / unit;
    for (int k = 0; k < 3; k++)
        said->gradient[k] = d.terms.gradient[k] * unit;
    host.area = 4 * unit * unit;
    said->answer[0] = (int)tool_near(&d, 0.5);
    said->answer[1] = (int)tool_overlap(&d);
    said->answer[2] = (int)tool_coplanar(&d);
    said->answer[3] = (int)tool_straddle(&d);
    said->answer[4] = (int)tool_projected_area(&d, 0.01 * unit * unit, 0.05);
    said->answer[5] = (int)tool_longer(&d);
    said->answer[6] = (int)tool_support_planes(&d);
}

static const double *numbers(const struct said *said)
{
    return said->f;
}

enum { NUMBERS = 13 + LEVELS };

/* The unit of length, any power of two from 2^-20 to 2^40, changes no bit. */
START_TEST(test_scale)
{
    static const int powers[] = {-20, -7, 10, 40};
    unsigned state = 37;
    ck_assert(offsetof(struct said, answer) == NUMBERS * sizeof(double));
    for (int i = 0; i < 400; i++) {
        unsigned same = state;
        struct said one, other;
        struct two t;
        two_random(&t, i % 3 == 0, i % 4 * 0.6, 1, &state);
        say(&t, 1e-9, 1, &one);
        two_close(&t);
        for (int p = 0; p < 4; p++) {
            double unit = ldexp(1, powers[p]);
            unsigned again = same;
            two_random(&t, i % 3 == 0, i % 4 * 0.6, unit, &again);
            say(&t, 1e-9, unit, &other);
            for (int k = 0; k < NUMBERS; k++)
                ck_assert_msg(numbers(&one)[k] == numbers(&other)[k], "pair %d at 2^%d: number %d",
                              i, powers[p], k);
            ck_assert(memcmp(one.answer, other.answer, sizeof one.answer) == 0);
            two_close(&t);
        }
    }
}
END_TEST

/* Elements that touch, coincide, stand back to back or have two corners in one place: nothing is
 * NaN, and ranges stay ranges. */
START_TEST(test_degenerate)
{
    static const double p[][4][3] = {
        {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},           /* the floor */
        {{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}},           /* its back */
        {{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}},           /* beside it */
        {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}},           /* a wall on its edge */
        {{0.5, 0, 0}, {0.5, 0, 1}, {0.5, 1, 1}, {0.5, 1, 0}},   /* a wall in its middle */
        {{0.5, 0, -1}, {0.5, 0, 1}, {0.5, 1, 1}, {0.5, 1, -1}}, /* through it */
        {{0, 0, 0}, {0, 1, 1}, {1, 1, 1}, {1, 0, 0}},           /* a roof on its edge */
        {{0.5, 0.5, 1e-300}, {0.5, 0.6, 1e-300}, {0.6, 0.6, 1e-300}, {0.6, 0.5, 1e-300}},
        {{0, 0, 1}, {0, 1, 1}, {0, 1, 1}, {1, 0, 1}}, /* a corner twice */
        /* crosses the floor's plane four times */
        {{0, 0, 1e-18}, {1, 0, -1e-18}, {1, 1, 1e-18}, {0, 1, -1e-18}},
        {{0.25, 0.25, 0.5},
         {0.25, 0.25 + 1e-12, 0.5},
         {0.25 + 1e-12, 0.25 + 1e-12, 0.5},
         {0.25 + 1e-12, 0.25, 0.5}},
        {{-1e9, -1e9, 1}, {-1e9, 1e9, 1}, {1e9, 1e9, 1}, {1e9, -1e9, 1}},
    };
    int n = (int)(sizeof p / sizeof *p);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            struct two t;
            two_start(&t);
            made_face(&t.scene, 0, 4, p[i]);
            made_face(&t.scene, 0, 4, p[j]);
            two_open(&t);
            struct said said;
            say(&t, 1e-9, 1, &said);
            for (int k = 0; k < NUMBERS; k++)
                ck_assert_msg(isfinite(numbers(&said)[k]), "%d and %d: number %d is %g", i, j, k,
                              numbers(&said)[k]);
            for (int k = 0; k < LEVELS; k++)
                ck_assert_msg(said.f[k] >= 0 && said.f[k] <= 1, "%d and %d: kind %d is %g", i, j, k,
                              said.f[k]);
            ck_assert(said.bounded[0] <= said.sampled[0] && said.sampled[1] <= said.bounded[1]);
            if (j > i) {
                struct discussion d = two_discussion(&t), e = d;
                double there = t.a->area * term_form_factor(&d, FORM_FACTOR_CONTOUR);
                e.receiver = t.b;
                e.emitter = t.a;
                double back = t.b->area * term_form_factor(&e, FORM_FACTOR_CONTOUR);
                ck_assert_msg(fabs(there - back) <= 1e-6 * there, "%d and %d: %g and %g m2", i, j,
                              there, back);
            }
            ck_assert(said.at_r[0] <= said.at_r[1] && said.at_s[0] <= said.at_s[1]
                      && said.distance[0] <= said.distance[1]);
            two_close(&t);
        }
}
END_TEST

/* The answers, on pairs whose answer is plain. */
START_TEST(test_answers)
{
    static const struct {
        double o[3], u[3], v[3];
        enum near_answer near;
        enum overlap_answer overlap;
        enum coplanar_answer coplanar;
        enum straddle_answer straddle;
        enum longer_answer longer;
    } with_floor[] = {
        {{0, 0, 1},
         {0, 1, 0},
         {1, 0, 0},
         NEAR_NEAR,
         OVERLAP_APART,
         COPLANAR_NO,
         STRADDLE_NONE,
         LONGER_RECEIVER},
        {{0, 0, 1.5},
         {0, 1, 0},
         {1, 0, 0},
         NEAR_FAR,
         OVERLAP_APART,
         COPLANAR_NO,
         STRADDLE_NONE,
         LONGER_RECEIVER},
        {{0, 0, 0},
         {0, 0, 0.5},
         {1, 0, 0},
         NEAR_TOUCHING,
         OVERLAP_OVERLAPPING,
         COPLANAR_NO,
         STRADDLE_NONE,
         LONGER_RECEIVER},
        {{2, 0, -1},
         {0, 0, 2},
         {0, 1, 0},
         NEAR_NEAR,
         OVERLAP_APART,
         COPLANAR_NO,
         STRADDLE_EMITTER,
         LONGER_EMITTER},
        {{0.5, 0.5, 1},
         {0, 1, 0},
         {0, 0, 1},
         NEAR_NEAR,
         OVERLAP_APART,
         COPLANAR_NO,
         STRADDLE_RECEIVER,
         LONGER_RECEIVER},
        {{0.5, 0, -1},
         {0, 0, 2},
         {0, 1, 0},
         NEAR_TOUCHING,
         OVERLAP_OVERLAPPING,
         COPLANAR_NO,
         STRADDLE_BOTH,
         LONGER_EMITTER},
        {{1, 0, 0},
         {0.01, 0, 0},
         {0, 3, 0},
         NEAR_TOUCHING,
         OVERLAP_OVERLAPPING,
         COPLANAR_YES,
         STRADDLE_NONE,
         LONGER_EMITTER},
        {{5, 0, 0},
         {0, 1, 0},
         {1, 0, 0},
         NEAR_FAR,
         OVERLAP_APART,
         COPLANAR_YES,
         STRADDLE_NONE,
         LONGER_RECEIVER},
    };
    for (int i = 0; i < (int)(sizeof with_floor / sizeof *with_floor); i++) {
        const double *o = with_floor[i].o, *u = with_floor[i].u, *v = with_floor[i].v;
        struct discussion d, e;
        struct two t;
        two_start(&t);
        made_quad(&t.scene, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
        made_quad(&t.scene, 0, o[0], o[1], o[2], u[0], u[1], u[2], v[0], v[1], v[2]);
        two_open(&t);
        d = e = two_discussion(&t);
        e.receiver = t.b;
        e.emitter = t.a;
        ck_assert_int_eq(tool_near(&d, 1), with_floor[i].near);
        ck_assert_int_eq(tool_near(&e, 1), with_floor[i].near);
        ck_assert_int_eq(tool_overlap(&d), with_floor[i].overlap);
        ck_assert_int_eq(tool_coplanar(&d), with_floor[i].coplanar);
        ck_assert_int_eq(tool_coplanar(&e), with_floor[i].coplanar);
        ck_assert_int_eq(tool_straddle(&d), with_floor[i].straddle);
        if (longer_square(t.a) < longer_square(t.b) || longer_square(t.a) > longer_square(t.b))
            ck_assert_int_eq(tool_longer(&d), with_floor[i].longer);
        /* the same element both ways */
        ck_assert((tool_longer(&d) == LONGER_RECEIVER) == (tool_longer(&e) == LONGER_EMITTER));
        two_close(&t);
    }
}
END_TEST

/* A square of 1 m2 at 45 degrees to the line of centres: .707 m2, whichever of the two it is,
 * and in shares of the scene. */
START_TEST(test_projected_area)
{
    struct two t;
    two_start(&t);
    made_quad(&t.scene, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    /* centres 3.25 - 0.5 apart in x, 3 in z */
    made_quad(&t.scene, 0, 3, 0, 3, 0, 0.5, 0, 0.5, 0, 0);
    two_open(&t);
    struct discussion d;
    d = two_discussion(&t);
    term_axis(&d);
    {
        double projected = 3 / length3(d.terms.axis); /* of the larger one, 1 m2 */
        t.host.area = 10;
        ck_assert_int_eq(tool_projected_area(&d, 1.001 * projected, 0), PROJECTED_AREA_SMALL);
        ck_assert_int_eq(tool_projected_area(&d, 0.999 * projected, 0), PROJECTED_AREA_LARGE);
        ck_assert_int_eq(tool_projected_area(&d, 0, 0.1001 * projected), PROJECTED_AREA_SMALL);
        ck_assert_int_eq(tool_projected_area(&d, 0.3, 0.0999 * projected), PROJECTED_AREA_LARGE);
    }
    two_close(&t);
}
END_TEST

/* Two squares of one plane, near or far, turned at random, at any scale: away, coplanar, no link
 * and not a single ray. */
START_TEST(test_coplanar)
{
    static char *const oracles[] = {"bf", "bf_guarded", "viewfactors"};
    unsigned state = 41;
    for (int i = 0; i < 21; i++) {
        struct solve_options options = {.tolerance = 1e-6, .iterations = 100, .threads = 1};
        double u[3], v[3], n[3], o[3], gap = (i % 3) * 0.7;
        int power = i % 7 * 10 - 20;
        for (int k = 0; k < 3; k++) {
            u[k] = random_unit(&state) - 0.5;
            v[k] = random_unit(&state) - 0.5;
            o[k] = 4 * random_unit(&state) - 2;
        }
        cross3(n, u, v);
        cross3(v, n, u);
        double size = length3(u);
        for (int k = 0; k < 3; k++)
            u[k] = ldexp(u[k] / size, power);
        size = length3(v);
        for (int k = 0; k < 3; k++) {
            v[k] = ldexp(v[k] / size, power);
            o[k] = ldexp(o[k], power);
        }
        struct two t;
        two_start(&t);
        t.scene.materials[0].exitance[0] = t.scene.materials[0].exitance[1] =
            t.scene.materials[0].exitance[2] = 1;
        made_quad(&t.scene, 0, o[0], o[1], o[2], u[0], u[1], u[2], v[0], v[1], v[2]);
        for (int k = 0; k < 3; k++)
            o[k] += (1 + gap) * u[k] + 0.3 * gap * v[k];
        made_quad(&t.scene, 0, o[0], o[1], o[2], u[0], u[1], u[2], v[0], v[1], v[2]);
        two_open(&t);
        struct discussion d;
        d = two_discussion(&t);
        ck_assert_int_eq(tool_coplanar(&d), COPLANAR_YES);
        ck_assert_int_eq(tool_support_planes(&d), SUPPORT_PLANES_AWAY);
        ck_assert_int_eq(tool_straddle(&d), STRADDLE_NONE);
        for (int k = FORM_FACTOR_POINT; k <= FORM_FACTOR_CONTOUR; k++) { /* by disc 1e-30 */
            d = two_discussion(&t);
            ck_assert(term_form_factor(&d, (enum form_factor_level)k) == 0);
        }
        ck_assert(hand_form_factor(t.a, t.b) == 0);
        ck_assert(term_form_factor_range(&d, FORM_FACTOR_RANGE_SAMPLED)[1] == 0);
        ck_assert(term_form_factor_range(&d, FORM_FACTOR_RANGE_BOUNDED)[1] == 0);
        ck_assert(length3(term_gradient(&d)) == 0);
        struct refiner *oracle = oracles_open(oracles[i / 7], RELEASE_FLAT);
        ck_assert_ptr_nonnull(oracle);
        struct solve s;
        const char *cause;
        ck_assert_int_eq(solve_open(&s, &t.scene, &options, &cause), 0);
        ck_assert_int_eq(solve_refine(&s, oracle, &cause), 0);
        ck_assert_uint_eq(s.refinement.link_count, 0);
        ck_assert_uint_eq(rays_count(s.problem.rays).rays, 0);
        refiner_close(oracle);
        solve_close(&s);
        two_close(&t);
    }
}
END_TEST

/* Point (s, t) of the sampled polygon, alone. */
static void sampled_alone(const struct sampler *q, const double normal[3], double s, double t,
                          double out[3])
{
    const double(*v)[3] = (const double(*)[3])q->p.v;
    double area[POLYGON_MAX] = {0}, whole = 0;
    int i;
    if (q->parallelogram) {
        for (int k = 0; k < 3; k++)
            out[k] = v[0][k] + s * (v[1][k] - v[0][k]) + t * (v[3][k] - v[0][k]);
        return;
    }
    for (i = 2; i < q->p.n; i++) {
        double a[3], b[3], c[3];
        sub3(a, v[i - 1], v[0]);
        sub3(b, v[i], v[0]);
        cross3(c, a, b);
        area[i] = dot3(c, normal);
        whole += area[i];
    }
    s *= whole;
    for (i = 2; i < q->p.n - 1 && s >= area[i]; i++)
        s -= area[i];
    s = area[i] > 0 && s < area[i] ? sqrt(s / area[i]) : 1;
    for (int k = 0; k < 3; k++)
        out[k] = v[0][k] + s * (v[i - 1][k] - v[0][k]) + s * t * (v[i][k] - v[i - 1][k]);
}

/* Segments that are computed several at a time have the bits of each alone, in vectors of any
 * width. */
START_TEST(test_samples)
{
    unsigned state = 17;
    int kinds[POLYGON_MAX + 1][2] = {{0}}, checked = 0;
    static struct samples made[3];
    for (int i = 0; i < 4000; i++) {
        struct two t;
        struct samples_ends ends;
        struct sobol net;
        two_random(&t, i % 5 == 4, i % 6, 1, &state);
        const struct element *r = t.a, *s = t.b;
        const int count = 1 << 2 * (i % 3 + 1);
        sampler_clip(&ends.p, r, s);
        sampler_clip(&ends.q, s, r);
        kinds[ends.p.p.n][ends.p.parallelogram]++;
        if (ends.p.p.n && ends.q.p.n) {
            ends.n = r->normal;
            ends.m = s->normal;
            ends.spread = r->area / count;
            ends.ray_offset = 1e-6;
            sobol_start(&net, hash64((uint64_t)i));
            for (int w = 0; w < 3; w++)
                sobol_points(&net, 0, count, made[w].digit);
            samples_at(1, &made[0], &ends, count);
            made[1].weight[0] = made[2].weight[0] = -1;
            for (int w = 1; w < 3; w++)
                samples_at(4 * w < lanes_width() ? 4 * w : lanes_width(), &made[w], &ends, count);
            for (int j = 0; j < count; j++) {
                double u[4], from[3], to[3];
                for (int k = 0; k < 4; k++)
                    u[k] = made[0].digit[k][j] * (1 / 4294967296.0);
                sampled_alone(&ends.p, r->normal, u[0], u[1], from);
                sampled_alone(&ends.q, s->normal, u[2], u[3], to);
                double weight = lambert_points(from, r->normal, to, s->normal, ends.spread);
                for (int w = 0; w < 3; w++) {
                    ck_assert_msg(made[w].weight[j] == weight, "pair %d, width %d, segment %d", i,
                                  w, j);
                    for (int k = 0; k < 3; k++) {
                        ck_assert(made[w].from[k][j] == from[k] + 1e-6 * r->normal[k]);
                        ck_assert(made[w].to[k][j] == to[k] + 1e-6 * s->normal[k]);
                    }
                }
                checked++;
            }
        }
        two_close(&t);
    }
    for (int n = 3; n <= POLYGON_MAX; n++)
        ck_assert_msg(kinds[n][0] > 20, "%d corners: %d", n, kinds[n][0]);
    ck_assert_int_gt(kinds[4][1], 20);
    ck_assert_int_gt(checked, 10000);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("terms");
    TCase *c = tcase_create("terms");
    tcase_set_timeout(c, 120);
    tcase_add_test(c, test_range);
    tcase_add_test(c, test_range_near);
    tcase_add_test(c, test_interior);
    tcase_add_test(c, test_gradient);
    tcase_add_test(c, test_bounds);
    tcase_add_test(c, test_distance);
    tcase_add_test(c, test_clusters);
    tcase_add_test(c, test_scale);
    tcase_add_test(c, test_degenerate);
    tcase_add_test(c, test_answers);
    tcase_add_test(c, test_projected_area);
    tcase_add_test(c, test_coplanar);
    tcase_add_test(c, test_sides);
    tcase_add_test(c, test_samples);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
