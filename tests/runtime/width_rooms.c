/* width_rooms.c - whatever the width of its vectors, an oracle refines alike:
 *
 *     WIDTHS="ORACLE WIDTH FILE.so ..." ROOMS=COUNT width_rooms
 *
 * FILE.so is the built-in ORACLE's text, compiled for loops and vectors of WIDTH numbers
 * (check_widths.sh). Each of COUNT random rooms is solved by the oracle as the library holds it,
 * pair by pair on one thread; then by the file's function for one pair and by that for a block, on
 * 1 to 3 threads in turn. Elements, links, their order, decisions and radiosities must be the same.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "engine/solve.h"
#include "oracle/refiner.h"
#include "random_room.h"
#include "suite.h"

enum { FILES_MOST = 200, NAME_MOST = 64 };

/* A text compiled for a width. */
struct compiled {
    char oracle[NAME_MOST], width[NAME_MOST];
    const struct oracle *made;
};

static struct compiled files[FILES_MOST];
static int file_count, room_count;

static char *const settings[] = {"min_share=1e-2"};

static struct refiner *open_file(const struct compiled *c, const char *release)
{
    struct refiner *r = refiner_compiled(c->made, release);
    ck_assert_ptr_nonnull(r);
    ck_assert_int_eq(oracles_set(r, settings, 1), 0);
    return r;
}

/* All rooms by the library's oracle and by all files that are of it. */
static void compare_room(const char *oracle, const struct scene *scene, int room, uint64_t *pairs)
{
    struct refiner *flat = oracles_open(oracle, RELEASE_FLAT);
    struct solve wanted, other;
    ck_assert_ptr_nonnull(flat);
    ck_assert_int_eq(oracles_set(flat, settings, 1), 0);
    solve_by(&wanted, scene, flat, 1);
    *pairs += wanted.refinement.pairs;
    for (int i = 0; i < file_count; i++) {
        if (strcmp(files[i].oracle, oracle) != 0)
            continue;
        struct refiner *wave = open_file(&files[i], "wave"), *one = open_file(&files[i], "flat");
        ck_assert(wave->wave);
        one->wave = NULL;
        solve_by(&other, scene, wave, 1 + (room + i) % 3);
        same_solves(&wanted, &other);
        solve_close(&other);
        solve_by(&other, scene, one, 1 + (room + i + 1) % 3);
        same_solves(&wanted, &other);
        solve_close(&other);
        refiner_close(wave);
        refiner_close(one);
    }
    solve_close(&wanted);
    refiner_close(flat);
}

START_TEST(test_widths)
{
    const char *oracle = files[_i].oracle;
    uint64_t pairs = 0;
    for (int i = 0; i < _i; i++)
        if (strcmp(files[i].oracle, oracle) == 0)
            return; /* its first file has had all */
    for (int room = 0; room < room_count; room++) {
        struct scene scene;
        random_room(&scene, (unsigned)(1000 + room));
        compare_room(oracle, &scene, room, &pairs);
        made_close(&scene);
    }
    printf("%-16s %3d rooms, %8llu discussions, the same with vectors of", oracle, room_count,
           (unsigned long long)pairs);
    for (int i = 0; i < file_count; i++)
        if (strcmp(files[i].oracle, oracle) == 0)
            printf(" %s", files[i].width);
    putchar('\n');
    fflush(stdout);
}
END_TEST

static int open_files(const char *list)
{
    char path[1024], symbol[NAME_MOST + 8];
    int read = 0;
    for (; file_count < FILES_MOST; list += read, file_count++) {
        struct compiled *c = &files[file_count];
        if (sscanf(list, " %63s %63s %1023s%n", c->oracle, c->width, path, &read) != 3)
            break;
        void *object = dlopen(path, RTLD_NOW | RTLD_LOCAL);
        snprintf(symbol, sizeof symbol, "%s_oracle", c->oracle);
        c->made = object ? dlsym(object, symbol) : NULL;
        if (!c->made) {
            fprintf(stderr, "width_rooms: %s\n", dlerror());
            return -1;
        }
    }
    return file_count;
}

int main(void)
{
    const char *list = getenv("WIDTHS"), *rooms = getenv("ROOMS");
    room_count = rooms ? atoi(rooms) : 0;
    if (!list || room_count < 1 || open_files(list) < 1) {
        fputs("usage: WIDTHS=\"ORACLE WIDTH FILE.so ...\" ROOMS=COUNT width_rooms\n", stderr);
        return 2;
    }
    Suite *suite = suite_create("widths");
    TCase *c = tcase_create("widths");
    tcase_set_timeout(c, 7200);
    tcase_add_loop_test(c, test_widths, 0, file_count);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
