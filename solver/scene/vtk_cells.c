/* vtk_cells.c - see vtk_cells.h.
 * SPDX-License-Identifier: MIT */
#include "scene/vtk_cells.h"

#include "scene/read_numbers.h"
#include "util/report.h"

enum { ANY = -1, NO_FACE = 0, VOLUME = -2, PIXEL = 8 };

/* How many corners a cell of this type has. */
static int corners_of(double type)
{
    if (!is_whole(type, 256))
        return VOLUME;
    switch ((int)type) {
    case VTK_POLYGON:
    case VTK_STRIP:
        return ANY;
    case 5:  /* triangle */
    case 22: /* curved ones */
    case 34:
    case 69:
        return 3;
    case PIXEL:
    case 9: /* quad */
    case 23:
    case 28:
    case 30:
    case 37:
    case 70:
        return 4;
    case 0: /* nothing, points, lines */
    case 1:
    case 2:
    case 3:
    case 4:
    case 21:
    case 35:
    case 68:
        return NO_FACE;
    default:
        return VOLUME;
    }
}

int vtk_wrong_offset(const struct mesh *m, double offset, size_t points, uint32_t line)
{
    return report_error(m->path, line,
                        "offset %g is less than the one before it, or more than the %zu points of "
                        "all cells; the file is damaged, export it again",
                        offset, points);
}

int vtk_wrong_types(const struct mesh *m, size_t types, size_t cells, uint32_t line)
{
    return report_error(m->path, line,
                        "%zu types of %zu cells; the file is damaged, export it again", types,
                        cells);
}

static int add_corner(struct mesh *m, struct vtk_points points, double point, uint32_t line)
{
    if (!is_whole(point, (double)points.count))
        return report_error(m->path, line,
                            "a cell names point %.17g, but there are %zu, counted from 0; the file "
                            "is damaged, export it again",
                            point, points.count);
    return scene_file_add_corner(m->file, (uint32_t)(points.first + (size_t)point))
               ? scene_file_no_memory(m->path)
               : 0;
}

/* Every second triangle is turned, so that all have one front. */
static int add_strip(struct mesh *m, struct vtk_points points, const double *point, size_t size,
                     uint32_t line)
{
    for (size_t i = 0; i + 2 < size; i++)
        if (add_corner(m, points, point[i + i % 2], line)
            || add_corner(m, points, point[i + 1 - i % 2], line)
            || add_corner(m, points, point[i + 2], line) || mesh_polygon(m, 3, 0, line))
            return -1;
    return 0;
}

int vtk_cell(struct mesh *m, struct vtk_points points, double type, const double *point,
             size_t size, uint32_t line)
{
    const int corners = corners_of(type);
    const size_t count = corners == ANY ? size : (size_t)corners;
    if (corners == VOLUME)
        mesh_note(&m->volumes, line);
    m->file->other += corners == NO_FACE;
    if (corners == VOLUME || corners == NO_FACE)
        return 0;
    if (size < 3 || size < count || size > UINT32_MAX)
        return report_error(m->path, line,
                            "a cell of type %g has %zu points; the file is damaged, export it "
                            "again",
                            type, size);
    if (corners != ANY && size > count)
        mesh_note(&m->curved, line);
    if (is_whole(type, 256) && (int)type == VTK_STRIP)
        return add_strip(m, points, point, size, line);
    for (size_t i = 0; i < count; i++) {
        const size_t j = (int)type == PIXEL && i >= 2 ? 5 - i : i; /* a pixel's go row by row */
        if (add_corner(m, points, point[j], line))
            return -1;
    }
    return mesh_polygon(m, (uint32_t)count, 0, line);
}
