/* tune.c - `radiosity tune`: fit an oracle's parameters to scenes by measured error and cost, and
 * see whether they carry over to scenes that were not used.
 *
 * First to all scenes, which gives the parameters; then, for each scene, to the others alone, from
 * the same start: what the scene fares with that fit, against what it fares with those that it had
 * a part in, tells whether parameters were found or scenes learnt by heart. It also tells how near
 * to the start fits shall stay (tune_choice.c).
 * A limit of time is shared out evenly to these fits, so that it cuts all of them short rather than
 * leaving the last ones out. SIGINT ends them all; the best so far is told and written.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands/commands.h"
#include "commands/tune_choice.h"
#include "commands/tune_parameters.h"
#include "commands/tune_report.h"
#include "output/json_file.h"
#include "util/atomic_file.h"
#include "util/beside.h"
#include "util/clock.h"
#include "util/device.h"
#include "util/graph_defaults.h"
#include "util/open_oracle.h"
#include "util/report.h"
#include "util/stop_signal.h"
#include "util/text_file.h"

enum { CARRIES_NOT = 3 }; /* exit status */

static const double FORETELL = 2; /* s, after which each fit is told of */

struct work {
    const struct options *options;
    RadDevice device; /* the oracle's */
    struct tuner tuner;
    struct tune_outcome outcome;
    char *text;          /* of the oracle's graph, where it shall be written */
    double start, begin; /* s, of the clock: of the command, of the fits */
};

/* ---- the graph */

/* The oracle's text, and does it compile where the new one will stand? Before the work, since what
 * it imports is looked for beside it. Returns 0, or -1 after a message. */
static int read_graph(struct work *w)
{
    const struct options *o = w->options;
    const char *built_in = radGetOracleText(o->oracle);
    size_t size;
    w->text = built_in ? strdup(built_in) : text_file_need(o->oracle, &size);
    if (!w->text)
        return built_in ? report_error(o->oracle, 0, "out of memory for the graph") : -1;
    RadOracle there = radParseOracle(w->device, o->out, w->text, NULL, RAD_RELEASE_DAG);
    if (!there) {
        (void)radGetDeviceError(w->device);
        return report_error(o->out, 0,
                            "%s does not compile in that folder: what it imports is looked for "
                            "there; copy that first, or write beside %s",
                            o->oracle, o->oracle);
    }
    radReleaseOracle(there);
    return 0;
}

/* The text with the fitted defaults, which must compile. Returns 0, or -1 after a message. */
static int write_graph(const struct work *w)
{
    const struct options *o = w->options;
    const struct tuner *t = &w->tuner;
    struct graph_default defaults[PATTERN_NUMBERS];
    const char *missing;
    int count = 0;
    for (int i = 0; i < t->parameter_count; i++)
        if (w->outcome.all.at[i])
            defaults[count++] = (struct graph_default){
                t->parameters[i].name, tune_value(&t->parameters[i], w->outcome.all.at[i])};
    char *text = graph_with_defaults(w->text, defaults, count, &missing);
    if (!text)
        return report_error(o->out, 0, "out of memory for the graph");
    RadOracle made = radParseOracle(w->device, o->out, text, NULL, RAD_RELEASE_DAG);
    radReleaseOracle(made);
    struct atomic_file file;
    int failed = !made ? report_device(w->device, o->out) : atomic_open(&file, o->out);
    if (!failed) {
        fputs(text, file.stream);
        failed = atomic_commit(&file);
    }
    free(text);
    return failed ? -1 : 0;
}

/* ---- the work */

/* Returns 0, or -1 after a message. */
static int open_scenes(struct work *w)
{
    const struct options *o = w->options;
    const struct scene_options how = {.two_sided = o->two_sided, .quiet = o->quiet};
    struct tuner *t = &w->tuner;
    t->scenes = calloc((size_t)o->scene_count, sizeof *t->scenes);
    if (!t->scenes)
        return report_error("tune", 0, "out of memory for scenes");
    for (int i = 0; i < o->scene_count; i++) {
        if (tune_scene_open(&t->scenes[i], o->scenes[i], &how, o->threads) < 0)
            return -1;
        t->scene_count++;
        radSetDeviceProgressFunction(t->scenes[i].scene.device, tune_watch, t);
    }
    return 0;
}

/* Where the share of the time ends that is for so many of the fits, of what is left when they
 * begin. */
static double deadline(const struct work *w, int count)
{
    double left = w->start + w->options->limit_seconds - w->begin;
    return w->options->limit_seconds ? w->begin + fmax(0, left) * count / tune_fits(&w->tuner) : 0;
}

/* Said of each fit where they take long, also to a log. */
static void tell(struct work *w, const struct tune_fit *f)
{
    struct tuner *t = &w->tuner;
    if (w->options->quiet || path_is_stdout(w->options->json) || seconds() - w->start < FORETELL)
        return;
    progress_end(&t->progress);
    printf("fit %d of %d: %d places, best %.3g of the price of the defaults, %.0f s so far\n",
           f->left_out + 2, tune_fits(t), f->found.evaluations, exp(f->found.value),
           seconds() - w->start);
    fflush(stdout);
}

/* All fits. Returns 0, STOPPED, or -1 after a message. */
static int fit_all(struct work *w)
{
    struct tuner *t = &w->tuner;
    struct tune_outcome *out = &w->outcome;
    int status = tune_defaults(t);
    if (status)
        return status < 0 ? -1 : STOPPED;
    w->begin = seconds();
    t->deadline = deadline(w, 1);
    if (tune_fit(t, -1, &out->all) < 0)
        return -1;
    tell(w, &out->all);
    if (!isfinite(out->all.found.value))
        return report_error(out->oracle, 0,
                            "nothing was solved within the ranges given; give other ones, by "
                            "--param NAME=LOW:HIGH");
    if (t->scene_count < 2)
        return 0;
    out->folds = calloc((size_t)t->scene_count, sizeof *out->folds);
    if (!out->folds)
        return report_error("tune", 0, "out of memory for folds");
    out->fold_count = t->scene_count;
    for (int s = 0; s < t->scene_count && !stop_signal_came(); s++) {
        t->deadline = deadline(w, s + 2);
        if (tune_fit(t, s, &out->folds[s].fit) < 0)
            return -1;
        tell(w, &out->folds[s].fit);
    }
    t->deadline = 0;
    snprintf(t->doing, sizeof t->doing, "scenes left out");
    if (!stop_signal_came() && tune_choose(out) < 0)
        return -1;
    return 0;
}

/* Say and write what was found. Returns the exit status. */
static int finish(struct work *w)
{
    const struct options *o = w->options;
    w->outcome.seconds = seconds() - w->start;
    progress_end(&w->tuner.progress);
    if (!o->quiet && !path_is_stdout(w->options->json))
        tune_print(&w->outcome);
    if (o->out && write_graph(w) < 0)
        return 1;
    if (o->json && json_file_write(o->json, tune_json(&w->outcome)) < 0)
        return 1;
    return stop_signal_came() ? STOPPED : tune_fails(&w->outcome) ? CARRIES_NOT : 0;
}

/* Returns the exit status. */
static int run(struct work *w)
{
    const struct options *o = w->options;
    struct tuner *t = &w->tuner;
    t->oracle = open_oracle(w->device, o->oracle, RAD_RELEASE_FLAT, NULL, 0);
    if (!t->oracle || tune_parameters(t, o->oracle, o->settings, o->setting_count) < 0
        || (o->out && read_graph(w) < 0))
        return 1;
    stop_signal_watch();
    progress_start(&t->progress, o->quiet);
    int status = open_scenes(w) < 0 || tuner_open(t) < 0 ? -1 : fit_all(w);
    progress_end(&t->progress);
    if (status == STOPPED)
        fprintf(stderr, "stopped before anything was fitted\n");
    return status ? (status == STOPPED ? STOPPED : 1) : finish(w);
}

int command_tune(const struct options *o, const struct open_scene *scene)
{
    (void)scene;
    struct work w = {.options = o, .start = seconds(), .device = open_device(o->threads)};
    w.tuner = (struct tuner){.cost = (enum tune_cost)o->cost,
                             .basis = o->basis,
                             .target = o->noise,
                             .power = o->power,
                             .evaluations = o->evaluations};
    w.outcome = (struct tune_outcome){.oracle = o->oracle, .tuner = &w.tuner};
    int status = w.device ? run(&w) : 1;
    tuner_close(&w.tuner);
    for (int i = 0; i < w.tuner.scene_count; i++)
        tune_scene_close(&w.tuner.scenes[i]);
    free(w.tuner.scenes);
    free(w.outcome.folds);
    free(w.text);
    radReleaseOracle(w.tuner.oracle);
    radReleaseDevice(w.device);
    return status;
}
