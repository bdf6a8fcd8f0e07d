/* check_visible_parts.c - what tools say of parts that are seen, by exact parts and by rays,
 * against closed forms; of the size of features and of fog.
 *
 * Once is enough: it is about numbers; that memory is used well, shorter suites tell.
 * SPDX-License-Identifier: MIT */
#include "engine/refine.h"
#include "shaft_worlds.h"
#include "terms/visibility_error.h"
#include "tools/cluster_visibility.h"
#include "tools/exact_visibility.h"
#include "tools/extinction.h"
#include "tools/feature_size.h"
#include "tools/presume_visible.h"
#include "tools/reference.h"
#include "tools/trace_reference.h"
#include "tools/visibility.h"
#include "util/spared_rays.h"

/* ---- visibility by parts and by rays */

/* Two unit squares, facing each other across the distance 1, and what a test puts between. */
static void open_squares(struct world *w)
{
    memset(w, 0, sizeof *w);
    made_open(&w->scene);
    made_material(&w->scene, 0.5, 1);
    made_quad(&w->scene, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    made_quad(&w->scene, 0, 0, 0, 1, 0, 1, 0, 1, 0, 0);
}

static struct discussion discuss_faces(const struct world *w, uint32_t r, uint32_t s)
{
    struct discussion d;
    memset(&d, 0, sizeof d);
    d.receiver = hierarchy_surface(&w->h, r);
    d.emitter = hierarchy_surface(&w->h, s);
    d.host = w->host;
    return d;
}

/* V by the exact tool, both ways; frees the world. */
static double exact(struct world *w, enum exact_visibility_answer *answer)
{
    struct discussion d, back;
    start_world(w, 1);
    d = discuss_faces(w, 0, 1);
    back = discuss_faces(w, 1, 0);
    *answer = tool_exact_visibility(&d);
    ck_assert_int_eq(tool_exact_visibility(&back), *answer);
    ck_assert(d.terms.visibility == back.terms.visibility);
    ck_assert(d.terms.visibility_level
              == (*answer == EXACT_VISIBILITY_TOO_COMPLEX ? VISIBILITY_RAYS_64 : VISIBILITY_EXACT));
    close_world(w);
    return d.terms.visibility;
}

/* By symmetry each quarter of the middle plane hides a quarter of the light, V F = 3/4 F =
 * .1498686718; any partition of it hides all, each part once; two parts of it hide what the two
 * do. */
START_TEST(test_partition)
{
    enum exact_visibility_answer answer;
    uint64_t seed = 3;
    for (int i = 0; i < 4; i++) {
        struct world w;
        open_squares(&w);
        made_quad(&w.scene, 0, i % 2 * 0.5, i / 2 * 0.5, 0.5, 0.5, 0, 0, 0, 0.5, 0);
        ck_assert_double_eq_tol(exact(&w, &answer), 0.75, 1e-6);
        ck_assert_int_eq(answer, EXACT_VISIBILITY_PARTIAL);
        for (int j = 0; j < i; j++) { /* two quarters, side by side or across */
            open_squares(&w);
            made_quad(&w.scene, 0, i % 2 * 0.5, i / 2 * 0.5, 0.5, 0.5, 0, 0, 0, 0.5, 0);
            made_quad(&w.scene, 0, j % 2 * 0.5, j / 2 * 0.5, 0.5, 0, 0.5, 0, 0.5, 0, 0);
            ck_assert_double_eq_tol(exact(&w, &answer), 0.5, 2e-6);
        }
    }
    ck_assert_double_eq_tol(0.75 * 0.1998248956983874, 0.1498686718, 1e-10);
    for (int round = 0; round < 3; round++) {
        double x = between(&seed, 0.1, 0.9), y = between(&seed, 0.1, 0.9), hidden = 0, pair = 0;
        for (int i = 0; i < 4; i++) {
            double a = i % 2 ? x : 0, b = i % 2 ? 1 : x, c = i / 2 ? y : 0, e = i / 2 ? 1 : y;
            struct world w;
            open_squares(&w);
            made_quad(&w.scene, 0, a, c, 0.5, b - a, 0, 0, 0, e - c, 0);
            double v = exact(&w, &answer);
            hidden += 1 - v;
            pair += i < 2 ? 1 - v : 0;
        }
        ck_assert_double_eq_tol(hidden, 1, 2e-6);
        {
            struct world w;
            open_squares(&w);
            made_quad(&w.scene, 0, 0, 0, 0.5, x, 0, 0, 0, y, 0);
            made_quad(&w.scene, 0, x, 0, 0.5, 1 - x, 0, 0, 0, y, 0);
            ck_assert_double_eq_tol(1 - exact(&w, &answer), pair, 2e-6);
        }
    }
    /* the whole plane; a neighbour of it, which only touches the shaft; and nothing */
    for (int i = 0; i < 3; i++) {
        struct world w;
        open_squares(&w);
        if (i < 2)
            made_quad(&w.scene, 0, i, 0, 0.5, 1, 0, 0, 0, 1, 0);
        ck_assert(exact(&w, &answer) == (i > 0));
        ck_assert_int_eq(answer, i ? EXACT_VISIBILITY_ALL : EXACT_VISIBILITY_NONE);
    }
    {
        struct world w;
        open_squares(&w);
        for (int i = 0; i < 3; i++)
            made_quad(&w.scene, 0, 0.3 * i, 0.3, 0.5, 0.2, 0, 0, 0, 0.2, 0);
        (void)exact(&w, &answer);
        ck_assert_int_eq(answer, EXACT_VISIBILITY_TOO_COMPLEX);
    }
}
END_TEST

/* One and two tilted blockers anywhere, against 400,000 random segments weighted by what they
 * carry: within four and a half standard deviations (significance 4e-5 for the six cases together;
 * the seed is fixed). */
START_TEST(test_random_parts)
{
    const int segments = thorough() ? 400000 : 100000;
    uint64_t seed = 40 + (uint64_t)_i;
    double p[3][3], all = 0, seen = 0, square[2] = {0, 0};
    struct world w;
    open_squares(&w);
    int f;
    for (f = 0; f <= _i % 2; f++) {
        for (int k = 0; k < 9; k++)
            p[k / 3][k % 3] = between(&seed, 0.1, 0.9);
        made_face(&w.scene, 0, 3, (const double(*)[3])p);
    }
    start_world(&w, 1);
    for (int i = 0; i < segments; i++) {
        struct segment g = {{random_unit(&seed), random_unit(&seed), 0},
                            {random_unit(&seed), random_unit(&seed), 1}};
        double d[3];
        sub3(d, g.to, g.from);
        double weight = 1 / (dot3(d, d) * dot3(d, d));
        all += weight;
        for (f = 2; f < (int)w.scene.face_count; f++)
            if (crosses_triangle(&g, w.scene.faces[f].vertex[0], w.scene.faces[f].vertex[1],
                                 w.scene.faces[f].vertex[2], 0, 0))
                break;
        if (f == (int)w.scene.face_count)
            seen += weight;
        square[f == (int)w.scene.face_count] += weight * weight;
    }
    double v = seen / all; /* of a ratio of sums: sum w^2 (I - V)^2 */
    double error = 4.5 * sqrt(square[1] * (1 - v) * (1 - v) + square[0] * v * v) / all;
    rays_close(w.rays);
    hierarchy_free(&w.h);
    enum exact_visibility_answer answer;
    v = exact(&w, &answer);
    printf("%d blockers: V = %.6f, by segments %.6f +- %.6f\n", 1 + _i % 2, v, seen / all, error);
    ck_assert_int_eq(answer, EXACT_VISIBILITY_PARTIAL);
    ck_assert_double_eq_tol(v, seen / all, error);
}
END_TEST

/* Point values of a penumbra as limits of a tiny receiver: source a unit square at z = 2,
 * occluder of side .75 at z = 1. */
START_TEST(test_penumbra)
{
    static const double at[] = {0.25, 0.5, 0.75, 1, 1.5};
    static const double right[] = {0, 0.0189169153, 0.0337198400, 0.0405845563, 0.0326632655};
    static const int power[] = {0, -20, 17};
    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
        double v[3];
        for (int k = 0; k < 3; k++) {
            const double side = 1e-5;
            struct world w;
            memset(&w, 0, sizeof w);
            made_open(&w.scene);
            made_material(&w.scene, 0.5, 1);
            made_quad(&w.scene, 0, at[i] - side / 2, -side / 2, 0, side, 0, 0, 0, side, 0);
            made_quad(&w.scene, 0, -0.5, -0.5, 2, 0, 1, 0, 1, 0, 0);
            made_quad(&w.scene, 0, -0.375, -0.375, 1, 0.75, 0, 0, 0, 0.75, 0);
            made_scale(&w.scene, ldexp(1, power[k]));
            start_world(&w, 1);
            struct discussion d;
            d = discuss_faces(&w, 0, 1);
            ck_assert(tool_exact_visibility(&d) != EXACT_VISIBILITY_TOO_COMPLEX);
            v[k] = d.terms.visibility * polygon_factor(d.receiver, d.emitter, 1);
            /* the first is where the umbra ends */
            ck_assert_double_eq_tol(v[k], right[i], i ? 1e-9 : 1e-6);
            d = discuss_faces(&w, 0, 1);
            (void)tool_visibility(&d, 1024, 0);
            ck_assert_int_eq(d.terms.visibility_level, VISIBILITY_RAYS_1024);
            ck_assert_double_eq_tol(d.terms.visibility * polygon_factor(d.receiver, d.emitter, 1),
                                    right[i], 1e-3);
            close_world(&w);
        }
        ck_assert(v[1] == v[0] && v[2] == v[0]);
    }
}
END_TEST

/* More rays, more levels; sigma_V is what the formula says and about what the rays do. */
START_TEST(test_levels)
{
    static const struct {
        int asked, cast;
        enum visibility_level level;
    } way[] = {
        {4, 4, VISIBILITY_RAYS_4},          {5, 16, VISIBILITY_RAYS_16},
        {64, 64, VISIBILITY_RAYS_64},       {65, 256, VISIBILITY_RAYS_256},
        {256, 256, VISIBILITY_RAYS_256},    {1000, 1024, VISIBILITY_RAYS_1024},
        {1024, 1024, VISIBILITY_RAYS_1024},
    };
    struct world w;
    open_squares(&w);
    made_quad(&w.scene, 0, 0.2, 0.1, 0.4, 0.5, 0, 0.2, 0, 0.6, 0);
    enum exact_visibility_answer answer;
    double v = exact(&w, &answer);
    open_squares(&w);
    made_quad(&w.scene, 0, 0.2, 0.1, 0.4, 0.5, 0, 0.2, 0, 0.6, 0);
    start_world(&w, 1);
    for (size_t i = 0; i < sizeof way / sizeof *way; i++) {
        struct discussion d = discuss_faces(&w, 0, 1);
        uint64_t before = rays_count(w.rays).rays;
        ck_assert(term_visibility_error(&d) == 0.5);
        (void)tool_visibility(&d, way[i].asked, 0);
        ck_assert_int_eq((int)(rays_count(w.rays).rays - before), way[i].cast);
        ck_assert_int_eq(d.terms.visibility_level, way[i].level);
        double sigma = term_visibility_error(&d);
        ck_assert_double_eq_tol(
            sigma, sqrt(d.terms.visibility * (1 - d.terms.visibility) / way[i].cast), 1e-15);
        /* a net does better than chance; the pair is fixed */
        ck_assert_double_eq_tol(d.terms.visibility, v, 3 * sigma);
        (void)tool_visibility(&d, 4, 0); /* known better already */
        ck_assert_int_eq((int)(rays_count(w.rays).rays - before), way[i].cast);
        (void)tool_extinction(&d);
        ck_assert_int_eq(d.terms.visibility_level, way[i].level);
    }
    ck_assert(visibility_error_of(1, VISIBILITY_RAYS_16) == 1 / 16.0
              && visibility_error_of(0, VISIBILITY_RAYS_256) == 1 / 256.0);
    ck_assert(visibility_error_of(0.3, VISIBILITY_EXACT) == 0
              && visibility_error_of(0.5, VISIBILITY_EXTINCTION) == 0.5);
    { /* the reference leaves the visibility alone */
        struct discussion d = discuss_faces(&w, 0, 1);
        uint64_t before = rays_count(w.rays).rays;
        (void)tool_visibility(&d, 4, 0);
        (void)tool_trace_reference(&d, 2000);
        ck_assert_int_eq((int)(rays_count(w.rays).rays - before), 4 + 4096);
        ck_assert_int_eq(tool_reference(&d), REFERENCE_PARTIAL);
        ck_assert_double_eq_tol(d.terms.reference, v, 3 * sqrt(v * (1 - v) / 4096));
        ck_assert_int_eq(d.terms.visibility_level, VISIBILITY_RAYS_4);
        d = discuss_faces(&w, 1, 2); /* nothing between, and no ray */
        before = rays_count(w.rays).rays;
        ck_assert_int_eq(tool_reference(&d), REFERENCE_ALL);
        ck_assert_uint_eq(rays_count(w.rays).rays, before);
        ck_assert_int_eq(d.terms.visibility_level, VISIBILITY_ABSENT);
    }
    close_world(&w);
}
END_TEST

/* A refiner that opens clusters, casts 16 rays between faces and then does what `state` says. */
static enum decision look(const void *state, struct discussion *d)
{
    const enum decision *then = state;
    if (d->receiver->vertices == 0 || d->emitter->vertices == 0)
        return d->receiver->radius > d->emitter->radius ? DECISION_SUBDIVIDE_RECEIVER
                                                        : DECISION_SUBDIVIDE_EMITTER;
    if (d->receiver == d->emitter || d->receiver->depth + d->emitter->depth > 0)
        return DECISION_STOP;
    (void)tool_visibility(d, 16, 0);
    return *then;
}

/* Be a pair linked or given up: the rays between are cast once for both ways round. */
START_TEST(test_both_ways)
{
    static const enum decision all[] = {DECISION_STOP, DECISION_LINK};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        struct refiner refiner = {.refine = look, .state = &all[i]};
        struct refinement r;
        struct world w;
        open_squares(&w);
        made_quad(&w.scene, 0, 0.2, 0.2, 0.5, 0.5, 0, 0, 0, 0.5, 0);
        start_world(&w, 1);
        int pairs = 0;
        for (uint32_t a = 0; a < w.h.count; a++) /* that rays are cast between, both ways round */
            for (uint32_t b = 0; b < a; b++) {
                struct discussion d = {.receiver = &w.h.elements[a], .emitter = &w.h.elements[b]};
                d.host = w.host;
                if (d.receiver->vertices && d.emitter->vertices) {
                    uint64_t before = rays_count(w.rays).rays;
                    (void)tool_visibility(&d, 16, 0);
                    pairs += rays_count(w.rays).rays > before;
                }
            }
        ck_assert_int_ge(pairs, 2);
        uint64_t before = rays_count(w.rays).rays;
        ck_assert_int_eq(refinement_open(&r, &w.h, w.host, &refiner,
                                         limits_complete((struct limits){0}, NULL), 1),
                         0);
        ck_assert_int_eq(refinement_start(&r), 0);
        ck_assert_uint_eq(rays_count(w.rays).rays - before, 16 * (uint64_t)pairs);
        refinement_close(&r);
        close_world(&w);
    }
}
END_TEST

/* One ray says all or none, the same both ways, and what it says is on the mean what four rays say,
 * which count by what they would carry: over many names of a pair whose nearest parts, which carry
 * the most, do not see each other; of two faces, and of a face and a group. */
START_TEST(test_one_ray)
{
    enum { NAMES = 20000 };
    struct world w;
    memset(&w, 0, sizeof w);
    made_open(&w.scene);
    made_material(&w.scene, 0.5, 1);
    made_quad(&w.scene, 0, 0, 0, 0, 1, 0, 0, 0, 1,
              0); /* a floor, a wall, a board across the edge */
    made_quad(&w.scene, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1);
    made_quad(&w.scene, 0, 0.3, 0, 0.02, -0.28, 0, 0.28, 0, 1, 0);
    for (int i = 0; i < 12; i++) /* tiles above the wall, which the board hides from some */
        made_quad(&w.scene, 0, 0, 0.08 * i, 0.02 + 0.11 * i, 0, 0.06, 0, 0, 0, 0.1);
    start_world(&w, 1);
    uint32_t tile = w.h.face_element[5], group = w.h.elements[tile].parent;
    ck_assert(group > 0 && w.h.elements[group].vertices == 0);
    for (int grouped = 0; grouped < 2; grouped++) {
        struct element r = *hierarchy_surface(&w.h, 0),
                       s = w.h.elements[grouped ? group : w.h.face_element[1]];
        double one = 0, four = 0;
        for (int i = 0; i < NAMES; i++) {
            struct discussion d[3] = {{.receiver = &r, .emitter = &s, .host = w.host},
                                      {.receiver = &s, .emitter = &r, .host = w.host},
                                      {.receiver = &r, .emitter = &s, .host = w.host}};
            r.id = hash64(2 * (uint64_t)i + 1);
            s.id = hash64(2 * (uint64_t)i + 2);
            uint64_t before = rays_count(w.rays).rays + spared_rays;
            for (int k = 0; k < 3; k++)
                grouped ? (void)tool_cluster_visibility(&d[k], k < 2 ? 1 : 4)
                        : (void)tool_visibility(&d[k], k < 2 ? 1 : 4, 0);
            /* what passes the board by takes none */
            ck_assert_uint_eq(rays_count(w.rays).rays + spared_rays - before, 1 + 1 + 4);
            ck_assert_int_eq(d[0].terms.visibility_level, VISIBILITY_RAYS_1);
            ck_assert(d[0].terms.visibility == 0 || d[0].terms.visibility == 1);
            ck_assert(d[1].terms.visibility == d[0].terms.visibility);
            ck_assert(term_visibility_error(&d[0]) == 0.5);
            one += d[0].terms.visibility / NAMES;
            four += d[2].terms.visibility / NAMES;
        }
        printf("one ray: %.4f, four: %.4f\n", one, four);
        ck_assert_double_eq_tol(one, four, 3 * 0.5 / sqrt(NAMES));
        ck_assert(four > 0.2 && four < 0.8);
    }
    close_world(&w);
}
END_TEST

/* ---- features and fog */

/* Parallel squares on one axis: the answer turns where S + (D / t)(C - S) says. */
START_TEST(test_feature)
{
    uint64_t seed = 77;
    int big = 0;
    for (int i = 0; i < 200; i++) {
        double s = between(&seed, 0.2, 1), c = between(&seed, 0.2, 1), far = between(&seed, 1, 4),
               t = far * between(&seed, 0.2, 0.8);
        double f = s + far / t * (c - s);
        struct world w;
        memset(&w, 0, sizeof w);
        made_open(&w.scene);
        made_material(&w.scene, 0.5, 1);
        made_quad(&w.scene, 0, -2, -2, 0, 4, 0, 0, 0, 4, 0);
        made_quad(&w.scene, 0, -s / 2, -s, far, 0, 2 * s, 0, s, 0, 0); /* twice as long as wide */
        made_quad(&w.scene, 0, -c / 2, -c / 2, far - t, c, 0, 0, 0, c, 0);
        start_world(&w, 1);
        struct discussion d;
        d = discuss_faces(&w, 0, 1);
        if (f > 0) {
            double longest = tool_feature_size(&d, f * 1.2) == FEATURE_SIZE_SMALL,
                   least = tool_feature_size(&d, f * 0.8) == FEATURE_SIZE_BIG;
            ck_assert(longest > 0 && least > 0);
            big++;
        } else {
            ck_assert_int_eq(tool_feature_size(&d, 1e-9), FEATURE_SIZE_SMALL);
        }
        d = discuss_faces(&w, 1, 2); /* nothing between */
        ck_assert_int_eq(tool_feature_size(&d, 0), FEATURE_SIZE_SMALL);
        close_world(&w);
    }
    ck_assert_int_gt(big, 50);
}
END_TEST

/* Extinction against a count of points along the segment, cluster by cluster. */
START_TEST(test_extinction)
{
    uint64_t seed = 9;
    int fog = 0;
    struct world w;
    open_world(&w, 2, &seed, 1);
    for (int i = 0; i < 40; i++) {
        uint32_t pair[2];
        double depth = 0;
        random_pair(&w, &seed, 0, pair);
        struct discussion d;
        memset(&d, 0, sizeof d);
        d.receiver = &w.h.elements[pair[0]];
        d.emitter = &w.h.elements[pair[1]];
        d.host = w.host;
        ck_assert_int_eq(tool_presume_visible(&d), PRESUME_VISIBLE_DONE);
        ck_assert(d.terms.visibility == 1 && d.terms.visibility_level == VISIBILITY_PRESUMED);
        ck_assert_int_eq(tool_extinction(&d), EXTINCTION_DONE); /* better than a presumption */
        ck_assert_int_eq(d.terms.visibility_level, VISIBILITY_EXTINCTION);
        (void)tool_presume_visible(&d); /* which leaves what is known alone */
        ck_assert_int_eq(d.terms.visibility_level, VISIBILITY_EXTINCTION);
        for (int j = 0; j < (int)w.h.count; j++) {
            const struct element *e = &w.h.elements[j];
            double area = 0, volume = 1, v[3];
            int own = 0, in = 0;
            if (e->vertices)
                continue;
            for (int c = 0; c < e->children; c++) {
                uint32_t x = e->child + (uint32_t)c;
                own |= x == pair[0] || x == pair[1];
                area += w.h.elements[x].vertices ? w.h.elements[x].area : 0;
            }
            if (own || area <= 0)
                continue;
            sub3(v, d.emitter->centre, d.receiver->centre);
            for (int n = 0; n < 10000; n++) {
                int inside = 1;
                for (int k = 0; k < 3; k++) {
                    double x = d.receiver->centre[k] + (n + 0.5) / 10000 * v[k];
                    inside &= x >= e->vertex[0][k] && x <= e->vertex[1][k];
                }
                in += inside;
            }
            for (int k = 0; k < 3; k++)
                volume *= e->vertex[1][k] - e->vertex[0][k];
            if (in)
                depth += area / (4 * volume) * length3(v) * in / 10000;
        }
        fog += depth > 0.1;
        ck_assert_double_eq_tol(d.terms.visibility, exp(-depth), 2e-3);
    }
    ck_assert_int_gt(fog, 5);
    close_world(&w);
}
END_TEST
int main(void)
{
    Suite *suite = suite_create("visible parts");
    TCase *c = tcase_create("visible parts");
    tcase_set_timeout(c, 120);
    tcase_add_test(c, test_partition);
    tcase_add_loop_test(c, test_random_parts, 0, 6);
    tcase_add_test(c, test_penumbra);
    tcase_add_test(c, test_levels);
    tcase_add_test(c, test_both_ways);
    tcase_add_test(c, test_one_ray);
    tcase_add_test(c, test_feature);
    tcase_add_test(c, test_extinction);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
