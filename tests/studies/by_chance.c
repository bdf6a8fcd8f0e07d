/* by_chance.c - what faces radiate by particles alone or by paths alone, from so many of them: what
 * a user would take instead of links, held against them at equal cost.
 *
 *     by_chance SCENE particles|paths COUNT FACES.csv
 *
 * COUNT is of particles from the emitters or of paths from the surfaces, a few more where the
 * method comes in sets (radTraceReference). FACES.csv: face, area, E_k, B_k and se_k, as cell_error
 * and `radiosity error` read them. Prints names and values, line by line: seconds (of the
 * processor, one thread, without reading and writing), rays, memory_mb (the peak of the process).
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include "scene/open_scene.h"
#include "util/atomic_file.h"
#include "util/clock.h"
#include "util/device.h"
#include "util/report.h"

static const char *const method_names[2] = {"particles", "paths"};

/* values: B of each band, then its standard error, [2 * bands][polygons]. */
static void print_faces(FILE *out, const struct open_scene *s, const double *values)
{
    uint32_t bands = s->report.bands, polygons = s->report.polygons;
    const double *areas = radGetScenePolygonAreas(s->scene);
    const struct RadMaterial *materials = radGetSceneMaterials(s->scene);
    fputs("face,area", out);
    for (uint32_t k = 0; k < 3 * bands; k++)
        fprintf(out, ",%s_%u", k < bands ? "E" : k < 2 * bands ? "B" : "se", (unsigned)(k % bands));
    for (uint32_t i = 0; i < polygons; i++) {
        const struct RadMaterial *m = &materials[s->file.polygon_materials[i]];
        fprintf(out, "\n%u,%.12g", (unsigned)i, (1 + m->two_sided) * areas[i]);
        for (uint32_t k = 0; k < bands; k++)
            fprintf(out, ",%.12g", areas[i] > 0 ? m->exitance[k] : 0);
        for (size_t k = 0; k < 2 * (size_t)bands; k++)
            fprintf(out, ",%.9g", values[k * polygons + i]);
    }
    putc('\n', out);
}

static int write_faces(const char *path, const struct open_scene *s, const double *values)
{
    struct atomic_file file;
    if (atomic_open(&file, path) < 0)
        return -1;
    print_faces(file.stream, s, values);
    return atomic_commit(&file);
}

/* Returns 0, or -1 after a message. */
static int trace(const struct open_scene *s, RadReference reference, enum RadMethod method,
                 uint64_t count, const char *path)
{
    uint32_t bands = s->report.bands, polygons = s->report.polygons;
    struct RadReferenceReport report;
    double *values = malloc((2 * (size_t)bands * polygons + 1) * sizeof *values);
    if (!values)
        return report_error(path, 0, "out of memory for the table of faces");
    double start = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
    int failed = radTraceReference(reference, method, count) < 0;
    for (uint32_t k = 0; k < bands && !failed; k++)
        failed = radGetReferenceValues(reference, method, k, values + (size_t)k * polygons,
                                       values + (size_t)(bands + k) * polygons)
                 < 0;
    double took = clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
    failed = failed || radGetReferenceReport(reference, &report) < 0;
    failed = failed ? report_device(s->device, s->path) : write_faces(path, s, values);
    free(values);
    if (failed)
        return -1;
    struct rusage use;
    getrusage(RUSAGE_SELF, &use);
    printf("seconds %.6g\nrays %llu\nmemory_mb %.4g\n", took,
           (unsigned long long)report.rays[method], (double)use.ru_maxrss / 1024);
    return 0;
}

int main(int words, char **word)
{
    int method = 0;
    while (method < 2 && (words < 3 || strcmp(word[2], method_names[method]) != 0))
        method++;
    char *end = NULL;
    double count = words == 5 ? strtod(word[3], &end) : 0;
    if (method == 2 || words != 5 || *end || !(count >= 1 && count <= 1e15)) {
        fputs("usage: by_chance SCENE particles|paths COUNT FACES.csv\n", stderr);
        return 2;
    }
    const struct scene_options how = {.quiet = 1};
    struct open_scene scene;
    if (open_scene(&scene, word[1], &how, 1) < 0)
        return 1;
    RadReference reference = radNewReference(scene.scene);
    int failed = reference
                     ? trace(&scene, reference, (enum RadMethod)method, (uint64_t)count, word[4])
                     : report_device(scene.device, word[1]);
    radReleaseReference(reference);
    close_scene(&scene);
    return failed != 0;
}
