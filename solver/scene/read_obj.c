/* read_obj.c - see read_obj.h.
 *
 * Read once, from top to bottom. Vertices and materials may be used before they are defined; what
 * is still undefined at the end is reported with the line that used it first.
 * SPDX-License-Identifier: MIT */
#include "scene/read_obj.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "kernel/hash.h"
#include "scene/text_lines.h"
#include "util/array.h"
#include "util/report.h"
#include "util/text_file.h"

/* What MTL files' materials reflect unless they say so, and the material of faces without one: as
 * Assimp has them, which read these files before. */
static const char STAND_IN[] = "DefaultMaterial";
static const struct RadMaterial PLAIN = {.reflectance = {0.6, 0.6, 0.6}};

#define NONE UINT32_MAX /* no material */

enum { QUOTED = 64 }; /* no message quotes more bytes of a word, so that it keeps its end */

struct obj {
    struct scene_file *file;
    const char *path;
    /* [material_count]: the line of the first usemtl of each that no library has defined yet,
     * else 0 */
    uint32_t *use;
    size_t use_capacity;
    /* [slot_count], a power of two: materials by their names, NONE where there is none; searched
     * from the name's hash on */
    uint32_t *slots, slot_count;
    uint32_t current; /* material of the faces to come */
    uint32_t libraries;
    int ahead; /* some face uses a vertex that comes after it */
};

static int out_of_memory(const char *path)
{
    return report_error(path, 0, "out of memory; use a smaller scene or a larger machine");
}

static int quoted_length(const char *from, const char *end)
{
    return end - from < QUOTED ? (int)(end - from) : QUOTED;
}

/* The finite numbers on the rest of the line, of which the first `most` go to `value`. Returns
 * how many; -1 after an error. */
static int read_numbers(struct text_lines *t, const char *path, const char *what, int most,
                        double *value)
{
    int count = 0;
    while (next_word(t)) {
        double x;
        int length = quoted_length(t->word, t->word_end);
        if (!word_number(t, &x))
            return report_error(path, t->number,
                                "'%.*s' is not a number in %s; write a decimal number", length,
                                t->word, what);
        if (!(fabs(x) <= (double)FLT_MAX))
            return report_error(path, t->number, "%s is not finite ('%.*s'); write a finite number",
                                what, length, t->word);
        if (count < most)
            value[count] = x;
        count++;
    }
    return count;
}

/* ---- materials */

/* The slot of that name, or the free one where it belongs. */
static uint32_t *find_slot(const struct obj *o, const char *name)
{
    uint64_t h = 0;
    for (const char *c = name; *c; c++)
        h = hash64(h + (unsigned char)*c + HASH_STEP);
    uint32_t i = (uint32_t)h & (o->slot_count - 1);
    while (o->slots[i] != NONE && strcmp(o->file->names[o->slots[i]], name) != 0)
        i = (i + 1) & (o->slot_count - 1);
    return &o->slots[i];
}

/* Twice the slots, so that half of them stay free. Returns 0, or -1 when out of memory. */
static int grow_slots(struct obj *o)
{
    uint32_t count = o->slot_count ? 2 * o->slot_count : 64;
    uint32_t *slots = count ? malloc(count * sizeof *slots) : NULL;
    if (!slots)
        return -1;
    free(o->slots);
    o->slots = slots;
    o->slot_count = count;
    memset(slots, 0xff, count * sizeof *slots); /* NONE */
    for (uint32_t i = 0; i < o->file->material_count; i++)
        *find_slot(o, o->file->names[i]) = i;
    return 0;
}

/* The material of that name, a new one when there is none. Returns NONE when out of memory. */
static uint32_t find_material(struct obj *o, const char *name)
{
    uint32_t n = o->file->material_count;
    if ((n >= o->slot_count / 2 && grow_slots(o))
        || array_reserve(&o->use, (size_t)n + 1, &o->use_capacity, sizeof *o->use) < 0)
        return NONE;
    uint32_t *slot = find_slot(o, name);
    if (*slot != NONE)
        return *slot;
    if (scene_file_add_material(o->file, name, &PLAIN))
        return NONE;
    o->use[n] = 0;
    *slot = n;
    return n;
}

static int read_newmtl(struct obj *o, const char *path, const struct text_lines *t,
                       uint32_t *material)
{
    char *name = rest_of_line(t);
    uint32_t before = o->file->material_count;
    *material = name ? find_material(o, name) : NONE;
    free(name);
    if (*material == NONE)
        return out_of_memory(path);
    if (*material < before && !o->use[*material])
        return 0; /* defined again: what it says now is added to what it said */
    o->use[*material] = 0;
    o->file->places[*material].file = strdup(path);
    return o->file->places[*material].file ? 0 : out_of_memory(path);
}

/* Kd or Ke: three numbers, or one for all three. */
static int read_colour(struct obj *o, const char *path, struct text_lines *t, uint32_t material)
{
    int diffuse = t->word[1] == 'd';
    double value[3] = {0};
    uint32_t line = t->number;
    int count =
        read_numbers(t, path, diffuse ? "a diffuse colour (Kd)" : "an exitance (Ke)", 3, value);
    if (count < 0)
        return -1;
    if (count != 1 && count != 3)
        return report_error(path, line,
                            "a colour has %d numbers; give one per channel, three in all", count);
    if (material == NONE)
        return 0;
    struct RadMaterial *m = &o->file->materials[material];
    for (int k = 0; k < 3; k++)
        (diffuse ? m->reflectance : m->exitance)[k] = value[count == 3 ? k : 0];
    *(diffuse ? &o->file->places[material].diffuse_line
              : &o->file->places[material].emissive_line) = line;
    return 0;
}

static int read_library_text(struct obj *o, const char *path, struct text_lines t)
{
    uint32_t material = NONE;
    while (next_line(&t)) {
        if (!next_word(&t))
            continue;
        if (word_is(&t, "newmtl")
                ? read_newmtl(o, path, &t, &material)
                : (word_is(&t, "Kd") || word_is(&t, "Ke")) && read_colour(o, path, &t, material))
            return -1;
    }
    return 0;
}

/* mtllib: the rest of the line is one name, which may hold blanks, beside the OBJ file. */
static int read_library(struct obj *o, const struct text_lines *line)
{
    char *name = rest_of_line(line), *path = NULL;
    const char *slash = strrchr(o->path, '/');
    int result = -1;
    if (name) {
        size_t folder = slash && *name != '/' ? (size_t)(slash - o->path) + 1 : 0;
        path = malloc(folder + strlen(name) + 1);
        if (path) {
            memcpy(path, o->path, folder);
            strcpy(path + folder, name);
            size_t size;
            char *text = text_file_read_regular(path, &size);
            if (text)
                result = read_library_text(o, path, text_lines(text, size));
            else
                report_error(
                    o->path, line->number,
                    "cannot read the material library '%.*s': %s; put it there or correct the name",
                    QUOTED * 4, path, strerror(errno));
            free(text);
            o->libraries++;
        }
    }
    if (!path)
        out_of_memory(o->path);
    free(name);
    free(path);
    return result;
}

static int read_usemtl(struct obj *o, const struct text_lines *t)
{
    char *name = rest_of_line(t);
    uint32_t before = o->file->material_count;
    o->current = name ? find_material(o, name) : NONE;
    free(name);
    if (o->current == NONE)
        return out_of_memory(o->path);
    if (o->current >= before)
        o->use[o->current] = t->number;
    return 0;
}

/* ---- faces */

/* v x y z, v x y z w, or v x y z and a colour. */
static int read_vertex(struct obj *o, struct text_lines *t)
{
    double p[4] = {0};
    uint32_t line = t->number;
    int count = read_numbers(t, o->path, "a vertex", 4, p);
    if (count < 0)
        return -1;
    if (count != 3 && count != 4 && count != 6)
        return report_error(o->path, line, "a vertex with %d numbers; give x, y and z", count);
    if (count == 4) {
        for (int k = 0; k < 3; k++)
            p[k] /= p[3];
        if (!(fabs(p[0]) <= (double)FLT_MAX && fabs(p[1]) <= (double)FLT_MAX
              && fabs(p[2]) <= (double)FLT_MAX))
            return report_error(o->path, line,
                                "a vertex is not finite when divided by its w, %g; give x, y and z",
                                p[3]);
    }
    return scene_file_add_position(o->file, p) ? out_of_memory(o->path) : 0;
}

static int report_index(const struct obj *o, uint32_t line, int length, const char *index,
                        int relative)
{
    return report_error(o->path, line,
                        "vertex index %.*s is out of range: %zu vertices %s; correct the index",
                        length, index, o->file->position_count,
                        relative ? "come before this line" : "are in the file, counted from 1");
}

/* f: corners N, N/T, N//N or N/T/N, of which the first number is the vertex; from 1, or from -1
 * back. */
static int read_face(struct obj *o, struct text_lines *t)
{
    struct scene_file *f = o->file;
    const long seen = (long)f->position_count;
    uint32_t corners = 0, line = t->number;
    while (next_word(t)) {
        errno = 0;
        char *stop;
        long index = strtol(t->word, &stop, 10);
        if (stop == t->word || (stop < t->word_end && *stop != '/') || stop > t->word_end)
            return report_error(o->path, line,
                                "'%.*s' is not a corner of a face; write the number of a vertex",
                                quoted_length(t->word, t->word_end), t->word);
        if (index == 0 || index < -seen || index >= (long)UINT32_MAX)
            return report_index(o, line, quoted_length(t->word, stop), t->word, index < 0);
        o->ahead |= index > seen;
        if (scene_file_add_corner(f, (uint32_t)(index > 0 ? index - 1 : index + seen)))
            return out_of_memory(o->path);
        corners++;
    }
    if (!corners)
        return report_error(o->path, line,
                            "a face without corners; give three vertex numbers or more");
    if (o->current == NONE) {
        o->current = find_material(o, STAND_IN);
        if (o->current == NONE)
            return out_of_memory(o->path);
    }
    return scene_file_add_polygon(f, corners, o->current, line) ? out_of_memory(o->path) : 0;
}

/* ---- the file */

static int read_lines(struct obj *o, struct text_lines t)
{
    while (next_line(&t)) {
        int failed = 0;
        if (!next_word(&t))
            continue;
        if (word_is(&t, "v"))
            failed = read_vertex(o, &t);
        else if (word_is(&t, "f"))
            failed = read_face(o, &t);
        else if (word_is(&t, "usemtl"))
            failed = read_usemtl(o, &t);
        else if (word_is(&t, "mtllib"))
            failed = read_library(o, &t);
        else
            o->file->other += word_is(&t, "l") || word_is(&t, "p");
        if (failed)
            return -1;
    }
    return 0;
}

/* Is everything defined that was used before it was? */
static int check_uses(const struct obj *o)
{
    const struct scene_file *f = o->file;
    for (uint32_t i = 0; i < f->material_count; i++)
        if (o->use[i])
            return report_error(
                o->path, o->use[i],
                o->libraries
                    ? "material '%.*s' is in no material library of this file; define it there or "
                      "correct the name"
                    : "material '%.*s' is used, but no mtllib line names a material library; add "
                      "one",
                QUOTED, f->names[i]);
    size_t at = 0;
    for (uint32_t i = 0; i < f->polygon_count && o->ahead; at += f->sizes[i], i++)
        for (uint32_t j = 0; j < f->sizes[i]; j++)
            if (f->indices[at + j] >= f->position_count) {
                char index[16];
                int length =
                    snprintf(index, sizeof index, "%lu", (unsigned long)f->indices[at + j] + 1);
                return report_index(o, f->lines[i], length, index, 0);
            }
    return 0;
}

int read_obj(struct scene_file *file, const char *path)
{
    struct obj o = {.file = file, .path = path, .current = NONE};
    size_t size;
    char *text = text_file_read(path, &size);
    if (!text)
        return report_error(path, 0, "cannot read: %s; check the name", strerror(errno));
    int result;
    if (memchr(text, 0, size)) {
        result = report_error(path, 0, "not a text, hence no OBJ file; check the format");
    } else {
        int mark = size >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0; /* of UTF-8 */
        result =
            read_lines(&o, text_lines(text + mark, size - (size_t)mark)) || check_uses(&o) ? -1 : 0;
        if (!result && !file->polygon_count)
            result = report_error(path, 0,
                                  "there is no face in it; a scene needs one `f` line at least");
    }
    free(text);
    free(o.use);
    free(o.slots);
    return result;
}
