/* check_clustering.c - the strategies that group faces into clusters: sound trees, right measures,
 * the same for any number of threads and any power of two, whatever the faces are.
 * Once is enough: it is about numbers; that memory is used well, shorter suites tell.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "hierarchy/hierarchy.h"
#include "scene/make_scene.h"
#include "util/oracles.h"
#include "engine/solve.h"
#include "suite.h"
#include "kernel/hash.h"

/* Each of libcheck's own assertions writes to a file; these are many. */
#define must(condition) \
    do { \
        if (!(condition)) \
            ck_abort_msg("%s", #condition); \
    } while (0)

/* Sets of faces, most of them bad. */
enum set {
    ONE,
    TWO,
    COINCIDENT,
    CONCENTRIC,
    LINE,
    WALLS,
    CLUTTER,
    SHRINKING,
    HUGE_NUMBERS,
    TINY_AND_LARGE,
    MANY,
    SETS
};
static const char *const set_names[SETS] = {
    "one",     "two",       "coincident",   "concentric",     "line", "walls",
    "clutter", "shrinking", "huge numbers", "tiny and large", "many"};

struct faces {
    struct face *face;
    uint32_t count;
};

static double chance(uint64_t *state)
{
    return (double)(hash64(*state += HASH_STEP) >> 11) * 0x1p-53;
}

/* A square of a side about a middle, its normal along an axis, turned a little when `turn` is
 * not 0. */
static void square(struct faces *s, double x, double y, double z, double side, int axis,
                   double turn)
{
    static const double corner[4][2] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
    const double middle[3] = {x, y, z};
    struct face *f = &s->face[s->count];
    memset(f, 0, sizeof *f);
    for (int i = 0; i < 4; i++) {
        f->vertex[i][axis] = middle[axis] + turn * side * corner[i][0];
        f->vertex[i][(axis + 1) % 3] = middle[(axis + 1) % 3] + side * corner[i][0];
        f->vertex[i][(axis + 2) % 3] = middle[(axis + 2) % 3] + side * corner[i][1];
    }
    f->vertices = 4;
    f->input = s->count++;
}

static struct faces made(int set)
{
    struct faces s = {malloc(70000 * sizeof *s.face), 0};
    uint64_t seed = 7;
    ck_assert_ptr_nonnull(s.face);
    int i, j;
    switch (set) {
    case ONE:
        square(&s, 1, 2, 3, 1, 2, 0);
        break;
    case TWO:
        square(&s, 1, 2, 3, 1, 2, 0);
        square(&s, 0, 2, 3, 1, 1, 0);
        break;
    case COINCIDENT:
        for (i = 0; i < 5000; i++)
            square(&s, 1, 2, 3, 1, 2, 0);
        break;
    case CONCENTRIC: /* one middle, sizes and planes of all kinds */
        for (i = 0; i < 999; i++)
            square(&s, 0, 0, 0, 1 + i % 37, i % 3, 0);
        break;
    case LINE:
        for (i = 0; i < 1000; i++)
            square(&s, i, 0, 0, 1, 2, 0);
        break;
    case WALLS: /* three planes of a room */
        for (i = 0; i < 24; i++)
            for (j = 0; j < 24; j++) {
                square(&s, i + 0.5, j + 0.5, 0, 1, 2, 0);
                square(&s, 0, i + 0.5, j + 0.5, 1, 0, 0);
                square(&s, i + 0.5, 0, j + 0.5, 1, 1, 0);
            }
        break;
    case SHRINKING: /* towards a corner, by halves: cells as deep as the numbers */
        for (i = 0; i < 200; i++)
            square(&s, ldexp(1, -i), ldexp(1, -i), 0, ldexp(1, -i - 2), 2, 0);
        break;
    case HUGE_NUMBERS:
        for (i = 0; i < 2000; i++)
            square(&s, 1e37 * chance(&seed), 1e37 * chance(&seed), -1e37 * chance(&seed),
                   i % 2 ? 1e35 : 1e30, i % 3, 0);
        break;
    case TINY_AND_LARGE:
        for (i = 0; i < 3000; i++)
            square(&s, chance(&seed), chance(&seed), chance(&seed), i % 10 ? 1e-3 : 0.7, i % 3,
                   0.1);
        break;
    default:
        for (i = 0; i < (set == MANY ? 70000 : 3000); i++)
            square(&s, chance(&seed), chance(&seed), chance(&seed), 0.05 * chance(&seed) + 1e-4,
                   i % 3, chance(&seed) - 0.5);
    }
    return s;
}

/* Each face once; children divide their parent's range, stand behind it and side by side;
 * nothing is deeper than it may be. */
static void check_tree(const struct bvh *t, uint32_t faces)
{
    unsigned char *seen = calloc(faces, 1);
    uint32_t *depth = calloc(t->count, sizeof *depth);
    uint32_t next = 1, deepest = 0, log = 0;
    ck_assert_ptr_nonnull(seen);
    ck_assert_ptr_nonnull(depth);
    for (uint32_t i = 0; i < faces; i++) {
        must(t->order[i] < faces);
        must(seen[t->order[i]] == 0);
        seen[t->order[i]] = 1;
    }
    must(t->nodes[0].from == 0 && t->nodes[0].to == faces);
    for (uint32_t i = 0; i < t->count; i++) {
        const struct bvh_node *n = &t->nodes[i];
        uint32_t from = n->from;
        must(n->from < n->to);
        deepest = depth[i] > deepest ? depth[i] : deepest;
        if (!n->children) {
            must(n->to - n->from == 1);
            must(i != 0);
            continue;
        }
        must(n->children <= PARTS_MAX);
        must(n->children > 1 || (i == 0 && faces == 1));
        must(n->child == next);
        next += n->children;
        must(next <= t->count);
        for (uint32_t k = 0; k < n->children; k++) {
            must(t->nodes[n->child + k].from == from);
            from = t->nodes[n->child + k].to;
            depth[n->child + k] = depth[i] + 1;
        }
        must(from == n->to);
    }
    must(next == t->count);
    for (uint32_t i = faces; i > 1; i = (i + 1) / 2)
        log++;
    must(deepest <= DEPTH_MAX + log + 1);
    must(t->depth == deepest + 1);
    free(seen);
    free(depth);
}

START_TEST(test_tree)
{
    int strategy = _i % CLUSTERING_COUNT, set = _i / CLUSTERING_COUNT;
    struct faces s = made(set);
    struct bvh t;
    ck_assert_int_eq(bvh_build(&t, s.face, s.count, (enum clustering)strategy, 2), 0);
    check_tree(&t, s.count);
    if (set == CLUTTER || set == COINCIDENT || set == SHRINKING)
        printf("%s, %s: %u nodes, depth %u\n", clustering_names[strategy], set_names[set], t.count,
               t.depth);
    bvh_free(&t);
    free(s.face);
}
END_TEST

static int same(const struct bvh *a, const struct bvh *b, uint32_t faces)
{
    return a->count == b->count && a->depth == b->depth
           && memcmp(a->nodes, b->nodes, a->count * sizeof *a->nodes) == 0
           && memcmp(a->order, b->order, faces * sizeof *a->order) == 0;
}

/* Threads and powers of two change nothing. */
START_TEST(test_same)
{
    int strategy = _i % CLUSTERING_COUNT, set = _i / CLUSTERING_COUNT;
    struct faces s = made(set);
    struct bvh t, other;
    ck_assert_int_eq(bvh_build(&t, s.face, s.count, (enum clustering)strategy, 1), 0);
    for (int threads = 2; threads <= (set == MANY ? 2 : 4); threads += 2) {
        ck_assert_int_eq(bvh_build(&other, s.face, s.count, (enum clustering)strategy, threads), 0);
        ck_assert(same(&t, &other, s.count));
        ck_assert_int_eq(memcmp(t.boxes, other.boxes, t.count * sizeof *t.boxes), 0);
        bvh_free(&other);
    }
    for (int n = -30; n <= 30 && set != MANY; n += 60) {
        for (uint32_t i = 0; i < s.count; i++)
            for (int k = 0; k < 12; k++)
                s.face[i].vertex[k / 3][k % 3] *= ldexp(1, n);
        ck_assert_int_eq(bvh_build(&other, s.face, s.count, (enum clustering)strategy, 1), 0);
        ck_assert(same(&t, &other, s.count));
        bvh_free(&other);
        for (uint32_t i = 0; i < s.count; i++)
            for (int k = 0; k < 12; k++)
                s.face[i].vertex[k / 3][k % 3] *= ldexp(1, -n);
    }
    bvh_free(&t);
    free(s.face);
}
END_TEST

/* Boxes, areas and cones against all faces of each cluster; faces are known by the same names
 * under every strategy. */
START_TEST(test_measures)
{
    int strategy = _i % CLUSTERING_COUNT, set = _i / CLUSTERING_COUNT;
    struct faces s = made(set);
    struct hierarchy h, first;
    uint32_t flat = 0;
    ck_assert_int_eq(hierarchy_build_by(&h, s.face, s.count, (enum clustering)strategy, 2), 0);
    ck_assert_int_eq(hierarchy_build_by(&first, s.face, s.count, CLUSTERING_DEFAULT, 1), 0);
    for (uint32_t i = 0; i < h.built; i++) {
        const struct element *e = &h.elements[i];
        double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY},
               area = 0, cone = 1, axis[3] = {0};
        if (e->vertices) {
            must(h.face_element[e->face] == i);
            must(h.range[i].to - h.range[i].from == 1 && h.order[h.range[i].from] == e->face);
            must(e->id == hierarchy_surface(&first, e->face)->id);
            continue;
        }
        for (uint32_t f = h.range[i].from; f < h.range[i].to; f++) {
            const struct element *x = hierarchy_surface(&h, h.order[f]);
            uint32_t at = h.face_element[h.order[f]];
            while (at != i && at != 0)
                at = h.elements[at].parent;
            must(at == i);
            area += x->area;
            for (int k = 0; k < 3; k++) {
                axis[k] += x->area * x->normal[k];
                for (uint32_t j = 0; j < x->vertices; j++) {
                    low[k] = fmin(low[k], x->vertex[j][k]);
                    high[k] = fmax(high[k], x->vertex[j][k]);
                }
            }
        }
        double size = length3(axis);
        for (int k = 0; k < 3; k++) {
            must(!(e->vertex[0][k] < low[k]) && !(e->vertex[0][k] > low[k]));
            must(!(e->vertex[1][k] < high[k]) && !(e->vertex[1][k] > high[k]));
        }
        must(fabs(e->area / area - 1) <= 1e-12);
        if (!(size > 2e-9 * area)) {
            must(e->cone < 0 || size > 0.5e-9 * area);
            continue;
        }
        for (uint32_t f = h.range[i].from; f < h.range[i].to; f++) {
            double c = dot3(axis, hierarchy_surface(&h, h.order[f])->normal) / size;
            cone = c < cone ? c : cone;
        }
        must(fabs(e->cone - cone) <= 1e-12);
        flat += e->cone >= 1;
    }
    if (set == LINE || set == COINCIDENT)
        ck_assert_uint_eq(flat, h.built - s.count);
    if (set == WALLS)
        ck_assert_uint_gt(flat, 300);
    hierarchy_free(&h);
    hierarchy_free(&first);
    free(s.face);
}
END_TEST

/* A million faces, half of them one and the same; a tenth of that for all strategies but the
 * default. */
START_TEST(test_million)
{
    int count = !thorough() ? 30000 : _i == CLUSTERING_SAH ? 1000000 : 100000;
    struct faces s = {malloc((size_t)count * sizeof *s.face), 0};
    uint64_t seed = 3;
    ck_assert_ptr_nonnull(s.face);
    for (int i = 0; i < count; i++)
        if (i % 2)
            square(&s, 0.5, 0.5, 0.5, 0.01, 0, 0);
        else
            square(&s, chance(&seed), chance(&seed), chance(&seed), 0.001, i % 3, 0);
    struct bvh t;
    ck_assert_int_eq(bvh_build(&t, s.face, s.count, (enum clustering)_i, 2), 0);
    check_tree(&t, s.count);
    bvh_free(&t);
    free(s.face);
}
END_TEST

/* What splits and solvers have done to a tree is undone, to the last byte. */
START_TEST(test_renewed)
{
    const struct faces s = made(_i);
    struct hierarchy h, fresh;
    ck_assert_int_eq(hierarchy_build(&h, s.face, s.count), 0);
    ck_assert_int_eq(hierarchy_build(&fresh, s.face, s.count), 0);
    for (uint32_t i = 0; i < s.count; i += 3)
        ck_assert_int_eq(hierarchy_split(&h, h.face_element[i]), 0);
    ck_assert_int_eq(hierarchy_split(&h, h.count - 1), 0);
    for (uint32_t i = 0; i < h.count; i++) {
        struct element *e = &h.elements[i];
        e->radiosity = e->spread = e->deviation = e->reflectance = 3;
        e->importance = e->tolerance = e->lower = e->gap = 4;
        e->bend = 5;
        e->mark = 6;
    }
    hierarchy_renew(&h);
    ck_assert_uint_eq(h.count, fresh.count);
    ck_assert_int_eq(memcmp(h.elements, fresh.elements, h.count * sizeof *h.elements), 0);
    hierarchy_free(&h);
    hierarchy_free(&fresh);
    free(s.face);
}
END_TEST

static void side(struct scene *s, int n, const double o[3], const double a[3], const double b[3])
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            made_quad(s, 0, o[0] + (i * a[0] + j * b[0]) / n, o[1] + (i * a[1] + j * b[1]) / n,
                      o[2] + (i * a[2] + j * b[2]) / n, a[0] / n, a[1] / n, a[2] / n, b[0] / n,
                      b[1] / n, b[2] / n);
}

/* A white furnace with a box in it, cluster links included: B = E / (1 - rho) = 2, exactly so with
 * closed rows; the same bytes for one thread and two. */
START_TEST(test_furnace)
{
    static const double unit[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    struct scene scene;
    size_t clusters = 0;
    double worst = 0, gain = 0, area = 0;
    ck_assert_int_eq(made_open(&scene), 0);
    made_material(&scene, 0.5, 1);
    for (int k = 0; k < 3; k++) {
        const double *a = unit[(k + 1) % 3], *b = unit[(k + 2) % 3], corner[3] = {1, 1, 1},
                     zero[3] = {0, 0, 0};
        const double down[2][3] = {{-a[0], -a[1], -a[2]}, {-b[0], -b[1], -b[2]}};
        const double u[3] = {0.3 * a[0], 0.3 * a[1], 0.3 * a[2]},
                     v[3] = {0.3 * b[0], 0.3 * b[1], 0.3 * b[2]};
        const double w[2][3] = {{-u[0], -u[1], -u[2]}, {-v[0], -v[1], -v[2]}},
                     low[3] = {0.3, 0.35, 0.2}, high[3] = {0.6, 0.65, 0.5};
        side(&scene, 6, zero, a, b);
        side(&scene, 6, corner, down[1], down[0]);
        side(&scene, 4, low, v, u);
        side(&scene, 4, high, w[0], w[1]);
    }
    struct solve s[2];
    /* rows closed with one thread, then two; then as they are */
    for (int run = 0; run < 3; run++) {
        struct solve *t = &s[run & 1];
        struct solve_options how = {.tolerance = 1e-6,
                                    .iterations = 2000,
                                    .threads = run == 0 ? 1 : 2,
                                    .clusters = 1 + _i,
                                    .closure = run < 2 ? CLOSURE_ROWS : CLOSURE_NONE};
        struct refiner *r = oracles_open("clusters", RELEASE_FLAT);
        ck_assert_ptr_nonnull(r);
        if (run == 2)
            solve_close(t);
        const char *cause;
        ck_assert_int_eq(solve_open(t, &scene, &how, &cause), 0);
        ck_assert_int_eq(solve_run(t, r, &cause), 0);
        refiner_close(r);
        if (run == 1) {
            ck_assert_uint_eq(s[0].refinement.link_count, s[1].refinement.link_count);
            ck_assert_int_eq(memcmp(s[0].refinement.links, s[1].refinement.links,
                                    s[0].refinement.link_count * sizeof(struct link)),
                             0);
            for (uint32_t i = 0; i < scene.face_count; i++)
                worst = fmax(worst, fabs(t->state.radiosity[t->hierarchy.face_element[i]] / 2 - 1));
        }
    }
    for (uint32_t i = 0; i < scene.face_count; i++) {
        double a = s[0].hierarchy.elements[s[0].hierarchy.face_element[i]].area;
        gain += a * (s[0].state.radiosity[s[0].hierarchy.face_element[i]] / 2 - 1);
        area += a;
    }
    for (size_t l = 0; l < s[0].refinement.link_count; l++)
        clusters += !s[0].hierarchy.elements[s[0].refinement.links[l].emitter].vertices;
    printf("furnace, %s: %zu links, %zu from clusters; gains %+.2g as it is; B off by %.2g at the "
           "most with rows closed\n",
           clustering_names[_i], s[0].refinement.link_count, clusters, gain / area, worst);
    ck_assert_uint_gt(clusters, 500);
    ck_assert_double_le(fabs(gain / area), 0.05);
    ck_assert_double_le(worst, 1e-4);
    solve_close(&s[0]);
    solve_close(&s[1]);
    made_close(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("clustering");
    TCase *c = tcase_create("clustering");
    tcase_set_timeout(c, 300);
    tcase_add_loop_test(c, test_tree, 0, SETS * CLUSTERING_COUNT);
    tcase_add_loop_test(c, test_same, 0, SETS * CLUSTERING_COUNT);
    tcase_add_loop_test(c, test_measures, 0, (SETS - 1) * CLUSTERING_COUNT);
    tcase_add_loop_test(c, test_renewed, 0, SETS - 1);
    tcase_add_loop_test(c, test_million, 0, CLUSTERING_COUNT);
    tcase_add_loop_test(c, test_furnace, 0, thorough() ? CLUSTERING_COUNT : 2);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
