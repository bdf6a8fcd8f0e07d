/* check_import_child.c - whom the process that reads a scene file may keep waiting.
 * SPDX-License-Identifier: MIT */
#define _DEFAULT_SOURCE /* vfork */
#include <check.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include "scene/import_child.h"
#include "suite.h"

static int one_triangle(struct scene_file *f)
{
    static const double at[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const struct RadMaterial grey = {.reflectance = {.5, .5, .5}};
    for (uint32_t i = 0; i < 3; i++)
        if (scene_file_add_position(f, at[i]) || scene_file_add_corner(f, i))
            return -1;
    return scene_file_add_material(f, "grey", &grey) || scene_file_add_polygon(f, 3, 0, 0) ? -1 : 0;
}

/* Whoever calls vfork(2) waits as one waits for a disk: nobody may wake it but a signal that kills.
 */
static int read_slowly(struct scene_file *f, const char *path)
{
    (void)path;
    const pid_t other = vfork();
    if (other == 0) {
        sleep(7); /* above the seconds that are granted to one that waits for nothing known */
        _exit(0);
    }
    waitpid(other, NULL, 0);
    return one_triangle(f);
}

static int read_never(struct scene_file *f, const char *path)
{
    (void)f;
    (void)path;
    sleep(60);
    return one_triangle(f);
}

START_TEST(one_that_waits_for_a_disk_is_waited_for)
{
    struct scene_file f = {0};
    ck_assert_int_eq(import_in_child(&f, "slow", read_slowly), 0);
    ck_assert_uint_eq(f.polygon_count, 1);
    scene_file_free(&f);
}
END_TEST

START_TEST(one_that_waits_for_nothing_is_not)
{
    struct scene_file f = {0};
    ck_assert_int_eq(import_in_child(&f, "never", read_never), -1);
    ck_assert_uint_eq(f.polygon_count, 0);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("import_child");
    TCase *t = tcase_create("import_child");
    tcase_set_timeout(t, 60);
    tcase_add_test(t, one_that_waits_for_a_disk_is_waited_for);
    tcase_add_test(t, one_that_waits_for_nothing_is_not);
    suite_add_tcase(suite, t);
    return suite_failures(suite) ? EXIT_FAILURE : EXIT_SUCCESS;
}
