/* obj_scan.c - see obj_scan.h.
 *
 * Invariant: the text keeps its length and its line breaks; what Assimp shall not see becomes
 * spaces. Continued lines (a backslash before the break) are joined by the same means.
 * SPDX-License-Identifier: MIT */
#include "scene/obj_scan.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "util/report.h"
#include "util/text_file.h"

/* One line of a text, its words split off one by one. */
struct cursor {
    char *next, *end;       /* where the next line starts, where the text ends */
    char *line, *line_end;  /* this line without its break */
    char *word, *word_end;  /* the last word taken */
    uint32_t number, after; /* this line's number, the next one's */
};

static int blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

static int next_line(struct cursor *c)
{
    if (c->next >= c->end)
        return 0;
    c->line = c->word_end = c->next;
    c->number = c->after;
    for (;;) {
        char *stop = memchr(c->next, '\n', (size_t)(c->end - c->next));
        c->line_end = stop ? stop : c->end;
        c->next = stop ? stop + 1 : c->end;
        c->after++;
        char *last = c->line_end;
        while (last > c->line && last[-1] == '\r')
            last--;
        if (!stop || last == c->line || last[-1] != '\\' || *c->line == '#')
            return 1;
        for (char *p = last - 1; p <= stop; p++)
            *p = ' ';
    }
}

static int next_word(struct cursor *c)
{
    c->word = c->word_end;
    while (c->word < c->line_end && blank(*c->word))
        c->word++;
    c->word_end = c->word;
    while (c->word_end < c->line_end && !blank(*c->word_end))
        c->word_end++;
    return c->word < c->word_end && *c->word != '#';
}

static int word_is(const struct cursor *c, const char *name)
{
    size_t size = strlen(name);
    return (size_t)(c->word_end - c->word) == size && memcmp(c->word, name, size) == 0;
}

static void erase(char *from, const char *to)
{
    for (; from < to; from++)
        *from = ' ';
}

/* The rest of the line without the blanks around it: names may hold spaces. */
static char *rest_of_line(const struct cursor *c)
{
    const char *from = c->word_end, *to = c->line_end;
    while (from < to && blank(*from))
        from++;
    while (to > from && blank(to[-1]))
        to--;
    return strndup(from, (size_t)(to - from));
}

/* The word as a number; 0 when it is none. The text ends with a 0 byte, so strtod stops. */
static int number(const struct cursor *c, double *value)
{
    char *stop;
    *value = strtod(c->word, &stop);
    return stop == c->word_end;
}

static int out_of_memory(const char *path)
{
    return report_error(path, 0, "out of memory; use a smaller scene or a larger machine");
}

/* `count` of finite numbers on the rest of the line; -1 after an error. */
static int numbers(struct cursor *c, const char *path, const char *what)
{
    int count = 0;
    while (next_word(c)) {
        double value;
        int length = (int)(c->word_end - c->word);
        if (!number(c, &value))
            return report_error(path, c->number, "'%.*s' is not a number in %s; write a decimal number", length, c->word, what);
        if (!isfinite(value) || fabs(value) > (double)FLT_MAX)
            return report_error(path, c->number, "%s is not finite ('%.*s'); write a finite number", what, length, c->word);
        count++;
    }
    return count;
}

static struct obj_material *add_material(struct obj_scan *s, char *name, const char *file, uint32_t line)
{
    if (s->material_count == s->material_capacity) {
        uint32_t capacity = s->material_capacity ? 2 * s->material_capacity : 32;
        struct obj_material *larger = realloc(s->materials, capacity * sizeof *larger);
        if (!larger)
            return NULL;
        s->materials = larger;
        s->material_capacity = capacity;
    }
    struct obj_material *m = &s->materials[s->material_count];
    *m = (struct obj_material){.name = name, .file = strdup(file), .line = line};
    if (!m->file)
        return NULL;
    s->material_count++;
    return m;
}

static int scan_mtl_text(struct obj_scan *s, const char *path, struct cursor c)
{
    struct obj_material *current = NULL;
    while (next_line(&c)) {
        if (!next_word(&c))
            continue;
        if (word_is(&c, "newmtl")) {
            char *name = rest_of_line(&c);
            if (!name || !(current = add_material(s, name, path, c.number))) {
                free(name);
                return out_of_memory(path);
            }
        } else if (word_is(&c, "Kd") || word_is(&c, "Ke")) {
            int diffuse = c.word[1] == 'd';
            uint32_t line = c.number;
            int count = numbers(&c, path, diffuse ? "a diffuse colour (Kd)" : "an exitance (Ke)");
            if (count < 0)
                return -1;
            if (count != 1 && count != 3)
                return report_error(path, line, "a colour has %d numbers; give one per channel, three in all", count);
            if (current && diffuse)
                current->diffuse_line = line;
            else if (current)
                current->emissive_line = line;
        }
    }
    return 0;
}

static int scan_mtl(struct obj_scan *s, const char *obj_path, uint32_t line, const char *name)
{
    const char *slash = strrchr(obj_path, '/');
    size_t folder = slash && *name != '/' ? (size_t)(slash - obj_path) + 1 : 0, size;
    char *path = malloc(folder + strlen(name) + 1);
    if (!path)
        return out_of_memory(obj_path);
    memcpy(path, obj_path, folder);
    strcpy(path + folder, name);
    char *text = text_file_read(path, &size);
    int result;
    if (!text)
        result = report_error(obj_path, line, "cannot read the material library '%s': %s; put it there or correct the name",
                              path, strerror(errno));
    else
        result = scan_mtl_text(s, path, (struct cursor){.next = text, .end = text + size, .after = 1});
    free(text);
    free(path);
    return result;
}

/* The corners of a face: N, N/T, N//M or N/T/M. All but N is erased: we use neither normals nor
 * texture, and a bad index there shall not cost the face. */
static int scan_face(struct obj_scan *s, struct cursor *c, const char *path, long seen, long total)
{
    int corners = 0;
    while (next_word(c)) {
        char *stop;
        errno = 0;
        long index = strtol(c->word, &stop, 10);
        int length = (int)(c->word_end - c->word);
        if (stop == c->word || (stop < c->word_end && *stop != '/') || stop > c->word_end)
            return report_error(path, c->number, "'%.*s' is not a corner of a face; write the number of a vertex", length, c->word);
        if (index == 0 || index > total || index < -seen)
            return report_error(path, c->number, "vertex index %.*s is out of range: %ld vertices %s; correct the index",
                                (int)(stop - c->word), c->word, index < 0 ? seen : total,
                                index < 0 ? "come before this line" : "are in the file, counted from 1");
        erase(stop, c->word_end);
        corners++;
    }
    if (!corners)
        return report_error(path, c->number, "a face without corners; give three vertex numbers or more");
    if (s->faces == s->face_lines_capacity) {
        uint32_t capacity = s->face_lines_capacity ? 2 * s->face_lines_capacity : 4096;
        uint32_t *larger = realloc(s->face_line, capacity * sizeof *larger);
        if (!larger)
            return out_of_memory(path);
        s->face_line = larger;
        s->face_lines_capacity = capacity;
    }
    s->face_line[s->faces++] = c->number;
    return 0;
}

/* First pass: vertices and libraries, so that the second can check what refers to them. */
static int scan_definitions(struct obj_scan *s, const char *path, struct cursor c, long *vertices)
{
    while (next_line(&c)) {
        if (!next_word(&c))
            continue;
        if (word_is(&c, "v")) {
            uint32_t line = c.number;
            int count = numbers(&c, path, "a vertex");
            if (count < 0)
                return -1;
            if (count != 3 && count != 4 && count != 6)
                return report_error(path, line, "a vertex with %d numbers; give x, y and z", count);
            ++*vertices;
        } else if (word_is(&c, "mtllib")) {
            char *name = rest_of_line(&c);
            int failed = !name ? out_of_memory(path) : scan_mtl(s, path, c.number, name);
            free(name);
            if (failed)
                return -1;
        }
    }
    return 0;
}

static int scan_uses(struct obj_scan *s, const char *path, struct cursor c, long total)
{
    long seen = 0;
    while (next_line(&c)) {
        if (!next_word(&c) || word_is(&c, "mtllib")) {
            continue;
        } else if (word_is(&c, "v")) {
            seen++;
        } else if (word_is(&c, "f")) {
            if (scan_face(s, &c, path, seen, total))
                return -1;
        } else if (word_is(&c, "usemtl")) {
            char *name = rest_of_line(&c);
            int known = name && obj_scan_material(s, name);
            if (!known)
                report_error(path, c.number, s->material_count ? "material '%s' is in no material library of this file; define it there or correct the name"
                                                               : "material '%s' is used, but no mtllib line names a material library; add one",
                             name ? name : "");
            free(name);
            if (!known)
                return -1;
        } else {
            s->other += word_is(&c, "l") || word_is(&c, "p");
            erase(c.line, c.line_end);
        }
    }
    return 0;
}

/* Assimp 5.2 sees neither that .5 is a number nor what an indented line says: write 0.5 on vertex
 * lines, and drop indents. Returns 0 or -1. */
static int spell_out(struct obj_scan *s)
{
    size_t more = 1, i, n = 0;
    int vertex = 0, line_start = 1;
    char *text;
    for (i = 0; i + 1 < s->size; i++)
        more += blank(s->text[i]) && s->text[i + 1] == '.';
    text = malloc(s->size + more);
    if (!text)
        return -1;
    for (i = 0; i < s->size; i++) {
        char c = s->text[i];
        if (line_start && blank(c) && c != '\r')
            continue;
        if (line_start) {
            vertex = c == 'v';
            line_start = 0;
        }
        if (c == '.' && vertex && blank(s->text[i - 1]))
            text[n++] = '0';
        text[n++] = c;
        if (c == '\n')
            line_start = 1;
    }
    text[n] = 0;
    free(s->text);
    s->text = text;
    s->size = n;
    return 0;
}

int obj_scan_read(struct obj_scan *scan, const char *path)
{
    *scan = (struct obj_scan){0};
    scan->text = text_file_read(path, &scan->size);
    if (!scan->text)
        return report_error(path, 0, "cannot read: %s; check the name", strerror(errno));
    int failed;
    long vertices = 0;
    if (memchr(scan->text, 0, scan->size)) {
        failed = report_error(path, 0, "not a text, hence no OBJ file; check the format");
    } else if (spell_out(scan) < 0) {
        failed = out_of_memory(path);
    } else {
        if (scan->size >= 3 && memcmp(scan->text, "\xEF\xBB\xBF", 3) == 0)
            erase(scan->text, scan->text + 3);
        struct cursor start = {.next = scan->text, .end = scan->text + scan->size, .after = 1};
        failed = scan_definitions(scan, path, start, &vertices) || scan_uses(scan, path, start, vertices);
        if (!failed && !scan->faces)
            failed = report_error(path, 0, "there is no face in it; a scene needs one `f` line at least");
    }
    if (failed)
        obj_scan_free(scan);
    return failed ? -1 : 0;
}

void obj_scan_free_text(struct obj_scan *scan)
{
    free(scan->text);
    scan->text = NULL;
    scan->size = 0;
}

void obj_scan_free(struct obj_scan *scan)
{
    for (uint32_t i = 0; i < scan->material_count; i++) {
        free(scan->materials[i].name);
        free(scan->materials[i].file);
    }
    free(scan->materials);
    free(scan->face_line);
    free(scan->text);
    *scan = (struct obj_scan){0};
}

const struct obj_material *obj_scan_material(const struct obj_scan *scan, const char *name)
{
    for (uint32_t i = 0; i < scan->material_count; i++)
        if (strcmp(scan->materials[i].name, name) == 0)
            return &scan->materials[i];
    return NULL;
}
