/* check_flat_clusters.c - clusters of faces in one plane are found, and only those; and what stands
 * in shafts is the same, whether they are known or not.
 * SPDX-License-Identifier: MIT */
#include "hierarchy/flat_clusters.h"
#include "kernel/shaft.h"
#include "shaft_worlds.h"
#include "visibility/candidates.h"

enum { SHELVES = 7, TILES = 12, WAYS = 5, MOST = 64 };

/* How shelves are laid: their corners as they are, turned in space, each of them moved by about
 * what planes may be apart, or by about what shafts take for rounding; and with a large quad under
 * the lowest, nearer than rays start. */
static const char *const ways[WAYS] = {"straight", "turned", "apart", "rough", "covered"};

/* Shelves of TILES x TILES quads each, every other one upside down. */
static void open_shelves(struct world *w, int way, uint64_t *seed)
{
    const double unit = RAY_OFFSET * SHAFT_SLACK, n = 1.0 / TILES,
                 rough = way == 2   ? unit
                         : way == 3 ? unit * 16
                                    : 0;
    memset(w, 0, sizeof *w);
    made_open(&w->scene);
    made_material(&w->scene, 0.5, 1);
    for (int i = 0; i < SHELVES * TILES * TILES; i++) {
        const int shelf = i / (TILES * TILES), x = i % TILES, y = i / TILES % TILES;
        const double over = shelf % 2;
        made_quad(&w->scene, 0, n * x, n * y, shelf, n * (1 - over), n * over, 0, n * over,
                  n * (1 - over), 0);
    }
    if (way == 4)
        made_quad(&w->scene, 0, 0, 0, -0.9 * (SHELVES - 1) * RAY_OFFSET, 1, 0, 0, 0, 1, 0);
    if (way == 1)
        rotate(&w->scene, seed);
    for (uint32_t i = 0; i < w->scene.face_count && rough > 0; i++)
        for (int v = 0; v < 4; v++)
            for (int k = 0; k < 3; k++)
                w->scene.faces[i].vertex[v][k] += rough / TILES * (random_unit(seed) - 0.5);
    start_world(w, 1);
}

/* The faces of a flat cluster are in its plane all over the scene, by either way to tell that; and
 * every shelf is such clusters, of half of it at least, unless its corners are moved by more than
 * that. */
START_TEST(test_planes)
{
    uint64_t seed = 5;
    struct world w;
    open_shelves(&w, _i, &seed);
    const struct hierarchy *h = &w.h;
    uint32_t flat = 0, large = 0;
    for (uint32_t e = 0; e < h->built; e++) {
        const struct element *plane = &h->elements[h->plane[e]];
        if (h->elements[e].vertices || !h->plane[e])
            continue;
        flat++;
        const struct face_range range = h->range[e];
        if (range.to - range.from >= TILES * TILES / 2 && !h->plane[h->elements[e].parent])
            large += range.to - range.from;
        for (uint32_t i = range.from; i < range.to; i++) {
            const double(*v)[3] = (const double(*)[3])h->faces[h->order[i]].vertex;
            double normal[3];
            ck_assert(shaft_normal(v, 4, normal));
            const double same = dot3(normal, plane->normal) < 0 ? -1 : 1;
            for (int c = 0; c < 8; c++) {
                const double x[3] = {c & 1 ? h->high[0] : h->low[0], c & 2 ? h->high[1] : h->low[1],
                                     c & 4 ? h->high[2] : h->low[2]};
                ck_assert_double_le(fabs(height3(x, plane->vertex[0], plane->normal)
                                         - same * height3(x, v[0], normal)),
                                    FLAT_APART * w.host->extent);
            }
        }
    }
    printf("%-9s %u flat clusters, the large ones of %u of %u faces\n", ways[_i], flat, large,
           h->face_count);
    fflush(stdout);
    ck_assert_uint_ge(large, _i < 2 ? h->face_count * 3 / 4 : 0);
    ck_assert(_i != 3 || large == 0);
    close_world(&w);
}
END_TEST

/* Returns how many there are; -1: the two do not face each other. */
static int find(const struct world *w, const uint32_t pair[2], uint32_t list[MOST])
{
    struct shaft shaft;
    return shaft_open(&shaft, &w->h.elements[pair[0]], &w->h.elements[pair[1]], w->host)
               ? candidates_find(&w->h, &shaft, w->host->ray_offset, MOST, list)
               : -1;
}

/* What stands in a shaft is what stands in it when no plane is known. lowest: all shafts are
 * from the last face. */
static void compare(struct world *w, int lowest, uint64_t *seed, const char *name)
{
    int listed = 0, open = 0;
    for (int i = 0; i < 3000; i++) {
        uint32_t pair[2], a[MOST], b[MOST], *plane = w->h.plane;
        random_pair(w, seed, 3, pair);
        if (lowest)
            pair[0] = w->h.face_element[w->h.face_count - 1];
        const int n = find(w, pair, a);
        w->h.plane = NULL;
        const int m = find(w, pair, b);
        w->h.plane = plane;
        ck_assert_int_eq(n, m);
        for (int k = 0; k < n && n <= MOST; k++)
            ck_assert_uint_eq(a[k], b[k]);
        listed += n > 0;
        open += n == 0;
    }
    printf("%-16s %d shafts with something in them, %d with nothing\n", name, listed, open);
    ck_assert_int_gt(listed, 100);
}

START_TEST(test_shelves)
{
    uint64_t seed = 50 + (uint64_t)_i;
    struct world w;
    open_shelves(&w, _i, &seed);
    compare(&w, _i == 4, &seed, ways[_i]);
    close_world(&w);
}
END_TEST

START_TEST(test_worlds)
{
    uint64_t seed = 70 + (uint64_t)_i;
    struct world w;
    open_world(&w, _i, &seed, 1);
    compare(&w, 0, &seed, kinds[_i]);
    close_world(&w);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("flat clusters");
    TCase *c = tcase_create("flat clusters");
    tcase_set_timeout(c, 60);
    tcase_add_loop_test(c, test_planes, 0, WAYS);
    tcase_add_loop_test(c, test_shelves, 0, WAYS);
    tcase_add_loop_test(c, test_worlds, 0, KINDS);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
