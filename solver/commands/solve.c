/* solve.c - `radiosity solve`: solve, then write whatever was asked for.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include "commands/accuracy.h"
#include "commands/asked_oracle.h"
#include "commands/commands.h"
#include "commands/summary.h"
#include "output/error_image.h"
#include "output/export.h"
#include "output/faces_csv.h"
#include "output/image.h"
#include "output/json_file.h"
#include "output/statistics_file.h"
#include "output/trace_file.h"
#include "util/beside.h"
#include "util/clock.h"
#include "util/device.h"
#include "util/machines.h"
#include "util/progress.h"
#include "util/report.h"

/* Both pictures, of the error and of the light, through the same camera. */
static int write_pictures(const struct options *o, const struct solution *solution,
                          struct vertex_values *values, RadDevice device, RadSolution solved,
                          struct progress *progress)
{
    const struct view *view = o->view_given ? &o->view : NULL;
    struct gathering gathering = {o->image, device, solved, progress, o->gather > 0 ? o->gather : 0,
                                  0};
    int failed = 0;
    if (o->image_error)
        failed |= error_image_write(o->image_error, solution, values,
                                    &(struct error_seen){radGetElementErrors(solved),
                                                         radGetElementErrorLimits(solved)},
                                    view, o->width, o->height, o->mesh)
                  < 0;
    if (o->image)
        failed |= image_write(o->image, solution, values, view, o->width, o->height, o->mesh,
                              o->gather == 0 ? NULL : &gathering)
                  < 0;
    return failed;
}

static int write_solution(const struct options *o, const struct surfaces *surfaces,
                          RadDevice device, RadSolution solved, int measured)
{
    struct solution solution = solution_of(surfaces, solved, o->threads);
    solution.quiet = o->quiet;
    int failed = 0;
    if (o->out || o->image || o->image_error) {
        struct vertex_values values;
        if (vertex_values_build(&values, &solution) < 0)
            return report_error(o->image         ? o->image
                                : o->image_error ? o->image_error
                                                 : o->out,
                                0, "out of memory");
        if (o->out)
            failed |= export_write(o->out, &solution, &values,
                                   measured ? radGetElementErrors(solved) : NULL)
                      < 0;
        struct progress progress;
        progress_start(&progress, o->quiet);
        failed |= write_pictures(o, &solution, &values, device, solved, &progress);
        progress_end(&progress);
        vertex_values_free(&values);
    }
    if (o->faces)
        failed |= faces_csv_write(o->faces, &solution, measured ? solved : NULL) < 0;
    return failed ? -1 : 0;
}

/* Write all that was asked for, which one of several ranks does. Returns the exit status. */
static int write_outputs(const struct options *o, const struct open_scene *scene,
                         const struct surfaces *surfaces, const struct solved *solved,
                         const struct coarse_first *coarse, const struct measured *measured,
                         const struct power_promise *promise, const struct accuracy *accuracy,
                         RadOracle oracle)
{
    struct RadRank ranks[MACHINES_MOST];
    const int rank_count = radGetRanks(solved->solution, ranks, MACHINES_MOST);
    double start = seconds();
    if (machines_number() > 0)
        return 0;
    int status =
        write_solution(o, surfaces, scene->device, solved->solution, measured->measured) < 0;
    if (o->statistics && statistics_write(o->statistics, o->scene, oracle) < 0)
        status = 1;
    const struct summary summary = {o,
                                    scene,
                                    solved,
                                    oracle,
                                    o->accuracy > 0 ? NULL : coarse,
                                    measured,
                                    promise,
                                    o->accuracy > 0 ? accuracy : NULL,
                                    seconds() - start,
                                    ranks,
                                    rank_count < MACHINES_MOST ? rank_count : MACHINES_MOST};
    if (o->json && json_file_write(o->json, summary_json(&summary)) < 0)
        status = 1;
    if (!o->quiet && !path_is_stdout(o->json) && !path_is_stdout(o->trace))
        summary_print(&summary);
    return status;
}

/* Solve, and write every discussion where that is asked for. Returns 0, or the exit status after a
 * message, with nothing to close. */
static int solve_links(struct solved *s, struct coarse_first *coarse, const struct options *o,
                       const struct open_scene *scene, RadOracle oracle,
                       const struct RadSolveOptions *how)
{
    struct trace_file *trace = NULL;
    struct trace_count count;
    if (!o->trace)
        return coarse_first_solve(coarse, s, o, scene->device, scene->scene, oracle, how) < 0;
    if (solved_begin(s, scene->device, o->scene, scene->scene, oracle, how) < 0)
        return 1;
    int status = trace_file_open(&trace, o->trace, o->where, scene->scene, s->solution, oracle);
    if (status) {
        solved_close(s);
        return status < 0 ? report_device(scene->device, o->trace), 1 : status;
    }
    if (solved_finish(s, how) < 0) {
        if (report_unless_cancelled(scene->device, o->scene) > 0)
            (void)trace_file_close(trace, &count); /* which says what stopped it */
        else
            trace_file_discard(trace);
        return 1;
    }
    if (trace_file_close(trace, &count) < 0) {
        solved_close(s);
        return 1;
    }
    if (count.written < count.matched)
        report_warning(o->trace, 0,
                       "holds the first %llu of %llu lines: that is %.0f MB, the most; --where "
                       "picks those that are wanted",
                       (unsigned long long)count.written, (unsigned long long)count.matched,
                       1e-6 * (double)count.bytes);
    else if (!o->quiet)
        fprintf(stderr, "trace: %llu of %llu discussions, %.1f MB\n",
                (unsigned long long)count.written, (unsigned long long)count.held,
                1e-6 * (double)count.bytes);
    return 0;
}

/* Solve, mend and measure as the options say. Returns 0, or the exit status after a message. */
static int solve_once(struct solved *s, struct coarse_first *coarse, struct measured *measured,
                      struct power_promise *promise, const struct options *o,
                      const struct open_scene *scene, RadOracle oracle,
                      const struct RadSolveOptions *how)
{
    const int status = solve_links(s, coarse, o, scene, oracle, how);
    if (status)
        return status;
    if (measured_take(measured, o, scene->device, s->solution) == 0
        && power_promise_hold(promise, measured, o, scene->device, s->solution) == 0)
        return 0;
    solved_close(s);
    return 1;
}

/* of what is emitted. A result that gains more power than that is told to be wrong, whatever else
 * is kept quiet; chosen: a tenth of what eyes tell apart */
static const double GAIN_TOLD = 0.01;

/* Does any face emit, shut in or not? */
static int has_lamp(const struct surfaces *s)
{
    int has = 0;
    for (uint32_t i = 0; i < s->polygon_count; i++)
        for (int k = 0; k < 3 && s->polygon_areas[i] > 0; k++)
            has |= s->materials[s->polygon_materials[i]].exitance[k] > 0;
    return has;
}

/* More light than there can be, or none, or none that meets anything. */
static void warn_of_power(const struct options *o, const struct surfaces *surfaces,
                          const struct RadReport *r, const struct measured *m)
{
    if (r->emitted > 0 && r->absorbed > (1 + GAIN_TOLD) * r->emitted)
        report_warning(o->scene, 0,
                       "%.2g %% more is absorbed than emitted, which is error: use finer links "
                       "(smaller thresholds, --set)",
                       100 * (r->absorbed / r->emitted - 1));
    if (!(r->emitted > 0) && !o->quiet)
        report_warning(o->scene, 0, "%s",
                       has_lamp(surfaces)
                           ? "all that emits is shut in by the backs of faces, as in a solid: if "
                             "these are turned the wrong way, turn them, or take --two-sided"
                           : "no face emits, so all is dark; give a face a material that does: Ke "
                             "above 0 in an .mtl file");
    /* a room turned inside out; light that ends on backs, or that too few have looked for, is told
     * by others */
    const struct RadErrorReport *e = &m->error;
    if (r->emitted > 0 && !(r->absorbed > 0) && m->measured && !(e->unseen > 0) && !(e->backs > 0)
        && !o->quiet)
        report_warning(
            o->scene, 0,
            "no light meets the front of a face: if faces are turned the wrong way, turn "
            "them (seen from the front, corners run counter-clockwise), or take "
            "--two-sided");
}

/* Solve by the oracle and write the outputs. Returns the exit status. */
static int solve_by(const struct options *o, const struct open_scene *scene, RadOracle oracle)
{
    const struct surfaces surfaces =
        surfaces_of(scene->scene, scene->file.polygon_materials, scene->file.names);
    const struct RadCamera camera = view_camera(&o->view, &surfaces, o->width / (double)o->height);
    struct RadSolveOptions how = solve_options(o);
    struct RadOracleReport report;
    radGetOracleReport(oracle, &report);
    if (o->view_given && !o->image && !o->image_error && !report.reads_importance) {
        report_error("--view", 0,
                     "is for a picture, or for an oracle that reads importance: add --image "
                     "FILE.png or --image-error FILE.png");
        return 2;
    }
    if (o->statistics && radCountOracle(oracle) < 0)
        return report_device(scene->device, o->statistics), 1;
    if (o->view_given)
        how.camera = &camera;
    struct progress progress;
    progress_start(&progress, o->quiet);
    radSetDeviceProgressFunction(scene->device, progress_show, &progress);
    struct solved s = {0};
    struct measured measured;
    struct power_promise promise = {0};
    struct accuracy accuracy = {.reached = 1};
    struct coarse_first coarse = {.choice = {.scale = 1}};
    int status =
        o->accuracy > 0
            ? accuracy_solve(&accuracy, &s, &measured, o, scene->device, scene->scene, oracle, &how)
            : solve_once(&s, &coarse, &measured, &promise, o, scene, oracle, &how);
    if (status == 0 && o->errors == ERRORS_ALL
        && measured_account(&measured, o, scene->device, s.solution) < 0) {
        solved_close(&s);
        status = -1;
    }
    progress_end(&progress);
    if (status != 0)
        return status < 0 ? 1 : status;
    radGetReport(s.solution, &s.report);
    const int unfinished = solved_status(&s.report, o->scene);
    warn_of_power(o, &surfaces, &s.report, &measured);
    if (!o->quiet) {
        measured_warn(&measured, o->scene);
        power_promise_warn(&promise, o->scene);
    }
    status =
        write_outputs(o, scene, &surfaces, &s, &coarse, &measured, &promise, &accuracy, oracle);
    status = status ? status : unfinished;
    if (!accuracy.reached) {
        report_warning(o->scene, 0, "--accuracy was not kept: stopped by %s", accuracy.why);
        status = status ? status : 3;
    }
    solved_close(&s);
    return status;
}

int command_solve(const struct options *o, const struct open_scene *scene)
{
    RadOracle oracle = open_asked_oracle(o, scene->device, o->release);
    const int status = oracle ? solve_by(o, scene, oracle) : 1;
    radReleaseOracle(oracle);
    return status;
}
