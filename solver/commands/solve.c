/* command_solve.c - `radiosity solve`: solve, then write whatever was asked for.
 * SPDX-License-Identifier: MIT */
#include <string.h>
#include "util/clock.h"
#include "commands/commands.h"
#include "output/export.h"
#include "output/faces_csv.h"
#include "output/image.h"
#include "output/json_file.h"
#include "progress.h"
#include "util/report.h"
#include "engine/solve.h"
#include "oracle/statistics.h"
#include "output/statistics_file.h"
#include "commands/summary.h"

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
    const struct camera camera = view_camera(&o->view, scene, o->width / (double)o->height);
    struct solve_options how = { .tolerance = o->tolerance, .iterations = o->iterations, .jacobi = o->jacobi, .closure = o->closure, .clusters = o->clusters, .camera = o->view_given ? &camera : NULL,
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
    if (o->view_given && !o->image && !refiner_reads(refiner, FACT_RECEIVER_IMPORTANCE)) {
        report_error("--view", 0, "is for a picture, or for an oracle that reads importance: add --image FILE.png");
        refiner_close(refiner);
        return 2;
    }
    if (o->statistics && refiner_count(refiner) < 0) {
        report_error(o->statistics, 0, "out of memory for the statistics");
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
        if (o->statistics && statistics_write(o->statistics, refiner) < 0)
            status = 1;
        if (o->json && json_file_write(o->json, summary_json(o, &s, refiner, seconds() - start)) < 0)
            status = 1;
        if (!o->quiet && !(o->json && strcmp(o->json, "-") == 0))
            summary_print(o, &s, refiner, seconds() - start);
    }
    solve_close(&s);
    refiner_close(refiner);
    return status;
}
