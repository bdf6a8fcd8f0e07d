/* check_mesh_formats.c - one room in every mesh format: the same polygons, corner by corner, and
 * the same matrix of view factors as its OBJ file, byte by byte; and what is wrong with a file is
 * said with its line.
 *
 * The writers here know the formats and nothing of the readers. Node numbers have gaps and come in
 * an order of their own wherever the format lets them.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "folder.h"
#include "scene/scene_file.h"
#include "suite.h"

enum { POINTS = 16, FACES = 12, TEXT = 1 << 16 };

/* 4 x 5 x 3 m, one wall two triangles, and in it a block that stands free. */
static const double point[POINTS][3] = {{0, 0, 0},     {4, 0, 0},       {4, 5, 0},     {0, 5, 0},
                                        {0, 0, 3},     {4, 0, 3},       {4, 5, 3},     {0, 5, 3},
                                        {1, 1.5, .25}, {2.5, 1.5, .25}, {2.5, 3, .25}, {1, 3, .25},
                                        {1, 1.5, 1.5}, {2.5, 1.5, 1.5}, {2.5, 3, 1.5}, {1, 3, 1.5}};
static const int face[FACES][4] = {{0, 1, 2, 3},   {4, 7, 6, 5},    {0, 4, 5, 1},
                                   {1, 5, 6, -1},  {1, 6, 2, -1},   {2, 6, 7, 3},
                                   {3, 7, 4, 0},   {8, 11, 10, 9},  {12, 13, 14, 15},
                                   {8, 9, 13, 12}, {9, 10, 14, 13}, {11, 15, 14, 10}};

static int corners(int i)
{
    return face[i][3] < 0 ? 3 : 4;
}

static const char *group(int i) /* walls, then the block, which has no fourth side */
{
    return i < 7 ? "walls" : "block";
}

static struct {
    char at[TEXT];
    size_t size;
} text;

__attribute__((__format__(__printf__, 1, 2))) static void put(const char *format, ...)
{
    va_list a;
    va_start(a, format);
    text.size += (size_t)vsnprintf(text.at + text.size, TEXT - text.size, format, a);
    va_end(a);
    ck_assert_uint_lt(text.size, TEXT);
}

static void put_corners(int i, const char *format, int first, int step)
{
    for (int j = 0; j < corners(i); j++)
        put(format, first + step * face[i][j]);
}

/* ---- writers */

static void write_obj(void)
{
    for (int i = 0; i < POINTS; i++)
        put("v %g %g %g\n", point[i][0], point[i][1], point[i][2]);
    for (int i = 0; i < FACES; i++) {
        put("f");
        put_corners(i, " %d", 1, 1);
        put("\n");
    }
}

static void write_vs3(void)
{
    put("T a room\n! a comment\nC eps=1e-4 list=0\nF 3\n");
    for (int i = 0; i < POINTS; i++)
        put("v %d %g %g %g ! point\n", i + 1, point[i][0], point[i][1], point[i][2]);
    for (int i = 0; i < FACES; i++) {
        put("S %d", i + 1);
        put_corners(i, " %d", 1, 1);
        put("%s 0 0 .75 %s / of it\n", corners(i) == 3 ? " 0" : "", group(i));
    }
    put("End of data\nS nothing\n");
}

static void write_gmsh_2(void)
{
    put("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n1 7 \"rim\"\n2 7 \"walls\"\n"
        "2 9 \"block\"\n$EndPhysicalNames\n$Nodes\n%d\n",
        POINTS);
    for (int i = POINTS; i-- > 0;)
        put("%d %g %g %g\n", 3 * i + 5, point[i][0], point[i][1], point[i][2]);
    put("$EndNodes\n$Comments\n$ 1 2 3\n$EndComments\n$Elements\n%d\n1 15 2 0 1 5\n2 1 2 7 1 5 8\n",
        FACES + 2);
    for (int i = 0; i < FACES; i++) {
        put("%d %d 2 %d 1", i + 3, corners(i) - 1, i < 7 ? 7 : 9);
        put_corners(i, " %d", 5, 3);
        put("\n");
    }
    put("$EndElements\n");
}

static void put_block_4(int from, int to, int entity)
{
    put("2 %d %d %d\n", entity, corners(from) - 1, to - from);
    for (int i = from; i < to; i++) {
        put("%d", i + 1);
        put_corners(i, " %d", 5, 3);
        put("\n");
    }
}

static void write_gmsh_4(void)
{
    put("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 7 \"walls\"\n2 9 \"block\"\n"
        "$EndPhysicalNames\n$Entities\n1 0 2 0\n1 0 0 0 0\n"
        "31 0 0 0 4 5 3 1 7 0\n32 1 1 1 2 3 2 1 -9 0\n$EndEntities\n$Nodes\n2 %d 5 50\n",
        POINTS);
    for (int half = 0; half < 2; half++) {
        const int from = half * 10, to = half ? POINTS : 10;
        put("2 %d 0 %d\n", 31 + half, to - from);
        for (int i = from; i < to; i++)
            put("%d\n", 3 * i + 5);
        for (int i = from; i < to; i++)
            put("%g %g %g\n", point[i][0], point[i][1], point[i][2]);
    }
    put("$EndNodes\n$Elements\n4 %d 1 %d\n", FACES, FACES);
    put_block_4(0, 3, 31);
    put_block_4(3, 5, 31);
    put_block_4(5, 7, 31);
    put_block_4(7, FACES, 32);
    put("$EndElements\n");
}

static void put_small(int i)
{
    put("%-8s%8d%8d", corners(i) == 3 ? "CTRIA3" : "CQUAD4", i + 1, i < 7 ? 7 : 9);
    put_corners(i, "%8d", 5, 3);
    put("\n");
}

static void write_nastran_small(void)
{
    put("SOL 101\nCEND\nTITLE = GRID\nBEGIN BULK\n$ shells first\nPSHELL  7       1       .1\n");
    for (int i = 0; i < FACES; i++)
        put_small(i);
    for (int i = 0; i < POINTS; i++)
        put("GRID    %8d%8s%8.3f%8.3f%5.0f.-%d\n", 3 * i + 5, "", point[i][0], point[i][1],
            point[i][2] * 100, 2);
    put("ENDDATA\nGRID nothing\n");
}

static void write_nastran_large(void)
{
    for (int i = 0; i < POINTS; i++)
        put("GRID*   %16d%16s%16.9E%16.9f*G%d\n*G%-6d%16.8fD0\n", 3 * i + 5, "", point[i][0],
            point[i][1], i, i, point[i][2]);
    for (int i = 0; i < FACES; i++) {
        put("%-8s%16d%16d", corners(i) == 3 ? "CTRIA3*" : "CQUAD4*", i + 1, i < 7 ? 7 : 9);
        for (int j = 0; j < corners(i); j++)
            put("%s%16d", j == 2 ? "\n*       " : "", 5 + 3 * face[i][j]);
        put("\n");
    }
}

static void write_nastran_free(void)
{
    put("BEGIN BULK\n");
    for (int i = 0; i < POINTS; i++)
        put(i % 2 ? "grid,%d,,%g,%g,%g\n" : "GRID , %d , 0, %g,%g, %g,,\n", 3 * i + 5, point[i][0],
            point[i][1], point[i][2]);
    for (int i = 0; i < FACES; i++) {
        put("%s,%d,%d", corners(i) == 3 ? "CTRIA3" : "CQUAD4", i + 1, i < 7 ? 7 : 9);
        put_corners(i, ",%d", 5, 3);
        put("\n");
    }
    put("ENDDATA\n");
}

/* ---- */

static void write_text(const char *name)
{
    FILE *f = fopen(in_folder(name), "wb");
    ck_assert_ptr_nonnull(f);
    ck_assert_uint_eq(fwrite(text.at, 1, text.size, f), text.size);
    ck_assert_int_eq(fclose(f), 0);
}

static void make(const char *name, void (*write)(void))
{
    text.size = 0;
    write();
    write_text(name);
}

static const struct {
    const char *name;
    void (*write)(void);
    const char *walls, *block; /* names of materials */
} formats[] = {
    {"room.vs3", write_vs3, "walls", "block"},
    {"two.msh", write_gmsh_2, "walls", "block"},
    {"four.msh", write_gmsh_4, "walls", "block"},
    {"small.bdf", write_nastran_small, "PSHELL 7", "PSHELL 9"},
    {"large.nas", write_nastran_large, "PSHELL 7", "PSHELL 9"},
    {"free.BDF", write_nastran_free, "PSHELL 7", "PSHELL 9"},
};
enum { FORMATS = sizeof formats / sizeof *formats };

static const struct scene_options quietly = {.quiet = 1};

START_TEST(test_polygons)
{
    struct scene_file f;
    make(formats[_i].name, formats[_i].write);
    ck_assert_int_eq(scene_file_read(&f, in_folder(formats[_i].name), &quietly), 0);
    ck_assert_uint_eq(f.polygon_count, FACES);
    size_t at = 0;
    for (int i = 0; i < FACES; i++) {
        ck_assert_uint_eq(f.sizes[i], (unsigned)corners(i));
        for (int j = 0; j < corners(i); j++, at++)
            for (int k = 0; k < 3; k++)
                ck_assert_double_eq(f.positions[3 * f.indices[at] + (unsigned)k],
                                    point[face[i][j]][k]);
        const uint32_t m = f.polygon_materials[i];
        ck_assert_str_eq(f.names[m], i < 7 ? formats[_i].walls : formats[_i].block);
        ck_assert_double_eq(f.materials[m].reflectance[1],
                            strstr(formats[_i].name, "vs3") ? .25 : .5);
    }
    scene_file_free(&f);
}
END_TEST

static size_t matrix(const char *name, char *to, size_t most)
{
    char command[1024], out[80];
    const char *program = getenv("RADIOSITY");
    snprintf(out, sizeof out, "%s.csv", name);
    snprintf(command, sizeof command, "%s viewfactors %s -q -o %s",
             program ? program : "build/bin/radiosity", in_folder(name), in_folder(out));
    ck_assert_int_eq(system(command), 0);
    FILE *f = fopen(in_folder(out), "r");
    ck_assert_ptr_nonnull(f);
    const size_t size = fread(to, 1, most, f);
    fclose(f);
    return size;
}

START_TEST(test_factors)
{
    static char wanted[TEXT], got[TEXT];
    make("room.obj", write_obj);
    const size_t size = matrix("room.obj", wanted, TEXT);
    ck_assert_uint_gt(size, 10 * FACES * FACES);
    for (int i = 0; i < FORMATS; i++) {
        make(formats[i].name, formats[i].write);
        ck_assert_msg(matrix(formats[i].name, got, TEXT) == size && memcmp(got, wanted, size) == 0,
                      "%s", formats[i].name);
    }
}
END_TEST

/* What reading says on stderr, of a file that must be refused. */
static const char *refusal(const char *path)
{
    static char said[1000];
    struct scene_file f;
    fflush(stderr);
    const int was = dup(2), to = open(in_folder("said"), O_RDWR | O_CREAT | O_TRUNC, 0600);
    dup2(to, 2);
    const int result = scene_file_read(&f, path, &quietly);
    fflush(stderr);
    dup2(was, 2);
    close(was);
    lseek(to, 0, SEEK_SET);
    const ssize_t size = read(to, said, sizeof said - 1);
    close(to);
    said[size > 0 ? size : 0] = '\0';
    ck_assert_msg(result == -1, "%s is read", path);
    return said;
}

START_TEST(test_refusals)
{
    static const struct {
        const char *name, *content, *said;
    } cases[] = {
        {"a.vs3", "F 3\nV 1 0 0 0\nS 1 1 2 1 0 0 0 .5 a\n", ":3: error: surface 1 names vertex 2"},
        {"a.vs3", "F 3\nV 1 0 0 nan\n", ":2: error: 'nan' where z belongs"},
        {"a.vs3", "F 2\n", ":1: error: a geometry of another kind"},
        {"a.vs3", "F 3\nV 1 0 0\n", ": error: ends before z"},
        {"a.vs3", "F 3\nV 1 0 0 0\nV 1 0 0 1\n", ":3: error: node 1 is defined twice"},
        {"a.vs3", "F 3\nS 2 1 1 1 0 0 0 1 a\n", ":2: error: surface 2 where 1 belongs"},
        {"a.vs3", "F 3\nQ\n", ":2: error: 'Q' is no entry"},
        {"a.vs3", "F 3\n", ": error: there is no face"},
        {"a.msh", "$MeshFormat\n4.1 1 8\n", ":2: error: a binary mesh; convert it to text: gmsh"},
        {"a.msh", "$MeshFormat\n4 0 8\n", ":2: error: version 4 is not read; convert it"},
        {"a.msh", "$Nodes\n1\n", ":1: error: no $MeshFormat"},
        {"a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4000000000\n1 0 0 0\n",
         ":6: error: ends before a node"},
        {"a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n2 0 0 0\n",
         ":7: error: '2' where $EndNodes belongs"},
        {"a.msh",
         "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n1\n"
         "1 2 0 1 5 1\n$EndElements\n",
         ":10: error: this face names node 5"},
        {"a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n0\n$EndNodes\n", "no $Elements"},
        {"a.msh",
         "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n0\n$EndNodes\n$Elements\n1\n"
         "1 4 0 1 2 3 4\n$EndElements\n",
         ":9: error: there are volumes in it and no face"},
        {"a.bdf", "GRID,1,,0,0,0\nCTRIA3,1,1,1,2,3\n", ":2: error: this face names node 2"},
        {"a.bdf", "GRID,1,4,0,0,0\n", ":1: error: GRID 1 is in coordinate system 4"},
        {"a.bdf", "GRID           1             1.x      0.      0.\n",
         ":1: error: '1.x' where x of GRID belongs"},
        {"a.bdf", "$\nCQUAD4,1,1,1,2,3\n", ":2: error: 0 where a corner of CQUAD4 belongs"},
        {"a.bdf", "INCLUDE 'b.bdf'\n", ":1: error: INCLUDE is not followed"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        text.size = 0;
        put("%s", cases[i].content);
        write_text(cases[i].name);
        const char *said = refusal(in_folder(cases[i].name));
        ck_assert_msg(strstr(said, cases[i].said), "%zu: %s", i, said);
        ck_assert_msg(strchr(said, '\n') == said + strlen(said) - 1, "more than one line: %s",
                      said);
    }
}
END_TEST

/* Subsurfaces come before their bases; combined surfaces have one material. */
START_TEST(test_view3d_surfaces)
{
    struct scene_file f;
    text.size = 0;
    put("T planes\nF 3a\nS 1 R 0 0 .9 wall\n 3 0 0 0 90 3 2\nS 2 Q 1 0 .8 window\n"
        "3 0 0 0 90\n 1 .5 2 .5 2 1.5 1 1.5\nS 3 t 0 1 .9\n 0 0 0 180 0 0 0 1 0 0 1\n"
        "O 4 R 0 4 0 180 0 1 1\n*\n");
    write_text("planes.vs3");
    ck_assert_int_eq(scene_file_read(&f, in_folder("planes.vs3"), &quietly), 0);
    ck_assert_uint_eq(f.polygon_count, 4);
    static const char *const names[] = {"window", "wall", "wall", "obstruction"};
    static const double first[4][3] = {{2, 0, .5}, {3, 0, 2}, {0, 0, 0}, {0, 5, 0}};
    size_t at = 0;
    for (int i = 0; i < 4; at += f.sizes[i++]) {
        ck_assert_str_eq(f.names[f.polygon_materials[i]], names[i]);
        for (int k = 0; k < 3; k++)
            ck_assert_double_eq_tol(f.positions[3 * f.indices[at] + (unsigned)k], first[i][k],
                                    1e-14);
    }
    scene_file_free(&f);
}
END_TEST

int main(void)
{
    if (folder_make("mesh_formats") < 0)
        return EXIT_FAILURE;
    Suite *suite = suite_create("mesh_formats");
    TCase *t = tcase_create("mesh_formats");
    tcase_set_timeout(t, 60);
    tcase_add_loop_test(t, test_polygons, 0, FORMATS);
    tcase_add_test(t, test_factors);
    tcase_add_test(t, test_refusals);
    tcase_add_test(t, test_view3d_surfaces);
    suite_add_tcase(suite, t);
    int failed = suite_failures(suite);
    folder_remove();
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
