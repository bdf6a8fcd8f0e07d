/* export.c - see export.h.
 *
 * PLY is written here because Assimp's writer knows no other vertex properties than its own, and
 * the radiosity would be lost; the others go through Assimp.
 * SPDX-License-Identifier: MIT */
#include "output/export.h"

#include <stdlib.h>
#include <string.h>

#include "output/export_assimp.h"
#include "output/export_xdmf.h"
#include "output/exposure.h"
#include "output/far_away.h"
#include "output/leaf_mesh.h"
#include "util/atomic_file.h"
#include "util/ends_with.h"
#include "util/report.h"

enum export_format export_format(const char *path)
{
    static const struct {
        const char *extension;
        enum export_format format;
    } known[] = {
        {".ply", EXPORT_PLY}, {".gltf", EXPORT_GLTF}, {".glb", EXPORT_GLB},
        {".obj", EXPORT_OBJ}, {".xdmf", EXPORT_XDMF},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (ends_with_any_case(path, known[i].extension))
            return known[i].format;
    return EXPORT_UNKNOWN;
}

/* Expose for the leaves as a picture of all of them would. */
static int measure(const struct solution *s, struct exposure *exposure)
{
    struct meter_sample *meter = malloc(((size_t)s->tree.count + 1) * sizeof *meter);
    size_t count = 0;
    if (!meter)
        return -1;
    for (int lamps = 0; lamps < 2 && !count; lamps++)
        for (uint32_t i = 0; i < s->tree.count; i++) {
            const struct element *e = &s->tree.elements[i];
            if (is_leaf(e) && !e->black && is_lamp(&s->surfaces, e->face) == lamps)
                meter[count++] =
                    (struct meter_sample){luminance(radiosity_of(s, i), s->tree.bands), e->area};
        }
    *exposure = exposure_measure(meter, count);
    free(meter);
    return 0;
}

static void put_bits(FILE *out, uint64_t bits, int size)
{
    unsigned char bytes[8];
    for (int i = 0; i < size; i++)
        bytes[i] = (unsigned char)(bits >> 8 * i);
    fwrite(bytes, 1, (size_t)size, out);
}

static void put_u32(FILE *out, uint32_t value)
{
    put_bits(out, value, 4);
}

static void put_float(FILE *out, double value)
{
    float f = (float)value;
    uint32_t bits;
    memcpy(&bits, &f, sizeof bits);
    put_u32(out, bits);
}

static void put_double(FILE *out, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_bits(out, bits, 8);
}

static void write_ply(FILE *out, const struct leaf_mesh *m, const struct vertex_values *v,
                      const float *colour)
{
    double middle[3];
    void (*const put_coordinate)(FILE *, double) = far_away(v, middle) > 0 ? put_double : put_float;
    const char *type = put_coordinate == put_double ? "double" : "float";
    fprintf(out,
            "ply\nformat binary_little_endian 1.0\n"
            "comment radiosity_K is B of band K in W/m2; red, green, blue show it exposed, sRGB\n"
            "element vertex %u\nproperty %s x\nproperty %s y\nproperty %s z\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\n",
            (unsigned)v->count, type, type, type);
    for (uint32_t k = 0; k < v->bands; k++)
        fprintf(out, "property float radiosity_%u\n", (unsigned)k);
    fprintf(out, "element face %u\nproperty list uint uint vertex_indices\nend_header\n",
            (unsigned)m->polygons);
    for (uint32_t i = 0; i < v->count; i++) {
        for (int k = 0; k < 3; k++)
            put_coordinate(out, v->vertices[i].position[k]);
        for (int k = 0; k < 3; k++)
            putc(srgb_byte((double)colour[3 * (size_t)i + (size_t)k]), out);
        for (uint32_t k = 0; k < v->bands; k++)
            put_float(out, v->value[(size_t)i * v->bands + k]);
    }
    for (uint32_t i = 0; i < m->polygons; i++) {
        put_u32(out, m->start[i + 1] - m->start[i]);
        for (uint32_t j = m->start[i]; j < m->start[i + 1]; j++)
            put_u32(out, m->corner[j]);
    }
}

static int write_format(const char *path, enum export_format format, const struct surfaces *s,
                        struct leaf_mesh *m, const struct vertex_values *v, float *colour)
{
    struct atomic_file file;
    switch (format) {
    case EXPORT_PLY:
        if (atomic_open(&file, path))
            return -1;
        write_ply(file.stream, m, v, colour);
        return atomic_commit(&file);
    case EXPORT_GLTF:
    case EXPORT_GLB:
        if (leaf_mesh_triangulate(m, v))
            return report_error(path, 0,
                                "out of memory for the mesh; write .ply, which needs less");
        return export_assimp(path, format == EXPORT_GLB ? "glb2" : "gltf2", s, m, v, colour);
    case EXPORT_OBJ:
        for (size_t i = 0; i < 3 * (size_t)v->count; i++)
            colour[i] = (float)srgb_byte((double)colour[i]) / 255;
        return export_assimp(path, "obj", s, m, v, colour);
    case EXPORT_XDMF:
    case EXPORT_UNKNOWN:
        break;
    }
    return report_error(path, 0, "unknown format; name it .ply, .gltf, .glb, .obj or .xdmf");
}

/* An OBJ has floats, and no node that could be moved. */
static void warn_far_away(const char *path, const struct vertex_values *v)
{
    double middle[3];
    const double moved = far_away(v, middle);
    if (moved > 0)
        report_warning(path, 0,
                       "single precision moves corners by up to %.2g m, so far from the origin "
                       "they are; write .ply, .glb or .xdmf",
                       moved);
}

int export_write(const char *path, const struct solution *s, const struct vertex_values *v,
                 const double *error)
{
    struct exposure exposure;
    struct leaf_mesh mesh = {0};
    float *colour = malloc((3 * (size_t)v->count + 1) * sizeof *colour);
    int result;
    if (!colour || measure(s, &exposure) || leaf_mesh_build(&mesh, s, v)) {
        result = report_error(path, 0, "out of memory for the mesh; use a coarser solution");
    } else if (export_format(path) == EXPORT_XDMF) {
        result = export_xdmf(path, s, &mesh, v, error);
    } else {
        for (uint32_t i = 0; i < v->count; i++) {
            double c[3];
            exposure_apply(&exposure, &v->value[(size_t)i * v->bands], v->bands, c);
            for (size_t k = 0; k < 3; k++)
                colour[3 * (size_t)i + k] = (float)c[k];
        }
        if (export_format(path) == EXPORT_OBJ && !s->quiet)
            warn_far_away(path, v);
        result = write_format(path, export_format(path), &s->surfaces, &mesh, v, colour);
    }
    leaf_mesh_free(&mesh);
    free(colour);
    return result;
}
