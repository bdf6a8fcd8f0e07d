/* gltf_materials.h - what glTF files say of materials and the import library does not hand on.
 *
 * The strength of emission (KHR_materials_emissive_strength); faces without a material, which are
 * grey; and meshes that this program wrote (util/material_name.h).
 * SPDX-License-Identifier: MIT */
#ifndef GLTF_MATERIALS_H
#define GLTF_MATERIALS_H

#include "scene/scene_file.h"

/* Refuse a file that needs an extension which changes shapes and which the library passes over
 * without a word, to read numbers as what they are not. Returns 0, or -1 after a message. */
int gltf_check_extensions(const char *path);

/* Mend the materials of a .gltf or .glb file that was read. Returns 0, or -1 after a message. */
int gltf_materials(struct scene_file *file, const char *path, int quiet);

#endif
