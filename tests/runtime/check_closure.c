/* check_closure.c - rows scaled to one, and the spread that oracles see.
 * B = E / (1 - rho) in any closed shape; an open scene must not gain.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include "scene/read_scene.h"
#include "runtime/make_solve.h"
#include "suite.h"

/* An L of two rooms, 2 x 1 and 1 x 1, that open into each other: walls hide parts of it from
 * others. */
static void furnace_l(struct scene *s, double rho)
{
    made_open(s);
    made_material(s, rho, 1);
    for (uint32_t i = 0; i < 2; i++) {
        double y = i, x = i ? 1 : 2;
        made_quad(s, 0, 0, y, 0, x, 0, 0, 0, 1, 0);
        made_quad(s, 0, 0, y, 1, 0, 1, 0, x, 0, 0);
    }
    made_quad(s, 0, 0, 0, 0, 0, 0, 1, 2, 0, 0);
    made_quad(s, 0, 2, 0, 0, 0, 0, 1, 0, 1, 0);
    made_quad(s, 0, 2, 1, 0, 0, 0, 1, -1, 0, 0);
    made_quad(s, 0, 1, 1, 0, 0, 0, 1, 0, 1, 0);
    made_quad(s, 0, 1, 2, 0, 0, 0, 1, -1, 0, 0);
    made_quad(s, 0, 0, 2, 0, 0, 0, 1, 0, -2, 0);
}

/* A room with a box on its floor, which buries a part of it; the box has no bottom. */
static void furnace_box(struct scene *s, double rho)
{
    static const uint32_t m[6] = {0};
    made_open(s);
    made_material(s, rho, 1);
    made_room(s, m, 2, 1.5, 1);
    /* turned against the walls, so that quarters do not fit it */
    made_quad(s, 0, 0.7, 0.3, 0.6, 0.5, 0.1, 0, -0.1, 0.5, 0);
    made_quad(s, 0, 0.7, 0.3, 0, 0.5, 0.1, 0, 0, 0, 0.6);
    made_quad(s, 0, 1.2, 0.4, 0, -0.1, 0.5, 0, 0, 0, 0.6);
    made_quad(s, 0, 1.1, 0.9, 0, -0.5, -0.1, 0, 0, 0, 0.6);
    made_quad(s, 0, 0.6, 0.8, 0, 0.1, -0.5, 0, 0, 0, 0.6);
}

/* With its rows closed a furnace is right in every element that no solid covers, and loses no
 * power; without, the defect that closure removes is there. */
START_TEST(test_closed_furnace)
{
    static void (*const shape[5])(struct scene *, double) = {
        furnace_cube, furnace_prism, furnace_octahedron, furnace_l, furnace_box};
    static const char *const name[5] = {"cube", "prism", "octahedron", "L", "box in a room"};
    struct scene scene;
    double worst[2] = {0, 0}, balance[2];
    shape[_i](&scene, 0.99);
    for (int closed = 0; closed < 2; closed++) {
        struct solve_options options = quick(1);
        options.tolerance = 1e-5;
        options.closure = closed ? CLOSURE_ROWS : CLOSURE_NONE;
        struct solve s;
        solve_with(&s, &scene, "bf_guarded", RELEASE_FLAT, NULL, options);
        for (uint32_t i = 0; i < s.hierarchy.count; i++)
            if (s.hierarchy.elements[i].vertices && s.operator.uncovered[i]> 0)
                worst[closed] = fmax(worst[closed], fabs(s.state.radiosity[i] * 0.01 - 1));
        balance[closed] = s.report.absorbed / s.report.emitted - 1;
        if (closed) {
            printf("furnace %s rho 0.99: worst element off by %.1e closed, %.1e without; power by "
                   "%.1e, %.1e; |row - 1| %.4f "
                   "in the mean, %.4f at the most; blind %.1e m2\n",
                   name[_i], worst[1], worst[0], balance[1], balance[0], s.report.rows.defect_mean,
                   s.report.rows.defect_most, s.report.rows.blind_area);
            ck_assert_int_eq(s.problem.closed, 1);
            ck_assert_double_gt(s.report.rows.defect_mean, 1e-3);
        }
        solve_close(&s);
    }
    ck_assert_double_le(worst[1], 1e-4);
    ck_assert_double_le(fabs(balance[1]), 1e-4);
    if (_i >= 3)
        ck_assert_double_gt(worst[0], 1e-3);
    made_close(&scene);
}
END_TEST

/* In an open scene closure only takes: no row is scaled up, and B is nowhere above what it is
 * without. A hole in the roof, and a roof whose black back is seen, are both openings. */
START_TEST(test_open_closure)
{
    static char *settings[] = {"relative=0.2", NULL};
    struct solve_options options = quick(2);
    options.closure = CLOSURE_ROWS;
    struct scene scene;
    furnace_cube(&scene, 0.9);
    if (_i == 0) /* the roof leaves a slit of 2 % */
        scene.faces[1].vertex[2][0] = scene.faces[1].vertex[3][0] = 0.98;
    else if (_i == 1) { /* a partition that turns its back on half of the room */
        made_quad(&scene, 0, 0.5, 0.2, 0.2, 0, 0.5, 0, 0, 0, 0.5);
    } else /* nothing but a plate and another */
        scene.face_count = scene.input_count = 2;
    struct solve s;
    solve_with(&s, &scene, "bf_guarded", RELEASE_FLAT, settings, options);
    ck_assert_int_eq(s.problem.closed, 0);
    for (uint32_t i = 0; i < s.hierarchy.count; i++) {
        if (!s.hierarchy.elements[i].vertices || s.hierarchy.elements[i].children)
            continue;
        ck_assert_double_le(s.operator.row_scale[i], 1);
        ck_assert(s.operator.row_share[i] == 0);
    }
    ck_assert_double_le(s.report.absorbed, s.report.emitted);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

/* The scenes shipped are closed, though things stand in each other there, books open to their
 * covers and a lamp's joints. A slit of a ten-thousandth of a cube's area opens it, and so does a
 * window in td; a pocket that only light from the pocket reaches does not. */
START_TEST(test_enclosure)
{
    static const char *const shipped[] = {"td", "room", "cornell", "maze_8", "furnace"};
    enum { SHIPPED = sizeof shipped / sizeof *shipped, SLIT = SHIPPED, WINDOW, POCKET, CASES };
    for (int i = 0; i < CASES; i++) {
        struct scene_options how = {.quiet = 1};
        struct solve_options options = quick(2);
        struct scene scene;
        if (i == SLIT || i == POCKET)
            furnace_cube(&scene, 0.5);
        if (i == SLIT)
            scene.faces[1].vertex[2][0] = scene.faces[1].vertex[3][0] = 1 - 6e-4;
        /* a box without a bottom, and in it a shelf that the floor beneath sees, and the box's
         * backs beside it */
        if (i == POCKET) {
            made_material(&scene, 0.5, 0);
            made_quad(&scene, 1, 0.5, 0.2, 0, 0, 0.5, 0, 0, 0, 0.5);
            made_quad(&scene, 1, 0.4, 0.2, 0, 0, 0, 0.5, 0, 0.5, 0);
            made_quad(&scene, 1, 0.4, 0.2, 0, 0.1, 0, 0, 0, 0, 0.5);
            made_quad(&scene, 1, 0.4, 0.7, 0, 0, 0, 0.5, 0.1, 0, 0);
            made_quad(&scene, 1, 0.4, 0.2, 0.5, 0.1, 0, 0, 0, 0.5, 0);
            made_quad(&scene, 1, 0.4, 0.2, 0.01, 0, 0.5, 0, 0.1, 0, 0);
        }
        if (i < SHIPPED || i == WINDOW) {
            char path[64];
            snprintf(path, sizeof path, "examples/scenes/%s.obj", shipped[i < SHIPPED ? i : 0]);
            ck_assert_int_eq(scene_read(&scene, path, &how), 0);
        }
        if (i == WINDOW) { /* a part of a wall turned round: its black back is in view */
            struct face *f = scene.faces, keep;
            while (f->input != 0)
                f++;
            keep = *f;
            for (uint32_t k = 0; k < f->vertices; k++)
                memcpy(f->vertex[k], keep.vertex[f->vertices - 1 - k], sizeof f->vertex[k]);
        }
        options.closure = CLOSURE_ROWS; /* asks */
        struct solve s;
        const char *cause;
        ck_assert_int_eq(solve_open(&s, &scene, &options, &cause), 0);
        ck_assert_msg(s.problem.closed == (i != SLIT && i != WINDOW), "case %d", i);
        ck_assert_uint_gt(s.problem.closed_rays, 1000);
        solve_close(&s);
        if (i < SHIPPED || i == WINDOW)
            scene_free(&scene);
        else
            made_close(&scene);
    }
}
END_TEST

/* Half of a wall is lit: its spread and that of all above it are the difference, the spread of
 * leaves is nothing. */
START_TEST(test_spread)
{
    static char *settings[] = {"relative=0.1", NULL};
    struct scene scene;
    furnace_l(&scene, 0.5);
    scene.faces[2].material = scene.faces[3].material = made_material(&scene, 0.7, 0);
    struct solve s;
    solve_with(&s, &scene, "bf_guarded", RELEASE_FLAT, settings, quick(2));
    for (uint32_t i = 0; i < s.hierarchy.count; i++) {
        const struct element *e = &s.hierarchy.elements[i];
        double low = INFINITY, high = -INFINITY;
        for (uint32_t j = i; j < s.hierarchy.count; j++) { /* leaves below i, by their ancestors */
            uint32_t up = j;
            if (s.hierarchy.elements[j].children)
                continue;
            while (up > i)
                up = s.hierarchy.elements[up].parent;
            if (up != i)
                continue;
            low = fmin(low, s.state.radiosity[j]);
            high = fmax(high, s.state.radiosity[j]);
        }
        ck_assert_double_le(fabs(e->spread - (high - low)), 0.0201 * (high - low) + 1e-6 * high);
    }
    ck_assert_double_gt(s.hierarchy.elements[0].spread, 0.5);
    solve_close(&s);
    made_close(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("closure");
    TCase *c = tcase_create("closure");
    tcase_set_timeout(c, 300);
    tcase_add_loop_test(c, test_closed_furnace, 0, 5);
    tcase_add_test(c, test_enclosure);
    tcase_add_loop_test(c, test_open_closure, 0, 3);
    tcase_add_test(c, test_spread);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
