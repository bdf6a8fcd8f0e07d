/* check_mesh_formats.c - one room in every mesh format: the same polygons, corner by corner, and
 * the same matrix of view factors as its OBJ file, byte by byte.
 *
 * The writers here know the formats and nothing of the readers. Node numbers have gaps and come in
 * an order of their own wherever the format lets them.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "command.h"
#include "solver/mesh_text.h"
#include "suite.h"

enum { POINTS = 16, FACES = 12 };

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
        FACES + 2 + (FACES + 2) / 3);
    for (int i = 0; i < FACES; i++) {
        put("%d %d 2 %d 1", i + 3, corners(i) - 1, i < 7 ? 7 : 9);
        put_corners(i, " %d", 5, 3);
        put("\n");
        if (i % 3)
            continue;
        put("%d %d 2 11 1", i + 3, corners(i) - 1); /* in a second group, too */
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

static const int whole_surfaces[] = {31, 31, 31, 32}, pieces_of_surfaces[] = {41, 42, 42, 43};

static void put_gmsh_4(const int on[4], const char *pieces)
{
    put("%s$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 7 \"walls\"\n2 9 \"block\"\n"
        "$EndPhysicalNames\n$Entities\n1 0 2 0\n1 0 0 0 0\n"
        "31 0 0 0 4 5 3 1 7 0\n32 1 1 1 2 3 2 1 -9 0\n$EndEntities\n%s$Nodes\n2 %d 5 50\n",
        on[0] == 31 ? "" : "$Comments\n$Nodes\n$EndComments\n", on[0] == 31 ? "" : pieces, POINTS);
    for (int half = 0; half < 2; half++) {
        const int from = half * 10, to = half ? POINTS : 10;
        put("2 %d 0 %d\n", 31 + half, to - from);
        for (int i = from; i < to; i++)
            put("%d\n", 3 * i + 5);
        for (int i = from; i < to; i++)
            put("%g %g %g\n", point[i][0], point[i][1], point[i][2]);
    }
    put("$EndNodes\n$Elements\n4 %d 1 %d\n", FACES, FACES);
    put_block_4(0, 3, on[0]);
    put_block_4(3, 5, on[1]);
    put_block_4(5, 7, on[2]);
    put_block_4(7, FACES, on[3]);
    put("$EndElements\n");
}

static void write_gmsh_4(void)
{
    put_gmsh_4(whole_surfaces, NULL);
}

/* Cut up: a piece is in its surface's group, or in its own where that has none. */
static void write_gmsh_4_pieces(void)
{
    put_gmsh_4(pieces_of_surfaces,
               "$PartitionedEntities\n2\n1\n44 1\n1 0 3 0\n2 0 1 1 1 0 0 0 0\n"
               "41 2 31 1 1 0 0 0 4 5 3 1 11 0\n42 2 31 2 1 2 0 0 0 4 5 3 0 1 9\n"
               "43 3 1 1 2 1 1 1 2 3 2 2 -9 11 0\n$EndPartitionedEntities\n");
}

static int high_first; /* the order of put_bytes */

static void put_bytes(uint64_t bits, int size)
{
    ck_assert_uint_lt(text.size + (size_t)size, TEXT);
    for (int k = 0; k < size; k++)
        text.at[text.size++] = (char)(bits >> 8 * (high_first ? size - 1 - k : k) & 0xff);
}

static void put_doubles(const double *x, int count)
{
    for (int k = 0; k < count; k++) {
        uint64_t bits;
        memcpy(&bits, &x[k], sizeof bits);
        put_bytes(bits, 8);
    }
}

/* Elements of a kind stand together, or one by one. */
static void write_gmsh_2_binary(void)
{
    put("$MeshFormat\n2.2 1 8\n");
    put_bytes(1, 4);
    put("\n$EndMeshFormat\n$PhysicalNames\n2\n2 7 \"walls\"\n2 9 \"block\"\n$EndPhysicalNames\n"
        "$Nodes\n%d\n",
        POINTS);
    for (int i = POINTS; i-- > 0;) {
        put_bytes((uint64_t)(3 * i + 5), 4);
        put_doubles(point[i], 3);
    }
    put("\n$EndNodes\n$Elements\n%d\n", FACES + 1);
    const int rim[] = {8, 1, 2, 1, 7, 1, 5, 8, 11}; /* a curved line */
    for (int k = 0; k < 9; k++)
        put_bytes((uint64_t)rim[k], 4);
    for (int i = 0; i < FACES; i++) {
        if (i == 0 || i == 3 || i == 5) {
            put_bytes((uint64_t)corners(i) - 1, 4);
            put_bytes(i == 0 ? 3 : i == 3 ? 2 : FACES - 5, 4);
            put_bytes(2, 4);
        }
        put_bytes((uint64_t)i + 2, 4);
        put_bytes(i < 7 ? 7 : 9, 4);
        put_bytes(1, 4);
        for (int j = 0; j < corners(i); j++)
            put_bytes((uint64_t)(5 + 3 * face[i][j]), 4);
    }
    put("\n$EndElements\n");
}

static void put_rest_4(int coordinates, int group, int bounds)
{
    static const double box[6] = {0, 0, 0, 4, 5, 3};
    put_doubles(box, coordinates);
    put_bytes(group != 0, 8);
    if (group)
        put_bytes((uint64_t)(int64_t)group, 4);
    if (coordinates == 6)
        put_bytes((uint64_t)bounds, 8);
    for (int k = 0; k < bounds; k++)
        put_bytes((uint64_t)k + 1, 4);
}

static void put_entity_4(int tag, int coordinates, int group, int bounds)
{
    put_bytes((uint64_t)tag, 4);
    put_rest_4(coordinates, group, bounds);
}

static void put_piece_4(int tag, int dimension, int parent, int group, int bounds)
{
    const int first[] = {tag, dimension, parent};
    for (int k = 0; k < 3; k++)
        put_bytes((uint64_t)first[k], 4);
    put_bytes(2, 8);
    put_bytes(1, 4);
    put_bytes(2, 4);
    put_rest_4(6, group, bounds);
}

/* High bytes first; the nodes of the first half have places on their surface. */
static void put_gmsh_4_binary(const int on[4])
{
    static const int from[] = {0, 3, 5, 7, FACES};
    high_first = 1;
    put("$MeshFormat\n4.1 1 8\n");
    put_bytes(1, 4);
    put("\n$EndMeshFormat\n$PhysicalNames\n2\n2 7 \"walls\"\n2 9 \"block\"\n$EndPhysicalNames\n"
        "$Entities\n");
    put_bytes(1, 8);
    put_bytes(1, 8);
    put_bytes(2, 8);
    put_bytes(0, 8);
    put_entity_4(1, 3, 0, 0);
    put_entity_4(4, 6, 3, 2);
    put_entity_4(31, 6, 7, 1);
    put_entity_4(32, 6, -9, 0);
    put("\n$EndEntities\n");
    if (on[0] != 31) {
        static const int counts[] = {2, 1, 0, 0, 3, 0};
        put("$PartitionedEntities\n");
        for (int k = 0; k < 6; k++) {
            put_bytes((uint64_t)counts[k], 8);
            if (k == 1) { /* the ghost: its number, its partition */
                put_bytes(44, 4);
                put_bytes(1, 4);
            }
        }
        put_piece_4(41, 2, 31, 11, 0);
        put_piece_4(42, 2, 31, 0, 1);
        put_piece_4(43, 3, 1, -9, 2);
        put("\n$EndPartitionedEntities\n");
    }
    put("$Nodes\n");
    for (int k = 0; k < 4; k++)
        put_bytes(k == 0 ? 2 : POINTS, 8);
    for (int half = 0; half < 2; half++) {
        put_bytes(2, 4);
        put_bytes((uint64_t)half + 31, 4);
        put_bytes(!half, 4);
        put_bytes(POINTS / 2, 8);
        for (int i = 0; i < POINTS / 2; i++)
            put_bytes((uint64_t)(3 * (i + half * POINTS / 2) + 5), 8);
        for (int i = 0; i < POINTS / 2; i++) {
            put_doubles(point[i + half * POINTS / 2], 3);
            if (!half)
                put_doubles(point[i], 2);
        }
    }
    put("\n$EndNodes\n$Elements\n");
    for (int k = 0; k < 4; k++)
        put_bytes(k == 0 ? 4 : FACES, 8);
    for (int b = 0; b < 4; b++) {
        put_bytes(2, 4);
        put_bytes((uint64_t)on[b], 4);
        put_bytes((uint64_t)corners(from[b]) - 1, 4);
        put_bytes((uint64_t)(from[b + 1] - from[b]), 8);
        for (int i = from[b]; i < from[b + 1]; i++) {
            put_bytes((uint64_t)i + 1, 8);
            for (int j = 0; j < corners(i); j++)
                put_bytes((uint64_t)(5 + 3 * face[i][j]), 8);
        }
    }
    put("\n$EndElements\n");
    high_first = 0;
}

static void write_gmsh_4_binary(void)
{
    put_gmsh_4_binary(whole_surfaces);
}

static void write_gmsh_4_binary_pieces(void)
{
    put_gmsh_4_binary(pieces_of_surfaces);
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

static void write_vtk_3(void)
{
    int numbers = 2;
    for (int i = 0; i < FACES; i++)
        numbers += 1 + corners(i);
    put("# vtk DataFile Version 3.0\na # room\nASCII\nDATASET UNSTRUCTURED_GRID\nFIELD FieldData "
        "1\nTIME 1 1 double\n0\nPOINTS %d double\n",
        POINTS);
    for (int i = 0; i < POINTS; i++)
        put("%g %g %g%s", point[i][0], point[i][1], point[i][2], i % 3 ? " " : "\n");
    put("\nCELLS %d %d\n1 3\n", FACES + 1, numbers);
    for (int i = 0; i < FACES; i++) {
        put("%d", corners(i));
        put_corners(i, " %d", 0, 1);
        put("\n");
    }
    put("CELL_TYPES %d\n1\n", FACES + 1);
    for (int i = 0; i < FACES; i++)
        put("%d\n", corners(i) == 3 ? 5 : i % 2 ? 9 : 7);
    put("CELL_DATA %d\nSCALARS q float\n", FACES + 1);
}

/* Offsets from `first` of them on. */
static void put_offsets(int first)
{
    int sum = 0;
    if (!first)
        put("0");
    for (int i = 0; i < FACES; i++)
        put(" %d", sum += corners(i));
    put("\n");
}

static void put_connectivity(void)
{
    for (int i = 0; i < FACES; i++)
        put_corners(i, " %d", 0, 1);
    put("\n");
}

static void write_vtk_5(void)
{
    put("# vtk DataFile Version 5.1\n\nASCII\nDATASET POLYDATA\nPOINTS %d double\n", POINTS);
    for (int i = 0; i < POINTS; i++)
        put("%g %g %g\n", point[i][0], point[i][1], point[i][2]);
    put("METADATA\nINFORMATION 0\n\nVERTICES 2 1\nOFFSETS vtktypeint64\n0 1\nCONNECTIVITY "
        "vtktypeint64\n5\nPOLYGONS %d %d\nOFFSETS vtktypeint64\n",
        FACES + 1, 4 * FACES - 2);
    put_offsets(0);
    put("CONNECTIVITY vtktypeint64\n");
    put_connectivity();
    put("POINT_DATA 16\n");
}

static void put_ints(int size, int count, const int *ints)
{
    for (int i = 0; i < count; i++)
        put_bytes((uint64_t)(int64_t)ints[i], size);
}

/* Before what is read stand data of other kinds, which are passed over. */
static void put_binary_vtk(const char *version, const char *kind)
{
    high_first = 1;
    put("# vtk DataFile Version %s\na # room\nBINARY\nDATASET %s\nFIELD FieldData 3\n", version,
        kind);
    put("names 1 2 string\n\xC3%s", "a\nb");
    put_bytes(0x8003, 2); /* 3 again, of 14 bits */
    put("c d\nTIME 2 1 double\n");
    put_doubles(point[6], 2);
    put("\nMASK 3 3 bit\n");
    put_bytes(0x0a0a, 2);
    put("\nPOINTS %d double\n", POINTS);
    for (int i = 0; i < POINTS; i++)
        put_doubles(point[i], 3);
    put("\nMETADATA\nINFORMATION 0\n\n");
}

static void write_vtk_3_binary(void)
{
    int numbers = 2;
    for (int i = 0; i < FACES; i++)
        numbers += 1 + corners(i);
    put_binary_vtk("3.0", "UNSTRUCTURED_GRID");
    put("CELLS %d %d\n", FACES + 1, numbers);
    put_ints(4, 2, (const int[]){1, 3});
    for (int i = 0; i < FACES; i++) {
        put_bytes((uint64_t)corners(i), 4);
        put_ints(4, corners(i), face[i]);
    }
    put("\nCELL_TYPES %d\n", FACES + 1);
    put_bytes(1, 4);
    for (int i = 0; i < FACES; i++)
        put_bytes(corners(i) == 3 ? 5 : i % 2 ? 9 : 7, 4);
    put("\nCELL_DATA %d\nSCALARS q float\n", FACES + 1);
    high_first = 0;
}

static void write_vtk_5_binary(void)
{
    int sum = 0;
    put_binary_vtk("5.1", "POLYDATA");
    put("VERTICES 2 1\nOFFSETS vtktypeint64\n");
    put_ints(8, 2, (const int[]){0, 1});
    put("\nCONNECTIVITY vtkIdType\n");
    put_bytes(5, 4);
    put("\nPOLYGONS %d %d\nOFFSETS unsigned_char\n", FACES + 1, 4 * FACES - 2);
    put_bytes(0, 1);
    for (int i = 0; i < FACES; i++)
        put_bytes((uint64_t)(sum += corners(i)), 1);
    put("\nCONNECTIVITY vtktypeint64\n");
    for (int i = 0; i < FACES; i++)
        put_ints(8, corners(i), face[i]);
    put("\n");
    high_first = 0;
}

static void put_array(const char *type, const char *name)
{
    put("<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"ascii\">\n", type,
        name, *type == 'F' ? 3 : 1);
}

static void write_xml_ascii(const char *kind, const char *section)
{
    put("<?xml version=\"1.0\"?>\n<VTKFile type=\"%s\" version=\"0.1\" "
        "byte_order=\"LittleEndian\">\n<%s>\n<Piece NumberOfPoints=\"%d\" NumberOf%s=\"%d\">\n"
        "<CellData><DataArray type=\"Int32\" Name=\"types\" format=\"ascii\">x</DataArray>"
        "</CellData>\n<Points>\n",
        kind, kind, POINTS, section, FACES);
    put_array("Float64", "Points");
    for (int i = 0; i < POINTS; i++)
        put("%g %g %g\n", point[i][0], point[i][1], point[i][2]);
    put("<InformationKey name=\"L2_NORM_RANGE\"><Value index=\"0\">7</Value></InformationKey>"
        "</DataArray></Points>\n<%s>",
        section);
    put_array("Int64", "connectivity");
    put_connectivity();
    put("</DataArray>");
    put_array("Int64", "offsets");
    put_offsets(1);
    put("</DataArray>");
    if (*section == 'C') {
        put_array("UInt8", "types");
        for (int i = 0; i < FACES; i++)
            put("%d ", corners(i) == 3 ? 5 : 9);
        put("</DataArray>");
    }
    put("</%s></Piece></%s></VTKFile>\n", section, kind);
}

static void write_vtu(void)
{
    write_xml_ascii("UnstructuredGrid", "Cells");
}

static void write_vtp(void)
{
    write_xml_ascii("PolyData", "Polys");
}

static struct {
    unsigned char at[4096];
    size_t size;
} raw;

/* Big-endian, whatever this machine is. */
static void put_raw(uint64_t bits, int size)
{
    while (size-- > 0)
        raw.at[raw.size++] = (unsigned char)(bits >> 8 * size);
}

/* As base64; "====" never ends here, as padding is of one or two. */
static void put_digits(const unsigned char *at, size_t size)
{
    static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        uint32_t group = 0;
        for (size_t k = 0; k < 3; k++)
            group = group << 8 | (i + k < size ? at[i + k] : 0);
        for (size_t k = 0; k < 4; k++)
            put("%c", i + k <= size ? digit[group >> (18 - 6 * k) & 63] : '=');
    }
}

static void put_count(unsigned char *at, uint64_t count)
{
    for (int k = 0; k < 8; k++)
        at[k] = (unsigned char)(count >> (56 - 8 * k));
}

static int compressed; /* 1: arrays in blocks of 40 bytes, the last one what is left */
static enum { INLINE, RAW, LETTERS } appended; /* arrays stand behind all elements */
static struct {
    char at[TEXT];
    size_t size;
} behind;

static void put_encoded(const unsigned char *at, size_t size)
{
    const size_t start = text.size;
    for (size_t i = 0; i < size && appended == RAW; i++)
        put_bytes(at[i], 1);
    if (appended != RAW)
        put_digits(at, size);
    if (!appended)
        return;
    ck_assert_uint_lt(behind.size + text.size - start, TEXT);
    memcpy(behind.at + behind.size, text.at + start, text.size - start);
    behind.size += text.size - start;
    text.size = start;
}

static void put_array_of_bytes(const char *type, const char *name)
{
    put("<DataArray type=\"%s\" Name=\"%s\" format=\"%s\" offset=\"%zu\">\n  ", type, name,
        appended ? "appended" : "binary", behind.size);
    if (compressed) {
        enum { BLOCK = 40 };
        static unsigned char head[1024], blocks[8192];
        const size_t body = raw.size - 8, count = (body + BLOCK - 1) / BLOCK;
        size_t used = 0;
        put_count(head, count);
        put_count(head + 8, BLOCK);
        put_count(head + 16, body % BLOCK);
        for (size_t i = 0; i < count; i++) {
            uLongf made = sizeof blocks - used;
            const size_t size = body - i * BLOCK < BLOCK ? body - i * BLOCK : BLOCK;
            ck_assert_int_eq(compress(blocks + used, &made, raw.at + 8 + i * BLOCK, size), Z_OK);
            put_count(head + 24 + 8 * i, made);
            used += made;
        }
        put_encoded(head, 24 + 8 * count);
        put_encoded(blocks, used);
    } else {
        put_count(raw.at, raw.size - 8);
        put_encoded(raw.at, raw.size);
    }
    put("\n</DataArray>\n");
    raw.size = 8;
}

/* Three pieces, of which the second has the block and the third nothing. */
static void write_vtu_base64(void)
{
    put("<VTKFile type=\"UnstructuredGrid\" byte_order=\"BigEndian\" header_type=\"UInt64\"%s>"
        "<UnstructuredGrid>",
        compressed ? " compressor=\"vtkZLibDataCompressor\"" : "");
    raw.size = 8;
    behind.size = 0;
    for (int half = 0; half < 3; half++) {
        const int from = half == 0 ? 0 : half == 1 ? 7 : FACES, to = half == 0 ? 7 : FACES;
        put("<Piece NumberOfPoints=\"%d\" NumberOfCells=\"%d\"><Points>", half < 2 ? 8 : 0,
            to - from);
        for (int i = 8 * half; i < 8 * half + 8 && i < POINTS; i++)
            for (int k = 0; k < 3; k++) {
                uint64_t bits;
                memcpy(&bits, &point[i][k], sizeof bits);
                put_raw(bits, 8);
            }
        put_array_of_bytes("Float64", "p");
        put("</Points><Cells>");
        int sum = 0;
        for (int i = from; i < to; i++)
            for (int j = 0; j < corners(i); j++)
                put_raw((uint64_t)(face[i][j] - 8 * half), 4);
        put_array_of_bytes("Int32", "connectivity");
        for (int i = from; i < to; i++)
            put_raw((uint64_t)(sum += corners(i)), 2);
        put_array_of_bytes("UInt16", "offsets");
        for (int i = from; i < to; i++)
            put_raw(corners(i) == 3 ? 5 : 9, 1);
        put_array_of_bytes("UInt8", "types");
        put("</Cells></Piece>");
    }
    put("</UnstructuredGrid>");
    if (appended) {
        put("<AppendedData encoding=\"%s\">\n  _", appended == RAW ? "raw" : "base64");
        for (size_t i = 0; i < behind.size; i++)
            put_bytes((unsigned char)behind.at[i], 1);
        put("\n</AppendedData>");
    }
    put("</VTKFile>");
}

static void write_vtu_zlib(void)
{
    compressed = 1;
    write_vtu_base64();
    compressed = 0;
}

static void write_vtu_raw(void)
{
    appended = RAW;
    write_vtu_base64();
    appended = INLINE;
}

static void write_vtu_raw_zlib(void)
{
    appended = RAW;
    write_vtu_zlib();
    appended = INLINE;
}

static void write_vtu_letters(void)
{
    appended = LETTERS;
    write_vtu_base64();
    appended = INLINE;
}

static void write_vtu_letters_zlib(void)
{
    appended = LETTERS;
    write_vtu_zlib();
    appended = INLINE;
}

/* ---- */

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
    {"bytes_2.msh", write_gmsh_2_binary, "walls", "block"},
    {"bytes_4.msh", write_gmsh_4_binary, "walls", "block"},
    {"pieces.msh", write_gmsh_4_pieces, "walls", "block"},
    {"bytes_pieces.msh", write_gmsh_4_binary_pieces, "walls", "block"},
    {"small.bdf", write_nastran_small, "PSHELL 7", "PSHELL 9"},
    {"large.nas", write_nastran_large, "PSHELL 7", "PSHELL 9"},
    {"free.BDF", write_nastran_free, "PSHELL 7", "PSHELL 9"},
    {"three.vtk", write_vtk_3, "DefaultMaterial", "DefaultMaterial"},
    {"five.vtk", write_vtk_5, "DefaultMaterial", "DefaultMaterial"},
    {"bytes_3.vtk", write_vtk_3_binary, "DefaultMaterial", "DefaultMaterial"},
    {"bytes_5.vtk", write_vtk_5_binary, "DefaultMaterial", "DefaultMaterial"},
    {"room.vtu", write_vtu, "DefaultMaterial", "DefaultMaterial"},
    {"bytes.vtu", write_vtu_base64, "DefaultMaterial", "DefaultMaterial"},
    {"zlib.vtu", write_vtu_zlib, "DefaultMaterial", "DefaultMaterial"},
    {"raw.vtu", write_vtu_raw, "DefaultMaterial", "DefaultMaterial"},
    {"raw_zlib.vtu", write_vtu_raw_zlib, "DefaultMaterial", "DefaultMaterial"},
    {"letters.vtu", write_vtu_letters, "DefaultMaterial", "DefaultMaterial"},
    {"letters_zlib.vtu", write_vtu_letters_zlib, "DefaultMaterial", "DefaultMaterial"},
    {"room.vtp", write_vtp, "DefaultMaterial", "DefaultMaterial"},
};
enum { FORMATS = sizeof formats / sizeof *formats };

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
    char out[80];
    snprintf(out, sizeof out, "%s.csv", name);
    ck_assert_int_eq(shell("$RADIOSITY viewfactors %s -q -o %s", in_folder(name), in_folder(out)),
                     0);
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

/* One point in systems of every kind, in one another, before them and behind them. */
START_TEST(test_systems_of_nastran)
{
    struct scene_file f;
    text.size = 0;
    put("GRDSET,,6\n"
        "GRID,1,2,1.,2.,3.\nGRID,2,3,2.,90.,1.\nGRID,3,4,2.,90.,0.\nGRID,4,5,1.,0.,0.\n"
        "GRID,11,0,10.,0.,0.\nGRID,12,0,10.,0.,1.\nGRID,13,0,10.,1.,0.\nGRID,5,,1.,0.,0.\n"
        "CTRIA3,1,1,1,2,3\nCTRIA3,2,1,3,4,5\n"
        /* 2: moved by 10, x to the old y, y to -x; 3 and 4 in it; 5 by points; 6 by angles in 4 */
        "CORD2R  2               10.     0.      0.      10.     0.      1.\n"
        "        10.     1.      0.\n"
        "CORD2C,3,2,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"
        "CORD2S,4,2,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"
        "CORD1R,5,11,12,13,7,11,12,13\n"
        "CORD2R,6,4,1.,90.,0.,1.,0.,0.\n,2.,90.,0.\n");
    write_text("systems.bdf");
    ck_assert_int_eq(scene_file_read(&f, in_folder("systems.bdf"), &quietly), 0);
    /* 6: from (1 0 0) of 2 z goes to (0 0 1), so along (-1 0 1), and x, in the plane with (2 0 0),
     * along (1 0 1) */
    static const double wanted[5][3] = {{8, 1, 3},
                                        {8, 0, 1},
                                        {10, 2, 0},
                                        {10, 1, 0},
                                        {10, 1 + .70710678118654752, .70710678118654752}};
    static const int order[6] = {0, 1, 2, 2, 3, 4};
    ck_assert_uint_eq(f.polygon_count, 2);
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 3; k++)
            ck_assert_double_eq_tol(f.positions[3 * f.indices[i] + (unsigned)k],
                                    wanted[order[i]][k], 1e-14);
    scene_file_free(&f);
}
END_TEST

/* What a line leaves out is empty, whatever comes behind it: eight fields, or four with a `*`. */
START_TEST(test_short_lines_of_nastran)
{
    static const char *const cards[] = {
        "CORD2R,3,,10.,20.\n,10.,21.\n",
        "CORD2R,3,,10.,20.,,,,\n,10.,21.,\n",
        "CORD2R  3               10.     20.\n        10.     21.\n",
        "CORD2R*,3,,10.,20.\n*\n*,10.,21.\n",
        "CORD2R*,3,,10.,20.\n*,,,,\n,10.,21.\n",
        ("CORD2R* 3                               10.             20.\n*\n"
         "*       10.             21.\n"),
    };
    struct scene_file f;
    text.size = 0;
    put("%sGRID,1,3,0.,0.,0.\nGRID,2,3,0.,0.,1.\nGRID,3,3,0.,1.,0.\nCTRIA3,1,1,1,2,3\n", cards[_i]);
    write_text("short.bdf");
    ck_assert_int_eq(scene_file_read(&f, in_folder("short.bdf"), &quietly), 0);
    /* z goes from (10 20 0) to the origin, y downwards */
    const double root = sqrt(.2);
    const double wanted[3][3] = {{10, 20, 0}, {10 - root, 20 - 2 * root, 0}, {10, 20, -1}};
    for (unsigned i = 0; i < 3; i++)
        for (unsigned k = 0; k < 3; k++)
            ck_assert_double_eq_tol(f.positions[3 * f.indices[i] + k], wanted[i][k], 1e-14);
    scene_file_free(&f);
}
END_TEST

/* Files that a file names, that a file names which it names; of the second quote may be any part.
 */
START_TEST(test_includes_of_nastran)
{
    static const struct {
        const char *name, *content;
    } files[] = {{"points.bdf", "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\r\nGRID,3,,0.,1.,0."},
                 {"one shell.bdf", "include points.bdf\nCTRIA3,1,7,1,2,3\nCTRIA3,2,8,1,3,2\n"},
                 {"all.bdf", "BEGIN BULK\nINCLUDE 'one \r\n  shell.bdf' $ and more\n"
                             "CTRIA3,3,9,1,2,3\nENDDATA\n"}};
    struct scene_file f;
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        text.size = 0;
        put("%s", files[i].content);
        write_text(files[i].name);
    }
    ck_assert_int_eq(scene_file_read(&f, in_folder("all.bdf"), &quietly), 0);
    ck_assert_uint_eq(f.polygon_count, 3);
    ck_assert_double_eq(f.positions[3 * f.indices[1]], 1);
    ck_assert_str_eq(f.names[f.polygon_materials[1]], "PSHELL 8");
    ck_assert_uint_eq(f.lines[1], 0); /* no line of this file */
    ck_assert_uint_eq(f.lines[2], 4);
    scene_file_free(&f);
}
END_TEST

/* GRDSET is for all points that name no system, wherever it stands; 0 is a name. */
START_TEST(test_defaults_of_nastran)
{
    static const char *const cards[4] = {
        "GRID,1,,0.,0.,0.\nGRID,2,,0.,0.,1.\nGRID,3,0,0.,1.,0.\n", "CTRIA3,1,1,1,2,3\n",
        "CORD2R,3,,10.,0.,0.,10.,0.,1.\n,11.,0.,0.\n", "GRDSET,,3\n"};
    struct scene_file f;
    text.size = 0;
    for (int i = 0; i < 4; i++)
        put("%s", cards[(i + _i) % 4]);
    write_text("default.bdf");
    ck_assert_int_eq(scene_file_read(&f, in_folder("default.bdf"), &quietly), 0);
    static const double wanted[3][3] = {{10, 0, 0}, {10, 0, 1}, {0, 1, 0}};
    for (unsigned i = 0; i < 3; i++)
        for (unsigned k = 0; k < 3; k++)
            ck_assert_double_eq(f.positions[3 * f.indices[i] + k], wanted[i][k]);
    scene_file_free(&f);
}
END_TEST

/* Each binary mesh, cut at every byte, is refused in one line, but where only ends of lines are
 * lost; so is one whose counts are huge. */
START_TEST(test_cut_bytes)
{
    static void (*const writers[])(void) = {
        write_gmsh_2_binary, write_gmsh_4_binary,    write_vtu_zlib,    write_vtu_raw,
        write_vtu_raw_zlib,  write_vtu_letters_zlib, write_vtk_5_binary};
    static const char *const names[] = {"cut.msh", "cut.msh", "cut.vtu", "cut.vtu",
                                        "cut.vtu", "cut.vtu", "cut.vtk"};
    static char whole[TEXT];
    text.size = 0;
    writers[_i]();
    const size_t size = text.size;
    memcpy(whole, text.at, size);
    for (size_t cut = 1; cut + 4 < size; cut += 1 + cut / 97) {
        memcpy(text.at, whole, text.size = cut);
        write_text(names[_i]);
        const char *said = refusal(in_folder(names[_i]));
        ck_assert_msg(strchr(said, '\n') == said + strlen(said) - 1, "%zu: %s", cut, said);
    }
    for (size_t at = 60; at + 8 < size; at += 1 + at / 97) {
        struct scene_file f;
        memcpy(text.at, whole, text.size = size);
        memset(text.at + at, 0x7f, 4);
        write_text(names[_i]);
        if (scene_file_read(&f, in_folder(names[_i]), &quietly) == 0)
            scene_file_free(&f); /* a coordinate, say */
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

/* Of faces with nodes beside their corners it is told once that these are not read; of others
 * nothing is, also where Nastran leaves those fields empty or writes an angle there. */
START_TEST(test_curved)
{
    static const char gmsh[] = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n1 0 0 0\n"
                               "2 1 0 0\n3 0 1 0\n4 .5 -.1 0\n5 .6 .6 0\n6 -.1 .5 0\n"
                               "$EndNodes\n$Elements\n";
    static const char vtk[] = "# vtk DataFile Version 3.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\n"
                              "POINTS 6 float\n0 0 0 1 0 0 0 1 0 .5 -.1 0 .6 .6 0 -.1 .5 0\n";
    static const char grids[] = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\n"
                                "GRID,4,,.5,-.1,0.\nGRID,5,,.6,.6,0.\nGRID,6,,-.1,.5,0.\n";
    static const struct {
        const char *name, *begin, *rest, *said;
    } cases[] = {
        {"c.msh", gmsh, "2\n1 9 0 1 2 3 4 5 6\n2 9 0 3 2 1 5 4 6\n$EndElements\n",
         ":15: warning: nodes beside the corners of faces are not read (2 such"},
        {"c.msh", gmsh, "1\n1 2 0 1 2 3\n$EndElements\n", NULL},
        {"c.vtk", vtk, "CELLS 1 7\n6 0 1 2 3 4 5\nCELL_TYPES 1\n22\n",
         "warning: nodes beside the corners of faces are not read (1 such"},
        {"c.vtk", vtk, "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\n", NULL},
        {"c.vtk", vtk, "CELLS 1 6\n5 0 1 4 2 5\nCELL_TYPES 1\n7\n", NULL},
        {"c.bdf", grids, "CTRIA6,1,1,1,2,3,4,5,6\n",
         ":7: warning: nodes beside the corners of faces are not read (1 such"},
        {"c.bdf", grids, "CTRIA6,1,1,1,2,3\n", NULL},
        {"c.bdf", grids, "CTRIA6,1,1,1,2,3,,,,45.\n", NULL},
        {"c.bdf", grids, "CTRIA3,1,1,1,2,3,45.\n", NULL},
    };
    static const struct scene_options told = {.quiet = 0};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        text.size = 0;
        put("%s%s", cases[i].begin, cases[i].rest);
        write_text(cases[i].name);
        const char *said = said_of(in_folder(cases[i].name), &told, 0);
        if (cases[i].said)
            ck_assert_msg(strstr(said, cases[i].said) != NULL, "%zu: %s", i, said);
        else
            ck_assert_msg(!strstr(said, "beside"), "%zu: %s", i, said);
    }
}
END_TEST

/* Surfaces of cards that are not read are counted, beside faces that are. */
START_TEST(test_passed_over)
{
    static const struct scene_options told = {.quiet = 0};
    text.size = 0;
    put("GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\nCTRIA3,1,1,1,2,3\n"
        "CHBDYG,2,,AREA3,,,,,,+\n+,1,2,3\nCTRIAX6,3,1,1,2,3\n");
    write_text("skins.bdf");
    const char *said = said_of(in_folder("skins.bdf"), &told, 0);
    ck_assert_msg(strstr(said, ":5: warning: 2 surfaces of heat") != NULL, "%s", said);
}
END_TEST

/* A hexagon and an L are one polygon each; each triangle of a strip is one, with one front. */
START_TEST(test_polygons_of_vtk)
{
    struct scene_file f;
    text.size = 0;
    put(POLYDATA "POINTS 12 float\n0 0 0 2 0 0 2 1 0 1 1 0 1 2 0 0 2 0\n"
                 "0 0 1 1 0 1 0 1 1 1 1 1 0 2 1 1 2 1\n"
                 "POLYGONS 1 7\n6 0 1 2 3 4 5\nTRIANGLE_STRIPS 1 7\n6 6 7 8 9 10 11\n");
    write_text("strip.vtk");
    ck_assert_int_eq(scene_file_read(&f, in_folder("strip.vtk"), &quietly), 0);
    static const uint32_t indices[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 8, 7, 9, 8, 9, 10, 10, 9, 11};
    ck_assert_uint_eq(f.polygon_count, 5);
    ck_assert_uint_eq(f.sizes[0], 6);
    ck_assert_uint_eq(f.index_count, sizeof indices / sizeof *indices);
    ck_assert_mem_eq(f.indices, indices, sizeof indices);
    scene_file_free(&f);
    static char rows[TEXT];
    rows[matrix("strip.vtk", rows, TEXT - 1)] = '\0';
    int lines = 0;
    for (const char *c = rows; *c; c++)
        lines += *c == '\n';
    ck_assert_int_eq(lines, 5);
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
    tcase_add_test(t, test_passed_over);
    tcase_add_test(t, test_systems_of_nastran);
    tcase_add_loop_test(t, test_short_lines_of_nastran, 0, 6);
    tcase_add_loop_test(t, test_defaults_of_nastran, 0, 4);
    tcase_add_test(t, test_includes_of_nastran);
    tcase_add_loop_test(t, test_cut_bytes, 0, 7);
    tcase_add_test(t, test_view3d_surfaces);
    tcase_add_test(t, test_polygons_of_vtk);
    tcase_add_test(t, test_curved);
    suite_add_tcase(suite, t);
    int failed = suite_failures(suite);
    folder_remove();
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
