/* faces_reference.c - see faces_reference.h. B of a face is E + rho H with H the mean over all of
 * it, as in faces_csv.c.
 * SPDX-License-Identifier: MIT */
#include "study/faces_reference.h"

#include <math.h>
#include <stdlib.h>

#include "util/report.h"

int faces_reference_read(struct faces_table *r, const char *path, const struct open_scene *scene)
{
    if (faces_table_read(r, path, scene->report.polygons) < 0)
        return -1;
    if (r->bands == scene->report.bands)
        return 0;
    report_error(path, 1, "%u bands of B, but the scene has %u; give a table of this scene",
                 (unsigned)r->bands, (unsigned)scene->report.bands);
    faces_table_free(r);
    return -1;
}

double faces_reference_error(const struct faces_table *r, const struct open_scene *scene,
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
            double reference = r->radiosity[(size_t)i * r->bands + k];
            off += r->area[i] * fabs(b - reference);
            all += r->area[i] * reference;
        }
    }
    double error = !irradiance ? (double)NAN : all > 0 ? off / all : 0;
    free(irradiance);
    return error;
}
