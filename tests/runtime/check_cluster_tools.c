/* check_cluster_tools.c - the questions about groups of faces, alpha_gap, dominates, self,
 * receiver_size, and the sum of facing areas: against closed forms, and on random trees against
 * what all faces below say; in every unit of length and of light, compiled and interpreted alike.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
#include "runtime/make_pair.h"
#include "runtime/make_solve.h"
#include "oracles.h"
#include "command.h"
#include "folder.h"
#include "suite.h"
#include "kernel/cluster_facing.h"
#include "tools/alpha_gap.h"
#include "tools/cluster_gap.h"
#include "tools/dominates.h"
#include "tools/receiver_size.h"
#include "tools/self.h"

/* ---- elements by hand: a forest in one array, as the hierarchy keeps it */

struct forest {
    struct element element[64];
    const struct element *elements;
    uint32_t count;
    struct host host;
};

static void forest_open(struct forest *f)
{
    memset(f, 0, sizeof *f);
    f->elements = f->element;
    f->host.elements = &f->elements;
    f->host.irradiance = 1;
    f->host.extent = 1;
    f->count = 1; /* child 0 means none */
}

/* A square with its normal along an axis of space or anywhere, by centre and area. Tools of this
 * suite ask no corner. */
static struct element *square(struct forest *f, double x, double y, double z, double nx, double ny,
                              double nz, double area, double radiosity)
{
    struct element *e = &f->element[f->count];
    double length = sqrt(nx * nx + ny * ny + nz * nz);
    const double centre[3] = {x, y, z}, normal[3] = {nx / length, ny / length, nz / length};
    memcpy(e->centre, centre, sizeof centre);
    memcpy(e->normal, normal, sizeof normal);
    e->cone = 1;
    e->area = area;
    e->radius = sqrt(area / 2);
    e->vertices = 4;
    e->radiosity = radiosity;
    e->id = f->count++;
    return e;
}

/* A cluster of the elements from `child` on; its cone holds every direction. */
static struct element *cluster(struct forest *f, uint32_t child, uint32_t children, double x,
                               double y, double z, double radius)
{
    struct element *e = &f->element[f->count];
    const double centre[3] = {x, y, z};
    memcpy(e->centre, centre, sizeof centre);
    e->normal[2] = 1;
    e->cone = -1;
    e->radius = radius;
    e->child = child;
    e->children = (uint8_t)children;
    e->black = 1;
    for (uint32_t i = child; i < child + children; i++) {
        e->area += f->element[i].area;
        e->radiosity += f->element[i].area * f->element[i].radiosity;
        e->black &= f->element[i].black;
    }
    e->radiosity /= e->area;
    e->id = f->count++;
    return e;
}

/* The six sides of a cube around the origin, seen from outside, as one cluster. */
static struct element *cube(struct forest *f, double radiosity)
{
    uint32_t from = f->count;
    for (int k = 0; k < 6; k++) {
        double n[3] = {0, 0, 0};
        n[k / 2] = k % 2 ? -1 : 1;
        square(f, 0.5 * n[0], 0.5 * n[1], 0.5 * n[2], n[0], n[1], n[2], 1, radiosity);
    }
    return cluster(f, from, 6, 0, 0, 0, sqrt(0.75));
}

static struct discussion between(const struct forest *f, const struct element *r,
                                 const struct element *s)
{
    struct discussion d;
    memset(&d, 0, sizeof d);
    d.receiver = r;
    d.emitter = s;
    d.host = &f->host;
    return d;
}

/* What cluster_gap holds against its limit: the emitter's intensity A B / pi times the range of
 * 1/d2. */
static double beta(const struct element *r, const struct element *s)
{
    double v[3], a = r->radius + s->radius;
    sub3(v, s->centre, r->centre);
    double d = length3(v);
    return s->area * s->radiosity / M_PI * (1 / ((d - a) * (d - a)) - 1 / ((d + a) * (d + a)));
}

/* alpha_gap's number, got from nothing but its answers. */
static double alpha_answers(const struct forest *f, const struct element *r,
                            const struct element *s)
{
    double low = 0, high = 1e6;
    for (int i = 0; i < 200; i++) {
        struct discussion d = between(f, r, s);
        double middle = 0.5 * (low + high);
        if (tool_alpha_gap(&d, middle, 0) == ALPHA_GAP_ABOVE)
            low = middle;
        else
            high = middle;
    }
    return high;
}

/* ---- alpha_gap */

/* Two unit squares at distance d: face to face what cluster_gap says, to rounding; with one, or
 * both, at 60 degrees its cosine and the sine of how far directions between them may differ; 0 back
 * to back. */
START_TEST(test_squares)
{
    const double d = 64, slope = sqrt(2) / d, half = 0.5 + slope, aside = sqrt(0.75);
    static struct forest f;
    forest_open(&f);
    struct element *front = square(&f, 0, 0, 0, 0, 0, 1, 1, 3);
    struct element *back = square(&f, 0, 0, d, 0, 0, 1, 1, 3);
    struct element *tilted = square(&f, 0, 0, 0, aside, 0, 0.5, 1, 3);
    struct element *other = square(&f, 0, 0, d, 0, 0, -1, 1, 3);
    ck_assert_double_eq_tol(alpha_answers(&f, front, other) / beta(front, other), 1, 1e-14);
    ck_assert_double_eq_tol(alpha_answers(&f, tilted, other) / beta(front, other), half, 1e-14);
    ck_assert_double_eq_tol(alpha_answers(&f, other, tilted) / beta(front, other), half, 1e-14);
    square(&f, 0, 0, d, aside, 0, -0.5, 1, 3);
    ck_assert_double_eq_tol(alpha_answers(&f, tilted, &f.element[f.count - 1]) / beta(front, other),
                            half * half, 1e-14);
    ck_assert(alpha_answers(&f, back, front) < 1e-50); /* the one turns its back; 1e6 / 2^200 */
    ck_assert(alpha_answers(&f, front, back) < 1e-50);
}
END_TEST

/* The cube as a cluster: seen along an axis one side of six and a sliver of four; along a
 * diagonal three sides at 1/sqrt(3). */
START_TEST(test_cube)
{
    static struct forest f;
    double d = 256;
    forest_open(&f);
    struct element *box = cube(&f, 2);
    struct element *along = square(&f, d, 0, 0, -1, 0, 0, 1, 5);
    struct element *across = square(&f, d, d, d, -1, -1, -1, 1, 5);
    double slope = (box->radius + along->radius) / d;
    ck_assert_double_eq_tol(alpha_answers(&f, box, along) / beta(box, along), (1 + 4 * slope) / 6,
                            1e-14);
    ck_assert_double_eq_tol(alpha_answers(&f, along, box) / beta(along, box), (1 + 4 * slope) / 6,
                            1e-14);
    slope /= sqrt(3);
    ck_assert_double_eq_tol(alpha_answers(&f, box, across) / beta(box, across),
                            3 * (1 / sqrt(3) + slope) / 6, 1e-14);
    ck_assert_double_eq_tol(alpha_answers(&f, across, box) / beta(across, box),
                            3 * (1 / sqrt(3) + slope) / 6, 1e-14);
}
END_TEST

/* Nothing to send, nothing to receive on, one and the same place, dark hosts: an answer, and
 * never a number that is none. */
START_TEST(test_nothing)
{
    static struct forest f;
    double axis[3] = {0, 0, 8};
    forest_open(&f);
    struct element *dark = square(&f, 0, 0, 8, 0, 0, -1, 1, 0);
    struct element *lit = square(&f, 0, 0, 0, 0, 0, 1, 1, 2);
    struct element *same = square(&f, 0, 0, 0, 0, 0, 1, 1, 2);
    struct element *none = square(&f, 0, 0, 0, 0, 0, 1, 0, 2);
    struct element *pair = cluster(&f, f.count - 3, 2, 0, 0, 0, 1);
    ck_assert(alpha_gap_range(lit, dark, f.element, axis) <= 0);
    ck_assert(alpha_gap_range(none, lit, f.element, axis) <= 0);
    axis[2] = 0;
    ck_assert(isinf(alpha_gap_range(lit, same, f.element, axis)));
    ck_assert(isinf(alpha_gap_range(none, none, f.element, axis)));
    ck_assert(isinf(alpha_gap_range(pair, pair, f.element, axis)));
    struct discussion d;
    d = between(&f, lit, dark);
    ck_assert_int_eq(tool_alpha_gap(&d, 0, 0), ALPHA_GAP_BELOW);
    d = between(&f, lit, same);
    ck_assert_int_eq(tool_alpha_gap(&d, 1e300, 0), ALPHA_GAP_ABOVE);
    f.host.irradiance = 0;
    ck_assert_int_eq(tool_alpha_gap(&d, 1e300, 1e300), ALPHA_GAP_ABOVE);
    /* A host without clusters. */
    f.host.elements = NULL;
    f.host.irradiance = 1;
    lit->centre[2] = -8;
    d = between(&f, lit, same);
    ck_assert_int_eq(tool_alpha_gap(&d, 0, 0), ALPHA_GAP_BELOW); /* the one is behind the other */
    ck_assert_int_eq(tool_dominates(&d, 0.5), DOMINATES_BOTH);
    ck_assert_int_eq(tool_self(&d), SELF_OTHER);
}
END_TEST

/* ---- random trees: the hierarchy's own, each face with light of its own */

static double random_light(struct hierarchy *h, uint32_t e, unsigned *state)
{
    struct element *x = &h->elements[e];
    double sum = 0;
    if (x->vertices) {
        double u = random_unit(state);
        x->radiosity = u < 0.5 ? 0 : pow(u, 16) * 100; /* half are dark, few are bright */
        return x->area * x->radiosity;
    }
    for (uint32_t i = 0; i < x->children; i++)
        sum += random_light(h, x->child + i, state);
    x->radiosity = sum / x->area;
    return sum;
}

/* Quads with any orientation (0), with much the same one (1), or the walls of small boxes (2). */
static void random_scene(struct scene *s, int kind, unsigned *state)
{
    made_open(s);
    made_material(s, 0.5, 1);
    for (int i = 0; i < 120; i++) {
        double o[3], u[3], v[3], n[3];
        for (int k = 0; k < 3; k++) {
            o[k] = 10 * random_unit(state);
            u[k] = random_unit(state) - 0.5;
            v[k] = random_unit(state) - 0.5;
        }
        if (kind == 1) {
            for (int k = 0; k < 3; k++) {
                u[k] = 0.3 * u[k] + (k == 0);
                v[k] = 0.3 * v[k] + (k == 1);
            }
        }
        if (kind < 2) {
            made_quad(s, 0, o[0], o[1], o[2], u[0], u[1], u[2], v[0], v[1], v[2]);
            continue;
        }
        cross3(n, u, v);
        for (int j = 0; j < 2; j++) {
            made_quad(s, 0, o[0], o[1], o[2], v[0], v[1], v[2], u[0], u[1], u[2]);
            made_quad(s, 0, o[0], o[1], o[2], u[0], u[1], u[2], n[0], n[1], n[2]);
            made_quad(s, 0, o[0], o[1], o[2], n[0], n[1], n[2], v[0], v[1], v[2]);
            for (int k = 0; k < 3; k++) {
                double last = u[k];
                /* the opposite corner: mirrored, and so turned out again */
                o[k] += u[k] + v[k] + n[k];
                u[k] = -v[k];
                v[k] = -last;
                n[k] = -n[k];
            }
        }
    }
}

struct random_tree {
    struct scene scene;
    struct hierarchy h;
    const struct element *elements;
    struct host host;
};

static void tree_open(struct random_tree *t, int kind, unsigned *state)
{
    random_scene(&t->scene, kind, state);
    ck_assert_int_eq(hierarchy_build(&t->h, t->scene.faces, t->scene.face_count), 0);
    random_light(&t->h, 0, state);
    memset(&t->host, 0, sizeof t->host);
    t->elements = t->h.elements;
    t->host.elements = &t->elements;
    t->host.irradiance = 1;
    t->host.extent = 10;
}

static void tree_close(struct random_tree *t)
{
    hierarchy_free(&t->h);
    made_close(&t->scene);
}

static uint32_t any(const struct random_tree *t, unsigned *state)
{
    return (uint32_t)(random_unit(state) * t->h.count);
}

static struct discussion tree_pair(const struct random_tree *t, unsigned *state)
{
    struct discussion d;
    memset(&d, 0, sizeof d);
    d.receiver = &t->elements[any(t, state)];
    d.emitter = &t->elements[any(t, state)];
    d.host = &t->host;
    return d;
}

/* Of all faces below e: the area that faces w; or the largest power of one. */
static double facing_faces(const struct element *all, const struct element *e, const double w[3])
{
    double sum = 0;
    if (e->vertices)
        return e->area * fmax(0, dot3(e->normal, w));
    for (uint32_t i = 0; i < e->children; i++)
        sum += facing_faces(all, &all[e->child + i], w);
    return sum;
}

static double brightest_face(const struct element *all, const struct element *e)
{
    double most = 0;
    if (e->vertices)
        return e->area * e->radiosity;
    for (uint32_t i = 0; i < e->children; i++)
        most = fmax(most, brightest_face(all, &all[e->child + i]));
    return most;
}

/* Are a cluster's children all faces? */
static int lowest(const struct element *all, const struct element *e)
{
    uint32_t i;
    for (i = 0; i < e->children && all[e->child + i].vertices; i++)
        ;
    return !e->vertices && i == e->children;
}

/* The area that may face a direction is no less than what the faces show to it; to directions
 * beside it by sine s, no less than sqrt(1 - s2) of that. By faces it is never more than by their
 * cluster. (A cluster's cone may reach out of the one above.) */
START_TEST(test_facing)
{
    unsigned state = 11 + (unsigned)_i;
    double least = 2, less = 0;
    struct random_tree t;
    tree_open(&t, _i, &state);
    int i;
    for (i = 0; i < 20000; i++) {
        const struct element *e = &t.elements[any(&t, &state)];
        double v[3], aside[3], w[3], slope = i % 2 ? 2.0 / 3 * random_unit(&state) : 0;
        for (int k = 0; k < 3; k++) {
            v[k] = random_unit(&state) - 0.5;
            w[k] = random_unit(&state) - 0.5;
        }
        double size = length3(v);
        for (int k = 0; k < 3; k++)
            v[k] /= size;
        cross3(aside, v, w);
        size = length3(aside);
        double sine = slope * (i % 4 == 1 ? 1 : random_unit(&state));
        for (int k = 0; k < 3; k++)
            w[k] = sqrt(1 - sine * sine) * v[k] + sine * aside[k] / size;
        double whole = cluster_facing(e, v, slope);
        double parts = cluster_facing_parts(e, t.elements, v, slope);
        double shown = facing_faces(t.elements, e, w);
        ck_assert(parts <= e->area * (1 + 1e-12) && whole <= e->area);
        ck_assert(parts >= sqrt(1 - slope * slope) * shown - 1e-12 * e->area);
        /* cones are known to rounding */
        ck_assert(!lowest(t.elements, e) || parts <= whole + 1e-6 * e->area);
        if (parts > 0) {
            least = fmin(least, shown / parts);
            less += parts < 0.999 * whole;
        }
    }
    printf("facing areas: down to %.2f of the bound; by children less than by the whole in %.0f of "
           "%d\n",
           least, less, i);
    ck_assert(less > 1000);
    tree_close(&t);
}
END_TEST

/* alpha_gap's number is cluster_gap's at the most, so what that finds below this does, too; near
 * is above. */
START_TEST(test_below_beta)
{
    unsigned state = 21 + (unsigned)_i;
    int near = 0, above = 0, better = 0;
    struct random_tree t;
    tree_open(&t, _i, &state);
    int i;
    for (i = 0; i < 20000; i++) {
        struct discussion d = tree_pair(&t, &state);
        double limit = random_size(&state, 1e3),
               range = alpha_gap_range(d.receiver, d.emitter, t.elements, term_axis(&d));
        enum cluster_gap_answer b = tool_cluster_gap(&d, 0, limit);
        enum alpha_gap_answer a = tool_alpha_gap(&d, 0, limit);
        if (b == CLUSTER_GAP_DARK)
            continue;
        ck_assert(!isnan(range) && range >= 0);
        ck_assert_int_eq(a, range > limit ? ALPHA_GAP_ABOVE : ALPHA_GAP_BELOW);
        ck_assert_int_eq(a, tool_alpha_gap(&d, limit, 0.5 * limit)); /* the larger of the two */
        if (b == CLUSTER_GAP_NEAR) {
            ck_assert_int_eq(a, ALPHA_GAP_ABOVE);
            near++;
            continue;
        }
        ck_assert(range <= beta(d.receiver, d.emitter) * (1 + 1e-12));
        ck_assert(b == CLUSTER_GAP_ABOVE || a == ALPHA_GAP_BELOW);
        above += b == CLUSTER_GAP_ABOVE;
        better += b == CLUSTER_GAP_ABOVE && a == ALPHA_GAP_BELOW;
    }
    printf("of %d pairs %d near, %d above by beta, %d of these below by alpha\n", i, near, above,
           better);
    ck_assert(near > 100 && above > 100 && better > 10);
    tree_close(&t);
}
END_TEST

/* ---- dominates */

static enum dominates_answer dominates(const struct forest *f, const struct element *r,
                                       const struct element *s, double share)
{
    struct discussion d = between(f, r, s);
    return tool_dominates(&d, share);
}

/* A lamp of 12 W among dark faces and a dim one of 4 W: three quarters of all. Exact numbers, so
 * exact shares. */
START_TEST(test_lamp)
{
    static struct forest f;
    forest_open(&f);
    uint32_t from = f.count;
    for (int k = 0; k < 3; k++)
        square(&f, k, 0, 0, 0, 0, 1, 1, 0);
    square(&f, 3, 0, 0, 0, 0, 1, 1, 12);
    struct element *lamps = cluster(&f, from, 4, 1.5, 0, 0, 3); /* 12 W, all of one */
    square(&f, 5, 0, 0, 0, 0, 1, 4, 1);
    ck_assert_ptr_eq(lamps + 1, &f.element[f.count - 1]);
    struct element *group = cluster(&f, f.count - 2, 2, 3, 0, 0, 5); /* and 4 W beside them */
    from = f.count;
    square(&f, 0, 9, 0, 0, 0, 1, 1, 0);
    square(&f, 1, 9, 0, 0, 0, 1, 1, 0);
    struct element *dark = cluster(&f, from, 2, 0.5, 9, 0, 1);
    from = f.count;
    square(&f, 0, 9, 0, 0, 0, 1, 2, 3);
    square(&f, 1, 9, 0, 0, 0, 1, 1, 6);
    struct element *equal = cluster(&f, from, 2, 0.5, 9, 0, 1);
    struct element *alone = square(&f, 0, 20, 0, 0, 0, 1, 1, 0);
    ck_assert_int_eq(dominates(&f, lamps, dark, 0.5), DOMINATES_RECEIVER);
    ck_assert_int_eq(dominates(&f, dark, lamps, 0.5), DOMINATES_EMITTER);
    ck_assert_int_eq(dominates(&f, lamps, dark, 0.99), DOMINATES_RECEIVER);
    ck_assert_int_eq(dominates(&f, lamps, group, 0.5), DOMINATES_BOTH);
    ck_assert_int_eq(dominates(&f, lamps, group, 0.74), DOMINATES_BOTH);
    ck_assert_int_eq(dominates(&f, lamps, group, 0.75), DOMINATES_RECEIVER); /* not more than it */
    ck_assert_int_eq(dominates(&f, group, lamps, 0.76), DOMINATES_EMITTER);
    ck_assert_int_eq(dominates(&f, lamps, dark, 1), DOMINATES_NONE); /* nothing is more than all */
    ck_assert_int_eq(dominates(&f, equal, equal, 0.5), DOMINATES_NONE);
    ck_assert_int_eq(dominates(&f, dark, equal, 0.5), DOMINATES_NONE);
    /* a surface dominates itself, dark or not */
    ck_assert_int_eq(dominates(&f, alone, dark, 0.5), DOMINATES_RECEIVER);
    ck_assert_int_eq(dominates(&f, alone, lamps, 1), DOMINATES_RECEIVER);
    ck_assert_int_eq(dominates(&f, alone, alone, 0.5), DOMINATES_BOTH);
}
END_TEST

/* The walk down finds what looking at every face finds. */
START_TEST(test_dominates)
{
    unsigned state = 31 + (unsigned)_i;
    int counted[4] = {0, 0, 0, 0};
    struct random_tree t;
    tree_open(&t, _i, &state);
    int k;
    for (int i = 0; i < 20000; i++) {
        struct discussion d = tree_pair(&t, &state);
        double share = 0.5 + 0.5 * random_unit(&state);
        int is[2];
        for (k = 0; k < 2; k++) {
            const struct element *e = k ? d.emitter : d.receiver;
            is[k] = e->vertices || brightest_face(t.elements, e) > share * e->area * e->radiosity;
        }
        k = (int)tool_dominates(&d, share);
        ck_assert_int_eq(k, is[0] && is[1] ? DOMINATES_BOTH
                            : is[0]        ? DOMINATES_RECEIVER
                            : is[1]        ? DOMINATES_EMITTER
                                           : DOMINATES_NONE);
        counted[k] += !d.receiver->vertices && !d.emitter->vertices;
    }
    printf("of pairs of clusters: %d none, %d receiver, %d emitter, %d both\n", counted[0],
           counted[1], counted[2], counted[3]);
    for (k = 0; k < 4; k++)
        ck_assert_int_gt(counted[k], 20);
    tree_close(&t);
}
END_TEST

/* ---- self, receiver_size */

START_TEST(test_self)
{
    unsigned state = 41;
    struct random_tree t;
    tree_open(&t, 0, &state);
    struct discussion d;
    for (uint32_t i = 0; i < t.h.count; i++) {
        d = tree_pair(&t, &state);
        d.receiver = &t.elements[i];
        ck_assert_int_eq(tool_self(&d), d.emitter != d.receiver ? SELF_OTHER
                                        : i < t.h.built && t.h.range[i].to - t.h.range[i].from > 1
                                            ? SELF_CLUSTER
                                            : SELF_SURFACE);
        d.emitter = d.receiver;
        ck_assert_int_eq(tool_self(&d),
                         t.h.range[i].to - t.h.range[i].from > 1 ? SELF_CLUSTER : SELF_SURFACE);
    }
    tree_close(&t);
}
END_TEST

/* What clusters_feature does with a pair and itself: every cluster is opened on both sides, once,
 * since no other pair meets itself; surfaces stop. So every pair of faces is reached: the light is
 * bf_guarded's, nearly. */
START_TEST(test_self_pairs)
{
    struct refiner *r = oracles_open("clusters_feature", RELEASE_FLAT);
    struct solve_options options = quick(2);
    char *coarse[] = {(char *)"min_share=1e-3", NULL};
    struct solve s, other;
    uint32_t clusters = 0;
    struct scene scene;
    furnished(&scene, 1);
    ck_assert_ptr_nonnull(r);
    ck_assert_int_eq(oracles_set(r, coarse, 1), 0);
    const char *cause;
    ck_assert_int_eq(solve_open(&s, &scene, &options, &cause), 0);
    for (uint32_t i = 0; i < s.hierarchy.count; i++) {
        struct discussion d;
        memset(&d, 0, sizeof d);
        d.receiver = d.emitter = &s.hierarchy.elements[i];
        d.host = rays_host(s.problem.rays);
        ck_assert_int_eq(r->refine(r->state, &d),
                         d.receiver->vertices ? DECISION_STOP : DECISION_SUBDIVIDE_BOTH);
        clusters += !d.receiver->vertices;
    }
    ck_assert_uint_gt(clusters, 3);
    ck_assert_int_eq(solve_run(&s, r, &cause), 0);
    ck_assert_uint_eq(s.refinement.decided[DECISION_SUBDIVIDE_BOTH], clusters);
    solve_with(&other, &scene, "bf_guarded", RELEASE_FLAT, coarse, quick(2));
    for (uint32_t i = 0; i < scene.face_count; i++)
        ck_assert_double_eq_tol(face_radiosity(&s, i), face_radiosity(&other, i), 0.1);
    refiner_close(r);
    solve_close(&s);
    solve_close(&other);
    made_close(&scene);
}
END_TEST

START_TEST(test_receiver_size)
{
    static struct forest f;
    forest_open(&f);
    f.host.extent = 16;
    struct discussion d;
    /* of radius 1 */
    d = between(&f, square(&f, 0, 0, 0, 0, 0, 1, 2, 0), square(&f, 0, 0, 0, 0, 0, 1, 800, 0));
    ck_assert_int_eq(tool_receiver_size(&d, 2, 0), RECEIVER_SIZE_BIG); /* not below */
    ck_assert_int_eq(tool_receiver_size(&d, 2.0000001, 0), RECEIVER_SIZE_SMALL);
    ck_assert_int_eq(tool_receiver_size(&d, 0, 0.125), RECEIVER_SIZE_BIG);
    ck_assert_int_eq(tool_receiver_size(&d, 0, 0.1250001), RECEIVER_SIZE_SMALL);
    /* the larger of the two */
    ck_assert_int_eq(tool_receiver_size(&d, 1, 0.2), RECEIVER_SIZE_SMALL);
    ck_assert_int_eq(tool_receiver_size(&d, 3, 0.01), RECEIVER_SIZE_SMALL);
    ck_assert_int_eq(tool_receiver_size(&d, 0, 0), RECEIVER_SIZE_BIG);
    f.element[1].radius = 0;
    /* nothing is below nothing */
    ck_assert_int_eq(tool_receiver_size(&d, 0, 0), RECEIVER_SIZE_BIG);
}
END_TEST

/* ---- all of them */

/* In other units of length and of light, by powers of two: the same answers, the same number. */
START_TEST(test_units)
{
    static const int powers[] = {-40, -7, 1, 30};
    unsigned state = 51;
    struct random_tree t;
    tree_open(&t, 2, &state);
    struct element *copy;
    copy = malloc(t.h.count * sizeof *copy);
    ck_assert_ptr_nonnull(copy);
    for (int p = 0; p < 16; p++) {
        double length = ldexp(1, powers[p % 4]), light = ldexp(1, powers[p / 4]), irradiance[2];
        struct host host = t.host;
        const struct element *elements = copy;
        memcpy(copy, t.h.elements, t.h.count * sizeof *copy);
        for (uint32_t e = 0; e < t.h.count; e++) {
            for (int k = 0; k < 3; k++)
                copy[e].centre[k] *= length;
            copy[e].radius *= length;
            copy[e].area *= length * length;
            copy[e].radiosity *= light;
        }
        host.elements = &elements;
        host.irradiance *= light;
        host.extent *= length;
        for (int i = 0; i < 2000; i++) {
            struct discussion a = tree_pair(&t, &state), b = a;
            double limit = random_size(&state, 1e3), share = 0.5 + 0.5 * random_unit(&state),
                   size = 5 * random_unit(&state);
            b.receiver = copy + (a.receiver - t.elements);
            b.emitter = copy + (a.emitter - t.elements);
            b.host = &host;
            ck_assert_int_eq(tool_self(&a), tool_self(&b));
            ck_assert_int_eq(tool_dominates(&a, share), tool_dominates(&b, share));
            ck_assert_int_eq(tool_alpha_gap(&a, limit, 0), tool_alpha_gap(&b, limit * light, 0));
            ck_assert_int_eq(tool_alpha_gap(&a, 0, limit), tool_alpha_gap(&b, 0, limit));
            ck_assert_int_eq(tool_receiver_size(&a, size, 0),
                             tool_receiver_size(&b, size * length, 0));
            ck_assert_int_eq(tool_receiver_size(&a, 0, size / 10),
                             tool_receiver_size(&b, 0, size / 10));
            irradiance[0] =
                alpha_gap_range(a.receiver, a.emitter, t.elements, term_axis(&a)) * light;
            irradiance[1] = alpha_gap_range(b.receiver, b.emitter, copy, term_axis(&b));
            ck_assert_int_eq(memcmp(&irradiance[0], &irradiance[1], sizeof irradiance[0]), 0);
        }
    }
    free(copy);
    tree_close(&t);
}
END_TEST

/* An oracle that tells each answer of one tool by a decision, and what it must be. */
static const struct told {
    const char *text;
    enum decision decision[4]; /* of each answer */
} told[] = {
    {"param most : ratio = 1 in [0, inf];  start same;\n"
     "  node same = self() { surface -> stop;  cluster -> subdivide_both;  other -> ask; }\n"
     "  node ask  = alpha_gap(relative = most) { below -> stop;  above -> subdivide_receiver; }",
     {[ALPHA_GAP_BELOW] = DECISION_STOP, [ALPHA_GAP_ABOVE] = DECISION_SUBDIVIDE_RECEIVER}},
    {"param most : ratio = 0.75 in [0.5, 1];  start same;\n"
     "  node same = self() { surface -> stop;  cluster -> subdivide_both;  other -> ask; }\n"
     "  node ask  = dominates(share = most) { none -> stop;  receiver -> subdivide_receiver;  "
     "emitter -> subdivide_emitter;  both -> subdivide_both; }",
     {[DOMINATES_NONE] = DECISION_STOP,
      [DOMINATES_RECEIVER] = DECISION_SUBDIVIDE_RECEIVER,
      [DOMINATES_EMITTER] = DECISION_SUBDIVIDE_EMITTER,
      [DOMINATES_BOTH] = DECISION_SUBDIVIDE_BOTH}},
    {"param most : ratio = 0.2 in [0, inf];  start same;\n"
     "  node same = self() { surface -> stop;  cluster -> subdivide_both;  other -> ask; }\n"
     "  node ask  = receiver_size(share = most) { small -> stop;  big -> subdivide_emitter; }",
     {[RECEIVER_SIZE_SMALL] = DECISION_STOP, [RECEIVER_SIZE_BIG] = DECISION_SUBDIVIDE_EMITTER}},
};
enum { TOLD = sizeof told / sizeof *told };

static int answer(int which, struct discussion *d)
{
    return which == 0   ? (int)tool_alpha_gap(d, 0, 1)
           : which == 1 ? (int)tool_dominates(d, 0.75)
                        : (int)tool_receiver_size(d, 0, 0.2);
}

START_TEST(test_interpreted)
{
    unsigned state = 61;
    int seen[8] = {0}, kinds = 0;
    char text[1024];
    snprintf(text, sizeof text, "oracle told { %s }\n", told[_i].text);
    /* it tells answers and need not end */
    struct refiner *r = refiner_interpret(
        &(struct interpretation){
            .path = "told.dag", .text = text, .switches = "no-error=unguarded-split"},
        NULL);
    ck_assert_ptr_nonnull(r);
    struct random_tree t;
    tree_open(&t, 2, &state);
    for (int i = 0; i < 20000; i++) {
        struct discussion d = tree_pair(&t, &state), other;
        if (i % 10 == 0)
            d.emitter = d.receiver;
        other = d;
        enum decision right = d.receiver != d.emitter ? told[_i].decision[answer(_i, &other)]
                              : d.receiver->vertices  ? DECISION_STOP
                                                      : DECISION_SUBDIVIDE_BOTH;
        seen[right]++;
        ck_assert_int_eq(r->refine(r->state, &d), right);
    }
    for (int k = 0; k < 8; k++)
        kinds += seen[k] > 20;
    ck_assert_int_eq(kinds, _i == 1 ? 4 : 3);
    refiner_close(r);
    tree_close(&t);
}
END_TEST

/* Compiled and interpreted, all of them in one oracle, surfaces asked like groups. */
static const char asked[] =
    "oracle asked {\n"
    "  start same;\n"
    "  node same  = self() { surface -> stop;  cluster -> subdivide_both;  other -> level; }\n"
    "  node level = clusters() { surfaces -> pair;  apart -> stop;  receiver | emitter -> lamp; }\n"
    "  node lamp  = dominates(share = 0.75) { none -> size;  receiver -> far;  emitter -> open;  "
    "both -> size; }\n"
    "  node size  = receiver_size(below = 0.3, share = 0.1) { small -> far;  big -> open; }\n"
    "  node far   = alpha_gap(relative = 0.5) { below -> seen;  above -> open; }\n"
    "  node seen  = cluster_visibility(rays = 4) { none -> stop;  partial | all -> link_clusters; "
    "}\n"
    "  node open  = opens(ratio = 2, min_share = 1e-2) { receiver -> subdivide_receiver;  emitter "
    "-> subdivide_emitter; }\n"
    "  node pair  = support_planes() { away -> stop;  toward | receiver_crosses | emitter_crosses "
    "-> gap; }\n"
    "  node gap   = alpha_gap(absolute = 0.1) { below -> small;  above -> guard; }\n"
    "  node guard = can_split(min_share = 1e-2) { receiver -> subdivide_receiver;  emitter -> "
    "subdivide_emitter;  both -> side;  neither -> few; }\n"
    "  node side  = dominates(share = 1) { none | receiver | emitter -> stop;  both -> "
    "subdivide_both; }\n"
    "  node small = receiver_size(share = 0.2) { small -> few;  big -> rays; }\n"
    "  node few   = visibility(rays = 4) { none -> stop;  partial | all -> form; }\n"
    "  node rays  = visibility(rays = 16) { none -> stop;  partial | all -> form; }\n"
    "  node form  = form_factor() { done -> link; }\n"
    "}\n";

START_TEST(test_compiled)
{
    ck_assert_int_eq(folder_make("cluster-tools"), 0);
    folder_write("asked.dag", asked);
    int status = shell(
        "$RADIOSITY compare examples/scenes/room.obj --oracle %s/asked.dag --repeats 1", folder);
    folder_remove();
    ck_assert_int_eq(status, 0);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("cluster tools");
    TCase *c = tcase_create("cluster tools");
    tcase_set_timeout(c, 60);
    tcase_add_test(c, test_squares);
    tcase_add_test(c, test_cube);
    tcase_add_test(c, test_nothing);
    tcase_add_loop_test(c, test_facing, 0, 3);
    tcase_add_loop_test(c, test_below_beta, 0, 3);
    tcase_add_test(c, test_lamp);
    tcase_add_loop_test(c, test_dominates, 0, 3);
    tcase_add_test(c, test_self);
    tcase_add_test(c, test_self_pairs);
    tcase_add_test(c, test_receiver_size);
    tcase_add_test(c, test_units);
    tcase_add_loop_test(c, test_interpreted, 0, TOLD);
    tcase_add_test(c, test_compiled);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
