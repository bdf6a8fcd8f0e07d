/* Split particles: do they come to what is dim, tell what light it has, and how far they are off;
 * and does mending by them leave what was known before? The truth is that of furnaces.
 * SPDX-License-Identifier: MIT */
#include "runtime/two_furnaces.h"
#include "engine/mend.h"
#include "kernel/constants.h"
#include "suite.h"

/* Split particles: the dark box is met by as many as the bright one, each wall by the light that it
 * has, and how replicates differ is how far they are off. The windows are wrong by half an order of
 * magnitude, here and there. */
static void split_boxes(double dark)
{
    struct scene scene;
    struct solve s;
    struct tally tally;
    two_furnaces(&s, &scene, dark, 2);
    const struct hierarchy *h = &s.hierarchy;
    struct tracer t = solve_tracer(&s);
    float *window = malloc(h->count * sizeof *window);
    for (uint32_t e = 0; e < h->count; e++) {
        uint32_t face = h->elements[e].vertices ? h->elements[e].face : 0;
        window[e] = (float)((face < WALL ? 1 : dark) * (e % 3 == 0 ? 0.3 : 1));
    }
    ck_assert_int_eq(tracer_open(&t), 0);
    ck_assert_int_eq(tally_open(&tally, &t, MEND_STREAM, 1), 0);
    ck_assert_int_eq(tally_split(&tally, &t, window, DIM_LEAST, 1e6), 0);
    ck_assert_int_eq(tally_trace(&tally, &t, 20000, NULL), 0);
    double chi = 0, walls[2] = {0, 0};
    for (uint32_t f = 0; f < h->face_count; f++) {
        double true_light = f < WALL ? 1 : dark, mean = 0, square = 0;
        double area = hierarchy_surface(h, f)->area;
        for (int r = 0; r < REPLICATES; r++) {
            double H = tally_face(&tally, r, f, 0) / area / true_light;
            mean += H / REPLICATES;
            square += H * H / REPLICATES;
        }
        double variance = (square - mean * mean) / (REPLICATES - 1);
        ck_assert_double_lt(sqrt(variance), 0.05);
        chi += (mean - 1) * (mean - 1) / variance;
        walls[f >= WALL] += mean * area / 6;
    }
    ck_assert_double_eq_tol(walls[0], 1, 0.005);
    ck_assert_double_eq_tol(walls[1], 1, 0.005);
    /* of one of h->face_count values Student's t^2, 15 / 13 in the mean, 3.2 its variance */
    double n = h->face_count;
    ck_assert_double_eq_tol(chi, n * 15 / 13, 4 * sqrt(3.2 * n));
    tally_close(&tally);
    tracer_close(&t);
    free(window);
    solve_close(&s);
    made_close(&scene);
}

/* In three bands: a closed room in which light is 1, .05 and .002 W/m2, and each wall reflects what
 * it does of each. Windows are wrong here and there, and differ by band. What lands in each band is
 * right in the mean, and as noisy as replicates say, however few of another band turn into it. */
START_TEST(test_split_bands)
{
    static const double light[3] = {1, 0.05, 0.002};
    static const double rho[6][3] = {{0.9, 0, 0.5},   {0, 0.8, 0.9}, {0, 0, 0.9},
                                     {0.5, 0.5, 0.5}, {0.9, 0.9, 0}, {0, 0.9, 0.3}};
    struct scene scene;
    struct solve s;
    struct tally tally;
    made_open(&scene);
    scene.bands = 3;
    uint32_t walls[6];
    for (int i = 0; i < 6; i++) {
        walls[i] = made_material(&scene, 0, 0);
        for (int k = 0; k < 3; k++) {
            scene.materials[walls[i]].reflectance[k] = rho[i][k];
            scene.materials[walls[i]].exitance[k] = (1 - rho[i][k]) * light[k];
        }
    }
    made_room(&scene, walls, 1, 1, 1);
    solve_with(&s, &scene, "power", RELEASE_FLAT, NULL, quick(2));
    struct tracer t = solve_tracer(&s);
    float *window = malloc(3 * s.hierarchy.count * sizeof *window);
    for (uint32_t i = 0; i < 3 * s.hierarchy.count; i++)
        window[i] = (float)(light[i % 3] * (i % 7 == 0 ? 0.3 : i % 5 == 0 ? 2 : 1));
    ck_assert_int_eq(tracer_open(&t), 0);
    ck_assert_int_eq(tally_open(&tally, &t, MEND_STREAM, 1), 0);
    ck_assert_int_eq(tally_split(&tally, &t, window, DIM_LEAST, 1e6), 0);
    ck_assert_int_eq(tally_trace(&tally, &t, 20000, NULL), 0);
    double chi = 0;
    for (uint32_t f = 0; f < 6; f++)
        for (uint32_t k = 0; k < 3; k++) {
            double h[REPLICATES], mean, variance;
            for (int r = 0; r < REPLICATES; r++)
                h[r] = tally_face(&tally, r, f, k) / light[k];
            mean = replicates_mean(h, &variance);
            ck_assert_double_lt(sqrt(variance), 0.03);
            chi += (mean - 1) * (mean - 1) / variance;
        }
    printf("18 lights of faces are off by %.2f of their noise\n", sqrt(chi / 18));
    ck_assert_double_lt(chi, 18 * 15 / 13.0 + 4 * sqrt(3.2 * 18));
    for (int k = 0; k < 3; k++) /* what others leave behind is not gathered in a few */
        ck_assert_double_lt(tally.square[k], 4 * light[k] * tally.until[t.lights.count - 1]);
    tally_close(&tally);
    tracer_close(&t);
    free(window);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

START_TEST(test_split)
{
    split_boxes(DARK);
}
END_TEST

/* The dark box has a lamp of its own that nobody would miss: as many start there as elsewhere, and
 * what they carry is not gathered in a few. */
START_TEST(test_split_weak_lamp)
{
    split_boxes(1e-10);
}
END_TEST

/* L1 error of the bright walls, leaf by leaf, a share of their light; *leaves: how many. */
static double bright_error(const struct solve *s, uint32_t *leaves)
{
    const struct hierarchy *h = &s->hierarchy;
    double off = 0, area = 0;
    *leaves = 0;
    for (uint32_t e = 0; e < h->count; e++) {
        const struct element *at = &h->elements[e];
        if (!at->vertices || at->children || at->face >= WALL)
            continue;
        off += fabs(s->mended.irradiance[e] - 1) * at->area;
        area += at->area;
        ++*leaves;
    }
    return off / area;
}

/* Split particles come through what is bright, and tell of it, too: what a few have left there,
 * where links know nothing of how light is shared, is less than half as much then. The lamp of
 * the dark box hangs low over its floor, where paths from other walls seldom find it. */
START_TEST(test_split_tells_of_bright)
{
    enum { FEW = 8000, MANY = 200000 };
    static char *settings[] = {"min_share=0.005", NULL};
    static const struct dim_budget none = {0, 0, 0}, split = {1000, 1000, MANY};
    double off[2], root;
    struct dim_count dim;
    for (int i = 0; i < 2; i++) {
        struct scene scene;
        struct solve s;
        uint64_t rays;
        uint32_t leaves;
        made_open(&scene);
        const uint32_t bright = made_material(&scene, RHO, 1 - RHO),
                       dark = made_material(&scene, RHO, 0), lamp = made_material(&scene, 0, 0.1);
        const uint32_t walls[6] = {bright, bright, bright, bright, bright, bright};
        made_room(&scene, walls, 1, 1, 1);
        for (int wall = 0; wall < 6; wall++)
            add_part(&scene, dark, &scene.faces[wall], 1, 0);
        made_quad(&scene, lamp, 5.4, 0.4, 0.01, 0, 0.2, 0, 0.2, 0, 0); /* turned down */
        solve_with(&s, &scene, "bf", RELEASE_FLAT, settings, quick(2));
        for (uint32_t e = 0; e < s.hierarchy.count; e++)
            if (s.hierarchy.elements[e].vertices && s.hierarchy.elements[e].face < WALL) {
                s.state.irradiance[e] *= e % 2 ? 1.3 : 0.7;
                s.state.radiosity[e] = 1 - RHO + RHO * s.state.irradiance[e];
            }
        ck_assert_int_ge(mend_within(&s, FEW, i ? &split : &none, &rays, &root, &dim), 0);
        off[i] = bright_error(&s, &leaves);
        printf("%u leaves off by %.4f: %u rays for dim walls\n", (unsigned)leaves, off[i],
               (unsigned)rays);
        ck_assert_uint_ge(leaves, 24);
        ck_assert(i == 0 || rays > MANY / 2);
        solve_close(&s);
        made_close(&scene);
    }
    ck_assert_double_lt(off[1], 0.5 * off[0]);
}
END_TEST

/* Sum of moduli of what the bright walls lack of their light, over that. */
static double walls_off(const struct solve *s, const double *irradiance)
{
    double off = 0;
    for (uint32_t f = 0; f < WALL; f++)
        off += fabs(irradiance[s->hierarchy.face_element[f]] - 1) / WALL;
    return off;
}

static void count_some(struct tally *tally, const struct tracer *t, uint64_t stream,
                       uint64_t particles)
{
    ck_assert_int_eq(tally_open(tally, t, stream, 1), 0);
    ck_assert_int_eq(tally_trace(tally, t, particles / REPLICATES, NULL), 0);
}

/* Links' light as many have mended it, and as few have mended that again. */
static void mend_twice(const struct solve *s, const struct tally *many, const struct tally *few,
                       double *mended, double *again)
{
    const size_t size = s->hierarchy.count * sizeof *mended;
    memcpy(mended, s->state.irradiance, size);
    ck_assert_int_eq(mend_irradiance(&s->operator, many, mended), 0);
    memcpy(again, mended, size);
    ck_assert_int_eq(mend_again(&s->operator, few, many, s->state.irradiance, again), 0);
}

/* What all faces of a room receive, and reflect (W). */
static void sum_faces(const struct solve *s, const double *irradiance, double sum[2])
{
    sum[0] = sum[1] = 0;
    for (uint32_t f = 0; f < s->hierarchy.face_count; f++) {
        const uint32_t e = s->hierarchy.face_element[f];
        const double light = s->hierarchy.elements[e].area * irradiance[e];
        sum[0] += light;
        sum[1] += s->problem.reflectance[f] * light;
    }
}

/* A room of white and dark tiles, of which links have the white ones too bright and the others too
 * dark. No count of a tile is believed, but that of what all reflect is, and tiles are settled for
 * it: then they receive less than 6 W, which the scene does. Few that count anew leave both. */
START_TEST(test_again_in_all)
{
    enum { TILES = 8 };
    struct scene scene;
    struct solve s;
    struct tally many, few;
    made_open(&scene);
    const uint32_t white = made_material(&scene, 0.9, 0.1), dark = made_material(&scene, 0.1, 0.9);
    const uint32_t walls[6] = {white, dark, white, dark, white, dark};
    made_room(&scene, walls, 1, 1, 1);
    static struct face wall[6];
    memcpy(wall, scene.faces, sizeof wall);
    scene.face_count = scene.input_count = 0;
    for (int i = 0; i < 6; i++)
        for (int part = 0; part < TILES * TILES; part++)
            add_part(&scene, part % 2 ? white : dark, &wall[i], TILES, part);
    static char *settings[] = {"min_share=0.02", NULL};
    solve_with(&s, &scene, "bf", RELEASE_FLAT, settings, quick(2));
    for (uint32_t e = 0; e < s.hierarchy.count; e++)
        if (s.hierarchy.elements[e].vertices)
            s.state.irradiance[e] *=
                scene.faces[s.hierarchy.elements[e].face].material == white ? 1.1 : 0.9;
    const size_t size = s.hierarchy.count * sizeof(double);
    double *mended = malloc(size), *again = malloc(size), before[2], after[2];
    struct tracer t = solve_tracer(&s);
    ck_assert_int_eq(tracer_open(&t), 0);
    count_some(&many, &t, 0, 10000);
    count_some(&few, &t, 1, 2000);
    mend_twice(&s, &many, &few, mended, again);
    sum_faces(&s, mended, before);
    sum_faces(&s, again, after);
    printf("received %.6f, then %.6f; reflected %.6f, then %.6f W; 6 and 3\n", before[0], after[0],
           before[1], after[1]);
    ck_assert_double_lt(before[0], 5.95);
    for (int i = 0; i < 2; i++)
        ck_assert_double_eq_tol(after[i] / before[i], 1, 0.005);
    tally_close(&many);
    tally_close(&few);
    free(mended);
    free(again);
    tracer_close(&t);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* Few that count anew leave what many have mended as it is: of twenty draws in the mean. Without
 * knowing of the many, a cluster alone in its class would often be believed what it got by chance.
 */
START_TEST(test_again)
{
    enum { FEW = 4000, MANY = 400000, DRAWS = 20 };
    struct scene scene;
    struct solve s;
    struct tally many, few;
    two_furnaces(&s, &scene, DARK, 2);
    for (uint32_t e = 0; e < s.hierarchy.count; e++) /* links are off from wall to wall */
        if (s.hierarchy.elements[e].vertices && s.hierarchy.elements[e].face < WALL)
            s.state.irradiance[e] *= s.hierarchy.elements[e].face % 2 ? 1.2 : 0.8;
    const size_t size = s.hierarchy.count * sizeof(double);
    double *mended = malloc(size), *again = malloc(size), off[3] = {0, 0, 0};
    struct tracer t = solve_tracer(&s);
    ck_assert_int_eq(tracer_open(&t), 0);
    for (uint64_t i = 0; i < DRAWS; i++) {
        count_some(&many, &t, 2 * i, MANY);
        count_some(&few, &t, 2 * i + 1, FEW);
        mend_twice(&s, &many, &few, mended, again);
        off[0] += walls_off(&s, mended) / DRAWS;
        off[2] += walls_off(&s, again) / DRAWS;
        ck_assert_double_eq_tol(again[0], mended[0], 1e-12);
        memcpy(again, mended, size);
        ck_assert_int_eq(mend_irradiance(&s.operator, & few, again), 0);
        off[1] += walls_off(&s, again) / DRAWS;
        tally_close(&many);
        tally_close(&few);
    }
    printf("many leave %.5f; few, again, %.5f, knowing of the many %.5f\n", off[0], off[1], off[2]);
    ck_assert_double_gt(off[1], 1.5 * off[0]);
    ck_assert_double_lt(off[2], 1.1 * off[0]);
    free(mended);
    free(again);
    tracer_close(&t);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("split particles");
    TCase *tests = tcase_create("");
    tcase_set_timeout(tests, 60);
    tcase_add_test(tests, test_split);
    tcase_add_test(tests, test_split_bands);
    tcase_add_test(tests, test_split_weak_lamp);
    tcase_add_test(tests, test_split_tells_of_bright);
    tcase_add_test(tests, test_again);
    tcase_add_test(tests, test_again_in_all);
    suite_add_tcase(suite, tests);
    return suite_failures(suite) > 0;
}
