/* read_obj.c - see read_obj.h.
 *
 * Read once, from top to bottom. Vertices and materials may be used before they are defined; what
 * is still undefined at the end is reported with the line that used it first.
 * SPDX-License-Identifier: MIT */
#include "scene/read_obj.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/materials_by_name.h"
#include "scene/read_numbers.h"
#include "scene/text_lines.h"
#include "util/report.h"
#include "util/text_file.h"

#define NONE UINT32_MAX /* no material */

struct obj {
    struct scene_file *file;
    const char *path;
    struct materials_by_name materials;
    uint32_t current; /* material of the faces to come */
    int ahead;        /* some face uses a vertex that comes after it */
};

/* mtllib or usemtl: the rest of the line is a name, which may hold blanks. */
static int read_name(struct obj *o, const struct text_lines *t)
{
    int library = *t->word == 'm';
    char *name = rest_of_line(t);
    if (!name)
        return scene_file_no_memory(o->path);
    int result = library ? materials_library(&o->materials, name, t->number)
                         : materials_use(&o->materials, name, t->number, &o->current);
    free(name);
    return result;
}

/* g or o: the rest of the line is a name; of several groups on a line together. */
static int read_part(struct obj *o, const struct text_lines *t)
{
    int group = *t->word == 'g';
    char *name = rest_of_line(t);
    int failed =
        !name
        || (group ? scene_file_use_group : scene_file_use_object)(o->file, name, strlen(name));
    free(name);
    return failed ? scene_file_no_memory(o->path) : 0;
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
        if (p[3] < 1 || p[3] > 1)
            materials_assume(&o->materials, WEIGHT, o->path, line, "", NULL);
        for (int k = 0; k < 3; k++)
            p[k] /= p[3];
        if (!is_finite_float(p[0]) || !is_finite_float(p[1]) || !is_finite_float(p[2]))
            return report_error(o->path, line,
                                "a vertex is not finite when divided by its w, %g; give x, y and z",
                                p[3]);
    }
    return scene_file_add_position(o->file, p) ? scene_file_no_memory(o->path) : 0;
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
            return scene_file_no_memory(o->path);
        corners++;
    }
    if (!corners)
        return report_error(o->path, line,
                            "a face without corners; give three vertex numbers or more");
    if (o->current == NONE && materials_stand_in(&o->materials, line, &o->current))
        return -1;
    return scene_file_add_polygon(f, corners, o->current, line) ? scene_file_no_memory(o->path) : 0;
}

/* ---- the file */

/* What changes neither faces nor materials, or the look of a picture alone. */
static int is_passed_over(const struct text_lines *t)
{
    static const char *const words[] = {"vn",     "vt",     "vp",         "s",        "mg",
                                        "usemap", "maplib", "bevel",      "lod",      "l",
                                        "p",      "deg",    "cstype",     "c_interp", "d_interp",
                                        "ctech",  "stech",  "shadow_obj", "trace_obj"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (word_is(t, words[i]))
            return 1;
    return 0;
}

static int read_lines(struct obj *o, struct text_lines t)
{
    while (next_line(&t)) {
        int failed = 0;
        if (!next_word(&t))
            continue;
        if (word_is(&t, "v"))
            failed = read_vertex(o, &t);
        else if (word_is(&t, "f") || word_is(&t, "fo")) /* so version 2.11 wrote it */
            failed = read_face(o, &t);
        else if (word_is(&t, "usemtl") || word_is(&t, "mtllib"))
            failed = read_name(o, &t);
        else if (word_is(&t, "g") || word_is(&t, "o"))
            failed = read_part(o, &t);
        else if (!is_passed_over(&t))
            materials_assume(&o->materials, UNKNOWN_LINE, o->path, t.number, t.word, t.word_end);
        o->file->other += word_is(&t, "l") || word_is(&t, "p");
        if (failed)
            return -1;
    }
    return 0;
}

/* Is every vertex there that a face used before it came? */
static int check_indices(const struct obj *o)
{
    const struct scene_file *f = o->file;
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

int read_obj(struct scene_file *file, const char *path, int quiet)
{
    struct obj o = {
        .file = file, .path = path, .materials = {.file = file, .path = path}, .current = NONE};
    size_t size;
    char *text = text_file_need(path, &size);
    if (!text)
        return -1;
    int result;
    if (memchr(text, 0, size))
        result = report_error(path, 0, "not a text, hence no OBJ file; check the format");
    else
        result = read_lines(&o, text_lines(text, size)) || materials_check(&o.materials)
                         || check_indices(&o)
                     ? -1
                     : 0;
    if (!result && !file->polygon_count)
        result =
            report_error(path, 0, "there is no face in it; a scene needs one `f` line at least");
    if (!result && !quiet)
        materials_warn(&o.materials);
    materials_free(&o.materials);
    free(text);
    return result;
}
