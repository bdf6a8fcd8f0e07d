/* read_stl.c - see read_shapes.h: STL, triangles each with its own corners, as text or as bytes.
 *
 * Bytes: 80 of a title, the number of triangles, 50 bytes for each. A text starts with `solid`, as
 * do some titles: what has the size that it counts, or a byte 0, is no text.
 * SPDX-License-Identifier: MIT */
#include <string.h>
#include <strings.h>

#include "scene/read_numbers.h"
#include "scene/read_shapes.h"
#include "scene/text_lines.h"
#include "util/report.h"

enum { TITLE = 80, HEAD = TITLE + 4, TRIANGLE = 50, NORMAL = 12 };

static int add_corner(struct scene_file *f, const char *path, const double p[3])
{
    return scene_file_add_position(f, p)
                   || scene_file_add_corner(f, (uint32_t)f->position_count - 1)
               ? scene_file_no_memory(path)
               : 0;
}

static int read_bytes(struct scene_file *f, const char *path, const char *text, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        const char *from = text + HEAD + (size_t)TRIANGLE * i + NORMAL;
        for (int j = 0; j < 3; j++) {
            double p[3];
            for (int k = 0; k < 3; k++, from += 4) {
                p[k] = typed_number(from, 'F', 4, 0);
                if (!is_finite_float(p[k]))
                    return report_error(path, 0,
                                        "triangle %u has a corner that is not finite; correct its "
                                        "coordinates",
                                        (unsigned)i);
            }
            if (add_corner(f, path, p))
                return -1;
        }
        if (scene_file_add_polygon(f, 3, 0, 0))
            return scene_file_no_memory(path);
    }
    return 0;
}

/* Both a group and an object: what the rest of the line calls it. */
static int name_solid(struct scene_file *f, const struct text_lines *t)
{
    char *name = rest_of_line(t);
    int failed = !name || scene_file_use_group(f, name, strlen(name))
                 || scene_file_use_object(f, name, strlen(name));
    free(name);
    return failed;
}

/* solid, then facets of a loop of three vertices, then endsolid; several of these. */
static int read_text(struct scene_file *f, const char *path, struct text_lines t)
{
    static const char *const order[] = {"facet",  "outer",   "vertex",  "vertex",
                                        "vertex", "endloop", "endfacet"};
    enum { STEPS = sizeof order / sizeof *order };
    int step = 0, open = 0;
    while (next_line(&t)) {
        if (!next_word(&t))
            continue;
        if (step == 0 && word_is_any_case(&t, open ? "endsolid" : "solid")) {
            open = !open;
            if (open && name_solid(f, &t))
                return scene_file_no_memory(path);
            continue;
        }
        uint32_t line = t.number;
        if (!open || !word_is_any_case(&t, order[step]))
            return report_error(
                path, line, "'%.*s' where '%s' belongs; the file is damaged, export it again",
                quoted_length(t.word, t.word_end), t.word, open ? order[step] : "solid");
        double p[3];
        if (*order[step] == 'v') {
            int count = read_numbers(&t, path, "a vertex", 3, p);
            if (count < 0)
                return -1;
            if (count != 3)
                return report_error(path, line, "a vertex with %d numbers; give x, y and z", count);
            if (add_corner(f, path, p))
                return -1;
        }
        if (++step == STEPS) {
            step = 0;
            if (scene_file_add_polygon(f, 3, 0, line))
                return scene_file_no_memory(path);
        }
    }
    f->single_precision = !t.finer;
    return open ? report_error(path, t.number,
                               "ends before endsolid; the file is cut, export it again")
                : 0;
}

int read_stl(struct scene_file *f, const char *path, char *text, size_t size, int quiet)
{
    uint32_t count = size >= HEAD ? (uint32_t)bytes_number(text + TITLE, 4, 0) : 0;
    uint64_t needed = HEAD + (uint64_t)TRIANGLE * count;
    size_t blank = strspn(text, "\xEF\xBB\xBF \t\r\n"); /* or a mark of UTF-8 */
    int result;
    f->single_precision = 1;
    if (needed != size && strncasecmp(text + blank, "solid", 5) == 0 && !memchr(text, 0, size)) {
        result = read_text(f, path, text_lines(text, size));
        if (!result && !quiet)
            warn_of_cut(path, 0, text, size);
    } else if (size < HEAD || needed > size) {
        return report_error(path, 0,
                            "counts %u triangles, which take %llu bytes, but has %zu; the file is "
                            "cut or damaged, export it again",
                            (unsigned)count, (unsigned long long)needed, size);
    } else {
        if (needed < size && !quiet)
            report_warning(path, 0, "%zu bytes more than its %u triangles take are passed over",
                           size - (size_t)needed, (unsigned)count);
        result = read_bytes(f, path, text, count);
    }
    if (!result && !f->polygon_count)
        result = report_error(path, 0, "there is no triangle in it; export it again");
    return result;
}
