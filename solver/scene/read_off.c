/* read_off.c - see read_shapes.h: OFF, counts, a line for each vertex, a line for each face.
 *
 * Behind x, y and z, and behind a face's corners, normals and colours may stand.
 * SPDX-License-Identifier: MIT */
#include <ctype.h>
#include <string.h>

#include "scene/read_numbers.h"
#include "scene/read_shapes.h"
#include "scene/text_lines.h"
#include "util/report.h"

/* The next line that has words. Returns 0, or -1 at the end. */
static int next_words(struct text_lines *t)
{
    while (next_line(t))
        if (next_word(t)) {
            t->word_end = t->word; /* taken again by whoever reads */
            return 0;
        }
    return -1;
}

static int take_count(struct text_lines *t, uint32_t *count)
{
    double x;
    if (!next_word(t) || !word_number(t, &x) || !is_whole(x, 0x1p32))
        return -1;
    *count = (uint32_t)x;
    return 0;
}

static int cut(const char *path, const struct text_lines *t, const char *what, uint32_t i,
               uint32_t count)
{
    return report_error(path, t->number,
                        "ends before %s %u of the %u that it counts; the file is cut or damaged, "
                        "export it again",
                        what, (unsigned)i, (unsigned)count);
}

static int read_counts(const char *path, struct text_lines *t, uint32_t *vertices, uint32_t *faces)
{
    static const char *const known[] = {"OFF", "COFF", "NOFF", "CNOFF", "STOFF", "STCNOFF"};
    int found = 0;
    if (next_words(t))
        return report_error(path, 0, "empty, hence no OFF file; check the format");
    next_word(t);
    if (isalpha((unsigned char)*t->word)) {
        for (size_t i = 0; i < sizeof known / sizeof *known; i++)
            found |= word_is(t, known[i]);
        if (!found)
            return report_error(path, t->number,
                                "'%.*s' is no kind of OFF file that is read here; export it as OFF",
                                quoted_length(t->word, t->word_end), t->word);
        struct text_lines rest = *t;
        if (!next_word(&rest) && next_words(t))
            return cut(path, t, "vertex", 0, 0);
    } else {
        t->word_end = t->word;
    }
    return take_count(t, vertices) || take_count(t, faces)
               ? report_error(path, t->number,
                              "no numbers of vertices and faces; the file is damaged or binary, "
                              "export it again as text")
               : 0;
}

static int read_vertex(struct scene_file *f, const char *path, struct text_lines *t, uint32_t i)
{
    double p[3];
    for (int k = 0; k < 3; k++)
        if (!next_word(t) || !word_number(t, &p[k]) || !is_finite_float(p[k]))
            return report_error(path, t->number,
                                "vertex %u has no three finite numbers; give x, y and z",
                                (unsigned)i);
    return scene_file_add_position(f, p) ? scene_file_no_memory(path) : 0;
}

static int read_face(struct scene_file *f, const char *path, struct text_lines *t, uint32_t i)
{
    uint32_t corners, index;
    if (take_count(t, &corners))
        return report_error(path, t->number,
                            "face %u has no number of corners; the file is damaged, export it "
                            "again",
                            (unsigned)i);
    for (uint32_t j = 0; j < corners; j++) {
        if (!next_word(t))
            return report_error(path, t->number,
                                "face %u has %u corners of the %u that it counts; the file is cut "
                                "or damaged, export it again",
                                (unsigned)i, (unsigned)j, (unsigned)corners);
        int length = quoted_length(t->word, t->word_end);
        const char *word = t->word;
        t->word_end = t->word;
        if (take_count(t, &index) || index >= f->position_count)
            return report_error(path, t->number,
                                "face %u names vertex %.*s, but there are %zu, counted from 0; "
                                "correct the index",
                                (unsigned)i, length, word, f->position_count);
        if (scene_file_add_corner(f, index))
            return scene_file_no_memory(path);
    }
    return scene_file_add_polygon(f, corners, 0, t->number) ? scene_file_no_memory(path) : 0;
}

int read_off(struct scene_file *f, const char *path, char *text, size_t size, int quiet)
{
    struct text_lines t = text_lines(text, size);
    uint32_t vertices, faces;
    if (memchr(text, 0, size))
        return report_error(path, 0, "not a text; export it as OFF text");
    if (read_counts(path, &t, &vertices, &faces))
        return -1;
    for (uint32_t i = 0; i < vertices; i++)
        if (next_words(&t))
            return cut(path, &t, "vertex", i, vertices);
        else if (read_vertex(f, path, &t, i))
            return -1;
    for (uint32_t i = 0; i < faces; i++)
        if (next_words(&t))
            return cut(path, &t, "face", i, faces);
        else if (read_face(f, path, &t, i))
            return -1;
    if (next_words(&t) == 0)
        return report_error(path, t.number,
                            "more lines than its %u vertices and %u faces take; correct the counts",
                            (unsigned)vertices, (unsigned)faces);
    if (!quiet)
        warn_of_cut(path, t.number, text, size);
    return faces ? 0 : report_error(path, 0, "there is no face in it; a scene needs one at least");
}
