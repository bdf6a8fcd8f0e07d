/* check_separable_links.c - what two groups of faces exchange over links between them, against the
 * sum over all pairs of points of their faces.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "engine/pivots.h"
#include "engine/separable_links.h"
#include "engine/separable_sums.h"
#include "kernel/constants.h"
#include "kernel/lanes.h"
#include "suite.h"

enum { MOST = 400, POINTS = 4 };

static struct face faces[MOST];
static uint32_t faces_count;

static void quad(const double a[3], const double b[3], const double c[3], const double d[3])
{
    struct face *f = &faces[faces_count++];
    ck_assert_uint_le(faces_count, MOST);
    memset(f, 0, sizeof *f);
    memcpy(f->vertex[0], a, sizeof f->vertex[0]);
    memcpy(f->vertex[1], b, sizeof f->vertex[1]);
    memcpy(f->vertex[2], c, sizeof f->vertex[2]);
    memcpy(f->vertex[3], d, sizeof f->vertex[3]);
    f->vertices = 4;
}

/* An n x n grid over the parallelogram at o with sides u and v, moved by `at`. */
static void grid(int n, const double at[3], const double o[3], const double u[3], const double v[3])
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            double p[4][3];
            for (int k = 0; k < 4; k++)
                for (int c = 0; c < 3; c++)
                    p[k][c] =
                        at[c] + o[c]
                        + ((i + (k == 1 || k == 2)) * u[c] + (j + (k == 2 || k == 3)) * v[c]) / n;
            quad(p[0], p[1], p[2], p[3]);
        }
}

/* Bodies about `at`, the largest about 1 across: a box, an inner corner, a plate, a plate that
 * is only one face, and a small face. */
enum { BOX, CORNER, PLATE, SLAB, SPECK, BODIES };
static const char *const body_name[BODIES] = {"box", "corner", "plate", "slab", "speck"};

static void body(int which, const double at[3], int mirrored)
{
    const double m = mirrored ? -1 : 1;
    if (which == BOX) {
        for (int k = 0; k < 3; k++) {
            double o[3] = {-0.3, -0.3, -0.3}, p[3] = {0.3, 0.3, 0.3}, u[3] = {0}, v[3] = {0},
                   w[3] = {0}, x[3] = {0};
            u[(k + 1) % 3] = v[(k + 2) % 3] = 0.6;
            w[(k + 1) % 3] = x[(k + 2) % 3] = -0.6;
            grid(4, at, o, v, u); /* normals outwards */
            grid(4, at, p, w, x);
        }
    } else if (which == CORNER) { /* opens towards m (1, 1, 0) */
        grid(6, at, (double[3]){-0.25 * m, -0.25 * m, -0.25}, (double[3]){0, 0.5 * m, 0},
             (double[3]){0, 0, 0.5});
        grid(6, at, (double[3]){-0.25 * m, -0.25 * m, -0.25}, (double[3]){0, 0, 0.5},
             (double[3]){0.5 * m, 0, 0});
    } else {
        const double s = which == SPECK ? 0.01 : 0.6;
        const int n = which == PLATE ? 6 : 1;
        grid(n, at, (double[3]){0, -0.5 * s * m, -0.5 * s}, (double[3]){0, s * m, 0},
             (double[3]){-0.3 * s * m, 0, s});
    }
}

/* A_j F_ji pi of two faces, not looking at what stands between; midpoints of POINTS x POINTS
 * parts of each. */
static double pair(const struct element *a, const struct element *b)
{
    double sum = 0, p[2][POINTS * POINTS][3];
    for (int e = 0; e < 2; e++)
        for (int i = 0; i < POINTS * POINTS; i++)
            for (int k = 0; k < 3; k++) {
                const double(*v)[3] = (e ? b : a)->vertex;
                p[e][i][k] = v[0][k] + (i / POINTS + 0.5) / POINTS * (v[1][k] - v[0][k])
                             + (i % POINTS + 0.5) / POINTS * (v[3][k] - v[0][k]);
            }
    for (int i = 0; i < POINTS * POINTS; i++)
        for (int j = 0; j < POINTS * POINTS; j++) {
            double v[3];
            sub3(v, p[1][j], p[0][i]);
            double near = dot3(a->normal, v);
            double far = -dot3(b->normal, v);
            double square = dot3(v, v);
            sum += near > 0 && far > 0 ? near * far / (square * square) : 0;
        }
    return sum * a->area * b->area / (POINTS * POINTS * POINTS * POINTS);
}

/* The elements that hold faces from `first` to `last` - 1 only, and whose parents hold others,
 * too. */
static int tops(const struct hierarchy *h, uint32_t first, uint32_t last, uint32_t *list)
{
    int n = 0;
    for (uint32_t e = 1; e < h->built; e++) {
        int all = 1, above = 1;
        const struct face_range own = h->range[e], up = h->range[h->elements[e].parent];
        for (uint32_t i = own.from; i < own.to; i++)
            all &= h->order[i] >= first && h->order[i] < last;
        for (uint32_t i = up.from; i < up.to; i++)
            above &= h->order[i] >= first && h->order[i] < last;
        if (all && !above)
            list[n++] = e;
    }
    return n;
}

/* Of a link, times the receiver's area (m2): A B / (pi d2) times r R / d2, which separable_gap
 * takes SEPARABLE_ERROR times, and times (r + R) / d. Infinite where their spheres meet. */
struct gap {
    double second, first;
};

static void gap_add(struct gap *g, const struct element *r, const struct element *s)
{
    double v[3], reach = r->radius + s->radius;
    sub3(v, s->centre, r->centre);
    double square = dot3(v, v), point = r->area * s->area / (3.14159265358979323846 * square);
    g->second += square > reach * reach ? point * r->radius * s->radius / square : INFINITY;
    g->first += point * reach / sqrt(square);
}

/* Link all of the first `receivers` faces to all of the others. What arrives (times pi, m2), what
 * should, the sum of the differences by face, and the gaps of all links. */
static void link_gaps(uint32_t receivers, double *got, double *should, double *differ,
                      struct gap *gap)
{
    struct hierarchy h;
    uint32_t r_list[MOST], s_list[MOST];
    /* faces that the builder put beside the other body's: a link between two of them is not
     * separable */
    unsigned char alone[MOST] = {0};
    double sum = 0, truth = 0, off = 0;
    ck_assert_int_eq(hierarchy_build(&h, faces, faces_count), 0);
    for (uint32_t i = 0; i < h.count; i++)
        h.elements[i].radiosity = 1;
    int n = tops(&h, 0, receivers, r_list);
    int m = tops(&h, receivers, faces_count, s_list);
    ck_assert_int_gt(n * m, 0);
    for (int k = 0; k < n + m; k++) {
        const struct element *e = &h.elements[k < n ? r_list[k] : s_list[k - n]];
        if (e->vertices)
            alone[e->face] = 1;
    }
    struct refinement r;
    memset(&r, 0, sizeof r);
    r.links = calloc((size_t)(n * m), sizeof *r.links);
    r.first_link = calloc((size_t)h.count + 1, sizeof *r.first_link);
    memset(gap, 0, sizeof *gap);
    for (uint32_t i = 0; i < h.count; i++) {
        r.first_link[i] = r.link_count;
        for (int a = 0; a < n; a++)
            for (int b = 0; b < m && r_list[a] == i; b++) {
                r.links[r.link_count++] =
                    (struct link){.receiver = i, .emitter = s_list[b], .visibility = LINK_VISIBLE};
                gap_add(gap, &h.elements[i], &h.elements[s_list[b]]);
            }
    }
    r.first_link[h.count] = r.link_count;
    struct separable_links light;
    ck_assert_int_eq(
        separable_links_open(&light, &h, &r, 1, 1, 0, (struct face_range){0, h.face_count}), 0);
    for (uint32_t i = 0; i < receivers; i++) {
        const struct element *x = hierarchy_surface(&h, i);
        double row = x->area * separable_links_row(&light, h.face_element[i]), known = 0;
        for (uint32_t j = receivers; j < faces_count; j++)
            known += alone[i] && alone[j]
                         ? 0
                         : pair(x, hierarchy_surface(&h, j)) / 3.14159265358979323846;
        sum += row;
        truth += known;
        off += fabs(row - known);
    }
    *got = sum;
    *should = truth;
    *differ = off;
    separable_links_close(&light);
    free(r.links);
    free(r.first_link);
    hierarchy_free(&h);
}

static void link_all(uint32_t receivers, double *got, double *should, double *differ)
{
    struct gap gap;
    link_gaps(receivers, got, should, differ, &gap);
}

/* Two bodies. What arrives over the truth, less 1: in all, and summed over the faces without
 * regard to sign. */
static void exchange(int receiver, int emitter, double distance, const double towards[3],
                     double *total, double *mean)
{
    double at[3];
    faces_count = 0;
    body(receiver, (double[3]){0, 0, 0}, 0);
    uint32_t receivers = faces_count;
    for (int k = 0; k < 3; k++)
        at[k] = distance * towards[k];
    body(emitter, at, 1);
    double got, should, differ;
    link_all(receivers, &got, &should, &differ);
    *total = got / should - 1;
    *mean = differ / should;
}

/* The error is of second order in size over distance, whatever the shapes; a side that is small
 * makes the other's size harmless. */
START_TEST(test_exchange)
{
    static const double directions[3][3] = {{1, 0, 0}, {0.8, 0.6, 0}, {0.72, 0.48, 0.50119856344}};
    /* in all, over the faces; near, far */
    static const double limit[2][2] = {{0.05, 0.002}, {0.055, 0.0025}};
    int receiver = _i / BODIES, emitter = _i % BODIES;
    if (receiver >= SLAB && emitter >= SLAB)
        return; /* two surfaces are no matter of groups */
    for (int d = 0; d < 3; d++) {
        double total[2], mean[2];
        exchange(receiver, emitter, 1.5, directions[d], &total[0], &mean[0]);
        exchange(receiver, emitter, 4, directions[d], &total[1], &mean[1]);
        printf("%s from %s, direction %d: %+.1e %+.1e in all, %.1e %.1e by face\n",
               body_name[receiver], body_name[emitter], d, total[0], total[1], mean[0], mean[1]);
        fflush(stdout);
        ck_assert_double_le(fabs(total[0]), limit[0][0]);
        ck_assert_double_le(fabs(total[1]), limit[0][1]);
        ck_assert_double_le(mean[0], limit[1][0]);
        ck_assert_double_le(mean[1], limit[1][1]);
        if (receiver == SPECK || emitter == SPECK)
            ck_assert_double_le(mean[0], 5e-4);
    }
}
END_TEST

/* SEPARABLE_ERROR is above the error of all pairs of bodies, from spheres that all but touch to far
 * off, in 26 directions. Where one lies on the other's horizon, the cosine's edge leaves a part of
 * the first order, 2.5e-3 (r + R) / d, which shows only beside a body that is small: there second
 * order is next to nothing. */
START_TEST(test_constant)
{
    static const double distances[] = {1.02, 1.3, 1.6, 2, 3, 5, 8};
    double worst = 0;
    int above = 0, pairs = 0;
    for (int d = 0; d < (int)(sizeof distances / sizeof *distances); d++) {
        double most[2] = {0, 0}; /* like sizes; a speck and a body */
        for (int k = 0; k < BODIES * BODIES * 27; k += thorough() ? 1 : 7) {
            int receiver = k / 27 / BODIES, emitter = k / 27 % BODIES;
            int speck = receiver == SPECK || emitter == SPECK;
            double towards[3] = {k % 3 - 1, k / 3 % 3 - 1, k / 9 % 3 - 1}, size = length3(towards),
                   at[3], got, should, differ;
            struct gap gap;
            if ((receiver >= SLAB && emitter >= SLAB) || !(size > 0))
                continue;
            faces_count = 0;
            body(receiver, (double[3]){0, 0, 0}, 0);
            uint32_t receivers = faces_count;
            for (int c = 0; c < 3; c++)
                at[c] = distances[d] * towards[c] / size;
            body(emitter, at, 1);
            link_gaps(receivers, &got, &should, &differ, &gap);
            if (!isfinite(gap.second))
                continue;
            most[speck] = fmax(most[speck], differ / gap.second);
            ck_assert_double_le(differ,
                                SEPARABLE_ERROR * gap.second + (speck ? 2.5e-3 * gap.first : 0));
            above += differ > SEPARABLE_ERROR * gap.second;
            pairs++;
        }
        printf("distance %g: %.3g, %.3g beside a speck\n", distances[d], most[0], most[1]);
        fflush(stdout);
        worst = fmax(worst, most[0]);
    }
    printf("above SEPARABLE_ERROR: %d of %d\n", above, pairs);
    fflush(stdout);
    ck_assert_double_ge(worst, 0.5 * SEPARABLE_ERROR); /* nor is it larger than need be */
    ck_assert_int_le(100 * above, 2 * pairs);
}
END_TEST

/* Walls of many faces in one plane, but for rounding, or by less than any ray would notice: nothing
 * is exchanged, and no number overflows for all that is nearly 0. The emitter faces as the receiver
 * does (0), the other way (1), or lies on edge in its plane (2). */
START_TEST(test_grazing)
{
    static const double apart[] = {0, 1e-300, 1e-40, 1e-20, 1e-17, 1e-12, 1e-9, -1e-17, -1e-9};
    for (size_t i = 0; i < sizeof apart / sizeof *apart; i++) {
        const double at[3] = {2.5, 0.1, apart[i]}, x[3] = {1, 0, 0}, y[3] = {0, 1, 0},
                     z[3] = {0, 0, -1};
        faces_count = 0;
        grid(9, (double[3]){0, 0, 0}, (double[3]){0, 0, 0}, x, y);
        uint32_t receivers = faces_count;
        grid(9, at, (double[3]){0, 0, 0}, _i == 0 ? x : y, _i == 0 ? y : _i == 1 ? x : z);
        double got, should, differ;
        link_all(receivers, &got, &should, &differ);
        ck_assert(isfinite(got));
        ck_assert_double_le(differ, 1e-7);
    }
}
END_TEST

/* A terrace whose mean normal is turned square to a box below its level: 12 squares lean away from
 * it, 18 look up past it, and 6 look at it. The box lies wholly behind the plane that the terrace
 * has in the mean, yet light passes. */
START_TEST(test_on_edge)
{
    const double s = 0.08, slope = sqrt(1.09);
    faces_count = 0;
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) {
            const double at[3] = {0.1 * i - 0.25, 0.1 * j - 0.25, 0}, across[3] = {0, s, 0};
            double along[3] = {s, 0, 0}, corner[3];
            if (i < 2) { /* normal (-1, 0, 0.3) / slope */
                along[0] = 0.3 * s / slope;
                along[2] = s / slope;
            } else if (i == 5) {
                along[0] = 0;
                along[2] = -s;
            }
            for (int k = 0; k < 3; k++)
                corner[k] = -0.5 * (along[k] + across[k]);
            grid(1, at, corner, along, across);
        }
    uint32_t receivers = faces_count;
    body(BOX, (double[3]){1.2, 0, -0.37}, 0);
    double got, should, differ;
    link_all(receivers, &got, &should, &differ);
    printf("on edge: %+.1e in all, %.1e by face\n", got / should - 1, differ / should);
    ck_assert_double_le(fabs(got / should - 1), 0.015);
    ck_assert_double_le(differ / should, 0.015);
}
END_TEST

/* Two sides with one centre pass what they do where the centres all but meet. */
START_TEST(test_one_centre)
{
    static const double apart[] = {1e-5, 1e-9, 1e-16, 1e-25, 1e-300, 0};
    enum { PLACES = sizeof apart / sizeof *apart };
    struct hierarchy h;
    struct refinement r;
    struct separable_links light;
    struct pivot pivot[PLACES][2];
    float passes[PLACES];
    faces_count = 0;
    body(CORNER, (double[3]){0, 0, 0}, 0);
    ck_assert_int_eq(hierarchy_build(&h, faces, faces_count), 0);
    memset(&r, 0, sizeof r);
    struct link link = {.visibility = LINK_VISIBLE}; /* of all with itself */
    r.links = &link;
    r.link_count = 1;
    r.first_link = malloc(((size_t)h.count + 1) * sizeof *r.first_link);
    for (uint32_t i = 0; i <= h.count; i++)
        r.first_link[i] = i > 0;
    for (uint32_t i = 0; i < h.count; i++)
        h.elements[i].radiosity = 1;
    ck_assert_int_eq(
        separable_links_open(&light, &h, &r, 1, 1, 0, (struct face_range){0, h.face_count}), 0);
    for (int i = 0; i < PLACES; i++) {
        struct element receiver = h.elements[0], emitter = h.elements[0];
        struct separable_side side;
        for (int k = 0; k < 3; k++)
            receiver.centre[k] = emitter.centre[k] = 0;
        emitter.centre[2] = apart[i];
        separable_side_whole(&side, &light.faces, 0, h.face_count);
        passes[i] = find_pivots(&pivot[i][0], &pivot[i][1], &receiver, &emitter, &side, &side);
        ck_assert_msg(passes[i] > 0 && isfinite(passes[i]), "%g apart: %g", apart[i],
                      (double)passes[i]);
        for (int e = 0; e < 2; e++)
            for (int k = 0; k < 3; k++) {
                ck_assert_float_eq_tol(pivot[i][e].centre[k], pivot[0][e].centre[k], 1e-3f);
                ck_assert_float_eq_tol(pivot[i][e].normal[k], pivot[0][e].normal[k], 1e-3f);
            }
    }
    separable_links_close(&light);
    free(r.first_link);
    hierarchy_free(&h);
}
END_TEST

/* Sums over faces from .. to - 1, against those of one face after the other in double precision;
 * with vectors of any width the same bits, and nothing of faces outside. */
START_TEST(test_sums)
{
    enum { FACES = 40, BANDS = 3, ARRAYS = SEPARABLE_ARRAYS + BANDS };
    static float at[ARRAYS * FACES + SEPARABLE_SPARE];
    struct separable_faces f;
    struct pivot pivot = {{0.5f, 0.4f, 0.9f}, {0, 0.6f, -0.8f}, 0.01f};
    separable_faces_arrays(&f, at, FACES, BANDS);
    uint32_t seed = 1;
    for (size_t i = 0; i < ARRAYS * FACES; i++) {
        seed = seed * 1664525u + 1013904223u;
        at[i] = (float)(seed >> 8) * 0x1p-24f * (i < 3 * FACES || i >= 12 * FACES ? 1 : 0.1f);
    }
    const float *const sent[3] = {f.sent[0], f.sent[1], f.sent[2]};
    const float arrives[BANDS] = {1, 2, 0.5f};
    for (size_t from = 0; from < 11; from++)
        for (size_t to = from; to <= FACES; to++)
            for (int centres = 0; centres < 2; centres++) {
                float sum[3][BANDS] = {{0}}, received[3][BANDS * FACES] = {{0}};
                for (int w = 0; w < 3; w++) {
                    const int width = w < 2 ? 1 + 3 * w : 8;
                    const struct separable_sum s = {
                        &f,      &pivot, from,
                        to,      BANDS,  width < lanes_width() ? width : lanes_width(),
                        centres,
                    };
                    separable_sum_sent(&s, sent, sum[w]);
                    separable_sum_received(&s, arrives, received[w], FACES);
                }
                ck_assert_mem_eq(sum[1], sum[0], sizeof *sum);
                ck_assert_mem_eq(sum[2], sum[0], sizeof *sum);
                ck_assert_mem_eq(received[1], received[0], sizeof *received);
                ck_assert_mem_eq(received[2], received[0], sizeof *received);
                for (int k = 0; k < BANDS; k++) {
                    double expected = 0;
                    for (size_t i = 0; i < FACES; i++) {
                        const float one = i < from || i >= to ? 0
                                          : centres ? separable_kernel_at_centre(&f, i, &pivot)
                                                    : separable_kernel(&f, i, &pivot);
                        expected += (double)sent[k][i] * (double)one;
                        ck_assert_float_eq(received[0][k * FACES + (int)i], arrives[k] * one);
                    }
                    ck_assert_double_le(fabs((double)sum[0][k] - expected), 1e-6 * expected);
                }
            }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("separable links");
    TCase *c = tcase_create("separable links");
    tcase_set_timeout(c, 300);
    tcase_add_loop_test(c, test_exchange, 0, BODIES * BODIES);
    tcase_add_test(c, test_constant);
    tcase_add_test(c, test_sums);
    tcase_add_loop_test(c, test_grazing, 0, 3);
    tcase_add_test(c, test_on_edge);
    tcase_add_test(c, test_one_centre);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
