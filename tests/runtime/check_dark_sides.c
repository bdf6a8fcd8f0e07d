/* check_dark_sides.c - sides of two-sided faces that no light comes to.
 *
 * Known cases: solids that stand on a floor, stand in each other, are open, have a hole or a lamp
 * inside. Then rooms by chance, where particles say which sides are lit: none of a dark one is met.
 * And a room with a box whose faces have two sides has the light of the same room with one-sided
 * faces.
 * SPDX-License-Identifier: MIT */
#include "runtime/make_solve.h"
#include "engine/lit_faces.h"
#include "engine/reference.h"
#include "hierarchy/polygon.h"
#include "kernel/hash.h"
#include "suite.h"

enum { POLYGONS = 256 };
enum material { ONE, TWO, LAMP, LAMP_TWO, MATERIALS };
/* of a box, in sets */
enum { BOTTOM = 1, TOP = 2, ALL = 63 };

/* Rectangles, turned about an axis that is askew. */
static struct {
    double positions[POLYGONS * 4][3], turn[3][3];
    uint32_t indices[POLYGONS * 4], materials[POLYGONS], count;
} world;

static void begin(double angle)
{
    const double a[3] = {0.6, 0, 0.8}, c = cos(angle), s = sin(angle);
    memset(&world, 0, sizeof world);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            world.turn[i][j] = a[i] * a[j] * (1 - c) + (i == j ? c : 0)
                               + ((j - i + 3) % 3 == 1 ? -1 : 1) * s * (i == j ? 0 : a[3 - i - j]);
}

/* The rectangle at o along u and v, its front where u x v points. Returns its number. */
static uint32_t add(enum material material, const double o[3], const double u[3], const double v[3])
{
    ck_assert_uint_lt(world.count, POLYGONS);
    for (uint32_t i = 0; i < 4; i++) {
        double p[3], *q = world.positions[4 * world.count + i];
        for (int k = 0; k < 3; k++)
            p[k] = o[k] + (i == 1 || i == 2 ? u[k] : 0) + (i >= 2 ? v[k] : 0);
        for (int k = 0; k < 3; k++)
            q[k] = dot3(world.turn[k], p);
        world.indices[4 * world.count + i] = 4 * world.count + i;
    }
    world.materials[world.count] = material;
    return world.count++;
}

static uint32_t quad(enum material material, double x, double y, double z, double ux, double uy,
                     double uz, double vx, double vy, double vz)
{
    return add(material, (double[3]){x, y, z}, (double[3]){ux, uy, uz}, (double[3]){vx, vy, vz});
}

/* Those sides of a box, turned by an angle about the vertical; fronts outward, or inward. Returns
 * the number of the first, which others follow. */
static uint32_t box(enum material material, unsigned which, int inward, const double at[3],
                    const double size[3], double angle)
{
    const double c = cos(angle), s = sin(angle), x[3] = {size[0] * c, size[0] * s, 0},
                 y[3] = {-size[1] * s, size[1] * c, 0}, z[3] = {0, 0, size[2]};
    const double *const along[6][2] = {{y, x}, {x, y}, {x, z}, {z, x}, {z, y}, {y, z}};
    const uint32_t first = world.count;
    for (int i = 0; i < 6; i++) {
        double o[3];
        const double *far = i == 1 ? z : i == 3 ? y : i == 5 ? x : NULL;
        for (int k = 0; k < 3; k++)
            o[k] = at[k] + (far ? far[k] : 0);
        if (which >> i & 1)
            add(material, o, along[i][inward], along[i][!inward]);
    }
    return first;
}

static const double origin[3] = {0, 0, 0}, room_size[3] = {4, 5, 3};

/* A room with two sides and a lamp in it. Its first polygon is the floor. */
static void room(double angle)
{
    begin(angle);
    box(TWO, ALL, 1, origin, room_size, 0);
    quad(LAMP, 1, 1, 2.9, 0, 0.7, 0, 0.7, 0, 0);
}

static void make(struct scene *scene)
{
    static const struct RadMaterial materials[MATERIALS] = {
        [ONE] = {{.6, .6, .6}, {0, 0, 0}, 0},
        [TWO] = {{.6, .6, .6}, {0, 0, 0}, 1},
        [LAMP] = {{.6, .6, .6}, {50, 50, 50}, 0},
        [LAMP_TWO] = {{.6, .6, .6}, {50, 50, 50}, 1},
    };
    const struct RadPolygons polygons = {.positions = world.positions[0],
                                         .position_count = 4 * (size_t)world.count,
                                         .indices = world.indices,
                                         .size = 4,
                                         .materials = world.materials,
                                         .count = world.count};
    struct scene_error error;
    const char *cause;
    ck_assert_msg(scene_build(scene, &polygons, materials, MATERIALS, 1, &error) == 0, "%s",
                  error.text);
    ck_assert_int_eq(lit_faces_find(scene, NULL, 1, &cause), 0);
}

/* How much of a side of a polygon is dark. */
static double dark(const struct scene *scene, uint32_t polygon, int back)
{
    double area = 0, all = 0, normal[3];
    for (uint32_t i = 0; i < scene->face_count; i++) {
        struct face f = scene->faces[i];
        if (f.input != polygon || f.back != back)
            continue;
        const double a = polygon_normal(f.vertex, f.vertices, normal);
        all += a;
        area += scene->lit && scene->lit[i].light == FACE_DARK ? a : 0;
    }
    ck_assert_double_gt(all, 0);
    return area / all;
}

/* Are the sides of so many polygons dark, all of them (1) or none (0)? */
static void expect(const struct scene *scene, uint32_t first, uint32_t count, int front, int back)
{
    for (uint32_t i = first; i < first + count; i++) {
        ck_assert_msg(fabs(dark(scene, i, 0) - front) < 1e-9, "front of %u: %g", (unsigned)i,
                      dark(scene, i, 0));
        ck_assert_msg(fabs(dark(scene, i, 1) - back) < 1e-9, "back of %u: %g", (unsigned)i,
                      dark(scene, i, 1));
    }
}

/* A box without a bottom on the floor, wound either way, turned; on a floor of tiles. */
START_TEST(test_standing)
{
    const double at[3] = {1.5, 2, 0}, size[3] = {0.8, 0.9, 1.1};
    for (int i = 0; i < 8; i++) {
        struct scene scene;
        room(0.7 * i);
        const uint32_t b = box(TWO, ALL & ~BOTTOM, i % 2, at, size, i < 4 ? 0 : 0.3 * i);
        make(&scene);
        expect(&scene, 1, 5, 0, 1);
        expect(&scene, b, 5, i % 2, !(i % 2));
        ck_assert_double_lt(dark(&scene, 0, 0), 0.8 * 0.9 / 20 + 1e-9);
        scene_free(&scene);
    }
    for (int i = 0; i < 4; i++) { /* feet along the border of tiles, and across it */
        struct scene scene;
        begin(0.9 * i);
        box(TWO, ALL & ~BOTTOM, 1, origin, room_size, 0);
        quad(LAMP, 1, 1, 2.9, 0, 0.7, 0, 0.7, 0, 0);
        quad(TWO, 0, 0, 0, 1.5, 0, 0, 0, 5, 0);
        quad(TWO, 1.5, 0, 0, 2.5, 0, 0, 0, 2.3, 0);
        quad(TWO, 1.5, 2.3, 0, 2.5, 0, 0, 0, 2.7, 0);
        const uint32_t b = box(TWO, ALL & ~BOTTOM, 0, at, size, i < 2 ? 0 : 0.4);
        make(&scene);
        expect(&scene, b, 5, 0, 1);
        expect(&scene, 0, 5, 0, 1);
        scene_free(&scene);
    }
}
END_TEST

/* Light comes in where a side is missing, or has a hole, or the box hangs. */
START_TEST(test_open)
{
    const double size[3] = {0.8, 0.8, 0.8};
    for (int i = 0; i < 5; i++) {
        const double at[3] = {1.5, 2, i == 1 ? 0.01 : 0};
        struct scene scene;
        room(0.4 * i);
        const uint32_t b =
            box(TWO, i == 1 ? ALL & ~BOTTOM : ALL & ~BOTTOM & ~TOP, 0, at, size, 0.2);
        const double c = cos(0.2), s = sin(0.2), e = 0.8 / 3, h = i == 2 ? 0.8 : 0.75;
        /* a lid of tiles, or of strips that meet in Ts, without the middle; or lower than the rim
         */
        for (int k = 0; k < 9 && (i == 2 || i == 3); k++)
            if (k != 4)
                quad(TWO, 1.5 + e * (k % 3 * c - k / 3 * s), 2 + e * (k % 3 * s + k / 3 * c), h,
                     e * c, e * s, 0, -e * s, e * c, 0);
        for (int k = 0; k < 4 && i == 4; k++) {
            const double from[4][2] = {{0, 0}, {2, 0}, {1, 2}, {0, 1}},
                         to[4][2] = {{2, 1}, {1, 2}, {2, 1}, {1, 2}};
            quad(TWO, 1.5 + e * (from[k][0] * c - from[k][1] * s),
                 2 + e * (from[k][0] * s + from[k][1] * c), 0.8, e * to[k][0] * c, e * to[k][0] * s,
                 0, -e * to[k][1] * s, e * to[k][1] * c, 0);
        }
        make(&scene);
        expect(&scene, b, world.count - b, 0, 0);
        scene_free(&scene);
    }
}
END_TEST

/* A lamp inside a solid: that is lit, and what is outside is not, unless there is another. */
START_TEST(test_lamp_inside)
{
    const double at[3] = {1.5, 2, 0.5}, size[3] = {0.8, 0.9, 1.1};
    for (int i = 0; i < 2; i++) {
        struct scene scene;
        begin(0.5);
        box(TWO, ALL, 1, origin, room_size, 0);
        const uint32_t b = box(TWO, ALL, 0, at, size, 0.3),
                       l = quad(LAMP_TWO, 1.5, 2.5, 1, 0.1, 0, 0, 0, 0.1, 0);
        if (i)
            quad(LAMP, 1, 1, 2.9, 0, 0.7, 0, 0.7, 0, 0);
        make(&scene);
        expect(&scene, 0, 6, !i, 1);
        expect(&scene, b, 6, !i, 0);
        expect(&scene, l, 1, 0, 0);
        scene_free(&scene);
    }
}
END_TEST

/* A solid in a solid, and a wall in it. */
START_TEST(test_nested)
{
    const double at[3] = {1.5, 2, 0.5}, size[3] = {0.8, 0.9, 1.1}, in[3] = {1.6, 2.3, 0.6},
                 small[3] = {0.2, 0.3, 0.4};
    struct scene scene;
    room(0.3);
    const uint32_t outer = box(TWO, ALL, 0, at, size, 0.3);
    const uint32_t inner = box(TWO, ALL, 1, in, small, 0.1);
    make(&scene);
    expect(&scene, 0, 6, 0, 1);
    expect(&scene, outer, 6, 0, 1);
    expect(&scene, inner, 6, 1, 1);
    scene_free(&scene);
}
END_TEST

/* Nothing is dark of one-sided faces, nor where nothing emits. */
START_TEST(test_nothing)
{
    const double at[3] = {1.5, 2, 0}, size[3] = {0.8, 0.9, 1.1};
    for (int i = 0; i < 2; i++) {
        struct scene scene;
        begin(0.5);
        box(i ? ONE : TWO, ALL, 1, origin, room_size, 0);
        if (i)
            quad(LAMP, 1, 1, 2.9, 0, 0.7, 0, 0.7, 0, 0);
        box(i ? ONE : TWO, ALL & ~BOTTOM, 0, at, size, 0.3);
        make(&scene);
        ck_assert_ptr_null(scene.lit);
        scene_free(&scene);
    }
}
END_TEST

static double chance(uint64_t *seed)
{
    return hash_unit(++*seed * HASH_STEP);
}

/* Boxes by chance: on the floor or not, open or not, wound any way, in each other. */
static void furnish(uint64_t seed)
{
    seed *= 1000;
    room(3 * chance(&seed));
    for (int i = 0; i < 6; i++) {
        const int stands = chance(&seed) < 0.6, inward = chance(&seed) < 0.3;
        const unsigned open = (stands ? BOTTOM : 0u) | (chance(&seed) < 0.2 ? TOP : 0u);
        const enum material material = chance(&seed) < 0.2 ? ONE : TWO;
        double at[3], size[3];
        for (int k = 0; k < 3; k++) {
            at[k] = k < 2 ? 0.6 + (2 + k) * chance(&seed) : stands ? 0 : 1.5 * chance(&seed);
            size[k] = 0.1 + chance(&seed);
        }
        box(material, ALL & ~open, inward, at, size, i % 2 ? 0 : 3 * chance(&seed));
    }
}

/* Particles that take all sides for lit meet no dark one. */
START_TEST(test_by_chance)
{
    const uint64_t worlds = under_sanitizers() ? 3 : thorough() ? 400 : 60;
    uint32_t found = 0, far = 0;
    for (uint64_t seed = 1; seed <= worlds; seed++) {
        struct scene scene;
        struct reference r;
        const char *cause;
        furnish(seed);
        make(&scene);
        ck_assert_int_eq(reference_open(&r, &scene, 1, NULL, &cause), 0);
        ck_assert_int_eq(tally_trace(&r.tally, &r.tracer, 2000, NULL), 0);
        for (uint32_t i = 0; i < scene.face_count; i++) {
            far += scene.faces[i].back;
            if (!scene.lit || scene.lit[i].light != FACE_DARK)
                continue;
            found++;
            for (int k = 0; k < REPLICATES; k++)
                ck_assert_msg(!(tally_face(&r.tally, k, i, 0) > 0),
                              "world %u: light on %u of polygon %u", (unsigned)seed, (unsigned)i,
                              (unsigned)scene.faces[i].input);
        }
        reference_close(&r);
        scene_free(&scene);
    }
    printf("%u sides are dark, of %u far ones and their fronts\n", (unsigned)found, (unsigned)far);
    ck_assert_uint_gt(found, far / 2);
}
END_TEST

/* A low box in a room whose lamp leaves one of its sides dim: B of its sides and the lid, and of
 * the room, by polygons. */
static void light_of(enum material material, int inward, const char *oracle, int linear,
                     double *light)
{
    const double at[3] = {2.2, 2.6, 0}, size[3] = {0.8, 0.9, 1.2};
    static char *fine[] = {"relative=0.02", NULL};
    struct scene scene;
    struct solve s;
    struct solve_options o = quick(1);
    o.linear = linear;
    begin(0);
    box(material, ALL, 1, origin, room_size, 0);
    quad(LAMP, 1, 1, 2.9, 0, 0.7, 0, 0.7, 0, 0);
    box(material, ALL & ~BOTTOM, inward, at, size, 0.3);
    make(&scene);
    solve_with(&s, &scene, oracle, RELEASE_FLAT, fine, o);
    for (uint32_t p = 0; p < world.count; p++)
        light[p] = 0;
    for (uint32_t i = 0; i < scene.face_count; i++) {
        const struct element *e = hierarchy_surface(&s.hierarchy, i);
        const double bare = s.operator.uncovered[s.hierarchy.face_element[i]];
        if (scene.lit && scene.lit[i].light == FACE_DARK)
            ck_assert(bare <= 0 && face_radiosity(&s, i) <= 0);
        light[scene.faces[i].input] += e->area * bare * face_radiosity(&s, i);
    }
    solve_close(&s);
    scene_free(&scene);
}

START_TEST(test_same_light)
{
    for (int linear = 0; linear < 2; linear++)
        for (int inward = 0; inward < 2; inward++) {
            double one[POLYGONS], two[POLYGONS], worst = 0;
            light_of(ONE, 0, "bf", linear, one);
            light_of(TWO, inward, "bf", linear, two);
            for (uint32_t p = 0; p < world.count; p++)
                worst = fmax(worst, fabs(two[p] / one[p] - 1));
            printf("two sides for one: light differs by %.2g%%\n", 100 * worst);
            ck_assert_double_lt(worst, 0.01);
        }
}
END_TEST

/* Dark sides are no part of any cluster, and what stands in the light still hides. */
START_TEST(test_tree)
{
    const double at[3] = {1.5, 2, 0}, size[3] = {0.8, 0.9, 1.1};
    for (int inward = 0; inward < 2; inward++) {
        struct scene scene;
        struct hierarchy h;
        room(0.5);
        box(TWO, ALL & ~BOTTOM, inward, at, size, 0.3);
        make(&scene);
        ck_assert_ptr_nonnull(scene.lit);
        ck_assert_int_eq(hierarchy_build(&h, scene.lit, scene.face_count), 0);
        uint32_t held = h.range[0].to;
        double area = 0;
        for (uint32_t i = 0; i < h.face_count; i++) {
            const struct element *e = hierarchy_surface(&h, h.order[i]);
            const struct face *f = &h.faces[h.order[i]];
            ck_assert_uint_eq(e->face, h.order[i]);
            ck_assert_int_eq(f->light == FACE_DARK, i >= held);
            ck_assert(i < held || (e->black && !face_shades(f)));
            area += i < held ? e->area : 0;
        }
        ck_assert_double_eq_tol(h.elements[0].area, area, 1e-9 * area);
        for (uint32_t p = 0; p < world.count; p++) { /* every polygon still hides what is behind */
            uint32_t shades = 0;
            for (uint32_t i = 0; i < h.face_count; i++)
                shades += h.faces[i].input == p && face_shades(&h.faces[i]);
            ck_assert_uint_gt(shades, 0);
        }
        hierarchy_free(&h);
        scene_free(&scene);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("dark sides");
    TCase *tests = tcase_create("");
    tcase_set_timeout(tests, 240);
    tcase_add_test(tests, test_standing);
    tcase_add_test(tests, test_open);
    tcase_add_test(tests, test_lamp_inside);
    tcase_add_test(tests, test_nested);
    tcase_add_test(tests, test_nothing);
    tcase_add_test(tests, test_by_chance);
    tcase_add_test(tests, test_same_light);
    tcase_add_test(tests, test_tree);
    suite_add_tcase(suite, tests);
    return suite_failures(suite) > 0;
}
