/* read_gmsh.c - see read_meshes.h: Gmsh's meshes, versions 2 to 2.2 and 4.1, as text or binary.
 *
 * Sections that are not needed are passed over up to their $End. In version 2 an element carries
 * its physical group, in 4.1 the surface that it is on does. An element that two groups have comes
 * twice in a row in version 2, and once in 4.1; it is in the first one. A mesh that is partitioned
 * has pieces in place of its surfaces, each with groups of its own making: it is in the first group
 * of the surface that it was cut from. [Gmsh reference manual, MSH file format]
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <string.h>

#include "scene/gmsh_numbers.h"
#include "scene/gmsh_types.h"
#include "scene/mesh_parts.h"
#include "scene/read_meshes.h"
#include "scene/read_numbers.h"
#include "scene/text_lines.h"
#include "util/array.h"
#include "util/report.h"

enum { SURFACE = 2 };

#define TO_OLDER "gmsh -0 -format msh22 -o NEW.msh OLD.msh" /* what reads more kinds than we do */

struct gmsh {
    struct mesh mesh;
    struct gmsh_numbers in;
    struct numbered names;    /* of physical surfaces, to materials */
    struct numbered surfaces; /* to their physical groups, as indices of `groups` */
    int64_t *groups;
    size_t group_count, group_capacity;
    int64_t *tags; /* of a block of nodes */
    size_t tag_capacity;
    int nodes, elements; /* sections seen */
    struct tags {
        int64_t group, surface;
    } last; /* of the last face, in version 2 */
};

/* ---- sections */

static int read_format(struct gmsh *g)
{
    double version, binary, size;
    uint64_t one;
    if (gmsh_need_line(&g->in, "the version") || gmsh_number(&g->in, "the version", &version)
        || gmsh_number(&g->in, "0 for a text", &binary) || gmsh_number(&g->in, "8 bytes", &size))
        return -1;
    g->in.version = version >= 2 && version < 3 ? 2 : version >= 4.1 && version < 5 ? 4 : 0;
    if (!g->in.version)
        return report_error(g->mesh.path, g->in.lines.number,
                            "version %g is not read; convert it: " TO_OLDER, version);
    g->in.binary = binary > 0;
    if (!g->in.binary)
        return gmsh_need_end(&g->in, "$EndMeshFormat");
    if (size < 8 || size > 8)
        return report_error(g->mesh.path, g->in.lines.number,
                            "a binary mesh with numbers of %g bytes, not 8; convert it: " TO_OLDER,
                            size);
    if (gmsh_bits(&g->in, "the number 1", 4, &one)) /* by which the order of bytes is told */
        return -1;
    g->in.big_endian = one != 1;
    if (one != 1 && one != 0x1000000)
        return report_error(
            g->mesh.path, g->in.lines.number,
            "no 1 behind this line of a binary mesh; the file is damaged, export it "
            "again");
    return gmsh_need_end(&g->in, "$EndMeshFormat");
}

/* The material of a physical surface: its name, or its number. */
static int group_material(struct gmsh *g, int64_t group, uint32_t *material)
{
    char name[40] = "DefaultMaterial";
    *material = numbered_find(&g->names, group);
    if (*material != UINT32_MAX)
        return 0;
    if (group)
        snprintf(name, sizeof name, "physical %lld", (long long)group);
    if (mesh_material(&g->mesh, name, strlen(name), MESH_GREY, material))
        return -1;
    return numbered_add(&g->names, group, *material) ? scene_file_no_memory(g->mesh.path) : 0;
}

static int read_names(struct gmsh *g)
{
    int64_t count, dimension, number;
    if (gmsh_need_line(&g->in, "physical names") || gmsh_count(&g->in, "physical names", &count))
        return -1;
    for (int64_t i = 0; i < count; i++) {
        if (gmsh_need_line(&g->in, "a physical name")
            || gmsh_whole(&g->in, "a dimension", &dimension)
            || gmsh_whole(&g->in, "a group's number", &number))
            return -1;
        const struct text_lines *t = &g->in.lines;
        const char *from = memchr(t->word_end, '"', (size_t)(t->line_end - t->word_end));
        const char *to = from ? memchr(from + 1, '"', (size_t)(t->line_end - from - 1)) : NULL;
        if (!to)
            return report_error(g->mesh.path, t->number,
                                "a physical name that is not in quotes; the file is damaged, "
                                "export it again");
        uint32_t material;
        if (dimension != SURFACE || to == from + 1
            || numbered_find(&g->names, number) != UINT32_MAX)
            continue;
        if (mesh_material(&g->mesh, from + 1, (size_t)(to - from) - 1, MESH_GREY, &material))
            return -1;
        if (numbered_add(&g->names, number, material))
            return scene_file_no_memory(g->mesh.path);
    }
    return gmsh_need_end(&g->in, "$EndPhysicalNames");
}

static int add_surface(struct gmsh *g, int64_t tag, int64_t group)
{
    if (numbered_find(&g->surfaces, tag) != UINT32_MAX)
        return report_error(g->mesh.path, g->in.lines.number,
                            "surface %lld is defined twice; the file is damaged, export it again",
                            (long long)tag);
    if (array_reserve(&g->groups, g->group_count + 1, &g->group_capacity, sizeof *g->groups)
        || numbered_add(&g->surfaces, tag, (uint32_t)g->group_count))
        return scene_file_no_memory(g->mesh.path);
    g->groups[g->group_count++] = group < 0 ? -group : group; /* negative: turned */
    return 0;
}

/* 0: none. */
static int64_t surface_group(const struct gmsh *g, int64_t dimension, int64_t tag)
{
    const uint32_t known = dimension == SURFACE ? numbered_find(&g->surfaces, tag) : UINT32_MAX;
    return known == UINT32_MAX ? 0 : g->groups[known];
}

/* What a piece was cut from, and which partitions it is of. */
static int read_parent(struct gmsh *g, int64_t *group)
{
    int64_t dimension, tag, partitions, ignored;
    if (gmsh_whole(&g->in, "a dimension", &dimension)
        || gmsh_whole(&g->in, "a parent's number", &tag)
        || gmsh_count(&g->in, "partitions", &partitions))
        return -1;
    for (int64_t i = 0; i < partitions; i++)
        if (gmsh_whole(&g->in, "a partition", &ignored))
            return -1;
    *group = surface_group(g, dimension, tag);
    return 0;
}

/* Of a surface its number and its first group; all of it must be taken where there are no lines. */
static int read_entity(struct gmsh *g, int dimension, int pieces)
{
    int64_t tag, groups, group, first = 0, bounds;
    double x;
    if (!g->in.bytes && dimension != SURFACE)
        return 0;
    if (gmsh_whole(&g->in, "an entity's number", &tag) || (pieces && read_parent(g, &first)))
        return -1;
    for (int k = 0; k < (dimension ? 6 : 3); k++)
        if (gmsh_number(&g->in, "an entity's bounds", &x))
            return -1;
    if (gmsh_count(&g->in, "physical groups", &groups))
        return -1;
    for (int64_t i = 0; i < groups; i++) {
        if (gmsh_whole(&g->in, "a physical group", &group))
            return -1;
        first = first ? first : group;
    }
    if (g->in.bytes && dimension) {
        if (gmsh_count(&g->in, "bounding entities", &bounds))
            return -1;
        for (int64_t i = 0; i < bounds; i++)
            if (gmsh_whole(&g->in, "a bounding entity", &group))
                return -1;
    }
    return dimension == SURFACE && first ? add_surface(g, tag, first) : 0;
}

/* How many partitions there are, and entities that are copies for others. */
static int read_partitions(struct gmsh *g)
{
    int64_t count, ignored;
    if (gmsh_need_line(&g->in, "partitions") || gmsh_count(&g->in, "partitions", &ignored)
        || gmsh_need_line(&g->in, "ghost entities") || gmsh_count(&g->in, "ghost entities", &count))
        return -1;
    for (int64_t i = 0; i < count; i++)
        if (gmsh_need_line(&g->in, "a ghost entity")
            || gmsh_whole(&g->in, "a ghost entity", &ignored)
            || gmsh_whole(&g->in, "a partition", &ignored))
            return -1;
    return 0;
}

/* Of 4.1: which physical group each surface is in, or each piece of one. */
static int read_entities(struct gmsh *g, int pieces)
{
    int64_t count[4];
    g->in.bytes = g->in.binary;
    if ((pieces && read_partitions(g)) || gmsh_need_line(&g->in, "entities"))
        return -1;
    for (int d = 0; d < 4; d++)
        if (gmsh_count(&g->in, "entities", &count[d]))
            return -1;
    for (int d = 0; d < 4; d++)
        for (int64_t i = 0; i < count[d]; i++)
            if (gmsh_need_line(&g->in, "an entity") || read_entity(g, d, pieces))
                return -1;
    return gmsh_need_end(&g->in, pieces ? "$EndPartitionedEntities" : "$EndEntities");
}

static int read_coordinates(struct gmsh *g, int64_t number)
{
    double p[3];
    for (int k = 0; k < 3; k++)
        if (gmsh_number(&g->in, "a coordinate", &p[k]))
            return -1;
    return mesh_define_node(&g->mesh, number, p, g->in.lines.number);
}

static int read_nodes_2(struct gmsh *g)
{
    int64_t count, number;
    if (gmsh_need_line(&g->in, "nodes") || gmsh_count(&g->in, "nodes", &count))
        return -1;
    g->in.bytes = g->in.binary;
    for (int64_t i = 0; i < count; i++)
        if (gmsh_need_line(&g->in, "a node") || gmsh_whole(&g->in, "a node's number", &number)
            || read_coordinates(g, number))
            return -1;
    return gmsh_need_end(&g->in, "$EndNodes");
}

/* What 4.1 says of all blocks: their number; how many are in them; the least and largest number. */
static int read_blocks(struct gmsh *g, const char *what, int64_t *blocks)
{
    int64_t ignored;
    g->in.bytes = g->in.binary;
    if (gmsh_need_line(&g->in, what) || gmsh_count(&g->in, what, blocks))
        return -1;
    for (int i = 0; i < 3 && g->in.bytes; i++)
        if (gmsh_long(&g->in, what, &ignored))
            return -1;
    return 0;
}

static int read_nodes_4(struct gmsh *g)
{
    int64_t blocks, dimension, ignored, parameters, count;
    double x;
    if (read_blocks(g, "blocks of nodes", &blocks))
        return -1;
    for (int64_t b = 0; b < blocks; b++) {
        if (gmsh_need_line(&g->in, "a block of nodes")
            || gmsh_whole(&g->in, "a dimension", &dimension)
            || gmsh_whole(&g->in, "an entity", &ignored)
            || gmsh_whole(&g->in, "0 or 1", &parameters) || gmsh_count(&g->in, "nodes", &count))
            return -1;
        for (int64_t i = 0; i < count; i++) {
            if (gmsh_need_line(&g->in, "a node's number"))
                return -1;
            if (array_reserve(&g->tags, (size_t)i + 1, &g->tag_capacity, sizeof *g->tags))
                return scene_file_no_memory(g->mesh.path);
            if (gmsh_long(&g->in, "a node's number", &g->tags[i]))
                return -1;
        }
        for (int64_t i = 0; i < count; i++) {
            if (gmsh_need_line(&g->in, "a node") || read_coordinates(g, g->tags[i]))
                return -1;
            /* places on the entity, where there are any */
            for (int64_t k = 0; g->in.bytes && parameters && k < dimension && k < 3; k++)
                if (gmsh_number(&g->in, "a parameter", &x))
                    return -1;
        }
    }
    return gmsh_need_end(&g->in, "$EndNodes");
}

/* The corners of an element; in a text the rest of its line is passed over. */
static int read_corners(struct gmsh *g, int64_t type, int64_t group)
{
    const int corners = corners_of(type);
    const uint32_t line = g->in.lines.number;
    int64_t node;
    uint32_t material;
    if (corners < 0)
        mesh_note(&g->mesh.volumes, line);
    g->mesh.file->other += corners == 0;
    if (corners <= 0)
        return 0;
    if (nodes_of(type) != corners)
        mesh_note(&g->mesh.curved, line);
    if (group_material(g, group, &material))
        return -1;
    for (int i = 0; i < corners; i++)
        if (gmsh_long(&g->in, "a node's number", &node) || mesh_corner(&g->mesh, node))
            return -1;
    return mesh_polygon(&g->mesh, (uint32_t)corners, material, line);
}

/* What is left of an element behind its number, its type and its tags. */
static int read_element(struct gmsh *g, int64_t type, int64_t group)
{
    const int all = nodes_of(type), corners = corners_of(type);
    int64_t ignored;
    if (type < 1 || type > GMSH_TYPES)
        return report_error(
            g->mesh.path, g->in.lines.number,
            "an element of type %lld: types are 1 to %d; the file is damaged, export "
            "it again",
            (long long)type, GMSH_TYPES);
    if (!g->in.bytes)
        return read_corners(g, type, group);
    if (!all)
        return report_error(
            g->mesh.path, g->in.lines.number,
            "an element of type %lld, which is not known; convert the mesh: " TO_OLDER,
            (long long)type);
    if (read_corners(g, type, group))
        return -1;
    for (int i = corners > 0 ? corners : 0; i < all; i++)
        if (gmsh_long(&g->in, "a node's number", &ignored))
            return -1;
    return 0;
}

/* The group, then the surface, then others. */
static int read_tags(struct gmsh *g, int64_t tags, struct tags *to)
{
    int64_t tag;
    *to = (struct tags){0, 0};
    for (int64_t k = 0; k < tags; k++) {
        if (gmsh_whole(&g->in, "a tag", &tag))
            return -1;
        tag = tag < 0 ? -tag : tag; /* turned */
        to->group = k == 0 ? tag : to->group;
        to->surface = k == 1 ? tag : to->surface;
    }
    return 0;
}

/* Takes back the last face if it is the one before it in another group. */
static void drop_repeated(struct gmsh *g, int64_t type, const struct tags *tags)
{
    struct scene_file *f = g->mesh.file;
    const uint32_t n = f->polygon_count, size = f->sizes[n - 1];
    const uint32_t *corners = &f->indices[f->index_count - size];
    if (n > 1 && f->sizes[n - 2] == size && tags->surface == g->last.surface
        && tags->group != g->last.group
        && memcmp(corners - size, corners, size * sizeof *corners) == 0) {
        g->mesh.curved.count -= nodes_of(type) != corners_of(type);
        f->polygon_count--;
        f->index_count -= size;
    } else {
        g->last = *tags;
    }
}

/* In a binary file elements of a kind stand together, behind what they share. */
static int read_elements_2(struct gmsh *g)
{
    int64_t count, type = 0, tags = 0, ignored, alike = 0;
    struct tags of;
    if (gmsh_need_line(&g->in, "elements") || gmsh_count(&g->in, "elements", &count))
        return -1;
    g->in.bytes = g->in.binary;
    for (int64_t i = 0; i < count; i++, alike--) {
        if (g->in.bytes && alike <= 0
            && (gmsh_whole(&g->in, "an element's type", &type)
                || gmsh_count(&g->in, "elements", &alike) || gmsh_count(&g->in, "tags", &tags)))
            return -1;
        if (gmsh_need_line(&g->in, "an element")
            || gmsh_whole(&g->in, "an element's number", &ignored))
            return -1;
        if (!g->in.bytes
            && (gmsh_whole(&g->in, "an element's type", &type)
                || gmsh_count(&g->in, "tags", &tags)))
            return -1;
        const uint32_t faces = g->mesh.file->polygon_count;
        if (read_tags(g, tags, &of) || read_element(g, type, of.group))
            return -1;
        if (g->mesh.file->polygon_count > faces)
            drop_repeated(g, type, &of);
    }
    return gmsh_need_end(&g->in, "$EndElements");
}

static int read_elements_4(struct gmsh *g)
{
    int64_t blocks, dimension, entity, type, count, ignored;
    if (read_blocks(g, "blocks of elements", &blocks))
        return -1;
    for (int64_t b = 0; b < blocks; b++) {
        if (gmsh_need_line(&g->in, "a block of elements")
            || gmsh_whole(&g->in, "a dimension", &dimension)
            || gmsh_whole(&g->in, "an entity", &entity) || gmsh_whole(&g->in, "a type", &type)
            || gmsh_count(&g->in, "elements", &count))
            return -1;
        const int64_t group = surface_group(g, dimension, entity);
        for (int64_t i = 0; i < count; i++)
            if (gmsh_need_line(&g->in, "an element")
                || gmsh_long(&g->in, "an element's number", &ignored)
                || read_element(g, type, group))
                return -1;
    }
    return gmsh_need_end(&g->in, "$EndElements");
}

/* ---- the file */

static int pass_over(struct gmsh *g)
{
    while (next_line(&g->in.lines))
        if (next_word(&g->in.lines) && g->in.lines.word_end - g->in.lines.word > 4
            && memcmp(g->in.lines.word, "$End", 4) == 0)
            return 0;
    return report_error(g->mesh.path, g->in.lines.number,
                        "ends within a section; the file is cut, export it again");
}

static int read_section(struct gmsh *g)
{
    const struct text_lines *t = &g->in.lines;
    if (*t->word != '$')
        return report_error(g->mesh.path, t->number,
                            "'%.*s' where a section begins with $; no Gmsh mesh, or a damaged one: "
                            "export it again",
                            quoted_length(t->word, t->word_end), t->word);
    if (word_is(t, "$MeshFormat"))
        return read_format(g);
    if (word_is(t, "$Comments"))
        return pass_over(g);
    if (!g->in.version)
        return report_error(g->mesh.path, t->number,
                            "no $MeshFormat before this section; the file is older than version 2 "
                            "or damaged: convert it with " TO_OLDER);
    if (word_is(t, "$PhysicalNames"))
        return read_names(g);
    if (word_is(t, "$Entities") && g->in.version == 4)
        return read_entities(g, 0);
    if (word_is(t, "$PartitionedEntities") && g->in.version == 4)
        return read_entities(g, 1);
    if (word_is(t, "$Nodes")) {
        g->nodes = 1;
        return g->in.version == 4 ? read_nodes_4(g) : read_nodes_2(g);
    }
    if (word_is(t, "$Elements")) {
        g->elements = 1;
        return g->in.version == 4 ? read_elements_4(g) : read_elements_2(g);
    }
    if (word_is(t, "$ParametricNodes"))
        return report_error(
            g->mesh.path, t->number,
            "nodes with their places on surfaces are not read; convert the mesh: " TO_OLDER);
    return pass_over(g);
}

int read_gmsh(struct scene_file *f, const char *path, char *text, size_t size, int quiet)
{
    struct gmsh g = {.mesh = {.file = f, .path = path},
                     .in = {.mesh = &g.mesh, .lines = text_lines(text, size)}};
    int result = 0;
    while (!result && next_line(&g.in.lines))
        if (next_word(&g.in.lines))
            result = read_section(&g);
    if (!result && !(g.nodes && g.elements))
        result = report_error(path, g.in.lines.number,
                              "no $Nodes or no $Elements; the file is cut, export it again");
    if (!result)
        result = mesh_finish(&g.mesh, quiet);
    mesh_free(&g.mesh);
    free(g.names.entry);
    free(g.surfaces.entry);
    free(g.groups);
    free(g.tags);
    return result;
}
