/* export_assimp.c - see export_assimp.h.
 *
 * Assimp may write several files (.gltf and .bin). Its file callbacks lead to atomic files, which
 * are committed together when all are complete.
 * SPDX-License-Identifier: MIT */
#include "output/export_assimp.h"

#include <stdlib.h>
#include <string.h>

#include <assimp/cexport.h>
#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/material.h>
#include <assimp/scene.h>

#include "util/atomic_file.h"
#include "util/report.h"
#include "util/temporary.h"

enum { FILES_MAX = 4 };

struct written_file {
    struct aiFile file; /* first, so that the one is the other */
    struct atomic_file out;
};

struct written_files {
    struct written_file slot[FILES_MAX];
    int count, failed;
};

static FILE *stream(struct aiFile *file)
{
    return ((struct written_file *)(void *)file)->out.stream;
}

static size_t read_file(struct aiFile *file, char *data, size_t size, size_t count)
{
    (void)file, (void)data, (void)size, (void)count;
    return 0;
}

static size_t write_file(struct aiFile *file, const char *data, size_t size, size_t count)
{
    return fwrite(data, size, count, stream(file)); /* atomic_commit asks for errors */
}

static size_t tell_file(struct aiFile *file)
{
    long at = ftell(stream(file));
    return at < 0 ? 0 : (size_t)at;
}

static enum aiReturn seek_file(struct aiFile *file, size_t offset, enum aiOrigin origin)
{
    int from = origin == aiOrigin_SET ? SEEK_SET : origin == aiOrigin_CUR ? SEEK_CUR : SEEK_END;
    return fseek(stream(file), (long)offset, from) ? aiReturn_FAILURE : aiReturn_SUCCESS;
}

static size_t size_file(struct aiFile *file)
{
    long at = ftell(stream(file));
    fseek(stream(file), 0, SEEK_END);
    long end = ftell(stream(file));
    fseek(stream(file), at, SEEK_SET);
    return end < 0 ? 0 : (size_t)end;
}

static void flush_file(struct aiFile *file)
{
    (void)file;
}

static struct aiFile *open_file(struct aiFileIO *io, const char *path, const char *mode)
{
    struct written_files *files = (struct written_files *)(void *)io->UserData;
    if (!strchr(mode, 'w'))
        return NULL;
    if (files->count == FILES_MAX || atomic_open(&files->slot[files->count].out, path)) {
        files->failed = 1;
        return NULL;
    }
    struct aiFile *file = &files->slot[files->count++].file;
    file->ReadProc = read_file;
    file->WriteProc = write_file;
    file->TellProc = tell_file;
    file->FileSizeProc = size_file;
    file->SeekProc = seek_file;
    file->FlushProc = flush_file;
    return file;
}

static void close_file(struct aiFileIO *io, struct aiFile *file)
{
    (void)io, (void)file; /* open until the export is known to have worked */
}

/* One vertex per corner, for Assimp 5.2 writes beyond its arrays when it has to part shared
 * vertices of polygons itself. It joins equal ones again where the format wants it. */
static int fill_mesh(struct aiMesh *to, const struct leaf_mesh *mesh,
                     const struct vertex_values *values, const float *colour, unsigned int *index)
{
    to->mNumVertices = mesh->corners;
    to->mNumFaces = mesh->polygons;
    to->mVertices = malloc(((size_t)mesh->corners + 1) * sizeof *to->mVertices);
    to->mColors[0] = malloc(((size_t)mesh->corners + 1) * sizeof *to->mColors[0]);
    to->mFaces = malloc(((size_t)mesh->polygons + 1) * sizeof *to->mFaces);
    if (!to->mVertices || !to->mColors[0] || !to->mFaces || !index)
        return -1;
    for (uint32_t i = 0; i < mesh->corners; i++) {
        const double *p = values->vertices[mesh->corner[i]].position;
        const float *c = &colour[3 * (size_t)mesh->corner[i]];
        to->mVertices[i] = (struct aiVector3D){(float)p[0], (float)p[1], (float)p[2]};
        to->mColors[0][i] = (struct aiColor4D){c[0], c[1], c[2], 1};
        index[i] = i;
    }
    for (uint32_t i = 0; i < mesh->polygons; i++) {
        to->mFaces[i].mNumIndices = mesh->start[i + 1] - mesh->start[i];
        to->mFaces[i].mIndices = &index[mesh->start[i]]; /* borrowed: Assimp copies the scene */
        to->mPrimitiveTypes |=
            to->mFaces[i].mNumIndices > 3 ? aiPrimitiveType_POLYGON : aiPrimitiveType_TRIANGLE;
    }
    return 0;
}

static struct aiMaterialProperty property(const char *key, enum aiPropertyTypeInfo type,
                                          const void *data, unsigned int size)
{
    struct aiMaterialProperty p = {
        .mType = type, .mDataLength = size, .mData = (char *)(uintptr_t)data};
    p.mKey.length = (ai_uint32)strlen(key);
    memcpy(p.mKey.data, key, p.mKey.length + 1);
    return p;
}

int export_assimp(const char *path, const char *id, int z_up, const struct leaf_mesh *mesh,
                  const struct vertex_values *values, const float *colour)
{
    /* A white material that no light changes: what shows is the vertices' colours. */
    static const float white[4] = {1, 1, 1, 1};
    static const struct {
        ai_uint32 length;
        char text[12];
    } name = {9, "radiosity"};
    const int unlit = aiShadingMode_Unlit;
    struct aiMaterialProperty properties[4] = {
        property("?mat.name", aiPTI_String, &name, sizeof name.length + name.length + 1),
        property("$clr.diffuse", aiPTI_Float, white, sizeof white),
        property("$clr.base", aiPTI_Float, white, sizeof white),
        /* Assimp's own writer keeps enumerations as bytes, and its reader of them wants that. */
        property("$mat.shadingm", aiPTI_Buffer, &unlit, sizeof unlit),
    };
    struct aiMaterialProperty *property_list[4] = {&properties[0], &properties[1], &properties[2],
                                                   &properties[3]};
    struct aiMaterial material = {
        .mProperties = property_list, .mNumProperties = 4, .mNumAllocated = 4};
    struct aiMaterial *materials[1] = {&material};
    struct aiMesh *shape = calloc(1, sizeof *shape), *shapes[1] = {shape};
    struct aiNode *node = calloc(1, sizeof *node);
    struct aiScene *scene = calloc(1, sizeof *scene);
    struct written_files *files = calloc(1, sizeof *files);
    unsigned int first = 0, *index = malloc(((size_t)mesh->corners + 1) * sizeof *index);
    int result = -1;
    if (!shape || !node || !scene || !files || fill_mesh(shape, mesh, values, colour, index)) {
        report_error(path, 0, "out of memory for the mesh; write .ply, which needs less");
    } else {
        aiIdentityMatrix4(&node->mTransformation);
        if (z_up) /* to y up: (x, y, z) becomes (x, z, -y) */
            node->mTransformation =
                (struct aiMatrix4x4){1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1};
        node->mNumMeshes = 1;
        node->mMeshes = &first;
        scene->mRootNode = node;
        scene->mNumMeshes = 1;
        scene->mMeshes = shapes;
        scene->mNumMaterials = 1;
        scene->mMaterials = materials;
        struct aiFileIO io = {open_file, close_file, (aiUserData)(void *)files};
        result =
            aiExportSceneEx(scene, id, path, &io, 0) == aiReturn_SUCCESS && !files->failed ? 0 : -1;
        if (result && !files->failed)
            report_error(path, 0, "cannot be written: %s; write .ply instead", aiGetErrorString());
    }
    temporary_lock(); /* a signal takes both or none */
    for (int i = 0; files && i < files->count; i++) {
        if (result)
            atomic_discard(&files->slot[i].out);
        else
            result = atomic_commit(&files->slot[i].out);
    }
    temporary_unlock();
    if (shape) {
        free(shape->mVertices);
        free(shape->mColors[0]);
        free(shape->mFaces);
    }
    free(index);
    free(shape);
    free(node);
    free(scene);
    free(files);
    return result;
}
