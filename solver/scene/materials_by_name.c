/* materials_by_name.c - see materials_by_name.h.
 * SPDX-License-Identifier: MIT */
#include "scene/materials_by_name.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "scene/read_numbers.h"
#include "scene/text_lines.h"
#include "util/array.h"
#include "util/beside.h"
#include "util/report.h"
#include "util/text_file.h"

/* What MTL files' materials reflect unless they say so, and the material of faces without one: as
 * Assimp has them, which read these files before. */
static const char STAND_IN[] = "DefaultMaterial";
static const struct RadMaterial PLAIN = {.reflectance = {0.6, 0.6, 0.6}};

enum { QUOTED_PATH = 256 }; /* bytes of a path that a message quotes */

/* ---- names */

/* A new material, from now on what its name means. Returns NO_NAME when out of memory. */
static uint32_t add_material(struct materials_by_name *m, const char *name)
{
    uint32_t n = m->file->material_count;
    if (array_reserve(&m->use, (size_t)n + 1, &m->use_capacity, sizeof *m->use) < 0
        || array_reserve(&m->group, (size_t)n + 1, &m->group_capacity, sizeof *m->group) < 0
        || scene_file_add_material(m->file, name, &PLAIN)
        || name_slots_put(&m->newest, m->file->names, n) < 0)
        return NO_NAME;
    m->use[n] = m->group[n] = 0;
    return n;
}

static uint32_t find_material(const struct materials_by_name *m, const char *name)
{
    return name_slots_find(&m->newest, m->file->names, name);
}

/* The name without a comment behind it: "Material #25" is a name, "red # warm" may be red. */
static size_t bare_length(const char *name)
{
    const char *end = strstr(name, " #"), *tab = strstr(name, "\t#");
    end = tab && (!end || tab < end) ? tab : end;
    size_t length = end ? (size_t)(end - name) : strlen(name);
    while (length && is_blank(name[length - 1]))
        length--;
    return length;
}

int materials_use(struct materials_by_name *m, const char *name, uint32_t line, uint32_t *material)
{
    *material = find_material(m, name);
    if (*material == NO_NAME) {
        *material = add_material(m, name);
        if (*material == NO_NAME)
            return scene_file_no_memory(m->path);
        m->use[*material] = line;
    }
    return 0;
}

int materials_stand_in(struct materials_by_name *m, uint32_t line, uint32_t *material)
{
    *material = find_material(m, STAND_IN);
    if (*material == NO_NAME)
        *material = add_material(m, STAND_IN);
    if (*material == NO_NAME)
        return scene_file_no_memory(m->path);
    materials_assume(m, NO_MATERIAL, m->path, line, "", NULL);
    return 0;
}

/* ---- libraries */

static int same_values(const struct RadMaterial *a, const struct RadMaterial *b)
{
    int same = 1;
    for (int k = 0; k < 3; k++)
        same &= !(a->reflectance[k] < b->reflectance[k] || a->reflectance[k] > b->reflectance[k]
                  || a->exitance[k] < b->exitance[k] || a->exitance[k] > b->exitance[k]);
    return same;
}

struct library {
    const char *path;
    uint32_t material, before; /* being defined; what its name meant before, or NO_NAME */
    uint32_t line;             /* of its newmtl */
    int passed_over;           /* 1: a file before it on the mtllib line has defined it */
};

/* What has been read of a material is all of it. */
static void end_material(struct materials_by_name *m, const struct library *l)
{
    const struct scene_file *f = m->file;
    if (l->material == NO_NAME)
        return;
    const char *name = f->names[l->material];
    if (l->before != NO_NAME && !same_values(&f->materials[l->before], &f->materials[l->material]))
        materials_assume(m, DEFINED_TWICE, l->path, l->line, name, NULL);
    if (!f->places[l->material].diffuse_line)
        materials_assume(m, NO_DIFFUSE, l->path, l->line, name, NULL);
}

static int read_newmtl(struct materials_by_name *m, const struct text_lines *t, struct library *l)
{
    char *name = rest_of_line(t);
    if (!name)
        return scene_file_no_memory(l->path);
    end_material(m, l);
    uint32_t found = find_material(m, name);
    int undefined = found != NO_NAME && m->use[found];
    l->passed_over = found != NO_NAME && !undefined && m->group[found] == m->groups
                     && strcmp(m->file->places[found].file, l->path) != 0;
    l->before = undefined ? NO_NAME : found;
    l->material = l->passed_over ? NO_NAME : undefined ? found : add_material(m, name);
    l->line = t->number;
    free(name);
    if (l->passed_over)
        return 0;
    if (l->material == NO_NAME)
        return scene_file_no_memory(l->path);
    m->use[l->material] = 0;
    m->group[l->material] = m->groups;
    m->defined++;
    m->file->places[l->material].file = strdup(l->path);
    return m->file->places[l->material].file ? 0 : scene_file_no_memory(l->path);
}

/* Kd or Ke: three numbers, or one for all three. */
static int read_colour(struct materials_by_name *m, struct text_lines *t, const struct library *l)
{
    int diffuse = t->word[1] == 'd';
    double value[3] = {0};
    uint32_t line = t->number;
    int count =
        read_numbers(t, l->path, diffuse ? "a diffuse colour (Kd)" : "an exitance (Ke)", 3, value);
    if (count < 0)
        return -1;
    if (count != 1 && count != 3)
        return report_error(l->path, line,
                            "a colour has %d numbers; give one per channel, three in all", count);
    if (l->material == NO_NAME) {
        if (!l->passed_over)
            materials_assume(m, STRAY_COLOUR, l->path, line, diffuse ? "Kd" : "Ke", NULL);
        return 0;
    }
    struct RadMaterial *to = &m->file->materials[l->material];
    struct material_place *place = &m->file->places[l->material];
    for (int k = 0; k < 3; k++)
        (diffuse ? to->reflectance : to->exitance)[k] = value[count == 3 ? k : 0];
    *(diffuse ? &place->diffuse_line : &place->emissive_line) = line;
    return 0;
}

/* d 1, Tr 0 and Tr 1 (exporters disagree which of the two is opaque) say nothing. */
static void read_opacity(struct materials_by_name *m, struct text_lines *t, const struct library *l)
{
    int dissolve = *t->word == 'd';
    double value;
    if (l->material != NO_NAME && next_word(t) && word_number(t, &value) && value < 1
        && (dissolve || value > 0))
        materials_assume(m, TRANSPARENT, l->path, t->number, m->file->names[l->material], NULL);
}

static int read_library_text(struct materials_by_name *m, const char *path, struct text_lines t)
{
    struct library l = {.path = path, .material = NO_NAME, .before = NO_NAME};
    while (next_line(&t)) {
        int failed = 0;
        if (!next_word(&t))
            continue;
        if (word_is(&t, "newmtl"))
            failed = read_newmtl(m, &t, &l);
        else if (word_is(&t, "Kd") || word_is(&t, "Ke"))
            failed = read_colour(m, &t, &l);
        else if (word_is(&t, "d") || word_is(&t, "Tr"))
            read_opacity(m, &t, &l);
        else if ((word_is(&t, "map_Kd") || word_is(&t, "map_Ke")) && l.material != NO_NAME)
            materials_assume(m, TEXTURE, path, t.number, m->file->names[l.material], NULL);
        else if (word_is_any_case(&t, "newmtl") || word_is_any_case(&t, "Kd")
                 || word_is_any_case(&t, "Ke")) /* a lamp may be dark for it */
            materials_assume(m, UNKNOWN_LINE, path, t.number, t.word, t.word_end);
        if (failed)
            return -1;
    }
    end_material(m, &l);
    return 0;
}

/* A library once more: its definitions are the newest again. Returns 0 when it is new. */
static int renew(struct materials_by_name *m, const char *path)
{
    int has_read = 0;
    for (uint32_t i = 0; i < m->file->material_count; i++)
        if (m->file->places[i].file && strcmp(m->file->places[i].file, path) == 0) {
            (void)name_slots_put(&m->newest, m->file->names, i); /* no new name */
            has_read = 1;
        }
    return has_read;
}

/* Returns 0, -1 after a message, or 1 when it cannot be opened and `may_miss`. A path of Windows is
 * none here: its file is sought beside the scene. */
static int read_library(void *to, const char *name, size_t length, int may_miss)
{
    struct materials_by_name *m = to;
    char *path = path_beside(m->path, name, length);
    if (!path)
        return scene_file_no_memory(m->path);
    if (m->last && strcmp(m->last, path) == 0) {
        free(path);
        return 0;
    }
    int result = 0;
    if (!renew(m, path)) {
        size_t size;
        char *text = text_file_read_regular(path, &size);
        size_t folder = text ? 0 : length;
        while (folder && name[folder - 1] != '\\')
            folder--;
        if (folder) {
            free(path);
            return read_library(to, name + folder, length - folder, may_miss);
        }
        if (!text && may_miss)
            result = 1;
        else if (!text)
            result = report_error(
                m->path, m->line,
                "cannot read the material library '%.*s': %s; put it there or correct the name",
                QUOTED_PATH, path, strerror(errno));
        else if (memchr(text, 0, size))
            result = report_error(path, 0, "not a text, hence no MTL file; check the format");
        else
            result = read_library_text(m, path, text_lines(text, size));
        free(text);
    }
    if (result) {
        free(path);
        return result;
    }
    free(m->last);
    m->last = path;
    return 0;
}

/* The first of several that is not there leaves one name of the whole line. */
int materials_libraries(const char *line_text, library_fn *take, void *to)
{
    const size_t whole = strlen(line_text), bare = bare_length(line_text);
    int result = 1;
    if (bare < whole)
        result = take(to, line_text, whole, 1);
    if (result > 0)
        result = take(to, line_text, bare, strcspn(line_text, " \t") < bare);
    if (result <= 0)
        return result;
    for (size_t at = 0; at < bare; at += strspn(line_text + at, " \t")) {
        size_t length = strcspn(line_text + at, " \t");
        length = length < bare - at ? length : bare - at;
        result = take(to, line_text + at, length, at == 0);
        if (result > 0)
            return take(to, line_text, whole, 0);
        if (result < 0)
            return -1;
        at += length;
    }
    return 0;
}

int materials_library(struct materials_by_name *m, const char *line_text, uint32_t line)
{
    m->groups++;
    m->line = line;
    return materials_libraries(line_text, read_library, m);
}

/* ---- the end of the file */

/* A use of "red # warm" may mean red. Returns 1 when it does. */
static int use_bare(struct materials_by_name *m, uint32_t i)
{
    struct scene_file *f = m->file;
    char *bare = strndup(f->names[i], bare_length(f->names[i]));
    uint32_t found = NO_NAME;
    for (uint32_t j = 0; bare && j < f->material_count; j++) {
        size_t length = m->use[j] ? 0 : bare_length(f->names[j]);
        if (!m->use[j] && length == strlen(bare) && memcmp(f->names[j], bare, length) == 0)
            found = j;
    }
    free(bare);
    if (found == NO_NAME)
        return 0;
    for (uint32_t j = 0; j < f->polygon_count; j++)
        if (f->polygon_materials[j] == i)
            f->polygon_materials[j] = found;
    return 1;
}

int materials_check(struct materials_by_name *m)
{
    const struct scene_file *f = m->file;
    for (uint32_t i = 0; i < f->material_count; i++) {
        if (!m->use[i] || use_bare(m, i))
            continue;
        if (!m->groups || m->defined)
            return report_error(
                m->path, m->use[i],
                m->groups
                    ? "material '%.*s' is in no material library of this file; define it there or "
                      "correct the name"
                    : "material '%.*s' is used, but no mtllib line names a material library; add "
                      "one",
                QUOTED, f->names[i]);
        materials_assume(m, NO_DEFINITION, m->path, m->use[i], f->names[i], NULL);
    }
    return 0;
}

void materials_assume(struct materials_by_name *m, enum assumption kind, const char *file,
                      uint32_t line, const char *name, const char *end)
{
    struct assumed *a = &m->assumed[kind];
    if (a->count++)
        return;
    a->line = line;
    a->file = strdup(file);
    a->name = end ? strndup(name, (size_t)(end - name)) : strdup(name);
}

void materials_warn(const struct materials_by_name *m)
{
    static const char *const text[ASSUMPTIONS] = {
        [NO_DIFFUSE] = "material '%.*s' has no Kd; taken as 0.6 (%u materials)",
        [NO_MATERIAL] = "a face before any usemtl%.*s; it reflects 0.6 and does not emit (so do "
                        "all faces up to the first usemtl, %u run)",
        [NO_DEFINITION] = "material '%.*s' is used, but its libraries are empty; it reflects 0.6 "
                          "and does not emit (%u materials)",
        [DEFINED_TWICE] = "material '%.*s' is defined again, otherwise than before; each usemtl "
                          "means the newest definition above it (%u definitions)",
        [STRAY_COLOUR] = "%.*s before any newmtl is passed over (%u lines)",
        [TEXTURE] = "the texture of material '%.*s' is passed over; its Kd and Ke hold (%u maps)",
        [TRANSPARENT] = "material '%.*s' is transparent; taken as opaque (%u lines)",
        [WEIGHT] = "a vertex with a weight w%.*s, by which its coordinates are divided (%u "
                   "vertices)",
        [UNKNOWN_LINE] = "a line that starts with '%.*s' is passed over; write it as the format "
                         "does, in its letters (%u lines of such kinds)",
    };
    for (int i = 0; i < ASSUMPTIONS; i++) {
        const struct assumed *a = &m->assumed[i];
        if (a->count)
            report_warning(a->file ? a->file : m->path, a->line, text[i], QUOTED,
                           a->name ? a->name : "", (unsigned)a->count);
    }
}

void materials_free(struct materials_by_name *m)
{
    for (int i = 0; i < ASSUMPTIONS; i++) {
        free(m->assumed[i].file);
        free(m->assumed[i].name);
    }
    free(m->use);
    free(m->group);
    name_slots_free(&m->newest);
    free(m->last);
}
