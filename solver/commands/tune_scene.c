/* tune_scene.c - see tune_scene.h.
 *
 * The reference is of particles alone: beside them, paths lower the noise of face means by some
 * hundredths at the price of a quarter more rays (`radiosity reference cornell.obj`: .198 and .193
 * %; maze_8 .196 and .195 %). The same reference serves all solutions of a scene, so that its noise
 * hardly tells on which of two is better. What it adds to an error: where error e and noise n of
 * faces are both normal, the mean of |e + n| is the root of the sum of the squares of the means of
 * |e| and |n|.
 * SPDX-License-Identifier: MIT */
#include "commands/tune_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "util/device.h"
#include "util/report.h"

/* Particles traced first: of a scene of few faces, and of each face. */
enum { FIRST = 1 << 15, FIRST_OF_FACE = 64 };

/* By how much their number grows from look to look, at the least and at the most. */
static const double LEAST_MORE = 1.25, MOST_MORE = 8;

int tune_scene_open(struct tune_scene *t, const char *path, const struct scene_options *options,
                    int threads)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    *t = (struct tune_scene){.name = name};
    t->name_length = (int)(dot && dot != name ? (size_t)(dot - name) : strlen(name));
    return open_scene(&t->scene, path, options, threads);
}

void tune_scene_close(struct tune_scene *t)
{
    free(t->radiosity);
    t->radiosity = NULL;
    close_scene(&t->scene);
}

/* Until the noise is low enough. Returns 0, or -1 after an error of the device's. */
static int trace(struct tune_scene *t, RadReference reference, double noise,
                 struct RadReferenceReport *report)
{
    double first = FIRST_OF_FACE * (double)t->scene.report.faces;
    double count = first > FIRST ? first : FIRST;
    for (;;) {
        if (radTraceReference(reference, RAD_METHOD_PARTICLES, (uint64_t)count) < 0
            || radGetReferenceReport(reference, report) < 0)
            return -1;
        double ratio = report->noise[RAD_METHOD_PARTICLES] / noise;
        if (!(ratio > 1))
            return 0;
        count *= fmin(fmax(1.05 * ratio * ratio, LEAST_MORE), MOST_MORE);
    }
}

/* Both sides of a face that has two count. */
static double area_of(const struct tune_scene *t, uint32_t polygon)
{
    const struct RadMaterial *m =
        &t->scene.file.materials[t->scene.file.polygon_materials[polygon]];
    return (1 + m->two_sided) * radGetScenePolygonAreas(t->scene.scene)[polygon];
}

/* Values, light and noise of the reference. Returns 0, or -1 after an error of the device's, or
 * without one when out of memory. */
static int keep(struct tune_scene *t, RadReference reference)
{
    size_t polygons = t->scene.report.polygons;
    double *deviation = malloc((polygons + 1) * sizeof *deviation), spread = 0;
    t->radiosity = malloc((polygons * t->scene.report.bands + 1) * sizeof *t->radiosity);
    int failed = !deviation || !t->radiosity;
    for (uint32_t k = 0; !failed && k < t->scene.report.bands; k++) {
        double *b = t->radiosity + k * polygons;
        failed = radGetReferenceValues(reference, RAD_METHOD_PARTICLES, k, b, deviation) < 0;
        for (uint32_t i = 0; !failed && i < polygons; i++) {
            const struct RadMaterial *m =
                &t->scene.file.materials[t->scene.file.polygon_materials[i]];
            double area = area_of(t, i);
            t->reflected += area > 0 ? area * (b[i] - m->exitance[k]) : 0;
            spread += area * deviation[i];
        }
    }
    t->noise = spread * sqrt(2 / M_PI) / t->reflected;
    free(deviation);
    return failed ? -1 : 0;
}

int tune_scene_trace(struct tune_scene *t, double noise)
{
    struct RadReferenceReport report = {0};
    RadReference reference = radNewReference(t->scene.scene);
    int failed = !reference || trace(t, reference, noise, &report) < 0 || keep(t, reference) < 0;
    radReleaseReference(reference);
    t->particles = report.traced[RAD_METHOD_PARTICLES];
    if (failed)
        return report_unless_cancelled(t->scene.device, t->scene.path);
    if (!(t->reflected > 0))
        return report_error(t->scene.path, 0,
                            "no light is reflected, so that no error can be told; give a "
                            "scene with a lamp and surfaces that reflect");
    return 0;
}

double tune_scene_error(const struct tune_scene *t, RadSolution solution)
{
    size_t polygons = t->scene.report.polygons;
    double *irradiance = malloc((polygons + 1) * sizeof *irradiance), off = 0;
    if (!irradiance)
        report_error(t->scene.path, 0, "out of memory for the faces");
    for (uint32_t k = 0; irradiance && k < t->scene.report.bands; k++) {
        const double *b = t->radiosity + k * polygons;
        if (radGetPolygonValues(solution, k, NULL, irradiance) < 0) {
            report_device(t->scene.device, t->scene.path);
            free(irradiance);
            return NAN;
        }
        for (uint32_t i = 0; i < polygons; i++) {
            const struct RadMaterial *m =
                &t->scene.file.materials[t->scene.file.polygon_materials[i]];
            double area = area_of(t, i);
            if (area > 0)
                off += area * fabs(m->exitance[k] + m->reflectance[k] * irradiance[i] - b[i]);
        }
    }
    if (!irradiance)
        return NAN;
    free(irradiance);
    off /= t->reflected;
    return sqrt(fmax(0, off * off - t->noise * t->noise));
}
