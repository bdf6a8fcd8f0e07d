/* check_causes.c - are the causes of what links bring wrongly told apart?
 *
 * In a furnace B is the same everywhere, so links that are spoilt by a known amount bring wrongly
 * by a known share, and every reflection multiplies it by 1 / (1 - rho). In rooms made so that one
 * cause dominates, that one is named. In any scene causes add up to what is measured without links,
 * and after all reflections to the error that particles, counted from the emitters, measure.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "make_solve.h"
#include "engine/error_causes.h"
#include "engine/link_cover.h"
#include "engine/measured_error.h"
#include "kernel/point_factor.h"
#include "suite.h"

static struct RadCausesReport causes_of(struct solve *s, uint64_t rays)
{
    struct RadCausesReport r;
    ck_assert_int_eq(error_causes_find(s, rays, 0, &r), 0);
    ck_assert(r.rays > rays / 4 && r.rays < 4 * rays);
    return r;
}

static void check_sums(const struct RadCausesReport *r)
{
    double power = 0, after = 0;
    for (int i = 0; i < RAD_CAUSES; i++) {
        const struct RadCause *c = &r->cause[i];
        power += c->power.value;
        after += c->after.value;
        ck_assert(c->l1.low <= c->l1.value && c->l1.value <= c->l1.high);
        ck_assert(c->l1.value >= fabs(c->power.value));
        ck_assert(c->after_l1.value >= fabs(c->after.value));
    }
    ck_assert_double_eq_tol(power, r->together.power.value, 1e-10);
    ck_assert_double_eq_tol(after, r->together.after.value, 1e-10);
}

/* ---- a furnace of rho 1/2 whose links are spoilt */

enum { MANY = 100000 };

/* A link for each pair of faces. */
static void furnace(struct scene *scene, struct solve *s)
{
    char *settings[] = {"relative=100", NULL};
    furnace_cube(scene, 0.5);
    solve_with(s, scene, "bf", RELEASE_FLAT, settings, quick(2));
    ck_assert_uint_eq(s->refinement.link_count, 30);
}

/* Solve again with form factors times `factor`, and visibilities (of links from face `emitter`, or
 * of all: -1) times `visible`. */
static void spoil(struct solve *s, double factor, double visible, int emitter)
{
    struct refinement *r = &s->refinement;
    float *f = malloc(r->link_count * sizeof *f);
    const char *cause;
    for (size_t i = 0; i < r->link_count; i++) {
        struct link *l = &r->links[i];
        f[i] = l->form_factor * (float)factor;
        if (emitter < 0 || s->hierarchy.elements[l->emitter].face == (uint32_t)emitter)
            l->visibility = (uint16_t)(l->visibility * visible);
    }
    ck_assert_int_eq(solve_with_factors(s, f, &cause), 0);
    free(f);
}

/* All that is wrong is `power` of the reflected light, by one cause; every reflection halves light,
 * so that comes to twice as much. */
static void check_only(const struct RadCausesReport *r, enum RadCauseKind kind, double power)
{
    check_sums(r);
    for (int i = 0; i < RAD_CAUSES; i++) {
        double wanted = i == (int)kind ? power : 0;
        ck_assert_double_eq_tol(r->cause[i].power.value, wanted, 3e-3);
        ck_assert_double_eq_tol(r->cause[i].after.value, 2 * wanted, 8e-3);
        ck_assert_double_eq_tol(r->cause[i].l1.value, fabs(wanted), 3e-3);
    }
    ck_assert(r->together.power.low <= power && power <= r->together.power.high);
}

START_TEST(test_right)
{
    struct scene scene;
    struct solve s;
    furnace(&scene, &s);
    struct RadCausesReport r = causes_of(&s, MANY);
    check_only(&r, RAD_CAUSE_SOLVER, 0);
    ck_assert_double_eq_tol(r.way[RAD_WAY_OPEN].links, 1, 1e-3);
    ck_assert_double_eq_tol(r.way[RAD_WAY_OPEN].rays, 1, 1e-3);
    ck_assert_double_eq_tol(r.reflected, 6, 1e-3);
    solve_close(&s);
    scene_free(&scene);
}
END_TEST

/* F 2 % too large: B = 1 / (1 - .51), and .02 / 1.02 of what it reflects is too much. */
START_TEST(test_kernel)
{
    struct scene scene;
    struct solve s;
    furnace(&scene, &s);
    spoil(&s, 1.02, 1, -1);
    struct RadCausesReport r = causes_of(&s, MANY);
    check_only(&r, RAD_CAUSE_OPEN_KERNEL, 0.02 / 1.02);
    solve_close(&s);
    scene_free(&scene);
}
END_TEST

/* V 3/4 where nothing is between: a third of what is reflected is missing. */
START_TEST(test_visibility)
{
    struct scene scene;
    struct solve s;
    furnace(&scene, &s);
    spoil(&s, 1, 0.75, -1);
    struct RadCausesReport r = causes_of(&s, MANY);
    check_only(&r, RAD_CAUSE_HALF_VISIBILITY, -1.0 / 3);
    ck_assert_double_eq(r.way[RAD_WAY_OPEN].links, 0);
    solve_close(&s);
    scene_free(&scene);
}
END_TEST

/* The light of one face is given up. The others have B = 5/3, it has 11/6, and they lack a fifth of
 * that: 11/12 W of the 25/6 W that are reflected. */
START_TEST(test_lost)
{
    struct scene scene;
    struct solve s;
    furnace(&scene, &s);
    spoil(&s, 1, 0, 0);
    struct RadCausesReport r = causes_of(&s, MANY);
    check_only(&r, RAD_CAUSE_LOST, -0.22);
    ck_assert_double_eq_tol(r.way[RAD_WAY_NONE].rays, 0.22, 3e-3);
    solve_close(&s);
    scene_free(&scene);
}
END_TEST

/* ---- rooms in which one cause dominates */

/* The share of two causes in what is wrong after all reflections. */
static double share_of(const struct RadCausesReport *r, enum RadCauseKind a, enum RadCauseKind b)
{
    double sum = 0;
    for (int i = 0; i < RAD_CAUSES; i++)
        sum += r->cause[i].after_l1.value;
    return (r->cause[a].after_l1.value + (a == b ? 0 : r->cause[b].after_l1.value)) / sum;
}

/* The causes of a solution by `bf`, which add up. Frees the scene. */
static struct RadCausesReport causes_by(struct scene *scene, char *const *settings)
{
    struct solve s;
    solve_with(&s, scene, "bf", RELEASE_FLAT, settings, quick(2));
    struct RadCausesReport r = causes_of(&s, MANY / 2);
    check_sums(&r);
    solve_close(&s);
    scene_free(scene);
    return r;
}

/* The room's walls, floor and ceiling of one material, 3 m high; a lamp that shines up, .1 m below
 * the ceiling: the spot above it is seen by hardly anything else. */
static void room_of_lamp(struct scene *scene)
{
    made_open(scene);
    uint32_t wall = made_material(scene, 0.6, 0), lamp = made_material(scene, 0, 100);
    const uint32_t walls[6] = {wall, wall, wall, wall, wall, wall};
    made_room(scene, walls, 4, 4, 3);
    made_quad(scene, lamp, 1.2, 1.3, 2.9, 1, 0, 0, 0, 1, 0);
}

/* The ceiling is split for the lamp and sends as a whole: a hidden bright spot. */
START_TEST(test_bright_spot)
{
    char *settings[] = {"relative=0.5", NULL};
    struct scene scene;
    room_of_lamp(&scene);
    struct RadCausesReport r = causes_by(&scene, settings);
    ck_assert_double_gt(share_of(&r, RAD_CAUSE_OPEN_BRIGHT, RAD_CAUSE_HALF_BRIGHT), 0.6);
    ck_assert_double_gt(r.cause[RAD_CAUSE_OPEN_BRIGHT].power.low, 0);
}
END_TEST

/* The ceiling is not split: light is spread over all of it, though most of what reaches it cannot
 * leave. By polygon that is not seen. */
START_TEST(test_spread)
{
    char *settings[] = {"relative=0.01", "min_share=0.1", NULL};
    struct scene scene;
    room_of_lamp(&scene);
    struct RadCausesReport r = causes_by(&scene, settings);
    ck_assert_double_gt(share_of(&r, RAD_CAUSE_OPEN_SPREAD, RAD_CAUSE_HALF_SPREAD), 0.6);
    ck_assert_double_gt(r.cause[RAD_CAUSE_OPEN_SPREAD].after.low, 0);
    ck_assert_double_lt(r.together.l1.value, 0.1 * r.together.after.value);
}
END_TEST

/* Two rooms, and a slit of 6 mm in the wall between them. All that is in the one shines evenly; the
 * other has a dim lamp, and light that comes by the slit, which four rays do not find. */
START_TEST(test_slit)
{
    char *settings[] = {"rays=4", "relative=100", NULL};
    struct scene scene;
    const double wide[2] = {1.297, 0.697}; /* beside the slit */
    made_open(&scene);
    uint32_t dark = made_material(&scene, 0.5, 0), bright = made_material(&scene, 0, 1);
    uint32_t dim = made_material(&scene, 0.5, 0.01);
    for (int room = 0; room < 2; room++) {
        uint32_t m = room ? dark : bright;
        double x = 2 * room;
        made_quad(&scene, m, x, 0, 0, 2, 0, 0, 0, 2, 0);
        made_quad(&scene, m, x, 0, 2, 0, 2, 0, 2, 0, 0);
        made_quad(&scene, m, x, 0, 0, 0, 0, 2, 2, 0, 0);
        made_quad(&scene, m, x, 2, 0, 2, 0, 0, 0, 0, 2);
        made_quad(&scene, room ? dim : m, 4 * room, 0, 0, 0, room ? 0 : 2, room ? 2 : 0, 0,
                  room ? 2 : 0, room ? 0 : 2);
        for (int side = 0; side < 2; side++) /* of the slit */
            made_quad(&scene, m, 2, side * 1.303, 0, 0, room ? wide[side] : 0, room ? 0 : 2, 0,
                      room ? 0 : wide[side], room ? 2 : 0);
    }
    struct RadCausesReport r = causes_by(&scene, settings);
    ck_assert_double_gt(share_of(&r, RAD_CAUSE_LOST, RAD_CAUSE_LOST), 0.9);
    ck_assert_double_lt(r.cause[RAD_CAUSE_LOST].power.high, 0);
}
END_TEST

/* Form factors from the receiver's centre, in an empty box with a bright wall. */
START_TEST(test_points)
{
    char *settings[] = {"relative=100", NULL};
    struct scene scene;
    struct solve s;
    const char *cause;
    float factor[30];
    made_open(&scene);
    uint32_t wall = made_material(&scene, 0.6, 0), lamp = made_material(&scene, 0.6, 100);
    const uint32_t walls[6] = {wall, wall, wall, wall, lamp, wall};
    made_room(&scene, walls, 4, 2, 2);
    solve_with(&s, &scene, "bf", RELEASE_FLAT, settings, quick(2));
    ck_assert_uint_eq(s.refinement.link_count, 30);
    for (int i = 0; i < 30; i++) {
        const struct link *l = &s.refinement.links[i];
        factor[i] = (float)point_factor(&s.hierarchy.elements[l->receiver],
                                        &s.hierarchy.elements[l->emitter]);
    }
    ck_assert_int_eq(solve_with_factors(&s, factor, &cause), 0);
    struct RadCausesReport r = causes_of(&s, MANY / 2);
    check_sums(&r);
    ck_assert_double_gt(share_of(&r, RAD_CAUSE_OPEN_KERNEL, RAD_CAUSE_OPEN_KERNEL), 0.8);
    ck_assert_double_gt(r.together.l1.low, 0.05);
    solve_close(&s);
    scene_free(&scene);
}
END_TEST

/* Nothing but lost light: the solution reflects none, and shares are of what rays find. */
START_TEST(test_all_lost)
{
    struct scene scene;
    struct solve s;
    made_open(&scene);
    uint32_t wall = made_material(&scene, 0.5, 0), lamp = made_material(&scene, 0, 1);
    made_quad(&scene, wall, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    made_quad(&scene, lamp, 0, 0, 1, 0, 1, 0, 1, 0, 0);
    solve_with(&s, &scene, "bf", RELEASE_FLAT, NULL, quick(2));
    spoil(&s, 1, 0, -1);
    struct RadCausesReport r = causes_of(&s, MANY / 2);
    check_sums(&r);
    ck_assert_double_eq_tol(r.reflected, 0.5 * 0.1998, 1e-3); /* parallel unit squares */
    ck_assert_double_eq_tol(r.cause[RAD_CAUSE_LOST].power.value, -1, 1e-12);
    solve_close(&s);
    scene_free(&scene);
}
END_TEST

static int keep_share(void *context, const struct solve *s, const char *phase)
{
    double *share = context;
    if (strcmp(phase, "causes") == 0) {
        ck_assert_double_ge(s->counting->share, *share);
        *share = s->counting->share;
    }
    return 0;
}

/* Of faces that have less than a point each it is told, too, how far the work is. */
START_TEST(test_share)
{
    enum { TILES = 20 };
    struct scene scene;
    struct solve s;
    double share = 0;
    made_open(&scene);
    uint32_t white = made_material(&scene, 0.5, 1);
    for (int face = 0; face < 6; face++)
        for (int i = 0; i < TILES * TILES; i++)
            made_tile(&scene, white, 0, face, i, TILES, 1);
    solve_with(&s, &scene, "power", RELEASE_FLAT, NULL, quick(1));
    s.problem.options.progress = keep_share;
    s.problem.options.context = &share;
    (void)causes_of(&s, 3000);
    ck_assert_double_ge(share, 0.99);
    ck_assert_double_le(share, 1);
    solve_close(&s);
    scene_free(&scene);
}
END_TEST

/* A lamp in a room, shining down, and above it one side of a board; and `flakes` of 6 cm with two
 * sides each. */
static void furnished_room(struct scene *scene, int flakes)
{
    made_open(scene);
    uint32_t wall = made_material(scene, 0.7, 0), lamp = made_material(scene, 0.2, 50);
    const uint32_t walls[6] = {wall, wall, wall, wall, wall, wall};
    made_room(scene, walls, 4, 4, 3);
    made_quad(scene, lamp, 1.5, 1.5, 2.6, 0, 1, 0, 1, 0, 0);
    made_quad(scene, wall, 1.5, 1.5, 2.7, 1, 0, 0, 0, 1, 0);
    for (int i = 0; i < flakes; i++) {
        double x = 0.4 + 0.1 * (i % 8), y = 0.4 + 0.1 * (i / 8 % 8), z = 0.4 + 0.5 * (i / 64);
        made_quad(scene, wall, x, y, z, 0.06, 0, 0, 0, 0.06, 0);
        made_quad(scene, wall, x, y, z, 0, 0.06, 0, 0.06, 0, 0);
    }
    for (int i = 0; i < 8 && flakes == 0; i++) { /* shelves */
        double z = 0.3 + 0.25 * i;
        made_quad(scene, wall, 0.4, 0.4, z, 1, 0, 0, 0, 3, 0);
        made_quad(scene, wall, 0.4, 0.4, z - 0.02, 0, 3, 0, 1, 0, 0);
    }
}

/* Causes add up after all reflections to what particles measure, and threads do not show; other
 * radiosities have other causes. */
static void check_particles(const char *oracle, char *const *settings, int flakes)
{
    struct scene scene;
    struct solve s;
    struct measured_error m;
    const char *cause;
    furnished_room(&scene, flakes);
    solve_with(&s, &scene, oracle, RELEASE_FLAT, settings, quick(2));
    struct RadCausesReport r = causes_of(&s, MANY), once;
    check_sums(&r);
    ck_assert_int_eq(measure_error(&s, 2 * MANY, 1, 0, &m, &cause), 0);
    double counted = m.faces.reflected / r.reflected,
           doubt = fmax(r.together.after.high - r.together.after.value,
                        counted * (m.faces.power.high - m.faces.power.value));
    ck_assert_double_eq_tol(r.together.after.value, counted * m.faces.power.value, 2 * doubt);
    if (flakes == 0) /* there is something to find */
        ck_assert_double_gt(fabs(r.together.after.value), doubt);
    ck_assert_int_eq(r.way[RAD_WAY_GROUPS].links > 0.01, flakes > 0);
    s.problem.options.threads = 1;
    once = causes_of(&s, MANY);
    ck_assert(memcmp(&once, &r, sizeof r) == 0);
    /* were the same radiosity everywhere, no spot would be bright */
    for (uint32_t e = 0; e < s.hierarchy.count; e++)
        s.state.radiosity[e] = 2;
    r = causes_of(&s, MANY / 4);
    check_sums(&r);
    ck_assert_double_eq_tol(r.cause[RAD_CAUSE_OPEN_BRIGHT].l1.value, 0, 1e-12);
    ck_assert_double_eq_tol(r.cause[RAD_CAUSE_HALF_BRIGHT].l1.value, 0, 1e-12);
    ck_assert_double_eq_tol(r.cause[RAD_CAUSE_GROUPS_BRIGHT].l1.value, 0, 1e-6);
    measured_error_free(&m);
    solve_close(&s);
    scene_free(&scene);
}

START_TEST(test_particles)
{
    char *settings[] = {"relative=1", "shadow=1", NULL};
    check_particles("bf_guarded", settings, 0);
}
END_TEST

START_TEST(test_groups)
{
    char *settings[] = {"relative=1", "dim=10",         "shadow=1", "spread=100",
                        "faint=0.1",  "min_share=1e-3", NULL};
    check_particles("clusters", settings, 128);
}
END_TEST

/* ---- which link covers two leaves */

static int is_above(const struct element *elements, uint32_t a, uint32_t e)
{
    while (e != a && e != 0)
        e = elements[e].parent;
    return e == a;
}

/* The link found must be the only one, of those that bring something, whose receiver holds the one
 * leaf and whose emitter the other. Returns how many links of groups were found. */
static int check_covers(const struct solve *s, struct link_cover *c, uint32_t leaf)
{
    const struct refinement *r = &s->refinement;
    const struct separable_links *groups = &s->operator.separable;
    const struct element *elements = s->hierarchy.elements;
    int found = 0;
    for (uint32_t e = 0; e < s->hierarchy.count; e++) {
        if (elements[e].children)
            continue;
        struct covering by = link_cover_find(c, e);
        const struct link *only = NULL;
        size_t group = 0;
        for (uint32_t up = leaf;; up = elements[up].parent) {
            size_t g = groups->count ? groups->first[up] : 0;
            for (size_t i = r->first_link[up]; i < r->first_link[up + 1]; i++) {
                const struct link *l = &r->links[i];
                if (l->visibility > 0 && is_above(elements, l->emitter, e)) {
                    ck_assert_ptr_null(only);
                    only = l;
                    group = g;
                }
                g += (size_t)link_is_separable(&s->hierarchy, l);
            }
            if (up == 0)
                break;
        }
        ck_assert_int_eq(by.way == RAD_WAY_NONE, only == NULL);
        if (by.way == RAD_WAY_GROUPS) {
            ck_assert_uint_eq(by.group, group);
            ck_assert_uint_eq(groups->links[group].emitter, only->emitter);
            found++;
        } else if (only)
            ck_assert_ptr_eq(by.link, only);
    }
    return found;
}

START_TEST(test_covers)
{
    char *settings[] = {"relative=1", "dim=10",         "shadow=1", "spread=100",
                        "faint=0.1",  "min_share=1e-3", NULL};
    struct scene scene;
    struct solve s;
    struct link_cover c;
    int groups = 0;
    furnished_room(&scene, 128);
    solve_with(&s, &scene, "clusters", RELEASE_FLAT, settings, quick(2));
    const struct element *elements = s.hierarchy.elements;
    ck_assert_int_eq(link_cover_open(&c, &s.operator), 0);
    for (uint32_t i = 0; i < 6; i++) {
        /* to a face by way of clusters near and far, and down to its last leaf */
        uint32_t e = s.hierarchy.face_element[(i * 197) % s.hierarchy.face_count], down = e;
        link_cover_move(&c, elements[e].parent);
        link_cover_mark(&c, down, 1);
        while (elements[down].children) {
            down = elements[down].child + elements[down].children - 1u;
            link_cover_mark(&c, down, 1);
        }
        groups += check_covers(&s, &c, down);
        for (; down != elements[e].parent; down = elements[down].parent)
            link_cover_mark(&c, down, 0);
    }
    ck_assert_int_gt(groups, 20);
    link_cover_close(&c);
    solve_close(&s);
    scene_free(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("causes");
    TCase *known = tcase_create("known"), *rooms = tcase_create("rooms");
    tcase_add_test(known, test_right);
    tcase_add_test(known, test_kernel);
    tcase_add_test(known, test_visibility);
    tcase_add_test(known, test_lost);
    suite_add_tcase(suite, known);
    tcase_add_test(rooms, test_bright_spot);
    tcase_add_test(rooms, test_spread);
    tcase_add_test(rooms, test_slit);
    tcase_add_test(rooms, test_points);
    tcase_add_test(rooms, test_all_lost);
    tcase_add_test(rooms, test_share);
    tcase_add_test(rooms, test_particles);
    tcase_add_test(rooms, test_groups);
    tcase_add_test(rooms, test_covers);
    tcase_set_timeout(known, 60);
    tcase_set_timeout(rooms, 60);
    suite_add_tcase(suite, rooms);
    return suite_failures(suite) != 0;
}
