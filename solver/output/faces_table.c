/* faces_table.c - see faces_table.h.
 * SPDX-License-Identifier: MIT */
#include "output/faces_table.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "util/report.h"
#include "util/text_file.h"

enum { COLUMNS = 64 };

/* Split one line at its commas, in place; quotes are taken off, a doubled one is one. Returns how
 * many fields there are. */
static int split(char *line, char *field[COLUMNS])
{
    int n = 0;
    for (char *to = line; n < COLUMNS; line++) {
        int quoted = 0;
        field[n++] = to = line;
        for (; *line && (quoted || *line != ','); line++)
            if (*line != '"' || (quoted && line[1] == '"' && *++line))
                *to++ = *line;
            else
                quoted = !quoted;
        int last = !*line;
        *to = 0;
        if (last)
            break;
    }
    return n;
}

static int number(const char *text, double *value)
{
    char *end;
    *value = strtod(text, &end);
    return end != text && *end == 0 && isfinite(*value);
}

static int find(char *const *names, int count, const char *name)
{
    for (int i = 0; i < count; i++)
        if (strcmp(names[i], name) == 0)
            return i;
    return -1;
}

/* Cut off the next line; NULL at the end of the text. */
static char *next_line(char **text)
{
    char *line = *text, *end = strchr(line, '\n');
    if (!*line)
        return NULL;
    *text = end ? end + 1 : line + strlen(line);
    if (end)
        *end = 0;
    size_t n = strlen(line);
    if (n && line[n - 1] == '\r')
        line[n - 1] = 0;
    return line;
}

/* Where a quantity's columns stand, one per band. */
struct columns {
    int at[3];
    uint32_t bands; /* 0: there is none */
};

static struct columns find_bands(char *const *names, int count, const char *quantity)
{
    struct columns c = {.bands = 0};
    for (uint32_t k = 0; k < 3; k++) {
        char name[16];
        snprintf(name, sizeof name, "%s_%u", quantity, (unsigned)k);
        c.at[k] = find(names, count, name);
        c.bands += c.at[k] >= 0 && c.bands == k;
    }
    return c;
}

/* Room for a quantity of every row, where the table has it. Returns 0, or -1. */
static int room(double **values, const struct columns *c, const struct faces_table *t, size_t rows)
{
    if (c->bands != t->bands)
        return 0;
    *values = malloc((rows + 1) * t->bands * sizeof **values);
    return *values ? 0 : -1;
}

/* The row's values of a quantity, which must be `least` or more. Returns 0, or -1 after a
 * message. */
static int read_bands(const struct faces_table *t, double *values, const struct columns *c,
                      double least, const char *what, char *const *field, const char *path)
{
    for (uint32_t k = 0; values && k < t->bands; k++) {
        double *value = &values[(size_t)t->count * t->bands + k];
        if (!number(field[c->at[k]], value) || *value < least)
            return report_error(path, t->count + 2, "'%s' is no %s; write W/m2, %s",
                                field[c->at[k]], what, least < 0 ? "a finite number" : "0 or more");
    }
    return 0;
}

static int parse(struct faces_table *t, const char *path, size_t rows, uint32_t faces)
{
    char *text = t->text + text_mark(t->text), *field[COLUMNS], *line = next_line(&text);
    int columns = line ? split(line, field) : 0, face = find(field, columns, "face"),
        area = find(field, columns, "area"), material = find(field, columns, "material"),
        side = find(field, columns, "sides");
    const struct columns b = find_bands(field, columns, "B"), e = find_bands(field, columns, "E"),
                         error = find_bands(field, columns, "err");
    struct columns se = find_bands(field, columns, "se");
    se.bands = error.bands ? 0 : se.bands;
    t->bands = b.bands;
    if (face < 0 || area < 0 || !t->bands)
        return report_error(path, 1,
                            "the columns face, area and B_0 are not all there; give a table as "
                            "`radiosity solve --faces` writes it");
    t->face = malloc((rows + 1) * sizeof *t->face);
    t->area = malloc((rows + 1) * sizeof *t->area);
    t->material = material < 0 ? NULL : malloc((rows + 1) * sizeof *t->material);
    if (!t->face || !t->area || (material >= 0 && !t->material)
        || room(&t->radiosity, &b, t, rows) < 0 || room(&t->exitance, &e, t, rows) < 0
        || room(&t->deviation, &se, t, rows) < 0)
        return report_error(path, 0, "out of memory");
    for (; (line = next_line(&text)); t->count++) {
        uint32_t at = t->count + 2;
        int n = split(line, field);
        if (n != columns)
            return report_error(
                path, at, "%d columns where the first line has %d; correct the line", n, columns);
        double index;
        if (!number(field[face], &index) || !(index >= 0 && index < (faces ? faces : UINT32_MAX))
            || index != (uint32_t)index || (t->count && (uint32_t)index <= t->face[t->count - 1]))
            return faces ? report_error(path, at,
                                        "face '%s' is out of order, or none of the scene's %u; "
                                        "give a table of this scene",
                                        field[face], (unsigned)faces)
                         : report_error(path, at,
                                        "face '%s' is out of order, or no number; faces count "
                                        "from 0 and rise",
                                        field[face]);
        t->face[t->count] = (uint32_t)index;
        double sides = 1;
        if (!number(field[area], &t->area[t->count]) || !(t->area[t->count] >= 0))
            return report_error(path, at, "'%s' is no area; write m2, 0 or more", field[area]);
        if (side >= 0 && (!number(field[side], &sides) || (sides != 1 && sides != 2)))
            return report_error(path, at, "'%s' is no number of sides; write 1 or 2", field[side]);
        t->area[t->count] *= sides;
        if (read_bands(t, t->radiosity, &b, -HUGE_VAL, "radiosity", field, path) < 0
            || read_bands(t, t->exitance, &e, 0, "exitance", field, path) < 0
            || read_bands(t, t->deviation, &se, 0, "standard error", field, path) < 0)
            return -1;
        if (t->material)
            t->material[t->count] = field[material];
    }
    return t->count ? 0 : report_error(path, 0, "no face is in it; give a table of this scene");
}

int faces_table_read(struct faces_table *t, const char *path, uint32_t faces)
{
    size_t size, rows = 0;
    *t = (struct faces_table){0};
    t->text = text_file_need(path, &size);
    if (!t->text)
        return -1;
    for (const char *c = t->text; (c = strchr(c, '\n')); c++)
        rows++;
    int failed = strlen(t->text) != size ? report_error(
                     path, (uint32_t)rows + 1,
                     "a byte 0: this is no table; give one as `radiosity solve --faces` writes it")
                                         : parse(t, path, rows, faces);
    if (failed)
        faces_table_free(t);
    return failed;
}

void faces_table_free(struct faces_table *t)
{
    free(t->face);
    free(t->area);
    free(t->radiosity);
    free(t->exitance);
    free(t->deviation);
    free((void *)(uintptr_t)t->material);
    free(t->text);
    *t = (struct faces_table){0};
}
