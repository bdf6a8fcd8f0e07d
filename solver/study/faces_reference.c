/* faces_reference.c - see faces_reference.h. B of a face is E + rho H with H the mean over all of
 * it, as in faces_csv.c.
 * SPDX-License-Identifier: MIT */
#include "study/faces_reference.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "util/report.h"
#include "util/text_file.h"

enum { COLUMNS = 64 };

/* Split one line at its commas, in place; quotes are taken off. Returns how many fields there
 * are. */
static int split(char *line, char *field[COLUMNS])
{
    int n = 0;
    for (char *to = line; n < COLUMNS; line++) {
        int quoted = 0;
        field[n++] = to = line;
        for (; *line && (quoted || *line != ','); line++)
            if (*line == '"')
                quoted = !quoted;
            else
                *to++ = *line;
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

static int parse(struct faces_reference *r, const char *path, char *text,
                 const struct open_scene *scene)
{
    static const char *const bands[3] = {"B_0", "B_1", "B_2"};
    char *field[COLUMNS], *line = next_line(&text);
    int columns = line ? split(line, field) : 0, face = find(field, columns, "face"),
        area = find(field, columns, "area"), band[3];
    for (uint32_t k = 0; k < 3; k++) {
        band[k] = find(field, columns, bands[k]);
        r->bands += band[k] >= 0 && r->bands == k;
    }
    if (face < 0 || area < 0 || !r->bands)
        return report_error(path, 1,
                            "the columns face, area and B_0 are not all there; give a table as "
                            "`radiosity solve --faces` writes it");
    if (r->bands != scene->report.bands)
        return report_error(path, 1,
                            "%u bands of B, but the scene has %u; give a table of this scene",
                            (unsigned)r->bands, (unsigned)scene->report.bands);
    for (uint32_t number_of_line = 2; (line = next_line(&text)); number_of_line++) {
        int n = split(line, field);
        if (n != columns)
            return report_error(path, number_of_line, "%d columns where the first line has %d", n,
                                columns);
        double index;
        if (!number(field[face], &index) || !(index >= 0 && index < scene->report.polygons)
            || index != (uint32_t)index || (r->count && (uint32_t)index <= r->face[r->count - 1]))
            return report_error(
                path, number_of_line,
                "face '%s' is out of order, or none of the scene's %u; give a table of this scene",
                field[face], (unsigned)scene->report.polygons);
        r->face[r->count] = (uint32_t)index;
        double a;
        if (!number(field[area], &a) || !(a >= 0))
            return report_error(path, number_of_line, "'%s' is no area", field[area]);
        r->area[r->count] = a;
        for (uint32_t k = 0; k < r->bands; k++)
            if (!number(field[band[k]], &r->value[(size_t)r->count * r->bands + k]))
                return report_error(path, number_of_line, "'%s' is no radiosity", field[band[k]]);
        r->count++;
    }
    return r->count ? 0 : report_error(path, 0, "no face is in it; give a table of this scene");
}

int faces_reference_read(struct faces_reference *r, const char *path,
                         const struct open_scene *scene)
{
    size_t size;
    char *text = text_file_read(path, &size);
    *r = (struct faces_reference){0};
    if (!text)
        return report_error(path, 0, "cannot read: %s; check the name", strerror(errno));
    r->face = malloc(((size_t)scene->report.polygons + 1) * sizeof *r->face);
    r->area = malloc(((size_t)scene->report.polygons + 1) * sizeof *r->area);
    r->value = malloc(((size_t)scene->report.polygons + 1) * 3 * sizeof *r->value);
    int failed = !r->face || !r->area || !r->value ? report_error(path, 0, "out of memory")
                                                   : parse(r, path, text, scene);
    free(text);
    if (failed)
        faces_reference_free(r);
    return failed;
}

double faces_reference_error(const struct faces_reference *r, const struct open_scene *scene,
                             RadSolution solution)
{
    const struct RadMaterial *materials = radGetSceneMaterials(scene->scene);
    const double *area = radGetScenePolygonAreas(scene->scene);
    double *irradiance = malloc(((size_t)scene->report.polygons + 1) * sizeof *irradiance), off = 0,
           all = 0;
    for (uint32_t k = 0; irradiance && k < r->bands; k++) {
        if (radGetPolygonValues(solution, k, NULL, irradiance) < 0) {
            free(irradiance);
            return NAN;
        }
        for (uint32_t i = 0; i < r->count; i++) {
            uint32_t face = r->face[i];
            const struct RadMaterial *m = &materials[scene->file.polygon_materials[face]];
            double b = area[face] > 0 ? m->exitance[k] + m->reflectance[k] * irradiance[face] : 0;
            double reference = r->value[(size_t)i * r->bands + k];
            off += r->area[i] * fabs(b - reference);
            all += r->area[i] * reference;
        }
    }
    double error = !irradiance ? (double)NAN : all > 0 ? off / all : 0;
    free(irradiance);
    return error;
}

void faces_reference_free(struct faces_reference *r)
{
    free(r->face);
    free(r->area);
    free(r->value);
    *r = (struct faces_reference){0};
}
