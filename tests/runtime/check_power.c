/* check_power.c - what the oracle power asks: deviation, unevenness, rays to the light, what is not
 * linear, noise, and groups taken for points; against closed forms.
 * SPDX-License-Identifier: MIT */
#include <stdatomic.h>
#include <stdio.h>
#include "runtime/make_pair.h"
#include "runtime/make_solve.h"
#include "runtime/random_room.h"
#include "kernel/constants.h"
#include "suite.h"
#include "tools/cluster_noise.h"
#include "tools/cluster_uneven.h"
#include "tools/handed_down.h"
#include "tools/light_visibility.h"
#include "tools/linear_gap.h"
#include "tools/separable_gap.h"
#include "tools/shaft.h"
#include "tools/transfer_noise.h"
#include "tools/uneven.h"

/* ---- deviation: what the engine shows the oracles */

/* Sum of A |B - mean| over the leaves below e. */
static double leaves_off(const struct solve *s, uint32_t e, double mean)
{
    const struct element *x = &s->hierarchy.elements[e];
    double sum = 0;
    if (!x->children)
        return x->area * fabs(s->state.radiosity[e] - mean);
    for (uint32_t c = x->child; c < x->child + x->children; c++)
        sum += leaves_off(s, c, mean);
    return sum;
}

/* How many splits lie below e. */
static int height(const struct hierarchy *h, uint32_t e)
{
    const struct element *x = &h->elements[e];
    int most = 0;
    for (uint32_t c = x->child; c < x->child + x->children; c++) {
        int below = 1 + height(h, c);
        most = below > most ? below : most;
    }
    return most;
}

/* Half the mean of |B - mean| where one split lies below, no less where more do, and less than
 * twice that in the mean. */
START_TEST(test_deviation)
{
    struct scene scene;
    struct solve s;
    char *settings[] = {"min_share=1e-4", NULL};
    int single = 0, many = 0;
    double most = 0, sum = 0, sum_known = 0;
    const uint32_t m[6] = {0, 0, 0, 0, 0, 0};
    made_open(&scene);
    made_material(&scene, 0.6, 0);
    made_material(&scene, 0.2, 10);
    made_room(&scene, m, 4, 5, 3);
    made_quad(&scene, 1, 1, 2, 2.5, 0, 1, 0, 1, 0, 0);
    made_quad(&scene, 1, 1, 2, 2.5, 1, 0, 0, 0, 1, 0);
    solve_with(&s, &scene, "bf_guarded", RELEASE_FLAT, settings, quick(2));
    for (uint32_t i = 0; i < s.hierarchy.count; i++)
        s.hierarchy.elements[i].deviation = 0; /* or they are within HYSTERESIS */
    s.inputs.known = 0;
    ck_assert_int_eq(oracle_inputs_update(&s.inputs, &s.operator, s.state.radiosity, &s.hierarchy),
                     0);
    for (uint32_t i = 0; i < s.hierarchy.count; i++)
        ck_assert_double_ge(s.operator.uncovered[i], 1); /* else the means are not those of areas */
    for (uint32_t i = 0; i < s.hierarchy.count; i++) {
        const struct element *e = &s.hierarchy.elements[i];
        double mean = s.state.radiosity[i], half = 0.5 * leaves_off(&s, i, mean) / e->area;
        int splits = height(&s.hierarchy, i);
        ck_assert_double_ge(e->deviation, half * (1 - 1e-9) - 1e-12);
        if (splits < 2)
            ck_assert_double_eq_tol(e->deviation, half, 1e-9 * (half + 1e-3));
        single += splits == 1 && half > 0;
        many += splits > 1;
        /* by the triangle inequality, level by level */
        ck_assert_double_le(e->deviation, fmax(1, 2 * splits - 1) * half + 1e-12);
        if (splits > 1 && half > 1e-6) {
            most = fmax(most, e->deviation / half);
            sum += e->area * e->deviation;
            sum_known += e->area * half;
        }
    }
    printf("deviation: %.2f times in the mean, up to %.2f, of %d elements with parts of parts\n",
           sum / sum_known, most, many);
    ck_assert_int_gt(single, 20);
    ck_assert_int_gt(many, 20);
    ck_assert_double_le(sum, 2 * sum_known);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* ---- unevenness */

enum { CELLS = 64 };

/* |mean of V B - mean of V times mean of B| of cells of equal size, and what unevenness makes of
 * them. The visibility is known exactly, or to 1/N of the level. */
static void uneven_cells(const double *v, const double *b, enum visibility_level level, double off,
                         double *covariance, double *bound)
{
    struct element s;
    struct discussion d;
    double mean_v = 0, mean_b = 0, both = 0, low = INFINITY, high = -INFINITY, wide = 0;
    for (int i = 0; i < CELLS; i++) {
        mean_v += v[i] / CELLS;
        mean_b += b[i] / CELLS;
        both += v[i] * b[i] / CELLS;
        low = fmin(low, b[i]);
        high = fmax(high, b[i]);
    }
    for (int i = 0; i < CELLS; i++)
        wide += 0.5 * fabs(b[i] - mean_b) / CELLS;
    memset(&s, 0, sizeof s);
    memset(&d, 0, sizeof d);
    s.spread = high - low;
    s.deviation = wide;
    d.emitter = &s;
    d.terms.visibility = fmin(1, fmax(0, mean_v + off));
    d.terms.visibility_level = (unsigned char)level;
    *covariance = fabs(both - mean_v * mean_b);
    *bound = unevenness(&d);
}

START_TEST(test_unevenness)
{
    unsigned state = 7;
    double v[CELLS], b[CELLS], covariance, bound, tightest = 0;
    for (int t = 0; t < 20000; t++) {
        int kind = t % 4; /* V: even, 0 or 1, 0 or 1 by B, nearly all the same */
        double power = random_size(&state, 20), edge = random_unit(&state);
        for (int i = 0; i < CELLS; i++) {
            double u = random_unit(&state);
            b[i] = pow(random_unit(&state), power);
            v[i] = kind == 0   ? u
                   : kind == 1 ? u < edge
                   : kind == 2 ? b[i] < edge
                   : u < 0.03  ? 0
                               : 1;
        }
        uneven_cells(v, b, VISIBILITY_EXACT, 0, &covariance, &bound);
        ck_assert_double_le(covariance, bound * (1 + 1e-12) + 1e-15);
        if (bound > 0)
            tightest = fmax(tightest, covariance / bound);
        uneven_cells(v, b, VISIBILITY_RAYS_16, (2 * random_unit(&state) - 1) / 16, &covariance,
                     &bound);
        ck_assert_double_le(covariance, bound * (1 + 1e-12) + 1e-15);
    }
    ck_assert_double_ge(tightest, 0.9); /* or it were no use */
    /* The bright half of two is hidden: reached. One cell of 64 shines and is hidden: share times
     * spread, 1/64, beside a deviation of 63/4096. */
    for (int i = 0; i < CELLS; i++)
        b[i] = i < CELLS / 2, v[i] = 1 - b[i];
    uneven_cells(v, b, VISIBILITY_EXACT, 0, &covariance, &bound);
    ck_assert_double_eq_tol(covariance, 0.25, 1e-12);
    ck_assert_double_eq_tol(bound, 0.25, 1e-12);
    for (int i = 0; i < CELLS; i++)
        b[i] = i == 5, v[i] = 1 - b[i];
    uneven_cells(v, b, VISIBILITY_EXACT, 0, &covariance, &bound);
    ck_assert_double_eq_tol(bound, 63.0 / 4096, 1e-12);
    ck_assert_double_eq_tol(covariance, 63.0 / 4096, 1e-12);
    /* All is seen, and it is known: nothing; by 16 rays: as much as 1/16 of the spread. */
    for (int i = 0; i < CELLS; i++) {
        v[i] = 1;
        b[i] = i < CELLS / 2;
    }
    uneven_cells(v, b, VISIBILITY_EXACT, 0, &covariance, &bound);
    ck_assert(bound <= 0);
    uneven_cells(v, b, VISIBILITY_RAYS_16, 0, &covariance, &bound);
    ck_assert_double_eq_tol(bound, 1.0 / 16, 1e-12);
}
END_TEST

/* ---- rays to the light */

/* A unit square at the height 1 that shines down, split into 8 x 8 cells, and one far below. A
 * plate just below the square hides what lies above x0..x1, y0..y1 of it. */
struct lamp {
    struct host host; /* first: `plate` is called with it */
    struct element element[1 + 4 + 16 + 64], receiver;
    const struct element *elements;
    double x0, x1, y0, y1;
};

static uint64_t plate(const struct host *host, int count, const struct segment *segments)
{
    const struct lamp *l = (const struct lamp *)(const void *)host;
    uint64_t hidden = 0;
    for (int i = 0; i < count; i++) {
        const struct segment *g = &segments[i];
        double t = (0.9999 - g->from[2]) / (g->to[2] - g->from[2]),
               x = g->from[0] + t * (g->to[0] - g->from[0]),
               y = g->from[1] + t * (g->to[1] - g->from[1]);
        if (x > l->x0 && x < l->x1 && y > l->y0 && y < l->y1)
            hidden |= UINT64_C(1) << i;
    }
    return hidden;
}

static void lamp_square(struct element *e, double x, double y, double z, double size, int down)
{
    const double corner[4][2] = {{x, y}, {x + size, y}, {x + size, y + size}, {x, y + size}};
    memset(e, 0, sizeof *e);
    for (int i = 0; i < 4; i++) {
        e->vertex[i][0] = corner[down ? 3 - i : i][0];
        e->vertex[i][1] = corner[down ? 3 - i : i][1];
        e->vertex[i][2] = z;
    }
    e->vertices = 4;
    e->normal[2] = down ? -1 : 1;
    e->centre[0] = x + 0.5 * size;
    e->centre[1] = y + 0.5 * size;
    e->centre[2] = z;
    e->area = size * size;
    e->radius = size * sqrt(0.5);
    e->cone = 1;
}

/* The cell that holds (x, y) has the radiosity `bright`, all others 1. */
static void lamp_make(struct lamp *l, double x, double y, double bright, uint64_t id)
{
    uint32_t next = 1;
    memset(l, 0, sizeof *l);
    lamp_square(&l->element[0], 0, 0, 1, 1, 1);
    for (uint32_t i = 0; i < 21; i++) {
        struct element *e = &l->element[i];
        double size = sqrt(e->area) / 2, left = e->centre[0] - size, low = e->centre[1] - size;
        e->child = next;
        e->children = 4;
        for (uint32_t c = 0; c < 4; c++)
            lamp_square(&l->element[next++], left + (c & 1 ? size : 0), low + (c & 2 ? size : 0), 1,
                        size, 1);
    }
    for (uint32_t i = next; i-- > 0;) {
        struct element *e = &l->element[i];
        double half = sqrt(e->area) / 2;
        if (!e->children)
            e->radiosity =
                fabs(x - e->centre[0]) < half && fabs(y - e->centre[1]) < half ? bright : 1;
        double least = INFINITY, most = 0;
        for (uint32_t c = e->child; c < e->child + e->children; c++) {
            e->radiosity += l->element[c].radiosity / 4;
            least = fmin(least, l->element[c].radiosity);
            most = fmax(most, l->element[c].radiosity);
        }
        e->spread = e->children ? most - least : 0;
        e->id = id + 1000 * i;
    }
    lamp_square(&l->receiver, 0, 0, -20, 1, 0);
    l->receiver.id = 77 * id + 5;
    l->elements = l->element;
    l->host.elements = &l->elements;
    l->host.occluded = plate;
    l->host.area = 2;
    l->host.irradiance = 1;
    l->host.extent = 21;
}

static struct discussion lamp_discussion(const struct lamp *l)
{
    struct discussion d;
    memset(&d, 0, sizeof d);
    d.receiver = &l->receiver;
    d.emitter = &l->element[0];
    d.host = &l->host;
    return d;
}

/* The plate hides 3/4 of a cell, 1/8 across, that shines 64 times as brightly as the rest. 16 rays
 * by area all arrive, at three of four places. By power 1 - 3/4 64 / (63 + 64) does, .622: 1024
 * rays know it, and 16 do in the mean of many pairs. */
START_TEST(test_light_visibility)
{
    const double share = 1 - 0.75 * 64 / (63 + 64);
    struct lamp l;
    double sum = 0, squares = 0, area = 0, worst = 0;
    int whole = 0;
    enum { PAIRS = 400 };
    for (int i = 0; i < PAIRS; i++) {
        lamp_make(&l, 0.55, 0.3, 64, (uint64_t)i + 1);
        l.x0 = 0.5;
        l.x1 = 0.5 + 0.75 / 8;
        l.y0 = 0.25;
        l.y1 = 0.375;
        struct discussion few = lamp_discussion(&l), many = few, plain = few;
        enum light_visibility_answer answer = tool_light_visibility(&few, 16, 0);
        ck_assert_int_eq(few.terms.visibility_level, VISIBILITY_RAYS_16);
        double v = few.terms.visibility;
        ck_assert_int_eq(answer, v <= 0  ? LIGHT_VISIBILITY_NONE
                                 : v < 1 ? LIGHT_VISIBILITY_PARTIAL
                                         : LIGHT_VISIBILITY_ALL);
        sum += v / PAIRS;
        squares += v * v / PAIRS;
        (void)tool_light_visibility(&many, 1024, 0);
        worst = fmax(worst, fabs(many.terms.visibility - share));
        whole += term_visibility(&plain, VISIBILITY_RAYS_16) >= 1;
        area += plain.terms.visibility / PAIRS;
    }
    double error = sqrt((squares - sum * sum) / PAIRS);
    printf("light that is seen: %.4f +- %.4f by 16 rays, within %.4f by 1024, known %.4f; by area "
           "%.4f, all of it for %d of %d\n",
           sum, error, worst, share, area, whole, PAIRS);
    ck_assert_double_eq_tol(sum, share, 4 * error);
    ck_assert_double_le(error, 0.01);
    ck_assert_double_le(worst, 0.03);
    ck_assert_int_ge(whole, PAIRS / 2);
    ck_assert_double_ge(area, 0.97);
    /* Nothing stands there, and a plate over all. */
    l.x0 = l.x1 = 2;
    struct discussion d = lamp_discussion(&l);
    ck_assert_int_eq(tool_light_visibility(&d, 16, 0), LIGHT_VISIBILITY_ALL);
    ck_assert_double_eq(d.terms.visibility, 1);
    l.x0 = l.y0 = -1;
    l.x1 = l.y1 = 2;
    d = lamp_discussion(&l);
    ck_assert_int_eq(tool_light_visibility(&d, 4, 0), LIGHT_VISIBILITY_NONE);
    ck_assert_double_eq(d.terms.visibility, 0);
}
END_TEST

/* ---- what a link is held against */

enum asked { LINEAR_GAP, UNEVEN, TRANSFER_NOISE, CLUSTER_NOISE, CLUSTER_UNEVEN, SEPARABLE_GAP };

static int small(enum asked tool, struct discussion d, double absolute, double relative)
{
    switch (tool) {
    case LINEAR_GAP:
        return tool_linear_gap(&d, absolute, relative, INFINITY) == LINEAR_GAP_SMALL;
    case UNEVEN:
        return tool_uneven(&d, absolute, relative) == UNEVEN_BELOW;
    case TRANSFER_NOISE:
        return tool_transfer_noise(&d, absolute, relative) == TRANSFER_NOISE_SMALL;
    case CLUSTER_NOISE:
        return tool_cluster_noise(&d, absolute, relative) == CLUSTER_NOISE_SMALL;
    case CLUSTER_UNEVEN:
        return tool_cluster_uneven(&d, absolute, relative) == CLUSTER_UNEVEN_BELOW;
    default:
        return tool_separable_gap(&d, absolute, relative) == SEPARABLE_GAP_BELOW;
    }
}

/* The irradiance (W/m2) that a tool holds against its limit, got from nothing but its answers. */
static double held(enum asked tool, struct discussion d)
{
    double low = 0, high = 1e6;
    for (int i = 0; i < 200; i++) {
        double middle = 0.5 * (low + high);
        *(small(tool, d, middle, 0) ? &high : &low) = middle;
    }
    return high;
}

/* The larger of both limits holds, and a share is one of the scene's mean irradiance. */
static void limits(enum asked tool, struct discussion d, double value)
{
    struct host host = *d.host;
    host.irradiance = 3;
    d.host = &host;
    ck_assert_int_eq(small(tool, d, 0, 1.01 * value / 3), 1);
    ck_assert_int_eq(small(tool, d, 0, 0.99 * value / 3), 0);
    ck_assert_int_eq(small(tool, d, 1.01 * value, 0.5 * value / 3), 1);
    ck_assert_int_eq(small(tool, d, 0.5 * value, 1.01 * value / 3), 1);
    ck_assert_int_eq(small(tool, d, 0.99 * value, 0.99 * value / 3), 0);
}

/* Receiver: a square of side `wide` in z = 0; emitter: one of side `size` at (x, y, z), facing it.
 */
static void squares(struct element e[2], double wide, double size, double x, double y, double z,
                    double radiosity)
{
    lamp_square(&e[0], -0.5 * wide, -0.5 * wide, 0, wide, 0);
    lamp_square(&e[1], x - 0.5 * size, y - 0.5 * size, z, size, 1);
    e[1].radiosity = radiosity;
    e[0].id = 1;
    e[1].id = 2;
}

static struct discussion between(const struct element e[2], const struct host *host)
{
    struct discussion d;
    memset(&d, 0, sizeof d);
    d.receiver = &e[0];
    d.emitter = &e[1];
    d.host = host;
    return d;
}

/* Far and even: nothing bends. A lamp above a large receiver: it is the receiver that is to be
 * split. */
START_TEST(test_linear_gap)
{
    struct host host = {.area = 1, .irradiance = 1, .extent = 10};
    struct element e[2];
    squares(e, 1, 1, 0.3, 0.2, 30, 1000);
    struct discussion d = between(e, &host);
    double brought = 1000 / (M_PI * 900);
    ck_assert_double_le(held(LINEAR_GAP, d), 2e-3 * brought);
    squares(e, 4, 0.2, 0, 0, 0.5, 1000);
    d = between(e, &host);
    double f = held(LINEAR_GAP, d), above = 0.04 / (M_PI * 0.25); /* F below the lamp, about */
    ck_assert_int_eq(tool_linear_gap(&d, 0.5 * f, 0, INFINITY), LINEAR_GAP_RECEIVER);
    /* What others bring makes up for it, or for just not enough of it. */
    ck_assert_int_eq(tool_linear_gap(&d, 0.5 * f, 0, 0.5 * f), LINEAR_GAP_BALANCED);
    ck_assert_int_eq(tool_linear_gap(&d, 0.5 * f, 0, 0.51 * f), LINEAR_GAP_RECEIVER);
    e[1].deviation = 1000;
    ck_assert_int_eq(tool_linear_gap(&d, 1e-3 * f, 0, 0), LINEAR_GAP_EMITTER);
    e[1].deviation = 0;
    ck_assert_double_ge(f, 0.5 * 1000 * above);
    ck_assert_double_le(f, 1000 * above);
    limits(LINEAR_GAP, between(e, &host), f);
    /* Half of it is seen: half of it bends. */
    d = between(e, &host);
    d.terms.visibility = 0.5;
    d.terms.visibility_level = VISIBILITY_RAYS_16;
    ck_assert_double_eq_tol(held(LINEAR_GAP, d), 0.5 * f, 1e-6 * f);
    /* Linear over the receiver, whose radiosity is not even: F D (radius / distance)^2. */
    squares(e, 0.01, 0.5, 0, 0, 10, 1);
    e[1].deviation = 40;
    d = between(e, &host);
    ck_assert_double_eq_tol(held(LINEAR_GAP, d), 0.25 / (M_PI * 100) * 40 * 0.125 / 100,
                            0.01 * 0.25 / (M_PI * 100) * 40 * 0.125 / 100);
    ck_assert_int_eq(tool_linear_gap(&d, 1e-7, 0, INFINITY), LINEAR_GAP_EMITTER);
    e[1].deviation = 0;
    ck_assert_int_eq(tool_linear_gap(&d, 1e-6, 0, INFINITY), LINEAR_GAP_SMALL);
}
END_TEST

/* A lamp 1 mm from a large square, all of whose light falls between the points where F is sampled:
 * F's mean is the ratio of the areas, the samples see next to nothing. */
START_TEST(test_close)
{
    struct host host = {.area = 1, .irradiance = 1, .extent = 10};
    struct element e[2];
    squares(e, 4, 0.4, 0.9, 0.5, 1e-3, 100);
    struct discussion d = between(e, &host);
    double all = 100 * 0.16 / 16, f = held(LINEAR_GAP, d);
    printf("lamp 1 mm off: %.3g of the %.3g W/m2 that it brings are not linear\n", f, all);
    ck_assert_double_ge(f, 0.9 * all);
    ck_assert_double_le(f, 1.01 * all);
    ck_assert_int_eq(tool_linear_gap(&d, 0.5 * all, 0, INFINITY), LINEAR_GAP_RECEIVER);
}
END_TEST

/* F B sigma: 16 rays of which a quarter arrive, 4 that all do, none that was cast, and a shaft's
 * word; of groups with A / (pi d2) for F. What is uneven, likewise. */
START_TEST(test_noise)
{
    static const struct {
        double v;
        enum visibility_level level;
        double sigma, share;
    } known[] = {{0.25, VISIBILITY_RAYS_16, 0.10825317547305482, 0.25 + 1.0 / 16},
                 {1, VISIBILITY_RAYS_4, 0.25, 0.25},
                 {0, VISIBILITY_RAYS_64, 1.0 / 64, 1.0 / 64},
                 {0.7, VISIBILITY_RAYS_64, 0.05728219618694786, 0.3 + 1.0 / 64}};
    struct host host = {.area = 1, .irradiance = 1, .extent = 10};
    struct element e[2];
    squares(e, 1, 0.5, 0, 0, 10, 800);
    e[1].spread = 600;
    e[1].deviation = 150;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        struct discussion d = between(e, &host);
        d.terms.visibility = known[i].v;
        d.terms.visibility_level = (unsigned char)known[i].level;
        double far = 0.25 / (M_PI * 100), near = 0.25 / (M_PI * 100 + 0.25),
               off = fmin(600 * known[i].share, 150);
        ck_assert_double_eq_tol(held(TRANSFER_NOISE, d), near * 800 * known[i].sigma, 1e-9);
        ck_assert_double_eq_tol(held(CLUSTER_NOISE, d), far * 800 * known[i].sigma, 1e-9);
        ck_assert_double_eq_tol(held(UNEVEN, d), near * off, 1e-9);
        ck_assert_double_eq_tol(held(CLUSTER_UNEVEN, d), far * off, 1e-9);
        for (enum asked tool = UNEVEN; tool <= CLUSTER_UNEVEN; tool++)
            limits(tool, d, held(tool, d));
        d.terms.visibility = 1;
        d.terms.visibility_level = VISIBILITY_EXACT;
        for (enum asked tool = UNEVEN; tool <= CLUSTER_UNEVEN; tool++)
            ck_assert_int_eq(small(tool, d, 0, 0), 1);
    }
}
END_TEST

/* Two groups: SEPARABLE_ERROR r R / d2 of A B / (pi d2); near, where their spheres meet; dark. That
 * it is above the errors of links is check_separable_links' matter. */
START_TEST(test_separable_gap)
{
    struct host host = {.area = 1, .irradiance = 1, .extent = 10};
    struct element e[2];
    memset(e, 0, sizeof e);
    e[0].radius = 0.6;
    e[1].radius = 1.2;
    e[1].area = 3;
    e[1].radiosity = 50;
    e[1].centre[0] = 3;
    e[1].centre[2] = 4;
    struct discussion d = between(e, &host);
    double f = 3 * 50 / (M_PI * 25) * SEPARABLE_ERROR * 0.6 * 1.2 / 25;
    ck_assert_double_eq_tol(held(SEPARABLE_GAP, d), f, 1e-9);
    limits(SEPARABLE_GAP, d, f);
    ck_assert_int_eq(tool_separable_gap(&d, 0.9 * f, 0), SEPARABLE_GAP_ABOVE);
    e[1].black = 1;
    ck_assert_int_eq(tool_separable_gap(&d, 0, 0), SEPARABLE_GAP_DARK);
    e[1].black = 0;
    e[0].radius = 3.79;
    ck_assert_int_eq(tool_separable_gap(&d, 1e9, 0), SEPARABLE_GAP_BELOW);
    e[0].radius = 3.81;
    ck_assert_int_eq(tool_separable_gap(&d, 1e9, 0), SEPARABLE_GAP_NEAR);
}
END_TEST

/* What is known exactly is answered without a look at faces, which this host has not. */
START_TEST(test_shaft)
{
    struct host host = {.area = 1, .irradiance = 1, .extent = 10};
    struct element e[2];
    squares(e, 1, 0.5, 0, 0, 10, 800);
    struct discussion d = between(e, &host);
    ck_assert_int_eq(tool_shaft(&d), SHAFT_TOO_COMPLEX);
    d.terms.visibility = 1;
    d.terms.visibility_level = VISIBILITY_RAYS_64;
    ck_assert_int_eq(tool_shaft(&d), SHAFT_TOO_COMPLEX);
    d.terms.visibility_level = VISIBILITY_EXACT;
    ck_assert_int_eq(tool_shaft(&d), SHAFT_VISIBLE);
    d.terms.visibility = 0;
    ck_assert_int_eq(tool_shaft(&d), SHAFT_INVISIBLE);
    d.terms.visibility = 0.5; /* an integral over the part that is seen; no shaft says so */
    ck_assert_int_eq(tool_shaft(&d), SHAFT_TOO_COMPLEX);
}
END_TEST

/* Whole faces, and parts of them with a list from above or without. */
START_TEST(test_handed_down)
{
    struct host host = {.area = 1, .irradiance = 1, .extent = 10};
    struct blockers list = {.known = BLOCKERS_UNKNOWN};
    struct element e[2];
    squares(e, 1, 0.5, 0, 0, 10, 800);
    struct discussion d = between(e, &host);
    ck_assert_int_eq(tool_handed_down(&d), HANDED_DOWN_WHOLE);
    e[0].depth = 1;
    ck_assert_int_eq(tool_handed_down(&d), HANDED_DOWN_NONE);
    d.blockers = &list;
    ck_assert_int_eq(tool_handed_down(&d), HANDED_DOWN_NONE);
    list.known = BLOCKERS_INHERITED;
    ck_assert_int_eq(tool_handed_down(&d), HANDED_DOWN_LIST);
    list.known = BLOCKERS_UNKNOWN;
    d.terms.visibility_level = VISIBILITY_EXACT;
    ck_assert_int_eq(tool_handed_down(&d), HANDED_DOWN_LIST);
}
END_TEST

/* An empty box, lit by its ceiling: whole faces see each other whole, and so do all their parts.
 * Not a ray is cast. */
START_TEST(test_empty)
{
    struct scene scene;
    struct solve s;
    uint32_t m[6] = {0, 1, 0, 0, 0, 0};
    struct solve_options how = {.tolerance = 1e-5, .iterations = 100000, .threads = 2, .linear = 1};
    made_open(&scene);
    made_material(&scene, 0.5, 0);
    made_material(&scene, 0.5, 1);
    made_room(&scene, m, 4, 5, 2.5);
    solve_with(&s, &scene, "power", RELEASE_FLAT, NULL, how);
    ck_assert_uint_gt(s.refinement.link_count, 30);
    ck_assert_uint_eq(rays_count(s.problem.rays).rays, 0);
    ck_assert_double_le(fabs(s.report.absorbed / s.report.emitted - 1), 5e-3);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Finds at once the lists that tools leave for when pairs below want them. */
static atomic_long found_at_once;
static enum decision refine_eagerly(const void *state, struct discussion *d)
{
    const struct refiner *r = *(const struct refiner *const *)state;
    const enum decision decision = r->refine(r->state, d);
    if (d->blockers && d->blockers->wanted) {
        blockers_find(d->receiver, d->emitter, d->host, d->blockers);
        atomic_fetch_add(&found_at_once, 1);
    }
    return decision;
}

/* A list that is found when pairs below want it is the one that would have been found before: of
 * links that are discussed again and split, too. */
START_TEST(test_lists_wanted)
{
    for (unsigned seed = 1; seed <= 4; seed++) {
        struct scene scene;
        struct solve lazy, eager;
        struct refiner *r = oracles_open("power", RELEASE_FLAT), asking;
        ck_assert_ptr_nonnull(r);
        asking = *r;
        asking.refine = refine_eagerly;
        asking.wave = NULL;
        asking.state = &r;
        random_room(&scene, seed);
        solve_by(&lazy, &scene, r, 1);
        solve_by(&eager, &scene, &asking, 2);
        same_solves(&lazy, &eager);
        solve_close(&lazy);
        solve_close(&eager);
        made_close(&scene);
        refiner_close(r);
    }
    printf("%ld lists that were left for later, found at once: the same links\n",
           (long)found_at_once);
    ck_assert_int_gt(found_at_once, 100);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("power");
    TCase *c = tcase_create("power");
    tcase_set_timeout(c, 60);
    tcase_add_test(c, test_deviation);
    tcase_add_test(c, test_unevenness);
    tcase_add_test(c, test_light_visibility);
    tcase_add_test(c, test_linear_gap);
    tcase_add_test(c, test_close);
    tcase_add_test(c, test_noise);
    tcase_add_test(c, test_separable_gap);
    tcase_add_test(c, test_shaft);
    tcase_add_test(c, test_handed_down);
    tcase_add_test(c, test_empty);
    tcase_add_test(c, test_lists_wanted);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
