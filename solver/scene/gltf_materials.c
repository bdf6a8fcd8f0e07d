/* gltf_materials.c - see gltf_materials.h.
 *
 * The library hands materials on in the order of their use, and not all: they are found again by
 * name and colours. Where two that look alike differ in strength, the file is refused.
 * [Khronos 2021, glTF 2.0 Specification, 4.4 GLB; 2022, KHR_materials_emissive_strength]
 * SPDX-License-Identifier: MIT */
#include "scene/gltf_materials.h"

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
static json_t *read_json(const char *path, int quiet)
{
    size_t size;
    char *text = (quiet ? text_file_read : text_file_need)(path, &size);
    if (!text)
        return NULL;
    const char *from = text;
    if (size >= 20 && memcmp(text, "glTF", 4) == 0) {
        uint32_t length = (uint32_t)bytes_number(text + 12, 4, 0);
        size = length <= size - 20 ? length : 0;
        from += 20;
    }
    json_error_t error;
    json_t *root = json_loadb(from, size, JSON_DISABLE_EOF_CHECK, &error);
    if (!root && !quiet)
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

/* Does light pass through it? */
static int is_transparent(const json_t *material)
{
    const char *mode = json_string_value(json_object_get(material, "alphaMode"));
    const json_t *pbr = json_object_get(material, "pbrMetallicRoughness"),
                 *passes = json_object_get(json_object_get(json_object_get(material, "extensions"),
                                                           "KHR_materials_transmission"),
                                           "transmissionFactor");
    return (mode && strcmp(mode, "BLEND") == 0
            && number(json_object_get(pbr, "baseColorFactor"), 3, 1) < 1)
           || json_number_value(passes) > 0;
}

/* What is in the file's materials and not in ours. */
static void warn_of_materials(const char *path, const json_t *materials)
{
    unsigned textured = 0, transparent = 0;
    for (size_t i = 0; i < json_array_size(materials); i++) {
        textured += has_texture(json_array_get(materials, i)) != 0;
        transparent += is_transparent(json_array_get(materials, i)) != 0;
    }
    if (textured)
        report_warning(path, 0, "textures are passed over; the factors of materials hold");
    if (transparent)
        report_warning(path, 0, "transparent materials are taken as opaque (%u materials)",
                       transparent);
}

/* What says nothing of shapes, or what the library reads or refuses itself (Draco). */
static int is_harmless(const char *extension)
{
    static const char *const begins[] = {"KHR_materials_", "KHR_texture_", "EXT_texture_",
                                         "MSFT_texture_",  "KHR_lights_",  "KHR_draco_mesh_"};
    for (size_t i = 0; i < sizeof begins / sizeof *begins; i++)
        if (strncmp(extension, begins[i], strlen(begins[i])) == 0)
            return 1;
    return 0;
}

int gltf_check_extensions(const char *path)
{
    json_t *root = read_json(path, 1), *name;
    const char *refused = NULL;
    size_t i;
    if (!root) /* the library says what is wrong with it */
        return 0;
    json_array_foreach(json_object_get(root, "extensionsRequired"), i, name)
    {
        if (json_is_string(name) && !is_harmless(json_string_value(name)))
            refused = json_string_value(name);
    }
    json_array_foreach(json_object_get(root, "extensionsUsed"), i, name)
    {
        /* whoever does not know it sees one copy of many */
        if (json_is_string(name) && strcmp(json_string_value(name), "EXT_mesh_gpu_instancing") == 0)
            refused = json_string_value(name);
    }
    if (refused)
        report_error(path, 0, "it needs %.64s, which is not read; export it without", refused);
    json_decref(root);
    return refused ? -1 : 0;
}

int gltf_materials(struct scene_file *f, const char *path, int quiet)
{
    json_t *root = read_json(path, 0);
    if (!root)
        return -1;
    const json_t *materials = json_object_get(root, "materials");
    int result = 0;
    replace_default(f, path, quiet);
    for (uint32_t i = 0; i < f->material_count && !result; i++)
        if (!material_name_read(f->names[i], &f->materials[i]))
            result = apply_strength(f, path, materials, i);
    if (!quiet && !result)
        warn_of_materials(path, materials);
    json_decref(root);
    return result;
}
