/* compare.c - `radiosity compare`: the releases of an oracle on one scene, the hand-written one
 * where there is one.
 *
 * First one solve by an oracle made of all of them: each discusses every pair on a copy, and
 * decisions and what links would store are compared bit by bit. Then each release solves alone, in
 * turn, several times, and the medians of the refinement's seconds are compared.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "commands/asked_oracle.h"
#include "commands/commands.h"
#include "output/json_file.h"
#include "util/progress.h"
#include "util/decisions.h"
#include "util/device.h"
#include "util/report.h"
#include "util/solved.h"

enum { RELEASES = 3 };

/* The order of the report: the first that there is is the yardstick. */
static const enum RadRelease order[RELEASES] = {RAD_RELEASE_HAND, RAD_RELEASE_DAG,
                                                RAD_RELEASE_FLAT};

/* What a link keeps of a discussion. */
struct kept {
    float form_factor;
    double visibility;
    unsigned char levels[2], mark;
};

struct difference {
    int release;
    uint64_t receiver, emitter; /* identities */
    uint32_t face[2];
    int depth[2];
    enum decision decision[2]; /* the yardstick's, the release's */
    struct kept link[2];
};

/* The state of an oracle that asks all releases. */
struct panel {
    RadOracle releases[RELEASES];
    int count;
    uint64_t decisions, differences;
    struct difference first; /* by identities, so the same on any number of threads */
};

static int links(enum decision decision)
{
    return decision == DECISION_LINK || decision == DECISION_LINK_CLUSTERS;
}

static struct kept keep(enum decision decision, const struct terms *t)
{
    if (!links(decision))
        return (struct kept){0};
    return (struct kept){(float)t->form_factor,
                         t->visibility,
                         {t->form_factor_level, t->visibility_level},
                         (unsigned char)(t->mark_level ? t->mark : 0)};
}

/* Equal to the bit, for which NAN is like NAN. */
static int same(const struct kept *a, const struct kept *b)
{
    return memcmp(&a->form_factor, &b->form_factor, sizeof a->form_factor) == 0
           && memcmp(&a->visibility, &b->visibility, sizeof a->visibility) == 0
           && memcmp(a->levels, b->levels, sizeof a->levels) == 0 && a->mark == b->mark;
}

static void record(struct panel *p, int k, const struct discussion *d,
                   const enum decision decision[2], const struct kept link[2])
{
    struct difference *f = &p->first;
    if (p->differences++
        && (d->receiver->id > f->receiver
            || (d->receiver->id == f->receiver && d->emitter->id >= f->emitter)))
        return;
    f->release = k;
    f->receiver = d->receiver->id;
    f->emitter = d->emitter->id;
    f->face[0] = d->receiver->face;
    f->face[1] = d->emitter->face;
    f->depth[0] = d->receiver->vertices ? d->receiver->depth : -1;
    f->depth[1] = d->emitter->vertices ? d->emitter->depth : -1;
    memcpy(f->decision, decision, sizeof f->decision);
    memcpy(f->link, link, sizeof f->link);
}

/* The parameters of the oracle that asks all: where the panel stands. An oracle's defaults have no
 * context, and a process runs one comparison. */
static struct panel panel;

static void panel_defaults(void *parameters)
{
    struct panel *at = &panel;
    memcpy(parameters, &at, sizeof at);
}

static enum decision ask_all(const void *parameters, struct discussion *d)
{
    struct panel *p;
    struct discussion start = *d;
    memcpy(&p, parameters, sizeof p);
    enum decision decision[2];
    decision[0] = radAskOracle(p->releases[0], d);
    struct kept link[2];
    link[0] = keep(decision[0], &d->terms);
    for (int k = 1; k < p->count; k++) {
        struct discussion other = start;
        decision[1] = radAskOracle(p->releases[k], &other);
        link[1] = keep(decision[1], &other.terms);
        if (decision[0] != decision[1] || !same(&link[0], &link[1])) {
#pragma omp critical(difference)
            record(p, k, d, decision, link);
        }
    }
    return decision[0];
}

static void print_side(const struct difference *f, int side)
{
    if (f->depth[side] < 0)
        printf("a cluster");
    else
        printf("face %u at depth %d", f->face[side], f->depth[side]);
}

/* What release k of the panel is called. */
static const char *name_of(const struct panel *p, int k)
{
    return release_words[order[RELEASES - p->count + k]];
}

static void print_difference(const struct panel *p)
{
    const struct difference *f = &p->first;
    printf("different: %llu of %llu discussions; first, receiver ",
           (unsigned long long)p->differences, (unsigned long long)p->decisions);
    print_side(f, 0);
    printf(", emitter ");
    print_side(f, 1);
    printf(":\n");
    for (int i = 0; i < 2; i++) {
        printf("  %-4s %s", name_of(p, i ? f->release : 0), decision_names[f->decision[i]]);
        if (links(f->decision[i]))
            printf(", F = %.9g (level %d), V = %.9g (level %d), mark %d",
                   (double)f->link[i].form_factor, f->link[i].levels[0], f->link[i].visibility,
                   f->link[i].levels[1], f->link[i].mark);
        printf("\n");
    }
}

/* Solve the scene with one oracle. Returns the refinement's seconds, or -1 after a message. */
static double solve_once(const struct options *o, const struct open_scene *scene, RadOracle oracle,
                         struct progress *progress, struct RadReport *report)
{
    const struct RadSolveOptions how = solve_options(o);
    struct solved s;
    int status = solved_open(&s, scene->device, o->scene, scene->scene, oracle, &how);
    progress_end(progress);
    if (status < 0)
        return -1;
    *report = s.report;
    solved_close(&s);
    return report->seconds.refine;
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, int n)
{
    qsort(values, (size_t)n, sizeof *values, by_size);
    return n % 2 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

static int time_releases(const struct options *o, const struct open_scene *scene,
                         const struct panel *p, struct progress *progress,
                         double median_seconds[RELEASES])
{
    double *times[RELEASES] = {0};
    int result = 0;
    for (int k = 0; k < p->count; k++)
        if (!(times[k] = malloc((size_t)o->repeats * sizeof **times)))
            result = report_error(o->scene, 0, "out of memory");
    struct RadReport report;
    for (int i = 0; i < o->repeats && result == 0; i++)
        for (int k = 0; k < p->count && result == 0; k++) {
            times[k][i] = solve_once(o, scene, p->releases[k], progress, &report);
            result = times[k][i] < 0 ? -1 : 0;
        }
    for (int k = 0; k < p->count; k++) {
        median_seconds[k] = result == 0 ? median(times[k], o->repeats) : 0;
        free(times[k]);
    }
    return result;
}

static json_t *compare_json(const struct panel *p, uint64_t link_count,
                            const double seconds[RELEASES])
{
    json_t *releases = json_object();
    for (int k = 0; k < p->count; k++)
        json_object_set_new(
            releases, name_of(p, k),
            json_pack("{s:f, s:f}", "seconds", seconds[k], "ratio", seconds[k] / seconds[0]));
    return json_pack("{s:b, s:I, s:I, s:I, s:o}", "identical", p->differences == 0, "decisions",
                     (json_int_t)p->decisions, "links", (json_int_t)link_count, "differences",
                     (json_int_t)p->differences, "releases", releases);
}

/* Open all releases that there are, and the oracle that asks them. Returns NULL after a message. */
static RadOracle open_panel(RadDevice device, const struct options *o, struct oracle *all)
{
    panel = (struct panel){
        /* what is written by hand has no nodes to replace */
        .count = !o->replacement_count && radHasOracle(device, o->oracle, RAD_RELEASE_HAND)
                     ? RELEASES
                     : RELEASES - 1};
    for (int k = 0; k < panel.count; k++) {
        panel.releases[k] = open_asked_oracle(o, device, order[RELEASES - panel.count + k]);
        if (!panel.releases[k])
            return NULL;
    }
    struct RadOracleReport report;
    radGetOracleReport(panel.releases[0], &report);
    *all = (struct oracle){.abi = RUNTIME_ABI,
                           .name = o->oracle,
                           .doc = report.doc,
                           .fingerprint = "",
                           .parameters_size = sizeof(struct panel *),
                           .defaults = panel_defaults,
                           .refine = ask_all};
    RadOracle oracle = radNewOracleCompiled(device, all, "all");
    if (!oracle)
        report_device(device, o->scene);
    return oracle;
}

/* Compare and time, and say what came of it. Returns the exit status. */
static int compare(const struct options *o, const struct open_scene *scene, RadOracle all)
{
    struct progress progress;
    progress_start(&progress, o->quiet);
    radSetDeviceProgressFunction(scene->device, progress_show, &progress);
    struct RadReport report;
    if (solve_once(o, scene, all, &progress, &report) < 0)
        return 1;
    panel.decisions = report.pairs;
    if (panel.differences)
        print_difference(&panel);
    else if (!o->quiet)
        printf("identical: %llu decisions, %llu links\n", (unsigned long long)panel.decisions,
               (unsigned long long)report.links);
    double seconds[RELEASES];
    if (time_releases(o, scene, &panel, &progress, seconds) < 0)
        return 1;
    for (int k = 0; k < panel.count && !o->quiet; k++)
        printf("  %-4s %9.3f s  %.3f\n", name_of(&panel, k), seconds[k], seconds[k] / seconds[0]);
    if (o->json && json_file_write(o->json, compare_json(&panel, report.links, seconds)) < 0)
        return 1;
    return panel.differences != 0;
}

int command_compare(const struct options *o, const struct open_scene *scene)
{
    struct oracle all;
    RadOracle oracle = open_panel(scene->device, o, &all);
    int status = oracle ? compare(o, scene, oracle) : 1;
    radReleaseOracle(oracle);
    for (int k = 0; k < panel.count; k++)
        radReleaseOracle(panel.releases[k]);
    return status;
}
