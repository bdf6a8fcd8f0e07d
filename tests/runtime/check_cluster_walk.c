/* check_cluster_walk.c - faces that samples choose below a cluster: the bits of a walk that asks
 * one child after the other and keeps nothing, at every width of vectors.
 *
 * Random trees, of up to four children a cluster and of up to eight; cones of any width, normals
 * beside the direction and against it, some children without area. Walks of one kind keep what
 * they have found for the next, so many faces are chosen by each.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <stdio.h>
#include <string.h>
#include "kernel/cluster_facing.h"
#include "suite.h"
#include "tools/cluster_visibility.h"

enum { MOST = 4000, WALKS = 60, EACH = 200 };

static uint64_t state = 88172645463325252;
static struct element tree[MOST];
static uint32_t used;

static double even(void)
{
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (double)(state >> 11) * 0x1p-53;
}

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

int main(void)
{
    Suite *suite = suite_create("cluster walk");
    TCase *c = tcase_create("cluster walk");
    tcase_set_timeout(c, 120);
    tcase_add_test(c, test_walks);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
