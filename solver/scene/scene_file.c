/* scene_file.c - see scene_file.h.
 * SPDX-License-Identifier: MIT */
#include "scene/scene_file.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "scene/gltf_materials.h"
#include "scene/other_formats.h"
#include "scene/read_assimp.h"
#include "scene/read_meshes.h"
#include "scene/read_obj.h"
#include "scene/read_shapes.h"
#include "util/array.h"
#include "util/ends_with.h"
#include "util/report.h"
#include "util/text_file.h"

int scene_file_no_memory(const char *path)
{
    return report_error(path, 0, "out of memory; use a smaller scene or a larger machine");
}

int scene_file_add_position(struct scene_file *f, const double position[3])
{
    if (f->position_count == UINT32_MAX
        || array_reserve(&f->positions, (size_t)f->position_count + 1, &f->position_capacity,
                         3 * sizeof *f->positions)
               < 0)
        return -1;
    memcpy(&f->positions[3 * f->position_count++], position, 3 * sizeof *position);
    return 0;
}

int scene_file_add_corner(struct scene_file *f, uint32_t position)
{
    if (array_reserve(&f->indices, f->index_count + 1, &f->index_capacity, sizeof *f->indices) < 0)
        return -1;
    f->indices[f->index_count++] = position;
    return 0;
}

int scene_file_add_polygon(struct scene_file *f, uint32_t size, uint32_t material, uint32_t line)
{
    uint32_t n = f->polygon_count;
    if (n == UINT32_MAX
        || array_reserve_beside(&f->sizes, (size_t)n + 1, f->polygon_capacity, sizeof *f->sizes) < 0
        || array_reserve_beside(&f->polygon_materials, (size_t)n + 1, f->polygon_capacity,
                                sizeof *f->polygon_materials)
               < 0
        || array_reserve(&f->lines, (size_t)n + 1, &f->polygon_capacity, sizeof *f->lines) < 0
        || part_names_add(&f->groups, n) || part_names_add(&f->objects, n))
        return -1;
    f->sizes[n] = size;
    f->polygon_materials[n] = material;
    f->lines[n] = line;
    f->polygon_count++;
    return 0;
}

int scene_file_use_group(struct scene_file *f, const char *name, size_t length)
{
    return part_names_use(&f->groups, name, length, f->polygon_count);
}

int scene_file_use_object(struct scene_file *f, const char *name, size_t length)
{
    return part_names_use(&f->objects, name, length, f->polygon_count);
}

int scene_file_add_material(struct scene_file *f, const char *name,
                            const struct RadMaterial *material)
{
    uint32_t n = f->material_count;
    if (n == UINT32_MAX
        || array_reserve_beside(&f->materials, (size_t)n + 1, f->material_capacity,
                                sizeof *f->materials)
               < 0
        || array_reserve_beside(&f->names, (size_t)n + 1, f->material_capacity, sizeof *f->names)
               < 0
        || array_reserve(&f->places, (size_t)n + 1, &f->material_capacity, sizeof *f->places) < 0)
        return -1;
    f->names[n] = strdup(name);
    if (!f->names[n])
        return -1;
    f->materials[n] = *material;
    f->places[n] = (struct material_place){0};
    f->material_count++;
    return 0;
}

/* of the scene's extent. Coarser rounding of coordinates is told; chosen: with 1e-5, what is a
 * hundredth as long as the scene is known to a thousandth */
static const double ROUNDING_TOLD = 1e-5;

typedef int read_shape_fn(struct scene_file *file, const char *path, char *text, size_t size,
                          int quiet);

/* Formats of shape alone, and those that name groups of faces or their emittances. */
struct shape_format {
    const char *ending;
    read_shape_fn *read;
    enum { ALL_GREY, NAMED, EMITTANCES } materials;
};

static const struct shape_format *shape_format(const char *path)
{
    static const struct shape_format formats[] = {
        {".ply", read_ply, ALL_GREY},     {".stl", read_stl, ALL_GREY},
        {".off", read_off, ALL_GREY},     {".msh", read_gmsh, NAMED},
        {".vtk", read_vtk, ALL_GREY},     {".vtu", read_vtk_xml, ALL_GREY},
        {".vtp", read_vtk_xml, ALL_GREY}, {".bdf", read_nastran, NAMED},
        {".nas", read_nastran, NAMED},    {".dat", read_nastran, NAMED},
        {".vs3", read_vs3, EMITTANCES},
    };
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        if (ends_with_any_case(path, formats[i].ending))
            return &formats[i];
    return NULL;
}

static int read_shape(struct scene_file *f, const char *path, const struct shape_format *format,
                      int quiet)
{
    static const char *const told[] = {
        "this format holds no materials: every face reflects 0.5 and none emits",
        "this format names materials and no more: every face reflects 0.5 and none emits",
        "faces reflect what they do not emit as grey bodies; none shines by itself"};
    const struct RadMaterial grey = {.reflectance = {0.5, 0.5, 0.5}};
    size_t size;
    char *text = text_file_need(path, &size);
    if (!text)
        return -1;
    int result =
        format->materials == ALL_GREY && scene_file_add_material(f, "DefaultMaterial", &grey)
            ? scene_file_no_memory(path)
            : format->read(f, path, text, size, quiet);
    free(text);
    if (!result && !quiet)
        report_warning(path, 0, "%s", told[format->materials]);
    return result;
}

static void dim_white(struct scene_file *f)
{
    for (uint32_t i = 0; i < f->material_count; i++)
        for (int k = 0; k < 3; k++) {
            double *reflectance = &f->materials[i].reflectance[k];
            if (*reflectance == 1)
                *reflectance = nextafter(1, 0);
        }
}

/* Materials that no polygon has may be anything. */
static int check_materials(const struct scene_file *f, const char *path)
{
    uint8_t *used = calloc((size_t)f->material_count + 1, 1);
    int result = used ? 0 : scene_file_no_memory(path);
    for (uint32_t i = 0; i < f->polygon_count && used; i++)
        used[f->polygon_materials[i]] = 1;
    for (uint32_t i = 0; i < f->material_count && !result; i++) {
        const struct RadMaterial *m = &f->materials[i];
        const struct material_place *where = &f->places[i];
        const char *file = where->file ? where->file : path;
        for (int k = 0; k < 3 && used[i] && !result; k++) {
            if (!(m->reflectance[k] >= 0 && m->reflectance[k] < 1))
                result = report_error(file, where->diffuse_line,
                                      "material '%s' has reflectance %g; the diffuse colour must "
                                      "be 0 or more and below 1",
                                      f->names[i], m->reflectance[k]);
            else if (!(m->exitance[k] >= 0 && m->exitance[k] <= (double)FLT_MAX))
                result = report_error(file, where->emissive_line,
                                      "material '%s' has exitance %g W/m2; the emissive colour "
                                      "must be 0 or more and finite, 3.4e38 at most",
                                      f->names[i], m->exitance[k]);
        }
    }
    free(used);
    return result;
}

/* What coordinates are rounded to (m), if that is more than a scene can bear; then how far they
 * are and how wide it is. */
static double rounding_told(const struct scene_file *f, double *far, double *extent)
{
    double low[3] = {DBL_MAX, DBL_MAX, DBL_MAX}, high[3] = {-DBL_MAX, -DBL_MAX, -DBL_MAX};
    *far = *extent = 0;
    for (size_t i = 0; i < f->position_count; i++)
        for (int k = 0; k < 3; k++) {
            double x = f->positions[3 * i + (size_t)k];
            low[k] = fmin(low[k], x);
            high[k] = fmax(high[k], x);
            *far = fmax(*far, fabs(x));
        }
    for (int k = 0; k < 3 && f->position_count; k++)
        *extent = fmax(*extent, high[k] - low[k]);
    double rounding = *far * FLT_EPSILON;
    return f->single_precision && rounding > ROUNDING_TOLD * *extent ? rounding : 0;
}

/* Nothing brings back what floats have lost. */
static void warn_of_rounding(const struct scene_file *f, const char *path)
{
    double far, extent, rounding = rounding_told(f, &far, &extent);
    if (rounding > 0)
        report_warning(path, 0,
                       "coordinates are floats up to %.3g m, rounded to %.2g m, of a scene of %.3g "
                       "m: move it to the origin before it is exported, or export double PLY or "
                       "OBJ",
                       far, rounding, extent);
}

int scene_file_check_rounding(const struct scene_file *f, const char *path,
                              const struct RadSceneReport *r)
{
    double far, extent, rounding = rounding_told(f, &far, &extent);
    if (!(rounding > 0) || r->dropped <= r->polygons / 2)
        return 0;
    return report_error(path, 0,
                        "%lu of %lu faces have no area left: coordinates are floats up to %.3g m, "
                        "rounded to %.2g m; move the scene to the origin before it is exported, "
                        "or export double PLY or OBJ",
                        (unsigned long)r->dropped, (unsigned long)r->polygons, far, rounding);
}

/* A room that such light fills where the file was made is dark here. */
static void warn_of_lights(const struct scene_file *f, const char *path)
{
    if (f->lights)
        report_warning(path, 0,
                       "lights without a surface, as points and suns, are passed over: faces emit, "
                       "by the emissive colour of their material (%lu lights)",
                       (unsigned long)f->lights);
}

int scene_file_read(struct scene_file *f, const char *path, const struct scene_options *options)
{
    const int gltf = ends_with_any_case(path, ".gltf") || ends_with_any_case(path, ".glb");
    const struct scene_options none = {0};
    options = options ? options : &none;
    struct stat status;
    *f = (struct scene_file){0};
    if (stat(path, &status))
        return report_error(path, 0, "cannot read: %s; check the name", strerror(errno));
    if (S_ISDIR(status.st_mode))
        return report_error(path, 0, "this is a folder; name a scene file in it");
    if (!S_ISREG(status.st_mode))
        return report_error(path, 0,
                            "cannot read: this is a pipe or a device; write the scene to a file");
    const struct shape_format *shape = shape_format(path);
    if (other_formats_refuse(path) || (gltf && gltf_check_extensions(path)))
        return -1;
    int result = shape                              ? read_shape(f, path, shape, options->quiet)
                 : ends_with_any_case(path, ".obj") ? read_obj(f, path, options->quiet)
                                                    : read_assimp(f, path);
    if (!result && gltf)
        result = gltf_materials(f, path, options->quiet);
    if (!result) {
        for (uint32_t i = 0; i < f->material_count; i++)
            f->materials[i].two_sided |= options->two_sided || ends_with(f->names[i], "_2s");
        if (options->factors_alone)
            dim_white(f);
        result = check_materials(f, path);
    }
    if (!result && !options->quiet) {
        warn_of_rounding(f, path);
        warn_of_lights(f, path);
    }
    if (result)
        scene_file_free(f);
    return result;
}

void scene_file_free(struct scene_file *f)
{
    for (uint32_t i = 0; i < f->material_count; i++) {
        free(f->names[i]);
        free(f->places[i].file);
    }
    free(f->positions);
    free(f->indices);
    free(f->sizes);
    free(f->polygon_materials);
    free(f->lines);
    free(f->materials);
    free(f->names);
    free(f->places);
    part_names_free(&f->groups);
    part_names_free(&f->objects);
    *f = (struct scene_file){0};
}

void scene_file_forget_places(struct scene_file *f)
{
    free(f->positions);
    free(f->indices);
    f->positions = NULL;
    f->indices = NULL;
    f->position_count = 0;
    f->index_count = 0;
}

struct RadPolygons scene_file_polygons(const struct scene_file *f)
{
    return (struct RadPolygons){
        .positions = f->positions,
        .position_count = f->position_count,
        .indices = f->indices,
        .sizes = f->sizes,
        .materials = f->polygon_materials,
        .count = f->polygon_count,
        .single_precision = f->single_precision,
    };
}

/* "face 7 (line 12)" */
static const char *face_name(const struct scene_file *f, uint32_t face, char name[48])
{
    int n = snprintf(name, 48, "face %lu", (unsigned long)face);
    if (f->lines[face])
        snprintf(name + n, 48 - (size_t)n, " (line %lu)", (unsigned long)f->lines[face]);
    return name;
}

static void warn_of_overlaps(const struct scene_file *f, const char *path,
                             const struct RadSceneReport *r)
{
    char more[200] = "", name[2][48];
    size_t n = 0;
    for (uint32_t i = 1; i < r->overlaps && i < RAD_OVERLAPS_NAMED; i++)
        n += (size_t)snprintf(more + n, sizeof more - n, "%s%s", i > 1 ? ", " : "; also ",
                              face_name(f, r->overlap[i].polygon, name[0]));
    if (r->overlaps > RAD_OVERLAPS_NAMED)
        snprintf(more + n, sizeof more - n, " and %lu more",
                 (unsigned long)(r->overlaps - RAD_OVERLAPS_NAMED));
    report_warning(path, f->lines[r->overlap[0].polygon],
                   "%s lies on %s in one plane and loses what is covered%s; %.3g m2 in all (where "
                   "faces overlap, one that emits stays, else the first)",
                   face_name(f, r->overlap[0].polygon, name[0]),
                   face_name(f, r->overlap[0].on, name[1]), more, r->overlap_area);
}

/* "what: the first of them by name (why)" */
static void warn_of_turned(const struct scene_file *f, const char *path,
                           const struct RadTurnedPolygons *t, const char *what, const char *why)
{
    char names[RAD_TURNED_NAMED * 50] = "", more[32] = "", name[48];
    size_t n = 0;
    for (uint32_t i = 0; i < t->count && i < RAD_TURNED_NAMED; i++)
        n += (size_t)snprintf(names + n, sizeof names - n, "%s%s", i ? ", " : "",
                              face_name(f, t->polygon[i], name));
    if (t->count > RAD_TURNED_NAMED)
        snprintf(more, sizeof more, " and %lu more", (unsigned long)t->count - RAD_TURNED_NAMED);
    if (t->count)
        report_warning(path, f->lines[t->polygon[0]], "%s: %s%s (%s)", what, names, more, why);
}

void scene_file_warn(const struct scene_file *f, const char *path, const struct RadSceneReport *r,
                     enum RadTurned turned)
{
    char name[48], more[40] = "";
    if (r->overlaps)
        warn_of_overlaps(f, path, r);
    if (r->crossing > 1)
        snprintf(more, sizeof more, " (and %lu more)", (unsigned long)r->crossing - 1);
    if (r->crossing)
        report_warning(path, f->lines[r->crossing_first],
                       "the outline of %s crosses itself%s: it is taken for all that it goes "
                       "round, with one front; check the order of its corners",
                       face_name(f, r->crossing_first, name), more);
    const char *looks = "looks turned, with its back to the light";
    if (turned == RAD_TURNED_FLIP)
        warn_of_turned(f, path, &r->turned_closed, "turned by --flip-closed",
                       "of closed shells, whose other faces are right");
    else
        warn_of_turned(f, path, &r->turned_closed, looks,
                       "of closed shells: --flip-closed turns these");
    warn_of_turned(f, path, &r->turned_open, looks,
                   "against the faces that it shares edges with: reverse the order of corners");
    if (r->dropped || f->other)
        report_warning(path, 0,
                       "%u degenerate faces dropped (no area, or fewer than three corners), %u "
                       "points and lines ignored",
                       (unsigned)r->dropped, (unsigned)f->other);
}
