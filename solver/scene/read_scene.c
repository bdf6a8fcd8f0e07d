/* scene.c - scene files to flat faces, through Assimp.
 *
 * Assimp reads with no post-processing, so that faces are those of the file. Invariant: one
 * input_face per face of the file, in the file's order, whatever becomes of it; every face of
 * the result is flat and convex, has an area, and names its input. Faces in which others stand are
 * cut there (scene_cut.h).
 *
 * Material: reflectance = diffuse colour (glTF: base colour), exitance in W/m2 = emissive
 * colour times its strength where the format has one. A face reflects and emits on both sides
 * when its material's name ends in "_2s", when the format says so (glTF: doubleSided), or when
 * the caller asks for it. Textures are not looked at.
 * SPDX-License-Identifier: MIT */
#include "hierarchy/scene.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include <assimp/cimport.h>
#include <assimp/material.h>
#include <assimp/scene.h>

#include "util/ends_with.h"
#include "scene/import_text.h"
#include "scene/obj_scan.h"
#include "hierarchy/polygon.h"
#include "util/report.h"
#include "hierarchy/cut_faces.h"

/* How far from its mean plane a quad's corner may lie, relative to the quad's size. */
static const double FLAT_QUAD = 1e-4;

struct reader {
    struct scene *scene;
    const struct scene_options *options;
    const char *path;
    struct obj_scan scan; /* empty when the file is no OBJ */
    uint32_t face_capacity, input_capacity;
    uint8_t *used;          /* [material_count] */
    double (*corner)[3];    /* the polygon at hand */
    uint32_t (*triangle)[3], *scratch;
    uint32_t corner_capacity;
};

static int out_of_memory(const struct reader *r)
{
    return report_error(r->path, 0, "out of memory; use a smaller scene or a larger machine");
}

/* The line a face came from, when the format has lines. */
static uint32_t face_line(const struct reader *r, uint32_t input)
{
    return input < r->scan.faces ? r->scan.face_line[input] : 0;
}

/* Files hold decimals; Assimp holds floats. The shortest decimal that rounds to the float is what
 * was written, as long as it had 7 digits or fewer, and keeps 1 - rho exact to the last of them. */
static double decimal(float value)
{
    char text[40];
    for (int digits = 6; digits < 9; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, (double)value);
        if (strtof(text, NULL) == value)
            return strtod(text, NULL);
    }
    return (double)value;
}

static void read_material(const struct reader *r, const struct aiMaterial *from, struct material *to)
{
    struct aiColor4D colour;
    float strength = 1;
    int two_sided = 0;
    if (aiGetMaterialColor(from, AI_MATKEY_BASE_COLOR, &colour) == aiReturn_SUCCESS ||
        aiGetMaterialColor(from, AI_MATKEY_COLOR_DIFFUSE, &colour) == aiReturn_SUCCESS) {
        to->reflectance[0] = decimal(colour.r);
        to->reflectance[1] = decimal(colour.g);
        to->reflectance[2] = decimal(colour.b);
    }
    if (aiGetMaterialColor(from, AI_MATKEY_COLOR_EMISSIVE, &colour) == aiReturn_SUCCESS) {
        aiGetMaterialFloatArray(from, AI_MATKEY_EMISSIVE_INTENSITY, &strength, NULL);
        to->exitance[0] = decimal(colour.r) * decimal(strength);
        to->exitance[1] = decimal(colour.g) * decimal(strength);
        to->exitance[2] = decimal(colour.b) * decimal(strength);
    }
    aiGetMaterialIntegerArray(from, AI_MATKEY_TWOSIDED, &two_sided, NULL);
    to->two_sided = two_sided || r->options->two_sided || ends_with(to->name, "_2s");
}

static int has_extension(const char *path, const char *const *extensions)
{
    const char *dot = strrchr(path, '.');
    for (; dot && *extensions; extensions++)
        if (strcasecmp(dot, *extensions) == 0)
            return 1;
    return 0;
}

/* Formats of shape alone: Assimp's stand-in is white, which no radiosity can stand, and two-sided. */
static void replace_stand_in(struct reader *r)
{
    static const char *const shapes[] = {".ply", ".stl", ".off", NULL};
    if (!has_extension(r->path, shapes))
        return;
    for (uint32_t i = 0; i < r->scene->material_count; i++) {
        struct material *m = &r->scene->materials[i];
        for (int k = 0; k < 3; k++) {
            m->reflectance[k] = 0.5;
            m->exitance[k] = 0;
        }
        m->two_sided = r->options->two_sided;
    }
    if (!r->options->quiet)
        report_warning(r->path, 0, "this format holds no materials: every face reflects 0.5 and none emits");
}

static int read_materials(struct reader *r, const struct aiScene *from)
{
    struct scene *scene = r->scene;
    /* A file without materials still gets one: grey, dark. */
    uint32_t count = from->mNumMaterials ? from->mNumMaterials : 1;
    scene->materials = calloc(count, sizeof *scene->materials);
    r->used = calloc(count, 1);
    if (!scene->materials || !r->used)
        return out_of_memory(r);
    scene->material_count = count;
    for (uint32_t i = 0; i < count; i++) {
        struct material *m = &scene->materials[i];
        struct aiString name = {0};
        if (i < from->mNumMaterials)
            aiGetMaterialString(from->mMaterials[i], AI_MATKEY_NAME, &name);
        m->name = strdup(name.length ? name.data : "unnamed");
        if (!m->name)
            return out_of_memory(r);
        if (i < from->mNumMaterials) {
            read_material(r, from->mMaterials[i], m);
        } else {
            m->reflectance[0] = m->reflectance[1] = m->reflectance[2] = 0.5;
            m->two_sided = r->options->two_sided;
        }
    }
    replace_stand_in(r);
    return 0;
}

static int check_materials(const struct reader *r)
{
    for (uint32_t i = 0; i < r->scene->material_count; i++) {
        const struct material *m = &r->scene->materials[i];
        const struct obj_material *where = obj_scan_material(&r->scan, m->name);
        const char *file = where ? where->file : r->path;
        for (int k = 0; k < 3 && r->used[i]; k++) {
            if (!(m->reflectance[k] >= 0 && m->reflectance[k] < 1))
                return report_error(file, where ? where->diffuse_line : 0,
                                    "material '%s' has reflectance %g; the diffuse colour must be 0 or more and below 1",
                                    m->name, m->reflectance[k]);
            if (!(m->exitance[k] >= 0 && isfinite(m->exitance[k])))
                return report_error(file, where ? where->emissive_line : 0,
                                    "material '%s' has exitance %g W/m2; the emissive colour must be 0 or more and finite",
                                    m->name, m->exitance[k]);
        }
    }
    return 0;
}

/* Room for one more element of `size` bytes; NULL when there is none. */
static void *grown(void *array, uint32_t count, uint32_t *capacity, size_t size)
{
    if (count < *capacity)
        return array;
    uint32_t more = *capacity < 1024 ? 1024 : *capacity > UINT32_MAX / 2 ? UINT32_MAX : *capacity * 2;
    void *larger = count < more ? realloc(array, more * size) : NULL;
    if (larger)
        *capacity = more;
    return larger;
}

static int add_face(struct reader *r, const uint32_t *corners, uint32_t count, uint32_t material, uint32_t input)
{
    struct scene *scene = r->scene;
    const struct material *m = &scene->materials[material];
    int black = 1;
    for (int k = 0; k < 3; k++)
        black &= m->reflectance[k] == 0 && m->exitance[k] == 0;
    for (int back = 0; back <= !!m->two_sided; back++) {
        struct face *larger = grown(scene->faces, scene->face_count, &r->face_capacity, sizeof *larger);
        if (!larger)
            return out_of_memory(r);
        scene->faces = larger;
        struct face *f = &larger[scene->face_count++];
        *f = (struct face){.vertices = count, .material = material, .input = input, .back = (uint8_t)back, .black = (uint8_t)black};
        for (uint32_t i = 0; i < count; i++)
            memcpy(f->vertex[i], r->corner[corners[back ? count - 1 - i : i]], sizeof f->vertex[i]);
    }
    return 0;
}

/* The polygon in r->corner becomes one face, several, or none. */
static int add_polygon(struct reader *r, uint32_t count, uint32_t material)
{
    struct scene *scene = r->scene;
    uint32_t input = scene->input_count, triangles = 1;
    const uint32_t whole[4] = {0, 1, 2, 3};
    double normal[3];
    struct input_face *larger = grown(scene->inputs, input, &r->input_capacity, sizeof *larger);
    if (!larger)
        return out_of_memory(r);
    scene->inputs = larger;
    scene->input_count++;
    larger[input] = (struct input_face){.material = material};
    if (polygon_degenerate(r->corner, count)) {
        scene->dropped++;
        return 0;
    }
    r->used[material] = 1;
    if (count == 3 || (count == 4 && polygon_flat(r->corner, 4, FLAT_QUAD) && polygon_convex_quad(r->corner))) {
        larger[input].area = polygon_normal(r->corner, count, normal);
        return add_face(r, whole, count, material, input);
    }
    triangles = polygon_triangulate(r->corner, count, r->triangle, r->scratch);
    for (uint32_t i = 0; i < triangles; i++) {
        double part[3][3];
        for (int k = 0; k < 3; k++)
            memcpy(part[k], r->corner[r->triangle[i][k]], sizeof part[k]);
        if (polygon_degenerate(part, 3))
            continue;
        larger[input].area += polygon_normal(part, 3, normal);
        if (add_face(r, r->triangle[i], 3, material, input))
            return -1;
    }
    if (!(larger[input].area > 0))
        scene->dropped++;
    return 0;
}

static int reserve_corners(struct reader *r, uint32_t count)
{
    if (count <= r->corner_capacity)
        return 0;
    void *corner = realloc(r->corner, count * sizeof *r->corner);
    if (corner)
        r->corner = corner;
    void *triangle = realloc(r->triangle, count * sizeof *r->triangle);
    if (triangle)
        r->triangle = triangle;
    void *scratch = realloc(r->scratch, count * sizeof *r->scratch);
    if (scratch)
        r->scratch = scratch;
    if (!corner || !triangle || !scratch)
        return out_of_memory(r);
    r->corner_capacity = count;
    return 0;
}

static int read_mesh(struct reader *r, const struct aiMesh *mesh, const struct aiMatrix4x4 *m, int mirrored)
{
    uint32_t material = mesh->mMaterialIndex < r->scene->material_count ? mesh->mMaterialIndex : 0;
    for (uint32_t i = 0; i < mesh->mNumFaces; i++) {
        const struct aiFace *from = &mesh->mFaces[i];
        uint32_t count = 0, input = r->scene->input_count;
        if (reserve_corners(r, from->mNumIndices + 4))
            return -1;
        for (uint32_t j = 0; j < from->mNumIndices; j++) {
            uint32_t index = from->mIndices[mirrored ? from->mNumIndices - 1 - j : j];
            if (index >= mesh->mNumVertices)
                return report_error(r->path, face_line(r, input),
                                    "face %u of mesh '%s' names vertex %u of %u; the file is damaged, export it again",
                                    (unsigned)i, mesh->mName.data, (unsigned)index, (unsigned)mesh->mNumVertices);
            const struct aiVector3D *v = &mesh->mVertices[index];
            double x = (double)v->x, y = (double)v->y, z = (double)v->z, *p = r->corner[count];
            p[0] = m->a1 * x + m->a2 * y + m->a3 * z + m->a4;
            p[1] = m->b1 * x + m->b2 * y + m->b3 * z + m->b4;
            p[2] = m->c1 * x + m->c2 * y + m->c3 * z + m->c4;
            if (!isfinite(p[0]) || !isfinite(p[1]) || !isfinite(p[2]))
                return report_error(r->path, face_line(r, input),
                                    "vertex %u of mesh '%s' is not finite; correct its coordinates",
                                    (unsigned)index, mesh->mName.data);
            /* A corner given twice in a row is one corner: a quad at a pole is a triangle. */
            if (!count || memcmp(p, r->corner[count - 1], sizeof r->corner[0]) != 0)
                count++;
        }
        while (count > 1 && memcmp(r->corner[0], r->corner[count - 1], sizeof r->corner[0]) == 0)
            count--;
        if (add_polygon(r, count, material))
            return -1;
    }
    return 0;
}

static int read_node(struct reader *r, const struct aiScene *from, const struct aiNode *node, const struct aiMatrix4x4 *above)
{
    struct aiMatrix4x4 m = *above;
    aiMultiplyMatrix4(&m, &node->mTransformation);
    /* A mirror turns the sense of rotation, hence the front; turn it back. */
    int mirrored = aiMatrix4Determinant(&m) < 0;
    for (uint32_t i = 0; i < node->mNumMeshes; i++)
        if (node->mMeshes[i] < from->mNumMeshes && read_mesh(r, from->mMeshes[node->mMeshes[i]], &m, mirrored))
            return -1;
    for (uint32_t i = 0; i < node->mNumChildren; i++)
        if (read_node(r, from, node->mChildren[i], &m))
            return -1;
    return 0;
}

static uint32_t bands(const struct reader *r)
{
    for (uint32_t i = 0; i < r->scene->material_count; i++) {
        const double *rho = r->scene->materials[i].reflectance, *e = r->scene->materials[i].exitance;
        if (r->used[i] && (rho[0] != rho[1] || rho[1] != rho[2] || e[0] != e[1] || e[1] != e[2]))
            return 3;
    }
    return 1;
}

static int convert(struct reader *r, const struct aiScene *from)
{
    struct scene *scene = r->scene;
    struct aiMatrix4x4 identity;
    aiIdentityMatrix4(&identity);
    if (read_materials(r, from) || read_node(r, from, from->mRootNode, &identity))
        return -1;
    if (r->scan.faces && scene->input_count != r->scan.faces)
        return report_error(r->path, 0, "%u faces in the file but %u were read; report this as a bug",
                            (unsigned)r->scan.faces, (unsigned)scene->input_count);
    if (!scene->face_count)
        return report_error(r->path, 0, scene->dropped ? "all of its %u faces are degenerate; give one face with an area"
                                                       : "there is no face in it (%u found); a scene needs one face at least",
                            (unsigned)scene->dropped);
    if (check_materials(r))
        return -1;
    scene->bands = bands(r);
    if ((scene->dropped || r->scan.other) && !r->options->quiet)
        report_warning(r->path, 0, "%u degenerate faces dropped (no area, or fewer than three corners), %u points and lines ignored",
                       (unsigned)scene->dropped, (unsigned)r->scan.other);
    return 0;
}

int scene_read(struct scene *scene, const char *path, const struct scene_options *options)
{
    const struct scene_options none = {0};
    struct reader r = {.scene = scene, .path = path, .options = options ? options : &none};
    struct stat status;
    const struct aiScene *from;
    static const char *const obj[] = {".obj", NULL};
    *scene = (struct scene){0};
    if (stat(path, &status))
        return report_error(path, 0, "cannot read: %s; check the name", strerror(errno));
    if (S_ISDIR(status.st_mode))
        return report_error(path, 0, "this is a folder; name a scene file in it");
    if (has_extension(path, obj)) {
        if (obj_scan_read(&r.scan, path))
            return -1;
        from = import_text(path, r.scan.text, r.scan.size);
        obj_scan_free_text(&r.scan); /* large, and read */
    } else {
        from = aiImportFile(path, 0);
    }
    int result;
    if (!from || !from->mRootNode)
        result = report_error(path, 0, "cannot be read as a scene: %s; check the format and that the file is whole", aiGetErrorString());
    else
        result = convert(&r, from);
    aiReleaseImport(from);
    if (!result && scene_cut(scene) < 0)
        result = out_of_memory(&r);
    obj_scan_free(&r.scan);
    free(r.used);
    free(r.corner);
    free(r.triangle);
    free(r.scratch);
    if (result)
        scene_free(scene);
    return result;
}

void scene_free(struct scene *scene)
{
    for (uint32_t i = 0; i < scene->material_count; i++)
        free(scene->materials[i].name);
    free(scene->materials);
    free(scene->faces);
    free(scene->inputs);
    *scene = (struct scene){0};
}
