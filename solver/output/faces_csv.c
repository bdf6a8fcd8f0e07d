/* faces_csv.c - see faces_csv.h.
 *
 * Every column is a mean over the whole face, so B = E + rho H holds in each row, to rounding;
 * the tree's radiosity is the mean over what no solid stands on, which may be more.
 * SPDX-License-Identifier: MIT */
#include "output/faces_csv.h"

#include <stdio.h>
#include <stdlib.h>

#include "util/atomic_file.h"
#include "util/csv_text.h"
#include "util/report.h"

/* Sums over the faces that one polygon became. */
struct total {
    double area, irradiance[3];
};

/* Does a face have two sides? Areas are of one, and who adds up light has to know it. */
static int has_two_sided(const struct solution *s)
{
    uint32_t i = 0;
    while (i < s->surfaces.polygon_count
           && !s->surfaces.materials[s->surfaces.polygon_materials[i]].two_sided)
        i++;
    return i < s->surfaces.polygon_count;
}

static void write_header(FILE *out, uint32_t bands, int measured, int sides)
{
    static const char *const quantity[] = {"E", "rho", "H", "B", "err", "se"};
    fputs("face,material,area", out);
    for (int q = 0; q < (measured ? 6 : 4); q++)
        for (uint32_t k = 0; k < bands; k++)
            fprintf(out, ",%s_%u", quantity[q], (unsigned)k);
    fputs(sides ? ",sides\n" : "\n", out);
}

/* errors: [2][bands][polygons], error and deviation; NULL: none. sides: tell how many it has. */
static void write_row(FILE *out, const struct solution *s, uint32_t i, const struct total *t,
                      const double *errors, int sides)
{
    uint32_t material = s->surfaces.polygon_materials[i], bands = s->tree.bands;
    const struct RadMaterial *m = &s->surfaces.materials[material];
    int dropped = !(t->area > 0);
    fprintf(out, "%u,", (unsigned)i);
    write_csv_text(out, s->surfaces.material_names[material]);
    fprintf(out, ",%.12g", s->surfaces.polygon_areas[i]);
    for (uint32_t k = 0; k < bands; k++)
        fprintf(out, ",%.12g", dropped ? 0 : m->exitance[k]);
    for (uint32_t k = 0; k < bands; k++)
        fprintf(out, ",%.12g", dropped ? 0 : m->reflectance[k]);
    for (uint32_t k = 0; k < bands; k++)
        fprintf(out, ",%.12g", dropped ? 0 : t->irradiance[k] / t->area);
    for (uint32_t k = 0; k < bands; k++)
        fprintf(out, ",%.12g",
                dropped ? 0 : m->exitance[k] + m->reflectance[k] * t->irradiance[k] / t->area);
    for (size_t k = 0; errors && k < 2 * (size_t)bands; k++)
        fprintf(out, ",%.6g", errors[k * s->surfaces.polygon_count + i]);
    fputs(!sides ? "\n" : m->two_sided ? ",2\n" : ",1\n", out);
}

/* Returns NULL when out of memory. */
static double *errors_of(const struct solution *s, RadSolution measured)
{
    size_t polygons = s->surfaces.polygon_count, bands = s->tree.bands;
    double *errors = malloc((2 * bands * polygons + 1) * sizeof *errors);
    for (uint32_t k = 0; errors && k < bands; k++)
        radGetPolygonErrors(measured, k, errors + k * polygons, errors + (bands + k) * polygons);
    return errors;
}

int faces_csv_write(const char *path, const struct solution *s, RadSolution measured)
{
    uint32_t polygons = s->surfaces.polygon_count, bands = s->tree.bands;
    struct total *total = calloc((size_t)polygons + 1, sizeof *total);
    double *errors = measured ? errors_of(s, measured) : NULL;
    struct atomic_file file;
    if (!total || (measured && !errors) || atomic_open(&file, path)) {
        if (!total || (measured && !errors))
            report_error(path, 0, "out of memory for the table of faces");
        free(total);
        free(errors);
        return -1;
    }
    for (uint32_t i = 0; i < s->surfaces.face_count; i++) {
        struct total *t = &total[s->surfaces.faces[i].input];
        size_t element = s->tree.face_element[i];
        double area = s->tree.elements[element].area;
        t->area += area;
        for (uint32_t k = 0; k < bands; k++)
            t->irradiance[k] += area * s->tree.irradiance[element * bands + k];
    }
    const int sides = has_two_sided(s);
    write_header(file.stream, bands, measured != NULL, sides);
    for (uint32_t i = 0; i < polygons; i++)
        write_row(file.stream, s, i, &total[i], errors, sides);
    free(total);
    free(errors);
    return atomic_commit(&file);
}
