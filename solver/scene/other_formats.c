/* other_formats.c - see other_formats.h.
 *
 * Only endings that the import library takes for nothing of its own, or for what it is not.
 * [Gmsh reference manual, 9: formats; meshio 5, README]
 * SPDX-License-Identifier: MIT */
#include "scene/other_formats.h"

#include "util/ends_with.h"
#include "util/report.h"

static const char PARTS[] = "it names other files, of pieces or blocks; open it in ParaView, Merge "
                            "Blocks, Extract Surface, and save as .vtp",
                  MESH[] = "a mesh of another kind; convert it: meshio convert OLD NEW.vtu",
                  BY_GMSH[] =
                      "a mesh of another kind; convert it: gmsh -0 -format msh22 -o NEW.msh "
                      "OLD",
                  SHAPE[] = "a shape that has no mesh yet; make one: gmsh -2 -format msh22 -o "
                            "NEW.msh OLD";

int other_formats_refuse(const char *path)
{
    static const struct {
        const char *ending, *advice;
    } formats[] = {
        {".pvtu", PARTS},   {".pvtp", PARTS}, {".pvd", PARTS},   {".vtm", PARTS},
        {".vtmb", PARTS},   {".inp", MESH},   {".exo", MESH},    {".e", MESH},
        {".xdmf", MESH},    {".su2", MESH},   {".unv", BY_GMSH}, {".med", BY_GMSH},
        {".cgns", BY_GMSH}, {".step", SHAPE}, {".stp", SHAPE},   {".igs", SHAPE},
        {".iges", SHAPE},   {".brep", SHAPE}, {".geo", SHAPE},
    };
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        if (ends_with_any_case(path, formats[i].ending))
            return report_error(path, 0, "%s", formats[i].advice);
    return 0;
}
