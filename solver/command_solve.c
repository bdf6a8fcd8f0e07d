/* command_solve.c - `radiosity solve`: solve, then write whatever was asked for.
 * SPDX-License-Identifier: MIT */
#include <string.h>
#include <sys/resource.h>
#include <time.h>
#include "commands.h"
#include "export.h"
#include "faces_csv.h"
#include "image.h"
#include "json_file.h"
#include "progress.h"
#include "report.h"
#include "solve.h"

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double peak_megabytes(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return (double)usage.ru_maxrss / 1024;
}

/* Emitted less absorbed, as a share: 0 in a closed scene; in an open one, what left it. */
static double imbalance(const struct solve *s)
{
    return s->emitted > 0 ? (s->emitted - s->absorbed) / s->emitted : 0;
}

static json_t *parameters_json(const struct refiner *r)
{
    json_t *all = json_object();
    int i;
    for (i = 0; i < r->parameter_count; i++)
        json_object_set_new(all, r->parameters[i].name, json_real(refiner_get(r, i)));
    return all;
}

static json_t *account_json(const struct options *o, const struct solve *s, const struct refiner *r, double output_seconds)
{
    struct rays_count rays = rays_count(s->rays);
    return json_pack("{s:s, s:s, s:s, s:o, s:i, s:i, s:i, s:i, s:i, s:I, s:I, s:I, s:I, s:i, s:i, s:b, s:f, s:f, s:f, s:f,"
                     " s:{s:f, s:f, s:f}, s:{s:f, s:f, s:f, s:f, s:f}, s:f}",
                     "scene", o->scene, "oracle", r->oracle, "release", r->release, "parameters", parameters_json(r),
                     "threads", o->threads, "bands", (int)s->bands, "faces", (int)s->scene->input_count,
                     "elements", (int)s->hierarchy.count, "leaves", (int)s->leaves,
                     "links", (json_int_t)s->refinement.link_count, "pairs", (json_int_t)s->refinement.pairs,
                     "rays", (json_int_t)rays.rays, "rounds", (json_int_t)s->refinement.rounds, "passes", s->passes,
                     "iterations", s->sweeps, "converged", s->converged, "residual", s->residual,
                     "power_emitted", s->emitted, "power_absorbed", s->absorbed, "power_imbalance", imbalance(s),
                     "row_sums", "smallest", s->row_low, "largest", s->row_high, "excess_moved", s->row_excess,
                     "seconds", "build", s->seconds.build, "refine", s->seconds.refine, "in_rays", s->seconds.in_rays,
                     "iterate", s->seconds.iterate, "output", output_seconds, "peak_memory_mb", peak_megabytes());
}

static void print_summary(const struct options *o, const struct solve *s, const struct refiner *r, double output_seconds)
{
    struct rays_count rays = rays_count(s->rays);
    printf("scene     %s: %u faces, %.4g m2, %s\n", o->scene, s->scene->input_count, rays_host(s->rays)->area,
           s->bands == 1 ? "grey" : "three bands");
    printf("oracle    %s (%s release)\n", r->oracle, r->release);
    printf("mesh      %u elements, of which %u leaves\n", s->hierarchy.count, s->leaves);
    printf("links     %zu from %llu discussions in %llu rounds; %.3g rays\n", s->refinement.link_count,
           (unsigned long long)s->refinement.pairs, (unsigned long long)s->refinement.rounds, (double)rays.rays);
    printf("solution  %d passes, %d sweeps, residual %.1e, %s\n", s->passes, s->sweeps, s->residual,
           s->converged ? "converged" : "NOT converged: allow more --iterations, or loosen --tolerance");
    printf("power     %.6g W emitted, %.6g W absorbed: %.2f %% %s\n", s->emitted, s->absorbed, 100 * fabs(imbalance(s)),
           imbalance(s) < 0 ? "gained, which is error" : "leave the scene or are lost to error");
    printf("rows      sums of F V from %.4f to %.4f before the cap at 1, which moved %.2g of the exchange\n",
           s->row_low, s->row_high, s->row_excess);
    printf("time      %.2f s: build %.2f, refine %.2f (%.2f in rays), iterate %.2f, output %.2f; %.0f MB\n",
           s->seconds.build + s->seconds.refine + s->seconds.iterate + output_seconds, s->seconds.build,
           s->seconds.refine, s->seconds.in_rays, s->seconds.iterate, output_seconds, peak_megabytes());
}

static int write_outputs(const struct options *o, const struct solve *s)
{
    struct solution solution = solve_solution(s);
    struct vertex_values values;
    int failed = 0;
    if (o->out || o->image) {
        if (vertex_values_build(&values, &solution) < 0)
            return report_error(o->image ? o->image : o->out, 0, "out of memory");
        if (o->out)
            failed |= export_write(o->out, &solution, &values) < 0;
        if (o->image)
            failed |= image_write(o->image, &solution, &values, o->view_given ? &o->view : NULL, o->width, o->height, o->mesh) < 0;
        vertex_values_free(&values);
    }
    if (o->faces)
        failed |= faces_csv_write(o->faces, &solution) < 0;
    return failed ? -1 : 0;
}

int command_solve(const struct options *o, const struct scene *scene)
{
    struct progress progress;
    struct solve_options how = { .tolerance = o->tolerance, .iterations = o->iterations, .jacobi = o->jacobi,
                                 .threads = o->threads, .progress = progress_show, .context = &progress };
    struct refiner *refiner = oracles_open(o->oracle, o->release);
    struct solve s;
    const char *cause;
    double start;
    int status = 1;
    if (!refiner)
        return 1;
    if (oracles_set(refiner, o->settings, o->setting_count) < 0) {
        refiner_close(refiner);
        return 1;
    }
    progress_start(&progress, o->quiet);
    if (solve_open(&s, scene, &how, &cause) < 0) {
        report_error(o->scene, 0, "%s", cause);
        refiner_close(refiner);
        return 1;
    }
    if (solve_run(&s, refiner, &cause) < 0) {
        progress_end(&progress);
        report_error(o->scene, 0, "%s", cause);
    } else {
        progress_end(&progress);
        start = seconds();
        if (!s.converged && !o->quiet)
            report_warning(o->scene, 0, "not converged after %d sweeps: residual %.1e", s.sweeps, s.residual);
        status = write_outputs(o, &s) < 0;
        if (o->json && json_file_write(o->json, account_json(o, &s, refiner, seconds() - start)) < 0)
            status = 1;
        if (!o->quiet && !(o->json && strcmp(o->json, "-") == 0))
            print_summary(o, &s, refiner, seconds() - start);
    }
    solve_close(&s);
    refiner_close(refiner);
    return status;
}
