/* read_nastran.c - see read_meshes.h: Nastran bulk data, GRID and shells in small, large and free
 * field.
 *
 * A card is eight fields of 8 characters behind its name, with a `*` four of 16, with a comma
 * fields of any width; further lines continue it. Points may be in coordinate systems of their own
 * (nastran_systems.h), which may come behind them: they are placed at the end. What is INCLUDEd has
 * no lines of its own in what is told at the end, as a scene has those of one file. [NX Nastran
 * quick reference guide, bulk data entries]
 * SPDX-License-Identifier: MIT */
#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "scene/mesh_parts.h"
#include "scene/nastran_include.h"
#include "scene/nastran_systems.h"
#include "scene/read_meshes.h"
#include "scene/read_numbers.h"
#include "scene/text_lines.h"
#include "util/report.h"
#include "util/text_file.h"

enum { LINE_FIELDS = 8, STAR_FIELDS = 4, FIELDS = 2 * LINE_FIELDS, WIDEST = 32 };
enum { DEPTH = 16, FILES = 1000 }; /* that include each other, and in all; chosen */

struct card {
    char name[WIDEST], field[FIELDS][WIDEST]; /* without blanks; shortened to what fits */
    int fields;                               /* so many have been given, empty ones too */
    int room;                                 /* so many its lines hold: there the next begins */
    uint32_t line;
};

struct nastran {
    struct mesh mesh;
    struct card card; /* the one under way: line 0 when there is none */
    struct nastran_systems systems;
    int depth; /* of the file under way: 0 the scene's own */
    int files;
    struct mesh_note skins; /* faces of cards that are not read */
    int quiet;
};

/* Of this card, for what is told when all is read. */
static uint32_t line_kept(const struct nastran *a)
{
    return a->depth ? 0 : a->card.line;
}

static void copy_field(char to[WIDEST], const char *from, const char *end)
{
    size_t n = 0;
    for (; from < end; from++)
        if (!isspace((unsigned char)*from) && *from && n < WIDEST - 1)
            to[n++] = *from;
    to[n] = '\0';
}

static int line_room(const char *first)
{
    return strchr(first, '*') ? STAR_FIELDS : LINE_FIELDS;
}

/* The fields of a line, its first one apart; a tab goes to the next eighth column. */
static int line_fields(const char *line, const char *end, char first[WIDEST],
                       char field[LINE_FIELDS][WIDEST])
{
    char flat[81] = "", *comma = memchr(line, ',', (size_t)(end - line));
    int count = 0;
    if (comma) {
        copy_field(first, line, comma);
        const int most = line_room(first);
        while (comma && count < most) {
            const char *from = comma + 1;
            comma = memchr(from, ',', (size_t)(end - from));
            copy_field(field[count++], from, comma ? comma : end);
        }
        return count;
    }
    size_t n = 0;
    for (; line < end && n < 80; line++) {
        do
            flat[n++] = *line == '\t' ? ' ' : *line;
        while (*line == '\t' && n % 8 && n < 80);
    }
    copy_field(first, flat, flat + (n < 8 ? n : 8));
    const size_t width = 64 / (size_t)line_room(first);
    for (size_t at = 8; at < n && at < 72; at += width)
        copy_field(field[count++], flat + at, flat + (at + width < n ? at + width : n));
    return count;
}

/* 1.5, 1.5e-3, 1.5d-3 and 1.5-3 are numbers; an empty field is 0. */
static int field_number(const struct nastran *a, int i, const char *what, double *x)
{
    const char *from = i < a->card.fields ? a->card.field[i] : "";
    char plain[WIDEST + 1], *stop;
    size_t n = 0;
    int digits = 0, power = 0;
    for (; *from; from++) {
        const char c = (char)tolower((unsigned char)*from);
        if ((c == '+' || c == '-') && digits && !power)
            plain[n++] = 'e', power = 1;
        plain[n++] = c == 'd' ? 'e' : c;
        power |= c == 'd' || c == 'e';
        digits |= isdigit((unsigned char)c) || c == '.';
    }
    plain[n] = '\0';
    *x = strtod(plain, &stop);
    if (*stop || !is_finite_float(*x))
        return report_error(a->mesh.path, a->card.line,
                            "'%s' where %s of %s belongs; write a finite number", a->card.field[i],
                            what, a->card.name);
    return 0;
}

static int field_whole(const struct nastran *a, int i, const char *what, int64_t *number)
{
    double x;
    if (field_number(a, i, what, &x))
        return -1;
    if (!is_whole(x, 1e15) || x <= 0)
        return report_error(a->mesh.path, a->card.line,
                            "%g where %s of %s belongs; write a whole number above 0", x, what,
                            a->card.name);
    *number = (int64_t)x;
    return 0;
}

/* Field 1, the coordinate system that points are given in; 0 where it is empty. */
static int field_system(const struct nastran *a, int64_t *system)
{
    double x;
    if (field_number(a, 1, "a system", &x))
        return -1;
    if (!is_whole(x, 1e15))
        return report_error(a->mesh.path, a->card.line,
                            "%g where a system of %s belongs; write a whole number, 0 or more", x,
                            a->card.name);
    *system = (int64_t)x;
    return 0;
}

static int read_grid(struct nastran *a)
{
    int64_t number, system;
    double p[3];
    if (field_whole(a, 0, "the number", &number) || field_system(a, &system)
        || field_number(a, 2, "x", &p[0]) || field_number(a, 3, "y", &p[1])
        || field_number(a, 4, "z", &p[2]))
        return -1;
    if (a->card.fields < 3)
        return report_error(a->mesh.path, a->card.line,
                            "GRID %lld has no coordinates; the file is cut or damaged, export it "
                            "again",
                            (long long)number);
    const char by_default = !*a->card.field[1];
    if (!by_default && !system)
        return mesh_define_node(&a->mesh, number, p, a->card.line);
    const struct nastran_point point = {.number = number,
                                        .system = system,
                                        .at = {p[0], p[1], p[2]},
                                        .line = line_kept(a),
                                        .by_default = by_default};
    return nastran_point_add(&a->systems, &point) ? scene_file_no_memory(a->mesh.path) : 0;
}

/* GRDSET: points that name no system are in this one. */
static int read_defaults(struct nastran *a)
{
    return field_system(a, &a->systems.default_system);
}

static int add_system(struct nastran *a, const struct nastran_system *s)
{
    switch (nastran_system_add(&a->systems, s)) {
    case NASTRAN_DONE:
        return 0;
    case NASTRAN_TWICE:
        return report_error(a->mesh.path, a->card.line,
                            "coordinate system %lld is defined twice; the file is damaged, export "
                            "it again",
                            (long long)s->number);
    default:
        return scene_file_no_memory(a->mesh.path);
    }
}

/* CORD2R, C or S: the number, the system that the points are in, A at the origin, B on the z axis,
 * C in the plane of x and z. */
static int read_system_of_points(struct nastran *a)
{
    struct nastran_system s = {.kind = a->card.name[5], .line = line_kept(a)};
    if (field_whole(a, 0, "the number", &s.number) || field_system(a, &s.within))
        return -1;
    for (int k = 0; k < 9; k++)
        if (field_number(a, 2 + k, "a coordinate", &s.at[k / 3][k % 3]))
            return -1;
    return add_system(a, &s);
}

/* CORD1R, C or S: A, B and C are points of the mesh; a card may have two systems. */
static int read_system_of_grids(struct nastran *a)
{
    for (int from = 0; from == 0 || (from == 4 && a->card.fields > 4 && *a->card.field[4]);
         from += 4) {
        struct nastran_system s = {.kind = a->card.name[5], .by_grids = 1, .line = line_kept(a)};
        if (field_whole(a, from, "the number", &s.number))
            return -1;
        for (int k = 0; k < 3; k++)
            if (field_whole(a, from + 1 + k, "a point", &s.grid[k]))
                return -1;
        if (add_system(a, &s))
            return -1;
    }
    return 0;
}

static int is_one_of(const char *name, const char *const *names)
{
    for (; *names; names++)
        if (strcasecmp(name, *names) == 0)
            return 1;
    return 0;
}

static int read_shell(struct nastran *a, uint32_t corners)
{
    static const char *const curved[] = {"CTRIA6", "CQUAD8", "CQUAD", NULL};
    int64_t number, property;
    uint32_t material;
    char name[40];
    double given;
    if (field_whole(a, 0, "the number", &number))
        return -1;
    property = number; /* which an empty field stands for */
    if (a->card.fields > 1 && *a->card.field[1] && field_whole(a, 1, "the property", &property))
        return -1;
    const int length = snprintf(name, sizeof name, "PSHELL %lld", (long long)property);
    if (mesh_material(&a->mesh, name, (size_t)length, MESH_GREY, &material))
        return -1;
    if (a->card.fields > 2 + (int)corners && *a->card.field[2 + corners]
        && is_one_of(a->card.name, curved))
        mesh_note(&a->mesh.curved, line_kept(a));
    for (uint32_t i = 0; i < corners; i++) {
        if (field_number(a, 2 + (int)i, "a corner", &given)
            || field_whole(a, 2 + (int)i, "a corner", &number) || mesh_corner(&a->mesh, number))
            return -1;
    }
    return mesh_polygon(&a->mesh, corners, material, line_kept(a));
}

/* What has been gathered of a card is all of it. */
static int finish_card(struct nastran *a)
{
    static const char *const triangles[] = {"CTRIA3", "CTRIA6", "CTRIAR", NULL},
                             *const quads[] = {"CQUAD4", "CQUAD8", "CQUADR",
                                               "CQUAD",  "CSHEAR", NULL},
                             *const by_points[] = {"CORD2R", "CORD2C", "CORD2S", NULL},
                             *const by_grids[] = {"CORD1R", "CORD1C", "CORD1S", NULL},
                             *const volumes[] = {"CTETRA", "CHEXA", "CPENTA", "CPYRAM", NULL},
                             *const skins[] = {"CHBDYE", "CHBDYG",  "CHBDYP", "CTRIAX",
                                               "CQUADX", "CTRIAX6", NULL},
                             *const lines[] = {"CBAR",  "CBEAM",  "CROD",   "CONROD", "CTUBE",
                                               "CBUSH", "CELAS1", "CELAS2", "PLOTEL", NULL};
    const struct card *c = &a->card;
    int result = 0;
    if (!c->line)
        return 0;
    if (strcasecmp(c->name, "GRID") == 0)
        result = read_grid(a);
    else if (strcasecmp(c->name, "GRDSET") == 0)
        result = read_defaults(a);
    else if (is_one_of(c->name, by_points))
        result = read_system_of_points(a);
    else if (is_one_of(c->name, by_grids))
        result = read_system_of_grids(a);
    else if (is_one_of(c->name, triangles))
        result = read_shell(a, 3);
    else if (is_one_of(c->name, quads))
        result = read_shell(a, 4);
    else if (is_one_of(c->name, volumes))
        mesh_note(&a->mesh.volumes, line_kept(a));
    else if (is_one_of(c->name, skins))
        mesh_note(&a->skins, line_kept(a));
    else
        a->mesh.file->other += (uint32_t)is_one_of(c->name, lines);
    a->card.line = 0;
    return result;
}

/* Returns 1 at the end of the data. */
static int read_line(struct nastran *a, const char *line, const char *end, uint32_t number)
{
    const char *dollar = memchr(line, '$', (size_t)(end - line));
    char first[WIDEST], field[LINE_FIELDS][WIDEST];
    end = dollar ? dollar : end;
    const char *word = line;
    while (word < end && is_blank(*word))
        word++;
    if (word == end)
        return 0;
    const int count = line_fields(line, end, first, field);
    struct card *c = &a->card;
    if (!*first || *first == '+' || *first == '*') { /* the card goes on */
        for (; c->line && c->fields < c->room && c->fields < FIELDS; c->fields++)
            *c->field[c->fields] = '\0'; /* the last line left it out */
        c->room += c->room < FIELDS ? line_room(first) : 0;
        for (int i = 0; i < count && c->line && c->fields < FIELDS; i++)
            memcpy(c->field[c->fields++], field[i], WIDEST);
        return 0;
    }
    if (finish_card(a))
        return -1;
    if (strncasecmp(first, "ENDDATA", 7) == 0)
        return 1;
    if (*first == '=')
        return report_error(a->mesh.path, number,
                            "this line repeats the card before it (=), which is not read; write "
                            "all cards out");
    *c = (struct card){.fields = count, .room = line_room(first), .line = number};
    char *star = strchr(first, '*');
    if (star)
        *star = '\0';
    memcpy(c->name, first, WIDEST);
    memcpy(c->field, field, (size_t)count * WIDEST);
    return 0;
}

/* Where BEGIN BULK ends: what is before it says how to compute. */
static size_t bulk_begins(const char *text, size_t size)
{
    for (size_t at = 0; at < size;) {
        const char *end = memchr(text + at, '\n', size - at);
        const size_t next = end ? (size_t)(end - text) + 1 : size;
        size_t word = at;
        while (word < next && is_blank(text[word]))
            word++;
        if (next - word >= 10 && strncasecmp(text + word, "BEGIN", 5) == 0
            && is_blank(text[word + 5]))
            return next;
        at = next;
    }
    return 0;
}

static int read_text(struct nastran *a, const char *text, size_t size);

/* All that the file has, in place of the line. */
static int follow(struct nastran *a, const char *name, const char **end, const char *text_end,
                  uint32_t number)
{
    const char *const path = a->mesh.path;
    struct nastran_include to;
    if (finish_card(a))
        return -1;
    if (a->depth == DEPTH || ++a->files > FILES)
        return report_error(path, number,
                            "INCLUDE goes on and on; is it a circle? %d files may include each "
                            "other, %d in all",
                            DEPTH, FILES);
    if (nastran_include(path, number, name, end, text_end, &to))
        return -1;
    a->mesh.path = to.path;
    a->depth++;
    const int result = read_text(a, to.text, to.size);
    a->depth--;
    a->mesh.path = path;
    free(to.path);
    free(to.text);
    return result;
}

/* Returns 1 behind ENDDATA. */
static int read_text(struct nastran *a, const char *text, size_t size)
{
    const char *const end = text + size, *line = text;
    uint32_t number = 1;
    int result = 0;
    if (memchr(text, 0, size))
        return report_error(a->mesh.path, 0,
                            "not a text; export it as Nastran bulk data (not OP2)");
    line += text_mark(text);
    const size_t begins = bulk_begins(text, size);
    line = begins ? text + begins : line;
    for (const char *c = text; c < line; c++)
        number += *c == '\n';
    while (line < end && !result) {
        size_t broken;
        const char *last = line_break((char *)(uintptr_t)line, end, &broken);
        const char *const name = nastran_is_include(line, last);
        result = name ? follow(a, name, &last, end, number) : read_line(a, line, last, number);
        if (name) { /* which may end on a further line */
            for (const char *c = line; c < last; c++)
                number += *c == '\n';
            last = line_break((char *)(uintptr_t)last, end, &broken);
        }
        line = last + (broken ? broken : 1);
        number++;
    }
    const int failed = result < 0 || finish_card(a);
    if (begins && !result && !failed && !a->quiet)
        report_warning(a->mesh.path, number - 1,
                       "ends without ENDDATA, which belongs behind BEGIN BULK: is it cut off?");
    return failed ? -1 : result;
}

int read_nastran(struct scene_file *f, const char *path, char *text, size_t size, int quiet)
{
    struct nastran a = {.mesh = {.file = f, .path = path}, .quiet = quiet};
    int failed = read_text(&a, text, size) < 0 || nastran_systems_place(&a.systems, &a.mesh);
    if (!failed && a.skins.count && !quiet)
        report_warning(path, a.skins.first,
                       "%u surfaces of heat (CHBDYG and its like) or of revolution (CTRIAX) are "
                       "passed over; those that are to be faces belong in CTRIA3 and CQUAD4",
                       (unsigned)a.skins.count);
    failed = failed || mesh_finish(&a.mesh, quiet);
    nastran_systems_free(&a.systems);
    mesh_free(&a.mesh);
    return failed ? -1 : 0;
}
