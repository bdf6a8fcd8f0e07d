/* command_compare.c - `radiosity compare`: the releases of an oracle on one scene, the hand-written one where there is one.
 *
 * First one solve in which a refiner made of all of them answers: each discusses every pair on a
 * copy, and decisions and stored links are compared bit by bit. Then each release solves alone, in
 * turn, several times, and the medians of the refinement's seconds are compared.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "commands/commands.h"
#include "output/json_file.h"
#include "progress.h"
#include "util/report.h"
#include "engine/solve.h"

/* The order of the report: the first that there is is the yardstick. */
static const enum release order[RELEASES] = { RELEASE_HAND, RELEASE_DAG, RELEASE_FLAT };

struct difference {
    int release;
    uint64_t receiver, emitter; /* identities */
    uint32_t face[2];
    int depth[2];
    enum decision decision[2]; /* the yardstick's, the release's */
    struct link link[2];
};

/* The state of a refiner that asks all releases. */
struct panel {
    struct refiner *releases[RELEASES];
    int count;
    uint64_t decisions, differences;
    struct difference first; /* by identities, so the same on any number of threads */
};

static void record(struct panel *p, int k, const struct discussion *d, const enum decision decision[2], const struct link link[2])
{
    struct difference *f = &p->first;
    if (p->differences++ && (d->receiver->id > f->receiver || (d->receiver->id == f->receiver && d->emitter->id >= f->emitter)))
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

static enum decision ask_all(const void *state, struct discussion *d)
{
    struct panel *p;
    struct discussion start = *d;
    enum decision decision[2];
    struct link link[2];
    int k;
    memcpy(&p, state, sizeof p);
    memset(link, 0, sizeof link);
    decision[0] = p->releases[0]->refine(p->releases[0]->state, d);
    if (decision_links(decision[0]))
        link_store(&link[0], &d->terms);
    for (k = 1; k < p->count; k++) {
        struct discussion other = start;
        decision[1] = p->releases[k]->refine(p->releases[k]->state, &other);
        memset(&link[1], 0, sizeof link[1]);
        if (decision_links(decision[1]))
            link_store(&link[1], &other.terms);
        if (decision[0] != decision[1] || memcmp(&link[0], &link[1], sizeof *link) != 0) {
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

static const char *decision_name(enum decision d)
{
    switch (d) {
    case DECISION_LINK:
        return "link";
    case DECISION_LINK_CLUSTERS:
        return "link_clusters";
    case DECISION_STOP:
        return "stop";
    case DECISION_SUBDIVIDE_RECEIVER:
        return "subdivide_receiver";
    case DECISION_SUBDIVIDE_EMITTER:
        return "subdivide_emitter";
    case DECISION_SUBDIVIDE_BOTH:
        return "subdivide_both";
    }
    return "?";
}

/* What release k of the panel is called. */
static const char *name_of(const struct panel *p, int k)
{
    return release_names[order[RELEASES - p->count + k]];
}

static void print_difference(const struct panel *p)
{
    const struct difference *f = &p->first;
    int i;
    printf("different: %llu of %llu discussions; first, receiver ", (unsigned long long)p->differences,
           (unsigned long long)p->decisions);
    print_side(f, 0);
    printf(", emitter ");
    print_side(f, 1);
    printf(":\n");
    for (i = 0; i < 2; i++) {
        printf("  %-4s %s", name_of(p, i ? f->release : 0), decision_name(f->decision[i]));
        if (decision_links(f->decision[i]))
            printf(", F = %.9g (level %d), V = %.9g (level %d), mark %d", (double)f->link[i].form_factor, f->link[i].levels & 15,
                   f->link[i].visibility / (double)LINK_VISIBLE, f->link[i].levels >> 4, f->link[i].mark);
        printf("\n");
    }
}

/* Solve the scene with one refiner. Returns the refinement's seconds, or -1 after a message. */
static double solve_once(const struct options *o, const struct scene *scene, const struct refiner *refiner,
                         struct progress *progress, uint64_t *pairs, size_t *links)
{
    struct solve_options how = { .tolerance = o->tolerance, .iterations = o->iterations, .jacobi = o->jacobi, .closure = (enum closure)o->closure,
                                 .threads = o->threads, .progress = progress_show, .context = progress };
    struct solve s;
    const char *cause;
    double result = -1;
    if (solve_open(&s, scene, &how, &cause) < 0) {
        report_error(o->scene, 0, "%s", cause);
        return -1;
    }
    if (solve_run(&s, refiner, &cause) < 0)
        report_error(o->scene, 0, "%s", cause);
    else {
        result = s.report.seconds.refine;
        *pairs = s.refinement.pairs;
        *links = s.refinement.link_count;
    }
    progress_end(progress);
    solve_close(&s);
    return result;
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

static int time_releases(const struct options *o, const struct scene *scene, struct panel *p, struct progress *progress, double seconds[RELEASES])
{
    double *times[RELEASES] = { 0 };
    uint64_t pairs;
    size_t links;
    int i, k, result = 0;
    for (k = 0; k < p->count; k++)
        if (!(times[k] = malloc((size_t)o->repeats * sizeof **times)))
            result = report_error(o->scene, 0, "out of memory");
    for (i = 0; i < o->repeats && result == 0; i++)
        for (k = 0; k < p->count && result == 0; k++) {
            times[k][i] = solve_once(o, scene, p->releases[k], progress, &pairs, &links);
            result = times[k][i] < 0 ? -1 : 0;
        }
    for (k = 0; k < p->count; k++) {
        seconds[k] = result == 0 ? median(times[k], o->repeats) : 0;
        free(times[k]);
    }
    return result;
}

static json_t *compare_json(const struct panel *p, size_t links, const double seconds[RELEASES])
{
    json_t *releases = json_object();
    int k;
    for (k = 0; k < p->count; k++)
        json_object_set_new(releases, name_of(p, k),
                            json_pack("{s:f, s:f}", "seconds", seconds[k], "ratio", seconds[k] / seconds[0]));
    return json_pack("{s:b, s:I, s:I, s:I, s:o}", "identical", p->differences == 0, "decisions", (json_int_t)p->decisions,
                     "links", (json_int_t)links, "differences", (json_int_t)p->differences, "releases", releases);
}

static int compare_scene(const struct options *o, const struct scene *scene)
{
    struct progress progress;
    struct panel panel = { 0 }, *at = &panel;
    struct refiner all = { .refine = ask_all, .state = &at, .oracle = o->oracle, .release = "all" };
    double seconds[RELEASES] = { 0 };
    size_t links = 0;
    int k, status = 1;
    panel.count = oracles_by_hand(o->oracle) ? RELEASES : RELEASES - 1;
    for (k = 0; k < panel.count; k++) {
        panel.releases[k] = oracles_open(o->oracle, order[RELEASES - panel.count + k]);
        if (!panel.releases[k] || oracles_set(panel.releases[k], o->settings, o->setting_count) < 0)
            goto done;
    }
    progress_start(&progress, o->quiet);
    if (solve_once(o, scene, &all, &progress, &panel.decisions, &links) < 0)
        goto done;
    if (panel.differences)
        print_difference(&panel);
    else if (!o->quiet)
        printf("identical: %llu decisions, %zu links\n", (unsigned long long)panel.decisions, links);
    if (time_releases(o, scene, &panel, &progress, seconds) < 0)
        goto done;
    if (!o->quiet)
        for (k = 0; k < panel.count; k++)
            printf("  %-4s %9.3f s  %.3f\n", name_of(&panel, k), seconds[k], seconds[k] / seconds[0]);
    status = panel.differences != 0;
    if (o->json && json_file_write(o->json, compare_json(&panel, links, seconds)) < 0)
        status = 1;
done:
    for (k = 0; k < panel.count; k++)
        refiner_close(panel.releases[k]);
    return status;
}

int command_compare(const struct options *o)
{
    return with_scene(o, compare_scene);
}
