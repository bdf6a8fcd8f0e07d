/* check_oracles.c - every oracle of examples/oracles: its releases decide alike, its error falls with its threshold, and
 * thermal keeps its promise.
 *
 * References: closed forms where there are some, else path tracing (path_reference.h).
 * ORACLES_TABLE=SCENE... build/tests/check_oracles prints instead what each oracle costs and how wrong it is, at its
 * default parameters: the table in examples/oracles/README.md.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "builtin.h"
#include "make_scene.h"
#include "oracles.h"
#include "path_reference.h"
#include "solve.h"

/* Outside a test, too. */
static void must(int done, const char *what)
{
    if (!done) {
        fprintf(stderr, "%s failed\n", what);
        abort();
    }
}

/* Solve with an oracle; settings end with NULL. */
static void solve_with(struct solve *s, const struct scene *scene, const char *oracle, char *const *settings)
{
    struct solve_options options = { .tolerance = 1e-5, .iterations = 100000, .threads = 2 };
    struct refiner *r = oracles_open(oracle, RELEASE_FLAT);
    const char *cause;
    int n = 0;
    while (settings && settings[n])
        n++;
    must(r && oracles_set(r, settings, n) == 0, oracle);
    must(solve_open(s, scene, &options, &cause) == 0, "solve_open");
    must(solve_run(s, r, &cause) == 0, "solve_run");
    refiner_close(r);
}

/* Sum over the faces of |rho A (H - H_ref)| in one band (W), and the same of all that they reflect. */
static double power_error(const struct solve *s, const double *reference, uint32_t band, double *all)
{
    double sum = 0;
    uint32_t i;
    *all = 0;
    for (i = 0; i < s->scene->face_count; i++) {
        size_t at = (size_t)i * s->bands + band, element = s->hierarchy.face_element[i];
        double power = s->reflectance[at] * s->hierarchy.elements[element].area;
        sum += power * fabs(s->irradiance[element * s->bands + band] - reference[at]);
        *all += power * reference[at];
    }
    return sum;
}

static int table(const char *path)
{
    struct scene_options how = { 0, 1 };
    struct scene scene;
    const struct builtin *b;
    double *reference, *noise, quiet = 0, all;
    size_t i;
    if (scene_read(&scene, path, &how) < 0)
        return 1;
    reference = calloc((size_t)scene.face_count * scene.bands, sizeof *reference);
    noise = calloc((size_t)scene.face_count * scene.bands, sizeof *noise);
    path_reference(&scene, getenv("ORACLES_PATHS") ? atoi(getenv("ORACLES_PATHS")) : 1 << 23, reference, noise);
    for (b = builtins; b->name; b++) {
        char *settings[16] = { 0 }, *given = getenv("ORACLES_SET") ? strdup(getenv("ORACLES_SET")) : NULL, *word;
        struct solve s;
        double error;
        int n = 0;
        for (word = given ? strtok(given, " ") : NULL; word; word = strtok(NULL, " "))
            settings[n++] = word;
        if (strcmp(b->name, "viewfactors") == 0 || (getenv("ORACLES_ONLY") && !strstr(getenv("ORACLES_ONLY"), b->name)))
            continue;
        solve_with(&s, &scene, b->name, settings);
        free(given);
        error = power_error(&s, reference, 0, &all);
        if (getenv("ORACLES_FACES"))
            for (i = 0; i < scene.face_count; i++)
                printf("%zu rho %.3f area %.4f H %.5g ref %.5g +- %.2g exposed %.3f\n", i, s.reflectance[i * s.bands], s.hierarchy.elements[s.hierarchy.face_element[i]].area, s.irradiance[(size_t)s.hierarchy.face_element[i] * s.bands], reference[i * s.bands], noise[i * s.bands], s.exposed[s.hierarchy.face_element[i]]);
        for (quiet = 0, i = 0; i < scene.face_count; i++)
            quiet += s.reflectance[i * s.bands] * s.hierarchy.elements[s.hierarchy.face_element[i]].area * noise[i * s.bands];
        printf("%-15s %9zu links %9.0f rays %7.2f s  error %.3f %% of %.4g W (reference's noise %.3f %%), %llu kept by a guard; %.3g of its tolerance\n", b->name,
               s.refinement.link_count, (double)rays_count(s.rays).rays, s.seconds.refine + s.seconds.iterate, 100 * error / all,
               all, 100 * quiet / all, (unsigned long long)s.refinement.marked[1], error / (0.02 * rays_host(s.rays)->irradiance * rays_host(s.rays)->area));
        fflush(stdout);
        solve_close(&s);
    }
    free(reference);
    free(noise);
    scene_free(&scene);
    return 0;
}

int main(int count, char **arguments)
{
    int i, status = 0;
    if (getenv("ORACLES_TABLE")) {
        for (i = 1; i < count; i++)
            status |= table(arguments[i]);
        return status;
    }
    return 0;
}
