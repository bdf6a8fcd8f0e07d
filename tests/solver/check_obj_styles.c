/* check_obj_styles.c - OBJ files as many programs write them, against what they were made of.
 *
 * A seed makes some polygons of known area with known materials, and writes them in a style of its
 * own: line ends, marks of UTF-8, indents, comments, continued lines, corners N/T/N or from the
 * end, numbers in many notations, libraries before, between or after the faces, names with blanks.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "folder.h"
#include "hierarchy/polygon.h"
#include "scene/scene_file.h"
#include "suite.h"

enum { FILES = 1300, FACES_MOST = 12, MATERIALS = 5, CORNERS_MOST = 7, TEXT = 100000 };

static uint64_t state;

static uint32_t chance(uint32_t of) /* 0 .. of - 1 */
{
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)((state >> 33) % of);
}

struct text {
    char *at;
    size_t size;
};

/* What differs from file to file. */
static struct style {
    const char *end;
    int mark, indent, comments, joined, colours, weight, corner, relative, notation, tabs, upside;
} style;

#if defined __GNUC__
__attribute__((__format__(__printf__, 2, 3)))
#endif
static void
put(struct text *t, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    t->size += (size_t)vsnprintf(t->at + t->size, TEXT - t->size, format, arguments);
    va_end(arguments);
    ck_assert_uint_lt(t->size, TEXT);
}

static void put_gap(struct text *t)
{
    if (style.joined && chance(6) == 0)
        put(t, " \\%s", style.end);
    put(t, "%s", style.tabs && chance(3) == 0 ? "\t" : chance(9) == 0 ? "   " : " ");
}

static void put_number(struct text *t, double x)
{
    char digits[64];
    snprintf(digits, sizeof digits,
             style.notation == 1   ? "%.17g"
             : style.notation == 2 ? "%.17e"
             : style.notation == 3 ? "%a"
             : style.notation == 4 ? "%+.17g"
                                   : "%.20f",
             x);
    const char *from = digits;
    if (style.notation == 1 && digits[0] == '0' && digits[1] == '.')
        from++; /* .5 */
    put_gap(t);
    put(t, "%s", from);
}

static void start_line(struct text *t, const char *word)
{
    static const char *const junk[] = {"# f 1 2 3", "g a b", "o x", "s off", "", "   "};
    while (chance(5) == 0)
        put(t, "%s%s", junk[chance(6)], style.end);
    put(t, "%s%s", style.indent && chance(2) ? "\t " : "", word);
}

static void end_line(struct text *t, int may_comment)
{
    put(t, "%s%s",
        !style.comments || !may_comment || chance(2) ? ""
        : chance(2)                                  ? " # v 9 9 9 \\ ."
                                                     : "#x",
        style.end);
}

struct face_made {
    uint32_t material;
    double area;
};

static struct RadMaterial materials[MATERIALS];
static char names[MATERIALS][64];

static void make_material(struct text *t, int i)
{
    static const char *const junk[] = {"Ns abc",      "aniso",          "Ka spectral a.rfl",
                                       "d 1",         "illum 2",        "Tf 1 1 1",
                                       "d -halo 0.5", "Ks 0.1 0.1 0.1", "map_Bump b"};
    int grey = chance(2) == 0;
    snprintf(names[i], sizeof names[i],
             chance(4) == 0   ? "two words %d"
             : chance(4) == 0 ? "Material #%d"
             : chance(4) == 0 ? "\xC3\xA9%d.a/b"
                              : "m%d",
             i);
    for (int k = 0; k < 3; k++) {
        materials[i].reflectance[k] = grey && k ? materials[i].reflectance[0] : chance(999) / 1e3;
        materials[i].exitance[k] = 0;
    }
    start_line(t, "newmtl ");
    put(t, "%s%s", names[i], style.end);
    int lines = (int)chance(4), lamp = chance(3) == 0, first = (int)chance(2);
    for (int part = 0; part < 2; part++) {
        for (int j = 0; j < lines; j++) {
            start_line(t, junk[chance(9)]);
            end_line(t, 1);
        }
        int diffuse = part == first;
        if (!diffuse && !lamp)
            continue;
        double *value = diffuse ? materials[i].reflectance : materials[i].exitance;
        for (int k = 0; k < 3 && !diffuse; k++)
            value[k] = grey && k ? value[0] : chance(100) * 1.5;
        start_line(t, diffuse ? "Kd" : "Ke");
        int numbers = grey && chance(2) ? 1 : 3;
        for (int k = 0; k < numbers; k++)
            put_number(t, value[k]);
        end_line(t, 1);
    }
}

static void write_file(const char *name, const struct text *t)
{
    FILE *f = fopen(in_folder(name), "wb");
    ck_assert_ptr_nonnull(f);
    if (style.mark)
        fputs("\xEF\xBB\xBF", f);
    ck_assert_uint_eq(fwrite(t->at, 1, t->size, f), t->size);
    ck_assert_int_eq(fclose(f), 0);
}

/* The corners of a regular polygon in a plane of its own; returns its area. */
static double put_vertices(struct text *t, uint32_t corners)
{
    const double pi = 3.14159265358979323846;
    double radius = 0.1 + chance(1000) / 100.0, tilt = chance(628) / 100.0;
    double at[3] = {(double)chance(100) - 50, (double)chance(100) - 50, (double)chance(100) - 50};
    for (uint32_t i = 0; i < corners; i++) {
        double angle = 2 * pi * i / corners, x = radius * cos(angle), y = radius * sin(angle);
        double weight = style.weight && chance(2) ? 2 : 1;
        const double p[3] = {at[0] + x, at[1] + y * cos(tilt), at[2] + y * sin(tilt)};
        start_line(t, "v");
        for (int k = 0; k < 3; k++)
            put_number(t, p[k] * weight);
        if (style.weight)
            put_number(t, weight);
        for (int k = 0; k < 3 && style.colours && !style.weight; k++)
            put_number(t, chance(256) / 255.0);
        end_line(t, 1);
    }
    return corners / 2.0 * radius * radius * sin(2 * pi / corners);
}

static void put_face(struct text *t, uint32_t corners, long first, long seen)
{
    static const char *const forms[] = {"%ld", "%ld/1", "%ld//1", "%ld/1/1"};
    start_line(t, chance(20) == 0 ? "fo" : "f");
    for (uint32_t i = 0; i < corners; i++) {
        long index = first + (long)i;
        put_gap(t);
        char corner[40];
        snprintf(corner, sizeof corner, forms[style.corner],
                 style.relative && index <= seen ? index - seen - 1 : index);
        put(t, "%s", corner);
    }
    end_line(t, 1);
}

/* Returns how many faces. */
static uint32_t make_files(struct face_made made[FACES_MOST])
{
    static char text[TEXT], library[2][TEXT];
    struct text obj = {.at = text}, mtl[2] = {{.at = library[0]}, {.at = library[1]}};
    static const char *const ends[] = {"\n", "\r\n", "\r"};
    style = (struct style){ends[chance(3)], chance(4) == 0, chance(2) == 0, chance(2) == 0,
                           chance(3) == 0,  chance(4) == 0, chance(6) == 0, (int)chance(4),
                           chance(3) == 0,  (int)chance(5), chance(3) == 0, chance(3) == 0};
    int split = (int)chance(MATERIALS + 1);
    for (int i = 0; i < MATERIALS; i++)
        make_material(&mtl[i >= split], i);
    write_file("a b.mtl", &mtl[0]);
    write_file("c.mtl", &mtl[1]);
    uint32_t count = 1 + chance(FACES_MOST);
    uint32_t corners[FACES_MOST], where[2] = {chance(count + 1), chance(count + 1)};
    long seen = 0, first = 1, all = 0;
    for (uint32_t i = 0; i < count; i++) {
        corners[i] = 3 + chance(CORNERS_MOST - 2);
        all += (long)corners[i];
    }
    if (!style.upside) /* all vertices first */
        for (uint32_t i = 0; i < count; i++) {
            made[i].area = put_vertices(&obj, corners[i]);
            seen += (long)corners[i];
        }
    uint32_t current = MATERIALS;
    for (uint32_t i = 0; i <= count; i++) {
        for (int j = 0; j < 2; j++)
            if (where[j] == i) {
                start_line(&obj, "mtllib ");
                put(&obj, "%s%s", j ? "c.mtl" : "a b.mtl", style.end);
            }
        if (i == count)
            break;
        if (style.upside) {
            made[i].area = put_vertices(&obj, corners[i]);
            seen += (long)corners[i];
        }
        if (!i || chance(2)) {
            current = chance(MATERIALS);
            start_line(&obj, "usemtl ");
            put(&obj, "%s%s%s", names[current], chance(5) ? "" : " ", style.end);
        }
        made[i].material = current;
        put_face(&obj, corners[i], first, seen);
        first += (long)corners[i];
    }
    ck_assert_int_eq(seen, all);
    write_file("styles.obj", &obj);
    return count;
}

static void check_file(uint64_t seed)
{
    struct face_made made[FACES_MOST];
    state = seed * 0x9E3779B97F4A7C15u + 1;
    chance(2);
    uint32_t count = make_files(made);
    struct scene_file file;
    ck_assert_msg(
        scene_file_read(&file, in_folder("styles.obj"), &(struct scene_options){.quiet = 1}) == 0,
        "seed %u", (unsigned)seed);
    ck_assert_uint_eq(file.polygon_count, count);
    size_t at = 0;
    for (uint32_t i = 0; i < count; at += file.sizes[i++]) {
        double corner[CORNERS_MOST][3], normal[3];
        ck_assert_uint_le(file.sizes[i], CORNERS_MOST);
        for (uint32_t j = 0; j < file.sizes[i]; j++)
            memcpy(corner[j], &file.positions[3 * (size_t)file.indices[at + j]], sizeof corner[j]);
        double area = polygon_normal(corner, file.sizes[i], normal);
        ck_assert_msg(fabs(area - made[i].area) <= 1e-10 * made[i].area, "seed %u face %u",
                      (unsigned)seed, (unsigned)i);
        uint32_t m = file.polygon_materials[i];
        ck_assert_str_eq(file.names[m], names[made[i].material]);
        for (int k = 0; k < 3; k++) {
            ck_assert_double_eq_tol(file.materials[m].reflectance[k],
                                    materials[made[i].material].reflectance[k], 1e-15);
            ck_assert_double_eq_tol(file.materials[m].exitance[k],
                                    materials[made[i].material].exitance[k], 1e-13);
        }
    }
    scene_file_free(&file);
}

START_TEST(test_styles)
{
    for (uint64_t seed = 1; seed <= FILES; seed++)
        check_file(seed);
}
END_TEST

int main(void)
{
    if (folder_make("obj_styles") < 0)
        return EXIT_FAILURE;
    Suite *suite = suite_create("obj_styles");
    TCase *t = tcase_create("obj_styles");
    tcase_set_timeout(t, 60);
    tcase_add_test(t, test_styles);
    suite_add_tcase(suite, t);
    int failed = suite_failures(suite);
    folder_remove();
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
