/* plain_reading.c - see plain_reading.h.
 *
 * A file is read whole and cut into words; whatever does not fit leaves by `leave`, so that what
 * is left is plain.
 * [Wavefront Advanced Visualizer, appendix B1; MTL material format, v4.2; Turk 1994, The PLY
 * Polygon File Format; 3D Systems 1989, StereoLithography Interface Specification; Geomview manual]
 * SPDX-License-Identifier: MIT */
#include "scene/plain_reading.h"

#include <ctype.h>
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BYTES = 1 << 16, WORDS = 64, LINES = 4000, DEFINITIONS = 40, PROPERTIES = 16, NAME = 64 };

struct definition {
    char name[NAME];
    double reflectance[3], exitance[3];
};

static struct {
    jmp_buf out;
    const char *path;
    struct plain_scene *scene;
    double vertex[PLAIN_VERTICES][3];
    uint32_t vertices;
    struct definition defined[DEFINITIONS];
    int definitions;
} now;

/* Words of a line that has any. */
struct words {
    char *word[WORDS];
    int count;
};

struct lines {
    char *text;
    struct words line[LINES];
    int count;
};

static _Noreturn void leave(enum plain result)
{
    longjmp(now.out, (int)result + 1);
}

static void need(int sure)
{
    if (!sure)
        leave(UNSURE);
}

static void claim(int sound)
{
    if (!sound)
        leave(DAMAGED);
}

static size_t read_bytes(const char *path, char bytes[BYTES])
{
    FILE *f = fopen(path, "rb");
    need(f != NULL);
    size_t size = fread(bytes, 1, BYTES, f);
    fclose(f);
    need(size < BYTES);
    bytes[size] = 0;
    return size;
}

/* Cut a text into lines and words, in place, up to where it ends in 0. */
static void read_lines(struct lines *l, char *text)
{
    l->count = 0;
    if (strncmp(text, "\xEF\xBB\xBF", 3) == 0)
        text += 3;
    for (char *line = text, *end; line; line = end) {
        end = strchr(line, '\n');
        if (end)
            *end++ = 0;
        size_t size = strlen(line);
        if (size && line[size - 1] == '\r')
            line[size - 1] = 0;
        for (const char *c = line; *c; c++)
            need((*c == '\t' || (unsigned char)*c >= ' ') && *c != '\\');
        need(l->count < LINES);
        struct words *w = &l->line[l->count];
        w->count = 0;
        line[strcspn(line, "#")] = 0;
        for (char *rest = NULL, *word = strtok_r(line, " \t", &rest); word;
             word = strtok_r(NULL, " \t", &rest)) {
            need(w->count < WORDS);
            w->word[w->count++] = word;
        }
        l->count += w->count > 0;
    }
}

/* [+-] digits [. digits] [e [+-] digits] */
static double number(const char *word)
{
    const char *c = word + (*word == '+' || *word == '-');
    int digits = 0;
    for (; isdigit((unsigned char)*c); c++)
        digits++;
    if (*c == '.')
        for (c++; isdigit((unsigned char)*c); c++)
            digits++;
    need(digits > 0);
    if (*c == 'e' || *c == 'E') {
        c += 1 + (c[1] == '+' || c[1] == '-');
        need(isdigit((unsigned char)*c));
        while (isdigit((unsigned char)*c))
            c++;
    }
    need(*c == 0);
    double x = atof(word);
    need(fabs(x) <= (double)FLT_MAX);
    return x;
}

/* Up to `end` of the word, or to its own. */
static long whole(const char *word, char end)
{
    const char *c = word + (*word == '-');
    int digits = 0;
    for (; isdigit((unsigned char)*c); c++)
        digits++;
    need(digits > 0 && digits < 10 && (*c == 0 || *c == end));
    return atol(word);
}

static struct plain_face *new_face(void)
{
    need(now.scene->count < PLAIN_FACES);
    struct plain_face *f = &now.scene->face[now.scene->count++];
    *f = (struct plain_face){.reflectance = {.5, .5, .5}};
    return f;
}

static void add_vertex(const double p[3])
{
    need(now.vertices < PLAIN_VERTICES);
    memcpy(now.vertex[now.vertices++], p, 3 * sizeof *p);
}

static void add_corner(struct plain_face *f, long vertex)
{
    claim(vertex >= 0 && vertex < (long)now.vertices);
    need(f->corners < PLAIN_CORNERS);
    memcpy(f->corner[f->corners++], now.vertex[vertex], sizeof f->corner[0]);
}

/* ---- OBJ */

static void colour(double to[3], const struct words *w)
{
    need(w->count == 2 || w->count == 4);
    for (int k = 0; k < 3; k++)
        to[k] = number(w->word[w->count == 2 ? 1 : 1 + k]);
}

static void read_library(const char *name)
{
    static char text[BYTES], path[512];
    static struct lines l;
    const char *slash = strrchr(now.path, '/');
    snprintf(path, sizeof path, "%.*s%s", slash ? (int)(slash - now.path) + 1 : 0, now.path, name);
    const size_t size = read_bytes(path, text);
    need(strlen(text) == size);
    read_lines(&l, text);
    struct definition *d = NULL;
    for (int i = 0; i < l.count; i++) {
        const struct words *w = &l.line[i];
        if (strcmp(w->word[0], "newmtl") == 0) {
            need(w->count == 2 && strlen(w->word[1]) < NAME && now.definitions < DEFINITIONS);
            d = &now.defined[now.definitions++];
            *d = (struct definition){.reflectance = {.6, .6, .6}};
            strcpy(d->name, w->word[1]);
        } else if (strcmp(w->word[0], "Kd") == 0) {
            need(d != NULL);
            colour(d->reflectance, w);
        } else if (strcmp(w->word[0], "Ke") == 0) {
            need(d != NULL);
            colour(d->exitance, w);
        }
    }
}

/* What a name means behind so many definitions: the newest, or else the first that follows. */
static const struct definition *meaning(const char *name, int definitions)
{
    for (int i = definitions - 1; i >= 0; i--)
        if (strcmp(now.defined[i].name, name) == 0)
            return &now.defined[i];
    for (int i = definitions; i < now.definitions; i++)
        if (strcmp(now.defined[i].name, name) == 0)
            return &now.defined[i];
    claim(now.definitions == 0);
    leave(UNSURE); /* an empty library may be none */
}

static void read_obj_vertex(const struct words *w)
{
    double p[3];
    need(w->count == 4 || (w->count == 5 && number(w->word[4]) >= 1 && number(w->word[4]) <= 1));
    for (int k = 0; k < 3; k++)
        p[k] = number(w->word[1 + k]);
    add_vertex(p);
}

static void read_obj(struct lines *l)
{
    static const char *const others[] = {"o", "g", "s", "vn", "vt", "l", "p"};
    struct {
        const struct words *corners;
        const char *name; /* of its material, NULL: none */
        int definitions;  /* above its usemtl */
        long seen;        /* vertices above it */
    } face[PLAIN_FACES];
    int faces = 0, definitions = 0;
    const char *name = NULL, *library = NULL;
    for (int i = 0; i < l->count; i++) {
        const struct words *w = &l->line[i];
        if (strcmp(w->word[0], "v") == 0) {
            read_obj_vertex(w);
        } else if (strcmp(w->word[0], "f") == 0) {
            need(faces < PLAIN_FACES && w->count > 1);
            face[faces].corners = w;
            face[faces].name = name;
            face[faces].definitions = definitions;
            face[faces++].seen = (long)now.vertices;
        } else if (strcmp(w->word[0], "usemtl") == 0) {
            need(w->count == 2);
            name = w->word[1];
            definitions = now.definitions;
        } else if (strcmp(w->word[0], "mtllib") == 0) {
            need(w->count == 2 && !library);
            library = w->word[1];
            read_library(library);
        } else {
            int known = 0;
            for (size_t j = 0; j < sizeof others / sizeof *others; j++)
                known |= strcmp(w->word[0], others[j]) == 0;
            need(known);
        }
    }
    for (int i = 0; i < faces; i++) {
        struct plain_face *f = new_face();
        for (int j = 1; j < face[i].corners->count; j++) {
            long index = whole(face[i].corners->word[j], '/');
            add_corner(f, index < 0 ? face[i].seen + index : index - 1);
        }
        static const struct definition plain = {.reflectance = {.6, .6, .6}};
        const struct definition *d =
            face[i].name ? meaning(face[i].name, face[i].definitions) : &plain;
        memcpy(f->reflectance, d->reflectance, sizeof f->reflectance);
        memcpy(f->exitance, d->exitance, sizeof f->exitance);
    }
}

/* ---- OFF */

static void read_off(const struct lines *l)
{
    need(l->count > 1 && (strcmp(l->line[0].word[0], "OFF") == 0));
    const int same = l->line[0].count > 1; /* the counts stand there, too */
    char *const *counts = same ? &l->line[0].word[1] : l->line[1].word;
    need((same ? l->line[0].count - 1 : l->line[1].count) == 3);
    const long vertices = whole(counts[0], 0), faces = whole(counts[1], 0);
    const int first = same ? 1 : 2;
    claim(vertices >= 0 && faces >= 0 && first + vertices + faces <= l->count);
    need(first + vertices + faces == l->count);
    for (long i = 0; i < vertices; i++) {
        const struct words *w = &l->line[first + i];
        double p[3];
        need(w->count == 3);
        for (int k = 0; k < 3; k++)
            p[k] = number(w->word[k]);
        add_vertex(p);
    }
    for (long i = 0; i < faces; i++) {
        const struct words *w = &l->line[first + vertices + i];
        long corners = whole(w->word[0], 0);
        claim(corners >= 0 && corners < w->count);
        struct plain_face *f = new_face();
        for (long j = 1; j <= corners; j++)
            add_corner(f, whole(w->word[j], 0));
    }
}

/* ---- STL */

static double float_at(const unsigned char *from, int big)
{
    uint32_t bits = 0;
    for (int i = 0; i < 4; i++)
        bits |= (uint32_t)from[big ? 3 - i : i] << 8 * i;
    float x;
    memcpy(&x, &bits, sizeof x);
    claim(isfinite(x));
    return (double)x;
}

static void read_stl_bytes(const unsigned char *bytes, size_t size)
{
    claim(size >= 84);
    uint32_t count = 0;
    for (int i = 0; i < 4; i++)
        count |= (uint32_t)bytes[80 + i] << 8 * i;
    claim(84 + 50 * (uint64_t)count <= size);
    for (uint32_t i = 0; i < count; i++) {
        struct plain_face *f = new_face();
        for (f->corners = 0; f->corners < 3; f->corners++)
            for (int k = 0; k < 3; k++)
                f->corner[f->corners][k] =
                    float_at(bytes + 84 + 50 * (size_t)i + 12 + 12 * f->corners + 4 * k, 0);
    }
}

static void read_stl_text(const struct lines *l)
{
    static const char *const order[] = {"facet",  "outer",   "vertex",  "vertex",
                                        "vertex", "endloop", "endfacet"};
    need(l->count >= 2 && strcmp(l->line[0].word[0], "solid") == 0
         && strcmp(l->line[l->count - 1].word[0], "endsolid") == 0 && (l->count - 2) % 7 == 0);
    struct plain_face *f = NULL;
    for (int i = 1; i < l->count - 1; i++) {
        const struct words *w = &l->line[i];
        need(strcmp(w->word[0], order[(i - 1) % 7]) == 0);
        if ((i - 1) % 7 == 0)
            f = new_face();
        if (*w->word[0] != 'v')
            continue;
        need(w->count == 4);
        for (int k = 0; k < 3; k++)
            f->corner[f->corners][k] = number(w->word[1 + k]);
        f->corners++;
    }
}

/* ---- PLY */

struct value {
    int size, list;
    char kind; /* integer, unsigned, float */
    int axis;  /* of x, y, z; -1: passed over */
};

static struct value type_of(const char *name)
{
    static const struct {
        const char *name;
        struct value value;
    } known[] = {{"char", {1, 0, 'i', -1}},  {"uchar", {1, 0, 'u', -1}},
                 {"short", {2, 0, 'i', -1}}, {"ushort", {2, 0, 'u', -1}},
                 {"int", {4, 0, 'i', -1}},   {"uint", {4, 0, 'u', -1}},
                 {"float", {4, 0, 'f', -1}}, {"double", {8, 0, 'f', -1}}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(known[i].name, name) == 0)
            return known[i].value;
    leave(UNSURE);
}

struct ply {
    struct value vertex[PROPERTIES], count, index;
    int properties, axes;
    long vertices, faces; /* -1: not yet */
    int big, text;
    const unsigned char *next, *end;
};

static double take(struct ply *p, const struct value *v)
{
    claim(p->end - p->next >= v->size);
    uint64_t bits = 0;
    for (int i = 0; i < v->size; i++)
        bits |= (uint64_t)p->next[p->big ? v->size - 1 - i : i] << 8 * i;
    const unsigned char *from = p->next;
    p->next += v->size;
    if (v->kind == 'f' && v->size == 4)
        return v->axis < 0 ? 0 : float_at(from, p->big);
    if (v->kind == 'f') {
        double x;
        memcpy(&x, &bits, sizeof x);
        claim(v->axis < 0 || fabs(x) <= (double)FLT_MAX);
        return x;
    }
    const int sign = v->kind == 'i' && bits >> (8 * v->size - 1);
    return (double)bits - (sign ? ldexp(1, 8 * v->size) : 0);
}

/* Returns how many lines the header has. */
static int read_ply_header(struct ply *p, const struct lines *l)
{
    need(l->count > 2 && l->line[0].count == 1 && strcmp(l->line[0].word[0], "ply") == 0
         && l->line[1].count == 3 && strcmp(l->line[1].word[0], "format") == 0);
    const char *format = l->line[1].word[1];
    p->text = strcmp(format, "ascii") == 0;
    p->big = strcmp(format, "binary_big_endian") == 0;
    need(p->text || p->big || strcmp(format, "binary_little_endian") == 0);
    for (int i = 2; i < l->count; i++) {
        const struct words *w = &l->line[i];
        char *const *word = w->word;
        if (strcmp(word[0], "end_header") == 0) {
            need(p->vertices >= 0 && p->faces >= 0 && p->axes == 7 && p->index.size
                 && w->count == 1);
            return i + 1;
        }
        if (strcmp(word[0], "comment") == 0)
            continue;
        const int element = strcmp(word[0], "element") == 0;
        need(w->count >= 3 && (element || strcmp(word[0], "property") == 0));
        if (element) {
            const int face = strcmp(word[1], "face") == 0;
            need(w->count == 3 && (face ? p->vertices >= 0 && p->faces < 0 : p->vertices < 0)
                 && (face || strcmp(word[1], "vertex") == 0));
            *(face ? &p->faces : &p->vertices) = whole(word[2], 0);
            need(p->faces >= -1 && p->vertices >= 0);
        } else if (p->faces >= 0) {
            need(w->count == 5 && strcmp(word[1], "list") == 0 && !p->index.size
                 && strcmp(word[4], "vertex_indices") == 0);
            p->count = type_of(word[2]);
            p->index = type_of(word[3]);
            need(p->count.kind != 'f' && p->index.kind != 'f');
        } else {
            need(w->count == 3 && p->vertices >= 0 && p->properties < PROPERTIES);
            struct value *v = &p->vertex[p->properties++];
            *v = type_of(word[1]);
            if (strlen(word[2]) == 1 && strchr("xyz", *word[2])) {
                v->axis = *word[2] - 'x';
                need(!(p->axes >> v->axis & 1));
                p->axes |= 1 << v->axis;
            }
        }
    }
    leave(UNSURE);
}

static void read_ply_text(const struct ply *p, const struct lines *l, int first)
{
    claim(first + p->vertices + p->faces <= l->count);
    need(first + p->vertices + p->faces == l->count);
    for (int i = 0; i < l->count - first; i++) {
        const struct words *w = &l->line[first + i];
        if (i < p->vertices) {
            double at[3] = {0};
            need(w->count == p->properties);
            for (int j = 0; j < p->properties; j++)
                if (p->vertex[j].axis >= 0)
                    at[p->vertex[j].axis] = number(w->word[j]);
            add_vertex(at);
            continue;
        }
        long corners = whole(w->word[0], 0);
        claim(corners >= 0 && corners < w->count);
        need(corners == w->count - 1);
        struct plain_face *f = new_face();
        for (long j = 1; j <= corners; j++)
            add_corner(f, whole(w->word[j], 0));
    }
}

static void read_ply_bytes(struct ply *p)
{
    for (long i = 0; i < p->vertices; i++) {
        double at[3] = {0};
        for (int j = 0; j < p->properties; j++) {
            double x = take(p, &p->vertex[j]);
            if (p->vertex[j].axis >= 0)
                at[p->vertex[j].axis] = x;
        }
        add_vertex(at);
    }
    for (long i = 0; i < p->faces; i++) {
        const double corners = take(p, &p->count);
        claim(corners >= 0);
        struct plain_face *f = new_face();
        for (double j = 0; j < corners; j++)
            add_corner(f, (long)take(p, &p->index));
    }
}

static void read_ply(char *text, size_t size, struct lines *l)
{
    struct ply p = {.vertices = -1, .faces = -1};
    static char header[BYTES];
    static const char last[] = "\nend_header\n";
    char *end = strstr(text, last);
    need(end != NULL);
    const size_t length = (size_t)(end - text) + sizeof last - 1;
    memcpy(header, text, length);
    header[length] = 0;
    read_lines(l, header);
    int first = read_ply_header(&p, l);
    if (p.text) {
        need(strlen(text) == size);
        read_lines(l, text);
        read_ply_text(&p, l, first);
    } else {
        p.next = (const unsigned char *)text + length;
        p.end = (const unsigned char *)text + size;
        read_ply_bytes(&p);
    }
}

/* ---- */

enum plain plain_reading(struct plain_scene *scene, const char *path)
{
    static char text[BYTES];
    static struct lines l;
    const char *end = strrchr(path, '.');
    now.path = path;
    now.scene = scene;
    now.vertices = 0;
    now.definitions = 0;
    scene->count = 0;
    const int left = setjmp(now.out);
    if (left)
        return (enum plain)(left - 1);
    const size_t size = read_bytes(path, text);
    const int is_text = strlen(text) == size;
    if (strcmp(end, ".ply") == 0) {
        read_ply(text, size, &l);
    } else if (strcmp(end, ".stl") == 0 && !(is_text && strncmp(text, "solid", 5) == 0)) {
        need(strncmp(text, "solid", 5) != 0);
        read_stl_bytes((const unsigned char *)text, size);
    } else {
        need(is_text);
        read_lines(&l, text);
        if (strcmp(end, ".obj") == 0)
            read_obj(&l);
        else if (strcmp(end, ".off") == 0)
            read_off(&l);
        else if (strcmp(end, ".stl") == 0)
            read_stl_text(&l);
        else
            leave(UNSURE);
    }
    return PLAIN;
}
