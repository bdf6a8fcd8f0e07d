/* check_mesh_refusals.c - what is wrong with a mesh file is said in one line, with the file's own.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <stdlib.h>
#include <string.h>

#include "solver/mesh_text.h"
#include "suite.h"

#define GRID "<VTKFile type='UnstructuredGrid'><Piece>\n"
#define ZLIB \
    "<VTKFile type='PolyData' compressor='vtkZLibDataCompressor'>\n<Piece><Points><DataArray " \
    "format='binary'>"

#define BINARY "# vtk DataFile Version 3.0\n\nBINARY\nDATASET POLYDATA\n"
#define APPENDED(offset, encoding) \
    "<VTKFile type='PolyData'>\n<Piece><Points><DataArray format='appended' offset='" offset \
    "'/></Points></Piece><AppendedData encoding='" encoding "'>"
#define BEHIND "</AppendedData></VTKFile>"

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
        {"a.vs3", "F 3\nV 1 0 0 0\nM 1 1 1 1 0 1 0 .5 a\n",
         ":3: error: surface 1 is a null or masking surface"},
        {"a.vs3", "F 3\nQ\n", ":2: error: 'Q' is no entry"},
        {"a.vs3", "F 3\n", ": error: there is no face"},
        {"a.msh", "$MeshFormat\n4.1 1 8\n", ":2: error: ends before the number 1"},
        {"a.msh", "$MeshFormat\n4.1 1 8\nabcd", ":2: error: no 1 behind this line"},
        {"a.msh", "$MeshFormat\n4.1 1 4\n", ":2: error: a binary mesh with numbers of 4 bytes"},
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
        {"a.msh",
         "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n0\n$EndNodes\n$Elements\n1\n"
         "1 4294967297 0 1 2 3\n$EndElements\n",
         ":9: error: an element of type 4294967297: types are 1 to 140"},
        {"a.msh",
         "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n0\n$EndNodes\n$Elements\n1\n"
         "1 -7 0 1 2 3\n$EndElements\n",
         ":9: error: an element of type -7"},
        {"a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$ParametricNodes\n0\n",
         ":4: error: nodes with their places on surfaces are not read"},
        {"a.PVTU", "<VTKFile/>", ": error: it names other files, of pieces"},
        {"a.stp", "ISO-10303-21;\n", ": error: a shape that has no mesh yet; make one"},
        {"a.unv", "    -1\n  2411\n", ": error: a mesh of another kind; convert it: gmsh"},
        {"a.bdf", "GRID,1,,0,0,0\nCTRIA3,1,1,1,2,3\n", ":2: error: this face names node 2"},
        {"a.bdf", "GRID,1,4,0,0,0\n", ":1: error: GRID 1 is in coordinate system 4, which is not"},
        {"a.bdf",
         "CORD2R,4,5,0,0,0,0,0,1\n,1,0,0\nCORD2R,5,4,0,0,0,0,0,1\n,1,0,0\nGRID,1,4,0,0,0\n",
         ":5: error: GRID 1 is in coordinate system 4, which is not there, or needs itself"},
        {"a.bdf", "CORD2C,4,,0,0,0,0,0,1\n,0,0,2\n",
         ":1: error: the three points of coordinate system 4 are in a line"},
        {"a.bdf", "CORD1S,4,1,2,3\nCORD1R,4,1,2,3\n", ":2: error: coordinate system 4 is def"},
        {"a.bdf", "CORD1S,4,1,2\n", ":1: error: 0 where a point of CORD1S belongs"},
        {"a.bdf", "CORD2R,4,-1\n", ":1: error: -1 where a system of CORD2R belongs"},
        {"a.bdf", "GRDSET,,.5\n", ":1: error: 0.5 where a system of GRDSET belongs"},
        {"a.bdf", "GRID,1,.5,0,0,0\n", ":1: error: 0.5 where a system of GRID belongs; write"},
        {"a.bdf", "GRID           1             1.x      0.      0.\n",
         ":1: error: '1.x' where x of GRID belongs"},
        {"a.bdf", "$\nCQUAD4,1,1,1,2,3\n", ":2: error: 0 where a corner of CQUAD4 belongs"},
        {"a.bdf", "$\nINCLUDE 'b.bdf'\n", ":2: error: INCLUDE of '"},
        {"a.bdf", "INCLUDE 'b.bdf\n", ":1: error: INCLUDE names no file"},
        {"a.bdf", "INCLUDE 'a.bdf'\n", ":1: error: INCLUDE goes on and on; is it a circle?"},
        {"a.bdf", "CTRIA3,1,1,1,2,3\n=,*1,=,=\n", ":2: error: this line repeats the card before"},
        {"a.vtk", "x\n", ":1: error: no legacy VTK file"},
        {"a.vtk", "# vtk DataFile Version 3.0\n\nTEXT\n", ":3: error: neither ASCII nor BINARY"},
        {"a.vtk", BINARY "POINTS 1 float128\n", ":5: error: numbers of type 'float128', which"},
        {"a.vtk", BINARY "POINTS 4000000000 float\n0123456789ab", ":5: error: ends before a coord"},
        {"a.vtk", BINARY "POINTS 1 float\n\x7f\xc0\1\1\1\1\1\1\1\1\1\1",
         ":5: error: a coordinate is not finite"},
        {"a.vtk", BINARY "FIELD f 1\na 9007199254740991 9007199254740991 double\n01234567",
         ":6: error: ends before a value"},
        {"a.vtk", BINARY "FIELD f 1\na 4 9007199254740991 bit\n0", ":6: error: ends before a v"},
        {"a.vtk", BINARY "FIELD f 1\na 1 9 string\n\x3f\xff\xff\xff\xff\xff\xff\xff",
         ":6: error: ends before a string"},
        {"a.vtk", "# vtk DataFile Version 3.0\n\nASCII\nDATASET STRUCTURED_POINTS\n",
         ":4: error: dataset STRUCTURED_POINTS has no faces"},
        {"a.vtk", POLYDATA "POINTS 4000000000 float\n0 0 0\n", ":6: error: ends before a coord"},
        {"a.vtk", POLYDATA "POINTS 1 float\n0 0 nan\n", ":6: error: 'nan' where a coordinate"},
        {"a.vtk", POLYDATA "POINTS 1 float\n0 0 0\nPOLYGONS 1 4\n3 0 0 1\n",
         ":8: error: a cell names point 1, but there are 1"},
        {"a.vtk", POLYDATA "POLYGONS 1 4\n4 0 0 0 0\n", ":6: error: cell 0 goes beyond the 4"},
        {"a.vtk", POLYDATA "POLYGONS 1 3\n2 0 0\n", ":6: error: a cell of type 7 has 2 points"},
        {"a.vtk", POLYDATA "QUADS 1 5\n", ":5: error: 'QUADS' is no part"},
        {"a.vtk",
         "# vtk DataFile Version 5.1\n\nASCII\nDATASET POLYDATA\nPOLYGONS 3 4\nOFFSETS t\n0 3 2\n",
         ":7: error: offset 2 is less"},
        {"a.vtk",
         "# vtk DataFile Version 3.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 1 float\n0 0 0\n"
         "CELLS 1 5\n4 0 0 0 0\nCELL_TYPES 1\n10\n",
         ":8: error: there are volumes in it and no face"},
        {"a.vtu", "<x/>\n", ":1: error: <x> before <VTKFile>"},
        {"a.vtu", "\n<VTKFile type='ImageData'/>\n", ":2: error: VTK data of type 'ImageData'"},
        {"a.vtu", "<VTKFile type='PolyData' compressor='vtkLZ4DataCompressor'/>",
         ":1: error: the file is compressed by vtkLZ4DataCompressor"},
        /* 2^32 - 1 blocks; one of 2^32 - 1 bytes made of 4; of 4 made of 4 that are none; one cut
         */
        {"a.vtu", ZLIB "/////wAAAAAAAAAA</DataArray>", ":2: error: the blocks of a compressed"},
        {"a.vtu", ZLIB "AQAAAP////8AAAAABAAAAAAAAAA=</DataArray>", ":2: error: the blocks of"},
        {"a.vtu", ZLIB "AQAAAAQAAAAAAAAABAAAAAAAAAA=</DataArray>", ":2: error: the blocks of"},
        {"a.vtu", ZLIB "AQAAAAQAAAAAAAAABAAAAAA=</DataArray>", ":2: error: the blocks of"},
        {"a.vtu", ZLIB "AQAA</DataArray>", ":2: error: an array is no base64"},
        {"a.vtu", GRID "<Points>\n", ":3: error: not well-formed XML"},
        {"a.vtu", GRID "<Points><DataArray format='binhex'/>", ":2: error: an array of format"},
        {"a.vtu", GRID "<Points><DataArray format='appended' offset='7'/>",
         ":2: error: an appended array of offset 7 is not all there"},
        {"a.vtu", APPENDED("-1", "raw") "_\4\1\1\1abcd" BEHIND, ":2: error: an appended array"},
        {"a.vtu", APPENDED("9", "raw") "_\4\1\1\1abcd" BEHIND, ":2: error: an appended array"},
        {"a.vtu", APPENDED("0", "raw") "_\4\1\1\1abcd" BEHIND, ":2: error: an appended array"},
        {"a.vtu", APPENDED("0", "base64") "_BAAAA" BEHIND, ":2: error: an appended array"},
        {"a.vtu", APPENDED("0", "base64") "_/////w==AAAA" BEHIND, ":2: error: an appended arr"},
        {"a.vtu", APPENDED("0", "base64") "_BAAA*A==AAAA" BEHIND, ":2: error: an appended arr"},
        {"a.vtu", APPENDED("0", "raw") "abcd" BEHIND, "error: <AppendedData> does not begin with"},
        {"a.vtu", APPENDED("0", "raw") "_abcd", "error: <AppendedData> does not begin with"},
        {"a.vtu", GRID "<Points><DataArray>1 2\n 3x</DataArray>", ":2: error: '3x' is not a num"},
        {"a.vtu", GRID "<Points><DataArray>1 2</DataArray></Points></Piece>",
         ":2: error: points have 2 numbers"},
        {"a.vtu", GRID "<Points><DataArray type='Float32' format='binary'>AAAAA</DataArray>",
         ":2: error: an array is no base64"},
        {"a.vtu", GRID "<Points><DataArray type='Float32' format='binary'>////fwAA</DataArray>",
         ":2: error: an array counts 2147483647 bytes of type Float32 and has 2"},
        {"a.vtu", GRID "<Cells><DataArray Name='offsets'>3</DataArray></Cells></Piece>",
         "0 types of 1 cells"},
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

/* Of five bytes four are left, though there are as many in all. */
START_TEST(test_appended_past_its_end)
{
    text.size = 0;
    put(APPENDED("4", "raw") "_abcd\5%c%c%cefgh" BEHIND, 0, 0, 0);
    write_text("past.vtp");
    const char *said = refusal(in_folder("past.vtp"));
    ck_assert_msg(strstr(said, ":2: error: an appended array of offset 4 is not all"), "%s", said);
}
END_TEST

#define TRIANGLE "F 3\nV 1 0 0 0\nV 2 1 0 0\nV 3 0 1 0\nS 1 1 2 3 0 0 0 .5 a\n"

/* What is read, though something is odd about it: a line that says so, besides that of all meshes,
 * that their faces are grey. */
START_TEST(test_warnings)
{
    static const struct {
        const char *name, *content, *said;
    } cases[] = {
        {"a.vs3", TRIANGLE "End\n", NULL},
        {"a.vs3", TRIANGLE "*\n", NULL},
        {"a.vs3", TRIANGLE, ":5: warning: ends without E or *"},
        {"a.vs3", TRIANGLE "O 2 1 3 2 0 b\nO 3 1 3 2 0\nE\n",
         ":6: warning: 2 obstructions are black surfaces, with rows"},
        {"a.bdf",
         "BEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\n"
         "CTRIA3,1,1,1,2,3\n",
         ":5: warning: ends without ENDDATA"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        text.size = 0;
        put("%s", cases[i].content);
        write_text(cases[i].name);
        const char *said = said_of(in_folder(cases[i].name), &(struct scene_options){0}, 0);
        int lines = 0;
        for (const char *c = said; *c; c++)
            lines += *c == '\n';
        ck_assert_msg(lines == (cases[i].said ? 2 : 1), "%zu: %s", i, said);
        ck_assert_msg(!cases[i].said || strstr(said, cases[i].said), "%zu: %s", i, said);
    }
}
END_TEST

int main(void)
{
    if (folder_make("mesh_refusals") < 0)
        return EXIT_FAILURE;
    Suite *suite = suite_create("mesh_refusals");
    TCase *t = tcase_create("mesh_refusals");
    tcase_add_test(t, test_refusals);
    tcase_add_test(t, test_appended_past_its_end);
    tcase_add_test(t, test_warnings);
    suite_add_tcase(suite, t);
    int failed = suite_failures(suite);
    folder_remove();
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
