/* explain.c - `radiosity explain`: one discussion of an oracle, node by node.
 *
 * The scene is solved by links, and all discussions on the way from (root, root) to the pair are
 * watched (watch_pair.h). What is shown is the last that was held of the pair itself, as it was
 * held: with the radiosities that the oracle saw then, and with what was known already. A pair that
 * was never discussed, since a pair above it was linked or given up, is discussed once it is all
 * over.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <string.h>
#include "commands/asked_oracle.h"
#include "commands/commands.h"
#include "commands/explain_steps.h"
#include "commands/watch_pair.h"
#include "geometry.h"
#include "output/json_file.h"
#include "output/json_values.h"
#include "util/beside.h"
#include "util/device.h"
#include "util/progress.h"
#include "util/report.h"

/* What is told of. */
struct subject {
    const struct options *options;
    RadDevice device;
    RadSolution solution;
    const struct watch *watch;
    uint32_t element[2];
    char name[2][RAD_NAME];
    const struct occasion *occasion; /* the discussion that is shown */
    struct occasion *made;           /* owned: held after all; NULL: it was held on the way */
    const struct occasion *settled;  /* the last on the way: what became of the light */
};

/* ---- what became of the pair */

static int is_below(const struct element *elements, uint32_t e, uint32_t top)
{
    while (e > top)
        e = elements[e].parent; /* parents stand before their children */
    return e == top;
}

/* Links from below the emitter to below the receiver, both included. */
static uint64_t count_links(const struct subject *s)
{
    struct RadElements tree;
    struct RadLinks links;
    uint64_t below = 0;
    radGetElements(s->solution, &tree);
    radGetLinks(s->solution, &links);
    for (size_t i = 0; i < links.count; i++)
        below += is_below(tree.elements, links.links[i].receiver, s->element[0])
                 && is_below(tree.elements, links.links[i].emitter, s->element[1]);
    return below;
}

static int settles(const struct occasion *o)
{
    return strncmp(o->decision, "subdivide", 9) != 0;
}

static void print_outcome(const struct subject *s)
{
    const uint64_t links = count_links(s);
    const struct occasion *o = s->settled;
    char receiver[RAD_NAME], emitter[RAD_NAME];
    if (links) {
        printf("in the solution: %llu link%s from %s or below to %s or below\n",
               (unsigned long long)links, links == 1 ? "" : "s", s->name[1], s->name[0]);
        return;
    }
    if (!o || radGetElementName(s->solution, o->receiver, receiver) < 0
        || radGetElementName(s->solution, o->emitter, emitter) < 0)
        return;
    if (o->receiver == s->element[0] && o->emitter == s->element[1])
        printf("in the solution: no link from %s to %s, nor below\n", s->name[1], s->name[0]);
    else
        printf("in the solution: %s from %s was decided above: %s of %s from %s\n", s->name[0],
               s->name[1], o->decision, receiver, emitter);
}

/* ---- text */

static void print_element(const struct subject *s, int side, const char *role)
{
    const struct element *e =
        side ? s->occasion->discussion.emitter : s->occasion->discussion.receiver;
    printf("  %-8s  %s: %s of %.6g m2 at %.4g,%.4g,%.4g, B %.6g W/m2", role, s->name[side],
           !e->vertices ? "cluster"
           : e->depth   ? "part of a face"
                        : "face",
           e->area, e->centre[0], e->centre[1], e->centre[2], e->radiosity);
    if (e->children)
        printf(", %d parts", e->children);
    /* the nearest face is taken, and a point may be mistyped */
    const struct watched_end *end = &s->watch->end[side];
    if (!*end->name && e->vertices)
        printf(", %.2g m from the point",
               polygon_distance(end->point, e->vertex, e->vertices, e->normal));
    printf("\n");
}

static void print_history(const struct subject *s)
{
    const struct watch *w = s->watch;
    size_t longest[2] = {8, 7};
    char name[RAD_NAME];
    for (size_t i = 0; i < w->count; i++)
        for (int k = 0; k < 2; k++)
            if (radGetElementName(s->solution,
                                  k ? w->occasions[i]->emitter : w->occasions[i]->receiver, name)
                    == 0
                && strlen(name) > longest[k])
                longest[k] = strlen(name);
    printf("the way to it:\n  pass  round  %-*s  %-*s  nodes  rays  decision\n", (int)longest[0],
           "receiver", (int)longest[1], "emitter");
    for (size_t i = 0; i < w->count; i++) {
        const struct occasion *o = w->occasions[i];
        char receiver[RAD_NAME] = "", emitter[RAD_NAME] = "";
        (void)radGetElementName(s->solution, o->receiver, receiver);
        (void)radGetElementName(s->solution, o->emitter, emitter);
        printf("%s %4d %6llu  %-*s  %-*s %6d %5u  %s\n", o == s->occasion ? ">" : " ", o->pass,
               (unsigned long long)o->round, (int)longest[0], receiver, (int)longest[1], emitter,
               o->nodes, (unsigned)o->rays, o->decision);
    }
}

static void print_subject(const struct subject *s)
{
    const struct occasion *o = s->occasion;
    struct RadOracleReport report;
    double between[3];
    radGetOracleReport(s->watch->oracle, &report);
    sub3(between, o->elements[0].centre, o->discussion.emitter->centre);
    printf("%s, oracle %s: may %s be lit by %s as it stands?\n", s->options->scene, report.name,
           s->name[0], s->name[1]);
    print_element(s, 0, "receiver");
    print_element(s, 1, "emitter");
    printf("  distance  %.6g m between their centres\n", length3(between));
    print_history(s);
    struct RadReport solved;
    radGetReport(s->solution, &solved);
    if (s->made)
        printf("never discussed; as it would be now, after %d solve%s:\n", solved.passes,
               solved.passes == 1 ? "" : "s");
    else
        printf("discussed in pass %d, round %llu:\n", o->pass, (unsigned long long)o->round);
}

/* ---- JSON */

static json_t *element_json(const struct subject *s, int side)
{
    const struct element *e =
        side ? s->occasion->discussion.emitter : s->occasion->discussion.receiver;
    char id[24];
    snprintf(id, sizeof id, "%016llx", (unsigned long long)e->id);
    return json_pack("{s:s, s:s, s:b, s:i, s:f, s:f, s:f, s:[f,f,f]}", "name", s->name[side],
                     "identity", id, "cluster", e->vertices == 0, "depth", (int)e->depth, "area",
                     e->area, "radiosity", e->radiosity, "reflectance", e->reflectance, "centre",
                     e->centre[0], e->centre[1], e->centre[2]);
}

static json_t *subject_json(const struct subject *s)
{
    struct RadOracleReport report;
    radGetOracleReport(s->watch->oracle, &report);
    json_t *history = json_array(), *replaced = json_array();
    for (size_t i = 0; i < s->watch->count; i++) {
        const struct occasion *o = s->watch->occasions[i];
        char receiver[RAD_NAME] = "", emitter[RAD_NAME] = "";
        (void)radGetElementName(s->solution, o->receiver, receiver);
        (void)radGetElementName(s->solution, o->emitter, emitter);
        json_array_append_new(history,
                              json_pack("{s:i, s:I, s:s, s:s, s:i, s:I, s:s}", "pass", o->pass,
                                        "round", (json_int_t)o->round, "receiver", receiver,
                                        "emitter", emitter, "nodes", o->nodes, "rays",
                                        (json_int_t)o->rays, "decision", o->decision));
    }
    for (int i = 0; i < s->options->replacement_count; i++)
        json_array_append_new(replaced, json_string(s->options->replacements[i]));
    return json_pack("{s:o, s:s, s:o, s:o, s:o, s:o, s:b, s:o, s:o, s:o, s:O, s:I}", "scene",
                     json_text(s->options->scene), "oracle", report.name, "parameters",
                     oracle_parameters_json(s->watch->oracle), "replaced", replaced, "receiver",
                     element_json(s, 0), "emitter", element_json(s, 1), "discussed", !s->made,
                     "pass", s->made ? json_null() : json_integer(s->occasion->pass), "round",
                     s->made ? json_null() : json_integer((json_int_t)s->occasion->round),
                     "history", history, "discussion", s->occasion->json, "links",
                     (json_int_t)count_links(s));
}

/* ---- which discussion */

/* The last of the pair, or, by points, the last that settled something; in one pass where that is
 * asked for. */
static const struct occasion *find_last(const struct subject *s, int by_points)
{
    const struct occasion *found = NULL;
    for (size_t i = 0; i < s->watch->count; i++) {
        const struct occasion *o = s->watch->occasions[i];
        if ((s->options->pass == 0 || o->pass == s->options->pass)
            && (by_points || (o->receiver == s->element[0] && o->emitter == s->element[1])))
            found = o;
    }
    return found;
}

/* Returns 0, or -1 after a message. */
static int choose(struct subject *s, struct watch *w)
{
    const int by_points = s->options->at != NULL;
    if (watch_settle(w) < 0)
        return report_error(by_points ? "--at" : "--pair", 0, "out of memory");
    for (int i = 0; i < 2 && !by_points; i++)
        if (watch_element(w, i, &s->element[i]) < 0)
            return report_device(s->device, "--pair");
    s->occasion = find_last(s, by_points);
    for (size_t i = 0; i < w->count; i++)
        if (settles(w->occasions[i]))
            s->settled = w->occasions[i];
    if (!s->occasion && s->options->pass > 0)
        return report_error("--pass", 0,
                            "nothing was said of this pair in pass %d; without --pass the last "
                            "discussion is shown, and the passes of all",
                            s->options->pass);
    if (!s->occasion) /* it never was */
        s->occasion = s->made =
            occasion_hold(s->device, s->solution, w->oracle, s->element, "--pair");
    if (!s->occasion)
        return -1;
    s->element[0] = s->occasion->receiver;
    s->element[1] = s->occasion->emitter;
    return radGetElementName(s->solution, s->element[0], s->name[0]) < 0
                   || radGetElementName(s->solution, s->element[1], s->name[1]) < 0
               ? report_device(s->device, "--pair")
               : 0;
}

static int tell(const struct subject *s)
{
    const struct options *o = s->options;
    if (o->json && json_file_write(o->json, subject_json(s)) < 0)
        return 1;
    if (o->quiet || path_is_stdout(o->json))
        return 0;
    print_subject(s);
    if (o->step)
        return explain_steps(o, s->device, s->solution, s->watch->oracle, s->occasion);
    fputs(s->occasion->text, stdout);
    print_outcome(s);
    return 0;
}

/* ---- the solve */

/* As far as the pass that is asked for. Returns 0, or -1 after a message. */
static int solve(const struct options *o, RadDevice device, RadSolution solution,
                 const struct watch *w)
{
    int more = 1, status = o->pass == 0 ? radSolve(solution) : radRefine(solution);
    for (int i = 1; i < o->pass && status == 0 && more > 0; i++) {
        more = radStep(solution);
        status = more < 0 ? -1 : 0;
    }
    if (status == 0)
        return 0;
    return w->failed ? report_error(o->scene, 0, "out of memory to watch")
                     : report_device(device, o->scene);
}

static int explain_pair(const struct options *o, const struct open_scene *scene, RadOracle oracle,
                        RadSolution solution)
{
    struct watch w;
    int status = watch_open(&w, scene->device, solution, oracle, o->pair, o->at);
    if (status)
        return status;
    struct progress progress;
    progress_start(&progress, o->quiet);
    radSetDeviceProgressFunction(scene->device, progress_show, &progress);
    status = solve(o, scene->device, solution, &w);
    progress_end(&progress);
    struct subject s = {.options = o, .device = scene->device, .solution = solution, .watch = &w};
    status = status < 0 || choose(&s, &w) < 0 ? 1 : tell(&s);
    occasion_free(s.made);
    watch_close(&w);
    return status;
}

int command_explain(const struct options *o, const struct open_scene *scene)
{
    const struct RadSolveOptions how = solve_options(o);
    RadOracle oracle = open_asked_oracle(o, scene->device, RAD_RELEASE_DAG);
    RadSolution solution = oracle ? radNewSolution(scene->scene, oracle, &how) : NULL;
    if (oracle && !solution)
        report_device(scene->device, o->scene);
    int status = solution ? explain_pair(o, scene, oracle, solution) : 1;
    radReleaseSolution(solution);
    radReleaseOracle(oracle);
    return status;
}
