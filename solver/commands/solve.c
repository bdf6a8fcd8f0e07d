/* solve.c - `radiosity solve`: solve, then write whatever was asked for.
 * SPDX-License-Identifier: MIT */
#include <string.h>
#include "commands/account_summary.h"
#include "commands/commands.h"
#include "commands/summary.h"
#include "output/export.h"
#include "output/faces_csv.h"
#include "output/image.h"
#include "output/json_file.h"
#include "output/statistics_file.h"
#include "util/progress.h"
#include "util/clock.h"
#include "util/device.h"
#include "util/open_oracle.h"
#include "util/report.h"

static int write_solution(const struct options *o, const struct surfaces *surfaces,
                          RadSolution solved)
{
    const struct solution solution = solution_of(surfaces, solved);
    int failed = 0;
    if (o->out || o->image) {
        struct vertex_values values;
        if (vertex_values_build(&values, &solution) < 0)
            return report_error(o->image ? o->image : o->out, 0, "out of memory");
        if (o->out)
            failed |= export_write(o->out, &solution, &values) < 0;
        if (o->image)
            failed |= image_write(o->image, &solution, &values, o->view_given ? &o->view : NULL,
                                  o->width, o->height, o->mesh)
                      < 0;
        vertex_values_free(&values);
    }
    if (o->faces)
        failed |= faces_csv_write(o->faces, &solution) < 0;
    return failed ? -1 : 0;
}

/* Write all that was asked for. Returns the exit status. */
static int write_outputs(const struct options *o, const struct open_scene *scene,
                         const struct surfaces *surfaces, const struct solved *solved,
                         RadOracle oracle)
{
    double start = seconds();
    int status = write_solution(o, surfaces, solved->solution) < 0;
    struct RadAccountReport account;
    struct progress progress;
    if (o->errors == ERRORS_ALL) {
        progress_start(&progress, o->quiet);
        radSetDeviceProgressFunction(scene->device, progress_show, &progress);
        int failed = radAccountErrors(solved->solution, &o->account, &account) < 0;
        progress_end(&progress);
        if (failed)
            return report_device(scene->device, o->scene), 1;
    }
    if (o->statistics && statistics_write(o->statistics, oracle) < 0)
        status = 1;
    const struct summary summary = {o, scene, solved, oracle, seconds() - start};
    json_t *json = o->json ? summary_json(&summary) : NULL;
    if (json && o->errors == ERRORS_ALL)
        json_object_set_new(json, "account", account_json(&account));
    if (o->json && json_file_write(o->json, json) < 0)
        status = 1;
    if (!o->quiet && !(o->json && strcmp(o->json, "-") == 0)) {
        summary_print(&summary);
        if (o->errors == ERRORS_ALL)
            account_print(&account);
    }
    return status;
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
    if (o->view_given && !o->image && !report.reads_importance) {
        report_error(
            "--view", 0,
            "is for a picture, or for an oracle that reads importance: add --image FILE.png");
        return 2;
    }
    if (o->statistics && radCountOracle(oracle) < 0)
        return report_device(scene->device, o->statistics), 1;
    if (o->view_given)
        how.camera = &camera;
    struct progress progress;
    progress_start(&progress, o->quiet);
    radSetDeviceProgressFunction(scene->device, progress_show, &progress);
    struct solved s;
    int status = solved_open(&s, scene->device, o->scene, scene->scene, oracle, &how);
    progress_end(&progress);
    if (status < 0)
        return 1;
    if (!s.report.converged && !o->quiet) {
        char cause[SUMMARY_CAUSE];
        summary_cause(&s.report, cause, sizeof cause);
        report_warning(o->scene, 0, "not converged after %d sweeps (residual %.1e): %s",
                       s.report.iterations, s.report.residual, cause);
    }
    status = write_outputs(o, scene, &surfaces, &s, oracle);
    solved_close(&s);
    return status;
}

int command_solve(const struct options *o, const struct open_scene *scene)
{
    RadOracle oracle =
        open_oracle(scene->device, o->oracle, o->release, o->settings, o->setting_count);
    int status = oracle ? solve_by(o, scene, oracle) : 1;
    radReleaseOracle(oracle);
    return status;
}
