/* reference.c - `radiosity reference`: what each face radiates, by particles and by paths until it
 * is known well enough; to judge solutions by.
 *
 * Both methods trace on in steps, a quarter of a doubling each, and after a step the noise of the
 * two together is held against what was asked for. Steps are fixed and cut at fixed places, so a
 * run that was stopped and goes on from its state file ends with the same bits as one that was not;
 * where it was cut, and by which thread what was traced, does not show.
 *
 * In the end the two are held against each other: by the whole light, and face by face. They share
 * the scene and its rays, but one starts where the other ends.
 * SPDX-License-Identifier: MIT */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "commands/commands.h"
#include "kernel/hash_bytes.h"
#include "output/json_file.h"
#include "output/json_values.h"
#include "util/atomic_file.h"
#include "util/beside.h"
#include "util/clock.h"
#include "util/device.h"
#include "util/machines.h"
#include "util/progress.h"
#include "util/read_alike.h"
#include "util/report.h"
#include "util/saving.h"
#include "util/stop_signal.h"
#include "util/text_file.h"

/* Steps of a quarter of a doubling by which a method may fall behind: a quarter as many. */
enum { LAG = 8 };

static const uint64_t CHUNK = 1 << 17; /* paths, or half the particles, between looks at signals */
static const double FORETELL = 2;      /* s, after which the time that it will take is told */
/* of a run that sees nothing reflected: chosen, some seconds */
static const uint64_t UNSEEN_RAYS = 1 << 24;

struct run {
    const struct options *options;
    const struct open_scene *scene;
    RadReference reference;
    struct RadReferenceReport report;
    struct progress progress;
    char *state;                   /* the state's file */
    double start, saved, save_for; /* s: of the clock; what the last save took */
    uint64_t loaded;               /* rays that were cast before this run */
    uint64_t identity;             /* of the state that they came with; 0: of none */
    int told;
};

static double noise_of(const struct run *r)
{
    return r->report.noise[RAD_METHOD_BOTH];
}

/* ---- the state beside the output */

/* One of several ranks does. Returns 0, or -1 after a message. */
static int save(struct run *r)
{
    double start = seconds();
    if (machines_number() > 0)
        return 0;
    size_t size = radSaveReference(r->reference, NULL, 0);
    unsigned char *bytes = malloc(size);
    struct atomic_file file;
    if (!bytes || radSaveReference(r->reference, bytes, size) != size) {
        free(bytes);
        return report_error(r->state, 0, "out of memory for the state");
    }
    int failed = atomic_open(&file, r->state) < 0;
    if (!failed) {
        /* a failed write leaves its mark on the stream, for commit to find */
        (void)fwrite(bytes, 1, size, file.stream);
        failed = atomic_commit(&file) < 0;
    }
    free(bytes);
    r->saved = seconds();
    r->save_for = r->saved - start;
    return failed ? -1 : 0;
}

/* Go on where another run stopped. Returns 0, or -1 after a message. */
static int load(struct run *r)
{
    RadDevice device = r->scene->device;
    size_t size;
    if (access(r->state, F_OK) != 0)
        return 0;
    char *bytes = text_file_read(r->state, &size);
    if (!bytes)
        return report_error(r->state, 0,
                            "cannot be read: %s; remove it to start anew, or give -o another name",
                            strerror(errno));
    int failed = radLoadReference(r->reference, bytes, size) < 0;
    r->identity = hash_bytes(1, bytes, size);
    free(bytes);
    if (failed) {
        report_error(r->state, 0, "%s; remove it to start anew, or give -o another name",
                     radGetDeviceErrorMessage(device));
        radGetDeviceError(device);
        return -1;
    }
    if (radGetReferenceReport(r->reference, &r->report) < 0)
        return report_device(device, r->scene->path);
    r->loaded = r->report.rays[0] + r->report.rays[1];
    if (r->options->quiet)
        return 0;
    printf("goes on from %s: %.3g particles, %.3g paths, ", r->state, (double)r->report.traced[0],
           (double)r->report.traced[1]);
    if (isfinite(noise_of(r)))
        printf("%.2g %%\n", 100 * noise_of(r));
    else
        printf("which saw nothing\n");
    return 0;
}

/* ---- how long */

/* s that are still needed; noise falls with the root of the rays. */
static double time_left(const struct run *r)
{
    double rays = (double)(r->report.rays[0] + r->report.rays[1]);
    double ratio = noise_of(r) / r->options->noise;
    double mine = rays - (double)r->loaded, gone = seconds() - r->start;
    return mine > 0 && ratio > 1 && isfinite(ratio) ? rays * (ratio * ratio - 1) * gone / mine : 0;
}

static const char *time_text(double s, char text[32])
{
    if (s < 100)
        snprintf(text, 32, s < 10 ? "%.1f s" : "%.0f s", s);
    else if (s < 100 * 60)
        snprintf(text, 32, "%.0f minutes", s / 60);
    else if (s < 100 * 3600)
        snprintf(text, 32, "%.0f hours", s / 3600);
    else
        snprintf(text, 32, "%.0f days", s / 86400);
    return text;
}

static int show_progress(void *context, const struct RadProgress *at)
{
    struct run *r = context;
    char gone[32], left[32];
    if (!(noise_of(r) > 0) || isinf(noise_of(r)))
        progress_say(&r->progress, "%s, %s", at->phase, time_text(seconds() - r->start, gone));
    else
        progress_say(&r->progress, "%s: %.2g %% so far, %.2g %% asked for; %s, %s to go", at->phase,
                     100 * noise_of(r), 100 * r->options->noise,
                     time_text(seconds() - r->start, gone), time_text(time_left(r), left));
    return 0;
}

/* Said once, where it will take long, also to a log. */
static void foretell(struct run *r)
{
    char gone[32], left[32];
    if (r->options->quiet || r->told || seconds() - r->start < FORETELL || time_left(r) < FORETELL)
        return;
    r->told = 1;
    progress_end(&r->progress);
    printf("%.2g %% after %s; %.2g %% will take about %s more\n", 100 * noise_of(r),
           time_text(seconds() - r->start, gone), 100 * r->options->noise,
           time_text(time_left(r), left));
    fflush(stdout);
}

/* ---- tracing */

/* How many there are of it after a step, from 0: the first gives each face what noise can be told
 * from. Twice as many particles as paths cast about as many rays. */
static uint64_t goal(const struct run *r, enum RadMethod method, int step)
{
    uint64_t first = 64 * (uint64_t)r->scene->report.faces;
    first = first > 1 << 15 ? first : 1 << 15;
    uint64_t paths = 16 * (uint64_t)((double)first / 16 * exp2(0.25 * step));
    return method == RAD_METHOD_PARTICLES ? 2 * paths : paths;
}

/* The method whose next step takes more off the noise per ray: precision, one over the noise
 * squared, grows with the rays. None falls behind by more than LAG steps, so that it can tell on
 * the other. */
static enum RadMethod next_method(const struct run *r, const int step[2])
{
    const struct RadReferenceReport *p = &r->report;
    double cost[2];
    for (int i = 0; i < 2; i++)
        cost[i] = p->noise[i] * p->noise[i] * (double)p->rays[i];
    int better = cost[RAD_METHOD_PATHS] < cost[RAD_METHOD_PARTICLES];
    int ahead = step[better] - step[!better] >= LAG;
    return ahead ? (enum RadMethod) !better : (enum RadMethod)better;
}

/* Trace one method on to its goal, by chunks that begin at multiples of their size. Returns 0,
 * STOPPED, or 1 after a message. */
static int trace(struct run *r, enum RadMethod method, uint64_t wanted)
{
    uint64_t chunk = method == RAD_METHOD_PARTICLES ? 2 * CHUNK : CHUNK;
    while (r->report.traced[method] < wanted) {
        uint64_t next = (r->report.traced[method] / chunk + 1) * chunk;
        next = next < wanted ? next : wanted;
        if (radTraceReference(r->reference, method, next) < 0) {
            progress_end(&r->progress);
            return report_device(r->scene->device, r->scene->path) ? 1 : 0;
        }
        r->report.traced[method] = next;
        const int stopped = machines_agree(stop_signal_came()),
                  late = save_is_due(seconds() - r->saved, r->save_for);
        if (machines_agree((stopped || late) && save(r) < 0))
            return 1;
        if (stopped)
            return STOPPED;
    }
    return 0;
}

/* Has nothing been seen by so many rays of this run that no more are cast? */
static int is_given_up(const struct run *r)
{
    const uint64_t rays = r->report.rays[0] + r->report.rays[1] - r->loaded;
    return r->report.unseen > 0 && rays >= UNSEEN_RAYS;
}

/* Returns 0 when the noise is what was asked for, or nothing is seen, STOPPED, or 1 after a
 * message. */
static int trace_all(struct run *r)
{
    int step[2] = {0, 0};
    for (int i = 0; i < 2; i++) /* where a run before this one was */
        while (goal(r, (enum RadMethod)i, step[i]) < r->report.traced[i])
            step[i]++;
    for (;;) {
        for (int i = 0; i < 2; i++) {
            int status = trace(r, (enum RadMethod)i, goal(r, (enum RadMethod)i, step[i]));
            if (status)
                return status;
        }
        if (radGetReferenceReport(r->reference, &r->report) < 0)
            return report_device(r->scene->device, r->scene->path) ? 1 : 0;
        if (!(noise_of(r) > r->options->noise) || is_given_up(r))
            return 0;
        foretell(r);
        step[next_method(r, step)]++;
    }
}

/* ---- what came of it */

static void print_rows(FILE *out, const struct run *r, const double *const values[6])
{
    uint32_t bands = r->scene->report.bands;
    const double *areas = radGetScenePolygonAreas(r->scene->scene);
    const struct RadMaterial *materials = radGetSceneMaterials(r->scene->scene);
    fputs("face,area", out);
    for (uint32_t k = 0; k < bands; k++)
        fprintf(out, ",B_%u", (unsigned)k);
    for (uint32_t k = 0; k < bands; k++)
        fprintf(out, ",se_%u", (unsigned)k);
    for (uint32_t i = 0; i < r->scene->report.polygons; i++) {
        int sides = 1 + materials[r->scene->file.polygon_materials[i]].two_sided;
        fprintf(out, "\n%u,%.9g", (unsigned)i, sides * areas[i]);
        for (uint32_t k = 0; k < bands; k++)
            fprintf(out, ",%.9g", values[k][i]);
        for (uint32_t k = 0; k < bands; k++)
            fprintf(out, ",%.3g", values[3 + k][i]);
    }
    fputc('\n', out);
}

/* Returns 0, or -1 after a message. */
static int write_table(const struct run *r)
{
    const char *path = r->options->out;
    size_t count = (size_t)r->scene->report.polygons + 1;
    double *values = malloc(6 * count * sizeof *values);
    if (!values)
        return report_error(path, 0, "out of memory for the table of faces");
    const double *columns[6];
    int failed = 0;
    for (uint32_t k = 0; k < 3; k++) {
        double *b = values + k * count, *se = values + (3 + k) * count;
        columns[k] = b;
        columns[3 + k] = se;
        if (k < r->scene->report.bands && !failed)
            failed = radGetReferenceValues(r->reference, RAD_METHOD_BOTH, k, b, se) < 0
                     && report_device(r->scene->device, r->scene->path);
    }
    struct atomic_file file;
    failed = failed || atomic_open(&file, path) < 0;
    if (!failed) {
        print_rows(file.stream, r, columns);
        failed = atomic_commit(&file) < 0;
    }
    free(values);
    return failed ? -1 : 0;
}

/* Do the two differ by more than chance lets them? The whole light by four standard errors: once in
 * 10,000 runs. Faces by half as much again as expected, and four standard errors of a chi-square of
 * as many faces, whose bands go together: replicates that are few make it a little more than 1. Of
 * few faces one on which a rare path lit says nothing. */
static int differ(const struct run *r)
{
    enum { FEW = 10 };
    const struct RadReferenceReport *p = &r->report;
    double faces = (double)p->compared / r->scene->report.bands;
    return fabs(p->difference) > 4 * p->deviation
           || (faces >= FEW && p->chi_square > 1.5 + 4 * sqrt(2 / faces));
}

/* Of nothing that was seen to be reflected. */
static void print_dark(const struct RadReferenceReport *p)
{
    if (p->unseen > 0)
        printf("none of %.3g particles and %.3g paths tells of light that is reflected: there is "
               "less than about %.2g W; the same command looks on\n",
               (double)p->traced[0], (double)p->traced[1], p->unseen);
    else
        printf("nothing is reflected: B is E, exactly\n");
}

static void print_summary(const struct run *r)
{
    const struct RadReferenceReport *p = &r->report;
    char text[32];
    printf("%s: %u faces, %u band%s, %.4g W emitted, %.4g W reflected, in %s\n", r->options->out,
           (unsigned)r->scene->report.polygons, (unsigned)r->scene->report.bands,
           r->scene->report.bands == 1 ? "" : "s", p->emitted, p->reflected,
           time_text(seconds() - r->start, text));
    if (!(p->reflected > 0)) {
        print_dark(p);
        return;
    }
    printf("standard error of a face, mean by area, of the reflected light: %.3f %%\n"
           "  particles  %7.3f %%  %9.3g of them, %9.3g rays\n"
           "  paths      %7.3f %%  %9.3g of them, %9.3g rays\n"
           "particles less paths: %+.3f %% in all, one standard error is %.3f %%\n",
           100 * p->noise[RAD_METHOD_BOTH], 100 * p->noise[RAD_METHOD_PARTICLES],
           (double)p->traced[0], (double)p->rays[0], 100 * p->noise[RAD_METHOD_PATHS],
           (double)p->traced[1], (double)p->rays[1], 100 * p->difference, 100 * p->deviation);
    if (p->compared)
        printf("  faces that both know well differ %.2f times as much as expected\n",
               sqrt(p->chi_square));
}

static json_t *reference_json(const struct run *r)
{
    const struct RadReferenceReport *p = &r->report;
    return json_pack(
        "{s:I, s:I, s:f, s:f, s:f, s:f, s:{s:o, s:o, s:o}, s:{s:I, s:I}, s:{s:I, s:I}, s:f, s:o, "
        "s:f, s:I, s:b, s:f}",
        "faces", (json_int_t)r->scene->report.polygons, "bands", (json_int_t)r->scene->report.bands,
        "emitted", p->emitted, "reflected", p->reflected, "unseen", p->unseen, "accuracy",
        r->options->noise, "standard_error", "particles", json_finite(p->noise[0]), "paths",
        json_finite(p->noise[1]), "both", json_finite(p->noise[2]), "traced", "particles",
        (json_int_t)p->traced[0], "paths", (json_int_t)p->traced[1], "rays", "particles",
        (json_int_t)p->rays[0], "paths", (json_int_t)p->rays[1], "difference", p->difference,
        "difference_error", json_finite(p->deviation), "chi_square", p->chi_square, "compared",
        (json_int_t)p->compared, "agree", !differ(r), "seconds", seconds() - r->start);
}

/* Write and say it all, and forget the state. Returns the exit status. */
static int finish(struct run *r)
{
    const struct options *o = r->options;
    if (machines_number() > 0)
        return 0;
    if (write_table(r) < 0) { /* what it took is not lost with it */
        (void)save(r);
        return 1;
    }
    int failed = 0;
    const int unknown = r->report.unseen > 0;
    if (o->keep || unknown)
        failed = save(r) < 0;
    else
        (void)unlink(r->state);
    if (!o->quiet && !path_is_stdout(o->json))
        print_summary(r);
    if (!o->quiet && differ(r))
        report_warning(o->out, 0,
                       "particles and paths differ by more than chance: one of them is wrong on "
                       "this scene; trust neither beyond their difference");
    failed = failed || (o->json && json_file_write(o->json, reference_json(r)) < 0);
    return failed ? 1 : unknown ? 3 : 0;
}

static int run(struct run *r)
{
    char text[32];
    if (machines_agree(load(r) < 0) || read_alike(r->state, r->identity) < 0)
        return 1;
    r->start = r->saved = seconds();
    int status = trace_all(r);
    progress_end(&r->progress);
    stop_signal_unwatch();
    if (status == 0)
        return finish(r);
    if (status == STOPPED && !r->options->quiet)
        fprintf(stderr, "stopped after %s; the same command goes on from %s\n",
                time_text(seconds() - r->start, text), r->state);
    return status;
}

int command_reference(const struct options *o, const struct open_scene *scene)
{
    struct run r = {.options = o, .scene = scene};
    int status = 1;
    r.state = path_and(o->out, REFERENCE_STATE);
    if (!r.state)
        return -report_error(o->out, 0, "out of memory");
    progress_start(&r.progress, o->quiet);
    radSetDeviceProgressFunction(scene->device, show_progress, &r);
    stop_signal_watch();
    if (machines_agree(machines_number() == 0 && atomic_check(r.state) < 0) == 0) {
        r.reference = radNewReference(scene->scene);
        status = r.reference ? run(&r) : report_device(scene->device, scene->path) < 0;
    }
    radReleaseReference(r.reference);
    free(r.state);
    return status;
}
