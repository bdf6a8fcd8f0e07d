/* check_cluster_walk.c - faces that samples choose below a cluster: the bits of a walk that asks
 * one child after the other and keeps nothing, at every width of vectors; and rays between two
 * clusters: as many and the same as where every sample goes down both trees; and of lists of pairs,
 * as the form for a block casts them.
 *
 * Random trees, of up to four children a cluster and of up to eight; cones of any width, normals
 * beside the direction and against it, some children without area. Walks of one kind keep what
 * they have found for the next, so many faces are chosen by each.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <stdio.h>
#include <string.h>
#include "kernel/cluster_facing.h"
#include "runtime/even_numbers.h"
#include "suite.h"
#include "tools/cluster_visibility.wave.h"

enum { MOST = 4000, WALKS = 60, EACH = 200 };

static struct element tree[MOST];
static uint32_t used;

static void direction(double v[3])
{
    double size;
    do {
        for (int k = 0; k < 3; k++)
            v[k] = 2 * even() - 1;
        size = length3(v);
    } while (!(size > 0.1));
    for (int k = 0; k < 3; k++)
        v[k] /= size;
}

static void grow(uint32_t at, int depth, int most)
{
    struct element *e = &tree[at];
    direction(e->normal);
    e->area = even() < 0.05 ? 0 : even();
    e->cone = even() < 0.2 ? -1 : even() < 0.2 ? 1 : 2 * even() - 1;
    const uint32_t children = 1 + (uint32_t)(even() * most);
    if (depth == 0 || even() < 0.1 || used + children > MOST) {
        e->vertices = 4;
        return;
    }
    e->child = used;
    e->children = (uint8_t)children;
    used += children;
    for (uint32_t c = 0; c < children; c++)
        grow(e->child + c, depth - 1, most);
}

/* As cluster_face, of cluster_facing alone. */
static const struct element *plainly(const struct element *e, const double v[3], double slope,
                                     double *u, double *chance)
{
    *chance = 1;
    while (!e->vertices) {
        const struct element *child = &tree[e->child];
        double part[CLUSTER_CHILDREN], sum = 0;
        int k = 0;
        for (int c = 0; c < e->children; c++) {
            part[c] = cluster_facing(&child[c], v, slope);
            sum += part[c];
        }
        for (*u *= sum; k < e->children - 1 && *u >= part[k]; k++)
            *u -= part[k];
        if (!(part[k] > 0))
            return NULL;
        *u = *u < part[k] ? *u / part[k] : 0.5;
        *chance *= part[k] / sum;
        e = &child[k];
    }
    return e;
}

START_TEST(test_walks)
{
    static struct cluster_walk walk;
    int chosen = 0, none = 0, many = 0;
    for (int i = 0; i < WALKS; i++) {
        double v[3], slope = i % 4 ? 0.5 * even() : 0;
        memset(tree, 0, sizeof tree);
        used = 1;
        grow(0, 6, i % 3 ? 4 : 8);
        direction(v);
        for (int width = 1; width <= lanes_width(); width *= width == 1 ? 4 : 2) {
            cluster_walk_open(&walk, tree, v, slope);
            walk.width = width;
            for (int j = 0; j < EACH; j++) {
                double u[2], chance[2];
                u[0] = u[1] = j ? even() : 0;
                chance[1] = 1;
                const struct element *wanted = plainly(&tree[0], v, slope, &u[0], &chance[0]),
                                     *e = cluster_face(&walk, &tree[0], &u[1], &chance[1]);
                ck_assert_msg(e == wanted, "tree %d, width %d, walk %d", i, width, j);
                none += !e;
                chosen += e != NULL;
                if (e) {
                    ck_assert(u[0] == u[1]);
                    ck_assert(chance[0] == chance[1]);
                }
            }
        }
        for (uint32_t e = 0; e < used; e++)
            many += tree[e].children > 4;
    }
    printf("%d faces chosen as one by one, %d times none; %d clusters of more than four\n", chosen,
           none, many);
    ck_assert_int_gt(chosen, WALKS * EACH / 2);
    ck_assert_int_gt(none, 100);
    ck_assert_int_gt(many, 100);
}
END_TEST

/* A small square there, and the tree above such: the sphere of each cluster holds what is below. */
static void stand(uint32_t at, const double middle[3], double wide)
{
    struct element *e = &tree[at];
    if (e->vertices) {
        double side[2][3];
        direction(side[0]);
        cross3(side[1], e->normal, side[0]);
        cross3(side[0], side[1], e->normal);
        for (int k = 0; k < 3; k++) {
            e->centre[k] = middle[k] + wide * (even() - 0.5);
            for (int i = 0; i < 4; i++)
                e->vertex[i][k] = e->centre[k] + 0.02 * (i == 1 || i == 2 ? 1 : -1) * side[0][k]
                                  + 0.02 * (i > 1 ? 1 : -1) * side[1][k];
        }
        e->radius = 0.03;
        return;
    }
    for (int k = 0; k < 3; k++)
        e->centre[k] = middle[k];
    for (uint32_t c = 0; c < e->children; c++) {
        const struct element *child = &tree[e->child + c];
        double off[3];
        stand(e->child + c, middle, wide);
        sub3(off, child->centre, middle);
        e->radius = fmax(e->radius, length3(off) + child->radius);
    }
}

static double where_cast; /* of all segments so far, where they begin and end */

static uint64_t cast(const struct host *host, int count, const struct segment *segments)
{
    uint64_t hits = 0;
    (void)host;
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++)
            where_cast = 0.99 * where_cast + segments[i].from[k] - 2 * segments[i].to[k];
        hits |= (uint64_t)(segments[i].from[2] > 0) << i;
    }
    return hits;
}

/* As cluster_rays, every sample by itself; of more than one ray. */
static double rays_plainly(const struct element *r, const struct element *s,
                           const struct host *host, int count)
{
    static const double step[4] = {0.8566748838545029, 0.733891856627126, 0.6287067210378087,
                                   0.5385972572236101};
    struct segment segments[SEGMENTS_MAX];
    double weight[SEGMENTS_MAX], seen = 0, whole = 0, v[3], back[3], away[3];
    const uint64_t hash = hash64(r->id + hash64(s->id));
    int n = 0;
    sub3(away, s->centre, r->centre);
    const double distance = length3(away), slope = (r->radius + s->radius) / distance;
    for (int k = 0; k < 3; k++) {
        v[k] = away[k] / distance;
        back[k] = -v[k];
    }
    for (int i = 0; n < count && i < CLUSTER_TRIES * count; i++) {
        double u[4], chance[2], w[3];
        for (int k = 0; k < 4; k++) {
            u[k] = (double)(hash >> 16 * k & 0xffff) * (1 / 65536.0) + (i + 0.5) * step[k];
            u[k] -= floor(u[k]);
        }
        const struct element *a = plainly(r, v, slope, &u[0], &chance[0]),
                             *b = plainly(s, back, slope, &u[2], &chance[1]);
        if (!a || !b)
            continue;
        surface_point(segments[n].from, a, u[0], u[1]);
        surface_point(segments[n].to, b, u[2], u[3]);
        sub3(w, segments[n].to, segments[n].from);
        const double cos_a = dot3(a->normal, w), cos_b = -dot3(b->normal, w),
                     square = dot3(w, w) / (distance * distance);
        if (!(cos_a > 0) || !(cos_b > 0))
            continue;
        weight[n] = cos_a * cos_b * (a->area / r->area) * (b->area / s->area)
                    / (square * square * chance[0] * chance[1]);
        segment_clear(&segments[n++], a->normal, b->normal, host);
    }
    if (n == 0)
        return 0;
    segments_cast(host, n, segments, weight, &seen, &whole);
    return whole > 0 ? seen / whole : 0;
}

START_TEST(test_rays)
{
    const struct element *all = tree;
    struct host host;
    int partial = 0, none = 0;
    memset(&host, 0, sizeof host);
    host.occluded = cast;
    host.elements = &all;
    host.ray_offset = 1e-5;
    for (int i = 0; i < 600; i++) {
        const double near = i % 2 ? 0.6 : 3, middle[2][3] = {{0, 0, 0}, {near, 0.3 * near, 0}};
        memset(tree, 0, sizeof tree);
        used = 2;
        for (uint32_t k = 0; k < 2; k++) {
            grow(k, 4, 4);
            stand(k, middle[k], i % 3 ? 0.3 : 0.9);
            tree[k].id = 1 + k + 2 * (uint64_t)i;
            tree[k].area += 1;
        }
        const int count = i % 4 ? 4 : 16;
        where_cast = 0;
        const double wanted = rays_plainly(&tree[0], &tree[1], &host, count), were = where_cast;
        where_cast = 0;
        const double v = cluster_rays(&tree[1], &tree[0], &host, count);
        ck_assert_msg(v == wanted && where_cast == were, "pair %d: %g, not %g", i, v, wanted);
        partial += v > 0 && v < 1;
        none += were == 0;
    }
    printf("%d pairs see each other in part, of %d no segment is cast\n", partial, none);
    ck_assert_int_gt(partial, 150);
    ck_assert_int_gt(none, 20);
}
END_TEST

/* A number for all calls so far, whatever their order, of where all their segments lie. */
static uint64_t calls_cast;

static uint64_t cast_any_order(const struct host *host, int count, const struct segment *segments)
{
    uint64_t hash = (uint64_t)count, hits = 0;
    (void)host;
    for (int i = 0; i < count; i++) {
        uint64_t bits[6];
        memcpy(bits, &segments[i], sizeof bits);
        for (int k = 0; k < 6; k++)
            hash = hash64(hash + bits[k]);
        hits |= (uint64_t)(segments[i].from[2] > 0) << i;
    }
    calls_cast += hash;
    return hits;
}

enum { ROOTS = 10, LIST = 60 };

/* Roots from 1 on, near and far from each other; 0 is nobody's. */
static void stand_all(int i, int most)
{
    memset(tree, 0, sizeof tree);
    used = 1 + ROOTS;
    for (uint32_t k = 1; k <= ROOTS; k++) {
        const double spread = i % 3 ? 1 : 3,
                     middle[3] = {spread * even(), spread * even(), 0.5 * even()};
        grow(k, k % 4 ? 5 : 0, most);
        stand(k, middle, i % 2 ? 0.2 : 0.7);
        tree[k].id = k + 100 * (uint64_t)i;
        tree[k].area += 1;
    }
}

START_TEST(test_lists)
{
    static struct discussion one[LIST], block[LIST];
    static const int cast[] = {1, 4, 16, 64};
    const struct element *all = tree;
    struct host host;
    long partial = 0, several = 0, nothing = 0, plain = 0;
    memset(&host, 0, sizeof host);
    host.occluded = cast_any_order;
    host.elements = &all;
    host.ray_offset = 1e-5;
    for (int i = 0; i < 60; i++) {
        int rays[LIST];
        uint16_t at[LIST];
        unsigned char answers[LIST];
        enum cluster_visibility_answer wanted[LIST];
        stand_all(i, i % 4 ? 4 : 8);
        const int count = i % 5 ? LIST : 1 + i / 5;
        for (int width = 1; width <= lanes_width(); width *= width == 1 ? 4 : 2) {
            memset(block, 0, sizeof block);
            for (int k = 0; k < count; k++) {
                struct discussion *d = &block[k];
                const uint32_t r = 1 + (uint32_t)(even() * ROOTS);
                const uint32_t s = 1 + (r + (uint32_t)(even() * (ROOTS - 1))) % ROOTS;
                d->receiver = &tree[r];
                d->emitter = &tree[s];
                d->host = &host;
                rays[k] = cast[(int)(even() * 4)];
                at[k] = (uint16_t)(count - 1 - k);
                if (k % 7 == 3) { /* known already, or not as well */
                    d->terms.visibility = 0.25;
                    d->terms.visibility_level = VISIBILITY_RAYS_4;
                }
                plain += tree[r].children > CLUSTER_FEW || tree[s].children > CLUSTER_FEW;
            }
            memcpy(one, block, sizeof one);
            calls_cast = 0;
            for (int k = 0; k < count; k++)
                wanted[k] = tool_cluster_visibility(&one[at[k]], rays[k]);
            const uint64_t were = calls_cast;
            calls_cast = 0;
            cluster_visibility_list(width, block, at, count, rays, answers);
            ck_assert_msg(calls_cast == were, "list %d, width %d: other segments", i, width);
            for (int k = 0; k < count; k++) {
                const struct terms *t = &block[at[k]].terms, *u = &one[at[k]].terms;
                ck_assert_msg(t->visibility == u->visibility
                                  && t->visibility_level == u->visibility_level
                                  && answers[k] == wanted[k],
                              "list %d, width %d, pair %d: %g, not %g", i, width, k, t->visibility,
                              u->visibility);
                partial += t->visibility > 0 && t->visibility < 1;
                nothing += !(t->visibility > 0);
            }
            several++;
        }
    }
    printf("%ld lists as pair by pair; %ld see each other in part, %ld not; %ld sample by sample\n",
           several, partial, nothing, plain);
    ck_assert_int_gt(partial, 300);
    ck_assert_int_gt(nothing, 100);
    ck_assert_int_gt(plain, 100);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("cluster walk");
    TCase *c = tcase_create("cluster walk");
    tcase_set_timeout(c, 120);
    tcase_add_test(c, test_walks);
    tcase_add_test(c, test_rays);
    tcase_add_test(c, test_lists);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
