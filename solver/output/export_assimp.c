/* export_assimp.c - see export_assimp.h.
 *
 * Assimp may write several files (.gltf and .bin). Its file callbacks lead to atomic files, which
 * are committed together when all are complete.
 * SPDX-License-Identifier: MIT */
#include "output/export_assimp.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "geometry.h"
#include "output/far_away.h"
#include "output/view.h"
#include "util/assimp_library.h"
#include "util/atomic_file.h"
#include "util/ends_with.h"
#include "util/material_name.h"
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

/* Whether a disk, and not Assimp, is why files are not written: Assimp says of it what it likes. */
static int disk_failed(const struct written_files *files)
{
    for (int i = 0; i < files->count; i++)
        if (ferror(files->slot[i].out.stream))
            return 1;
    return 0;
}

static void close_file(struct aiFileIO *io, struct aiFile *file)
{
    (void)io, (void)file; /* open until the export is known to have worked */
}

/* The polygons of one material, with one vertex per corner, for Assimp 5.2 writes beyond its arrays
 * when it has to part shared vertices of polygons itself. It joins equal ones again where the
 * format wants it. */
static int fill_mesh(struct aiMesh *to, const struct leaf_mesh *mesh, uint32_t material,
                     const struct vertex_values *values, const double origin[3],
                     const float *colour, unsigned int *index)
{
    uint32_t corners = 0, polygons = 0;
    for (uint32_t i = 0; i < mesh->polygons; i++)
        if (mesh->material[i] == material) {
            corners += mesh->start[i + 1] - mesh->start[i];
            polygons++;
        }
    to->mVertices = malloc(((size_t)corners + 1) * sizeof *to->mVertices);
    to->mColors[0] = malloc(((size_t)corners + 1) * sizeof *to->mColors[0]);
    to->mFaces = malloc(((size_t)polygons + 1) * sizeof *to->mFaces);
    if (!to->mVertices || !to->mColors[0] || !to->mFaces)
        return -1;
    for (uint32_t i = 0; i < mesh->polygons; i++) {
        if (mesh->material[i] != material)
            continue;
        struct aiFace *face = &to->mFaces[to->mNumFaces++];
        face->mNumIndices = mesh->start[i + 1] - mesh->start[i];
        face->mIndices = &index[to->mNumVertices]; /* borrowed: Assimp copies the scene */
        to->mPrimitiveTypes |=
            face->mNumIndices > 3 ? aiPrimitiveType_POLYGON : aiPrimitiveType_TRIANGLE;
        for (uint32_t j = mesh->start[i]; j < mesh->start[i + 1]; j++) {
            double p[3];
            sub3(p, values->vertices[mesh->corner[j]].position, origin);
            const float *c = &colour[3 * (size_t)mesh->corner[j]];
            to->mVertices[to->mNumVertices] =
                (struct aiVector3D){(float)p[0], (float)p[1], (float)p[2]};
            to->mColors[0][to->mNumVertices++] = (struct aiColor4D){c[0], c[1], c[2], 1};
        }
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

enum { NAME_MOST = 800, PROPERTIES = 5 }; /* bytes of a name: Assimp's strings end at 1024 */

struct text {
    ai_uint32 length;
    char data[1024];
};

struct written_material {
    struct aiMaterial material;
    struct aiMaterialProperty *list[PROPERTIES], property[PROPERTIES];
    struct text name;
    float shown[4], diffuse[4], emissive[4];
};

static const int UNLIT = aiShadingMode_Unlit;

/* The names of materials that look alike must differ in MTL; and both sides of a two-sided face are
 * written, so that none of them is two-sided. */
static int fill_name(struct text *to, const struct surfaces *s, uint32_t i, int obj)
{
    const char *own = s->material_names ? s->material_names[i] : "material";
    int same = !s->material_names || strlen(own) > NAME_MOST || !*own;
    for (uint32_t j = 0; j < i && !same; j++)
        same = strcmp(own, s->material_names[j]) == 0;
    char base[NAME_MOST + 40];
    int length = snprintf(base, sizeof base, "%.*s", NAME_MOST, own);
    if (same)
        length += snprintf(base + length, sizeof base - (size_t)length, " no. %u", (unsigned)i);
    if (ends_with(base, "_2s"))
        snprintf(base + length, sizeof base - (size_t)length, " side");
    char *name = obj ? strdup(base) : material_name_write(base, &s->materials[i]);
    if (!name)
        return -1;
    to->length = (ai_uint32)snprintf(to->data, sizeof to->data, "%s", name);
    free(name);
    return 0;
}

/* MTL has the scene's material. That of glTF is white, and no light changes it: what shows is the
 * vertices' colours. */
static int fill_material(struct written_material *w, const struct surfaces *s, uint32_t i, int obj)
{
    if (fill_name(&w->name, s, i, obj))
        return -1;
    for (int k = 0; k < 4; k++) {
        w->shown[k] = 1;
        w->diffuse[k] = obj && k < 3 ? (float)s->materials[i].reflectance[k] : 1;
        w->emissive[k] = obj && k < 3 ? (float)s->materials[i].exitance[k] : (float)(k == 3);
    }
    w->property[0] = property("?mat.name", aiPTI_String, &w->name,
                              (unsigned int)sizeof w->name.length + w->name.length + 1);
    w->property[1] = property("$clr.diffuse", aiPTI_Float, w->diffuse, sizeof w->diffuse);
    w->property[2] = property("$clr.emissive", aiPTI_Float, w->emissive, sizeof w->emissive);
    w->property[3] = property("$clr.base", aiPTI_Float, w->shown, sizeof w->shown);
    /* Assimp's own writer keeps enumerations as bytes, and its reader of them wants that. */
    w->property[4] = property("$mat.shadingm", aiPTI_Buffer, &UNLIT, sizeof UNLIT);
    for (int k = 0; k < PROPERTIES; k++)
        w->list[k] = &w->property[k];
    w->material = (struct aiMaterial){
        .mProperties = w->list, .mNumProperties = PROPERTIES, .mNumAllocated = PROPERTIES};
    return 0;
}

/* A scene of one mesh per material that is used, all below one node, which moves them by `origin`.
 */
struct written_scene {
    struct aiScene scene;
    struct aiNode node;
    struct aiMesh *shape, **shapes;
    struct written_material *written;
    struct aiMaterial **materials;
    unsigned int *meshes, *index;
};

static int fill_scene(struct written_scene *w, const struct surfaces *s, int obj,
                      const struct leaf_mesh *mesh, const struct vertex_values *values,
                      const double origin[3], const float *colour)
{
    uint32_t most = 0, count = 0, corners = 0;
    for (uint32_t i = 0; i < mesh->polygons; i++)
        most = mesh->material[i] >= most ? mesh->material[i] + 1 : most;
    uint8_t *used = calloc((size_t)most + 1, 1);
    for (uint32_t i = 0; i < mesh->polygons && used; i++) {
        count += !used[mesh->material[i]];
        used[mesh->material[i]] = 1;
    }
    w->shape = calloc((size_t)count + 1, sizeof *w->shape);
    w->shapes = calloc((size_t)count + 1, sizeof *w->shapes);
    w->written = calloc((size_t)count + 1, sizeof *w->written);
    w->materials = calloc((size_t)count + 1, sizeof *w->materials);
    w->meshes = calloc((size_t)count + 1, sizeof *w->meshes);
    w->index = malloc(((size_t)mesh->corners + 1) * sizeof *w->index);
    int failed =
        !used || !w->shape || !w->shapes || !w->written || !w->materials || !w->meshes || !w->index;
    for (uint32_t i = 0, n = 0; i < most && !failed; i++) {
        if (!used[i])
            continue;
        w->scene.mNumMeshes = n + 1;
        failed = fill_material(&w->written[n], s, i, obj)
                 || fill_mesh(&w->shape[n], mesh, i, values, origin, colour, w->index);
        corners = w->shape[n].mNumVertices > corners ? w->shape[n].mNumVertices : corners;
        w->shape[n].mMaterialIndex = n;
        w->shapes[n] = &w->shape[n];
        w->materials[n] = &w->written[n].material;
        w->meshes[n] = n;
        n++;
    }
    for (uint32_t i = 0; i < corners && !failed; i++)
        w->index[i] = i;
    free(used);
    const float x = (float)origin[0], y = (float)origin[1], z = (float)origin[2];
    w->node.mTransformation = (struct aiMatrix4x4){1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1};
    if (!obj && view_up_axis(s) == 2) /* to y up: (x, y, z) becomes (x, z, -y) */
        w->node.mTransformation =
            (struct aiMatrix4x4){1, 0, 0, x, 0, 0, 1, z, 0, -1, 0, -y, 0, 0, 0, 1};
    w->node.mNumMeshes = w->scene.mNumMaterials = w->scene.mNumMeshes;
    w->node.mMeshes = w->meshes;
    w->scene.mRootNode = &w->node;
    w->scene.mMeshes = w->shapes;
    w->scene.mMaterials = w->materials;
    return failed ? -1 : 0;
}

static void free_scene(struct written_scene *w)
{
    for (uint32_t i = 0; w->shape && i < w->scene.mNumMeshes; i++) {
        free(w->shape[i].mVertices);
        free(w->shape[i].mColors[0]);
        free(w->shape[i].mFaces);
    }
    free(w->shape);
    free(w->shapes);
    free(w->written);
    free(w->materials);
    free(w->meshes);
    free(w->index);
    free(w);
}

int export_assimp(const char *path, const char *id, const struct surfaces *surfaces,
                  const struct leaf_mesh *mesh, const struct vertex_values *values,
                  const float *colour)
{
    const struct assimp *assimp = assimp_load(path);
    if (!assimp)
        return -1;
    const int obj = strcmp(id, "obj") == 0;
    double origin[3];
    if (obj)
        memset(origin, 0, sizeof origin);
    else
        far_away(values, origin);
    struct written_scene *w = calloc(1, sizeof *w);
    struct written_files *files = calloc(1, sizeof *files);
    int result = -1;
    if (!w || !files || fill_scene(w, surfaces, obj, mesh, values, origin, colour)) {
        report_error(path, 0, "out of memory for the mesh; write .ply, which needs less");
    } else {
        struct aiFileIO io = {open_file, close_file, (aiUserData)(void *)files};
        result = assimp->aiExportSceneEx(&w->scene, id, path, &io, 0) == aiReturn_SUCCESS
                         && !files->failed
                     ? 0
                     : -1;
        if (disk_failed(files))
            result = 0; /* the commit fails, and says why */
        else if (result && !files->failed)
            report_error(path, 0, "cannot be written: %s; write .ply instead",
                         assimp->aiGetErrorString());
    }
    temporary_lock(); /* a signal takes both or none */
    for (int i = 0; files && i < files->count; i++) {
        if (result)
            atomic_discard(&files->slot[i].out);
        else
            result = atomic_commit(&files->slot[i].out);
    }
    temporary_unlock();
    if (w)
        free_scene(w);
    free(files);
    return result;
}
