/* gltf_materials.c - see gltf_materials.h.
 *
 * The library hands materials on in the order of their use, and not all: they are found again by
 * name and colours. Where two that look alike differ in strength, the file is refused.
 * [Khronos 2021, glTF 2.0 Specification, 4.4 GLB; 2022, KHR_materials_emissive_strength]
 * SPDX-License-Identifier: MIT */
#include "scene/gltf_materials.h"

#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/read_numbers.h"
#include "util/material_name.h"
#include "util/report.h"
#include "util/text_file.h"

/* relative. The library keeps colours as floats */
static const double SAME_COLOUR = 1e-6;

/* The JSON of a file: all of it, or the first chunk of a GLB: 12 bytes, its length, "JSON". */
static json_t *read_json(const char *path)
{
    size_t size;
    char *text = text_file_read(path, &size);
    if (!text) {
        report_error(path, 0, "cannot read: %s; check the name", strerror(errno));
        return NULL;
    }
    const char *from = text;
    if (size >= 20 && memcmp(text, "glTF", 4) == 0) {
        uint32_t length = (uint32_t)bytes_number(text + 12, 4, 0);
        size = length <= size - 20 ? length : 0;
        from += 20;
    }
    json_error_t error;
    json_t *root = json_loadb(from, size, JSON_DISABLE_EOF_CHECK, &error);
    if (!root)
        report_error(path, 0, "its JSON cannot be read: %s; export it again", error.text);
    free(text);
    return root;
}

static double number(const json_t *array, size_t i, double otherwise)
{
    const json_t *value = json_array_get(array, i);
    return json_is_number(value) ? json_number_value(value) : otherwise;
}

static int same(double a, double b)
{
    return fabs(a - b) <= SAME_COLOUR * fmax(fabs(a), fabs(b));
}

/* Is it that material? Its colours are of floats. */
static int looks_like(const json_t *from, const char *name, const struct RadMaterial *m)
{
    const json_t *pbr = json_object_get(from, "pbrMetallicRoughness"),
                 *base = json_object_get(pbr, "baseColorFactor"),
                 *emissive = json_object_get(from, "emissiveFactor");
    const char *own = json_string_value(json_object_get(from, "name"));
    int alike = strcmp(own && *own ? own : "unnamed", name) == 0;
    for (size_t k = 0; k < 3; k++)
        alike &= same(number(base, k, 1), m->reflectance[k])
                 && same(number(emissive, k, 0), m->exitance[k]);
    return alike;
}

static double strength_of(const json_t *from)
{
    const json_t *value = json_object_get(
        json_object_get(json_object_get(from, "extensions"), "KHR_materials_emissive_strength"),
        "emissiveStrength");
    return json_is_number(value) ? json_number_value(value) : 1;
}

static int apply_strength(struct scene_file *f, const char *path, const json_t *materials,
                          uint32_t i)
{
    struct RadMaterial *m = &f->materials[i];
    double strength = 1;
    int found = 0;
    for (size_t j = 0; j < json_array_size(materials); j++) {
        const json_t *from = json_array_get(materials, j);
        if (!looks_like(from, f->names[i], m))
            continue;
        double own = strength_of(from);
        if (found && (own < strength || own > strength))
            return report_error(path, 0,
                                "two materials '%.64s' of one colour emit with strengths %g and "
                                "%g; give them different names",
                                f->names[i], strength, own);
        strength = own;
        found = 1;
    }
    for (int k = 0; k < 3; k++)
        m->exitance[k] *= strength;
    return 0;
}

/* The library puts a white material behind all others, for faces without one. */
static void replace_default(struct scene_file *f, const char *path, int quiet)
{
    uint32_t last = f->material_count - 1;
    struct RadMaterial *m = &f->materials[last];
    int is_default = strcmp(f->names[last], "unnamed") == 0, used = 0;
    for (int k = 0; k < 3; k++)
        is_default &= same(m->reflectance[k], 1) && m->exitance[k] <= 0;
    for (uint32_t i = 0; i < f->polygon_count && is_default; i++)
        used |= f->polygon_materials[i] == last;
    if (!used)
        return;
    for (int k = 0; k < 3; k++)
        m->reflectance[k] = 0.5;
    if (!quiet)
        report_warning(path, 0, "faces without a material reflect 0.5 and do not emit");
}

static int has_texture(const json_t *material)
{
    return json_object_get(json_object_get(material, "pbrMetallicRoughness"), "baseColorTexture")
           || json_object_get(material, "emissiveTexture");
}

int gltf_materials(struct scene_file *f, const char *path, int quiet)
{
    json_t *root = read_json(path);
    if (!root)
        return -1;
    const json_t *materials = json_object_get(root, "materials");
    int result = 0;
    replace_default(f, path, quiet);
    for (uint32_t i = 0; i < f->material_count && !result; i++)
        if (!material_name_read(f->names[i], &f->materials[i]))
            result = apply_strength(f, path, materials, i);
    for (size_t i = 0; i < json_array_size(materials) && !quiet && !result; i++)
        if (has_texture(json_array_get(materials, i))) {
            report_warning(path, 0, "textures are passed over; the factors of materials hold");
            break;
        }
    json_decref(root);
    return result;
}
