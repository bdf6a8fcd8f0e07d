/* compare.c - `radiosity compare`: the releases of an oracle on one scene, the hand-written one
 * where there is one.
 *
 * First one solve by an oracle made of all of them, which reads what they read: each discusses
 * every pair on a copy, blocks of them at once where it runs in waves, and decisions and what links
 * would store are compared bit by bit. It ends with the first round in which they differ: what
 * follows would tell of other links. Else each release solves alone, in turn, several times, and
 * the medians of the refinement's seconds are compared.
 * SPDX-License-Identifier: MIT */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include "commands/asked_oracle.h"
#include "commands/commands.h"
#include "output/json_file.h"
#include "util/array.h"
#include "util/progress.h"
#include "util/decisions.h"
#include "util/device.h"
#include "util/report.h"
#include "util/solved.h"
#include "wave.h"

enum { RELEASES = 4 };

/* The order of the report: the first that there is is the yardstick. */
static const enum RadRelease order[RELEASES] = {RAD_RELEASE_HAND, RAD_RELEASE_DAG, RAD_RELEASE_FLAT,
                                                RAD_RELEASE_WAVE};

/* What a link keeps of a discussion. */
struct kept {
    float form_factor;
    double visibility;
    unsigned char levels[2], mark, marks[2]; /* marks: of receiver and emitter */
};

/* The first pair that they do not do the same with: by identities, so the same on any number of
 * threads. */
struct difference {
    uint64_t receiver, emitter; /* identities */
    uint32_t element[2];
    char name[2][RAD_NAME];
    uint64_t way;                     /* of the interpreted release */
    enum decision decision[RELEASES]; /* as panel.releases */
    struct kept link[RELEASES];
};

/* The state of an oracle that asks all releases. */
struct panel {
    RadOracle releases[RELEASES];
    int count, interpreted; /* which of them keeps its graph */
    uint64_t decisions, differences;
    struct difference first;
    RadSolution solution;
    struct progress *progress;
};

static int links(enum decision decision)
{
    return decision == DECISION_LINK || decision == DECISION_LINK_CLUSTERS;
}

static struct kept keep(enum decision decision, const struct terms *t)
{
    struct kept kept = {.marks = {(unsigned char)(t->receiver_mark_level ? t->receiver_mark : 0),
                                  (unsigned char)(t->emitter_mark_level ? t->emitter_mark : 0)}};
    if (!links(decision))
        return kept;
    kept.form_factor = (float)t->form_factor;
    kept.visibility = t->visibility;
    kept.levels[0] = t->form_factor_level;
    kept.levels[1] = t->visibility_level;
    kept.mark = (unsigned char)(t->mark_level ? t->mark : 0);
    return kept;
}

/* Equal to the bit, for which NAN is like NAN. */
static int same(const struct kept *a, const struct kept *b)
{
    return memcmp(&a->form_factor, &b->form_factor, sizeof a->form_factor) == 0
           && memcmp(&a->visibility, &b->visibility, sizeof a->visibility) == 0
           && memcmp(a->levels, b->levels, sizeof a->levels) == 0 && a->mark == b->mark
           && memcmp(a->marks, b->marks, sizeof a->marks) == 0;
}

static void record(struct panel *p, const struct discussion *start, const enum decision *decision,
                   const struct kept *link)
{
    struct difference *f = &p->first;
    struct discussion again = *start;
    if (p->differences++
        && (start->receiver->id > f->receiver
            || (start->receiver->id == f->receiver && start->emitter->id >= f->emitter)))
        return;
    f->receiver = start->receiver->id;
    f->emitter = start->emitter->id;
    f->element[0] = (uint32_t)(start->receiver - *start->host->elements);
    f->element[1] = (uint32_t)(start->emitter - *start->host->elements);
    memcpy(f->decision, decision, sizeof f->decision);
    memcpy(f->link, link, sizeof f->link);
    (void)radAskOracleWay(p->releases[p->interpreted], &again, &f->way);
}

/* The parameters of the oracle that asks all: where the panel stands. An oracle's defaults have no
 * context, and a process runs one comparison. */
static struct panel panel;
static pthread_mutex_t recording = PTHREAD_MUTEX_INITIALIZER;

static void panel_defaults(void *parameters)
{
    struct panel *at = &panel;
    memcpy(parameters, &at, sizeof at);
}

/* A block's discussions as one release holds them. */
struct held {
    struct discussion d[WAVE_PAIRS];
    struct blockers lists[WAVE_PAIRS];
    enum decision decisions[WAVE_PAIRS];
};

/* Each of them from the same beginning, lists included; those of the first release go on. */
static void ask_release(const struct panel *p, int k, const struct discussion *block, int count,
                        struct held *held)
{
    for (int i = 0; i < count; i++) {
        held->d[i] = block[i];
        if (!block[i].blockers)
            continue;
        held->lists[i] = *block[i].blockers;
        held->d[i].blockers = &held->lists[i];
    }
    radAskOracles(p->releases[k], held->d, count, held->decisions);
}

static void judge(struct panel *p, const struct discussion *block, int count,
                  const struct held *held)
{
    for (int i = 0; i < count; i++) {
        enum decision decision[RELEASES] = {held[0].decisions[i]};
        struct kept link[RELEASES] = {keep(decision[0], &held[0].d[i].terms)};
        int different = 0;
        for (int k = 1; k < p->count; k++) {
            decision[k] = held[k].decisions[i];
            link[k] = keep(decision[k], &held[k].d[i].terms);
            different |= decision[0] != decision[k] || !same(&link[0], &link[k]);
        }
        if (different) {
            pthread_mutex_lock(&recording);
            record(p, &block[i], decision, link);
            pthread_mutex_unlock(&recording);
        }
    }
}

static void ask_block(struct panel *p, struct discussion *block, int count,
                      enum decision *decisions)
{
    struct held held[RELEASES];
    for (int k = 0; k < p->count; k++)
        ask_release(p, k, block, count, &held[k]);
    judge(p, block, count, held);
    for (int i = 0; i < count; i++) {
        if (block[i].blockers)
            *block[i].blockers = held[0].lists[i];
        block[i].terms = held[0].d[i].terms;
        decisions[i] = held[0].decisions[i];
    }
}

static void ask_all_in_blocks(const void *parameters, struct discussion *block, int count,
                              enum decision *decisions)
{
    struct panel *p;
    memcpy(&p, parameters, sizeof p);
    for (int from = 0; from < count; from += WAVE_PAIRS)
        ask_block(p, block + from, count - from < WAVE_PAIRS ? count - from : WAVE_PAIRS,
                  decisions + from);
}

static enum decision ask_all(const void *parameters, struct discussion *d)
{
    enum decision decision;
    ask_all_in_blocks(parameters, d, 1, &decision);
    return decision;
}

/* What release k of the panel is called. */
static const char *name_of(const struct panel *p, int k)
{
    return release_words[order[RELEASES - p->count + k]];
}

/* The answers that led the interpreted release to its decision; the last of them is the one to look
 * at. NULL: out of memory, or none. */
static struct RadAnswer *way_of(const struct panel *p, int *count)
{
    RadOracle oracle = p->releases[p->interpreted];
    *count = radGetOracleWay(oracle, p->first.way, NULL, 0);
    struct RadAnswer *way = *count > 0 ? malloc((size_t)*count * sizeof *way) : NULL;
    if (way)
        (void)radGetOracleWay(oracle, p->first.way, way, *count);
    return way;
}

static void print_difference(const struct panel *p)
{
    const struct difference *f = &p->first;
    int count;
    struct RadAnswer *way = way_of(p, &count);
    printf("different: %llu of the first %llu discussions; of receiver %s, emitter %s\n",
           (unsigned long long)p->differences, (unsigned long long)p->decisions, f->name[0],
           f->name[1]);
    for (int k = 0; k < p->count; k++) {
        printf("  %-4s %s", name_of(p, k), decision_names[f->decision[k]]);
        if (links(f->decision[k]))
            printf(", F = %.9g (level %d), V = %.9g (level %d), mark %d",
                   (double)f->link[k].form_factor, f->link[k].levels[0], f->link[k].visibility,
                   f->link[k].levels[1], f->link[k].mark);
        if (f->link[k].marks[0] || f->link[k].marks[1])
            printf(", receiver marked %d, emitter %d", f->link[k].marks[0], f->link[k].marks[1]);
        printf("\n");
    }
    printf("the graph's way there, as release dag goes it:\n");
    for (int i = 0; way && i < count; i++)
        printf("  node %s = %s: %s -> %s\n", way[i].node, way[i].tool, way[i].answer,
               way[i].target);
    printf("stopped there; nothing is timed\n");
    free(way);
}

/* Where it was, while its elements can be named. */
static void note_place(struct panel *p, uint64_t pairs)
{
    p->decisions = pairs;
    for (int i = 0; i < 2; i++)
        if (radGetElementName(p->solution, p->first.element[i], p->first.name[i]) < 0)
            snprintf(p->first.name[i], RAD_NAME, "%u", p->first.element[i]);
}

/* Between rounds: what is different ends the solve. */
static int show_and_stop(void *user, const struct RadProgress *at)
{
    struct panel *p = user;
    if (!p->differences)
        return progress_show(p->progress, at);
    note_place(p, at->pairs);
    return 1;
}

/* Solve with all of them at once, up to where they differ. Returns 0, or -1 after a message. */
static int solve_all(const struct options *o, const struct open_scene *scene, RadOracle all,
                     struct progress *progress, struct RadReport *report)
{
    const struct RadSolveOptions how = solve_options(o);
    struct solved s;
    *report = (struct RadReport){0};
    if (solved_begin(&s, scene->device, o->scene, scene->scene, all, &how) < 0)
        return -1;
    panel.solution = s.solution;
    panel.progress = progress;
    radSetDeviceProgressFunction(scene->device, show_and_stop, &panel);
    int status = solved_finish(&s, &how);
    radSetDeviceProgressFunction(scene->device, progress_show, progress);
    progress_end(progress);
    if (status < 0 && panel.differences)
        return (void)radGetDeviceError(scene->device), 0; /* it was cancelled */
    if (status < 0)
        return report_device(scene->device, o->scene);
    panel.decisions = s.report.pairs;
    if (panel.differences) /* in the last round */
        note_place(&panel, s.report.pairs);
    *report = s.report;
    solved_close(&s);
    return 0;
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

static double median(double *values, int n)
{
    qsort(values, (size_t)n, sizeof *values, compare_numbers);
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

static json_t *difference_json(const struct panel *p)
{
    const struct difference *f = &p->first;
    json_t *decisions = json_object(), *asked = json_array();
    int count;
    struct RadAnswer *way = way_of(p, &count);
    for (int k = 0; k < p->count; k++)
        json_object_set_new(decisions, name_of(p, k), json_string(decision_names[f->decision[k]]));
    for (int i = 0; way && i < count; i++)
        json_array_append_new(
            asked, json_pack("{s:s, s:s}", "node", way[i].node, "answer", way[i].answer));
    free(way);
    return json_pack("{s:b, s:I, s:I, s:{s:s, s:s, s:o, s:o}}", "identical", 0, "decisions",
                     (json_int_t)p->decisions, "differences", (json_int_t)p->differences, "first",
                     "receiver", f->name[0], "emitter", f->name[1], "way", asked, "decides",
                     decisions);
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
        if (order[RELEASES - panel.count + k] == RAD_RELEASE_DAG)
            panel.interpreted = k;
    }
    struct RadOracleReport report;
    radGetOracleReport(panel.releases[panel.interpreted], &report);
    (void)radGetOracleWay(panel.releases[panel.interpreted], 0, NULL, 0); /* from now on */
    *all = (struct oracle){.abi = RUNTIME_ABI,
                           .name = o->oracle,
                           .doc = report.doc,
                           .fingerprint = "",
                           .parameters_size = sizeof(struct panel *),
                           .defaults = panel_defaults,
                           .refine = ask_all,
                           .reads = report.reads,
                           .read_count = report.read_count,
                           .wave = ask_all_in_blocks};
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
    struct RadReport report;
    if (solve_all(o, scene, all, &progress, &report) < 0)
        return 1;
    if (panel.differences) {
        print_difference(&panel);
        if (o->json)
            (void)json_file_write(o->json, difference_json(&panel));
        return 1;
    }
    if (!o->quiet)
        printf("identical: %llu decisions, %llu links\n", (unsigned long long)panel.decisions,
               (unsigned long long)report.links);
    double seconds[RELEASES];
    if (time_releases(o, scene, &panel, &progress, seconds) < 0)
        return 1;
    for (int k = 0; k < panel.count && !o->quiet; k++)
        printf("  %-4s %9.3f s  %.3f\n", name_of(&panel, k), seconds[k], seconds[k] / seconds[0]);
    const int unfinished = solved_status(&report, o->scene);
    return o->json && json_file_write(o->json, compare_json(&panel, report.links, seconds)) < 0
               ? 1
               : unfinished;
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
