/* study_visibility.c - `radiosity study visibility`: how often are few rays wrong about visibility?
 *
 * The paper's section 5: a branch before a normal refiner asks visibility tools with few rays about
 * every pair whose projected areas are below a threshold, and holds the answers against a
 * reference. All of that is the graph examples/oracles/tester.dag; here its parameters are set, the
 * counts of its arcs read (reliability.h) and shown (visibility_table.h).
 *
 * One solve serves eight thresholds. Between its rounds, when nobody asks the oracle, the counts
 * are read, and the share of pairs that is drawn under a threshold is halved when enough have been;
 * the rounds do not depend on threads or time, so neither do the tables. A run that is stopped, by
 * SIGINT, SIGTERM or --limit-seconds, ends at such a place, too, and what has been counted is a
 * table of the pairs discussed until then: it is printed and written, marked as partial, and the
 * exit status is 130 or 3.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "study/study.h"
#include "study/visibility_table.h"
#include "util/clock.h"
#include "util/device.h"
#include "util/open_oracle.h"
#include "util/progress.h"
#include "util/report.h"
#include "util/solved.h"
#include "util/stop_signal.h"

enum { OUT_OF_TIME = 3 }; /* exit status, as of solve */

struct study {
    const struct options *o;
    const struct open_scene *scene;
    struct visibility_table table;
    struct progress progress;
    double start; /* of the clock, s */
    int status;   /* STOPPED or OUT_OF_TIME: the tables are partial */

    /* The solve that is going on. */
    RadOracle oracle;
    int first, count; /* its thresholds */
    int slot;         /* of the graph's eight, the first one's place, from 0 */
    double tested[BINS_OF_SOLVE];
};

/* ---- a solve with oracle tester */

/* Set one of the parameters NAME_1, NAME_2, ..., the first of which is 0 here. */
static int set_number(struct study *s, const char *name, int i, double value)
{
    char numbered[32];
    snprintf(numbered, sizeof numbered, "%s_%d", name, i + 1);
    return radSetOracleParameter(s->oracle, numbered, value);
}

static double get_tested(struct study *s, int i)
{
    char numbered[32];
    snprintf(numbered, sizeof numbered, "tested_%d", i + 1);
    return radGetOracleParameter(s->oracle, numbered);
}

/* A solve for later thresholds draws none of the pairs below those before, whose place is slot 0.
 * Returns 0, or -1 after a message. */
static int set_tester(struct study *s)
{
    const struct options *o = s->o;
    int status = set_oracle(s->scene->device, s->oracle, o->settings, o->setting_count);
    if (status < 0)
        return -1;
    for (int i = 0; i < s->slot; i++)
        status |= set_number(s, "threshold", i, o->thresholds[s->first - 1])
                  | set_number(s, "tested", i, 0);
    for (int i = s->slot; i < BINS_OF_SOLVE; i++) {
        int given = i - s->slot < s->count;
        s->tested[i] = get_tested(s, i);
        status |= set_number(s, "threshold", i, given ? o->thresholds[s->first + i - s->slot] : 0);
    }
    for (int k = 0; k < RAY_TOOLS; k++)
        status |= set_number(s, "rays", k, o->rays[k < o->ray_count ? k : o->ray_count - 1]);
    return status < 0 ? report_device(s->scene->device, o->scene) : 0;
}

/* Between rounds: halve the share that is drawn of the pairs of which enough have been. */
static int draw_fewer(struct study *s)
{
    struct RadStatistics statistics;
    if (radGetOracleStatistics(s->oracle, &statistics) < 0)
        return -1;
    struct bin *bins = &s->table.bins[s->first];
    read_bins(bins, s->count, s->slot, &statistics);
    for (int i = 0; i < s->count; i++) {
        if (period_drawn(&bins[i]) < period_length(&bins[i], s->o->ray_count, s->o->within)
            || next_period(&bins[i]) < 0)
            continue;
        s->tested[s->slot + i] /= 2;
        if (set_number(s, "tested", s->slot + i, s->tested[s->slot + i]) < 0)
            return -1;
    }
    return 0;
}

/* The device's progress function. */
static int after_round(void *user, const struct RadProgress *at)
{
    struct study *s = user;
    if (strcmp(at->phase, "refine") == 0 && draw_fewer(s) < 0)
        return -1;
    if (stop_signal_came())
        s->status = STOPPED;
    else if (s->o->limit_seconds && seconds() - s->start > s->o->limit_seconds)
        s->status = OUT_OF_TIME;
    return s->status ? -1 : progress_show(&s->progress, at);
}

/* Refine from the root, and then as often as is asked for solve, and discuss the links again in
 * that light. Returns 0, or -1 after a message, or without one when s->status says why. */
static int run_passes(struct study *s)
{
    RadDevice device = s->scene->device;
    struct RadSolveOptions how = solve_options(s->o);
    how.iterations = 0; /* the option means passes here */
    struct solved solved;
    if (solved_begin(&solved, device, s->o->scene, s->scene->scene, s->oracle, &how) < 0)
        return -1;
    int more = radRefine(solved.solution) < 0 ? -1 : 1;
    for (int pass = 1; pass < s->o->iterations && more > 0; pass++)
        more = radStep(solved.solution);
    progress_end(&s->progress);
    solved_close(&solved);
    if (more >= 0)
        return 0;
    if (s->status)
        (void)radGetDeviceError(device); /* it was cancelled, and that is no error */
    else
        report_device(device, s->o->scene);
    return -1;
}

/* The solve for the thresholds from s->first on that it has places for. Returns 0, or -1 as
 * run_passes. */
static int run(struct study *s)
{
    s->slot = s->first > 0;
    s->count = s->o->threshold_count - s->first;
    if (s->count > BINS_OF_SOLVE - s->slot)
        s->count = BINS_OF_SOLVE - s->slot;
    for (int i = 0; i < s->count; i++)
        s->table.bins[s->first + i].count = 1;
    s->oracle = open_oracle(s->scene->device, "tester", RAD_RELEASE_DAG, NULL, 0);
    if (!s->oracle)
        return -1;
    int result = set_tester(s);
    if (result == 0) {
        s->table.unit =
            fmax(radGetOracleParameter(s->oracle, "unit"),
                 radGetOracleParameter(s->oracle, "unit_share") * s->scene->report.area);
        result = radCountOracle(s->oracle) < 0 ? report_device(s->scene->device, s->o->scene)
                                               : run_passes(s);
    }
    radReleaseOracle(s->oracle);
    return result;
}

int study_visibility(const struct options *o, const struct open_scene *scene)
{
    struct study *s = calloc(1, sizeof *s);
    if (!s)
        return report_error(o->scene, 0, "out of memory") ? 1 : 0;
    s->o = s->table.options = o;
    s->scene = scene;
    s->table.area = scene->report.area;
    s->start = seconds();
    progress_start(&s->progress, o->quiet);
    radSetDeviceProgressFunction(scene->device, after_round, s);
    stop_signal_watch();
    int failed = 0;
    for (; s->first < o->threshold_count && !failed && !s->status; s->first += s->count)
        failed = run(s) < 0 && !s->status;
    stop_signal_unwatch();
    radSetDeviceProgressFunction(scene->device, NULL, NULL);
    int status = failed ? 1 : s->status;
    s->table.partial = s->status == STOPPED       ? "stopped"
                       : s->status == OUT_OF_TIME ? "--limit-seconds came"
                                                  : NULL;
    s->table.seconds = seconds() - s->start;
    if (!failed) {
        if (!o->quiet)
            visibility_table_print(&s->table);
        if ((o->out && visibility_table_write(&s->table) < 0)
            || (o->chart && visibility_table_draw(&s->table) < 0))
            status = 1;
    }
    free(s);
    return status;
}
