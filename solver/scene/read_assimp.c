/* read_assimp.c - see read_assimp.h.
 *
 * Assimp reads with no post-processing, so that faces are those of the file. Invariant: one polygon
 * per face of the file, in the file's order. It runs in a child, which its crashes end.
 * SPDX-License-Identifier: MIT */
#include "scene/read_assimp.h"

#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "scene/import_child.h"
#include "util/assimp_library.h"
#include "util/report.h"

struct reader {
    const struct assimp *assimp;
    struct scene_file *file;
    const char *path;
};

static void read_material(const struct assimp *assimp, const struct aiMaterial *from,
                          struct RadMaterial *to)
{
    struct aiColor4D colour;
    float strength = 1;
    if (assimp->aiGetMaterialColor(from, AI_MATKEY_BASE_COLOR, &colour) == aiReturn_SUCCESS
        || assimp->aiGetMaterialColor(from, AI_MATKEY_COLOR_DIFFUSE, &colour) == aiReturn_SUCCESS) {
        to->reflectance[0] = (double)colour.r;
        to->reflectance[1] = (double)colour.g;
        to->reflectance[2] = (double)colour.b;
    }
    if (assimp->aiGetMaterialColor(from, AI_MATKEY_COLOR_EMISSIVE, &colour) == aiReturn_SUCCESS) {
        assimp->aiGetMaterialFloatArray(from, AI_MATKEY_EMISSIVE_INTENSITY, &strength, NULL);
        to->exitance[0] = (double)colour.r * (double)strength;
        to->exitance[1] = (double)colour.g * (double)strength;
        to->exitance[2] = (double)colour.b * (double)strength;
    }
    int two_sided = 0;
    assimp->aiGetMaterialIntegerArray(from, AI_MATKEY_TWOSIDED, &two_sided, NULL);
    to->two_sided = !!two_sided;
}

/* Its words stay on the line of the message that has them. */
static void to_one_line(char *text)
{
    for (; *text; text++)
        if (*text == '\n' || *text == '\r')
            *text = ' ';
}

static int read_materials(struct reader *r, const struct aiScene *from)
{
    for (uint32_t i = 0; i < from->mNumMaterials; i++) {
        struct RadMaterial material = {0};
        struct aiString name = {0};
        r->assimp->aiGetMaterialString(from->mMaterials[i], AI_MATKEY_NAME, &name);
        to_one_line(name.data);
        read_material(r->assimp, from->mMaterials[i], &material);
        if (scene_file_add_material(r->file, name.length ? name.data : "unnamed", &material))
            return scene_file_no_memory(r->path);
    }
    /* A file without materials still gets one: grey, dark. */
    if (!from->mNumMaterials
        && scene_file_add_material(r->file, "unnamed",
                                   &(struct RadMaterial){.reflectance = {0.5, 0.5, 0.5}}))
        return scene_file_no_memory(r->path);
    return 0;
}

static int read_mesh(struct reader *r, const struct aiMesh *mesh, const struct aiMatrix4x4 *m,
                     int mirrored)
{
    struct scene_file *f = r->file;
    size_t first = f->position_count;
    uint32_t material = mesh->mMaterialIndex < f->material_count ? mesh->mMaterialIndex : 0;
    if (scene_file_use_group(f, mesh->mName.data, mesh->mName.length))
        return scene_file_no_memory(r->path);
    for (uint32_t i = 0; i < mesh->mNumVertices; i++) {
        const struct aiVector3D *v = &mesh->mVertices[i];
        double x = (double)v->x, y = (double)v->y, z = (double)v->z;
        const double p[3] = {m->a1 * x + m->a2 * y + m->a3 * z + m->a4,
                             m->b1 * x + m->b2 * y + m->b3 * z + m->b4,
                             m->c1 * x + m->c2 * y + m->c3 * z + m->c4};
        if (scene_file_add_position(f, p))
            return scene_file_no_memory(r->path);
    }
    for (uint32_t i = 0; i < mesh->mNumFaces; i++) {
        const struct aiFace *from = &mesh->mFaces[i];
        for (uint32_t j = 0; j < from->mNumIndices; j++) {
            uint32_t index = from->mIndices[mirrored ? from->mNumIndices - 1 - j : j];
            if (index >= mesh->mNumVertices)
                return report_error(r->path, 0,
                                    "face %u of mesh '%s' names vertex %u of %u; the file is "
                                    "damaged, export it again",
                                    (unsigned)i, mesh->mName.data, (unsigned)index,
                                    (unsigned)mesh->mNumVertices);
            const double *p = &f->positions[3 * (first + index)];
            if (!isfinite(p[0]) || !isfinite(p[1]) || !isfinite(p[2]))
                return report_error(r->path, 0,
                                    "vertex %u of mesh '%s' is not finite; correct its coordinates",
                                    (unsigned)index, mesh->mName.data);
            if (scene_file_add_corner(f, (uint32_t)(first + index)))
                return scene_file_no_memory(r->path);
        }
        if (scene_file_add_polygon(f, from->mNumIndices, material, 0))
            return scene_file_no_memory(r->path);
    }
    return 0;
}

static int read_node(struct reader *r, const struct aiScene *from, const struct aiNode *node,
                     const struct aiMatrix4x4 *above)
{
    struct aiMatrix4x4 m = *above;
    r->assimp->aiMultiplyMatrix4(&m, &node->mTransformation);
    /* A mirror turns the sense of rotation, hence the front; turn it back. */
    int mirrored = r->assimp->aiMatrix4Determinant(&m) < 0;
    if (node->mNumMeshes && scene_file_use_object(r->file, node->mName.data, node->mName.length))
        return scene_file_no_memory(r->path);
    for (uint32_t i = 0; i < node->mNumMeshes; i++)
        if (node->mMeshes[i] < from->mNumMeshes
            && read_mesh(r, from->mMeshes[node->mMeshes[i]], &m, mirrored))
            return -1;
    for (uint32_t i = 0; i < node->mNumChildren; i++)
        if (read_node(r, from, node->mChildren[i], &m))
            return -1;
    return 0;
}

static int convert(struct reader *r, const struct aiScene *from)
{
    struct aiMatrix4x4 identity;
    r->assimp->aiIdentityMatrix4(&identity);
    r->file->lights = from->mNumLights;
    if (read_materials(r, from) || read_node(r, from, from->mRootNode, &identity))
        return -1;
    return 0;
}

/* A library that aborts says so on standard error, in words that help nobody. */
static const struct aiScene *import_in_silence(const struct assimp *assimp, const char *path)
{
    const int kept = dup(STDERR_FILENO), nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDERR_FILENO);
    const struct aiScene *scene = assimp->aiImportFile(path, 0);
    dup2(kept, STDERR_FILENO);
    close(nowhere);
    close(kept);
    return scene;
}

/* In a process of its own, which ends behind it. */
static int import(struct scene_file *file, const char *path)
{
    struct reader r = {.assimp = assimp_load(path), .file = file, .path = path};
    const struct aiScene *from = import_in_silence(r.assimp, path);
    file->single_precision = sizeof(ai_real) == sizeof(float);
    if (from && from->mRootNode)
        return convert(&r, from);
    const char *cause = r.assimp->aiGetErrorString();
    if (strstr(cause, "bad_alloc") || strstr(cause, "length_error"))
        return IMPORT_MEMORY;
    const char *dot = strrchr(path, '.');
    if (strstr(cause, "No suitable reader") && dot && r.assimp->aiIsExtensionSupported(dot))
        return report_error(
            path, 0,
            "cannot be read as a scene: it is empty or damaged, or not what its name "
            "says; make it anew");
    if (strstr(cause, "No suitable reader"))
        return report_error(path, 0,
                            "cannot be read as a scene: a format that is not known here; check the "
                            "name, radiosity --help tells the formats");
    char words[512];
    snprintf(words, sizeof words, "%s", cause);
    to_one_line(words);
    return report_error(
        path, 0, "cannot be read as a scene: %s; check the format and that the file is whole",
        words);
}

int read_assimp(struct scene_file *file, const char *path)
{
    if (!assimp_load(path)) /* which the child's limits are not for */
        return -1;
    return import_in_child(file, path, import);
}
